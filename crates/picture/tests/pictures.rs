//! Facts about whole pictures of synthetic scenes.
#![allow(clippy::unwrap_used)]

mod figures;

use figures::{capsule, sheet, skirt, sphere};
use proptest::prelude::*;
use std::f64::consts::PI;
use toile_geometry::{TriangleMesh, Vec3};
use toile_picture::{
    Backdrop, Camera, ColourMap, ColourScale, Edges, Finish, Image, Legend, Lines, Paint,
    PictureError, Projection, Scene, Sheet, Surface, View, drape_picture, fit_picture, render,
};

const RED: [f64; 3] = [0.8, 0.1, 0.1];
const GREEN: [f64; 3] = [0.1, 0.7, 0.1];

fn scene(surfaces: impl IntoIterator<Item = Surface>) -> Scene {
    Scene {
        surfaces: surfaces.into_iter().collect(),
    }
}

fn cloth(mesh: TriangleMesh, colour: [f64; 3]) -> Surface {
    Surface::plain(mesh, colour, Finish::Cloth)
}

/// A square of two metres across the view at a depth.
fn square(z: f64) -> TriangleMesh {
    sheet(7, 9, |u, v| Vec3::new(2.0 * u - 1.0, 2.0 * v - 1.0, z))
}

/// Looks from +Z at a window of four metres, 100 pixels a metre.
fn straight(scene: &Scene) -> Image {
    let eye = Vec3::new(0.0, 0.0, 5.0);
    let camera = Camera::look_at(eye, Vec3::zeros(), Projection::Orthographic, [2.0, 2.0]);
    render(scene, &camera, [400, 400], &Backdrop::PAPER).unwrap()
}

/// Sum over pixels of how far they are from white paper towards black, by one channel.
fn ink(image: &Image, channel: usize) -> f64 {
    let pixels = image.pixels.chunks(4);
    pixels.map(|p| 1.0 - f64::from(p[channel]) / 255.0).sum()
}

fn is_white(pixel: [u8; 4]) -> bool {
    pixel == [255; 4]
}

#[test]
fn a_ball_covers_its_disc() {
    let ball = cloth(sphere(Vec3::zeros(), 1.2, 90), [0.0; 3]);
    let image = straight(&scene([ball]));
    let inside = image.pixels.chunks(4).filter(|p| p[0] < 128).count() as f64;
    let disc = PI * 120.0 * 120.0;
    assert!((inside / disc - 1.0).abs() < 0.005, "{inside} of {disc}");
}

#[test]
fn edges_are_soft_and_in_place() {
    // A black square with its edge at 0.3 pixel: the border column is partly covered.
    let mesh = sheet(5, 5, |u, v| Vec3::new(2.003 * u - 1.0, 2.0 * v - 1.0, 0.0));
    let image = straight(&scene([cloth(mesh, [0.0; 3])]));
    assert!(is_white(image.pixel(301, 200).unwrap()));
    let border = image.pixel(300, 200).unwrap()[0];
    assert!((120..240).contains(&border), "{border}");
    assert!(image.pixel(299, 200).unwrap()[0] < 60);
}

#[test]
fn a_closed_surface_has_no_holes() {
    let image = straight(&scene([cloth(sphere(Vec3::zeros(), 1.5, 140), RED)]));
    for y in 0..400_i64 {
        for x in 0..400_i64 {
            let radius = ((x - 200) as f64 + 0.5).hypot((y - 200) as f64 + 0.5);
            if radius < 147.0 {
                let p = image.pixel(x as usize, y as usize).unwrap();
                assert!(p[2] < 190, "{x} {y}: {p:?}");
            }
        }
    }
}

#[test]
fn the_nearer_surface_hides_the_farther_in_any_order() {
    let mut surfaces = [cloth(square(0.5), RED), cloth(square(-0.5), GREEN)];
    for _ in 0..2 {
        let pixel = straight(&scene(surfaces.clone())).pixel(200, 200).unwrap();
        assert!(pixel[0] > 2 * pixel[1], "{pixel:?}");
        surfaces.reverse();
    }
}

