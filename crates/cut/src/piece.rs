//! A piece as it is cut: everything that is drawn on it, each part with what it came from.
//!
//! # Decided with
//! - [`crate::seams`], [`crate::outline::cut_line`]: allowances, corners, darts and grain as drafted; the cut
//!   line;
//! - [`crate::notch_place::notches_of`], [`crate::notch_room`], [`crate::notch`]: where notches stand, how
//!   deep, their shapes;
//! - [`crate::press::fold_ticks`]: how darts and pleats are folded;
//! - [`crate::label_block`], [`crate::label::roomiest_of`]: words and where they go;
//! - [`crate::fold`]: halves and mirror images;
//! - [`crate::options::CutOptions`]: shrinkage and blocks of fusing;
//! - [`crate::drawing::Drawing`], [`crate::cut_list::CutList`]: its drawing; the list of pieces by fabric;
//! - [`crate::words::cut_diagnostics`], [`crate::names::edge_words`]: faults in words.

use crate::names::edge_words;
use crate::notch::CutNotch;
use crate::notch_place::notches_of;
use crate::notch_room::Room;
use crate::options::CutOptions;
use crate::outline::cut_line;
use crate::press::{FoldTick, fold_ticks, pressed};
use crate::ring::FLATNESS;
use crate::seams::{NamedSeam, Plane, seam_of};
use crate::{CutError, CutRing, EdgeIndex, Finding, SeamEdge, SegmentKind};
use toile_geometry::{Bounds2, Polygon, Vec2};
use toile_pattern::{
    CornerName, Draft, EdgeOrigin, LineName, Name, NotchId, Pattern, Piece, PieceId, PressArrow,
    Role,
};

/// Least depth of a notch (m): notches that are cut less deep are reported as short.
const SHORT_NOTCH: f64 = 0.0035;

/// Origin of a segment of a closed line of a cut piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum PieceSegment {
    /// On a cut line, the line in the allowance of an edge; on a line to sew along, the edge itself.
    Edge(EdgeOrigin),
    /// Cloth at the mouth of a dart; the edge is the leg that the segment lies beside.
    DartCap(EdgeOrigin),
    /// Cut line at a corner; the edge is the one that starts at the corner.
    Corner(EdgeOrigin),
    /// The fold of the cloth, which is not cut.
    Fold,
    /// Segment of unknown origin.
    Unknown,
}

/// A closed line of a cut piece.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PieceRing {
    /// Corners of the line (m); the first is not repeated.
    pub points: Vec<Vec2>,
    /// Origins of the segments, one for the segment from each corner to the next.
    pub segments: Vec<PieceSegment>,
}

/// A line drawn inside a cut piece.
#[derive(Clone, Debug, PartialEq)]
pub struct InsideLine {
    /// Name of the panel's line, or of the operation that made the line.
    pub name: LineName,
    /// Corners of the line (m).
    pub points: Vec<Vec2>,
}

/// A point to mark with a drill or a tack: the end of a dart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drill {
    /// Name of the corner that the dart made.
    pub name: CornerName,
    /// Number of the half of a folded panel that the point is on.
    pub half: u8,
    /// Position (m).
    pub at: Vec2,
}

/// The kind of a text on a cut piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum TextKind {
    /// The name of the piece.
    Name,
    /// The size that the piece is drafted to.
    Size,
    /// The number of pieces to cut.
    Count,
    /// The fabric that the piece is cut from.
    Fabric,
}

/// A text of a cut piece.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PieceText {
    /// Kind of the text.
    pub kind: TextKind,
    /// The words.
    pub text: String,
}

