//! Pleats: cloth inserted between the parts of a panel, with ends shaped by the outline that they are
//! folded under.
//!
//! # Decided with
//! - [`crate::document::OperationKind`], [`crate::plan::pleat_panel`] (`reshape.rs`): fields of a pleat, and their defaults;
//! - [`crate::evaluate`] (`reshape.rs`, `pleat`, `no_spread`): numbers evaluated, refusals in words;
//! - [`mod@crate::stage::spread`] (`CutOpen::of`): cuts that cross or open too wide;
//! - [`crate::press::press_arrows`], [`crate::check`] (`note_pleats`): arrows; a depth of 0 told.
//!
//! Asked in the window: `tools/alter.rs` (`PLEAT_SLOTS`), `inspector/steps.rs`.

use super::motion::Motion;
use super::spread::{Chord, Crossed, CutOpen, Gap};
use super::{NOTHING, SpreadError, Spreading, Stage, StageEdge, StageLine};
use crate::{
    CornerName, EdgeCorner, LineKind, Name, OperationId, PleatKind, PleatLine, Role, Side,
};
use toile_geometry::{Curve, Vec2};

/// Pleats with their numbers evaluated: the spread that makes room for them, their depth and kind.
#[derive(Clone, Debug)]
pub(crate) struct Pleating {
    pub spread: Spreading,
    /// Depth of a fold under the cloth (m).
    pub depth: f64,
    pub kind: PleatKind,
    pub pressed: Side,
    /// Whether the pleats are trued: the end of each underlay is cut along the edge that it lies under when
    /// folded.
    pub trued: bool,
}

/// A piece of the outline beside a pleat.
#[derive(Clone, Copy)]
struct Piece {
    curve: Curve,
    allowance: f64,
}

/// Rounding error that is allowed in distances from the pleat line (m).
const SAME_DEPTH: f64 = 1e-9;

/// A stage with pleats: its parts are moved apart, with underlays between them and lines to fold along.
/// Pleats of depth 0 leave the stage unchanged, except that all corners of each underlay are named at one
/// place.
pub(crate) fn pleat(stage: &Stage, wish: &Pleating) -> Result<Stage, SpreadError> {
    if wish.depth < -NOTHING {
        return Err(SpreadError::NoDepth);
    }
    let open = CutOpen::of(stage, &wish.spread, PleatLine::LARGEST)?;
    let turn = stage.turn();
    let by = wish.spread.by;
    if wish.depth <= NOTHING {
        return laid_flat(stage, &open, by, 2 * folds(wish, (turn, 0)).len());
    }
    let mut result = open.moved(stage, |gap| underlay(&open, gap, (wish, turn)))?;
    let outline = result
        .lines
        .iter()
        .find(|line| line.name == wish.spread.line);
    let creases: Vec<StageLine> = open
        .chords
        .iter()
        .flat_map(|chord| creases(outline, (by, chord), folds(wish, (turn, 0))))
        .collect();
    result.lines.extend(creases);
    Ok(result)
}

/// A stage with pleats of depth 0: all corners of an underlay lie where the pleat line meets the outline.
fn laid_flat(
    stage: &Stage,
    open: &CutOpen,
    by: OperationId,
    layers: usize,
) -> Result<Stage, SpreadError> {
    let corners = |gap: (u16, usize)| move |k: usize| corner(by, gap, k);
    let mut result = open.moved(stage, |gap| {
        let name = corners((gap.chord.number, gap.end));
        Ok(Crossed {
            corners: [name(0), name(layers)],
            edges: Vec::new(),
        })
    })?;
    if let Some(line) = result
        .lines
        .iter_mut()
        .find(|line| line.name == open.line.name)
    {
        for (chord, end) in open.chords.iter().flat_map(|c| [(c, 0), (c, 1)]) {
            let name = corners((chord.number, end));
            line.twins
                .extend((1..layers).map(|k| [name(k), name(layers)]));
        }
    }
    result.idle.push(by);
    Ok(result)
}

/// The folds of a pleat at one end of its line, in the order of the outline. A fold is `true` if it lies
/// under the part of the panel that comes before the pleat along the outline, `false` if under the part after
/// it.
fn folds(wish: &Pleating, (turn, end): (f64, usize)) -> Vec<bool> {
    // On a counter-clockwise outline, the part left of the pleat line comes before the pleat at the start of
    // the line.
    let left_is_before = (turn > 0.0) == (end == 0);
    match wish.kind {
        PleatKind::Knife => vec![(wish.pressed == Side::Left) == left_is_before],
        PleatKind::Box | PleatKind::Inverted => vec![true, false],
    }
}

