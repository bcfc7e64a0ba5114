//! A patch: vertices that one task moves on its own for several substeps, with a halo round them.
//!
//! A ring is what the forces at the last one's vertices look at: their bending rows and triangles.
//! What a halo vertex lacks spoils one ring a substep, so a halo of k rings leaves the patch's own
//! vertices exact for k substeps. Patches
//! then need to meet only once every k substeps, and stay in the fast memory of their core
//! meanwhile. Rings that are spoiled already are not moved any more.

use super::Lane;
use super::octets::{PAD, Points, load, padded, parts, place, store};
use super::rows::{Rows, rounding};
use super::tensions::{Ground, Tensions, within};
use super::touch::Touching;
use crate::{Elastic, ElasticEnd, System};
use pulp::Simd;

/// Vertices moved by one task.
pub struct Patch {
    /// Its vertices in the model, in its own order.
    pub vertices: Vec<u32>,
    /// Contacts of its vertices, by their places in it; those at vertices that others look at, and those at
    /// its halo.
    touching: Vec<Touching>,
    shown: Vec<u32>,
    watched: Vec<u32>,
    /// Largest and smallest principal squared stretch when last measured.
    pub stretch: [f64; 2],
    /// Energy of motion, stretch and bending [J] when last measured, of what it owns.
    pub energy: f64,
    positions: Points,
    velocities: Points,
    gradient: Points,
    moved: Points,
    /// Where each vertex of the model lies in it; [`NOWHERE`] outside.
    local: Vec<u32>,
    /// The ring of each vertex; zero are those it owns.
    ring: Vec<usize>,
    /// Owned vertices that others look at, and whether each is one.
    border: Vec<u32>,
    is_border: Vec<bool>,
    /// Vertices it does not own.
    halo: Vec<u32>,
    /// Groups with a vertex within each ring.
    groups: Vec<Vec<u32>>,
    /// Inverse masses [1/kg], zero where pinned.
    inverse_mass: Vec<f64>,
    /// One where a vertex falls, zero where pinned.
    falls: Vec<f64>,
    forces: Forces,
    elastics: Vec<Elastic>,
}

/// The stiffness of a patch.
struct Forces {
    bending: Rows,
    membrane: Tensions,
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

impl Patch {
    /// A patch that owns some vertices, with a halo of `rings` rings.
    ///
    /// Its vertices stand in the order of the model, or first all even and then all odd ones,
    /// whichever lets more operands lie side by side: on a grid with alternating diagonals every
    /// other vertex is alike.
    pub fn new(system: &System, owned: Vec<u32>, rings: usize) -> Self {
        let in_turn = with_halo(system, owned, rings);
        let mut by_parity = in_turn.clone();
        by_parity.sort_unstable_by_key(|&(v, _)| (v % 2, v));
        let [first, second] = [in_turn, by_parity].map(|order| Self::in_order(system, &order));
        if second.forces.cost() < first.forces.cost() {
            second
        } else {
            first
        }
    }

    /// A patch of some vertices with their rings.
    fn in_order(system: &System, order: &[(u32, usize)]) -> Self {
        let (vertices, ring): (Vec<u32>, Vec<usize>) = order.iter().copied().unzip();
        let count = vertices.len();
        let mut local = vec![NOWHERE; system.vertex_count()];
        let (mut inverse_mass, mut falls) = (padded(count), padded(count));
        for (at, &v) in vertices.iter().enumerate() {
            local[v as usize] = at as u32;
            if !system.prescribed.pinned[v as usize] {
                (inverse_mass[PAD + at], falls[PAD + at]) =
                    (1.0 / system.rest.mass[v as usize], 1.0);
            }
        }
        let within_it = |v: u32| Some(local[v as usize]).filter(|&at| at != NOWHERE);
        let elastics = system.elastics().filter_map(|elastic| {
            Some(Elastic {
                from: within_it(elastic.from)?,
                to: match elastic.to {
                    ElasticEnd::Vertex(v) => ElasticEnd::Vertex(within_it(v)?),
                    point => point,
                },
                law: elastic.law,
            })
        });
        let triangles: Vec<(usize, [u32; 3])> = (system.topology.triangles.iter().enumerate())
            .map(|(t, corners)| (t, corners.map(|v| local[v as usize])))
            .filter(|(_, corners)| !corners.contains(&NOWHERE))
            .collect();
        let rings = ring.iter().max().map_or(1, |most| most + 1);
        Self {
            elastics: elastics.collect(),
            forces: Forces {
                bending: Rows::new(&bending_rows(system, &vertices, within_it)),
                membrane: Tensions::new(&Ground {
                    system,
                    triangles: &triangles,
                    ring: &ring,
                    vertices: &vertices,
                }),
            },
            groups: within(&ring, rings),
            positions: Points::new(count),
            velocities: Points::new(count),
            gradient: Points::new(count),
            moved: Points::new(count),
            border: Vec::new(),
            is_border: vec![false; count],
            halo: (0u32..)
                .zip(&ring)
                .filter(|(_, ring)| **ring > 0)
                .map(|(at, _)| at)
                .collect(),
            touching: Vec::new(),
            shown: Vec::new(),
            watched: Vec::new(),
            stretch: [1.0; 2],
            energy: 0.0,
            inverse_mass,
            falls,
            local,
            ring,
            vertices,
        }
    }

