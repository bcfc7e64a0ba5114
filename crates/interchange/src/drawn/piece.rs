//! Pieces and lines as another program drew them, in metres, in all sizes.

use toile_geometry::Vec2;
use toile_pattern::{Cut, NotchKind};

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

/// A line through vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct DrawnLine {
    /// Vertices in each size (m); all sizes have as many. A closed line does not repeat its start.
    pub by_size: Vec<Vec<Vec2>>,
    /// Whether it runs back to its first vertex.
    pub is_closed: bool,
    /// For each vertex, whether the file marks it as a corner; empty if the file marks no corners.
    pub is_corner: Vec<bool>,
    /// In each size, for each vertex the points of the curve between it and the next one (m); empty if the file has no
    /// such points.
    pub between: Vec<Vec<Vec<Vec2>>>,
}

/// A notch.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct DrawnNotch {
    /// Place on or beside the outline in the base size (m).
    pub at: Vec2,
    /// Places in all sizes (m), where the file has them; else it keeps its share between two vertices.
    pub in_sizes: Vec<Option<Vec2>>,
    /// Shape of the cut.
    pub kind: NotchKind,
}

impl DrawnLine {
    /// A line in one size.
    #[cfg(test)]
    pub fn one(points: Vec<Vec2>, is_closed: bool) -> Self {
        Self {
            by_size: vec![points],
            is_closed,
            ..Self::default()
        }
    }

    /// The points of the curve between a vertex and the next one in a size.
    pub fn between_in(&self, size: usize, vertex: usize) -> &[Vec2] {
        let own = self.between.get(size).or(self.between.first());
        let own = own.and_then(|vertices| vertices.get(vertex));
        own.map_or(&[], Vec::as_slice)
    }

    /// Vertices in a size; those of the first size where it has no others.
    pub fn in_size(&self, size: usize) -> &[Vec2] {
        let own = self.by_size.get(size).or(self.by_size.first());
        own.map_or(&[], Vec::as_slice)
    }

    /// Number of its vertices.
    pub fn len(&self) -> usize {
        self.by_size.first().map_or(0, Vec::len)
    }

    /// Turns it round.
    pub fn reverse(&mut self) {
        self.by_size.iter_mut().for_each(|points| points.reverse());
        self.is_corner.reverse();
        for stretches in &mut self.between {
            stretches.iter_mut().for_each(|points| points.reverse());
            stretches.reverse();
            // The stretch after a vertex is before it now; of an open line the last stretch is empty.
            if !stretches.is_empty() {
                stretches.rotate_left(1);
            }
        }
    }

    /// Removes the vertices of these numbers; what lies between goes to the vertex before.
    pub fn remove(&mut self, is_gone: &[bool]) {
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
            count > 1 && self.by_size.iter().all(near)
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
}
