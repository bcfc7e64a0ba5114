//! Caches everything that is computed from the project: draft, mannequin, markers, garment, drape.
//!
//! # Decided with
//! - [`crate::project::Project`]: what all is derived from;
//! - [`crate::outfit::Outfit`], [`crate::outfit::checked`]: garments put together, faults gathered;
//! - [`crate::setup::job`], [`crate::choice::Quality::first_edge_length`]: setup of a drape; the coarse level
//!   before it;
//! - [`crate::put_on::PutOn::otherwise`], [`crate::stuck::stuck`], [`toile_drape::GarmentRun`]: a garment put
//!   on another way; what holds one that does not come to rest;
//! - [`crate::mannequin_source::MannequinSource`]: when the mannequin is made anew;
//! - [`crate::marker_cache::MarkerCache`]: pieces of the document's markers;
//! - [`crate::session::Session::adopt`] (`snapshot.rs`): results taken over from another thread;
//! - [`crate::placed_panels::sleeve_angle`]: arms that follow sleeves.
//!
//! By hand: `follow` and `has_same_panels` name what each part depends on. In the window: `app/mod.rs`
//! (`refresh`), `app/background_work.rs`.

use crate::NestOptions;
use crate::choice::BodyChoice;
use crate::drape::{Drape, drape};
use crate::fabrics::{FabricChoice, unseen_at_rest};
use crate::mannequin_source::{MannequinSource, measurements_for_sleeves};
use crate::marker_cache::MarkerCache;
use crate::outfit::{DraftedPart, MeshedPart, Outfit, checked, tell_apart};
use crate::put_on::PutOn;
use crate::setup::{self, GarmentJob};
use crate::watched_search::lay_watched;
use crate::{Project, SessionError, Watcher};
use std::sync::Arc;
use toile_assembly::{AssemblyOptions, assemble};
use toile_body::{BodyError, Mannequin};
use toile_drape::{Aspect, Finding, Input};
use toile_geometry::SurfaceTree;
use toile_interchange::FormatError;
use toile_marker::{FinishedMarker, Garments};
use toile_pattern::{
    ClothSettings, Diagnostic, Draft, Evaluation, Panel, Pattern, Size, SizeId, Wearer,
};

/// A mannequin with its skin, and the source that it was made from.
#[derive(Clone)]
struct CachedMannequin {
    source: MannequinSource,
    mannequin: Arc<Mannequin>,
    skin: Arc<SurfaceTree>,
}

/// The wearer a pattern is drafted for, with the choices that decide it. Cached, because predicting
/// measurements that were not given takes longer than drafting a small pattern.
#[derive(Clone)]
struct DraftedFor {
    size: Option<String>,
    body: BodyChoice,
    sizes: Vec<Arc<Size>>,
    base_size: Option<SizeId>,
    wearer: Wearer,
}

impl DraftedFor {
    fn of(project: &Project) -> Self {
        Self {
            size: project.size.clone(),
            body: project.body.clone(),
            sizes: project.pattern.sizes.clone(),
            base_size: project.pattern.base_size,
            wearer: project.drafted_to(),
        }
    }

    fn holds_for(&self, project: &Project) -> bool {
        let (known, now) = (&self.sizes, &project.pattern.sizes);
        let mut pairs = known.iter().zip(now);
        known.len() == now.len()
            && pairs.all(|(a, b)| Arc::ptr_eq(a, b))
            && self.base_size == project.pattern.base_size
            && self.size == project.size
            && self.body == project.body
    }
}

/// All values computed from one project; a value that is missing is computed when asked for.
#[derive(Clone, Default)]
pub(crate) struct Derived {
    evaluation: Option<Arc<Evaluation>>,
    /// Pattern that the evaluation was last updated to.
    evaluated: Option<Arc<Pattern>>,
    drafted_for: Option<DraftedFor>,
    draft: Option<Arc<Draft>>,
    diagnostics: Option<Arc<Vec<Diagnostic>>>,
    mannequin: Option<CachedMannequin>,
    /// The markers, if they were made.
    pub finished_markers: Option<Arc<Vec<FinishedMarker>>>,
    /// Drafts and pieces of the document's markers.
    pub markers: MarkerCache,
    /// Drafts of the garments worn.
    parts: Option<Arc<Vec<DraftedPart>>>,
    outfit: Option<Arc<Outfit>>,
    /// Notes on the garment's mesh, placement and cloth.
    pub assembly_notes: Vec<String>,
    /// The drape, if it was made.
    pub drape: Option<Arc<Drape>>,
}

