//! Every command of the window: label, tooltip and shortcut in one place.

use egui::{Key, KeyboardShortcut, Modifiers};

/// Something the person at the window can ask for by button or key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UiCommand {
    /// Write the pattern to its file.
    Save,
    /// Take the last change back.
    Undo,
    /// Do it again.
    Redo,
    /// Divide the selected edge in its middle.
    AddPoint,
    /// Remove the selected point.
    DeletePoint,
    /// Select nothing.
    Deselect,
    /// Show the whole pattern.
    FitPattern,
    /// Enlarge the pattern.
    ZoomIn,
    /// Make the pattern smaller.
    ZoomOut,
    /// Sew and drape the garment.
    Drape,
    /// Hold the drape, or let it go on.
    Pause,
    /// End the drape.
    Stop,
    /// Look at the wearer's front.
    FrontView,
    /// Look at the wearer's back.
    BackView,
    /// Look at the wearer's left side.
    SideView,
}

impl UiCommand {
    /// All of them, in the order shortcuts are looked at: those with more modifiers first.
    pub const ALL: [Self; 15] = [
        Self::Redo,
        Self::Undo,
        Self::Save,
        Self::AddPoint,
        Self::DeletePoint,
        Self::Deselect,
        Self::FitPattern,
        Self::ZoomIn,
        Self::ZoomOut,
        Self::Stop,
        Self::Drape,
        Self::Pause,
        Self::FrontView,
        Self::BackView,
        Self::SideView,
    ];

    /// Text of its button, and its accessible name.
    pub fn label(self) -> &'static str {
        self.words().0
    }

    /// One sentence on what it does.
    pub fn tooltip(self) -> &'static str {
        self.words().1
    }

    fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Save => ("Save", "Write the pattern to its file"),
            Self::Undo => ("Undo", "Take the last change back"),
            Self::Redo => ("Redo", "Do the change again that was taken back"),
            Self::AddPoint => (
                "Add point",
                "Divide the selected edge in its middle; double-click an edge to divide it there",
            ),
            Self::DeletePoint => (
                "Delete point",
                "Remove the selected point; its two edges become one",
            ),
            Self::Deselect => ("Deselect", "Select nothing"),
            Self::FitPattern => ("Fit", "Show the whole pattern"),
            Self::ZoomIn => ("Zoom in", "Enlarge the pattern"),
            Self::ZoomOut => ("Zoom out", "Make the pattern smaller"),
            Self::Drape => (
                "Drape",
                "Sew the garment round the mannequin and let it hang",
            ),
            Self::Pause => ("Pause", "Hold the drape, or let it go on"),
            Self::Stop => ("Stop", "End the drape and keep what there is"),
            Self::FrontView => ("Front", "Look at the front of the garment"),
            Self::BackView => ("Back", "Look at the back of the garment"),
            Self::SideView => ("Side", "Look at the wearer's left side"),
        }
    }

    /// Its key.
    pub fn shortcut(self) -> KeyboardShortcut {
        let (modifiers, key) = match self {
            Self::Save => (Modifiers::COMMAND, Key::S),
            Self::Undo => (Modifiers::COMMAND, Key::Z),
            Self::Redo => (Modifiers::COMMAND | Modifiers::SHIFT, Key::Z),
            Self::AddPoint => (Modifiers::NONE, Key::A),
            Self::DeletePoint => (Modifiers::NONE, Key::Delete),
            Self::Deselect => (Modifiers::NONE, Key::Escape),
            Self::FitPattern => (Modifiers::NONE, Key::F),
            Self::ZoomIn => (Modifiers::NONE, Key::Plus),
            Self::ZoomOut => (Modifiers::NONE, Key::Minus),
            Self::Drape => (Modifiers::NONE, Key::D),
            Self::Pause => (Modifiers::NONE, Key::P),
            Self::Stop => (Modifiers::SHIFT, Key::D),
            Self::FrontView => (Modifiers::NONE, Key::Num1),
            Self::BackView => (Modifiers::NONE, Key::Num2),
            Self::SideView => (Modifiers::NONE, Key::Num3),
        };
        KeyboardShortcut::new(modifiers, key)
    }

    /// A button for it: true when it was pressed. A command that cannot be done now is greyed.
    pub fn button(self, ui: &mut egui::Ui, enabled: bool) -> bool {
        self.show(ui, enabled, egui::Button::new(self.label()), self.tooltip())
    }

    /// The same with a button and a tooltip of one's own.
    pub fn show(
        self,
        ui: &mut egui::Ui,
        enabled: bool,
        button: egui::Button<'_>,
        tooltip: &str,
    ) -> bool {
        let tip = format!("{tooltip} ({})", ui.ctx().format_shortcut(&self.shortcut()));
        ui.add_enabled(enabled, button)
            .on_hover_text(&tip)
            .on_disabled_hover_text(&tip)
            .clicked()
    }

    /// Commands whose keys were pressed in this frame. While text is typed only those with a
    /// command key count.
    pub fn pressed(context: &egui::Context) -> Vec<Self> {
        let typing = context.egui_wants_keyboard_input();
        let mut pressed = Vec::new();
        context.input_mut(|input| {
            for command in Self::ALL {
                let shortcut = command.shortcut();
                if typing && !shortcut.modifiers.command {
                    continue;
                }
                if input.consume_shortcut(&shortcut) {
                    pressed.push(command);
                }
            }
        });
        pressed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_and_shortcuts_are_all_different() {
        for (k, one) in UiCommand::ALL.into_iter().enumerate() {
            for other in &UiCommand::ALL[k + 1..] {
                assert_ne!(one.label(), other.label());
                assert_ne!(one.shortcut(), other.shortcut(), "{one:?} and {other:?}");
            }
            assert!(!one.tooltip().is_empty());
        }
    }
}
