//! Pivots darts and spreads panels: what the operations need that a wish leaves open is chosen.

use super::impossible;
use super::lookup;
use super::on_stage::{edge_ends, mark_value};
use super::operations::add_operation;
use crate::stage::{MarkValue, is_sewn};
use crate::{
    Bridge, EdgeId, Edit, EditError, Evaluation, LineName, Mark, Name, Number, OperationId,
    OperationKind, Panel, PanelId, PleatKind, PleatLine, Pressed, Role, Side, SpreadCut, Turned,
};

/// A dart that is to be pivoted.
#[derive(Clone, Debug, PartialEq)]
pub struct PivotWish {
    /// The dart: a dart or a pivot of the panel.
    pub dart: OperationId,
    /// The line and the place on it where the new mouth opens.
    pub mouth: (LineName, Mark),
    /// Plain share of the dart that is moved, from 0 to 1.
    pub share: Number,
    /// How far the points of both darts are set back (m).
    pub back: Number,
    /// Which part is turned; nothing for that without the fold, else the shorter one.
    pub turned: Option<Turned>,
}

/// The edits that pivot a dart; and the operation. The new dart is pressed as a dart is at first.
///
/// # Errors
/// The panel is not there or cannot be drawn; the dart cannot be pivoted so: the words say why.
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

/// The part of a panel without its fold, else the shorter one; nothing if they cannot be told.
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

/// A panel that is to be spread.
#[derive(Clone, Debug, PartialEq)]
pub struct SpreadWish {
    /// The line it is cut from and to.
    pub line: LineName,
    /// Where each cut starts and ends, and how far it opens there (m).
    pub cuts: Vec<([Mark; 2], [Number; 2])>,
    /// A place that stays where it is; nothing for the start of the fold, else of the line.
    pub held: Option<Mark>,
    /// How the outline goes across openings.
    pub bridge: Bridge,
}

/// The edits that spread a panel; and the operation.
///
/// # Errors
/// The panel is not there or cannot be drawn; there is no cut; it cannot be spread so: the words
/// say why.
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

/// A panel that is to be pleated.
#[derive(Clone, Debug, PartialEq)]
pub struct PleatWish {
    /// The line it is pleated from and to.
    pub line: LineName,
    /// Where each pleat starts and ends.
    pub lines: Vec<[Mark; 2]>,
    /// How deep a fold goes under (m).
    pub depth: Number,
    /// How it is folded.
    pub kind: PleatKind,
    /// The side of its line a knife pleat is pressed to.
    pub pressed: Side,
    /// A place that stays where it is; nothing for the start of the fold, else of the line.
    pub held: Option<Mark>,
}

/// The edits that pleat a panel; and the operation. The pleats are trued.
///
/// # Errors
/// The panel is not there or cannot be drawn; there is no line; it cannot be pleated so: the words
/// say why.
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

/// Places for cuts from one edge of a panel to another, evenly: the panel falls into `count + 1`
/// parts of equal width along both edges.
///
/// # Errors
/// The panel or an edge is not there; the edges are of different lines, or one and the same.
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
    // Across a closed line edges run against each other.
    let cuts = (1..=count).map(|k| {
        let share = f64::from(k) / f64::from(count + 1);
        [between(start, share), between(end, 1.0 - share)]
    });
    Ok((Name::Drawn(line), cuts.collect()))
}
