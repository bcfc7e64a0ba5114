//! How fabric is laid to be cut: the same settings on the command line, in a file of settings and in a marker of the
//! document. What one leaves open is that of the next below it.

use crate::fields::{Choice, FieldFault, group, key};
use crate::{Fabric, fields};
use serde::{Deserialize, Serialize};
use strum::{VariantArray, VariantNames};

/// Unusable edge at either side of fabric where nothing else is said (m).
pub const DEFAULT_SELVEDGE: f64 = 0.010;
/// Room for the blade between two pieces where nothing else is said (m).
pub const DEFAULT_GAP: f64 = 0.002;

/// Which way pieces may point along the warp.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    Hash,
    VariantArray,
    VariantNames,
    Serialize,
    Deserialize,
)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum NapRule {
    /// Each either way.
    #[default]
    None,
    /// All one way.
    OneWay,
    /// All pieces of a garment one way.
    PerGarment,
}

/// How fabric is spread on the table.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    Hash,
    VariantArray,
    VariantNames,
    Serialize,
    Deserialize,
)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum Spread {
    /// Open, all plies with the right side up.
    #[default]
    Open,
    /// Folded in two along the warp, selvedge on selvedge.
    Folded,
    /// A tube laid flat: a fold at both sides.
    Tubular,
    /// Open, every second ply turned over: what is cut comes in pairs.
    FaceToFace,
}

impl Choice for NapRule {}
impl Choice for Spread {}

impl Spread {
    /// The numbers of plies that are right.
    pub const PLIES: &'static str = "give 1 or more, face to face an even number";

    /// Layers cut at once where nothing is said.
    pub fn usual_plies(self) -> u32 {
        match self {
            Self::FaceToFace => 2,
            Self::Open | Self::Folded | Self::Tubular => 1,
        }
    }

    /// Whether fabric can be spread so in so many plies.
    pub fn allows(self, plies: u32) -> bool {
        plies > 0 && (self != Self::FaceToFace || plies.is_multiple_of(2))
    }
}

/// A print that repeats.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Print {
    /// Length of a repeat along the warp and across (m); 0 where it does not repeat.
    pub repeat: [f64; 2],
    /// A point where lines of the print cross (m).
    pub origin: [f64; 2],
}

fields!(Print, |self, v| {
    let Self {
        repeat: [along, across],
        origin: [x, y],
    } = self;
    v.list(group("repeat"), &mut |v| {
        v.value(key("along").length(), along);
        v.value(key("across").length(), across);
    });
    let is_zero = [*x, *y].map(f64::to_bits) == [0; 2];
    v.list(group("origin").left_out_if(is_zero), &mut |v| {
        v.value(key("x").length(), x);
        v.value(key("y").length(), y);
    });
});

/// A flaw: a rectangle of the fabric laid open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Flaw {
    /// Its corner nearest to the start: along the warp and across (m).
    pub at: [f64; 2],
    /// Its length and width (m).
    pub size: [f64; 2],
    /// Distance pieces keep from it (m).
    pub clearance: f64,
}

fields!(Flaw, |self, v| {
    let Self {
        at: [x, y],
        size: [long, wide],
        clearance,
    } = self;
    v.list(group("at"), &mut |v| {
        v.value(key("x").length(), x);
        v.value(key("y").length(), y);
    });
    v.list(group("size"), &mut |v| {
        v.value(key("length").length(), long);
        v.value(key("width").length(), wide);
    });
    v.value(
        key("clearance")
            .length()
            .left_out_if(clearance.to_bits() == 0),
        clearance,
    );
});

/// A roll of fabric. What it leaves open is that of the fabric.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Roll {
    /// Name for messages and files; without one it is numbered.
    pub name: Option<String>,
    /// Full width (m).
    pub width: Option<f64>,
    /// Length, all plies together (m); without one as long as it takes.
    pub length: Option<f64>,
    /// Price of a metre of length.
    pub price_per_metre: Option<f64>,
    /// Its flaws, none where the list is empty.
    pub flaws: Option<Vec<Flaw>>,
}

/// A field that may be left out: whether it is there, then the field.
macro_rules! given {
    ($v:ident, $field:ident) => {
        given!($v, $field, key(stringify!($field)))
    };
    ($v:ident, $field:ident, $how:expr) => {
        $v.optional(stringify!($field), $field);
        if let Some(value) = $field {
            $v.value($how, value);
        }
    };
}

