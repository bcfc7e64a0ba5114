//! The chart as files: CSV, SVG, and the table of which method to use when.

use crate::chart_contact::{contact_files, contact_table};
use crate::chart_data::{ChartData, Point};
use crate::check::significant;
use crate::csv::field;
use crate::{LabError, Resolved};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use toile_drape::MethodKind;
use toile_interchange::{read_text, write_all_atomically};
use toile_picture::{Axis, Chart, Joined, Marker, Series, palette};

fn csv(points: &[Point], step: &str, wall: &str) -> String {
    let mut text = format!(
        "scene,mesh,vertices,method,{step},most_iterations,{wall},cpu_ms,error_mm,best,failure\n"
    );
    for p in points {
        let number = |x: Option<f64>| x.map_or(String::new(), |x| significant(x, 5));
        let _ = writeln!(
            text,
            "{},{},{},{},{:.4e},{},{},{},{},{},{}",
            p.scene,
            p.mesh,
            p.vertices,
            p.method,
            p.step,
            p.iterations.map_or(String::new(), |n| n.to_string()),
            significant(p.wall_ms, 5),
            number(p.cpu_ms),
            number(p.error_mm),
            if p.best { "yes" } else { "" },
            field(p.failure.as_deref().unwrap_or("")),
        );
    }
    text
}

/// Notes under every chart, and under those of methods that iterate.
const CROSSES: &str = "crosses in the top row: failed or wrong; the reason stands in the CSV";
const ITERATIONS_AND_CROSSES: &str = "in brackets: iterations a step at the most; crosses in the top row: failed or wrong; the reason stands in the CSV";

/// A method's name, and the iterations it is given in a step where these are more than one: block
/// descent is given more of them than Newton's method.
fn named(point: &Point) -> String {
    match point.iterations {
        Some(most) if most > 1 => format!("{} ({most})", point.method),
        _ => point.method.to_owned(),
    }
}

/// A chart of the runs on one mesh.
fn mesh_chart(points: &[&Point], title: String, note: String, across: &str) -> Chart {
    let errors = points
        .iter()
        .filter(|p| p.failure.is_none())
        .filter_map(|p| p.error_mm);
    let highest = errors.clone().fold(f64::NEG_INFINITY, f64::max);
    let lowest = errors.filter(|e| *e > 0.0).fold(f64::INFINITY, f64::min);
    // Failures stand in a row of their own above the rest.
    let row = if highest > 0.0 { 4.0 * highest } else { 1.0 };
    let floor = (0.5 * lowest).min(0.25 * row).max(1e-9);
    let mut series = Vec::new();
    let mut front: Vec<[f64; 2]> = points
        .iter()
        .filter(|p| p.best)
        .filter_map(|p| Some([p.cost(), p.error_mm?]))
        .collect();
    front.sort_by(|a, b| a[0].total_cmp(&b[0]));
    series.push(Series {
        name: "front: nothing faster is nearer".to_owned(),
        colour: [0.86, 0.90, 0.80],
        marker: Marker::None,
        size: 0.0,
        joined: Joined::Band,
        points: front,
    });
    for (number, (name, _)) in MethodKind::ALL.into_iter().enumerate() {
        let own: Vec<&&Point> = points.iter().filter(|p| p.method == name).collect();
        if own.is_empty() {
            continue;
        }
        let good = own.iter().filter(|p| p.failure.is_none());
        let mut places: Vec<(f64, [f64; 2])> = good
            .filter_map(|p| Some((p.step, [p.cost(), p.error_mm?.max(floor)])))
            .collect();
        places.sort_by(|a, b| a.0.total_cmp(&b.0));
        series.push(Series::numbered(
            number,
            named(own[0]),
            places.iter().map(|p| p.1).collect(),
        ));
        series.push(Series {
            name: String::new(),
            colour: palette(number),
            marker: Marker::Cross,
            size: 9.0,
            joined: Joined::Not,
            points: own
                .iter()
                .filter(|p| p.failure.is_some())
                .map(|p| [p.cost(), row])
                .collect(),
        });
    }
    let words = if points.iter().any(|p| p.iterations.is_some()) {
        ITERATIONS_AND_CROSSES
    } else {
        CROSSES
    };
    Chart {
        title,
        x: Axis::logarithmic(across),
        y: Axis::logarithmic("RMS distance to the converged end [mm]"),
        series,
        notes: vec![note, words.to_owned()],
        size: [860.0, 520.0],
    }
}

