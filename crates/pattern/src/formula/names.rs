//! Names of a document's parts, and the ids of these parts.

use super::written::{Corner, Kind, Owner, Word, Written};
use crate::{
    CornerName, CurveId, Name, OperationId, Panel, PanelId, PartReference, Pattern, PointId,
    SeamId, SheetId, VariableId, nearest,
};
use std::collections::{BTreeMap, BTreeSet};
use toile_measure::definition;

/// The names that formulas may use, for one state of a document.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Names {
    pub(super) variables: Book<(), VariableId>,
    pub(super) sheets: Book<(), SheetId>,
    pub(super) panels: Book<(), PanelId>,
    pub(super) seams: Book<(), SeamId>,
    pub(super) points: Book<SheetId, PointId>,
    pub(super) curves: Book<SheetId, CurveId>,
    pub(super) operations: Book<PanelId, OperationId>,
    /// For each panel and each name of an edge, the ends of the first edge with that name.
    pub(super) edges: BTreeMap<PanelId, BTreeMap<Box<str>, [PointId; 2]>>,
    /// For each panel and each pair of ends, the name of the first edge with these ends.
    pub(super) spanned: BTreeMap<(PanelId, [PointId; 2]), Box<str>>,
    /// For each panel, the sheet that it is traced from.
    pub(super) source: BTreeMap<PanelId, SheetId>,
    /// For each sheet, the first panel traced from it.
    pub(super) traced: BTreeMap<SheetId, PanelId>,
    /// Names of measurements in the tables of sizes.
    pub(super) measured: BTreeSet<Box<str>>,
    /// Whether parts are written as `@` and their ids, so that renaming does not change the text.
    pub(super) by_id: bool,
}

/// Names of one kind of part, each with the owner of the part, such as a sheet. If several parts of an owner
/// have the same name, the name stands for the first of them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Book<Owner, Id> {
    /// Owner and name of each part.
    of: BTreeMap<Id, (Owner, Box<str>)>,
    /// For each owner and each name, the first part of the owner with that name.
    named: BTreeMap<Owner, BTreeMap<Box<str>, Id>>,
}

impl<Owner, Id> Default for Book<Owner, Id> {
    fn default() -> Self {
        Self {
            of: BTreeMap::new(),
            named: BTreeMap::new(),
        }
    }
}

impl<Owner: Copy + Ord, Id: Copy + Ord> Book<Owner, Id> {
    fn put(&mut self, owner: Owner, name: &str, id: Id) {
        self.of.insert(id, (owner, name.into()));
        let own = self.named.entry(owner).or_default();
        own.entry(name.into()).or_insert(id);
    }

    pub fn id(&self, owner: Owner, name: &str) -> Option<Id> {
        self.named.get(&owner)?.get(name).copied()
    }

    /// Owner and name of a part with this id.
    pub fn name(&self, id: Id) -> Option<(Owner, &str)> {
        self.of.get(&id).map(|(owner, name)| (*owner, &**name))
    }

    pub fn names(&self, owner: Owner) -> impl Iterator<Item = &str> {
        let own = self.named.get(&owner).into_iter();
        own.flat_map(|names| names.keys().map(|name| &**name))
    }
}

impl Names {
    /// The names of all parts of a document.
    pub fn new(pattern: &Pattern) -> Self {
        let mut names = Self::default();
        for variable in &pattern.variables {
            names.variables.put((), &variable.name, variable.id);
        }
        for sheet in &pattern.sheets {
            names.sheets.put((), &sheet.name, sheet.id);
            for point in &sheet.points {
                names.points.put(sheet.id, &point.name, point.id);
            }
            for curve in &sheet.curves {
                names.curves.put(sheet.id, &curve.name, curve.id);
            }
        }
        for panel in &pattern.panels {
            names.panel(panel);
        }
        for seam in &pattern.seams {
            names.seams.put((), &seam.name, seam.id);
        }
        for size in &pattern.sizes {
            let table = size.measurements.iter();
            names.measured.extend(table.map(|(name, _)| name.into()));
        }
        names
    }

    fn panel(&mut self, panel: &Panel) {
        self.panels.put((), &panel.name, panel.id);
        if let Some(sheet) = panel.sheet() {
            self.source.entry(panel.id).or_insert(sheet);
            self.traced.entry(sheet).or_insert(panel.id);
        }
        let edges = self.edges.entry(panel.id).or_default();
        for edge in panel.edges() {
            edges.entry((*edge.name).into()).or_insert(edge.ends);
            let spanned = self.spanned.entry((panel.id, edge.ends));
            spanned.or_insert_with(|| (*edge.name).into());
        }
        for operation in &panel.operations {
            self.operations.put(panel.id, &operation.name, operation.id);
        }
    }

