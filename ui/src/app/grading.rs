//! Grade rules given to the selected points, copied, mirrored, read off sizes and taken away.

use super::ToileApp;
use super::tab::Tab;
use crate::canvas::selection::{Item, Selection};
use toile_pattern::plan::{self, Axis};
use toile_pattern::{GradeRule, PointId};

impl ToileApp {
    /// The points of the selected parts.
    fn chosen_points(&self) -> Vec<PointId> {
        plan::points_of(&self.base, &self.selected_parts())
    }

    /// Whether there are sizes, and something is selected that they could move.
    pub(super) fn can_grade(&self) -> bool {
        self.has_sizes() && self.has_selection()
    }

    /// Gives the selected points a new rule, which moves nothing yet: its shifts are typed into the table.
    pub(super) fn give_grade_rule(&mut self) {
        let planned = plan::give_rule(&self.base, &self.chosen_points(), &[]);
        if self.edit(planned.map(|(edits, _)| edits), "Give grade rule") {
            self.show_table(Tab::Grading);
        }
    }

    /// Gives the rule of the first selected point that has one to the other selected points.
    pub(super) fn copy_grade_rule(&mut self) {
        let points = self.chosen_points();
        let pattern = self.base.pattern();
        let has_rule = |id: &PointId| plan::rule_of(pattern, *id).is_some();
        let from = self.view.selection.points().into_iter().find(has_rule);
        let from = from.or_else(|| points.iter().copied().find(has_rule));
        match from {
            Some(from) => {
                let planned = plan::copy_rule(&self.base, from, &points);
                self.edit(planned, "Copy grade rule");
            }
            None => self.say_fault(
                "none of the selected points has a grade rule: select one that has, then the others"
                    .to_owned(),
            ),
        }
    }

    /// Turns the shifts of the selected points along an axis.
    pub(super) fn mirror_grade_rule(&mut self, axis: Axis) {
        let planned = plan::mirror_rule(&self.base, &self.chosen_points(), axis);
        self.edit(planned, "Mirror grade rule");
    }

    /// Puts rules in place of what moves the selected points from size to size.
    pub(super) fn read_grade_rules(&mut self) {
        let planned = plan::rules_of_sizes(&self.base, &self.chosen_points());
        match planned {
            Ok((_, 0)) => self.say_fault(
                "the selected points lie alike in all sizes, or have rules: select points that move"
                    .to_owned(),
            ),
            planned => {
                if self.edit(planned.map(|(edits, _)| edits), "Read grade rules") {
                    self.show_table(Tab::Grading);
                }
            }
        }
    }

    /// Takes the rules of the selected points away.
    pub(super) fn remove_grade_rule(&mut self) {
        let planned = plan::ungrade(&self.base, &self.chosen_points());
        self.edit(planned, "Remove grade rule");
    }

    /// Selects the points of a rule.
    pub(crate) fn select_rule(&mut self, rule: GradeRule) {
        let points = plan::points_of_rule(self.base.pattern(), rule);
        let selection: Selection = points.into_iter().map(Item::Point).collect();
        self.view.select(selection);
    }
}
