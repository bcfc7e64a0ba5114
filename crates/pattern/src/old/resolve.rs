//! From the document to the draft: one set of measurements, plain numbers.

use crate::resolver::{Resolver, Want};
use crate::shape::{Shape, ShapeEdge, shape};
use crate::{
    BodyPart, Code, DartShape, Diagnostic, Draft, DraftSeam, DraftSpan, EdgeOrigin, Facing, Panel,
    PanelId, Pattern, Piece, PieceEdge, PieceId, PieceLine, PieceNotch, Place, Seam, SeamOrigin,
    Span, Worn, WornRule,
};
use std::collections::{BTreeMap, BTreeSet};
use toile_geometry::{Rigid, Vec3};
use toile_measure::Measurements;

/// Most pieces a draft may have.
const MOST_PIECES: usize = 2000;

/// A draft with what only its checks need.
pub(crate) struct Resolution {
    pub draft: Draft,
    pub diagnostics: Vec<Diagnostic>,
    /// How much longer one side of each draft seam may be [m].
    pub eases: Vec<f64>,
}

impl Pattern {
    /// The draft for a table of measurements, and everything that kept parts out of it.
    ///
    /// Measurements that are not given are taken from the base size, with a note. Panels that
    /// cannot be drawn and seams that cannot be walked are left out, with an error each.
    pub fn resolve(&self, measurements: &Measurements) -> (Draft, Vec<Diagnostic>) {
        let resolution = resolve(self, measurements);
        (resolution.draft, resolution.diagnostics)
    }
}

pub(crate) fn resolve(pattern: &Pattern, measurements: &Measurements) -> Resolution {
    let mut resolver = Resolver::new(pattern, measurements);
    resolver.all_variables();
    report_duplicates(pattern, &mut resolver.diagnostics);
    let mut drafter = Drafter {
        pattern,
        resolver,
        draft: Draft {
            name: pattern.name.clone(),
            fabrics: pattern.fabrics.iter().map(|f| (**f).clone()).collect(),
            ..Draft::default()
        },
        eases: Vec::new(),
        tracks: BTreeMap::new(),
    };
    for index in 0..pattern.panels.len() {
        drafter.panel(index);
    }
    drafter.darts();
    for seam in &pattern.seams {
        drafter.seam(seam);
    }
    drafter.mark_sewn();
    drafter.resolver.note_borrowed();
    Resolution {
        draft: drafter.draft,
        diagnostics: drafter.resolver.diagnostics,
        eases: drafter.eases,
    }
}

/// Ids must be unique, or seams would mean two things.
fn report_duplicates(pattern: &Pattern, diagnostics: &mut Vec<Diagnostic>) {
    let mut report = |place: Place, what: String| {
        diagnostics.push(Diagnostic::error(
            Code::Duplicate,
            place,
            format!("two parts have the id {what}"),
            "renumber one of them",
        ));
    };
    let mut panels = BTreeSet::new();
    let mut darts = BTreeSet::new();
    for panel in &pattern.panels {
        if !panels.insert(panel.id) {
            report(Place::Panel(panel.id), panel.id.to_string());
        }
        for dart in &panel.darts {
            if !darts.insert(dart.id) {
                report(Place::Dart(panel.id, dart.id), dart.id.to_string());
            }
        }
    }
    let mut seams = BTreeSet::new();
    for seam in &pattern.seams {
        if !seams.insert(seam.id) {
            report(Place::Seam(seam.id), seam.id.to_string());
        }
    }
    let mut fabrics = BTreeSet::new();
    for fabric in &pattern.fabrics {
        if !fabrics.insert(fabric.id) {
            report(Place::Fabric(fabric.id), fabric.id.to_string());
        }
    }
}

/// A stretch of an origin on a piece: index of the piece's edge and the fractions it covers.
#[derive(Clone, Copy)]
struct Track {
    edge: usize,
    from: f64,
    to: f64,
}

type Tracks = BTreeMap<EdgeOrigin, Vec<Track>>;

struct Drafter<'a> {
    pattern: &'a Pattern,
    resolver: Resolver<'a>,
    draft: Draft,
    eases: Vec<f64>,
    /// Per piece of cloth: index in the draft, and where every document edge went.
    tracks: BTreeMap<PieceId, (usize, Tracks)>,
}

impl<'a> Drafter<'a> {
    fn error(&mut self, code: Code, place: Place, message: String, hint: &str) {
        self.resolver
            .diagnostics
            .push(Diagnostic::error(code, place, message, hint));
    }

