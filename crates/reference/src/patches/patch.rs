//! A patch: vertices that one task advances by several substeps without communication, with a halo around
//! them.
//!
//! Ring r + 1 of the halo holds the vertices on which the forces at ring r depend, by bending rows and by
//! triangles. The outermost ring lacks forces, and each substep makes one more ring wrong, so a halo of k rings
//! leaves the vertices that the patch owns exact for k substeps. Patches exchange halos only once every k
//! substeps and stay in the cache of their core meanwhile. A ring that is wrong already is not advanced.

use super::Lane;
use super::octets::{PAD, Points, lane_group_start, lane_groups, load, padded, store};
use super::patch_contacts::PatchContact;
use super::rows::{Rows, rounding};
use super::tensions::{PatchTopology, Tensions, groups_by_ring};
use pulp::Simd;
use toile_drape::lane_arithmetic::{F64s, Number, Triple};
use toile_drape::{Elastic, ElasticEnd, System};

/// Vertices advanced by one task.
pub struct Patch {
    /// The number in the model of each of its vertices.
    pub vertices: Vec<u32>,
    /// Contacts of its vertices, by their indices in the patch.
    contacts: Vec<PatchContact>,
    /// Indices of the contacts at border vertices and at halo vertices.
    border_contacts: Vec<u32>,
    halo_contacts: Vec<u32>,
    /// Largest and smallest principal squared stretch when last measured (1).
    pub stretch: [f64; 2],
    /// Kinetic, membrane and bending energy of the vertices and edges that it owns, when last measured (J).
    pub energy: f64,
    positions: Points,
    velocities: Points,
    gradient: Points,
    next_positions: Points,
    /// Index in the patch of each vertex of the model; [`OUTSIDE`] for the others.
    local: Vec<u32>,
    /// The halo ring of each vertex; zero for vertices that it owns.
    ring: Vec<usize>,
    /// Owned vertices that lie in halos of other patches, and whether each vertex is one.
    border: Vec<u32>,
    is_border: Vec<bool>,
    /// Vertices it does not own.
    halo: Vec<u32>,
    /// For each ring the groups of eight with a vertex of at most that ring.
    groups: Vec<Vec<u32>>,
    /// Inverse masses (1/kg), zero where pinned.
    inverse_mass: Vec<f64>,
    /// Factor of gravity: one, zero where pinned.
    gravity_factor: Vec<f64>,
    forces: Forces,
    elastics: Vec<Elastic>,
}

/// The elastic forces of a patch.
struct Forces {
    bending: Rows,
    membrane: Tensions,
}

/// Some substeps, and what acts in them besides the forces of the patch.
#[derive(Clone, Copy)]
pub struct Substeps {
    /// Length of a substep (s).
    pub h: f64,
    /// Number of substeps: at most the number of halo rings.
    pub count: usize,
    /// Gravity (m/s2).
    pub gravity: Lane,
    /// Drag per mass (1/s).
    pub drag: f64,
}

/// In place of the index of a vertex that is not in the patch.
const OUTSIDE: u32 = u32::MAX;

impl Patch {
    /// A patch that owns some vertices, with a halo of `rings` rings.
    ///
    /// Its vertices are in the order of the model, or all even ones before all odd ones, whichever makes the
    /// loads cheaper: on a grid with alternating diagonals every other vertex has the same stencil.
    pub fn new(system: &System, owned: Vec<u32>, rings: usize) -> Self {
        let in_model_order = with_halo(system, owned, rings);
        let mut by_parity = in_model_order.clone();
        by_parity.sort_unstable_by_key(|&(v, _)| (v % 2, v));
        let [first, second] =
            [in_model_order, by_parity].map(|order| Self::in_order(system, &order));
        if second.forces.cost() < first.forces.cost() {
            second
        } else {
            first
        }
    }

