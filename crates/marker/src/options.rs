//! How markers are made: what was given on the command line, else in the settings, else the
//! pattern's own, else usual.

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

/// How markers are made. What is not given is the fabric's own, or usual.
#[derive(Clone, Debug, PartialEq)]
pub struct NestOptions {
    /// Which sizes, and how many garments of each.
    pub sizes: SizeSelection,
    /// How the fabrics are laid: what is given here comes before all else.
    pub cloth: ClothSettings,
    /// Flaws of fabrics laid open, beside those that are said elsewhere.
    pub flaws: Vec<GivenFlaw>,
    /// What is said by name of fabrics and pieces.
    pub settings: MarkerSettings,
    /// The marker of the document that is laid: its cloth, rules and marks are those of its pattern, and settings by name
    /// say nothing.
    pub marker: Option<Arc<Marker>>,
    /// Markers to go on from.
    pub from: Vec<MarkerFile>,
    /// Names of pieces that stay where those markers have them.
    pub locked: Vec<String>,
    /// Whether a search that the watcher stops ends with the best marker so far, not with an error.
    pub keep_best: bool,
    /// Files to write.
    pub formats: Vec<MarkerFormat>,
    /// When the search ends.
    pub budget: Budget,
    /// Searches side by side; 0 as usual.
    pub islands: usize,
    /// Threads; 0 for as many as the machine has.
    pub threads: usize,
    /// Start of the sequences of chance.
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

/// One fabric as it is laid.
#[derive(Clone, Debug)]
pub(crate) struct FabricPlan {
    pub spread: Spread,
    pub plies: u32,
    /// How far the grain of a piece may lie off the warp where nothing else is said of it (rad).
    pub tilt: f64,
    /// Currency of prices.
    pub currency: String,
    /// What the pieces are laid on, one after another.
    pub rolls: Vec<PlannedRoll>,
    /// Whether rolls were given, so that pieces may be left over.
    pub rolled: bool,
}

/// A roll to lay pieces on.
#[derive(Clone, Debug)]
pub(crate) struct PlannedRoll {
    /// Its name, if there are several.
    pub name: Option<String>,
    pub strip: Strip,
    pub price_per_metre: Option<f64>,
}

impl NestOptions {
    /// How hard to search.
    pub fn search(&self) -> Search {
        Search {
            budget: self.budget,
            seed: self.seed,
            islands: self.islands,
            threads: self.threads,
        }
    }

    /// What is asked of a piece: what its own rule leaves open is that of its panel's, then of all.
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

    /// Whether marks lie on the same place of the print in every garment, so that each is laid in itself.
    pub(crate) fn matches_marks(&self) -> bool {
        match &self.marker {
            Some(marker) => !marker.matched.is_empty(),
            None => !self.settings.matched.is_empty(),
        }
    }

    /// How a fabric is laid, by name; its own figures where nothing else is said.
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

    /// Refuses a width or length for all rolls where rolls have their own.
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

/// One roll, with what it has of its own.
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

/// Fabric as it lies, with its flaws and some that are added.
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

/// Width of fabric as it lies, from its full width (m).
fn folded(width: f64, spread: Spread) -> f64 {
    match spread {
        Spread::Open | Spread::FaceToFace => width,
        Spread::Folded | Spread::Tubular => 0.5 * width,
    }
}
