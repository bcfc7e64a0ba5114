//! Bounds on the largest angular frequency of a cloth, by which substeps are chosen.

use nalgebra::Matrix3;
use toile_drape::largest_frequency;
use toile_drape::{State, System};

/// Largest deviation of the principal squared stretches from 1 at which a layout counts as isometric to the
/// rest shapes.
const ISOMETRIC: f64 = 0.02;

/// Relative bound on the error of the Lanczos iteration, which approaches the largest frequency from below.
const LANCZOS_ERROR: f64 = 2e-3;

/// A bound on the largest angular frequency of the unstrained cloth (rad/s), given the largest and smallest
/// principal squared stretch of its layout: by Lanczos iteration about the layout where that is nearly isometric
/// to the rest shapes, otherwise by bounds that do not depend on the layout.
pub fn frequency_at_rest(system: &System, [largest, smallest]: [f64; 2]) -> f64 {
    let bound = stiffest(system).0.hypot(soft_frequency(system));
    if largest < 1.0 + ISOMETRIC && smallest > 1.0 - ISOMETRIC {
        let layout = State::at_rest(system, system.topology.layout.clone());
        // In compression the frequency falls as the stretch, the root of the squared one.
        bound.min((1.0 + LANCZOS_ERROR) * largest_frequency(system, &layout) / smallest.sqrt())
    } else {
        bound
    }
}

/// The largest angular frequency of any single triangle on its share of the masses (rad/s), which bounds that of
/// the whole cloth (Irons and Treharne 1971), and a vertex of that triangle.
///
/// With strain B u, energy A C : strain strain / 2 and density rho, w^2 is the largest eigenvalue
/// of 3/rho L^T (B B^T) L, C = L L^T.
pub fn stiffest(system: &System) -> (f64, usize) {
    let mut best = (0.0, 0);
    for (t, element) in system.rest.elements.iter().enumerate() {
        let material = system.materials.of_triangle[t] as usize;
        let [c11, c22, c12, g] = system.materials.laws[material].stiffness;
        let sum = |p: [f64; 3], q: [f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
        let (a, b) = (element.warp, element.weft);
        let (aa, bb, ab) = (sum(a, a), sum(b, b), sum(a, b));
        let shapes = Matrix3::new(aa, 0.0, ab, 0.0, bb, ab, ab, ab, aa + bb);
        let law = Matrix3::new(c11, c12, 0.0, c12, c22, 0.0, 0.0, 0.0, g);
        let largest = match law.cholesky() {
            Some(root) => (root.l().transpose() * shapes * root.l())
                .symmetric_eigenvalues()
                .max(),
            None => law.norm() * shapes.trace(),
        };
        let squared = 3.0 / system.materials.list[material].density * largest;
        if squared > best.0 {
            best = (squared, system.topology.triangles[t][0] as usize);
        }
    }
    (best.0.sqrt(), best.1)
}

/// A bound on the largest angular frequency due to bending and elastics (rad/s): the largest row sum of
/// |K| / m (Gershgorin 1931).
pub fn soft_frequency(system: &System) -> f64 {
    (0..system.vertex_count())
        .filter(|&v| !system.prescribed.pinned[v])
        .map(|v| {
            let (_, values) = system.rest.bending.row_entries(v);
            let bending: f64 = values.iter().map(|k| k.abs()).sum();
            (bending + 2.0 * system.elastic_stiffness(v)) / system.rest.mass[v]
        })
        .fold(0.0, f64::max)
        .sqrt()
}

/// The largest factor by which a squared stretch r raises the frequencies of the membrane. The material
/// stiffness grows by the factor r. The geometric stiffness is the stress, at most (1 + nu) C (r - 1)/2 in
/// biaxial stretch, C being the material stiffness at rest.
pub fn stiffening(r: f64) -> f64 {
    (2.0 * r - 1.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_drape::{Cloth, Material};
    use toile_geometry::{TriangleMesh, Vec3};

    fn sheet([columns, rows]: [u32; 2], size: [f64; 2]) -> TriangleMesh {
        let mut mesh = TriangleMesh::default();
        for j in 0..=rows {
            for i in 0..=columns {
                let x = size[0] * f64::from(i) / f64::from(columns);
                let z = size[1] * f64::from(j) / f64::from(rows);
                mesh.positions.push(Vec3::new(x, 0.0, z));
            }
        }
        for j in 0..rows {
            for i in 0..columns {
                let a = j * (columns + 1) + i;
                let (b, c, d) = (a + 1, a + columns + 2, a + columns + 1);
                mesh.triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        mesh
    }

    #[test]
    fn the_bound_by_triangles_lies_above_the_largest_frequency_and_not_far() {
        let mesh = sheet([7, 5], [0.21, 0.16]);
        let material = Material {
            bend: [0.0; 3],
            ..Material::default()
        };
        let cloth = Cloth::from_mesh("cloth", &mesh, material).unwrap();
        let system = System::new("cloth", &cloth).unwrap();
        let exact = largest_frequency(&system, &State::at_rest(&system, mesh.positions.clone()));
        let (bound, _) = stiffest(&system);
        assert!(bound >= exact && bound < 1.6 * exact, "{bound} {exact}");
        // About a compressed layout the frequency of the cloth at rest cannot be measured.
        let squeezed = frequency_at_rest(&system, [1.0, 0.5]);
        assert!((squeezed - bound).abs() < 1e-9 * bound);
        let flat = frequency_at_rest(&system, [1.0, 1.0]);
        assert!(flat >= exact && flat < 1.003 * exact, "{flat} {exact}");
    }

    #[test]
    fn stretch_raises_the_frequency_by_no_more_than_it_says() {
        let mesh = sheet([6, 6], [0.2, 0.2]);
        let material = Material {
            bend: [0.0; 3],
            ..Material::default()
        };
        let cloth = Cloth::from_mesh("cloth", &mesh, material).unwrap();
        let system = System::new("cloth", &cloth).unwrap();
        let frequency = |drawn: [f64; 2]| {
            let places = mesh.positions.iter();
            let moved = places.map(|p| Vec3::new(p.x * drawn[0], p.y, p.z * drawn[1]));
            largest_frequency(&system, &State::at_rest(&system, moved.collect()))
        };
        let still = frequency([1.0, 1.0]);
        for [a, b] in [
            [1.1f64, 1.0],
            [1.0, 1.3],
            [1.2, 1.2],
            [1.5, 0.7],
            [2.0, 2.0],
        ] {
            let r: f64 = a.max(b) * a.max(b);
            let (got, most) = (frequency([a, b]) / still, stiffening(r));
            assert!(got <= 1.001 * most, "{a} {b}: {got} {most}");
        }
    }
}
