//! Grade rules given to points, copied, mirrored, changed, read off sizes and taken away.
//!
//! # Decided with
//! - [`crate::grade_rule`]: rules as variables, and the points that they move;
//! - [`crate::plan`] (`moving.rs`, `added`): a drag moves a graded point alike in all sizes;
//! - [`crate::evaluate`] (`numbers.rs`): values that a size has of its own.
//!
//! In the window: its commands (`app/grading.rs`), the table of rules (`tables/grade_rules.rs`).

use super::align::Axis;
use super::lookup::{place, point};
use super::{impossible, number_at, set_number_in_size};
use crate::fields::NumberAddress;
use crate::{
    Edit, EditError, Entity, Evaluation, GradeRule, Graded, MAX_GRADE_RULE, Number, PartId,
    Pattern, Point, PointId, PointRule, Size, SizeId, Variable, VariableId, Want,
};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use toile_geometry::Vec2;

/// Shifts that differ by less are one (m).
const SAME: f64 = 1e-9;
/// Largest shift of a point between two sizes (m).
const MAX_SHIFT: f64 = 10.0;
/// Steps from one size to the next that differ by more are a jump (m).
const JUMP: f64 = 5e-4;

/// The shift of a rule in one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SizeShift {
    /// The size.
    pub size: SizeId,
    /// The shift to the right and upwards against the base size (m).
    pub by: Vec2,
    /// Whether the step from the size before to this one is another than the step before it.
    pub is_jump: bool,
}

/// The rule of a point. `None`: it has none, or is missing.
pub fn rule_of(pattern: &Pattern, id: PointId) -> Option<Graded> {
    GradeRule::of_point(pattern, &pattern.point(id)?.1.rule)
}

/// The points that a rule moves, in the order of sheets.
pub fn points_of_rule(pattern: &Pattern, rule: GradeRule) -> Vec<PointId> {
    let all = pattern.sheets.iter().flat_map(|sheet| &sheet.points);
    let own = all.filter(|point| {
        let found = GradeRule::of_point(pattern, &point.rule);
        found.is_some_and(|found| found.rule == rule)
    });
    own.map(|point| point.id).collect()
}

/// The shifts of a rule in all sizes, in the order of their table. Sizes in which it has no value are left out.
pub fn rule_shifts(evaluation: &Evaluation, rule: GradeRule) -> Vec<SizeShift> {
    let pattern = evaluation.pattern();
    let number = |id: VariableId| {
        let variable = pattern.variables.iter().find(|known| known.id == id);
        variable.map(|variable| &variable.number)
    };
    let [Some(x), Some(y)] = rule.variables.map(number) else {
        return Vec::new();
    };
    let value = |number: &Number, size: SizeId| match number {
        Number::PerSize { usual, sizes } => {
            let own = sizes.iter().find(|own| own.0 == size).map(|own| own.1);
            own.or_else(|| evaluation.number(usual, Want::Length))
        }
        Number::Value(_) | Number::Formula(_) | Number::Adjusted { .. } => {
            evaluation.number(number, Want::Length)
        }
    };
    let mut shifts: Vec<SizeShift> = Vec::new();
    for size in &pattern.sizes {
        let (Some(x), Some(y)) = (value(x, size.id), value(y, size.id)) else {
            continue;
        };
        shifts.push(SizeShift {
            size: size.id,
            by: Vec2::new(x, y),
            is_jump: false,
        });
    }
    let places: Vec<Vec2> = shifts.iter().map(|own| own.by).collect();
    for (own, is_jump) in shifts.iter_mut().zip(jumps(&places)) {
        own.is_jump = is_jump;
    }
    shifts
}

/// For the places of a point from size to size (m), whether the step to each is another than the step before it.
pub fn jumps(places: &[Vec2]) -> Vec<bool> {
    let step = |k: usize| places[k] - places[k - 1];
    let is_jump = |k: usize| k > 1 && (step(k) - step(k - 1)).norm() > JUMP;
    (0..places.len()).map(is_jump).collect()
}

