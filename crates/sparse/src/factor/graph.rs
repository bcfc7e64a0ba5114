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
        let pairs: Vec<[u32; 2]> = pairs.into_iter().collect();
        // Rows as long as they may be: each vertex itself, and every pair both ways.
        let mut first = vec![0usize; vertices + 1];
        for &[a, b] in &pairs {
            first[a as usize + 1] += 1;
            first[b as usize + 1] += 1;
        }
        for row in 0..vertices {
            first[row + 1] += first[row] + 1;
        }
        let mut entries = vec![0; first[vertices]];
        let mut next = first.clone();
        let mut enter = |row: u32, column: u32| {
            entries[next[row as usize]] = column;
            next[row as usize] += 1;
        };
        (0..vertices as u32).for_each(|v| enter(v, v));
        for &[a, b] in &pairs {
            enter(a, b);
            enter(b, a);
        }
        let mut graph = Self {
            start: vec![0],
            columns: Vec::with_capacity(entries.len()),
        };
        for row in 0..vertices {
            let row = &mut entries[first[row]..first[row + 1]];
            row.sort_unstable();
            let mut last = u32::MAX;
            for &column in row.iter() {
                if column != last {
                    graph.columns.push(column);
                    last = column;
                }
            }
            graph.start.push(graph.columns.len());
        }
        graph
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
