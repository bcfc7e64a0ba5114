//! The flat shape of least energy: L-BFGS (Nocedal 1980) with the cotangent matrix as first inverse, triangles never
//! flipped, the grain kept upright.

use crate::conformal::flipped;
use crate::cotangent::Cotangent;
use crate::{FlattenError, Grain, RestEnergy};
use std::collections::VecDeque;
use toile_geometry::Vec2;

/// Most steps of one descent.
pub const MAX_STEPS: usize = 2000;

/// Pairs of steps and changes of the gradient that are remembered.
const MEMORY: usize = 20;

/// Most halvings of one step.
const MAX_HALVINGS: usize = 40;

/// Decrease of the energy that is asked of a step, as a share of what its slope promises (Armijo).
const DECREASE: f64 = 1e-4;

/// What is left to gain when the descent ends, as a share of the energy.
const TOLERANCE: f64 = 1e-9;

/// The same as a share of stiffness times area, for surfaces that take no energy.
const FLOOR: f64 = 1e-20;

/// The end of a descent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Minimum {
    /// Energy (J).
    pub energy: f64,
    /// Steps taken.
    pub steps: usize,
    /// Whether so little is left to gain that the descent ended by itself.
    pub is_converged: bool,
}

/// Moves a flat shape without flipped triangles to the least energy, the grain upright (m).
///
/// # Errors
/// A triangle of the start is flipped, or the triangles are too thin.
pub fn minimise(
    energy: &RestEnergy,
    grain: &Grain,
    flat: &mut [Vec2],
    most_steps: usize,
) -> Result<Minimum, FlattenError> {
    if flipped(energy.region(), flat) > 0 {
        return Err(FlattenError::NoStart);
    }
    grain.set_upright(flat);
    let mut inverse = FirstInverse::new(energy, grain)?;
    let count = flat.len();
    let [c11, c22, ..] = energy.law().stiffness;
    let floor = FLOOR * (c11 + c22) * energy.region().area();
    let mut gradient = vec![Vec2::zeros(); count];
    let mut value = energy
        .gradient(flat, &mut gradient)
        .ok_or(FlattenError::NoStart)?;
    let mut pairs: VecDeque<Pair> = VecDeque::new();
    let (mut direction, mut trial, mut next) = (
        vec![Vec2::zeros(); count],
        flat.to_vec(),
        vec![Vec2::zeros(); count],
    );
    for step in 0..most_steps {
        two_loops(&pairs, &mut inverse, &gradient, &mut direction);
        let mut slope = dot(&gradient, &direction);
        // A slope that is no number is no way down, either.
        let falls = |slope: f64| slope < 0.0;
        if !falls(slope) && !pairs.is_empty() {
            pairs.clear();
            two_loops(&pairs, &mut inverse, &gradient, &mut direction);
            slope = dot(&gradient, &direction);
        }
        if !falls(slope) || -slope <= TOLERANCE * value + floor {
            return Ok(Minimum {
                energy: value,
                steps: step,
                is_converged: true,
            });
        }
        let mut share = largest_share(energy, flat, &direction).min(1.0);
        let mut halvings = 0;
        let found = loop {
            for ((to, from), way) in trial.iter_mut().zip(flat.iter()).zip(&direction) {
                *to = from + way * share;
            }
            match energy.gradient(&trial, &mut next) {
                Some(found) if found <= value + DECREASE * share * slope => break Some(found),
                Some(_) | None if halvings < MAX_HALVINGS => {
                    share *= 0.5;
                    halvings += 1;
                }
                Some(_) | None => break None,
            }
        };
        let Some(found) = found else {
            if pairs.is_empty() {
                // Nothing lower within rounding.
                return Ok(Minimum {
                    energy: value,
                    steps: step,
                    is_converged: -slope <= 1e3 * TOLERANCE * value + floor,
                });
            }
            pairs.clear();
            continue;
        };
        let pair = Pair::new(
            trial.iter().zip(flat.iter()).map(|(a, b)| a - b).collect(),
            next.iter().zip(&gradient).map(|(a, b)| a - b).collect(),
        );
        if let Some(pair) = pair {
            if pairs.len() == MEMORY {
                pairs.pop_front();
            }
            inverse.scale(&pair);
            pairs.push_back(pair);
        }
        flat.copy_from_slice(&trial);
        std::mem::swap(&mut gradient, &mut next);
        value = found;
    }
    Ok(Minimum {
        energy: value,
        steps: most_steps,
        is_converged: false,
    })
}

/// A step and the change of the gradient over it.
struct Pair {
    step: Vec<Vec2>,
    change: Vec<Vec2>,
    product: f64,
}

