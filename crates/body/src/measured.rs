//! Takes each measurement, by name, from a skin.
//!
//! # Decided with
//! - [`crate::tape`], [`toile_geometry::horizontal_section`]: tape round sections and along the body;
//! - [`crate::definitions::Taping`], [`crate::cuts::CutPlane`]: where each girth lies, its plane on our own
//!   bodies;
//! - [`crate::template_marks`], [`crate::landmarks::Landmarks`]: marks of a template; points of a finished
//!   body;
//! - [`crate::bands`]: triangles near a tape;
//! - [`crate::scan::Scan`], [`crate::scan_girths`]: a foreign mesh of a person;
//! - [`toile_measure::CATALOGUE`]: the names.
//!
//! By hand: a new measurement is taken here by its name.

use crate::Part;
use crate::bands::Near;
use crate::cuts::{CutPlane, scale_place};
use crate::definitions::{BodyMarks, KNEE, Taping};
use crate::girths::{Girth, PerGirth};
use crate::levels::{Level, Levels, upright};
use crate::tape::{
    Skinned, along, breadth_at, extent, fall, half_length, hanging, outermost, stretched,
};
use crate::template_marks::TemplateMarks;
use crate::warp::{Follow, Warp};
use std::cell::{OnceCell, RefCell};
use std::f64::consts::FRAC_PI_2;
use std::rc::Rc;
use toile_geometry::{Vec2, Vec3, closed_length, convex_hull};

/// A skin with the levels, marks and caches that the tape needs to measure it.
pub(crate) struct TapedSkin<'a> {
    pub(crate) skinned: &'a Skinned<'a>,
    pub(crate) marks: &'a TemplateMarks,
    pub(crate) levels: &'a Levels,
    pub(crate) warp: &'a Warp,
    /// Vertices of the crotch in the median plane of the body.
    pub(crate) crotch: &'a [u32],
    /// Known positions of girths, as shares of their ranges; other girths are searched for.
    shares: Shares,
    body: OnceCell<BodyMarks>,
    /// Cache of the positions of girths.
    places: RefCell<PerGirth<Option<f64>>>,
    /// Cache of the hulls of sections.
    hulls: RefCell<PerGirth<Option<Rc<[Vec2]>>>>,
    /// Cache of measured values by name.
    known: RefCell<Vec<(String, Option<f64>)>>,
    /// Cache of the line round the crotch.
    around: OnceCell<Option<Around>>,
    /// Cache of the left bust point (m).
    bust: OnceCell<Option<Vec3>>,
    /// Cache of girths round the trunk at the positions found for them.
    found: PerGirth<OnceCell<f64>>,
    /// Cache of the upright section through the side of the neck.
    through_neck: OnceCell<Vec<[Vec3; 2]>>,
    /// Vertices of the left armpit from front to back.
    armpit: &'a [u32],
}

/// Positions of girths, as shares of their ranges (1).
pub(crate) type Shares = PerGirth<Option<f64>>;

/// The tight line in the median plane from the waist in front round the crotch to the waist behind.
struct Around {
    /// Length of the line (m).
    length: f64,
    /// Convex hull of the section in the median plane below the waist: height, depth (m).
    hull: Vec<Vec2>,
    /// Depth of the front end (m).
    front: f64,
}

impl Around {
    /// Length of the part of the line in front of a depth (m).
    fn before(&self, depth: f64) -> f64 {
        part_of(&self.hull, 1.0, depth) - (self.front - depth)
    }
}

/// Share by which the girth at the hips' level given by lengths may be smaller than the largest girth: up to
/// it, this level counts as the height of the hips.
const LEVEL_SLACK: f64 = 0.01;

/// Distance at which sections count as clearly apart, and hips as clearly below their level given by lengths,
/// as a share of stature: a centimetre.
const APART: f64 = 0.006;

/// Halvings of a range in a bisection: to a billionth of it.
const HALVINGS: usize = 30;

/// Length of the part of a hull on one side of a position on its second axis, without the closing chord (m).
fn part_of(hull: &[Vec2], side: f64, place: f64) -> f64 {
    let moved: Vec<Vec2> = hull.iter().map(|p| Vec2::new(p.x, p.y - place)).collect();
    half_length(&moved, side)
}

