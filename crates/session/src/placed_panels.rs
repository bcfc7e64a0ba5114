//! Panels that a file places in space: the height of the origin they stand round, and how their sleeves hold
//! the arms.

use serde::{Deserialize, Serialize};
use std::sync::Arc;
use toile_assembly::body_part_by_name;
use toile_geometry::{Curve, Vec2, Vec3};
use toile_measure::Measurements;
use toile_pattern::{BodyPart, Draft, Pattern, Piece, Worn, WornRule};

/// The point of the body that a file places its panels round.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PanelOrigin {
    /// Detected from the positions of the panels.
    #[default]
    Automatic,
    /// The floor between the feet, as in Toile.
    Floor,
    /// The centre of the body at the height of the waist.
    Waist,
    /// The pelvis of the body model SMPL, as its authors' garments are placed.
    Pelvis,
    /// A point at a height above the floor (m).
    Height(f64),
}

/// Height of the waist of an adult of average stature above the floor (m).
const WAIST: f64 = 1.05;
/// Height of the origin of SMPL's average body, which its authors call the pelvis, above the floor (m).
const PELVIS: f64 = 1.12;
/// Height below which a panel reaches through the floor (m); the hem of a long garment may touch the floor.
const BELOW_FLOOR: f64 = -0.05;
/// Least height above the floor of the middle of a panel of a head, an arm or a trunk (m): a child of one
/// year is 75 cm tall.
const LOWEST: [(BodyPart, f64); 4] = [
    (BodyPart::Head, 0.55),
    (BodyPart::LeftArm, 0.35),
    (BodyPart::RightArm, 0.35),
    (BodyPart::Trunk, 0.2),
];
/// Greatest height of the upper edge of a garment (m).
const HIGHEST: f64 = 2.2;
/// Range of the angle below the horizontal that arms can be held at (rad).
const ARM_ANGLES: [f64; 2] = [0.0, 1.4];

/// Height by which panels are raised to stand on the floor (m), and a note on it.
#[derive(Clone, Debug, Default, PartialEq)]
struct Raise {
    height: f64,
    note: Option<String>,
}

impl PanelOrigin {
    /// Height of the origin above the floor (m); `None` if it is to be detected.
    fn height(self) -> Option<f64> {
        match self {
            Self::Automatic => None,
            Self::Floor => Some(0.0),
            Self::Waist => Some(WAIST),
            Self::Pelvis => Some(PELVIS),
            Self::Height(height) => Some(height),
        }
    }

    /// Raises those panels of a pattern that its file places in space round this point, so that they stand on
    /// the floor. Returns a note if the origin was detected, or could not be.
    pub(crate) fn settle(self, pattern: &mut Pattern) -> Option<String> {
        if !has_placed_panels(pattern) {
            return None;
        }
        let Raise { height, note } = match self.height() {
            Some(height) => Raise { height, note: None },
            None => found(&draft_of(pattern)),
        };
        for panel in &mut pattern.panels {
            // A height of 0 leaves positions unchanged to the bit.
            if height != 0.0
                && matches!(panel.worn, WornRule::Placed { .. })
                && let WornRule::Placed { translation, .. } = &mut Arc::make_mut(panel).worn
            {
                translation[1] += height;
            }
        }
        note
    }
}

fn has_placed_panels(pattern: &Pattern) -> bool {
    let mut panels = pattern.panels.iter();
    panels.any(|panel| matches!(panel.worn, WornRule::Placed { .. }))
}

fn draft_of(pattern: &Pattern) -> Draft {
    let none = Measurements::new();
    pattern
        .resolve(pattern.base_measurements().unwrap_or(&none))
        .0
}

/// The sewn pieces of a draft that are placed in space, with corners and midpoints of their edges there (m).
fn placed_pieces(draft: &Draft) -> impl Iterator<Item = (usize, &Piece, Vec<Vec3>)> {
    draft.pieces.iter().enumerate().filter_map(|(k, piece)| {
        let curves = piece.outline.iter().map(|edge| &edge.curve);
        let points: Vec<Vec3> = curves
            .flat_map(|curve| points_in_space(piece, curve))
            .collect();
        (piece.sewn && !points.is_empty()).then_some((k, piece, points))
    })
}

/// Start and midpoint of a curve of a piece that is placed in space (m); empty for other pieces.
fn points_in_space(piece: &Piece, curve: &Curve) -> Vec<Vec3> {
    let Worn::Placed(place) = piece.worn else {
        return Vec::new();
    };
    let at = |p: Vec2| place.rotation * Vec3::new(p.x, p.y, 0.0) + place.translation.vector;
    [0.0, 0.5].map(|t| at(curve.point(t))).to_vec()
}

