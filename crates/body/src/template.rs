//! Template figures: primitives and joints before any measurement is applied.

#[path = "template_man.rs"]
mod man;
#[path = "template_mean.rs"]
mod mean;
#[path = "template_woman.rs"]
mod woman;

use crate::rigging::Rigging;
use crate::sides::both_sides;
use crate::{Part, Primitive};
use serde::{Deserialize, Serialize};
use toile_measure::{Build, Measurements};

/// The figures with their names on the command line and in files, each declared once.
macro_rules! figures {
    ($($(#[$docs:meta])* $figure:ident = $name:literal,)*) => {
        /// The template that a mannequin is grown from.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
        pub enum Figure {
            $($(#[$docs])* #[serde(rename = $name)] $figure,)*
        }

        impl Figure {
            /// Number of figures.
            pub const COUNT: usize = [$($name),*].len();

            /// All figures, the adults first.
            pub const ALL: [Figure; Self::COUNT] = [$(Figure::$figure),*];

            /// Name on the command line and in files.
            pub fn name(self) -> &'static str {
                match self {
                    $(Figure::$figure => $name,)*
                }
            }
        }
    };
}

figures! {
    /// An adult woman.
    Woman = "woman",
    /// An adult man.
    Man = "man",
    /// The mean of woman and man.
    Mean = "mean",
    /// A woman's trunk without head, arms and legs, on a stand.
    DressForm = "dress-form",
    /// A child of 2 years.
    Child2 = "child-2",
    /// A child of 4 years.
    Child4 = "child-4",
    /// A child of 6 years.
    Child6 = "child-6",
    /// A child of 8 years.
    Child8 = "child-8",
    /// A child of 10 years.
    Child10 = "child-10",
    /// A child of 12 years.
    Child12 = "child-12",
    /// A child of 14 years.
    Child14 = "child-14",
}

impl Figure {
    /// Age of a child (years); `None` for an adult.
    pub fn age(self) -> Option<u8> {
        match self {
            Figure::Woman | Figure::Man | Figure::Mean | Figure::DressForm => None,
            child => Some(2 * (child as u8 - Figure::Child2 as u8 + 1)),
        }
    }

    /// The average body of the figure, for which garments are drafted.
    pub fn average(self) -> Measurements {
        Measurements::average(self.build())
    }

    /// The build whose statistics predict missing measurements.
    pub fn build(self) -> Build {
        match self {
            Figure::Woman | Figure::DressForm => Build::Woman,
            Figure::Man => Build::Man,
            Figure::Mean => Build::Either,
            child => Build::Child(child.age().unwrap_or(8)),
        }
    }
}

/// Joint centres of the left side and the median plane.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Joints {
    /// Shoulder joint (m).
    pub shoulder: [f64; 3],
    /// Elbow (m).
    pub elbow: [f64; 3],
    /// Wrist (m).
    pub wrist: [f64; 3],
    /// Hip joint (m).
    pub hip: [f64; 3],
    /// Knee (m).
    pub knee: [f64; 3],
    /// Ankle (m).
    pub ankle: [f64; 3],
    /// Tip of the foot (m).
    pub toe: [f64; 3],
    /// Middle of the pelvis (m).
    pub pelvis: [f64; 3],
    /// Spine at the chest (m).
    pub chest: [f64; 3],
    /// Base of the neck (m).
    pub neck: [f64; 3],
    /// Base of the skull (m).
    pub head: [f64; 3],
}

/// Levels, joints and lengths that are needed besides the primitives to cast the skin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BodyFrame {
    /// Height from floor to crown (m).
    pub height: f64,
    /// Height of the crotch (m).
    pub crotch: f64,
    /// Height of the armpits (m).
    pub armpit: f64,
    /// Distance from the wrist to the last ring of the hand (m).
    pub hand: f64,
    /// A distance from the median plane that lies outside the neck and below the shoulder's slope (m).
    pub neck_radius: f64,
    /// Joint centres.
    pub joints: Joints,
    /// Positions of fine features, if the body has face and thumbs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub features: Option<Features>,
}

/// Features of a body with nose, ears and thumbs: its head and hands are cast finely.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Features {
    /// Middle of the left thumb where it is clear of the palm, and near its tip (m).
    pub thumb: [[f64; 3]; 2],
}

