//! Items, the strip they are laid on, and the resulting marker.
//!
//! # Decided with
//! - [`crate::marker::Strip::usable_width`], [`crate::marker::Strip::gap_between`]: selvedges, margins and
//!   gaps;
//! - [`crate::job::Job::gap`], [`crate::job::Job::corner`], [`crate::job::Job::axes`]: what the search keeps
//!   to; prints;
//! - [`crate::turns::orientations_within`], [`crate::explore`] (`turn_round`): turns that are tried; a
//!   garment all one way;
//! - [`crate::rules::check_rules`], [`crate::referee::judge`]: how the referee judges it;
//! - [`crate::clashes::clashes`], [`crate::check::check`]: overlaps and selvedges of pieces laid by hand;
//!   what is refused before a search;
//! - [`crate::violation::Violation`], [`crate::words`]: kinds of violation, and their words;
//! - [`crate::poses`], [`crate::shape::Shape`]: pieces turned by their grain; halves on a fold;
//! - [`crate::marker::Marker::measure`]: length, efficiency and use of the fabric.
//!
//! A new rule is kept by the search, judged by the referee and put in words; each is a place of its own.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use toile_geometry::{Polygon, Vec2};

/// Rule for turning over the copies of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Mirror {
    /// Every copy lies face up, as drawn.
    #[default]
    Never,
    /// Left and right pieces: copies 1, 3, 5... are mirrored.
    Pairs,
    /// Every copy lies face down.
    Always,
    /// Each copy lies face up or down, as the search chooses.
    Free,
}

/// The orientations that a piece may have on the fabric.
#[derive(Clone, Debug, PartialEq)]
pub struct Allowed {
    /// Angles between the piece's grain and the warp (rad), counter-clockwise.
    pub turns: Vec<f64>,
    /// Rule for turning the piece over.
    pub mirror: Mirror,
    /// Largest deviation of the grain from each of the angles, to either side (rad).
    pub tilt: f64,
}

impl Allowed {
    /// Grain along the warp, in one direction.
    pub fn one_way() -> Self {
        Self::turned(vec![0.0])
    }

    /// Grain along the warp, in either direction.
    pub fn two_way() -> Self {
        Self::turned(vec![0.0, PI])
    }

    /// A list of angles (rad), not turned over, without tilt.
    pub fn turned(turns: Vec<f64>) -> Self {
        Self {
            turns,
            mirror: Mirror::Never,
            tilt: 0.0,
        }
    }

    /// The same orientations with another rule for turning over.
    pub fn mirrored(self, mirror: Mirror) -> Self {
        Self { mirror, ..self }
    }
}

/// A piece to lay, with its cut outline.
#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    /// Name for messages.
    pub name: String,
    /// Cut outline, curves flattened, with the holes cut into it (m). The search lays no piece into the holes
    /// of another, but a marker with one there is valid.
    pub outline: Polygon,
    /// Direction of the warp in the outline's plane (rad), counter-clockwise from +x.
    pub grain: f64,
    /// Number of copies.
    pub quantity: u32,
    /// Orientations that the piece may have.
    pub allowed: Allowed,
    /// Distance this piece needs to any other (m); the gap of the strip applies if it is larger.
    pub gap: f64,
    /// The garment of each copy, for fabric on which each garment must run one way; copies beyond the list
    /// belong to garment 0.
    pub bundles: Vec<u32>,
    /// The side of the outline that must lie on a fold of the fabric, as drawn and with the grain along +x.
    /// The outline is then half of the piece.
    pub fold_edge: Option<FoldEdge>,
    /// The point that must match the print.
    pub match_point: Option<MatchPoint>,
    /// Whether the piece may be cut from flawed fabric (a pocket bag, an inner yoke).
    pub over_flaws: bool,
    /// Copies with a fixed position.
    pub locked: Vec<Locked>,
}

/// A side of an outline along the grain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FoldEdge {
    /// The side with the smallest y, when the grain lies along +x.
    Lower,
    /// The side with the largest y, when the grain lies along +x.
    Upper,
}

/// A point of a piece that must lie at a given place of the print.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MatchPoint {
    /// Position in the plane of the outline (m).
    pub point: Vec2,
    /// Place within the repeat.
    pub phase: Phase,
}

/// A place within the repeat of a print.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Phase {
    /// At this offset from the lines of the print, along the warp and across it (m).
    At(Vec2),
    /// At the same place for all pieces of this set, wherever that is, so that the print matches at seams.
    Set(u32),
}

/// A copy with a fixed position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Locked {
    /// Number of the copy, from 0.
    pub copy: u32,
    /// Angle from the warp to the piece's grain (rad).
    pub turn: f64,
    /// Whether the copy lies face down.
    pub mirrored: bool,
    /// Translation after the rotation (m).
    pub translation: Vec2,
}

