//! Cloth settings: how fabric is laid to be cut, alike on the command line, in a settings file and in a
//! marker of the document. A setting that is left open is taken from the next lower level.

use crate::fields::{Choice, FieldFault, group, key};
use crate::{Fabric, fields};
use serde::{Deserialize, Serialize};
use strum::{VariantArray, VariantNames};

/// Default width of the unusable edge at either side of the fabric (m).
pub const DEFAULT_SELVEDGE: f64 = 0.010;
/// Default room for the blade between two pieces (m).
pub const DEFAULT_GAP: f64 = 0.002;

/// Rule for the directions in which pieces may point along the warp (nap).
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
    /// Each piece may point either way.
    #[default]
    None,
    /// All pieces point the same way.
    OneWay,
    /// All pieces of one garment point the same way.
    PerGarment,
}

/// Way of spreading fabric on the table.
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
    /// Open, every second ply turned over: pieces come in mirrored pairs.
    FaceToFace,
}

impl Choice for NapRule {}
impl Choice for Spread {}

impl Spread {
    /// Advice on the numbers of plies that are allowed.
    pub const PLIES: &'static str = "give 1 or more, face to face an even number";

    /// Default number of plies for this way of spreading.
    pub fn usual_plies(self) -> u32 {
        match self {
            Self::FaceToFace => 2,
            Self::Open | Self::Folded | Self::Tubular => 1,
        }
    }

    /// Whether fabric can be spread this way in that many plies.
    pub fn allows(self, plies: u32) -> bool {
        plies > 0 && (self != Self::FaceToFace || plies.is_multiple_of(2))
    }
}

/// A repeating print.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Print {
    /// Length of the repeat along the warp and across (m); 0 where the print does not repeat.
    pub repeat: [f64; 2],
    /// A point at which lines of the print cross (m).
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

/// A flaw: a rectangle of the fabric, measured with the fabric laid open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Flaw {
    /// Corner of the flaw nearest to the start of the fabric: along the warp and across (m).
    pub at: [f64; 2],
    /// Length and width of the flaw (m).
    pub size: [f64; 2],
    /// Distance that pieces keep from the flaw (m).
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

/// A roll of fabric. Fields that are left open are taken from the fabric.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Roll {
    /// Name for messages and files; a roll without a name is numbered.
    pub name: Option<String>,
    /// Full width of the roll (m).
    pub width: Option<f64>,
    /// Length of the roll, all plies together (m); `None`: as long as needed.
    pub length: Option<f64>,
    /// Price of a metre of the roll's length.
    pub price_per_metre: Option<f64>,
    /// Flaws of the roll; an empty list: the roll has no flaws.
    pub flaws: Option<Vec<Flaw>>,
}

/// Visits a field that may be left out: first whether it is given, then its value.
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

/// Visits a list that may be left out or may be given and empty.
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

/// Settings of how fabric is laid to be cut. A setting that is not given (`None`) is taken from more general
/// settings ([`ClothSettings::over`]); if these do not give it either, from the fabric or the default
/// ([`ClothSettings::resolved`]).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ClothSettings {
    /// Full width of the fabric laid open (m); for a tube its girth.
    pub width: Option<f64>,
    /// Length of fabric at hand, all plies together (m); by default as long as needed.
    pub length: Option<f64>,
    /// Width of the unusable edge at either side (m).
    pub selvedge: Option<f64>,
    /// Length of fabric left free at either end (m).
    pub end_margin: Option<f64>,
    /// Least distance between two pieces (m).
    pub gap: Option<f64>,
    /// Directions in which pieces may point along the warp.
    pub nap: Option<NapRule>,
    /// Greatest angle between the grain of a piece and the warp (rad).
    pub tilt: Option<f64>,
    /// Way of spreading the fabric.
    pub spread: Option<Spread>,
    /// Number of plies cut at once. Folded fabric counts as one ply, though it has two layers.
    pub plies: Option<u32>,
    /// Price of a metre of the fabric's length.
    pub price_per_metre: Option<f64>,
    /// Currency of the price, such as EUR.
    pub currency: Option<String>,
    /// Repeating print of the fabric.
    pub print: Option<Print>,
    /// Flaws that no piece may lie on; an empty list: the fabric has no flaws.
    pub flaws: Option<Vec<Flaw>>,
    /// Rolls at hand, filled in this order; without a roll, as much fabric as needed.
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

/// Settings of how fabric is laid, with every default filled in.
#[derive(Clone, Debug, PartialEq)]
pub struct LaidCloth {
    /// Full width of the fabric laid open (m).
    pub width: f64,
    /// Length of fabric at hand, all plies together (m); `None`: as long as needed.
    pub length: Option<f64>,
    /// Width of the unusable edge at either side (m).
    pub selvedge: f64,
    /// Length of fabric left free at either end (m).
    pub end_margin: f64,
    /// Least distance between two pieces (m).
    pub gap: f64,
    /// Directions in which pieces may point along the warp.
    pub nap: NapRule,
    /// Greatest angle between the grain of a piece and the warp (rad).
    pub tilt: f64,
    /// Way of spreading the fabric.
    pub spread: Spread,
    /// Number of plies cut at once.
    pub plies: u32,
    /// Price of a metre of the fabric's length.
    pub price_per_metre: Option<f64>,
    /// Currency of the price.
    pub currency: String,
    /// Repeating print of the fabric.
    pub print: Option<Print>,
    /// Flaws that no piece may lie on.
    pub flaws: Vec<Flaw>,
    /// Rolls at hand; an empty list means as much fabric as needed.
    pub rolls: Vec<Roll>,
}

impl ClothSettings {
    /// These settings, with each setting that is not given taken from `below`.
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

    /// The settings for laying a fabric. Settings that are not given are taken from the fabric `own` or, if
    /// it does not have them, from the defaults. `None`: neither the settings nor the fabric give a width.
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

    /// Fault of the first setting whose value is not allowed.
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
