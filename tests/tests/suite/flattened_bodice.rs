//! A bodice from the skin of a woman: front and back are flattened, sewn with their mirror images, draped, and held against
//! the surface they came from.

use std::sync::Arc;
use toile_body::Mannequin;
use toile_drape::{GarmentRun, Stage};
use toile_geometry::{SurfaceTree, TriangleMesh, Vec2, Vec3};
use toile_pattern::plan::{self, SewnEdge};
use toile_pattern::{Cut, EdgeId, Edit, Entity, Evaluation, Fabric, Ids, Panel};
use toile_session::{
    Command, Figure, FlatSurface, FlattenOptions, Quality, Session, Silent, SkinLoop,
};

/// A flattened half of the bodice, with the corners of its panel.
struct Half {
    flat: FlatSurface,
    /// For each place of the loop, the place on the panel (m).
    corners: Vec<Vec2>,
}

/// Lays a loop by rays, each an origin and a direction, and flattens the region inside.
fn half(woman: &Arc<Mannequin>, (name, ease): (&str, f64), rays: &[[[f64; 3]; 2]]) -> Half {
    let mut laid = SkinLoop::new(woman.clone());
    for [origin, direction] in rays {
        laid.add(Vec3::from(*origin), Vec3::from(*direction))
            .unwrap();
    }
    let mut ids = Ids::default();
    let options = FlattenOptions {
        strain: 0.02,
        darts: 2,
        ease,
        ..FlattenOptions::default()
    };
    let flat = laid
        .flatten(Fabric::poplin(ids.take()), (name, &options), None)
        .unwrap();
    let (surface, flat_places) = (flat.surface(), flat.places());
    let corner = |place: &Vec3| {
        let off = |k: &usize| (Vec3::from(surface[*k]) - place).norm();
        let nearest = (0..surface.len()).min_by(|a, b| off(a).total_cmp(&off(b)));
        Vec2::from(flat_places[nearest.unwrap()])
    };
    let corners = laid.places().iter().map(corner).collect();
    Half { flat, corners }
}

/// The edges of a panel from one corner to another, without the mouths of darts, in the order of the outline.
fn edges_between((evaluation, panel): (&Evaluation, &Panel), from: Vec2, to: Vec2) -> Vec<EdgeId> {
    let edges: Vec<_> = panel.edges().collect();
    let start = |k: usize| evaluation.point(edges[k % edges.len()].ends[0]).unwrap();
    let nearest = |place: Vec2| {
        let off = |k: &usize| (start(*k) - place).norm();
        (0..edges.len())
            .min_by(|a, b| off(a).total_cmp(&off(b)))
            .unwrap()
    };
    let (first, last) = (nearest(from), nearest(to));
    let count = (last + edges.len() - first) % edges.len();
    let between = (0..count).map(|k| edges[(first + k) % edges.len()]);
    let sewn = between.filter(|edge| !edge.name.starts_with("mouth"));
    sewn.map(|edge| edge.id).collect()
}

#[test]
fn a_bodice_of_the_skin_fits_the_surface_it_came_from() {
    let [half, most] = distances(0.003);
    assert!(half < 0.002 && most < 0.006, "{half} {most}");
    // The cloth sinks from its ease to the skin of the shoulders, and stands off as far elsewhere.
    let [half, most] = distances(0.01);
    assert!(half < 0.007 && most < 0.013, "{half} {most}");
}

