//! How the body holds itself: what lengths over it decide at given levels and girths.

use crate::conflict::is_short;
use crate::girths::Girth;
use crate::levels::Level;
use crate::shape::Scales;
use crate::solve::{ASPECT, DEEPEST, Grown, PARTS, ratio};
use crate::taken::Taken;
use crate::warp::Warp;
use std::cell::Cell;
use toile_geometry::Vec3;

/// How far a neck may stand from the template's place, over stature.
const LEAN: f64 = 0.05;

/// How far an armpit may lie from the template's place, over stature.
const ARMPIT: f64 = 0.05;

/// How far a section of the trunk may stand from the template's place, over stature.
const SHIFT: f64 = 0.035;

/// How far the bust points may stand out or lie back, over stature.
const BULGE: [f64; 2] = [-0.02, 0.065];

/// How much farther up the template may lie what comes to the hips, over stature.
const SEAT: f64 = 0.12;

/// From how much of this on the hips become deeper besides, over stature.
const DEEPER: f64 = 0.06;

/// How far the crotch may lie before or behind the template's place, over stature.
const FORK: f64 = 0.03;

/// How wide a neck may be over what is predicted.
const WIDE: f64 = 1.3;

/// The round after which the bust points keep their place on the skin.
const SNAP: usize = 6;

/// How far sideways the foremost place may lie from it, over stature: half the way to the next
/// column of vertices.
const COLUMN: f64 = 0.0065;

/// How far bust points are drawn apart where there is a choice: chests grow narrower yet.
const DRAWN: f64 = 0.2;

/// Half the distance of rows of vertices, over stature.
const ROW: f64 = 0.005;

impl Grown<'_> {
    /// The vertex of the chest's front at the bust that is nearest to a distance from the middle of
    /// the body [m] when drawn apart a little.
    fn column_at(&self, taken: &Taken, spread: f64, x: f64) -> Option<u32> {
        let m = &self.marks;
        let is_near = |p: &Vec3| {
            let row = (p.y - m.bust).abs() < ROW * m.crown;
            row && p.z > m.depth && p.x > 0.0 && p.x < m.tip.x
        };
        let off = |v: u32| {
            let apart = Warp::apart(m, self.skin.mesh.positions[v as usize]);
            let own = taken.skinned.at(v).x / (1.0 + spread * apart);
            (own * (1.0 + DRAWN * apart) - x).abs()
        };
        let vertices = self.skin.mesh.positions.iter().enumerate();
        vertices
            .filter(|(_, p)| is_near(p))
            .map(|(v, _)| v as u32)
            .min_by(|&a, &b| off(a).total_cmp(&off(b)))
    }

    /// Corrects where neck and sections of the trunk stand, the bust points, the armpits and the
    /// seat. Returns the largest step taken and the largest miss of what is corrected [m].
    pub(crate) fn posture(&self, scales: &mut Scales, taken: &Taken, round: usize) -> [f64; 2] {
        let q = &self.request;
        let height = q.get("height");
        let mut miss: f64 = 0.0;
        let open = Cell::new(0.0);
        let gap = |name: &str| {
            let asked = q.is_asked(name).then(|| q.get(name))?;
            Some(asked - taken.value(name)?)
        };
        let note = |gap: f64| open.set(f64::max(open.get(), gap.abs()));
        // Moves an unknown by a step between limits over stature.
        let mut step = |unknown: &mut f64, by: f64, [low, high]: [f64; 2]| {
            let before = *unknown;
            *unknown = (before + by).clamp(low * height, high * height);
            miss = miss.max((*unknown - before).abs());
        };
        if let (Some(front), Some(back)) = (gap("hps_to_waist_front"), gap("hps_to_waist_back")) {
            note(front);
            note(back);
            step(&mut scales.lean, 0.5 * (back - front), [-LEAN, LEAN]);
        }
        let armpit = taken.levels.at(Level::Armpit) - taken.height(Level::Armpit);
        step(&mut scales.armpit, armpit, [-ARMPIT, ARMPIT]);
        for (girth, name, side) in PARTS {
            if let Some(longer) = gap(name) {
                note(longer);
                let by = 0.4 * side * longer;
                step(&mut scales.shift[girth as usize], by, [-SHIFT, SHIFT]);
            }
        }
        if let (Some(above), Some(below)) = (gap("bust_line"), gap("bust_to_underbust"))
            && !is_short("bust_line", &q.conflicts)
        {
            note(above);
            note(below);
            step(&mut scales.bulge, 0.6 * (above + below), BULGE);
            if let (Some(front), false) = (gap("hps_to_waist_front"), q.is_asked("neck_w")) {
                // Beside the bust the straight way is shorter.
                let by = -0.2 * (front - above - below) / q.get("neck_w");
                scales.wide = (scales.wide + by).clamp(1.0, WIDE);
            }
        }
        if let Some(around) = gap("crotch_length") {
            note(around);
            step(&mut scales.seat, 0.5 * around, [0.0, SEAT]);
            if scales.seat >= DEEPER * height || (around < 0.0 && scales.seat > 0.0) {
                // Then by deeper hips.
                let form = &mut scales.aspect[Girth::Hips as usize];
                let deeper = 2.0 * around / q.get("hip_depth");
                *form = (*form * (-deeper).exp()).clamp(DEEPEST, ASPECT[1]);
            }
            if let Some(before) = gap("crotch_length_front") {
                step(
                    &mut scales.fork,
                    0.3 * (around - 2.0 * before),
                    [-FORK, FORK],
                );
            }
        }
        if let (Some(wider), Some(point)) = (gap("bust_points"), taken.bust_point()) {
            let got = q.get("bust_points") - wider;
            note(wider);
            // Another one where this one had to be drawn too far.
            let far = !(-0.35..=0.9).contains(&scales.spread) && round < 5 * SNAP;
            // An asked form of the chest says itself which place is foremost.
            let is_said = ["chest_breadth", "chest_depth"]
                .iter()
                .any(|name| q.is_asked(name));
            let again = far && round > 0 && round.is_multiple_of(SNAP);
            if !is_said && (round == SNAP || again) {
                let asked = 0.5 * q.get("bust_points");
                scales.column = self.column_at(taken, scales.spread, asked);
            }
            let off = |v: u32| (taken.skinned.at(v).x - point.x).abs() > COLUMN * height;
            if scales.column.is_some_and(off) {
                // Another place of the chest is foremost: let this one stand out.
                step(&mut scales.bulge, 0.002 * height, BULGE);
            } else {
                let before = scales.spread;
                let more = 0.8 * (ratio(q.get("bust_points"), got) - 1.0);
                scales.spread = (before + more).clamp(-0.4, 1.1);
                step(&mut 0.0, (scales.spread - before) * got, [-1.0, 1.0]);
            }
        }
        [miss, open.get()]
    }
}
