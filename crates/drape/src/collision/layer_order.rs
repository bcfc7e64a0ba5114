//! Which of two cloths worn one over another lies farther inside.

use std::cmp::Ordering;

/// Layer of a vertex that hangs in cloths of several layers: it is in order with none.
pub const BETWEEN_LAYERS: u16 = u16::MAX;

/// Which of two vertices' cloths lies farther inside; equal where they are in no order.
pub fn layer_order(layer: &[u16], a: u32, b: u32) -> Ordering {
    match (layer.get(a as usize), layer.get(b as usize)) {
        (Some(&a), Some(&b)) if a != BETWEEN_LAYERS && b != BETWEEN_LAYERS => a.cmp(&b),
        _ => Ordering::Equal,
    }
}
