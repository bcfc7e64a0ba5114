//! Triangles are nearly equilateral and of the asked size.

use crate::support::{self, draft, piece, polygon, poncho, skirt, tee, trousers};
use toile_assembly::{MeshQuality, combine, mesh_pieces};
use toile_geometry::Curve;
use toile_pattern::{Draft, LineId, PieceLine, Worn};

fn quality(draft: &Draft, edge_length: f64) -> MeshQuality {
    let meshes = mesh_pieces(draft, edge_length).unwrap();
    let parts: Vec<MeshQuality> = meshes.pieces.iter().map(|m| m.quality()).collect();
    combine(&parts)
}

fn check(draft: &Draft, edge_length: f64) {
    let q = quality(draft, edge_length);
    let under_20 = q.under_20 as f64 / q.triangles as f64;
    assert!(under_20 <= 1e-3, "{}: {q:?}", draft.name);
    assert!(
        q.smallest_free_angle.to_degrees() > 10.0,
        "{}: {q:?}",
        draft.name
    );
    assert!(
        (q.mean_edge / edge_length - 1.0).abs() < 0.15,
        "{}: {q:?}",
        draft.name
    );
}

#[test]
fn garments_mesh_well_at_every_size() {
    for make in [tee, trousers, skirt, poncho] {
        for edge_length in [0.007, 0.01, 0.02] {
            check(&make(), edge_length);
        }
    }
}

#[test]
fn the_inside_is_close_to_equilateral() {
    let q = quality(&tee(), 0.01);
    assert!(q.mean_smallest_angle.to_degrees() > 54.0, "{q:?}");
    assert!(q.smallest_angle.to_degrees() > 25.0, "{q:?}");
    assert_eq!(q.bridging, 0);
}

#[test]
fn tiny_edges_beside_long_ones_grade_gently() {
    let outline = polygon(&[
        [0.0, 0.0],
        [0.3, 0.0],
        [0.3, 0.2],
        [0.203, 0.2],
        [0.2, 0.197],
        [0.196, 0.2],
        [0.0, 0.2],
    ]);
    check(
        &draft(vec![piece(0, "nicked", outline, Worn::Automatic)], vec![]),
        0.01,
    );
}

#[test]
fn narrow_strips_get_a_row_of_inner_vertices() {
    for width in [0.011, 0.015, 0.02, 0.03] {
        let outline = polygon(&[[0.0, 0.0], [0.5, 0.0], [0.5, width], [0.0, width]]);
        let q = quality(
            &draft(vec![piece(0, "strip", outline, Worn::Automatic)], vec![]),
            0.01,
        );
        assert!(q.smallest_angle.to_degrees() > 20.0, "{width}: {q:?}");
        assert_eq!(q.bridging, 0, "{width}: {q:?}");
    }
}

#[test]
fn areas_are_kept_and_windings_too() {
    let mut draft = tee();
    let mut clockwise: Vec<Curve> = draft.pieces[1]
        .outline
        .iter()
        .map(|e| e.curve.reversed())
        .collect();
    clockwise.reverse();
    draft.pieces[1].outline = support::edges(&clockwise);
    draft.seams.clear();
    let meshes = mesh_pieces(&draft, 0.01).unwrap();
    let signed = |k: usize| -> f64 {
        let mesh = &meshes.pieces[k];
        mesh.triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|v| mesh.points[v as usize]);
                0.5 * (b - a).perp(&(c - a))
            })
            .sum()
    };
    assert!(signed(0) > 0.0 && signed(1) < 0.0);
    assert!((signed(0) - meshes.pieces[0].area()).abs() < 1e-12);
    // A disc of radius 0.6 with a hole of radius 0.14.
    let area = mesh_pieces(&poncho(), 0.01).unwrap().pieces[0].area();
    let exact = std::f64::consts::PI * (0.36 - 0.0196);
    assert!((area / exact - 1.0).abs() < 1e-3, "{area} {exact}");
}

#[test]
fn internal_lines_are_edges_of_the_mesh() {
    let outline = polygon(&[[0.0, 0.0], [0.3, 0.0], [0.3, 0.3], [0.0, 0.3]]);
    let mut cloth = piece(0, "lined", outline, Worn::Automatic);
    cloth.internal_lines.push(PieceLine {
        name: toile_pattern::Name::Drawn(LineId(0)),
        curves: vec![Curve::Line {
            start: [0.05, 0.1].into(),
            end: [0.25, 0.2].into(),
        }],
    });
    let draft = draft(vec![cloth], vec![]);
    check(&draft, 0.01);
    let meshes = mesh_pieces(&draft, 0.01).unwrap();
    let mesh = &meshes.pieces[0];
    let on_line = |v: u32| {
        let p = mesh.points[v as usize];
        (0.05..=0.25).contains(&p.x) && (p.y - (0.1 + 0.5 * (p.x - 0.05))).abs() < 1e-12
    };
    let mut length = 0.0;
    for t in &mesh.triangles {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            if a < b && on_line(a) && on_line(b) {
                length += (mesh.points[a as usize] - mesh.points[b as usize]).norm();
            }
        }
    }
    assert!((length - 0.05f64.sqrt()).abs() < 1e-9, "{length}");
}

#[test]
fn internal_lines_that_leave_the_piece_crease_what_lies_inside() {
    let outline = polygon(&[[0.0, 0.0], [0.3, 0.0], [0.3, 0.3], [0.0, 0.3]]);
    let mut cloth = piece(0, "lined", outline, Worn::Automatic);
    let line = |number, ends: [[f64; 2]; 2]| PieceLine {
        name: toile_pattern::Name::Drawn(LineId(number)),
        curves: vec![Curve::Line {
            start: ends[0].into(),
            end: ends[1].into(),
        }],
    };
    cloth
        .internal_lines
        .push(line(0, [[-0.1, 0.1], [0.4, 0.1]]));
    cloth.internal_lines.push(line(1, [[0.5, 0.1], [0.6, 0.1]]));
    cloth
        .internal_lines
        .push(line(2, [[0.3, 0.05], [0.3, 0.25]]));
    let draft = draft(vec![cloth], vec![]);
    check(&draft, 0.01);
    let mesh = &mesh_pieces(&draft, 0.01).unwrap().pieces[0];
    assert!((mesh.area() - 0.09).abs() < 1e-12);
    let on_line = mesh.points.iter().filter(|p| (p.y - 0.1).abs() < 1e-12);
    assert!(on_line.count() > 25);
}