const TORSO: &[Part] = &[Part::Trunk, Part::Head];

impl<'a> TapedSkin<'a> {
    /// The tape on a skin cast from a template.
    pub(crate) fn new(
        skinned: &'a Skinned<'a>,
        (marks, armpit): (&'a TemplateMarks, &'a [u32]),
        (levels, warp): (&'a Levels, &'a Warp),
        crotch: &'a [u32],
    ) -> Self {
        Self {
            skinned,
            marks,
            levels,
            warp,
            crotch,
            shares: Shares::default(),
            body: OnceCell::new(),
            places: Default::default(),
            hulls: Default::default(),
            known: Default::default(),
            around: OnceCell::new(),
            bust: OnceCell::new(),
            found: Default::default(),
            through_neck: OnceCell::new(),
            armpit,
        }
    }

    /// End of the left shoulder (m).
    pub(crate) fn tip(&self) -> Vec3 {
        self.marks.shoulder.tip_on.on(self.skinned)
    }

    /// Left side of the neck (m).
    pub(crate) fn neck_side(&self) -> Vec3 {
        self.marks.neck.side_on.on(self.skinned)
    }

    /// Height of a landmark on the skin (m).
    pub(crate) fn height(&self, level: Level) -> f64 {
        match level {
            Level::Tip => self.tip().y,
            Level::NeckSide => self.neck_side().y,
            Level::Armpit => self.armpit_fold().y,
            Level::Crotch => {
                let heights = self.crotch.iter().map(|&v| self.skinned.at(v).y);
                heights.fold(f64::INFINITY, f64::min)
            }
            Level::Hips => self.hip_height(),
            _ => self.levels.at(level),
        }
    }

    /// Middle of the left armpit (m).
    fn armpit_fold(&self) -> Vec3 {
        self.skinned.at(self.armpit[self.armpit.len() / 2])
    }

    /// Hull of the section of a girth; for a girth round the trunk, at the level given by lengths.
    pub(crate) fn hull(&self, girth: Girth) -> Rc<[Vec2]> {
        if let Some(known) = &self.hulls.borrow()[girth] {
            return known.clone();
        }
        let hull: Rc<[Vec2]> = self.taken_hull(girth).into();
        self.hulls.borrow_mut()[girth] = Some(hull.clone());
        hull
    }

    fn taken_hull(&self, girth: Girth) -> Vec<Vec2> {
        let found = match girth.level() {
            None => self.taping(girth).zip(self.place(girth)),
            Some(_) => None,
        };
        let cut = match found {
            Some((taping, place)) => CutPlane::of(taping.cut, place, self.marks, self.warp),
            None => CutPlane::placed(girth, self.marks, self.levels, self.warp),
        };
        self.skinned.hull(cut.part, cut.plane, Some(cut.near))
    }

    /// Landmarks that determine the positions of the girths.
    pub(crate) fn body(&self) -> &BodyMarks {
        self.body.get_or_init(|| {
            let crotch = self.height(Level::Crotch);
            let stature = self.levels.at(Level::Crown);
            let heights = self.armpit.iter().map(|&v| self.skinned.at(v).y);
            let arm = [
                self.armpit_fold(),
                self.skinned.at(self.marks.arm.finger_tip),
            ];
            BodyMarks {
                stature,
                crotch,
                armpit: heights.fold(f64::INFINITY, f64::min),
                knee: KNEE * crotch,
                arm: arm.map(|p| self.warp.along_arm(p)),
            }
        })
    }

    /// Girth by a definition, taped at a position (m).
    pub(crate) fn taped(&self, taping: &Taping, place: f64) -> f64 {
        closed_length(&self.taped_hull(taping, place))
    }

    /// Hull of the section by a definition, at a position (m).
    fn taped_hull(&self, taping: &Taping, place: f64) -> Vec<Vec2> {
        let cut = CutPlane::of(taping.cut, place, self.marks, self.warp);
        self.skinned.hull(cut.part, cut.plane, Some(cut.near))
    }