impl Pair {
    /// None where the energy bends down along the step.
    fn new(step: Vec<Vec2>, change: Vec<Vec2>) -> Option<Self> {
        let product = dot(&step, &change);
        let sizes = (dot(&step, &step) * dot(&change, &change)).sqrt();
        (product > 1e-10 * sizes).then_some(Self {
            step,
            change,
            product,
        })
    }
}

/// The inverse of the cotangent matrix among steps that keep the grain upright.
struct FirstInverse {
    matrix: Cotangent,
    weights: Vec<f64>,
    /// The inverse times the weights of the grain, in x.
    turned: Vec<f64>,
    length: f64,
    scale: f64,
    scratch: Vec<Vec2>,
}

impl FirstInverse {
    fn new(energy: &RestEnergy, grain: &Grain) -> Result<Self, FlattenError> {
        let mut matrix = Cotangent::new(energy.region())?;
        let weights = grain.weights().to_vec();
        let right: Vec<Vec2> = weights.iter().map(|&w| Vec2::new(w, 0.0)).collect();
        let mut scratch = vec![Vec2::zeros(); right.len()];
        matrix.solve(&right, &mut scratch);
        let turned: Vec<f64> = scratch.iter().map(|p| p.x).collect();
        let length = turned.iter().zip(&weights).map(|(a, b)| a * b).sum();
        let [c11, c22, ..] = energy.law().stiffness;
        Ok(Self {
            matrix,
            weights,
            turned,
            length,
            scale: 2.0 / (c11 + c22),
            scratch,
        })
    }

    /// Applies the inverse in place.
    fn apply(&mut self, vector: &mut [Vec2]) {
        self.matrix.solve(vector, &mut self.scratch);
        let off: f64 = (self.scratch.iter().zip(&self.weights))
            .map(|(p, weight)| p.x * weight)
            .sum();
        let share = off / self.length;
        for ((to, from), turned) in vector.iter_mut().zip(&self.scratch).zip(&self.turned) {
            *to = Vec2::new(from.x - share * turned, from.y) * self.scale;
        }
    }

    /// Takes the size of the inverse from the last pair.
    fn scale(&mut self, pair: &Pair) {
        let mut change = pair.change.clone();
        self.scale = 1.0;
        self.apply(&mut change);
        let size = dot(&change, &pair.change);
        if size > 0.0 {
            self.scale = pair.product / size;
        }
    }
}

/// The direction of descent from the remembered pairs (Nocedal 1980, two loops).
fn two_loops(
    pairs: &VecDeque<Pair>,
    inverse: &mut FirstInverse,
    gradient: &[Vec2],
    direction: &mut [Vec2],
) {
    for (to, from) in direction.iter_mut().zip(gradient) {
        *to = -from;
    }
    let mut shares = Vec::with_capacity(pairs.len());
    for pair in pairs.iter().rev() {
        let share = dot(&pair.step, direction) / pair.product;
        add(direction, &pair.change, -share);
        shares.push(share);
    }
    inverse.apply(direction);
    for (pair, share) in pairs.iter().zip(shares.into_iter().rev()) {
        let back = dot(&pair.change, direction) / pair.product;
        add(direction, &pair.step, share - back);
    }
}

/// Nine tenths of the largest share of a step that flips no triangle.
fn largest_share(energy: &RestEnergy, flat: &[Vec2], direction: &[Vec2]) -> f64 {
    let mut largest = f64::INFINITY;
    for triangle in &energy.region().mesh().triangles {
        let [a, b, c] = triangle.map(|v| v as usize);
        let (p, q) = (flat[b] - flat[a], flat[c] - flat[a]);
        let (u, v) = (direction[b] - direction[a], direction[c] - direction[a]);
        // The first positive root of area(t) = t^2 u x v + t (p x v + u x q) + p x q.
        let (square, line, constant) = (u.perp(&v), p.perp(&v) + u.perp(&q), p.perp(&q));
        let root = line * line - 4.0 * square * constant;
        if root < 0.0 {
            continue;
        }
        let twice = -line
            + if line > 0.0 {
                -root.sqrt()
            } else {
                root.sqrt()
            };
        for t in [twice / (2.0 * square), 2.0 * constant / twice] {
            if t > 0.0 && t < largest {
                largest = t;
            }
        }
    }
    0.9 * largest
}

fn dot(a: &[Vec2], b: &[Vec2]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}

fn add(to: &mut [Vec2], from: &[Vec2], factor: f64) {
    for (to, from) in to.iter_mut().zip(from) {
        *to += from * factor;
    }
}
