//! Sews chains of edges together.

use super::impossible;
use super::lookup::{self, after, refuse_faults};
use super::names::{free_name, wished};
use super::on_stage::edge_ends;
use crate::{
    CornerName, EdgeId, Edit, EditError, Entity, Evaluation, LineId, Mark, Name, Panel, PanelId,
    Place, Role, Seam, SeamId, Span, StageEdge,
};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// What is left of an edge that a dart takes in is shorter (m).
const MIN_LENGTH: f64 = 1e-9;

/// An edge of a copy and half of a panel, as it comes in a chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SewnEdge {
    /// The panel.
    pub panel: PanelId,
    /// Its copy, from 0.
    pub copy: u32,
    /// Which half of a folded panel: 0 as drawn; a bit a fold, set beyond it.
    pub half: u8,
    /// The edge.
    pub edge: EdgeId,
}

/// One of the two sides of a seam.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SeamSide {
    /// The first.
    First,
    /// The second.
    Second,
}

impl SeamSide {
    /// Its place among a seam's sides.
    pub(super) fn index(self) -> usize {
        match self {
            Self::First => 0,
            Self::Second => 1,
        }
    }
}

/// The edits that sew two chains of edges together, start to start; and the seam. Edges of one
/// panel follow each other along its line, either way; which way tells where the chain starts. A
/// chain of single edges is walked so that right sides lie together. Without a name the seam is
/// called after its edges.
///
/// # Errors
/// A chain is empty; an edge, copy or half is not there, follows not upon the one before it, or is
/// sewn to itself; the name is taken or can be none.
pub fn sew(
    evaluation: &Evaluation,
    sides: [&[SewnEdge]; 2],
    name: Option<&str>,
) -> Result<(Vec<Edit>, SeamId), EditError> {
    let pattern = evaluation.pattern();
    if let Some(edge) = sides[0].iter().find(|edge| sides[1].contains(edge)) {
        let found = located(evaluation, *edge)?.edge;
        return Err(impossible(
            format!("edge {:?} would be sewn to itself", found.name),
            "choose another edge, or another copy of the panel",
        ));
    }
    let runs = [runs(evaluation, sides[0])?, runs(evaluation, sides[1])?];
    let turned = orientations(&runs);
    let mut spans = [Vec::new(), Vec::new()];
    for side in 0..2 {
        spans[side] = runs[side]
            .iter()
            .map(|run| run.span(turned[side]))
            .collect();
    }
    let owner = |name: &str| {
        let mut seams = pattern.seams.iter();
        seams
            .any(|seam| seam.name == name)
            .then(|| format!("seam {name:?}"))
    };
    let name = match name {
        Some(name) => wished(name, owner)?,
        None => free_name(&proposed(&runs), |name| owner(name).is_some()),
    };
    let mut ids = pattern.ids;
    let seam = Seam::new(ids.take(), name, spans);
    let id = seam.id;
    Ok((put(evaluation, seam)?, id))
}

/// The edits that walk one side of a seam from its other end, so that its ends change places.
///
/// # Errors
/// The seam is not there, or would have no place.
pub fn flip_side(
    evaluation: &Evaluation,
    seam: SeamId,
    side: SeamSide,
) -> Result<Vec<Edit>, EditError> {
    let mut changed = (**lookup::seam(evaluation.pattern(), seam)?).clone();
    let side = &mut changed.sides[side.index()];
    let spans = std::mem::take(side);
    *side = spans.into_iter().rev().map(Span::reversed).collect();
    put(evaluation, changed)
}

/// The edits that take a seam away; its edges stay.
///
/// # Errors
/// The seam is not there.
pub fn remove_seam(evaluation: &Evaluation, seam: SeamId) -> Result<Vec<Edit>, EditError> {
    lookup::seam(evaluation.pattern(), seam)?;
    Ok(vec![Edit::Remove(seam.into())])
}

/// An edge as it lies on its panel.
struct RunEdge<'p> {
    id: EdgeId,
    name: &'p str,
    /// Its corners there.
    ends: [CornerName; 2],
}

