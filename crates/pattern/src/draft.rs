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
    /// Every piece that is cut: folded panels unfolded, one entry for each copy.
    pub pieces: Vec<Piece>,
    /// Every seam between pieces, darts' seams included.
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
    /// The closed outline: each edge ends where the next starts. Its winding decides the right
    /// side of the cloth: seen from the right side it runs counter-clockwise.
    pub outline: Vec<PieceEdge>,
    /// Closed holes, wound against the outline.
    pub holes: Vec<Vec<PieceEdge>>,
    /// Lines drawn on the piece, which the mesh follows.
    pub internal_lines: Vec<PieceLine>,
    /// Marks on the outline.
    pub notches: Vec<PieceNotch>,
    /// Darts taken out of the piece, darts inside it too.
    pub darts: Vec<StageDart>,
    /// Arrows of the directions in which its darts and pleats are pressed.
    pub pressed: Vec<PressArrow>,
    /// Fold lines along which the piece was unfolded: a point on each (m) and its direction.
    pub folds: Vec<[Vec2; 2]>,
    /// Direction of the warp in the piece's plane (rad), from +x counter-clockwise.
    pub grain: f64,
    /// Index into [`Draft::fabrics`].
    pub fabric: usize,
    /// Place of the piece on the body.
    pub worn: Worn,
    /// Whether the piece is part of the garment (sewn to something, or the only panel), or only
    /// cut (an extra copy, a facing that no seam names).
    pub sewn: bool,
}

/// The origin of an edge of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct EdgeOrigin {
    /// The edge of the panel, or the edge that an operation made.
    pub name: EdgeName,
    /// Half of a folded panel: 0 as drawn; each fold has one bit, set for the half beyond that fold.
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
    /// and 1 after it; round a dart inside the panel 0 to 3.
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
    /// The curve of the edge, in the direction of the outline (m).
    pub curve: Curve,
    /// Width of the seam allowance outside the edge (m).
    pub seam_allowance: f64,
    /// Shape of the cut line at the corner at the start of the edge.
    pub corner: EdgeCorner,
    /// Whether the edge runs against the edge as drawn, as on a mirror image: the corner at its start is then
    /// the corner at the end of the edge as drawn.
    pub reversed: bool,
}

/// A line inside a piece.
#[derive(Clone, Debug, PartialEq)]
pub struct PieceLine {
    /// The internal line of the panel, or a line that an operation made: a fold of a pleat or the line that
    /// it is laid to.
    pub name: LineName,
    /// Joined curves (m).
    pub curves: Vec<Curve>,
}

/// A notch on a piece's outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PieceNotch {
    /// The notch of the panel.
    pub id: NotchId,
    /// The edge it is on.
    pub edge: EdgeOrigin,
    /// Shape of the notch.
    pub kind: NotchKind,
    /// Position on the outline (m).
    pub point: Vec2,
    /// Unit direction into the piece.
    pub inward: Vec2,
}

/// A stretch of one piece's edge, by fractions of its arc length; `from > to` walks it backwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DraftSpan {
    /// Index into [`Draft::pieces`].
    pub piece: usize,
    /// Index of the edge: outline edges first, then each hole's edges in order.
    pub edge: usize,
    /// Arc-length fraction at which the span starts.
    pub from: f64,
    /// Arc-length fraction at which the span ends.
    pub to: f64,
}

/// Two chains of spans that are sewn together: the start of one to the start of the other.
#[derive(Clone, Debug, PartialEq)]
pub struct DraftSeam {
    /// The seam of the document, or the seam a dart makes.
    pub id: SeamOrigin,
    /// Name to show.
    pub name: String,
    /// Both chains, each in walking order.
    pub sides: [Vec<DraftSpan>; 2],
    /// Whether the longer side is gathered or eased on purpose, so that its strain is expected.
    pub gathered: bool,
    /// Whether right sides lie together before sewing (the usual seam).
    pub right_sides_together: bool,
    /// Whether more than two plies may meet here, so that merging may leave a non-manifold edge.
    pub multi_ply: bool,
}

/// The origin of a seam of the draft.
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
        /// Half of a folded panel.
        half: u8,
    },
}

/// Place of a piece on the body before it is sewn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Worn {
    /// Wrapped round a body part by the program.
    Wrapped {
        /// The body part.
        part: BodyPart,
        /// The side of the body part.
        facing: Facing,
        /// Height of the piece's reference point above the floor (m), for an arm its distance along the arm
        /// from the shoulder point; none lets the program choose.
        level: Option<f64>,
    },
    /// Placed in space at a given position: world from piece.
    Placed(Rigid),
    /// No place is given: the program decides from the seams.
    Automatic,
}

impl Worn {
    /// The place of the mirror image: on the other side of the body.
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

/// Whether left and right of this body part are the wearer's own. On an arm they are above and below.
fn is_middle(part: BodyPart) -> bool {
    !matches!(part, BodyPart::LeftArm | BodyPart::RightArm)
}

/// Direction in which a dart or a pleat is pressed: an arrow in the plane of its panel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressArrow {
    /// The dart or pleat.
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
    /// The mirror image in the y axis, for the other piece of a pair.
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
