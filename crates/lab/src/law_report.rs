//! The laws as Markdown: of each the check that is hardest on it, and every check that fails.

use crate::check::significant;
use crate::{Check, LAWS};
use std::fmt::Write;

/// How much of what is allowed a check takes up; infinite where it has no number.
fn taken(check: &Check) -> f64 {
    check
        .error
        .map_or(f64::INFINITY, |error| error / check.tolerance)
}

/// Of each law measured how many of its checks pass, and the one that takes up most of what is
/// allowed; then every check that fails. Markdown.
pub fn law_table(checks: &[Check]) -> String {
    let mut text = String::from(
        "| law | checks met | hardest check | error | allowed | wall time, s |\n|---|---|---|---|---|---|\n",
    );
    for law in &LAWS {
        let own = || checks.iter().filter(|check| check.law == law.name);
        let Some(hardest) = own().max_by(|a, b| taken(a).total_cmp(&taken(b))) else {
            continue;
        };
        let error = hardest
            .error
            .map_or("none: failed".to_owned(), |error| format!("{error:.1e}"));
        let _ = writeln!(
            text,
            "| {} | {} of {} | {}: {} | {error} | {:.0e} | {:.1} |",
            law.name,
            own().filter(|check| check.passed()).count(),
            own().count(),
            hardest.case,
            hardest.quantity,
            hardest.tolerance,
            own().map(|check| check.seconds).sum::<f64>(),
        );
    }
    let passed = checks.iter().filter(|check| check.passed()).count();
    let _ = writeln!(text, "\n{passed} of {} checks are met.", checks.len());
    let failed = checks.iter().filter(|check| !check.passed());
    for check in failed {
        let found = match (check.measured, &check.failure) {
            (Some(measured), _) => format!("{} measured", significant(measured, 4)),
            (None, Some(failure)) => failure.clone(),
            (None, None) => "nothing measured".to_owned(),
        };
        let _ = writeln!(
            text,
            "- Not met: {}, {}, {}: {found}, {} expected, {:.0e} of {} allowed.",
            check.law,
            check.case,
            check.quantity,
            significant(check.expected, 4),
            check.tolerance,
            check.of,
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(law: &'static str, case: &str, error: Option<f64>) -> Check {
        Check {
            law,
            case: case.to_owned(),
            quantity: "force, N",
            expected: 2.0,
            measured: error.map(|error| 2.0 * (1.0 + error)),
            error,
            of: "the expected value",
            tolerance: 0.01,
            failure: error.is_none().then(|| "it fell over".to_owned()),
            seconds: 0.5,
        }
    }

    #[test]
    fn the_hardest_check_of_each_law_and_all_that_fail_are_told() {
        let checks = [
            check("rigid", "easy", Some(1e-3)),
            check("rigid", "hard", Some(5e-3)),
            check("patch", "far", Some(0.5)),
            check("patch", "lost", None),
        ];
        let text = law_table(&checks);
        for line in [
            "| rigid | 2 of 2 | hard: force, N | 5.0e-3 | 1e-2 | 1.0 |",
            "| patch | 0 of 2 | lost: force, N | none: failed | 1e-2 | 1.0 |",
            "2 of 4 checks are met.",
            "- Not met: patch, far, force, N: 3.000 measured, 2.000 expected, 1e-2 of the expected value allowed.",
            "- Not met: patch, lost, force, N: it fell over, 2.000 expected",
        ] {
            assert!(text.contains(line), "{line:?} in\n{text}");
        }
        assert!(!text.contains("easy") && !text.contains("cusick"), "{text}");
    }
}
