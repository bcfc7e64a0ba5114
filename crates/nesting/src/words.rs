//! The referee's violations in sentences.

use crate::{Side, Violation};

fn mm(metres: f64) -> String {
    format!("{:.2} mm", metres * 1e3)
}

impl Violation {
    /// The fault, the place and the remedy. `name` gives the name of a placement.
    pub fn in_words(&self, name: &dyn Fn(usize) -> String) -> String {
        match self {
            Self::Overlap {
                pair, depth, area, ..
            } => format!(
                "{} and {} overlap by {}, {:.2} cm2 are cut twice; move them apart",
                name(pair[0]),
                name(pair[1]),
                mm(*depth),
                area * 1e4
            ),
            Self::Gap {
                pair,
                distance,
                needed,
            } => format!(
                "{} and {} lie {} apart and need {}; move them apart",
                name(pair[0]),
                name(pair[1]),
                mm(*distance),
                mm(*needed)
            ),
            Self::Outside {
                placement,
                side,
                by,
            } => format!(
                "{} sticks out by {} ({}); move it in",
                name(*placement),
                mm(*by),
                match side {
                    Side::Start => "at the start",
                    Side::End => "at the end",
                    Side::Lower => "at the lower selvedge",
                    Side::Upper => "at the upper selvedge",
                }
            ),
            Self::Nap { pair, bundle } => format!(
                "{} and {} of garment {} run opposite ways on fabric with a nap; turn one of them",
                name(pair[0]),
                name(pair[1]),
                bundle + 1
            ),
            Self::Length { stated, found } => format!(
                "the length is said to be {} and is {}; correct it",
                mm(*stated),
                mm(*found)
            ),
            Self::Copy { item, copy, count } => format!(
                "copy {copy} of piece number {} is laid or listed {count} times; lay it once",
                item + 1
            ),
            _ => self.of_one(name),
        }
    }

    /// The sentence for a violation that concerns a single piece.
    fn of_one(&self, name: &dyn Fn(usize) -> String) -> String {
        match self {
            Self::Orientation {
                placement,
                turn,
                mirrored,
            } => format!(
                "{} is turned by {:.1} degrees{}, which its grain, the nap or its pair forbid; turn it back",
                name(*placement),
                turn.to_degrees(),
                if *mirrored { " and lies face down" } else { "" }
            ),
            Self::OffFold { placement, by } if by.is_finite() => format!(
                "{} lies {} beside the fold; move it onto the fold",
                name(*placement),
                mm(*by)
            ),
            Self::OffFold { placement, .. } => format!(
                "{} does not have its fold edge at a fold; turn it round or over",
                name(*placement)
            ),
            Self::OffPrint { placement, by } => format!(
                "{} lies beside the print, by {} along the warp and {} across; move it",
                name(*placement),
                mm(by.x),
                mm(by.y)
            ),
            Self::OnFlaw {
                placement, flaw, ..
            } => format!(
                "{} lies on flaw {} or too near; move it away",
                name(*placement),
                flaw + 1
            ),
            Self::Moved { placement } => {
                format!(
                    "{} does not lie where it is locked; move it back",
                    name(*placement)
                )
            }
            Self::Nonsense { placement } => {
                format!("{} lies nowhere; give it a place", name(*placement))
            }
            _ => String::new(),
        }
    }
}
