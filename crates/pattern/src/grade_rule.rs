//! Grade rules: the shift of a point by size, kept as two variables, and the points that they move.
//!
//! Rule 7 is the variables `grade_7_x` and `grade_7_y`, each a length that is 0 in the base size and has a
//! value of its own in other sizes. A graded point lies at coordinates that are the rule's variables, adjusted
//! by its place in the base size. The document needs nothing else: a drag of the point changes the adjustment,
//! and so moves it alike in all sizes; a changed variable moves all points of the rule.

use crate::formula::Formula;
use crate::{Number, Pattern, PointRule, SizeId, Variable, VariableId};
use toile_geometry::Vec2;

/// Shifts that differ by less are one (m).
const SAME: f64 = 1e-9;
/// Largest number of a grade rule.
pub const MAX_GRADE_RULE: u32 = 999_999;

/// A grade rule of a pattern.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GradeRule {
    /// Its number, from 1.
    pub number: u32,
    /// The variables with its shifts to the right and upwards.
    pub variables: [VariableId; 2],
}

/// The rule of a point, and how it is turned there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Graded {
    /// The rule.
    pub rule: GradeRule,
    /// Whether the shifts to the right and upwards have their signs turned.
    pub is_turned: [bool; 2],
    /// Place of the point without its shift (m).
    pub by: Vec2,
}

/// The number of the rule whose variable along an axis, `_x` or `_y`, has a name. Numbers with leading zeros or a sign
/// name no rule.
fn number_of(name: &str, axis: &str) -> Option<u32> {
    let digits = name.strip_prefix("grade_")?.strip_suffix(axis)?;
    let number: u32 = digits.parse().ok()?;
    ((1..=MAX_GRADE_RULE).contains(&number) && number.to_string() == digits).then_some(number)
}

impl GradeRule {
    /// The names of a rule's variables.
    pub fn names(number: u32) -> [String; 2] {
        ["x", "y"].map(|axis| format!("grade_{number}_{axis}"))
    }

    /// The rule of a number.
    pub fn of_number(pattern: &Pattern, number: u32) -> Option<Self> {
        let [x, y] = Self::names(number);
        let variables = [
            pattern.variable_named(&x)?.id,
            pattern.variable_named(&y)?.id,
        ];
        Some(Self { number, variables })
    }

    /// The rules of a pattern, in the order of their numbers.
    pub fn all(pattern: &Pattern) -> Vec<Self> {
        let numbered = |axis: &str| -> std::collections::BTreeMap<u32, VariableId> {
            let all = pattern.variables.iter();
            let own =
                all.filter_map(|variable| Some((number_of(&variable.name, axis)?, variable.id)));
            own.collect()
        };
        let upwards = numbered("_y");
        let both = numbered("_x").into_iter().filter_map(|(number, x)| {
            let variables = [x, *upwards.get(&number)?];
            Some(Self { number, variables })
        });
        both.collect()
    }

    /// Numbers that no rule has: those above all rules, then those between.
    pub fn free_numbers(pattern: &Pattern) -> impl Iterator<Item = u32> {
        let is_free = |number: &u32| {
            let names = Self::names(*number);
            let mut names = names.iter();
            names.all(|name| pattern.variable_named(name).is_none())
        };
        let last = Self::all(pattern).last().map_or(0, |rule| rule.number);
        (last + 1..=MAX_GRADE_RULE).chain(1..last).filter(is_free)
    }

    /// A new rule and its variables, with their ids. Sizes without a shift stand for no shift.
    pub fn made(
        variables: [VariableId; 2],
        number: u32,
        shifts: &[(SizeId, Vec2)],
    ) -> (Self, [Variable; 2]) {
        let mut names = Self::names(number).into_iter();
        let both = [0, 1].map(|axis| {
            let own = shifts.iter().map(|(size, shift)| (*size, shift[axis]));
            Variable {
                id: variables[axis],
                name: names.next().unwrap_or_default(),
                number: shift_number(own),
            }
        });
        (Self { number, variables }, both)
    }

    /// The rule of a point whose place in the base size is given (m).
    pub fn point(&self, is_turned: [bool; 2], by: Vec2) -> PointRule {
        let [x, y] = [0, 1].map(|axis| {
            let formula = Formula::of_variable(self.variables[axis], is_turned[axis]);
            match by[axis] {
                0.0 => Number::Formula(formula),
                by => Number::Adjusted { formula, by },
            }
        });
        PointRule::At { x, y }
    }

    /// The rule that a point has. `None`: it has none.
    pub fn of_point(pattern: &Pattern, point: &PointRule) -> Option<Graded> {
        let PointRule::At { x, y } = point else {
            return None;
        };
        let [x, y] = [variable_of(x)?, variable_of(y)?];
        let number = |id: VariableId, axis: &str| -> Option<u32> {
            let variable = pattern.variables.iter().find(|known| known.id == id)?;
            number_of(&variable.name, axis)
        };
        let own = number(x.0, "_x")?;
        (number(y.0, "_y")? == own).then_some(Graded {
            rule: Self {
                number: own,
                variables: [x.0, y.0],
            },
            is_turned: [x.1, y.1],
            by: Vec2::new(x.2, y.2),
        })
    }
}

/// The variable in a number, whether its sign is turned, and what is added to it (m).
fn variable_of(number: &Number) -> Option<(VariableId, bool, f64)> {
    let (formula, by) = match number {
        Number::Formula(formula) => (formula, 0.0),
        Number::Adjusted { formula, by } => (formula, *by),
        Number::Value(_) | Number::PerSize { .. } => return None,
    };
    let (id, is_turned) = formula.as_variable()?;
    Some((id, is_turned, by))
}

/// A length of no extent with values of its own in sizes (m).
fn shift_number(shifts: impl Iterator<Item = (SizeId, f64)>) -> Number {
    let sizes: Vec<(SizeId, f64)> = shifts.filter(|(_, by)| by.abs() > SAME).collect();
    let usual = no_length();
    match sizes.is_empty() {
        true => usual,
        false => Number::PerSize {
            usual: Box::new(usual),
            sizes,
        },
    }
}

/// A length of 0 as a formula: a variable that is a value would be a plain number.
fn no_length() -> Number {
    Formula::of_measurements("0cm").map_or(Number::ZERO, Number::Formula)
}
