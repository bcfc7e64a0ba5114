//! The dialog of an export: formats, marker and folder.

use super::ToileApp;
use super::answer::{Answer, main_button};
use crate::fields::text_field;
use crate::theme::Palette;
use egui::{ComboBox, Grid, RichText, Ui};
use std::path::{Path, PathBuf};
use toile_session::{Export, ExportFormat};

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
    /// Error to show in the dialog.
    pub fault: String,
}

/// Groups of formats, each format with the label of its tick box.
const GROUPS: [(&str, &[(ExportFormat, &str)]); 4] = [
    (
        "Garment",
        &[
            (ExportFormat::Glb, "GLB"),
            (ExportFormat::Obj, "OBJ"),
            (ExportFormat::Drape, "Picture of the garment"),
            (ExportFormat::Fit, "Picture of the fit"),
        ],
    ),
    (
        "Marker",
        &[
            (ExportFormat::MarkerDxf, "Marker DXF"),
            (ExportFormat::MarkerPlt, "Marker HPGL"),
            (ExportFormat::MarkerPdf, "Marker PDF"),
            (ExportFormat::MarkerSvg, "Marker SVG"),
            (ExportFormat::MarkerReport, "Marker report"),
            (ExportFormat::MarkerJson, "Marker JSON"),
            (ExportFormat::MarkerInstance, "Nesting problem JSON"),
        ],
    ),
    (
        "Pieces",
        &[
            (ExportFormat::PiecesPdf, "Pieces PDF"),
            (ExportFormat::PiecesSvg, "Pieces SVG"),
        ],
    ),
    (
        "Numbers",
        &[
            (ExportFormat::Report, "Report"),
            (ExportFormat::Journal, "Journal and times"),
        ],
    ),
];

/// Description of the file of a format, in words.
fn meaning(format: ExportFormat) -> &'static str {
    match format {
        ExportFormat::Glb => "the garment as it hangs, for 3D programs; UVs in metres",
        ExportFormat::Obj => "the garment as it hangs, a group for each panel [m]",
        ExportFormat::Drape => "the garment worn",
        ExportFormat::Fit => "how much the cloth is stretched",
        ExportFormat::MarkerSvg => "the pieces on the fabric at true size",
        ExportFormat::MarkerJson => "the marker, to be checked or gone on from",
        ExportFormat::MarkerDxf => {
            "the pieces on the fabric for cutters and drafting programs [mm]"
        }
        ExportFormat::MarkerPdf => "the pieces on the fabric on one page at true size",
        ExportFormat::MarkerReport => "A4: picture, table of the pieces, fabric needed",
        ExportFormat::MarkerPlt => "the pieces on the fabric for plotters, HPGL/2",
        ExportFormat::MarkerInstance => "the pieces alone, for other nesting programs",
        ExportFormat::PiecesPdf => "the pieces on sheets of A4 at true size; Print has other paper",
        ExportFormat::PiecesSvg => "the pieces on one page at true size",
        ExportFormat::Report => "what is exported, in numbers; by itself garment and marker",
        ExportFormat::Journal => "the commands that led here, and how long they took",
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
        for (group, formats) in GROUPS {
            ui.label(RichText::new(group).strong());
            Grid::new(("export", group)).num_columns(2).show(ui, |ui| {
                for (k, (format, words)) in formats.iter().enumerate() {
                    let mut is_on = choice.formats.contains(format);
                    let ticked = ui.checkbox(&mut is_on, *words);
                    if ticked.changed() {
                        choice.set(*format, is_on);
                    }
                    ticked.on_hover_text(format!("{}: {}", format.file(), meaning(*format)));
                    if k % 2 == 1 {
                        ui.end_row();
                    }
                }
            });
        }
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
