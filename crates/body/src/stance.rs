//! The stance of a foreign mesh of a person in its file: the axis that is up, the axis it faces along, and
//! its unit, found from two legs, a trunk and a head.

use crate::BodyError;
use std::collections::HashMap;
use std::fmt;
use std::str::FromStr;
use strum::{EnumCount, VariantArray};
use toile_geometry::{TriangleMesh, Vec3};

/// An axis of a mesh's file, in positive or negative direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axis {
    index: usize,
    is_negative: bool,
}

impl Axis {
    const Y: Self = Self::new(1, false);
    const Z: Self = Self::new(2, false);

    const fn new(index: usize, is_negative: bool) -> Self {
        Self { index, is_negative }
    }

    fn all() -> impl Iterator<Item = Self> {
        // The usual ones first: Y, then Z.
        let order = [1, 2, 0].into_iter();
        order.flat_map(|index| [Self::new(index, false), Self::new(index, true)])
    }

    fn direction(self) -> Vec3 {
        Vec3::ith(self.index, if self.is_negative { -1.0 } else { 1.0 })
    }
}

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = if self.is_negative { "-" } else { "" };
        write!(f, "{sign}{}", ["x", "y", "z"][self.index])
    }
}

impl FromStr for Axis {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let found = Self::all().find(|axis| axis.to_string() == text.trim_start_matches('+'));
        found.ok_or_else(|| format!("{text:?} is no axis; write x, y, z, -x, -y or -z"))
    }
}

/// A unit of length of a mesh's file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, EnumCount, VariantArray)]
pub enum MeshUnit {
    /// Metre.
    Metre,
    /// Centimetre.
    Centimetre,
    /// Millimetre.
    Millimetre,
    /// Inch, 25.4 mm.
    Inch,
    /// Foot, 12 inches.
    Foot,
}

impl MeshUnit {
    const ALL: [Self; Self::COUNT] = toile_geometry::all_variants!();

    /// Length of the unit (m).
    pub fn metres(self) -> f64 {
        match self {
            Self::Metre => 1.0,
            Self::Centimetre => 0.01,
            Self::Millimetre => 0.001,
            Self::Inch => 0.0254,
            Self::Foot => 0.3048,
        }
    }

    /// The unit in which a height has the size of a person; metres if these are among several that fit, and
    /// for the size of a doll.
    fn of_height(height: f64) -> Result<Self, BodyError> {
        let fits = |unit: &Self| PERSON.contains(&(height * unit.metres()));
        let fitting: Vec<Self> = Self::ALL.into_iter().filter(fits).collect();
        match fitting[..] {
            // A height that fits only inches can be that of a child in inches or that of a doll in
            // centimetres.
            [unit] if unit != Self::Inch => Ok(unit),
            [Self::Metre, ..] => Ok(Self::Metre),
            [] if DOLL.contains(&height) => Ok(Self::Metre),
            _ => {
                let possible =
                    |unit: &Self| (DOLL.start..*PERSON.end()).contains(&(height * unit.metres()));
                let ways: Vec<String> = Self::ALL
                    .iter()
                    .filter(|unit| possible(unit))
                    .map(|unit| {
                        format!(
                            "{:.0} cm if it is in {unit}",
                            height * unit.metres() * 100.0
                        )
                    })
                    .collect();
                let ways = match ways.is_empty() {
                    true => "no size of a person in any unit".to_owned(),
                    false => ways.join(", "),
                };
                Err(BodyError::Mesh(format!(
                    "is {height:.4} units tall ({ways}): give its unit: m, cm, mm, in or ft"
                )))
            }
        }
    }
}

impl fmt::Display for MeshUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Metre => "m",
            Self::Centimetre => "cm",
            Self::Millimetre => "mm",
            Self::Inch => "in",
            Self::Foot => "ft",
        })
    }
}

impl FromStr for MeshUnit {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|unit| unit.to_string() == text);
        found.ok_or_else(|| format!("{text:?} is no unit of a mesh; write m, cm, mm, in or ft"))
    }
}

/// Statures of persons (m).
const PERSON: std::ops::RangeInclusive<f64> = 0.45..=2.5;
/// Statures of dolls (m), accepted only of a mesh in metres.
const DOLL: std::ops::Range<f64> = 0.12..0.45;

/// Requested values of a mesh's stance; values that are left out are detected.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AskedStance {
    /// The axis that is up.
    pub up: Option<Axis>,
    /// The axis that the person faces along.
    pub forward: Option<Axis>,
    /// The unit of the file.
    pub unit: Option<MeshUnit>,
}

/// The stance of a person's mesh in its file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stance {
    up: Axis,
    forward: Axis,
    unit: MeshUnit,
}

impl Default for Stance {
    fn default() -> Self {
        Self::OURS
    }
}

impl fmt::Display for Stance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} is up, {} is forward, in {}",
            self.up, self.forward, self.unit
        )
    }
}

impl Stance {
    /// Our own stance: metres, Y up, facing +Z.
    const OURS: Self = Self {
        up: Axis::Y,
        forward: Axis::Z,
        unit: MeshUnit::Metre,
    };

