//! Planted tangles: each is undone. A hundred of them run in `soak tangles`.

use crate::support::tangles::tangle;
use toile_drape::{MethodSettings, SceneRun};

/// Crossings at the start, and at the end: cloth with cloth, cloth with a body.
fn undo(seed: u64) -> [[usize; 2]; 2] {
    let mut run = SceneRun::new(&tangle(seed), MethodSettings::build).expect("a sound scene");
    let count = |run: &mut SceneRun| {
        let measures = run.measure();
        [measures.self_intersections, measures.body_intersections]
    };
    let start = count(&mut run);
    while !run.finished() {
        run.advance().expect("a step that succeeds");
    }
    let end = count(&mut run);
    [start, end]
}

fn check(seeds: impl Iterator<Item = u64>) {
    let mut left = Vec::new();
    for seed in seeds {
        let [start, end] = undo(seed);
        assert!(start != [0, 0], "seed {seed} plants nothing");
        if end != [0, 0] {
            left.push((seed, start, end));
        }
    }
    assert!(left.is_empty(), "{left:?}");
}

#[test]
fn points_pushed_through_a_layer_come_back() {
    check([0, 4, 8].into_iter());
}

#[test]
fn crossed_layers_come_apart() {
    check([1, 5, 9].into_iter());
}

#[test]
fn a_fold_through_itself_comes_out() {
    // The last one rolls over its own pinned border.
    check([2, 6, 10, 74].into_iter());
}

#[test]
fn a_panel_half_inside_a_body_is_led_out() {
    check([3, 7, 11].into_iter());
}
