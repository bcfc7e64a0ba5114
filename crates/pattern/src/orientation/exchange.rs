//! Chooses the spans of seams that take the other copy of a pair, or the other half of a folded panel, so
//! that every piece shows its right side.
//!
//! The other copy or half is a mirror image, so a span on it runs the other way round its cloth. Each
//! exchange therefore turns a seam that would show a wrong side into one that does not, or the reverse. Spans
//! that must be exchanged together, and the demand of a seam on its two sides, are links of one graph.

use super::colouring::{Colouring, Link};
use super::meetings::Meeting;
use crate::evaluate::SpanValue;
use crate::{EdgeName, PanelId};
use std::collections::BTreeMap;

/// Overlaps shorter than this share of an edge are ignored (1).
const APART: f64 = 1e-9;

/// The mirror image of a piece of cloth that may be sewn instead of the piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Twin {
    /// The other copy of a mirrored pair.
    Copy,
    /// The other half of a folded panel.
    Half,
}

impl Twin {
    /// A span, moved to the other copy or half.
    pub fn of(self, span: &SpanValue) -> SpanValue {
        let mut twin = span.clone();
        match self {
            Self::Copy => twin.copy ^= 1,
            Self::Half => twin.half ^= 1,
        }
        twin
    }
}

/// A span of a seam, and the twin that it may be exchanged with.
pub(crate) struct SeamSpan<'a> {
    /// Index of the seam that the span belongs to.
    pub seam: usize,
    pub side: usize,
    pub value: &'a SpanValue,
    pub twin: Option<Twin>,
}

/// A class of spans that may be exchanged with each other: all are on one panel, on the same two copies or
/// two halves.
type Class = (PanelId, Twin, u32, u8);

impl SeamSpan<'_> {
    fn class(&self) -> Option<Class> {
        let value = self.value;
        Some(match self.twin? {
            Twin::Copy => (value.panel, Twin::Copy, value.copy / 2, value.half),
            Twin::Half => (value.panel, Twin::Half, value.copy, value.half / 2),
        })
    }

    /// Whether the span is on the second of its two copies or halves.
    fn is_second(&self) -> bool {
        match self.twin {
            Some(Twin::Copy) => self.value.copy % 2 == 1,
            Some(Twin::Half) => self.value.half % 2 == 1,
            None => false,
        }
    }

    /// The span moved to the other copy or half; unchanged if it has no twin.
    pub fn exchanged(&self) -> SpanValue {
        match self.twin {
            Some(twin) => twin.of(self.value),
            None => self.value.clone(),
        }
    }
}

/// The decision whether a span is exchanged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Taken {
    /// Whether the span is moved to the other copy or half.
    pub exchanged: bool,
    /// Whether the exchange corrects a seam; otherwise two seams only change places, and the sewn garment
    /// stays the same.
    pub is_needed: bool,
}

