//! Contact of cloth with cloth in substeps: detected once in a few substeps, with fixed contact planes in between.

use super::contact::{ContactConstraint, ContactStencil, compliance_of};
use super::{Xpbd, XpbdReport, middle};
use crate::collision::{
    Ahead, ClothContact, ContactDetector, ContactFrictionState, ContactSet, FeaturePair,
    ImpactStats, Motions, Reach,
};
use crate::{DrapeError, State, System};
use rayon::prelude::*;
use toile_geometry::Vec3;

/// Some substeps of one size.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Substeps {
    /// Substep (s).
    pub substep: f64,
    /// Number of substeps.
    pub count: u32,
    /// Drag per mass (1/s).
    pub drag: f64,
}

/// Largest displacement of a vertex or surface, at its present speed, between two detections (m). Detection reaches
/// twice as far beyond the offset, for two features that approach each other.
const MAX_TRAVEL: f64 = 2e-3;

/// Least displacement that is assumed of any vertex (m): one at rest may be pushed by another.
const MIN_TRAVEL: f64 = 5e-4;

/// Largest relative displacement of the two sides of a loaded contact between two detections (m), since its plane is
/// fixed meanwhile; and the quantile of loaded contacts that has to satisfy it.
const MAX_SLIP: f64 = 3e-4;
const SLIP_QUANTILE: f64 = 0.9;

/// Longest time between two detections (s).
const MAX_INTERVAL: f64 = 1.0 / 60.0;

/// Least number of substeps between two detections, and the same for tangled cloth, whose recovery directions change
/// faster.
const MIN_SUBSTEPS: u32 = 5;
const MIN_SUBSTEPS_TANGLED: u32 = 4;

/// The contacts of cloth with cloth detected last, and the time for which they are valid.
#[derive(Clone, Debug, Default)]
pub(crate) struct ClothContacts {
    /// The contacts.
    pub contacts: ContactSet,
    detector: ContactDetector,
    /// Time until the next detection (s); none where contacts have to be detected first.
    valid_for: Option<f64>,
    /// Positions before the last substeps (m), displacements in them (m), and inverse masses (1/kg).
    before: Vec<Vec3>,
    displacements: Vec<Vec3>,
    inverse_masses: Vec<f64>,
}

impl ClothContacts {
    /// Marks the contacts as invalid: they are detected again at the next step.
    pub fn invalidate(&mut self) {
        self.valid_for = None;
    }

    /// [`Self::invalidate`], and clears the detector, so that the next detection does not depend on earlier ones.
    pub fn reset(&mut self) {
        self.invalidate();
        self.detector.forget();
    }

    /// Least number of substeps before the next detection.
    fn min_substeps(&self) -> u32 {
        match self.contacts.is_in_order() {
            true => MIN_SUBSTEPS,
            false => MIN_SUBSTEPS_TANGLED,
        }
    }

    /// Detects the contacts and sets the time for which they are valid: at least a few substeps of `substep` (s). Solids
    /// move at `surface_speed` (m/s) at most.
    fn detect(&mut self, system: &System, state: &mut State, substep: f64, surface_speed: f64) {
        let offset = system.contact.cloth_offset;
        let min_time = f64::from(MIN_SUBSTEPS) * substep;
        let speed = largest_speed(system, state, min_time).max(surface_speed);
        let travel_time = (MAX_TRAVEL / speed).min(MAX_INTERVAL);
        let longest = travel_time.max(min_time);
        let fall = 0.5 * system.control.gravity.norm() * longest * longest;
        let reach = Reach {
            max: offset + 2.0 * MAX_TRAVEL,
            ahead: Some(Ahead {
                velocities: &state.velocities,
                offset,
                pinned: &system.prescribed.pinned,
                time: longest,
                min_path: (speed * longest + fall).clamp(MIN_TRAVEL, MAX_TRAVEL),
            }),
        };
        let (memory, x) = (&state.cloth, &state.positions);
        (self.detector).detect(system, memory, x, &reach, &mut self.contacts);
        self.contacts.remember_crossings(state);
        let slip_time = MAX_SLIP / self.slip_speed(&state.velocities);
        let min_time = f64::from(self.min_substeps()) * substep;
        self.valid_for = Some(travel_time.min(slip_time).max(min_time));
    }

