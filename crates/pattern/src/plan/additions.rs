//! New points and curves for a sheet, with unique ids and names.

use super::impossible;
use super::lookup::sheet;
use super::names::{curve_owner, letter_name, point_owner, wished};
use crate::fields::{self, Fields};
use crate::{
    Curve, CurveId, CurveRule, Edit, EditError, Entity, Ids, Number, Pattern, Point, PointId,
    PointRule, Sheet, SheetId,
};
use std::sync::Arc;

/// New points and curves of one sheet, collected while they are planned.
pub(super) struct Additions {
    /// The sheet with all additions so far.
    pub sheet: Sheet,
    /// Source of new ids.
    pub ids: Ids,
    /// The edits that add the parts.
    pub edits: Vec<Edit>,
}

impl Additions {
    /// Starts without additions.
    pub fn new(pattern: &Pattern, id: SheetId) -> Result<Self, EditError> {
        Ok(Self {
            sheet: (**sheet(pattern, id)?).clone(),
            ids: pattern.ids,
            edits: Vec::new(),
        })
    }

    /// Adds a point. Without a name it gets the next free letter as its name.
    pub fn point(&mut self, name: Option<&str>, rule: PointRule) -> Result<PointId, EditError> {
        let name = match name {
            Some(name) => wished(name, |name| point_owner(&self.sheet, name))?,
            None => letter_name(|name| self.sheet.point_named(name).is_some()),
        };
        let what = format!("point {name:?}");
        for base in fields::points(&rule) {
            self.has_point(&what, base)?;
        }
        for base in fields::curves(&rule) {
            self.has_curve(&what, base)?;
        }
        finite(&what, &rule)?;
        let point = Arc::new(Point {
            id: self.ids.take(),
            name,
            rule,
        });
        let id = point.id;
        self.sheet.points.push(point.clone());
        let put = Entity::Point(self.sheet.id, point);
        self.edits.push(Edit::Put(put));
        Ok(id)
    }

    /// Adds a curve. Without a name it is named after its ends.
    pub fn curve(
        &mut self,
        name: Option<&str>,
        ends: [PointId; 2],
        rule: CurveRule,
    ) -> Result<CurveId, EditError> {
        let name = match name {
            Some(name) => wished(name, |name| curve_owner(&self.sheet, name))?,
            None => self.curve_name(ends),
        };
        let what = format!("curve {name:?}");
        for base in ends.into_iter().chain(fields::points(&rule)) {
            self.has_point(&what, base)?;
        }
        for of in fields::curves(&rule) {
            self.has_curve(&what, of)?;
        }
        finite(&what, &rule)?;
        let curve = Arc::new(Curve {
            id: self.ids.take(),
            name,
            ends,
            rule,
        });
        let id = curve.id;
        self.sheet.curves.push(curve.clone());
        let put = Entity::Curve(self.sheet.id, curve);
        self.edits.push(Edit::Put(put));
        Ok(id)
    }

    /// A free name for a curve: the names of its two ends, one after the other, if that is short; otherwise
    /// `curve`, with a number if that name is taken.
    fn curve_name(&self, ends: [PointId; 2]) -> String {
        let name = |id| self.sheet.point(id).map_or("", |point| &*point.name);
        let both: String = ends.map(name).concat();
        let wanted = match both.len() {
            1..=6 => both,
            _ => "curve".to_owned(),
        };
        super::names::free_name(&wanted, |name| self.sheet.curve_named(name).is_some())
    }

    fn has_point(&self, what: &str, id: PointId) -> Result<(), EditError> {
        match self.sheet.point(id) {
            Some(_) => Ok(()),
            None => Err(self.foreign(what, &id)),
        }
    }

    fn has_curve(&self, what: &str, id: CurveId) -> Result<(), EditError> {
        match self.sheet.curve(id) {
            Some(_) => Ok(()),
            None => Err(self.foreign(what, &id)),
        }
    }

    fn foreign(&self, what: &str, part: &dyn std::fmt::Display) -> EditError {
        impossible(
            format!(
                "{what} needs {part}, which sheet {:?} has not",
                self.sheet.name
            ),
            "construct it from points and curves of its own sheet; a formula may speak of others",
        )
    }
}

fn finite(what: &str, rule: &dyn Fields) -> Result<(), EditError> {
    match fields::numbers(rule).into_iter().all(Number::is_finite) {
        true => Ok(()),
        false => Err(EditError::NotFinite(what.to_owned())),
    }
}
