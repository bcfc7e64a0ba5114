//! Moves a point that formulas place; the caller chooses how the formulas change.

use super::impossible;
use super::lookup::{after, place};
use super::moving::{added, move_point};
use super::numbers::{numbers_of, put_number};
use crate::formula::Token;
use crate::{Edit, EditError, Entity, Evaluation, Number, PointId, Variable, VariableId};
use std::sync::Arc;
use toile_geometry::Vec2;

/// Most steps of the secant method for the value of a variable: one suffices for a linear formula.
const STEPS: usize = 12;
/// Tolerance of a number (m), (rad) or plain. It is well below the tolerance of a point, since several
/// numbers place a point.
const NUMBER_TOLERANCE: f64 = 1e-12;
/// Tolerance of the new position of a point (m).
const POINT_TOLERANCE: f64 = 1e-9;
/// Least slope of a number with respect to a variable: below it, the variable is not used to reach a value.
const MIN_SLOPE: f64 = 1e-6;

/// Change of a formula when the point that it places is moved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FormulaChange {
    /// The formula stays; an adjustment is added to it, which counts in all sizes.
    #[default]
    Adjust,
    /// The formula stays; a variable that it names gets another value.
    Variable,
    /// The number gets a value of its own for the current size; the formula, or plain value, stays for all
    /// other sizes.
    ThisSize,
    /// A value replaces the formula in all sizes.
    Detach,
}

impl FormulaChange {
    /// The next choice; after the last comes the first.
    pub fn next(self) -> Self {
        match self {
            Self::Adjust => Self::Variable,
            Self::Variable => Self::ThisSize,
            Self::ThisSize => Self::Detach,
            Self::Detach => Self::Adjust,
        }
    }
}

/// Plans to move a point to `to` (m) as drawn now; the formulas that place the point change as `change` says.
/// See [`move_point`].
///
/// # Errors
/// Any error of [`move_point`]; there is no current size, or no variable of the formula changes the number.
pub fn move_point_by(
    evaluation: &Evaluation,
    point: PointId,
    to: Vec2,
    change: FormulaChange,
) -> Result<Vec<Edit>, EditError> {
    let edits = move_point(evaluation, point, to)?;
    let (Some(Edit::Put(mut moved)), true) =
        (edits.first().cloned(), change != FormulaChange::Adjust)
    else {
        return Ok(edits);
    };
    // A point that is bound to a line may be unable to reach `to` exactly.
    let goal = place(&after(evaluation, &edits)?, point)?;
    let mut variables: Vec<(VariableId, Edit)> = Vec::new();
    // The pattern with all variables changed so far: the next number may name them too.
    let mut work = evaluation.clone();
    for entry in numbers_of(evaluation, point.into()) {
        let want = entry.want;
        let moved_entries = moved.number_entries(Some(point.into()));
        let moved_entry = moved_entries
            .into_iter()
            .find(|moved| moved.place == entry.place);
        let (Some(old), Some(new)) = (entry.number, moved_entry.and_then(|moved| moved.number))
        else {
            continue;
        };
        if new == old {
            continue;
        }
        let value = evaluation.number(&new, want).ok_or_else(|| {
            impossible(
                "a number of the point has no value",
                "mend its formula first",
            )
        })?;
        let new = match change {
            FormulaChange::Adjust | FormulaChange::Detach => Number::Value(value),
            FormulaChange::ThisSize => in_this_size(evaluation, old, value)?,
            // A plain value names no variable, so the value itself is changed.
            FormulaChange::Variable if old.as_formula().is_none() => continue,
            FormulaChange::Variable => {
                let taken: Vec<VariableId> = variables.iter().map(|found| found.0).collect();
                let reach = |work: &Evaluation| work.number(&old, want);
                let found = solve(&work, (&old, &taken), &reach, value)?;
                work = after(&work, std::slice::from_ref(&found.1))?;
                variables.push(found);
                old
            }
        };
        put_number(&mut moved, &entry.place, &new);
    }
    let variables = variables.into_iter().map(|found| found.1);
    let edits: Vec<Edit> = variables.chain([Edit::Put(moved)]).collect();
    let at = place(&after(evaluation, &edits)?, point)?;
    match (at - goal).norm() <= POINT_TOLERANCE {
        true => Ok(edits),
        false => Err(cannot()),
    }
}

/// The number with another value in the current size.
fn in_this_size(evaluation: &Evaluation, old: Number, value: f64) -> Result<Number, EditError> {
    let size = evaluation.size().ok_or_else(|| {
        impossible(
            "the pattern has no size to change alone",
            "add sizes, or press = for another choice",
        )
    })?;
    let (usual, mut sizes) = match old {
        Number::PerSize { usual, sizes } => (usual, sizes),
        other @ (Number::Value(_) | Number::Formula(_) | Number::Adjusted { .. }) => {
            (Box::new(other), Vec::new())
        }
    };
    sizes.retain(|own| own.0 != size);
    sizes.push((size, value));
    Ok(Number::PerSize { usual, sizes })
}

/// Finds, by the secant method, a variable of a number and a value for it with which the number reaches its
/// target; returns also the edit that sets it. Variables in `taken` are not changed.
fn solve(
    evaluation: &Evaluation,
    (number, taken): (&Number, &[VariableId]),
    reach: &dyn Fn(&Evaluation) -> Option<f64>,
    target: f64,
) -> Result<(VariableId, Edit), EditError> {
    let pattern = evaluation.pattern();
    let tokens = number
        .as_formula()
        .map_or(&[][..], |formula| formula.tokens());
    for token in tokens {
        let Token::Variable(id) = token else { continue };
        let variable = pattern.variables.iter().find(|known| known.id == *id);
        let (Some(variable), false) = (variable, taken.contains(id)) else {
            continue;
        };
        let put = |by: f64| {
            Edit::Put(Entity::Variable(Arc::new(Variable {
                number: added(&variable.number, by),
                ..(**variable).clone()
            })))
        };
        let value = |by: f64| {
            let work = after(evaluation, &[put(by)]).ok()?;
            reach(&work).map(|value| value - target)
        };
        let scale = evaluation.variable(*id).map_or(0.0, |found| found.0.abs());
        let (mut last, mut by) = (0.0, (1e-3 * scale).max(1e-3));
        let (Some(mut last_miss), Some(mut miss)) = (value(last), value(by)) else {
            continue;
        };
        for _ in 0..STEPS {
            let slope = (miss - last_miss) / (by - last);
            if slope.is_nan() || slope.abs() <= MIN_SLOPE {
                break;
            }
            (last, last_miss) = (by, miss);
            by -= miss / slope;
            match value(by) {
                Some(next) => miss = next,
                None => break,
            }
            if miss.abs() <= NUMBER_TOLERANCE {
                return Ok((*id, put(by)));
            }
        }
    }
    Err(cannot())
}

fn cannot() -> EditError {
    impossible(
        "no variable of the formula moves the point there",
        "press = for another choice, or change the formula",
    )
}
