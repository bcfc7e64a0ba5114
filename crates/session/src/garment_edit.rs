//! Carries an edit of the pattern over to the garment that is worn: with other rest shapes of the
//! same triangles, on another mesh, or not at all.
//!
//! # Decided with
//! - [`toile_assembly::morph()`]: the same triangles at new places;
//! - [`crate::garment_edit::CannotFollow`], [`crate::garment_edit::CannotFollow::asks_for_another`]: why it
//!   cannot follow; whether it is hung anew;
//! - [`crate::rest_change::RestChange`]: how much changes;
//! - [`crate::live::LiveRun::edit`], [`crate::interactive_run::InteractiveRun::edit`]: when an edit is taken;
//!   how it is handed on;
//! - [`toile_drape::GarmentRun`]: the run of the garment, which goes on under other shapes or another mesh;
//! - [`crate::mannequin_source::MannequinSource::of`]: whether it is still the same body; the window asks
//!   [`crate::project::Project::has_same_body`].
//!
//! The window asks (`app/background_work.rs`).

use crate::derived::Derived;
use crate::fabrics::cloth_material;
use crate::mannequin_source::MannequinSource;
use crate::outfit::{DraftedPart, MeshedPart, Outfit};
use crate::rest_change::RestChange;
use crate::setup::{self, JobOrigin};
use crate::{GarmentJob, Project, Session, SessionError};
use std::sync::Arc;
use toile_assembly::{PieceMeshes, morph};
use toile_pattern::{Draft, Piece};

/// Effect of an edit of the pattern on a garment that is worn.
pub struct GarmentEdit {
    /// The garment after the edit. Unless it is meshed anew, it keeps its triangles.
    pub job: GarmentJob,
    /// Kind of change of the cloth.
    pub change: RestChange,
}

/// Reason why a worn garment cannot follow to the present pattern.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CannotFollow {
    /// Panels were added, removed or put in another order.
    #[error("the pattern has other panels now; drape it again")]
    Panels,
    /// The body has changed.
    #[error("the body is another now; drape it again")]
    Body,
    /// The quality has changed.
    #[error("the cloth is to be finer or coarser now; drape it again")]
    Quality,
    /// A panel is cut from cloth of another material.
    #[error("the fabric of \"{0}\" is another now; drape it again")]
    Fabric(String),
    /// Other garments are worn, or in other layers.
    #[error("other garments are worn together now, or in other layers; drape them again")]
    Garments,
    /// The pattern has faults.
    #[error("the pattern has faults; the garment goes on when they are mended")]
    Faults,
    /// The pattern cannot be meshed or sewn as it is, for another reason.
    #[error("it cannot be made as it is now: {0}")]
    NotMade(String),
}

impl CannotFollow {
    /// Whether a new garment of the present project can hang at once in place of the worn one. While panels
    /// are added or faults are still to be mended it is better to wait.
    pub fn asks_for_another(&self) -> bool {
        match self {
            Self::Body | Self::Quality | Self::Fabric(_) | Self::Garments => true,
            Self::Panels | Self::Faults | Self::NotMade(_) => false,
        }
    }
}

impl Session {
    /// Carries a worn garment, made from an earlier state of this project, over to the present state. It is
    /// not put on anew: that is for [`Session::garment_setup`].
    ///
    /// # Errors
    /// The reason why the garment cannot follow.
    pub fn garment_edit(&mut self, worn: &GarmentJob) -> Result<GarmentEdit, CannotFollow> {
        let mut edit = self.derived.garment_edit(&self.project, worn)?;
        edit.job.revision = self.revision;
        Ok(edit)
    }
}

