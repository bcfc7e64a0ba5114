//! Outlines of all sizes drawn on top of each other, as drafted.

use crate::theme;
use egui::Color32;
use toile_geometry::Vec2;
use toile_pattern::{Evaluation, PanelId, SizeId};

/// Outlines of every size.
#[derive(Clone, Debug, Default)]
pub struct Grading {
    /// The sizes, in the order of their table.
    pub sizes: Vec<GradedSize>,
}

/// Outlines in one size.
#[derive(Clone, Debug)]
pub struct GradedSize {
    /// Identity of the size.
    pub id: SizeId,
    /// Name of the size.
    pub name: String,
    /// Closed outlines and holes of each panel, in its plane (m).
    pub panels: Vec<(PanelId, Vec<Vec<Vec2>>)>,
}

impl Grading {
    /// Outlines of a pattern in each of its sizes. `evaluation` is the pattern in any size, `in_size`
    /// evaluates it in the size of a name; curves are flattened to within a tolerance (m).
    pub fn new(
        evaluation: &Evaluation,
        tolerance: f64,
        mut in_size: impl FnMut(&str) -> Evaluation,
    ) -> Self {
        let pattern = evaluation.pattern();
        let sizes = pattern.sizes.iter().map(|size| {
            let graded = in_size(&size.name);
            let panels = pattern.panels.iter().filter_map(|panel| {
                let stage = graded.last_stage(panel)?;
                let rings = std::iter::once(stage.outline()).chain(stage.holes());
                let rings = rings.map(|ring| {
                    let mut points: Vec<Vec2> = Vec::new();
                    for edge in ring {
                        points.extend(edge.curve.flatten(tolerance));
                    }
                    points
                });
                Some((panel.id, rings.collect()))
            });
            GradedSize {
                id: size.id,
                name: size.name.clone(),
                panels: panels.collect(),
            }
        });
        Self {
            sizes: sizes.collect(),
        }
    }

    /// Colour of a size by its index in the table: neighbours differ.
    pub fn colour(number: usize) -> Color32 {
        theme::seam(number + 1)
    }
}
