//! The pieces of drafts as they are laid: cut outlines, copies, what may be done with them.

use crate::laying::Garments;
use crate::matching::{match_up, resolve_marks};
use crate::nest_options::FabricPlan;
use crate::{NestOptions, SessionError};
use std::collections::BTreeSet;
use std::f64::consts::PI;
use std::sync::Arc;
use toile_cut::{CutOptions, CutPiece, HalfPlane};
use toile_geometry::Vec2;
use toile_interchange::{ANY_NAME, PieceSettings, Spread};
use toile_nesting::{
    Allowed, FoldEdge, Item, Locked, MOST_PIECES, MatchPoint, Mirror, Nap, NestingError, Phase,
};
use toile_pattern::{Diagnostic, Piece, Severity};

/// A piece of one draft that is to be cut from a fabric.
#[derive(Clone, Debug)]
pub(crate) struct Wanted {
    pub fabric: String,
    pub cut: Arc<CutPiece>,
    pub settings: PieceSettings,
    /// Name for messages and on the marker.
    pub name: String,
    /// The garment of each copy.
    pub bundles: Vec<u32>,
    /// Marks on the print: number of the set, and the point [m].
    pub marks: Vec<(usize, Vec2)>,
    /// What its cut line does not do as drawn.
    pub notes: Vec<String>,
}

/// Everything that is to be cut, in the order of the drafts. Where pieces are matched, every
/// garment's pieces stand alone, as each garment is matched in itself.
pub(crate) fn wanted_of(
    garments: &[Garments<'_>],
    options: &NestOptions,
) -> Result<Vec<Wanted>, SessionError> {
    check_piece_names(garments, options)?;
    check_count(garments, options)?;
    let mut all = Vec::new();
    let mut first = 0;
    for garment in garments {
        let marks = resolve_marks(garment.pattern, &options.settings.matched);
        let bundles: Vec<u32> = (first..first + garment.count).collect();
        first += garment.count;
        let alone = !options.settings.matched.is_empty();
        let parts: Vec<Vec<u32>> = match alone {
            true => bundles.iter().map(|&b| vec![b]).collect(),
            false => vec![bundles],
        };
        for bundles in parts {
            for (number, piece) in garment.draft.pieces.iter().enumerate() {
                let Some(own) = garment.draft.fabrics.get(piece.fabric) else {
                    continue;
                };
                let settings = options.piece(panel_name(garment, piece), &piece.name);
                let cut = cut_piece(garment, number, &settings)?;
                let found = match piece.id.copy {
                    0 => cut.diagnostics(garment.pattern),
                    _ => Vec::new(),
                };
                let name = match garment.label {
                    Some(label) => format!("{} {label}", piece.name),
                    None => piece.name.clone(),
                };
                let wanted = |fabric: &str, count: u32| Wanted {
                    fabric: fabric.to_owned(),
                    name: name.clone(),
                    bundles: bundles
                        .iter()
                        .flat_map(|&b| (0..count).map(move |_| b))
                        .collect(),
                    marks: marks
                        .iter()
                        .filter(|mark| mark.1 == piece.id.panel)
                        .filter_map(|mark| {
                            let notch = cut.notches.iter().find(|n| n.id == mark.2)?;
                            Some((mark.0, notch.point))
                        })
                        .collect(),
                    settings: settings.clone(),
                    cut: cut.clone(),
                    notes: notes_of(&found, garment.label),
                };
                let fabric = settings.fabric.as_deref().unwrap_or(&own.name);
                all.push(wanted(fabric, 1));
                for (fabric, &count) in settings.also.iter().flatten() {
                    if piece.id.copy == 0 && count > 0 {
                        all.push(wanted(fabric, count));
                    }
                }
            }
        }
    }
    Ok(all)
}

/// A piece of a draft with the block round it.
fn cut_piece(
    garment: &Garments<'_>,
    number: usize,
    settings: &PieceSettings,
) -> Result<Arc<CutPiece>, SessionError> {
    let options = CutOptions {
        block: settings.block.unwrap_or_default().0.max(0.0),
        ..CutOptions::default()
    };
    let of = (garment.pattern, garment.draft);
    let made = CutPiece::new(of, number, (None, &options));
    made.map(Arc::new).map_err(|error| SessionError::Faults {
        source_name: garment.pattern.name.clone(),
        faults: vec![format!(
            "piece {:?} cannot be cut: {error}",
            garment.draft.pieces[number].name
        )],
    })
}

/// Warnings in words, with what tells their garment from others.
fn notes_of(found: &[Diagnostic], label: Option<&str>) -> Vec<String> {
    let of = label.map_or_else(String::new, |label| format!("{label}: "));
    let words = |one: &Diagnostic| format!("{of}{}; {}", one.message, one.hint);
    let warnings = found.iter().filter(|one| one.severity > Severity::Note);
    warnings.map(words).collect()
}

fn panel_name<'a>(garment: &Garments<'a>, piece: &Piece) -> &'a str {
    let panels = &garment.pattern.panels;
    let panel = panels.iter().find(|p| p.id == piece.id.panel);
    panel.map_or("", |p| p.name.as_str())
}

