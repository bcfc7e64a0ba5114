//! Flaws of the fabric: measured on the open fabric, mapped to their positions on the spread fabric.

use crate::MarkerError;
use toile_geometry::{Bounds2, Polygon, Vec2};
use toile_pattern::{Flaw, Spread};

/// Tolerance by which a flaw may extend beyond the edge of the fabric (m).
const ROUNDING: f64 = 1e-9;

/// A flaw given on the command line.
#[derive(Clone, Debug, PartialEq)]
pub struct GivenFlaw {
    /// Name of the fabric with the flaw; not needed if there is only one fabric.
    pub fabric: Option<String>,
    /// Corner (x along the warp, y across it), length and width on the open fabric (m).
    pub place: [f64; 4],
}

impl GivenFlaw {
    /// A flaw of the only fabric, given by x, y, length and width (m).
    pub fn at(place: [f64; 4]) -> Self {
        Self {
            fabric: None,
            place,
        }
    }

    /// The flaw without the name of its fabric.
    pub(crate) fn flaw(&self) -> Flaw {
        let [x, y, length, width] = self.place;
        Flaw {
            at: [x, y],
            size: [length, width],
            clearance: 0.0,
        }
    }

    /// Whether it is on a fabric.
    pub(crate) fn is_on(&self, fabric: &str) -> bool {
        self.fabric.as_deref().is_none_or(|own| own == fabric)
    }
}

/// Refuses a flaw without fabric name if there are several fabrics, and one of a fabric that nothing is cut
/// from.
pub(crate) fn check_given(flaws: &[GivenFlaw], fabrics: &[&str]) -> Result<(), MarkerError> {
    for flaw in flaws {
        match flaw.fabric.as_deref() {
            None if fabrics.len() > 1 => {
                return Err(MarkerError::Conflict(format!(
                    "a flaw lies on one fabric, and pieces are cut from several: {}; name it, as in --defect {}:20cm,30cm,1cm,1cm",
                    fabrics.join(", "),
                    fabrics[0]
                )));
            }
            Some(name) if !fabrics.contains(&name) => {
                return Err(MarkerError::Unknown {
                    kind: "fabric",
                    name: name.to_owned(),
                    hint: format!("pieces are cut from: {}", fabrics.join(", ")),
                });
            }
            _ => {}
        }
    }
    Ok(())
}

/// The flaws of a fabric with an open width (m), in the plane of the spread fabric. A flaw across a fold
/// gives one on each layer.
pub(crate) fn flaws_on(
    flaws: &[Flaw],
    (fabric, width): (&str, f64),
    spread: Spread,
) -> Result<Vec<toile_nesting::Flaw>, MarkerError> {
    let mut spread_flaws = Vec::new();
    for (k, flaw) in flaws.iter().enumerate() {
        let [x, low] = flaw.at;
        let [length, high] = [flaw.size[0], low + flaw.size[1]];
        let inside = x >= 0.0 && low >= -ROUNDING && high <= width + ROUNDING;
        if !inside {
            return Err(MarkerError::Conflict(format!(
                "flaw {} of fabric {fabric:?} reaches from {:.0} to {:.0} mm across and starts at {:.0} mm; the fabric laid open is {:.0} mm wide and starts at 0: measure the flaw on the open fabric",
                k + 1,
                low * 1e3,
                high * 1e3,
                x * 1e3,
                width * 1e3
            )));
        }
        for [low, high] in as_spread([low, high], width, spread) {
            spread_flaws.push(toile_nesting::Flaw {
                outline: Polygon::rectangle(Bounds2 {
                    min: Vec2::new(x, low),
                    max: Vec2::new(x + length, high),
                }),
                clearance: flaw.clearance,
            });
        }
    }
    Ok(spread_flaws)
}

/// Positions on the spread fabric of a span across the open fabric (m). On folded fabric the middle of the
/// open fabric is the fold, at 0, and the selvedges meet; a tube is measured round from its fold at 0.
fn as_spread([low, high]: [f64; 2], width: f64, spread: Spread) -> Vec<[f64; 2]> {
    let middle = 0.5 * width;
    if matches!(spread, Spread::Open | Spread::FaceToFace) {
        return vec![[low, high]];
    }
    let lower = [low.min(middle), high.min(middle)];
    let upper = [low.max(middle), high.max(middle)];
    let is_folded = spread == Spread::Folded;
    let placed = |[low, high]: [f64; 2]| match (is_folded, high <= middle) {
        (true, true) => [middle - high, middle - low],
        (true, false) => [low - middle, high - middle],
        (false, true) => [low, high],
        (false, false) => [width - high, width - low],
    };
    if high <= middle || low >= middle {
        // All on one layer, or a span of zero width, which the job's check refuses.
        return vec![placed([low, high])];
    }
    vec![placed(lower), placed(upper)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spans(low: f64, high: f64, spread: Spread) -> Vec<[f64; 2]> {
        let flaw = Flaw {
            at: [1.0, low],
            size: [0.1, high - low],
            clearance: 0.0,
        };
        let found = flaws_on(&[flaw], ("cloth", 1.6), spread).unwrap();
        let span = |d: &toile_nesting::Flaw| [d.outline.bounds().min.y, d.outline.bounds().max.y];
        found.iter().map(span).collect()
    }

    fn same(found: &[[f64; 2]], wanted: &[[f64; 2]]) {
        assert_eq!(found.len(), wanted.len(), "{found:?}");
        for (a, b) in found.iter().flatten().zip(wanted.iter().flatten()) {
            assert!((a - b).abs() < 1e-12, "{found:?} {wanted:?}");
        }
    }

    #[test]
    fn flaws_lie_where_the_fabric_is_folded_to() {
        same(&spans(1.2, 1.3, Spread::Open), &[[1.2, 1.3]]);
        same(&spans(1.2, 1.3, Spread::Folded), &[[0.4, 0.5]]);
        same(&spans(0.1, 0.2, Spread::Folded), &[[0.6, 0.7]]);
        same(&spans(0.7, 0.9, Spread::Folded), &[[0.0, 0.1], [0.0, 0.1]]);
        same(&spans(1.2, 1.3, Spread::Tubular), &[[0.3, 0.4]]);
        same(&spans(0.1, 0.2, Spread::Tubular), &[[0.1, 0.2]]);
        same(
            &spans(0.75, 0.9, Spread::Tubular),
            &[[0.75, 0.8], [0.7, 0.8]],
        );
    }

    #[test]
    fn flaws_beside_the_fabric_are_refused() {
        for (x, y) in [
            (1.0, 2.0),
            (1.0, 1.55),
            (1.0, -0.1),
            (-0.2, 0.5),
            (f64::NAN, 0.5),
        ] {
            let flaw = Flaw {
                at: [x, y],
                size: [0.1, 0.1],
                clearance: 0.0,
            };
            let error = flaws_on(&[flaw], ("cloth", 1.6), Spread::Open).unwrap_err();
            assert!(error.to_string().contains("flaw 1"), "{error}");
        }
    }
}
