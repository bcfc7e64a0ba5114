//! Files of this program come back: panels whose lines are as they were written keep construction and formulas,
//! those that were edited come in as drawn.

use super::drawing::Drawing;
use super::kinds::{LineKind, NAMESPACE};
use super::likeness::{Outlines, are_alike};
use super::reading::{SvgReading, sew_line_guess};
use super::scale::Scale;
use super::shape::path;
use super::{layers, plain};
use crate::drawn::builder::add_pieces;
use crate::native::PatternFile;
use crate::xml::Xml;
use crate::{FormatError, Loss, ReadOptions, read_document};
use roxmltree::Node;
use std::sync::Arc;
use toile_geometry::Vec2;
use toile_pattern::{Panel, PanelId, Pattern};

/// Ways that are shorter are no move (mm).
const STAYS: f64 = 0.01;

/// The contents of the metadata in a file of this program.
#[derive(Debug)]
pub(super) struct Written {
    file: PatternFile,
    size: Option<String>,
    panels: Vec<WrittenPanel>,
}

/// The lines of a panel as they were written (mm, y down).
#[derive(Debug)]
struct WrittenPanel {
    name: String,
    lines: Outlines,
}

/// The fate of a panel in the drawing.
enum Found {
    /// It is as it was written, moved by a way (mm, y down).
    AsWritten(Vec2),
    /// It was edited, in this group.
    Edited(usize),
    /// The drawing does not show it.
    Gone,
}

/// Reads the contents that this program wrote into the metadata; `None` for files of others.
///
/// # Errors
/// The document there is damaged: its fault, place and remedy.
pub(super) fn written(xml: &Xml<'_>) -> Result<Option<Written>, FormatError> {
    let is = |node: &Node<'_, '_>, name: &str| {
        node.tag_name().name() == name && node.tag_name().namespace() == Some(NAMESPACE)
    };
    let Some(root) = xml.elements().find(|node| is(node, "pattern")) else {
        return Ok(None);
    };
    let Some(document) = root.children().find(|node| is(node, "document")) else {
        return Ok(None);
    };
    let text: String = document.children().filter_map(|node| node.text()).collect();
    let file = read_document(&text).map_err(|error| {
        FormatError::new(
            format!(
                "the metadata, from line {}: {}",
                xml.line(document),
                error.place
            ),
            error.what,
            format!(
                "{}; or take <metadata> out, and the drawing is read as drawn",
                error.hint
            ),
        )
    })?;
    let panels = root.children().filter(|node| is(node, "panel"));
    let panels = panels.map(|panel| {
        let mut lines = Outlines::default();
        for node in panel.children().filter(|node| is(node, "path")) {
            let kind = node
                .attribute("kind")
                .and_then(|word| LineKind::of(word, None));
            if let (Some(kind), Some(text)) = (kind, node.attribute("d")) {
                lines.add(Some(kind), &path(text).lines);
            }
        }
        WrittenPanel {
            name: panel.attribute("name").unwrap_or_default().to_owned(),
            lines,
        }
    });
    Ok(Some(Written {
        file,
        size: root.attribute("size").map(str::to_owned),
        panels: panels.collect(),
    }))
}

/// The pattern of a file of this program.
///
/// # Errors
/// Answers to questions that such a file leaves not open; more closed lines than a pattern has pieces.
pub(super) fn read(
    drawing: &Drawing,
    (written, scale): (Written, &Scale),
    options: &ReadOptions,
    mut losses: Vec<Loss>,
) -> Result<SvgReading, FormatError> {
    let unused = [
        ("--unit", options.unit.is_some()),
        ("--inside", options.allowance_inside.is_some()),
    ];
    if let Some((option, _)) = unused.into_iter().find(|(_, is_given)| *is_given) {
        return Err(FormatError::new(
            "the options",
            format!("{option} is given, which SVG files of Toile say themselves"),
            format!("leave {option} out"),
        ));
    }
    let unit = scale.metres(None, 0.0).0;
    let Written { file, size, panels } = written;
    let mut pattern = file.pattern;
    let mut notes: Vec<String> = file.notes.iter().map(ToString::to_string).collect();
    let groups = layers::groups(drawing);
    let mut taken = Vec::new();
    let mut edited: Vec<(PanelId, usize)> = Vec::new();
    for panel in &panels {
        let Some(id) = pattern.panel_named(&panel.name).map(|panel| panel.id) else {
            continue;
        };
        let own: Vec<usize> = groups
            .iter()
            .copied()
            .filter(|&group| drawing.groups[group].panel.as_deref() == Some(&panel.name))
            .collect();
        let (found, group) = found(drawing, (panel, unit), &own);
        taken.extend(group);
        match found {
            Found::AsWritten(by) if by.norm() > STAYS => {
                notes.push(format!(
                    "{}: it was moved in the drawing, and keeps its construction",
                    panel.name
                ));
                moved(&mut pattern, id, Vec2::new(by.x, -by.y) * 1e-3);
            }
            Found::AsWritten(_) => {}
            Found::Edited(group) => edited.push((id, group)),
            Found::Gone => notes.push(format!(
                "{}: the drawing does not show it; the panel stays as it was",
                panel.name
            )),
        }
    }
    let mut pieces = Vec::new();
    let mut replaced = Vec::new();
    for (id, group) in edited {
        match layers::piece(drawing, group, &mut losses) {
            Some(piece) => {
                replaced.push(Some(id));
                pieces.push(piece);
            }
            None => notes.push(format!(
                "{}: it has no closed outline in the drawing; the panel stays as it was",
                pattern.panel(id).map_or("a panel", |panel| &panel.name)
            )),
        }
    }
    // Copies of layers, and what was drawn beside the panels.
    for &group in groups.iter().filter(|group| !taken.contains(group)) {
        if let Some(piece) = layers::new_piece(drawing, group, &mut losses) {
            replaced.push(None);
            pieces.push(piece);
        }
    }
    let rest = beside(drawing, &groups);
    for piece in plain::pieces(&rest, (unit, scale.page), &mut losses)? {
        replaced.push(None);
        pieces.push(piece);
    }
    let mut drawn = Vec::new();
    for piece in &pieces {
        let (piece, lost) = piece.drawn(unit, None);
        drawn.push(piece);
        losses.extend(lost);
    }
    let guesses = sew_line_guess(&pieces, options).into_iter().collect();
    let first = pattern.panels.len();
    losses.extend(add_pieces(&mut pattern, &drawn));
    let new: Vec<PanelId> = pattern.panels[first..]
        .iter()
        .map(|panel| panel.id)
        .collect();
    for (new, old) in new.into_iter().zip(replaced) {
        match old {
            Some(old) => take_place(&mut pattern, (new, old), size.as_deref(), &mut losses),
            None => {
                let name = pattern.panel(new).map_or("", |panel| &panel.name);
                notes.push(format!(
                    "{name}: it is new in the drawing, and comes in as drawn"
                ));
            }
        }
    }
    Ok(SvgReading {
        pattern,
        fitting: file.fitting,
        guesses,
        losses,
        notes,
    })
}

