//! Solves for the shape whose skin has the measurements asked for.
//!
//! # Decided with
//! - [`crate::levels`], [`crate::landmark_level`]: heights and ways over the body;
//! - [`crate::girths`], [`crate::scales`], [`crate::shape_from_scales`]: girths, and the form by scales;
//! - [`crate::warp`], [`crate::warp_trunk`], [`crate::warp_limbs`]: the template put to the form;
//! - [`crate::fair`], [`crate::refit`]: small bumps taken away; primitives fitted anew;
//! - [`crate::measured`], [`crate::template_marks`]: measurements taken from the skin for comparison;
//! - [`crate::deviation::Deviation`]: what was not reached.
//!
//! A new height stands in `levels` (`UPRIGHT`, `OVER`), a new girth in `girths`, `scales`,
//! `shape_from_scales` and `template_marks`, by hand.

use crate::BodyError;
use crate::girths::Girth;
use crate::levels::{self, Level, Levels, OVER, SkinOffsets};
use crate::measured::{Shares, TapedSkin};
use crate::scales::Scales;
use crate::shape::Shape;
use crate::shape_from_scales::shape;
use crate::solve_input::SolveInput;
use crate::tape::{Skinned, extent, half_length};
use crate::warp::{Follow, Warp};
use toile_geometry::{TriangleMesh, Vec3, closed_length};

/// The solved shape, levels and skin of a body.
pub(crate) struct Solved {
    pub(crate) shape: Shape,
    pub(crate) levels: Levels,
    pub(crate) mesh: TriangleMesh,
}

/// Number of rounds between two extrapolations of the unknowns to their limit.
const EXTRAPOLATION_INTERVAL: usize = 8;
/// Number of rounds in which posture and form are still corrected. The first number holds if the form of a
/// bust is solved for, which influences all other unknowns, the second if it is not. Most bodies need 8 to 15
/// rounds.
const FORMING: [usize; 2] = [32, 24];
/// Number of rounds after [`FORMING`], in which only girths and levels are corrected.
const LAST: usize = 16;
/// Number of first rounds in which the form of sections is corrected.
const SHAPING: usize = 12;
/// Number of rounds between two searches for the positions of girths.
const LOOKS: usize = 4;
/// Largest change of a girth or a level as a share of stature at which the rounds end: 0.002 mm.
const STILL: f64 = 1e-6;

