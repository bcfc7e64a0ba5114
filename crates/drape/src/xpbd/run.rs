//! Substeps: prediction, constraints, contact, velocities, each in parallel over domains.
//!
//! # Decided with
//! - [`crate::xpbd::particles`]: free motion before constraints, velocities after them;
//! - [`crate::xpbd::vertex_partition`], [`crate::xpbd::domains`]: order of vertices, and domains that are
//!   solved at the same time;
//! - [`crate::xpbd::region::Region`], [`crate::xpbd::membrane`], [`crate::xpbd::bending`]: constraints of one
//!   domain: stretch and bending;
//! - [`crate::xpbd::contact`], [`crate::xpbd::contact_block`], [`crate::xpbd::several_solids`]: contact with
//!   solids: one vertex, sixteen at once, between several solids;
//! - [`crate::xpbd::cloth`], [`crate::xpbd::bounce`]: contact of cloth with cloth, restitution;
//! - [`crate::xpbd::attachment_constraint`], [`crate::xpbd::tie_constraint`]: elastics, attachments and ties;
//! - [`crate::xpbd::air`], [`crate::xpbd::viscosity`]: drag and viscosity as impulses;
//! - [`crate::lanes`], [`crate::lane_arithmetic`]: vectors of the processor's width.
//!
//! Patches, the other method that cuts a cloth into parts: `patches/sheet.rs`, `patches/edges.rs`,
//! `patches/octets.rs`. By hand: `contact_block` repeats the contact of `contact` for several vertices at
//! once.

use super::air::{AddAirImpulses, AirStep};
use super::bending::{BendingForce, Filter};
use super::bounce::{BounceStep, bounce};
use super::contact::Solid;
use super::domains::{RegionSlices, SweepSlices, for_domains};
use super::particles::{
    FilterSlices, FilterStage, FinishIteration, FinishSlices, FreeBending, MotionStep, Particles,
    Predict, PredictSlices,
};
use super::region::{Regions, SweepStep};
use super::triangle_sums::Ranges;
use super::viscosity::{AddViscousForces, Viscosity, ViscousStage};
use crate::ContactSample;
use crate::lanes::Point;

/// Parameters of substeps of one size.
pub struct Run<'a> {
    /// Parameters of sweeps over constraints.
    pub sweep: SweepStep<'a>,
    /// Parameters of free motion.
    pub motion: MotionStep,
    /// Parameters of restitution, where any material has it.
    pub bounces: Option<BounceStep>,
    /// The air, where it exerts a force on triangles.
    pub air: Option<AirStep>,
    /// The viscosity with its filter, where any material has it.
    pub viscosity: Option<(&'a Viscosity, &'a Filter)>,
    /// The bending matrix K.
    pub bending: &'a BendingForce,
    /// The filter of the bending force; none where bending is constraints.
    pub filter: Option<&'a Filter>,
    /// Time when the first substep begins (s).
    pub time: f64,
    /// Sweeps over all constraints in a substep.
    pub iterations: u32,
    /// The contact samples of the state.
    pub samples: &'a [ContactSample],
    /// First slots of the domains, and the end.
    pub domain_starts: &'a [usize],
    /// First slots of the ranges whose contacts with solids one task solves, and the end.
    pub contact_starts: &'a [usize],
    /// First slots of the ranges about cuts, and the end.
    pub cut_starts: &'a [usize],
    /// The instruction set for vectors.
    pub arch: pulp::Arch,
}

