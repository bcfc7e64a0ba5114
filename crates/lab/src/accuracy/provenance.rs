//! Of what and where a page was measured: commit, build, threads, processor.

use std::path::Path;
use std::process::Command;

/// The commit that the program was built from, as `git rev-parse --short HEAD` names it in the
/// folder of its sources, and whether files other than documents were changed since. None without
/// git or sources.
fn commit() -> Option<(String, bool)> {
    let sources = Path::new(env!("CARGO_MANIFEST_DIR"));
    let git = |arguments: &[&str]| {
        let mut command = Command::new("git");
        let ran = command.arg("-C").arg(sources).args(arguments).output();
        let output = ran.ok().filter(|output| output.status.success())?;
        Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    let name = git(&["rev-parse", "--short", "HEAD"])?;
    let changes = git(&[
        "status",
        "--porcelain",
        "--untracked-files=no",
        "--",
        ":/",
        ":(top,exclude)docs",
    ])?;
    Some((name, !changes.is_empty()))
}

/// The processor's name where the system tells it (Linux: `/proc/cpuinfo`), else its kind.
fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = text
        .lines()
        .find_map(|line| line.strip_prefix("model name")?.split_once(':'))
        .map(|(_, name)| name.trim().to_owned());
    name.filter(|name| !name.is_empty())
        .unwrap_or_else(|| std::env::consts::ARCH.to_owned())
}

/// Of what and where this program measures, as a sentence: commit, or version where there is none
/// to be had; kind of build; threads; processor.
pub fn provenance() -> String {
    let source = match commit() {
        Some((name, false)) => format!("Commit `{name}`"),
        Some((name, true)) => format!("Commit `{name}` with changes"),
        None => format!("Version {}", env!("CARGO_PKG_VERSION")),
    };
    let build = match cfg!(debug_assertions) {
        true => "development build",
        false => "release build",
    };
    let threads = rayon::current_num_threads();
    let ending = if threads == 1 { "" } else { "s" };
    format!(
        "{source}, {build}, {threads} thread{ending}, {}.",
        processor()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commit_or_version_build_threads_and_processor_are_told() {
        let told = provenance();
        assert!(
            told.starts_with("Commit `") || told.starts_with("Version "),
            "{told}"
        );
        for text in [" build, ", " thread", &processor()] {
            assert!(told.contains(text), "{text:?} in {told}");
        }
        assert!(!told.contains('\n'), "{told}");
    }
}