/// Chooses the spans to exchange so that no seam shows a wrong side. No span is exchanged if that is
/// impossible or not needed. `asked` are the pairs of spans that lie opposite each other in a seam, each with
/// whether one of the two shows its wrong side.
pub(crate) fn choose(spans: &[SeamSpan<'_>], asked: &[Meeting]) -> Vec<Taken> {
    let mut exchanged = vec![Taken::default(); spans.len()];
    if asked.iter().all(|meeting| !meeting.turns) {
        return exchanged;
    }
    let ties = Ties::new(spans);
    let mut links: Vec<Link> = ties.links.iter().copied().map(alike).collect();
    links.extend(asked.iter().map(|meeting| Link {
        nodes: meeting.spans,
        unlike: meeting.turns,
    }));
    let colouring = Colouring::new(spans.len(), &links);
    let mut members: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (k, &root) in colouring.root.iter().enumerate() {
        members.entry(root).or_default().push(k);
    }
    for (root, members) in members {
        if colouring.rings.contains_key(&root) {
            continue;
        }
        let one: Vec<bool> = members.iter().map(|&k| colouring.unlike[k]).collect();
        let other: Vec<bool> = one.iter().map(|&moved| !moved).collect();
        let turns = one.contains(&true);
        let swaps = members.iter().all(|&k| ties.swaps[k]);
        let moves_only_what_may = |moved: &Vec<bool>| {
            let mut taken = members.iter().zip(moved);
            taken.all(|(&k, &moved)| !moved || ties.may_move[k])
        };
        let choices = [one, other].into_iter().filter(moves_only_what_may);
        let best = choices.min_by_key(|moved| cost(spans, &members, (moved, swaps)));
        for (&k, moved) in members.iter().zip(best.unwrap_or_default()) {
            exchanged[k] = Taken {
                exchanged: moved,
                is_needed: moved && turns,
            };
        }
    }
    exchanged
}

fn alike(nodes: [usize; 2]) -> Link {
    Link {
        nodes,
        unlike: false,
    }
}

/// Cost of a choice; earlier items decide first. They are: number of exchanges, or 0 if all of them are swaps
/// of two spans; for each seam, in the order of the document, number of spans on second copies and halves;
/// number of exchanged halves; for each span, whether it is then on a second copy or half, so that early
/// spans are on first copies.
type Cost = (usize, Vec<usize>, usize, Vec<bool>);

fn cost(spans: &[SeamSpan<'_>], members: &[usize], (moved, swaps): (&[bool], bool)) -> Cost {
    let taken = members.iter().zip(moved);
    let count = |chosen: &dyn Fn(&SeamSpan<'_>) -> bool| {
        let moves = taken
            .clone()
            .filter(|&(&k, &moved)| moved && chosen(&spans[k]));
        moves.count()
    };
    let mut second_of_seam: BTreeMap<usize, usize> = BTreeMap::new();
    let mut second = Vec::with_capacity(members.len());
    for (&k, &moved) in taken.clone() {
        let is_second = spans[k].is_second() != moved;
        *second_of_seam.entry(spans[k].seam).or_default() += usize::from(is_second);
        second.push(is_second);
    }
    (
        if swaps { 0 } else { count(&|_| true) },
        second_of_seam.into_values().collect(),
        count(&|span| span.twin == Some(Twin::Half)),
        second,
    )
}

/// Constraints: links between spans that must be exchanged together or not at all.
struct Ties {
    links: Vec<[usize; 2]>,
    /// Whether each span may be exchanged.
    may_move: Vec<bool>,
    /// Whether each span, if it is exchanged, changes places with another span.
    swaps: Vec<bool>,
}

impl Ties {
    fn new(spans: &[SeamSpan<'_>]) -> Self {
        let mut ties = Self {
            links: Vec::new(),
            may_move: vec![false; spans.len()],
            swaps: vec![false; spans.len()],
        };
        let mut classes: BTreeMap<Class, Vec<usize>> = BTreeMap::new();
        for (k, span) in spans.iter().enumerate() {
            if let Some(class) = span.class() {
                classes.entry(class).or_default().push(k);
            }
        }
        for ((_, twin, ..), members) in &classes {
            let met = ties.tie_places(spans, members);
            for (&k, met) in members.iter().zip(met) {
                // A half is exchanged only if another seam lies on its stretch, since the piece itself stays
                // in place.
                ties.may_move[k] = met || *twin == Twin::Copy;
            }
            ties.tie_chains(spans, members);
        }
        // Linked spans move together: if one of them may not move, none of them may.
        let links: Vec<Link> = ties.links.iter().map(|&nodes| alike(nodes)).collect();
        let groups = Colouring::new(spans.len(), &links).root;
        let held: Vec<usize> = (0..spans.len())
            .filter(|&k| !ties.may_move[k])
            .map(|k| groups[k])
            .collect();
        for (k, group) in groups.iter().enumerate() {
            ties.may_move[k] &= !held.contains(group);
        }
        ties
    }

    /// Links spans that lie on the same stretch of the two copies or halves: they change places with each
    /// other. Spans on the same stretch of one copy are not linked, as they were meant for both copies or
    /// halves. Returns for each span whether another span lies on its stretch, on either copy or half.
    fn tie_places(&mut self, spans: &[SeamSpan<'_>], members: &[usize]) -> Vec<bool> {
        let mut met = vec![false; members.len()];
        let mut places: BTreeMap<EdgeName, Vec<(f64, f64, usize)>> = BTreeMap::new();
        for (index, &k) in members.iter().enumerate() {
            for &(name, from, to) in &spans[k].value.stretch {
                let here = places.entry(name).or_default();
                let (low, high) = (from.min(to), from.max(to));
                for &(known_low, known_high, other) in &*here {
                    if other == index || high.min(known_high) - low.max(known_low) < APART {
                        continue;
                    }
                    met[index] = true;
                    met[other] = true;
                    let pair = [members[other], k];
                    if spans[pair[0]].is_second() != spans[pair[1]].is_second() {
                        self.links.push(pair);
                        self.swaps[pair[0]] = true;
                        self.swaps[pair[1]] = true;
                    }
                }
                here.push((low, high, index));
            }
        }
        met
    }

    /// Links the spans of a panel within one side of a seam. If only one copy of a pair is sewn, links all
    /// spans on it, so that they move to the other copy together or not at all.
    fn tie_chains(&mut self, spans: &[SeamSpan<'_>], members: &[usize]) {
        let is_whole = members
            .windows(2)
            .all(|pair| spans[pair[0]].is_second() == spans[pair[1]].is_second());
        for pair in members.windows(2) {
            let [one, two] = [&spans[pair[0]], &spans[pair[1]]];
            let is_chain = (one.seam, one.side) == (two.seam, two.side);
            if is_chain || is_whole && one.twin == Some(Twin::Copy) {
                self.links.push([pair[0], pair[1]]);
            }
        }
    }
}
