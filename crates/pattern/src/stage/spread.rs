//! Panels cut apart along straight cuts and spread.

use super::motion::Motion;
use super::partition::{CutError, SAME, check_cut, outline_of, partition, ring};
use super::{PlaceError, Placed, Stage, StageEdge, StageLine, with_ends};
use crate::{Bridge, CornerName, EdgeCorner, LineName, Name, OperationId, Role, SpreadCut};
use toile_geometry::{Curve, Path, Vec2};

/// A spread operation with its numbers evaluated.
#[derive(Clone, Debug)]
pub(crate) struct Spreading {
    pub by: OperationId,
    pub line: LineName,
    /// A position on the line. The part of the panel that has it stays fixed.
    pub held: Placed,
    pub cuts: Vec<SpreadAlong>,
    pub bridge: Bridge,
}

/// A cut of a spread with its numbers evaluated.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpreadAlong {
    pub number: u16,
    pub ends: [Placed; 2],
    /// Openings at the start and at the end of the cut (m).
    pub openings: [f64; 2],
}

/// Reason why a panel cannot be spread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum SpreadError {
    /// The cut with this number cannot be made.
    Cut(u16, CutError),
    /// The line, or the place on it that stays fixed, is missing, or the stage is unfolded already.
    Line(CutError),
    /// An opening of the cut with this number is negative.
    Negative(u16),
    /// The openings of the cut with this number differ by more than twice its length.
    TooWide(u16),
    /// Two cuts, with these numbers, cross or lie on each other.
    Cross(u16, u16),
    /// Two cuts, with these numbers, open at the same place.
    OneEnd(u16, u16),
    /// Two cuts have this same number.
    Number(u16),
    /// There are more than [`MAX_CUTS`] cuts.
    TooMany,
    /// The number of a cut or pleat is too large to number its parts by: the number, and the largest allowed.
    Large(u16, u16),
    /// The depth of pleats is negative.
    NoDepth,
    /// The pleat with this number is too deep: within the depth of a fold, the outline beside it ends or runs
    /// back towards the pleat.
    TooDeep(u16),
}

/// Most cuts of one operation: a set of cuts is stored as one bit for each cut.
pub(crate) const MAX_CUTS: usize = 64;

/// A cut between two corners of the outline; `at` are the indices of the edges that start at these corners.
pub(super) struct Chord {
    pub at: [usize; 2],
    pub points: [Vec2; 2],
    pub number: u16,
    pub openings: [f64; 2],
}

/// The stage, spread along its cuts.
pub(crate) fn spread(stage: &Stage, wish: &Spreading) -> Result<Stage, SpreadError> {
    let open = CutOpen::of(stage, wish, SpreadCut::LARGEST)?;
    open.moved(stage, |gap| {
        let index = 2 * gap.chord.number + gap.end as u16;
        let name = |corner: u16| Name::Made {
            by: wish.by,
            role: Role::Opening,
            index: 2 * index + corner,
        };
        let edge = StageEdge {
            name: Name::Made {
                by: wish.by,
                role: Role::Opening,
                index,
            },
            half: 0,
            start: Some(name(0)),
            from: 0.0,
            to: 1.0,
            curve: bridge(wish.bridge, gap.before, gap.after),
            allowance: gap.before.allowance,
            corner: EdgeCorner::default(),
        };
        Ok(Crossed {
            corners: [name(0), name(1)],
            edges: vec![edge],
        })
    })
}

/// A stage that is cut along chords, with the motion of each of its parts.
pub(super) struct CutOpen {
    outline: usize,
    /// The outline, divided at both ends of each cut.
    pub line: StageLine,
    pub chords: Vec<Chord>,
    parts: Parts,
}

/// An end of a cut, where the outline has an opening.
pub(super) struct Gap<'g> {
    pub chord: &'g Chord,
    /// 0 at the start of the cut, 1 at its end.
    pub end: usize,
    /// Index, in the divided outline, of the edge after the opening.
    pub at: usize,
    /// The edge before the opening, moved with its part.
    pub before: &'g StageEdge,
    /// The edge after the opening, moved with its part.
    pub after: &'g StageEdge,
}

/// The edges that lead across an opening.
pub(super) struct Crossed {
    /// The corners at the start and end of these edges.
    pub corners: [CornerName; 2],
    pub edges: Vec<StageEdge>,
}

