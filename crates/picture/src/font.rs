//! A stroke font of our own: the printable ASCII characters as lines and smooth curves.

/// Height of a capital letter above the baseline, in the font's units.
pub(crate) const CAPITAL: f64 = 14.0;
/// Height of the baseline above the lowest point.
const BASELINE: f64 = 4.0;
/// Space after a character.
pub(crate) const SPACING: f64 = 4.2;
/// Width of a blank.
const BLANK: f64 = 5.0;

/// Characters from blank to tilde. Strokes are separated by blanks; a point is two digits of
/// base 36, x to the right and y up, baseline at 4, capitals to 18, small letters to 14. A stroke
/// that begins with `~` is an open curve, with `@` a closed one: a quadratic B-spline over the
/// points as control polygon. One point alone is a dot.
const STROKES: [&str; 95] = [
    "",
    "0i09 04",
    "0i0e 4i4e",
    "245i 74ai 08a8 0eae", // blank ! " #
    "~9f9i0i0b9b940407 5k52",
    "@0c4c4i0i @64a4aa6a 149i", // $ %
    "~b994040a6d7i1i1eb4",
    "0i0e",
    "~4k0h0441",
    "~0k4h4401", // & ' ( )
    "4i4c 1h7d 7h1d",
    "4e46 0a8a",
    "1401",
    "0a6a",
    "04",
    "018k", // * + , - . /
    "@04949i0i",
    "1f5i54",
    "~0e0i9i9c04 0494",
    "~0f0i9i9b4b ~4b9b940407", // 0 1 2 3
    "747i0898",
    "8i1i1b ~1b3d9d940406",
    "@04949c0c ~080i8i", // 4 5 6
    "0i9i34",
    "@1b8b8i1i @04949b0b",
    "@0a9a9i0i ~9e9414", // 7 8 9
    "04 0c",
    "1401 1c",
    "8e0a86",
    "0c8c 0888",
    "0e8a06", // : ; < = >
    "~0f0i8i8c4b48 44",
    "@48888d4d ~8d87c7ci0i04a4", // ? @
    "045ia4 2989",
    "040i ~0i4i9i9b4b0b ~0b5baba45404",
    "~afai0i04a4a7", // A B C
    "040i ~0i4iaia44404",
    "9i0i0494 0b7b",
    "9i0i04 0b7b", // D E F
    "~afai0i04a4aa aa6a",
    "040i a4ai 0bab",
    "040i",
    "~7i79740408", // G H I J
    "040i 9i09 3c94",
    "0i0494",
    "040i69cic4",
    "040ia4ai",
    "@04b4bi0i", // K L M N O
    "040i ~0i5iaiaa5a0a",
    "@04b4bi0i 67b3",
    "040i ~0i5iaiaa5a0a 5aa4", // P Q R
    "~9f9i0i0b9b940407",
    "0iai 5i54",
    "~0i0904a4a9ai",
    "0i54ai", // S T U V
    "0i447ia4ei",
    "04ai 0ia4",
    "0i5bai 5b54",
    "0iai04a4", // W X Y Z
    "4k0k0141",
    "0k71",
    "0k4k4101",
    "0c4i8c",
    "02a2",
    "0i3f", // [ \ ] ^ _ `
    "@04848e0e 8e84",
    "0i04 @04848e0e",
    "~8c8e0e048486",
    "8i84 @04848e0e", // a b c d
    "0989 ~898e0e048486",
    "~6i2i2d 2d24 0e5e",
    "@04848e0e ~8e84800002", // e f g
    "0i04 ~0a0e8e8984",
    "040e 0i",
    "~3e333000 3i",
    "040i 7e08 3a74",
    "040i", // h i j k l
    "040e ~0a0e6e6964 ~6a6ecec9c4",
    "040e ~0a0e8e8984",
    "@04949e0e", // m n o
    "0e00 @04848e0e",
    "8e80 @04848e0e",
    "040e ~0a0e5e", // p q r
    "~7c7e0e0979740406",
    "~2i272464 0e6e",
    "~0e09048488 8e84",
    "0e448e", // s t u v
    "0e346e94ce",
    "048e 0e84",
    "0e44 8e20",
    "0e8e0484", // w x y z
    "~4k2k2b0b ~0b2b2141",
    "0k01",
    "~0k2k2b4b ~4b2b2101",
    "~092d678b", // { | } ~
];

