//! Moves the table while a seam is walked, and back at the end of the walk.

use super::PatternView;
use crate::tools::{Overlay, State, walk};
use egui::{Rect, Ui};
use toile_geometry::Vec2;
use toile_pattern::Evaluation;

impl PatternView {
    /// At the start of a walk, moves the table so that both pieces will be visible at every position of the
    /// walk; later the pointer does not move the table, only a key can.
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
        // Zooms out only if necessary.
        self.camera.scale = self.camera.scale.min(scale);
        self.fitted = None;
        ui.ctx().request_repaint();
    }

    /// Centres the view on the point of contact of the pieces, if a key moved that point out of view.
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
