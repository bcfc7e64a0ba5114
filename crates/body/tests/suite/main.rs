//! All tests over the public interface, in one program: `cargo test -p toile-body --test suite NAME::` runs those of one file.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

mod breadths;
mod children;
mod common;
mod dress_forms;
mod ellipsoids;
mod fits;
mod gaits;
mod head_and_hands;
mod mannequins;
mod motion;
mod moving_skin;
mod own_measures;
mod players;
mod primitives;
mod proportions;
mod real_time;
mod scaling;
mod scans;
mod sizes;
mod skeleton;
mod swing;
mod webbing;
