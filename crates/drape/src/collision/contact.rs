//! Contact of cloth with cloth: the laws of contact with a surface, on the vector between two
//! features in place of the point.

use super::bound::ImpactStats;
use super::cloth_contact::ClothContact;
use super::curvature::Clearance;
use super::fade::fade;
use super::layer_order::layer_order;
use super::layers::{Knots, Stray, strays, ways_out};
use super::memory::{ContactFrictionState, RecoveryDirection};
use super::motions::Motions;
use super::nearness::Nearness;
use super::proximity::nearnesses;
use super::reach::Reach;
use super::surface::{ClothSurface, Near};
use super::tangle::{Piercing, crossed_for, crossings, keep_on, loose_round, piercings};
use super::trajectories::LinearTrajectories;
use crate::laws::contact::{ContactLaw, ContactPlane};
use crate::{Model, State};
use nalgebra::Matrix3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;
use std::sync::Arc;
use toile_geometry::Vec3;

/// What was found and done so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tally {
    /// Looks.
    pub looks: usize,
    /// Edges that crossed a face: at the first look, most at one look, at the last look.
    pub crossings: [usize; 3],
    /// Vertices of outer layers on the wrong side of inner ones, likewise.
    pub astray: [usize; 3],
    /// Impulses that kept features from passing through each other between looks.
    pub impulses: usize,
    /// Moves of vertices in rigid zones, where impulses did not settle.
    pub zoned: usize,
    /// Moves of vertices that were cut because zones were not enough.
    pub cut: usize,
}

impl Tally {
    fn look(&mut self, crossings: usize, astray: usize) {
        for (counts, now) in [(&mut self.crossings, crossings), (&mut self.astray, astray)] {
            if self.looks == 0 {
                counts[0] = now;
            }
            counts[1] = counts[1].max(now);
            counts[2] = now;
        }
        self.looks += 1;
    }

    /// With another's counts after these.
    #[must_use]
    pub fn then(self, next: Self) -> Self {
        if self.looks == 0 || next.looks == 0 {
            return if self.looks == 0 { next } else { self };
        }
        let both = |[first, most, _]: [usize; 3], [_, next, last]: [usize; 3]| {
            [first, most.max(next), last]
        };
        Self {
            looks: self.looks + next.looks,
            crossings: both(self.crossings, next.crossings),
            astray: both(self.astray, next.astray),
            impulses: self.impulses + next.impulses,
            zoned: self.zoned + next.zoned,
            cut: self.cut + next.cut,
        }
    }
}

/// What is drawn where it belongs.
struct Pull<'a> {
    vertices: [u32; 4],
    weights: [f64; 4],
    /// Unit direction that the first feature goes against the second.
    way: Vec3,
    /// How far [m].
    depth: f64,
    /// Force per depth [N/m].
    stiffness: f64,
    x: &'a [Vec3],
}

/// The contact that pulls, without friction.
fn pull(pull: &Pull) -> ClothContact {
    let four = pull.vertices.into_iter().zip(pull.weights);
    let point = four.map(|(v, w)| pull.x[v as usize] * w).sum();
    ClothContact {
        vertices: pull.vertices,
        weights: pull.weights,
        plane: ContactPlane {
            point,
            depth: pull.depth,
            gradient: pull.way,
            normal: pull.way,
            hollow: Matrix3::zeros(),
            bulge: Matrix3::zeros(),
            anchor: point,
            lagged_normal_force: 0.0,
            returning: false,
            landing: false,
        },
        law: ContactLaw {
            normal: pull.stiffness,
            tangential: pull.stiffness,
            friction: 0.0,
            hard_from: f64::INFINITY,
        },
        restitution: None,
        pair: None,
    }
}

/// Contacts of the present positions.
#[derive(Clone, Debug, Default)]
pub struct ClothContacts {
    /// The contacts.
    pub active: Vec<ClothContact>,
    /// Pairs of an edge and a face that cross.
    pub piercings: usize,
    /// Vertices of outer layers on the wrong side of inner ones.
    pub strays: usize,
    /// Vertices at a crossing within a layer.
    pub tangled: Vec<bool>,
    /// Vertices at a crossing of two layers, or on the wrong side of one.
    pub astray: Vec<bool>,
    /// Vertices round a crossing that stays; empty where none does.
    pub loose: Vec<bool>,
    /// What was found and done so far.
    pub tally: Tally,
    surface: ClothSurface,
    /// The model the surface was made for.
    made_for: Option<Model>,
    drawn: Vec<RecoveryDirection>,
    /// What a state is to remember of vertices on the wrong side of a layer, as in [`ClothMemory`].
    stray_reach: Option<f64>,
    /// For how many looks vertices have been at a crossing, likewise.
    crossed_for: Vec<u32>,
}

