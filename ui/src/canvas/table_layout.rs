//! The layout of the table: positions of sheets and panels. A sheet lies where the document says; sheets
//! that all lie at one place, as in files without positions, are laid side by side.

use super::scene::{PanelScene, Scene, SheetScene};
use std::collections::BTreeMap;
use toile_geometry::{Bounds2, Vec2};
use toile_pattern::{PanelId, Pattern, SheetId};

/// Gap between sheets (m): enough for seam numbers and names beside narrow panels.
const GAP: f64 = 0.06;
/// Gap between pieces that were pushed apart (m).
const PUSHED: f64 = 0.03;
/// Half the side of the visible area of an empty sheet (m).
const ROOM: f64 = 0.3;
/// Ratio of width to height that sheets arranged in rows have together, as nearly as possible (1): about that
/// of the view.
const ASPECT: f64 = 1.15;

/// Positions of the origins of sheets and panels on the table (m).
#[derive(Clone, Debug, Default)]
pub struct TableLayout {
    /// Sheets that were shifted so that no sheet covers another: the position in the document, and the
    /// shift from that position (m). The shift stays while the pattern is edited, so that no sheet jumps,
    /// until the document gives the sheet another position.
    shifted: BTreeMap<SheetId, ([f64; 2], Vec2)>,
    /// Positions of the sheets when the document was opened (m); a sheet with another position was moved
    /// by the user.
    opened: BTreeMap<SheetId, [f64; 2]>,
    /// Pairs of sheets whose pieces overlapped already when the document was opened: this is intended.
    together: Vec<[SheetId; 2]>,
    /// Shifts of sheets away from pieces that have grown (m).
    pushed: BTreeMap<SheetId, Vec2>,
    sheets: BTreeMap<SheetId, Vec2>,
    panels: BTreeMap<PanelId, Vec2>,
}

impl TableLayout {
    /// Lays out the sheets of a pattern that was just opened.
    pub fn open(&mut self, pattern: &Pattern, scene: &Scene) {
        self.shifted.clear();
        // Sheets that lie on panels have the positions of their panels.
        let mut free = pattern.sheets.iter().filter(|sheet| sheet.on.is_none());
        let first = free.clone().next().map(|sheet| sheet.on_table);
        let is_one = free.clone().count() < 2;
        let at_one_place = free.all(|sheet| Some(sheet.on_table) == first);
        if !is_one && at_one_place {
            let boxes: Vec<(SheetId, Bounds2)> = scene
                .sheets
                .iter()
                .filter(|sheet| sheet.on.is_none())
                .filter_map(|sheet| Some((sheet.id, bounds(sheet, scene)?)))
                .collect();
            let place = first.unwrap_or_default();
            let moved = rows(&boxes).into_iter();
            self.shifted = moved.map(|(id, by)| (id, (place, by))).collect();
        }
        let sheets = pattern.sheets.iter();
        self.opened = sheets.map(|sheet| (sheet.id, sheet.on_table)).collect();
        self.pushed.clear();
        self.follow(pattern);
        let rooms = self.rooms(pattern, scene);
        self.together.clear();
        for (k, (one, room)) in rooms.iter().enumerate() {
            let rest = rooms[k + 1..].iter();
            let over = rest.filter(|(_, other)| overlap(room, other).is_some());
            self.together.extend(over.map(|(other, _)| [*one, *other]));
        }
    }

