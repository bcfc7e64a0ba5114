//! Walks every number of a panel, seam or pattern, to check or rewrite it.

use crate::formula::Mentioned;
use crate::{
    Along, Dart, DartShape, DartTip, EdgeCurve, EditError, Notch, Number, Panel, Pattern, Seam,
    WornRule,
};
use std::sync::Arc;

fn curve_numbers(curve: &mut EdgeCurve) -> Option<&mut Number> {
    match curve {
        EdgeCurve::Arc { bulge } => Some(bulge),
        _ => None,
    }
}

impl Panel {
    /// Every number of the panel.
    pub(crate) fn numbers_mut(&mut self) -> Vec<&mut Number> {
        let mut numbers = vec![&mut self.grain, &mut self.seam_allowance];
        for point in &mut self.points {
            numbers.extend(point.place.numbers_mut());
        }
        for edge in self
            .outline
            .iter_mut()
            .chain(self.holes.iter_mut().flatten())
        {
            numbers.extend(curve_numbers(&mut edge.curve));
            numbers.extend(edge.seam_allowance.as_mut());
        }
        for line in &mut self.internal_lines {
            for segment in &mut line.segments {
                numbers.extend(curve_numbers(&mut segment.curve));
            }
        }
        for Dart { shape, .. } in &mut self.darts {
            match shape {
                DartShape::Edge { at, width, tip, .. } => {
                    numbers.extend([at, width]);
                    if let DartTip::Depth(depth) = tip {
                        numbers.push(depth);
                    }
                }
                DartShape::Diamond { at, width, .. } => numbers.extend([at, width]),
            }
        }
        for Notch { at, .. } in &mut self.notches {
            let (Along::Fraction(number) | Along::Distance(number)) = at;
            numbers.push(number);
        }
        if let WornRule::Wrapped {
            level: Some(level), ..
        } = &mut self.worn
        {
            numbers.push(level);
        }
        numbers
    }
}

impl Seam {
    /// Every number of the seam.
    pub(crate) fn numbers_mut(&mut self) -> Vec<&mut Number> {
        let mut numbers = vec![&mut self.ease];
        for span in self.sides.iter_mut().flatten() {
            numbers.extend([&mut span.from, &mut span.to]);
        }
        numbers
    }
}

/// Whether a number mentions something.
fn mentions(number: &Number, what: &Mentioned) -> bool {
    match number {
        Number::Formula(formula) => formula.mentions().any(|found| found == what),
        Number::Value(_) => false,
    }
}

fn rewrite(number: &mut Number, old: &Mentioned, new: &str) -> Result<(), EditError> {
    if let Number::Formula(formula) = number
        && mentions(&Number::Formula(formula.clone()), old)
    {
        *formula = formula
            .renamed(old, new)
            .ok_or_else(|| EditError::Impossible {
                message: format!("the formula {:?} would become too long", formula.text()),
                hint: "choose a shorter name or split the formula".into(),
            })?;
    }
    Ok(())
}

impl Pattern {
    /// Writes `new` for `old` in every formula of the pattern.
    pub(crate) fn rewrite(&mut self, old: &Mentioned, new: &str) -> Result<(), EditError> {
        for variable in &mut self.variables {
            rewrite(&mut variable.number, old, new)?;
        }
        for panel in &mut self.panels {
            let mut copy = (**panel).clone();
            let mut changed = false;
            for number in copy.numbers_mut() {
                changed |= mentions(number, old);
                rewrite(number, old, new)?;
            }
            if changed {
                *panel = Arc::new(copy);
            }
        }
        for seam in &mut self.seams {
            let mut copy = (**seam).clone();
            let mut changed = false;
            for number in copy.numbers_mut() {
                changed |= mentions(number, old);
                rewrite(number, old, new)?;
            }
            if changed {
                *seam = Arc::new(copy);
            }
        }
        Ok(())
    }
}

/// Whether every bare value is finite.
pub(crate) fn all_finite(numbers: Vec<&mut Number>) -> bool {
    numbers
        .into_iter()
        .all(|number| number.value().is_none_or(f64::is_finite))
}
