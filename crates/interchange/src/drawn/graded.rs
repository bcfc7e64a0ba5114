//! Points of drawn pieces that follow sizes: corners by grade rules, points between two corners in their frame.
//!
//! A corner that moves from size to size gets a grade rule; corners that move alike share one. A point between
//! two corners lies at shares of the way from one to the other and of the same length square to it, by size
//! where the shares differ. So a drag of a corner in the base size, or a changed rule, takes the points between
//! along in all sizes.

use std::collections::{BTreeMap, BTreeSet};
use toile_geometry::Vec2;
use toile_pattern::{
    GradeRule, MAX_GRADE_RULE, Number, PanelBuilder, PointId, PointRule, SizeId, Variable,
};

/// Places of one point in two sizes that differ by less are one (m): as coarse as files round.
const SAME_PLACE: f64 = 1e-6;
/// Shifts that differ by less share a rule (m): twice the rounding of files in inches.
const SAME_SHIFT: f64 = 5e-6;
/// Shortest way between two corners whose frame points between them follow (m).
const MIN_FRAME: f64 = 1e-3;
/// Largest distance of a point from the corners of its frame, over their distance (1).
const MAX_REACH: f64 = 20.0;

/// Places of a point in all sizes (m); one place where there are no sizes.
pub(super) struct SizedPlaces(Vec<Vec2>);

impl SizedPlaces {
    /// The places that `at` gives for the first `sizes` sizes.
    pub fn new(at: &dyn Fn(usize) -> Vec2, sizes: usize) -> Self {
        Self((0..sizes.max(1)).map(at).collect())
    }

    fn moves(&self, base: usize) -> bool {
        let usual = self.0[base];
        self.0.iter().any(|p| (p - usual).norm() > SAME_PLACE)
    }
}

/// Two corners that points between them follow.
pub(super) struct Frame {
    ends: [PointId; 2],
    /// Places of the corners in all sizes (m).
    places: [Vec<Vec2>; 2],
    /// Whether the corners lie far enough apart in all sizes.
    is_wide: bool,
}

/// The grade rules of a pattern while it is built.
pub(super) struct Rules {
    /// The variables of all rules so far.
    pub variables: Vec<Variable>,
    sizes: Vec<SizeId>,
    base: usize,
    /// The rules by their shifts, in steps of [`SAME_SHIFT`].
    known: BTreeMap<Vec<[i64; 2]>, GradeRule>,
    /// Numbers that the file gives to shifts.
    numbers: BTreeMap<Vec<[i64; 2]>, u32>,
    /// Numbers that are taken.
    taken: BTreeSet<u32>,
    /// The smallest number that may be free.
    next: u32,
}

fn key(shifts: &[Vec2]) -> Vec<[i64; 2]> {
    let steps = |value: f64| (value / SAME_SHIFT).round() as i64;
    shifts.iter().map(|by| [steps(by.x), steps(by.y)]).collect()
}

impl Rules {
    /// No rules yet; `numbered` are the rules that the file numbers.
    pub fn new(sizes: &[SizeId], base: usize, numbered: &[(u32, Vec<Vec2>)]) -> Self {
        let mut numbers = BTreeMap::new();
        let is_number = |number: &u32| (1..=MAX_GRADE_RULE).contains(number);
        let numbered = numbered.iter().filter(|(number, _)| is_number(number));
        for (number, shifts) in numbered.clone() {
            numbers.entry(key(shifts)).or_insert(*number);
        }
        Self {
            variables: Vec::new(),
            sizes: sizes.to_vec(),
            base,
            known: BTreeMap::new(),
            taken: numbered.map(|(number, _)| *number).collect(),
            next: 1,
            numbers,
        }
    }

    /// The rule of a corner at places in all sizes.
    pub fn corner(&mut self, drawing: &mut PanelBuilder<'_>, places: &SizedPlaces) -> PointRule {
        let usual = places.0[self.base];
        if self.sizes.len() < 2 || !places.moves(self.base) {
            return PointRule::at(usual.x, usual.y);
        }
        let shifts: Vec<Vec2> = places.0.iter().map(|p| p - usual).collect();
        let key = key(&shifts);
        if let Some(rule) = self.known.get(&key) {
            return rule.point([false; 2], usual);
        }
        let number = match self.numbers.get(&key) {
            Some(&number) => number,
            None => {
                while self.taken.contains(&self.next) {
                    self.next += 1;
                }
                self.next
            }
        };
        self.taken.insert(number);
        let by_size: Vec<(SizeId, Vec2)> = self.sizes.iter().copied().zip(shifts).collect();
        let ids = [drawing.id(), drawing.id()];
        let (rule, variables) = GradeRule::made(ids, number, &by_size);
        self.variables.extend(variables);
        self.known.insert(key, rule);
        rule.point([false; 2], usual)
    }

    /// The frame of two corners at places in all sizes.
    pub fn frame(&self, ends: [PointId; 2], places: &[SizedPlaces; 2]) -> Frame {
        let [from, to] = places;
        let mut ways = from.0.iter().zip(&to.0);
        Frame {
            is_wide: ends[0] != ends[1] && ways.all(|(a, b)| (b - a).norm() >= MIN_FRAME),
            ends,
            places: [from.0.clone(), to.0.clone()],
        }
    }

    /// The rule of a point between two corners.
    pub fn between(&self, frame: &Frame, places: &SizedPlaces) -> PointRule {
        let usual = places.0[self.base.min(places.0.len() - 1)];
        if self.sizes.len() < 2 {
            return PointRule::at(usual.x, usual.y);
        }
        let [from, to] = &frame.places;
        let reach = |size: usize| {
            let way = (to[size] - from[size]).norm();
            (places.0[size] - from[size]).norm() / way
        };
        let sizes = 0..places.0.len();
        if !frame.is_wide || sizes.clone().any(|size| reach(size) > MAX_REACH) {
            let off = |axis: usize| {
                self.number(SAME_PLACE, |size| places.0[size][axis] - from[size][axis])
            };
            return PointRule::Offset {
                base: frame.ends[0],
                x: off(0),
                y: off(1),
            };
        }
        let shares = sizes.map(|size| {
            let way = to[size] - from[size];
            let out = places.0[size] - from[size];
            Vec2::new(out.dot(&way), way.perp(&out)) / way.norm_squared()
        });
        let shares: Vec<Vec2> = shares.collect();
        let longest = from.iter().zip(to).map(|(a, b)| (b - a).norm());
        let same = SAME_PLACE / longest.fold(MIN_FRAME, f64::max);
        PointRule::Between {
            base: frame.ends[0],
            tip: frame.ends[1],
            along: self.number(same, |size| shares[size].x),
            aside: self.number(same, |size| shares[size].y),
        }
    }

    /// A number with its values in all sizes; values that differ by less than `same` from that of the base size
    /// are left out.
    pub fn number(&self, same: f64, values: impl Fn(usize) -> f64) -> Number {
        let usual = values(self.base);
        let others = self.sizes.iter().enumerate();
        let others = others.filter(|&(k, _)| k != self.base);
        let differing: Vec<(SizeId, f64)> = others
            .map(|(k, &size)| (size, values(k)))
            .filter(|(_, value)| (value - usual).abs() > same)
            .collect();
        match differing.is_empty() {
            true => usual.into(),
            false => Number::PerSize {
                usual: Box::new(usual.into()),
                sizes: differing,
            },
        }
    }
}
