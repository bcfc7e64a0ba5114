//! Rings and sectors of rings stand round the trunk as cones, level with the band they are sewn to.

use crate::support::{Doll, draft, edges, piece, polygon, span, worn};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use toile_assembly::{Assembled, AssemblyOptions, assemble};
use toile_geometry::{Curve, Vec2};
use toile_pattern::{BodyPart, Draft, DraftSpan, Facing, Piece, Worn};

/// Length round the waist, and of the skirt below it (m).
const WAIST: f64 = 0.8;
const LENGTH: f64 = 0.45;

fn polar(radius: f64, angle: f64) -> Vec2 {
    Vec2::new(radius * angle.cos(), radius * angle.sin())
}

fn arc(radius: f64, [from, to]: [f64; 2]) -> Curve {
    Curve::Arc {
        start: polar(radius, from),
        end: polar(radius, to),
        bulge: ((to - from) / 4.0).tan(),
    }
}

fn band(number: u32) -> Piece {
    let outline = polygon(&[[0.0, 0.0], [WAIST, 0.0], [WAIST, 0.04], [0.0, 0.04]]);
    let around = worn(BodyPart::Trunk, Facing::Around);
    piece(number, "waistband", outline, around)
}

/// A full circle skirt of one ring on a band. The hole is walked by the seam one way or the other.
fn ring(facing: Facing, is_turned: bool) -> Draft {
    let [hole, hem] = [WAIST / TAU, WAIST / TAU + LENGTH];
    let [top, bottom] = [FRAC_PI_2, -FRAC_PI_2];
    let outline = edges(&[arc(hem, [bottom, top]), arc(hem, [top, 3.0 * FRAC_PI_2])]);
    let mut skirt = piece(0, "skirt", outline, worn(BodyPart::Trunk, facing));
    skirt.holes.push(edges(&[
        arc(hole, [top, bottom]),
        arc(hole, [bottom, bottom - PI]),
    ]));
    let whole = |piece, edge, back: bool| match back {
        true => span(piece, edge, 1.0, 0.0),
        false => span(piece, edge, 0.0, 1.0),
    };
    let around = match is_turned {
        true => vec![whole(0, 2, false), whole(0, 3, false)],
        false => vec![whole(0, 3, true), whole(0, 2, true)],
    };
    let seams = vec![
        (vec![whole(1, 1, false)], vec![whole(1, 3, true)]),
        (vec![whole(1, 0, false)], around),
    ];
    draft(vec![skirt, band(1)], seams)
}

/// A skirt of so many sectors that make an angle together, on a band or by itself.
fn sectors(count: usize, whole: f64, has_band: bool) -> Draft {
    let [inner, hem] = [WAIST / whole, WAIST / whole + LENGTH];
    let half = 0.5 * whole / count as f64;
    let [left, right] = [-FRAC_PI_2 - half, -FRAC_PI_2 + half];
    let line = |from: f64, to: f64, angle: f64| Curve::Line {
        start: polar(from, angle),
        end: polar(to, angle),
    };
    let outline = [
        arc(hem, [left, right]),
        line(hem, inner, right),
        arc(inner, [right, left]),
        line(inner, hem, left),
    ];
    let mut pieces: Vec<Piece> = (0..count)
        .map(|k| {
            let name = format!("skirt {k}");
            piece(k as u32, &name, edges(&outline), Worn::Automatic)
        })
        .collect();
    let along = |piece, edge| vec![span(piece, edge, 0.0, 1.0)];
    let against = |piece, edge| vec![span(piece, edge, 1.0, 0.0)];
    let mut seams: Vec<(Vec<DraftSpan>, Vec<DraftSpan>)> = (0..count)
        .map(|k| (along(k, 1), against((k + 1) % count, 3)))
        .collect();
    if has_band {
        pieces.push(band(count as u32));
        seams.push((along(count, 1), against(count, 3)));
        seams.push((
            along(count, 0),
            (0..count).flat_map(|k| against(k, 2)).collect(),
        ));
    }
    draft(pieces, seams)
}

fn made(draft: &Draft, doll: &Doll) -> Assembled {
    assemble(draft, &doll.body(), &AssemblyOptions { edge_length: 0.025 }).unwrap()
}

