//! Removal of caps, triangles with an angle near 180 degrees, from a cloth before it is simulated.
//!
//! Linear triangles follow a curved surface only while their largest angle stays away from 180
//! degrees (the maximum angle condition, Babuska and Aziz 1976). The membrane of a cap
//! ties the corner with the large angle to the chord of the other two, and a bent sheet with caps is several per cent
//! too stiff (membrane locking). The long edge of a cap is exchanged for the other diagonal of its two triangles (an
//! intrinsic flip, Bobenko and Springborn 2007): vertices, area and rest metric stay the same. Cloth without caps is
//! left untouched.

use crate::Cloth;
use crate::laws::rest_sheet::IllConditioned;
use std::borrow::Cow;
use std::collections::BTreeMap;
use toile_geometry::Vec2;

/// Cosine of the angle from which a triangle is a cap: 150 degrees.
const CAP: f64 = -0.866_025_403_784_438_6;

/// Least cosine between the warp directions of two triangles whose common edge may be exchanged: 10 degrees.
const SAME_WARP: f64 = 0.985;

/// Largest relative difference of the two rest lengths of a common edge; beyond it the edge is a seam with ease.
const SAME_LENGTH: f64 = 1e-6;

/// Most flips for each cap; each flip lowers the largest angle of its pair.
const MAX_FLIPS: usize = 8;

/// The flip of a cap's long edge to the other diagonal of its pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Exchange {
    /// The cap, and the corner with its large angle.
    cap: (u32, usize),
    /// The triangle across the long edge, and its corner at which that edge begins.
    behind: (u32, usize),
}

/// The cloth with the long edges of its caps exchanged where that lowers the largest angle of the pair, and the
/// exchanges. Triangles keep their indices, materials and panels; only the areas of a pair change, not their sum.
pub(crate) fn without_caps(cloth: &Cloth) -> (Cow<'_, Cloth>, Vec<Exchange>) {
    let caps: Vec<u32> = (0..cloth.triangles.len() as u32)
        .filter(|&t| largest_angle(cloth.rest[t as usize]).1 < CAP)
        .collect();
    if caps.is_empty() {
        return (Cow::Borrowed(cloth), Vec::new());
    }
    let mut flipper = Flipper::new(cloth.clone());
    let mut exchanges = Vec::new();
    let mut left = MAX_FLIPS * caps.len();
    let mut open = caps;
    while let Some(t) = open.pop() {
        if left == 0 {
            break;
        }
        if let Some(exchange) = flipper.flip(t) {
            left -= 1;
            open.extend([t, exchange.behind.0]);
            exchanges.push(exchange);
        }
    }
    (Cow::Owned(flipper.cloth), exchanges)
}

/// Rest shapes of a cloth with the same triangles after given exchanges.
///
/// # Errors
/// The cap of a pair whose edge cannot be exchanged with these rest shapes.
pub(crate) fn exchange_again(
    mut rest: Vec<[Vec2; 3]>,
    exchanges: &[Exchange],
) -> Result<Vec<[Vec2; 3]>, IllConditioned> {
    for exchange in exchanges {
        let (cap, _) = exchange.cap;
        let pair = exchanged(&rest, exchange).ok_or(IllConditioned {
            triangle: cap as usize,
        })?;
        [rest[cap as usize], rest[exchange.behind.0 as usize]] = pair;
    }
    Ok(rest)
}

/// The rest shapes of cap and neighbour after the exchange; none where the warp directions differ or a triangle would
/// be inverted.
fn exchanged(rest: &[[Vec2; 3]], exchange: &Exchange) -> Option<[[Vec2; 3]; 2]> {
    let ((t, k), (s, at)) = (exchange.cap, exchange.behind);
    let [pn, pa, pb] = [0, 1, 2].map(|i| rest[t as usize][(k + i) % 3]);
    let pd = unfolded(rest[s as usize], at, [pa, pb])?;
    let hand = twice_area([pn, pa, pb]);
    let pair = [[pn, pa, pd], [pd, pb, pn]];
    let convex = pair.iter().all(|&p| twice_area(p) * hand > 0.0);
    convex.then_some(pair)
}

