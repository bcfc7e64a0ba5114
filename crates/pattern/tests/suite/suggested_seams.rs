//! Seams suggested for patterns whose own were taken away. Samples that are not there are skipped, with a
//! word.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toile_interchange::{ReadOptions, read};
use toile_measure::Measurements;
use toile_pattern::plan::{
    MAX_SUGGESTED_EDGES, SeamSuggestions, SewnEdge, accept_seams, remove_seam, suggest_seams,
};
use toile_pattern::{
    Draft, Evaluation, Mark, Name, PanelId, Pattern, PieceEdge, Seam, SeamOrigin, Span, WornRule,
};

/// Least shares of the sewn edges whose partner is the first candidate, and among three candidates: with all shared
/// patterns just below what is measured (docs/methods/seams-suggested.md), else for those that ship alone.
fn floors(edges: usize, measured: [f64; 2]) -> [f64; 2] {
    match edges > 400 {
        true => measured.map(|share| share - 0.02),
        false => [0.65, 0.80],
    }
}

fn shared() -> Option<PathBuf> {
    let named = std::env::var_os("TOILE_SHARED").map(PathBuf::from);
    let found = named.or_else(|| {
        let above = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
        let mut beside = above.map(|folder| folder.join("shared"));
        beside.find(|folder| folder.join("data").is_dir())
    });
    let found = found.map(|folder| folder.join("data/garmentcode"));
    let found = found.filter(|folder| folder.is_dir());
    if found.is_none() {
        println!("skipped: no sample folder");
    }
    found
}

fn patterns_in(folder: &Path, ending: &str) -> Vec<(String, Pattern)> {
    let files = std::fs::read_dir(folder).unwrap();
    let mut paths: Vec<PathBuf> = files.map(|file| file.unwrap().path()).collect();
    paths.sort();
    let named = paths.into_iter().filter_map(|path| {
        let name = path.file_name()?.to_string_lossy().into_owned();
        (name.ends_with(ending) && name != "wearer.json").then_some((name, path))
    });
    let read = named.map(|(name, path)| {
        let bytes = std::fs::read(path).unwrap();
        let reading = read(&bytes, &ReadOptions::default(), &[]).unwrap();
        (name, reading.pattern)
    });
    read.collect()
}

fn shipped() -> Vec<(String, Pattern)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../patterns");
    patterns_in(&folder, ".toile.json")
}

fn foreign() -> Vec<(String, Pattern)> {
    let Some(folder) = shared() else {
        return Vec::new();
    };
    let mut all = patterns_in(&folder, "_specification.json");
    all.extend(patterns_in(&folder.join("templates"), ".json"));
    all
}

fn wearer(pattern: &Pattern) -> Measurements {
    let size = pattern.sizes.first();
    size.map_or_else(Measurements::adult_woman, |size| size.measurements.clone())
}

/// The pattern without its seams.
fn bare(pattern: &Pattern) -> Pattern {
    let mut bare = pattern.clone();
    bare.seams.clear();
    bare
}

type Key = (u32, u32, u8, u32);

fn key(edge: SewnEdge) -> Key {
    (edge.panel.0, edge.copy, edge.half, edge.edge.0)
}

fn drawn(draft: &Draft, piece: usize, edge: usize) -> Option<Key> {
    let piece = &draft.pieces[piece];
    let mut edges = piece.outline.iter().chain(piece.holes.iter().flatten());
    let edge: &PieceEdge = edges.nth(edge)?;
    match edge.origin.name {
        Name::Drawn(id) => Some((piece.id.panel.0, piece.id.copy, edge.origin.half, id.0)),
        Name::Made { .. } => None,
    }
}

