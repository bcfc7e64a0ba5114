//! How markers are made: what was given on the command line, else in the settings, else the
//! pattern's own, else usual.

use crate::MarkerError;
use crate::file::MarkerFormat;
use crate::flaws::{GivenFlaw, flaws_on};
use toile_geometry::Vec2;
use toile_interchange::{
    ANY_NAME, FabricSettings, FlawSettings, MarkerFile, MarkerSettings, Metres, PieceSettings,
    RollSettings,
};
use toile_nesting::{Budget, Fold, Nap, Search, Strip, Stripes};
use toile_pattern::{Fabric, SizeSelection, Spread, USUAL_GAP, USUAL_SELVEDGE};

/// How markers are made. What is not given is the fabric's own, or usual.
#[derive(Clone, Debug, PartialEq)]
pub struct NestOptions {
    /// Which sizes, and how many garments of each.
    pub sizes: SizeSelection,
    /// Full width of the fabric [m].
    pub width: Option<f64>,
    /// Length at hand [m], all plies together.
    pub length: Option<f64>,
    /// Unusable edge at either side [m].
    pub selvedge: Option<f64>,
    /// Fabric left free at either end [m].
    pub end_margin: Option<f64>,
    /// Least distance between pieces [m].
    pub gap: Option<f64>,
    /// Nap.
    pub nap: Option<Nap>,
    /// How far the grain of every piece may lie off the warp [rad].
    pub tilt: Option<f64>,
    /// Repeat of the print along the warp and across [m], 0 where it does not repeat: the hem and
    /// the middle of every piece lie on its lines.
    pub repeat: Option<[f64; 2]>,
    /// Flaws of fabrics laid open.
    pub flaws: Vec<GivenFlaw>,
    /// How the fabric is spread.
    pub spread: Option<Spread>,
    /// Layers cut at once.
    pub plies: Option<u32>,
    /// Price of a metre of length.
    pub price_per_metre: Option<f64>,
    /// Rolls at hand: length, all plies together, and, if it is not the fabric's, width [m].
    pub rolls: Vec<(f64, Option<f64>)>,
    /// Everything else, by fabric and by piece.
    pub settings: MarkerSettings,
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
            width: None,
            length: None,
            selvedge: None,
            end_margin: None,
            gap: None,
            nap: None,
            tilt: None,
            repeat: None,
            flaws: Vec::new(),
            spread: None,
            plies: None,
            price_per_metre: None,
            rolls: Vec::new(),
            settings: MarkerSettings::default(),
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

fn metres(length: Option<Metres>) -> Option<f64> {
    length.map(|m| m.0)
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

    /// What the settings say of a piece: under its own name, else its panel's, else of all.
    pub(crate) fn piece(&self, panel: &str, piece: &str) -> PieceSettings {
        let names = [piece, panel, ANY_NAME];
        let mut found = names
            .iter()
            .filter_map(|name| self.settings.pieces.get(*name));
        let mut one = found.next().cloned().unwrap_or_default();
        for more in found {
            one.gap = one.gap.or(more.gap);
            one.block = one.block.or(more.block);
            one.tilt = one.tilt.or(more.tilt);
            one.turns = one.turns.or_else(|| more.turns.clone());
            one.turn_over = one.turn_over.or(more.turn_over);
            one.on_fold = one.on_fold.or(more.on_fold);
            one.over_flaws = one.over_flaws.or(more.over_flaws);
            one.on_print = one.on_print.or(more.on_print);
            one.fabric = one.fabric.or_else(|| more.fabric.clone());
            one.also = one.also.or_else(|| more.also.clone());
            one.locked = one.locked.or_else(|| more.locked.clone());
        }
        one
    }

    /// What the settings say of a fabric: under its own name, and what that leaves open, of all.
    fn fabric(&self, name: &str) -> FabricSettings {
        let entry = |name: &str| self.settings.fabrics.get(name).cloned();
        let mut one = entry(name).unwrap_or_default();
        let Some(more) = entry(ANY_NAME) else {
            return one;
        };
        one.width = one.width.or(more.width);
        one.selvedge = one.selvedge.or(more.selvedge);
        one.end_margin = one.end_margin.or(more.end_margin);
        one.gap = one.gap.or(more.gap);
        one.nap = one.nap.or(more.nap);
        one.spread = one.spread.or(more.spread);
        one.plies = one.plies.or(more.plies);
        one.price_per_metre = one.price_per_metre.or(more.price_per_metre);
        one.print = one.print.or(more.print);
        one.flaws = one.flaws.or(more.flaws);
        one.rolls = one.rolls.or(more.rolls);
        one
    }

    /// How a fabric is laid, by name; the pattern's own figures where it has it.
    pub(crate) fn plan(&self, name: &str, own: Option<&Fabric>) -> Result<FabricPlan, MarkerError> {
        let given = self.fabric(name);
        let spread = self.spread.or(given.spread).unwrap_or_default();
        let plies = self.plies.or(given.plies).unwrap_or(spread.usual_plies());
        if !spread.allows(plies) {
            return Err(MarkerError::Number {
                what: "the number of plies",
                value: f64::from(plies),
                hint: Spread::PLIES,
            });
        }
        let width = self.width.or(metres(given.width));
        let Some(width) = width.or(own.map(|f| f.width)) else {
            return Err(MarkerError::Unknown {
                kind: "fabric",
                name: name.to_owned(),
                hint: "the pattern does not have it: give its width under fabrics in the settings"
                    .to_owned(),
            });
        };
        let cloth = Cloth {
            name,
            width,
            nap: own.is_some_and(|f| f.nap),
            spread,
            plies,
        };
        let rolls = self.rolls_of(name, &given)?;
        let rolled = !rolls.is_empty();
        if rolls.len() > 1 && self.flaws.iter().any(|flaw| flaw.is_on(name)) {
            return Err(MarkerError::Conflict(format!(
                "fabric {name:?} is laid on {} rolls, and a flaw lies on one of them; leave --defect out, and give the flaws under the rolls in the settings",
                rolls.len()
            )));
        }
        let planned = match rolled {
            true => {
                let planned = rolls.iter().enumerate();
                let planned = planned.map(|(k, roll)| self.roll(&given, &cloth, (k, roll)));
                planned.collect::<Result<_, _>>()?
            }
            false => vec![PlannedRoll {
                name: None,
                strip: self.strip(&given, &cloth, given.flaws.as_deref().unwrap_or_default())?,
                price_per_metre: self.price_per_metre.or(given.price_per_metre),
            }],
        };
        Ok(FabricPlan {
            spread,
            plies,
            rolls: planned,
            rolled,
        })
    }

    /// The rolls at hand: those of the command line, else those of the settings.
    fn rolls_of(
        &self,
        name: &str,
        given: &FabricSettings,
    ) -> Result<Vec<RollSettings>, MarkerError> {
        if self.rolls.is_empty() {
            let rolls = given.rolls.as_deref().unwrap_or_default();
            let has = |field: fn(&RollSettings) -> bool| rolls.iter().any(field);
            let width = self.width.is_some() && has(|roll| roll.width.is_some());
            let length = self.length.is_some() && has(|roll| roll.length.is_some());
            if width || length {
                return Err(MarkerError::Conflict(format!(
                    "the settings have rolls of fabric {name:?} with a {} of their own; leave --{0} out, or give the rolls with --roll",
                    if width { "width" } else { "length" }
                )));
            }
            return Ok(rolls.to_vec());
        }
        let roll = |&(length, width): &(f64, Option<f64>)| RollSettings {
            width: width.map(Metres),
            length: Some(Metres(length)),
            ..RollSettings::default()
        };
        Ok(self.rolls.iter().map(roll).collect())
    }

    /// One roll, with what it has of its own.
    fn roll(
        &self,
        given: &FabricSettings,
        cloth: &Cloth<'_>,
        (number, roll): (usize, &RollSettings),
    ) -> Result<PlannedRoll, MarkerError> {
        let cloth = Cloth {
            width: roll.width.map_or(cloth.width, |w| w.0),
            ..*cloth
        };
        let flaws = roll.flaws.as_ref().or(given.flaws.as_ref());
        let mut strip = self.strip(given, &cloth, flaws.map_or(&[], |list| list))?;
        let own = metres(roll.length).map(|length| length / f64::from(cloth.plies));
        strip.max_length = own.or(strip.max_length);
        let name = roll.name.clone();
        let price = self.price_per_metre.or(roll.price_per_metre);
        Ok(PlannedRoll {
            name: Some(name.unwrap_or_else(|| format!("roll {}", number + 1))),
            strip,
            price_per_metre: price.or(given.price_per_metre),
        })
    }

    /// Fabric as it lies, with flaws of the fabric laid open.
    fn strip(
        &self,
        given: &FabricSettings,
        cloth: &Cloth<'_>,
        flaws: &[FlawSettings],
    ) -> Result<Strip, MarkerError> {
        let own = if cloth.nap { Nap::OneWay } else { Nap::None };
        let of_all = self.repeat.map(|repeat| Stripes {
            repeat: Vec2::from(repeat),
            origin: Vec2::zeros(),
        });
        let of_fabric = given.print.map(|print| Stripes {
            repeat: Vec2::new(print.repeat[0].0, print.repeat[1].0),
            origin: Vec2::new(print.origin[0].0, print.origin[1].0),
        });
        let margin = self.end_margin.or(metres(given.end_margin));
        let own_flaws = self.flaws.iter().filter(|flaw| flaw.is_on(cloth.name));
        let own_flaws = own_flaws.map(GivenFlaw::settings);
        let flaws: Vec<FlawSettings> = flaws.iter().copied().chain(own_flaws).collect();
        Ok(Strip {
            selvedge: self
                .selvedge
                .or(metres(given.selvedge))
                .unwrap_or(USUAL_SELVEDGE),
            end_margin: margin.unwrap_or_default(),
            gap: self.gap.or(metres(given.gap)).unwrap_or(USUAL_GAP),
            max_length: self.length.map(|length| length / f64::from(cloth.plies)),
            nap: self.nap.or(given.nap.map(|n| n.0)).unwrap_or(own),
            fold: match cloth.spread {
                Spread::Open | Spread::FaceToFace => Fold::Open,
                Spread::Folded => Fold::Lower,
                Spread::Tubular => Fold::Both,
            },
            stripes: of_all.or(of_fabric),
            flaws: flaws_on(&flaws, (cloth.name, cloth.width), cloth.spread)?,
            ..Strip::of_width(folded(cloth.width, cloth.spread))
        })
    }
}

/// Fabric as it comes, and how it is spread.
#[derive(Clone, Copy, Debug)]
struct Cloth<'a> {
    name: &'a str,
    /// Laid open [m].
    width: f64,
    nap: bool,
    spread: Spread,
    plies: u32,
}

/// Width of fabric as it lies, from its full width [m].
fn folded(width: f64, spread: Spread) -> f64 {
    match spread {
        Spread::Open | Spread::FaceToFace => width,
        Spread::Folded | Spread::Tubular => 0.5 * width,
    }
}