/// A piece as it is cut, as seen from the right side of the cloth. Lengths in metres, curves
/// flattened to [`FLATNESS`].
#[derive(Clone, Debug, PartialEq)]
pub struct CutPiece {
    /// The panel, and the number of the copy.
    pub id: PieceId,
    /// Name to show.
    pub name: String,
    /// The lines to cut along, the cloth at their left: the outline first, then holes.
    pub cut: Vec<PieceRing>,
    /// The lines to sew along: the outline first, then holes and darts inside the piece.
    pub sew: Vec<PieceRing>,
    /// Lines drawn inside the piece.
    pub inside: Vec<InsideLine>,
    /// The last fold line along which the piece was unfolded, with the side that was drawn. `None`: the piece
    /// was not unfolded.
    pub fold: Option<HalfPlane>,
    /// Ends of the fold (m), if this is half of a piece and is laid on the fold of the cloth.
    pub on_fold: Option<[Vec2; 2]>,
    /// Direction of the warp (rad), from +x counter-clockwise.
    pub grain: f64,
    /// Notches.
    pub notches: Vec<CutNotch>,
    /// Ends of darts, to be marked.
    pub drills: Vec<Drill>,
    /// Short lines at the cut line where legs of darts and lines of pleats meet it.
    pub fold_ticks: Vec<FoldTick>,
    /// Directions in which the darts and pleats are pressed.
    pub pressed: Vec<PressArrow>,
    /// Texts to write on the piece.
    pub texts: Vec<PieceText>,
    /// Faults of the cut line.
    pub findings: Vec<Finding>,
    /// Edges of the pattern by [`EdgeIndex`], loop by loop: findings give edges by such numbers.
    pub(crate) names: Vec<Vec<EdgeOrigin>>,
    /// Width of the allowance asked for beside each of these edges (m).
    pub(crate) widths: Vec<Vec<f64>>,
    /// First leg of each dart by the dart's number in findings.
    pub(crate) darts: Vec<EdgeOrigin>,
}

/// A line, and the side of it that is kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfPlane {
    /// A point on the line (m).
    pub at: Vec2,
    /// Unit vector to the side that is kept.
    pub inward: Vec2,
}

/// Reason why a piece of a draft cannot be cut.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PieceError {
    /// No cut line can be made for the seam line: the reason in words.
    #[error("{0}")]
    Cut(String),
    /// The draft has no piece of this number.
    #[error("there is no piece of number {0}")]
    NoPiece(usize),
}

impl CutPiece {
    /// A piece of a draft as it is cut. `size` is written on the piece if it is given.
    ///
    /// # Errors
    /// [`PieceError`] if there is no piece of this number, or the piece has no cut line.
    pub fn new(
        (pattern, draft): (&Pattern, &Draft),
        number: usize,
        (size, options): (Option<&str>, &CutOptions),
    ) -> Result<Self, PieceError> {
        let piece = draft.pieces.get(number);
        let piece = piece.ok_or(PieceError::NoPiece(number))?;
        let plane = Plane::new(piece, options);
        let seam = seam_of(piece, &plane, options);
        let line = cut_line(&seam.line)
            .map_err(|error| PieceError::Cut(error_words((pattern, piece), &seam, &error)))?;
        let named = |ring: &CutRing| PieceRing {
            points: ring.points.clone(),
            segments: ring
                .origins
                .iter()
                .map(|origin| {
                    let edge = name_of(&seam.names, origin.edge);
                    match (origin.kind, edge) {
                        (_, None) => PieceSegment::Unknown,
                        (SegmentKind::Edge, Some(edge)) => PieceSegment::Edge(edge),
                        (SegmentKind::DartCap, Some(edge)) => PieceSegment::DartCap(edge),
                        (SegmentKind::Corner, Some(edge)) => PieceSegment::Corner(edge),
                    }
                })
                .collect(),
        };
        let rings = std::iter::once(&line.outline).chain(&line.holes);
        let cut: Vec<PieceRing> = rings.map(named).collect();
        let sew = sewn(&seam);
        // Darts inside the piece are sewn but not cut out: they do not limit the room for notches.
        let room = Room {
            cut: polygon_of(&cut),
            sewn: polygon_of(&sew[..seam.names.len()]),
        };
        let notches = notches_of(piece, &plane, &seam, &room);
        let fold_ticks = fold_ticks(piece, &plane, &seam, (&room, &notches));
        let mut findings = line.findings;
        findings.extend(notch_findings(&notches));
        Ok(Self {
            id: piece.id,
            name: piece.name.clone(),
            notches,
            cut,
            sew,
            inside: inside_lines(piece, &plane),
            fold: last_fold(piece, &plane),
            on_fold: None,
            grain: plane.grain(piece.grain),
            drills: drills(&seam),
            fold_ticks,
            pressed: pressed(piece, &plane),
            texts: texts((pattern, draft), piece, size),
            findings,
            darts: seam
                .line
                .darts
                .iter()
                .filter_map(|dart| {
                    name_of(
                        &seam.names,
                        EdgeIndex {
                            ring: 0,
                            edge: dart.legs[0],
                        },
                    )
                })
                .collect(),
            widths: widths(&seam),
            names: seam.names,
        })
    }

