//! Snapping of pieces that the user drops on a marker: they come to rest against neighbours, edges of the
//! fabric and flaws at exactly the required distance, or stay where they were dropped.

use crate::DocumentMarker;
use toile_geometry::{Bounds2, Polygon, PreparedPolygon, Vec2, closest_on_segment};
use toile_nesting::Strip;
use toile_pattern::OrderedPiece;

/// Tolerance of the gaps (m).
const EXACT: f64 = 1e-10;
/// Largest number of steps to free a piece, and to place it against two neighbours at once.
const STEPS: usize = 200;
/// Largest total move of a dropped piece (multiples of the reach): out of overlaps, to an edge, along it,
/// into a corner.
const MOVES: f64 = 5.0;
/// Smallest sine of the angle between the two directions in which a piece is blocked.
const MIN_SINE: f64 = 0.2;

/// Result of dropping pieces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LetGo {
    /// The pieces are moved by this vector (m): they overlap nothing, and touch a neighbour that was near.
    Apart(Vec2),
    /// The pieces overlap this obstacle too deeply to be moved out of it automatically.
    Over(Obstacle),
}

/// An obstacle that a piece may not overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Obstacle {
    /// Another piece.
    Piece(OrderedPiece),
    /// A flaw of the fabric.
    Flaw,
}

/// An obstacle or edge that a piece keeps its distance from.
enum Neighbour {
    /// Another piece, or a flaw of the fabric.
    Outline {
        own: usize,
        outline: PreparedPolygon,
        gap: f64,
        is: Obstacle,
    },
    /// An edge of the usable fabric: the direction to it, and its coordinate along that direction (m).
    Edge { own: usize, toward: Vec2, at: f64 },
}

/// Distance that a piece can still move toward a neighbour (m); negative if it is too near.
#[derive(Clone, Copy, Debug)]
struct Clearance {
    length: f64,
    /// Unit direction to the neighbour.
    toward: Vec2,
}

/// The dropped pieces and the neighbours that they keep their distance from.
struct Surroundings {
    held: Vec<Polygon>,
    neighbours: Vec<Neighbour>,
}

impl DocumentMarker {
    /// Position of dropped pieces: moved by at most `reach` (m) out of overlaps, and by as much again against
    /// a neighbour and into the corner between two.
    pub fn let_go(&self, pieces: &[OrderedPiece], reach: f64) -> LetGo {
        let strip = self.strip();
        let laid: Vec<_> = self.outlines().collect();
        let is_held = |piece: &OrderedPiece| pieces.contains(piece);
        let held: Vec<_> = laid.iter().filter(|(p, ..)| is_held(p)).collect();
        let mut neighbours = Vec::new();
        for (own, (_, item, outline)) in held.iter().enumerate() {
            let bounds = outline.bounds();
            for (piece, other, stays) in laid.iter().filter(|(p, ..)| !is_held(p)) {
                let gap = strip.gap_between(item, other);
                if bounds.distance(&stays.bounds()) <= gap + MOVES * reach {
                    neighbours.push(Neighbour::Outline {
                        own,
                        outline: PreparedPolygon::new(stays),
                        gap,
                        is: Obstacle::Piece(*piece),
                    });
                }
            }
            for flaw in strip.flaws.iter().filter(|_| !item.over_flaws) {
                let gap = flaw.clearance;
                if bounds.distance(&flaw.outline.bounds()) <= gap + MOVES * reach {
                    neighbours.push(Neighbour::Outline {
                        own,
                        outline: PreparedPolygon::new(&flaw.outline),
                        gap,
                        is: Obstacle::Flaw,
                    });
                }
            }
            neighbours.extend(edges(strip).map(|(toward, at)| Neighbour::Edge { own, toward, at }));
        }
        let held = held.into_iter().map(|(.., outline)| outline.clone());
        let mut around = Surroundings {
            held: held.collect(),
            neighbours,
        };
        // A piece far off the fabric was put there on purpose.
        around.leave_out_edges(reach);
        around.let_go(reach)
    }
}

