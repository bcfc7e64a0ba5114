//! Wraps rows of pieces round a body part, outside the skin, without stretching them.

use crate::PlacementBody;
use crate::flared_row::wrap_flared;
use crate::flat_pieces::FlatPiece;
use crate::outline_curve::OutlineCurve;
use crate::part_frames::PartFrame;
use crate::role::Role;
use crate::rows::Row;
use crate::surroundings::{BAND, Fit, Surroundings, arm_distance, obstacles, skin_outline};
use toile_geometry::{Vec2, Vec3, closed_length, convex_hull};
use toile_pattern::{BodyPart, Facing};

/// Initial distance of cloth from the convex hull of the skin (m).
const FIRST_DISTANCE: f64 = 0.012;
/// Factor on the positions of a row's pieces round the part, which leaves gaps between neighbours.
const SPREAD: f64 = 1.02;
/// Smallest room for folds in which a ring is folded (m).
const MIN_FOLD: f64 = 0.04;
/// Distance that pieces of one leg keep from the middle of the body (m).
const MIDDLE_CLEARANCE: f64 = 0.006;

/// The shape to which a row is bent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Bend {
    /// A ring round the part.
    Ring,
    /// Curves in front of and behind the part: no ring fits under the arms or between the legs.
    Sides,
}

fn bend(row: &Row, laid: &[FlatPiece], body: &PlacementBody) -> Bend {
    match row.part {
        BodyPart::LeftLeg | BodyPart::RightLeg => Bend::Sides,
        BodyPart::Trunk => {
            let top = row.pieces.iter().map(|&k| laid[k].span()[1]);
            if top.fold(f64::NEG_INFINITY, f64::max) > body.levels.chest + BAND {
                Bend::Sides
            } else {
                Bend::Ring
            }
        }
        _ => Bend::Ring,
    }
}

fn facing_of(role: &Role) -> Facing {
    match role {
        Role::Wrapped { facing, .. } => *facing,
        Role::Placed(_) => Facing::Front,
    }
}

/// Positions of the pieces of a row (m), in the order of the row.
pub(crate) fn wrap_row(
    row: &Row,
    laid: &[FlatPiece],
    roles: &[Role],
    around: &Surroundings,
    fit: Fit,
) -> Vec<Vec<Vec3>> {
    let frame = PartFrame::new(around.body, row.part);
    if row.turn > 0.0 {
        return wrap_flared(row, laid, around, &frame, fit);
    }
    let spans = row.pieces.iter().map(|&k| laid[k].span());
    let band = spans.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], [a, b]| {
        [l.min(a + fit.lift - BAND), h.max(b + fit.lift + BAND)]
    });
    let shape = bend(row, laid, around.body);
    let ring = ring_for(row, around, &frame, band, fit.distance);
    row.pieces
        .iter()
        .map(|&k| {
            let facing = facing_of(&roles[k]);
            let quarter = frame.quarter(facing);
            let sideways = matches!(facing, Facing::Front | Facing::Back);
            if shape == Bend::Sides && (sideways || row.part != BodyPart::Trunk) {
                let place = SidePlace {
                    frame: &frame,
                    quarter,
                    band,
                };
                wrap_side(row, &laid[k], around, &place, fit)
            } else {
                wrap_ring(row, &laid[k], &frame, &ring, fit)
            }
        })
        .collect()
}

fn ring_for(
    row: &Row,
    around: &Surroundings,
    frame: &PartFrame,
    band: [f64; 2],
    distance: f64,
) -> OutlineCurve {
    let points = skin_outline(row.part, around, frame, [band[0] + BAND, band[1] - BAND]);
    let length = row.girth * SPREAD + 0.01;
    let hull = closed_length(&convex_hull(&points));
    let wanted = ((length - hull) / std::f64::consts::TAU).max(FIRST_DISTANCE) + distance;
    let ring = OutlineCurve::ring(&points, Vec2::zeros(), wanted);
    if row.part != BodyPart::Trunk {
        return ring;
    }
    // Wide skirts would touch the arms: they are laid in folds between body and arms.
    let free = arm_distance(row.part, around, frame, [band[0] + BAND, band[1] - BAND]);
    let close = OutlineCurve::ring(&points, Vec2::zeros(), FIRST_DISTANCE + distance);
    let room = free - close.reach(Vec2::zeros());
    if ring.reach(Vec2::zeros()) <= free || room < MIN_FOLD {
        return ring;
    }
    let base = FIRST_DISTANCE + distance + 0.3 * room;
    OutlineCurve::ring(&points, Vec2::zeros(), base).folded(length, 0.65 * room)
}

fn wrap_ring(
    row: &Row,
    piece: &FlatPiece,
    frame: &PartFrame,
    ring: &OutlineCurve,
    fit: Fit,
) -> Vec<Vec3> {
    let middle = piece.shift + 0.5 * (piece.low.x + piece.high.x);
    let spread = middle * (ring.length() / row.girth.max(1e-6));
    piece
        .points
        .iter()
        .map(|p| {
            let along = spread + (p.x + piece.shift - middle);
            frame.on_curve(ring, 0, along, p.y + piece.rise + fit.lift)
        })
        .collect()
}

