//! Output: words for people, or one JSON report for programs.
//!
//! # Decided with
//! - [`toile_session::SessionError::is_bad_input`]: bad input or failure;
//! - [`crate::output::Failure`], [`crate::output::Made`]: exit status 2 or 1; 3 for a bad verdict;
//! - [`crate::check_commands::check`]: several files;
//! - [`crate::bar::Bar`]: progress, Ctrl-C;
//! - [`crate::output::words`], [`toile_session::Event`]: events in words;
//! - [`crate::output::meaning`], [`toile_session::ExportFormat`]: what a file is for, by hand.

use serde_json::{Value, json};
use std::fmt::Display;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use toile_session::{Event, SessionError, Shown, Verdict};

/// Why a command was not done, and its exit status.
#[derive(Debug)]
pub struct Failure {
    message: String,
    bad_input: bool,
    /// Whether the message names the file at fault.
    names_file: bool,
    /// Whether files cannot be written.
    unwritten: bool,
    report: Option<Value>,
}

impl Failure {
    /// Something given is wrong.
    pub fn bad_input(message: impl Display) -> Self {
        Self {
            message: message.to_string(),
            bad_input: true,
            names_file: false,
            unwritten: false,
            report: None,
        }
    }

    /// Something was done and did not turn out as it must.
    pub fn failed(message: impl Display) -> Self {
        Self {
            message: message.to_string(),
            bad_input: false,
            names_file: false,
            unwritten: false,
            report: None,
        }
    }

    /// Whether what was given is at fault, and not the work on it.
    pub fn is_bad_input(&self) -> bool {
        self.bad_input
    }

    /// Whether files cannot be written: then neither what was given nor the work on it is at fault.
    pub fn is_unwritten(&self) -> bool {
        self.unwritten
    }

    /// What went wrong, with place and remedy.
    pub fn message(&self) -> &str {
        &self.message
    }

    /// What was found all the same.
    pub fn report(&self) -> Option<&Value> {
        self.report.as_ref()
    }

    /// The same with what was found so far.
    pub fn with_report(self, report: Value) -> Self {
        Self {
            report: Some(report),
            ..self
        }
    }

    /// The same with the file it is about, unless it names it already.
    pub fn about(mut self, file: &Path) -> Self {
        let file = file.display().to_string();
        if !self.names_file && !self.message.contains(&file) {
            self.message = format!("{file}: {}", self.message);
        }
        self
    }
}

impl Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut lines = self.message.lines();
        write!(f, "error: {}", lines.next().unwrap_or_default())?;
        lines.try_for_each(|line| write!(f, "\nerror: {line}"))
    }
}

impl From<SessionError> for Failure {
    fn from(error: SessionError) -> Self {
        Self {
            bad_input: error.is_bad_input(),
            names_file: matches!(
                error,
                SessionError::File(_) | SessionError::Format { .. } | SessionError::Faults { .. }
            ),
            unwritten: matches!(&error, SessionError::File(file) if file.action != "read"),
            message: error.to_string(),
            report: None,
        }
    }
}

/// What a command made.
pub struct Made {
    report: Value,
    /// What the result is that it ought not to be, in a few words; none where it is sound.
    fault: Option<String>,
}

impl Made {
    /// The report for programs, and words for a bad verdict.
    pub fn into_parts(self) -> (Value, Option<String>) {
        (self.report, self.fault)
    }

    /// What was made with the verdict on it, where there is one.
    pub fn judged(report: Value, verdict: Option<&Verdict>) -> Self {
        let bad = verdict.filter(|verdict| !verdict.is_sound());
        Self {
            report,
            fault: bad.map(Verdict::headline),
        }
    }
}

impl From<Value> for Made {
    fn from(report: Value) -> Self {
        Self::judged(report, None)
    }
}

/// Exit status where all was made and written but the verdict on it is bad.
const BAD_VERDICT: u8 = 3;

/// Where results go.
pub struct Output {
    json: bool,
}

impl Output {
    /// Words, or JSON.
    pub fn new(json: bool) -> Self {
        Self { json }
    }

    /// Neither words nor JSON, for a command within a job: its report is taken as a value.
    pub fn silent() -> Self {
        Self::new(true)
    }

    /// Says something to a person.
    pub fn say(&self, words: impl Display) {
        if !self.json {
            print_line(words);
        }
    }

    /// Warns a person.
    pub fn warn(&self, words: impl Display) {
        if !self.json {
            complain(words);
        }
    }

    /// Tells what happened in plain words.
    pub fn print_events(&self, events: &[Event]) {
        for event in events {
            match event {
                Event::Warned { message } => self.warn(format!("note: {message}")),
                other => {
                    if let Some(words) = words(other) {
                        self.say(words);
                    }
                }
            }
        }
    }

    /// Ends with what was made.
    pub fn finish(&self, made: Made) -> ExitCode {
        let is_sound = made.fault.is_none();
        if let Some(fault) = &made.fault {
            self.warn(format_args!(
                "verdict: {fault}; the files show how it ended"
            ));
        }
        if self.json {
            let start = json!({ "ok": is_sound });
            print_line(format_args!("{:#}", merged(start, made.report)));
        }
        match is_sound {
            true => ExitCode::SUCCESS,
            false => ExitCode::from(BAD_VERDICT),
        }
    }

