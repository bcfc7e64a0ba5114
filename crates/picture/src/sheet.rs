//! Finished pictures (drape and fit pictures): several views of a scene side by side, with captions and a
//! legend.

use crate::backdrop::Backdrop;
use crate::camera::{Camera, Projection, View, box_corners};
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
    /// Words under the title in the colour of a warning; may be empty.
    pub warning: String,
    /// Views from left to right, all at one scale.
    pub views: Vec<View>,
    /// A box (m) that the views show, whatever the scene fills of it, so that pictures of one motion have one camera.
    /// Without it they show what the scene holds.
    pub room: Option<[Vec3; 2]>,
    /// The background.
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
            warning: String::new(),
            views: vec![View::Front, View::ThreeQuarter, View::Side, View::Back],
            room: None,
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

    /// Height of captions (pixel).
    fn letters(&self) -> f64 {
        (0.0135 * self.height as f64).max(7.0)
    }
}

/// Angle of the cameras above the horizon (rad).
const RISE: f64 = 0.05;
/// Colour of captions.
const SOFT: Rgb = [0.42, 0.41, 0.40];
/// Colour of warnings.
const WARNING: Rgb = [0.72, 0.13, 0.10];

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
    raster::render(
        &Prepared::new(scene, None)?,
        camera,
        [width, height],
        backdrop,
    )
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
    let key = Legend::height(letters) + letters;
    let top = if sheet.title.is_empty() {
        0.0
    } else {
        3.5 * letters
    };
    let mut image = views(scene, sheet, [top, key + 4.5 * letters])?;
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
    let style = TextStyle {
        colour: WARNING,
        ..style
    };
    image.write([2.5 * letters, 5.4 * letters], &sheet.warning, &style);
}

/// All views and their captions; `margins` are kept free above and below (pixel).
fn views(scene: &Scene, sheet: &Sheet, margins: [f64; 2]) -> Result<Image, PictureError> {
    let mut image = Image::new(sheet.width, sheet.height, sheet.backdrop.top)?;
    let prepared = Prepared::new(scene, sheet.room)?;
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
        let rows = 5.0 * letters;
        fade(&mut part, &sheet.backdrop, [margins[0], rows], [end, rows]);
        let middle = 0.5 * pane.width as f64;
        part.write([middle, end + 2.2 * letters], pane.view.name(), &style);
        image.place(&part, pane.left, 0);
    }
    Ok(image)
}

