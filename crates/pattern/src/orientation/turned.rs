//! Pieces that their seams turn inside out.

use super::colouring::{Colouring, Link};
use super::meetings::{SidePart, meetings};
use super::words::{ring_words, turned_words};
use crate::{Diagnostic, Draft, DraftSpan, SeamOrigin};
use std::collections::{BTreeMap, BTreeSet};

/// Two pieces that a seam joins, and how the seam turns them.
struct Joined {
    /// Index of the seam in the draft.
    seam: usize,
    /// Indices of the pieces in the draft.
    pieces: [usize; 2],
    /// Whether one of the pieces shows its wrong side when the other shows its right side.
    opposite: bool,
    /// Whether the seam is sewn with right sides together, so that a piece showing its wrong side is a
    /// mistake.
    is_fault: bool,
}

/// Diagnostics for pieces that show their wrong side, and for rings of pieces that cannot all show their
/// right side, as a Moebius band.
pub(crate) fn turned_pieces(draft: &Draft) -> Vec<Diagnostic> {
    let joined = joined(draft);
    let mut found = Vec::new();
    if joined.iter().all(|joined| !joined.opposite) {
        return found;
    }
    let count = draft.pieces.len();
    let as_laid = Colouring::new(count, &links(&joined, |joined| joined.opposite));
    for ring in as_laid.rings.values() {
        let seams: BTreeSet<usize> = ring.iter().map(|&k| joined[k].seam).collect();
        let pieces: BTreeSet<usize> = ring.iter().flat_map(|&k| joined[k].pieces).collect();
        found.push(ring_words(draft, &pieces, seams));
    }
    let as_meant = Colouring::new(count, &links(&joined, |joined| joined.is_fault));
    let mut faults: BTreeMap<usize, Vec<&Joined>> = BTreeMap::new();
    for joined in joined.iter().filter(|joined| joined.is_fault) {
        let root = as_laid.root[joined.pieces[0]];
        faults.entry(root).or_default().push(joined);
    }
    for (root, faults) in faults {
        if as_laid.rings.contains_key(&root) {
            continue;
        }
        // A seam that shows a wrong side on purpose is not counted as a fault of a piece, unless other seams
        // contradict it.
        let colouring = match as_meant.rings.contains_key(&root) {
            true => &as_laid,
            false => &as_meant,
        };
        let members = (0..count).filter(|&k| colouring.root[k] == root);
        let (unlike, like): (Vec<usize>, Vec<usize>) = members.partition(|&k| colouring.unlike[k]);
        let turned = match smaller(draft, &unlike, &like) {
            true => unlike,
            false => like,
        };
        for piece in turned {
            let own = faults
                .iter()
                .filter(|joined| joined.pieces.contains(&piece));
            let seams: BTreeSet<usize> = own.map(|joined| joined.seam).collect();
            if !seams.is_empty() {
                found.push(turned_words(draft, piece, seams));
            }
        }
    }
    found
}

/// All pairs of pieces that meet along seams of the document. Seams of darts are left out: the two legs of a
/// dart always run in opposite directions.
fn joined(draft: &Draft) -> Vec<Joined> {
    let mut all = Vec::new();
    for (index, seam) in draft.seams.iter().enumerate() {
        if !matches!(seam.id, SeamOrigin::Seam(_)) {
            continue;
        }
        let [first, second] = [0, 1].map(|side| parts(draft, &seam.sides[side]));
        let of = |side: &[(usize, SidePart)]| side.iter().map(|part| part.1).collect::<Vec<_>>();
        for meeting in meetings([&of(&first), &of(&second)]) {
            let [i, j] = meeting.spans;
            all.push(Joined {
                seam: index,
                pieces: [first[i].0, second[j].0],
                opposite: meeting.turns,
                is_fault: meeting.turns && seam.right_sides_together,
            });
        }
    }
    all
}

/// The parts of a side of a seam: each is on one piece and runs one way round it.
fn parts(draft: &Draft, side: &[DraftSpan]) -> Vec<(usize, SidePart)> {
    let is_one =
        |a: &DraftSpan, b: &DraftSpan| a.piece == b.piece && (a.to > a.from) == (b.to > b.from);
    side.chunk_by(is_one)
        .filter_map(|spans| Some((spans[0].piece, SidePart::of(draft, spans)?)))
        .collect()
}

fn links(joined: &[Joined], unlike: impl Fn(&Joined) -> bool) -> Vec<Link> {
    let link = |joined: &Joined| Link {
        nodes: joined.pieces,
        unlike: unlike(joined),
    };
    joined.iter().map(link).collect()
}

/// Whether the pieces `some` are to be reported, not the pieces `others`. The fewer pieces are; if both are
/// equally many, those with less cloth; if that is equal too, those that come later.
fn smaller(draft: &Draft, some: &[usize], others: &[usize]) -> bool {
    let cloth = |pieces: &[usize]| -> f64 {
        let edges = pieces.iter().flat_map(|&k| &draft.pieces[k].outline);
        edges.map(|edge| edge.curve.swept_area()).sum::<f64>().abs()
    };
    let order = some.len().cmp(&others.len());
    let order = order.then_with(|| cloth(some).total_cmp(&cloth(others)));
    order.then_with(|| others.cmp(some)).is_lt()
}