    /// Names for journals: parts are written as `@` and their ids, which do not change when parts are
    /// renamed.
    pub(crate) fn by_id() -> Self {
        Self {
            by_id: true,
            ..Self::default()
        }
    }

    /// The variable with this name.
    pub fn variable(&self, name: &str) -> Option<VariableId> {
        self.variables.id((), name)
    }

    /// Names of all variables, for suggestions.
    pub(crate) fn variable_names(&self) -> impl Iterator<Item = &str> {
        self.variables.names(())
    }

    /// Name of the sheet that a point is on.
    pub(crate) fn sheet_of_point(&self, id: PointId) -> Option<&str> {
        let (sheet, _) = self.points.name(id)?;
        self.sheets.name(sheet).map(|(_, name)| name)
    }

    /// Name of the sheet that a curve is on.
    pub(crate) fn sheet_of_curve(&self, id: CurveId) -> Option<&str> {
        let (sheet, _) = self.curves.name(id)?;
        self.sheets.name(sheet).map(|(_, name)| name)
    }

    /// Whether a word is the name of a measurement: in the catalogue, or in the table of a size.
    pub(super) fn is_measurement(&self, name: &str) -> bool {
        definition(name).is_some() || self.measured.contains(name)
    }

    /// The part that a text names. `None`: no such part exists.
    pub(crate) fn part(&self, text: &str, kind: Kind) -> Option<PartReference> {
        self.part_of(&Written::of(text, kind)?, kind)
    }

    /// The part that a parsed notation names. `None`: no such part exists.
    pub(super) fn part_of(&self, written: &Written, kind: Kind) -> Option<PartReference> {
        match written {
            Written::Lost(id) if kind == Kind::Point => Some(PartReference::Point((*id).into())),
            Written::Lost(id) => {
                let curve = self.curves.name((*id).into()).is_some();
                let seam = kind == Kind::StretchOrSeam && self.seams.name((*id).into()).is_some();
                match (curve, seam) {
                    (true, _) => Some(PartReference::Curve((*id).into())),
                    (_, true) => Some(PartReference::Seam((*id).into())),
                    _ => None,
                }
            }
            Written::Seam(Word::Id(id)) => Some(PartReference::Seam((*id).into())),
            Written::Seam(Word::Name(name)) => self.seams.id((), name).map(PartReference::Seam),
            Written::Curve(id) => Some(PartReference::Curve((*id).into())),
            Written::CurveOf(owner, Word::Name(name)) => {
                let owners = [Owner::Sheet(owner.clone()), Owner::Panel(owner.clone())];
                let mut sheets = owners.iter().filter_map(|owner| self.sheet(owner));
                let curve = sheets.find_map(|sheet| self.curves.id(sheet, name))?;
                Some(PartReference::Curve(curve))
            }
            Written::CurveOf(_, Word::Id(id)) => Some(PartReference::Curve((*id).into())),
            Written::Part(owner, Word::Name(name)) if kind == Kind::Point => {
                let point = self.points.id(self.sheet(owner)?, name)?;
                Some(PartReference::Point(point))
            }
            Written::Part(_, Word::Id(id)) if kind == Kind::Point => {
                Some(PartReference::Point((*id).into()))
            }
            Written::Part(owner, Word::Name(name)) => self.edge_or_curve(owner, name),
            Written::Part(_, Word::Id(id)) => {
                let curve = CurveId(*id);
                let known = self.curves.name(curve).is_some();
                known.then_some(PartReference::Curve(curve))
            }
            Written::Stretch(owner, [from, to]) => {
                let panel = self.owning_panel(owner)?;
                Some(PartReference::Stretch {
                    panel,
                    ends: [self.corner(panel, from)?, self.corner(panel, to)?],
                })
            }
        }
    }

    fn owning_panel(&self, owner: &Owner) -> Option<PanelId> {
        match owner {
            Owner::Panel(Word::Name(name)) => self.panels.id((), name),
            Owner::Panel(Word::Id(id)) => Some(PanelId(*id)),
            Owner::Sheet(_) => None,
        }
    }

    /// The sheet that the name of an owner stands for: the sheet of the panel with this name or, if there is
    /// no such panel, the sheet with this name.
    fn sheet(&self, owner: &Owner) -> Option<SheetId> {
        let panel = self.owning_panel(owner);
        let traced = panel.and_then(|panel| self.source.get(&panel).copied());
        traced.or_else(|| match owner {
            Owner::Panel(Word::Name(name)) | Owner::Sheet(Word::Name(name)) => {
                self.sheets.id((), name)
            }
            Owner::Panel(Word::Id(id)) | Owner::Sheet(Word::Id(id)) => Some(SheetId(*id)),
        })
    }

