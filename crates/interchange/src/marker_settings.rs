//! `*.marker-settings.json`: settings that a marker maker adds to a pattern: spreads, rolls, prices, print,
//! flaws, and rules for single pieces. Lengths are texts with their unit, angles degrees.

use crate::FormatError;
use serde::de::{Error as _, Visitor};
use serde::{Deserialize, Deserializer};
use std::collections::BTreeMap;
use std::fmt;
use toile_geometry::Length;
use toile_nesting::Nap;
use toile_pattern::Spread;

const KIND: &str = "marker-settings";

/// The name that stands for any fabric, or any piece: for what its own entry leaves open.
pub const ANY_NAME: &str = "*";

/// The content of a file of marker settings.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MarkerSettings {
    /// Version of the format: 1.
    #[serde(default)]
    pub toile: u32,
    /// What kind of file this is: `marker-settings`.
    #[serde(default)]
    pub kind: String,
    /// Currency of prices, as in EUR.
    #[serde(default)]
    pub currency: Option<String>,
    /// By name of the fabric.
    #[serde(default)]
    pub fabrics: BTreeMap<String, FabricSettings>,
    /// By name of the panel, or of one of its pieces.
    #[serde(default)]
    pub pieces: BTreeMap<String, PieceSettings>,
    /// Marks that lie on the same place of the print in every garment: lists of `panel.notch`.
    #[serde(default, rename = "match")]
    pub matched: Vec<Vec<String>>,
}

/// Settings of a fabric. A setting that is not given is the pattern's, or the default.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FabricSettings {
    /// Full width, selvedges included; of a tube its girth.
    pub width: Option<Metres>,
    /// Unusable edge at either side.
    pub selvedge: Option<Metres>,
    /// Fabric left free at either end.
    pub end_margin: Option<Metres>,
    /// Least distance between pieces.
    pub gap: Option<Metres>,
    /// Nap.
    pub nap: Option<NapField>,
    /// How it is spread.
    pub spread: Option<Spread>,
    /// Layers cut at once.
    pub plies: Option<u32>,
    /// Price of a metre of length.
    pub price_per_metre: Option<f64>,
    /// Print that repeats.
    pub print: Option<PrintSettings>,
    /// Flaws no piece may lie on; none where the list is empty.
    pub flaws: Option<Vec<FlawSettings>>,
    /// Rolls at hand, filled in this order. Without any, as much as it takes.
    pub rolls: Option<Vec<RollSettings>>,
}

/// A roll of fabric.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RollSettings {
    /// Name for messages and files.
    pub name: Option<String>,
    /// Full width; the fabric's if it is not given.
    pub width: Option<Metres>,
    /// Length; as long as it takes if it is not given.
    pub length: Option<Metres>,
    /// Price of a metre of length; the fabric's if it is not given.
    pub price_per_metre: Option<f64>,
    /// Its flaws, none where the list is empty; the fabric's if they are not given.
    pub flaws: Option<Vec<FlawSettings>>,
}

/// A print that repeats.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PrintSettings {
    /// Length of a repeat along the warp and across; 0mm where it does not repeat.
    pub repeat: [Metres; 2],
    /// A point where lines of the print cross.
    #[serde(default)]
    pub origin: [Metres; 2],
}

/// A flaw: a rectangle of the fabric.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FlawSettings {
    /// Its corner nearest to the start: along the warp and across.
    pub at: [Metres; 2],
    /// Its length and width.
    pub size: [Metres; 2],
    /// Distance pieces keep from it.
    #[serde(default)]
    pub clearance: Metres,
}

