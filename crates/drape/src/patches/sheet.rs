//! The cloth as the method works on it: what is worked out once for a model, and the moving parts.

use super::Lane;
use super::limits;
use super::patch::{Course, Patch, wider};
use super::touch::{Touch, Touching};
use crate::methods::damped_contact_frequency;
use crate::{Attachments, Model, State, System};
use rayon::prelude::*;
use toile_geometry::Vec3;

/// Rings of a patch's halo, two edges wide each: it lasts as many substeps.
const RINGS: usize = 4;

/// The same for a small cloth, of which a wide halo would be a large part.
const FEW_RINGS: usize = 2;

/// Vertices below which a cloth is small.
const SMALL: usize = 2500;

/// Vertices from which on a cloth is cut into patches: below, the halo and waking a second core cost
/// more than it brings (a hung square of 1089 takes 1.9 ms a frame whole and 2.4 in two).
const CUT_FROM: usize = 2000;

/// Vertices of a patch at the most: two megabytes of positions, velocities and triangles.
const PATCH: usize = 12_000;

/// Vertices taken back by one task.
const UNLOADED: usize = 2048;

/// A cloth cut into patches.
pub struct Sheet {
    /// Largest frequency while no triangle is strained [rad/s].
    pub frequency: f64,
    key: Key,
    patches: Vec<Patch>,
    /// The patch that owns each vertex, and its place there.
    home: Vec<[u32; 2]>,
    /// Width of their halos.
    rings: usize,
    touch: Touch,
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
    /// A sheet for a model, cut as suits two cores.
    pub fn new(system: &System) -> Self {
        let count = match system.vertex_count() {
            // An elastic between two vertices may cross from any patch to any other.
            n if n < CUT_FROM || !system.couplings.all.is_empty() => 1,
            n => n.div_ceil(PATCH).max(2),
        };
        Self::cut_into(system, count)
    }

    /// A sheet of `count` patches.
    fn cut_into(system: &System, count: usize) -> Self {
        let rings = match count {
            1 => 0,
            _ if system.vertex_count() < SMALL => FEW_RINGS,
            _ => RINGS,
        };
        let mut patches: Vec<Patch> = cut(system, count)
            .into_par_iter()
            .map(|owned| Patch::new(system, owned, rings))
            .collect();
        let mut looked_at = vec![false; system.vertex_count()];
        for v in patches.iter().flat_map(|patch| patch.halo()) {
            looked_at[v as usize] = true;
        }
        for patch in &mut patches {
            patch.share(|v| looked_at[v as usize]);
        }
        let mut home = vec![[0; 2]; system.vertex_count()];
        for (patch, number) in patches.iter().zip(0..) {
            for (v, at) in patch.owned() {
                home[v as usize] = [number, at];
            }
        }
        let mut sheet = Self {
            frequency: 0.0,
            key: Key {
                model: system.model.clone(),
                attachments: system.control.attachments.clone(),
            },
            patches,
            home,
            rings,
            touch: Touch::default(),
            positions: Vec::new(),
            velocities: Vec::new(),
            saved: Saved::default(),
        };
        sheet.start(
            system,
            &State::at_rest(system, system.topology.layout.clone()),
        );
        let inner = limits::frequency_at_rest(system, sheet.stretch());
        sheet.frequency = inner.hypot(damped_contact_frequency(system, &system.rest.samples));
        sheet
    }

    /// Whether it is a sheet of this model still.
    pub fn fits(&self, system: &System) -> bool {
        let key = &self.key;
        key.model.has_cloth_of(system)
            && key.model.has_couplings_of(system)
            && key.model.contact == system.contact
            && key.model.colliders.is_empty() == system.colliders.is_empty()
            && key.attachments.is(&system.control.attachments)
    }

