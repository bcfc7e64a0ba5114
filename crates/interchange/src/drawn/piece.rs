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
    /// Closed lines that are cut out.
    pub holes: Vec<DrawnLine>,
    /// Lines drawn inside.
    pub inside: Vec<DrawnLine>,
    /// Notches.
    pub notches: Vec<DrawnNotch>,
    /// Direction of the warp (rad), if the file draws a grain line.
    pub grain: Option<f64>,
    /// Both ends of the line that lies on the fold of the cloth, in the base size; the piece is then a half.
    pub fold: Option<[Vec2; 2]>,
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
    #[cfg(test)]
    pub fn one(points: Vec<Vec2>, is_closed: bool) -> Self {
        Self {
            by_size: vec![points],
            is_closed,
            is_corner: Vec::new(),
        }
    }

    /// Its vertices in a size; those of the first size where it has no others.
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
        let mut kept = gone.iter().map(|gone| !gone).cycle();
        for points in &mut self.by_size {
            points.retain(|_| kept.next().unwrap_or(true));
        }
        if !self.is_corner.is_empty() {
            self.is_corner.retain(|_| kept.next().unwrap_or(true));
        }
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
        };
        line.drop_repeats(1e-6);
        assert_eq!(line.by_size[0], [at(0.0), at(1.0), at(1.0)]);
        assert_eq!(line.by_size[1], [at(0.0), at(1.0), at(1.1)]);
        assert_eq!(line.is_corner, [true, false, false]);
    }
}
