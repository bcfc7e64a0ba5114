//! Places pieces round the body: wrapped, laid over or as given; then moves them until they are clear of the
//! skin and of each other.
//!
//! # Decided with
//! - [`crate::placement_body::PlacementBody`], [`crate::part_frames::PartFrame`]: the body's axes and levels;
//!   a part with its skin;
//! - [`crate::role::roles`], [`crate::gores::ring_facings`], [`crate::wearer_side::wearer_sides`]: part of
//!   the body, facing and side of a piece: as said, by name, or by seams;
//! - [`crate::rows::rows`], [`crate::rows::set_heights`], [`crate::rows::set_shifts`]: order and heights;
//! - [`crate::wrap::wrap_row`], [`crate::outline_curve::OutlineCurve`]: bent round the skin;
//! - [`crate::surroundings::Surroundings`], [`crate::placement::SKIN_CLEARANCE`]: what a row keeps clear of;
//! - [`crate::flare::unroll_flares`], [`crate::flared_row`] (`cone`): rings as a cone;
//! - [`crate::closing::clear_closing_seams`]: halves that would close through the body;
//! - [`crate::placement::Placer::place_given`], [`crate::placement::Placer::place_over`]: pieces placed by
//!   their file; pieces laid over the head.
//!
//! The part of the body is given in the window, `inspector.rs` (`worn_choice`), or by the file; a mirrored
//! piece goes to the other side ([`toile_pattern::Worn`]).

use crate::closing::{PlacedPieces, clear_closing_seams};
use crate::flare::{Pieces, turn_as_sewn, unroll_flares};
use crate::flared_row::set_flared_shifts;
use crate::flat_pieces::{FlatPiece, flat_pieces, ties};
use crate::mesh::PieceMeshes;
use crate::part_frames::{PartFrame, label_skin};
use crate::placement_body::part_words;
use crate::role::{Role, roles};
use crate::rows::{Row, rows, set_heights, set_shifts};
use crate::surroundings::{Fit, Surroundings, skin_outline};
use crate::wrap::{lay_over, wrap_row};
use crate::{AssemblyError, Diagnostic, PlacementBody};
use toile_geometry::{SurfaceTree, TriangleMesh, Vec2, Vec3, closed_length, convex_hull};
use toile_pattern::{BodyPart, Draft, Facing};

/// Distance that every vertex keeps from the skin (m).
pub(crate) const SKIN_CLEARANCE: f64 = 0.005;
/// Distance from a vertex within which the skin is searched (m).
const LOOK: f64 = 0.03;
/// Largest number of steps of the search for a clear position.
const CLEAR_STEPS: usize = 60;
/// Largest number of steps to separate rows that intersect.
const APART_STEPS: usize = 12;
/// Number of steps in which collars and hoods only rise, before they also widen.
const HEAD_LIFTS: usize = 8;
/// Largest distance by which a piece placed by its file is pushed (m).
const MAX_PUSH: f64 = 0.3;

/// Positions of all vertices.
#[derive(Clone, Debug, Default)]
pub(crate) struct Placement {
    /// Positions of each meshed piece's vertices (m).
    pub positions: Vec<Vec<Vec3>>,
}

/// A trial placement of a row: depth in the skin (m) and number of intersections, the parameters, and the
/// positions of its pieces (m).
type Attempt = ((f64, usize), Fit, Vec<Vec<Vec3>>);

struct Placer<'a> {
    draft: &'a Draft,
    meshes: &'a PieceMeshes,
    body: &'a PlacementBody<'a>,
    labels: Vec<BodyPart>,
    laid: Vec<FlatPiece>,
    roles: Vec<Role>,
    positions: Vec<Vec<Vec3>>,
}

