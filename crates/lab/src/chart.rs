//! Speed against accuracy: every method at several steps on the standard scenes.
//!
//! # Decided with
//! - [`crate::chart_plan::ChartPlan`], [`crate::chart_data::ChartData`]: what is run; results;
//! - [`crate::chart_contact::contact_chart`]: charts with contact of cloth;
//! - [`crate::chart_report::chart_files`], [`crate::stability_report::stability_files`]: files that are
//!   written;
//! - [`crate::stability::stability_map`], [`crate::hard::hard_cases`]: limits of stability; hard cases;
//! - [`crate::scenes::SCENES`], [`crate::freeze::freeze`]: the scenes; how they are made anew;
//! - [`toile_picture::Chart`]: how it is drawn.

use crate::chart_contact::contact_chart;
use crate::chart_data::{Agreement, ChartData, Point};
use crate::chart_plan::ChartPlan;
use crate::clock::Clock;
use crate::scenes::{Card, Reference, SCENES, apart, card};
use crate::{LabError, settle::TIGHT};
use std::ops::ControlFlow;
use toile_drape::{MethodKind, MethodSettings, State, System};
use toile_geometry::Vec3;
use toile_session::Watcher;

struct Setting<'a> {
    card: &'a Card,
    mesh: String,
    system: System,
    start: State,
}

impl Setting<'_> {
    fn point(&self, kind: MethodKind, step: f64) -> Point {
        Point {
            scene: self.card.name.clone(),
            mesh: self.mesh.clone(),
            vertices: self.system.vertex_count(),
            method: kind.name(),
            step,
            iterations: None,
            wall_ms: 0.0,
            cpu_ms: None,
            error_mm: None,
            failure: None,
            best: false,
        }
    }

    /// One run in time.
    fn run(
        &self,
        kind: MethodKind,
        step: f64,
        reference: &Reference,
        budget: f64,
    ) -> Result<Point, LabError> {
        let mut method = toile_reference::build(&kind.into())?;
        let mut point = self.point(kind, step);
        point.iterations = method.most_iterations();
        let mut state = self.start.clone();
        let steps = (self.card.duration / step).round().max(1.0) as usize;
        let clock = Clock::start();
        let mut done = 0;
        while done < steps {
            if let Err(error) = method.advance(&self.system, &mut state, step) {
                point.failure = Some(error.to_string());
                break;
            }
            done += 1;
            if clock.spent() > budget && done < steps {
                point.failure = Some(format!("not done in {budget} s: {done} of {steps} steps"));
                break;
            }
        }
        let simulated = done.max(1) as f64 * step;
        point.wall_ms = 1e3 * clock.wall() / simulated;
        point.cpu_ms = clock.cpu().map(|cpu| 1e3 * cpu / simulated);
        if point.failure.is_none() {
            let end: Vec<Vec3> = reference
                .positions
                .iter()
                .map(|p| p.map(f64::from).into())
                .collect();
            let error = apart(&state.positions, &end);
            let moved = apart(&self.start.positions, &end);
            if error > 0.5 * moved {
                point.failure = Some(format!(
                    "wrong: {:.0} mm off after moving {:.0} mm",
                    1e3 * error,
                    1e3 * moved
                ));
            }
            point.error_mm = Some(1e3 * error);
        }
        Ok(point)
    }

    /// One way to rest.
    fn settle(
        &self,
        kind: MethodKind,
        residual: f64,
        rest: &[Vec3],
        budget: f64,
    ) -> Result<Point, LabError> {
        let mut point = self.point(kind, residual);
        let mut state = self.start.clone();
        let settings = MethodSettings {
            tolerance: Some(residual),
            iterations: Some(200_000),
            ..kind.into()
        };
        let mut method = toile_reference::build(&settings)?;
        let clock = Clock::start();
        while !method.finished() {
            if let Err(error) = method.advance(&self.system, &mut state, 1.0 / 60.0) {
                point.failure = Some(error.to_string());
                break;
            }
            if clock.spent() > budget {
                let at = method.residual().unwrap_or(f64::NAN);
                point.failure = Some(format!(
                    "not done in {budget} s: net force {at:.1e} of the weight"
                ));
                break;
            }
        }
        point.wall_ms = 1e3 * clock.wall();
        point.cpu_ms = clock.cpu().map(|cpu| 1e3 * cpu);
        if point.failure.is_none() {
            point.error_mm = Some(1e3 * apart(&state.positions, rest));
        }
        Ok(point)
    }
}

/// Name of the part of the chart about contact of cloth with cloth.
const CONTACT: &str = "contact";

/// Runs the scenes named and, where it is named, the part about contact of cloth with cloth; all by
/// default.
///
/// # Errors
/// An unknown scene; the watcher asked to stop. Methods that fail are points with a reason.
pub fn chart(
    names: &[String],
    plan: ChartPlan,
    watcher: &mut dyn Watcher,
) -> Result<ChartData, LabError> {
    let known = |name: &String| name == CONTACT || SCENES.contains(&name.as_str());
    if let Some(name) = names.iter().find(|name| !known(name)) {
        return Err(LabError::Unknown {
            what: "scene",
            name: name.clone(),
            known: format!("{}, {CONTACT}", SCENES.join(", ")),
        });
    }
    let chosen: Vec<&str> = SCENES
        .into_iter()
        .filter(|name| names.is_empty() || names.iter().any(|n| n == name))
        .collect();
    let mut data = ChartData::default();
    for (k, name) in chosen.iter().enumerate() {
        let card = card(name)?;
        for (r, cloth_card) in card.cloths.iter().enumerate().take(plan.resolutions) {
            let cloth = card.cloth(r)?;
            let (system, start) = card.system(&cloth, &cloth_card.pins)?;
            let setting = Setting {
                card: &card,
                mesh: cloth_card.mesh.clone(),
                system,
                start,
            };
            let share = |part: f64| (k as f64 + part) / chosen.len() as f64;
            let mut tell =
                |part: f64, detail: &str| match watcher.progress(name, share(part), detail) {
                    ControlFlow::Continue(()) => Ok(()),
                    ControlFlow::Break(()) => Err(LabError::Cancelled),
                };
            move_all(&setting, r, plan, &mut data, &mut tell)?;
            settle_all(&setting, plan, &mut data, &mut tell)?;
        }
    }
    mark_best(&mut data.motion);
    mark_best(&mut data.rest);
    if names.is_empty() || names.iter().any(|name| name == CONTACT) {
        data.contact = contact_chart(plan, watcher)?;
    }
    Ok(data)
}