impl Derived {
    fn garment_edit(
        &mut self,
        project: &Project,
        worn: &GarmentJob,
    ) -> Result<GarmentEdit, CannotFollow> {
        let origin = &*worn.origin;
        if origin.quality != project.quality {
            return Err(CannotFollow::Quality);
        }
        if origin.body != MannequinSource::of(project) {
            return Err(CannotFollow::Body);
        }
        refuse_other_garments(&origin.drafted, &self.parts(project))?;
        let parts = self.sound_parts(project).map_err(cannot_be_made)?;
        refuse_other_pieces(&origin.drafted, &parts)?;
        let is_same = |(old, new): (&DraftedPart, &DraftedPart)| has_same_cloth(old, new);
        if origin.drafted.iter().zip(parts.iter()).all(is_same) {
            let mut job = worn.clone();
            for (listed, part) in Arc::make_mut(&mut job.parts).iter_mut().zip(&*parts) {
                listed.name.clone_from(&part.name);
                listed.source.clone_from(&part.source);
            }
            let change = RestChange::Nothing;
            return Ok(GarmentEdit { job, change });
        }
        let morphed: Option<Vec<MeshedPart>> = origin
            .meshed
            .iter()
            .zip(parts.iter())
            .map(morphed)
            .collect();
        let (outfit, meshed, change) = match morphed {
            Some(parts) => (
                Arc::new(Outfit::new(parts)),
                origin.meshed.clone(),
                RestChange::Shapes,
            ),
            None => {
                let outfit = self.outfit(project).map_err(cannot_be_made)?;
                let meshed = outfit.meshed.clone();
                (outfit, meshed, RestChange::Mesh)
            }
        };
        let skin = worn.setup.colliders.first();
        let skin = skin.ok_or(CannotFollow::Body)?.clone();
        let mut job = setup::job(&outfit, (origin.body.clone(), skin), project.quality);
        // The run has passed the coarser meshes, which stay as they were.
        let coarse = worn.setup.levels.len().saturating_sub(1);
        let finest = std::mem::take(&mut job.setup.levels);
        job.setup.levels = worn.setup.levels[..coarse].to_vec();
        job.setup.levels.extend(finest);
        job.origin = Arc::new(JobOrigin {
            body: origin.body.clone(),
            quality: origin.quality,
            drafted: parts.to_vec(),
            meshed,
        });
        Ok(GarmentEdit { job, change })
    }
}

/// The garment on the same triangles with the shapes of another draft; `None` if the mesh cannot be morphed.
fn morphed((old, new): (&MeshedPart, &DraftedPart)) -> Option<MeshedPart> {
    let meshes = match has_same_cloth(&old.part, new) {
        true => PieceMeshes::clone(&old.meshes),
        false => morph(&old.meshes, &new.draft).ok()?,
    };
    let garment = old.garment.with_shapes(&new.draft, &meshes);
    Some(MeshedPart {
        part: new.clone(),
        meshes: Arc::new(meshes),
        garment,
    })
}

fn cannot_be_made(error: SessionError) -> CannotFollow {
    match matches!(error, SessionError::Faults { .. }) {
        true => CannotFollow::Faults,
        false => CannotFollow::NotMade(error.to_string()),
    }
}

/// Whether two drafts have the same pieces, seams and fabrics; the garments' names may differ.
fn has_same_cloth(a: &DraftedPart, b: &DraftedPart) -> bool {
    let (a, b) = (&*a.draft, &*b.draft);
    std::ptr::eq(a, b) || a.pieces == b.pieces && a.seams == b.seams && a.fabrics == b.fabrics
}

/// Refuses other garments than before, and garments that lack a panel that was sewn.
fn refuse_other_garments(before: &[DraftedPart], now: &[DraftedPart]) -> Result<(), CannotFollow> {
    if before.len() != now.len() {
        return Err(CannotFollow::Garments);
    }
    for (k, (before, now)) in before.iter().zip(now).enumerate() {
        // The project's own garment, the first, may be saved under another name.
        let is_other = k > 0 && before.source != now.source;
        if is_other || before.layer != now.layer {
            return Err(CannotFollow::Garments);
        }
        let mut pieces = sewn(&before.draft);
        if pieces.any(|piece| now.pattern.panel(piece.id.panel).is_none()) {
            return Err(CannotFollow::Panels);
        }
    }
    Ok(())
}

/// Refuses garments with other sewn pieces than before, or with pieces cut from another material.
fn refuse_other_pieces(before: &[DraftedPart], now: &[DraftedPart]) -> Result<(), CannotFollow> {
    for (before, now) in before.iter().zip(now) {
        let [old, new] = [before, now].map(|part| sewn(&part.draft).collect::<Vec<_>>());
        let mut pairs = old.iter().zip(&new);
        if old.len() != new.len() || pairs.any(|(a, b)| a.id != b.id) {
            return Err(CannotFollow::Panels);
        }
        let material =
            |draft: &Draft, piece: &Piece| draft.fabrics.get(piece.fabric).map(cloth_material);
        let mut pairs = old.iter().zip(&new);
        let other = pairs.find(|(a, b)| material(&before.draft, a) != material(&now.draft, b));
        if let Some((_, piece)) = other {
            return Err(CannotFollow::Fabric(piece.name.clone()));
        }
    }
    Ok(())
}

fn sewn(draft: &Draft) -> impl Iterator<Item = &Piece> {
    draft.pieces.iter().filter(|piece| piece.sewn)
}