impl Derived {
    /// Drops the results that a change of the project may invalidate. The mannequin stays: it is
    /// cached with its source. Results made from a draft stay if the new draft is equal, as after a
    /// panel was moved on the table or a construction line was drawn.
    pub fn follow(&mut self, before: &Project, after: &Project) {
        let same_choices =
            before.body == after.body && before.size == after.size && before.fabric == after.fabric;
        let mut same_draft = same_choices && Arc::ptr_eq(&before.pattern, &after.pattern);
        if !same_draft {
            self.diagnostics = None;
            let old = self.draft.take();
            let makes =
                self.finished_markers.is_some() || self.outfit.is_some() || self.drape.is_some();
            if let Some(old) = old.filter(|_| makes && same_choices)
                && has_same_panels(&before.pattern, &after.pattern)
                && *self.draft(after) == *old
            {
                self.draft = Some(old);
                same_draft = true;
            }
        }
        let same_parts = same_draft && before.layer == after.layer && before.others == after.others;
        if !same_parts {
            self.parts = None;
        }
        if !same_parts || before.width != after.width {
            self.finished_markers = None;
        }
        if !same_parts || before.quality != after.quality {
            self.outfit = None;
            self.assembly_notes.clear();
            self.drape = None;
        }
    }

    /// Takes over the results that `other`, derived from the same project, has and this one lacks;
    /// and the mannequin of `other`, if it has one.
    pub fn adopt(&mut self, other: Self) {
        self.draft = self.draft.take().or(other.draft);
        self.diagnostics = self.diagnostics.take().or(other.diagnostics);
        self.mannequin = other.mannequin.or(self.mannequin.take());
        self.finished_markers = self.finished_markers.take().or(other.finished_markers);
        self.parts = self.parts.take().or(other.parts);
        if self.outfit.is_none() {
            self.outfit = other.outfit;
            self.assembly_notes = other.assembly_notes;
        }
        self.drape = self.drape.take().or(other.drape);
    }

    /// Takes over only the mannequin of `other`.
    pub fn adopt_mannequin(&mut self, other: Self) {
        self.mannequin = other.mannequin.or(self.mannequin.take());
    }

    /// Evaluation of all values of the pattern, updated to the present project.
    pub fn evaluation(&mut self, project: &Project) -> Arc<Evaluation> {
        let wearer = match self.drafted_for.take() {
            Some(known) if known.holds_for(project) => &self.drafted_for.insert(known).wearer,
            _ => &self.drafted_for.insert(DraftedFor::of(project)).wearer,
        };
        let kept = self.evaluation.get_or_insert_with(Arc::default);
        let known = self.evaluated.as_ref();
        let is_same = known.is_some_and(|known| Arc::ptr_eq(known, &project.pattern));
        if !is_same || kept.wearer() != wearer {
            Arc::make_mut(kept).update(&project.pattern, wearer);
            self.evaluated = Some(project.pattern.clone());
        }
        kept.clone()
    }

    /// Discards the draft and its diagnostics, for the preview of a gesture.
    pub fn forget_draft(&mut self) {
        self.draft = None;
        self.diagnostics = None;
    }

    /// These results with the evaluation of `other`, from which the next update starts.
    #[must_use]
    pub fn with_evaluation_of(self, other: &Self) -> Self {
        Self {
            evaluation: other.evaluation.clone(),
            evaluated: other.evaluated.clone(),
            ..self
        }
    }

    /// The draft of the project's own pattern, cut from the chosen fabric.
    pub fn draft(&mut self, project: &Project) -> Arc<Draft> {
        if let Some(draft) = &self.draft {
            return draft.clone();
        }
        tracing::debug!("draft recomputed");
        let (mut draft, _) = self.evaluation(project).draft();
        let chosen = project.fabric.as_ref();
        if let Some(fabric) = chosen.and_then(|choice| choice.fabric(&project.pattern)) {
            FabricChoice::cut(fabric, &mut draft);
        }
        self.draft.insert(Arc::new(draft)).clone()
    }

    /// Everything found wrong with the pattern.
    pub fn diagnostics(&mut self, project: &Project) -> Arc<Vec<Diagnostic>> {
        if let Some(diagnostics) = &self.diagnostics {
            return diagnostics.clone();
        }
        tracing::debug!("diagnostics recomputed");
        let (_, diagnostics) = checked(&self.evaluation(project));
        self.diagnostics.insert(Arc::new(diagnostics)).clone()
    }

    /// Drafts of all garments worn, the project's own first, with their diagnostics.
    pub fn parts(&mut self, project: &Project) -> Arc<Vec<DraftedPart>> {
        if let Some(parts) = &self.parts {
            return parts.clone();
        }
        let draft = self.draft(project);
        let diagnostics = self.diagnostics(project);
        let mut parts = vec![DraftedPart::own(project, draft, diagnostics)];
        let others = project.other_patterns();
        parts.extend(others.map(|(worn, pattern)| DraftedPart::other(project, worn, pattern)));
        tell_apart(&mut parts);
        self.parts.insert(Arc::new(parts)).clone()
    }

