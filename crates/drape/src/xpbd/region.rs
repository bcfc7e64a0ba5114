//! A region: the constraints of one partition, solved by one task on one slice of the points.

use super::attachment_constraint::{AttachmentConstraint, AttachmentEnd, solve_attachments};
use super::bending::{self, BendingBatch, Stencil};
use super::carried_plane::CarriedPlane;
use super::contact::{ContactConstraint, ContactStencil, ContactStep, Solid, solve_stencils};
use super::membrane::{self, LawRow, MembraneBatch};
use super::skin_contacts::SkinContact;
use super::tie_constraint::{TieConstraint, solve_ties, stiff_ties};
use super::vertex_partition::{Partition, VertexPartition, batches};
use super::viscosity::{Viscosity, ViscousBatch};
use crate::lanes::{LANES, Point, Row};
use crate::material::MaterialLaws;
use crate::{ContactSample, Material, Model, System};
use pulp::{Simd, WithSimd};
use rayon::prelude::*;
use toile_geometry::Vec3;

/// The constraints of one partition; indices of vertices count from its first slot.
#[derive(Clone, Debug, Default)]
pub struct Region {
    /// The triangles.
    pub membrane: Vec<MembraneBatch>,
    membrane_multipliers: Vec<membrane::Multipliers>,
    bending: Vec<BendingBatch>,
    /// Those with viscous bending.
    pub viscous: Vec<ViscousBatch>,
    bending_multipliers: Vec<bending::Multipliers>,
    elastics: Vec<AttachmentConstraint>,
    attachments: Vec<AttachmentConstraint>,
    /// Attachments that end on moving solids: index among the attachments, index among the control's frames.
    frames: Vec<[u32; 2]>,
    ties: Vec<TieConstraint>,
    /// Contacts of points within triangles with surfaces.
    pub contacts: Vec<ContactStencil>,
    /// Their planes on solids that move; empty where none does.
    carried: Vec<CarriedPlane>,
    /// Contacts of faces with vertices of solids that move.
    pub skin: Vec<SkinContact>,
    /// Contacts of cloth with cloth.
    pub cloth: Vec<ContactStencil>,
    /// Whether the stencils have begun a substep whose end their slips do not yet contain.
    has_begun: bool,
}

/// One of the lists of contacts of a region.
pub type ContactList<C> = fn(&mut Region) -> &mut Vec<C>;

/// The regions of a model.
#[derive(Clone, Debug, Default)]
pub struct Regions {
    /// One for each domain.
    pub domains: Vec<Region>,
    /// One for each cut between two domains.
    pub cuts: Vec<Region>,
    /// Constraints between vertices far apart in memory, solved last by one core.
    pub global: Region,
}

impl Regions {
    /// Empty regions for the partitions of the vertices.
    pub fn new(numbering: &VertexPartition) -> Self {
        let count = numbering.domains();
        Self {
            domains: vec![Region::default(); count],
            cuts: vec![Region::default(); count - 1],
            global: Region::default(),
        }
    }

    fn at(&mut self, partition: Partition) -> &mut Region {
        match partition {
            Partition::Domain(d) => &mut self.domains[d],
            Partition::Cut(d) => &mut self.cuts[d],
            Partition::Global => &mut self.global,
        }
    }

    /// Every region.
    pub fn all_mut(&mut self) -> impl Iterator<Item = &mut Region> {
        (self.domains.iter_mut())
            .chain(self.cuts.iter_mut())
            .chain(std::iter::once(&mut self.global))
    }

