//! Where the levels and landmarks of a template lie, found on its skin.

use crate::rings::TemplateSkin;
use crate::tape::{girth, ridge};
use crate::template::Template;
use crate::{BodyError, Part};
use toile_geometry::{TriangleMesh, Vec3, horizontal_section};

/// Levels [m] and shoulder places of a template.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Marks {
    /// Top of the head.
    pub(crate) crown: f64,
    pub(crate) crotch: f64,
    pub(crate) bust: f64,
    /// Where the neck meets the shoulder, left.
    pub(crate) neck_side: Vec3,
    /// Outer end of the shoulder, left.
    pub(crate) tip: Vec3,
    /// Depth of the middle of the trunk [m].
    pub(crate) depth: f64,
}

/// Distance of the end of the shoulder beyond the shoulder joint, over stature.
const TIP: f64 = 0.003;

/// Distance of the underbust below the bust, over stature.
pub(crate) const UNDERBUST: f64 = 0.042;

impl Marks {
    pub(crate) fn of(template: &Template, skin: &TemplateSkin) -> Result<Self, BodyError> {
        let h = template.height;
        let tape = |y: f64| girth(&skin.mesh, &skin.parts, Part::Trunk, y);
        let crotch = crotch(skin);
        let shoulder = template.joints.shoulder;
        let bust = extreme([shoulder[1] - 0.10 * h, shoulder[1] - 0.045 * h], tape);
        let open = BodyError::Open {
            part: "shoulder",
            x: shoulder[0],
            y: shoulder[1],
            z: shoulder[2],
        };
        let window = [bust, template.joints.head[1] - 0.02 * h];
        let tip = ridge(&skin.mesh, shoulder[0] + TIP * h, window).ok_or(open.clone())?;
        let neck_side = neck_side(&skin.mesh, tip, window).ok_or(open)?;
        let middle = |y: f64| {
            let trunk = (0..skin.mesh.triangles.len()).filter(|&t| skin.parts[t] == Part::Trunk);
            middle_depth(&horizontal_section(&skin.mesh, trunk, y))
        };
        let crown = skin.mesh.bounds().map_or(h, |[_, high]| high.y);
        Ok(Self {
            crown,
            crotch,
            bust,
            neck_side,
            tip,
            depth: (0..=4)
                .map(|k| {
                    0.2 * middle(
                        crotch + 0.05 * h + (bust - crotch - 0.05 * h) * 0.25 * f64::from(k),
                    )
                })
                .sum(),
        })
    }
}

/// Height of the lowest point in the middle [m].
fn crotch(skin: &TemplateSkin) -> f64 {
    (0..skin.mesh.positions.len())
        .filter(|&v| skin.mirror[v] as usize == v)
        .map(|v| skin.mesh.positions[v].y)
        .fold(f64::INFINITY, f64::min)
}

/// Middle between the foremost and the hindmost point of a section [m].
pub(crate) fn middle_depth(section: &[toile_geometry::Vec2]) -> f64 {
    let low = section.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
    let high = section
        .iter()
        .map(|p| p.y)
        .fold(f64::NEG_INFINITY, f64::max);
    0.5 * (low + high)
}

/// The level in a range at which a value is largest, to 2 mm.
fn extreme([low, high]: [f64; 2], value: impl Fn(f64) -> f64) -> f64 {
    let count = ((high - low) / 0.002).ceil() as usize;
    let mut best = [f64::NEG_INFINITY, low];
    for k in 0..=count {
        let y = low + (high - low) * k as f64 / count as f64;
        let v = value(y);
        if v > best[0] {
            best = [v, y];
        }
    }
    best[1]
}

/// Where the shoulder becomes the steep side of the neck: walking inward along the ridge from the
/// middle of the shoulder, the first place where it rises by more than 35 degrees over 6 mm.
fn neck_side(mesh: &TriangleMesh, tip: Vec3, window: [f64; 2]) -> Option<Vec3> {
    let step = 0.002;
    let steep = 35f64.to_radians().tan() * 3.0 * step;
    for k in 0.. {
        let x = 0.75 * tip.x - step * f64::from(k);
        if x < 0.03 {
            return None;
        }
        let here = ridge(mesh, x, window)?;
        if ridge(mesh, x - 3.0 * step, window)?.y - here.y > steep {
            return Some(here);
        }
    }
    None
}