/// Plans to give points a new rule; also returns its number. `shifts` are against the base size (m); sizes that
/// are left out keep the place of the base size.
///
/// # Errors
/// The pattern has no sizes; a size or a point is missing; a shift is not finite, too large, or of the base
/// size; a point grades by a construction or a formula of its own.
pub fn give_rule(
    evaluation: &Evaluation,
    points: &[PointId],
    shifts: &[(SizeId, Vec2)],
) -> Result<(Vec<Edit>, u32), EditError> {
    let pattern = evaluation.pattern();
    let base = base_of(pattern)?;
    for (size, by) in shifts {
        refuse_size(pattern, *size)?;
        refuse_shift(*by)?;
        if *size == base.id && by.norm() > SAME {
            return Err(impossible(
                format!("{:?} is the base size, which rules do not move", base.name),
                "drag the point, which moves it alike in all sizes",
            ));
        }
    }
    if points.is_empty() {
        return Err(no_points());
    }
    let number = GradeRule::free_numbers(pattern).next();
    let number = number.ok_or_else(no_number)?;
    let mut ids = pattern.ids;
    let (rule, variables) = GradeRule::made([ids.take(), ids.take()], number, shifts);
    let at_base = in_size(evaluation, base);
    let mut edits: Vec<Edit> = variables.into_iter().map(put_variable).collect();
    let put = put_rule(&at_base, points, (rule, [false; 2], Vec2::zeros()))?;
    edits.extend(put);
    let freed = points.iter().copied().collect();
    edits.extend(unused(pattern, &freed, None));
    Ok((edits, number))
}

/// Plans to give the rule of one point to others, turned as it is there.
///
/// # Errors
/// The first point has no rule; those of [`give_rule`] about points.
pub fn copy_rule(
    evaluation: &Evaluation,
    from: PointId,
    to: &[PointId],
) -> Result<Vec<Edit>, EditError> {
    let pattern = evaluation.pattern();
    let found = graded(pattern, from)?;
    let to: Vec<PointId> = to.iter().copied().filter(|&id| id != from).collect();
    if to.is_empty() {
        return Err(no_points());
    }
    let at_base = in_size(evaluation, base_of(pattern)?);
    let shift = shift_now(&at_base, found);
    let mut edits = put_rule(&at_base, &to, (found.rule, found.is_turned, shift))?;
    let freed = to.iter().copied().collect();
    edits.extend(unused(pattern, &freed, Some(found.rule)));
    Ok(edits)
}

/// Plans to turn the signs of the shifts along an axis at points: along `X` for the other side of an upright
/// mirror line, along `Y` for that of a level one.
///
/// # Errors
/// A point has no rule.
pub fn mirror_rule(
    evaluation: &Evaluation,
    points: &[PointId],
    axis: Axis,
) -> Result<Vec<Edit>, EditError> {
    let pattern = evaluation.pattern();
    let at_base = in_size(evaluation, base_of(pattern)?);
    if points.is_empty() {
        return Err(no_points());
    }
    let mut edits = Vec::new();
    for &id in points {
        let mut found = graded(pattern, id)?;
        let turned = match axis {
            Axis::X => &mut found.is_turned[0],
            Axis::Y => &mut found.is_turned[1],
        };
        *turned = !*turned;
        let shift = shift_now(&at_base, found);
        edits.extend(put_rule(
            &at_base,
            &[id],
            (found.rule, found.is_turned, shift),
        )?);
    }
    Ok(edits)
}

/// Plans to change the shift of a rule in one size (m), which moves all points of the rule.
///
/// # Errors
/// The rule or the size is missing; the shift is not finite or too large; the size is the base size.
pub fn set_rule_shift(
    evaluation: &Evaluation,
    number: u32,
    (size, by): (SizeId, Vec2),
) -> Result<Vec<Edit>, EditError> {
    let pattern = evaluation.pattern();
    let rule = GradeRule::of_number(pattern, number)
        .ok_or_else(|| EditError::Missing(format!("grade rule {number}")))?;
    refuse_size(pattern, size)?;
    refuse_shift(by)?;
    let base = base_of(pattern)?;
    if size == base.id {
        return Err(impossible(
            format!("{:?} is the base size, which rules do not move", base.name),
            "drag the point, which moves it alike in all sizes",
        ));
    }
    let mut edits = Vec::new();
    for (axis, id) in rule.variables.into_iter().enumerate() {
        let place = NumberAddress::new(id, "value");
        // A value that is that of the base size is not kept beside it.
        let usual = match number_at(pattern, &place) {
            Some(Number::PerSize { usual, .. }) => evaluation.number(&usual, Want::Length),
            Some(number @ (Number::Value(_) | Number::Formula(_) | Number::Adjusted { .. })) => {
                evaluation.number(&number, Want::Length)
            }
            None => None,
        };
        let is_usual = usual.is_some_and(|usual| (usual - by[axis]).abs() <= SAME);
        let value = (!is_usual).then_some(by[axis]);
        edits.extend(set_number_in_size(evaluation, &place, (size, value))?);
    }
    Ok(edits)
}

