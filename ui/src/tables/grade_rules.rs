//! The table of grade rules: two rows a rule, across and up, a column a size.

use super::{VALUE, named};
use crate::app::ToileApp;
use crate::app::document_commands::grading_commands;
use crate::fields::Entered;
use crate::theme::Palette;
use crate::tools::number;
use egui::{Color32, Grid, Id, RichText, ScrollArea, Ui};
use toile_geometry::Vec2;
use toile_pattern::plan::{self, SizeShift};
use toile_pattern::{GradeRule, Number, Pattern, SizeId, Want};

/// Width of the name of a rule (pixels).
const RULE: f32 = 110.0;
/// Room for the sign of a jump beside a value (pixels).
const SIGN: f32 = 16.0;
/// The directions of shifts, in words.
const DIRECTIONS: [&str; 2] = ["across", "up"];

impl ToileApp {
    /// Shows the commands for rules, and the shifts of all rules by size.
    pub(super) fn grade_rule_table(&mut self, ui: &mut Ui) {
        let pattern = self.base.pattern().clone();
        ui.horizontal_wrapped(|ui| {
            for command in grading_commands() {
                self.command_button(ui, command);
            }
        });
        let rules = GradeRule::all(&pattern);
        if pattern.sizes.len() < 2 {
            ui.label("The pattern has fewer than two sizes: add some under Measurements.");
            return;
        }
        if rules.is_empty() {
            ui.label("No point has a grade rule: select points, then give them one.");
            return;
        }
        ScrollArea::both()
            .id_salt("grade rules")
            .auto_shrink([false, false])
            .show(ui, |ui| {
                let grid = Grid::new("grade rules").striped(true);
                grid.show(ui, |ui| {
                    named(ui, RULE, RichText::new("Grade rule").strong());
                    for size in &pattern.sizes {
                        let is_base = pattern.base().is_some_and(|base| base.id == size.id);
                        let words = match is_base {
                            true => format!("{} (base)", size.name),
                            false => size.name.clone(),
                        };
                        named(ui, VALUE + SIGN, RichText::new(words).strong());
                    }
                    ui.end_row();
                    for rule in rules {
                        self.grade_rule_rows(ui, &pattern, rule);
                    }
                });
            });
    }

    /// The rows of a rule.
    fn grade_rule_rows(&mut self, ui: &mut Ui, pattern: &Pattern, rule: GradeRule) {
        let shifts = plan::rule_shifts(&self.base, rule);
        for (axis, direction) in DIRECTIONS.into_iter().enumerate() {
            let words = format!("Rule {} {direction}", rule.number);
            match axis {
                0 => {
                    let count = plan::points_of_rule(pattern, rule).len();
                    let points = match count {
                        1 => "1 point".to_owned(),
                        _ => format!("{count} points"),
                    };
                    let button = egui::Button::new(words.as_str()).min_size(egui::vec2(RULE, 0.0));
                    let button = ui.add(button);
                    if button
                        .on_hover_text(format!("Select what it moves: {points}"))
                        .clicked()
                    {
                        self.select_rule(rule);
                    }
                }
                _ => {
                    named(ui, RULE, words.as_str().into());
                }
            }
            for size in &pattern.sizes {
                let own = shifts.iter().find(|own| own.size == size.id);
                match own {
                    Some(own) => self.grade_shift(ui, (rule, axis), (own, &size.name)),
                    None => {
                        ui.label("no value");
                    }
                }
            }
            ui.end_row();
        }
    }

    /// The shift of a rule in a size along one direction.
    fn grade_shift(
        &mut self,
        ui: &mut Ui,
        (rule, axis): (GradeRule, usize),
        (own, size): (&SizeShift, &str),
    ) {
        let palette = Palette::of(ui.ctx());
        let base = self.base.clone();
        let shown = plan::number_shown(&base, &Number::Value(own.by[axis]), Want::Length);
        let is_base = base
            .pattern()
            .base()
            .is_some_and(|size| size.id == own.size);
        if is_base {
            ui.label(RichText::new(shown).color(palette.ink_soft))
                .on_hover_text("The base size, which rules do not move");
            return;
        }
        ui.horizontal(|ui| {
            // For screen readers; sighted users read row and column.
            let unseen = format!("Rule {} {} in {size}", rule.number, DIRECTIONS[axis]);
            let unseen = RichText::new(unseen).size(1.0).color(Color32::TRANSPARENT);
            ui.spacing_mut().item_spacing.x = 2.0;
            let label = ui.scope(|ui| {
                ui.set_max_width(1.0);
                ui.add(egui::Label::new(unseen).truncate()).id
            });
            let id = Id::unique(("grade shift", rule.number, axis, own.size));
            let entered = ui.scope(|ui| {
                ui.set_width(VALUE);
                self.typed.field(ui, (id, label.inner), &shown, |text| {
                    number::parse(text, Want::Length, &base).map(|_| String::new())
                })
            });
            let sign = match own.is_jump {
                true => RichText::new("!").color(palette.warning),
                false => RichText::new(" "),
            };
            let sign = ui.label(sign);
            if own.is_jump {
                sign.on_hover_text(
                    "A jump: the step to this size is another than the step before it",
                );
            }
            if let Entered::Text(text) = entered.inner {
                self.enter_shift((rule, axis), (own.size, own.by), (id, text));
            }
        });
    }

    /// Sets a shift that was typed.
    fn enter_shift(
        &mut self,
        (rule, axis): (GradeRule, usize),
        (size, by): (SizeId, Vec2),
        (id, text): (Id, String),
    ) {
        let base = self.base.clone();
        let planned = number::parse(&text, Want::Length, &base)
            .and_then(|number| base.number_or_fault(&number, Want::Length))
            .and_then(|value| {
                let mut by = by;
                by[axis] = value;
                plan::set_rule_shift(&base, rule.number, (size, by)).map_err(|e| e.to_string())
            });
        match planned {
            Ok(edits) => {
                self.edit(Ok(edits), "Set grade rule");
            }
            Err(fault) => self.typed.refuse(id, text, fault),
        }
    }
}
