//! The cloth of a marker: fabric, width, plies, price, and any difference from the cloth of the garment.

use super::ToileApp;
use egui::{Color32, ComboBox, DragValue, Id, Label, TextStyle, Ui, vec2};
use toile_pattern::plan;
use toile_pattern::{ClothSettings, FabricId, Marker, MarkerId, MarkerKeeps, OrderedSize};
use toile_session::{Shown, kept_words, other_sizes_words};

/// Widths that differ by less count as equal (m).
const SAME_WIDTH: f64 = 1e-9;
/// Width reserved for a field beside its label (pixels).
const FIELD_ROOM: f32 = 84.0;

impl ToileApp {
    pub(super) fn cloth_fields(&mut self, ui: &mut Ui, marker: &Marker) {
        let mut lies_on = (marker.fabric, marker.keeps_fabric);
        self.fabric_choice(ui, marker, &mut lies_on);
        if lies_on != (marker.fabric, marker.keeps_fabric) {
            self.set_marker_fabric(marker.id, lies_on);
        }
        let mut cloth = marker.cloth.clone();
        self.width_field(ui, marker, &mut cloth);
        let usual = cloth.spread.unwrap_or_default().usual_plies();
        let mut plies = cloth.plies.unwrap_or(usual);
        let label = kept_label(ui, "Plies");
        let field = DragValue::new(&mut plies)
            .range(1..=500)
            .speed(0.05)
            .update_while_editing(false);
        if ui.add(field).labelled_by(label).changed() {
            cloth.plies = Some(plies);
        }
        let mut price = cloth.price_per_metre.unwrap_or(0.0);
        let label = kept_label(ui, "Price per m");
        let field = DragValue::new(&mut price)
            .range(0.0..=10_000.0)
            .speed(0.1)
            .max_decimals(2)
            .update_while_editing(false);
        if ui.add(field).labelled_by(label).changed() {
            cloth.price_per_metre = (price > 0.0).then_some(price);
        }
        if cloth != marker.cloth {
            self.set_marker_cloth(marker.id, cloth);
        }
    }

    fn set_marker_fabric(&mut self, id: MarkerId, lies_on: (FabricId, bool)) {
        let planned = plan::set_marker_fabric(&self.base, id, lies_on);
        self.edit(planned, "Set fabric of marker");
        self.follow_marker();
    }

    pub(super) fn set_marker_cloth(&mut self, id: MarkerId, cloth: ClothSettings) {
        let planned = plan::set_marker_cloth(&self.base, id, cloth);
        self.edit(planned, "Set fabric of marker");
        self.follow_marker();
    }

    /// Shows the choice of the marker's fabric: as the garment, always the marker's own, or another one that
    /// panels are cut from.
    fn fabric_choice(
        &self,
        ui: &mut Ui,
        marker: &Marker,
        (fabric, keeps_fabric): &mut (FabricId, bool),
    ) {
        let pattern = self.base.pattern();
        let garment = self.session.project().garment_cloth();
        let name = |marker: &Marker| {
            let fabric = pattern.marker_fabric(marker, &garment);
            fabric.map_or_else(|| "gone".to_owned(), |fabric| fabric.name)
        };
        let mut following = marker.clone();
        following.keeps_fabric = false;
        let own = pattern.fabric(*fabric).map(|own| own.name.clone());
        let others = self.fabrics_cut(marker.fabric);
        let label = kept_label(ui, "Lies on");
        ComboBox::from_id_salt("marker fabric")
            .selected_text(name(marker))
            .show_ui(ui, |ui| {
                let words = format!("as the garment: {}", name(&following));
                ui.selectable_value(keeps_fabric, false, words);
                if let Some(own) = own {
                    let words = format!("always {own}");
                    ui.selectable_value(keeps_fabric, true, words);
                }
                for (id, name) in others {
                    let words = format!("the pieces of {name}");
                    ui.selectable_value(fabric, id, words);
                }
            })
            .response
            .labelled_by(label);
    }

    /// Fabrics that panels are cut from, without the fabric `but`; the most used first.
    fn fabrics_cut(&self, but: FabricId) -> Vec<(FabricId, String)> {
        let pattern = self.base.pattern();
        let count = |id| pattern.panels.iter().filter(|p| p.fabric == id).count();
        let others = pattern.fabrics.iter().filter(|fabric| fabric.id != but);
        let mut others: Vec<_> = others.filter(|fabric| count(fabric.id) > 0).collect();
        others.sort_by_key(|fabric| std::cmp::Reverse(count(fabric.id)));
        let named = others.into_iter().map(|own| (own.id, own.name.clone()));
        named.collect()
    }

    /// Shows the field for the width of the cloth. A width equal to that of the roll or fabric is not
    /// stored, so that the marker follows it; any other width is the marker's own.
    fn width_field(&self, ui: &mut Ui, marker: &Marker, cloth: &mut ClothSettings) {
        let pattern = self.base.pattern();
        let garment = self.session.project().garment_cloth();
        let width_of = |width: Option<f64>| {
            let mut marker = marker.clone();
            marker.cloth.width = width;
            let fabric = pattern.marker_fabric(&marker, &garment);
            fabric.map_or(1.5, |fabric| fabric.width)
        };
        let unit = pattern.unit;
        let metres = unit.metres();
        let followed = width_of(None);
        let mut width = width_of(cloth.width) / metres;
        let before = width;
        let label = kept_label(ui, "Width");
        let field = DragValue::new(&mut width)
            .range(0.01 / metres..=20.0 / metres)
            .suffix(format!(" {}", unit.sign()))
            .update_while_editing(false);
        ui.add(field).labelled_by(label);
        if width != before {
            let typed = width * metres;
            cloth.width = ((typed - followed).abs() > SAME_WIDTH).then_some(typed);
        }
    }

