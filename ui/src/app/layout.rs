//! The parts of the window and their sizes.

use super::ToileApp;
use crate::theme;
use egui::{Panel, Ui};

/// Initial share of the window's width for the 3D view: alone, and with the tables under it.
const GARMENT_SHARES: [f32; 2] = [0.245, 0.33];
/// Least height of the marker (pixels).
const MIN_MARKER_HEIGHT: f32 = 140.0;
/// Least height of the pattern above the marker, if there is room for both (pixels).
const MIN_PATTERN_HEIGHT: f32 = 170.0;
/// Least width of the window at which the tables stand beside the pattern if the user has not moved them
/// (pixels).
const WIDE: f32 = 1600.0;
/// Initial height of the tables below the pattern (pixels).
const TABLES: f32 = 210.0;
/// Initial share of the height for the tables, if they stand under the garment (1).
const TABLES_SHARE: f32 = 0.45;
/// Width of the row of buttons above the 3D view (pixels). The view is at first at least as wide, if the
/// window has room for it.
const GARMENT_ROW: f32 = 320.0;
/// Largest share of the window's width for the 3D view.
const GARMENT_MOST: f32 = 0.6;

impl ToileApp {
    /// Shows the bars and views, from the edge of the window inward.
    pub(super) fn parts(&mut self, ui: &mut Ui) {
        self.offer_length();
        let frame = theme::bar(ui.ctx());
        Panel::top("menus")
            .frame(frame)
            .resizable(false)
            .show(ui, |ui| self.menu_bar(ui));
        Panel::bottom("status")
            .frame(frame)
            .resizable(false)
            .show(ui, |ui| self.status(ui));
        if self.panes.findings {
            Panel::bottom("findings")
                .frame(frame)
                .default_size(130.0)
                .resizable(true)
                .show(ui, |ui| self.list_findings(ui));
        }
        if !self.is_open() {
            egui::CentralPanel::default()
                .frame(egui::Frame::new().fill(theme::Palette::of(ui.ctx()).table))
                .show(ui, |ui| self.welcome(ui));
            return;
        }
        if self.is_foreign() {
            Panel::top("foreign file")
                .frame(frame)
                .resizable(false)
                .show(ui, |ui| self.foreign_bar(ui));
        }
        if self.panes.marker {
            let height = ui.available_height();
            let below = self.panes.tables && !self.tables_stand_beside(ui.ctx());
            let tables = if below { TABLES } else { 0.0 };
            // Part of the pattern stays visible above the marker.
            let most = (height - tables - MIN_PATTERN_HEIGHT).max(MIN_MARKER_HEIGHT);
            Panel::bottom("marker")
                .frame(frame)
                .resizable(true)
                .default_size((height * 0.55).min(most))
                .size_range(MIN_MARKER_HEIGHT..=most)
                .show(ui, |ui| self.marker_side(ui));
        }
        Panel::left("tools")
            .frame(frame)
            .resizable(false)
            .exact_size(self.tool_bar_width())
            .show(ui, |ui| self.tool_bar(ui));
        self.tables_are_beside = self.tables_stand_beside(ui.ctx());
        let beside = self.panes.tables && self.tables_are_beside;
        if self.panes.tables && !beside {
            Panel::bottom("tables")
                .frame(frame)
                .default_size(TABLES)
                .min_size(self.tables.least_height())
                .resizable(true)
                .show(ui, |ui| self.show_tables(ui));
        }
        if self.panes.garment || beside {
            let width = ui.available_width();
            let share = width * GARMENT_SHARES[usize::from(beside)];
            let row = GARMENT_ROW.min(width * GARMENT_SHARES[1]);
            Panel::right("side")
                .frame(egui::Frame::new())
                .resizable(true)
                .default_size(share.max(row))
                .size_range(240.0..=(width * GARMENT_MOST).max(240.0))
                .show(ui, |ui| self.side(ui, beside));
        }
        egui::CentralPanel::default()
            .frame(egui::Frame::new())
            .show(ui, |ui| self.pattern_side(ui));
    }

    /// Whether the tables stand beside the pattern: as the user chose; if the user did not choose, whether
    /// the window is wide enough.
    pub(crate) fn tables_stand_beside(&self, context: &egui::Context) -> bool {
        let is_wide = context.content_rect().width() >= WIDE;
        self.panes.tables_beside.unwrap_or(is_wide)
    }

    /// Shows the pane beside the pattern: the garment, and the tables under it if they stand beside the
    /// pattern.
    fn side(&mut self, ui: &mut Ui, tables: bool) {
        let frame = theme::bar(ui.ctx());
        if !self.panes.garment {
            frame.show(ui, |ui| self.show_tables(ui));
            return;
        }
        if tables {
            let height = ui.available_height();
            let least = self.tables.least_height();
            Panel::bottom("tables beside")
                .frame(frame)
                .default_size(height * TABLES_SHARE)
                .size_range(least..=(height * 0.8).max(least))
                .resizable(true)
                .show(ui, |ui| self.show_tables(ui));
        }
        self.garment_side(ui);
    }
}
