//! What is derived from the project, kept while the project does not change.

use crate::choice::BodyChoice;
use crate::setup::{self, GarmentJob};
use crate::{Project, SessionError};
use std::sync::Arc;
use toile_assembly::Garment;
use toile_body::{Figure, Mannequin};
use toile_geometry::SurfaceTree;
use toile_measure::Measurements;
use toile_pattern::{Diagnostic, Draft, Fabric, FabricId};

/// A mannequin and what it was made from.
struct KeptMannequin {
    figure: Figure,
    measurements: Measurements,
    mannequin: Arc<Mannequin>,
    skin: Arc<SurfaceTree>,
}

/// Products of one project. What a change does not touch is kept: the mannequin outlives edits of
/// the pattern.
#[derive(Default)]
pub(crate) struct Derived {
    drafted: Option<(Arc<Draft>, Arc<Vec<Diagnostic>>)>,
    mannequin: Option<KeptMannequin>,
    garment: Option<Arc<Garment>>,
}

impl Derived {
    /// Forgets everything that a change of the project may have changed.
    pub fn forget(&mut self) {
        *self = Self {
            mannequin: self.mannequin.take(),
            ..Self::default()
        };
    }

    /// The draft with the fabric chosen, and everything found wrong with the pattern.
    pub fn drafted(&mut self, project: &Project) -> (Arc<Draft>, Arc<Vec<Diagnostic>>) {
        let (draft, diagnostics) = self.drafted.get_or_insert_with(|| {
            let (mut draft, diagnostics) = project.pattern.resolve(&project.drafted_to());
            if let Some(fabric) = project
                .fabric
                .as_deref()
                .and_then(|n| fabric_named(project, n))
            {
                draft.fabrics = vec![fabric];
                for piece in &mut draft.pieces {
                    piece.fabric = 0;
                }
            }
            (Arc::new(draft), Arc::new(diagnostics))
        });
        (draft.clone(), diagnostics.clone())
    }

    /// The mannequin of the project's wearer.
    pub fn mannequin(&mut self, project: &Project) -> Result<Arc<Mannequin>, SessionError> {
        let (figure, measurements) = (project.figure(), project.wearer());
        if let Some(kept) = &self.mannequin
            && kept.figure == figure
            && kept.measurements == measurements
        {
            return Ok(kept.mannequin.clone());
        }
        let mannequin =
            Mannequin::new(&measurements, figure).map_err(|error| match &project.body {
                BodyChoice::Measured { path, .. } => SessionError::Format {
                    path: path.clone(),
                    error: toile_interchange::FormatError::new(
                        "measurements",
                        error.to_string(),
                        "change the file",
                    ),
                },
                _ => SessionError::Body(error),
            })?;
        let mannequin = Arc::new(mannequin);
        self.mannequin = Some(KeptMannequin {
            figure,
            measurements,
            skin: Arc::new(SurfaceTree::new(mannequin.skin().clone())),
            mannequin: mannequin.clone(),
        });
        Ok(mannequin)
    }

    /// The meshed and placed pieces.
    pub fn garment(&mut self, project: &Project) -> Result<Arc<Garment>, SessionError> {
        if let Some(garment) = &self.garment {
            return Ok(garment.clone());
        }
        let (draft, _) = self.drafted(project);
        let mannequin = self.mannequin(project)?;
        let wearer = setup::wearer(&mannequin);
        let edge_length = project.quality.edge_length();
        let garment = Arc::new(setup::assemble(&draft, &wearer, edge_length)?);
        self.garment = Some(garment.clone());
        Ok(garment)
    }

    /// The garment ready to be sewn and draped.
    pub fn job(&mut self, project: &Project) -> Result<GarmentJob, SessionError> {
        let garment = self.garment(project)?;
        let (draft, _) = self.drafted(project);
        self.mannequin(project)?;
        let skin = match &self.mannequin {
            Some(kept) => kept.skin.clone(),
            None => Arc::new(SurfaceTree::new(Default::default())),
        };
        Ok(setup::job(&draft, garment, skin, project.quality))
    }
}

/// A fabric by name: one of the pattern's, else `jersey` or `poplin`.
pub(crate) fn fabric_named(project: &Project, name: &str) -> Option<Fabric> {
    let own = project.pattern.fabrics.iter().find(|f| f.name == name);
    match (own, name) {
        (Some(own), _) => Some((**own).clone()),
        (None, "jersey") => Some(Fabric::jersey(FabricId(0))),
        (None, "poplin") => Some(Fabric::poplin(FabricId(0))),
        (None, _) => None,
    }
}
