//! Markers of drafts: one for each fabric their pieces are cut from, and for each roll of it.

use crate::going_on::{lock, read_starts, start_of};
use crate::laying_items::{LaidPiece, Wanted, items_on, wanted_of};
use crate::matching::runs_one_way;
use crate::nest_options::{FabricPlan, PlannedRoll};
use crate::watcher::tell;
use crate::{Budget, NestOptions, Nested, SessionError, Watcher};
use std::sync::atomic::{AtomicBool, Ordering};
use toile_interchange::{MarkerDrawing, MarkerFacts, MarkerFile, MarkerPiece, Spread};
use toile_nesting::{
    Control, Item, Marker, Nap, NestingError, Progress, Strip, Verdict, improve_marker, judge,
    make_marker, make_markers_on_rolls,
};
use toile_pattern::{Draft, Fabric, Pattern};

/// A marker made, with everything a drawing of it needs.
#[derive(Clone, Debug)]
pub(crate) struct Laying {
    /// Name of the fabric.
    pub fabric: String,
    /// Pieces by their cut outline.
    pub items: Vec<Item>,
    /// What is drawn on them, in the order of the items.
    pub pieces: Vec<LaidPiece>,
    pub strip: Strip,
    pub marker: Marker,
    pub verdict: Verdict,
    /// Copies that lie on no marker of this fabric: names, and why.
    pub missing: Vec<[String; 2]>,
    /// What else is known.
    pub facts: MarkerFacts,
}

impl Laying {
    /// A few numbers.
    pub fn summary(&self) -> Nested {
        let yardage = self.marker.length * f64::from(self.facts.plies);
        Nested {
            fabric: self.fabric.clone(),
            roll: self.facts.roll.clone(),
            pieces: self.marker.placements.len(),
            unplaced: self.missing.len(),
            missing: self.missing.clone(),
            length: self.marker.length,
            width: self.strip.width,
            plies: self.facts.plies,
            yardage,
            cost: self.facts.price_per_metre.map(|price| price * yardage),
            currency: self.facts.currency.clone(),
            efficiency: self.marker.efficiency,
            utilisation: self.marker.utilisation,
            notes: self.facts.notes.clone(),
            sound: self.verdict.is_sound(),
        }
    }

    /// Area of the pieces that were laid, seam allowance included [m2].
    pub fn cut_area(&self) -> f64 {
        let area = |p: &toile_nesting::Placement| self.items[p.item].outline.area().abs();
        self.marker.placements.iter().map(area).sum()
    }

    /// The marker as a drawing.
    pub fn drawing(&self, pattern: &str) -> MarkerDrawing {
        let piece = |placement: &toile_nesting::Placement| {
            let (item, piece) = (&self.items[placement.item], &self.pieces[placement.item]);
            MarkerPiece {
                name: item.name.clone(),
                item: placement.item,
                cut: item.outline.clone(),
                sew: piece.sew.clone(),
                grain: None,
                notches: piece.notches.clone(),
                lines: piece.lines.clone(),
                pose: placement.pose(item),
            }
        };
        let overlaps = self.verdict.overlaps.iter().flat_map(|o| &o.1);
        MarkerDrawing {
            title: self.title(pattern),
            strip: self.strip.clone(),
            length: self.marker.length,
            efficiency: self.marker.efficiency,
            pieces: self.marker.placements.iter().map(piece).collect(),
            unplaced: self.missing.clone(),
            overlaps: overlaps.cloned().collect(),
            facts: MarkerFacts {
                utilisation: self.marker.utilisation,
                ..self.facts.clone()
            },
        }
    }

    /// The marker as its file.
    pub fn file(&self, pattern: &str) -> MarkerFile {
        MarkerFile {
            roll: self.facts.roll.clone(),
            plies: self.facts.plies,
            face_to_face: self.facts.face_to_face,
            ..MarkerFile::new(&self.title(pattern), &self.items, &self.strip, &self.marker)
        }
    }

    fn title(&self, pattern: &str) -> String {
        match &self.facts.roll {
            Some(roll) => format!("{pattern}, {}, {roll}", self.fabric),
            None => format!("{pattern}, {}", self.fabric),
        }
    }
}

/// Garments to cut from one draft.
#[derive(Clone, Copy)]
pub(crate) struct Garments<'a> {
    pub pattern: &'a Pattern,
    pub draft: &'a Draft,
    /// How many.
    pub count: u32,
    /// What tells its pieces from those of other drafts, as in a size.
    pub label: Option<&'a str>,
}

