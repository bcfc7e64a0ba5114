//! Levels and landmarks of a template, found on its skin.

use crate::definitions::{BodyMarks, Taping};
use crate::girths::Girth;
use crate::rings::TemplateSkin;
use crate::tape::{OnEdge, Skinned, extent, girth, ridge};
use crate::template::Template;
use crate::{BodyError, Part};
use toile_geometry::{TriangleMesh, Vec2, Vec3, horizontal_section};

/// Three points of a plane of a template (m).
pub(crate) type Plane = [Vec3; 3];

/// Landmarks of a template by part of the body (m); of landmarks in pairs, the left one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TemplateMarks {
    /// Height of the top of the head.
    pub(crate) crown: f64,
    pub(crate) neck: NeckMarks,
    pub(crate) shoulder: ShoulderMarks,
    pub(crate) armpit: ArmpitMarks,
    pub(crate) bust: BustMarks,
    pub(crate) trunk: TrunkMarks,
    pub(crate) crotch: CrotchMarks,
    pub(crate) arm: ArmMarks,
    pub(crate) leg: LegMarks,
}

/// Landmarks of the neck.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NeckMarks {
    /// Middle of the neck (m).
    pub(crate) middle: Vec3,
    /// Point where the neck meets the shoulder (m).
    pub(crate) side: Vec3,
    /// The same point as a point of the skin.
    pub(crate) side_on: OnEdge,
}

/// Landmarks of the shoulder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ShoulderMarks {
    /// Outer end of the shoulder (m).
    pub(crate) tip: Vec3,
    /// The same point as a point of the skin.
    pub(crate) tip_on: OnEdge,
}

/// Landmarks of the armpit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ArmpitMarks {
    /// Height of the armpit (m).
    pub(crate) height: f64,
    /// Vertex of the skin at the front fold of the armpit.
    pub(crate) front_fold: u32,
}

/// Landmarks of the bust.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BustMarks {
    /// Height of the bust (m).
    pub(crate) height: f64,
    /// The bust point (m).
    pub(crate) point: Vec3,
}

/// Measures of the trunk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TrunkMarks {
    /// Depth of the centre of the trunk (m).
    pub(crate) middle_depth: f64,
    /// Sections from crotch to bust: height, half the breadth, depths in front of and behind the centre (m).
    pub(crate) sections: [[f64; 4]; SECTIONS],
}

/// Landmarks of the crotch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CrotchMarks {
    /// Height of the crotch (m).
    pub(crate) height: f64,
    /// Rise of the body's midline above this height, at [`CROTCH_PLACES`] even depths from back to front (m).
    pub(crate) rise: [f64; CROTCH_PLACES],
    /// Depth of the rearmost of these points (m).
    pub(crate) hindmost: f64,
}

/// Landmarks of the arm: distances from the shoulder joint along the arm (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ArmMarks {
    /// Centres of the arm's sections at even distances from the shoulder joint, the first at [`ARM_BEGINS`]
    /// times the wrist's distance (m).
    pub(crate) middles: [Vec3; ARM_MIDDLES],
    pub(crate) upper_arm: f64,
    pub(crate) elbow: f64,
    pub(crate) forearm: f64,
    pub(crate) wrist: f64,
    /// Vertex of the skin at the tip of the hand.
    pub(crate) finger_tip: u32,
}

/// Landmarks of the leg: heights (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LegMarks {
    pub(crate) lower_thigh: f64,
    pub(crate) knee: f64,
    pub(crate) calf: f64,
    pub(crate) ankle: f64,
    /// Plane of the girth over heel and instep.
    pub(crate) heel: Plane,
}

/// Number of stored centres of the arm.
pub(crate) const ARM_MIDDLES: usize = 24;
/// Distance of the first centre from the shoulder joint, divided by that of the wrist (1).
pub(crate) const ARM_BEGINS: f64 = 0.2;
/// Distance between two centres, divided by the distance of the wrist from the shoulder joint (1).
pub(crate) const ARM_STEP: f64 = 0.05;

/// Number of stored points of the crotch's line.
pub(crate) const CROTCH_PLACES: usize = 21;

/// Distance between two of the [`CROTCH_PLACES`] points, as a share of stature.
const CROTCH_STEP: f64 = 0.01;
/// Largest stored rise of the midline above the crotch, as a share of stature.
const CROTCH_RISE: f64 = 0.045;

