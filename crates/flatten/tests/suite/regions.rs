//! Regions cut out of surfaces along shortest paths, against closed forms; loops that bound none.

use crate::common::{grid, options};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use toile_flatten::{
    LoopError, Options, PathNode, Region, Spanning, SplitMesh, SurfaceLoop, SurfaceRegion, cut_out,
    flatten_surface, shortest_path, surface_path,
};
use toile_geometry::{SurfaceTree, TriangleMesh, Vec3};

/// A closed sphere of 10 cm: a cube of grids pushed out, so many cells a side.
fn ball(cells: u32) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    for axis in 0..3 {
        for sign in [-1.0, 1.0] {
            let face = grid(cells as usize, cells as usize, |u, v| {
                // Equal angles, so that the cells are about equal.
                let (a, b) = ((u - 0.5) * FRAC_PI_2, (v - 0.5) * FRAC_PI_2);
                let mut p = Vec3::zeros();
                p[axis] = sign;
                p[(axis + 1) % 3] = sign * a.tan();
                p[(axis + 2) % 3] = b.tan();
                p.normalize() * 0.1
            });
            mesh.append(&face);
        }
    }
    // Vertices of neighbouring faces are joined.
    let mut numbers: Vec<u32> = Vec::new();
    let mut positions: Vec<Vec3> = Vec::new();
    for p in &mesh.positions {
        let found = positions.iter().position(|q| (p - q).norm() < 1e-9);
        numbers.push(found.unwrap_or(positions.len()) as u32);
        if found.is_none() {
            positions.push(*p);
        }
    }
    mesh.triangles
        .iter_mut()
        .for_each(|t| *t = t.map(|v| numbers[v as usize]));
    mesh.positions = positions;
    mesh.orient();
    assert!(mesh.is_closed_and_oriented() && mesh.volume() > 0.0);
    mesh
}

fn sheet() -> TriangleMesh {
    grid(10, 10, |u, v| Vec3::new(u, v, 0.0))
}

fn on_ball(longitude: f64, latitude: f64) -> Vec3 {
    let (x, y) = (longitude.to_radians(), latitude.to_radians());
    Vec3::new(x.sin() * y.cos(), y.sin(), x.cos() * y.cos()) * 0.1
}

fn length(mesh: &SplitMesh, path: &[PathNode]) -> f64 {
    let place = |node: &PathNode| match *node {
        PathNode::Vertex(v) => mesh.positions()[v as usize],
        PathNode::Edge {
            ends: [a, b],
            share,
        } => mesh.positions()[a as usize].lerp(&mesh.positions()[b as usize], share),
    };
    path.windows(2)
        .map(|pair| (place(&pair[1]) - place(&pair[0])).norm())
        .sum()
}

#[test]
fn paths_are_straight_on_a_sheet_and_round_a_box() {
    let split = SplitMesh::new(&sheet()).unwrap();
    for (from, to) in [(0, 120), (3, 117), (10, 110), (5, 5 + 11 * 10), (14, 106)] {
        let path = shortest_path(&split, from, to).unwrap();
        let straight = (split.positions()[from as usize] - split.positions()[to as usize]).norm();
        assert!(
            (length(&split, &path) - straight).abs() < 1e-12,
            "{from} {to}"
        );
    }
    // Across two faces of a cube, from corner to far corner: the root of five.
    let cube = SplitMesh::new(&TriangleMesh::cuboid(Vec3::zeros(), Vec3::repeat(1.0))).unwrap();
    let path = shortest_path(&cube, 0, 7).unwrap();
    assert!((length(&cube, &path) - 5f64.sqrt()).abs() < 1e-12);
}

