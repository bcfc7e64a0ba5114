//! Builds a sheet and the panel traced from it together, for importers.

use super::{
    Curve, CurveRule, Edge, EdgeCorner, Line, LineKind, Panel, Pattern, Point, PointRule, Sheet,
    Span,
};
use crate::{CurveId, EdgeId, FabricId, Ids, LineId, Mark, Name, PanelId, PointId, SheetId};
use std::sync::Arc;

/// A sheet and the panel traced from it, while they are being built.
#[derive(Debug)]
pub struct PanelBuilder<'i> {
    ids: &'i mut Ids,
    /// The sheet as built so far.
    pub sheet: Sheet,
    /// The panel as built so far.
    pub panel: Panel,
}

impl<'i> PanelBuilder<'i> {
    /// An empty sheet and an empty panel, both with the given name.
    pub fn new(ids: &'i mut Ids, name: &str, fabric: FabricId) -> Self {
        let sheet = Sheet {
            id: ids.take::<SheetId>(),
            name: name.to_owned(),
            ..Sheet::default()
        };
        let panel = Panel::new(ids.take::<PanelId>(), name, sheet.id, fabric);
        Self { ids, sheet, panel }
    }

    /// Adds a point to the sheet.
    pub fn point(&mut self, name: impl Into<String>, rule: PointRule) -> PointId {
        let id: PointId = self.ids.take();
        self.sheet.points.push(Arc::new(Point {
            id,
            name: name.into(),
            rule,
        }));
        id
    }

    /// Adds a curve to the sheet and returns an edge that follows the whole curve.
    pub fn edge(&mut self, name: impl Into<String>, ends: [PointId; 2], rule: CurveRule) -> Edge {
        let name = name.into();
        let curve: CurveId = self.ids.take();
        self.sheet.curves.push(Arc::new(Curve {
            id: curve,
            name: name.clone(),
            ends,
            rule,
        }));
        Edge {
            id: self.ids.take::<EdgeId>(),
            name,
            curve,
            ends,
            allowance: None,
            corner: EdgeCorner::default(),
        }
    }

    /// Adds a line with these edges to the panel.
    pub fn line(&mut self, name: impl Into<String>, kind: LineKind, edges: Vec<Edge>) -> LineId {
        let id: LineId = self.ids.take();
        self.panel.lines.push(Line {
            id,
            name: name.into(),
            kind,
            by: None,
            edges,
        });
        id
    }

    /// A new id.
    pub fn id<T: From<crate::FreshId>>(&mut self) -> T {
        self.ids.take()
    }

    /// The finished sheet and the finished panel.
    pub fn done(self) -> (Arc<Sheet>, Arc<Panel>) {
        (Arc::new(self.sheet), Arc::new(self.panel))
    }
}

impl CurveRule {
    /// A cubic Bezier curve with two handles.
    pub fn cubic(handles: [PointId; 2]) -> Self {
        Self::Spline {
            handles,
            knots: Vec::new(),
            to_length: None,
        }
    }
}

impl Panel {
    /// The span of a whole edge on copy 0, in the direction of the edge. `None`: the panel has no such edge.
    pub fn span(&self, edge: EdgeId) -> Option<Span> {
        let line = self.line_of(edge)?;
        let ends = self.edge(edge)?.ends;
        Some(Span {
            panel: self.id,
            copy: 0,
            half: 0,
            line: Name::Drawn(line.id),
            from: Mark::corner(ends[0]),
            to: Mark::corner(ends[1]),
            backwards: false,
        })
    }
}

impl Pattern {
    /// Adds a sheet and the panel traced from it.
    pub fn add(&mut self, (sheet, panel): (Arc<Sheet>, Arc<Panel>)) {
        self.sheets.push(sheet);
        self.panels.push(panel);
    }
}