    /// Adds the membrane of every triangle with a free vertex.
    pub fn add_membranes(&mut self, system: &System, numbering: &VertexPartition) {
        let is_free = |t: &u32| {
            let corners = system.topology.triangles[*t as usize];
            corners
                .iter()
                .any(|&v| !system.prescribed.pinned[v as usize])
        };
        let triangles: Vec<u32> = (0..system.topology.triangles.len() as u32)
            .filter(is_free)
            .collect();
        let corners = |&t: &u32| &system.topology.triangles[t as usize][..];
        for (partition, members) in by_partition(numbering, &triangles, corners) {
            let start = numbering.start(partition) as u32;
            let local = |v: u32| numbering.slot_of[v as usize] - start;
            let region = self.at(partition);
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
    pub fn add_bending(&mut self, system: &System, numbering: &VertexPartition) {
        let stencils = bending::stencils(system, Material::bending_matrix);
        self.add_stencils(system, numbering, stencils, |region, batch, local| {
            region.bending.push(BendingBatch::new(system, batch, local));
        });
    }

    /// Adds the viscosity of bending.
    pub fn add_viscous_bending(&mut self, system: &System, numbering: &VertexPartition) {
        let stencils = Viscosity::stencils(system);
        self.add_stencils(system, numbering, stencils, |region, batch, local| {
            region.viscous.push(ViscousBatch::new(system, batch, local));
        });
    }

    /// Adds stencils with a free vertex in batches; `add` has the region, the batch, and the index of a vertex in the
    /// region.
    fn add_stencils(
        &mut self,
        system: &System,
        numbering: &VertexPartition,
        mut stencils: Vec<Stencil>,
        mut add: impl FnMut(&mut Region, &[&Stencil], &dyn Fn(u32) -> u32),
    ) {
        stencils.retain(|s| {
            s.vertices
                .iter()
                .any(|&v| !system.prescribed.pinned[v as usize])
        });
        fn vertices(member: &Stencil) -> &[u32] {
            &member.vertices
        }
        for (partition, members) in by_partition(numbering, &stencils, vertices) {
            let start = numbering.start(partition) as u32;
            let local = |v: u32| numbering.slot_of[v as usize] - start;
            let region = self.at(partition);
            for batch in batches(
                members.len(),
                LANES,
                |i| vertices(members[i]),
                |i| vertices(members[i]).len(),
            ) {
                let batch: Vec<_> = batch.iter().map(|&i| members[i]).collect();
                add(region, &batch, &local);
            }
        }
    }

    /// Adds elastics between vertices.
    pub fn add_elastics(&mut self, model: &Model, numbering: &VertexPartition) {
        for &(ends, law) in &model.couplings.all {
            let is_free = ends.iter().any(|&v| !model.prescribed.pinned[v as usize]);
            if law.stiffness <= 0.0 || !is_free || ends[0] == ends[1] {
                continue;
            }
            let partition = numbering.partition_of(&ends);
            let start = numbering.start(partition) as u32;
            let [from, to] = ends.map(|v| numbering.slot_of[v as usize] - start);
            let end = AttachmentEnd::Vertex(to);
            self.at(partition)
                .elastics
                .push(AttachmentConstraint::new(from, end, &law));
        }
    }

    /// Replaces the attachments by those of the control; coordinates are relative to `origin` (m).
    pub fn set_attachments(&mut self, system: &System, numbering: &VertexPartition, origin: Vec3) {
        for region in self.all_mut() {
            region.attachments.clear();
            region.frames.clear();
        }
        for one in system.control.attachments.all() {
            if one.law.stiffness <= 0.0 || system.prescribed.pinned[one.vertex as usize] {
                continue;
            }
            let partition = numbering.partition_of(&[one.vertex]);
            let slot = numbering.slot_of[one.vertex as usize] - numbering.start(partition) as u32;
            let to = one.place - origin;
            let end = AttachmentEnd::Fixed([0, 1, 2].map(|k| to[k] as f32));
            let attachments = &mut self.at(partition).attachments;
            attachments.push(AttachmentConstraint::new(slot, end, &one.law));
        }
        for (number, one) in (0..).zip(&system.control.frames) {
            if one.law.stiffness <= 0.0 || system.prescribed.pinned[one.vertex as usize] {
                continue;
            }
            let partition = numbering.partition_of(&[one.vertex]);
            let slot = numbering.slot_of[one.vertex as usize] - numbering.start(partition) as u32;
            let region = self.at(partition);
            let constraint =
                AttachmentConstraint::new(slot, AttachmentEnd::Fixed([0.0; 3]), &one.law);
            region
                .frames
                .push([region.attachments.len() as u32, number]);
            region.attachments.push(constraint);
        }
    }

    /// Replaces the ties by those of the control.
    pub fn set_ties(&mut self, system: &System, numbering: &VertexPartition) {
        for region in self.all_mut() {
            region.ties.clear();
        }
        for (number, tie) in stiff_ties(system) {
            let vertices: Vec<u32> = tie.vertices().collect();
            let partition = numbering.partition_of(&vertices);
            let start = numbering.start(partition) as u32;
            let constraint = TieConstraint::new(tie, number, numbering, start);
            self.at(partition).ties.push(constraint);
        }
    }

    /// Sets the ends of the ties to where they are at a time (s), the end of the substep.
    pub fn follow_ties(&mut self, solid: &Solid, time: f64) {
        let of = (&solid.system.control, solid.moving);
        for tie in self.all_mut().flat_map(|region| &mut region.ties) {
            tie.follow(of, solid.origin, [time, solid.shares[1]]);
        }
    }

    /// Sets the ends of the attachments to moving solids to their positions at a time (s).
    pub fn move_frames(&mut self, system: &System, origin: Vec3, time: f64) {
        for region in self.all_mut() {
            for &[constraint, frame] in &region.frames {
                let to = system.control.frames[frame as usize].target(time) - origin;
                let end = AttachmentEnd::Fixed([0, 1, 2].map(|k| to[k] as f32));
                region.attachments[constraint as usize].to = end;
            }
        }
    }

    /// Adds the contacts of the samples that lie within triangles, one with each solid.
    pub fn add_samples(
        &mut self,
        system: &System,
        samples: &[ContactSample],
        numbering: &VertexPartition,
    ) {
        for (index, sample) in samples.iter().enumerate() {
            if sample.triangle.is_none() {
                continue;
            }
            let partition = numbering.partition_of(&sample.vertices);
            let start = numbering.start(partition) as u32;
            let [a, b, c] = sample
                .vertices
                .map(|v| numbering.slot_of[v as usize] - start);
            let [p, q, r] = sample.weights.map(|x| x as f32);
            for solid in 0..system.colliders.len() {
                self.at(partition).contacts.push(ContactStencil {
                    vertices: [a, b, c, 0],
                    weights: [p, q, r, 0.0],
                    constraint: ContactConstraint::of_sample(system, (index, sample), solid),
                    begun_at: [0.0; 3],
                    number: 0,
                    restitution: None,
                });
            }
        }
    }

    /// Replaces the contacts in a list of every region: `contact` makes each one from an element of `all` and the first
    /// slot of its partition, from which the indices of its vertices count.
    pub fn replace<T: Sync, C: Send>(
        &mut self,
        numbering: &VertexPartition,
        all: &[T],
        slots: impl Fn(&T) -> [u32; 4] + Sync,
        (contact, list): (impl Fn(&T, u32) -> C + Sync, ContactList<C>),
    ) {
        let partition = |one: &T| numbering.partition_of_slots(slots(one));
        let partitions: Vec<Partition> = all.par_iter().with_min_len(512).map(partition).collect();
        let mut members: Vec<Vec<&T>> = numbering.partitions().map(|_| Vec::new()).collect();
        for (one, partition) in all.iter().zip(&partitions) {
            members[numbering.index_of(*partition)].push(one);
        }
        for (partition, members) in numbering.partitions().zip(&members) {
            let start = numbering.start(partition) as u32;
            let members = members.par_iter().with_min_len(256);
            members
                .map(|one| contact(one, start))
                .collect_into_vec(list(self.at(partition)));
            self.at(partition).has_begun = false;
        }
    }

    /// Every region.
    pub fn all(&self) -> impl Iterator<Item = &Region> {
        (self.domains.iter())
            .chain(&self.cuts)
            .chain(std::iter::once(&self.global))
    }

    /// Numbers of membrane constraints and of bending constraints.
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

    /// Number of elastics and attachments.
    pub fn elastic_count(&self) -> usize {
        (self.all().map(|r| r.elastics.len() + r.attachments.len())).sum()
    }
}

/// Sorts constraints by the partition that solves them.
fn by_partition<'a, T>(
    numbering: &VertexPartition,
    all: &'a [T],
    vertices: impl Fn(&'a T) -> &'a [u32],
) -> Vec<(Partition, Vec<&'a T>)> {
    let partitions = numbering
        .partitions()
        .map(|partition| (partition, Vec::new()));
    let mut partitions: Vec<(Partition, Vec<&T>)> = partitions.collect();
    for member in all {
        let partition = numbering.partition_of(vertices(member));
        partitions[numbering.index_of(partition)].1.push(member);
    }
    // Constraints on neighbouring slots follow each other.
    for (_, members) in &mut partitions {
        let first = |member: &&'a T| {
            let slots = vertices(member)
                .iter()
                .map(|&v| numbering.slot_of[v as usize]);
            slots.min().unwrap_or(0)
        };
        members.sort_by_key(first);
    }
    partitions
}

/// Parameters of a sweep over constraints.
#[derive(Clone, Copy)]
pub struct SweepStep<'a> {
    /// The solids.
    pub solid: Solid<'a>,
    /// The laws of the materials.
    pub laws: &'a [LawRow],
    /// (1 + drag h) / h^2 (1/s2), and the parameters of contacts.
    pub contact: ContactStep,
    /// Whether it is the first sweep of a substep, which sets the multipliers to zero.
    pub is_first: bool,
    /// Whether multipliers are accumulated over several iterations.
    pub iterated: bool,
    /// Whether bending is constraints.
    pub has_bending: bool,
}

