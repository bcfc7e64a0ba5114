//! Finds the parts at a place of the table, the likeliest first: handle, point, notch or name of a sheet,
//! edge, inner line, curve, panel. Guides are put into the order later, before panels.
//!
//! # Decided with
//! - [`crate::views::pattern::PatternView::pointer`]: hits and snaps put together;
//! - [`crate::views::pattern::PatternView::add_guide_hit`] (`guides.rs`): guides among the hits;
//! - [`crate::tools::select`] (`clicked`): what of it is chosen;
//! - [`crate::canvas::snap::snaps`], [`crate::canvas::guides::on_guides`]: snapping; snapping to guides;
//! - [`crate::tools`] (`toward.rs`, `turned`): round angles;
//! - [`crate::views::marker::MarkerView::at`]: pieces of a marker.

use super::scene::{PanelScene, PointRole, Scene};
use super::selection::{Item, Selection};
use super::sheet_tag::{self, tagged};
use super::table_layout::TableLayout;
use toile_geometry::{Vec2, closest_on_segment};
use toile_pattern::{PanelId, PointId, SheetId};

/// Distance within which the pointer hits a point (pixels).
const POINT_REACH: f64 = 9.0;
/// Distance within which the pointer hits a line (pixels).
const LINE_REACH: f64 = 7.0;

/// A part near the pointer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The part.
    pub item: Item,
    /// The sheet it is on.
    pub sheet: SheetId,
    /// Point of the part nearest to the pointer, in coordinates of the sheet (m).
    pub at: Vec2,
    /// Origin, on the table, of the sheet or panel that the part is drawn on (m).
    pub origin: Vec2,
    /// Distance from the pointer (m).
    pub away: f64,
}

/// A point that is shown, and the sheet or panel on which it is drawn.
#[derive(Clone, Copy, Debug)]
pub struct ShownPoint<'s> {
    /// The point.
    pub point: &'s super::scene::PointScene,
    /// Sheet that the point belongs to.
    pub sheet: SheetId,
    /// Origin, on the table, of the sheet or panel on which the point is drawn (m).
    pub origin: Vec2,
}

/// Points that are shown: corners of outlines always; other points if no panel is traced on their sheet
/// yet, or while a part of the sheet is selected.
pub fn shown_points<'s>(
    scene: &'s Scene,
    table_layout: &TableLayout,
    open: &[SheetId],
) -> Vec<ShownPoint<'s>> {
    let mut shown = Vec::new();
    for sheet in &scene.sheets {
        let is_open = sheet.is_bare || open.contains(&sheet.id);
        let origin = table_layout.sheet(sheet.id);
        let apart: Vec<&PanelScene> = scene
            .panels
            .iter()
            .filter(|panel| panel.sheet == sheet.id && table_layout.is_apart(panel))
            .collect();
        for point in &sheet.points {
            if is_open || (point.role == PointRole::Corner && !point.is_left) {
                shown.push(ShownPoint {
                    point,
                    sheet: sheet.id,
                    origin,
                });
            }
            for panel in &apart {
                let is_own = panel.corners.contains(&point.id);
                let is_left = panel.left.contains(&point.id);
                if is_own && !is_left {
                    shown.push(ShownPoint {
                        point,
                        sheet: sheet.id,
                        origin: table_layout.panel(panel.id),
                    });
                }
            }
        }
    }
    shown
}

/// Sheets with a selected part ("open" sheets).
pub fn open_sheets(scene: &Scene, selection: &Selection) -> Vec<SheetId> {
    let mut sheets: Vec<SheetId> = selection
        .items()
        .iter()
        .filter_map(|item| sheet_of(scene, *item))
        .collect();
    sheets.sort_unstable();
    sheets.dedup();
    sheets
}

/// Sheet on which a part is drawn.
pub fn sheet_of(scene: &Scene, item: Item) -> Option<SheetId> {
    match item {
        Item::Point(id) => Some(scene.point(id)?.0.id),
        Item::Curve(id) => Some(scene.curve(id)?.0.id),
        Item::Sheet(id) => Some(id),
        _ => Some(scene.panel_scene(item.panel()?)?.sheet),
    }
}

