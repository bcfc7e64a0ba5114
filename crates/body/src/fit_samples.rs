//! Samples that the primitives of a part are fitted to: points of a foreign mesh on the surface of the part,
//! and points inside and outside of it.

use crate::curve::smooth_step;
use crate::fit_check::outermost;
use crate::fit_frame::FoundFrame;
use crate::rings::FAN;
use crate::{Part, Scan};
use toile_geometry::{SurfaceTree, TriangleMesh, Vec2, Vec3};

/// Condition on the density at a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum DensityTarget {
    /// Equal to the threshold: the surface of the part passes through the sample.
    Surface {
        /// Outward normal of the surface.
        normal: Vec3,
        /// Original point of the mesh; the sample may have been moved since (m).
        own: Vec3,
    },
    /// Above the threshold by a margin: inside the part.
    Within,
    /// Below the threshold by a margin: outside the part.
    Beyond,
    /// Nearly 0: far outside the surface.
    Far,
    /// At most the threshold: the surface of another part passes through the sample.
    Below,
}

/// A point of the left half, the condition on the density at the point, and the area that it stands for (m2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sample {
    pub(crate) place: Vec3,
    pub(crate) target: DensityTarget,
    pub(crate) weight: f64,
}

/// A point of the mesh, its outward normal and the area that it stands for (m2); points of the right half are
/// mirrored to the left.
struct Spot {
    place: Vec3,
    normal: Vec3,
    area: f64,
    is_arm: bool,
}

/// Parts that are fitted; the parts of the right side are mirror images.
pub(crate) const PARTS: [Part; 4] = [Part::Trunk, Part::Head, Part::LeftArm, Part::LeftLeg];

/// Distances from the surface of the samples inside and outside, as a share of stature.
const DEPTH: [f64; 2] = [0.010, 0.007];

/// The samples of each of [`PARTS`].
pub(crate) fn samples(scan: &Scan, tree: &SurfaceTree, found: &FoundFrame) -> [Vec<Sample>; 4] {
    let spots = {
        let top = TOP * found.frame.height;
        let neck = found.chin;
        let mut all = thinned(spots(tree.mesh(), found), found);
        all.retain(|s| s.is_arm || !(neck..top).contains(&s.place.y));
        all.extend(head_spots(scan, tree, found, [neck, top]));
        all
    };
    let zones = Zones::new(found);
    let height = found.frame.height;
    PARTS.map(|part| {
        let mut all = Vec::new();
        for spot in &spots {
            let [own, other] = zones.shares(part, spot);
            let mut add = |place: Vec3, target: DensityTarget, weight: f64| {
                all.push(Sample {
                    place,
                    target,
                    weight: weight * spot.area,
                });
            };
            if own > 0.0 {
                let surface = DensityTarget::Surface {
                    normal: spot.normal,
                    own: spot.place,
                };
                // The skin is compared in level sections, where a misfit on a slope is larger than along the
                // normal: spots on slopes get more weight.
                let level = spot.normal.x.hypot(spot.normal.z);
                let seen = match part {
                    Part::Trunk => 1.0 / (0.2 + level * level),
                    _ => 1.0,
                };
                add(spot.place, surface, own * seen);
                let [within, beyond] = DEPTH.map(|d| d * height);
                let outer = spot.place + spot.normal * beyond;
                // Samples inside keep trunk and head free of hollows: rays that cast their skin start there.
                let depths: &[f64] = match part {
                    Part::Trunk | Part::Head => &[1.0, 2.5, 4.0],
                    _ => &[1.0],
                };
                for depth in depths {
                    let inner = spot.place - spot.normal * (depth * within);
                    if own > 0.3 && inner.x > 0.0 && tree.contains(inner) {
                        add(inner, DensityTarget::Within, 0.5 * own);
                    }
                }
                let free = |p: Vec3| zones.is_alien(part, spot, p) || !tree.contains(p);
                if free(outer) {
                    add(outer, DensityTarget::Beyond, own);
                }
                for times in [2.5, 5.0, 9.0, 14.0] {
                    let far = spot.place + spot.normal * (times * beyond);
                    if free(far) {
                        let target = if times < 4.0 {
                            DensityTarget::Beyond
                        } else {
                            DensityTarget::Far
                        };
                        add(far, target, 0.4 * own);
                    }
                }
            } else if other > 0.0 {
                add(spot.place, DensityTarget::Below, other);
            }
        }
        all.extend(zones.axis(part));
        all
    })
}

/// Height as a share of stature above which a head has no cavities.
const TOP: f64 = 0.975;