    /// Pushes sheets apart whose pieces have come to overlap, as after a change of size or when a piece
    /// becomes longer: to the right or downward, whichever is shorter. Affects the display only, not the
    /// positions in the document. Sheets that the user moved stay, and so do sheets that overlapped when
    /// the pattern was opened.
    pub fn push_apart(&mut self, pattern: &Pattern, scene: &Scene) {
        self.pushed.clear();
        self.follow(pattern);
        let by_hand = |id: SheetId| {
            let place = pattern.sheet(id).map(|sheet| sheet.on_table);
            self.opened.get(&id).copied() != place
        };
        let mut rooms = self.rooms(pattern, scene);
        // In the order from the upper left; but sheets that the user moved come first, because they stay.
        rooms.sort_by(|(one, a), (other, b)| {
            let rank = |id: SheetId, room: &Bounds2| (!by_hand(id), room.min.x - room.max.y);
            let (one, other) = (rank(*one, a), rank(*other, b));
            one.0.cmp(&other.0).then(one.1.total_cmp(&other.1))
        });
        let mut pushed = BTreeMap::new();
        for k in 1..rooms.len() {
            let (id, mut room) = rooms[k];
            if by_hand(id) {
                continue;
            }
            let mut by = Vec2::zeros();
            // Each push moves the sheet clear of at least one earlier sheet.
            for _ in 0..rooms.len() {
                let covers = rooms[..k].iter().find_map(|(other, taken)| {
                    let meant = self.together.contains(&[id, *other])
                        || self.together.contains(&[*other, id]);
                    overlap(taken, &room).filter(|_| !meant)
                });
                let Some(way) = covers else { break };
                by += way;
                room = moved(&room, way);
            }
            rooms[k].1 = room;
            if by != Vec2::zeros() {
                pushed.insert(id, by);
            }
        }
        if !pushed.is_empty() {
            self.pushed = pushed;
            self.follow(pattern);
        }
    }

    /// Bounding boxes of the pieces of each sheet on the table, with cut lines (m).
    fn rooms(&self, pattern: &Pattern, scene: &Scene) -> Vec<(SheetId, Bounds2)> {
        let free = pattern.sheets.iter().filter(|sheet| sheet.on.is_none());
        let rooms = free.filter_map(|sheet| {
            let panels = scene.panels.iter().filter(|panel| panel.sheet == sheet.id);
            let rooms = panels.map(|panel| moved(&scene.room_of(panel), self.panel(panel.id)));
            Some((sheet.id, rooms.reduce(|a, b| a.union(&b))?))
        });
        rooms.collect()
    }

    /// Updates the layout after a change of the pattern.
    pub fn follow(&mut self, pattern: &Pattern) {
        let sheets = pattern.sheets.iter();
        self.sheets = sheets
            .map(|sheet| {
                let moved = self.shifted.get(&sheet.id);
                let moved = moved.filter(|(from, _)| *from == sheet.on_table);
                let by = moved.map_or_else(Vec2::zeros, |(_, by)| *by);
                let pushed = self.pushed.get(&sheet.id).copied().unwrap_or_default();
                (sheet.id, Vec2::from(sheet.on_table) + by + pushed)
            })
            .collect();
        let panels = pattern.panels.iter();
        self.panels = panels
            .filter_map(|panel| {
                let sheet = self.sheets.get(&pattern.sheet_of(panel)?)?;
                let own = panel.on_table.map_or_else(Vec2::zeros, Vec2::from);
                Some((panel.id, sheet + own))
            })
            .collect();
        for sheet in &pattern.sheets {
            let panel = sheet.on.and_then(|(panel, _)| self.panels.get(&panel));
            if let Some(place) = panel {
                self.sheets.insert(sheet.id, *place);
            }
        }
    }

    /// Position of a sheet's origin on the table (m).
    pub fn sheet(&self, id: SheetId) -> Vec2 {
        self.sheets.get(&id).copied().unwrap_or_default()
    }

    /// Sheets whose position on the table, without pushes, differs from the one in the document; with the
    /// position on the table (m). Once the document stores the position of one of several sheets it has to
    /// store all.
    pub fn laid_apart(&self, pattern: &Pattern) -> Vec<(SheetId, [f64; 2])> {
        let free = pattern.sheets.iter().filter(|sheet| sheet.on.is_none());
        let laid = |id: SheetId| self.sheet(id) - self.pushed.get(&id).copied().unwrap_or_default();
        let seen = free.map(|sheet| (sheet, <[f64; 2]>::from(laid(sheet.id))));
        let apart = seen.filter(|(sheet, place)| *place != sheet.on_table);
        apart.map(|(sheet, place)| (sheet.id, place)).collect()
    }

    /// Position of a panel's origin on the table (m).
    pub fn panel(&self, id: PanelId) -> Vec2 {
        self.panels.get(&id).copied().unwrap_or_default()
    }

    /// Whether a panel is drawn away from the sheet on which it is traced.
    pub fn is_apart(&self, panel: &PanelScene) -> bool {
        self.panel(panel.id) != self.sheet(panel.sheet)
    }

