//! Tools that alter panels: darts pivoted, panels spread, pleated and split.

use super::planning::{Planning, panel_under};
use super::refusal::refuse;
use super::slots::{Answer, Plan, Slot, SlotKind, SlotTool};
use super::{Reading, along};
use crate::canvas::selection::Item;
use toile_geometry::Vec2;
use toile_pattern::plan::{
    self, FinishedEdge, Joined, PivotWish, PleatWish, SplitWish, SpreadWish,
};
use toile_pattern::{
    Bridge, CurveId, EdgeId, EditError, Evaluation, Formula, Mark, Name, Number, PanelId,
    PleatKind, Side, Want,
};

/// Distance from the pivot point at which both darts end, if only a share of a dart is moved (m): about the
/// usual distance between a dart's point and the bust point.
const SET_BACK: f64 = 0.02;

/// Moves a dart, or a share of it, to another place of the outline.
pub static PIVOT: SlotTool = SlotTool {
    command: "Pivot dart",
    slots: &[
        Slot {
            hint: "Click the dart to move",
            kind: SlotKind::Operation,
        },
        Slot {
            hint: "Click the outline where it goes to",
            kind: SlotKind::OnLine,
        },
        Slot {
            hint: "Type what part of it is moved: 1 for all, 0.5 for half",
            kind: SlotKind::Number {
                label: "part",
                want: Want::Plain,
                usual: 1.0,
                live: None,
            },
        },
    ],
    plan: |answers, reading| {
        let [
            Answer::Operation(panel, dart),
            Answer::OnLine(on, _, at, mark),
            Answer::Number(share),
        ] = answers
        else {
            return Err(refuse("nothing was given", "click a dart"));
        };
        if on != panel {
            return Err(refuse(
                "the new place is on another panel",
                "click the outline of the dart's own panel",
            ));
        }
        let near = super::panel::marked(reading, *panel, (*at, mark))?;
        // The points of the two darts must not meet. The user can change their distance from the pivot point:
        // it is a number of the operation.
        let moved = reading.evaluation.number(share, Want::Plain);
        let back = match moved.is_some_and(|moved| moved < 1.0) {
            true => SET_BACK,
            false => 0.0,
        };
        let mut planning = Planning::new(reading);
        let wish = PivotWish {
            dart: *dart,
            mouth: (Name::Drawn(near.line), near.mark),
            share: share.clone(),
            back: Number::Value(back),
            turned: None,
        };
        let id = planning.run(|evaluation| plan::pivot_dart(evaluation, *panel, wish))?;
        Ok(planning.done("Pivot dart", [Item::Operation(*panel, id)]))
    },
};

/// Cuts a panel from edge to edge and spreads the parts.
pub static SPREAD: SlotTool = SlotTool {
    command: "Spread",
    slots: &[
        Slot {
            hint: "Click the edge that opens",
            kind: SlotKind::Edge,
        },
        Slot {
            hint: "Click the edge the cuts go to",
            kind: SlotKind::Edge,
        },
        Slot {
            hint: "Type how many cuts",
            kind: SlotKind::Number {
                label: "cuts",
                want: Want::Plain,
                usual: 3.0,
                live: None,
            },
        },
        Slot {
            hint: "Type how far each opens",
            kind: SlotKind::Number {
                label: "opening",
                want: Want::Length,
                usual: 0.03,
                live: None,
            },
        },
        Slot {
            hint: "Type how far each opens at the other edge; 0 is a hinge",
            kind: SlotKind::Number {
                label: "at the other edge",
                want: Want::Length,
                usual: 0.0,
                live: None,
            },
        },
    ],
    plan: |answers, reading| {
        let [
            Answer::Edge(panel, from, _),
            Answer::Edge(on, to, _),
            Answer::Number(count),
            Answer::Number(near),
            Answer::Number(far),
        ] = answers
        else {
            return Err(refuse("nothing was given", "click the edge that opens"));
        };
        if on != panel {
            return Err(refuse(
                "the edges are of two panels",
                "click another edge of the same panel",
            ));
        }
        let count = reading.evaluation.number(count, Want::Plain);
        let count = count.filter(|count| (1.0..=100.0).contains(count) && count.fract() == 0.0);
        let count =
            count.ok_or_else(|| refuse("a panel has 1 to 100 cuts", "type a whole number"))?;
        let mut planning = Planning::new(reading);
        let id = planning.run(|evaluation| {
            let count = count.round() as u16;
            let (line, cuts) = plan::even_cuts(evaluation, *panel, [*from, *to], count)?;
            let openings = || [near.clone(), far.clone()];
            let wish = SpreadWish {
                line,
                cuts: cuts.into_iter().map(|ends| (ends, openings())).collect(),
                held: None,
                bridge: Bridge::default(),
            };
            plan::spread_panel(evaluation, *panel, wish)
        })?;
        Ok(planning.done("Spread panel", [Item::Operation(*panel, id)]))
    },
};

