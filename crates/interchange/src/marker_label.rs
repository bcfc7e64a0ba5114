//! Breaks a text into lines of a given length.

use toile_lettering::{is_plain, width};

/// Safety factor for the length of a line, since a sans-serif font other than Helvetica may draw it: in DejaVu
/// Sans and Verdana a line is about 1.17 times as long as in Helvetica.
const WIDER: f64 = 1.25;

/// Breaks a text into lines that are no longer than `length`, whichever sans-serif font draws them; `size` is
/// the letter size, in the unit of `length`. Lines break between words, and within a word that is longer than
/// a line.
pub(crate) fn lines_within(text: &str, size: f64, length: f64) -> Vec<String> {
    // Letters of other scripts may be as wide as they are high.
    let wide = |c: char| {
        let letter = c.encode_utf8(&mut [0; 4]).to_owned();
        let share = if is_plain(&letter) {
            width(&letter) * WIDER
        } else {
            1.0
        };
        share * size
    };
    let width = |text: &str| text.chars().map(wide).sum::<f64>();
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if width(line) + width(" ") + width(word) <= length => {
                line.push(' ');
                line.push_str(word);
                continue;
            }
            _ => lines.push(String::new()),
        }
        let mut taken = 0.0;
        for c in word.chars() {
            if taken > 0.0 && taken + wide(c) > length {
                lines.push(String::new());
                taken = 0.0;
            }
            taken += wide(c);
            if let Some(line) = lines.last_mut() {
                line.push(c);
            }
        }
    }
    lines
}
