//! Tables under the pattern: measurements by size, variables, grade rules, wearer and layers, the history.

mod fabric;
mod fabric_figures;
mod fabric_words;
mod grade_rules;
mod handle;
mod history;
mod line_field;
mod properties;
mod wearer;
mod worn_where;
mod worn_with;

pub use fabric::FabricTable;
pub use line_field::is_empty_field;
pub use wearer::WearerTable;
pub use worn_where::WornWhere;

use crate::app::ToileApp;
use crate::app::tab::Tab;
use crate::fields::{Beside, Entered};
use crate::inspector::number_field_id;
use crate::theme::Palette;
use crate::tools::number;
use egui::containers::menu::{MenuButton, MenuConfig};
use egui::{Button, Color32, Grid, Id, PopupCloseBehavior, RichText, ScrollArea, TextStyle, Ui};
use line_field::{is_entered, line_field};
use toile_measure::{CATALOGUE, Definition, Measurements, definition, is_angle};
use toile_pattern::{Number, Pattern, SizeId, VariableId, Want, plan};

/// Measurements that the first size of a pattern gets, with the wearer's values.
const FIRST: &[&str] = &[
    "height",
    "bust",
    "underbust",
    "waist",
    "hips",
    "neck",
    "shoulder_width",
    "back_length",
    "waist_to_hips",
    "arm_length",
    "upper_arm",
    "wrist",
];

/// Width of the value of a measurement (pixels).
const VALUE: f32 = 84.0;
/// Least width of the name of a measurement (pixels).
const MIN_LABEL_WIDTH: f32 = 100.0;

/// Width of the name of a variable (pixels).
const NAME: f32 = 150.0;
/// Width of the formula of a variable (pixels).
const FORMULA: f32 = 320.0;

/// Width reserved for the button beside the field of a new variable (pixels).
const ADD_BUTTON: f32 = 120.0;

/// Largest number of measurements that are proposed for a typed name.
const PROPOSED: usize = 5;

impl ToileApp {
    pub(crate) fn show_tables(&mut self, ui: &mut Ui) {
        ui.horizontal_wrapped(|ui| {
            for (tab, name) in [
                (Tab::Measurements, "Measurements"),
                (Tab::Variables, "Variables"),
                (Tab::Grading, "Grading"),
                (Tab::Fabric, "Fabric"),
                (Tab::Wearer, "Wearer"),
                (Tab::WornWith, "Worn with"),
                (Tab::History, "History"),
                (Tab::Pattern, "Pattern"),
            ] {
                ui.selectable_value(&mut self.tables.tab, tab, name);
            }
            self.tables_handle(ui);
        });
        ui.separator();
        match self.tables.tab {
            Tab::Measurements => self.measurement_table(ui),
            Tab::Variables => self.variable_table(ui),
            Tab::Grading => self.grade_rule_table(ui),
            Tab::Fabric => self.fabric_table(ui),
            Tab::Wearer => self.wearer_table(ui),
            Tab::WornWith => self.worn_with_table(ui),
            Tab::History => self.history_table(ui),
            Tab::Pattern => self.properties_table(ui),
        }
    }

    /// The table of measurements: a row per measurement, a column per size.
    fn measurement_table(&mut self, ui: &mut Ui) {
        let pattern = self.base.pattern().clone();
        let mut names: Vec<String> = Vec::new();
        for known in CATALOGUE {
            let is_used = pattern
                .sizes
                .iter()
                .any(|s| s.measurements.contains(known.name));
            if is_used {
                names.push(known.name.to_owned());
            }
        }
        for size in &pattern.sizes {
            for (name, _) in size.measurements.iter() {
                if !names.iter().any(|known| known == name) {
                    names.push(name.to_owned());
                }
            }
        }
        let mut chosen = None;
        ui.horizontal_wrapped(|ui| {
            if ui.button("Add size").clicked() {
                self.add_size();
            }
            if pattern.sizes.is_empty() {
                ui.label("The pattern has no sizes: formulas use the measurements of the wearer.");
                return;
            }
            let label = ui.label("New measurement").id;
            let text = &mut self.tables.new_measurement;
            let response = line_field(ui, label, text, ("waist, or your own name", 180.0));
            let entered = is_entered(ui, &response);
            let wanted = self.tables.new_measurement.trim().to_lowercase();
            let found: Vec<&Definition> = match wanted.is_empty() {
                true => Vec::new(),
                false => CATALOGUE
                    .iter()
                    .filter(|known| {
                        !names.iter().any(|name| name == known.name)
                            && (known.name.contains(&wanted)
                                || known.label.to_lowercase().contains(&wanted))
                    })
                    .collect(),
            };
            for known in found.iter().take(PROPOSED) {
                let button = egui::Button::new(RichText::new(known.label).small()).small();
                if ui.add(button).on_hover_text(known.meaning).clicked() {
                    chosen = Some(known.name.to_owned());
                }
            }
            // The name of an existing measurement scrolls to the row of that measurement.
            let is_there = |name: &&String| {
                let label = definition(name).map(|known| known.label.to_lowercase());
                name.to_lowercase() == wanted || label.is_some_and(|label| label == wanted)
            };
            if entered && let Some(name) = names.iter().find(is_there) {
                self.tables.new_measurement.clear();
                self.tables.entered_measurement = Some(name.clone());
            } else if entered && !wanted.is_empty() {
                let is_whole = |known: &&&Definition| {
                    known.name == wanted || known.label.to_lowercase() == wanted
                };
                let whole = found.iter().find(is_whole);
                // If exactly one measurement matches, it is added; else the text names a measurement of
                // the pattern's own.
                chosen = match (whole, &found[..]) {
                    (Some(known), _) | (None, [known]) => Some(known.name.to_owned()),
                    _ => Some(self.tables.new_measurement.trim().to_owned()),
                };
            }
        });
        self.measurement_rows(ui, &pattern, &names);
        if let Some(name) = chosen {
            self.add_measurement(&name);
        }
    }

