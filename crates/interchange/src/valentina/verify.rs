//! The document compared with the places of the file's tools for the base size.

use super::build::Build;
use super::things::PointThing;
use crate::exchange::Loss;
use std::sync::Arc;
use toile_measure::Measurements;
use toile_pattern::{Evaluation, Pattern, Point, PointId, PointRule};

/// Difference from which a construction gives another place than its tool (m).
const TOLERANCE: f64 = 1e-6;
/// Rounds in which one construction is replaced, and what hangs on it evaluated again.
const MAX_ROUNDS: usize = 20;

/// Gives points whose construction has another place than their tool, or none, the place of the tool.
pub(super) fn verify(build: &mut Build) {
    let points = std::mem::take(&mut build.places);
    for round in 0..=MAX_ROUNDS {
        let wrong = wrong_points(&build.pattern, &points);
        let Some((first, why)) = wrong.first() else {
            return;
        };
        let replaced = match round == MAX_ROUNDS {
            false => std::slice::from_ref(first),
            true => &wrong.iter().map(|(point, _)| *point).collect::<Vec<_>>(),
        };
        for point in replaced {
            let name = build.point_name(*point);
            let told = "the point stays where the base size has it";
            let why = format!("{told}: {why}");
            build.losses.push(Loss::at(name, "a construction", why));
            fix(&mut build.pattern, *point);
        }
    }
}

/// Points at other places than their tools, in the order in which they were made, with the reasons.
fn wrong_points(pattern: &Pattern, points: &[PointThing]) -> Vec<(PointThing, String)> {
    let wearer = pattern.base_measurements().cloned().unwrap_or_default();
    let evaluation = Evaluation::new(pattern, &wearer as &Measurements);
    let fault = |id: PointId| {
        let all = evaluation.diagnostics();
        let own = all
            .into_iter()
            .find(|one| one.place == toile_pattern::Place::Point(id));
        own.map_or_else(|| "it has no place".to_owned(), |one| one.message)
    };
    let wrong = points
        .iter()
        .filter_map(|point| match evaluation.point(point.id) {
            None => Some((*point, None)),
            Some(at) => {
                let distance = (at - point.at).norm();
                (distance > TOLERANCE).then_some((*point, Some(distance)))
            }
        });
    let told = |(point, distance): (PointThing, Option<f64>)| match distance {
        None => (point, fault(point.id)),
        Some(distance) => (point, format!("it is {:.3} mm off", distance * 1e3)),
    };
    // Only the first is told why: the others may hang on it.
    let mut wrong: Vec<_> = wrong.collect();
    let first = wrong.drain(..wrong.len().min(1)).map(told);
    let mut all: Vec<_> = first.collect();
    all.extend(wrong.into_iter().map(|(point, _)| (point, String::new())));
    all
}

fn fix(pattern: &mut Pattern, point: PointThing) {
    let Some(sheet) = pattern.sheets.get_mut(point.sheet) else {
        return;
    };
    let sheet = Arc::make_mut(sheet);
    let own = sheet.points.iter_mut().find(|own| own.id == point.id);
    if let Some(own) = own {
        *own = Arc::new(Point {
            rule: PointRule::at(point.at.x, point.at.y),
            ..(**own).clone()
        });
    }
}
