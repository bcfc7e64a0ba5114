//! What is done to seams that are selected.

use super::ToileApp;
use crate::canvas::selection::{Item, Selection};
use toile_pattern::SeamId;
use toile_pattern::plan::{self, SeamSide};
use toile_session::Command;

impl ToileApp {
    fn selected_seams(&self) -> Vec<SeamId> {
        let items = self.view.selection.items().iter();
        let seams = items.filter_map(|item| match item {
            Item::Seam(id) => Some(*id),
            _ => None,
        });
        seams.collect()
    }

    pub(crate) fn has_seam(&self) -> bool {
        !self.selected_seams().is_empty()
    }

    /// Sews the other ends of the second sides together.
    pub(crate) fn flip_seam(&mut self) {
        let mut edits = Vec::new();
        for seam in self.selected_seams() {
            match plan::flip_side(&self.base, seam, SeamSide::Second) {
                Ok(found) => edits.extend(found),
                Err(error) => return self.say_fault(error.to_string()),
            }
        }
        let label = "Flip seam".to_owned();
        self.execute(Command::Edit { edits, label });
    }

    /// Selects the seams of the selected edge.
    pub(crate) fn select_seam(&mut self) {
        let Some(Item::Edge(panel, edge)) = self.view.selection.single() else {
            return;
        };
        let at_edge = |stretch: &crate::canvas::seams::SeamStretch| {
            stretch.panel == panel && stretch.edge == Some(edge)
        };
        let seams = self.view.scene.seams.iter();
        let found: Selection = seams
            .filter(|seam| seam.stretches.iter().any(at_edge))
            .map(|seam| Item::Seam(seam.id))
            .collect();
        match found.is_empty() {
            true => self.say_fault("the edge is not sewn: take the seam tool (S)".into()),
            false => self.view.select(found),
        }
    }
}
