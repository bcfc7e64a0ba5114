//! Typed input of a slot tool: numbers for the present slot, for a place in one of several ways, and a
//! name; or numbers and a name for the part made last.
//!
//! # Decided with
//! - [`crate::tools::number::parse`], [`crate::tools::composed::formula`]: text to number; formulas of what
//!   was typed;
//! - [`crate::tools::newest::set_handles`]: numbers of what was made last;
//! - [`crate::tools::along::mark_along`], [`crate::tools::list`]: distances along edges; several numbers;
//! - [`crate::fields::TypedTexts`]: fields of the inspector and the tables;
//! - [`toile_pattern::plan::read_number`], [`toile_pattern::plan::number_text`]: text to a number of the
//!   document, with its units; and back;
//! - [`crate::app`] (`pacing.rs`, `Pacing`): keys that come in one frame.
//!
//! Units of bare numbers and names that wait for their part: crate `pattern`, `bare.rs` and `bind.rs` in
//! `plan`.

use super::Reading;
use super::newest::{self, Handle};
use super::refusal::Unanswered;
use super::slots::{Fields, SlotKind, SlotState, SlotTool, slot};
use toile_pattern::Want;

/// Label of the name field.
pub(super) const NAME: &str = "name";
/// Label of the field that shows text typed where no number is accepted.
const NUMBER: &str = "number";
/// Sign that begins a name if no other text was typed; formulas quote names with it too.
pub const NAME_SIGN: char = '\'';
/// Signs that choose another way to type a place, as in other CAD programs.
pub const WAY_SIGNS: [char; 3] = [BESIDE_SIGN, COORDINATES_SIGN, ANGLE_SIGN];
/// Sign that chooses [`Way::Beside`].
const BESIDE_SIGN: char = '@';
/// Sign that chooses [`Way::Coordinates`].
const COORDINATES_SIGN: char = '#';
/// Sign that chooses [`Way::FromLast`] or [`Way::Radius`], or goes on to the angle of a way that has one.
const ANGLE_SIGN: char = '<';

/// A way to type the answer to a slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// Coordinates on the sheet.
    Coordinates,
    /// Distance and angle from the last place.
    FromLast,
    /// Radius and angle from the last place, the centre of an arc.
    Radius,
    /// Offset to the right and upward from the last place.
    Beside,
    /// Width and height from the last place.
    Size,
    /// Radius and angle of an arc that continues the curve at the last place smoothly.
    Turn,
    /// Distance along an edge from its nearer corner.
    Distance,
    /// A number with a label and a kind.
    Number(&'static str, Want),
}

impl Way {
    fn fields(self) -> Vec<(&'static str, Want)> {
        let lengths = |first, second| vec![(first, Want::Length), (second, Want::Length)];
        let turned = |first| vec![(first, Want::Length), ("angle", Want::Angle)];
        match self {
            Self::Coordinates => lengths("x", "y"),
            Self::FromLast => turned("length"),
            Self::Radius | Self::Turn => turned("radius"),
            Self::Beside => lengths("dx", "dy"),
            Self::Size => lengths("width", "height"),
            Self::Distance => vec![("distance", Want::Length)],
            Self::Number(label, want) => vec![(label, want)],
        }
    }

    /// The sign that chooses this way.
    pub fn sign(self) -> Option<char> {
        match self {
            Self::Coordinates => Some(COORDINATES_SIGN),
            Self::Beside => Some(BESIDE_SIGN),
            Self::FromLast | Self::Radius => Some(ANGLE_SIGN),
            Self::Size | Self::Turn | Self::Distance | Self::Number(..) => None,
        }
    }

    /// Labels of the fields of this way.
    pub fn words(self) -> String {
        let labels: Vec<&str> = self.fields().into_iter().map(|(label, _)| label).collect();
        labels.join(", ")
    }
}

