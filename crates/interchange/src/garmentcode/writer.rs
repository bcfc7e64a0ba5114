//! A resolved pattern as a GarmentCode specification.

use super::curves::write_curve;
use crate::exchange::Loss;
use serde_json::{Map, Value, json};
use toile_geometry::{Curve, Rigid, Vec3};
use toile_pattern::{Draft, DraftSeam, Facing, Piece, PieceEdge, Worn};

/// Size of the file unit, the centimetre (m).
const UNIT: f64 = 0.01;
/// Two points at which an edge is cut count as one if they are nearer to each other than this fraction of its
/// length (1).
const SAME_CUT: f64 = 1e-7;
/// Largest number of rounds in which cuts on one side of a seam are copied to its other side.
const MAX_ROUNDS: usize = 32;

/// A written file.
#[derive(Clone, Debug)]
pub struct GarmentCodeWriting {
    /// The JSON text.
    pub text: String,
    /// What single pieces and seams lost; what the format has no place for at all is not listed.
    pub lost: Vec<Loss>,
}

/// Writes the sewn pieces of a draft.
///
/// The format stitches whole edges one to one, so edges are cut at the ends of seam spans. Curves are cut
/// exactly. Everything else that the format cannot hold is listed.
pub fn write_garmentcode(draft: &Draft) -> GarmentCodeWriting {
    let mut writer = Writer {
        draft,
        cuts: Vec::new(),
        lost: Vec::new(),
    };
    writer.find_cuts();
    let mut panels = Map::new();
    let mut order = Vec::new();
    for (index, piece) in draft.pieces.iter().enumerate() {
        if piece.sewn {
            panels.insert(piece.name.clone(), writer.panel(index, piece));
            order.push(json!(piece.name));
        } else {
            writer.lose(&piece.name, "the piece", "sewn to nothing, and left out");
        }
    }
    let stitches: Vec<Value> = draft
        .seams
        .iter()
        .flat_map(|seam| writer.stitches(seam))
        .collect();
    let value = json!({
        "pattern": { "panels": panels, "stitches": stitches, "panel_order": order },
        "parameters": {},
        "parameter_order": [],
        "properties": {
            "curvature_coords": "relative",
            "normalize_panel_translation": false,
            "normalized_edge_loops": true,
            "units_in_meter": (1.0 / UNIT).round() as u32,
        },
    });
    GarmentCodeWriting {
        text: format!("{value:#}\n"),
        lost: writer.lost,
    }
}

struct Writer<'a> {
    draft: &'a Draft,
    /// For each piece and edge, the fractions of the edge at which it is cut, 0 and 1 included.
    cuts: Vec<Vec<Vec<f64>>>,
    lost: Vec<Loss>,
}

/// One span of a seam's side, with its ends as fractions of the side's length (`start`, `end`) and of the
/// edge (`from`, `to`).
struct Stretch {
    piece: usize,
    edge: usize,
    from: f64,
    to: f64,
    start: f64,
    end: f64,
}

fn edges(piece: &Piece) -> impl Iterator<Item = &PieceEdge> {
    piece.outline.iter().chain(piece.holes.iter().flatten())
}

/// The spans of a seam's side in order; spans on pieces that are not written are left out.
fn chain(draft: &Draft, seam: &DraftSeam, side: usize) -> Vec<Stretch> {
    let mut walked = 0.0;
    let mut stretches = Vec::new();
    for span in &seam.sides[side] {
        let Some(edge) = draft
            .pieces
            .get(span.piece)
            .filter(|p| p.sewn)
            .and_then(|p| edges(p).nth(span.edge))
        else {
            continue;
        };
        let start = walked;
        walked += edge.curve.length() * (span.to - span.from).abs();
        stretches.push(Stretch {
            piece: span.piece,
            edge: span.edge,
            from: span.from,
            to: span.to,
            start,
            end: walked,
        });
    }
    for stretch in &mut stretches {
        stretch.start /= walked.max(f64::MIN_POSITIVE);
        stretch.end /= walked.max(f64::MIN_POSITIVE);
    }
    stretches.retain(|s| s.end > s.start);
    stretches
}

