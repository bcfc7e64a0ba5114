//! Cost of each rule of the trade: the same garments laid with and without it, with the same number
//! of evaluations.

use crate::nest_patterns::drafts_of;
use crate::watched_search::lay_watched;
use crate::watcher::ProgressShare;
use crate::{Budget, GivenFlaw, NapRule, NestOptions, SessionError, Spread, Watcher};
use std::collections::BTreeMap;
use std::path::PathBuf;
use toile_interchange::ANY_NAME;
use toile_marker::{FinishedMarker, Garments};
use toile_nesting::{Fold, Marker, judge};
use toile_pattern::{LayingRule, Pattern, Print, Roll};

/// Cost of a rule of the trade, in fabric.
#[derive(Clone, Debug, PartialEq)]
pub struct RuleCost {
    /// The rule, in words.
    pub rule: String,
    /// Fabric a set of garments needs, on average over the seeds (m).
    pub fabric: f64,
    /// Area of the garments' pieces, as laid without any rule, over the area of the fabric laid open, 0..=1;
    /// not a number if pieces found no place.
    pub efficiency: f64,
    /// Efficiency without the rule minus efficiency with it (1); not a number if either is not a number.
    pub cost: f64,
    /// Number of pieces of one set of garments that found no place: the most over the seeds.
    pub unplaced: usize,
    /// Reason why the garments could not be laid with the rule, if they could not.
    pub refused: Option<String>,
}

/// A rule: its words, and its change of the options.
type Rule = (String, Box<dyn Fn(&mut NestOptions)>);

/// Length of the repeat of stripes and checks (m).
const REPEAT: f64 = 0.05;

fn rule(words: &str, change: impl Fn(&mut NestOptions) + 'static) -> Rule {
    (words.to_owned(), Box::new(change))
}

/// The laying rule that applies to all pieces, to be changed by a studied rule.
fn every_piece(options: &mut NestOptions) -> &mut LayingRule {
    let pieces = &mut options.settings.pieces;
    &mut pieces.entry(ANY_NAME.to_owned()).or_default().rule
}

/// A printed fabric whose print repeats along the warp and across it (m).
fn print(repeat: [f64; 2]) -> Option<Print> {
    Some(Print {
        repeat,
        origin: [0.0; 2],
    })
}

/// The rules to study. Positions of flaws and lengths of rolls are chosen to suit `base`, the markers found
/// without any rule.
fn rules(patterns: &[&Pattern], base: &Found) -> Vec<Rule> {
    let length = base.fabric;
    let fabrics = base.fabrics.clone();
    let mut all = vec![
        rule("grain within 2 degrees instead of exact", |o| {
            o.cloth.tilt = Some(2f64.to_radians());
        }),
        rule("pieces may be turned over", |o| {
            every_piece(o).turn_over = Some(true);
        }),
        rule("nap: each garment one way", |o| {
            o.cloth.nap = Some(NapRule::PerGarment);
        }),
        rule("nap: all one way", |o| {
            o.cloth.nap = Some(NapRule::OneWay);
        }),
        rule("gap of 5 mm instead of 2 mm", |o| {
            o.cloth.gap = Some(0.005);
        }),
        rule("block of 5 mm round every piece", |o| {
            every_piece(o).block = Some(0.005);
        }),
        rule("selvedges of 20 mm instead of 10 mm, ends of 20 mm", |o| {
            o.cloth.selvedge = Some(0.02);
            o.cloth.end_margin = Some(0.02);
        }),
        rule("stripes of 50 mm across, hems on a line", |o| {
            o.cloth.print = print([REPEAT, 0.0]);
        }),
        rule("checks of 50 mm, hems and middles on lines", |o| {
            o.cloth.print = print([REPEAT, REPEAT]);
        }),
        rule("three flaws of 50 mm, 5 mm kept from them", move |o| {
            for (name, [length, width]) in &fabrics {
                o.flaws.extend([1.0, 2.0, 3.0].map(|k| GivenFlaw {
                    fabric: Some(name.clone()),
                    place: [length * k / 4.0, width * k / 4.0, 0.06, 0.06],
                }));
            }
        }),
        rule("two rolls of 60 % of the length", move |o| {
            let roll = Roll {
                length: Some(0.6 * length),
                ..Roll::default()
            };
            o.cloth.rolls = Some(vec![roll; 2]);
        }),
        rule("face to face", |o| {
            o.cloth.spread = Some(Spread::FaceToFace);
        }),
        rule("folded in two", |o| {
            o.cloth.spread = Some(Spread::Folded);
        }),
        rule("tubular", |o| {
            o.cloth.spread = Some(Spread::Tubular);
        }),
    ];
    if let Some(marks) = shared_notch(patterns) {
        let words = format!("stripes of 50 mm met at {}", marks.join(" and "));
        all.push((
            words,
            Box::new(move |o| {
                o.cloth.print = print([REPEAT, 0.0]);
                o.settings.matched = vec![marks.clone()];
            }),
        ));
    }
    all
}

