//! The body's ellipsoids as a hierarchy for collision (Rudomin, Perez, Hernandez and Diaz 2002):
//! groups by part with an adjacency between them, matrices that follow the joints, and a parent
//! ellipsoid for every particle of a garment.

use crate::{AttachedPrimitive, Joint, Mannequin, Part, Pose, Skeleton, VISIBLE_RATIO};
use nalgebra::Matrix3;
use toile_geometry::Vec3;

/// Which parts touch which, each itself too: the trunk all others, and nothing else.
pub fn adjacent(part: Part) -> &'static [Part] {
    match part {
        Part::Trunk => &Part::ALL,
        Part::Head => &[Part::Head, Part::Trunk],
        Part::LeftArm => &[Part::LeftArm, Part::Trunk],
        Part::RightArm => &[Part::RightArm, Part::Trunk],
        Part::LeftLeg => &[Part::LeftLeg, Part::Trunk],
        Part::RightLeg => &[Part::RightLeg, Part::Trunk],
    }
}

/// A place against one ellipsoid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipsoidContact {
    /// Which ellipsoid, in the order of [`Mannequin::primitives`].
    pub ellipsoid: usize,
    /// `|q|` for `q = S^-1 R^T (p - c)`: below one inside [1].
    pub ratio: f64,
    /// Where the ray from the ellipsoid's centre through the place leaves it, `R S q/|q| + c`: not
    /// the closest point, the more so the longer the ellipsoid [m].
    pub point: Vec3,
}

/// A matrix row by row and the centre, for a run of ellipsoids side by side.
#[derive(Clone, Debug, Default)]
struct Rows {
    /// `S^-1 R^T` by its nine entries [1/m].
    unit: [Vec<f64>; 9],
    /// `S^-1 R^T c` [1].
    shift: [Vec<f64>; 3],
}

/// Ellipsoids tested beside one another.
const RUN: usize = 32;

/// Ellipsoids of a body in a pose. Inside tests are exact; the matrices are made anew only for
/// joints that moved, themselves or by one they hang on.
#[derive(Clone, Debug)]
pub struct EllipsoidTree {
    skeleton: Skeleton,
    primitives: Vec<AttachedPrimitive>,
    /// The ellipsoids' size over the visible one of their primitives [1].
    scale: f64,
    /// Ellipsoids of each part in the rows' order, and where each part's rows begin and end.
    order: Vec<usize>,
    ranges: [[usize; 2]; 6],
    rows: Rows,
    pose: Pose,
    /// From body to the unit sphere back: `R S` and c of each row.
    body_from_unit: Vec<(Matrix3<f64>, Vec3)>,
}

impl EllipsoidTree {
    /// The ellipsoids of a body at rest, `scale` times as large as each lone primitive is visible:
    /// 1 lies within the skin, where primitives blend; a garment over another takes more [1].
    pub fn new(body: &Mannequin, scale: f64) -> Self {
        let primitives = body.primitives().to_vec();
        let mut order = Vec::new();
        let ranges = Part::ALL.map(|part| {
            let from = order.len();
            order.extend((0..primitives.len()).filter(|&k| primitives[k].local.part == part));
            [from, order.len()]
        });
        let count = order.len();
        let column = || vec![0.0; count];
        let mut tree = Self {
            skeleton: body.skeleton().clone(),
            scale: if scale.is_finite() {
                scale.clamp(0.1, 10.0)
            } else {
                1.0
            },
            order,
            ranges,
            rows: Rows {
                unit: std::array::from_fn(|_| column()),
                shift: std::array::from_fn(|_| column()),
            },
            pose: Pose::rest(),
            body_from_unit: vec![(Matrix3::identity(), Vec3::zeros()); count],
            primitives,
        };
        tree.place(|_| true);
        tree
    }

    /// Number of ellipsoids.
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// Takes another pose. Returns how many matrices were made anew: those of ellipsoids whose
    /// joint, or one it hangs on, or whose reference joint is turned otherwise.
    pub fn pose(&mut self, pose: &Pose) -> usize {
        let all = self.pose.shift != pose.shift;
        let turned = Joint::ALL.map(|joint| self.pose.rotation(joint) != pose.rotation(joint));
        let moved = Joint::ALL.map(|joint| {
            all || Joint::ALL
                .into_iter()
                .any(|above| turned[above as usize] && joint.follows(above))
        });
        self.pose = pose.clone();
        self.place(|attached| {
            let reference = attached.deformation.as_ref().map(|d| d.joint);
            moved[attached.joint as usize] || reference.is_some_and(|joint| turned[joint as usize])
        })
    }

