//! Laws of the intersection of two polygons.

use proptest::prelude::*;
use toile_geometry::{
    Bounds2, Corner, Location, Polygon, Vec2, difference, interiors_overlap, intersection, offset,
    point_segment_distance, total_area, union, wound_region,
};

fn polygon(points: &[(f64, f64)]) -> Polygon {
    Polygon::new(points.iter().map(|&(x, y)| Vec2::new(x, y)).collect())
}

fn box_of(x0: f64, y0: f64, x1: f64, y1: f64) -> Polygon {
    Polygon::rectangle(Bounds2 {
        min: Vec2::new(x0, y0),
        max: Vec2::new(x1, y1),
    })
}

fn area(a: &Polygon, b: &Polygon) -> f64 {
    total_area(&intersection(a, b))
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-7
}

/// Star-shaped outlines, now and then with a star-shaped hole.
fn star() -> impl Strategy<Value = Polygon> {
    let radii = || prop::collection::vec(0.3..1.0f64, 3..24);
    (radii(), radii(), any::<bool>(), -1.0..1.0f64, -1.0..1.0f64).prop_map(
        |(outer, inner, holed, x, y)| {
            let ring = |radii: &[f64], scale: f64| -> Vec<Vec2> {
                let n = radii.len() as f64;
                let point = |(k, r): (usize, &f64)| {
                    let angle = std::f64::consts::TAU * k as f64 / n;
                    Vec2::new(angle.cos(), angle.sin()) * (r * scale) + Vec2::new(x, y)
                };
                radii.iter().enumerate().map(point).collect()
            };
            let outer = ring(&outer, 1.0);
            let centre = Vec2::new(x, y);
            let reach = Polygon::new(outer.clone())
                .edges()
                .map(|edge| point_segment_distance(centre, edge))
                .fold(f64::INFINITY, f64::min);
            let holes = if holed && outer.len() > 3 {
                vec![ring(&inner, 0.9 * reach)]
            } else {
                Vec::new()
            };
            Polygon { outer, holes }
        },
    )
}

/// Area of the region in both, by the lengths of many horizontal lines in it.
fn scanned_area(a: &Polygon, b: &Polygon, lines: u32) -> f64 {
    let bounds = a.bounds();
    let step = bounds.size().y / f64::from(lines);
    let stretches = |p: &Polygon, y: f64| {
        let mut cuts: Vec<f64> = p
            .edges()
            .filter(|[p, q]| (p.y <= y) != (q.y <= y))
            .map(|[p, q]| p.x + (q.x - p.x) * (y - p.y) / (q.y - p.y))
            .collect();
        cuts.sort_by(f64::total_cmp);
        cuts.chunks_exact(2)
            .map(|c| (c[0], c[1]))
            .collect::<Vec<_>>()
    };
    let line = |k: u32| {
        let y = bounds.min.y + (f64::from(k) + 0.5) * step;
        let (mine, theirs) = (stretches(a, y), stretches(b, y));
        let shared = |p: &(f64, f64), q: &(f64, f64)| (p.1.min(q.1) - p.0.max(q.0)).max(0.0);
        mine.iter()
            .map(|p| theirs.iter().map(|q| shared(p, q)).sum::<f64>())
            .sum::<f64>()
    };
    (0..lines).map(line).sum::<f64>() * step
}

#[test]
fn boxes_that_overlap_touch_share_edges_or_miss() {
    let base = box_of(0.0, 0.0, 2.0, 1.0);
    for (other, want) in [
        (box_of(1.0, 0.5, 3.0, 2.0), 0.5),
        (box_of(2.0, 0.0, 3.0, 1.0), 0.0),
        (box_of(2.0, 1.0, 3.0, 2.0), 0.0),
        (box_of(0.5, 0.0, 1.0, 1.0), 0.5),
        (box_of(-1.0, 0.0, 1.0, 1.0), 1.0),
        (box_of(0.0, -1.0, 2.0, 0.0), 0.0),
        (box_of(5.0, 5.0, 6.0, 6.0), 0.0),
        (base.clone(), 2.0),
    ] {
        assert!(near(area(&base, &other), want), "{other:?}");
        assert!(near(area(&other, &base), want), "{other:?}");
    }
}

#[test]
fn the_hole_of_one_takes_from_the_other() {
    let mut frame = box_of(0.0, 0.0, 4.0, 4.0);
    frame.holes.push(box_of(1.0, 1.0, 3.0, 3.0).outer);
    let bar = box_of(-1.0, 1.5, 5.0, 2.5);
    let both = intersection(&frame, &bar);
    assert_eq!(both.len(), 2);
    assert!(near(total_area(&both), 2.0));
    assert!(
        near(area(&frame, &box_of(1.0, 1.0, 3.0, 3.0)), 0.0),
        "fills the hole exactly"
    );
    let ring = intersection(&frame, &box_of(0.5, 0.5, 3.5, 3.5));
    assert_eq!((ring.len(), ring[0].holes.len()), (1, 1));
    assert!(near(ring[0].area(), 5.0));
}

#[test]
fn slanted_collinear_edges_share_no_area() {
    for turn in 0..24 {
        let turn = f64::from(turn) * 0.13;
        let (a, b) = (box_of(0.0, 0.0, 1.0, 1.0), box_of(1.0, 0.25, 1.7, 2.0));
        assert!(area(&a.rotated(turn), &b.rotated(turn)) < 1e-8);
    }
}

