//! Finds the marks of a pattern that must match a print, by their names.

use crate::NestOptions;
use toile_geometry::Vec2;
use toile_pattern::{MarkRef, Notch, NotchId, Panel, PanelId, Pattern};

/// The marks of a pattern: number of the set, panel and notch. Marks that do not exist are left out.
pub(crate) fn resolve_marks(
    pattern: &Pattern,
    options: &NestOptions,
) -> Vec<(usize, PanelId, NotchId)> {
    let mut marks = Vec::new();
    let is_in = |set: usize, panel: &Panel, notch: &Notch| match &options.marker {
        Some(marker) => marker.matched.get(set).is_some_and(|set| {
            set.0.contains(&MarkRef {
                panel: panel.id,
                notch: notch.id,
            })
        }),
        None => options
            .settings
            .matched
            .get(set)
            .is_some_and(|names| names.contains(&format!("{}.{}", panel.name, notch.name))),
    };
    let sets = match &options.marker {
        Some(marker) => marker.matched.len(),
        None => options.settings.matched.len(),
    };
    for set in 0..sets {
        for panel in &pattern.panels {
            for notch in &panel.notches {
                if is_in(set, panel, notch) {
                    marks.push((set, panel.id, notch.id));
                }
            }
        }
    }
    marks
}

/// A vector turned by an angle (rad).
pub(crate) fn turned(v: Vec2, angle: f64) -> Vec2 {
    let (sin, cos) = angle.sin_cos();
    Vec2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y)
}
