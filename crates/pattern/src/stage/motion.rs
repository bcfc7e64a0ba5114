//! Rigid motions of parts of a stage.

use super::{StageDart, StageEdge, StageNotch};
use toile_geometry::{Curve, Vec2};

/// The vector `v`, turned counter-clockwise by an angle (rad).
pub(super) fn turned(v: Vec2, angle: f64) -> Vec2 {
    let (sin, cos) = angle.sin_cos();
    Vec2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y)
}

/// A rigid motion: a turn about the origin, followed by a shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Motion {
    /// Angle of the turn, counter-clockwise (rad).
    angle: f64,
    shift: Vec2,
}

impl Motion {
    /// The identity: it leaves points unchanged to the last bit.
    pub const NONE: Self = Self {
        angle: 0.0,
        shift: Vec2::new(0.0, 0.0),
    };

    /// The motion that turns by `angle` (rad) and takes the point `from` to the point `to`.
    pub fn taking(from: Vec2, to: Vec2, angle: f64) -> Self {
        let turn = Self {
            angle,
            shift: Vec2::zeros(),
        };
        Self {
            shift: to - turn.direction(from),
            ..turn
        }
    }

    /// The turn about a point by an angle (rad).
    pub fn about(centre: Vec2, angle: f64) -> Self {
        Self::taking(centre, centre, angle)
    }

    /// The motion that first does `first` and then this motion.
    pub fn after(self, first: Self) -> Self {
        Self {
            angle: self.angle + first.angle,
            shift: self.point(first.shift),
        }
    }

    fn is_none(self) -> bool {
        self == Self::NONE
    }

    pub fn direction(self, v: Vec2) -> Vec2 {
        match self.angle == 0.0 {
            true => v,
            false => turned(v, self.angle),
        }
    }

    pub fn point(self, p: Vec2) -> Vec2 {
        match self.is_none() {
            true => p,
            false => self.direction(p) + self.shift,
        }
    }

    pub fn curve(self, curve: Curve) -> Curve {
        match self.is_none() {
            true => curve,
            false => curve.rotated(self.angle).translated(self.shift),
        }
    }

    pub fn edge(self, edge: &StageEdge) -> StageEdge {
        StageEdge {
            curve: self.curve(edge.curve),
            ..edge.clone()
        }
    }

    pub fn notch(self, notch: StageNotch) -> StageNotch {
        StageNotch {
            point: self.point(notch.point),
            inward: self.direction(notch.inward),
            ..notch
        }
    }

    /// Moves a dart: the start of its mouth by this motion, the end of its mouth by `other`.
    pub fn dart(self, other: Self, dart: StageDart) -> StageDart {
        let [start, end] = dart.mouth;
        StageDart {
            mouth: [self.point(start), other.point(end)],
            apex: self.point(dart.apex),
            pivot: self.point(dart.pivot),
            ..dart
        }
    }
}