    /// Drafts of all garments worn, refused if a fault keeps one of them from being made.
    pub fn sound_parts(
        &mut self,
        project: &Project,
    ) -> Result<Arc<Vec<DraftedPart>>, SessionError> {
        let parts = self.parts(project);
        for part in parts.iter() {
            part.refuse_faults()?;
        }
        Ok(parts)
    }

    /// The mannequin of the project's wearer.
    pub fn mannequin(&mut self, project: &Project) -> Result<Arc<Mannequin>, SessionError> {
        Ok(self.cached_mannequin(project)?.mannequin.clone())
    }

    fn cached_mannequin(&mut self, project: &Project) -> Result<&CachedMannequin, SessionError> {
        let source = MannequinSource::of(project);
        let kept = match self.mannequin.take() {
            Some(kept) if kept.source == source => kept,
            _ => {
                tracing::debug!("mannequin recomputed");
                let mannequin = source.make().map_err(|error| body_error(project, error))?;
                CachedMannequin {
                    source,
                    skin: Arc::new(SurfaceTree::new(mannequin.skin().clone())),
                    mannequin: Arc::new(mannequin),
                }
            }
        };
        Ok(self.mannequin.insert(kept))
    }

    /// Lays the markers, or returns the markers laid before.
    pub fn finished_markers(
        &mut self,
        project: &Project,
        watcher: &mut dyn Watcher,
    ) -> Result<Arc<Vec<FinishedMarker>>, SessionError> {
        if let Some(finished_markers) = &self.finished_markers {
            return Ok(finished_markers.clone());
        }
        let parts = self.sound_parts(project)?;
        tracing::debug!("markers recomputed");
        let options = NestOptions {
            cloth: ClothSettings {
                width: project.width,
                ..ClothSettings::default()
            },
            ..NestOptions::default()
        };
        let several = parts.len() > 1;
        let each = parts.iter().map(|part| Garments {
            pattern: &part.pattern,
            draft: &part.draft,
            count: 1,
            label: several.then_some(&*part.name),
        });
        let garments: Vec<Garments<'_>> = each.collect();
        let finished_markers = Arc::new(lay_watched(&garments, &options, watcher)?);
        self.finished_markers = Some(finished_markers.clone());
        Ok(finished_markers)
    }

    /// The meshed and placed pieces of every garment worn.
    pub fn outfit(&mut self, project: &Project) -> Result<Arc<Outfit>, SessionError> {
        if let Some(outfit) = &self.outfit {
            return Ok(outfit.clone());
        }
        let put_on = PutOn::as_given(self.sound_parts(project)?);
        let outfit = self.outfit_put_on(project, &put_on)?;
        Ok(self.outfit.insert(outfit).clone())
    }

    /// Meshes and places the pieces of every garment, put on as `put_on` says.
    fn outfit_put_on(
        &mut self,
        project: &Project,
        put_on: &PutOn,
    ) -> Result<Arc<Outfit>, SessionError> {
        tracing::debug!("outfit recomputed");
        let mannequin = self.mannequin(project)?;
        let (outfit, notes) = assembled(put_on, &mannequin, project.quality.edge_length())?;
        self.assembly_notes = notes;
        self.assembly_notes.extend(unseen_at_rest(&outfit.draft));
        self.assembly_notes.extend(arms_follow_sleeves(project));
        Ok(Arc::new(outfit))
    }

    /// Whether the pieces are meshed and placed already.
    pub fn has_outfit(&self) -> bool {
        self.outfit.is_some()
    }

    /// The garment ready to be sewn and draped.
    pub fn job(&mut self, project: &Project) -> Result<GarmentJob, SessionError> {
        let put_on = PutOn::as_given(self.sound_parts(project)?);
        let outfit = self.outfit(project)?;
        self.job_put_on(project, &outfit, &put_on)
    }

    /// The drape job of an outfit that was put on as `put_on` says.
    fn job_put_on(
        &mut self,
        project: &Project,
        outfit: &Outfit,
        put_on: &PutOn,
    ) -> Result<GarmentJob, SessionError> {
        let skin = self.cached_mannequin(project)?.skin.clone();
        let source = MannequinSource::of(project);
        let mut job = setup::job(outfit, (source, skin), project.quality);
        // A garment with gathers gets no coarse mesh: on it, gathers would form fewer folds.
        let gathers = outfit.draft.seams.iter().any(|seam| seam.gathered);
        let first = project.quality.first_edge_length();
        if let Some(edge_length) = first.filter(|_| !gathers) {
            let mannequin = self.mannequin(project)?;
            // A piece too small for the coarse mesh is no fault: the fine mesh is then used alone.
            if let Ok((coarse, _)) = assembled(put_on, &mannequin, edge_length) {
                job.setup.levels.insert(0, setup::level(&coarse));
            }
        }
        Ok(job)
    }

