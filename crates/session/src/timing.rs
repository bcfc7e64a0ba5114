//! Wall and processor time of the stages of work. Never part of any file but `timing.json`.

use serde::Serialize;
use std::collections::BTreeMap;
use std::time::Instant;

/// Wall and processor time by stage since a pattern was opened.
#[derive(Clone, Debug, Default)]
pub(crate) struct Timing {
    stages: BTreeMap<String, f64>,
    /// Processor time when the pattern was opened (s).
    cpu_start: Option<f64>,
    /// Wall time of all stages (s).
    wall: f64,
}

#[derive(Serialize)]
struct TimingFile {
    wall_s: f64,
    cpu_s: Option<f64>,
    stages_s: BTreeMap<String, f64>,
}

impl Timing {
    /// Resets all times to zero.
    pub fn restart(&mut self) {
        *self = Self {
            cpu_start: cpu_seconds(),
            ..Self::default()
        };
    }

    /// Adds the time since `start` to a stage.
    pub fn add(&mut self, stage: &str, start: Instant) {
        self.add_seconds(stage, start.elapsed().as_secs_f64());
    }

    /// Adds a time (s) to a stage.
    pub fn add_seconds(&mut self, stage: &str, seconds: f64) {
        *self.stages.entry(stage.to_owned()).or_default() += seconds;
        self.wall += seconds;
    }

    /// The content of `timing.json`.
    pub fn to_json(&self) -> String {
        let file = TimingFile {
            wall_s: self.wall,
            cpu_s: cpu_seconds()
                .zip(self.cpu_start)
                .map(|(now, start)| now - start),
            stages_s: self.stages.clone(),
        };
        // Finite numbers and plain names: this cannot fail.
        serde_json::to_string_pretty(&file).unwrap_or_default() + "\n"
    }
}

/// Processor time of this process so far (s), where the system tells it (Linux: fields 14 and 15 of
/// `/proc/self/stat`, in hundredths of a second).
pub fn cpu_seconds() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/stat").ok()?;
    // The second field is a name in brackets that may hold spaces.
    let after_name = text.rsplit_once(')')?.1;
    let mut fields = after_name.split_whitespace().skip(11);
    let user: f64 = fields.next()?.parse().ok()?;
    let system: f64 = fields.next()?.parse().ok()?;
    Some((user + system) / 100.0)
}
