//! How markers are made: what was given on the command line, else in the settings, else the
//! pattern's own, else usual.

use crate::SessionError;
use std::path::PathBuf;
use toile_geometry::{Bounds2, Polygon, Vec2};
use toile_interchange::{
    ALL, FabricSettings, FlawSettings, MarkerSettings, Metres, PieceSettings, RollSettings, Spread,
};
use toile_nesting::{Budget, Defect, Fold, Nap, Search, Strip, Stripes};
use toile_pattern::Fabric;

/// Unusable edge at either side of the fabric [m].
const SELVEDGE: f64 = 0.010;
/// Room for the blade between two pieces [m].
const GAP: f64 = 0.002;

/// A file a marker is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MarkerFormat {
    /// `marker.svg`: a drawing at true size.
    Svg,
    /// `marker.json`: the marker as data.
    Json,
    /// `marker.dxf`: release 12, millimetres.
    Dxf,
    /// `marker.pdf`: one page at true size.
    Pdf,
    /// `marker-report.pdf`: A4, all markers.
    Report,
    /// `marker.plt`: HPGL/2.
    Hpgl,
    /// `marker-instance.json`: the pieces and the usable width as a nesting instance, for other
    /// programs.
    Instance,
}

/// How markers are made. What is not given is the fabric's own, or usual.
#[derive(Clone, Debug, PartialEq)]
pub struct NestOptions {
    /// Named sizes, and how many garments of each; without any, one garment of the base size.
    pub sizes: Vec<(String, u32)>,
    /// Full width of the fabric [m].
    pub width: Option<f64>,
    /// Length at hand [m].
    pub length: Option<f64>,
    /// Unusable edge at either side [m].
    pub selvedge: Option<f64>,
    /// Fabric left free at either end [m].
    pub end_margin: Option<f64>,
    /// Least distance between pieces [m].
    pub gap: Option<f64>,
    /// Nap.
    pub nap: Option<Nap>,
    /// How far the grain may lie off the warp [rad].
    pub tilt: f64,
    /// Repeat of the print along the warp and across [m], 0 where it does not repeat: the hem and
    /// the middle of every piece lie on its lines.
    pub repeat: Option<[f64; 2]>,
    /// Flaws of the fabric: x and y of the corner, length and width [m].
    pub defects: Vec<[f64; 4]>,
    /// How the fabric is spread.
    pub spread: Option<Spread>,
    /// Layers cut at once.
    pub plies: Option<u32>,
    /// Price of a metre of length.
    pub price_per_metre: Option<f64>,
    /// Rolls at hand: length and, if it is not the fabric's, width [m].
    pub rolls: Vec<(f64, Option<f64>)>,
    /// Everything else, by fabric and by piece.
    pub settings: MarkerSettings,
    /// Markers to go on from, as `marker.json`.
    pub from: Vec<PathBuf>,
    /// Names of pieces that stay where those markers have them.
    pub locked: Vec<String>,
    /// Whether a search that the watcher stops ends with the best marker so far, not with an error.
    pub keep_best: bool,
    /// Files to write.
    pub formats: Vec<MarkerFormat>,
    /// When the search ends.
    pub budget: Budget,
    /// Start of the sequences of chance.
    pub seed: u64,
}

