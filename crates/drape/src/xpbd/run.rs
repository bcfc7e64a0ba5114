//! Substeps: free motion, constraints, contact, velocities, each shared between cores.

use super::bending::{BendingForce, Filter};
use super::bounce::{BounceStep, bounce};
use super::contact::Solid;
use super::domains::{Of, Swept, for_domains};
use super::particles::{
    Bend, Bound, Free, MotionStep, Particles, Predict, RunStage, Settle, Stage,
};
use super::region::{Regions, SweepStep};
use crate::ContactSample;
use crate::Pose;

/// What substeps of one size share.
pub struct Run<'a> {
    /// For constraints.
    pub sweep: SweepStep<'a>,
    /// For free motion.
    pub motion: MotionStep,
    /// Restitution, where any cloth bounces.
    pub bounces: Option<BounceStep>,
    /// K.
    pub bending: &'a BendingForce,
    /// How its force is filtered; none where bending is constraints.
    pub filter: Option<&'a Filter>,
    /// Time when the first substep begins [s].
    pub time: f64,
    /// Sweeps a substep.
    pub iterations: u32,
    /// The contact samples of the state.
    pub samples: &'a [ContactSample],
    /// First slots of the domains, and the end.
    pub domain_starts: &'a [usize],
    /// First slots of what meets surfaces by itself, and the end.
    pub contact_starts: &'a [usize],
    /// First slots of the ranges about cuts, and the end.
    pub cut_starts: &'a [usize],
    /// The processor's vectors.
    pub arch: pulp::Arch,
}

