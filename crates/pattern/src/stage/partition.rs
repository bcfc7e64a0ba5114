//! A stage cut apart: assigns its lines, notches and darts to the parts.

use super::dart::{parameter, part};
use super::motion::Motion;
use super::{PlaceError, Stage, StageDart, StageEdge, StageLine, StageNotch};
use crate::{CornerName, EdgeCorner, LineKind, LineName, Name, Role};
use toile_geometry::{Path, Polygon, Vec2, closest_on_segment};

/// Reason why a stage cannot be cut apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum CutError {
    /// A place is not on the outline.
    Place(PlaceError),
    /// The stage is unfolded already: a cut would divide one half and leave the other half whole.
    Unfolded,
    /// A cut has no length.
    NoLength,
    /// A cut leaves the panel or crosses its outline between its ends.
    LeavesPanel,
    /// A cut goes through a hole.
    ThroughHole,
}

/// Largest distance between positions that count as equal (m).
pub(super) const SAME: f64 = 1e-9;
/// Arc length from either end of a cut within which the cut may touch the outline or a hole (m). Also the
/// least distance of its middle from the outline (m).
const AT_END: f64 = 1e-6;
/// Largest distance between a curve and its chords in the polygons that decide in which part a point lies
/// (m).
const FLATNESS: f64 = 1e-5;

/// The lines, notches and darts of a stage that is cut apart, except the outline that is cut; each with the
/// index of its part.
pub(super) struct Partition {
    pub lines: Vec<(StageLine, usize)>,
    pub notches: Vec<(StageNotch, usize)>,
    /// Darts, each with the parts that have its leg before and its leg after the apex.
    pub darts: Vec<(StageDart, [usize; 2])>,
}

/// Index of the outline with this name among the lines of a stage; refused if the stage is unfolded.
pub(super) fn outline_of(stage: &Stage, name: LineName) -> Result<usize, CutError> {
    if !stage.folds.is_empty() {
        return Err(CutError::Unfolded);
    }
    let mut lines = stage.lines.iter();
    let found = lines.position(|line| line.name == name && line.kind == LineKind::Outline);
    found.ok_or(CutError::Place(PlaceError::NoLine))
}

impl StageLine {
    /// Divides an edge of a closed line at an arc length from the start of the line (m), unless an edge
    /// starts there already; returns the index of the edge that starts there.
    pub(super) fn divide(&mut self, along: f64) -> usize {
        let mut before = 0.0;
        for k in 0..self.edges.len() {
            if along <= before + SAME {
                return k;
            }
            let edge = &self.edges[k];
            let own = edge.curve.length();
            if along < before + own - SAME {
                let share = edge.from + (edge.to - edge.from) * (along - before) / own;
                let at = edge.curve.point(parameter(edge, share));
                let first = part(edge, edge.from, share, [edge.curve.start(), at]);
                let second = part(edge, share, edge.to, [at, edge.curve.end()]);
                self.edges[k] = first;
                let second = StageEdge {
                    start: None,
                    corner: EdgeCorner::default(),
                    ..second
                };
                self.edges.insert(k + 1, second);
                return k + 1;
            }
            before += own;
        }
        0
    }

    /// Names the corner at the start of an edge. If the corner has a name already, the new name is added as a
    /// twin.
    pub(super) fn call(&mut self, edge: usize, name: CornerName) {
        match self.edges[edge].start {
            Some(known) => self.twins.push([name, known]),
            None => self.edges[edge].start = Some(name),
        }
    }
}

/// The polygon that edges enclose.
pub(super) fn ring<'e>(edges: impl IntoIterator<Item = &'e StageEdge>) -> Vec<Vec2> {
    let mut ring: Vec<Vec2> = Vec::new();
    for edge in edges {
        let points = edge.curve.flatten(FLATNESS);
        ring.extend(points.into_iter().skip(usize::from(!ring.is_empty())));
    }
    ring
}

/// Refuses a cut that has no length, leaves the panel or goes through a hole.
pub(super) fn check_cut(stage: &Stage, outline: usize, cut: &Path) -> Result<(), CutError> {
    let length = cut.length();
    if length <= SAME {
        return Err(CutError::NoLength);
    }
    let path = |line: &StageLine| Path::new(line.edges.iter().map(|edge| edge.curve).collect());
    let inside = |along: f64| along > AT_END && along < length - AT_END;
    let leaves = |crossing: &toile_geometry::PathCrossing| inside(crossing.here.along);
    let line = &stage.lines[outline];
    let middle = cut.at_length(0.5 * length).map(|place| cut.point(place));
    let outside = path(line);
    let within = middle.is_some_and(|p| {
        let nearest = outside.nearest(p).map(|place| outside.point(place));
        let clear = nearest.is_some_and(|near| (near - p).norm() > AT_END);
        clear && Polygon::new(ring(&line.edges)).contains(p)
    });
    if !within || cut.crossings(&outside).iter().any(leaves) {
        return Err(CutError::LeavesPanel);
    }
    let mut holes = stage.lines.iter().filter(|l| l.kind == LineKind::Hole);
    match holes.any(|hole| cut.crossings(&path(hole)).iter().any(leaves)) {
        true => Err(CutError::ThroughHole),
        false => Ok(()),
    }
}

