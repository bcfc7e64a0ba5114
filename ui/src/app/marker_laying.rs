//! Laying of the fabric of a marker: margins, gap, nap, spread, tilt, print, and its rolls.

use super::ToileApp;
use super::marker_cloth::kept_label;
use crate::fields::{Beside, Entered};
use crate::tools::number;
use egui::{Align, ComboBox, Id, Layout, Ui, vec2};
use toile_pattern::plan;
use toile_pattern::{
    ClothSettings, DEFAULT_GAP, DEFAULT_SELVEDGE, Marker, NapRule, Print, Roll, Spread, Want,
};

/// Width of a field (pixels).
const FIELD: f32 = 84.0;
/// Length of a roll that is added (m).
const NEW_ROLL: f64 = 5.0;

/// Hint in a number field that is empty.
pub(super) enum Empty {
    /// The default number: a length (m) or an angle (rad).
    Means(f64),
    /// The default, in words.
    Words(&'static str),
}

impl ToileApp {
    /// Shows the list of rolls; on request also the fields for how the fabric is laid, and the rules for
    /// pieces.
    pub(super) fn laying_rows(&mut self, ui: &mut Ui) {
        let pattern = self.base.pattern().clone();
        let Some(marker) = self.marker_id().and_then(|id| pattern.marker(id).cloned()) else {
            return;
        };
        if self.marker_view.shows_laying {
            ui.horizontal_wrapped(|ui| self.laying_fields(ui, &marker));
        }
        let rolls = marker.cloth.rolls.as_ref().map_or(0, Vec::len);
        if self.marker_view.shows_laying || rolls > 1 {
            ui.horizontal_wrapped(|ui| self.roll_fields(ui, &marker));
        }
        if self.marker_view.shows_laying {
            ui.horizontal_wrapped(|ui| self.rule_fields(ui, &marker));
        }
    }

    fn laying_fields(&mut self, ui: &mut Ui, marker: &Marker) {
        let before = &marker.cloth;
        let mut cloth = before.clone();
        let usual_nap = match self.base.pattern().fabric(marker.fabric) {
            Some(fabric) if fabric.nap => "as the fabric: one way",
            _ => "as the fabric: either way",
        };
        let mut field = |ui: &mut Ui, words: &str, want, empty, value: &mut Option<f64>| {
            let id = Id::unique(("marker", marker.id, words));
            self.given_field(ui, (words, id), (want, empty), value);
        };
        let any_length = Empty::Words("as needed");
        field(
            ui,
            "Length at hand",
            Want::Length,
            any_length,
            &mut cloth.length,
        );
        let selvedge = Empty::Means(DEFAULT_SELVEDGE);
        field(ui, "Selvedge", Want::Length, selvedge, &mut cloth.selvedge);
        field(
            ui,
            "Ends",
            Want::Length,
            Empty::Means(0.0),
            &mut cloth.end_margin,
        );
        field(
            ui,
            "Gap",
            Want::Length,
            Empty::Means(DEFAULT_GAP),
            &mut cloth.gap,
        );
        field(ui, "Tilt", Want::Angle, Empty::Means(0.0), &mut cloth.tilt);
        let mut print = cloth.print.unwrap_or_default();
        let repeats = ["Repeat along", "Repeat across"];
        for (words, repeat) in repeats.into_iter().zip(&mut print.repeat) {
            let mut given = Some(*repeat).filter(|repeat| *repeat > 0.0);
            field(ui, words, Want::Length, Empty::Words("none"), &mut given);
            *repeat = given.unwrap_or(0.0);
        }
        if print != cloth.print.unwrap_or_default() {
            cloth.print = Some(print).filter(|print| *print != Print::default());
        }
        let naps = [
            (None, usual_nap),
            (Some(NapRule::None), "either way"),
            (Some(NapRule::OneWay), "all one way"),
            (Some(NapRule::PerGarment), "each garment one way"),
        ];
        list(ui, "Nap", &naps, &mut cloth.nap);
        let spreads = [
            (Spread::Open, "open"),
            (Spread::Folded, "folded in two"),
            (Spread::Tubular, "a tube"),
            (Spread::FaceToFace, "face to face"),
        ];
        let mut spread = cloth.spread.unwrap_or_default();
        list(ui, "Spread", &spreads, &mut spread);
        if spread != before.spread.unwrap_or_default() {
            cloth.spread = Some(spread);
            cloth.plies = cloth.plies.filter(|plies| spread.allows(*plies));
        }
        if cloth != *before {
            self.set_marker_cloth(marker.id, cloth);
        }
    }