struct SidePlace<'a> {
    frame: &'a PartFrame,
    quarter: usize,
    band: [f64; 2],
}

/// Wraps a piece over the front or back of the trunk or of a leg.
fn wrap_side(
    row: &Row,
    piece: &FlatPiece,
    around: &Surroundings,
    place: &SidePlace,
    fit: Fit,
) -> Vec<Vec3> {
    let frame = place.frame;
    let turn = if place.quarter == 3 {
        -1.0
    } else {
        place.quarter as f64
    };
    let ring_middle = piece.shift + 0.5 * (piece.low.x + piece.high.x);
    let home = turn * 0.25 * row.girth;
    let mut middle = ring_middle - home;
    middle = (middle - row.girth * (middle / row.girth.max(1e-6)).round()) * SPREAD;
    let half = 0.5 * piece.width();
    let side = match row.part {
        BodyPart::LeftLeg => Some(1.0),
        BodyPart::RightLeg => Some(-1.0),
        _ => None,
    };
    let reach = middle.abs() + half + 0.02;
    let points: Vec<Vec2> = obstacles(row.part, around, frame, place.band, |p, label| {
        let arm = matches!(label, BodyPart::LeftArm | BodyPart::RightArm);
        frame.across(p, place.quarter).x.abs() <= reach && (side.is_none() || !arm)
    })
    .into_iter()
    .map(|p| frame.across(p, place.quarter))
    .collect();
    let curve = OutlineCurve::front(&points, 0.0, FIRST_DISTANCE + fit.distance);
    let bent = |middle: f64| -> Vec<Vec3> {
        let mean = 0.5 * (piece.low.x + piece.high.x);
        piece
            .points
            .iter()
            .map(|p| {
                let along = middle + p.x - mean;
                frame.on_curve(&curve, place.quarter, along, p.y + piece.rise + fit.lift)
            })
            .collect()
    };
    let mut positions = bent(middle);
    if let Some(side) = side {
        // Mirrored copies must not cross in the middle of the body.
        let outward = if place.quarter == 2 { -side } else { side };
        for _ in 0..20 {
            let nearest = positions
                .iter()
                .map(|p| side * p.x)
                .fold(f64::INFINITY, f64::min);
            if nearest >= MIDDLE_CLEARANCE {
                break;
            }
            middle += outward * (MIDDLE_CLEARANCE - nearest + 1e-3);
            positions = bent(middle);
        }
    }
    positions
}

/// Lays a piece flat over the body like a poncho, with the hole (else the middle) over the neck, at the
/// lowest height above the shoulders at which the hole clears the skin. Returns whether it does.
pub(crate) fn lay_over(
    piece: &FlatPiece,
    hole: &[Vec2],
    body: &PlacementBody,
    lift: f64,
) -> (Vec<Vec3>, bool) {
    let neck = body
        .limbs
        .iter()
        .find(|l| l.part == BodyPart::Head)
        .and_then(|l| l.axis.first().copied())
        .unwrap_or_else(|| Vec3::new(0.0, body.levels.neck, 0.0));
    let ring: &[Vec2] = if hole.is_empty() { &piece.points } else { hole };
    let middle = ring.iter().sum::<Vec2>() / ring.len().max(1) as f64;
    let at = |p: Vec2, height: f64| {
        // The top of the piece lies behind the neck, with its right side up.
        Vec3::new(neck.x + p.x - middle.x, height, neck.z - (p.y - middle.y))
    };
    let skin = &body.skin.mesh().positions;
    let clears = |height: f64| {
        let slab = 0.012;
        skin.iter()
            .filter(|p| (p.y - height).abs() < slab)
            .all(|p| {
                let flat = Vec2::new(p.x - neck.x + middle.x, middle.y - (p.z - neck.z));
                inside_by(flat, hole, 0.004)
            })
    };
    let mut height = body.levels.shoulder + 0.02;
    let mut clear = false;
    while height < body.levels.crown + 0.05 {
        if clears(height) {
            clear = true;
            break;
        }
        height += 0.005;
    }
    let place = height + lift;
    (piece.points.iter().map(|&p| at(p, place)).collect(), clear)
}

/// Whether a point lies inside a polygon, at least `margin` (m) from its corners and edges.
fn inside_by(p: Vec2, polygon: &[Vec2], margin: f64) -> bool {
    let mut inside = false;
    for k in 0..polygon.len() {
        let (a, b) = (polygon[k], polygon[(k + 1) % polygon.len()]);
        if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y) {
            inside = !inside;
        }
        let d = b - a;
        let t = ((p - a).dot(&d) / d.norm_squared().max(1e-18)).clamp(0.0, 1.0);
        if (a + d * t - p).norm() < margin {
            return false;
        }
    }
    inside
}