    /// Whether a vertex, by its place in the patch, is its own.
    pub fn owns(&self, at: usize) -> bool {
        self.ring[at] == 0
    }

    /// Names the vertices that others look at: it hands them over when patches meet.
    pub fn share(&mut self, looked_at: impl Fn(u32) -> bool) {
        let places = 0..self.vertices.len();
        let shared = places.filter(|&at| self.owns(at) && looked_at(self.vertices[at]));
        self.border = shared.map(|at| at as u32).collect();
        for &at in &self.border {
            self.is_border[at as usize] = true;
        }
    }

    /// The vertices of its halo, in the model.
    pub fn halo(&self) -> impl Iterator<Item = u32> {
        self.halo.iter().map(|&at| self.vertices[at as usize])
    }

    /// Copies its vertices, and forgets its contacts.
    pub fn load(&mut self, positions: &[Lane], velocities: &[Lane]) {
        // Lanes without a vertex too: what blew up there would come back as zero times no number.
        let all = [
            &mut self.positions,
            &mut self.moved,
            &mut self.velocities,
            &mut self.gradient,
        ];
        for axis in all.into_iter().flat_map(Points::axes_mut) {
            axis.fill(0.0);
        }
        self.forces.membrane.clear();
        for contacts in [&mut self.shown, &mut self.watched] {
            contacts.clear();
        }
        self.touching.clear();
        for at in 0..self.vertices.len() {
            self.load_vertex(at, positions, velocities);
        }
    }

    /// Copies its halo.
    pub fn load_halo(&mut self, positions: &[Lane], velocities: &[Lane]) {
        for k in 0..self.halo.len() {
            self.load_vertex(self.halo[k] as usize, positions, velocities);
        }
    }

    fn load_vertex(&mut self, at: usize, positions: &[Lane], velocities: &[Lane]) {
        let v = self.vertices[at] as usize;
        // Into both: what is spoiled is not moved any more, but it is looked at.
        self.positions.set(at, positions[v]);
        self.moved.set(at, positions[v]);
        self.velocities.set(at, velocities[v]);
    }

    /// Vertices that it owns: their numbers in the model, and their places in it.
    pub fn owned(&self) -> impl Iterator<Item = (u32, u32)> {
        let all = (0u32..).zip(&self.vertices);
        let own = all.filter(|(at, _)| self.owns(*at as usize));
        own.map(|(at, &v)| (v, at))
    }

    /// Position and velocity of a vertex, by its place.
    #[inline]
    pub fn vertex(&self, at: u32) -> (Lane, Lane) {
        let at = at as usize;
        (self.positions.get(at), self.velocities.get(at))
    }

    /// Hands over what others look at.
    pub fn unload_border(&self, positions: &mut [Lane], velocities: &mut [Lane]) {
        for &at in &self.border {
            let v = self.vertices[at as usize] as usize;
            (positions[v], velocities[v]) = self.vertex(at);
        }
    }

    /// Takes over the contacts at its vertices.
    pub fn load_contacts(&mut self, touching: &[Touching]) {
        for contacts in [&mut self.shown, &mut self.watched] {
            contacts.clear();
        }
        self.touching.clear();
        for contact in touching {
            let at = self.local[contact.vertex as usize];
            if at == NOWHERE {
                continue;
            }
            let mine = self.touching.len() as u32;
            if !self.owns(at as usize) {
                self.watched.push(mine);
            } else if self.is_border[at as usize] {
                self.shown.push(mine);
            }
            let mut contact = *contact;
            contact.vertex = at;
            self.touching.push(contact);
        }
    }

    /// Takes over what contacts at its halo have become; the others it has.
    pub fn renew_contacts(&mut self, touching: &[Touching]) {
        for &k in &self.watched {
            self.touching[k as usize].renew(touching);
        }
    }

    /// Contacts at vertices that it owns.
    pub fn own_contacts(&self) -> impl Iterator<Item = &Touching> {
        let touching = self.touching.iter();
        touching.filter(|contact| self.owns(contact.vertex as usize))
    }

