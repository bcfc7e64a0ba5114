//! Fragments: parts of a pattern as data, to be pasted into the same pattern or another.

use super::impossible;
use super::numbers::numbers_of;
use crate::fields::NumberAddress;
use crate::{
    EditError, Entity, Evaluation, Fabric, Ids, Number, Panel, PartId, Pattern, PointRule, Seam,
    Sheet, SheetHead, SheetId, Source, Variable, VariableId, Want,
};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Tag field that marks data as a fragment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FragmentKind {
    /// The only value of the tag.
    #[default]
    Fragment,
}

/// Parts of a pattern, copied to be pasted. Everything that the parts need is included, except other parts
/// that only their formulas name.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Fragment {
    /// Tag that marks the data as a fragment.
    pub kind: FragmentKind,
    /// Name of the pattern that the parts were copied from.
    pub pattern: String,
    /// Sheets, each with its copied points and curves.
    pub sheets: Vec<Arc<Sheet>>,
    /// Sheets that were chosen as a whole: they are pasted as new sheets, not onto another sheet.
    #[serde(default)]
    pub whole_sheets: Vec<SheetId>,
    /// Panels.
    pub panels: Vec<Arc<Panel>>,
    /// Seams between these panels.
    pub seams: Vec<Arc<Seam>>,
    /// Variables.
    pub variables: Vec<Arc<Variable>>,
    /// Fabrics of the panels.
    pub fabrics: Vec<Arc<Fabric>>,
    /// Parts that formulas of the fragment name but that are not in the fragment.
    pub outside: Vec<Outside>,
    /// Values of the numbers whose formulas name parts that are not in the fragment.
    pub values: Vec<OutsideValue>,
}

/// A part that formulas of a fragment name but that is not in the fragment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outside {
    /// The part.
    pub part: PartId,
    /// Description of the part. `None`: the part was missing when the fragment was copied.
    pub words: Option<String>,
    /// Name of the part, if parts of its kind are found again by name alone, as sizes are.
    pub name: Option<String>,
}

/// Value of a number whose formula names parts that are not in the fragment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OutsideValue {
    /// Address of the number in the fragment.
    pub place: NumberAddress,
    /// Value of the number (m), (rad) or plain. `None`: it had no value.
    pub value: Option<f64>,
    /// Dimension of the value as a power of length: 0 plain, 1 a length.
    pub power: i8,
}

/// All parts that a number refers to.
pub(super) fn references(number: &Number) -> Vec<PartId> {
    let speaks = Variable {
        number: number.clone(),
        ..Variable::default()
    };
    Entity::Variable(Arc::new(speaks)).references()
}

/// Copies parts: points and curves, with all parts of their sheet that they are constructed from; panels,
/// with the curves that they follow; whole sheets; variables; and seams whose panels are all copied.
///
/// # Errors
/// No part is chosen, a part is missing, or a part can only be copied with its panel.
pub fn copy(evaluation: &Evaluation, parts: &[PartId]) -> Result<Fragment, EditError> {
    let pattern = evaluation.pattern();
    let chosen = closure(pattern, parts)?;
    if chosen.is_empty() {
        return Err(impossible(
            "there is nothing to copy",
            "choose points, curves or panels",
        ));
    }
    let mut fragment = Fragment {
        pattern: pattern.name.clone(),
        whole_sheets: parts.iter().filter_map(whole_sheet).collect(),
        ..Fragment::default()
    };
    for sheet in &pattern.sheets {
        let mut copied = (**sheet).clone();
        copied
            .points
            .retain(|point| chosen.contains(&point.id.into()));
        copied
            .curves
            .retain(|curve| chosen.contains(&curve.id.into()));
        let is_empty = copied.points.is_empty() && copied.curves.is_empty();
        if !is_empty || chosen.contains(&sheet.id.into()) {
            let on = copied.on.filter(|on| chosen.contains(&on.0.into()));
            if std::mem::replace(&mut copied.on, on) != on {
                lay_free(evaluation, &mut copied);
            }
            fragment.sheets.push(Arc::new(copied));
        }
    }
    let panels = pattern.panels.iter();
    fragment.panels = panels
        .filter(|panel| chosen.contains(&panel.id.into()))
        .cloned()
        .collect();
    let is_whole = |seam: &&Arc<Seam>| {
        let mut spans = seam.spans();
        spans.all(|span| chosen.contains(&span.panel.into()))
    };
    fragment.seams = pattern.seams.iter().filter(is_whole).cloned().collect();
    let variables = pattern.variables.iter();
    fragment.variables = variables
        .filter(|variable| chosen.contains(&variable.id.into()))
        .cloned()
        .collect();
    let is_used = |fabric: &&Arc<Fabric>| fragment.panels.iter().any(|p| p.fabric == fabric.id);
    fragment.fabrics = pattern.fabrics.iter().filter(is_used).cloned().collect();
    look_outside(evaluation, &mut fragment);
    Ok(fragment)
}

