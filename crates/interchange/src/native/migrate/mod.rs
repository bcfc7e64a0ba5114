//! Documents of version 1 as today's: a panel becomes a sheet and a panel, darts and the fold
//! become operations, shares of edges become marks.

mod document;
mod panels;
mod read;
mod read_panel;
mod seams;

use super::item::Item;
use crate::FormatError;
use document::Number as OldNumber;
use std::collections::HashMap;
use std::sync::Arc;
use toile_measure::Measurements;
use toile_pattern::{
    CurveId, Diagnostic, Evaluation, FabricId, Formula, LineId, Names, Number, PanelId, Pattern,
    PointId, Size, SizeId, Variable, VariableId, Want,
};

/// Reads a document of version 1.
pub fn read_version_1(
    root: &Item<'_>,
    notes: &mut Vec<Diagnostic>,
) -> Result<Pattern, FormatError> {
    let old = read::read(root, notes)?;
    // Formulas name parts, so the parts come first: names are bound in a second round, which
    // gives the same ids. Directions of spans that formulas decide need values: a third.
    let unbound = Migration::new(&old, Names::default()).run(&|_, _| None);
    let names = Names::new(&unbound);
    let bound = Migration::new(&old, names.clone()).run(&|_, _| None);
    let adult = Measurements::adult();
    let body = bound.base_measurements().unwrap_or(&adult).clone();
    let evaluation = Evaluation::new(&bound, &body);
    Ok(Migration::new(&old, names).run(&|number, want| evaluation.number(number, want)))
}

/// An edge of version 1 and its counterpart in the document.
#[derive(Clone, Copy)]
struct EdgePlace {
    panel: PanelId,
    line: LineId,
    curve: CurveId,
    ends: [PointId; 2],
}

/// Values of today's numbers in the base size.
type Values<'v> = &'v dyn Fn(&Number, Want) -> Option<f64>;

/// A document of version 1 on its way to today's.
struct Migration<'o> {
    old: &'o document::Pattern,
    names: Names,
    new: Pattern,
    /// Panels by their old numbers.
    panels: HashMap<u32, PanelId>,
    fabrics: HashMap<u32, FabricId>,
    points: HashMap<u32, PointId>,
    edges: HashMap<u32, EdgePlace>,
}

impl<'o> Migration<'o> {
    fn new(old: &'o document::Pattern, names: Names) -> Self {
        let mut new = Pattern::new(old.name.clone());
        new.unit = old.unit;
        Self {
            old,
            names,
            new,
            panels: HashMap::new(),
            fabrics: HashMap::new(),
            points: HashMap::new(),
            edges: HashMap::new(),
        }
    }

    /// Today's number.
    fn number(&self, number: &OldNumber) -> Number {
        match number {
            OldNumber::Value(value) => Number::Value(*value),
            OldNumber::Formula(text) => match Formula::parse(text, &self.names) {
                Ok(formula) => Number::Formula(formula),
                // The reader took the text for a formula, whatever it names.
                Err(_) => Number::ZERO,
            },
        }
    }

    /// Builds the document; `values` gives the values of numbers where they are known.
    fn run(mut self, values: Values<'_>) -> Pattern {
        for size in &self.old.sizes {
            let id: SizeId = self.new.ids.take();
            if self.old.base_size.as_ref() == Some(&size.name) {
                self.new.base_size = Some(id);
            }
            self.new.sizes.push(Arc::new(Size {
                id,
                name: size.name.clone(),
                measurements: size.measurements.clone(),
            }));
        }
        for variable in &self.old.variables {
            let id: VariableId = self.new.ids.take();
            let number = self.number(&variable.number);
            self.new.variables.push(Arc::new(Variable {
                id,
                name: variable.name.clone(),
                number,
            }));
        }
        for fabric in &self.old.fabrics {
            let id: FabricId = self.new.ids.take();
            self.fabrics.insert(fabric.id.0, id);
            let mut fabric = fabric.clone();
            fabric.id = id;
            self.new.fabrics.push(Arc::new(fabric));
        }
        for panel in &self.old.panels {
            self.panel(panel, values);
        }
        for seam in &self.old.seams {
            self.seam(seam, values);
        }
        self.new
    }
}