    /// The quantile [`SLIP_QUANTILE`] of the relative speeds of the two sides of loaded contacts and recovery
    /// forces (m/s).
    fn slip_speed(&self, velocities: &[Vec3]) -> f64 {
        let speed = |contact: &ClothContact| {
            let corners = contact.vertices.iter().zip(contact.weights);
            let velocity: Vec3 = corners.map(|(&v, w)| velocities[v as usize] * w).sum();
            velocity.norm()
        };
        let ContactSet {
            contacts, recovery, ..
        } = &self.contacts;
        let contacts = contacts.par_iter().chain(&recovery.pulls);
        let contacts = contacts.with_min_len(256);
        let loaded = contacts.filter(|contact| contact.plane.depth > 0.0);
        let mut speeds: Vec<f64> = loaded.map(speed).collect();
        let at = (SLIP_QUANTILE * speeds.len() as f64) as usize;
        match speeds.is_empty() {
            true => 0.0,
            false => *speeds.select_nth_unstable_by(at, f64::total_cmp).1,
        }
    }

    /// Corrects the displacements of the last substeps, of `span` (s), where cloth would have passed through cloth
    /// (continuous collision detection).
    fn resolve_impacts(&mut self, system: &System, state: &mut State, span: f64) {
        let displacements = state.positions.iter().zip(&self.before);
        self.displacements.clear();
        self.displacements
            .extend(displacements.map(|(x, from)| x - from));
        let masses = system.rest.mass.iter().zip(&system.prescribed.pinned);
        self.inverse_masses.clear();
        self.inverse_masses
            .extend(masses.map(|(m, &pinned)| if pinned { 0.0 } else { 1.0 / m }));
        let mut motion = Motions {
            x: &self.before,
            moves: &mut self.displacements,
            velocities: &mut state.velocities,
            inverse_mass: &self.inverse_masses,
            span,
        };
        let exemptions = &self.contacts.exemptions;
        let impacts = (self.detector).resolve_impacts(system, exemptions, &mut motion);
        self.contacts.tally.count_impacts(impacts);
        if impacts != ImpactStats::default() {
            let ends = self.before.iter().zip(&self.displacements);
            for (x, (from, displacement)) in state.positions.iter_mut().zip(ends) {
                *x = from + displacement;
            }
        }
    }
}

/// The largest speed of a vertex or of a prescribed vertex (m/s); those of prescribed motions are means over the next
/// `min_time` (s) and over the longest interval between detections.
fn largest_speed(system: &System, state: &State, min_time: f64) -> f64 {
    let of_cloth = state.velocities.iter().map(Vec3::norm);
    let spans = [min_time, MAX_INTERVAL].into_iter();
    let prescribed = spans.flat_map(|span| {
        system.prescribed.led.iter().map(move |grip| {
            let to = grip.motion.pose(state.time + span).apply(grip.home);
            (to - state.positions[grip.vertex as usize]).norm() / span
        })
    });
    of_cloth.chain(prescribed).fold(0.0, f64::max)
}

/// Height of a face's rim over the plane of another face, in offsets, up to which the vertex that the plane keeps away
/// keeps clear of the rim too.
const RIM_HEIGHT: f64 = 0.1;

/// Whether each contact, in order of features, is needless: of a vertex beside a face on whose rim it does not press,
/// where the plane of a face below it keeps it from that rim. Its own plane, fixed until the next detection, is tilted
/// toward the rim, and cloth that slides would run into it.
fn needless(contacts: &[ClothContact]) -> Vec<bool> {
    let vertex = |contact: &ClothContact| match contact.pair {
        Some(FeaturePair::VertexFace([v, ..])) => Some(v),
        _ => None,
    };
    let mut needless = Vec::with_capacity(contacts.len());
    for group in contacts.chunk_by(|a, b| vertex(a).is_some() && vertex(a) == vertex(b)) {
        let is_inside = |contact: &&ClothContact| !contact.weights.contains(&0.0);
        let inside = || group.iter().filter(is_inside);
        let keeps = |a: &ClothContact, b: &ClothContact| {
            let offset = a.plane.depth + a.plane.normal.dot(&a.plane.point);
            let height = a.plane.normal.dot(&(a.plane.point - b.plane.point));
            height <= RIM_HEIGHT * offset
        };
        needless.extend(group.iter().map(|contact| {
            let is_beside = vertex(contact).is_some() && !is_inside(&contact);
            is_beside && contact.plane.depth <= 0.0 && inside().any(|below| keeps(below, contact))
        }));
    }
    needless
}

