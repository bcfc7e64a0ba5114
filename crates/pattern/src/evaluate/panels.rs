//! Stages of panels: as drawn, and after each operation.

use super::node::Node;
use super::numbers::{Computation, Want};
use crate::stage::{
    DartApex, DartError, DartMouth, FoldError, MarkValue, PlaceError, Placed, Spot, StageEdge,
    StageLine, StageNotch, cut_dart, cut_diamond, unfold,
};
use crate::{
    Apex, Code, Corner, Diagnostic, Edge, Line, LineKind, LineName, Mark, Name, Notch, Operation,
    OperationKind, Panel, Place, Stage,
};
use std::sync::Arc;
use toile_geometry::Vec2;

/// A stage of a panel; nothing if its outline or the stage before it cannot be drawn.
pub(super) fn stage(c: &mut Computation<'_>, panel: &Panel, step: usize) -> Option<Arc<Stage>> {
    if step == 0 {
        return Drawing { c, panel }.drawn().map(Arc::new);
    }
    let before = step.checked_sub(2).map(|k| panel.operations[k].id);
    let stage = c.stage(Node::Stage(panel.id, before)).cloned();
    let operation = &panel.operations[step - 1];
    let place = Place::Operation(panel.id, operation.id);
    let stage = c.reported(stage, &place, "")?;
    // An operation that cannot be done is left out, with an error.
    let mut drawing = Drawing { c, panel };
    let done = drawing.done(&stage, (step, operation));
    let mut stage = done.map_or(stage, Arc::new);
    let notches = drawing.notches(&stage, step);
    if !notches.is_empty() {
        Arc::make_mut(&mut stage).notches.extend(notches);
    }
    Some(stage)
}

struct Drawing<'c, 'e, 'p> {
    c: &'c mut Computation<'e>,
    panel: &'p Panel,
}

