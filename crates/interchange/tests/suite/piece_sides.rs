//! Pieces show their right side: copies and halves that are written the wrong way round are exchanged in
//! the draft, what cannot be set right is named, and of what is right nothing is said.

mod stacked;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;
use toile_interchange::read_pattern;
use toile_pattern::{
    Code, Diagnostic, Draft, DraftSpan, Evaluation, PanelId, Pattern, Severity, Span, Wearer,
};

/// A pattern that ships.
fn shipped(name: &str) -> Pattern {
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../../patterns/{name}.toile.json"));
    read_pattern(&std::fs::read_to_string(path).unwrap())
        .unwrap()
        .0
}

/// The draft of the base size, and what is told of the sides of its pieces.
fn drafted(pattern: &Pattern) -> (Draft, Vec<Diagnostic>) {
    let evaluation = Evaluation::new(pattern, Wearer::default());
    (evaluation.draft().0, evaluation.check_sides())
}

/// Where a span is: its seam, its side, and its place there.
type At = (usize, usize, usize);

/// Spans of pairs in groups that lie on one stretch of one panel, both copies of it; those of one side of
/// a seam go together.
fn pair_stretches(pattern: &Pattern) -> Vec<Vec<At>> {
    let mut groups: BTreeMap<(PanelId, String), Vec<At>> = BTreeMap::new();
    for (k, seam) in pattern.seams.iter().enumerate() {
        for (side, spans) in seam.sides.iter().enumerate() {
            let words = |span: &Span| {
                let mut ends = [format!("{:?}", span.from), format!("{:?}", span.to)];
                ends.sort();
                ends.concat()
            };
            let first = &spans[0];
            let panel = pattern.panel(first.panel).unwrap();
            if panel.cut.mirrored && spans.iter().all(|span| span.panel == first.panel) {
                let stretch: String = spans.iter().map(words).collect();
                let own = groups.entry((first.panel, stretch)).or_default();
                own.extend((0..spans.len()).map(|n| (k, side, n)));
            }
        }
    }
    groups.into_values().collect()
}

/// The pattern with spans on the other copy of their panels.
fn exchanged(pattern: &Pattern, spans: impl IntoIterator<Item = At>) -> Pattern {
    let mut pattern = pattern.clone();
    for (seam, side, n) in spans {
        Arc::make_mut(&mut pattern.seams[seam]).sides[side][n].copy ^= 1;
    }
    pattern
}

/// Where a span is: its piece, edge and ends.
type Place = (usize, usize, u64, u64);

/// Seams as sets: which side is the first, from which end both are walked and which seam comes first does
/// not count.
fn sewn(draft: &Draft) -> BTreeSet<[Vec<Place>; 2]> {
    let ahead = |spans: &[DraftSpan]| {
        let span = |s: &DraftSpan| (s.piece, s.edge, s.from.to_bits(), s.to.to_bits());
        spans.iter().map(span).collect::<Vec<_>>()
    };
    let back = |spans: &[DraftSpan]| {
        let span = |s: &DraftSpan| (s.piece, s.edge, s.to.to_bits(), s.from.to_bits());
        spans.iter().rev().map(span).collect::<Vec<_>>()
    };
    let seams = draft.seams.iter().map(|seam| {
        let [one, two] = [&seam.sides[0], &seam.sides[1]];
        let mut ways = [[ahead(one), ahead(two)], [back(one), back(two)]];
        ways.iter_mut().for_each(|sides| sides.sort());
        ways.into_iter().min().unwrap()
    });
    seams.collect()
}

/// A stretch of a panel: the panel and the share of an edge that it covers [1e-9].
type Stretch = (PanelId, i64);

/// Which stretches of which panels are sewn to which, whatever copies they are on: where a chain went to
/// the other copies as a whole, the same is sewn of their mirror images.
fn joined(draft: &Draft) -> Vec<[Vec<Stretch>; 2]> {
    let side = |spans: &Vec<DraftSpan>| {
        let stretch = |span: &DraftSpan| {
            let share = ((span.to - span.from).abs() * 1e9).round() as i64;
            (draft.pieces[span.piece].id.panel, share)
        };
        let mut all: Vec<Stretch> = spans.iter().map(stretch).collect();
        all.sort();
        all
    };
    let mut seams: Vec<[Vec<Stretch>; 2]> = draft
        .seams
        .iter()
        .map(|seam| {
            let mut sides = [side(&seam.sides[0]), side(&seam.sides[1])];
            sides.sort();
            sides
        })
        .collect();
    seams.sort();
    seams
}

#[test]
fn of_patterns_that_are_right_nothing_is_said() {
    for name in ["t-shirt", "trousers", "dress", "gathered-skirt", "poncho"] {
        let pattern = shipped(name);
        for size in &pattern.sizes {
            let evaluation = Evaluation::new(&pattern, &**size);
            assert_eq!(evaluation.check_sides(), [], "{name}");
        }
    }
}

#[test]
fn copies_of_pairs_written_the_wrong_way_round_are_exchanged() {
    let mut exact = 0;
    for (name, stretches) in [("t-shirt", 4), ("trousers", 8), ("dress", 7)] {
        let pattern = shipped(name);
        let (right, _) = drafted(&pattern);
        let groups = pair_stretches(&pattern);
        assert_eq!(groups.len(), stretches, "{name}");
        for choice in 0..1_usize << groups.len() {
            let chosen = (0..groups.len()).filter(|k| choice >> k & 1 == 1);
            let moved: BTreeSet<At> = chosen.flat_map(|k| groups[k].clone()).collect();
            let (draft, told) = drafted(&exchanged(&pattern, moved.iter().copied()));
            let case = format!("{name}, choice {choice}");
            assert!(
                told.iter().all(|found| found.code == Code::OtherCopy),
                "{case}: {told:?}"
            );
            assert_eq!(sewn(&draft), sewn(&right), "{case}");
            // Where both sides of each seam were exchanged it is right as it is, and sews what its twin did.
            if told.is_empty() {
                continue;
            }
            exact += 1;
            assert_eq!(draft.seams, right.seams, "{case}");
            assert_eq!(draft.pieces, right.pieces, "{case}");
        }
    }
    assert!(exact > 100, "{exact}");
}

