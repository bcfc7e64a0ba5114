//! Errors of marker making.

use toile_geometry::Vec2;

/// Largest number of pieces of a marker: tables of all pairs grow with its square, to a hundred megabytes per
/// island at this number.
pub const MAX_PIECES: u32 = 2_000;
/// Largest number of points of an outline: more are a mistake, and no-fit polygons grow with its square.
pub(crate) const MAX_POINTS: usize = 10_000;

/// The reason why a marker was not made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NestingError {
    /// There are no pieces to lay.
    #[error("there are no pieces to lay: mark at least one piece to be cut from this fabric")]
    NoItems,
    /// More pieces than can be laid at once.
    #[error(
        "there are {0} pieces to lay; at most {MAX_PIECES} can be laid at once: make several markers"
    )]
    TooManyPieces(u64),
    /// The search parameters are invalid.
    #[error("search: {0}")]
    Search(String),
    /// Too many or too large shapes for the tables of all pairs.
    #[error(
        "{outlines} different outlines, in {orientations} orientations together, are more than the search can hold; allow fewer turns, give flaws as fewer areas, or make several markers"
    )]
    TooManyShapes {
        /// Number of different outlines of pieces and flaws.
        outlines: usize,
        /// Total number of their orientations, with few turns each.
        orientations: usize,
    },
    /// The fabric is invalid.
    #[error("fabric: {0}")]
    Strip(String),
    /// Pieces that cannot be laid.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
    Refused(Vec<Refusal>),
    /// The marker found does not pass the referee's check.
    #[error("the marker found is not sound ({0}); try another seed, and report this job")]
    Unsound(String),
    /// The search was stopped.
    #[error("stopped before a marker was found")]
    Cancelled,
}

/// A piece that cannot be laid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("piece \"{name}\": {problem}")]
pub struct Refusal {
    /// Index of the item.
    pub item: usize,
    /// Name of the item.
    pub name: String,
    /// The fault and the remedy.
    pub problem: ItemProblem,
}

impl NestingError {
    /// The error with all lengths converted to another unit, for jobs that were scaled.
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

/// The fault of a piece.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ItemProblem {
    /// A coordinate, angle or gap is not a finite number.
    #[error("{0} is not a finite number; redraw it")]
    NotFinite(&'static str),
    /// No outline, or an outline without area.
    #[error("its outline encloses no area; draw at least three corners")]
    Empty,
    /// The outline crosses itself.
    #[error("its outline crosses itself at ({:.1}, {:.1}) mm; move the points there apart", .0.x * 1e3, .0.y * 1e3)]
    Crosses(Vec2),
    /// A hole outside the outline.
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
    #[error("its quantity is {0}; at most {MAX_PIECES} pieces can be laid at once")]
    TooMany(u32),
    /// Too many points to hold the no-fit polygons.
    #[error(
        "its outline has {0} points; at most {MAX_POINTS} can be laid: draw curves with fewer points"
    )]
    TooManyPoints(usize),
    /// The piece must lie on a fold and there is none.
    #[error(
        "it is cut on a fold and the fabric lies open; fold the fabric, or unfold the piece to its whole outline"
    )]
    NoFold,
    /// No orientation brings the piece's fold edge to the fold.
    #[error(
        "no allowed orientation brings its fold edge to the fold; allow half a turn, or turning over"
    )]
    WrongSide,
    /// The piece may be tilted but must lie on a fold.
    #[error("it is cut on a fold and may not be tilted; set its tilt to 0")]
    TiltOnFold,
    /// Tilt out of range.
    #[error("its tilt is {:.1} degrees; give 0 to 45", .0.to_degrees())]
    Tilt(f64),
    /// A locked copy that does not exist, is locked twice, or has an orientation that is not allowed.
    #[error("locked copy {0} does not exist, or may not lie so; unlock it or correct it")]
    Locked(u32),
    /// A locked copy that breaks a rule of the marker in its position.
    #[error("locked copy {copy} cannot stay there: {why}")]
    LockedBadly {
        /// Number of the copy.
        copy: u32,
        /// The fault and the remedy.
        why: String,
    },
    /// Too wide for the fabric.
    #[error(
        "it is {:.0} mm across the fabric and {:.0} mm are usable; use fabric at least {:.0} mm wide, split the piece with a seam, or allow another orientation",
        .needed * 1e3, .usable * 1e3, .fabric * 1e3
    )]
    TooWide {
        /// Smallest extent across the fabric over all allowed orientations (m).
        needed: f64,
        /// Width between the selvedges (m).
        usable: f64,
        /// Smallest full width of an open fabric that fits the piece (m).
        fabric: f64,
    },
    /// Too long for the fabric.
    #[error(
        "it is {:.0} mm long and {:.0} mm of fabric are usable; take a longer piece of fabric or split the piece with a seam",
        .needed * 1e3, .usable * 1e3
    )]
    TooLong {
        /// Smallest extent along the fabric over the orientations that fit its width (m).
        needed: f64,
        /// Length between the end margins (m).
        usable: f64,
    },
}
