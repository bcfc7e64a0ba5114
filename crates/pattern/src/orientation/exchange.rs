//! Which spans of seams take the other copy of a pair, or the other half of a folded panel, so that
//! every piece shows its right side.
//!
//! A span on the other copy or half lies on the mirror image, so it runs the other way round its
//! cloth: each exchange turns a seam that would show a wrong side into one that does not, and back.
//! What must be exchanged together, and what a seam asks of its two sides, are links of one graph.

use super::colouring::{Colouring, Link};
use super::meetings::Meeting;
use crate::evaluate::SpanValue;
use crate::{EdgeName, PanelId};
use std::collections::BTreeMap;

/// Stretches that share less than this of their edge lie apart.
const APART: f64 = 1e-9;

/// What a cutter may lay in the place of what a span is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Twin {
    /// The other copy of a mirrored pair.
    Copy,
    /// The other half of a folded panel.
    Half,
}

impl Twin {
    /// A span on the other copy or half.
    pub fn of(self, span: &SpanValue) -> SpanValue {
        let mut twin = span.clone();
        match self {
            Self::Copy => twin.copy ^= 1,
            Self::Half => twin.half ^= 1,
        }
        twin
    }
}

/// A span of a seam.
pub(crate) struct SeamSpan<'a> {
    /// Number of its seam, and its side.
    pub seam: usize,
    pub side: usize,
    pub value: &'a SpanValue,
    pub twin: Option<Twin>,
}

/// Spans between which alone exchanges go: of one panel, of two copies or of two halves.
type Class = (PanelId, Twin, u32, u8);

impl SeamSpan<'_> {
    fn class(&self) -> Option<Class> {
        let value = self.value;
        Some(match self.twin? {
            Twin::Copy => (value.panel, Twin::Copy, value.copy / 2, value.half),
            Twin::Half => (value.panel, Twin::Half, value.copy, value.half / 2),
        })
    }

    /// Whether it is on the second of the two copies or halves.
    fn is_second(&self) -> bool {
        match self.twin {
            Some(Twin::Copy) => self.value.copy % 2 == 1,
            Some(Twin::Half) => self.value.half % 2 == 1,
            None => false,
        }
    }

    /// The span on the other copy or half.
    pub fn exchanged(&self) -> SpanValue {
        match self.twin {
            Some(twin) => twin.of(self.value),
            None => self.value.clone(),
        }
    }
}

/// What becomes of a span.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Taken {
    /// Whether it takes the other copy or half.
    pub exchanged: bool,
    /// Whether that sets a seam right: else two seams change places, and what is sewn stays the same.
    pub is_needed: bool,
}

/// Which spans are exchanged so that every seam is right; none where that cannot be, or need not.
/// `asked` are pairs of spans that lie across a seam, each with whether they turn a piece.
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

/// What makes one choice better than another, in this order: fewer exchanges, unless all of them change
/// places with others; of each seam, in the order of the document, fewer spans on second copies and halves;
/// fewer halves exchanged; first copies first.
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

/// Spans that are exchanged together or not at all.
struct Ties {
    links: Vec<[usize; 2]>,
    /// Whether each span may be exchanged.
    may_move: Vec<bool>,
    /// Whether each changes places with others if it is.
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
                // A half moves only to where a seam is that moves here: its piece stays where it is.
                ties.may_move[k] = met || *twin == Twin::Copy;
            }
            ties.tie_chains(spans, members);
        }
        // Spans of one chain move together, so none may move where one may not.
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

    /// Ties spans that would lie on each other's places. Of each span, whether another is there already,
    /// or would be: two on one place were meant for both copies or halves, and each goes its own way.
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

    /// Ties the spans of a panel within one side of a seam; and all of a copy whose other is not sewn
    /// at all, which takes its place as a whole.
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
