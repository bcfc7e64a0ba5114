//! Fixed keywords of the pattern format.

use super::item::FieldsOfKind;
use toile_pattern::{
    BodyPart, Bridge, Corner, Facing, LineKind, NapRule, NotchKind, PleatKind, Pressed, Role, Side,
    Spread, Turned,
};

/// Version of the format this program writes.
pub const VERSION: u32 = 2;

/// Names of body parts.
pub const PARTS: &[(&str, BodyPart)] = &[
    ("trunk", BodyPart::Trunk),
    ("head", BodyPart::Head),
    ("left_arm", BodyPart::LeftArm),
    ("right_arm", BodyPart::RightArm),
    ("left_leg", BodyPart::LeftLeg),
    ("right_leg", BodyPart::RightLeg),
];

/// Names of sides.
pub const FACINGS: &[(&str, Facing)] = &[
    ("front", Facing::Front),
    ("back", Facing::Back),
    ("left", Facing::Left),
    ("right", Facing::Right),
    ("around", Facing::Around),
    ("over", Facing::Over),
];

/// The word for a choice.
pub fn word<T: PartialEq>(choices: &[(&'static str, T)], choice: &T) -> &'static str {
    choices
        .iter()
        .find(|(_, known)| known == choice)
        .map_or("", |(word, _)| word)
}

/// Names of line kinds.
pub const LINES: &[(&str, LineKind)] = &[
    ("outline", LineKind::Outline),
    ("hole", LineKind::Hole),
    ("internal", LineKind::Internal),
];

/// Names of corner kinds of cut lines.
pub const CORNERS: &[(&str, Corner)] = &[
    ("mitre", Corner::Mitre),
    ("bevel", Corner::Bevel),
    ("square", Corner::Square),
    ("extended", Corner::Extended),
    ("mirrored", Corner::Mirrored),
];

/// Names of the legs a dart is pressed towards.
pub const PRESSED: &[(&str, Pressed)] = &[("before", Pressed::Before), ("after", Pressed::After)];

/// Names of pleats.
pub const PLEATS: &[(&str, PleatKind)] = &[
    ("knife", PleatKind::Knife),
    ("box", PleatKind::Box),
    ("inverted", PleatKind::Inverted),
];

/// Names of notch kinds.
pub const NOTCHES: &[(&str, NotchKind)] = &[
    ("slit", NotchKind::Slit),
    ("v", NotchKind::V),
    ("castle", NotchKind::Castle),
    ("t", NotchKind::T),
    ("check", NotchKind::Check),
];

/// Names of the ways pieces may point.
pub const NAPS: &[(&str, NapRule)] = &[
    ("none", NapRule::None),
    ("one-way", NapRule::OneWay),
    ("per-garment", NapRule::PerGarment),
];

/// Names of the ways fabric is spread.
pub const SPREADS: &[(&str, Spread)] = &[
    ("open", Spread::Open),
    ("folded", Spread::Folded),
    ("tubular", Spread::Tubular),
    ("face-to-face", Spread::FaceToFace),
];

/// Names of what operations make.
pub const ROLES: &[(&str, Role)] = &[
    ("leg", Role::Leg),
    ("apex", Role::Apex),
    ("mouth", Role::Mouth),
    ("diamond", Role::Diamond),
    ("opening", Role::Opening),
    ("split", Role::Split),
    ("underlay", Role::Underlay),
    ("crease", Role::Crease),
    ("placement", Role::Placement),
];

/// Names of the sides of a split.
pub const SIDES: &[(&str, Side)] = &[("left", Side::Left), ("right", Side::Right)];

/// Names of the parts that pivots turn.
pub const TURNED: &[(&str, Turned)] =
    &[("from_dart", Turned::FromDart), ("to_dart", Turned::ToDart)];

/// Names of how an outline goes across an opening.
pub const BRIDGES: &[(&str, Bridge)] =
    &[("straight", Bridge::Straight), ("smooth", Bridge::Smooth)];

/// Where a panel is worn: at a place, or round a part of the body.
pub const WORN: &[FieldsOfKind<'_>] = &[
    (1, &["translation_m", "rotation_xyzw"]),
    (0, &["part", "facing", "level"]),
];
