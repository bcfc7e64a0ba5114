//! A region: the constraints that one core solves in one go, on one slice of the points.

use super::bending::{self, BendingBatch, Stencil};
use super::contact::{
    ContactStencil, ContactStep, Solid, Tie, TieEnd, Touch, solve_stencils, solve_ties,
};
use super::membrane::{self, LawRow, MembraneBatch};
use super::order::{Order, Place, batches};
use crate::lanes::{LANES, Point, Row};
use crate::{ContactSample, Model, System};
use pulp::{Simd, WithSimd};
use rayon::prelude::*;
use toile_geometry::Vec3;

/// Constraints of one place, indices being relative to its first slot.
#[derive(Clone, Debug, Default)]
pub struct Region {
    membrane: Vec<MembraneBatch>,
    membrane_sums: Vec<membrane::Sums>,
    bending: Vec<BendingBatch>,
    bending_sums: Vec<bending::Sums>,
    ties: Vec<Tie>,
    attachments: Vec<Tie>,
    /// Which of the attachments end on moving solids: their numbers, and those in the control.
    frames: Vec<[u32; 2]>,
    /// Contacts of points within triangles with surfaces.
    pub contacts: Vec<ContactStencil>,
    /// Contacts of cloth with cloth.
    pub cloth: Vec<ContactStencil>,
}

/// The regions of a model.
#[derive(Clone, Debug, Default)]
pub struct Regions {
    /// One for each domain.
    pub domains: Vec<Region>,
    /// One for each cut between two domains.
    pub cuts: Vec<Region>,
    /// What is solved alone.
    pub rest: Region,
}

impl Regions {
    /// Empty regions for an order.
    pub fn new(order: &Order) -> Self {
        let count = order.domains();
        Self {
            domains: vec![Region::default(); count],
            cuts: vec![Region::default(); count - 1],
            rest: Region::default(),
        }
    }

    fn at(&mut self, place: Place) -> &mut Region {
        match place {
            Place::Domain(d) => &mut self.domains[d],
            Place::Cut(d) => &mut self.cuts[d],
            Place::Rest => &mut self.rest,
        }
    }

    /// Every region.
    pub fn all_mut(&mut self) -> impl Iterator<Item = &mut Region> {
        (self.domains.iter_mut())
            .chain(self.cuts.iter_mut())
            .chain(std::iter::once(&mut self.rest))
    }

    /// Adds the membrane of every triangle that has a vertex to move.
    pub fn add_membranes(&mut self, system: &System, order: &Order) {
        let moves = |t: &u32| {
            let corners = system.topology.triangles[*t as usize];
            corners
                .iter()
                .any(|&v| !system.prescribed.pinned[v as usize])
        };
        let triangles: Vec<u32> = (0..system.topology.triangles.len() as u32)
            .filter(moves)
            .collect();
        let corners = |&t: &u32| &system.topology.triangles[t as usize][..];
        for (place, members) in by_place(order, &triangles, corners) {
            let start = order.start(place) as u32;
            let local = |v: u32| order.slot_of[v as usize] - start;
            let region = self.at(place);
            for batch in batches(
                members.len(),
                LANES,
                |i| corners(members[i]),
                |i| system.materials.of_triangle[*members[i] as usize] as usize,
            ) {
                let batch: Vec<u32> = batch.iter().map(|&i| *members[i]).collect();
                region
                    .membrane
                    .push(MembraneBatch::new(system, &batch, local));
            }
        }
    }

    /// Adds bending as constraints.
    pub fn add_bending(&mut self, system: &System, order: &Order) {
        let mut stencils = bending::stencils(system);
        stencils.retain(|s| {
            s.vertices
                .iter()
                .any(|&v| !system.prescribed.pinned[v as usize])
        });
        fn vertices(member: &Stencil) -> &[u32] {
            &member.vertices
        }
        for (place, members) in by_place(order, &stencils, vertices) {
            let start = order.start(place) as u32;
            let local = |v: u32| order.slot_of[v as usize] - start;
            let region = self.at(place);
            for batch in batches(
                members.len(),
                LANES,
                |i| vertices(members[i]),
                |i| vertices(members[i]).len(),
            ) {
                let batch: Vec<_> = batch.iter().map(|&i| members[i]).collect();
                region
                    .bending
                    .push(BendingBatch::new(system, &batch, local));
            }
        }
    }