/// A template as it is stored. Each entry is a primitive: centre, effective semi-axes (m), rotation vector
/// (rad). Primitives of trunk and head off the median plane stand for a pair; arm and leg are the left ones.
pub(crate) struct Table {
    height: f64,
    crotch: f64,
    joints: Joints,
    /// Middle of the thumb where it is clear of the palm, and near its tip (m).
    thumb: [[f64; 3]; 2],
    trunk: &'static [[f64; 9]],
    /// Neck and skull.
    head: &'static [[f64; 9]],
    /// Protruding parts: nose, brow, lids, cheeks, mouth, chin, jaw, ears.
    face: &'static [[f64; 9]],
    /// Arm down to the wrist.
    arm: &'static [[f64; 9]],
    /// Palm, fingers, thumb.
    hand: &'static [[f64; 9]],
    leg: &'static [[f64; 9]],
}

/// A template figure.
pub(crate) struct Template {
    /// Height from floor to crown (m).
    pub(crate) height: f64,
    /// Height of the crotch (m).
    pub(crate) crotch: f64,
    pub(crate) joints: Joints,
    /// Height of the armpits (m); `None` if they are found on the primitives.
    pub(crate) armpit: Option<f64>,
    /// Distance from the wrist to the last ring of the hand (m).
    pub(crate) hand: f64,
    /// A distance from the median plane that lies outside the neck and below the shoulder's slope (m): rays
    /// of the rows over shoulder and neck cross only farther out.
    pub(crate) neck_radius: f64,
    /// Positions of fine features, if the body has face and thumbs.
    pub(crate) features: Option<Features>,
    /// Primitives of both sides.
    pub(crate) primitives: Vec<Primitive>,
    /// Properties of the primitives of the left side and the median plane that differ from the default.
    pub(crate) rigging: Rigging,
}

/// Distance from the wrist to the last ring of the hand, of a body of 1.7 m (m).
pub(crate) const HAND: f64 = 0.176;
/// The distance `neck_radius` of [`Template`], of a body of 1.7 m (m).
pub(crate) const NECK_RADIUS: f64 = 0.082;

impl Table {
    fn of(figure: Figure) -> &'static Self {
        match figure {
            Figure::Woman | Figure::DressForm => &woman::TABLE,
            Figure::Man => &man::TABLE,
            // A child has the form of the mean adult with its own proportions.
            _ => &mean::TABLE,
        }
    }
}

/// Primitives of the left side and the median plane of a figure's trunk, neck and skull, and of its arm down
/// to the wrist: without face and hands.
pub(crate) fn plain_primitives(figure: Figure) -> Vec<Primitive> {
    let table = Table::of(figure);
    let rows = [
        (Part::Trunk, table.trunk),
        (Part::Head, table.head),
        (Part::LeftArm, table.arm),
    ];
    rows.into_iter()
        .flat_map(|(part, rows)| rows.iter().map(move |&row| from_row(part, row)))
        .collect()
}

impl Template {
    /// The template of a figure.
    pub(crate) fn of(figure: Figure) -> Self {
        let table = Table::of(figure);
        let mut primitives = Vec::new();
        let rows = [
            (Part::Trunk, table.trunk),
            (Part::Head, table.head),
            (Part::Head, table.face),
            (Part::LeftArm, table.arm),
            (Part::LeftArm, table.hand),
            (Part::LeftLeg, table.leg),
        ];
        for (part, rows) in rows {
            primitives.extend(rows.iter().map(|&row| from_row(part, row)));
        }
        let scale = table.height / 1.7;
        Self {
            height: table.height,
            crotch: table.crotch,
            joints: table.joints,
            armpit: None,
            hand: HAND * scale,
            neck_radius: NECK_RADIUS * scale,
            features: Some(Features { thumb: table.thumb }),
            primitives: both_sides(primitives),
            rigging: Rigging::default(),
        }
    }

    /// A template with a given frame and primitives of both sides.
    pub(crate) fn framed(frame: &BodyFrame, primitives: Vec<Primitive>) -> Self {
        Self {
            height: frame.height,
            crotch: frame.crotch,
            joints: frame.joints,
            armpit: Some(frame.armpit),
            hand: frame.hand,
            neck_radius: frame.neck_radius,
            features: frame.features,
            primitives,
            rigging: Rigging::default(),
        }
    }

    /// The frame of the template; `None` for a figure's own template.
    pub(crate) fn frame(&self) -> Option<BodyFrame> {
        Some(BodyFrame {
            height: self.height,
            crotch: self.crotch,
            armpit: self.armpit?,
            hand: self.hand,
            neck_radius: self.neck_radius,
            joints: self.joints,
            features: self.features,
        })
    }
}

fn from_row(part: Part, row: [f64; 9]) -> Primitive {
    let [x, y, z, a, b, c, u, v, w] = row;
    Primitive {
        rotation: [u, v, w],
        ..Primitive::new(part, [x, y, z], [a, b, c])
    }
}
