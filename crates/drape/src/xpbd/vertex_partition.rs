//! The order of vertices in memory, cut into partitions whose constraints several cores solve at once.
//!
//! Vertices are sorted so that neighbours lie close (reverse Cuthill-McKee), and the sorted list is cut
//! into domains. A constraint between vertices of one domain is solved with that domain. A constraint
//! across the cut between two domains is solved in a second round, over ranges shifted by half a domain.
//! A constraint that fits neither, such as an elastic across the garment, belongs to the global
//! partition, which one core solves last. A sweep therefore has two barriers however many colours the
//! constraints would need, and each core works on a slice of the vertices of its own.

use crate::System;
use crate::lanes::LANES;

/// Least number of vertices of a domain: two cores have two domains each in a sheet of 10,000 vertices.
const DOMAIN: usize = 2500;

/// Most domains.
const MAX_DOMAINS: usize = 64;

/// Slots of the vertices and cuts of the domains.
#[derive(Clone, Debug, Default)]
pub struct VertexPartition {
    /// Slot of each vertex.
    pub slot_of: Vec<u32>,
    /// Vertex in each slot; none in the first slot of each half domain, a fixed point to which unused lanes refer,
    /// and in the slots that pad its last block.
    pub vertex_of: Vec<Option<u32>>,
    /// First slot of each half domain, and the end.
    pub halves: Vec<usize>,
}

/// The partition that solves a constraint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Partition {
    /// All its vertices lie in one domain.
    Domain(usize),
    /// Its vertices lie on both sides of the cut after a domain, at most half a domain away.
    Cut(usize),
    /// Its vertices lie farther apart; solved last, by one core.
    Global,
}

impl VertexPartition {
    /// Sorts and cuts the vertices of a model.
    pub fn new(system: &System) -> Self {
        let sorted = cuthill_mckee(system);
        let count = sorted.len();
        let domains = (count / DOMAIN).clamp(1, MAX_DOMAINS);
        let halves = 2 * domains;
        let mut partition = Self {
            slot_of: vec![0; count],
            ..Self::default()
        };
        for half in 0..halves {
            partition.halves.push(partition.vertex_of.len());
            partition.vertex_of.push(None);
            for &v in &sorted[half * count / halves..(half + 1) * count / halves] {
                partition.slot_of[v as usize] = partition.vertex_of.len() as u32;
                partition.vertex_of.push(Some(v));
            }
            // Halves are whole blocks of lanes.
            let padded = partition.vertex_of.len().next_multiple_of(LANES);
            partition.vertex_of.resize(padded, None);
        }
        partition.halves.push(partition.vertex_of.len());
        partition
    }

    /// Number of domains.
    pub fn domains(&self) -> usize {
        self.halves.len() / 2
    }

    /// Number of slots.
    pub fn len(&self) -> usize {
        self.vertex_of.len()
    }

    /// First slot of each domain, and the end.
    pub fn domain_starts(&self) -> Vec<usize> {
        self.halves.iter().copied().step_by(2).collect()
    }

    /// First slot of each range of vertices whose contacts with solids one task solves, and the end: halves of
    /// domains, or all vertices in one range where there are few.
    pub fn contact_starts(&self) -> Vec<usize> {
        match self.len() < DOMAIN {
            true => self.domain_starts(),
            false => self.halves.clone(),
        }
    }

    /// First slot of each range about a cut, and the end; empty with one domain.
    pub fn cut_starts(&self) -> Vec<usize> {
        if self.domains() == 1 {
            return Vec::new();
        }
        self.halves.iter().copied().skip(1).step_by(2).collect()
    }

    /// The partition that solves a constraint on some vertices.
    pub fn partition_of(&self, vertices: &[u32]) -> Partition {
        let slots = vertices.iter().map(|&v| self.slot_of[v as usize]);
        match (slots.clone().min(), slots.max()) {
            (Some(low), Some(high)) => self.partition_between(low as usize, high as usize),
            _ => Partition::Global,
        }
    }

    /// The partition that solves a constraint on the vertices in some slots.
    pub fn partition_of_slots(&self, slots: [u32; 4]) -> Partition {
        let [low, high] = [slots.iter().min(), slots.iter().max()];
        let slot = |end: Option<&u32>| end.map_or(0, |&slot| slot as usize);
        self.partition_between(slot(low), slot(high))
    }

    /// The partition that solves a constraint whose lowest and highest slots are given.
    fn partition_between(&self, low: usize, high: usize) -> Partition {
        let half = |slot: usize| self.halves.partition_point(|&start| start <= slot) - 1;
        let (low, high) = (half(low), half(high));
        if low / 2 == high / 2 {
            Partition::Domain(low / 2)
        } else if low % 2 == 1 && high == low + 1 {
            Partition::Cut(low / 2)
        } else {
            Partition::Global
        }
    }