    /// Adds elastics between vertices.
    pub fn add_ties(&mut self, model: &Model, order: &Order) {
        for &(ends, law) in &model.couplings.all {
            let moves = ends.iter().any(|&v| !model.prescribed.pinned[v as usize]);
            if law.stiffness <= 0.0 || !moves || ends[0] == ends[1] {
                continue;
            }
            let place = order.place(&ends);
            let start = order.start(place) as u32;
            let [from, to] = ends.map(|v| order.slot_of[v as usize] - start);
            let end = TieEnd::Point(to);
            self.at(place).ties.push(Tie::new(from, end, &law));
        }
    }

    /// Holds attachments to places in place of those held before; numbers are relative to `origin` [m].
    pub fn hold_attachments(&mut self, system: &System, order: &Order, origin: Vec3) {
        for region in self.all_mut() {
            region.attachments.clear();
            region.frames.clear();
        }
        for one in system.control.attachments.all() {
            if one.law.stiffness <= 0.0 || system.prescribed.pinned[one.vertex as usize] {
                continue;
            }
            let place = order.place(&[one.vertex]);
            let slot = order.slot_of[one.vertex as usize] - order.start(place) as u32;
            let to = one.place - origin;
            let end = TieEnd::Place([0, 1, 2].map(|k| to[k] as f32));
            let attachments = &mut self.at(place).attachments;
            attachments.push(Tie::new(slot, end, &one.law));
        }
        for (number, one) in (0..).zip(&system.control.frames) {
            if one.law.stiffness <= 0.0 || system.prescribed.pinned[one.vertex as usize] {
                continue;
            }
            let place = order.place(&[one.vertex]);
            let slot = order.slot_of[one.vertex as usize] - order.start(place) as u32;
            let region = self.at(place);
            let tie = Tie::new(slot, TieEnd::Place([0.0; 3]), &one.law);
            region
                .frames
                .push([region.attachments.len() as u32, number]);
            region.attachments.push(tie);
        }
    }

    /// Moves the ends of attachments that lie on moving solids to where these stand at a time [s].
    pub fn move_frames(&mut self, system: &System, origin: Vec3, time: f64) {
        for region in self.all_mut() {
            for &[tie, frame] in &region.frames {
                let to = system.control.frames[frame as usize].place(time) - origin;
                let end = TieEnd::Place([0, 1, 2].map(|k| to[k] as f32));
                region.attachments[tie as usize].to = end;
            }
        }
    }

    /// Adds the contact samples that lie within triangles.
    pub fn add_samples(&mut self, system: &System, samples: &[ContactSample], order: &Order) {
        for (index, sample) in samples.iter().enumerate() {
            if sample.triangle.is_none() {
                continue;
            }
            let place = order.place(&sample.vertices);
            let start = order.start(place) as u32;
            let [a, b, c] = sample.vertices.map(|v| order.slot_of[v as usize] - start);
            let [p, q, r] = sample.weights.map(|x| x as f32);
            self.at(place).contacts.push(ContactStencil {
                vertices: [a, b, c, 0],
                weights: [p, q, r, 0.0],
                touch: Touch::of_sample(system, (index, sample)),
                restitution: None,
            });
        }
    }

    /// Holds contacts of cloth with cloth in place of those held before: `stencil` makes one of each, its
    /// vertices being slots counted from the one that is given.
    pub fn hold_cloth<T: Sync>(
        &mut self,
        order: &Order,
        all: &[T],
        slots: impl Fn(&T) -> [u32; 4] + Sync,
        stencil: impl Fn(&T, u32) -> ContactStencil + Sync,
    ) {
        let place = |one: &T| order.place_of_slots(slots(one));
        let places: Vec<Place> = all.par_iter().with_min_len(512).map(place).collect();
        let mut members: Vec<Vec<&T>> = order.places().map(|_| Vec::new()).collect();
        for (one, place) in all.iter().zip(&places) {
            members[order.number(*place)].push(one);
        }
        for (place, members) in order.places().zip(&members) {
            let start = order.start(place) as u32;
            let made = members.par_iter().with_min_len(256);
            let held = &mut self.at(place).cloth;
            made.map(|one| stencil(one, start)).collect_into_vec(held);
        }
    }

    /// Every region.
    pub fn all(&self) -> impl Iterator<Item = &Region> {
        (self.domains.iter())
            .chain(&self.cuts)
            .chain(std::iter::once(&self.rest))
    }

    /// Membrane constraints and bending constraints.
    pub fn counts(&self) -> [usize; 2] {
        [
            self.all()
                .flat_map(|r| &r.membrane)
                .map(MembraneBatch::len)
                .sum(),
            self.all()
                .flat_map(|r| &r.bending)
                .map(BendingBatch::len)
                .sum(),
        ]
    }

