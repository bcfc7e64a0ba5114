//! The rings of an arm with its hand and of a leg with its foot.

use crate::curve::smooth_step;
use crate::rings::{CROTCH_POINTS, Half, OPEN, SPACING, TRANSITION, at_length, follow};
use crate::{BodyError, Part};
use std::f64::consts::{FRAC_PI_2, PI};
use toile_geometry::Vec3;

/// Angle between the bones from which an arm counts as bent (rad).
pub(crate) const BENT: f64 = 0.02;

/// Choice among the points where a ray leaves a limb.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Exit {
    First,
    /// The last point: hollows are passed over.
    Last,
}

/// The plane of a ring of a limb's skin. The vertices are cast by rays from `centre`; the ray at an angle a
/// has the direction `cos a * first + sin a * second`.
#[derive(Clone, Copy)]
pub(crate) struct Frame {
    pub(crate) centre: Vec3,
    /// First axis: shorter than 1 where the limb is flat, so that points are evenly spaced.
    pub(crate) first: Vec3,
    /// Second axis, a unit vector.
    pub(crate) second: Vec3,
    pub(crate) exit: Exit,
    /// Share by which columns gather at the grooves between the fingers, 0 to 1.
    pub(crate) gathering: f64,
}

impl Frame {
    pub(crate) fn direction(&self, angle: f64) -> Vec3 {
        (self.first * angle.cos() + self.second * angle.sin()).normalize()
    }

    /// Angle of a point about the centre of the ring (rad).
    fn angle(&self, point: Vec3) -> f64 {
        let offset = point - self.centre;
        offset.dot(&self.second).atan2(offset.dot(&self.first))
    }
}

/// One angle for each point of a border, evenly spaced all round, as near as possible to the angles of the
/// points.
fn even_angles(border: &[Vec3], frame: &Frame) -> Vec<f64> {
    let step = 2.0 * PI / border.len() as f64;
    // Mean of the differences to even angles, taken as directions, so that the mean has no jump at a full
    // turn.
    let (sin, cos) = border
        .iter()
        .enumerate()
        .map(|(k, &point)| (frame.angle(point) - step * k as f64).sin_cos())
        .fold((0.0, 0.0), |sum, (sin, cos)| (sum.0 + sin, sum.1 + cos));
    let offset = sin.atan2(cos);
    (0..border.len())
        .map(|k| offset + step * k as f64)
        .collect()
}

/// The input for casting the rings of a limb.
pub(crate) struct Limb<'a> {
    pub(crate) part: Part,
    /// The limb's own part first, then the parts it grows from.
    pub(crate) parts: &'a [Part],
    /// Vertices of the first ring.
    pub(crate) border: &'a [u32],
    /// A point inside the body, behind the border.
    pub(crate) behind: Vec3,
    /// Planes of the limb's rings, from the border to the tip.
    pub(crate) frames: Vec<Frame>,
    /// Direction from the last frame's centre to the tip.
    pub(crate) tip: Vec3,
    /// Ring number of the border: number of rings between the border and the trunk.
    pub(crate) number: f64,
    /// Opening from which another limb grows.
    pub(crate) gap: Option<Gap>,
}

/// The block of a limb's rings that is left open for another limb.
#[derive(Clone, Copy)]
pub(crate) struct Gap {
    /// The first and the last ring plane of the gap.
    pub(crate) frames: [usize; 2],
    /// The first column of the gap.
    pub(crate) column: usize,
    /// Number of columns from the first to the last.
    pub(crate) columns: usize,
}

impl Gap {
    /// Whether a vertex lies strictly inside the gap, in rings of `n` columns.
    fn inside(&self, frame: usize, column: usize, n: usize) -> bool {
        let on = (column + n - self.column) % n;
        frame > self.frames[0] && frame < self.frames[1] && on > 0 && on < self.columns
    }

    /// The vertices round the gap, in the direction of the rings of the limb that grows from it.
    pub(crate) fn border(&self, rings: &[Vec<u32>]) -> Vec<u32> {
        let [low, high] = self.frames;
        let at = |frame: usize, on: usize| {
            let ring = &rings[frame];
            ring[(self.column + on) % ring.len()]
        };
        let mut border: Vec<u32> = (0..=self.columns).map(|on| at(low, on)).collect();
        border.extend((low + 1..=high).map(|frame| at(frame, self.columns)));
        border.extend((0..self.columns).rev().map(|on| at(high, on)));
        border.extend((low + 1..high).rev().map(|frame| at(frame, 0)));
        border
    }
}