    /// Half the breadth of the section of a girth round the trunk, and its height, at the position where the
    /// girth is taped (m).
    fn side_of(&self, girth: Girth, level: Level) -> [f64; 2] {
        match self.taping(girth).zip(self.place(girth)) {
            Some((taping, place)) => [0.5 * extent(&self.taped_hull(&taping, place))[0], place],
            None => [0.5 * extent(&self.hull(girth))[0], self.levels.at(level)],
        }
    }

    /// The definition by which a girth is searched for; `None` if lengths alone give its level, as is
    /// possible round the trunk.
    fn taping(&self, girth: Girth) -> Option<Taping> {
        let body = self.body();
        let ends = [body.crotch, body.stature];
        let is_level = |_| !self.levels.is_looked_for(girth, ends);
        if girth.level().is_some_and(is_level) {
            return None;
        }
        Taping::of(girth, body)
    }

    /// Position of a girth (m); `None` if it is given by lengths alone.
    fn place(&self, girth: Girth) -> Option<f64> {
        if let Some(known) = self.places.borrow()[girth] {
            return Some(known);
        }
        let taping = self.taping(girth)?;
        let place = match self.shares[girth] {
            Some(share) => taping.at(share),
            None => taping.find(|place| Some(self.taped(&taping, place)))?,
        };
        self.places.borrow_mut()[girth] = Some(place);
        Some(place)
    }

    /// Girth round the trunk, if it is searched for, measured at its level given by lengths (m).
    pub(crate) fn at_level(&self, girth: Girth) -> Option<f64> {
        self.taping(girth)?;
        girth.level()?;
        Some(closed_length(&self.hull(girth)))
    }

    /// A girth at the section that sets its scale (m): round the trunk at its level given by lengths, or at the
    /// nearest end of its range; on neck and limbs at the template's mark, if the taped place lies clearly apart.
    pub(crate) fn at_section(&self, girth: Girth) -> Option<f64> {
        let taping = self.taping(girth)?;
        let Some(level) = girth.level() else {
            let place = scale_place(girth, self.marks, self.warp)?;
            let apart = (place - self.place(girth)?).abs() > APART * self.body().stature;
            return apart.then(|| self.taped(&taping, place));
        };
        let y = self.levels.at(level);
        let [low, high] = taping.range;
        if (low..=high).contains(&y) {
            return self.at_level(girth);
        }
        Some(self.taped(&taping, if y < low { low } else { high }))
    }

    /// Whether the largest hip girth lies clearly below the hips' level given by lengths.
    pub(crate) fn hips_lie_below(&self) -> bool {
        let level = self.levels.at(Level::Hips) - APART * self.levels.at(Level::Crown);
        self.place(Girth::Hips).is_some_and(|place| place < level)
    }

    /// Height of the hips (m): their level given by lengths if the girth there is nearly the largest, else
    /// the position of the largest girth.
    fn hip_height(&self) -> f64 {
        let level = self.levels.at(Level::Hips);
        let most = self.girth(Girth::Hips);
        let least = (1.0 - LEVEL_SLACK) * most;
        match self.place(Girth::Hips) {
            Some(place)
                if self
                    .at_level(Girth::Hips)
                    .is_some_and(|there| there < least) =>
            {
                place
            }
            _ => level,
        }
    }

    /// Positions of the girths as shares of their ranges, for use with the next, similar body.
    pub(crate) fn shares(&self) -> Shares {
        Shares::of(|girth| {
            let taping = self.taping(girth)?;
            let known = self.places.borrow()[girth];
            known.map(|place| taping.share(place))
        })
    }

    /// This tape with known positions of girths, so that they are not searched for.
    pub(crate) fn knowing(mut self, shares: Shares) -> Self {
        self.shares = shares;
        self
    }

    /// A girth (m).
    pub(crate) fn girth(&self, girth: Girth) -> f64 {
        let found = girth
            .level()
            .and_then(|_| self.taping(girth).zip(self.place(girth)));
        match found {
            Some((taping, place)) => *self.found[girth].get_or_init(|| self.taped(&taping, place)),
            None => closed_length(&self.hull(girth)),
        }
    }

