//! Clothes in real time against the method as published: the six rows of the paper's table, the
//! cost by vertices, and how many characters a thread moves.

use crate::LabError;
use crate::clock::Clock;
use crate::published::Published;
use crate::timed::Timed;
use std::fmt::Write;
use toile_realtime::{
    Blending, Character, Ellipsoids, Field, Garment, GarmentSettings, RealtimeError,
};
use toile_session::woman_character;

/// Time of a frame (s).
const FRAME: f32 = 1.0 / 60.0;

/// Frames before the clock starts, frames timed, and runs in turn of which the least counts.
const WARM_UP: usize = 60;
const FRAMES: usize = 240;
const RUNS: usize = 5;

/// Distance of the garments from the ellipsoids (m).
const OFFSET: f32 = 0.006;

type Mesh = (Vec<[f32; 3]>, Vec<[u32; 3]>);

#[derive(Clone, Copy, PartialEq)]
enum Adjustment {
    Gravity,
    Shape,
}

/// The paper's garments: their vertices.
const LARGE: [usize; 2] = [911, 944];
const SMALL: [usize; 2] = [464, 454];

/// A tube wound of one thread of vertices, `round` a turn, between two heights about an axis: any
/// number of vertices, a little farther out than the ellipsoids reach at their height.
fn tube(field: &Field, count: usize, [top, bottom]: [[f32; 3]; 2], largest: f32) -> Mesh {
    // About as far apart along as round.
    let girth = 0.75 * largest * std::f32::consts::TAU;
    let round = ((count as f32 * girth / (top[1] - bottom[1])).sqrt() as usize).max(8);
    let positions = (0..count).map(|k| {
        let share = k as f32 / (count - 1) as f32;
        let axis: [f32; 3] = std::array::from_fn(|i| top[i] + share * (bottom[i] - top[i]));
        let angle = std::f32::consts::TAU * k as f32 / round as f32;
        let radius = reach(field, axis, largest) + 0.012;
        on_circle(axis, angle, radius)
    });
    let positions: Vec<[f32; 3]> = positions.collect();
    let round = round as u32;
    let triangles = (0..count as u32 - round - 1)
        .flat_map(|k| [[k, k + round, k + 1], [k + 1, k + round, k + round + 1]])
        .collect();
    (positions, triangles)
}

/// A place round an upright axis.
fn on_circle(axis: [f32; 3], angle: f32, radius: f32) -> [f32; 3] {
    [
        axis[0] + radius * angle.sin(),
        axis[1],
        axis[2] + radius * angle.cos(),
    ]
}

/// How far the ellipsoids reach round an axis at its height, no farther than the largest radius.
fn reach(field: &Field, axis: [f32; 3], largest: f32) -> f32 {
    let mut radii = (1..100).map(|step| step as f32 * largest / 100.0);
    let is_reached = |radius: &f32| {
        let angles = (0..48).map(|k| std::f32::consts::TAU * k as f32 / 48.0);
        let mut places = angles.map(|angle| on_circle(axis, angle, *radius));
        places.any(|p| field.contains(p))
    };
    radii.rfind(is_reached).unwrap_or(0.3 * largest)
}

/// A blouse without sleeves: a tube round the trunk.
fn blouse(field: &Field, count: usize) -> Mesh {
    tube(field, count, [[0.0, 1.24, 0.0], [0.0, 0.86, 0.0]], 0.22)
}

/// Trousers without a seat: a tube round each leg, below where the thighs touch.
fn trousers(field: &Field, count: usize) -> Mesh {
    let leg = |side: f32, count| {
        let ends = [[side * 0.105, 0.62, 0.0], [side * 0.13, 0.12, -0.03]];
        tube(field, count, ends, 0.09)
    };
    let (mut positions, mut triangles) = leg(1.0, count / 2);
    let first = positions.len() as u32;
    let (others, more) = leg(-1.0, count - count / 2);
    positions.extend(others);
    triangles.extend(more.into_iter().map(|t| t.map(|v| v + first)));
    (positions, triangles)
}