impl Stretch {
    /// Fraction of the side's length at a fraction of the edge.
    fn place_of(&self, fraction: f64) -> f64 {
        self.start + (self.end - self.start) * (fraction - self.from) / (self.to - self.from)
    }

    /// Fraction of the edge at a fraction of the side's length.
    fn fraction_at(&self, place: f64) -> f64 {
        self.from + (self.to - self.from) * (place - self.start) / (self.end - self.start)
    }
}

impl Writer<'_> {
    fn lose(&mut self, place: &str, what: &str, why: &str) {
        self.lost.push(Loss::at(place, what, why));
    }

    /// Cuts edges at the ends of spans, and copies every cut on one side of a seam to its other side until no
    /// new cut arises.
    fn find_cuts(&mut self) {
        let start = |piece: &Piece| edges(piece).map(|_| vec![0.0, 1.0]).collect();
        self.cuts = self.draft.pieces.iter().map(start).collect();
        for _ in 0..MAX_ROUNDS {
            let mut changed = false;
            for seam in &self.draft.seams {
                let sides = [0, 1].map(|side| chain(self.draft, seam, side));
                let places: Vec<f64> = sides
                    .iter()
                    .flatten()
                    .flat_map(|s| self.places(s))
                    .collect();
                for stretch in sides.iter().flatten() {
                    for &place in &places {
                        if place >= stretch.start - SAME_CUT && place <= stretch.end + SAME_CUT {
                            let fraction = stretch.fraction_at(place).clamp(0.0, 1.0);
                            changed |= self.cut(stretch.piece, stretch.edge, fraction);
                        }
                    }
                }
            }
            if !changed {
                return;
            }
        }
        self.lose(
            "seams",
            "some stitches",
            "the cuts that seams ask of each other never settle",
        );
    }

    /// Cuts on a stretch, its ends included, as fractions of the seam's side in ascending order.
    fn places(&self, stretch: &Stretch) -> Vec<f64> {
        let (low, high) = (stretch.from.min(stretch.to), stretch.from.max(stretch.to));
        let inside = self.cuts[stretch.piece][stretch.edge]
            .iter()
            .filter(|&&f| f > low + SAME_CUT && f < high - SAME_CUT)
            .map(|&f| stretch.place_of(f));
        let mut places: Vec<f64> = inside.chain([stretch.start, stretch.end]).collect();
        places.sort_by(f64::total_cmp);
        places
    }

    /// Cuts an edge at a fraction of its length; returns whether it was not cut there before.
    fn cut(&mut self, piece: usize, edge: usize, fraction: f64) -> bool {
        let cuts = &mut self.cuts[piece][edge];
        if cuts.iter().any(|c| (c - fraction).abs() <= SAME_CUT) {
            return false;
        }
        cuts.push(fraction);
        cuts.sort_by(f64::total_cmp);
        true
    }

    fn panel(&mut self, index: usize, piece: &Piece) -> Value {
        let mut vertices: Vec<Value> = Vec::new();
        let mut written: Vec<Value> = Vec::new();
        let mut edge = 0;
        for contour in std::iter::once(&piece.outline).chain(&piece.holes) {
            let first = vertices.len();
            let total: usize = (edge..edge + contour.len())
                .map(|e| self.cuts[index][e].len() - 1)
                .sum();
            for source in contour {
                for curve in cut_curve(&source.curve, &self.cuts[index][edge]) {
                    let start = curve.start() / UNIT;
                    vertices.push(json!([start.x, start.y]));
                    let here = vertices.len() - 1;
                    let next = if here + 1 == first + total {
                        first
                    } else {
                        here + 1
                    };
                    let mut entry = json!({ "endpoints": [here, next] });
                    if let Some(curvature) = write_curve(&curve, UNIT) {
                        entry["curvature"] = curvature;
                    }
                    written.push(entry);
                }
                edge += 1;
            }
        }
        let place = self.place(piece);
        let (x, y, z) = {
            let (roll, pitch, yaw) = place.rotation.euler_angles();
            (roll.to_degrees(), pitch.to_degrees(), yaw.to_degrees())
        };
        let t = place.translation.vector / UNIT;
        json!({
            "translation": [t.x, t.y, t.z],
            "rotation": [x, y, z],
            "vertices": vertices,
            "edges": written,
        })
    }

    /// Transform from the panel's plane to the world. Pieces to be wrapped round the body lie flat beside it.
    fn place(&mut self, piece: &Piece) -> Rigid {
        let (facing, level) = match piece.worn {
            Worn::Placed(place) => return place,
            Worn::Wrapped { facing, level, .. } => (facing, level.unwrap_or(1.0)),
            Worn::Automatic => (Facing::Front, 1.0),
        };
        self.lose(
            &piece.name,
            "its place round the body",
            "it is put flat beside it",
        );
        let (turn, offset) = match facing {
            Facing::Front | Facing::Around => (Vec3::zeros(), Vec3::new(0.0, level, 0.25)),
            Facing::Back => (
                Vec3::y() * std::f64::consts::PI,
                Vec3::new(0.0, level, -0.2),
            ),
            Facing::Left => (
                Vec3::y() * std::f64::consts::FRAC_PI_2,
                Vec3::new(0.5, level, 0.0),
            ),
            Facing::Right => (
                Vec3::y() * -std::f64::consts::FRAC_PI_2,
                Vec3::new(-0.5, level, 0.0),
            ),
            Facing::Over => (
                Vec3::x() * -std::f64::consts::FRAC_PI_2,
                Vec3::new(0.0, 1.6, 0.0),
            ),
        };
        Rigid::from_parts(offset.into(), Rigid::rotation(turn).rotation)
    }

    fn stitches(&mut self, seam: &DraftSeam) -> Vec<Value> {
        let [a, b] = [0, 1].map(|side| {
            let stretches = chain(self.draft, seam, side);
            let mut parts = Vec::new();
            for stretch in &stretches {
                for pair in self.places(stretch).windows(2) {
                    let middle = stretch.fraction_at(0.5 * (pair[0] + pair[1]));
                    parts.push((self.part(stretch, middle), stretch.from > stretch.to));
                }
            }
            parts
        });
        if a.len() != b.len() || a.is_empty() {
            self.lose(
                &seam.name,
                "the seam",
                "it cannot be cut into pairs of whole edges",
            );
            return Vec::new();
        }
        a.into_iter()
            .zip(b)
            .map(|((first, first_back), (second, second_back))| {
                let sides = [first, second].map(
                    |(piece, edge)| json!({ "panel": self.draft.pieces[piece].name, "edge": edge }),
                );
                let [first, second] = sides;
                if first_back == second_back {
                    json!([first, second, "right_wrong"])
                } else {
                    json!([first, second])
                }
            })
            .collect()
    }

    /// Piece of a stretch, and index of the written edge that contains a fraction of the stretch's edge.
    fn part(&self, stretch: &Stretch, fraction: f64) -> (usize, usize) {
        let before: usize = self.cuts[stretch.piece][..stretch.edge]
            .iter()
            .map(|c| c.len() - 1)
            .sum();
        let cuts = &self.cuts[stretch.piece][stretch.edge];
        let within = cuts.iter().filter(|&&c| c < fraction).count().max(1) - 1;
        (stretch.piece, before + within.min(cuts.len() - 2))
    }
}

/// The parts of a curve between arc-length fractions; without inner cuts the curve unchanged.
fn cut_curve(curve: &Curve, cuts: &[f64]) -> Vec<Curve> {
    if cuts.len() == 2 {
        return vec![*curve];
    }
    let length = curve.length();
    let parameter = |fraction: f64| match fraction {
        f if f <= 0.0 => 0.0,
        f if f >= 1.0 => 1.0,
        f => curve.parameter_at_length(f * length),
    };
    cuts.windows(2)
        .map(|pair| curve.between(parameter(pair[0]), parameter(pair[1])))
        .collect()
}
