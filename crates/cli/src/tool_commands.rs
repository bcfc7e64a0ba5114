//! Commands that need no session.

use crate::arguments::{Body, FramesTask, Mesh, Run};
use crate::bar::Bar;
use crate::output::{Failure, Made, Output, count};
use serde_json::{Value, json};
use std::path::Path;
use std::sync::Arc;
use toile_geometry::Duration;
use toile_measure::Origin;
use toile_session::{
    AskedStance, BodyChoice, BodyReport, BodySource, Description, Figure, Fit, FramesExport,
    Moment, PersonFile, PictureOptions, Project, RunOptions, SizeChoice, edit_body, export_frames,
    figure_named, fit_mesh, make_body, measure_mesh, mesh_panels, open_body_edits, open_mannequin,
    open_measurements, run_scene, stretch_body,
};

/// Triangulated panels.
pub fn mesh(mesh: &Mesh, output: &Output) -> Result<Value, Failure> {
    let (quality, notes) = mesh_panels(
        &mesh.pattern,
        mesh.size.as_deref(),
        mesh.edge.as_metres(),
        &mesh.out,
    )
    .map_err(|error| Failure::from(error).about(&mesh.pattern))?;
    for note in &notes {
        output.warn(format!("note: {note}"));
    }
    output.say(format!(
        "{} triangles, edges {:.1} mm on average ({:.1} to {:.1} mm), smallest angle {:.1} degrees away from sharp corners",
        quality.triangles,
        quality.mean_edge * 1e3,
        quality.shortest_edge * 1e3,
        quality.longest_edge * 1e3,
        quality.smallest_free_angle.to_degrees(),
    ));
    output.say(format!("wrote {}", mesh.out.display()));
    Ok(json!({
        "files": [mesh.out],
        "triangles": quality.triangles,
        "mean_edge_m": quality.mean_edge,
        "shortest_edge_m": quality.shortest_edge,
        "longest_edge_m": quality.longest_edge,
        "smallest_angle_rad": quality.smallest_angle,
        "smallest_free_angle_rad": quality.smallest_free_angle,
        "under_20_degrees": quality.under_20,
    }))
}

/// A mannequin.
pub fn body(body: &Body, output: &Output) -> Result<Value, Failure> {
    if let Some(mesh) = &body.mesh {
        return measured_mesh(mesh, body, output);
    }
    let figure = figure_named(&body.figure).ok_or_else(|| {
        Failure::bad_input(format!(
            "there is no figure {:?}; choose woman, man, mean, dress-form, or child-2, child-4, ... child-14",
            body.figure
        ))
    })?;
    let (choice, mut notes) = chosen_body(body, figure)?;
    let project = Project {
        body: choice,
        ..Project::default()
    };
    let moment = body.motion.clone().map(|motion| Moment {
        motion,
        blend: body.blend.clone(),
        time: body.time.map_or(0.0, Duration::as_seconds),
    });
    let is_of_mesh = body.landmarks.is_some() || body.stance.asked() != AskedStance::default();
    if is_of_mesh && body.fit.is_none() {
        return Err(Failure::bad_input(
            "--landmarks, --up, --forward and --unit go with --mesh or --fit".to_owned(),
        ));
    }
    let fit = match &body.fit {
        Some(mesh) => Some(fitted_mesh(mesh, figure, body, output)?),
        None => None,
    };
    let described = match (&fit, &body.mannequin) {
        (Some(fit), _) => Some(fit.description.clone()),
        (None, Some(path)) => Some(open_mannequin(path).map_err(Failure::from)?),
        (None, None) => None,
    };
    let stretch = body.stretch.asked()?;
    let described = match &stretch {
        Some(_) if body.measurements.is_some() => {
            return Err(Failure::bad_input(
                "--proportions, --heads, --stature and the ratios scale a body as it is: leave out --measurements, or give lengths there".to_owned(),
            ));
        }
        Some(stretch) => Some(stretch_body(described, figure, stretch).map_err(Failure::from)?),
        None => described,
    };
    let described = match &body.edits {
        Some(edits) => Some(edited_body(edits, described, &project)?),
        None => described,
    };
    let source = match &described {
        Some(description) => BodySource::Described(description),
        None => BodySource::Wearer(&project),
    };
    let report = make_body(source, moment.as_ref(), &body.out).map_err(|error| {
        let failure = Failure::from(error);
        match body.measurements.as_ref().or(body.mannequin.as_ref()) {
            Some(path) => failure.about(path),
            None => failure,
        }
    })?;
    notes.extend(report.notes.iter().cloned());
    for note in &notes {
        output.warn(format!("note: {note}"));
    }
    body_table(&report, output);
    output.say(format!("{:.2} head lengths tall", report.proportions.heads));
    let asked = stretch.as_ref().and_then(|s| s.proportions.as_ref());
    let missed = asked.map_or_else(Vec::new, |asked| asked.missed_by(&report.proportions));
    for (name, asked, got) in &missed {
        output.warn(format!(
            "note: {name}: asked {asked:.2}, got {got:.2} head lengths, the nearest that this body comes to: its chin moves from ring to ring of the skin"
        ));
    }
    output.say(format!(
        "wrote {} ({} compared)",
        body.out.display(),
        count(report.rows.len(), "measurement")
    ));
    let listed: Vec<Value> = report
        .rows
        .iter()
        .map(|row| {
            let unit = if row.is_angle() { "rad" } else { "m" };
            json!({ "name": row.name, "asked": row.asked, "got": row.got, "unit": unit, "origin": row.origin })
        })
        .collect();
    let conflicts: Vec<Value> = report
        .conflicts
        .iter()
        .map(|c| {
            let gap = if c.is_angle() { "gap_rad" } else { "gap_m" };
            json!({ "names": c.names, gap: c.gap, "why": c.why })
        })
        .collect();
    let mut made = json!({
        "files": [body.out],
        "measurements": listed,
        "not_taken": report.untaken,
        "conflicts": conflicts,
        "notes": notes,
        "heads": report.proportions.heads,
        "proportions_missed": missed.iter().map(|(name, asked, got)| {
            json!({ "name": name, "asked": asked, "got": got })
        }).collect::<Vec<_>>(),
    });
    if let Some(fit) = &fit {
        let m = &fit.misfit;
        made["fit"] = json!({
            "primitives": m.primitives,
            "sections": m.sections,
            "radial_rms_m": m.radial,
            "radial_max_m": m.radial_max,
            "girth_rms_m": m.girth,
            "girth_max_m": m.girth_max,
            "trunk_legs_arms_radial_rms_m": m.parts,
            "self_crossings": m.self_crossings,
            "levels": m.levels,
            "moved_by_m": [fit.shift.x, fit.shift.y, fit.shift.z],
            "left_out": fit.dropped,
        });
    }
    Ok(made)
}

