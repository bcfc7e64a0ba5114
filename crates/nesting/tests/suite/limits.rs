//! Jobs of many shapes: fewer turns are tried, or the job is refused before its tables are made.

use std::f64::consts::TAU;
use std::sync::atomic::AtomicBool;
use toile_geometry::{Polygon, Vec2};
use toile_nesting::{
    Allowed, Control, Item, Marker, NestingError, Search, Strip, judge, make_marker,
};

fn make(items: &[Item], strip: &Strip, search: Search) -> Result<Marker, NestingError> {
    let mut control = Control {
        progress: &mut |_| {},
        cancel: &AtomicBool::new(false),
    };
    make_marker(items, strip, search, &mut control)
}

/// Small pieces, each of another shape.
fn different(count: u32) -> Vec<Item> {
    let one = |k: u32| {
        let bulge = 1e-4 * f64::from(k);
        let points = [(0.0, 0.0), (0.1, bulge), (0.08, 0.07), (0.02, 0.06 + bulge)];
        let points = points.iter().map(|&(x, y)| Vec2::new(x, y)).collect();
        Item::new(format!("piece {k}"), Polygon::new(points))
    };
    (0..count).map(one).collect()
}

#[test]
fn many_pieces_that_turn_freely_are_laid() {
    let mut items = different(60);
    for item in &mut items {
        let turns = (0..24).map(|k| TAU * f64::from(k) / 24.0);
        item.allowed = Allowed::turned(turns.collect());
    }
    let strip = Strip::of_width(1.0);
    let marker = make(&items, &strip, Search::evaluations(1_000)).unwrap();
    assert_eq!(marker.placements.len(), 60);
    assert!(judge(&items, &strip, &marker).is_sound());
}

#[test]
fn more_outlines_than_tables_can_hold_are_refused() {
    let error = make(&different(600), &Strip::of_width(1.0), Search::seconds(0.5)).unwrap_err();
    let text = error.to_string();
    assert!(text.contains("600 different outlines"), "{text}");
}

#[test]
fn more_islands_than_memory_holds_are_refused() {
    let items = [Item {
        quantity: 2_000,
        ..different(1).remove(0)
    }];
    let search = Search {
        islands: 64,
        ..Search::evaluations(1)
    };
    let mut control = Control {
        progress: &mut |_| {},
        cancel: &AtomicBool::new(true),
    };
    let error = make_marker(&items, &Strip::of_width(1.0), search, &mut control).unwrap_err();
    let text = error.to_string();
    assert!(text.starts_with("search: 64 islands"), "{text}");
    assert!(text.contains("2000 pieces and flaws"), "{text}");
}