impl CutOpen {
    /// Cuts a stage along the cuts of `wish`; `largest` is the largest number that a cut may have.
    pub fn of(stage: &Stage, wish: &Spreading, largest: u16) -> Result<Self, SpreadError> {
        if let Some(cut) = wish.cuts.iter().find(|cut| cut.number > largest) {
            return Err(SpreadError::Large(cut.number, largest));
        }
        let outline = outline_of(stage, wish.line).map_err(SpreadError::Line)?;
        let mut line = stage.lines[outline].clone();
        if wish.cuts.len() > MAX_CUTS {
            return Err(SpreadError::TooMany);
        }
        let lost = |error: PlaceError| CutError::Place(error);
        let held = line
            .placed(wish.held)
            .map_err(|e| SpreadError::Line(lost(e)))?;
        let mut places = Vec::with_capacity(wish.cuts.len());
        for cut in &wish.cuts {
            let place = |end: usize| line.placed(cut.ends[end]);
            let of_cut = |error| SpreadError::Cut(cut.number, lost(error));
            places.push([place(0).map_err(of_cut)?, place(1).map_err(of_cut)?]);
        }
        let mut all: Vec<f64> = places.iter().flatten().copied().collect();
        all.sort_by(f64::total_cmp);
        for along in all {
            line.divide(along);
        }
        let cuts = wish.cuts.iter().zip(&places);
        let chords: Vec<Chord> = cuts
            .map(|(cut, ends)| {
                let at = ends.map(|along| line.divide(along));
                Chord {
                    at,
                    points: at.map(|k| line.edges[k].curve.start()),
                    number: cut.number,
                    openings: cut.openings,
                }
            })
            .collect();
        check_chords(stage, outline, &chords)?;
        let parts = Parts::of(&chords, &line, stage.turn(), held);
        Ok(Self {
            outline,
            line,
            chords,
            parts,
        })
    }

    /// Motion of the part that an edge is on.
    pub fn motion(&self, edge: usize) -> Motion {
        self.parts.motions[self.parts.of_edge[edge]]
    }

