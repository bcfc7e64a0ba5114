//! Definitions of the girths: where each is taped on a standing body. Our own bodies are solved and reported
//! by them, and foreign meshes are measured by them.

use crate::girths::Girth;

/// Landmarks of a standing body that determine the positions of the girths (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BodyMarks {
    pub(crate) stature: f64,
    /// Height of the crotch over the floor.
    pub(crate) crotch: f64,
    /// Height of the armpits over the floor.
    pub(crate) armpit: f64,
    /// Height of the centre of the knee over the floor.
    pub(crate) knee: f64,
    /// Distances along the arm of the armpit and of the finger tips, from one starting point.
    pub(crate) arm: [f64; 2],
}

/// The section that a tape goes round.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cut {
    /// Level round the trunk, at a height over the floor.
    Trunk,
    /// Level round the head, at a height over the floor.
    Head,
    /// Round the neck, lower in front by [`NECK_TILT`], at a height over the middle of the neck.
    Neck,
    /// Level round one leg, at a height over the floor.
    Leg,
    /// Across one arm, at a distance along it.
    Arm,
}

/// The section that counts among all sections in the range of a girth: the one with the largest or with the
/// smallest girth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Choice {
    Largest,
    Smallest,
}

/// Definition of a girth: the section, the range of positions (m), and the choice within it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Taping {
    pub(crate) cut: Cut,
    pub(crate) range: [f64; 2],
    choice: Choice,
}

/// Tilt of a tape round the neck, lower in front (rad): about square to the axis of the neck. A tape of this
/// tilt takes the least girth of a neck to within 2 mm.
pub(crate) const NECK_TILT: f64 = 20.0 * std::f64::consts::PI / 180.0;
/// Largest distance of the tape above or below the middle of the neck, as a share of stature.
const NECK_REACH: f64 = 0.03;

/// Range of the height of the hips, as shares of the way from crotch to crown.
const HIPS: [f64; 2] = [0.035, 0.11];
/// Range of the height of the waist, as shares of the same way.
const WAIST: [f64; 2] = [0.28, 0.35];
/// Height of the girth under the bust, as a share of the same way.
const UNDERBUST: f64 = 0.415;
/// Range of the height of the bust, as shares of the same way.
const BUST: [f64; 2] = [0.44, 0.50];
/// Least depth of the bust below the armpits, as a share of stature.
pub(crate) const BUST_DROP: f64 = 0.008;
/// Depth below the crotch at which the thigh is taped, as a share of stature.
pub(crate) const THIGH_DROP: f64 = 0.012;
/// Height of the knee as a share of the height of the crotch, if it is not given.
pub(crate) const KNEE: f64 = 0.58;
/// Height of the lower thigh's girth, as a share of the way from knee to crotch.
const LOWER_THIGH: f64 = 0.15;
/// Range of the height of the calf, as shares of the height of the knee.
const CALF: [f64; 2] = [0.55, 0.9];
/// Largest height of the ankle's girth, as a share of the height of the knee.
const ANKLE_MOST: f64 = 0.6;
/// Smallest height of the ankle's girth, as a share of stature.
const ANKLE_LEAST: f64 = 0.03;
/// Range of the height of the head's girth, as shares of stature.
const HEAD: [f64; 2] = [0.94, 0.97];
/// Range of the upper arm's girth, as shares of the way along the arm from the armpit to the finger tips.
const UPPER_ARM: [f64; 2] = [0.15, 0.28];
/// Range of the forearm's girth, as shares of the same way.
const FOREARM: [f64; 2] = [0.38, 0.60];
/// Range of the wrist's girth, as shares of the same way.
const WRIST: [f64; 2] = [0.60, 0.78];

/// Number of even steps in which a range is searched first.
const STEPS: usize = 8;
/// Number of times that the range round the best step is then narrowed by the golden section (Kiefer 1953).
const NARROWINGS: usize = 5;

/// Range of heights in which a girth round the trunk is searched for, from the heights of crotch and crown
/// (m); `None` if lengths alone give the level of the girth.
pub(crate) fn trunk_range(girth: Girth, [crotch, crown]: [f64; 2]) -> Option<[f64; 2]> {
    let shares = match girth {
        Girth::Hips => HIPS,
        Girth::Waist => WAIST,
        Girth::Bust => BUST,
        Girth::Underbust => [UNDERBUST; 2],
        _ => return None,
    };
    Some(shares.map(|share| crotch + share * (crown - crotch)))
}