/// Strokes as lines, x from 0, y up from the baseline, and the advance.
pub(crate) type Glyph = (Vec<Vec<[f64; 2]>>, f64);

/// The strokes of a character; nothing if it is not ASCII, dashes excepted.
pub(crate) fn glyph(character: char) -> Option<Glyph> {
    let index = match character {
        ' '..='~' => character as usize - ' ' as usize,
        '\u{2010}'..='\u{2015}' | '\u{2212}' => '-' as usize - ' ' as usize,
        _ => return None,
    };
    let strokes: Vec<Vec<[f64; 2]>> = STROKES[index]
        .split_ascii_whitespace()
        .map(stroke)
        .collect();
    let width = strokes
        .iter()
        .flatten()
        .map(|p| p[0])
        .fold(f64::NEG_INFINITY, f64::max);
    let advance = if strokes.is_empty() {
        BLANK
    } else {
        width + SPACING
    };
    Some((strokes, advance))
}

fn stroke(text: &str) -> Vec<[f64; 2]> {
    let (kind, digits) = match text.strip_prefix(['~', '@']) {
        Some(rest) => (&text[..1], rest),
        None => ("", text),
    };
    let values: Vec<f64> = digits
        .chars()
        .filter_map(|c| c.to_digit(36))
        .map(f64::from)
        .collect();
    let mut points: Vec<[f64; 2]> = values
        .chunks_exact(2)
        .map(|p| [p[0], p[1] - BASELINE])
        .collect();
    match kind {
        "~" => {
            // A control point twice makes the curve begin and end there.
            let (first, last) = (points[0], points[points.len() - 1]);
            points.insert(0, first);
            points.push(last);
            spline(&points)
        }
        "@" => {
            points.extend([points[0], points[1]]);
            spline(&points)
        }
        _ => points,
    }
}

/// A uniform quadratic B-spline: an arc a control point, from midpoint to midpoint.
fn spline(control: &[[f64; 2]]) -> Vec<[f64; 2]> {
    const STEPS: usize = 6;
    let middle = |a: [f64; 2], b: [f64; 2]| [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
    let mut points = vec![middle(control[0], control[1])];
    for three in control.windows(3) {
        let (from, to) = (middle(three[0], three[1]), middle(three[1], three[2]));
        for step in 1..=STEPS {
            let t = step as f64 / STEPS as f64;
            let (a, b, c) = ((1.0 - t) * (1.0 - t), 2.0 * t * (1.0 - t), t * t);
            points.push([0, 1].map(|k| a * from[k] + b * three[1][k] + c * to[k]));
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_character_has_its_own_strokes_inside_the_cell() {
        let mut seen = Vec::new();
        for character in '!'..='~' {
            let (strokes, advance) = glyph(character).unwrap();
            assert!(!strokes.is_empty(), "{character}");
            for [x, y] in strokes.iter().flatten() {
                assert!(
                    (-0.01..=14.01).contains(x) && (-4.01..=16.01).contains(y),
                    "{character}"
                );
                assert!(*x < advance);
            }
            assert!(!seen.contains(&STROKES[character as usize - 32]) || "Il".contains(character));
            seen.push(STROKES[character as usize - 32]);
        }
        assert_eq!(glyph(' '), Some((Vec::new(), BLANK)));
        assert_eq!(glyph('\u{e9}'), None);
    }

    #[test]
    fn points_are_pairs_of_digits() {
        for text in STROKES {
            for stroke in text.split_ascii_whitespace() {
                let digits = stroke.trim_start_matches(['~', '@']);
                assert!(digits.len().is_multiple_of(2), "{stroke}");
                assert!(digits.chars().all(|c| c.is_digit(36)), "{stroke}");
            }
        }
    }

    #[test]
    fn curves_end_where_they_are_drawn_to() {
        let open = stroke("~04a4ai");
        assert_eq!(open[0], [0.0, 0.0]);
        assert_eq!(open[open.len() - 1], [10.0, 14.0]);
        let closed = stroke("@04a4ai0i");
        assert_eq!(closed[0], closed[closed.len() - 1]);
    }
}