#[test]
fn a_seam_written_on_a_copy_that_another_has_takes_the_free_one() {
    for name in ["t-shirt", "trousers", "dress"] {
        let pattern = shipped(name);
        let (right, _) = drafted(&pattern);
        for (k, seam) in pattern.seams.iter().enumerate() {
            for side in 0..2 {
                let spans = &seam.sides[side];
                let is_pair = |span: &Span| pattern.panel(span.panel).unwrap().cut.mirrored;
                if !spans.iter().all(is_pair) {
                    continue;
                }
                let spans = (0..spans.len()).map(|n| (k, side, n));
                let (draft, told) = drafted(&exchanged(&pattern, spans));
                assert!(
                    !told.is_empty() && told.iter().all(|found| found.code == Code::OtherCopy),
                    "{name}, seam {:?}: {told:?}",
                    seam.name
                );
                assert_eq!(draft.seams, right.seams, "{name}, seam {:?}", seam.name);
            }
        }
    }
}

#[test]
fn halves_of_a_fold_are_exchanged_too() {
    let pattern = shipped("gathered-skirt");
    let (right, _) = drafted(&pattern);
    let mut turned = pattern.clone();
    for name in ["left side", "right side"] {
        let seam = turned.seams.iter_mut().find(|seam| seam.name == name);
        Arc::make_mut(seam.unwrap()).sides[1][0].half ^= 1;
    }
    let gathers = turned
        .seams
        .iter_mut()
        .find(|seam| seam.name == "front gathers");
    for span in &mut Arc::make_mut(gathers.unwrap()).sides[0] {
        span.half ^= 1;
    }
    let (draft, told) = drafted(&turned);
    assert_eq!(draft.seams, right.seams);
    let words: Vec<&str> = told.iter().map(|found| found.message.as_str()).collect();
    assert_eq!(
        words,
        [
            "seam \"front gathers\" takes the other half of panel \"front\" than is written: so every \
             piece shows its right side",
            "seams \"left side\" and \"right side\" take the other half of panel \"back\" than is \
             written: so every piece shows its right side",
        ]
    );
}

#[test]
fn a_piece_that_no_exchange_sets_right_is_named() {
    // Both backs are cut alike: one of them can only show its wrong side.
    let mut pattern = shipped("dress");
    for panel in pattern
        .panels
        .iter_mut()
        .filter(|panel| panel.name == "back skirt")
    {
        Arc::make_mut(panel).cut.mirrored = false;
    }
    let (_, told) = drafted(&pattern);
    let [found] = &told[..] else {
        panic!("{told:?}");
    };
    assert_eq!(
        (found.severity, found.code),
        (Severity::Warning, Code::InsideOut)
    );
    assert!(
        found.message.contains("\"back skirt 2\""),
        "{}",
        found.message
    );
    assert!(
        found.message.contains("\"right skirt side\""),
        "{}",
        found.message
    );
    // Where that is meant, the seams say so.
    for seam in &mut pattern.seams {
        let names = ["right skirt side", "right back waist", "skirt back centre"];
        Arc::make_mut(seam).right_sides_together = !names.contains(&seam.name.as_str());
    }
    assert_eq!(drafted(&pattern).1, []);
}

#[test]
fn a_ring_with_a_half_turn_is_refused_by_name() {
    let mut pattern = shipped("gathered-skirt");
    let seam = pattern
        .seams
        .iter_mut()
        .find(|seam| seam.name == "left band");
    let side = &mut Arc::make_mut(seam.unwrap()).sides[1];
    side[0] = side[0].clone().reversed();
    let (_, told) = drafted(&pattern);
    let [found] = &told[..] else {
        panic!("{told:?}");
    };
    assert_eq!(
        (found.severity, found.code),
        (Severity::Error, Code::InsideOut)
    );
    for name in [
        "\"band front\"",
        "\"band back\"",
        "\"left band\"",
        "\"right band\"",
    ] {
        assert!(found.message.contains(name), "{}", found.message);
    }
}

#[test]
fn of_random_garments_of_pairs_and_folds_nothing_is_said_and_wrong_ones_are_set_right() {
    for seed in 0..200 {
        let garment = stacked::Stacked::new(seed);
        let (right, told) = drafted(&garment.pattern());
        assert_eq!(told, [], "seed {seed}");
        assert!(right.pieces.iter().all(|piece| piece.sewn), "seed {seed}");
        // One stretch written on the other copy or half, as by a newcomer's clicks.
        let wrong = garment.with_one_exchange();
        let (draft, told) = drafted(&wrong);
        assert_eq!(
            sewn(&draft).len(),
            sewn(&right).len(),
            "seed {seed}: {told:?}"
        );
        assert_eq!(joined(&draft), joined(&right), "seed {seed}: {told:?}");
        assert!(
            !told.is_empty() && told.iter().all(|found| found.code == Code::OtherCopy),
            "seed {seed}: {told:?}"
        );
    }
}
