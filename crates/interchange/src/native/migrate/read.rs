//! Reads a pattern file of version 1: head, measurements, variables, fabrics, seams.

use super::super::item::{Item, Object};
use super::super::json::Value;
use super::super::units::UNITS;
use super::super::values::{fabric, measurements};
use super::document::{Number, Panel, Pattern, Seam, Size, Span, Variable};
use super::read_panel::panel;
use crate::FormatError;
use std::collections::BTreeSet;
use toile_pattern::{Diagnostic, DisplayUnit, nearest};

/// Reads the document of version 1 at the root of a file.
pub fn read(root: &Item<'_>, notes: &mut Vec<Diagnostic>) -> Result<Pattern, FormatError> {
    let mut reader = Reader {
        notes: Vec::new(),
        unit: DisplayUnit::default(),
        ids: Ids::default(),
    };
    let pattern = reader.pattern(root)?;
    notes.extend(reader.notes);
    Ok(pattern)
}

/// State of the reader.
pub struct Reader {
    pub notes: Vec<Diagnostic>,
    pub unit: DisplayUnit,
    pub ids: Ids,
}

/// Numbers given out so far, by kind. A number that a file leaves out is one more than that of the
/// part before.
#[derive(Default)]
pub struct Ids {
    next: [u32; 8],
    used: [BTreeSet<u32>; 8],
}

/// Kinds of part that version 1 counts.
#[derive(Clone, Copy)]
pub enum Kind {
    Panel,
    Point,
    Edge,
    Line,
    Dart,
    Notch,
    Seam,
    Fabric,
}

const KINDS: [&str; 8] = [
    "panel",
    "point",
    "edge",
    "internal line",
    "dart",
    "notch",
    "seam",
    "fabric",
];

impl Ids {
    /// The number of a part: the one that is written, else the next.
    pub fn take(
        &mut self,
        kind: Kind,
        written: Option<Item<'_>>,
        item: &Item<'_>,
    ) -> Result<u32, FormatError> {
        let slot = kind as usize;
        let id = match &written {
            Some(written) => written.count()?,
            None => self.next[slot],
        };
        if id == u32::MAX || !self.used[slot].insert(id) {
            return Err(written.as_ref().unwrap_or(item).error(
                format!("the id of {} {id} is taken", KINDS[slot]),
                "give it another id, or leave ids out",
            ));
        }
        self.next[slot] = id + 1;
        Ok(id)
    }
}

const HEAD: &[&str] = &[
    "toile",
    "kind",
    "name",
    "unit",
    "base_size",
    "sizes",
    "variables",
    "fabrics",
    "panels",
    "seams",
    "next_ids",
];

impl Reader {
    fn pattern(&mut self, root: &Item<'_>) -> Result<Pattern, FormatError> {
        let head = root.object(HEAD, &mut self.notes)?;
        if let Some(unit) = head.get("unit") {
            self.unit = unit.choice(UNITS)?;
        }
        let mut pattern = Pattern {
            name: head.need("name")?.text()?.to_owned(),
            unit: self.unit,
            ..Pattern::default()
        };
        if let Some(sizes) = head.get("sizes") {
            for (name, item) in sizes.entries()? {
                item.check_name(name)?;
                let measurements = measurements(&item, self.unit, &mut self.notes)?;
                pattern.sizes.push(Size {
                    name: name.to_owned(),
                    measurements,
                });
            }
        }
        if let Some(base) = head.get("base_size") {
            let name = base.text()?;
            if !pattern.sizes.iter().any(|size| size.name == name) {
                let near = nearest(name, pattern.sizes.iter().map(|size| &*size.name));
                return Err(unknown(&base, "size", name, near));
            }
            pattern.base_size = Some(name.to_owned());
        }
        if let Some(variables) = head.get("variables") {
            for (name, item) in variables.entries()? {
                item.check_name(name)?;
                pattern.variables.push(Variable {
                    name: name.to_owned(),
                    number: item.plain()?.into(),
                });
            }
        }
        if let Some(fabrics) = head.get("fabrics") {
            for (name, item) in fabrics.entries()? {
                let (id, mut fabric) = fabric(name, &item, &mut self.notes)?;
                fabric.id.0 = self.ids.take(Kind::Fabric, id, &item)?;
                pattern.fabrics.push(fabric);
            }
        }
        if let Some(panels) = head.get("panels") {
            for (name, item) in panels.entries()? {
                let panel = panel(self, &pattern, name, &item)?;
                pattern.panels.push(panel);
            }
        }
        if let Some(seams) = head.get("seams") {
            for item in seams.list()? {
                let seam = self.seam(&pattern, &item)?;
                pattern.seams.push(seam);
            }
        }
        Ok(pattern)
    }

