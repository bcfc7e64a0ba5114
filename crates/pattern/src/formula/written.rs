//! Notation of parts in formulas: by name, or `?id` if the part is lost or its name leads to another part.

use super::cursor::Cursor;
use super::{FormulaError, quoted};
use crate::Role;
use std::fmt;

const HINT: &str = "write panel.name, for example front.armhole";

/// Kind of part that a function takes as argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Point,
    /// An edge, a stretch of a line or a curve.
    Stretch,
    /// An edge, a stretch of a line, a curve or a seam.
    StretchOrSeam,
}

/// A name of a part, or `?` and the id of a part.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Word {
    Name(Box<str>),
    Id(u32),
}

/// The panel or sheet that points, edges and curves in a formula belong to.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Owner {
    /// A panel and the sheet that it is traced from; if no panel has this name, a sheet.
    Panel(Word),
    /// `sheet front`: a sheet, even if a panel has the same name.
    Sheet(Word),
}

/// A corner of a panel.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Corner {
    Drawn(Word),
    /// Example: `'inner dart'.mouth.0`
    Made {
        by: Word,
        role: Role,
        index: u16,
    },
}

/// A part as written in a formula.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Written {
    /// `?47`: a point; as the argument of `length`, a part that was removed and whose kind is unknown.
    Lost(u32),
    /// `'side seam'`, or `seam ?9`.
    Seam(Word),
    /// Example: `curve ?12`
    Curve(u32),
    /// `curve front.side`: a curve of a sheet, even if an edge has the same name.
    CurveOf(Word, Word),
    /// Example: `front.armhole`
    Part(Owner, Word),
    /// Example: `front.underarm..front.tip`
    Stretch(Owner, [Corner; 2]),
}

impl Written {
    /// Parses a text as one part. `None`: the text is no part of this kind.
    pub fn of(text: &str, kind: Kind) -> Option<Self> {
        let mut cursor = Cursor::new(text);
        let written = Self::read(&mut cursor, kind).ok()?;
        cursor.peek().is_none().then_some(written)
    }

    /// Reads a part at the cursor's position in a formula.
    pub fn read(cursor: &mut Cursor<'_>, kind: Kind) -> Result<Self, FormulaError> {
        cursor.skip_space();
        if kind != Kind::Point && cursor.take_prefix("curve") {
            return curve(cursor);
        }
        if kind == Kind::StretchOrSeam && cursor.take_prefix("seam") {
            return id(cursor).map(|id| Self::Seam(Word::Id(id)));
        }
        let owner = match kind == Kind::Point && cursor.take_prefix("sheet") {
            true => Owner::Sheet(word(cursor)?),
            false => Owner::Panel(word(cursor)?),
        };
        let end = cursor.at;
        if !cursor.take('.') {
            let is_last = matches!(cursor.peek(), None | Some(')'));
            return match owner {
                Owner::Panel(Word::Id(id)) => {
                    cursor.at = end;
                    Ok(Self::Lost(id))
                }
                Owner::Panel(name) if is_last && kind == Kind::StretchOrSeam => {
                    cursor.at = end;
                    Ok(Self::Seam(name))
                }
                Owner::Panel(_) | Owner::Sheet(_) => {
                    Err(cursor.error_here("stands where a dot is missing", HINT))
                }
            };
        }
        let part = word(cursor)?;
        if kind == Kind::Point || !cursor.rest().starts_with('.') {
            return Ok(Self::Part(owner, part));
        }
        let from = corner(cursor, part)?;
        if !cursor.rest().starts_with("..") {
            return Err(cursor.error_here(
                "stands where .. is missing",
                "write both corners, for example front.underarm..front.tip",
            ));
        }
        cursor.at += 2;
        cursor.skip_space();
        let start = cursor.at;
        if Owner::Panel(word(cursor)?) != owner {
            cursor.at = start;
            return Err(cursor.error(
                "the stretch ends on another panel than it starts on",
                "name two corners of one panel; add the lengths of stretches of two with +",
            ));
        }
        if !cursor.take('.') {
            return Err(cursor.error_here("stands where a dot is missing", HINT));
        }
        let to = word(cursor)?;
        let to = corner(cursor, to)?;
        Ok(Self::Stretch(owner, [from, to]))
    }
}