/// The far corner of a triangle moved rigidly so that its edge from corner `at` lies on `pb`, `pa`; none where the warp
/// directions differ or the edge is a seam with ease.
fn unfolded(corners: [Vec2; 3], at: usize, [pa, pb]: [Vec2; 2]) -> Option<Vec2> {
    let [qb, qa, qd] = [0, 1, 2].map(|i| corners[(at + i) % 3]);
    let (from, to) = ((qb - qa).try_normalize(0.0)?, (pb - pa).try_normalize(0.0)?);
    let lengths = (qb - qa).norm() / (pb - pa).norm();
    if from.dot(&to) < SAME_WARP || (lengths - 1.0).abs() > SAME_LENGTH {
        return None;
    }
    let left = |d: Vec2| Vec2::new(-d.y, d.x);
    let off = qd - (qa + qb) * 0.5;
    Some((pa + pb) * 0.5 + to * off.dot(&from) + left(to) * off.dot(&left(from)))
}

/// The corner with the largest angle and the cosine there.
fn largest_angle(corners: [Vec2; 3]) -> (usize, f64) {
    let cosine = |k: usize| {
        let (u, v) = (
            corners[(k + 1) % 3] - corners[k],
            corners[(k + 2) % 3] - corners[k],
        );
        u.dot(&v) / (u.norm() * v.norm())
    };
    let mut found = (0, cosine(0));
    for k in 1..3 {
        let c = cosine(k);
        if c < found.1 {
            found = (k, c);
        }
    }
    found
}

/// Twice the signed area.
fn twice_area([a, b, c]: [Vec2; 3]) -> f64 {
    (b - a).perp(&(c - a))
}

/// A cloth whose edges are flipped, with its edge map.
struct Flipper {
    cloth: Cloth,
    /// Triangles at each edge; the key has the smaller vertex first.
    edges: BTreeMap<[u32; 2], Vec<u32>>,
}

