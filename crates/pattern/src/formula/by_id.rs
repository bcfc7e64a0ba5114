//! Notation of parts by id, in journals: ids outlive names.

use crate::{CornerName, Name, PartReference, Role};

/// Text for a part by its ids: `@p47` a point, `@c12` a curve, `@s9` a seam, `@e33:47:48` a stretch.
pub(super) fn ids_of(part: &PartReference) -> String {
    let corner = |corner: CornerName| match corner {
        Name::Drawn(point) => point.0.to_string(),
        Name::Made { by, role, index } => format!("{}.{}.{index}", by.0, role.word()),
    };
    match part {
        PartReference::Point(id) => format!("@p{}", id.0),
        PartReference::Curve(id) => format!("@c{}", id.0),
        PartReference::Seam(id) => format!("@s{}", id.0),
        PartReference::Unknown(text) => text.to_string(),
        PartReference::Stretch { panel, ends } => {
            format!("@e{}:{}:{}", panel.0, corner(ends[0]), corner(ends[1]))
        }
    }
}

/// The part whose text was made by [`ids_of`]; `text` lacks the `@`.
pub(super) fn part_of_ids(text: &str) -> Option<PartReference> {
    let (kind, rest) = text.split_at_checked(1)?;
    let corner = |text: &str| -> Option<CornerName> {
        let mut parts = text.split('.');
        let number: u32 = parts.next()?.parse().ok()?;
        Some(match (parts.next(), parts.next()) {
            (Some(role), Some(index)) => Name::Made {
                by: number.into(),
                role: Role::of_word(role)?,
                index: index.parse().ok()?,
            },
            _ => Name::Drawn(number.into()),
        })
    };
    let number = || rest.parse::<u32>().ok();
    Some(match kind {
        "p" => PartReference::Point(number()?.into()),
        "c" => PartReference::Curve(number()?.into()),
        "s" => PartReference::Seam(number()?.into()),
        "e" => {
            let mut parts = rest.split(':');
            let panel: u32 = parts.next()?.parse().ok()?;
            PartReference::Stretch {
                panel: panel.into(),
                ends: [corner(parts.next()?)?, corner(parts.next()?)?],
            }
        }
        _ => return None,
    })
}
