//! The outline of a panel as cubic curves between its corners, darts closed by the line of their mouths.

use crate::Flattened;
use crate::cubics::{Cubic, fit};
use toile_geometry::{Vec2, closest_on_segment};

/// Turn of the outline that makes a corner (rad).
pub const CORNER: f64 = 0.4;

/// One edge of an outline: cubics from end to end, the next begins where one ends.
#[derive(Clone, Debug, PartialEq)]
pub struct OutlineEdge {
    /// The cubics.
    pub cubics: Vec<Cubic>,
    /// The dart whose mouth the edge is.
    pub mouth: Option<usize>,
}

/// A dart on the outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutlineDart {
    /// Index of the dart.
    pub dart: usize,
    /// The apex (m).
    pub apex: Vec2,
    /// Width of the mouth (m).
    pub intake: f64,
    /// How far its legs are from straight (m).
    pub bow: f64,
}

/// The outline of a panel, counter-clockwise.
#[derive(Clone, Debug, PartialEq)]
pub struct PanelOutline {
    /// Edges in order; the last ends where the first begins.
    pub edges: Vec<OutlineEdge>,
    /// Darts that open.
    pub darts: Vec<OutlineDart>,
    /// Darts whose sides overlap: they need a gusset and are left open as part of the outline.
    pub gussets: Vec<usize>,
}

/// The outline of a panel with its curves within a tolerance (m).
pub fn panel_outline(flat: &Flattened, tolerance: f64) -> PanelOutline {
    let mut gussets = Vec::new();
    let mut darts = Vec::new();
    let count = flat.region.vertex_count();
    let mut is_inside = vec![false; count];
    let mut mouth_of = vec![None; count];
    for (k, dart) in flat.darts.iter().enumerate() {
        if dart.overlaps(&flat.places) {
            gussets.push(k);
            continue;
        }
        let place = |v: u32| flat.places[v as usize];
        let Some((&apex, ends)) = dart
            .left
            .last()
            .zip(dart.left.first().zip(dart.right.first()))
        else {
            continue;
        };
        let bow = |leg: &[u32], end: u32| {
            leg.iter()
                .map(|&v| {
                    (place(v) - closest_on_segment(place(v), [place(end), place(apex)])).norm()
                })
                .fold(0.0, f64::max)
        };
        darts.push(OutlineDart {
            dart: k,
            apex: place(apex),
            intake: dart.intake(&flat.places),
            bow: bow(&dart.left, *ends.0).max(bow(&dart.right, *ends.1)),
        });
        for &v in dart.left[1..].iter().chain(&dart.right[1..]) {
            is_inside[v as usize] = true;
        }
        for &v in [ends.0, ends.1] {
            mouth_of[v as usize] = Some(k);
        }
    }
    let ring: Vec<u32> = (flat.region.outline().iter().copied())
        .filter(|&v| !is_inside[v as usize])
        .collect();
    let place = |k: usize| flat.places[ring[k % ring.len()] as usize];
    let mouth = |k: usize| mouth_of[ring[k % ring.len()] as usize];
    let is_corner = |k: usize| {
        let before = place(k) - place(k + ring.len() - 1);
        let after = place(k + 1) - place(k);
        mouth(k).is_some() || before.angle(&after) > CORNER
    };
    let mut corners: Vec<usize> = (0..ring.len()).filter(|&k| is_corner(k)).collect();
    // A smooth ring, as a circle, still begins somewhere and has two edges, so that no edge ends where it begins.
    match corners[..] {
        [] => corners = vec![0, ring.len() / 2],
        [only] => {
            corners.push((only + ring.len() / 2) % ring.len());
            corners.sort_unstable();
        }
        _ => {}
    }
    let edges = (0..corners.len())
        .map(|k| {
            let from = corners[k];
            let to = match corners.get(k + 1) {
                Some(&next) => next,
                None => corners[0] + ring.len(),
            };
            let points: Vec<Vec2> = (from..=to).map(place).collect();
            OutlineEdge {
                cubics: fit(&points, tolerance),
                mouth: mouth(from).filter(|_| to == from + 1 && mouth(to) == mouth(from)),
            }
        })
        .collect();
    PanelOutline {
        edges,
        darts,
        gussets,
    }
}