/// Number of stored sections of the trunk.
pub(crate) const SECTIONS: usize = 9;

/// Distance of the end of the shoulder beyond the shoulder joint, as a share of stature.
const TIP: f64 = 0.003;

/// Share of the way from the neck's base to the base of the skull that lies below any chin.
const BELOW_CHIN: f64 = 0.4;

/// Share of the way from the neck's base to the base of the skull at which the centre of the neck lies.
const NECK: f64 = 0.42;

/// Distance of the underbust below the bust, as a share of stature.
pub(crate) const UNDERBUST: f64 = 0.042;
/// Range of the height of the calf, as shares of the height of the knee.
const CALF: [f64; 2] = [0.55, 0.9];

impl TemplateMarks {
    pub(crate) fn of(template: &Template, skin: &TemplateSkin) -> Result<Self, BodyError> {
        let h = template.height;
        let skinned = Skinned::finished(&skin.mesh, &skin.parts);
        let level = |part: Part, y: f64| girth(&skinned, part, [Vec3::y() * y, Vec3::y()], None);
        let crotch = crotch(skin);
        let j = template.joints;
        let bust = extreme([j.shoulder[1] - 0.10 * h, j.shoulder[1] - 0.045 * h], |y| {
            level(Part::Trunk, y)
        });
        let [x, y, z] = j.shoulder;
        let part = "shoulder";
        let open = BodyError::Open { part, x, y, z };
        // A head may be large relative to the shoulders: with a frame of its own the search ends lower.
        let top = match template.armpit {
            Some(_) => j.neck[1] + BELOW_CHIN * (j.head[1] - j.neck[1]),
            None => j.head[1] - 0.02 * h,
        };
        let window = [bust, top];
        let tip_on = ridge(&skin.mesh, x + TIP * h, window).ok_or(open.clone())?;
        let tip = tip_on.at(&skin.mesh.positions);
        let neck_side_on = neck_side(&skin.mesh, tip, window).ok_or(open)?;
        let [shoulder, elbow, wrist] = [j.shoulder, j.elbow, j.wrist].map(Vec3::from);
        let along = (wrist - shoulder).normalize();
        let [elbow, wrist] = [elbow, wrist].map(|p| (p - shoulder).dot(&along));
        let arm = |d: f64| girth(&skinned, Part::LeftArm, [shoulder + along * d, along], None);
        let (knee, leg) = (j.knee[1], |y: f64| level(Part::LeftLeg, y));
        let calf = extreme(CALF.map(|share| share * knee), leg);
        let [neck, head] = [j.neck, j.head].map(Vec3::from);
        let neck = neck + (head - neck) * NECK;
        let depth = depth(skin, [crotch + 0.05 * h, bust]);
        let crown = skin.mesh.bounds().map_or(h, |[_, high]| high.y);
        let finger_tip = finger_tip(skin, [shoulder, along]);
        let armpit = lowest(&skin.mesh, &skin.armpit);
        // The scale of the forearm is set where the forearm is taped, away from the elbow.
        let ends = [skin.armpit[skin.armpit.len() / 2], finger_tip];
        let body = BodyMarks {
            stature: h,
            crotch,
            armpit,
            knee,
            arm: ends.map(|v| (skin.mesh.positions[v as usize] - shoulder).dot(&along)),
        };
        let forearm = Taping::of(Girth::Forearm, &body).map(|taping| taping.range);
        Ok(Self {
            crown,
            neck: NeckMarks {
                middle: neck,
                side: neck_side_on.at(&skin.mesh.positions),
                side_on: neck_side_on,
            },
            shoulder: ShoulderMarks { tip, tip_on },
            armpit: ArmpitMarks {
                height: armpit,
                front_fold: skin.fold,
            },
            bust: BustMarks {
                height: bust,
                point: bust_point(skin, bust, tip.x),
            },
            trunk: TrunkMarks {
                middle_depth: depth,
                sections: sections(skin, [crotch + 0.03 * h, bust], depth),
            },
            crotch: crotch_marks(skin, crotch, h),
            arm: ArmMarks {
                middles: arm_middles(&skinned, [shoulder, along], wrist),
                upper_arm: extreme([0.45 * elbow, 0.75 * elbow], arm),
                elbow,
                forearm: extreme(forearm.unwrap_or([elbow, wrist]), arm),
                wrist,
                finger_tip,
            },
            leg: LegMarks {
                lower_thigh: knee + 0.15 * (crotch - knee),
                knee,
                calf,
                ankle: extreme([j.ankle[1] + 0.005 * h, 0.6 * calf], |y| -leg(y)),
                heel: heel_plane(template, &skinned),
            },
        })
    }