impl Item {
    /// One copy with the grain along +x in the outline, in either direction on the warp.
    pub fn new(name: impl Into<String>, outline: Polygon) -> Self {
        Self {
            name: name.into(),
            outline,
            grain: 0.0,
            quantity: 1,
            allowed: Allowed::two_way(),
            gap: 0.0,
            bundles: Vec::new(),
            fold_edge: None,
            match_point: None,
            over_flaws: false,
            locked: Vec::new(),
        }
    }

    /// The garment a copy belongs to.
    pub fn bundle(&self, copy: u32) -> u32 {
        self.bundles.get(copy as usize).copied().unwrap_or(0)
    }

    /// The smallest signed angle of the piece's grain from one of the allowed angles, counter-clockwise
    /// (rad).
    pub(crate) fn tilt_of(&self, turn: f64) -> f64 {
        let off = |allowed: &f64| {
            let apart = (turn - allowed).rem_euclid(TAU);
            if apart > PI { apart - TAU } else { apart }
        };
        let nearer = |a: f64, b: f64| if b.abs() < a.abs() { b } else { a };
        self.allowed.turns.iter().map(off).fold(PI, nearer)
    }
}

/// The directions in which pieces may lie on the fabric, because of its nap or print.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Nap {
    /// No nap: the fabric looks the same from both ends.
    #[default]
    None,
    /// A nap or a one-way print: every piece has turn 0.
    OneWay,
    /// A nap: each garment may run either way, but all its pieces the same way.
    PerBundle,
}

/// Folds of the fabric along the warp.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Fold {
    /// No fold: the fabric lies open.
    #[default]
    Open,
    /// Folded at y = 0; the selvedges lie on each other at y = width.
    Lower,
    /// Folded at y = 0 and at y = width: tubular fabric.
    Both,
}

/// A repeating print.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stripes {
    /// Length of a repeat along the warp and across it (m); 0 in a direction without repeat.
    pub repeat: Vec2,
    /// A point at which lines of the print cross (m).
    pub origin: Vec2,
}

/// A flaw in the fabric.
#[derive(Clone, Debug, PartialEq)]
pub struct Flaw {
    /// Outline of the flawed area (m), in the plane of the strip.
    pub outline: Polygon,
    /// Clearance between pieces and the flaw (m).
    pub clearance: f64,
}

/// The fabric.
#[derive(Clone, Debug, PartialEq)]
pub struct Strip {
    /// Full width, selvedges included (m).
    pub width: f64,
    /// Width of the unusable edge on either side (m).
    pub selvedge: f64,
    /// Fabric left free at either end (m).
    pub end_margin: f64,
    /// Smallest distance between two pieces (m).
    pub gap: f64,
    /// Length available, end margins included (m); `None` for no limit.
    pub max_length: Option<f64>,
    /// Nap of the fabric.
    pub nap: Nap,
    /// Folds. The width of folded fabric is that after folding, and there is no selvedge at a fold.
    pub fold: Fold,
    /// Print that the match points of pieces must meet.
    pub stripes: Option<Stripes>,
    /// Flaws that pieces must avoid.
    pub flaws: Vec<Flaw>,
}

impl Strip {
    /// Fabric of a width (m) without margins, gap or nap.
    pub fn of_width(width: f64) -> Self {
        Self {
            width,
            selvedge: 0.0,
            end_margin: 0.0,
            gap: 0.0,
            max_length: None,
            nap: Nap::None,
            fold: Fold::Open,
            stripes: None,
            flaws: Vec::new(),
        }
    }

    /// Smallest y that a piece may reach (m).
    pub fn lower(&self) -> f64 {
        match self.fold {
            Fold::Open => self.selvedge,
            Fold::Lower | Fold::Both => 0.0,
        }
    }

    /// Largest y that a piece may reach (m).
    pub fn upper(&self) -> f64 {
        match self.fold {
            Fold::Open | Fold::Lower => self.width - self.selvedge,
            Fold::Both => self.width,
        }
    }

    /// Number of layers in one ply: two if the fabric is folded.
    pub(crate) fn layers(&self) -> f64 {
        match self.fold {
            Fold::Open => 1.0,
            Fold::Lower | Fold::Both => 2.0,
        }
    }

    /// Width between the selvedges (m).
    pub fn usable_width(&self) -> f64 {
        self.upper() - self.lower()
    }

    /// Smallest distance between two items (m).
    pub fn gap_between(&self, a: &Item, b: &Item) -> f64 {
        self.gap.max(a.gap).max(b.gap)
    }
}

/// Transform from the piece to the marker: the grain is rotated to +x, the piece is turned over (y changes
/// sign), rotated by `turn`, then translated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Direction of the warp in the piece (rad).
    pub grain: f64,
    /// Angle from the warp of the fabric to the piece's grain (rad).
    pub turn: f64,
    /// Whether the piece lies face down.
    pub mirrored: bool,
    /// Translation after the rotation (m).
    pub translation: Vec2,
}

