//! The adjustment of clothes in real time as Rudomin, Castillo, Muñoz and Alencastre (2002) describe
//! it, plainly written: what `toile-realtime` is measured against. The same `f32` columns and the
//! same ellipsoids; what they leave open is read as the methods page says.

use toile_realtime::{Character, Ellipsoids, Frame};

/// Passes over the edges that correct their lengths in a frame.
const PASSES: usize = 4;

/// Springs: stiffness over mass (1/s2) and damping (1/s), as the other method's.
const STIFFNESS: f32 = 300.0;
const DAMPING: f32 = 2.0;

/// Share by which the shape adjustment draws a vertex to its rest offset in a frame.
const DRAWN: f32 = 0.2;

/// Lengths over rest beyond which an edge is corrected.
const BOUNDS: [f32; 2] = [0.90, 1.08];

type Vector = [f32; 3];

fn dot(a: Vector, b: Vector) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn difference(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// An ellipsoid where it is, with the way back into its axes.
#[derive(Clone)]
struct Placed {
    semi_axes: Vector,
    forth: Frame,
    back: Frame,
    /// From where it was in the last frame to where it is.
    motion: Frame,
}

/// A garment as published.
#[derive(Clone)]
pub(crate) struct Published {
    x: Vec<f32>,
    y: Vec<f32>,
    z: Vec<f32>,
    velocities: Vec<Vector>,
    edges: Vec<[u32; 2]>,
    lengths: Vec<f32>,
    parents: Vec<usize>,
    /// Places at rest in the axes of the first parent.
    offsets: Vec<Vector>,
    first_parents: Vec<usize>,
    placed: Vec<Placed>,
    groups: Vec<usize>,
    touching: Vec<Vec<bool>>,
}

impl Published {
    pub fn new(
        character: &Character,
        ellipsoids: &Ellipsoids,
        (positions, triangles): (&[Vector], &[[u32; 3]]),
        offset: f32,
    ) -> Self {
        let placed: Vec<Placed> = (0..ellipsoids.len())
            .map(|k| {
                let forth = ellipsoids.transform(k).unwrap_or(Frame::NONE);
                let axes = ellipsoids.semi_axes(k).unwrap_or([1.0; 3]);
                Placed {
                    semi_axes: axes.map(|axis| axis + offset),
                    back: forth.inverse(),
                    motion: Frame::NONE,
                    forth,
                }
            })
            .collect();
        let number = |name: &str| character.groups.iter().position(|g| g.name == name);
        let groups: Vec<usize> = character
            .ellipsoids
            .iter()
            .map(|e| number(&e.group).unwrap_or(0))
            .collect();
        let named = &character.groups;
        let touches = |a: usize, b: usize| {
            a == b
                || named[a].touches.contains(&named[b].name)
                || named[b].touches.contains(&named[a].name)
        };
        let touching = (0..named.len())
            .map(|a| (0..named.len()).map(|b| touches(a, b)).collect())
            .collect();
        let mut edges: Vec<[u32; 2]> = triangles
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
            .map(|[a, b]| [a.min(b), a.max(b)])
            .collect();
        edges.sort_unstable();
        edges.dedup();
        let lengths = edges.iter().map(|ends| {
            let [a, b] = ends.map(|v| positions[v as usize]);
            let gap = difference(a, b);
            dot(gap, gap).sqrt()
        });
        let mut made = Self {
            lengths: lengths.collect(),
            x: positions.iter().map(|p| p[0]).collect(),
            y: positions.iter().map(|p| p[1]).collect(),
            z: positions.iter().map(|p| p[2]).collect(),
            velocities: vec![[0.0; 3]; positions.len()],
            parents: vec![0; positions.len()],
            first_parents: Vec::new(),
            offsets: Vec::new(),
            edges,
            placed,
            groups,
            touching,
        };
        for v in 0..positions.len() {
            made.parents[v] = made.nearest(v, |_| true);
        }
        made.first_parents = made.parents.clone();
        let offsets = made.parents.iter().zip(positions);
        made.offsets = offsets
            .map(|(&k, &p)| made.placed[k].back.applied(p))
            .collect();
        made
    }

    fn at(&self, v: usize) -> Vector {
        [self.x[v], self.y[v], self.z[v]]
    }

    fn put(&mut self, v: usize, p: Vector) {
        [self.x[v], self.y[v], self.z[v]] = p;
    }

    /// The ellipsoid nearest to a vertex: along the ray from the centre to the surface and back into
    /// the world, as published.
    fn nearest(&self, v: usize, among: impl Fn(usize) -> bool) -> usize {
        let p = self.at(v);
        let (mut best, mut nearest) = (self.parents[v], f32::INFINITY);
        for (k, placed) in self.placed.iter().enumerate() {
            if !among(k) {
                continue;
            }
            let local = placed.back.applied(p);
            let q: Vector = std::array::from_fn(|i| local[i] / placed.semi_axes[i]);
            let length = dot(q, q).sqrt().max(1e-4);
            let on = std::array::from_fn(|i| q[i] / length * placed.semi_axes[i]);
            let gap = difference(p, placed.forth.applied(on));
            let distance = dot(gap, gap).sqrt() * (length - 1.0).signum();
            if distance < nearest {
                (best, nearest) = (k, distance);
            }
        }
        best
    }

    fn follow(&mut self, ellipsoids: &Ellipsoids) {
        for (k, placed) in self.placed.iter_mut().enumerate() {
            let now = ellipsoids.transform(k).unwrap_or(Frame::NONE);
            placed.motion = now.after(&placed.back);
            if now != placed.forth {
                placed.forth = now;
                placed.back = now.inverse();
            }
        }
    }

    fn carry(&mut self) {
        for v in 0..self.x.len() {
            let motion = self.placed[self.parents[v]].motion;
            self.put(v, motion.applied(self.at(v)));
            self.velocities[v] = motion.turned(self.velocities[v]);
        }
    }

    fn correct_edges(&mut self) {
        for _ in 0..PASSES {
            for k in 0..self.edges.len() {
                let [a, b] = self.edges[k].map(|v| v as usize);
                let gap = difference(self.at(b), self.at(a));
                let length = dot(gap, gap).sqrt().max(1e-9);
                let wanted = length.clamp(BOUNDS[0] * self.lengths[k], BOUNDS[1] * self.lengths[k]);
                let share = 0.5 * (1.0 - wanted / length);
                let [p, q] = [self.at(a), self.at(b)];
                self.put(a, std::array::from_fn(|i| p[i] + share * gap[i]));
                self.put(b, std::array::from_fn(|i| q[i] - share * gap[i]));
            }
        }
    }

    fn put_out(&mut self) {
        for v in 0..self.x.len() {
            for k in 0..self.placed.len() {
                if !self.touching[self.groups[self.parents[v]]][self.groups[k]] {
                    continue;
                }
                let placed = &self.placed[k];
                let local = placed.back.applied(self.at(v));
                let q: Vector = std::array::from_fn(|i| local[i] / placed.semi_axes[i]);
                let length = dot(q, q).sqrt();
                if length < 1.0 {
                    let on = std::array::from_fn(|i| q[i] / length.max(1e-6) * placed.semi_axes[i]);
                    self.put(v, self.placed[k].forth.applied(on));
                }
            }
        }
    }

    /// Gravity: carried, forces and one step of Euler's, edges, out of the ellipsoids, parents.
    pub fn adjust_by_gravity(&mut self, ellipsoids: &Ellipsoids, dt: f32) {
        self.follow(ellipsoids);
        self.carry();
        let mut forces = vec![[0.0f32, -9.81, 0.0]; self.x.len()];
        for (ends, rest) in self.edges.iter().zip(&self.lengths) {
            let [a, b] = ends.map(|v| v as usize);
            let gap = difference(self.at(b), self.at(a));
            let length = dot(gap, gap).sqrt().max(1e-9);
            let pull = STIFFNESS * (length - rest) / length;
            for i in 0..3 {
                forces[a][i] += pull * gap[i];
                forces[b][i] -= pull * gap[i];
            }
        }
        let starts: Vec<Vector> = (0..self.x.len()).map(|v| self.at(v)).collect();
        for (v, force) in forces.iter().enumerate() {
            let velocity = &mut self.velocities[v];
            *velocity =
                std::array::from_fn(|i| (velocity[i] + dt * force[i]) * (1.0 - DAMPING * dt));
            let step = *velocity;
            let p = self.at(v);
            self.put(v, std::array::from_fn(|i| p[i] + dt * step[i]));
        }
        self.correct_edges();
        self.put_out();
        for (v, start) in starts.iter().enumerate() {
            let gap = difference(self.at(v), *start);
            self.velocities[v] = gap.map(|x| (x / dt).clamp(-4.0, 4.0));
        }
        for v in 0..self.x.len() {
            let own = self.groups[self.parents[v]];
            self.parents[v] = self.nearest(v, |k| self.touching[own][self.groups[k]]);
        }
    }

    /// Shape: carried, drawn to the rest offset, edges, out of the ellipsoids.
    pub fn adjust_by_shape(&mut self, ellipsoids: &Ellipsoids) {
        self.follow(ellipsoids);
        self.carry();
        for v in 0..self.x.len() {
            let rest = self.placed[self.first_parents[v]]
                .forth
                .applied(self.offsets[v]);
            let p = self.at(v);
            self.put(v, std::array::from_fn(|i| p[i] + DRAWN * (rest[i] - p[i])));
        }
        self.correct_edges();
        self.put_out();
    }

    /// Shortest and longest edge over rest.
    pub fn edge_extremes(&self) -> [f32; 2] {
        let ratios = self.edges.iter().zip(&self.lengths).map(|(ends, rest)| {
            let [a, b] = ends.map(|v| self.at(v as usize));
            let gap = difference(a, b);
            dot(gap, gap).sqrt() / rest
        });
        ratios.fold([f32::INFINITY, 0.0], |[low, high], r| {
            [low.min(r), high.max(r)]
        })
    }
}
