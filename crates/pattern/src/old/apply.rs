//! Applies edits to a document, all or nothing, and finds what undoes them.

use crate::difference::difference;
use crate::formula::Mentioned;
use crate::numbers::all_finite;
use crate::{
    Edit, EditError, Fabric, Panel, PanelEdit, PanelId, Pattern, Seam, Size, Variable, is_part_name,
};
use std::sync::Arc;
use toile_measure::Origin;

/// Deepest nesting of `Edit::Many`.
const DEEPEST: usize = 20;

impl Pattern {
    /// Applies an edit and returns the one that undoes it. On an error the document is unchanged.
    ///
    /// Undoing restores everything but the id counters, which only grow.
    pub fn apply(&mut self, edit: Edit) -> Result<Edit, EditError> {
        let mut changed = self.clone();
        let inverse = match &edit {
            Edit::InPanel {
                panel,
                edit: PanelEdit::MovePoint { point, .. },
            } => self
                .panel(*panel)
                .and_then(|owner| owner.point(*point))
                .map(|found| Edit::InPanel {
                    panel: *panel,
                    edit: PanelEdit::MovePoint {
                        point: *point,
                        place: found.place.clone(),
                    },
                }),
            _ => None,
        };
        changed.change(edit, 0)?;
        let inverse = inverse.unwrap_or_else(|| difference(&changed, self));
        *self = changed;
        Ok(inverse)
    }

    fn change(&mut self, edit: Edit, depth: usize) -> Result<(), EditError> {
        match edit {
            Edit::Many(edits) => {
                if depth >= DEEPEST {
                    return Err(impossible(
                        "edits are nested too deeply",
                        "list them one after the other",
                    ));
                }
                edits
                    .into_iter()
                    .try_for_each(|edit| self.change(edit, depth + 1))?;
            }
            Edit::SetName(name) => {
                self.name = name;
            }
            Edit::SetUnit(unit) => self.unit = unit,
            Edit::SetBaseSize(name) => {
                if let Some(name) = &name
                    && self.size(name).is_none()
                {
                    return Err(EditError::Missing(format!("size {name:?}")));
                }
                self.base_size = name;
            }
            Edit::PutSize { at, size } => self.put_size(at, size)?,
            Edit::RemoveSize(name) => self.remove_size(&name)?,
            Edit::SetMeasurement { size, name, value } => {
                self.set_measurement(&size, &name, value)?;
            }
            Edit::PutVariable { at, variable } => self.put_variable(at, variable)?,
            Edit::RemoveVariable(name) => {
                let k = self.variable_index(&name)?;
                self.variables.remove(k);
            }
            Edit::RenameVariable { from, to } => self.rename_variable(&from, to)?,
            Edit::PutFabric { at, fabric } => self.put_fabric(at, fabric)?,
            Edit::RemoveFabric(id) => {
                if let Some(panel) = self.panels.iter().find(|panel| panel.fabric == id) {
                    return Err(EditError::InUse {
                        what: id.to_string(),
                        by: format!("panel {:?}", panel.name),
                    });
                }
                let k = self.fabrics.iter().position(|fabric| fabric.id == id);
                let k = k.ok_or_else(|| EditError::Missing(id.to_string()))?;
                self.fabrics.remove(k);
            }
            Edit::PutPanel { at, panel } => self.put_panel(at, *panel)?,
            Edit::RemovePanel(id) => {
                let k = self.panel_position(id)?;
                self.panels.remove(k);
                self.seams
                    .retain(|seam| seam.spans().all(|span| span.panel != id));
            }
            Edit::PutSeam { at, seam } => self.put_seam(at, seam)?,
            Edit::RemoveSeam(id) => {
                let k = self.seams.iter().position(|seam| seam.id == id);
                let k = k.ok_or_else(|| EditError::Missing(id.to_string()))?;
                self.seams.remove(k);
            }
            Edit::InPanel { panel, edit } => self.change_panel(panel, edit)?,
        }
        Ok(())
    }

    pub(crate) fn panel_position(&self, id: PanelId) -> Result<usize, EditError> {
        self.panels
            .iter()
            .position(|panel| panel.id == id)
            .ok_or_else(|| EditError::Missing(id.to_string()))
    }

    fn put_size(&mut self, at: usize, size: Size) -> Result<(), EditError> {
        name_allowed(&size.name)?;
        self.sizes.retain(|known| known.name != size.name);
        self.sizes.insert(at.min(self.sizes.len()), size);
        Ok(())
    }

    fn remove_size(&mut self, name: &str) -> Result<(), EditError> {
        let k = self.sizes.iter().position(|size| size.name == name);
        let k = k.ok_or_else(|| EditError::Missing(format!("size {name:?}")))?;
        self.sizes.remove(k);
        if self.base_size.as_deref() == Some(name) {
            self.base_size = None;
        }
        Ok(())
    }