    /// A patch of some vertices, given with their rings.
    fn in_order(system: &System, order: &[(u32, usize)]) -> Self {
        let (vertices, ring): (Vec<u32>, Vec<usize>) = order.iter().copied().unzip();
        let count = vertices.len();
        let mut local = vec![OUTSIDE; system.vertex_count()];
        let (mut inverse_mass, mut gravity_factor) = (padded(count), padded(count));
        for (at, &v) in vertices.iter().enumerate() {
            local[v as usize] = at as u32;
            if !system.prescribed.pinned[v as usize] {
                (inverse_mass[PAD + at], gravity_factor[PAD + at]) =
                    (1.0 / system.rest.mass[v as usize], 1.0);
            }
        }
        let index_of = |v: u32| Some(local[v as usize]).filter(|&at| at != OUTSIDE);
        let elastics = system.elastics().filter_map(|elastic| {
            Some(Elastic {
                from: index_of(elastic.from)?,
                to: match elastic.to {
                    ElasticEnd::Vertex(v) => ElasticEnd::Vertex(index_of(v)?),
                    point => point,
                },
                law: elastic.law,
            })
        });
        let triangles: Vec<(usize, [u32; 3])> = (system.topology.triangles.iter().enumerate())
            .map(|(t, corners)| (t, corners.map(|v| local[v as usize])))
            .filter(|(_, corners)| !corners.contains(&OUTSIDE))
            .collect();
        let rings = ring.iter().max().map_or(1, |most| most + 1);
        Self {
            elastics: elastics.collect(),
            forces: Forces {
                bending: Rows::new(&bending_rows(system, &vertices, index_of)),
                membrane: Tensions::new(&PatchTopology {
                    system,
                    triangles: &triangles,
                    ring: &ring,
                    vertices: &vertices,
                }),
            },
            groups: groups_by_ring(&ring, rings),
            positions: Points::new(count),
            velocities: Points::new(count),
            gradient: Points::new(count),
            next_positions: Points::new(count),
            border: Vec::new(),
            is_border: vec![false; count],
            halo: (0u32..)
                .zip(&ring)
                .filter(|(_, ring)| **ring > 0)
                .map(|(at, _)| at)
                .collect(),
            contacts: Vec::new(),
            border_contacts: Vec::new(),
            halo_contacts: Vec::new(),
            stretch: [1.0; 2],
            energy: 0.0,
            inverse_mass,
            gravity_factor,
            local,
            ring,
            vertices,
        }
    }

    /// Whether it owns the vertex with an index in the patch.
    pub fn owns(&self, at: usize) -> bool {
        self.ring[at] == 0
    }

    /// Sets the border: the owned vertices that lie in halos of other patches, which it hands over at an
    /// exchange.
    pub fn set_border(&mut self, is_in_halo: impl Fn(u32) -> bool) {
        let indices = 0..self.vertices.len();
        let border = indices.filter(|&at| self.owns(at) && is_in_halo(self.vertices[at]));
        self.border = border.map(|at| at as u32).collect();
        for &at in &self.border {
            self.is_border[at as usize] = true;
        }
    }

    /// The numbers in the model of its halo vertices.
    pub fn halo(&self) -> impl Iterator<Item = u32> {
        self.halo.iter().map(|&at| self.vertices[at as usize])
    }

    /// Loads all its vertices and clears its contacts.
    pub fn load(&mut self, positions: &[Lane], velocities: &[Lane]) {
        // Unused lanes too: a NaN left in one would reach sums as zero times NaN.
        let all = [
            &mut self.positions,
            &mut self.next_positions,
            &mut self.velocities,
            &mut self.gradient,
        ];
        for axis in all.into_iter().flat_map(Points::axes_mut) {
            axis.fill(0.0);
        }
        self.forces.membrane.clear();
        self.clear_contacts();
        for at in 0..self.vertices.len() {
            self.load_vertex(at, positions, velocities);
        }
    }

    /// Loads its halo.
    pub fn load_halo(&mut self, positions: &[Lane], velocities: &[Lane]) {
        for k in 0..self.halo.len() {
            self.load_vertex(self.halo[k] as usize, positions, velocities);
        }
    }

    fn load_vertex(&mut self, at: usize, positions: &[Lane], velocities: &[Lane]) {
        let v = self.vertices[at] as usize;
        // Into both buffers: a ring that is wrong is not advanced, but forces still read its positions.
        self.positions.set(at, positions[v]);
        self.next_positions.set(at, positions[v]);
        self.velocities.set(at, velocities[v]);
    }

    /// The vertices that it owns: their numbers in the model and their indices in the patch.
    pub fn owned(&self) -> impl Iterator<Item = (u32, u32)> {
        let all = (0u32..).zip(&self.vertices);
        let own = all.filter(|(at, _)| self.owns(*at as usize));
        own.map(|(at, &v)| (v, at))
    }

    /// Position (m) and velocity (m/s) of the vertex with an index in the patch.
    #[inline]
    pub fn vertex(&self, at: u32) -> (Lane, Lane) {
        let at = at as usize;
        (self.positions.get(at), self.velocities.get(at))
    }

