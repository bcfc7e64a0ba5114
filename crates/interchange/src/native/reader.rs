//! The state of reading a pattern file: unit, ids and names; reads numbers and formulas.

use super::item::{Item, Written};
use super::json::Value;
use super::measurements::measurements;
use crate::FormatError;
use std::collections::HashMap;
use std::sync::OnceLock;
use toile_measure::Measurements;
use toile_pattern::fields::{Clash, Kind};
use toile_pattern::{AnyId, Diagnostic, DisplayUnit, Formula, Names, Number, PartId, SizeId, Want};

/// State of reading a pattern file: everything that the parts of the file share.
pub struct Reader<'a> {
    /// Notes on unknown fields.
    pub notes: Vec<Diagnostic>,
    /// The first error found in the fields of a part; after it, no more fields are read.
    pub fault: Option<FormatError>,
    /// Unit of the lengths in the file.
    pub unit: DisplayUnit,
    /// Names of parts, by which formulas refer to them.
    names: Names,
    /// Ids that the parts of the file have.
    given: HashMap<u32, PartId>,
    /// Ids that are referred to, with the place of the reference.
    referred: Vec<(PartId, Item<'a>)>,
}

impl<'a> Reader<'a> {
    pub fn new(names: Names) -> Self {
        Self {
            notes: Vec::new(),
            fault: None,
            unit: DisplayUnit::default(),
            names,
            given: HashMap::new(),
            referred: Vec::new(),
        }
    }

    /// Reads a table of measurements.
    pub fn measurements(&mut self, item: &Item<'a>) -> Result<Measurements, FormatError> {
        measurements(item, self.unit, &mut self.notes)
    }

    /// Reads the id that a part itself has.
    pub fn own(&mut self, item: &Item<'a>, id: &mut dyn AnyId) -> Result<(), FormatError> {
        let number = item.count()?;
        id.set_number(number);
        match self.given.insert(number, id.part()) {
            None => Ok(()),
            Some(other) => Err(item.error(
                format!("the id {number} is that of {other} already"),
                "give each part an id of its own",
            )),
        }
    }

    /// Reads a reference to a part by its id.
    pub fn reference(&mut self, item: &Item<'a>, id: &mut dyn AnyId) -> Result<(), FormatError> {
        id.set_number(item.count()?);
        self.referred.push((id.part(), item.clone()));
        Ok(())
    }

    /// Refuses a next id that is not above the ids of all parts, and references to an id of another kind or to
    /// an id never given. A reference to a deleted part is allowed: it becomes valid when the part is restored.
    pub fn check_ids(&self, item: &Item<'_>, next: u32) -> Result<(), FormatError> {
        if let Some((highest, id)) = self.given.iter().max_by_key(|(number, _)| **number)
            && *highest >= next
        {
            return Err(item.error(
                format!("the next id is {next}, and {id} has been given"),
                format!("write {}", highest.saturating_add(1)),
            ));
        }
        for (wanted, item) in &self.referred {
            let found = self.given.get(&wanted.number());
            if found.is_some_and(|found| found != wanted) || wanted.number() >= next {
                let what = match found {
                    Some(other) => format!("{wanted} is referred to, but the file has {other}"),
                    None => format!("{wanted} is referred to, which was never given"),
                };
                return Err(item.error(what, "refer to a part of the right kind"));
            }
        }
        Ok(())
    }

    /// Reads a number: a value, a formula, an adjusted formula, or one value per size.
    pub fn number(&mut self, item: &Item<'a>, want: Want) -> Result<Number, FormatError> {
        if let Value::Object(_) = item.node.value {
            let fields = item.fields()?;
            fields.kind(numbers(), &Clash::default())?;
            if let Some(formula) = fields.get("formula") {
                item.object(&["formula", "by"], &mut self.notes)?;
                return Ok(Number::Adjusted {
                    formula: self.formula(&formula, formula.text()?)?,
                    by: self.value(&fields.need("by")?, want)?,
                });
            }
            if let Some(usual) = fields.get("usual") {
                item.object(&["usual", "sizes"], &mut self.notes)?;
                let usual = Box::new(self.number(&usual, want)?);
                let mut sizes: Vec<(SizeId, f64)> = Vec::new();
                for pair in fields.need("sizes")?.list()? {
                    let pair = pair.exactly(2)?;
                    let mut id = SizeId::default();
                    self.reference(&pair[0], &mut id)?;
                    if sizes.iter().any(|known| known.0 == id) {
                        let what = format!("{id} is given two values");
                        return Err(pair[0].error(what, "keep one of them"));
                    }
                    sizes.push((id, self.value(&pair[1], want)?));
                }
                return Ok(Number::PerSize { usual, sizes });
            }
        }
        match self.written(item, want)? {
            Written::Value(value) => Ok(Number::Value(value)),
            Written::Formula(text) => self.formula(item, text).map(Number::Formula),
        }
    }

    /// A number that must be a plain value.
    pub fn value(&self, item: &Item<'_>, want: Want) -> Result<f64, FormatError> {
        item.fixed(&self.written(item, want)?)
    }

    fn written<'b>(&self, item: &Item<'b>, want: Want) -> Result<Written<'b>, FormatError> {
        match want {
            Want::Length => item.length(self.unit),
            Want::Angle => item.angle(),
            Want::Plain | Want::Any => item.plain(),
        }
    }

    fn formula(&mut self, item: &Item<'a>, text: &str) -> Result<Formula, FormatError> {
        let formula = Formula::parse(text, &self.names).map_err(|error| {
            let column = error.column;
            let what = format!("the formula {text:?}, column {column}: {}", error.message);
            item.error(what, error.hint)
        })?;
        let named = formula.references().into_iter();
        self.referred.extend(named.map(|part| (part, item.clone())));
        Ok(formula)
    }
}

/// The kinds of numbers that are written as objects.
fn numbers() -> &'static [Kind] {
    static KINDS: OnceLock<Vec<Kind>> = OnceLock::new();
    let kinds: [(&'static str, &[&'static str]); 4] = [
        ("formula", &["by"]),
        ("usual", &["sizes"]),
        ("m", &[]),
        ("rad", &[]),
    ];
    KINDS.get_or_init(|| kinds.map(|(told, more)| Kind::told_by(told, more)).to_vec())
}
