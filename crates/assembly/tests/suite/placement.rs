//! Garments stand round the body: outside the skin, not crossing, not stretched.

use crate::support::{self, Doll, piece, polygon, poncho, skirt, tee, trousers, worn};
use toile_assembly::{Assembled, AssemblyOptions, assemble, sanity};
use toile_geometry::{Rigid, Vec3};
use toile_pattern::{BodyPart, Draft, Facing, Worn};

fn made(draft: &Draft, doll: &Doll) -> Assembled {
    assemble(draft, &doll.body(), &AssemblyOptions { edge_length: 0.02 }).unwrap()
}

fn centre(assembled: &Assembled, name: &str) -> Vec3 {
    let panel = assembled
        .garment
        .panels
        .iter()
        .find(|p| p.name == name)
        .unwrap();
    let points = &assembled.garment.positions[panel.vertices.clone()];
    points.iter().sum::<Vec3>() / points.len() as f64
}

#[test]
fn the_doll_is_closed_and_outward() {
    let doll = Doll::new();
    assert!(doll.tree.mesh().is_closed_and_oriented());
    assert!(doll.tree.mesh().volume() > 0.04);
}

#[test]
fn garments_keep_off_the_skin_and_off_each_other() {
    let doll = Doll::new();
    for (name, draft) in [
        ("tee", tee()),
        ("trousers", trousers()),
        ("skirt", skirt()),
        ("poncho", poncho()),
    ] {
        let made = made(&draft, &doll);
        assert_eq!(made.body_intersections, 0, "{name}: {:?}", made.diagnostics);
        assert_eq!(
            made.panel_intersections, 0,
            "{name}: {:?}",
            made.diagnostics
        );
        for &p in &made.garment.positions {
            let skin = doll.tree.closest_point(p, f64::INFINITY).unwrap();
            assert!(
                skin.signed_distance > 0.004,
                "{name}: {p} {}",
                skin.signed_distance
            );
        }
        let report = sanity(&draft, &made.garment);
        assert!(report.is_sound(), "{name}: {report:?}");
        assert_eq!(report.components, 1, "{name}");
    }
}

#[test]
fn wrapping_keeps_lengths() {
    let doll = Doll::new();
    for draft in [tee(), trousers(), skirt()] {
        let made = made(&draft, &doll);
        let garment = &made.garment;
        for t in &garment.triangles {
            for k in 0..3 {
                let (a, b) = (t[k] as usize, t[(k + 1) % 3] as usize);
                let flat = (garment.flat[a] - garment.flat[b]).norm();
                let bent = (garment.positions[a] - garment.positions[b]).norm();
                assert!(
                    bent <= flat * (1.0 + 1e-9) && bent > 0.9 * flat,
                    "{flat} {bent}"
                );
            }
        }
    }
}

#[test]
fn right_sides_face_outward() {
    let doll = Doll::new();
    for draft in [tee(), trousers(), skirt()] {
        let made = made(&draft, &doll);
        let garment = &made.garment;
        for panel in &garment.panels {
            let mut outward = 0.0;
            for t in &garment.triangles[panel.triangles.clone()] {
                let [a, b, c] = t.map(|v| garment.positions[v as usize]);
                let middle = (a + b + c) / 3.0;
                let skin = doll.tree.closest_point(middle, f64::INFINITY).unwrap();
                outward += (b - a).cross(&(c - a)).dot(&(middle - skin.point));
            }
            assert!(outward > 0.0, "{}", panel.name);
        }
    }
}

#[test]
fn pieces_go_where_they_are_worn() {
    let doll = Doll::new();
    let shirt = made(&tee(), &doll);
    assert!(centre(&shirt, "front").z > 0.05 && centre(&shirt, "back").z < -0.05);
    assert!(centre(&shirt, "left sleeve").x > 0.2 && centre(&shirt, "right sleeve").x < -0.2);
    let top = shirt.garment.positions.iter().map(|p| p.y);
    assert!((top.fold(0.0, f64::max) - 1.43).abs() < 0.02);
    let legs = made(&trousers(), &doll);
    assert!(centre(&legs, "front left").x > 0.05 && centre(&legs, "back right").x < -0.05);
    assert!((centre(&legs, "waistband").y - 1.04).abs() < 0.04);
    let skirt = made(&skirt(), &doll);
    assert!(centre(&skirt, "skirt front").y < centre(&skirt, "waistband").y - 0.2);
}

#[test]
fn a_poncho_surrounds_the_neck() {
    let doll = Doll::new();
    let made = made(&poncho(), &doll);
    let height = made.garment.positions[0].y;
    assert!(made.garment.positions.iter().all(|p| p.y == height));
    assert!((1.38..1.6).contains(&height), "{height}");
    let neck = Vec3::new(0.0, height, 0.01);
    let nearest = made
        .garment
        .positions
        .iter()
        .map(|p| (p - neck).norm())
        .fold(f64::INFINITY, f64::min);
    assert!(nearest > 0.1, "{nearest}");
}

