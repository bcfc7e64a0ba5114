//! Pieces and lines as another program drew them, in metres, in all sizes.

use toile_geometry::{Curve, Vec2, ring_area};
use toile_pattern::{Cut, NotchKind};

/// Most chords that stand for one curve of a line, where its places are measured.
const MAX_CHORDS: usize = 64;
/// Fewest chords that do so on a line of very many curves.
const MIN_CHORDS: usize = 4;
/// Number of chords that a line of many curves is kept to.
const CHORDS: usize = 20_000;

/// A pattern as another program drew it.
#[derive(Clone, Debug, Default)]
pub(crate) struct DrawnPattern {
    /// Name of the style; empty if the file has none.
    pub name: String,
    /// Names of the sizes, from small to large; empty if there is one size only.
    pub sizes: Vec<String>,
    /// Index of the base size.
    pub base: usize,
    /// The pieces.
    pub pieces: Vec<DrawnPiece>,
    /// Grade rules that the file numbers: the number, and the shift in each size against the base size (m).
    pub rules: Vec<(u32, Vec<Vec2>)>,
}

/// A piece.
#[derive(Clone, Debug, Default)]
pub(crate) struct DrawnPiece {
    /// Name of the piece.
    pub name: String,
    /// Name of its fabric, if the file says it.
    pub fabric: Option<String>,
    /// Number of pieces cut.
    pub cut: Cut,
    /// The line that is sewn, closed; the cut line if the file has no other.
    pub outline: DrawnLine,
    /// The cut line in the base size, if it is another than the outline.
    pub cut_line: Option<Vec<Vec2>>,
    /// The cut line in all sizes, where the file has it so.
    pub cut_outline: Option<DrawnLine>,
    /// Closed lines that are cut out.
    pub holes: Vec<DrawnLine>,
    /// Lines drawn inside.
    pub inside: Vec<DrawnLine>,
    /// Notches.
    pub notches: Vec<DrawnNotch>,
    /// Places of drill holes in each size (m).
    pub drills: Vec<Vec<Vec2>>,
    /// Direction of the warp (rad), if the file draws a grain line.
    pub grain: Option<f64>,
    /// Both ends of the line that lies on the fold of the cloth, in the base size; the piece is then a half.
    pub fold: Option<[Vec2; 2]>,
}

/// What a line is from a vertex to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum Span {
    /// A chord: curves are fitted where vertices show them.
    #[default]
    Chord,
    /// A straight line, as the file says.
    Straight,
    /// A cubic Bezier curve with these handles (m).
    Cubic([Vec2; 2]),
}

/// A line through vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct DrawnLine {
    /// Its vertices in each size (m); all sizes have as many. A closed line does not repeat its start.
    pub by_size: Vec<Vec<Vec2>>,
    /// Whether it runs back to its first vertex.
    pub is_closed: bool,
    /// For each vertex, whether the file marks it as a corner; empty if the file marks no corners.
    pub is_corner: Vec<bool>,
    /// For each vertex, what the line is to the next; chords where the list is too short. Lines of several sizes have
    /// chords alone.
    pub spans: Vec<Span>,
    /// In each size, for each vertex the points of the curve between it and the next one (m), where the file has such
    /// points of chords.
    pub between: Vec<Vec<Vec<Vec2>>>,
}

/// A line as chords that follow its curves.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Chords {
    /// Ends of the chords (m).
    pub points: Vec<Vec2>,
    /// For each vertex of the line, its index among them.
    pub starts: Vec<usize>,
}

impl Chords {
    /// The vertex before a chord, whose number may run beyond the last.
    pub fn vertex(&self, chord: usize) -> usize {
        let chord = chord % self.points.len();
        self.starts.partition_point(|&start| start <= chord) - 1
    }

    /// The place on a chord as the vertex before it, and the share of the length of the span after that.
    pub fn place(&self, chord: usize, share: f64) -> (usize, f64) {
        let vertex = self.vertex(chord);
        let start = self.starts[vertex];
        let end = self.starts.get(vertex + 1).copied();
        let end = end.unwrap_or(self.points.len());
        let at = |k: usize| self.points[k % self.points.len()];
        let length = |k: usize| (at(k + 1) - at(k)).norm();
        let whole: f64 = (start..end).map(length).sum();
        let before: f64 = (start..chord).map(length).sum();
        let part = (before + share * length(chord)) / whole.max(f64::MIN_POSITIVE);
        (vertex, part.clamp(0.0, 1.0))
    }
}

/// A notch.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct DrawnNotch {
    /// Its place on or beside the outline in the base size (m).
    pub at: Vec2,
    /// Its places in all sizes (m), where the file has them; else it keeps its share between two vertices.
    pub in_sizes: Vec<Option<Vec2>>,
    /// Its shape.
    pub kind: NotchKind,
}

