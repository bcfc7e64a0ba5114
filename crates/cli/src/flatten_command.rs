//! Runs `toile flatten`.

use crate::arguments::body_command;
use crate::flatten_arguments::Flatten;
use crate::output::{Failure, Output, count};
use serde_json::{Value, json};
use toile_session::{Command, FlattenOptions, SurfaceSource, flatten_to_panel};

/// A panel of a surface.
pub fn flatten(flatten: &Flatten, output: &Output) -> Result<Value, Failure> {
    let options = FlattenOptions {
        grain: flatten.grain,
        fabric: flatten.fabric.clone(),
        strain: flatten.strain,
        darts: usize::from(flatten.darts),
        ease: flatten.ease.as_metres(),
        loop_file: flatten.loop_file.clone(),
        edge: flatten.edge.as_ref().map(|edge| edge.as_metres()),
        follows_hollows: flatten.follow_hollows,
    };
    let source = source(flatten)?;
    let report = flatten_to_panel(&source, &options, &flatten.out).map_err(|error| {
        let failure = Failure::from(error);
        match &source {
            SurfaceSource::Mesh(path)
            | SurfaceSource::Body {
                path: Some(path), ..
            } => failure.about(path),
            SurfaceSource::Body { path: None, .. } => failure,
        }
    })?;
    output.say(format!(
        "{} of {}: surface {:.1} cm2, panel {:.1} cm2, energy {:.3} mJ, stretch within {:.1} % on 99 % of the area",
        count(report.triangles, "triangle"),
        report.fabric,
        report.surface_area_m2 * 1e4,
        report.panel_area_m2 * 1e4,
        report.energy_j * 1e3,
        report.stretch_99 * 1e2,
    ));
    for (k, dart) in report.darts.iter().enumerate() {
        output.say(format!(
            "dart {}: {:.1} cm deep, intake {:.1} mm, legs within {:.1} mm of straight",
            k + 1,
            dart.length_m * 1e2,
            dart.intake_m * 1e3,
            dart.bow_m * 1e3,
        ));
    }
    for note in &report.notes {
        output.warn(format!("note: {note}"));
    }
    for file in &report.files {
        output.say(format!("wrote {}", file.display()));
    }
    Ok(json!(report))
}

/// The surface that the options name.
fn source(flatten: &Flatten) -> Result<SurfaceSource, Failure> {
    if let Some(mesh) = &flatten.mesh {
        return Ok(SurfaceSource::Mesh(mesh.clone()));
    }
    let text = flatten.body.as_deref().unwrap_or_default();
    let refuse = |what: String| {
        Err(Failure::bad_input(format!(
            "--body: {what}; give woman, man, mean, dress-form, child-2 to child-14, a mannequin file, a file of measurements, \
             FIGURE:FILE, or a mesh"
        )))
    };
    match body_command(text) {
        Command::SetBody {
            figure: None,
            measurements: None,
        } => refuse(format!("{text:?} is no body")),
        Command::SetBody {
            measurements: Some(file),
            ..
        } if !toile_session::is_input(&file) => {
            refuse(format!("there is no file {}", file.display()))
        }
        Command::SetBody {
            figure,
            measurements: path,
        } => Ok(SurfaceSource::Body { figure, path }),
        _ => refuse(format!("{text:?} is no body")),
    }
}
