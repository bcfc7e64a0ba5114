//! Both sides of every seam match vertex to vertex.

use crate::support::{draft, piece, polygon, poncho, skirt, span, tee, trousers};
use toile_assembly::{AssemblyError, PieceMeshes, mesh_pieces};
use toile_geometry::Vec2;
use toile_pattern::{Draft, Worn};

/// Piece and place of a vertex of the meshes.
fn find(meshes: &PieceMeshes, vertex: u32) -> (usize, Vec2) {
    let mut vertex = vertex as usize;
    for (k, mesh) in meshes.pieces.iter().enumerate() {
        if vertex < mesh.points.len() {
            return (k, mesh.points[vertex]);
        }
        vertex -= mesh.points.len();
    }
    panic!("no such vertex");
}

fn rectangle(width: f64, height: f64) -> Vec<toile_pattern::PieceEdge> {
    polygon(&[[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]])
}

fn two(
    a: (f64, f64),
    b: (f64, f64),
    seams: Vec<(Vec<toile_pattern::DraftSpan>, Vec<toile_pattern::DraftSpan>)>,
) -> Draft {
    draft(
        vec![
            piece(0, "a", rectangle(a.0, a.1), Worn::Automatic),
            piece(1, "b", rectangle(b.0, b.1), Worn::Automatic),
        ],
        seams,
    )
}

#[test]
fn sides_of_different_length_get_the_same_samples_at_the_same_shares() {
    let draft = two(
        (0.30, 0.1),
        (0.36, 0.1),
        vec![(vec![span(0, 0, 0.0, 1.0)], vec![span(1, 0, 1.0, 0.0)])],
    );
    let meshes = mesh_pieces(&draft, 0.01).unwrap();
    // 33 centimetres in the mean.
    assert_eq!(meshes.stitches.len(), 34);
    for stitch in &meshes.stitches {
        let [(p, a), (q, b)] = stitch.vertices.map(|v| find(&meshes, v));
        assert_eq!((p, q), (0, 1));
        assert!((a.y, b.y) == (0.0, 0.0));
        assert!((a.x / 0.30 + b.x / 0.36 - 1.0).abs() < 1e-9, "{a} {b}");
    }
}

#[test]
fn a_gathered_seam_counts_by_its_longer_side() {
    let mut draft = two(
        (0.20, 0.1),
        (0.40, 0.1),
        vec![(vec![span(0, 0, 0.0, 1.0)], vec![span(1, 0, 1.0, 0.0)])],
    );
    draft.seams[0].gathered = true;
    assert_eq!(mesh_pieces(&draft, 0.01).unwrap().stitches.len(), 41);
}

#[test]
fn corners_of_one_side_are_vertices_of_the_other() {
    // Two edges of b round a corner are sewn to one edge of a: 0.11 + 0.2.
    let draft = two(
        (0.31, 0.2),
        (0.11, 0.2),
        vec![(
            vec![span(0, 0, 0.0, 1.0)],
            vec![span(1, 0, 0.0, 1.0), span(1, 1, 0.0, 1.0)],
        )],
    );
    let meshes = mesh_pieces(&draft, 0.01).unwrap();
    let corner = meshes.stitches.iter().any(|s| {
        let [(_, a), (_, b)] = s.vertices.map(|v| find(&meshes, v));
        (a - Vec2::new(0.11, 0.0)).norm() < 1e-9 && (b - Vec2::new(0.11, 0.0)).norm() < 1e-9
    });
    assert!(corner);
    assert_eq!(meshes.stitches.len(), 32);
}

#[test]
fn where_a_chain_passes_over_another_seam_all_vertices_meet() {
    // c is sewn to the bottoms of a and b, which are sewn together at their sides.
    let mut draft = two(
        (0.2, 0.1),
        (0.2, 0.1),
        vec![
            (vec![span(0, 1, 0.0, 1.0)], vec![span(1, 3, 1.0, 0.0)]),
            (
                vec![span(0, 0, 0.0, 1.0), span(1, 0, 0.0, 1.0)],
                vec![span(2, 2, 1.0, 0.0)],
            ),
        ],
    );
    draft
        .pieces
        .push(piece(2, "c", rectangle(0.4, 0.05), Worn::Automatic));
    let meshes = mesh_pieces(&draft, 0.02).unwrap();
    let at = |k: usize, p: Vec2| {
        let first: usize = meshes.pieces[..k].iter().map(|m| m.points.len()).sum();
        let v = meshes.pieces[k]
            .points
            .iter()
            .position(|q| (p - q).norm() < 1e-9);
        (first + v.unwrap()) as u32
    };
    let meeting = [
        at(0, Vec2::new(0.2, 0.0)),
        at(1, Vec2::zeros()),
        at(2, Vec2::new(0.2, 0.05)),
    ];
    for pair in [[0, 1], [0, 2], [1, 2]] {
        let wanted = pair.map(|k| meeting[k]);
        let found = meshes
            .stitches
            .iter()
            .any(|s| s.vertices == wanted || s.vertices == [wanted[1], wanted[0]]);
        assert!(found, "{pair:?}");
    }
}

