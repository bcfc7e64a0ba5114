//! Samples along every edge: the same number on both sides of each seam, even if their lengths differ, with
//! intervals that grow gradually away from short ones.

use crate::edges::EdgeTable;
use crate::links::{Links, OrientedLinks};
use crate::seam_match::{Matching, Nodes, SeamChains};
use toile_pattern::Draft;

/// Largest growth of the interval length per metre of edge. Neighbouring intervals then differ by at most a
/// third, which keeps triangle angles over 25 degrees.
pub(crate) const GROWTH: f64 = 0.3;
/// Smallest interval on the short side of a gathered seam, relative to the edge length.
const MIN_GATHERED: f64 = 0.3;
/// Intervals shorter than this fraction of the edge length do not shorten their neighbours further: one tiny
/// edge must not fill a whole garment with tiny triangles.
const MIN_SPREAD: f64 = 0.15;

/// Two vertices to be sewn together: edge and sample on each side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct SampleStitch {
    pub draft_seam: usize,
    /// Edge and index of the sample, for both sides.
    pub samples: [(usize, usize); 2],
}

/// Samples of all edges and the stitches between them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sampling {
    /// Arc-length fractions of the samples on each edge, both ends included.
    pub fractions: Vec<Vec<f64>>,
    /// Indices of the samples on each edge that are nodes, the ends included.
    pub nodes: Vec<Vec<usize>>,
    /// Stitches, seam by seam in walking order.
    pub stitches: Vec<SampleStitch>,
}

/// The part of an edge between two neighbouring nodes.
struct Interval {
    edge: usize,
    nodes: [usize; 2],
    from: f64,
    to: f64,
    length: f64,
}

/// Intervals that are sewn together and therefore get the same samples.
struct Class {
    members: Vec<(usize, bool)>,
    /// Length for which the number of samples is computed (m).
    length: f64,
    /// Target interval (m), at equal steps along the class.
    size: Vec<f64>,
    /// Whether the class is sewn to itself in reverse, so that its samples must be symmetric.
    symmetric: bool,
}

/// Chooses the samples of all edges.
pub(crate) fn sample(
    draft: &Draft,
    table: &EdgeTable,
    matching: &Matching,
    spacing: f64,
) -> Sampling {
    let nodes = &matching.nodes;
    let (intervals, first) = intervals(table, nodes);
    let (mut links, partners) = link_intervals(matching, &first, intervals.len());
    let gathered = gathered_intervals(draft, &intervals, &partners);
    let mut classes = classes(table, &intervals, &mut links, &gathered, spacing);
    let groups = node_groups(table, nodes);
    grade(&mut classes, &intervals, &groups, spacing);
    let steps: Vec<Vec<f64>> = classes.iter().map(Class::places).collect();
    assemble(table, matching, &intervals, (&classes, &steps), &first)
}

fn intervals(table: &EdgeTable, nodes: &Nodes) -> (Vec<Interval>, Vec<usize>) {
    let mut intervals = Vec::new();
    let mut first = Vec::new();
    for (edge, list) in nodes.on_edge.iter().enumerate() {
        first.push(intervals.len());
        for pair in list.windows(2) {
            let [from, to] = [pair[0], pair[1]].map(|n| nodes.all[n].fraction);
            intervals.push(Interval {
                edge,
                nodes: [pair[0], pair[1]],
                from,
                to,
                length: (to - from) * table.edges[edge].length,
            });
        }
    }
    (intervals, first)
}

/// For consecutive stations on one side of a seam, the interval between them and whether it is walked
/// backwards; `None` if they do not span one interval.
fn spanned(
    nodes: &Nodes,
    first: &[usize],
    sewing: &SeamChains,
    side: usize,
) -> Vec<Option<(usize, bool)>> {
    let mut found = Vec::new();
    let index_on_edge = |node: usize| {
        let edge = nodes.all[node].edge;
        nodes.on_edge[edge].iter().position(|&n| n == node)
    };
    for pair in sewing.stations(nodes, side).windows(2) {
        let (Some(&from), Some(&to)) = (pair[0].nodes.last(), pair[1].nodes.first()) else {
            found.push(None);
            continue;
        };
        let edge = nodes.all[from].edge;
        found.push(match (index_on_edge(from), index_on_edge(to)) {
            (Some(i), Some(j)) if nodes.all[to].edge == edge && i.abs_diff(j) == 1 => {
                Some((first[edge] + i.min(j), i > j))
            }
            _ => None,
        });
    }
    found
}

/// Pairs of intervals that a seam sews together: the seam and both intervals.
type Partners = Vec<(usize, [usize; 2])>;