#[test]
fn unknown_pieces_find_their_place_from_names_and_seams() {
    let doll = Doll::new();
    let mut draft = tee();
    for piece in &mut draft.pieces {
        piece.worn = Worn::Automatic;
    }
    let named = made(&draft, &doll);
    assert!(centre(&named, "front").z > 0.05 && centre(&named, "back").z < -0.05);
    assert!(centre(&named, "left sleeve").x > 0.2);
    assert_eq!(named.diagnostics.len(), 4);
    for (k, piece) in draft.pieces.iter_mut().enumerate() {
        piece.name = format!("thing {k}");
    }
    let nameless = made(&draft, &doll);
    assert!(centre(&nameless, "thing 0").z * centre(&nameless, "thing 1").z < 0.0);
}

#[test]
fn placed_panels_stay_unless_they_cross_the_body() {
    let doll = Doll::new();
    let square = || polygon(&[[-0.1, 0.0], [0.1, 0.0], [0.1, 0.2], [-0.1, 0.2]]);
    let at = |z: f64| Worn::Placed(Rigid::translation(0.0, 1.0, z));
    let draft = support::draft(
        vec![
            piece(0, "clear", square(), at(0.3)),
            piece(1, "inside", square(), at(0.05)),
        ],
        vec![],
    );
    let made = made(&draft, &doll);
    assert_eq!(centre(&made, "clear").z, 0.3);
    let pushed = centre(&made, "inside").z;
    assert!(pushed > 0.1 && pushed < 0.2, "{pushed}");
    assert_eq!(made.body_intersections, 0);
    assert!(made.diagnostics.iter().any(|d| d.place == "inside"));
}

#[test]
fn levels_are_heights_of_the_origin() {
    let doll = Doll::new();
    let band = polygon(&[[-0.5, 0.0], [0.5, 0.0], [0.5, 0.04], [-0.5, 0.04]]);
    let mut cloth = piece(0, "band", band, worn(BodyPart::Trunk, Facing::Around));
    cloth.worn = Worn::Wrapped {
        part: BodyPart::Trunk,
        facing: Facing::Around,
        level: Some(0.9),
    };
    let made = made(&support::draft(vec![cloth], vec![]), &doll);
    let low = made.garment.positions.iter().map(|p| p.y);
    assert!((low.fold(f64::INFINITY, f64::min) - 0.9).abs() < 1e-9);
}

#[test]
fn the_same_draft_stands_the_same() {
    let doll = Doll::new();
    let (a, b) = (made(&tee(), &doll), made(&tee(), &doll));
    assert_eq!(a.garment.positions, b.garment.positions);
    assert_eq!(a.diagnostics, b.diagnostics);
}

#[test]
fn a_very_wide_skirt_is_laid_in_folds_between_body_and_arms() {
    let doll = Doll::new();
    let panel = polygon(&[[-1.1, 0.0], [1.1, 0.0], [1.1, 0.5], [-1.1, 0.5]]);
    let draft = support::draft(
        vec![
            piece(
                0,
                "front",
                panel.clone(),
                worn(BodyPart::Trunk, Facing::Front),
            ),
            piece(1, "back", panel, worn(BodyPart::Trunk, Facing::Back)),
        ],
        vec![
            (
                vec![support::span(0, 1, 0.0, 1.0)],
                vec![support::span(1, 3, 1.0, 0.0)],
            ),
            (
                vec![support::span(0, 3, 0.0, 1.0)],
                vec![support::span(1, 1, 1.0, 0.0)],
            ),
        ],
    );
    let made = made(&draft, &doll);
    assert_eq!(made.body_intersections, 0, "{:?}", made.diagnostics);
    assert_eq!(made.panel_intersections, 0, "{:?}", made.diagnostics);
}

#[test]
fn a_collar_stands_round_the_neck() {
    let doll = Doll::new();
    let mut draft = tee();
    let band = polygon(&[[-0.21, 0.0], [0.21, 0.0], [0.21, 0.06], [-0.21, 0.06]]);
    draft.pieces.push(piece(
        4,
        "collar",
        band,
        worn(BodyPart::Head, Facing::Around),
    ));
    let span = support::span;
    // Closed at the back: from the middle of the back neck once round by the wearer's right.
    let neck = vec![
        span(1, 4, 0.5, 0.0),
        span(0, 4, 1.0, 0.0),
        span(1, 4, 1.0, 0.5),
    ];
    draft
        .seams
        .push(support::seam(10, vec![span(4, 0, 0.0, 1.0)], neck));
    draft.seams.push(support::seam(
        11,
        vec![span(4, 1, 0.0, 1.0)],
        vec![span(4, 3, 1.0, 0.0)],
    ));
    let made = made(&draft, &doll);
    assert_eq!(made.body_intersections, 0, "{:?}", made.diagnostics);
    assert_eq!(made.panel_intersections, 0, "{:?}", made.diagnostics);
    let middle = centre(&made, "collar");
    assert!(middle.x.abs() < 0.01 && middle.z.abs() < 0.06, "{middle}");
    assert!((1.38..1.6).contains(&middle.y), "{middle}");
    let report = sanity(&draft, &made.garment);
    assert!(report.is_sound(), "{report:?}");
}
