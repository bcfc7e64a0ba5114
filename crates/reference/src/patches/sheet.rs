//! The cloth cut into patches: patches, contacts and frequency built once for a model, and the state.

use super::Lane;
use super::limits;
use super::patch::{Patch, Substeps, merge_extremes};
use super::patch_contacts::{PatchContact, PatchContacts};
use rayon::prelude::*;
use toile_drape::methods::damped_contact_frequency;
use toile_drape::{Attachments, Model, State, System};
use toile_geometry::Vec3;

/// Rings of a patch's halo, each two edges wide: patches exchange halos after as many substeps.
const HALO_RINGS: usize = 4;

/// Rings of the halo in a small cloth, whose patches are hardly larger than a wide halo.
const SMALL_CLOTH_HALO_RINGS: usize = 2;

/// A cloth of fewer vertices has the smaller halo.
const SMALL_CLOTH: usize = 2500;

/// A cloth of fewer vertices is one patch: halo and synchronisation cost more than a second core saves (a hung
/// square of 1089 takes 1.9 ms a frame as one patch and 2.4 as two).
const MIN_VERTICES_TO_CUT: usize = 2000;

/// Largest number of vertices of a patch: two megabytes of positions, velocities and triangles, which fit the
/// cache of a core.
const MAX_PATCH_VERTICES: usize = 12_000;

/// Vertices of one task that copies from the patches.
const UNLOAD_CHUNK: usize = 2048;

/// A cloth cut into patches.
pub struct Sheet {
    /// Largest frequency while no triangle is strained (rad/s).
    pub frequency: f64,
    key: Key,
    patches: Vec<Patch>,
    /// For each vertex the patch that owns it and its index there.
    owner: Vec<[u32; 2]>,
    /// Rings of their halos.
    rings: usize,
    contacts: PatchContacts,
    positions: Vec<Lane>,
    velocities: Vec<Lane>,
    saved: Saved,
}

/// The model and the attachments that a sheet was made from.
struct Key {
    model: Model,
    attachments: Attachments,
}

#[derive(Default)]
struct Saved {
    positions: Vec<Lane>,
    velocities: Vec<Lane>,
    contacts: Vec<(Lane, f64, bool)>,
}

impl Sheet {
    /// A sheet for a model: one patch, or at least two of up to 12,000 vertices.
    pub fn new(system: &System) -> Self {
        let count = match system.vertex_count() {
            // An elastic between two vertices may cross from any patch to any other.
            n if n < MIN_VERTICES_TO_CUT || !system.couplings.all.is_empty() => 1,
            n => n.div_ceil(MAX_PATCH_VERTICES).max(2),
        };
        Self::cut_into(system, count)
    }

    /// A sheet of `count` patches.
    fn cut_into(system: &System, count: usize) -> Self {
        let rings = match count {
            1 => 0,
            _ if system.vertex_count() < SMALL_CLOTH => SMALL_CLOTH_HALO_RINGS,
            _ => HALO_RINGS,
        };
        let mut patches: Vec<Patch> = cut(system, count)
            .into_par_iter()
            .map(|owned| Patch::new(system, owned, rings))
            .collect();
        let mut is_in_halo = vec![false; system.vertex_count()];
        for v in patches.iter().flat_map(|patch| patch.halo()) {
            is_in_halo[v as usize] = true;
        }
        for patch in &mut patches {
            patch.set_border(|v| is_in_halo[v as usize]);
        }
        let mut owner = vec![[0; 2]; system.vertex_count()];
        for (patch, number) in patches.iter().zip(0..) {
            for (v, at) in patch.owned() {
                owner[v as usize] = [number, at];
            }
        }
        let mut sheet = Self {
            frequency: 0.0,
            key: Key {
                model: system.model.clone(),
                attachments: system.control.attachments.clone(),
            },
            patches,
            owner,
            rings,
            contacts: PatchContacts::default(),
            positions: Vec::new(),
            velocities: Vec::new(),
            saved: Saved::default(),
        };
        sheet.start(
            system,
            &State::at_rest(system, system.topology.layout.clone()),
        );
        let elastic = limits::frequency_at_rest(system, sheet.stretch());
        sheet.frequency = elastic.hypot(damped_contact_frequency(system, &system.rest.samples));
        sheet
    }