/// The number of substeps until the next detection, of `remaining` ones, when contacts are valid for `valid_for`
/// substeps: at least `fewest`, and such that the remaining substeps are divided evenly.
fn substeps_before_detection(remaining: u32, valid_for: f64, fewest: u32) -> u32 {
    let valid_for = (valid_for + 1e-6).floor().max(f64::from(fewest));
    let detections = (f64::from(remaining) / valid_for).ceil().max(1.0);
    let count = (f64::from(remaining) / detections).ceil() as u32;
    count.max(fewest).min(remaining)
}

impl Xpbd {
    /// [`Xpbd::advance`] with contact of cloth with cloth, where the model has it.
    pub(crate) fn advance_with_cloth_contact(
        &mut self,
        system: &System,
        state: &mut State,
        cloth: &mut ClothContacts,
        substeps: &Substeps,
    ) -> Result<XpbdReport, DrapeError> {
        if system.contact.cloth_offset <= 0.0 {
            cloth.invalidate();
            return self.advance(
                system,
                state,
                substeps.substep,
                substeps.count,
                substeps.drag,
            );
        }
        if self.rebuild_if_changed(system, &state.samples) {
            // The constraints of the present contacts are gone.
            cloth.invalidate();
        }
        let origin = middle(&state.positions);
        let mut report = XpbdReport::default();
        let mut pieces = 1;
        let parts: Vec<Substeps> = self.parts(system, state.time, substeps).collect();
        for (number, part) in parts.iter().enumerate() {
            self.place_solids(system, state, (&parts, number));
            report = self.advance_part(system, state, cloth, (origin, part))?;
            pieces = pieces.max(report.pieces);
        }
        report.pieces = pieces;
        Ok(report)
    }

    /// Advances by substeps in which solids move straight on, with coordinates relative to `origin` (m).
    fn advance_part(
        &mut self,
        system: &System,
        state: &mut State,
        cloth: &mut ClothContacts,
        (origin, substeps): (Vec3, &Substeps),
    ) -> Result<XpbdReport, DrapeError> {
        let mut remaining = substeps.count;
        let mut report = XpbdReport::default();
        let mut pieces = 1;
        while remaining > 0 {
            let min_time = f64::from(cloth.min_substeps()) * substeps.substep;
            if cloth.valid_for.is_none_or(|time| time < min_time) {
                cloth.detect(system, state, substeps.substep, self.moving.speed());
                self.set_cloth_contacts(&cloth.contacts);
            }
            let valid_for = cloth.valid_for.map_or(0.0, |time| time / substeps.substep);
            let count = substeps_before_detection(remaining, valid_for, cloth.min_substeps());
            cloth.before.clone_from(&state.positions);
            let run = Substeps { count, ..*substeps };
            report = self.advance_about(system, state, origin, &run)?;
            self.store_cloth_friction(&cloth.contacts, state);
            let time = run.substep * f64::from(count);
            cloth.resolve_impacts(system, state, time);
            pieces = pieces.max(report.pieces);
            cloth.valid_for = cloth.valid_for.map(|left| left - time);
            remaining -= count;
        }
        report.pieces = pieces;
        Ok(report)
    }

    /// Replaces the constraints of contacts of cloth with cloth.
    fn set_cloth_contacts(&mut self, contacts: &ContactSet) {
        let slot_of = &self.partition.slot_of;
        let slots = |contact: &ClothContact| contact.vertices.map(|v| slot_of[v as usize]);
        let stencil = |&(contact, number): &(&ClothContact, u32), start: u32| {
            let (plane, law) = (&contact.plane, &contact.law);
            let slip = plane.point - plane.anchor;
            let slip = slip - plane.normal * slip.dot(&plane.normal);
            ContactStencil {
                vertices: slots(contact).map(|slot| slot - start),
                weights: contact.weights.map(|w| w as f32),
                constraint: ContactConstraint {
                    normal: [0, 1, 2].map(|k| plane.normal[k] as f32),
                    level: (plane.depth + plane.normal.dot(&plane.point)) as f32,
                    compliance: compliance_of(law.normal),
                    tangential_compliance: compliance_of(law.tangential),
                    hard_from: law.hard_from as f32,
                    friction: law.friction as f32,
                    slip: [0, 1, 2].map(|k| slip[k] as f32),
                    ..ContactConstraint::none()
                },
                begun_at: [0.0; 3],
                number,
                restitution: contact.restitution.map(|e| e as f32),
            }
        };
        let needless = needless(&contacts.contacts);
        let constraints = contacts.all().zip(0..);
        let constraints =
            constraints.filter(|&(_, number)| needless.get(number as usize) != Some(&true));
        let constraints: Vec<(&ClothContact, u32)> = constraints.collect();
        self.regions.replace(
            &self.partition,
            &constraints,
            |(contact, _)| slots(contact),
            (stencil, |region| &mut region.cloth),
        );
    }