/// Distances of the draped cloth of panels with some ease from the surface that they came from, within which one half and 95 % of
/// it lie (m).
fn distances(ease: f64) -> [f64; 2] {
    let mut session = Session::new();
    let body = Command::SetBody {
        figure: Some(Figure::Woman),
        measurements: None,
    };
    session
        .execute(
            Command::NewPattern {
                name: "bodice".to_owned(),
            },
            &mut Silent,
        )
        .unwrap();
    session.execute(body, &mut Silent).unwrap();
    let woman = session.mannequin().unwrap();
    let (front, back) = ([0.0, 0.0, -1.0], [0.0, 0.0, 1.0]);
    let (down, in_left) = ([0.0, -1.0, 0.0], [-1.0, 0.0, 0.0]);
    // The waist at the side, under the arm, at the tip of the shoulder and at the neck: both halves have these.
    let side = [
        [[0.25, 1.045, 0.0], in_left],
        [[0.22, 1.2, -0.02], in_left],
        [[0.155, 1.5, -0.045], down],
        [[0.085, 1.42, -0.05], down],
    ];
    let at_front = |x: f64, y: f64| [[x, y, 2.0], front];
    let at_back = |x: f64, y: f64| [[x, y, -2.0], back];
    let mut own = vec![at_front(0.0, 1.045)];
    own.extend(&side[..2]);
    own.push(at_front(0.13, 1.26));
    own.extend(&side[2..]);
    own.push(at_front(0.0, 1.33));
    let fronts = half(&woman, ("front", ease), &own);
    let mut own = vec![at_back(0.0, 1.045)];
    own.extend(&side[..2]);
    own.push(at_back(0.134, 1.27));
    own.extend(&side[2..]);
    own.push(at_back(0.0, 1.39));
    let backs = half(&woman, ("back", ease), &own);
    // A place is the middle of the waist, the waist at the side, under the arm, on the arm, at the tip of the shoulder, at the
    // neck, the middle of the neck. Seen on the cloth the front is laid counter-clockwise, the back clockwise.
    let mut panels = Vec::new();
    for (half, name) in [(&fronts, "front"), (&backs, "back")] {
        let here = Evaluation::new(&session.project().pattern, session.project().drafted_to());
        let made = Evaluation::new(&half.flat.pattern, session.project().drafted_to());
        let offset = Vec2::new(0.6 * panels.len() as f64, 0.0);
        let pasted = plan::insert_pattern(&here, &made, offset.into()).unwrap();
        edit(&mut session, pasted.edits);
        let pattern = &session.project().pattern;
        let panel = pattern
            .panels
            .iter()
            .find(|panel| panel.name == name)
            .unwrap();
        let mut panel = (**panel).clone();
        panel.cut = Cut {
            quantity: 2,
            mirrored: true,
        };
        panels.push(panel.id);
        edit(
            &mut session,
            vec![Edit::Put(Entity::Panel(Arc::new(panel)))],
        );
    }
    let evaluation = Evaluation::new(&session.project().pattern, session.project().drafted_to());
    let edges = |of: usize, ends: [usize; 2]| {
        let half = [&fronts, &backs][of];
        let id = panels[of];
        let panel = evaluation.pattern().panel(id).unwrap();
        let ends = match of {
            0 => ends,
            _ => [ends[1], ends[0]],
        };
        let [from, to] = ends.map(|k| half.corners[k]);
        let found = edges_between((&evaluation, panel), from, to);
        let sewn = |copy| {
            let own = found.iter().map(move |&edge| (edge, copy));
            let own = own.map(|(edge, copy)| SewnEdge {
                panel: id,
                copy,
                half: 0,
                edge,
            });
            own.collect::<Vec<_>>()
        };
        [sewn(0), sewn(1)]
    };
    let mut work = evaluation.clone();
    let mut sew = |sides: [&Vec<SewnEdge>; 2]| {
        let (edits, _) = plan::sew(&work, [sides[0], sides[1]], None).unwrap();
        edit(&mut session, edits);
        work = Evaluation::new(&session.project().pattern, session.project().drafted_to());
    };
    for of in [0, 1] {
        // The middle, with the mirror image.
        let [own, other] = edges(of, [6, 0]);
        sew([&own, &other]);
    }
    for ends in [[1, 2], [4, 5]] {
        for copy in [0, 1] {
            sew([&edges(0, ends)[copy], &edges(1, ends)[copy]]);
        }
    }
    session
        .execute(
            Command::SetQuality {
                quality: Quality::Fit,
            },
            &mut Silent,
        )
        .unwrap();
    let job = session.garment_setup().unwrap();
    let mut run = GarmentRun::new(job.setup).unwrap();
    while run.progress().stage != Stage::Finished {
        run.advance().unwrap();
    }
    let measures = run.measure();
    let mesh = run.system.mesh(&run.state.positions);
    let surfaces = [&fronts, &backs].map(|half| {
        let places = half.flat.surface();
        SurfaceTree::new(TriangleMesh {
            positions: places.into_iter().map(Vec3::from).collect(),
            triangles: half.flat.triangles().to_vec(),
        })
    });
    let mut off: Vec<f64> = Vec::new();
    for place in &mesh.positions {
        let place = Vec3::new(place.x.abs(), place.y, place.z);
        let nearest = surfaces.iter().map(|surface| {
            let found = surface.closest_point(place, f64::INFINITY);
            found.map_or(f64::INFINITY, |found| found.signed_distance.abs())
        });
        off.push(nearest.fold(f64::INFINITY, f64::min));
    }
    off.sort_by(f64::total_cmp);
    let share = |share: f64| off[(share * (off.len() - 1) as f64) as usize];
    let [half, most] = [0.5, 0.95].map(share);
    println!(
        "ease {:.0} mm: half within {:.1} mm, 95 % within {:.1} mm; {measures:?}",
        1e3 * ease,
        1e3 * half,
        1e3 * most
    );
    assert_eq!(
        (measures.body_intersections, measures.self_intersections),
        (0, 0)
    );
    assert!(measures.residual < 5e-3, "{measures:?}");
    [half, most]
}

fn edit(session: &mut Session, edits: Vec<Edit>) {
    let label = "bodice".to_owned();
    session
        .execute(Command::Edit { edits, label }, &mut Silent)
        .unwrap();
}