    /// Whether it was built from a model with the same cloth, couplings, contact and attachments.
    pub fn fits(&self, system: &System) -> bool {
        let key = &self.key;
        key.model.has_cloth_of(system)
            && key.model.has_couplings_of(system)
            && key.model.contact == system.contact
            && key.model.colliders.is_empty() == system.colliders.is_empty()
            && key.attachments.is(&system.control.attachments)
    }

    /// Loads a state and detects its contacts.
    pub fn start(&mut self, system: &System, state: &State) {
        self.positions.clear();
        self.positions
            .extend(state.positions.iter().map(|&p| Lane::from(p)));
        self.velocities.clear();
        let velocities = state.velocities.iter().zip(&system.prescribed.pinned);
        self.velocities.extend(
            velocities.map(|(v, &pinned)| if pinned { Lane::default() } else { (*v).into() }),
        );
        self.load();
        self.contacts.start(system, state);
        let time = self.contacts.interval;
        (self.contacts).detect(system, &self.positions, &self.velocities, time);
    }

    /// Loads positions and velocities into every patch.
    fn load(&mut self) {
        let (positions, velocities) = (&self.positions, &self.velocities);
        let patches = self.patches.par_iter_mut();
        patches.for_each(|patch| patch.load(positions, velocities));
    }

    /// Stores positions, velocities and friction in a state.
    pub fn finish(&self, state: &mut State) {
        let vector = |&l: &Lane| Vec3::from(l);
        state.positions.clear();
        state.positions.extend(self.positions.iter().map(vector));
        state.velocities.clear();
        state.velocities.extend(self.velocities.iter().map(vector));
        self.contacts.finish(state);
    }

    /// Saves the present state for [`Self::restore`].
    pub fn save(&mut self) {
        self.saved.positions.clone_from(&self.positions);
        self.saved.velocities.clone_from(&self.velocities);
        self.contacts.save(&mut self.saved.contacts);
    }

    /// Restores the state saved last.
    pub fn restore(&mut self) {
        self.positions.clone_from(&self.saved.positions);
        self.velocities.clone_from(&self.saved.velocities);
        self.contacts.restore(&self.saved.contacts);
        self.load();
    }

    /// Advances by `count` substeps of `h` (s).
    pub fn advance(&mut self, system: &System, h: f64, count: usize) {
        let between_exchanges = match self.patches.len() {
            1 => count,
            _ => self.rings,
        };
        let has_solids = !system.colliders.is_empty();
        // Substeps until the next detection of contacts.
        let mut until_detection = if has_solids { 0 } else { count };
        let mut remaining = count;
        while remaining > 0 {
            let detects = until_detection == 0;
            if detects {
                let substeps = |contacts: &PatchContacts| {
                    ((contacts.interval / h) as usize).clamp(1, remaining)
                };
                until_detection = substeps(&self.contacts);
                let (x, v) = (&self.positions, &self.velocities);
                self.contacts
                    .detect(system, x, v, h * until_detection as f64);
                // The detection may have shortened its interval.
                until_detection = until_detection.min(substeps(&self.contacts));
            }
            let run = until_detection.min(between_exchanges);
            remaining -= run;
            until_detection -= run;
            let substeps = Substeps {
                h,
                count: run,
                gravity: system.control.gravity.into(),
                drag: system.control.air_drag,
            };
            self.for_patches(|patch, near| {
                match detects {
                    true => patch.load_contacts(near),
                    false => patch.refresh_halo_contacts(near),
                }
                patch.advance(substeps);
            });
            // A detection needs all vertices, and so does the caller at the end.
            match until_detection == 0 {
                true => self.unload(),
                false => self.unload_borders(),
            }
        }
    }

    /// Copies all vertices and contacts from the patches.
    fn unload(&mut self) {
        let patches = &self.patches;
        let vertices = (&mut self.positions, &mut self.velocities, &self.owner).into_par_iter();
        vertices
            .with_min_len(UNLOAD_CHUNK)
            .for_each(|(x, v, &[patch, at])| (*x, *v) = patches[patch as usize].vertex(at));
        for contact in patches.iter().flat_map(Patch::own_contacts) {
            self.contacts.store(contact);
        }
    }