/// The same of a list, which may be there and empty.
macro_rules! given_list {
    ($v:ident, $field:ident) => {
        $v.optional(stringify!($field), $field);
        if let Some(list) = $field {
            $v.each(group(stringify!($field)).even_empty(), list);
        }
    };
}

fields!(Roll, |self, v| {
    let Self {
        name,
        width,
        length,
        price_per_metre,
        flaws,
    } = self;
    given!(v, name);
    given!(v, width, key("width").length());
    given!(v, length, key("length").length());
    given!(v, price_per_metre);
    given_list!(v, flaws);
});

/// How fabric is laid to be cut. What is not given is that of what lies below: other settings, the fabric, the default.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ClothSettings {
    /// Full width laid open, of a tube its girth (m).
    pub width: Option<f64>,
    /// Length at hand, all plies together (m); by default as much as it takes.
    pub length: Option<f64>,
    /// Unusable edge at either side (m).
    pub selvedge: Option<f64>,
    /// Fabric left free at either end (m).
    pub end_margin: Option<f64>,
    /// Least distance between two pieces (m).
    pub gap: Option<f64>,
    /// Which way pieces may point.
    pub nap: Option<NapRule>,
    /// How far the grain of a piece may lie off the warp (rad).
    pub tilt: Option<f64>,
    /// How it is spread.
    pub spread: Option<Spread>,
    /// Layers cut at once; a fold does not count.
    pub plies: Option<u32>,
    /// Price of a metre of length.
    pub price_per_metre: Option<f64>,
    /// Currency of the price, as in EUR.
    pub currency: Option<String>,
    /// Print that repeats.
    pub print: Option<Print>,
    /// Flaws no piece may lie on; none where the list is empty.
    pub flaws: Option<Vec<Flaw>>,
    /// Rolls at hand, filled in this order. Without any, as much as it takes.
    pub rolls: Option<Vec<Roll>>,
}

fields!(ClothSettings, |self, v| {
    let Self {
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
    } = self;
    given!(v, width, key("width").length());
    given!(v, length, key("length").length());
    given!(v, selvedge, key("selvedge").length());
    given!(v, end_margin, key("end_margin").length());
    given!(v, gap, key("gap").length());
    given!(v, nap);
    given!(v, tilt, key("tilt").angle());
    given!(v, spread);
    given!(v, plies);
    given!(v, price_per_metre);
    given!(v, currency);
    v.optional("print", print);
    if let Some(print) = print {
        v.part(group("print"), print);
    }
    given_list!(v, flaws);
    given_list!(v, rolls);
});

/// How fabric is laid, every setting resolved.
#[derive(Clone, Debug, PartialEq)]
pub struct LaidCloth {
    /// Full width laid open (m).
    pub width: f64,
    /// Length at hand, all plies together (m); nothing means as much as it takes.
    pub length: Option<f64>,
    /// Unusable edge at either side (m).
    pub selvedge: f64,
    /// Fabric left free at either end (m).
    pub end_margin: f64,
    /// Least distance between two pieces (m).
    pub gap: f64,
    /// Which way pieces may point.
    pub nap: NapRule,
    /// How far the grain of a piece may lie off the warp (rad).
    pub tilt: f64,
    /// How it is spread.
    pub spread: Spread,
    /// Layers cut at once.
    pub plies: u32,
    /// Price of a metre of length.
    pub price_per_metre: Option<f64>,
    /// Currency of the price.
    pub currency: String,
    /// Print that repeats.
    pub print: Option<Print>,
    /// Flaws no piece may lie on.
    pub flaws: Vec<Flaw>,
    /// Rolls at hand; none where there is as much as it takes.
    pub rolls: Vec<Roll>,
}

impl ClothSettings {
    /// These settings over others: what they leave open is that of those below.
    #[must_use]
    pub fn over(self, below: &Self) -> Self {
        let Self {
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
        } = self;
        Self {
            width: width.or(below.width),
            length: length.or(below.length),
            selvedge: selvedge.or(below.selvedge),
            end_margin: end_margin.or(below.end_margin),
            gap: gap.or(below.gap),
            nap: nap.or(below.nap),
            tilt: tilt.or(below.tilt),
            spread: spread.or(below.spread),
            plies: plies.or(below.plies),
            price_per_metre: price_per_metre.or(below.price_per_metre),
            currency: currency.or_else(|| below.currency.clone()),
            print: print.or(below.print),
            flaws: flaws.or_else(|| below.flaws.clone()),
            rolls: rolls.or_else(|| below.rolls.clone()),
        }
    }

