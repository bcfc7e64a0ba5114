//! The strain map of a panel.

use crate::SessionError;
use toile_flatten::Flattened;
use toile_geometry::{TriangleMesh, Vec3};
use toile_picture::{ColourMap, ColourScale, Finish, Legend, Paint, Scene, Sheet, Surface, View};

/// Colours of the stretch in per cent, up to a limit (1).
pub(super) fn strain_scale(limit: f64) -> ColourScale {
    ColourScale {
        map: ColourMap::Heat,
        low: 0.0,
        high: 100.0 * limit.min(1.0),
        over: Some(ColourScale::OVER),
    }
}

/// The panel with the stretch of its cloth in colour, as PNG.
pub(super) fn strain_map(flat: &Flattened, limit: f64) -> Result<Vec<u8>, SessionError> {
    let scale = strain_scale(limit);
    let high = scale.high;
    let mesh = TriangleMesh {
        positions: (flat.places.iter())
            .map(|p| Vec3::new(p.x, p.y, 0.0))
            .collect(),
        triangles: flat.region.mesh().triangles.clone(),
    };
    let values = flat.stretch.iter().map(|s| 100.0 * s.size()).collect();
    let scene = Scene {
        surfaces: vec![Surface {
            paint: Paint::TriangleScalar(values, scale),
            ..Surface::plain(mesh, [0.8; 3], Finish::Smooth)
        }],
    };
    let legend = Legend {
        title: "Stretch of the cloth on the surface, either way".into(),
        unit: "%".into(),
        scale,
        ends: ["as cut".into(), "at the limit".into()],
        over: format!("over {high} %"),
    };
    let sheet = Sheet {
        views: vec![View::Front],
        ..Sheet::chart("Panel")
    };
    Ok(toile_picture::fit_picture(&scene, &legend, &sheet)?.to_png()?)
}
