//! Shading: key, fill and rim lamps that stand with the camera, and a sky.

use crate::camera::Camera;
use crate::colour::mix;
use crate::depth_map::DepthMap;
use crate::prepare::Prepared;
use crate::scene::Finish;
use toile_geometry::Vec3;

/// Cells a side of the key lamp's shadow map.
const SHADOW_CELLS: usize = 1024;
/// Brightness of the key lamp.
const KEY: f64 = 0.86;
/// Brightness of the fill lamp.
const FILL: f64 = 0.17;
/// Brightness of the rim lamp.
const RIM: f64 = 0.30;
/// Brightness of the sky.
const SKY: f64 = 0.44;
/// How much darker the wrong side of cloth is.
const WRONG_SIDE: f64 = 0.74;
/// How much light cloth lets through from its other side.
const THROUGH: f64 = 0.60;
/// How much of the light and shade a measured colour keeps.
const SCALAR_SHADE: f64 = 0.5;

/// The lamps of one view.
pub(crate) struct Lamps<'a> {
    prepared: &'a Prepared<'a>,
    key: Vec3,
    fill: Vec3,
    rim: Vec3,
    shadow: DepthMap,
}

/// A place on a triangle, as seen.
pub(crate) struct Place {
    pub triangle: usize,
    /// Weights of the corners, sum 1.
    pub weights: [f64; 3],
    /// Whether the right side is seen.
    pub right_side: bool,
    /// Unit vector towards the eye.
    pub to_eye: Vec3,
    /// Part of the paint under a line, 0..=1.
    pub line: f64,
}

impl<'a> Lamps<'a> {
    pub(crate) fn new(prepared: &'a Prepared<'a>, camera: &Camera) -> Self {
        let direction = |right: f64, up: f64, back: f64| {
            (right * camera.right + up * camera.up - back * camera.forward).normalize()
        };
        let key = direction(-0.74, 0.62, 0.66);
        Self {
            prepared,
            key,
            fill: direction(0.85, 0.15, 0.50),
            rim: direction(0.55, 0.55, -0.65),
            shadow: DepthMap::new(&prepared.positions, &prepared.triangles, key, SHADOW_CELLS),
        }
    }

    /// Linear light that comes from a place to the eye.
    pub(crate) fn shade(&self, place: &Place) -> [f64; 3] {
        let all = self.prepared;
        let corners = all.triangles[place.triangle];
        let blend = |values: &[Vec3]| -> Vec3 {
            (0..3)
                .map(|k| place.weights[k] * values[corners[k] as usize])
                .sum()
        };
        let mut normal = blend(&all.normals)
            .try_normalize(1e-9)
            .unwrap_or(place.to_eye);
        if !place.right_side {
            normal = -normal;
        }
        // Near an outline the smooth normal may turn away from the eye; it is bent back.
        let facing = normal.dot(&place.to_eye);
        if facing < 0.02 {
            normal = (normal + (0.02 - facing) * place.to_eye).normalize();
        }
        let side = usize::from(!place.right_side);
        let sky_on = |side: usize| -> f64 {
            (0..3)
                .map(|k| place.weights[k] * f64::from(all.ambient[corners[k] as usize][side]))
                .sum()
        };
        let finish = all.finish(place.triangle);
        let sky = match finish {
            Finish::Cloth => sky_on(side).max(THROUGH * sky_on(1 - side)),
            Finish::Smooth => sky_on(side),
        };
        let light = self.light(blend(&all.positions), normal, place, (sky, finish));
        let mut colour = all.colour(place.triangle, place.weights);
        let scalar = all.is_scalar(place.triangle);
        if finish == Finish::Cloth && !place.right_side && !scalar {
            colour = colour.map(|c| c * WRONG_SIDE);
        }
        let lines = &all.scene.surfaces[all.owner[place.triangle] as usize].lines;
        if place.line > 0.0 {
            let ink = all.line_colour(place.triangle);
            colour = mix(colour, ink, place.line * lines.opacity);
        }
        let (diffuse, sheen) = light;
        if scalar {
            let even = 1.0 - SCALAR_SHADE + SCALAR_SHADE * diffuse.min(1.0);
            return colour.map(|c| c * even);
        }
        colour.map(|c| shoulder(c * diffuse + sheen * (0.25 + 0.75 * c)))
    }

    /// Light for a white matt surface, and the edge light of cloth.
    fn light(
        &self,
        at: Vec3,
        normal: Vec3,
        place: &Place,
        (sky, finish): (f64, Finish),
    ) -> (f64, f64) {
        let cell = 1.0 / self.shadow.cells_per_metre;
        let toward = normal.dot(&self.key);
        let shadow = if toward > 0.0 {
            self.shadow.light(at + normal * (2.0 * cell), 1.5 * cell, 3)
        } else {
            0.0
        };
        let key = KEY * toward.max(0.0) * shadow;
        // Half of the fill goes round the edge, as from a wide screen.
        let fill = FILL * ((normal.dot(&self.fill) + 0.5) / 1.5).max(0.0) * sky;
        let rim = RIM * normal.dot(&self.rim).max(0.0) * sky;
        let grazing = 1.0 - normal.dot(&place.to_eye).clamp(0.0, 1.0);
        let sheen = match finish {
            Finish::Cloth => 0.10 * grazing.powi(4) * sky,
            Finish::Smooth => 0.04 * grazing.powi(5) * sky,
        };
        (SKY * sky * sky.sqrt().sqrt() + key + fill + rim, sheen)
    }
}

/// Bright light is rolled off instead of cut.
fn shoulder(light: f64) -> f64 {
    const FROM: f64 = 0.75;
    const ROOM: f64 = 1.0 - FROM;
    if light <= FROM {
        light
    } else {
        FROM + ROOM * (1.0 - (-(light - FROM) / ROOM).exp())
    }
}