/// For each sewn edge, the edges that lie opposite it for at least 30 % of the shorter of the two.
fn partners(draft: &Draft) -> BTreeMap<Key, BTreeSet<Key>> {
    let mut found: BTreeMap<Key, BTreeSet<Key>> = BTreeMap::new();
    for seam in &draft.seams {
        if !matches!(seam.id, SeamOrigin::Seam(_)) {
            continue;
        }
        let sides = [0, 1].map(|side| {
            let mut parts: Vec<(Option<Key>, f64, f64)> = Vec::new();
            let mut along = 0.0;
            for span in &seam.sides[side] {
                let piece = &draft.pieces[span.piece];
                let mut edges = piece.outline.iter().chain(piece.holes.iter().flatten());
                let length = edges.nth(span.edge).unwrap().curve.length();
                let length = length * (span.to - span.from).abs();
                let key = drawn(draft, span.piece, span.edge);
                match parts.last_mut() {
                    Some(last) if last.0 == key => last.2 = along + length,
                    _ => parts.push((key, along, along + length)),
                }
                along += length;
            }
            for part in &mut parts {
                (part.1, part.2) = (part.1 / along, part.2 / along);
            }
            parts
        });
        for (a, from, to) in &sides[0] {
            for (b, start, end) in &sides[1] {
                let common = to.min(*end) - from.max(*start);
                let is_shared = common > 0.3 * (to - from).min(end - start);
                if let (Some(a), Some(b), true) = (a, b, is_shared) {
                    found.entry(*a).or_default().insert(*b);
                    found.entry(*b).or_default().insert(*a);
                }
            }
        }
    }
    found
}

/// Sewn edges of a pattern, those whose first candidate is right, and those with a right one among three;
/// suggested seams that are accepted unseen, and how many of them are right.
#[derive(Clone, Copy, Debug, Default)]
struct Rates {
    edges: usize,
    first: usize,
    three: usize,
    accepted: usize,
    right: usize,
}

impl std::ops::AddAssign for Rates {
    fn add_assign(&mut self, other: Self) {
        self.edges += other.edges;
        self.first += other.first;
        self.three += other.three;
        self.accepted += other.accepted;
        self.right += other.right;
    }
}

fn rates(name: &str, pattern: &Pattern, without: &Pattern) -> Rates {
    let wearer = wearer(pattern);
    let (draft, _) = pattern.resolve(&wearer);
    let truth = partners(&draft);
    let suggestions = suggest_seams(&Evaluation::new(without, &wearer)).unwrap();
    let mut rates = Rates {
        edges: truth.len(),
        ..Rates::default()
    };
    for edge in &suggestions.open {
        let Some(right) = truth.get(&key(*edge)) else {
            continue;
        };
        let ranked: Vec<Key> = suggestions
            .partners(*edge)
            .iter()
            .map(|(partner, _)| key(*partner))
            .collect();
        let is_right = |partner: &Key| right.contains(partner);
        rates.first += usize::from(ranked.first().is_some_and(is_right));
        rates.three += usize::from(ranked.iter().take(3).any(is_right));
        if std::env::var_os("TOILE_TELL").is_some() && !ranked.first().is_some_and(is_right) {
            let rank = ranked.iter().position(is_right).map(|k| k + 1);
            let named = |k: &Key| {
                let panel = pattern.panel(PanelId(k.0)).unwrap();
                let edge = panel.edge(toile_pattern::EdgeId(k.3));
                let edge = edge.map_or("?", |edge| edge.name.as_str());
                format!("{}.{edge} copy {} half {}", panel.name, k.1, k.2)
            };
            let wrong = ranked.first().map(&named);
            let right: Vec<String> = right.iter().map(named).collect();
            println!(
                "    {} -> {wrong:?}, not {right:?} (rank {rank:?})",
                named(&key(*edge))
            );
        }
    }
    for seam in suggestions.best().iter().map(|k| &suggestions.seams[*k]) {
        for [a, b] in seam.edges() {
            rates.accepted += 1;
            let right = truth.get(&key(a));
            rates.right += usize::from(right.is_some_and(|right| right.contains(&key(b))));
        }
    }
    println!("{name}: {rates:?}");
    rates
}

/// The pattern without the places of its panels in space, and with names that tell nothing.
fn unplaced(pattern: &Pattern, is_named: bool) -> Pattern {
    let mut bare = bare(pattern);
    for (k, panel) in bare.panels.iter_mut().enumerate() {
        let panel = Arc::make_mut(panel);
        panel.worn = WornRule::Automatic;
        if !is_named {
            panel.name = format!("p{k}");
        }
    }
    bare
}

