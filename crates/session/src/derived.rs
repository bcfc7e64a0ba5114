//! What is derived from the project, kept while the project does not change.

use crate::NestOptions;
use crate::choice::BodyChoice;
use crate::drape::{Drape, drape};
use crate::fabrics::fabric_named;
use crate::laying::{Garments, Laying, lay};
use crate::setup::{self, GarmentJob};
use crate::{Project, SessionError, StampedInput, Watcher};
use std::sync::Arc;
use toile_assembly::{AssemblyOptions, Garment, assemble};
use toile_body::{BodyError, Description, Figure, Mannequin};
use toile_geometry::SurfaceTree;
use toile_interchange::FormatError;
use toile_measure::Measurements;
use toile_pattern::{Diagnostic, Draft};

/// What a mannequin is made from.
#[derive(Clone, PartialEq)]
enum Source {
    /// Grown to measurements.
    Grown(Figure, Measurements),
    /// Standing as its description says.
    Shaped(Arc<Description>),
}

impl Source {
    fn of(project: &Project) -> Self {
        match &project.body {
            BodyChoice::Shaped { description, .. } => Self::Shaped(description.clone()),
            _ => Self::Grown(project.figure(), project.wearer()),
        }
    }

    fn make(&self) -> Result<Mannequin, BodyError> {
        match self {
            Self::Grown(figure, measurements) => Mannequin::new(measurements, *figure),
            Self::Shaped(description) => Mannequin::from_description(description),
        }
    }
}

/// A mannequin and what it was made from.
#[derive(Clone)]
struct KeptMannequin {
    source: Source,
    mannequin: Arc<Mannequin>,
    skin: Arc<SurfaceTree>,
}

/// Products of one project.
#[derive(Clone, Default)]
pub(crate) struct Derived {
    drafted: Option<(Arc<Draft>, Arc<Vec<Diagnostic>>)>,
    mannequin: Option<KeptMannequin>,
    /// The markers, if they were made.
    pub layings: Option<Arc<Vec<Laying>>>,
    garment: Option<Arc<Garment>>,
    /// What is worth telling about the garment's mesh and placement.
    pub assembly_notes: Vec<String>,
    /// The drape, if it was made.
    pub drape: Option<Arc<Drape>>,
}

impl Derived {
    /// Forgets what a change of the project may have changed. The mannequin knows by itself what
    /// it was made from.
    pub fn follow(&mut self, before: &Project, after: &Project) {
        let same_draft = Arc::ptr_eq(&before.pattern, &after.pattern)
            && before.body == after.body
            && before.size == after.size
            && before.fabric == after.fabric;
        if !same_draft {
            self.drafted = None;
        }
        if !same_draft || before.width != after.width {
            self.layings = None;
        }
        if !same_draft || before.quality != after.quality {
            self.garment = None;
            self.assembly_notes.clear();
            self.drape = None;
        }
    }

    /// Takes over everything that another, derived from the same project, has and this one has
    /// not.
    pub fn adopt(&mut self, other: Self) {
        self.drafted = self.drafted.take().or(other.drafted);
        self.mannequin = other.mannequin.or(self.mannequin.take());
        self.layings = self.layings.take().or(other.layings);
        if self.garment.is_none() {
            self.garment = other.garment;
            self.assembly_notes = other.assembly_notes;
        }
        self.drape = self.drape.take().or(other.drape);
    }

    /// Takes over another's mannequin alone.
    pub fn adopt_mannequin(&mut self, other: Self) {
        self.mannequin = other.mannequin.or(self.mannequin.take());
    }

    /// The draft with the fabric chosen, and everything found wrong with the pattern.
    pub fn drafted(&mut self, project: &Project) -> (Arc<Draft>, Arc<Vec<Diagnostic>>) {
        let (draft, diagnostics) = self.drafted.get_or_insert_with(|| {
            let measurements = project.drafted_to();
            let diagnostics = project.pattern.check(&measurements);
            let (mut draft, _) = project.pattern.resolve(&measurements);
            let chosen = project.fabric.as_deref();
            if let Some(fabric) = chosen.and_then(|name| fabric_named(project, name)) {
                draft.fabrics = vec![fabric];
                for piece in &mut draft.pieces {
                    piece.fabric = 0;
                }
            }
            (Arc::new(draft), Arc::new(diagnostics))
        });
        (draft.clone(), diagnostics.clone())
    }