/// Heights of the lowest and the highest of some points (m).
fn span(points: &[Vec3]) -> [f64; 2] {
    let empty = [f64::INFINITY, f64::NEG_INFINITY];
    let heights = points.iter().map(|p| p.y);
    heights.fold(empty, |[low, high], y| [low.min(y), high.max(y)])
}

/// Detects the origin that puts every panel where a body can wear it; the floor is preferred.
fn found(draft: &Draft) -> Raise {
    let pieces: Vec<(Option<BodyPart>, [f64; 2])> = placed_pieces(draft)
        .map(|(_, piece, points)| (body_part_by_name(piece), span(&points)))
        .collect();
    let is_plausible = |raised: f64| {
        pieces.iter().all(|(part, [low, high])| {
            let least = LOWEST.iter().find(|row| Some(row.0) == *part);
            let middle = raised + 0.5 * (low + high);
            raised + low >= BELOW_FLOOR
                && raised + high <= HIGHEST
                && least.is_none_or(|row| middle >= row.1)
        })
    };
    if pieces.is_empty() || is_plausible(0.0) {
        return Raise::default();
    }
    let lowest = pieces.iter().map(|row| row.1[0]);
    let lowest = lowest.fold(f64::INFINITY, f64::min);
    let seen = match lowest < BELOW_FLOOR {
        true => format!("the panels reach {:.2} m below the floor", -lowest),
        false => "the panels lie too near the floor for what they are worn on".to_owned(),
    };
    let origins = [(PELVIS, "pelvis"), (WAIST, "waist")];
    match origins.iter().find(|origin| is_plausible(origin.0)) {
        Some((height, name)) => Raise {
            height: *height,
            note: Some(format!(
                "{seen}: they are taken as placed round the {name}, and raised by {height} m to stand on the floor; --origin says otherwise"
            )),
        },
        None => Raise {
            height: 0.0,
            note: Some(format!(
                "{seen}, and neither pelvis nor waist as their origin sets that right; give its height above the floor, as in --origin 90cm"
            )),
        },
    }
}

/// Pieces that an edge of a piece is sewn to.
fn partners(draft: &Draft, [piece, edge]: [usize; 2]) -> Vec<usize> {
    let mut found = Vec::new();
    for seam in &draft.seams {
        for side in [0, 1] {
            let mut here = seam.sides[side].iter();
            if here.any(|span| span.piece == piece && span.edge == edge) {
                found.extend(seam.sides[1 - side].iter().map(|span| span.piece));
            }
        }
    }
    found
}

/// The angle below the horizontal at which the sleeves of a pattern hold the arms (rad), where its file
/// places them in space: from the seams that set them in to their free edges.
pub(crate) fn sleeve_angle(pattern: &Pattern) -> Option<f64> {
    if !has_placed_panels(pattern) {
        return None;
    }
    let draft = draft_of(pattern);
    let is_sleeve = |k: usize| {
        let part = draft.pieces.get(k).and_then(body_part_by_name);
        matches!(part, Some(BodyPart::LeftArm | BodyPart::RightArm))
    };
    // Sums of points of edges, with the number of points: of edges sewn to another part of the garment, and
    // of edges that are not sewn.
    let [mut armhole, mut free] = [(Vec3::zeros(), 0.0); 2];
    for (k, piece, _) in placed_pieces(&draft).filter(|row| is_sleeve(row.0)) {
        for (e, edge) in piece.outline.iter().enumerate() {
            let (mut is_sewn, mut sets_in) = (false, false);
            for other in partners(&draft, [k, e]) {
                is_sewn = true;
                sets_in |= !is_sleeve(other);
            }
            let sum = match (is_sewn, sets_in) {
                (_, true) => &mut armhole,
                (false, _) => &mut free,
                _ => continue,
            };
            for p in points_in_space(piece, &edge.curve.reversed())
                .into_iter()
                .chain(points_in_space(piece, &edge.curve))
            {
                // Both arms as one: outward is +x.
                sum.0 += Vec3::new(p.x.abs(), p.y, 0.0);
                sum.1 += 1.0;
            }
        }
    }
    if armhole.1 == 0.0 || free.1 == 0.0 {
        return None;
    }
    let along = free.0 / free.1 - armhole.0 / armhole.1;
    let angle = (-along.y).atan2(along.x);
    (along.x > 0.0).then(|| angle.clamp(ARM_ANGLES[0], ARM_ANGLES[1]))
}
