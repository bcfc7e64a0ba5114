//! Measures of a drape: residual (net force over weight), strain, penetration, crossings.
//!
//! # Decided with
//! - [`crate::newton`]: the net force of the residual;
//! - [`crate::collider::PlacedSolid::crossings`]: crossings with solids;
//! - [`toile_geometry::segment_intersects_triangle`]: exact signs;
//! - [`crate::garment`] (`body_crossings`), [`crate::scene_run::SceneRun::crossings`]: counts on the way of a
//!   garment, of a scene;
//! - [`crate::laws::membrane::MembraneElement::strain`]: strain of a triangle;
//! - [`crate::pair_policies::PairPolicies`]: objects that pass through each other are left out.

use crate::collision::{ClothSurface, layer_violations_of, layers_of};
use crate::{State, System, Workspace};
use rayon::prelude::*;
use std::collections::BTreeMap;
use toile_geometry::{ClosestPoint, SurfaceTree, TriangleMesh, Vec3};

/// Measures of one state. Crossings and depths of objects that ignore each other
/// ([`PairPolicies`](crate::PairPolicies)) do not count.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measures {
    /// Norm of the net forces over the norm of the weights, over free vertices; contact and
    /// friction inside its cone are part of the net force.
    pub residual: f64,
    /// Kinetic energy (J).
    pub kinetic_energy: f64,
    /// Largest stretch along warp and weft.
    pub strain_max: [f64; 2],
    /// 99th percentile by area of the stretch along warp and weft.
    pub strain_p99: [f64; 2],
    /// Largest shortening along warp and weft, as a positive number.
    pub compression_max: [f64; 2],
    /// Largest shear angle (rad).
    pub shear_max: f64,
    /// Deepest vertex below a solid surface (m).
    pub penetration_max: f64,
    /// Pairs of a cloth triangle and a solid triangle that intersect, exactly.
    pub body_intersections: usize,
    /// Those of them with a solid triangle that is partly inside another part of its solid, where a figure's skin goes
    /// through itself: there cloth has nowhere to be.
    pub buried_intersections: usize,
    /// Area of those triangles over that of the solids (1).
    pub buried_share: f64,
    /// Edges of cloth with both ends more than 5 mm inside a solid that lie nearest to opposite sides of it (outward
    /// normals there more than 90 degrees apart): such cloth is not pressed in from one side, it goes through.
    pub edges_through_body: usize,
    /// Pairs of cloth triangles that intersect and share no vertex, exactly.
    pub self_intersections: usize,
    /// Measures by layer, innermost first; empty where all cloth is in one layer.
    pub layers: Vec<LayerMeasures>,
}

/// Measures of one layer of cloth among several.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LayerMeasures {
    /// Its number.
    pub layer: u16,
    /// Pairs of one of its triangles and a solid triangle that intersect, exactly.
    pub body_intersections: usize,
    /// Pairs of its triangles that intersect and share no vertex, exactly.
    pub self_intersections: usize,
    /// Pairs of one of its triangles and one of an outer layer that intersect, exactly.
    pub outer_intersections: usize,
    /// Vertices of outer layers on its inside, within 5 cm of it.
    pub astray: usize,
}

/// Distance from a layer within which outer vertices on its inside are counted (m).
const ORDER_REACH: f64 = 0.05;
/// Depth inside a solid from which the side that a vertex lies nearest to counts (m).
const DEPTH_OF_SIDES: f64 = 5e-3;
/// Cosine between the normals of two sides of a solid below which they are opposite: at the edge of a block it is 0 up
/// to rounding.
const OPPOSITE: f64 = -1e-3;

/// Net force over weight, both as norms over all free vertices.
pub fn residual(system: &System, state: &State, workspace: &mut Workspace) -> f64 {
    let net = workspace.net_force(system, state);
    let force: f64 = net.iter().map(Vec3::norm_squared).sum();
    force.sqrt() / weight_norm(system)
}

/// Norm of the weights of the free vertices (N); without gravity that of their weights on earth.
pub fn weight_norm(system: &System) -> f64 {
    let free = system
        .rest
        .mass
        .iter()
        .zip(&system.prescribed.pinned)
        .filter(|&(_, &pinned)| !pinned);
    let mass: f64 = free.map(|(m, _)| m * m).sum();
    let gravity = if system.control.gravity.norm() > 0.0 {
        system.control.gravity.norm()
    } else {
        9.81
    };
    mass.sqrt() * gravity
}

