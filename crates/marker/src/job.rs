//! The pieces of one fabric, ready to be laid on it.

use crate::finished_marker::FinishedMarker;
use crate::items::items_on;
use crate::matching::runs_one_way;
use crate::options::{FabricPlan, PlannedRoll};
use crate::pieces::PieceToCut;
use crate::progress::SearchProgress;
use crate::starting_marker::{lock, start_of};
use crate::{MarkerError, NestOptions};
use std::collections::HashMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use toile_cut::CutPiece;
use toile_interchange::{MarkerFacts, MarkerFileUnplaced};
use toile_nesting::{
    Control, Item, Marker, Nap, NestingError, Progress, Search, Strip, improve_marker, judge,
    make_marker, make_markers_on_rolls,
};
use toile_pattern::{DisplayUnit, Fabric, OrderedPiece, SizeId, Spread};

/// Receives the progress of the search on one fabric; returns whether to continue.
type Report<'a> = &'a mut dyn FnMut(SearchProgress) -> bool;

/// The pieces to lay on one fabric, with its rolls.
pub(crate) struct FabricJob {
    fabric: String,
    plan: FabricPlan,
    pub items: Vec<Item>,
    pub pieces: Vec<Arc<CutPiece>>,
    /// For each item, the number of its first copy among the copies of its panel.
    first_copies: Vec<u32>,
    pub notes: Vec<String>,
    /// The unit of displayed lengths.
    unit: DisplayUnit,
    /// The marker that the search starts from.
    start: Option<Marker>,
}

impl FabricJob {
    pub fn new(
        (fabric, to_cut): (&str, &[PieceToCut]),
        own: Option<&Fabric>,
        options: &NestOptions,
    ) -> Result<Self, MarkerError> {
        let starts = &options.from;
        let mut plan = options.plan(fabric, own)?;
        if plan.rolled && !starts.is_empty() {
            return Err(MarkerError::Conflict(format!(
                "fabric {fabric:?} is laid on rolls, and markers on rolls cannot be gone on from; leave out --from, or the rolls"
            )));
        }
        if runs_one_way(to_cut) {
            for roll in &mut plan.rolls {
                if roll.strip.stripes.is_some() && roll.strip.nap == Nap::None {
                    roll.strip.nap = Nap::PerBundle;
                }
            }
        }
        let (mut items, drawn, notes) = items_on(to_cut, &plan, options)?;
        let first_copies = drawn.iter().map(|(k, _)| to_cut[*k].first_copy).collect();
        let pieces = drawn.into_iter().map(|(_, piece)| piece).collect();
        let start = start_of(starts, fabric, (&items, &plan.rolls[0].strip));
        if let Some(start) = &start {
            lock(&mut items, start, &options.locked);
        }
        Ok(Self {
            fabric: fabric.to_owned(),
            plan,
            items,
            pieces,
            first_copies,
            notes,
            unit: to_cut.first().map(|piece| piece.unit).unwrap_or_default(),
            start,
        })
    }

