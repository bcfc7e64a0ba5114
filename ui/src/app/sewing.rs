//! Commands on selected seams.

use super::ToileApp;
use super::tool_commands::WALK_SEAM;
use crate::canvas::selection::{Item, Selection};
use crate::theme::Palette;
use crate::tools::walk::crossing_lines;
use crate::tools::{Tone, Tool};
use egui::{RichText, Ui};
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

    pub(crate) fn has_seams(&self) -> bool {
        !self.session.project().pattern.seams.is_empty()
    }

    /// Walks the selected seam, or the seam of the selected edge, or else lets the user click one.
    pub(crate) fn walk_seam(&mut self) {
        if !self.has_seam() && self.has_edge() {
            self.select_seam();
            if !self.has_seam() {
                return;
            }
        }
        self.take(Tool::Walk);
    }

    /// Reverses the second side of each selected seam: then the opposite ends are sewn together.
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

    /// Shows, for each end of a seam, how smoothly the line that crosses the seam there runs on, as a hem
    /// does.
    pub(crate) fn seam_joints(&mut self, ui: &mut Ui, seam: SeamId) {
        let palette = Palette::of(ui.ctx());
        for (words, tone) in crossing_lines((&self.base, &self.view.scene), seam) {
            let colour = match tone {
                Tone::Plain | Tone::Good => palette.ink_soft,
                Tone::Warning => palette.warning,
                Tone::Fault => palette.fault,
            };
            ui.label(RichText::new(words).color(colour));
        }
        self.command_button(ui, &WALK_SEAM);
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