impl Taping {
    /// Definition of a girth on a body; `None` where lengths alone give its position.
    ///
    /// Hips are the largest level girth from the crotch up, the waist is the smallest above them, the bust
    /// the largest under the armpits, as in ISO 8559-1 (2017). The girth under the bust lies at a share of
    /// the height from crotch to crown. Calf and ankle are the largest and smallest level girths of the lower
    /// leg, the neck is the smallest girth about square to its axis, upper arm and forearm are the largest
    /// and the wrist the smallest girth across the arm.
    pub(crate) fn of(girth: Girth, marks: &BodyMarks) -> Option<Self> {
        use Choice::{Largest, Smallest};
        let h = marks.stature;
        let along = |share: f64| marks.arm[0] + share * (marks.arm[1] - marks.arm[0]);
        let reach = NECK_REACH * h;
        let lower_thigh = marks.knee + LOWER_THIGH * (marks.crotch - marks.knee);
        let trunk = || trunk_range(girth, [marks.crotch, h]);
        let (cut, range, choice) = match girth {
            Girth::Hips | Girth::Underbust => (Cut::Trunk, trunk()?, Largest),
            Girth::Waist => (Cut::Trunk, trunk()?, Smallest),
            Girth::Bust => {
                let top = marks.armpit - BUST_DROP * h;
                (Cut::Trunk, trunk()?.map(|y| y.min(top)), Largest)
            }
            Girth::Thigh => (Cut::Leg, [marks.crotch - THIGH_DROP * h; 2], Largest),
            Girth::LowerThigh => (Cut::Leg, [lower_thigh; 2], Largest),
            Girth::Knee => (Cut::Leg, [marks.knee; 2], Largest),
            Girth::Calf => (Cut::Leg, CALF.map(|share| share * marks.knee), Largest),
            Girth::Ankle => {
                let range = [ANKLE_LEAST * h, ANKLE_MOST * marks.knee];
                (Cut::Leg, range, Smallest)
            }
            Girth::Head => (Cut::Head, HEAD.map(|share| share * h), Largest),
            Girth::Neck => (Cut::Neck, [-reach, reach], Smallest),
            Girth::UpperArm => (Cut::Arm, UPPER_ARM.map(along), Largest),
            Girth::Forearm => (Cut::Arm, FOREARM.map(along), Largest),
            Girth::Wrist => (Cut::Arm, WRIST.map(along), Smallest),
            Girth::HighBust | Girth::HighHips | Girth::Heel | Girth::Elbow => return None,
        };
        Some(Self { cut, range, choice })
    }

    /// Position of the girth (m); `around` takes the girth at a position. `None` if the body has no section
    /// in the range.
    pub(crate) fn find(&self, around: impl Fn(f64) -> Option<f64>) -> Option<f64> {
        let [low, high] = self.range;
        if high <= low {
            return Some(low);
        }
        let sign = match self.choice {
            Choice::Largest => 1.0,
            Choice::Smallest => -1.0,
        };
        let value = |at: f64| around(at).filter(|g| *g > 0.0).map(|g| sign * g);
        let step = (high - low) / STEPS as f64;
        let places = (0..=STEPS).map(|k| low + step * k as f64);
        let (_, best) = places
            .filter_map(|at| Some((value(at)?, at)))
            .max_by(|a, b| a.0.total_cmp(&b.0))?;
        let value = |at: f64| value(at).unwrap_or(f64::NEG_INFINITY);
        let golden = 0.5 * (5f64.sqrt() - 1.0);
        let (mut a, mut b) = ((best - step).max(low), (best + step).min(high));
        let [mut c, mut d] = [b - golden * (b - a), a + golden * (b - a)];
        let [mut at_c, mut at_d] = [value(c), value(d)];
        for _ in 0..NARROWINGS {
            if at_c > at_d {
                (b, d, at_d) = (d, c, at_c);
                c = b - golden * (b - a);
                at_c = value(c);
            } else {
                (a, c, at_c) = (c, d, at_d);
                d = a + golden * (b - a);
                at_d = value(d);
            }
        }
        let last = [(at_c, c), (at_d, d), (value(best), best)];
        let found = last.into_iter().max_by(|a, b| a.0.total_cmp(&b.0));
        found.map(|(_, at)| at)
    }

    /// Position (m) at a share of the range.
    pub(crate) fn at(&self, share: f64) -> f64 {
        self.range[0] + share * (self.range[1] - self.range[0])
    }

    /// Share of the range at which a position lies (1).
    pub(crate) fn share(&self, place: f64) -> f64 {
        let wide = self.range[1] - self.range[0];
        if wide > 0.0 {
            (place - self.range[0]) / wide
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MARKS: BodyMarks = BodyMarks {
        stature: 1.7,
        crotch: 0.8,
        armpit: 1.3,
        knee: 0.46,
        arm: [0.1, 0.7],
    };

    #[test]
    fn a_girth_lies_where_its_definition_says() {
        let hips = Taping::of(Girth::Hips, &MARKS).unwrap();
        let found = hips.find(|y| Some(1.0 - (y - 0.8567).powi(2))).unwrap();
        assert!((found - 0.8567).abs() < 1e-3, "{found}");
        assert!((hips.at(hips.share(found)) - found).abs() < 1e-12);
        // A girth that keeps falling lies at the end of its range.
        let waist = Taping::of(Girth::Waist, &MARKS).unwrap();
        let found = waist.find(|y| Some(2.0 - y)).unwrap();
        assert!((found - waist.range[1]).abs() < 1e-12, "{found}");
        assert_eq!(waist.find(|_| None), None);
        assert_eq!(Taping::of(Girth::HighHips, &MARKS), None);
    }
}