#[test]
fn the_wrong_side_is_darker() {
    let right = square(0.0);
    let mut wrong = right.clone();
    wrong.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    let of = |mesh: TriangleMesh, finish| {
        let s = Surface::plain(mesh, RED, finish);
        straight(&scene([s])).pixel(200, 200).unwrap()[0]
    };
    assert!(of(wrong.clone(), Finish::Cloth) + 15 < of(right.clone(), Finish::Cloth));
    assert_eq!(of(wrong, Finish::Smooth), of(right, Finish::Smooth));
}

#[test]
fn light_stands_with_the_camera() {
    // A ball looks the same from all sides: all that differs is the mesh and the sky's samples.
    let balls = scene([cloth(sphere(Vec3::zeros(), 1.0, 80), RED)]);
    let bounds = balls.bounds().unwrap();
    let pictures = [View::Front, View::Side, View::Back].map(|view| {
        let camera = Camera::fit_to(bounds, view, 1.0, Projection::Orthographic);
        render(&balls, &camera, [200, 200], &Backdrop::PAPER).unwrap()
    });
    for other in &pictures[1..] {
        for (a, b) in pictures[0].pixels.iter().zip(&other.pixels) {
            assert!(a.abs_diff(*b) <= 12, "{a} {b}");
        }
    }
    // The key lamp is at the upper left.
    let at = |x, y| pictures[0].pixel(x, y).unwrap()[0];
    assert!(at(70, 70) > at(130, 130) + 30);
}

#[test]
fn a_roof_throws_a_shadow() {
    let wall = square(0.0);
    let roof = sheet(4, 4, |u, v| Vec3::new(2.4 * u - 1.2, 1.05, 1.0 - 1.0 * v));
    let open = straight(&scene([cloth(wall.clone(), GREEN)]));
    let roofed = straight(&scene([cloth(wall, GREEN), cloth(roof, RED)]));
    let green = |image: &Image, y| image.pixel(200, y).unwrap()[1];
    assert!(green(&roofed, 120) + 40 < green(&open, 120));
}

#[test]
fn the_ground_is_darker_under_the_figure() {
    let figure = scene([Surface::plain(capsule(0.2, 1.7), [0.8; 3], Finish::Smooth)]);
    let camera = Camera::fit_to(
        figure.bounds().unwrap(),
        View::Front,
        1.0,
        Projection::Perspective,
    );
    let image = render(&figure, &camera, [300, 300], &Backdrop::default()).unwrap();
    let near_feet = image.pixel(125, 290).unwrap()[0];
    let far = image.pixel(20, 290).unwrap()[0];
    assert!(near_feet + 4 < far, "{near_feet} {far}");
}

#[test]
fn colours_tell_values() {
    let scale = ColourScale {
        map: ColourMap::Depth,
        low: 0.0,
        high: 1.0,
        over: Some(ColourScale::OVER),
    };
    let mesh = square(0.0);
    let values = mesh.positions.iter().map(|p| 0.6 * (p.x + 1.0)).collect();
    let mut surface = cloth(mesh, RED);
    surface.paint = Paint::VertexScalar(values, scale);
    let image = straight(&scene([surface]));
    for (x, value) in [(110, 0.063), (200, 0.603), (250, 0.903), (290, 1.143)] {
        let pixel = image.pixel(x, 200).unwrap();
        let wanted = scale.colour(value).map(|c| c * 255.0);
        // Light may dim a colour, but its parts keep their proportion.
        let dim = (0..3).map(|k| f64::from(pixel[k])).sum::<f64>() / wanted.iter().sum::<f64>();
        assert!((0.7..=1.02).contains(&dim), "{x}: {dim}");
        for k in 0..3 {
            let expected = wanted[k] * dim;
            assert!(
                (f64::from(pixel[k]) - expected).abs() < 14.0,
                "{x}: {pixel:?} {wanted:?}"
            );
        }
    }
}

