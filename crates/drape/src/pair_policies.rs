//! Policies of pairs of objects: cloths that pass through each other, and solids that a cloth passes through.
//!
//! # Decided with
//! - [`crate::world::World::policy`], [`crate::world::World::set_policy`] (`edit.rs`): the policy of a pair;
//!   changed by an edit;
//! - [`crate::scene::Scene::check_ignored`], [`crate::world::World::of_scene`]: what is refused in a scene;
//!   taken from it;
//! - [`crate::world::World::policies`] (`compile.rs`): policies by vertex and solid, for the system;
//! - [`crate::collision`] (`exemptions.rs`, `entanglement.rs`, `layers.rs`): contact, crossings and layers of
//!   cloth;
//! - [`crate::contacts`] (`find`), [`crate::xpbd`] (`contact.rs`, `of_sample`), crate `reference` (`patches/`)
//!   (`patch_contacts.rs`, `start`): contact with solids;
//! - [`crate::submodel::SubModel`], [`crate::scene_run::SceneRun::refine`]: regions of the cloth; finer
//!   samples;
//! - [`crate::measure::measure`], [`crate::measure::self_intersections`]: counts of crossings.
//!
//! Not heeded by the count of vertices on the wrong side of a layer.

/// Object number of a vertex that several objects share, as at a merged seam: it ignores none.
pub const BETWEEN_OBJECTS: u16 = u16::MAX;

/// Pairs of objects that ignore each other. A pair of features of two such objects makes no contact, no impact and no
/// recovery force; a contact sample of an object that ignores a solid makes no contact with it. The default has no
/// pair.
///
/// A feature (vertex, edge, face, or sample) belongs to the object of its vertices; one whose vertices all are
/// [`BETWEEN_OBJECTS`] belongs to none and ignores none.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PairPolicies {
    /// Object of each vertex.
    object_of_vertex: Vec<u16>,
    /// Objects of cloth that ignore each other, the smaller first, sorted.
    ignored: Vec<[u16; 2]>,
    /// Pairs of an object of cloth and the index of a solid that it ignores, sorted.
    ignored_solids: Vec<(u16, u32)>,
}

impl PairPolicies {
    /// Policies for the vertices of a model: `object_of_vertex` has the object of each or [`BETWEEN_OBJECTS`]; vertices
    /// beyond its end belong to none. `ignored` are pairs of objects in any order,
    /// an object with itself where it ignores itself; `ignored_solids` are pairs of an object and an index
    /// into [`ModelParts::colliders`](crate::ModelParts::colliders).
    pub fn new(
        object_of_vertex: Vec<u16>,
        ignored: impl IntoIterator<Item = [u16; 2]>,
        ignored_solids: impl IntoIterator<Item = (u16, u32)>,
    ) -> Self {
        let ignored = ignored.into_iter().map(|[a, b]| [a.min(b), a.max(b)]);
        let mut policies = Self {
            object_of_vertex,
            ignored: ignored.collect(),
            ignored_solids: ignored_solids.into_iter().collect(),
        };
        policies.ignored.sort_unstable();
        policies.ignored.dedup();
        policies.ignored_solids.sort_unstable();
        policies.ignored_solids.dedup();
        policies
    }

    /// Object of each vertex.
    pub fn object_of_vertex(&self) -> &[u16] {
        &self.object_of_vertex
    }

    /// Pairs of objects of cloth that ignore each other, the smaller first, sorted.
    pub fn ignored(&self) -> &[[u16; 2]] {
        &self.ignored
    }

    /// Pairs of an object of cloth and the index of a solid that it ignores, sorted.
    pub fn ignored_solids(&self) -> &[(u16, u32)] {
        &self.ignored_solids
    }

