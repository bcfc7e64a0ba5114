//! Settings that the window remembers: recent files, theme, layout, paper, size.
//!
//! # Decided with
//! - [`crate::app::panes::Panes`]: what is on show;
//! - [`crate::app::command::UiCommand::on`]: check marks;
//! - [`crate::app::ToileApp::ask_print_choice`] (`print_choice.rs`): papers; a paper that the method
//!   `paper` here does not know is forgotten.

use super::Beginning;
use super::panes::Panes;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use toile_session::Paper;

/// Longest time between the clicks of a double click (s): as long as desktops allow, so that slow frames
/// do not separate them.
const DOUBLE_CLICK: f64 = 0.5;

/// Width and height of the window when it is opened for the first time (logical pixels).
const WINDOW: [f32; 2] = [1400.0, 860.0];
/// Least width and height of the window (logical pixels).
const MIN_WINDOW_SIZE: [f32; 2] = [760.0, 480.0];
/// Least and largest scale of text, icons and buttons.
const SCALES: [f32; 2] = [0.7, 2.5];
/// Largest number of recent files.
const MAX_RECENT: usize = 10;

/// Preferences, and the file they are stored in.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Preferences {
    /// Files opened or saved, the latest first.
    pub recent: Vec<PathBuf>,
    /// Whether colours are dark; `None` follows the system.
    pub dark: Option<bool>,
    /// Visible parts of the window.
    #[serde(rename = "shows")]
    pub panes: Panes,
    /// Name of the last paper for printing.
    pub paper: Option<String>,
    /// Width and height of the window when it was last not maximized (logical pixels).
    pub window: Option<[f32; 2]>,
    /// Whether the window was maximized.
    pub fills_screen: bool,
    /// Scale of text, icons and buttons.
    pub scale: Option<f32>,
    #[serde(skip)]
    file: Option<PathBuf>,
}

impl Preferences {
    /// Reads the preferences in a folder. Defaults replace a file that is missing or cannot be read.
    pub fn read(folder: Option<&Path>) -> Self {
        let file = folder.map(|folder| folder.join("preferences.json"));
        let text = file
            .as_ref()
            .and_then(|file| std::fs::read_to_string(file).ok());
        let read = text.and_then(|text| serde_json::from_str(&text).ok());
        Self {
            file,
            ..read.unwrap_or_default()
        }
    }

    /// Applies the theme, the scale and the settings of input.
    pub fn apply(&self, context: &egui::Context) {
        // Light colours, if the system states no preference.
        context.options_mut(|options| {
            options.fallback_theme = egui::Theme::Light;
            options.input_options.max_double_click_delay = DOUBLE_CLICK;
            // The commands of the window change the scale, and store it.
            options.zoom_with_keyboard = false;
        });
        context.set_zoom_factor(self.scale());
        context.set_theme(match self.dark {
            None => egui::ThemePreference::System,
            Some(true) => egui::ThemePreference::Dark,
            Some(false) => egui::ThemePreference::Light,
        });
    }

    /// The folder of the preferences and of everything else that the window stores.
    pub fn folder(&self) -> Option<&Path> {
        self.file.as_deref().and_then(Path::parent)
    }

    /// Remembers a file that was opened or saved.
    pub fn opened(&mut self, path: &Path) {
        // The built-in samples are no files.
        if path.exists() {
            let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
            self.recent.retain(|known| *known != path);
            self.recent.insert(0, path);
            self.recent.truncate(MAX_RECENT);
            self.write();
        }
    }

    /// Switches between dark and light.
    pub fn change_theme(&mut self, context: &egui::Context) {
        self.dark = Some(context.theme() == egui::Theme::Light);
        self.apply(context);
        self.write();
    }

    fn scale(&self) -> f32 {
        let scale = self.scale.filter(|scale| scale.is_finite());
        scale.unwrap_or(1.0).clamp(SCALES[0], SCALES[1])
    }

    /// Changes the scale of text, icons and buttons by a share of the usual size; `None` restores the
    /// usual size.
    pub fn change_scale(&mut self, context: &egui::Context, step: Option<f32>) {
        let scale = step.map_or(1.0, |step| self.scale() + step);
        self.scale = Some(((scale * 10.0).round() / 10.0).clamp(SCALES[0], SCALES[1]));
        self.apply(context);
        self.write();
    }

    /// Remembers the visible parts of the window.
    pub fn set_shows(&mut self, panes: Panes) {
        if self.panes != panes {
            self.panes = panes;
            self.write();
        }
    }

    /// Last paper for printing; A4 at first.
    pub fn paper(&self) -> Paper {
        let found = Paper::ALL
            .into_iter()
            .find(|paper| Some(paper.name()) == self.paper.as_deref());
        found.unwrap_or(Paper::A4)
    }

    /// Remembers the paper for printing.
    pub fn set_paper(&mut self, paper: Paper) {
        if self.paper() != paper {
            self.paper = Some(paper.name().to_owned());
            self.write();
        }
    }

    /// Remembers the size of the window, to write it when the window closes.
    pub fn note_window(&mut self, context: &egui::Context) {
        self.fills_screen = context.input(|input| input.viewport().maximized.unwrap_or_default());
        let size = context.content_rect().size();
        if !self.fills_screen && size.x > 0.0 && size.y > 0.0 {
            self.window = Some(size.into());
        }
    }

    /// Writes the size of the window.
    pub fn write_window(&self) {
        self.write();
    }

    /// Size at which the window opens (logical pixels).
    fn window(&self) -> [f32; 2] {
        let [width, height] = self.window.unwrap_or(WINDOW);
        [
            width.max(MIN_WINDOW_SIZE[0]),
            height.max(MIN_WINDOW_SIZE[1]),
        ]
    }

    fn write(&self) {
        let (Some(file), Ok(text)) = (&self.file, serde_json::to_vec_pretty(self)) else {
            return;
        };
        let folder = file.parent().unwrap_or(Path::new("."));
        // A failure to store preferences is not worth a message.
        let _ = std::fs::create_dir_all(folder);
        let _ = toile_session::write_atomically(file, &text);
    }
}

impl Beginning {
    /// The window to open, with the size at which it was last closed.
    pub fn viewport(&self) -> egui::ViewportBuilder {
        let preferences = Preferences::read(self.folder.as_deref());
        egui::ViewportBuilder::default()
            .with_title("Toile")
            .with_app_id("toile")
            .with_inner_size(preferences.window())
            .with_min_inner_size(MIN_WINDOW_SIZE)
            // The first window is maximized, because the size of the screen is not known yet.
            .with_maximized(preferences.fills_screen || preferences.window.is_none())
    }
}
