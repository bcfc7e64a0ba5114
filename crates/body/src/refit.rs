//! Fits primitives anew to the skin that was made from them.

use crate::sides::both_sides;
use crate::{Blend, Part, Primitive, THRESHOLD};
use nalgebra::Matrix3;
use toile_geometry::{TriangleMesh, Vec3};

/// Number of sweeps over all points: about five halve the error.
const SWEEPS: usize = 12;

/// Scales the primitives of the left side and the median plane so that the density at the skin's vertices is
/// the threshold, and returns them with their mirror images. The scales solve the linearised least squares by
/// simultaneous reconstruction (Gilbert 1972): `x += C A^T R (b - A x)`. A holds `4 q (1 - q)`, the
/// derivative of a density by the logarithm of its primitive's size, R and C hold the inverse sums of its
/// rows and columns.
pub(crate) fn refitted(
    mut primitives: Vec<Primitive>,
    mesh: &TriangleMesh,
    parts: &[Part],
) -> Vec<Primitive> {
    let points = left_points(mesh, parts);
    for _ in 0..SWEEPS {
        let mut step = vec![0.0; primitives.len()];
        let mut weight = vec![0.0; primitives.len()];
        for (part, points) in &points {
            let own: Vec<Own> = primitives
                .iter()
                .enumerate()
                .filter(|(_, p)| p.belongs_to(*part) && p.blend == Blend::Blendable)
                .map(|(i, p)| (i, p.weight, sides(p), inverse(p)))
                .collect();
            for &point in points {
                sweep(point, &own, (&mut step, &mut weight));
            }
        }
        for (i, primitive) in primitives.iter_mut().enumerate() {
            if weight[i] > 0.0 {
                let scale = (step[i] / weight[i]).clamp(-0.1, 0.1).exp();
                primitive.radii = primitive.radii.map(|r| r * scale);
            }
        }
    }
    both_sides(primitives)
}

/// Number of a primitive, weight, centre, centre of its mirror image, and `S^-1 R^T`.
type Own = (usize, f64, [Vec3; 2], Matrix3<f64>);

/// Centres of a primitive and of its mirror image in the same part; infinitely far away if it has no such
/// image.
fn sides(primitive: &Primitive) -> [Vec3; 2] {
    let centre = Vec3::from(primitive.centre);
    let twin = match primitive.part {
        // The mirror image of a limb's primitive lies in the other limb.
        Part::Trunk | Part::Head if !primitive.is_central() => {
            Vec3::new(-centre.x, centre.y, centre.z)
        }
        _ => Vec3::repeat(f64::INFINITY),
    };
    [centre, twin]
}

/// The matrix `S^-1 R^T` of a primitive (1/m), see [`Primitive`].
fn inverse(primitive: &Primitive) -> Matrix3<f64> {
    let inverse = Matrix3::from_diagonal(&Vec3::from(primitive.radii).map(|r| 1.0 / r));
    inverse * primitive.rotation().matrix().transpose()
}

/// Adds the steps and weights of one point for the primitives.
fn sweep(point: Vec3, own: &[Own], (step, weight): (&mut [f64], &mut [f64])) {
    let (mut density, mut row) = (0.0, 0.0);
    let mut touched: Vec<(usize, f64)> = Vec::new();
    for (i, strength, [centre, twin], matrix) in own {
        let mut slope = 0.0;
        let mut add = |offset: Vec3| {
            let q = (matrix * offset).norm_squared();
            if q < 1.0 {
                density += strength * (1.0 - q) * (1.0 - q);
                slope += 4.0 * strength * q * (1.0 - q);
            }
        };
        add(point - centre);
        if twin.x.is_finite() {
            let offset = point - twin;
            // The frame of the mirror image is the mirror image of the primitive's frame.
            add(Vec3::new(-offset.x, offset.y, offset.z));
        }
        if slope > 0.0 {
            row += slope;
            touched.push((*i, slope));
        }
    }
    let error = (THRESHOLD - density) / row.max(1e-9);
    for (i, slope) in touched {
        step[i] += slope * error;
        weight[i] += slope;
    }
}

/// The skin's vertices on the left and in the median plane, by part.
fn left_points(mesh: &TriangleMesh, parts: &[Part]) -> Vec<(Part, Vec<Vec3>)> {
    let mut seen = vec![false; mesh.positions.len()];
    let mut all: Vec<(Part, Vec<Vec3>)> = [Part::Trunk, Part::Head, Part::LeftArm, Part::LeftLeg]
        .map(|part| (part, Vec::new()))
        .into();
    let left = mesh.triangles.len() / 2;
    for (t, triangle) in mesh.triangles[..left].iter().enumerate() {
        for &v in triangle {
            if !std::mem::replace(&mut seen[v as usize], true)
                && let Some(row) = all.iter_mut().find(|row| row.0 == parts[t])
            {
                row.1.push(mesh.positions[v as usize]);
            }
        }
    }
    all
}
