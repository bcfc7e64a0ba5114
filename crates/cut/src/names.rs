//! Names of edges and corners of a cut piece, in words.

use toile_pattern::{EdgeOrigin, Name, Panel};

/// Words for an edge: its name if it was drawn on a panel of `lineage`, else the operation that made it.
pub(crate) fn edge_words(lineage: &[&Panel], origin: EdgeOrigin) -> String {
    match origin.name {
        Name::Drawn(id) => match lineage.iter().find_map(|panel| panel.edge(id)) {
            Some(edge) => format!("edge {:?}", edge.name),
            None => id.to_string(),
        },
        Name::Made { by, .. } => {
            let mut operations = lineage.iter().flat_map(|panel| &panel.operations);
            match operations.find(|operation| operation.id == by) {
                Some(operation) => format!("{} {:?}", operation.kind.word(), operation.name),
                None => by.to_string(),
            }
        }
    }
}
