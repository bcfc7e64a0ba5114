//! One measurement of the catalogue: its name, unit and meaning.

/// The unit of a measurement's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum UnitKind {
    /// A length (m).
    Length,
    /// An angle (rad).
    Angle,
}

/// One measurement of the catalogue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Definition {
    /// Name in tables and formulas.
    pub name: &'static str,
    /// Plain words for a screen.
    pub label: &'static str,
    /// Length or angle.
    pub kind: UnitKind,
    /// How it is taken on a standing body.
    pub meaning: &'static str,
    /// Other names for the same thing, in this and other programs.
    pub aliases: &'static [&'static str],
}

pub(crate) const fn length(
    name: &'static str,
    label: &'static str,
    meaning: &'static str,
    aliases: &'static [&'static str],
) -> Definition {
    Definition {
        name,
        label,
        kind: UnitKind::Length,
        meaning,
        aliases,
    }
}

pub(crate) const fn angle(
    name: &'static str,
    label: &'static str,
    meaning: &'static str,
    aliases: &'static [&'static str],
) -> Definition {
    Definition {
        name,
        label,
        kind: UnitKind::Angle,
        meaning,
        aliases,
    }
}
