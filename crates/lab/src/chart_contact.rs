//! Contact of cloth with cloth in the chart: scenes and steps with it and without, what it costs, and
//! what passes through what where it is left out.

use crate::chart_plan::ChartPlan;
use crate::check::significant;
use crate::clock::Clock;
use crate::csv::field;
use crate::scenes::card;
use crate::{LabError, MeshKind, rectangle};
use serde::Serialize;
use std::fmt::Write;
use std::ops::ControlFlow;
use std::sync::Arc;
use toile_drape::collision::{ClothSurface, LinearTrajectories, crossings};
use toile_drape::{Collider, Feature, Material, MethodKind, State, System, SystemBuilder};
use toile_geometry::{SurfaceTree, TriangleMesh, Vec2, Vec3};
use toile_picture::{Axis, Chart, Series};
use toile_session::Watcher;

/// One run, with contact of cloth with cloth or without.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Touched {
    /// The scene.
    pub scene: &'static str,
    /// Vertices of the cloth.
    pub vertices: usize,
    /// The method.
    pub method: &'static str,
    /// Step (s).
    pub step: f64,
    /// Distance that cloth keeps from cloth (m); zero without contact.
    pub offset: f64,
    /// Wall time (ms) a simulated second.
    pub wall_ms: f64,
    /// Processor time (ms) a simulated second.
    pub cpu_ms: Option<f64>,
    /// Edges of cloth through faces of it at the end, exactly.
    pub crossings: Option<usize>,
    /// Looks for contacts a simulated second.
    pub looks: f64,
    /// Impulses that kept cloth from passing through cloth.
    pub impulses: usize,
    /// Moves of vertices that were cut for that.
    pub cut: usize,
    /// Pieces that a step was cut into, at the most; 1 where all were taken whole.
    pub pieces: u32,
    /// Why there is no end.
    pub failure: Option<String>,
}

impl Touched {
    fn cost(&self) -> f64 {
        self.cpu_ms.unwrap_or(self.wall_ms)
    }
}

/// Scenes by their names, and how long each goes on (s).
const SCENES: [(&str, f64); 3] = [("sphere", 0.5), ("shirt", 0.1), ("fall", 0.4)];

/// Distances that cloth keeps from cloth in the runs (m).
const OFFSETS: [f64; 3] = [0.0, 1e-3, 2e-3];

/// A square sheet of so many metres and cells along a side that falls on its edge, and folds up over a
/// floor.
pub(crate) fn fall(side: f64, cells: usize) -> Result<(System, State), LabError> {
    let corner = Vec2::repeat(side);
    let flat = rectangle(MeshKind::Delaunay, Vec2::zeros(), corner, [cells; 2])?;
    // Not quite upright nor flat, so that it has a way to fold.
    let cloth = flat.cloth(Material::default(), |p| {
        Vec3::new(p.x, p.y + 0.02, 0.004 * (20.0 * p.y).sin())
    });
    let mut builder = SystemBuilder::new("fall", &cloth)?;
    let floor = TriangleMesh::cuboid(Vec3::new(-1.0, -0.5, -1.0), Vec3::new(1.0, 0.0, 1.0));
    let floor = SurfaceTree::new(floor);
    builder.colliders.push(Collider::new(Arc::new(floor)));
    let system = builder.build();
    let state = State::at_rest(&system, cloth.positions);
    Ok((system, state))
}

fn scene(name: &str) -> Result<(System, State), LabError> {
    if name == "fall" {
        return fall(0.3, 20);
    }
    let card = card(name)?;
    let finest = card.cloths.len() - 1;
    card.system(&card.cloth(finest)?, &card.cloths[finest].pins)
}

/// Edges of a model's cloth through faces of it, exactly.
pub(crate) fn crossed(system: &System, x: &[Vec3]) -> usize {
    let mut surface = ClothSurface::new(system);
    let near = surface.near_leaves(LinearTrajectories::still(x), 0.0);
    crossings(&surface, &near, x).len()
}

