//! The face of a sheet's curves that contains a point: the outline meant by a tap inside a drawing.
//!
//! Curves are cut at the points that lie on them; the stretches are the edges of a planar graph. Its faces
//! are walked by turning at every node to the next stretch clockwise (de Berg, Cheong, van Kreveld, Overmars
//! 2008, chapter 2), after removal of stretches that bound no face.

use super::chain::{ON_CURVE, Stretch, along};
use super::impossible;
use crate::{Curve, CurveId, EditError, Evaluation, PointId, Sheet};
use std::sync::Arc;
use toile_geometry::{Bounds2, Path, Polygon, Vec2};

/// Largest distance between a curve and the polygon that approximates it (m).
const FLAT: f64 = 1e-5;
/// Distance from a node at which the directions of the stretches that meet there are compared, as a share of
/// the shortest of them (1).
const NEAR_NODE: f64 = 1e-3;

/// A face: its outline, counter-clockwise, and its holes, clockwise.
pub(super) struct Face {
    pub outline: Vec<Stretch>,
    pub holes: Vec<Vec<Stretch>>,
}

/// The face that contains a point (m): the smallest closed line of stretches round it.
pub(super) fn face(evaluation: &Evaluation, sheet: &Sheet, place: Vec2) -> Result<Face, EditError> {
    let mut graph = Graph::new(evaluation, sheet);
    graph.refuse_on_curve(sheet, place)?;
    graph.prune();
    let cycles = graph.cycles();
    let around = |cycle: &&Cycle| cycle.area > 0.0 && cycle.polygon.contains(place);
    let found = cycles.iter().filter(around);
    let Some(outer) = found.min_by(|a, b| a.area.total_cmp(&b.area)) else {
        return Err(impossible(
            "no closed line of curves goes round that place",
            "close the gap, or trace the panel by its corner points",
        ));
    };
    graph.refuse_crossing(evaluation, sheet, outer)?;
    let inside = |cycle: &Cycle, of: &Cycle| of.polygon.contains(cycle.inner);
    let own: Vec<&Cycle> = cycles
        .iter()
        .filter(|c| c.component != outer.component && inside(c, outer))
        .collect();
    let is_nested = |hole: &Cycle| {
        let mut others = own.iter();
        others.any(|c| c.component != hole.component && c.area > 0.0 && inside(hole, c))
    };
    let holes = own.iter().filter(|c| c.area < 0.0 && !is_nested(c));
    Ok(Face {
        outline: graph.walked(evaluation, sheet, outer),
        holes: holes
            .map(|hole| graph.walked(evaluation, sheet, hole))
            .collect(),
    })
}

/// A stretch of a curve between two neighbouring nodes on it.
struct Link {
    curve: CurveId,
    nodes: [usize; 2],
    /// Arc lengths along the curve at the start and the end of the link (m).
    along: [f64; 2],
    path: Path,
}

/// A walk round a face, with the face on its left, as a list of half-links. Half-link `2 k` is link `k`
/// walked forwards, half-link `2 k + 1` is the same link walked backwards.
struct Cycle {
    halves: Vec<usize>,
    /// Signed area of the walk (m2).
    area: f64,
    polygon: Polygon,
    /// A point on the walk (m).
    inner: Vec2,
    /// Number of the connected part of the graph that the walk belongs to.
    component: usize,
}

struct Graph {
    /// Points at which links meet, and their positions (m).
    nodes: Vec<(PointId, Vec2)>,
    links: Vec<Link>,
    /// Whether each link is walked. At first all are; `prune` leaves out those that bound no face.
    used: Vec<bool>,
}

impl Graph {
    fn new(evaluation: &Evaluation, sheet: &Sheet) -> Self {
        let mut graph = Self {
            nodes: Vec::new(),
            links: Vec::new(),
            used: Vec::new(),
        };
        for end in sheet.curves.iter().flat_map(|curve| curve.ends) {
            graph.node(evaluation, end);
        }
        for curve in &sheet.curves {
            graph.cut(evaluation, sheet, curve);
        }
        graph.used = vec![true; graph.links.len()];
        graph
    }

    /// The node at a point. Points at the same position share one node, named by the first of them.
    fn node(&mut self, evaluation: &Evaluation, point: PointId) -> Option<usize> {
        let at = evaluation.point(point)?;
        let known = self
            .nodes
            .iter()
            .position(|n| (n.1 - at).norm() <= ON_CURVE);
        Some(known.unwrap_or_else(|| {
            self.nodes.push((point, at));
            self.nodes.len() - 1
        }))
    }

