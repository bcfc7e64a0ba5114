//! Values of options that have several parts.

use toile_geometry::Length;

/// Most garments of one size: far more than can be laid at once.
const MOST_GARMENTS: u32 = 10_000;

/// A size and how many garments of it, as in M:2.
pub fn size_count(text: &str) -> Result<(String, u32), String> {
    let (name, count) = text.rsplit_once(':').unwrap_or((text, "1"));
    match count.parse() {
        Ok(count @ 1..=MOST_GARMENTS) => Ok((name.to_owned(), count)),
        _ => Err(format!(
            "{count:?} is no number of garments from 1 to {MOST_GARMENTS}; write NAME:COUNT"
        )),
    }
}

/// Lengths with commas between [m].
fn lengths(text: &str) -> Result<Vec<f64>, String> {
    text.split(',')
        .map(|part| {
            let length: Result<Length, _> = part.trim().parse();
            length
                .map(|l| l.as_metres())
                .map_err(|error| error.to_string())
        })
        .collect()
}

/// Length and width of a roll [m].
pub fn roll(text: &str) -> Result<(f64, Option<f64>), String> {
    match lengths(text)?[..] {
        [length] => Ok((length, None)),
        [length, width] => Ok((length, Some(width))),
        ref more => Err(format!(
            "there are {} lengths; give the roll's length, or length,width",
            more.len()
        )),
    }
}

/// Repeat along the warp and, if it repeats there, across [m].
pub fn repeat(text: &str) -> Result<[f64; 2], String> {
    match lengths(text)?[..] {
        [along] => Ok([along, 0.0]),
        [along, across] => Ok([along, across]),
        ref more => Err(format!(
            "there are {} lengths; give the repeat along the warp, or along,across",
            more.len()
        )),
    }
}

/// Four lengths with commas between [m].
pub fn four_lengths(text: &str) -> Result<[f64; 4], String> {
    let lengths = lengths(text)?;
    let count = lengths.len();
    lengths
        .try_into()
        .map_err(|_| format!("there are {count} lengths; give four"))
}
