//! Measurements and variables given by name, for programs.

use crate::{BodyChoice, Project, SessionError};
use std::sync::Arc;
use toile_measure::{CATALOGUE, Measurements, Origin, definition};
use toile_pattern::fields::NumberAddress;
use toile_pattern::plan::set_number;
use toile_pattern::{Evaluation, Formula, FormulaError, Number, nearest};

impl Project {
    /// The variables of the pattern in its order, each with its value for the project's wearer (m), (m2), (rad) or
    /// plain; without one where its formula has none.
    pub fn variables(&self) -> Vec<(String, Option<f64>)> {
        let evaluation = Evaluation::new(&self.pattern, self.drafted_to());
        let variables = self.pattern.variables.iter();
        let each = variables.map(|variable| {
            let value = evaluation.variable(variable.id).map(|found| found.0);
            (variable.name.clone(), value)
        });
        each.collect()
    }

    /// The project with a variable set to a value in every size: metres if it is a length, radians if it is an
    /// angle.
    ///
    /// # Errors
    /// There is no variable of this name; a value that is not finite; a value with which a formula has none.
    pub fn with_variable(&self, name: &str, value: f64) -> Result<Self, SessionError> {
        let pattern = &self.pattern;
        let own = pattern.variables.iter().find(|own| own.name == name);
        let own = own.ok_or_else(|| {
            let names: Vec<&str> = pattern.variables.iter().map(|own| &*own.name).collect();
            SessionError::Unknown {
                kind: "variable",
                name: name.to_owned(),
                hint: match names.is_empty() {
                    true => "the pattern has no variables".to_owned(),
                    false => format!("choose one of {}", names.join(", ")),
                },
            }
        })?;
        if !value.is_finite() {
            return Err(SessionError::Number {
                what: "the value of the variable",
                value,
                hint: "give a finite number",
            });
        }
        let evaluation = Evaluation::new(pattern, self.drafted_to());
        let power = evaluation.variable(own.id).map_or(0, |found| found.1);
        // A length or an angle has its unit in a formula.
        let unit = match power {
            0 if evaluation.is_angle(own.id) => "rad".to_owned(),
            0 => String::new(),
            power => format!("m{}", " * 1m".repeat(usize::from(power.unsigned_abs()) - 1)),
        };
        let number = match unit.is_empty() {
            true => Number::Value(value),
            false => {
                let text = format!("{value}{unit}");
                let formula = Formula::of_measurements(&text);
                let why = |error: FormulaError| SessionError::Conflict(format!("{text}: {error}"));
                Number::Formula(formula.map_err(why)?)
            }
        };
        let place = NumberAddress::new(own.id, "value");
        Ok(self.edited(&set_number(&evaluation, &place, number)?)?)
    }

    /// The project drafted for a wearer of given measurements (m), (rad), in place of a size. Those that are
    /// missing are predicted.
    ///
    /// # Errors
    /// A name that is no measurement; a length that nobody has.
    pub fn with_measurements(
        &self,
        given: impl IntoIterator<Item = (String, f64)>,
    ) -> Result<Self, SessionError> {
        let measurements = self.named_measurements(given)?;
        Ok(Self {
            body: BodyChoice::Measured {
                figure: self.figure(),
                path: None,
                measurements: Arc::new(measurements),
            },
            size: None,
            ..self.clone()
        })
    }

    /// A table of measurements (m), (rad) by names of the catalogue or of the pattern's own tables.
    ///
    /// # Errors
    /// A name that neither has; a value that nobody has.
    pub fn named_measurements(
        &self,
        given: impl IntoIterator<Item = (String, f64)>,
    ) -> Result<Measurements, SessionError> {
        let mut measurements = Measurements::new();
        for (name, value) in given {
            let tables = self.pattern.sizes.iter().map(|size| &size.measurements);
            let is_own = tables.clone().any(|table| table.contains(&name));
            if definition(&name).is_none() && !is_own {
                let own = tables.flat_map(Measurements::iter).map(|(own, _)| own);
                let known = CATALOGUE.iter().map(|known| known.name).chain(own);
                let hint = match nearest(&name, known) {
                    Some(meant) => format!("did you mean {meant}?"),
                    None => {
                        "choose a name of the catalogue, as bust, waist, hips or height".to_owned()
                    }
                };
                return Err(SessionError::Unknown {
                    kind: "measurement",
                    name,
                    hint,
                });
            }
            let taken = measurements.set(&name, value, Origin::Asked);
            taken.map_err(|error| SessionError::Conflict(error.to_string()))?;
        }
        match measurements.impossible() {
            None => Ok(measurements),
            Some((name, value)) => Err(SessionError::Measurement {
                name: name.to_owned(),
                value,
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_pattern::Variable;

    fn with_variables(texts: &[(&str, &str)]) -> Project {
        let mut pattern = toile_pattern::Pattern::blank("skirt");
        for (name, formula) in texts {
            let known = Evaluation::new(&pattern, &Measurements::new());
            let formula = Formula::parse(formula, known.names()).unwrap();
            let id = pattern.ids.take();
            pattern.variables.push(Arc::new(Variable {
                id,
                name: (*name).to_owned(),
                number: Number::Formula(formula),
            }));
        }
        Project {
            pattern: Arc::new(pattern),
            ..Project::default()
        }
    }

    #[test]
    fn a_variable_keeps_its_dimension_and_takes_the_value_to_the_bit() {
        let project = with_variables(&[
            ("ease", "5cm"),
            ("slope", "30deg"),
            ("share", "1 / 3"),
            ("cloth", "2m * 3m"),
            ("twice", "ease * 2"),
        ]);
        for (name, value) in [
            ("ease", 0.1 + 0.2),
            ("slope", -0.123),
            ("share", 1e-7),
            ("cloth", 7.3),
        ] {
            let next = project.with_variable(name, value).unwrap();
            let found = |of: &Project, name: &str| {
                let all = of.variables();
                all.into_iter()
                    .find(|own| own.0 == name)
                    .and_then(|own| own.1)
            };
            assert_eq!(found(&next, name), Some(value), "{name}");
            assert_ne!(found(&project, name), Some(value), "{name}");
            if name == "ease" {
                assert_eq!(found(&next, "twice"), Some(2.0 * value));
            }
        }
        let refused = project.with_variable("eas", 0.1).unwrap_err().to_string();
        assert!(refused.contains("ease"), "{refused}");
        assert!(project.with_variable("ease", f64::NAN).is_err());
    }

    #[test]
    fn measurements_take_the_place_of_a_size() {
        let project = with_variables(&[]);
        let given = [("bust".to_owned(), 0.96)];
        let measured = project.with_measurements(given).unwrap();
        assert_eq!(measured.drafted_to().measurements.get("bust"), Some(0.96));
        let refused = project.with_measurements([("busst".to_owned(), 0.96)]);
        let words = refused.unwrap_err().to_string();
        assert!(words.contains("did you mean bust?"), "{words}");
        assert!(
            project
                .with_measurements([("bust".to_owned(), -1.0)])
                .is_err()
        );
        assert!(
            project
                .with_measurements([("bust".to_owned(), f64::NAN)])
                .is_err()
        );
    }
}
