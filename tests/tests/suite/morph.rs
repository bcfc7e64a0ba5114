//! Meshes of the shipped patterns follow edits of their points.

use toile_assembly::{MorphError, PieceMesh, PieceMeshes, mesh_pieces, morph, smallest_angle};
use toile_geometry::Vec2;
use toile_pattern::{Draft, plan};
use toile_session::{Command, Quality, SAMPLES, Session, Silent};
use toile_tests::random::Random;

fn corners(mesh: &PieceMesh, triangle: usize) -> [Vec2; 3] {
    mesh.triangles[triangle].map(|v| mesh.points[v as usize])
}

/// Smallest angle of each triangle (degrees), negative where it is wound the other way than `like`.
fn angles(mesh: &PieceMesh, like: &PieceMesh) -> Vec<f64> {
    let area = |[a, b, c]: [Vec2; 3]| (b - a).perp(&(c - a));
    let signed = |t| {
        let (new, old) = (corners(mesh, t), corners(like, t));
        smallest_angle(new).to_degrees() * (area(new) * area(old)).signum()
    };
    (0..mesh.triangles.len()).map(signed).collect()
}

/// Holds meshes that followed an edit to those they came from and to fresh ones; says how many panels
/// moved.
fn check(before: (&Draft, &PieceMeshes), after: (&Draft, &PieceMeshes)) -> usize {
    let mut moved = 0;
    assert_eq!(before.1.stitches, after.1.stitches);
    for (old, new) in before.1.pieces.iter().zip(&after.1.pieces) {
        assert_eq!(old.triangles, new.triangles);
        for (now, was) in angles(new, old).into_iter().zip(angles(old, old)) {
            assert!(now >= 15.0 - 1e-9 || now >= was - 1.0 - 1e-9, "{was} {now}");
        }
        let pieces = [(before.0, old), (after.0, new)].map(|(d, m)| &d.pieces[m.draft_piece]);
        if pieces[0] == pieces[1] && old.edge_fractions == new.edge_fractions {
            assert_eq!(old.points, new.points, "{}", pieces[1].name);
        } else {
            moved += 1;
        }
        // Samples are where the edited outline has them.
        for (edge, (list, fractions)) in
            (pieces[1].outline.iter()).zip(new.edge_vertices.iter().zip(&new.edge_fractions))
        {
            for (&v, &f) in list.iter().zip(fractions) {
                let point = edge.curve.sample(f, f, 0)[0];
                assert!((new.points[v as usize] - point).norm() < 1e-6);
            }
        }
    }
    moved
}

#[test]
fn shipped_patterns_follow_moves_of_a_few_millimetres() {
    let mut random = Random(36);
    for (path, _) in SAMPLES {
        let mut session = Session::new();
        let open = Command::open(path);
        session.execute(open, &mut Silent).unwrap();
        let before = session.draft();
        let meshes = mesh_pieces(&before, Quality::Fit.edge_length()).unwrap();
        let evaluation = session.evaluation();
        let points: Vec<_> = (evaluation.pattern().sheets.iter())
            .flat_map(|sheet| sheet.points.iter().map(|p| p.id))
            .collect();
        let (mut followed, mut refused, mut moved) = (0, 0, 0);
        for _ in 0..15 {
            let point = *random.one_of(&points).unwrap();
            let way = Vec2::new(random.between(-0.003, 0.003), random.between(-0.003, 0.003));
            let to = evaluation.point(point).unwrap() + way;
            let Ok(edits) = plan::move_point(&evaluation, point, to) else {
                continue;
            };
            session.preview(&edits).unwrap();
            let after = session.draft();
            match morph(&meshes, &after) {
                Ok(morphed) => {
                    moved += check((&before, &meshes), (&after, &morphed));
                    followed += 1;
                }
                // The kink of a side seam that was straight is an edge more, and a few others.
                Err(MorphError::NeedsRemesh(_)) => refused += 1,
                Err(error) => panic!("{path}: {error}"),
            }
        }
        assert!(
            followed >= 8 && moved > 0,
            "{path}: {followed} {refused} {moved}"
        );
    }
}
