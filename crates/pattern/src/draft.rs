//! The draft: a pattern with every formula resolved for one set of measurements. Plain numbers.

use crate::stage::StageDart;
use crate::{
    BodyPart, EdgeCorner, EdgeName, Fabric, Facing, LineName, Name, NotchId, NotchKind,
    OperationId, PanelId, Role, SeamId,
};
use toile_geometry::{Curve, Rigid, Vec2, Vec3};

/// A resolved pattern: pieces of cloth to cut, and the seams between them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Draft {
    /// Name of the pattern.
    pub name: String,
    /// All pieces that are cut: one entry for each copy of a panel, with folded panels unfolded.
    pub pieces: Vec<Piece>,
    /// All seams between pieces, including the seams of darts.
    pub seams: Vec<DraftSeam>,
    /// Fabrics that the pieces are cut from.
    pub fabrics: Vec<Fabric>,
}

/// Identifier of one piece of cloth: a copy of a panel. Copy 0 is the panel as drawn; the odd copies of a
/// mirrored pair are reflected.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PieceId {
    /// The panel that the piece is a copy of.
    pub panel: PanelId,
    /// Number of the copy, from 0.
    pub copy: u32,
}

/// One flat piece of cloth as it is cut and sewn, without seam allowance.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// Panel and copy of the piece.
    pub id: PieceId,
    /// Name to show, unique in the draft.
    pub name: String,
    /// The closed outline: each edge ends where the next starts. Seen from the right side of the cloth it
    /// runs counter-clockwise.
    pub outline: Vec<PieceEdge>,
    /// Closed holes; they run the other way round than the outline.
    pub holes: Vec<Vec<PieceEdge>>,
    /// Lines drawn on the piece; edges of the mesh follow them.
    pub internal_lines: Vec<PieceLine>,
    /// Marks on the outline.
    pub notches: Vec<PieceNotch>,
    /// Darts taken out of the piece, including darts inside it.
    pub darts: Vec<StageDart>,
    /// Arrows in the directions in which the piece's darts and pleats are pressed.
    pub pressed: Vec<PressArrow>,
    /// Fold lines along which the piece was unfolded: a point on each (m) and its direction.
    pub folds: Vec<[Vec2; 2]>,
    /// Direction of the warp in the piece's plane (rad), from +x counter-clockwise.
    pub grain: f64,
    /// Index of the piece's fabric in [`Draft::fabrics`].
    pub fabric: usize,
    /// Place of the piece on the body.
    pub worn: Worn,
    /// Whether the piece is part of the garment (sewn to another piece, or the only panel); otherwise it is
    /// cut only (an extra copy, a facing that no seam names).
    pub sewn: bool,
}

/// The origin of an edge of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct EdgeOrigin {
    /// Name of the panel's edge, or of the edge that an operation made.
    pub name: EdgeName,
    /// Half of a folded panel: 0 is the half as drawn; each fold has one bit, which is set for the half
    /// beyond that fold.
    pub half: u8,
}

impl EdgeOrigin {
    /// An edge as drawn.
    pub fn drawn(edge: crate::EdgeId) -> Self {
        Self {
            name: Name::Drawn(edge),
            half: 0,
        }
    }

    /// The dart that this edge is a leg of, and the number of the leg: 0 before the apex along the outline
    /// and 1 after it; 0 to 3 round a dart inside the panel. `None`: the edge is no leg.
    pub fn leg(&self) -> Option<(OperationId, u16)> {
        match self.name {
            Name::Made {
                by,
                role: Role::Leg,
                index,
            } => Some((by, index)),
            Name::Drawn(_) | Name::Made { .. } => None,
        }
    }
}

/// One edge of a piece.
#[derive(Clone, Debug, PartialEq)]
pub struct PieceEdge {
    /// Origin of the edge.
    pub origin: EdgeOrigin,
    /// Curve of the edge, directed as the outline runs (m).
    pub curve: Curve,
    /// Width of the seam allowance outside the edge (m).
    pub seam_allowance: f64,
    /// Shape of the cut line at the corner where the edge starts.
    pub corner: EdgeCorner,
    /// Whether the edge runs against its direction as drawn, as on a mirror image: the corner at its start is
    /// then the corner at the end of the edge as drawn.
    pub reversed: bool,
}

/// A line inside a piece.
#[derive(Clone, Debug, PartialEq)]
pub struct PieceLine {
    /// Name of the panel's internal line, or of a line that an operation made: a fold of a pleat, or the line
    /// that a fold is laid to.
    pub name: LineName,
    /// Curves of the line, joined end to start (m).
    pub curves: Vec<Curve>,
}

/// A notch on a piece's outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PieceNotch {
    /// The notch of the panel.
    pub id: NotchId,
    /// The edge that the notch is on.
    pub edge: EdgeOrigin,
    /// Shape of the notch.
    pub kind: NotchKind,
    /// Position on the outline (m).
    pub point: Vec2,
    /// Unit vector from the notch into the piece.
    pub inward: Vec2,
}