/// Ways to type the answer to a slot; the first way needs no sign.
pub(super) fn ways(kind: SlotKind, state: &SlotState) -> Vec<Way> {
    let place = |fields: Fields| match (state.last_place(), fields) {
        (None, _) => vec![Way::Coordinates],
        (_, Fields::Usual) => vec![Way::FromLast, Way::Beside, Way::Coordinates],
        (_, Fields::Radius) => vec![Way::Radius, Way::Beside, Way::Coordinates],
        (_, Fields::Size) => vec![Way::Size, Way::Beside, Way::Coordinates],
        (_, Fields::Turn) => vec![Way::Turn, Way::FromLast, Way::Beside, Way::Coordinates],
    };
    match kind {
        SlotKind::Place(fields) | SlotKind::Named(fields) => place(fields),
        SlotKind::Places => place(Fields::Usual),
        SlotKind::Inside => vec![Way::Coordinates],
        SlotKind::OnLine => vec![Way::Distance],
        SlotKind::Number { label, want, .. } => vec![Way::Number(label, want)],
        SlotKind::Numbers { label, .. } => vec![Way::Number(label, Want::Any)],
        SlotKind::Edge
        | SlotKind::Chain
        | SlotKind::Operation
        | SlotKind::Curve
        | SlotKind::End
        | SlotKind::Panel => Vec::new(),
    }
}

/// The way to type the answer that was chosen; `None` if the slot takes no numbers.
pub(super) fn way(kind: SlotKind, state: &SlotState) -> Option<Way> {
    ways(kind, state).get(state.typed.way).copied()
}

/// Whether the result of a slot can have a name.
pub(super) fn is_named(kind: SlotKind) -> bool {
    matches!(
        kind,
        SlotKind::Named(_) | SlotKind::Places | SlotKind::Inside
    )
}

/// A field for typed text.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Field {
    pub label: String,
    pub want: Want,
}

/// Fields for typed text in the present state.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Typable {
    /// Fields; the field for the name comes last. A field for numbers and one for the name exist even if
    /// numbers or a name are not accepted, to show text that is typed all the same.
    pub fields: Vec<Field>,
    /// Whether numbers are accepted.
    pub takes_numbers: bool,
    /// Whether a name is accepted.
    pub takes_name: bool,
    /// Handle numbers of the part made last, if the number fields are for these; empty if the fields are for
    /// the slot.
    pub handles: Vec<Handle>,
    /// Ways to type the requested place.
    pub ways: Vec<Way>,
}

impl Typable {
    /// The fields for the present state.
    pub fn new(tool: &SlotTool, state: &SlotState, reading: &Reading<'_>) -> Self {
        let kind = slot(tool, state).kind;
        let newest = state.newest();
        let open = newest.filter(|_| !state.settled);
        let handles = open.map_or_else(Vec::new, |item| newest::handles(item, reading));
        let field = |label: &str, want| Field {
            label: label.to_owned(),
            want,
        };
        let (ways, mut fields) = match handles.is_empty() {
            false => {
                let own = handles.iter();
                let own = own.map(|handle| field(&handle.label, handle.entry.want));
                (Vec::new(), own.collect())
            }
            true => {
                let own = way(kind, state).map_or_else(Vec::new, Way::fields);
                let own = own.into_iter().map(|(label, want)| field(label, want));
                (ways(kind, state), own.collect::<Vec<_>>())
            }
        };
        let names_newest = newest.is_some_and(|item| newest::name(item, reading).is_some());
        let takes_numbers = !fields.is_empty();
        if !takes_numbers {
            fields.push(field(NUMBER, Want::Any));
        }
        fields.push(field(NAME, Want::Any));
        Self {
            fields,
            takes_numbers,
            takes_name: is_named(kind) || names_newest,
            handles,
            ways,
        }
    }

    /// Number of the fields for numbers; the field for the name comes after them.
    pub fn numbers(&self) -> usize {
        self.fields.len() - 1
    }

