//! The table of fabrics: what the garment is cut from, and the figures of each fabric of the pattern and of the
//! library.

use super::fabric_words::{colour_text, read_colour, shares};
use crate::app::ToileApp;
use crate::fields::Entered;
use crate::theme::{Palette, bytes};
use crate::tools::number;
use egui::{Align, Color32, ComboBox, Id, Layout, Popup, RichText, ScrollArea, Sense, Ui, vec2};
use toile_fabric::{LIBRARY, LibraryFabric};
use toile_pattern::plan::{self, FabricFigure};
use toile_pattern::{Edit, EditError, Entity, Fabric, FabricId, PanelId, Want};
use toile_session::{Command, FabricChoice, library_fabric, with_hardening};

/// Width of the list of fabrics (pixels).
const LIST: f32 = 190.0;
/// Width of a text field (pixels).
const FIELD: f32 = 84.0;
/// Height of a line (pixels).
const LINE: f32 = 22.0;
/// Gap between two lines (pixels).
const LINE_GAP: f32 = 3.0;
/// Width of the part with the figures that a marker uses (pixels).
const MARKER_PART: f32 = 300.0;
/// Largest number of figures in a column.
const ROWS: usize = 6;
/// Height of the drop-down list of the fabrics that the garment can be cut from (pixels).
const CHOICES: f32 = 480.0;
/// Side of the small square in the colour of a fabric (pixels).
const SWATCH: f32 = 12.0;
/// Least and largest width of a roll that can be typed (m).
const WIDTHS: [f64; 2] = [0.05, 20.0];

/// Fabric that the table shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Viewed {
    /// A fabric of the pattern.
    Own(FabricId),
    /// A fabric of the library, by its name.
    Library(&'static str),
    /// The fabric of a file that the garment is cut from.
    File,
}

/// State of the table of fabrics that is kept between frames.
#[derive(Default)]
pub struct FabricTable {
    /// The fabric on show; with `None` the fabric that the garment, or else its first panel, is cut from.
    viewed: Option<Viewed>,
    /// The fabric that the list was last scrolled to.
    scrolled_to: Option<Viewed>,
    /// A colour that is being picked, and the fabric it is for.
    colour: Option<(FabricId, [u8; 3])>,
}

impl ToileApp {
    pub(super) fn fabric_table(&mut self, ui: &mut Ui) {
        let spacing = ui.spacing_mut();
        spacing.item_spacing.y = LINE_GAP;
        spacing.interact_size.y = LINE;
        spacing.button_padding.y = 1.0;
        ui.horizontal_wrapped(|ui| {
            self.cut_choice(ui);
            self.roll_width(ui);
            if ui.button("New fabric").clicked() {
                let mut fabric = Fabric::poplin(FabricId(0));
                fabric.name = "fabric".into();
                self.add_fabric(fabric, "Add fabric");
            }
        });
        ui.separator();
        let viewed = self.viewed_fabric();
        let height = ui.available_height();
        ui.horizontal_top(|ui| {
            ui.allocate_ui_with_layout(vec2(LIST, height), Layout::top_down(Align::Min), |ui| {
                ui.set_width(LIST);
                self.fabric_list(ui, viewed);
            });
            ui.separator();
            if let Some((viewed, fabric)) = viewed.and_then(|v| Some((v, self.fabric_on_show(v)?)))
            {
                ScrollArea::both()
                    .id_salt("fabric figures")
                    .auto_shrink([false, false])
                    .show(ui, |ui| {
                        ui.vertical(|ui| self.fabric_page(ui, viewed, &fabric))
                    });
            }
        });
    }