/// Lays all pieces of one or more drafts, each fabric on its own markers, fabrics in the order in
/// which pieces first name them.
pub(crate) fn lay(
    garments: &[Garments<'_>],
    options: &NestOptions,
    watcher: &mut dyn Watcher,
) -> Result<Vec<Laying>, SessionError> {
    let mut groups: Vec<(String, Vec<Wanted>)> = Vec::new();
    for wanted in wanted_of(garments, options)? {
        match groups.iter_mut().find(|g| g.0 == wanted.fabric) {
            Some(group) => group.1.push(wanted),
            None => groups.push((wanted.fabric.clone(), vec![wanted])),
        }
    }
    if groups.is_empty() {
        return Err(NestingError::NoItems.into());
    }
    check_fabric_names(&groups, options)?;
    let fabrics = || garments.iter().flat_map(|g| &g.draft.fabrics);
    let starts = read_starts(options)?;
    let count = groups.len() as f64;
    let mut layings = Vec::new();
    let mut stopped = false;
    for (k, (name, wanted)) in groups.iter().enumerate() {
        let own: Option<&Fabric> = fabrics().find(|f| f.name == *name);
        let mut plan = options.plan(name, own)?;
        if runs_one_way(wanted) {
            for roll in &mut plan.rolls {
                if roll.strip.stripes.is_some() && roll.strip.nap == Nap::None {
                    roll.strip.nap = Nap::PerBundle;
                }
            }
        }
        let from = k as f64 / count;
        let mut part = |done: f64, detail: &str| {
            stopped |= tell(watcher, "laying out", from + done / count, detail).is_err();
            !stopped
        };
        let going_on = part(0.0, "");
        let laid = match going_on {
            true => lay_fabric((name, wanted), (&plan, options), (&starts, &mut part)),
            false if !options.keep_best => return Err(SessionError::Cancelled),
            false => {
                // Stopped on an earlier fabric: this one gets the first marker that is found.
                let mut shortly = options.clone();
                shortly.budget = Budget::Evaluations(1);
                let mut unheard = |_: f64, _: &str| true;
                lay_fabric((name, wanted), (&plan, &shortly), (&starts, &mut unheard))
            }
        };
        if stopped && !options.keep_best {
            return Err(SessionError::Cancelled);
        }
        layings.extend(laid?);
    }
    if stopped {
        for laying in &mut layings {
            laying
                .facts
                .notes
                .push("stopped early: the best so far".to_owned());
        }
    }
    Ok(layings)
}

/// Settings of a fabric that nothing is cut from are a mistake.
fn check_fabric_names(
    groups: &[(String, Vec<Wanted>)],
    options: &NestOptions,
) -> Result<(), SessionError> {
    let known = |name: &str| name == "*" || groups.iter().any(|g| g.0 == name);
    let given = options.settings.fabrics.keys();
    match given.into_iter().find(|name| !known(name)) {
        None => Ok(()),
        Some(name) => {
            let names: Vec<&str> = groups.iter().map(|g| g.0.as_str()).collect();
            Err(SessionError::Unknown {
                kind: "fabric",
                name: name.clone(),
                hint: format!("pieces are cut from: {}", names.join(", ")),
            })
        }
    }
}

/// Told the part done of one fabric and a detail; answers whether to go on.
type Told<'a> = &'a mut dyn FnMut(f64, &str) -> bool;

/// All markers of one fabric.
fn lay_fabric(
    (fabric, wanted): (&str, &[Wanted]),
    (plan, options): (&FabricPlan, &NestOptions),
    (starts, told): (&[MarkerFile], Told<'_>),
) -> Result<Vec<Laying>, SessionError> {
    let (mut items, pieces, notes) = items_on(wanted, plan, options)?;
    let start = start_of(starts, &items);
    if let Some(start) = &start {
        lock(&mut items, start, &options.locked);
    }
    let cancel = AtomicBool::new(false);
    let mut follow = |progress: Progress| {
        let detail = format!("{:.0} mm of fabric", progress.length * 1e3);
        if !told(progress.done, &detail) {
            cancel.store(true, Ordering::Relaxed);
        }
    };
    let mut control = Control {
        progress: &mut follow,
        cancel: &cancel,
    };
    let laying = |roll: &PlannedRoll, items: Vec<Item>, pieces: Vec<LaidPiece>, marker: Marker| {
        let verdict = judge(&items, &roll.strip, &marker);
        Laying {
            fabric: fabric.to_owned(),
            strip: roll.strip.clone(),
            facts: MarkerFacts {
                fabric: fabric.to_owned(),
                roll: roll.name.clone(),
                plies: plan.plies,
                face_to_face: plan.spread == Spread::FaceToFace,
                utilisation: marker.utilisation,
                price_per_metre: roll.price_per_metre,
                currency: options.settings.currency.clone().unwrap_or_default(),
                notes: notes.clone(),
            },
            missing: Vec::new(),
            items,
            pieces,
            marker,
            verdict,
        }
    };
    if !plan.rolled {
        let roll = &plan.rolls[0];
        let search = options.search();
        let marker = match &start {
            Some(start) => improve_marker(&items, &roll.strip, start, search, &mut control)?,
            None => make_marker(&items, &roll.strip, search, &mut control)?,
        };
        let mut only = laying(roll, items, pieces, marker);
        only.missing = named(&only.items, &only.marker.unplaced);
        return Ok(vec![only]);
    }
    let strips: Vec<Strip> = plan.rolls.iter().map(|r| r.strip.clone()).collect();
    let out = make_markers_on_rolls(&items, &strips, options.search(), &mut control)?;
    let missing = named(&items, &out.unplaced);
    let mut layings: Vec<Laying> = out
        .markers
        .into_iter()
        .map(|made| {
            let drawn = made.sources.iter().map(|s| pieces[s.0].clone());
            let drawn = drawn.collect();
            laying(&plan.rolls[made.roll], made.items, drawn, made.marker)
        })
        .collect();
    match layings.last_mut() {
        Some(last) => last.missing = missing,
        None => {
            let reasons = missing.iter().map(|[name, why]| format!("{name}: {why}"));
            let reasons: Vec<String> = reasons.collect();
            let what = format!("no piece fits any roll: {}", reasons.join("; "));
            return Err(NestingError::Strip(what).into());
        }
    }
    Ok(layings)
}

/// Names of copies that found no place, and why.
fn named(items: &[Item], unplaced: &[toile_nesting::Unplaced]) -> Vec<[String; 2]> {
    let name = |u: &toile_nesting::Unplaced| [items[u.item].name.clone(), u.reason.clone()];
    unplaced.iter().map(name).collect()
}
