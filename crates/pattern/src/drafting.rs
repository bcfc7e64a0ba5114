//! Makes a draft from an evaluation: pieces of cloth, and seams between them.

use crate::evaluate::{Evaluation, SeamValue, SpanValue, Wearer};
use crate::orientation::{
    Meeting, SeamSpan, SidePart, Taken, Twin, choose, exchange_words, meetings,
};
use crate::stage::StageEdge;
use crate::{
    Code, Diagnostic, Draft, DraftSeam, DraftSpan, EdgeName, EdgeOrigin, LineKind, Name, Number,
    OperationKind, Panel, PanelId, Pattern, Piece, PieceEdge, PieceId, PieceLine, PieceNotch,
    Place, PressArrow, Role, Seam, SeamOrigin, Severity, Stage, Worn, WornRule, press_arrows,
};
use std::collections::{BTreeMap, BTreeSet};
use toile_geometry::{Rigid, Vec3};

/// Most pieces a draft may have.
const MAX_PIECES: usize = 2000;

/// A draft together with data that only its checks need.
pub(crate) struct Drafting {
    pub draft: Draft,
    pub diagnostics: Vec<Diagnostic>,
    /// Greatest difference in length between the sides of each draft seam (m).
    pub eases: Vec<f64>,
}

impl Pattern {
    /// The draft for a size or a table of measurements, and diagnostics.
    ///
    /// Measurements that are not given are taken from the base size, with a note for each. Panels that cannot
    /// be drawn and seams that cannot be walked are left out of the draft, with an error for each.
    pub fn resolve(&self, wearer: impl Into<Wearer>) -> (Draft, Vec<Diagnostic>) {
        Evaluation::new(self, wearer).draft()
    }
}

impl Evaluation {
    /// The draft of the pattern as last evaluated, and a diagnostic for each part that is left out of it.
    pub fn draft(&self) -> (Draft, Vec<Diagnostic>) {
        let drafting = self.drafting();
        (drafting.draft, drafting.diagnostics)
    }

    pub(crate) fn drafting(&self) -> Drafting {
        let pattern = self.pattern();
        let mut drafter = Drafter {
            evaluation: self,
            drafting: Drafting {
                draft: Draft {
                    name: pattern.name.clone(),
                    fabrics: pattern.fabrics.iter().map(|f| (**f).clone()).collect(),
                    ..Draft::default()
                },
                diagnostics: self.diagnostics(),
                eases: Vec::new(),
            },
            tracks: BTreeMap::new(),
        };
        for panel in &pattern.panels {
            drafter.panel(panel);
        }
        drafter.darts();
        drafter.seams();
        drafter.mark_sewn();
        drafter.drafting
    }
}

/// A stretch of a named edge on a piece: index of the piece's edge, and the two shares of the named edge
/// between which the stretch lies.
#[derive(Clone, Copy)]
struct Track {
    edge: usize,
    from: f64,
    to: f64,
}

type Tracks = BTreeMap<EdgeOrigin, Vec<Track>>;

struct Drafter<'a> {
    evaluation: &'a Evaluation,
    drafting: Drafting,
    /// For each piece, its index in the draft and the stretches of its named edges.
    tracks: BTreeMap<PieceId, (usize, Tracks)>,
}

