//! Finds the pieces and seams that keep a garment from coming to rest.

use crate::GarmentJob;
use std::collections::BTreeMap;
use toile_drape::{Aspect, Finding, GarmentRun};

/// Finding on a garment that was given up because its net force stayed far above its weight: the pieces and
/// seams that bear most of that force.
pub(crate) fn stuck(job: &GarmentJob, run: &mut GarmentRun) -> Option<Finding> {
    /// Least share of the sum of squared forces from which a piece or seam is named (1).
    const WORTH: f64 = 0.15;
    let forces = run.forces_of_stuck()?;
    let force = |v: usize| forces[run.target()[v] as usize].powi(2);
    let whole: f64 = forces.iter().map(|f| f * f).sum();
    let pieces = job.garment.panels.iter().zip(job.panels.iter());
    let pieces = pieces.map(|(panel, named)| {
        let share = panel.vertices.clone().map(force).sum::<f64>();
        (share, format!("piece \"{}\"", named.name))
    });
    let mut seams: BTreeMap<usize, f64> = BTreeMap::new();
    for stitch in &job.garment.stitches {
        *seams.entry(stitch.draft_seam).or_default() += force(stitch.vertices[0] as usize);
    }
    let names = job.origin.seam_names();
    let seams = seams
        .into_iter()
        .filter_map(|(seam, share)| Some((share, format!("seam \"{}\"", names.get(seam)?))));
    let mut named: Vec<(f64, String)> = pieces.chain(seams).collect();
    named.retain(|(share, _)| *share >= WORTH * whole);
    named.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    named.truncate(4);
    let names: Vec<String> = named.into_iter().map(|(_, name)| name).collect();
    let words = format!(
        "it was given up: its net force stayed above 100 times its weight without falling by half. Most of it is in {}: see there for panels placed through each other, seams sewn to the wrong edge, or cloth caught in itself",
        names.join(", ")
    );
    Some(Finding::bad(Aspect::Rest, words))
}
