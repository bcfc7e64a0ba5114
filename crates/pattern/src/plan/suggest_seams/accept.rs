//! Sews suggested seams.

use super::sewn::sewn_edges;
use crate::plan::impossible;
use crate::plan::lookup::after;
use crate::plan::seam::{SewnEdge, sew};
use crate::{Edit, EditError, Entity, Evaluation, PartId, SEAM_TOLERANCE, SeamId};
use std::sync::Arc;

/// A seam with sides that differ in length by more than this ratio is gathered (1).
const GATHER_RATIO: f64 = 1.05;
/// Eases are rounded up to whole multiples of this (m).
const EASE_STEP: f64 = 1e-3;

/// Plans to sew pairs of edges, a seam for each; returns the seams too. A difference in length becomes ease,
/// a difference of more than 5 % is gathered.
///
/// # Errors
/// An edge is missing, or would be in a second seam.
pub fn accept_seams(
    evaluation: &Evaluation,
    pairs: &[[SewnEdge; 2]],
) -> Result<(Vec<Edit>, Vec<SeamId>), EditError> {
    let mut work = evaluation.clone();
    let mut taken = sewn_edges(evaluation);
    let (mut edits, mut seams) = (Vec::new(), Vec::new());
    for pair in pairs {
        for edge in pair {
            if taken.contains(edge) {
                return Err(impossible(
                    format!("{} would be in a second seam", described(evaluation, *edge)),
                    "accept one of the suggestions for it, or remove the seam that it is in",
                ));
            }
        }
        taken.extend(pair);
        let [one, two] = pair;
        let (mut own, id) = sew(&work, [&[*one], &[*two]], None)?;
        work = after(&work, &own)?;
        if let Some(value) = work.seam_value(id) {
            let [longer, shorter] =
                [f64::max, f64::min].map(|of| of(value.lengths[0], value.lengths[1]));
            for edit in &mut own {
                if let Edit::Put(Entity::Seam(seam)) = edit
                    && longer - shorter > SEAM_TOLERANCE
                {
                    let seam = Arc::make_mut(seam);
                    seam.gathered = longer > GATHER_RATIO * shorter;
                    seam.ease = (((longer - shorter) / EASE_STEP).ceil() * EASE_STEP).into();
                }
            }
        }
        work = after(&work, &own)?;
        edits.extend(own);
        seams.push(id);
    }
    Ok((edits, seams))
}

/// An edge in words: its name and its panel.
fn described(evaluation: &Evaluation, edge: SewnEdge) -> String {
    let pattern = evaluation.pattern();
    let owner = pattern.owner_of(edge.panel, PartId::Edge(edge.edge));
    let name = owner
        .and_then(|owner| owner.edge(edge.edge))
        .map_or("", |edge| &edge.name);
    let panel = pattern.panel(edge.panel).map_or("", |panel| &panel.name);
    format!("edge {name:?} of panel {panel:?}")
}
