//! Random events on the window's tools: ten thousand here, a hundred thousand in `soak events`.

use std::sync::Mutex;
use toile_tests::events::{EVENTS, events};

#[test]
fn random_events_damage_nothing_and_are_undone_and_replayed() {
    let folder = tempfile::tempdir().unwrap();
    let seeds = Mutex::new(0..10_000 / EVENTS as u64);
    let failed = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                loop {
                    let Some(seed) = seeds.lock().unwrap().next() else {
                        return;
                    };
                    if let Err(why) = events(seed, folder.path()) {
                        failed.lock().unwrap().push(why);
                    }
                }
            });
        }
    });
    let failed = failed.into_inner().unwrap();
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}
