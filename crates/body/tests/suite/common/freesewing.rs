//! The sets of FreeSewing: adults, dolls and giants.

use super::shared;
use std::collections::BTreeMap;
use toile_body::Figure;
use toile_measure::{FREESEWING, Measurements, Origin, UnitKind, definition, translated};

type Sets = BTreeMap<String, BTreeMap<String, BTreeMap<String, f64>>>;

/// All FreeSewing sets: name, figure and table.
pub fn freesewing() -> Vec<(String, Figure, Measurements)> {
    let Some(path) = shared("body/measurements/freesewing_models_4.10.2.json") else {
        return Vec::new();
    };
    let text = std::fs::read_to_string(path).unwrap();
    let file: serde_json::Value = serde_json::from_str(&text).unwrap();
    let mut all = Vec::new();
    for group in ["adult", "doll", "giant"] {
        let sets: Sets = serde_json::from_value(file[group].clone()).unwrap();
        for (sex, sizes) in sets {
            let figure = if sex == "cisFemale" {
                Figure::Woman
            } else {
                Figure::Man
            };
            for (size, values) in sizes {
                let mut table = Measurements::new();
                for (name, value) in values {
                    let own = translated(FREESEWING, &name).unwrap();
                    let si = match definition(own).unwrap().kind {
                        UnitKind::Length => value * 1e-3,
                        UnitKind::Angle => value.to_radians(),
                    };
                    table.set(own, si, Origin::Asked).unwrap();
                }
                all.push((format!("{group} {sex} {size}"), figure, table));
            }
        }
    }
    all
}
