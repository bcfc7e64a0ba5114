//! The drawing of a cut piece: lines, areas and words by kind. Prints, markers, their files and the window
//! draw a piece from the drawing alone.
//!
//! # Decided with
//! - [`crate::piece::CutPiece`]: what is drawn;
//! - [`crate::drawing::StrokeKind`], [`crate::piece::CutPiece::grain_arrow`]: kinds of lines; the grain;
//! - [`crate::notch::shape`], [`crate::press::FoldTick`]: notches; fold lines;
//! - [`toile_pattern::press_arrows`]: arrows of what is pressed.
//!
//! Styles: crate `interchange` (`print/draw.rs`, `marker_strokes.rs`, `marker_svg.rs`) and the window
//! (`views/marker_paint.rs`). By hand: the legend of prints (`print/title.rs`) and `marker_svg.rs`.

use crate::CutNotch;
use crate::label::Spot;
use crate::label_block::{Label, Words, label};
use crate::piece::{CutPiece, PieceRing, PieceSegment};
use toile_geometry::{Polygon, Vec2};
use toile_pattern::{CornerName, LineName, NotchId};

/// The purpose of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum StrokeKind {
    /// A line to cut along.
    Cut,
    /// A line to sew along.
    Sew,
    /// Another line drawn inside the piece.
    Inside,
    /// A notch, to cut along.
    Notch,
    /// A notch that is drawn, as there is no allowance to cut it into.
    Mark,
    /// The fold of the cloth.
    Fold,
    /// The grain line with its arrow.
    Grain,
    /// A cross at the end of a dart, to be drilled or tacked.
    Drill,
}

/// The part of the piece that a line draws.
#[derive(Clone, Debug, PartialEq)]
pub enum StrokeName {
    /// A closed line, with the name of each segment.
    Ring(Vec<PieceSegment>),
    /// A line of the panel.
    Line(LineName),
    /// A notch.
    Notch(NotchId),
    /// A corner that a dart made, and the half of a folded panel that it is on.
    Corner(CornerName, u8),
    /// The piece as a whole.
    Piece,
}

/// A line through points.
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    /// Purpose of the line.
    pub kind: StrokeKind,
    /// Part of the piece that the line draws.
    pub name: StrokeName,
    /// Corners of the line (m).
    pub points: Vec<Vec2>,
    /// Whether the last point is joined to the first.
    pub closed: bool,
}

/// A piece drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawing {
    /// The area of the cloth.
    pub fill: Option<Polygon>,
    /// Lines, in the order of their kinds: later ones are drawn over earlier ones.
    pub strokes: Vec<Stroke>,
    /// Words written on the piece.
    pub words: Vec<Words>,
}

/// The text to write on a piece, with limits on its size and place.
#[derive(Clone, Copy, Debug, Default)]
pub struct Writing<'w> {
    /// Lines of text, the first one in the largest letters.
    pub lines: &'w [&'w str],
    /// Largest height of letters (m); `None`: the usual height.
    pub most: Option<f64>,
    /// Lines that words must not lie on, besides the lines of the piece (m).
    pub clear_of: &'w [[Vec2; 2]],
}

/// Height of letters on the largest pieces and on the smallest (m).
const LETTERS: [f64; 2] = [0.022, 0.004];
/// Arm of the cross at the end of a dart (m).
const DRILL: f64 = 0.003;

impl StrokeKind {
    /// Whether a knife follows the line.
    pub fn is_cut(self) -> bool {
        matches!(self, Self::Cut | Self::Notch)
    }
}

impl CutPiece {
    /// Drawing of the piece. `place` maps points of the piece to points of the drawing: moved, turned, turned
    /// over or scaled. The texts `lines` are written on the piece, the first one in the largest letters.
    pub fn drawing(&self, place: impl Fn(Vec2) -> Vec2, lines: &[&str]) -> Drawing {
        let writing = Writing {
            lines,
            ..Writing::default()
        };
        self.drawing_with(place, &writing)
    }

