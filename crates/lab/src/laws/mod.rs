//! The laws: small scenes with a known outcome.

mod bounce;
mod buckling;
mod cantilever;
mod capstan;
mod drape;
mod friction;
mod hang;
mod motion;
mod order;
mod stick_slip;
mod strain;
mod swing;

pub use cantilever::{Resolved, locking};
pub use drape::{Drape, cusick};

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
pub const LAWS: [Law; 23] = [
    Law {
        name: "cantilever",
        title: "a strip clamped horizontally bends by its weight: drop over reach against the heavy elastica, four kinds of mesh",
        run: cantilever::heavy,
    },
    Law {
        name: "resolution",
        title: "the strip and the hang at 5 to 40 elements and membrane stiffness Y L^2 / D of 1e4 to 1e8",
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
    Law {
        name: "patch",
        title: "a linear displacement gives the same stress everywhere",
        run: strain::patch,
    },
    Law {
        name: "rigid",
        title: "a rigid motion makes no force",
        run: strain::rigid,
    },
    Law {
        name: "uniaxial",
        title: "a strip drawn out pulls by Saint Venant and Kirchhoff's law",
        run: strain::uniaxial,
    },
    Law {
        name: "picture-frame",
        title: "a sheared frame works by the shear stiffness",
        run: strain::picture_frame,
    },
    Law {
        name: "hang",
        title: "a hung strip lengthens by its weight and carries it",
        run: hang::elastic,
    },
    Law {
        name: "catenary",
        title: "a strip slung between two supports hangs as a catenary",
        run: hang::catenary,
    },
    Law {
        name: "swing",
        title: "frequencies of a hung strip: half the zeros of J0",
        run: swing::hanging,
    },
    Law {
        name: "vibration",
        title: "frequency of a clamped strip",
        run: swing::vibrating,
    },
    Law {
        name: "buckling",
        title: "a strip on edge gives way sideways at 12.85 sqrt(2)",
        run: buckling::lateral,
    },
    Law {
        name: "flight",
        title: "momentum is kept in free flight",
        run: motion::flight,
    },
    Law {
        name: "fall",
        title: "a cloth let go falls by g t^2 / 2",
        run: motion::fall,
    },
    Law {
        name: "terminal",
        title: "a cloth falling through air reaches a terminal velocity",
        run: motion::terminal,
    },
    Law {
        name: "corner",
        title: "a cloth held at one corner comes to rest",
        run: motion::corner,
    },
    Law {
        name: "order-in-time",
        title: "errors fall with the order of the method",
        run: order::in_time_order,
    },
    Law {
        name: "incline",
        title: "a cloth on an incline sticks or slides by Coulomb's law",
        run: friction::incline,
    },
    Law {
        name: "capstan",
        title: "a strip drawn over a cylinder pulls by exp(mu phi) more on one side than on the other",
        run: capstan::capstan,
    },
    Law {
        name: "stick-slip",
        title: "a strip pushed down on a table sticks while friction bears what the propped elastica asks",
        run: stick_slip::stick_slip,
    },
    Law {
        name: "bounce",
        title: "a cloth dropped flat from h comes back to e^2 h",
        run: bounce::bounce,
    },
    Law {
        name: "cusick",
        title: "the drape coefficient rises with the bending length",
        run: drape::rising,
    },
];

/// Measures the laws named, or all.
///
/// # Errors
/// A name that is no law; the watcher asked to stop. Failed simulations are failed checks.
pub fn validate(names: &[String], watcher: &mut dyn Watcher) -> Result<Vec<Check>, LabError> {
    let known = || LAWS.map(|law| law.name).join(", ");
    if let Some(name) = names
        .iter()
        .find(|n| LAWS.iter().all(|law| law.name != **n))
    {
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
