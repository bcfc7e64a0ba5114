//! Refuses jobs that cannot be done, before any work.

use crate::turns::orientations;
use crate::{Fold, FoldEdge, Item, Marker, Mirror, Nap, Placement, Pose, Strip, Violation, judge};
use std::collections::BTreeMap;
use toile_geometry::{CrossingKind, PolygonDefect, Vec2};

/// Rounding allowed when a piece is exactly as wide as the fabric \[m\].
pub(crate) const SNUG: f64 = 1e-9;

/// Most pieces of a marker: tables of all pairs grow with their square, a hundred megabytes for
/// each island at this number.
pub const MOST_PIECES: u32 = 2_000;
/// Most points of an outline: more are a mistake, and no-fit polygons grow with their square.
const MOST_POINTS: usize = 10_000;

/// Why a marker was not made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NestingError {
    /// There is nothing to lay.
    #[error("there are no pieces to lay: mark at least one piece to be cut from this fabric")]
    NoItems,
    /// More pieces than can be laid at once.
    #[error(
        "there are {0} pieces to lay; at most {MOST_PIECES} can be laid at once: make several markers"
    )]
    TooManyPieces(u64),
    /// The search makes no sense.
    #[error("search: {0}")]
    Search(String),
    /// So many or so large shapes that tables of all pairs cannot be held.
    #[error(
        "{outlines} different outlines, in {orientations} orientations together, are more than the search can hold; allow fewer turns, give flaws as fewer areas, or make several markers"
    )]
    TooManyShapes {
        /// Outlines of pieces and flaws that differ.
        outlines: usize,
        /// Orientations of all of them together, with few turns each.
        orientations: usize,
    },
    /// The fabric makes no sense.
    #[error("fabric: {0}")]
    Strip(String),
    /// Pieces that cannot be laid.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
    Refused(Vec<Refusal>),
    /// The marker found does not pass the referee.
    #[error("the marker found is not sound ({0}); try another seed, and report this job")]
    Unsound(String),
    /// The search was told to stop.
    #[error("stopped before a marker was found")]
    Cancelled,
}

/// A piece that cannot be laid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("piece \"{name}\": {problem}")]
pub struct Refusal {
    /// Index of the item.
    pub item: usize,
    /// Its name.
    pub name: String,
    /// What is wrong and what helps.
    pub problem: ItemProblem,
}

impl NestingError {
    /// The same with all lengths in another unit: for jobs that were scaled.
    pub fn scaled(mut self, by: f64) -> Self {
        let Self::Refused(refusals) = &mut self else {
            return self;
        };
        for refusal in refusals {
            match &mut refusal.problem {
                ItemProblem::Crosses(at) => *at *= by,
                ItemProblem::TooWide {
                    needed,
                    usable,
                    fabric,
                } => [needed, usable, fabric].into_iter().for_each(|l| *l *= by),
                ItemProblem::TooLong { needed, usable } => {
                    [needed, usable].into_iter().for_each(|l| *l *= by);
                }
                _ => {}
            }
        }
        self
    }
}

