//! The cut list: pieces to cut, by fabric.

use crate::piece::CutPiece;
use toile_pattern::{Draft, Pattern};

/// The pieces cut from one fabric.
#[derive(Clone, Debug, PartialEq)]
pub struct CutList {
    /// The fabric.
    pub fabric: String,
    /// Pieces cut from the fabric, in the order of the pattern.
    pub pieces: Vec<CutListPiece>,
}

/// A panel in a cut list.
#[derive(Clone, Debug, PartialEq)]
pub struct CutListPiece {
    /// Name of the panel.
    pub name: String,
    /// Number of pieces to cut.
    pub quantity: u32,
    /// Number of mirrored pairs among these pieces: one piece of each pair is cut turned over.
    pub pairs: u32,
    /// Area of one piece as cut, holes taken out (m2).
    pub area: f64,
}

impl CutList {
    /// Area of all pieces of the list (m2).
    pub fn area(&self) -> f64 {
        let all = self.pieces.iter().map(|p| f64::from(p.quantity) * p.area);
        all.sum()
    }
}

/// The cut list of a draft, one list for each fabric, with one entry for the first copy of each panel.
/// Fabrics are in the order in which the pieces name them. Further copies among `pieces` are left out.
pub fn cut_list((pattern, draft): (&Pattern, &Draft), pieces: &[CutPiece]) -> Vec<CutList> {
    let mut lists: Vec<CutList> = Vec::new();
    for cut in pieces.iter().filter(|piece| piece.id.copy == 0) {
        let drafted = draft.pieces.iter().find(|piece| piece.id == cut.id);
        let fabric = drafted.and_then(|piece| draft.fabrics.get(piece.fabric));
        let (Some(fabric), Some(panel)) = (fabric, pattern.panel(cut.id.panel)) else {
            continue;
        };
        let entry = CutListPiece {
            name: panel.name.clone(),
            quantity: panel.cut.quantity,
            pairs: if panel.cut.mirrored {
                panel.cut.quantity / 2
            } else {
                0
            },
            area: cut.polygon().area(),
        };
        match lists.iter_mut().find(|list| list.fabric == fabric.name) {
            Some(list) => list.pieces.push(entry),
            None => lists.push(CutList {
                fabric: fabric.name.clone(),
                pieces: vec![entry],
            }),
        }
    }
    lists
}
