//! Makes a drawn piece, in metres, of the blocks of its sizes.

use super::block_piece::{BlockLine, BlockPiece};
use super::piece_lines::{FoundLine, SizedPiece, tell_apart};
use super::piece_marks::{corners, drills, notches, with_marks};
use super::sized_pieces::NestedPiece;
use crate::Loss;
use crate::drawn::allowance::{distance, is_evenly_inside};
use crate::drawn::inset::inset;
use crate::drawn::piece::{DrawnLine, DrawnPiece};
use toile_geometry::{Vec2, ring_area};
use toile_pattern::Cut;

/// Largest distance of a vertex from the fold line that it lies on (m).
const ON_FOLD: f64 = 5e-4;
/// Largest allowance between a sew line on the layer of internal lines and the cut line (m).
const MAX_ALLOWANCE: f64 = 0.05;
/// Least share of the area within the cut line that lies within such a sew line (1).
const MIN_SEWN: f64 = 0.3;

/// Makes pieces of one file.
#[derive(Debug)]
pub(super) struct PieceMaker {
    /// Index of the base size.
    pub base: usize,
    /// Number of sizes, at least 1.
    pub count: usize,
    /// Length of a unit of the file (m).
    pub unit: f64,
    /// Distance from a cut line to the sew line of pieces that have no other (m).
    pub inside: Option<f64>,
    /// Number of pieces that have no sew line.
    pub without_sew_line: usize,
    pub losses: Vec<Loss>,
}

/// Place of the sew line of a piece in its block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum SewLine {
    /// On its layer: the number of the line there.
    Own(usize),
    /// Among the internal lines.
    Internal(usize),
    /// Among the closed lines within the cut line.
    Cutout(usize),
    None,
}

impl PieceMaker {
    /// A piece; `None` if it has no block.
    pub fn piece(&mut self, nested: &NestedPiece) -> Option<DrawnPiece> {
        let own = &with_marks(nested.sized.get(&self.base)?, &nested.sized);
        let name = nested.name.as_str();
        let piece = SizedPiece {
            own,
            sized: &nested.sized,
            count: self.count,
            unit: self.unit,
        };
        let cut = self.told(name, piece.line(|piece| piece.cut.first(), 84))?;
        let cut_points = cut.in_size(self.base).to_vec();
        let fold = own.mirror.first().map(|line| {
            let from = line.points[0];
            let off = |p: &Vec2| (p - from).norm();
            // A line that is drawn twice runs there and back.
            let to = line.points.iter().copied();
            let to = to.max_by(|a, b| off(a).total_cmp(&off(b)));
            [from, to.unwrap_or(from)].map(|p| p * self.unit)
        });
        let place = self.sew_line(own, &cut_points);
        let sew = match place {
            SewLine::Own(k) => self.told(name, piece.line(|piece| piece.sew.get(k), 87)),
            SewLine::Internal(k) => self.told(name, piece.line(|piece| piece.internal.get(k), 85)),
            SewLine::Cutout(k) => self.told(name, piece.line(|piece| piece.cutouts.get(k), 86)),
            SewLine::None => self
                .inside
                .and_then(|by| self.inside(name, &cut, (fold, by))),
        };
        let is_found = sew.is_some();
        self.without_sew_line += usize::from(!is_found);
        let mut outline = sew.unwrap_or_else(|| cut.clone());
        outline.is_corner = corners(&outline, &cut_points, own, (self.base, self.unit));
        let drills = drills(own, &nested.sized, (&outline, self.base, self.unit));
        tell_apart(&mut outline);
        let mut drawn = DrawnPiece {
            name: name.to_owned(),
            fabric: own.labels.value(&["fabric", "material"]).map(str::to_owned),
            cut: quantity(own),
            cut_outline: is_found.then(|| self.with_corners(cut, own)),
            cut_line: is_found.then_some(cut_points),
            notches: notches(own, &nested.sized, (self.count, self.unit)),
            grain: own
                .grain
                .iter()
                // Arrows at its ends are shorter.
                .flat_map(|line| line.points.windows(2).map(|ends| ends[1] - ends[0]))
                .max_by(|a, b| a.norm().total_cmp(&b.norm()))
                .map(|along| along.y.atan2(along.x)),
            fold,
            drills,
            outline,
            ..DrawnPiece::default()
        };
        self.lines_inside(&mut drawn, &piece, place);
        self.left_out(name, own);
        Some(drawn)
    }