/// The outermost points of a head's level sections on the left: mouth, nose and ears have inner surfaces that
/// our skin does not follow.
fn head_spots(
    scan: &Scan,
    tree: &SurfaceTree,
    found: &FoundFrame,
    [low, high]: [f64; 2],
) -> Vec<Spot> {
    const RAYS: usize = 24;
    let step = 0.006 * found.frame.height;
    let depth = found.frame.joints.head[2];
    let count = ((high - low) / step) as usize;
    let mut all = Vec::new();
    for y in (0..count).map(|k| low + step * (k as f64 + 0.5)) {
        let Some(section) = scan.trunk(y) else {
            continue;
        };
        for k in 0..RAYS {
            let turn = std::f64::consts::PI * (k as f64 + 0.5) / RAYS as f64;
            let ray = Vec2::new(turn.sin(), turn.cos());
            let Some(far) = outermost(&section, Vec2::new(0.0, depth), ray) else {
                continue;
            };
            let place = Vec3::new(ray.x * far, y, depth + ray.y * far);
            if let Some(closest) = tree.closest_point(place, step) {
                let [a, b, c] = tree.mesh().corners(closest.triangle as usize);
                all.push(Spot {
                    place,
                    normal: (b - a).cross(&(c - a)).normalize(),
                    area: step * far * std::f64::consts::PI / RAYS as f64,
                    is_arm: false,
                });
            }
        }
    }
    all
}

/// The centre of every triangle, mirrored to the left half, and whether it belongs to an arm.
fn spots(mesh: &TriangleMesh, found: &FoundFrame) -> Vec<Spot> {
    let is_arm = arms(mesh, found);
    let normals = mesh.face_normals();
    mesh.triangles
        .iter()
        .enumerate()
        .map(|(t, triangle)| {
            let [a, b, c] = mesh.corners(t);
            let fold = if a.x + b.x + c.x < 0.0 { -1.0 } else { 1.0 };
            let fold = |v: Vec3| Vec3::new(fold * v.x, v.y, v.z);
            Spot {
                place: fold((a + b + c) / 3.0),
                normal: fold(normals[t]),
                area: 0.5 * (b - a).cross(&(c - a)).norm(),
                is_arm: triangle.iter().all(|&v| is_arm[v as usize]),
            }
        })
        .collect()
}

/// Whether each vertex belongs to an arm: it is connected with the finger tips and lies beyond the plane
/// across the arm at `arm_begins`.
fn arms(mesh: &TriangleMesh, found: &FoundFrame) -> Vec<bool> {
    let j = &found.frame.joints;
    let shoulder = Vec3::from(j.shoulder);
    let along = (Vec3::from(j.elbow) - shoulder).normalize();
    let folded = |p: Vec3| Vec3::new(p.x.abs(), p.y, p.z);
    let beyond = |p: Vec3| (folded(p) - shoulder).dot(&along) > found.arm_begins;
    let mut is_arm: Vec<bool> = mesh
        .positions
        .iter()
        .map(|p| (folded(*p) - found.finger_tip).norm() < 0.02 * found.frame.height)
        .collect();
    // Spread along triangles until nothing changes: as many rounds as the arm has rings.
    loop {
        let mut changed = false;
        for triangle in &mesh.triangles {
            if triangle.iter().any(|&v| is_arm[v as usize]) {
                for &v in triangle {
                    if !is_arm[v as usize] && beyond(mesh.positions[v as usize]) {
                        is_arm[v as usize] = true;
                        changed = true;
                    }
                }
            }
        }
        if !changed {
            return is_arm;
        }
    }
}

/// One spot for each cell of a grid, with the area of all spots in it, so that dense feet and hands count no
/// more than their area.
fn thinned(spots: Vec<Spot>, found: &FoundFrame) -> Vec<Spot> {
    let height = found.frame.height;
    let cell = 0.006 * height;
    let key = |p: Vec3| [p.x, p.y, p.z].map(|x| (x / cell).floor() as i64);
    let mut cells: std::collections::BTreeMap<([i64; 3], bool, [bool; 3]), Spot> =
        std::collections::BTreeMap::new();
    for spot in spots {
        let side = [spot.normal.x, spot.normal.y, spot.normal.z].map(|x| x > 0.0);
        cells
            .entry((key(spot.place), spot.is_arm, side))
            .and_modify(|known| {
                let whole = known.area + spot.area;
                known.place = (known.place * known.area + spot.place * spot.area) / whole;
                known.normal = (known.normal * known.area + spot.normal * spot.area)
                    .try_normalize(1e-9)
                    .unwrap_or(known.normal);
                known.area = whole;
            })
            .or_insert(spot);
    }
    cells.into_values().collect()
}

/// Decides to which part a point of the mesh belongs.
struct Zones<'a> {
    found: &'a FoundFrame,
    /// Point from which the rays of the trunk's skin over the shoulder are cast (m).
    focus: Vec3,
    /// Angle above the horizontal, seen from `focus`, at which the opening for the arm ends over the shoulder
    /// (rad).
    top: f64,
}

impl<'a> Zones<'a> {
    fn new(found: &'a FoundFrame) -> Self {
        let f = &found.frame;
        let scale = f.height / 1.7;
        let shoulder = Vec3::from(f.joints.shoulder);
        // The same height as the origin of the skin's rays over the shoulder.
        let base = f.armpit - FAN * scale;
        Self {
            found,
            focus: Vec3::new(0.0, base, f.joints.chest[2]),
            top: (shoulder.y + 0.035 * scale - base).atan2(shoulder.x),
        }
    }