    /// Depth of one of the [`CROTCH_PLACES`] points (m).
    pub(crate) fn crotch_depth(&self, k: usize) -> f64 {
        self.crotch.hindmost + k as f64 * CROTCH_STEP * self.crown
    }
}

/// Mean depth of the centre of the trunk between two heights (m).
fn depth(skin: &TemplateSkin, [low, high]: [f64; 2]) -> f64 {
    let middle = |y: f64| {
        let trunk = (0..skin.mesh.triangles.len()).filter(|&t| skin.parts[t] == Part::Trunk);
        middle_depth(&horizontal_section(&skin.mesh, trunk, y))
    };
    (0..=4)
        .map(|k| 0.2 * middle(low + (high - low) * 0.25 * f64::from(k)))
        .sum()
}

/// Range of the distance of a bust point from the median plane, as shares of that of the end of the shoulder.
const BUST_POINT: [f64; 2] = [0.45, 0.6];

/// The left bust point at a height (m): the foremost point, but on a flat chest no nearer to the median plane
/// than usual.
fn bust_point(skin: &TemplateSkin, y: f64, shoulder: f64) -> Vec3 {
    let trunk = (0..skin.mesh.triangles.len()).filter(|&t| skin.parts[t] == Part::Trunk);
    let section = horizontal_section(&skin.mesh, trunk, y);
    let foremost = section.iter().max_by(|a, b| a.y.total_cmp(&b.y));
    let [least, most] = BUST_POINT.map(|share| share * shoulder);
    let x = foremost.map_or(least, |p| p.x.abs()).clamp(least, most);
    let near = section
        .iter()
        .filter(|p| p.y > 0.0)
        .min_by(|a, b| (a.x - x).abs().total_cmp(&(b.x - x).abs()));
    Vec3::new(x, y, near.map_or(0.0, |p| p.y))
}

/// Rise of the body's midline behind and in front of a crotch at a height, on a body of a stature (m).
fn crotch_marks(skin: &TemplateSkin, crotch: f64, stature: f64) -> CrotchMarks {
    let most = CROTCH_RISE * stature;
    let is_middle = |v: u32| skin.mirror[v as usize] == v;
    let mut line: Vec<[Vec3; 2]> = Vec::new();
    for t in &skin.mesh.triangles {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            if is_middle(a) && is_middle(b) && a < b {
                line.push([a, b].map(|v| skin.mesh.positions[v as usize]));
            }
        }
    }
    let lowest = line.iter().flatten().min_by(|a, b| a.y.total_cmp(&b.y));
    let step = CROTCH_STEP * stature;
    let hindmost = lowest.map_or(0.0, |p| p.z) - 0.5 * (CROTCH_PLACES - 1) as f64 * step;
    let rise = |z: f64| {
        line.iter()
            .filter(|[a, b]| (a.z - z) * (b.z - z) <= 0.0 && a.z != b.z)
            .map(|[a, b]| a.y + (b.y - a.y) * (z - a.z) / (b.z - a.z) - crotch)
            .fold(most, f64::min)
            .max(0.0)
    };
    CrotchMarks {
        height: crotch,
        rise: std::array::from_fn(|k| rise(hindmost + k as f64 * step)),
        hindmost,
    }
}

/// Sections of the trunk at even heights: height, half the breadth, and extents in front of and behind a
/// depth (m).
fn sections(skin: &TemplateSkin, [low, high]: [f64; 2], depth: f64) -> [[f64; 4]; SECTIONS] {
    std::array::from_fn(|k| {
        let y = low + (high - low) * k as f64 / (SECTIONS - 1) as f64;
        let trunk = (0..skin.mesh.triangles.len()).filter(|&t| skin.parts[t] == Part::Trunk);
        let points = horizontal_section(&skin.mesh, trunk, y);
        let largest = |value: &dyn Fn(&Vec2) -> f64| points.iter().map(value).fold(0.02, f64::max);
        let half = largest(&|p| p.x.abs());
        let [front, back] = [largest(&|p| p.y - depth), largest(&|p| depth - p.y)];
        [y, half, front, back]
    })
}

