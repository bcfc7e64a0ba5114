//! The dialog of an export: formats, marker and folder.

use super::ToileApp;
use super::answer::{Answer, main_button};
use crate::fields::text_field;
use crate::theme::Palette;
use egui::{ComboBox, Grid, RichText, Ui};
use std::path::{Path, PathBuf};
use toile_session::{Export, ExportFormat, Format, WriteOptions};

/// Settings of an export.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExportChoice {
    /// Formats to write.
    pub formats: Vec<ExportFormat>,
    /// Name of the marker to write as it is laid; with `None` the pieces are laid for the export.
    pub marker: Option<String>,
    /// Folder of the files, as typed.
    pub folder: String,
    /// Existing files that the export would replace, and that the user was told of; empty before. If the user
    /// confirms once more, they are replaced.
    pub replaced: Vec<PathBuf>,
    /// Contents that the chosen formats of patterns leave out, in words.
    pub lost: Vec<(Format, Vec<String>)>,
    /// Error to show in the dialog.
    pub fault: String,
}

/// A group of formats in the dialog.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Group {
    Garment,
    Marker,
    Pieces,
    Pattern,
    Numbers,
}

impl Group {
    /// The groups with their titles, in the order of the dialog.
    const ALL: [(Self, &str); 5] = [
        (Self::Garment, "Garment"),
        (Self::Marker, "Marker"),
        (Self::Pieces, "Pieces"),
        (Self::Pattern, "Pattern"),
        (Self::Numbers, "Numbers"),
    ];
}

/// Group and label of the tick box of a format, and the description of its file.
fn words(format: ExportFormat) -> (Group, &'static str, &'static str) {
    use Group::{Garment, Marker, Numbers, Pattern, Pieces};
    match format {
        ExportFormat::Glb => (
            Garment,
            "GLB",
            "the garment as it hangs, for 3D programs; UVs in metres",
        ),
        ExportFormat::Obj => (
            Garment,
            "OBJ",
            "the garment as it hangs, a group for each panel [m]",
        ),
        ExportFormat::Drape => (Garment, "Picture of the garment", "the garment worn"),
        ExportFormat::Fit => (
            Garment,
            "Picture of the fit",
            "how much the cloth is stretched",
        ),
        ExportFormat::MarkerDxf => (
            Marker,
            "Marker DXF",
            "the pieces on the fabric for cutters and drafting programs [mm]",
        ),
        ExportFormat::MarkerPlt => (
            Marker,
            "Marker HPGL",
            "the pieces on the fabric for plotters, HPGL/2",
        ),
        ExportFormat::MarkerPdf => (
            Marker,
            "Marker PDF",
            "the pieces on the fabric on one page at true size",
        ),
        ExportFormat::MarkerSvg => (
            Marker,
            "Marker SVG",
            "the pieces on the fabric at true size",
        ),
        ExportFormat::MarkerReport => (
            Marker,
            "Marker report",
            "A4: picture, table of the pieces, fabric needed",
        ),
        ExportFormat::MarkerJson => (
            Marker,
            "Marker JSON",
            "the marker, to be checked or gone on from",
        ),
        ExportFormat::MarkerInstance => (
            Marker,
            "Nesting problem JSON",
            "the pieces alone, for other nesting programs",
        ),
        ExportFormat::PiecesPdf => (
            Pieces,
            "Pieces PDF",
            "the pieces on sheets of A4 at true size; Print has other paper",
        ),
        ExportFormat::PiecesSvg => (Pieces, "Pieces SVG", "the pieces on one page at true size"),
        ExportFormat::PatternGarmentcode => {
            (Pattern, "GarmentCode", "panels and seams for GarmentCode")
        }
        ExportFormat::PatternSvg => (
            Pattern,
            "SVG",
            "the panels in layers, to be drawn on and opened again",
        ),
        ExportFormat::PatternDxfAama => (
            Pattern,
            "DXF-AAMA",
            "the pieces in all sizes for programs of the trade",
        ),
        ExportFormat::PatternDxfAstm => (
            Pattern,
            "DXF-ASTM",
            "the pieces in all sizes for programs of the trade",
        ),
        ExportFormat::Report => (
            Numbers,
            "Report",
            "what is exported, in numbers; by itself garment and marker",
        ),
        ExportFormat::Journal => (
            Numbers,
            "Journal and times",
            "the commands that led here, and how long they took",
        ),
    }
}

impl ExportChoice {
    /// The export that these settings describe.
    pub fn export(&self) -> Export {
        let export = Export {
            dir: PathBuf::from(self.folder.trim()),
            formats: self.formats.clone(),
            marker: None,
        };
        Export {
            marker: self.marker.clone().filter(|_| export.takes_marker()),
            ..export
        }
    }

    /// Existing files that the export would replace.
    fn would_replace(&self) -> Vec<PathBuf> {
        let folder = Path::new(self.folder.trim());
        let mut there: Vec<PathBuf> = std::fs::read_dir(folder)
            .into_iter()
            .flatten()
            .filter_map(|entry| Some(entry.ok()?.path()))
            .filter(|path| self.formats.iter().any(|format| is_written(*format, path)))
            .collect();
        there.sort();
        there
    }

    fn set(&mut self, format: ExportFormat, is_on: bool) {
        self.formats.retain(|other| *other != format);
        if is_on {
            self.formats.push(format);
            self.formats.sort_unstable();
        }
    }
}