/// The fate of a panel, and the group that shows it.
fn found(
    drawing: &Drawing,
    (panel, unit): (&WrittenPanel, f64),
    groups: &[usize],
) -> (Found, Option<usize>) {
    let mut shown = None;
    for &group in groups {
        let mut lines = Outlines::default();
        for line in &drawing.lines {
            let element = drawing.element(line);
            if drawing.is_within(element.group, group) {
                let in_mm = line.shape.mapped(|p| p * (unit * 1e3));
                lines.add(element.kind, &[in_mm]);
            }
        }
        if lines.is_empty() {
            continue;
        }
        if let Some(by) = are_alike(&panel.lines, &lines) {
            return (Found::AsWritten(by), Some(group));
        }
        shown = shown.or(Some(group));
    }
    match shown {
        Some(group) => (Found::Edited(group), Some(group)),
        None => (Found::Gone, None),
    }
}

/// The lines and words that stand in none of the groups of panels.
fn beside(drawing: &Drawing, groups: &[usize]) -> Drawing {
    let mut rest = drawing.clone();
    let is_free = |group: usize| !groups.iter().any(|&own| drawing.is_within(group, own));
    rest.lines
        .retain(|line| is_free(drawing.element(line).group));
    rest.texts.retain(|text| is_free(text.group));
    rest
}

/// Moves a panel on the table (m).
fn moved(pattern: &mut Pattern, id: PanelId, by: Vec2) {
    if let Some(panel) = pattern.panels.iter_mut().find(|panel| panel.id == id) {
        let panel = Arc::make_mut(panel);
        let before = panel.on_table.map_or(Vec2::zeros(), Vec2::from);
        panel.on_table = Some((before + by).into());
    }
}

/// Puts a panel as drawn in the place of one that was edited.
fn take_place(
    pattern: &mut Pattern,
    (new, old): (PanelId, PanelId),
    size: Option<&str>,
    losses: &mut Vec<Loss>,
) {
    let place = |pattern: &Pattern, id| pattern.panels.iter().position(|panel| panel.id == id);
    let Some(from) = place(pattern, new) else {
        return;
    };
    let drawn = pattern.panels.remove(from);
    let Some(to) = place(pattern, old) else {
        return;
    };
    let before = pattern.panels[to].clone();
    let Panel {
        id,
        name,
        source: _,
        lines: _,
        notches: _,
        operations: _,
        grain: _,
        allowance: _,
        cut,
        fabric,
        worn,
        on_table: _,
    } = &*before;
    pattern.panels[to] = Arc::new(Panel {
        id: *id,
        name: name.clone(),
        cut: *cut,
        fabric: *fabric,
        worn: worn.clone(),
        ..(*drawn).clone()
    });
    let why = match size {
        Some(size) => format!("it was edited in the drawing, and comes in as drawn in size {size}"),
        None => "it was edited in the drawing, and comes in as drawn".to_owned(),
    };
    losses.push(Loss::at(
        name,
        "construction and formulas of the panel",
        why,
    ));
    let seams = pattern.seams.len();
    pattern.seams.retain(|seam| {
        let spans = seam.sides.iter().flatten();
        !spans.map(|span| span.panel).any(|panel| panel == *id)
    });
    let lost = seams - pattern.seams.len();
    if lost > 0 {
        losses.push(Loss {
            count: lost,
            ..Loss::at(
                name,
                "seams of the panel",
                "they name edges that it had before it was edited",
            )
        });
    }
}