    fn panel(&mut self, index: usize) {
        let pattern = self.pattern;
        let panel: &'a Panel = &pattern.panels[index];
        let place = Place::Panel(panel.id);
        let shape = shape(&mut self.resolver, index, panel);
        let worn = self.worn(panel);
        let fabric = pattern.fabrics.iter().position(|f| f.id == panel.fabric);
        if fabric.is_none() {
            self.error(
                Code::MissingReference,
                place.clone(),
                format!(
                    "panel {:?} is cut from a fabric that is not there",
                    panel.name
                ),
                "choose a fabric of this pattern",
            );
        }
        if shape.is_none() && panel.outline.is_empty() {
            self.error(
                Code::EmptyOutline,
                place.clone(),
                format!("panel {:?} has no outline", panel.name),
                "draw its outline or remove the panel",
            );
        }
        let (Some(shape), Some(fabric)) = (shape, fabric) else {
            return;
        };
        let room = MOST_PIECES - self.draft.pieces.len();
        if panel.cut.quantity as usize > room {
            self.error(
                Code::TooMany,
                place,
                format!(
                    "panel {:?} is cut {} times, which makes more than {MOST_PIECES} pieces",
                    panel.name, panel.cut.quantity
                ),
                "cut it less often",
            );
            return;
        }
        if panel.cut.mirrored && panel.cut.quantity % 2 == 1 {
            self.resolver.diagnostics.push(Diagnostic::warning(
                Code::OddPair,
                place,
                format!(
                    "panel {:?} is cut in mirrored pairs, but {} times",
                    panel.name, panel.cut.quantity
                ),
                "cut it an even number of times, or not mirrored",
            ));
        }
        for copy in 0..panel.cut.quantity {
            let flipped = panel.cut.mirrored && copy % 2 == 1;
            let (shape, worn) = if flipped {
                (&shape.mirror_image(), mirrored_worn(worn))
            } else {
                (&shape, worn)
            };
            let name = self.piece_name(panel, copy, flipped);
            let id = PieceId {
                panel: panel.id,
                copy,
            };
            self.tracks
                .insert(id, (self.draft.pieces.len(), tracks(shape)));
            self.draft.pieces.push(Piece {
                id,
                name,
                outline: shape.outline.iter().map(piece_edge).collect(),
                holes: shape
                    .holes
                    .iter()
                    .map(|hole| hole.iter().map(piece_edge).collect())
                    .collect(),
                internal_lines: shape
                    .lines
                    .iter()
                    .map(|(id, curves)| PieceLine {
                        id: *id,
                        curves: curves.clone(),
                    })
                    .collect(),
                notches: shape
                    .notches
                    .iter()
                    .map(|&(id, point, inward)| PieceNotch { id, point, inward })
                    .collect(),
                grain: shape.grain,
                fabric,
                worn,
                sewn: false,
            });
        }
    }

