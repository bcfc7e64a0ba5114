//! Meshes follow an edit of the draft with the same triangles, or say which pieces cannot.

use crate::support::edits::{corner, lined, map_piece, move_point, notched};
use crate::support::{Doll, draft, piece, polygon, poncho, skirt, span, tee, trousers};
use toile_assembly::{
    AssemblyOptions, MorphError, PieceMesh, PieceMeshes, assemble, mesh_pieces, morph,
    smallest_angle,
};
use toile_geometry::{Curve, Vec2};
use toile_pattern::{Draft, EdgeId, EdgeOrigin, PieceId, Worn};

/// Mean edge of quality `fit` (m).
const FIT: f64 = 0.015;

/// Numbers from -1 to 1, the same for the same seed.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) as f64 / u64::MAX as f64 * 2.0 - 1.0
    }

    fn below(&mut self, count: usize) -> usize {
        ((self.next() * 0.5 + 0.5) * count as f64) as usize % count
    }

    /// A vector no longer than `most` (m).
    fn vector(&mut self, most: f64) -> Vec2 {
        let (length, angle) = (self.next() * most, self.next() * 3.2);
        Vec2::new(angle.cos(), angle.sin()) * length
    }
}

fn bits(points: &[Vec2]) -> Vec<[u64; 2]> {
    points
        .iter()
        .map(|p| [p.x.to_bits(), p.y.to_bits()])
        .collect()
}

fn assert_same_points(a: &PieceMesh, b: &PieceMesh) {
    assert_eq!(bits(&a.points), bits(&b.points));
    assert_eq!(a.edge_fractions, b.edge_fractions);
}

/// Everything but points, fractions and numbers of seams is as it was, and no triangle of the new
/// meshes is worse than promised.
fn assert_sound(old: &PieceMeshes, new: &PieceMeshes) {
    let sewn =
        |m: &PieceMeshes| -> Vec<_> { m.stitches.iter().map(|s| (s.vertices, s.seam)).collect() };
    assert_eq!(sewn(old), sewn(new));
    assert_eq!(old.pieces.len(), new.pieces.len());
    for (a, b) in old.pieces.iter().zip(&new.pieces) {
        assert_eq!(a.triangles, b.triangles);
        assert_eq!(a.loops, b.loops);
        assert_eq!(a.edge_vertices, b.edge_vertices);
        assert_eq!(a.points.len(), b.points.len());
        for t in &a.triangles {
            let [p, q] = [a, b].map(|m| t.map(|v| m.points[v as usize]));
            let area = |p: [Vec2; 3]| (p[1] - p[0]).perp(&(p[2] - p[0]));
            assert!(area(p) * area(q) > 0.0, "turned over");
            let [before, after] = [p, q].map(|p| smallest_angle(p).to_degrees());
            assert!(
                after >= 15.0 - 1e-9 || after >= before - 1.0 - 1e-9,
                "{before} {after}"
            );
            for k in 0..3 {
                let share = (q[k] - q[(k + 1) % 3]).norm() / (p[k] - p[(k + 1) % 3]).norm();
                assert!((0.5 - 1e-9..=1.5 + 1e-9).contains(&share), "{share}");
            }
        }
    }
}

/// Both sides of each seam have their samples at the same shares of the way between nodes: here of
/// the whole seam, in drafts whose seams have no nodes but their ends.
fn assert_sides_match(draft: &Draft, meshes: &PieceMeshes) {
    for seam in &draft.seams {
        let [a, b] = [0, 1].map(|side| {
            let span = seam.sides[side][0];
            let mut list = meshes.pieces[span.piece].edge_fractions[span.edge].clone();
            if span.from > span.to {
                list = list.iter().rev().map(|f| 1.0 - f).collect();
            }
            list
        });
        assert_eq!(a.len(), b.len());
        for (x, y) in a.iter().zip(&b) {
            assert!((x - y).abs() < 1e-12, "{x} {y}");
        }
    }
}