/// The edges of the usable fabric: the direction to each, and its coordinate along that direction (m).
fn edges(strip: &Strip) -> impl Iterator<Item = (Vec2, f64)> {
    let end = strip.max_length.map(|length| length - strip.end_margin);
    let sides = [
        (-Vec2::x(), -strip.end_margin),
        (-Vec2::y(), -strip.lower()),
        (Vec2::y(), strip.upper()),
    ];
    let end = end.map(|end| (Vec2::x(), end));
    sides.into_iter().chain(end)
}

impl Surroundings {
    fn leave_out_edges(&mut self, reach: f64) {
        let held = &self.held;
        self.neighbours.retain(|neighbour| match neighbour {
            Neighbour::Outline { .. } => true,
            Neighbour::Edge { own, toward, at } => {
                to_edge(&held[*own], (*toward, *at), Vec2::zeros()).length > -reach
            }
        });
    }

    /// Distance that a piece can move toward a neighbour, after a displacement `way` (m).
    fn clearance(&self, neighbour: &Neighbour, way: Vec2) -> Clearance {
        match neighbour {
            Neighbour::Edge { own, toward, at } => to_edge(&self.held[*own], (*toward, *at), way),
            Neighbour::Outline {
                own, outline, gap, ..
            } => {
                let held = PreparedPolygon::new(&self.held[*own].translated(way));
                let off = outline.separation(&held);
                let depth = off.norm();
                if depth > EXACT {
                    return Clearance {
                        length: -depth - gap,
                        toward: -off / depth,
                    };
                }
                let between = nearest_way(held.polygon(), outline.polygon());
                let length = between.norm();
                let across = outline.bounds().centre() - held.bounds().centre();
                let toward = match length > EXACT {
                    true => between / length,
                    // Touching outlines: the direction is only known once they are apart.
                    false => across / across.norm().max(EXACT),
                };
                Clearance {
                    length: length - gap,
                    toward,
                }
            }
        }
    }

    /// The neighbour with the least clearance, among those that `takes` accepts.
    fn nearest(&self, way: Vec2, takes: impl Fn(usize) -> bool) -> Option<(usize, Clearance)> {
        let all = self.neighbours.iter().enumerate();
        let all = all.filter(|(k, _)| takes(*k));
        let all = all.map(|(k, neighbour)| (k, self.clearance(neighbour, way)));
        all.min_by(|a, b| a.1.length.total_cmp(&b.1.length))
    }

    fn let_go(&self, reach: f64) -> LetGo {
        let way = match self.freed(reach) {
            Ok(way) => way,
            Err(obstacle) => return LetGo::Over(obstacle),
        };
        let nearest = self.nearest(way, |_| true);
        let Some((first, near)) = nearest.filter(|(_, near)| near.length <= reach) else {
            return LetGo::Apart(way);
        };
        // No point of the piece moves farther than the nearest neighbour is away, so it meets nothing else.
        let against = way + near.toward * near.length;
        let along = Vec2::new(-near.toward.y, near.toward.x);
        let slides = [along, -along].map(|along| self.slide(first, (against, along), reach));
        let slid = slides.into_iter().flatten();
        let nearer = |a: &Vec2, b: &Vec2| (a - against).norm().total_cmp(&(b - against).norm());
        let slid = slid.min_by(nearer);
        // A piece that already touches one neighbour, such as the edge of the fabric, may leave it for
        // another.
        let moved = || match near.length > EXACT {
            true => None,
            false => self.against_next(way, reach),
        };
        LetGo::Apart(slid.or_else(moved).unwrap_or(against))
    }

