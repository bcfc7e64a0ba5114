//! The size of a unit of a drawing: by its width and view box, else by the program that wrote it, else by the
//! sizes of its pieces.

use super::viewport::{PIXELS, Viewport, view_box};
use crate::{FormatError, Guess, ReadOption};
use kurbo::Affine;
use roxmltree::Node;
use std::str::FromStr;
use svgtypes::{AspectRatio, Length, LengthUnit};
use toile_pattern::DisplayUnit;
use toile_pattern::fields::Choice;

/// Sizes that the largest piece of a garment may have (m).
const PIECE_SIZES: [f64; 2] = [0.2, 2.5];
const INCH: f64 = 0.0254;

/// Statements of a file about the size of its units.
#[derive(Clone, Debug)]
pub(super) struct Scale {
    /// The size of a unit (m), if the file states it.
    pub stated: Option<f64>,
    /// Pixels to the inch of the program that wrote the file, and the reason.
    pub pixels: (f64, &'static str),
    /// A unit in pixels.
    in_pixels: f64,
    /// Stretch of the drawing's units, where its page stretches them one way.
    pub root: Affine,
    /// The page: its corner and size in units, if it has one.
    pub page: Option<[f64; 4]>,
}

impl Scale {
    /// Reads the statements of the root element.
    ///
    /// # Errors
    /// A view box without an area, in which nothing is drawn.
    pub fn of(root: Node<'_, '_>, text: &str) -> Result<Self, FormatError> {
        let own = view_box(root);
        if root.has_attribute("viewBox") && !own.is_some_and(|[.., w, h]| w > 0.0 && h > 0.0) {
            return Err(FormatError::new(
                "the root element",
                "its view box has no area, so nothing of the drawing shows",
                "give viewBox four numbers, of which width and height are greater than 0",
            ));
        }
        let size = |name: &str| Length::from_str(root.attribute(name)?.trim()).ok();
        let [width, height] = ["width", "height"].map(size);
        let physical = |length: Option<Length>| {
            let Length { number, unit } = length?;
            let metres = match unit {
                LengthUnit::In => INCH,
                LengthUnit::Cm => 0.01,
                LengthUnit::Mm => 0.001,
                LengthUnit::Pt => INCH / 72.0,
                LengthUnit::Pc => INCH / 6.0,
                LengthUnit::None
                | LengthUnit::Em
                | LengthUnit::Ex
                | LengthUnit::Px
                | LengthUnit::Percent => return None,
            };
            Some(number * metres).filter(|size| size.is_finite() && *size > 0.0)
        };
        let pixel = |length: Option<Length>| {
            let Length { number, unit } = length?;
            let is_pixels = matches!(unit, LengthUnit::None | LengthUnit::Px);
            (is_pixels && number.is_finite() && number > 0.0).then_some(number)
        };
        let mut scale = Self {
            stated: None,
            pixels: pixels(root, text),
            in_pixels: 1.0,
            root: Affine::IDENTITY,
            page: own,
        };
        let Some([_, _, w, h]) = own else {
            // Without a view box a unit is a pixel, whatever the size of the page.
            let page = [width, height].map(|length| {
                physical(length)
                    .map(|size| size / INCH * PIXELS)
                    .or(pixel(length))
            });
            if let [Some(w), Some(h)] = page {
                scale.page = Some([0.0, 0.0, w, h]);
            }
            return Ok(scale);
        };
        let aspect = root.attribute("preserveAspectRatio");
        let aspect = aspect.and_then(|text| AspectRatio::from_str(text.trim()).ok());
        let shares = |[a, b]: [Option<f64>; 2]| [a.map(|size| size / w), b.map(|size| size / h)];
        let mut chosen = |shares: [Option<f64>; 2]| match shares {
            [Some(a), Some(b)] => Some(match aspect {
                Some(AspectRatio {
                    align: svgtypes::Align::None,
                    ..
                }) => {
                    scale.root = Affine::scale_non_uniform(1.0, b / a);
                    a
                }
                Some(AspectRatio { slice: true, .. }) => a.max(b),
                Some(_) | None => a.min(b),
            }),
            [a, b] => a.or(b),
        };
        let metres = chosen(shares([physical(width), physical(height)]));
        let in_pixels = match metres {
            Some(_) => None,
            None => chosen(shares([pixel(width), pixel(height)])),
        };
        scale.stated = metres;
        scale.in_pixels = in_pixels.unwrap_or(1.0);
        Ok(scale)
    }

    /// The viewport of the whole drawing, in its units.
    pub fn viewport(&self) -> Viewport {
        let [.., width, height] = self.page.unwrap_or([0.0, 0.0, 100.0, 100.0]);
        Viewport { width, height }
    }

    /// The size of a unit (m): as asked for, else as stated, else as the program that wrote the file counts
    /// pixels, unless only another unit makes the largest piece, of an extent in units, the size of a piece of
    /// a garment.
    pub fn metres(&self, asked: Option<DisplayUnit>, largest: f64) -> (f64, Option<Guess>) {
        if let Some(asked) = asked {
            return (asked.metres(), None);
        }
        if let Some(stated) = self.stated {
            return (stated, None);
        }
        let (pixels, because) = self.pixels;
        let usual = INCH / pixels * self.in_pixels;
        let fits = |metres: f64| (PIECE_SIZES[0]..=PIECE_SIZES[1]).contains(&(largest * metres));
        let units = [
            DisplayUnit::Millimetre,
            DisplayUnit::Centimetre,
            DisplayUnit::Inch,
            DisplayUnit::Metre,
        ];
        let other = units.into_iter().find(|unit| fits(unit.metres()));
        let (metres, chosen, because) = match other {
            Some(unit) if !fits(usual) => (unit.metres(), unit.word().to_owned(), ""),
            Some(_) | None => (usual, format!("1/{pixels} in"), because),
        };
        let size = format!(
            "the largest piece is then {:.0} cm",
            largest * metres * 100.0
        );
        let because = match because {
            "" => format!("the file states none; {size}"),
            _ => format!("the file states none; {because}; {size}"),
        };
        let guess = Guess {
            what: "unit",
            chosen,
            because,
            option: ReadOption::Unit,
        };
        (metres, Some(guess))
    }
}

/// Pixels to the inch of the program that wrote a file, and the reason.
fn pixels(root: Node<'_, '_>, text: &str) -> (f64, &'static str) {
    const INKSCAPE: &str = "http://www.inkscape.org/namespaces/inkscape";
    let version = root.attribute((INKSCAPE, "version")).unwrap_or_default();
    let mut numbers = version.split(['.', ' ']).map(str::parse::<u32>);
    if let (Some(Ok(0)), Some(Ok(minor))) = (numbers.next(), numbers.next())
        && minor < 92
    {
        return (90.0, "Inkscape before 0.92 has 90 pixels to the inch");
    }
    // Illustrator names itself in a comment or in its spaces.
    let head: String = text.chars().take(2000).collect();
    if head.contains("Adobe Illustrator") || head.contains("ns.adobe.com/AdobeIllustrator") {
        return (72.0, "Illustrator has 72 pixels to the inch");
    }
    (PIXELS, "96 pixels to the inch are usual")
}