/// Settings of one piece. A setting that is not given is the default.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PieceSettings {
    /// Free fabric it needs to any other.
    pub gap: Option<Metres>,
    /// Extra fabric cut all round it, to be cut to shape later.
    pub block: Option<Metres>,
    /// How far its grain may lie off \[deg\].
    pub tilt: Option<f64>,
    /// Angles its grain may have to the warp \[deg\].
    pub turns: Option<Vec<f64>>,
    /// Whether it may be turned over.
    pub turn_over: Option<bool>,
    /// Where the fabric is folded and the panel too: whether half of it lies on the fold.
    pub on_fold: Option<bool>,
    /// Whether it may hide flaws.
    pub over_flaws: Option<bool>,
    /// Whether its hem and middle lie on the print.
    pub on_print: Option<bool>,
    /// The fabric it is cut from instead of the pattern's.
    pub fabric: Option<String>,
    /// How often it is cut from further fabrics too.
    pub also: Option<BTreeMap<String, u32>>,
    /// Copies that have their place already.
    pub locked: Option<Vec<LockSettings>>,
}

/// A copy that stays where it is, in the terms of a `marker.json`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LockSettings {
    /// Number of the copy, from 0.
    #[serde(default)]
    pub copy: u32,
    /// Angle from the warp to the piece's grain \[deg\].
    #[serde(default)]
    pub turn: f64,
    /// Whether it lies face down.
    #[serde(default)]
    pub face_down: bool,
    /// Move after turning.
    pub at: [Metres; 2],
}

/// A length written as text with its unit, held in metres.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct Metres(pub f64);

impl<'de> Deserialize<'de> for Metres {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Text;
        impl Visitor<'_> for Text {
            type Value = Metres;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a length as text with its unit, as in \"150cm\"")
            }

            fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<Metres, E> {
                let length: Length = text.parse().map_err(E::custom)?;
                Ok(Metres(length.as_metres()))
            }
        }
        deserializer.deserialize_str(Text)
    }
}

/// A nap by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NapField(pub Nap);

impl<'de> Deserialize<'de> for NapField {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match String::deserialize(deserializer)?.as_str() {
            "none" => Ok(Self(Nap::None)),
            "one-way" => Ok(Self(Nap::OneWay)),
            "per-garment" => Ok(Self(Nap::PerBundle)),
            other => Err(D::Error::custom(format!(
                "{other:?} is no nap; write none, one-way or per-garment"
            ))),
        }
    }
}

/// Reads a file of marker settings.
///
/// # Errors
/// The text is not JSON, not marker settings, of a newer version, has a field that is not known
/// here, or a number that makes no sense.
pub fn read_marker_settings(text: &str) -> Result<MarkerSettings, FormatError> {
    let broken = |error: serde_json::Error| {
        let place = format!("line {}, column {}", error.line(), error.column());
        let what = error.to_string();
        let what = what.split(" at line ").next().unwrap_or(&what).to_owned();
        FormatError::new(place, what, "see docs/FORMATS.md, marker settings")
    };
    let settings: MarkerSettings = serde_json::from_str(text).map_err(broken)?;
    if settings.kind != KIND {
        return Err(FormatError::new(
            "kind",
            format!("these are no marker settings: the field is not {KIND:?}"),
            format!("write \"toile\": 1, \"kind\": {KIND:?} at the top"),
        ));
    }
    if settings.toile != 1 {
        return Err(FormatError::new(
            "toile",
            "only version 1 is known here",
            "write \"toile\": 1, or use a newer program",
        ));
    }
    check(&settings)?;
    Ok(settings)
}

