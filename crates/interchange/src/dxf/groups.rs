//! Groups of tags: an entity of a DXF file and its values.

use super::tags::Tag;
use crate::FormatError;
use toile_geometry::Vec2;

/// Splits tags into groups that each begin with a tag of code 0.
pub(super) fn groups<'t, 'a>(tags: &'t [Tag<'a>]) -> impl Iterator<Item = &'t [Tag<'a>]> {
    let mut rest = tags;
    std::iter::from_fn(move || {
        let start = rest.iter().position(|tag| tag.code == 0)?;
        let after = rest[start + 1..].iter().position(|tag| tag.code == 0);
        let end = after.map_or(rest.len(), |after| start + 1 + after);
        let group = &rest[start..end];
        rest = &rest[end..];
        Some(group)
    })
}

/// The first tag of a group with a code.
pub(super) fn value<'t, 'a>(group: &'t [Tag<'a>], code: i32) -> Option<&'t Tag<'a>> {
    group[1..].iter().find(|tag| tag.code == code)
}

/// The place whose x has a code; y stands under the code that is 10 higher.
pub(super) fn place(group: &[Tag<'_>], code: i32) -> Result<Option<Vec2>, FormatError> {
    match (value(group, code), value(group, code + 10)) {
        (Some(x), Some(y)) => Ok(Some(Vec2::new(x.place()?, y.place()?))),
        _ => Ok(None),
    }
}

/// All places of a group whose x has a code.
pub(super) fn places(group: &[Tag<'_>], code: i32) -> Result<Vec<Vec2>, FormatError> {
    let mut found: Vec<Vec2> = Vec::new();
    for tag in &group[1..] {
        if tag.code == code {
            found.push(Vec2::new(tag.place()?, 0.0));
        } else if let (true, Some(last)) = (tag.code == code + 10, found.last_mut()) {
            last.y = tag.place()?;
        }
    }
    Ok(found)
}

/// All vertices of a group, each with the bulge of the way to the next.
pub(super) fn bulged_places(group: &[Tag<'_>]) -> Result<Vec<(Vec2, f64)>, FormatError> {
    let mut found: Vec<(Vec2, f64)> = Vec::new();
    for tag in &group[1..] {
        match (tag.code, found.last_mut()) {
            (10, _) => found.push((Vec2::new(tag.place()?, 0.0), 0.0)),
            (20, Some(last)) => last.0.y = tag.place()?,
            (42, Some(last)) => last.1 = tag.number()?,
            _ => {}
        }
    }
    Ok(found)
}

/// Whether an entity is drawn on the back of the plane, as mirror images of some programs are.
pub(super) fn is_behind(group: &[Tag<'_>]) -> bool {
    let z = value(group, 230).and_then(|tag| tag.number().ok());
    z.is_some_and(|z| z < 0.0)
}

/// Whether the flags of a polyline say that it is closed.
pub(super) fn is_closed(group: &[Tag<'_>]) -> bool {
    value(group, 70).is_some_and(|tag| tag.count() & 1 == 1)
}