    /// Copies border vertices and their contacts from the patches, for the halos of the others.
    fn unload_borders(&mut self) {
        for patch in &self.patches {
            patch.unload_border(&mut self.positions, &mut self.velocities);
            for contact in patch.border_contacts() {
                self.contacts.store_near(contact);
            }
        }
    }

    /// Loads the halo of every patch and then runs `work` on it, with the near contacts.
    fn for_patches(&mut self, work: impl Fn(&mut Patch, &[PatchContact]) + Sync) {
        let (positions, velocities) = (&self.positions, &self.velocities);
        let near = &self.contacts.near;
        self.patches.par_iter_mut().for_each(|patch| {
            patch.load_halo(positions, velocities);
            work(patch, near);
        });
    }

    /// Largest and smallest principal squared stretch (1); the largest is at least 1, the smallest at most 1,
    /// and both are NaN where a position is.
    pub fn stretch(&mut self) -> [f64; 2] {
        self.for_patches(|patch, _| patch.measure_stretch());
        let patches = self.patches.iter();
        patches.fold([1.0; 2], |extremes, patch| {
            merge_extremes(extremes, patch.stretch)
        })
    }

    /// Energy of motion, strain, elastics and contact (J).
    pub fn energy(&mut self) -> f64 {
        self.for_patches(|patch, _| patch.measure_energy());
        let own: f64 = self.patches.iter().map(|patch| patch.energy).sum();
        let between = self
            .key
            .model
            .couplings
            .all
            .iter()
            .map(|&([from, to], law)| {
                let [from, to] = [from, to].map(|v| self.positions[v as usize]);
                law.energy(from.minus(to).into())
            });
        let to_points = self.key.attachments.all().iter().map(|one| {
            let from = self.positions[one.vertex as usize];
            one.law.energy(from.minus(one.place.into()).into())
        });
        let elastics = between.chain(to_points);
        own + self.contacts.energy(&self.positions) + elastics.sum::<f64>()
    }

    /// The fastest vertex and its speed (m/s); the first one whose speed is NaN, if any.
    pub fn fastest(&self) -> (usize, f64) {
        let mut best = (0, 0.0);
        for (at, v) in self.velocities.iter().enumerate() {
            let squared = Vec3::from(*v).norm_squared();
            if squared.is_nan() {
                return (at, f64::NAN);
            }
            if squared > best.1 {
                best = (at, squared);
            }
        }
        (best.0, best.1.sqrt())
    }
}