    /// Shows the sizes as column heads, which do not scroll, and the rows below them.
    fn measurement_rows(&mut self, ui: &mut Ui, pattern: &Pattern, names: &[String]) {
        let label = |name: &str| {
            let known = definition(name);
            known.map_or_else(|| name.to_owned(), |known| known.label.to_owned())
        };
        let font = TextStyle::Body.resolve(ui.style());
        let widths = names.iter().map(|name| {
            let text = label(name);
            let text = ui
                .painter()
                .layout_no_wrap(text, font.clone(), Color32::PLACEHOLDER);
            text.size().x
        });
        let width = widths.fold(MIN_LABEL_WIDTH, f32::max);
        ScrollArea::horizontal()
            .id_salt("measurements across")
            .auto_shrink([false, false])
            .show(ui, |ui| {
                Grid::new("sizes").show(ui, |ui| {
                    if !pattern.sizes.is_empty() {
                        named(ui, width, RichText::new("Measurement").strong());
                    }
                    for size in &pattern.sizes {
                        ui.scope(|ui| {
                            ui.set_width(VALUE);
                            self.size_head(ui, size.id, &size.name);
                        });
                    }
                    ui.end_row();
                });
                let rows = ScrollArea::vertical()
                    .id_salt("measurements")
                    .auto_shrink([true, false]);
                rows.show(ui, |ui| {
                    let grid = Grid::new("measurements").striped(true);
                    grid.show(ui, |ui| {
                        for name in names {
                            let words = named(ui, width, label(name).into());
                            let words = match definition(name) {
                                Some(known) => {
                                    words.on_hover_text(format!("{name}: {}", known.meaning))
                                }
                                None => words,
                            };
                            for size in &pattern.sizes {
                                let value = size.measurements.get(name);
                                self.measurement(ui, (size.id, words.id), name, value);
                            }
                            ui.end_row();
                        }
                    });
                });
            });
    }

    fn size_head(&mut self, ui: &mut Ui, id: SizeId, name: &str) {
        let is_base = self.base.pattern().base().is_some_and(|base| base.id == id);
        let words = match is_base {
            true => RichText::new(format!("{name} (base)")).strong(),
            false => RichText::new(name).strong(),
        };
        // A click into the name field must not close the menu.
        let stays = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
        let (head, _) = MenuButton::from_button(Button::new(words).truncate())
            .config(stays)
            .ui(ui, |ui| {
                let field = Id::unique(("size name", id));
                let label = ui.label("Size name").id;
                let entered = self
                    .typed
                    .field(ui, (field, label), name, |_| Ok(String::new()));
                if ui.memory(|memory| memory.focused().is_none()) {
                    ui.memory_mut(|memory| memory.request_focus(field));
                }
                if let Entered::Text(text) = entered {
                    let planned = plan::rename(&self.base, id.into(), &text);
                    self.enter(planned, "Rename size", (field, text));
                    ui.close();
                }
                if ui.button("Make it the base size").clicked() {
                    let planned = plan::set_base_size(&self.base, Some(id));
                    self.edit(planned, "Choose base size");
                    ui.close();
                }
                if ui.button("Remove this size").clicked() {
                    let planned = plan::remove_size(&self.base, id);
                    self.edit(planned, "Remove size");
                    ui.close();
                }
            });
        head.on_hover_text("Rename or remove the size");
    }

