//! Contact of cloth with cloth in substeps: found once in a few of them, kept as planes meanwhile.

use super::contact::{ContactConstraint, ContactStencil};
use super::{Xpbd, XpbdReport, middle};
use crate::collision::{
    Ahead, ClothContact, ContactDetector, ContactSet, ImpactStats, Motions, Reach,
};
use crate::laws::contact::HARDER;
use crate::{DrapeError, State, System};
use rayon::prelude::*;
use toile_geometry::Vec3;

/// Some substeps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    /// Substep [s].
    pub substep: f64,
    /// How many.
    pub count: u32,
    /// Drag per mass [1/s].
    pub drag: f64,
}

/// How far the fastest vertex or surface is to go, at the speed that it has, before contacts are looked for
/// anew [m]. Features that both go so far are found before they come as near as is kept.
const FARTHEST: f64 = 2e-3;

/// How far each is taken to go at the least [m]: what moves pushes what does not.
const LEAST_WAY: f64 = 5e-4;

/// How far those that press may move against each other meanwhile [m], and what share of them counts: their
/// planes stay as they were found.
const SHIFTS: f64 = 3e-4;
const SHIFTING: f64 = 0.9;

/// Longest time that contacts serve [s].
const LONGEST: f64 = 1.0 / 60.0;

/// Substeps between two looks, at the least; and where cloth crosses cloth, whose way out is to be found soon.
const FEWEST: u32 = 5;
const FEWEST_CROSSED: u32 = 4;

/// Contacts of cloth with cloth as they were last found.
#[derive(Clone, Debug, Default)]
pub(crate) struct ClothWatch {
    /// The contacts.
    pub contacts: ContactSet,
    detector: ContactDetector,
    /// For how long they are to serve yet [s]; none before the first look.
    serves: Option<f64>,
    /// Positions before the last substeps [m], and how far they went.
    before: Vec<Vec3>,
    moves: Vec<Vec3>,
    inverse_mass: Vec<f64>,
}

impl ClothWatch {
    /// Looks anew at the next step.
    pub fn forget(&mut self) {
        self.serves = None;
    }

    /// [`Self::forget`], and the search then depends on none before.
    pub fn forget_all(&mut self) {
        self.forget();
        self.detector.forget();
    }

    /// Substeps before the next look, at the least.
    fn fewest(&self) -> u32 {
        match self.contacts.is_in_order() {
            true => FEWEST,
            false => FEWEST_CROSSED,
        }
    }

    /// Looks for contacts, which are to serve for a few substeps of so many seconds at the least.
    fn look(&mut self, system: &System, state: &mut State, substep: f64) {
        let offset = system.contact.cloth_offset;
        let least = f64::from(FEWEST) * substep;
        let speed = fastest(system, state, least);
        let soon = (FARTHEST / speed).min(LONGEST);
        let longest = soon.max(least);
        let fall = 0.5 * system.control.gravity.norm() * longest * longest;
        let reach = Reach {
            max: offset + 2.0 * FARTHEST,
            ahead: Some(Ahead {
                velocities: &state.velocities,
                offset,
                pinned: &system.prescribed.pinned,
                time: longest,
                min_path: (speed * longest + fall).clamp(LEAST_WAY, FARTHEST),
            }),
        };
        let (memory, x) = (&state.cloth, &state.positions);
        (self.detector).detect(system, memory, x, &reach, &mut self.contacts);
        self.contacts.remember_crossings(state);
        let shifts = SHIFTS / self.shifting(&state.velocities);
        let least = f64::from(self.fewest()) * substep;
        self.serves = Some(soon.min(shifts).max(least));
    }

    /// Speed that most contacts which press, or pull out of a crossing, are slower than [m/s], one side seen
    /// from the other.
    fn shifting(&self, velocities: &[Vec3]) -> f64 {
        let speed = |contact: &ClothContact| {
            let four = contact.vertices.iter().zip(contact.weights);
            let velocity: Vec3 = four.map(|(&v, w)| velocities[v as usize] * w).sum();
            velocity.norm()
        };
        let ContactSet {
            contacts, recovery, ..
        } = &self.contacts;
        let contacts = contacts.par_iter().chain(&recovery.pulls);
        let contacts = contacts.with_min_len(256);
        let pressed = contacts.filter(|contact| contact.plane.depth > 0.0);
        let mut speeds: Vec<f64> = pressed.map(speed).collect();
        let at = (SHIFTING * speeds.len() as f64) as usize;
        match speeds.is_empty() {
            true => 0.0,
            false => *speeds.select_nth_unstable_by(at, f64::total_cmp).1,
        }
    }