#[test]
fn paths_on_a_cylinder_and_a_ball_have_the_lengths_of_geodesics() {
    // A closed cylinder wall: unrolled it is a sheet, in either direction.
    let count = 40u32;
    let mut wall = TriangleMesh::default();
    let flat = PI / f64::from(count);
    for j in 0..=10u32 {
        for i in 0..count {
            let a = TAU * f64::from(i) / f64::from(count);
            wall.positions
                .push(Vec3::new(0.1 * a.cos(), 0.02 * f64::from(j), 0.1 * a.sin()));
        }
    }
    for j in 0..10 {
        for i in 0..count {
            let at = |i: u32, j: u32| j * count + i % count;
            wall.triangles.extend([
                [at(i, j), at(i, j + 1), at(i + 1, j)],
                [at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)],
            ]);
        }
    }
    let split = SplitMesh::new(&wall).unwrap();
    let chord = 0.2 * flat.sin();
    for (i, j) in [(13, 10), (7, 3), (35, 8), (19, 0)] {
        let path = shortest_path(&split, 0, j * count + i).unwrap();
        let across = chord * f64::from(i.min(count - i));
        let expected = across.hypot(0.02 * f64::from(j));
        assert!((length(&split, &path) - expected).abs() < 1e-10, "{i} {j}");
    }
    let split = SplitMesh::new(&ball(12)).unwrap();
    for to in [37, 200, 411, 700] {
        let (a, b) = (split.positions()[0], split.positions()[to as usize]);
        let path = shortest_path(&split, 0, to).unwrap();
        let arc = 0.1 * a.angle(&b);
        let found = length(&split, &path);
        assert!((found / arc - 1.0).abs() < 5e-3, "{found} {arc}");
    }
}

#[test]
fn a_path_between_places_of_a_ball_is_a_great_circle() {
    let ball = SurfaceTree::new(ball(16));
    let ends = [on_ball(10.0, 5.0), on_ball(70.0, 40.0)];
    let path = surface_path(&ball, ends).unwrap();
    let length: f64 = path.windows(2).map(|p| (p[1] - p[0]).norm()).sum();
    let arc = 0.1 * (ends[0].dot(&ends[1]) / 0.01).acos();
    assert!((length / arc - 1.0).abs() < 0.003, "{length} {arc}");
    assert!((path[0] - ends[0]).norm() < 1e-3 && (path[path.len() - 1] - ends[1]).norm() < 1e-3);
    let same = surface_path(&ball, [ends[0], ends[0]]);
    assert!(matches!(same, Err(LoopError::Same(..))), "{same:?}");
}

#[test]
fn a_region_of_a_closed_ball_has_the_area_between_its_great_circles() {
    // An octant: an eighth of the sphere.
    let ball = ball(24);
    let asked = SurfaceLoop {
        places: vec![on_ball(-20.0, 0.0), on_ball(70.0, 0.0), on_ball(0.0, 90.0)],
        ..SurfaceLoop::default()
    };
    let region = cut_out(&ball, &asked).unwrap();
    // Shortest paths on the faceted ball keep off its vertices, to one side of the great circles.
    let octant = 0.5 * PI * 0.01;
    let area = region.surface().area();
    assert!((area / octant - 1.0).abs() < 1e-2, "{area} {octant}");
    assert!(Region::new(&region.surface()).is_ok());
    // The larger side is named by a place.
    let inside = Some(on_ball(180.0, 0.0));
    let rest = cut_out(
        &ball,
        &SurfaceLoop {
            inside,
            ..asked.clone()
        },
    )
    .unwrap();
    let whole = rest.surface().area() + area;
    assert!((whole - ball.area()).abs() < 1e-12);
    // Moved out by a tenth.
    let moved = region.moved_out(0.01).surface().area();
    assert!((moved / (1.21 * area) - 1.0).abs() < 2e-3);
}

#[test]
fn a_region_is_meshed_with_even_triangles_that_keep_its_area_and_outline() {
    let asked = SurfaceLoop {
        places: vec![
            on_ball(-40.0, -30.0),
            on_ball(40.0, -30.0),
            on_ball(35.0, 30.0),
            on_ball(-35.0, 30.0),
        ],
        cuts: vec![vec![on_ball(0.0, -37.0), on_ball(3.0, -5.0)]],
        ..SurfaceLoop::default()
    };
    let region = cut_out(&ball(20), &asked).unwrap();
    let edge = 0.006;
    let meshed = region.remeshed(edge).unwrap();
    let disk = Region::new(&meshed.mesh).unwrap();
    assert_eq!(disk.vertex_count(), meshed.mesh.positions.len());
    let (before, after) = (region.surface().area(), meshed.mesh.area());
    assert!((after / before - 1.0).abs() < 3e-3, "{before} {after}");
    // Angles and edges.
    let mut least = f64::INFINITY;
    let mut lengths = Vec::new();
    for t in 0..meshed.mesh.triangles.len() {
        let c = meshed.mesh.corners(t);
        for k in 0..3 {
            let (u, v) = (c[(k + 1) % 3] - c[k], c[(k + 2) % 3] - c[k]);
            least = f64::min(least, u.angle(&v).to_degrees());
            lengths.push(u.norm() / edge);
        }
    }
    lengths.sort_by(f64::total_cmp);
    assert!(least > 20.0, "{least}");
    let (low, high) = (
        lengths[lengths.len() / 50],
        lengths[lengths.len() * 49 / 50],
    );
    assert!(low > 0.6 && high < 1.5, "{low} {high}");
    // The cut runs along edges, straight, to the place asked for.
    let cut = &meshed.cuts[0];
    let topology = meshed.mesh.topology();
    assert!(cut.windows(2).all(|p| topology.edge(p[0], p[1]).is_some()));
    let place = |v: u32| meshed.mesh.positions[v as usize];
    let end = place(cut[cut.len() - 1]);
    assert!((end - on_ball(3.0, -5.0)).norm() < 5e-4);
    let way: f64 = cut
        .windows(2)
        .map(|p| (place(p[1]) - place(p[0])).norm())
        .sum();
    let arc = 0.1 * place(cut[0]).angle(&end);
    assert!((way / arc - 1.0).abs() < 0.01, "{way} {arc}");
}

