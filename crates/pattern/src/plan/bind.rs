//! Binds names in formulas to parts once these exist.

use super::number_address::Slot;
use super::numbers::numbers_of;
use crate::{Edit, Entity, Evaluation, Formula, Names, Number, PartReference, Token};

/// The edits after which formulas that name what was not there mean what is called so now. Formulas
/// that also speak of removed parts keep waiting for them.
pub(super) fn bound(evaluation: &Evaluation) -> Vec<Edit> {
    let pattern = evaluation.pattern();
    let names = evaluation.names();
    let mut changed: Vec<Entity> = Vec::new();
    for (part, _) in pattern.parts() {
        for entry in numbers_of(evaluation, part) {
            let Some(number) = entry.number.and_then(|number| bound_number(&number, names)) else {
                continue;
            };
            let Some(entity) = entry.place.entity(pattern) else {
                continue;
            };
            // A panel or seam may have several such numbers.
            let known = changed.iter().position(|other| other.id() == entity.id());
            let k = known.unwrap_or_else(|| {
                changed.push(entity);
                changed.len() - 1
            });
            match entry.place.slot(&mut changed[k]) {
                Some(Slot::Always(old)) => *old = number,
                Some(Slot::Optional(old)) => *old = Some(number),
                None => {}
            }
        }
    }
    changed.into_iter().map(Edit::Put).collect()
}

/// The number with its names bound; nothing if nothing changes.
fn bound_number(number: &Number, names: &Names) -> Option<Number> {
    match number {
        Number::Value(_) => None,
        Number::Formula(formula) => bound_formula(formula, names).map(Number::Formula),
        Number::Adjusted { formula, by } => {
            let formula = bound_formula(formula, names)?;
            Some(Number::Adjusted { formula, by: *by })
        }
        Number::PerSize { usual, sizes } => Some(Number::PerSize {
            usual: Box::new(bound_number(usual, names)?),
            sizes: sizes.clone(),
        }),
    }
}

fn bound_formula(formula: &Formula, names: &Names) -> Option<Formula> {
    let waits = |token: &Token| {
        matches!(
            token,
            Token::Word(_) | Token::Part(PartReference::Unknown(_))
        )
    };
    let text = formula.text(names);
    if !formula.tokens().iter().any(waits) || text.contains('?') {
        return None;
    }
    let again = Formula::parse(&text, names).ok()?;
    (again != *formula).then_some(again)
}
