//! The implicit surface of a body part: a sum of ellipsoidal densities.
//!
//! # Decided with
//! - [`crate::template`]: primitives and joints before measurements; a table for each figure;
//! - [`crate::rings`], [`crate::limbs`], [`crate::hand`], [`crate::fingers`]: surface cast to rings: trunk,
//!   limbs, hand;
//! - [`crate::underarm`], [`crate::arm_rings`], [`crate::strips`]: under the arm; rings of foreign arms;
//!   triangles;
//! - [`crate::bones`], [`crate::skinning`]: joints placed; shares of joints at a vertex;
//! - [`crate::character`]: the same as a character of real time;
//! - [`crate::dress_form`]: cut to a dress form.

use nalgebra::{Matrix3, Rotation3};
use serde::{Deserialize, Serialize};
use strum::{EnumCount, VariantArray};
use toile_geometry::Vec3;

/// The density at which the surface of a part lies.
pub const THRESHOLD: f64 = 0.5;

/// Ratio of the visible radius of a lone primitive to its effective radius: the root of
/// `(1 - r^2)^2 = 1/2`.
pub const VISIBLE_RATIO: f64 = 0.541_196_100_146_197;

/// A group of primitives whose densities add up. Densities never add across parts, so that an arm
/// beside the trunk does not grow a web to it.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Hash,
    Serialize,
    Deserialize,
    EnumCount,
    VariantArray,
)]
#[serde(rename_all = "snake_case")]
pub enum Part {
    /// From the crotch to the base of the neck.
    Trunk,
    /// Neck and head.
    Head,
    /// The arm and hand on the wearer's left, +X.
    LeftArm,
    /// The arm and hand on the wearer's right, -X.
    RightArm,
    /// The leg and foot on the wearer's left, +X.
    LeftLeg,
    /// The leg and foot on the wearer's right, -X.
    RightLeg,
}

impl Part {
    /// All parts, in order.
    pub const ALL: [Self; Self::COUNT] = toile_geometry::all_variants!();

    /// The corresponding part of the other side; trunk and head correspond to themselves.
    pub fn mirrored(self) -> Self {
        match self {
            Part::LeftArm => Part::RightArm,
            Part::RightArm => Part::LeftArm,
            Part::LeftLeg => Part::RightLeg,
            Part::RightLeg => Part::LeftLeg,
            Part::Trunk | Part::Head => self,
        }
    }

    /// The name on screens.
    pub fn name(self) -> &'static str {
        match self {
            Part::Trunk => "trunk",
            Part::Head => "head",
            Part::LeftArm => "left arm",
            Part::RightArm => "right arm",
            Part::LeftLeg => "left leg",
            Part::RightLeg => "right leg",
        }
    }
}

/// Blending of a primitive with the others of its part (Volino et al. 1996).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Blend {
    /// The density adds to those of the part's other blendable primitives.
    #[default]
    Blendable,
    /// A plain ellipsoid: united with the rest of the part, without blending.
    Unblendable,
}

impl Blend {
    fn is_default(&self) -> bool {
        *self == Self::Blendable
    }
}

/// An ellipsoid with the density `w (1 - q)^2` inside `q < 1`, where `q = |S^-1 R^T (x - c)|^2` (Murakami and
/// Ichihara 1987, extended from a sphere to an ellipsoid).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Primitive {
    /// The part whose density the primitive adds to.
    pub part: Part,
    /// Centre c (m).
    pub centre: [f64; 3],
    /// Effective semi-axes, the diagonal of S, where the density reaches zero (m).
    pub radii: [f64; 3],
    /// Rotation R as axis times angle (rad).
    pub rotation: [f64; 3],
    /// Factor w of the density (1).
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub weight: f64,
    /// Whether the density adds to the densities of other primitives.
    #[serde(default, skip_serializing_if = "Blend::is_default")]
    pub blend: Blend,
    /// A second part that the primitive belongs to, for example near a shoulder or hip.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub also: Option<Part>,
}

fn one() -> f64 {
    1.0
}

fn is_one(weight: &f64) -> bool {
    *weight == 1.0
}

impl Primitive {
    /// A blendable primitive of one part, its axes along the body's: centre and effective
    /// semi-axes (m).
    pub fn new(part: Part, centre: [f64; 3], radii: [f64; 3]) -> Self {
        Self {
            part,
            centre,
            radii,
            rotation: [0.0; 3],
            weight: 1.0,
            blend: Blend::Blendable,
            also: None,
        }
    }

    /// Whether the primitive belongs to a part, as its own or as its second group.
    pub fn belongs_to(&self, part: Part) -> bool {
        self.part == part || self.also == Some(part)
    }

    /// The rotation R, from the primitive's axes to the body's.
    pub fn rotation(&self) -> Rotation3<f64> {
        Rotation3::new(Vec3::from(self.rotation))
    }

