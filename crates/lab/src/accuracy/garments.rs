//! Garments from pattern to report, as `toile make` and `toile drape` make them.

use super::patterns::{failed, scratch, tell};
use super::{Content, markdown};
use crate::LabError;
use serde_json::Value;
use std::path::{Path, PathBuf};
use toile_session::{
    Command, Figure, OtherGarment, Quality, SAMPLES, Session, SessionError, Watcher,
};

/// Qualities of the garments, with their names.
const QUALITIES: [(Quality, &str); 2] = [(Quality::Preview, "preview"), (Quality::Fit, "fit")];

/// Outfits, innermost garment first, with the paths of the patterns that ship.
const OUTFITS: [(&str, [&str; 3]); 2] = [
    (
        "trousers, T-shirt, poncho",
        ["sample:trousers", "sample:t-shirt", "sample:poncho"],
    ),
    (
        "gathered skirt, T-shirt, poncho",
        ["sample:gathered-skirt", "sample:t-shirt", "sample:poncho"],
    ),
];

/// What `report.json` and `timing.json` of a job say.
struct Report {
    report: Value,
    timing: Value,
}

impl Report {
    /// Does a job, exports it into a folder, and reads what it reports there.
    fn of(
        commands: &[Command],
        (folder, watcher): (&Path, &mut dyn Watcher),
    ) -> Result<Self, SessionError> {
        let export = [Command::export(folder)];
        let commands: Vec<Command> = commands.iter().chain(&export).cloned().collect();
        Session::new().execute_all(&commands, watcher)?;
        Ok(Self {
            report: json(&folder.join("report.json")),
            timing: json(&folder.join("timing.json")),
        })
    }

    /// Net force over weight, or a dash.
    fn residual(&self) -> String {
        let value = self.report["residual"].as_f64();
        value.map_or("-".to_owned(), |value| format!("{value:.1e}"))
    }

    /// A count of the report, or a dash.
    fn count(&self, pointer: &str) -> String {
        let value = self.report.pointer(pointer).and_then(Value::as_u64);
        value.map_or("-".to_owned(), |value| value.to_string())
    }

    /// A number of the report times a factor, with so many decimals, or a dash.
    fn scaled(&self, pointer: &str, factor: f64, decimals: usize) -> String {
        let value = self.report.pointer(pointer).and_then(Value::as_f64);
        value.map_or("-".to_owned(), |value| {
            format!("{:.decimals$}", factor * value)
        })
    }

    /// Stretch along warp and weft (%).
    fn stretch(&self, name: &str) -> String {
        let direction = |direction: &str| self.scaled(&format!("/{name}/{direction}"), 100.0, 1);
        format!("{} / {}", direction("warp"), direction("weft"))
    }

    /// Wall and processor time (s).
    fn times(&self) -> String {
        let time = |name: &str| {
            let value = self.timing[name].as_f64();
            value.map_or("-".to_owned(), |value| format!("{value:.1}"))
        };
        format!("{} / {}", time("wall_s"), time("cpu_s"))
    }

    /// Sum of a count over all layers.
    fn over_layers(&self, name: &str) -> String {
        let layers = self.report["layers"].as_array();
        let counts = layers.map(|layers| layers.iter().filter_map(|layer| layer[name].as_u64()));
        counts.map_or("-".to_owned(), |counts| counts.sum::<u64>().to_string())
    }
}

/// A file that a job has written; nothing if it is not there or no JSON.
fn json(path: &Path) -> Value {
    let text = std::fs::read_to_string(path).unwrap_or_default();
    serde_json::from_str(&text).unwrap_or_default()
}

/// `toile make` of each pattern in each quality.
pub(super) fn one_by_one(watcher: &mut dyn Watcher) -> Result<Content, LabError> {
    let folder = scratch()?;
    let mut rows = Vec::new();
    let count = SAMPLES.len() * QUALITIES.len();
    for (quality, quality_name) in QUALITIES {
        for (path, pattern) in SAMPLES {
            let name = format!("{pattern}, {quality_name}");
            tell(watcher, ("garments", rows.len(), count), &name)?;
            let share = rows.len() as f64 / count as f64;
            let mut follow = |stage: &str, done: f64, _: &str| {
                let detail = format!("{name}, {stage}");
                watcher.progress("garments", share + done / count as f64, &detail)
            };
            let commands = [
                Command::open(path),
                Command::SetQuality { quality },
                Command::Check,
                Command::Nest,
                Command::Assemble,
                Command::drape(),
            ];
            rows.push(match Report::of(&commands, (folder.path(), &mut follow)) {
                Ok(report) => vec![
                    name.clone(),
                    report.count("/vertices"),
                    report.residual(),
                    match report.report["steps"]["sewing"].as_u64() {
                        Some(0) => "no seam".to_owned(),
                        _ => report.scaled("/seam_gap_max_m", 1e3, 2),
                    },
                    report.stretch("strain_p99"),
                    report.stretch("strain_max"),
                    format!(
                        "{}, {}",
                        report.count("/body_intersections"),
                        report.count("/self_intersections")
                    ),
                    format!(
                        "{} + {}",
                        report.count("/steps/sewing"),
                        report.count("/steps/settling")
                    ),
                    report.times(),
                ],
                Err(error) => failed(&name, &error)?,
            });
        }
    }
    let columns = [
        "garment",
        "vertices",
        "residual",
        "seam gap, mm",
        "stretch of 99 %, % warp / weft",
        "most, %",
        "crossings: body, cloth",
        "steps: sewing + settling",
        "wall / processor time, s",
    ];
    Ok(markdown(&columns, rows).into())
}

/// `toile drape` of each outfit.
pub(super) fn layered(watcher: &mut dyn Watcher) -> Result<Content, LabError> {
    let folder = scratch()?;
    let mut rows = Vec::new();
    for (number, (name, patterns)) in OUTFITS.into_iter().enumerate() {
        tell(watcher, ("layers", number, OUTFITS.len()), name)?;
        let share = number as f64 / OUTFITS.len() as f64;
        let mut follow = |stage: &str, done: f64, _: &str| {
            let detail = format!("{name}, {stage}");
            watcher.progress("layers", share + done / OUTFITS.len() as f64, &detail)
        };
        let [inner, others @ ..] = patterns.map(PathBuf::from);
        let others = others.into_iter().zip(2..);
        let commands = [
            Command::open(inner),
            Command::SetLayers {
                layer: 1,
                others: others
                    .map(|(path, layer)| OtherGarment { path, layer })
                    .collect(),
            },
            Command::SetBody {
                figure: Some(Figure::Woman),
                measurements: None,
            },
            Command::SetQuality {
                quality: Quality::Preview,
            },
            Command::Check,
            Command::Assemble,
            Command::drape(),
        ];
        rows.push(match Report::of(&commands, (folder.path(), &mut follow)) {
            Ok(report) => vec![
                name.to_owned(),
                report.count("/vertices"),
                report.count("/body_intersections"),
                report.count("/self_intersections"),
                report.over_layers("outer_intersections"),
                report.over_layers("astray"),
                report.residual(),
                report.times(),
            ],
            Err(error) => failed(name, &error)?,
        });
    }
    let columns = [
        "garments",
        "vertices",
        "body crossings",
        "cloth crossings",
        "layer crossings",
        "astray",
        "residual",
        "wall / processor time, s",
    ];
    Ok(markdown(&columns, rows).into())
}