    /// The draft, if nothing keeps the garment from being made.
    fn sound_draft(&mut self, project: &Project) -> Result<Arc<Draft>, SessionError> {
        let (draft, diagnostics) = self.drafted(project);
        project.refuse_faults(&diagnostics)?;
        Ok(draft)
    }

    /// The mannequin of the project's wearer.
    pub fn mannequin(&mut self, project: &Project) -> Result<Arc<Mannequin>, SessionError> {
        Ok(self.kept_mannequin(project)?.mannequin.clone())
    }

    fn kept_mannequin(&mut self, project: &Project) -> Result<&KeptMannequin, SessionError> {
        let source = Source::of(project);
        let kept = match self.mannequin.take() {
            Some(kept) if kept.source == source => kept,
            _ => {
                let mannequin = source.make().map_err(|error| body_error(project, error))?;
                KeptMannequin {
                    source,
                    skin: Arc::new(SurfaceTree::new(mannequin.skin().clone())),
                    mannequin: Arc::new(mannequin),
                }
            }
        };
        Ok(self.mannequin.insert(kept))
    }

    /// The markers.
    pub fn layings(
        &mut self,
        project: &Project,
        watcher: &mut dyn Watcher,
    ) -> Result<Arc<Vec<Laying>>, SessionError> {
        if let Some(layings) = &self.layings {
            return Ok(layings.clone());
        }
        let draft = self.sound_draft(project)?;
        let options = NestOptions {
            width: project.width,
            ..NestOptions::default()
        };
        let garments = [Garments {
            pattern: &project.pattern,
            draft: &draft,
            count: 1,
            label: None,
        }];
        let layings = Arc::new(lay(&garments, &options, watcher)?);
        self.layings = Some(layings.clone());
        Ok(layings)
    }

    /// The meshed and placed pieces.
    pub fn garment(&mut self, project: &Project) -> Result<Arc<Garment>, SessionError> {
        if let Some(garment) = &self.garment {
            return Ok(garment.clone());
        }
        let draft = self.sound_draft(project)?;
        let mannequin = self.mannequin(project)?;
        let options = AssemblyOptions {
            edge_length: project.quality.edge_length(),
        };
        let assembled = assemble(&draft, &setup::wearer(&mannequin), &options)?;
        self.assembly_notes = assembled
            .diagnostics
            .iter()
            .map(ToString::to_string)
            .collect();
        let garment = Arc::new(assembled.garment);
        self.garment = Some(garment.clone());
        Ok(garment)
    }

    /// Whether the pieces are meshed and placed already.
    pub fn has_garment(&self) -> bool {
        self.garment.is_some()
    }

    /// The garment ready to be sewn and draped.
    pub fn job(&mut self, project: &Project) -> Result<GarmentJob, SessionError> {
        let garment = self.garment(project)?;
        let (draft, _) = self.drafted(project);
        let skin = self.kept_mannequin(project)?.skin.clone();
        Ok(setup::job(&draft, garment, skin, project.quality))
    }

    /// The drape.
    pub fn drape(
        &mut self,
        project: &Project,
        inputs: &[StampedInput],
        watcher: &mut dyn Watcher,
    ) -> Result<Arc<Drape>, SessionError> {
        if let Some(drape) = self.drape.as_ref().filter(|drape| drape.inputs == inputs) {
            return Ok(drape.clone());
        }
        let made = Arc::new(drape(self.job(project)?, inputs, watcher)?);
        self.drape = Some(made.clone());
        Ok(made)
    }
}

/// A body's error, with the file its measurements came from.
fn body_error(project: &Project, error: BodyError) -> SessionError {
    match &project.body {
        BodyChoice::Measured { path, .. } => SessionError::Format {
            path: path.clone(),
            error: FormatError::new("measurements", error.to_string(), "correct the file"),
        },
        _ => SessionError::Body(error),
    }
}
