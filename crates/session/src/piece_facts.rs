//! A pattern's pieces and seams in numbers, for programs: millimetres, square centimetres, degrees.

use crate::report::span_length;
use serde::Serialize;
use toile_cut::{CutOptions, CutPiece, PieceRing};
use toile_geometry::{Bounds2, Polygon, Vec2};
use toile_pattern::walk::{Joint, Walk};
use toile_pattern::{
    Corner, Draft, DraftSeam, EdgeOrigin, Evaluation, NotchKind, Panel, PanelId, Pattern, Piece,
    PieceEdge, Pressed,
};

/// A piece in numbers. Positions are in the plane of the piece, seen from the right side of the cloth.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PieceFacts {
    /// Name of the piece; no other has it.
    pub name: String,
    /// The panel it is a copy of.
    pub panel: String,
    /// Number of the copy, from 0.
    pub copy: u32,
    /// The size it is drafted to, if it is one of the pattern's.
    pub size: Option<String>,
    /// The fabric.
    pub fabric: String,
    /// Direction of the warp, counter-clockwise from +x (deg).
    pub grain_deg: f64,
    /// Whether the piece was unfolded from a folded panel.
    pub folded: bool,
    /// Region within the sewing lines.
    pub sewn: RegionFacts,
    /// Region within the cut lines.
    pub cut: RegionFacts,
    /// The edges of the outline, then those of holes.
    pub edges: Vec<EdgeFacts>,
    /// Notches of the piece.
    pub notches: Vec<NotchFacts>,
    /// Darts of the piece.
    pub darts: Vec<DartFacts>,
}

/// A region of cloth.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RegionFacts {
    /// Area, holes taken out (cm2).
    pub area_cm2: f64,
    /// Least and greatest x and y (mm).
    pub bounds_mm: [[f64; 2]; 2],
    /// Length of the outline, holes left out (mm).
    pub outline_mm: f64,
}

/// An edge. A spline is several edges of one name.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EdgeFacts {
    /// Name of the edge, or of the operation that made it.
    pub name: String,
    /// Half of a folded panel: 0 as drawn; one bit for each fold, set beyond the fold.
    pub half: u8,
    /// Length along the seam line (mm).
    pub length_mm: f64,
    /// Width of the seam allowance (mm).
    pub allowance_mm: f64,
    /// Corner of the cut line at the start of the edge: mitre, bevel, square, extended or mirrored.
    pub corner: &'static str,
}

/// A notch.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NotchFacts {
    /// Name of the notch.
    pub name: String,
    /// Name of the edge that the notch is on.
    pub edge: String,
    /// Half of a folded panel that the notch is on, as in [`EdgeFacts::half`].
    pub half: u8,
    /// Kind: slit, v, castle, t or check.
    pub kind: &'static str,
    /// Position on the seam line (mm).
    pub seam_mm: [f64; 2],
    /// Position on the cut line (mm).
    pub cut_mm: [f64; 2],
    /// Depth of the cut (mm); 0 if the notch is drawn on the seam line.
    pub depth_mm: f64,
}

/// A dart.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DartFacts {
    /// Name of the dart.
    pub name: String,
    /// Half of a folded panel that the dart is on, as in [`EdgeFacts::half`].
    pub half: u8,
    /// Width straight across the mouth, or across the widest place of a diamond dart (mm).
    pub width_mm: f64,
    /// Lengths of the legs in the order of the outline; all four of a diamond dart (mm).
    pub legs_mm: Vec<f64>,
    /// The leg that the dart is pressed towards: before or after the apex as drawn.
    pub pressed: &'static str,
}

/// A seam.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SeamFacts {
    /// Name of the seam.
    pub name: String,
    /// Lengths of both sides (mm).
    pub lengths_mm: [f64; 2],
    /// Whether the longer side is gathered or eased on purpose.
    pub gathered: bool,
    /// Pairs of edges that go on into each other across the seam, at its ends.
    pub joints: Vec<JointFacts>,
}

/// Two edges that go on into each other across a seam at one of its ends.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct JointFacts {
    /// End of the seam: start or end.
    pub end: &'static str,
    /// Names of the edges, or of the operations that made them: on the first side, on the second.
    pub edges: [String; 2],
    /// Names of the pieces that the two edges belong to.
    pub pieces: [String; 2],
    /// Angle by which the outline turns across the seam: above 0 a peak, below 0 a dip (deg).
    pub kink_deg: f64,
    /// Length by which the first piece reaches beyond the second at that end of the seam (mm).
    pub step_mm: f64,
}

/// Every piece of a draft in numbers; pieces without a cut line are left out, as checks report them.
pub fn piece_facts((pattern, draft): (&Pattern, &Draft), size: Option<&str>) -> Vec<PieceFacts> {
    let pieces = draft.pieces.iter().enumerate();
    let facts = pieces.filter_map(|(k, piece)| {
        let how = (size, &CutOptions::default());
        let cut = CutPiece::new((pattern, draft), k, how).ok()?;
        let panel = pattern.panel(piece.id.panel)?;
        let lineage = pattern.lineage(panel);
        let fabric = draft.fabrics.get(piece.fabric);
        Some(PieceFacts {
            name: piece.name.clone(),
            panel: panel.name.clone(),
            copy: piece.id.copy,
            size: size.map(str::to_owned),
            fabric: fabric.map_or_else(String::new, |fabric| fabric.name.clone()),
            grain_deg: cut.grain.to_degrees(),
            folded: !piece.folds.is_empty(),
            sewn: sewn_facts(piece, &cut),
            cut: region_facts(&cut.polygon()),
            edges: edges_of(piece)
                .map(|edge| edge_facts((pattern, panel.id), edge))
                .collect(),
            notches: notch_facts((pattern, panel), &cut),
            darts: darts(&lineage, piece),
        })
    });
    facts.collect()
}