fn stale(result: Result<PieceMeshes, MorphError>) -> Vec<u32> {
    match result {
        Err(MorphError::NeedsRemesh(pieces)) => {
            pieces.iter().map(|p: &PieceId| p.panel.0).collect()
        }
        Err(error) => panic!("{error}"),
        Ok(_) => panic!("followed"),
    }
}

#[test]
fn the_same_draft_gives_the_same_points() {
    for make in [tee, trousers, skirt, poncho] {
        let mut draft = make();
        lined(&mut draft, 0, [[-0.2, 0.3], [0.2, 0.35]]);
        let meshes = mesh_pieces(&draft, FIT).unwrap();
        let same = morph(&meshes, &draft).unwrap();
        assert_sound(&meshes, &same);
        assert_eq!(meshes.stitches, same.stitches);
        assert_eq!(meshes.diagnostics, same.diagnostics);
        for (a, b) in meshes.pieces.iter().zip(&same.pieces) {
            assert_same_points(a, b);
        }
    }
}

#[test]
fn a_scaled_garment_is_reproduced() {
    for scale in [0.7, 1.3] {
        let draft = tee();
        let meshes = mesh_pieces(&draft, FIT).unwrap();
        let map = |p: Vec2| p * scale + Vec2::new(0.1, -0.2);
        let mut edited = draft.clone();
        (0..4).for_each(|k| map_piece(&mut edited, k, &map));
        let morphed = morph(&meshes, &edited).unwrap();
        assert_sound(&meshes, &morphed);
        for (a, b) in meshes.pieces.iter().zip(&morphed.pieces) {
            for (p, q) in a.points.iter().zip(&b.points) {
                assert!((map(*p) - q).norm() < 1e-12, "{p} {q}");
            }
        }
    }
}

#[test]
fn a_sheared_and_turned_panel_is_reproduced() {
    let outline = [
        [0.0, 0.0],
        [0.3, 0.02],
        [0.33, 0.4],
        [0.12, 0.45],
        [-0.05, 0.38],
    ];
    let mut draft = draft(
        vec![piece(0, "panel", polygon(&outline), Worn::Automatic)],
        vec![],
    );
    lined(&mut draft, 0, [[0.06, 0.1], [0.2, 0.3]]);
    let meshes = mesh_pieces(&draft, 0.01).unwrap();
    let map = |p: Vec2| Vec2::new(0.6 * p.x - 0.8 * p.y, 0.95 * p.x + 0.7 * p.y) + Vec2::x();
    let mut edited = draft.clone();
    map_piece(&mut edited, 0, &map);
    let morphed = morph(&meshes, &edited).unwrap();
    for (p, q) in meshes.pieces[0]
        .points
        .iter()
        .zip(&morphed.pieces[0].points)
    {
        assert!((map(*p) - q).norm() < 1e-12, "{p} {q}");
    }
}

#[test]
fn small_moves_of_the_front_keep_everything_but_its_points() {
    let draft = tee();
    let meshes = mesh_pieces(&draft, FIT).unwrap();
    let mut random = Random(1);
    for _ in 0..100 {
        let mut edited = draft.clone();
        let point = corner(&draft, 0, random.below(8));
        move_point(&mut edited, 0, point, random.vector(0.005));
        let morphed = morph(&meshes, &edited).unwrap();
        assert_sound(&meshes, &morphed);
        assert_sides_match(&edited, &morphed);
        for (k, (a, b)) in meshes.pieces.iter().zip(&morphed.pieces).enumerate() {
            if k > 0 {
                assert_same_points(a, b);
            } else {
                assert!(bits(&a.points) != bits(&b.points));
            }
        }
        // The outline is that of the new draft, at the same shares of its edges.
        let front = &morphed.pieces[0];
        assert_eq!(meshes.pieces[0].edge_fractions, front.edge_fractions);
        for (k, edge) in edited.pieces[0].outline.iter().enumerate() {
            for (&v, &f) in front.edge_vertices[k].iter().zip(&front.edge_fractions[k]) {
                let point = edge.curve.sample(f, f, 0)[0];
                assert!((front.points[v as usize] - point).norm() < 1e-12);
            }
        }
    }
}

