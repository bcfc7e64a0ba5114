//! What is laid, on what, and the result.

use std::f64::consts::{FRAC_PI_2, PI};
use toile_geometry::{Polygon, Vec2};

/// How copies of a piece may be turned over.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Mirror {
    /// Every copy as drawn.
    #[default]
    Never,
    /// Left and right: copies 1, 3, 5... are mirrored.
    Pairs,
    /// Each copy either way, as the marker likes.
    Free,
}

/// The orientations a piece may take on the fabric.
#[derive(Clone, Debug, PartialEq)]
pub struct Allowed {
    /// Angles between the piece's grain and the warp \[rad\], counter-clockwise.
    pub turns: Vec<f64>,
    /// Whether it may be turned over.
    pub mirror: Mirror,
}

impl Allowed {
    /// Grain along the warp, one way only.
    pub fn one_way() -> Self {
        Self {
            turns: vec![0.0],
            mirror: Mirror::Never,
        }
    }

    /// Grain along the warp, either way.
    pub fn two_way() -> Self {
        Self {
            turns: vec![0.0, PI],
            mirror: Mirror::Never,
        }
    }

    /// The same with another rule for turning over.
    pub fn mirrored(self, mirror: Mirror) -> Self {
        Self { mirror, ..self }
    }
}

/// A piece to lay, by its cut outline.
#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    /// Name for messages.
    pub name: String,
    /// Cut outline, curves flattened \[m\]. Pieces are not laid into each other's holes.
    pub outline: Polygon,
    /// Direction of the warp in the outline's plane \[rad\], counter-clockwise from +x.
    pub grain: f64,
    /// Number of copies.
    pub quantity: u32,
    /// Orientations it may take.
    pub allowed: Allowed,
    /// Free fabric this piece needs to any other \[m\]; the strip's gap holds where it is larger.
    pub gap: f64,
}

impl Item {
    /// One copy, grain along +x, either way.
    pub fn new(name: impl Into<String>, outline: Polygon) -> Self {
        Self {
            name: name.into(),
            outline,
            grain: 0.0,
            quantity: 1,
            allowed: Allowed::two_way(),
            gap: 0.0,
        }
    }
}

/// Whether the fabric looks the same from both ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Nap {
    /// It does.
    #[default]
    None,
    /// It has a nap or a one-way print: every piece keeps turn 0.
    OneWay,
}

/// The fabric.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strip {
    /// Full width, selvedges included \[m\].
    pub width: f64,
    /// Unusable edge at either side \[m\].
    pub selvedge: f64,
    /// Fabric left free at either end \[m\].
    pub end_margin: f64,
    /// Least distance between two pieces \[m\].
    pub gap: f64,
    /// Length at hand, end margins included \[m\]; nothing means as long as it takes.
    pub max_length: Option<f64>,
    /// Nap.
    pub nap: Nap,
}

impl Strip {
    /// Fabric of a width \[m\] without margins, gap or nap.
    pub fn of_width(width: f64) -> Self {
        Self {
            width,
            selvedge: 0.0,
            end_margin: 0.0,
            gap: 0.0,
            max_length: None,
            nap: Nap::None,
        }
    }

    /// Width between the selvedges \[m\].
    pub fn usable_width(&self) -> f64 {
        self.width - 2.0 * self.selvedge
    }

    /// Least distance two items must keep \[m\].
    pub fn gap_between(&self, a: &Item, b: &Item) -> f64 {
        self.gap.max(a.gap).max(b.gap)
    }
}

/// Marker from piece: grain to +x, then turned over (y changes sign), then turned, then moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Direction of the warp in the piece \[rad\].
    pub grain: f64,
    /// Angle from the warp of the fabric to the piece's grain \[rad\].
    pub turn: f64,
    /// Whether the piece lies face down.
    pub mirrored: bool,
    /// Move after turning \[m\].
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
    /// The columns of the linear part: where the piece's x and y directions go.
    pub fn axes(&self) -> [Vec2; 2] {
        let (cg, sg) = cos_sin(-self.grain);
        let (ct, st) = cos_sin(self.turn);
        let flip = if self.mirrored { -1.0 } else { 1.0 };
        let turned = |x: f64, y: f64| Vec2::new(ct * x - st * y, st * x + ct * y);
        [turned(cg, flip * sg), turned(-sg, flip * cg)]
    }

    /// Where a point of the piece lies on the marker \[m\].
    pub fn apply(&self, point: Vec2) -> Vec2 {
        let [x, y] = self.axes();
        x * point.x + y * point.y + self.translation
    }

    /// A whole polygon laid on the marker.
    pub fn lay(&self, polygon: &Polygon) -> Polygon {
        let [x, y] = self.axes();
        polygon.mapped(|p| x * p.x + y * p.y + self.translation)
    }
}

/// One piece laid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Index of the item.
    pub item: usize,
    /// Number of the copy, from 0.
    pub copy: u32,
    /// Angle from the warp to the piece's grain \[rad\].
    pub turn: f64,
    /// Whether it lies face down.
    pub mirrored: bool,
    /// Move after turning \[m\].
    pub translation: Vec2,
}

impl Placement {
    /// Marker from piece.
    pub fn pose(&self, item: &Item) -> Pose {
        Pose {
            grain: item.grain,
            turn: self.turn,
            mirrored: self.mirrored,
            translation: self.translation,
        }
    }
}

/// A copy that found no place.
#[derive(Clone, Debug, PartialEq)]
pub struct Unplaced {
    /// Index of the item.
    pub item: usize,
    /// Number of the copy, from 0.
    pub copy: u32,
    /// Why, and what helps.
    pub reason: String,
}

/// Pieces laid on fabric.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Marker {
    /// What lies where, by item and copy.
    pub placements: Vec<Placement>,
    /// Fabric used, end margins included \[m\].
    pub length: f64,
    /// Area of the pieces over width times length between the end margins, 0..=1.
    pub efficiency: f64,
    /// Area of the pieces over width times length, 0..=1.
    pub utilisation: f64,
    /// Copies that found no place.
    pub unplaced: Vec<Unplaced>,
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