/// What is wrong with a piece.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ItemProblem {
    /// A coordinate, angle or gap is not a finite number.
    #[error("{0} is not a finite number; redraw it")]
    NotFinite(&'static str),
    /// No outline, or one without area.
    #[error("its outline encloses no area; draw at least three corners")]
    Empty,
    /// The outline crosses itself.
    #[error("its outline crosses itself at ({:.1}, {:.1}) mm; move the points there apart", .0.x * 1e3, .0.y * 1e3)]
    Crosses(Vec2),
    /// A hole that is not inside.
    #[error("hole {0} is not inside its outline; move or delete the hole")]
    StrayHole(usize),
    /// Quantity 0.
    #[error("its quantity is 0; set at least 1, or leave it out of the marker")]
    NoCopies,
    /// Negative gap.
    #[error("its gap is negative; give 0 or more")]
    NegativeGap,
    /// No orientation is allowed.
    #[error("no orientation is allowed; allow at least turn 0")]
    NoOrientation,
    /// The fabric's nap forbids every orientation.
    #[error(
        "the fabric has a nap and the piece may not lie with its grain forward; allow turn 0 or use fabric without nap"
    )]
    AgainstNap,
    /// More copies than can be laid at once.
    #[error("its quantity is {0}; at most {MOST_PIECES} pieces can be laid at once")]
    TooMany(u32),
    /// So many points that its no-fit polygons cannot be held.
    #[error(
        "its outline has {0} points; at most {MOST_POINTS} can be laid: draw curves with fewer points"
    )]
    TooManyPoints(usize),
    /// It must lie on a fold and there is none.
    #[error(
        "it is cut on a fold and the fabric lies open; fold the fabric, or unfold the piece to its whole outline"
    )]
    NoFold,
    /// No orientation brings its fold edge to the fold.
    #[error(
        "no allowed orientation brings its fold edge to the fold; allow half a turn, or turning over"
    )]
    WrongSide,
    /// It may be tilted and must lie on a fold.
    #[error("it is cut on a fold and may not be tilted; set its tilt to 0")]
    TiltOnFold,
    /// Tilt out of range.
    #[error("its tilt is {:.1} degrees; give 0 to 45", .0.to_degrees())]
    Tilt(f64),
    /// A locked copy that does not exist, or not in an orientation it may take, or twice.
    #[error("locked copy {0} does not exist, or may not lie so; unlock it or correct it")]
    Locked(u32),
    /// A locked copy that breaks a rule of the marker where it is.
    #[error("locked copy {copy} cannot stay there: {why}")]
    LockedBadly {
        /// Number of the copy.
        copy: u32,
        /// What is wrong and what helps.
        why: String,
    },
    /// Too wide for the fabric.
    #[error(
        "it is {:.0} mm across the fabric and {:.0} mm are usable; use fabric at least {:.0} mm wide, split the piece with a seam, or allow another orientation",
        .needed * 1e3, .usable * 1e3, .fabric * 1e3
    )]
    TooWide {
        /// Least extent across the fabric in any allowed orientation \[m\].
        needed: f64,
        /// Width between the selvedges \[m\].
        usable: f64,
        /// Least full width of fabric that takes it, laid open \[m\].
        fabric: f64,
    },
    /// Too long for the fabric.
    #[error(
        "it is {:.0} mm long and {:.0} mm of fabric are usable; take a longer piece of fabric or split the piece with a seam",
        .needed * 1e3, .usable * 1e3
    )]
    TooLong {
        /// Least extent along the fabric in an orientation that fits its width \[m\].
        needed: f64,
        /// Length between the end margins \[m\].
        usable: f64,
    },
}

/// Extent of an item in an orientation \[m\].
pub(crate) fn extent(item: &Item, (turn, mirrored): (f64, bool)) -> Vec2 {
    let pose = Pose {
        grain: item.grain,
        turn,
        mirrored,
        translation: Vec2::zeros(),
    };
    pose.lay(&item.outline).bounds().size()
}

fn check_outline(item: &Item) -> Option<ItemProblem> {
    let points = item.outline.rings().map(Vec::len).sum();
    if points > MOST_POINTS {
        return Some(ItemProblem::TooManyPoints(points));
    }
    let problem = |defect: &PolygonDefect| match *defect {
        PolygonDefect::NotFinite { .. } => Some(ItemProblem::NotFinite("its outline")),
        PolygonDefect::TooFewPoints { .. } | PolygonDefect::NoArea { .. } => {
            Some(ItemProblem::Empty)
        }
        PolygonDefect::Crossing(c) if c.kind == CrossingKind::Touch => None,
        PolygonDefect::Crossing(c) => Some(ItemProblem::Crosses(c.point)),
        PolygonDefect::StrayHole { hole } => Some(ItemProblem::StrayHole(hole)),
    };
    let found = item.outline.defects().iter().find_map(problem);
    if found == Some(ItemProblem::Empty) {
        // A bow tie has no area either: where its lines cross is the better remedy.
        let crossings = item.outline.crossings(16);
        let crossing = crossings.iter().find(|c| c.kind == CrossingKind::Cross);
        return crossing.map(|c| ItemProblem::Crosses(c.point)).or(found);
    }
    found
}

fn check_item(item: &Item, strip: &Strip) -> Option<ItemProblem> {
    if let Some(problem) = check_outline(item) {
        return Some(problem);
    }
    if !item.grain.is_finite() {
        return Some(ItemProblem::NotFinite("its grain"));
    }
    if !item.allowed.turns.iter().all(|t| t.is_finite()) {
        return Some(ItemProblem::NotFinite("an allowed turn"));
    }
    if !item.gap.is_finite() {
        return Some(ItemProblem::NotFinite("its gap"));
    }
    if item.gap < 0.0 {
        return Some(ItemProblem::NegativeGap);
    }
    if item.quantity == 0 {
        return Some(ItemProblem::NoCopies);
    }
    if item.allowed.turns.is_empty() {
        return Some(ItemProblem::NoOrientation);
    }
    if !(0.0..=std::f64::consts::FRAC_PI_4).contains(&item.allowed.tilt) {
        return Some(ItemProblem::Tilt(item.allowed.tilt));
    }
    if item.quantity > MOST_PIECES {
        return Some(ItemProblem::TooMany(item.quantity));
    }
    if let Some(problem) = check_fold(item, strip).or_else(|| check_locks(item)) {
        return Some(problem);
    }
    let copies = 0..item.quantity.min(2);
    copies
        .into_iter()
        .find_map(|copy| check_size(item, strip, copy))
}