impl Region {
    /// Sets up the bending constraints for a new size of substep; `kappa` is (1 + drag h) / h^2 (1/s2).
    pub fn set_step(&mut self, kappa: f64) {
        for batch in &mut self.bending {
            batch.set_step(kappa);
        }
    }

    /// Sizes the multipliers, which only iterated constraints need.
    pub fn begin(&mut self, iterated: bool) {
        if iterated {
            self.membrane_multipliers
                .resize(self.membrane.len(), [Row::splat(0.0); 3]);
            self.bending_multipliers
                .resize(self.bending.len(), [[Row::splat(0.0); 3]; 3]);
        }
    }

    /// Marks all contact planes as invalid: surfaces are queried again before the next use.
    pub fn invalidate_surfaces(&mut self) {
        for contact in &mut self.contacts {
            contact.constraint.invalidate();
        }
    }

    /// Ends the last substep for the friction of the stencils, at the points at its end.
    pub fn end_substep(&mut self, points: &[Point], step: &ContactStep) {
        if std::mem::take(&mut self.has_begun) {
            for contact in self.contacts.iter_mut().chain(&mut self.cloth) {
                contact.end_substep(points, step);
            }
        }
    }

    /// Clears the slips of cloth on cloth after a failed substep.
    pub fn forget_slips(&mut self) {
        self.has_begun = false;
        for contact in &mut self.cloth {
            contact.constraint.slip = [0.0; 3];
        }
    }

