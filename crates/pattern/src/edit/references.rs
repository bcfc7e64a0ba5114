//! References: the parts that each part refers to.

use super::{Entity, Head, SheetHead};
use crate::fields::{Fields, key};
use crate::{Names, Number, PartId, Pattern, Place, Sheet, fields};
use std::collections::BTreeSet;

fields!(Head, |self, v| {
    let Self {
        name,
        unit,
        base_size,
    } = self;
    v.value(key("name"), name);
    v.value(key("unit"), unit);
    v.optional("base_size", base_size);
    if let Some(base_size) = base_size {
        v.id("base_size", base_size);
    }
});

impl From<SheetHead> for Sheet {
    fn from(head: SheetHead) -> Self {
        let SheetHead {
            id,
            name,
            on,
            on_table,
        } = head;
        Self {
            id,
            name,
            on,
            on_table,
            ..Self::default()
        }
    }
}

impl From<&Sheet> for SheetHead {
    fn from(sheet: &Sheet) -> Self {
        Self {
            id: sheet.id,
            name: sheet.name.clone(),
            on: sheet.on,
            on_table: sheet.on_table,
        }
    }
}

impl Entity {
    /// The part in the entity, for a visitor of its fields. The head of a sheet is written into `sheet`,
    /// since only whole sheets can be visited.
    fn part<'e>(&'e self, sheet: &'e mut Sheet) -> &'e dyn Fields {
        match self {
            Self::Head(head) => head,
            Self::Size(size) => size,
            Self::Variable(variable) => variable,
            Self::Fabric(fabric) => fabric,
            Self::Sheet(head) => {
                *sheet = Sheet::from(head.clone());
                sheet
            }
            Self::Point(_, point) => point,
            Self::Curve(_, curve) => curve,
            Self::Panel(panel) => panel,
            Self::Seam(seam) => seam,
            Self::Marker(marker) => marker,
            Self::Guide(guide) => guide,
        }
    }

    /// Calls `change` with the part in the entity.
    pub(crate) fn change(&mut self, change: &mut dyn FnMut(&mut dyn Fields)) {
        match self {
            Self::Head(head) => change(head),
            Self::Size(size) => change(size),
            Self::Variable(variable) => change(variable),
            Self::Fabric(fabric) => change(fabric),
            Self::Sheet(head) => {
                let mut sheet = Sheet::from(head.clone());
                change(&mut sheet);
                *head = SheetHead::from(&sheet);
            }
            Self::Point(_, point) => change(point),
            Self::Curve(_, curve) => change(curve),
            Self::Panel(panel) => change(panel),
            Self::Seam(seam) => change(seam),
            Self::Marker(marker) => change(marker),
            Self::Guide(guide) => change(guide),
        }
    }

    /// The sheet that a point or a curve is on; `None` for other entities.
    pub(crate) fn sheet_mut(&mut self) -> Option<&mut crate::SheetId> {
        match self {
            Self::Point(sheet, _) | Self::Curve(sheet, _) => Some(sheet),
            Self::Head(_)
            | Self::Size(_)
            | Self::Variable(_)
            | Self::Fabric(_)
            | Self::Sheet(_)
            | Self::Panel(_)
            | Self::Seam(_)
            | Self::Marker(_)
            | Self::Guide(_) => None,
        }
    }

    /// All parts that the entity refers to.
    pub fn references(&self) -> Vec<PartId> {
        let found = fields::references(self.part(&mut Sheet::default()));
        match self {
            Self::Point(sheet, _) | Self::Curve(sheet, _) => {
                std::iter::once((*sheet).into()).chain(found).collect()
            }
            // Each part is listed once, however many pieces of the marker refer to it.
            Self::Marker(_) => found
                .into_iter()
                .collect::<BTreeSet<_>>()
                .into_iter()
                .collect(),
            Self::Head(_)
            | Self::Size(_)
            | Self::Variable(_)
            | Self::Fabric(_)
            | Self::Sheet(_)
            | Self::Panel(_)
            | Self::Seam(_)
            | Self::Guide(_) => found,
        }
    }

    /// Whether all numbers in the entity are finite.
    pub(crate) fn is_finite(&self) -> bool {
        let mut sheet = Sheet::default();
        fields::numbers(self.part(&mut sheet))
            .into_iter()
            .all(Number::is_finite)
    }

    /// The numbers of the entity, or of the part `part` of it, in the order in which inspectors show them.
    pub(crate) fn number_entries(&self, part: Option<PartId>) -> Vec<fields::NumberEntry> {
        fields::number_entries(self.part(&mut Sheet::default()), part)
    }
}

impl Pattern {
    /// Variables, points, curves, panels, seams, markers and guides as entities, each with its diagnostic
    /// place.
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

    /// The entity that is the part or contains it. `None`: the part is not in the pattern.
    pub(crate) fn entity_with(&self, part: PartId) -> Option<Entity> {
        let panel = |owns: &dyn Fn(&crate::Panel) -> bool| {
            let panel = self.panels.iter().find(|panel| owns(panel))?;
            Some(Entity::Panel(panel.clone()))
        };
        match part {
            PartId::Size(id) => {
                let size = self.sizes.iter().find(|size| size.id == id)?;
                Some(Entity::Size(size.clone()))
            }
            PartId::Variable(id) => {
                let variable = self.variables.iter().find(|variable| variable.id == id)?;
                Some(Entity::Variable(variable.clone()))
            }
            PartId::Fabric(id) => Some(Entity::Fabric(self.fabric(id)?.clone())),
            PartId::Sheet(id) => Some(Entity::Sheet(SheetHead::from(&**self.sheet(id)?))),
            PartId::Point(id) => {
                let (sheet, point) = self.point(id)?;
                Some(Entity::Point(sheet.id, point.clone()))
            }
            PartId::Curve(id) => {
                let (sheet, curve) = self.curve(id)?;
                Some(Entity::Curve(sheet.id, curve.clone()))
            }
            PartId::Panel(id) => panel(&|panel| panel.id == id),
            PartId::Line(id) => panel(&|panel| panel.line(id).is_some()),
            PartId::Edge(id) => panel(&|panel| panel.edge(id).is_some()),
            PartId::Notch(id) => panel(&|panel| panel.notch(id).is_some()),
            PartId::Operation(id) => panel(&|panel| panel.step_of(id).is_some()),
            PartId::Seam(id) => Some(Entity::Seam(self.seam(id)?.clone())),
            PartId::Marker(id) => Some(Entity::Marker(self.marker(id)?.clone())),
            PartId::Guide(id) => Some(Entity::Guide(self.guide(id)?.clone())),
        }
    }

    /// Diagnostic places of the parts that refer to a part, by its id or by its name; the parts searched are
    /// those of [`Pattern::entities`].
    pub fn users(&self, part: PartId) -> Vec<Place> {
        let names = Names::new(self);
        let by_name = |entity: &Entity| {
            let mut sheet = Sheet::default();
            let numbers = fields::numbers(entity.part(&mut sheet));
            let mut formulas = numbers.iter().filter_map(|number| number.as_formula());
            formulas.any(|formula| formula.found_by_name(&names).contains(&part))
        };
        let all = self.entities().into_iter();
        let using =
            all.filter(|(entity, _)| entity.references().contains(&part) || by_name(entity));
        using.map(|(_, place)| place).collect()
    }
}
