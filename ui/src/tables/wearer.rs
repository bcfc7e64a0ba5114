//! The wearer: body, size and all measurements of the person who tries the garment on.

use super::line_field::line_field;
use super::named;
use crate::app::ToileApp;
use crate::app::tool_commands::WEARER_FROM_FILE;
use crate::fields::Entered;
use crate::theme::Palette;
use crate::tools::number;
use egui::{Grid, Id, RichText, Role, ScrollArea, Ui, WidgetInfo};
use std::path::Path;
use toile_measure::{CATALOGUE, FURTHER, Measurements, Origin, UnitKind, definition};
use toile_pattern::{DisplayUnit, Number, Want, plan};
use toile_session::{BodyChoice, Command, Figure};

/// Width of the list of figures (pixels).
const CHOICE: f32 = 420.0;
/// Least width of the measurements beside the list (pixels).
const MEASUREMENTS: f32 = 400.0;
/// Name of the measurement that is stored, too, when another one is typed, unless it was given before.
const HEIGHT: &str = "height";
/// Width of the value of a measurement (pixels).
const VALUE: f32 = 96.0;

/// State of the wearer table that is kept between frames.
#[derive(Default)]
pub struct WearerTable {
    /// Search text.
    search: String,
    /// Every figure, with height, and bust or chest girth (m).
    figures: Vec<(Figure, [f64; 2])>,
    known: Option<Known>,
    /// The last chosen wearer from measurements or a file, to be chosen again after a figure was tried.
    own: Option<BodyChoice>,
}

/// The measurements of a wearer, cached because their prediction takes longer than a frame.
#[derive(Clone)]
struct Known {
    /// Revision of the project.
    revision: u64,
    /// All measurements.
    all: Measurements,
    /// The measurements that were given.
    asked: Measurements,
    /// Height of the average body of the wearer's figure (m).
    figure_height: Option<f64>,
}

impl WearerTable {
    /// Forgets the wearer from measurements or a file, because another document is opened.
    pub fn forget(&mut self) {
        self.own = None;
    }
}

/// A measurement of the wearer.
struct Row {
    name: String,
    label: String,
    want: Want,
    value: f64,
    is_asked: bool,
}

/// Name of a figure.
fn figure_words(figure: Figure) -> String {
    match figure {
        Figure::Woman => "Woman".to_owned(),
        Figure::Man => "Man".to_owned(),
        Figure::Mean => "Average adult".to_owned(),
        Figure::DressForm => "Dress form".to_owned(),
        child => {
            let years = child.name().trim_start_matches("child-");
            format!("Child of {years} years")
        }
    }
}

impl ToileApp {
    /// The choice of the wearer on the left, the measurements on the right; below each other if the table
    /// is too narrow for that.
    pub(super) fn wearer_table(&mut self, ui: &mut Ui) {
        if ui.available_width() < CHOICE + MEASUREMENTS {
            let all = ScrollArea::both()
                .id_salt("wearer")
                .auto_shrink([false, false]);
            all.show(ui, |ui| {
                self.figure_choice(ui);
                ui.separator();
                self.worn_size_choice(ui);
                let known = self.wearer_search(ui);
                self.wearer_rows(ui, &known);
            });
            return;
        }
        ui.horizontal_top(|ui| {
            ui.vertical(|ui| {
                ui.set_width(CHOICE);
                let choice = ScrollArea::vertical()
                    .id_salt("wearers")
                    .auto_shrink([false, false]);
                choice.show(ui, |ui| self.figure_choice(ui));
            });
            ui.separator();
            ui.vertical(|ui| {
                self.worn_size_choice(ui);
                let known = self.wearer_search(ui);
                let area = ScrollArea::vertical()
                    .id_salt("wearer's measurements")
                    .auto_shrink([false, false]);
                area.show(ui, |ui| self.wearer_rows(ui, &known));
            });
        });
    }

