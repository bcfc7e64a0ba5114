//! An index of a template's triangles by height, distance along the arm and distance from the median plane,
//! so that a tape tests few of them.

use crate::Part;
use crate::definitions::NECK_TILT;
use toile_geometry::{TriangleMesh, Vec3};

/// The range in which a tape searches for triangles of a template.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Near {
    /// Heights above the floor (m).
    Level([f64; 2]),
    /// Heights along the normal of a tape round the neck, see [`neck_height`] (m).
    Neck([f64; 2]),
    /// Distances from the shoulder joint along the arm (m).
    Arm([f64; 2]),
    /// Distances from the median plane, and heights above the floor (m).
    Side([f64; 2], [f64; 2]),
}

impl Near {
    /// Range on the template for the points of a body between two distances from the median plane (m). The
    /// body is the template scaled sideways by `least` to `most`; `heights` are heights on the template (m).
    pub(crate) fn side(places: [f64; 2], [least, most]: [f64; 2], heights: [f64; 2]) -> Self {
        let [low, high] = [places[0].min(places[1]), places[0].max(places[1])];
        Self::Side([low / most - 0.025, high / least + 0.025], heights)
    }
}

/// The triangles of a template's left half in four lists. Each list is sorted by one coordinate of the
/// triangle's first corner (m): height, height along the normal of a neck tape, distance along the arm, or
/// distance from the median plane.
pub(crate) struct Bands {
    level: Vec<(f64, u32)>,
    neck: Vec<(f64, u32)>,
    arm: Vec<(f64, u32)>,
    side: Vec<(f64, u32)>,
    /// Heights of the first corners of triangles, in the order of `side`.
    side_level: Vec<f64>,
    /// Number of vertices of the left half and the median plane: these come first in the mesh.
    vertices: usize,
}

impl Bands {
    /// Sorts the left half of a template's triangles. Distances along the arm are measured from the point
    /// `shoulder` in the direction `along`.
    pub(crate) fn new(mesh: &TriangleMesh, parts: &[Part], [shoulder, along]: [Vec3; 2]) -> Self {
        let half = mesh.triangles.len() / 2;
        let first = |t: usize| mesh.positions[mesh.triangles[t][0] as usize];
        let sorted = |mut rows: Vec<(f64, u32)>| {
            rows.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            rows
        };
        let level = (0..half).map(|t| (first(t).y, t as u32)).collect();
        let on_neck = |t: &usize| matches!(parts[*t], Part::Head | Part::Trunk);
        let tilted = |t: usize| (neck_height(first(t)), t as u32);
        let on_arm = |t: &usize| matches!(parts[*t], Part::LeftArm | Part::Trunk);
        let place = |t: usize| ((first(t) - shoulder).dot(&along), t as u32);
        let side = sorted((0..half).map(|t| (first(t).x, t as u32)).collect());
        Self {
            side_level: side.iter().map(|row| first(row.1 as usize).y).collect(),
            side,
            vertices: (mesh.triangles[..half].iter().flatten().max())
                .map_or(0, |&v| v as usize + 1),
            level: sorted(level),
            neck: sorted((0..half).filter(on_neck).map(tilted).collect()),
            arm: sorted((0..half).filter(on_arm).map(place).collect()),
        }
    }

    /// Number of vertices of the left half and the median plane.
    pub(crate) fn vertices(&self) -> usize {
        self.vertices
    }

    /// The triangles whose first corner lies in a range.
    pub(crate) fn of(&self, near: Near) -> impl Iterator<Item = usize> + '_ {
        let (rows, [from, to], heights) = match near {
            Near::Level(range) => (&self.level, range, None),
            Near::Neck(range) => (&self.neck, range, None),
            Near::Arm(range) => (&self.arm, range, None),
            Near::Side(range, heights) => (&self.side, range, Some(heights)),
        };
        let low = rows.partition_point(|row| row.0 < from);
        let high = rows.partition_point(|row| row.0 <= to).max(low);
        let within = move |k: &usize| {
            heights.is_none_or(|[least, most]| (least..=most).contains(&self.side_level[*k]))
        };
        (low..high).filter(within).map(|k| rows[k].1 as usize)
    }
}

/// Coordinate of a point along the normal of a tape round the neck (m). The tape is lower in front by
/// [`NECK_TILT`].
pub(crate) fn neck_height(p: Vec3) -> f64 {
    let (sin, cos) = NECK_TILT.sin_cos();
    p.y * cos + p.z * sin
}
