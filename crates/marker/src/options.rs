//! Options for making markers. Each value comes from the command line, else the settings, else the pattern,
//! else a default.
//!
//! # Decided with
//! - [`toile_pattern::ClothSettings`]: the settings, their order of precedence, their defaults;
//! - [`toile_interchange::MarkerSettings`]: settings of a file;
//! - [`crate::ordered::MarkerPieces`]: settings of a marker of the document;
//! - [`crate::options::strip`], [`toile_nesting::Strip`]: fabric as the search takes it: selvedges, margins,
//!   gaps, nap, tilt, print;
//! - [`crate::options::folded`], [`crate::items`] (`roles`): folded fabric; pieces laid as halves or with
//!   their twin;
//! - [`toile_cut::CutPiece`], [`crate::items`] (`item_of`, `two_at_once`): turns of a piece by its grain;
//! - [`crate::matching`], [`crate::marks`], [`crate::flaws::check_given`]: prints that meet, and narrow the
//!   turns; flaws;
//! - [`crate::options::NestOptions::check_rolls`], [`crate::search`] (`check_fabric_names`),
//!   [`crate::starting_marker::check_names`]: names and rolls refused before a search;
//! - [`toile_pattern::LayingRule`], [`crate::options::NestOptions::piece`], [`crate::items`] (`item_of`): rules
//!   of single pieces: gap, turns, turned over, tilt.
//!
//! By hand: a new setting on the command line (crate `cli`, `nest_arguments.rs`, `nest_commands.rs`) and in
//! the window (`app/marker_laying.rs`). The document and files of settings read it from its list of fields,
//! and the compiler asks for journals.

use crate::MarkerError;
use crate::file::MarkerFormat;
use crate::flaws::{GivenFlaw, flaws_on};
use std::sync::Arc;
use toile_geometry::Vec2;
use toile_interchange::{ANY_NAME, MarkerFile, MarkerSettings, PieceSettings};
use toile_nesting::{Budget, Fold, Nap, Search, Strip, Stripes};
use toile_pattern::{
    ClothSettings, Fabric, FabricId, Flaw, LaidCloth, Marker, NapRule, Pattern, Piece, Roll,
    SizeSelection, Spread,
};

/// Options for making markers. A missing value is taken from the fabric, else a default.
#[derive(Clone, Debug, PartialEq)]
pub struct NestOptions {
    /// The sizes to cut, and the number of garments of each.
    pub sizes: SizeSelection,
    /// Settings of the fabric; values given here override all others.
    pub cloth: ClothSettings,
    /// Flaws of the open fabrics, in addition to flaws given elsewhere.
    pub flaws: Vec<GivenFlaw>,
    /// Settings by name of fabrics and pieces.
    pub settings: MarkerSettings,
    /// The document's marker that is laid. Fabric, rules and marks are then taken from it, and settings by
    /// name have no effect.
    pub marker: Option<Arc<Marker>>,
    /// Existing markers that the search starts from.
    pub from: Vec<MarkerFile>,
    /// Names of pieces that keep the positions that they have on those markers.
    pub locked: Vec<String>,
    /// Whether a search stopped by the watcher ends with the best marker so far instead of an error.
    pub keep_best: bool,
    /// Files to write.
    pub formats: Vec<MarkerFormat>,
    /// Limit at which the search ends.
    pub budget: Budget,
    /// Number of parallel searches; 0 for the default.
    pub islands: usize,
    /// Number of threads; 0 for as many as the machine has.
    pub threads: usize,
    /// Seed of the random number generators.
    pub seed: u64,
}

impl Default for NestOptions {
    fn default() -> Self {
        let search = Search::default();
        Self {
            sizes: SizeSelection::Base,
            cloth: ClothSettings::default(),
            flaws: Vec::new(),
            settings: MarkerSettings::default(),
            marker: None,
            from: Vec::new(),
            locked: Vec::new(),
            keep_best: false,
            formats: vec![MarkerFormat::Svg, MarkerFormat::Json],
            budget: search.budget,
            islands: search.islands,
            threads: search.threads,
            seed: search.seed,
        }
    }
}

