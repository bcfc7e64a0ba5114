//! Names of points: placed beside them on the side without curves, and clear of names placed before.

use super::hit::ShownPoint;
use super::paint::Picture;
use super::scene::{PanelScene, PointRole, SheetScene};
use super::selection::Item;
use crate::theme;
use egui::{Pos2, Rect, Vec2, vec2};

/// Directions from a point in which its name can stand (Y down), the preferred first.
const SIDES: [Vec2; 8] = [
    vec2(1.0, -1.0),
    vec2(1.0, 1.0),
    vec2(-1.0, -1.0),
    vec2(-1.0, 1.0),
    vec2(1.0, 0.0),
    vec2(-1.0, 0.0),
    vec2(0.0, -1.0),
    vec2(0.0, 1.0),
];
/// Gap between a point and its name (pixels).
const GAP: f32 = 8.0;
/// Half the side of the mark of a point (pixels).
const MARK: f32 = 5.0;

/// Rectangle of a name beside a point.
fn beside(at: Pos2, size: Vec2, side: Vec2) -> Rect {
    let away = match side.x * side.y == 0.0 {
        true => side * (GAP + 2.0),
        false => side * GAP,
    };
    Rect::from_center_size(at + away + side * size * 0.5, size)
}

/// Whether a line segment meets a rectangle.
fn crosses(rect: Rect, [from, to]: [Pos2; 2]) -> bool {
    let way = to - from;
    let mut stretch = [0.0_f32, 1.0];
    let spans = [
        (from.x, way.x, rect.min.x, rect.max.x),
        (from.y, way.y, rect.min.y, rect.max.y),
    ];
    for (start, by, low, high) in spans {
        if by == 0.0 {
            if start < low || start > high {
                return false;
            }
            continue;
        }
        let [a, b] = [(low - start) / by, (high - start) / by];
        stretch = [stretch[0].max(a.min(b)), stretch[1].min(a.max(b))];
    }
    stretch[0] <= stretch[1]
}

/// Obstacles that names avoid: pieces of other sheets, and lines.
#[derive(Clone, Copy, Default)]
struct Around<'a> {
    others: &'a [Rect],
    lines: &'a [Vec<Pos2>],
}

/// Rectangle for a name at a point that overlaps no rectangle of `taken`; preferably one without other
/// pieces and lines in it. `None` if all places are taken.
fn place(at: Pos2, size: Vec2, taken: &[Rect], around: Around<'_>) -> Option<Rect> {
    let is_free = |rect: &Rect| !taken.iter().any(|other| other.intersects(*rect));
    let Around { others, lines } = around;
    let runs_into = |rect: &Rect| others.iter().any(|other| other.intersects(*rect));
    let crossed = |rect: &Rect| {
        let crosses = |line: &&Vec<Pos2>| line.windows(2).any(|w| crosses(*rect, [w[0], w[1]]));
        lines.iter().filter(crosses).count()
    };
    let places = SIDES.iter().map(|side| beside(at, size, *side));
    places
        .filter(is_free)
        .min_by_key(|rect| (runs_into(rect), crossed(rect)))
}

