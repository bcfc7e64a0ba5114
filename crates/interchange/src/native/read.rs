//! Reads a pattern file: the document's head, measurements, variables, fabrics, seams.

use super::item::{Item, Object};
use super::json::{self, Value};
use super::read_panel::panel;
use super::units::UNITS;
use super::words::VERSION;
use crate::FormatError;
use std::collections::BTreeSet;
use std::sync::Arc;
use toile_measure::{Measurements, Origin, UnitKind, definition};
use toile_pattern::{
    Diagnostic, DisplayUnit, EdgeId, Fabric, IdCounters, Number, Panel, PanelId, Pattern, Rheology,
    Seam, Size, Span, Variable, nearest,
};

/// Reads a pattern in the native format (`*.toile.json`).
///
/// Fields this version does not know are named in the diagnostics; everything else that is not
/// understood is refused with its line, column, path and remedy.
///
/// # Errors
/// The text is not JSON, not a pattern of this version, or refers to parts it does not have.
pub fn read_pattern(text: &str) -> Result<(Pattern, Vec<Diagnostic>), FormatError> {
    let node = json::parse(text)?;
    let root = Item::root(&node);
    let mut reader = Reader {
        notes: Vec::new(),
        unit: DisplayUnit::default(),
        ids: Ids::default(),
    };
    let pattern = reader.pattern(&root)?;
    Ok((pattern, reader.notes))
}

/// What is known while reading.
pub struct Reader {
    pub notes: Vec<Diagnostic>,
    pub unit: DisplayUnit,
    pub ids: Ids,
}

/// Ids given out so far. An id that a file leaves out is one more than that of the part before.
#[derive(Default)]
pub struct Ids {
    next: IdCounters,
    highest: IdCounters,
    used: [BTreeSet<u32>; 8],
}

macro_rules! id_readers {
    ($($method:ident $field:ident $kind:ident $slot:literal),* $(,)?) => {
        impl Ids {
            $(
                pub fn $method(
                    &mut self,
                    written: Option<Item<'_>>,
                    item: &Item<'_>,
                ) -> Result<toile_pattern::$kind, FormatError> {
                    let id = match &written {
                        Some(written) => written.count()?,
                        None => self.next.$field,
                    };
                    let named = toile_pattern::$kind(id);
                    if id == u32::MAX || !self.used[$slot].insert(id) {
                        return Err(written.as_ref().unwrap_or(item).error(
                            format!("the id of {named} is taken"),
                            "give it another id, or leave ids out",
                        ));
                    }
                    self.next.$field = id + 1;
                    self.highest.$field = self.highest.$field.max(id + 1);
                    Ok(named)
                }
            )*
        }
    };
}