fn whole_sheet(part: &PartId) -> Option<SheetId> {
    SheetId::try_from(*part).ok()
}

/// Points placed at marks of a panel that is not copied get their current positions instead.
fn lay_free(evaluation: &Evaluation, sheet: &mut Sheet) {
    for point in &mut sheet.points {
        if let (PointRule::Mark { .. }, Some(at)) = (&point.rule, evaluation.point(point.id)) {
            Arc::make_mut(point).rule = PointRule::at(at.x, at.y);
        }
    }
}

/// Copies everything in a pattern except its sizes.
///
/// # Errors
/// The pattern has nothing to copy.
pub(super) fn copy_all(evaluation: &Evaluation) -> Result<Fragment, EditError> {
    let pattern = evaluation.pattern();
    let mut parts: Vec<PartId> = pattern.sheets.iter().map(|s| s.id.into()).collect();
    parts.extend(pattern.panels.iter().map(|panel| PartId::from(panel.id)));
    parts.extend(pattern.seams.iter().map(|seam| PartId::from(seam.id)));
    parts.extend(pattern.variables.iter().map(|v| PartId::from(v.id)));
    copy(evaluation, &parts)
}

/// The chosen parts, and the parts of their sheets that they depend on.
fn closure(pattern: &Pattern, parts: &[PartId]) -> Result<BTreeSet<PartId>, EditError> {
    let known: BTreeSet<PartId> = pattern.parts().into_iter().map(|(id, _)| id).collect();
    let mut chosen: BTreeSet<PartId> = BTreeSet::new();
    let mut open: Vec<PartId> = Vec::new();
    for &part in parts {
        if !known.contains(&part) {
            return Err(EditError::Missing(part.to_string()));
        }
        open.extend(seeds(pattern, part)?);
    }
    let sheets = |part: PartId| match part {
        PartId::Point(id) => pattern.point(id).map(|found| found.0.id),
        PartId::Curve(id) => pattern.curve(id).map(|found| found.0.id),
        PartId::Panel(id) => pattern.panel(id).and_then(|panel| pattern.sheet_of(panel)),
        PartId::Size(_)
        | PartId::Variable(_)
        | PartId::Fabric(_)
        | PartId::Sheet(_)
        | PartId::Line(_)
        | PartId::Edge(_)
        | PartId::Notch(_)
        | PartId::Operation(_)
        | PartId::Seam(_)
        | PartId::Marker(_)
        | PartId::Guide(_) => None,
    };
    while let Some(part) = open.pop() {
        if !chosen.insert(part) {
            continue;
        }
        // With a side of a split panel, the panel that was split is copied.
        if let PartId::Panel(id) = part
            && let Some(Source::Side { of, .. }) = pattern.panel(id).map(|panel| panel.source)
            && known.contains(&of.into())
        {
            open.extend(seeds(pattern, of.into())?);
        }
        // With a panel, the sheets that its operations insert are copied.
        if let PartId::Panel(id) = part {
            let steps = pattern
                .panel(id)
                .into_iter()
                .flat_map(|panel| &panel.operations);
            for sheet in steps.filter_map(|step| step.kind.sheet()) {
                open.extend(seeds(pattern, sheet.into())?);
            }
        }
        let (Some(sheet), Some(entity)) = (sheets(part), pattern.entity_with(part)) else {
            continue;
        };
        let is_drawn = |other: &PartId| matches!(other, PartId::Point(_) | PartId::Curve(_));
        let needs = entity.references().into_iter().filter(is_drawn);
        open.extend(needs.filter(|&other| sheets(other) == Some(sheet)));
    }
    // With a panel, its sheet is copied, even if all points of the sheet were removed.
    let own = chosen
        .iter()
        .filter(|part| matches!(part, PartId::Panel(_)));
    let own: Vec<PartId> = own
        .filter_map(|&panel| sheets(panel))
        .map(PartId::from)
        .collect();
    chosen.extend(own.into_iter().filter(|sheet| known.contains(sheet)));
    Ok(chosen)
}