    /// Left bust point (m).
    pub(crate) fn bust_point(&self) -> Option<Vec3> {
        *self.bust.get_or_init(|| self.taken_bust_point())
    }

    fn taken_bust_point(&self) -> Option<Vec3> {
        let y = self.levels.at(Level::Bust);
        let level = [Vec3::y() * y, Vec3::y()];
        let x = self.warp.apply(self.marks.bust.point, Follow::default()).x;
        let section = self
            .skinned
            .section(&[Part::Trunk], level, self.around(y))
            .into_iter()
            .map(|s| s.map(|p| Vec2::new(p.x, p.z)))
            .collect::<Vec<_>>();
        let on = outermost(&section, x)?;
        Some(Vec3::new(on.x, y, on.y))
    }

    /// Range on the template of the triangles that may cross a height on the body (m).
    fn around(&self, height: f64) -> Option<Near> {
        Some(self.warp.near(height, 0.08))
    }

    /// Range of heights on the template of the triangles between two heights on the body (m).
    fn between(&self, low: f64, high: f64) -> Option<[f64; 2]> {
        match (self.around(low)?, self.around(high)?) {
            (Near::Level([from, _]), Near::Level([_, to])) => Some([from, to]),
            _ => None,
        }
    }

    /// The upright section through a point, parallel to z and to a direction, between two heights.
    fn upright(
        &self,
        parts: &[Part],
        [through, sideways]: [Vec3; 2],
        [low, high]: [f64; 2],
    ) -> Vec<[Vec3; 2]> {
        let normal = Vec3::z().cross(&sideways).normalize();
        let places = [through.x, through.x + sideways.x];
        let near = self
            .between(low, high)
            .map(|heights| Near::side(places, self.warp.sideways(), heights));
        self.skinned.section(parts, [through, normal], near)
    }

    fn bust_line(&self) -> Option<f64> {
        let (neck, bust) = (self.neck_side(), self.bust_point()?);
        let way = bust - neck;
        let down = Vec3::new(way.x, way.y, 0.0);
        let stretch = down.norm() / down.y.abs().max(1e-9);
        let section = self.upright(TORSO, [neck, down], [bust.y, neck.y]);
        // Lengths are along the plane's own line of slope, not along the vertical.
        let scaled: Vec<[Vec2; 2]> = section
            .iter()
            .map(|s| s.map(|p| Vec2::new(p.y * stretch, p.z)))
            .collect();
        let at = |p: Vec3| Vec2::new(p.y * stretch, p.z);
        Some(stretched(&scaled, at(bust), at(neck)))
    }

    fn below_bust(&self, to: Level) -> Option<f64> {
        let bust = self.bust_point()?;
        let floor = self.levels.at(to);
        let section = self.upright(&[Part::Trunk], [bust, Vec3::y()], [floor, bust.y]);
        fall(&section, bust, floor, Vec3::z())
    }

    /// Length along the skin from the bust point straight down to the level under the bust (m).
    fn under_bust(&self) -> Option<f64> {
        let bust = self.bust_point()?;
        let floor = self.levels.at(Level::Underbust);
        let section = self.upright(&[Part::Trunk], [bust, Vec3::y()], [floor, bust.y]);
        Some(along(&section, [floor, bust.y]))
    }

    fn outside_leg(&self) -> Option<f64> {
        let waist = self.levels.at(Level::Waist);
        let hips = self.levels.at(Level::Hips);
        let level = [Vec3::y() * waist, Vec3::y()];
        let side = self
            .skinned
            .section(&[Part::Trunk], level, self.around(waist))
            .into_iter()
            .flatten()
            .max_by(|a, b| a.x.total_cmp(&b.x))?;
        let section = self.skinned.section(
            &[Part::Trunk, Part::LeftLeg],
            [side, Vec3::z()],
            self.between(hips, waist).map(Near::Level),
        );
        Some(fall(&section, side, hips, Vec3::x())? + hips)
    }