    /// All partitions in the order in which they are solved.
    pub fn partitions(&self) -> impl Iterator<Item = Partition> + use<> {
        let count = self.domains();
        (0..count)
            .map(Partition::Domain)
            .chain((0..count - 1).map(Partition::Cut))
            .chain(std::iter::once(Partition::Global))
    }

    /// The index of a partition in that order.
    pub fn index_of(&self, partition: Partition) -> usize {
        match partition {
            Partition::Domain(d) => d,
            Partition::Cut(d) => self.domains() + d,
            Partition::Global => 2 * self.domains() - 1,
        }
    }

    /// First slot of the range of vertices that the constraints of a partition move.
    pub fn start(&self, partition: Partition) -> usize {
        match partition {
            Partition::Domain(d) => self.halves[2 * d],
            Partition::Cut(d) => self.halves[2 * d + 1],
            Partition::Global => 0,
        }
    }
}

/// Vertices in reverse Cuthill-McKee order over triangles and elastics (Cuthill and McKee 1969):
/// breadth first from a vertex at the rim, neighbours by their number of neighbours.
fn cuthill_mckee(system: &System) -> Vec<u32> {
    let count = system.vertex_count();
    let mut pairs: Vec<(u32, u32)> = Vec::new();
    for &[a, b, c] in &system.topology.triangles {
        pairs.extend([(a, b), (b, a), (b, c), (c, b), (c, a), (a, c)]);
    }
    for [from, to] in system.couplings.ends() {
        pairs.extend([(from, to), (to, from)]);
    }
    pairs.sort_unstable();
    pairs.dedup();
    let start = |v: u32| pairs.partition_point(|&(from, _)| from < v);
    let starts: Vec<usize> = (0..=count as u32).map(start).collect();
    let neighbours = |v: u32| &pairs[starts[v as usize]..starts[v as usize + 1]];
    let mut sorted = Vec::with_capacity(count);
    let mut seen = vec![false; count];
    let mut front = Vec::new();
    for seed in 0..count as u32 {
        if seen[seed as usize] {
            continue;
        }
        // The last vertex of a search lies far away from the seed: a good end to start from.
        let mut far = seed;
        for _ in 0..2 {
            let first = sorted.len();
            search(far, neighbours, &mut seen, &mut sorted, &mut front);
            far = sorted[sorted.len() - 1];
            for &v in &sorted[first..] {
                seen[v as usize] = false;
            }
            sorted.truncate(first);
        }
        search(far, neighbours, &mut seen, &mut sorted, &mut front);
    }
    sorted.reverse();
    sorted
}

fn search<'a>(
    from: u32,
    neighbours: impl Fn(u32) -> &'a [(u32, u32)],
    seen: &mut [bool],
    sorted: &mut Vec<u32>,
    next: &mut Vec<u32>,
) {
    let mut at = sorted.len();
    sorted.push(from);
    seen[from as usize] = true;
    while at < sorted.len() {
        next.clear();
        for &(_, v) in neighbours(sorted[at]) {
            if !seen[v as usize] {
                seen[v as usize] = true;
                next.push(v);
            }
        }
        next.sort_by_key(|&v| (neighbours(v).len(), v));
        sorted.extend_from_slice(next);
        at += 1;
    }
}

/// Sorts constraints into batches of at most `size` of one kind without a shared vertex: greedy
/// colouring in the order given, then each colour cut into batches. Returns lists of indices.
pub fn batches<'a>(
    count: usize,
    size: usize,
    vertices: impl Fn(usize) -> &'a [u32],
    kind: impl Fn(usize) -> usize,
) -> Vec<Vec<usize>> {
    let mut used: std::collections::BTreeMap<u32, u128> = std::collections::BTreeMap::new();
    let mut coloured: Vec<(u32, usize, usize)> = Vec::with_capacity(count);
    for index in 0..count {
        let taken = vertices(index)
            .iter()
            .fold(0u128, |all, v| all | used.get(v).copied().unwrap_or(0));
        let colour = taken.trailing_ones();
        // Beyond 128 colours each constraint is a colour of its own.
        let colour = if colour < 128 {
            for &v in vertices(index) {
                *used.entry(v).or_default() |= 1 << colour;
            }
            colour
        } else {
            128 + index as u32
        };
        coloured.push((colour, kind(index), index));
    }
    coloured.sort_unstable();
    let mut batches: Vec<Vec<usize>> = Vec::new();
    let mut last = None;
    for (colour, kind, index) in coloured {
        match batches.last_mut() {
            Some(batch) if last == Some((colour, kind)) && batch.len() < size => batch.push(index),
            _ => batches.push(vec![index]),
        }
        last = Some((colour, kind));
    }
    batches
}