fn run(
    (scene, duration): (&'static str, f64),
    (system, start): (&System, &State),
    (kind, step): (MethodKind, f64),
    budget: f64,
) -> Result<Touched, LabError> {
    let mut method = toile_reference::build(&kind.into())?;
    let mut state = start.clone();
    let steps = (duration / step).round().max(1.0) as usize;
    let clock = Clock::start();
    let (mut done, mut pieces, mut failure) = (0, 1, None);
    while done < steps && failure.is_none() {
        match method.advance(system, &mut state, step) {
            Ok(report) => pieces = pieces.max(report.pieces),
            Err(error) => failure = Some(error.to_string()),
        }
        done += 1;
        if clock.spent() > budget && done < steps {
            failure = Some(format!("not done in {budget} s: {done} of {steps} steps"));
        }
    }
    let simulated = done.max(1) as f64 * step;
    let tally = method.cloth_tally().unwrap_or_default();
    Ok(Touched {
        scene,
        vertices: system.vertex_count(),
        method: kind.name(),
        step,
        offset: system.contact.cloth_offset,
        wall_ms: 1e3 * clock.wall() / simulated,
        cpu_ms: clock.cpu().map(|cpu| 1e3 * cpu / simulated),
        crossings: failure.is_none().then(|| crossed(system, &state.positions)),
        looks: tally.looks as f64 / simulated,
        impulses: tally.impulses,
        cut: tally.cut,
        pieces,
        failure,
    })
}

/// Runs every method that knows contact of cloth with cloth, with it and without.
///
/// # Errors
/// The watcher asked to stop. Methods that fail are points with a reason.
pub fn contact_chart(plan: ChartPlan, watcher: &mut dyn Watcher) -> Result<Vec<Touched>, LabError> {
    let methods = MethodKind::ALL.into_iter();
    let methods =
        methods.filter(|(_, kind)| kind.supports(Feature::ClothContact) && !kind.is_equilibrium());
    let mut found = Vec::new();
    for (number, (name, duration)) in SCENES.into_iter().enumerate() {
        let (mut system, start) = scene(name)?;
        for &step in plan.contact_steps {
            for (method, kind) in methods.clone() {
                for offset in OFFSETS {
                    let detail = format!("{name}, {method}, step {:.2} ms", 1e3 * step);
                    let share = number as f64 / SCENES.len() as f64;
                    if let ControlFlow::Break(()) = watcher.progress("contact", share, &detail) {
                        return Err(LabError::Cancelled);
                    }
                    system = system.with(|builder| builder.contact.cloth_offset = offset);
                    let ready = (&system, &start);
                    found.push(run((name, duration), ready, (kind, step), plan.budget)?);
                }
            }
        }
    }
    Ok(found)
}

/// The runs as files: CSV, and a chart of each scene.
///
/// # Errors
/// A chart cannot be drawn.
pub fn contact_files(found: &[Touched]) -> Result<Vec<(String, String)>, LabError> {
    let mut text = "scene,vertices,method,step_s,offset_m,wall_ms_per_simulated_s,cpu_ms,\
                    crossings,looks_per_simulated_s,impulses,cut,pieces,failure\n"
        .to_owned();
    for p in found {
        let _ = writeln!(
            text,
            "{},{},{},{:.4e},{},{},{},{},{},{},{},{},{}",
            p.scene,
            p.vertices,
            p.method,
            p.step,
            p.offset,
            significant(p.wall_ms, 5),
            p.cpu_ms.map_or(String::new(), |x| significant(x, 5)),
            p.crossings.map_or(String::new(), |n| n.to_string()),
            significant(p.looks, 3),
            p.impulses,
            p.cut,
            p.pieces,
            field(p.failure.as_deref().unwrap_or("")),
        );
    }
    let mut files = vec![("contact.csv".to_owned(), text)];
    for (scene, _) in SCENES {
        let mut series = Vec::new();
        for (method, _) in MethodKind::ALL {
            for (offset, words) in OFFSETS.into_iter().zip(["none", "1 mm", "2 mm"]) {
                let own = found
                    .iter()
                    .filter(|p| p.scene == scene && p.method == method && p.offset == offset);
                let places: Vec<[f64; 2]> = own
                    .filter_map(|p| Some([p.cost(), p.crossings? as f64 + 1.0]))
                    .collect();
                if !places.is_empty() {
                    let name = format!("{method}, {words}");
                    series.push(Series::numbered(series.len(), name, places));
                }
            }
        }
        let chart = Chart {
            title: format!("{scene}: contact of cloth with cloth, by the distance kept"),
            x: Axis::logarithmic("processor time per simulated second [ms]"),
            y: Axis::logarithmic("edges of cloth through cloth at the end, plus 1"),
            series,
            notes: vec!["points of a line: steps".to_owned()],
            size: [860.0, 420.0],
        };
        // A scene in which everything failed has no axes to show it on.
        if let Ok(drawing) = chart.draw() {
            files.push((format!("contact-{scene}.svg"), drawing.to_svg()));
        }
    }
    Ok(files)
}

/// The cost and savings of contact, as Markdown.
pub fn contact_table(found: &[Touched]) -> String {
    let mut text = String::from(
        "\nContact of cloth with cloth, the same steps with it and without (processor ms per simulated second; edges through faces at the end, \
         exactly; pieces a step was cut into):\n\n| scene | vertices | method, step | without | 1 mm | 2 mm |\n|---|---|---|---|---|---|\n",
    );
    let cell = |p: &Touched| match (&p.failure, p.crossings) {
        (None, Some(crossings)) => {
            format!("{}: {crossings}, {}", significant(p.cost(), 3), p.pieces)
        }
        _ => "failed".to_owned(),
    };
    let mut without_end = Vec::new();
    for three in found.chunks(OFFSETS.len()) {
        let p = &three[0];
        if three.iter().all(|p| p.failure.is_some()) {
            let step = significant(1e3 * p.step, 2);
            without_end.push(format!("{} by {} ({step} ms)", p.scene, p.method));
            continue;
        }
        let cells: Vec<String> = three.iter().map(cell).collect();
        let _ = writeln!(
            text,
            "| {} | {} | {}, {} ms | {} |",
            p.scene,
            p.vertices,
            p.method,
            significant(1e3 * p.step, 2),
            cells.join(" | ")
        );
    }
    if !without_end.is_empty() {
        let list = without_end.join(", ");
        let _ = writeln!(
            text,
            "\nNo run of these came to its end; the reasons stand in the CSV: {list}."
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_passes_without_contact_does_not_with_it() {
        let (mut system, start) = fall(0.3, 20).unwrap();
        let fell = |system: &System| {
            let how = (MethodKind::Xpbd, 1.0 / 60.0);
            run(("fall", 0.4), (system, &start), how, f64::INFINITY).unwrap()
        };
        system = system.with(|builder| {
            builder.contact.cloth_offset = 0.0;
        });
        let without = fell(&system);
        system = system.with(|builder| {
            builder.contact.cloth_offset = 2e-3;
        });
        let with = fell(&system);
        assert!(without.crossings > Some(10), "{without:?}");
        assert_eq!((with.crossings, with.pieces), (Some(0), 1), "{with:?}");
        let lost = Touched {
            scene: "sphere",
            failure: Some("not done".to_owned()),
            ..with.clone()
        };
        let three = [without.clone(), with.clone(), with];
        let text = contact_table(&[&three[..], &vec![lost; 3]].concat());
        assert!(
            text.contains("| fall | ") && !text.contains("| sphere"),
            "{text}"
        );
        assert!(
            text.contains("in the CSV: sphere by xpbd (17 ms).\n"),
            "{text}"
        );
    }
}
