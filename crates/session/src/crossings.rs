//! Counts crossings of cloth with cloth, and phrases the warning about them.

use toile_drape::SceneRun;
use toile_drape::collision::Tally;

/// Number of pairs of cloth triangles that intersect and share no vertex, counted exactly before, during and
/// after a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub(crate) struct Crossings {
    /// Pairs that intersect before the first step.
    start: usize,
    /// Largest number of pairs at one count.
    most: usize,
    /// Pairs that intersect after the last step.
    end: usize,
    /// Number of steps between two counts.
    #[serde(skip)]
    every: usize,
}

/// Number of counts in a run of known length. They are few, as an exact count can take as long as a step.
const COUNTS: f64 = 32.0;
/// Number of steps between two counts in a run that solves for rest.
const STEPS_TO_REST: usize = 8;

impl Crossings {
    /// Counts before the first step.
    pub fn new(run: &SceneRun) -> Self {
        let count = run.crossings();
        Self::resumed(run, [count; 3])
    }

    /// Resumes the counts of a saved run: before the first step, the most at one count, and at the last
    /// count.
    pub fn resumed(run: &SceneRun, [start, most, end]: [usize; 3]) -> Self {
        let settings = run.settings();
        let steps = (settings.whole() / settings.step / COUNTS).ceil().max(1.0);
        Self {
            start,
            most,
            end,
            every: match settings.method.kind.is_equilibrium() {
                true => STEPS_TO_REST,
                false => steps as usize,
            },
        }
    }

    /// Crossings before the first step, the most at one count, and at the last count.
    pub fn counts(&self) -> [usize; 3] {
        [self.start, self.most, self.end]
    }

    /// Counts after a step if a count is due, and after the last step.
    pub fn follow(&mut self, run: &SceneRun) {
        if run.finished() || run.steps().is_multiple_of(self.every) {
            self.end = run.crossings();
            self.most = self.most.max(self.end);
        }
    }

    /// Warning about a run that ends tangled, with a remedy; `None` if no cloth crosses.
    pub fn warning(&self, cloth_offset: f64) -> Option<String> {
        if self.end == 0 {
            return None;
        }
        let remedy = match (cloth_offset > 0.0, self.start) {
            (false, _) => {
                "cloth passes through cloth here: give collision.cloth_offset a distance, as in 0.002, and lay the cloths so that none crosses at the start"
            }
            (true, 0) => {
                "cloth went through cloth on the way: take a shorter step, a finer mesh or a larger collision.cloth_offset"
            }
            (true, _) => "lay the cloths so that none crosses at the start",
        };
        Some(format!(
            "it ends tangled: {} pairs of cloth triangles cross each other, {} at the start, {} at most; {remedy}",
            self.end, self.start, self.most
        ))
    }
}

/// Crossings of edges of cloth with faces of cloth, as the detections of a run's contact counted them.
#[derive(Clone, Copy, Debug, serde::Serialize)]
pub(crate) struct Tangles {
    /// Crossings at the first detection.
    found: usize,
    /// Largest number of crossings at one detection.
    most: usize,
    /// Crossings at the last detection.
    left: usize,
    /// Vertices of outer layers that lie inside inner layers: at the first detection, the most at one
    /// detection, at the last detection.
    astray: [usize; 3],
}

impl Tangles {
    pub(crate) fn of(tally: &Tally) -> Self {
        let [found, most, left] = tally.crossings;
        Self {
            found,
            most,
            left,
            astray: tally.astray,
        }
    }
}