fn corner(by: OperationId, gap: (u16, usize), k: usize) -> CornerName {
    Name::Made {
        by,
        role: Role::Underlay,
        index: 10 * gap.0 + 5 * gap.1 as u16 + k as u16,
    }
}

/// The edges of the outline across the underlay of a pleat. If the pleat is trued, they lie on the outline
/// beside the pleat once it is folded; if not, they are straight.
fn underlay(
    open: &CutOpen,
    gap: &Gap<'_>,
    (wish, turn): (&Pleating, f64),
) -> Result<Crossed, SpreadError> {
    let by = wish.spread.by;
    let [start, end] = gap.chord.points;
    let way = end - start;
    let (from, to) = (gap.before.curve.end(), gap.after.curve.start());
    let across = (to - from).try_normalize(1e-15);
    let across = across.ok_or(SpreadError::NoDepth)?;
    let count = open.line.edges.len();
    let before = (gap.at + count - 1) % count;
    let folds = folds(wish, (turn, gap.end));
    let mut layers: Vec<Vec<Piece>> = Vec::new();
    if !wish.trued {
        let count = 2 * folds.len();
        let at = |k: usize| from + (to - from) * (k as f64 / count as f64);
        let straight = (0..count).map(|k| Piece {
            curve: Curve::Line {
                start: at(k),
                end: at(k + 1),
            },
            allowance: gap.before.allowance,
        });
        layers.extend(straight.map(|piece| vec![piece]));
        return Ok(crossed(gap, by, layers));
    }
    let mut origin = from;
    for is_before in folds {
        let motion = open.motion(if is_before { before } else { gap.at });
        let way = motion.direction(way);
        let beside = beside(open, gap, (is_before, wish.depth))?;
        let twice = across * (2.0 * wish.depth);
        // Position, after the spread, of the end of the outline on this part (m).
        let at = if is_before { from } else { to };
        let near: Vec<Piece> = beside.iter().map(|p| moved(*p, motion)).collect();
        let back = |pieces: &[Piece]| -> Vec<Piece> {
            let back = pieces.iter().rev();
            back.map(|p| with(*p, p.curve.reversed())).collect()
        };
        let mirrored = |pieces: &[Piece]| -> Vec<Piece> {
            let all = pieces.iter();
            all.map(|p| with(*p, p.curve.reflected(at, way))).collect()
        };
        let shifted = |pieces: &[Piece], by: Vec2| -> Vec<Piece> {
            let all = pieces.iter();
            all.map(|p| with(*p, p.curve.translated(by))).collect()
        };
        match is_before {
            true => {
                layers.push(mirrored(&near));
                layers.push(shifted(&back(&near), origin + twice - at));
            }
            false => {
                layers.push(shifted(&near, origin - at));
                layers.push(back(&mirrored(&near)));
            }
        }
        origin += twice;
    }
    Ok(crossed(gap, by, layers))
}

/// The layers of an underlay as edges, between the end of the edge before the pleat and the start of the edge
/// after it.
fn crossed(gap: &Gap<'_>, by: OperationId, layers: Vec<Vec<Piece>>) -> Crossed {
    let number = gap.chord.number;
    let (from, to) = (gap.before.curve.end(), gap.after.curve.start());
    let mut edges: Vec<StageEdge> = Vec::new();
    let last = layers.len();
    for (k, layer) in layers.into_iter().enumerate() {
        let name = Name::Made {
            by,
            role: Role::Underlay,
            index: 8 * number + 4 * gap.end as u16 + k as u16,
        };
        let length: f64 = layer.iter().map(|piece| piece.curve.length()).sum();
        let mut along = 0.0;
        for (j, piece) in layer.into_iter().enumerate() {
            let own = piece.curve.length();
            edges.push(StageEdge {
                name,
                half: 0,
                start: (j == 0).then(|| corner(by, (number, gap.end), k)),
                from: along / length,
                to: (along + own) / length,
                curve: piece.curve,
                allowance: piece.allowance,
                corner: EdgeCorner::default(),
            });
            along += own;
        }
    }
    join(&mut edges, [from, to]);
    Crossed {
        corners: [0, last].map(|k| corner(by, (number, gap.end), k)),
        edges,
    }
}

fn with(piece: Piece, curve: Curve) -> Piece {
    Piece { curve, ..piece }
}