    /// Elastics.
    pub fn tie_count(&self) -> usize {
        (self.all().map(|r| r.ties.len() + r.attachments.len())).sum()
    }
}

/// Sorts constraints by where they are solved.
fn by_place<'a, T>(
    order: &Order,
    all: &'a [T],
    vertices: impl Fn(&'a T) -> &'a [u32],
) -> Vec<(Place, Vec<&'a T>)> {
    let places = order.places().map(|place| (place, Vec::new()));
    let mut places: Vec<(Place, Vec<&T>)> = places.collect();
    for member in all {
        let place = order.place(vertices(member));
        places[order.number(place)].1.push(member);
    }
    // Neighbours in memory come one after the other.
    for (_, members) in &mut places {
        let first = |member: &&'a T| {
            let slots = vertices(member).iter().map(|&v| order.slot_of[v as usize]);
            slots.min().unwrap_or(0)
        };
        members.sort_by_key(first);
    }
    places
}

/// What the constraints of a substep share.
#[derive(Clone, Copy)]
pub struct SweepStep<'a> {
    /// The surfaces.
    pub solid: Solid<'a>,
    /// The laws of the materials.
    pub laws: &'a [LawRow],
    /// (1 + drag h) / h^2 [1/s2], and the like for contacts.
    pub contact: ContactStep,
    /// How far surfaces move in the substep [m]; said in its first sweep, which lets forces start from zero.
    pub begins: Option<f32>,
    /// Whether forces are kept from iteration to iteration.
    pub iterated: bool,
    /// Whether bending is a constraint.
    pub bends: bool,
}

impl Region {
    /// Gets ready for a substep of new size.
    pub fn set_step(&mut self, kappa: f64) {
        for batch in &mut self.bending {
            batch.set_step(kappa);
        }
    }

    /// Gets ready for an advance.
    pub fn begin(&mut self, iterated: bool) {
        if iterated {
            self.membrane_sums
                .resize(self.membrane.len(), [Row::splat(0.0); 3]);
            self.bending_sums
                .resize(self.bending.len(), [[Row::splat(0.0); 3]; 3]);
        }
    }

    /// Looks up surfaces anew.
    pub fn forget_surfaces(&mut self) {
        for contact in &mut self.contacts {
            contact.touch.forget();
        }
    }

    /// Forces start from zero.
    fn clear(&mut self) {
        self.membrane_sums.fill([Row::splat(0.0); 3]);
        self.bending_sums.fill([[Row::splat(0.0); 3]; 3]);
        for tie in self.ties.iter_mut().chain(&mut self.attachments) {
            tie.sum = [0.0; 3];
        }
        for contact in self.contacts.iter_mut().chain(&mut self.cloth) {
            contact.touch.push = 0.0;
            contact.touch.rub = [0.0; 3];
        }
    }

    /// Surfaces move by up to `travel` [m] in the substep that begins.
    fn age(&mut self, travel: f32) {
        for contact in &mut self.contacts {
            contact.touch.age(travel);
        }
    }

    /// Solves every constraint once.
    pub fn sweep(&mut self, step: &SweepStep, points: &mut [Point], starts: &[Point]) {
        if let Some(travel) = step.begins {
            self.clear();
            if travel > 0.0 {
                self.age(travel);
            }
        }
        for contact in &mut self.contacts {
            let point = contact.point(points);
            if contact.touch.is_stale(point) {
                contact.touch.look(&step.solid, point);
            }
        }
        pulp::Arch::new().dispatch(Sweep {
            region: self,
            step,
            points,
        });
        solve_ties(&mut self.ties, points, step.contact.kappa);
        solve_ties(&mut self.attachments, points, step.contact.kappa);
        solve_stencils(&mut self.contacts, points, starts, &step.contact);
        solve_stencils(&mut self.cloth, points, starts, &step.contact);
    }
}

struct Sweep<'a> {
    region: &'a mut Region,
    step: &'a SweepStep<'a>,
    points: &'a mut [Point],
}

impl WithSimd for Sweep<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let (region, kappa) = (self.region, self.step.contact.kappa);
        let laws = self.step.laws;
        if self.step.iterated {
            let sums = Some(&mut region.membrane_sums[..]);
            membrane::solve(simd, &region.membrane, sums, laws, kappa, self.points);
            let sums = Some(&mut region.bending_sums[..]);
            if self.step.bends {
                bending::solve(simd, &region.bending, sums, kappa, self.points);
            }
        } else {
            membrane::solve(simd, &region.membrane, None, laws, kappa, self.points);
            if self.step.bends {
                bending::solve(simd, &region.bending, None, kappa, self.points);
            }
        }
    }
}