/// A stretch of one piece's edge, from one fraction of its arc length to another; if `from > to` it is walked
/// backwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DraftSpan {
    /// Index into [`Draft::pieces`].
    pub piece: usize,
    /// Index of the edge in the piece: first the edges of the outline, then those of each hole.
    pub edge: usize,
    /// Fraction of the edge's arc length at which the span starts (1).
    pub from: f64,
    /// Fraction of the edge's arc length at which the span ends (1).
    pub to: f64,
}

/// Two chains of spans that are sewn together, beginning at the start of each chain.
#[derive(Clone, Debug, PartialEq)]
pub struct DraftSeam {
    /// The seam of the document, or the dart that the seam closes.
    pub id: SeamOrigin,
    /// Name to show.
    pub name: String,
    /// Both chains, each in walking order.
    pub sides: [Vec<DraftSpan>; 2],
    /// Whether the longer side is gathered or eased on purpose: its strain is then no fault.
    pub gathered: bool,
    /// Whether right sides lie together before sewing (the usual seam).
    pub right_sides_together: bool,
    /// Whether more than two plies may meet at the seam: merging the sides may then leave a non-manifold
    /// edge.
    pub multi_ply: bool,
}

/// The source of a seam of the draft.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SeamOrigin {
    /// A seam of the document.
    Seam(SeamId),
    /// The closing of a dart on a copy of a panel.
    Dart {
        /// The operation that takes the dart out.
        dart: OperationId,
        /// The copy of the panel.
        copy: u32,
        /// Half of a folded panel that the dart is on.
        half: u8,
    },
}

/// Place of a piece on the body before it is sewn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Worn {
    /// Wrapped round a body part.
    Wrapped {
        /// The body part.
        part: BodyPart,
        /// The side of the body part.
        facing: Facing,
        /// Height of the piece's reference point above the floor (m); for an arm, distance of that point
        /// along the arm from the shoulder point. `None`: the program decides.
        level: Option<f64>,
    },
    /// Placed in space by a rigid transformation from the piece to the world.
    Placed(Rigid),
    /// No place is given: the program decides from the seams.
    Automatic,
}

impl Worn {
    /// Place of the mirror image of the piece: on the other side of the body.
    #[must_use]
    pub(crate) fn mirror_image(self) -> Self {
        match self {
            Self::Automatic => Self::Automatic,
            Self::Wrapped {
                part,
                facing,
                level,
            } => Self::Wrapped {
                part: match part {
                    BodyPart::LeftArm => BodyPart::RightArm,
                    BodyPart::RightArm => BodyPart::LeftArm,
                    BodyPart::LeftLeg => BodyPart::RightLeg,
                    BodyPart::RightLeg => BodyPart::LeftLeg,
                    middle @ (BodyPart::Trunk | BodyPart::Head) => middle,
                },
                facing: match facing {
                    Facing::Left if is_middle(part) => Facing::Right,
                    Facing::Right if is_middle(part) => Facing::Left,
                    other @ (Facing::Front
                    | Facing::Back
                    | Facing::Left
                    | Facing::Right
                    | Facing::Around
                    | Facing::Over) => other,
                },
                level,
            },
            Self::Placed(rigid) => {
                let t = rigid.translation.vector;
                let q = rigid.rotation.into_inner();
                let mirrored = nalgebra::Quaternion::new(q.w, q.i, -q.j, -q.k);
                Self::Placed(Rigid::from_parts(
                    Vec3::new(-t.x, t.y, t.z).into(),
                    nalgebra::Unit::new_normalize(mirrored),
                ))
            }
        }
    }
}

/// Whether `Left` and `Right` of this body part are the wearer's left and right. On an arm they are above and
/// below.
fn is_middle(part: BodyPart) -> bool {
    !matches!(part, BodyPart::LeftArm | BodyPart::RightArm)
}

/// Direction in which a dart or a pleat is pressed: an arrow in the plane of its panel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressArrow {
    /// The dart or pleat that is pressed.
    pub by: OperationId,
    /// Half of a folded panel that the arrow is on.
    pub half: u8,
    /// Position of the middle of the arrow (m).
    pub at: Vec2,
    /// Direction of the arrow, a unit vector.
    pub way: Vec2,
    /// Width of the cloth that is folded under (m).
    pub width: f64,
}

impl PressArrow {
    /// The arrow mirrored in the y axis, for the mirrored piece of a pair.
    #[must_use]
    pub fn mirror_image(self) -> Self {
        let flip = |v: Vec2| Vec2::new(-v.x, v.y);
        Self {
            at: flip(self.at),
            way: flip(self.way),
            ..self
        }
    }
}
