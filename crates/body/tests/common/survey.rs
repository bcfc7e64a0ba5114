//! The people of a survey table (ANSUR II, as CSV with head units: millimetres).

use std::collections::BTreeMap;
use toile_body::Figure;
use toile_geometry::TriangleMesh;
use toile_measure::{Measurements, Origin};

/// The survey's names and the catalogue's: twelve girths and ten lengths.
pub const ASKED: [(&str, &str); 22] = [
    ("chestcircumference", "bust"),
    ("waistcircumference", "waist"),
    ("buttockcircumference", "hips"),
    ("neckcircumference", "neck"),
    ("bicepscircumferenceflexed", "upper_arm"),
    ("forearmcircumferenceflexed", "forearm"),
    ("wristcircumference", "wrist"),
    ("thighcircumference", "leg_circ"),
    ("lowerthighcircumference", "lower_thigh"),
    ("calfcircumference", "calf"),
    ("anklecircumference", "ankle"),
    ("headcircumference", "head"),
    ("stature", "height"),
    ("cervicaleheight", "nape_height"),
    ("acromialheight", "shoulder_height"),
    ("chestheight", "bust_height"),
    ("waistheightomphalion", "waist_height"),
    ("buttockheight", "hip_height"),
    ("crotchheight", "inside_leg"),
    ("kneeheightmidpatella", "knee_height"),
    ("sleeveoutseam", "arm_length"),
    ("biacromialbreadth", "shoulder_w"),
];

/// A person of the survey.
#[derive(Clone)]
pub struct Person {
    /// Row in the table.
    pub row: usize,
    pub figure: Figure,
    /// What was measured, by the survey's names [m].
    pub values: BTreeMap<String, f64>,
}

impl Person {
    /// A measurement by the survey's name [m].
    pub fn get(&self, name: &str) -> f64 {
        self.values.get(name).copied().unwrap_or(f64::NAN)
    }

    /// The measurements asked.
    pub fn asked(&self) -> Measurements {
        let mut table = Measurements::new();
        for (from, name) in ASKED {
            let known = table.set(name, self.get(from), Origin::Asked);
            assert!(known.is_ok(), "{name} of person {}", self.row);
        }
        table
    }
}

/// The people of a table.
pub fn people(text: &str) -> Vec<Person> {
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    lines
        .enumerate()
        .map(|(row, line)| {
            let cells: Vec<&str> = line.split(',').collect();
            let value = |(name, cell): (&&str, &&str)| {
                Some(((*name).to_owned(), cell.parse::<f64>().ok()? * 1e-3))
            };
            Person {
                row,
                figure: match cells.first() {
                    Some(&"f") => Figure::Woman,
                    _ => Figure::Man,
                },
                values: names.iter().zip(&cells).filter_map(value).collect(),
            }
        })
        .collect()
}

/// Whether a skin is one closed, outward surface.
pub fn is_closed(skin: &TriangleMesh) -> bool {
    skin.check() == Ok(())
        && skin.is_closed_and_oriented()
        && skin.euler_characteristic() == 2
        && skin.component_count() == 1
        && skin.volume() > 0.0
}
