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
    // An edge that is sewn to itself is sewn to the other copy: a centre back seam.
    if first == second {
        second = twins(pattern, &second).ok_or_else(|| {
            refuse(
                "an edge is not sewn to itself",
                "click another edge, or have the panel cut in mirrored pairs",
            )
        })?;
    }
    // Hems must meet hems, and right sides lie together: if both panels are drawn with the seam on the
    // same side, the mirrored half or copy of the second lies against the first.
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
        // A seam across the middle is its own mirror image.
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

/// First new finding on the sides of the cloth that the seams cause, in words.
fn told(reading: &Reading<'_>, planning: &Planning) -> Option<String> {
    let known = reading.evaluation.check_sides();
    let found = planning.evaluation().check_sides();
    let new = found.into_iter().find(|found| !known.contains(found));
    new.map(|found| found.message)
}

/// The chain mirrored to the other side of the wearer, if all of its edges have a twin.
fn twins(pattern: &Pattern, chain: &[SewnEdge]) -> Option<Vec<SewnEdge>> {
    let twins = chain.iter().map(|edge| plan::twin(pattern, *edge));
    twins.collect()
}

/// Puts a notch on an edge, and its match on every seam there.
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
        // A typed distance gives one place, which every side stores as a share.
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
