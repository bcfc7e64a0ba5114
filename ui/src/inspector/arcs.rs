//! Arcs in the inspector: shown and edited by swept angle and radius. The document stores the tangent of
//! a quarter of the angle.

use super::mark_words;
use crate::app::ToileApp;
use crate::fields::{Beside, Entered, labelled};
use crate::tools::number;
use egui::Ui;
use toile_pattern::plan::{self, NumberAddress, NumberEntry};
use toile_pattern::{
    CurveId, CurveRule, EditError, Evaluation, Formula, Number, PartId, PartReference, Want,
};

/// The numbers of a part as displayed: an arc shows its swept angle, in place of the stored number.
pub fn numbers_of(evaluation: &Evaluation, part: PartId) -> Vec<NumberEntry> {
    let entries = plan::numbers_of(evaluation, part).into_iter();
    let seen = entries.map(|entry| match is_bulge(&entry) {
        true => NumberEntry {
            label: "angle",
            want: Want::Angle,
            number: entry.number.map(|n| plan::angle_of(evaluation, &n)),
            ..entry
        },
        false => mark_words::shown(evaluation, entry),
    });
    seen.collect()
}

/// Converts a displayed number to the stored one.
///
/// # Errors
/// An arc cannot sweep this angle, or the formula would be too long.
pub fn kept(
    evaluation: &Evaluation,
    entry: &NumberEntry,
    number: Number,
) -> Result<Number, EditError> {
    match is_bulge(entry) {
        true => plan::bulge_of(evaluation, &number),
        false => mark_words::kept(evaluation, entry, number),
    }
}

fn is_bulge(entry: &NumberEntry) -> bool {
    matches!(entry.place.part, PartId::Curve(_)) && entry.place.path == BULGE
}

/// Name, in the document, of the number that an arc stores: the tangent of a quarter of the swept angle.
const BULGE: &str = "bulge";

impl ToileApp {
    /// Shows the field for the radius of an arc; shows no field for other curves.
    pub(super) fn radius_field(&mut self, ui: &mut Ui, id: CurveId) {
        let base = self.base.clone();
        let Some(arc) = Arc::new(&base, id) else {
            return;
        };
        let field = egui::Id::unique(("radius", id));
        let shown = plan::number_shown(&base, &Number::Value(arc.radius()), Want::Length);
        let unit = base.pattern().unit;
        let told = |text: &str| {
            let found = number::parse(text, Want::Length, &base)?;
            let value = base.number_or_fault(&found, Want::Length)?;
            arc.angle(&found)?;
            Ok(format!("= {}", number::show(value, Want::Length, unit)))
        };
        let entered = labelled(ui, "radius", |ui, label| {
            self.typed
                .number_field(ui, (field, label), (&shown, &Beside::default()), told)
        });
        self.typed.show_proposals(ui, field, &self.base);
        let Entered::Text(text) = entered else {
            return;
        };
        let planned = number::parse(&text, Want::Length, &base)
            .and_then(|radius| arc.angle(&radius))
            .and_then(|angle| {
                let made = plan::bulge_of(&base, &angle).and_then(|bulge| {
                    plan::set_number(&base, &NumberAddress::new(id, BULGE), bulge)
                });
                made.map_err(|error| error.to_string())
            });
        match planned {
            Ok(edits) => {
                self.edit(Ok(edits), "Set radius");
            }
            Err(fault) => self.typed.refuse(field, text, fault),
        }
    }
}

/// An arc between two points.
struct Arc<'e> {
    evaluation: &'e Evaluation,
    /// Distance between the ends, as a formula and as a value (m).
    chord: (String, f64),
    /// Swept angle (rad).
    swept: f64,
}

impl<'e> Arc<'e> {
    fn new(evaluation: &'e Evaluation, id: CurveId) -> Option<Self> {
        let (_, curve) = evaluation.pattern().curve(id)?;
        let CurveRule::Arc { bulge } = &curve.rule else {
            return None;
        };
        let swept = 4.0 * evaluation.number(bulge, Want::Plain)?.atan();
        let [start, end] = curve.ends;
        let chord = (evaluation.point(end)? - evaluation.point(start)?).norm();
        let name = |id| evaluation.names().print_part(&PartReference::Point(id));
        let written = format!("distance({}, {})", name(start), name(end));
        (swept != 0.0).then_some(Self {
            evaluation,
            chord: (written, chord),
            swept,
        })
    }

    fn radius(&self) -> f64 {
        (0.5 * self.chord.1 / (0.5 * self.swept).sin()).abs()
    }

    /// Swept angle that gives the arc this radius, between the same ends and turning in the same direction.
    fn angle(&self, radius: &Number) -> Result<Number, String> {
        let value = self.evaluation.number(radius, Want::Length);
        let value = value.ok_or("the radius has no value")?;
        if value < 0.5 * self.chord.1 {
            let unit = self.evaluation.pattern().unit;
            let least = number::show(0.5 * self.chord.1, Want::Length, unit);
            return Err(format!(
                "no arc so small joins the ends: type {least} or more, or another angle"
            ));
        }
        let is_long = self.swept.abs() > std::f64::consts::PI;
        let (sign, whole) = match (self.swept < 0.0, is_long) {
            (false, false) => ("", ""),
            (true, false) => ("-", ""),
            (false, true) => ("-", "360deg "),
            (true, true) => ("", "-360deg + "),
        };
        let sign = if is_long && sign == "-" { "- " } else { sign };
        let radius = plan::number_text(self.evaluation, radius, Want::Length);
        let chord = &self.chord.0;
        // Half the chord divided by the radius is the sine of half the angle.
        let text = format!(
            "{whole}{sign}2 * atan2({chord}, sqrt(max(0, 4 * ({radius}) * ({radius}) - {chord} * {chord})))"
        );
        let read = Formula::parse(&text, self.evaluation.names());
        read.map(Number::Formula).map_err(|error| error.to_string())
    }
}
