//! Settings of the solver.

use super::air::AirStep;
use super::viscosity::Viscosity;
use crate::System;

/// The forces of motion beside drag per mass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Losses {
    /// Air on triangles and viscosity, as the system has them.
    #[default]
    OfSystem,
    /// None: on the way to an equilibrium they would only cost time.
    DragAlone,
}

impl Losses {
    /// The air in substeps of h (s), where it acts.
    pub(super) fn air(self, system: &System, h: f64) -> Option<AirStep> {
        match self {
            Self::OfSystem => AirStep::new(system, h),
            Self::DragAlone => None,
        }
    }

    /// The viscosity of a system, where it acts.
    pub(super) fn viscosity(self, system: &System) -> Option<Viscosity> {
        match self {
            Self::OfSystem => Viscosity::new(system),
            Self::DragAlone => None,
        }
    }
}

/// Settings of the solver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct XpbdSettings {
    /// Sweeps over all constraints in a substep. One sweep with many substeps is most efficient; one substep a step
    /// needs hundreds.
    pub iterations: u32,
    /// Largest speed of a vertex; faster ones are slowed down to it (m/s).
    pub speed_limit: f64,
    /// The forces of motion that act.
    pub losses: Losses,
}

impl Default for XpbdSettings {
    /// One sweep, 100 m/s, the air of the system.
    fn default() -> Self {
        Self {
            iterations: 1,
            speed_limit: 100.0,
            losses: Losses::default(),
        }
    }
}