#[test]
fn lines_lie_on_the_asked_edges() {
    let mesh = sheet(2, 1, |u, v| Vec3::new(2.0 * u - 1.0, 2.0 * v - 1.0, 0.0));
    let mut surface = cloth(mesh, [0.9; 3]);
    let plain = ink(&straight(&scene([surface.clone()])), 0);
    surface.lines = Lines {
        edges: Edges::Pairs(vec![[4, 1]]),
        colour: [0.0; 3],
        width: 4.0,
        opacity: 1.0,
    };
    let image = straight(&scene([surface.clone()]));
    assert!(image.pixel(200, 150).unwrap()[0] < 40);
    assert!(image.pixel(190, 150).unwrap()[0] > 150);
    let seam = ink(&image, 0) - plain;
    surface.lines.edges = Edges::All;
    let all = ink(&straight(&scene([surface])), 0) - plain;
    assert!(all > 3.0 * seam, "{all} {seam}");
}

#[test]
fn one_and_two_threads_give_the_same_bytes() {
    let figure = scene([
        Surface::plain(capsule(0.2, 1.7), [0.8; 3], Finish::Smooth),
        cloth(skirt(80, 40), RED),
    ]);
    let mut sheet = Sheet::studio("Skirt");
    (sheet.width, sheet.height) = (480, 300);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| drape_picture(&figure, &sheet).unwrap().to_png().unwrap())
    };
    assert!(with(1) == with(2));
}

#[test]
fn a_sheet_shows_all_its_views_at_one_scale() {
    let figure = scene([cloth(skirt(60, 30), [0.0; 3])]);
    let mut sheet = Sheet::chart("");
    (sheet.width, sheet.height) = (900, 400);
    let image = drape_picture(&figure, &sheet).unwrap();
    assert_eq!((image.width, image.height), (900, 400));
    // Black runs along the middle row: one a view, about equally wide, none touching the border.
    let dark: Vec<bool> = (0..900)
        .map(|x| image.pixel(x, 180).unwrap()[0] < 120)
        .collect();
    let mut runs = Vec::new();
    for x in 1..900 {
        if dark[x] && !dark[x - 1] {
            runs.push((x, x));
        }
        if dark[x]
            && let Some(last) = runs.last_mut()
        {
            last.1 = x;
        }
    }
    runs.retain(|(a, b)| b - a > 40);
    assert_eq!(runs.len(), 3, "{runs:?}");
    assert!(!dark[0] && !dark[899]);
    let widths: Vec<usize> = runs.iter().map(|(a, b)| b - a).collect();
    assert!(
        widths.iter().all(|w| w.abs_diff(widths[0]) < widths[0] / 5),
        "{widths:?}"
    );
}

#[test]
fn a_fit_picture_carries_its_legend() {
    let scale = ColourScale {
        map: ColourMap::Heat,
        low: 0.0,
        high: 5.0,
        over: Some(ColourScale::OVER),
    };
    let mesh = skirt(60, 30);
    let values = vec![1.0; mesh.triangles.len()];
    let mut surface = cloth(mesh, RED);
    surface.paint = Paint::TriangleScalar(values, scale);
    let figure = scene([surface]);
    let mut legend = Legend {
        title: "Stretch along the weft".into(),
        unit: "%".into(),
        scale,
        ends: ["relaxed".into(), "tight".into()],
        over: "over 5 %".into(),
    };
    let mut sheet = Sheet::chart("Fit");
    (sheet.width, sheet.height) = (640, 400);
    let image = fit_picture(&figure, &legend, &sheet).unwrap();
    let over = ColourScale::OVER.map(|c| (c * 255.0).round() as u8);
    let marked = image.pixels.chunks(4).filter(|p| p[..3] == over).count();
    assert!(marked > 50, "{marked}");
    legend.scale.high = f64::NAN;
    assert!(matches!(
        fit_picture(&figure, &legend, &sheet),
        Err(PictureError::NotFinite(_))
    ));
}