/// Plans to replace constructions, formulas and coordinates by sizes of points by rules that give the same
/// places in all sizes; also returns the number of points that got a rule. Points that move alike share one.
/// Points that have a rule, or lie alike in all sizes, stay as they are.
///
/// # Errors
/// The pattern has no sizes; a point is missing, or cannot be drawn in a size.
pub fn rules_of_sizes(
    evaluation: &Evaluation,
    points: &[PointId],
) -> Result<(Vec<Edit>, usize), EditError> {
    let pattern = evaluation.pattern();
    let base = base_of(pattern)?;
    if points.is_empty() {
        return Err(no_points());
    }
    let at_base = in_size(evaluation, base);
    let others = pattern.sizes.iter().filter(|size| size.id != base.id);
    let sized: Vec<(&Arc<Size>, Evaluation)> = others
        .map(|size| (size, in_size(evaluation, size)))
        .collect();
    let mut ids = pattern.ids;
    let mut known: BTreeMap<Vec<[i64; 2]>, GradeRule> = BTreeMap::new();
    for rule in GradeRule::all(pattern) {
        let shifts = rule_shifts(&at_base, rule);
        let of = |size: &SizeId| shifts.iter().find(|own| own.size == *size);
        let is_still = of(&base.id).is_some_and(|own| own.by.norm() <= SAME);
        let own: Option<Vec<[i64; 2]>> = sized
            .iter()
            .map(|(size, _)| of(&size.id).map(|own| rounded(own.by)))
            .collect();
        if let Some(own) = own.filter(|_| is_still) {
            known.entry(own).or_insert(rule);
        }
    }
    let mut numbers = GradeRule::free_numbers(pattern);
    let (mut variables, mut put) = (Vec::new(), Vec::new());
    for &id in points {
        let (sheet, found) = point(pattern, id)?;
        if rule_of(pattern, id).is_some() {
            continue;
        }
        let by = place(&at_base, id)?;
        let mut shifts = Vec::with_capacity(sized.len());
        for (size, evaluation) in &sized {
            let there = place(evaluation, id).map_err(|_| {
                impossible(
                    format!(
                        "point {:?} cannot be drawn in size {:?}",
                        found.name, size.name
                    ),
                    "mend the size first",
                )
            })?;
            shifts.push((size.id, there - by));
        }
        if shifts.iter().all(|(_, shift)| shift.norm() <= SAME) {
            continue;
        }
        let key: Vec<[i64; 2]> = shifts.iter().map(|(_, shift)| rounded(*shift)).collect();
        let rule = match known.get(&key) {
            Some(rule) => *rule,
            None => {
                let number = numbers.next().ok_or_else(no_number)?;
                let (rule, both) = GradeRule::made([ids.take(), ids.take()], number, &shifts);
                variables.extend(both.map(put_variable));
                known.insert(key, rule);
                rule
            }
        };
        put.push(Edit::Put(Entity::Point(
            sheet.id,
            Arc::new(Point {
                rule: rule.point([false; 2], by),
                ..(**found).clone()
            }),
        )));
    }
    let count = put.len();
    variables.extend(put);
    Ok((variables, count))
}

/// Plans to take the rules of points away, which then lie in all sizes where they lie in the base size. Rules
/// that move no point any longer go too.
///
/// # Errors
/// A point is missing or has neither a rule nor places by size.
pub fn ungrade(evaluation: &Evaluation, points: &[PointId]) -> Result<Vec<Edit>, EditError> {
    let pattern = evaluation.pattern();
    let at_base = in_size(evaluation, base_of(pattern)?);
    if points.is_empty() {
        return Err(no_points());
    }
    let mut edits = Vec::new();
    for &id in points {
        let (sheet, found) = point(pattern, id)?;
        let by_size = |number: &Number| matches!(number, Number::PerSize { usual, .. } if usual.value().is_some());
        let is_by_size = matches!(&found.rule, PointRule::At { x, y }
            if (by_size(x) || x.value().is_some()) && (by_size(y) || y.value().is_some()));
        if rule_of(pattern, id).is_none() && !is_by_size {
            return Err(without_rule(found));
        }
        let by = place(&at_base, id)?;
        edits.push(Edit::Put(Entity::Point(
            sheet.id,
            Arc::new(Point {
                rule: PointRule::at(by.x, by.y),
                ..(**found).clone()
            }),
        )));
    }
    let freed = points.iter().copied().collect();
    edits.extend(unused(pattern, &freed, None));
    Ok(edits)
}

/// The evaluation in another size.
fn in_size(evaluation: &Evaluation, size: &Arc<Size>) -> Evaluation {
    let mut sized = evaluation.clone();
    sized.update(evaluation.pattern(), size);
    sized
}

fn base_of(pattern: &Pattern) -> Result<&Arc<Size>, EditError> {
    let base = pattern.base().filter(|_| pattern.sizes.len() > 1);
    base.ok_or_else(|| {
        impossible(
            "the pattern has fewer than two sizes",
            "add sizes in the table of sizes first",
        )
    })
}

fn refuse_size(pattern: &Pattern, size: SizeId) -> Result<(), EditError> {
    match pattern.sizes.iter().any(|known| known.id == size) {
        true => Ok(()),
        false => Err(EditError::Missing(size.to_string())),
    }
}