/// Plane through the lower end of the heel and over the instep.
fn heel_plane(template: &Template, skinned: &Skinned) -> Plane {
    let ankle = Vec3::from(template.joints.ankle);
    let low = Vec3::new(ankle.x, 0.012, ankle.z);
    // The heel's rearmost point at a finger's breadth above the floor.
    let hull = skinned.hull(Part::LeftLeg, [Vec3::y() * low.y, Vec3::y()], None);
    let [_, length] = extent(&hull);
    let back = hull.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
    let heel = Vec3::new(ankle.x, low.y, back + 0.06 * length);
    let instep = Vec3::new(ankle.x, ankle.y + 0.01, ankle.z + 0.30 * length);
    [heel, instep, heel + Vec3::x()]
}

/// Centres of the left arm's sections along its axis from the shoulder; where the arm has no section, the
/// point of the axis.
fn arm_middles(skinned: &Skinned, [shoulder, along]: [Vec3; 2], wrist: f64) -> [Vec3; ARM_MIDDLES] {
    std::array::from_fn(|k| {
        let on_axis = shoulder + along * ((ARM_BEGINS + ARM_STEP * k as f64) * wrist);
        let points = skinned.section(&[Part::LeftArm], [on_axis, along], None);
        let first = Vec3::z().cross(&along).normalize();
        let middle = |axis: Vec3| {
            let ends = points.iter().flatten().map(|p| (p - on_axis).dot(&axis));
            let [low, high] = [f64::min, f64::max].map(|pick| ends.clone().reduce(pick));
            0.5 * (low.unwrap_or_default() + high.unwrap_or_default())
        };
        let second = along.cross(&first);
        on_axis + first * middle(first) + second * middle(second)
    })
}

/// The vertex of the left arm that is farthest along it from the shoulder.
fn finger_tip(skin: &TemplateSkin, [shoulder, along]: [Vec3; 2]) -> u32 {
    let far = |v: u32| (skin.mesh.positions[v as usize] - shoulder).dot(&along);
    let of_arm = (0..skin.mesh.triangles.len()).filter(|&t| skin.parts[t] == Part::LeftArm);
    of_arm
        .flat_map(|t| skin.mesh.triangles[t])
        .max_by(|&a, &b| far(a).total_cmp(&far(b)))
        .unwrap_or_default()
}

/// Height of the lowest of some vertices (m).
fn lowest(mesh: &TriangleMesh, vertices: &[u32]) -> f64 {
    let heights = vertices.iter().map(|&v| mesh.positions[v as usize].y);
    heights.fold(f64::INFINITY, f64::min)
}

/// Height of the lowest point in the median plane (m).
fn crotch(skin: &TemplateSkin) -> f64 {
    (0..skin.mesh.positions.len())
        .filter(|&v| skin.mirror[v] as usize == v)
        .map(|v| skin.mesh.positions[v].y)
        .fold(f64::INFINITY, f64::min)
}

/// Depth half-way between the foremost and the rearmost point of a section (m).
pub(crate) fn middle_depth(section: &[Vec2]) -> f64 {
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

/// The point where the shoulder becomes the steep side of the neck: inward along the ridge from the middle of
/// the shoulder, the first point from which it rises by more than 35 degrees over 6 mm.
fn neck_side(mesh: &TriangleMesh, tip: Vec3, window: [f64; 2]) -> Option<OnEdge> {
    let height = |x: f64| Some(ridge(mesh, x, window)?.at(&mesh.positions).y);
    let step = 0.002;
    let steep = 35f64.to_radians().tan() * 3.0 * step;
    for k in 0.. {
        let x = 0.75 * tip.x - step * f64::from(k);
        if x < 0.03 {
            return None;
        }
        let here = ridge(mesh, x, window)?;
        if height(x - 3.0 * step)? - here.at(&mesh.positions).y > steep {
            return Some(here);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use crate::{Figure, Mannequin};

    #[test]
    fn scales_of_an_arm_are_set_apart_from_the_elbow() {
        for figure in [Figure::Woman, Figure::Man, Figure::Mean] {
            let body = Mannequin::framed(figure).unwrap();
            let body = Mannequin::from_description(&body).unwrap();
            let m = &body.template_body.marks.arm;
            let rows = [m.upper_arm, m.elbow, m.forearm, m.wrist];
            let apart = rows.windows(2).all(|w| w[1] - w[0] > 0.07 * m.wrist);
            assert!(apart, "{figure:?}: {rows:?}");
        }
    }
}
