//! A body measured as anybody's mesh has what it was asked for.

use super::{toile, words};
use std::collections::BTreeMap;

/// A column of the table a command prints, by the name in the first (cm).
fn column(text: &str, which: usize) -> BTreeMap<String, f64> {
    text.lines()
        .filter_map(|line| {
            let fields: Vec<&str> = line.split_whitespace().collect();
            let value = fields.get(which)?.parse().ok()?;
            Some((fields[0].to_owned(), value))
        })
        .collect()
}

#[test]
fn a_mannequin_has_its_girths_as_anybody_s_mesh() {
    let folder = tempfile::tempdir().unwrap();
    for figure in ["woman", "man", "mean"] {
        let made = ["body", "--figure", figure, "--out", "b.obj"];
        let made = toile(folder.path(), &made);
        assert!(made.status.success(), "{}", words(&made.stderr));
        let measured = ["body", "--mesh", "b.obj", "--out", "t.json"];
        let measured = toile(folder.path(), &measured);
        assert!(measured.status.success(), "{}", words(&measured.stderr));
        let asked = column(&words(&made.stdout), 1);
        let got = column(&words(&made.stdout), 2);
        let mesh = column(&words(&measured.stdout), 1);
        for name in [
            "hips",
            "waist",
            "bust",
            "underbust",
            "neck",
            "wrist",
            "leg_circ",
        ] {
            for (what, found) in [("reported", &got), ("as a mesh", &mesh)] {
                let gap = found[name] - asked[name];
                assert!(gap.abs() <= 0.5, "{figure} {name} {what}: {gap} cm");
            }
        }
    }
}