#[test]
fn partners_are_found_for_garments_whose_seams_were_taken_away() {
    let mut total = Rates::default();
    let mut all = foreign();
    all.extend(shipped());
    for (name, pattern) in &all {
        total += rates(name, pattern, &bare(pattern));
    }
    println!("together: {total:?}");
    assert!(total.edges >= 60, "{total:?}");
    let [first, three] = floors(total.edges, [0.84, 0.96]);
    assert!(
        total.first as f64 >= first * total.edges as f64,
        "{total:?}"
    );
    assert!(
        total.three as f64 >= three * total.edges as f64,
        "{total:?}"
    );
    // Nearly all that is accepted unseen is right, and that is most of the seams.
    assert!(10 * total.right >= 9 * total.accepted, "{total:?}");
    // Of the shipped patterns alone fewer are certain: sleeves, yokes and gathers have several partners.
    let most = if total.edges > 400 { 0.7 } else { 0.6 };
    assert!(
        2.0 * total.right as f64 > most * total.edges as f64,
        "{total:?}"
    );
}

#[test]
fn partners_are_found_without_places_in_space() {
    let mut total = Rates::default();
    let mut all = foreign();
    all.extend(shipped());
    for (name, pattern) in &all {
        total += rates(name, pattern, &unplaced(pattern, true));
    }
    println!("without places: {total:?}");
    let [first, three] = floors(total.edges, [0.81, 0.94]);
    assert!(
        total.first as f64 >= first * total.edges as f64,
        "{total:?}"
    );
    assert!(
        total.three as f64 >= three * total.edges as f64,
        "{total:?}"
    );
    let mut total = Rates::default();
    for (name, pattern) in &all {
        total += rates(name, pattern, &unplaced(pattern, false));
    }
    println!("without places and names: {total:?}");
    let [_, three] = floors(total.edges, [0.61, 0.93]);
    assert!(
        total.three as f64 >= three * total.edges as f64,
        "{total:?}"
    );
}

/// A seam as its spans, whichever side comes first and from whichever end it is sewn.
fn plain(seam: &Seam) -> BTreeSet<Vec<String>> {
    let told = |spans: &[Span]| -> Vec<String> {
        let span = |span: &Span| format!("{span:?}");
        spans.iter().map(span).collect()
    };
    let reversed = |spans: &[Span]| -> Vec<Span> {
        let spans = spans.iter().rev().cloned();
        spans.map(Span::reversed).collect()
    };
    let forward: BTreeSet<Vec<String>> = seam.sides.iter().map(|side| told(side)).collect();
    let back: BTreeSet<Vec<String>> = seam
        .sides
        .iter()
        .map(|side| told(&reversed(side)))
        .collect();
    forward.min(back)
}

/// The suggested seam that sews what a seam of the pattern sews, if each of its sides is one whole edge.
fn meant(seam: &Seam, pattern: &Pattern, suggestions: &SeamSuggestions) -> Option<usize> {
    let edge = |span: &Span| {
        let panel = pattern.panel(span.panel)?;
        let ends = match (&span.from, &span.to, span.backwards) {
            (Mark::Corner(Name::Drawn(from)), Mark::Corner(Name::Drawn(to)), false) => [*from, *to],
            (Mark::Corner(Name::Drawn(from)), Mark::Corner(Name::Drawn(to)), true) => [*to, *from],
            _ => return None,
        };
        let edge = panel.edges().find(|edge| edge.ends == ends)?;
        Some((span.panel.0, span.copy, span.half, edge.id.0))
    };
    let [one, two] = [&seam.sides[0], &seam.sides[1]];
    let ([one], [two]) = (&one[..], &two[..]) else {
        return None;
    };
    let wanted = BTreeSet::from([edge(one)?, edge(two)?]);
    suggestions.seams.iter().position(|found| {
        found
            .edges()
            .any(|pair| pair.map(key).into_iter().collect::<BTreeSet<_>>() == wanted)
    })
}

