//! Counts over saved frames of cloth on a moving solid: crossings with solids and with itself, and stretch.

use serde::{Deserialize, Serialize};
use toile_drape::{Measures, SceneRun, Workspace, measure};

/// Counts over the saved frames of a run, all exact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FrameCounts {
    /// Number of frames counted.
    frames: usize,
    /// Frames in which a triangle of cloth crosses one of a solid, the most such pairs in one frame, and the
    /// time of that frame (s). Pairs where the solid goes through itself are counted apart.
    crossing_solids: usize,
    most_solid_pairs: usize,
    most_solid_pairs_at: Option<f64>,
    /// Largest number of crossing pairs in one frame whose triangle of the solid lies inside another part of
    /// the solid, and the largest area of such triangles over the area of the solids (1).
    most_buried_pairs: usize,
    buried_share: f64,
    /// Frames in which cloth crosses cloth, and the most pairs in one frame.
    crossing_cloth: usize,
    most_cloth_pairs: usize,
    /// Largest stretch of warp and of weft that a hundredth of the cloth exceeds in a frame.
    stretch_p99: [f64; 2],
}

impl FrameCounts {
    /// Number of frames counted so far.
    pub fn frames(&self) -> usize {
        self.frames
    }

    /// Counts a frame; `counted` marks the triangles whose stretch counts. `counted` is ignored once merging
    /// has removed triangles.
    pub fn add(&mut self, run: &SceneRun, counted: &[bool]) {
        let counted = match counted.len() == run.system.topology.triangles.len() {
            true => counted,
            false => &[],
        };
        let Measures {
            body_intersections,
            buried_intersections,
            buried_share,
            self_intersections,
            strain_p99,
            ..
        } = measure(&run.system, &run.state, &mut Workspace::default(), counted);
        self.frames += 1;
        let open = body_intersections - buried_intersections;
        self.crossing_solids += usize::from(open > 0);
        if open > self.most_solid_pairs {
            (self.most_solid_pairs, self.most_solid_pairs_at) = (open, Some(run.state.time));
        }
        self.most_buried_pairs = self.most_buried_pairs.max(buried_intersections);
        self.buried_share = self.buried_share.max(buried_share);
        self.crossing_cloth += usize::from(self_intersections > 0);
        self.most_cloth_pairs = self.most_cloth_pairs.max(self_intersections);
        for (most, now) in self.stretch_p99.iter_mut().zip(strain_p99) {
            *most = most.max(now);
        }
    }
}
