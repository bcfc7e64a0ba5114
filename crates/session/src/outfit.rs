//! The garments worn together: each is drafted and meshed by itself, then all become one garment of several
//! parts, each in its layer.
//!
//! # Decided with
//! - [`crate::session::Session::set_layers`] (`perform.rs`), [`crate::command::OtherGarment`]: the command
//!   that asks for them;
//! - [`crate::project::Project::drafted_for`]: for whom the other garments are drafted;
//! - [`crate::setup::level`]: layers of the drape;
//! - [`crate::garment_edit`] (`refuse_other_garments`): edits that are refused;
//! - [`crate::drape::Drape::part_files`] (`product.rs`), [`crate::report`] (`LayerReport`): files and numbers
//!   of a layer;
//! - [`crate::verdict`] (`disorder`): cloth on the wrong side of a layer.
//!
//! Options: crate `cli`, `arguments.rs`, `session_commands.rs` (`refuse_layers`).

use crate::fabrics::FabricChoice;
use crate::{Project, SessionError, WornGarment};
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;
use toile_assembly::{Garment, PieceMeshes};
use toile_cut::cut_diagnostics;
use toile_pattern::{Diagnostic, Draft, Evaluation, Pattern, Severity};

/// One of the garments worn, with its share of the combined garment.
#[derive(Clone, Debug, PartialEq)]
pub struct GarmentPart {
    /// Name to show; no other part has it.
    pub name: String,
    /// The file of its pattern.
    pub source: Option<PathBuf>,
    /// Layer of the garment: larger numbers lie farther out.
    pub layer: u16,
    /// Panels of the garment.
    pub panels: Range<usize>,
    /// Vertices of the garment before merging.
    pub vertices: Range<usize>,
    /// Triangles of the garment before merging.
    pub triangles: Range<usize>,
}

/// A garment that is worn, drafted to the wearer.
#[derive(Clone)]
pub(crate) struct DraftedPart {
    pub name: String,
    pub source: Option<PathBuf>,
    pub layer: u16,
    pub pattern: Arc<Pattern>,
    /// Name of the size it is drafted in, if it is drafted to a size of a table.
    pub size: Option<String>,
    pub draft: Arc<Draft>,
    pub diagnostics: Arc<Vec<Diagnostic>>,
}

impl DraftedPart {
    /// The garment of the project's own pattern.
    pub fn own(project: &Project, draft: Arc<Draft>, diagnostics: Arc<Vec<Diagnostic>>) -> Self {
        Self {
            name: project.pattern.name.clone(),
            source: project.source.clone(),
            layer: project.layer,
            pattern: project.pattern.clone(),
            size: project.size_name().map(str::to_owned),
            draft,
            diagnostics,
        }
    }

    /// A garment worn with the project's own, in the project's size and fabric.
    pub fn other(project: &Project, worn: &WornGarment, pattern: &Arc<Pattern>) -> Self {
        let measurements = project.drafted_for(pattern);
        let (mut draft, diagnostics) = checked(&Evaluation::new(pattern, &measurements));
        let chosen = project.fabric.as_ref();
        let of = |pattern| chosen.and_then(|choice| choice.fabric(pattern));
        if let Some(fabric) = of(pattern).or_else(|| of(&project.pattern)) {
            FabricChoice::cut(fabric, &mut draft);
        }
        Self {
            name: pattern.name.clone(),
            source: Some(worn.source.clone()),
            layer: worn.layer,
            pattern: pattern.clone(),
            size: project.size.clone(),
            draft: Arc::new(draft),
            diagnostics: Arc::new(diagnostics),
        }
    }

    /// Refuses a pattern with faults that keep the garment from being made.
    pub fn refuse_faults(&self) -> Result<(), SessionError> {
        let named = Project {
            pattern: self.pattern.clone(),
            source: self.source.clone(),
            ..Project::default()
        };
        named.refuse_faults_in(self.size.as_deref(), &self.diagnostics)
    }
}

/// The draft of an evaluated pattern, with its diagnostics, including those of cut lines that cannot
/// be made as drawn.
pub(crate) fn checked(evaluation: &Evaluation) -> (Draft, Vec<Diagnostic>) {
    let pattern = evaluation.pattern();
    let mut found = evaluation.check();
    let (draft, _) = evaluation.draft();
    if found.iter().all(|f| f.severity != Severity::Error) {
        found.extend(cut_diagnostics(pattern, &draft));
    }
    (draft, found)
}

/// Makes names differ: a second `Shirt` is `Shirt 2`.
pub(crate) fn tell_apart(parts: &mut [DraftedPart]) {
    for k in 1..parts.len() {
        let (before, part) = parts.split_at_mut(k);
        let taken = |name: &str| before.iter().any(|other| other.name == name);
        let name = part[0].name.clone();
        let mut number = 1;
        while taken(&part[0].name) {
            number += 1;
            part[0].name = format!("{name} {number}");
        }
    }
}