#[test]
fn the_t_shirt_is_sewn_from_suggestions_as_it_ships() {
    let all = shipped();
    let (_, pattern) = all
        .iter()
        .find(|(name, _)| name.starts_with("t-shirt"))
        .unwrap();
    let wearer = wearer(pattern);
    let without = bare(pattern);
    let evaluation = Evaluation::new(&without, &wearer);
    let suggestions = suggest_seams(&evaluation).unwrap();
    let mut chosen = BTreeSet::new();
    for seam in &pattern.seams {
        chosen.insert(meant(seam, pattern, &suggestions).unwrap());
    }
    // Both sides of the wearer are sewn by one choice.
    assert_eq!(chosen.len(), 5, "{chosen:?}");
    let pairs: Vec<[SewnEdge; 2]> = chosen
        .iter()
        .flat_map(|k| suggestions.seams[*k].edges())
        .collect();
    let (edits, seams) = accept_seams(&evaluation, &pairs).unwrap();
    assert_eq!(seams.len(), pattern.seams.len());
    let mut sewn = without.clone();
    sewn.apply(&edits).unwrap();
    let of = |pattern: &Pattern| -> BTreeSet<BTreeSet<Vec<String>>> {
        pattern.seams.iter().map(|seam| plain(seam)).collect()
    };
    assert_eq!(of(&sewn), of(pattern));
    let errors = sewn.check(&wearer);
    assert!(errors.is_empty(), "{errors:?}");
    // Undone, the pattern is the one without seams.
    let mut undone = sewn.clone();
    for seam in seams {
        let edits = remove_seam(&Evaluation::new(&undone, &wearer), seam).unwrap();
        undone.apply(&edits).unwrap();
    }
    undone.ids = without.ids;
    assert_eq!(undone, without);
    // An edge that is sewn is not suggested again.
    let again = suggest_seams(&Evaluation::new(&sewn, &wearer)).unwrap();
    let sewn_edges: BTreeSet<Key> = pairs.iter().flatten().map(|edge| key(*edge)).collect();
    assert!(
        again
            .open
            .iter()
            .all(|edge| !sewn_edges.contains(&key(*edge)))
    );
    let mut listed = again.seams.iter().flat_map(|seam| seam.edges()).flatten();
    assert!(listed.all(|edge| !sewn_edges.contains(&key(edge))));
}

#[test]
fn no_edge_gets_a_second_seam() {
    let all = shipped();
    let (_, pattern) = all
        .iter()
        .find(|(name, _)| name.starts_with("t-shirt"))
        .unwrap();
    let wearer = wearer(pattern);
    let evaluation = Evaluation::new(&bare(pattern), &wearer);
    let suggestions = suggest_seams(&evaluation).unwrap();
    let first = suggestions.seams[0].pairs[0].edges;
    let error = accept_seams(&evaluation, &[first, first])
        .unwrap_err()
        .to_string();
    assert!(error.contains("second seam"), "{error}");
    let sewn = Evaluation::new(pattern, &wearer);
    let own = suggestions.seams[suggestions.best()[0]].pairs[0].edges;
    assert!(accept_seams(&sewn, &[own]).is_err());
    // What is accepted unseen takes every edge once.
    let best = suggestions.best();
    let edges: Vec<Key> = best
        .iter()
        .flat_map(|k| suggestions.seams[*k].edges())
        .flatten()
        .map(key)
        .collect();
    let distinct: BTreeSet<&Key> = edges.iter().collect();
    assert_eq!(distinct.len(), edges.len());
    assert!(MAX_SUGGESTED_EDGES > 0 && !edges.is_empty());
}

#[test]
fn a_pattern_without_panels_has_no_suggestions() {
    let empty = Pattern::default();
    let suggestions = suggest_seams(&Evaluation::new(&empty, &Measurements::new())).unwrap();
    assert_eq!(suggestions, SeamSuggestions::default());
    assert!(suggestions.best().is_empty());
}
