//! The points that define the shape of a selection of parts.

use crate::{Evaluation, Panel, PartId, Pattern, PointId, fields};
use std::collections::BTreeSet;

/// The points that define the shapes of parts, each once, in the order of their sheets. For a point, the
/// point itself; for a curve, its ends, handles and knots; for an edge, line or panel, the points of the
/// curves that it follows and the dart ends in it; for a sheet, all its points. Other parts have no points.
pub fn points_of(evaluation: &Evaluation, parts: &[PartId]) -> Vec<PointId> {
    let pattern = evaluation.pattern();
    let mut found: BTreeSet<PointId> = BTreeSet::new();
    for &part in parts {
        collect(pattern, part, &mut found);
    }
    let all = pattern.sheets.iter().flat_map(|sheet| &sheet.points);
    let chosen = all.map(|point| point.id).filter(|id| found.contains(id));
    chosen.collect()
}

fn collect(pattern: &Pattern, part: PartId, found: &mut BTreeSet<PointId>) {
    let panels = || pattern.panels.iter();
    match part {
        PartId::Point(id) => {
            found.insert(id);
        }
        PartId::Curve(id) => {
            if let Some((_, curve)) = pattern.curve(id) {
                found.extend(curve.ends);
                found.extend(fields::points(&curve.rule));
            }
        }
        PartId::Edge(id) => {
            for edge in panels().filter_map(|panel| panel.edge(id)) {
                found.extend(edge.ends);
                collect(pattern, edge.curve.into(), found);
            }
        }
        PartId::Line(id) => {
            let lines = panels().filter_map(|panel| panel.line(id));
            for edge in lines.flat_map(|line| &line.edges) {
                collect(pattern, edge.id.into(), found);
            }
        }
        PartId::Operation(id) => {
            let all = panels().flat_map(|panel| &panel.operations);
            let own = all.filter(|operation| operation.id == id);
            found.extend(own.flat_map(|operation| fields::points(&operation.kind)));
        }
        PartId::Panel(id) => {
            let panel = pattern.panel(id);
            found.extend(panel.into_iter().flat_map(|panel| apexes(panel)));
            for line in panel.into_iter().flat_map(|panel| &panel.lines) {
                collect(pattern, line.id.into(), found);
            }
        }
        PartId::Sheet(id) => {
            let sheet = pattern.sheet(id);
            let points = sheet.into_iter().flat_map(|sheet| &sheet.points);
            found.extend(points.map(|point| point.id));
        }
        PartId::Size(_)
        | PartId::Variable(_)
        | PartId::Fabric(_)
        | PartId::Notch(_)
        | PartId::Seam(_)
        | PartId::Marker(_)
        | PartId::Guide(_) => {}
    }
}

/// Points inside a panel that its operations use, such as the apexes of darts.
fn apexes(panel: &Panel) -> Vec<PointId> {
    let kinds = panel.operations.iter().map(|operation| &operation.kind);
    kinds.flat_map(|kind| fields::points(kind)).collect()
}
