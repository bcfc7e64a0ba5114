//! XPBD as a method in time.

use super::{ClothContacts, Substeps, Xpbd, XpbdSettings};
use crate::collision::Tally;
use crate::method::{Method, MethodSettings, StepReport};
use crate::{DrapeError, State, System};

/// XPBD as a method in time.
pub(crate) struct XpbdMethod {
    settings: XpbdSettings,
    substeps: u32,
    solver: Option<Xpbd>,
    cloth: ClothContacts,
}

/// Substeps of a step where the settings give none.
const SUBSTEPS: u32 = 20;

impl XpbdMethod {
    /// From settings: substeps and iterations.
    pub(crate) fn new(settings: &MethodSettings) -> Self {
        let default = XpbdSettings::default();
        let iterations = settings.iterations.map(|n| n.clamp(1, 1_000_000) as u32);
        Self {
            settings: XpbdSettings {
                iterations: iterations.unwrap_or(default.iterations),
                ..default
            },
            substeps: settings.substeps.unwrap_or(SUBSTEPS).max(1),
            solver: None,
            cloth: ClothContacts::default(),
        }
    }
}

impl Method for XpbdMethod {
    fn follows_frames(&self) -> bool {
        true
    }

    fn most_iterations(&self) -> Option<usize> {
        Some(self.settings.iterations as usize)
    }

    fn cloth_tally(&self) -> Option<Tally> {
        Some(self.cloth.contacts.tally)
    }

    fn advance(
        &mut self,
        system: &System,
        state: &mut State,
        step: f64,
    ) -> Result<StepReport, DrapeError> {
        let settings = self.settings;
        let solver = (self.solver).get_or_insert_with(|| Xpbd::with_settings(system, settings));
        let substep = step / f64::from(self.substeps);
        let substeps = Substeps {
            substep,
            count: self.substeps,
            drag: system.control.air_drag,
        };
        // A step must depend on the state alone, not on contacts detected before it.
        self.cloth.invalidate();
        let report =
            solver.advance_with_cloth_contact(system, state, &mut self.cloth, &substeps)?;
        let iterations = self.substeps * self.settings.iterations * report.pieces;
        Ok(StepReport {
            pieces: report.pieces,
            iterations: iterations as usize,
            linear_iterations: 0,
        })
    }
}
