//! Seams between chains of edges.

use super::*;
use crate::sample::{alter, dart, edge, fold, put_operation, sample};
use toile_pattern::plan::{SeamSide, SewnEdge};

fn sewn(pattern: &Pattern, panel: &str, edge_name: &str) -> SewnEdge {
    SewnEdge {
        panel: pattern.panel_named(panel).unwrap().id,
        copy: 0,
        half: 0,
        edge: edge(pattern, panel, edge_name),
    }
}

/// The sample without its seams.
fn unsewn() -> Pattern {
    let mut pattern = sample();
    pattern.seams.clear();
    pattern
}

/// Start and end of both sides of the only seam but for darts, and the lengths of the sides (m).
fn sides(pattern: &Pattern, body: &Measurements) -> [(Vec2, Vec2, f64); 2] {
    let (draft, found) = pattern.resolve(body);
    assert!(
        found.iter().all(|d| d.severity < Severity::Error),
        "{found:?}"
    );
    [0, 1].map(|side| {
        let spans = &draft.seams.last().unwrap().sides[side];
        let walked: Vec<(Vec2, Vec2, f64)> = spans
            .iter()
            .map(|span| {
                let piece = &draft.pieces[span.piece];
                let edges: Vec<_> = piece
                    .outline
                    .iter()
                    .chain(piece.holes.iter().flatten())
                    .collect();
                let curve = edges[span.edge].curve;
                let points = curve.sample(span.from, span.to, 3);
                let length = curve.length() * (span.to - span.from).abs();
                (points[0], points[points.len() - 1], length)
            })
            .collect();
        let length = walked.iter().map(|w| w.2).sum();
        (walked[0].0, walked[walked.len() - 1].1, length)
    })
}

#[test]
fn single_edges_are_sewn_with_right_sides_together() {
    let pattern = unsewn();
    let chains = [
        sewn(&pattern, "front", "right"),
        sewn(&pattern, "back", "left"),
    ];
    let (edits, seam) =
        plan::sew(&evaluated(&pattern), [&chains[..1], &chains[1..]], None).unwrap();
    let after = done(&pattern, &edits);
    assert_eq!(after.seam(seam).unwrap().name, "front right to back left");
    for body in bodies() {
        let [one, two] = sides(&after, &body);
        // Both are walked upwards.
        same_place(one.0, v(0.4, 0.0));
        same_place(one.1, v(0.4, 0.6));
        same_place(two.0, v(0.0, 0.0));
        same_place(two.1, v(0.0, 0.6));
    }
    assert_eq!(after.seam(seam).unwrap().sides, sample().seams[0].sides);
    let edits = plan::flip_side(&evaluated(&after), seam, SeamSide::Second).unwrap();
    let flipped = done(&after, &edits);
    let [_, two] = sides(&flipped, &Measurements::adult());
    same_place(two.0, v(0.0, 0.6));
    let edits = plan::flip_side(&evaluated(&flipped), seam, SeamSide::Second).unwrap();
    assert_eq!(done(&flipped, &edits).seams, after.seams);
    let edits = plan::remove_seam(&evaluated(&after), seam).unwrap();
    assert!(done(&after, &edits).says_the_same(&pattern));
}

#[test]
fn a_chain_goes_on_past_a_dart_that_takes_in_a_whole_edge() {
    let mut pattern = unsewn();
    // The front's right edge is the mouth of a dart: bottom and top meet when it is sewn.
    let kind = dart(&pattern, "right", 0.5, 0.6, Apex::Depth(0.1.into()));
    put_operation(&mut pattern, 0, "dart", kind);
    let [bottom, top] = ["bottom", "top"].map(|name| sewn(&pattern, "front", name));
    let back = sewn(&pattern, "back", "left");
    for (chain, is_backwards) in [([bottom, top], false), ([top, bottom], true)] {
        let (edits, seam) = plan::sew(&evaluated(&pattern), [&chain, &[back]], None).unwrap();
        let after = done(&pattern, &edits);
        let span = &after.seam(seam).unwrap().sides[0];
        assert_eq!((span.len(), span[0].backwards), (1, is_backwards));
        let [(_, _, length), _] = sides(&after, &Measurements::new());
        assert!((length - 0.8).abs() < 1e-9, "{length}");
    }
    // One that leaves some of it lies between them.
    let kind = dart(&pattern, "right", 0.5, 0.3, Apex::Depth(0.1.into()));
    alter(&mut pattern, 0, |panel| panel.operations.clear());
    put_operation(&mut pattern, 0, "dart", kind);
    let refused = plan::sew(&evaluated(&pattern), [&[bottom, top], &[back]], None);
    let words = refused.unwrap_err().to_string();
    assert!(words.contains("do not follow each other"), "{words}");
}

