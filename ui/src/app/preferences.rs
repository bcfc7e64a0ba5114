//! Settings that the window remembers: recent files, theme, layout, paper, size.

use super::Beginning;
use super::panes::Panes;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use toile_session::Paper;

/// Two clicks no farther apart are one double click (s): as long as desktops allow, so that slow frames do not
/// part them.
const DOUBLE_CLICK: f64 = 0.5;

/// Size of a window that was never opened before, and the least one has (logical pixels).
const WINDOW: [f32; 2] = [1400.0, 860.0];
const MIN_WINDOW_SIZE: [f32; 2] = [760.0, 480.0];
/// Least and largest enlargement of text, signs and buttons.
const SCALES: [f32; 2] = [0.7, 2.5];
/// Most recent files kept.
const MAX_RECENT: usize = 10;

/// Preferences, and the file they are in.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Preferences {
    /// Files opened or saved, the latest first.
    pub recent: Vec<PathBuf>,
    /// Whether colours are dark; nothing follows the system.
    pub dark: Option<bool>,
    /// What of the window is on show.
    #[serde(rename = "shows")]
    pub panes: Panes,
    /// Name of the paper that was printed on last.
    pub paper: Option<String>,
    /// Width and height of the window while it was last not as large as the screen (logical pixels).
    pub window: Option<[f32; 2]>,
    /// Whether it was as large as the screen.
    pub fills_screen: bool,
    /// Enlargement of text, signs and buttons.
    pub scale: Option<f32>,
    #[serde(skip)]
    file: Option<PathBuf>,
}

impl Preferences {
    /// The preferences in a folder. What cannot be read is begun anew.
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

    /// Sets the theme.
    pub fn apply(&self, context: &egui::Context) {
        // Where the system says nothing, colours are light.
        context.options_mut(|options| {
            options.fallback_theme = egui::Theme::Light;
            options.input_options.max_double_click_delay = DOUBLE_CLICK;
            // The commands of the window change the enlargement, and note it.
            options.zoom_with_keyboard = false;
        });
        context.set_zoom_factor(self.scale());
        context.set_theme(match self.dark {
            None => egui::ThemePreference::System,
            Some(true) => egui::ThemePreference::Dark,
            Some(false) => egui::ThemePreference::Light,
        });
    }

    /// The folder they are kept in, with whatever else the window remembers.
    pub fn folder(&self) -> Option<&Path> {
        self.file.as_deref().and_then(Path::parent)
    }

    /// Notes a file that was opened or saved.
    pub fn opened(&mut self, path: &Path) {
        // The samples in the program are no files.
        if path.exists() {
            let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
            self.recent.retain(|known| *known != path);
            self.recent.insert(0, path);
            self.recent.truncate(MAX_RECENT);
            self.write();
        }
    }

    /// Changes between dark and light.
    pub fn change_theme(&mut self, context: &egui::Context) {
        self.dark = Some(context.theme() == egui::Theme::Light);
        self.apply(context);
        self.write();
    }

    fn scale(&self) -> f32 {
        let scale = self.scale.filter(|scale| scale.is_finite());
        scale.unwrap_or(1.0).clamp(SCALES[0], SCALES[1])
    }

    /// Makes text, signs and buttons larger or smaller by a share of their usual size; nothing means as large as
    /// usual.
    pub fn change_scale(&mut self, context: &egui::Context, step: Option<f32>) {
        let scale = step.map_or(1.0, |step| self.scale() + step);
        self.scale = Some(((scale * 10.0).round() / 10.0).clamp(SCALES[0], SCALES[1]));
        self.apply(context);
        self.write();
    }

    /// Notes what of the window is on show.
    pub fn set_shows(&mut self, panes: Panes) {
        if self.panes != panes {
            self.panes = panes;
            self.write();
        }
    }

    /// The paper that was printed on last, A4 at first.
    pub fn paper(&self) -> Paper {
        let known = [
            Paper::A4,
            Paper::Letter,
            Paper::A0,
            Paper::Page,
            Paper::Projector,
        ];
        let found = known
            .into_iter()
            .find(|paper| Some(paper.name()) == self.paper.as_deref());
        found.unwrap_or(Paper::A4)
    }

    /// Notes the paper that is printed on.
    pub fn set_paper(&mut self, paper: Paper) {
        if self.paper() != paper {
            self.paper = Some(paper.name().to_owned());
            self.write();
        }
    }

    /// Notes the size of the window, which is written when it closes.
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

    /// How large the window opens (logical pixels).
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
        // Preferences that cannot be kept are no reason to disturb anybody.
        let _ = std::fs::create_dir_all(folder);
        let _ = toile_session::write_atomically(file, &text);
    }
}

impl Beginning {
    /// The window to open: as large as it was when it was closed last.
    pub fn viewport(&self) -> egui::ViewportBuilder {
        let preferences = Preferences::read(self.folder.as_deref());
        egui::ViewportBuilder::default()
            .with_title("Toile")
            .with_app_id("toile")
            .with_inner_size(preferences.window())
            .with_min_inner_size(MIN_WINDOW_SIZE)
            // The first time it takes the screen, whose size nobody knows yet.
            .with_maximized(preferences.fills_screen || preferences.window.is_none())
    }
}