impl Drafter<'_> {
    fn report(&mut self, severity: Severity, code: Code, place: Place, what: String, hint: &str) {
        let found = Diagnostic::new(severity, code, place, what, hint);
        self.drafting.diagnostics.push(found);
    }

    fn panel(&mut self, panel: &Panel) {
        // The sides of a split panel are cut instead of it.
        if panel.is_split() {
            return;
        }
        let place = Place::Panel(panel.id);
        let stage = self.evaluation.last_stage(panel).cloned();
        let worn = self.worn(panel);
        let fabrics = &self.evaluation.pattern().fabrics;
        let fabric = fabrics.iter().position(|f| f.id == panel.fabric);
        if fabric.is_none() {
            self.report(
                Severity::Error,
                Code::MissingReference,
                place.clone(),
                format!(
                    "panel {:?} is cut from a fabric that is not there",
                    panel.name
                ),
                "choose a fabric of this pattern",
            );
        }
        let (Some(stage), Some(fabric)) = (stage, fabric) else {
            return;
        };
        let room = MAX_PIECES - self.drafting.draft.pieces.len();
        if panel.cut.quantity as usize > room {
            self.report(
                Severity::Error,
                Code::TooMany,
                place,
                format!(
                    "panel {:?} is cut {} times, which makes more than {MAX_PIECES} pieces",
                    panel.name, panel.cut.quantity
                ),
                "cut it less often",
            );
            return;
        }
        if panel.cut.mirrored && panel.cut.quantity % 2 == 1 {
            self.report(
                Severity::Warning,
                Code::OddPair,
                place,
                format!(
                    "panel {:?} is cut in mirrored pairs, but {} times",
                    panel.name, panel.cut.quantity
                ),
                "cut it an even number of times, or not mirrored",
            );
        }
        let pressed = press_arrows(&stage, self.evaluation.pattern(), panel);
        for copy in 0..panel.cut.quantity {
            let flipped = panel.cut.mirrored && copy % 2 == 1;
            let (stage, worn) = if flipped {
                (&stage.mirror_image(), worn.mirror_image())
            } else {
                (&*stage, worn)
            };
            let pressed = pressed.iter().map(|arrow| match flipped {
                true => arrow.mirror_image(),
                false => *arrow,
            });
            let name = self.piece_name(panel, copy, flipped);
            let id = PieceId {
                panel: panel.id,
                copy,
            };
            let pieces = &mut self.drafting.draft.pieces;
            self.tracks.insert(id, (pieces.len(), tracks(stage)));
            pieces.push(piece(id, name, stage, (fabric, worn, pressed.collect())));
        }
    }

    /// A name for a copy of a panel that no other piece has.
    fn piece_name(&self, panel: &Panel, copy: u32, flipped: bool) -> String {
        let base = match (copy, flipped) {
            (0, _) => panel.name.clone(),
            (1, true) => format!("{} mirrored", panel.name),
            _ => format!("{} {}", panel.name, copy + 1),
        };
        let pieces = &self.drafting.draft.pieces;
        let taken = |name: &str| pieces.iter().any(|piece| piece.name == name);
        let mut name = base.clone();
        let mut number = 2;
        while taken(&name) {
            name = format!("{base} ({number})");
            number += 1;
        }
        name
    }

    fn worn(&mut self, panel: &Panel) -> Worn {
        match &panel.worn {
            WornRule::Automatic => Worn::Automatic,
            WornRule::Wrapped {
                part,
                facing,
                level,
            } => Worn::Wrapped {
                part: *part,
                facing: *facing,
                level: level.as_ref().and_then(|level| self.level(panel, level)),
            },
            WornRule::Placed {
                translation,
                rotation,
            } => {
                let [x, y, z, w] = *rotation;
                let quaternion = nalgebra::Quaternion::new(w, x, y, z);
                let near = translation.iter().all(|v| v.abs() <= 1000.0);
                let turned = nalgebra::Unit::try_new(quaternion, 1e-6);
                match turned.filter(|q| near && q.coords.iter().all(|v| v.is_finite())) {
                    Some(rotation) => {
                        Worn::Placed(Rigid::from_parts(Vec3::from(*translation).into(), rotation))
                    }
                    None => {
                        self.report(
                            Severity::Error,
                            Code::NotFinite,
                            Place::Panel(panel.id),
                            format!("panel {:?} is placed nowhere", panel.name),
                            "give a place within 1 km and a rotation that is a unit quaternion",
                        );
                        Worn::Automatic
                    }
                }
            }
        }
    }

    fn level(&mut self, panel: &Panel, level: &Number) -> Option<f64> {
        let what = format!("panel {:?}, level it is worn at", panel.name);
        let place = Place::Panel(panel.id);
        let (value, found) = self.evaluation.length_of(level, &place, &what);
        self.drafting.diagnostics.extend(found);
        value
    }

    /// Adds the seams that close darts, in the order of pieces.
    fn darts(&mut self) {
        let pattern = self.evaluation.pattern();
        let mut seams = Vec::new();
        for (id, (piece, tracks)) in &self.tracks {
            let Some(panel) = pattern.panel(id.panel) else {
                continue;
            };
            let halves = 1_u8 << folds(panel);
            let lineage = pattern.lineage(panel).into_iter().rev();
            for operation in lineage.flat_map(|own| &own.operations) {
                for half in 0..halves {
                    let walked = |(role, index, reverse): Walked| -> Option<Vec<DraftSpan>> {
                        let by = operation.id;
                        let name = Name::Made { by, role, index };
                        let found = tracks.get(&EdgeOrigin { name, half })?.iter();
                        let (from, to) = if reverse { (1.0, 0.0) } else { (0.0, 1.0) };
                        Some(spans_on(*piece, found, from, to))
                    };
                    if let Some(sides) = closing(&operation.kind) {
                        let sides = sides.map(|legs| {
                            let legs: Option<Vec<_>> = legs.into_iter().map(walked).collect();
                            legs.map(|legs| legs.concat())
                        });
                        let [Some(first), Some(second)] = sides else {
                            continue;
                        };
                        let owner = &self.drafting.draft.pieces[*piece].name;
                        seams.push(DraftSeam {
                            id: SeamOrigin::Dart {
                                dart: operation.id,
                                copy: id.copy,
                                half,
                            },
                            name: format!("{} of {owner}", operation.name),
                            sides: [first, second],
                            gathered: false,
                            right_sides_together: true,
                            multi_ply: false,
                        });
                    }
                }
            }
        }
        self.drafting.eases.resize(seams.len(), 0.0);
        self.drafting.draft.seams = seams;
    }

    /// Adds the seams of the document, on the copies and halves of panels with which the pieces show their
    /// right sides.
    fn seams(&mut self) {
        let evaluation = self.evaluation;
        let seams = evaluation.pattern().seams.iter();
        let walked: Vec<(&Seam, &SeamValue)> = seams
            .filter_map(|seam| Some((&**seam, &**evaluation.seam_value(seam.id)?)))
            .filter(|(_, value)| {
                let mut spans = value.sides.iter().flatten();
                spans.all(|span| self.tracks.contains_key(&piece_id(span)))
            })
            .collect();
        let mut spans = Vec::new();
        let mut asked = Vec::new();
        for (number, (seam, value)) in walked.iter().enumerate() {
            let first = spans.len();
            let mut parts = [Vec::new(), Vec::new()];
            for (side, values) in value.sides.iter().enumerate() {
                for value in values {
                    parts[side].extend(SidePart::of(&self.drafting.draft, &self.spans(value)));
                    spans.push(SeamSpan {
                        seam: number,
                        side,
                        value,
                        twin: self.twin(value),
                    });
                }
            }
            let all = parts[0].len() + parts[1].len() == spans.len() - first;
            if all && seam.right_sides_together {
                let starts = [first, first + parts[0].len()];
                let found = meetings([&parts[0], &parts[1]]);
                asked.extend(found.into_iter().map(|meeting| Meeting {
                    spans: [0, 1].map(|side| starts[side] + meeting.spans[side]),
                    ..meeting
                }));
            }
        }
        let exchanged = choose(&spans, &asked);
        let mut taken = spans.iter().zip(&exchanged);
        for (seam, value) in &walked {
            let sides = [0, 1].map(|side| {
                let own = taken.by_ref().take(value.sides[side].len());
                let own = own.flat_map(|(span, taken)| match taken.exchanged {
                    true => self.spans(&span.exchanged()),
                    false => self.spans(span.value),
                });
                own.collect()
            });
            self.drafting.eases.push(value.ease);
            self.drafting.draft.seams.push(DraftSeam {
                id: SeamOrigin::Seam(seam.id),
                name: seam.name.clone(),
                sides,
                gathered: seam.gathered,
                right_sides_together: seam.right_sides_together,
                multi_ply: seam.multi_ply,
            });
        }
        self.tell_exchanges((&walked, &spans), &exchanged);
    }

    /// The stretches of edges of its piece that a span covers, in walking order.
    fn spans(&self, span: &SpanValue) -> Vec<DraftSpan> {
        let Some((piece, tracks)) = self.tracks.get(&piece_id(span)) else {
            return Vec::new();
        };
        let parts = span.stretch.iter().flat_map(|&(name, from, to)| {
            let half = span.half;
            let found = tracks.get(&EdgeOrigin { name, half }).into_iter().flatten();
            spans_on(*piece, found, from, to)
        });
        parts.collect()
    }

    /// The twin of a span: the other copy or half of the panel that the span may be moved to. `None`: the
    /// whole span does not exist there.
    fn twin(&self, span: &SpanValue) -> Option<Twin> {
        let panel = self.evaluation.pattern().panel(span.panel)?;
        let twin = match folds(panel) {
            0 if panel.cut.mirrored => Twin::Copy,
            0 => return None,
            _ => Twin::Half,
        };
        let there = twin.of(span);
        let count = self.spans(span).len();
        (self.spans(&there).len() == count).then_some(twin)
    }

    /// Reports, with one note for each panel, the seams that take another copy or half of the panel than the
    /// document gives.
    fn tell_exchanges(
        &mut self,
        (walked, spans): (&[(&Seam, &SeamValue)], &[SeamSpan<'_>]),
        taken: &[Taken],
    ) {
        let mut told: BTreeMap<(PanelId, Twin), BTreeSet<usize>> = BTreeMap::new();
        for (span, _) in spans.iter().zip(taken).filter(|(_, taken)| taken.is_needed) {
            if let Some(twin) = span.twin {
                let seams = told.entry((span.value.panel, twin)).or_default();
                seams.insert(span.seam);
            }
        }
        for ((id, twin), seams) in told {
            let Some(panel) = self.evaluation.pattern().panel(id) else {
                continue;
            };
            let names = seams.iter().map(|seam| &*walked[*seam].0.name);
            let what = exchange_words(twin, &panel.name, names);
            let hint = "nothing need be done; the pattern stays as it is written";
            let place = Place::Panel(id);
            self.report(Severity::Note, Code::OtherCopy, place, what, hint);
        }
    }

    /// Marks the pieces that seams join as sewn. If no seam joins pieces, and all pieces are copies of one
    /// panel, the first piece is marked.
    fn mark_sewn(&mut self) {
        let draft = &mut self.drafting.draft;
        for seam in &draft.seams {
            if matches!(seam.id, SeamOrigin::Seam(_)) {
                for span in seam.sides.iter().flatten() {
                    draft.pieces[span.piece].sewn = true;
                }
            }
        }
        let panels: BTreeSet<PanelId> = draft.pieces.iter().map(|p| p.id.panel).collect();
        if panels.len() == 1 && !draft.pieces.iter().any(|piece| piece.sewn) {
            draft.pieces[0].sewn = true;
        }
    }
}

/// The piece that a span is on.
fn piece_id(span: &SpanValue) -> PieceId {
    PieceId {
        panel: span.panel,
        copy: span.copy,
    }
}

/// An edge of a dart, as it is walked in the seam that closes the dart: role, index, and whether it is walked
/// backwards.
type Walked = (Role, u16, bool);

/// Both sides of the seam that closes the dart an operation makes. `None`: the operation makes no dart.
fn closing(kind: &OperationKind) -> Option<[Vec<Walked>; 2]> {
    let leg = |index: u16, reverse: bool| (Role::Leg, index, reverse);
    match kind {
        OperationKind::Dart { .. } | OperationKind::Pivot { .. } => {
            Some([vec![leg(0, false)], vec![leg(1, true)]])
        }
        OperationKind::Diamond { .. } => Some([
            vec![leg(0, false), leg(1, false)],
            vec![leg(3, true), leg(2, true)],
        ]),
        OperationKind::Fold { .. }
        | OperationKind::Spread { .. }
        | OperationKind::Split { .. }
        | OperationKind::Pleat { .. }
        | OperationKind::Insert { .. } => None,
    }
}

/// Number of folds along which a panel is unfolded, at most 7.
fn folds(panel: &Panel) -> u32 {
    let folds = panel
        .operations
        .iter()
        .filter(|o| matches!(o.kind, OperationKind::Fold { .. }));
    (folds.count() as u32).min(7)
}

/// Stretches of the edges of a piece that lie between the shares `from` and `to` of a named edge, in walking
/// order. `tracks` are the stretches of that edge on the piece.
fn spans_on<'t>(
    piece: usize,
    tracks: impl Iterator<Item = &'t Track>,
    from: f64,
    to: f64,
) -> Vec<DraftSpan> {
    let (low, high) = (from.min(to), from.max(to));
    let mut parts: Vec<(f64, DraftSpan)> = Vec::new();
    for track in tracks {
        let cut_low = track.from.min(track.to).max(low);
        let cut_high = track.from.max(track.to).min(high);
        if cut_high - cut_low < 1e-9 {
            continue;
        }
        let local = |f: f64| whole_at_ends((f - track.from) / (track.to - track.from));
        let (start, end) = match from < to {
            true => (cut_low, cut_high),
            false => (cut_high, cut_low),
        };
        parts.push((
            start,
            DraftSpan {
                piece,
                edge: track.edge,
                from: local(start),
                to: local(end),
            },
        ));
    }
    parts.sort_by(|a, b| a.0.total_cmp(&b.0));
    if from > to {
        parts.reverse();
    }
    parts.into_iter().map(|(_, span)| span).collect()
}