    /// The edge with this name in the panel that `owner` names or, if there is none, the curve with this name
    /// on the sheet of `owner`.
    fn edge_or_curve(&self, owner: &Owner, name: &str) -> Option<PartReference> {
        let panel = self.owning_panel(owner);
        let edge = panel.and_then(|panel| Some((panel, *self.edges.get(&panel)?.get(name)?)));
        if let Some((panel, ends)) = edge {
            return Some(PartReference::Stretch {
                panel,
                ends: ends.map(Name::Drawn),
            });
        }
        let curve = self.curves.id(self.sheet(owner)?, name)?;
        Some(PartReference::Curve(curve))
    }

    pub(super) fn corner(&self, panel: PanelId, corner: &Corner) -> Option<CornerName> {
        match corner {
            Corner::Drawn(Word::Id(id)) => Some(Name::Drawn((*id).into())),
            Corner::Drawn(Word::Name(name)) => {
                let sheet = *self.source.get(&panel)?;
                self.points.id(sheet, name).map(Name::Drawn)
            }
            Corner::Made { by, role, index } => Some(Name::Made {
                by: match by {
                    Word::Id(id) => (*id).into(),
                    Word::Name(name) => self.operations.id(panel, name)?,
                },
                role: *role,
                index: *index,
            }),
        }
    }

    /// Message that a text names no part, and advice; if possible with the most similar name.
    pub(crate) fn missing(&self, text: &str, kind: Kind) -> (String, String) {
        match Written::of(text, kind) {
            None => removed(text),
            Some(Written::Lost(_)) => removed("the part that it names"),
            Some(Written::Curve(_)) => removed("the curve that it names"),
            Some(Written::Seam(Word::Id(_))) => removed("the seam that it names"),
            Some(Written::Seam(Word::Name(name))) => {
                let near = nearest(&name, self.seams.names(()));
                let hint = suggestion(near, "name a seam, or a part as in front.armhole");
                (format!("there is no seam {name:?}"), hint)
            }
            Some(Written::CurveOf(owner, part)) => {
                self.missing_part(&Owner::Panel(owner), &part, "curve")
            }
            Some(Written::Part(owner, part)) => {
                let what = if kind == Kind::Point { "point" } else { "edge" };
                self.missing_part(&owner, &part, what)
            }
            Some(Written::Stretch(owner, corners)) => {
                let panel = self.owning_panel(&owner);
                let lost = |c: &&Corner| panel.is_none_or(|p| self.corner(p, c).is_none());
                match corners.iter().find(lost) {
                    Some(Corner::Drawn(point)) => self.missing_part(&owner, point, "point"),
                    Some(Corner::Made { by, .. }) => self.missing_part(&owner, by, "operation"),
                    None => removed(text),
                }
            }
        }
    }

    fn missing_part(&self, owner: &Owner, part: &Word, kind: &str) -> (String, String) {
        let (whose, own) = match owner {
            Owner::Panel(word) => ("panel", word),
            Owner::Sheet(word) => ("sheet", word),
        };
        let Word::Name(own) = own else {
            return removed(&format!("the {whose} whose {kind} it names"));
        };
        let known = self
            .sheet(owner)
            .filter(|id| self.sheets.name(*id).is_some());
        let Some(sheet) = known else {
            let names = self.panels.names(()).chain(self.sheets.names(()));
            let hint = suggestion(
                nearest(own, names),
                &format!("name a {whose} of this pattern"),
            );
            return (format!("there is no {whose} {own:?}"), hint);
        };
        let Word::Name(named) = part else {
            return removed(&format!("the {kind} of {whose} {own:?} that it names"));
        };
        let panel = self.owning_panel(owner);
        let near = match (kind, panel) {
            ("point", _) => nearest(named, self.points.names(sheet)),
            ("operation", Some(panel)) => nearest(named, self.operations.names(panel)),
            _ => {
                let edges = panel.and_then(|panel| self.edges.get(&panel));
                let edges = edges.into_iter().flat_map(|e| e.keys().map(|name| &**name));
                nearest(named, edges.chain(self.curves.names(sheet)))
            }
        };
        let hint = suggestion(near, &format!("name {kind}s of that {whose}"));
        let message = format!("{whose} {own:?} has no {kind} {named:?}");
        (message, hint)
    }
}

/// Message for a part that was removed, and advice.
fn removed(what: &str) -> (String, String) {
    (
        format!("{what} was removed"),
        "name another part, or undo its removal".to_owned(),
    )
}

fn suggestion(near: Option<&str>, otherwise: &str) -> String {
    near.map_or_else(|| otherwise.to_owned(), |n| format!("did you mean {n:?}?"))
}