    /// Displacement to the nearest neighbour not yet touched, if that is within reach and free of overlaps.
    fn against_next(&self, way: Vec2, reach: f64) -> Option<Vec2> {
        let touches = |k: usize| self.clearance(&self.neighbours[k], way).length <= EXACT;
        let (_, near) = self.nearest(way, |k| !touches(k))?;
        let next = way + near.toward * near.length;
        let least = self.nearest(next, |_| true)?;
        (near.length <= reach && least.1.length >= -EXACT).then_some(next)
    }

    /// Displacement along one neighbour up to the next one, if that is within reach.
    fn slide(&self, first: usize, (from, along): (Vec2, Vec2), reach: f64) -> Option<Vec2> {
        let mut way = from;
        for _ in 0..STEPS {
            let (next, near) = self.nearest(way, |k| k != first)?;
            if near.length < EXACT {
                let is_on = |way| self.clearance(&self.neighbours[first], way).length.abs() < EXACT;
                return match is_on(way) {
                    true => Some(way),
                    // The outline of the first neighbour is not straight there.
                    false => self.against_both([first, next], (way, reach)),
                };
            }
            // A move by the clearance meets no other neighbour, whatever its direction.
            way += along * near.length;
            if (way - from).norm() > reach {
                return None;
            }
        }
        None
    }

    /// Displacement out of all overlaps and gaps too small; if there is none, an obstacle that is overlapped.
    fn freed(&self, reach: f64) -> Result<Vec2, Obstacle> {
        let mut way = Vec2::zeros();
        let mut over = None;
        for _ in 0..STEPS {
            let Some((k, near)) = self.nearest(way, |_| true) else {
                break;
            };
            if near.length >= -EXACT {
                return Ok(way);
            }
            if let Neighbour::Outline { is, .. } = &self.neighbours[k] {
                over.get_or_insert(*is);
            }
            way += near.toward * near.length;
            if way.norm() > reach {
                break;
            }
        }
        // A piece blocked by edges only stays where it lies.
        over.map_or(Ok(Vec2::zeros()), Err)
    }

    /// Displacement to touch two neighbours at once, by Newton's method, if that is near and free of
    /// overlaps.
    fn against_both(&self, pair: [usize; 2], (from, reach): (Vec2, f64)) -> Option<Vec2> {
        let mut way = from;
        for _ in 0..STEPS {
            let [a, b] = pair.map(|k| self.clearance(&self.neighbours[k], way));
            if a.length.abs().max(b.length.abs()) < EXACT {
                let least = self.nearest(way, |_| true)?;
                return (least.1.length >= -EXACT).then_some(way);
            }
            let sine = a.toward.perp(&b.toward);
            if sine.abs() < MIN_SINE {
                return None;
            }
            // a.toward . step = a.length, b.toward . step = b.length.
            let step = Vec2::new(
                a.length * b.toward.y - b.length * a.toward.y,
                b.length * a.toward.x - a.length * b.toward.x,
            );
            way += step / sine;
            if (way - from).norm() > 2.0 * reach {
                return None;
            }
        }
        None
    }
}

/// Distance that a piece, displaced by `way`, can move toward an edge.
fn to_edge(held: &Polygon, (toward, at): (Vec2, f64), way: Vec2) -> Clearance {
    let reaches = held.outer.iter().map(|p| toward.dot(&(p + way)));
    Clearance {
        length: at - reaches.fold(f64::NEG_INFINITY, f64::max),
        toward,
    }
}