    fn across_shoulders(&self) -> f64 {
        let tip = self.tip();
        let level = [tip, Vec3::y()];
        let section = self.skinned.section(TORSO, level, self.around(tip.y));
        let flat: Vec<[Vec2; 2]> = section
            .iter()
            .flat_map(|s| {
                let left = s.map(|p| Vec2::new(p.x, -p.z));
                [left, left.map(|p| Vec2::new(-p.x, p.y))]
            })
            .collect();
        let end = |x: f64| Vec2::new(x, -tip.z);
        stretched(&flat, end(-tip.x), end(tip.x))
    }

    /// The tight line round the crotch from waist to waist.
    fn crotch_lengths(&self) -> Option<&Around> {
        self.around.get_or_init(|| self.taken_crotch()).as_ref()
    }

    fn taken_crotch(&self) -> Option<Around> {
        let waist = self.levels.at(Level::Waist);
        let parts = &[Part::Trunk, Part::LeftLeg];
        // Just beside the median plane, where the section crosses whole triangles.
        let section = self.upright(
            parts,
            [Vec3::x() * 1e-6, Vec3::y()],
            [self.levels.at(Level::Crotch), waist],
        );
        let flat = |side: f64| -> Vec<[Vec2; 2]> {
            let turned = |p: Vec3| Vec2::new(p.y, side * p.z);
            section.iter().map(|s| s.map(turned)).collect()
        };
        let ends = [1.0, -1.0].map(|side| outermost(&flat(side), waist));
        let [Some(front), Some(back)] = ends else {
            return None;
        };
        let mut points: Vec<Vec2> = section
            .iter()
            .flatten()
            .filter(|p| p.y <= waist)
            .map(|p| Vec2::new(p.z, p.y))
            .collect();
        points.push(Vec2::new(front.y, waist));
        points.push(Vec2::new(-back.y, waist));
        let hull = convex_hull(&points);
        // The hull with depth as its second axis, to measure the length in front of a depth.
        let turned: Vec<Vec2> = hull.iter().map(|p| Vec2::new(p.y, p.x)).collect();
        Some(Around {
            length: closed_length(&hull) - (front.y + back.y),
            hull: turned,
            front: front.y,
        })
    }