/// Parts at a place of the table (m), the most likely first; all points of the `open` sheets are found;
/// `scale` is in pixels per metre.
pub fn hits(
    (scene, table_layout): (&Scene, &TableLayout),
    open: &[SheetId],
    at: Vec2,
    scale: f64,
) -> Vec<Hit> {
    let mut ranked: Vec<(u8, Hit)> = Vec::new();
    let [point_reach, line_reach] = [POINT_REACH, LINE_REACH].map(|reach| reach / scale);
    for shown in shown_points(scene, table_layout, open) {
        let away = (at - shown.origin - shown.point.at).norm();
        if away <= point_reach {
            let rank = match shown.point.role {
                PointRole::Handle => 0,
                PointRole::Corner => 1,
                PointRole::Construction => 2,
            };
            ranked.push((
                rank,
                Hit {
                    item: Item::Point(shown.point.id),
                    sheet: shown.sheet,
                    at: shown.point.at,
                    origin: shown.origin,
                    away,
                },
            ));
        }
    }
    for sheet in tagged(scene, open) {
        let origin = table_layout.sheet(sheet.id);
        if let Some(away) = sheet_tag::distance(sheet, origin, at, scale) {
            let hit = Hit {
                item: Item::Sheet(sheet.id),
                sheet: sheet.id,
                at: Vec2::zeros(),
                origin,
                away,
            };
            ranked.push((3, hit));
        }
    }
    for panel in &scene.panels {
        panel_hits(
            panel,
            table_layout.panel(panel.id),
            at,
            line_reach,
            &mut ranked,
        );
    }
    for sheet in &scene.sheets {
        let origin = table_layout.sheet(sheet.id);
        for curve in &sheet.curves {
            let hit = nearest(&curve.line, at - origin);
            if let Some((place, away)) = hit.filter(|(_, away)| *away <= line_reach) {
                let item = Item::Curve(curve.id);
                let hit = Hit {
                    item,
                    sheet: sheet.id,
                    at: place,
                    origin,
                    away,
                };
                ranked.push((6, hit));
            }
        }
    }
    ranked.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.away.total_cmp(&b.1.away)));
    ranked.into_iter().map(|(_, hit)| hit).collect()
}

fn panel_hits(panel: &PanelScene, origin: Vec2, at: Vec2, reach: f64, ranked: &mut Vec<(u8, Hit)>) {
    let there = at - origin;
    let bounds = panel.bounds();
    let margin = Vec2::new(reach, reach);
    let (low, high) = (bounds.min - margin, bounds.max + margin);
    if there.x < low.x || there.y < low.y || there.x > high.x || there.y > high.y {
        return;
    }
    let mut found = |rank: u8, item: Item, (place, away): (Vec2, f64)| {
        if away <= reach {
            let hit = Hit {
                item,
                sheet: panel.sheet,
                at: place,
                origin,
                away,
            };
            ranked.push((rank, hit));
        }
    };
    let shape = &panel.shape;
    for (id, place, _) in &shape.notches {
        let away = (there - place).norm();
        found(3, Item::Notch(panel.id, *id), (*place, away));
    }
    for (id, mirrored, line) in &shape.darts {
        if let Some(near) = nearest(line, there).filter(|_| !mirrored) {
            found(4, Item::Operation(panel.id, *id), near);
        }
    }
    if let (Some(step), Some(ends)) = (panel.fold_step, panel.fold)
        && let Some(near) = nearest(&ends, there)
    {
        found(4, Item::Operation(panel.id, step), near);
    }
    for (id, _, line) in &shape.creases {
        if let Some(near) = nearest(line, there) {
            found(5, Item::Operation(panel.id, *id), near);
        }
    }
    for (id, line) in &shape.made {
        if let Some(near) = nearest(line, there) {
            found(4, Item::Operation(panel.id, *id), near);
        }
    }
    for edge in &shape.edges {
        let near = edge.lines.iter().filter_map(|line| nearest(line, there));
        if let Some(near) = near.min_by(|a, b| a.1.total_cmp(&b.1)) {
            found(4, Item::Edge(panel.id, edge.id), near);
        }
    }
    for (id, line) in &shape.internal_lines {
        if let Some(near) = nearest(line, there) {
            found(5, Item::Line(panel.id, *id), near);
        }
    }
    if shape.contains(there) {
        found(7, Item::Panel(panel.id), (there, 0.0));
    }
}

/// The point of a polyline nearest to a point (m), and the distance (m).
fn nearest(line: &[Vec2], to: Vec2) -> Option<(Vec2, f64)> {
    line.windows(2)
        .map(|side| {
            let place = closest_on_segment(to, [side[0], side[1]]);
            (place, (place - to).norm())
        })
        .min_by(|a, b| a.1.total_cmp(&b.1))
}

/// The panels that lie wholly inside a rectangle of the table (m); if there are none, the shown points inside
/// it.
pub fn inside_box(
    (scene, table_layout): (&Scene, &TableLayout),
    open: &[SheetId],
    [from, to]: [Vec2; 2],
) -> Vec<Item> {
    let (low, high) = (from.inf(&to), from.sup(&to));
    let within = |p: Vec2| p.x >= low.x && p.y >= low.y && p.x <= high.x && p.y <= high.y;
    let panels: Vec<PanelId> = scene
        .panels
        .iter()
        .filter(|panel| {
            let origin = table_layout.panel(panel.id);
            within(panel.bounds().min + origin) && within(panel.bounds().max + origin)
        })
        .map(|panel| panel.id)
        .collect();
    if !panels.is_empty() {
        return panels.into_iter().map(Item::Panel).collect();
    }
    let points: Vec<PointId> = shown_points(scene, table_layout, open)
        .into_iter()
        .filter(|shown| within(shown.point.at + shown.origin))
        .map(|shown| shown.point.id)
        .collect();
    points.into_iter().map(Item::Point).collect()
}
