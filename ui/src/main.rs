//! Opens the window: `toile-ui [FILE]`; without a file on its first page. Or shows a figure in motion:
//! `toile-ui --figure NAME PATTERN…`.

use std::path::PathBuf;
use std::process::ExitCode;
use toile_session::{RealtimeRun, Silent, start_log, write_atomically};
use toile_ui::{Beginning, FigureTask, FigureWindow, ToileApp};

fn main() -> ExitCode {
    if let Err(error) = start_log() {
        return fail(&error);
    }
    match FigureTask::read(std::env::args_os().skip(1)) {
        Ok(None) => open_document(),
        Ok(Some(task)) => show_figure(&task).unwrap_or_else(|error| fail(&error)),
        Err(error) => fail(&error),
    }
}

/// Dresses a figure, and shows it in a window or writes a picture of it into a file.
fn show_figure(task: &FigureTask) -> Result<ExitCode, String> {
    let words = |error: toile_session::SessionError| error.to_string();
    let mut run = RealtimeRun::dressed(task.figure, &task.patterns, &mut Silent).map_err(words)?;
    if let Some((keys, path)) = &task.pictures {
        let png = run.pictures(keys, PICTURE).map_err(words)?;
        write_atomically(path, &png).map_err(|error| error.to_string())?;
        return Ok(ExitCode::SUCCESS);
    }
    let options = eframe::NativeOptions {
        renderer: eframe::Renderer::Wgpu,
        ..Default::default()
    };
    let opened = eframe::run_native(
        "toile figure",
        options,
        Box::new(move |creation| {
            let state = creation.wgpu_render_state.as_ref();
            Ok(Box::new(FigureWindow::new(run, state)))
        }),
    );
    Ok(ended(opened))
}

/// Size of each picture of a figure (pixels).
const PICTURE: [usize; 2] = [360, 640];

fn open_document() -> ExitCode {
    let beginning = Beginning {
        file: std::env::args_os().nth(1).map(PathBuf::from),
        folder: toile_session::state_folder(),
    };
    let options = eframe::NativeOptions {
        viewport: beginning.viewport(),
        renderer: eframe::Renderer::Wgpu,
        ..Default::default()
    };
    let opened = eframe::run_native(
        "toile",
        options,
        Box::new(move |creation| {
            let state = creation.wgpu_render_state.as_ref();
            Ok(Box::new(ToileApp::new(
                &creation.egui_ctx,
                state,
                beginning,
            )))
        }),
    );
    ended(opened)
}

fn ended(opened: eframe::Result) -> ExitCode {
    match opened {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            complain(&error.to_string());
            ExitCode::FAILURE
        }
    }
}

/// Reports on standard error why something failed.
#[allow(clippy::print_stderr)]
fn fail(error: &str) -> ExitCode {
    eprintln!("toile-ui: {error}");
    ExitCode::FAILURE
}

/// Reports on standard error why no window opened.
#[allow(clippy::print_stderr)]
fn complain(error: &str) {
    eprintln!("toile-ui: no window could be opened: {error}");
    eprintln!(
        "toile-ui: a graphical display and a graphics driver are needed; `toile make` works without"
    );
}