impl Half<'_> {
    /// Casts the left arm, from the border of the armhole to the finger tips.
    pub(crate) fn arm(&mut self, border: &[u32]) -> Result<(), BodyError> {
        let j = self.template.joints;
        let scale = self.template.height / 1.7;
        let [shoulder, elbow, wrist] = [j.shoulder, j.elbow, j.wrist].map(Vec3::from);
        let [upper, lower] = [elbow - shoulder, wrist - elbow].map(|bone| bone.normalize());
        let is_bent = upper.dot(&lower) < BENT.cos();
        let along = match is_bent {
            true => upper,
            false => (wrist - shoulder).normalize(),
        };
        let points: Vec<Vec3> = border.iter().map(|&v| self.positions[v as usize]).collect();
        let start = points
            .iter()
            .map(|p| (p - shoulder).dot(&along))
            .fold(f64::NEG_INFINITY, f64::max)
            + 0.03 * scale;
        let hand = self.template.hand;
        let is_fine = self.template.features.is_some() && !is_bent;
        let mut frames = if is_bent {
            let path = [shoulder, elbow, wrist, wrist + lower * hand];
            self.bent_frames(&path, start)
        } else {
            let whole = if is_fine { 0.0 } else { hand };
            let end = (wrist - shoulder).norm() + whole;
            let count = ((end - start) / (SPACING * scale)).round() as usize;
            (0..count)
                .map(|k| Frame {
                    centre: shoulder + along * (start + (end - start) * k as f64 / count as f64),
                    first: Vec3::z().cross(&along),
                    second: Vec3::z(),
                    exit: Exit::Last,
                    gathering: 0.0,
                })
                .collect()
        };
        let behind = points.iter().sum::<Vec3>() / points.len() as f64;
        let before = frames.len();
        if is_fine {
            frames.extend(self.hand_frames([wrist, along]));
        }
        let arm = Limb {
            part: Part::LeftArm,
            parts: &[Part::LeftArm, Part::Trunk],
            border,
            behind,
            frames,
            tip: if is_bent { lower } else { along },
            number: 0.0,
            gap: None,
        };
        match self.template.features {
            Some(features) if is_fine => self.arm_with_thumb(arm, before, features),
            _ => self.limb(&arm).map(|_| ()),
        }
    }

    /// Ring planes of a bent arm from a distance along its bones (m): square to the bones, turning evenly
    /// round the elbow.
    fn bent_frames(&self, path: &[Vec3; 4], start: f64) -> Vec<Frame> {
        /// Half the length over which the planes turn, for a stature of 1.7 m (m).
        const TURN: f64 = 0.045;
        let scale = self.template.height / 1.7;
        let [upper, lower] = [path[1] - path[0], path[3] - path[1]];
        let elbow = upper.norm();
        let end = elbow + (path[2] - path[1]).norm() + (path[3] - path[2]).norm();
        let count = ((end - start) / (SPACING * scale)).round().max(4.0) as usize;
        let (upper, lower) = (upper.normalize(), lower.normalize());
        (0..count)
            .map(|k| {
                let at = start + (end - start) * k as f64 / count as f64;
                let share = smooth_step(0.5 + 0.5 * (at - elbow) / (TURN * scale));
                let along = (upper + (lower - upper) * share).normalize();
                let first = Vec3::z().cross(&along).normalize();
                self.recentred(
                    Part::LeftArm,
                    Frame {
                        centre: at_length(path, at),
                        first,
                        second: along.cross(&first),
                        exit: Exit::Last,
                        gathering: 0.0,
                    },
                )
            })
            .collect()
    }

    /// Casts the left leg, from the lowest ring of the trunk to the toes.
    pub(crate) fn leg(&mut self, bottom: &[u32]) -> Result<(), BodyError> {
        let border = self.crotch_line(bottom)?;
        let j = self.template.joints;
        let scale = self.template.height / 1.7;
        let [hip, knee, ankle] = [j.hip, j.knee, j.ankle].map(Vec3::from);
        let path = [hip, knee, ankle];
        let start_y = self.template.crotch - 0.03 * scale;
        let start = (hip.y - start_y) / (hip.y - knee.y) * (knee - hip).norm();
        let turn = ankle.y + 0.025 * scale;
        let mut frames = Vec::new();
        let length = (knee - hip).norm() + (ankle - knee).norm();
        let count = ((length - start) / (SPACING * scale)).round() as usize;
        for k in 0..=count {
            let point = at_length(&path, start + (length - start) * k as f64 / count as f64);
            if point.y > turn {
                let level = Frame {
                    centre: point,
                    first: -Vec3::z(),
                    second: Vec3::x(),
                    exit: Exit::Last,
                    gathering: 0.0,
                };
                frames.push(self.recentred(Part::LeftLeg, level));
            }
        }
        let last = frames.last().map_or(ankle, |f: &Frame| f.centre);
        frames.extend(self.foot(last));
        let behind = Vec3::new(
            frames[0].centre.x,
            self.template.crotch + 0.015 * scale,
            frames[0].centre.z,
        );
        self.limb(&Limb {
            part: Part::LeftLeg,
            parts: &[Part::LeftLeg, Part::Trunk],
            border: &border,
            behind,
            frames,
            tip: Vec3::z(),
            number: 0.0,
            gap: None,
        })
        .map(|_| ())
    }

    /// Ring planes of the foot: a fan from the level ring at `ankle` to an upright one over the instep, then
    /// upright ones to the toes.
    fn foot(&self, ankle: Vec3) -> Vec<Frame> {
        let scale = self.template.height / 1.7;
        let toe = Vec3::from(self.template.joints.toe);
        let pivot = ankle + Vec3::new(0.0, 0.0, 0.085) * scale;
        let mut frames = Vec::new();
        let fan = 7;
        for k in 1..=fan {
            let turn = FRAC_PI_2 * k as f64 / fan as f64;
            let away = -Vec3::z() * turn.cos() - Vec3::y() * turn.sin();
            let u = k as f64 / fan as f64;
            let distance = 0.085 * scale * (1.0 - u) + (pivot.y - 0.034 * scale) * u;
            frames.push(Frame {
                centre: pivot + away * distance,
                first: away,
                second: Vec3::x(),
                exit: Exit::Last,
                gathering: 0.0,
            });
        }
        let from = pivot - Vec3::y() * (pivot.y - 0.034 * scale);
        let to = Vec3::new(toe.x, 0.02 * scale, toe.z - 0.03 * scale);
        let count = ((to.z - from.z) / (SPACING * scale)).round().max(2.0) as usize;
        for k in 1..=count {
            let u = k as f64 / count as f64;
            frames.push(Frame {
                centre: from + (to - from) * u,
                first: -Vec3::y(),
                second: Vec3::x(),
                exit: Exit::Last,
                gathering: 0.0,
            });
        }
        frames
    }

    /// The frame with its centre moved to the centre of the limb's section.
    pub(crate) fn recentred(&self, part: Part, frame: Frame) -> Frame {
        let mut centre = frame.centre;
        for axis in [frame.second, -frame.first, frame.second] {
            let exit = |d: Vec3| self.field.first_exit(&[part], centre, d);
            if let (Some(ahead), Some(behind)) = (exit(axis), exit(-axis)) {
                centre += axis * (0.5 * (ahead - behind));
            }
        }
        Frame { centre, ..frame }
    }

    /// Closes the lowest half ring of the trunk, given from back to front, by points along the crotch.
    /// Returns the closed ring.
    fn crotch_line(&mut self, bottom: &[u32]) -> Result<Vec<u32>, BodyError> {
        let front = self.positions[bottom[bottom.len() - 1] as usize];
        let back = self.positions[bottom[0] as usize];
        let origin = 0.5 * (front + back);
        let mut ring = bottom.to_vec();
        for k in 1..=CROTCH_POINTS {
            let turn = PI * k as f64 / (CROTCH_POINTS + 1) as f64;
            // Flattened, so that the points are spread along the shallow curve from front to back.
            let direction = Vec3::new(0.0, -0.35 * turn.sin(), turn.cos()).normalize();
            let position = self.hit(&[Part::Trunk], origin, direction)?;
            let vertex = self.add(position, true);
            self.leg[vertex as usize] = follow(0.0);
            ring.push(vertex);
        }
        Ok(ring)
    }

    /// Angle of each column of a limb's rings (rad).
    pub(crate) fn angles(&self, limb: &Limb) -> Vec<f64> {
        let points: Vec<Vec3> = (limb.border.iter())
            .map(|&v| self.positions[v as usize])
            .collect();
        let behind = Frame {
            centre: limb.behind,
            ..limb.frames[0]
        };
        even_angles(&points, &behind)
    }

    /// Casts a limb from its border to its tip, and returns the rings of its planes.
    pub(crate) fn limb(&mut self, limb: &Limb) -> Result<Vec<Vec<u32>>, BodyError> {
        let points: Vec<Vec3> = limb
            .border
            .iter()
            .map(|&v| self.positions[v as usize])
            .collect();
        let first = limb.frames[0];
        let even = self.angles(limb);
        let targets = even
            .iter()
            .map(|&angle| self.outermost(limb.part, &first, angle))
            .collect::<Result<Vec<Vec3>, BodyError>>()?;
        let mut ring = limb.border.to_vec();
        let mut number = limb.number;
        for k in 1..TRANSITION {
            let u = k as f64 / TRANSITION as f64;
            let origin = limb.behind + (first.centre - limb.behind) * u;
            let mut next = Vec::with_capacity(ring.len());
            for (from, to) in points.iter().zip(&targets) {
                let guide = from + (to - from) * u;
                next.push(Some(self.hit(
                    limb.parts,
                    origin,
                    (guide - origin).normalize(),
                )?));
            }
            number += 1.0;
            ring = self.ring(limb.part, &ring, &next, number);
        }
        let mut rings = Vec::with_capacity(limb.frames.len());
        for (t, frame) in limb.frames.iter().enumerate() {
            let mut next = Vec::with_capacity(ring.len());
            let angles = crate::fingers::gathered(&even, frame.gathering);
            for (k, &angle) in angles.iter().enumerate() {
                let is_open = limb.gap.is_some_and(|gap| gap.inside(t, k, even.len()));
                next.push(match is_open {
                    true => None,
                    false => Some(self.outermost(limb.part, frame, angle)?),
                });
            }
            number += 1.0;
            ring = self.ring(limb.part, &ring, &next, number);
            rings.push(ring.clone());
        }
        let last = limb.frames[limb.frames.len() - 1].centre;
        let tip = self.hit(&[limb.part], last, limb.tip)?;
        let pole = self.ring_point(limb.part, tip, number + 1.0);
        for k in 0..ring.len() {
            self.face(limb.part, [ring[k], ring[(k + 1) % ring.len()], pole]);
        }
        rings.push(vec![pole]);
        Ok(rings)
    }

    /// Point where the ray of a ring plane at an angle (rad) leaves the limb.
    fn outermost(&self, part: Part, frame: &Frame, angle: f64) -> Result<Vec3, BodyError> {
        /// Larger than the radius of any arm and any leg, but short of the next limb, for a stature of 1.7 m
        /// (m).
        const REACH: [f64; 2] = [0.11, 0.17];
        let (origin, direction) = (frame.centre, frame.direction(angle));
        // In a field fitted to a mesh, small separate pieces can lie beside the limb: the first exit does not
        // reach them.
        if (self.template.armpit.is_some() || frame.exit == Exit::First)
            && let Some(distance) = self.field.first_exit(&[part], origin, direction)
        {
            return Ok(origin + direction * distance);
        }
        let reach = REACH[usize::from(part == Part::LeftLeg)] * self.template.height / 1.7;
        match self.field.last_exit(part, [origin, direction], reach) {
            Some(distance) => Ok(origin + direction * distance),
            None => self.hit(&[part], origin, direction),
        }
    }

    /// Adds a ring of vertices, joined to the ring before; where a point is `None`, the ring is left open.
    fn ring(&mut self, part: Part, from: &[u32], points: &[Option<Vec3>], number: f64) -> Vec<u32> {
        let to: Vec<u32> = points
            .iter()
            .map(|point| point.map_or(OPEN, |p| self.ring_point(part, p, number)))
            .collect();
        self.band(part, from, &to);
        to
    }

    fn ring_point(&mut self, part: Part, mut position: Vec3, number: f64) -> u32 {
        /// Half the least gap between the legs (m).
        const GAP: f64 = 0.004;
        if part == Part::LeftLeg {
            position.x = position.x.max(GAP);
            position.y = position.y.max(0.0);
        }
        let vertex = self.add(position, false);
        let follows = follow(number);
        if part == Part::LeftLeg {
            self.leg[vertex as usize] = follows;
        } else {
            self.arm[vertex as usize] = follows;
        }
        vertex
    }
}
