//! The inspector for several selected parts: numbers they have in common are edited together.

use super::arcs::{kept, numbers_of};
use crate::app::ToileApp;
use crate::canvas::selection::Item;
use crate::fields::{Beside, Entered, labelled};
use crate::theme::{self, Palette};
use crate::tools::{Planning, number};
use egui::{RichText, Ui};
use toile_pattern::plan::{self, NumberEntry};
use toile_pattern::{EdgeId, EditError, PanelId, Want};

impl ToileApp {
    pub(crate) fn inspect_several(&mut self, ui: &mut Ui, items: &[Item]) {
        theme::title(ui, &format!("{} {} selected", items.len(), kind_of(items)));
        let soft = Palette::of(ui.ctx()).ink_soft;
        for words in self.measured_together(items) {
            ui.label(RichText::new(words).color(soft));
        }
        for entries in self.common_numbers(items) {
            self.common_field(ui, &entries);
        }
    }

    /// Measurements of several parts in words: total length of edges and curves; distance and direction
    /// between two points.
    fn measured_together(&self, items: &[Item]) -> Vec<String> {
        let unit = self.base.pattern().unit;
        let length = |length: f64| number::show(length, Want::Length, unit);
        let mut words = Vec::new();
        let lengths = items.iter().map(|item| match item {
            Item::Edge(_, edge) => Some(self.base.edge(*edge)?.length()),
            Item::Curve(curve) => Some(self.base.curve(*curve)?.length()),
            _ => None,
        });
        if let Some(lengths) = lengths.collect::<Option<Vec<f64>>>() {
            words.push(format!("{} long together", length(lengths.iter().sum())));
        }
        if let [Item::Point(a), Item::Point(b)] = items
            && let (Some(a), Some(b)) = (self.base.point(*a), self.base.point(*b))
        {
            let way = b - a;
            let angle = number::show(way.y.atan2(way.x), Want::Angle, unit);
            words.push(format!("{} apart, {angle}", length(way.norm())));
        }
        words
    }

    /// Numbers that all parts have in common: for each number its entries, one per part.
    fn common_numbers(&self, items: &[Item]) -> Vec<Vec<NumberEntry>> {
        let mut of_parts = items.iter().map(|item| numbers_of(&self.base, item.part()));
        let Some(first) = of_parts.next() else {
            return Vec::new();
        };
        let mut common: Vec<Vec<NumberEntry>> = first.into_iter().map(|e| vec![e]).collect();
        for mut entries in of_parts {
            common.retain_mut(|known| {
                let alike = |entry: &NumberEntry| {
                    entry.label == known[0].label && entry.want == known[0].want
                };
                match entries.iter().position(alike) {
                    Some(k) => {
                        known.push(entries.remove(k));
                        true
                    }
                    None => false,
                }
            });
        }
        common
    }

    fn common_field(&mut self, ui: &mut Ui, entries: &[NumberEntry]) {
        let first = &entries[0];
        let label = format!("{} of all", first.label);
        let id = egui::Id::unique(("number of all", first.label));
        let base = self.base.clone();
        let want = first.want;
        let text = |entry: &NumberEntry| {
            let number = entry.number.as_ref()?;
            Some(plan::number_shown(&base, number, want))
        };
        // The field is empty if the values differ.
        let shown = match entries.iter().all(|entry| text(entry) == text(first)) {
            true => text(first).unwrap_or_default(),
            false => String::new(),
        };
        let unit = base.pattern().unit;
        let value = |text: &str| -> Result<String, String> {
            let found = number::parse(text, want, &base)?;
            let value = base.number_or_fault(&found, want)?;
            Ok(format!("= {}", number::show(value, want, unit)))
        };
        let entered = labelled(ui, &label, |ui, label| {
            self.typed
                .number_field(ui, (id, label), (&shown, &Beside::default()), value)
        });
        self.typed.show_proposals(ui, id, &self.base);
        if let Entered::Text(text) = entered {
            let mut planning = Planning::of(&self.base);
            let planned = entries.iter().try_for_each(|entry| {
                let edits = planning.run(|evaluation| {
                    let number = number::parse(&text, want, evaluation).map_err(|words| {
                        EditError::Impossible {
                            message: words,
                            hint: "type another".into(),
                        }
                    })?;
                    let number = kept(evaluation, entry, number)?;
                    Ok((plan::set_number(evaluation, &entry.place, number)?, ()))
                });
                edits.map_err(|error| error.to_string())
            });
            match planned {
                Ok(()) => {
                    self.edit(Ok(planning.edits()), &format!("Set {}", first.label));
                }
                Err(fault) => self.typed.refuse(id, text, fault),
            }
        }
    }

    /// Shows fields for the numbers of the curve that an edge follows.
    pub(crate) fn curve_numbers(&mut self, ui: &mut Ui, (panel, edge): (PanelId, EdgeId)) {
        let pattern = self.base.pattern();
        let owner = pattern.owner_of(panel, edge.into());
        let curve = owner.and_then(|owner| owner.edge(edge));
        let Some(curve) = curve.map(|edge| edge.curve) else {
            return;
        };
        let entries = numbers_of(&self.base, curve.into());
        if !entries.is_empty() {
            theme::title(ui, "Its curve");
        }
        for entry in entries {
            self.number_field(ui, &entry);
        }
        self.radius_field(ui, curve);
        self.handle_numbers(ui, curve);
    }
}

/// Word for the common kind of several parts.
fn kind_of(items: &[Item]) -> &'static str {
    let word = |item: &Item| match item {
        Item::Point(_) => "points",
        Item::Curve(_) => "curves",
        Item::Edge(..) => "edges",
        Item::Line(..) => "lines",
        Item::Notch(..) => "notches",
        Item::Operation(..) => "steps",
        Item::Panel(_) => "panels",
        Item::Seam(_) => "seams",
        Item::Sheet(_) => "sheets",
        Item::Guide(_) => "guides",
    };
    let first = items.first().map_or("parts", word);
    match items.iter().all(|item| word(item) == first) {
        true => first,
        false => "parts",
    }
}