/// Folds pleats that are pressed to one side.
pub static KNIFE_PLEAT: SlotTool = SlotTool {
    command: "Knife pleat",
    slots: PLEAT_SLOTS,
    plan: |answers, reading| pleat(answers, reading, PleatKind::Knife),
};

/// Folds pleats that stand as boxes on the right side.
pub static BOX_PLEAT: SlotTool = SlotTool {
    command: "Box pleat",
    slots: PLEAT_SLOTS,
    plan: |answers, reading| pleat(answers, reading, PleatKind::Box),
};

/// Folds pleats whose folds meet on the right side (inverted pleats).
pub static INVERTED_PLEAT: SlotTool = SlotTool {
    command: "Inverted pleat",
    slots: PLEAT_SLOTS,
    plan: |answers, reading| pleat(answers, reading, PleatKind::Inverted),
};

const PLEAT_SLOTS: &[Slot] = &[
    Slot {
        hint: "Click the edge the pleats start at",
        kind: SlotKind::Edge,
    },
    Slot {
        hint: "Click the edge they go to; arrows then show which way they are pressed",
        kind: SlotKind::Edge,
    },
    Slot {
        hint: "Type how deep a fold goes under",
        kind: SlotKind::Number {
            label: "depth",
            want: Want::Length,
            usual: 0.03,
            live: None,
        },
    },
    Slot {
        hint: "Type how many pleats; or where each lies along the first edge as it is finished, from its end nearer to the click: 4 8 12.5",
        kind: SlotKind::Numbers {
            label: "pleats",
            usual: 1.0,
        },
    },
    Slot {
        hint: "Type where the first lies along the first edge as it is finished, from its end nearer to the click; Enter spreads them evenly",
        kind: SlotKind::Number {
            label: "first at",
            want: Want::Length,
            usual: 0.0,
            live: None,
        },
    },
    Slot {
        hint: "Type how far it is from each to the next; Enter spreads them evenly from the first on",
        kind: SlotKind::Number {
            label: "spacing",
            want: Want::Length,
            usual: 0.0,
            live: None,
        },
    },
];

fn pleat(answers: &[Answer], reading: &Reading<'_>, kind: PleatKind) -> Result<Plan, EditError> {
    let [
        Answer::Edge(panel, from, clicked),
        Answer::Edge(on, to, _),
        Answer::Number(depth),
        places @ ..,
    ] = answers
    else {
        return Err(refuse("nothing was given", "click an edge"));
    };
    if on != panel {
        return Err(refuse(
            "the edges are of two panels",
            "click another edge of the same panel",
        ));
    }
    let mut planning = Planning::new(reading);
    let id = planning.run(|evaluation| {
        let edges = (*panel, [*from, *to]);
        let near = plan::finished_edge(evaluation, *panel, *from)?;
        let end = along::end_near(&near, *clicked);
        let (line, lines) = match places {
            [Answer::Numbers(places)] => {
                let (line, _) = plan::even_cuts(evaluation, *panel, edges.1, 1)?;
                (line, cuts_at(evaluation, (edges, &near, end), places)?)
            }
            [
                Answer::Number(count),
                Answer::Number(first),
                Answer::Number(spacing),
            ] => {
                let count = how_many(evaluation, count)?;
                let (line, even) = plan::even_cuts(evaluation, *panel, edges.1, count)?;
                let [at, apart] = [first, spacing].map(|n| evaluation.number(n, Want::Length));
                match (at, apart) {
                    (Some(0.0), Some(0.0)) => (line, even),
                    _ => {
                        let places = spaced(evaluation, &near, (count, first, spacing))?;
                        (line, cuts_at(evaluation, (edges, &near, end), &places)?)
                    }
                }
            }
            _ => return Err(refuse("nothing was given", "type how many pleats")),
        };
        let wish = PleatWish {
            line,
            lines,
            depth: depth.clone(),
            kind,
            pressed: Side::Left,
            held: None,
        };
        plan::pleat_panel(evaluation, *panel, wish)
    })?;
    let mut plan = planning.done("Pleat panel", [Item::Operation(*panel, id)]);
    plan.told = counted_words(reading.evaluation, (*panel, *from), *clicked);
    Ok(plan)
}

/// Note to the user that names the end of an edge from which the places are measured: the end nearer to the
/// click.
fn counted_words(
    evaluation: &Evaluation,
    (panel, edge): (PanelId, EdgeId),
    clicked: Vec2,
) -> Option<String> {
    let finished = plan::finished_edge(evaluation, panel, edge).ok()?;
    let end = along::end_near(&finished, clicked);
    let words = along::end_words(evaluation, (&finished, edge), end)?;
    let name = evaluation.pattern().edge_name(panel, Name::Drawn(edge))?;
    Some(format!("Places along {name} count from {words}"))
}

/// Checks and rounds the number of pleats.
fn how_many(evaluation: &Evaluation, count: &Number) -> Result<u16, EditError> {
    let count = evaluation.number(count, Want::Plain);
    let count = count.filter(|count| (1.0..=60.0).contains(count) && count.fract() == 0.0);
    let count = count.map(|count| count.round() as u16);
    count.ok_or_else(|| {
        refuse(
            "a panel has 1 to 60 pleats",
            "type a whole number, or a place for each with spaces between: 4 8 12.5",
        )
    })
}