fn link_intervals(matching: &Matching, first: &[usize], count: usize) -> (OrientedLinks, Partners) {
    let mut links = OrientedLinks::new(count);
    let mut partners = Vec::new();
    for sewing in &matching.sewings {
        let sides = [0, 1].map(|side| spanned(&matching.nodes, first, sewing, side));
        for (a, b) in sides[0].iter().zip(&sides[1]) {
            if let (&Some((a, a_back)), &Some((b, b_back))) = (a, b) {
                links.join(a, b, a_back != b_back);
                partners.push((sewing.seam, [a, b]));
            }
        }
    }
    (links, partners)
}

fn gathered_intervals(draft: &Draft, intervals: &[Interval], partners: &Partners) -> Vec<bool> {
    let mut gathered = vec![false; intervals.len()];
    for &(seam, pair) in partners {
        if draft.seams[seam].gathered {
            for interval in pair {
                gathered[interval] = true;
            }
        }
    }
    gathered
}

fn classes(
    table: &EdgeTable,
    intervals: &[Interval],
    links: &mut OrientedLinks,
    gathered: &[bool],
    spacing: f64,
) -> Vec<Class> {
    let mut members: Vec<Vec<(usize, bool)>> = vec![Vec::new(); intervals.len()];
    for interval in 0..intervals.len() {
        let (root, reversed) = links.root(interval);
        members[root].push((interval, reversed));
    }
    let mut classes = Vec::new();
    for (root, members) in members.into_iter().enumerate() {
        if members.is_empty() {
            continue;
        }
        let lengths = members.iter().map(|m| intervals[m.0].length);
        let longest = lengths.clone().fold(0.0, f64::max);
        let shortest = lengths.clone().fold(f64::INFINITY, f64::min);
        let mean = lengths.sum::<f64>() / members.len() as f64;
        let length = if members.iter().any(|m| gathered[m.0]) {
            longest.min(shortest / MIN_GATHERED).max(mean)
        } else {
            mean
        };
        let steps = ((2.0 * longest / spacing).ceil()).clamp(4.0, 8000.0) as usize;
        let mut size = vec![spacing; steps + 1];
        for &(m, reversed) in &members {
            let interval = &intervals[m];
            for (k, size) in size.iter_mut().enumerate() {
                let along = k as f64 / steps as f64;
                let along = if reversed { 1.0 - along } else { along };
                let fraction = interval.from + along * (interval.to - interval.from);
                *size = size.min(table.edges[interval.edge].size_at(fraction));
            }
        }
        for size in &mut size {
            *size = size.min(length.max(1e-9));
        }
        classes.push(Class {
            members,
            length,
            size,
            symmetric: links.is_symmetric(root),
        });
    }
    classes
}

/// For each node, the group of nodes at the same corner of a piece.
fn node_groups(table: &EdgeTable, nodes: &Nodes) -> Vec<usize> {
    let mut links = Links::new(nodes.all.len());
    for (edge, list) in nodes.on_edge.iter().enumerate() {
        let next = &nodes.on_edge[table.edges[edge].next];
        if let (Some(&last), Some(&first)) = (list.last(), next.first()) {
            links.join(last, first);
        }
    }
    (0..nodes.all.len()).map(|n| links.root(n)).collect()
}

/// Limits the growth of the target interval along each class and round the corners of pieces. The interval of
/// a member is that of the class, scaled by the ratio of their lengths.
fn grade(classes: &mut [Class], intervals: &[Interval], groups: &[usize], spacing: f64) {
    let mut node_size = vec![f64::INFINITY; groups.len()];
    for _ in 0..100 {
        let mut changed = false;
        for class in classes.iter_mut() {
            let last = class.size.len() - 1;
            let ends = |reversed: bool| if reversed { [last, 0] } else { [0, last] };
            for &(m, reversed) in &class.members {
                let share = intervals[m].length / class.length;
                for (end, node) in ends(reversed).into_iter().zip(intervals[m].nodes) {
                    class.size[end] = class.size[end].min(node_size[groups[node]] / share);
                }
            }
            class.limit_growth();
            for &(m, reversed) in &class.members {
                let share = intervals[m].length / class.length;
                for (end, node) in ends(reversed).into_iter().zip(intervals[m].nodes) {
                    let known = &mut node_size[groups[node]];
                    let size = (class.size[end] * share).max(MIN_SPREAD * spacing);
                    if size < *known - 1e-12 {
                        *known = size;
                        changed = true;
                    }
                }
            }
        }
        if !changed {
            break;
        }
    }
}

impl Class {
    fn limit_growth(&mut self) {
        let last = self.size.len() - 1;
        if self.symmetric {
            for k in 0..=last / 2 {
                let least = self.size[k].min(self.size[last - k]);
                (self.size[k], self.size[last - k]) = (least, least);
            }
        }
        let growth = GROWTH * self.length / last as f64;
        for k in 1..=last {
            self.size[k] = self.size[k].min(self.size[k - 1] + growth);
        }
        for k in (0..last).rev() {
            self.size[k] = self.size[k].min(self.size[k + 1] + growth);
        }
    }