/// Holds a skirt to standing round the waist: clear of the skin, with its inner edge level at the waist and its hem
/// below, all round the trunk. Sewn edges lie less than `apart` from each other (m).
fn stands_apart(name: &str, made: &Assembled, doll: &Doll, apart: f64) {
    let skirts = made
        .garment
        .panels
        .iter()
        .filter(|p| p.name.contains("skirt"));
    let points: Vec<_> = skirts
        .flat_map(|p| made.garment.positions[p.vertices.clone()].iter())
        .collect();
    for p in &points {
        let skin = doll.tree.closest_point(**p, f64::INFINITY).unwrap();
        assert!(
            skin.signed_distance > 0.004,
            "{name}: {p} {}",
            skin.signed_distance
        );
    }
    assert_eq!(made.body_intersections, 0, "{name}: {:?}", made.diagnostics);
    assert_eq!(
        made.panel_intersections, 0,
        "{name}: {:?}",
        made.diagnostics
    );
    let waist = doll.body().levels.waist;
    let top = points.iter().map(|p| p.y).fold(f64::MIN, f64::max);
    assert!(
        (top - waist).abs() < 0.06,
        "{name}: from {top}, waist {waist}"
    );
    let lowest = points.iter().map(|p| p.y).fold(f64::MAX, f64::min);
    assert!(
        (0.0..top - 0.6 * LENGTH).contains(&lowest),
        "{name}: {lowest}"
    );
    for quarter in 0..4 {
        let side = |p: &toile_geometry::Vec3| (p.x.atan2(p.z) / FRAC_PI_2).rem_euclid(4.0) as usize;
        let count = points.iter().filter(|p| side(p) == quarter).count();
        assert!(
            8 * count > points.len(),
            "{name}: {count} of {}",
            points.len()
        );
    }
    for stitch in &made.garment.stitches {
        let [a, b] = stitch.vertices.map(|v| made.garment.positions[v as usize]);
        assert!((a - b).norm() < apart, "{name}: {a} {b}");
    }
}

/// Holds a flared skirt to standing round the waist with sewn edges near each other.
fn stands_round(name: &str, made: &Assembled, doll: &Doll) {
    stands_apart(name, made, doll, 0.16);
}

#[test]
fn a_ring_goes_round_the_body_at_the_level_of_its_band() {
    let doll = Doll::new();
    for facing in [Facing::Around, Facing::Over] {
        for is_turned in [false, true] {
            let draft = ring(facing, is_turned);
            let name = format!("{facing:?}, turned {is_turned}");
            stands_round(&name, &made(&draft, &doll), &doll);
        }
    }
}

#[test]
fn sectors_of_rings_go_round_the_body() {
    let doll = Doll::new();
    for (whole, counts) in [(TAU, &[2, 4][..]), (PI, &[1, 2, 4]), (FRAC_PI_2, &[1, 2])] {
        for &count in counts {
            for has_band in [true, false] {
                let draft = sectors(count, whole, has_band);
                let name = format!("{count} of {whole:.2} rad, band {has_band}");
                stands_round(&name, &made(&draft, &doll), &doll);
            }
        }
    }
}

#[test]
fn gores_without_a_band_stand_side_by_side_round_the_body() {
    let doll = Doll::new();
    for (whole, count) in [(PI, 8), (FRAC_PI_2, 3), (FRAC_PI_2, 4), (FRAC_PI_2, 6)] {
        let made = made(&sectors(count, whole, false), &doll);
        // Laid flat, neighbours that touch at the hem are as far apart at the waist as that is shorter.
        let apart = whole * LENGTH / count as f64 + 0.04;
        let name = format!("{count} of {whole:.2} rad");
        stands_apart(&name, &made, &doll, apart);
    }
}

#[test]
fn the_cloth_of_a_cone_keeps_its_lengths_but_for_its_folds() {
    let doll = Doll::new();
    let made = made(&sectors(2, PI, true), &doll);
    let garment = &made.garment;
    let mut lengths = [0.0; 2];
    for t in &garment.triangles {
        for [a, b] in [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]].map(|e| e.map(|v| v as usize)) {
            lengths[0] += (garment.flat[a] - garment.flat[b]).norm();
            lengths[1] += (garment.positions[a] - garment.positions[b]).norm();
        }
    }
    let stretch = lengths[1] / lengths[0];
    assert!((0.9..1.15).contains(&stretch), "{stretch}");
}