/// The body of a figure or of a file of measurements, and what was taken of the file.
fn chosen_body(body: &Body, figure: Figure) -> Result<(BodyChoice, Vec<String>), Failure> {
    let Some(path) = &body.measurements else {
        return Ok((BodyChoice::Sample(figure), Vec::new()));
    };
    let size = SizeChoice {
        size: body.size.map(|size| size / 100.0),
        height: body.height.map(|height| height.as_metres()),
    };
    let (table, notes) = open_measurements(path, size)?;
    let choice = BodyChoice::Measured {
        figure,
        path: Some(path.clone()),
        measurements: Arc::new(table),
    };
    Ok((choice, notes))
}

/// A body with its ellipsoids edited as a file says.
fn edited_body(
    edits: &Path,
    described: Option<Description>,
    project: &Project,
) -> Result<Description, Failure> {
    let list = open_body_edits(edits).map_err(Failure::from)?;
    edit_body(described, project, &list).map_err(|error| Failure::from(error).about(edits))
}

/// The file of somebody's mesh, with what the options say of it.
fn person<'a>(mesh: &'a Path, body: &'a Body) -> PersonFile<'a> {
    PersonFile {
        mesh,
        landmarks: body.landmarks.as_deref(),
        stance: body.stance.asked(),
    }
}

/// A mannequin fitted to a mesh, with what it misses it by.
fn fitted_mesh(mesh: &Path, figure: Figure, body: &Body, output: &Output) -> Result<Fit, Failure> {
    let (fit, notes) = fit_mesh(&person(mesh, body), figure).map_err(Failure::from)?;
    for note in notes {
        output.warn(format!("note: {note}"));
    }
    let m = &fit.misfit;
    output.say(format!(
        "{} primitives; over {} level sections from ankles to chin, without hands: radial {:.2} mm rms ({:.1} at most), girth {:.2} mm rms ({:.1} at most)",
        m.primitives,
        m.sections,
        m.radial * 1e3,
        m.radial_max * 1e3,
        m.girth * 1e3,
        m.girth_max * 1e3,
    ));
    if m.self_crossings > 0 {
        output.say(format!(
            "its skin crosses itself in {} of triangles",
            count(m.self_crossings, "pair")
        ));
    }
    if !fit.dropped.is_empty() {
        output.warn(format!(
            "note: left out, since no body has what the tape found: {}; give better --landmarks",
            fit.dropped.join(", ")
        ));
    }
    if fit.shift.norm() > 0.0 {
        output.say(format!(
            "moved by ({:.4}, {:.4}, {:.4}) m to stand on y = 0 with its middle at x = 0",
            fit.shift.x, fit.shift.y, fit.shift.z,
        ));
    }
    Ok(fit)
}