/// Contacts are kept from this many offsets away, so that a step is stopped before it lands.
const REACH_IN_OFFSETS: f64 = 2.0;

/// Share of the offset that two cloths give way by before their contact is hard.
const HARD_FROM: f64 = 0.75;

/// How far the vertices of a region that is left out may stray from one another on their ways before
/// it is looked at again [m].
const BEYOND: f64 = 1e-3;

/// How far an edge that pierces a face is pulled at a time, in offsets: by less, a fold caught in a seam
/// stays there.
const PULL: f64 = 2.0;

/// How far within an inner layer an outer one may start [m]: the ease of a wide garment. What is found
/// deeper by `STRAY_SLACK` [m] at the next look is found too.
const STRAY_REACH: f64 = 0.15;
const STRAY_SLACK: f64 = 0.02;

impl ClothContacts {
    /// What regions that are left out must keep, for cloth that is kept `offset` [m] apart.
    pub fn clearance(offset: f64) -> Clearance {
        Clearance {
            kept: offset,
            beyond: BEYOND,
        }
    }

    /// The surface in hand, made anew for another model.
    pub fn surface(&mut self, model: &Model) -> &mut ClothSurface {
        let fits = |of: &Model| of.has_cloth_of(model) && Arc::ptr_eq(&of.layer, &model.layer);
        if !self.made_for.as_ref().is_some_and(fits) {
            self.surface = ClothSurface::new(model);
            self.made_for = Some(model.clone());
        }
        &mut self.surface
    }

    /// Finds contacts and crossings; what the state remembers of friction goes into the contacts.
    pub fn find(&mut self, model: &Model, state: &State, x: &[Vec3], reach: &Reach) {
        self.active.clear();
        self.piercings = 0;
        self.strays = 0;
        for flags in [&mut self.tangled, &mut self.astray] {
            flags.clear();
            flags.resize(x.len(), false);
        }
        if model.contact.cloth_offset <= 0.0 {
            self.loose.clear();
            self.crossed_for.clear();
            self.drawn.clear();
            return;
        }
        let clearance = Self::clearance(model.contact.cloth_offset);
        self.surface(model)
            .look(LinearTrajectories::still(x), reach, clearance);
        let crossings = crossings(&self.surface, Near::Listed, x);
        self.piercings = crossings.len();
        let (own, across) = self.mark(&crossings);
        self.loosen(&state.cloth.crossed_for);
        let strays = self.find_strays(x, !across.is_empty(), state.cloth.stray_reach);
        self.tally.look(self.piercings, self.strays);
        let knots = Knots {
            tangled: &self.tangled,
            astray: &self.astray,
            loose: &self.loose,
            layer: &model.layer,
        };
        let mut active = std::mem::take(&mut self.active);
        let mut found = nearnesses(&self.surface, Near::Listed, x, reach);
        found.retain(|near| {
            let vertices = near.pair.vertices();
            let fixed = vertices
                .iter()
                .all(|&v| model.prescribed.pinned[v as usize]);
            !fixed && !knots.lets_go(near.pair)
        });
        let contacts = found.par_iter().with_min_len(256);
        active.par_extend(contacts.map(|near| self.contact(model, state, x, near)));
        let mut ways = piercings(&self.surface, &own, x);
        self.drawn = keep_on(&mut ways, &state.cloth.drawn);
        ways.extend(ways_out(&self.surface, &across, x));
        active.extend(ways.iter().filter_map(|way| self.way_out(model, x, way)));
        active.extend(strays.iter().filter_map(|s| self.way_back(model, x, s)));
        self.active = active;
    }

    /// Marks the vertices at crossings; gives those within a layer and those of two.
    fn mark(&mut self, crossings: &[[u32; 2]]) -> (Vec<[u32; 2]>, Vec<[u32; 2]>) {
        let surface = &self.surface;
        let within = |&[e, t]: &[u32; 2]| {
            let (edge, face) = (surface.edges[e as usize], surface.triangles[t as usize]);
            layer_order(&surface.layer, edge[0], face[0]) == Ordering::Equal
        };
        let (own, across): (Vec<_>, Vec<_>) = crossings.iter().copied().partition(within);
        for (crossings, flags) in [(&own, &mut self.tangled), (&across, &mut self.astray)] {
            for &[e, t] in crossings {
                let face = surface.triangles[t as usize];
                for v in surface.edges[e as usize].into_iter().chain(face) {
                    flags[v as usize] = true;
                }
            }
        }
        (own, across)
    }