#[test]
fn a_region_of_a_sheet_flattens_to_itself_and_its_darts_are_straight() {
    let asked = SurfaceLoop {
        places: [[0.12, 0.15], [0.83, 0.21], [0.77, 0.88], [0.31, 0.74]]
            .map(|[x, y]| Vec3::new(x, y, 0.003))
            .to_vec(),
        ..SurfaceLoop::default()
    };
    let region = cut_out(&sheet(), &asked).unwrap();
    assert!((region.farthest - 0.003).abs() < 1e-12);
    let flat = flatten_surface(&region, 0.05, &options()).unwrap();
    assert!(flat.strain < 1e-6, "{}", flat.strain);
    assert!((flat.region.area() - region.surface().area()).abs() < 1e-9);
    // A bowl gets a dart with straight legs.
    let bowl = grid(30, 30, |u, v| {
        let (x, y) = (u - 0.5, v - 0.5);
        Vec3::new(0.2 * x, 0.2 * y, 0.1 * (1.0 - 2.0 * (x * x + y * y)))
    });
    let asked = SurfaceLoop {
        places: [[-0.08, -0.07], [0.08, -0.07], [0.08, 0.07], [-0.08, 0.07]]
            .map(|[x, y]: [f64; 2]| Vec3::new(x, y, 0.1 - 5.0 * (x * x + y * y)))
            .to_vec(),
        ..SurfaceLoop::default()
    };
    // The inside is a disk, and so is taken, though the rim about it is smaller.
    let region = cut_out(&bowl, &asked).unwrap();
    let rim = SurfaceLoop {
        inside: Some(Vec3::new(0.095, 0.0, 0.055)),
        ..asked.clone()
    };
    assert_eq!(cut_out(&bowl, &rim).unwrap_err(), LoopError::Holes(2));
    let with = |darts| Options { darts, ..options() };
    let plain = flatten_surface(&region, 0.006, &with(0)).unwrap();
    let darted = flatten_surface(&region, 0.006, &with(2)).unwrap();
    assert!(!darted.darts.is_empty() && darted.minimum.energy < 0.7 * plain.minimum.energy);
    for dart in &darted.darts {
        let place = |v: &u32| darted.places[*v as usize];
        let (a, b) = (place(&dart.left[0]), place(dart.left.last().unwrap()));
        let bow = (dart.left.iter())
            .map(|v| ((place(v) - a).perp(&(b - a)) / (b - a).norm()).abs())
            .fold(0.0, f64::max);
        assert!(bow < 0.03 * (b - a).norm(), "{bow} of {}", (b - a).norm());
    }
}

