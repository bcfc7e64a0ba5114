//! Measurements and increments of a file: names that its formulas use.

use super::build::Build;
use super::expression::Expression;
use super::kinds::{LENGTH, PLAIN, Quantity, Symbol};
use super::quantities::{constant, demand, quantity_of};
use super::sizes::tables_of;
use super::translate::{translated, value};
use crate::exchange::{Companion, Guess, ReadOption};
use crate::measurements_seamly::SeamlyRows;
use crate::part_names::part_name;
use crate::xml::Xml;
use crate::{FormatError, Loss};
use roxmltree::Node;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use toile_measure::{
    Build as Figure, Measurements, Origin, SEAMLY, definition, is_angle, translated as own_name,
};
use toile_pattern::{Number, Size, SizeId, Variable, VariableId};

/// A length that is unknown although formulas name it (m).
const UNKNOWN_LENGTH: f64 = 0.1;
/// Rounds in which quantities of increments are found from their uses.
const MAX_ROUNDS: usize = 10;
/// Attributes of tools that are formulas, and what they are wanted as.
const FORMULAS: &[(&str, Quantity)] = &[
    ("length", LENGTH),
    ("length1", LENGTH),
    ("length2", LENGTH),
    ("radius", LENGTH),
    ("radius1", LENGTH),
    ("radius2", LENGTH),
    ("arcRadius", LENGTH),
    ("c1Radius", LENGTH),
    ("c2Radius", LENGTH),
    ("cRadius", LENGTH),
    ("width", LENGTH),
    ("before", LENGTH),
    ("after", LENGTH),
    ("angle", Quantity::Angle),
    ("angle1", Quantity::Angle),
    ("angle2", Quantity::Angle),
    ("rotationAngle", Quantity::Angle),
];

/// The names of all measurement files that a pattern names.
pub(super) fn measurement_file(xml: &Xml<'_>) -> Option<String> {
    let node = xml
        .elements()
        .find(|node| node.tag_name().name() == "measurements")?;
    let path = node.attribute("path").or(node.text())?.trim();
    (!path.is_empty()).then(|| path.to_owned())
}

/// An increment of the file.
struct Increment {
    name: String,
    line: usize,
    formula: Result<Expression, String>,
}

/// Reads measurements and increments, so that formulas of the drawing may name them.
///
/// # Errors
/// The file of measurements is damaged: its fault.
pub(super) fn read(
    build: &mut Build,
    xml: &Xml<'_>,
    companions: &[Companion],
) -> Result<(), FormatError> {
    let increments = increments(xml);
    let named: BTreeSet<&str> = increments.iter().map(|one| one.name.as_str()).collect();
    let formulas = formulas_of(xml);
    let mut words: BTreeSet<String> = BTreeSet::new();
    let all = formulas.iter().map(|(formula, _)| formula);
    let all = all.chain(
        increments
            .iter()
            .filter_map(|one| one.formula.as_ref().ok()),
    );
    for formula in all {
        formula.each_name(&mut |name| {
            build.used.insert(name.to_owned());
            let is_drawn = super::build::quantity_by_name(name).is_some();
            if !is_drawn && constant(name).is_none() && !named.contains(name) {
                words.insert(name.to_owned());
            }
        });
    }
    measurements(build, xml, companions, &words)?;
    find_quantities(build, &increments, &formulas);
    let mut taken: BTreeSet<String> = build
        .pattern
        .variables
        .iter()
        .map(|variable| variable.name.clone())
        .collect();
    for increment in increments {
        let place = format!("line {}", increment.line);
        let name = increment.name.clone();
        let told = format!("increment {name:?}");
        if let Err(why) = add_increment(build, increment, &mut taken) {
            build.left_out(place, told, why);
        }
    }
    Ok(())
}

