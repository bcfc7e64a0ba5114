//! The setup of a drape, made from draft, fabrics and mannequin. `derived.rs` adds the coarser mesh of a fine
//! quality.
//!
//! # Decided with
//! - [`crate::choice::Quality`]: length of edges, steps, residual;
//! - [`toile_drape::GarmentSetup`]: the setup as it is simulated;
//! - [`toile_drape::ContactSettings`], [`crate::setup::CLOTH_OFFSET`], [`crate::setup::GRAVITY`]: how far
//!   cloth keeps off; gravity;
//! - [`crate::setup::cloth`], [`toile_pattern::Piece`]: warp and weft by the grain of a piece;
//! - [`crate::setup::placement_body`], [`toile_assembly::PlacementBody`]: the body that panels are placed
//!   round;
//! - [`crate::setup::level`], [`crate::outfit::Outfit::new`]: layers; several garments;
//! - [`crate::setup::counted`]: strain near gathers, which is not counted.

use crate::Quality;
use crate::fabrics::cloth_material;
use crate::mannequin_source::MannequinSource;
use crate::outfit::{DraftedPart, GarmentPart, MeshedPart, Outfit};
use std::sync::Arc;
use toile_assembly::{Garment, Levels, Limb, PlacementBody};
use toile_body::{Mannequin, Part};
use toile_drape::{
    Cloth, ContactSettings, GarmentLevel, GarmentSetup, Material, RestSettings, SewSettings,
};
use toile_geometry::{SurfaceTree, Vec2, Vec3};
use toile_pattern::{BodyPart, Draft, PieceId};

/// Acceleration of gravity (m/s2).
pub(crate) const GRAVITY: f64 = 9.81;

/// A garment ready to be sewn and draped, with the map from the result back to panels.
#[derive(Clone)]
pub struct GarmentJob {
    /// Revision of the session that the job was made from.
    pub revision: u64,
    /// Setup of the drape.
    pub setup: GarmentSetup,
    /// The meshed and placed pieces; vertices are those of the setup.
    pub garment: Arc<Garment>,
    /// Names and colours of the pieces, in the order of the garment's panels.
    pub panels: Arc<Vec<JobPanel>>,
    /// The seams, in the order in which the stitches of the garment number them.
    pub seams: Arc<Vec<JobSeam>>,
    /// The garments worn together, the project's own first.
    pub parts: Arc<Vec<GarmentPart>>,
    /// Sources of the garment, with which an edit of the pattern is compared.
    pub(crate) origin: Arc<JobOrigin>,
}

/// Sources that a garment was made from.
pub(crate) struct JobOrigin {
    /// Body that the garment was placed round.
    pub body: MannequinSource,
    pub quality: Quality,
    /// The garments as drafted for this job.
    pub drafted: Vec<DraftedPart>,
    /// The garments as drafted when they were meshed.
    pub meshed: Arc<Vec<MeshedPart>>,
}

impl JobOrigin {
    /// Names of the seams of all garments, in the order in which stitches number them.
    pub fn seam_names(&self) -> Vec<String> {
        let drafts = self.meshed.iter().map(|meshed| &meshed.part.draft);
        let seams = drafts.flat_map(|draft| &draft.seams);
        seams.map(|seam| seam.name.clone()).collect()
    }
}

/// Facts about a piece of a garment, for pictures and files.
#[derive(Clone, Debug, PartialEq)]
pub struct JobPanel {
    /// Id of the piece.
    pub piece: PieceId,
    /// Name to show.
    pub name: String,
    /// Base colour, sRGB 0..=1.
    pub colour: [f64; 3],
}

/// Facts about a seam of a garment, for reports.
#[derive(Clone, Debug, PartialEq)]
pub struct JobSeam {
    /// Name to show.
    pub name: String,
    /// Whether the longer side is gathered or eased on purpose.
    pub gathered: bool,
}

/// Builds the drape of a garment that was meshed and placed.
pub(crate) fn job(
    outfit: &Outfit,
    (body, skin): (MannequinSource, Arc<SurfaceTree>),
    quality: Quality,
) -> GarmentJob {
    let (draft, garment) = (&*outfit.draft, outfit.garment.clone());
    let panels = garment
        .panels
        .iter()
        .map(|panel| JobPanel {
            piece: panel.piece,
            name: panel.name.clone(),
            colour: draft
                .fabrics
                .get(panel.fabric)
                .map_or([0.7; 3], |f| f.colour),
        })
        .collect();
    let seams = draft.seams.iter().map(|seam| JobSeam {
        name: seam.name.clone(),
        gathered: seam.gathered,
    });
    let setup = GarmentSetup {
        levels: vec![level(outfit)],
        counted: counted(draft, &garment, 2.0 * quality.edge_length()),
        colliders: vec![skin],
        contact: ContactSettings {
            cloth_offset: CLOTH_OFFSET,
            ..ContactSettings::default()
        },
        gravity: Vec3::new(0.0, -GRAVITY, 0.0),
        sew: SewSettings::default(),
        rest: RestSettings {
            residual: quality.residual(),
            steps: quality.steps(),
            ..RestSettings::default()
        },
    };
    GarmentJob {
        revision: 0,
        setup,
        garment,
        panels: Arc::new(panels),
        seams: Arc::new(seams.collect()),
        parts: outfit.parts.clone(),
        origin: Arc::new(JobOrigin {
            body,
            quality,
            drafted: outfit.meshed.iter().map(|m| m.part.clone()).collect(),
            meshed: outfit.meshed.clone(),
        }),
    }
}