    /// The same primitive on the other side of the plane x = 0.
    pub fn mirrored(&self) -> Self {
        let part = self.part.mirrored();
        let ([x, y, z], [a, b, c]) = (self.centre, self.rotation);
        Self {
            part,
            centre: [-x, y, z],
            radii: self.radii,
            rotation: [a, -b, -c],
            also: self.also.map(Part::mirrored),
            ..*self
        }
    }

    /// Whether the primitive is its own mirror image.
    pub fn is_central(&self) -> bool {
        let middle = self.part == self.part.mirrored() && self.centre[0] == 0.0;
        middle && self.rotation[1] == 0.0 && self.rotation[2] == 0.0
    }

    /// Whether the primitive belongs to the wearer's right side: by its part, or, in trunk and head, by its
    /// centre. A limb's primitive may reach across the median plane.
    pub fn is_right(&self) -> bool {
        match self.part {
            Part::RightArm | Part::RightLeg => true,
            Part::LeftArm | Part::LeftLeg => false,
            Part::Trunk | Part::Head => self.centre[0] < 0.0,
        }
    }
}

/// A primitive made ready for evaluation.
#[derive(Clone, Copy, Debug)]
struct Density {
    centre: Vec3,
    /// S^-1 R^T (1/m).
    unit_from_body: Matrix3<f64>,
    /// Square of the largest semi-axis (m2).
    reach_squared: f64,
    weight: f64,
}

impl Density {
    /// The density at a point (1).
    fn at(&self, point: Vec3) -> f64 {
        let offset = point - self.centre;
        if offset.norm_squared() >= self.reach_squared {
            return 0.0;
        }
        let q = (self.unit_from_body * offset).norm_squared();
        let within = (1.0 - q).max(0.0);
        self.weight * within * within
    }

    /// Gradient of the density at a point (1/m): `-4 w (1 - q) R S^-1 u`, `u = S^-1 R^T (x - c)`.
    fn gradient(&self, point: Vec3) -> Vec3 {
        let unit = self.unit_from_body * (point - self.centre);
        let within = (1.0 - unit.norm_squared()).max(0.0);
        self.unit_from_body.tr_mul(&unit) * (-4.0 * self.weight * within)
    }
}

/// The primitives of one part.
#[derive(Clone, Debug, Default)]
struct Group {
    /// Blendable primitives, whose densities add up.
    blended: Vec<Density>,
    /// Unblendable primitives.
    plain: Vec<Density>,
}

/// The fields of all parts, ready for evaluation.
#[derive(Clone, Debug)]
pub struct Field {
    parts: [Group; 6],
}

impl Field {
    /// Makes primitives ready for evaluation.
    pub fn new(primitives: &[Primitive]) -> Self {
        let mut parts: [Group; 6] = Default::default();
        for primitive in primitives {
            let inverse = Matrix3::from_diagonal(&Vec3::from(primitive.radii).map(|r| 1.0 / r));
            let largest = primitive.radii.iter().copied().fold(0.0, f64::max);
            let density = Density {
                centre: Vec3::from(primitive.centre),
                unit_from_body: inverse * primitive.rotation().matrix().transpose(),
                reach_squared: largest * largest,
                weight: primitive.weight,
            };
            let second = primitive.also.filter(|&part| part != primitive.part);
            for part in std::iter::once(primitive.part).chain(second) {
                let group = &mut parts[part as usize];
                match primitive.blend {
                    Blend::Blendable => group.blended.push(density),
                    Blend::Unblendable => group.plain.push(density),
                }
            }
        }
        Self { parts }
    }

    /// Density of one part at a point: the sum of its blendable primitives or, if larger, the density of an
    /// unblendable one.
    pub fn density(&self, part: Part, point: Vec3) -> f64 {
        let group = &self.parts[part as usize];
        let sum: f64 = group.blended.iter().map(|d| d.at(point)).sum();
        group.plain.iter().map(|d| d.at(point)).fold(sum, f64::max)
    }

    /// Gradient of one part's density at a point (1/m).
    pub fn gradient(&self, part: Part, point: Vec3) -> Vec3 {
        let group = &self.parts[part as usize];
        let sum: f64 = group.blended.iter().map(|d| d.at(point)).sum();
        let mut best: (f64, Option<&Density>) = (sum, None);
        for density in &group.plain {
            let own = density.at(point);
            if own > best.0 {
                best = (own, Some(density));
            }
        }
        match best.1 {
            Some(density) => density.gradient(point),
            None => group.blended.iter().map(|d| d.gradient(point)).sum(),
        }
    }

    /// Largest density of any part at a point: the body is the region where it is at least [`THRESHOLD`].
    pub fn strongest(&self, point: Vec3) -> f64 {
        Part::ALL
            .iter()
            .map(|&part| self.density(part, point))
            .fold(0.0, f64::max)
    }

    /// Whether a point lies inside the union of the parts.
    pub fn contains(&self, point: Vec3) -> bool {
        Part::ALL
            .iter()
            .any(|&part| self.density(part, point) >= THRESHOLD)
    }

