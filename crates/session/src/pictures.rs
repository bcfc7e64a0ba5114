//! The two pictures of a drape: the garment worn, and how tight it sits.
//!
//! # Decided with
//! - [`toile_picture::drape_picture`], [`toile_picture::fit_picture`]: the pages;
//! - [`crate::pictures::vertex_stretch`], [`crate::pictures::MAX_STRETCH`],
//!   [`toile_drape::stretch_per_triangle`]: which strain is shown;
//! - [`crate::drape::Drape::of`]: the stretch kept with the drape;
//! - [`crate::scene_pictures::SceneAlbum`], [`crate::state_picture::RunCamera`]: pictures of scenes, and
//!   their camera;
//! - [`toile_picture::ColourMap`], [`toile_picture::Paint`]: colours of stretch;
//! - [`crate::verdict::of_garment`]: words of the verdict.
//!
//! The report counts warp and weft each by itself and leaves gathers out.

use crate::SessionError;
use crate::drape::Drape;
use toile_geometry::TriangleMesh;
use toile_picture::{
    Backdrop, Camera, ColourMap, ColourScale, Edges, Finish, Legend, Lines, Paint, Projection, Rgb,
    Scene, Sheet, Surface, View, drape_picture, fit_picture, render,
};

/// Stretch at the upper end of the colour scale (%).
const MAX_STRETCH: f64 = 10.0;
/// Colour of a mannequin.
pub(crate) const SKIN: [f64; 3] = [0.80, 0.77, 0.74];

fn body(skin: &TriangleMesh) -> Surface {
    Surface {
        framed: false,
        ..Surface::plain(skin.clone(), SKIN, Finish::Smooth)
    }
}

fn garment(drape: &Drape, paint: Paint, line: [f64; 3]) -> Surface {
    Surface {
        mesh: drape.mesh.clone(),
        normals: Vec::new(),
        paint,
        finish: Finish::Cloth,
        lines: seam_lines(drape.seam_edges(), line),
        framed: true,
    }
}

/// Lines along seams.
pub(crate) fn seam_lines(pairs: Vec<[u32; 2]>, colour: Rgb) -> Lines {
    Lines {
        edges: Edges::Pairs(pairs),
        colour,
        width: 1.2,
        opacity: 0.55,
    }
}

/// Colour of lines on cloth of the given colour.
pub(crate) fn darker(colour: Rgb) -> Rgb {
    colour.map(|c| 0.35 * c)
}

/// The garment in its colours on the mannequin.
fn worn(drape: &Drape, skin: &TriangleMesh) -> Scene {
    let mut colours = vec![[0.7; 3]; drape.job.garment.triangles.len()];
    for (panel, look) in drape.job.garment.panels.iter().zip(drape.job.panels.iter()) {
        colours[panel.triangles.clone()].fill(look.colour);
    }
    let colours: Vec<[f64; 3]> = drape.origin.iter().map(|&t| colours[t as usize]).collect();
    let mean: [f64; 3] =
        [0, 1, 2].map(|k| colours.iter().map(|c| c[k]).sum::<f64>() / colours.len().max(1) as f64);
    let line = darker(mean);
    Scene {
        surfaces: vec![
            garment(drape, Paint::PerTriangle(colours), line),
            body(skin),
        ],
    }
}

/// Three-quarter view of the garment on the mannequin, as a PNG of a size (pixels).
pub(crate) fn drape_view_png(
    drape: &Drape,
    skin: &TriangleMesh,
    size: [usize; 2],
) -> Result<Vec<u8>, SessionError> {
    let scene = worn(drape, skin);
    let bounds = scene.bounds().unwrap_or_default();
    let aspect = size[0] as f64 / size[1] as f64;
    let camera = Camera::fit_to(bounds, View::ThreeQuarter, aspect, Projection::Perspective);
    Ok(render(&scene, &camera, size, &Backdrop::default())?.to_png()?)
}

/// The garment on the mannequin from all sides with the headline of the verdict, as PNG.
pub(crate) fn drape_png(
    drape: &Drape,
    skin: &TriangleMesh,
    title: &str,
) -> Result<Vec<u8>, SessionError> {
    let scene = worn(drape, skin);
    let sheet = Sheet {
        warning: drape.verdict.headline(),
        ..Sheet::studio(title)
    };
    Ok(drape_picture(&scene, &sheet)?.to_png()?)
}

/// The stretch of the cloth in colour, with its key, as PNG.
pub(crate) fn fit_png(
    drape: &Drape,
    skin: &TriangleMesh,
    title: &str,
) -> Result<Vec<u8>, SessionError> {
    let scale = ColourScale {
        map: ColourMap::Heat,
        low: 0.0,
        high: MAX_STRETCH,
        over: Some(ColourScale::OVER),
    };
    let values = vertex_stretch(drape);
    let scene = Scene {
        surfaces: vec![
            garment(drape, Paint::VertexScalar(values, scale), [0.25; 3]),
            body(skin),
        ],
    };
    let legend = Legend {
        title: "Stretch of the cloth, the larger of warp and weft".into(),
        unit: "%".into(),
        scale,
        ends: ["relaxed".into(), "tight".into()],
        over: format!("over {MAX_STRETCH} %"),
    };
    Ok(fit_picture(&scene, &legend, &Sheet::chart(title))?.to_png()?)
}

/// Stretch at each merged vertex (%): mean of the triangles there, weighted by area; compressed
/// cloth counts as relaxed.
fn vertex_stretch(drape: &Drape) -> Vec<f64> {
    let mut sums = vec![[0.0; 2]; drape.mesh.positions.len()];
    for (t, triangle) in drape.mesh.triangles.iter().enumerate() {
        let area = toile_geometry::triangle_area(drape.mesh.corners(t));
        let stretch = 100.0 * drape.stretch[t].max(0.0);
        for &v in triangle {
            sums[v as usize][0] += area * stretch;
            sums[v as usize][1] += area;
        }
    }
    sums.iter()
        .map(|[sum, area]| if *area > 0.0 { sum / area } else { 0.0 })
        .collect()
}