/// Cosine and sine, exact for whole quarter turns.
fn cos_sin(angle: f64) -> (f64, f64) {
    let quarters = (angle / FRAC_PI_2).round();
    if (angle - quarters * FRAC_PI_2).abs() > 1e-12 {
        let (sin, cos) = angle.sin_cos();
        return (cos, sin);
    }
    match quarters.rem_euclid(4.0) as u8 {
        0 => (1.0, 0.0),
        1 => (0.0, 1.0),
        2 => (-1.0, 0.0),
        _ => (0.0, -1.0),
    }
}

impl Pose {
    /// Columns of the linear part: images of the piece's x and y directions.
    pub fn axes(&self) -> [Vec2; 2] {
        let (cg, sg) = cos_sin(-self.grain);
        let (ct, st) = cos_sin(self.turn);
        let flip = if self.mirrored { -1.0 } else { 1.0 };
        let turned = |x: f64, y: f64| Vec2::new(ct * x - st * y, st * x + ct * y);
        [turned(cg, flip * sg), turned(-sg, flip * cg)]
    }

    /// Position on the marker of a point of the piece (m).
    pub fn apply(&self, point: Vec2) -> Vec2 {
        let [x, y] = self.axes();
        x * point.x + y * point.y + self.translation
    }

    /// A polygon of the piece, laid on the marker.
    pub fn lay(&self, polygon: &Polygon) -> Polygon {
        let [x, y] = self.axes();
        polygon.mapped(|p| x * p.x + y * p.y + self.translation)
    }
}

/// A ring mirrored at the x axis if `mirrored`, then rotated (rad).
pub(crate) fn turned(ring: &[Vec2], turn: f64, mirrored: bool) -> Vec<Vec2> {
    let pose = Pose {
        grain: 0.0,
        turn,
        mirrored,
        translation: Vec2::zeros(),
    };
    ring.iter().map(|&p| pose.apply(p)).collect()
}

/// The position of one copy of an item.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Index of the item.
    pub item: usize,
    /// Number of the copy, from 0.
    pub copy: u32,
    /// Angle from the warp to the piece's grain (rad).
    pub turn: f64,
    /// Whether the copy lies face down.
    pub mirrored: bool,
    /// Translation after the rotation (m).
    pub translation: Vec2,
}

impl Placement {
    /// Transform from the piece to the marker.
    pub fn pose(&self, item: &Item) -> Pose {
        Pose {
            grain: item.grain,
            turn: self.turn,
            mirrored: self.mirrored,
            translation: self.translation,
        }
    }
}

/// A copy that could not be placed.
#[derive(Clone, Debug, PartialEq)]
pub struct Unplaced {
    /// Index of the item.
    pub item: usize,
    /// Number of the copy, from 0.
    pub copy: u32,
    /// The reason, and the remedy.
    pub reason: String,
}

/// Pieces laid on fabric.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Marker {
    /// Positions of the laid copies.
    pub placements: Vec<Placement>,
    /// Length of fabric used, end margins included (m).
    pub length: f64,
    /// Area of the pieces divided by width times length between the end margins, 0 to 1 (1).
    pub efficiency: f64,
    /// Area of the pieces divided by width times length, 0 to 1 (1).
    pub utilisation: f64,
    /// Copies that could not be placed.
    pub unplaced: Vec<Unplaced>,
}

impl Marker {
    /// Computes length, efficiency and utilisation from the placements.
    pub fn measure(&mut self, items: &[Item], strip: &Strip) {
        let laid = || {
            self.placements
                .iter()
                .filter_map(|p| Some((p, items.get(p.item)?)))
        };
        let end = |(p, item): (&Placement, &Item)| p.pose(item).lay(&item.outline).bounds().max.x;
        let reach = laid().map(end).fold(strip.end_margin, f64::max);
        let area: f64 = laid().map(|(_, item)| item.outline.area()).sum();
        let share = |length: f64| {
            if length > 0.0 {
                area / (strip.width * length)
            } else {
                0.0
            }
        };
        self.length = reach + strip.end_margin;
        self.efficiency = share(reach - strip.end_margin);
        self.utilisation = share(self.length);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_turn_the_grain_onto_the_warp() {
        let pose = |turn: f64, mirrored: bool| Pose {
            grain: FRAC_PI_2,
            turn,
            mirrored,
            translation: Vec2::new(10.0, 0.0),
        };
        let grain = Vec2::new(0.0, 2.0);
        let right = Vec2::new(1.0, 0.0);
        assert_eq!(pose(0.0, false).apply(grain), Vec2::new(12.0, 0.0));
        assert_eq!(pose(0.0, true).apply(grain), Vec2::new(12.0, 0.0));
        assert_eq!(pose(PI, false).apply(grain), Vec2::new(8.0, 0.0));
        assert_eq!(pose(0.0, false).apply(right), Vec2::new(10.0, -1.0));
        assert_eq!(pose(0.0, true).apply(right), Vec2::new(10.0, 1.0));
        let [x, y] = Pose {
            grain: 0.3,
            ..pose(0.7, true)
        }
        .axes();
        assert!((x.norm() - 1.0).abs() < 1e-15 && x.dot(&y).abs() < 1e-15);
        assert!((x.perp(&y) + 1.0).abs() < 1e-15, "mirrored");
    }
}
