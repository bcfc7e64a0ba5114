//! Search of the tree with pruning: regions of the cloth that are far apart are left out, and regions that pass the
//! curvature test, which cannot touch themselves while their vertices deviate little from a common rigid motion.

use super::boxes::{BoxTree, Region};
use super::curvature::{Clearance, Curvature, MIN_LEAVES};
use super::moves::Moves;
use super::surface_view::{OFFSET_PER_EDGE, SurfaceView};
use super::trajectories::LinearTrajectories;
use toile_geometry::Vec3;

/// Notes of one task of a search.
#[derive(Debug, Default)]
struct Notes<N> {
    /// Regions to be given the curvature test, and the drift level of the test.
    pending: Vec<(Region, usize)>,
    /// Number of regions tested.
    tested: usize,
    /// Notes of the rule.
    of_rule: N,
}

/// Result of a search.
#[derive(Debug)]
pub struct RegionSearch<N> {
    /// Pairs of leaves that were not pruned, and leaves with themselves.
    pub pairs: Vec<[u32; 2]>,
    /// Number of regions opened.
    pub opened: usize,
    /// Number of regions given the curvature test.
    pub tested: usize,
    /// Notes of the rule, one of each task.
    pub notes: Vec<N>,
}

/// Decides which regions a search prunes.
pub trait PruningRule: Sync {
    /// Notes on pruned regions.
    type Notes: Default + Send;
    /// Whether the two nodes of a region are far apart.
    fn is_separated(&self, notes: &mut Self::Notes, region: &Region) -> bool;
    /// Drift level at which a region is given the curvature test; none where it is not tested.
    fn level(&self, region: &Region) -> Option<usize>;
    /// Takes note of a region that passed the curvature test.
    fn note_clear(&self, notes: &mut Self::Notes, region: &Region, level: usize);
}

/// Rule of a single search, which leaves nothing for later ones.
struct SingleSearch<'a> {
    tree: &'a BoxTree,
    moves: Option<Moves>,
    clearance: Clearance,
}

impl PruningRule for SingleSearch<'_> {
    type Notes = ();

    fn is_separated(&self, (): &mut (), region: &Region) -> bool {
        !self.tree.meets(region)
    }

    fn level(&self, region: &Region) -> Option<usize> {
        let deviation = (self.moves.as_ref()).map_or(0.0, |moves| moves.deviation(region));
        self.clearance.level(deviation)
    }

    fn note_clear(&self, (): &mut (), _: &Region, _: usize) {}
}

/// Searches of the regions of a cloth.
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

    /// Pairs of leaves whose boxes overlap, without regions that pass the curvature test on their trajectories.
    pub fn near_leaves(
        &mut self,
        cloth: &SurfaceView,
        trajectories: &LinearTrajectories,
        clearance: Clearance,
    ) -> RegionSearch<()> {
        let root: Vec<Region> = cloth.tree.root().map(Region::Own).into_iter().collect();
        let rule = SingleSearch {
            tree: cloth.tree,
            moves: Moves::of(trajectories, cloth),
            clearance,
        };
        self.search(cloth, (trajectories.from, &root), clearance, &rule)
    }

    /// Searches some regions at positions `x` (m), without regions that `rule` prunes. There are two passes: the
    /// first collects the topmost regions to be tested, so that the directions that they face are computed for all
    /// of them at once; the second tests them and, where a region fails, its children.
    pub fn search<R: PruningRule>(
        &mut self,
        cloth: &SurfaceView,
        (x, regions): (&[Vec3], &[Region]),
        clearance: Clearance,
        rule: &R,
    ) -> RegionSearch<R::Notes> {
        let max_offsets = cloth.shortest_edge.iter();
        self.curvature.set_clearance(
            max_offsets.map(|length| OFFSET_PER_EDGE * length),
            clearance,
        );
        let level = |region: &Region| match region.leaf_count() < MIN_LEAVES {
            true => None,
            false => rule.level(region),
        };
        let collect = |notes: &mut Notes<R::Notes>, region: &Region| {
            if rule.is_separated(&mut notes.of_rule, region) {
                return true;
            }
            let level = level(region);
            notes.pending.extend(level.map(|level| (*region, level)));
            level.is_some()
        };
        let mut found = cloth.tree.leaf_pairs(regions, collect);
        let pending = found.notes.iter().flat_map(|n| n.pending.iter().copied());
        let pending: Vec<(Region, usize)> = pending.collect();
        if !pending.is_empty() {
            (self.curvature).find_facing(cloth.tree, cloth.triangles, x, &pending);
            let curvature = &self.curvature;
            let regions: Vec<Region> = pending.iter().map(|(region, _)| *region).collect();
            let test = |notes: &mut Notes<R::Notes>, region: &Region| {
                if rule.is_separated(&mut notes.of_rule, region) {
                    return true;
                }
                let Some(level) = level(region) else {
                    return false;
                };
                notes.tested += 1;
                let clear = curvature.is_clear(cloth.edges, x, region, level);
                if clear {
                    rule.note_clear(&mut notes.of_rule, region, level);
                }
                clear
            };
            let more = cloth.tree.leaf_pairs(&regions, test);
            found.pairs.extend(more.pairs);
            found.opened += more.opened;
            found.notes.extend(more.notes);
        }
        RegionSearch {
            pairs: found.pairs,
            opened: found.opened,
            tested: found.notes.iter().map(|notes| notes.tested).sum(),
            notes: found.notes.into_iter().map(|notes| notes.of_rule).collect(),
        }
    }
}
