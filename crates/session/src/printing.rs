//! Pieces printed on paper: laid out to save it, in one size or all.
//!
//! # Decided with
//! - [`crate::printing::PrintOptions`], [`crate::printing::print_job`], [`crate::printing::arranged`]: which
//!   pieces and sizes, laid to save paper;
//! - [`toile_interchange::PrintJob`], [`toile_interchange::Paper`]: lines, sheets, papers;
//! - [`toile_cut::Drawing`]: the lines of a piece;
//! - [`crate::printing::EVALUATIONS`], [`toile_nesting::Budget`]: how long the arrangement is searched for.
//!
//! Faults of the pattern are told, not refused (`print_job`).

use crate::sizes::selected;
use crate::tools::{check_ending, sound_draft};
use crate::watcher::report_progress;
use crate::{Project, SessionError, Watcher};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use toile_cut::{CutList, CutOptions, CutPiece, Shrinkage, TextKind, concerns_cutter, cut_list};
use toile_geometry::{Bounds2, Polygon, Vec2, convex_hull, union};
use toile_interchange::{
    FormatError, Lines, Paper, PrintJob, PrintLayer, PrintPiece, Shown, Tile, TitleBlock,
    write_atomically,
};
use toile_nesting::{
    Allowed, Budget, Control, Item, Locked, Marker, Progress, Search, Strip, make_marker,
};
use toile_pattern::{DisplayUnit, Draft, Pattern, SizeSelection};

/// Gap between pieces on paper (m).
const GAP: f64 = 0.004;
/// Margin between the pieces and the edge of the drawing (m).
const EDGE: f64 = 0.003;
/// Progress of a print when its pieces are arranged (1).
const ARRANGED: f64 = 0.95;
/// Evaluations in the search for each arrangement: a second or so.
const EVALUATIONS: u64 = 500_000;
/// Number of rows of sheets beyond the rows needed that are also tried.
const MORE_ROWS: u32 = 3;
/// Area of the drawing on one page over the area of its pieces (1): about what nesting reaches.
const ROOMY: f64 = 1.3;
/// Largest number of sheets of a print. Nobody joins more sheets: larger paper or a smaller scale is meant.
const MAX_SHEETS: usize = 500;
/// Smallest and largest scale that can be printed (1): a doll's, and twice the size.
const SCALES: [f64; 2] = [0.01, 2.0];

/// Options of a print.
#[derive(Clone, Debug, PartialEq)]
pub struct PrintOptions {
    /// Sizes to print.
    pub sizes: SizeSelection,
    /// Names of the pieces to print; all if the list is empty.
    pub pieces: Vec<String>,
    /// Lines to draw: cut lines, sewing lines or both.
    pub lines: Lines,
    /// Length on paper over length of cloth (1).
    pub scale: f64,
    /// Paper to print on.
    pub paper: Paper,
    /// Whether only half is drawn of pieces that are symmetric in their fold.
    pub halves: bool,
    /// Shrinkage of the cloth in the wash, for which pieces are drawn larger.
    pub shrinkage: Shrinkage,
}

impl Default for PrintOptions {
    fn default() -> Self {
        Self {
            sizes: SizeSelection::Base,
            pieces: Vec::new(),
            lines: Lines::Both,
            scale: 1.0,
            paper: Paper::A4,
            halves: false,
            shrinkage: Shrinkage::default(),
        }
    }
}

/// Result of a print.
#[derive(Clone, Debug, PartialEq)]
pub struct Printed {
    /// The sheets, row by row from the top.
    pub tiles: Vec<Tile>,
    /// Names of the sizes.
    pub sizes: Vec<String>,
    /// Names of the pieces.
    pub pieces: Vec<String>,
    /// Cut list of each fabric, in the first of the sizes.
    pub cut_list: Vec<CutList>,
    /// Unit in which lengths of the pattern are shown.
    pub shown: Shown,
    /// Notes on cut lines that cannot be made as asked.
    pub notes: Vec<String>,
}

