//! A patch: vertices that one task moves on its own for several substeps, with a halo round them.
//!
//! A ring is what the forces at the last one's vertices look at: their bending rows and triangles.
//! What a halo vertex lacks spoils one ring a substep, so a halo of k rings leaves the patch's own
//! vertices exact for k substeps. Patches
//! then need to meet only once every k substeps, and stay in the fast memory of their core
//! meanwhile. Rings that are spoiled already are not moved any more.

use super::Lane;
use super::membrane::EdgeMembrane;
use super::rows::Rows;
use super::touch::Touching;
use crate::{Elastic, ElasticEnd, Model};
use std::collections::BTreeMap;

/// Vertices moved by one task.
pub struct Patch {
    /// Its vertices in the model: those it owns first, then the halo ring by ring.
    pub vertices: Vec<u32>,
    /// Positions [m] of its vertices.
    pub positions: Vec<Lane>,
    /// Velocities [m/s] of its vertices.
    pub velocities: Vec<Lane>,
    /// Contacts of its vertices, by their places in it.
    pub touching: Vec<Touching>,
    /// Largest and smallest principal squared stretch when last measured.
    pub stretch: [f64; 2],
    /// Energy of motion, stretch and bending [J] when last measured, of what it owns.
    pub energy: f64,
    /// Where each vertex of the model lies in it; [`NOWHERE`] outside.
    local: Vec<u32>,
    /// How many vertices lie within each ring; the first are those it owns.
    vertex_end: Vec<usize>,
    /// Triangles in the order of their innermost ring.
    triangles: Vec<Triangle>,
    /// How many triangles have a corner within each ring.
    triangle_end: Vec<usize>,
    /// Their membranes; those that are alike kept once.
    membranes: Vec<EdgeMembrane>,
    rows: Rows,
    elastics: Vec<Elastic>,
    inertia: Vec<Inertia>,
    gradient: Vec<Lane>,
    moved: Vec<Lane>,
}

#[derive(Clone, Copy)]
struct Triangle {
    corners: [u32; 3],
    membrane: u32,
}

impl Triangle {
    #[inline(always)]
    fn edges(&self, x: &[Lane]) -> [Lane; 2] {
        let [a, b, c] = self.corners.map(|c| x[c as usize]);
        [b.minus(a), c.minus(a)]
    }
}

/// How a vertex answers to force and to gravity.
#[derive(Clone, Copy)]
struct Inertia {
    /// Its inverse mass [1/kg], zero where pinned.
    inverse_mass: f64,
    /// One where it falls, zero where pinned.
    falls: f64,
}

/// What acts for some substeps.
#[derive(Clone, Copy)]
pub struct Course {
    /// Length of a substep [s].
    pub h: f64,
    /// How many: no more than the halo has rings.
    pub count: usize,
    /// Gravity [m/s2].
    pub gravity: Lane,
    /// Drag per mass [1/s].
    pub drag: f64,
}

const NOWHERE: u32 = u32::MAX;

/// Streams of triangles that are worked on in turn.
const STREAMS: usize = 4;

impl Patch {
    /// A patch that owns some vertices, with a halo of `rings` rings.
    pub fn new(model: &Model, owned: Vec<u32>, rings: usize) -> Self {
        let (vertices, vertex_end) = with_halo(model, owned, rings);
        let mut local = vec![NOWHERE; model.vertex_count()];
        for (at, &v) in vertices.iter().enumerate() {
            local[v as usize] = at as u32;
        }
        let within = |v: u32| Some(local[v as usize]).filter(|&at| at != NOWHERE);
        let inertia = |&v: &u32| match model.pinned[v as usize] {
            true => Inertia {
                inverse_mass: 0.0,
                falls: 0.0,
            },
            false => Inertia {
                inverse_mass: 1.0 / model.mass[v as usize],
                falls: 1.0,
            },
        };
        let elastics = model.elastics.iter().filter_map(|elastic| {
            Some(Elastic {
                from: within(elastic.from)?,
                to: match elastic.to {
                    ElasticEnd::Vertex(v) => ElasticEnd::Vertex(within(v)?),
                    point => point,
                },
                law: elastic.law,
            })
        });
        let mut patch = Self {
            elastics: elastics.collect(),
            rows: Rows::new(model, &vertices, within),
            inertia: vertices.iter().map(inertia).collect(),
            positions: vec![Lane::default(); vertices.len()],
            velocities: vec![Lane::default(); vertices.len()],
            gradient: vec![Lane::default(); vertices.len()],
            moved: vec![Lane::default(); vertices.len()],
            touching: Vec::new(),
            stretch: [1.0; 2],
            energy: 0.0,
            local,
            vertex_end,
            triangles: Vec::new(),
            triangle_end: Vec::new(),
            membranes: Vec::new(),
            vertices,
        };
        patch.add_triangles(model);
        patch
    }

