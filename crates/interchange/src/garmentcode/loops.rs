//! Orders edges that come in any order into closed loops.

/// An edge of a loop: its index in the file, and whether the loop walks it backwards.
pub(super) type LoopEdge = (usize, bool);

/// The reason why edges form no closed loops: the edge at fault and the fault.
pub(super) type LoopError = (usize, String);

/// Sorts edges, given by their end vertices, into closed loops. Each loop has the direction of its first
/// edge. Edges that are already in order, as in GarmentCode's own files, keep their order.
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