fn check_fold(item: &Item, strip: &Strip) -> Option<ItemProblem> {
    item.fold_edge?;
    if strip.fold == Fold::Open {
        return Some(ItemProblem::NoFold);
    }
    if item.allowed.tilt > 0.0 {
        return Some(ItemProblem::TiltOnFold);
    }
    let copies = 0..item.quantity.min(2);
    let lies = |copy: u32| {
        let ways = orientations(item, strip, copy);
        ways.iter()
            .any(|&way| folds_up(item, strip, way) != Some(None))
    };
    (!copies.into_iter().all(lies)).then_some(ItemProblem::WrongSide)
}

/// Whether an orientation brings the fold edge of a piece to the lower or upper fold, if it has one
/// and if there is such a fold: `Some(None)` if there is none.
pub(crate) fn folds_up(
    item: &Item,
    strip: &Strip,
    (turn, mirrored): (f64, bool),
) -> Option<Option<FoldEdge>> {
    let flipped = mirrored != (turn.cos() < 0.0);
    let lower = (item.fold_edge? == FoldEdge::Lower) != flipped;
    let along = turn.sin().abs() < 1e-9;
    Some(match (strip.fold, lower) {
        (Fold::Lower | Fold::Both, true) if along => Some(FoldEdge::Lower),
        (Fold::Both, false) if along => Some(FoldEdge::Upper),
        _ => None,
    })
}

pub(crate) fn check_locks(item: &Item) -> Option<ItemProblem> {
    let mut seen = Vec::new();
    for lock in &item.locked {
        let finite = [lock.turn, lock.translation.x, lock.translation.y];
        let sided = match item.allowed.mirror {
            Mirror::Never => !lock.mirrored,
            Mirror::Pairs => lock.mirrored == (lock.copy % 2 == 1),
            Mirror::Always => lock.mirrored,
            Mirror::Free => true,
        };
        let sound = finite.iter().all(|x| x.is_finite())
            && lock.copy < item.quantity
            && sided
            && item.tilt_of(lock.turn).abs() <= item.allowed.tilt + 1e-9
            && !seen.contains(&lock.copy);
        if !sound {
            return Some(ItemProblem::Locked(lock.copy));
        }
        seen.push(lock.copy);
    }
    None
}

fn check_size(item: &Item, strip: &Strip, copy: u32) -> Option<ItemProblem> {
    let ways = orientations(item, strip, copy);
    let forward = |way: &(f64, bool)| strip.nap != Nap::PerBundle || way.0.cos() >= 0.0;
    if !ways.iter().any(forward) {
        return Some(ItemProblem::AgainstNap);
    }
    let sizes: Vec<Vec2> = ways.iter().map(|&way| extent(item, way)).collect();
    let usable = strip.usable_width();
    let needed = sizes.iter().map(|s| s.y).fold(f64::INFINITY, f64::min);
    if needed > usable + SNUG {
        return Some(ItemProblem::TooWide {
            needed,
            usable,
            fabric: strip.layers() * (needed + strip.width - usable),
        });
    }
    let fitting = sizes.iter().filter(|s| s.y <= usable + SNUG);
    let needed = fitting.map(|s| s.x).fold(f64::INFINITY, f64::min);
    let usable = strip.max_length? - 2.0 * strip.end_margin;
    (needed > usable + SNUG).then_some(ItemProblem::TooLong { needed, usable })
}

fn check_strip(strip: &Strip) -> Option<String> {
    let fields = [
        ("width", strip.width),
        ("selvedge", strip.selvedge),
        ("end margin", strip.end_margin),
        ("gap", strip.gap),
        ("length", strip.max_length.unwrap_or(0.0)),
    ];
    for (name, value) in fields {
        if !value.is_finite() || value < 0.0 {
            return Some(format!("the {name} is {value} m; give 0 or more"));
        }
    }
    if strip.usable_width() <= 0.0 {
        return Some(format!(
            "nothing is left of {:.0} mm between two selvedges of {:.0} mm; give the full width of the roll",
            strip.width * 1e3,
            strip.selvedge * 1e3
        ));
    }
    if let Some(stripes) = &strip.stripes {
        let numbers = [stripes.repeat, stripes.origin];
        if !numbers.iter().all(|v| v.x.is_finite() && v.y.is_finite()) || stripes.repeat.min() < 0.0
        {
            return Some("the repeat of the print is not 0 or more; give lengths".into());
        }
    }
    for (k, flaw) in strip.flaws.iter().enumerate() {
        let sound = flaw.outline.is_simple() && flaw.outline.area() > 0.0;
        if !sound || !flaw.clearance.is_finite() || flaw.clearance < 0.0 {
            return Some(format!(
                "defect {} has no sound outline, or a negative clearance; outline the flaw again",
                k + 1
            ));
        }
    }
    None
}