#[test]
fn empty_degenerate_and_endless_operands_give_nothing() {
    let square = box_of(0.0, 0.0, 1.0, 1.0);
    let nan = polygon(&[(0.0, 0.0), (f64::NAN, 1.0), (1.0, 0.0)]);
    let endless = polygon(&[(0.0, 0.0), (f64::INFINITY, 1.0), (1.0, 0.0)]);
    let line = polygon(&[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0)]);
    for bad in [
        Polygon::default(),
        nan,
        endless,
        polygon(&[(0.0, 0.0), (1.0, 1.0)]),
    ] {
        assert!(intersection(&square, &bad).is_empty());
        assert!(near(total_area(&union(&square, &bad)), 1.0));
        assert!(near(total_area(&difference(&square, &bad)), 1.0));
        assert!(offset(&bad, 0.1, Corner::Bevel).is_empty());
    }
    assert!(near(area(&square, &line), 0.0));
    assert!(wound_region(&[]).is_empty());
}

#[test]
fn size_and_place_do_not_matter() {
    for scale in [1e-3, 1.0, 1e6] {
        for shift in [0.0, 1e3, -1e6] {
            let place = |p: &Polygon| p.mapped(|v| (v + Vec2::new(shift, -shift)) * scale);
            let (a, b) = (box_of(0.0, 0.0, 2.0, 2.0), box_of(1.0, 1.0, 3.0, 3.0));
            let got = area(&place(&a), &place(&b)) / (scale * scale);
            assert!(
                (got - 1.0).abs() < 1e-7,
                "scale {scale}, shift {shift}: {got}"
            );
        }
    }
}

#[test]
fn offsets_of_a_square() {
    let square = box_of(0.0, 0.0, 1.0, 1.0);
    let grown = |corner: Corner| total_area(&offset(&square, 0.1, corner));
    assert!(near(grown(Corner::Mitre { limit: 0.5 }), 1.44));
    assert!(near(grown(Corner::Bevel), 1.42));
    let round = grown(Corner::Round { step: 0.05 });
    assert!(
        (round - (1.4 + 0.01 * std::f64::consts::PI)).abs() < 1e-4,
        "{round}"
    );
    let inner = offset(&square, -0.2, Corner::Mitre { limit: 0.5 });
    assert!(near(total_area(&inner), 0.36));
    assert!(offset(&square, -0.6, Corner::Bevel).is_empty());
}

#[test]
fn a_figure_of_eight_is_the_sum_of_its_loops() {
    let eight = vec![
        Vec2::new(0.0, 0.0),
        Vec2::new(2.0, 2.0),
        Vec2::new(2.0, 0.0),
        Vec2::new(0.0, 2.0),
    ];
    assert!(near(total_area(&wound_region(&[eight])), 2.0));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn intersections_obey_the_laws_of_sets(a in star(), b in star()) {
        let shared = area(&a, &b);
        prop_assert!(near(shared, area(&b, &a)));
        prop_assert!(shared <= a.area().min(b.area()) + 1e-7);
        prop_assert!(near(shared, a.area() + b.area() - total_area(&union(&a, &b))));
        prop_assert!(near(shared, a.area() - total_area(&difference(&a, &b))));
        prop_assert!(near(area(&a, &a), a.area()));
        if shared > 1e-6 {
            prop_assert!(interiors_overlap(&a, &b));
        }
        if shared == 0.0 && !interiors_overlap(&a, &b) {
            prop_assert!(intersection(&a, &b).is_empty());
        }
    }

    #[test]
    fn moving_and_turning_both_changes_nothing(
        a in star(), b in star(), turn in 0.0..6.2f64, x in -9.0..9.0f64, y in -9.0..9.0f64
    ) {
        let place = |p: &Polygon| p.rotated(turn).translated(Vec2::new(x, y));
        prop_assert!(near(area(&a, &b), area(&place(&a), &place(&b))));
    }

    #[test]
    fn areas_equal_those_of_scan_lines(a in star(), b in star()) {
        let got = area(&a, &b);
        let scanned = scanned_area(&a, &b, 4000);
        prop_assert!((got - scanned).abs() < 2e-3, "{got} against {scanned}");
    }

    #[test]
    fn a_point_is_in_the_result_where_it_is_in_both(
        a in star(), b in star(), x in -1.0..1.0f64, y in -1.0..1.0f64
    ) {
        let p = Vec2::new(x, y);
        let close = a.edges().chain(b.edges()).any(|e| point_segment_distance(p, e) < 1e-7);
        prop_assume!(!close);
        let both = a.contains(p) && b.contains(p);
        let found = intersection(&a, &b).iter().any(|r| r.locate(p) != Location::Outside);
        prop_assert_eq!(both, found);
    }

    #[test]
    fn a_grown_polygon_keeps_its_distance(a in star(), distance in 0.01..0.2f64) {
        let grown = offset(&a, distance, Corner::Round { step: 0.2 });
        prop_assert!(total_area(&grown) > a.area());
        for ring in &grown {
            for &p in &ring.outer {
                let gap = a
                    .edges()
                    .map(|e| point_segment_distance(p, e))
                    .fold(f64::INFINITY, f64::min);
                prop_assert!((gap - distance).abs() < 0.02 * distance + 1e-6, "{gap}");
            }
        }
    }
}