impl Drawing<'_, '_, '_> {
    fn words(&self, what: &str) -> String {
        format!("panel {:?}, {what}", self.panel.name)
    }

    fn error(&mut self, code: Code, place: Place, what: &str, hint: &str) {
        let message = self.words(what);
        let found = Diagnostic::error(code, place, message, hint);
        self.c.diagnostics.push(found);
    }

    fn drawn(&mut self) -> Option<Stage> {
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
            for line in panel.lines.iter().filter(|line| line.kind == kind) {
                match self.line(line, general.unwrap_or(0.0)) {
                    Some(line) => stage.lines.push(line),
                    // Lines inside can be left out; their faults are told.
                    None => complete &= kind == LineKind::Internal,
                }
            }
        }
        if !complete {
            return None;
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
        stage.notches = self.notches(&stage, 0);
        Some(stage)
    }

    /// The notches that are placed when that many operations are done: on the first stage that has
    /// their corners.
    fn notches(&mut self, stage: &Stage, step: usize) -> Vec<StageNotch> {
        let panel = self.panel;
        let mut found = Vec::new();
        for notch in &panel.notches {
            if panel.first_step(&notch.at).unwrap_or(0) == step && has_made(stage, panel, &notch.at)
            {
                found.extend(self.notch(stage, notch));
            }
        }
        found
    }

    fn line(&mut self, line: &Line, general: f64) -> Option<StageLine> {
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
        })
    }

    /// The pieces of an edge, each with its share of the edge.
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
                    0 => edge.corner.unwrap_or(Corner::Mitre),
                    _ => Corner::Mitre,
                },
            });
        Some(pieces.collect())
    }

    /// A mark with its number.
    fn mark(&mut self, mark: &Mark, place: &Place, what: &str) -> Option<MarkValue> {
        Some(match mark {
            Mark::Corner(corner) => MarkValue::Corner(*corner),
            Mark::Along { from, distance } => {
                MarkValue::Along(*from, self.c.number(distance, Want::Length, place, what)?)
            }
            Mark::Between { ends, share } => {
                MarkValue::Between(*ends, self.c.number(share, Want::Plain, place, what)?)
            }
            Mark::Notch(id) => {
                let notch = self.panel.notches.iter().find(|notch| notch.id == *id);
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

    /// Where a mark of the operation of a step is, on the first stage that has its corners.
    fn first_spot(
        &mut self,
        (line, mark): (LineName, &Mark),
        step: usize,
        (place, what): (&Place, &str),
    ) -> Option<Result<Spot, PlaceError>> {
        let panel = self.panel;
        let value = self.mark(mark, place, what)?;
        let first = panel.first_step(mark).unwrap_or(0);
        if first >= step {
            self.c.diagnostics.push(Diagnostic::error(
                Code::MissingReference,
                place.clone(),
                format!("{what}: it is placed by a corner that this step or a later one makes"),
                "do the step that makes the corner first, or place it by another corner",
            ));
            return None;
        }
        let after = first.checked_sub(1).map(|k| panel.operations[k].id);
        let stage = self.c.stage(Node::Stage(panel.id, after)).cloned();
        let stage = self.c.reported(stage, place, "")?;
        // What was not made was told where it is made.
        has_made(&stage, panel, mark).then(|| stage.spot(line, value))
    }

    /// A place of the stage an operation is done on: a corner as it is there, any other mark as it
    /// was on the first stage that had its corners.
    fn placed(
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

    fn gone(&mut self, place: &Place, what: &str, part: &str) {
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
                let mut operations = self.panel.operations.iter();
                match operations.find(|operation| operation.id == by) {
                    Some(made) => format!("a corner of {} {:?}", made.kind.word(), made.name),
                    None => format!("a corner of {by}"),
                }
            }
        }
    }

    fn no_place(&mut self, error: PlaceError, place: &Place, what: &str) {
        let part = match error {
            PlaceError::NoLine => "its line".to_owned(),
            PlaceError::NoCorner(corner) => self.corner_words(corner),
            PlaceError::Beyond => "its place".to_owned(),
        };
        self.gone(place, what, &part);
    }

    fn notch(&mut self, stage: &Stage, notch: &Notch) -> Option<StageNotch> {
        let place = Place::Notch(self.panel.id, notch.id);
        let what = self.words(&format!("notch {:?}", notch.name));
        let mark = self.mark(&notch.at, &place, &what)?;
        let line = Name::Drawn(notch.line);
        let spot = match stage.spot(line, mark) {
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
        let (point, along) = stage.at_spot(line, spot)?;
        let turn = stage.turn();
        Some(StageNotch {
            id: notch.id,
            edge: spot.edge,
            half: 0,
            kind: notch.kind,
            point,
            inward: Vec2::new(-along.y, along.x) * turn,
        })
    }

    /// A stage after an operation; nothing if it cannot be done.
    fn done(&mut self, stage: &Stage, (step, operation): (usize, &Operation)) -> Option<Stage> {
        let place = Place::Operation(self.panel.id, operation.id);
        match &operation.kind {
            OperationKind::Dart { .. } => self.dart(stage, (step, operation), &place),
            OperationKind::Diamond {
                ends,
                widest,
                intake,
            } => {
                let what = self.words(&format!("dart {:?}", operation.name));
                let ends = ends.map(|end| {
                    let at = self.c.point_at(end);
                    self.c.reported(at, &place, &what)
                });
                let widest = self.c.number(widest, Want::Plain, &place, &what);
                let intake = self.c.number(intake, Want::Length, &place, &what);
                let ([Some(a), Some(b)], Some(widest), Some(intake)) = (ends, widest, intake)
                else {
                    return None;
                };
                let done = cut_diamond(stage, operation.id, [a, b], widest, intake);
                if done.is_none() {
                    self.error(
                        Code::DartTooWide,
                        place,
                        &format!("dart {:?} has no width or length", operation.name),
                        "give it a width, two ends that are apart, and a widest place from 0 to 1",
                    );
                }
                done
            }
            OperationKind::Fold { line, ends } => self.fold(stage, (step, *line), ends, &place),
        }
    }

    fn dart(
        &mut self,
        stage: &Stage,
        (step, operation): (usize, &Operation),
        place: &Place,
    ) -> Option<Stage> {
        let OperationKind::Dart {
            line,
            mouth,
            intake,
            apex,
            pressed,
        } = &operation.kind
        else {
            return None;
        };
        let what = self.words(&format!("dart {:?}", operation.name));
        let middle = self.first_spot((*line, mouth), step, (place, &what));
        let intake = self.c.number(intake, Want::Length, place, &what);
        let apex = match apex {
            Apex::Depth(depth) => {
                let depth = self.c.number(depth, Want::Length, place, &what);
                depth.map(DartApex::Depth)
            }
            Apex::Point(point) => {
                let at = self.c.point_at(*point);
                self.c.reported(at, place, &what).map(DartApex::Point)
            }
        };
        let (middle, intake, apex) = (middle?, intake?, apex?);
        let done = match middle {
            Ok(middle) => {
                let mouth = DartMouth {
                    by: operation.id,
                    line: *line,
                    middle,
                    intake,
                    apex,
                    pressed: *pressed,
                };
                cut_dart(stage, &mouth)
            }
            Err(PlaceError::Beyond) => Err(DartError::TooWide),
            Err(error) => Err(DartError::Place(error)),
        };
        match done {
            Ok(stage) => return Some(stage),
            Err(DartError::Place(error)) => self.no_place(error, place, &what),
            Err(DartError::TooWide) => self.error(
                Code::DartTooWide,
                place.clone(),
                &format!(
                    "dart {:?} is {:.1} cm wide and does not fit on its edge",
                    operation.name,
                    intake * 100.0
                ),
                "make it narrower (and more than nothing), or move it along the edge",
            ),
            Err(DartError::Overlaps) => self.error(
                Code::DartTooWide,
                place.clone(),
                "two darts of one edge overlap",
                "move them apart or make them narrower",
            ),
        }
        None
    }

    fn fold(
        &mut self,
        stage: &Stage,
        (step, line): (usize, LineName),
        ends: &[Mark; 2],
        place: &Place,
    ) -> Option<Stage> {
        let what = self.words("fold");
        let from = self.placed((line, &ends[0]), step, (place, &what))?;
        let to = self.placed((line, &ends[1]), step, (place, &what))?;
        match unfold(stage, line, [from, to]) {
            Ok((stage, lost)) => {
                for id in lost {
                    let notch = self.panel.notches.iter().find(|notch| notch.id == id);
                    let name = notch.map_or_else(|| id.to_string(), |n| format!("{:?}", n.name));
                    self.error(
                        Code::MissingReference,
                        Place::Notch(self.panel.id, id),
                        &format!("notch {name}: its edge is the fold"),
                        "put it on another edge of this panel",
                    );
                }
                Some(stage)
            }
            Err(FoldError::Place(error)) => {
                self.no_place(error, place, &what);
                None
            }
            Err(FoldError::NotStraight) => {
                self.error(
                    Code::BadFold,
                    place.clone(),
                    "the fold is not a straight edge with a length",
                    "choose a straight edge of the outline, or none",
                );
                None
            }
        }
    }
}

/// Whether a stage has what operations of the panel make of a mark's corners. It has not where one
/// could not be done, which is told there.
pub(super) fn has_made(stage: &Stage, panel: &Panel, mark: &Mark) -> bool {
    let at = match mark {
        Mark::Notch(id) => panel.notch(*id).map(|notch| &notch.at),
        own => Some(own),
    };
    let corners = at.map_or_else(Vec::new, Mark::corners);
    let makers = corners.iter().filter_map(|corner| corner.maker());
    makers
        .filter(|by| panel.step_of(*by).is_some())
        .all(|by| stage.darts.iter().any(|dart| dart.by == by))
}
