//! Rows of the figures of a fabric: label, value, unit, source.

use super::fabric::{Viewed, field};
use super::fabric_words::{library_source, own_source};
use crate::app::ToileApp;
use crate::fields::Entered;
use crate::theme::Palette;
use crate::tools::number;
use egui::{ComboBox, Grid, Id, Label, RichText, Ui};
use strum::VariantArray;
use toile_fabric::{Access, Compression, FIGURES, LibraryFabric};
use toile_pattern::plan::{self, FabricFigure};
use toile_pattern::{Fabric, Want};
use toile_session::with_hardening;

/// Largest width of the text that names the source of a figure (pixels).
const SOURCE: f32 = 150.0;

impl ToileApp {
    /// Shows the figures of a fabric, one per row: name, value, unit, source.
    pub(super) fn figure_rows(
        &mut self,
        ui: &mut Ui,
        (viewed, fabric): (Viewed, &Fabric),
        figures: &[FabricFigure],
    ) {
        let soft = Palette::of(ui.ctx()).ink_soft;
        let whole = with_hardening(fabric);
        let shown_in = self.base.pattern().unit;
        Grid::new(("fabric figures", figures.first().map(|f| f.name())))
            .num_columns(4)
            .show(ui, |ui| {
                for &figure in figures {
                    let name = RichText::new(figure.name()).color(soft);
                    let label = ui.label(name).on_hover_text(figure.about()).id;
                    let (sign, unit) = figure.unit();
                    let (shown, sign) = match (figure, figure.of(&whole)) {
                        (_, None) => (String::new(), sign),
                        (FabricFigure::Width, Some(width)) => {
                            (number::show(width, Want::Length, shown_in), "")
                        }
                        (FabricFigure::Material(_), Some(value)) => {
                            (shown_figure(value / unit), sign)
                        }
                    };
                    match viewed {
                        Viewed::Own(_) => self.figure_field(ui, (figure, label), (&whole, &shown)),
                        Viewed::Library(_) | Viewed::File => {
                            ui.label(shown);
                        }
                    }
                    ui.label(RichText::new(sign).color(soft));
                    let source = match viewed {
                        Viewed::Own(_) => own_source(figure, fabric),
                        Viewed::Library(name) => LibraryFabric::named(name)
                            .map_or("", |library| library_source(figure, library))
                            .to_owned(),
                        Viewed::File => "given in its file".to_owned(),
                    };
                    ui.scope(|ui| {
                        ui.set_max_width(SOURCE);
                        let words = RichText::new(&source).small().color(soft);
                        ui.add(Label::new(words).truncate()).on_hover_text(source);
                    });
                    ui.end_row();
                }
            });
    }

    /// Shows the choice of the law by which the cloth resists compression.
    pub(super) fn compression_choice(&mut self, ui: &mut Ui, viewed: Viewed, fabric: &Fabric) {
        let before = fabric.material.compression;
        let mut chosen = before;
        ui.horizontal(|ui| {
            for figure in &FIGURES {
                let Access::Compression { .. } = figure.access else {
                    continue;
                };
                let soft = Palette::of(ui.ctx()).ink_soft;
                let name = RichText::new(figure.label).color(soft);
                let label = ui.label(name).on_hover_text(figure.about).id;
                if viewed != Viewed::Own(fabric.id) {
                    ui.label(before.word());
                    continue;
                }
                let list = ComboBox::from_id_salt("compression")
                    .selected_text(before.word())
                    .show_ui(ui, |ui| {
                        for &kind in Compression::VARIANTS {
                            ui.selectable_value(&mut chosen, kind, kind.word());
                        }
                    });
                list.response.labelled_by(label);
            }
        });
        if chosen != before {
            let mut changed = fabric.clone();
            changed.material.compression = chosen;
            let planned = plan::set_fabric(&self.base, changed);
            self.edit(planned, "Set compression");
        }
    }

    /// Shows the field of a figure, for a fabric of the pattern.
    fn figure_field(
        &mut self,
        ui: &mut Ui,
        (figure, label): (FabricFigure, Id),
        (fabric, shown): (&Fabric, &str),
    ) {
        let base = self.base.clone();
        let (sign, unit) = figure.unit();
        let read = |text: &str| {
            if text.trim().is_empty() && figure.may_be_absent() {
                return Ok(None);
            }
            let (want, unit) = match figure {
                FabricFigure::Width => (Want::Length, 1.0),
                FabricFigure::Material(_) => (Want::Plain, unit),
            };
            let bare = match want {
                Want::Plain => text.trim().trim_end_matches(sign),
                _ => text,
            };
            let found = number::parse(bare, want, &base)?;
            let value = Some(unit * base.number_or_fault(&found, want)?);
            figure.check(value).map(|()| value)
        };
        let id = Id::unique(("fabric figure", fabric.id, figure.name()));
        let entered = field(ui, |ui| {
            self.typed.field(ui, (id, label), shown, |text| {
                read(text).map(|_| String::new())
            })
        });
        if let Entered::Text(text) = entered {
            match read(&text) {
                Ok(value) => {
                    let planned = plan::set_fabric_figure(&base, fabric.clone(), (figure, value));
                    self.enter(planned, "Change fabric", (id, text));
                }
                Err(fault) => self.typed.refuse(id, text, fault),
            }
        }
    }
}

/// A figure rounded to four significant digits, without trailing zeros.
fn shown_figure(value: f64) -> String {
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    format!("{rounded}")
}
