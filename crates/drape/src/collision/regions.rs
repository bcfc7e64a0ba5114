//! Which regions of the cloth a search leaves out: those far from each other, and those that cannot touch
//! themselves while their vertices stray little from one another, however far they go together.

use super::boxes::{BoxTree, Region};
use super::clusters::Corners;
use super::curvature::{Clearance, Curvature, LEAST};
use super::moves::Moves;
use super::surface::{FeaturePair, ROOM};
use toile_geometry::Vec3;

/// Straight ways of all vertices.
#[derive(Clone, Copy, Debug)]
pub struct Ways<'a> {
    /// Where they begin [m].
    pub from: &'a [Vec3],
    /// Where they end [m].
    pub to: &'a [Vec3],
    /// Whether all go at one pace; else each may end anywhere on its way.
    pub together: bool,
}

impl<'a> Ways<'a> {
    /// Ways that all go at one pace.
    pub fn together(from: &'a [Vec3], to: &'a [Vec3]) -> Self {
        Self {
            from,
            to,
            together: true,
        }
    }

    /// Ways on which each vertex may stop where it likes.
    pub fn each(from: &'a [Vec3], to: &'a [Vec3]) -> Self {
        Self {
            from,
            to,
            together: false,
        }
    }

    /// No ways.
    pub fn still(x: &'a [Vec3]) -> Self {
        Self::together(x, x)
    }

    /// Whether nothing moves.
    pub fn are_still(&self) -> bool {
        std::ptr::eq(self.from, self.to)
    }

    /// The moves below every node; nothing where nothing moves.
    pub fn moves(&self, cloth: &Cloth) -> Option<Moves> {
        let way = |v: u32| self.to[v as usize] - self.from[v as usize];
        (!self.are_still()).then(|| match self.together {
            true => Moves::new(cloth, self.from, way),
            false => Moves::shifts(cloth, way).or_less(),
        })
    }
}

/// The cloth that is searched.
#[derive(Clone, Copy)]
pub struct Cloth<'a> {
    /// The tree over its triangles, fitted.
    pub tree: &'a BoxTree,
    /// The corners of each leaf's triangles, leaf after leaf; where those of each begin, and the end.
    pub leaf_vertices: [&'a [u32]; 2],
    /// Corners of the triangles.
    pub triangles: &'a [[u32; 3]],
    /// Ends of the edges.
    pub edges: &'a [[u32; 2]],
    /// Length of the shortest edge at each vertex [m].
    pub room: &'a [f64],
}

impl Cloth<'_> {
    /// The vertices of a leaf.
    pub fn leaf(&self, leaf: usize) -> &[u32] {
        let [vertices, starts] = self.leaf_vertices;
        &vertices[starts[leaf] as usize..starts[leaf + 1] as usize]
    }

    /// Its features.
    pub fn corners(&self) -> Corners<'_> {
        Corners {
            edges: self.edges,
            triangles: self.triangles,
        }
    }

    /// A vertex and a face; nothing where the face has the vertex.
    pub fn vertex_face(&self, [v, t]: [u32; 2]) -> Option<FeaturePair> {
        let [a, b, c] = self.triangles[t as usize];
        (v != a && v != b && v != c).then_some(FeaturePair::VertexFace([v, a, b, c]))
    }

    /// Two edges, the same whichever comes first; nothing where they share a vertex.
    pub fn edge_edge(&self, [e, f]: [u32; 2]) -> Option<FeaturePair> {
        let (e, f) = (e.min(f), e.max(f));
        let ([a, b], [c, d]) = (self.edges[e as usize], self.edges[f as usize]);
        let apart = a != c && a != d && b != c && b != d;
        apart.then_some(FeaturePair::EdgeEdge([a, b, c, d]))
    }

    /// Whether an edge and a face share no vertex.
    pub fn are_apart(&self, [e, t]: [u32; 2]) -> bool {
        let face = self.triangles[t as usize];
        !self.edges[e as usize].iter().any(|v| face.contains(v))
    }
}

/// What one part of a search notes.
#[derive(Debug, Default)]
struct Notes<N> {
    /// Regions to be looked at more closely, and at which level.
    asked: Vec<(Region, usize)>,
    /// How many were.
    told: usize,
    /// Those left out.
    own: N,
}