    /// Bounding box of everything on the table (m).
    pub fn bounds(&self, scene: &Scene) -> Option<Bounds2> {
        let sheets = scene
            .sheets
            .iter()
            .filter(|sheet| sheet.on.is_none())
            .filter_map(|sheet| {
                // If there are several sheets an empty one is shown, too, with room to draw on.
                let room = Vec2::new(ROOM, ROOM);
                let is_seen = scene.sheets.len() > 1;
                let room = is_seen.then(|| Bounds2::of([-room, room]));
                Some(moved(&sheet.bounds().or(room)?, self.sheet(sheet.id)))
            });
        let panels = scene.panels.iter();
        sheets
            .chain(panels.map(|panel| moved(&scene.room_of(panel), self.panel(panel.id))))
            .reduce(|a, b| a.union(&b))
    }
}

fn moved(bounds: &Bounds2, by: Vec2) -> Bounds2 {
    Bounds2 {
        min: bounds.min + by,
        max: bounds.max + by,
    }
}

/// Shortest shift to the right or downward (m) that moves the box `goes` clear of the box `stays`; `None`
/// if they do not overlap.
fn overlap(stays: &Bounds2, goes: &Bounds2) -> Option<Vec2> {
    let common = stays.max.inf(&goes.max) - stays.min.sup(&goes.min);
    if common.x <= 1e-9 || common.y <= 1e-9 {
        return None;
    }
    let right = stays.max.x - goes.min.x + PUSHED;
    let down = goes.max.y - stays.min.y + PUSHED;
    Some(match right <= down {
        true => Vec2::new(right, 0.0),
        false => Vec2::new(0.0, -down),
    })
}

/// Bounding box of the panels of a sheet (m); of its points and curves if it has no panels.
fn bounds(sheet: &SheetScene, scene: &Scene) -> Option<Bounds2> {
    let panels = scene.panels.iter().filter(|panel| panel.sheet == sheet.id);
    let drawn = panels
        .map(PanelScene::bounds)
        .copied()
        .reduce(|a, b| a.union(&b));
    // Points and curves of a sheet with panels do not count: those far outside would push neighbours away
    // needlessly.
    drawn.or_else(|| sheet.bounds())
}

/// Arranges the boxes of sheets in rows, in the given order; returns where the origin of each sheet goes (m).
fn rows(boxes: &[(SheetId, Bounds2)]) -> BTreeMap<SheetId, Vec2> {
    let sizes: Vec<Vec2> = boxes
        .iter()
        .map(|(_, bounds)| bounds.max - bounds.min + Vec2::new(GAP, GAP))
        .collect();
    let width = best_width(&sizes);
    let mut places = BTreeMap::new();
    let mut pen = Vec2::zeros();
    let mut row = 0.0_f64;
    for ((id, bounds), size) in boxes.iter().zip(&sizes) {
        if pen.x > 0.0 && pen.x + size.x > width {
            pen = Vec2::new(0.0, pen.y - row);
            row = 0.0;
        }
        places.insert(*id, pen - Vec2::new(bounds.min.x, bounds.max.y));
        pen.x += size.x;
        row = row.max(size.y);
    }
    places
}
/// Width of rows (m) at which the box round all rows comes nearest to the ratio `ASPECT`; tries 25 widths,
/// from the widest box to all boxes in one row.
fn best_width(sizes: &[Vec2]) -> f64 {
    let widest = sizes.iter().map(|s| s.x).fold(0.0, f64::max);
    let total: f64 = sizes.iter().map(|s| s.x).sum();
    let steps = 24;
    (0..=steps)
        .map(|k| widest + (total - widest) * f64::from(k) / f64::from(steps))
        .min_by(|a, b| misfit(sizes, *a).total_cmp(&misfit(sizes, *b)))
        .unwrap_or(widest)
}

/// Height of the smallest box of the ratio `ASPECT` that holds all rows, if these have a given width (m).
fn misfit(sizes: &[Vec2], width: f64) -> f64 {
    let (mut x, mut row, mut used, mut height) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0);
    for size in sizes {
        if x > 0.0 && x + size.x > width + 1e-12 {
            height += row;
            (x, row) = (0.0, 0.0);
        }
        x += size.x;
        used = used.max(x);
        row = row.max(size.y);
    }
    (used / ASPECT).max(height + row)
}