#[test]
fn pictures_of_one_room_have_one_camera() {
    let mut sheet = Sheet::chart("");
    (sheet.width, sheet.height) = (900, 400);
    // Leftmost and topmost black pixel of a ball at rest, beside a sheet that moves.
    let ball_in = |height: f64, sheet: &Sheet| {
        let ball = cloth(sphere(Vec3::zeros(), 0.2, 40), [0.0; 3]);
        let moving = square(0.0)
            .positions
            .iter()
            .map(|p| 0.2 * p + height * Vec3::y())
            .collect();
        let moving = TriangleMesh {
            positions: moving,
            ..square(0.0)
        };
        let image = drape_picture(&scene([ball, cloth(moving, GREEN)]), sheet).unwrap();
        let is_black = |p: [u8; 4]| p[..3].iter().all(|&c| c < 60);
        let black = (0..900 * 400).map(|k| [k % 900, k / 900]);
        let black: Vec<_> = black
            .filter(|&[x, y]| is_black(image.pixel(x, y).unwrap()))
            .collect();
        [0, 1].map(|axis| black.iter().map(|at| at[axis]).min().unwrap())
    };
    assert_ne!(ball_in(0.6, &sheet), ball_in(1.2, &sheet));
    sheet.room = Some([Vec3::new(-0.3, -0.3, -0.3), Vec3::new(0.3, 1.4, 0.3)]);
    assert_eq!(ball_in(0.6, &sheet), ball_in(1.2, &sheet));
}

#[test]
fn what_cannot_be_drawn_is_refused_in_words() {
    let sheet = Sheet::studio("");
    let empty = drape_picture(&Scene::default(), &sheet).unwrap_err();
    assert!(empty.to_string().contains("add a surface"));
    let bare = scene([cloth(TriangleMesh::default(), RED)]);
    assert!(matches!(
        drape_picture(&bare, &sheet),
        Err(PictureError::Empty)
    ));
    let camera = Camera::fit_to(
        [Vec3::zeros(); 2],
        View::Front,
        1.0,
        Projection::Perspective,
    );
    assert!(render(&bare, &camera, [0, 10], &Backdrop::PAPER).is_err());
    assert!(render(&bare, &camera, [10, 10], &Backdrop::PAPER).is_ok());
    let no_views = Sheet {
        views: vec![],
        ..Sheet::studio("")
    };
    assert!(drape_picture(&scene([cloth(square(0.0), RED)]), &no_views).is_err());
}

#[test]
fn flat_thin_and_single_things_are_drawn() {
    let mut sheet = Sheet::studio("x");
    (sheet.width, sheet.height) = (160, 100);
    let line = TriangleMesh {
        positions: vec![Vec3::zeros(), Vec3::x(), 2.0 * Vec3::x()],
        triangles: vec![[0, 1, 2]],
    };
    let point = TriangleMesh {
        positions: vec![Vec3::zeros(); 3],
        triangles: vec![[0, 1, 2], [0, 0, 1]],
    };
    for mesh in [line, point, square(0.0)] {
        let image = drape_picture(&scene([cloth(mesh, RED)]), &sheet).unwrap();
        assert_eq!(image.pixels.len(), 4 * 160 * 100);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn any_triangles_before_any_camera_do_not_panic(
        points in prop::collection::vec(prop::array::uniform3(-1e3..1e3), 3..30),
        eye in prop::array::uniform3(-10.0..10.0), scale in -9..9_i32,
    ) {
        let factor = 10_f64.powi(scale);
        let positions: Vec<Vec3> = points.iter().map(|p| Vec3::from(*p) * factor).collect();
        let count = positions.len() as u32;
        let triangles = (0..count - 2).map(|k| [k, k + 1, k + 2]).collect();
        let wild = scene([cloth(TriangleMesh { positions, triangles }, RED)]);
        for projection in [Projection::Orthographic, Projection::Perspective] {
            let camera = Camera::look_at(Vec3::from(eye), Vec3::zeros(), projection, [1.0, 0.7]);
            let image = render(&wild, &camera, [40, 28], &Backdrop::default()).unwrap();
            prop_assert_eq!(image.pixels.len(), 4 * 40 * 28);
        }
        let mut sheet = Sheet::studio("wild");
        (sheet.width, sheet.height) = (80, 50);
        prop_assert!(drape_picture(&wild, &sheet).is_ok());
    }
}
