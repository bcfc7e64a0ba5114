//! The hand of a figure with thumbs: flat rings from the wrist to the finger tips, with a gap from which
//! the thumb grows as a limb of its own.

use crate::curve::smooth_step;
use crate::fingers::gathered;
use crate::limbs::{Exit, Frame, Gap, Limb};
use crate::rings::Half;
use crate::template::Features;
use crate::{BodyError, Part, THRESHOLD};
use toile_geometry::Vec3;

/// Distance between rings of the hand and of the thumb, for a stature of 1.7 m (m).
const SPACING: [f64; 2] = [0.0075, 0.0055];
/// Length of the first axis of a flat hand's rings, divided by that of the second (1).
const FLAT: f64 = 0.45;
/// Share of the hand's length over which the rings change from round at the wrist to flat (1).
const FLATTENED: f64 = 0.45;
/// Share of the way from the centre of a ring to the thumb's axis (1): the thumb counts as clear if all rays
/// towards it leave the hand within this share.
const CLEAR: f64 = 0.85;
/// Positions of the last ring planes, as shares of the way from the last full ring to the tip.
const TIP: [f64; 2] = [0.45, 0.8];
/// Number of ring planes and of columns of the gap for the thumb.
const GAP: [usize; 2] = [5, 6];

impl Half<'_> {
    /// Ring planes of the hand from the wrist on, each centred in the hand.
    pub(crate) fn hand_frames(&self, [wrist, along]: [Vec3; 2]) -> Vec<Frame> {
        let length = self.template.hand;
        let scale = self.template.height / 1.7;
        let thumb = self.template.features.map(|f| Vec3::from(f.thumb[0]));
        let web = thumb.map_or(0.0, |p| (p - wrist).dot(&along));
        let count = (length / (SPACING[0] * scale)).round().max(1.0) as usize;
        let mut frames = Vec::with_capacity(count + 1);
        let mut offset = Vec3::zeros();
        for k in 0..=count {
            let at = length * k as f64 / count as f64;
            let axes = [Vec3::z().cross(&along), Vec3::z()];
            let mut centre = wrist + along * at + offset;
            // From the wrist to the web the thumb is part of the palm: rings are not centred in breadth
            // there.
            let passes: &[Vec3] = match at > web {
                true => &[axes[1], axes[0], axes[1], axes[0]],
                false => &[axes[0]],
            };
            for &axis in passes {
                centre += axis * self.off_the_middle(centre, axis);
            }
            if self.field.density(Part::LeftArm, centre) < THRESHOLD {
                break;
            }
            offset = centre - wrist - along * at;
            let share = smooth_step(at / (FLATTENED * length));
            frames.push(Frame {
                centre,
                first: axes[0] * (1.0 + (FLAT - 1.0) * share),
                second: axes[1],
                exit: Exit::First,
                gathering: share,
            });
        }
        self.rounded(frames, along)
    }

    /// The ring planes with additional ones towards the tip, so that the tip is round.
    fn rounded(&self, mut frames: Vec<Frame>, along: Vec3) -> Vec<Frame> {
        if let Some(&last) = frames.last()
            && let Some(rest) = (self.field).first_exit(&[Part::LeftArm], last.centre, along)
        {
            frames.extend(TIP.map(|share| Frame {
                centre: last.centre + along * (share * rest),
                ..last
            }));
        }
        frames
    }

    /// Distance of the centre of the arm from a point along an axis (m).
    fn off_the_middle(&self, point: Vec3, axis: Vec3) -> f64 {
        let exit = |d: Vec3| self.field.first_exit(&[Part::LeftArm], point, d);
        match (exit(axis), exit(-axis)) {
            (Some(ahead), Some(behind)) => 0.5 * (ahead - behind),
            _ => 0.0,
        }
    }

    /// Casts an arm whose frames from index `wrist` on are the frames of the hand; without a thumb
    /// if the primitives have no thumb.
    pub(crate) fn arm_with_thumb(
        &mut self,
        mut arm: Limb,
        wrist: usize,
        features: Features,
    ) -> Result<(), BodyError> {
        let thumb = features.thumb.map(Vec3::from);
        arm.gap = self.gap(&arm, wrist, thumb);
        let first = self.positions.len();
        let rings = self.limb(&arm)?;
        let mut web = Vec::new();
        if let Some(gap) = arm.gap {
            web = gap.border(&rings);
            let first = self.positions.len() as u32;
            self.thumb(&web, thumb)?;
            web.extend(first..first + web.len() as u32);
        }
        // Fairing leaves the hand as it is, except where thumb and fingers part. The first two rings at the
        // wrist are a transition and are faired.
        let from = rings.get(wrist + 2).and_then(|ring| ring.iter().min());
        let from = from.map_or(first, |&v| v as usize);
        self.held[from..].fill(true);
        for v in web {
            self.held[v as usize] = false;
        }
        Ok(())
    }

    /// The gap for the thumb in the rings of the hand: it ends at the first ring plane on which the thumb is
    /// clear of the fingers.
    fn gap(&self, arm: &Limb, wrist: usize, [base, tip]: [Vec3; 2]) -> Option<Gap> {
        let is_inside = |share: f64| {
            let at = base + (tip - base) * share;
            self.field.density(Part::LeftArm, at) >= THRESHOLD
        };
        if ![0.0, 0.25, 0.5, 0.75, 1.0].into_iter().all(is_inside) {
            return None;
        }
        let n = arm.border.len();
        let even = self.angles(arm);
        // The first column of the gap, centred on the direction of the thumb, if all columns of the gap are
        // clear.
        let first_column = |frame: &Frame| {
            let way = on_plane([base, tip], frame, arm.tip) - frame.centre;
            let angles = gathered(&even, frame.gathering);
            let off = |k: &usize| (frame.direction(angles[*k]) - way.normalize()).norm();
            let nearest = (0..n).min_by(|a, b| off(a).total_cmp(&off(b)))?;
            let column = (nearest + n - GAP[1] / 2) % n;
            let is_clear = (0..=GAP[1]).all(|on| {
                let direction = frame.direction(angles[(column + on) % n]);
                let exit = (self.field).first_exit(&[Part::LeftArm], frame.centre, direction);
                let reach = |distance: f64| distance * direction.dot(&way) / way.norm_squared();
                exit.is_some_and(|distance| reach(distance) < CLEAR)
            });
            is_clear.then_some(column)
        };
        let (high, column) = (wrist + GAP[0]..arm.frames.len())
            .find_map(|t| Some((t, first_column(&arm.frames[t])?)))?;
        Some(Gap {
            frames: [high - GAP[0], high],
            column,
            columns: GAP[1],
        })
    }

    /// Casts the thumb, from the border of its gap to its tip.
    fn thumb(&mut self, border: &[u32], [base, tip]: [Vec3; 2]) -> Result<(), BodyError> {
        let points = border.iter().map(|&v| self.positions[v as usize]);
        let behind = points.sum::<Vec3>() / border.len() as f64;
        let along = (tip - base).normalize();
        let first = Vec3::z().cross(&along).normalize();
        let scale = self.template.height / 1.7;
        let count = ((tip - base).norm() / (SPACING[1] * scale))
            .round()
            .max(1.0) as usize;
        let frames = (0..=count)
            .map(|k| Frame {
                centre: base + (tip - base) * (k as f64 / count as f64),
                first,
                second: along.cross(&first),
                exit: Exit::First,
                gathering: 0.0,
            })
            .collect();
        self.limb(&Limb {
            part: Part::LeftArm,
            parts: &[Part::LeftArm],
            border,
            behind,
            frames: self.rounded(frames, along),
            tip: along,
            number: HELD,
            gap: None,
        })
        .map(|_| ())
    }
}

/// Ring number of the thumb's border: so high that the rings of the thumb follow only the arm and not the
/// trunk.
const HELD: f64 = 100.0;

/// Intersection of a line with the plane of a ring square to `along`.
fn on_plane([base, tip]: [Vec3; 2], frame: &Frame, along: Vec3) -> Vec3 {
    let way = tip - base;
    base + way * ((frame.centre - base).dot(&along) / way.dot(&along))
}
