//! The pieces of one fabric as items of the search: cut outlines, copies, allowed positions.

use crate::marks::turned;
use crate::matching::match_up;
use crate::options::FabricPlan;
use crate::pieces::PieceToCut;
use crate::{MarkerError, NestOptions};
use std::collections::BTreeSet;
use std::f64::consts::PI;
use std::sync::Arc;
use toile_cut::{CutPiece, HalfPlane};
use toile_geometry::Vec2;

use toile_nesting::{
    Allowed, FoldEdge, Item, Locked, MatchPoint, Mirror, Nap, NestingError, Phase,
};
use toile_pattern::Spread;

/// Items; for each its index among the pieces to cut and its drawing; notes for the cutter.
type Items = (Vec<Item>, Vec<(usize, Arc<CutPiece>)>, Vec<String>);

/// The pieces of one fabric as items to lay on it.
pub(crate) fn items_on(
    to_cut: &[PieceToCut],
    plan: &FabricPlan,
    options: &NestOptions,
) -> Result<Items, MarkerError> {
    let mut items = Vec::new();
    let mut drawn = Vec::new();
    let mut notes: Vec<String> = Vec::new();
    for note in to_cut.iter().flat_map(|to_cut| &to_cut.notes) {
        // Garments that are matched separately repeat the notes of the same pieces.
        if !notes.contains(note) {
            notes.push(note.clone());
        }
    }
    let printed = plan.rolls.iter().any(|r| r.strip.stripes.is_some());
    let matched = to_cut.iter().any(|w| !w.marks.is_empty());
    let each_alone = plan.rolls.iter().any(|r| r.strip.nap == Nap::PerBundle);
    for (k, role) in roles(to_cut, plan)?.into_iter().enumerate() {
        let to_cut = &to_cut[k];
        let on_print = to_cut.settings.rule.on_print.unwrap_or(!matched);
        let print = printed && on_print && to_cut.marks.is_empty();
        let mut item = item_of(to_cut, print, (plan, options));
        match role {
            Role::Twin => continue,
            Role::Alone => {}
            Role::Paired => item.allowed.mirror = Mirror::Free,
            Role::Half(half) => {
                let (halved, piece) = halved(item, &to_cut.cut, half);
                items.push(halved);
                drawn.push((k, piece));
                continue;
            }
            Role::Two { spare } => {
                let left = two_at_once(&mut item, spare, each_alone);
                if left > 0 {
                    notes.push(format!(
                        "{}: two plies are cut at once, {left} more than needed",
                        item.name
                    ));
                }
            }
        }
        items.push(item);
        drawn.push((k, to_cut.cut.clone()));
    }
    notes.extend(holes_left(&items));
    if printed {
        let order: Vec<usize> = drawn.iter().map(|d| d.0).collect();
        match_up(&mut items, &order, (to_cut, plan))?;
    }
    if plan.plies > 1 {
        notes.push(format!(
            "{} plies: every piece on the marker is cut {0} times",
            plan.plies
        ));
    }
    Ok((items, drawn, notes))
}

/// A note about pieces with holes, since a search lays nothing into them.
fn holes_left(items: &[Item]) -> Option<String> {
    let holed = items.iter().filter(|item| !item.outline.holes.is_empty());
    let mut names: Vec<&str> = holed.map(|item| &*item.name).collect();
    names.dedup();
    let of = names.join(", ");
    (!names.is_empty()).then(|| {
        format!("{of}: no piece is laid into its holes, and their cloth counts as not used")
    })
}

/// Adapts a piece that is cut twice at each placement: half as many placements, or all of them if one of the
/// two cuts is mirrored wrongly (`spare`). Returns the number of surplus cuts. If the pieces of each garment
/// must point one way, both cuts belong to one garment.
fn two_at_once(item: &mut Item, spare: bool, each_alone: bool) -> u32 {
    let count = item.quantity;
    item.allowed.mirror = Mirror::Free;
    if !spare && each_alone {
        let garments: BTreeSet<u32> = item.bundles.iter().copied().collect();
        let laid = |garment: u32| {
            let own = item.bundles.iter().filter(|&&b| b == garment).count();
            std::iter::repeat_n(garment, own.div_ceil(2))
        };
        item.bundles = garments.into_iter().flat_map(laid).collect();
        item.quantity = item.bundles.len() as u32;
    } else {
        item.quantity = if spare { count } else { count.div_ceil(2) };
        item.bundles.truncate(item.quantity as usize);
    }
    2 * item.quantity - count
}

