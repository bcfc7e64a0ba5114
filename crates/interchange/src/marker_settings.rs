//! `*.marker-settings.json`: settings that a marker maker adds to a pattern: spreads, rolls, prices, print,
//! flaws, and rules for single pieces. Lengths are texts with their unit, angles degrees.

use crate::FormatError;
use crate::native::item::{Item, Object};
use crate::native::json::{self, Value as Json};
use crate::settings_reader::{SettingsReader, invalid_type, refused, unknown_field};
use std::collections::BTreeMap;
use toile_pattern::fields::{group, key};
use toile_pattern::{ClothSettings, LayingRule, Spread, fields};

const KIND: &str = "marker-settings";

/// The name that stands for every fabric or every piece; the entry of a specific name takes precedence.
pub const ANY_NAME: &str = "*";

/// The content of a file of marker settings.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MarkerSettings {
    /// Currency of the prices, as in EUR.
    pub currency: Option<String>,
    /// Settings of each fabric, by name.
    pub fabrics: BTreeMap<String, ClothSettings>,
    /// Settings of pieces, by name of the panel or of one of its pieces.
    pub pieces: BTreeMap<String, PieceSettings>,
    /// Sets of notches that lie at the same place of the print in every garment: lists of `panel.notch`.
    pub matched: Vec<Vec<String>>,
}

/// Settings of one piece. A setting that is not given has its default.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PieceSettings {
    /// Rules for laying the piece.
    pub rule: LayingRule,
    /// The fabric to cut the piece from, instead of the pattern's.
    pub fabric: Option<String>,
    /// Number of additional cuts from other fabrics, by name of the fabric.
    pub also: Option<BTreeMap<String, u32>>,
    /// Copies with a fixed position.
    pub locked: Option<Vec<LockSettings>>,
}

/// A copy with a fixed position, in the same terms as in a `marker.json`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LockSettings {
    /// Number of the copy, from 0.
    pub copy: u32,
    /// Angle from the warp to the piece's grain (rad).
    pub turn: f64,
    /// Whether the copy lies face down.
    pub face_down: bool,
    /// Translation after the rotation (m).
    pub at: [f64; 2],
}

fields!(LockSettings, |self, v| {
    let Self {
        copy,
        turn,
        face_down,
        at: [x, y],
    } = self;
    v.value(key("copy").may_lack(), copy);
    v.value(key("turn").angle().may_lack(), turn);
    v.value(key("face_down").may_lack(), face_down);
    v.list(group("at"), &mut |v| {
        v.value(key("x").length(), x);
        v.value(key("y").length(), y);
    });
});

impl PieceSettings {
    /// These settings, with missing ones filled from the more general settings `below`.
    #[must_use]
    pub fn over(self, below: &Self) -> Self {
        let Self {
            rule,
            fabric,
            also,
            locked,
        } = self;
        Self {
            rule: rule.over(&below.rule),
            fabric: fabric.or_else(|| below.fabric.clone()),
            also: also.or_else(|| below.also.clone()),
            locked: locked.or_else(|| below.locked.clone()),
        }
    }
}

/// Fields of fabric settings that are refused in this kind of file, because it expresses them in another way:
/// the length as a roll, the tilt as a rule for all pieces, the currency once for the whole file.
const SAID_OTHERWISE: [&str; 3] = ["length", "tilt", "currency"];