/// Measures a state. `counted` marks the triangles whose strain counts, those away from gathers.
pub fn measure(
    system: &System,
    state: &State,
    workspace: &mut Workspace,
    counted: &[bool],
) -> Measures {
    let x = &state.positions;
    let strains: Vec<_> = (0..system.topology.triangles.len())
        .into_par_iter()
        .map(|t| {
            system.rest.elements[t].strain(system.topology.triangles[t].map(|v| x[v as usize]))
        })
        .collect();
    let mut measures = Measures {
        residual: residual(system, state, workspace),
        kinetic_energy: state.kinetic_energy(system),
        ..Measures::default()
    };
    for direction in 0..2 {
        let mut stretch: Vec<(f64, f64)> = Vec::new();
        for (t, strain) in strains.iter().enumerate() {
            let value = if direction == 0 {
                strain.warp
            } else {
                strain.weft
            };
            let compression = &mut measures.compression_max[direction];
            *compression = compression.max(-value);
            if counted.get(t).copied().unwrap_or(true) {
                stretch.push((value.max(0.0), system.rest.elements[t].area));
                measures.shear_max = measures.shear_max.max(strain.shear.abs());
            }
        }
        (
            measures.strain_max[direction],
            measures.strain_p99[direction],
        ) = top_of(&mut stretch);
    }
    let mesh = system.mesh(x);
    let on_body = measure_solids(system, state, &mesh, &mut measures);
    let tree = SurfaceTree::new(mesh);
    let own = self_intersections(system, &tree);
    measures.self_intersections = own.len();
    measures.layers = by_layer(system, tree.mesh(), &on_body, &own);
    measures
}

/// Measures the cloth against the solids, and returns the pairs of a cloth triangle and a solid triangle that intersect.
fn measure_solids(
    system: &System,
    state: &State,
    mesh: &TriangleMesh,
    measures: &mut Measures,
) -> Vec<[u32; 2]> {
    let policies = &system.policies;
    let meets = |vertices: &[u32], collider: usize| {
        !policies.ignores_solid(policies.object_of_sample(vertices), collider)
    };
    let edges = mesh.topology().edges;
    let mut on_body = Vec::new();
    let mut buried_area = 0.0;
    for (number, collider) in system.colliders.iter().enumerate() {
        let solid = collider.at(state.time);
        let pairs = solid.crossings(mesh);
        let pair_meets = |pair: &[u32; 2]| meets(&mesh.triangles[pair[0] as usize], number);
        let pairs: Vec<[u32; 2]> = pairs.into_iter().filter(pair_meets).collect();
        let mut buried = BTreeMap::new();
        for &[_, triangle] in &pairs {
            let area = buried.entry(triangle);
            let area = area.or_insert_with(|| solid.buried_area(triangle));
            measures.buried_intersections += usize::from(area.is_some());
        }
        buried_area += buried.values().flatten().sum::<f64>();
        on_body.extend(pairs);
        let nearest = |(v, &p): (usize, &Vec3)| {
            let is_met = meets(&[v as u32], number);
            (is_met.then(|| solid.closest_point(p))).flatten()
        };
        let closest: Vec<Option<ClosestPoint>> =
            (mesh.positions.par_iter().enumerate().map(nearest)).collect();
        let depths = closest.iter().flatten().map(|c| -c.signed_distance);
        measures.penetration_max = depths.fold(measures.penetration_max, f64::max);
        measures.edges_through_body += edges_through(&edges, &closest);
    }
    measures.body_intersections = on_body.len();
    if buried_area > 0.0 {
        let areas = system.colliders.iter().map(|c| c.surface.mesh().area());
        measures.buried_share = buried_area / areas.sum::<f64>();
    }
    on_body
}

/// Edges whose ends lie nearest to opposite sides of a solid, by the closest point of its surface to each vertex: they
/// cross its medial axis.
fn edges_through(edges: &[[u32; 2]], closest: &[Option<ClosestPoint>]) -> usize {
    let deep = |v: u32| {
        let closest = closest[v as usize].as_ref();
        closest.filter(|c| -c.signed_distance > DEPTH_OF_SIDES)
    };
    let goes_through = |&&[a, b]: &&[u32; 2]| match (deep(a), deep(b)) {
        (Some(a), Some(b)) => a.normal.dot(&b.normal) < OPPOSITE,
        _ => false,
    };
    edges.iter().filter(goes_through).count()
}

/// Pairs of cloth triangles that intersect and share no vertex, by exact predicates, without pairs of objects that
/// ignore each other.
pub(crate) fn self_intersections(system: &System, cloth: &SurfaceTree) -> Vec<[u32; 2]> {
    let mut pairs = cloth.self_intersections();
    let triangles = &cloth.mesh().triangles;
    pairs.retain(|pair| {
        let [a, b] = pair.map(|t| triangles[t as usize]);
        !system.policies.ignores(&a, &b)
    });
    pairs
}

/// The measures by layer; a triangle with corners of several layers counts with the innermost.
fn by_layer(
    system: &System,
    mesh: &TriangleMesh,
    on_body: &[[u32; 2]],
    own: &[[u32; 2]],
) -> Vec<LayerMeasures> {
    if system.layer.is_empty() {
        return Vec::new();
    }
    let surface = ClothSurface::new(system);
    let layer_of = |t: u32| {
        let corners = mesh.triangles[t as usize];
        corners.into_iter().map(|v| system.layer[v as usize]).min()
    };
    let layers = layers_of(&surface).into_iter().map(|layer| {
        let mut astray = Vec::new();
        layer_violations_of(&surface, layer, &mesh.positions, ORDER_REACH, &mut astray);
        let count = |found: &mut dyn Iterator<Item = bool>| found.filter(|&x| x).count();
        let of_both = |&[t, u]: &[u32; 2]| [layer_of(t), layer_of(u)];
        LayerMeasures {
            layer,
            body_intersections: count(
                &mut on_body.iter().map(|pair| layer_of(pair[0]) == Some(layer)),
            ),
            self_intersections: count(&mut own.iter().map(|p| of_both(p) == [Some(layer); 2])),
            outer_intersections: count(&mut own.iter().map(|pair| {
                let [t, u] = of_both(pair);
                t != u && t.min(u) == Some(layer)
            })),
            astray: astray.len(),
        }
    });
    layers.collect()
}

