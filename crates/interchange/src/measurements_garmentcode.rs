//! Tables of body measurements of GarmentCode (YAML).

use crate::FormatError;
use toile_measure::{Measurements, Origin, is_angle};

/// Names with values in degrees, besides those that [`is_angle`] knows; other values are in
/// centimetres.
const DEGREES: [&str; 3] = ["arm_pose_angle", "hip_inclination", "shoulder_incl"];

/// Reads a GarmentCode body file: YAML with a top key `body` that holds one flat map of names to numbers,
/// lengths in centimetres, angles in degrees. Only this subset of YAML is read; comments and blank lines are
/// skipped.
///
/// # Errors
/// The first line that is not `name: number`, a name given twice, a number that is not finite, or a missing
/// `body` map.
pub fn read_body_yaml(text: &str) -> Result<Measurements, FormatError> {
    let mut table = Measurements::new();
    let mut inside = false;
    for (index, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
        let problem = |what: String, hint: &str| FormatError {
            place: format!("line {}", index + 1),
            what,
            hint: hint.to_owned(),
        };
        let content = line.split('#').next().unwrap_or_default().trim_end();
        if content.trim().is_empty() || content == "---" || content == "..." {
            continue;
        }
        let indented = content.starts_with([' ', '\t']);
        let Some((name, value)) = content.split_once(':') else {
            return Err(problem(
                format!("{:?} is not a name and a value", shortened(content.trim())),
                "write one measurement a line, as in `waist: 84.3`",
            ));
        };
        let (name, value) = (name.trim().trim_matches(['"', '\'']), value.trim());
        if !indented {
            inside = name == "body" && value.is_empty();
            continue;
        }
        if !inside {
            continue;
        }
        let number: f64 = value.parse().map_err(|_| {
            problem(
                format!("the value of {:?} is not a number", shortened(name)),
                "write centimetres or degrees as a plain number",
            )
        })?;
        if table.contains(name) {
            return Err(problem(
                format!("{:?} is given twice", shortened(name)),
                "leave one of the two lines",
            ));
        }
        table
            .set(name, in_si(name, number), Origin::Asked)
            .map_err(|error| problem(error.to_string(), "correct the line"))?;
    }
    if table.is_empty() {
        return Err(FormatError {
            place: "the file".to_owned(),
            what: "there is no `body:` with measurements under it".to_owned(),
            hint: "give a GarmentCode body file: `body:`, then indented `name: number` lines"
                .to_owned(),
        });
    }
    Ok(table)
}

fn in_si(name: &str, number: f64) -> f64 {
    let angle = DEGREES.contains(&name) || is_angle(name);
    if angle {
        number.to_radians()
    } else {
        number / 100.0
    }
}

fn shortened(text: &str) -> String {
    text.chars().take(60).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn lengths_and_angles_become_si() {
        let text = "# a comment\nbody:\n  height: 171.99 # stature\n\n  arm_pose_angle: 45\n  \
                    'waist': 84.3338\nother:\n  ignored: words\n";
        let table = read_body_yaml(text).unwrap();
        assert_eq!(table.len(), 3);
        assert!((table.get("height").unwrap() - 1.7199).abs() < 1e-15);
        assert!((table.get("waist").unwrap() - 0.843_338).abs() < 1e-15);
        let angle = table.get("arm_pose_angle").unwrap();
        assert!((angle - std::f64::consts::FRAC_PI_4).abs() < 1e-15);
    }

    #[test]
    fn refusals_name_line_and_remedy() {
        let place = |text: &str| read_body_yaml(text).unwrap_err().place;
        assert_eq!(place("body:\n  height: tall\n"), "line 2");
        assert_eq!(place("body:\n  height: .nan\n"), "line 2");
        assert_eq!(place("body:\n  height: NaN\n"), "line 2");
        assert_eq!(place("body:\n  height: 170\n  waist\n"), "line 3");
        assert_eq!(place("body:\n  height: 170\n  height: 171\n"), "line 3");
        assert_eq!(place("body:\n  Hei ght: 170\n"), "line 2");
        assert_eq!(place(""), "the file");
        assert_eq!(place("  height: 170\n"), "the file");
    }

    proptest! {
        #[test]
        fn any_text_is_read_or_refused(text in "\\PC{0,200}|(body:\n( {2}[a-z]{1,5}: ?[0-9.e-]{0,6}\n){0,5})") {
            if let Ok(table) = read_body_yaml(&text) {
                prop_assert!(table.iter().all(|(_, m)| m.value.is_finite()));
            }
        }
    }
}