fn moved(piece: Piece, motion: Motion) -> Piece {
    with(piece, motion.curve(piece.curve))
}

/// Moves the ends of joined edges to exactly the given points, and the start of each edge to the end of the
/// edge before.
fn join(edges: &mut [StageEdge], [from, to]: [Vec2; 2]) {
    let count = edges.len();
    let mut start = from;
    for (k, edge) in edges.iter_mut().enumerate() {
        let end = match k + 1 == count {
            true => to,
            false => edge.curve.end(),
        };
        edge.curve = super::with_ends(edge.curve, start, end);
        start = end;
    }
}

/// The outline on one side of a pleat, before it if `is_before`: from the pleat line to the distance `depth`
/// from it (m), at which a fold ends.
fn beside(
    open: &CutOpen,
    gap: &Gap<'_>,
    (is_before, depth): (bool, f64),
) -> Result<Vec<Piece>, SpreadError> {
    let [start, end] = gap.chord.points;
    let way = (end - start).normalize();
    let origin = gap.chord.points[gap.end];
    let count = open.line.edges.len();
    let away = |p: Vec2| way.perp(&(p - origin));
    let mut pieces = Vec::new();
    let mut sign = 0.0;
    for n in 0..count {
        let edge = match is_before {
            true => &open.line.edges[(gap.at + 2 * count - 1 - n) % count],
            false => &open.line.edges[(gap.at + n) % count],
        };
        let curve = match is_before {
            true => edge.curve.reversed(),
            false => edge.curve,
        };
        if n == 0 {
            sign = away(curve.point(1e-3)).signum();
        }
        let far = |t: f64| sign * away(curve.point(t));
        // The outline must lead away from the pleat everywhere, else the folded cloth would overlap itself.
        let leads = (0..=32).all(|k| {
            let t = f64::from(k) / 32.0;
            far(t) > depth || sign * way.perp(&curve.derivative(t)) > -SAME_DEPTH
        });
        if !leads {
            return Err(SpreadError::TooDeep(gap.chord.number));
        }
        let allowance = edge.allowance;
        if far(1.0) < depth - SAME_DEPTH {
            pieces.push(Piece { curve, allowance });
            continue;
        }
        let (mut low, mut high) = (0.0_f64, 1.0_f64);
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            match far(middle) < depth {
                true => low = middle,
                false => high = middle,
            }
        }
        let curve = match 1.0 - high < 1e-12 {
            true => curve,
            false => curve.between(0.0, high),
        };
        pieces.push(Piece { curve, allowance });
        return Ok(pieces);
    }
    Err(SpreadError::TooDeep(gap.chord.number))
}

/// The lines along which a pleat is folded, and the lines that its folds are laid to, from its start to its
/// end.
fn creases(
    outline: Option<&StageLine>,
    (by, chord): (OperationId, &Chord),
    folds: Vec<bool>,
) -> Vec<StageLine> {
    let edges = outline.map_or(&[][..], |line| &line.edges);
    let layers = 2 * folds.len();
    // Each layer starts at a corner; the last layer ends at the start of the next edge.
    let ends = |end: usize| -> Vec<Vec2> {
        let name = |k: usize| Name::Made {
            by,
            role: Role::Underlay,
            index: 8 * chord.number + 4 * end as u16 + k as u16,
        };
        let of = |k: usize| edges.iter().filter(move |edge| edge.name == name(k));
        let starts = (0..layers).filter_map(|k| Some(of(k).next()?.curve.start()));
        let last = of(layers - 1).next_back().map(|edge| edge.curve.end());
        starts.chain(last).collect()
    };
    let (from, mut to) = (ends(0), ends(1));
    to.reverse();
    let is_placement = |k: usize| match folds[..] {
        [true] => k == 2,
        [false] => k == 0,
        _ => k == 2,
    };
    let pairs = from.into_iter().zip(to).enumerate();
    pairs
        .map(|(k, (start, end))| {
            let role = match is_placement(k) {
                true => Role::Placement,
                false => Role::Crease,
            };
            let index = 5 * chord.number + k as u16;
            StageLine {
                name: Name::Made { by, role, index },
                half: 0,
                kind: LineKind::Internal,
                edges: vec![StageEdge {
                    name: Name::Made { by, role, index },
                    half: 0,
                    start: None,
                    from: 0.0,
                    to: 1.0,
                    curve: Curve::Line { start, end },
                    allowance: 0.0,
                    corner: EdgeCorner::default(),
                }],
                end: None,
                twins: Vec::new(),
            }
        })
        .collect()
}