fn increments(xml: &Xml<'_>) -> Vec<Increment> {
    let all = xml.elements().filter(|node| {
        let tag = node.tag_name().name();
        (tag == "increment" || tag == "variable") && node.has_attribute("name")
    });
    let read = |node: Node<'_, '_>| {
        let name = node.attribute("name").unwrap_or_default().to_owned();
        let text = node.attribute("formula").or(node.attribute("base"));
        // A separator of the table has a name and no formula.
        let text = text.filter(|text| !text.trim().is_empty())?;
        Some(Increment {
            name,
            line: xml.line(node),
            formula: Expression::read(text),
        })
    };
    all.filter_map(read).collect()
}

/// All formulas of tools and pieces, with what they are wanted as.
fn formulas_of(xml: &Xml<'_>) -> Vec<(Expression, Quantity)> {
    let mut found = Vec::new();
    for node in xml.elements() {
        for (attribute, want) in FORMULAS {
            let Some(text) = node.attribute(*attribute) else {
                continue;
            };
            if text.trim().parse::<f64>().is_ok() {
                continue;
            }
            if let Ok(formula) = Expression::read(text) {
                found.push((formula, *want));
            }
        }
    }
    found
}

/// Finds whether increments that are numbers alone are lengths, angles or factors, from their uses.
fn find_quantities(
    build: &mut Build,
    increments: &[Increment],
    formulas: &[(Expression, Quantity)],
) {
    let names: BTreeSet<&str> = increments.iter().map(|one| one.name.as_str()).collect();
    for _ in 0..MAX_ROUNDS {
        let mut found: BTreeMap<String, Quantity> = BTreeMap::new();
        for increment in increments {
            let Ok(formula) = &increment.formula else {
                continue;
            };
            let known = build.quantities.get(&increment.name).copied();
            let own = quantity_of(formula, build);
            if let (None, Some(own)) = (known, own) {
                found.entry(increment.name.clone()).or_insert(own);
            }
            let want = known.or(own).unwrap_or(PLAIN);
            demand(formula, want, build, &mut |name, quantity| {
                if names.contains(name) {
                    found.entry(name.to_owned()).or_insert(quantity);
                }
            });
        }
        for (formula, want) in formulas {
            demand(formula, *want, build, &mut |name, quantity| {
                if names.contains(name) {
                    found.entry(name.to_owned()).or_insert(quantity);
                }
            });
        }
        found.retain(|name, _| !build.quantities.contains_key(name));
        if found.is_empty() {
            break;
        }
        build.quantities.extend(found);
    }
    for name in names {
        let known = build.quantities.entry(name.to_owned());
        known.or_insert(PLAIN);
    }
}

fn add_increment(
    build: &mut Build,
    increment: Increment,
    taken: &mut BTreeSet<String>,
) -> Result<(), String> {
    let formula = increment.formula?;
    let quantity = build.quantities.get(&increment.name).copied();
    let quantity = quantity.unwrap_or(PLAIN);
    let number = value(&formula, build)?;
    if !number.is_finite() {
        return Err("its value is no number".to_owned());
    }
    let text = translated(&formula, quantity, build)?;
    let mut has_names = false;
    formula.each_name(&mut |_| has_names = true);
    let number_of_document = match has_names || quantity != PLAIN {
        true => build.formula(&text)?,
        false => Number::Value(number),
    };
    let wanted = increment.name.trim_start_matches('#');
    let id = add_variable(build, wanted, number_of_document, taken);
    let symbol = Symbol {
        text: format!("?{}", id.0),
        quantity,
        value: number,
    };
    build.symbols.insert(increment.name, symbol);
    Ok(())
}

fn add_variable(
    build: &mut Build,
    name: &str,
    number: Number,
    taken: &mut BTreeSet<String>,
) -> VariableId {
    let id: VariableId = build.pattern.ids.take();
    let name = part_name(name, taken);
    build
        .pattern
        .variables
        .push(Arc::new(Variable { id, name, number }));
    id
}

/// Our name of a measurement of theirs.
fn name_of(theirs: &str) -> String {
    match own_name(SEAMLY, theirs) {
        Some(own) => own.to_owned(),
        None => theirs.trim_start_matches('@').to_ascii_lowercase(),
    }
}

