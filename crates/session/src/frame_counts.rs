//! Counts over saved frames of cloth on a moving solid: crossings with solids and with itself, and stretch.

use serde::{Deserialize, Serialize};
use toile_drape::{Measures, SceneRun, Workspace, measure};

/// Counts over the saved frames of a run, all exact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FrameCounts {
    /// Number of frames counted.
    frames: usize,
    /// Number of frames in which a triangle of cloth crosses a triangle of a solid. Pairs where the solid
    /// goes through itself (`most_buried_pairs`) do not count.
    crossing_solids: usize,
    /// Largest number of such pairs in one frame.
    most_solid_pairs: usize,
    /// Time of that frame (s). `None`: no frame has such a pair.
    most_solid_pairs_at: Option<f64>,
    /// Largest number of crossing pairs in one frame whose triangle of the solid lies inside another part of
    /// the solid.
    most_buried_pairs: usize,
    /// Largest area of such triangles in one frame, over the area of the solids (1).
    buried_share: f64,
    /// Number of frames in which cloth crosses cloth.
    crossing_cloth: usize,
    /// Largest number of pairs of cloth triangles that cross in one frame.
    most_cloth_pairs: usize,
    /// Stretch of warp and of weft that a hundredth of the cloth exceeds in a frame (1): the largest of all
    /// frames.
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