/// A garment that is worn, meshed by itself.
#[derive(Clone)]
pub(crate) struct MeshedPart {
    pub part: DraftedPart,
    pub meshes: Arc<PieceMeshes>,
    pub garment: Garment,
}

/// The garments worn, combined into one: draft, mesh and parts.
pub(crate) struct Outfit {
    pub draft: Arc<Draft>,
    pub garment: Arc<Garment>,
    pub parts: Arc<Vec<GarmentPart>>,
    /// Meshed garments that the outfit was put together from.
    pub meshed: Arc<Vec<MeshedPart>>,
}

impl Outfit {
    /// Puts parts together, in their order; there is at least one. Where there are several, pieces and
    /// seams are named after their garment.
    pub fn new(meshed: Vec<MeshedPart>) -> Self {
        let several = meshed.len() > 1;
        let mut whole = Draft {
            name: String::new(),
            pieces: Vec::new(),
            seams: Vec::new(),
            fabrics: Vec::new(),
        };
        let mut mesh = Garment::default();
        let mut listed = Vec::new();
        for MeshedPart { part, garment, .. } in &meshed {
            let first = [
                mesh.panels.len(),
                mesh.positions.len(),
                mesh.triangles.len(),
            ];
            let prefix = match several {
                true => format!("{}: ", part.name),
                false => String::new(),
            };
            add_garment(&mut mesh, garment.clone(), &whole, &prefix);
            add_draft(&mut whole, part, &prefix);
            listed.push(GarmentPart {
                name: part.name.clone(),
                source: part.source.clone(),
                layer: part.layer,
                panels: first[0]..mesh.panels.len(),
                vertices: first[1]..mesh.positions.len(),
                triangles: first[2]..mesh.triangles.len(),
            });
        }
        Self {
            draft: Arc::new(whole),
            garment: Arc::new(mesh),
            parts: Arc::new(listed),
            meshed: Arc::new(meshed),
        }
    }
}

/// Adds the mesh of a garment whose draft comes after the drafts in `before`.
fn add_garment(whole: &mut Garment, part: Garment, before: &Draft, prefix: &str) {
    let (vertex, triangle) = (whole.positions.len(), whole.triangles.len());
    let shifted = |range: Range<usize>, by: usize| range.start + by..range.end + by;
    whole.positions.extend(part.positions);
    whole.flat.extend(part.flat);
    let corners = part.triangles.iter();
    (whole.triangles).extend(corners.map(|t| t.map(|v| v + vertex as u32)));
    for mut panel in part.panels {
        panel.draft_piece += before.pieces.len();
        panel.fabric += before.fabrics.len();
        panel.name.insert_str(0, prefix);
        panel.vertices = shifted(panel.vertices, vertex);
        panel.triangles = shifted(panel.triangles, triangle);
        whole.panels.push(panel);
    }
    for mut stitch in part.stitches {
        stitch.vertices = stitch.vertices.map(|v| v + vertex as u32);
        stitch.draft_seam += before.seams.len();
        whole.stitches.push(stitch);
    }
}

fn add_draft(whole: &mut Draft, part: &DraftedPart, prefix: &str) {
    let (piece_count, fabric_count) = (whole.pieces.len(), whole.fabrics.len());
    let join = if whole.name.is_empty() { "" } else { " + " };
    whole.name.push_str(join);
    whole.name.push_str(&part.name);
    for piece in &part.draft.pieces {
        let mut piece = piece.clone();
        piece.name.insert_str(0, prefix);
        piece.fabric += fabric_count;
        whole.pieces.push(piece);
    }
    for seam in &part.draft.seams {
        let mut seam = seam.clone();
        seam.name.insert_str(0, prefix);
        for span in seam.sides.iter_mut().flatten() {
            span.piece += piece_count;
        }
        whole.seams.push(seam);
    }
    whole.fabrics.extend(part.draft.fabrics.iter().cloned());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_told_apart() {
        let project = Project::default();
        let part = |name: &str| DraftedPart {
            name: name.into(),
            ..DraftedPart::own(
                &project,
                Arc::new(project.pattern.resolve(project.drafted_to()).0),
                Arc::default(),
            )
        };
        let mut parts = vec![part("Shirt"), part("Shirt"), part("Coat"), part("Shirt")];
        tell_apart(&mut parts);
        let names: Vec<&str> = parts.iter().map(|part| &*part.name).collect();
        assert_eq!(names, ["Shirt", "Shirt 2", "Coat", "Shirt 3"]);
    }
}
