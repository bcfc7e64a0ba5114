//! Orders edges that come in any order into closed loops.

/// An edge of a loop: its index in the file, and whether it is walked backwards.
pub(super) type LoopEdge = (usize, bool);

/// Why edges are no closed loops: the edge at fault and what is wrong with it.
pub(super) type LoopError = (usize, String);

/// Arranges edges, given by their end vertices, into closed loops, each in the direction of its
/// first edge. Edges that are in order already, as files of this kind have them, stay so.
pub(super) fn closed_loops(edges: &[[usize; 2]]) -> Result<Vec<Vec<LoopEdge>>, LoopError> {
    let vertex_count = edges.iter().flatten().max().map_or(0, |&v| v + 1);
    let mut at_vertex: Vec<Vec<usize>> = vec![Vec::new(); vertex_count];
    for (k, &[a, b]) in edges.iter().enumerate() {
        if a == b {
            return Err((k, "it starts and ends at one vertex".to_owned()));
        }
        at_vertex[a].push(k);
        at_vertex[b].push(k);
    }
    for (k, edge) in edges.iter().enumerate() {
        for &v in edge {
            if at_vertex[v].len() != 2 {
                let count = at_vertex[v].len();
                return Err((k, format!("{count} edges meet at its vertex {v}, not two")));
            }
        }
    }
    let mut used = vec![false; edges.len()];
    let mut loops = Vec::new();
    for first in 0..edges.len() {
        if used[first] {
            continue;
        }
        let mut walk = vec![(first, false)];
        used[first] = true;
        let mut tip = edges[first][1];
        while let Some(&next) = at_vertex[tip].iter().find(|&&e| !used[e]) {
            used[next] = true;
            let backwards = edges[next][1] == tip && edges[next][0] != tip;
            walk.push((next, backwards));
            tip = edges[next][usize::from(!backwards)];
        }
        loops.push(walk);
    }
    Ok(loops)
}