fn check(settings: &MarkerSettings) -> Result<(), FormatError> {
    let refuse = |place: String, what: String, hint: &str| Err(FormatError::new(place, what, hint));
    for (name, fabric) in &settings.fabrics {
        let place = format!("fabrics.{name}");
        let rolls = fabric.rolls.iter().flatten();
        let prices = rolls.map(|r| r.price_per_metre);
        for price in prices.chain([fabric.price_per_metre]).flatten() {
            if !(price.is_finite() && price >= 0.0) {
                let what = format!("the price is {price}");
                return refuse(place, what, "give 0 or more");
            }
        }
        let spread = fabric.spread.unwrap_or_default();
        let plies = fabric.plies.unwrap_or(spread.usual_plies());
        if !spread.allows(plies) {
            let what = format!("it is spread in {plies} plies");
            return refuse(place, what, Spread::PLIES);
        }
    }
    for (k, set) in settings.matched.iter().enumerate() {
        let place = format!("match[{k}]");
        if set.len() < 2 {
            return refuse(place, "it names fewer than two marks".into(), "name two");
        }
        if let Some(mark) = set.iter().find(|mark| !mark.contains('.')) {
            let what = format!("{mark:?} is no mark");
            return refuse(place, what, "write panel.notch, as in front.hip");
        }
    }
    for (name, piece) in &settings.pieces {
        if piece.turns.as_ref().is_some_and(Vec::is_empty) {
            let what = "it may lie in no direction".into();
            let hint = "give at least one turn, as in [0]";
            return refuse(format!("pieces.{name}.turns"), what, hint);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = r#"{ "toile": 1, "kind": "marker-settings", "currency": "EUR",
      "fabrics": { "twill": { "width": "150cm", "nap": "per-garment", "spread": "face-to-face",
        "plies": 4, "price_per_metre": 11.5,
        "print": { "repeat": ["50mm", "0mm"] },
        "flaws": [ { "at": ["1m", "0.2m"], "size": ["30mm", "1in"], "clearance": "5mm" } ],
        "rolls": [ { "name": "A", "length": "3m" }, { "width": "140cm" } ] } },
      "pieces": { "*": { "tilt": 2 }, "front": { "gap": "4mm", "block": "2cm", "turns": [0],
        "locked": [ { "at": ["1cm", "2cm"] } ], "also": { "interfacing": 1 } } },
      "match": [ ["front.hip", "back.hip"] ] }"#;

    #[test]
    fn settings_are_read_in_metres() {
        let settings = read_marker_settings(GOOD).unwrap();
        let twill = &settings.fabrics["twill"];
        assert_eq!(twill.width, Some(Metres(1.5)));
        assert_eq!(twill.nap, Some(NapField(Nap::PerBundle)));
        assert_eq!(twill.spread, Some(Spread::FaceToFace));
        assert_eq!(
            twill.flaws.as_ref().unwrap()[0].size,
            [Metres(0.03), Metres(0.0254)]
        );
        assert_eq!(twill.rolls.as_ref().unwrap().len(), 2);
        assert_eq!(settings.pieces["*"].tilt, Some(2.0));
        assert_eq!(settings.pieces["front"].block, Some(Metres(0.02)));
        assert_eq!(settings.matched[0][1], "back.hip");
    }

    #[test]
    fn what_is_wrong_is_named_with_its_place() {
        for (old, new, place, what) in [
            ("marker-settings", "pattern", "kind", "no marker settings"),
            ("\"toile\": 1", "\"toile\": 7", "toile", "version"),
            ("\"150cm\"", "150", "line 2", "unit"),
            ("\"150cm\"", "\"150\"", "line 2", "no unit"),
            ("\"width\"", "\"witdh\"", "line 2", "witdh"),
            ("per-garment", "sometimes", "line 2", "sometimes"),
            ("\"plies\": 4", "\"plies\": 3", "fabrics.twill", "3 plies"),
            ("\"plies\": 4", "\"plies\": 0", "fabrics.twill", "0 plies"),
            ("11.5", "-1", "fabrics.twill", "price"),
            (
                "\"turns\": [0]",
                "\"turns\": []",
                "pieces.front",
                "direction",
            ),
            ("\"back.hip\"", "\"back\"", "match[0]", "back"),
            (", \"back.hip\"", "", "match[0]", "two marks"),
        ] {
            assert!(GOOD.contains(old), "{old}");
            let error = read_marker_settings(&GOOD.replacen(old, new, 1)).unwrap_err();
            assert!(error.place.starts_with(place), "{old}: {error}");
            assert!(error.to_string().contains(what), "{old}: {error}");
        }
        assert!(read_marker_settings("").is_err());
        assert!(read_marker_settings(&GOOD[..200]).is_err());
    }
}
