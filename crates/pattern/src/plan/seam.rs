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

/// Length below which an edge counts as taken in by a dart (m).
const MIN_LENGTH: f64 = 1e-9;

/// One edge of a chain that is sewn: the edge on a copy and half of a panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SewnEdge {
    /// The panel.
    pub panel: PanelId,
    /// Number of the copy, from 0.
    pub copy: u32,
    /// Half of a folded panel: 0 is the half as drawn; each fold has one bit, which is set for the half
    /// beyond that fold.
    pub half: u8,
    /// The edge.
    pub edge: EdgeId,
}

/// One of the two sides of a seam.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SeamSide {
    /// The first side.
    First,
    /// The second side.
    Second,
}

impl SeamSide {
    /// Index in the sides of a seam.
    pub(super) fn index(self) -> usize {
        match self {
            Self::First => 0,
            Self::Second => 1,
        }
    }
}

/// Plans to sew two chains of edges together, beginning at the start of each; returns the seam too.
/// Consecutive edges of one panel follow each other along its line, or against it: this tells at which end
/// the chain starts. A chain in which no edge follows another tells nothing, and is walked so that right
/// sides lie together. Without a name the seam is named after its edges.
///
/// # Errors
/// A chain is empty; an edge, copy or half is missing, does not follow the edge before it, or is sewn to
/// itself; the name is taken or not allowed.
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

/// Plans to walk one side of a seam in the other direction, so that its start and end change places.
///
/// # Errors
/// The seam is missing, or a span would have no position.
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

/// Plans to remove a seam; its edges stay.
///
/// # Errors
/// The seam is missing.
pub fn remove_seam(evaluation: &Evaluation, seam: SeamId) -> Result<Vec<Edit>, EditError> {
    lookup::seam(evaluation.pattern(), seam)?;
    Ok(vec![Edit::Remove(seam.into())])
}

/// An edge on the last stage of its panel.
struct RunEdge<'p> {
    id: EdgeId,
    name: &'p str,
    /// Corners of the edge on that stage.
    ends: [CornerName; 2],
}

/// A run: consecutive edges of one line, on one copy and half of a panel.
struct Run<'p> {
    panel: &'p Panel,
    line: LineId,
    first: SewnEdge,
    edges: Vec<RunEdge<'p>>,
    /// Whether the run is walked against the direction of its line. `None`: the run is a single edge and
    /// shows no direction.
    backwards: Option<bool>,
}

impl Run<'_> {
    /// Whether the cloth of the run is a mirror image of the panel as drawn: an odd copy of a pair, or a half
    /// beyond a fold.
    fn is_mirrored(&self) -> bool {
        let odd_copy = self.panel.cut.mirrored && self.first.copy % 2 == 1;
        let beyond = self.first.half.count_ones() % 2 == 1;
        odd_copy != beyond
    }

    /// Whether the run is walked clockwise round its cloth, seen from the right side. `None`: the run shows
    /// no direction.
    fn is_clockwise(&self) -> Option<bool> {
        let backwards = self.backwards?;
        Some(backwards != self.is_mirrored())
    }

    /// The span of the run. It is walked as `clockwise` says, unless the run itself shows a direction.
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

/// Divides a chain into runs of consecutive edges.
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

/// Whether an edge meets the next one on the finished panel, with nothing but darts between them: a dart may
/// have taken in a whole edge that lay there.
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

/// For each side, whether it is walked clockwise. With right sides together the two plies lie face to face,
/// so one side is walked counter-clockwise round its cloth where the other is walked clockwise.
fn orientations(runs: &[Vec<Run<'_>>; 2]) -> [bool; 2] {
    let told = |side: usize| runs[side].iter().find_map(Run::is_clockwise);
    match (told(0), told(1)) {
        (Some(one), Some(two)) => [one, two],
        (Some(one), None) => [one, !one],
        (None, Some(two)) => [!two, two],
        (None, None) => {
            // No run shows a direction: the first edge is walked in its drawn direction.
            let one = runs[0].first().is_some_and(Run::is_mirrored);
            [one, !one]
        }
    }
}

/// A name for a new seam, made from the names of the sewn edges.
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

/// The words that all names begin with: `side` for `side_low`, `side_high` and `side`.
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

/// The edit that puts a seam into the pattern; refused if the seam has no position.
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