/// Distance kept between cloth and cloth, in one layer and between layers (m): half of the distance kept from
/// the body (`ContactSettings::offset`, 4 mm), so that a layer fits between the body and the next layer.
pub(crate) const CLOTH_OFFSET: f64 = 2e-3;

/// The mesh of an outfit as one level of a drape. Vertices have layers only if the garments lie in several
/// layers.
pub(crate) fn level(outfit: &Outfit) -> GarmentLevel {
    let garment = &outfit.garment;
    let first = outfit.parts.first().map(|part| part.layer);
    let mut layer = Vec::new();
    if outfit.parts.iter().any(|part| Some(part.layer) != first) {
        for part in outfit.parts.iter() {
            layer.resize(part.vertices.end, part.layer);
        }
    }
    GarmentLevel {
        cloth: cloth(&outfit.draft, garment),
        stitches: garment.stitches.iter().map(|s| s.vertices).collect(),
        layer,
    }
}

/// The pieces as cloth: each triangle's rest shape is its shape in the piece, turned so that the warp is the
/// first axis.
fn cloth(draft: &Draft, garment: &Garment) -> Cloth {
    let mut rest = vec![[Vec2::zeros(); 3]; garment.triangles.len()];
    let mut material_of = vec![0; garment.triangles.len()];
    let mut panel_of = vec![0; garment.triangles.len()];
    // Materials of fabrics that no panel is cut from must be left out: contact and sewing use all materials
    // listed.
    let mut fabrics: Vec<usize> = garment.panels.iter().map(|panel| panel.fabric).collect();
    fabrics.sort_unstable();
    fabrics.dedup();
    for (index, panel) in garment.panels.iter().enumerate() {
        let (sine, cosine) = panel.grain.sin_cos();
        let turned = |p: Vec2| Vec2::new(cosine * p.x + sine * p.y, cosine * p.y - sine * p.x);
        for t in panel.triangles.clone() {
            rest[t] = garment.triangles[t].map(|v| turned(garment.flat[v as usize]));
            material_of[t] = fabrics.partition_point(|&fabric| fabric < panel.fabric) as u16;
            panel_of[t] = index as u32;
        }
    }
    Cloth {
        positions: garment.positions.clone(),
        triangles: garment.triangles.clone(),
        rest,
        material: material_of,
        panel: panel_of,
        materials: (fabrics.into_iter())
            .map(|fabric| {
                draft
                    .fabrics
                    .get(fabric)
                    .map_or_else(Material::default, cloth_material)
            })
            .collect(),
    }
}

/// Triangles where strain counts: those with every corner at least `reach` (m) from the vertices
/// of gathered seams, measured in the piece.
fn counted(draft: &Draft, garment: &Garment, reach: f64) -> Vec<bool> {
    let mut counted = vec![true; garment.triangles.len()];
    let gathered: Vec<u32> = garment
        .stitches
        .iter()
        .filter(|stitch| draft.seams[stitch.draft_seam].gathered)
        .flat_map(|stitch| stitch.vertices)
        .collect();
    for panel in &garment.panels {
        let near: Vec<Vec2> = gathered
            .iter()
            .filter(|&&v| panel.vertices.contains(&(v as usize)))
            .map(|&v| garment.flat[v as usize])
            .collect();
        for t in panel.triangles.clone() {
            counted[t] = garment.triangles[t].iter().all(|&v| {
                let p = garment.flat[v as usize];
                near.iter().all(|q| (p - q).norm() >= reach)
            });
        }
    }
    counted
}

fn body_part(part: Part) -> BodyPart {
    match part {
        Part::Trunk => BodyPart::Trunk,
        Part::Head => BodyPart::Head,
        Part::LeftArm => BodyPart::LeftArm,
        Part::RightArm => BodyPart::RightArm,
        Part::LeftLeg => BodyPart::LeftLeg,
        Part::RightLeg => BodyPart::RightLeg,
    }
}

/// A mannequin in the form that the placement of panels takes.
pub(crate) fn placement_body(mannequin: &Mannequin) -> PlacementBody<'_> {
    let levels = mannequin.levels();
    PlacementBody {
        skin: mannequin.skin_tree(),
        limbs: mannequin
            .parts()
            .into_iter()
            .map(|axis| Limb {
                part: body_part(axis.part),
                axis: axis.axis,
            })
            .collect(),
        levels: Levels {
            crown: levels.crown,
            neck: levels.neck,
            shoulder: levels.shoulder,
            chest: levels.chest,
            waist: levels.waist,
            hip: levels.hip,
            crotch: levels.crotch,
        },
    }
}
