//! Stability as files: CSV, SVG maps with the theoretical limits, a table.

use crate::csv::field;
use crate::stability::{Cell, Limit, Verdict};
use crate::{HardRun, LabError, Outcome};
use std::fmt::Write;
use toile_drape::{MethodKind, largest_frequency};
use toile_picture::{Axis, Chart, Drawing, Joined, Marker, Rgb, Series};

const STABLE: Rgb = [0.55, 0.75, 0.62];
const WRONG: Rgb = [0.95, 0.77, 0.35];
const UNSTABLE: Rgb = [0.80, 0.33, 0.25];

fn map(method: &'static str, limit: Option<f64>, cells: &[Cell]) -> Result<Drawing, LabError> {
    let mut series = Vec::new();
    for (verdict, colour, name) in [
        (Verdict::Stable, STABLE, "stable"),
        (Verdict::Wrong, WRONG, "wrong"),
        (Verdict::Unstable, UNSTABLE, "unstable"),
    ] {
        let own = cells
            .iter()
            .filter(|c| c.method == method && c.verdict == verdict);
        series.push(Series {
            name: name.to_owned(),
            colour,
            marker: Marker::Square,
            size: 24.0,
            joined: Joined::Not,
            points: own.map(|c| [c.stiffness, c.step]).collect(),
        });
    }
    if let Some(limit) = limit.filter(|l| *l > 0.0) {
        let mut points = Vec::new();
        for decade in 2..=14 {
            let stiffness = 10f64.powf(0.5 * f64::from(decade));
            let (system, rest) = crate::stability::hung(stiffness, false)?;
            points.push([stiffness, limit / largest_frequency(&system, &rest)]);
        }
        series.push(Series {
            name: format!("{limit:.3} / w"),
            colour: [0.1, 0.1, 0.12],
            marker: Marker::None,
            size: 0.0,
            joined: Joined::Dashed,
            points,
        });
    }
    let chart = Chart {
        title: method.to_owned(),
        x: Axis {
            range: Some([4e0, 2.5e7]),
            ..Axis::logarithmic("stretch stiffness [N/m]")
        },
        y: Axis {
            range: Some([5e-6, 0.2]),
            ..Axis::logarithmic("step [s]")
        },
        series,
        notes: Vec::new(),
        size: [440.0, 330.0],
    };
    Ok(chart.draw()?)
}

/// Name and content of every file of the stability map.
///
/// # Errors
/// A map cannot be drawn.
pub fn stability_files(
    cells: &[Cell],
    limits: &[Limit],
    hard: &[HardRun],
) -> Result<Vec<(String, String)>, LabError> {
    let mut text = "method,stiffness_N_per_m,step_s,verdict,detail\n".to_owned();
    for cell in cells {
        let verdict = format!("{:?}", cell.verdict).to_lowercase();
        let _ = writeln!(
            text,
            "{},{:e},{:e},{verdict},{}",
            cell.method,
            cell.stiffness,
            cell.step,
            field(&cell.detail)
        );
    }
    let maps = MethodKind::ALL
        .into_iter()
        .map(|(name, kind)| map(name, kind.stability_limit(), cells))
        .collect::<Result<Vec<_>, _>>()?;
    let mut bounds = "method,stiffness_N_per_m,theory_s,measured_s,ratio\n".to_owned();
    for limit in limits {
        let _ = writeln!(
            bounds,
            "{},{:e},{:.4e},{:.4e},{:.4}",
            limit.method,
            limit.stiffness,
            limit.theory,
            limit.measured,
            limit.measured / limit.theory
        );
    }
    let mut cases = "case,method,outcome,detail\n".to_owned();
    for run in hard {
        let outcome = format!("{:?}", run.outcome).to_lowercase();
        let _ = writeln!(
            cases,
            "{},{},{outcome},{}",
            field(run.case),
            run.method,
            field(&run.detail)
        );
    }
    Ok(vec![
        ("stability.csv".to_owned(), text),
        (
            "stability.svg".to_owned(),
            Drawing::sheet(&maps, 3).to_svg(),
        ),
        ("limits.csv".to_owned(), bounds),
        ("hard-cases.csv".to_owned(), cases),
    ])
}

/// The limits and the hard cases as Markdown.
pub fn stability_table(limits: &[Limit], hard: &[HardRun]) -> String {
    let mut text = String::from(
        "| method | stiffness: limit / w, s; where it blows up, in units of that |\n|---|---|\n",
    );
    let mut methods: Vec<&str> = limits.iter().map(|limit| limit.method).collect();
    methods.sort_unstable();
    methods.dedup();
    for method in methods {
        let own = limits.iter().filter(|limit| limit.method == method);
        let each = own.map(|limit| {
            let ratio = limit.measured / limit.theory;
            format!(
                "{:.0e} N/m: {:.3e}; {ratio:.3}",
                limit.stiffness, limit.theory
            )
        });
        let each: Vec<String> = each.collect();
        let _ = writeln!(text, "| {method} | {} |", each.join(", "));
    }
    let mut cases: Vec<&str> = hard.iter().map(|run| run.case).collect();
    cases.dedup();
    text.push_str(
        "\n| hard case | sound | stopped with an error | slow | unsound |\n|---|---|---|---|---|\n",
    );
    for case in cases {
        let names = |outcome: Outcome| -> String {
            let own = hard
                .iter()
                .filter(|run| run.case == case && run.outcome == outcome);
            let names: Vec<&str> = own.map(|run| run.method).collect();
            if names.len() == MethodKind::ALL.len() {
                "all".to_owned()
            } else if names.is_empty() {
                "-".to_owned()
            } else {
                names.join(", ")
            }
        };
        let _ = writeln!(
            text,
            "| {case} | {} | {} | {} | {} |",
            names(Outcome::Sound),
            names(Outcome::Stopped),
            names(Outcome::Slow),
            names(Outcome::Unsound)
        );
    }
    text
}
