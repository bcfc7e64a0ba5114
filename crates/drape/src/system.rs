//! The simulated system: a constant model and the control of the present step; and its builder.
//!
//! # Decided with
//! - [`crate::model::Model`], [`crate::control::Control`]: what is constant; what may change from step to
//!   step;
//! - [`crate::environment::Environment`], [`crate::world::World::furnish`] (`compile.rs`): what a world gives
//!   to its system;
//! - [`crate::scene::Scene::environment`], [`crate::garment::GarmentSetup::worn_environment`]: environment of
//!   a scene, of a worn garment;
//! - [`crate::submodel::SubModel::new`]: the same parts of a region of the cloth;
//! - [`crate::model::ModelParts::has_cloth_of`]: what is compared to keep caches.

use crate::bending_structure::BendingStructure;
use crate::caps::{exchange_again, without_caps};
use crate::collider::{Collider, PrescribedVertex};
use crate::control::{Attachment, Control};
use crate::elastic::{Elastic, ElasticCouplings, ElasticEnd};
use crate::laws::elastic::ElasticLaw;
use crate::material::MaterialLaws;
use crate::materials::Materials;
use crate::model::{Model, ModelParts, Prescribed};
use crate::pair_policies::PairPolicies;
use crate::rest_data::RestData;
use crate::topology::Topology;
use crate::{Cloth, ContactSettings, DrapeError};
use std::ops::Deref;
use std::sync::Arc;
use toile_geometry::Vec2;

/// A model and the control of the present step. The control may change between steps; a change of structure is a new
/// model.
#[derive(Clone)]
pub struct System {
    /// The constant part.
    pub model: Model,
    /// Loads and attachments of the present step.
    pub control: Control,
}

impl Deref for System {
    type Target = Model;

    fn deref(&self) -> &Model {
        &self.model
    }
}

impl System {
    /// A free cloth under gravity.
    ///
    /// # Errors
    /// Bad indices, triangles without area, materials that cannot be simulated; the message names `object`.
    pub fn new(object: &str, cloth: &Cloth) -> Result<Self, DrapeError> {
        Ok(SystemBuilder::new(object, cloth)?.build())
    }

    /// A builder with the data of this system, for one that differs in some of them; unchanged parts of the model are
    /// shared.
    pub fn edit(&self) -> SystemBuilder {
        SystemBuilder {
            pinned: self.prescribed.pinned.clone(),
            led: self.prescribed.led.clone(),
            elastics: self.elastics().collect(),
            colliders: self.colliders.to_vec(),
            contact: self.contact,
            layer: self.layer.to_vec(),
            policies: PairPolicies::clone(&self.policies),
            control: self.control.clone(),
            topology: self.topology.clone(),
            rest: self.rest.clone(),
            materials: self.materials.clone(),
            from: Some(self.model.clone()),
        }
    }

    /// The system after a change of its builder.
    #[must_use]
    pub fn with(&self, change: impl FnOnce(&mut SystemBuilder)) -> Self {
        let mut builder = self.edit();
        change(&mut builder);
        builder.build()
    }

    /// The system with other rest shapes for the triangles of [`Topology::surface_triangles`], in the same order (m).
    /// The topology is shared; at the first change it is replaced by one with a structure of bending.
    ///
    /// # Errors
    /// A wrong number of shapes, one without area, and [`DrapeError::NeedsRemesh`] for ill-conditioned ones; the
    /// message names `object`.
    pub fn reshaped(&self, object: &str, rest: Vec<[Vec2; 3]>) -> Result<Self, DrapeError> {
        let count = self.topology.triangles.len();
        if rest.len() != count {
            return Err(DrapeError::Scene {
                place: object.to_owned(),
                what: format!("{} rest shapes are given for {count} triangles", rest.len()),
                remedy: "give one for each triangle".to_owned(),
            });
        }
        let rest = exchange_again(rest, &self.topology.exchanges)?;
        let structured = match &self.topology.bending {
            Some(_) => self.model.clone(),
            None => self.with_bending_structure()?,
        };
        let topology = &structured.topology;
        let rest = (structured.rest).reshaped(object, topology, &rest, &self.materials)?;
        Ok(Self {
            model: Model::of(ModelParts {
                rest: Arc::new(rest),
                ..ModelParts::clone(&structured)
            }),
            control: self.control.clone(),
        })
    }

