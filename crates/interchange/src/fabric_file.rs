//! Fabric files: figures as a scene's material has them, or test values of a laboratory.

use crate::scene::json_error;
use crate::{FormatError, MaterialFile, read_fabric_test};
use serde::Deserialize;
use serde_json::Value;
use toile_drape::{Material, MaterialLaws};

/// A fabric in a file of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct FabricFile {
    /// Name of the fabric; `None` if the file gives no name.
    pub name: Option<String>,
    /// Material of the fabric. A value that the file leaves out is taken from the library fabric that the
    /// file names, or from the default material if it names none.
    pub material: Material,
    /// Notes on unknown fields, and other notes for the user.
    pub notes: Vec<String>,
}

/// The content of a file of the kind `fabric`: version, name, and the fields of a scene's material.
#[derive(Deserialize)]
struct Figures {
    toile: u32,
    name: Option<String>,
    #[serde(flatten)]
    material: MaterialFile,
}

/// Reads a fabric file: JSON of the kind `fabric` with the fields of a scene's material, or the test values
/// that [`read_fabric_test`] reads.
///
/// # Errors
/// Text of neither kind, fields of the wrong type, or values that no cloth can have.
pub fn read_fabric(text: &str) -> Result<FabricFile, FormatError> {
    let head: Option<Value> = serde_json::from_str(text).ok();
    let says = |field: &str| head.as_ref().and_then(|head| head.get(field)?.as_str());
    let file = match says("kind") {
        Some("fabric") => figures(text)?,
        _ => {
            let test = read_fabric_test(text)?;
            let mut material = test.material;
            let mut notes = Vec::new();
            if let Some(kept) = test.kept_fold {
                material.relaxed_fraction[1] = kept;
                notes.push(format!(
                    "the hysteresis of bending (2HB) keeps {:.0} % of a fold",
                    kept * 100.0
                ));
            }
            FabricFile {
                name: says("name").map(str::to_owned),
                material,
                notes,
            }
        }
    };
    let checked = file.material.check("fabric");
    checked.map_err(|error| FormatError::new("the fabric", error.to_string(), "correct it"))?;
    Ok(file)
}

fn figures(text: &str) -> Result<FabricFile, FormatError> {
    let mut file: Figures = serde_json::from_str(text).map_err(|error| json_error(&error))?;
    if file.toile != 1 {
        return Err(FormatError::new(
            "toile",
            format!("version {} of fabric files is not known", file.toile),
            "write \"toile\": 1",
        ));
    }
    let material = file.material.material("the fabric")?;
    let unknown = file.material.take_unknown().into_iter();
    let unknown = unknown.filter(|field| field != "kind");
    Ok(FabricFile {
        name: file.name,
        material,
        notes: unknown
            .map(|field| format!("the field {field} is not known and was left out"))
            .collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_and_test_values_are_read_from_one_kind_of_file() {
        let text = r#"{ "toile": 1, "kind": "fabric", "name": "ponte", "fabric": "jersey",
            "density": 0.3, "viscosity": 0.02, "kept": [0, 0.2], "relaxation_time": 4, "gloss": 1 }"#;
        let file = read_fabric(text).unwrap();
        assert_eq!(file.name.as_deref(), Some("ponte"));
        assert_eq!(
            (file.material.density, file.material.viscosity),
            (0.3, 0.02)
        );
        assert_eq!(
            (
                file.material.relaxed_fraction,
                file.material.relaxation_time
            ),
            ([0.0, 0.2], 4.0)
        );
        assert_eq!(
            file.notes,
            ["the field gloss is not known and was left out"]
        );
        let test = read_fabric("B,0.136\n2HB,0.062\nW,26.35\n").unwrap();
        assert!(
            test.material.relaxed_fraction[1] > 0.08 && test.material.relaxed_fraction[0] == 0.0
        );
        assert_eq!(test.name, None);
    }

    #[test]
    fn figures_no_cloth_has_are_refused_with_their_place() {
        for (text, words) in [
            (
                r#"{"toile": 1, "kind": "fabric", "density": -1}"#,
                "density",
            ),
            (
                r#"{"toile": 1, "kind": "fabric", "fabric": "gold"}"#,
                "gold",
            ),
            (r#"{"toile": 2, "kind": "fabric"}"#, "version 2"),
            (r#"{"toile": 1, "kind": "fabric", "kept": 3}"#, "line 1"),
            ("B,-1", "B"),
        ] {
            let error = read_fabric(text).expect_err(text).to_string();
            assert!(error.contains(words), "{text}: {error}");
        }
    }
}