/// Prints a pattern's pieces into a file: PDF or SVG by its ending.
///
/// # Errors
/// The pattern cannot be drafted or cut; an unknown size or piece, a scale out of range; the file
/// cannot be written.
pub fn print_pattern(
    (project, to): (&Project, &Path),
    options: &PrintOptions,
    watcher: &mut dyn Watcher,
) -> Result<Printed, SessionError> {
    let remedy = "prints are written as NAME.pdf or NAME.svg";
    check_ending(to, &[".pdf", ".svg"], remedy)?;
    let (job, mut printed) = print_job(project, options, watcher)?;
    report_progress(watcher, "writing", ARRANGED, "")?;
    let is_svg = to.to_string_lossy().to_lowercase().ends_with(".svg");
    let bytes = print_bytes(&job, is_svg, &mut printed.notes).map_err(unprintable)?;
    write_atomically(to, &bytes)?;
    Ok(printed)
}

/// The content of a print as SVG or PDF; adds a note on characters that a PDF cannot show.
pub(crate) fn print_bytes(
    job: &PrintJob,
    is_svg: bool,
    notes: &mut Vec<String>,
) -> Result<Vec<u8>, FormatError> {
    if is_svg {
        return job.svg().map(String::into_bytes);
    }
    notes.extend(job.missing_note());
    job.pdf()
}

fn unprintable(error: FormatError) -> SessionError {
    SessionError::Write {
        file: "the print",
        error,
    }
}

/// Arranges the pieces of a pattern on paper; also returns facts about the print.
///
/// # Errors
/// As [`print_pattern`], apart from the errors of the file.
pub fn print_job(
    project: &Project,
    options: &PrintOptions,
    watcher: &mut dyn Watcher,
) -> Result<(PrintJob, Printed), SessionError> {
    check_numbers(options)?;
    report_progress(watcher, "drafting", 0.0, "")?;
    let pattern = &project.pattern;
    let sizes = drafted(project, &options.sizes)?;
    check_pieces(pattern, &options.pieces)?;
    let cuts = sizes
        .iter()
        .map(|size| cut_pieces(pattern, size, options))
        .collect::<Result<Vec<_>, _>>()?;
    let layers: Vec<PrintLayer> = sizes.iter().map(|size| size.layer()).collect();
    // A print of named sizes is not made to the measurements of the wearer.
    let made_for = project
        .made_for()
        .filter(|_| sizes.iter().all(|size| size.name.is_none()));
    let pieces = grouped((pattern, made_for.as_ref()), &cuts, &layers);
    if pieces.is_empty() {
        return Err(SessionError::Nothing {
            action: "print",
            hint: "draw a panel first",
        });
    }
    let of = (&**pattern, &sizes[0].draft);
    let whole: Vec<CutPiece> = cuts[0].iter().map(|cut| cut.whole.clone()).collect();
    let list = cut_list(of, &whole);
    let notes = whole.iter().flat_map(|cut| cut.diagnostics(pattern));
    let notes = notes
        .filter(concerns_cutter)
        .map(|found| format!("{}; {}", found.message, found.hint))
        .collect();
    let job = PrintJob {
        paper: options.paper,
        scale: options.scale,
        lines: options.lines,
        size: Vec2::zeros(),
        title: TitleBlock {
            name: pattern.name.clone(),
            facts: facts(options, (&layers, made_for), (&list, pattern.unit)),
            unit: pattern.unit,
        },
        title_at: Vec2::zeros(),
        layers,
        pieces,
    };
    let job = arranged(job, watcher)?;
    let printed = Printed {
        tiles: job.tiles().map_err(unprintable)?,
        sizes: sizes.into_iter().filter_map(|size| size.name).collect(),
        pieces: job.pieces.iter().map(|p| p.words[0].clone()).collect(),
        cut_list: list,
        shown: Shown(pattern.unit),
        notes,
    };
    Ok((job, printed))
}

fn check_numbers(options: &PrintOptions) -> Result<(), SessionError> {
    let scale = options.scale;
    if !(scale.is_finite() && (SCALES[0]..=SCALES[1]).contains(&scale)) {
        return Err(SessionError::Number {
            what: "the scale",
            value: scale,
            hint: "give one from 1:100 to 2:1",
        });
    }
    let Shrinkage { warp, weft } = options.shrinkage;
    if !options.shrinkage.is_sound() {
        return Err(SessionError::Number {
            what: "the shrinkage in percent",
            value: 100.0 * if warp.abs() <= 0.5 { weft } else { warp },
            hint: "give shares of the length from -50 to 50",
        });
    }
    Ok(())
}

/// The draft of a size.
struct SizeDraft {
    name: Option<String>,
    draft: Draft,
}