/// Places every meshed piece.
///
/// # Errors
/// A piece is worn on a body part that the body does not have.
pub(crate) fn place(
    draft: &Draft,
    meshes: &PieceMeshes,
    body: &PlacementBody,
    diagnostics: &mut Vec<Diagnostic>,
) -> Result<Placement, AssemblyError> {
    let turned: Vec<bool> = meshes.pieces.iter().map(is_counter_clockwise).collect();
    let mut laid = flat_pieces(meshes, &turned);
    let drawn = ties(meshes, &laid);
    let mut roles = roles((draft, meshes), (&laid, &drawn), diagnostics);
    has_parts((draft, meshes), &roles, body)?;
    let labels = label_skin(body);
    let pieces = Pieces {
        draft,
        meshes,
        waist: waist_length(body, &labels),
    };
    unroll_flares(&pieces, &mut laid, &mut roles);
    let mut ties = ties(meshes, &laid);
    turn_as_sewn(&mut laid, &mut ties);
    set_heights(&mut laid, &roles, &ties, (draft, meshes, body));
    let mut rows = rows(&laid, &roles);
    for row in &rows {
        let frame = PartFrame::new(body, row.part);
        set_shifts(&mut laid, &roles, row, &ties, &frame);
    }
    for row in rows.iter().filter(|row| row.turn > 0.0) {
        let frame = PartFrame::new(body, row.part);
        set_flared_shifts(&mut laid, &roles, (row, &rows), &ties, &frame);
    }
    // Trunk last, over sleeves: its fronts and backs go round the pieces placed before.
    rows.sort_by_key(|row| row.part == BodyPart::Trunk);
    let mut placer = Placer {
        draft,
        meshes,
        body,
        labels,
        positions: vec![Vec::new(); laid.len()],
        laid,
        roles,
    };
    placer.place_given(diagnostics);
    let placed = PlacedPieces {
        draft,
        meshes,
        roles: &placer.roles,
    };
    clear_closing_seams(&placed, body, &mut placer.positions, diagnostics);
    let mut fits: Vec<Fit> = Vec::new();
    for row in &rows {
        let start = Fit {
            distance: 0.0,
            lift: 0.0,
        };
        fits.push(placer.place_row(row, start));
    }
    placer.place_over(diagnostics);
    placer.part_rows(&rows, &mut fits);
    Ok(Placement {
        positions: placer.positions,
    })
}

/// Refuses a piece worn on a body part that the body does not have.
fn has_parts(
    (draft, meshes): (&Draft, &PieceMeshes),
    roles: &[Role],
    body: &PlacementBody,
) -> Result<(), AssemblyError> {
    for (mesh, role) in meshes.pieces.iter().zip(roles) {
        if let Role::Wrapped { part, .. } = *role
            && !body.has(part)
        {
            return Err(AssemblyError::NoPart {
                piece: draft.pieces[mesh.draft_piece].name.clone(),
                part: part_words(part),
            });
        }
    }
    Ok(())
}

/// Girth of the trunk at the waist (m).
fn waist_length(body: &PlacementBody, labels: &[BodyPart]) -> f64 {
    let around = Surroundings {
        body,
        labels,
        placed: &[],
    };
    let frame = PartFrame::new(body, BodyPart::Trunk);
    let level = [body.levels.waist; 2];
    let points = skin_outline(BodyPart::Trunk, &around, &frame, level);
    closed_length(&convex_hull(&points))
}

fn is_counter_clockwise(mesh: &crate::PieceMesh) -> bool {
    let twice: f64 = mesh
        .triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| mesh.points[v as usize]);
            (b - a).perp(&(c - a))
        })
        .sum();
    twice > 0.0
}