#[test]
fn loops_that_bound_no_region_are_refused_by_name() {
    let why = |mesh: &TriangleMesh, places: &[[f64; 2]]| {
        let places = places.iter().map(|[x, y]| Vec3::new(*x, *y, 0.0)).collect();
        let asked = SurfaceLoop {
            places,
            ..SurfaceLoop::default()
        };
        cut_out(mesh, &asked).unwrap_err()
    };
    let sheet = sheet();
    assert!(matches!(
        why(&sheet, &[[0.1, 0.1], [0.5, 0.5]]),
        LoopError::Count { count: 2, .. }
    ));
    assert!(matches!(
        why(&sheet, &[[0.1, 0.1], [0.5, 0.5], [0.1, 0.1]]),
        LoopError::Same(..)
    ));
    assert!(matches!(
        why(&sheet, &[[0.1, 0.1], [1.5, 0.5], [0.1, 0.9]]),
        LoopError::Off { ref what, .. } if what == "place 2"
    ));
    // A bow tie, and a spike.
    for places in [
        &[[0.13, 0.12], [0.87, 0.91], [0.85, 0.11], [0.15, 0.93]][..],
        &[[0.1, 0.1], [0.5, 0.1], [0.3, 0.1], [0.3, 0.5]],
    ] {
        assert!(
            matches!(why(&sheet, places), LoopError::Crosses { .. }),
            "{places:?}"
        );
    }
    let nan = SurfaceLoop {
        places: vec![Vec3::repeat(f64::NAN); 3],
        ..SurfaceLoop::default()
    };
    assert!(matches!(cut_out(&sheet, &nan), Err(LoopError::Off { .. })));
    let mut two = sheet.clone();
    let mut other = sheet.clone();
    other.positions.iter_mut().for_each(|p| p.x += 2.0);
    two.append(&other);
    assert!(matches!(
        why(&two, &[[0.1, 0.1], [2.5, 0.5], [0.1, 0.9]]),
        LoopError::Apart(..)
    ));
    assert_eq!(
        cut_out(&TriangleMesh::default(), &asked_square()).unwrap_err(),
        LoopError::Empty
    );
    let mut fin = sheet.clone();
    fin.triangles.push(fin.triangles[0]);
    assert!(matches!(
        cut_out(&fin, &asked_square()),
        Err(LoopError::Branches(..))
    ));
    let away = SurfaceLoop {
        inside: Some(Vec3::new(2.5, 0.5, 0.0)),
        ..asked_square()
    };
    assert_eq!(cut_out(&two, &away).unwrap_err(), LoopError::Inside);
}

fn asked_square() -> SurfaceLoop {
    SurfaceLoop {
        places: [[0.2, 0.2], [0.8, 0.2], [0.8, 0.8], [0.2, 0.8]]
            .map(|[x, y]| Vec3::new(x, y, 0.0))
            .to_vec(),
        ..SurfaceLoop::default()
    }
}

#[test]
fn a_loop_round_a_ring_parts_nothing() {
    // A torus: a loop round its tube leaves it in one piece.
    let (big, small) = (24u32, 12u32);
    let mut torus = TriangleMesh::default();
    for i in 0..big {
        for j in 0..small {
            let a = TAU * f64::from(i) / f64::from(big);
            let b = TAU * f64::from(j) / f64::from(small);
            let out = 0.1 + 0.04 * b.cos();
            torus
                .positions
                .push(Vec3::new(out * a.cos(), 0.04 * b.sin(), out * a.sin()));
        }
    }
    let at = |i: u32, j: u32| (i % big) * small + j % small;
    for i in 0..big {
        for j in 0..small {
            torus.triangles.extend([
                [at(i, j), at(i, j + 1), at(i + 1, j)],
                [at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)],
            ]);
        }
    }
    let place = |j: u32| torus.positions[j as usize];
    let asked = SurfaceLoop {
        places: vec![place(0), place(4), place(8)],
        ..SurfaceLoop::default()
    };
    assert_eq!(
        cut_out(&torus, &asked).unwrap_err(),
        LoopError::PartsNothing
    );
}

#[test]
fn cuts_and_lengths_are_refused_by_name() {
    let with = |cuts: &[&[[f64; 2]]]| {
        let line = |line: &&[[f64; 2]]| line.iter().map(|[x, y]| Vec3::new(*x, *y, 0.0)).collect();
        let asked = SurfaceLoop {
            cuts: cuts.iter().map(line).collect(),
            ..asked_square()
        };
        cut_out(&sheet(), &asked)
    };
    assert_eq!(with(&[&[[0.5, 0.2], [0.5, 0.5]]]).unwrap().cuts().len(), 1);
    for cuts in [
        &[&[[0.5, 0.2]][..]][..],
        &[&[[0.5, 0.3], [0.5, 0.5]]],
        &[&[[0.5, 0.2], [0.5, 0.2]]],
        &[&[[0.5, 0.2], [0.5, 0.81]]],
        &[&[[0.5, 0.2], [0.5, 0.5]], &[[0.5, 0.2], [0.6, 0.5]]],
        &[&[[0.5, 0.2], [0.5, 0.5]], &[[0.2, 0.4], [0.7, 0.4]]],
        &[&[[0.5, 0.2], [0.5, 0.6], [0.4, 0.4], [0.6, 0.4]]],
    ] {
        assert!(matches!(with(cuts), Err(LoopError::Cut { .. })), "{cuts:?}");
    }
    assert!(matches!(
        with(&[&[[0.5, 0.2], [0.5, 5.0]]]),
        Err(LoopError::Off { .. })
    ));
    let region = with(&[]).unwrap();
    for edge in [0.0, -1.0, f64::NAN, 1e-9, 1.0] {
        assert!(matches!(
            region.remeshed(edge),
            Err(LoopError::EdgeLength(..))
        ));
    }
}

