//! A garment taken the whole way by the application's commands.

use toile_drape::{GarmentRun, Measures, Stage};
use toile_session::{Command, Session, Silent};

/// Executes commands, drapes what they set up, and measures it.
pub fn worn(commands: impl IntoIterator<Item = Command>) -> Result<(GarmentRun, Measures), String> {
    let mut session = Session::new();
    for command in commands {
        session
            .execute(command, &mut Silent)
            .map_err(|error| error.to_string())?;
    }
    let job = session.garment_setup().map_err(|error| error.to_string())?;
    let mut run = GarmentRun::new(job.setup).map_err(|error| error.to_string())?;
    while run.progress().stage != Stage::Finished {
        run.advance().map_err(|error| error.to_string())?;
    }
    let measures = run.measure();
    Ok((run, measures))
}