    /// How a fabric is laid by them, its own figures and the defaults where they say nothing. Nothing where neither they
    /// nor the fabric say how wide it is.
    pub fn resolved(&self, own: Option<&Fabric>) -> Option<LaidCloth> {
        let spread = self.spread.unwrap_or_default();
        let own_nap = match own.is_some_and(|fabric| fabric.nap) {
            true => NapRule::OneWay,
            false => NapRule::None,
        };
        Some(LaidCloth {
            width: self.width.or(own.map(|fabric| fabric.width))?,
            length: self.length,
            selvedge: self.selvedge.unwrap_or(DEFAULT_SELVEDGE),
            end_margin: self.end_margin.unwrap_or_default(),
            gap: self.gap.unwrap_or(DEFAULT_GAP),
            nap: self.nap.unwrap_or(own_nap),
            tilt: self.tilt.unwrap_or_default(),
            spread,
            plies: self.plies.unwrap_or(spread.usual_plies()),
            price_per_metre: self.price_per_metre,
            currency: self.currency.clone().unwrap_or_default(),
            print: self.print,
            flaws: self.flaws.clone().unwrap_or_default(),
            rolls: self.rolls.clone().unwrap_or_default(),
        })
    }

    /// The first setting that no fabric can be laid by.
    pub fn fault(&self) -> Option<FieldFault> {
        let sound = |value: f64| value.is_finite() && value >= 0.0;
        let numbers = [
            ("width", self.width),
            ("length", self.length),
            ("selvedge", self.selvedge),
            ("end_margin", self.end_margin),
            ("gap", self.gap),
            ("tilt", self.tilt),
            ("price_per_metre", self.price_per_metre),
        ];
        let fault = |field, item, message: String, hint| {
            Some(FieldFault {
                field,
                item,
                message,
                hint,
            })
        };
        let wrong = numbers
            .into_iter()
            .find_map(|(field, value)| Some((field, value.filter(|value| !sound(*value))?)));
        if let Some((field, value)) = wrong {
            let message = format!("the {} is {value}", field.replace('_', " "));
            return fault(field, None, message, "give 0 or more");
        }
        let spread = self.spread.unwrap_or_default();
        let plies = self.plies.unwrap_or(spread.usual_plies());
        if !spread.allows(plies) {
            let message = format!("it is spread in {plies} plies");
            return fault("plies", None, message, Spread::PLIES);
        }
        if let Some(print) = &self.print
            && !(print.repeat.iter().all(|v| sound(*v))
                && print.origin.iter().all(|v| v.is_finite()))
        {
            let message = "the repeat of the print is not 0 or more".to_owned();
            return fault("print", None, message, "give lengths");
        }
        let flawed = |flaw: &Flaw| {
            let at = flaw.at.iter().all(|v| v.is_finite());
            !(at && flaw.size.iter().all(|v| sound(*v)) && sound(flaw.clearance))
        };
        let mut flaws = self.flaws.iter().flatten();
        if let Some(k) = flaws.position(flawed) {
            let message = "the flaw's size or clearance is not 0 or more".to_owned();
            return fault("flaws", Some(k), message, "give lengths");
        }
        let rolls = self.rolls.as_deref().unwrap_or_default();
        rolls.iter().enumerate().find_map(|(k, roll)| {
            let is_nothing = |length: &f64| !(length.is_finite() && *length > 0.0);
            let named = |other: &Roll| roll.name.is_some() && other.name == roll.name;
            let (message, hint) = match roll {
                Roll {
                    length: Some(length),
                    ..
                } if is_nothing(length) => (
                    "the roll has no length".to_owned(),
                    "give its length, or leave it out: as long as it takes",
                ),
                Roll {
                    width: Some(width), ..
                } if is_nothing(width) => (
                    "the roll has no width".to_owned(),
                    "give its width, or leave it out: that of the fabric",
                ),
                Roll {
                    price_per_metre: Some(price),
                    ..
                } if !sound(*price) => {
                    (format!("the price per metre is {price}"), "give 0 or more")
                }
                Roll {
                    flaws: Some(flaws), ..
                } if flaws.iter().any(flawed) => (
                    "a flaw of the roll is not 0 or more in size or clearance".to_owned(),
                    "give lengths",
                ),
                _ if rolls[..k].iter().any(named) => {
                    let name = roll.name.as_deref().unwrap_or_default();
                    (
                        format!("two rolls are called {name:?}"),
                        "give each a name of its own",
                    )
                }
                _ => return None,
            };
            fault("rolls", Some(k), message, hint)
        })
    }
}