    fn add_triangles(&mut self, model: &Model) {
        let mut by_ring = vec![Vec::new(); self.vertex_end.len()];
        let mut known: BTreeMap<[u64; 9], u32> = BTreeMap::new();
        for (t, corners) in model.triangles.iter().enumerate() {
            let corners = corners.map(|v| self.local[v as usize]);
            let innermost = corners[0].min(corners[1]).min(corners[2]) as usize;
            if corners.contains(&NOWHERE) {
                continue;
            }
            let law = model.laws[model.material[t] as usize].stiffness;
            let made = EdgeMembrane::new(&model.elements[t], law);
            let membrane = *known.entry(made.bits()).or_insert_with(|| {
                self.membranes.push(made);
                self.membranes.len() as u32 - 1
            });
            // Vertices are in the order of their rings.
            let ring = self.vertex_end.partition_point(|&end| end <= innermost);
            by_ring[ring].push(Triangle { corners, membrane });
        }
        for of_ring in &by_ring {
            self.triangles.extend(interleaved(of_ring));
            self.triangle_end.push(self.triangles.len());
        }
    }

    /// How many vertices it owns.
    pub fn owned(&self) -> usize {
        self.vertex_end[0]
    }

    /// Copies its vertices.
    pub fn load(&mut self, positions: &[Lane], velocities: &[Lane]) {
        let lanes = self.positions.iter_mut().zip(&mut self.velocities);
        for ((x, v), &at) in lanes.zip(&self.vertices) {
            *x = positions[at as usize];
            *v = velocities[at as usize];
        }
        self.gradient.fill(Lane::default());
    }

    /// Takes over the contacts at its vertices.
    pub fn load_contacts(&mut self, touching: &[Touching]) {
        self.touching.clear();
        for contact in touching {
            let at = self.local[contact.vertex as usize];
            if at != NOWHERE {
                let mut mine = *contact;
                mine.vertex = at;
                self.touching.push(mine);
            }
        }
    }

    /// Moves the patch on under all its forces: drift half a step, kick, drift half a step
    /// (Verlet), neighbouring half drifts joined.
    pub fn advance(&mut self, course: Course) {
        pulp::Arch::new().dispatch(Run {
            patch: self,
            course,
        });
    }

    /// Measures the stretch of the triangles at what it owns.
    pub fn measure_stretch(&mut self) {
        pulp::Arch::new().dispatch(Stretch { patch: self });
    }

    /// Measures the energy of what it owns: its vertices, and the triangles whose first corner is
    /// one of them.
    pub fn measure_energy(&mut self) {
        pulp::Arch::new().dispatch(Energy { patch: self });
    }

    #[inline(always)]
    fn drift(&mut self, h: f64) {
        for (x, v) in self.positions.iter_mut().zip(&self.velocities) {
            *x = x.add_scaled(*v, h);
        }
    }

    #[inline(always)]
    fn add_membrane(&mut self, ring: usize) {
        // Of one length, so that an index is checked once.
        let x = &self.positions[..];
        let gradient = &mut self.gradient[..x.len()];
        let membranes = &self.membranes[..];
        for triangle in &self.triangles[..self.triangle_end[ring]] {
            let edges = triangle.edges(x);
            let [by_1, by_2] = membranes[triangle.membrane as usize].gradient(edges);
            let [a, b, c] = triangle.corners.map(|c| c as usize);
            gradient[a] = gradient[a].minus(by_1.plus(by_2));
            gradient[b] = gradient[b].plus(by_1);
            gradient[c] = gradient[c].plus(by_2);
        }
    }

    #[inline(always)]
    fn add_contacts(&mut self, ring: usize, h: f64) {
        for contact in &mut self.touching {
            let at = contact.vertex as usize;
            if at < self.vertex_end[ring] {
                let (x, v) = (self.positions[at], self.velocities[at]);
                let force = contact.press(x, v, 1.0 / self.inertia[at].inverse_mass, h);
                self.gradient[at] = self.gradient[at].minus(force);
            }
        }
    }

    #[inline(always)]
    fn add_elastics(&mut self) {
        for elastic in &self.elastics {
            let from = elastic.from as usize;
            let gap = self.positions[from].minus(end_of(elastic, &self.positions));
            let secant = elastic.law.secant(gap.into());
            self.gradient[from] = self.gradient[from].add_scaled(gap, secant);
            if let ElasticEnd::Vertex(v) = elastic.to {
                let to = &mut self.gradient[v as usize];
                *to = to.add_scaled(gap, -secant);
            }
        }
    }