    /// The cut line with its corners, without repeats.
    fn with_corners(&self, mut cut: DrawnLine, own: &BlockPiece) -> DrawnLine {
        let points = cut.in_size(self.base).to_vec();
        cut.is_corner = corners(&cut, &points, own, (self.base, self.unit));
        tell_apart(&mut cut);
        cut
    }

    /// A line that was found, and tells what of it was not.
    fn told(&mut self, name: &str, found: Option<FoundLine>) -> Option<DrawnLine> {
        let found = found?;
        let why = "blocks of these sizes have no such line; they take that of the base size";
        self.lost(name, (found.unlike, "lines in other sizes", why));
        let why =
            "they do not run along their lines in every size; splines go through the vertices";
        self.lost(
            name,
            (usize::from(found.is_twin_off), "dense twins of lines", why),
        );
        Some(found.line)
    }

    fn lines_inside(&mut self, drawn: &mut DrawnPiece, piece: &SizedPiece<'_>, sew: SewLine) {
        let name = drawn.name.clone();
        let own = piece.own;
        for k in (0..own.internal.len()).filter(|&k| sew != SewLine::Internal(k)) {
            let line = self.told(&name, piece.line(|piece| piece.internal.get(k), 85));
            drawn.inside.extend(line);
        }
        let mut open = 0;
        for k in (0..own.cutouts.len()).filter(|&k| sew != SewLine::Cutout(k)) {
            let line = self.told(&name, piece.line(|piece| piece.cutouts.get(k), 86));
            match own.cutouts[k].is_closed {
                true => drawn.holes.extend(line),
                false => {
                    open += 1;
                    drawn.inside.extend(line);
                }
            }
        }
        let why = "they are not closed; kept as lines inside";
        self.lost(&name, (open, "cut-outs", why));
        let mut further = 0;
        for k in (0..own.sew.len()).filter(|&k| sew != SewLine::Own(k)) {
            further += 1;
            drawn
                .inside
                .extend(self.told(&name, piece.line(|piece| piece.sew.get(k), 87)));
        }
        let why = "they are not the closed outline; kept as lines inside";
        self.lost(&name, (further, "sew lines", why));
        for line in drawn.inside.iter_mut().chain(&mut drawn.holes) {
            tell_apart(line);
        }
        drawn.inside.retain(|line| line.len() > 1);
        drawn
            .holes
            .retain(|line| line.chords(self.base).points.len() > 2);
    }

    /// Place of the sew line: on its layer, else evenly inside the cut line among internal lines, as Valentina
    /// draws it, or among closed lines on the cut layer.
    fn sew_line(&self, own: &BlockPiece, cut: &[Vec2]) -> SewLine {
        let largest = |lines: &[BlockLine]| {
            let closed = (0..lines.len()).filter(|&k| lines[k].is_closed);
            closed.max_by(|&a, &b| lines[a].area().total_cmp(&lines[b].area()))
        };
        if let Some(k) = largest(&own.sew) {
            return SewLine::Own(k);
        }
        let whole = ring_area(cut).abs();
        let is_evenly = |lines: &[BlockLine], k: &usize| {
            let inner: Vec<Vec2> = lines[*k].points.iter().map(|p| p * self.unit).collect();
            ring_area(&inner).abs() > MIN_SEWN * whole
                && is_evenly_inside(&inner, cut, MAX_ALLOWANCE)
                && cut
                    .iter()
                    .all(|p| distance(*p, &inner) <= 2.0 * MAX_ALLOWANCE)
        };
        if let Some(k) = largest(&own.internal).filter(|k| is_evenly(&own.internal, k)) {
            return SewLine::Internal(k);
        }
        match largest(&own.cutouts).filter(|k| is_evenly(&own.cutouts, k)) {
            Some(k) => SewLine::Cutout(k),
            None => SewLine::None,
        }
    }

