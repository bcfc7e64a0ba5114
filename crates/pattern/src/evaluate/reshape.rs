//! Operations that cut a panel apart: pivots, spreads and splits.

use super::node::Node;
use super::panels::PanelEvaluation;
use crate::Want;
use crate::stage::{
    CutError, MAX_CUTS, PivotError, Pivoting, Pleating, SplitError, SpreadAlong, SpreadError,
    Spreading, pivot_dart, pleat, split, spread,
};
use crate::{
    Bridge, Code, CurveId, Diagnostic, LineName, Operation, OperationId, OperationKind, Place,
    PleatKind, PleatLine, SpreadCut, Stage,
};

impl PanelEvaluation<'_, '_, '_> {
    /// The stage after a pivot. `None`: the pivot cannot be done.
    pub fn pivot(
        &mut self,
        stage: &Stage,
        (step, operation): (usize, &Operation),
        place: &Place,
    ) -> Option<Stage> {
        let OperationKind::Pivot {
            dart,
            line,
            mouth,
            share,
            back,
            turned,
            pressed,
        } = &operation.kind
        else {
            return None;
        };
        let what = self.words(&format!("pivot {:?}", operation.name));
        let share = self.c.number(share, Want::Plain, place, &what);
        let back = self.c.number(back, Want::Length, place, &what);
        let is_there = self.is_done(stage, (step, *dart), (place, &what));
        let mouth = self.placed((*line, mouth), step, (place, &what));
        let (share, back, mouth) = (share?, back?, mouth?);
        if !is_there {
            return None;
        }
        let wish = Pivoting {
            by: operation.id,
            dart: *dart,
            line: *line,
            mouth,
            share,
            back,
            turned: *turned,
            pressed: *pressed,
        };
        let error = match pivot_dart(stage, &wish) {
            Ok(stage) => return Some(self.trued(stage, (step, operation), place)),
            Err(error) => error,
        };
        let (message, hint) = match error {
            PivotError::Cut(error) => {
                self.no_cut(
                    error,
                    place,
                    &format!("{what}, from its mouth to the dart's point"),
                );
                return None;
            }
            PivotError::NoMouth => (
                "the dart has no mouth in the outline".to_owned(),
                "pivot a dart that is open on the outline, and not one that was closed before",
            ),
            PivotError::Share => (
                format!("its share is {share:.3} and should be from 0 to 1"),
                "give the share of the dart that is moved: 0.5 is half of it, 1 all",
            ),
            PivotError::OnDart => (
                "its mouth lies on a dart".to_owned(),
                "open it elsewhere on the outline",
            ),
            PivotError::LegsDiffer => (
                "the legs of the dart are of different lengths, so that it does not close"
                    .to_owned(),
                "make the legs equal, or move a share of less than 1",
            ),
            PivotError::OnePoint => (
                "both darts end in one point, where the panel would come apart".to_owned(),
                "set their points back by a length above 0, or move the whole dart with a share of 1",
            ),
            PivotError::TooFarBack => (
                format!("its darts are set back by {:.1} cm", back * 100.0),
                "set them back by at least 0 and less than a leg is long",
            ),
        };
        self.refused(Code::BadPivot, place, (&what, &message), hint);
        None
    }

    /// The stage after a spread. `None`: the spread cannot be done.
    pub fn spread(
        &mut self,
        stage: &Stage,
        (step, operation): (usize, &Operation),
        place: &Place,
    ) -> Option<Stage> {
        let OperationKind::Spread {
            line,
            held,
            cuts,
            bridge,
        } = &operation.kind
        else {
            return None;
        };
        let what = self.words(&format!("spread {:?}", operation.name));
        let held = self.placed((*line, held), step, (place, &what));
        let mut known = Vec::with_capacity(cuts.len());
        for cut in cuts {
            let words = format!("{what}, cut {}", cut.number);
            known.extend(self.cut(cut, (step, *line), (place, &words)));
        }
        let held = held.filter(|_| known.len() == cuts.len())?;
        let wish = Spreading {
            by: operation.id,
            line: *line,
            held,
            cuts: known,
            bridge: *bridge,
        };
        match spread(stage, &wish) {
            Ok(stage) => Some(stage),
            Err(error) => {
                self.no_spread(error, place, &what);
                None
            }
        }
    }

    /// The stage with pleats. `None`: the pleats cannot be made.
    pub fn pleat(
        &mut self,
        stage: &Stage,
        (step, operation): (usize, &Operation),
        place: &Place,
    ) -> Option<Stage> {
        let OperationKind::Pleat {
            line,
            held,
            pleats,
            depth,
            kind,
            pressed,
            trued,
        } = &operation.kind
        else {
            return None;
        };
        let what = self.words(&format!("pleat {:?}", operation.name));
        let held = self.placed((*line, held), step, (place, &what));
        let depth = self.c.number(depth, Want::Length, place, &what)?;
        let folds = match kind {
            PleatKind::Knife => 1.0,
            PleatKind::Box | PleatKind::Inverted => 2.0,
        };
        let mut cuts = Vec::with_capacity(pleats.len());
        for pleat in pleats {
            let words = format!("{what}, line {}", pleat.number);
            let ends = [0, 1].map(|k| self.placed((*line, &pleat.ends[k]), step, (place, &words)));
            let [Some(from), Some(to)] = ends else {
                continue;
            };
            cuts.push(SpreadAlong {
                number: pleat.number,
                ends: [from, to],
                openings: [2.0 * folds * depth.max(0.0); 2],
            });
        }
        let held = held.filter(|_| cuts.len() == pleats.len())?;
        let spread = Spreading {
            by: operation.id,
            line: *line,
            held,
            cuts,
            bridge: Bridge::Straight,
        };
        let wish = Pleating {
            spread,
            depth,
            kind: *kind,
            pressed: *pressed,
            trued: *trued,
        };
        match pleat(stage, &wish) {
            Ok(stage) => Some(stage),
            Err(error) => {
                self.no_spread(error, place, &what);
                None
            }
        }
    }

    /// Reports why a panel cannot be spread or pleated.
    fn no_spread(&mut self, error: SpreadError, place: &Place, what: &str) {
        let (message, hint) = match error {
            SpreadError::Cut(number, error) => {
                return self.no_cut(error, place, &format!("{what}, cut {number}"));
            }
            SpreadError::Line(error) => return self.no_cut(error, place, what),
            SpreadError::Negative(number) => (
                format!("cut {number} opens by less than nothing"),
                "give openings of at least 0; take cloth out with a dart",
            ),
            SpreadError::TooWide(number) => (
                format!("the openings of cut {number} differ by more than twice its length"),
                "make the cut longer or the openings more alike",
            ),
            SpreadError::Cross(one, other) => (
                format!("cuts {one} and {other} cross or lie on each other"),
                "move one of them, or cut in a spread of its own afterwards",
            ),
            SpreadError::OneEnd(one, other) => (
                format!("cuts {one} and {other} open at one place"),
                "move them apart, or open there by 0",
            ),
            SpreadError::Number(number) => (
                format!("two cuts have the number {number}"),
                "give each a number of its own",
            ),
            SpreadError::TooMany => (
                format!("it has more than {MAX_CUTS} cuts"),
                "divide them among several operations",
            ),
            SpreadError::Large(number, largest) => (
                format!("{number} is too large a number for a cut"),
                match largest {
                    PleatLine::LARGEST => "give pleats numbers up to 6552",
                    _ => "give cuts numbers up to 16383",
                },
            ),
            SpreadError::NoDepth => (
                "its folds are less than nothing deep".to_owned(),
                "give a depth of 0 or more; 0 is no pleat",
            ),
            SpreadError::TooDeep(number) => (
                format!("the outline beside pleat {number} does not reach as far as its fold"),
                "make the pleats less deep, or move them away from corners and darts",
            ),
        };
        self.refused(Code::BadCut, place, (what, &message), hint);
    }

    fn cut(
        &mut self,
        cut: &SpreadCut,
        (step, line): (usize, LineName),
        (place, what): (&Place, &str),
    ) -> Option<SpreadAlong> {
        let [from, to] = [0, 1].map(|k| self.placed((line, &cut.ends[k]), step, (place, what)));
        let [start, end] = [0, 1].map(|k: usize| {
            let opening = &cut.openings[k];
            self.c.number(opening, Want::Length, place, what)
        });
        Some(SpreadAlong {
            number: cut.number,
            ends: [from?, to?],
            openings: [start?, end?],
        })
    }

    /// The stage with both sides of a split. `None`: it cannot be split.
    pub fn split(
        &mut self,
        stage: &Stage,
        (operation, line): (&Operation, LineName),
        curve: CurveId,
    ) -> Option<Stage> {
        let place = Place::Operation(self.panel.id, operation.id);
        let what = self.words(&format!("split {:?}", operation.name));
        let path = self.c.path(Node::Curve(curve)).cloned();
        let path = self.c.reported(path, &place, &what)?;
        match split(stage, (operation.id, line), &path) {
            Ok(stage) => return Some(stage),
            Err(SplitError::Cut(error)) => self.no_cut(error, &place, &what),
            Err(SplitError::Meets(count)) => {
                let message = match count {
                    0 => "its curve does not meet the outline".to_owned(),
                    1 => "its curve meets the outline in one place".to_owned(),
                    count => format!("its curve meets the outline in {count} places"),
                };
                let hint =
                    "draw the curve from one place of the outline to another, with ends on it";
                self.refused(Code::BadCut, &place, (&what, &message), hint);
            }
        }
        None
    }

    /// Whether an operation comes before this step and was done. An operation that failed reports the fault
    /// itself.
    fn is_done(
        &mut self,
        stage: &Stage,
        (step, operation): (usize, OperationId),
        (place, what): (&Place, &str),
    ) -> bool {
        match self.lineage.step_of(operation) {
            Some(own) if own < self.lineage.base + step => stage.done.contains(&operation),
            Some(_) => {
                self.refused(
                    Code::MissingReference,
                    place,
                    (what, "its dart is made by this step or a later one"),
                    "do the step that makes the dart first",
                );
                false
            }
            None => {
                self.gone(place, what, "its dart");
                false
            }
        }
    }

    fn refused(&mut self, code: Code, place: &Place, (what, message): (&str, &str), hint: &str) {
        let message = format!("{what}: {message}");
        let found = Diagnostic::error(code, place.clone(), message, hint);
        self.c.diagnostics.push(found);
    }

    /// Reports why a panel cannot be cut.
    pub fn no_cut(&mut self, error: CutError, place: &Place, what: &str) {
        let (message, hint) = match error {
            CutError::Place(error) => return self.no_place(error, place, what),
            CutError::Unfolded => (
                "it would cut one half of a folded panel",
                "do it before the fold, so that both halves have it",
            ),
            CutError::NoLength => ("the cut has no length", "choose two places that are apart"),
            CutError::LeavesPanel => (
                "the cut leaves the panel or crosses its outline",
                "choose places between which the panel lies",
            ),
            CutError::ThroughHole => (
                "the cut goes through a hole",
                "lead it past the hole, or cut first and make the hole afterwards",
            ),
        };
        self.refused(Code::BadCut, place, (what, message), hint);
    }
}