    /// Shows the choice of the fabric that the whole garment is cut from.
    fn cut_choice(&mut self, ui: &mut Ui) {
        let chosen = self.session.project().fabric.clone();
        let each = "each panel's own fabric";
        let shown = match &chosen {
            None => each,
            Some(choice) => choice.name(),
        };
        let is_named =
            |name: &str| matches!(&chosen, Some(FabricChoice::Named(own)) if own == name);
        let mut wished: Option<Option<String>> = None;
        let mut asks_file = false;
        let label = ui.label("Garment cut from").id;
        let pattern = self.base.pattern();
        let list = ComboBox::from_id_salt("garment cut from")
            .selected_text(shown)
            .width(LIST)
            .height(CHOICES)
            .show_ui(ui, |ui| {
                if ui.selectable_label(chosen.is_none(), each).clicked() {
                    wished = Some(None);
                }
                for fabric in &pattern.fabrics {
                    let words = format!("{} of the pattern", fabric.name);
                    if ui.selectable_label(is_named(&fabric.name), words).clicked() {
                        wished = Some(Some(fabric.name.clone()));
                    }
                }
                let is_file = matches!(chosen, Some(FabricChoice::File { .. }));
                asks_file = ui
                    .selectable_label(is_file, "a fabric file\u{2026}")
                    .clicked();
                let is_own = |name| pattern.fabrics.iter().any(|own| own.name == name);
                for library in LIBRARY.iter().filter(|library| !is_own(library.name)) {
                    let words = format!("{}: {}", library.name, library.about);
                    if ui.selectable_label(is_named(library.name), words).clicked() {
                        wished = Some(Some(library.name.to_owned()));
                    }
                }
            });
        list.response.labelled_by(label);
        let is_chosen = |wished: &Option<String>| match wished {
            Some(name) => is_named(name),
            None => chosen.is_none(),
        };
        if let Some(fabric) = wished.filter(|wished| !is_chosen(wished)) {
            self.execute(Command::SetFabric { fabric });
            self.tables.fabric.viewed = None;
        }
        if asks_file {
            self.ask_fabric_file();
        }
    }

    /// Shows the field for the width of the roll; empty if it is the fabric's own width.
    fn roll_width(&mut self, ui: &mut Ui) {
        let base = self.base.clone();
        let unit = base.pattern().unit;
        let width = self.session.project().width;
        let shown = width.map_or_else(String::new, |w| number::show(w, Want::Length, unit));
        let read = |text: &str| {
            if text.trim().is_empty() {
                return Ok(None);
            }
            let found = number::parse(text, Want::Length, &base)?;
            let width = base.number_or_fault(&found, Want::Length)?;
            let [least, most] = WIDTHS;
            match (least..=most).contains(&width) {
                true => Ok(Some(width)),
                false => Err(format!("give {} cm to {most} m", least * 100.0)),
            }
        };
        let label = ui
            .label("Roll width")
            .on_hover_text("Empty: the fabric's own")
            .id;
        let id = Id::unique("roll width");
        let entered = field(ui, |ui| {
            self.typed.field(ui, (id, label), &shown, |text| {
                read(text).map(|_| String::new())
            })
        });
        if let Entered::Text(text) = entered {
            match read(&text) {
                Ok(width) => {
                    self.execute(Command::SetWidth { width });
                }
                Err(fault) => self.typed.refuse(id, text, fault),
            }
        }
    }

    /// Shows the list of fabrics: those of the pattern, the one of a chosen file, and those of the library.
    fn fabric_list(&mut self, ui: &mut Ui, viewed: Option<Viewed>) {
        let pattern = self.base.pattern().clone();
        let mut clicked = None;
        let is_new = viewed != self.tables.fabric.scrolled_to;
        self.tables.fabric.scrolled_to = viewed;
        let mut row = |ui: &mut Ui, one: Viewed, (name, colour): (&str, [f64; 3])| {
            ui.horizontal(|ui| {
                swatch(ui, colour);
                let is_viewed = viewed == Some(one);
                let label = ui.selectable_label(is_viewed, name);
                if is_viewed && is_new {
                    label.scroll_to_me(Some(Align::Center));
                }
                if label.clicked() {
                    clicked = Some(one);
                }
            });
        };
        ScrollArea::vertical()
            .id_salt("fabrics")
            .auto_shrink([false, false])
            .show(ui, |ui| {
                ui.label(RichText::new("Of the pattern").strong());
                for fabric in &pattern.fabrics {
                    row(ui, Viewed::Own(fabric.id), (&fabric.name, fabric.colour));
                }
                if let Some(fabric) = self.fabric_on_show(Viewed::File) {
                    ui.label(RichText::new("Of a file").strong());
                    row(ui, Viewed::File, (&fabric.name, fabric.colour));
                }
                ui.label(RichText::new("Of the library").strong());
                for library in &LIBRARY {
                    let name = format!("{} (library)", library.name);
                    let colour = library_fabric(library.name).map_or([0.7; 3], |f| f.colour);
                    row(ui, Viewed::Library(library.name), (&name, colour));
                }
            });
        if clicked.is_some() {
            self.tables.fabric.viewed = clicked;
        }
    }

