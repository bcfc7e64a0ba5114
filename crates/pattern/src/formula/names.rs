//! Names of a document's parts, both ways: from a text to ids, and back.

use super::{Token, quoted};
use crate::{
    CornerName, Curve, CurveId, Line, Name, Panel, PanelId, PartReference, Pattern, PointId, Role,
    Seam, SeamId, Sheet, SheetId, VariableId, nearest,
};
use std::collections::HashMap;
use std::sync::Arc;

/// The word before a curve that is named like an edge.
pub(super) const CURVE: &str = "curve";

/// The names formulas may use, of one state of a document.
#[derive(Clone, Debug, Default)]
pub struct Names {
    variables: HashMap<String, VariableId>,
    variable_names: HashMap<VariableId, String>,
    sheets: HashMap<SheetId, Arc<Sheet>>,
    sheets_named: HashMap<String, SheetId>,
    panels: HashMap<PanelId, Arc<Panel>>,
    panels_named: HashMap<String, PanelId>,
    seams: HashMap<SeamId, Arc<Seam>>,
    seams_named: HashMap<String, SeamId>,
    points: HashMap<PointId, (SheetId, String)>,
    points_named: HashMap<(SheetId, String), PointId>,
    curves: HashMap<CurveId, (SheetId, Arc<Curve>)>,
    /// The first panel traced from each sheet.
    traced: HashMap<SheetId, PanelId>,
    /// Whether parts are written as `@` and their ids, which no renaming changes.
    by_id: bool,
}

impl Names {
    /// The names of a document.
    pub fn new(pattern: &Pattern) -> Self {
        let mut names = Self::default();
        for variable in &pattern.variables {
            names
                .variables
                .entry(variable.name.clone())
                .or_insert(variable.id);
            names
                .variable_names
                .insert(variable.id, variable.name.clone());
        }
        for sheet in &pattern.sheets {
            names.sheets.insert(sheet.id, sheet.clone());
            names
                .sheets_named
                .entry(sheet.name.clone())
                .or_insert(sheet.id);
            for point in &sheet.points {
                names
                    .points
                    .insert(point.id, (sheet.id, point.name.clone()));
                let key = (sheet.id, point.name.clone());
                names.points_named.entry(key).or_insert(point.id);
            }
            for curve in &sheet.curves {
                names.curves.insert(curve.id, (sheet.id, curve.clone()));
            }
        }
        for panel in &pattern.panels {
            names.panels.insert(panel.id, panel.clone());
            names
                .panels_named
                .entry(panel.name.clone())
                .or_insert(panel.id);
            names.traced.entry(panel.sheet()).or_insert(panel.id);
        }
        for seam in &pattern.seams {
            names.seams.insert(seam.id, seam.clone());
            names
                .seams_named
                .entry(seam.name.clone())
                .or_insert(seam.id);
        }
        names
    }

    /// Parts written as `@` and their ids: for journals, which outlive names.
    pub(crate) fn by_id() -> Self {
        Self {
            by_id: true,
            ..Self::default()
        }
    }

    /// Whether parts are written as `@` and their ids.
    pub(crate) fn are_ids(&self) -> bool {
        self.by_id
    }

    /// The variable of that name.
    pub fn variable(&self, name: &str) -> Option<VariableId> {
        self.variables.get(name).copied()
    }

    /// Names of all variables, for suggestions.
    pub(crate) fn variable_names(&self) -> impl Iterator<Item = &str> {
        self.variables.keys().map(String::as_str)
    }

    /// The sheet a name leads to: of the panel called so, else the sheet called so.
    fn sheet(&self, name: &str) -> Option<&Arc<Sheet>> {
        let traced = self
            .panels_named
            .get(name)
            .map(|id| self.panels[id].sheet());
        let id = traced.or_else(|| self.sheets_named.get(name).copied())?;
        self.sheets.get(&id)
    }

    /// The point `sheet.point` or `panel.point` names.
    pub fn point(&self, owner: &str, part: &str) -> Option<PointId> {
        let sheet = self.sheet(owner)?;
        self.points_named.get(&(sheet.id, part.to_owned())).copied()
    }

