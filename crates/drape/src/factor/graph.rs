//! Which vertices a symmetric matrix couples.

/// For every vertex the vertices its row of the matrix has entries for: ascending, itself
/// included, and symmetric.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Graph {
    start: Vec<usize>,
    columns: Vec<u32>,
}

impl Graph {
    /// The graph of some coupled pairs; either order will do, and a pair may come twice.
    ///
    /// # Panics
    /// When a pair names a vertex there is not.
    pub fn from_pairs(vertices: usize, pairs: impl IntoIterator<Item = [u32; 2]>) -> Self {
        let mut entries: Vec<[u32; 2]> = (0..vertices as u32).map(|v| [v, v]).collect();
        for [a, b] in pairs {
            entries.push([a, b]);
            if a != b {
                entries.push([b, a]);
            }
        }
        entries.sort_unstable();
        entries.dedup();
        let mut start = vec![0; vertices + 1];
        for &[row, _] in &entries {
            start[row as usize + 1] += 1;
        }
        for row in 0..vertices {
            start[row + 1] += start[row];
        }
        Self {
            start,
            columns: entries.into_iter().map(|[_, column]| column).collect(),
        }
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.start.len().saturating_sub(1)
    }

    /// The vertices coupled with one, ascending, itself included.
    pub fn row(&self, vertex: usize) -> &[u32] {
        &self.columns[self.start[vertex]..self.start[vertex + 1]]
    }

    /// Entries in the longest row.
    pub fn longest_row(&self) -> usize {
        (0..self.vertex_count())
            .map(|v| self.row(v).len())
            .max()
            .unwrap_or(0)
    }
}
