//! Finished pictures: several views of a scene side by side, with captions and a legend.

use crate::backdrop::Backdrop;
use crate::camera::{Camera, Projection, View};
use crate::image::Image;
use crate::legend::Legend;
use crate::prepare::Prepared;
use crate::raster;
use crate::scene::Scene;
use crate::text::{Align, TextStyle};
use crate::{PictureError, Rgb};
use toile_geometry::Vec3;

/// Size and words of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Words at the top; may be empty.
    pub title: String,
    /// Views from left to right, all at one scale.
    pub views: Vec<View>,
    /// What is behind.
    pub backdrop: Backdrop,
}

impl Sheet {
    /// A picture of 1600 x 1000 pixels from the front, half-way, the side and the back, in a
    /// light studio.
    pub fn studio(title: impl Into<String>) -> Self {
        Self {
            width: 1600,
            height: 1000,
            title: title.into(),
            views: vec![View::Front, View::ThreeQuarter, View::Side, View::Back],
            backdrop: Backdrop::default(),
        }
    }

    /// A picture of 1600 x 1000 pixels from the front, the side and the back, on white.
    pub fn chart(title: impl Into<String>) -> Self {
        Self {
            views: vec![View::Front, View::Side, View::Back],
            backdrop: Backdrop::PAPER,
            ..Self::studio(title)
        }
    }

    /// Height of captions \[pixel\].
    fn letters(&self) -> f64 {
        (0.0135 * self.height as f64).max(7.0)
    }
}

const SOFT: Rgb = [0.42, 0.41, 0.40];

/// Draws a scene from one camera.
///
/// # Errors
/// The scene is not fit to be drawn, or the size is empty or too large.
pub fn render(
    scene: &Scene,
    camera: &Camera,
    [width, height]: [usize; 2],
    backdrop: &Backdrop,
) -> Result<Image, PictureError> {
    raster::render(&Prepared::new(scene)?, camera, [width, height], backdrop)
}

/// Draws a scene as in a look-book: lit, from all sides of the sheet, with captions.
///
/// # Errors
/// The scene is empty or not fit to be drawn, or the size is empty or too large.
pub fn drape_picture(scene: &Scene, sheet: &Sheet) -> Result<Image, PictureError> {
    let letters = sheet.letters();
    let top = if sheet.title.is_empty() {
        0.0
    } else {
        3.5 * letters
    };
    let mut image = views(scene, sheet, [top, 3.5 * letters])?;
    write_title(&mut image, sheet);
    Ok(image)
}

/// Draws a scene whose surfaces carry measured values, with the key to their colours below.
///
/// # Errors
/// As [`drape_picture`], or the legend's range is empty.
pub fn fit_picture(scene: &Scene, legend: &Legend, sheet: &Sheet) -> Result<Image, PictureError> {
    legend.check()?;
    let letters = sheet.letters();
    let key = Legend::height(letters) + 2.0 * letters;
    let top = if sheet.title.is_empty() {
        0.0
    } else {
        3.5 * letters
    };
    let mut image = views(scene, sheet, [top, key + 3.5 * letters])?;
    write_title(&mut image, sheet);
    let width = (0.6 * sheet.width as f64)
        .max(30.0 * letters)
        .min(sheet.width as f64);
    let left = 0.5 * (sheet.width as f64 - width);
    legend.draw(
        &mut image,
        [left, sheet.height as f64 - key],
        width,
        letters,
    );
    Ok(image)
}

fn write_title(image: &mut Image, sheet: &Sheet) {
    let letters = sheet.letters();
    let style = TextStyle::plain(1.35 * letters);
    image.write([2.5 * letters, 3.4 * letters], &sheet.title, &style);
}

/// All views and their captions; `margins` are kept free above and below \[pixel\].
fn views(scene: &Scene, sheet: &Sheet, margins: [f64; 2]) -> Result<Image, PictureError> {
    let mut image = Image::new(sheet.width, sheet.height, sheet.backdrop.top)?;
    let prepared = Prepared::new(scene)?;
    let panes = panes(scene, sheet, margins)?;
    let letters = sheet.letters();
    let style = TextStyle {
        colour: SOFT,
        align: Align::Middle,
        ..TextStyle::plain(letters)
    };
    for pane in &panes {
        let size = [pane.width, sheet.height];
        let mut part = raster::render(&prepared, &pane.camera, size, &sheet.backdrop)?;
        let end = sheet.height as f64 - margins[1];
        fade(&mut part, &sheet.backdrop, end, 5.0 * letters);
        let middle = 0.5 * pane.width as f64;
        part.write([middle, end + 2.2 * letters], pane.view.name(), &style);
        image.place(&part, pane.left, 0);
    }
    Ok(image)
}