#[test]
fn what_was_between_two_edits_does_not_matter() {
    let draft = tee();
    let meshes = mesh_pieces(&draft, FIT).unwrap();
    let edit = |edge: usize, by: Vec2| {
        let mut edited = draft.clone();
        move_point(&mut edited, 0, corner(&draft, 0, edge), by);
        edited
    };
    let (one, two) = (
        edit(2, Vec2::new(0.01, 0.004)),
        edit(5, Vec2::new(-0.003, 0.006)),
    );
    let straight = morph(&meshes, &two).unwrap();
    let round = morph(&morph(&meshes, &one).unwrap(), &two).unwrap();
    assert_same_points(&straight.pieces[0], &round.pieces[0]);
    let back = morph(&round, &draft).unwrap();
    assert_same_points(&meshes.pieces[0], &back.pieces[0]);
}

#[test]
fn many_small_edits_are_bounded_as_one() {
    // Each step is small, all together are not.
    let draft = tee();
    let mut meshes = mesh_pieces(&draft, FIT).unwrap();
    let mut edited = draft.clone();
    for step in 0..100 {
        map_piece(&mut edited, 0, &|p| p * 1.01);
        match morph(&meshes, &edited) {
            Ok(next) => meshes = next,
            Err(_) => {
                // 1.01 to the 41st is 1.504.
                assert_eq!(step, 40);
                return;
            }
        }
    }
    panic!("followed to {:?}", corner(&edited, 0, 0));
}

#[test]
fn a_notch_that_moves_takes_the_samples_of_both_sides_along() {
    let mut draft = tee();
    notched(&mut draft, 0, 1, 0.4);
    let meshes = mesh_pieces(&draft, FIT).unwrap();
    let mut edited = draft.clone();
    edited.pieces[0].notches.clear();
    notched(&mut edited, 0, 1, 0.45);
    let morphed = morph(&meshes, &edited).unwrap();
    assert_sound(&meshes, &morphed);
    let has = |m: &PieceMeshes, piece: usize, edge: usize, fraction: f64| {
        m.pieces[piece].edge_fractions[edge]
            .iter()
            .any(|f| (f - fraction).abs() < 1e-6)
    };
    assert!(has(&meshes, 0, 1, 0.4) && has(&meshes, 1, 7, 0.6));
    assert!(has(&morphed, 0, 1, 0.45) && has(&morphed, 1, 7, 0.55));
    assert_sides_match(&edited, &morphed);
    // Shares between nodes are kept on both of them.
    let [old, new] = [&meshes, &morphed].map(|m| &m.pieces[0].edge_fractions[1]);
    for (old, new) in old.iter().zip(new) {
        let wanted = if *old <= 0.4 {
            old / 0.4 * 0.45
        } else {
            0.45 + (old - 0.4) / 0.6 * 0.55
        };
        assert!((new - wanted).abs() < 1e-6, "{old} {new}");
    }
}