    /// Angle by which a point, seen from `focus`, lies inside the opening for the arm in the trunk's skin,
    /// divided by a margin, plus one half: above 1 well inside the opening, below 0 well outside.
    fn opening(&self, p: Vec3) -> f64 {
        let offset = p - self.focus;
        let azimuth = (offset.x.atan2(offset.z) - std::f64::consts::FRAC_PI_2).abs();
        let level = (offset.x * offset.x + offset.z * offset.z).sqrt();
        let elevation = offset.y.atan2(level);
        let margin = 0.12;
        let sides = (0.52 - azimuth) / margin;
        let above = (self.top - elevation) / margin;
        let below = (elevation - 0.05) / margin;
        sides.min(above).min(below) + 0.5
    }

    /// Weight of a spot as a point of the surface of `part`, and weight as a point of the surface of another
    /// part.
    fn shares(&self, part: Part, spot: &Spot) -> [f64; 2] {
        let f = &self.found.frame;
        let (p, h) = (spot.place, f.height);
        let neck = f.joints.neck[1];
        let above_neck = (p.y - neck) / (0.012 * h);
        let below_crotch = (f.crotch - p.y) / (0.012 * h);
        let opening = if spot.is_arm { 2.0 } else { self.opening(p) };
        let own = match part {
            Part::Trunk => {
                let not_arm = smooth_step(1.0 - opening);
                let not_head = smooth_step(1.0 - above_neck);
                let hip = f.joints.hip[0];
                let inner = p.x < hip && spot.normal.x < -0.3;
                let not_leg = match inner && below_crotch > 0.1 {
                    true => 0.0,
                    false => smooth_step(1.6 - below_crotch),
                };
                not_arm * not_head * not_leg
            }
            Part::Head => smooth_step(above_neck + 1.0) * smooth_step(1.0 - opening),
            Part::LeftArm => {
                let wrist = Vec3::from(f.joints.wrist);
                let along = (wrist - Vec3::from(f.joints.elbow)).normalize();
                let hand = ((p - wrist).dot(&along) / h > 0.012) && spot.is_arm;
                let near = (p.y > f.crotch) || spot.is_arm;
                match (hand, near) {
                    (true, _) => 0.15,
                    (_, true) => smooth_step(opening + 0.35),
                    _ => 0.0,
                }
            }
            _ => match spot.is_arm {
                true => 0.0,
                false => {
                    let foot = if p.y < 0.04 * h { 0.4 } else { 1.0 };
                    smooth_step(below_crotch + 1.5) * foot
                }
            },
        };
        [own, if own > 0.0 { 0.0 } else { 1.0 }]
    }

    /// Whether a point near a spot, on its outer side, belongs to another limb or to the trunk, so that the
    /// limb of the spot must not reach there.
    fn is_alien(&self, part: Part, spot: &Spot, place: Vec3) -> bool {
        let f = &self.found.frame;
        match part {
            Part::LeftLeg => place.x < 0.0 && spot.place.y < f.crotch,
            Part::LeftArm => spot.is_arm && spot.place.y < f.armpit - 0.01 * f.height,
            _ => false,
        }
    }

    /// Samples along a part's axis, from which its skin is cast: they must lie inside the part by a margin.
    fn axis(&self, part: Part) -> Vec<Sample> {
        let f = &self.found.frame;
        let j = &f.joints;
        let [shoulder, elbow, wrist] = [j.shoulder, j.elbow, j.wrist].map(Vec3::from);
        let [hip, knee, ankle] = [j.hip, j.knee, j.ankle].map(Vec3::from);
        let end = wrist + (wrist - elbow).normalize() * f.hand;
        let instep = Vec3::new(ankle.x, 0.025 * f.height, ankle.z + 0.05 * f.height);
        let foot = Vec3::from(j.toe) - Vec3::z() * (0.03 * f.height);
        let [pelvis, chest, neck, head] = [j.pelvis, j.chest, j.neck, j.head].map(Vec3::from);
        let low = Vec3::new(0.0, f.crotch + 0.02 * f.height, pelvis.z);
        let top = Vec3::new(0.0, f.height - 0.05 * f.height, head.z);
        let path: Vec<Vec3> = match part {
            Part::Trunk => vec![low, pelvis, chest, neck],
            Part::Head => vec![neck, head, top],
            Part::LeftArm => vec![shoulder, elbow, wrist, end],
            _ => vec![hip, knee, ankle, instep, foot],
        };
        let spacing = 0.01 * f.height;
        // Points inside the trunk behind the arms, from which the first rings of the arms are cast.
        let side = |y: f64| Vec3::new(0.75 * shoulder.x, y, shoulder.z);
        let low = shoulder.y - 0.07 * f.height;
        let inner = match part {
            Part::Trunk => vec![side(low), side(shoulder.y)],
            _ => Vec::new(),
        };
        path.windows(2)
            .chain(inner.windows(2))
            .flat_map(|w| {
                let count = ((w[1] - w[0]).norm() / spacing).ceil() as usize;
                (0..=count).map(move |k| w[0] + (w[1] - w[0]) * (k as f64 / count.max(1) as f64))
            })
            .map(|place| Sample {
                place,
                target: DensityTarget::Within,
                weight: 3e-4 * f.height * f.height,
            })
            .collect()
    }
}