impl Placer<'_> {
    fn mesh(&self, k: usize, positions: &[Vec3]) -> TriangleMesh {
        TriangleMesh {
            positions: positions.to_vec(),
            triangles: self.meshes.pieces[k].triangles.clone(),
        }
    }

    /// Depth by which a piece violates the skin clearance (m); if it keeps the clearance, also the number of
    /// its triangles that still intersect the skin.
    fn trouble(&self, k: usize, positions: &[Vec3]) -> (f64, usize) {
        let skin = self.body.skin;
        let mut depth: f64 = 0.0;
        for (i, &p) in positions.iter().enumerate() {
            // A piece without intersections has all vertices on one side of the skin: one unlimited search is
            // enough.
            let reach = if i == 0 { f64::INFINITY } else { LOOK };
            if let Some(closest) = skin.closest_point(p, reach) {
                depth = depth.max(SKIN_CLEARANCE - closest.signed_distance);
            }
        }
        if depth > 0.0 {
            return (depth, 0);
        }
        let crossings = skin.intersections_with(&self.mesh(k, positions)).len();
        (depth, crossings)
    }

    /// Places a row, increasing its distance until it is clear of the skin; returns the parameters used.
    fn place_row(&mut self, row: &Row, start: Fit) -> Fit {
        let placed: Vec<Vec3> = self.positions.iter().flatten().copied().collect();
        let mut fit = start;
        let mut best: Option<Attempt> = None;
        for step in 0..CLEAR_STEPS {
            let around = Surroundings {
                body: self.body,
                labels: &self.labels,
                placed: &placed,
            };
            let positions = wrap_row(row, &self.laid, &self.roles, &around, fit);
            let (mut depth, mut crossings): (f64, usize) = (0.0, 0);
            for (&k, p) in row.pieces.iter().zip(&positions) {
                let (d, c) = self.trouble(k, p);
                depth = depth.max(d);
                crossings += c;
            }
            let score = (depth, crossings);
            if best.as_ref().is_none_or(|b| score < b.0) {
                best = Some((score, fit, positions));
            }
            if depth <= 0.0 && crossings == 0 {
                break;
            }
            let even = step % 2 == 0;
            match row.part {
                // Sleeves slide off the shoulder; collars and hoods rise off it.
                BodyPart::LeftArm | BodyPart::RightArm if even => fit.lift -= 0.01,
                BodyPart::Head if even || step < HEAD_LIFTS => fit.lift += 0.005,
                BodyPart::LeftArm | BodyPart::RightArm => fit.distance += 0.002,
                _ => fit.distance += depth.clamp(0.003, 0.02),
            }
        }
        let Some((_, fit, positions)) = best else {
            return start;
        };
        for (&k, p) in row.pieces.iter().zip(positions) {
            self.positions[k] = p;
        }
        fit
    }

    /// Separates rows that intersect: the outer one of two is moved farther out.
    fn part_rows(&mut self, rows: &[Row], fits: &mut [Fit]) {
        let row_of = |k: usize| rows.iter().position(|r| r.pieces.contains(&k));
        for _ in 0..APART_STEPS {
            let pairs = crossing_panels(self.meshes, &self.positions);
            let mut moved: Vec<usize> = Vec::new();
            for [a, b] in pairs {
                let outer = match (row_of(a), row_of(b)) {
                    (Some(a), Some(b)) => a.max(b),
                    (Some(only), None) | (None, Some(only)) => only,
                    (None, None) => continue,
                };
                moved.push(outer);
            }
            moved.sort_unstable();
            moved.dedup();
            if moved.is_empty() {
                return;
            }
            for r in moved {
                let mut fit = fits[r];
                fit.distance += 0.01;
                for &k in &rows[r].pieces {
                    self.positions[k].clear();
                }
                fits[r] = self.place_row(&rows[r], fit);
            }
        }
    }

    /// Places pieces as their file says, pushed off the skin along their right side.
    fn place_given(&mut self, diagnostics: &mut Vec<Diagnostic>) {
        for k in 0..self.roles.len() {
            let Role::Placed(place) = self.roles[k] else {
                continue;
            };
            let flat = &self.meshes.pieces[k].points;
            let at =
                |p: &Vec2| place.rotation * Vec3::new(p.x, p.y, 0.0) + place.translation.vector;
            let positions: Vec<Vec3> = flat.iter().map(at).collect();
            let side = if is_counter_clockwise(&self.meshes.pieces[k]) {
                1.0
            } else {
                -1.0
            };
            let direction = self.outward(&positions, place.rotation * Vec3::z() * side);
            let mut push = 0.0;
            while push < MAX_PUSH {
                let moved: Vec<Vec3> = positions.iter().map(|p| p + direction * push).collect();
                let (depth, crossings) = self.trouble(k, &moved);
                if depth <= 0.0 && crossings == 0 {
                    break;
                }
                push += depth.max(0.01);
            }
            let name = &self.draft.pieces[self.meshes.pieces[k].draft_piece].name;
            if push >= MAX_PUSH {
                diagnostics.push(Diagnostic::warning(
                    name,
                    "it crosses the body where it is placed, and no push clears it".to_owned(),
                    "move it away from the body",
                ));
                push = 0.0;
            } else if push > 0.0 {
                let millimetres = push * 1000.0;
                diagnostics.push(Diagnostic::note(
                    name,
                    format!(
                        "it crosses the body where it is placed: moved out by {millimetres:.0} mm"
                    ),
                    "place it farther from the body",
                ));
            }
            self.positions[k] = positions.iter().map(|p| p + direction * push).collect();
        }
    }

    /// A normal, reversed if needed so that it points away from the nearest axis of the body.
    fn outward(&self, positions: &[Vec3], normal: Vec3) -> Vec3 {
        let middle = positions.iter().sum::<Vec3>() / positions.len().max(1) as f64;
        let mut nearest = (f64::INFINITY, Vec3::zeros());
        for limb in &self.body.limbs {
            for pair in limb.axis.windows(2) {
                for step in 0..=8 {
                    let p = pair[0] + (pair[1] - pair[0]) * (f64::from(step) / 8.0);
                    let distance = (p - middle).norm();
                    if distance < nearest.0 {
                        nearest = (distance, p);
                    }
                }
            }
        }
        if (middle - nearest.1).dot(&normal) < 0.0 {
            -normal
        } else {
            normal
        }
    }

    fn place_over(&mut self, diagnostics: &mut Vec<Diagnostic>) {
        let mut lift = 0.0;
        for k in 0..self.roles.len() {
            let over = matches!(
                self.roles[k],
                Role::Wrapped {
                    facing: Facing::Over,
                    ..
                }
            );
            if !over {
                continue;
            }
            let mesh = &self.meshes.pieces[k];
            let largest = mesh.loops[1..].iter().max_by(|a, b| a.len().cmp(&b.len()));
            let hole: Vec<Vec2> = largest
                .into_iter()
                .flatten()
                .map(|&v| self.laid[k].points[v as usize])
                .collect();
            let name = &self.draft.pieces[mesh.draft_piece].name;
            let (positions, clear) = lay_over(&self.laid[k], &hole, self.body, lift);
            if !clear && !hole.is_empty() {
                diagnostics.push(Diagnostic::warning(
                    name,
                    "its hole clears neither neck nor head: it is laid above the head".to_owned(),
                    "make the hole larger",
                ));
            }
            self.positions[k] = positions;
            lift += 0.02;
        }
    }
}