impl Run<'_> {
    /// Advances by `count` substeps.
    pub fn substeps(&self, regions: &mut Regions, particles: &mut Particles, count: u32) {
        self.extrapolate(particles);
        for number in 0..count {
            let Solid {
                system,
                origin,
                moving,
                ..
            } = self.sweep.solid;
            let step = f64::from(self.motion.step);
            let times = [number, number + 1].map(|k| self.time + step * f64::from(k));
            if !system.control.frames.is_empty() {
                regions.move_frames(system, origin, times[1]);
            }
            let sweep = SweepStep {
                solid: Solid {
                    shares: times.map(|time| moving.share(time)),
                    ..self.sweep.solid
                },
                ..self.sweep
            };
            if !system.control.ties.is_empty() {
                regions.follow_ties(&sweep.solid, times[1]);
            }
            if sweep.solid.has_surfaces() {
                for contact in &mut particles.contacts {
                    contact.clear();
                    contact.carry(&sweep.solid);
                }
            }
            self.damp(regions, particles);
            self.sum_air_impulses(regions, particles);
            self.filter_bending(particles);
            for iteration in 0..self.iterations {
                let sweep = SweepStep {
                    is_first: iteration == 0,
                    ..sweep
                };
                self.domains(regions, particles, &sweep, iteration == 0);
                self.cuts(regions, particles, &sweep);
                let Particles { start, now, .. } = &mut *particles;
                regions.global.sweep(&sweep, now, start);
                self.solve_skin(regions, now, &sweep);
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
                self.extrapolate(particles);
            }
        }
    }

    /// Extrapolates all positions by the lead of the bending force.
    fn extrapolate(&self, particles: &mut Particles) {
        let Particles {
            start,
            ahead,
            velocity,
            ..
        } = particles;
        self.motion.extrapolate(start, velocity, ahead);
    }

    /// The partitions of the vertices.
    fn ranges(&self) -> Ranges<'_> {
        Ranges {
            domains: self.domain_starts,
            cuts: self.cut_starts,
        }
    }

    /// Damps velocities by viscosity, stage by stage.
    fn damp(&self, regions: &Regions, particles: &mut Particles) {
        let Some((viscosity, filter)) = self.viscosity else {
            return;
        };
        let Particles {
            start,
            velocity,
            unfiltered: forces,
            filtered,
            ..
        } = particles;
        let [mut last, mut new] = filtered.each_mut();
        last.copy_from_slice(velocity);
        new.copy_from_slice(velocity);
        for &stage in &filter.stages {
            self.ranges().sum(regions, forces, |region, first, sums| {
                self.arch.dispatch(AddViscousForces {
                    viscosity,
                    membrane: &region.membrane,
                    bending: &region.viscous,
                    starts: &start[first..],
                    velocities: &last[first..],
                    sums,
                });
            });
            for_domains(self.domain_starts, 0, &mut new[..], &|d, new| {
                let first = self.domain_starts[d];
                let of_stage = ViscousStage {
                    unfiltered: &velocity[first..],
                    last: &last[first..],
                    new,
                    forces: &forces[first..],
                    starts: &start[first..],
                };
                of_stage.advance(stage, self.motion.step);
            });
            std::mem::swap(&mut last, &mut new);
        }
        for (v, damped) in velocity.iter_mut().zip(last) {
            for k in 0..3 {
                v[k] += filter.factor * (damped[k] - v[k]);
            }
        }
    }

    /// Sums the impulses of the air at every vertex.
    fn sum_air_impulses(&self, regions: &Regions, particles: &mut Particles) {
        let Some(air) = &self.air else {
            return particles.air_impulses.clear();
        };
        let Particles {
            start,
            velocity,
            air_impulses,
            ..
        } = particles;
        air_impulses.resize(start.len(), [0.0; 4]);
        self.ranges()
            .sum(regions, air_impulses, |region, first, sums| {
                self.arch.dispatch(AddAirImpulses {
                    batches: &region.membrane,
                    starts: &start[first..],
                    velocities: &velocity[first..],
                    sums,
                    air,
                });
            });
    }

    /// Computes the displacements of the bending filter, stage by stage.
    fn filter_bending(&self, particles: &mut Particles) {
        let stages = self.filter.map_or(&[][..], |filter| &filter.stages);
        let Particles {
            ahead,
            unfiltered,
            filtered,
            ..
        } = particles;
        let [mut current, mut last] = filtered.each_mut();
        for (stage, &coefficients) in stages.iter().enumerate() {
            let known = (stage > 0).then_some(&last[..]);
            let all = FilterSlices {
                unfiltered: &mut unfiltered[..],
                filtered: &mut current[..],
            };
            for_domains(self.domain_starts, 0, all, &|d, mut fields| {
                self.arch.dispatch(FilterStage {
                    fields: &mut fields,
                    first: self.domain_starts[d],
                    ahead,
                    last: known,
                    force: self.bending,
                    coefficients,
                    step2: self.motion.step * self.motion.step,
                });
            });
            std::mem::swap(&mut current, &mut last);
        }
    }

    /// Sweeps over the constraints within domains, in the first iteration together with the prediction.
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
            filtered,
            air_impulses,
            ..
        } = particles;
        let regions = &mut regions.domains[..];
        if !first {
            let all = SweepSlices {
                regions,
                now,
                start,
            };
            for_domains(self.domain_starts, 0, all, &|_, all| {
                all.regions[0].sweep(sweep, all.now, all.start);
            });
            return;
        }
        let bending = match self.filter {
            None => FreeBending::None,
            Some(filter) if filter.is_identity() => FreeBending::Force(self.bending, ahead),
            // Stages alternate between two arrays, beginning with the first.
            Some(filter) => {
                let last = (filter.stages.len() + 1) % 2;
                FreeBending::Filtered(&filtered[last], filter.factor)
            }
        };
        let fields = PredictSlices {
            now,
            free,
            low,
            velocity,
        };
        for_domains(
            self.domain_starts,
            0,
            (fields, RegionSlices { regions }),
            &|d, (mut fields, own)| {
                let at = self.domain_starts[d];
                self.arch.dispatch(Predict {
                    fields: &mut fields,
                    first: at,
                    start,
                    bending,
                    air_impulses,
                    step: &self.motion,
                });
                let end = at + fields.now.len();
                own.regions[0].sweep(sweep, fields.now, &start[at..end]);
            },
        );
    }

    /// Sweeps over the constraints across cuts.
    fn cuts(&self, regions: &mut Regions, particles: &mut Particles, sweep: &SweepStep) {
        let (Some(&from), Some(&to)) = (self.cut_starts.first(), self.cut_starts.last()) else {
            return;
        };
        let all = SweepSlices {
            regions: &mut regions.cuts,
            now: &mut particles.now[from..to],
            start: &particles.start[from..to],
        };
        for_domains(self.cut_starts, 0, all, &|_, all| {
            all.regions[0].sweep(sweep, all.now, all.start);
        });
    }

    /// Solves the contacts of vertices and edges of moving solids once more: what was solved after those of their region
    /// has pulled the cloth into them.
    fn solve_skin(&self, regions: &mut Regions, now: &mut [Point], sweep: &SweepStep) {
        let domains = self.domain_starts.iter().zip(&mut regions.domains);
        let cuts = self.cut_starts.iter().zip(&mut regions.cuts);
        for (&first, region) in domains.chain(cuts) {
            region.solve_skin(&mut now[first..], sweep);
        }
        regions.global.solve_skin(now, sweep);
    }

    /// Solves the contacts of vertices with solids and, in the last iteration, updates velocities.
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
        let all = FinishSlices {
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
            self.arch.dispatch(FinishIteration {
                fields: &mut fields,
                solid: sweep.solid.has_surfaces().then_some(sweep.solid),
                contact: &sweep.contact,
                finish: last.then_some(&self.motion),
            });
        });
    }
}