    /// Begins a substep: sets all multipliers to zero. Only slips are carried over from one substep to the next.
    fn clear(&mut self, starts: &[Point]) {
        self.has_begun = true;
        self.membrane_multipliers.fill([Row::splat(0.0); 3]);
        self.bending_multipliers.fill([[Row::splat(0.0); 3]; 3]);
        for constraint in self.elastics.iter_mut().chain(&mut self.attachments) {
            constraint.lambda = [0.0; 3];
        }
        for tie in &mut self.ties {
            tie.lambda = [0.0; 3];
        }
        for contact in self.contacts.iter_mut().chain(&mut self.cloth) {
            contact.begun_at = contact.point(starts);
            contact.constraint.lambda_normal = 0.0;
            contact.constraint.lambda_tangent = [0.0; 3];
        }
        for SkinContact { stencil, .. } in &mut self.skin {
            stencil.begun_at = stencil.point(starts);
            stencil.constraint.lambda_normal = 0.0;
        }
    }

    /// Moves the planes of surfaces that move to the end of the coming substep.
    fn carry(&mut self, solid: &Solid) {
        self.carried
            .resize(self.contacts.len(), CarriedPlane::default());
        for (contact, carried) in self.contacts.iter_mut().zip(&self.carried) {
            contact.constraint.carry(solid, carried);
        }
        for SkinContact {
            stencil, carried, ..
        } in &mut self.skin
        {
            stencil.constraint.carry(solid, carried);
        }
    }

    /// Solves every constraint once.
    pub fn sweep(&mut self, step: &SweepStep, points: &mut [Point], starts: &[Point]) {
        if step.is_first {
            self.end_substep(starts, &step.contact);
            for contact in &mut self.skin {
                contact.follow(&step.solid, starts);
            }
            self.clear(starts);
            if step.solid.moving.any() {
                self.carry(&step.solid);
            }
        }
        for (k, contact) in self.contacts.iter_mut().enumerate() {
            let point = contact.point(points);
            if contact.constraint.is_stale(point) {
                let carried = self.carried.get_mut(k);
                (contact.constraint).query_surface(&step.solid, point, carried);
            }
        }
        pulp::Arch::new().dispatch(Sweep {
            region: self,
            step,
            points,
        });
        solve_attachments(&mut self.elastics, points, step.contact.kappa);
        solve_attachments(&mut self.attachments, points, step.contact.kappa);
        solve_ties(&mut self.ties, points, step.contact.kappa);
        solve_stencils(self.contacts.iter_mut(), points, &step.contact);
        self.solve_skin(points, step);
        solve_stencils(self.cloth.iter_mut(), points, &step.contact);
    }
}

impl Region {
    /// Solves the contacts of vertices and edges of moving solids.
    pub fn solve_skin(&mut self, points: &mut [Point], step: &SweepStep) {
        let skin = self.skin.iter_mut().map(|contact| &mut contact.stencil);
        solve_stencils(skin, points, &step.contact);
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
            let multipliers = Some(&mut region.membrane_multipliers[..]);
            membrane::solve(
                simd,
                &region.membrane,
                multipliers,
                laws,
                kappa,
                self.points,
            );
            let multipliers = Some(&mut region.bending_multipliers[..]);
            if self.step.has_bending {
                bending::solve(simd, &region.bending, multipliers, kappa, self.points);
            }
        } else {
            membrane::solve(simd, &region.membrane, None, laws, kappa, self.points);
            if self.step.has_bending {
                bending::solve(simd, &region.bending, None, kappa, self.points);
            }
        }
    }
}