id_readers! {
    panel panel PanelId 0,
    point point PointId 1,
    edge edge EdgeId 2,
    internal_line internal_line InternalLineId 3,
    dart dart DartId 4,
    notch notch NotchId 5,
    seam seam SeamId 6,
    fabric fabric FabricId 7,
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
        check_kind(root)?;
        let head = root.object(HEAD, &mut self.notes)?;
        if let Some(unit) = head.get("unit") {
            self.unit = unit.choice(UNITS)?;
        }
        let mut pattern = Pattern::new(head.need("name")?.text()?);
        pattern.unit = self.unit;
        if let Some(sizes) = head.get("sizes") {
            for (name, item) in sizes.entries()? {
                item.check_name(name)?;
                let measurements = self.measurements(&item)?;
                pattern.sizes.push(Size {
                    name: name.to_owned(),
                    measurements,
                });
            }
        }
        if let Some(base) = head.get("base_size") {
            let name = base.text()?;
            if pattern.size(name).is_none() {
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
                    number: item.plain()?,
                });
            }
        }
        if let Some(fabrics) = head.get("fabrics") {
            for (name, item) in fabrics.entries()? {
                let fabric = self.fabric(name, &item)?;
                pattern.fabrics.push(Arc::new(fabric));
            }
        }
        if let Some(panels) = head.get("panels") {
            for (name, item) in panels.entries()? {
                let panel = panel(self, &pattern, name, &item)?;
                pattern.panels.push(Arc::new(panel));
            }
        }
        if let Some(seams) = head.get("seams") {
            for item in seams.list()? {
                let seam = self.seam(&pattern, &item)?;
                pattern.seams.push(Arc::new(seam));
            }
        }
        pattern.ids = self.counters(head.get("next_ids"))?;
        Ok(pattern)
    }

    fn measurements(&mut self, item: &Item<'_>) -> Result<Measurements, FormatError> {
        let mut table = Measurements::new();
        for (name, entry) in item.entries()? {
            let predicted = match &entry.node.value {
                Value::Object(fields) => fields.iter().any(|(name, _)| name == "predicted"),
                _ => false,
            };
            let (entry, origin) = if predicted {
                let fields = entry.object(&["predicted"], &mut self.notes)?;
                (fields.need("predicted")?, Origin::Predicted)
            } else {
                (entry, Origin::Asked)
            };
            let is_angle = definition(name).is_some_and(|known| known.kind == UnitKind::Angle);
            let number = if is_angle {
                entry.angle()?
            } else {
                entry.length(self.unit)?
            };
            let value = entry.fixed(number)?;
            if table.contains(name) {
                return Err(entry.error(
                    format!("the measurement {name:?} is given twice, once under another name"),
                    "remove one of them",
                ));
            }
            table
                .set(name, value, origin)
                .map_err(|error| entry.error(error.to_string(), "change it"))?;
        }
        Ok(table)
    }

    fn fabric(&mut self, name: &str, item: &Item<'_>) -> Result<Fabric, FormatError> {
        item.check_name(name)?;
        let fields = item.object(
            &[
                "id",
                "density_kg_per_m2",
                "thickness_m",
                "stretch_N_per_m",
                "shear_N_per_m",
                "poisson",
                "bend_N_m",
                "friction",
                "width_m",
                "nap",
                "colour",
                "hardening",
                "viscosity_N_s_per_m",
                "bend_viscosity_N_m_s",
                "kept",
                "relaxation_time_s",
            ],
            &mut self.notes,
        )?;
        let value = |field: &str| fields.need(field)?.plain_value();
        let usual = Rheology::default();
        let or = |field: &str, usual| fields.get(field).map_or(Ok(usual), |v| v.plain_value());
        let pair_or = |field: &str, usual| fields.get(field).map_or(Ok(usual), |v| values(&v));
        let rheology = Rheology {
            hardening: pair_or("hardening", usual.hardening)?,
            viscosity: or("viscosity_N_s_per_m", usual.viscosity)?,
            bend_viscosity: or("bend_viscosity_N_m_s", usual.bend_viscosity)?,
            kept: pair_or("kept", usual.kept)?,
            relaxation_time: or("relaxation_time_s", usual.relaxation_time)?,
        };
        Ok(Fabric {
            id: self.ids.fabric(fields.get("id"), item)?,
            name: name.to_owned(),
            density: value("density_kg_per_m2")?,
            thickness: value("thickness_m")?,
            stretch: values(&fields.need("stretch_N_per_m")?)?,
            shear: value("shear_N_per_m")?,
            poisson: value("poisson")?,
            bend: values(&fields.need("bend_N_m")?)?,
            friction: value("friction")?,
            width: value("width_m")?,
            nap: fields.flag_or("nap", false)?,
            colour: match fields.get("colour") {
                Some(colour) => values(&colour)?,
                None => [0.8, 0.8, 0.8],
            },
            rheology,
        })
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
            id: self.ids.seam(fields.get("id"), item)?,
            name: fields.need("name")?.name()?.to_owned(),
            sides: chains,
            ease: match fields.get("ease") {
                Some(ease) => ease.length(self.unit)?,
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
            Some(item) => item.plain(),
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

    fn counters(&mut self, written: Option<Item<'_>>) -> Result<IdCounters, FormatError> {
        let mut counters = self.ids.highest;
        let Some(item) = written else {
            return Ok(counters);
        };
        let fields = item.object(
            &[
                "panel", "point", "edge", "line", "dart", "notch", "seam", "fabric",
            ],
            &mut self.notes,
        )?;
        let raise = |field: &str, counter: &mut u32| -> Result<(), FormatError> {
            if let Some(item) = fields.get(field) {
                *counter = (*counter).max(item.count()?);
            }
            Ok(())
        };
        raise("panel", &mut counters.panel)?;
        raise("point", &mut counters.point)?;
        raise("edge", &mut counters.edge)?;
        raise("line", &mut counters.internal_line)?;
        raise("dart", &mut counters.dart)?;
        raise("notch", &mut counters.notch)?;
        raise("seam", &mut counters.seam)?;
        raise("fabric", &mut counters.fabric)?;
        Ok(counters)
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

/// Refuses files that are not patterns, or of a later version.
fn check_kind(root: &Item<'_>) -> Result<(), FormatError> {
    let object = root.object(HEAD, &mut Vec::new())?;
    let Some(version) = object.get("toile") else {
        return Err(root.error(
            "the file does not say that it is one of Toile's",
            "its first field is \"toile\": 1; for other formats name the format",
        ));
    };
    let number = version.count()?;
    if number == 0 || number > VERSION {
        return Err(version.error(
            format!("the file is of version {number}, this program reads up to {VERSION}"),
            "use a newer program, or save the file for this version",
        ));
    }
    let kind = object.need("kind")?;
    if kind.text()? != "pattern" {
        return Err(kind.error(
            format!("the file holds a {:?}", kind.text()?),
            "give a file of kind \"pattern\"",
        ));
    }
    Ok(())
}

fn values<const N: usize>(item: &Item<'_>) -> Result<[f64; N], FormatError> {
    let items: [Item<'_>; N] = item.exactly()?;
    let mut result = [0.0; N];
    for (value, item) in result.iter_mut().zip(&items) {
        *value = item.plain_value()?;
    }
    Ok(result)
}

fn named_panel<'p>(
    pattern: &'p Pattern,
    item: &Item<'_>,
    name: &str,
) -> Result<&'p Panel, FormatError> {
    pattern.panel_named(name).ok_or_else(|| {
        let near = nearest(name, pattern.panels.iter().map(|panel| &*panel.name));
        unknown(item, "panel", name, near)
    })
}

fn named_edge(panel: &Panel, item: &Item<'_>, name: &str) -> Result<EdgeId, FormatError> {
    let edge = panel.edge_named(name).map(|edge| edge.id);
    edge.ok_or_else(|| {
        let near = nearest(name, panel.edges().map(|edge| &*edge.name));
        let mut error = unknown(item, "edge", name, near);
        error.what.push_str(&format!(" in panel {:?}", panel.name));
        error
    })
}

fn dotted(
    pattern: &Pattern,
    item: &Item<'_>,
    text: &str,
) -> Result<(PanelId, EdgeId), FormatError> {
    let Some((panel, edge)) = text.split_once('.') else {
        return Err(item.error(
            format!("{text:?} is not an edge"),
            "write panel.edge, for example \"front.side\"",
        ));
    };
    let panel = named_panel(pattern, item, panel)?;
    Ok((panel.id, named_edge(panel, item, edge)?))
}

fn span_target(pattern: &Pattern, fields: &Object<'_>) -> Result<(PanelId, EdgeId), FormatError> {
    if let (Some(panel), Some(edge)) = (fields.get("panel_id"), fields.get("edge_id")) {
        return Ok((PanelId(panel.count()?), EdgeId(edge.count()?)));
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
