//! Parsers for options with several values.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use toile_geometry::Length;
use toile_session::{
    Choice, ExportFormat, GivenFlaw, NapRule, PanelOrigin, Print, Roll, Shrinkage, SizeSelection,
    Spread,
};

/// Most garments of one size: far more than can be laid at once.
const MAX_GARMENTS: u32 = 10_000;

/// The word for every size of a pattern.
const EVERY_SIZE: &str = "all";

/// Sizes: `all`, or names with commas between, each with how many garments of it where that is not
/// one, as in S,M:2.
pub fn sizes(text: &str) -> Result<SizeSelection, String> {
    if text == EVERY_SIZE {
        return Ok(SizeSelection::All);
    }
    let each = text.split(',').map(|one| {
        let (name, count) = one.rsplit_once(':').unwrap_or((one, "1"));
        match count.parse() {
            Ok(count @ 1..=MAX_GARMENTS) => Ok((name.to_owned(), count)),
            _ => Err(format!(
                "{count:?} is no number of garments from 1 to {MAX_GARMENTS}; write NAME:COUNT"
            )),
        }
    });
    each.collect::<Result<_, _>>().map(SizeSelection::Named)
}

/// A share, as in 2% or 0.02.
pub fn share(text: &str) -> Result<f64, String> {
    let (number, unit) = match text.strip_suffix('%') {
        Some(number) => (number, 0.01),
        None => (text, 1.0),
    };
    match number.trim().parse::<f64>() {
        Ok(value) if value.is_finite() && value > 0.0 && value * unit <= 1.0 => Ok(value * unit),
        Ok(_) | Err(_) => {
            Err("give a share above zero and up to 100%, as in 2% or 0.02".to_owned())
        }
    }
}

/// A direction in space, as in 0,1,0.
pub fn direction(text: &str) -> Result<[f64; 3], String> {
    let wrong = || "give three numbers with commas, not all zero, as in 0,1,0".to_owned();
    let numbers: Vec<f64> = (text.split(','))
        .map(|one| one.trim().parse().map_err(|_| wrong()))
        .collect::<Result<_, _>>()?;
    match numbers[..] {
        [x, y, z] if [x, y, z].iter().all(|n| n.is_finite()) && [x, y, z] != [0.0; 3] => {
            Ok([x, y, z])
        }
        _ => Err(wrong()),
    }
}

/// What an export writes, as in marker-dxf.
pub fn export_format(text: &str) -> Result<ExportFormat, String> {
    ExportFormat::named(text).ok_or_else(|| {
        let names = ExportFormat::ALL.map(ExportFormat::name);
        format!("choose from {}", names.join(", "))
    })
}

/// The name of one size, of which one garment is made.
pub fn one_size(text: &str) -> Result<String, String> {
    match sizes(text)? {
        SizeSelection::Named(names) if names.len() == 1 && names[0].1 == 1 => {
            Ok(names[0].0.clone())
        }
        _ => Err("one garment is made, of one size: give one name; \
                  `toile check`, `print` and `nest` take several sizes"
            .to_owned()),
    }
}

/// A gait and its share from 0 to 1, as in run:0.3.
pub fn blend(text: &str) -> Result<(String, f64), String> {
    let parts = text.split_once(':');
    let share = parts.and_then(|(_, share)| share.parse::<f64>().ok());
    match (parts, share) {
        (Some((gait @ ("walk" | "run"), _)), Some(share)) if (0.0..=1.0).contains(&share) => {
            Ok((gait.to_owned(), share))
        }
        _ => Err(format!(
            "{text:?} is no gait with a share from 0 to 1; write for example run:0.3"
        )),
    }
}

/// A point of the body that panels are placed round, or its height above the floor, as in 90cm.
pub fn panel_origin(text: &str) -> Result<PanelOrigin, String> {
    let length: Result<Length, _> = text.parse();
    match (text, length) {
        ("auto", _) => Ok(PanelOrigin::Automatic),
        ("floor", _) => Ok(PanelOrigin::Floor),
        ("waist", _) => Ok(PanelOrigin::Waist),
        ("pelvis", _) => Ok(PanelOrigin::Pelvis),
        (_, Ok(height)) => Ok(PanelOrigin::Height(height.as_metres())),
        _ => Err(format!(
            "{text:?} is no point that panels are placed round; write auto, floor, waist, pelvis, or its height above the floor, as in 90cm"
        )),
    }
}

/// Lengths with commas between (m).
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

/// One of a closed list of words, each with what it means.
fn choice<T: Choice + Send + Sync + 'static>(
    all: &'static [(T, &'static str)],
) -> impl TypedValueParser<Value = T> {
    let words = all
        .iter()
        .map(|(choice, meaning)| PossibleValue::new(choice.word()).help(*meaning));
    PossibleValuesParser::new(words).try_map(|word| {
        let found = all.iter().find(|(choice, _)| choice.word() == word);
        found.map(|(choice, _)| *choice).ok_or("it is not known")
    })
}

