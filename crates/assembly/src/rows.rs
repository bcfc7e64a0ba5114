//! Arrangement of flat pieces before wrapping: heights and positions round the body part that bring sewn
//! edges near each other.

use crate::PlacementBody;
use crate::flat_pieces::{FlatPiece, Tie};
use crate::links::Links;
use crate::mesh::PieceMeshes;
use crate::part_frames::PartFrame;
use crate::role::Role;
use toile_geometry::Vec2;
use toile_pattern::{BodyPart, Draft, Facing};

/// Weight of the pull towards the middle of the side that a piece faces; a stitch has weight 1.
const FACING_WEIGHT: f64 = 0.5;
/// Number of sweeps of the solver for positions; garments have few pieces.
const SWEEPS: usize = 400;

/// Pieces on one body part at about the same height.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    pub part: BodyPart,
    /// Indices of meshed pieces.
    pub pieces: Vec<usize>,
    /// Total length of the pieces round the body part (m).
    pub girth: f64,
    /// Increase of the girth per metre downwards: sum of the sector angles of the flared pieces (rad).
    pub turn: f64,
}

/// Index of the group of body parts that are arranged together. Parts with heights above the floor form one
/// group. Each arm is a group of its own, and so is the head, whose pieces stand on the base of the neck, not
/// in the neckline.
fn family(part: BodyPart) -> usize {
    match part {
        BodyPart::LeftArm => 1,
        BodyPart::RightArm => 2,
        BodyPart::Head => 3,
        _ => 0,
    }
}

fn wrapped(role: &Role) -> Option<(BodyPart, Facing, Option<f64>)> {
    match *role {
        Role::Wrapped {
            part,
            facing,
            level,
        } if facing != Facing::Over => Some((part, facing, level)),
        _ => None,
    }
}

/// Sets the height of every wrapped piece: sewn edges at the same height, then each connected group moved to
/// the height at which it hangs.
pub(crate) fn set_heights(
    laid: &mut [FlatPiece],
    roles: &[Role],
    ties: &[Tie],
    (draft, meshes, body): (&Draft, &PieceMeshes, &PlacementBody),
) {
    let count = laid.len();
    let mut links = Links::new(count);
    let mut pulls: Vec<Vec<(usize, f64)>> = vec![Vec::new(); count];
    let mut reaches_upward = vec![false; count];
    for tie in ties {
        let [a, b] = tie.pieces;
        let (Some(x), Some(y)) = (wrapped(&roles[a]), wrapped(&roles[b])) else {
            continue;
        };
        if family(x.0) == family(y.0) {
            links.join(a, b);
            let difference = tie.points[1].y - tie.points[0].y;
            pulls[a].push((b, difference));
            pulls[b].push((a, -difference));
        } else {
            reaches_upward[a] = true;
            reaches_upward[b] = true;
        }
    }
    for _ in 0..SWEEPS {
        for k in 0..count {
            if !pulls[k].is_empty() {
                let sum: f64 = pulls[k].iter().map(|&(j, d)| laid[j].rise + d).sum();
                laid[k].rise = sum / pulls[k].len() as f64;
            }
        }
    }
    let groups: Vec<usize> = (0..count).map(|k| links.root(k)).collect();
    for root in 0..count {
        let members: Vec<usize> = (0..count)
            .filter(|&k| groups[k] == root && wrapped(&roles[k]).is_some())
            .collect();
        if members.is_empty() {
            continue;
        }
        let lift = group_lift(
            &members,
            laid,
            roles,
            (draft, meshes, body, &reaches_upward),
        );
        for &k in &members {
            laid[k].rise += lift;
        }
    }
}

/// Distance by which a group of pieces must rise to hang at the right height (m).
fn group_lift(
    members: &[usize],
    laid: &[FlatPiece],
    roles: &[Role],
    (draft, meshes, body, reaches_upward): (&Draft, &PieceMeshes, &PlacementBody, &[bool]),
) -> f64 {
    let told: Vec<f64> = members
        .iter()
        .filter_map(|&k| {
            let (part, _, level) = wrapped(&roles[k])?;
            // On an arm the level counts from the shoulder outward, opposite to the frame.
            let arm = matches!(part, BodyPart::LeftArm | BodyPart::RightArm);
            let height = if arm { -level? } else { level? };
            Some(height - laid[k].rise)
        })
        .collect();
    if !told.is_empty() {
        return told.iter().sum::<f64>() / told.len() as f64;
    }
    let part_of = |k: usize| wrapped(&roles[k]).map(|r| r.0);
    let top_of = |chosen: &dyn Fn(usize) -> bool| {
        members
            .iter()
            .filter(|&&k| chosen(k))
            .map(|&k| laid[k].span()[1])
            .fold(f64::NEG_INFINITY, f64::max)
    };
    let levels = &body.levels;
    match members.first().and_then(|&k| part_of(k)) {
        Some(BodyPart::LeftArm | BodyPart::RightArm) => return -top_of(&|_| true),
        Some(BodyPart::Head) => {
            let bottoms = members.iter().map(|&k| laid[k].span()[0]);
            return levels.neck - bottoms.fold(f64::INFINITY, f64::min);
        }
        _ => {}
    }
    let trunk = top_of(&|k| part_of(k) == Some(BodyPart::Trunk));
    let is_top = members.iter().any(|&k| reaches_upward[k])
        || has_shoulder_seam(members, laid, roles, (draft, meshes));
    if is_top && trunk.is_finite() {
        levels.neck - trunk
    } else {
        levels.waist + 0.01 - top_of(&|_| true)
    }
}

