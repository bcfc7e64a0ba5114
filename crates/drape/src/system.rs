//! What is simulated: a constant model and the control of the present step; how both are made.

use crate::bending_structure::BendingStructure;
use crate::caps::{exchange_again, without_caps};
use crate::collider::{Collider, PrescribedVertex};
use crate::control::{Attachment, Control};
use crate::elastic::{Elastic, ElasticCouplings, ElasticEnd};
use crate::laws::elastic::ElasticLaw;
use crate::materials::Materials;
use crate::model::{Model, ModelParts, Prescribed};
use crate::pair_policies::PairPolicies;
use crate::rest_data::RestData;
use crate::topology::Topology;
use crate::{Cloth, ContactSettings, DrapeError};
use std::ops::Deref;
use std::sync::Arc;
use toile_geometry::Vec2;

/// A model and what acts on it in the present step. Between steps the control may change freely; another
/// structure is another model.
#[derive(Clone)]
pub struct System {
    /// The constant part.
    pub model: Model,
    /// What acts in the present step.
    pub control: Control,
}

impl Deref for System {
    type Target = Model;

    fn deref(&self) -> &Model {
        &self.model
    }
}

impl System {
    /// A cloth that hangs free on earth.
    ///
    /// # Errors
    /// Bad indices, triangles without area, materials that cannot be simulated, told as those of `object`.
    pub fn new(object: &str, cloth: &Cloth) -> Result<Self, DrapeError> {
        Ok(SystemBuilder::new(object, cloth)?.build())
    }

    /// A builder that has all of this, for a system that differs in some of it: what is left as it is
    /// shares its part of the model.
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

    /// The same but for what `change` changes of it.
    #[must_use]
    pub fn with(&self, change: impl FnOnce(&mut SystemBuilder)) -> Self {
        let mut builder = self.edit();
        change(&mut builder);
        builder.build()
    }

    /// The same with another rest shape for each triangle of [`Topology::surface_triangles`], in the same
    /// order [m]: what hangs on the triangles alone stays the same one, but that the first change keeps what
    /// curvatures are estimated from.
    ///
    /// # Errors
    /// Another number of shapes, one without area, and [`DrapeError::NeedsRemesh`] for shapes that the
    /// triangles do not serve; told as those of `object`.
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
        let kept = match &self.topology.bending {
            Some(_) => self.model.clone(),
            None => self.with_bending_structure()?,
        };
        let rest = (kept.rest).reshaped(object, &kept.topology, &rest, &self.materials)?;
        Ok(Self {
            model: Model::of(ModelParts {
                rest: Arc::new(rest),
                ..ModelParts::clone(&kept)
            }),
            control: self.control.clone(),
        })
    }

    /// The same model, its topology with the structure of bending that its rest shapes choose.
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

    /// Has other elastics between vertices; all other parts of its model stay the ones they are.
    pub fn couple(&mut self, between: Vec<([u32; 2], ElasticLaw)>) {
        self.model = Model::of(ModelParts {
            couplings: Arc::new(ElasticCouplings::new(self.vertex_count(), between)),
            ..ModelParts::clone(&self.model)
        });
    }

    /// Every elastic: those between vertices, then the attachments.
    pub fn elastics(&self) -> impl Iterator<Item = Elastic> + '_ {
        let between = (self.couplings.all.iter()).map(|&([from, to], law)| Elastic {
            from,
            to: ElasticEnd::Vertex(to),
            law,
        });
        let to_places = (self.control.attachments.all().iter()).map(|one| Elastic {
            from: one.vertex,
            to: ElasticEnd::Point(one.place),
            law: one.law,
        });
        between.chain(to_places)
    }

    /// How many elastics there are.
    pub(crate) fn elastic_count(&self) -> usize {
        self.couplings.all.len() + self.control.attachments.all().len()
    }

    /// Elastics at a vertex, as indices into [`Self::elastics`], with their other end.
    #[inline]
    pub(crate) fn elastics_at(&self, v: usize) -> impl Iterator<Item = (usize, ElasticEnd)> + '_ {
        let between = self.couplings.at(v).iter().map(move |&e| {
            let (ends, _) = self.couplings.all[e as usize];
            let other = ends[usize::from(ends[0] as usize == v)];
            (e as usize, ElasticEnd::Vertex(other))
        });
        let (first, some) = self.control.attachments.at(v);
        let first = self.couplings.all.len() + first;
        let to_places = (first..).zip(some);
        between.chain(to_places.map(|(e, one)| (e, ElasticEnd::Point(one.place))))
    }

    /// The law of one of [`Self::elastics`].
    pub(crate) fn elastic_law(&self, index: usize) -> ElasticLaw {
        match self.couplings.all.get(index) {
            Some((_, law)) => *law,
            None => self.control.attachments.all()[index - self.couplings.all.len()].law,
        }
    }

    /// Sum of the stiffnesses of the elastics at a vertex at small gaps [N/m].
    pub(crate) fn elastic_stiffness(&self, v: usize) -> f64 {
        let between = self.couplings.at(v).iter();
        let between = between.map(|&e| self.couplings.all[e as usize].1.stiffness);
        let to_places = self.control.attachments.at(v).1.iter();
        between.chain(to_places.map(|one| one.law.stiffness)).sum()
    }
}

/// A system in the making: of a cloth, its fields say what holds it, what it meets and what acts on it.
pub struct SystemBuilder {
    /// Vertices that do not move; those on no triangle from the start.
    pub pinned: Vec<bool>,
    /// Pinned vertices that are led; only XPBD leads them.
    pub led: Vec<PrescribedVertex>,
    /// Attachment forces.
    pub elastics: Vec<Elastic>,
    /// Solid surfaces.
    pub colliders: Vec<Collider>,
    /// How the cloth meets them, and itself.
    pub contact: ContactSettings,
    /// Layer of each vertex, larger numbers farther out, or
    /// [`BETWEEN_LAYERS`](crate::collision::BETWEEN_LAYERS); empty where all are of one.
    pub layer: Vec<u16>,
    /// Which objects of the cloth do not meet each other, or which of `colliders`; at first all meet.
    pub policies: PairPolicies,
    /// What acts at first; its attachments to places are those of `elastics`.
    pub control: Control,
    topology: Arc<Topology>,
    rest: Arc<RestData>,
    materials: Arc<Materials>,
    /// The model it was taken from.
    from: Option<Model>,
}

impl SystemBuilder {
    /// A cloth that hangs free on earth.
    ///
    /// # Errors
    /// Bad indices, triangles without area, materials that cannot be simulated, told as those of `object`.
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

    /// Lets every vertex go that is on a triangle.
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

    /// Keeps outer layers farther from solids than the contact settings say, each by `apart` [m] more than the
    /// one below; `layer` is that of each vertex, or empty.
    pub(crate) fn keep_layers_off(&mut self, layer: &[u16], apart: f64) {
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

/// A part of a model: the one it had, where that says the same.
fn shared<T: PartialEq>(had: Option<&Arc<T>>, now: T) -> Arc<T> {
    match had {
        Some(had) if **had == now => had.clone(),
        _ => Arc::new(now),
    }
}

fn same_colliders(had: &[Collider], now: &[Collider]) -> bool {
    had.len() == now.len() && had.iter().zip(now).all(|(a, b)| a.is_same(b))
}
