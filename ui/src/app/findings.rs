//! The list of findings on the pattern, with their places.

use super::ToileApp;
use super::notice::Notice;
use crate::canvas::finding_marks::FindingMark;
use crate::canvas::selection::{Item, Selection};
use crate::theme::Palette;
use egui::{Button, Color32, RichText, Ui};
use toile_pattern::{Diagnostic, Place, Severity};

impl ToileApp {
    pub(crate) fn findings_button(&mut self, ui: &mut Ui) {
        let palette = Palette::of(ui.ctx());
        if !self.is_open() {
            return;
        }
        let count = |severity| {
            self.findings
                .iter()
                .filter(|f| f.severity == severity)
                .count()
        };
        let (faults, warnings) = (count(Severity::Error), count(Severity::Warning));
        let notes = count(Severity::Note);
        let several = |count: usize, word: &str| match count {
            1 => format!("1 {word}"),
            _ => format!("{count} {word}s"),
        };
        let (words, colour) = match (faults, warnings) {
            (0, 0) if notes == 0 => ("No faults".to_owned(), palette.accent),
            (0, 0) => (
                format!("No faults, {}", several(notes, "note")),
                palette.accent,
            ),
            (0, w) => (several(w, "warning"), palette.warning),
            (f, 0) => (several(f, "fault"), palette.fault),
            (f, w) => (
                format!("{}, {}", several(f, "fault"), several(w, "warning")),
                palette.fault,
            ),
        };
        let button = Button::new(RichText::new(words).color(colour)).selected(self.panes.findings);
        let tip = "List what is found wrong with the pattern";
        if ui.add(button).on_hover_text(tip).clicked() {
            self.panes.findings = !self.panes.findings;
        }
    }

    /// Marks the findings at their places on the canvas.
    pub(super) fn mark_findings(&mut self) {
        let mut marks: Vec<FindingMark> = Vec::new();
        for found in self.findings.iter() {
            let Some(item) = item_at(&found.place) else {
                continue;
            };
            let end = match found.place {
                Place::SeamEnd(_, end) => Some(end),
                _ => None,
            };
            let is_here = |mark: &&mut FindingMark| (mark.item, mark.end) == (item, end);
            match marks.iter_mut().find(is_here) {
                Some(mark) => {
                    mark.severity = mark.severity.max(found.severity);
                    mark.words = format!("{}\n{found}", mark.words);
                }
                None => marks.push(FindingMark {
                    item,
                    end,
                    severity: found.severity,
                    words: found.to_string(),
                }),
            }
        }
        self.view.finding_marks = marks;
    }

    /// Warns of an error in the pattern that the last edit caused, unless the status line shows a failure
    /// already. It is only a warning, because the edit itself succeeded.
    pub(super) fn tell_new_fault(&mut self, before: &[Diagnostic]) {
        let is_new =
            |found: &&Diagnostic| found.severity == Severity::Error && !before.contains(found);
        if !self.notice.is_fault()
            && let Some(found) = self.findings.iter().find(is_new)
        {
            self.notice = Notice::warning(found.to_string());
        }
    }

    pub(crate) fn list_findings(&mut self, ui: &mut Ui) {
        let palette = Palette::of(ui.ctx());
        let findings = self.findings.clone();
        let mut chosen = None;
        egui::ScrollArea::vertical()
            .auto_shrink([false, false])
            .show(ui, |ui| {
                if findings.is_empty() {
                    ui.label("Nothing is wrong with this pattern.");
                }
                for found in findings.iter() {
                    let words = RichText::new(found.to_string());
                    let words = words.color(finding_colour(found, palette));
                    if ui.add(Button::new(words).frame(false).wrap()).clicked() {
                        chosen = Some(found.place.clone());
                    }
                }
            });
        if let Some(item) = chosen.and_then(|place| item_at(&place)) {
            self.view.reveal(item);
            self.view.select(Selection::one(item));
        }
    }
}

/// The part that a finding is about.
fn item_at(place: &Place) -> Option<Item> {
    Some(match *place {
        Place::Point(id) => Item::Point(id),
        Place::Curve(id) => Item::Curve(id),
        Place::Panel(id) => Item::Panel(id),
        Place::Line(panel, id) => Item::Line(panel, id),
        Place::Edge(panel, id) => Item::Edge(panel, id),
        Place::Notch(panel, id) => Item::Notch(panel, id),
        Place::Operation(panel, id) => Item::Operation(panel, id),
        Place::Seam(id) | Place::SeamEnd(id, _) => Item::Seam(id),
        _ => return None,
    })
}

/// Colour of the text of a finding.
pub fn finding_colour(found: &Diagnostic, palette: &Palette) -> Color32 {
    match found.severity {
        Severity::Note => palette.ink,
        Severity::Warning => palette.warning,
        Severity::Error => palette.fault,
    }
}
