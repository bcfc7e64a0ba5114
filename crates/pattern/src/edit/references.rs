//! References: the parts that each part refers to.

use super::Entity;
use crate::{
    CornerName, LineName, Mark, Marker, Name, Names, Number, Panel, PartId, Pattern, Place,
    PointRule, Source, Span,
};
use std::collections::BTreeSet;

impl Entity {
    /// Every part it refers to.
    pub fn references(&self) -> Vec<PartId> {
        let mut found = Vec::new();
        match self {
            Self::Head(head) => found.extend(head.base_size.map(PartId::from)),
            Self::Size(_) | Self::Fabric(_) | Self::Guide(_) => {}
            Self::Variable(variable) => number(&variable.number, &mut found),
            Self::Sheet(sheet) => {
                if let Some((panel, after)) = sheet.on {
                    found.push(panel.into());
                    found.extend(after.map(PartId::from));
                }
            }
            Self::Point(sheet, point) => {
                found.push((*sheet).into());
                found.extend(point.rule.points().into_iter().map(PartId::from));
                found.extend(point.rule.curves().into_iter().map(PartId::from));
                if let PointRule::Mark { line: on, at } = &point.rule {
                    line(*on, &mut found);
                    mark(at, &mut found);
                }
                point
                    .rule
                    .numbers()
                    .into_iter()
                    .for_each(|n| number(n, &mut found));
            }
            Self::Curve(sheet, curve) => {
                found.push((*sheet).into());
                found.extend(curve.ends.map(PartId::from));
                found.extend(curve.rule.points().into_iter().map(PartId::from));
                found.extend(curve.rule.curve().map(PartId::from));
                curve
                    .rule
                    .number()
                    .into_iter()
                    .for_each(|n| number(n, &mut found));
            }
            Self::Panel(panel) => panel_references(panel, &mut found),
            Self::Seam(seam) => {
                number(&seam.ease, &mut found);
                for span in seam.spans() {
                    span_references(span, &mut found);
                }
            }
            Self::Marker(marker) => marker_references(marker, &mut found),
        }
        found
    }

    /// Every number it has.
    pub(crate) fn numbers(&self) -> Vec<&Number> {
        match self {
            Self::Head(_)
            | Self::Size(_)
            | Self::Fabric(_)
            | Self::Sheet(_)
            | Self::Marker(_)
            | Self::Guide(_) => Vec::new(),
            Self::Variable(variable) => vec![&variable.number],
            Self::Point(_, point) => point.rule.numbers(),
            Self::Curve(_, curve) => curve.rule.number().into_iter().collect(),
            Self::Panel(panel) => panel.numbers(),
            Self::Seam(seam) => seam.numbers(),
        }
    }
}

fn number(number: &Number, found: &mut Vec<PartId>) {
    if let Number::PerSize { sizes, .. } = number {
        found.extend(sizes.iter().map(|(size, _)| PartId::from(*size)));
    }
    if let Some(formula) = number.as_formula() {
        found.extend(formula.references());
    }
}

fn corner(name: CornerName, found: &mut Vec<PartId>) {
    found.push(match name {
        Name::Drawn(id) => id.into(),
        Name::Made { by, .. } => by.into(),
    });
}

fn line(name: LineName, found: &mut Vec<PartId>) {
    found.push(match name {
        Name::Drawn(id) => id.into(),
        Name::Made { by, .. } => by.into(),
    });
}

fn mark(mark: &Mark, found: &mut Vec<PartId>) {
    mark.corners().into_iter().for_each(|c| corner(c, found));
    if let Mark::Notch(id) = mark {
        found.push((*id).into());
    }
    mark.number().into_iter().for_each(|n| number(n, found));
}

fn span_references(span: &Span, found: &mut Vec<PartId>) {
    found.push(span.panel.into());
    line(span.line, found);
    mark(&span.from, found);
    mark(&span.to, found);
}

/// Each part once, however many pieces name it.
fn marker_references(marker: &Marker, found: &mut Vec<PartId>) {
    let mut named: BTreeSet<PartId> = BTreeSet::new();
    named.insert(marker.cloth.fabric.into());
    let ordered = marker.order.iter().filter_map(|one| one.size);
    named.extend(ordered.map(PartId::from));
    for laid in &marker.placements {
        named.insert(laid.piece.panel.into());
        named.extend(laid.piece.size.map(PartId::from));
    }
    found.extend(named);
}

fn panel_references(panel: &Panel, found: &mut Vec<PartId>) {
    match panel.source {
        Source::Traced(sheet) => found.push(sheet.into()),
        Source::Side { of, split, .. } => found.extend([of.into(), PartId::from(split)]),
    }
    found.push(panel.fabric.into());
    found.extend(panel.lines.iter().filter_map(|l| l.by).map(PartId::from));
    for edge in panel.edges() {
        found.push(edge.curve.into());
        found.extend(edge.ends.map(PartId::from));
    }
    for notch in &panel.notches {
        found.push(notch.line.into());
        mark(&notch.at, found);
    }
    for operation in &panel.operations {
        found.extend(operation.kind.points().into_iter().map(PartId::from));
        found.extend(operation.kind.altered().map(PartId::from));
        found.extend(operation.kind.curve().map(PartId::from));
        found.extend(operation.kind.sheet().map(PartId::from));
        if let Some(on) = operation.kind.line() {
            line(on, found);
        }
        operation
            .kind
            .marks()
            .into_iter()
            .for_each(|at| mark(at, found));
    }
    panel.numbers().into_iter().for_each(|n| number(n, found));
}

impl Pattern {
    /// Every part as an entity, with its place.
    pub fn entities(&self) -> Vec<(Entity, Place)> {
        let mut all: Vec<(Entity, Place)> = Vec::new();
        let mut put = |entity: Entity, place: Place| all.push((entity, place));
        for variable in &self.variables {
            put(
                Entity::Variable(variable.clone()),
                Place::Variable(variable.id),
            );
        }
        for sheet in &self.sheets {
            for point in &sheet.points {
                put(
                    Entity::Point(sheet.id, point.clone()),
                    Place::Point(point.id),
                );
            }
            for curve in &sheet.curves {
                put(
                    Entity::Curve(sheet.id, curve.clone()),
                    Place::Curve(curve.id),
                );
            }
        }
        for panel in &self.panels {
            put(Entity::Panel(panel.clone()), Place::Panel(panel.id));
        }
        for seam in &self.seams {
            put(Entity::Seam(seam.clone()), Place::Seam(seam.id));
        }
        for marker in &self.markers {
            put(Entity::Marker(marker.clone()), Place::Marker(marker.id));
        }
        for guide in &self.guides {
            put(Entity::Guide(guide.clone()), Place::Guide(guide.id));
        }
        all
    }

    /// The places of all parts that refer to a part, by its id or by its name.
    pub fn users(&self, part: PartId) -> Vec<Place> {
        let names = Names::new(self);
        let by_name = |entity: &Entity| {
            let numbers = entity.numbers();
            let mut formulas = numbers.iter().filter_map(|number| number.as_formula());
            formulas.any(|formula| formula.found_by_name(&names).contains(&part))
        };
        let all = self.entities().into_iter();
        let using =
            all.filter(|(entity, _)| entity.references().contains(&part) || by_name(entity));
        using.map(|(_, place)| place).collect()
    }
}