    /// Drapes the garment, or returns the drape made before with the same inputs.
    pub fn drape(
        &mut self,
        project: &Project,
        inputs: &[Input],
        watcher: &mut dyn Watcher,
    ) -> Result<Arc<Drape>, SessionError> {
        if let Some(drape) = self.drape.as_ref().filter(|drape| drape.inputs == inputs) {
            return Ok(drape.clone());
        }
        tracing::debug!("drape recomputed");
        let made = match drape(self.job(project)?, inputs, watcher) {
            Err(error) if error.has_left_body() => {
                self.drape_otherwise(project, inputs, watcher)?
            }
            made => made?,
        };
        let made = Arc::new(made);
        self.drape = Some(made.clone());
        Ok(made)
    }

    /// Drapes a garment that fell off the body once more, put on another way; an error if it falls off again.
    fn drape_otherwise(
        &mut self,
        project: &Project,
        inputs: &[Input],
        watcher: &mut dyn Watcher,
    ) -> Result<Drape, SessionError> {
        let (put_on, [first, second]) = PutOn::otherwise(&self.sound_parts(project)?)
            .map_err(|place| SessionError::falls_off(&place, None))?;
        let fell = |error: SessionError| match error.has_left_body() {
            true => SessionError::falls_off(first, Some(second)),
            false => error,
        };
        let given = self.outfit(project)?;
        let outfit = self.outfit_put_on(project, &put_on)?;
        if put_on.hangs_from_chest && outfit.garment.positions == given.garment.positions {
            // A garment that hangs neither from the waist nor from the chest hangs from the neck.
            return Err(SessionError::falls_off("from the neck", None));
        }
        let job = self.job_put_on(project, &outfit, &put_on)?;
        let mut made = drape(job, inputs, watcher).map_err(fell)?;
        self.outfit = Some(outfit);
        let words = format!("put on {first}, it fell off the body: put on again {second}");
        made.warnings.insert(0, words.clone());
        let told = Finding::told(Aspect::Placement, words);
        made.verdict.extend([told]);
        Ok(made)
    }
}

/// Note on the angle of the arms, if they are held as the sleeves are placed.
fn arms_follow_sleeves(project: &Project) -> Option<String> {
    if project.body.description().is_some() {
        return None;
    }
    let angle = measurements_for_sleeves(project).1?.to_degrees();
    Some(format!(
        "the arms are held {angle:.0} degrees below the horizontal, as the sleeves are placed; give arm_pose_angle among the measurements to hold them otherwise"
    ))
}

/// Whether the panels of two patterns are equal apart from their positions on the table.
fn has_same_panels(a: &Pattern, b: &Pattern) -> bool {
    let same = |a: &Panel, b: &Panel| {
        let moved = Panel {
            on_table: b.on_table,
            ..a.clone()
        };
        moved == *b
    };
    let mut pairs = a.panels.iter().zip(&b.panels);
    a.unit == b.unit
        && a.panels.len() == b.panels.len()
        && pairs.all(|(a, b)| Arc::ptr_eq(a, b) || same(a, b))
}

/// Meshes the garments with a mean edge length (m) and places them round a mannequin; also
/// returns notes for the user.
fn assembled(
    put_on: &PutOn,
    mannequin: &Mannequin,
    edge_length: f64,
) -> Result<(Outfit, Vec<String>), SessionError> {
    let options = AssemblyOptions { edge_length };
    let body = put_on.body(setup::placement_body(mannequin));
    let parts = &put_on.parts;
    let mut meshed = Vec::new();
    let mut notes = Vec::new();
    for part in parts.iter() {
        let assembled = assemble(&part.draft, &body, &options)?;
        let prefix = match parts.len() {
            1 => String::new(),
            _ => format!("{}: ", part.name),
        };
        let found = assembled.diagnostics.iter();
        notes.extend(found.map(|note| format!("{prefix}{note}")));
        meshed.push(MeshedPart {
            part: part.clone(),
            meshes: assembled.meshes,
            garment: assembled.garment,
        });
    }
    Ok((Outfit::new(meshed), notes))
}

/// Turns an error of the body into one that names the file of the measurements, if there is one.
fn body_error(project: &Project, error: BodyError) -> SessionError {
    let BodyChoice::Measured {
        path: Some(path), ..
    } = &project.body
    else {
        return SessionError::Body(error);
    };
    SessionError::Format {
        path: path.clone(),
        error: FormatError::new("measurements", error.to_string(), "correct the file"),
    }
}