    /// A piece of which only the cut line is known.
    pub fn of_outline(name: &str, outline: &Polygon, grain: f64) -> Self {
        let ring = |points: &Vec<Vec2>| PieceRing {
            points: points.clone(),
            segments: vec![PieceSegment::Unknown; points.len()],
        };
        Self {
            id: PieceId {
                panel: toile_pattern::PanelId(0),
                copy: 0,
            },
            name: name.to_owned(),
            cut: outline.rings().map(ring).collect(),
            sew: Vec::new(),
            inside: Vec::new(),
            fold: None,
            on_fold: None,
            grain,
            notches: Vec::new(),
            drills: Vec::new(),
            fold_ticks: Vec::new(),
            pressed: Vec::new(),
            texts: vec![PieceText {
                kind: TextKind::Name,
                text: name.to_owned(),
            }],
            findings: Vec::new(),
            names: Vec::new(),
            widths: Vec::new(),
            darts: Vec::new(),
        }
    }

    /// Whether all numbers of the piece are finite.
    pub fn is_finite(&self) -> bool {
        let rings = self.cut.iter().chain(&self.sew).map(|ring| &ring.points);
        let lines = rings.chain(self.inside.iter().map(|line| &line.points));
        let notches = self.notches.iter();
        let notches = notches.flat_map(|n| [n.point, n.inward, n.on_cut, n.along]);
        let cuts = self.notches.iter().flat_map(|n| n.cut.iter().flatten());
        let drills = self.drills.iter().map(|drill| drill.at);
        let ticks = self.fold_ticks.iter().flat_map(|tick| &tick.ends);
        let arrows = self.pressed.iter().flat_map(|arrow| [arrow.at, arrow.way]);
        let points = lines.flatten().chain(cuts).chain(ticks).copied();
        let mut points = points.chain(notches).chain(drills).chain(arrows);
        points.all(|p| p.x.is_finite() && p.y.is_finite()) && self.grain.is_finite()
    }

    /// Shape of the piece as cut, with its holes.
    pub fn polygon(&self) -> Polygon {
        polygon_of(&self.cut)
    }

    /// The outline of the piece as cut, without its holes, as it is laid on fabric.
    pub fn outer(&self) -> Polygon {
        Polygon::new(self.cut.first().map_or_else(Vec::new, |r| r.points.clone()))
    }

    /// Shape of the piece inside its seam lines.
    pub fn sewn(&self) -> Polygon {
        polygon_of(&self.sew)
    }

    /// Box of the piece as cut (m).
    pub fn bounds(&self) -> Bounds2 {
        self.outer().bounds()
    }

    /// The text of this kind, if the piece has one.
    pub fn text(&self, kind: TextKind) -> Option<&str> {
        let found = self.texts.iter().find(|text| text.kind == kind);
        found.map(|text| &*text.text)
    }

    /// Width of the allowance asked for along an edge (m): `index` numbers the edge as faults of the cut line
    /// do. `None` if the piece has no such edge.
    pub(crate) fn width(&self, index: EdgeIndex) -> Option<f64> {
        self.widths.get(index.ring)?.get(index.edge).copied()
    }