/// One of the words of a closed list.
pub fn word<T: Choice + Send + Sync + 'static>() -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(T::words()).try_map(|word| {
        let found = T::all().iter().find(|choice| choice.word() == word);
        found.copied().ok_or("it is not known")
    })
}

/// Which way pieces may point.
pub fn nap() -> impl TypedValueParser<Value = NapRule> {
    choice(&[
        (NapRule::None, "Pieces may point either way"),
        (NapRule::OneWay, "All pieces point one way"),
        (NapRule::PerGarment, "All pieces of a garment point one way"),
    ])
}

/// How fabric is spread.
pub fn spread() -> impl TypedValueParser<Value = Spread> {
    choice(&[
        (Spread::Open, "Open, right side up"),
        (
            Spread::Folded,
            "Folded in two along the warp: pieces cut on the fold lie on it, pairs are cut at once",
        ),
        (
            Spread::Tubular,
            "A tube laid flat, a fold at both sides; its width is its girth",
        ),
        (
            Spread::FaceToFace,
            "Open, every second ply turned over: pairs are cut at once",
        ),
    ])
}

/// A roll of a length and, if that is not the fabric's, a width.
pub fn roll(text: &str) -> Result<Roll, String> {
    let roll = |length, width| Roll {
        length: Some(length),
        width,
        ..Roll::default()
    };
    match lengths(text)?[..] {
        [length] => Ok(roll(length, None)),
        [length, width] => Ok(roll(length, Some(width))),
        ref more => Err(format!(
            "there are {} lengths; give the roll's length, or length,width",
            more.len()
        )),
    }
}

/// A print that repeats along the warp and, if it repeats there, across.
pub fn repeat(text: &str) -> Result<Print, String> {
    let print = |repeat| Print {
        repeat,
        origin: [0.0; 2],
    };
    match lengths(text)?[..] {
        [along] => Ok(print([along, 0.0])),
        [along, across] => Ok(print([along, across])),
        ref more => Err(format!(
            "there are {} lengths; give the repeat along the warp, or along,across",
            more.len()
        )),
    }
}

/// A flaw: four lengths with commas between (m), after the name of its fabric if there are several.
pub fn flaw(text: &str) -> Result<GivenFlaw, String> {
    let (fabric, place) = match text.rsplit_once(':') {
        Some((fabric, place)) => (Some(fabric.to_owned()), place),
        None => (None, text),
    };
    let lengths = lengths(place)?;
    let count = lengths.len();
    let place = lengths
        .try_into()
        .map_err(|_| format!("there are {count} lengths; give four"))?;
    Ok(GivenFlaw { fabric, place })
}

/// A length on paper to a length of cloth, as in 1:4.
pub fn scale(text: &str) -> Result<f64, String> {
    let parts = text.split_once(':');
    let number = |part: &str| part.trim().parse::<f64>().ok();
    let parts = parts.and_then(|(paper, cloth)| Some((number(paper)?, number(cloth)?)));
    match parts {
        Some((paper, cloth)) if paper > 0.0 && cloth > 0.0 && (paper / cloth).is_finite() => {
            Ok(paper / cloth)
        }
        _ => Err(format!(
            "{text:?} is no scale; write paper:cloth, as in 1:4, from 1:100 to 2:1"
        )),
    }
}

/// What cloth loses along warp and weft in percent, as in 3,1.5.
pub fn shrinkage(text: &str) -> Result<Shrinkage, String> {
    let percents: Option<Vec<f64>> = text.split(',').map(|p| p.trim().parse().ok()).collect();
    let shrinkage = match percents.as_deref() {
        Some(&[warp, weft]) => Shrinkage {
            warp: warp / 100.0,
            weft: weft / 100.0,
        },
        _ => {
            return Err(format!(
                "{text:?} is no pair of percents; write WARP,WEFT, as in 3,1.5"
            ));
        }
    };
    match shrinkage.is_sound() {
        true => Ok(shrinkage),
        false => Err(format!("{text:?} is beyond any cloth; give -50 to 50 %")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flaw_may_name_its_fabric() {
        let place = [1.0, 0.2, 0.03, 0.01];
        assert_eq!(flaw("1m,20cm,3cm,10mm"), Ok(GivenFlaw::at(place)));
        let named = flaw("fine: lining:1m,20cm,3cm,10mm").unwrap();
        assert_eq!(named.fabric.as_deref(), Some("fine: lining"));
        assert_eq!(named.place, place);
        assert!(
            flaw("lining:1m,20cm,3cm")
                .unwrap_err()
                .contains("3 lengths")
        );
    }
}