impl SizeDraft {
    fn layer(&self) -> PrintLayer {
        PrintLayer {
            name: match &self.name {
                Some(name) => format!("size {name}"),
                None => "as drafted".to_owned(),
            },
        }
    }
}

fn drafted(project: &Project, sizes: &SizeSelection) -> Result<Vec<SizeDraft>, SessionError> {
    let each = selected(sizes, &project.pattern)?
        .into_iter()
        .map(|(size, count)| {
            if let (Some(name), 2..) = (&size, count) {
                return Err(SessionError::Conflict(format!(
                    "a size is printed once: leave the number after {name} out"
                )));
            }
            let project = Project {
                size: size.or_else(|| project.size.clone()),
                ..project.clone()
            };
            project.check_size()?;
            Ok(SizeDraft {
                draft: sound_draft(&project)?,
                name: project.size_name().map(str::to_owned),
            })
        });
    each.collect()
}

/// Refuses unknown pieces; pieces are named by their panels.
fn check_pieces(pattern: &Pattern, pieces: &[String]) -> Result<(), SessionError> {
    for name in pieces {
        if pattern.panel_named(name).is_none() {
            let names: Vec<&str> = pattern.panels.iter().map(|p| &*p.name).collect();
            return Err(SessionError::Unknown {
                kind: "piece",
                name: name.clone(),
                hint: format!("choose from: {}", names.join(", ")),
            });
        }
    }
    Ok(())
}

/// A cut piece, and the part of it that is printed: the whole piece or half of it.
struct Cut {
    whole: CutPiece,
    printed: Arc<CutPiece>,
}

/// Cuts the first copy of each panel asked for.
fn cut_pieces(
    pattern: &Pattern,
    size: &SizeDraft,
    options: &PrintOptions,
) -> Result<Vec<Cut>, SessionError> {
    let asked = |name: &String| options.pieces.is_empty() || options.pieces.contains(name);
    let cut_options = CutOptions {
        shrinkage: options.shrinkage,
        block: 0.0,
    };
    let mut cuts = Vec::new();
    for (k, piece) in size.draft.pieces.iter().enumerate() {
        let panel = pattern.panel(piece.id.panel);
        if piece.id.copy != 0 || !panel.is_some_and(|panel| asked(&panel.name)) {
            continue;
        }
        let how = (size.name.as_deref(), &cut_options);
        let whole = CutPiece::new((pattern, &size.draft), k, how);
        let whole = whole.map_err(|error| SessionError::Faults {
            source_name: pattern.name.clone(),
            faults: vec![format!("piece {:?} cannot be cut: {error}", piece.name)],
        })?;
        let fold = whole.fold.filter(|_| options.halves);
        let fold = fold.filter(|fold| whole.is_symmetric_in(fold));
        let printed = match fold {
            Some(fold) => whole.halved(&fold),
            None => whole.clone(),
        };
        cuts.push(Cut {
            whole,
            printed: Arc::new(printed),
        });
    }
    Ok(cuts)
}

/// Groups the pieces by panel, each in all its sizes, with the words written on it.
fn grouped(
    (pattern, made_for): (&Pattern, Option<&[String; 2]>),
    cuts: &[Vec<Cut>],
    layers: &[PrintLayer],
) -> Vec<PrintPiece> {
    let of_panel = |panel: &Arc<toile_pattern::Panel>| {
        let sizes = cuts.iter().enumerate().filter_map(|(k, cuts)| {
            let found = cuts.iter().find(|cut| cut.whole.id.panel == panel.id)?;
            Some((k, found.printed.clone()))
        });
        let sizes: Vec<(usize, Arc<CutPiece>)> = sizes.collect();
        let (_, first) = sizes.first()?;
        let mut words = vec![panel.name.clone()];
        words.extend(
            Some(&pattern.name)
                .filter(|style| **style != panel.name)
                .cloned(),
        );
        words.extend(made_for.map(|[name, _]| format!("made for {name}")));
        words.extend(match sizes.len() {
            1 => first.text(TextKind::Size).map(str::to_owned),
            n => Some(match n == layers.len() {
                true => "all sizes".to_owned(),
                false => format!("{n} sizes"),
            }),
        });
        let count = first
            .text(TextKind::Count)
            .map(|count| match first.on_fold {
                Some(_) => format!("{count} on the fold"),
                None => count.to_owned(),
            });
        words.extend(count);
        words.extend(first.text(TextKind::Fabric).map(str::to_owned));
        Some(PrintPiece {
            sizes,
            words,
            pose: toile_nesting::Pose {
                grain: 0.0,
                turn: 0.0,
                mirrored: false,
                translation: Vec2::zeros(),
            },
        })
    };
    pattern.panels.iter().filter_map(of_panel).collect()
}