/// What a run of frames cost and came to.
#[derive(Clone, Copy)]
struct Outcome {
    /// Processor time a frame (us).
    cost: f64,
    /// Most vertices inside an ellipsoid of their own group and pinched between groups.
    inside: usize,
    pinched: usize,
    /// Shortest and longest edge over rest of all frames.
    edges: [f32; 2],
}

impl Outcome {
    const NONE: Self = Self {
        cost: f64::INFINITY,
        inside: 0,
        pinched: 0,
        edges: [f32::INFINITY, 0.0],
    };

    fn take(&mut self, [low, high]: [f32; 2]) {
        self.edges = [self.edges[0].min(low), self.edges[1].max(high)];
    }
}

/// A row of the table: garments with their adjustments.
struct Row<'a> {
    name: &'a str,
    clothes: Vec<(Mesh, Adjustment)>,
}

/// Runs the frames of a walk; `each` adjusts, `after` looks at what came out. Only adjusting and
/// moving the ellipsoids is timed.
fn walked<T>(
    ellipsoids: &Ellipsoids,
    subject: &mut T,
    each: impl Fn(&mut T, &Ellipsoids),
) -> Result<f64, RealtimeError> {
    let mut ellipsoids = ellipsoids.clone();
    ellipsoids.start("walk", 0.5)?;
    for _ in 0..WARM_UP {
        ellipsoids.advance(FRAME);
        each(subject, &ellipsoids);
    }
    let clock = Clock::start();
    for _ in 0..FRAMES {
        ellipsoids.advance(FRAME);
        each(subject, &ellipsoids);
    }
    Ok(clock.spent() / FRAMES as f64 * 1e6)
}

fn adjust(garments: &mut [(Garment, Adjustment)], ellipsoids: &Ellipsoids) {
    for (garment, adjustment) in garments {
        match adjustment {
            Adjustment::Gravity => garment.adjust_by_gravity(ellipsoids, FRAME),
            Adjustment::Shape => garment.adjust_by_shape(ellipsoids, FRAME),
        }
    }
}

fn adjust_as_published(garments: &mut [(Published, Adjustment)], ellipsoids: &Ellipsoids) {
    for (garment, adjustment) in garments {
        match adjustment {
            Adjustment::Gravity => garment.adjust_by_gravity(ellipsoids, FRAME),
            Adjustment::Shape => garment.adjust_by_shape(ellipsoids),
        }
    }
}

fn made(ellipsoids: &Ellipsoids, row: &Row) -> Result<Vec<(Garment, Adjustment)>, RealtimeError> {
    let settings = GarmentSettings {
        offset: OFFSET,
        ..GarmentSettings::default()
    };
    let garments = row
        .clothes
        .iter()
        .map(|((positions, triangles), adjustment)| {
            let garment = Garment::new(ellipsoids, positions, triangles, settings)?;
            Ok((garment, *adjustment))
        });
    garments.collect()
}

/// Ours and the published method, in turn.
fn compared(
    (character, ellipsoids): (&Character, &Ellipsoids),
    row: &Row,
) -> Result<[Outcome; 2], RealtimeError> {
    let mut outcomes = [Outcome::NONE; 2];
    for _ in 0..RUNS {
        let mut ours = made(ellipsoids, row)?;
        let cost = walked(ellipsoids, &mut ours, |garments, e| adjust(garments, e))?;
        outcomes[0].cost = outcomes[0].cost.min(cost);
        let mut theirs: Vec<(Published, Adjustment)> = row
            .clothes
            .iter()
            .map(|((positions, triangles), adjustment)| {
                let mesh = (&**positions, &**triangles);
                let made = Published::new(character, ellipsoids, mesh, OFFSET);
                (made, *adjustment)
            })
            .collect();
        let cost = walked(ellipsoids, &mut theirs, |garments, e| {
            adjust_as_published(garments, e);
        })?;
        outcomes[1].cost = outcomes[1].cost.min(cost);
        for (garment, _) in &theirs {
            outcomes[1].take(garment.edge_extremes());
        }
    }
    let mut ours = made(ellipsoids, row)?;
    let mut moving = ellipsoids.clone();
    moving.start("walk", 0.5)?;
    for _ in 0..WARM_UP + FRAMES {
        moving.advance(FRAME);
        adjust(&mut ours, &moving);
        for (garment, _) in &ours {
            outcomes[0].take(garment.edge_extremes());
            outcomes[0].inside = outcomes[0].inside.max(garment.inside_count());
            outcomes[0].pinched = outcomes[0].pinched.max(garment.pinched_count());
        }
    }
    Ok(outcomes)
}

