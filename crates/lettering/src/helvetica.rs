//! Helvetica, which readers of PDF have: the letters of its usual encoding and their widths.

/// Width of the letters from the space to the tilde, in thousandths of their size (Adobe font
/// metrics).
const WIDTHS: [u16; 95] = [
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556,
    556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667,
    611, 778, 722, 278, 500, 667, 556, 833, 722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667,
    667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500,
    222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584,
];

/// The same from code 128 on.
const UPPER_WIDTHS: [u16; 128] = [
    556, 350, 222, 556, 333, 1000, 556, 556, 333, 1000, 667, 333, 1000, 350, 611, 350, 350, 222,
    222, 333, 333, 350, 556, 1000, 333, 1000, 500, 333, 944, 350, 500, 667, 278, 333, 556, 556,
    556, 556, 260, 556, 333, 737, 370, 556, 584, 333, 737, 333, 400, 584, 333, 333, 333, 556, 537,
    278, 333, 333, 365, 556, 834, 834, 834, 611, 667, 667, 667, 667, 667, 667, 1000, 722, 667, 667,
    667, 667, 278, 278, 278, 278, 722, 722, 778, 778, 778, 778, 778, 584, 778, 722, 722, 722, 722,
    667, 667, 611, 556, 556, 556, 556, 556, 556, 889, 500, 556, 556, 556, 556, 278, 278, 278, 278,
    556, 556, 556, 556, 556, 556, 556, 584, 611, 556, 556, 556, 556, 500, 556, 500,
];

/// Letters of codes 128 to 159; blanks have none.
const UPPER_LETTERS: [char; 32] = [
    '€', ' ', '‚', 'ƒ', '„', '…', '†', '‡', 'ˆ', '‰', 'Š', '‹', 'Œ', ' ', 'Ž', ' ', ' ', '‘', '’',
    '“', '”', '•', '–', '—', '˜', '™', 'š', '›', 'œ', ' ', 'ž', 'Ÿ',
];

/// The code of a letter in the encoding `WinAnsiEncoding`. Control characters are blanks.
fn code(c: char) -> Option<u8> {
    match c {
        ' '..='~' | '\u{a0}'..='\u{ff}' => u8::try_from(u32::from(c)).ok(),
        c if c.is_control() => Some(b' '),
        c => {
            let place = UPPER_LETTERS.iter().position(|&letter| letter == c)?;
            u8::try_from(128 + place).ok()
        }
    }
}

/// A text in the encoding of Helvetica, `WinAnsiEncoding`, if that has all its letters.
pub fn plain_bytes(text: &str) -> Option<Vec<u8>> {
    text.chars().map(code).collect()
}

/// Whether Helvetica has all letters of a text.
pub fn is_plain(text: &str) -> bool {
    text.chars().all(|c| code(c).is_some())
}

/// Width of encoded text over the size of its letters.
pub(crate) fn width(encoded: &[u8]) -> f64 {
    let width = |&byte: &u8| match byte {
        b' '..=b'~' => WIDTHS[usize::from(byte - b' ')],
        128.. => UPPER_WIDTHS[usize::from(byte - 128)],
        _ => 0,
    };
    encoded
        .iter()
        .map(|byte| f64::from(width(byte)))
        .sum::<f64>()
        / 1e3
}