impl SolveInput<'_> {
    /// Finds the shape by fixed-point iteration: each scale is multiplied by the ratio of requested to
    /// measured girth, each level is moved by the error of its landmark. Until the last round is over,
    /// only the vertices that the tape meets are computed.
    pub(crate) fn solve(&self) -> Result<Solved, BodyError> {
        let height = self.request.get("height");
        let mut scales = Scales::new(self.stature_ratio(), &self.marks);
        let mut offsets = SkinOffsets::default();
        let crotch = self.crotch_vertices();
        let mut before: Option<[Scales; 2]> = None;
        let mut known: Option<Shares> = Some(Shares::of(|_| Some(0.5)));
        let slow = self.request.follows_skin();
        let forming = FORMING[usize::from(!slow)];
        let extrapolating = if slow { forming } else { forming + LAST };
        for round in 0..forming + LAST {
            let levels = levels::solve(&self.request, &self.marks, &offsets);
            let shape = shape(self, &scales, &levels)?;
            let warp = Warp::new(self.template, &self.marks, shape);
            let place = |v: usize| self.place(&warp, height, v);
            let skinned = Skinned::lazy(
                (&self.skin.mesh, &self.skin.bands),
                &self.skin.parts,
                &place,
            );
            let looks = known.is_none();
            let taken = self
                .taken(&skinned, (&levels, &warp), &crotch)
                .knowing(known.unwrap_or_default());
            let mut moved = self.correct(&mut scales, &mut offsets, &taken);
            if round < forming {
                if round < SHAPING {
                    self.form(&mut scales, &taken);
                }
                moved = moved.max(self.posture(&mut scales, &taken, round));
            }
            let is_still = moved < STILL * height;
            if is_still && looks {
                break;
            }
            let looks_next = is_still || round % LOOKS == 0;
            known = (!looks_next).then(|| taken.shares());
            before = Some(match before {
                Some([older, old])
                    if round % EXTRAPOLATION_INTERVAL == EXTRAPOLATION_INTERVAL - 1
                        && round + EXTRAPOLATION_INTERVAL < extrapolating =>
                {
                    extrapolate(&mut scales, [older, old]);
                    [scales.clone(), scales.clone()]
                }
                Some([_, old]) => [old, scales.clone()],
                None => [scales.clone(), scales.clone()],
            });
        }
        let levels = levels::solve(&self.request, &self.marks, &offsets);
        let shape = shape(self, &scales, &levels)?;
        let mesh = self.skin_of(&Warp::new(self.template, &self.marks, shape.clone()));
        Ok(Solved {
            shape,
            levels,
            mesh,
        })
    }

    pub(crate) fn taken<'a>(
        &'a self,
        skinned: &'a Skinned<'a>,
        on: (&'a Levels, &'a Warp),
        crotch: &'a [u32],
    ) -> TapedSkin<'a> {
        TapedSkin::new(skinned, (&self.marks, &self.skin.armpit), on, crotch)
    }

    /// Corrects scales and offsets by the values of the tape. Returns the largest error (m).
    fn correct(&self, scales: &mut Scales, offsets: &mut SkinOffsets, taken: &TapedSkin) -> f64 {
        let q = &self.request;
        let mut miss: f64 = 0.0;
        for girth in Girth::ALL {
            if let Some(asked) = q.girth(girth) {
                let got = taken.girth(girth);
                miss = miss.max((asked - got).abs());
                let factor = ratio(asked, got);
                scales.girth[girth] *= match taken.at_section(girth) {
                    Some(there) => {
                        let [low, high] = beside(girth).map(|share| ratio(share * asked, there));
                        match girth.level() {
                            Some(_) => factor.clamp(low.min(1.0), high.max(1.0)),
                            None => factor.clamp(low, high),
                        }
                    }
                    None => factor,
                };
            }
        }
        let (tip, neck) = (taken.tip(), taken.neck_side());
        // The shoulders' breadth is determined by their width, or else by the lengths over them.
        let over = ["shoulder_w", "shoulder_to_shoulder", "shoulder_length"];
        let name = over
            .into_iter()
            .find(|name| q.is_asked(name))
            .unwrap_or("shoulder_w");
        let widths = [
            (
                &mut scales.shoulder.breadth,
                name,
                taken.value(name).unwrap_or(2.0 * tip.x),
            ),
            (&mut scales.neck.breadth, "neck_w", 2.0 * neck.x),
        ];
        for (scale, name, got) in widths {
            miss = miss.max((q.get(name) - got).abs());
            *scale *= ratio(q.get(name), got);
        }
        let mut along = |name: &str, scale: &mut f64| {
            if let Some(got) = taken.value(name) {
                miss = miss.max((q.get(name) - got).abs());
                *scale += q.get(name) - got;
            }
        };
        along("arm_length", &mut scales.arm.wrist);
        if q.is_asked("shoulder_to_elbow") {
            along("shoulder_to_elbow", &mut scales.arm.elbow);
        } else if q.is_asked("elbow_to_wrist") {
            let share = self.marks.arm.elbow / self.marks.arm.wrist;
            let asked = q
                .get("elbow_to_wrist")
                .clamp(0.3 * scales.arm.wrist, 0.7 * scales.arm.wrist);
            scales.arm.elbow = if share > 0.0 {
                scales.arm.wrist - asked
            } else {
                scales.arm.elbow
            };
        } else {
            scales.arm.elbow = scales.arm.wrist * self.marks.arm.elbow / self.marks.arm.wrist;
        }
        offsets.run = Some(tip.x - neck.x);
        for level in [Level::Tip, Level::NeckSide, Level::Crotch] {
            let found = taken.height(level) - taken.levels.at(level);
            let known = &mut offsets.level[level as usize];
            miss = miss.max((found - *known).abs());
            *known = found;
        }
        for (k, (name, upper, lower, _)) in OVER.into_iter().enumerate() {
            if q.is_asked(name)
                && let Some(got) = taken.value(name)
            {
                let lower = lower.map_or(0.0, |level| taken.levels.at(level));
                let found = got - (taken.levels.at(upper) - lower);
                // Half steps, because a change in a length over the body moves the points that it passes
                // over.
                let step = 0.5 * (found - offsets.over[k]);
                miss = miss.max(step.abs());
                offsets.over[k] += step;
            }
        }
        miss
    }

    /// Corrects the form of sections at equal girth: breadth over depth, front over back.
    fn form(&self, scales: &mut Scales, taken: &TapedSkin) {
        let q = &self.request;
        for (girth, breadth, depth) in [
            (Girth::Waist, "waist_breadth", "waist_depth"),
            (Girth::Hips, "hip_breadth", "hip_depth"),
        ] {
            let asked = q.is_asked(breadth) && q.is_asked(depth);
            let hull = taken.hull(girth);
            let [x, z] = extent(&hull);
            let form = &mut scales.trunk.section[girth];
            let aspect = form.aspect * ratio(q.get(breadth) * z, q.get(depth) * x);
            form.aspect = aspect.clamp(ASPECT[0], ASPECT[1]);
            // The girth over breadth and depth determines the fullness of the corners. The survey's waist is
            // taped at the navel.
            let around = match girth {
                Girth::Waist if !asked => q.get("navel_girth"),
                _ => q.girth(girth).unwrap_or_default(),
            };
            let wanted = around / (q.get(breadth) + q.get(depth));
            let found = closed_length(&hull) / (x + z);
            let fullness = form.corner_fullness + 2.0 * ratio(wanted, found).ln();
            form.corner_fullness = fullness.clamp(CORNERS[0], CORNERS[1]);
        }
        // The breadth of the chest is taken between the front folds of the armpits: at given girth and depth
        // it is determined by the front corners relative to the back ones.
        let [_, z] = extent(&taken.hull(Girth::Bust));
        let form = &mut scales.trunk.section[Girth::Bust];
        let aspect = form.aspect * ratio(z, q.get("chest_depth"));
        form.aspect = aspect.clamp(ASPECT[0], ASPECT[1]);
        // Requested widths of front or back already determine the asymmetry of the corners.
        let is_said = ["front_width", "back_width"]
            .iter()
            .any(|name| q.is_asked(name));
        if let (true, Some(found)) = (
            q.is_asked("chest_breadth") || !is_said,
            taken.between_folds(),
        ) {
            let fuller = ratio(q.get("chest_breadth"), found).ln();
            let asymmetry = &mut scales.trunk.chest_asymmetry;
            *asymmetry = (*asymmetry + fuller).clamp(ASYMMETRY[0], ASYMMETRY[1]);
        }
        for (girth, name, side) in PARTS {
            if !q.is_asked(name) {
                continue;
            }
            let hull = taken.hull(girth);
            let [own, other] = [side, -side].map(|side| half_length(&hull, side));
            let asked = (q.get(name) / (own + other)).clamp(0.3, 0.7);
            let share = &mut scales.trunk.section[girth].front_share;
            *share += side * (asked - own / (own + other));
            *share = share.clamp(-FRONT_SHARE, FRONT_SHARE);
        }
    }

    /// Corrects the position of the neck between front and back lengths, the positions of side lines, armpits
    /// and crotch point, the flatness of the crotch, and the projection and distance of the bust points.
    /// Returns the largest error that can still be corrected (m).
    fn posture(&self, scales: &mut Scales, taken: &TapedSkin, round: usize) -> f64 {
        let q = &self.request;
        let height = q.get("height");
        let mut miss: f64 = 0.0;
        let gap = |name: &str| -> Option<f64> {
            let asked = q.is_asked(name).then(|| q.get(name))?;
            Some(asked - taken.value(name)?)
        };
        // Moves an unknown by a step and keeps it between limits; `worth` converts the step to a length (m).
        let mut step = |unknown: &mut f64, by: f64, [low, high]: [f64; 2], worth: f64| {
            let before = *unknown;
            *unknown = (before + by).clamp(low, high);
            miss = miss.max((*unknown - before).abs() * worth);
        };
        let of_height = |limits: [f64; 2]| limits.map(|limit| limit * height);
        for (girth, name, side) in PARTS {
            if q.is_asked(name) {
                let at = taken.sides_of(girth, side, q.get(name), SIDES * height);
                scales.trunk.section[girth].side_depth = at;
            }
        }
        if let (true, Some(longer)) = (q.follows_skin(), gap("bust_to_underbust")) {
            step(
                &mut scales.bust.projection,
                longer,
                of_height(PROJECTION),
                1.0,
            );
        }
        if let Some(longer) = gap("crotch_length") {
            let more = longer / (LEVELLED * height);
            let flatness = &mut scales.crotch.flatness;
            step(flatness, 0.6 * more, FLATNESS, LEVELLED * height);
            // If a level crotch does not suffice for the crotch length, hips without a requested form are
            // made deeper.
            let is_said = q.is_asked("hip_depth") || q.is_asked("hip_breadth");
            if *flatness == FLATNESS[1] && round >= SHAPING && !is_said {
                let aspect = &mut scales.trunk.section[Girth::Hips].aspect;
                let depth = q.get("hip_depth");
                let by = *aspect * (-1.4 * longer / depth).exp_m1();
                step(aspect, by, ASPECT, depth);
            }
        }
        if q.is_asked("crotch_length_front") {
            let now = taken.warp.crotch_point();
            let range =
                [-1.0, 1.0].map(|end| now - scales.crotch.point_offset + end * SIDES * height);
            if let Some(at) = taken.crotch_point_of(q.get("crotch_length_front"), range) {
                scales.crotch.point_offset += at - now;
            }
        }
        let ways = ["hps_to_waist_front", "hps_to_waist_back"].map(gap);
        if let [Some(front), Some(back)] = ways {
            let by = 0.8 * (back - front);
            let limits = of_height([-NECK_FORWARD, NECK_FORWARD]);
            step(&mut scales.neck.forward, by, limits, 1.0);
        }
        if let Some(asked) = q.girth(Girth::Hips) {
            // No section below the hips may have a larger girth than the hips at their level.
            let most = taken.girth(Girth::Hips);
            let share = match taken.at_level(Girth::Hips) {
                Some(there) if taken.hips_lie_below() => (there / most + AS_LARGE).min(1.0),
                _ => 1.0,
            };
            let crotch = &mut scales.trunk.crotch_to_hips;
            let by = *crotch * (share.powf(CROTCH_GAIN) - 1.0);
            step(crotch, by, CROTCH_TO_HIPS, asked);
        }
        let higher = taken.levels.at(Level::Armpit) - taken.height(Level::Armpit);
        step(
            &mut scales.shoulder.armpit_rise,
            higher,
            of_height([-ARMPIT, ARMPIT]),
            1.0,
        );
        if let Some(wider) = gap("bust_points") {
            let got = q.get("bust_points") - wider;
            let gain = if q.follows_skin() { 1.1 } else { 0.6 };
            let more = gain * (ratio(q.get("bust_points"), got) - 1.0);
            step(&mut scales.bust.spread, more, SPREAD, got);
        }
        miss
    }

    /// Position of a vertex of the template on a body of a height (m); only for the left half and the median
    /// plane.
    fn place(&self, warp: &Warp, height: f64, v: usize) -> Vec3 {
        let follow = Follow {
            arm: self.skin.arm[v],
            leg: self.skin.leg[v],
        };
        let mut p = warp.apply(self.skin.mesh.positions[v], follow);
        if self.skin.mirror[v] as usize == v {
            p.x = 0.0;
        } else {
            let least = if follow.leg > 0.5 { LEG_GAP } else { SIDE_GAP };
            p.x = p.x.max(least * height);
        }
        p
    }

    /// The template's skin carried to a shape, exactly symmetric.
    fn skin_of(&self, warp: &Warp) -> TriangleMesh {
        let (skin, height) = (self.skin, self.request.get("height"));
        let mut mesh = skin.mesh.clone();
        let left = |v: &usize| skin.mirror[*v] as usize >= *v;
        for v in (0..skin.mirror.len()).filter(left) {
            mesh.positions[v] = self.place(warp, height, v);
        }
        skin.underarm.draw(&mut mesh.positions, height);
        for v in (0..skin.mirror.len()).filter(left) {
            let mirror = skin.mirror[v] as usize;
            if mirror != v {
                let p = mesh.positions[v];
                mesh.positions[mirror] = Vec3::new(-p.x, p.y, p.z);
            }
        }
        mesh
    }
}

