//! Markers of drafts: one for each fabric their pieces are cut from, and for each roll of it.

use crate::flaws::check_given;
use crate::going_on::{check_locks, lock, read_starts, start_of};
use crate::laying_items::{Wanted, items_on, wanted_of};
use crate::matching::runs_one_way;
use crate::nest_options::{FabricPlan, PlannedRoll};
use crate::watcher::tell;
use crate::{Budget, NestOptions, Nested, SessionError, Watcher};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use toile_cut::CutPiece;
use toile_interchange::{
    ANY_NAME, MarkerDrawing, MarkerFabric, MarkerFacts, MarkerFile, MarkerFileUnplaced,
    MarkerPiece, Spread,
};
use toile_nesting::{
    Control, Item, Marker, Nap, NestingError, Progress, Search, Strip, Verdict, improve_marker,
    judge, make_marker, make_markers_on_rolls,
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
    pub pieces: Vec<Arc<CutPiece>>,
    pub strip: Strip,
    pub marker: Marker,
    pub verdict: Verdict,
    /// Copies that lie on no marker of this fabric, by the items and copies of the whole fabric.
    pub missing: Vec<MarkerFileUnplaced>,
    /// On a roll: of each item, its index among those of the whole fabric, and its copies there.
    pub sources: Option<Vec<(usize, Vec<u32>)>>,
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
            missing: self.reasons(),
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
                item: self.of_fabric(placement.item, placement.copy).0,
                piece: piece.clone(),
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
            unplaced: self.reasons(),
            overlaps: overlaps.cloned().collect(),
            facts: MarkerFacts {
                utilisation: self.marker.utilisation,
                ..self.facts.clone()
            },
        }
    }

    /// The marker as its file.
    pub fn file(&self, pattern: &str) -> MarkerFile {
        let title = self.title(pattern);
        let mut file = MarkerFile::new(&title, &self.items, &self.strip, &self.marker);
        for piece in &mut file.pieces {
            (piece.item, piece.copy) = self.of_fabric(piece.item, piece.copy);
        }
        MarkerFile {
            roll: self.facts.roll.clone(),
            plies: self.facts.plies,
            face_to_face: self.facts.face_to_face,
            unplaced: self.missing.clone(),
            fabric: MarkerFabric {
                name: Some(self.fabric.clone()),
                ..file.fabric
            },
            ..file
        }
    }

    /// The item and the copy of the whole fabric that an item and a copy of this marker are.
    fn of_fabric(&self, item: usize, copy: u32) -> (usize, u32) {
        let source = self.sources.as_ref().and_then(|s| s.get(item));
        let own = source.and_then(|(item, copies)| Some((*item, *copies.get(copy as usize)?)));
        own.unwrap_or((item, copy))
    }

    /// Names of the copies that lie nowhere, and why.
    fn reasons(&self) -> Vec<[String; 2]> {
        let reason = |u: &MarkerFileUnplaced| [u.name.clone(), u.reason.clone()];
        self.missing.iter().map(reason).collect()
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
    let names: Vec<&str> = groups.iter().map(|group| group.0.as_str()).collect();
    check_given(&options.defects, &names)?;
    let fabrics = || garments.iter().flat_map(|g| &g.draft.fabrics);
    let starts = read_starts(options)?;
    // Everything is refused before anything is searched for.
    let jobs: Vec<FabricJob<'_>> = groups
        .iter()
        .map(|(name, wanted)| {
            let own: Option<&Fabric> = fabrics().find(|f| f.name == *name);
            FabricJob::new((name, wanted), own, (options, &starts))
        })
        .collect::<Result<_, _>>()?;
    check_locks(jobs.iter().flat_map(|job| &job.items), &options.locked)?;
    let count = jobs.len() as f64;
    let flag = watcher.stop_flag().unwrap_or_default();
    let mut layings = Vec::new();
    let mut stopped = false;
    for (k, job) in jobs.iter().enumerate() {
        let from = k as f64 / count;
        let mut part = |done: f64, detail: &str| {
            stopped |= tell(watcher, "laying out", from + done / count, detail).is_err();
            !stopped
        };
        let laid = match part(0.0, "") {
            true => job.lay(options, &flag, &mut part),
            false => Err(SessionError::Cancelled),
        };
        stopped |= flag.load(Ordering::Relaxed);
        if stopped && !options.keep_best {
            return Err(SessionError::Cancelled);
        }
        layings.extend(match laid {
            // Earlier fabrics are done: this one gets the first marker that is found.
            Err(SessionError::Cancelled) if !layings.is_empty() => {
                stopped = true;
                let mut shortly = options.clone();
                shortly.budget = Budget::Evaluations(1);
                job.lay(&shortly, &Arc::default(), &mut |_, _| true)?
            }
            laid => laid?,
        });
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
    let known = |name: &str| name == ANY_NAME || groups.iter().any(|g| g.0 == name);
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

/// What is to be laid on one fabric.
struct FabricJob<'a> {
    fabric: &'a str,
    plan: FabricPlan,
    items: Vec<Item>,
    pieces: Vec<Arc<CutPiece>>,
    notes: Vec<String>,
    /// What to go on from.
    start: Option<Marker>,
}

impl<'a> FabricJob<'a> {
    fn new(
        (fabric, wanted): (&'a str, &[Wanted]),
        own: Option<&Fabric>,
        (options, starts): (&NestOptions, &[MarkerFile]),
    ) -> Result<Self, SessionError> {
        let mut plan = options.plan(fabric, own)?;
        if plan.rolled && !starts.is_empty() {
            return Err(SessionError::Conflict(format!(
                "fabric {fabric:?} is laid on rolls, and markers on rolls cannot be gone on from; leave out --from, or the rolls"
            )));
        }
        if runs_one_way(wanted) {
            for roll in &mut plan.rolls {
                if roll.strip.stripes.is_some() && roll.strip.nap == Nap::None {
                    roll.strip.nap = Nap::PerBundle;
                }
            }
        }
        let (mut items, pieces, notes) = items_on(wanted, &plan, options)?;
        let start = start_of(starts, fabric, (&items, &plan.rolls[0].strip));
        if let Some(start) = &start {
            lock(&mut items, start, &options.locked);
        }
        Ok(Self {
            fabric,
            plan,
            items,
            pieces,
            notes,
            start,
        })
    }

    /// All markers of the fabric. Stops when the flag is set, or the one told says so.
    fn lay(
        &self,
        options: &NestOptions,
        flag: &AtomicBool,
        told: Told<'_>,
    ) -> Result<Vec<Laying>, SessionError> {
        let mut follow = |progress: Progress| {
            let detail = match progress.length.is_finite() {
                true => format!("{:.0} mm of fabric", progress.length * 1e3),
                false => "making ready".to_owned(),
            };
            if !told(progress.done, &detail) {
                flag.store(true, Ordering::Relaxed);
            }
        };
        let mut control = Control {
            progress: &mut follow,
            cancel: flag,
        };
        let search = options.search();
        if self.plan.rolled {
            return self.lay_on_rolls(options, search, &mut control);
        }
        let strip = &self.plan.rolls[0].strip;
        let marker = match &self.start {
            Some(start) => improve_marker(&self.items, strip, start, search, &mut control)?,
            None => make_marker(&self.items, strip, search, &mut control)?,
        };
        let missing = named(&self.items, &marker.unplaced);
        let of = (self.items.clone(), self.pieces.clone());
        let mut only = self.laying(&self.plan.rolls[0], of, marker, options);
        only.missing = missing;
        Ok(vec![only])
    }

    fn lay_on_rolls(
        &self,
        options: &NestOptions,
        search: Search,
        control: &mut Control<'_>,
    ) -> Result<Vec<Laying>, SessionError> {
        let strips: Vec<Strip> = self.plan.rolls.iter().map(|r| r.strip.clone()).collect();
        let out = make_markers_on_rolls(&self.items, &strips, search, control)?;
        let missing = named(&self.items, &out.unplaced);
        let mut layings: Vec<Laying> = out
            .markers
            .into_iter()
            .map(|made| {
                let drawn = made.sources.iter().map(|s| self.pieces[s.0].clone());
                let of = (made.items, drawn.collect());
                let roll = &self.plan.rolls[made.roll];
                Laying {
                    sources: Some(made.sources),
                    ..self.laying(roll, of, made.marker, options)
                }
            })
            .collect();
        let Some(last) = layings.last_mut() else {
            let reasons = missing.iter().map(|u| format!("{}: {}", u.name, u.reason));
            let reasons: Vec<String> = reasons.collect();
            let what = format!("no piece fits any roll: {}", reasons.join("; "));
            return Err(NestingError::Strip(what).into());
        };
        last.missing = missing;
        Ok(layings)
    }

    /// A marker with what a drawing of it needs; nothing counts as missing yet.
    fn laying(
        &self,
        roll: &PlannedRoll,
        (items, pieces): (Vec<Item>, Vec<Arc<CutPiece>>),
        marker: Marker,
        options: &NestOptions,
    ) -> Laying {
        let verdict = judge(&items, &roll.strip, &marker);
        Laying {
            fabric: self.fabric.to_owned(),
            strip: roll.strip.clone(),
            facts: MarkerFacts {
                fabric: self.fabric.to_owned(),
                roll: roll.name.clone(),
                plies: self.plan.plies,
                face_to_face: self.plan.spread == Spread::FaceToFace,
                utilisation: marker.utilisation,
                price_per_metre: roll.price_per_metre,
                currency: options.settings.currency.clone().unwrap_or_default(),
                notes: self.notes.clone(),
            },
            missing: Vec::new(),
            sources: None,
            items,
            pieces,
            marker,
            verdict,
        }
    }
}

/// Copies that found no place, by name.
fn named(items: &[Item], unplaced: &[toile_nesting::Unplaced]) -> Vec<MarkerFileUnplaced> {
    let name = |u: &toile_nesting::Unplaced| MarkerFileUnplaced {
        name: items[u.item].name.clone(),
        item: u.item,
        copy: u.copy,
        reason: u.reason.clone(),
    };
    unplaced.iter().map(name).collect()
}