/// The plan for laying one fabric.
#[derive(Clone, Debug)]
pub(crate) struct FabricPlan {
    pub spread: Spread,
    pub plies: u32,
    /// Largest deviation of a piece's grain from the warp, unless the piece has its own limit (rad).
    pub tilt: f64,
    /// Currency of the prices.
    pub currency: String,
    /// The rolls that pieces are laid on, one after the other.
    pub rolls: Vec<PlannedRoll>,
    /// Whether rolls were given, so that some pieces may not fit.
    pub rolled: bool,
}

/// A roll to lay pieces on.
#[derive(Clone, Debug)]
pub(crate) struct PlannedRoll {
    /// Name of the roll, if there are several.
    pub name: Option<String>,
    pub strip: Strip,
    pub price_per_metre: Option<f64>,
}

impl NestOptions {
    /// Parameters of the search.
    pub fn search(&self) -> Search {
        Search {
            budget: self.budget,
            seed: self.seed,
            islands: self.islands,
            threads: self.threads,
        }
    }

    /// Settings of a piece. Gaps in its own settings are filled from those of its panel, then from those of
    /// all pieces.
    pub(crate) fn piece(&self, pattern: &Pattern, piece: &Piece) -> PieceSettings {
        let Some(marker) = &self.marker else {
            let panel = pattern.panel(piece.id.panel);
            let names = [
                &*piece.name,
                panel.map_or("", |panel| &*panel.name),
                ANY_NAME,
            ];
            let found = names
                .iter()
                .filter_map(|name| self.settings.pieces.get(*name));
            return found.fold(PieceSettings::default(), |own, below| own.over(below));
        };
        let rule = marker.rule_for(piece.id.panel, piece.id.copy);
        let name = |id: FabricId| {
            pattern
                .fabric(id)
                .map_or_else(|| id.to_string(), |f| f.name.clone())
        };
        let also = rule.also.map(|also| {
            also.iter()
                .map(|also| (name(also.fabric), also.quantity))
                .collect()
        });
        PieceSettings {
            rule: rule.rule,
            fabric: rule.fabric.map(name),
            also,
            locked: None,
        }
    }

    /// Whether marks must match the print in every garment, so that each garment is matched separately.
    pub(crate) fn matches_marks(&self) -> bool {
        match &self.marker {
            Some(marker) => !marker.matched.is_empty(),
            None => !self.settings.matched.is_empty(),
        }
    }

    /// The plan for laying a fabric given by name; missing values are taken from the fabric itself.
    pub(crate) fn plan(&self, name: &str, own: Option<&Fabric>) -> Result<FabricPlan, MarkerError> {
        let entry = |name: &str| self.settings.fabrics.get(name).cloned().unwrap_or_default();
        let below = match &self.marker {
            Some(marker) => marker.cloth.clone(),
            None => entry(name).over(&entry(ANY_NAME)),
        };
        let currency = self.settings.currency.clone();
        let mut cloth = self.cloth.clone().over(&below);
        cloth.currency = cloth.currency.or(currency);
        if self.cloth.price_per_metre.is_some() {
            for roll in cloth.rolls.iter_mut().flatten() {
                roll.price_per_metre = None;
            }
        }
        let spread = cloth.spread.unwrap_or_default();
        let plies = cloth.plies.unwrap_or(spread.usual_plies());
        if !spread.allows(plies) {
            return Err(MarkerError::Number {
                what: "the number of plies",
                value: f64::from(plies),
                hint: Spread::PLIES,
            });
        }
        let Some(cloth) = cloth.resolved(own) else {
            return Err(MarkerError::Unknown {
                kind: "fabric",
                name: name.to_owned(),
                hint: "the pattern does not have it: give its width under fabrics in the settings"
                    .to_owned(),
            });
        };
        self.check_rolls(name, below.rolls.as_deref().unwrap_or_default())?;
        let added: Vec<Flaw> = self
            .flaws
            .iter()
            .filter(|flaw| flaw.is_on(name))
            .map(GivenFlaw::flaw)
            .collect();
        if cloth.rolls.len() > 1 && !added.is_empty() {
            return Err(MarkerError::Conflict(format!(
                "fabric {name:?} is laid on {} rolls, and a flaw lies on one of them; leave --defect out, and give the flaws under the rolls in the settings",
                cloth.rolls.len()
            )));
        }
        let rolled = !cloth.rolls.is_empty();
        let rolls = match rolled {
            true => {
                let rolls = cloth.rolls.iter().enumerate();
                rolls
                    .map(|(k, roll)| planned_roll(&cloth, (k, roll), (name, &added)))
                    .collect::<Result<_, _>>()?
            }
            false => vec![PlannedRoll {
                name: None,
                strip: strip(&cloth, (name, &added))?,
                price_per_metre: cloth.price_per_metre,
            }],
        };
        Ok(FabricPlan {
            spread: cloth.spread,
            plies: cloth.plies,
            tilt: cloth.tilt,
            currency: cloth.currency,
            rolls,
            rolled,
        })
    }