    /// Edge of the pattern for the number of an edge in a finding.
    pub fn edge(&self, index: EdgeIndex) -> Option<EdgeOrigin> {
        name_of(&self.names, index)
    }
}

fn polygon_of(rings: &[PieceRing]) -> Polygon {
    let mut points = rings.iter().map(|ring| ring.points.clone());
    Polygon {
        outer: points.next().unwrap_or_default(),
        holes: points.collect(),
    }
}

fn name_of(names: &[Vec<EdgeOrigin>], index: EdgeIndex) -> Option<EdgeOrigin> {
    names.get(index.ring)?.get(index.edge).copied()
}

fn widths(seam: &NamedSeam) -> Vec<Vec<f64>> {
    let loops = std::iter::once(&seam.line.outline).chain(&seam.line.holes);
    let width = |edges: &Vec<SeamEdge>| edges.iter().map(|edge| edge.width).collect();
    loops.map(width).collect()
}

/// The last fold line along which a piece was unfolded, with the side that was drawn: everything drawn before
/// that fold lies on that side.
fn last_fold(piece: &Piece, plane: &Plane) -> Option<HalfPlane> {
    let bit = 1_u8 << piece.folds.len().checked_sub(1)?.min(7);
    let [at, way] = *piece.folds.last()?;
    let at = plane.vector(at);
    let across = plane.normal(Vec2::new(-way.y, way.x));
    let drawn = piece.outline.iter().filter(|e| e.origin.half & bit == 0);
    let depths = drawn.map(|edge| (plane.vector(edge.curve.point(0.5)) - at).dot(&across));
    let side: f64 = depths.sum();
    Some(HalfPlane {
        at,
        inward: across * if side >= 0.0 { 1.0 } else { -1.0 },
    })
}

/// The lines a piece is sewn along.
fn sewn(seam: &NamedSeam) -> Vec<PieceRing> {
    let ring = |(edges, names): (&[SeamEdge], &[EdgeOrigin])| {
        let mut ring = PieceRing::default();
        for (edge, name) in edges.iter().zip(names) {
            let points = edge.curve.flatten(FLATNESS);
            for &p in &points[..points.len().saturating_sub(1)] {
                ring.points.push(p);
                ring.segments.push(PieceSegment::Edge(*name));
            }
        }
        ring
    };
    seam.loops().map(ring).collect()
}

/// Findings about notches: those in a narrow allowance, and those without an allowance.
fn notch_findings(notches: &[CutNotch]) -> Vec<Finding> {
    let of = |wanted: &dyn Fn(&CutNotch) -> bool| {
        let mut ids: Vec<NotchId> = Vec::new();
        for notch in notches.iter().filter(|notch| wanted(notch)) {
            if !ids.contains(&notch.id) {
                ids.push(notch.id);
            }
        }
        ids
    };
    let is_short = |notch: &CutNotch| !notch.cut.is_empty() && notch.depth < SHORT_NOTCH;
    let short = of(&is_short);
    let depths = notches.iter().filter(|n| is_short(n)).map(|n| n.depth);
    let least = depths.fold(SHORT_NOTCH, f64::min);
    let drawn = of(&|notch| notch.cut.is_empty());
    let short = (!short.is_empty()).then_some(Finding::NotchesShort {
        notches: short,
        depth: least,
    });
    let drawn = (!drawn.is_empty()).then_some(Finding::NotchesDrawn { notches: drawn });
    short.into_iter().chain(drawn).collect()
}

fn inside_lines(piece: &Piece, plane: &Plane) -> Vec<InsideLine> {
    let line = |line: &toile_pattern::PieceLine| {
        let mut points: Vec<Vec2> = Vec::new();
        for curve in line.curves.iter().flat_map(|&c| plane.curves(c)) {
            let part = curve.flatten(FLATNESS);
            points.extend(&part[usize::from(!points.is_empty()).min(part.len())..]);
        }
        InsideLine {
            name: line.name,
            points,
        }
    };
    piece.internal_lines.iter().map(line).collect()
}