/// What a search found.
#[derive(Debug)]
pub struct Searched<N> {
    /// Pairs of leaves that are not left out, and leaves with themselves.
    pub pairs: Vec<[u32; 2]>,
    /// How many regions were looked into.
    pub opened: usize,
    /// How many were looked at closely.
    pub told: usize,
    /// What was noted of those left out, in parts.
    pub notes: Vec<N>,
}

/// What decides which regions are left out.
pub trait Leave: Sync {
    /// Is told what was left out.
    type Notes: Default + Send;
    /// Whether a region's two nodes are far apart.
    fn apart(&self, notes: &mut Self::Notes, region: &Region) -> bool;
    /// With which margin a region is to be looked at closely; nothing where it is not.
    fn level(&self, region: &Region) -> Option<usize>;
    /// Is told of a region that keeps clear of itself.
    fn clear(&self, notes: &mut Self::Notes, region: &Region, level: usize);
}

/// Leaves out what is clear for some ways once.
struct Once<'a> {
    tree: &'a BoxTree,
    moves: Option<Moves>,
    clearance: Clearance,
}

impl Leave for Once<'_> {
    type Notes = ();

    fn apart(&self, (): &mut (), region: &Region) -> bool {
        !self.tree.meets(region)
    }

    fn level(&self, region: &Region) -> Option<usize> {
        let stray = self.moves.as_ref().map_or(0.0, |moves| moves.stray(region));
        self.clearance.level(stray)
    }

    fn clear(&self, (): &mut (), _: &Region, _: usize) {}
}

/// What the mesh says of regions.
#[derive(Clone, Debug, Default)]
pub struct Regions {
    curvature: Curvature,
}

impl Regions {
    /// Regions of a cloth.
    pub fn new(cloth: &Cloth, edge_triangles: &[Vec<u32>]) -> Self {
        Self {
            curvature: Curvature::new(cloth.tree, cloth.triangles, cloth.edges, edge_triangles),
        }
    }

    /// Pairs of clusters whose boxes meet, without those of regions that keep clear of themselves on
    /// the way.
    pub fn near(&mut self, cloth: &Cloth, ways: &Ways, clearance: Clearance) -> Searched<()> {
        let root: Vec<Region> = cloth.tree.root().map(Region::Own).into_iter().collect();
        let leave = Once {
            tree: cloth.tree,
            moves: ways.moves(cloth),
            clearance,
        };
        self.search(cloth, (ways.from, &root), clearance, &leave)
    }

    /// Looks into some regions at some places [m], those left out that `leave` says.
    pub fn search<L: Leave>(
        &mut self,
        cloth: &Cloth,
        (x, regions): (&[Vec3], &[Region]),
        clearance: Clearance,
        leave: &L,
    ) -> Searched<L::Notes> {
        self.curvature
            .keep(cloth.room.iter().map(|room| ROOM * room), clearance);
        let level = |region: &Region| match region.count() < LEAST {
            true => None,
            false => leave.level(region),
        };
        let ask = |notes: &mut Notes<L::Notes>, region: &Region| {
            if leave.apart(&mut notes.own, region) {
                return true;
            }
            let level = level(region);
            notes.asked.extend(level.map(|level| (*region, level)));
            level.is_some()
        };
        let mut all = cloth.tree.pairs(regions, ask);
        let asked = all.notes.iter().flat_map(|n| n.asked.iter().copied());
        let asked: Vec<(Region, usize)> = asked.collect();
        if !asked.is_empty() {
            self.curvature.face(cloth.tree, cloth.triangles, x, &asked);
            let curvature = &self.curvature;
            let regions: Vec<Region> = asked.iter().map(|(region, _)| *region).collect();
            let tell = |notes: &mut Notes<L::Notes>, region: &Region| {
                if leave.apart(&mut notes.own, region) {
                    return true;
                }
                let Some(level) = level(region) else {
                    return false;
                };
                notes.told += 1;
                let clear = curvature.is_clear(cloth.edges, x, region, level);
                if clear {
                    leave.clear(&mut notes.own, region, level);
                }
                clear
            };
            let more = cloth.tree.pairs(&regions, tell);
            all.pairs.extend(more.pairs);
            all.opened += more.opened;
            all.notes.extend(more.notes);
        }
        Searched {
            pairs: all.pairs,
            opened: all.opened,
            told: all.notes.iter().map(|notes| notes.told).sum(),
            notes: all.notes.into_iter().map(|notes| notes.own).collect(),
        }
    }
}
