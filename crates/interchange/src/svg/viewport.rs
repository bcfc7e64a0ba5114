//! Lengths of attributes, and the part of a drawing that a viewport shows.

use kurbo::Affine;
use roxmltree::Node;
use std::str::FromStr;
use svgtypes::{Align, AspectRatio, Length, LengthUnit, ViewBox};

/// Pixels to the inch, as CSS has them.
pub(super) const PIXELS: f64 = 96.0;

/// A viewport: width and height in units of what lies in it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Viewport {
    pub width: f64,
    pub height: f64,
}

impl Viewport {
    /// The length that a share of 1 means: of a width, a height, or neither.
    fn whole(self, axis: Axis) -> f64 {
        match axis {
            Axis::X => self.width,
            Axis::Y => self.height,
            Axis::Both => (0.5 * (self.width.powi(2) + self.height.powi(2))).sqrt(),
        }
    }
}

/// The direction of a length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Axis {
    X,
    Y,
    Both,
}

/// A length of an attribute in pixels; `None` if it has none, or one that is not finite.
pub(super) fn length(
    node: Node<'_, '_>,
    name: &str,
    (axis, viewport): (Axis, Viewport),
) -> Option<f64> {
    let Length { number, unit } = Length::from_str(node.attribute(name)?.trim()).ok()?;
    let value = match unit {
        LengthUnit::None | LengthUnit::Px => number,
        LengthUnit::In => number * PIXELS,
        LengthUnit::Cm => number * PIXELS / 2.54,
        LengthUnit::Mm => number * PIXELS / 25.4,
        LengthUnit::Pt => number * PIXELS / 72.0,
        LengthUnit::Pc => number * PIXELS / 6.0,
        LengthUnit::Em => number * 16.0,
        LengthUnit::Ex => number * 8.0,
        LengthUnit::Percent => number / 100.0 * viewport.whole(axis),
    };
    value.is_finite().then_some(value)
}

/// The view box of an element; `None` if it has none. A box without an area is returned as it is.
pub(super) fn view_box(node: Node<'_, '_>) -> Option<[f64; 4]> {
    let text = node.attribute("viewBox")?;
    if let Ok(ViewBox { x, y, w, h }) = ViewBox::from_str(text.trim()) {
        return Some([x, y, w, h]).filter(|all| all.iter().all(|value| value.is_finite()));
    }
    // The parser refuses a box without an area.
    let numbers: Result<Vec<f64>, _> = svgtypes::NumberListParser::from(text.trim()).collect();
    let numbers = numbers.ok()?;
    let all: [f64; 4] = numbers.try_into().ok()?;
    all.iter().all(|value| value.is_finite()).then_some(all)
}

/// The map from a view box to a viewport of a size.
pub(super) fn fitted(node: Node<'_, '_>, [x, y, w, h]: [f64; 4], size: Viewport) -> Affine {
    let aspect = node.attribute("preserveAspectRatio");
    let aspect = aspect.and_then(|text| AspectRatio::from_str(text.trim()).ok());
    let aspect = aspect.unwrap_or(AspectRatio {
        defer: false,
        align: Align::XMidYMid,
        slice: false,
    });
    let [sx, sy] = [size.width / w, size.height / h];
    let uniform = match aspect.slice {
        true => sx.max(sy),
        false => sx.min(sy),
    };
    let [across, down] = match aspect.align {
        Align::None => {
            return Affine::scale_non_uniform(sx, sy) * Affine::translate((-x, -y));
        }
        Align::XMinYMin => [0.0, 0.0],
        Align::XMidYMin => [0.5, 0.0],
        Align::XMaxYMin => [1.0, 0.0],
        Align::XMinYMid => [0.0, 0.5],
        Align::XMidYMid => [0.5, 0.5],
        Align::XMaxYMid => [1.0, 0.5],
        Align::XMinYMax => [0.0, 1.0],
        Align::XMidYMax => [0.5, 1.0],
        Align::XMaxYMax => [1.0, 1.0],
    };
    let rest = [
        (size.width - w * uniform) * across,
        (size.height - h * uniform) * down,
    ];
    Affine::translate((rest[0], rest[1])) * Affine::scale(uniform) * Affine::translate((-x, -y))
}