fn key(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

impl Flipper {
    fn new(cloth: Cloth) -> Self {
        let mut edges: BTreeMap<[u32; 2], Vec<u32>> = BTreeMap::new();
        for (t, v) in cloth.triangles.iter().enumerate() {
            for k in 0..3 {
                let edge = edges.entry(key(v[k], v[(k + 1) % 3])).or_default();
                edge.push(t as u32);
            }
        }
        Self { cloth, edges }
    }

    /// Exchanges the long edge of a cap. None where the triangle is no cap, where its long edge is free, sewn or
    /// between different materials, and where the exchange would not lower the largest angle.
    fn flip(&mut self, t: u32) -> Option<Exchange> {
        let (k, cosine) = largest_angle(self.cloth.rest[t as usize]);
        if cosine >= CAP {
            return None;
        }
        // The cap n a b with its large angle at n, and the far corner d behind a b.
        let [n, a, b] = [0, 1, 2].map(|i| self.cloth.triangles[t as usize][(k + i) % 3]);
        let [_, pa, pb] = [0, 1, 2].map(|i| self.cloth.rest[t as usize][(k + i) % 3]);
        let &[first, second] = self.edges.get(&key(a, b))?.as_slice() else {
            return None;
        };
        let s = if first == t { second } else { first };
        if self.cloth.material[t as usize] != self.cloth.material[s as usize] {
            return None;
        }
        let corners = self.cloth.triangles[s as usize];
        let at = (0..3).find(|&i| corners[i] == b && corners[(i + 1) % 3] == a)?;
        let d = corners[(at + 2) % 3];
        if d == n || self.edges.contains_key(&key(n, d)) {
            return None;
        }
        let exchange = Exchange {
            cap: (t, k),
            behind: (s, at),
        };
        let pair = exchanged(&self.cloth.rest, &exchange)?;
        let pd = pair[0][2];
        let before = cosine.min(largest_angle([pb, pa, pd]).1);
        if pair.iter().any(|&p| largest_angle(p).1 <= before) {
            return None;
        }
        for (triangle, vertices, rest) in [(t, [n, a, d], pair[0]), (s, [d, b, n], pair[1])] {
            self.cloth.triangles[triangle as usize] = vertices;
            self.cloth.rest[triangle as usize] = rest;
        }
        self.edges.remove(&key(a, b));
        self.edges.insert(key(n, d), vec![t, s]);
        for (edge, old, new) in [(key(b, n), t, s), (key(a, d), s, t)] {
            for triangle in self.edges.get_mut(&edge).into_iter().flatten() {
                if *triangle == old {
                    *triangle = new;
                }
            }
        }
        Some(exchange)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Material, State, System, Workspace};
    use toile_geometry::Vec3;

    /// A square of 4 x 4 cells with a cap planted on the first edge of some triangles.
    fn square(planted: &[usize]) -> Cloth {
        let mut points: Vec<Vec2> = (0..25)
            .map(|k| Vec2::new(f64::from(k % 5), f64::from(k / 5)) * 0.01)
            .collect();
        let mut triangles = Vec::new();
        for (i, j) in (0..16u32).map(|q| (q % 4, q / 4)) {
            let at = |a: u32, b: u32| (j + b) * 5 + i + a;
            triangles.push([at(1, 1), at(0, 0), at(1, 0)]);
            triangles.push([at(0, 0), at(1, 1), at(0, 1)]);
        }
        for &t in planted {
            let [a, b, c]: [u32; 3] = triangles[t];
            let [pa, pb, pc] = triangles[t].map(|v| points[v as usize]);
            let middle = (pa + pb) * 0.5;
            let new = points.len() as u32;
            points.push(middle + (pc - middle) * 0.02);
            triangles[t] = [a, b, new];
            triangles.extend([[b, c, new], [c, a, new]]);
        }
        let count = triangles.len();
        Cloth {
            positions: points.iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect(),
            rest: triangles
                .iter()
                .map(|t| t.map(|v| points[v as usize]))
                .collect(),
            triangles,
            material: vec![0; count],
            panel: vec![0; count],
            materials: vec![Material::default()],
        }
    }

    fn widest(cloth: &Cloth) -> f64 {
        let cosines = cloth.rest.iter().map(|&rest| largest_angle(rest).1);
        cosines.fold(1.0, f64::min).acos().to_degrees()
    }

    #[test]
    fn cloth_without_caps_is_left_alone() {
        let cloth = square(&[]);
        assert!(matches!(without_caps(&cloth).0, Cow::Borrowed(_)));
    }

    #[test]
    fn caps_inside_are_exchanged_and_nothing_else_changes() {
        let cloth = square(&[2, 9, 21]);
        assert!(widest(&cloth) > 170.0);
        let (eased, exchanges) = without_caps(&cloth);
        assert!(exchanges.len() >= 3);
        let again = exchange_again(cloth.rest.clone(), &exchanges).unwrap();
        assert_eq!(again, eased.rest);
        assert!(widest(&eased) < 120.0, "{}", widest(&eased));
        let area = |cloth: &Cloth| {
            let areas = cloth.rest.iter().map(|&rest| 0.5 * twice_area(rest));
            areas.inspect(|&a| assert!(a > 0.0)).sum::<f64>()
        };
        assert!((area(&eased) - area(&cloth)).abs() < 1e-15);
        // Rest and surface agree at every corner, and the mesh is whole.
        for (rest, corners) in eased.rest.iter().zip(&eased.triangles) {
            for (p, &v) in rest.iter().zip(corners) {
                let position = cloth.positions[v as usize];
                assert!((Vec3::new(p.x, p.y, 0.0) - position).norm() < 1e-15);
            }
        }
        assert!(eased.mesh().check().is_ok());
        assert_eq!(eased.mesh().component_count(), 1);
        assert_eq!(
            eased.mesh().euler_characteristic(),
            cloth.mesh().euler_characteristic()
        );
    }

    #[test]
    fn a_cap_on_a_free_edge_or_across_cloths_stays() {
        let mut cloth = square(&[]);
        // A corner pulled close to the free edge below it.
        cloth.rest = vec![[
            Vec2::zeros(),
            Vec2::new(0.01, 0.0),
            Vec2::new(0.005, 0.0001),
        ]];
        cloth.triangles = vec![[0, 1, 5]];
        assert_eq!(without_caps(&cloth).0.triangles, cloth.triangles);
        let mut two = square(&[2]);
        two.materials.push(Material::default());
        two.material[3] = 1;
        assert_eq!(without_caps(&two).0.triangles, two.triangles);
    }

    #[test]
    fn a_model_keeps_the_surface_and_an_even_stretch_pulls_on_no_inner_vertex() {
        let cloth = square(&[2, 9, 21]);
        let system = System::new("square", &cloth).unwrap();
        assert_ne!(system.topology.triangles, cloth.triangles);
        assert_eq!(system.mesh(&cloth.positions).triangles, cloth.triangles);
        let mut system = system;
        system.control.gravity = Vec3::zeros();
        let stretched: Vec<Vec3> = cloth
            .positions
            .iter()
            .map(|p| Vec3::new(1.03 * p.x + 0.02 * p.y, 0.98 * p.y, 0.0))
            .collect();
        let state = State::at_rest(&system, stretched);
        let mut workspace = Workspace::default();
        let force = workspace.net_force(&system, &state);
        let most = force.iter().map(Vec3::norm).fold(0.0, f64::max);
        for (p, f) in cloth.positions.iter().zip(force) {
            let inside = [p.x, p.y].iter().all(|&c| c > 1e-9 && c < 0.04 - 1e-9);
            assert!(!inside || f.norm() < 1e-10 * most, "{p:?} {f:?}");
        }
    }
}