    /// Stores the friction of cloth with cloth in a state with the positions of the particles.
    fn store_cloth_friction(&self, contacts: &ContactSet, state: &mut State) {
        let kappa = self.kappa;
        let stencils = self.regions.all().flat_map(|region| &region.cloth);
        let pressing = stencils.filter(|stencil| stencil.constraint.lambda_normal > 0.0);
        let found = pressing.filter_map(
            |ContactStencil {
                 constraint, number, ..
             }| {
                Some(ContactFrictionState {
                    pair: contacts.contacts.get(*number as usize)?.pair?,
                    slip: Vec3::from(constraint.slip.map(f64::from)),
                    force: kappa * f64::from(constraint.lambda_normal),
                })
            },
        );
        state.cloth.friction.clear();
        state.cloth.friction.extend(found);
        (state.cloth.friction).sort_unstable_by_key(|friction| friction.pair);
        state.cloth.positions.clone_from(&state.positions);
    }
}

#[cfg(test)]
mod tests {
    use super::super::XpbdSettings;
    use super::*;
    use crate::SystemBuilder;
    use crate::{Cloth, Material};
    use toile_geometry::TriangleMesh;

    /// A sheet of 60 by 60 cells of 10 mm in pleats 2.5 mm apart, and a flat one on it: more vertices than a
    /// domain holds.
    fn pleats_under_a_sheet() -> (System, State) {
        let mut mesh = TriangleMesh::default();
        for flat in [false, true] {
            let first = mesh.positions.len() as u32;
            for i in 0..=60u32 {
                for j in 0..=60u32 {
                    let (pleat, along) = (i / 5, 0.01 * f64::from(i % 5));
                    let up = if pleat % 2 == 0 { along } else { 0.04 - along };
                    let folded = [2.5e-3 * f64::from(pleat), up];
                    let [x, y] = match flat {
                        true => [0.01 * f64::from(i), 0.0425],
                        false => folded,
                    };
                    mesh.positions.push(Vec3::new(x, y, 0.01 * f64::from(j)));
                }
            }
            for i in 0..60 {
                for j in 0..60 {
                    let a = first + 61 * i + j;
                    mesh.triangles.push([a, a + 61, a + 1]);
                    mesh.triangles.push([a + 1, a + 61, a + 62]);
                }
            }
        }
        let cloth = Cloth::from_mesh("pleats", &mesh, Material::default()).expect("a cloth");
        let mut builder = SystemBuilder::new("pleats", &cloth).expect("a model");
        builder.contact.cloth_offset = 3e-3;
        let system = builder.build();
        let state = State::at_rest(&system, mesh.positions);
        (system, state)
    }