    /// The stage with all parts moved, and with the edges that `cross` gives across the openings.
    pub fn moved(
        &self,
        stage: &Stage,
        cross: impl Fn(&Gap<'_>) -> Result<Crossed, SpreadError>,
    ) -> Result<Stage, SpreadError> {
        let edges = self.line.edges.iter().cloned();
        let parted: Vec<(StageEdge, usize)> =
            edges.zip(self.parts.of_edge.iter().copied()).collect();
        let rings: Vec<Vec<Vec2>> = (0..self.parts.motions.len())
            .map(|part| ring(parted.iter().filter(|own| own.1 == part).map(|own| &own.0)))
            .collect();
        let cuts: Vec<Path> = self.chords.iter().map(Chord::path).collect();
        let everything = partition(stage, self.outline, &parted, (&cuts, &rings));
        let line = self.bridged(cross)?;
        Ok(everything.moved(stage, self.outline, line, &self.parts.motions))
    }

    /// The outline with all parts moved, and with the edges that `cross` gives across the openings.
    fn bridged(
        &self,
        cross: impl Fn(&Gap<'_>) -> Result<Crossed, SpreadError>,
    ) -> Result<StageLine, SpreadError> {
        let mut line = self.line.clone();
        let count = line.edges.len();
        let moved: Vec<StageEdge> = (0..count)
            .map(|k| self.motion(k).edge(&line.edges[k]))
            .collect();
        let mut edges: Vec<StageEdge> = Vec::with_capacity(count + 2 * self.chords.len());
        for (k, own) in moved.iter().enumerate() {
            let before = &moved[(k + count - 1) % count];
            let mut next = own.clone();
            let open = (own.curve.start() - before.curve.end()).norm() > SAME;
            for chord in &self.chords {
                for end in (0..2).filter(|&end| chord.at[end] == k) {
                    let gap = Gap {
                        chord,
                        end,
                        at: k,
                        before,
                        after: own,
                    };
                    let Crossed {
                        corners: [first, last],
                        edges: across,
                    } = cross(&gap)?;
                    line.call(k, last);
                    next.start = line.edges[k].start;
                    match open {
                        true => {
                            edges.extend(across);
                            next.corner = EdgeCorner::default();
                        }
                        false => line.twins.push([first, next.start.unwrap_or(last)]),
                    }
                }
            }
            if !open {
                next.curve = with_ends(next.curve, before.curve.end(), next.curve.end());
            }
            edges.push(next);
        }
        Ok(StageLine { edges, ..line })
    }
}

impl Chord {
    fn path(&self) -> Path {
        let [start, end] = self.points;
        Path::new(vec![Curve::Line { start, end }])
    }

    /// Whether an edge of the outline lies between the two ends of the cut, in the order of edges.
    fn is_between(&self, edge: usize) -> bool {
        let [a, b] = self.at;
        (a.min(b)..a.max(b)).contains(&edge)
    }

    /// Whether another cut, which does not cross this one, lies between the two ends of this cut, in the
    /// order of edges.
    fn has_between(&self, other: &Self) -> bool {
        let own = other.at.iter().find(|at| !self.at.contains(at));
        own.is_some_and(|at| self.is_between(*at))
    }

    fn crosses(&self, other: &Self) -> bool {
        let free: Vec<bool> = other
            .at
            .iter()
            .filter(|at| !self.at.contains(at))
            .map(|at| self.is_between(*at))
            .collect();
        free.is_empty() || free.len() == 2 && free[0] != free[1]
    }

    /// Motion of the part of the panel on one side of the cut, left of it if `left`, when the cut opens and
    /// the part on its other side stays.
    fn opened(&self, left: bool) -> Motion {
        let [start, end] = self.points;
        let way = end - start;
        let [a, b] = self.openings;
        let side = if left { 1.0 } else { -1.0 };
        // The opened cut is an isosceles trapezoid: its legs are the two copies of the cut, its bases the
        // openings.
        let half = ((a - b) / (2.0 * way.norm())).clamp(-1.0, 1.0).asin();
        let axis = Motion::about(Vec2::zeros(), -side * half).direction(way.normalize());
        let across = Vec2::new(-axis.y, axis.x) * side;
        Motion::taking(start, start + across * a, -2.0 * side * half)
    }
}

fn check_chords(stage: &Stage, outline: usize, chords: &[Chord]) -> Result<(), SpreadError> {
    for (k, chord) in chords.iter().enumerate() {
        let number = chord.number;
        check_cut(stage, outline, &chord.path()).map_err(|e| SpreadError::Cut(number, e))?;
        let [a, b] = chord.openings;
        if a < 0.0 || b < 0.0 {
            return Err(SpreadError::Negative(number));
        }
        if (a - b).abs() > 2.0 * (chord.points[1] - chord.points[0]).norm() {
            return Err(SpreadError::TooWide(number));
        }
        for other in &chords[..k] {
            if other.number == number {
                return Err(SpreadError::Number(number));
            }
            if chord.crosses(other) {
                return Err(SpreadError::Cross(other.number, number));
            }
            let opens = |chord: &Chord, at: usize| {
                (0..2).any(|end| chord.at[end] == at && chord.openings[end] > SAME)
            };
            if chord
                .at
                .iter()
                .any(|&at| opens(chord, at) && other.at.contains(&at) || opens(other, at))
            {
                return Err(SpreadError::OneEnd(other.number, number));
            }
        }
    }
    Ok(())
}

/// The parts into which the cuts divide a panel.
struct Parts {
    /// For each edge of the divided outline, the index of its part.
    of_edge: Vec<usize>,
    /// Motion of each part.
    motions: Vec<Motion>,
}

impl Parts {
    fn of(chords: &[Chord], line: &StageLine, turn: f64, held: f64) -> Self {
        let key = |edge: usize| -> u64 {
            let bits = chords.iter().enumerate();
            bits.map(|(k, chord)| u64::from(chord.is_between(edge)) << k)
                .sum()
        };
        let mut keys: Vec<u64> = Vec::new();
        let of_edge = (0..line.edges.len())
            .map(|edge| {
                let own = key(edge);
                keys.iter()
                    .position(|known| *known == own)
                    .unwrap_or_else(|| {
                        keys.push(own);
                        keys.len() - 1
                    })
            })
            .collect();
        let mut before = 0.0;
        let ends = line.edges.iter().map(|edge| {
            before += edge.curve.length();
            before
        });
        let held = ends
            .into_iter()
            .position(|end| held < end - SAME)
            .unwrap_or(0);
        let still = key(held);
        let motions = keys
            .iter()
            .map(|&own| motion(chords, (still, own), turn))
            .collect();
        Self { of_edge, motions }
    }
}

/// Motion of a part: the motions at all cuts between it and the fixed part, beginning with the cut nearest to
/// the fixed part. `own` and `still` are keys of the two parts: bit k of a key is set if the part lies
/// between the ends of cut k in the order of edges.
fn motion(chords: &[Chord], (still, own): (u64, u64), turn: f64) -> Motion {
    let is_far = |k: usize| own >> k & 1 == 1;
    let between: Vec<usize> = (0..chords.len())
        .filter(|k| (still ^ own) >> k & 1 == 1)
        .collect();
    let depth = |k: usize| {
        let others = between.iter().filter(|&&d| d != k);
        let nearer = others.filter(|&&d| chords[d].has_between(&chords[k]) == is_far(d));
        nearer.count()
    };
    let mut order: Vec<(usize, usize)> = between.iter().map(|&k| (depth(k), k)).collect();
    order.sort_unstable();
    order.iter().fold(Motion::NONE, |so_far, &(_, k)| {
        let chord = &chords[k];
        // On a counter-clockwise outline, the part between the start and the end of the cut lies right of the
        // cut.
        let forwards = chord.at[0] < chord.at[1];
        let left = (is_far(k) == forwards) != (turn > 0.0);
        so_far.after(chord.opened(left))
    })
}

/// The curve across an opening, from the end of one edge to the start of another.
fn bridge(kind: Bridge, before: &StageEdge, after: &StageEdge) -> Curve {
    let (start, end) = (before.curve.end(), after.curve.start());
    let leaving = before.curve.derivative(1.0).try_normalize(1e-15);
    let arriving = after.curve.derivative(0.0).try_normalize(1e-15);
    match (kind, leaving, arriving) {
        (Bridge::Smooth, Some(leaving), Some(arriving)) => {
            let handle = (end - start).norm() / 3.0;
            Curve::Cubic {
                start,
                controls: [start + leaving * handle, end - arriving * handle],
                end,
            }
        }
        _ => Curve::Line { start, end },
    }
}
