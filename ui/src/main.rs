//! The Toile window.
fn main() {}