    /// Refuses a width or length for all rolls if rolls have their own.
    fn check_rolls(&self, name: &str, rolls: &[Roll]) -> Result<(), MarkerError> {
        if self.cloth.rolls.is_some() {
            return Ok(());
        }
        let has = |field: fn(&Roll) -> bool| rolls.iter().any(field);
        let width = self.cloth.width.is_some() && has(|roll| roll.width.is_some());
        let length = self.cloth.length.is_some() && has(|roll| roll.length.is_some());
        match width || length {
            false => Ok(()),
            true => Err(MarkerError::Conflict(format!(
                "the settings have rolls of fabric {name:?} with a {} of their own; leave --{0} out, or give the rolls with --roll",
                if width { "width" } else { "length" }
            ))),
        }
    }
}

/// Plan of one roll, with its own width, length and price.
fn planned_roll(
    cloth: &LaidCloth,
    (number, roll): (usize, &Roll),
    of: (&str, &[Flaw]),
) -> Result<PlannedRoll, MarkerError> {
    let cloth = LaidCloth {
        width: roll.width.unwrap_or(cloth.width),
        length: roll.length.or(cloth.length),
        flaws: roll.flaws.clone().unwrap_or_else(|| cloth.flaws.clone()),
        ..cloth.clone()
    };
    let name = roll.name.clone();
    Ok(PlannedRoll {
        name: Some(name.unwrap_or_else(|| format!("roll {}", number + 1))),
        strip: strip(&cloth, of)?,
        price_per_metre: roll.price_per_metre.or(cloth.price_per_metre),
    })
}

/// The spread fabric, with its own flaws and additional ones.
fn strip(cloth: &LaidCloth, (name, added): (&str, &[Flaw])) -> Result<Strip, MarkerError> {
    let flaws: Vec<Flaw> = cloth.flaws.iter().chain(added).copied().collect();
    Ok(Strip {
        selvedge: cloth.selvedge,
        end_margin: cloth.end_margin,
        gap: cloth.gap,
        max_length: cloth.length.map(|length| length / f64::from(cloth.plies)),
        nap: match cloth.nap {
            NapRule::None => Nap::None,
            NapRule::OneWay => Nap::OneWay,
            NapRule::PerGarment => Nap::PerBundle,
        },
        fold: match cloth.spread {
            Spread::Open | Spread::FaceToFace => Fold::Open,
            Spread::Folded => Fold::Lower,
            Spread::Tubular => Fold::Both,
        },
        stripes: cloth.print.map(|print| Stripes {
            repeat: Vec2::from(print.repeat),
            origin: Vec2::from(print.origin),
        }),
        flaws: flaws_on(&flaws, (name, cloth.width), cloth.spread)?,
        ..Strip::of_width(folded(cloth.width, cloth.spread))
    })
}

/// Width of the spread fabric, from the full width (m).
fn folded(width: f64, spread: Spread) -> f64 {
    match spread {
        Spread::Open | Spread::FaceToFace => width,
        Spread::Folded | Spread::Tubular => 0.5 * width,
    }
}
