//! Published nesting instances: every marker passes the referee, and the densities are printed.
//! Skipped, with a word, where the instances are not at hand.

use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
use toile_geometry::{Polygon, Vec2};
use toile_nesting::{Allowed, Control, Item, Search, Strip, judge, make_marker};

/// Width given to the strip of every instance (m): they are in units of their own.
const WIDTH: f64 = 1.5;

fn folder() -> Option<PathBuf> {
    let named = std::env::var_os("TOILE_SHARED").map(|p| PathBuf::from(p).join("data"));
    let here = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let above = here.ancestors().map(|p| p.join("shared/data"));
    named
        .into_iter()
        .chain(above)
        .map(|p| p.join("nesting"))
        .find(|p| p.is_dir())
}

fn read(text: &str) -> (Vec<Item>, Strip) {
    let value: serde_json::Value = serde_json::from_str(text).unwrap();
    let number = |v: &serde_json::Value| v.as_f64().unwrap();
    let scale = WIDTH / number(&value["strip_height"]);
    let item = |v: &serde_json::Value| {
        let points = v["shape"]["data"].as_array().unwrap().iter();
        let outline = points
            .map(|p| Vec2::new(number(&p[0]), number(&p[1])) * scale)
            .collect();
        let turns = v["allowed_orientations"].as_array().unwrap().iter();
        Item {
            quantity: v["demand"].as_u64().unwrap() as u32,
            allowed: Allowed::turned(turns.map(|t| number(t).to_radians()).collect()),
            ..Item::new(v["id"].to_string(), Polygon::new(outline))
        }
    };
    let items = value["items"]
        .as_array()
        .unwrap()
        .iter()
        .map(item)
        .collect();
    (items, Strip::of_width(WIDTH))
}

#[test]
fn published_instances_are_laid_soundly_and_densely() {
    let Some(folder) = folder() else {
        println!("skipped: no shared/data/nesting folder");
        return;
    };
    // An optimised build searches as it does for a user, others a little.
    let search = if cfg!(debug_assertions) {
        Search::evaluations(3_000_000)
    } else {
        Search::default()
    };
    // What is reached at once; a plain bottom-left-fill gives less.
    for (name, floor) in [
        ("albano", 0.83),
        ("dagli", 0.81),
        ("marques", 0.84),
        ("blaz1", 0.76),
        ("gardeyn0", 0.80),
        ("gardeyn1", 0.80),
    ] {
        let text = std::fs::read_to_string(folder.join(format!("{name}.json"))).unwrap();
        let (items, strip) = read(&text);
        let mut control = Control {
            progress: &mut |_| {},
            cancel: &AtomicBool::new(false),
        };
        let started = std::time::Instant::now();
        let marker = make_marker(&items, &strip, search, &mut control).unwrap();
        let seconds = started.elapsed().as_secs_f64();
        let verdict = judge(&items, &strip, &marker);
        println!(
            "{name}: {} pieces, density {:.2} % in {seconds:.2} s, deepest overlap {:.1e} m",
            marker.placements.len(),
            100.0 * marker.efficiency,
            verdict.deepest
        );
        assert!(verdict.is_sound(), "{name}: {:?}", verdict.violations);
        assert!(marker.unplaced.is_empty());
        assert!(marker.efficiency > floor, "{name}: {}", marker.efficiency);
    }
}