/// Places along a finished edge of a panel: `count` places, the first at `first`, the others at a spacing; if
/// the spacing is zero, evenly spaced, the last one spacing before the end of the edge.
fn spaced(
    evaluation: &Evaluation,
    near: &FinishedEdge,
    (count, first, spacing): (u16, &Number, &Number),
) -> Result<Vec<Number>, EditError> {
    let start = length_of(evaluation, first)?;
    let step = match length_of(evaluation, spacing)? {
        0.0 => (near.length - start) / f64::from(count),
        step => step,
    };
    let place = |k: u16| -> Result<Number, EditError> {
        let by = f64::from(k) * step;
        Ok(match (first.as_formula(), spacing.as_formula()) {
            _ if k == 0 => first.clone(),
            (_, Some(_)) => {
                let names = evaluation.names();
                let text = |number: &Number, value: f64| match number.as_formula() {
                    Some(formula) => formula.text(names),
                    None => format!("{value}m"),
                };
                let sum = format!("({}) + {k} * ({})", text(first, start), text(spacing, step));
                let read = Formula::parse(&sum, names);
                Number::Formula(read.map_err(|error| refuse(&error.to_string(), "type a length"))?)
            }
            (Some(formula), None) => Number::Adjusted {
                formula: formula.clone(),
                by,
            },
            (None, None) => Number::Value(start + by),
        })
    };
    (0..count).map(place).collect()
}

fn length_of(evaluation: &Evaluation, number: &Number) -> Result<f64, EditError> {
    let value = evaluation.number(number, Want::Length);
    value.ok_or_else(|| refuse("the distance has no value", "type a length"))
}

/// Cut lines that begin at places along one finished edge of a panel, measured from one of the edge's ends.
/// Each ends on the other edge that was clicked, at the same share of that edge's length.
fn cuts_at(
    evaluation: &Evaluation,
    ((panel, [_, to]), near, end): ((PanelId, [EdgeId; 2]), &FinishedEdge, usize),
    places: &[Number],
) -> Result<Vec<[Mark; 2]>, EditError> {
    let far = plan::finished_edge(evaluation, panel, to)?;
    // The ratio is rounded, so that the formula stays readable: edges of equal length differ by rounding
    // errors.
    let ratio = (far.length / near.length * 1e10).round() / 1e10;
    let cut = |place: &Number| {
        let across = along::scaled(evaluation, place, ratio)?;
        // On a closed outline two opposite edges run in opposite directions.
        Ok([
            along::mark_from(evaluation, near, (end, place))?,
            along::mark_from(evaluation, &far, (1 - end, &across))?,
        ])
    };
    places.iter().map(cut).collect()
}

/// Cuts a panel in two along a straight line.
pub static SPLIT: SlotTool = SlotTool {
    command: "Split",
    slots: &[
        Slot {
            hint: "Click the outline where the cut starts",
            kind: SlotKind::OnLine,
        },
        Slot {
            hint: "Click the outline where it ends",
            kind: SlotKind::OnLine,
        },
    ],
    plan: |answers, reading| {
        let [
            Answer::OnLine(panel, _, from, first),
            Answer::OnLine(on, _, to, second),
        ] = answers
        else {
            return Err(refuse("nothing was given", "click the outline"));
        };
        if on != panel {
            return Err(refuse(
                "the places are on two panels",
                "click the outline of the same panel",
            ));
        }
        let mut planning = Planning::new(reading);
        let ends = [(*from, first), (*to, second)];
        let [from, to] = ends.map(|end| super::panel::marked(reading, *panel, end));
        let places = [from?, to?];
        let curve = planning.run(|evaluation| plan::line_across(evaluation, *panel, places))?;
        split(planning, *panel, curve)
    },
};

/// Cuts a panel in two along a curve that is drawn across it.
pub static SPLIT_ALONG: SlotTool = SlotTool {
    command: "Split along",
    slots: &[Slot {
        hint: "Click the curve to cut along, where it lies on the panel",
        kind: SlotKind::Curve,
    }],
    plan: |answers, reading| {
        let Some(Answer::Curve(sheet, curve, at)) = answers.first() else {
            return Err(refuse("nothing was given", "click a curve"));
        };
        let panel = panel_under(reading, (*sheet, *at))?;
        split(Planning::new(reading), panel, *curve)
    },
};

fn split(mut planning: Planning, panel: PanelId, curve: CurveId) -> Result<Plan, EditError> {
    let line = plan::outline_of(planning.evaluation(), panel)?;
    let wish = SplitWish {
        line,
        curve,
        joined: Joined::default(),
    };
    let made = planning.run(|evaluation| plan::split_panel(evaluation, panel, wish))?;
    Ok(planning.done("Split panel", made.sides.map(Item::Panel)))
}