/// Whether an export in a format can write a file of this name: the format's usual name, or that name with
/// the number of a fabric, or the name of a layer.
fn is_written(format: ExportFormat, path: &Path) -> bool {
    let Some(name) = path.file_name().and_then(|name| name.to_str()) else {
        return false;
    };
    let own = format.file();
    let (stem, end) = own.rsplit_once('.').unwrap_or((own, ""));
    let rest = |stem: &str| {
        name.strip_prefix(stem)?
            .strip_prefix('-')?
            .strip_suffix(end)
    };
    let numbered = |rest: &str| {
        rest.trim_end_matches('.')
            .chars()
            .all(|c| c.is_ascii_digit())
    };
    let is_layer = format == ExportFormat::Obj && rest("layer").is_some();
    name == own || rest(stem).is_some_and(numbered) || is_layer
}

impl ToileApp {
    /// Shows the dialog of an export.
    pub(super) fn ask_export_choice(&self, ui: &mut Ui, choice: &mut ExportChoice) -> Answer {
        ui.heading("Export");
        for (group, title) in Group::ALL {
            ui.label(RichText::new(title).strong());
            Grid::new(("export", title)).num_columns(2).show(ui, |ui| {
                let formats = ExportFormat::ALL.into_iter();
                let formats = formats.filter(|format| words(*format).0 == group);
                for (k, format) in formats.enumerate() {
                    let (_, label, meaning) = words(format);
                    let mut is_on = choice.formats.contains(&format);
                    let ticked = ui.checkbox(&mut is_on, label);
                    if ticked.changed() {
                        choice.set(format, is_on);
                    }
                    ticked.on_hover_text(format!("{}: {meaning}", format.file()));
                    if k % 2 == 1 {
                        ui.end_row();
                    }
                }
            });
        }
        self.tell_losses(ui, choice);
        Grid::new("export to").num_columns(2).show(ui, |ui| {
            self.choose_marker(ui, choice);
            let label = ui.label("Folder").id;
            let field = egui::Id::unique("export folder");
            let field = text_field(ui, field, &mut choice.folder).labelled_by(label);
            if ui.memory(|memory| memory.focused().is_none()) {
                field.request_focus();
            }
            ui.end_row();
        });
        self.answer_export(ui, choice)
    }

    /// Tells what the chosen formats of patterns leave out.
    fn tell_losses(&self, ui: &mut Ui, choice: &mut ExportChoice) {
        let patterns = choice
            .formats
            .iter()
            .filter_map(|format| format.of_pattern());
        let patterns: Vec<Format> = patterns.collect();
        choice.lost.retain(|(format, _)| patterns.contains(format));
        let project = self.session.project();
        let palette = Palette::of(ui.ctx());
        for format in patterns {
            if !choice.lost.iter().any(|(known, _)| *known == format) {
                let lost = project.lost_in(format, &WriteOptions::whole(format, &project.pattern));
                let words = lost.map(|lost| lost.iter().map(ToString::to_string).collect());
                choice.lost.push((
                    format,
                    words.unwrap_or_else(|error| vec![error.to_string()]),
                ));
            }
            let lost = choice.lost.iter().find(|(known, _)| *known == format);
            let Some((_, lost)) = lost.filter(|(_, lost)| !lost.is_empty()) else {
                continue;
            };
            let words = format!("{} leaves out: {}", format.title(), lost.join("; "));
            let label = RichText::new(words).small().color(palette.warning);
            ui.add(egui::Label::new(label).truncate())
                .on_hover_text(lost.join("\n"));
        }
    }

    /// Lets the user choose the marker to write, if the pattern has any.
    fn choose_marker(&self, ui: &mut Ui, choice: &mut ExportChoice) {
        let markers = &self.session.project().pattern.markers;
        if markers.is_empty() {
            return;
        }
        let anew = "laid anew";
        let label = ui.label("Marker to write").id;
        let shown = choice.marker.clone().unwrap_or_else(|| anew.to_owned());
        ComboBox::from_id_salt("marker to write")
            .selected_text(shown)
            .width(240.0)
            .show_ui(ui, |ui| {
                for marker in markers {
                    let name = Some(marker.name.clone());
                    let words = format!("{}, as it lies", marker.name);
                    ui.selectable_value(&mut choice.marker, name, words);
                }
                ui.selectable_value(&mut choice.marker, None, anew);
            })
            .response
            .labelled_by(label);
        ui.end_row();
    }

    fn answer_export(&self, ui: &mut Ui, choice: &mut ExportChoice) -> Answer {
        let would_replace = choice.would_replace();
        let asks = !choice.replaced.is_empty() && choice.replaced == would_replace;
        let palette = Palette::of(ui.ctx());
        if !choice.fault.is_empty() {
            ui.label(RichText::new(&choice.fault).color(palette.fault));
        } else if asks {
            let names: Vec<_> = would_replace
                .iter()
                .filter_map(|file| file.file_name())
                .collect();
            let names: Vec<_> = names.iter().map(|name| name.to_string_lossy()).collect();
            let words = format!("There already: {}", names.join(", "));
            ui.label(RichText::new(words).color(palette.warning));
        }
        let mut answer = Answer::Stay;
        ui.horizontal(|ui| {
            // Enter does not replace existing files.
            let (keeps, exports) = match asks {
                true => (main_button(ui, "Keep them"), ui.button("Replace").clicked()),
                false => (false, main_button(ui, "Export")),
            };
            if keeps {
                choice.replaced.clear();
            } else if exports {
                choice.fault.clear();
                if choice.formats.is_empty() {
                    choice.fault = "tick what is to be written".into();
                } else if choice.folder.trim().is_empty() {
                    choice.fault = "name the folder it goes to".into();
                } else if !asks && !self.has_exported(&would_replace) {
                    choice.replaced = would_replace;
                } else {
                    let choice = choice.clone();
                    answer = Answer::Do(Box::new(move |app| app.export(choice)));
                }
            } else if ui.button("Cancel").clicked() {
                answer = Answer::Leave;
            }
        });
        answer
    }
}