/// Reads a curve after the word `curve`.
fn curve(cursor: &mut Cursor<'_>) -> Result<Written, FormulaError> {
    let owner = word(cursor)?;
    let end = cursor.at;
    if cursor.take('.') {
        return Ok(Written::CurveOf(owner, word(cursor)?));
    }
    match owner {
        Word::Id(id) => {
            cursor.at = end;
            Ok(Written::Curve(id))
        }
        Word::Name(_) => Err(cursor.error_here("stands where a dot is missing", HINT)),
    }
}

fn word(cursor: &mut Cursor<'_>) -> Result<Word, FormulaError> {
    match cursor.peek() {
        Some('?') => id(cursor).map(Word::Id),
        _ => cursor.word().map(|(name, _)| Word::Name(name)),
    }
}

/// Reads an id such as `?47`.
pub(super) fn id(cursor: &mut Cursor<'_>) -> Result<u32, FormulaError> {
    cursor.skip_space();
    let number = |cursor: &Cursor<'_>| cursor.rest().get(1..1 + cursor.digits(1))?.parse().ok();
    let is_id = cursor.rest().starts_with('?');
    match number(cursor).filter(|_| is_id) {
        Some(id) => {
            cursor.at += 1 + cursor.digits(1);
            Ok(id)
        }
        None => Err(cursor.error_here(
            "is not the id of a part",
            "write ? and the number of the part, or its name",
        )),
    }
}

/// Reads the rest of a corner, whose first word was read before.
fn corner(cursor: &mut Cursor<'_>, first: Word) -> Result<Corner, FormulaError> {
    let rest = cursor.rest();
    if !rest.starts_with('.') || rest.starts_with("..") {
        return Ok(Corner::Drawn(first));
    }
    cursor.at += 1;
    let before = cursor.at;
    let (name, _) = cursor.word()?;
    let Some(role) = Role::of_word(&name) else {
        cursor.at = before;
        return Err(cursor.error_here(
            "is no corner that an operation makes",
            "write for example dart.mouth.0, dart.apex.0 or dart.mouth.1",
        ));
    };
    let digits = cursor.digits(1);
    let index = cursor.rest().get(1..1 + digits);
    match index.and_then(|index| index.parse().ok()) {
        Some(index) if cursor.rest().starts_with('.') => {
            cursor.at += 1 + digits;
            let by = first;
            Ok(Corner::Made { by, role, index })
        }
        _ => Err(cursor.error_here(
            "stands where the number of the corner is missing",
            "write which of several, from 0, for example dart.mouth.0",
        )),
    }
}

impl fmt::Display for Word {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Name(name) => f.write_str(&quoted(name)),
            Self::Id(id) => write!(f, "?{id}"),
        }
    }
}

impl fmt::Display for Owner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Panel(word) => word.fmt(f),
            Self::Sheet(word) => write!(f, "sheet {word}"),
        }
    }
}

impl fmt::Display for Corner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Drawn(word) => word.fmt(f),
            Self::Made { by, role, index } => write!(f, "{by}.{}.{index}", role.word()),
        }
    }
}

impl fmt::Display for Written {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Lost(id) => write!(f, "?{id}"),
            Self::Seam(Word::Id(id)) => write!(f, "seam ?{id}"),
            Self::Seam(name) => name.fmt(f),
            Self::Curve(id) => write!(f, "curve ?{id}"),
            Self::CurveOf(owner, part) => write!(f, "curve {owner}.{part}"),
            Self::Part(owner, part) => write!(f, "{owner}.{part}"),
            Self::Stretch(owner, [from, to]) => write!(f, "{owner}.{from}..{owner}.{to}"),
        }
    }
}