    /// A sew line at a distance inside a cut line, but on it along the fold; `None`, with a loss, where the piece
    /// is too narrow for it.
    fn inside(
        &mut self,
        name: &str,
        cut: &DrawnLine,
        (fold, by): (Option<[Vec2; 2]>, f64),
    ) -> Option<DrawnLine> {
        let mut line = cut.clone();
        let is_clockwise = line.area(self.base) < 0.0;
        if is_clockwise {
            line.reverse();
        }
        let ends = fold.map(|[a, b]| [a, b, a]);
        let ring = line.in_size(self.base).to_vec();
        let on_fold = |k: usize| {
            let on = |p: Vec2| ends.is_some_and(|ends| distance(p, &ends) <= ON_FOLD);
            on(ring[k]) && on(ring[(k + 1) % ring.len()])
        };
        let by = |k: usize| if on_fold(k) { 0.0 } else { by };
        for size in 0..line.by_size.len() {
            // Points of curves between the vertices move as these do.
            let chords = line.chords(size);
            let Some(moved) = inset(&chords.points, |chord| by(chords.vertex(chord))) else {
                let why = "the piece is too narrow for it";
                self.lost(name, (1, "the allowance that was asked for", why));
                return None;
            };
            let ends = chords.starts.iter().copied().skip(1).chain([moved.len()]);
            let spans: Vec<(usize, usize)> = chords.starts.iter().copied().zip(ends).collect();
            line.by_size[size] = spans.iter().map(|&(start, _)| moved[start]).collect();
            if let Some(between) = line.between.get_mut(size) {
                let of = |&(start, end): &(usize, usize)| moved[start + 1..end].to_vec();
                *between = spans.iter().map(of).collect();
            }
        }
        if is_clockwise {
            line.reverse();
        }
        Some(line)
    }

    /// Tells what of a block has no place in the document.
    fn left_out(&mut self, name: &str, own: &BlockPiece) {
        let no_place = "the document has no place for them";
        let all = [
            (
                own.rules.len(),
                "numbers of grade rules",
                "rules come from the blocks of sizes, or from a table given with --with",
            ),
            (own.u_notches, "U notches", "read as V notches"),
            (
                own.depths,
                "depths of notches",
                "all are cut as deep as this program does",
            ),
            (
                own.open_cuts,
                "cut lines",
                "they are not closed; the only line of a named piece is closed straight",
            ),
            (own.flat_cuts, "closed cut lines", "they enclose nothing"),
            (
                own.mirror.len().saturating_sub(1),
                "further mirror lines",
                "a piece is read with one fold",
            ),
            (own.references + own.axes.len(), "reference lines", no_place),
            (
                own.others,
                "lines and points on layers of no standard",
                "their meaning is not known",
            ),
            (own.labels.others.len(), "texts", no_place),
            (
                usize::from(own.labels.is_quantity_nothing()),
                "quantities of 0",
                "read as 1",
            ),
        ];
        all.into_iter().for_each(|loss| self.lost(name, loss));
    }

    /// Tells a loss; what several pieces lose is told once.
    fn lost(&mut self, name: &str, (count, what, why): (usize, &str, &str)) {
        if count == 0 {
            return;
        }
        let alike = |loss: &&mut Loss| loss.what == what && loss.why == why;
        match self.losses.iter_mut().find(alike) {
            Some(loss) => {
                loss.count += count;
                if loss.place != name {
                    loss.place.clear();
                }
            }
            None => self.losses.push(Loss {
                count,
                ..Loss::at(name, what, why)
            }),
        }
    }
}

fn quantity(own: &BlockPiece) -> Cut {
    match own.labels.quantity() {
        None => Cut::default(),
        Some([left, 0]) => Cut {
            quantity: left,
            mirrored: false,
        },
        Some([0, right]) => Cut {
            quantity: right,
            mirrored: false,
        },
        Some([left, right]) => Cut {
            quantity: left.saturating_add(right),
            mirrored: true,
        },
    }
}
