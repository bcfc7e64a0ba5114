//! Pivots darts, and spreads and pleats panels: chooses the settings that a request leaves open.

use super::impossible;
use super::lookup;
use super::on_stage::{edge_ends, mark_value};
use super::operations::add_operation;
use crate::stage::{MarkValue, is_sewn};
use crate::{
    Bridge, EdgeId, Edit, EditError, Evaluation, LineName, Mark, Name, Number, OperationId,
    OperationKind, Panel, PanelId, PleatKind, PleatLine, Pressed, Role, Side, SpreadCut, Turned,
};

/// Request to pivot a dart, that is to move some of its intake to a new dart.
#[derive(Clone, Debug, PartialEq)]
pub struct PivotWish {
    /// The operation that made the dart: a dart or a pivot of the panel.
    pub dart: OperationId,
    /// The line and the position on it where the new mouth opens.
    pub mouth: (LineName, Mark),
    /// Share of the dart's angle that is moved to the new dart, from 0 to 1.
    pub share: Number,
    /// Distance from the pivot point at which both darts end after the pivot (m).
    pub back: Number,
    /// The part of the panel that is turned. `None`: the part that does not contain the fold, or the shorter
    /// part if the panel has no fold.
    pub turned: Option<Turned>,
}

/// Plans to pivot a dart; returns the operation too. The new dart is pressed in the default direction.
///
/// # Errors
/// The panel is missing or cannot be drawn; the dart cannot be pivoted like this (the message gives the
/// reason).
pub fn pivot_dart(
    evaluation: &Evaluation,
    panel: PanelId,
    wish: PivotWish,
) -> Result<(Vec<Edit>, OperationId), EditError> {
    let owner = lookup::panel(evaluation.pattern(), panel)?;
    let (line, mouth) = wish.mouth;
    let turned = match wish.turned {
        Some(turned) => turned,
        None => freer_part(evaluation, owner, (wish.dart, line, &mouth)).unwrap_or_default(),
    };
    let kind = OperationKind::Pivot {
        dart: wish.dart,
        line,
        mouth,
        share: wish.share,
        back: wish.back,
        turned,
        pressed: Pressed::default(),
    };
    add_operation(evaluation, panel, kind)
}

/// The part of a panel that does not contain its fold, or the shorter part if it has no fold. `None`: the
/// parts cannot be found.
fn freer_part(
    evaluation: &Evaluation,
    panel: &Panel,
    (dart, line, mouth): (OperationId, LineName, &Mark),
) -> Option<Turned> {
    let pattern = evaluation.pattern();
    let lineage = pattern.stage_lineage(panel);
    let operations = &panel.operations;
    let folds = operations.iter().enumerate().filter_map(|(k, operation)| {
        let OperationKind::Fold { ends, .. } = &operation.kind else {
            return None;
        };
        Some((k, &ends[0]))
    });
    let fold = folds.clone().next();
    let before = fold.map_or(operations.len(), |fold| fold.0);
    let stage_at = |step: usize| {
        let after = step.checked_sub(1).map(|k| operations[k].id);
        evaluation.stage(panel.id, after)
    };
    let stage = stage_at(before)?;
    let corner = |index: u16| {
        let role = Role::Mouth;
        MarkValue::Corner(Name::Made {
            by: dart,
            role,
            index,
        })
    };
    let placed = |mark: &Mark| {
        let value = mark_value(evaluation, panel, mark)?;
        let step = pattern.first_step(panel, &lineage, mark)?;
        let (of, after) = lineage.stage(step)?;
        let first = evaluation.stage(of, after)?;
        stage.placed(first, line, value).ok()
    };
    let place = |value| stage.placed(stage, line, value).ok();
    let (old_end, new) = (place(corner(1))?, placed(mouth)?);
    let way = |to| {
        let stretch = stage.stretch(line, [old_end, to], is_sewn).ok()?;
        Some(stage.stretch_length(0, &stretch))
    };
    let (own, all) = (way(new)?, way(place(corner(0))?)?);
    let is_from_dart = match fold.and_then(|fold| way(placed(fold.1)?)) {
        Some(to_fold) => to_fold >= own,
        None => own <= 0.5 * all,
    };
    Some(match is_from_dart {
        true => Turned::FromDart,
        false => Turned::ToDart,
    })
}

/// Request to spread a panel.
#[derive(Clone, Debug, PartialEq)]
pub struct SpreadWish {
    /// The line that the cuts start and end on.
    pub line: LineName,
    /// Start and end of each cut, and its openings at the start and at the end (m).
    pub cuts: Vec<([Mark; 2], [Number; 2])>,
    /// A place of the panel that stays fixed. `None`: the start of the fold on the line, or the start of the
    /// line if the panel has no fold there.
    pub held: Option<Mark>,
    /// Shape of the outline across the openings.
    pub bridge: Bridge,
}

