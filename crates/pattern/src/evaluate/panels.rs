//! Panels as drawn; positions of marks and notches on their stages.

use super::node::Node;
use super::numbers::Computation;
use crate::Want;
use crate::stage::{MarkValue, PlaceError, Placed, Spot, StageEdge, StageLine, StageNotch};
use crate::{
    Code, Diagnostic, Edge, EdgeCorner, Line, LineKind, LineName, Mark, Name, Notch, OperationId,
    Panel, PanelId, Pattern, Place, Role, Side, Source, Stage, StageLineage,
};
use std::sync::Arc;
use toile_geometry::Vec2;

/// The computation of a panel's stages.
pub(super) struct PanelEvaluation<'c, 'e, 'p> {
    pub c: &'c mut Computation<'e>,
    pub panel: &'p Panel,
    /// The stages that lead to the panel.
    pub lineage: StageLineage,
}

impl<'c, 'e, 'p> PanelEvaluation<'c, 'e, 'p> {
    pub fn new(c: &'c mut Computation<'e>, panel: &'p Panel) -> Self {
        let lineage = c.evaluation.pattern.stage_lineage(panel);
        Self { c, panel, lineage }
    }

    fn first_step(&self, mark: &Mark) -> Option<usize> {
        let pattern = &self.c.evaluation.pattern;
        pattern.first_step(self.panel, &self.lineage, mark)
    }

    fn has_made(&self, stage: &Stage, mark: &Mark) -> bool {
        let pattern = &self.c.evaluation.pattern;
        has_made(stage, (pattern, self.panel, &self.lineage), mark)
    }

    /// One of the stages that lead to the panel, by its index.
    pub(super) fn past(&mut self, step: usize, place: &Place) -> Option<Arc<Stage>> {
        let (panel, after) = self.lineage.stage(step)?;
        let stage = self.c.stage(Node::Stage(panel, after)).cloned();
        self.c.reported(stage, place, "")
    }

    pub fn words(&self, what: &str) -> String {
        format!("panel {:?}, {what}", self.panel.name)
    }

    pub fn error(&mut self, code: Code, place: Place, what: &str, hint: &str) {
        let message = self.words(what);
        let found = Diagnostic::error(code, place, message, hint);
        self.c.diagnostics.push(found);
    }

    pub fn drawn(&mut self) -> Option<Stage> {
        let panel = self.panel;
        let place = Place::Panel(panel.id);
        let words = self.words("seam allowance");
        let general = self
            .c
            .number(&panel.allowance, Want::Length, &place, &words);
        let words = self.words("grain");
        let grain = self.c.number(&panel.grain, Want::Angle, &place, &words);
        let mut stage = Stage {
            grain: grain.unwrap_or(std::f64::consts::FRAC_PI_2),
            ..Stage::default()
        };
        let mut complete = true;
        for kind in [LineKind::Outline, LineKind::Hole, LineKind::Internal] {
            let drawn = |line: &&Line| line.kind == kind && line.by.is_none();
            for line in panel.lines.iter().filter(drawn) {
                match self.line(line, general.unwrap_or(0.0)) {
                    Some(line) => stage.lines.push(line),
                    // Internal lines can be left out; their faults are reported.
                    None => complete &= kind == LineKind::Internal,
                }
            }
        }
        if !complete {
            return None;
        }
        if let Source::Side { of, split, side } = panel.source {
            stage = self.side((of, split, side), stage.grain, general.unwrap_or(0.0))?;
        }
        if stage.outline().is_empty() {
            self.error(
                Code::EmptyOutline,
                place,
                "it has no outline",
                "draw its outline or remove the panel",
            );
            return None;
        }
        let own = self.notches(&stage, 0);
        stage.notches.extend(own);
        Some(stage)
    }

    /// The first stage of a panel that is a side of a split panel. The side has its own grain, and its own
    /// allowance for edges that have none themselves.
    fn side(
        &mut self,
        (of, split, side): (PanelId, OperationId, Side),
        grain: f64,
        general: f64,
    ) -> Option<Stage> {
        let place = Place::Panel(self.panel.id);
        let evaluation = self.c.evaluation;
        let parent = evaluation.pattern.panel(of);
        let hint = "undo its removal, or remove this panel";
        let Some(parent) = parent else {
            let what = "the panel that it is a side of was removed";
            self.error(Code::MissingReference, place, what, hint);
            return None;
        };
        if parent.step_of(split).is_none() {
            let what = format!(
                "panel {:?} is not split any more as it was for it",
                parent.name
            );
            self.error(Code::MissingReference, place, &what, hint);
            return None;
        }
        let node = Node::Stage(of, Some(split));
        let whole = self.c.stage(node).cloned();
        let whole = self.c.reported(whole, &place, "")?;
        let index = match side {
            Side::Left => 0,
            Side::Right => 1,
        };
        let Some(found) = whole.sides.get(index) else {
            // The split reports itself why it could not be done.
            self.c.cause = evaluation.index.get(&node).copied().unwrap_or(self.c.k);
            return None;
        };
        let mut stage = Stage {
            grain,
            ..(**found).clone()
        };
        let pattern = &evaluation.pattern;
        for line in &mut stage.lines {
            let mut before = general;
            for edge in &mut line.edges {
                let is_general = match edge.name {
                    Name::Drawn(id) => {
                        let owner = pattern.owner_of(self.panel.id, id.into());
                        let own = owner.and_then(|owner| owner.edge(id));
                        own.is_some_and(|own| own.allowance.is_none())
                    }
                    Name::Made { by, .. } => by == split,
                };
                match edge.name.role() {
                    // An opening has the allowance of the edge before it.
                    Some(Role::Opening) => edge.allowance = before,
                    _ if is_general => edge.allowance = general,
                    _ => {}
                }
                before = edge.allowance;
            }
        }
        Some(stage)
    }