impl Default for NestOptions {
    fn default() -> Self {
        let search = Search::default();
        Self {
            sizes: Vec::new(),
            width: None,
            length: None,
            selvedge: None,
            end_margin: None,
            gap: None,
            nap: None,
            tilt: 0.0,
            repeat: None,
            defects: Vec::new(),
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

fn flaw(flaw: &FlawSettings) -> Defect {
    let corner = Vec2::new(flaw.at[0].0, flaw.at[1].0);
    Defect {
        outline: Polygon::rectangle(Bounds2 {
            min: corner,
            max: corner + Vec2::new(flaw.size[0].0, flaw.size[1].0),
        }),
        clearance: flaw.clearance.0,
    }
}

impl NestOptions {
    pub(crate) fn search(&self) -> Search {
        Search {
            budget: self.budget,
            seed: self.seed,
            ..Search::default()
        }
    }

    /// What the settings say of a piece: under its own name, else its panel's, else of all.
    pub(crate) fn piece(&self, panel: &str, piece: &str) -> PieceSettings {
        let names = [piece, panel, ALL];
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

    /// What the settings say of a fabric: under its own name, else of all.
    fn fabric(&self, name: &str) -> FabricSettings {
        let own = self.settings.fabrics.get(name);
        own.or_else(|| self.settings.fabrics.get(ALL))
            .cloned()
            .unwrap_or_default()
    }

    /// How a fabric is laid, by name; the pattern's own figures where it has it.
    pub(crate) fn plan(
        &self,
        name: &str,
        own: Option<&Fabric>,
    ) -> Result<FabricPlan, SessionError> {
        let given = self.fabric(name);
        let spread = self.spread.or(given.spread).unwrap_or_default();
        let usual = if spread == Spread::FaceToFace { 2 } else { 1 };
        let plies = self.plies.or(given.plies).unwrap_or(usual);
        if plies == 0 || (spread == Spread::FaceToFace && plies % 2 == 1) {
            return Err(SessionError::Number {
                what: "the number of plies",
                value: f64::from(plies),
                hint: "give 1 or more, face to face an even number",
            });
        }
        let width = self.width.or(metres(given.width));
        let Some(width) = width.or(own.map(|f| f.width)) else {
            return Err(SessionError::Unknown {
                kind: "fabric",
                name: name.to_owned(),
                hint: "the pattern does not have it: give its width under fabrics in the settings"
                    .to_owned(),
            });
        };
        let strip = self.strip(&given, (width, own.is_some_and(|f| f.nap)), spread);
        let rolls: Vec<RollSettings> = match self.rolls.is_empty() {
            true => given.rolls.clone(),
            false => self
                .rolls
                .iter()
                .map(|&(length, width)| RollSettings {
                    width: width.map(Metres),
                    length: Some(Metres(length)),
                    ..RollSettings::default()
                })
                .collect(),
        };
        let rolled = !rolls.is_empty();
        let price = self.price_per_metre.or(given.price_per_metre);
        let planned = |(k, roll): (usize, &RollSettings)| {
            let mut strip = strip.clone();
            if let Some(Metres(width)) = roll.width {
                strip.width = folded(width, spread);
            }
            strip.max_length = metres(roll.length).or(strip.max_length);
            strip.defects.extend(roll.flaws.iter().map(flaw));
            PlannedRoll {
                name: Some(
                    roll.name
                        .clone()
                        .unwrap_or_else(|| format!("roll {}", k + 1)),
                ),
                strip,
                price_per_metre: self.price_per_metre.or(roll.price_per_metre).or(price),
            }
        };
        let mut planned: Vec<PlannedRoll> = rolls.iter().enumerate().map(planned).collect();
        if planned.is_empty() {
            planned.push(PlannedRoll {
                name: None,
                strip,
                price_per_metre: price,
            });
        }
        Ok(FabricPlan {
            spread,
            plies,
            rolls: planned,
            rolled,
        })
    }

    fn strip(&self, given: &FabricSettings, (width, nap): (f64, bool), spread: Spread) -> Strip {
        let own = if nap { Nap::OneWay } else { Nap::None };
        let print = given.print.map(|print| Stripes {
            repeat: Vec2::new(print.repeat[0].0, print.repeat[1].0),
            origin: Vec2::new(print.origin[0].0, print.origin[1].0),
        });
        let mut strip = Strip {
            selvedge: self.selvedge.or(metres(given.selvedge)).unwrap_or(SELVEDGE),
            end_margin: self
                .end_margin
                .or(metres(given.end_margin))
                .unwrap_or_default(),
            gap: self.gap.or(metres(given.gap)).unwrap_or(GAP),
            nap: self.nap.or(given.nap.map(|n| n.0)).unwrap_or(own),
            fold: match spread {
                Spread::Open | Spread::FaceToFace => Fold::Open,
                Spread::Folded => Fold::Lower,
                Spread::Tubular => Fold::Both,
            },
            stripes: print,
            defects: given.flaws.iter().map(flaw).collect(),
            ..Strip::of_width(folded(width, spread))
        };
        strip = self.applied(strip);
        strip.width = folded(width, spread);
        strip
    }

    /// A strip with what is given on the command line instead of its own.
    pub(crate) fn applied(&self, strip: Strip) -> Strip {
        let rectangle = |&[x, y, length, width]: &[f64; 4]| Defect {
            outline: Polygon::rectangle(Bounds2 {
                min: Vec2::new(x, y),
                max: Vec2::new(x + length, y + width),
            }),
            clearance: 0.0,
        };
        let given = self.repeat.map(|repeat| Stripes {
            repeat: Vec2::from(repeat),
            origin: Vec2::zeros(),
        });
        let flaws = self.defects.iter().map(rectangle);
        Strip {
            width: self.width.unwrap_or(strip.width),
            selvedge: self.selvedge.unwrap_or(strip.selvedge),
            end_margin: self.end_margin.unwrap_or(strip.end_margin),
            gap: self.gap.unwrap_or(strip.gap),
            max_length: self.length.or(strip.max_length),
            nap: self.nap.unwrap_or(strip.nap),
            stripes: given.or(strip.stripes),
            defects: strip.defects.iter().cloned().chain(flaws).collect(),
            ..strip
        }
    }
}

/// Width of fabric as it lies, from its full width [m].
fn folded(width: f64, spread: Spread) -> f64 {
    match spread {
        Spread::Open | Spread::FaceToFace => width,
        Spread::Folded | Spread::Tubular => 0.5 * width,
    }
}