/// Shortest vector from a polygon to another that it does not overlap (m).
fn nearest_way(from: &Polygon, to: &Polygon) -> Vec2 {
    let box_of = |edge: [Vec2; 2]| (edge, Bounds2::of(edge));
    let others: Vec<_> = to.edges().map(box_of).collect();
    let mut best = (f64::INFINITY, Vec2::zeros());
    for (edge, around) in from.edges().map(box_of) {
        for (other, other_around) in &others {
            if around.distance(other_around) >= best.0 {
                continue;
            }
            let ways = [
                closest_on_segment(edge[0], *other) - edge[0],
                closest_on_segment(edge[1], *other) - edge[1],
                other[0] - closest_on_segment(other[0], edge),
                other[1] - closest_on_segment(other[1], edge),
            ];
            for way in ways {
                if way.norm() < best.0 {
                    best = (way.norm(), way);
                }
            }
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use toile_pattern::PanelId;

    const REACH: f64 = 0.02;
    const GAP: f64 = 0.002;

    fn star(centre: Vec2, radii: &[f64]) -> Polygon {
        let count = radii.len() as f64;
        let points = radii.iter().enumerate().map(|(k, radius)| {
            let angle = std::f64::consts::TAU * k as f64 / count;
            centre + Vec2::new(angle.cos(), angle.sin()) * *radius
        });
        Polygon::new(points.collect())
    }

    fn around(held: Polygon, others: &[Polygon]) -> Surroundings {
        let piece = |k: usize| OrderedPiece {
            panel: PanelId(k as u32),
            copy: 0,
            size: None,
            garment: 0,
        };
        let others = others.iter().enumerate();
        Surroundings {
            held: vec![held],
            neighbours: others
                .map(|(k, other)| Neighbour::Outline {
                    own: 0,
                    outline: PreparedPolygon::new(other),
                    gap: GAP,
                    is: Obstacle::Piece(piece(k)),
                })
                .collect(),
        }
    }

    fn distance(a: &Polygon, b: &Polygon) -> f64 {
        PreparedPolygon::new(a).distance(&PreparedPolygon::new(b))
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]
        #[test]
        fn what_is_let_go_beside_another_lies_at_the_gap(
            a in prop::collection::vec(0.05..0.2, 3..12),
            b in prop::collection::vec(0.05..0.2, 3..12),
            angle in 0.0..std::f64::consts::TAU,
            off in -0.01..0.03,
        ) {
            let stays = star(Vec2::zeros(), &a);
            let toward = Vec2::new(angle.cos(), angle.sin());
            // The piece is brought from far away to the given distance.
            let mut held = star(toward * 0.5, &b);
            let far = Surroundings::clearance(&around(held.clone(), std::slice::from_ref(&stays)),
                &around(held.clone(), std::slice::from_ref(&stays)).neighbours[0], Vec2::zeros());
            held = held.translated(far.toward * (far.length - off));
            match around(held.clone(), std::slice::from_ref(&stays)).let_go(REACH) {
                LetGo::Apart(way) => {
                    let apart = distance(&held.translated(way), &stays);
                    if off <= REACH {
                        prop_assert!((apart - GAP).abs() < 1e-9, "{apart}");
                        prop_assert!(way.norm() < REACH + 1e-9);
                    } else {
                        prop_assert_eq!(way, Vec2::zeros());
                    }
                }
                LetGo::Over(_) => prop_assert!(off < 0.0, "{off}"),
            }
        }
    }

    #[test]
    fn between_two_it_lies_against_both_and_over_another_it_is_told() {
        let square = |x: f64, y: f64| {
            let min = Vec2::new(x, y);
            Polygon::rectangle(Bounds2 {
                min,
                max: min + Vec2::new(0.1, 0.1),
            })
        };
        let others = [square(0.0, 0.0), square(0.11, 0.11)];
        let held = square(0.107, 0.003);
        let LetGo::Apart(way) = around(held.clone(), &others).let_go(REACH) else {
            panic!("it lies over nothing");
        };
        for other in &others {
            let apart = distance(&held.translated(way), other);
            assert!((apart - GAP).abs() < 1e-9, "{apart}");
        }
        let over = around(square(0.05, 0.05), &others).let_go(REACH);
        assert!(matches!(over, LetGo::Over(_)), "{over:?}");
        let free = around(square(0.5, 0.5), &others).let_go(REACH);
        assert_eq!(free, LetGo::Apart(Vec2::zeros()));
    }
}
