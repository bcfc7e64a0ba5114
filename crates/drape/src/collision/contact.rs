//! Contact of cloth with cloth: the laws of contact with a surface, on the vector between two
//! features in place of the point.

use super::bound::{Kept, Motions, REACH_OF_WAYS, features_within, reach_of};
use super::curvature::{Clearance, longest};
use super::proximity::{Nearness, nearnesses};
use super::surface::{ClothSurface, FeaturePair};
use super::tangle::{Piercing, crossings, piercings};
use crate::laws::contact::{ContactLaw, ContactPlane};
use crate::{Model, State};
use nalgebra::Matrix3;
use toile_geometry::Vec3;

/// A contact of two features.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClothContact {
    /// The four vertices.
    pub vertices: [u32; 4],
    /// Their weights; they sum to zero.
    pub weights: [f64; 4],
    /// The plane; its point is the vector from the second feature to the first.
    pub plane: ContactPlane,
    /// The laws.
    pub law: ContactLaw,
    /// The features; none for a crossing that is being undone.
    pub pair: Option<FeaturePair>,
}

impl ClothContact {
    /// The vector between the features.
    pub fn between(&self, x: &[Vec3]) -> Vec3 {
        let four = self.vertices.into_iter().zip(self.weights);
        four.map(|(v, w)| x[v as usize] * w).sum()
    }
}

/// What a contact remembers from step to step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Held {
    /// The features.
    pub pair: FeaturePair,
    /// How far they have slid against each other since they stuck [m].
    pub slip: Vec3,
    /// Normal force in the last step [N].
    pub force: f64,
}

/// What contact of cloth with cloth remembers of the last step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ClothMemory {
    /// Positions then [m].
    pub places: Vec<Vec3>,
    /// Contacts that pressed, in order of their features.
    pub held: Vec<Held>,
}

/// What was found and done so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Looks.
    pub looks: usize,
    /// Edges that crossed a face: at the first look, most at one look, at the last look.
    pub crossings: [usize; 3],
    /// Impulses that kept features from passing through each other between looks.
    pub impulses: usize,
    /// Moves of vertices that were cut because impulses were not enough.
    pub cut: usize,
}

impl Tally {
    fn look(&mut self, crossings: usize) {
        if self.looks == 0 {
            self.crossings[0] = crossings;
        }
        self.looks += 1;
        self.crossings[1] = self.crossings[1].max(crossings);
        self.crossings[2] = crossings;
    }

    /// With another's counts after these.
    #[must_use]
    pub fn then(self, next: Self) -> Self {
        if self.looks == 0 || next.looks == 0 {
            return if self.looks == 0 { next } else { self };
        }
        Self {
            looks: self.looks + next.looks,
            crossings: [
                self.crossings[0],
                self.crossings[1].max(next.crossings[1]),
                next.crossings[2],
            ],
            impulses: self.impulses + next.impulses,
            cut: self.cut + next.cut,
        }
    }
}

/// Contacts of the present positions.
#[derive(Clone, Debug, Default)]
pub struct ClothContacts {
    /// The contacts.
    pub active: Vec<ClothContact>,
    /// Pairs of an edge and a face that cross.
    pub piercings: usize,
    /// Vertices at a crossing.
    pub tangled: Vec<bool>,
    /// What was found and done so far.
    pub tally: Tally,
    surface: ClothSurface,
    near: Vec<[u32; 2]>,
    /// Features of those as near, with their distances then [m]; found when asked for.
    features: Option<Vec<(FeaturePair, f64)>>,
    near_at: Vec<Vec3>,
    near_reach: f64,
}

/// Contacts are kept from this many offsets away, so that a step is stopped before it lands.
const REACH_IN_OFFSETS: f64 = 2.0;

/// How much farther pairs of triangles are looked for, so that they serve for some time [m].
const SLACK: f64 = 2e-3;

/// How far vertices may go meanwhile [m].
const STRAY: f64 = 0.5 * SLACK;

