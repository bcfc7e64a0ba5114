//! Template figures: primitives and joints before any measurement is applied.

#[path = "template_man.rs"]
mod man;
#[path = "template_mean.rs"]
mod mean;
#[path = "template_woman.rs"]
mod woman;

use crate::{Part, Primitive};
use serde::{Deserialize, Serialize};
use toile_measure::{Build, Measurements};

/// Which template a mannequin is grown from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Figure {
    /// An adult woman.
    Woman,
    /// An adult man.
    Man,
    /// The mean of both.
    Mean,
    /// A child of 2 years.
    #[serde(rename = "child-2")]
    Child2,
    /// A child of 4 years.
    #[serde(rename = "child-4")]
    Child4,
    /// A child of 6 years.
    #[serde(rename = "child-6")]
    Child6,
    /// A child of 8 years.
    #[serde(rename = "child-8")]
    Child8,
    /// A child of 10 years.
    #[serde(rename = "child-10")]
    Child10,
    /// A child of 12 years.
    #[serde(rename = "child-12")]
    Child12,
    /// A child of 14 years.
    #[serde(rename = "child-14")]
    Child14,
}

impl Figure {
    /// How many there are.
    pub const COUNT: usize = 10;

    /// All figures, the adults first.
    pub const ALL: [Figure; Self::COUNT] = [
        Figure::Woman,
        Figure::Man,
        Figure::Mean,
        Figure::Child2,
        Figure::Child4,
        Figure::Child6,
        Figure::Child8,
        Figure::Child10,
        Figure::Child12,
        Figure::Child14,
    ];

    /// The name on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Figure::Woman => "woman",
            Figure::Man => "man",
            Figure::Mean => "mean",
            Figure::Child2 => "child-2",
            Figure::Child4 => "child-4",
            Figure::Child6 => "child-6",
            Figure::Child8 => "child-8",
            Figure::Child10 => "child-10",
            Figure::Child12 => "child-12",
            Figure::Child14 => "child-14",
        }
    }

    /// Age of a child [years]; none for an adult.
    pub fn age(self) -> Option<u8> {
        match self {
            Figure::Woman | Figure::Man | Figure::Mean => None,
            child => Some(2 * (child as u8 - Figure::Child2 as u8 + 1)),
        }
    }

    /// The average body of the figure: the measurements a garment is drawn from.
    pub fn average(self) -> Measurements {
        Measurements::average(self.build())
    }

    /// Whose statistics predict what was not measured.
    pub fn build(self) -> Build {
        match self {
            Figure::Woman => Build::Woman,
            Figure::Man => Build::Man,
            Figure::Mean => Build::Either,
            child => Build::Child(child.age().unwrap_or(8)),
        }
    }
}

/// Joint centres of the left side and the middle [m].
pub(crate) struct Joints {
    pub(crate) shoulder: [f64; 3],
    pub(crate) elbow: [f64; 3],
    pub(crate) wrist: [f64; 3],
    pub(crate) hip: [f64; 3],
    pub(crate) knee: [f64; 3],
    pub(crate) ankle: [f64; 3],
    pub(crate) toe: [f64; 3],
    pub(crate) pelvis: [f64; 3],
    pub(crate) chest: [f64; 3],
    pub(crate) neck: [f64; 3],
    pub(crate) head: [f64; 3],
}

/// A template as it is stored. Rows: centre, effective semi-axes [m], rotation vector [rad]. Rows
/// of trunk and head off the middle stand for a pair; arm and leg are the left ones.
pub(crate) struct Table {
    height: f64,
    crotch: f64,
    joints: Joints,
    trunk: &'static [[f64; 9]],
    head: &'static [[f64; 9]],
    arm: &'static [[f64; 9]],
    leg: &'static [[f64; 9]],
}

/// A template figure.
pub(crate) struct Template {
    /// Floor to crown [m].
    pub(crate) height: f64,
    /// Height of the crotch [m].
    pub(crate) crotch: f64,
    pub(crate) joints: &'static Joints,
    /// Primitives of both sides.
    pub(crate) primitives: Vec<Primitive>,
}

impl Template {
    /// The template of a figure.
    pub(crate) fn of(figure: Figure) -> Self {
        let table: &'static Table = match figure {
            Figure::Woman => &woman::TABLE,
            Figure::Man => &man::TABLE,
            // A child has the adult's form at its own proportions.
            _ => &mean::TABLE,
        };
        let mut primitives = Vec::new();
        let rows = [
            (Part::Trunk, table.trunk),
            (Part::Head, table.head),
            (Part::LeftArm, table.arm),
            (Part::LeftLeg, table.leg),
        ];
        for (part, rows) in rows {
            primitives.extend(rows.iter().map(|&row| from_row(part, row)));
        }
        Self {
            height: table.height,
            crotch: table.crotch,
            joints: &table.joints,
            primitives: crate::describe::both_sides(primitives),
        }
    }
}

fn from_row(part: Part, row: [f64; 9]) -> Primitive {
    let [x, y, z, a, b, c, u, v, w] = row;
    Primitive {
        part,
        centre: [x, y, z],
        radii: [a, b, c],
        rotation: [u, v, w],
    }
}