impl DrawnLine {
    /// A line in one size.
    pub fn one(points: Vec<Vec2>, is_closed: bool) -> Self {
        Self {
            by_size: vec![points],
            is_closed,
            ..Self::default()
        }
    }

    /// What the line is from a vertex to the next.
    pub fn span(&self, vertex: usize) -> Span {
        self.spans.get(vertex).copied().unwrap_or_default()
    }

    /// The points of the curve between a vertex and the next one in a size.
    pub fn between_in(&self, size: usize, vertex: usize) -> &[Vec2] {
        let own = self.between.get(size).or(self.between.first());
        let own = own.and_then(|vertices| vertices.get(vertex));
        own.map_or(&[], Vec::as_slice)
    }

    /// Chords along the line in a size, the curves cut into equal steps.
    pub fn chords(&self, size: usize) -> Chords {
        let vertices = self.in_size(size);
        let is_cubic = |way: &&Span| matches!(way, Span::Cubic(_));
        let cubics = self.spans.iter().filter(is_cubic).count();
        let count = (CHORDS / cubics.max(1)).clamp(MIN_CHORDS, MAX_CHORDS);
        let mut chords = Chords::default();
        for (k, &start) in vertices.iter().enumerate() {
            chords.starts.push(chords.points.len());
            chords.points.push(start);
            if !self.is_closed && k + 1 == vertices.len() {
                break;
            }
            match self.span(k) {
                Span::Straight => {}
                Span::Chord => chords.points.extend(self.between_in(size, k)),
                Span::Cubic(controls) => {
                    let end = vertices[(k + 1) % vertices.len()];
                    let curve = Curve::Cubic {
                        start,
                        controls,
                        end,
                    };
                    let steps = 1..count;
                    let at = |step: usize| curve.point(step as f64 / count as f64);
                    chords.points.extend(steps.map(at));
                }
            }
        }
        chords
    }

    /// The area that it encloses in a size (m2), positive if it runs counter-clockwise.
    pub fn area(&self, size: usize) -> f64 {
        ring_area(&self.chords(size).points)
    }

    /// The line with all its points mapped.
    #[must_use]
    pub fn mapped(&self, map: impl Fn(Vec2) -> Vec2) -> Self {
        let points = |points: &Vec<Vec2>| points.iter().map(|&p| map(p)).collect();
        let span = |span: &Span| match span {
            Span::Cubic(handles) => Span::Cubic(handles.map(&map)),
            Span::Chord => Span::Chord,
            Span::Straight => Span::Straight,
        };
        Self {
            by_size: self.by_size.iter().map(points).collect(),
            is_closed: self.is_closed,
            is_corner: self.is_corner.clone(),
            spans: self.spans.iter().map(span).collect(),
            between: self
                .between
                .iter()
                .map(|vertices| vertices.iter().map(points).collect())
                .collect(),
        }
    }

    /// Its vertices in a size; those of the first size where it has no others.
    pub fn in_size(&self, size: usize) -> &[Vec2] {
        let own = self.by_size.get(size).or(self.by_size.first());
        own.map_or(&[], Vec::as_slice)
    }

    /// The vertices from one to another in a size, with the points between them; `to` may lie beyond the last vertex of
    /// a closed line. Also the index of each vertex among them.
    pub fn stretch(&self, size: usize, (from, to): (usize, usize)) -> (Vec<Vec2>, Vec<usize>) {
        let vertices = self.in_size(size);
        let (mut points, mut indices) = (Vec::new(), Vec::new());
        for k in from..=to {
            indices.push(points.len());
            points.push(vertices[k % vertices.len()]);
            if k < to {
                points.extend(self.between_in(size, k % vertices.len()));
            }
        }
        (points, indices)
    }

    /// Number of its vertices.
    pub fn len(&self) -> usize {
        self.by_size.first().map_or(0, Vec::len)
    }

    /// Turns it round.
    pub fn reverse(&mut self) {
        self.by_size.iter_mut().for_each(|points| points.reverse());
        self.is_corner.reverse();
        if !self.spans.is_empty() {
            self.spans.resize(self.len(), Span::Chord);
            self.spans.reverse();
            // The span before a vertex is after it now.
            self.spans.rotate_left(1);
            for span in &mut self.spans {
                if let Span::Cubic(handles) = span {
                    handles.reverse();
                }
            }
        }
        for stretches in &mut self.between {
            stretches.iter_mut().for_each(|points| points.reverse());
            stretches.reverse();
            // Of an open line the last stretch is empty.
            if !stretches.is_empty() {
                stretches.rotate_left(1);
            }
        }
    }