#[test]
fn what_lay_on_an_internal_line_still_does() {
    let mut draft = tee();
    lined(&mut draft, 0, [[-0.15, 0.2], [0.15, 0.3]]);
    let meshes = mesh_pieces(&draft, FIT).unwrap();
    let mut edited = draft.clone();
    move_point(
        &mut edited,
        0,
        Vec2::new(-0.15, 0.2),
        Vec2::new(0.004, -0.005),
    );
    move_point(
        &mut edited,
        0,
        corner(&draft, 0, 3),
        Vec2::new(0.003, 0.002),
    );
    let morphed = morph(&meshes, &edited).unwrap();
    assert_sound(&meshes, &morphed);
    let on = |draft: &Draft, m: &PieceMeshes| -> Vec<usize> {
        let curve = draft.pieces[0].internal_lines[0].curves[0];
        let (start, end) = (curve.start(), curve.end());
        let points = &m.pieces[0].points;
        (0..points.len())
            .filter(|&v| {
                let (a, b) = (points[v] - start, end - start);
                a.perp(&b).abs() < 1e-12 && (0.0..=b.norm_squared() + 1e-12).contains(&a.dot(&b))
            })
            .collect()
    };
    let before = on(&draft, &meshes);
    assert!(before.len() > 15);
    assert_eq!(before, on(&edited, &morphed));
}

#[test]
fn a_line_alone_that_moves_moves_its_piece() {
    let mut draft = tee();
    lined(&mut draft, 0, [[-0.15, 0.2], [0.15, 0.3]]);
    let meshes = mesh_pieces(&draft, FIT).unwrap();
    let mut edited = draft.clone();
    move_point(&mut edited, 0, Vec2::new(0.15, 0.3), Vec2::new(0.0, 0.005));
    let morphed = morph(&meshes, &edited).unwrap();
    let boundary: usize = meshes.pieces[0].loops.iter().map(Vec::len).sum();
    let [old, new] = [&meshes, &morphed].map(|m| bits(&m.pieces[0].points));
    assert_eq!(old[..boundary], new[..boundary]);
    assert_ne!(old[boundary..], new[boundary..]);
}

#[test]
fn pieces_that_come_go_or_change_places_need_new_meshes() {
    let draft = tee();
    let meshes = mesh_pieces(&draft, 0.03).unwrap();
    let mut edited = draft.clone();
    edited.pieces.push(piece(
        9,
        "pocket",
        polygon(&[[0.0, 0.0], [0.1, 0.0], [0.1, 0.1]]),
        Worn::Automatic,
    ));
    assert_eq!(stale(morph(&meshes, &edited)), [9]);
    // One that is not sewn is no part of the garment, wherever it stands.
    edited.pieces[4].sewn = false;
    edited.pieces.rotate_right(1);
    for span in edited
        .seams
        .iter_mut()
        .flat_map(|s| s.sides.iter_mut().flatten())
    {
        span.piece += 1;
    }
    let morphed = morph(&meshes, &edited).unwrap();
    let places: Vec<usize> = morphed.pieces.iter().map(|m| m.draft_piece).collect();
    assert_eq!(places, [1, 2, 3, 4]);
    let mut edited = draft.clone();
    edited.pieces[3].sewn = false;
    assert_eq!(stale(morph(&meshes, &edited)), [3]);
    let mut edited = draft;
    edited.pieces.swap(1, 3);
    assert_eq!(stale(morph(&meshes, &edited)), [1, 3]);
}

#[test]
fn other_edges_and_lines_need_new_meshes() {
    let mut draft = tee();
    lined(&mut draft, 2, [[-0.1, -0.15], [0.1, -0.15]]);
    let meshes = mesh_pieces(&draft, 0.03).unwrap();
    let mut named = draft.clone();
    named.pieces[1].outline[0].origin = EdgeOrigin::drawn(EdgeId(77));
    assert_eq!(stale(morph(&meshes, &named)), [1]);
    // The hem of the front in two.
    let mut divided = draft.clone();
    let hem = divided.pieces[0].outline[0].clone();
    divided.pieces[0].outline[0].curve = hem.curve.between(0.0, 0.5);
    let mut rest = hem.clone();
    rest.curve = hem.curve.between(0.5, 1.0);
    rest.origin = EdgeOrigin::drawn(EdgeId(50));
    divided.pieces[0].outline.insert(1, rest);
    for span in divided
        .seams
        .iter_mut()
        .flat_map(|s| s.sides.iter_mut().flatten())
    {
        span.edge += usize::from(span.piece == 0);
    }
    assert_eq!(stale(morph(&meshes, &divided)), [0]);
    let mut unlined = draft.clone();
    unlined.pieces[2].internal_lines.clear();
    assert_eq!(stale(morph(&meshes, &unlined)), [2]);
    let mut curved = draft;
    let line = &mut curved.pieces[2].internal_lines[0];
    line.curves = vec![
        line.curves[0].between(0.0, 0.3),
        line.curves[0].between(0.3, 1.0),
    ];
    assert_eq!(stale(morph(&meshes, &curved)), [2]);
}