/// Extrapolates unknowns with evenly shrinking steps to their limit, each by its own ratio of steps (Aitken
/// 1926), by at most eight more steps.
fn extrapolate(scales: &mut Scales, [mut older, mut old]: [Scales; 2]) {
    let history = older.coupled().zip(old.coupled());
    for (now, (older, old)) in scales.coupled().zip(history) {
        let [first, second] = [*old - *older, *now - *old];
        let ratio = second / first;
        if (0.3..0.98).contains(&ratio) {
            *now += second * (ratio / (1.0 - ratio)).min(8.0);
        }
    }
}

/// Parts of girths in front of the side lines (+1) or behind them (-1), by name.
const PARTS: [(Girth, &str, f64); 5] = [
    (Girth::Bust, "front_width", 1.0),
    (Girth::Bust, "back_width", -1.0),
    (Girth::HighBust, "high_bust_front", 1.0),
    (Girth::Waist, "waist_back_width", -1.0),
    (Girth::Hips, "hip_back_width", -1.0),
];

/// Range of the lateral scale of a section divided by the frontal one (1): people differ by less.
const ASPECT: [f64; 2] = [0.7, 1.3];
/// Range of the fullness of a section's corners (1): people differ by less.
const CORNERS: [f64; 2] = [-0.3, 0.3];