    /// Loosens the cloth round vertices that stay at a crossing within a layer.
    fn loosen(&mut self, before: &[u32]) {
        self.crossed_for = crossed_for(&self.tangled, before);
        self.loose = loose_round(&self.surface.edges, &self.tangled, &self.crossed_for);
    }

    /// Vertices on the wrong side of a layer no farther off than the last look says, where there may be
    /// any.
    fn find_strays(&mut self, x: &[Vec3], crossed: bool, reach: Option<f64>) -> Vec<Stray> {
        let reach = reach.unwrap_or(STRAY_REACH);
        self.stray_reach = Some(0.0);
        if reach == 0.0 && !crossed {
            return Vec::new();
        }
        let found = strays(&self.surface, x, reach.max(STRAY_SLACK));
        for stray in &found {
            self.astray[stray.vertex as usize] = true;
        }
        self.strays = found.len();
        if crossed || !found.is_empty() {
            let deepest = found.iter().map(|s| s.depth).fold(0.0, f64::max);
            self.stray_reach = Some((deepest + STRAY_SLACK).min(STRAY_REACH));
        }
        found
    }

    /// Has a state remember what the last look found of crossings and layers.
    pub fn remember(&self, state: &mut State) {
        state.cloth.drawn.clone_from(&self.drawn);
        state.cloth.crossed_for.clone_from(&self.crossed_for);
        state.cloth.stray_reach = self.stray_reach.or(state.cloth.stray_reach);
    }

    /// Whether nothing crosses and nothing is on the wrong side of a layer.
    pub fn is_in_order(&self) -> bool {
        self.piercings == 0 && self.strays == 0
    }

    /// Searches all at the next look, so that it does not depend on what was found before.
    pub fn forget(&mut self) {
        self.surface.forget();
    }

    /// Contacts within the usual reach; two edges fade where their contact would come and go at once.
    pub fn refresh(&mut self, model: &Model, state: &State, x: &[Vec3]) {
        let reach = Reach::all(REACH_IN_OFFSETS * model.contact.cloth_offset);
        self.find(model, state, x, &reach);
        for contact in &mut self.active {
            let fade = fade(contact, x);
            contact.law.normal *= fade;
            contact.law.tangential *= fade;
        }
    }

    fn contact(&self, model: &Model, state: &State, x: &[Vec3], near: &Nearness) -> ClothContact {
        let vertices = near.pair.vertices();
        let of = |values: &[f64]| {
            let four = vertices.iter().zip(near.weights);
            0.5 * four
                .map(|(&v, w)| values[v as usize] * w.abs())
                .sum::<f64>()
        };
        let offset = model.contact.cloth_offset;
        let kept = self.surface.kept(near.pair, near.neighbours, offset);
        // Each side's vertices see the other's faces: half the area each.
        let normal = 0.5 * model.contact.stiffness * of(&self.surface.area);
        let between = near.normal * near.distance;
        let memory = &state.cloth;
        let held = memory
            .held
            .binary_search_by(|held| held.pair.cmp(&near.pair))
            .ok();
        let (mut anchor, mut force) = (between, 0.0);
        if let Some(held) = held.map(|at| memory.held[at]) {
            let four = vertices.iter().zip(near.weights);
            let slid: Vec3 = four
                .map(|(&v, w)| (x[v as usize] - memory.places[v as usize]) * w)
                .sum();
            anchor = between - held.slip - slid;
            force = held.force;
        }
        let friction = if model.contact.friction {
            of(&self.surface.friction)
        } else {
            0.0
        };
        ClothContact {
            vertices,
            weights: near.weights,
            plane: ContactPlane {
                point: between,
                depth: kept - near.distance,
                gradient: near.normal,
                normal: near.normal,
                hollow: Matrix3::zeros(),
                bulge: Matrix3::zeros(),
                anchor,
                lagged_normal_force: force,
                returning: false,
                landing: false,
            },
            law: ContactLaw {
                normal,
                // What presses harder than the soft contact can slips no farther before it slides.
                tangential: 0.5 * normal.max(force / kept),
                friction,
                hard_from: HARD_FROM * kept,
            },
            restitution: self.restitution(vertices, near.weights),
            pair: Some(near.pair),
        }
    }

    /// The mean by weight of the vertices that say it.
    fn restitution(&self, vertices: [u32; 4], weights: [f64; 4]) -> Option<f64> {
        let (mut sum, mut all) = (0.0, 0.0);
        for (v, w) in vertices.into_iter().zip(weights) {
            if let Some(e) = self.surface.restitution[v as usize] {
                sum += e * w.abs();
                all += w.abs();
            }
        }
        (all > 0.0).then(|| sum / all)
    }

