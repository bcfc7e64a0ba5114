//! Pieces nearly as wide as the fabric on a print: they lie on it wherever their garment runs and
//! wherever their set lies.

use std::sync::atomic::AtomicBool;
use toile_geometry::{Polygon, Vec2};
use toile_nesting::{
    Control, Item, MatchPoint, Nap, Phase, Search, Strip, Stripes, judge, make_marker,
};

/// A tall wedge and a small one, of two garments; on 1.4 m of fabric with lines 0.3 m apart the
/// tall one lies on the print one way up only.
fn pieces(phase: impl Fn(u32) -> Phase) -> Vec<Item> {
    let wedge = |height: f64| {
        let points = [(0.0, 0.0), (0.4, 0.0), (0.3, height), (0.15, height)];
        Polygon::new(points.iter().map(|&(x, y)| Vec2::new(x, y)).collect())
    };
    let mut items = Vec::new();
    for garment in 0..2 {
        for (name, height) in [("tall", 1.3), ("small", 0.35)] {
            let point = MatchPoint {
                point: Vec2::new(0.2, 0.25),
                phase: phase(garment),
            };
            items.push(Item {
                quantity: 2,
                bundles: vec![garment; 2],
                match_point: Some(point),
                ..Item::new(format!("{name} {garment}"), wedge(height))
            });
        }
    }
    items
}

fn strip() -> Strip {
    Strip {
        nap: Nap::PerBundle,
        stripes: Some(Stripes {
            repeat: Vec2::new(0.0, 0.3),
            origin: Vec2::zeros(),
        }),
        ..Strip::of_width(1.4)
    }
}

fn all_are_laid(items: &[Item], strip: &Strip) {
    for seed in 1..5 {
        let search = Search {
            seed,
            ..Search::evaluations(60_000)
        };
        let mut control = Control {
            progress: &mut |_| {},
            cancel: &AtomicBool::new(false),
        };
        let marker = make_marker(items, strip, search, &mut control).unwrap();
        let verdict = judge(items, strip, &marker);
        assert!(verdict.is_sound(), "seed {seed}: {:?}", verdict.violations);
        let left: Vec<_> = marker.unplaced.iter().map(|u| (u.item, u.copy)).collect();
        assert!(left.is_empty(), "seed {seed}: {left:?}");
    }
}

#[test]
fn a_garment_runs_the_way_its_print_allows() {
    let mut items = pieces(|_| Phase::At(Vec2::zeros()));
    all_are_laid(&items, &strip());
    // The other way.
    for item in &mut items {
        if let Some(point) = &mut item.match_point {
            point.point.y = 0.1;
        }
    }
    all_are_laid(&items, &strip());
}

#[test]
fn a_matched_set_lies_where_all_of_it_fits() {
    all_are_laid(&pieces(Phase::Set), &strip());
}

#[test]
fn a_set_that_fits_only_off_the_first_line_is_laid() {
    let mut items = pieces(Phase::Set);
    for item in &mut items {
        if let Some(point) = &mut item.match_point {
            point.point.y = 0.15;
        }
    }
    let one_way = Strip {
        nap: Nap::OneWay,
        ..strip()
    };
    all_are_laid(&items, &one_way);
}

#[test]
fn a_repeat_longer_than_the_strip_left_does_not_let_pieces_stick_out() {
    let mut items = pieces(|_| Phase::At(Vec2::zeros()));
    for item in &mut items {
        item.outline = item.outline.mapped(|p| Vec2::new(p.x, 0.3 * p.y));
    }
    let strip = Strip {
        stripes: Some(Stripes {
            repeat: Vec2::new(0.7, 0.0),
            origin: Vec2::zeros(),
        }),
        ..strip()
    };
    all_are_laid(&items, &strip);
}
