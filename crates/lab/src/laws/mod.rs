//! Physical laws that the simulation is validated against: small scenes with a known outcome. The force laws
//! of materials and contact are in crate `drape`.
//!
//! # Decided with
//! - [`crate::laws::LAWS`], [`crate::laws::validate`]: the laws, listed by hand; how they are measured;
//! - [`crate::check::Check`], [`crate::tolerance::Tolerance`]: a number beside the expected one; how near it
//!   must be;
//! - [`crate::law_report::law_table`]: told as Markdown;
//! - [`crate::settle`], [`crate::flat`]: cloth brought to rest; sheets.
//!
//! Run by `lab/tests/laws.rs`, which names the quick ones, and by `toile validate`. Described in
//! `docs/methods/laws.md`.

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
mod viscosity;

pub use cantilever::{Resolved, locking};
pub use drape::{Drape, cusick};

use crate::check::{Cases, Check};
use crate::{LabError, Tolerance};
use toile_session::Watcher;

/// A physical law with its cases.
pub struct Law {
    /// Its name on the command line.
    pub name: &'static str,
    /// Its statement.
    pub title: &'static str,
    /// Every tolerance of its checks; each allows a relative error of 3 % at the most.
    pub tolerances: &'static [Tolerance],
    run: fn(&mut Cases) -> Result<(), LabError>,
}

/// Every law.
pub static LAWS: [Law; 26] = [
    Law {
        name: "cantilever",
        title: "a strip clamped horizontally bends by its weight: drop over reach against the heavy elastica, four kinds of mesh",
        tolerances: &cantilever::HEAVY,
        run: cantilever::heavy,
    },
    Law {
        name: "resolution",
        title: "the strip and the hang at 5 to 40 elements and membrane stiffness Y L^2 / D of 1e4 to 1e8",
        tolerances: &cantilever::RESOLUTION,
        run: cantilever::resolution,
    },
    Law {
        name: "order-in-space",
        title: "the error of the strip falls with the square of the cell",
        tolerances: &cantilever::ORDER,
        run: cantilever::order,
    },
    Law {
        name: "peirce",
        title: "bending length: the overhang whose chord falls by 41.5 degrees (ASTM D1388)",
        tolerances: &cantilever::PEIRCE,
        run: cantilever::peirce,
    },
    Law {
        name: "patch",
        title: "a linear displacement gives the same stress everywhere",
        tolerances: &strain::PATCH,
        run: strain::patch,
    },
    Law {
        name: "rigid",
        title: "a rigid motion makes no force",
        tolerances: &strain::RIGID,
        run: strain::rigid,
    },
    Law {
        name: "uniaxial",
        title: "a strip drawn out pulls by Saint Venant and Kirchhoff's law",
        tolerances: &strain::UNIAXIAL,
        run: strain::uniaxial,
    },
    Law {
        name: "picture-frame",
        title: "a sheared frame works by the shear stiffness",
        tolerances: &strain::PICTURE_FRAME,
        run: strain::picture_frame,
    },
    Law {
        name: "hang",
        title: "a hung strip lengthens by its weight and carries it",
        tolerances: &hang::ELASTIC,
        run: hang::elastic,
    },
    Law {
        name: "catenary",
        title: "a strip slung between two supports hangs as a catenary",
        tolerances: &hang::CATENARY,
        run: hang::catenary,
    },
    Law {
        name: "swing",
        title: "frequencies of a hung strip: half the zeros of J0",
        tolerances: &swing::HANGING,
        run: swing::hanging,
    },
    Law {
        name: "vibration",
        title: "frequency of a clamped strip",
        tolerances: &swing::VIBRATING,
        run: swing::vibrating,
    },
    Law {
        name: "viscous-stretch",
        title: "a viscous strip that was stretched swings out or creeps back by Kelvin and Voigt's law",
        tolerances: &viscosity::STRETCHED,
        run: viscosity::stretched,
    },
    Law {
        name: "viscous-bending",
        title: "a viscous clamped strip vibrates with its damping ratio",
        tolerances: &viscosity::BENT,
        run: viscosity::bent,
    },
    Law {
        name: "buckling",
        title: "a strip on edge gives way sideways at 12.85 sqrt(2)",
        tolerances: &buckling::LATERAL,
        run: buckling::lateral,
    },
    Law {
        name: "flight",
        title: "momentum is kept in free flight",
        tolerances: &motion::FLIGHT,
        run: motion::flight,
    },
    Law {
        name: "fall",
        title: "a cloth let go falls by g t^2 / 2",
        tolerances: &motion::FALL,
        run: motion::fall,
    },
    Law {
        name: "terminal",
        title: "a cloth falling through air reaches a terminal velocity",
        tolerances: &motion::TERMINAL,
        run: motion::terminal,
    },
    Law {
        name: "corner",
        title: "a cloth held at one corner comes to rest",
        tolerances: &motion::CORNER,
        run: motion::corner,
    },
    Law {
        name: "order-in-time",
        title: "errors fall with the order of the method",
        tolerances: &order::IN_TIME,
        run: order::in_time_order,
    },
    Law {
        name: "incline",
        title: "a cloth on an incline sticks or slides by Coulomb's law",
        tolerances: &friction::INCLINE,
        run: friction::incline,
    },
    Law {
        name: "cloth-on-cloth",
        title: "a cloth on a cloth sticks or slides by Coulomb's law",
        tolerances: &friction::INCLINE,
        run: friction::cloth_on_cloth,
    },
    Law {
        name: "capstan",
        title: "a strip drawn over a cylinder pulls by exp(mu phi) more on one side than on the other",
        tolerances: &capstan::CAPSTAN,
        run: capstan::capstan,
    },
    Law {
        name: "stick-slip",
        title: "a strip pushed down on a table sticks while friction bears what the propped elastica asks",
        tolerances: &stick_slip::STICK_SLIP,
        run: stick_slip::stick_slip,
    },
    Law {
        name: "bounce",
        title: "a cloth dropped flat from h comes back to e^2 h",
        tolerances: &bounce::BOUNCE,
        run: bounce::bounce,
    },
    Law {
        name: "cusick",
        title: "the drape coefficient rises with the bending length",
        tolerances: &drape::CUSICK,
        run: drape::rising,
    },
];

/// The laws named, or all, in the order of [`LAWS`].
///
/// # Errors
/// A name that is no law.
pub fn laws_named(names: &[String]) -> Result<Vec<&'static Law>, LabError> {
    let known = || LAWS.each_ref().map(|law| law.name).join(", ");
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
    let chosen = LAWS
        .iter()
        .filter(|law| names.is_empty() || names.iter().any(|name| name == law.name));
    Ok(chosen.collect())
}

/// Measures the laws named, or all.
///
/// # Errors
/// A name that is no law; the watcher asked to stop. Failed simulations are failed checks.
pub fn validate(names: &[String], watcher: &mut dyn Watcher) -> Result<Vec<Check>, LabError> {
    let chosen = laws_named(names)?;
    let mut cases = Cases::new(watcher);
    for (k, law) in chosen.iter().enumerate() {
        cases.law = law.name;
        cases.tolerances = law.tolerances;
        cases.share = [k, k + 1].map(|k| k as f64 / chosen.len() as f64);
        (law.run)(&mut cases)?;
    }
    Ok(cases.finish())
}