/// Root mean square distance between the drapes of a standing figure after 2 s and after 30 s (m).
fn to_converged(ellipsoids: &Ellipsoids, mesh: &Mesh) -> Result<f64, RealtimeError> {
    let mut standing = ellipsoids.clone();
    standing.start("stand", 0.5)?;
    let row = Row {
        name: "",
        clothes: vec![(mesh.clone(), Adjustment::Gravity)],
    };
    let mut garments = made(ellipsoids, &row)?;
    let mut drapes = Vec::new();
    for frame in 0..1800 {
        standing.advance(FRAME);
        adjust(&mut garments, &standing);
        if frame == 120 || frame == 1799 {
            drapes.push(garments[0].0.positions().collect::<Vec<_>>());
        }
    }
    let squares = drapes[0]
        .iter()
        .zip(&drapes[1])
        .map(|(p, q)| (0..3).map(|k| f64::from(p[k] - q[k]).powi(2)).sum::<f64>());
    Ok((squares.sum::<f64>() / mesh.0.len() as f64).sqrt())
}

/// A line a + b n through points by least squares, and its largest deviation as a share.
fn fitted(points: &[[f64; 2]]) -> [f64; 3] {
    let n = points.len() as f64;
    let sum = |f: &dyn Fn(&[f64; 2]) -> f64| points.iter().map(f).sum::<f64>();
    let (x, y) = (sum(&|p| p[0]) / n, sum(&|p| p[1]) / n);
    let slope = sum(&|p| (p[0] - x) * (p[1] - y)) / sum(&|p| (p[0] - x).powi(2));
    let start = y - slope * x;
    let off = points
        .iter()
        .map(|p| ((start + slope * p[0]) / p[1] - 1.0).abs())
        .fold(0.0, f64::max);
    [start, slope, off]
}

/// Time that a pose of a character takes, by a blending, in the middle of a fade (us).
fn posed(ellipsoids: &Ellipsoids, blending: Blending) -> Result<f64, RealtimeError> {
    let mut least = f64::INFINITY;
    for _ in 0..RUNS {
        let mut moving = ellipsoids.clone();
        moving.set_blending(blending);
        moving.start("walk", 0.0)?;
        moving.advance(FRAME);
        moving.start("run", 60.0)?;
        let clock = Clock::start();
        for _ in 0..1000 {
            moving.advance(FRAME);
        }
        least = least.min(clock.spent() * 1e3);
    }
    Ok(least)
}

/// Measures everything into a report.
pub(crate) fn realtime(result: &mut Timed) -> Result<(), LabError> {
    let words = |what: String| LabError::Files { what };
    let character = woman_character().map_err(|error| words(error.to_string()))?;
    let report = measured(&character, result).map_err(|error| words(error.to_string()))?;
    result.report = Some(report);
    Ok(())
}

