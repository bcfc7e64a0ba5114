//! Draws a piece on paper: its lines in the style of their kind and size, its words.

use super::mark::{LineStyle, Mark, Shape};
use super::paper::clipped;
use super::{Lines, Paper, PrintJob, PrintPiece};
use crate::pdf::{Align, Ink};
use toile_cut::{CutPiece, Drawing, StrokeKind, Words, Writing};
use toile_geometry::{Polygon, Vec2};

pub(crate) const BLACK: Ink = [0.07, 0.07, 0.07];
const BLUE: Ink = [0.12, 0.31, 0.62];
const PURPLE: Ink = [0.55, 0.2, 0.55];
/// Smallest line widths on a projector (m): of lines to cut along (second), and of all other lines (first).
const PROJECTED: [f64; 2] = [0.0012, 0.002];
/// Letter size of the text beside the fold (m).
const FOLD_LETTERS: f64 = 0.005;
/// Letter size of the text beside the grain line (m).
const GRAIN_LETTERS: f64 = 0.0035;
/// Positions that are tried for the text beside the fold or the grain line, the preferred first (fraction of
/// the line's length).
const ALONG_PLACES: [f64; 5] = [0.5, 0.38, 0.62, 0.26, 0.74];
/// Largest letter size of the text beside the fold or the grain line, as a fraction of the line's length: the
/// text then is no longer than the line.
const ALONG_SHARE: f64 = 0.1;

/// Largest letter size of a piece's texts (m).
const LETTERS: f64 = 0.012;
/// Largest length of the arrow in the direction in which a dart or pleat is pressed (m).
const ARROW: f64 = 0.018;
/// Largest length of that arrow relative to the width of the folded part (1).
const ARROW_SHARE: f64 = 0.9;
/// Length of the arrow's head relative to the arrow's length (1).
const HEAD: f64 = 0.3;
/// Half the width of the arrow's head relative to the head's length (1).
const HEAD_WIDTH: f64 = 0.5;

/// Colour and dash length (m) of the lines of each size, used in turn: the colours tell the sizes apart, and
/// the dashes do so in black and white.
const SIZES: [(Ink, f64); 8] = [
    ([0.07, 0.07, 0.07], 0.0),
    ([0.75, 0.1, 0.15], 0.012),
    ([0.05, 0.4, 0.7], 0.006),
    ([0.1, 0.5, 0.2], 0.003),
    ([0.6, 0.3, 0.0], 0.018),
    ([0.5, 0.15, 0.6], 0.009),
    ([0.0, 0.5, 0.5], 0.0045),
    ([0.8, 0.35, 0.55], 0.024),
];

/// Line style of a kind of stroke in a size.
pub(crate) fn style(job: &PrintJob, kind: StrokeKind, layer: usize) -> LineStyle {
    let several = job.layers.len() > 1;
    let (ink, dash) = match several {
        true => SIZES[layer % SIZES.len()],
        false => (BLACK, 0.0),
    };
    let (ink, width, dash) = match kind {
        StrokeKind::Cut => (ink, 0.0005, dash),
        // Fine and solid, to differ from the lines to cut along.
        StrokeKind::Sew => (if several { ink } else { [0.35; 3] }, 0.0002, 0.0),
        StrokeKind::Inside => (if several { ink } else { [0.35; 3] }, 0.0002, 0.004),
        StrokeKind::Notch => (ink, 0.000_35, 0.0),
        // Drawn but not cut: as fine as the lines to sew along.
        StrokeKind::Mark | StrokeKind::Drill => {
            (if several { ink } else { [0.35; 3] }, 0.0002, 0.0)
        }
        StrokeKind::Fold => (PURPLE, 0.0006, 0.02),
        StrokeKind::Grain => (BLUE, 0.0003, 0.0),
    };
    let width = match (job.paper, kind.is_cut()) {
        (Paper::Projector, cut) => PROJECTED[usize::from(cut)].max(width),
        _ => width,
    };
    LineStyle {
        ink,
        width,
        dash,
        layer: Some(kind.into()),
    }
}