/// Both marks of the first notch name that two panels share.
fn shared_notch(patterns: &[&Pattern]) -> Option<Vec<String>> {
    for pattern in patterns {
        for (k, panel) in pattern.panels.iter().enumerate() {
            for notch in &panel.notches {
                let has = |other: &&std::sync::Arc<toile_pattern::Panel>| {
                    other.notches.iter().any(|n| n.name == notch.name)
                };
                if let Some(other) = pattern.panels[k + 1..].iter().find(has) {
                    let mark = |panel: &str| format!("{panel}.{}", notch.name);
                    return Some(vec![mark(&panel.name), mark(&other.name)]);
                }
            }
        }
    }
    None
}

/// Lays the garments without and with each rule, from several seeds each, and compares the lengths of fabric.
/// The first entry of the result is without any rule except those of `options`.
///
/// # Errors
/// A pattern cannot be read, or the garments cannot be laid even without the rules.
pub fn study_rules(
    patterns: &[PathBuf],
    options: &NestOptions,
    (seeds, watcher): (u64, &mut dyn Watcher),
) -> Result<Vec<RuleCost>, SessionError> {
    let drafts = drafts_of(patterns, options)?.drafts;
    let garments: Vec<Garments<'_>> = drafts.iter().map(|d| d.garments()).collect();
    let seeds = seeds.max(1);
    let try_rule = |change: &dyn Fn(&mut NestOptions), watcher: &mut dyn Watcher| {
        let lay = |seed: u64| {
            let mut own = options.clone();
            change(&mut own);
            own.seed = options.seed.wrapping_add(seed);
            lay_watched(&garments, &own, watcher)
        };
        (0..seeds).map(lay).collect::<Result<Tried, _>>()
    };
    let first = try_rule(&|_| {}, &mut ProgressShare::new(watcher, 0.0, 0.06))?;
    let known: Vec<&Pattern> = garments.iter().map(|g| g.pattern).collect();
    let rules = rules(&known, &Found::of(&first));
    let count = rules.len() as f64;
    let mut tried = vec![Ok(first)];
    for (k, (_, change)) in rules.iter().enumerate() {
        let share = |k: f64| 0.06 + 0.94 * k / count;
        let mut part = ProgressShare::new(watcher, share(k as f64), share(k as f64 + 1.0));
        match try_rule(change, &mut part) {
            Err(SessionError::Cancelled) => return Err(SessionError::Cancelled),
            other => tried.push(other),
        }
    }
    let words = ["none"]
        .into_iter()
        .chain(rules.iter().map(|(words, _)| &**words));
    Ok(rows(words, carried_over(tried)))
}

/// The markers of each seed, of every fabric and roll.
type Tried = Vec<Vec<FinishedMarker>>;

/// One entry of the result for each rule.
fn rows<'a>(
    words: impl Iterator<Item = &'a str>,
    tried: Vec<Result<Tried, SessionError>>,
) -> Vec<RuleCost> {
    let found: Vec<Result<Found, SessionError>> = tried
        .into_iter()
        .map(|tried| tried.map(|markers| Found::of(&markers)))
        .collect();
    let nothing = Found::default();
    let base = match found.first() {
        Some(Ok(base)) => base,
        _ => &nothing,
    };
    // Pieces that found no place take no fabric: the efficiencies could not be compared.
    let efficiency = |found: &Found| match found.unplaced {
        0 => base.area / found.fabric_area,
        _ => f64::NAN,
    };
    let row = |(words, found): (&str, &Result<Found, SessionError>)| match found {
        Ok(found) => RuleCost {
            rule: words.to_owned(),
            fabric: found.fabric,
            efficiency: efficiency(found),
            cost: efficiency(base) - efficiency(found),
            unplaced: found.unplaced,
            refused: None,
        },
        Err(error) => RuleCost {
            rule: words.to_owned(),
            fabric: f64::NAN,
            efficiency: f64::NAN,
            cost: f64::NAN,
            unplaced: 0,
            refused: Some(error.to_string()),
        },
    };
    words.zip(&found).map(row).collect()
}

