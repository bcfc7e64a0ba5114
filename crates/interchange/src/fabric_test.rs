//! Textile test values of one fabric: KES-F, cantilever and Cusick readings, as JSON or CSV.
//!
//! JSON: `{ "kes": { "B": [0.12, 0.08], "2HB": [..], "G": 0.9, ... }, "cantilever": { ... },
//! "cusick": { ... } }`. CSV: one property a line, `name, warp, weft`; a single value stands for
//! both warp and weft. Units are those of the tests: see docs/FORMATS.md.

use crate::FormatError;
use serde_json::{Map, Value};
use toile_fabric::kes::{bending_of_length, bending_of_overhang, drape_coefficient};
use toile_fabric::{KesValues, Material};

/// The test values of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct FabricTest {
    /// Material with the tested values; values that were not measured are those of [`Material::default`].
    pub material: Material,
    /// Share of a fold that remains in the unloaded fabric (1); `None` if the file gives no bending
    /// hysteresis (2HB) or no bending stiffness (B).
    pub kept_fold: Option<f64>,
    /// Cusick's drape coefficient (%), to compare a simulated drape with.
    pub drape_coefficient: Option<f64>,
}

/// Reads test values; text that begins with `{` is JSON, other text CSV.
///
/// # Errors
/// Text of neither kind, unknown names, values that are missing or are not numbers.
pub fn read_fabric_test(text: &str) -> Result<FabricTest, FormatError> {
    let values = if text.trim_start().starts_with('{') {
        json(text)?
    } else {
        csv(text)?
    };
    if values.is_empty() {
        return Err(FormatError::new(
            "the whole file",
            "it holds no test value",
            "write names and values, as in B,0.12,0.08",
        ));
    }
    Reader { values }.read()
}

/// Names of the test values, each with the object that holds it in the JSON form.
const NAMES: [(&str, &str); 18] = [
    ("kes", "B"),
    ("kes", "2HB"),
    ("kes", "G"),
    ("kes", "2HG"),
    ("kes", "EM"),
    ("kes", "LT"),
    ("kes", "WT"),
    ("kes", "RT"),
    ("kes", "T0"),
    ("kes", "W"),
    ("kes", "MIU"),
    ("cantilever", "bending_length"),
    ("cantilever", "overhang"),
    ("cantilever", "angle"),
    ("cusick", "drape_coefficient"),
    ("cusick", "shadow_area"),
    ("cusick", "specimen_radius"),
    ("cusick", "disc_radius"),
];