    /// Adds bending, then v = ((1 - c h/2) v + h a) / (1 + c h/2) with drag c, x = x + `drift` v;
    /// the gradient is cleared for the next.
    #[inline(always)]
    fn kick_and_drift(&mut self, ring: usize, course: Course, drift: f64) {
        let half = 0.5 * course.drag * course.h;
        let (keep, gain) = ((1.0 - half) / (1.0 + half), course.h / (1.0 + half));
        let end = self.vertex_end[ring];
        let (x, rows) = (&self.positions[..], &self.rows);
        let moving = self.moved[..end].iter_mut().zip(&mut self.velocities);
        let acting = self.gradient.iter_mut().zip(&self.inertia);
        for (at, ((to, v), (g, m))) in moving.zip(acting).enumerate() {
            let gradient = g.plus(rows.gradient(at, x));
            *v = v
                .scaled(keep)
                .add_scaled(course.gravity, gain * m.falls)
                .add_scaled(gradient, -gain * m.inverse_mass);
            *to = x[at].add_scaled(*v, drift);
            *g = Lane::default();
        }
        std::mem::swap(&mut self.positions, &mut self.moved);
    }
}

/// Two pairs of largest and smallest as one; what is no number stays.
#[inline(always)]
pub fn wider([most, least]: [f64; 2], [high, low]: [f64; 2]) -> [f64; 2] {
    let lost = most.is_nan() || least.is_nan();
    [
        if high <= most || lost { most } else { high },
        if low >= least || lost { least } else { low },
    ]
}

/// Where an elastic ends [m].
pub fn end_of(elastic: &Elastic, positions: &[Lane]) -> Lane {
    match elastic.to {
        ElasticEnd::Vertex(v) => positions[v as usize],
        ElasticEnd::Point(p) => p.into(),
    }
}

/// Some vertices and those that forces at them look at, `rings` times, ring by ring, with how many
/// lie within each ring.
fn with_halo(model: &Model, mut vertices: Vec<u32>, rings: usize) -> (Vec<u32>, Vec<usize>) {
    let mut inside = vec![false; model.vertex_count()];
    for &v in &vertices {
        inside[v as usize] = true;
    }
    let mut ends = vec![vertices.len()];
    let mut front = 0;
    for _ in 0..rings {
        let end = vertices.len();
        for at in front..end {
            let v = vertices[at] as usize;
            let uses = model.corner_start[v] as usize..model.corner_start[v + 1] as usize;
            let corners = model.corners[uses].iter();
            let triangles = corners.flat_map(|&corner| model.triangles[corner as usize / 3]);
            let (columns, _) = model.bending.row_entries(v);
            for u in triangles.chain(columns.iter().copied()) {
                if !std::mem::replace(&mut inside[u as usize], true) {
                    vertices.push(u);
                }
            }
        }
        ends.push(vertices.len());
        front = end;
    }
    (vertices, ends)
}

/// Triangles in an order in which neighbours follow one another only after [`STREAMS`] others: a
/// sum at a vertex need not wait then for the one just stored there.
fn interleaved(triangles: &[Triangle]) -> impl Iterator<Item = Triangle> {
    let length = triangles.len().div_ceil(STREAMS);
    (0..length)
        .flat_map(move |at| (0..STREAMS).map(move |stream| stream * length + at))
        .filter_map(|at| triangles.get(at).copied())
}

struct Run<'a> {
    patch: &'a mut Patch,
    course: Course,
}

impl pulp::WithSimd for Run<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let (patch, course) = (self.patch, self.course);
        let outermost = patch.vertex_end.len() - 1;
        patch.drift(0.5 * course.h);
        for left in (0..course.count).rev() {
            let ring = left.min(outermost);
            let drift = if left == 0 { 0.5 * course.h } else { course.h };
            patch.add_membrane(ring);
            patch.add_contacts(ring, course.h);
            patch.add_elastics();
            patch.kick_and_drift(ring, course, drift);
        }
    }
}

struct Stretch<'a> {
    patch: &'a mut Patch,
}

impl pulp::WithSimd for Stretch<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let patch = self.patch;
        patch.stretch = [1.0; 2];
        for triangle in &patch.triangles[..patch.triangle_end[0]] {
            let edges = triangle.edges(&patch.positions);
            let membrane = &patch.membranes[triangle.membrane as usize];
            patch.stretch = wider(patch.stretch, membrane.squared_stretch(edges));
        }
    }
}

struct Energy<'a> {
    patch: &'a mut Patch,
}

impl pulp::WithSimd for Energy<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let patch = self.patch;
        let owned = patch.owned();
        patch.energy = 0.0;
        for triangle in &patch.triangles[..patch.triangle_end[0]] {
            if (triangle.corners[0] as usize) < owned {
                let membrane = &patch.membranes[triangle.membrane as usize];
                patch.energy += membrane.energy(triangle.edges(&patch.positions));
            }
        }
        for (at, v) in patch.velocities[..owned].iter().enumerate() {
            if patch.inertia[at].falls > 0.0 {
                patch.energy += 0.5 * v.dot(*v) / patch.inertia[at].inverse_mass;
            }
            let bending = patch.rows.gradient(at, &patch.positions);
            patch.energy += 0.5 * bending.dot(patch.positions[at]);
        }
    }
}
