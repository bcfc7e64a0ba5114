//! Garments worn over and under this one: layers in visible order, the outermost first.

use super::worn_where::WornWhere;
use crate::app::ToileApp;
use crate::app::tool_commands::{WEAR_OVER, WEAR_UNDER};
use crate::fields::Entered;
use crate::theme::Palette;
use egui::{Button, Color32, Grid, Id, RichText, Role, ScrollArea, Ui, WidgetInfo};
use std::path::Path;
use toile_session::{Command, OtherGarment};

/// Width of the field for a layer number (pixels).
const NUMBER: f32 = 60.0;
/// Largest layer number.
const MOST: u16 = 999;

/// A garment that is worn.
struct Worn {
    /// Index of the garment among the other garments; `None` for the garment of this document.
    other: Option<usize>,
    name: String,
    layer: u16,
    /// File name.
    file: String,
    is_missing: bool,
}

impl ToileApp {
    pub(super) fn worn_with_table(&mut self, ui: &mut Ui) {
        let worn = self.worn();
        let own = self.session.project().layer;
        ui.horizontal(|ui| {
            self.command_button(ui, &WEAR_OVER);
            self.command_button(ui, &WEAR_UNDER);
            let words = match worn.len() {
                1 => "The garment is worn alone.",
                _ => {
                    "As they are seen, the outermost first. Garments of one number are in no order."
                }
            };
            ui.label(RichText::new(words).color(Palette::of(ui.ctx()).ink_soft));
        });
        let area = ScrollArea::both()
            .id_salt("worn with")
            .auto_shrink([false, false]);
        area.show(ui, |ui| {
            Grid::new("worn with").striped(true).show(ui, |ui| {
                for head in ["Layer", "What is worn", "", "From"] {
                    ui.label(RichText::new(head).strong());
                }
                ui.end_row();
                for one in &worn {
                    self.worn_row(ui, one, own);
                    ui.end_row();
                }
            });
        });
    }

    /// All garments that are worn, the outermost first.
    fn worn(&self) -> Vec<Worn> {
        let project = self.session.project();
        let mut worn = vec![Worn {
            other: None,
            name: project.pattern.name.clone(),
            layer: project.layer,
            file: String::new(),
            is_missing: false,
        }];
        worn.extend(project.others.iter().enumerate().map(|(k, other)| Worn {
            other: Some(k),
            name:
                match &other.pattern {
                    Some(pattern) => pattern.name.clone(),
                    None => {
                        other.source.file_name().map_or_else(
                            || other.name(),
                            |name| name.to_string_lossy().into_owned(),
                        )
                    }
                },
            layer: other.layer,
            file: other.source.display().to_string(),
            is_missing: other.pattern.is_none(),
        }));
        worn.sort_by_key(|one| std::cmp::Reverse(one.layer));
        worn
    }

    fn worn_row(&mut self, ui: &mut Ui, one: &Worn, own: u16) {
        let palette = Palette::of(ui.ctx());
        let id = Id::unique(("layer", one.other));
        let mut chosen = None;
        ui.horizontal(|ui| {
            // For screen readers; sighted users read the head of the column.
            let unseen = RichText::new(format!("Layer of {}", one.name)).size(1.0);
            let label = ui.label(unseen.color(Color32::TRANSPARENT)).id;
            ui.set_width(NUMBER);
            let shown = one.layer.to_string();
            let entered = self.typed.field(ui, (id, label), &shown, |text| {
                layer_number(text).map(|_| String::new())
            });
            if let Entered::Text(text) = entered {
                match layer_number(&text) {
                    Ok(layer) => chosen = Some(layer),
                    Err(fault) => self.typed.refuse(id, text, fault),
                }
            }
        });
        let name = RichText::new(&one.name);
        ui.label(match one.other {
            None => name.strong(),
            Some(_) => name,
        });
        ui.label(match one.other {
            None => RichText::new("this garment").color(palette.ink_soft),
            Some(_) if one.is_missing => {
                RichText::new("left off: its file cannot be read").color(palette.fault)
            }
            Some(_) => RichText::new(match one.layer.cmp(&own) {
                std::cmp::Ordering::Greater => "worn over it",
                std::cmp::Ordering::Less => "worn under it",
                std::cmp::Ordering::Equal => "in no order with it",
            }),
        });
        ui.label(RichText::new(&one.file).color(palette.ink_soft));
        let mut is_taken_off = false;
        if one.other.is_some() {
            let words = format!("Take off {}", one.name);
            let button = ui.add(Button::new("Take off"));
            button.widget_info(|| WidgetInfo::labeled(Role::Button, true, &words));
            is_taken_off = button.clicked();
        }
        let (mut layer, mut others) = self.layers();
        match (one.other, chosen) {
            // Another row may have removed a garment in this frame.
            (Some(k), _) if others.len() <= k => return,
            (Some(k), _) if is_taken_off => {
                others.remove(k);
            }
            (Some(k), Some(number)) => others[k].layer = number,
            (None, Some(number)) => layer = number,
            (_, None) => return,
        }
        self.execute(Command::SetLayers { layer, others });
    }

    /// The layer of this garment, and the other garments.
    fn layers(&self) -> (u16, Vec<OtherGarment>) {
        let project = self.session.project();
        let others = project.others.iter().map(|worn| OtherGarment {
            path: worn.source.clone(),
            layer: worn.layer,
        });
        (project.layer, others.collect())
    }

    /// Adds the garment of a pattern file over all other garments, or under all others.
    pub(crate) fn wear(&mut self, path: &Path, place: WornWhere) {
        let (mut own, mut others) = self.layers();
        let all = || others.iter().map(|other| other.layer).chain([own]);
        let layer = match place {
            WornWhere::Over => (all().max().unwrap_or_default() + 1).min(MOST),
            WornWhere::Under => match all().min().unwrap_or_default() {
                0 => {
                    // Layer 0 is taken: so all garments move one layer outward.
                    others
                        .iter_mut()
                        .for_each(|o| o.layer = (o.layer + 1).min(MOST));
                    own = (own + 1).min(MOST);
                    0
                }
                lowest => lowest - 1,
            },
        };
        others.push(OtherGarment {
            path: path.to_owned(),
            layer,
        });
        self.execute(Command::SetLayers { layer: own, others });
    }
}

/// Reads a layer number.
fn layer_number(text: &str) -> Result<u16, String> {
    let number = text.trim().parse().ok().filter(|&layer| layer <= MOST);
    number.ok_or_else(|| format!("a layer is a number from 0 to {MOST}"))
}
