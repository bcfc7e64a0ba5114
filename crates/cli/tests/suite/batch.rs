//! Batches: killed and resumed, shared by two processes, with jobs that fail, hang or take too much memory; and
//! specifications that are refused.

use crate::common::{patterns, toile, words};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Time after which a test gives up waiting.
const PATIENCE: Duration = Duration::from_secs(120);

/// A folder with two patterns, one of them broken, and a specification.
fn prepared(spec: &Value) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, from) in [
        ("shirt.toile.json", "t-shirt.toile.json"),
        ("skirt.toile.json", "gathered-skirt.toile.json"),
    ] {
        std::fs::copy(patterns().join(from), folder.path().join(name)).unwrap();
    }
    std::fs::write(folder.path().join("broken.json"), "{").unwrap();
    write_spec(folder.path(), spec);
    folder
}

fn write_spec(folder: &Path, spec: &Value) {
    std::fs::write(folder.join("spec.json"), spec.to_string()).unwrap();
}

/// Six quick jobs.
fn six() -> Value {
    json!({
        "patterns": ["shirt.toile.json", "skirt.toile.json"],
        "do": ["check", "convert", "print"],
        "options": { "paper": "page", "print": { "file": "pieces.svg" } },
    })
}

fn start(folder: &Path, out: &str) -> Child {
    Command::new(env!("CARGO_BIN_EXE_toile"))
        .args(["batch", "spec.json", "--out", out, "--jobs", "2"])
        .current_dir(folder)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

/// Every file below a folder that is the same from run to run.
fn lasting(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut left = vec![folder.to_owned()];
    while let Some(next) = left.pop() {
        for entry in std::fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            match path.is_dir() {
                true => left.push(path),
                false if path.ends_with("timing.json") => {}
                false => {
                    let name = path.strip_prefix(folder).unwrap().to_owned();
                    found.insert(name, std::fs::read(&path).unwrap());
                }
            }
        }
    }
    found
}

fn report(folder: &Path, out: &str) -> Value {
    let path = folder.join(out).join("report.json");
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

/// The processes that were started with a folder's name among their arguments.
fn alive(folder: &Path) -> usize {
    let name = folder.to_str().unwrap();
    let entries = std::fs::read_dir("/proc").into_iter().flatten().flatten();
    let lines = entries.filter_map(|entry| std::fs::read(entry.path().join("cmdline")).ok());
    lines
        .filter(|line| String::from_utf8_lossy(line).contains(name))
        .count()
}

#[test]
fn a_batch_that_is_killed_goes_on_to_the_same_bytes() {
    let folder = prepared(&six());
    let whole = toile(folder.path(), &["batch", "spec.json", "--out", "whole"]);
    assert_eq!(whole.status.code(), Some(0), "{}", words(&whole.stderr));
    let told = report(folder.path(), "whole");
    assert_eq!([&told["total"], &told["made"]], [6, 6]);
    let first = &told["jobs"][0];
    assert_eq!(first["pattern"], "shirt.toile.json");
    assert_eq!(first["report"]["pattern"], "T-shirt");
    let report = lasting(&folder.path().join("whole"))[Path::new("report.json")].clone();
    let own = folder.path().to_str().unwrap();
    assert!(!words(&report).contains(own), "a path is in the report");

    // Killed ever later, until a run comes to its end.
    let mut kills = 0;
    for pause in (0..).map(|k| Duration::from_millis(40 + 90 * k)) {
        let mut child = start(folder.path(), "killed");
        std::thread::sleep(pause);
        if child.try_wait().unwrap().is_some() {
            break;
        }
        child.kill().unwrap();
        child.wait().unwrap();
        kills += 1;
    }
    assert!(kills > 0);
    let (whole, killed) = (
        lasting(&folder.path().join("whole")),
        lasting(&folder.path().join("killed")),
    );
    let names = |found: &BTreeMap<PathBuf, Vec<u8>>| found.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&whole), names(&killed));
    for (name, bytes) in &whole {
        assert!(killed[name] == *bytes, "{} differs", name.display());
    }

    // What is done is not done again.
    let result = folder.path().join("killed/jobs");
    let result = std::fs::read_dir(result).unwrap().next().unwrap().unwrap();
    let result = result.path().join("result.json");
    let before = result.metadata().unwrap().modified().unwrap();
    let again = toile(folder.path(), &["batch", "spec.json", "--out", "killed"]);
    assert_eq!(again.status.code(), Some(0));
    assert_eq!(result.metadata().unwrap().modified().unwrap(), before);
}