    /// Those that others look at.
    pub fn border_contacts(&self) -> impl Iterator<Item = &Touching> {
        self.shown.iter().map(|&k| &self.touching[k as usize])
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
    fn drift<S: Simd>(&mut self, simd: S, h: f64) {
        let h = simd.splat_f64s(h);
        let (x, v) = (self.positions.axes_mut(), self.velocities.axes());
        for (x, v) in x.into_iter().zip(v) {
            // Padded arrays are whole groups.
            let (x, v) = (S::as_mut_simd_f64s(x).0, S::as_simd_f64s(v).0);
            for (x, v) in x.iter_mut().zip(v) {
                *x = simd.mul_add_f64s(*v, h, *x);
            }
        }
    }

    #[inline(always)]
    fn add_contacts(&mut self, ring: usize, h: f64) {
        for contact in &mut self.touching {
            let at = contact.vertex as usize;
            if self.ring[at] <= ring {
                let (x, v) = (self.positions.get(at), self.velocities.get(at));
                let force = contact.press(x, v, 1.0 / self.inverse_mass[PAD + at], h);
                self.gradient.add(at, force.scaled(-1.0));
            }
        }
    }

    #[inline(always)]
    fn add_elastics(&mut self) {
        for elastic in &self.elastics {
            let from = elastic.from as usize;
            let end = match elastic.to {
                ElasticEnd::Vertex(v) => self.positions.get(v as usize),
                ElasticEnd::Point(p) => p.into(),
            };
            let gap = self.positions.get(from).minus(end);
            let pull = gap.scaled(elastic.law.secant(gap.into()));
            self.gradient.add(from, pull);
            if let ElasticEnd::Vertex(v) = elastic.to {
                self.gradient.add(v as usize, pull.scaled(-1.0));
            }
        }
    }

    /// Adds stretch and bending, then v = ((1 - c h/2) v + h a) / (1 + c h/2) with drag c,
    /// x = x + `drift` v; the gradient is cleared for the next.
    #[inline(always)]
    fn kick_and_drift<S: Simd>(&mut self, simd: S, ring: usize, course: Course, drift: f64) {
        let half = 0.5 * course.drag * course.h;
        let (keep, gain) = ((1.0 - half) / (1.0 + half), course.h / (1.0 + half));
        let fall = course.gravity.scaled(gain).coordinates();
        let fall = [0, 1, 2].map(|axis| simd.splat_f64s(fall[axis]));
        let [keep, gain, drift] = [keep, -gain, drift].map(|k| simd.splat_f64s(k));
        let x = self.positions.axes();
        let (v, g) = (self.velocities.axes_mut(), self.gradient.axes_mut());
        let to = self.moved.axes_mut();
        for &group in &self.groups[ring] {
            for part in 0..parts::<S>() {
                let at = place::<S>(group as usize, part);
                let force = self.forces.gradient(simd, group as usize, part, x);
                let inverse_mass = load::<S>(&self.inverse_mass, at);
                let (falls, gain) = (
                    load::<S>(&self.falls, at),
                    simd.mul_f64s(gain, inverse_mass),
                );
                for axis in 0..3 {
                    let force = simd.add_f64s(force[axis], load::<S>(g[axis], at));
                    let v_new = simd.mul_f64s(load::<S>(v[axis], at), keep);
                    let v_new = simd.mul_add_f64s(fall[axis], falls, v_new);
                    let v_new = simd.mul_add_f64s(gain, force, v_new);
                    store::<S>(v[axis], at, v_new);
                    let x_new = simd.mul_add_f64s(v_new, drift, load::<S>(x[axis], at));
                    store::<S>(to[axis], at, x_new);
                    store::<S>(g[axis], at, simd.splat_f64s(0.0));
                }
            }
        }
        std::mem::swap(&mut self.positions, &mut self.moved);
    }
}

impl Forces {
    /// Numbers of runs that the loads of a substep are worth.
    fn cost(&self) -> usize {
        4 * self.bending.cost() + self.membrane.cost()
    }

