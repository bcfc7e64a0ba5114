//! Blocks as their inserts place them: moved, turned, mirrored.

use super::drawing::{Block, Drawn, Insert};
use toile_geometry::Vec2;

/// A line placed as an insert says.
fn placed(p: Vec2, base: Vec2, insert: &Insert) -> Vec2 {
    let (sin, cos) = insert.turn.sin_cos();
    let own = p - base;
    let scaled = Vec2::new(own.x * insert.scale[0], own.y * insert.scale[1]);
    insert.at
        + Vec2::new(
            cos * scaled.x - sin * scaled.y,
            sin * scaled.x + cos * scaled.y,
        )
}

/// A block as its insert places it.
pub(super) fn moved(block: &Block, insert: &Insert) -> Block {
    let mut block = block.clone();
    let base = block.base;
    for entity in &mut block.entities {
        match &mut entity.drawn {
            Drawn::Line { points, .. } => {
                points
                    .iter_mut()
                    .for_each(|p| *p = placed(*p, base, insert));
            }
            Drawn::Point { at, .. } | Drawn::Text { at, .. } => *at = placed(*at, base, insert),
        }
    }
    block
}
