//! Opens the window: `toile-ui [FILE]`. Without a file it shows how to begin.

use std::path::PathBuf;
use std::process::ExitCode;
use toile_ui::{Beginning, ToileApp};

fn main() -> ExitCode {
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
    match opened {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            complain(&error.to_string());
            ExitCode::FAILURE
        }
    }
}

/// Says on standard error why there is no window.
#[allow(clippy::print_stderr)]
fn complain(error: &str) {
    eprintln!("toile-ui: no window could be opened: {error}");
    eprintln!(
        "toile-ui: a graphical display and a graphics driver are needed; `toile make` works without"
    );
}
