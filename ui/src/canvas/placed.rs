//! A candidate place for a point, with its construction.

use super::scene::{CurveScene, SheetScene};
use toile_geometry::Vec2;
use toile_pattern::plan::EdgePart;
use toile_pattern::{Mark, Name, Number, PointId, PointRule, SheetId};

/// Grid steps (m), each with the least enlargement it is used at (pixels per metre).
const GRID: [(f64, f64); 4] = [(0.001, 8000.0), (0.005, 1600.0), (0.01, 500.0), (0.05, 0.0)];

/// Largest step that a drag is rounded to (m).
const MAX_ROUNDING: f64 = 0.001;

/// The construction of a point at a place.
#[derive(Clone, Debug, PartialEq)]
pub enum Spec {
    /// An existing point.
    Point(PointId),
    /// A new point by a rule.
    New(PointRule),
    /// A new point at a distance and an angle from the place given before.
    FromLast {
        /// The distance (m).
        distance: Number,
        /// The angle (rad), from +x counter-clockwise.
        angle: Number,
    },
    /// A new point at an offset from the place given before.
    BesideLast {
        /// Offset to the right (m).
        x: Number,
        /// Offset upward (m).
        y: Number,
    },
}

/// A candidate place for a point.
#[derive(Clone, Debug, PartialEq)]
pub struct Placed {
    /// The sheet.
    pub sheet: SheetId,
    /// Coordinates on the sheet (m).
    pub at: Vec2,
    /// Construction of a point there.
    pub spec: Spec,
    /// Description of the place; empty for a free one.
    pub words: String,
}

impl Placed {
    /// A place without a relation to other parts.
    pub fn free(sheet: SheetId, at: Vec2) -> Self {
        Self {
            sheet,
            at,
            spec: Spec::New(PointRule::at(at.x, at.y)),
            words: String::new(),
        }
    }

    /// The existing point at this place; `None` if there is none.
    pub fn point(&self) -> Option<PointId> {
        match self.spec {
            Spec::Point(id) => Some(id),
            _ => None,
        }
    }
}

/// Grid step at an enlargement (m).
pub fn grid_step(scale: f64) -> f64 {
    let step = GRID.iter().find(|(_, least)| scale >= *least);
    step.map_or(0.05, |(step, _)| *step)
}

/// Rounding step of lengths in a drag (m), for a pixel of this width (m): the least of 1, 2 or 5 times a
/// power of ten of a unit (m) that is not less than the pixel, and at most a millimetre.
pub fn drag_step(pixel: f64, unit: f64) -> f64 {
    let wanted = pixel.clamp(1e-9, MAX_ROUNDING);
    let power = 10.0_f64.powf((wanted / unit).log10().floor());
    let steps = [0.5, 1.0, 2.0, 5.0, 10.0].map(|step| step * power * unit);
    let is_fit =
        |step: &f64| *step >= wanted * (1.0 - 1e-9) && *step <= MAX_ROUNDING * (1.0 + 1e-9);
    let most = || {
        steps
            .into_iter()
            .rfind(|step| *step <= MAX_ROUNDING * (1.0 + 1e-9))
    };
    let found = steps.into_iter().find(is_fit);
    found.or_else(most).unwrap_or(MAX_ROUNDING)
}

/// The nearest multiple of a step, with few digits: 0.3, not 0.30000000000000004.
pub fn rounded(value: f64, step: f64) -> f64 {
    ((value / step).round() * step * 1e6).round() / 1e6
}

/// Curves within `reach` of a point (m), the nearest first. With each: the length of the curve up to its
/// point nearest to the given one (m), and that point (m).
pub fn near_curves(sheet: &SheetScene, at: Vec2, reach: f64) -> Vec<(&CurveScene, f64, Vec2)> {
    let mut near: Vec<(f64, &CurveScene, f64, Vec2)> = sheet
        .curves
        .iter()
        .filter_map(|curve| {
            let place = curve.path.nearest(at)?;
            let point = curve.path.point(place);
            let away = (point - at).norm();
            (away <= reach).then_some((away, curve, place.along, point))
        })
        .collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    near.into_iter()
        .map(|(_, curve, along, point)| (curve, along, point))
        .collect()
}

/// A place on a curve, at a share of the curve's length, with coordinates `at` (m).
pub fn on_curve(
    sheet: SheetId,
    curve: &CurveScene,
    (share, at): (f64, Vec2),
    words: &str,
) -> Placed {
    Placed {
        sheet,
        at,
        spec: Spec::New(PointRule::OnCurve {
            curve: curve.id,
            share: Number::Value(share),
        }),
        words: format!("{words} {}", curve.name),
    }
}

/// A place on an edge of the panel that a sheet lies on, at a share of the edge, with coordinates `at` (m).
pub fn on_edge(sheet: SheetId, part: &EdgePart, (share, at): (f64, Vec2), words: &str) -> Placed {
    let mark = Mark::Between {
        ends: part.ends,
        share: Number::Value(share),
    };
    let line = Name::Drawn(part.line);
    Placed {
        sheet,
        at,
        spec: Spec::New(PointRule::Mark { line, at: mark }),
        words: words.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drags_are_rounded_to_what_is_seen_and_no_more_than_a_millimetre() {
        for (pixel, unit, step) in [
            (0.0007, 0.01, 0.001),
            (0.003, 0.01, 0.001),
            (0.0003, 0.01, 0.0005),
            (0.00015, 0.001, 0.0002),
            (0.00001, 0.001, 0.00001),
            (0.002, 0.0254, 0.02 * 0.0254),
            (0.0001, 0.0254, 0.005 * 0.0254),
        ] {
            let found = drag_step(pixel, unit);
            assert!((found - step).abs() < 1e-9, "{pixel} {unit}: {found}");
        }
    }
}
