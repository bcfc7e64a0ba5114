//! Checks: a measured number beside the expected one, and tables of them.

use crate::{LabError, Tolerance};
use serde::Serialize;
use std::fmt::Write;
use std::ops::ControlFlow;
use std::time::Instant;
use toile_session::Watcher;

/// A number that a law gives, and what was measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Check {
    /// The law's name.
    pub law: &'static str,
    /// Which case of it.
    pub case: String,
    /// The quantity measured, with its unit.
    pub quantity: &'static str,
    /// The expected value.
    pub expected: f64,
    /// The measured value; none when the simulation failed.
    pub measured: Option<f64>,
    /// |measured - expected| over the scale (that of the expected value unless it is zero).
    pub error: Option<f64>,
    /// What that scale is.
    pub of: &'static str,
    /// Largest error allowed; one that the law declares, or less.
    pub tolerance: f64,
    /// Why there is no number.
    pub failure: Option<String>,
    /// Wall time of the case (s).
    pub seconds: f64,
}

impl Check {
    /// Whether the measured number is as near as it must be.
    pub fn passed(&self) -> bool {
        self.error.is_some_and(|error| error <= self.tolerance)
    }
}

/// The expectation of a case.
#[derive(Clone, Copy, Debug)]
pub struct Expected {
    /// The tolerance that the law declares for it.
    tolerance: Tolerance,
    /// The expected value.
    value: f64,
    /// The scale of errors; the expected value itself, unless it is zero.
    scale: f64,
    /// Largest error allowed, as a share of the scale: the tolerance's, or less.
    allowed: f64,
}

impl Expected {
    /// A value, met to a share of itself.
    pub fn value(tolerance: Tolerance, value: f64) -> Self {
        Self {
            tolerance,
            value,
            scale: value.abs(),
            allowed: tolerance.share,
        }
    }

    /// Nothing, met to a share of a scale.
    pub fn zero(tolerance: Tolerance, scale: f64) -> Self {
        Self {
            tolerance,
            value: 0.0,
            scale,
            allowed: tolerance.share,
        }
    }

    /// The same, met more nearly where this case allows less than the law at its widest.
    pub fn within(self, share: f64) -> Self {
        Self {
            allowed: share.min(self.allowed),
            ..self
        }
    }

    fn error(&self, measured: f64) -> f64 {
        (measured - self.value).abs() / self.scale
    }
}

/// Collects the cases of laws and tells how far they are.
pub struct Cases<'a> {
    pub(crate) law: &'static str,
    pub(crate) tolerances: &'static [Tolerance],
    pub(crate) share: [f64; 2],
    watcher: &'a mut dyn Watcher,
    found: Vec<Check>,
}

impl<'a> Cases<'a> {
    /// No cases yet.
    pub fn new(watcher: &'a mut dyn Watcher) -> Self {
        Self {
            law: "",
            tolerances: &[],
            share: [0.0, 1.0],
            watcher,
            found: Vec::new(),
        }
    }

    /// Tells what is being done; `share` is the part of this law that is done.
    ///
    /// # Errors
    /// The watcher asked to stop.
    pub fn tell(&mut self, share: f64, case: &str) -> Result<(), LabError> {
        let [from, to] = self.share;
        let share = from + (to - from) * share.clamp(0.0, 1.0);
        match self.watcher.progress(self.law, share, case) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(LabError::Cancelled),
        }
    }

    /// Measures a case and writes down how it went; a simulation that fails is a failed case.
    ///
    /// # Errors
    /// The watcher asked to stop.
    pub fn measure(
        &mut self,
        case: impl Into<String>,
        expected: Expected,
        measure: impl FnOnce() -> Result<f64, LabError>,
    ) -> Result<Option<f64>, LabError> {
        let case = case.into();
        self.tell(0.0, &case)?;
        let start = Instant::now();
        let outcome = measure();
        self.add(case, expected, outcome, start)
    }

    /// Writes down a case measured elsewhere.
    ///
    /// # Errors
    /// Only when the measuring was cancelled.
    pub fn add(
        &mut self,
        case: impl Into<String>,
        expected: Expected,
        outcome: Result<f64, LabError>,
        start: Instant,
    ) -> Result<Option<f64>, LabError> {
        let declared = self.tolerances.contains(&expected.tolerance);
        let (measured, failure) = match outcome {
            Ok(_) if !declared => (None, Some("the law declares no such tolerance".to_owned())),
            Ok(value) if value.is_finite() => (Some(value), None),
            Ok(value) => (None, Some(format!("measured {value}"))),
            Err(LabError::Cancelled) => return Err(LabError::Cancelled),
            Err(error) => (None, Some(error.to_string())),
        };
        self.found.push(Check {
            law: self.law,
            case: case.into(),
            quantity: expected.tolerance.quantity,
            expected: expected.value,
            measured,
            error: measured.map(|m| expected.error(m)),
            of: expected.tolerance.of,
            tolerance: expected.allowed,
            failure,
            seconds: start.elapsed().as_secs_f64(),
        });
        Ok(measured)
    }

    /// The cases found.
    pub fn finish(self) -> Vec<Check> {
        self.found
    }
}