    /// Divides a curve into links at the points on it.
    fn cut(&mut self, evaluation: &Evaluation, sheet: &Sheet, curve: &Curve) {
        let Some(path) = evaluation.curve(curve.id) else {
            return;
        };
        let bounds = bounds(path);
        let mut places: Vec<(f64, usize)> = Vec::new();
        for point in &sheet.points {
            let Some(at) = evaluation.point(point.id) else {
                continue;
            };
            if !bounds.contains(at) {
                continue;
            }
            let Some(along) = along(evaluation, curve, path, point) else {
                continue;
            };
            if let Some(node) = self.node(evaluation, point.id) {
                places.push((along, node));
                if curve.ends == [point.id; 2] {
                    places.push((path.length(), node));
                }
            }
        }
        places.sort_by(|a, b| a.0.total_cmp(&b.0));
        places.dedup_by(|b, a| a.1 == b.1 && b.0 - a.0 <= 2.0 * ON_CURVE);
        for pair in places.windows(2) {
            let [(from, start), (to, end)] = [pair[0], pair[1]];
            if to - from > ON_CURVE {
                self.links.push(Link {
                    curve: curve.id,
                    nodes: [start, end],
                    along: [from, to],
                    path: path.between(from, to),
                });
            }
        }
    }

    fn refuse_on_curve(&self, sheet: &Sheet, place: Vec2) -> Result<(), EditError> {
        let on = self.links.iter().find(|link| {
            let nearest = link.path.nearest(place);
            nearest.is_some_and(|near| (link.path.point(near) - place).norm() <= ON_CURVE)
        });
        match on {
            Some(link) => Err(impossible(
                format!("the place lies on curve {:?}", name(sheet, link.curve)),
                "choose a place inside",
            )),
            None => Ok(()),
        }
    }

    /// Refuses a face in which curves cross without a point at the crossing: such a crossing is no corner of
    /// a face, so the face that is meant may be smaller.
    fn refuse_crossing(
        &self,
        evaluation: &Evaluation,
        sheet: &Sheet,
        face: &Cycle,
    ) -> Result<(), EditError> {
        let reach = face.polygon.bounds().grown(2.0 * FLAT);
        let paths: Vec<(&Curve, &Arc<Path>, Bounds2)> = sheet
            .curves
            .iter()
            .filter_map(|curve| Some((&**curve, evaluation.curve(curve.id)?)))
            .map(|(curve, path)| (curve, path, bounds(path)))
            .filter(|(_, _, bounds)| bounds.meets(&reach))
            .collect();
        let on_outline = |at: Vec2| {
            let mut links = face.halves.iter().map(|h| &self.links[h / 2]);
            links.any(|link| {
                let near = link.path.nearest(at);
                near.is_some_and(|n| (link.path.point(n) - at).norm() <= ON_CURVE)
            })
        };
        for (k, (one, path, own)) in paths.iter().enumerate() {
            for (other, second, bounds) in &paths[k + 1..] {
                if !own.meets(bounds) {
                    continue;
                }
                let is_open = |at: Vec2| {
                    let mut nodes = self.nodes.iter();
                    !nodes.any(|n| (n.1 - at).norm() <= 2.0 * ON_CURVE)
                        && (face.polygon.contains(at) || on_outline(at))
                };
                if path.crossings(second).iter().any(|c| is_open(c.point)) {
                    return Err(impossible(
                        format!(
                            "curves {:?} and {:?} cross where there is no point",
                            one.name, other.name
                        ),
                        "put a point where they cross, or trace the panel by its corner points",
                    ));
                }
            }
        }
        Ok(())
    }

    /// Removes links that have the same face on both sides, such as loose lines and bridges between lines. No
    /// two faces are joined by this, so one pass is enough.
    fn prune(&mut self) {
        let mut face = vec![0_usize; 2 * self.links.len()];
        for (k, halves) in self.walk().iter().enumerate() {
            halves.iter().for_each(|&half| face[half] = k);
        }
        for (link, used) in self.used.iter_mut().enumerate() {
            *used = face[2 * link] != face[2 * link + 1];
        }
    }

