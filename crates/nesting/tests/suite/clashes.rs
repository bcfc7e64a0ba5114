//! The quick check says what the referee says of overlaps and of the edges of the fabric.

use proptest::prelude::*;
use toile_geometry::{Polygon, Vec2, total_area};
use toile_nesting::{Allowed, Item, Marker, Mirror, Placement, Strip, Violation, clashes, judge};

fn item(name: &str, corners: &[(f64, f64)]) -> Item {
    let points = corners.iter().map(|&(x, y)| Vec2::new(x, y)).collect();
    Item {
        quantity: 8,
        allowed: Allowed::two_way().mirrored(Mirror::Free),
        ..Item::new(name, Polygon::new(points))
    }
}

fn items() -> Vec<Item> {
    vec![
        item("square", &[(0.0, 0.0), (0.3, 0.0), (0.3, 0.3), (0.0, 0.3)]),
        item(
            "notched",
            &[(0.0, 0.0), (0.4, 0.0), (0.4, 0.3), (0.2, 0.05), (0.0, 0.3)],
        ),
        item("bar", &[(0.0, 0.0), (0.8, 0.0), (0.8, 0.02), (0.0, 0.02)]),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    #[test]
    fn it_finds_what_the_referee_finds(
        places in prop::collection::vec((0usize..3, -0.2..1.6f64, -0.2..1.2f64, 0u8..4, any::<bool>()), 1..12),
        on_grid in any::<bool>(),
    ) {
        let items = items();
        let strip = Strip { selvedge: 0.05, end_margin: 0.01, max_length: Some(1.5), ..Strip::of_width(1.2) };
        let snapped = |v: f64| if on_grid { (v * 10.0).round() / 10.0 } else { v };
        let placements = places.iter().zip(0..).map(|(&(item, x, y, quarter, mirrored), copy)| Placement {
            item,
            copy,
            turn: f64::from(quarter) * std::f64::consts::FRAC_PI_2,
            mirrored,
            translation: Vec2::new(snapped(x), snapped(y)),
        });
        let mut marker = Marker { placements: placements.collect(), ..Marker::default() };
        marker.measure(&items, &strip);
        let verdict = judge(&items, &strip, &marker);
        let mut overlaps = Vec::new();
        let mut outside = Vec::new();
        for violation in &verdict.violations {
            match violation {
                Violation::Overlap { pair, area, .. } => overlaps.push((*pair, *area)),
                Violation::Outside { placement, side, by } => outside.push((*placement, *side, *by)),
                _ => {}
            }
        }
        overlaps.sort_by_key(|o| o.0);
        let found = clashes(&items, &strip, &marker);
        prop_assert_eq!(found.overlaps.iter().map(|o| o.pair).collect::<Vec<_>>(), overlaps.iter().map(|o| o.0).collect::<Vec<_>>());
        for (quick, slow) in found.overlaps.iter().zip(&overlaps) {
            let area = total_area(&quick.region);
            prop_assert!((area - slow.1).abs() < 1e-9, "{} {}", area, slow.1);
        }
        prop_assert_eq!(found.outside.iter().map(|o| (o.placement, o.side, o.by)).collect::<Vec<_>>(), outside);
        prop_assert_eq!(found.length, verdict.length);
        prop_assert_eq!(found.efficiency, marker.efficiency);
        prop_assert_eq!(found.is_empty(), found.overlaps.is_empty() && found.outside.is_empty());
    }
}

#[test]
fn what_lies_nowhere_is_passed_over() {
    let items = items();
    let placement = |item: usize, x: f64| Placement {
        item,
        copy: 0,
        turn: 0.0,
        mirrored: false,
        translation: Vec2::new(x, 0.0),
    };
    let marker = Marker {
        placements: vec![placement(9, 0.0), placement(0, f64::NAN), placement(0, 0.0)],
        ..Marker::default()
    };
    let found = clashes(&items, &Strip::of_width(1.0), &marker);
    assert!(found.overlaps.is_empty(), "{found:?}");
    assert!((found.length - 0.3).abs() < 1e-12, "{found:?}");
}
