//! Patch Verlet: velocity Verlet for cloth of the plain laws, made fast.
//!
//! Every force acts in every substep: membrane, bending, elastics, gravity, drag, contact and
//! friction. A substep is
//!   x += h/2 v;   v = ((1 - c h/2) v + h f(x)/m) / (1 + c h/2);   x += h/2 v
//! (position Verlet with drag c by the trapezoidal rule; Swope, Andersen, Berens and Wilson 1982;
//! Tuckerman, Berne and Martyna 1992, section II). Order 2, symplectic without drag and friction,
//! momentum exact, stable while h w < 2 for the fastest vibration w.
//!
//! Without given substeps it takes h = 0.95 * 2 / w, where w is the frequency at rest raised by the largest
//! stretch of any triangle; when the stretch grows beyond the stability limit of the substeps taken, they are
//! undone and repeated with more.
//!
//! It is fast because the cloth is cut into patches with halos, each advanced by one task for several
//! substeps; vertices and edges are computed eight at a time, in an order in which most of their neighbours
//! have consecutive indices; the membrane is evaluated as tensions of edges; and contact planes are detected
//! every half to whole millisecond only. A frame costs vertices x substeps, the substeps growing as 1 / edge:
//! for light, soft cloth that is less than any implicit step costs, and without numerical damping.
//!
//! Bending in longer steps than the membrane's (impulses, Tuckerman et al.) was measured and left out: the
//! membrane rings between impulses, and the net force on a hung cloth stays at 4e-2 of its weight with two
//! substeps to an impulse, at 0.6 with four.
//!
//! A model with a feature that patches do not support (stretch that hardens or has a limit, viscosity,
//! persistent folds, moving air, contact samples inside triangles) is advanced by velocity Verlet.

mod edges;
mod lane;
mod limits;
mod membrane;
mod octets;
mod patch;
mod patch_contacts;
mod rows;
mod sheet;
mod stretch;
mod tensions;

use lane::Lane;
use limits::stiffening;
use sheet::Sheet;
use toile_drape::methods::{energy_bound, is_possible_speed};
use toile_drape::{ContactSample, DrapeError, State, System};
use toile_drape::{Method, MethodSettings, StepReport};

/// Patch Verlet with its private memory.
pub struct PatchVerlet {
    substeps: Option<u32>,
    sheet: Option<Sheet>,
    fallback: Box<dyn Method>,
}

const STAGE: &str = "patch Verlet";

/// Fraction of the stability limit 2/w that automatic substeps use; the margin covers the growth of the stretch
/// between two checks.
const STABILITY_FRACTION: f64 = 0.95;

/// Fraction of the stability limit above which substeps are undone.
const MAX_STABILITY_FRACTION: f64 = 0.99;

/// Most attempts at an interval, each with more substeps.
const MAX_ATTEMPTS: usize = 8;

/// Longest time between two checks of the stretch (s): cloth of 0.2 m pulled at 3 m/s stretches by 0.03
/// meanwhile.
const STRETCH_CHECK_STEP: f64 = 2e-3;

/// Most substeps of one step: only a mesh with sliver triangles asks for more, and that is an error.
const MAX_SUBSTEPS: f64 = 1e6;

impl PatchVerlet {
    /// With the settings' substeps, or automatic ones where not given; `fallback` advances the models that patches
    /// do not support.
    pub fn new(settings: &MethodSettings, fallback: Box<dyn Method>) -> Self {
        Self {
            substeps: settings.substeps,
            sheet: None,
            fallback,
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
            // Within the thread pool: entering it once spares waking its threads for every run of substeps.
            rayon::scope(|_| self.advance_patches(system, state, step))
        } else {
            self.fallback.advance(system, state, step)
        }
    }
}

/// Advances by a step in as many substeps as stability needs at the present stretch, which is checked every
/// interval; returns the number of substeps taken, the undone ones included.
fn take_automatic(sheet: &mut Sheet, system: &System, step: f64) -> Result<usize, DrapeError> {
    let longest = 2.0 / sheet.frequency;
    let too_stiff = |substeps: f64| DrapeError::TooStiff {
        stage: STAGE,
        vertex: limits::stiffest(system).1,
        substeps,
    };
    let fewest = step / (STABILITY_FRACTION * longest);
    if fewest.is_nan() || fewest > MAX_SUBSTEPS {
        return Err(too_stiff(fewest));
    }
    let intervals = (step / STRETCH_CHECK_STEP).ceil().max(1.0);
    let length = step / intervals;
    let mut taken = 0;
    let mut stretch = sheet.stretch()[0];
    for _ in 0..intervals as usize {
        sheet.save();
        for attempt in 1..=MAX_ATTEMPTS {
            let needed = length * stiffening(stretch) / (STABILITY_FRACTION * longest);
            let count = needed.ceil().max(1.0);
            if needed.is_nan() || count > MAX_SUBSTEPS {
                let (vertex, speed) = sheet.fastest();
                return Err(blown_up(vertex, speed, length / count));
            }
            let h = length / count;
            sheet.advance(system, h, count as usize);
            taken += count as usize;
            let reached = sheet.stretch()[0];
            let is_stable = h * stiffening(reached) <= MAX_STABILITY_FRACTION * longest;
            // The stretch reached by an unstable run is not that of the motion: its use is bounded.
            stretch = match is_stable {
                true => reached,
                false => reached.min(3.0 * stretch).max(1.5 * stretch),
            };
            if is_stable {
                break;
            }
            if attempt == MAX_ATTEMPTS {
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

/// Whether a model has only features that patches support.
fn is_plain(system: &System, samples: &[ContactSample]) -> bool {
    system.materials.laws.iter().all(|law| law.is_linear())
        && !system.materials.have_viscous_stretch()
        && system.rest.viscous_bending.is_none()
        && system.rest.stencils.is_empty()
        && !system.materials.keep_strain()
        && !system.control.air.acts()
        && samples.iter().all(|sample| sample.triangle.is_none())
}