    fn measurement(
        &mut self,
        ui: &mut Ui,
        (size, label): (SizeId, Id),
        name: &str,
        value: Option<f64>,
    ) {
        let is_angle = is_angle(name);
        let want = if is_angle { Want::Angle } else { Want::Length };
        let id = Id::unique(("measurement", size, name));
        let is_asked = self.tables.entered_measurement.as_deref() == Some(name);
        if is_asked && Some(size) == self.shown_size() && has_been_led_to(ui, id) {
            self.tables.entered_measurement = None;
        }
        let base = self.base.clone();
        let shown = value.map_or_else(String::new, |value| {
            plan::number_shown(&base, &Number::Value(value), want)
        });
        ui.scope(|ui| {
            ui.set_width(VALUE);
            let entered = self.typed.field(ui, (id, label), &shown, |text| {
                number::parse(text, want, &base).map(|_| String::new())
            });
            let Entered::Text(text) = entered else {
                return;
            };
            let value = match text.is_empty() {
                true => Ok(None),
                false => number::parse(&text, want, &base)
                    .and_then(|found| base.number_or_fault(&found, want).map(Some)),
            };
            let planned = value.and_then(|value| {
                let planned = plan::set_measurement(&base, size, name, value);
                planned.map_err(|error| error.to_string())
            });
            match planned {
                Ok(edits) => {
                    self.edit(Ok(edits), "Set measurement");
                }
                Err(fault) => self.typed.refuse(id, text, fault),
            }
        });
    }

    /// The size in which the pattern is drafted: the chosen one, else the base size, else the first.
    fn shown_size(&self) -> Option<SizeId> {
        let project = self.session.project();
        let sizes = &project.pattern.sizes;
        let shown = project.size.as_ref();
        let shown = shown.and_then(|name| sizes.iter().find(|size| size.name == *name));
        let base = project.pattern.base();
        shown.or(base).or(sizes.first()).map(|size| size.id)
    }

    /// Adds a size with the measurements of the last size; the first size gets the wearer's measurements.
    fn add_size(&mut self) {
        let pattern = self.base.pattern();
        let table = match pattern.sizes.last() {
            Some(last) => last.measurements.clone(),
            None => {
                let wearer = self.session.project().body_measurements();
                let mut table = Measurements::new();
                for name in FIRST {
                    if let Some(found) = wearer.measured(name) {
                        // Cannot fail: a table accepts every name and value of another table.
                        let _ =
                            table.set(name, (found.value * 1000.0).round() / 1000.0, found.origin);
                    }
                }
                table
            }
        };
        let planned = plan::add_size(&self.base, None, table);
        self.edit(planned.map(|(edits, _)| edits), "Add size");
    }

    /// Adds a measurement to every size, with the wearer's value; if there is none, with 0.5 (m or rad).
    fn add_measurement(&mut self, name: &str) {
        let wearer = self.session.project().body_measurements();
        let value = wearer.get(name).unwrap_or(0.5);
        let sizes = self.base.pattern().sizes.clone();
        let mut edits = Vec::new();
        for size in &sizes {
            match plan::set_measurement(&self.base, size.id, name, Some(value)) {
                Ok(found) => edits.extend(found),
                Err(error) => {
                    self.edit(Err(error), "Add measurement");
                    return;
                }
            }
        }
        if self.edit(Ok(edits), "Add measurement") {
            self.tables.new_measurement.clear();
            self.tables.entered_measurement = Some(name.to_owned());
        }
    }