    /// Makes all markers of the fabric. Stops if the flag is set or `report` returns false.
    pub fn lay(
        &self,
        options: &NestOptions,
        (flag, report): (&AtomicBool, Report<'_>),
    ) -> Result<Vec<FinishedMarker>, MarkerError> {
        if self.plan.rolled {
            return self.lay_on_rolls(options.search(), (flag, report));
        }
        let of = (&*self.items, self.start.as_ref());
        let marker = self.made(of, options.search(), (flag, report))?;
        Ok(vec![self.whole(marker, 0)])
    }

    /// Lays the items, some of them locked, on the only roll: from scratch, or from a start.
    pub fn made(
        &self,
        (items, start): (&[Item], Option<&Marker>),
        search: Search,
        (flag, report): (&AtomicBool, Report<'_>),
    ) -> Result<Marker, MarkerError> {
        let mut follow = |progress| self.follow(progress, flag, report);
        let mut control = Control {
            progress: &mut follow,
            cancel: flag,
        };
        let strip = &self.plan.rolls[0].strip;
        Ok(match start {
            Some(start) => improve_marker(items, strip, start, search, &mut control)?,
            None => make_marker(items, strip, search, &mut control)?,
        })
    }

    fn follow(
        &self,
        progress: Progress,
        flag: &AtomicBool,
        report: &mut dyn FnMut(SearchProgress) -> bool,
    ) {
        if !report(self.progress(progress)) {
            flag.store(true, Ordering::Relaxed);
        }
    }

    /// The finished marker with all pieces on one roll.
    pub fn whole(&self, marker: Marker, roll: usize) -> FinishedMarker {
        let missing = named(&self.items, &marker.unplaced);
        let of = (self.items.clone(), self.pieces.clone());
        FinishedMarker {
            missing,
            ..self.finished(&self.plan.rolls[roll], of, marker)
        }
    }

    /// The spread fabric of a roll.
    pub fn strip(&self, roll: usize) -> &Strip {
        &self.plan.rolls[roll].strip
    }

    /// The spread fabrics of all rolls.
    pub fn strips(&self) -> impl Iterator<Item = &Strip> {
        self.plan.rolls.iter().map(|roll| &roll.strip)
    }

    /// Names of the rolls; a single `None` if no rolls are defined.
    pub fn roll_names(&self) -> impl Iterator<Item = Option<&str>> {
        self.plan.rolls.iter().map(|roll| roll.name.as_deref())
    }

    /// Whether rolls were given, so that some pieces may not fit.
    pub fn is_on_rolls(&self) -> bool {
        self.plan.rolled
    }

    /// Price of a length of a roll (m) for all plies, if the price per metre is known.
    pub fn cost(&self, length: f64, roll: usize) -> Option<f64> {
        let price = self.plan.rolls[roll].price_per_metre;
        price.map(|price| price * length * f64::from(self.plan.plies))
    }

    /// For each copy of each item, its piece in the order. `order` lists the garments in the order they were
    /// laid.
    pub fn keys(&self, order: &[(Option<SizeId>, u32)]) -> Vec<Vec<OrderedPiece>> {
        let garments: Vec<(Option<SizeId>, u32)> = order
            .iter()
            .flat_map(|&(size, quantity)| (0..quantity).map(move |garment| (size, garment)))
            .collect();
        let items = self.items.iter().zip(&self.pieces).zip(&self.first_copies);
        let keys = items.map(|((item, piece), first_copy)| {
            // Further copies within one garment get consecutive numbers.
            let mut seen: HashMap<u32, u32> = HashMap::new();
            let mut own = Vec::with_capacity(item.bundles.len());
            for bundle in &item.bundles {
                let Some(&(size, garment)) = garments.get(*bundle as usize) else {
                    continue;
                };
                let number = seen.entry(*bundle).or_default();
                own.push(OrderedPiece {
                    panel: piece.id.panel,
                    copy: first_copy + *number,
                    size,
                    garment,
                });
                *number += 1;
            }
            own
        });
        keys.collect()
    }

    /// Progress of a search. On rolls the total length is unknown until the end.
    fn progress(&self, progress: Progress) -> SearchProgress {
        let length = Some(progress.length).filter(|length| length.is_finite());
        let whole = length.filter(|_| !self.plan.rolled);
        let roll = &self.plan.rolls[0];
        let copies = self.items.iter();
        let area = copies.map(|item| item.outline.area() * f64::from(item.quantity));
        let area: f64 = area.sum();
        let width = roll.strip.width;
        let efficiency = |length: f64| area / (width * (length - 2.0 * roll.strip.end_margin));
        SearchProgress {
            done: progress.done,
            length,
            efficiency: whole.map(efficiency),
            cost: whole.and_then(|length| self.cost(length, 0)),
            marker: progress.marker,
        }
    }

    /// Lays all pieces on the rolls, one roll after the other.
    pub fn lay_on_rolls(
        &self,
        search: Search,
        (flag, report): (&AtomicBool, Report<'_>),
    ) -> Result<Vec<FinishedMarker>, MarkerError> {
        let mut follow = |progress| self.follow(progress, flag, report);
        let mut control = Control {
            progress: &mut follow,
            cancel: flag,
        };
        let strips: Vec<Strip> = self.plan.rolls.iter().map(|r| r.strip.clone()).collect();
        let out = make_markers_on_rolls(&self.items, &strips, search, &mut control)?;
        let missing = named(&self.items, &out.unplaced);
        let mut finished_markers: Vec<FinishedMarker> = out
            .markers
            .into_iter()
            .map(|made| {
                let drawn = made.sources.iter().map(|s| self.pieces[s.0].clone());
                let of = (made.items, drawn.collect());
                let roll = &self.plan.rolls[made.roll];
                FinishedMarker {
                    sources: Some(made.sources),
                    roll: made.roll,
                    ..self.finished(roll, of, made.marker)
                }
            })
            .collect();
        let Some(last) = finished_markers.last_mut() else {
            let reasons = missing.iter().map(|u| format!("{}: {}", u.name, u.reason));
            let reasons: Vec<String> = reasons.collect();
            let what = format!("no piece fits any roll: {}", reasons.join("; "));
            return Err(NestingError::Strip(what).into());
        };
        last.missing = missing;
        Ok(finished_markers)
    }

    /// A finished marker of one roll, without missing copies.
    fn finished(
        &self,
        roll: &PlannedRoll,
        (items, pieces): (Vec<Item>, Vec<Arc<CutPiece>>),
        marker: Marker,
    ) -> FinishedMarker {
        let verdict = judge(&items, &roll.strip, &marker);
        FinishedMarker {
            fabric: self.fabric.clone(),
            strip: roll.strip.clone(),
            facts: MarkerFacts {
                fabric: self.fabric.clone(),
                roll: roll.name.clone(),
                plies: self.plan.plies,
                face_to_face: self.plan.spread == Spread::FaceToFace,
                utilisation: marker.utilisation,
                price_per_metre: roll.price_per_metre,
                currency: self.plan.currency.clone(),
                unit: self.unit,
                notes: self.notes.clone(),
            },
            missing: Vec::new(),
            roll: 0,
            sources: None,
            items,
            pieces,
            marker,
            verdict,
        }
    }
}

/// Copies that could not be placed, with their names.
fn named(items: &[Item], unplaced: &[toile_nesting::Unplaced]) -> Vec<MarkerFileUnplaced> {
    let name = |u: &toile_nesting::Unplaced| MarkerFileUnplaced {
        name: items[u.item].name.clone(),
        item: u.item,
        copy: u.copy,
        reason: u.reason.clone(),
    };
    unplaced.iter().map(name).collect()
}