    /// Ends with a failure.
    pub fn fail(&self, failure: &Failure) -> ExitCode {
        complain(failure);
        if self.json {
            let report = failure.report.clone().unwrap_or_else(|| json!({}));
            let start = json!({ "ok": false, "error": failure.message });
            print_line(format_args!("{:#}", merged(start, report)));
        }
        ExitCode::from(if failure.bad_input { 2 } else { 1 })
    }
}

/// A line on stdout. Nothing happens when nobody reads it any more, as after `toile ... | head`:
/// the files are written all the same.
fn print_line(words: impl Display) {
    let _ = writeln!(std::io::stdout(), "{words}");
}

/// A line on stderr.
fn complain(words: impl Display) {
    let _ = writeln!(std::io::stderr(), "{words}");
}

fn merged(mut first: Value, second: Value) -> Value {
    if let (Some(into), Value::Object(from)) = (first.as_object_mut(), second) {
        into.extend(from);
    }
    first
}

fn words(event: &Event) -> Option<String> {
    match event {
        Event::Checked { errors, warnings } => Some(match (errors, warnings) {
            (0, 0) => "checked: no faults".into(),
            _ => format!(
                "checked: {} and {}",
                count(*errors, "error"),
                count(*warnings, "warning")
            ),
        }),
        Event::Nested(summary) => Some(format!(
            "laid out: {} on {}{}, {} wide and {} long, {:.1} % used",
            count(summary.pieces, "piece"),
            summary.fabric,
            summary
                .roll
                .as_ref()
                .map_or_else(String::new, |roll| format!(" ({roll})")),
            Shown(summary.unit).width(summary.width),
            Shown(summary.unit).length(summary.length),
            summary.efficiency * 100.0,
        )),
        Event::Assembled(mesh) => Some(format!(
            "meshed: {}, {} triangles, {} stitches",
            count(mesh.panels, "panel"),
            mesh.triangles,
            mesh.stitches
        )),
        Event::Draped(drape) => Some(format!(
            "{}draped in {} to a net force of {:.1e} of the weight; stretch at most {:.1} % along the warp, {:.1} % along the weft",
            match drape.steps[0] {
                0 => String::new(),
                steps => format!(
                    "sewn in {} to a gap of {:.2} mm, ",
                    count(steps, "step"),
                    drape.seam_gap * 1e3
                ),
            },
            count(drape.steps[1], "step"),
            drape.residual,
            drape.strain_max[0] * 100.0,
            drape.strain_max[1] * 100.0,
        )),
        Event::FilesWritten { paths } => {
            let name = |path: &PathBuf| path.display().to_string();
            let width = paths.iter().map(|path| name(path).chars().count()).max();
            let line = |path: &PathBuf| {
                let width = width.unwrap_or_default();
                format!("wrote {:<width$}  {}", name(path), meaning(path))
            };
            Some(paths.iter().map(line).collect::<Vec<_>>().join("\n"))
        }
        Event::PatternOpened
        | Event::FileRead(_)
        | Event::ProjectChanged { .. }
        | Event::Warned { .. } => None,
    }
}

/// `1 piece`, `2 pieces`.
pub fn count(number: usize, noun: &str) -> String {
    let ending = if number == 1 { "" } else { "s" };
    format!("{number} {noun}{ending}")
}

/// What a file is for.
fn meaning(path: &Path) -> &'static str {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    match &*name {
        "garment.glb" => "the garment for 3D programs, UVs in metres",
        "garment.obj" => "the garment as OBJ, a group for each panel",
        name if name.starts_with("layer-") => "a garment of several by itself",
        "drape.png" => "the garment worn",
        "fit.png" => "how much the cloth is stretched",
        "pieces.pdf" => "the pieces on sheets of A4, at true size",
        "pieces.svg" => "the pieces on one page, at true size",
        "pattern.json" => "the pattern for GarmentCode",
        "pattern.svg" => "the panels in layers, to be drawn on and opened again",
        name if name.starts_with("pattern-") => "the pattern for programs of the trade",
        "report.json" => "what was made, in numbers",
        "timing.json" => "how long it took",
        "journal.jsonl" => "the commands, for `toile replay`",
        name if name.starts_with("marker") && name.ends_with(".svg") => {
            "the pieces on the fabric, at true size"
        }
        "marker-report.pdf" => "report on A4: picture, table of pieces, fabric needed, cost",
        name if name.starts_with("marker") && name.ends_with(".pdf") => {
            "the pieces on the fabric on one page, at true size"
        }
        name if name.starts_with("marker") && name.ends_with(".dxf") => {
            "the pieces on the fabric for drafting programs and cutters, mm"
        }
        name if name.starts_with("marker") && name.ends_with(".plt") => {
            "the pieces on the fabric for plotters, HPGL/2"
        }
        name if name.starts_with("marker") => "the pieces on the fabric, as data",
        _ => "",
    }
}