#[test]
fn other_seams_and_notches_need_new_meshes() {
    let draft = tee();
    let meshes = mesh_pieces(&draft, 0.03).unwrap();
    let mut shorter = draft.clone();
    shorter.seams[0].sides[0] = vec![span(0, 1, 0.0, 0.8)];
    assert_eq!(stale(morph(&meshes, &shorter)), [0]);
    let mut notched_draft = draft.clone();
    notched(&mut notched_draft, 0, 1, 0.5);
    assert_eq!(stale(morph(&meshes, &notched_draft)), [0, 1]);
    let mut opened = draft.clone();
    opened.seams.remove(4);
    assert_eq!(stale(morph(&meshes, &opened)), [2]);
    // Left and right sleeve change places: the same nodes, other partners.
    let mut swapped = draft;
    for span in swapped.seams[6..]
        .iter_mut()
        .flat_map(|s| s.sides.iter_mut().flatten())
    {
        span.piece = [0, 1, 3, 2][span.piece];
    }
    assert_eq!(stale(morph(&meshes, &swapped)), [0, 1, 2, 3]);
}

#[test]
fn shapes_too_far_from_what_was_meshed_need_new_meshes() {
    let draft = tee();
    let meshes = mesh_pieces(&draft, 0.03).unwrap();
    let check = |map: &dyn Fn(Vec2) -> Vec2| {
        let mut edited = draft.clone();
        map_piece(&mut edited, 3, map);
        assert_eq!(stale(morph(&meshes, &edited)), [3]);
    };
    // Larger than bounds, sharper than bounds, turned over.
    check(&|p| p * 1.6);
    check(&|p| p * 0.45);
    check(&|p| Vec2::new(p.x + 1.5 * p.y, p.y));
    check(&|p| Vec2::new(-p.x, p.y));
    let mut far = draft.clone();
    move_point(&mut far, 0, corner(&draft, 0, 2), Vec2::new(1.0, 0.0));
    assert_eq!(stale(morph(&meshes, &far)), [0]);
    // A corner of the hem pulled over the other: the outline crosses itself.
    let mut crossed = draft.clone();
    move_point(&mut crossed, 0, corner(&draft, 0, 0), Vec2::new(0.6, 0.1));
    assert_eq!(stale(morph(&meshes, &crossed)), [0]);
    // Two panels at once.
    let mut both = draft.clone();
    map_piece(&mut both, 2, &|p| p * 1.6);
    map_piece(&mut both, 1, &|p| p * 1.6);
    assert_eq!(stale(morph(&meshes, &both)), [1, 2]);
}

#[test]
fn a_draft_without_meshes_says_why() {
    let draft = tee();
    let meshes = mesh_pieces(&draft, 0.03).unwrap();
    let mut open = draft.clone();
    open.pieces[0].outline[0].curve = Curve::Line {
        start: Vec2::new(-0.27, 0.0),
        end: Vec2::new(0.2, 0.0),
    };
    let error = morph(&meshes, &open).unwrap_err();
    assert!(error.to_string().contains("close the outline"), "{error}");
    let mut wild = draft.clone();
    map_piece(&mut wild, 0, &|_| Vec2::new(f64::NAN, 0.0));
    assert!(matches!(morph(&meshes, &wild), Err(MorphError::Draft(_))));
    let mut lost = draft;
    lost.seams[0].sides[0] = vec![span(0, 99, 0.0, 1.0)];
    let error = morph(&meshes, &lost).unwrap_err();
    assert!(error.to_string().contains("edge 99"), "{error}");
}