/// Ends of darts: the apex of each dart in the outline, and the corners of each dart inside the piece.
fn drills(seam: &NamedSeam) -> Vec<Drill> {
    let outline = seam.names.first().map_or(&[][..], |names| names);
    let mut found = Vec::new();
    for dart in &seam.line.darts {
        let [_, second] = dart.legs;
        if let Some((by, _)) = outline.get(second).and_then(EdgeOrigin::leg) {
            found.push(Drill {
                name: Name::Made {
                    by,
                    role: Role::Apex,
                    index: 0,
                },
                half: outline[second].half,
                at: seam.line.outline[second].curve.start(),
            });
        }
    }
    for (edges, names) in &seam.sewn_only {
        for (edge, name) in edges.iter().zip(names) {
            if let Some((by, leg)) = name.leg() {
                found.push(Drill {
                    name: Name::Made {
                        by,
                        role: Role::Mouth,
                        index: leg,
                    },
                    half: name.half,
                    at: edge.curve.start(),
                });
            }
        }
    }
    found
}

fn texts(
    (pattern, draft): (&Pattern, &Draft),
    piece: &Piece,
    size: Option<&str>,
) -> Vec<PieceText> {
    let cut = pattern.panel(piece.id.panel).map(|panel| panel.cut);
    let count = cut.map(|cut| match (cut.quantity, cut.mirrored) {
        (2, true) => "cut 1 pair".to_owned(),
        (n, true) if n % 2 == 0 => format!("cut {} pairs", n / 2),
        (n, true) => format!("cut {n}, every second one mirrored"),
        (n, false) => format!("cut {n}"),
    });
    let fabric = draft.fabrics.get(piece.fabric).map(|f| f.name.clone());
    let all = [
        (TextKind::Name, Some(piece.name.clone())),
        (TextKind::Size, size.map(|size| format!("size {size}"))),
        (TextKind::Count, count),
        (TextKind::Fabric, fabric),
    ];
    all.into_iter()
        .filter_map(|(kind, text)| Some(PieceText { kind, text: text? }))
        .collect()
}

/// Words for the reason why a seam line has no cut line, with the names of the edges.
fn error_words((pattern, piece): (&Pattern, &Piece), seam: &NamedSeam, error: &CutError) -> String {
    let words = |index: EdgeIndex| match name_of(&seam.names, index) {
        Some(origin) => {
            let panel = pattern.panel(piece.id.panel);
            let lineage = panel.map_or_else(Vec::new, |panel| pattern.lineage(panel));
            edge_words(&lineage, origin)
        }
        None => "an edge".to_owned(),
    };
    match error {
        CutError::NotFinite(edge) => {
            format!(
                "{} has a coordinate that is not a finite number",
                words(*edge)
            )
        }
        CutError::Width(edge) => format!(
            "{} has an allowance that is negative or not a finite number",
            words(*edge)
        ),
        CutError::Limit(edge) => format!(
            "{} starts at a corner whose limit is not from 1 to 100",
            words(*edge)
        ),
        CutError::Open(edge, gap) => format!(
            "{} ends {:.3} mm from where the next edge starts",
            words(*edge),
            gap * 1e3
        ),
        CutError::NoArea(_) => "a line encloses nothing".to_owned(),
        CutError::Crossing(one, other, at) => format!(
            "{} and {} meet near x = {:.1} cm, y = {:.1} cm",
            words(*one),
            words(*other),
            at.x * 1e2,
            at.y * 1e2
        ),
        CutError::StrayHole(_) => "a hole lies outside the outline or in another hole".to_owned(),
        CutError::Dart(k) => {
            let leg = seam.line.darts.get(*k).map(|dart| dart.legs[0]);
            let leg = leg.map(|edge| words(EdgeIndex { ring: 0, edge }));
            format!(
                "{} points outwards",
                leg.unwrap_or_else(|| "a dart".to_owned())
            )
        }
    }
}