    /// The notches that are placed once the first `step` operations are done. Each notch is placed on the
    /// first stage that has the corners of its mark.
    pub fn notches(&mut self, stage: &Stage, step: usize) -> Vec<StageNotch> {
        let panel = self.panel;
        let mut found = Vec::new();
        for notch in &panel.notches {
            let first = self.first_step(&notch.at).unwrap_or(0);
            if first.max(self.lineage.base) == self.lineage.base + step
                && self.has_made(stage, &notch.at)
            {
                found.extend(self.notch(stage, (notch, first)));
            }
        }
        found
    }

    pub(super) fn line(&mut self, line: &Line, general: f64) -> Option<StageLine> {
        let mut edges = Vec::with_capacity(line.edges.len());
        let mut complete = true;
        for edge in &line.edges {
            match self.edge(edge, general) {
                Some(found) => edges.extend(found),
                None => complete = false,
            }
        }
        let end = line.edges.last().map(|edge| Name::Drawn(edge.ends[1]));
        complete.then_some(StageLine {
            name: Name::Drawn(line.id),
            half: 0,
            kind: line.kind,
            edges,
            end,
            twins: Vec::new(),
        })
    }

    /// The curve pieces of an edge, each with the shares of the edge that it covers.
    fn edge(&mut self, edge: &Edge, general: f64) -> Option<Vec<StageEdge>> {
        let place = Place::Edge(self.panel.id, edge.id);
        let own = edge.allowance.as_ref().and_then(|allowance| {
            let what = self.words(&format!("edge {:?}, seam allowance", edge.name));
            self.c.number(allowance, Want::Length, &place, &what)
        });
        let path = self.c.path(Node::Edge(edge.id)).cloned();
        let path = self.c.reported(path, &place, "")?;
        let count = path.curves().len();
        let share = |k: usize| match k {
            0 => 0.0,
            k if k == count => 1.0,
            k => path.length_before(k) / path.length(),
        };
        let pieces = path
            .curves()
            .iter()
            .enumerate()
            .map(|(k, curve)| StageEdge {
                name: Name::Drawn(edge.id),
                half: 0,
                start: (k == 0).then_some(Name::Drawn(edge.ends[0])),
                from: share(k),
                to: share(k + 1),
                curve: *curve,
                allowance: own.unwrap_or(general),
                corner: match k {
                    0 => edge.corner,
                    _ => EdgeCorner::default(),
                },
            });
        Some(pieces.collect())
    }

    /// A mark with its number evaluated.
    pub fn mark(&mut self, mark: &Mark, place: &Place, what: &str) -> Option<MarkValue> {
        Some(match mark {
            Mark::Corner(corner) => MarkValue::Corner(*corner),
            Mark::Along { from, distance } => {
                MarkValue::Along(*from, self.c.number(distance, Want::Length, place, what)?)
            }
            Mark::Between { ends, share } => {
                MarkValue::Between(*ends, self.c.number(share, Want::Plain, place, what)?)
            }
            Mark::Notch(id) => {
                let pattern = &self.c.evaluation.pattern;
                let notch = pattern.notch_of(self.panel, *id);
                match notch.map(|notch| &notch.at) {
                    Some(at) if !matches!(at, Mark::Notch(_)) => self.mark(at, place, what)?,
                    _ => {
                        self.gone(place, what, &id.to_string());
                        return None;
                    }
                }
            }
        })
    }