    fn used_links(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.links.len()).filter(|&link| self.used[link])
    }

    fn start(&self, half: usize) -> usize {
        self.links[half / 2].nodes[half % 2]
    }

    fn end(&self, half: usize) -> usize {
        self.links[half / 2].nodes[1 - half % 2]
    }

    /// The half-links that leave each node, counter-clockwise.
    fn stars(&self) -> Vec<Vec<usize>> {
        let mut stars: Vec<Vec<usize>> = vec![Vec::new(); self.nodes.len()];
        for link in self.used_links() {
            for half in [2 * link, 2 * link + 1] {
                stars[self.start(half)].push(half);
            }
        }
        for (node, star) in stars.iter_mut().enumerate() {
            let lengths = star.iter().map(|half| self.links[half / 2].path.length());
            let reach = NEAR_NODE * lengths.fold(f64::INFINITY, f64::min);
            let angle = |half: usize| {
                let path = &self.links[half / 2].path;
                let along = match half % 2 {
                    0 => reach,
                    _ => path.length() - reach,
                };
                let away = path.at_length(along).map(|p| path.point(p));
                let way = away.map_or(Vec2::zeros(), |p| p - self.nodes[node].1);
                way.y.atan2(way.x)
            };
            star.sort_by(|&a, &b| angle(a).total_cmp(&angle(b)));
        }
        stars
    }

    /// The half-links round each face, in order.
    fn walk(&self) -> Vec<Vec<usize>> {
        let stars = self.stars();
        let next = |half: usize| {
            let star = &stars[self.end(half)];
            let back = star.iter().position(|&out| out == half ^ 1).unwrap_or(0);
            star[(back + star.len() - 1) % star.len()]
        };
        let mut seen = vec![false; 2 * self.links.len()];
        let mut faces = Vec::new();
        for start in self.used_links().flat_map(|link| [2 * link, 2 * link + 1]) {
            let mut halves = Vec::new();
            let mut half = start;
            while !seen[half] {
                seen[half] = true;
                halves.push(half);
                half = next(half);
            }
            if !halves.is_empty() {
                faces.push(halves);
            }
        }
        faces
    }

    fn cycles(&self) -> Vec<Cycle> {
        let components = self.components();
        let cycles = self.walk().into_iter().map(|halves| {
            let mut area = 0.0;
            let mut ring: Vec<Vec2> = Vec::new();
            for &half in &halves {
                let path = self.half_path(half);
                area += 0.5 * path.curves().iter().map(|c| c.swept_area()).sum::<f64>();
                ring.pop();
                ring.extend(path.flatten(FLAT));
            }
            ring.pop();
            let node = self.start(halves[0]);
            Cycle {
                halves,
                area,
                polygon: Polygon::new(ring),
                inner: self.nodes[node].1,
                component: components[node],
            }
        });
        cycles.collect()
    }

    /// For every node, the smallest node of its connected component.
    fn components(&self) -> Vec<usize> {
        let mut least: Vec<usize> = (0..self.nodes.len()).collect();
        let mut changed = true;
        while changed {
            changed = false;
            for link in self.used_links() {
                let [a, b] = self.links[link].nodes;
                let low = least[a].min(least[b]);
                changed |= least[a] != low || least[b] != low;
                (least[a], least[b]) = (low, low);
            }
        }
        least
    }

    fn half_path(&self, half: usize) -> Path {
        let path = &self.links[half / 2].path;
        match half % 2 {
            0 => path.clone(),
            _ => path.reversed(),
        }
    }

    /// The stretches round a face. Two links of one curve become one stretch unless other links meet them at
    /// their node.
    fn walked(&self, evaluation: &Evaluation, sheet: &Sheet, cycle: &Cycle) -> Vec<Stretch> {
        let stars = self.stars();
        let ends = |curve: CurveId| sheet.curve(curve).map(|curve| curve.ends);
        let goes_on = |before: usize, half: usize| {
            let (one, other) = (&self.links[before / 2], &self.links[half / 2]);
            let node = self.start(half);
            let mut nodes = ends(one.curve).into_iter().flatten();
            let is_end = nodes.any(|end| {
                let at = evaluation.point(end);
                at.is_some_and(|at| (at - self.nodes[node].1).norm() <= ON_CURVE)
            });
            one.curve == other.curve && before % 2 == half % 2 && stars[node].len() == 2 && !is_end
        };
        let halves = &cycle.halves;
        let count = halves.len();
        let first = (0..count).find(|&k| !goes_on(halves[(k + count - 1) % count], halves[k]));
        let mut found: Vec<Stretch> = Vec::new();
        let mut runs: Vec<Vec<usize>> = Vec::new();
        for k in 0..count {
            let half = halves[(first.unwrap_or(0) + k) % count];
            match runs.last_mut() {
                Some(run) if run.last().is_some_and(|&last| goes_on(last, half)) => run.push(half),
                _ => runs.push(vec![half]),
            }
        }
        for run in runs {
            let (Some(&head), Some(&tail)) = (run.first(), run.last()) else {
                continue;
            };
            let (one, last) = (&self.links[head / 2], &self.links[tail / 2]);
            let (from, to) = match head % 2 {
                0 => (one.along[0], last.along[1]),
                _ => (one.along[1], last.along[0]),
            };
            if let Some(path) = evaluation.curve(one.curve) {
                found.push(Stretch {
                    curve: one.curve,
                    ends: [self.nodes[self.start(head)].0, self.nodes[self.end(tail)].0],
                    path: Arc::new(path.between(from, to)),
                    is_reversed: head % 2 == 1,
                });
            }
        }
        found
    }
}

/// Bounding box of a path with some margin.
fn bounds(path: &Path) -> Bounds2 {
    Bounds2::of(path.flatten(FLAT)).grown(2.0 * FLAT)
}

fn name(sheet: &Sheet, curve: CurveId) -> &str {
    sheet.curve(curve).map_or("", |curve| &curve.name)
}