    /// Stores position and velocity of its border vertices.
    pub fn unload_border(&self, positions: &mut [Lane], velocities: &mut [Lane]) {
        for &at in &self.border {
            let v = self.vertices[at as usize] as usize;
            (positions[v], velocities[v]) = self.vertex(at);
        }
    }

    fn clear_contacts(&mut self) {
        self.contacts.clear();
        self.border_contacts.clear();
        self.halo_contacts.clear();
    }

    /// Loads the contacts at its vertices, of all that are near.
    pub fn load_contacts(&mut self, near: &[PatchContact]) {
        self.clear_contacts();
        for contact in near {
            let at = self.local[contact.vertex as usize];
            if at == OUTSIDE {
                continue;
            }
            let index = self.contacts.len() as u32;
            if !self.owns(at as usize) {
                self.halo_contacts.push(index);
            } else if self.is_border[at as usize] {
                self.border_contacts.push(index);
            }
            let mut contact = *contact;
            contact.vertex = at;
            self.contacts.push(contact);
        }
    }

    /// Updates the friction state of the contacts at its halo, which other patches have advanced.
    pub fn refresh_halo_contacts(&mut self, near: &[PatchContact]) {
        for &k in &self.halo_contacts {
            self.contacts[k as usize].refresh_from(near);
        }
    }

    /// Contacts at vertices that it owns.
    pub fn own_contacts(&self) -> impl Iterator<Item = &PatchContact> {
        let contacts = self.contacts.iter();
        contacts.filter(|contact| self.owns(contact.vertex as usize))
    }

    /// Contacts at its border vertices.
    pub fn border_contacts(&self) -> impl Iterator<Item = &PatchContact> {
        let indices = self.border_contacts.iter();
        indices.map(|&k| &self.contacts[k as usize])
    }

    /// Advances the patch under all its forces: drift half a step, kick, drift half a step (position Verlet);
    /// the half drifts between two substeps are joined.
    pub fn advance(&mut self, substeps: Substeps) {
        pulp::Arch::new().dispatch(Advance {
            patch: self,
            substeps,
        });
    }

    /// Measures the principal squared stretches of the triangles at vertices that it owns.
    pub fn measure_stretch(&mut self) {
        pulp::Arch::new().dispatch(MeasureStretch { patch: self });
    }

    /// Measures the kinetic and bending energy of the vertices and the membrane energy of the edges that it
    /// owns.
    pub fn measure_energy(&mut self) {
        pulp::Arch::new().dispatch(MeasureEnergy { patch: self });
    }

    #[inline(always)]
    fn drift<S: Simd>(&mut self, simd: S, h: f64) {
        let h = F64s::splat(simd, h);
        let (x, v) = (self.positions.axes_mut(), self.velocities.axes());
        for (x, v) in x.into_iter().zip(v) {
            // Padded arrays are whole groups.
            let (x, v) = (S::as_mut_simd_f64s(x).0, S::as_simd_f64s(v).0);
            for (x, v) in x.iter_mut().zip(v) {
                let (start, v) = (F64s::new(simd, *x), F64s::new(simd, *v));
                *x = v.mul_add(h, start).vector;
            }
        }
    }