    /// The list of built-in figures, and the wearer from a file or from the pattern.
    fn figure_choice(&mut self, ui: &mut Ui) {
        let body = self.session.project().body.clone();
        let size = self.session.project().size.clone();
        let mut chosen = None;
        ui.horizontal(|ui| {
            self.command_button(ui, &WEARER_FROM_FILE);
            if ui
                .selectable_label(body.is_of_pattern(), "As the pattern says")
                .on_hover_text(
                    "A woman of the pattern's size; the mean adult where it has no sizes",
                )
                .clicked()
            {
                chosen = Some(None);
            }
        });
        let palette = Palette::of(ui.ctx());
        if let BodyChoice::Missing { .. } = &body {
            ui.label(RichText::new(body.words()).color(palette.fault));
        }
        if matches!(
            body,
            BodyChoice::Measured { .. } | BodyChoice::Shaped { .. }
        ) {
            self.tables.wearer.own = Some(body.clone());
        }
        let own = self
            .tables
            .wearer
            .own
            .clone()
            .filter(|own| *own == body || chosen_again(own).is_some());
        if let Some(own) = own
            && ui.selectable_label(own == body, own.words()).clicked()
            && own != body
            && let Some(again) = chosen_again(&own)
        {
            self.execute(again);
        }
        if self.tables.wearer.figures.is_empty() {
            let girths = |figure: Figure| {
                let average = figure.average();
                let of = |name| average.get(name).unwrap_or_default();
                (figure, ["height", "bust"].map(of))
            };
            self.tables.wearer.figures = Figure::ALL.into_iter().map(girths).collect();
        }
        let (adults, children): (Vec<_>, Vec<_>) = (self.tables.wearer.figures.iter().copied())
            .partition(|(figure, _)| !figure.name().starts_with("child"));
        let words = |girths: [f64; 2]| self.figure_girths(size.as_deref(), girths);
        Grid::new("figures").striped(true).show(ui, |ui| {
            for (figure, girths) in adults {
                let is_worn = body == BodyChoice::Sample(figure);
                if ui.selectable_label(is_worn, figure_words(figure)).clicked() {
                    chosen = Some(Some(figure));
                }
                ui.label(RichText::new(words(girths)).color(palette.ink_soft));
                ui.end_row();
            }
        });
        ui.horizontal_wrapped(|ui| {
            ui.label("Child, years:");
            for (figure, girths) in children {
                let is_worn = body == BodyChoice::Sample(figure);
                let age = figure.name().trim_start_matches("child-");
                let name = figure_words(figure);
                let choice = ui.selectable_label(is_worn, age);
                choice.widget_info(|| WidgetInfo::selected(Role::Button, true, is_worn, &name));
                let choice = choice.on_hover_text(format!("{name}: {}", words(girths)));
                if choice.clicked() {
                    chosen = Some(Some(figure));
                }
            }
        });
        if let Some(figure) = chosen {
            self.execute(Command::SetBody {
                figure,
                measurements: None,
            });
        }
    }

    /// Height and bust or chest girth of a figure, in words; if the garment is worn in a size, that size.
    fn figure_girths(&self, size: Option<&str>, girths: [f64; 2]) -> String {
        if let Some(size) = size {
            return format!("in size {size}");
        }
        let unit = self.base.pattern().unit;
        let shown = |value: f64| {
            let whole = match unit {
                DisplayUnit::Inch => value,
                _ => (value * 100.0).round() / 100.0,
            };
            number::show(whole, Want::Length, unit)
        };
        let [height, bust] = girths.map(shown);
        format!("{height} tall, bust or chest {bust}")
    }

    /// The choice between the sizes of the pattern and the wearer's own measurements.
    fn worn_size_choice(&mut self, ui: &mut Ui) {
        let project = self.session.project();
        let names: Vec<String> = project
            .pattern
            .sizes
            .iter()
            .map(|s| s.name.clone())
            .collect();
        if names.is_empty() {
            return;
        }
        let drafted = project.size_name().map(str::to_owned);
        let is_own = project.size.is_none() && !project.body.is_of_pattern();
        let shows_own = !project.body.is_of_pattern();
        let mut chosen = None;
        ui.horizontal_wrapped(|ui| {
            ui.label("Drafted to");
            if shows_own && ui.selectable_label(is_own, "the wearer").clicked() {
                chosen = Some(None);
            }
            for name in names {
                let is_worn = drafted.as_ref() == Some(&name);
                if ui
                    .selectable_label(is_worn, format!("size {name}"))
                    .clicked()
                {
                    chosen = Some(Some(name));
                }
            }
        });
        if let Some(size) = chosen {
            self.execute(Command::SetSize { size });
        }
    }

