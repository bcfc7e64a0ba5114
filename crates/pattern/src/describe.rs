//! Descriptions of diagnostic places in words, and the places of parts.

use crate::{EdgeName, Name, Panel, PanelId, PartId, Pattern, Place};

impl Pattern {
    /// Description of a diagnostic place, with the names of the parts.
    pub fn describe(&self, place: &Place) -> String {
        let panel = |id: PanelId| match self.panel(id) {
            Some(panel) => format!("panel {:?}", panel.name),
            None => id.to_string(),
        };
        let named = |kind: &str, name: Option<&str>, number: String| match name {
            Some(name) => format!("{kind} {name:?}"),
            None => number,
        };
        let part = |id: PanelId, kind: &str, name: Option<&str>, number: String| {
            format!("{}, {}", panel(id), named(kind, name, number))
        };
        match place {
            Place::Pattern => format!("pattern {:?}", self.name),
            Place::Size(id) => {
                let found = self.sizes.iter().find(|size| size.id == *id);
                named("size", found.map(|s| &*s.name), id.to_string())
            }
            Place::Variable(id) => {
                let found = self.variables.iter().find(|variable| variable.id == *id);
                named("variable", found.map(|v| &*v.name), id.to_string())
            }
            Place::Sheet(id) => {
                let found = self.sheet(*id);
                named("sheet", found.map(|s| &*s.name), id.to_string())
            }
            Place::Point(id) => match self.point(*id) {
                Some((sheet, point)) => format!("sheet {:?}, point {:?}", sheet.name, point.name),
                None => id.to_string(),
            },
            Place::Curve(id) => {
                let mut sheets = self.sheets.iter();
                match sheets.find_map(|sheet| Some((sheet, sheet.curve(*id)?))) {
                    Some((sheet, c)) => format!("sheet {:?}, curve {:?}", sheet.name, c.name),
                    None => id.to_string(),
                }
            }
            Place::Panel(id) => panel(*id),
            Place::Line(id, line) => {
                let found = self.panel(*id).and_then(|p| p.line(*line));
                part(*id, "line", found.map(|l| &*l.name), line.to_string())
            }
            Place::Edge(id, edge) => {
                let found = self.panel(*id).and_then(|p| p.edge(*edge));
                part(*id, "edge", found.map(|e| &*e.name), edge.to_string())
            }
            Place::Operation(id, operation) => {
                let mut all = self.panel(*id).into_iter().flat_map(|p| &p.operations);
                let found = all.find(|o| o.id == *operation);
                let kind = found.map_or("operation", |o| o.kind.word());
                part(*id, kind, found.map(|o| &*o.name), operation.to_string())
            }
            Place::Notch(id, notch) => {
                let mut all = self.panel(*id).into_iter().flat_map(|p| &p.notches);
                let found = all.find(|n| n.id == *notch);
                part(*id, "notch", found.map(|n| &*n.name), notch.to_string())
            }
            Place::Seam(id) | Place::SeamEnd(id, _) => {
                named("seam", self.seam(*id).map(|s| &*s.name), id.to_string())
            }
            Place::Fabric(id) => {
                named("fabric", self.fabric(*id).map(|f| &*f.name), id.to_string())
            }
            Place::Marker(id) => {
                named("marker", self.marker(*id).map(|m| &*m.name), id.to_string())
            }
            Place::Guide(id) => self.guide_words(*id).unwrap_or_else(|| id.to_string()),
            Place::File { path, line, column } => {
                format!("line {line}, column {column}, {path}")
            }
        }
    }

    /// Name of an edge of a panel, or of the operation that made the edge. `None`: the panel has no such
    /// edge.
    pub fn edge_name(&self, panel: PanelId, name: EdgeName) -> Option<&str> {
        let lineage = self.lineage(self.panel(panel)?);
        match name {
            Name::Drawn(id) => {
                let edge = lineage.iter().find_map(|own| own.edge(id));
                edge.map(|edge| &*edge.name)
            }
            Name::Made { by, .. } => {
                let mut operations = lineage.iter().flat_map(|own| &own.operations);
                operations.find(|o| o.id == by).map(|o| &*o.name)
            }
        }
    }

    /// All parts of the document, each with its id and its diagnostic place.
    pub fn parts(&self) -> Vec<(PartId, Place)> {
        let mut parts: Vec<(PartId, Place)> = Vec::new();
        parts.extend(self.sizes.iter().map(|s| (s.id.into(), Place::Size(s.id))));
        let variables = self.variables.iter();
        parts.extend(variables.map(|v| (v.id.into(), Place::Variable(v.id))));
        parts.extend(
            self.fabrics
                .iter()
                .map(|f| (f.id.into(), Place::Fabric(f.id))),
        );
        for sheet in &self.sheets {
            parts.push((sheet.id.into(), Place::Sheet(sheet.id)));
            parts.extend(
                sheet
                    .points
                    .iter()
                    .map(|p| (p.id.into(), Place::Point(p.id))),
            );
            parts.extend(
                sheet
                    .curves
                    .iter()
                    .map(|c| (c.id.into(), Place::Curve(c.id))),
            );
        }
        for panel in &self.panels {
            parts.push((panel.id.into(), Place::Panel(panel.id)));
            parts.extend(panel.own_parts());
        }
        parts.extend(self.seams.iter().map(|s| (s.id.into(), Place::Seam(s.id))));
        let markers = self.markers.iter();
        parts.extend(markers.map(|m| (m.id.into(), Place::Marker(m.id))));
        parts.extend(
            self.guides
                .iter()
                .map(|g| (g.id.into(), Place::Guide(g.id))),
        );
        parts
    }
}

impl Panel {
    /// All parts inside the panel, each with its id and its diagnostic place.
    pub fn own_parts(&self) -> Vec<(PartId, Place)> {
        let id = self.id;
        let mut parts: Vec<(PartId, Place)> = Vec::new();
        for line in &self.lines {
            parts.push((line.id.into(), Place::Line(id, line.id)));
            parts.extend(
                line.edges
                    .iter()
                    .map(|e| (e.id.into(), Place::Edge(id, e.id))),
            );
        }
        parts.extend(
            self.notches
                .iter()
                .map(|n| (n.id.into(), Place::Notch(id, n.id))),
        );
        let operations = self.operations.iter();
        parts.extend(operations.map(|o| (o.id.into(), Place::Operation(id, o.id))));
        parts
    }
}