    /// The typed name.
    pub fn typed_name<'s>(&self, state: &'s SlotState) -> &'s str {
        state.typed.text(self.numbers()).trim()
    }

    /// Refuses typed text that is not accepted here.
    ///
    /// # Errors
    /// A number or a name was typed where none is accepted.
    pub fn refuse_untaken(&self, state: &SlotState) -> Result<(), Unanswered> {
        let name = self.numbers();
        if !self.takes_numbers && !state.typed.is_blank(name) {
            return Err(Unanswered {
                field: Some(0),
                words: format!("{NUMBER}: what is asked for here is pointed at, not typed"),
            });
        }
        if !self.takes_name && (state.typed.naming || !state.typed.text(name).is_empty()) {
            return Err(Unanswered {
                field: Some(name),
                words: format!("{NAME}: nothing is named here"),
            });
        }
        Ok(())
    }

    /// Adds typed text to the present field. The sign for names begins a name, other signs choose another
    /// way to type a place; inside a formula signs are ordinary characters.
    ///
    /// # Errors
    /// No such text is accepted here, or a sign comes after numbers were typed. The text is kept in any
    /// case.
    pub fn take(&self, state: &mut SlotState, text: &str) -> Result<(), Unanswered> {
        let name = self.numbers();
        for c in text.chars() {
            let typed = &mut state.typed;
            typed.fault = None;
            typed.field = typed.field.min(name);
            let is_name = typed.field == name;
            let now = typed.text(typed.field);
            let is_open = now.matches('(').count() > now.matches(')').count();
            match c {
                NAME_SIGN if now.is_empty() && !typed.naming => {
                    typed.naming = true;
                    typed.field = name;
                }
                ANGLE_SIGN if !is_name && !is_open && self.goes_to_angle(typed.way) => {
                    typed.field = 1;
                }
                BESIDE_SIGN | COORDINATES_SIGN | ANGLE_SIGN if !is_name && !is_open => {
                    if let Err(words) = self.choose(state, c) {
                        let field = state.typed.field;
                        state.typed.text_mut(field).push(c);
                        let field = Some(field);
                        return Err(Unanswered { field, words });
                    }
                }
                _ => typed.text_mut(typed.field).push(c),
            }
        }
        self.refuse_untaken(state)
    }

    /// Whether the sign for angles goes on to the angle field of the present way.
    fn goes_to_angle(&self, way: usize) -> bool {
        let now = self.ways.get(way);
        now.is_some_and(|way| matches!(way, Way::FromLast | Way::Radius | Way::Turn))
    }

    /// Chooses the way to type a place that a sign stands for.
    fn choose(&self, state: &mut SlotState, sign: char) -> Result<(), String> {
        let found = self.ways.iter().position(|way| way.sign() == Some(sign));
        let places = [Way::Coordinates, Way::FromLast, Way::Beside];
        let asks_place = self.ways.iter().any(|way| places.contains(way));
        let found = found.ok_or_else(|| match !asks_place {
            true => format!("{sign} chooses other numbers of a place, and none is asked for here"),
            false => format!("{sign} counts from a place that was given before: there is none yet"),
        })?;
        let numbers = self.fields.iter().take(self.numbers()).enumerate();
        let mut begun = numbers.filter(|(k, _)| !state.typed.text(*k).is_empty());
        if let Some((k, field)) = begun.next() {
            let text = state.typed.text(k);
            return Err(format!(
                "{} {text} is typed already: take it back before {sign} chooses {}",
                field.label,
                self.ways[found].words()
            ));
        }
        state.typed.way = found;
        state.typed.field = 0;
        Ok(())
    }

    /// Deletes the last typed character; in an empty field, goes back a field or to the first way.
    pub fn take_back(&self, state: &mut SlotState) {
        let typed = &mut state.typed;
        typed.fault = None;
        if typed.text_mut(typed.field).pop().is_some() {
            return;
        }
        if typed.naming {
            typed.naming = false;
            typed.field = 0;
        } else if typed.field > 0 {
            typed.field -= 1;
        } else {
            typed.way = 0;
        }
    }

    /// Goes to the next field.
    pub fn next(&self, state: &mut SlotState) {
        let count = self.numbers() + usize::from(self.takes_name);
        state.typed.field = (state.typed.field + 1) % count.max(1);
    }
}