/// Replaces each marker by the marker found for another rule if that is shorter and keeps this rule, too: a
/// search does not find the optimum, so that more freedom might otherwise seem to cost fabric.
fn carried_over(mut tried: Vec<Result<Tried, SessionError>>) -> Vec<Result<Tried, SessionError>> {
    let all: Vec<Tried> = tried.iter().flatten().cloned().collect();
    for (seed, own) in tried
        .iter_mut()
        .flatten()
        .flat_map(|t| t.iter_mut().enumerate())
    {
        let same = all.iter().map(|markers| &markers[seed]);
        let others: Vec<_> = same.filter(|other| other.len() == own.len()).collect();
        for (k, finished) in own.iter_mut().enumerate() {
            for other in others.iter().map(|other| &other[k]) {
                if let Some(marker) = under_the_rules_of(finished, other) {
                    finished.marker = marker;
                    finished.missing.clear();
                }
            }
        }
    }
    tried
}

/// The layout of `other` measured under the rules of `own`, if it keeps these rules and is better; only for
/// the same fabric.
fn under_the_rules_of(own: &FinishedMarker, other: &FinishedMarker) -> Option<Marker> {
    let is_whole = own.sources.is_none() && other.sources.is_none() && other.missing.is_empty();
    if own.fabric != other.fabric || own.items.len() != other.items.len() || !is_whole {
        return None;
    }
    let mut marker = other.marker.clone();
    marker.measure(&own.items, &own.strip);
    let is_better = !own.missing.is_empty() || marker.length < own.marker.length;
    (is_better && judge(&own.items, &own.strip, &marker).is_sound()).then_some(marker)
}

/// Totals over markers; [`Found::of`] divides them by the number of seeds.
#[derive(Clone, Debug, Default)]
struct Found {
    /// Length for one set of garments (m).
    fabric: f64,
    /// Area of the pieces (m2).
    area: f64,
    /// Area of the fabric that they lie on, laid open (m2).
    fabric_area: f64,
    /// Length of the longest marker of each fabric, and its width laid open (m).
    fabrics: BTreeMap<String, [f64; 2]>,
    /// Largest number of pieces of one seed that found no place.
    unplaced: usize,
}

impl Found {
    /// Means over the seeds; for pieces that found no place, the most of one seed.
    fn of(tried: &Tried) -> Self {
        let mut found = Self::default();
        for markers in tried {
            markers.iter().for_each(|finished| found.add(finished));
            let unplaced = markers.iter().map(|m| m.summary().unplaced).sum();
            found.unplaced = found.unplaced.max(unplaced);
        }
        found.mean(tried.len() as f64)
    }

    fn add(&mut self, finished: &FinishedMarker) {
        let summary = finished.summary();
        let layers = match finished.strip.fold {
            Fold::Open => 1.0,
            Fold::Lower | Fold::Both => 2.0,
        };
        self.fabric += summary.length;
        self.area += finished.cut_area();
        let own = self.fabrics.entry(summary.fabric).or_default();
        own[0] = own[0].max(summary.length);
        own[1] = own[1].max(summary.width * layers);
        self.fabric_area += summary.length * summary.width * layers;
    }

    fn mean(self, seeds: f64) -> Self {
        Self {
            fabric: self.fabric / seeds,
            area: self.area / seeds,
            fabric_area: self.fabric_area / seeds,
            ..self
        }
    }
}

/// A share in percentage points; a dash if it is not a number.
fn points(share: f64) -> String {
    match share.is_nan() {
        true => "-".to_owned(),
        false => format!("{:.2}", share * 100.0 + 0.0),
    }
}

/// The costs of the rules as a table of text.
pub fn rule_table(rows: &[RuleCost], budget: Budget) -> String {
    let budget = match budget {
        Budget::Evaluations(count) => format!("{} M evaluations", count as f64 / 1e6),
        Budget::Seconds(seconds) => format!("{seconds} s"),
    };
    let mut text = format!(
        "| rule added ({budget} a marker) | fabric, m | efficiency, % | cost, points | not laid |\n|---|---|---|---|---|\n"
    );
    for row in rows {
        let cells = match &row.refused {
            Some(why) => format!("| {} | {why} | | | |\n", row.rule),
            None => format!(
                "| {} | {:.3} | {} | {} | {} |\n",
                row.rule,
                row.fabric,
                points(row.efficiency),
                points(row.cost),
                row.unplaced
            ),
        };
        text += &cells;
    }
    text
}