    /// A name for a copy that no other piece has.
    fn piece_name(&self, panel: &Panel, copy: u32, flipped: bool) -> String {
        let base = match (copy, flipped) {
            (0, _) => panel.name.clone(),
            (1, true) => format!("{} mirrored", panel.name),
            _ => format!("{} {}", panel.name, copy + 1),
        };
        let taken = |name: &str| self.draft.pieces.iter().any(|piece| piece.name == name);
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
            } => {
                let place = Place::Panel(panel.id);
                let what = format!("panel {:?}, level it is worn at", panel.name);
                let level = level
                    .as_ref()
                    .and_then(|level| self.resolver.number(level, Want::Length, &place, &what));
                Worn::Wrapped {
                    part: *part,
                    facing: *facing,
                    level,
                }
            }
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
                        self.error(
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

    /// Seams that close darts, in the order of pieces.
    fn darts(&mut self) {
        let pattern = self.pattern;
        let mut seams = Vec::new();
        for (id, (piece, tracks)) in &self.tracks {
            let Some(panel) = pattern.panel(id.panel) else {
                continue;
            };
            for dart in &panel.darts {
                for reflected in [false, true] {
                    let leg = |leg: u8, reverse: bool| -> Option<DraftSpan> {
                        let origin = EdgeOrigin::DartLeg {
                            dart: dart.id,
                            reflected,
                            leg,
                        };
                        let track = tracks.get(&origin)?.first()?;
                        let backwards = (track.from > track.to) != reverse;
                        Some(DraftSpan {
                            piece: *piece,
                            edge: track.edge,
                            from: f64::from(u8::from(backwards)),
                            to: f64::from(u8::from(!backwards)),
                        })
                    };
                    let sides = match dart.shape {
                        DartShape::Edge { .. } => [vec![leg(0, false)], vec![leg(1, true)]],
                        DartShape::Diamond { .. } => [
                            vec![leg(0, false), leg(1, false)],
                            vec![leg(3, true), leg(2, true)],
                        ],
                    };
                    let sides = sides.map(|s| s.into_iter().collect::<Option<Vec<_>>>());
                    if let [Some(first), Some(second)] = sides {
                        seams.push(DraftSeam {
                            id: SeamOrigin::Dart {
                                dart: dart.id,
                                copy: id.copy,
                                reflected,
                            },
                            name: format!("{} of {}", dart.name, self.draft.pieces[*piece].name),
                            sides: [first, second],
                            gathered: false,
                            right_sides_together: true,
                            multi_ply: false,
                        });
                    }
                }
            }
        }
        self.eases.resize(seams.len(), 0.0);
        self.draft.seams = seams;
    }

    fn seam(&mut self, seam: &Seam) {
        let place = Place::Seam(seam.id);
        let what = format!("seam {:?}, ease", seam.name);
        let ease = self
            .resolver
            .number(&seam.ease, Want::Length, &place, &what)
            .unwrap_or(0.0);
        let mut sides = [Vec::new(), Vec::new()];
        let mut complete = true;
        for (side, spans) in seam.sides.iter().enumerate() {
            for span in spans {
                match self.span(seam, span) {
                    Some(found) => sides[side].extend(found),
                    None => complete = false,
                }
            }
            if complete && sides[side].is_empty() {
                complete = false;
                self.error(
                    Code::MissingSpan,
                    place.clone(),
                    format!("seam {:?} has an empty side", seam.name),
                    "name at least one edge on each side",
                );
            }
        }
        if !complete {
            return;
        }
        self.eases.push(ease);
        self.draft.seams.push(DraftSeam {
            id: SeamOrigin::Seam(seam.id),
            name: seam.name.clone(),
            sides,
            gathered: seam.gathered,
            right_sides_together: seam.right_sides_together,
            multi_ply: seam.multi_ply,
        });
    }

    /// Fractions of a span, checked.
    fn fractions(&mut self, seam: &Seam, span: &Span) -> Option<(f64, f64)> {
        let place = Place::Seam(seam.id);
        let what = format!("seam {:?}, span", seam.name);
        let from = self
            .resolver
            .number(&span.from, Want::Plain, &place, &what)?;
        let to = self.resolver.number(&span.to, Want::Plain, &place, &what)?;
        let inside = |f: f64| (-1e-9..=1.0 + 1e-9).contains(&f);
        if !inside(from) || !inside(to) || (from - to).abs() < 1e-9 {
            self.error(
                Code::BadSpan,
                place,
                format!(
                    "seam {:?}: a span from {from} to {to} of an edge",
                    seam.name
                ),
                "use two different fractions from 0 to 1",
            );
            return None;
        }
        Some((from.clamp(0.0, 1.0), to.clamp(0.0, 1.0)))
    }

    /// Where a span of the document lies in the draft; nothing if it is not there.
    fn span(&mut self, seam: &Seam, span: &Span) -> Option<Vec<DraftSpan>> {
        let (from, to) = self.fractions(seam, span)?;
        let id = PieceId {
            panel: span.panel,
            copy: span.copy,
        };
        let origin = EdgeOrigin::Edge {
            edge: span.edge,
            reflected: span.reflected,
        };
        let found = self
            .tracks
            .get(&id)
            .and_then(|(piece, tracks)| Some((*piece, tracks.get(&origin)?)));
        let Some((piece, tracks)) = found else {
            let (message, hint) = self.missing(seam, span);
            self.error(Code::MissingSpan, Place::Seam(seam.id), message, hint);
            return None;
        };
        let (low, high) = (from.min(to), from.max(to));
        let mut parts: Vec<(f64, DraftSpan)> = Vec::new();
        for track in tracks {
            let cut_low = track.from.min(track.to).max(low);
            let cut_high = track.from.max(track.to).min(high);
            if cut_high - cut_low < 1e-9 {
                continue;
            }
            let local = |f: f64| ((f - track.from) / (track.to - track.from)).clamp(0.0, 1.0);
            let (start, end) = if from < to {
                (cut_low, cut_high)
            } else {
                (cut_high, cut_low)
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
        Some(parts.into_iter().map(|(_, span)| span).collect())
    }

    /// What of a span is missing, and what to do.
    fn missing(&self, seam: &Seam, span: &Span) -> (String, &'static str) {
        let name = &seam.name;
        let Some(panel) = self.pattern.panel(span.panel) else {
            return (
                format!("seam {name:?} names {}, which is not there", span.panel),
                "name a panel of this pattern, or remove the seam",
            );
        };
        let panel_name = &panel.name;
        if span.copy >= panel.cut.quantity {
            return (
                format!(
                    "seam {name:?} names copy {} of panel {panel_name:?}, which is cut {} times",
                    span.copy, panel.cut.quantity
                ),
                "cut the panel more often, or name another copy (they count from 0)",
            );
        }
        let Some(edge) = panel.edge(span.edge) else {
            return (
                format!(
                    "seam {name:?} names {} of panel {panel_name:?}, which is not there",
                    span.edge
                ),
                "name an edge of that panel, or remove the seam",
            );
        };
        let edge_name = &edge.name;
        if panel.fold == Some(span.edge) {
            return (
                format!("seam {name:?} names edge {edge_name:?} of panel {panel_name:?}, its fold"),
                "sew another edge, or cut the panel without a fold",
            );
        }
        if span.reflected && panel.fold.is_none() {
            return (
                format!(
                    "seam {name:?} names the reflected edge {edge_name:?} of panel \
                     {panel_name:?}, which has no fold"
                ),
                "put the panel on the fold, or name the edge itself",
            );
        }
        (
            format!(
                "seam {name:?} names edge {edge_name:?} of panel {panel_name:?}, which could not \
                 be drawn"
            ),
            "mend the panel first",
        )
    }

    /// A piece is sewn if a seam names it, or if it is all there is.
    fn mark_sewn(&mut self) {
        let pieces = &mut self.draft.pieces;
        for seam in &self.draft.seams {
            if matches!(seam.id, SeamOrigin::Seam(_)) {
                for span in seam.sides.iter().flatten() {
                    pieces[span.piece].sewn = true;
                }
            }
        }
        let panels: BTreeSet<PanelId> = pieces.iter().map(|piece| piece.id.panel).collect();
        if panels.len() == 1 && !pieces.iter().any(|piece| piece.sewn) {
            pieces[0].sewn = true;
        }
    }
}

fn tracks(shape: &Shape) -> Tracks {
    let mut tracks: Tracks = BTreeMap::new();
    let edges = shape.outline.iter().chain(shape.holes.iter().flatten());
    for (edge, piece) in edges.enumerate() {
        tracks.entry(piece.origin).or_default().push(Track {
            edge,
            from: piece.from,
            to: piece.to,
        });
    }
    tracks
}

fn piece_edge(edge: &ShapeEdge) -> PieceEdge {
    PieceEdge {
        origin: edge.origin,
        curve: edge.curve,
        seam_allowance: edge.seam_allowance,
    }
}

/// The place of a mirror image: the other side of the body.
fn mirrored_worn(worn: Worn) -> Worn {
    match worn {
        Worn::Automatic => Worn::Automatic,
        Worn::Wrapped {
            part,
            facing,
            level,
        } => Worn::Wrapped {
            part: match part {
                BodyPart::LeftArm => BodyPart::RightArm,
                BodyPart::RightArm => BodyPart::LeftArm,
                BodyPart::LeftLeg => BodyPart::RightLeg,
                BodyPart::RightLeg => BodyPart::LeftLeg,
                middle => middle,
            },
            facing: match facing {
                Facing::Left if is_middle(part) => Facing::Right,
                Facing::Right if is_middle(part) => Facing::Left,
                other => other,
            },
            level,
        },
        Worn::Placed(rigid) => {
            let t = rigid.translation.vector;
            let q = rigid.rotation.into_inner();
            let mirrored = nalgebra::Quaternion::new(q.w, q.i, -q.j, -q.k);
            Worn::Placed(Rigid::from_parts(
                Vec3::new(-t.x, t.y, t.z).into(),
                nalgebra::Unit::new_normalize(mirrored),
            ))
        }
    }
}

/// Whether left and right of that part are the wearer's own. Of an arm they are above and below.
fn is_middle(part: BodyPart) -> bool {
    !matches!(part, BodyPart::LeftArm | BodyPart::RightArm)
}
