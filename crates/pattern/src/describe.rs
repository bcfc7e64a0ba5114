//! Places in words.

use crate::{PanelId, Pattern, Place};

impl Pattern {
    /// A place in words, with the names of the parts.
    pub fn describe(&self, place: &Place) -> String {
        let panel = |id: PanelId| match self.panel(id) {
            Some(panel) => format!("panel {:?}", panel.name),
            None => id.to_string(),
        };
        let part = |id: PanelId, kind: &str, name: Option<&str>, number: String| match name {
            Some(name) => format!("{}, {kind} {name:?}", panel(id)),
            None => format!("{}, {number}", panel(id)),
        };
        let owner = |id: PanelId| self.panel(id);
        match place {
            Place::Pattern => format!("pattern {:?}", self.name),
            Place::Size(name) => format!("size {name:?}"),
            Place::Variable(name) => format!("variable {name:?}"),
            Place::Panel(id) => panel(*id),
            Place::Point(id, point) => {
                let name = owner(*id).and_then(|p| p.point(*point));
                part(*id, "point", name.map(|p| &*p.name), point.to_string())
            }
            Place::Edge(id, edge) => {
                let name = owner(*id).and_then(|p| p.edge(*edge));
                part(*id, "edge", name.map(|e| &*e.name), edge.to_string())
            }
            Place::Hole(id, k) => format!("{}, hole {}", panel(*id), k + 1),
            Place::InternalLine(id, line) => {
                let mut lines = owner(*id).into_iter().flat_map(|p| &p.internal_lines);
                let name = lines.find(|l| l.id == *line).map(|l| &*l.name);
                part(*id, "internal line", name, line.to_string())
            }
            Place::Dart(id, dart) => {
                let mut darts = owner(*id).into_iter().flat_map(|p| &p.darts);
                let name = darts.find(|d| d.id == *dart).map(|d| &*d.name);
                part(*id, "dart", name, dart.to_string())
            }
            Place::Notch(id, notch) => {
                let mut notches = owner(*id).into_iter().flat_map(|p| &p.notches);
                let name = notches.find(|n| n.id == *notch).map(|n| &*n.name);
                part(*id, "notch", name, notch.to_string())
            }
            Place::Seam(id) => match self.seam(*id) {
                Some(seam) => format!("seam {:?}", seam.name),
                None => id.to_string(),
            },
            Place::Fabric(id) => match self.fabric(*id) {
                Some(fabric) => format!("fabric {:?}", fabric.name),
                None => id.to_string(),
            },
            Place::File { path, line, column } => {
                format!("line {line}, column {column}, {path}")
            }
        }
    }
}