    fn place(&mut self, moved: impl Fn(&AttachedPrimitive) -> bool) -> usize {
        let frames = self.skeleton.frames(&self.pose);
        let mut count = 0;
        for (row, &k) in self.order.iter().enumerate() {
            let attached = &self.primitives[k];
            if !moved(attached) {
                continue;
            }
            count += 1;
            let placed = attached.placed(&frames, &self.pose);
            let radii = Vec3::from(placed.radii) * (VISIBLE_RATIO * self.scale);
            let turn = *placed.rotation().matrix();
            let centre = Vec3::from(placed.centre);
            let unit = Matrix3::from_diagonal(&radii.map(|r| 1.0 / r)) * turn.transpose();
            let shift = unit * centre;
            for i in 0..3 {
                self.rows.shift[i][row] = shift[i];
                for j in 0..3 {
                    self.rows.unit[3 * i + j][row] = unit[(i, j)];
                }
            }
            self.body_from_unit[row] = (turn * Matrix3::from_diagonal(&radii), centre);
        }
        count
    }

    /// `|q|^2` of a place for a run of rows, written beside one another. One test each.
    fn ratios(&self, [from, to]: [usize; 2], p: Vec3, into: &mut [f64; RUN]) {
        let [a, b, c, d, e, f, g, h, i] = &self.rows.unit;
        let [s, t, u] = &self.rows.shift;
        for (k, ratio) in (from..to).zip(into) {
            let x = a[k] * p.x + b[k] * p.y + c[k] * p.z - s[k];
            let y = d[k] * p.x + e[k] * p.y + f[k] * p.z - t[k];
            let z = g[k] * p.x + h[k] * p.y + i[k] * p.z - u[k];
            *ratio = x * x + y * y + z * z;
        }
    }

    /// The row nearest to a place in the measure of the unit spheres, among some parts.
    fn nearest_of(&self, parts: &[Part], p: Vec3) -> Option<(usize, f64)> {
        let mut best: Option<(usize, f64)> = None;
        let mut run = [0.0; RUN];
        for &part in parts {
            let [first, last] = self.ranges[part as usize];
            for from in (first..last).step_by(RUN) {
                let to = (from + RUN).min(last);
                self.ratios([from, to], p, &mut run);
                for (k, &q) in run[..to - from].iter().enumerate() {
                    if best.is_none_or(|known| q < known.1) {
                        best = Some((from + k, q));
                    }
                }
            }
        }
        best
    }

    fn contact(&self, (row, squared): (usize, f64), p: Vec3) -> EllipsoidContact {
        let (matrix, centre) = &self.body_from_unit[row];
        let ratio = squared.sqrt();
        let row_of = |i: usize| {
            let [x, y, z] = [0, 1, 2].map(|j| self.rows.unit[3 * i + j][row]);
            x * p.x + y * p.y + z * p.z - self.rows.shift[i][row]
        };
        let unit = Vec3::new(row_of(0), row_of(1), row_of(2));
        let direction = unit.try_normalize(1e-12).unwrap_or(Vec3::y());
        EllipsoidContact {
            ellipsoid: self.order[row],
            ratio,
            point: matrix * direction + centre,
        }
    }

    /// The ellipsoid nearest to a place among all: a particle's first parent. None for a place
    /// that is not finite.
    pub fn nearest(&self, p: Vec3) -> Option<EllipsoidContact> {
        self.searched(&Part::ALL, p)
    }

    /// The nearest ellipsoid among the parent's part and those it touches: a particle's next
    /// parent.
    pub fn reparented(&self, parent: usize, p: Vec3) -> Option<EllipsoidContact> {
        let part = self.primitives.get(parent)?.local.part;
        self.searched(adjacent(part), p)
    }

    fn searched(&self, parts: &[Part], p: Vec3) -> Option<EllipsoidContact> {
        if !p.iter().all(|x| x.is_finite()) {
            return None;
        }
        let best = self.nearest_of(parts, p)?;
        Some(self.contact(best, p))
    }

    /// For each of some places whether it lies inside any ellipsoid. Exact up to rounding.
    pub fn inside(&self, places: &[Vec3]) -> Vec<bool> {
        let mut run = [0.0; RUN];
        let mut is_inside = |p: Vec3| {
            (0..self.len()).step_by(RUN).any(|from| {
                let to = (from + RUN).min(self.len());
                self.ratios([from, to], p, &mut run);
                run[..to - from]
                    .iter()
                    .fold(f64::INFINITY, |a, &b| a.min(b))
                    < 1.0
            })
        };
        places.iter().map(|&p| is_inside(p)).collect()
    }
}