    /// Shows the search field; returns all measurements of the wearer.
    fn wearer_search(&mut self, ui: &mut Ui) -> Known {
        ui.horizontal_wrapped(|ui| {
            let label = ui.label("Find measurement").id;
            let search = &mut self.tables.wearer.search;
            line_field(ui, label, search, ("waist, knee, back\u{2026}", 180.0));
            let words = "Type what was measured; what is left empty is estimated from it";
            ui.label(RichText::new(words).color(Palette::of(ui.ctx()).ink_soft));
        });
        self.known_wearer()
    }

    /// Shows a row for each measurement that matches the search.
    fn wearer_rows(&mut self, ui: &mut Ui, known: &Known) {
        let rows = found_rows(known, &self.tables.wearer.search);
        if rows.is_empty() {
            ui.label("No measurement has this in its name or meaning.");
        }
        let grid = Grid::new("wearer's measurements").striped(true);
        grid.show(ui, |ui| {
            for row in &rows {
                self.wearer_row(ui, row, known);
                ui.end_row();
            }
        });
    }

    fn wearer_row(&mut self, ui: &mut Ui, row: &Row, known: &Known) {
        let palette = Palette::of(ui.ctx());
        let words = match row.is_asked {
            true => RichText::new(&row.label),
            false => RichText::new(&row.label).color(palette.ink_soft),
        };
        let mut label = named(ui, 0.0, words);
        if let Some(entry) = definition(&row.name) {
            label = label.on_hover_text(format!("{}: {}", row.name, entry.meaning));
        }
        let base = self.base.clone();
        // Predicted lengths are shown to a tenth of a millimetre.
        let shown = match (row.is_asked, row.want) {
            (true, _) => plan::number_shown(&base, &Number::Value(row.value), row.want),
            (false, Want::Length) => {
                let value = (row.value * 1e4).round() / 1e4;
                plan::number_shown(&base, &Number::Value(value), row.want)
            }
            (false, want) => number::show(row.value, want, base.pattern().unit),
        };
        let id = Id::unique(("wearer", &row.name));
        let entered = ui.scope(|ui| {
            ui.set_width(VALUE);
            self.typed.field(ui, (id, label.id), &shown, |text| {
                number::parse(text, row.want, &base).map(|_| String::new())
            })
        });
        let origin = match row.is_asked {
            true => RichText::new("given"),
            false => RichText::new("estimated").italics().color(palette.ink_soft),
        };
        ui.label(origin);
        if let Entered::Text(text) = entered.inner {
            let value = match text.is_empty() {
                true => Ok(None),
                false => number::parse(&text, row.want, &base)
                    .and_then(|found| base.number_or_fault(&found, row.want).map(Some)),
            };
            let changed = value.and_then(|value| with_measurement(known, &row.name, value));
            let faults = changed.and_then(|measurements| {
                let figure = None;
                match self.execute(Command::SetMeasurements {
                    figure,
                    measurements,
                }) {
                    true => Ok(()),
                    false => Err(self.fault().unwrap_or_default().to_owned()),
                }
            });
            if let Err(fault) = faults {
                self.typed.refuse(id, text, fault);
            }
        }
    }

    /// The measurements of the present wearer, computed anew after a change of the project.
    fn known_wearer(&mut self) -> Known {
        let revision = self.session.revision();
        let known = self.tables.wearer.known.take();
        let holds = |known: &Known| known.revision == revision || self.session.is_previewing();
        let known = known.filter(holds).unwrap_or_else(|| {
            let project = self.session.project();
            Known {
                revision,
                all: project.body_measurements(),
                asked: project.asked_measurements(),
                figure_height: project.figure().average().get(HEIGHT),
            }
        });
        self.tables.wearer.known.insert(known).clone()
    }

