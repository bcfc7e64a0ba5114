//! Running a scene: all deformable objects in one model, stepped in time or led to rest.

use crate::collision::Tally;
use crate::laws::elastic::ElasticLaw;
use crate::measure::{Measures, measure};
use crate::merge::{joinable, merged_layers, merged_motion};
use crate::method::Method;
use crate::methods::whole_energy;
use crate::scene::{ObjectKind, Scene, SceneEnd};
use crate::{
    Cloth, Collider, Control, DrapeError, Elastic, ElasticEnd, Grip, State, System, SystemBuilder,
    Workspace, merge_map,
};
use std::sync::Arc;
use toile_geometry::{SurfaceTree, TriangleMesh};

/// A scene on its way.
pub struct SceneRun {
    /// The model of the present structure.
    pub system: System,
    /// The state.
    pub state: State,
    scene: Scene,
    cloth: Cloth,
    /// First vertex of each object in the cloth as loaded; nothing for solid ones.
    first: Vec<Option<u32>>,
    /// Present vertex of every vertex as loaded.
    target: Vec<u32>,
    pins: Vec<u32>,
    /// Elastics still acting, as indices into the scene's.
    acting: Vec<usize>,
    workspace: Workspace,
    method: Box<dyn Method>,
    steps: usize,
    split_steps: usize,
    refinements: usize,
    /// What methods counted before the last merging.
    tally: Option<Tally>,
}

/// Steps between two looks for cloth that crosses a body between its samples, and how often it may
/// be tested more finely.
const STEPS_TO_REFINE: usize = 4;
const MOST_REFINEMENTS: usize = 24;

impl SceneRun {
    /// Builds the model of a scene.
    ///
    /// # Errors
    /// Whatever [`Scene::check`] and [`Model::new`] refuse, and a scene without cloth.
    pub fn new(scene: Scene) -> Result<Self, DrapeError> {
        scene.check()?;
        let mut cloth = Cloth::default();
        let (mut first, mut pins) = (Vec::new(), Vec::new());
        for object in &scene.objects {
            let ObjectKind::Deformable {
                material,
                pins: own,
            } = &object.kind
            else {
                first.push(None);
                continue;
            };
            let start = cloth.positions.len() as u32;
            first.push(Some(start));
            pins.extend(own.iter().map(|pin| pin + start));
            let part = match &object.cloth {
                Some(part) => part.clone(),
                None => Cloth::from_mesh(&object.name, &object.mesh, material.clone())?,
            };
            append(&mut cloth, part);
        }
        for material in &mut cloth.materials {
            material.stiffness_damping += scene.damping.stiffness;
        }
        if cloth.triangles.is_empty() {
            return Err(DrapeError::Scene {
                place: "objects".to_owned(),
                what: "no deformable object has any triangle".to_owned(),
                remedy: "add an object of kind \"deformable\"".to_owned(),
            });
        }
        let target = (0..cloth.positions.len() as u32).collect();
        let acting = (0..scene.elastics.len()).collect();
        let system = System::new("scene", &cloth)?;
        let mut run = Self {
            state: State::at_rest(&system, cloth.positions.clone()),
            system,
            method: scene.method.build(),
            workspace: Workspace::default(),
            scene,
            cloth,
            first,
            target,
            pins,
            acting,
            steps: 0,
            split_steps: 0,
            refinements: 0,
            tally: None,
        };
        run.furnish();
        Ok(run)
    }

    /// Gives the present cloth its solids, pins, elastics and what acts on it.
    fn furnish(&mut self) {
        let mut builder = self.system.edit();
        if builder.colliders.is_empty() {
            builder.colliders = self.solids();
        }
        builder.contact = self.scene.contact.for_cloth(&self.cloth.materials);
        builder.layer = self.layers();
        builder.control = Control {
            gravity: self.scene.gravity,
            air_drag: self.scene.air.drag + self.scene.damping.mass,
            air: self.scene.air,
            ..Control::default()
        };
        for &pin in &self.pins {
            builder.pinned[self.target[pin as usize] as usize] = true;
        }
        builder.grips = self.grips();
        for grip in &builder.grips {
            builder.pinned[grip.vertex as usize] = true;
        }
        let acting = self.acting.iter();
        builder.elastics = acting.filter_map(|&e| self.elastic(e)).collect();
        self.system = builder.build();
    }