    fn set_measurement(
        &mut self,
        size: &str,
        name: &str,
        value: Option<f64>,
    ) -> Result<(), EditError> {
        let found = self.sizes.iter_mut().find(|known| known.name == size);
        let found = found.ok_or_else(|| EditError::Missing(format!("size {size:?}")))?;
        match value {
            Some(value) => found
                .measurements
                .set(name, value, Origin::Asked)
                .map_err(|error| impossible(&error.to_string(), "see there"))?,
            None => {
                let removed = found.measurements.remove(name);
                removed.ok_or_else(|| EditError::Missing(format!("measurement {name:?}")))?;
            }
        }
        Ok(())
    }

    fn variable_index(&self, name: &str) -> Result<usize, EditError> {
        self.variables
            .iter()
            .position(|variable| variable.name == name)
            .ok_or_else(|| EditError::Missing(format!("variable {name:?}")))
    }

    fn put_variable(&mut self, at: usize, mut variable: Variable) -> Result<(), EditError> {
        name_allowed(&variable.name)?;
        if !all_finite(vec![&mut variable.number]) {
            return Err(EditError::NotFinite(format!(
                "variable {:?}",
                variable.name
            )));
        }
        self.variables.retain(|known| known.name != variable.name);
        self.variables
            .insert(at.min(self.variables.len()), variable);
        Ok(())
    }

    fn rename_variable(&mut self, from: &str, to: String) -> Result<(), EditError> {
        name_allowed(&to)?;
        let k = self.variable_index(from)?;
        if from != to && self.variable_index(&to).is_ok() {
            return Err(EditError::Taken(format!("variable {to:?}")));
        }
        self.rewrite(&Mentioned::Name(from.into()), &to)?;
        self.variables[k].name = to;
        Ok(())
    }

    fn put_fabric(&mut self, at: usize, fabric: Fabric) -> Result<(), EditError> {
        name_allowed(&fabric.name)?;
        let taken = |known: &Arc<Fabric>| known.id != fabric.id && known.name == fabric.name;
        if self.fabrics.iter().any(taken) {
            return Err(EditError::Taken(format!("fabric {:?}", fabric.name)));
        }
        let numbers = [
            fabric.density,
            fabric.thickness,
            fabric.shear,
            fabric.poisson,
            fabric.friction,
            fabric.width,
        ];
        let all = numbers
            .iter()
            .chain(&fabric.stretch)
            .chain(&fabric.bend)
            .chain(&fabric.colour);
        let flow = &fabric.rheology;
        let all = all.chain(&flow.hardening).chain(&flow.kept).chain([
            &flow.viscosity,
            &flow.bend_viscosity,
            &flow.relaxation_time,
        ]);
        if !all.copied().all(f64::is_finite) {
            return Err(EditError::NotFinite(format!("fabric {:?}", fabric.name)));
        }
        fabric.id.reserve(&mut self.ids);
        self.fabrics.retain(|known| known.id != fabric.id);
        self.fabrics
            .insert(at.min(self.fabrics.len()), Arc::new(fabric));
        Ok(())
    }

    fn put_panel(&mut self, at: usize, panel: Panel) -> Result<(), EditError> {
        self.replaceable(&panel)?;
        if self.fabric(panel.fabric).is_none() {
            return Err(EditError::Missing(panel.fabric.to_string()));
        }
        panel.reserve_ids(&mut self.ids);
        self.panels.retain(|known| known.id != panel.id);
        self.panels
            .insert(at.min(self.panels.len()), Arc::new(panel));
        Ok(())
    }

    /// Whether the panel may stand in this pattern.
    pub(crate) fn replaceable(&self, panel: &Panel) -> Result<(), EditError> {
        panel.validate()?;
        let others = || self.panels.iter().filter(|known| known.id != panel.id);
        if others().any(|known| known.name == panel.name) {
            return Err(EditError::Taken(format!("panel {:?}", panel.name)));
        }
        let dart = panel
            .darts
            .iter()
            .find(|dart| others().any(|known| known.darts.iter().any(|d| d.id == dart.id)));
        match dart {
            Some(dart) => Err(EditError::Taken(dart.id.to_string())),
            None => Ok(()),
        }
    }

    fn put_seam(&mut self, at: usize, mut seam: Seam) -> Result<(), EditError> {
        name_allowed(&seam.name)?;
        if !all_finite(seam.numbers_mut()) {
            return Err(EditError::NotFinite(format!("seam {:?}", seam.name)));
        }
        seam.id.reserve(&mut self.ids);
        self.seams.retain(|known| known.id != seam.id);
        self.seams.insert(at.min(self.seams.len()), Arc::new(seam));
        Ok(())
    }
}

pub(crate) fn name_allowed(name: &str) -> Result<(), EditError> {
    if is_part_name(name) {
        Ok(())
    } else {
        Err(EditError::Name(name.chars().take(100).collect()))
    }
}

pub(crate) fn impossible(message: &str, hint: &str) -> EditError {
    EditError::Impossible {
        message: message.to_owned(),
        hint: hint.to_owned(),
    }
}