    /// The position of a mark that an operation names, on the first stage that has the corners of the mark.
    pub fn first_spot(
        &mut self,
        (line, mark): (LineName, &Mark),
        step: usize,
        (place, what): (&Place, &str),
    ) -> Option<Result<Spot, PlaceError>> {
        let value = self.mark(mark, place, what)?;
        let first = self.first_step(mark).unwrap_or(0);
        if first >= self.lineage.base + step {
            self.c.diagnostics.push(Diagnostic::error(
                Code::MissingReference,
                place.clone(),
                format!("{what}: it is placed by a corner that this step or a later one makes"),
                "do the step that makes the corner first, or place it by another corner",
            ));
            return None;
        }
        let stage = self.past(first, place)?;
        // A missing corner is reported by the operation that should make it.
        self.has_made(&stage, mark).then(|| stage.spot(line, value))
    }

    /// A place on the stage that an operation is applied to. A corner is taken where it is on that stage; any
    /// other mark where it was on the first stage that has its corners.
    pub fn placed(
        &mut self,
        (line, mark): (LineName, &Mark),
        step: usize,
        (place, what): (&Place, &str),
    ) -> Option<Placed> {
        if let Mark::Corner(corner) = mark {
            return Some(Placed::Mark(MarkValue::Corner(*corner)));
        }
        match self.first_spot((line, mark), step, (place, what))? {
            Ok(spot) => Some(Placed::Spot(spot)),
            Err(error) => {
                self.no_place(error, place, what);
                None
            }
        }
    }

    pub fn gone(&mut self, place: &Place, what: &str, part: &str) {
        self.c.diagnostics.push(Diagnostic::error(
            Code::MissingReference,
            place.clone(),
            format!("{what}: {part} is not there any more"),
            "put it somewhere else, remove it, or undo the removal",
        ));
    }

    fn corner_words(&self, corner: crate::CornerName) -> String {
        match corner {
            Name::Drawn(id) => match self.c.evaluation.pattern.point(id) {
                Some((_, point)) => format!("the corner {:?}", point.name),
                None => id.to_string(),
            },
            Name::Made { by, .. } => {
                let pattern = &self.c.evaluation.pattern;
                match pattern.operation_of(self.panel, by) {
                    Some(made) => format!("a corner of {} {:?}", made.kind.word(), made.name),
                    None => format!("a corner of {by}"),
                }
            }
        }
    }

    pub fn no_place(&mut self, error: PlaceError, place: &Place, what: &str) {
        let part = match error {
            PlaceError::NoLine => "its line".to_owned(),
            PlaceError::NoCorner(corner) => self.corner_words(corner),
            PlaceError::Beyond => "its place".to_owned(),
        };
        self.gone(place, what, &part);
    }

    /// A notch; `first` is the index of the first stage that has the corners of its mark.
    fn notch(&mut self, stage: &Stage, (notch, first): (&Notch, usize)) -> Option<StageNotch> {
        let place = Place::Notch(self.panel.id, notch.id);
        let what = self.words(&format!("notch {:?}", notch.name));
        let mark = self.mark(&notch.at, &place, &what)?;
        let line = Name::Drawn(notch.line);
        // A notch whose corners exist before the split is placed on an earlier stage, which belongs to the
        // panel that is split.
        let found = match first < self.lineage.base {
            true => self.past(first, &place)?.spot(line, mark),
            false => stage.spot(line, mark),
        };
        let spot = match found {
            Ok(spot) => spot,
            Err(PlaceError::Beyond) => {
                self.c.diagnostics.push(Diagnostic::warning(
                    Code::NotchOffEdge,
                    place,
                    format!("{what} lies beyond its edge and is left out"),
                    "use a share from 0 to 1, or a distance within the line",
                ));
                return None;
            }
            Err(error) => {
                self.no_place(error, &place, &what);
                return None;
            }
        };
        let Some((point, along)) = stage.at_spot(line, spot) else {
            // An edge without length is reported by its own node.
            if first < self.lineage.base {
                self.no_place(PlaceError::Beyond, &place, &what);
            }
            return None;
        };
        let turn = stage.turn();
        Some(StageNotch {
            id: notch.id,
            edge: spot.edge,
            share: spot.share,
            half: 0,
            kind: notch.kind,
            point,
            inward: Vec2::new(-along.y, along.x) * turn,
        })
    }
}

/// Whether a stage has all corners of a mark that operations of the panel make. A corner is missing if its
/// operation could not be done, which that operation reports.
pub(super) fn has_made(
    stage: &Stage,
    (pattern, panel, lineage): (&Pattern, &Panel, &StageLineage),
    mark: &Mark,
) -> bool {
    let at = match mark {
        Mark::Notch(id) => pattern.notch_of(panel, *id).map(|notch| &notch.at),
        own @ (Mark::Along { .. } | Mark::Between { .. } | Mark::Corner(_)) => Some(own),
    };
    let corners = at.map_or_else(Vec::new, Mark::corners);
    let makers = corners.iter().filter_map(|corner| corner.maker());
    makers
        .filter(|by| lineage.step_of(*by).is_some())
        .all(|by| stage.done.contains(&by))
}
