//! Runs `toile flatten`.

use crate::arguments::Flatten;
use crate::output::{Failure, Output, count};
use serde_json::{Value, json};
use toile_session::{FlattenOptions, flatten_mesh};

/// A panel of a surface.
pub fn flatten(flatten: &Flatten, output: &Output) -> Result<Value, Failure> {
    let options = FlattenOptions {
        grain: flatten.grain,
        fabric: flatten.fabric.clone(),
        strain: flatten.strain,
        darts: usize::from(flatten.darts),
        ease: flatten.ease.as_metres(),
    };
    let report = flatten_mesh(&flatten.mesh, &options, &flatten.out)
        .map_err(|error| Failure::from(error).about(&flatten.mesh))?;
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
