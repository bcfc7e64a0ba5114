//! The state of reading a pattern file: its unit, ids and names; numbers and formulas in them.

use super::item::{Item, Written};
use super::json::Value;
use super::measurements::measurements;
use crate::FormatError;
use std::collections::HashMap;
use std::sync::OnceLock;
use toile_measure::Measurements;
use toile_pattern::fields::{Clash, Kind};
use toile_pattern::{AnyId, Diagnostic, DisplayUnit, Formula, Names, Number, PartId, SizeId, Want};

/// State of the reader.
pub struct Reader<'a> {
    pub notes: Vec<Diagnostic>,
    /// The first thing that is wrong with what is read by its fields; nothing is read after it.
    pub fault: Option<FormatError>,
    pub unit: DisplayUnit,
    names: Names,
    /// Ids that parts of the file have.
    given: HashMap<u32, PartId>,
    /// Ids that are referred to, with their places.
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

    /// A table of measurements.
    pub fn measurements(&mut self, item: &Item<'a>) -> Result<Measurements, FormatError> {
        measurements(item, self.unit, &mut self.notes)
    }

    /// The id of a part of the file.
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

    /// The id of a part that is referred to.
    pub fn reference(&mut self, item: &Item<'a>, id: &mut dyn AnyId) -> Result<(), FormatError> {
        id.set_number(item.count()?);
        self.referred.push((id.part(), item.clone()));
        Ok(())
    }

    /// Refuses ids of another kind, and ids that were never given. A part that was removed may be
    /// referred to: what refers to it waits for its return.
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

    /// A number: a value, a formula, an adjusted formula, a value a size.
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

    /// A number that is a value.
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

/// Kinds of numbers that are objects.
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
