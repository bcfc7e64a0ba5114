//! The dialog of a print: paper, scale, panels and file.

use super::ToileApp;
use super::answer::{Answer, main_button};
use crate::fields::text_field;
use crate::theme::Palette;
use egui::{ComboBox, Grid, RichText, Ui};
use toile_session::{Lines, Paper, PrintOptions, SizeSelection};

/// Settings of a print.
#[derive(Clone, Debug)]
pub struct PrintChoice {
    /// Content and layout of the print.
    pub options: PrintOptions,
    /// Names of the selected panels.
    pub selected: Vec<String>,
    /// Whether only the selected panels are printed.
    pub only_selected: bool,
    /// The scale as typed, for example 1:4.
    pub scale: String,
    /// Path of the file to write.
    pub path: String,
    /// Error to show in the dialog.
    pub fault: String,
}

impl ToileApp {
    /// Shows the dialog of a print.
    pub(super) fn ask_print_choice(&self, ui: &mut Ui, choice: &mut PrintChoice) -> Answer {
        ui.heading("Print");
        let sizes = &self.session.project().pattern.sizes;
        Grid::new("print").num_columns(2).show(ui, |ui| {
            let label = ui.label("Paper").id;
            let papers = [
                (Paper::A4, "A4, sheets to join"),
                (Paper::Letter, "Letter, sheets to join"),
                (Paper::A0, "A0, sheets to join"),
                (Paper::Page, "one page, as large as it takes"),
                (Paper::Projector, "projector"),
            ];
            choose(ui, ("paper", label), &mut choice.options.paper, &papers);
            ui.end_row();
            let label = ui.label("Size").id;
            let mut known = vec![(SizeSelection::Base, "as drafted")];
            if !sizes.is_empty() {
                known = sizes
                    .iter()
                    .map(|size| (SizeSelection::one(&*size.name), &*size.name))
                    .collect();
                known.push((SizeSelection::All, "all, a layer each"));
            }
            choose(ui, ("sizes", label), &mut choice.options.sizes, &known);
            ui.end_row();
            let label = ui.label("Lines").id;
            let lines = [
                (Lines::Both, "to cut and to sew"),
                (Lines::Cut, "to cut"),
                (Lines::Sew, "to sew"),
            ];
            choose(ui, ("lines", label), &mut choice.options.lines, &lines);
            ui.end_row();
            let label = ui.label("Scale").id;
            text_field(ui, egui::Id::unique("print scale"), &mut choice.scale).labelled_by(label);
            ui.end_row();
            let label = ui.label("File").id;
            let file = text_field(ui, egui::Id::unique("print file"), &mut choice.path);
            if ui.memory(|memory| memory.focused().is_none()) {
                file.labelled_by(label).request_focus();
            } else {
                file.labelled_by(label);
            }
            ui.end_row();
        });
        ui.checkbox(&mut choice.options.halves, "Halves of pieces on the fold");
        if !choice.selected.is_empty() {
            let words = format!("Only what is selected: {}", choice.selected.join(", "));
            ui.checkbox(&mut choice.only_selected, words);
        }
        if !choice.fault.is_empty() {
            let colour = Palette::of(ui.ctx()).fault;
            ui.label(RichText::new(&choice.fault).color(colour));
        }
        let mut answer = Answer::Stay;
        ui.horizontal(|ui| {
            if main_button(ui, "Print") {
                match read_scale(&choice.scale) {
                    Some(scale) => {
                        choice.options.scale = scale;
                        choice.options.pieces = match choice.only_selected {
                            true => choice.selected.clone(),
                            false => Vec::new(),
                        };
                        choice.fault.clear();
                        let choice = choice.clone();
                        answer = Answer::Do(Box::new(move |app| app.print(choice)));
                    }
                    None => choice.fault = "the scale is written as 1:1 or 1:4".into(),
                }
            } else if ui.button("Cancel").clicked() {
                answer = Answer::Leave;
            }
        });
        answer
    }
}

/// Shows a drop-down list of the values `known`, and stores the user's choice in `chosen`.
fn choose<T: Clone + PartialEq>(
    ui: &mut Ui,
    (name, label): (&str, egui::Id),
    chosen: &mut T,
    known: &[(T, &str)],
) {
    let shown = known.iter().find(|(value, _)| value == chosen);
    ComboBox::from_id_salt(("print", name))
        .selected_text(shown.map_or("", |(_, words)| words))
        .width(240.0)
        .show_ui(ui, |ui| {
            for (value, words) in known {
                ui.selectable_value(chosen, value.clone(), *words);
            }
        })
        .response
        .labelled_by(label);
}

/// Reads a typed scale: 1:4, 1/4, 25 % or 0.25.
fn read_scale(text: &str) -> Option<f64> {
    let text = text.trim().replace(',', ".");
    let number = |text: &str| text.trim().parse::<f64>().ok();
    let scale = match text.split_once([':', '/']) {
        Some((paper, cloth)) => number(paper)? / number(cloth)?,
        None => match text.strip_suffix('%') {
            Some(percent) => number(percent)? / 100.0,
            None => number(&text)?,
        },
    };
    (scale.is_finite() && scale > 0.0).then_some(scale)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_are_read_as_they_are_written() {
        assert_eq!(read_scale("1:4"), Some(0.25));
        assert_eq!(read_scale(" 1/5 "), Some(0.2));
        assert_eq!(read_scale("50 %"), Some(0.5));
        assert_eq!(read_scale("0,25"), Some(0.25));
        for text in ["", "1:0", "four", "-1", "0:1"] {
            assert_eq!(read_scale(text), None, "{text}");
        }
    }
}
