//! Order of two vertices by the layers of their cloths.

use std::cmp::Ordering;

/// Layer number of a vertex that cloths of several layers share: it has no order with any.
pub const BETWEEN_LAYERS: u16 = u16::MAX;

/// Order of two vertices by layer, the inner one less; equal within a layer, and where one of them has no order.
pub fn layer_order(layer: &[u16], a: u32, b: u32) -> Ordering {
    match (layer.get(a as usize), layer.get(b as usize)) {
        (Some(&a), Some(&b)) if a != BETWEEN_LAYERS && b != BETWEEN_LAYERS => a.cmp(&b),
        _ => Ordering::Equal,
    }
}