/// Range of the fullness of a chest's front corners relative to the mean of front and back.
const ASYMMETRY: [f64; 2] = [-0.25, 0.25];

/// Largest distance of a neck from the template's position, as a share of stature.
const NECK_FORWARD: f64 = 0.05;

/// Range of a girth at the section that sets its scale, divided by the girth where it is taped (1). Where a
/// neighbour decides the taped girth, as an elbow does at the end of a forearm, no scale reaches it.
fn beside(girth: Girth) -> [f64; 2] {
    match girth {
        Girth::Forearm => [0.9, 1.6],
        // The foot decides where thick ankles are taped, and they where the calf is.
        Girth::Calf | Girth::Ankle => [0.5, 2.0],
        _ if girth.level().is_some() => [0.7, 1.5],
        _ => [0.8, 1.6],
    }
}

/// Range of the trunk's scale at the crotch divided by the scale at the hips (1).
const CROTCH_TO_HIPS: [f64; 2] = [0.85, 1.0];

/// Largest share of the hips' girth by which the girth at the hips' level may be smaller.
const AS_LARGE: f64 = 0.002;

/// Exponent with which the scale at the crotch is corrected: more than 1, as the correction is meant for the
/// section above the crotch.
const CROTCH_GAIN: f64 = 1.7;