    /// Distance (m) from `origin` along the unit vector `direction` to the first point where this ray leaves
    /// the union of some parts, to 1e-9 m. `None` if `origin` is outside or the distance is more than 0.6 m.
    pub fn first_exit(&self, parts: &[Part], origin: Vec3, direction: Vec3) -> Option<f64> {
        /// Larger than the thickness of any limb and half of any trunk (m).
        const REACH: f64 = 0.6;
        let along = self.along(parts, [origin, direction]);
        let mut distance = 0.0;
        while along.is_inside(distance) {
            distance += STEP;
            if distance > REACH {
                return None;
            }
        }
        (distance > 0.0).then(|| along.exit([distance - STEP, distance]))
    }

    /// Distance (m) along a ray, given by its origin and unit direction, to the last point where it leaves
    /// one part within `reach` (m), to 1e-9 m: hollows inside are passed over. `None` if the ray does not
    /// meet the part.
    pub fn last_exit(&self, part: Part, ray: [Vec3; 2], reach: f64) -> Option<f64> {
        let along = self.along(&[part], ray);
        let count = (reach / STEP).ceil() as usize;
        let last = (0..count)
            .rev()
            .find(|&k| along.is_inside(k as f64 * STEP))? as f64;
        Some(along.exit([last * STEP, (last + 1.0) * STEP]))
    }

    fn along(&self, parts: &[Part], ray: [Vec3; 2]) -> Along {
        let mut along = Along {
            rows: Vec::with_capacity(24),
            ends: Vec::with_capacity(8),
        };
        for part in parts {
            let group = &self.parts[*part as usize];
            for density in &group.blended {
                along.rows.extend(density.along(ray));
            }
            along.ends.push(along.rows.len());
            for density in &group.plain {
                if let Some(row) = density.along(ray) {
                    along.rows.push(row);
                    along.ends.push(along.rows.len());
                }
            }
        }
        along
    }
}

impl Density {
    /// Coefficients of q (see [`Primitive`]) along a line, as a quadratic in the distance, and the weight;
    /// `None` if the line misses the primitive.
    fn along(&self, [origin, direction]: [Vec3; 2]) -> Option<[f64; 4]> {
        let offset = origin - self.centre;
        let towards = offset.dot(&direction);
        let beside = offset.norm_squared() - towards * towards;
        if beside >= self.reach_squared {
            return None;
        }
        let start = self.unit_from_body * offset;
        let step = self.unit_from_body * direction;
        let row = [
            step.norm_squared(),
            2.0 * start.dot(&step),
            start.norm_squared(),
            self.weight,
        ];
        // Least value of q on the whole line.
        (row[2] - 0.25 * row[1] * row[1] / row[0] < 1.0).then_some(row)
    }
}

/// Densities along a ray: on a straight line the q of each primitive is a quadratic in the distance t, `q = a
/// t^2 + b t + c`.
struct Along {
    /// a, b, c and the weight of each primitive that the line meets, group after group.
    rows: Vec<[f64; 4]>,
    /// Ends of the groups in `rows`: the densities of one group add up.
    ends: Vec<usize>,
}

impl Along {
    /// The largest sum of densities of a group at the distance `t` (1), and its slope along the ray (1/m).
    fn strongest(&self, t: f64) -> [f64; 2] {
        let mut best = [0.0, 0.0];
        let mut from = 0;
        for &end in &self.ends {
            let mut sum = [0.0, 0.0];
            for &[a, b, c, weight] in &self.rows[from..end] {
                let within = (1.0 - ((a * t + b) * t + c)).max(0.0);
                sum[0] += weight * within * within;
                sum[1] -= 2.0 * weight * within * (2.0 * a * t + b);
            }
            if sum[0] > best[0] {
                best = sum;
            }
            from = end;
        }
        best
    }

    fn is_inside(&self, t: f64) -> bool {
        let mut from = 0;
        self.ends.iter().any(|&end| {
            let rows = &self.rows[from..end];
            from = end;
            let mut sum = 0.0;
            for &[a, b, c, weight] in rows {
                let within = (1.0 - ((a * t + b) * t + c)).max(0.0);
                sum += weight * within * within;
            }
            sum >= THRESHOLD
        })
    }

    /// Distance (m) between two given distances at which the ray leaves the inside, to 1e-9 m: Newton's
    /// method kept between these ends, bisection where a step would leave the interval.
    fn exit(&self, [mut low, mut high]: [f64; 2]) -> f64 {
        let mut t = 0.5 * (low + high);
        for _ in 0..60 {
            let [density, slope] = self.strongest(t);
            if density >= THRESHOLD {
                low = t;
            } else {
                high = t;
            }
            let step = (THRESHOLD - density) / slope;
            let next = t + step;
            let better = slope < 0.0 && next > low && next < high;
            let next = if better { next } else { 0.5 * (low + high) };
            let moved = (next - t).abs();
            t = next;
            if moved < 1e-10 || high - low < 1e-9 {
                break;
            }
        }
        t
    }
}

/// Distance between the points of a ray that are tested for lying inside (m): thinner parts and gaps can be
/// missed.
const STEP: f64 = 0.004;
