//! How fast the sections of a body change in scale with height, beyond what its girths ask for.

use crate::common::freesewing::freesewing;
use std::collections::BTreeSet;
use toile_body::{Mannequin, Part, template_skin};
use toile_geometry::{TriangleMesh, closed_length, convex_hull, horizontal_section};
use toile_measure::Measurements;

/// Largest change of a section's scale within 1 % of the stature that no girth asks for.
const SWING: f64 = 0.15;

/// Girth, breadth and depth (m) of the trunk's level section.
fn section(mesh: &TriangleMesh, parts: &[Part], height: f64) -> [f64; 3] {
    let own = |part: Part| matches!(part, Part::Trunk | Part::LeftLeg | Part::RightLeg);
    let triangles = (0..mesh.triangles.len()).filter(|&t| own(parts[t]));
    let hull = convex_hull(&horizontal_section(mesh, triangles, height));
    let extent = |k: usize| {
        let low = hull.iter().map(|p| p[k]).fold(f64::INFINITY, f64::min);
        let high = hull.iter().map(|p| p[k]).fold(f64::NEG_INFINITY, f64::max);
        high - low
    };
    [closed_length(&hull), extent(0), extent(1)]
}

/// A broken line through places in ascending order, level beyond its ends.
fn line(points: &[[f64; 2]], x: f64) -> f64 {
    let k = points.partition_point(|p| p[0] <= x);
    if k == 0 || k == points.len() {
        return points[k.min(points.len() - 1)][1];
    }
    let ([x0, y0], [x1, y1]) = (points[k - 1], points[k]);
    y0 + (y1 - y0) * (x - x0) / (x1 - x0)
}

/// Heights of the front middle of the trunk on a body and on its template (m), from below.
fn heights(body: &TriangleMesh, template: &TriangleMesh, low: f64) -> Vec<[f64; 2]> {
    let mut pairs: Vec<[f64; 2]> = (body.positions.iter().zip(&template.positions))
        .filter(|(b, t)| t.x == 0.0 && t.z > 0.02 && b.y > low)
        .map(|(b, t)| [b.y, t.y])
        .collect();
    pairs.sort_by(|a, b| a[0].total_cmp(&b[0]));
    pairs
}

/// Girths asked for with their heights on a body (m), from below.
fn girths(body: &Mannequin, table: &Measurements) -> Vec<[f64; 2]> {
    let levels = body.levels();
    let get = |name: &str| table.get(name).unwrap();
    let mut all = vec![
        [levels.hip, get("hips")],
        [levels.waist - get("waist_to_high_hips"), get("high_hips")],
        [levels.waist, get("waist")],
        [levels.waist + get("waist_to_underbust"), get("underbust")],
        [levels.chest, get("bust")],
        [
            0.62 * levels.chest + 0.38 * levels.shoulder,
            get("high_bust"),
        ],
    ];
    all.sort_by(|a, b| a[0].total_cmp(&b[0]));
    all
}

/// The largest swing of a body's sections in girth, breadth or depth, with its
/// height (m) and which of them.
fn largest(body: &Mannequin, template: &TriangleMesh, asked: &[[f64; 2]]) -> [f64; 3] {
    let (skin, parts) = (body.skin(), body.part_of_triangle());
    let levels = body.levels();
    let step = 0.01 * levels.crown;
    let to_template = heights(skin, template, levels.crotch);
    let of_template = |y: f64| section(template, parts, line(&to_template, y));
    // What the girths ask for, evenly between their levels.
    let wanted: Vec<[f64; 2]> = asked
        .iter()
        .map(|&[y, girth]| [y, (girth / of_template(y)[0]).ln()])
        .collect();
    let scales = |y: f64| {
        let (own, before) = (section(skin, parts, y), of_template(y));
        [0, 1, 2].map(|k| (own[k] / before[k]).ln())
    };
    let mut most = [0.0; 3];
    let mut compared = 0;
    let mut y = levels.crotch + step;
    // Where the arms begin a section ends at their border, on the body and on the template.
    let ends = |mesh: &TriangleMesh| {
        let of = |part: Part| -> BTreeSet<u32> {
            let own = (0..parts.len()).filter(|&t| parts[t] == part);
            own.flat_map(|t| mesh.triangles[t]).collect()
        };
        let border = &of(Part::Trunk) & &of(Part::LeftArm);
        let heights = border.iter().map(|&v| mesh.positions[v as usize].y);
        heights.fold(f64::INFINITY, f64::min)
    };
    let [top, top_of_template] = [ends(skin), ends(template)];
    while y + step < top && line(&to_template, y + step) < top_of_template {
        compared += 1;
        let demand = (line(&wanted, y + step) - line(&wanted, y)).abs();
        let (low, high) = (scales(y), scales(y + step));
        for k in 0..3 {
            let swing = ((high[k] - low[k]).abs() - demand).exp_m1();
            if swing > most[0] {
                most = [swing, y, k as f64];
            }
        }
        y += 0.5 * step;
    }
    assert!(compared > 40, "{compared} heights compared");
    most
}

#[test]
fn no_section_swings_beyond_its_girths() {
    let mut worst = [0.0, 0.0];
    for (name, figure, table) in freesewing() {
        let body = Mannequin::new(&table, figure).unwrap();
        let template = template_skin(figure).unwrap();
        assert_eq!(template.positions.len(), body.skin().positions.len());
        let [swing, height, way] = largest(&body, &template, &girths(&body, &table));
        println!("{name}: {:.1} % at {height:.3} m, {way}", 100.0 * swing);
        if swing > worst[0] {
            worst = [swing, height];
        }
    }
    println!("largest: {:.1} %", 100.0 * worst[0]);
    assert!(worst[0] <= SWING, "{worst:?}");
}

#[test]
fn a_swing_is_seen() {
    // A waist drawn in by a third over a hand's breadth is no scale the girths ask for.
    let (_, figure, table) = match freesewing().into_iter().next() {
        Some(set) => set,
        None => return,
    };
    let body = Mannequin::new(&table, figure).unwrap();
    let template = template_skin(figure).unwrap();
    let asked = girths(&body, &table);
    let mut crooked = template.clone();
    let at = body.levels().waist * 1.7 / body.levels().crown;
    for p in &mut crooked.positions {
        p.x *= 1.0 + 0.5 * (-((p.y - at) / 0.02).powi(2)).exp();
    }
    assert!(largest(&body, &crooked, &asked)[0] > SWING);
}
