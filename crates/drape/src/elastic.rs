//! Elastics: attachment forces between a vertex and another, or a place.

use crate::laws::elastic::ElasticLaw;
use toile_geometry::Vec3;

/// One end of an elastic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ElasticEnd {
    /// A vertex of the cloth.
    Vertex(u32),
    /// A fixed place [m].
    Point(Vec3),
}

/// An attachment force between a vertex and another vertex or a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elastic {
    /// The vertex it pulls.
    pub from: u32,
    /// What it is pulled to.
    pub to: ElasticEnd,
    /// Its force law.
    pub law: ElasticLaw,
}

impl ElasticEnd {
    /// Its place [m].
    pub(crate) fn place(self, x: &[Vec3]) -> Vec3 {
        match self {
            Self::Vertex(v) => x[v as usize],
            Self::Point(place) => place,
        }
    }
}

impl Elastic {
    /// From the place it pulls to, to the vertex it pulls [m].
    pub(crate) fn gap(&self, x: &[Vec3]) -> Vec3 {
        x[self.from as usize] - self.to.place(x)
    }
}

/// Elastics between two vertices of the cloth, with those at each vertex.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ElasticCouplings {
    /// Ends and law of each.
    pub all: Vec<([u32; 2], ElasticLaw)>,
    /// Where the uses of each vertex begin in `uses`, and the end.
    start: Vec<u32>,
    /// The elastics at each vertex, ascending.
    uses: Vec<u32>,
}

impl ElasticCouplings {
    /// Of a cloth of `count` vertices.
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

    /// The vertices that each couples.
    pub(crate) fn ends(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        self.all.iter().map(|(ends, _)| *ends)
    }

    /// Those at a vertex, as indices into `all`.
    pub(crate) fn at(&self, vertex: usize) -> &[u32] {
        &self.uses[self.start[vertex] as usize..self.start[vertex + 1] as usize]
    }
}