/// Every seam of an evaluation's draft in numbers, darts' seams included.
pub fn seam_facts((evaluation, draft): (&Evaluation, &Draft)) -> Vec<SeamFacts> {
    let seams = draft.seams.iter().map(|seam| SeamFacts {
        name: seam.name.clone(),
        lengths_mm: [0, 1].map(|side| {
            let spans = seam.sides[side].iter();
            1e3 * spans.map(|span| span_length(draft, span)).sum::<f64>()
        }),
        gathered: seam.gathered,
        joints: joints((evaluation, draft), seam),
    });
    seams.collect()
}

fn joints((evaluation, draft): (&Evaluation, &Draft), seam: &DraftSeam) -> Vec<JointFacts> {
    let pattern = evaluation.pattern();
    let facts = |joint: Joint| JointFacts {
        end: ["start", "end"][joint.end],
        edges: joint.names(pattern, draft),
        pieces: joint.pieces.map(|k| draft.pieces[k].name.clone()),
        kink_deg: joint.kink.to_degrees(),
        step_mm: 1e3 * joint.step,
    };
    let walk = Walk::new(draft, seam);
    let found = walk.map(|walk| walk.joints(evaluation.ease(seam.id)));
    found.into_iter().flatten().flatten().map(facts).collect()
}

fn edges_of(piece: &Piece) -> impl Iterator<Item = &PieceEdge> {
    piece.outline.iter().chain(piece.holes.iter().flatten())
}

fn millimetres(p: Vec2) -> [f64; 2] {
    [p.x * 1e3, p.y * 1e3]
}

fn bounds_mm(bounds: Bounds2) -> [[f64; 2]; 2] {
    [millimetres(bounds.min), millimetres(bounds.max)]
}

fn region_facts(polygon: &Polygon) -> RegionFacts {
    RegionFacts {
        area_cm2: polygon.area() * 1e4,
        bounds_mm: bounds_mm(polygon.bounds()),
        outline_mm: Polygon::new(polygon.outer.clone()).perimeter() * 1e3,
    }
}

/// Facts of the sewing lines; area and length are those of the curves themselves, not of polygons.
fn sewn_facts(piece: &Piece, cut: &CutPiece) -> RegionFacts {
    let outer = cut
        .sew
        .first()
        .map_or(&[][..], |ring: &PieceRing| &ring.points);
    let length: f64 = piece.outline.iter().map(|edge| edge.curve.length()).sum();
    RegionFacts {
        area_cm2: crate::report::piece_area(piece) * 1e4,
        bounds_mm: bounds_mm(Bounds2::of(outer.iter().copied())),
        outline_mm: length * 1e3,
    }
}

/// Name of an edge, or of the operation that made it.
pub(crate) fn edge_name((pattern, panel): (&Pattern, PanelId), origin: EdgeOrigin) -> String {
    let name = pattern.edge_name(panel, origin.name);
    name.unwrap_or_default().to_owned()
}

fn edge_facts(of: (&Pattern, PanelId), edge: &PieceEdge) -> EdgeFacts {
    EdgeFacts {
        name: edge_name(of, edge.origin),
        half: edge.origin.half,
        length_mm: edge.curve.length() * 1e3,
        allowance_mm: edge.seam_allowance * 1e3,
        corner: match edge.corner.kind {
            Corner::Mitre => "mitre",
            Corner::Bevel => "bevel",
            Corner::Square => "square",
            Corner::Extended => "extended",
            Corner::Mirrored => "mirrored",
        },
    }
}

/// Facts of the notches of a piece as it is cut, in their order.
pub(crate) fn notch_facts((pattern, panel): (&Pattern, &Panel), cut: &CutPiece) -> Vec<NotchFacts> {
    let lineage = pattern.lineage(panel);
    let notch = |notch: &toile_cut::CutNotch| {
        let named = lineage.iter().find_map(|own| own.notch(notch.id));
        NotchFacts {
            name: named.map_or_else(String::new, |n| n.name.clone()),
            edge: edge_name((pattern, panel.id), notch.edge),
            half: notch.edge.half,
            kind: match notch.kind {
                NotchKind::Slit => "slit",
                NotchKind::V => "v",
                NotchKind::Castle => "castle",
                NotchKind::T => "t",
                NotchKind::Check => "check",
            },
            seam_mm: millimetres(notch.point),
            cut_mm: millimetres(notch.on_cut),
            depth_mm: notch.depth * 1e3,
        }
    };
    cut.notches.iter().map(notch).collect()
}

fn darts(lineage: &[&Panel], piece: &Piece) -> Vec<DartFacts> {
    let dart = |dart: &toile_pattern::StageDart| {
        let mut operations = lineage.iter().flat_map(|own| &own.operations);
        let operation = operations.find(|o| o.id == dart.by);
        let is_leg = |edge: &&PieceEdge| {
            edge.origin.half == dart.half && edge.origin.leg().is_some_and(|leg| leg.0 == dart.by)
        };
        let legs = edges_of(piece).filter(is_leg);
        DartFacts {
            name: operation.map_or_else(String::new, |o| o.name.clone()),
            half: dart.half,
            width_mm: (dart.mouth[1] - dart.mouth[0]).norm() * 1e3,
            legs_mm: legs.map(|leg| leg.curve.length() * 1e3).collect(),
            pressed: match dart.pressed {
                Pressed::Before => "before",
                Pressed::After => "after",
            },
        }
    };
    piece.darts.iter().map(dart).collect()
}
