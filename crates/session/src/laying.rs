//! Markers of a draft: one for each fabric its pieces are cut from.

use crate::cut::{cut_outline, sewn_outline};
use crate::watcher::tell;
use crate::{NestOptions, Nested, SessionError, Watcher};
use std::f64::consts::PI;
use std::sync::atomic::{AtomicBool, Ordering};
use toile_geometry::{Vec2, ring_area};
use toile_interchange::{MarkerDrawing, MarkerFile, MarkerPiece};
use toile_nesting::{
    Allowed, Control, Item, Marker, MatchPoint, Nap, NestingError, Phase, Progress, Strip, Verdict,
    judge, make_marker,
};
use toile_pattern::{Draft, Piece};

/// Unusable edge at either side of the fabric [m].
const SELVEDGE: f64 = 0.010;
/// Room for the blade between two pieces [m].
const GAP: f64 = 0.002;
/// Length of a notch's stroke on the drawing [m].
const NOTCH: f64 = 0.006;

/// A marker made, with everything a drawing of it needs.
#[derive(Clone, Debug)]
pub(crate) struct Laying {
    /// Name of the fabric.
    pub fabric: String,
    /// Pieces by their cut outline.
    pub items: Vec<Item>,
    /// The same pieces as drafted, in the order of the items.
    pub pieces: Vec<Piece>,
    pub strip: Strip,
    pub marker: Marker,
    pub verdict: Verdict,
}

impl Laying {
    /// A few numbers.
    pub fn summary(&self) -> Nested {
        Nested {
            fabric: self.fabric.clone(),
            pieces: self.marker.placements.len(),
            unplaced: self.marker.unplaced.len(),
            length: self.marker.length,
            width: self.strip.width,
            efficiency: self.marker.efficiency,
            sound: self.verdict.is_sound(),
        }
    }

    /// Area of the pieces that were laid, seam allowance included [m2].
    pub fn cut_area(&self) -> f64 {
        let area = |p: &toile_nesting::Placement| self.items[p.item].outline.area().abs();
        self.marker.placements.iter().map(area).sum()
    }

    /// The marker as a drawing.
    pub fn drawing(&self, pattern: &str) -> MarkerDrawing {
        let piece = |placement: &toile_nesting::Placement| {
            let (item, piece) = (&self.items[placement.item], &self.pieces[placement.item]);
            MarkerPiece {
                name: item.name.clone(),
                item: placement.item,
                cut: item.outline.clone(),
                sew: sewn_outline(piece),
                grain: None,
                notches: piece
                    .notches
                    .iter()
                    .map(|n| [n.point, n.point + n.inward * NOTCH])
                    .collect(),
                lines: piece
                    .internal_lines
                    .iter()
                    .map(|line| flattened(&line.curves))
                    .collect(),
                pose: placement.pose(item),
            }
        };
        MarkerDrawing {
            title: self.title(pattern),
            strip: self.strip.clone(),
            length: self.marker.length,
            efficiency: self.marker.efficiency,
            pieces: self.marker.placements.iter().map(piece).collect(),
            unplaced: self
                .marker
                .unplaced
                .iter()
                .map(|u| self.items[u.item].name.clone())
                .collect(),
        }
    }

    /// The marker as its file.
    pub fn file(&self, pattern: &str) -> MarkerFile {
        MarkerFile::new(&self.title(pattern), &self.items, &self.strip, &self.marker)
    }

    fn title(&self, pattern: &str) -> String {
        format!("{pattern}, {}", self.fabric)
    }
}

fn flattened(curves: &[toile_geometry::Curve]) -> Vec<Vec2> {
    curves
        .iter()
        .flat_map(|curve| curve.flatten(1e-4))
        .collect()
}

/// Garments to cut from one draft.
#[derive(Clone, Copy)]
pub(crate) struct Garments<'a> {
    pub draft: &'a Draft,
    /// How many.
    pub count: u32,
}