    /// Takes the wearer from a file: a table of measurements, applied to the present figure, or a
    /// mannequin.
    pub(crate) fn take_wearer(&mut self, path: &Path) {
        let figure = Some(self.session.project().figure());
        self.execute(Command::SetBody {
            figure,
            measurements: Some(path.to_owned()),
        });
    }
}

/// Command that chooses a wearer from measurements or a file again; `None` for an edited mannequin, which
/// is in no file.
fn chosen_again(own: &BodyChoice) -> Option<Command> {
    match own {
        BodyChoice::Measured {
            figure,
            path: None,
            measurements,
        } => Some(Command::SetMeasurements {
            figure: Some(*figure),
            measurements: (**measurements).clone(),
        }),
        BodyChoice::Measured {
            figure,
            path: Some(path),
            ..
        } => Some(Command::SetBody {
            figure: Some(*figure),
            measurements: Some(path.clone()),
        }),
        BodyChoice::Shaped {
            path: Some(path), ..
        } => Some(Command::SetBody {
            figure: None,
            measurements: Some(path.clone()),
        }),
        _ => None,
    }
}

/// The given measurements with one added, changed or removed. If another measurement than the height is
/// typed, the present height is stored as a given measurement, too, so that measurements from the floor do
/// not change.
fn with_measurement(known: &Known, name: &str, value: Option<f64>) -> Result<Measurements, String> {
    let mut table = known.asked.clone();
    let mut ask = |name: &str, value: f64| {
        let asked = table.set(name, value, Origin::Asked);
        asked.map_err(|error| error.to_string())
    };
    match value {
        Some(value) => {
            ask(name, value)?;
            if name != HEIGHT
                && !known.asked.contains(HEIGHT)
                && let Some(height) = known.all.get(HEIGHT)
            {
                ask(HEIGHT, (height * 1e3).round() / 1e3)?;
            }
        }
        None => {
            table.remove(name);
            // The height was stored only beside another measurement: if it is the last one left, it is
            // removed, too.
            let height = known.figure_height.filter(|_| table.len() == 1);
            if let (Some(usual), Some(given)) = (height, table.get(HEIGHT))
                && (usual - given).abs() < 1e-3
            {
                table.remove(HEIGHT);
            }
        }
    }
    Ok(table)
}

/// Rows of the measurements whose name or meaning contains every word of the search, from head to foot.
fn found_rows(known: &Known, search: &str) -> Vec<Row> {
    let catalogue = CATALOGUE.iter().chain(FURTHER).map(|known| known.name);
    let mut names: Vec<&str> = catalogue.filter(|name| known.all.contains(name)).collect();
    for (name, _) in known.all.iter() {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let search = search.to_lowercase();
    let is_found = |name: &&str| {
        let mut text = name.to_lowercase();
        if let Some(known) = definition(name) {
            let others = known.aliases.join(" ");
            text = format!("{text} {} {} {others}", known.label, known.meaning).to_lowercase();
        }
        search.split_whitespace().all(|word| text.contains(word))
    };
    let rows = names.into_iter().filter(is_found).map(|name| {
        let definition = definition(name);
        Row {
            name: name.to_owned(),
            label: definition.map_or(name, |known| known.label).to_owned(),
            want: match definition.map(|known| known.kind) {
                Some(UnitKind::Angle) => Want::Angle,
                _ => Want::Length,
            },
            value: known.all.get(name).unwrap_or_default(),
            is_asked: known.asked.contains(name),
        }
    });
    rows.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measurements_are_found_by_name_and_meaning() {
        let all = Measurements::adult_woman();
        let mut asked = Measurements::new();
        asked.set("waist", 0.8, Origin::Asked).unwrap();
        let known = Known {
            revision: 0,
            all,
            asked,
            figure_height: None,
        };
        let whole = found_rows(&known, "");
        assert_eq!(whole.len(), known.all.len());
        assert_eq!(whole[0].name, "height");
        let waist = found_rows(&known, " Waist GIRTH ");
        assert!(waist.iter().any(|row| row.name == "waist" && row.is_asked));
        assert!(waist.len() < whole.len() / 4);
        // The word "crown" is only in the meaning of the height.
        assert_eq!(found_rows(&known, "floor crown")[0].name, "height");
        assert!(found_rows(&known, "elephant").is_empty());
    }
}