    /// Corrects the way of the last substeps, `span` [s] long, where cloth would have passed through cloth.
    fn keep_apart(&mut self, system: &System, state: &mut State, span: f64) {
        let ways = state.positions.iter().zip(&self.before);
        self.moves.clear();
        self.moves.extend(ways.map(|(x, from)| x - from));
        let masses = system.rest.mass.iter().zip(&system.prescribed.pinned);
        self.inverse_mass.clear();
        self.inverse_mass
            .extend(masses.map(|(m, &pinned)| if pinned { 0.0 } else { 1.0 / m }));
        let mut motion = Motions {
            x: &self.before,
            moves: &mut self.moves,
            velocities: &mut state.velocities,
            inverse_mass: &self.inverse_mass,
            span,
        };
        let exemptions = &self.contacts.exemptions;
        let impacts = (self.detector).resolve_impacts(system, exemptions, &mut motion);
        self.contacts.tally.count_impacts(impacts);
        if impacts != ImpactStats::default() {
            let ends = self.before.iter().zip(&self.moves);
            for (x, (from, way)) in state.positions.iter_mut().zip(ends) {
                *x = from + way;
            }
        }
    }
}

/// Speed of what is fastest [m/s]: a vertex, one that is led, or a surface, in the next `soon` seconds or as
/// long as contacts may serve.
fn fastest(system: &System, state: &State, soon: f64) -> f64 {
    let of_cloth = state.velocities.iter().map(Vec3::norm);
    let spans = [soon, LONGEST].into_iter();
    let led = spans.flat_map(|span| {
        let times = [state.time, state.time + span];
        let of_bodies = system.colliders.iter().filter_map(move |collider| {
            let [from, to] = times.map(|time| collider.pose(time));
            Some(collider.travel(&from?, &to?) / span)
        });
        let of_grips = system.prescribed.led.iter().map(move |grip| {
            let to = grip.motion.pose(times[1]).apply(grip.home);
            (to - state.positions[grip.vertex as usize]).norm() / span
        });
        of_bodies.chain(of_grips)
    });
    of_cloth.chain(led).fold(0.0, f64::max)
}

/// How many of the substeps that are left go before the next look when contacts serve for so many, and so few
/// at the least: shared out evenly.
fn before_next(left: u32, serves: f64, fewest: u32) -> u32 {
    let serves = (serves + 1e-6).floor().max(f64::from(fewest));
    let looks = (f64::from(left) / serves).ceil().max(1.0);
    let count = (f64::from(left) / looks).ceil() as u32;
    count.max(fewest).min(left)
}

impl Xpbd {
    /// [`Xpbd::advance`] with contact of cloth with cloth, where the model has it.
    pub(crate) fn advance_touching(
        &mut self,
        system: &System,
        state: &mut State,
        watch: &mut ClothWatch,
        span: &Span,
    ) -> Result<XpbdReport, DrapeError> {
        if system.contact.cloth_offset <= 0.0 {
            watch.forget();
            return self.advance(system, state, span.substep, span.count, span.drag);
        }
        if self.take_up(system, &state.samples) {
            // The contacts in hand are gone.
            watch.forget();
        }
        let origin = middle(&state.positions);
        self.invalidate_surfaces();
        let mut left = span.count;
        let mut report = XpbdReport::default();
        let mut pieces = 1;
        while left > 0 {
            let least = f64::from(watch.fewest()) * span.substep;
            if watch.serves.is_none_or(|serves| serves < least) {
                watch.look(system, state, span.substep);
                self.set_cloth_contacts(&watch.contacts, 2.0 * FARTHEST);
            }
            let serves = watch.serves.map_or(0.0, |serves| serves / span.substep);
            let count = before_next(left, serves, watch.fewest());
            watch.before.clone_from(&state.positions);
            report = self.advance_about(system, state, origin, &Span { count, ..*span })?;
            let time = span.substep * f64::from(count);
            watch.keep_apart(system, state, time);
            pieces = pieces.max(report.pieces);
            watch.serves = watch.serves.map(|serves| serves - time);
            left -= count;
        }
        report.pieces = pieces;
        Ok(report)
    }

