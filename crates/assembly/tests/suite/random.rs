//! Any outline is meshed soundly or refused: never a panic.

use crate::support::{draft, edges, piece, polygon, span};
use proptest::prelude::*;
use toile_assembly::{mesh_pieces, sanity};
use toile_geometry::{Curve, Vec2};
use toile_pattern::Worn;

fn corners() -> impl Strategy<Value = Vec<[f64; 2]>> {
    let anywhere = prop::collection::vec([-0.3..0.3f64, -0.3..0.3f64], 0..8);
    // Star-shaped outlines with spikes and slivers.
    let star = prop::collection::vec((0.001..0.3f64, 0.05..1.0f64), 3..16).prop_map(|rays| {
        let total: f64 = rays.iter().map(|r| r.1).sum();
        let mut angle = 0.0;
        rays.iter()
            .map(|&(r, share)| {
                angle += share / total * std::f64::consts::TAU;
                [r * angle.cos(), r * angle.sin()]
            })
            .collect()
    });
    let needle =
        (0.05..0.5f64, 1e-6..0.02f64).prop_map(|(l, w)| vec![[0.0, 0.0], [l, 0.0], [l, w]]);
    prop_oneof![anywhere, star, needle]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn outlines_are_meshed_exactly_or_refused(
        corners in corners(),
        bulges in prop::collection::vec(-1.2..1.2f64, 16),
        curved in any::<bool>(),
        edge_length in 0.02..0.06f64,
    ) {
        let count = corners.len();
        let outline = if curved {
            let curves: Vec<Curve> = (0..count).map(|k| Curve::Arc {
                start: corners[k].into(),
                end: corners[(k + 1) % count].into(),
                bulge: 0.3 * bulges[k % 16],
            }).collect();
            edges(&curves)
        } else {
            polygon(&corners)
        };
        let draft = draft(vec![piece(0, "random", outline, Worn::Automatic)], vec![]);
        if let Ok(meshes) = mesh_pieces(&draft, edge_length) {
            let mesh = &meshes.pieces[0];
            let ring: Vec<Vec2> = mesh.loops[0].iter().map(|&v| mesh.points[v as usize]).collect();
            let area: f64 = (0..ring.len())
                .map(|k| 0.5 * ring[k].perp(&ring[(k + 1) % ring.len()]))
                .sum();
            prop_assert!((mesh.area() - area.abs()).abs() <= 1e-9 * (1.0 + area.abs()));
            for t in &mesh.triangles {
                let [a, b, c] = t.map(|v| mesh.points[v as usize]);
                prop_assert!((b - a).perp(&(c - a)) * area > 0.0);
            }
            // A disc: as many vertices as edges and one more, triangles counted.
            let euler = mesh.points.len() as i64 + mesh.triangles.len() as i64;
            let boundary = ring.len() as i64;
            let edge_count = (3 * mesh.triangles.len() as i64 + boundary) / 2;
            prop_assert_eq!(euler - edge_count, 1);
        }
    }

    #[test]
    fn random_seams_never_panic_and_sew_one_to_one(
        spans in prop::collection::vec((0..2usize, 0..4usize, 0.0..1.0f64, 0.0..1.0f64), 2..10),
        cut in 1..4usize,
        gathered in any::<bool>(),
    ) {
        let rectangle = |w: f64| polygon(&[[0.0, 0.0], [w, 0.0], [w, 0.2], [0.0, 0.2]]);
        let all: Vec<_> = spans.iter().map(|&(p, e, f, t)| span(p, e, f, t)).collect();
        let seams: Vec<_> = all
            .chunks(2 * cut)
            .filter(|c| c.len() >= 2)
            .map(|c| (c[..c.len() / 2].to_vec(), c[c.len() / 2..].to_vec()))
            .collect();
        let pieces = vec![
            piece(0, "a", rectangle(0.3), Worn::Automatic),
            piece(1, "b", rectangle(0.25), Worn::Automatic),
        ];
        let mut draft = draft(pieces, seams);
        for seam in &mut draft.seams {
            seam.gathered = gathered;
        }
        if let Ok(meshes) = mesh_pieces(&draft, 0.03) {
            let count: usize = meshes.pieces.iter().map(|m| m.points.len()).sum();
            for stitch in &meshes.stitches {
                prop_assert!(stitch.vertices.iter().all(|&v| (v as usize) < count));
            }
            let garment = toile_assembly::Garment {
                flat: meshes.pieces.iter().flat_map(|m| m.points.clone()).collect(),
                stitches: meshes.stitches,
                ..Default::default()
            };
            prop_assert_eq!(sanity(&draft, &garment).components, 0);
        }
    }
}