    /// The stance of a person's mesh: as requested, else as recognized, else the program's own.
    ///
    /// # Errors
    /// [`BodyError::Mesh`] for a mesh that seems to lie down, whose unit is not clear, or with two axes that
    /// do not go together.
    pub fn of(mesh: &TriangleMesh, asked: &AskedStance) -> Result<Self, BodyError> {
        if let Some(stance) = Self::seen(mesh, asked)? {
            return Ok(stance);
        }
        if asked.up.is_none()
            && let Some(axis) = lies_along(mesh)
        {
            return Err(BodyError::Mesh(format!(
                "seems to lie down, along {axis}: say which of its axes is up"
            )));
        }
        let up = asked.up.unwrap_or(Axis::Y);
        Self {
            up,
            forward: asked.forward.unwrap_or(usual_forward(up)),
            unit: asked.unit.unwrap_or(MeshUnit::Metre),
        }
        .checked()
    }

    /// Whether the stance is the program's own, so that points keep their coordinates.
    pub fn is_ours(&self) -> bool {
        *self == Self::OURS
    }

    /// The stance with the same up axis and unit, and with the usual forward axis: for meshes that are not to
    /// be turned about the vertical.
    #[must_use]
    pub fn facing_anywhere(self) -> Self {
        Self {
            forward: usual_forward(self.up),
            ..self
        }
    }

    /// The stance of a mesh in which a standing person is recognized; requested values replace recognized
    /// ones. `None` if no person is recognized.
    ///
    /// # Errors
    /// [`BodyError::Mesh`] for a person whose height is possible in several units or in none.
    pub fn seen(mesh: &TriangleMesh, asked: &AskedStance) -> Result<Option<Self>, BodyError> {
        let mut axes = Axis::all().filter(|axis| asked.up.is_none_or(|up| up == *axis));
        let Some(found) = axes.find_map(|up| Standing::along(mesh, up)) else {
            return Ok(None);
        };
        let unit = match asked.unit {
            Some(unit) => unit,
            None => MeshUnit::of_height(found.height)?,
        };
        let forward = asked.forward.or(found.forward);
        Self {
            up: found.up,
            forward: forward.unwrap_or(usual_forward(found.up)),
            unit,
        }
        .checked()
        .map(Some)
    }

    fn checked(self) -> Result<Self, BodyError> {
        match self.up.index == self.forward.index {
            true => Err(BodyError::Mesh(format!(
                "cannot have {} up and face {}: name two different axes",
                self.up, self.forward
            ))),
            false => Ok(self),
        }
    }

    /// A point of the file in the program's own stance: metres, Y up, facing +Z.
    pub fn place(&self, point: Vec3) -> Vec3 {
        let (up, forward) = (self.up.direction(), self.forward.direction());
        let left = up.cross(&forward);
        Vec3::new(point.dot(&left), point.dot(&up), point.dot(&forward)) * self.unit.metres()
    }
}

/// The axis that a person usually faces along in programs with this axis up.
fn usual_forward(up: Axis) -> Axis {
    match (up.index, up.is_negative) {
        (2, _) => Axis::new(1, true),
        _ => Axis::Z,
    }
}

/// Least height of a standing mesh over its longest side; a lower one lies down.
const LYING: f64 = 0.45;
/// Least height of a person over its longest side: arms held level reach a little farther.
const STANDING: f64 = 0.85;

fn extent(mesh: &TriangleMesh) -> Vec3 {
    mesh.bounds()
        .map_or(Vec3::zeros(), |[low, high]| high - low)
}

/// The axis along which a mesh is much longer than it is high.
fn lies_along(mesh: &TriangleMesh) -> Option<Axis> {
    let sides = extent(mesh);
    let longest = sides.imax();
    (sides.y < LYING * sides[longest]).then_some(Axis::new(longest, false))
}

/// A person recognized as standing along an axis.
struct Standing {
    up: Axis,
    forward: Option<Axis>,
    /// Height (units of the file).
    height: f64,
}

/// Heights at which two legs are looked for, as shares of stature.
const LEGS: [f64; 3] = [0.14, 0.22, 0.3];
/// Height at which a trunk is looked for, as a share of stature.
const TRUNK: f64 = 0.58;
/// Height at which a head is looked for, as a share of stature.
const HEAD: f64 = 0.94;
/// Height at which the ankles are looked for, as a share of stature.
const ANKLE: f64 = 0.08;
/// Height at which the feet are looked for, as a share of stature.
const FOOT: f64 = 0.02;
/// Smallest length of the outline of a leg, as a share of stature.
const LEG_LEAST: f64 = 0.06;
/// Largest length of the outline of a head, as a share of stature.
const HEAD_MOST: f64 = 0.9;
/// Least length of the outline of the thinner leg over the length of the other leg's outline.
const ALIKE: f64 = 0.6;
/// Smallest distance of the centre of a foot in front of the ankle, as a share of stature.
const FOOT_AHEAD: f64 = 0.01;