/// The region of a sheet with a groove, whose depth falls off on both sides; it runs along y.
fn grooved(depth: f64) -> SurfaceRegion {
    let sheet = grid(40, 10, |u, v| {
        let x = u - 0.5;
        Vec3::new(0.4 * x, 0.1 * v, -depth * (-(x / 0.15).powi(2)).exp())
    });
    let at = |x: f64, y: f64| {
        let u = x / 0.4;
        Vec3::new(x, y, -depth * (-(u / 0.15).powi(2)).exp())
    };
    let asked = SurfaceLoop {
        places: vec![
            at(-0.19, 0.005),
            at(0.19, 0.005),
            at(0.19, 0.095),
            at(-0.19, 0.095),
        ],
        inside: Some(at(0.0, 0.05)),
        ..SurfaceLoop::default()
    };
    cut_out(&sheet, &asked).unwrap()
}

#[test]
fn cloth_spans_a_groove_and_lies_on_a_ridge() {
    let region = grooved(0.03);
    let Spanning {
        region: spanning,
        farthest: deep,
        ..
    } = region.spanning_hollows(0.0, 0.006, false).unwrap();
    assert!((deep - 0.03).abs() < 0.002, "{deep}");
    let flat = spanning.surface();
    // Straight from rim to rim: as large as the sheet between the corners.
    let farthest = flat.positions.iter().map(|p| p.z.abs());
    let farthest = farthest.fold(0.0, f64::max);
    assert!(farthest < 0.002, "{farthest}");
    assert!(
        (flat.area() / (0.38 * 0.09) - 1.0).abs() < 0.01,
        "{}",
        flat.area()
    );
    // Over a ridge the cloth lies on the top, and leaves it straight for the rim.
    let ridge = grooved(-0.03);
    let lying = ridge.spanning_hollows(0.004, 0.006, false).unwrap();
    assert!(lying.at_rest);
    let lying = lying.region;
    assert!(lying.surface().area() < ridge.moved_out(0.004).surface().area());
    let top = lying
        .surface()
        .positions
        .iter()
        .map(|p| p.z)
        .fold(0.0, f64::max);
    assert!((top - 0.034).abs() < 5e-4, "{top}");
}

#[test]
fn an_edge_in_the_middle_plane_is_the_middle_of_symmetrical_cloth() {
    // Half of a groove, cut at its bottom: with its mirror image the cloth spans it, alone it is held down there.
    let depth = 0.03;
    let at = |x: f64, y: f64| Vec3::new(x, y, -depth * (-(x / 0.06).powi(2)).exp());
    let half = grid(20, 10, |u, v| at(0.2 * u, 0.1 * v));
    let asked = SurfaceLoop {
        places: vec![
            at(0.0, 0.005),
            at(0.19, 0.005),
            at(0.19, 0.095),
            at(0.0, 0.095),
        ],
        inside: Some(at(0.1, 0.05)),
        ..SurfaceLoop::default()
    };
    let region = cut_out(&half, &asked).unwrap();
    let deepest = |is_symmetrical: bool| {
        let spanning = region.spanning_hollows(0.0, 0.006, is_symmetrical).unwrap();
        let surface = spanning.region.surface();
        let middle = surface
            .positions
            .iter()
            .filter(|p| p.x.abs() < 1e-3 && (p.y - 0.05).abs() < 0.01);
        middle.map(|p| p.z).fold(f64::INFINITY, f64::min)
    };
    assert!(deepest(false) < -0.029, "{}", deepest(false));
    assert!(deepest(true) > -0.001, "{}", deepest(true));
}