/// How far impulses may change a motion before what may meet in it is looked for anew, as a share of
/// how far it strays from its mean.
const OFF: f64 = 0.25;

/// How far an edge that pierces a face is pulled at a time, in offsets: by less, a fold caught in a seam
/// stays there.
const PULL: f64 = 2.0;

impl ClothContacts {
    /// What regions that are left out must keep, for cloth that is kept `offset` [m] apart.
    pub fn clearance(offset: f64) -> Clearance {
        Clearance {
            stray: STRAY,
            kept: offset,
        }
    }

    /// The surface in hand, made anew for another model.
    pub fn surface(&mut self, model: &Model) -> &mut ClothSurface {
        let stale = {
            let given = model.surface_triangles();
            self.surface.triangles != given || self.surface.room.len() != model.vertex_count()
        };
        if stale {
            self.surface = ClothSurface::new(model);
            self.near_at.clear();
        }
        &mut self.surface
    }

    /// Pairs of triangles near each other at some positions, found anew only when the cloth has
    /// moved too far for the last ones.
    fn look(&mut self, model: &Model, x: &[Vec3], reach: f64) {
        self.surface(model);
        let moved = |(a, b): (&Vec3, &Vec3)| (a - b).norm();
        let fresh = self.near_at.len() == x.len()
            && self.near_reach >= reach
            && longest(self.near_at.iter().zip(x).map(moved)) < STRAY;
        if !fresh {
            let clearance = Self::clearance(model.contact.cloth_offset);
            self.near = (self.surface).near_unless_clear(x, x, reach + SLACK, clearance);
            self.features = None;
            self.near_at.clear();
            self.near_at.extend_from_slice(x);
            self.near_reach = reach;
        }
    }

    /// Finds contacts within `reach` [m] and crossings; what the state remembers of friction goes into them.
    pub fn find(&mut self, model: &Model, state: &State, x: &[Vec3], reach: f64) {
        self.active.clear();
        self.piercings = 0;
        self.tangled.clear();
        self.tangled.resize(x.len(), false);
        if model.contact.cloth_offset <= 0.0 {
            return;
        }
        self.look(model, x, reach);
        let crossings = crossings(&self.surface, &self.near, x);
        self.piercings = crossings.len();
        self.tally.look(self.piercings);
        for &[e, t] in &crossings {
            let face = self.surface.triangles[t as usize];
            for v in self.surface.edges[e as usize].into_iter().chain(face) {
                self.tangled[v as usize] = true;
            }
        }
        for near in nearnesses(&self.surface, &self.near, x, reach) {
            let vertices = near.pair.vertices();
            let fixed = vertices.iter().all(|&v| model.pinned[v as usize]);
            if fixed || vertices.iter().any(|&v| self.tangled[v as usize]) {
                continue;
            }
            let contact = self.contact(model, state, x, &near);
            self.active.push(contact);
        }
        for piercing in &piercings(&self.surface, &crossings, x) {
            let contact = self.way_out(model, x, piercing);
            self.active.extend(contact);
        }
    }

    /// Looks anew at the next search, so that it does not depend on what was found before.
    pub fn forget(&mut self) {
        self.near_at.clear();
    }

    /// Contacts within the usual reach.
    pub fn refresh(&mut self, model: &Model, state: &State, x: &[Vec3]) {
        self.find(
            model,
            state,
            x,
            REACH_IN_OFFSETS * model.contact.cloth_offset,
        );
    }

