//! Which regions of the cloth a search leaves out: those far from each other, and those that cannot touch
//! themselves while their vertices stray little from one another, however far they go together.

use super::boxes::{BoxTree, Region};
use super::curvature::{Clearance, Curvature, LEAST};
use super::moves::Moves;
use super::surface_view::{ROOM, SurfaceView};
use super::trajectories::LinearTrajectories;
use toile_geometry::Vec3;

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

/// Decides which regions a search prunes.
pub trait PruningRule: Sync {
    /// Notes of the regions pruned.
    type Notes: Default + Send;
    /// Whether a region's two nodes are far apart.
    fn apart(&self, notes: &mut Self::Notes, region: &Region) -> bool;
    /// With which margin a region is to be looked at closely; nothing where it is not.
    fn level(&self, region: &Region) -> Option<usize>;
    /// Notes a region that keeps clear of itself.
    fn clear(&self, notes: &mut Self::Notes, region: &Region, level: usize);
}

/// Prunes regions that are clear on some trajectories, for one search.
struct Once<'a> {
    tree: &'a BoxTree,
    moves: Option<Moves>,
    clearance: Clearance,
}

impl PruningRule for Once<'_> {
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
    pub fn new(cloth: &SurfaceView, edge_triangles: &[Vec<u32>]) -> Self {
        Self {
            curvature: Curvature::new(cloth.tree, cloth.triangles, cloth.edges, edge_triangles),
        }
    }

    /// Pairs of leaves whose boxes overlap, without those of regions that keep clear of themselves on
    /// their trajectories.
    pub fn near(
        &mut self,
        cloth: &SurfaceView,
        ways: &LinearTrajectories,
        clearance: Clearance,
    ) -> Searched<()> {
        let root: Vec<Region> = cloth.tree.root().map(Region::Own).into_iter().collect();
        let rule = Once {
            tree: cloth.tree,
            moves: Moves::of(ways, cloth),
            clearance,
        };
        self.search(cloth, (ways.from, &root), clearance, &rule)
    }

    /// Searches some regions at some positions [m], but for those that `rule` prunes.
    pub fn search<L: PruningRule>(
        &mut self,
        cloth: &SurfaceView,
        (x, regions): (&[Vec3], &[Region]),
        clearance: Clearance,
        rule: &L,
    ) -> Searched<L::Notes> {
        self.curvature
            .keep(cloth.room.iter().map(|room| ROOM * room), clearance);
        let level = |region: &Region| match region.count() < LEAST {
            true => None,
            false => rule.level(region),
        };
        let ask = |notes: &mut Notes<L::Notes>, region: &Region| {
            if rule.apart(&mut notes.own, region) {
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
                if rule.apart(&mut notes.own, region) {
                    return true;
                }
                let Some(level) = level(region) else {
                    return false;
                };
                notes.told += 1;
                let clear = curvature.is_clear(cloth.edges, x, region, level);
                if clear {
                    rule.clear(&mut notes.own, region, level);
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