/// Cuts a cloth into `count` sets of nearly equal size: slices along the longest axis of the layout, or slices of
/// the order of the model where that severs at most a quarter more triangles, since it leaves whole rows of a
/// grid in one patch. The vertices of a set are in the order of the model.
fn cut(system: &System, count: usize) -> Vec<Vec<u32>> {
    let in_model_order: Vec<u32> = (0..system.vertex_count() as u32).collect();
    let size = in_model_order.len().div_ceil(count).max(1);
    let bounds = system
        .topology
        .layout
        .iter()
        .fold(None, |bounds: Option<(Vec3, Vec3)>, p| {
            Some(bounds.map_or((*p, *p), |(low, high)| (low.inf(p), high.sup(p))))
        });
    let axis = bounds.map_or(0, |(low, high)| (high - low).imax());
    let key = |v: u32| system.topology.layout[v as usize][axis];
    let mut along = in_model_order.clone();
    along.sort_by(|&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
    let severed = |order: &[u32]| {
        let mut slice = vec![0; order.len()];
        for (at, &v) in order.iter().enumerate() {
            slice[v as usize] = at / size;
        }
        let corners = system
            .topology
            .triangles
            .iter()
            .map(|t| t.map(|v| slice[v as usize]));
        corners.filter(|[a, b, c]| a != b || a != c).count()
    };
    let order = match 4 * severed(&in_model_order) <= 5 * severed(&along) {
        true => in_model_order,
        false => along,
    };
    let sorted = |slice: &[u32]| {
        let mut slice = slice.to_vec();
        slice.sort_unstable();
        slice
    };
    order.chunks(size).map(sorted).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use toile_drape::SystemBuilder;
    use toile_drape::{Cloth, Collider, Material};
    use toile_geometry::{SurfaceTree, TriangleMesh};

    fn grid(side: u32, size: f64, height: f64) -> TriangleMesh {
        let mut mesh = TriangleMesh::default();
        for j in 0..=side {
            for i in 0..=side {
                let [x, z] = [i, j].map(|k| size * (f64::from(k) / f64::from(side) - 0.5));
                mesh.positions.push(Vec3::new(x, height, z));
            }
        }
        for j in 0..side {
            for i in 0..side {
                let a = j * (side + 1) + i;
                let (b, c, d) = (a + 1, a + side + 2, a + side + 1);
                mesh.triangles.extend([[a, c, b], [a, d, c]]);
            }
        }
        mesh
    }

    /// A cloth that falls onto a floor, one corner held, with drag.
    fn falling() -> (System, State) {
        let mesh = grid(24, 0.24, 0.0055);
        let material = Material {
            stretch: [60.0, 50.0],
            shear: 15.0,
            ..Material::default()
        };
        let cloth = Cloth::from_mesh("cloth", &mesh, material).unwrap();
        let mut builder = SystemBuilder::new("cloth", &cloth).unwrap();
        builder.pinned[0] = true;
        builder.control.air_drag = 0.5;
        let floor = SurfaceTree::new(grid(4, 2.0, 0.0));
        builder.colliders.push(Collider::new(Arc::new(floor)));
        let system = builder.build();
        let mut state = State::at_rest(&system, mesh.positions.clone());
        for (k, x) in state.positions.iter_mut().enumerate() {
            x.y += 1e-3 * (0.7 * k as f64).sin();
        }
        state.velocities.fill(Vec3::new(0.2, -0.3, 0.1));
        (system, state)
    }

    #[test]
    fn patches_together_move_as_one() {
        let (system, state) = falling();
        let run = |count: usize| {
            let mut sheet = Sheet::cut_into(&system, count);
            sheet.start(&system, &state);
            // Patches exchange halos between detections, too.
            sheet.advance(&system, 1e-4, 50);
            sheet
        };
        let (whole, cut) = (run(1), run(4));
        assert_eq!(cut.patches.len(), 4);
        assert!(whole.contacts.near.len() > 100);
        // The sums are in another order: rounding errors, amplified by the motion.
        for (a, b) in whole.positions.iter().zip(&cut.positions) {
            let off = (Vec3::from(*a) - Vec3::from(*b)).norm();
            assert!(off < 1e-10, "{off:e}");
        }
    }

    #[test]
    fn detection_is_more_frequent_where_cloth_slides_over_a_curved_surface() {
        for (curved, expected) in [(0.0, 1e-3), (50.0, 5e-4)] {
            let (mut system, mut state) = falling();
            system = system.with(|builder| {
                builder.pinned[0] = false;
            });
            let mut floor = grid(200, 0.4, 0.0);
            for x in state.positions.iter_mut().chain(&mut floor.positions) {
                x.y -= 0.5 * curved * x.x * x.x;
            }
            state.velocities.fill(Vec3::new(2.0, -0.5, 0.0));
            system = system.with(|builder| {
                builder.colliders = vec![Collider::new(Arc::new(SurfaceTree::new(floor)))];
            });
            let mut sheet = Sheet::cut_into(&system, 2);
            sheet.start(&system, &state);
            assert_eq!(sheet.contacts.interval, 5e-4, "before the first detection");
            let (mut longest, mut pressed) = (0.0f64, false);
            for _ in 0..8 {
                sheet.advance(&system, 1e-4, 10);
                pressed |= sheet.contacts.near.iter().any(PatchContact::is_pressed);
                longest = longest.max(sheet.contacts.interval);
            }
            assert!(pressed);
            assert_eq!(longest, expected, "{curved}");
        }
    }

    #[test]
    fn a_halo_contains_the_stencils_of_all_forces() {
        // With alternating diagonals a bending row reaches over three edges.
        let mut mesh = grid(16, 0.16, 0.0);
        for (quad, pair) in mesh.triangles.chunks_exact_mut(2).enumerate() {
            if (quad % 16 + quad / 16) % 2 == 1 {
                let ([a, c, b], d) = (pair[0], pair[1][1]);
                (pair[0], pair[1]) = ([a, d, b], [b, d, c]);
            }
        }
        let cloth = Cloth::from_mesh("cloth", &mesh, Material::default()).unwrap();
        let mut builder = SystemBuilder::new("cloth", &cloth).unwrap();
        builder.pinned[0] = true;
        let system = builder.build();
        let mut state = State::at_rest(&system, mesh.positions.clone());
        for (k, x) in state.positions.iter_mut().enumerate() {
            x.y += 1e-3 * (0.7 * k as f64).sin();
        }
        let run = |count: usize| {
            let mut sheet = Sheet::cut_into(&system, count);
            let h = 0.5 / sheet.frequency;
            sheet.start(&system, &state);
            for _ in 0..3 {
                sheet.advance(&system, h, 8);
            }
            sheet.positions
        };
        for (a, b) in run(1).iter().zip(&run(5)) {
            let off = (Vec3::from(*a) - Vec3::from(*b)).norm();
            assert!(off < 1e-10, "{off:e}");
        }
    }

    #[test]
    fn cloth_that_a_surface_was_put_over_is_not_thrown() {
        let (mut system, mut state) = falling();
        system = system.with(|builder| {
            builder.pinned[0] = false;
        });
        system.control.air_drag = 0.0;
        for (x, v) in state.positions.iter_mut().zip(&mut state.velocities) {
            (x.y, *v) = (-0.02, Vec3::zeros());
        }
        let mut highest = f64::MIN;
        let mut sheet = Sheet::cut_into(&system, 2);
        for _ in 0..40 {
            // As after a checkpoint: the state is all that is carried over.
            sheet.start(&system, &state);
            sheet.advance(&system, 1e-4, 50);
            sheet.finish(&mut state);
            let top = state.positions.iter().map(|x| x.y).fold(f64::MIN, f64::max);
            highest = highest.max(top);
        }
        // 4 mm above the surface at 1 m/s, and a little more by the membrane.
        assert!((0.0..0.12).contains(&highest), "{highest}");
    }

    #[test]
    fn a_nan_position_is_reported_at_any_vertex() {
        let (system, mut state) = falling();
        let mut sheet = Sheet::cut_into(&system, 3);
        for at in [0, 300, 624] {
            let saved = std::mem::replace(&mut state.positions[at].y, f64::NAN);
            sheet.start(&system, &state);
            let found = sheet.stretch();
            assert!(found.iter().all(|stretch| stretch.is_nan()), "{at}");
            state.positions[at].y = saved;
        }
    }

    #[test]
    fn restoring_after_a_blow_up_leaves_no_trace_of_it() {
        let (system, state) = falling();
        let run = |blow_up: bool| {
            let mut sheet = Sheet::cut_into(&system, 3);
            sheet.start(&system, &state);
            sheet.save();
            if blow_up {
                sheet.advance(&system, 1.0, 400);
                assert!(sheet.fastest().1.is_nan());
                assert!(sheet.stretch().iter().all(|stretch| stretch.is_nan()));
            }
            sheet.restore();
            sheet.advance(&system, 2e-4, 25);
            sheet.positions
        };
        assert!(run(true) == run(false));
    }

    #[test]
    fn energy_is_kept_for_long() {
        let (mut system, mut state) = falling();
        system = system.with(|builder| builder.colliders.clear());
        system.control.air_drag = 0.0;
        system.control.gravity = Vec3::zeros();
        state.velocities[24] = Vec3::new(0.5, 1.0, 0.2);
        let mut sheet = Sheet::cut_into(&system, 2);
        sheet.start(&system, &state);
        let before = sheet.energy();
        let h = 0.5 * 2.0 / sheet.frequency;
        let mut worst = 0.0f64;
        for _ in 0..40 {
            sheet.advance(&system, h, 500);
            let now = sheet.energy();
            worst = worst.max((now / before - 1.0).abs());
        }
        assert!(worst < 0.02, "{worst}");
    }

    #[test]
    fn another_model_needs_another_sheet() {
        let (system, _) = falling();
        let sheet = Sheet::new(&system);
        assert!(sheet.fits(&system));
        let other = system.with(|builder| builder.pinned[3] = true);
        assert!(!sheet.fits(&other));
    }
}
