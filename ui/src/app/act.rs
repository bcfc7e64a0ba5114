//! From what is asked at the window to commands of the session.

use crate::app::ToileApp;
use crate::command::UiCommand;
use crate::notice::Notice;
use crate::selection::Selection;
use crate::space::PanelPoint;
use crate::table_view::ZOOM_STEP;
use egui::{Key, Modifiers};
use std::f64::consts::{FRAC_PI_2, PI};
use std::path::PathBuf;
use toile_geometry::Vec2;
use toile_pattern::{EdgeId, Edit, EditError, PanelId, PointId, plan};
use toile_session::Command;

/// How far an arrow key moves a point, alone and with Shift [m].
const NUDGES: [f64; 2] = [0.001, 0.01];
/// How the names of files in the native format end.
const ENDING: &str = ".toile.json";

impl ToileApp {
    /// Whether a command can be done now.
    pub(crate) fn can(&self, command: UiCommand) -> bool {
        let opened = !self.session.project().pattern.panels.is_empty();
        match command {
            UiCommand::Save => opened && self.is_unsaved(),
            UiCommand::Undo => self.session.can_undo().is_some(),
            UiCommand::Redo => self.session.can_redo().is_some(),
            UiCommand::AddPoint => matches!(self.table.selection, Selection::Edge(..)),
            UiCommand::DeletePoint => matches!(self.table.selection, Selection::Point(..)),
            UiCommand::Deselect => self.table.selection != Selection::Nothing,
            UiCommand::FitPattern | UiCommand::ZoomIn | UiCommand::ZoomOut | UiCommand::Drape => {
                opened
            }
            UiCommand::Pause | UiCommand::Stop => self.making.is_draping(),
            UiCommand::FrontView | UiCommand::BackView | UiCommand::SideView => true,
        }
    }

    /// Does a command.
    pub(crate) fn run(&mut self, command: UiCommand) {
        match command {
            UiCommand::Save => self.save(),
            UiCommand::Undo => {
                self.execute(Command::Undo);
            }
            UiCommand::Redo => {
                self.execute(Command::Redo);
            }
            UiCommand::AddPoint => {
                if let Selection::Edge(panel, edge) = self.table.selection {
                    self.split((panel, edge), None);
                }
            }
            UiCommand::DeletePoint => {
                if let Selection::Point(panel, point) = self.table.selection {
                    self.delete((panel, point));
                }
            }
            UiCommand::Deselect => self.table.selection = Selection::Nothing,
            UiCommand::FitPattern => self.table.fit(),
            UiCommand::ZoomIn => self.table.zoom(ZOOM_STEP),
            UiCommand::ZoomOut => self.table.zoom(1.0 / ZOOM_STEP),
            UiCommand::Drape => {
                self.notice = Notice::default();
                self.making.start_garment(&self.session);
            }
            UiCommand::Pause => self.making.toggle_pause(),
            UiCommand::Stop => self.making.stop(),
            UiCommand::FrontView => self.stage.look_from(0.0),
            UiCommand::BackView => self.stage.look_from(PI),
            UiCommand::SideView => self.stage.look_from(FRAC_PI_2),
        }
    }

    /// Moves a point to a place of its panel.
    pub(crate) fn move_point(&mut self, point: (PanelId, PointId), to: PanelPoint) {
        self.show_moved(point, to);
        self.commit("Move point");
    }

    /// Shows a point at a place of its panel until the gesture is committed.
    pub(crate) fn show_moved(&mut self, (_, point): (PanelId, PointId), to: PanelPoint) {
        let evaluation = self.session.evaluation();
        let shown = plan::move_point(&evaluation, point, to.0)
            .map_err(|error| error.to_string())
            .and_then(|edits| {
                let shown = self.session.preview(&edits);
                shown.map_err(|error| error.to_string())
            });
        match shown {
            Ok(()) => self.refresh(),
            Err(words) => self.notice = Notice::fault(words),
        }
    }

    /// Takes over what is shown, as one step of the history.
    pub(crate) fn commit(&mut self, label: &str) {
        match self.session.commit(label) {
            Ok(events) => self.hear(&events),
            Err(error) => self.notice = Notice::fault(error.to_string()),
        }
    }

    /// Divides an edge at the place nearest to a point, or in its middle, and selects the corner.
    pub(crate) fn split(&mut self, (panel, edge): (PanelId, EdgeId), near: Option<PanelPoint>) {
        let evaluation = self.session.evaluation();
        let planned = plan::divide_edge(&evaluation, (panel, edge), near.map(|near| near.0));
        let corner = planned.as_ref().ok().map(|(_, corner)| *corner);
        if self.edit(planned.map(|(edits, _)| edits), "Add point")
            && let Some(corner) = corner
        {
            self.table.selection = Selection::Point(panel, corner);
        }
    }

    fn delete(&mut self, (panel, point): (PanelId, PointId)) {
        let evaluation = self.session.evaluation();
        let edits = plan::remove_point(&evaluation, (panel, point));
        self.edit(edits, "Delete point");
    }

    fn edit(&mut self, edits: Result<Vec<Edit>, EditError>, label: &str) -> bool {
        match edits {
            Ok(edits) => self.execute(Command::Edit {
                edits,
                label: label.to_owned(),
            }),
            Err(error) => {
                self.notice = Notice::fault(error.to_string());
                false
            }
        }
    }

    /// Moves the selected point by the arrow keys.
    pub(crate) fn nudge(&mut self, context: &egui::Context) {
        let Selection::Point(panel, point) = self.table.selection else {
            return;
        };
        if context.egui_wants_keyboard_input() {
            return;
        }
        let way = context.input_mut(|input| {
            let mut way = Vec2::zeros();
            for (key, x, y) in [
                (Key::ArrowLeft, -1.0, 0.0),
                (Key::ArrowRight, 1.0, 0.0),
                (Key::ArrowUp, 0.0, 1.0),
                (Key::ArrowDown, 0.0, -1.0),
            ] {
                for (modifiers, step) in
                    [(Modifiers::SHIFT, NUDGES[1]), (Modifiers::NONE, NUDGES[0])]
                {
                    if input.consume_key(modifiers, key) {
                        way += Vec2::new(x, y) * step;
                    }
                }
            }
            way
        });
        let at = self.drawing.panel(panel).and_then(|p| p.point(point));
        if let Some(at) = at.map(|point| point.at.0)
            && way != Vec2::zeros()
        {
            self.move_point((panel, point), PanelPoint(at + way));
        }
    }

    pub(crate) fn save(&mut self) {
        let path = self.save_path();
        let own = self.session.project().source.as_ref() == Some(&path);
        if !own && path.exists() {
            self.notice = Notice::fault(format!(
                "{} is there already: move it away, or open that file",
                path.display()
            ));
            return;
        }
        self.execute(Command::SavePattern { path });
    }

    /// The file it came from, if that is in the native format; else one beside it.
    fn save_path(&self) -> PathBuf {
        let project = self.session.project();
        match &project.source {
            Some(path) if path.to_string_lossy().ends_with(ENDING) => path.clone(),
            Some(path) if path.exists() => {
                let stem = path.file_stem().unwrap_or_default().to_string_lossy();
                path.with_file_name(format!("{stem}{ENDING}"))
            }
            _ => PathBuf::from(format!("{}{ENDING}", project.pattern.name)),
        }
    }
}
