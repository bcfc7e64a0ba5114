//! Markers of several patterns and sizes, and of published nesting instances.

use crate::export::{cannot, marker_files};
use crate::laying::{Garments, lay};
use crate::tools::{project_of, sound_draft};
use crate::watcher::tell;
use crate::{Nested, SessionError, Watcher};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use toile_geometry::{Bounds2, Polygon, Vec2};
use toile_interchange::{
    is_jagua_instance, read_jagua, read_text, write_all_atomically, write_jagua,
};
use toile_nesting::{
    Budget, Control, Defect, Nap, Progress, Search, Strip, Stripes, judge, make_marker,
};

/// How markers are made. What is not given is the fabric's own, or usual.
#[derive(Clone, Debug, PartialEq)]
pub struct NestOptions {
    /// Named sizes, and how many garments of each; without any, one garment of the base size.
    pub sizes: Vec<(String, u32)>,
    /// Full width of the fabric [m].
    pub width: Option<f64>,
    /// Length at hand [m].
    pub length: Option<f64>,
    /// Unusable edge at either side [m].
    pub selvedge: Option<f64>,
    /// Fabric left free at either end [m].
    pub end_margin: Option<f64>,
    /// Least distance between pieces [m].
    pub gap: Option<f64>,
    /// Nap.
    pub nap: Option<Nap>,
    /// How far the grain may lie off the warp [rad].
    pub tilt: f64,
    /// Repeat of the print along the warp and across [m], 0 where it does not repeat: the hem and
    /// the middle of every piece lie on its lines.
    pub repeat: Option<[f64; 2]>,
    /// Flaws of the fabric: x and y of the corner, length and width [m].
    pub defects: Vec<[f64; 4]>,
    /// When the search ends.
    pub budget: Budget,
    /// Start of the sequences of chance.
    pub seed: u64,
}

impl Default for NestOptions {
    fn default() -> Self {
        let search = Search::default();
        Self {
            sizes: Vec::new(),
            width: None,
            length: None,
            selvedge: None,
            end_margin: None,
            gap: None,
            nap: None,
            tilt: 0.0,
            repeat: None,
            defects: Vec::new(),
            budget: search.budget,
            seed: search.seed,
        }
    }
}

impl NestOptions {
    pub(crate) fn search(&self) -> Search {
        Search {
            budget: self.budget,
            seed: self.seed,
            ..Search::default()
        }
    }

    /// A strip with what is given instead of its own.
    pub(crate) fn applied(&self, strip: Strip) -> Strip {
        let rectangle = |&[x, y, length, width]: &[f64; 4]| Defect {
            outline: Polygon::rectangle(Bounds2 {
                min: Vec2::new(x, y),
                max: Vec2::new(x + length, y + width),
            }),
            clearance: 0.0,
        };
        Strip {
            width: self.width.unwrap_or(strip.width),
            selvedge: self.selvedge.unwrap_or(strip.selvedge),
            end_margin: self.end_margin.unwrap_or(strip.end_margin),
            gap: self.gap.unwrap_or(strip.gap),
            max_length: self.length.or(strip.max_length),
            nap: self.nap.unwrap_or(strip.nap),
            stripes: self.repeat.map(|repeat| Stripes {
                repeat: Vec2::from(repeat),
                origin: Vec2::zeros(),
            }),
            defects: self.defects.iter().map(rectangle).collect(),
            ..strip
        }
    }
}

/// Lays the pieces of one or more patterns together and writes the markers. Returns a summary of
/// each marker and the files written.
///
/// # Errors
/// A pattern cannot be read or laid, or a file cannot be written.
pub fn nest_patterns(
    patterns: &[PathBuf],
    options: &NestOptions,
    (folder, watcher): (&Path, &mut dyn Watcher),
) -> Result<(Vec<Nested>, Vec<PathBuf>), SessionError> {
    let mut drafts = Vec::new();
    let mut names = Vec::new();
    for path in patterns {
        let sizes: Vec<(Option<&str>, u32)> = match options.sizes.is_empty() {
            true => vec![(None, 1)],
            false => options
                .sizes
                .iter()
                .map(|(s, n)| (Some(s.as_str()), *n))
                .collect(),
        };
        for (size, count) in sizes {
            let (project, _) = project_of(path, size)?;
            drafts.push((sound_draft(&project)?, count));
            let name = &project.pattern.name;
            names.push(match (size, options.sizes.len() > 1 || count > 1) {
                (Some(size), true) => format!("{name} {count} x {size}"),
                _ => name.clone(),
            });
        }
    }
    let garments = drafts.iter().map(|(draft, count)| Garments {
        draft,
        count: *count,
    });
    let layings = lay(&garments.collect::<Vec<_>>(), options, watcher)?;
    let mut files = Vec::new();
    marker_files(&names.join(" + "), &layings, &mut files)?;
    write_all_atomically(folder, &files)?;
    let paths = files.iter().map(|(name, _)| folder.join(name)).collect();
    Ok((layings.iter().map(|l| l.summary()).collect(), paths))
}

/// Whether a file is a nesting instance rather than a pattern.
pub fn is_nesting_instance(path: &Path) -> bool {
    read_text(path).is_ok_and(|text| is_jagua_instance(&text))
}

/// Lays the items of an instance and writes the solution in the instance's own format, as
/// `NAME.json`. Returns a summary, the density of the strip (0..=1), notes and the file written.
///
/// # Errors
/// The instance cannot be read or laid, an option does not apply, or the file cannot be written.
pub fn nest_instance(
    path: &Path,
    options: &NestOptions,
    (folder, watcher): (&Path, &mut dyn Watcher),
) -> Result<(Nested, Vec<String>, PathBuf), SessionError> {
    let started = std::time::Instant::now();
    let mut instance = read_jagua(&read_text(path)?).map_err(|error| SessionError::Format {
        path: path.to_owned(),
        error,
    })?;
    instance.strip = options.applied(instance.strip);
    for item in &mut instance.items {
        item.allowed.tilt = options.tilt;
    }
    let cancel = AtomicBool::new(false);
    let scale = instance.scale;
    let mut follow = |progress: Progress| {
        let detail = format!("length {:.1}", progress.length / scale);
        if tell(watcher, "laying out", progress.done, &detail).is_err() {
            cancel.store(true, Ordering::Relaxed);
        }
    };
    let mut control = Control {
        progress: &mut follow,
        cancel: &cancel,
    };
    let (items, strip) = (&instance.items, &instance.strip);
    let marker = make_marker(items, strip, options.search(), &mut control)?;
    let verdict = judge(items, strip, &marker);
    let seconds = match options.budget {
        Budget::Seconds(_) => Some(started.elapsed().as_secs_f64()),
        Budget::Evaluations(_) => None,
    };
    let text = write_jagua(&instance, &marker, seconds).map_err(cannot("the solution"))?;
    let plain = |c: char| {
        if c.is_alphanumeric() || "-_.".contains(c) {
            c
        } else {
            '_'
        }
    };
    let name: String = instance.name.chars().map(plain).collect();
    let file = (format!("{name}.json"), text.into_bytes());
    write_all_atomically(folder, std::slice::from_ref(&file))?;
    let nested = Nested {
        fabric: instance.name.clone(),
        pieces: marker.placements.len(),
        unplaced: marker.unplaced.len(),
        length: marker.length / scale,
        width: strip.width / scale,
        efficiency: marker.efficiency,
        sound: verdict.is_sound(),
    };
    Ok((nested, instance.notes, folder.join(file.0)))
}