/// Whether strokes of a kind are printed.
fn prints(job: &PrintJob, kind: StrokeKind) -> bool {
    !matches!(
        (job.lines, kind),
        (Lines::Cut, StrokeKind::Sew) | (Lines::Sew, StrokeKind::Cut | StrokeKind::Notch)
    )
}

/// Draws a piece in all its sizes. Texts and grain line are drawn once, for the smallest size. Texts keep
/// clear of the lines `clear_of`; if that list is `None`, no texts are drawn.
pub(crate) fn piece_marks(
    job: &PrintJob,
    piece: &PrintPiece,
    clear_of: Option<&[[Vec2; 2]]>,
) -> Vec<Mark> {
    let place = |p: Vec2| piece.pose.apply(p * job.scale);
    let smallest = piece.sizes.iter().enumerate().min_by(|a, b| {
        let area = |k: &(usize, std::sync::Arc<CutPiece>)| k.1.outer().area();
        area(a.1).total_cmp(&area(b.1))
    });
    let smallest = smallest.map(|(k, _)| k);
    let words: Vec<&str> = piece.words.iter().map(String::as_str).collect();
    let mut marks = Vec::new();
    for (k, (layer, cut)) in piece.sizes.iter().enumerate() {
        let own = smallest == Some(k);
        let arrows = cut.pressed.iter().map(|arrow| {
            let half = arrow.way * (0.5 * arrow.width);
            [arrow.at - half, arrow.at + half].map(place)
        });
        let between = clear_of.unwrap_or_default().iter().copied();
        let clear_of_all: Vec<[Vec2; 2]> = between.chain(arrows).collect();
        let writing = Writing {
            lines: match clear_of {
                Some(_) if own => &words,
                _ => &[],
            },
            most: Some(LETTERS),
            clear_of: &clear_of_all,
        };
        let drawing: Drawing = cut.drawing_with(place, &writing);
        for stroke in drawing.strokes {
            let shared = stroke.kind == StrokeKind::Grain;
            if !prints(job, stroke.kind) || (shared && !own) {
                continue;
            }
            let layer = (!shared).then_some(*layer);
            let style = style(job, stroke.kind, layer.unwrap_or(0));
            let told = match stroke.kind {
                StrokeKind::Fold => Some(("fold of the cloth", FOLD_LETTERS, PURPLE)),
                StrokeKind::Grain => Some(("grain", GRAIN_LETTERS, BLUE)),
                StrokeKind::Cut
                | StrokeKind::Sew
                | StrokeKind::Inside
                | StrokeKind::Notch
                | StrokeKind::Mark
                | StrokeKind::Drill => None,
            };
            if let ([from, to], Some(told), true, Some(lines)) =
                (&stroke.points[..], told, own, clear_of)
            {
                let fill = drawing.fill.as_ref();
                marks.extend(words_along([*from, *to], told, (fill, lines)));
            }
            marks.push(Mark::line(layer, (stroke.points, stroke.closed), style));
        }
        if job.lines == Lines::Sew {
            marks.extend(seam_marks(job, cut, (*layer, &place)));
        }
        marks.extend(press_marks(job, cut, (*layer, &place)));
        marks.extend(drawing.words.into_iter().map(words_mark));
    }
    marks
}

/// Notches drawn as marks on the seam line, for prints without the cut line that notches are cut into.
fn seam_marks(
    job: &PrintJob,
    cut: &CutPiece,
    (layer, place): (usize, &dyn Fn(Vec2) -> Vec2),
) -> Vec<Mark> {
    let style = style(job, StrokeKind::Mark, layer);
    let mut lines: Vec<Vec<Vec2>> = Vec::new();
    for notch in cut.notches.iter().filter(|notch| !notch.cut.is_empty()) {
        for line in notch.on_seam_line() {
            let line: Vec<Vec2> = line.iter().map(|p| place(*p)).collect();
            if !lines.contains(&line) {
                lines.push(line);
            }
        }
    }
    let mark = |line| Mark::line(Some(layer), (line, false), style);
    lines.into_iter().map(mark).collect()
}