    /// Removes the vertices of these numbers, and the spans before them; points between go to the vertex before.
    pub fn remove(&mut self, is_gone: &[bool]) {
        let count = self.len();
        if !self.spans.is_empty() {
            self.spans.resize(count, Span::Chord);
            // A vertex that stays goes on by the span of the last one that is gone after it.
            let on = |k: usize| {
                let gone_after = (1..count).take_while(|step| is_gone[(k + step) % count]);
                self.span((k + gone_after.count()) % count)
            };
            let stay = (0..count).filter(|&k| !is_gone[k]);
            self.spans = stay.map(on).collect();
        }
        for stretches in &mut self.between {
            let mut kept: Vec<Vec<Vec2>> = Vec::new();
            let mut first: Vec<Vec2> = Vec::new();
            for (points, &is_gone) in std::mem::take(stretches).into_iter().zip(is_gone) {
                match (is_gone, kept.last_mut()) {
                    (false, _) => kept.push(points),
                    (true, Some(last)) => last.extend(points),
                    (true, None) => first.extend(points),
                }
            }
            if let Some(last) = kept.last_mut() {
                last.extend(first);
            }
            *stretches = kept;
        }
        let mut kept = is_gone.iter().map(|is_gone| !is_gone).cycle();
        for points in &mut self.by_size {
            points.retain(|_| kept.next().unwrap_or(true));
        }
        if !self.is_corner.is_empty() {
            self.is_corner.retain(|_| kept.next().unwrap_or(true));
        }
    }

    /// Removes vertices that lie on the one before them in every size, within a tolerance (m).
    pub fn drop_repeats(&mut self, tolerance: f64) {
        let count = self.len();
        let repeats = |k: usize| {
            let before = match k {
                0 if self.is_closed => count - 1,
                0 => return false,
                k => k - 1,
            };
            let near = |points: &Vec<Vec2>| (points[k] - points[before]).norm() <= tolerance;
            let is_loop = matches!(self.span(before), Span::Cubic(_));
            count > 1 && !is_loop && self.by_size.iter().all(near)
        };
        let gone: Vec<bool> = (0..count).map(repeats).collect();
        for k in (0..count).filter(|&k| gone[k]) {
            // The vertex that stays is a corner if any of those that lie there is one.
            let before = (k + count - 1) % count;
            if self.is_corner.get(k) == Some(&true) {
                self.is_corner[before] = true;
            }
        }
        self.remove(&gone);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeats_go_only_where_all_sizes_repeat() {
        let at = |x: f64| Vec2::new(x, 0.0);
        let mut line = DrawnLine {
            by_size: vec![
                vec![at(0.0), at(0.0), at(1.0), at(1.0)],
                vec![at(0.0), at(0.0), at(1.0), at(1.1)],
            ],
            is_closed: false,
            is_corner: vec![false, true, false, false],
            spans: Vec::new(),
            between: vec![vec![vec![], vec![at(0.5)], vec![at(1.05)], vec![]]; 2],
        };
        line.drop_repeats(1e-6);
        assert_eq!(line.by_size[0], [at(0.0), at(1.0), at(1.0)]);
        assert_eq!(line.by_size[1], [at(0.0), at(1.0), at(1.1)]);
        assert_eq!(line.is_corner, [true, false, false]);
        assert_eq!(line.between[0], [vec![at(0.5)], vec![at(1.05)], vec![]]);
        line.reverse();
        assert_eq!(line.between[1], [vec![at(1.05)], vec![at(0.5)], vec![]]);
    }

    #[test]
    fn spans_follow_their_vertices() {
        let at = |x: f64, y: f64| Vec2::new(x, y);
        let handles = [at(1.0, 0.5), at(1.0, 0.8)];
        let mut line = DrawnLine {
            spans: vec![
                Span::Straight,
                Span::Straight,
                Span::Cubic(handles),
                Span::Straight,
            ],
            ..DrawnLine::one(
                vec![at(0.0, 0.0), at(1.0, 0.0), at(1.0, 0.0), at(0.0, 1.0)],
                true,
            )
        };
        line.drop_repeats(1e-9);
        assert_eq!(
            line.spans,
            [Span::Straight, Span::Cubic(handles), Span::Straight]
        );
        let area = line.area(0);
        let mut turned = line.clone();
        turned.reverse();
        assert_eq!(
            turned.in_size(0),
            [at(0.0, 1.0), at(1.0, 0.0), at(0.0, 0.0)]
        );
        assert_eq!(turned.span(0), Span::Cubic([handles[1], handles[0]]));
        assert!((turned.area(0) + area).abs() < 1e-12);
        let chords = line.chords(0);
        assert_eq!(chords.starts, [0, 1, 1 + MAX_CHORDS]);
        turned.reverse();
        assert_eq!(turned, line);
        // The last vertex lies on the first one.
        let mut line = DrawnLine {
            spans: vec![Span::Cubic(handles), Span::Straight, Span::Straight],
            ..DrawnLine::one(vec![at(0.0, 0.0), at(1.0, 0.0), at(0.0, 0.0)], true)
        };
        line.drop_repeats(1e-9);
        assert_eq!(line.in_size(0), [at(1.0, 0.0), at(0.0, 0.0)]);
        assert_eq!(line.spans, [Span::Straight, Span::Cubic(handles)]);
    }
}
