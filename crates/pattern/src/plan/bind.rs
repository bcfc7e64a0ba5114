//! Binds names in formulas to parts as soon as these exist.

use super::numbers::put_number;
use crate::{Edit, Evaluation, Formula, Names, Number, PartReference, Token};

/// Plans to replace names in formulas by ids, where a part with the name exists now but did not before.
/// Formulas that also name removed parts are not changed.
pub(super) fn bound(evaluation: &Evaluation) -> Vec<Edit> {
    let names = evaluation.names();
    let mut edits = Vec::new();
    for (mut entity, _) in evaluation.pattern().entities() {
        let mut is_changed = false;
        for entry in entity.number_entries(None) {
            if let Some(number) = entry.number.and_then(|number| bound_number(&number, names)) {
                is_changed |= put_number(&mut entity, &entry.place, &number);
            }
        }
        if is_changed {
            edits.push(Edit::Put(entity));
        }
    }
    edits
}

/// The number with its names replaced by ids. `None`: nothing changes.
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