/// More pieces than can be laid at once are refused before any list of them is made.
fn check_count(garments: &[Garments<'_>], options: &NestOptions) -> Result<(), SessionError> {
    let of = |garment: &Garments<'_>| {
        let each = |piece: &Piece| {
            let settings = options.piece(panel_name(garment, piece), &piece.name);
            let also = settings.also.iter().flatten();
            1 + also.map(|(_, &count)| u64::from(count)).sum::<u64>()
        };
        let pieces: u64 = garment.draft.pieces.iter().map(each).sum();
        pieces.saturating_mul(u64::from(garment.count))
    };
    let total = garments.iter().map(of).fold(0, u64::saturating_add);
    match total > u64::from(MOST_PIECES) {
        true => Err(NestingError::TooManyPieces(total).into()),
        false => Ok(()),
    }
}

/// Settings, locks and marks that name nothing are mistakes.
fn check_piece_names(garments: &[Garments<'_>], options: &NestOptions) -> Result<(), SessionError> {
    let mut names: Vec<String> = Vec::new();
    let mut marks: Vec<String> = Vec::new();
    for garment in garments {
        names.extend(garment.draft.pieces.iter().map(|p| p.name.clone()));
        for panel in &garment.pattern.panels {
            names.push(panel.name.clone());
            let notch = |n: &toile_pattern::Notch| format!("{}.{}", panel.name, n.name);
            marks.extend(panel.notches.iter().map(notch));
        }
    }
    for list in [&mut names, &mut marks] {
        list.sort_unstable();
        list.dedup();
    }
    let unknown = |kind: &'static str, name: &str, there: &[String]| SessionError::Unknown {
        kind,
        name: name.to_owned(),
        hint: match there.is_empty() {
            true => "there are none in the pattern".to_owned(),
            false => format!("choose from: {}", there.join(", ")),
        },
    };
    let given = options.settings.pieces.keys();
    for name in given.filter(|name| *name != ANY_NAME) {
        if !names.contains(name) {
            return Err(unknown("piece", name, &names));
        }
    }
    for mark in options.settings.matched.iter().flatten() {
        if !marks.contains(mark) {
            return Err(unknown("mark", mark, &marks));
        }
    }
    Ok(())
}

/// Items, what is drawn on each, and what the cutter must know.
type Items = (Vec<Item>, Vec<Arc<CutPiece>>, Vec<String>);