/// Name and content of every file of the chart.
///
/// # Errors
/// A chart cannot be drawn.
pub fn chart_files(data: &ChartData) -> Result<Vec<(String, String)>, LabError> {
    let mut files = vec![
        (
            "motion.csv".to_owned(),
            csv(&data.motion, "step_s", "wall_ms_per_simulated_s"),
        ),
        (
            "rest.csv".to_owned(),
            csv(&data.rest, "residual", "wall_ms"),
        ),
    ];
    for (points, kind, across) in [
        (
            &data.motion,
            "motion",
            "processor time per simulated second [ms]",
        ),
        (&data.rest, "rest", "processor time to rest [ms]"),
    ] {
        let mut meshes: Vec<&str> = points.iter().map(|p| p.mesh.as_str()).collect();
        meshes.dedup();
        for mesh in meshes {
            let own: Vec<&Point> = points.iter().filter(|p| p.mesh == mesh).collect();
            let title = format!("{} ({} vertices): {kind}", own[0].scene, own[0].vertices);
            let known = data.agreement.iter().find(|a| a.mesh == mesh);
            let note = match (kind, known) {
                ("motion", Some(a)) => format!(
                    "converged end: {} at fine steps end {} mm apart",
                    a.by,
                    a.apart_mm.map_or("?".to_owned(), |x| significant(x, 2))
                ),
                _ => {
                    "converged end: the way to rest at a net force of 1e-4 of the weight".to_owned()
                }
            };
            let chart = mesh_chart(&own, title, note, across);
            // A mesh on which everything failed has no axes to show it on.
            if let Ok(drawing) = chart.draw() {
                files.push((
                    format!("{kind}-{}.svg", mesh.trim_end_matches(".obj")),
                    drawing.to_svg(),
                ));
            }
        }
    }
    if !data.contact.is_empty() {
        files.extend(contact_files(&data.contact)?);
    }
    Ok(files)
}

/// How discretisation stiffens, as a chart and a table.
///
/// # Errors
/// The chart cannot be drawn.
pub fn locking_files(found: &[Resolved]) -> Result<Vec<(String, String)>, LabError> {
    let mut text = "scene,mesh,Y_L2_over_D,elements,relative_error\n".to_owned();
    for point in found {
        let error = point
            .error
            .map_or("failed".to_owned(), |e| format!("{e:.4e}"));
        let _ = writeln!(
            text,
            "{},{},{:e},{},{error}",
            point.scene, point.mesh, point.stiffness, point.elements
        );
    }
    let mut drawings = Vec::new();
    for scene in ["cantilever", "hang"] {
        let mut series = Vec::new();
        let mut keys: Vec<(&str, f64)> = found.iter().map(|p| (p.mesh, p.stiffness)).collect();
        keys.sort_by(|a, b| a.0.cmp(b.0).then(a.1.total_cmp(&b.1)));
        keys.dedup();
        for (number, (mesh, stiffness)) in keys.into_iter().enumerate() {
            let own = found
                .iter()
                .filter(|p| p.scene == scene && p.mesh == mesh && p.stiffness == stiffness);
            let points = own
                .filter_map(|p| Some([p.elements as f64, p.error?.abs().max(1e-6)]))
                .collect();
            series.push(Series::numbered(
                number,
                format!("{mesh}, Y L2/D {stiffness:.0e}"),
                points,
            ));
        }
        let chart = Chart {
            title: format!("{scene}: error by elements along"),
            x: Axis::logarithmic("elements along"),
            y: Axis::logarithmic("relative error"),
            series,
            notes: vec![],
            size: [760.0, 440.0],
        };
        drawings.push(chart.draw()?);
    }
    let sheet = toile_picture::Drawing::sheet(&drawings, 1);
    Ok(vec![
        ("locking.csv".to_owned(), text),
        ("locking.svg".to_owned(), sheet.to_svg()),
    ])
}