    /// The model with a structure of bending in its topology, which suits the present rest shapes.
    fn with_bending_structure(&self) -> Result<Model, DrapeError> {
        let (triangles, shapes) = (&self.topology.triangles, self.rest.shapes());
        let (structure, curvatures) =
            BendingStructure::new(self.vertex_count(), triangles, &shapes)?;
        let topology = Topology {
            bending: Some(Arc::new(structure)),
            ..Topology::clone(&self.topology)
        };
        let rest = RestData {
            curvatures,
            ..RestData::clone(&self.rest)
        };
        Ok(Model::of(ModelParts {
            topology: Arc::new(topology),
            rest: Arc::new(rest),
            ..ModelParts::clone(&self.model)
        }))
    }

    /// Replaces the elastics between vertices; all other parts of the model stay shared.
    pub fn couple(&mut self, between: Vec<([u32; 2], ElasticLaw)>) {
        self.model = Model::of(ModelParts {
            couplings: Arc::new(ElasticCouplings::new(self.vertex_count(), between)),
            ..ModelParts::clone(&self.model)
        });
    }

    /// All elastics: those between vertices, then the attachments.
    pub fn elastics(&self) -> impl Iterator<Item = Elastic> + '_ {
        let between = (self.couplings.all.iter()).map(|&([from, to], law)| Elastic {
            from,
            to: ElasticEnd::Vertex(to),
            law,
        });
        let to_points = (self.control.attachments.all().iter()).map(|attachment| Elastic {
            from: attachment.vertex,
            to: ElasticEnd::Point(attachment.place),
            law: attachment.law,
        });
        between.chain(to_points)
    }

    /// Number of elastics.
    pub(crate) fn elastic_count(&self) -> usize {
        self.couplings.all.len() + self.control.attachments.all().len()
    }

    /// Elastics at a vertex, as indices into [`Self::elastics`], with their other ends.
    #[inline]
    pub fn elastics_at(&self, v: usize) -> impl Iterator<Item = (usize, ElasticEnd)> + '_ {
        let between = self.couplings.at(v).iter().map(move |&e| {
            let (ends, _) = self.couplings.all[e as usize];
            let other = ends[usize::from(ends[0] as usize == v)];
            (e as usize, ElasticEnd::Vertex(other))
        });
        let (first, at_vertex) = self.control.attachments.at(v);
        let first = self.couplings.all.len() + first;
        let to_points = (first..).zip(at_vertex);
        between.chain(to_points.map(|(e, attachment)| (e, ElasticEnd::Point(attachment.place))))
    }

    /// The law of one of [`Self::elastics`].
    #[inline]
    pub fn elastic_law(&self, index: usize) -> ElasticLaw {
        match self.couplings.all.get(index) {
            Some((_, law)) => *law,
            None => self.control.attachments.all()[index - self.couplings.all.len()].law,
        }
    }

    /// Sum of the stiffnesses of the elastics at a vertex at small gaps (N/m).
    pub fn elastic_stiffness(&self, v: usize) -> f64 {
        let between = self.couplings.at(v).iter();
        let between = between.map(|&e| self.couplings.all[e as usize].1.stiffness);
        let to_points = self.control.attachments.at(v).1.iter();
        between
            .chain(to_points.map(|attachment| attachment.law.stiffness))
            .sum()
    }
}

/// A builder of a system from a cloth, pins, elastics, solids, contact settings and control.
pub struct SystemBuilder {
    /// Pinned vertices; at first those on no triangle.
    pub pinned: Vec<bool>,
    /// Pinned vertices on a prescribed motion; only XPBD moves them.
    pub led: Vec<PrescribedVertex>,
    /// Elastics between vertices and to fixed points.
    pub elastics: Vec<Elastic>,
    /// Solid surfaces.
    pub colliders: Vec<Collider>,
    /// Contact settings.
    pub contact: ContactSettings,
    /// Layer of each vertex, larger numbers farther out, or
    /// [`BETWEEN_LAYERS`](crate::collision::BETWEEN_LAYERS); empty where all have the same.
    pub layer: Vec<u16>,
    /// Pairs of objects that ignore each other; at first none.
    pub policies: PairPolicies,
    /// The control at first; its attachments are replaced by the fixed-point ones of `elastics`.
    pub control: Control,
    topology: Arc<Topology>,
    rest: Arc<RestData>,
    materials: Arc<Materials>,
    /// The model it was made from, whose unchanged parts are shared.
    from: Option<Model>,
}