impl Picture<'_> {
    /// Paints the names of points: of selected or hovered points always; of the other points on open sheets
    /// if there is room.
    pub(super) fn point_names(&self, points: &[ShownPoint<'_>], labels: &mut Vec<Rect>) {
        let view = self.view.expand(20.0);
        let seen = |shown: &ShownPoint<'_>| self.seen(shown.origin, shown.point.at);
        let points = points.iter().filter(|shown| view.contains(seen(shown)));
        let is_lit = |shown: &&&ShownPoint<'_>| self.is_lit(Item::Point(shown.point.id));
        for shown in points.clone().filter(|shown| is_lit(&shown)) {
            let tag = self.words_on(&shown.point.name, self.palette.accent, |size, _| {
                let usual = beside(seen(shown), size, SIDES[0]);
                place(seen(shown), size, labels, Around::default()).unwrap_or(usual)
            });
            labels.push(tag);
        }
        let is_named = |shown: &&&ShownPoint<'_>| {
            let is_open = self.open.contains(&shown.sheet) || self.scene.panels.is_empty();
            is_open && !shown.point.is_left && shown.point.role != PointRole::Handle
        };
        let named: Vec<_> = points
            .clone()
            .filter(|shown| is_named(&shown) && !is_lit(&shown))
            .collect();
        if named.is_empty() {
            return;
        }
        let marks = points.map(|shown| {
            let mark = Vec2::splat(2.0 * MARK);
            Rect::from_center_size(seen(shown), mark)
        });
        let mut taken: Vec<Rect> = labels.iter().copied().chain(marks).collect();
        for sheet in &self.scene.sheets {
            let mut named = named.iter().filter(|shown| shown.sheet == sheet.id);
            let Some(first) = named.next() else {
                continue;
            };
            let (others, lines) = (self.others_by(sheet), self.lines_by(sheet));
            let around = Around {
                others: &others,
                lines: &lines,
            };
            for shown in std::iter::once(first).chain(named) {
                let colour = self.palette.ink_soft;
                let name = shown.point.name.clone();
                let name = self.painter.layout_no_wrap(name, theme::font(11.5), colour);
                if let Some(rect) = place(seen(shown), name.size(), &taken, around) {
                    self.painter.galley(rect.min, name, colour);
                    taken.push(rect);
                    labels.push(rect);
                }
            }
        }
    }

    /// Rectangles of all panels except those that lie on the given sheet.
    fn others_by(&self, sheet: &SheetScene) -> Vec<Rect> {
        let others = self.scene.panels.iter();
        let others =
            others.filter(|panel| panel.sheet != sheet.id || self.table_layout.is_apart(panel));
        others
            .map(|panel| {
                let (origin, room) = (self.table_layout.panel(panel.id), self.scene.room_of(panel));
                Rect::from_two_pos(self.seen(origin, room.min), self.seen(origin, room.max))
            })
            .collect()
    }

    /// Lines of a sheet, and of the panels that lie on the sheet.
    fn lines_by(&self, sheet: &SheetScene) -> Vec<Vec<Pos2>> {
        let origin = self.table_layout.sheet(sheet.id);
        let curves = sheet.curves.iter().map(|curve| &curve.line[..]);
        let on_it =
            |panel: &&PanelScene| panel.sheet == sheet.id && !self.table_layout.is_apart(panel);
        let panels = self.scene.panels.iter().filter(on_it);
        let of_panels = panels.flat_map(|panel| {
            let shape = &panel.shape;
            let edges = shape.edges.iter().flat_map(|edge| &edge.lines);
            let darts = shape.darts.iter().map(|(.., line)| line);
            let made = shape.made.iter().map(|(_, line)| line);
            let cut = self.allowances.then(|| self.scene.cut_lines.of(panel.id));
            let all = edges.chain(darts).chain(made).map(|line| &line[..]);
            all.chain(cut.into_iter().flatten().map(|ring| &ring[..]))
        });
        let all = curves.chain(of_panels);
        all.map(|line| self.line(origin, line)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::pos2;

    #[test]
    fn a_name_stands_where_no_line_and_no_name_is() {
        let at = pos2(100.0, 100.0);
        let size = vec2(40.0, 12.0);
        let usual = place(at, size, &[], Around::default()).unwrap();
        assert!(usual.min.x > at.x && usual.max.y < at.y);
        // A line from the point through the preferred place.
        let line = vec![at, pos2(200.0, 60.0)];
        let lines = [line.clone()];
        let crossed = Around {
            lines: &lines,
            ..Around::default()
        };
        let other = place(at, size, &[], crossed).unwrap();
        assert!(!crosses(other, [line[0], line[1]]) && other != usual);
        // A line of the own piece is the lesser evil than the next piece.
        let next = [Rect::from_min_max(pos2(104.0, 60.0), pos2(300.0, 200.0))];
        let walls = [vec![pos2(90.0, 0.0), pos2(90.0, 200.0)]];
        let between = Around {
            others: &next,
            lines: &walls,
        };
        let own = place(at, size, &[], between).unwrap();
        assert!(!own.intersects(next[0]), "{own:?}");
        // Names never overlap, whatever lines cross them.
        let mut taken = Vec::new();
        while let Some(rect) = place(at, size, &taken, crossed) {
            assert!(taken.iter().all(|known: &Rect| !known.intersects(rect)));
            taken.push(rect);
        }
        assert!((4..=SIDES.len()).contains(&taken.len()), "{taken:?}");
    }

    #[test]
    fn a_line_crosses_a_rectangle_if_it_comes_into_it() {
        let rect = Rect::from_min_max(pos2(0.0, 0.0), pos2(10.0, 4.0));
        assert!(crosses(rect, [pos2(-5.0, 2.0), pos2(20.0, 2.0)]));
        assert!(crosses(rect, [pos2(3.0, 1.0), pos2(4.0, 2.0)]));
        assert!(!crosses(rect, [pos2(-5.0, 3.0), pos2(5.0, 13.0)]));
        assert!(!crosses(rect, [pos2(20.0, 0.0), pos2(20.0, 4.0)]));
    }
}