/// Lets what hangs into the lower margin disappear into the background over some rows.
fn fade(image: &mut Image, backdrop: &Backdrop, end: f64, rows: f64) {
    for y in (end - rows).max(0.0) as usize..image.height {
        let part = ((y as f64 + 0.5 - (end - rows)) / rows).clamp(0.0, 1.0);
        let height = (y as f64 + 0.5) / image.height as f64;
        let colour = crate::colour::srgb_from_linear(backdrop.plain(height));
        for x in 0..image.width {
            image.blend(x as i64, y as i64, colour, part * part * (3.0 - 2.0 * part));
        }
    }
}

struct Pane {
    view: View,
    camera: Camera,
    left: usize,
    width: usize,
}

/// Lays the views side by side at the largest common scale.
fn panes(scene: &Scene, sheet: &Sheet, margins: [f64; 2]) -> Result<Vec<Pane>, PictureError> {
    let [low, high] = framed_heights(scene)?;
    let bounds = scene.bounds().ok_or(PictureError::Empty)?;
    let mut middle = 0.5 * (bounds[0] + bounds[1]);
    middle.y = 0.5 * (low + high);
    let distance = 3.5 * (high - low).max(0.3 * (bounds[1] - bounds[0]).norm());
    let cameras: Vec<(View, Camera)> = sheet
        .views
        .iter()
        .map(|&view| {
            let projection = Projection::Perspective;
            (
                view,
                Camera::around(middle, distance, view.turn(), 0.05, projection),
            )
        })
        .collect();
    let extents: Vec<[f64; 4]> = cameras
        .iter()
        .map(|(_, camera)| extent(scene, camera, [low, high]))
        .collect();
    let bottom = extents.iter().map(|e| e[2]).fold(f64::INFINITY, f64::min);
    let top = extents
        .iter()
        .map(|e| e[3])
        .fold(f64::NEG_INFINITY, f64::max);
    let total: f64 = extents.iter().map(|e| e[1] - e[0]).sum();
    let free = (sheet.height as f64 - margins[0] - margins[1]).max(1.0);
    let gap = 0.03 * sheet.height as f64;
    let across = (sheet.width as f64 - gap * (extents.len() + 1) as f64).max(1.0);
    // Pixels a unit of tangent.
    let scale = (0.95 * free / (top - bottom)).min(across / total);
    if !scale.is_finite() {
        return Err(PictureError::Empty);
    }
    let spare = (across - scale * total) / extents.len() as f64;
    let mut edge = 0.5 * gap;
    let mut left = 0;
    let mut panes = Vec::new();
    for (k, (&(view, mut camera), e)) in cameras.iter().zip(&extents).enumerate() {
        edge += scale * (e[1] - e[0]) + gap + spare;
        let end = if k + 1 == extents.len() {
            sheet.width
        } else {
            (edge.round() as usize).clamp(left + 1, sheet.width)
        };
        let width = (end - left).max(1);
        let half = 0.5 * width as f64 / scale;
        let centre = 0.5 * (e[0] + e[1]);
        // The framed heights lie in the middle of the rows that are free.
        let up = 0.5 * (bottom + top) + (margins[0] + 0.5 * free) / scale;
        let down = up - sheet.height as f64 / scale;
        camera.window = [centre - half, centre + half, down, up];
        panes.push(Pane {
            view,
            camera,
            left,
            width,
        });
        left = end;
    }
    Ok(panes)
}

/// Lowest and highest place the picture must hold \[m\]: that of the framed surfaces, widened to
/// all surfaces where little would be missing.
fn framed_heights(scene: &Scene) -> Result<[f64; 2], PictureError> {
    let [low, high] = scene.framed_bounds().ok_or(PictureError::Empty)?;
    let [lowest, highest] = scene.bounds().ok_or(PictureError::Empty)?;
    let height = (high.y - low.y).max(0.1 * (highest.y - lowest.y)).max(1e-3);
    let bottom = if low.y - lowest.y < 0.3 * height {
        lowest.y
    } else {
        low.y - 0.10 * height
    };
    let top = if highest.y - high.y < 0.5 * height {
        highest.y
    } else {
        high.y + 0.10 * height
    };
    Ok([bottom, top])
}

/// Left, right, bottom and top of what a camera sees between two heights \[tangent\].
fn extent(scene: &Scene, camera: &Camera, [low, high]: [f64; 2]) -> [f64; 4] {
    let mut extent = [
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::INFINITY,
        f64::NEG_INFINITY,
    ];
    let mut add = |p: Vec3| {
        if let Some([x, y]) = camera.tangent(p) {
            extent[0] = extent[0].min(x);
            extent[1] = extent[1].max(x);
            extent[2] = extent[2].min(y);
            extent[3] = extent[3].max(y);
        }
    };
    for p in scene.surfaces.iter().flat_map(|s| &s.mesh.positions) {
        if (low..=high).contains(&p.y) {
            add(*p);
        }
    }
    extent
}