    fn seam(&mut self, pattern: &Pattern, item: &Item<'_>) -> Result<Seam, FormatError> {
        let fields = item.object(
            &[
                "id",
                "name",
                "sides",
                "ease",
                "gathered",
                "right_sides_together",
                "multi_ply",
            ],
            &mut self.notes,
        )?;
        let sides: [Item<'_>; 2] = fields.need("sides")?.exactly()?;
        let mut chains = [Vec::new(), Vec::new()];
        for (chain, side) in chains.iter_mut().zip(&sides) {
            for item in side.list()? {
                chain.push(self.span(pattern, &item)?);
            }
        }
        Ok(Seam {
            id: self.ids.take(Kind::Seam, fields.get("id"), item)?,
            name: fields.need("name")?.name()?.to_owned(),
            sides: chains,
            ease: match fields.get("ease") {
                Some(ease) => ease.length(self.unit)?.into(),
                None => Number::ZERO,
            },
            gathered: fields.flag_or("gathered", false)?,
            right_sides_together: fields.flag_or("right_sides_together", true)?,
            multi_ply: fields.flag_or("multi_ply", false)?,
        })
    }

    /// A span: `"panel.edge"`, or an object with copy, half and fractions.
    fn span(&mut self, pattern: &Pattern, item: &Item<'_>) -> Result<Span, FormatError> {
        if let Value::Text(text) = &item.node.value {
            let (panel, edge) = dotted(pattern, item, text)?;
            return Ok(Span::whole(panel, edge));
        }
        let fields = item.object(
            &[
                "panel",
                "edge",
                "panel_id",
                "edge_id",
                "copy",
                "reflected",
                "from",
                "to",
            ],
            &mut self.notes,
        )?;
        let (panel, edge) = span_target(pattern, &fields)?;
        let fraction = |field: &str, default: f64| match fields.get(field) {
            Some(item) => item.plain().map(Number::from),
            None => Ok(default.into()),
        };
        Ok(Span {
            panel,
            edge,
            copy: fields.get("copy").map_or(Ok(0), |copy| copy.count())?,
            reflected: fields.flag_or("reflected", false)?,
            from: fraction("from", 0.0)?,
            to: fraction("to", 1.0)?,
        })
    }
}

/// A text saying that a name is not known.
pub fn unknown(item: &Item<'_>, kind: &str, name: &str, near: Option<&str>) -> FormatError {
    let shown: String = name.chars().take(80).collect();
    let hint = match near {
        Some(near) => format!("did you mean {near:?}?"),
        None => format!("name a {kind} of this file, or add it"),
    };
    item.error(format!("there is no {kind} {shown:?}"), hint)
}

fn named_panel<'p>(
    pattern: &'p Pattern,
    item: &Item<'_>,
    name: &str,
) -> Result<&'p Panel, FormatError> {
    let found = pattern.panels.iter().find(|panel| panel.name == name);
    found.ok_or_else(|| {
        let near = nearest(name, pattern.panels.iter().map(|panel| &*panel.name));
        unknown(item, "panel", name, near)
    })
}

fn named_edge(panel: &Panel, item: &Item<'_>, name: &str) -> Result<u32, FormatError> {
    let edge = panel.edge_named(name).map(|edge| edge.id);
    edge.ok_or_else(|| {
        let near = nearest(name, panel.edges().map(|edge| &*edge.name));
        let mut error = unknown(item, "edge", name, near);
        error.what.push_str(&format!(" in panel {:?}", panel.name));
        error
    })
}

fn dotted(pattern: &Pattern, item: &Item<'_>, text: &str) -> Result<(u32, u32), FormatError> {
    let Some((panel, edge)) = text.split_once('.') else {
        return Err(item.error(
            format!("{text:?} is not an edge"),
            "write panel.edge, for example \"front.side\"",
        ));
    };
    let panel = named_panel(pattern, item, panel)?;
    Ok((panel.id, named_edge(panel, item, edge)?))
}

fn span_target(pattern: &Pattern, fields: &Object<'_>) -> Result<(u32, u32), FormatError> {
    if let (Some(panel), Some(edge)) = (fields.get("panel_id"), fields.get("edge_id")) {
        return Ok((panel.count()?, edge.count()?));
    }
    let edge = fields.need("edge")?;
    match fields.get("panel") {
        Some(panel) => {
            let found = named_panel(pattern, &panel, panel.text()?)?;
            Ok((found.id, named_edge(found, &edge, edge.text()?)?))
        }
        None => dotted(pattern, &edge, edge.text()?),
    }
}