    /// The solid objects of the scene.
    fn solids(&self) -> Vec<Collider> {
        let surface = |mesh: &TriangleMesh| Arc::new(SurfaceTree::new(mesh.clone()));
        let solids = self.scene.objects.iter().filter_map(|o| match &o.kind {
            ObjectKind::Static => Some(Collider::new(surface(&o.mesh))),
            ObjectKind::Animated { motion } => {
                Some(Collider::moving(surface(&o.mesh), motion.clone()))
            }
            ObjectKind::Deformable { .. } => None,
        });
        solids.collect()
    }

    /// Pairs of cloths that elastics have merged vertices of, as indices into the scene's objects.
    pub fn sewn_objects(&self) -> Vec<[usize; 2]> {
        let mut owner: Vec<Option<usize>> = vec![None; self.system.vertex_count()];
        let mut pairs = Vec::new();
        for (index, object) in self.scene.objects.iter().enumerate() {
            let Some(first) = self.first[index] else {
                continue;
            };
            let own = first as usize..first as usize + object.mesh.positions.len();
            for &vertex in &self.target[own] {
                match owner[vertex as usize].replace(index) {
                    Some(other) if other != index => pairs.push([other, index]),
                    _ => {}
                }
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }

    /// Layer of each present vertex; empty where all are of one.
    fn layers(&self) -> Vec<u16> {
        let mut layers = Vec::with_capacity(self.target.len());
        for (object, first) in self.scene.objects.iter().zip(&self.first) {
            if first.is_some() {
                layers.resize(layers.len() + object.mesh.positions.len(), object.layer);
            }
        }
        if layers.windows(2).all(|pair| pair[0] == pair[1]) {
            return Vec::new();
        }
        merged_layers(&layers, &self.target, self.system.vertex_count())
    }

    fn grips(&self) -> Vec<Grip> {
        let mut grips = Vec::new();
        for grip in &self.scene.grips {
            let Some(first) = self.first[grip.object] else {
                continue;
            };
            let motion = Arc::new(grip.motion.clone());
            let mesh = &self.scene.objects[grip.object].mesh;
            grips.extend(grip.vertices.iter().map(|&v| Grip {
                vertex: self.target[(first + v) as usize],
                home: mesh.positions[v as usize],
                motion: motion.clone(),
            }));
        }
        grips
    }

    /// A vertex of the present structure, or a place.
    fn end(&self, end: SceneEnd) -> ElasticEnd {
        match end {
            SceneEnd::Point(point) => ElasticEnd::Point(point),
            SceneEnd::Vertex { object, vertex } => match self.first[object] {
                Some(first) => ElasticEnd::Vertex(self.target[(first + vertex) as usize]),
                None => {
                    ElasticEnd::Point(self.scene.objects[object].mesh.positions[vertex as usize])
                }
            },
        }
    }

    fn elastic(&self, index: usize) -> Option<Elastic> {
        let elastic = &self.scene.elastics[index];
        let law = ElasticLaw {
            stiffness: elastic.stiffness,
            largest_force: f64::INFINITY,
        };
        match (self.end(elastic.from), self.end(elastic.to)) {
            (ElasticEnd::Vertex(a), ElasticEnd::Vertex(b)) if a == b => None,
            (ElasticEnd::Vertex(from), to) | (to, ElasticEnd::Vertex(from)) => {
                Some(Elastic { from, to, law })
            }
            // Two fixed places: nothing moves.
            _ => None,
        }
    }

    /// Whether the duration is over, or rest is reached.
    pub fn finished(&self) -> bool {
        if self.scene.method.kind.is_equilibrium() {
            return self.method.finished();
        }
        self.steps as f64 * self.scene.step >= self.scene.duration - 1e-9 * self.scene.step
    }

    /// Share of the way, 0..=1.
    pub fn share(&self) -> f64 {
        match self.method.residual() {
            Some(residual) => ((1.0 / residual.max(1e-3)).log10() / 3.0).clamp(0.0, 1.0),
            None if self.scene.duration > 0.0 => {
                (self.steps as f64 * self.scene.step / self.scene.duration).min(1.0)
            }
            None => 1.0,
        }
    }

    /// Steps taken.
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// Steps that had to be cut into smaller ones.
    pub fn split_steps(&self) -> usize {
        self.split_steps
    }

    /// Takes one step, then merges what elastics have drawn together.
    ///
    /// # Errors
    /// When a step fails at every size; the state is the last good one.
    pub fn advance(&mut self) -> Result<(), DrapeError> {
        let report = self
            .method
            .advance(&self.system, &mut self.state, self.scene.step)?;
        self.split_steps += usize::from(report.pieces > 1);
        self.steps += 1;
        if self.steps.is_multiple_of(STEPS_TO_REFINE) {
            self.refine();
        }
        self.merge_close()
    }

    /// Tests contact more finely where cloth crosses a body although its corners keep off: where a
    /// body is too sharp for the triangles on it.
    fn refine(&mut self) {
        if self.system.colliders.is_empty() || self.refinements >= MOST_REFINEMENTS {
            return;
        }
        let mesh = self.system.mesh(&self.state.positions);
        let mut found: Vec<u32> = Vec::new();
        for collider in self.system.colliders.iter() {
            let pose = collider.pose(self.state.time);
            let clear = |&v: &u32| {
                let place = self.state.positions[v as usize];
                let off = 0.5 * self.system.contact.offset;
                collider.exact_distance(pose.as_ref(), place) > off
            };
            let pairs = collider.crossings(self.state.time, &mesh);
            let crossing = pairs.iter().map(|pair| pair[0]);
            found.extend(crossing.filter(|&t| mesh.triangles[t as usize].iter().all(clear)));
        }
        found.sort_unstable();
        found.dedup();
        self.refinements += usize::from(!found.is_empty());
        for triangle in found {
            self.state.refine_contact(&self.system, triangle);
        }
    }

    /// What contact of cloth with cloth found and did, where the method counts it.
    pub fn cloth_tally(&self) -> Option<Tally> {
        match (self.tally, self.method.cloth_tally()) {
            (Some(before), Some(now)) => Some(before.then(now)),
            (before, now) => before.or(now),
        }
    }

    /// Merges the ends of elastics that are close enough: [`merged_motion`] says where they meet. Two
    /// vertices that are held become one only where both are pinned at one place.
    fn merge_close(&mut self) -> Result<(), DrapeError> {
        let (held, gripped) = self.held();
        let x = &self.state.positions;
        let ends = |index: usize| self.vertex_ends(index);
        let close = |&index: &usize| {
            let within = self.scene.elastics[index].merge_within?;
            let [a, b] = ends(index)?;
            ((x[a as usize] - x[b as usize]).norm() <= within).then_some([a, b])
        };
        let together = |a: u32, b: u32| {
            let [a, b] = [a as usize, b as usize];
            x[a] == x[b] && !gripped[a] && !gripped[b]
        };
        let pairs = joinable(self.acting.iter().filter_map(close), &held, together);
        if pairs.is_empty() {
            return Ok(());
        }
        let (map, count) = merge_map(self.state.positions.len(), pairs);
        let one =
            |&index: &usize| ends(index).is_some_and(|[a, b]| map[a as usize] == map[b as usize]);
        let acting: Vec<usize> = (self.acting.iter().copied())
            .filter(|index| !one(index))
            .collect();
        let mass = self.system.cloth_mass();
        let (positions, velocities) = merged_motion(
            (&self.state.positions, &self.state.velocities),
            &mass,
            &held,
            (&map, count),
        );
        self.cloth.positions.clone_from(&self.state.positions);
        let mut merged = self.cloth.merged(&map, count);
        merged.positions = positions;
        let mut builder = SystemBuilder::new("scene", &merged)?;
        builder.colliders = self.system.colliders.to_vec();
        self.acting = acting;
        self.system = builder.build();
        let time = self.state.time;
        let settled = std::mem::take(&mut self.state.settled);
        self.state = State::at_rest(&self.system, merged.positions.clone());
        self.state.time = time;
        self.state.velocities = velocities;
        // A triangle whose corners became one is gone: then nothing remembers.
        if settled.len() == self.system.topology.triangles.len() {
            self.state.settled = settled;
        }
        self.cloth = merged;
        self.refinements = 0;
        for target in &mut self.target {
            *target = map[*target as usize];
        }
        self.workspace = Workspace::default();
        self.tally = self.cloth_tally();
        self.method = self.scene.method.build();
        self.furnish();
        Ok(())
    }

    /// Which vertices pins or grips hold, and which of them grips.
    fn held(&self) -> (Vec<bool>, Vec<bool>) {
        let mut gripped = vec![false; self.state.positions.len()];
        for grip in &self.system.prescribed.grips {
            gripped[grip.vertex as usize] = true;
        }
        let mut held = gripped.clone();
        for &pin in &self.pins {
            held[self.target[pin as usize] as usize] = true;
        }
        (held, gripped)
    }

    /// The present vertices that an elastic joins, where both its ends are of cloth.
    fn vertex_ends(&self, index: usize) -> Option<[u32; 2]> {
        let elastic = &self.scene.elastics[index];
        match [elastic.from, elastic.to].map(|end| self.end(end)) {
            [ElasticEnd::Vertex(a), ElasticEnd::Vertex(b)] => Some([a, b]),
            _ => None,
        }
    }

    /// Surface of every object as it lies now, in the order of the scene.
    pub fn meshes(&self) -> Vec<TriangleMesh> {
        self.scene
            .objects
            .iter()
            .zip(&self.first)
            .map(|(object, first)| match first {
                None => {
                    let mut mesh = object.mesh.clone();
                    if let ObjectKind::Animated { motion } = &object.kind {
                        let pose = motion.pose(self.state.time);
                        for place in &mut mesh.positions {
                            *place = pose.apply(*place);
                        }
                    }
                    mesh
                }
                Some(first) => TriangleMesh {
                    positions: (0..object.mesh.positions.len())
                        .map(|v| self.state.positions[self.target[*first as usize + v] as usize])
                        .collect(),
                    triangles: object.mesh.triangles.clone(),
                },
            })
            .collect()
    }

    /// The scene as it was given.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Largest gap of an elastic that still acts [m].
    pub fn elastic_gap(&self) -> f64 {
        let gap = |elastic: Elastic| elastic.gap(&self.state.positions).norm();
        self.system.elastics().map(gap).fold(0.0, f64::max)
    }

    /// Energy of motion, strain, weight, elastics and contact [J]; heights count from the origin.
    pub fn energy(&mut self) -> f64 {
        whole_energy(&self.system, &self.state, &mut self.workspace)
    }

    /// Pairs of cloth triangles that intersect and share no vertex, exactly.
    pub fn crossings(&self) -> usize {
        let mesh = self.system.mesh(&self.state.positions);
        SurfaceTree::new(mesh).self_intersections().len()
    }

    /// Net force over weight of a state measured, where that says how far from rest it is.
    pub fn residual_of(&self, measures: &Measures) -> Option<f64> {
        let balances = self.scene.method.kind.balances_forces();
        balances.then_some(measures.residual)
    }

    /// Measures the present state.
    pub fn measure(&mut self) -> Measures {
        measure(&self.system, &self.state, &mut self.workspace, &[])
    }
}

/// Adds a part's vertices, triangles and materials to a cloth.
fn append(cloth: &mut Cloth, part: Cloth) {
    let vertex = cloth.positions.len() as u32;
    let material = cloth.materials.len() as u16;
    cloth.positions.extend(part.positions);
    cloth
        .triangles
        .extend(part.triangles.iter().map(|t| t.map(|v| v + vertex)));
    cloth.rest.extend(part.rest);
    cloth
        .material
        .extend(part.material.iter().map(|m| m + material));
    let panel = cloth.panel.iter().max().map_or(0, |p| p + 1);
    cloth.panel.extend(part.panel.iter().map(|p| p + panel));
    cloth.materials.extend(part.materials);
}
