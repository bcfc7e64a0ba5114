//! Proportion boxes: the built-in table, and tables of the user in the same form.

use crate::FormatError;
use toile_body::ProportionBox;

/// The built-in table: stature in head lengths by sex and age, after published canons.
const TABLE: &str = include_str!("proportions.json");

/// The built-in proportion boxes.
pub fn proportion_boxes() -> Vec<ProportionBox> {
    read_proportions(TABLE).expect("a test reads the table that ships")
}

/// Reads a table of proportion boxes: a JSON list of objects with a name and the stature in head lengths
/// (crown to chin), and optionally sex, age (years), and crotch height, distance between the shoulder ends
/// and hip breadth in head lengths.
///
/// # Errors
/// The text is no such list, or the list is empty: the fault, its place and a remedy.
pub fn read_proportions(text: &str) -> Result<Vec<ProportionBox>, FormatError> {
    let hint = "write [{\"name\": \"mine\", \"heads\": 7.5, \"crotch\": 3.6}], lengths in heads";
    let table: Vec<ProportionBox> = serde_json::from_str(text).map_err(|error| {
        let place = format!("line {}, column {}", error.line(), error.column());
        FormatError::new(place, error.to_string(), hint)
    })?;
    if table.is_empty() {
        return Err(FormatError::new("the table", "is empty", hint));
    }
    Ok(table)
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_body::{Mannequin, Sex};

    #[test]
    fn the_table_that_ships_spans_ages_and_sexes() {
        let table = proportion_boxes();
        let heads = |pick: fn(f64, f64) -> f64| table.iter().map(|b| b.heads).reduce(pick).unwrap();
        assert_eq!((heads(f64::min), heads(f64::max)), (4.0, 8.0));
        for sex in [Sex::Female, Sex::Male] {
            assert!(table.iter().any(|b| b.sex == Some(sex)));
        }
        assert!(table.iter().any(|b| b.age.is_some_and(|age| age < 2.0)));
        // A name selects one box.
        for (k, row) in table.iter().enumerate() {
            assert!(table[..k].iter().all(|other| other.name != row.name));
            assert!(!row.source.is_empty(), "{}", row.name);
        }
    }

    #[test]
    fn every_box_that_ships_is_met_by_a_body() {
        let figure = toile_body::Figure::Mean;
        let body = Mannequin::framed(figure).unwrap();
        for row in proportion_boxes() {
            let made = row.apply(&body).unwrap();
            let made = Mannequin::from_description(&made).unwrap();
            let got = ProportionBox::of_body(&made);
            let near = |asked: Option<f64>, got: Option<f64>| match (asked, got) {
                (Some(asked), Some(got)) => assert!(
                    (got / asked - 1.0).abs() < 0.01,
                    "{}: {got} for {asked}",
                    row.name
                ),
                (None, _) => {}
                (Some(_), None) => panic!("{} is not measured", row.name),
            };
            near(Some(row.heads), Some(got.heads));
            near(row.crotch, got.crotch);
            near(row.shoulders, got.shoulders);
            near(row.hips, got.hips);
            assert!(
                made.skin_tree().self_intersections().is_empty(),
                "{}",
                row.name
            );
        }
    }

    #[test]
    fn damage_is_refused_with_place_and_remedy() {
        for (text, word) in [
            ("[", "line 1"),
            ("[]", "empty"),
            ("[{\"name\": \"x\"}]", "heads"),
            (
                "[{\"name\": \"x\", \"heads\": 7, \"crotsch\": 3}]",
                "crotsch",
            ),
            ("[{\"name\": \"x\", \"heads\": 7, \"sex\": \"no\"}]", "no"),
        ] {
            let error = read_proportions(text).unwrap_err().to_string();
            assert!(error.contains(word), "{error}");
        }
    }
}
