//! How long a garment takes to rest, many times over: the way there is chaotic, a start moved by
//! micrometres takes other steps, so one run says little.

use std::path::PathBuf;
use std::time::Instant;
use toile_drape::{GarmentRun, GarmentSetup, Stage};
use toile_geometry::Vec3;
use toile_session::{Command, Figure, OtherGarment, Quality, figure_named};
use toile_tests::root;

/// How far a placed vertex is moved along each axis at the most (m).
const MOVED: f64 = 1e-5;

/// Where the residual stands in a line.
const RESIDUAL: usize = 3;

/// What is asked.
struct Task {
    pattern: PathBuf,
    /// Patterns worn over it, innermost first.
    over: Vec<PathBuf>,
    /// The pattern's own where none is named.
    figure: Option<Figure>,
    quality: Quality,
    seeds: u64,
    /// Seconds after which a run is given up.
    limit: f64,
}

fn parse(arguments: &[String]) -> Result<Task, String> {
    let mut task = Task {
        pattern: root().join("patterns/t-shirt.toile.json"),
        over: Vec::new(),
        figure: None,
        quality: Quality::Fit,
        seeds: 8,
        limit: f64::INFINITY,
    };
    let mut rest = arguments.iter();
    while let Some(argument) = rest.next() {
        match argument.as_str() {
            "--quality" => task.quality = super::quality_named(rest.next())?,
            "--seeds" => {
                let count = rest.next().and_then(|text| text.parse().ok());
                task.seeds = count.filter(|n| *n > 0).ok_or("--seeds needs a number")?;
            }
            "--over" => {
                let file = rest.next().ok_or("--over needs a pattern")?;
                task.over.push(PathBuf::from(file));
            }
            "--body" => {
                let name = rest.next().ok_or("--body needs a figure")?;
                let figure = figure_named(name);
                task.figure = Some(figure.ok_or_else(|| format!("{name} is not a figure"))?);
            }
            "--limit" => {
                let seconds = rest.next().and_then(|text| text.parse().ok());
                task.limit = seconds
                    .filter(|s| *s > 0.0)
                    .ok_or("--limit needs seconds")?;
            }
            option if option.starts_with("--") => return Err(format!("{option} is not known")),
            file => task.pattern = PathBuf::from(file),
        }
    }
    Ok(task)
}

/// Drapes one garment, or several over one another, from so many starts, and prints steps and seconds of
/// each stage.
pub fn rest(arguments: &[String]) -> Result<(), String> {
    let task = parse(arguments)?;
    let over = task.over.iter().zip(2..);
    let others = over.map(|(path, layer)| OtherGarment {
        path: path.clone(),
        layer,
    });
    let mut commands = vec![
        Command::open(task.pattern.clone()),
        Command::SetQuality {
            quality: task.quality,
        },
        Command::SetLayers {
            layer: 1,
            others: others.collect(),
        },
    ];
    commands.extend(task.figure.map(|figure| Command::SetBody {
        figure: Some(figure),
        measurements: None,
    }));
    let setup = super::worn::prepared(commands)?;
    println!(
        "seed,vertices,sewing_steps,settling_steps,residual,sewing_s,swinging_s,settling_s,wall_s"
    );
    let asked = setup.rest.residual;
    let (mut lines, mut restless) = (Vec::new(), Vec::new());
    for seed in 0..task.seeds {
        let line = draped(setup.clone(), seed, task.limit)?;
        println!("{seed},{}", row(&line));
        if line[RESIDUAL] > asked {
            restless.push(seed.to_string());
        }
        // What was given up says nothing of the time it would have taken.
        lines.extend(line[RESIDUAL].is_finite().then_some(line));
    }
    let mean: Vec<f64> = (0..lines.first().map_or(0, Vec::len))
        .map(|column| lines.iter().map(|line| line[column]).sum::<f64>() / lines.len() as f64)
        .collect();
    if !lines.is_empty() {
        println!("mean of {},{}", lines.len(), row(&mean));
    }
    match restless.is_empty() {
        true => Ok(()),
        false => Err(format!("not at rest: {}", restless.join(", "))),
    }
}

fn row(line: &[f64]) -> String {
    let numbers: Vec<String> = line.iter().map(|number| format!("{number:.3}")).collect();
    numbers.join(",")
}

/// One run: what stands in the header.
fn draped(mut setup: GarmentSetup, seed: u64, limit: f64) -> Result<Vec<f64>, String> {
    for (v, place) in setup.levels[0].cloth.positions.iter_mut().enumerate() {
        *place += moved(seed, v as u64) * MOVED;
    }
    let start = Instant::now();
    let mut run = GarmentRun::new(setup).map_err(|error| error.to_string())?;
    let mut seconds = [0.0; 3];
    while start.elapsed().as_secs_f64() < limit {
        let place = match run.progress().stage {
            Stage::Sewing => 0,
            Stage::Swinging => 1,
            Stage::Settling => 2,
            Stage::Finished => break,
        };
        let step = Instant::now();
        run.advance().map_err(|error| error.to_string())?;
        seconds[place] += step.elapsed().as_secs_f64();
    }
    let [sewing, settling] = run.steps().map(|steps| steps as f64);
    let vertices = run.state.positions.len() as f64;
    let residual = match run.progress().stage {
        Stage::Finished => run.progress().residual,
        _ => f64::INFINITY,
    };
    let mut line = vec![vertices, sewing, settling, residual];
    line.extend(seconds);
    line.push(start.elapsed().as_secs_f64());
    Ok(line)
}

/// A direction within the cube of side 2, none for the first seed (splitmix; Steele et al. 2014).
fn moved(seed: u64, vertex: u64) -> Vec3 {
    if seed == 0 {
        return Vec3::zeros();
    }
    let number = |axis: u64| {
        let mut z = (seed << 40 | vertex << 2 | axis).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    Vec3::new(number(0), number(1), number(2))
}