#[test]
fn a_span_in_two_seams_carries_the_samples_of_both() {
    // a's edge is sewn to all of b and, at its first half, to c.
    let mut draft = two(
        (0.3, 0.1),
        (0.3, 0.1),
        vec![
            (vec![span(0, 0, 0.0, 1.0)], vec![span(1, 0, 1.0, 0.0)]),
            (vec![span(0, 0, 0.0, 0.5)], vec![span(2, 0, 1.0, 0.0)]),
        ],
    );
    draft
        .pieces
        .push(piece(2, "c", rectangle(0.17, 0.1), Worn::Automatic));
    let meshes = mesh_pieces(&draft, 0.01).unwrap();
    let bottom = |k: usize| {
        meshes.pieces[k].edge_vertices[0]
            .iter()
            .map(|&v| meshes.pieces[k].points[v as usize].x)
            .collect::<Vec<f64>>()
    };
    let (a, b, c) = (bottom(0), bottom(1), bottom(2));
    assert_eq!(a.len(), b.len());
    for (x, y) in a.iter().zip(b.iter().rev()) {
        assert!((x + y - 0.3).abs() < 1e-9);
    }
    let half = a.iter().position(|x| (x - 0.15).abs() < 1e-9).unwrap();
    assert_eq!(half + 1, c.len());
}

#[test]
fn a_dart_keeps_its_apex_single() {
    let outline = polygon(&[
        [0.0, 0.0],
        [0.2, 0.0],
        [0.2, 0.3],
        [0.11, 0.3],
        [0.1, 0.2],
        [0.09, 0.3],
        [0.0, 0.3],
    ]);
    let draft = draft(
        vec![piece(0, "darted", outline, Worn::Automatic)],
        vec![(vec![span(0, 3, 0.0, 1.0)], vec![span(0, 4, 1.0, 0.0)])],
    );
    let meshes = mesh_pieces(&draft, 0.01).unwrap();
    assert_eq!(meshes.stitches.len(), 10);
    for stitch in &meshes.stitches {
        let [(_, a), (_, b)] = stitch.vertices.map(|v| find(&meshes, v));
        assert!((a.x + b.x - 0.2).abs() < 1e-9 && (a.y - b.y).abs() < 1e-9);
        assert!(a.x > 0.1 && b.x < 0.1);
    }
}

#[test]
fn an_edge_folded_on_itself_matches_its_own_mirror_image() {
    let draft = draft(
        vec![piece(0, "folded", rectangle(0.3, 0.1), Worn::Automatic)],
        vec![(vec![span(0, 0, 0.0, 0.5)], vec![span(0, 0, 1.0, 0.5)])],
    );
    let meshes = mesh_pieces(&draft, 0.01).unwrap();
    assert!(!meshes.stitches.is_empty());
    for stitch in &meshes.stitches {
        let [(_, a), (_, b)] = stitch.vertices.map(|v| find(&meshes, v));
        assert!((a.x + b.x - 0.3).abs() < 1e-9);
    }
}

#[test]
fn the_same_draft_gives_the_same_meshes() {
    for make in [tee, trousers, skirt, poncho] {
        let (a, b) = (
            mesh_pieces(&make(), 0.02).unwrap(),
            mesh_pieces(&make(), 0.02).unwrap(),
        );
        assert_eq!(a.stitches, b.stitches);
        for (x, y) in a.pieces.iter().zip(&b.pieces) {
            assert_eq!(x.points, y.points);
            assert_eq!(x.triangles, y.triangles);
        }
    }
}

#[test]
fn bad_seams_and_outlines_are_refused_by_name() {
    let missing = two(
        (0.3, 0.1),
        (0.3, 0.1),
        vec![(vec![span(0, 9, 0.0, 1.0)], vec![span(1, 0, 1.0, 0.0)])],
    );
    let error = mesh_pieces(&missing, 0.01).unwrap_err();
    assert!(
        error.to_string().contains("seam 0") && error.to_string().contains("edge 9"),
        "{error}"
    );
    let crossed = draft(
        vec![piece(
            0,
            "bow",
            polygon(&[[0.0, 0.0], [0.2, 0.2], [0.2, 0.0], [0.0, 0.2]]),
            Worn::Automatic,
        )],
        vec![],
    );
    let error = mesh_pieces(&crossed, 0.01).unwrap_err();
    assert!(
        matches!(&error, AssemblyError::Outline { piece, .. } if piece == "bow"),
        "{error}"
    );
    assert_eq!(
        mesh_pieces(&tee(), f64::NAN).unwrap_err().to_string(),
        "edge length NaN m cannot be used; give one from 0.5 mm to 1 m"
    );
    assert!(matches!(
        mesh_pieces(&Draft::default(), 0.01),
        Err(AssemblyError::Empty)
    ));
    let mut open = tee();
    open.pieces[0].outline.pop();
    let error = mesh_pieces(&open, 0.01).unwrap_err();
    assert!(error.to_string().contains("close the outline"), "{error}");
    let mut wild = tee();
    wild.pieces[1].outline[0].curve = toile_geometry::Curve::Line {
        start: Vec2::new(f64::NAN, 0.0),
        end: Vec2::zeros(),
    };
    assert!(mesh_pieces(&wild, 0.01).is_err());
}