    /// The fabric that the whole garment is cut from; `None` if none was chosen, so that each panel has its
    /// own.
    fn fabric_of_garment(&self) -> Option<Viewed> {
        let pattern = self.base.pattern();
        match self.session.project().fabric.as_ref()? {
            FabricChoice::File { .. } => Some(Viewed::File),
            FabricChoice::Named(name) => {
                match pattern.fabrics.iter().find(|own| own.name == *name) {
                    Some(own) => Some(Viewed::Own(own.id)),
                    None => LibraryFabric::named(name).map(|library| Viewed::Library(library.name)),
                }
            }
        }
    }

    /// The fabric on show; if it does not exist any more, the one the garment is cut from, or else the
    /// first.
    fn viewed_fabric(&self) -> Option<Viewed> {
        let pattern = self.base.pattern();
        let is_there = |viewed: &Viewed| self.fabric_on_show(*viewed).is_some();
        let chosen = match self.session.project().fabric {
            Some(_) => self.fabric_of_garment(),
            None => pattern
                .panels
                .first()
                .map(|panel| Viewed::Own(panel.fabric)),
        };
        let first = pattern.fabrics.first().map(|own| Viewed::Own(own.id));
        let kept = self.tables.fabric.viewed.filter(is_there);
        kept.or(chosen.filter(is_there)).or(first)
    }

    fn fabric_on_show(&self, viewed: Viewed) -> Option<Fabric> {
        match viewed {
            Viewed::Own(id) => Some((**self.base.pattern().fabric(id)?).clone()),
            Viewed::Library(name) => library_fabric(name),
            Viewed::File => self.session.project().fabric.as_ref()?.of_file().cloned(),
        }
    }

    /// Shows the name of a fabric, the commands for it, and its figures.
    fn fabric_page(&mut self, ui: &mut Ui, viewed: Viewed, fabric: &Fabric) {
        ui.horizontal(|ui| match viewed {
            Viewed::Own(_) => self.own_fabric_head(ui, fabric),
            Viewed::Library(_) | Viewed::File => {
                let about = match viewed {
                    Viewed::Library(name) => LibraryFabric::named(name).map_or("", |l| l.about),
                    _ => "of a file",
                };
                swatch(ui, fabric.colour);
                ui.label(RichText::new(&fabric.name).strong());
                ui.label(about);
                if ui
                    .button("Copy into the pattern")
                    .on_hover_text(
                        "To give it other figures or a colour, or to cut single panels from it",
                    )
                    .clicked()
                {
                    self.add_fabric(fabric.clone(), "Copy fabric");
                }
            }
        });
        ui.horizontal_top(|ui| {
            ui.vertical(|ui| {
                ui.set_width(MARKER_PART);
                ui.label(RichText::new("A marker takes").strong());
                self.figure_rows(ui, (viewed, fabric), &[FabricFigure::Width]);
                self.nap_choice(ui, viewed, fabric);
                self.cut_panels(ui, viewed, fabric);
            });
            ui.vertical(|ui| {
                ui.label(RichText::new("The drape takes").strong());
                let numbers = FabricFigure::all().filter(|figure| *figure != FabricFigure::Width);
                let (usual, rare): (Vec<_>, Vec<_>) = numbers.partition(|f| f.is_usual());
                ui.horizontal_top(|ui| {
                    for column in usual.chunks(ROWS) {
                        self.figure_rows(ui, (viewed, fabric), column);
                    }
                });
                ui.label(RichText::new("Rarely given").strong());
                ui.horizontal_top(|ui| {
                    let mut columns = rare.chunks(ROWS).peekable();
                    while let Some(column) = columns.next() {
                        ui.vertical(|ui| {
                            self.figure_rows(ui, (viewed, fabric), column);
                            if columns.peek().is_none() {
                                self.compression_choice(ui, viewed, fabric);
                            }
                        });
                    }
                });
            });
        });
    }