    /// [`Self::drawing`] with limits on the size and place of the words.
    pub fn drawing_with(&self, place: impl Fn(Vec2) -> Vec2, writing: &Writing<'_>) -> Drawing {
        let placed = |points: &[Vec2]| points.iter().map(|&p| place(p)).collect::<Vec<Vec2>>();
        let mut strokes = Vec::new();
        let mut draw = |kind, name, points: Vec<Vec2>, closed| {
            if points.len() > 1 {
                strokes.push(Stroke {
                    kind,
                    name,
                    points,
                    closed,
                });
            }
        };
        let mut rings = |kind, rings: &[PieceRing]| {
            for (points, segments, closed) in rings.iter().flat_map(off_the_fold) {
                draw(kind, StrokeName::Ring(segments), placed(&points), closed);
            }
        };
        rings(StrokeKind::Cut, &self.cut);
        rings(StrokeKind::Sew, &self.sew);
        for line in &self.inside {
            let name = StrokeName::Line(line.name);
            draw(StrokeKind::Inside, name, placed(&line.points), false);
        }
        for notch in self.notches_seen() {
            let name = StrokeName::Notch(notch.id);
            for points in &notch.cut {
                draw(StrokeKind::Notch, name.clone(), placed(points), false);
            }
            let drawn = notch.cut.is_empty().then(|| notch.on_seam_line());
            for points in drawn.iter().flatten() {
                draw(StrokeKind::Mark, name.clone(), placed(points), false);
            }
        }
        if let Some(ends) = self.on_fold {
            draw(StrokeKind::Fold, StrokeName::Piece, placed(&ends), false);
        }
        for drill in &self.drills {
            for arm in [Vec2::new(DRILL, 0.0), Vec2::new(0.0, DRILL)] {
                let name = StrokeName::Corner(drill.name, drill.half);
                let ends = placed(&[drill.at - arm, drill.at + arm]);
                draw(StrokeKind::Drill, name, ends, false);
            }
        }
        let polygon = self.polygon().mapped(&place);
        // Words and grain line lie inside the seam lines and clear of darts if the seam lines are known.
        let inner = match self.sew.is_empty() {
            true => polygon.clone(),
            false => self.sewn().mapped(&place),
        };
        let mut clear_of = inner_lines(&strokes);
        clear_of.extend(writing.clear_of);
        let most = writing.most.unwrap_or(LETTERS[0]);
        let letters = |spot: &Spot| letters(spot).min(most);
        let label = label(&inner, &clear_of, (writing.lines, letters));
        let grain = self.grain_arrow(&place, &label).into_iter();
        strokes.extend(grain.map(|points| Stroke {
            kind: StrokeKind::Grain,
            name: StrokeName::Piece,
            points,
            closed: false,
        }));
        strokes.sort_by_key(|stroke| stroke.kind);
        Drawing {
            fill: Some(polygon),
            strokes,
            words: label.words,
        }
    }

    /// Notches of the piece; of notches that look alike only the first.
    pub fn notches_seen(&self) -> impl Iterator<Item = &CutNotch> {
        let seen = self.notches.iter().enumerate();
        seen.filter(|(k, notch)| !self.notches[..*k].iter().any(|n| n.looks_like(notch)))
            .map(|(_, notch)| notch)
    }

    /// The grain line and its arrow head, at the free spot of `label`: above the words if they lie there,
    /// else in the middle of the spot.
    fn grain_arrow(&self, place: impl Fn(Vec2) -> Vec2, label: &Label) -> Vec<Vec<Vec2>> {
        let spot = &label.spot;
        let along = Vec2::new(self.grain.cos(), self.grain.sin());
        let way = (place(along) - place(Vec2::zeros())).try_normalize(0.0);
        let Some(way) = way.filter(|_| spot.room > 0.0) else {
            return Vec::new();
        };
        // The whole arrow lies inside the free circle round the spot, and above the words if the words are at
        // the spot.
        let (centre, reach) = match label.above {
            true => {
                let up = label.words.first().map_or(Vec2::y(), Words::up);
                let rise = way.dot(&up).abs();
                let reach = spot.room * (0.42 / rise.max(1e-9)).min(0.75);
                let above = (0.2 * spot.room).max(reach * rise + 0.08 * spot.room);
                (spot.at + up * above, reach)
            }
            false => (spot.at, 0.75 * spot.room),
        };
        let [tail, head] = [centre - way * reach, centre + way * reach];
        let side = Vec2::new(-way.y, way.x);
        let barb = (letters(spot) * 0.6).min(reach * 0.6);
        let wing = |s: f64| head - way * barb + side * (barb * s);
        vec![vec![tail, head], vec![wing(0.5), head, wing(-0.5)]]
    }
}

/// Lines that words keep clear of, other than the outline.
fn inner_lines(strokes: &[Stroke]) -> Vec<[Vec2; 2]> {
    use StrokeKind::{Drill, Inside, Mark, Notch};
    let inner = |s: &&Stroke| matches!(s.kind, Inside | Notch | Mark | Drill);
    let lines = strokes.iter().filter(inner);
    lines
        .flat_map(|stroke| stroke.points.windows(2).map(|pair| [pair[0], pair[1]]))
        .collect()
}

/// A closed line as a whole, or, where it lies partly on the fold of the cloth, the parts off the fold. Each
/// part has corners, segments, and whether it is closed.
fn off_the_fold(ring: &PieceRing) -> Vec<(Vec<Vec2>, Vec<PieceSegment>, bool)> {
    let count = ring.points.len();
    let on_fold = |k: usize| ring.segments[k % count] == PieceSegment::Fold;
    let Some(first) = (0..ring.segments.len()).find(|&k| on_fold(k)) else {
        return vec![(ring.points.clone(), ring.segments.clone(), true)];
    };
    let mut parts = Vec::new();
    let mut part: (Vec<Vec2>, Vec<PieceSegment>, bool) = (Vec::new(), Vec::new(), false);
    for k in first + 1..=first + count {
        part.0.push(ring.points[k % count]);
        if on_fold(k) {
            parts.push(std::mem::take(&mut part));
        } else {
            part.1.push(ring.segments[k % count]);
        }
    }
    parts
}

/// Height of the letters of the first line at a spot (m).
fn letters(spot: &Spot) -> f64 {
    (spot.room * 0.3).clamp(LETTERS[1], LETTERS[0])
}