/// Gives each measurement that formulas name its value: from the file of measurements, predicted, or as a
/// variable.
fn measurements(
    build: &mut Build,
    xml: &Xml<'_>,
    companions: &[Companion],
    words: &BTreeSet<String>,
) -> Result<(), FormatError> {
    let wanted = measurement_file(xml);
    let found = companions.first();
    let tables = match found {
        None => None,
        Some(companion) => Some(tables_of(companion)?),
    };
    let none = SeamlyRows::default();
    let rows = tables.as_ref().map_or(&none, |tables| &tables.rows);
    if words.is_empty() && rows.rows.is_empty() {
        return Ok(());
    }
    let (mut table, given) = table_of(rows);
    for out in &rows.impossible {
        let place = found.map_or("", |companion| companion.name.as_str());
        build.losses.push(Loss {
            count: out.names.len(),
            ..Loss::at(
                place,
                "measurements of the wearer",
                format!("{}; formulas have them", out.why),
            )
        });
    }
    let complete = table.completed(Figure::Either);
    let others: Vec<OtherSize<'_>> = tables
        .iter()
        .flat_map(|tables| &tables.others)
        .map(|(name, rows)| {
            let (table, given) = table_of(rows);
            OtherSize {
                id: build.pattern.ids.take(),
                name,
                complete: table.completed(Figure::Either),
                table,
                given,
            }
        })
        .collect();
    let mut taken = BTreeSet::new();
    let (mut predicted, mut unknown) = (Vec::new(), Vec::new());
    for theirs in words {
        let own = name_of(theirs);
        let quantity = quantity_of_measurement(&own);
        let in_table = table.get(&own);
        let measured = given.get(theirs.as_str()).copied();
        let from_figure = complete.get(&own).filter(|_| measured.is_none());
        let symbol = match (in_table, from_figure) {
            (Some(value), _) => Some((value, Origin::Asked)),
            (None, Some(value)) => Some((value, Origin::Predicted)),
            (None, None) => None,
        };
        let symbol = match symbol {
            Some((value, origin)) => {
                if origin == Origin::Predicted {
                    predicted.push(theirs.clone());
                    let _ = table.set(&own, value, origin);
                }
                let own = definition(&own).map_or(own.as_str(), |known| known.name);
                (own.to_owned(), value)
            }
            None => {
                let value = measured.unwrap_or_else(|| {
                    unknown.push(theirs.clone());
                    match quantity {
                        Quantity::Angle => 0.0,
                        Quantity::Power(_) => UNKNOWN_LENGTH,
                    }
                });
                let text = match quantity {
                    Quantity::Angle => format!("{}deg", value.to_degrees()),
                    Quantity::Power(_) => {
                        format!("{}{}", build.unit.of_si(value, LENGTH), build.unit.word)
                    }
                };
                let number = build.formula(&text).unwrap_or(Number::Value(value));
                let number = in_sizes(number, value, &others, theirs);
                let name = theirs.trim_start_matches('@');
                let id = add_variable(build, name, number, &mut taken);
                (format!("?{}", id.0), value)
            }
        };
        build.name_value(theirs.clone(), &symbol.0, quantity, symbol.1);
    }
    tell(build, (found, wanted), predicted, unknown);
    if !table.is_empty() {
        let name = tables
            .as_ref()
            .map_or("base", |tables| tables.base.as_str());
        add_sizes(build, name, table, others);
    }
    build.guesses.extend(tables.and_then(|tables| tables.guess));
    Ok(())
}

/// A size beside the base of a table.
struct OtherSize<'a> {
    id: SizeId,
    name: &'a str,
    table: Measurements,
    /// The table with what it does not have, predicted.
    complete: Measurements,
    /// Values of the file by its names (m) or (rad).
    given: BTreeMap<&'a str, f64>,
}

