//! The marks of a pattern that lie on a print, by their names.

use toile_geometry::Vec2;
use toile_pattern::{NotchId, PanelId, Pattern};

/// The marks of a pattern: number of the set, panel and notch. Names that are not there are left out.
pub(crate) fn resolve_marks(
    pattern: &Pattern,
    sets: &[Vec<String>],
) -> Vec<(usize, PanelId, NotchId)> {
    let mut marks = Vec::new();
    for (set, names) in sets.iter().enumerate() {
        for panel in &pattern.panels {
            for notch in &panel.notches {
                if names.contains(&format!("{}.{}", panel.name, notch.name)) {
                    marks.push((set, panel.id, notch.id));
                }
            }
        }
    }
    marks
}

/// A vector turned by an angle [rad].
pub(crate) fn turned(v: Vec2, angle: f64) -> Vec2 {
    let (sin, cos) = angle.sin_cos();
    Vec2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y)
}