    /// The edge of a panel, else the curve of a sheet, that `owner.part` names.
    pub fn stretch(&self, owner: &str, part: &str) -> Option<PartReference> {
        let panel = self.panels_named.get(owner).map(|id| &self.panels[id]);
        let edge = panel.and_then(|panel| Some((panel, panel.edge_named(part)?)));
        if let Some((panel, edge)) = edge {
            return Some(PartReference::Stretch {
                panel: panel.id,
                ends: edge.ends.map(Name::Drawn),
            });
        }
        let curve = self.sheet(owner)?.curve_named(part)?;
        Some(PartReference::Curve(curve.id))
    }

    /// The curve of a sheet that `curve owner.part` names, even where a panel has such an edge: of
    /// the sheet called so, else of that of the panel called so.
    pub fn curve(&self, owner: &str, part: &str) -> Option<PartReference> {
        let named = self.sheets_named.get(owner).map(|id| &self.sheets[id]);
        let own = named.and_then(|sheet| sheet.curve_named(part));
        let curve = match own {
            Some(curve) => curve,
            None => self.sheet(owner)?.curve_named(part)?,
        };
        Some(PartReference::Curve(curve.id))
    }

    /// The stretch from corner to corner of a panel that `owner.from..owner.to` names.
    pub fn between(&self, owner: &str, [from, to]: [&str; 2]) -> Option<PartReference> {
        let panel = *self.panels_named.get(owner)?;
        Some(PartReference::Stretch {
            panel,
            ends: [
                Name::Drawn(self.point(owner, from)?),
                Name::Drawn(self.point(owner, to)?),
            ],
        })
    }

    /// The seam of that name.
    pub fn seam(&self, name: &str) -> Option<SeamId> {
        self.seams_named.get(name).copied()
    }

    /// Why `owner.part` names nothing, and what may have been meant; `kind` is "point" or "edge".
    pub(crate) fn missing(&self, text: &str, kind: &str) -> (String, String) {
        let Some((owner, part)) = text.split_once('.') else {
            let near = nearest(text, self.seams_named.keys().map(String::as_str));
            let hint = suggestion(near, "name a seam, or a part as in front.armhole");
            return (format!("there is no seam {text:?}"), hint);
        };
        let (owner, part) = (unquoted(owner), unquoted(part));
        let Some(sheet) = self.sheet(owner) else {
            let known = self.panels_named.keys().chain(self.sheets_named.keys());
            let near = nearest(owner, known.map(String::as_str));
            let hint = suggestion(near, "name a panel of this pattern");
            return (format!("there is no panel {owner:?}"), hint);
        };
        let near = if kind == "point" {
            nearest(part, sheet.points.iter().map(|p| &*p.name))
        } else {
            let edges = self.panels_named.get(owner).map(|id| &self.panels[id]);
            let edges = edges
                .into_iter()
                .flat_map(|panel| panel.edges().map(|e| &*e.name));
            nearest(part, edges.chain(sheet.curves.iter().map(|c| &*c.name)))
        };
        let hint = suggestion(near, &format!("name a {kind} of that panel"));
        (format!("panel {owner:?} has no {kind} {part:?}"), hint)
    }

    /// A token with the names of the day; what is gone prints its number, as in `?47`.
    pub fn print(&self, token: &Token) -> String {
        match token {
            Token::Variable(id) if self.by_id => format!("@{}", id.0),
            Token::Part(part) if self.by_id => ids_of(part),
            Token::Text(text) => text.to_string(),
            Token::Word(word) => quoted(word),
            Token::Variable(id) => match self.variable_names.get(id) {
                Some(name) => quoted(name),
                None => format!("?{}", id.0),
            },
            Token::Part(part) => self.print_part(part),
        }
    }

    fn owner_of(&self, sheet: SheetId) -> String {
        let panel = self.traced.get(&sheet).map(|id| &self.panels[id].name);
        match panel.or_else(|| self.sheets.get(&sheet).map(|sheet| &sheet.name)) {
            Some(name) => quoted(name),
            None => format!("?{}", sheet.0),
        }
    }