/// Edges of one copy and half of a panel that follow each other along one line.
struct Run<'p> {
    panel: &'p Panel,
    line: LineId,
    first: SewnEdge,
    edges: Vec<RunEdge<'p>>,
    /// Whether they are walked against the line; nothing if one edge does not tell.
    backwards: Option<bool>,
}

impl Run<'_> {
    /// Whether its cloth lies mirrored on the table: an odd copy of a pair, or beyond a fold.
    fn is_mirrored(&self) -> bool {
        let odd_copy = self.panel.cut.mirrored && self.first.copy % 2 == 1;
        let beyond = self.first.half.count_ones() % 2 == 1;
        odd_copy != beyond
    }

    /// Whether it is walked clockwise round its cloth, seen from the right side.
    fn is_clockwise(&self) -> Option<bool> {
        let backwards = self.backwards?;
        Some(backwards != self.is_mirrored())
    }

    /// The span, walked clockwise or not unless the run itself tells how.
    fn span(&self, clockwise: bool) -> Span {
        let backwards = self.backwards.unwrap_or(clockwise != self.is_mirrored());
        let (first, last) = (&self.edges[0], &self.edges[self.edges.len() - 1]);
        let [from, to] = match backwards {
            false => [first.ends[0], last.ends[1]],
            true => [first.ends[1], last.ends[0]],
        };
        Span {
            panel: self.panel.id,
            copy: self.first.copy,
            half: self.first.half,
            line: Name::Drawn(self.line),
            from: Mark::Corner(from),
            to: Mark::Corner(to),
            backwards,
        }
    }
}

/// An edge with its panel and line.
struct Located<'p> {
    panel: &'p Panel,
    line: LineId,
    edge: RunEdge<'p>,
}

fn located(evaluation: &Evaluation, sewn: SewnEdge) -> Result<Located<'_>, EditError> {
    let pattern = evaluation.pattern();
    let panel = lookup::panel(pattern, sewn.panel)?;
    let (line, ends) = edge_ends(evaluation, panel, sewn.edge)?;
    let owner = pattern.owner_of(sewn.panel, sewn.edge.into());
    let edge = owner.and_then(|owner| owner.edge(sewn.edge));
    let missing = || EditError::Missing(sewn.edge.to_string());
    let name = &edge.ok_or_else(missing)?.name;
    let id = sewn.edge;
    let edge = RunEdge { id, name, ends };
    Ok(Located { panel, line, edge })
}

/// The runs of a chain.
fn runs<'p>(evaluation: &'p Evaluation, chain: &[SewnEdge]) -> Result<Vec<Run<'p>>, EditError> {
    let mut runs: Vec<Run<'p>> = Vec::new();
    for (k, &sewn) in chain.iter().enumerate() {
        let Located { panel, line, edge } = located(evaluation, sewn)?;
        if chain[..k].contains(&sewn) {
            return Err(impossible(
                format!("edge {:?} is in the chain twice", edge.name),
                "choose every edge once",
            ));
        }
        let same_cloth = |run: &&mut Run<'_>| {
            let first = run.first;
            (first.panel, first.copy, first.half) == (sewn.panel, sewn.copy, sewn.half)
        };
        let Some(run) = runs.last_mut().filter(same_cloth) else {
            runs.push(Run {
                panel,
                line,
                first: sewn,
                edges: vec![edge],
                backwards: None,
            });
            continue;
        };
        let last = &run.edges[run.edges.len() - 1];
        let closed = |ends| is_closed_between(evaluation, panel, ends);
        let forwards = last.ends[1] == edge.ends[0] || closed([last.id, edge.id]);
        let against = last.ends[0] == edge.ends[1] || closed([edge.id, last.id]);
        let backwards = match (run.backwards, forwards, against) {
            (None | Some(false), true, _) => false,
            (None | Some(true), _, true) => true,
            _ => {
                return Err(impossible(
                    format!(
                        "edges {:?} and {:?} of panel {:?} do not follow each other",
                        last.name, edge.name, panel.name
                    ),
                    "choose the edges in the order they have along the line, without gaps",
                ));
            }
        };
        run.backwards = Some(backwards);
        run.edges.push(edge);
    }
    match runs.is_empty() {
        true => Err(impossible(
            "a side of the seam has no edges",
            "choose at least one edge for each side",
        )),
        false => Ok(runs),
    }
}

