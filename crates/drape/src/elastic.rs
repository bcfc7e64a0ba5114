//! Elastics: springs from a vertex to another vertex or to a point in space.
//!
//! # Decided with
//! - [`crate::laws::elastic::ElasticLaw`]: linear up to a largest force, then constant;
//! - [`crate::system::System::couple`], [`crate::system::System::elastics_at`]: elastics and hands in a
//!   system;
//! - [`crate::sew::SewRun::set_elastics`]: stiffness and largest force while a garment is sewn, and how they
//!   grow;
//! - [`crate::world::World::resolve_attachments`] (`attachment.rs`): attachments of a scene as elastics and
//!   ties;
//! - [`crate::xpbd`] (`attachment_constraint.rs`), crate `reference` (`patches/`: `patch.rs`, `add_elastics`): elastics
//!   in XPBD and in patches;
//! - [`crate::tie::Tie`], [`crate::tied`]: ties to points within triangles and to moving frames, and where
//!   these are;
//! - [`crate::xpbd`] (`tie_constraint.rs`): ties solved: XPBD alone knows them.

use crate::laws::elastic::ElasticLaw;
use toile_geometry::Vec3;

/// One end of an elastic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ElasticEnd {
    /// A vertex of the cloth.
    Vertex(u32),
    /// A fixed point (m).
    Point(Vec3),
}

/// A spring from a vertex to another vertex or to a fixed point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elastic {
    /// The first end.
    pub from: u32,
    /// The second end.
    pub to: ElasticEnd,
    /// Its force law.
    pub law: ElasticLaw,
}

impl ElasticEnd {
    /// Its position (m).
    #[inline]
    pub fn position(self, x: &[Vec3]) -> Vec3 {
        match self {
            Self::Vertex(v) => x[v as usize],
            Self::Point(point) => point,
        }
    }
}

impl Elastic {
    /// Vector from the second end to the first (m).
    pub(crate) fn gap(&self, x: &[Vec3]) -> Vec3 {
        x[self.from as usize] - self.to.position(x)
    }
}

/// Elastics between two vertices of the cloth, and for each vertex the list of its elastics.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ElasticCouplings {
    /// Ends and law of each.
    pub all: Vec<([u32; 2], ElasticLaw)>,
    /// First index into `uses` of each vertex, and the end.
    start: Vec<u32>,
    /// The elastics at each vertex, ascending.
    uses: Vec<u32>,
}

impl ElasticCouplings {
    /// Elastics of a cloth of `count` vertices.
    pub(crate) fn new(count: usize, all: Vec<([u32; 2], ElasticLaw)>) -> Self {
        let numbered = (0..).zip(&all);
        let mut uses: Vec<(u32, u32)> = numbered
            .flat_map(|(e, (ends, _))| ends.map(|v| (v, e)))
            .collect();
        uses.sort_unstable();
        let mut start = vec![0u32; count + 1];
        for &(v, _) in &uses {
            start[v as usize + 1] += 1;
        }
        for v in 0..count {
            start[v + 1] += start[v];
        }
        Self {
            start,
            uses: uses.into_iter().map(|(_, e)| e).collect(),
            all,
        }
    }

    /// The two vertices of each elastic.
    pub fn ends(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        self.all.iter().map(|(ends, _)| *ends)
    }

    /// The elastics at a vertex, as indices into `all`.
    pub(crate) fn at(&self, vertex: usize) -> &[u32] {
        &self.uses[self.start[vertex] as usize..self.start[vertex + 1] as usize]
    }
}