/// A share of an edge (1), set to 0 or 1 if it differs from that by rounding alone.
fn whole_at_ends(share: f64) -> f64 {
    match share {
        _ if share < 1e-12 => 0.0,
        _ if share > 1.0 - 1e-12 => 1.0,
        _ => share,
    }
}

fn piece(
    id: PieceId,
    name: String,
    stage: &Stage,
    (fabric, worn, pressed): (usize, Worn, Vec<PressArrow>),
) -> Piece {
    let edges = |edges: &[StageEdge]| edges.iter().map(piece_edge).collect();
    let inside = stage
        .lines
        .iter()
        .filter(|line| line.kind == LineKind::Internal);
    Piece {
        id,
        name,
        outline: edges(stage.outline()),
        holes: stage.holes().map(edges).collect(),
        internal_lines: inside
            .map(|line| PieceLine {
                name: line.name,
                curves: line.edges.iter().map(|edge| edge.curve).collect(),
            })
            .filter(|line| !line.curves.is_empty())
            .collect(),
        notches: stage
            .notches
            .iter()
            .map(|notch| PieceNotch {
                id: notch.id,
                edge: origin(notch.edge, notch.half),
                kind: notch.kind,
                point: notch.point,
                inward: notch.inward,
            })
            .collect(),
        darts: stage.darts.clone(),
        pressed,
        folds: stage.folds.iter().map(|fold| [fold.0, fold.1]).collect(),
        grain: stage.grain,
        fabric,
        worn,
        sewn: false,
    }
}

fn piece_edge(edge: &StageEdge) -> PieceEdge {
    PieceEdge {
        origin: origin(edge.name, edge.half),
        curve: edge.curve,
        seam_allowance: edge.allowance,
        corner: edge.corner,
        reversed: edge.from > edge.to,
    }
}

fn origin(name: EdgeName, half: u8) -> EdgeOrigin {
    EdgeOrigin { name, half }
}

fn tracks(stage: &Stage) -> Tracks {
    let mut tracks: Tracks = BTreeMap::new();
    let edges = stage.outline().iter().chain(stage.holes().flatten());
    for (edge, piece) in edges.enumerate() {
        let key = origin(piece.name, piece.half);
        tracks.entry(key).or_default().push(Track {
            edge,
            from: piece.from,
            to: piece.to,
        });
    }
    tracks
}