type Values = Vec<(&'static str, [f64; 2])>;

fn json(text: &str) -> Result<Values, FormatError> {
    let root: Map<String, Value> = serde_json::from_str(text).map_err(|error| {
        let place = format!("line {}, column {}", error.line(), error.column());
        FormatError::new(place, error.to_string(), "see docs/FORMATS.md")
    })?;
    let mut values = Values::new();
    for (group, fields) in &root {
        if group == "name" {
            continue;
        }
        let Some(fields) = fields.as_object() else {
            return Err(unknown(group, group));
        };
        for (name, value) in fields {
            let place = format!("{group}.{name}");
            let known = NAMES.iter().find(|(g, n)| g == group && n == name);
            let &(_, known) = known.ok_or_else(|| unknown(&place, name))?;
            let number = |value: &Value| value.as_f64();
            let pair = match value.as_array().map(Vec::as_slice) {
                Some([warp, weft]) => number(warp).zip(number(weft)),
                _ => number(value).map(|v| (v, v)),
            };
            let (warp, weft) = pair.ok_or_else(|| no_number(place))?;
            values.push((known, [warp, weft]));
        }
    }
    Ok(values)
}

fn csv(text: &str) -> Result<Values, FormatError> {
    let mut values = Values::new();
    for (line, row) in text.lines().enumerate() {
        let row = row.split('#').next().unwrap_or_default().trim();
        let mut cells = row
            .split(',')
            .map(str::trim)
            .filter(|cell| !cell.is_empty());
        let Some(name) = cells.next() else {
            continue;
        };
        let place = format!("line {}", line + 1);
        let known = NAMES.iter().find(|(_, n)| *n == name);
        // The first line may name the columns.
        if line == 0 && known.is_none() && cells.clone().all(|cell| cell.parse::<f64>().is_err()) {
            continue;
        }
        let &(_, known) = known.ok_or_else(|| unknown(&place, name))?;
        let numbers: Option<Vec<f64>> = cells.map(|cell| cell.parse().ok()).collect();
        match numbers.as_deref() {
            Some([both]) => values.push((known, [*both, *both])),
            Some([warp, weft]) => values.push((known, [*warp, *weft])),
            _ => return Err(no_number(place)),
        }
    }
    Ok(values)
}

fn unknown(place: &str, name: &str) -> FormatError {
    let known: Vec<_> = NAMES.iter().map(|(_, name)| *name).collect();
    FormatError::new(
        place.to_owned(),
        format!("\"{name}\" is not a test value"),
        format!("write one of {}", known.join(", ")),
    )
}

fn no_number(place: String) -> FormatError {
    FormatError::new(
        place,
        "it is no number, and no pair of warp and weft".to_owned(),
        "write one or two numbers".to_owned(),
    )
}

struct Reader {
    values: Values,
}

impl Reader {
    /// Values of a property along warp and weft, which must be finite and above zero.
    fn pair(&self, name: &str) -> Result<Option<[f64; 2]>, FormatError> {
        let Some(&(_, pair)) = self.values.iter().find(|(n, _)| *n == name) else {
            return Ok(None);
        };
        if pair.iter().all(|v| v.is_finite() && *v > 0.0) {
            return Ok(Some(pair));
        }
        Err(FormatError::new(
            name.to_owned(),
            "it is out of range".to_owned(),
            "give numbers above zero".to_owned(),
        ))
    }

    fn single(&self, name: &str) -> Result<Option<f64>, FormatError> {
        Ok(self.pair(name)?.map(|[a, b]| 0.5 * (a + b)))
    }

    fn read(&self) -> Result<FabricTest, FormatError> {
        let usual = Material::default();
        let mut material = usual.clone();
        if let Some(w) = self.single("W")? {
            material.density = toile_fabric::kes::weight(w);
        }
        if let Some(t) = self.single("T0")? {
            material.thickness = t * 1e-3;
        }
        if let Some(friction) = self.single("MIU")? {
            material.friction = friction;
        }
        if let Some(g) = self.single("G")? {
            material.shear = toile_fabric::kes::shear(g);
        }
        self.tensile(&mut material)?;
        let kept_fold = self.bending(&mut material)?;
        Ok(FabricTest {
            material,
            kept_fold,
            drape_coefficient: self.cusick()?,
        })
    }

    /// Sets the tensile values of a material from EM (extension) and LT (linearity). If one of them is missing,
    /// it is computed from the other and the energy WT: WT = LT EM 500 gf/cm / 2.
    fn tensile(&self, material: &mut Material) -> Result<(), FormatError> {
        let (lt, wt) = (self.pair("LT")?, self.pair("WT")?);
        let em = match (self.pair("EM")?, lt, wt) {
            (Some(em), _, _) => Some(em),
            (None, Some(lt), Some(wt)) => Some([0, 1].map(|k| 100.0 * wt[k] / (250.0 * lt[k]))),
            _ => None,
        };
        let Some(em) = em else {
            return Ok(());
        };
        let lt = match (lt, wt) {
            (Some(lt), _) => lt,
            (None, Some(wt)) => [0, 1].map(|k| 100.0 * wt[k] / (250.0 * em[k])),
            (None, None) => [1.0; 2],
        };
        for k in 0..2 {
            let (stiffness, hardening) = toile_fabric::kes::tensile_curve(em[k], lt[k]);
            material.stretch[k] = stiffness;
            material.hardening[k] = hardening;
        }
        material.poisson = 0.0;
        Ok(())
    }

    /// Sets the bending stiffness of a material from B, or from the cantilever test if B is missing. Returns
    /// the share of a fold that remains (1), if B and 2HB are given.
    fn bending(&self, material: &mut Material) -> Result<Option<f64>, FormatError> {
        let density = material.density;
        let mut kept = None;
        let bend = if let Some(bending) = self.pair("B")? {
            if let Some(bending_hysteresis) = self.pair("2HB")? {
                let values = KesValues {
                    bending,
                    bending_hysteresis,
                    shear: 1.0,
                    shear_hysteresis: 1.0,
                    extension: [1.0; 2],
                    linearity: [1.0; 2],
                    resilience: [100.0; 2],
                    thickness: 1.0,
                    weight: 1.0,
                    friction: 0.0,
                };
                kept = Some(values.kept_fold());
            }
            Some(bending.map(toile_fabric::kes::bending))
        } else if let Some(length) = self.pair("bending_length")? {
            Some(length.map(|c| bending_of_length(density, c * 1e-3)))
        } else if let Some(overhang) = self.pair("overhang")? {
            let angle = self.single("angle")?.unwrap_or(41.5);
            let found =
                overhang.map(|l| bending_of_overhang(density, l * 1e-3, angle.to_radians()));
            match found {
                [Some(warp), Some(weft)] => Some([warp, weft]),
                _ => {
                    return Err(FormatError::new(
                        "angle".to_owned(),
                        "the strip hangs too steeply to measure".to_owned(),
                        "give an angle between 0 and 85 degrees".to_owned(),
                    ));
                }
            }
        } else {
            None
        };
        if let Some([warp, weft]) = bend {
            material.bend = [warp, weft, 0.5 * (warp + weft)];
        }
        Ok(kept)
    }

    fn cusick(&self) -> Result<Option<f64>, FormatError> {
        if let Some(given) = self.single("drape_coefficient")? {
            return Ok(Some(given));
        }
        let Some(area) = self.single("shadow_area")? else {
            return Ok(None);
        };
        let specimen = self.single("specimen_radius")?.unwrap_or(15.0);
        let disc = self.single("disc_radius")?.unwrap_or(9.0);
        Ok(Some(drape_coefficient(area, specimen, disc)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const JSON: &str = r#"{ "name": "suiting", "kes": { "B": 0.136, "2HB": 0.062, "G": 0.968,
        "EM": [6, 5], "LT": 0.608, "T0": 0.746, "W": 26.35, "MIU": 0.2085 },
        "cusick": { "shadow_area": 400 } }"#;

    #[test]
    fn json_and_csv_say_the_same() {
        let a = read_fabric_test(JSON).unwrap();
        let text = "property,warp,weft\nB,0.136\n2HB,0.062\nG,0.968\nEM,6,5\nLT,0.608,0.608\n\
                    T0,0.746\nW,26.35 # mg/cm2\nMIU,0.2085\nshadow_area,400\n";
        assert_eq!(read_fabric_test(text).unwrap(), a);
        assert!((a.material.density - 0.2635).abs() < 1e-12);
        assert!((a.material.bend[0] - 0.136 * 98.0665e-6).abs() < 1e-12);
        assert!(a.material.stretch[1] > a.material.stretch[0]);
        assert!(a.kept_fold.unwrap() > 0.08);
        let expected = 100.0 * (400.0 / std::f64::consts::PI - 81.0) / 144.0;
        assert!((a.drape_coefficient.unwrap() - expected).abs() < 1e-9);
        assert!(a.material.in_domain().is_ok());
    }

    #[test]
    fn energy_stands_for_extension_and_an_overhang_for_bending() {
        let test =
            read_fabric_test("WT,9.12\nLT,0.608\nW,20\noverhang,50,40\nangle,41.5\n").unwrap();
        let same = read_fabric_test("EM,6\nLT,0.608\n").unwrap();
        assert!((test.material.stretch[0] / same.material.stretch[0] - 1.0).abs() < 1e-12);
        let expected = 0.2 * 9.80665 * 0.05f64.powi(3) / 8.0042;
        assert!((test.material.bend[0] / expected - 1.0).abs() < 1e-4);
    }

    #[test]
    fn what_is_wrong_is_named() {
        for (text, place) in [
            ("{", "line 1"),
            (r#"{"kes": {"Q": 1}}"#, "kes.Q"),
            (r#"{"kes": {"B": "soft"}}"#, "kes.B"),
            (r#"{"kes": 3}"#, "kes"),
            ("property,warp,weft\nG,1,2,3", "line 2"),
            ("B,soft\nG,1", "line 1"),
            ("hello\n", "the whole file"),
            (r#"{"name": "suiting"}"#, "the whole file"),
            ("B,-1", "B"),
            ("B,NaN", "B"),
            ("overhang,50\nangle,89", "angle"),
        ] {
            let error = read_fabric_test(text).expect_err(text);
            assert!(error.place.starts_with(place), "{text}: {error}");
        }
    }
}