    /// The table of variables: a row per variable with name, formula and value.
    fn variable_table(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            let label = ui.label("New variable").id;
            let width = (ui.available_width() - ADD_BUTTON).clamp(220.0, 480.0);
            let text = &mut self.tables.new_variable;
            let response = line_field(ui, label, text, ("ease = 2cm", width));
            let entered = is_entered(ui, &response);
            if ui.button("Add variable").clicked() || entered {
                self.add_variable();
                // The next variable can be typed at once.
                response.request_focus();
            }
        });
        let pattern = self.base.pattern().clone();
        ScrollArea::horizontal()
            .id_salt("variables across")
            .auto_shrink([false, false])
            .show(ui, |ui| self.variable_rows(ui, &pattern));
    }

    /// Shows the column heads, which do not scroll, and the rows below them.
    fn variable_rows(&mut self, ui: &mut Ui, pattern: &Pattern) {
        let heads = Grid::new("variable heads").num_columns(4).show(ui, |ui| {
            let heads = [
                ("", 0.0),
                ("Variable name", NAME),
                ("Number or formula", FORMULA),
                ("Value", 0.0),
            ];
            let heads =
                heads.map(|(head, width)| named(ui, width, RichText::new(head).strong()).id);
            ui.end_row();
            heads
        });
        let rows = ScrollArea::vertical()
            .id_salt("variables")
            .auto_shrink([true, false]);
        rows.show(ui, |ui| {
            self.variable_grid(ui, pattern, heads.inner[1]);
        });
    }

    fn variable_grid(&mut self, ui: &mut Ui, pattern: &Pattern, name_head: Id) {
        let palette = Palette::of(ui.ctx());
        Grid::new("variables")
            .striped(true)
            .num_columns(5)
            .show(ui, |ui| {
                let last = pattern.variables.last().map(|variable| variable.id);
                for variable in &pattern.variables {
                    // For screen readers; sighted users read the name in the field.
                    let unseen = RichText::new(&variable.name).size(1.0);
                    let label = ui.label(unseen.color(Color32::TRANSPARENT)).id;
                    let field = Id::unique(("variable name", variable.id));
                    let name = &variable.name;
                    ui.scope(|ui| {
                        ui.set_width(NAME);
                        let entered = self
                            .typed
                            .field(ui, (field, name_head), name, |_| Ok(String::new()));
                        if let Entered::Text(text) = entered {
                            let planned = plan::rename(&self.base, variable.id.into(), &text);
                            self.enter(planned, "Rename variable", (field, text));
                        }
                    });
                    ui.scope(|ui| {
                        ui.set_width(FORMULA);
                        for entry in plan::numbers_of(&self.base, variable.id.into()) {
                            let is_asked = self.tables.entered_variable == Some(variable.id);
                            if is_asked && has_been_led_to(ui, number_field_id(&entry)) {
                                self.tables.entered_variable = None;
                            }
                            self.number_text_field(ui, &entry, (label, &Beside::default()));
                            let field = number_field_id(&entry);
                            self.typed.show_proposals(ui, field, &self.base);
                        }
                    });
                    let value = self.base.variable(variable.id);
                    let want = match value {
                        Some((_, 1)) => Want::Length,
                        _ if self.base.is_angle(variable.id) => Want::Angle,
                        _ => Want::Plain,
                    };
                    let words = match value {
                        Some((value, _)) => number::show(value, want, pattern.unit),
                        None => "no value".into(),
                    };
                    let value = ui.label(RichText::new(words).color(palette.ink_soft));
                    // Scrolls to a variable that was just added.
                    if Some(variable.id) == last && std::mem::take(&mut self.tables.added) {
                        value.scroll_to_me(None);
                    }
                    if ui.button("Remove").clicked() {
                        let planned = plan::remove_parts(&self.base, &[variable.id.into()]);
                        self.edit(planned, "Remove variable");
                    }
                    ui.end_row();
                }
            });
    }

    /// Adds a variable from a typed text `name = formula`, or from a formula alone. If the name exists, the
    /// formula of that variable is changed.
    fn add_variable(&mut self) {
        let text = self.tables.new_variable.clone();
        let (name, formula) = match text.split_once('=') {
            Some((name, formula)) => (Some(name.trim()), formula),
            None => (None, text.as_str()),
        };
        let known = name.and_then(|name| self.base.pattern().variable_named(name));
        if let Some(known) = known.map(|variable| variable.id) {
            self.set_variable(known, formula);
            return;
        }
        let planned = number::parse(formula, Want::Any, &self.base).and_then(|number| {
            plan::add_variable(&self.base, name, number).map_err(|error| error.to_string())
        });
        match planned {
            Ok((edits, _)) => {
                if self.edit(Ok(edits), "Add variable") {
                    self.tables.new_variable.clear();
                    self.tables.added = true;
                }
            }
            Err(words) => self.say_fault(words),
        }
    }

    fn set_variable(&mut self, id: VariableId, formula: &str) {
        let entries = plan::numbers_of(&self.base, id.into());
        let planned = number::parse(formula, Want::Any, &self.base).and_then(|number| {
            let place = entries.first().map(|entry| &entry.place);
            let place = place.ok_or("the variable has no number")?;
            plan::set_number(&self.base, place, number).map_err(|error| error.to_string())
        });
        match planned {
            Ok(edits) => {
                if self.edit(Ok(edits), "Set variable") {
                    self.tables.new_variable.clear();
                }
            }
            Err(words) => self.say_fault(words),
        }
    }
}

/// Moves the focus to a requested field; returns whether the field has the focus. Waits in a frame in which
/// Enter is pressed: the Enter that made the request would end the typing at once. Waits also in the frame
/// in which a dialog closes: widgets behind it get no focus then.
fn has_been_led_to(ui: &Ui, field: Id) -> bool {
    let is_entered = ui.input(|input| input.key_pressed(egui::Key::Enter));
    let has_keys = !is_entered && ui.memory(|memory| memory.has_focus(field));
    if !has_keys {
        ui.ctx().request_repaint();
    }
    if !has_keys && !is_entered {
        ui.memory_mut(|memory| memory.request_focus(field));
    }
    has_keys
}

/// Shows a label in a column that is at least `width` wide (pixels).
fn named(ui: &mut Ui, width: f32, words: RichText) -> egui::Response {
    let label = ui.scope(|ui| {
        ui.set_min_width(width);
        ui.label(words)
    });
    label.inner
}