    /// Depth of the crotch point for which the part of the line in front of it has the length `before` (m).
    pub(crate) fn crotch_point_of(&self, before: f64, [low, high]: [f64; 2]) -> Option<f64> {
        let around = self.crotch_lengths()?;
        let (mut low, mut high) = (low, high);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            match around.before(middle) > before {
                true => low = middle,
                false => high = middle,
            }
        }
        Some(0.5 * (low + high))
    }

    /// Length of the part of a girth in front of the side lines (`side` 1) or behind them (-1) (m).
    fn part(&self, girth: Girth, side: f64) -> f64 {
        part_of(&self.hull(girth), side, self.warp.side_of(girth))
    }

    /// Depth of the side lines, between `-limit` and `limit`, for which the part of a girth in front of them
    /// (`side` 1) or behind them (-1) has a length (m).
    pub(crate) fn sides_of(&self, girth: Girth, side: f64, length: f64, limit: f64) -> f64 {
        let hull = self.hull(girth);
        let (mut low, mut high) = (-limit, limit);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let longer = part_of(&hull, side, middle) > length;
            match longer == (side > 0.0) {
                true => low = middle,
                false => high = middle,
            }
        }
        0.5 * (low + high)
    }

    /// Length of the tight line from the side of the neck straight down to the level of the waist, in front
    /// or behind (m).
    fn to_waist(&self, outward: Vec3) -> Option<f64> {
        let (neck, waist) = (self.neck_side(), self.levels.at(Level::Waist));
        let section = self
            .through_neck
            .get_or_init(|| self.upright(TORSO, [neck, Vec3::y()], [waist, neck.y]));
        hanging(section, neck, waist, outward)
    }

    /// A measurement by its name in the catalogue (m) or (rad); `None` if the tape cannot take it.
    pub(crate) fn value(&self, name: &str) -> Option<f64> {
        let known = |row: &&(String, Option<f64>)| row.0 == name;
        if let Some(row) = self.known.borrow().iter().find(known) {
            return row.1;
        }
        let found = self.taken_value(name);
        self.known.borrow_mut().push((name.to_owned(), found));
        found
    }

    fn taken_value(&self, name: &str) -> Option<f64> {
        if let Some(girth) = Girth::ALL.into_iter().find(|girth| girth.name() == name) {
            return Some(self.girth(girth));
        }
        if let Some((_, upper, lower)) = upright().find(|row| row.0 == name) {
            let lower = lower.map_or(0.0, |level| self.height(level));
            return Some(self.height(upper) - lower);
        }
        let part = |girth: Girth, side: f64| self.part(girth, side);
        let wide = |girth: Girth, axis: usize| extent(&self.hull(girth))[axis];
        let (tip, neck) = (self.tip(), self.neck_side());
        let [arm, along] = self.warp.arm_plane(0.0);
        let on_arm = |d: f64| (self.warp.arm_plane(d)[0] - arm).dot(&along);
        let from_tip = (tip - arm).dot(&along);
        Some(match name {
            "shoulder_w" => 2.0 * tip.x,
            "neck_w" => 2.0 * neck.x,
            "shoulder_incl" => (neck.y - tip.y).atan2(tip.x - neck.x),
            "shoulder_length" => (tip - neck).norm(),
            "shoulder_to_shoulder" => self.across_shoulders(),
            "arm_length" => on_arm(self.marks.arm.wrist) - from_tip,
            "shoulder_to_elbow" => on_arm(self.marks.arm.elbow) - from_tip,
            "elbow_to_wrist" => on_arm(self.marks.arm.wrist) - on_arm(self.marks.arm.elbow),
            "arm_pose_angle" => (-along.y).atan2(along.x),
            "front_width" => part(Girth::Bust, 1.0),
            "back_width" => part(Girth::Bust, -1.0),
            "high_bust_front" => part(Girth::HighBust, 1.0),
            "waist_back_width" => part(Girth::Waist, -1.0),
            "hip_back_width" => part(Girth::Hips, -1.0),
            "chest_breadth" => self.between_folds()?,
            "chest_depth" => wide(Girth::Bust, 1),
            "waist_breadth" => wide(Girth::Waist, 0),
            "waist_depth" => wide(Girth::Waist, 1),
            "hip_breadth" => wide(Girth::Hips, 0),
            "hip_depth" => wide(Girth::Hips, 1),
            "head_breadth" => wide(Girth::Head, 0),
            "head_depth" => wide(Girth::Head, 1),
            "bust_points" => 2.0 * self.bust_point()?.x,
            "bum_points" => 2.0 * self.hindmost()?.x,
            "bust_line" => self.bust_line()?,
            "bust_to_underbust" => self.under_bust()?,
            "waist_over_bust_line" => self.bust_line()? + self.below_bust(Level::Waist)?,
            "hps_to_waist_front" => self.to_waist(Vec3::z())?,
            "hps_to_waist_back" => self.to_waist(-Vec3::z())?,
            "outside_leg" => self.outside_leg()?,
            "hip_inclination" => {
                let [hips, low] = self.side_of(Girth::Hips, Level::Hips);
                let [waist, high] = self.side_of(Girth::Waist, Level::Waist);
                FRAC_PI_2 - (high - low).atan2(hips - waist)
            }
            "crotch_length" => self.crotch_lengths()?.length,
            "crotch_length_front" => self.crotch_lengths()?.before(self.warp.crotch_point()),
            _ => return None,
        })
    }

    /// Breadth of the taped section of the bust at the depth of the front folds of the armpits (m): in front
    /// of the muscles that continue into arm and back.
    pub(crate) fn between_folds(&self) -> Option<f64> {
        let fold = self.skinned.at(self.marks.armpit.front_fold);
        breadth_at(&self.hull(Girth::Bust), fold.z)
    }

    /// The rearmost point of the left buttock (m).
    fn hindmost(&self) -> Option<Vec3> {
        let y = self.hip_height();
        self.skinned
            .section(
                &[Part::Trunk, Part::LeftLeg],
                [Vec3::y() * y, Vec3::y()],
                self.around(y),
            )
            .into_iter()
            .flatten()
            .min_by(|a, b| a.z.total_cmp(&b.z).then(b.x.total_cmp(&a.x)))
    }
}
