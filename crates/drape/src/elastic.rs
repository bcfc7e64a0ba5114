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

    /// The vertices it couples, where it couples two.
    pub(crate) fn ends(&self) -> Option<[u32; 2]> {
        match self.to {
            ElasticEnd::Vertex(to) => Some([self.from, to]),
            ElasticEnd::Point(_) => None,
        }
    }
}