impl Run<'_> {
    /// Takes some substeps.
    pub fn substeps(&self, regions: &mut Regions, particles: &mut Particles, count: u32) {
        let mut poses = Vec::new();
        self.look_ahead(particles);
        for number in 0..count {
            let travel = self.place_surfaces(number, &mut poses);
            let Solid { system, origin, .. } = self.sweep.solid;
            if !system.control.frames.is_empty() {
                let end = self.time + f64::from(self.motion.step) * f64::from(number + 1);
                regions.move_frames(system, origin, end);
            }
            let sweep = SweepStep {
                solid: Solid {
                    poses: &poses,
                    ..self.sweep.solid
                },
                ..self.sweep
            };
            if sweep.solid.has_surfaces() {
                for contact in &mut particles.contacts {
                    contact.clear();
                    if travel > 0.0 {
                        contact.expect_motion(travel);
                    }
                }
            }
            self.filter_bending(particles);
            for iteration in 0..self.iterations {
                let sweep = SweepStep {
                    begins: (iteration == 0).then_some(travel),
                    ..sweep
                };
                self.domains(regions, particles, &sweep, iteration == 0);
                self.cuts(regions, particles, &sweep);
                let Particles { start, now, .. } = &mut *particles;
                regions.global.sweep(&sweep, now, start);
                self.solve_contacts(particles, &sweep, iteration + 1 == self.iterations);
            }
            if let Some(step) = self.bounces {
                let domains = self.domain_starts.iter().zip(&regions.domains);
                let cuts = self.cut_starts.iter().zip(&regions.cuts);
                let runs = domains
                    .chain(cuts)
                    .chain(std::iter::once((&0, &regions.global)))
                    .flat_map(|(&first, region)| {
                        [&region.contacts, &region.cloth].map(|run| (first, &run[..]))
                    });
                bounce(self.samples, runs, particles, step);
                self.look_ahead(particles);
            }
        }
    }

    /// Says where bending is felt.
    fn look_ahead(&self, particles: &mut Particles) {
        let Particles {
            start,
            ahead,
            velocity,
            ..
        } = particles;
        self.motion.look_ahead(start, velocity, ahead);
    }

    /// Where moving surfaces stand before and after a substep; returns how far they move [m].
    fn place_surfaces(&self, number: u32, poses: &mut Vec<Option<[Pose; 2]>>) -> f32 {
        let colliders = &self.sweep.solid.system.colliders;
        poses.clear();
        if colliders.iter().all(|collider| collider.motion.is_none()) {
            return 0.0;
        }
        let step = f64::from(self.motion.step);
        let times = [0, 1].map(|k| self.time + step * f64::from(number + k));
        let mut travel = 0.0f64;
        for collider in colliders.iter() {
            let [from, to] = times.map(|time| collider.pose(time));
            let both = from.zip(to).map(|(from, to)| [from, to]);
            if let Some([from, to]) = &both {
                travel = travel.max(collider.travel(from, to));
            }
            poses.push(both);
        }
        travel as f32
    }

    /// Finds the moves of the bending filter, stage by stage.
    fn filter_bending(&self, particles: &mut Particles) {
        let stages = self.filter.map_or(&[][..], |filter| &filter.stages);
        let Particles {
            ahead, pull, bend, ..
        } = particles;
        let [mut moves, mut last] = bend.each_mut();
        for (stage, &numbers) in stages.iter().enumerate() {
            let known = (stage > 0).then_some(&last[..]);
            let all = Stage {
                pull: &mut pull[..],
                moves: &mut moves[..],
            };
            for_domains(self.domain_starts, 0, all, &|d, mut fields| {
                self.arch.dispatch(RunStage {
                    fields: &mut fields,
                    first: self.domain_starts[d],
                    ahead,
                    last: known,
                    force: self.bending,
                    numbers,
                    step2: self.motion.step * self.motion.step,
                });
            });
            std::mem::swap(&mut moves, &mut last);
        }
    }

    /// Free motion and the domains' own constraints, in one go.
    fn domains(
        &self,
        regions: &mut Regions,
        particles: &mut Particles,
        sweep: &SweepStep,
        first: bool,
    ) {
        let Particles {
            start,
            ahead,
            now,
            free,
            low,
            velocity,
            bend,
            ..
        } = particles;
        let regions = &mut regions.domains[..];
        if !first {
            let all = Swept {
                regions,
                now,
                start,
            };
            for_domains(self.domain_starts, 0, all, &|_, all| {
                all.regions[0].sweep(sweep, all.now, all.start);
            });
            return;
        }
        let bend = match self.filter {
            None => Bend::None,
            Some(filter) if filter.is_plain() => Bend::Force(self.bending, ahead),
            // Stages take turns in two places; the first one writes the first.
            Some(filter) => {
                let last = (filter.stages.len() + 1) % 2;
                Bend::Moves(&bend[last], filter.factor)
            }
        };
        let fields = Free {
            now,
            free,
            low,
            velocity,
        };
        for_domains(
            self.domain_starts,
            0,
            (fields, Of { regions }),
            &|d, (mut fields, own)| {
                let at = self.domain_starts[d];
                self.arch.dispatch(Predict {
                    fields: &mut fields,
                    first: at,
                    start,
                    bend,
                    step: &self.motion,
                });
                let end = at + fields.now.len();
                own.regions[0].sweep(sweep, fields.now, &start[at..end]);
            },
        );
    }

    /// Constraints across cuts.
    fn cuts(&self, regions: &mut Regions, particles: &mut Particles, sweep: &SweepStep) {
        let (Some(&from), Some(&to)) = (self.cut_starts.first(), self.cut_starts.last()) else {
            return;
        };
        let all = Swept {
            regions: &mut regions.cuts,
            now: &mut particles.now[from..to],
            start: &particles.start[from..to],
        };
        for_domains(self.cut_starts, 0, all, &|_, all| {
            all.regions[0].sweep(sweep, all.now, all.start);
        });
    }

    /// Contacts of vertices and, at the end of the substep, velocities.
    fn solve_contacts(&self, particles: &mut Particles, sweep: &SweepStep, last: bool) {
        let Particles {
            start,
            ahead,
            now,
            free,
            velocity,
            contacts,
            ..
        } = particles;
        let all = Bound {
            start,
            ahead,
            now,
            free,
            velocity,
            contacts,
        };
        let starts = match sweep.solid.has_surfaces() {
            true => self.contact_starts,
            false => self.domain_starts,
        };
        for_domains(starts, 0, all, &|_, mut fields| {
            self.arch.dispatch(Settle {
                fields: &mut fields,
                solid: sweep.solid.has_surfaces().then_some(sweep.solid),
                contact: &sweep.contact,
                finish: last.then_some(&self.motion),
            });
        });
    }
}
