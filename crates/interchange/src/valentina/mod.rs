//! Patterns of Valentina (.val) and Seamly2D (.sm2d): their tools become constructions, their formulas ours.
//!
//! Lengths there are in the unit of the file, y points down, angles are in degrees counter-clockwise as seen.
//! Each tool is read twice at once: as a construction of the document, and as a place for the base size. Where
//! the document gives another place than the tool has, the place is kept as it is, and said.
//!
//! # Decided with
//! - [`crate::valentina::expression::Expression`], [`crate::valentina::translate`]: formulas read, written in
//!   ours;
//! - [`crate::valentina::variables`]: measurements and increments;
//! - [`crate::valentina::points`]: tools that place points;
//! - [`crate::valentina::nodes`], [`crate::valentina::pieces`]: outlines, panels.

mod build;
mod calculation;
mod contacts;
mod curves;
mod cuts;
mod expression;
mod joined_pieces;
mod kinds;
mod loops;
mod nodes;
mod operations;
mod pieces;
mod points;
mod quantities;
mod rounds;
mod sizes;
mod splines;
mod things;
mod translate;
mod variables;
mod verify;
mod versions;

#[cfg(test)]
mod tests;

use crate::FormatError;
use crate::exchange::{Companion, Guess, Loss};
use crate::part_names::part_name;
use crate::xml::Xml;
use build::Build;
use kinds::FileUnit;
use roxmltree::Node;
use std::collections::BTreeSet;
use std::sync::Arc;
use toile_pattern::{DisplayUnit, Fabric, FabricId, Pattern};

/// Largest number of elements in a file.
const MAX_ELEMENTS: usize = 200_000;
/// Advice on a damaged file.
const REMEDY: &str = "save the pattern again with the program that wrote it";

/// A pattern that was read.
pub(crate) struct ValentinaReading {
    pub pattern: Pattern,
    pub guesses: Vec<Guess>,
    pub losses: Vec<Loss>,
    pub notes: Vec<String>,
}

/// The name of the measurement file that a pattern names, with its folders.
pub(crate) fn measurement_file(text: &str) -> Option<String> {
    variables::measurement_file(&Xml::read(text, REMEDY).ok()?)
}

/// Reads a pattern. Companions are its file of measurements.
///
/// # Errors
/// Damaged XML, a file that is no pattern, or a damaged file of measurements: the fault, its place and a
/// remedy.
pub(crate) fn read_valentina(
    text: &str,
    companions: &[Companion],
) -> Result<ValentinaReading, FormatError> {
    let xml = Xml::read(text, REMEDY)?;
    if xml.elements().count() > MAX_ELEMENTS {
        let what = format!("it has more than {MAX_ELEMENTS} elements");
        return Err(FormatError::new("the whole file", what, REMEDY));
    }
    let root = xml.root();
    if !root.has_tag_name("pattern") {
        let what = format!("its root is <{}>, not <pattern>", root.tag_name().name());
        let hint = "give a .val or .sm2d file; measurements go to --with";
        return Err(FormatError::new("the whole file", what, hint));
    }
    let word = text_of(root, "unit").unwrap_or("cm");
    let unit = FileUnit::of(word).ok_or_else(|| {
        let what = format!("{word:?} is no unit of patterns");
        FormatError::new("unit", what, "save the file in mm, cm or inch")
    })?;
    let mut build = Build::new(unit);
    build.pattern.unit = match unit.word {
        "mm" => DisplayUnit::Millimetre,
        "in" => DisplayUnit::Inch,
        _ => DisplayUnit::Centimetre,
    };
    versions::read(&mut build, root);
    variables::read(&mut build, &xml, companions)?;
    let fabric: FabricId = build.pattern.ids.take();
    build.pattern.fabrics.push(Arc::new(Fabric::poplin(fabric)));
    let (mut sheets, mut panels) = (BTreeSet::new(), BTreeSet::new());
    let modeling = pieces::modeling(root);
    let drawings = root
        .children()
        .filter(|node| node.has_tag_name("draw") || node.has_tag_name("draftBlock"));
    for drawing in drawings {
        let name = drawing.attribute("name").unwrap_or("draft");
        build.add_sheet(part_name(name, &mut sheets));
        for calculation in drawing
            .children()
            .filter(|node| node.has_tag_name("calculation"))
        {
            calculation::read(&mut build, &xml, calculation);
        }
        joined_pieces::read(&mut build, &xml, drawing, &modeling);
        pieces::read(&mut build, &xml, drawing, (&modeling, fabric), &mut panels);
    }
    if build.sheets.is_empty() {
        let what = "this pattern of Valentina or Seamly2D has no drawing";
        return Err(FormatError::new("the whole file", what, REMEDY));
    }
    left_aside(&mut build, &xml);
    Ok(done(build))
}

fn text_of<'a>(node: Node<'a, '_>, tag: &str) -> Option<&'a str> {
    let child = node.children().find(|child| child.has_tag_name(tag))?;
    child.text().map(str::trim).filter(|text| !text.is_empty())
}

/// Says which contents of the whole file have no counterpart.
fn left_aside(build: &mut Build, xml: &Xml<'_>) {
    for (tag, what) in [
        ("group", "groups of objects"),
        ("finalMeasurment", "final measurements"),
        ("backgroudImage", "background images"),
    ] {
        let all = xml.elements().filter(|node| node.has_tag_name(tag));
        let count = all.count();
        if count > 0 {
            build.losses.push(Loss {
                what: what.to_owned(),
                place: "the whole file".to_owned(),
                count,
                why: "patterns here have none".to_owned(),
            });
        }
    }
}

fn done(mut build: Build) -> ValentinaReading {
    let sheets = std::mem::take(&mut build.sheets);
    let sheets = sheets.into_iter().map(|own| Arc::new(own.sheet));
    build.pattern.sheets.extend(sheets);
    verify::verify(&mut build);
    ValentinaReading {
        pattern: build.pattern,
        guesses: build.guesses,
        losses: build.losses,
        notes: build.notes,
    }
}
