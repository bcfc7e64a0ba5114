//! Average children by age, and the proportions that predict a child's measurements.

use crate::{Measurements, Origin};

/// Ages there are figures for (years).
const AGES: [u8; 7] = [2, 4, 6, 8, 10, 12, 14];

/// Round figures (mm) for boys and girls alike: statures and girths as is customary for the sizes
/// of European children's wear (92 to 164), heads after the counts of the US Navy's Draftsman
/// manual (6.25 heads at 8 years, 7 at 12) and Loomis (5 at 3). No survey stands behind them.
const ROWS: &[(&str, [u16; AGES.len()])] = &[
    ("height", [920, 1040, 1160, 1280, 1400, 1520, 1640]),
    ("head_l", [200, 205, 211, 218, 225, 233, 242]),
    ("waist_line", [215, 240, 265, 292, 320, 348, 378]),
    ("hips_line", [98, 112, 126, 141, 157, 173, 190]),
    ("crotch_hip_diff", [47, 53, 59, 64, 69, 74, 80]),
    ("vert_bust_line", [123, 136, 149, 162, 176, 190, 205]),
    ("armscye_depth", [66, 75, 83, 92, 101, 109, 118]),
    ("shoulder_w", [215, 240, 265, 290, 315, 340, 362]),
    ("neck_w", [122, 130, 138, 145, 153, 161, 172]),
    ("arm_length", [300, 350, 400, 450, 500, 550, 590]),
    ("bust", [540, 570, 600, 645, 700, 760, 840]),
    ("underbust", [525, 550, 580, 622, 670, 715, 765]),
    ("waist", [510, 530, 550, 580, 620, 655, 690]),
    ("hips", [560, 600, 640, 695, 750, 815, 890]),
    ("neck", [245, 260, 275, 290, 305, 320, 340]),
    ("upper_arm", [165, 175, 185, 200, 220, 240, 260]),
    ("wrist", [118, 124, 130, 137, 145, 151, 157]),
    ("leg_circ", [305, 335, 365, 400, 440, 480, 520]),
    ("calf", [210, 230, 250, 270, 295, 320, 345]),
    ("ankle", [150, 160, 172, 185, 200, 212, 222]),
    ("head", [490, 508, 520, 530, 540, 550, 558]),
];

/// Girths, breadths and depths: they go with the girths asked for, the rest with the stature.
const GIRTHS: [&str; 30] = [
    "bust",
    "underbust",
    "waist",
    "hips",
    "neck",
    "upper_arm",
    "forearm",
    "wrist",
    "leg_circ",
    "lower_thigh",
    "calf",
    "ankle",
    "navel_girth",
    "shoulder_girth",
    "chest_breadth",
    "chest_depth",
    "waist_breadth",
    "waist_depth",
    "hip_breadth",
    "hip_depth",
    "bust_points",
    "bum_points",
    "back_width",
    "waist_back_width",
    "hip_back_width",
    "neck_w",
    "high_bust",
    "high_hips",
    "knee",
    "elbow",
];

fn row(name: &str) -> Option<&'static [u16; AGES.len()]> {
    ROWS.iter().find(|row| row.0 == name).map(|row| &row.1)
}

/// A row at an age (m): even between the ages known, held beyond them.
fn at_age(values: &[u16; AGES.len()], age: u8) -> f64 {
    let age = age.clamp(AGES[0], AGES[AGES.len() - 1]);
    let k = AGES.partition_point(|&known| known <= age) - 1;
    let next = (k + 1).min(AGES.len() - 1);
    let share = match next > k {
        true => f64::from(age - AGES[k]) / f64::from(AGES[next] - AGES[k]),
        false => 0.0,
    };
    let [low, high] = [values[k], values[next]].map(f64::from);
    (low + (high - low) * share) * 1e-3
}

/// A row at a stature (m): even between the ages, in proportion beyond them.
fn at_stature(values: &[u16; AGES.len()], stature: f64) -> f64 {
    let heights = ROWS[0].1.map(|mm| f64::from(mm) * 1e-3);
    let values = values.map(|mm| f64::from(mm) * 1e-3);
    let last = AGES.len() - 1;
    if stature <= heights[0] {
        return values[0] * stature / heights[0];
    }
    if stature >= heights[last] {
        return values[last] * stature / heights[last];
    }
    let k = heights.partition_point(|&h| h <= stature) - 1;
    let share = (stature - heights[k]) / (heights[k + 1] - heights[k]);
    values[k] + (values[k + 1] - values[k]) * share
}

impl Measurements {
    /// The average child of an age (years): even between the ages known, 2 to 14, and held
    /// beyond them. Angles and what no table of sizes lists are predicted.
    pub fn child(age: u8) -> Self {
        let age = age.clamp(AGES[0], AGES[AGES.len() - 1]);
        let mut table = Self::new();
        for (name, values) in ROWS {
            let _ = table.set(name, at_age(values, age), Origin::Asked);
        }
        table.completed_child(age)
    }