/// The pieces of one fabric as they are laid on it.
pub(crate) fn items_on(
    wanted: &[Wanted],
    plan: &FabricPlan,
    options: &NestOptions,
) -> Result<Items, SessionError> {
    let mut items = Vec::new();
    let mut drawn = Vec::new();
    let mut notes: Vec<String> = Vec::new();
    for note in wanted.iter().flat_map(|wanted| &wanted.notes) {
        // Garments that are matched each in itself have the same pieces again.
        if !notes.contains(note) {
            notes.push(note.clone());
        }
    }
    let printed = plan.rolls.iter().any(|r| r.strip.stripes.is_some());
    let matched = wanted.iter().any(|w| !w.marks.is_empty());
    let each_alone = plan.rolls.iter().any(|r| r.strip.nap == Nap::PerBundle);
    for (k, role) in roles(wanted, plan)?.into_iter().enumerate() {
        let wanted = &wanted[k];
        let on_print = wanted.settings.on_print.unwrap_or(!matched);
        let print = printed && on_print && wanted.marks.is_empty();
        let mut item = item_of(wanted, print, options);
        match role {
            Role::Twin => continue,
            Role::Alone => {}
            Role::Paired => item.allowed.mirror = Mirror::Free,
            Role::Half(half) => {
                let (halved, piece) = halved(item, &wanted.cut, half);
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
        drawn.push((k, wanted.cut.clone()));
    }
    if printed {
        let order: Vec<usize> = drawn.iter().map(|d| d.0).collect();
        match_up(&mut items, &order, (wanted, plan))?;
    }
    if plan.plies > 1 {
        notes.push(format!(
            "{} plies: every piece on the marker is cut {0} times",
            plan.plies
        ));
    }
    Ok((items, drawn.into_iter().map(|d| d.1).collect(), notes))
}

/// Lays a piece half as often, or as often if one of two is the wrong way round; how many more come
/// out than are needed. Where each garment runs one way, two at once belong to one garment.
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

/// What becomes of a piece on fabric of several layers.
enum Role {
    /// Cut as it is laid.
    Alone,
    /// Either way up.
    Paired,
    /// Cut together with its mirror image, which is laid instead.
    Twin,
    /// Half of it on the fold.
    Half(HalfPlane),
    /// Each placement gives two; `spare` if one of them is the wrong way round.
    Two { spare: bool },
}

fn roles(wanted: &[Wanted], plan: &FabricPlan) -> Result<Vec<Role>, SessionError> {
    if plan.spread == Spread::Open {
        return Ok(wanted.iter().map(|_| Role::Alone).collect());
    }
    let folded = plan.spread != Spread::FaceToFace;
    let mut roles: Vec<Option<Role>> = wanted.iter().map(|_| None).collect();
    for k in 0..wanted.len() {
        if roles[k].is_some() {
            continue;
        }
        let along = |half: &HalfPlane| {
            half.runs_along(wanted[k].cut.grain) && wanted[k].cut.is_symmetric_in(half)
        };
        let fold = wanted[k].cut.fold.filter(along);
        let on_fold = wanted[k].settings.on_fold.unwrap_or(true);
        if let Some(half) = fold.filter(|_| folded && on_fold) {
            roles[k] = Some(Role::Half(half));
            continue;
        }
        let symmetrical = wanted[k].cut.is_mirror_image_of(&wanted[k].cut);
        let twin = (k + 1..wanted.len()).find(|&other| {
            roles[other].is_none()
                && !symmetrical
                && wanted[other].bundles == wanted[k].bundles
                && wanted[k].cut.is_mirror_image_of(&wanted[other].cut)
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
                    wanted[k].name
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

/// A piece as it is laid: its cut outline, its grain, and where the print must meet it.
fn item_of(wanted: &Wanted, print: bool, options: &NestOptions) -> Item {
    let (piece, settings) = (&wanted.cut, &wanted.settings);
    let outline = piece.outer();
    // Back to the grain's own axes: the hem lies where the grain starts.
    let bounds = outline.rotated(-piece.grain).bounds();
    let hem = turned(Vec2::new(bounds.min.x, bounds.centre().y), piece.grain);
    let turns = match &settings.turns {
        Some(turns) => turns.iter().map(|t| t.to_radians()).collect(),
        None => vec![0.0, PI],
    };
    let locked = settings.locked.iter().flatten().map(|lock| Locked {
        copy: lock.copy,
        turn: lock.turn.to_radians(),
        mirrored: lock.face_down,
        translation: Vec2::new(lock.at[0].0, lock.at[1].0),
    });
    Item {
        grain: piece.grain,
        quantity: wanted.bundles.len() as u32,
        bundles: wanted.bundles.clone(),
        gap: settings.gap.unwrap_or_default().0,
        over_defects: settings.over_flaws.unwrap_or(false),
        match_point: print.then_some(MatchPoint {
            point: hem,
            phase: Phase::At(Vec2::zeros()),
        }),
        allowed: Allowed {
            tilt: options
                .tilt
                .or(settings.tilt.map(f64::to_radians))
                .unwrap_or(0.0),
            mirror: match settings.turn_over {
                Some(true) => Mirror::Free,
                _ => Mirror::Never,
            },
            ..Allowed::turned(turns)
        },
        locked: locked.collect(),
        ..Item::new(wanted.name.clone(), outline)
    }
}

/// Half of a piece, for the fold.
fn halved(mut item: Item, piece: &CutPiece, half: HalfPlane) -> (Item, Arc<CutPiece>) {
    let drawn = piece.halved(&half);
    item.outline = drawn.outer();
    let inward = turned(half.inward, -item.grain);
    item.fold_edge = Some(match inward.y > 0.0 {
        true => FoldEdge::Lower,
        false => FoldEdge::Upper,
    });
    item.allowed.mirror = Mirror::Free;
    item.allowed.tilt = 0.0;
    (item, Arc::new(drawn))
}

/// A vector turned by an angle [rad].
pub(crate) fn turned(v: Vec2, angle: f64) -> Vec2 {
    let (sin, cos) = angle.sin_cos();
    Vec2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y)
}