/// The checks as a table for people.
pub fn table(checks: &[Check]) -> String {
    let mut text = format!(
        "{:<16} {:<44} {:<22} {:>13} {:>13} {:>9} {:>9}  pass\n",
        "law", "case", "quantity", "expected", "measured", "error", "allowed"
    );
    for check in checks {
        let number = |x: Option<f64>| x.map_or("-".to_owned(), |x| significant(x, 6));
        let error = |x: Option<f64>| x.map_or("-".to_owned(), |x| format!("{x:.1e}"));
        let _ = writeln!(
            text,
            "{:<16} {:<44} {:<22} {:>13} {:>13} {:>9} {:>9}  {}",
            check.law,
            check.case,
            check.quantity,
            significant(check.expected, 6),
            number(check.measured),
            error(check.error),
            error(Some(check.tolerance)),
            if check.passed() { "yes" } else { "NO" },
        );
        if let Some(failure) = &check.failure {
            let _ = writeln!(text, "{:<16} {failure}", "");
        }
    }
    text
}

/// A number with so many significant digits.
pub(crate) fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let magnitude = value.abs().log10().floor();
    if !(-4.0..7.0).contains(&magnitude) {
        return format!("{value:.*e}", digits.saturating_sub(2));
    }
    let decimals = (digits as f64 - 1.0 - magnitude).max(0.0) as usize;
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_session::Silent;

    #[test]
    fn errors_are_shares_of_the_expected_value_and_failures_are_kept() {
        const SHARE: Tolerance = Tolerance::value("x", 0.02);
        const NOTHING: Tolerance = Tolerance::zero("x", "ten", 0.02);
        let mut silent = Silent;
        let mut cases = Cases::new(&mut silent);
        cases.tolerances = &[SHARE, NOTHING];
        cases
            .measure("near", Expected::value(SHARE, 2.0), || Ok(2.02))
            .unwrap();
        cases
            .measure("far", Expected::zero(NOTHING, 10.0), || Ok(-1.0))
            .unwrap();
        cases
            .measure("none", Expected::value(SHARE, 1.0), || Ok(f64::NAN))
            .unwrap();
        let checks = cases.finish();
        assert!((checks[0].error.unwrap() - 0.01).abs() < 1e-12);
        assert!((checks[1].error.unwrap() - 0.1).abs() < 1e-12);
        let passed: Vec<_> = checks.iter().map(Check::passed).collect();
        assert_eq!(passed, [true, false, false]);
        assert!(checks[2].failure.is_some());
        assert!(table(&checks).lines().count() == 5);
    }

    #[test]
    fn a_check_with_a_tolerance_that_its_law_does_not_declare_fails() {
        const DECLARED: Tolerance = Tolerance::value("x", 0.02);
        let mut silent = Silent;
        let mut cases = Cases::new(&mut silent);
        cases.tolerances = &[DECLARED];
        let wider = Tolerance::value("x", 0.2);
        for (tolerance, share) in [(DECLARED, 0.01), (DECLARED, 0.5), (wider, 0.01)] {
            let expected = Expected::value(tolerance, 2.0).within(share);
            cases.measure("exact", expected, || Ok(2.0)).unwrap();
        }
        let checks = cases.finish();
        let allowed: Vec<f64> = checks.iter().map(|c| c.tolerance).collect();
        assert_eq!(allowed, [0.01, 0.02, 0.01]);
        let passed: Vec<bool> = checks.iter().map(Check::passed).collect();
        assert_eq!(passed, [true, true, false]);
    }

    #[test]
    fn numbers_keep_their_significant_digits() {
        assert_eq!(significant(1234.5678, 6), "1234.57");
        assert_eq!(significant(0.0, 6), "0");
        assert_eq!(significant(1.0e-9, 4), "1.00e-9");
    }
}
