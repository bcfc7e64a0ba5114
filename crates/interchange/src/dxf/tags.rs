//! The tags of a DXF file: pairs of lines, a code and a value.

use crate::FormatError;

/// Most bytes of a file that is read.
const MAX_BYTES: usize = 64 << 20;
/// Largest coordinate (units of the file): 10 km in millimetres.
const MAX_PLACE: f64 = 1e7;
/// Start of a binary DXF.
const BINARY: &[u8] = b"AutoCAD Binary DXF";

/// A pair of lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Tag<'a> {
    /// The group code, which says what the value is.
    pub code: i32,
    /// The value as it stands in the file, without blanks round it.
    pub value: &'a [u8],
    /// Number of the line that the code stands on, from 1.
    pub line: usize,
}

impl Tag<'_> {
    /// Whether the tag has a code and a value.
    pub fn is(&self, code: i32, value: &str) -> bool {
        self.code == code && self.value.eq_ignore_ascii_case(value.as_bytes())
    }

    /// The value as a finite number.
    pub fn number(&self) -> Result<f64, FormatError> {
        let text = std::str::from_utf8(self.value).unwrap_or_default();
        // German programs write a comma.
        let number = text.replace(',', ".").parse::<f64>();
        match number {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(FormatError::new(
                format!("line {}", self.line + 1),
                format!("{:?} is no number", String::from_utf8_lossy(self.value)),
                "write the file again from the program that it comes from",
            )),
        }
    }

    /// The value as a coordinate.
    pub fn place(&self) -> Result<f64, FormatError> {
        let value = self.number()?;
        match value.abs() <= MAX_PLACE {
            true => Ok(value),
            false => Err(FormatError::new(
                format!("line {}", self.line + 1),
                format!("{value:e} is no place on a pattern"),
                format!("move the drawing near its origin: at most {MAX_PLACE:e} units away"),
            )),
        }
    }

    /// The value as a whole number; 0 where it is none.
    pub fn count(&self) -> i64 {
        self.number().map_or(0, |number| number as i64)
    }
}

/// The tags of a text DXF, without comments. A file that breaks off after a code is read up to there.
///
/// # Errors
/// The file is binary or too large, or a line that must hold a code holds none.
pub(super) fn tags(bytes: &[u8]) -> Result<Vec<Tag<'_>>, FormatError> {
    if bytes.starts_with(BINARY) {
        return Err(FormatError::new(
            "the whole file",
            "this DXF is binary",
            "save it as DXF in text (ASCII)",
        ));
    }
    if bytes.len() > MAX_BYTES {
        return Err(FormatError::new(
            "the whole file",
            format!("it has {} MB", bytes.len() >> 20),
            format!(
                "at most {} MB are read: save fewer pieces or sizes",
                MAX_BYTES >> 20
            ),
        ));
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let lines = bytes.split(|&byte| byte == b'\n');
    let mut lines = lines.map(<[u8]>::trim_ascii).enumerate();
    let mut found = Vec::new();
    while let Some((k, code)) = lines.next() {
        let Some((_, value)) = lines.next() else {
            break;
        };
        let number = std::str::from_utf8(code)
            .ok()
            .and_then(|code| code.parse().ok());
        let Some(code) = number else {
            return Err(FormatError::new(
                format!("line {}", k + 1),
                format!(
                    "a number of a group must stand here, not {:?}",
                    String::from_utf8_lossy(&code[..code.len().min(40)])
                ),
                "the file is damaged: write it again from the program that it comes from",
            ));
        };
        if code != COMMENT {
            found.push(Tag {
                code,
                value,
                line: k + 1,
            });
        }
        if code == 0 && value.eq_ignore_ascii_case(b"EOF") {
            break;
        }
    }
    Ok(found)
}

/// Code of a comment.
const COMMENT: i32 = 999;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_are_read_with_blanks_and_line_ends_of_any_system() {
        let found =
            tags(b"999\nby hand\r\n  0\r\nSECTION\r\n  2\r\n BLOCKS \r\n0\nEOF\nrest").unwrap();
        assert_eq!(found.len(), 3);
        assert!(found[0].is(0, "section") && found[1].is(2, "BLOCKS"));
        assert_eq!(found[1].line, 5);
        assert_eq!(tags(b"10\n1,5\n").unwrap()[0].number().unwrap(), 1.5);
        assert!(tags(b"10\nnan\n").unwrap()[0].number().is_err());
        assert_eq!(tags(b"").unwrap(), []);
    }

    #[test]
    fn damage_is_refused_with_its_line() {
        let refused = tags(b"0\nSECTION\nBLOCKS\n2\n").unwrap_err();
        assert_eq!(refused.place, "line 3");
        let binary = tags(b"AutoCAD Binary DXF\r\n\x1a\0").unwrap_err();
        assert!(binary.what.contains("binary"), "{binary}");
    }
}