#[test]
fn seams_in_another_order_keep_their_stitches() {
    let draft = tee();
    let meshes = mesh_pieces(&draft, 0.03).unwrap();
    let mut edited = draft.clone();
    edited.seams.reverse();
    let morphed = morph(&meshes, &edited).unwrap();
    assert_sound(&meshes, &morphed);
    for (old, new) in meshes.stitches.iter().zip(&morphed.stitches) {
        assert_eq!(edited.seams[new.draft_seam].id, new.seam);
        assert_eq!(new.draft_seam, 9 - old.draft_seam);
    }
}

#[test]
fn a_garment_takes_new_shapes_where_it_is() {
    let draft = tee();
    let doll = Doll::new();
    let options = AssemblyOptions { edge_length: 0.03 };
    let made = assemble(&draft, &doll.body(), &options).unwrap();
    let mut edited = draft.clone();
    move_point(
        &mut edited,
        0,
        corner(&draft, 0, 2),
        Vec2::new(0.004, 0.003),
    );
    edited.pieces[1].grain = 0.25;
    edited.pieces[1].fabric = 3;
    edited.pieces[1].name = "rear".to_owned();
    edited.seams.reverse();
    let meshes = morph(&made.meshes, &edited).unwrap();
    let shaped = made.garment.with_shapes(&edited, &meshes);
    assert_eq!(shaped.positions, made.garment.positions);
    assert_eq!(shaped.triangles, made.garment.triangles);
    let flat: Vec<Vec2> = meshes
        .pieces
        .iter()
        .flat_map(|m| m.points.clone())
        .collect();
    assert_eq!(shaped.flat, flat);
    assert_ne!(shaped.flat, made.garment.flat);
    assert_eq!(shaped.stitches, meshes.stitches);
    let back = &shaped.panels[1];
    assert_eq!(
        (back.grain, back.fabric, back.name.as_str()),
        (0.25, 3, "rear")
    );
    assert_eq!(back.vertices, made.garment.panels[1].vertices);
}

#[test]
fn any_edits_give_sound_meshes_or_are_refused() {
    let mut random = Random(7);
    let (mut followed, mut refused) = (0, 0);
    for round in 0..40 {
        let start = [tee, trousers, skirt, poncho][round % 4]();
        let mut edited = start.clone();
        if round % 3 == 0 {
            notched(&mut edited, 0, 1, 0.3);
            lined(&mut edited, 0, [[-0.1, 0.2], [0.1, 0.3]]);
        }
        let made = mesh_pieces(&edited, 0.03).unwrap();
        let mut meshes = made.clone();
        for _ in 0..12 {
            let k = random.below(edited.pieces.len());
            let size = [0.003, 0.02, 0.3][random.below(3)];
            let mut next = edited.clone();
            if random.next() < 0.2 {
                let scale = 1.0 + 0.2 * random.next();
                map_piece(&mut next, k, &|p| Vec2::new(p.x * scale, p.y));
            } else {
                let edge = random.below(next.pieces[k].outline.len());
                let point = corner(&next, k, edge);
                move_point(&mut next, k, point, random.vector(size));
            }
            match morph(&meshes, &next) {
                Ok(morphed) => {
                    assert_sound(&made, &morphed);
                    (meshes, edited) = (morphed, next);
                    followed += 1;
                }
                Err(MorphError::NeedsRemesh(pieces)) => {
                    assert!(!pieces.is_empty() && pieces.is_sorted());
                    refused += 1;
                }
                Err(MorphError::Draft(_)) => refused += 1,
            }
        }
    }
    assert!(followed > 150 && refused > 50, "{followed} {refused}");
}
