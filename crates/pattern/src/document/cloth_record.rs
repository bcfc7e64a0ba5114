//! The cloth of a marker as journals write it: with its fabric and with defaults written out. Settings that
//! are given but equal to their default are listed by name, which tells them from settings that are not given.

use super::{ClothSettings, Flaw, NapRule, Print, Roll, Spread};
use crate::FabricId;
use serde::{Deserialize, Serialize};

/// The fabric of a marker and its cloth settings, as one record of a journal.
#[derive(Serialize, Deserialize)]
pub(super) struct ClothRecord {
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
    /// Names of the settings that are given although they equal their default.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    given: Vec<String>,
}

/// Names of the settings that are given and equal to their default, collected while a record is written. A
/// record writes the default for a setting that is not given; the list of names tells the two apart.
struct Written(Vec<String>);

impl Written {
    fn or<T: PartialEq>(&mut self, name: &str, given: Option<T>, usual: T) -> T {
        if given.as_ref() == Some(&usual) {
            self.0.push(name.to_owned());
        }
        given.unwrap_or(usual)
    }
}

impl ClothRecord {
    /// The record of a marker's fabric and settings. `keeps_fabric`: all pieces lie on this fabric, even if
    /// the garment is cut from another.
    pub(super) fn new(fabric: FabricId, keeps_fabric: bool, cloth: ClothSettings) -> Self {
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
        Self {
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
        }
    }

    /// The fabric of the marker, and whether all pieces lie on it even if the garment is cut from another.
    pub(super) const fn fabric(&self) -> (FabricId, bool) {
        (self.fabric, self.keeps_fabric)
    }

    /// The cloth settings that this record stands for.
    pub(super) fn settings(self) -> ClothSettings {
        let usual = usual(self.spread);
        let given =
            |name: &str, is_usual: bool| !is_usual || self.given.iter().any(|own| own == name);
        ClothSettings {
            width: self.width,
            length: self.length,
            selvedge: given("selvedge", self.selvedge == usual.selvedge).then_some(self.selvedge),
            end_margin: given("end_margin", self.end_margin == usual.end_margin)
                .then_some(self.end_margin),
            gap: given("gap", self.gap == usual.gap).then_some(self.gap),
            nap: self.nap,
            tilt: given("tilt", self.tilt == usual.tilt).then_some(self.tilt),
            spread: given("spread", self.spread == usual.spread).then_some(self.spread),
            plies: given("plies", self.plies == usual.plies).then_some(self.plies),
            price_per_metre: self.price_per_metre,
            currency: given("currency", self.currency.is_empty()).then_some(self.currency),
            print: self.print,
            flaws: given("flaws", self.flaws.is_empty()).then_some(self.flaws),
            rolls: self.rolls,
        }
    }
}

/// The values that journals write for settings that are not given: the defaults for this way of spreading.
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
