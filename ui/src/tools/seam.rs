//! Tools that sew: chains of edges, and matched notches.

use super::Reading;
use super::planning::Planning;
use super::refusal::refuse;
use super::slots::{Answer, ChainEdge, Plan, Slot, SlotKind, SlotTool};
use crate::canvas::selection::Item;
use toile_pattern::plan::{self, SewnEdge};
use toile_pattern::{EditError, NotchKind, Pattern};

/// Sews one chain of edges to another, on both sides of the wearer.
pub static SEAM: SlotTool = SlotTool {
    command: "Seam",
    slots: &[
        Slot {
            hint: "Click the edge to sew",
            kind: SlotKind::Chain,
        },
        Slot {
            hint: "Click the edge it is sewn to",
            kind: SlotKind::Chain,
        },
    ],
    plan: |answers, reading| {
        let [Answer::Chain(first), Answer::Chain(second)] = answers else {
            return Err(refuse("nothing was given", "click an edge"));
        };
        sewn([first, second], reading)
    },
};

fn sewn(chains: [&[ChainEdge]; 2], reading: &Reading<'_>) -> Result<Plan, EditError> {
    let pattern = reading.evaluation.pattern();
    let [mut first, mut second] = chains.map(|chain| {
        let edges = chain.iter().map(|(panel, edge)| SewnEdge {
            panel: *panel,
            copy: 0,
            half: 0,
            edge: *edge,
        });
        edges.collect::<Vec<_>>()
    });
    // An edge that is clicked for both sides is sewn to the panel's other copy: a centre back seam.
    if first == second {
        second = twins(pattern, &second).ok_or_else(|| {
            refuse(
                "an edge is not sewn to itself",
                "click another edge, or have the panel cut in mirrored pairs",
            )
        })?;
    }
    // Lower ends must meet lower ends, and the right sides of the cloth must lie together. If a seam as
    // clicked would break that, its second side is moved to the mirrored half or copy.
    let mut trial = Planning::new(reading);
    let seam = trial.run(|evaluation| plan::sew(evaluation, [&first, &second], None))?;
    let sewn = trial.evaluation();
    if plan::is_upside_down(sewn, seam) != plan::turns_over(sewn, seam)
        && let Some(turned) = twins(pattern, &second)
        && turned.iter().all(|edge| !first.contains(edge))
    {
        second = turned;
    }
    let mut planning = Planning::new(reading);
    let mut seams = Vec::new();
    seams.push(planning.run(|evaluation| plan::sew(evaluation, [&first, &second], None))?);
    if let (Some(a), Some(b)) = (twins(pattern, &first), twins(pattern, &second)) {
        // A seam across the middle of the wearer is its own mirror image, and is not sewn twice.
        let is_same = a
            .iter()
            .all(|edge| second.contains(edge) || first.contains(edge));
        if !is_same {
            (first, second) = (a, b);
            seams.push(planning.run(|evaluation| plan::sew(evaluation, [&first, &second], None))?);
        }
    }
    let label = if seams.len() > 1 {
        "Sew both sides"
    } else {
        "Sew"
    };
    let told = told(reading, &planning);
    Ok(Plan {
        told,
        ..planning.done(label, seams.into_iter().map(Item::Seam))
    })
}

/// Message of the first finding on the right and wrong sides of the cloth that the new seams cause.
fn told(reading: &Reading<'_>, planning: &Planning) -> Option<String> {
    let known = reading.evaluation.check_sides();
    let found = planning.evaluation().check_sides();
    let new = found.into_iter().find(|found| !known.contains(found));
    new.map(|found| found.message)
}

/// The chain of edges mirrored to the other side of the wearer; `None` if an edge has no twin there.
fn twins(pattern: &Pattern, chain: &[SewnEdge]) -> Option<Vec<SewnEdge>> {
    let twins = chain.iter().map(|edge| plan::twin(pattern, *edge));
    twins.collect()
}

/// Puts a notch on an edge, and matching notches on the other sides of all seams of that edge.
pub static MATCHED_NOTCH: SlotTool = SlotTool {
    command: "Matched notches",
    slots: &[Slot {
        hint: "Click a sewn edge where notches are to meet",
        kind: SlotKind::OnLine,
    }],
    plan: |answers, reading| {
        let Some(Answer::OnLine(panel, _, at, typed)) = answers.first() else {
            return Err(refuse("nothing was given", "click a sewn edge"));
        };
        // A typed distance gives one place; every side of the seam stores this place as a share of its
        // edge.
        let near = match typed {
            Some(_) => plan::nearest_mark(reading.evaluation, *panel, *at)?,
            None => super::panel::marked(reading, *panel, (*at, &None))?,
        };
        let mut planning = Planning::new(reading);
        let made = planning.run(|evaluation| {
            plan::add_matched_notches(evaluation, (*panel, near), NotchKind::Slit)
        })?;
        let items = made.into_iter().map(|(of, id)| Item::Notch(of, id));
        Ok(planning.done("Add matched notches", items))
    },
};