    #[test]
    fn cloth_contacts_in_every_kind_of_partition_give_the_same_bytes_at_any_number_of_threads() {
        let (system, start) = pleats_under_a_sheet();
        let substeps = Substeps {
            substep: 1.0 / 1200.0,
            count: 10,
            drag: 0.1,
        };
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            pool.build().expect("threads").install(|| {
                let settings = XpbdSettings {
                    iterations: 2,
                    ..XpbdSettings::default()
                };
                let mut solver = Xpbd::with_settings(&system, settings);
                let (mut state, mut cloth) = (start.clone(), ClothContacts::default());
                solver
                    .advance_with_cloth_contact(&system, &mut state, &mut cloth, &substeps)
                    .expect("sound");
                let count = |region: &super::super::region::Region| region.cloth.len();
                let regions = &solver.regions;
                let domains: Vec<usize> = regions.domains.iter().map(count).collect();
                let cuts: Vec<usize> = regions.cuts.iter().map(count).collect();
                let global = count(&regions.global);
                assert!(
                    domains.iter().sum::<usize>() > 0 && cuts[0] > 0 && global > 0,
                    "{domains:?} {cuts:?} {global}"
                );
                let found = cloth.contacts.all().count();
                let all = domains.iter().chain(&cuts).sum::<usize>() + global;
                let needless = needless(&cloth.contacts.contacts);
                let needless = needless.iter().filter(|&&needless| needless).count();
                assert_eq!(all, found - needless);
                state
            })
        };
        let (one, three) = (run(1), run(3));
        assert!(one.positions == three.positions && one.velocities == three.velocities);
        assert!(one.positions != start.positions);
    }

    /// Contacts of a vertex 2.5 mm over a flat square, of which it has two triangles or that alone that is not below the
    /// vertex; the offset is 2 mm. How many on a rim are needless, and how many are not.
    fn on_rims(has_face_below: bool) -> [usize; 2] {
        let mut mesh = TriangleMesh::default();
        let square = [[0.0, 0.0], [0.004, 0.0], [0.0, 0.004], [0.004, 0.004]];
        (mesh.positions).extend(square.map(|[x, z]| Vec3::new(x, 0.0, z)));
        let above = [[0.001, 0.001], [0.2, 0.0], [0.0, 0.2]];
        (mesh.positions)
            .extend(above.map(|[x, z]| Vec3::new(x, 0.0025 + 2.0 * (x + z - 0.002), z)));
        mesh.triangles.extend([[1, 2, 3], [4, 6, 5]]);
        if has_face_below {
            mesh.triangles.push([0, 2, 1]);
        }
        let cloth = Cloth::from_mesh("beside", &mesh, Material::default()).expect("a cloth");
        let mut builder = SystemBuilder::new("beside", &cloth).expect("a model");
        builder.contact.cloth_offset = 2e-3;
        let system = builder.build();
        let mut state = State::at_rest(&system, mesh.positions);
        let mut cloth = ClothContacts::default();
        cloth.detect(&system, &mut state, 1.0 / 2400.0, 0.0);
        let contacts = &cloth.contacts.contacts;
        let needless = needless(contacts);
        let of_vertex = contacts.iter().zip(&needless).filter(|(contact, _)| {
            matches!(contact.pair, Some(FeaturePair::VertexFace([4, ..])))
                && contact.weights.contains(&0.0)
        });
        let [dropped, all] = of_vertex.fold([0, 0], |[dropped, all], (_, &needless)| {
            [dropped + usize::from(needless), all + 1]
        });
        [dropped, all - dropped]
    }

    #[test]
    fn a_rim_is_needless_where_the_face_before_it_keeps_the_vertex_from_it() {
        assert_eq!(on_rims(true), [1, 0]);
        assert_eq!(on_rims(false), [0, 1]);
    }

    #[test]
    fn substeps_are_divided_evenly_between_detections() {
        for remaining in 1..=200 {
            for valid_for in [
                0.0,
                1.0,
                4.9,
                5.0,
                6.5,
                19.999_999_9,
                48.1,
                1e9,
                f64::INFINITY,
                f64::NAN,
            ] {
                let (mut rest, mut pieces) = (remaining, Vec::new());
                while rest > 0 {
                    pieces.push(substeps_before_detection(rest, valid_for, MIN_SUBSTEPS));
                    rest -= pieces[pieces.len() - 1];
                }
                let (last, before) = pieces.split_last().expect("one at the least");
                let longest = f64::from(MIN_SUBSTEPS).max(valid_for + 1e-3);
                assert!(
                    pieces.iter().all(|&n| n > 0 && f64::from(n) <= longest),
                    "{remaining} {valid_for}"
                );
                assert!(
                    before.iter().all(|&n| n >= MIN_SUBSTEPS && n >= *last),
                    "{remaining} {valid_for}"
                );
            }
        }
        assert_eq!(
            substeps_before_detection(20, 20.0 * (1.0 - 1e-12), MIN_SUBSTEPS),
            20
        );
        assert_eq!(substeps_before_detection(40, 26.6, MIN_SUBSTEPS), 20);
        assert_eq!(substeps_before_detection(20, 0.0, MIN_SUBSTEPS_TANGLED), 4);
    }
}