/// Assigns lines, notches and darts to the parts. `edges` are the edges of the cut outline, each with its
/// part; `rings` are the polygons of the parts. Internal lines are divided where cuts cross them.
pub(super) fn partition(
    stage: &Stage,
    outline: usize,
    edges: &[(StageEdge, usize)],
    (cuts, rings): (&[Path], &[Vec<Vec2>]),
) -> Partition {
    let mut lines: Vec<(StageLine, usize)> = Vec::new();
    for (k, line) in stage.lines.iter().enumerate() {
        match line.kind {
            _ if k == outline || line.edges.is_empty() => {}
            LineKind::Internal => lines.extend(parts_of_line(line, cuts, rings)),
            LineKind::Outline | LineKind::Hole => {
                lines.push((line.clone(), part_at(rings, line.edges[0].curve.point(0.5))))
            }
        }
    }
    let part_of = |is: &dyn Fn(&StageEdge) -> bool| {
        let own = edges.iter().find(|(edge, _)| is(edge)).map(|found| found.1);
        let mut others = lines.iter();
        own.or_else(|| Some(others.find(|(line, _)| line.edges.iter().any(is))?.1))
    };
    let notch_part = |notch: &StageNotch| {
        let found = part_of(&|edge: &StageEdge| {
            let (low, high) = (edge.from.min(edge.to), edge.from.max(edge.to));
            edge.name == notch.edge
                && edge.half == notch.half
                && (low - 1e-12..=high + 1e-12).contains(&notch.share)
        });
        found.unwrap_or_else(|| part_at(rings, notch.point))
    };
    let dart_parts = |dart: &StageDart| {
        [0, 1].map(|index| {
            let name = Name::Made {
                by: dart.by,
                role: Role::Leg,
                index,
            };
            let found = part_of(&|edge: &StageEdge| edge.name == name && edge.half == dart.half);
            found.unwrap_or_else(|| part_at(rings, dart.apex))
        })
    };
    Partition {
        notches: stage.notches.iter().map(|n| (*n, notch_part(n))).collect(),
        darts: stage.darts.iter().map(|d| (*d, dart_parts(d))).collect(),
        lines,
    }
}

/// An internal line, divided where cuts cross it; each piece has the index of its part.
fn parts_of_line(line: &StageLine, cuts: &[Path], rings: &[Vec<Vec2>]) -> Vec<(StageLine, usize)> {
    let path = Path::new(line.edges.iter().map(|edge| edge.curve).collect());
    let length = path.length();
    let crossings = cuts.iter().flat_map(|cut| path.crossings(cut));
    let mut inner: Vec<f64> = crossings
        .map(|crossing| crossing.here.along)
        .filter(|along| *along > SAME && *along < length - SAME)
        .collect();
    inner.sort_by(f64::total_cmp);
    inner.dedup_by(|b, a| *b - *a <= SAME);
    let mut rest = line.clone();
    for &along in &inner {
        rest.divide(along);
    }
    let bounds: Vec<f64> = [0.0].into_iter().chain(inner).chain([length]).collect();
    let mut parts: Vec<(StageLine, usize)> = Vec::new();
    let mut before = 0.0;
    for edge in rest.edges.drain(..) {
        let own = edge.curve.length();
        let middle = before + 0.5 * own;
        before += own;
        let piece = bounds.windows(2).find(|b| (b[0]..=b[1]).contains(&middle));
        let along = piece.map_or(middle, |b| 0.5 * (b[0] + b[1]));
        let at = path
            .at_length(along)
            .map_or(edge.curve.point(0.5), |p| path.point(p));
        let part = part_at(rings, at);
        match parts.last_mut().filter(|last| last.1 == part) {
            Some((last, _)) => last.edges.push(edge),
            None => parts.push((
                StageLine {
                    edges: vec![edge],
                    end: None,
                    twins: line.twins.clone(),
                    ..*line
                },
                part,
            )),
        }
    }
    if let Some((last, _)) = parts.last_mut() {
        last.end = line.end;
    }
    parts
}

/// Index of the part that contains a point; if no part does, of the part nearest to it.
fn part_at(rings: &[Vec<Vec2>], at: Vec2) -> usize {
    let inside = rings
        .iter()
        .position(|ring| ring.len() > 2 && Polygon::new(ring.clone()).contains(at));
    let away = |ring: &Vec<Vec2>| {
        let ends = ring.iter().zip(ring.iter().cycle().skip(1));
        let distances = ends.map(|(a, b)| (closest_on_segment(at, [*a, *b]) - at).norm());
        distances.fold(f64::INFINITY, f64::min)
    };
    let nearest = || {
        let all = rings.iter().enumerate();
        all.min_by(|a, b| away(a.1).total_cmp(&away(b.1)))
            .map(|found| found.0)
    };
    inside.or_else(nearest).unwrap_or(0)
}

impl Partition {
    /// The stage with a new outline; all other lines, notches and darts are moved with their parts.
    pub fn moved(
        self,
        stage: &Stage,
        outline: usize,
        line: StageLine,
        motions: &[Motion],
    ) -> Stage {
        let mut lines: Vec<StageLine> = Vec::with_capacity(self.lines.len() + 1);
        for (line, part) in self.lines {
            let edges = line
                .edges
                .iter()
                .map(|edge| motions[part].edge(edge))
                .collect();
            lines.push(StageLine { edges, ..line });
        }
        lines.insert(outline.min(lines.len()), line);
        Stage {
            lines,
            notches: self
                .notches
                .into_iter()
                .map(|(notch, part)| motions[part].notch(notch))
                .collect(),
            darts: self
                .darts
                .into_iter()
                .map(|(dart, [first, second])| motions[first].dart(motions[second], dart))
                .collect(),
            ..stage.clone()
        }
    }
}