/// The parts to copy if the part `part` is chosen.
fn seeds(pattern: &Pattern, part: PartId) -> Result<Vec<PartId>, EditError> {
    Ok(match part {
        PartId::Point(_)
        | PartId::Curve(_)
        | PartId::Panel(_)
        | PartId::Seam(_)
        | PartId::Variable(_) => vec![part],
        PartId::Sheet(id) => {
            let sheet = pattern.sheet(id);
            let mut all = vec![part];
            for sheet in sheet.into_iter() {
                all.extend(sheet.points.iter().map(|point| PartId::from(point.id)));
                all.extend(sheet.curves.iter().map(|curve| PartId::from(curve.id)));
            }
            // With a sheet, the panels traced from it are copied, as they are also moved and removed with it.
            let traced = pattern
                .panels
                .iter()
                .filter(|panel| panel.sheet() == Some(id));
            all.extend(traced.map(|panel| PartId::from(panel.id)));
            all
        }
        PartId::Line(_) | PartId::Edge(_) => {
            let lines = pattern.panels.iter().flat_map(|panel| &panel.lines);
            let edges = lines.flat_map(|line| line.edges.iter().map(move |edge| (line.id, edge)));
            let own = edges.filter(|(line, edge)| [(*line).into(), edge.id.into()].contains(&part));
            own.map(|(_, edge)| edge.curve.into()).collect()
        }
        PartId::Notch(_)
        | PartId::Operation(_)
        | PartId::Size(_)
        | PartId::Fabric(_)
        | PartId::Marker(_) => {
            return Err(impossible(
                format!("{part} is not copied by itself"),
                "copy its panel, or points and curves",
            ));
        }
        PartId::Guide(id) => {
            let words = pattern.guide_words(id).unwrap_or_else(|| part.to_string());
            return Err(impossible(
                format!("{words} is not copied"),
                "drag another out of the ruler",
            ));
        }
    })
}

/// Records the parts outside a fragment that its numbers name, and the current values of these numbers.
fn look_outside(evaluation: &Evaluation, fragment: &mut Fragment) {
    let pattern = evaluation.pattern();
    let places = pattern.parts();
    let own = fragment.as_pattern();
    let mine: BTreeSet<PartId> = own.parts().into_iter().map(|(id, _)| id).collect();
    let mut outside: BTreeSet<PartId> = BTreeSet::new();
    for &part in &mine {
        for entry in numbers_of(evaluation, part) {
            let Some(number) = entry.number else { continue };
            let found = references(&number).into_iter();
            let found: Vec<PartId> = found.filter(|id| !mine.contains(id)).collect();
            let only_sizes = found.iter().all(|id| matches!(id, PartId::Size(_)));
            outside.extend(found);
            if only_sizes {
                continue;
            }
            let (value, power) = match VariableId::try_from(entry.place.part) {
                Ok(id) => match evaluation.variable(id) {
                    Some((value, power)) => (Some(value), power),
                    None => (None, 0),
                },
                Err(_) => (
                    evaluation.number(&number, entry.want),
                    i8::from(entry.want == Want::Length),
                ),
            };
            fragment.values.push(OutsideValue {
                place: entry.place,
                value,
                power,
            });
        }
    }
    let told = outside.into_iter().map(|part| {
        let place = places.iter().find(|(id, _)| *id == part);
        let size = pattern
            .sizes
            .iter()
            .find(|size| PartId::from(size.id) == part);
        Outside {
            part,
            words: place.map(|(_, place)| pattern.describe(place)),
            name: size.map(|size| size.name.clone()),
        }
    });
    fragment.outside = told.collect();
}

impl Fragment {
    /// The fragment as a pattern; its id counter is such that no id in it is given again.
    pub(super) fn as_pattern(&self) -> Pattern {
        Pattern {
            sheets: self.sheets.clone(),
            panels: self.panels.clone(),
            seams: self.seams.clone(),
            variables: self.variables.clone(),
            fabrics: self.fabrics.clone(),
            ids: Ids { next: u32::MAX },
            ..Pattern::new(self.pattern.clone())
        }
    }

    /// The entities that put the whole fragment into an empty pattern, in order.
    pub(super) fn entities(&self) -> Vec<Entity> {
        let mut all: Vec<Entity> = Vec::new();
        all.extend(self.fabrics.iter().cloned().map(Entity::Fabric));
        all.extend(self.variables.iter().cloned().map(Entity::Variable));
        for sheet in &self.sheets {
            all.push(Entity::Sheet(SheetHead {
                id: sheet.id,
                name: sheet.name.clone(),
                on: sheet.on,
                on_table: sheet.on_table,
            }));
            let points = sheet.points.iter().cloned();
            all.extend(points.map(|point| Entity::Point(sheet.id, point)));
            let curves = sheet.curves.iter().cloned();
            all.extend(curves.map(|curve| Entity::Curve(sheet.id, curve)));
        }
        all.extend(self.panels.iter().cloned().map(Entity::Panel));
        all.extend(self.seams.iter().cloned().map(Entity::Seam));
        all
    }
}
