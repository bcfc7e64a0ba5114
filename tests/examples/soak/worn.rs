//! A garment taken the whole way by the application's commands.

use toile_drape::{GarmentRun, GarmentSetup, Measures, Stage};
use toile_session::{Command, Session, Silent};

/// A garment as it ended.
pub struct Worn {
    /// The drape.
    pub run: GarmentRun,
    /// What it measures.
    pub measures: Measures,
    /// Whether it came to rest as nearly as was asked.
    pub at_rest: bool,
}

/// What commands set up to be draped.
pub fn prepared(commands: impl IntoIterator<Item = Command>) -> Result<GarmentSetup, String> {
    let mut session = Session::new();
    for command in commands {
        session
            .execute(command, &mut Silent)
            .map_err(|error| error.to_string())?;
    }
    let job = session.garment_setup().map_err(|error| error.to_string())?;
    Ok(job.setup)
}

/// Executes commands, drapes what they set up, and measures it.
pub fn worn(commands: impl IntoIterator<Item = Command>) -> Result<Worn, String> {
    let setup = prepared(commands)?;
    let asked = setup.rest.residual;
    let mut run = GarmentRun::new(setup).map_err(|error| error.to_string())?;
    while run.progress().stage != Stage::Finished {
        run.advance().map_err(|error| error.to_string())?;
    }
    let measures = run.measure();
    let at_rest = run.progress().residual <= asked;
    Ok(Worn {
        run,
        measures,
        at_rest,
    })
}