fn refuse_shift(by: Vec2) -> Result<(), EditError> {
    if !(by.x.is_finite() && by.y.is_finite()) {
        return Err(EditError::NotFinite("the shift".to_owned()));
    }
    match by.norm() <= MAX_SHIFT {
        true => Ok(()),
        false => Err(impossible(
            format!("a shift is longer than {MAX_SHIFT} m"),
            "give the shift from the base size to the size, not the place",
        )),
    }
}

fn no_number() -> EditError {
    impossible(
        format!("rules are numbered to {MAX_GRADE_RULE}"),
        "take rules away that no point has",
    )
}

fn no_points() -> EditError {
    impossible("no points are chosen", "choose the points to grade")
}

fn without_rule(point: &Point) -> EditError {
    impossible(
        format!("point {:?} has no grade rule", point.name),
        "give it one first",
    )
}

fn graded(pattern: &Pattern, id: PointId) -> Result<Graded, EditError> {
    let (_, found) = point(pattern, id)?;
    GradeRule::of_point(pattern, &found.rule).ok_or_else(|| without_rule(found))
}

/// The shift of a graded point in the size of an evaluation (m).
fn shift_now(evaluation: &Evaluation, found: Graded) -> Vec2 {
    let mut shift = Vec2::zeros();
    for axis in [0, 1] {
        let value = evaluation.variable(found.rule.variables[axis]);
        let value = value.map_or(0.0, |found| found.0);
        shift[axis] = if found.is_turned[axis] { -value } else { value };
    }
    shift
}

/// Edits that give points a rule, whose shift in the base size is `shift` (m).
fn put_rule(
    at_base: &Evaluation,
    points: &[PointId],
    (rule, is_turned, shift): (GradeRule, [bool; 2], Vec2),
) -> Result<Vec<Edit>, EditError> {
    let pattern = at_base.pattern();
    let put = |&id: &PointId| {
        let (sheet, found) = point(pattern, id)?;
        let has_rule = GradeRule::of_point(pattern, &found.rule).is_some();
        let is_free = matches!(&found.rule, PointRule::At { x, y }
            if x.as_formula().is_none() && y.as_formula().is_none());
        if !has_rule && !is_free {
            return Err(impossible(
                format!(
                    "point {:?} grades by its construction or formula",
                    found.name
                ),
                "read rules off its sizes first, which puts a rule in place of it",
            ));
        }
        let by = place(at_base, id)? - shift;
        Ok(Edit::Put(Entity::Point(
            sheet.id,
            Arc::new(Point {
                rule: rule.point(is_turned, by),
                ..(**found).clone()
            }),
        )))
    };
    points.iter().map(put).collect()
}

fn put_variable(variable: Variable) -> Edit {
    Edit::Put(Entity::Variable(Arc::new(variable)))
}

/// Shifts as keys, in steps of a nanometre.
fn rounded(shift: Vec2) -> [i64; 2] {
    [shift.x, shift.y].map(|value| (value * 1e9).round() as i64)
}

/// Edits that remove the rules which nothing but these points used.
fn unused(pattern: &Pattern, freed: &BTreeSet<PointId>, kept: Option<GradeRule>) -> Vec<Edit> {
    let mut rules: Vec<GradeRule> = Vec::new();
    for &id in freed {
        let found = rule_of(pattern, id).map(|found| found.rule);
        if let Some(rule) = found.filter(|rule| Some(*rule) != kept && !rules.contains(rule)) {
            rules.push(rule);
        }
    }
    let mut used: BTreeSet<VariableId> = BTreeSet::new();
    for (entity, _) in pattern.entities() {
        let is_freed = matches!(entity.id(), Some(PartId::Point(id)) if freed.contains(&id));
        if is_freed {
            continue;
        }
        for part in entity.references() {
            if let Ok(id) = VariableId::try_from(part) {
                used.insert(id);
            }
        }
    }
    let is_unused = |rule: &&GradeRule| rule.variables.iter().all(|id| !used.contains(id));
    let unused = rules.iter().filter(is_unused);
    let removed = unused.flat_map(|rule| rule.variables);
    removed.map(|id| Edit::Remove(id.into())).collect()
}

/// Shifts of a new rule that grow by one step from size to size, from the base size on (m).
pub fn even_shifts(pattern: &Pattern, step: Vec2) -> Vec<(SizeId, Vec2)> {
    let base = pattern.base().map(|size| size.id);
    let at = pattern.sizes.iter().position(|size| Some(size.id) == base);
    let at = at.unwrap_or(0) as f64;
    let sizes = pattern.sizes.iter().enumerate();
    let others = sizes.filter(|(_, size)| Some(size.id) != base);
    others
        .map(|(k, size)| (size.id, step * (k as f64 - at)))
        .collect()
}