    /// Holds contacts of cloth with cloth from here on, in place of those held before: those that may give
    /// way to their hard depth before the next look, `way` [m] ahead, as two.
    fn set_cloth_contacts(&mut self, contacts: &ContactSet, way: f64) {
        let slot_of = &self.partition.slot_of;
        let slots = |contact: &ClothContact| contact.vertices.map(|v| slot_of[v as usize]);
        let stencil = |&(contact, is_hard): &(&ClothContact, bool), start: u32| {
            let (plane, law) = (&contact.plane, &contact.law);
            let (depth, stiffness) = match is_hard {
                true => (plane.depth - law.hard_from, HARDER * law.normal),
                false => (plane.depth, law.normal),
            };
            ContactStencil {
                vertices: slots(contact).map(|slot| slot - start),
                weights: contact.weights.map(|w| w as f32),
                constraint: ContactConstraint {
                    normal: [0, 1, 2].map(|k| plane.normal[k] as f32),
                    level: (depth + plane.normal.dot(&plane.point)) as f32,
                    compliance: (1.0 / stiffness).min(1e30) as f32,
                    friction: law.friction as f32,
                    ..ContactConstraint::none()
                },
                restitution: contact.restitution.map(|e| e as f32),
            }
        };
        let each = contacts.all().flat_map(|contact| {
            let hard = contact.plane.depth + way > contact.law.hard_from;
            std::iter::once((contact, false)).chain(hard.then_some((contact, true)))
        });
        let each: Vec<(&ClothContact, bool)> = each.collect();
        self.regions.set_cloth_contacts(
            &self.partition,
            &each,
            |(contact, _)| slots(contact),
            stencil,
        );
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
    fn contacts_in_domains_across_cuts_and_alone_give_the_same_bytes_at_any_number_of_threads() {
        let (system, start) = pleats_under_a_sheet();
        let span = Span {
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
                let (mut state, mut watch) = (start.clone(), ClothWatch::default());
                solver
                    .advance_touching(&system, &mut state, &mut watch, &span)
                    .expect("sound");
                let held = |region: &super::super::region::Region| region.cloth.len();
                let regions = &solver.regions;
                let domains: Vec<usize> = regions.domains.iter().map(held).collect();
                let cuts: Vec<usize> = regions.cuts.iter().map(held).collect();
                let alone = held(&regions.global);
                assert!(
                    domains.iter().sum::<usize>() > 0 && cuts[0] > 0 && alone > 0,
                    "{domains:?} {cuts:?} {alone}"
                );
                let found = watch.contacts.all().count();
                let all = domains.iter().chain(&cuts).sum::<usize>() + alone;
                assert!((found..=2 * found).contains(&all), "{all} of {found}");
                state
            })
        };
        let (one, three) = (run(1), run(3));
        assert!(one.positions == three.positions && one.velocities == three.velocities);
        assert!(one.positions != start.positions);
    }

    #[test]
    fn substeps_are_shared_out_between_looks() {
        for left in 1..=200 {
            for serves in [
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
                let (mut rest, mut pieces) = (left, Vec::new());
                while rest > 0 {
                    pieces.push(before_next(rest, serves, FEWEST));
                    rest -= pieces[pieces.len() - 1];
                }
                let (last, before) = pieces.split_last().expect("one at the least");
                let most = f64::from(FEWEST).max(serves + 1e-3);
                assert!(
                    pieces.iter().all(|&n| n > 0 && f64::from(n) <= most),
                    "{left} {serves}"
                );
                assert!(
                    before.iter().all(|&n| n >= FEWEST && n >= *last),
                    "{left} {serves}"
                );
            }
        }
        assert_eq!(before_next(20, 20.0 * (1.0 - 1e-12), FEWEST), 20);
        assert_eq!(before_next(40, 26.6, FEWEST), 20);
        assert_eq!(before_next(20, 0.0, FEWEST_CROSSED), 4);
    }
}