/// Largest distance of an armpit from the template's position, as a share of stature.
const ARMPIT: f64 = 0.035;

/// Largest deviation of the front's share of the frontal scale from one half; if a requested part of a girth
/// needs more, the side lines are moved.
const FRONT_SHARE: f64 = 0.05;

/// Largest distance of the side lines of a girth from the plane z = 0, and of the crotch point from the
/// lowest point of the crotch, as a share of stature.
const SIDES: f64 = 0.045;

/// Range of the share by which the bust points may be farther apart than in the scaled sections.
const SPREAD: [f64; 2] = [-0.4, 1.0];

/// Range of the projection of the bust points, as a share of stature.
const PROJECTION: [f64; 2] = [-0.02, 0.085];

/// Range of the flatness of a crotch (1).
const FLATNESS: [f64; 2] = [-0.3, 0.97];
/// Lengthening of the crotch length by a level crotch, as a share of stature.
const LEVELLED: f64 = 0.05;

/// Half the least gap between the legs, as a share of stature: cloth must pass.
const LEG_GAP: f64 = 0.0018;

/// Smallest distance from the median plane of points that are not in it, as a share of stature.
const SIDE_GAP: f64 = 0.0006;

fn ratio(asked: f64, got: f64) -> f64 {
    if got > 0.0 && asked > 0.0 {
        (asked / got).clamp(0.25, 4.0)
    } else {
        1.0
    }
}
