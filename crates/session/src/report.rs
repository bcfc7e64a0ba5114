//! `report.json`: what was made, in numbers.

use crate::Project;
use crate::choice::figure_name;
use crate::crossings::Tangles;
use crate::drape::Drape;
use crate::outfit::DraftedPart;
use serde::Serialize;
use toile_drape::Verdict;
use toile_marker::FinishedMarker;
use toile_pattern::{Draft, DraftSpan};

/// Method by which a garment comes to rest, in words.
const METHOD: &str =
    "implicit Newton for sewing, XPBD for the swing, pseudo-transient Newton continuation to rest";

#[derive(Serialize)]
pub(crate) struct Report {
    format: &'static str,
    version: u32,
    pattern: String,
    source: Option<String>,
    size: Option<String>,
    fabric: Option<String>,
    body: &'static str,
    body_height_m: Option<f64>,
    pieces: Vec<PieceReport>,
    area_m2: f64,
    seams: Vec<SeamReport>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    markers: Vec<MarkerReport>,
    #[serde(flatten)]
    drape: Option<DrapeReport>,
    warnings: Vec<String>,
}

#[derive(Serialize)]
struct PieceReport {
    name: String,
    fabric: String,
    area_cm2: f64,
    sewn: bool,
}

#[derive(Serialize)]
struct SeamReport {
    name: String,
    lengths_m: [f64; 2],
    gathered: bool,
}

#[derive(Serialize)]
struct MarkerReport {
    fabric: String,
    pieces: usize,
    unplaced: usize,
    width_m: f64,
    length_m: f64,
    cut_area_m2: f64,
    efficiency: f64,
    utilisation: f64,
    sound: bool,
    penetration_max_m: f64,
}

#[derive(Serialize)]
struct ByDirection {
    warp: f64,
    weft: f64,
}

#[derive(Serialize)]
struct Steps {
    sewing: usize,
    settling: usize,
}

#[derive(Serialize)]
struct DrapeReport {
    quality: &'static str,
    edge_length_m: f64,
    method: &'static str,
    vertices: usize,
    triangles: usize,
    components: usize,
    non_manifold_edges: usize,
    steps: Steps,
    residual: f64,
    residual_goal: f64,
    #[serde(rename = "kinetic_energy_J")]
    kinetic_energy: f64,
    strain_max: ByDirection,
    strain_p99: ByDirection,
    compression_max: ByDirection,
    shear_max_rad: f64,
    seam_gap_max_m: f64,
    body_penetration_max_m: f64,
    body_intersections: usize,
    edges_through_body: usize,
    self_intersections: usize,
    /// Garments worn over one another, innermost first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    layers: Vec<LayerReport>,
    tangles: Tangles,
    verdict: Verdict,
}

#[derive(Serialize)]
struct LayerReport {
    layer: u16,
    garments: Vec<GarmentReport>,
    body_intersections: usize,
    self_intersections: usize,
    /// Crossings of this layer with layers farther out.
    outer_intersections: usize,
    /// Vertices of layers farther out that lie inside this layer.
    astray: usize,
}

#[derive(Serialize)]
struct GarmentReport {
    name: String,
    source: Option<String>,
    vertices: usize,
    triangles: usize,
}

fn layer_reports(drape: &Drape) -> Vec<LayerReport> {
    let each = drape.measures.layers.iter();
    each.map(|measured| LayerReport {
        layer: measured.layer,
        garments: drape
            .job
            .parts
            .iter()
            .filter(|part| part.layer == measured.layer)
            .map(|part| {
                let mesh = drape.part_mesh(part);
                let file = part.source.as_deref().and_then(|path| path.file_name());
                GarmentReport {
                    name: part.name.clone(),
                    source: file.map(|name| name.to_string_lossy().into_owned()),
                    vertices: mesh.positions.len(),
                    triangles: mesh.triangles.len(),
                }
            })
            .collect(),
        body_intersections: measured.body_intersections,
        self_intersections: measured.self_intersections,
        outer_intersections: measured.outer_intersections,
        astray: measured.astray,
    })
    .collect()
}

fn by_direction([warp, weft]: [f64; 2]) -> ByDirection {
    ByDirection { warp, weft }
}

/// Name of the fabric that was chosen, else the names of the fabrics that pieces are cut from.
fn fabric_names(project: &Project, parts: &[DraftedPart]) -> Option<String> {
    if let Some(choice) = &project.fabric {
        return Some(choice.name().to_owned());
    }
    let mut names: Vec<&str> = Vec::new();
    for draft in parts.iter().map(|part| &part.draft) {
        for fabric in draft
            .pieces
            .iter()
            .filter_map(|p| draft.fabrics.get(p.fabric))
        {
            if !names.contains(&&*fabric.name) {
                names.push(&fabric.name);
            }
        }
    }
    (!names.is_empty()).then(|| names.join(", "))
}

