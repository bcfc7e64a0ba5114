//! Markers of several fabrics, rolls and patterns: nothing made is lost, and every copy keeps its
//! number.

use crate::marker_settings::{pattern, rolls, settings};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use toile_interchange::{MarkerFile, read_marker_json, write_marker_json};
use toile_session::{
    Budget, ClothSettings, MarkerFormat, MarkerSummary, NapRule, NestOptions, SessionError, Silent,
    SizeSelection, Watcher, judge_marker_file, nest_patterns,
};

fn options() -> NestOptions {
    NestOptions {
        budget: Budget::Evaluations(50_000),
        formats: vec![MarkerFormat::Json],
        ..NestOptions::default()
    }
}

fn marker(folder: &Path, name: &str) -> MarkerFile {
    read_marker_json(&std::fs::read_to_string(folder.join(name)).unwrap()).unwrap()
}

fn nest(
    names: &[&str],
    options: &NestOptions,
    (folder, watcher): (&Path, &mut dyn Watcher),
) -> Result<Vec<MarkerSummary>, SessionError> {
    let patterns: Vec<PathBuf> = names.iter().map(|name| pattern(name)).collect();
    nest_patterns(&patterns, options, (folder, watcher)).map(|made| made.0)
}

/// Sleeves are cut from a lining.
fn two_fabrics() -> NestOptions {
    NestOptions {
        settings: settings(
            r#""fabrics": { "lining": { "width": "140cm" } },
               "pieces": { "sleeve": { "fabric": "lining" } }"#,
        ),
        ..options()
    }
}

/// Somebody who asks to stop once the first of two fabrics is done.
struct Impatient(Arc<AtomicBool>);

impl Watcher for Impatient {
    fn progress(&mut self, _stage: &str, share: f64, _detail: &str) -> ControlFlow<()> {
        self.0.fetch_or(share >= 0.5, Ordering::Relaxed);
        ControlFlow::Continue(())
    }

    fn stop_flag(&self) -> Option<Arc<AtomicBool>> {
        Some(self.0.clone())
    }
}

#[test]
fn stopping_on_the_second_fabric_keeps_the_first() {
    let folder = tempfile::tempdir().unwrap();
    let keeping = NestOptions {
        keep_best: true,
        ..two_fabrics()
    };
    let mut watcher = Impatient(Arc::default());
    let summary = nest(&["t-shirt"], &keeping, (folder.path(), &mut watcher)).unwrap();
    assert!(watcher.0.load(Ordering::Relaxed));
    let found: Vec<_> = summary.iter().map(|n| (n.pieces, n.sound)).collect();
    assert_eq!(found, [(2, true), (2, true)]);
    for one in &summary {
        let early = |note: &String| note.starts_with("stopped early");
        assert!(one.notes.iter().any(early), "{:?}", one.notes);
    }
    // Without that wish it is an error, and no fault of what was given.
    let mut watcher = Impatient(Arc::default());
    let error = nest(&["t-shirt"], &two_fabrics(), (folder.path(), &mut watcher)).unwrap_err();
    assert!(!error.is_bad_input(), "{error}");
    let stopped = SessionError::from(toile_session::MarkerError::Cancelled);
    assert!(!stopped.is_bad_input());
}

#[test]
fn copies_on_rolls_keep_the_numbers_of_the_fabric() {
    let folder = tempfile::tempdir().unwrap();
    let rolled = NestOptions {
        cloth: ClothSettings {
            rolls: rolls(&[(1.2, Some(0.3)), (1.1, Some(0.8))]),
            ..ClothSettings::default()
        },
        sizes: SizeSelection::Named(vec![("M".into(), 2)]),
        ..options()
    };
    let summary = nest(&["trousers"], &rolled, (folder.path(), &mut Silent)).unwrap();
    assert_eq!(summary.len(), 2);
    let files = ["marker.json", "marker-2.json"].map(|name| marker(folder.path(), name));
    let mut names: BTreeMap<usize, String> = BTreeMap::new();
    let mut seen = BTreeSet::new();
    let laid = files.iter().flat_map(|f| &f.pieces);
    let laid = laid.map(|p| (p.item, p.copy, p.name.clone()));
    let left = files.iter().flat_map(|f| &f.unplaced);
    let left = left.map(|u| (u.item, u.copy, u.name.clone()));
    assert!(left.clone().count() > 0);
    for (item, copy, name) in laid.chain(left) {
        let known = names.entry(item).or_insert_with(|| name.clone());
        assert_eq!(*known, name, "item {item}");
        assert!(seen.insert((item, copy)), "{name}: {item} {copy} twice");
    }
    assert_eq!((names.len(), seen.len()), (5, 10));
}

#[test]
fn a_piece_across_the_nap_is_a_fault() {
    let folder = tempfile::tempdir().unwrap();
    for nap in [NapRule::PerGarment, NapRule::OneWay] {
        let napped = NestOptions {
            cloth: ClothSettings {
                nap: Some(nap),
                tilt: Some(0.03),
                ..ClothSettings::default()
            },
            ..options()
        };
        nest(&["t-shirt"], &napped, (folder.path(), &mut Silent)).unwrap();
        let path = folder.path().join("marker.json");
        assert!(judge_marker_file(&path, None).unwrap().faults.is_empty());
        let mut file = marker(folder.path(), "marker.json");
        let piece = &mut file.pieces[0];
        let at = piece.at;
        for p in &mut piece.outline {
            *p = [at[0] - (p[1] - at[1]), at[1] + (p[0] - at[0])];
        }
        piece.turn += 90.0;
        let path = folder.path().join("turned.json");
        std::fs::write(&path, write_marker_json(&file).unwrap()).unwrap();
        let faults = judge_marker_file(&path, None).unwrap().faults;
        let turned = |f: &String| f.contains("is turned by") && f.contains("forbid");
        assert!(faults.iter().any(turned), "{nap:?}: {faults:?}");
    }
}

#[test]
fn patterns_of_one_name_are_told_apart() {
    let folder = tempfile::tempdir().unwrap();
    nest(&["t-shirt"; 2], &options(), (folder.path(), &mut Silent)).unwrap();
    let file = marker(folder.path(), "marker.json");
    let fronts = file.pieces.iter().filter(|p| p.name.starts_with("front"));
    let names: BTreeSet<&str> = fronts.map(|p| p.name.as_str()).collect();
    assert_eq!(names.len(), 2, "{names:?}");
    assert!(names.iter().any(|name| name.ends_with("(2)")), "{names:?}");
}