    /// Fractions of the samples of the class, both ends included: equal steps of the integral of one over the
    /// target interval.
    fn places(&self) -> Vec<f64> {
        let last = self.size.len() - 1;
        let step = self.length / last as f64;
        let mut total = vec![0.0];
        for k in 0..last {
            let density = 0.5 * (1.0 / self.size[k] + 1.0 / self.size[k + 1]);
            total.push(total[k] + density * step);
        }
        let wanted = total[last];
        let low = wanted.floor().max(1.0);
        // The number of intervals that brings their length nearest to the target, by ratio.
        let count = if wanted > (low * (low + 1.0)).sqrt() {
            low + 1.0
        } else {
            low
        };
        let mut places = vec![0.0];
        let mut k = 0;
        for i in 1..count as usize {
            let target = wanted * i as f64 / count;
            while k + 1 < last && total[k + 1] < target {
                k += 1;
            }
            let share = (target - total[k]) / (total[k + 1] - total[k]);
            places.push((k as f64 + share) / last as f64);
        }
        places.push(1.0);
        if self.symmetric {
            let mirrored: Vec<f64> = places.iter().rev().map(|p| 1.0 - p).collect();
            for (place, other) in places.iter_mut().zip(mirrored) {
                *place = 0.5 * (*place + other);
            }
        }
        places
    }
}

fn assemble(
    table: &EdgeTable,
    matching: &Matching,
    intervals: &[Interval],
    (classes, steps): (&[Class], &[Vec<f64>]),
    first: &[usize],
) -> Sampling {
    let mut class_of = vec![(0, false); intervals.len()];
    for (c, class) in classes.iter().enumerate() {
        for &(m, reversed) in &class.members {
            class_of[m] = (c, reversed);
        }
    }
    let mut fractions: Vec<Vec<f64>> = vec![vec![0.0]; table.edges.len()];
    let mut nodes: Vec<Vec<usize>> = vec![vec![0]; table.edges.len()];
    for (m, interval) in intervals.iter().enumerate() {
        let list = &mut fractions[interval.edge];
        let (c, reversed) = class_of[m];
        let count = steps[c].len() - 1;
        for k in 1..=count {
            let along = if reversed {
                1.0 - steps[c][count - k]
            } else {
                steps[c][k]
            };
            list.push(if k == count {
                interval.to
            } else {
                interval.from + along * (interval.to - interval.from)
            });
        }
        nodes[interval.edge].push(list.len() - 1);
    }
    let mut sampling = Sampling {
        fractions,
        nodes,
        stitches: Vec::new(),
    };
    sampling.stitch(matching, intervals, first);
    sampling
}

impl Sampling {
    /// Adds the stitches to given samples. Each edge must have as many nodes here as in the matching.
    pub fn sew(&mut self, table: &EdgeTable, matching: &Matching) {
        let (intervals, first) = intervals(table, &matching.nodes);
        self.stitch(matching, &intervals, &first);
    }

    fn stitch(&mut self, matching: &Matching, intervals: &[Interval], first: &[usize]) {
        for sewing in &matching.sewings {
            stitch(self, matching, sewing, first, intervals);
        }
    }
}

fn stitch(
    sampling: &mut Sampling,
    matching: &Matching,
    sewing: &SeamChains,
    first: &[usize],
    intervals: &[Interval],
) {
    let samples_of = |sampling: &Sampling, m: usize| {
        let edge = intervals[m].edge;
        // Interval m lies between this node of its edge and the next.
        let nodes = &sampling.nodes[edge][m - first[edge]..];
        (edge, nodes[0], nodes[1] - nodes[0])
    };
    let sides = [0, 1].map(|side| spanned(&matching.nodes, first, sewing, side));
    let mut previous: Option<[(usize, usize); 2]> = None;
    for (a, b) in sides[0].iter().zip(&sides[1]) {
        let (&Some(a), &Some(b)) = (a, b) else {
            continue;
        };
        let ends = [a, b].map(|(m, backward)| (samples_of(sampling, m), backward));
        let walk = |((edge, offset, count), backward): ((usize, usize, usize), bool), k: usize| {
            (edge, offset + if backward { count - k } else { k })
        };
        let count = ends[0].0.2.min(ends[1].0.2);
        for k in 0..=count {
            let samples = ends.map(|end| walk(end, k));
            // At a joint between two edges of a chain, both vertices of the joint are sewn to the other side,
            // so that merging makes them one vertex.
            if previous != Some(samples) {
                sampling.stitches.push(SampleStitch {
                    draft_seam: sewing.seam,
                    samples,
                });
            }
            previous = Some(samples);
        }
    }
}