    /// This table with what is missing predicted and marked so, for a child of an age (years)
    /// where no stature is given: lengths as of an average child of the stature, girths besides
    /// in proportion to the girths asked for.
    pub(crate) fn completed_child(&self, age: u8) -> Self {
        let stature = self.child_stature(age);
        let adult = Self::of_survey(crate::Build::Either);
        let usual_adult = Self::adult();
        let adult_stature = adult.get("height").unwrap_or(1.7);
        let known = |name: &str| row(name).map(|values| at_stature(values, stature));
        let ratio_of = |names: &[&str]| -> f64 {
            let ratios = names
                .iter()
                .filter_map(|name| Some(known(name)? / adult.get(name)?));
            ratios.sum::<f64>() / names.len() as f64
        };
        let slim = ratio_of(&["bust", "waist", "hips"]);
        // How the girths asked for stand to those of the average child.
        let logs: Vec<f64> = GIRTHS
            .iter()
            .filter_map(|name| Some((self.get(name)? / known(name)?).ln()))
            .collect();
        let fuller = match logs.is_empty() {
            true => 1.0,
            false => (logs.iter().sum::<f64>() / logs.len() as f64).exp(),
        };
        let mut result = self.clone();
        let others = adult
            .iter()
            .chain(usual_adult.iter())
            .map(|(name, m)| (name, m.value));
        for (name, value) in ROWS.iter().map(|row| (row.0, 0.0)).chain(others) {
            let girth = GIRTHS.contains(&name);
            let angle = crate::is_angle(name);
            let average = match known(name) {
                Some(known) => known,
                None if angle => value,
                None if girth => value * slim,
                // Heights follow the solved levels and are left to them.
                None if name.ends_with("_height") || name == "inside_leg" => continue,
                None => value * stature / adult_stature,
            };
            let value = if girth { average * fuller } else { average };
            if !result.contains(name) && value.is_finite() {
                let _ = result.set(name, value, Origin::Predicted);
            }
        }
        result
    }

    /// The stature asked for, or the one that goes with the lengths asked for, or the age's (m).
    fn child_stature(&self, age: u8) -> f64 {
        if let Some(height) = self.get("height") {
            return height;
        }
        let of_age = at_age(&ROWS[0].1, age);
        let ratios: Vec<f64> = ROWS
            .iter()
            .filter(|row| !GIRTHS.contains(&row.0))
            .filter_map(|(name, values)| Some(self.get(name)? / at_stature(values, of_age)))
            .collect();
        match ratios.is_empty() {
            true => of_age,
            false => of_age * ratios.iter().sum::<f64>() / ratios.len() as f64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Build;

    #[test]
    fn children_grow_with_age_and_their_heads_less() {
        let mut before: Option<Measurements> = None;
        for age in 2..=14 {
            let child = Measurements::child(age);
            for (name, values) in ROWS {
                assert!(values.windows(2).all(|w| w[0] < w[1]), "{name}");
            }
            let get = |name: &str| child.get(name).unwrap();
            if let Some(before) = &before {
                assert!(get("height") > before.get("height").unwrap());
                let share = |t: &Measurements| t.get("head").unwrap() / t.get("height").unwrap();
                assert!(share(&child) < share(before));
            }
            let legs = get("height")
                - ["head_l", "waist_line", "hips_line", "crotch_hip_diff"]
                    .map(get)
                    .iter()
                    .sum::<f64>();
            assert!((0.38..0.47).contains(&(legs / get("height"))), "{legs}");
            for known in &crate::CATALOGUE[..26] {
                assert!(child.contains(known.name), "{}", known.name);
            }
            before = Some(child);
        }
        assert_eq!(Measurements::child(1), Measurements::child(2));
        assert_eq!(Measurements::child(40), Measurements::child(14));
    }

    #[test]
    fn what_is_asked_stays_and_draws_the_girths() {
        let mut asked = Measurements::new();
        asked.set("height", 1.22, Origin::Asked).unwrap();
        asked.set("waist", 0.66, Origin::Asked).unwrap();
        let full = asked.completed(Build::Child(8));
        assert_eq!(full.get("height"), Some(1.22));
        assert_eq!(full.get("waist"), Some(0.66));
        let usual = Measurements::child(7);
        assert!(full.get("hips").unwrap() > 1.1 * usual.get("hips").unwrap());
        assert!((full.get("head").unwrap() - usual.get("head").unwrap()).abs() < 2e-3);
        assert_eq!(full.measured("hips").unwrap().origin, Origin::Predicted);
        // Of an age alone, between those of the table too.
        for age in 2..=14 {
            let of_age = Measurements::new().completed(Build::Child(age));
            assert_eq!(of_age.get("height"), Measurements::child(age).get("height"));
        }
        // From a length alone.
        let mut arm = Measurements::new();
        arm.set("arm_length", 0.35, Origin::Asked).unwrap();
        let height = arm.completed(Build::Child(8)).get("height").unwrap();
        assert!((0.95..1.05).contains(&height), "{height}");
    }
}