/// The measurements of a file as a table, and all its values by its names (m) or (rad).
fn table_of(rows: &SeamlyRows) -> (Measurements, BTreeMap<&str, f64>) {
    let mut table = Measurements::new();
    let mut given = BTreeMap::new();
    let impossible = rows.impossible.iter().flat_map(|out| &out.names);
    let impossible: BTreeSet<&String> = impossible.collect();
    for (theirs, number) in &rows.rows {
        let own = name_of(theirs);
        let quantity = quantity_of_measurement(&own);
        let si = match quantity {
            Quantity::Power(_) => number * rows.metres,
            Quantity::Angle => number.to_radians(),
        };
        given.entry(theirs.as_str()).or_insert(si);
        // Measurements that are not in the catalogue are lengths in a table.
        let is_length = quantity == LENGTH || is_angle(&own);
        let is_possible = !impossible.contains(theirs);
        let is_kept = *number != 0.0 && !table.contains(&own) && is_length && is_possible;
        if is_kept {
            // A name with other letters than a table may have becomes a variable.
            let _ = table.set(&own, si, Origin::Asked);
        }
    }
    (table, given)
}

/// A value of a file's measurement that becomes a variable, with the values of the other sizes.
fn in_sizes(usual: Number, value: f64, others: &[OtherSize<'_>], theirs: &str) -> Number {
    let differs = |other: &OtherSize<'_>| {
        let own = other.given.get(theirs).copied()?;
        ((own - value).abs() > 1e-12).then_some((other.id, own))
    };
    let sizes: Vec<(SizeId, f64)> = others.iter().filter_map(differs).collect();
    match sizes.is_empty() {
        true => usual,
        false => Number::PerSize {
            usual: Box::new(usual),
            sizes: sizes.into_iter().collect(),
        },
    }
}

/// Adds the base size and the others, which have the same measurements.
fn add_sizes(build: &mut Build, base: &str, table: Measurements, others: Vec<OtherSize<'_>>) {
    let mut taken = BTreeSet::new();
    let names: Vec<String> = table.iter().map(|(name, _)| name.to_owned()).collect();
    let id: SizeId = build.pattern.ids.take();
    build.pattern.base_size = Some(id);
    build.pattern.sizes.push(Arc::new(Size {
        id,
        name: part_name(base, &mut taken),
        measurements: table,
    }));
    for mut other in others {
        for name in &names {
            if let (false, Some(value)) = (other.table.contains(name), other.complete.get(name)) {
                let _ = other.table.set(name, value, Origin::Predicted);
            }
        }
        build.pattern.sizes.push(Arc::new(Size {
            id: other.id,
            name: part_name(other.name, &mut taken),
            measurements: other.table,
        }));
    }
}

fn quantity_of_measurement(own: &str) -> Quantity {
    match is_angle(own) || own.ends_with("_angle") {
        true => Quantity::Angle,
        false => LENGTH,
    }
}

/// Says which measurements were predicted, and which nothing is known of.
fn tell(
    build: &mut Build,
    (found, wanted): (Option<&Companion>, Option<String>),
    predicted: Vec<String>,
    unknown: Vec<String>,
) {
    let because = match (found, wanted) {
        (Some(companion), _) => format!("{} does not have them", companion.name),
        (None, Some(wanted)) => format!("the file {wanted} is not here"),
        (None, None) => "the pattern names no file of measurements".to_owned(),
    };
    if !predicted.is_empty() {
        build.guesses.push(Guess {
            what: "measurements",
            chosen: format!("{} of an average adult", listed(&predicted)),
            because: because.clone(),
            option: ReadOption::With,
        });
    }
    if !unknown.is_empty() {
        build.guesses.push(Guess {
            what: "unknown measurements",
            chosen: format!("10 cm or 0 degrees for {}", listed(&unknown)),
            because,
            option: ReadOption::With,
        });
    }
}

/// The first few of some names.
fn listed(names: &[String]) -> String {
    const SHOWN: usize = 8;
    match names.len() > SHOWN {
        false => names.join(", "),
        true => format!(
            "{} and {} more",
            names[..SHOWN].join(", "),
            names.len() - SHOWN
        ),
    }
}