    /// Shows name, colour and buttons to copy and remove, for a fabric of the pattern.
    fn own_fabric_head(&mut self, ui: &mut Ui, fabric: &Fabric) {
        let label = ui.label("Fabric name").id;
        let id = Id::unique(("fabric name", fabric.id));
        let entered = field(ui, |ui| {
            self.typed
                .field(ui, (id, label), &fabric.name, |_| Ok(String::new()))
        });
        if let Entered::Text(text) = entered {
            // Only the name changes. The library gives a fabric hardening by its name: this hardening is
            // stored in the fabric, because under the new name the library would not give it.
            let kept = with_hardening(fabric);
            let planned = plan::rename(&self.base, fabric.id.into(), &text).map(|mut edits| {
                for edit in &mut edits {
                    if let Edit::Put(Entity::Fabric(renamed)) = edit {
                        std::sync::Arc::make_mut(renamed).material = kept.material.clone();
                    }
                }
                edits
            });
            self.enter(planned, "Rename fabric", (id, text));
        }
        self.colour_choice(ui, fabric);
        if ui.button("Copy fabric").clicked() {
            self.add_fabric(with_hardening(fabric), "Copy fabric");
        }
        if ui.button("Remove fabric").clicked() {
            let is_chosen = matches!(&self.session.project().fabric, Some(FabricChoice::Named(name)) if *name == fabric.name);
            match is_chosen {
                true => self.say_fault(format!(
                    "the garment is cut from fabric {:?}: choose another first",
                    fabric.name
                )),
                false => {
                    self.edit(plan::remove_fabric(&self.base, fabric.id), "Remove fabric");
                }
            }
        }
    }

    /// Shows the choice of a fabric's colour, which is picked or typed.
    fn colour_choice(&mut self, ui: &mut Ui, fabric: &Fabric) {
        let picked = self.tables.fabric.colour.filter(|(id, _)| *id == fabric.id);
        let before = picked.map_or(bytes(fabric.colour), |(_, colour)| colour);
        let mut colour = before;
        ui.color_edit_button_srgb(&mut colour);
        if colour != before {
            self.tables.fabric.colour = Some((fabric.id, colour));
        }
        let label = ui.label("Colour").id;
        let id = Id::unique(("fabric colour", fabric.id));
        let shown = colour_text(fabric.colour);
        let entered = field(ui, |ui| {
            self.typed.field(ui, (id, label), &shown, |text| {
                read_colour(text).map(|_| String::new())
            })
        });
        if let Entered::Text(text) = entered {
            match read_colour(&text) {
                Ok(colour) => self.colour_fabric(fabric.id, colour),
                Err(fault) => self.typed.refuse(id, text, fault),
            }
        }
    }

    /// Applies a picked colour once the picking has ended, as one step of the history.
    pub(crate) fn take_picked_colour(&mut self, context: &egui::Context) {
        let is_picking =
            Popup::is_any_open(context) || context.input(|input| input.pointer.any_down());
        if is_picking {
            return;
        }
        if let Some((id, colour)) = self.tables.fabric.colour.take() {
            self.colour_fabric(id, shares(colour));
        }
    }

    fn colour_fabric(&mut self, id: FabricId, colour: [f64; 3]) {
        let Some(fabric) = self.base.pattern().fabric(id) else {
            return;
        };
        let changed = Fabric {
            colour,
            ..(**fabric).clone()
        };
        self.edit(plan::set_fabric(&self.base, changed), "Colour fabric");
    }

