//! Long runs of garments on bodies: every pattern that ships on women, men and children from small
//! to large.

use super::worn::Worn;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;
use toile_interchange::{write_atomically, write_measurements};
use toile_measure::{Measurements, Origin};
use toile_session::{Command, Figure, Quality, figure_named};
use toile_tests::{files_below, root};

/// A wearer: name, figure, and what is asked of the body (cm); the rest is predicted.
type Wearer = (&'static str, &'static str, [f64; 4]);

/// Height, bust, waist and hips.
const ASKED: [&str; 4] = ["height", "bust", "waist", "hips"];

/// Five women, five men and two children. Children are the average ones of their age.
const WEARERS: [Wearer; 12] = [
    ("woman-1", "woman", [152.0, 80.0, 64.0, 88.0]),
    ("woman-2", "woman", [160.0, 88.0, 71.0, 95.0]),
    ("woman-3", "woman", [166.0, 94.0, 78.0, 101.0]),
    ("woman-4", "woman", [172.0, 105.0, 91.0, 112.0]),
    ("woman-5", "woman", [178.0, 120.0, 108.0, 126.0]),
    ("man-1", "man", [165.0, 88.0, 76.0, 90.0]),
    ("man-2", "man", [172.0, 96.0, 84.0, 97.0]),
    ("man-3", "man", [178.0, 103.0, 92.0, 103.0]),
    ("man-4", "man", [184.0, 113.0, 104.0, 112.0]),
    ("man-5", "man", [190.0, 126.0, 120.0, 122.0]),
    ("child-4", "child-4", [0.0; 4]),
    ("child-10", "child-10", [0.0; 4]),
];

/// Header of `sizes.csv`.
const HEADER: &str = "pattern,body,body_crossings,cloth_crossings,residual,strain_p99_warp,strain_p99_weft,seam_gap_mm,wall_s";

/// What is asked.
struct Task {
    out: PathBuf,
    quality: Quality,
    /// Parts of the names of patterns and bodies to run; all where empty.
    names: Vec<String>,
}

fn parse(arguments: &[String]) -> Result<Task, String> {
    let mut task = Task {
        out: root().join("out/sizes"),
        quality: Quality::Preview,
        names: Vec::new(),
    };
    let mut rest = arguments.iter();
    while let Some(argument) = rest.next() {
        match argument.as_str() {
            "--out" => task.out = PathBuf::from(rest.next().ok_or("--out needs a folder")?),
            "--quality" => task.quality = super::quality_named(rest.next())?,
            option if option.starts_with("--") => return Err(format!("{option} is not known")),
            name => task.names.push(name.to_owned()),
        }
    }
    Ok(task)
}

/// Drapes every pattern on every body; fails where cloth crosses a body or cloth.
pub fn sizes(arguments: &[String]) -> Result<(), String> {
    let task = parse(arguments)?;
    std::fs::create_dir_all(&task.out).map_err(|error| error.to_string())?;
    let patterns = files_below(&root().join("patterns"), ".toile.json");
    let asked = |own: &str, kinds: &[&str]| {
        let mut named = task
            .names
            .iter()
            .filter(|name| kinds.iter().any(|kind| kind.contains(&***name)))
            .peekable();
        named.peek().is_none() || named.any(|name| own.contains(&**name))
    };
    let bodies = WEARERS.map(|wearer| wearer.0);
    let stems: Vec<String> = patterns.iter().map(|path| stem(path)).collect();
    let kinds: Vec<&str> = stems.iter().map(|stem| &**stem).collect();
    let mut table = format!("{HEADER}\n");
    println!("{HEADER}");
    let mut left = Vec::new();
    for (pattern, name) in patterns.iter().zip(&stems) {
        for wearer in WEARERS {
            if !asked(name, &kinds) || !asked(wearer.0, &bodies) {
                continue;
            }
            let place = format!("{name} on {}", wearer.0);
            match worn(pattern, &wearer, &task) {
                Ok((row, clean)) => {
                    let row = format!("{name},{},{row}", wearer.0);
                    println!("{row}");
                    let _ = writeln!(table, "{row}");
                    if !clean {
                        left.push(place);
                    }
                }
                Err(why) => {
                    println!("{name},{},{why}", wearer.0);
                    left.push(format!("{place} ({why})"));
                }
            }
            write_atomically(&task.out.join("sizes.csv"), table.as_bytes())
                .map_err(|error| error.to_string())?;
        }
    }
    match left.is_empty() {
        true => Ok(()),
        false => Err(format!("not clean or not at rest: {}", left.join(", "))),
    }
}

fn stem(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    name.trim_end_matches(".toile.json").to_owned()
}

/// The command that chooses a wearer.
fn dressed((name, figure, lengths): &Wearer, out: &Path) -> Result<Command, String> {
    let figure: Option<Figure> = figure_named(figure);
    if lengths[0] == 0.0 {
        return Ok(Command::SetBody {
            figure,
            measurements: None,
        });
    }
    let mut table = Measurements::new();
    for (name, value) in ASKED.iter().zip(lengths) {
        table
            .set(name, value * 0.01, Origin::Asked)
            .map_err(|error| error.to_string())?;
    }
    let file = out.join(format!("{name}.json"));
    let text = write_measurements(&table).map_err(|error| error.to_string())?;
    write_atomically(&file, text.as_bytes()).map_err(|error| error.to_string())?;
    Ok(Command::SetBody {
        figure,
        measurements: Some(file),
    })
}

/// One garment on one body: its row, and whether it is at rest and nothing crosses.
fn worn(pattern: &Path, wearer: &Wearer, task: &Task) -> Result<(String, bool), String> {
    let start = Instant::now();
    let Worn {
        run,
        measures,
        at_rest,
    } = super::worn::worn([
        Command::open(pattern),
        dressed(wearer, &task.out)?,
        Command::SetQuality {
            quality: task.quality,
        },
    ])?;
    let row = format!(
        "{},{},{:.2e},{:.4},{:.4},{:.3},{:.1}",
        measures.body_intersections,
        measures.self_intersections,
        measures.residual,
        measures.strain_p99[0],
        measures.strain_p99[1],
        run.gap_before_merging() * 1e3,
        start.elapsed().as_secs_f64()
    );
    let crossings = measures.body_intersections + measures.self_intersections;
    Ok((row, at_rest && crossings == 0))
}