    /// A pull on the ends of a piercing edge and the two nearest corners of the face.
    fn way_out(&self, model: &Model, x: &[Vec3], piercing: &Piercing) -> Option<ClothContact> {
        let (v, w) = (piercing.vertices, piercing.weights);
        let least = (2..5).fold(2, |least, k| if w[k] > w[least] { k } else { least });
        let mut corners = (2..5).filter(|&k| k != least);
        let [c, d] = [corners.next()?, corners.next()?];
        let total = w[c] + w[d];
        let vertices = [v[0], v[1], v[c], v[d]];
        let weights = [w[0], w[1], -w[c] / total, -w[d] / total];
        if vertices
            .iter()
            .all(|&v| model.prescribed.pinned[v as usize])
        {
            return None;
        }
        let area: f64 = vertices
            .iter()
            .map(|&v| self.surface.area[v as usize])
            .sum();
        Some(pull(&Pull {
            vertices,
            weights,
            way: piercing.way,
            depth: PULL * model.contact.cloth_offset,
            stiffness: 0.25 * model.contact.stiffness * area,
            x,
        }))
    }

    /// A pull on a vertex that is on the wrong side of a layer, and on the face it belongs beyond.
    fn way_back(&self, model: &Model, x: &[Vec3], stray: &Stray) -> Option<ClothContact> {
        let ([a, b, c], w) = (stray.face, stray.weights);
        let vertices = [stray.vertex, a, b, c];
        if vertices
            .iter()
            .all(|&v| model.prescribed.pinned[v as usize])
        {
            return None;
        }
        let weights = [1.0, -w[0], -w[1], -w[2]];
        let areas = vertices.iter().zip(weights);
        let area: f64 = areas
            .map(|(&v, w)| self.surface.area[v as usize] * w.abs())
            .sum();
        let offset = model.contact.cloth_offset;
        Some(pull(&Pull {
            vertices,
            weights,
            way: stray.way,
            depth: (offset + stray.depth).min(PULL * offset),
            stiffness: 0.25 * model.contact.stiffness * area,
            x,
        }))
    }

    /// Pairs of vertices that the contacts in reach couple.
    pub fn couples(&self) -> Vec<[u32; 2]> {
        let mut pairs = Vec::new();
        for contact in &self.active {
            let v = contact.vertices;
            pairs.extend((0..4).flat_map(|i| (0..i).map(move |j| [v[i], v[j]])));
        }
        pairs
    }

    /// Remembers what presses after a step.
    pub fn settle(&self, model: &Model, state: &mut State) {
        let mut held = Vec::new();
        for contact in &self.active {
            let Some(pair) = contact.pair else { continue };
            let between = contact.between(&state.positions);
            let force = contact.law.normal_force(&contact.plane, between);
            if force > 0.0 && contact.law.friction > 0.0 {
                let anchor = contact.law.slide(&contact.plane, between, force);
                let slip = between - anchor;
                let n = contact.plane.normal;
                held.push(ContactFrictionState {
                    pair,
                    slip: slip - n * slip.dot(&n),
                    force,
                });
            }
        }
        held.sort_unstable_by_key(|held| held.pair);
        state.cloth.held = held;
        self.remember(state);
        if model.contact.cloth_offset > 0.0 {
            state.cloth.places.clone_from(&state.positions);
        }
    }

    /// Corrects a motion so that cloth does not pass through cloth on the way.
    pub fn keep_apart(&mut self, model: &Model, motion: &mut Motions) -> ImpactStats {
        if model.contact.cloth_offset <= 0.0 {
            return ImpactStats::default();
        }
        self.surface(model);
        let clearance = Self::clearance(model.contact.cloth_offset);
        let knots = Knots {
            tangled: &self.tangled,
            astray: &self.astray,
            loose: &self.loose,
            layer: &model.layer,
        };
        let kept = super::bound::keep_apart(&mut self.surface, knots, motion, clearance);
        self.tally.impulses += kept.impulses;
        self.tally.zoned += kept.zoned;
        self.tally.cut += kept.cut;
        kept
    }

    /// Shortens moves so that cloth does not pass through cloth on the way; returns the number of
    /// vertices held back.
    pub fn bound(&mut self, model: &Model, x: &[Vec3], moves: &mut [Vec3]) -> usize {
        if model.contact.cloth_offset <= 0.0 {
            return 0;
        }
        self.surface(model);
        let knots = Knots {
            tangled: &self.tangled,
            astray: &self.astray,
            loose: &self.loose,
            layer: &model.layer,
        };
        super::bound::bound_moves(&mut self.surface, knots, x, moves)
    }
}
