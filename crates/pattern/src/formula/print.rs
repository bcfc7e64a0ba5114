//! Prints the parts that a formula names, with their current names.

use super::by_id::ids_of;
use super::written::{Corner, Kind, Owner, Word, Written};
use super::{Names, Token, quoted};
use crate::{CornerName, Name, PanelId, PartReference, SheetId, VariableId};

impl Names {
    /// The text of a token, with the current names of parts. If the text is parsed it gives the same token: a
    /// part that was removed, or whose name stands for another part, is printed as `?` and its id.
    pub fn print(&self, token: &Token) -> String {
        match token {
            Token::Text(text) => text.to_string(),
            Token::Variable(id) if self.by_id => format!("@{}", id.0),
            Token::Variable(id) => self.print_variable(*id),
            Token::Word(word) if self.variable(word).is_some() && self.is_measurement(word) => {
                format!("measurement {}", quoted(word))
            }
            Token::Word(word) => quoted(word),
            Token::Part(part) => self.print_part(part),
        }
    }

    fn print_variable(&self, id: VariableId) -> String {
        let name = self.variables.name(id).map(|(_, name)| name);
        match name.filter(|name| self.variable(name) == Some(id)) {
            Some(name) => quoted(name),
            None => format!("?{}", id.0),
        }
    }

    /// The text for a part with its current names.
    pub fn print_part(&self, part: &PartReference) -> String {
        if self.by_id {
            return ids_of(part);
        }
        let written = match part {
            PartReference::Unknown(text) => return text.to_string(),
            PartReference::Point(id) => {
                let named = self.points.name(*id);
                let named = named.and_then(|(sheet, name)| self.in_sheet(sheet, name, part));
                named.unwrap_or(Written::Lost(id.0))
            }
            PartReference::Curve(id) => {
                let named = self.curves.name(*id);
                let named = named.and_then(|(sheet, name)| self.in_sheet(sheet, name, part));
                named.unwrap_or(Written::Curve(id.0))
            }
            PartReference::Seam(id) => {
                let name = self.seams.name(*id).map(|(_, name)| name);
                let own = name.filter(|name| self.seams.id((), name) == Some(*id));
                Written::Seam(own.map_or(Word::Id(id.0), |name| Word::Name(name.into())))
            }
            PartReference::Stretch { panel, ends } => self.stretch(*panel, *ends),
        };
        written.to_string()
    }

    /// Notation of a point or curve by its name and the name of its sheet, or of the panel traced from the
    /// sheet. `None`: all of these notations stand for another part.
    fn in_sheet(&self, sheet: SheetId, name: &str, part: &PartReference) -> Option<Written> {
        let is_point = matches!(part, PartReference::Point(_));
        let kind = if is_point { Kind::Point } else { Kind::Stretch };
        let panel = self.traced.get(&sheet).filter(|_| is_point);
        let panel = panel.and_then(|panel| self.panels.name(*panel));
        let own = self.sheets.name(sheet).map(|(_, name)| name);
        let word = |name: &str| Word::Name(name.into());
        let part_of = |owner: &str| Written::Part(Owner::Panel(word(owner)), word(name));
        let ways = [
            panel.map(|(_, panel)| part_of(panel)),
            own.map(part_of),
            own.map(|own| match is_point {
                true => Written::Part(Owner::Sheet(word(own)), word(name)),
                false => Written::CurveOf(word(own), word(name)),
            }),
        ];
        ways.into_iter()
            .flatten()
            .find(|written| self.part_of(written, kind).as_ref() == Some(part))
    }

    fn stretch(&self, panel: PanelId, ends: [CornerName; 2]) -> Written {
        let part = PartReference::Stretch { panel, ends };
        let name = self.panels.name(panel).map(|(_, name)| name);
        let own = name.filter(|name| self.panels.id((), name) == Some(panel));
        let owner = Owner::Panel(own.map_or(Word::Id(panel.0), |name| Word::Name(name.into())));
        let edge = match ends {
            [Name::Drawn(from), Name::Drawn(to)] => self.spanned.get(&(panel, [from, to])),
            _ => None,
        };
        let whole = edge.map(|edge| Written::Part(owner.clone(), Word::Name(edge.clone())));
        match whole.filter(|whole| self.part_of(whole, Kind::Stretch).as_ref() == Some(&part)) {
            Some(whole) => whole,
            None => Written::Stretch(owner, ends.map(|end| self.corner_of(panel, end))),
        }
    }

    fn corner_of(&self, panel: PanelId, corner: CornerName) -> Corner {
        let by_name = |name: Option<&str>| name.map(|name| Word::Name(name.into()));
        match corner {
            Name::Drawn(id) => {
                let name = by_name(self.points.name(id).map(|(_, name)| name));
                let own = name.map(Corner::Drawn);
                own.filter(|own| self.corner(panel, own) == Some(corner))
                    .unwrap_or(Corner::Drawn(Word::Id(id.0)))
            }
            Name::Made { by, role, index } => {
                let name = by_name(self.operations.name(by).map(|(_, name)| name));
                let made = |by| Corner::Made { by, role, index };
                name.map(made)
                    .filter(|own| self.corner(panel, own) == Some(corner))
                    .unwrap_or(made(Word::Id(by.0)))
            }
        }
    }
}
