//! The laws: small scenes with a known outcome.

mod cantilever;
mod drape;
mod fabric;
mod hang;
mod motion;
mod order;
mod strain;
mod swing;
mod buckling;

use crate::LabError;
use crate::check::{Cases, Check};
use toile_session::Watcher;

/// A physical law with its cases.
pub struct Law {
    /// Its name on the command line.
    pub name: &'static str,
    /// What it says.
    pub title: &'static str,
    run: fn(&mut Cases) -> Result<(), LabError>,
}

/// Every law.
pub const LAWS: [Law; 4] = [
    Law {
        name: "cantilever",
        title: "a strip clamped horizontally bends by its weight: drop over reach against the heavy elastica, four kinds of mesh",
        run: cantilever::heavy,
    },
    Law {
        name: "resolution",
        title: "the same at 5 to 40 elements and membrane stiffness Y L^2 / D of 1e4 to 1e8",
        run: cantilever::resolution,
    },
    Law {
        name: "order-in-space",
        title: "the error of the strip falls with the square of the cell",
        run: cantilever::order,
    },
    Law {
        name: "peirce",
        title: "bending length: the overhang whose chord falls by 41.5 degrees (ASTM D1388)",
        run: cantilever::peirce,
    },
];

/// Measures the laws named, or all.
///
/// # Errors
/// A name that is no law; the watcher asked to stop. Failed simulations are failed checks.
pub fn validate(names: &[String], watcher: &mut dyn Watcher) -> Result<Vec<Check>, LabError> {
    let known = || LAWS.map(|law| law.name).join(", ");
    if let Some(name) = names.iter().find(|n| LAWS.iter().all(|law| law.name != **n)) {
        return Err(LabError::Unknown {
            what: "law",
            name: name.clone(),
            known: known(),
        });
    }
    let chosen: Vec<&Law> = LAWS
        .iter()
        .filter(|law| names.is_empty() || names.iter().any(|name| name == law.name))
        .collect();
    let mut cases = Cases::new(watcher);
    for (k, law) in chosen.iter().enumerate() {
        cases.law = law.name;
        cases.share = [k, k + 1].map(|k| k as f64 / chosen.len() as f64);
        (law.run)(&mut cases)?;
    }
    Ok(cases.finish())
}