    /// A part with the names of the day.
    pub fn print_part(&self, part: &PartReference) -> String {
        match part {
            PartReference::Unknown(text) => text.to_string(),
            PartReference::Point(id) => match self.points.get(id) {
                Some((sheet, name)) => format!("{}.{}", self.owner_of(*sheet), quoted(name)),
                None => format!("?{}", id.0),
            },
            PartReference::Curve(id) => match self.curves.get(id) {
                Some((sheet, curve)) => {
                    let owner = self.sheets.get(sheet).map_or("", |sheet| &sheet.name);
                    let text = format!("{}.{}", quoted(owner), quoted(&curve.name));
                    match self.stretch(owner, &curve.name) == Some(part.clone()) {
                        true => text,
                        false => format!("{CURVE} {text}"),
                    }
                }
                None => format!("?{}", id.0),
            },
            PartReference::Seam(id) => match self.seams.get(id) {
                Some(seam) => quoted(&seam.name),
                None => format!("?{}", id.0),
            },
            PartReference::Stretch { panel, ends } => self.print_stretch(*panel, *ends),
        }
    }

    fn print_stretch(&self, id: PanelId, ends: [CornerName; 2]) -> String {
        let Some(panel) = self.panels.get(&id) else {
            return format!("?{}", id.0);
        };
        if let Some(edge) = whole_edge(&panel.lines, ends) {
            return format!("{}.{}", quoted(&panel.name), quoted(edge));
        }
        let corner = |corner: CornerName| match corner {
            Name::Drawn(point) => match self.points.get(&point) {
                Some((_, name)) => quoted(name),
                None => format!("?{}", point.0),
            },
            Name::Made { by, .. } => format!("?{}", by.0),
        };
        let name = quoted(&panel.name);
        format!("{name}.{}..{name}.{}", corner(ends[0]), corner(ends[1]))
    }
}

/// A part by its ids: `@p47` a point, `@c12` a curve, `@s9` a seam, `@e33:47:48` a stretch.
fn ids_of(part: &PartReference) -> String {
    let corner = |corner: CornerName| match corner {
        Name::Drawn(point) => point.0.to_string(),
        Name::Made { by, role, index } => format!("{}.{}.{index}", by.0, role.word()),
    };
    match part {
        PartReference::Point(id) => format!("@p{}", id.0),
        PartReference::Curve(id) => format!("@c{}", id.0),
        PartReference::Seam(id) => format!("@s{}", id.0),
        PartReference::Unknown(text) => text.to_string(),
        PartReference::Stretch { panel, ends } => {
            format!("@e{}:{}:{}", panel.0, corner(ends[0]), corner(ends[1]))
        }
    }
}

/// The part that [`ids_of`] wrote.
pub(super) fn part_of_ids(text: &str) -> Option<PartReference> {
    let (kind, rest) = text.split_at_checked(1)?;
    let corner = |text: &str| -> Option<CornerName> {
        let mut parts = text.split('.');
        let number: u32 = parts.next()?.parse().ok()?;
        Some(match (parts.next(), parts.next()) {
            (Some(role), Some(index)) => Name::Made {
                by: number.into(),
                role: Role::of_word(role)?,
                index: index.parse().ok()?,
            },
            _ => Name::Drawn(number.into()),
        })
    };
    let number = || rest.parse::<u32>().ok();
    Some(match kind {
        "p" => PartReference::Point(number()?.into()),
        "c" => PartReference::Curve(number()?.into()),
        "s" => PartReference::Seam(number()?.into()),
        "e" => {
            let mut parts = rest.split(':');
            let panel: u32 = parts.next()?.parse().ok()?;
            PartReference::Stretch {
                panel: panel.into(),
                ends: [corner(parts.next()?)?, corner(parts.next()?)?],
            }
        }
        _ => return None,
    })
}

/// Name of the edge that spans a stretch alone.
fn whole_edge(lines: &[Line], ends: [CornerName; 2]) -> Option<&str> {
    let [Name::Drawn(from), Name::Drawn(to)] = ends else {
        return None;
    };
    let mut edges = lines.iter().flat_map(|line| &line.edges);
    edges
        .find(|edge| edge.ends == [from, to])
        .map(|edge| &*edge.name)
}

fn unquoted(name: &str) -> &str {
    name.trim_matches('\'')
}

fn suggestion(near: Option<&str>, otherwise: &str) -> String {
    near.map_or_else(|| otherwise.to_owned(), |n| format!("did you mean {n:?}?"))
}