/// Whether a front is sewn to a back along the top of both, which distinguishes tops from skirts. A dart in the shoulder
/// makes that of one side steep: both together are wider than high.
fn has_shoulder_seam(
    members: &[usize],
    laid: &[FlatPiece],
    roles: &[Role],
    (draft, meshes): (&Draft, &PieceMeshes),
) -> bool {
    let mesh_of = |piece: usize| meshes.pieces.iter().position(|m| m.draft_piece == piece);
    draft.seams.iter().any(|seam| {
        let ends = [0, 1].map(|side| {
            let span = seam.sides[side].first()?;
            let k = mesh_of(span.piece).filter(|k| members.contains(k))?;
            let vertices = meshes.pieces[k].edge_vertices.get(span.edge)?;
            let heights = vertices.iter().map(|&v| laid[k].points[v as usize]);
            let (low, high) = heights.fold(
                (Vec2::repeat(f64::INFINITY), Vec2::repeat(f64::NEG_INFINITY)),
                |(l, h), p| (l.inf(&p), h.sup(&p)),
            );
            let size = laid[k].high.y - laid[k].low.y;
            let near_top = low.y > laid[k].high.y - 0.25 * size;
            let narrow = high.x - low.x < 0.45 * laid[k].width();
            let facing = wrapped(&roles[k])?.1;
            (near_top && narrow).then_some((facing, high - low))
        });
        let [Some((first, a)), Some((second, b))] = ends else {
            return false;
        };
        let sides = [first, second];
        let is_both = sides.contains(&Facing::Front) && sides.contains(&Facing::Back);
        is_both && a.x + b.x > a.y + b.y
    })
}

/// Groups wrapped pieces of one body part with overlapping heights into rows.
pub(crate) fn rows(laid: &[FlatPiece], roles: &[Role]) -> Vec<Row> {
    let count = laid.len();
    let mut links = Links::new(count);
    for a in 0..count {
        for b in a + 1..count {
            let (Some(x), Some(y)) = (wrapped(&roles[a]), wrapped(&roles[b])) else {
                continue;
            };
            let ([al, ah], [bl, bh]) = (laid[a].span(), laid[b].span());
            let overlap = ah.min(bh) - al.max(bl);
            if x.0 == y.0 && overlap > 0.4 * (ah - al).min(bh - bl) {
                links.join(a, b);
            }
        }
    }
    let mut rows: Vec<Row> = Vec::new();
    for root in 0..count {
        let pieces: Vec<usize> = (0..count)
            .filter(|&k| wrapped(&roles[k]).is_some() && links.root(k) == root)
            .collect();
        if let Some((part, ..)) = pieces.first().and_then(|&k| wrapped(&roles[k])) {
            let girth = pieces.iter().map(|&k| laid[k].width()).sum();
            let turn = pieces.iter().map(|&k| laid[k].turn).sum();
            rows.push(Row {
                part,
                pieces,
                girth,
                turn,
            });
        }
    }
    rows
}

/// Sets the distance of every piece round the body part: sewn edges near each other, pieces near the side
/// they face, on a ring as long as all pieces of the row together.
pub(crate) fn set_shifts(
    laid: &mut [FlatPiece],
    roles: &[Role],
    row: &Row,
    ties: &[Tie],
    frame: &PartFrame,
) {
    let girth = row.girth.max(1e-6);
    let home = |laid: &[FlatPiece], k: usize| {
        let facing = wrapped(&roles[k]).map_or(Facing::Front, |r| r.1);
        let quarter = frame.quarter(facing);
        let turn = if quarter == 3 { -1.0 } else { quarter as f64 };
        turn * 0.25 * girth - 0.5 * (laid[k].low.x + laid[k].high.x)
    };
    for &k in &row.pieces {
        laid[k].shift = home(laid, k);
    }
    let own: Vec<&Tie> = ties
        .iter()
        .filter(|t| t.pieces.iter().all(|p| row.pieces.contains(p)))
        .collect();
    let nearest = |d: f64| d - girth * (d / girth).round();
    for _ in 0..SWEEPS {
        for &k in &row.pieces {
            let mut sum = FACING_WEIGHT * home(laid, k);
            let mut weight = FACING_WEIGHT;
            for tie in &own {
                for (side, other) in [(0, 1), (1, 0)] {
                    if tie.pieces[side] == k {
                        let there = laid[tie.pieces[other]].shift + tie.points[other].x;
                        let here = laid[k].shift + tie.points[side].x;
                        sum += laid[k].shift + nearest(there - here);
                        weight += 1.0;
                    }
                }
            }
            laid[k].shift = sum / weight;
        }
    }
}