    /// Shows the choice of the roll, and the fields of the chosen one.
    fn roll_fields(&mut self, ui: &mut Ui, marker: &Marker) {
        let rolls = marker.cloth.rolls.clone().unwrap_or_default();
        ui.label("Rolls");
        if rolls.is_empty() {
            ui.label("none: as much fabric as it takes");
        }
        let before = self.marker_view.roll;
        for (k, roll) in rolls.iter().enumerate() {
            ui.selectable_value(&mut self.marker_view.roll, k, roll_name(roll, k));
        }
        if self.marker_view.roll != before {
            self.marker_view.selection.clear();
            self.marker_view.fit();
            self.follow_marker();
        }
        if !self.marker_view.shows_laying {
            return;
        }
        let number = self.marker_view.roll;
        if let Some(before) = rolls.get(number) {
            let mut roll = before.clone();
            self.roll_name_field(ui, (marker, number), &mut roll);
            let id = |words: &str| Id::unique(("roll", marker.id, number, words));
            let (length, width) = ("Roll length", "Roll width");
            let as_needed = (Want::Length, Empty::Words("as needed"));
            self.given_field(ui, (length, id(length)), as_needed, &mut roll.length);
            let of_fabric = (Want::Length, Empty::Words("the fabric\u{2019}s"));
            self.given_field(ui, (width, id(width)), of_fabric, &mut roll.width);
            if roll != *before {
                let mut rolls = rolls.clone();
                rolls[number] = roll;
                self.set_rolls(marker, rolls, "Set roll");
            }
        }
        if ui.button("Add roll").clicked() {
            let mut rolls = rolls.clone();
            rolls.push(Roll {
                length: Some(NEW_ROLL),
                ..Roll::default()
            });
            self.marker_view.roll = rolls.len() - 1;
            self.set_rolls(marker, rolls, "Add roll");
        }
        let remove = ui.add_enabled(number < rolls.len(), egui::Button::new("Remove roll"));
        if remove.clicked() {
            let planned = plan::remove_marker_roll(&self.base, marker.id, number);
            self.edit(planned, "Remove roll");
            self.marker_view.roll = number.saturating_sub(1);
            self.follow_marker();
        }
    }

    fn roll_name_field(
        &mut self,
        ui: &mut Ui,
        (marker, number): (&Marker, usize),
        roll: &mut Roll,
    ) {
        let label = kept_label(ui, "Roll called");
        let id = Id::unique(("roll", marker.id, number, "name"));
        let shown = roll.name.clone().unwrap_or_default();
        let entered = field_of(ui, |ui| {
            let nothing = |_: &str| Ok(String::new());
            self.typed.field(ui, (id, label), &shown, nothing)
        });
        if let Entered::Text(text) = entered {
            roll.name = Some(text).filter(|text| !text.is_empty());
        }
    }

    fn set_rolls(&mut self, marker: &Marker, rolls: Vec<Roll>, label: &str) {
        let cloth = ClothSettings {
            rolls: Some(rolls),
            ..marker.cloth.clone()
        };
        let planned = plan::set_marker_cloth(&self.base, marker.id, cloth);
        self.edit(planned, label);
        self.follow_marker();
    }

    /// Shows a number field that can be left empty. A typed number is stored, even if it equals the default.
    pub(super) fn given_field(
        &mut self,
        ui: &mut Ui,
        (words, id): (&str, Id),
        (want, empty): (Want, Empty),
        value: &mut Option<f64>,
    ) {
        let base = self.base.clone();
        let unit = base.pattern().unit;
        let show = |number: f64| number::show(number, want, unit);
        let shown = value.map_or_else(String::new, show);
        let beside = Beside {
            hint: match empty {
                Empty::Means(number) => show(number),
                Empty::Words(words) => words.to_owned(),
            },
            ..Beside::default()
        };
        let read = |text: &str| {
            if text.trim().is_empty() {
                return Ok(None);
            }
            let found = number::parse(text, want, &base)?;
            match base.number_or_fault(&found, want)? {
                number if number >= 0.0 => Ok(Some(number)),
                _ => Err("give 0 or more".to_owned()),
            }
        };
        let label = kept_label(ui, words);
        let entered = field_of(ui, |ui| {
            let told = |text: &str| read(text).map(|_| String::new());
            self.typed
                .number_field(ui, (id, label), (&shown, &beside), told)
        });
        if let Entered::Text(text) = entered {
            match read(&text) {
                Ok(number) => *value = number,
                Err(fault) => self.typed.refuse(id, text, fault),
            }
        }
    }
}

/// Name of the roll with a number (from 0); a roll without a name of its own is called `roll 1` and so on.
fn roll_name(roll: &Roll, number: usize) -> String {
    let name = roll.name.clone();
    name.unwrap_or_else(|| format!("roll {}", number + 1))
}

/// Places a text field of the usual width.
fn field_of(ui: &mut Ui, show: impl FnOnce(&mut Ui) -> Entered) -> Entered {
    let size = vec2(FIELD, ui.spacing().interact_size.y);
    let layout = Layout::left_to_right(Align::Center);
    ui.allocate_ui_with_layout(size, layout, show).inner
}

/// A drop-down list beside its label.
fn list<T: Copy + PartialEq>(ui: &mut Ui, words: &str, all: &[(T, &str)], value: &mut T) {
    let label = kept_label(ui, words);
    let shown = all.iter().find(|known| known.0 == *value);
    ComboBox::from_id_salt(words)
        .selected_text(shown.map_or("", |known| known.1))
        .show_ui(ui, |ui| {
            for (one, words) in all {
                ui.selectable_value(value, *one, *words);
            }
        })
        .response
        .labelled_by(label);
}