impl Standing {
    fn along(mesh: &TriangleMesh, up: Axis) -> Option<Self> {
        let sides = extent(mesh);
        let height = sides[up.index];
        if height <= 0.0 || height < STANDING * sides.max() {
            return None;
        }
        let direction = up.direction();
        let lowest = mesh
            .positions
            .iter()
            .map(|p| p.dot(&direction))
            .fold(f64::INFINITY, f64::min);
        let level = |share: f64| {
            let outlines = outlines(mesh, direction, lowest + share * height);
            outlines
                .into_iter()
                .filter(move |o| o.length > LEG_LEAST * height)
        };
        let pair = |share: f64| pair(level(share).collect());
        let legs: Vec<[Outline; 2]> = LEGS.into_iter().map(pair).collect::<Option<_>>()?;
        let [left, right] = &legs[1];
        let (across, middle) = (
            right.middle() - left.middle(),
            0.5 * (right.middle() + left.middle()),
        );
        let one = |share: f64| level(share).max_by(|a, b| a.length.total_cmp(&b.length));
        let (trunk, head) = (one(TRUNK)?, one(HEAD)?);
        let width = across.norm();
        let is_over = |o: &Outline| ((o.middle() - middle).dot(&across) / width).abs() < width;
        let stands = trunk.length > left.length.max(right.length)
            && trunk.side(across) > 0.5 * width
            && head.length < HEAD_MOST * height
            && head.length < trunk.length
            && is_over(&trunk)
            && is_over(&head);
        // Legs stand side by side along an axis, and the person faces along the third axis.
        let depth = 3 - up.index - across.iamax();
        let ahead = || {
            let foot = level(FOOT).map(|o| o.middle()[depth]);
            let [one, other] = pair(ANKLE)?;
            let ankle = 0.5 * (one.middle() + other.middle())[depth];
            let feet: Vec<f64> = foot.collect();
            let ahead = feet.iter().sum::<f64>() / feet.len() as f64 - ankle;
            (ahead.abs() > FOOT_AHEAD * height).then_some(Axis::new(depth, ahead < 0.0))
        };
        stands.then(|| Self {
            up,
            forward: ahead(),
            height,
        })
    }
}

/// The two longest outlines of a level, if they are about equal and no third is nearly as long.
fn pair(mut outlines: Vec<Outline>) -> Option<[Outline; 2]> {
    outlines.sort_by(|a, b| b.length.total_cmp(&a.length));
    let (two, more) = outlines.split_at_checked(2)?;
    let alike = two[1].length > ALIKE * two[0].length;
    let alone = more.iter().all(|o| o.length < ALIKE * two[1].length);
    (alike && alone).then(|| [two[0].clone(), two[1].clone()])
}

/// An outline of a level section, whole or in part, by its length and the corners of its box.
#[derive(Clone, Debug)]
struct Outline {
    length: f64,
    low: Vec3,
    high: Vec3,
}

impl Outline {
    fn middle(&self) -> Vec3 {
        0.5 * (self.low + self.high)
    }

    /// Extent along the axis that a direction is nearest to.
    fn side(&self, direction: Vec3) -> f64 {
        let axis = direction.iamax();
        self.high[axis] - self.low[axis]
    }
}

/// The outlines of a level section. An outline consists of segments that meet at edges of the mesh; it need
/// not be closed.
fn outlines(mesh: &TriangleMesh, up: Vec3, level: f64) -> Vec<Outline> {
    let above = |v: u32| mesh.positions[v as usize].dot(&up) - level;
    let mut found: Vec<Option<Outline>> = Vec::new();
    // The outline that each cut edge of the mesh belongs to so far.
    let mut on: HashMap<[u32; 2], usize> = HashMap::new();
    let mut joined: Vec<usize> = Vec::new();
    let root = |joined: &[usize], mut k: usize| {
        while joined[k] != k {
            k = joined[k];
        }
        k
    };
    for triangle in &mesh.triangles {
        let edges = [0, 1, 2].map(|k| [triangle[k], triangle[(k + 1) % 3]]);
        let cut = edges.map(|[a, b]| (above(a) >= 0.0) != (above(b) >= 0.0));
        let ends: Vec<[u32; 2]> = edges
            .into_iter()
            .zip(cut)
            .filter(|(_, cut)| *cut)
            .map(|([a, b], _)| [a.min(b), a.max(b)])
            .collect();
        let [first, second] = ends[..] else { continue };
        let places = [first, second].map(|[a, b]| {
            let (u, w) = (above(a), above(b));
            mesh.positions[a as usize].lerp(&mesh.positions[b as usize], u / (u - w))
        });
        let here = found.len();
        found.push(Some(Outline {
            length: (places[1] - places[0]).norm(),
            low: places[0].inf(&places[1]),
            high: places[0].sup(&places[1]),
        }));
        joined.push(here);
        for end in [first, second] {
            let other = root(&joined, *on.entry(end).or_insert(here));
            let own = root(&joined, here);
            if own != other
                && let (Some(a), Some(b)) = (found[own].take(), found[other].take())
            {
                joined[own] = other;
                found[other] = Some(Outline {
                    length: a.length + b.length,
                    low: a.low.inf(&b.low),
                    high: a.high.sup(&b.high),
                });
            }
        }
    }
    found.into_iter().flatten().collect()
}
