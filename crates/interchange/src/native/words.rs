//! Words of the format that are fixed.

use toile_pattern::{BodyPart, Facing};

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