/// Plans to spread a panel; returns the operation too.
///
/// # Errors
/// The panel is missing or cannot be drawn; there is no cut; the panel cannot be spread like this (the
/// message gives the reason).
pub fn spread_panel(
    evaluation: &Evaluation,
    panel: PanelId,
    wish: SpreadWish,
) -> Result<(Vec<Edit>, OperationId), EditError> {
    let owner = lookup::panel(evaluation.pattern(), panel)?;
    if wish.cuts.is_empty() {
        return Err(impossible("there is no cut", "give one or more"));
    }
    let cuts = (0_u16..)
        .zip(wish.cuts)
        .map(|(number, (ends, openings))| SpreadCut {
            number,
            ends,
            openings,
        });
    let kind = OperationKind::Spread {
        line: wish.line,
        held: match wish
            .held
            .or_else(|| usual_held(evaluation, owner, wish.line))
        {
            Some(held) => held,
            None => {
                return Err(impossible(
                    format!("panel {:?} has no such line", owner.name),
                    "spread it along its outline",
                ));
            }
        },
        cuts: cuts.collect(),
        bridge: wish.bridge,
    };
    add_operation(evaluation, panel, kind)
}

/// Request to pleat a panel.
#[derive(Clone, Debug, PartialEq)]
pub struct PleatWish {
    /// The line that the pleats start and end on.
    pub line: LineName,
    /// Start and end of each pleat.
    pub lines: Vec<[Mark; 2]>,
    /// Depth of a fold under the cloth (m).
    pub depth: Number,
    /// Kind of pleat.
    pub kind: PleatKind,
    /// The side of its pleat line to which a knife pleat is pressed.
    pub pressed: Side,
    /// A place of the panel that stays fixed. `None`: the start of the fold on the line, or the start of the
    /// line if the panel has no fold there.
    pub held: Option<Mark>,
}

/// Plans to pleat a panel; returns the operation too. The pleats are trued.
///
/// # Errors
/// The panel is missing or cannot be drawn; there is no pleat line; the panel cannot be pleated like this
/// (the message gives the reason).
pub fn pleat_panel(
    evaluation: &Evaluation,
    panel: PanelId,
    wish: PleatWish,
) -> Result<(Vec<Edit>, OperationId), EditError> {
    let owner = lookup::panel(evaluation.pattern(), panel)?;
    if wish.lines.is_empty() {
        return Err(impossible("there is no pleat", "give one or more"));
    }
    let held = wish
        .held
        .or_else(|| usual_held(evaluation, owner, wish.line));
    let held = held.ok_or_else(|| {
        impossible(
            format!("panel {:?} has no such line", owner.name),
            "pleat it along its outline",
        )
    })?;
    let pleats = (0_u16..).zip(wish.lines);
    let kind = OperationKind::Pleat {
        line: wish.line,
        held,
        pleats: pleats
            .map(|(number, ends)| PleatLine { number, ends })
            .collect(),
        depth: wish.depth,
        kind: wish.kind,
        pressed: wish.pressed,
        trued: true,
    };
    add_operation(evaluation, panel, kind)
}

fn usual_held(evaluation: &Evaluation, panel: &Panel, line: LineName) -> Option<Mark> {
    let fold = panel
        .operations
        .iter()
        .filter(|operation| operation.kind.line() == Some(line))
        .find_map(|operation| Some(operation.kind.fold_ends()?[0].clone()));
    let first = || {
        let stage = evaluation.stage(panel.id, None)?;
        let found = stage.lines.iter().find(|known| known.name == line)?;
        found.edges.first()?.start.map(Mark::Corner)
    };
    fold.or_else(first)
}

/// Marks for evenly spaced cuts from one edge of a panel to another: the cuts divide both edges into
/// `count + 1` equal parts.
///
/// # Errors
/// The panel or an edge is missing; the edges are on different lines, or are the same.
pub fn even_cuts(
    evaluation: &Evaluation,
    panel: PanelId,
    [from, to]: [EdgeId; 2],
    count: u16,
) -> Result<(LineName, Vec<[Mark; 2]>), EditError> {
    let owner = lookup::panel(evaluation.pattern(), panel)?;
    let (line, start) = edge_ends(evaluation, owner, from)?;
    let (other, end) = edge_ends(evaluation, owner, to)?;
    if line != other || from == to {
        return Err(impossible(
            "the edges are not two of one line",
            "choose two edges of the outline that lie across from each other",
        ));
    }
    let between = |ends, share: f64| Mark::Between {
        ends,
        share: share.into(),
    };
    // Opposite edges of a closed line run in opposite directions.
    let cuts = (1..=count).map(|k| {
        let share = f64::from(k) / f64::from(count + 1);
        [between(start, share), between(end, 1.0 - share)]
    });
    Ok((Name::Drawn(line), cuts.collect()))
}