fn measured(character: &Character, result: &mut Timed) -> Result<String, RealtimeError> {
    let ellipsoids = Ellipsoids::new(character)?;
    let field = Field::new(&ellipsoids, OFFSET)?;
    let clock = Clock::start();
    let mut text = format!(
        "{} ellipsoids, walking at 60 Hz, one thread; microseconds of processor time a frame, ellipsoids included\n\n\
         | garments | vertices | published | ours | ratio | inside, pinched | edges, % | published edges, % |\n\
         |---|---|---|---|---|---|---|---|\n",
        ellipsoids.len()
    );
    use Adjustment::{Gravity, Shape};
    for (k, [above, below]) in [LARGE, SMALL].into_iter().enumerate() {
        let top = (blouse(&field, above), Gravity);
        let legs = (trousers(&field, below), Shape);
        let names = [
            ["blouse 1, gravity", "trousers 1, shape", "both 1"],
            ["blouse 2, gravity", "trousers 2, shape", "both 2"],
        ];
        let sets = [vec![top.clone()], vec![legs.clone()], vec![top, legs]];
        for (name, clothes) in names[k].into_iter().zip(sets) {
            let row = Row { name, clothes };
            let [ours, theirs] = compared((character, &ellipsoids), &row)?;
            let vertices: usize = row.clothes.iter().map(|(mesh, _)| mesh.0.len()).sum();
            let percent = |edges: [f32; 2]| edges.map(|e| (e - 1.0) * 100.0);
            let [a, b] = percent(ours.edges);
            let [c, d] = percent(theirs.edges);
            let _ = writeln!(
                text,
                "| {} | {vertices} | {:.0} | {:.0} | {:.3} | {}, {} | {a:.1} to {b:.1} | {c:.1} to {d:.1} |",
                row.name,
                theirs.cost,
                ours.cost,
                ours.cost / theirs.cost,
                ours.inside,
                ours.pinched
            );
            result.vertices = result.vertices.max(vertices);
            let key = format!("{}_ratio", row.name.replace([' ', ','], "_"));
            result.counted.insert(key, ours.cost / theirs.cost);
        }
    }
    text += &by_vertices(&ellipsoids, &field)?;
    text += &crowd(&ellipsoids, &field)?;
    let rms = to_converged(&ellipsoids, &blouse(&field, LARGE[0]))?;
    let [linear, slerp] = [
        posed(&ellipsoids, Blending::Linear)?,
        posed(&ellipsoids, Blending::Slerp)?,
    ];
    let _ = writeln!(
        text,
        "\nblouse 1 standing, after 2 s against after 30 s: {:.1} mm RMS\n\
         a pose amid a fade: linear {linear:.2} us, slerp {slerp:.2} us, ratio {:.2}",
        rms * 1e3,
        linear / slerp
    );
    result.wall_s = clock.wall();
    result.cpu_s = clock.cpu();
    Ok(text)
}

/// The cost of gravity from 455 to 1,855 vertices.
fn by_vertices(ellipsoids: &Ellipsoids, field: &Field) -> Result<String, RealtimeError> {
    let mut points = Vec::new();
    for count in [455, 800, 1150, 1500, 1855] {
        let row = Row {
            name: "",
            clothes: vec![(blouse(field, count), Adjustment::Gravity)],
        };
        let mut least = f64::INFINITY;
        for _ in 0..RUNS {
            let mut garments = made(ellipsoids, &row)?;
            least = least.min(walked(ellipsoids, &mut garments, |g, e| adjust(g, e))?);
        }
        points.push([count as f64, least]);
    }
    let [start, slope, off] = fitted(&points);
    let listed: Vec<String> = points
        .iter()
        .map(|[n, t]| format!("{n:.0}: {t:.0}"))
        .collect();
    Ok(format!(
        "\ngravity by vertices, us: {}; a = {start:.1} us, b = {:.1} ns a vertex, fits within {:.0} %\n",
        listed.join(", "),
        slope * 1e3,
        off * 100.0
    ))
}

/// How many characters in blouse and trousers a thread moves at 60 Hz.
fn crowd(ellipsoids: &Ellipsoids, field: &Field) -> Result<String, RealtimeError> {
    let row = Row {
        name: "",
        clothes: vec![
            (blouse(field, SMALL[0]), Adjustment::Gravity),
            (trousers(field, SMALL[1]), Adjustment::Shape),
        ],
    };
    const CHARACTERS: usize = 32;
    let mut all = Vec::new();
    for k in 0..CHARACTERS {
        let mut own = ellipsoids.clone();
        own.start("walk", 0.0)?;
        own.advance(0.031 * k as f32);
        all.push((own, made(ellipsoids, &row)?));
    }
    let mut least = f64::INFINITY;
    for _ in 0..RUNS {
        let clock = Clock::start();
        for _ in 0..30 {
            for (own, garments) in &mut all {
                own.advance(FRAME);
                adjust(garments, own);
            }
        }
        least = least.min(clock.spent() / 30.0);
    }
    Ok(format!(
        "\n{CHARACTERS} characters in {} vertices each: {:.2} ms a frame, so {:.0} at 60 Hz on one thread\n",
        SMALL[0] + SMALL[1],
        least * 1e3,
        CHARACTERS as f64 / (60.0 * least)
    ))
}