/// Everything that keeps a job from being done.
pub(crate) fn check(items: &[Item], strip: &Strip) -> Result<(), NestingError> {
    check_numbered(items, strip, &|_, copy| copy)
}

/// The number by which a copy of an item is called.
type Number<'a> = &'a dyn Fn(usize, u32) -> u32;

/// The same, with copies called by other numbers.
pub(crate) fn check_numbered(
    items: &[Item],
    strip: &Strip,
    number: Number<'_>,
) -> Result<(), NestingError> {
    if items.is_empty() {
        return Err(NestingError::NoItems);
    }
    if let Some(problem) = check_strip(strip) {
        return Err(NestingError::Strip(problem));
    }
    let refusal = |(k, item): (usize, &Item)| {
        check_item(item, strip).map(|problem| Refusal {
            item: k,
            name: item.name.clone(),
            problem,
        })
    };
    let mut refusals: Vec<Refusal> = items.iter().enumerate().filter_map(refusal).collect();
    let total: u64 = items.iter().map(|i| u64::from(i.quantity)).sum();
    if refusals.is_empty() && total > u64::from(MOST_PIECES) {
        return Err(NestingError::TooManyPieces(total));
    }
    if refusals.is_empty() {
        refusals = check_places(items, strip, number);
    }
    if refusals.is_empty() {
        Ok(())
    } else {
        Err(NestingError::Refused(refusals))
    }
}

/// Locked copies as a marker of their own: what is wrong there can never be mended.
fn check_places(items: &[Item], strip: &Strip, number: Number<'_>) -> Vec<Refusal> {
    let placed = |(item, what): (usize, &Item)| {
        let place = move |lock: &crate::Locked| Placement {
            item,
            copy: lock.copy,
            turn: lock.turn,
            mirrored: lock.mirrored,
            translation: lock.translation,
        };
        what.locked.iter().map(place).collect::<Vec<_>>()
    };
    let marker = Marker {
        placements: items.iter().enumerate().flat_map(placed).collect(),
        ..Marker::default()
    };
    if marker.placements.is_empty() {
        return Vec::new();
    }
    let laid = |k: usize| (&marker.placements[k], &items[marker.placements[k].item]);
    let copy = |k: usize| number(laid(k).0.item, laid(k).0.copy);
    let name = |k: usize| format!("\"{}\" {}", laid(k).1.name, copy(k));
    let refuse = |k: usize, why: String| Refusal {
        item: laid(k).0.item,
        name: laid(k).1.name.clone(),
        problem: ItemProblem::LockedBadly { copy: copy(k), why },
    };
    let mut refusals = Vec::new();
    for violation in judge(items, strip, &marker).violations {
        let at = match violation {
            Violation::Copy { .. } | Violation::Length { .. } => continue,
            Violation::Overlap { pair, .. }
            | Violation::Gap { pair, .. }
            | Violation::Nap { pair, .. } => pair[1],
            Violation::Outside { placement, .. }
            | Violation::Orientation { placement, .. }
            | Violation::OffFold { placement, .. }
            | Violation::OffPrint { placement, .. }
            | Violation::OnFlaw { placement, .. }
            | Violation::Moved { placement }
            | Violation::Nonsense { placement } => placement,
        };
        refusals.push(refuse(at, violation.in_words(&name)));
    }
    if refusals.is_empty() && strip.nap == Nap::PerBundle {
        refusals.extend(stranded(items, strip, &marker).map(|(k, why)| refuse(k, why)));
    }
    refusals
}

/// A locked placement whose garment runs a way that another piece of it may not, and why.
fn stranded(items: &[Item], strip: &Strip, marker: &Marker) -> Option<(usize, String)> {
    let mut ways: BTreeMap<u32, (usize, bool)> = BTreeMap::new();
    for (k, placement) in marker.placements.iter().enumerate() {
        let bundle = items[placement.item].bundle(placement.copy);
        ways.insert(bundle, (k, placement.turn.cos() >= 0.0));
    }
    items.iter().find_map(|item| {
        (0..item.quantity).find_map(|copy| {
            let &(k, forward) = ways.get(&item.bundle(copy))?;
            let mut own = orientations(item, strip, copy).into_iter();
            let can = own.any(|way| (way.0.cos() >= 0.0) == forward);
            (!can).then(|| {
                let why = format!(
                    "piece \"{}\" of its garment may not run that way; turn the locked piece round",
                    item.name
                );
                (k, why)
            })
        })
    })
}
