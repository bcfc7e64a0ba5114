//! Names for new parts: the requested one, or a free one of the kind that pattern makers use.

use crate::{EditError, NAME_LENGTH, Panel, Pattern, Sheet, is_part_name};

/// The wanted name if it is free, otherwise the wanted name with a number: `side`, `side 2`, `side 3`.
pub(super) fn free_name(wanted: &str, taken: impl Fn(&str) -> bool) -> String {
    let mut name: String = wanted.chars().take(NAME_LENGTH - 4).collect();
    let mut number = 2;
    while taken(&name) {
        let base: String = wanted.chars().take(NAME_LENGTH - 8).collect();
        name = format!("{} {number}", base.trim_end());
        number += 1;
    }
    name
}

/// The first free name of A, B, ... Z, A1, B1, ... Z1, A2, ...
pub(super) fn letter_name(taken: impl Fn(&str) -> bool) -> String {
    let mut round = 0_u32;
    loop {
        for letter in 'A'..='Z' {
            let name = match round {
                0 => letter.to_string(),
                _ => format!("{letter}{round}"),
            };
            if !taken(&name) {
                return name;
            }
        }
        round += 1;
    }
}

/// A word with the smallest number, from 1, that makes a free name: `h1`, `h2`.
pub(super) fn numbered_name(word: &str, taken: impl Fn(&str) -> bool) -> String {
    let mut number = 1_u32;
    while taken(&format!("{word}{number}")) {
        number += 1;
    }
    format!("{word}{number}")
}

/// The name asked for; `owner` describes the part, if any, that has a name already.
///
/// # Errors
/// The name is not allowed, or another part has it.
pub(super) fn wished(
    name: &str,
    owner: impl Fn(&str) -> Option<String>,
) -> Result<String, EditError> {
    if !is_part_name(name) {
        return Err(EditError::Name(name.to_owned()));
    }
    match owner(name) {
        Some(owner) => Err(EditError::Taken(format!(
            "the name {name:?}, which {owner} has,"
        ))),
        None => Ok(name.to_owned()),
    }
}

/// Description of the point of a sheet that has this name, if any.
pub(super) fn point_owner(sheet: &Sheet, name: &str) -> Option<String> {
    let found = sheet.point_named(name)?;
    Some(format!("point {:?} of sheet {:?}", found.name, sheet.name))
}

/// Description of the curve of a sheet that has this name, if any.
pub(super) fn curve_owner(sheet: &Sheet, name: &str) -> Option<String> {
    let found = sheet.curve_named(name)?;
    Some(format!("curve {:?} of sheet {:?}", found.name, sheet.name))
}

/// Description of the part that has the name `name` for a sheet already, if any. A panel traced from another
/// sheet counts too: formulas with this name would find the panel's parts, not the sheet's.
pub(super) fn sheet_owner(pattern: &Pattern, own: Option<&Sheet>, name: &str) -> Option<String> {
    let other = |sheet: &Sheet| own.is_none_or(|own| own.id != sheet.id);
    let mut sheets = pattern.sheets.iter();
    if sheets.any(|sheet| sheet.name == name && other(sheet)) {
        return Some(format!("sheet {name:?}"));
    }
    let mut panels = pattern.panels.iter();
    let is_foreign = |panel: &Panel| own.is_none_or(|own| Some(own.id) != panel.sheet());
    panels
        .any(|panel| panel.name == name && is_foreign(panel))
        .then(|| format!("panel {name:?}"))
}

/// Description of the part that has the name `name` for a panel already, if any. A sheet that the panel is
/// not traced from counts too: formulas would no longer find that sheet's parts.
pub(super) fn panel_owner(pattern: &Pattern, own: &Panel, name: &str) -> Option<String> {
    let mut panels = pattern.panels.iter();
    if panels.any(|panel| panel.name == name && panel.id != own.id) {
        return Some(format!("panel {name:?}"));
    }
    let mut sheets = pattern.sheets.iter();
    sheets
        .any(|sheet| sheet.name == name && Some(sheet.id) != own.sheet())
        .then(|| format!("sheet {name:?}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn free_names_count_up() {
        let taken = ["side", "side 2"];
        assert_eq!(free_name("side", |n| taken.contains(&n)), "side 3");
        assert_eq!(free_name("hem", |n| taken.contains(&n)), "hem");
        let long = "x".repeat(200);
        assert!(is_part_name(&free_name(&long, |n| n.len() == 76)));
    }

    #[test]
    fn letters_go_round_with_numbers() {
        assert_eq!(letter_name(|n| n < "C"), "C");
        assert_eq!(letter_name(|n| n.len() == 1), "A1");
        assert_eq!(letter_name(|n| n.len() == 1 || n == "A1"), "B1");
        assert_eq!(letter_name(|n| n.len() == 1 || n.ends_with('1')), "A2");
        assert_eq!(numbered_name("h", |n| n == "h1"), "h2");
    }

    #[test]
    fn wished_names_are_refused_with_their_owner() {
        let owner = |name: &str| (name == "side").then(|| "edge 7".to_owned());
        assert_eq!(wished("hem", owner).unwrap(), "hem");
        assert_eq!(wished(" ", owner), Err(EditError::Name(" ".into())));
        let error = wished("side", owner).unwrap_err().to_string();
        assert_eq!(
            error,
            "the name \"side\", which edge 7 has, is taken: choose another"
        );
    }
}
