//! The implicit surface of one part, with derivatives by the unknowns of its primitives.

use crate::{Part, Primitive, THRESHOLD};
use nalgebra::Matrix3;
use toile_geometry::Vec3;

/// Number of unknowns of a primitive: centre, logarithms of the semi-axes, turn, logarithm of the weight.
pub(crate) const UNKNOWNS: usize = 10;

/// A primitive ready for evaluation. `inverse` is 1 over each semi-axis (1/m), `reach` the square of the
/// largest semi-axis (m2).
struct Ready {
    centre: Vec3,
    turn: Matrix3<f64>,
    inverse: Vec3,
    weight: f64,
    reach: f64,
    /// Whether the mirror image of the primitive belongs to the same part.
    twin: bool,
    /// Whether the primitive is its own mirror image: it then neither moves nor turns sideways.
    central: bool,
}

/// The implicit surface of one part of the left side and the median plane.
pub(crate) struct Surface {
    all: Vec<Ready>,
}

/// Number of a primitive, and derivatives by its unknowns.
pub(crate) type Row = (usize, [f64; UNKNOWNS]);

fn ready(p: &Primitive) -> Ready {
    Ready {
        centre: Vec3::from(p.centre),
        turn: *p.rotation().matrix(),
        inverse: Vec3::from(p.radii).map(|r| 1.0 / r),
        weight: p.weight,
        reach: p.radii.iter().copied().fold(0.0, f64::max).powi(2),
        twin: matches!(p.part, Part::Trunk | Part::Head) && !p.is_central(),
        central: p.is_central(),
    }
}

/// Density of a primitive at a point, with its gradient and its derivatives by the unknowns; `None` if the
/// density is 0 there. The derivative by the centre is the negative gradient.
fn density(p: &Ready, place: Vec3) -> Option<(f64, Vec3, [f64; UNKNOWNS])> {
    let offset = place - p.centre;
    if offset.norm_squared() >= p.reach {
        return None;
    }
    let unit = p.turn.tr_mul(&offset).component_mul(&p.inverse);
    let q = unit.norm_squared();
    if q >= 1.0 {
        return None;
    }
    let value = p.weight * (1.0 - q) * (1.0 - q);
    let slope = -2.0 * p.weight * (1.0 - q);
    let toward = p.turn * unit.component_mul(&p.inverse);
    let gradient = toward * (2.0 * slope);
    // A turn of the ellipsoid by w turns the offset by -w.
    let turned = toward.cross(&offset) * (2.0 * slope);
    let sized = unit.component_mul(&unit) * (-2.0 * slope);
    let row = [
        -gradient.x,
        -gradient.y,
        -gradient.z,
        sized.x,
        sized.y,
        sized.z,
        turned.x,
        turned.y,
        turned.z,
        value,
    ];
    Some((value, gradient, row))
}

impl Surface {
    pub(crate) fn new(primitives: &[Primitive]) -> Self {
        Self {
            all: primitives.iter().map(ready).collect(),
        }
    }

    /// Number of primitives.
    pub(crate) fn count(&self) -> usize {
        self.all.len()
    }

    /// Density at a point and its gradient; `touched` gets the rows of the primitives that reach the point.
    pub(crate) fn at(&self, place: Vec3, touched: &mut Vec<Row>) -> (f64, Vec3) {
        touched.clear();
        let (mut value, mut gradient) = (0.0, Vec3::zeros());
        let image = Vec3::new(-place.x, place.y, place.z);
        for (k, p) in self.all.iter().enumerate() {
            let own = density(p, place);
            let twin = if p.twin { density(p, image) } else { None };
            let mut row = [0.0; UNKNOWNS];
            if let Some((v, g, r)) = own {
                value += v;
                gradient += g;
                row = r;
            }
            if let Some((v, g, r)) = twin {
                value += v;
                gradient += Vec3::new(-g.x, g.y, g.z);
                row.iter_mut().zip(r).for_each(|(a, b)| *a += b);
            }
            if p.central {
                [row[0], row[7], row[8]] = [0.0; 3];
            }
            if own.is_some() || twin.is_some() {
                touched.push((k, row));
            }
        }
        (value, gradient)
    }

    /// Distance in the level plane by which the surface lies outside a point, to first order (m), and the
    /// slope of the density in that plane (1/m).
    pub(crate) fn beyond(&self, place: Vec3, touched: &mut Vec<Row>) -> (f64, f64) {
        /// Least slope in the level plane that is used, as a share of the whole slope: a nearly level surface
        /// would otherwise seem to lie far away.
        const LEVEL: f64 = 0.15;
        let (value, gradient) = self.at(place, touched);
        let steep = gradient.x.hypot(gradient.z).max(LEVEL * gradient.norm());
        ((value - THRESHOLD) / steep.max(1e-6), steep.max(1e-6))
    }

    /// Lengthening of a tape if it is laid round the surface instead of through its corners (m).
    pub(crate) fn lengthening(&self, corners: &[(Vec3, f64)]) -> f64 {
        let mut touched = Vec::new();
        corners
            .iter()
            .map(|&(place, turn)| turn * self.beyond(place, &mut touched).0)
            .sum()
    }
}