#[test]
fn two_batches_share_a_folder() {
    let folder = prepared(&six());
    let whole = toile(folder.path(), &["batch", "spec.json", "--out", "whole"]);
    assert_eq!(whole.status.code(), Some(0), "{}", words(&whole.stderr));
    let mut both = [
        start(folder.path(), "shared"),
        start(folder.path(), "shared"),
    ];
    for child in &mut both {
        assert_eq!(child.wait().unwrap().code(), Some(0));
    }
    let [whole, shared] = ["whole", "shared"].map(|name| lasting(&folder.path().join(name)));
    assert!(whole == shared);
}

#[test]
fn jobs_that_fail_hang_or_grow_are_results() {
    let spec = json!({
        "patterns": ["broken.json", "skirt.toile.json"],
        "do": ["check", "nest"],
        "options": { "evaluations": 4_000_000_000_000_u64, "time_limit": "1s" },
    });
    let folder = prepared(&spec);
    let done = toile(folder.path(), &["batch", "spec.json", "--out", "o"]);
    assert_eq!(done.status.code(), Some(1), "{}", words(&done.stderr));
    let told = report(folder.path(), "o");
    let errors: Vec<&str> = told["jobs"]
        .as_array()
        .unwrap()
        .iter()
        .map(|job| job["error"].as_str().unwrap_or("made"))
        .collect();
    assert!(errors[0].starts_with("broken.json: line 1"), "{errors:?}");
    assert!(errors[1].starts_with("broken.json: line 1"), "{errors:?}");
    assert_eq!(errors[2], "made");
    assert!(
        errors[3].contains("longer than its limit of 1 s"),
        "{errors:?}"
    );

    // With more time and fewer evaluations it would be another batch; more time alone is the same one.
    let mut longer = spec.clone();
    longer["options"]["time_limit"] = json!("1500ms");
    write_spec(folder.path(), &longer);
    let kept = toile(folder.path(), &["batch", "spec.json", "--out", "o"]);
    assert_eq!(kept.status.code(), Some(1), "{}", words(&kept.stderr));
    assert_eq!(report(folder.path(), "o"), told);
    let again = toile(
        folder.path(),
        &["batch", "spec.json", "--out", "o", "--retry"],
    );
    assert_eq!(again.status.code(), Some(1));
    let retried = report(folder.path(), "o");
    let error = retried["jobs"][3]["error"].as_str().unwrap();
    assert!(error.contains("limit of 1.5 s"), "{error}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_job_over_its_memory_is_a_result() {
    let spec = json!({
        "patterns": ["shirt.toile.json"],
        "do": ["check", "drape"],
        "options": { "quality": "final", "memory_limit": "300MB" },
    });
    let folder = prepared(&spec);
    let done = toile(folder.path(), &["batch", "spec.json", "--out", "o"]);
    assert_eq!(done.status.code(), Some(1), "{}", words(&done.stderr));
    let told = report(folder.path(), "o");
    assert_eq!(told["jobs"][0]["made"], true, "{told}");
    let error = told["jobs"][1]["error"].as_str().unwrap();
    assert!(
        error.contains("more memory than its limit of 300 MB"),
        "{error}"
    );
}

#[cfg(target_os = "linux")]
#[test]
fn no_child_outlives_its_parent() {
    let spec = json!({
        "patterns": ["skirt.toile.json"],
        "do": "nest",
        "options": { "evaluations": 4_000_000_000_000_u64 },
    });
    let folder = prepared(&spec);
    let mut batch = start(folder.path(), "o");
    let begun = Instant::now();
    while alive(folder.path()) == 0 {
        assert!(begun.elapsed() < PATIENCE, "no job began");
        std::thread::sleep(Duration::from_millis(10));
    }
    batch.kill().unwrap();
    batch.wait().unwrap();
    let killed = Instant::now();
    while alive(folder.path()) > 0 {
        assert!(killed.elapsed() < Duration::from_secs(2), "a child lives");
        std::thread::sleep(Duration::from_millis(10));
    }

    // A job by itself ends with the pipe that it is held by, and leaves no result.
    let list = toile(
        folder.path(),
        &["batch", "spec.json", "--out", "o", "--list", "--json"],
    );
    let list: Value = serde_json::from_slice(&list.stdout).unwrap();
    assert_eq!(list["jobs"][0]["state"], "waiting");
    let job = list["jobs"][0]["job"].as_str().unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_toile"))
        .args(["job", job])
        .stdin(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    std::thread::sleep(Duration::from_millis(500));
    assert!(child.try_wait().unwrap().is_none());
    drop(child.stdin.take());
    let closed = Instant::now();
    assert_eq!(child.wait().unwrap().code(), Some(1));
    assert!(closed.elapsed() < Duration::from_secs(2));
    assert_eq!(alive(folder.path()), 0);
    assert!(!Path::new(job).with_file_name("result.json").exists());
}

#[test]
fn a_scheduler_does_the_jobs_of_a_list() {
    let folder =
        prepared(&json!({ "patterns": "shirt.toile.json", "sizes": ["S", "M"], "do": "check" }));
    let whole = toile(folder.path(), &["batch", "spec.json", "--out", "whole"]);
    assert_eq!(whole.status.code(), Some(0), "{}", words(&whole.stderr));
    let list = ["batch", "spec.json", "--out", "o", "--list", "--json"];
    let listed: Value = serde_json::from_slice(&toile(folder.path(), &list).stdout).unwrap();
    let jobs = listed["jobs"].as_array().unwrap();
    assert_eq!(jobs.len(), 2);
    let early = toile(
        folder.path(),
        &["batch", "spec.json", "--out", "o", "--report"],
    );
    assert_eq!(early.status.code(), Some(1));
    assert!(words(&early.stderr).contains("2 without a result"));
    for job in jobs {
        let done = toile(Path::new("/"), &["job", job["job"].as_str().unwrap()]);
        assert_eq!(done.status.code(), Some(0), "{}", words(&done.stderr));
    }
    let last = toile(
        folder.path(),
        &["batch", "spec.json", "--out", "o", "--report"],
    );
    assert_eq!(last.status.code(), Some(0));
    let [whole, one_by_one] = ["whole", "o"].map(|name| lasting(&folder.path().join(name)));
    assert!(whole == one_by_one);

    // A changed pattern is another job; the file of the old one is refused.
    let pattern = folder.path().join("shirt.toile.json");
    let text = std::fs::read_to_string(&pattern).unwrap();
    std::fs::write(&pattern, text + "\n").unwrap();
    let job = jobs[0]["job"].as_str().unwrap();
    std::fs::remove_file(Path::new(job).with_file_name("result.json")).unwrap();
    let stale = toile(folder.path(), &["job", job]);
    assert!(
        words(&stale.stderr).contains("has changed"),
        "{}",
        words(&stale.stderr)
    );
    let anew: Value = serde_json::from_slice(&toile(folder.path(), &list).stdout).unwrap();
    assert_eq!(anew["jobs"][0]["state"], "waiting");
    assert_ne!(anew["jobs"][0]["id"], jobs[0]["id"]);
}

#[test]
fn a_wrong_specification_is_refused_with_place_and_remedy() {
    let table = [
        (json!([]), ["the file", "an object"]),
        (
            json!({ "do": "check" }),
            ["patterns: the field is missing", "at least one"],
        ),
        (
            json!({ "patterns": ["shirt.toile.json", "gone.json"], "do": "check" }),
            ["patterns[1]: there is no file", "spelling"],
        ),
        (
            json!({ "patterns": ["shirt.toile.json", "shirt.toile.json"], "do": "check" }),
            ["patterns[1]", "named twice"],
        ),
        (
            json!({ "patterns": [], "do": "check" }),
            ["patterns: the list is empty", "at least one"],
        ),
        (
            json!({ "patterns": [7], "do": "check" }),
            ["patterns[0]: 7 is no name", "list of texts"],
        ),
        (
            json!({ "patterns": "shirt.toile.json", "do": "check", "sice": "M" }),
            ["sice: a batch has no such field", "sizes"],
        ),
        (
            json!({ "patterns": "shirt.toile.json", "do": ["check", "sew"] }),
            [
                "do[1]: \"sew\" is nothing",
                "make, drape, nest, print, check, convert",
            ],
        ),
        (
            json!({ "patterns": "shirt.toile.json", "do": "check", "sizes": ["M", "XXXL"] }),
            [
                "sizes[1]: shirt.toile.json has no size \"XXXL\"",
                "XS, S, M, L, XL, XXL",
            ],
        ),
        (
            json!({ "patterns": "shirt.toile.json", "do": "drape", "fabrics": ["poplin", "tin"] }),
            ["fabrics[1]: there is no file \"tin\"", "chiffon"],
        ),
        (
            json!({ "patterns": "shirt.toile.json", "do": "drape", "bodies": ["woman", "ghost"] }),
            ["bodies[1]: there is no figure", "dress-form"],
        ),
        (
            json!({ "patterns": "shirt.toile.json", "do": "check", "bodies": ["woman"] }),
            ["bodies: only make and drape", "leave the field out"],
        ),
        (
            json!({ "patterns": "shirt.toile.json", "do": "drape", "options": { "quality": "best" } }),
            [
                "options.quality: invalid value 'best'",
                "preview, fit, final",
            ],
        ),
        (
            json!({ "patterns": "shirt.toile.json", "do": "drape", "options": { "out": "x" } }),
            ["options.out: nothing that is done takes it", "quality"],
        ),
        (
            json!({ "patterns": "shirt.toile.json", "do": "drape", "options": { "nest": { "seed": 2 } } }),
            ["options.nest: nothing that is done takes it", "quality"],
        ),
        (
            json!({ "patterns": "shirt.toile.json", "do": "print", "options": { "file": "../x.pdf" } }),
            [
                "options.file: \"../x.pdf\" is no name of a file",
                "without its folder",
            ],
        ),
        (
            json!({ "patterns": "shirt.toile.json", "do": "check", "options": { "memory_limit": "4" } }),
            ["options.memory_limit", "as in 2GB"],
        ),
    ];
    let folder = prepared(&six());
    for (spec, said) in table {
        write_spec(folder.path(), &spec);
        let refused = toile(folder.path(), &["batch", "spec.json", "--out", "o"]);
        let heard = words(&refused.stderr);
        assert_eq!(refused.status.code(), Some(2), "{spec}: {heard}");
        assert!(heard.contains("spec.json"), "{heard}");
        for words in said {
            assert!(heard.contains(words), "{spec}: {words:?} is not in {heard}");
        }
        assert!(
            !folder.path().join("o").exists(),
            "{spec} left something behind"
        );
    }
    let twice = "{\"patterns\": \"shirt.toile.json\",\n\"do\": \"check\", \"do\": \"print\"}";
    std::fs::write(folder.path().join("spec.json"), twice).unwrap();
    let refused = toile(folder.path(), &["batch", "spec.json", "--out", "o"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(
        words(&refused.stderr).contains("line 2"),
        "{}",
        words(&refused.stderr)
    );
}

#[test]
fn another_specification_on_the_same_folder_is_refused() {
    let folder = prepared(&json!({ "patterns": "shirt.toile.json", "do": "check" }));
    let first = toile(folder.path(), &["batch", "spec.json", "--out", "o"]);
    assert_eq!(first.status.code(), Some(0), "{}", words(&first.stderr));
    let before = lasting(&folder.path().join("o"));
    write_spec(
        folder.path(),
        &json!({ "patterns": "skirt.toile.json", "do": "check" }),
    );
    let second = toile(folder.path(), &["batch", "spec.json", "--out", "o"]);
    assert_eq!(second.status.code(), Some(2));
    let heard = words(&second.stderr);
    assert!(
        heard.contains("another specification (it differs in patterns)"),
        "{heard}"
    );
    assert!(heard.contains("another --out"), "{heard}");
    assert!(before == lasting(&folder.path().join("o")));
}