/// Fold marks of darts and pleats: ticks at the cut line, and arrows in the direction of pressing.
fn press_marks(
    job: &PrintJob,
    cut: &CutPiece,
    (layer, place): (usize, &dyn Fn(Vec2) -> Vec2),
) -> Vec<Mark> {
    let mut marks = Vec::new();
    for tick in &cut.fold_ticks {
        let kind = match tick.in_allowance {
            true => StrokeKind::Notch,
            false => StrokeKind::Mark,
        };
        if prints(job, kind) {
            let line = tick.ends.map(place).to_vec();
            marks.push(Mark::line(
                Some(layer),
                (line, false),
                style(job, kind, layer),
            ));
        }
    }
    // Drawn as visibly as a notch, but not cut.
    let cut_like = style(job, StrokeKind::Notch, layer);
    let drawn = style(job, StrokeKind::Mark, layer);
    let style = LineStyle {
        ink: cut_like.ink,
        width: drawn.width.max(0.000_3),
        ..drawn
    };
    for arrow in &cut.pressed {
        let middle = place(arrow.at);
        let Some(way) = (place(arrow.at + arrow.way) - middle).try_normalize(0.0) else {
            continue;
        };
        let length = ARROW.min(ARROW_SHARE * arrow.width * job.scale);
        let [tail, tip] = [middle - way * (0.5 * length), middle + way * (0.5 * length)];
        let back = tip - way * (HEAD * length);
        let aside = Vec2::new(-way.y, way.x) * (HEAD * HEAD_WIDTH * length);
        for line in [vec![tail, tip], vec![back + aside, tip, back - aside]] {
            marks.push(Mark::line(Some(layer), (line, false), style));
        }
    }
    marks
}

fn words_mark(words: Words) -> Mark {
    Mark {
        layer: None,
        shape: Shape::Text {
            text: words.text,
            at: words.at,
            size: words.size,
            angle: words.angle,
            align: Align::Middle,
            ink: BLACK,
        },
    }
}

/// A text along the fold or the grain line, inside the piece: at the middle of that line, or at another
/// position along it if the text would cross one of the lines `clear_of` there.
fn words_along(
    [from, to]: [Vec2; 2],
    (text, letters, ink): (&str, f64, Ink),
    (fill, clear_of): (Option<&Polygon>, &[[Vec2; 2]]),
) -> Option<Mark> {
    let way = (to - from).try_normalize(0.0)?;
    let size = letters.min((to - from).norm() * ALONG_SHARE);
    let left = Vec2::new(-way.y, way.x) * size;
    let middle = (from + to) * 0.5;
    let inside = fill.is_some_and(|fill| fill.contains(middle + left));
    // The letters stand with their feet towards the fold, and the text is read from below or from the right.
    let (way, above) = if inside { (way, left) } else { (-way, -left) };
    let upside_down = way.x < -1e-6;
    let (way, above) = match upside_down {
        true => (-way, above * 1.9),
        false => (way, above * 0.8),
    };
    let words = |share: f64| Mark {
        layer: None,
        shape: Shape::Text {
            text: text.to_owned(),
            at: from + (to - from) * share + above,
            size,
            angle: way.y.atan2(way.x),
            align: Align::Middle,
            ink,
        },
    };
    let is_whole = |mark: &Mark| {
        let bounds = mark.bounds();
        clear_of
            .iter()
            .all(|line| clipped(line, false, &bounds).is_empty())
    };
    let places = ALONG_PLACES.map(words).into_iter();
    places.clone().find(is_whole).or(places.into_iter().next())
}
