//! What the chart of speed against accuracy is to run.

/// The runs of a chart: steps, methods and scenes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChartPlan {
    /// Steps (s) of methods in time.
    pub steps: &'static [f64],
    /// Steps (s) of the runs with contact of cloth with cloth.
    pub contact_steps: &'static [f64],
    /// Net forces over weight asked of methods of rest.
    pub residuals: &'static [f64],
    /// Resolutions of each scene at the most.
    pub resolutions: usize,
    /// Processor time after which a run is given up (s); another program's load does not use it.
    pub budget: f64,
    /// Times each run is made; the fastest counts.
    pub repeats: usize,
}

impl ChartPlan {
    /// All steps and resolutions, three seconds a run at the most.
    pub const FULL: Self = Self {
        steps: &[
            1.0 / 30.0,
            1.0 / 60.0,
            1.0 / 120.0,
            1.0 / 240.0,
            1.0 / 480.0,
            1.0 / 960.0,
        ],
        contact_steps: &[1.0 / 60.0, 1.0 / 120.0, 1.0 / 240.0],
        residuals: &[1e-1, 1e-2, 1e-3, 1e-4],
        resolutions: 2,
        budget: 3.0,
        repeats: 1,
    };
    /// Two steps on the coarse meshes: under a minute on two cores.
    pub const QUICK: Self = Self {
        steps: &[1.0 / 60.0, 1.0 / 240.0],
        contact_steps: &[1.0 / 60.0],
        residuals: &[1e-2],
        resolutions: 1,
        budget: 0.4,
        repeats: 1,
    };
}