    /// Shows the check box for a nap, with which all pieces must point one way.
    fn nap_choice(&mut self, ui: &mut Ui, viewed: Viewed, fabric: &Fabric) {
        let mut nap = fabric.nap;
        let is_own = matches!(viewed, Viewed::Own(_));
        let words = "Nap: all pieces point one way";
        let ticked = ui.add_enabled(is_own, egui::Checkbox::new(&mut nap, words));
        if ticked.changed() {
            let changed = Fabric {
                nap,
                ..fabric.clone()
            };
            self.edit(plan::set_fabric(&self.base, changed), "Change nap");
        }
    }

    /// Shows the panels, each ticked if it is cut from the fabric. A tick cuts the panel from the fabric.
    fn cut_panels(&mut self, ui: &mut Ui, viewed: Viewed, fabric: &Fabric) {
        let pattern = self.base.pattern().clone();
        if pattern.panels.is_empty() || viewed == Viewed::File {
            return;
        }
        ui.label(RichText::new("Panels cut from it").strong());
        if let Some(choice) = self.session.project().fabric.as_ref() {
            let words = format!("The whole garment is cut from {} now", choice.name());
            ui.label(RichText::new(words).color(Palette::of(ui.ctx()).ink_soft));
        }
        let is_whole = self.fabric_of_garment() == Some(viewed);
        let mut wished = None;
        ui.horizontal_wrapped(|ui| {
            for panel in &pattern.panels {
                let is_cut = is_whole || viewed == Viewed::Own(panel.fabric);
                let mut ticked = is_cut;
                let tick = egui::Checkbox::new(&mut ticked, &panel.name);
                ui.add_enabled(!is_cut, tick);
                if ticked && !is_cut {
                    wished = Some(panel.id);
                }
            }
        });
        if let Some(panel) = wished {
            let planned = self.cut_from(panel, viewed, fabric);
            self.edit(planned, "Cut panel from fabric");
        }
    }

    /// The edits that cut a panel from a fabric; a fabric that is not the pattern's own is copied into the
    /// pattern.
    fn cut_from(
        &self,
        panel: PanelId,
        viewed: Viewed,
        fabric: &Fabric,
    ) -> Result<Vec<Edit>, EditError> {
        let pattern = self.base.pattern();
        let copied = pattern.fabrics.iter().find(|own| own.name == fabric.name);
        let (mut edits, id) = match (viewed, copied) {
            (Viewed::Own(id), _) => (Vec::new(), id),
            (_, Some(own)) if is_same_cloth(own, fabric) => (Vec::new(), own.id),
            _ => plan::add_fabric(&self.base, fabric.clone())?,
        };
        edits.extend(self.changed_panel(panel, |panel| panel.fabric = id)?);
        Ok(edits)
    }

    /// Adds a fabric to the pattern, and shows the fabric in the table.
    fn add_fabric(&mut self, fabric: Fabric, label: &str) {
        let planned = plan::add_fabric(&self.base, fabric);
        let id = planned.as_ref().ok().map(|(_, id)| *id);
        if self.edit(planned.map(|(edits, _)| edits), label) {
            self.tables.fabric.viewed = id.map(Viewed::Own);
        }
    }
}

/// Whether all figures of two fabrics are the same.
fn is_same_cloth(a: &Fabric, b: &Fabric) -> bool {
    let [a, b] = [a, b].map(with_hardening);
    a.material == b.material && a.width == b.width
}

/// Shows a text field of the usual width.
pub(super) fn field(ui: &mut Ui, show: impl FnOnce(&mut Ui) -> Entered) -> Entered {
    let shown = ui.scope(|ui| {
        ui.set_width(FIELD);
        ui.vertical(show).inner
    });
    shown.inner
}

/// Paints a small square of a colour.
fn swatch(ui: &mut Ui, colour: [f64; 3]) {
    let [red, green, blue] = bytes(colour);
    let (rect, _) = ui.allocate_exact_size(vec2(SWATCH, SWATCH), Sense::hover());
    let fill = Color32::from_rgb(red, green, blue);
    ui.painter().rect_filled(rect, 2.0, fill);
}