#[test]
fn chains_merge_into_spans_and_tell_their_direction() {
    let pattern = unsewn();
    let [bottom, right] = ["bottom", "right"].map(|name| sewn(&pattern, "front", name));
    let [left, below] = ["left", "bottom"].map(|name| sewn(&pattern, "back", name));
    for (chain, start, backwards) in [
        ([bottom, right], v(0.0, 0.0), false),
        ([right, bottom], v(0.4, 0.6), true),
    ] {
        let other = match backwards {
            false => [below, left],
            true => [left, below],
        };
        let (edits, seam) = plan::sew(&evaluated(&pattern), [&chain, &other], Some("l")).unwrap();
        let after = done(&pattern, &edits);
        let found = after.seam(seam).unwrap();
        assert_eq!(found.sides[0].len(), 1, "merged");
        assert_eq!(found.sides[0][0].backwards, backwards);
        for body in bodies() {
            let [one, two] = sides(&after, &body);
            same_place(one.0, start);
            assert!((one.2 - 1.0).abs() < 1e-9 && (two.2 - 1.0).abs() < 1e-9);
        }
    }
    // One edge is walked against a chain that tells its direction.
    for (chain, backwards) in [([bottom, right], true), ([right, bottom], false)] {
        for sides in [[&chain[..], &[left]], [&[left], &chain[..]]] {
            let (edits, seam) = plan::sew(&evaluated(&pattern), sides, None).unwrap();
            let after = done(&pattern, &edits);
            let mut spans = after.seam(seam).unwrap().spans();
            let single = spans.find(|span| span.panel == left.panel).unwrap();
            assert_eq!(single.backwards, backwards);
        }
    }
    // A chain over two panels against one edge that is twice as long.
    let chain = [
        sewn(&pattern, "front", "right"),
        sewn(&pattern, "back", "right"),
    ];
    let other = [sewn(&pattern, "front", "left")];
    let (edits, seam) = plan::sew(&evaluated(&pattern), [&chain, &other], None).unwrap();
    let after = done(&pattern, &edits);
    assert_eq!(after.seam(seam).unwrap().sides[0].len(), 2);
    assert!((sides(&after, &Measurements::adult())[0].2 - 1.2).abs() < 1e-9);
}

#[test]
fn mirrored_copies_and_halves_are_walked_alike() {
    let mut pattern = unsewn();
    alter(&mut pattern, 0, |panel| {
        panel.cut = Cut {
            quantity: 2,
            mirrored: true,
        };
    });
    let right = sewn(&pattern, "front", "right");
    let other = SewnEdge { copy: 1, ..right };
    let (edits, seam) = plan::sew(&evaluated(&pattern), [&[right], &[other]], None).unwrap();
    let after = done(&pattern, &edits);
    let found = after.seam(seam).unwrap();
    assert_eq!(found.name, "right seam");
    assert!(found.spans().all(|span| !span.backwards));
    let [one, two] = sides(&after, &Measurements::adult());
    assert!((one.0.y - two.0.y).abs() < 1e-9 && (one.0.x + two.0.x).abs() < 1e-9);
    // The two halves of a folded panel: a tube.
    let mut pattern = unsewn();
    let kind = fold(&pattern, "left");
    put_operation(&mut pattern, 0, "fold", kind);
    let right = sewn(&pattern, "front", "right");
    let other = SewnEdge { half: 1, ..right };
    let (edits, seam) = plan::sew(&evaluated(&pattern), [&[right], &[other]], None).unwrap();
    let after = done(&pattern, &edits);
    assert!(
        after
            .seam(seam)
            .unwrap()
            .spans()
            .all(|span| !span.backwards)
    );
}

#[test]
fn chains_that_cannot_be_sewn_are_refused() {
    let pattern = sample();
    let evaluation = evaluated(&pattern);
    let of = |panel, name| sewn(&pattern, panel, name);
    let [right, left] = ["right", "left"].map(|name| of("front", name));
    let back = of("back", "left");
    let gone = SewnEdge {
        edge: EdgeId(9999),
        ..right
    };
    for (sides, name, says) in [
        (
            [vec![right], vec![]],
            None,
            "a side of the seam has no edges",
        ),
        (
            [vec![right], vec![right]],
            None,
            "edge \"right\" would be sewn to itself",
        ),
        (
            [vec![right, right], vec![back]],
            None,
            "\"right\" is in the chain twice",
        ),
        (
            [vec![right, left], vec![back]],
            None,
            "edges \"right\" and \"left\" of panel \"front\" do not follow each other",
        ),
        (
            [vec![gone], vec![back]],
            None,
            "edge 9999 of panel \"front\" is not there",
        ),
        (
            [vec![SewnEdge { copy: 1, ..right }], vec![back]],
            None,
            "cut the panel more often",
        ),
        (
            [vec![SewnEdge { half: 1, ..right }], vec![back]],
            None,
            "which has no fold",
        ),
        (
            [vec![right], vec![back]],
            Some("one side"),
            "which seam \"one side\" has",
        ),
    ] {
        let told = refusal(plan::sew(&evaluation, [&sides[0], &sides[1]], name));
        assert!(told.contains(says), "{told}");
    }
    assert!(plan::flip_side(&evaluation, SeamId(9999), SeamSide::First).is_err());
    assert!(plan::remove_seam(&evaluation, SeamId(9999)).is_err());
}
