//! How the table is moved while a seam is walked, and back when the walk is over.

use super::PatternView;
use crate::tools::{Overlay, State, walk};
use egui::{Rect, Ui};
use toile_geometry::Vec2;
use toile_pattern::Evaluation;

impl PatternView {
    /// When a walk begins, the table is moved away so far that both pieces are seen wherever it leads.
    /// While it goes on the table stays.
    pub(super) fn make_room(&mut self, ui: &Ui, view: Rect, evaluation: &Evaluation) {
        let State::Walk(state) = &self.state else {
            self.walked = None;
            if let Some(camera) = self.before_walk.take() {
                self.camera = camera;
                ui.ctx().request_repaint();
            }
            return;
        };
        let reading = self.reading(evaluation);
        let seam = walk::selected(&reading);
        if seam == self.walked || view.width() <= 50.0 {
            return;
        }
        let room = walk::room(state, &reading);
        self.walked = seam;
        let Some(room) = room else {
            return;
        };
        let mut corners = [room.min, room.max].into_iter();
        if corners.all(|at| view.contains(self.screen(view, Vec2::zeros(), at))) {
            return;
        }
        let scale = self.camera.scale;
        self.before_walk.get_or_insert(self.camera);
        self.camera.fit(view, &room);
        // What is seen small enough is moved alone.
        self.camera.scale = self.camera.scale.min(scale);
        self.fitted = None;
        ui.ctx().request_repaint();
    }

    /// Where the pieces of a seam touch comes into the middle of the view if a key led out of it.
    pub(super) fn follow_walk(&mut self, view: Rect, evaluation: &Evaluation) {
        let marks = self.overlay(evaluation);
        let touch = marks.iter().find_map(|mark| match mark {
            Overlay::Touch(at) => Some(*at),
            _ => None,
        });
        if let Some(at) = touch
            && !view.contains(self.screen(view, Vec2::zeros(), at))
        {
            self.before_walk.get_or_insert(self.camera);
            self.camera.centre = at;
            self.fitted = None;
        }
    }
}
