//! Markers as journals write them: the fabric within the cloth, defaults written out. What is given and is as by default
//! is named, so that it stays given.

use super::{
    ClothSettings, Flaw, Marker, MatchedMarks, NapRule, OrderedSize, PiecePlacement, PieceRule,
    Print, Roll, Spread,
};
use crate::{FabricId, MarkerId};
use serde::{Deserialize, Serialize};

/// A marker in a journal.
#[derive(Serialize, Deserialize)]
pub(super) struct MarkerRecord {
    id: MarkerId,
    name: String,
    cloth: ClothRecord,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    rules: Vec<PieceRule>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    matched: Vec<MatchedMarks>,
    order: Vec<OrderedSize>,
    placements: Vec<PiecePlacement>,
}

/// Its fabric, and how that is laid.
#[derive(Serialize, Deserialize)]
struct ClothRecord {
    fabric: FabricId,
    #[serde(default)]
    keeps_fabric: bool,
    width: Option<f64>,
    length: Option<f64>,
    selvedge: f64,
    end_margin: f64,
    gap: f64,
    nap: Option<NapRule>,
    tilt: f64,
    spread: Spread,
    plies: u32,
    price_per_metre: Option<f64>,
    currency: String,
    print: Option<Print>,
    flaws: Vec<Flaw>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    rolls: Option<Vec<Roll>>,
    /// Fields that are given though they are as by default.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    given: Vec<String>,
}

/// What is written of a field that may be left open: itself or the default; and that it is given where that does not
/// show.
struct Written(Vec<String>);

impl Written {
    fn or<T: PartialEq>(&mut self, name: &str, given: Option<T>, usual: T) -> T {
        if given.as_ref() == Some(&usual) {
            self.0.push(name.to_owned());
        }
        given.unwrap_or(usual)
    }
}

impl From<Marker> for MarkerRecord {
    fn from(marker: Marker) -> Self {
        let Marker {
            id,
            name,
            fabric,
            keeps_fabric,
            cloth,
            rules,
            matched,
            order,
            placements,
        } = marker;
        let usual = usual(cloth.spread.unwrap_or_default());
        let mut written = Written(Vec::new());
        let ClothSettings {
            width,
            length,
            selvedge,
            end_margin,
            gap,
            nap,
            tilt,
            spread,
            plies,
            price_per_metre,
            currency,
            print,
            flaws,
            rolls,
        } = cloth;
        let cloth = ClothRecord {
            fabric,
            keeps_fabric,
            width,
            length,
            selvedge: written.or("selvedge", selvedge, usual.selvedge),
            end_margin: written.or("end_margin", end_margin, usual.end_margin),
            gap: written.or("gap", gap, usual.gap),
            nap,
            tilt: written.or("tilt", tilt, usual.tilt),
            spread: written.or("spread", spread, usual.spread),
            plies: written.or("plies", plies, usual.plies),
            price_per_metre,
            currency: written.or("currency", currency, usual.currency),
            print,
            flaws: written.or("flaws", flaws, usual.flaws),
            rolls,
            given: written.0,
        };
        Self {
            id,
            name,
            cloth,
            rules,
            matched,
            order,
            placements,
        }
    }
}

impl From<MarkerRecord> for Marker {
    fn from(record: MarkerRecord) -> Self {
        let MarkerRecord {
            id,
            name,
            cloth,
            rules,
            matched,
            order,
            placements,
        } = record;
        let usual = usual(cloth.spread);
        let given =
            |name: &str, is_usual: bool| !is_usual || cloth.given.iter().any(|own| own == name);
        let settings = ClothSettings {
            width: cloth.width,
            length: cloth.length,
            selvedge: given("selvedge", cloth.selvedge == usual.selvedge).then_some(cloth.selvedge),
            end_margin: given("end_margin", cloth.end_margin == usual.end_margin)
                .then_some(cloth.end_margin),
            gap: given("gap", cloth.gap == usual.gap).then_some(cloth.gap),
            nap: cloth.nap,
            tilt: given("tilt", cloth.tilt == usual.tilt).then_some(cloth.tilt),
            spread: given("spread", cloth.spread == usual.spread).then_some(cloth.spread),
            plies: given("plies", cloth.plies == usual.plies).then_some(cloth.plies),
            price_per_metre: cloth.price_per_metre,
            currency: given("currency", cloth.currency.is_empty()).then(|| cloth.currency.clone()),
            print: cloth.print,
            flaws: given("flaws", cloth.flaws.is_empty()).then(|| cloth.flaws.clone()),
            rolls: cloth.rolls.clone(),
        };
        Self {
            id,
            name,
            fabric: cloth.fabric,
            keeps_fabric: cloth.keeps_fabric,
            cloth: settings,
            rules,
            matched,
            order,
            placements,
        }
    }
}

/// What journals write where nothing is given: the defaults of fabric spread so.
fn usual(spread: Spread) -> ClothRecord {
    ClothRecord {
        fabric: FabricId::default(),
        keeps_fabric: false,
        width: None,
        length: None,
        selvedge: super::DEFAULT_SELVEDGE,
        end_margin: 0.0,
        gap: super::DEFAULT_GAP,
        nap: None,
        tilt: 0.0,
        spread: Spread::default(),
        plies: spread.usual_plies(),
        price_per_metre: None,
        currency: String::new(),
        print: None,
        flaws: Vec::new(),
        rolls: None,
        given: Vec::new(),
    }
}
