//! The `toile` command: sewing patterns checked, laid out, sewn and draped.
//!
//! Exit status: 0 on success, 2 on bad input, 1 on failure, 3 where all was made and written but the verdict on it is
//! bad.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod arguments;
mod bar;
mod batch_arguments;
mod batch_commands;
mod body_options;
mod check_commands;
mod convert_arguments;
mod convert_command;
mod flatten_arguments;
mod flatten_command;
mod lab_commands;
mod nest_arguments;
mod nest_commands;
mod output;
mod print_arguments;
mod print_commands;
mod read_options;
mod seams_arguments;
mod seams_command;
mod session_commands;
mod tool_commands;
mod values;

use arguments::{Arguments, Task};
use clap::Parser;
use output::{Failure, Made, Output};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use toile_session::start_log;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let output = Output::new(arguments.json);
    if let Err(words) = start_log() {
        return output.fail(&Failure::bad_input(words));
    }
    let outcome = run(arguments.task.unwrap_or_else(sample), &output);
    match outcome {
        Ok(made) => output.finish(made),
        Err(failure) => output.fail(&failure),
    }
}

/// What is done when nothing is asked for: the sample T-shirt into `out/`.
fn sample() -> Task {
    let shipped = Path::new("patterns/t-shirt.toile.json");
    let pattern = if shipped.is_file() {
        shipped.to_owned()
    } else {
        PathBuf::from(toile_session::SAMPLE)
    };
    Task::Make(arguments::Make::of(pattern, "out"))
}

fn run(task: Task, output: &Output) -> Result<Made, Failure> {
    let report = match task {
        Task::Make(make) => return session_commands::make(&make, output),
        Task::Drape(drape) => return session_commands::drape(&drape, output),
        Task::Check(check) => check_commands::check(&check, output),
        Task::Batch(batch) => return batch_commands::batch(&batch, output),
        Task::Job(job) => return batch_commands::job(&job, output),
        Task::Replay(replay) => return session_commands::replay(&replay, output),
        Task::Convert(convert) => convert_command::convert(&convert, output),
        Task::Seams(seams) => seams_command::seams(&seams, output),
        Task::Flatten(flatten) => flatten_command::flatten(&flatten, output),
        Task::Mesh(mesh) => tool_commands::mesh(&mesh, output),
        Task::Print(print) => print_commands::print(&print, output),
        Task::Nest(nest) => nest_commands::nest(&nest, output),
        Task::Body(body) => tool_commands::body(&body, output),
        Task::Frames(frames) => tool_commands::frames(&frames, output),
        Task::Run(run) => return tool_commands::run(&run, output),
        Task::Validate(validate) => lab_commands::validate(&validate, output),
        Task::Chart(chart) => lab_commands::chart(&chart, output),
        Task::Stability(stability) => lab_commands::stability(&stability, output),
        Task::Accuracy(accuracy) => lab_commands::accuracy(&accuracy, output),
        Task::Bench(bench) => lab_commands::bench(&bench, output),
    };
    report.map(Made::from)
}