    /// The gradient of stretch and bending by a part of a group of vertices [N].
    #[inline(always)]
    fn gradient<S: Simd>(
        &self,
        simd: S,
        group: usize,
        part: usize,
        x: [&[f64]; 3],
    ) -> [S::f64s; 3] {
        let bending = self.bending.product_points(simd, group, part, x);
        let membrane = self.membrane.gradient(simd, group, part, x);
        [
            simd.add_f64s(bending[0], membrane[0]),
            simd.add_f64s(bending[1], membrane[1]),
            simd.add_f64s(bending[2], membrane[2]),
        ]
    }
}

/// The rows of the bending matrix for some vertices; `local` says where a vertex of the model lies
/// in the patch, and a row that looks outside it is left empty.
///
/// The matrix stays symmetric, so momentum is kept, and the diagonal is minus the sum of the
/// others, so that a shift of the cloth bends nothing.
fn bending_rows(
    system: &System,
    vertices: &[u32],
    local: impl Fn(u32) -> Option<u32>,
) -> Vec<Vec<(u32, f64)>> {
    let diagonals = (0..system.vertex_count()).map(|v| system.rest.bending.diagonal(v));
    let round = rounding(diagonals.fold(f64::MIN_POSITIVE, f64::max));
    let entry = |row: u32, column: u32| {
        let (columns, values) = system.rest.bending.row_entries(row as usize);
        columns.binary_search(&column).map_or(0.0, |at| values[at])
    };
    let row = |&v: &u32| {
        let (columns, _) = system.rest.bending.row_entries(v as usize);
        let mut row = Vec::new();
        let mut diagonal = 0.0;
        for &column in columns.iter().filter(|&&column| column != v) {
            let Some(at) = local(column) else {
                return Vec::new();
            };
            let value = round(entry(v.min(column), v.max(column)));
            row.push((at, value));
            diagonal -= value;
        }
        row.extend(local(v).map(|at| (at, diagonal)));
        row
    };
    vertices.iter().map(row).collect()
}

/// Two pairs of largest and smallest as one; what is no number stays.
pub fn wider([most, least]: [f64; 2], [high, low]: [f64; 2]) -> [f64; 2] {
    let lost = most.is_nan() || least.is_nan();
    [
        if high <= most || lost { most } else { high },
        if low >= least || lost { least } else { low },
    ]
}

/// Some vertices and those that forces at them look at, `rings` times, each with its ring, in the
/// order of the model.
fn with_halo(system: &System, owned: Vec<u32>, rings: usize) -> Vec<(u32, usize)> {
    let mut inside = vec![false; system.vertex_count()];
    for &v in &owned {
        inside[v as usize] = true;
    }
    let mut vertices: Vec<(u32, usize)> = owned.into_iter().map(|v| (v, 0)).collect();
    let mut front = 0;
    for ring in 1..=rings {
        let end = vertices.len();
        for at in front..end {
            let v = vertices[at].0 as usize;
            let uses = system.topology.corner_start[v] as usize
                ..system.topology.corner_start[v + 1] as usize;
            let corners = system.topology.corners[uses].iter();
            let triangles =
                corners.flat_map(|&corner| system.topology.triangles[corner as usize / 3]);
            let (columns, _) = system.rest.bending.row_entries(v);
            for u in triangles.chain(columns.iter().copied()) {
                if !std::mem::replace(&mut inside[u as usize], true) {
                    vertices.push((u, ring));
                }
            }
        }
        front = end;
    }
    vertices.sort_unstable();
    vertices
}

struct Run<'a> {
    patch: &'a mut Patch,
    course: Course,
}

impl pulp::WithSimd for Run<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let (patch, course) = (self.patch, self.course);
        let outermost = patch.groups.len() - 1;
        patch.drift(simd, 0.5 * course.h);
        for left in (0..course.count).rev() {
            let ring = left.min(outermost);
            let drift = if left == 0 { 0.5 * course.h } else { course.h };
            patch.forces.membrane.measure(simd, ring, &patch.positions);
            patch.forces.membrane.draw(simd, ring);
            patch.add_contacts(ring, course.h);
            patch.add_elastics();
            patch.kick_and_drift(simd, ring, course, drift);
        }
    }
}

struct Stretch<'a> {
    patch: &'a mut Patch,
}

impl pulp::WithSimd for Stretch<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let patch = self.patch;
        patch.stretch = patch.forces.membrane.stretch(simd, &patch.positions);
    }
}

struct Energy<'a> {
    patch: &'a mut Patch,
}

impl pulp::WithSimd for Energy<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let patch = self.patch;
        patch.energy = patch.forces.membrane.energy(simd, &patch.positions);
        let x = patch.positions.axes();
        for &group in &patch.groups[0] {
            for part in 0..parts::<S>() {
                let at = place::<S>(group as usize, part);
                let bending = patch
                    .forces
                    .bending
                    .product_points(simd, group as usize, part, x);
                for (axis, bending) in patch.gradient.axes_mut().into_iter().zip(bending) {
                    store::<S>(axis, at, bending);
                }
            }
        }
        for at in 0..patch.vertices.len() {
            if patch.ring[at] == 0 {
                let v = patch.velocities.get(at);
                if patch.falls[PAD + at] > 0.0 {
                    patch.energy += 0.5 * v.dot(v) / patch.inverse_mass[PAD + at];
                }
                patch.energy += 0.5 * patch.gradient.get(at).dot(patch.positions.get(at));
            }
        }
        for axis in patch.gradient.axes_mut() {
            axis.fill(0.0);
        }
    }
}