    #[inline(always)]
    fn add_contacts(&mut self, ring: usize, h: f64) {
        for contact in &mut self.contacts {
            let at = contact.vertex as usize;
            if self.ring[at] <= ring {
                let (x, v) = (self.positions.get(at), self.velocities.get(at));
                let force = contact.update_force(x, v, 1.0 / self.inverse_mass[PAD + at], h);
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

    /// Adds membrane and bending to the gradient, then v = ((1 - c h/2) v + h a) / (1 + c h/2) with drag c,
    /// x = x + `drift` v, for all vertices up to a ring; clears the gradient for the next substep.
    #[inline(always)]
    fn kick_and_drift<S: Simd>(&mut self, simd: S, ring: usize, substeps: Substeps, drift: f64) {
        let half = 0.5 * substeps.drag * substeps.h;
        let (decay, gain) = ((1.0 - half) / (1.0 + half), substeps.h / (1.0 + half));
        let gravity = substeps.gravity.scaled(gain).coordinates();
        let drift = F64s::splat(simd, drift);
        let x = self.positions.axes();
        let (v, g) = (self.velocities.axes_mut(), self.gradient.axes_mut());
        let next_x = self.next_positions.axes_mut();
        for &group in &self.groups[ring] {
            for lane_group in 0..lane_groups::<S>() {
                let at = lane_group_start::<S>(group as usize, lane_group);
                let force = self.forces.gradient(simd, group as usize, lane_group, x);
                let gravity_factor = load(simd, &self.gravity_factor, at);
                let gain = -gain * load(simd, &self.inverse_mass, at);
                for axis in 0..3 {
                    let force = force.0[axis] + load(simd, g[axis], at);
                    let v_new = load(simd, v[axis], at) * decay;
                    let v_new = F64s::splat(simd, gravity[axis]).mul_add(gravity_factor, v_new);
                    let v_new = gain.mul_add(force, v_new);
                    store(v[axis], at, v_new);
                    let x_new = v_new.mul_add(drift, load(simd, x[axis], at));
                    store(next_x[axis], at, x_new);
                    store(g[axis], at, F64s::splat(simd, 0.0));
                }
            }
        }
        std::mem::swap(&mut self.positions, &mut self.next_positions);
    }
}

impl Forces {
    /// Cost of the loads of a substep, in loads of a run.
    fn cost(&self) -> usize {
        4 * self.bending.cost() + self.membrane.cost()
    }

    /// The gradient of membrane and bending energy at the vertices of one lane group (N).
    #[inline(always)]
    fn gradient<S: Simd>(
        &self,
        simd: S,
        group: usize,
        lane_group: usize,
        x: [&[f64]; 3],
    ) -> Triple<F64s<S>> {
        let bending = self.bending.product_points(simd, group, lane_group, x);
        bending + self.membrane.gradient(simd, group, lane_group, x)
    }
}

/// The rows of the bending matrix for some vertices; `local` gives the index in the patch of a vertex of the
/// model. A row with an entry outside the patch is left empty.
///
/// The rounded matrix is symmetric, which conserves momentum, and its rows sum to zero, so that a translation
/// of the cloth has no bending force.
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

/// The largest and smallest of two pairs (largest, smallest); NaN in either pair gives NaN.
pub fn merge_extremes([largest, smallest]: [f64; 2], [high, low]: [f64; 2]) -> [f64; 2] {
    let nan = largest.is_nan() || smallest.is_nan();
    [
        if high <= largest || nan {
            largest
        } else {
            high
        },
        if low >= smallest || nan {
            smallest
        } else {
            low
        },
    ]
}

/// Some vertices with a halo of `rings` rings: each vertex with its ring, in the order of the model.
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
            let corners = system.topology.corners_of(v).iter();
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

struct Advance<'a> {
    patch: &'a mut Patch,
    substeps: Substeps,
}

impl pulp::WithSimd for Advance<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let (patch, substeps) = (self.patch, self.substeps);
        let outermost = patch.groups.len() - 1;
        patch.drift(simd, 0.5 * substeps.h);
        for remaining in (0..substeps.count).rev() {
            let ring = remaining.min(outermost);
            let drift = if remaining == 0 {
                0.5 * substeps.h
            } else {
                substeps.h
            };
            patch
                .forces
                .membrane
                .update_strains(simd, ring, &patch.positions);
            patch.forces.membrane.update_tensions(simd, ring);
            patch.add_contacts(ring, substeps.h);
            patch.add_elastics();
            patch.kick_and_drift(simd, ring, substeps, drift);
        }
    }
}

struct MeasureStretch<'a> {
    patch: &'a mut Patch,
}

impl pulp::WithSimd for MeasureStretch<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let patch = self.patch;
        patch.stretch = patch.forces.membrane.stretch(simd, &patch.positions);
    }
}

struct MeasureEnergy<'a> {
    patch: &'a mut Patch,
}

impl pulp::WithSimd for MeasureEnergy<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let patch = self.patch;
        patch.energy = patch.forces.membrane.energy(simd, &patch.positions);
        let x = patch.positions.axes();
        for &group in &patch.groups[0] {
            for lane_group in 0..lane_groups::<S>() {
                let at = lane_group_start::<S>(group as usize, lane_group);
                let bending =
                    patch
                        .forces
                        .bending
                        .product_points(simd, group as usize, lane_group, x);
                for (axis, bending) in patch.gradient.axes_mut().into_iter().zip(bending.0) {
                    store(axis, at, bending);
                }
            }
        }
        for at in 0..patch.vertices.len() {
            if patch.ring[at] == 0 {
                let v = patch.velocities.get(at);
                if patch.gravity_factor[PAD + at] > 0.0 {
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
