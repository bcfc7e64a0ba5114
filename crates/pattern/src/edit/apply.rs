//! Applies edits to a document, all or nothing.

use super::{Edit, EditError, Entity};
use crate::{PartId, Pattern, Sheet, is_part_name};
use std::sync::Arc;

impl Pattern {
    /// Applies edits in order. On an error the document is unchanged.
    ///
    /// # Errors
    /// A name that is not allowed for a part, a number that is not finite, a reference to an id that was
    /// never given or that belongs to a part of another kind. A reference to a part that was removed is no
    /// error, as the part may come back.
    pub fn apply(&mut self, edits: &[Edit]) -> Result<(), EditError> {
        let mut changed = self.clone();
        for edit in edits {
            changed.change(edit)?;
        }
        for edit in edits {
            if let Edit::Put(entity) = edit {
                changed.check_references(entity)?;
            }
        }
        *self = changed;
        Ok(())
    }

    fn change(&mut self, edit: &Edit) -> Result<(), EditError> {
        match edit {
            Edit::Put(entity) => self.put(entity),
            Edit::Remove(part) => self.remove(*part),
            Edit::Order { part, at } => self.order(*part, *at),
        }
    }

    fn put(&mut self, entity: &Entity) -> Result<(), EditError> {
        let is_head = matches!(entity, Entity::Head(_));
        if !is_head && !is_part_name(entity.name()) {
            return Err(EditError::Name(entity.name().to_owned()));
        }
        if !entity.is_finite() {
            return Err(EditError::NotFinite(format!("{:?}", entity.name())));
        }
        if let Some(id) = entity.id() {
            self.ids.reserve(id.number());
        }
        match entity {
            Entity::Head(head) => {
                self.name.clone_from(&head.name);
                self.unit = head.unit;
                self.base_size = head.base_size;
            }
            Entity::Size(size) => put(&mut self.sizes, size, |s| s.id),
            Entity::Variable(variable) => put(&mut self.variables, variable, |v| v.id),
            Entity::Fabric(fabric) => put(&mut self.fabrics, fabric, |f| f.id),
            Entity::Seam(seam) => put(&mut self.seams, seam, |s| s.id),
            Entity::Marker(marker) => {
                if let Some(fault) = marker.fault() {
                    return Err(EditError::Impossible {
                        message: format!("marker {:?}: {}", marker.name, fault.message),
                        hint: fault.hint.to_owned(),
                    });
                }
                put(&mut self.markers, marker, |m| m.id);
            }
            Entity::Guide(guide) => {
                if !guide.at.is_finite() {
                    return Err(EditError::NotFinite(guide.id.to_string()));
                }
                put(&mut self.guides, guide, |g| g.id);
            }
            Entity::Panel(panel) => {
                for (id, _) in panel.own_parts() {
                    self.ids.reserve(id.number());
                }
                put(&mut self.panels, panel, |p| p.id);
            }
            Entity::Sheet(head) => {
                let mut sheet = match self.sheet(head.id) {
                    Some(sheet) => (**sheet).clone(),
                    None => Sheet {
                        id: head.id,
                        ..Sheet::default()
                    },
                };
                if !head.on_table.iter().all(|v| v.is_finite()) {
                    return Err(EditError::NotFinite(format!("sheet {:?}", head.name)));
                }
                sheet.name.clone_from(&head.name);
                sheet.on = head.on;
                sheet.on_table = head.on_table;
                put(&mut self.sheets, &Arc::new(sheet), |s| s.id);
            }
            Entity::Point(sheet, point) => {
                let sheet = self.sheet_mut(*sheet)?;
                put(&mut sheet.points, point, |p| p.id);
            }
            Entity::Curve(sheet, curve) => {
                let sheet = self.sheet_mut(*sheet)?;
                put(&mut sheet.curves, curve, |c| c.id);
            }
        }
        Ok(())
    }

    fn sheet_mut(&mut self, id: crate::SheetId) -> Result<&mut Sheet, EditError> {
        let found = self.sheets.iter_mut().find(|sheet| sheet.id == id);
        found
            .map(Arc::make_mut)
            .ok_or_else(|| EditError::Missing(id.to_string()))
    }

    fn remove(&mut self, part: PartId) -> Result<(), EditError> {
        let removed = match part {
            PartId::Size(id) => remove(&mut self.sizes, |s| s.id == id),
            PartId::Variable(id) => remove(&mut self.variables, |v| v.id == id),
            PartId::Fabric(id) => remove(&mut self.fabrics, |f| f.id == id),
            PartId::Sheet(id) => remove(&mut self.sheets, |s| s.id == id),
            PartId::Panel(id) => remove(&mut self.panels, |p| p.id == id),
            PartId::Seam(id) => remove(&mut self.seams, |s| s.id == id),
            PartId::Marker(id) => remove(&mut self.markers, |m| m.id == id),
            PartId::Guide(id) => remove(&mut self.guides, |g| g.id == id),
            PartId::Point(id) => {
                let mut sheets = self.sheets.iter_mut();
                let owner = sheets.find(|sheet| sheet.point(id).is_some());
                owner.is_some_and(|s| remove(&mut Arc::make_mut(s).points, |p| p.id == id))
            }
            PartId::Curve(id) => {
                let mut sheets = self.sheets.iter_mut();
                let owner = sheets.find(|sheet| sheet.curve(id).is_some());
                owner.is_some_and(|s| remove(&mut Arc::make_mut(s).curves, |c| c.id == id))
            }
            PartId::Line(_) | PartId::Edge(_) | PartId::Notch(_) | PartId::Operation(_) => {
                return Err(EditError::Impossible {
                    message: format!("{part} is removed by itself"),
                    hint: "put its panel without it".into(),
                });
            }
        };
        if removed {
            Ok(())
        } else {
            Err(EditError::Missing(part.to_string()))
        }
    }

