//! Benchmarks as tables for the page: both numbers of threads of one in a row.

use super::{Content, markdown};
use crate::bench::bench;
use crate::check::significant;
use crate::timed::Timed;
use crate::{LabError, bench_report};
use toile_session::Watcher;

const SHEETS: [&str; 2] = ["detect-sheet-1k", "detect-sheet-30k"];
const SHIRTS: [&str; 2] = ["detect-shirt-1k", "detect-shirt-6k"];
const BALL: &str = "sphere-65-touching";
pub(super) const CONTACT_COMMAND: &str = "toile bench detect-sheet-1k detect-sheet-30k detect-shirt-1k detect-shirt-6k sphere-65-touching";

const FACTORS: [&str; 5] = [
    "factor-sheet-10k",
    "factor-sheet-30k",
    "factor-sheet-100k",
    "factor-tube-10k",
    "factor-tube-30k",
];
pub(super) const FACTOR_COMMAND: &str = "toile bench factor-sheet-10k factor-sheet-30k factor-sheet-100k factor-tube-10k factor-tube-30k";

/// Runs benchmarks by their names.
fn run(names: &[&str], watcher: &mut dyn Watcher) -> Result<Vec<Timed>, LabError> {
    let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
    bench(&names, watcher)
}

/// The runs of one benchmark, by rising number of threads.
struct Runs<'a>(Vec<&'a Timed>);

impl<'a> Runs<'a> {
    fn of(found: &'a [Timed], name: &str) -> Self {
        Self(found.iter().filter(|timed| timed.name == name).collect())
    }

    /// What a run counted, by its name, rounded; a dash where it counted no such thing.
    fn counted(timed: &Timed, what: &str, digits: usize) -> String {
        let value = timed.counted.get(what);
        value.map_or("-".to_owned(), |value| significant(*value, digits))
    }

    /// Of every number of threads.
    fn each(&self, what: &str, digits: usize) -> String {
        let each: Vec<String> = self
            .0
            .iter()
            .map(|timed| Self::counted(timed, what, digits))
            .collect();
        each.join(" / ")
    }

    /// Wall time and, in brackets, processor time of every number of threads, by the names they are
    /// counted by.
    fn times(&self, [wall, cpu]: [&str; 2]) -> String {
        let each = self.0.iter().map(|timed| {
            let [wall, cpu] = [wall, cpu].map(|what| Self::counted(timed, what, 3));
            format!("{wall} ({cpu})")
        });
        each.collect::<Vec<_>>().join(" / ")
    }

    /// A count that is the same with any number of threads.
    fn count(&self, what: &str) -> String {
        let value = self.0.first().and_then(|timed| timed.counted.get(what));
        value.map_or("-".to_owned(), |value| format!("{value:.0}"))
    }

    /// What is the same with any number of threads.
    fn any(&self, what: &str, digits: usize) -> String {
        let first = self.0.first();
        first.map_or("-".to_owned(), |timed| Self::counted(timed, what, digits))
    }

    /// Number of vertices, or why there is nothing to tell.
    fn vertices(&self) -> String {
        let failure = self.0.iter().find_map(|timed| timed.failure.as_ref());
        let vertices = self.0.first().map_or(0, |timed| timed.vertices);
        failure.map_or_else(
            || vertices.to_string(),
            |failure| format!("failed: {failure}"),
        )
    }
}