    fn contact(&self, model: &Model, state: &State, x: &[Vec3], near: &Nearness) -> ClothContact {
        let vertices = near.pair.vertices();
        let of = |values: &[f64]| {
            let four = vertices.iter().zip(near.weights);
            0.5 * four
                .map(|(&v, w)| values[v as usize] * w.abs())
                .sum::<f64>()
        };
        let kept = vertices.iter().map(|&v| self.surface.most_kept(v));
        let kept = kept.fold(model.contact.cloth_offset, f64::min);
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
                tangential: 0.5 * normal,
                friction,
            },
            pair: Some(near.pair),
        }
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
        if vertices.iter().all(|&v| model.pinned[v as usize]) {
            return None;
        }
        let area: f64 = vertices
            .iter()
            .map(|&v| self.surface.area[v as usize])
            .sum();
        let four = vertices.into_iter().zip(weights);
        let normal = 0.25 * model.contact.stiffness * area;
        let point = four.map(|(v, w)| x[v as usize] * w).sum();
        Some(ClothContact {
            vertices,
            weights,
            plane: ContactPlane {
                point,
                depth: PULL * model.contact.cloth_offset,
                gradient: piercing.way,
                normal: piercing.way,
                hollow: Matrix3::zeros(),
                bulge: Matrix3::zeros(),
                anchor: point,
                lagged_normal_force: 0.0,
                returning: false,
                landing: false,
            },
            law: ContactLaw {
                normal,
                tangential: normal,
                friction: 0.0,
            },
            pair: None,
        })
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
                held.push(Held {
                    pair,
                    slip: slip - n * slip.dot(&n),
                    force,
                });
            }
        }
        held.sort_unstable_by_key(|held| held.pair);
        state.cloth.held = held;
        if model.contact.cloth_offset > 0.0 {
            state.cloth.places.clone_from(&state.positions);
        }
    }

    /// Corrects a motion so that cloth does not pass through cloth on the way.
    pub fn keep_apart(&mut self, model: &Model, motion: &mut Motions) -> Kept {
        if model.contact.cloth_offset <= 0.0 {
            return Kept::default();
        }
        self.surface(model);
        self.tangled.resize(motion.x.len(), false);
        let x = motion.x;
        let since = if self.near_at.len() == x.len() {
            longest((self.near_at.iter().zip(x)).map(|(a, b)| (a - b).norm()))
        } else {
            f64::INFINITY
        };
        let Self {
            surface,
            near,
            near_at,
            features,
            near_reach,
            tangled,
            ..
        } = self;
        // The moves that the pairs in hand were looked for along, and how far off they still serve.
        let mut looked: Option<(Vec<Vec3>, f64)> = None;
        let find = |surface: &mut ClothSurface, moves: &[Vec3], pairs: &mut Vec<FeaturePair>| {
            let mean = moves.iter().sum::<Vec3>() / moves.len().max(1) as f64;
            let stray = longest(moves.iter().map(|d| (d - mean).norm()));
            let reach = 2.0 * since + reach_of(stray);
            if reach <= *near_reach + SLACK && since + stray <= STRAY {
                let all = features.get_or_insert_with(|| {
                    features_within(surface, near, near_at, *near_reach + SLACK)
                });
                let near = all.iter().filter(|(_, distance)| *distance <= reach);
                pairs.clear();
                pairs.extend(near.map(|(pair, _)| *pair));
                looked = None;
                return;
            }
            if let Some((before, off)) = &looked
                && longest(moves.iter().zip(before).map(|(d, b)| (d - b).norm())) <= *off
            {
                return;
            }
            let off = OFF * stray;
            let clearance = Clearance {
                stray: stray + off,
                kept: 0.0,
            };
            let reach = REACH_OF_WAYS + 2.0 * off;
            let target: Vec<Vec3> = x.iter().zip(moves).map(|(x, d)| x + d).collect();
            pairs.clear();
            for pair in surface.near_unless_clear(x, &target, reach, clearance) {
                surface.features(pair, |pair| pairs.push(pair));
            }
            looked = Some((moves.to_vec(), off));
        };
        let kept = super::bound::keep_apart(surface, tangled, motion, find);
        self.tally.impulses += kept.impulses;
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
        self.tangled.resize(x.len(), false);
        super::bound::bound_moves(&mut self.surface, &self.tangled, x, moves)
    }
}