/// Errors a reader may ask for (mm).
const ASKED: [f64; 3] = [10.0, 3.0, 1.0];

/// Which method to use when: for each mesh the fastest run within an error, as Markdown.
pub fn when_to_use(data: &ChartData) -> String {
    let mut text = String::from(
        "| scene | vertices | within 10 mm | within 3 mm | within 1 mm | failed runs |\n|---|---|---|---|---|---|\n",
    );
    let mut meshes: Vec<&str> = data.motion.iter().map(|p| p.mesh.as_str()).collect();
    meshes.dedup();
    for mesh in meshes {
        let own: Vec<&Point> = data.motion.iter().filter(|p| p.mesh == mesh).collect();
        let _ = write!(text, "| {} | {} |", own[0].scene, own[0].vertices);
        for asked in ASKED {
            let good = own
                .iter()
                .filter(|p| p.failure.is_none() && p.error_mm.is_some_and(|e| e <= asked));
            let fastest = good.min_by(|a, b| a.cost().total_cmp(&b.cost()));
            let _ = match fastest {
                Some(p) => write!(
                    text,
                    " {}, step {} ms: {} ms/s |",
                    named(p),
                    significant(1e3 * p.step, 2),
                    significant(p.cost(), 3)
                ),
                None => write!(text, " none |"),
            };
        }
        let failed = own.iter().filter(|p| p.failure.is_some()).count();
        let _ = writeln!(text, " {failed} of {} |", own.len());
    }
    text.push_str("\nTo rest, by the net force over the weight that was asked for:\n\n| scene | vertices | asked | fastest | processor ms | wall ms | distance to rest, mm |\n|---|---|---|---|---|---|---|\n");
    let mut meshes: Vec<&str> = data.rest.iter().map(|p| p.mesh.as_str()).collect();
    meshes.dedup();
    for mesh in meshes {
        let own: Vec<&Point> = data.rest.iter().filter(|p| p.mesh == mesh).collect();
        let tightest = own.iter().map(|p| p.step).fold(f64::INFINITY, f64::min);
        let asked = own
            .iter()
            .map(|p| p.step)
            .filter(|s| *s <= 1.01e-3)
            .fold(tightest, f64::max);
        let good = own
            .iter()
            .filter(|p| p.failure.is_none() && p.step == asked);
        let _ = match good.min_by(|a, b| a.cost().total_cmp(&b.cost())) {
            Some(p) => writeln!(
                text,
                "| {} | {} | {asked:.0e} | {} | {} | {} | {} |",
                p.scene,
                p.vertices,
                p.method,
                significant(p.cost(), 3),
                significant(p.wall_ms, 3),
                p.error_mm.map_or("-".to_owned(), |e| significant(e, 2))
            ),
            None => writeln!(
                text,
                "| {} | {} | {asked:.0e} | none | - | - | - |",
                own[0].scene, own[0].vertices
            ),
        };
    }
    if !data.contact.is_empty() {
        text.push_str(&contact_table(&data.contact));
    }
    text
}

/// A document with the part between two markers, `<!-- NAME -->` and `<!-- /NAME -->`, replaced;
/// the part is added at the end where there are none.
pub fn with_section(document: &str, name: &str, section: &str) -> String {
    let (open, close) = (format!("<!-- {name} -->"), format!("<!-- /{name} -->"));
    let whole = format!("{open}\n{}\n{close}", section.trim_end());
    match (document.find(&open), document.find(&close)) {
        (Some(from), Some(to)) if from < to => {
            format!(
                "{}{whole}{}",
                &document[..from],
                &document[to + close.len()..]
            )
        }
        _ => format!("{}\n\n{whole}\n", document.trim_end()),
    }
}

/// Writes named texts into a folder, whole or not at all.
///
/// # Errors
/// The folder cannot be written.
pub fn write_files(folder: &Path, files: &[(String, String)]) -> Result<Vec<PathBuf>, LabError> {
    write_all_atomically(folder, files).map_err(|error| LabError::Files {
        what: error.to_string(),
    })?;
    Ok(files.iter().map(|(name, _)| folder.join(name)).collect())
}

