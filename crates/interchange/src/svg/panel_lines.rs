//! The lines of a piece as descriptions of paths, in millimetres, y down.

use super::kinds::LineKind;
use crate::svg_text::number;
use toile_cut::{CutPiece, Drawing, StrokeKind};
use toile_geometry::{Curve, Vec2};
use toile_pattern::{Piece, PieceEdge};

/// A path of a panel.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PanelPath {
    /// The kind of its lines.
    pub kind: LineKind,
    /// The description of the path.
    pub description: String,
}

/// The paths of a piece, its points moved by an offset (m).
pub(super) fn paths(piece: &Piece, cut: &CutPiece, drawing: &Drawing, by: Vec2) -> Vec<PanelPath> {
    let mut all = Vec::new();
    let mut put = |kind, description| all.push(PanelPath { kind, description });
    for (k, ring) in cut.cut.iter().enumerate() {
        let kind = if k == 0 {
            LineKind::Cut
        } else {
            LineKind::Hole
        };
        // The edges of holes without allowance are written below, with their curves.
        let has_allowance = k == 0 || cut.sew.len() > k && cut.sew[k].points != ring.points;
        if has_allowance {
            put(kind, chords(&ring.points, true, by));
        }
    }
    put(LineKind::Sew, edges(&piece.outline, by));
    for (k, hole) in piece.holes.iter().enumerate() {
        let is_cut = cut.cut.get(k + 1).zip(cut.sew.get(k + 1));
        let kind = match is_cut.is_some_and(|(cut, sew)| cut.points != sew.points) {
            true => LineKind::Sew,
            false => LineKind::Hole,
        };
        put(kind, edges(hole, by));
    }
    for line in &piece.internal_lines {
        let description = curves(line.curves.iter(), false, by);
        if !description.is_empty() {
            put(LineKind::Internal, description);
        }
    }
    for notch in cut.notches_seen() {
        let lines = match notch.cut.is_empty() {
            true => notch.on_seam_line(),
            false => notch.cut.clone(),
        };
        let lines: Vec<String> = lines.iter().map(|line| chords(line, false, by)).collect();
        put(LineKind::Notch(notch.kind), lines.join(""));
    }
    let grain = drawing
        .strokes
        .iter()
        .filter(|stroke| stroke.kind == StrokeKind::Grain);
    let grain: Vec<String> = grain
        .map(|stroke| chords(&stroke.points, false, by))
        .collect();
    if !grain.is_empty() {
        put(LineKind::Grain, grain.join(""));
    }
    all
}

/// A point of a piece as coordinates.
pub(super) fn at(p: Vec2, by: Vec2) -> String {
    let p = (p + by) * 1e3;
    format!("{} {}", number(p.x), number(-p.y))
}

fn chords(points: &[Vec2], is_closed: bool, by: Vec2) -> String {
    let points: Vec<String> = points.iter().map(|&p| at(p, by)).collect();
    let end = if is_closed { "Z" } else { "" };
    format!("M{}{end}", points.join("L"))
}

fn edges(edges: &[PieceEdge], by: Vec2) -> String {
    curves(edges.iter().map(|edge| &edge.curve), true, by)
}

/// Curves that follow one another.
fn curves<'a>(curves: impl Iterator<Item = &'a Curve>, is_closed: bool, by: Vec2) -> String {
    let mut text = String::new();
    for curve in curves {
        if text.is_empty() {
            text = format!("M{}", at(curve.start(), by));
        }
        text += &match *curve {
            Curve::Line { end, .. } => format!("L{}", at(end, by)),
            Curve::Arc { bulge, end, start } => arc((start, end), bulge, by),
            Curve::Quadratic { control, end, .. } => {
                format!("Q{} {}", at(control, by), at(end, by))
            }
            Curve::Cubic {
                controls: [a, b],
                end,
                ..
            } => format!("C{} {} {}", at(a, by), at(b, by), at(end, by)),
        };
    }
    if is_closed && !text.is_empty() {
        text.push('Z');
    }
    text
}

/// An arc by its bulge, the tangent of a quarter of its angle.
fn arc((start, end): (Vec2, Vec2), bulge: f64, by: Vec2) -> String {
    let radius = (end - start).norm() * (1.0 + bulge * bulge) / (4.0 * bulge.abs());
    if !radius.is_finite() || radius > 1e3 {
        return format!("L{}", at(end, by));
    }
    let large = u8::from(bulge.abs() > 1.0);
    // Counter-clockwise with y up is against the sense of angles with y down.
    let sweep = u8::from(bulge < 0.0);
    let radius = format!("{:.6}", radius * 1e3);
    format!("A{radius} {radius} 0 {large} {sweep} {}", at(end, by))
}