type Tell<'a> = &'a mut dyn FnMut(f64, &str) -> Result<(), LabError>;

/// All methods in time, one after another at each step, so that a busy machine is unfair to none.
fn move_all(
    setting: &Setting,
    resolution: usize,
    plan: ChartPlan,
    data: &mut ChartData,
    tell: Tell,
) -> Result<(), LabError> {
    let Some(reference) = setting.card.reference(resolution)? else {
        data.agreement.push(Agreement {
            mesh: setting.mesh.clone(),
            apart_mm: None,
            by: "no reference".to_owned(),
        });
        return Ok(());
    };
    data.agreement.push(Agreement {
        mesh: setting.mesh.clone(),
        apart_mm: Some(1e3 * reference.agreement),
        by: format!("{} and {}", reference.methods[0], reference.methods[1]),
    });
    let methods = MethodKind::ALL
        .into_iter()
        .filter(|(_, kind)| !kind.is_equilibrium());
    let mut found: Vec<Point> = Vec::new();
    for repeat in 0..plan.repeats {
        for &step in plan.steps {
            for (name, kind) in methods.clone() {
                tell(
                    0.1,
                    &format!("{}, {name}, step {:.2} ms", setting.mesh, 1e3 * step),
                )?;
                let old = found
                    .iter()
                    .position(|p| p.method == name && p.step == step);
                // What failed once is not tried again.
                if old.is_some_and(|at| found[at].failure.is_some()) {
                    continue;
                }
                let point = setting.run(kind, step, &reference, plan.budget)?;
                match old {
                    None => found.push(point),
                    Some(at) if repeat > 0 && point.cost() < found[at].cost() => found[at] = point,
                    Some(_) => {}
                }
            }
        }
    }
    data.motion.extend(found);
    Ok(())
}

fn settle_all(
    setting: &Setting,
    plan: ChartPlan,
    data: &mut ChartData,
    tell: Tell,
) -> Result<(), LabError> {
    let methods = MethodKind::ALL
        .into_iter()
        .filter(|(_, kind)| kind.is_equilibrium());
    tell(0.8, &format!("{}, rest", setting.mesh))?;
    let mut rest = setting.start.clone();
    let known = crate::settle::to_rest(&setting.system, &mut rest, 100.0 * TIGHT).is_ok();
    for &residual in plan.residuals {
        for (name, kind) in methods.clone() {
            tell(0.9, &format!("{}, {name}, to {residual:.0e}", setting.mesh))?;
            let mut point = setting.settle(kind, residual, &rest.positions, plan.budget)?;
            if !known {
                point.error_mm = None;
                point
                    .failure
                    .get_or_insert("no converged rest to compare with".to_owned());
            }
            data.rest.push(point);
        }
    }
    Ok(())
}

/// Marks the Pareto front of each mesh.
fn mark_best(points: &mut [Point]) {
    let judged: Vec<Option<(String, f64, f64)>> = points
        .iter()
        .map(|p| {
            let error = p.error_mm.filter(|_| p.failure.is_none())?;
            Some((p.mesh.clone(), p.cost(), error))
        })
        .collect();
    for (k, point) in points.iter_mut().enumerate() {
        let Some((mesh, wall, error)) = &judged[k] else {
            continue;
        };
        point.best = !judged.iter().flatten().any(|(other, w, e)| {
            other == mesh && w <= wall && e <= error && (w < wall || e < error)
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(wall_ms: f64, error_mm: Option<f64>) -> Point {
        Point {
            scene: "s".to_owned(),
            mesh: "m".to_owned(),
            vertices: 1,
            method: "x",
            step: 1.0,
            iterations: None,
            wall_ms,
            cpu_ms: None,
            error_mm,
            failure: error_mm.is_none().then(|| "stopped".to_owned()),
            best: false,
        }
    }

    #[test]
    fn the_front_is_what_nothing_beats_in_both() {
        let mut points = [
            point(1.0, Some(10.0)),
            point(2.0, Some(5.0)),
            point(3.0, Some(7.0)),
            point(0.5, None),
            point(4.0, Some(1.0)),
        ];
        mark_best(&mut points);
        let best: Vec<bool> = points.iter().map(|p| p.best).collect();
        assert_eq!(best, [true, true, false, false, true]);
    }

    #[test]
    fn an_unknown_scene_is_refused() {
        let error = chart(
            &["moon".to_owned()],
            ChartPlan::QUICK,
            &mut toile_session::Silent,
        );
        assert!(
            matches!(error, Err(LabError::Unknown { known, .. }) if known.ends_with("shirt, contact"))
        );
    }
}
