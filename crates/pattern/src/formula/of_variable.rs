//! Formulas that are one variable, or one variable with its sign turned.

use super::{Formula, Operation, Step, Token};
use crate::VariableId;

impl Formula {
    /// The formula that is one variable, with its sign turned if `is_turned`.
    pub fn of_variable(id: VariableId, is_turned: bool) -> Self {
        let step = |column, operation| Step { column, operation };
        let (tokens, steps) = match is_turned {
            false => (
                vec![Token::Variable(id)],
                vec![step(1, Operation::Variable(id))],
            ),
            true => (
                vec![Token::Text("-".into()), Token::Variable(id)],
                vec![step(2, Operation::Variable(id)), step(1, Operation::Negate)],
            ),
        };
        Self {
            tokens: tokens.into(),
            steps: steps.into(),
        }
    }

    /// The variable that the formula consists of, and whether its sign is turned. `None`: it is another formula.
    pub fn as_variable(&self) -> Option<(VariableId, bool)> {
        let operations: Vec<&Operation> = self.steps.iter().map(|step| &step.operation).collect();
        match operations[..] {
            [Operation::Variable(id)] => Some((*id, false)),
            [Operation::Variable(id), Operation::Negate] => Some((*id, true)),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{Formula, Names, Number, Pattern, Variable, VariableId};
    use std::sync::Arc;

    #[test]
    fn a_variable_as_a_formula_is_what_its_text_says() {
        let mut pattern = Pattern::new("rules");
        let id: VariableId = pattern.ids.take();
        let number = Number::from(Formula::of_measurements("1cm").unwrap());
        let name = "grade_7_x".to_owned();
        pattern
            .variables
            .push(Arc::new(Variable { id, name, number }));
        let names = Names::new(&pattern);
        for (text, is_turned) in [("grade_7_x", false), ("-grade_7_x", true)] {
            let read = Formula::parse(text, &names).unwrap();
            let made = Formula::of_variable(id, is_turned);
            assert_eq!(read, made);
            assert_eq!(made.text(&names), text);
            assert_eq!(read.as_variable(), Some((id, is_turned)));
        }
        let other = Formula::parse("grade_7_x + 1cm", &names).unwrap();
        assert_eq!(other.as_variable(), None);
    }
}