/// What a tape finds on somebody's mesh.
fn measured_mesh(mesh: &Path, body: &Body, output: &Output) -> Result<Value, Failure> {
    let found = measure_mesh(&person(mesh, body), &body.out).map_err(Failure::from)?;
    for note in &found.notes {
        output.warn(format!("note: {note}"));
    }
    for (name, measured) in found.measurements.iter() {
        output.say(format!("{name:<22} {:>10.2} cm", measured.value * 100.0));
    }
    output.say(format!("wrote {}", body.out.display()));
    let listed: Vec<Value> = found
        .measurements
        .iter()
        .map(|(name, m)| json!({ "name": name, "got": m.value, "unit": "m" }))
        .collect();
    Ok(json!({
        "files": [body.out],
        "measurements": listed,
        "landmarks": found.landmarks,
        "notes": found.notes,
    }))
}

/// The table of what was asked for or predicted and what the body has.
fn body_table(report: &BodyReport, output: &Output) {
    output.say(format!(
        "{:<22} {:>10} {:>10} {:>8}",
        "measurement", "asked", "got", "gap"
    ));
    for row in &report.rows {
        let (scale, unit) = if row.is_angle() {
            (180.0 / std::f64::consts::PI, "deg")
        } else {
            (100.0, "cm")
        };
        let predicted = match row.origin {
            Origin::Asked => "",
            Origin::Predicted => " (predicted)",
        };
        output.say(format!(
            "{:<22} {:>10.2} {:>10.2} {:>8.2} {unit}{predicted}",
            row.name,
            row.asked * scale,
            row.got * scale,
            rounded((row.got - row.asked) * scale),
        ));
    }
    for name in &report.untaken {
        output.say(format!("not taken on a standing body: {name}"));
    }
    for conflict in &report.conflicts {
        let (scale, unit) = match conflict.is_angle() {
            true => (1f64.to_degrees(), "degrees"),
            false => (100.0, "cm"),
        };
        output.say(format!(
            "conflict of {:.1} {unit}: {}: {}",
            conflict.gap * scale,
            conflict.names.join(", "),
            conflict.why
        ));
    }
}

/// To two decimals, and no negative zero.
fn rounded(value: f64) -> f64 {
    (value * 100.0).round() / 100.0 + 0.0
}

/// Recorded frames in another format.
pub fn frames(task: &FramesTask, output: &Output) -> Result<Value, Failure> {
    let export = FramesExport {
        object: task.object.clone(),
        frame: task.frame,
    };
    let outcome = export_frames(&task.frames, &task.out, &export)
        .map_err(|error| Failure::from(error).about(&task.frames))?;
    for note in &outcome.notes {
        output.warn(format!("note: {note}"));
    }
    output.say(format!("read {}", count(outcome.frames, "frame")));
    match &outcome.files[..] {
        [first, .., last] if outcome.files.len() > 8 => output.say(format!(
            "wrote {} files, {} to {}",
            outcome.files.len(),
            first.display(),
            last.display()
        )),
        files => files
            .iter()
            .for_each(|file| output.say(format!("wrote {}", file.display()))),
    }
    Ok(json!({ "files": outcome.files, "frames": outcome.frames, "warnings": outcome.notes }))
}

/// Simulates a scene.
pub fn run(run: &Run, output: &Output) -> Result<Made, Failure> {
    let options = RunOptions {
        checkpoint_step: run.checkpoint,
        resume: run.resume,
        restart: run.restart,
        give_up: run.give_up.map(Duration::as_seconds),
        pictures: PictureOptions {
            times: run.picture.clone(),
            of: run.picture_of.clone(),
        },
    };
    let outcome = run_scene(&run.scene, &run.out, &options, &mut Bar::new())
        .map_err(|error| Failure::from(error).about(&run.scene))?;
    let report = &outcome.report;
    for warning in report["warnings"].as_array().into_iter().flatten() {
        output.warn(format!("note: {}", warning.as_str().unwrap_or_default()));
    }
    let number = |name: &str| report[name].as_f64().unwrap_or_default();
    let force = report["residual"].as_f64().map_or_else(
        || "no net force is told of this method".to_owned(),
        |residual| format!("net force {residual:.1e} of the weight"),
    );
    output.say(format!(
        "simulated {:.2} s by {} in {:.0} steps: {force}; {:.0} pairs of cloth and body triangles cross, {:.0} of cloth and cloth",
        number("time_s"),
        report["method"].as_str().unwrap_or_default(),
        number("steps"),
        number("body_intersections"),
        number("self_intersections"),
    ));
    for file in &outcome.files {
        output.say(format!("wrote {}", file.display()));
    }
    let made = json!({ "files": outcome.files, "report": outcome.report });
    Ok(Made::judged(made, Some(&outcome.verdict)))
}