/// Lines of the title block.
fn facts(
    options: &PrintOptions,
    (layers, made_for): (&[PrintLayer], Option<[String; 2]>),
    (list, unit): (&[CutList], DisplayUnit),
) -> Vec<String> {
    let names: Vec<&str> = layers.iter().map(|layer| &*layer.name).collect();
    let scale = match options.scale {
        1.0 => "true size".to_owned(),
        s if s < 1.0 => format!("scale 1:{}", plain(1.0 / s)),
        s => format!("scale {}:1", plain(s)),
    };
    let sizes = match names[..] {
        [only] => only.to_owned(),
        _ => names.join(", ").replace(", size ", ", "),
    };
    let mut facts = match made_for {
        Some([name, girths]) => vec![format!("Made to measure for {name}, {scale}"), girths],
        None => vec![format!("{sizes}, {scale}")],
    };
    facts.extend(list.iter().map(|list| {
        let count: u32 = list.pieces.iter().map(|piece| piece.quantity).sum();
        let plural = if count == 1 { "" } else { "s" };
        format!("{}: {count} piece{plural} to cut", list.fabric)
    }));
    facts.push(
        match options.lines {
            Lines::Cut | Lines::Both => "Seam allowances are included.",
            Lines::Sew => "Without seam allowances: add them as you cut.",
        }
        .to_owned(),
    );
    if options.shrinkage != Shrinkage::default() {
        let [warp, weft] = options
            .shrinkage
            .factors()
            .map(|f| plain((f - 1.0) * 100.0));
        facts.push(format!(
            "Drawn {warp} % longer along the warp and {weft} % across it, for what is lost in the wash."
        ));
    }
    if options.paper.sheet().is_some() {
        let overlap = match unit {
            DisplayUnit::Inch => "0.39 in (10 mm)",
            DisplayUnit::Millimetre | DisplayUnit::Centimetre | DisplayUnit::Metre => "10 mm",
        };
        facts.push(format!(
            "Join the sheets so that frames overlap by {overlap} and crosses meet."
        ));
    }
    facts
}