/// Reads a file of marker settings.
///
/// # Errors
/// The text is not JSON, not marker settings, of a newer version, has an unknown field, or a number that
/// makes no sense.
pub fn read_marker_settings(text: &str) -> Result<MarkerSettings, FormatError> {
    // Parsed by `serde_json` first, so that invalid JSON is reported in the words of the other readers.
    serde_json::from_str::<serde::de::IgnoredAny>(text).map_err(|error| {
        let place = format!("line {}, column {}", error.line(), error.column());
        let what = error.to_string();
        let what = what.split(" at line ").next().unwrap_or(&what).to_owned();
        refused(place, what)
    })?;
    let node = json::parse(text)?;
    let root = Item::root(&node);
    let known = ["toile", "kind", "currency", "fabrics", "pieces", "match"];
    let object = object(&root, "struct MarkerSettings")?;
    refuse_unknown(&root, &known)?;
    let given = |name: &str| {
        object
            .get(name)
            .filter(|item| item.node.value != Json::Null)
    };
    let kind = object.get("kind").map(|item| text_of(&item)).transpose()?;
    let version = object
        .get("toile")
        .map(|item| count_of(&item))
        .transpose()?;
    let mut settings = MarkerSettings {
        currency: given("currency").map(|item| text_of(&item)).transpose()?,
        ..MarkerSettings::default()
    };
    if let Some(fabrics) = object.get("fabrics") {
        for (name, item) in entries(&fabrics)? {
            let mut cloth = ClothSettings::default();
            let mut reader = SettingsReader::new(&item, "struct FabricSettings", &SAID_OTHERWISE);
            reader.read(&mut cloth)?;
            settings.fabrics.insert(name, cloth);
        }
    }
    if let Some(pieces) = object.get("pieces") {
        for (name, item) in entries(&pieces)? {
            let piece = piece(&item)?;
            settings.pieces.insert(name, piece);
        }
    }
    if let Some(sets) = object.get("match") {
        for set in list(&sets)? {
            let marks = list(&set)?;
            let marks: Result<_, _> = marks.iter().map(text_of).collect();
            settings.matched.push(marks?);
        }
    }
    if kind.as_deref() != Some(KIND) {
        return Err(FormatError::new(
            "kind",
            format!("these are no marker settings: the field is not {KIND:?}"),
            format!("write \"toile\": 1, \"kind\": {KIND:?} at the top"),
        ));
    }
    if version != Some(1) {
        return Err(FormatError::new(
            "toile",
            "only version 1 is known here",
            "write \"toile\": 1, or use a newer program",
        ));
    }
    check(&settings)?;
    Ok(settings)
}

/// Reads the settings of a piece.
fn piece(item: &Item<'_>) -> Result<PieceSettings, FormatError> {
    let mut settings = PieceSettings::default();
    let besides = ["fabric", "also", "locked"];
    let mut reader = SettingsReader::new(item, "struct PieceSettings", &[]).with(&besides);
    reader.read(&mut settings.rule)?;
    let object = object(item, "struct PieceSettings")?;
    let given = |name: &str| {
        object
            .get(name)
            .filter(|item| item.node.value != Json::Null)
    };
    settings.fabric = given("fabric").map(|item| text_of(&item)).transpose()?;
    if let Some(also) = given("also") {
        let counts = entries(&also)?.into_iter();
        let counts = counts.map(|(name, item)| Ok((name, count_of(&item)?)));
        settings.also = Some(counts.collect::<Result<_, FormatError>>()?);
    }
    if let Some(locked) = given("locked") {
        let mut copies = Vec::new();
        for item in list(&locked)? {
            let mut lock = LockSettings::default();
            SettingsReader::new(&item, "struct LockSettings", &[]).read(&mut lock)?;
            copies.push(lock);
        }
        settings.locked = Some(copies);
    }
    Ok(settings)
}

fn object<'a>(item: &Item<'a>, expected: &str) -> Result<Object<'a>, FormatError> {
    item.fields().map_err(|_| invalid_type(item, expected))
}

fn refuse_unknown(item: &Item<'_>, known: &[&str]) -> Result<(), FormatError> {
    let mut entries = item.entries()?.into_iter();
    match entries.find(|(name, _)| !known.contains(name)) {
        Some((name, field)) => Err(unknown_field(&field, name, known)),
        None => Ok(()),
    }
}

fn entries<'a>(item: &Item<'a>) -> Result<Vec<(String, Item<'a>)>, FormatError> {
    let entries = item.entries().map_err(|_| invalid_type(item, "a map"))?;
    Ok(entries
        .into_iter()
        .map(|(name, item)| (name.to_owned(), item))
        .collect())
}

fn list<'a>(item: &Item<'a>) -> Result<Vec<Item<'a>>, FormatError> {
    item.list().map_err(|_| invalid_type(item, "a sequence"))
}

fn text_of(item: &Item<'_>) -> Result<String, FormatError> {
    let text = item.text().map_err(|_| invalid_type(item, "a string"))?;
    Ok(text.to_owned())
}

fn count_of(item: &Item<'_>) -> Result<u32, FormatError> {
    item.count().map_err(|_| invalid_type(item, "u32"))
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
        if piece.rule.turns.as_ref().is_some_and(Vec::is_empty) {
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
    use toile_pattern::NapRule;

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
        assert_eq!(twill.width, Some(1.5));
        assert_eq!(twill.nap, Some(NapRule::PerGarment));
        assert_eq!(twill.spread, Some(Spread::FaceToFace));
        assert_eq!(twill.flaws.as_ref().unwrap()[0].size, [0.03, 0.0254]);
        assert_eq!(twill.rolls.as_ref().unwrap().len(), 2);
        assert_eq!(settings.pieces["*"].rule.tilt, Some(2.0_f64.to_radians()));
        assert_eq!(settings.pieces["front"].rule.block, Some(0.02));
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
