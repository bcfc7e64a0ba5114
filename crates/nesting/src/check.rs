//! Jobs that cannot be done, said before any work.

use crate::{Item, Mirror, Nap, Pose, Strip};
use toile_geometry::{CrossingKind, PolygonDefect, Vec2};

/// Rounding allowed when a piece is exactly as wide as the fabric \[m\].
pub(crate) const SNUG: f64 = 1e-9;

/// Why a marker was not made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NestingError {
    /// There is nothing to lay.
    #[error("there are no pieces to lay: mark at least one piece to be cut from this fabric")]
    NoItems,
    /// The fabric makes no sense.
    #[error("fabric: {0}")]
    Strip(String),
    /// Pieces that cannot be laid.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
    Refused(Vec<Refusal>),
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
        /// Least full width of fabric that takes it \[m\].
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

/// Where within its tolerance the grain is tried.
const TILTS: [f64; 5] = [0.0, -0.5, 0.5, -1.0, 1.0];

/// Turns and sides an item's copy may take on a strip, without repeats.
pub(crate) fn orientations(item: &Item, strip: &Strip, copy: u32) -> Vec<(f64, bool)> {
    let sides: &[bool] = match item.allowed.mirror {
        Mirror::Never => &[false],
        Mirror::Pairs if copy % 2 == 1 => &[true],
        Mirror::Pairs => &[false],
        Mirror::Free => &[false, true],
    };
    let mut found: Vec<(f64, bool)> = Vec::new();
    let tilt = item.allowed.tilt;
    let tilts: &[f64] = if tilt > 0.0 { &TILTS } else { &[0.0] };
    for (base, part) in item.allowed.turns.iter().flat_map(|b| tilts.iter().map(move |t| (b, t))) {
        let turn = base + part * tilt;
        let runs_off = match strip.nap {
            Nap::None => false,
            Nap::OneWay => *base != 0.0,
            Nap::PerBundle => base.sin().abs() > 1e-9,
        };
        if runs_off {
            continue;
        }
        for &side in sides {
            if !found.contains(&(turn, side)) {
                found.push((turn, side));
            }
        }
    }
    found
}

/// Extent of an item in an orientation \[m\].
fn extent(item: &Item, (turn, mirrored): (f64, bool)) -> Vec2 {
    let pose = Pose {
        grain: item.grain,
        turn,
        mirrored,
        translation: Vec2::zeros(),
    };
    pose.lay(&item.outline).bounds().size()
}

fn check_outline(item: &Item) -> Option<ItemProblem> {
    let problem = |defect: &PolygonDefect| match *defect {
        PolygonDefect::NotFinite { .. } => Some(ItemProblem::NotFinite("its outline")),
        PolygonDefect::TooFewPoints { .. } | PolygonDefect::NoArea { .. } => {
            Some(ItemProblem::Empty)
        }
        PolygonDefect::Crossing(c) if c.kind == CrossingKind::Touch => None,
        PolygonDefect::Crossing(c) => Some(ItemProblem::Crosses(c.point)),
        PolygonDefect::StrayHole { hole } => Some(ItemProblem::StrayHole(hole)),
    };
    item.outline.defects().iter().find_map(problem)
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
    let copies = 0..item.quantity.min(2);
    copies
        .into_iter()
        .find_map(|copy| check_size(item, strip, copy))
}

fn check_size(item: &Item, strip: &Strip, copy: u32) -> Option<ItemProblem> {
    let ways = orientations(item, strip, copy);
    if ways.is_empty() {
        return Some(ItemProblem::AgainstNap);
    }
    let sizes: Vec<Vec2> = ways.iter().map(|&way| extent(item, way)).collect();
    let usable = strip.usable_width();
    let needed = sizes.iter().map(|s| s.y).fold(f64::INFINITY, f64::min);
    if needed > usable + SNUG {
        return Some(ItemProblem::TooWide {
            needed,
            usable,
            fabric: needed + 2.0 * strip.selvedge,
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
    None
}

/// Everything that keeps a job from being done.
pub(crate) fn check(items: &[Item], strip: &Strip) -> Result<(), NestingError> {
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
    let refusals: Vec<Refusal> = items.iter().enumerate().filter_map(refusal).collect();
    if refusals.is_empty() {
        Ok(())
    } else {
        Err(NestingError::Refused(refusals))
    }
}