/// A number with at most two decimals.
fn plain(number: f64) -> String {
    let text = format!("{number:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Lays the pieces of a job so that they take few sheets.
fn arranged(job: PrintJob, watcher: &mut dyn Watcher) -> Result<PrintJob, SessionError> {
    let block = job.title.size(job.layers.len());
    let outlines: Vec<Polygon> = job.pieces.iter().map(|p| outline(p, job.scale)).collect();
    let extents = outlines.iter().map(|outline| outline.bounds().size());
    // Pieces lie in any quarter turn: the drawing must be at least as high as their shorter sides.
    let needed = extents.map(|size| size.min()).fold(block.y, f64::max) + 2.0 * EDGE + 1e-6;
    let heights: Vec<f64> = match job.paper.height_of(1) {
        Some(_) => {
            let enough = |rows: &u32| job.paper.height_of(*rows).is_some_and(|h| h >= needed);
            let least = (1..).find(enough).unwrap_or(1);
            let tried = least..=least + MORE_ROWS;
            tried.filter_map(|rows| job.paper.height_of(rows)).collect()
        }
        None => {
            let area: f64 = outlines.iter().map(Polygon::area).sum::<f64>() + block.x * block.y;
            vec![needed.max((ROOMY * area).sqrt())]
        }
    };
    if let Some(step) = job.paper.step() {
        // A rough check by area, before the sheets are counted one by one. Sheets without a line are not
        // printed, but few sheets lie so far within a piece that they have none.
        let area: f64 = outlines.iter().map(Polygon::area).sum();
        let sheets = (area / (step.x * step.y)) as usize;
        if sheets > 10 * MAX_SHEETS {
            return Err(too_many(sheets));
        }
    }
    let mut best: Option<(usize, PrintJob)> = None;
    let count = heights.len() as f64;
    for (k, height) in heights.into_iter().enumerate() {
        let part = 0.9 / count;
        let share = (0.05 + part * k as f64, part);
        let laid = laid(&job, (&outlines, block, height), (&mut *watcher, share))?;
        let sheets = laid.tiles().map_err(unprintable)?.len();
        if best.as_ref().is_none_or(|(least, _)| sheets < *least) {
            best = Some((sheets, laid));
        }
    }
    match best {
        Some((sheets, _)) if sheets > MAX_SHEETS => Err(too_many(sheets)),
        best => Ok(best.map_or(job, |(_, laid)| laid)),
    }
}

fn too_many(sheets: usize) -> SessionError {
    SessionError::Conflict(format!(
        "the print would take some {sheets} sheets, more than {MAX_SHEETS}; choose larger paper, one page, or a smaller scale"
    ))
}

/// Outline of the area that a piece takes on paper in all its sizes (m).
fn outline(piece: &PrintPiece, scale: f64) -> Polygon {
    let mut outers = piece.sizes.iter().map(|(_, cut)| cut.outer());
    let mut whole = outers.next().unwrap_or_default();
    for outer in outers {
        let mut parts = union(&whole, &outer);
        whole = match parts.len() {
            1 => Polygon::new(parts.remove(0).outer),
            _ => {
                let points: Vec<Vec2> = [whole.outer, outer.outer].concat();
                Polygon::new(convex_hull(&points))
            }
        };
    }
    whole.mapped(|p| p * scale)
}

/// Lays a job on a drawing of a height (m), with the title block in the upper left corner.
fn laid(
    job: &PrintJob,
    (outlines, block, height): (&[Polygon], Vec2, f64),
    (watcher, (from, part)): (&mut dyn Watcher, (f64, f64)),
) -> Result<PrintJob, SessionError> {
    let title_at = Vec2::new(EDGE, height - EDGE - block.y);
    let title = Polygon::rectangle(Bounds2 {
        min: Vec2::zeros(),
        max: block,
    });
    let locked = Locked {
        copy: 0,
        turn: 0.0,
        mirrored: false,
        translation: title_at,
    };
    let mut items = vec![Item {
        allowed: Allowed::one_way(),
        locked: vec![locked],
        ..Item::new("the title", title)
    }];
    let quarters = [0.0, 0.5, 1.0, 1.5].map(|half| half * std::f64::consts::PI);
    items.extend(
        job.pieces
            .iter()
            .zip(outlines)
            .map(|(piece, outline)| Item {
                allowed: Allowed::turned(quarters.to_vec()),
                ..Item::new(piece.words[0].clone(), outline.clone())
            }),
    );
    let strip = Strip {
        selvedge: EDGE,
        end_margin: EDGE,
        gap: GAP,
        ..Strip::of_width(height)
    };
    let marker = searched(&items, &strip, (watcher, (from, part)))?;
    let mut laid = job.clone();
    laid.size = Vec2::new(marker.length, height);
    laid.title_at = title_at;
    for placement in &marker.placements {
        let piece = placement.item.checked_sub(1);
        if let Some(piece) = piece.and_then(|k| laid.pieces.get_mut(k)) {
            piece.pose = placement.pose(&items[placement.item]);
        }
    }
    match marker.unplaced.first() {
        None => Ok(laid),
        Some(lost) => Err(SessionError::Conflict(format!(
            "piece {:?} finds no place on the paper: {}",
            items[lost.item].name, lost.reason
        ))),
    }
}

fn searched(
    items: &[Item],
    strip: &Strip,
    (watcher, (from, part)): (&mut dyn Watcher, (f64, f64)),
) -> Result<Marker, SessionError> {
    let cancel = watcher
        .stop_flag()
        .unwrap_or_else(|| Arc::new(AtomicBool::new(false)));
    let mut stopped = false;
    let mut follow = |progress: Progress| {
        let share = (from + part * progress.done.clamp(0.0, 1.0)).min(ARRANGED);
        if report_progress(watcher, "arranging", share, "").is_err() {
            stopped = true;
            cancel.store(true, std::sync::atomic::Ordering::Relaxed);
        }
    };
    let mut control = Control {
        progress: &mut follow,
        cancel: &cancel,
    };
    let search = Search {
        budget: Budget::Evaluations(EVALUATIONS),
        ..Search::default()
    };
    let marker = make_marker(items, strip, search, &mut control);
    if stopped || cancel.load(std::sync::atomic::Ordering::Relaxed) {
        return Err(SessionError::Cancelled);
    }
    Ok(marker.map_err(toile_marker::MarkerError::from)?)
}