    fn order(&mut self, part: PartId, at: usize) -> Result<(), EditError> {
        let moved = match part {
            PartId::Size(id) => order(&mut self.sizes, |s| s.id == id, at),
            PartId::Variable(id) => order(&mut self.variables, |v| v.id == id, at),
            PartId::Fabric(id) => order(&mut self.fabrics, |f| f.id == id, at),
            PartId::Sheet(id) => order(&mut self.sheets, |s| s.id == id, at),
            PartId::Panel(id) => order(&mut self.panels, |p| p.id == id, at),
            PartId::Seam(id) => order(&mut self.seams, |s| s.id == id, at),
            PartId::Marker(id) => order(&mut self.markers, |m| m.id == id, at),
            PartId::Guide(id) => order(&mut self.guides, |g| g.id == id, at),
            PartId::Point(id) => {
                let mut sheets = self.sheets.iter_mut();
                let owner = sheets.find(|sheet| sheet.point(id).is_some());
                owner.is_some_and(|s| order(&mut Arc::make_mut(s).points, |p| p.id == id, at))
            }
            PartId::Curve(id) => {
                let mut sheets = self.sheets.iter_mut();
                let owner = sheets.find(|sheet| sheet.curve(id).is_some());
                owner.is_some_and(|s| order(&mut Arc::make_mut(s).curves, |c| c.id == id, at))
            }
            PartId::Line(_) | PartId::Edge(_) | PartId::Notch(_) | PartId::Operation(_) => {
                return Err(EditError::Impossible {
                    message: format!("{part} is moved by itself"),
                    hint: "put its panel in the order that is wanted".into(),
                });
            }
        };
        if moved {
            Ok(())
        } else {
            Err(EditError::Missing(part.to_string()))
        }
    }

    /// Refuses references to ids that were never given or that belong to parts of another kind.
    fn check_references(&self, entity: &Entity) -> Result<(), EditError> {
        let mut parts = None;
        for reference in entity.references() {
            let refuse = |why| EditError::Reference {
                what: format!("{:?}", entity.name()),
                to: reference.to_string(),
                why,
            };
            if reference.number() >= self.ids.next {
                return Err(refuse("was never given"));
            }
            if self.has(reference) {
                continue;
            }
            let parts = parts.get_or_insert_with(|| self.parts());
            let other = parts
                .iter()
                .any(|(id, _)| id.number() == reference.number());
            let own = parts.iter().any(|(id, _)| *id == reference);
            if other && !own {
                return Err(refuse("is of another kind"));
            }
        }
        Ok(())
    }

    /// Whether a part of a kind that is often looked up is in the pattern; `false` for parts of other kinds.
    fn has(&self, part: PartId) -> bool {
        match part {
            PartId::Variable(id) => self.variables.iter().any(|v| v.id == id),
            PartId::Sheet(id) => self.sheet(id).is_some(),
            PartId::Point(id) => self.point(id).is_some(),
            PartId::Panel(id) => self.panel(id).is_some(),
            PartId::Fabric(id) => self.fabric(id).is_some(),
            PartId::Curve(id) => self.curve(id).is_some(),
            // These kinds are seldom looked up: the caller searches for them among all parts.
            PartId::Size(_)
            | PartId::Line(_)
            | PartId::Edge(_)
            | PartId::Notch(_)
            | PartId::Operation(_)
            | PartId::Seam(_)
            | PartId::Marker(_)
            | PartId::Guide(_) => false,
        }
    }
}

fn put<T: Clone, Id: PartialEq>(list: &mut Vec<Arc<T>>, part: &Arc<T>, id: impl Fn(&T) -> Id) {
    match list.iter_mut().find(|known| id(known) == id(part)) {
        Some(known) => *known = part.clone(),
        None => list.push(part.clone()),
    }
}

fn remove<T>(list: &mut Vec<Arc<T>>, is: impl Fn(&T) -> bool) -> bool {
    let before = list.len();
    list.retain(|part| !is(part));
    list.len() < before
}

fn order<T>(list: &mut Vec<Arc<T>>, is: impl Fn(&T) -> bool, at: usize) -> bool {
    let Some(k) = list.iter().position(|part| is(part)) else {
        return false;
    };
    let part = list.remove(k);
    list.insert(at.min(list.len()), part);
    true
}
