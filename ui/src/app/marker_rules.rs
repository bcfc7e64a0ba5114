//! Rules of a marker for the selected pieces, and marks that must lie on the same place of its print.

use super::ToileApp;
use super::marker_laying::Empty;
use crate::canvas::selection::Item;
use egui::{Button, Id, Ui};
use std::f64::consts::{FRAC_PI_2, PI};
use toile_pattern::plan;
use toile_pattern::{
    LayingRule, MarkRef, Marker, MatchedMarks, PieceRule, RULE_FLAGS, RuleFlag, RuledPieces, Turn,
    Want,
};

/// Quarter turns (rad), with their labels.
const TURNS: [(f64, &str); 4] = [
    (0.0, "0\u{b0}"),
    (FRAC_PI_2, "90\u{b0}"),
    (PI, "180\u{b0}"),
    (3.0 * FRAC_PI_2, "270\u{b0}"),
];
/// Turns that differ by less count as equal (rad).
const SAME_TURN: f64 = 1e-9;

impl ToileApp {
    /// Shows the rules for the selected pieces, and the matched marks.
    pub(super) fn rule_fields(&mut self, ui: &mut Ui, marker: &Marker) {
        match self.marker_view.selection.first().copied() {
            None => {
                ui.label("Select pieces to give them rules");
            }
            Some(first) => {
                let before = marker.rule_for(first.panel, first.copy).rule;
                let mut rule = before.clone();
                let pattern = self.base.pattern();
                let name = pattern.panel(first.panel).map(|panel| panel.name.clone());
                let name = name.unwrap_or_default();
                ui.label(match self.marker_view.selection.len() {
                    1 => format!("Rule for {name}"),
                    count => format!("Rule for {name} and {} more", count - 1),
                });
                self.rule_values(ui, marker, &mut rule);
                let is_ruled = |own: &PieceRule| self.is_for_selected(own);
                let has_rule = marker.rules.iter().any(is_ruled);
                let button = ui.add_enabled(has_rule, Button::new("No rule"));
                if rule != before {
                    self.set_rule(marker, &before, &rule);
                } else if button.clicked() {
                    let mut rules = marker.rules.clone();
                    rules.retain(|own| !self.is_for_selected(own));
                    self.set_rules(marker, rules);
                }
            }
        }
        ui.separator();
        self.matched_marks(ui, marker);
    }

    fn rule_values(&mut self, ui: &mut Ui, marker: &Marker, rule: &mut LayingRule) {
        let id = |words: &str| Id::unique(("rule", marker.id, words));
        let nothing = || (Want::Length, Empty::Means(0.0));
        let (block, gap) = ("Block", "Gap of piece");
        self.given_field(ui, (block, id(block)), nothing(), &mut rule.block);
        self.given_field(ui, (gap, id(gap)), nothing(), &mut rule.gap);
        ui.label("Turned by");
        let usual = || vec![Turn(0.0), Turn(PI)];
        let turns = rule.turns.clone().unwrap_or_else(usual);
        for (angle, words) in TURNS {
            let is_same = |turn: &Turn| (turn.0 - angle).abs() < SAME_TURN;
            let mut may = turns.iter().any(is_same);
            if ui.checkbox(&mut may, words).changed() {
                let mut turns = turns.clone();
                turns.retain(|turn| !is_same(turn));
                if may {
                    turns.push(Turn(angle));
                }
                turns.sort_by(|one, other| one.0.total_cmp(&other.0));
                rule.turns = Some(turns);
            }
        }
        for RuleFlag { label, of, usual } in RULE_FLAGS {
            let flag = of(rule);
            let mut is_on = flag.unwrap_or(usual(!marker.matched.is_empty()));
            if ui.checkbox(&mut is_on, *label).changed() {
                *flag = Some(is_on);
            }
        }
    }

    /// Whether a rule names a selected piece or its panel, rather than all pieces.
    fn is_for_selected(&self, rule: &PieceRule) -> bool {
        let mut selected = self.marker_view.selection.iter();
        selected.any(|piece| match rule.pieces {
            RuledPieces::Copy(panel, copy) => (panel, copy) == (piece.panel, piece.copy),
            RuledPieces::Panel(panel) => panel == piece.panel,
            RuledPieces::All => false,
        })
    }

    /// Applies the changes from `before` to `now` to the rules of the selected pieces: to the rule of the
    /// piece if it has one of its own, else to the rule of its panel.
    fn set_rule(&mut self, marker: &Marker, before: &LayingRule, now: &LayingRule) {
        let mut rules = marker.rules.clone();
        for piece in &self.marker_view.selection {
            let own = RuledPieces::Copy(piece.panel, piece.copy);
            let place = |rules: &[PieceRule], pieces| {
                let mut all = rules.iter();
                all.position(|rule: &PieceRule| rule.pieces == pieces)
            };
            let of_panel = RuledPieces::Panel(piece.panel);
            let known = place(&rules, own).or_else(|| place(&rules, of_panel));
            let k = known.unwrap_or_else(|| {
                rules.push(PieceRule {
                    pieces: of_panel,
                    ..PieceRule::default()
                });
                rules.len() - 1
            });
            rules[k].rule.take_changes(before, now);
        }
        rules.retain(|rule| {
            let is_empty = rule.rule == LayingRule::default();
            !is_empty || rule.fabric.is_some() || rule.also.is_some()
        });
        self.set_rules(marker, rules);
    }

    fn set_rules(&mut self, marker: &Marker, rules: Vec<PieceRule>) {
        let planned = plan::set_marker_rules(&self.base, marker.id, rules);
        self.edit(planned, "Set rule of pieces");
        self.follow_marker();
    }

    /// Shows the button that matches the notches selected in the pattern view, and the list of matched
    /// marks.
    fn matched_marks(&mut self, ui: &mut Ui, marker: &Marker) {
        let selected = self.view.selection.items().iter();
        let marks = selected.filter_map(|item| match item {
            Item::Notch(panel, notch) => Some(MarkRef {
                panel: *panel,
                notch: *notch,
            }),
            _ => None,
        });
        let marks = MatchedMarks(marks.collect());
        let is_new = marks.0.len() > 1 && !marker.matched.contains(&marks);
        let button = ui
            .add_enabled(is_new, Button::new("Match marks"))
            .on_hover_text("The selected notches lie on the same place of the print")
            .on_disabled_hover_text("Select two or more notches of the pattern first");
        let mut matched = marker.matched.clone();
        if button.clicked() {
            matched.push(marks);
        }
        if !matched.is_empty() {
            ui.label(match matched.len() {
                1 => "1 set of marks matches".to_owned(),
                count => format!("{count} sets of marks match"),
            });
            if ui.button("Match none").clicked() {
                matched.clear();
            }
        }
        if matched != marker.matched {
            let planned = plan::set_matched_marks(&self.base, marker.id, matched);
            self.edit(planned, "Match marks");
            self.follow_marker();
        }
    }
}