/// Refuses what long work could not be written to in the end, and makes nothing: the folder, or the
/// nearest one above it that exists, and the document, if any, that a section of is to be replaced.
///
/// # Errors
/// A file stands in the place of the folder, or it is read-only; the document cannot be read.
pub fn ready_to_write(folder: &Path, document: Option<&Path>) -> Result<(), LabError> {
    let failed = |what: String| LabError::Files { what };
    let here = Path::new(".");
    let above = folder.ancestors().filter(|at| !at.as_os_str().is_empty());
    let found = above
        .chain([here])
        .find_map(|at| Some((at, std::fs::metadata(at).ok()?)));
    let fault = match &found {
        Some((at, about)) if !about.is_dir() => Some((at, "is a file")),
        Some((at, about)) if about.permissions().readonly() => Some((at, "is read-only")),
        _ => None,
    };
    if let Some((at, fault)) = fault {
        let (folder, at) = (folder.display(), at.display());
        return Err(failed(format!(
            "cannot write into {folder}: {at} {fault}; choose another folder"
        )));
    }
    match document.map(read_text) {
        Some(Err(error)) => Err(failed(error.to_string())),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_section_is_added_once_and_replaced_after() {
        let once = with_section("# Title\n", "chart", "one");
        assert_eq!(once, "# Title\n\n<!-- chart -->\none\n<!-- /chart -->\n");
        let twice = with_section(&once, "chart", "two\n");
        assert_eq!(twice, "# Title\n\n<!-- chart -->\ntwo\n<!-- /chart -->\n");
    }

    #[test]
    fn rows_of_block_descent_say_that_it_is_given_more_iterations() {
        let point = |kind: toile_drape::MethodKind, cost: f64| Point {
            scene: "hang".to_owned(),
            mesh: "hang-a.obj".to_owned(),
            vertices: 169,
            method: kind.name(),
            step: 0.01,
            iterations: toile_reference::build(&kind.into())
                .unwrap()
                .most_iterations(),
            wall_ms: cost,
            cpu_ms: None,
            error_mm: Some(0.5),
            failure: None,
            best: false,
        };
        let data = ChartData {
            motion: vec![
                point(MethodKind::VertexBlockDescent, 1.0),
                point(MethodKind::ImplicitEuler, 2.0),
                point(MethodKind::VelocityVerlet, 3.0),
            ],
            ..ChartData::default()
        };
        let files = chart_files(&data).unwrap();
        let text = |name: &str| &files.iter().find(|(n, _)| n == name).unwrap().1;
        let rows: Vec<&str> = text("motion.csv").lines().collect();
        assert!(rows[0].contains(",step_s,most_iterations,"), "{}", rows[0]);
        assert!(rows[1].contains("vertex-block-descent,1.0000e-2,100,"));
        assert!(rows[2].contains("implicit-euler,1.0000e-2,40,"));
        assert!(rows[3].contains("velocity-verlet,1.0000e-2,,"));
        assert!(text("motion-hang-a.svg").contains(">vertex-block-descent (100)<"));
        assert!(when_to_use(&data).contains("| vertex-block-descent (100), step 10"));
    }

    #[test]
    fn a_file_in_the_place_of_the_folder_is_refused_before_the_work() {
        let folder = std::env::temp_dir().join(format!("toile-lab-{}", std::process::id()));
        ready_to_write(&folder, None).unwrap();
        assert!(!folder.exists());
        std::fs::create_dir(&folder).unwrap();
        let file = folder.join("report.md");
        std::fs::write(&file, "kept").unwrap();
        ready_to_write(&folder, Some(&file)).unwrap();
        for (out, into) in [(&file, None), (&folder, Some(folder.join("gone.md")))] {
            let error = ready_to_write(out, into.as_deref()).unwrap_err();
            assert!(matches!(error, LabError::Files { .. }), "{error}");
        }
        assert_eq!(std::fs::read_to_string(&file).unwrap(), "kept");
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