/// Lets what hangs into the margins disappear into the background: above a first row over a
/// number of rows, and likewise below a last one.
fn fade(image: &mut Image, backdrop: &Backdrop, top: [f64; 2], bottom: [f64; 2]) {
    for y in 0..image.height {
        let row = y as f64 + 0.5;
        let above = if top[0] > 0.0 {
            (top[0] + top[1] - row) / top[1]
        } else {
            0.0
        };
        let below = (row - (bottom[0] - bottom[1])) / bottom[1];
        let part = above.max(below).clamp(0.0, 1.0);
        if part == 0.0 {
            continue;
        }
        let colour = crate::colour::srgb_from_linear(backdrop.plain(row / image.height as f64));
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

/// Cameras with what each of them must show, and the largest scale at which it all fits.
struct Layout {
    cameras: Vec<(View, Camera)>,
    /// Left, right, bottom and top of each view (tangent).
    extents: Vec<[f64; 4]>,
    /// Lowest and highest of all views (tangent).
    heights: [f64; 2],
    /// Distance of the cameras (m).
    distance: f64,
    /// Pixels a unit of tangent.
    scale: f64,
}

/// What the views show.
struct Subject {
    /// Corners of triangles or of a box (m).
    points: Vec<Vec3>,
    /// Smallest and largest coordinates of the points (m).
    bounds: [Vec3; 2],
    /// Lowest and highest place that must be seen (m).
    heights: [f64; 2],
}

impl Subject {
    /// The box of a sheet, or else the scene.
    fn new(scene: &Scene, sheet: &Sheet) -> Result<Self, PictureError> {
        let Some(bounds) = sheet.room else {
            return Ok(Self {
                points: scene.surfaces.iter().flat_map(|s| s.corners()).collect(),
                bounds: scene.bounds().ok_or(PictureError::Empty)?,
                heights: framed_heights(scene)?,
            });
        };
        let [low, high] = bounds;
        Ok(Self {
            points: box_corners(bounds).to_vec(),
            bounds,
            heights: [low.y, high.y.max(low.y + 1e-3)],
        })
    }
}

/// Pixels left free of figures between the views.
fn gap(sheet: &Sheet) -> f64 {
    0.03 * sheet.height as f64
}

/// Pixels across and down that figures may fill.
fn room(sheet: &Sheet, margins: [f64; 2]) -> [f64; 2] {
    let across = sheet.width as f64 - gap(sheet) * (sheet.views.len() + 1) as f64;
    let down = sheet.height as f64 - margins[0] - margins[1];
    [across.max(1.0), down.max(1.0)]
}

impl Layout {
    /// Shows what lies between two heights (m).
    fn new(
        subject: &Subject,
        sheet: &Sheet,
        [across, down]: [f64; 2],
        [low, high]: [f64; 2],
    ) -> Result<Self, PictureError> {
        let bounds = subject.bounds;
        let mut middle = 0.5 * (bounds[0] + bounds[1]);
        middle.y = 0.5 * (low + high);
        let distance = 3.5 * (high - low).max(0.3 * (bounds[1] - bounds[0]).norm());
        let place = |&view: &View| {
            let projection = Projection::Perspective;
            (
                view,
                Camera::around(middle, distance, view.turn(), RISE, projection),
            )
        };
        let cameras: Vec<(View, Camera)> = sheet.views.iter().map(place).collect();
        let extents: Vec<[f64; 4]> = cameras
            .iter()
            .map(|(_, camera)| extent(&subject.points, camera, [low, high]))
            .collect();
        let bottom = extents.iter().map(|e| e[2]).fold(f64::INFINITY, f64::min);
        let top = extents
            .iter()
            .map(|e| e[3])
            .fold(f64::NEG_INFINITY, f64::max);
        let total: f64 = extents.iter().map(|e| e[1] - e[0]).sum();
        let scale = (0.95 * down / (top - bottom)).min(across / total);
        if !scale.is_finite() {
            return Err(PictureError::Empty);
        }
        Ok(Self {
            cameras,
            extents,
            heights: [bottom, top],
            distance,
            scale,
        })
    }
}

/// Lays the views side by side at the largest common scale. All of the scene is shown unless
/// that makes what is framed much smaller.
fn panes(scene: &Scene, sheet: &Sheet, margins: [f64; 2]) -> Result<Vec<Pane>, PictureError> {
    let room = room(sheet, margins);
    let subject = Subject::new(scene, sheet)?;
    let [low, high] = subject.heights;
    let (lowest, highest) = (subject.bounds[0].y, subject.bounds[1].y.max(high));
    let close = Layout::new(&subject, sheet, room, [low, high])?;
    let whole = Layout::new(&subject, sheet, room, [lowest, highest])?;
    let layout = if whole.scale / whole.distance >= 0.85 * close.scale / close.distance {
        whole
    } else {
        // Height that is left over shows more of what is below, then of what is above.
        let [bottom, top] = close.heights;
        let left_over = (0.95 * room[1] / close.scale - (top - bottom)) * close.distance;
        let down = left_over.clamp(0.0, (low - lowest).max(0.0));
        let up = (left_over - down).clamp(0.0, (highest - high).max(0.0));
        Layout::new(&subject, sheet, room, [low - down, high + up])?
    };
    Ok(place_panes(&layout, sheet, margins))
}

fn place_panes(layout: &Layout, sheet: &Sheet, margins: [f64; 2]) -> Vec<Pane> {
    let [across, down] = room(sheet, margins);
    let Layout {
        extents,
        scale,
        heights: [bottom, top],
        ..
    } = layout;
    let count = extents.len();
    let total: f64 = extents.iter().map(|e| e[1] - e[0]).sum();
    let spare = (across - scale * total) / count as f64;
    let mut edge = 0.5 * gap(sheet);
    let mut left = 0;
    let mut panes = Vec::new();
    for (k, (&(view, mut camera), e)) in layout.cameras.iter().zip(extents).enumerate() {
        edge += scale * (e[1] - e[0]) + gap(sheet) + spare;
        let end = if k + 1 == count {
            sheet.width
        } else {
            (edge.round() as usize).clamp(left + 1, sheet.width.max(left + 1))
        };
        let width = end.saturating_sub(left).max(1);
        let half = 0.5 * width as f64 / scale;
        let centre = 0.5 * (e[0] + e[1]);
        // The shown heights lie in the middle of the rows that are free.
        let up = 0.5 * (bottom + top) + (margins[0] + 0.5 * down) / scale;
        camera.window = [
            centre - half,
            centre + half,
            up - sheet.height as f64 / scale,
            up,
        ];
        panes.push(Pane {
            view,
            camera,
            left,
            width,
        });
        left = end;
    }
    panes
}

/// Lowest and highest place the picture must hold (m): that of the framed surfaces, widened to
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

/// Left, right, bottom and top of what a camera sees between two heights (tangent).
fn extent(points: &[Vec3], camera: &Camera, [low, high]: [f64; 2]) -> [f64; 4] {
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
    for &p in points {
        if (low..=high).contains(&p.y) {
            add(p);
        }
    }
    extent
}