    /// If the marker on show differs from the garment in cloth or size, or has no pieces: shows the
    /// button that corrects it, and returns a description of the difference.
    pub(super) fn mend_button(&mut self, ui: &mut Ui) -> Option<String> {
        let pattern = self.base.pattern().clone();
        let marker = pattern.marker(self.marker_id()?)?.clone();
        let garment = self.session.project().garment_cloth();
        let mut lies_on = (marker.fabric, marker.keeps_fabric);
        let mut cloth = marker.cloth.clone();
        let (button, words) = match pattern.marker_keeps(&marker, &garment) {
            Some(keeps) => {
                let button = match &keeps {
                    MarkerKeeps::Fabric { garments, .. } => {
                        lies_on.1 = false;
                        format!("Lay on {garments}")
                    }
                    MarkerKeeps::Width { garments, .. } => {
                        cloth.width = None;
                        format!("Take {}", Shown(pattern.unit).length(*garments))
                    }
                };
                let words = kept_words(&pattern, &keeps);
                (button, format!("The marker {words}"))
            }
            None if self.has_pieces_to_lay(&marker) => {
                let words = other_sizes_words(self.session.project(), &marker)?;
                self.order_button(ui, &marker);
                return Some(format!("The marker {words}"));
            }
            None => {
                let (id, name) = self.fabrics_cut(marker.fabric).into_iter().next()?;
                lies_on.0 = id;
                (format!("Lay the pieces of {name}"), String::new())
            }
        };
        if ui.button(button).clicked() {
            match cloth == marker.cloth {
                true => self.set_marker_fabric(marker.id, lies_on),
                false => self.set_marker_cloth(marker.id, cloth),
            }
        }
        Some(words)
    }

    /// Shows the button that orders a garment in the size on show. The order replaces an order of a single
    /// garment; else it is added.
    fn order_button(&mut self, ui: &mut Ui, marker: &Marker) {
        let project = self.session.project();
        let of_size = project.size.as_deref();
        let of_size = of_size.and_then(|name| project.pattern.size_named(name));
        let size = of_size.map(|size| size.id);
        let is_one = matches!(marker.order[..], [OrderedSize { quantity: 1, .. }]);
        let whose = match of_size {
            Some(size) => format!("size {}", size.name),
            None => "the wearer\u{2019}s".to_owned(),
        };
        let words = match is_one {
            true => format!("Order {whose}"),
            false => format!("Order {whose} too"),
        };
        if marker.quantity(size) == 0 && ui.button(words).clicked() {
            let mut order = marker.order.clone();
            if is_one {
                order.clear();
            }
            order.insert(0, OrderedSize { size, quantity: 1 });
            self.set_order(marker.id, order);
        }
    }

    /// Whether a marker gets any piece: from a panel cut from its fabric, or by its order and rules.
    fn has_pieces_to_lay(&self, marker: &Marker) -> bool {
        let pattern = self.base.pattern();
        let mut panels = pattern.panels.iter();
        panels.any(|panel| panel.fabric == marker.fabric)
            || pattern.ordered_pieces(marker).next().is_some()
    }

    /// Reason why a marker has no pieces, and a remedy; `None` if it has pieces.
    pub(super) fn why_marker_is_empty(&self, id: MarkerId) -> Option<String> {
        let pattern = self.base.pattern();
        let marker = pattern.marker(id)?;
        let own = pattern.fabric(marker.fabric)?;
        let words = match () {
            () if pattern.panels.is_empty() => {
                "The pieces are laid here: draw a panel first".to_owned()
            }
            () if marker.order.is_empty() => {
                "No garment is ordered: say above how many of which size are cut".to_owned()
            }
            () if !self.has_pieces_to_lay(marker) => {
                format!("No panel is cut from {}", own.name)
            }
            () if pattern.ordered_pieces(marker).next().is_none() => {
                "The panels are cut no times: say beside the pattern how often each is cut"
                    .to_owned()
            }
            () => return None,
        };
        Some(words)
    }
}

/// Adds a label, on a new line if the line has no room for the label and its field; returns the id of the
/// label.
pub(super) fn kept_label(ui: &mut Ui, words: &str) -> Id {
    let font = TextStyle::Body.resolve(ui.style());
    let galley = ui
        .painter()
        .layout_no_wrap(words.to_owned(), font, Color32::PLACEHOLDER);
    if ui.available_size_before_wrap().x < galley.size().x + FIELD_ROOM {
        ui.end_row();
    }
    // The label is as high as its field, so that both are level at the start of a line.
    let size = vec2(galley.size().x, ui.spacing().interact_size.y);
    ui.add_sized(size, Label::new(words)).id
}