impl Report {
    /// A report on a project that contains only its pieces and seams.
    pub fn new(project: &Project, parts: &[DraftedPart]) -> Self {
        let several = parts.len() > 1;
        let prefix = |part: &DraftedPart| match several {
            true => format!("{}: ", part.name),
            false => String::new(),
        };
        let pieces: Vec<PieceReport> = parts
            .iter()
            .flat_map(|part| {
                let (prefix, draft) = (prefix(part), &part.draft);
                draft.pieces.iter().map(move |piece| PieceReport {
                    name: format!("{prefix}{}", piece.name),
                    fabric: draft
                        .fabrics
                        .get(piece.fabric)
                        .map_or_else(String::new, |f| f.name.clone()),
                    area_cm2: 1e4 * piece_area(piece),
                    sewn: piece.sewn,
                })
            })
            .collect();
        let seams = parts
            .iter()
            .flat_map(|part| {
                let (prefix, draft) = (prefix(part), &part.draft);
                draft.seams.iter().map(move |seam| SeamReport {
                    name: format!("{prefix}{}", seam.name),
                    lengths_m: [0, 1].map(|side| {
                        seam.sides[side]
                            .iter()
                            .map(|span| span_length(draft, span))
                            .sum()
                    }),
                    gathered: seam.gathered,
                })
            })
            .collect();
        let source = project.source.as_deref().and_then(|path| path.file_name());
        Self {
            format: "toile-report",
            version: 1,
            pattern: project.pattern.name.clone(),
            source: source.map(|name| name.to_string_lossy().into_owned()),
            size: project.size_name().map(str::to_owned),
            fabric: fabric_names(project, parts),
            body: figure_name(project.figure()),
            body_height_m: project.body_measurements().get("height"),
            area_m2: 1e-4 * pieces.iter().map(|p| p.area_cm2).sum::<f64>(),
            pieces,
            seams,
            markers: Vec::new(),
            drape: None,
            warnings: Vec::new(),
        }
    }

    /// Adds the markers.
    pub fn add_markers(&mut self, finished_markers: &[FinishedMarker]) {
        for finished in finished_markers {
            self.markers.push(MarkerReport {
                fabric: finished.fabric.clone(),
                pieces: finished.marker.placements.len(),
                unplaced: finished.marker.unplaced.len(),
                width_m: finished.strip.width,
                length_m: finished.marker.length,
                cut_area_m2: finished.cut_area(),
                efficiency: finished.marker.efficiency,
                utilisation: finished.marker.utilisation,
                sound: finished.verdict.is_sound(),
                penetration_max_m: finished.verdict.deepest,
            });
        }
    }

    /// Adds the drape.
    pub fn add_drape(&mut self, project: &Project, drape: &Drape) {
        let measures = &drape.measures;
        self.drape = Some(DrapeReport {
            quality: project.quality.name(),
            edge_length_m: project.quality.edge_length(),
            method: METHOD,
            vertices: drape.mesh.positions.len(),
            triangles: drape.mesh.triangles.len(),
            components: drape.mesh.component_count(),
            non_manifold_edges: drape.mesh.topology().non_manifold().count(),
            steps: Steps {
                sewing: drape.steps[0],
                settling: drape.steps[1],
            },
            residual: measures.residual,
            residual_goal: project.quality.residual(),
            kinetic_energy: measures.kinetic_energy,
            strain_max: by_direction(measures.strain_max),
            strain_p99: by_direction(measures.strain_p99),
            compression_max: by_direction(measures.compression_max),
            shear_max_rad: measures.shear_max,
            seam_gap_max_m: drape.seam_gap,
            body_penetration_max_m: measures.penetration_max.max(0.0),
            body_intersections: measures.body_intersections,
            edges_through_body: measures.edges_through_body,
            self_intersections: measures.self_intersections,
            layers: layer_reports(drape),
            tangles: Tangles::of(&drape.tally),
            verdict: drape.verdict.clone(),
        });
    }

    /// Adds warnings.
    pub fn add_warnings(&mut self, warnings: impl IntoIterator<Item = String>) {
        self.warnings.extend(warnings);
    }

    /// The file's content.
    pub fn to_json(&self) -> String {
        // Plain data: this cannot fail.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }
}

/// Area of a piece, holes taken out (m2). Exact for lines, arcs and Bezier curves.
pub(crate) fn piece_area(piece: &toile_pattern::Piece) -> f64 {
    let ring = |edges: &[toile_pattern::PieceEdge]| -> f64 {
        0.5 * edges
            .iter()
            .map(|edge| edge.curve.swept_area())
            .sum::<f64>()
    };
    let holes = piece.holes.iter().map(|hole| ring(hole).abs());
    ring(&piece.outline).abs() - holes.sum::<f64>()
}

/// Length of a span (m).
pub(crate) fn span_length(draft: &Draft, span: &DraftSpan) -> f64 {
    let Some(piece) = draft.pieces.get(span.piece) else {
        return 0.0;
    };
    let mut edges = piece.outline.iter().chain(piece.holes.iter().flatten());
    edges.nth(span.edge).map_or(0.0, |edge| {
        edge.curve.length() * (span.to - span.from).abs()
    })
}