/// The role of a piece on fabric with two layers.
enum Role {
    /// Cut as it is laid.
    Alone,
    /// One of a pair, laid either face up or face down.
    Paired,
    /// Cut together with its mirror image, which is laid instead of it.
    Twin,
    /// Half of the piece is laid on the fold.
    Half(HalfPlane),
    /// Each placement gives two pieces; with `spare`, one of them is mirrored wrongly.
    Two { spare: bool },
}

fn roles(to_cut: &[PieceToCut], plan: &FabricPlan) -> Result<Vec<Role>, MarkerError> {
    if plan.spread == Spread::Open {
        return Ok(to_cut.iter().map(|_| Role::Alone).collect());
    }
    let folded = plan.spread != Spread::FaceToFace;
    let mut roles: Vec<Option<Role>> = to_cut.iter().map(|_| None).collect();
    for k in 0..to_cut.len() {
        if roles[k].is_some() {
            continue;
        }
        let along = |half: &HalfPlane| {
            half.runs_along(to_cut[k].cut.grain) && to_cut[k].cut.is_symmetric_in(half)
        };
        let fold = to_cut[k].cut.fold.filter(along);
        let on_fold = to_cut[k].settings.rule.on_fold.unwrap_or(true);
        if let Some(half) = fold.filter(|_| folded && on_fold) {
            roles[k] = Some(Role::Half(half));
            continue;
        }
        let symmetrical = to_cut[k].cut.is_mirror_image_of(&to_cut[k].cut);
        let twin = (k + 1..to_cut.len()).find(|&other| {
            roles[other].is_none()
                && !symmetrical
                && to_cut[other].bundles == to_cut[k].bundles
                && to_cut[k].cut.is_mirror_image_of(&to_cut[other].cut)
        });
        roles[k] = Some(match (twin, symmetrical, folded) {
            (Some(other), ..) => {
                roles[other] = Some(if folded { Role::Twin } else { Role::Paired });
                Role::Paired
            }
            (None, true, true) => Role::Two { spare: false },
            (None, true, false) => Role::Alone,
            (None, false, true) => Role::Two { spare: true },
            (None, false, false) => {
                return Err(NestingError::Strip(format!(
                    "piece \"{}\" is neither symmetrical nor one of a pair: half of its copies would come out mirrored face to face; spread the fabric open, or cut it from another fabric",
                    to_cut[k].name
                ))
                .into());
            }
        });
    }
    Ok(roles
        .into_iter()
        .map(|r| r.unwrap_or(Role::Alone))
        .collect())
}

/// The item of a piece: cut outline, grain, allowed positions, and the point that must match the print.
fn item_of(to_cut: &PieceToCut, print: bool, (plan, options): (&FabricPlan, &NestOptions)) -> Item {
    let (piece, settings) = (&to_cut.cut, &to_cut.settings);
    let outline = piece.polygon();
    // Rotated to the axes of the grain: the hem lies at the start of the grain.
    let bounds = outline.rotated(-piece.grain).bounds();
    let hem = turned(Vec2::new(bounds.min.x, bounds.centre().y), piece.grain);
    let turns = match &settings.rule.turns {
        Some(turns) => turns.iter().map(|turn| turn.0).collect(),
        None => vec![0.0, PI],
    };
    let locked = settings.locked.iter().flatten().map(|lock| Locked {
        copy: lock.copy,
        turn: lock.turn,
        mirrored: lock.face_down,
        translation: Vec2::from(lock.at),
    });
    Item {
        grain: piece.grain,
        quantity: to_cut.bundles.len() as u32,
        bundles: to_cut.bundles.clone(),
        gap: settings.rule.gap.unwrap_or_default(),
        over_flaws: settings.rule.over_flaws.unwrap_or(false),
        match_point: print.then_some(MatchPoint {
            point: hem,
            phase: Phase::At(Vec2::zeros()),
        }),
        allowed: Allowed {
            tilt: options
                .cloth
                .tilt
                .or(settings.rule.tilt)
                .unwrap_or(plan.tilt),
            mirror: match settings.rule.turn_over {
                Some(true) => Mirror::Free,
                _ => Mirror::Never,
            },
            ..Allowed::turned(turns)
        },
        locked: locked.collect(),
        ..Item::new(to_cut.name.clone(), outline)
    }
}

/// Half of a piece, to be laid on the fold.
fn halved(mut item: Item, piece: &CutPiece, half: HalfPlane) -> (Item, Arc<CutPiece>) {
    let drawn = piece.halved(&half);
    item.outline = drawn.polygon();
    let inward = turned(half.inward, -item.grain);
    item.fold_edge = Some(match inward.y > 0.0 {
        true => FoldEdge::Lower,
        false => FoldEdge::Upper,
    });
    item.allowed.mirror = Mirror::Free;
    item.allowed.tilt = 0.0;
    (item, Arc::new(drawn))
}
