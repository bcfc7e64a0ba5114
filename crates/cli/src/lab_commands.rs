//! Commands of the laboratory: laws, chart, stability, benchmarks.

use crate::arguments::Validate;
use crate::bar::Bar;
use crate::output::{Failure, Output, count};
use serde_json::{Value, json};
use toile_lab::{Check, LAWS, LabError};

impl From<LabError> for Failure {
    fn from(error: LabError) -> Self {
        match error {
            LabError::Unknown { .. } => Self::bad_input(error),
            other => Self::failed(other),
        }
    }
}

/// The laws.
pub fn validate(validate: &Validate, output: &Output) -> Result<Value, Failure> {
    if validate.list {
        for law in &LAWS {
            output.say(format!("{:<16} {}", law.name, law.title));
        }
        let names: Vec<Value> = LAWS
            .iter()
            .map(|law| json!({ "name": law.name, "title": law.title }))
            .collect();
        return Ok(json!({ "laws": names }));
    }
    let checks = toile_lab::validate(&validate.laws, &mut Bar::new())?;
    output.say(toile_lab::table(&checks));
    let failed = checks.iter().filter(|check| !check.passed()).count();
    let listed: Vec<Value> = checks
        .iter()
        .map(|check| {
            let mut value = serde_json::to_value(check).unwrap_or_default();
            value["pass"] = check.passed().into();
            value
        })
        .collect();
    let report = json!({ "checks": listed, "failed": failed });
    let summary = format!("{} of {} failed", failed, count(checks.len(), "check"));
    if failed > 0 {
        return Err(Failure::failed(summary).with_report(report));
    }
    let seconds: f64 = checks.iter().map(|check: &Check| check.seconds).sum();
    output.say(format!(
        "all {} passed in {seconds:.1} s",
        count(checks.len(), "check")
    ));
    Ok(report)
}