/// Pairs of meshed pieces that intersect, each once. Triangles that only touch at coinciding vertices, as at
/// sewn edges, do not count.
pub(crate) fn crossing_panels(meshes: &PieceMeshes, positions: &[Vec<Vec3>]) -> Vec<[usize; 2]> {
    let mut pairs: Vec<[usize; 2]> = crossing_triangles(meshes, positions)
        .into_iter()
        .map(|(pieces, _)| pieces)
        .collect();
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// Pairs of intersecting triangles of different pieces: the pieces, and the triangle indices in the whole
/// garment.
pub(crate) fn crossing_triangles(
    meshes: &PieceMeshes,
    positions: &[Vec<Vec3>],
) -> Vec<([usize; 2], [u32; 2])> {
    let mut whole = TriangleMesh::default();
    let mut ends = Vec::new();
    for (mesh, placed) in meshes.pieces.iter().zip(positions) {
        let base = whole.positions.len() as u32;
        if placed.len() == mesh.points.len() {
            whole.positions.extend(placed);
            whole
                .triangles
                .extend(mesh.triangles.iter().map(|t| t.map(|v| v + base)));
        }
        ends.push(whole.triangles.len());
    }
    let tree = SurfaceTree::new(whole);
    let piece_of = |t: u32| ends.partition_point(|&e| e <= t as usize);
    let touching = |a: u32, b: u32| {
        let (x, y) = (
            tree.mesh().corners(a as usize),
            tree.mesh().corners(b as usize),
        );
        x.iter().any(|p| y.iter().any(|q| (p - q).norm() < 1e-9))
    };
    tree.self_intersections()
        .into_iter()
        .filter_map(|[a, b]| {
            let pieces = [piece_of(a), piece_of(b)];
            (pieces[0] != pieces[1] && !touching(a, b)).then_some((pieces, [a, b]))
        })
        .collect()
}