/// The largest value, and the 99th percentile by weight.
fn top_of(values: &mut [(f64, f64)]) -> (f64, f64) {
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = values.iter().map(|v| v.1).sum();
    let mut passed = 0.0;
    let mut p99 = 0.0;
    for &(value, weight) in values.iter() {
        passed += weight;
        p99 = value;
        if passed >= 0.99 * total {
            break;
        }
    }
    (values.last().map_or(0.0, |v| v.0), p99)
}

/// Stretch of each triangle: the larger of warp and weft, negative where both are compressed.
pub fn stretch_per_triangle(system: &System, positions: &[Vec3]) -> Vec<f64> {
    (0..system.topology.triangles.len())
        .map(|t| {
            let s = system.rest.elements[t]
                .strain(system.topology.triangles[t].map(|v| positions[v as usize]));
            s.warp.max(s.weft)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Cloth, Collider, Material, Motion, MotionKey, PairPolicies, SystemBuilder, Workspace,
    };
    use std::sync::Arc;

    /// An upright bar, 8 cm by 8.1 cm by 60 cm, round the origin.
    fn bar() -> Arc<SurfaceTree> {
        let corner = Vec3::new(0.04, 0.3, 0.0405);
        Arc::new(SurfaceTree::new(TriangleMesh::cuboid(-corner, corner)))
    }

    /// A square sheet of cells of 2.5 cm whose vertices lie at odd multiples of 1.25 cm of two coordinates, which
    /// `place` takes to space.
    fn sheet(place: impl Fn(f64, f64) -> Vec3) -> TriangleMesh {
        const COUNT: u32 = 10;
        let at = |k: u32| 0.025 * f64::from(k) - 0.1125;
        let vertices = (0..COUNT * COUNT).map(|v| place(at(v % COUNT), at(v / COUNT)));
        let cells = (0..COUNT * (COUNT - 1)).filter(|v| v % COUNT + 1 < COUNT);
        TriangleMesh {
            positions: vertices.collect(),
            triangles: cells
                .flat_map(|a| [[a, a + 1, a + COUNT + 1], [a, a + COUNT + 1, a + COUNT]])
                .collect(),
        }
    }

    fn measured(sheet: &TriangleMesh, bar: Collider, policies: PairPolicies) -> Measures {
        let cloth = Cloth::from_mesh("sheet", sheet, Material::default()).unwrap();
        let mut builder = SystemBuilder::new("sheet", &cloth).unwrap();
        builder.colliders = vec![bar];
        builder.policies = policies;
        let system = builder.build();
        let state = State::at_rest(&system, sheet.positions.clone());
        measure(&system, &state, &mut Workspace::default(), &[])
    }

    #[test]
    fn cloth_that_a_solid_goes_through_is_told_from_cloth_that_is_pressed_in() {
        let alone = PairPolicies::default;
        // Four vertices lie deep inside: two edges and a diagonal go from one broad side to the other.
        let skewered = sheet(|u, v| Vec3::new(u, 0.0, v));
        let found = measured(&skewered, Collider::new(bar()), alone());
        assert_eq!(found.edges_through_body, 3);
        assert!((found.penetration_max - 0.0275).abs() < 1e-12);

        // As deep inside, along one side.
        let pressed = sheet(|u, v| Vec3::new(0.0125, u, v));
        let found = measured(&pressed, Collider::new(bar()), alone());
        assert_eq!(found.edges_through_body, 0);
        assert!((found.penetration_max - 0.0275).abs() < 1e-12);
        assert!(found.body_intersections > 0);
    }

    #[test]
    fn a_solid_that_moved_counts_where_it_is_and_one_that_is_ignored_does_not() {
        let at = Vec3::new(0.4, 0.1, -0.2);
        let turned = MotionKey {
            time: 0.0,
            translation: at,
            rotation: Vec3::z() * std::f64::consts::FRAC_PI_2,
        };
        let motion = Motion {
            pivot: Vec3::zeros(),
            keys: vec![turned],
        };
        // The bar lies along x now.
        let skewered = sheet(|u, v| at + Vec3::new(0.0, u, v));
        let moved = || Collider::moving(bar(), motion.clone());
        let found = measured(&skewered, moved(), PairPolicies::default());
        assert_eq!(found.edges_through_body, 3);
        let objects = vec![0; skewered.positions.len()];
        let ignored = PairPolicies::new(objects, [], [(0, 0)]);
        let found = measured(&skewered, moved(), ignored);
        assert_eq!((found.edges_through_body, found.body_intersections), (0, 0));
    }
}