impl SystemBuilder {
    /// A free cloth under gravity.
    ///
    /// # Errors
    /// Bad indices, triangles without area, materials that cannot be simulated; the message names `object`.
    pub fn new(object: &str, cloth: &Cloth) -> Result<Self, DrapeError> {
        let mesh = cloth.mesh();
        mesh.check().map_err(|defect| DrapeError::Mesh {
            object: object.to_owned(),
            defect,
        })?;
        for material in &cloth.materials {
            material.check(object)?;
        }
        let (cloth, exchanges) = without_caps(cloth);
        let materials = Materials::new(cloth.materials.clone(), cloth.material.clone());
        let topology = Topology::new(cloth.positions.clone(), cloth.triangles.clone())
            .with_exchanges(mesh.triangles, exchanges);
        let rest = RestData::new(object, &topology, &cloth.rest, &materials)?;
        let mut builder = Self {
            pinned: vec![true; cloth.positions.len()],
            led: Vec::new(),
            elastics: Vec::new(),
            colliders: Vec::new(),
            contact: ContactSettings::default(),
            layer: Vec::new(),
            policies: PairPolicies::default(),
            control: Control::default(),
            topology: Arc::new(topology),
            rest: Arc::new(rest),
            materials: Arc::new(materials),
            from: None,
        };
        builder.release();
        Ok(builder)
    }

    /// Unpins all vertices but those on no triangle.
    pub(crate) fn release(&mut self) {
        self.pinned.fill(true);
        for sample in self.rest.samples.iter() {
            self.pinned[sample.vertices[0] as usize] = false;
        }
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.pinned.len()
    }

    /// Enlarges the contact offset of outer layers from solids, by `apart` (m) for each layer inside of them; `layer`
    /// has the layer of each vertex, or is empty.
    pub(crate) fn offset_layers(&mut self, layer: &[u16], apart: f64) {
        let mut layers = layer.to_vec();
        layers.sort_unstable();
        layers.dedup();
        let mut samples = self.rest.samples.to_vec();
        for sample in &mut samples {
            let own = layer.get(sample.vertices[0] as usize);
            let below = own.map_or(0, |own| layers.partition_point(|other| other < own));
            sample.extra_offset = below as f64 * apart;
        }
        let rest = RestData {
            samples: Arc::new(samples),
            ..(*self.rest).clone()
        };
        self.rest = Arc::new(rest);
    }

    /// The system.
    pub fn build(self) -> System {
        let mut between = Vec::new();
        let mut attachments = Vec::new();
        for Elastic { from, to, law } in self.elastics {
            match to {
                ElasticEnd::Vertex(to) => between.push(([from, to], law)),
                ElasticEnd::Point(place) => attachments.push(Attachment {
                    vertex: from,
                    place,
                    law,
                }),
            }
        }
        let couplings = ElasticCouplings::new(self.pinned.len(), between);
        let prescribed = Prescribed {
            pinned: self.pinned,
            led: self.led,
        };
        let from = self.from.as_ref();
        let parts = ModelParts {
            topology: self.topology,
            rest: self.rest,
            materials: self.materials,
            prescribed: shared(from.map(|m| &m.prescribed), prescribed),
            couplings: shared(from.map(|m| &m.couplings), couplings),
            colliders: match from {
                Some(m) if same_colliders(&m.colliders, &self.colliders) => m.colliders.clone(),
                _ => Arc::new(self.colliders),
            },
            contact: self.contact,
            layer: shared(from.map(|m| &m.layer), self.layer),
            policies: shared(from.map(|m| &m.policies), self.policies),
        };
        System {
            model: Model::of(parts),
            control: Control {
                attachments: attachments.into_iter().collect(),
                ..self.control
            },
        }
    }
}

/// A part of a model: the former one where it is equal.
fn shared<T: PartialEq>(former: Option<&Arc<T>>, new: T) -> Arc<T> {
    match former {
        Some(former) if **former == new => former.clone(),
        _ => Arc::new(new),
    }
}

fn same_colliders(former: &[Collider], new: &[Collider]) -> bool {
    former.len() == new.len() && former.iter().zip(new).all(|(a, b)| a.is_same(b))
}
