//! Name and unit of the pattern, and the current sheet.

use crate::app::ToileApp;
use crate::app::tab::Tab;
use crate::fields::{Entered, choice, labelled};
use crate::theme::Palette;
use egui::{RichText, Ui};
use toile_pattern::plan;

impl ToileApp {
    /// Shows the table with the properties of the pattern.
    pub(crate) fn show_properties(&mut self) {
        self.panes.tables = true;
        self.tables.tab = Tab::Pattern;
    }

    /// Shows name and unit of the pattern, and the current sheet.
    pub(super) fn properties_table(&mut self, ui: &mut Ui) {
        use toile_pattern::DisplayUnit::{Centimetre, Inch, Metre, Millimetre};
        let pattern = self.base.pattern().clone();
        let id = egui::Id::unique("pattern name");
        let entered = labelled(ui, "Name", |ui, label| {
            let nothing = |_: &str| Ok(String::new());
            self.typed.field(ui, (id, label), &pattern.name, nothing)
        });
        if let Entered::Text(text) = entered {
            let planned = plan::rename_pattern(&self.base, &text);
            self.enter(planned, "Rename pattern", (id, text));
        }
        self.sheet_name(ui);
        let mut unit = pattern.unit;
        let units = [Millimetre, Centimetre, Metre, Inch].map(|unit| (unit, unit.sign()));
        choice(ui, "Unit", &units, &mut unit);
        if unit != pattern.unit {
            let edits = plan::set_unit(&self.base, unit);
            self.edit(Ok(edits), "Change unit");
        }
        ui.separator();
        let soft = Palette::of(ui.ctx()).ink_soft;
        let counted = |count: usize, word: &str| match count {
            1 => format!("1 {word}"),
            _ => format!("{count} {word}s"),
        };
        let words = [
            counted(pattern.panels.len(), "panel"),
            counted(pattern.seams.len(), "seam"),
            counted(pattern.sizes.len(), "size"),
        ];
        let words = words.join(", ");
        ui.label(RichText::new(words).color(soft));
    }

    /// Shows the field for the name of the current sheet; formulas use the name for points of the sheet.
    fn sheet_name(&mut self, ui: &mut Ui) {
        let pattern = self.base.pattern().clone();
        let drawn_on = self.view.sheet.and_then(|id| pattern.sheet(id));
        let Some(sheet) = drawn_on.or(pattern.sheets.first()) else {
            return;
        };
        let id = egui::Id::unique(("sheet name", sheet.id));
        let entered = labelled(ui, "Sheet that is drawn on", |ui, label| {
            let nothing = |_: &str| Ok(String::new());
            self.typed.field(ui, (id, label), &sheet.name, nothing)
        });
        if let Entered::Text(text) = entered {
            let planned = plan::rename(&self.base, sheet.id.into(), &text);
            self.enter(planned, "Rename sheet", (id, text));
        }
    }
}
