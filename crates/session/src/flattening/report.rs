//! What is asked of a panel, and what became of the surface.

use serde::Serialize;
use std::path::PathBuf;
use toile_flatten::{Flattened, PanelOutline};
use toile_interchange::FormatError;

/// What is asked of a panel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlattenOptions {
    /// Direction of the grain in space; `None`: upwards, or along z where the surface lies flat.
    pub grain: Option<[f64; 3]>,
    /// Name of a fabric of the library, or a fabric file; `None`: poplin.
    pub fabric: Option<String>,
    /// Limit of the stretch on 99 % of the area (1).
    pub strain: f64,
    /// Most darts.
    pub darts: usize,
    /// Distance by which the surface is moved out to its front (m).
    pub ease: f64,
    /// File of a loop round the region to flatten; `None`: the whole surface.
    pub loop_file: Option<PathBuf>,
    /// Length of the edges that a region is meshed with (m); `None`: one that suits its size.
    pub edge: Option<f64>,
    /// Whether the cloth of a region follows the hollows of the surface; else it spans them.
    pub follows_hollows: bool,
}

/// A dart of the report.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DartReport {
    /// Distance from the middle of the mouth to the apex on the surface (m).
    pub length_m: f64,
    /// Width of the mouth (m).
    pub intake_m: f64,
    /// Largest distance of its legs from straight (m).
    pub bow_m: f64,
}

/// What became of a surface.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FlattenReport {
    /// Files that were written, the pattern first.
    pub files: Vec<PathBuf>,
    /// Name of the fabric.
    pub fabric: String,
    /// Triangles of the surface.
    pub triangles: usize,
    /// Area of the surface, moved out by the ease (m2).
    pub surface_area_m2: f64,
    /// Length of the edges that the region of a loop was meshed with (m).
    pub edge_m: Option<f64>,
    /// Area of the panel (m2).
    pub panel_area_m2: f64,
    /// Energy of the fabric on the surface (J).
    pub energy_j: f64,
    /// Stretch that is not exceeded on 99 % of the area, either way (1).
    pub stretch_99: f64,
    /// Limit asked for (1).
    pub stretch_limit: f64,
    /// Whether the limit is kept.
    pub within_limit: bool,
    /// Energy (J) and stretch (1) before each dart.
    pub before_darts: Vec<[f64; 2]>,
    /// Darts of the panel.
    pub darts: Vec<DartReport>,
    /// Cuts whose sides overlap: each asks for a gusset.
    pub gussets: usize,
    /// Steps of the last descent.
    pub steps: usize,
    /// Whether the last descent came to rest.
    pub at_rest: bool,
    /// Notes in words.
    pub notes: Vec<String>,
}

impl FlattenReport {
    /// The report as JSON.
    ///
    /// # Errors
    /// Numbers that JSON does not hold.
    pub fn to_json(&self) -> Result<String, FormatError> {
        serde_json::to_string_pretty(self)
            .map_err(|error| FormatError::new("the report", error.to_string(), "report this fault"))
    }
}

/// The report on a flattened surface, without files.
pub(super) fn report_on(
    flat: &Flattened,
    outline: &PanelOutline,
    (options, fabric, edge_m, mut notes): (&FlattenOptions, String, Option<f64>, Vec<String>),
) -> FlattenReport {
    let places = &flat.places;
    let panel_area: f64 = (flat.region.mesh().triangles.iter())
        .map(|t| {
            let [a, b, c] = t.map(|v| places[v as usize]);
            0.5 * (b - a).perp(&(c - a))
        })
        .sum();
    let within = flat.strain <= options.strain;
    if !within {
        notes.push(format!(
            "the cloth is stretched or pressed by {:.1} % where {:.1} % is asked: allow more darts (--darts), cut the \
             surface into more panels, or take a softer fabric",
            100.0 * flat.strain,
            100.0 * options.strain
        ));
    }
    for gusset in &outline.gussets {
        notes.push(format!(
            "the sides of cut {} overlap: the surface is a saddle there and asks for a gusset, no dart",
            gusset + 1
        ));
    }
    FlattenReport {
        files: Vec::new(),
        fabric,
        triangles: flat.region.mesh().triangles.len(),
        surface_area_m2: flat.region.area(),
        edge_m,
        panel_area_m2: panel_area,
        energy_j: flat.minimum.energy,
        stretch_99: flat.strain,
        stretch_limit: options.strain,
        within_limit: within,
        before_darts: flat.before.clone(),
        darts: (outline.darts.iter())
            .map(|dart| DartReport {
                length_m: length_on(flat, dart.dart),
                intake_m: dart.intake,
                bow_m: dart.bow,
            })
            .collect(),
        gussets: outline.gussets.len(),
        steps: flat.minimum.steps,
        at_rest: flat.minimum.is_converged,
        notes,
    }
}

/// Length of a dart along its left leg on the surface (m).
fn length_on(flat: &Flattened, dart: usize) -> f64 {
    let place = |v: u32| flat.region.mesh().positions[v as usize];
    (flat.darts[dart].left.windows(2))
        .map(|pair| (place(pair[1]) - place(pair[0])).norm())
        .sum()
}