/// Lays all pieces of one or more drafts, each fabric on its own marker, fabrics in the order in
/// which pieces first name them.
pub(crate) fn lay(
    garments: &[Garments<'_>],
    options: &NestOptions,
    watcher: &mut dyn Watcher,
) -> Result<Vec<Laying>, SessionError> {
    let mut layings: Vec<Laying> = Vec::new();
    let mut first_bundle = 0;
    for Garments { draft, count } in garments {
        for piece in &draft.pieces {
            let Some(fabric) = draft.fabrics.get(piece.fabric) else {
                continue;
            };
            let piece = &right_side_up(piece);
            let item = Item {
                quantity: *count,
                bundles: (first_bundle..first_bundle + count).collect(),
                ..item_of(piece, options)
            };
            let mut known = layings.iter_mut().filter(|l| l.fabric == fabric.name);
            if let Some(laying) = known.next() {
                laying.items.push(item);
                laying.pieces.push(piece.clone());
                continue;
            }
            layings.push(Laying {
                fabric: fabric.name.clone(),
                items: vec![item],
                pieces: vec![piece.clone()],
                strip: options.applied(Strip {
                    selvedge: SELVEDGE,
                    gap: GAP,
                    nap: if fabric.nap { Nap::OneWay } else { Nap::None },
                    ..Strip::of_width(fabric.width)
                }),
                marker: Marker::default(),
                verdict: Verdict::default(),
            });
        }
        first_bundle += count;
    }
    if layings.is_empty() {
        return Err(NestingError::NoItems.into());
    }
    let count = layings.len() as f64;
    for (k, laying) in layings.iter_mut().enumerate() {
        let from = k as f64 / count;
        lay_one(laying, options, watcher, |done| from + done / count)?;
    }
    Ok(layings)
}

/// A piece as it is laid: its cut outline, its grain, and where the print must meet it.
fn item_of(piece: &Piece, options: &NestOptions) -> Item {
    let outline = cut_outline(piece);
    // Back to the grain's own axes: the hem lies where the grain starts.
    let bounds = outline.rotated(-piece.grain).bounds();
    let (sin, cos) = piece.grain.sin_cos();
    let hem = Vec2::new(bounds.min.x, bounds.centre().y);
    let hem = Vec2::new(cos * hem.x - sin * hem.y, sin * hem.x + cos * hem.y);
    Item {
        grain: piece.grain,
        match_point: options.repeat.map(|_| MatchPoint {
            point: hem,
            phase: Phase::At(Vec2::zeros()),
        }),
        allowed: Allowed {
            tilt: options.tilt,
            ..Allowed::two_way()
        },
        ..Item::new(piece.name.clone(), outline)
    }
}

/// The piece as seen from the right side of the cloth, which lies up: a clockwise outline is drawn
/// from the wrong side and is reflected.
fn right_side_up(piece: &Piece) -> Piece {
    let mut piece = piece.clone();
    if ring_area(&sewn_outline(&piece).outer) >= 0.0 {
        return piece;
    }
    let across = |p: Vec2| Vec2::new(-p.x, p.y);
    let holes = piece.holes.iter_mut().flatten();
    for edge in piece.outline.iter_mut().chain(holes) {
        edge.curve = edge.curve.reflected(Vec2::zeros(), Vec2::y());
    }
    for line in &mut piece.internal_lines {
        for curve in &mut line.curves {
            *curve = curve.reflected(Vec2::zeros(), Vec2::y());
        }
    }
    for notch in &mut piece.notches {
        notch.point = across(notch.point);
        notch.inward = across(notch.inward);
    }
    piece.grain = PI - piece.grain;
    piece
}

fn lay_one(
    laying: &mut Laying,
    options: &NestOptions,
    watcher: &mut dyn Watcher,
    share: impl Fn(f64) -> f64,
) -> Result<(), SessionError> {
    let stage = "laying out";
    tell(watcher, stage, share(0.0), "")?;
    let cancel = AtomicBool::new(false);
    let mut follow = |progress: Progress| {
        let detail = format!("{:.0} mm of fabric", progress.length * 1e3);
        if tell(watcher, stage, share(progress.done), &detail).is_err() {
            cancel.store(true, Ordering::Relaxed);
        }
    };
    let mut control = Control {
        progress: &mut follow,
        cancel: &cancel,
    };
    laying.marker = make_marker(&laying.items, &laying.strip, options.search(), &mut control)?;
    laying.verdict = judge(&laying.items, &laying.strip, &laying.marker);
    Ok(())
}