/// Finding contacts, and frames with contact of cloth with cloth.
pub(super) fn contact(watcher: &mut dyn Watcher) -> Result<Content, LabError> {
    let names: Vec<&str> = SHEETS.into_iter().chain(SHIRTS).chain([BALL]).collect();
    let found = run(&names, watcher)?;
    let searched = SHEETS.into_iter().chain(SHIRTS).map(|name| {
        let runs = Runs::of(&found, name);
        let both = |what: &str| {
            ["all", "curved"]
                .map(|by| runs.count(&format!("{by}_{what}")))
                .join(", ")
        };
        vec![
            name.trim_start_matches("detect-").to_owned(),
            runs.vertices(),
            runs.times(["all_ms", "all_cpu_ms"]),
            runs.times(["curved_ms", "curved_cpu_ms"]),
            both("regions"),
            both("contacts"),
            both("crossings"),
        ]
    });
    let columns = [
        "cloth",
        "vertices",
        "all regions, ms",
        "by curvature, ms",
        "regions: all, by curvature",
        "contacts: all, by curvature",
        "crossings: all, by curvature",
    ];
    let mut tables = markdown(&columns, searched);
    let mut rows = Vec::new();
    for name in SHIRTS {
        let runs = Runs::of(&found, name);
        for (key, words) in [("worn", "still"), ("turning", "turning at 2 rad/s")] {
            let key = |what: &str| format!("{key}_{what}");
            let times = |wall: &str, cpu: &str| runs.times([&key(wall), &key(cpu)]);
            rows.push(vec![
                format!("{}, {words}", name.trim_start_matches("detect-")),
                runs.vertices(),
                times("frame_ms", "frame_cpu_ms"),
                times("frame_without_ms", "frame_without_cpu_ms"),
                runs.any(&key("looks_a_frame"), 2),
                runs.each(&key("detection_percent"), 2),
                "-".to_owned(),
            ]);
        }
    }
    let runs = Runs::of(&found, BALL);
    rows.push(vec![
        "square that falls on a ball".to_owned(),
        runs.vertices(),
        runs.times(["ms_per_frame", "cpu_ms_per_frame"]),
        "-".to_owned(),
        runs.any("looks_a_frame", 2),
        "-".to_owned(),
        runs.count("crossings"),
    ]);
    let columns = [
        "scene",
        "vertices",
        "a frame, ms",
        "without contact, ms",
        "searches a frame",
        "searching, % of the frame",
        "crossings at the end",
    ];
    tables += "\n";
    tables += &markdown(&columns, rows);
    Ok(tables.into())
}

/// Factorising and solving.
pub(super) fn factorisation(watcher: &mut dyn Watcher) -> Result<Content, LabError> {
    let found = run(&FACTORS, watcher)?;
    let rows = FACTORS.map(|name| {
        let runs = Runs::of(&found, name);
        vec![
            name.trim_start_matches("factor-").to_owned(),
            runs.vertices(),
            runs.any("gflop", 3),
            runs.any("millions_of_numbers", 3),
            runs.each("structure_ms", 3),
            runs.times(["factorise_ms", "factorise_cpu_ms"]),
            runs.each("gflop_a_cpu_second", 2),
            runs.times(["solve_ms", "solve_cpu_ms"]),
            runs.any("error", 2),
        ]
    });
    let columns = [
        "mesh",
        "vertices",
        "operations, GFlop",
        "numbers in L, millions",
        "structure (once), ms",
        "factorise, ms",
        "GFlop a processor second",
        "solve, ms",
        "error",
    ];
    Ok(markdown(&columns, rows).into())
}

/// Drags of points.
pub(super) fn drag(watcher: &mut dyn Watcher) -> Result<Content, LabError> {
    Ok(bench_report(&run(&["drag"], watcher)?).into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn commands_name_every_benchmark_of_their_section() {
        let known = crate::bench_names();
        let contact = SHEETS.into_iter().chain(SHIRTS).chain([BALL]);
        for (command, names) in [
            (CONTACT_COMMAND, contact.collect::<Vec<_>>()),
            (FACTOR_COMMAND, FACTORS.to_vec()),
        ] {
            assert_eq!(command, format!("toile bench {}", names.join(" ")));
            assert!(names.iter().all(|name| known.contains(&(*name).to_owned())));
        }
    }

    #[test]
    fn numbers_of_threads_stand_in_a_row_and_failures_are_told() {
        let timed = |threads, counted, failure: Option<&str>| Timed {
            name: "one".to_owned(),
            threads,
            vertices: 9,
            wall_s: 1.0,
            cpu_s: None,
            counted: BTreeMap::from([("ms".to_owned(), counted)]),
            report: None,
            failure: failure.map(str::to_owned),
        };
        let found = [timed(1, 4.0, None), timed(2, 2.0, None)];
        let runs = Runs::of(&found, "one");
        assert_eq!(runs.each("ms", 2), "4.0 / 2.0");
        assert_eq!(runs.times(["ms", "cpu_ms"]), "4.00 (-) / 2.00 (-)");
        assert_eq!(
            (runs.count("ms"), runs.count("s")),
            ("4".into(), "-".into())
        );
        assert_eq!(
            (runs.any("ms", 2), runs.any("s", 2)),
            ("4.0".into(), "-".into())
        );
        assert_eq!(runs.vertices(), "9");
        let found = [timed(1, 4.0, None), timed(2, 2.0, Some("too hot"))];
        assert_eq!(Runs::of(&found, "one").vertices(), "failed: too hot");
    }
}
