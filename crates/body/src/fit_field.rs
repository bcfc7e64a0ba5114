//! Primitives of one part fitted to samples of its surface by damped least squares (Levenberg
//! 1944, Marquardt 1963) with derivatives in closed form.

use crate::fit_girths::GirthResidual;
use crate::fit_samples::{DensityTarget, Sample};
use crate::fit_surface::{Row, Surface, UNKNOWNS};
use crate::{Part, Primitive, THRESHOLD};
use nalgebra::{Cholesky, DMatrix, DVector, Rotation3};
use toile_geometry::Vec3;

/// Largest number of steps tried.
const STEPS: usize = 150;
/// Residual, as a share of stature, above which samples count less (Huber 1964).
const FAR: f64 = 0.004;
/// Least difference between the density and the threshold at samples inside, and at samples outside the
/// surface (1).
const ROOM: [f64; 2] = [0.05, 0.03];
/// Limits of the weight of a primitive (1).
const WEIGHT: [f64; 2] = [0.3, 3.0];

/// Samples and tapes that a part is fitted to.
pub(crate) struct Goal<'a> {
    pub(crate) samples: &'a [Sample],
    pub(crate) girths: &'a [GirthResidual],
    /// Stature (m).
    pub(crate) height: f64,
}

/// Normal equations of a sum of squares, with the sum.
struct System {
    normal: DMatrix<f64>,
    right: DVector<f64>,
    sum: f64,
}

/// Fits the primitives of one part of the left side and the median plane, in place.
pub(crate) fn fit(primitives: &mut [Primitive], goal: &Goal) {
    if primitives.is_empty() || goal.samples.is_empty() {
        return;
    }
    let start = primitives.to_vec();
    let mut damping = 1e-2;
    let mut system = assembled(primitives, &start, goal);
    for _ in 0..STEPS {
        let mut damped = system.normal.clone();
        for k in 0..damped.nrows() {
            damped[(k, k)] += damping * system.normal[(k, k)].max(1e-12);
        }
        let Some(factor) = Cholesky::new(damped) else {
            damping *= 10.0;
            continue;
        };
        let step = factor.solve(&system.right);
        let mut tried = primitives.to_vec();
        for (primitive, own) in tried.iter_mut().zip(step.as_slice().chunks(UNKNOWNS)) {
            moved(primitive, own, goal.height);
        }
        let next = assembled(&tried, &start, goal);
        if next.sum < system.sum {
            let gain = 1.0 - next.sum / system.sum;
            primitives.copy_from_slice(&tried);
            system = next;
            damping = (damping * 0.3).max(1e-7);
            if gain < 3e-5 {
                break;
            }
        } else {
            damping *= 4.0;
            if damping > 1e6 {
                break;
            }
        }
    }
}

/// Changes a primitive by a step of its unknowns, limited to the range in which the linear model can be
/// trusted.
fn moved(primitive: &mut Primitive, step: &[f64], height: f64) {
    let central = primitive.is_central();
    let far = 0.02 * height;
    for k in 0..3 {
        if !(central && k == 0) {
            primitive.centre[k] += step[k].clamp(-far, far);
        }
        let grown = primitive.radii[k] * step[3 + k].clamp(-0.3, 0.3).exp();
        primitive.radii[k] = grown.clamp(0.008 * height, 0.35 * height);
    }
    let mut turn = Vec3::new(step[6], step[7], step[8]).map(|x| x.clamp(-0.3, 0.3));
    if central {
        turn.y = 0.0;
        turn.z = 0.0;
    }
    let rotation = (Rotation3::new(turn) * primitive.rotation()).scaled_axis();
    primitive.rotation = match central {
        true => [rotation.x, 0.0, 0.0],
        false => rotation.into(),
    };
    let weight = primitive.weight * step[9].clamp(-0.3, 0.3).exp();
    primitive.weight = weight.clamp(WEIGHT[0], WEIGHT[1]);
    // A primitive off the median plane stays off it: otherwise it and its mirror image could become one.
    if !central && matches!(primitive.part, Part::Trunk | Part::Head) {
        primitive.centre[0] = primitive.centre[0].max(0.004 * height);
    }
}