    /// The policies for a selection of vertices: vertex `v` of the result is `vertices[v]`.
    #[must_use]
    pub fn taken(&self, vertices: &[u32]) -> Self {
        if self.ignored.is_empty() && self.ignored_solids.is_empty() {
            return Self::default();
        }
        let object = |&v: &u32| self.object_of_vertex.get(v as usize).copied();
        let objects = vertices
            .iter()
            .map(|v| object(v).unwrap_or(BETWEEN_OBJECTS));
        Self {
            object_of_vertex: objects.collect(),
            ..self.clone()
        }
    }

    /// The object of a feature; none where all its vertices are [`BETWEEN_OBJECTS`].
    pub(crate) fn object_of(&self, feature: &[u32]) -> Option<u16> {
        let objects = feature
            .iter()
            .filter_map(|&v| self.object_of_vertex.get(v as usize));
        objects.copied().find(|&object| object != BETWEEN_OBJECTS)
    }

    /// Whether two features of cloth ignore each other.
    #[inline]
    pub(crate) fn ignores(&self, first: &[u32], second: &[u32]) -> bool {
        if self.ignored.is_empty() {
            return false;
        }
        let objects = self.object_of(first).zip(self.object_of(second));
        objects.is_some_and(|(a, b)| self.ignored.binary_search(&[a.min(b), a.max(b)]).is_ok())
    }

    /// The objects of cloth that an object ignores, in order.
    pub(crate) fn ignored_by(&self, object: u16) -> Vec<u16> {
        let pairs = self.ignored.iter().filter(|pair| pair.contains(&object));
        let mut others: Vec<u16> = pairs
            .map(|&[a, b]| if a == object { b } else { a })
            .collect();
        others.sort_unstable();
        others
    }

    /// The object of a contact sample on some vertices, for [`Self::ignores_solid`]; none where no object ignores a
    /// solid.
    #[inline]
    pub fn object_of_sample(&self, vertices: &[u32]) -> Option<u16> {
        if self.ignored_solids.is_empty() {
            return None;
        }
        self.object_of(vertices)
    }

    /// Whether the object of a sample ignores the solid with an index.
    #[inline]
    pub fn ignores_solid(&self, object: Option<u16>, collider: usize) -> bool {
        let ignored = &self.ignored_solids;
        object.is_some_and(|object| ignored.binary_search(&(object, collider as u32)).is_ok())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn features_belong_to_the_object_of_their_vertices() {
        let policies = PairPolicies::new(
            vec![0, 1, 2, BETWEEN_OBJECTS],
            [[1, 0], [0, 1], [2, 2]],
            [(2, 1)],
        );
        assert_eq!(policies.ignored(), [[0, 1], [2, 2]]);
        assert!(policies.ignores(&[0], &[1]) && policies.ignores(&[1, 3], &[3, 0]));
        assert!(policies.ignores(&[2], &[2, 3]), "an object with itself");
        assert!(!policies.ignores(&[0], &[2]) && !policies.ignores(&[0], &[0]));
        assert!(!policies.ignores(&[3], &[1]), "a seam meets all");
        assert!(
            !policies.ignores(&[9], &[1]),
            "so does what is of no object"
        );
        assert_eq!(policies.ignored_by(0), [1]);
        assert_eq!(policies.ignored_by(2), [2]);
        assert_eq!(policies.object_of_sample(&[3, 2, 2]), Some(2));
        assert_eq!(policies.object_of_sample(&[3; 3]), None);
        assert!(!policies.ignores_solid(None, 1));
        assert!(policies.ignores_solid(Some(2), 1) && !policies.ignores_solid(Some(2), 0));
        let taken = policies.taken(&[3, 1]);
        assert_eq!(taken.object_of_vertex(), [BETWEEN_OBJECTS, 1]);
        assert_eq!(taken.ignored(), policies.ignored());
    }

    #[test]
    fn nothing_is_ignored_by_default() {
        let none = PairPolicies::default();
        assert!(!none.ignores(&[0], &[1]));
        assert_eq!(none.object_of_sample(&[0]), None);
        assert_eq!(none.taken(&[0, 1]), none);
    }
}
