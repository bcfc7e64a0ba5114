//! The people of a survey table (ANSUR II, as CSV with head units: millimetres).

use nalgebra::{DMatrix, DVector};
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

/// What is not asked: the survey's name and the catalogue's.
pub const HELD_OUT: [(&str, &str); 6] = [
    ("chestbreadth", "chest_breadth"),
    ("chestdepth", "chest_depth"),
    ("waistbreadth", "waist_breadth"),
    ("waistdepth", "waist_depth"),
    ("hipbreadth", "hip_breadth"),
    ("buttockdepth", "hip_depth"),
];

/// A person of the survey.
#[derive(Clone)]
pub struct Person {
    /// Row in the table.
    pub row: usize,
    pub figure: Figure,
    /// What was measured, by the survey's names (m).
    pub values: BTreeMap<String, f64>,
}

impl Person {
    /// A measurement by the survey's name (m).
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

    /// The same with girth and height at the navel, where the survey's waist lies: what is
    /// predicted stands on that.
    pub fn asked_with_navel(&self) -> Measurements {
        let mut table = self.asked();
        for (from, name) in [
            ("waistcircumference", "navel_girth"),
            ("waistheightomphalion", "navel_height"),
        ] {
            let known = table.set(name, self.get(from), Origin::Asked);
            assert!(known.is_ok(), "{name} of person {}", self.row);
        }
        table
    }
}

/// Root mean square of a linear regression on the asked values, fitted on people with an odd row
/// and held against those of a figure with an even one, and of the bodies against the same (m).
pub fn held_out(
    everyone: &[Person],
    (people, bodies): (&[&Person], &[[f64; HELD_OUT.len()]]),
    figure: Figure,
    which: usize,
) -> [f64; 2] {
    let inputs = |p: &Person| -> Vec<f64> {
        let values = ASKED.iter().map(|(name, _)| p.get(name));
        std::iter::once(1.0).chain(values).collect()
    };
    let half: Vec<&Person> = everyone
        .iter()
        .filter(|p| p.figure == figure && p.row % 2 == 1)
        .collect();
    let rows: Vec<f64> = half.iter().flat_map(|p| inputs(p)).collect();
    let rows = DMatrix::from_row_slice(half.len(), ASKED.len() + 1, &rows);
    let actual = half.iter().map(|p| p.get(HELD_OUT[which].0));
    let right = rows.tr_mul(&DVector::from_iterator(half.len(), actual));
    let Some(line) = rows.tr_mul(&rows).cholesky().map(|n| n.solve(&right)) else {
        return [f64::NAN; 2];
    };
    let (mut sums, mut count) = ([0.0; 2], 0.0);
    for (person, body) in people.iter().zip(bodies) {
        let got = body[which];
        if person.figure != figure || person.row % 2 == 1 || !got.is_finite() {
            continue;
        }
        let actual = person.get(HELD_OUT[which].0);
        let fitted: f64 = inputs(person).iter().zip(&line).map(|(x, b)| x * b).sum();
        sums[0] += (fitted - actual).powi(2);
        sums[1] += (got - actual).powi(2);
        count += 1.0;
    }
    sums.map(|sum: f64| (sum / f64::max(count, 1.0)).sqrt())
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