/// Whether an edge goes on into another as the panel is finished, with nothing between them but darts:
/// one may have taken in a whole edge that lay there.
fn is_closed_between(evaluation: &Evaluation, panel: &Panel, edges: [EdgeId; 2]) -> bool {
    let Some(stage) = evaluation.last_stage(panel) else {
        return false;
    };
    let outline: Vec<_> = stage.outline().iter().filter(|e| e.half == 0).collect();
    let [first, second] = edges.map(Name::Drawn);
    let is_dart =
        |edge: &StageEdge| edge.name.role() == Some(Role::Leg) || edge.curve.length() < MIN_LENGTH;
    (0..outline.len()).any(|k| {
        let mut after = outline[k + 1..].iter().chain(&outline[..k]);
        let next = after.find(|edge| !is_dart(edge));
        outline[k].name == first && next.is_some_and(|edge| edge.name == second)
    })
}

/// Whether each side is walked clockwise. Right sides together, two plies lie face to face, so one
/// is walked counter-clockwise round its cloth where the other is walked clockwise.
fn orientations(runs: &[Vec<Run<'_>>; 2]) -> [bool; 2] {
    let told = |side: usize| runs[side].iter().find_map(Run::is_clockwise);
    match (told(0), told(1)) {
        (Some(one), Some(two)) => [one, two],
        (Some(one), None) => [one, !one],
        (None, Some(two)) => [!two, two],
        (None, None) => {
            // The first edge is walked as it is drawn.
            let one = runs[0].first().is_some_and(Run::is_mirrored);
            [one, !one]
        }
    }
}

/// A name after the edges that are sewn.
fn proposed(runs: &[Vec<Run<'_>>; 2]) -> String {
    let [one, two] = [0, 1].map(|side| runs[side].first());
    let (Some(one), Some(two)) = (one, two) else {
        return "seam".into();
    };
    let edges = runs.iter().flatten().flat_map(|run| &run.edges);
    let names: Vec<&str> = edges.map(|edge| edge.name).collect();
    let common = common_words(&names);
    match common.is_empty() {
        false => format!("{common} seam"),
        true => {
            let [a, b] = [one, two].map(|run| run.edges[0].name);
            format!("{} {a} to {} {b}", one.panel.name, two.panel.name)
        }
    }
}

/// The words that all names begin with: `side` of `side_low`, `side_high` and `side`.
fn common_words<'n>(names: &[&'n str]) -> &'n str {
    let is_between = |c: char| c == '_' || c == ' ';
    let Some((first, others)) = names.split_first() else {
        return "";
    };
    let ends = first.char_indices().filter(|(_, c)| is_between(*c));
    let mut ends: Vec<usize> = ends.map(|(at, _)| at).collect();
    ends.push(first.len());
    let is_common = |end: &usize| {
        others.iter().all(|name| {
            let rest = name.strip_prefix(&first[..*end]);
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(is_between))
        })
    };
    let end = ends.into_iter().rev().find(is_common);
    end.map_or("", |end| &first[..end])
}

/// The edit that puts a seam, refused if it has no place.
fn put(evaluation: &Evaluation, seam: Seam) -> Result<Vec<Edit>, EditError> {
    let (id, name) = (seam.id, seam.name.clone());
    let edits = vec![Edit::Put(Entity::Seam(Arc::new(seam)))];
    let after = after(evaluation, &edits)?;
    refuse_faults(evaluation, &after, &[Place::Seam(id)])?;
    match after.seam_value(id) {
        Some(_) => Ok(edits),
        None => Err(impossible(
            format!("seam {name:?} has no place"),
            "mend its panels first",
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::common_words;

    #[test]
    fn names_share_whole_words() {
        assert_eq!(common_words(&["side_low", "side_high", "side"]), "side");
        assert_eq!(common_words(&["side seam low", "side seam"]), "side seam");
        assert_eq!(common_words(&["side", "sideways"]), "");
        assert_eq!(common_words(&["right", "left"]), "");
        assert_eq!(common_words(&["waist", "waist"]), "waist");
        assert_eq!(common_words(&[]), "");
    }
}
