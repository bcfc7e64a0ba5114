//! Outlines of all sizes drawn on top of each other, as drafted, and the ways of corners from size to size.

use crate::theme;
use egui::Color32;
use std::collections::BTreeMap;
use toile_geometry::Vec2;
use toile_pattern::{Evaluation, PanelId, PointId, SizeId, plan};

/// Corners that move less from size to size lie still (m).
const STILL: f64 = 1e-6;

/// Outlines of every size.
#[derive(Clone, Debug, Default)]
pub struct Grading {
    /// The sizes, in the order of their table.
    pub sizes: Vec<GradedSize>,
    /// Ways of the corners that move.
    pub ways: Vec<CornerWay>,
}

/// The way of a corner from size to size.
#[derive(Clone, Debug)]
pub struct CornerWay {
    /// The panel.
    pub panel: PanelId,
    /// Places of the corner in its plane, in the order of sizes (m).
    pub places: Vec<Vec2>,
    /// For each place, whether the step to it is another than the step before.
    pub is_jump: Vec<bool>,
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
        let mut corners: BTreeMap<(PanelId, PointId), Vec<Vec2>> = BTreeMap::new();
        for panel in &pattern.panels {
            for id in panel.edges().flat_map(|edge| edge.ends) {
                corners.insert((panel.id, id), Vec::new());
            }
        }
        let sizes = pattern.sizes.iter().map(|size| {
            let graded = in_size(&size.name);
            for ((_, id), places) in &mut corners {
                places.extend(graded.point(*id));
            }
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
        let sizes: Vec<GradedSize> = sizes.collect();
        let moving = corners.into_iter().filter(|(_, places)| {
            let is_whole = places.len() == sizes.len();
            is_whole && places.iter().any(|p| (p - places[0]).norm() > STILL)
        });
        let ways = moving.map(|((panel, _), places)| CornerWay {
            panel,
            is_jump: plan::jumps(&places),
            places,
        });
        Self {
            ways: ways.collect(),
            sizes,
        }
    }

    /// Colour of a size by its index in the table: neighbours differ.
    pub fn colour(number: usize) -> Color32 {
        theme::seam(number + 1)
    }
}
