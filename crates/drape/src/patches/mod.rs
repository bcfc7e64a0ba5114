//! Patch Verlet: velocity Verlet for cloth of the plain laws, made fast.
//!
//! Every force acts in every substep: membrane, bending, elastics, gravity, drag, contact and
//! friction. A substep is
//!   x += h/2 v;   v = ((1 - c h/2) v + h f(x)/m) / (1 + c h/2);   x += h/2 v
//! (position Verlet with drag c by the trapezoidal rule; Swope, Andersen, Berens and Wilson 1982;
//! Tuckerman, Berne and Martyna 1992, section II). Order 2, symplectic without drag and friction,
//! momentum exact, stable while h w < 2 for the fastest vibration w.
//!
//! Left to itself it takes h = 0.95 * 2 / w with w that at rest, raised by the largest stretch of
//! any triangle; a stretch that grew beyond what the substeps allow undoes them and takes more.
//!
//! It is fast because the cloth is cut into patches with halos, each moved by one task for several
//! substeps; vertices and edges are worked on eight at a time, in an order in which their neighbours
//! lie side by side; the membrane is evaluated as tensions of edges; and contact planes are measured
//! every half to whole millisecond only. A frame costs vertices x substeps, the substeps growing as 1 / edge:
//! for light, soft cloth that is less than any implicit step, and without its damping.
//!
//! Bending in longer steps than the membrane's (impulses, Tuckerman et al.) was measured and left
//! out: with two substeps to an impulse the rest of a hung cloth is 4e-2 of its weight off balance,
//! with four 0.6, for the membrane rings between impulses.
//!
//! Where a model has what this does not treat (stretch that hardens or has a limit, viscosity,
//! kept folds, moving air, contact inside triangles), the step is velocity Verlet's.

mod edges;
mod lane;
mod limits;
mod membrane;
mod octets;
mod patch;
mod rows;
mod sheet;
mod stretch;
mod tensions;
mod touch;

use crate::method::{Method, MethodSettings, StepReport};
use crate::methods::{energy_bound, is_possible_speed};
use crate::{ContactSample, DrapeError, State, System};
use lane::Lane;
use limits::stiffening;
use sheet::Sheet;

/// Patch Verlet with its memory.
pub struct PatchVerlet {
    substeps: Option<u32>,
    sheet: Option<Sheet>,
    general: Box<dyn Method>,
}

const STAGE: &str = "patch Verlet";

/// Share of the stability limit 2/w that automatic substeps use; what is left pays for stretch
/// that grows between two looks at it.
const SHARE: f64 = 0.95;

/// Share of the limit beyond which substeps are undone.
const MOST_SHARE: f64 = 0.99;

/// Times a stretch of time is begun anew with more substeps.
const TRIES: usize = 8;

/// Longest time between two looks at the stretch [s]: cloth that is drawn at 3 m/s over 0.2 m
/// gains 0.03 of stretch.
const LOOK_STEP: f64 = 2e-3;

/// Substeps of one step at the most: more is a mesh with slivers, not a simulation.
const MOST_SUBSTEPS: f64 = 1e6;

impl PatchVerlet {
    /// With the settings' substeps, or those the cloth asks for when not given; `general` is what
    /// stands in for models that are not plain.
    pub fn new(settings: &MethodSettings, general: Box<dyn Method>) -> Self {
        Self {
            substeps: settings.substeps,
            sheet: None,
            general,
        }
    }

    fn advance_patches(
        &mut self,
        system: &System,
        state: &mut State,
        step: f64,
    ) -> Result<StepReport, DrapeError> {
        let mut sheet = match self.sheet.take().filter(|sheet| sheet.fits(system)) {
            Some(sheet) => sheet,
            None => Sheet::new(system),
        };
        state.follow_samples();
        sheet.start(system, state);
        let before = sheet.energy();
        let taken = match self.substeps {
            Some(given) => {
                let count = given.max(1) as usize;
                sheet.advance(system, step / count as f64, count);
                Ok(count)
            }
            None => take_automatic(&mut sheet, system, step),
        };
        let bound = energy_bound(system, before, step);
        let result = taken.and_then(|taken| {
            let (vertex, speed) = sheet.fastest();
            let energy = sheet.energy();
            if is_possible_speed(speed) && energy <= bound {
                sheet.finish(state);
                state.time += step;
                return Ok(StepReport {
                    pieces: 1,
                    iterations: taken,
                    linear_iterations: 0,
                });
            }
            Err(blown_up(vertex, speed, step / taken as f64))
        });
        self.sheet = Some(sheet);
        result
    }
}

impl Method for PatchVerlet {
    fn advance(
        &mut self,
        system: &System,
        state: &mut State,
        step: f64,
    ) -> Result<StepReport, DrapeError> {
        if is_plain(system, &state.samples) {
            // Inside the pool, so that its threads need not be called again for every substep.
            rayon::scope(|_| self.advance_patches(system, state, step))
        } else {
            self.general.advance(system, state, step)
        }
    }
}

/// Takes a step in as many substeps as the stretch asks for, looked at again and again.
fn take_automatic(sheet: &mut Sheet, system: &System, step: f64) -> Result<usize, DrapeError> {
    let longest = 2.0 / sheet.frequency;
    let too_stiff = |substeps: f64| DrapeError::TooStiff {
        stage: STAGE,
        vertex: limits::stiffest(system).1,
        substeps,
    };
    let least = step / (SHARE * longest);
    if least.is_nan() || least > MOST_SUBSTEPS {
        return Err(too_stiff(least));
    }
    let parts = (step / LOOK_STEP).ceil().max(1.0);
    let length = step / parts;
    let mut taken = 0;
    let mut stretch = sheet.stretch()[0];
    for _ in 0..parts as usize {
        sheet.save();
        for attempt in 1..=TRIES {
            let wanted = length * stiffening(stretch) / (SHARE * longest);
            let count = wanted.ceil().max(1.0);
            if wanted.is_nan() || count > MOST_SUBSTEPS {
                let (vertex, speed) = sheet.fastest();
                return Err(blown_up(vertex, speed, length / count));
            }
            let h = length / count;
            sheet.advance(system, h, count as usize);
            taken += count as usize;
            let reached = sheet.stretch()[0];
            let sound = h * stiffening(reached) <= MOST_SHARE * longest;
            // What broke away tells how far it went, not how far it would have gone.
            stretch = match sound {
                true => reached,
                false => reached.min(3.0 * stretch).max(1.5 * stretch),
            };
            if sound {
                break;
            }
            if attempt == TRIES {
                let (vertex, speed) = sheet.fastest();
                return Err(blown_up(vertex, speed, h));
            }
            sheet.restore();
        }
    }
    Ok(taken)
}

fn blown_up(vertex: usize, speed: f64, substep: f64) -> DrapeError {
    if speed.is_finite() {
        DrapeError::BlownUp {
            stage: STAGE,
            vertex,
            speed,
            substep,
        }
    } else {
        DrapeError::NotFinite {
            stage: STAGE,
            vertex,
        }
    }
}

/// Whether nothing acts but what patches treat.
fn is_plain(system: &System, samples: &[ContactSample]) -> bool {
    system.materials.laws.iter().all(|law| law.is_linear())
        && !system.materials.have_viscous_stretch()
        && system.rest.viscous_bending.is_none()
        && system.rest.stencils.is_empty()
        && !system.materials.keep_strain()
        && !system.control.air.acts()
        && samples.iter().all(|sample| sample.triangle.is_none())
}