    /// Takes over a state.
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
        self.touch.start(system, state);
        let time = self.touch.interval;
        (self.touch).look(system, &self.positions, &self.velocities, time);
    }

    /// Gives every patch its part.
    fn load(&mut self) {
        let (positions, velocities) = (&self.positions, &self.velocities);
        let patches = self.patches.par_iter_mut();
        patches.for_each(|patch| patch.load(positions, velocities));
    }

    /// Hands the state over.
    pub fn finish(&self, state: &mut State) {
        let vector = |&l: &Lane| Vec3::from(l);
        state.positions.clear();
        state.positions.extend(self.positions.iter().map(vector));
        state.velocities.clear();
        state.velocities.extend(self.velocities.iter().map(vector));
        self.touch.finish(state);
    }

    /// Keeps the present state to come back to.
    pub fn save(&mut self) {
        self.saved.positions.clone_from(&self.positions);
        self.saved.velocities.clone_from(&self.velocities);
        self.touch.remember(&mut self.saved.contacts);
    }

    /// Comes back to the state kept.
    pub fn restore(&mut self) {
        self.positions.clone_from(&self.saved.positions);
        self.velocities.clone_from(&self.saved.velocities);
        self.touch.recall(&self.saved.contacts);
        self.load();
    }

    /// Moves on by `count` substeps of `h` [s].
    pub fn advance(&mut self, system: &System, h: f64, count: usize) {
        let most = match self.patches.len() {
            1 => count,
            _ => self.rings,
        };
        let touches = !system.colliders.is_empty();
        // Substeps until the next look.
        let mut seen = if touches { 0 } else { count };
        let mut left = count;
        while left > 0 {
            let looks = seen == 0;
            if looks {
                let substeps = |touch: &Touch| ((touch.interval / h) as usize).clamp(1, left);
                seen = substeps(&self.touch);
                let (x, v) = (&self.positions, &self.velocities);
                self.touch.look(system, x, v, h * seen as f64);
                // What was found may ask for the next look sooner.
                seen = seen.min(substeps(&self.touch));
            }
            let now = seen.min(most);
            left -= now;
            seen -= now;
            let course = Course {
                h,
                count: now,
                gravity: system.control.gravity.into(),
                drag: system.control.air_drag,
            };
            self.on_patches(|patch, touching| {
                match looks {
                    true => patch.load_contacts(touching),
                    false => patch.renew_contacts(touching),
                }
                patch.advance(course);
            });
            // All are looked at for contact, and at the end.
            match seen == 0 {
                true => self.unload(),
                false => self.unload_borders(),
            }
        }
    }

    /// Takes back all vertices and contacts.
    fn unload(&mut self) {
        let patches = &self.patches;
        let all = (&mut self.positions, &mut self.velocities, &self.home).into_par_iter();
        all.with_min_len(UNLOADED)
            .for_each(|(x, v, &[patch, at])| (*x, *v) = patches[patch as usize].vertex(at));
        for contact in patches.iter().flat_map(Patch::own_contacts) {
            self.touch.take_back(contact);
        }
    }

    /// Takes back what patches look at of one another.
    fn unload_borders(&mut self) {
        for patch in &self.patches {
            patch.unload_border(&mut self.positions, &mut self.velocities);
            for contact in patch.border_contacts() {
                self.touch.show(contact);
            }
        }
    }

    /// Lets every patch work on its part of the cloth.
    fn on_patches(&mut self, work: impl Fn(&mut Patch, &[Touching]) + Sync) {
        let (positions, velocities) = (&self.positions, &self.velocities);
        let touching = &self.touch.near;
        self.patches.par_iter_mut().for_each(|patch| {
            patch.load_halo(positions, velocities);
            work(patch, touching);
        });
    }

    /// Largest and smallest principal squared stretch; the largest is 1 or more, the smallest 1 or
    /// less, and both are no numbers where a place is none.
    pub fn stretch(&mut self) -> [f64; 2] {
        self.on_patches(|patch, _| patch.measure_stretch());
        let patches = self.patches.iter();
        patches.fold([1.0; 2], |most, patch| wider(most, patch.stretch))
    }

    /// Energy of motion, strain, elastics and contact [J].
    pub fn energy(&mut self) -> f64 {
        self.on_patches(|patch, _| patch.measure_energy());
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
        let to_places = self.key.attachments.all().iter().map(|one| {
            let from = self.positions[one.vertex as usize];
            one.law.energy(from.minus(one.place.into()).into())
        });
        let elastics = between.chain(to_places);
        own + self.touch.energy(&self.positions) + elastics.sum::<f64>()
    }

    /// The fastest vertex and its speed [m/s]; one whose speed is no number before all.
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

/// Cuts a cloth into `count` sets of nearly equal size: the next slices along the longest axis, or
/// in the order of the vertices where that severs hardly more triangles, since it leaves whole
/// rows of a grid in one patch. Within a set the vertices keep their order.
fn cut(system: &System, count: usize) -> Vec<Vec<u32>> {
    let in_turn: Vec<u32> = (0..system.vertex_count() as u32).collect();
    let size = in_turn.len().div_ceil(count).max(1);
    let bounds = system
        .topology
        .layout
        .iter()
        .fold(None, |bounds: Option<(Vec3, Vec3)>, p| {
            Some(bounds.map_or((*p, *p), |(low, high)| (low.inf(p), high.sup(p))))
        });
    let axis = bounds.map_or(0, |(low, high)| (high - low).imax());
    let key = |v: u32| system.topology.layout[v as usize][axis];
    let mut along = in_turn.clone();
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
    let order = match 4 * severed(&in_turn) <= 5 * severed(&along) {
        true => in_turn,
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
    use crate::SystemBuilder;
    use crate::{Cloth, Collider, Material};
    use std::sync::Arc;
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
            // Patches meet between looks, too.
            sheet.advance(&system, 1e-4, 50);
            sheet
        };
        let (whole, cut) = (run(1), run(4));
        assert_eq!(cut.patches.len(), 4);
        assert!(whole.touch.near.len() > 100);
        // Sums in another order: rounding, grown by the motion.
        for (a, b) in whole.positions.iter().zip(&cut.positions) {
            let off = (Vec3::from(*a) - Vec3::from(*b)).norm();
            assert!(off < 1e-10, "{off:e}");
        }
    }

    #[test]
    fn looks_are_nearer_where_cloth_slides_over_what_is_curved() {
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
            assert_eq!(sheet.touch.interval, 5e-4, "nothing is known yet");
            let (mut longest, mut pressed) = (0.0f64, false);
            for _ in 0..8 {
                sheet.advance(&system, 1e-4, 10);
                pressed |= sheet.touch.near.iter().any(Touching::presses);
                longest = longest.max(sheet.touch.interval);
            }
            assert!(pressed);
            assert_eq!(longest, expected, "{curved}");
        }
    }

    #[test]
    fn a_halo_holds_all_that_forces_look_at() {
        // At the corners of a square cut crosswise bending looks three edges far.
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
            // As after a checkpoint: nothing but the state remembers.
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
    fn what_is_no_number_is_seen_wherever_it_stands() {
        let (system, mut state) = falling();
        let mut sheet = Sheet::cut_into(&system, 3);
        for at in [0, 300, 624] {
            let kept = std::mem::replace(&mut state.positions[at].y, f64::NAN);
            sheet.start(&system, &state);
            let found = sheet.stretch();
            assert!(found.iter().all(|stretch| stretch.is_nan()), "{at}");
            state.positions[at].y = kept;
        }
    }

    #[test]
    fn what_blew_up_leaves_nothing_behind_when_it_is_undone() {
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
