//! Lays the panels on the table side by side, so that none covers another.

use crate::drawing::Drawing;
use crate::space::PanelPlace;
use std::collections::BTreeMap;
use toile_geometry::{Bounds2, Vec2};
use toile_pattern::PanelId;

/// Room between panels [m]: enough for seam numbers and names beside narrow panels.
const GAP: f64 = 0.06;
/// Width of the whole over its height that rows are broken for: about that of the view.
const ASPECT: f64 = 1.15;

/// Where each panel lies. View state: it stays while panels are edited, so that nothing jumps.
#[derive(Clone, Debug, Default)]
pub struct Layout {
    places: BTreeMap<PanelId, PanelPlace>,
}

impl Layout {
    /// Lays every panel anew: in rows, in the pattern's order.
    pub fn arrange(drawing: &Drawing) -> Self {
        let sizes: Vec<Vec2> = drawing
            .panels
            .iter()
            .map(|panel| panel.bounds.max - panel.bounds.min + Vec2::new(GAP, GAP))
            .collect();
        let width = best_width(&sizes);
        let mut places = BTreeMap::new();
        let mut pen = Vec2::zeros();
        let mut row = 0.0_f64;
        for (panel, size) in drawing.panels.iter().zip(&sizes) {
            if pen.x > 0.0 && pen.x + size.x > width {
                pen = Vec2::new(0.0, pen.y - row);
                row = 0.0;
            }
            let top_left = Vec2::new(panel.bounds.min.x, panel.bounds.max.y);
            let offset = pen - top_left;
            places.insert(panel.id, PanelPlace { offset });
            pen.x += size.x;
            row = row.max(size.y);
        }
        Self { places }
    }

    /// Gives panels that are new a place right of the others.
    pub fn add_missing(&mut self, drawing: &Drawing) {
        for panel in &drawing.panels {
            if self.places.contains_key(&panel.id) {
                continue;
            }
            let bounds = self.bounds(drawing);
            let corner = match bounds {
                Some(bounds) => Vec2::new(bounds.max.x + GAP, bounds.max.y),
                None => Vec2::zeros(),
            };
            let offset = corner - Vec2::new(panel.bounds.min.x, panel.bounds.max.y);
            self.places.insert(panel.id, PanelPlace { offset });
        }
    }

    /// Where a panel lies.
    pub fn place(&self, panel: PanelId) -> Option<PanelPlace> {
        self.places.get(&panel).copied()
    }

    /// Least rectangle round all panels on the table [m].
    pub fn bounds(&self, drawing: &Drawing) -> Option<Bounds2> {
        drawing
            .panels
            .iter()
            .filter_map(|panel| {
                let offset = self.place(panel.id)?.offset;
                Some(Bounds2 {
                    min: panel.bounds.min + offset,
                    max: panel.bounds.max + offset,
                })
            })
            .reduce(|a, b| a.union(&b))
    }
}

/// The row width whose rows come nearest to the wanted aspect: every sum of neighbours is tried.
fn best_width(sizes: &[Vec2]) -> f64 {
    let widest = sizes.iter().map(|s| s.x).fold(0.0, f64::max);
    let total: f64 = sizes.iter().map(|s| s.x).sum();
    let steps = 24;
    (0..=steps)
        .map(|k| widest + (total - widest) * f64::from(k) / f64::from(steps))
        .min_by(|a, b| misfit(sizes, *a).total_cmp(&misfit(sizes, *b)))
        .unwrap_or(widest)
}

/// How small the whole is seen in a view of the wanted aspect [m].
fn misfit(sizes: &[Vec2], width: f64) -> f64 {
    let (mut x, mut row, mut used, mut height) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0);
    for size in sizes {
        if x > 0.0 && x + size.x > width + 1e-12 {
            height += row;
            (x, row) = (0.0, 0.0);
        }
        x += size.x;
        used = used.max(x);
        row = row.max(size.y);
    }
    (used / ASPECT).max(height + row)
}