fn assembled(primitives: &[Primitive], start: &[Primitive], goal: &Goal) -> System {
    let height = goal.height;
    let surface = Surface::new(primitives);
    let size = UNKNOWNS * primitives.len();
    let mut system = System {
        normal: DMatrix::zeros(size, size),
        right: DVector::zeros(size),
        sum: 0.0,
    };
    let mut touched: Vec<Row> = Vec::new();
    // Least slope assumed where the field is flat (1/m).
    let least = 6.0 / height;
    for sample in goal.samples {
        let (value, gradient) = surface.at(sample.place, &mut touched);
        let miss = match sample.target {
            DensityTarget::Surface { .. } => value - THRESHOLD,
            DensityTarget::Within => (value - THRESHOLD - ROOM[0]).min(0.0),
            DensityTarget::Beyond => (value - THRESHOLD + ROOM[1]).max(0.0),
            DensityTarget::Far => (value - 0.4 * THRESHOLD).max(0.0),
            DensityTarget::Below => (value - THRESHOLD).max(0.0),
        };
        if miss == 0.0 {
            continue;
        }
        let steep = gradient.norm().max(least);
        let steep = match sample.target {
            DensityTarget::Surface { .. } => steep,
            _ => steep.max(2.5 * least),
        };
        system.add(&touched, miss / steep, steep, (sample.weight, FAR * height));
    }
    for girth in goal.girths {
        system.tape(&surface, girth);
    }
    system.hold(primitives, start, height);
    system
}

impl System {
    /// Adds a residual `miss` (m). Its derivatives are those of the density, in `touched`, divided by the
    /// slope `steep`. A residual larger than `far` counts less.
    fn add(&mut self, touched: &[Row], miss: f64, steep: f64, (weight, far): (f64, f64)) {
        let size = miss.abs();
        let (cost, factor) = match size <= far {
            true => (miss * miss, 1.0),
            false => (far * (2.0 * size - far), far / size),
        };
        self.sum += weight * cost;
        let weight = weight * factor;
        let over = 1.0 / steep;
        for (k, row) in touched {
            for (i, slope) in row.iter().enumerate() {
                let a = slope * over;
                self.right[UNKNOWNS * k + i] -= weight * a * miss;
                let wa = weight * a * over;
                for (l, other) in touched {
                    for (j, slope) in other.iter().enumerate() {
                        self.normal[(UNKNOWNS * l + j, UNKNOWNS * k + i)] += wa * slope;
                    }
                }
            }
        }
    }

    /// Adds the residual of a tape (m): the lengthening of the tape by the moves of the surface off its
    /// corners, minus the wanted lengthening.
    fn tape(&mut self, surface: &Surface, girth: &GirthResidual) {
        let mut touched = Vec::new();
        let mut rows = vec![None; surface.count()];
        let mut long = -girth.target;
        for &(place, turn) in &girth.corners {
            let (beyond, steep) = surface.beyond(place, &mut touched);
            long += turn * beyond;
            for (k, own) in &touched {
                let row = rows[*k].get_or_insert([0.0; UNKNOWNS]);
                for (sum, slope) in row.iter_mut().zip(own) {
                    *sum += turn * slope / steep;
                }
            }
        }
        let rows: Vec<Row> = rows
            .into_iter()
            .enumerate()
            .filter_map(|(k, row)| Some((k, row?)))
            .collect();
        self.add(&rows, long, 1.0, (girth.weight, f64::INFINITY));
    }

    /// Pulls the primitives weakly to their start, so that a primitive that no sample determines does not
    /// wander.
    fn hold(&mut self, primitives: &[Primitive], start: &[Primitive], height: f64) {
        // The area of a whole body times the square of a residual that matters little.
        let weak = 2e-10 * height.powi(4);
        for (k, (p, s)) in primitives.iter().zip(start).enumerate() {
            let mut pull = |i: usize, gap: f64, scale: f64| {
                let weight = weak / (scale * scale);
                self.sum += weight * gap * gap;
                self.right[UNKNOWNS * k + i] -= weight * gap;
                self.normal[(UNKNOWNS * k + i, UNKNOWNS * k + i)] += weight;
            };
            for i in 0..3 {
                pull(i, p.centre[i] - s.centre[i], 0.05 * height);
                pull(3 + i, (p.radii[i] / s.radii[i]).ln(), 0.5);
                pull(6 + i, 0.0, 1.0);
            }
            pull(9, (p.weight / s.weight).ln(), 0.5);
        }
    }
}
