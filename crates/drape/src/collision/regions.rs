//! Which regions of the cloth are left out of a search, remembered from one search to the next: a
//! region that was found clear stays so while its own vertices stray little from one another,
//! however far they go together, and one that was not is not asked again at once.

use super::boxes::{Bounds, BoxTree, Pairs, Region};
use super::curvature::{Clearance, Curvature, Found, LEAST};
use super::surface::ROOM;
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

    fn are_still(&self) -> bool {
        std::ptr::eq(self.from, self.to)
    }
}

/// The cloth that is searched.
#[derive(Clone, Copy)]
pub struct Cloth<'a> {
    /// The tree over its triangles, fitted.
    pub tree: &'a BoxTree,
    /// Corners of the triangles.
    pub triangles: &'a [[u32; 3]],
    /// Ends of the edges.
    pub edges: &'a [[u32; 2]],
    /// Length of the shortest edge at each vertex [m].
    pub room: &'a [f64],
}

/// The boxes of a region's nodes; the second is no box of the tree where there is one node.
type Key = [u32; 2];

/// What was found of a region.
#[derive(Clone, Copy, Debug)]
struct Verdict {
    key: Key,
    clear: bool,
    /// The level it was looked at with.
    level: usize,
    /// How far its vertices may have strayed from one another since [m].
    strayed: f64,
}

/// What one part of a search notes.
#[derive(Debug, Default)]
struct Notes {
    verdicts: Vec<Verdict>,
    /// Regions to be looked at more closely, and at which level.
    asked: Vec<(Region, usize)>,
    /// How many were.
    told: usize,
}

/// What is known of the regions of a cloth.
#[derive(Clone, Debug, Default)]
pub struct Regions {
    curvature: Curvature,
    clearance: Option<Clearance>,
    /// Places at the last search [m].
    at: Vec<Vec3>,
    /// What it found, in order of the keys.
    verdicts: Vec<Verdict>,
    told: usize,
}

/// Boxes round the moves of some vertices [m].
#[derive(Clone, Copy, Debug)]
struct Moves {
    /// Since the last search.
    since: Bounds,
    /// On their ways.
    ways: Bounds,
}

impl Moves {
    fn join(&self, other: &Self) -> Self {
        Self {
            since: self.since.join(&other.since),
            ways: self.ways.join(&other.ways),
        }
    }
}

/// How the vertices below every node move.
struct Motion<'a> {
    /// For every node; nothing where nothing moved since the last search and nothing does.
    moves: Option<Vec<Moves>>,
    before: &'a [Verdict],
    clearance: Clearance,
}

fn key(region: &Region) -> Key {
    match *region {
        Region::Own(a) => [a.at, u32::MAX],
        Region::Two(a, b) => [a.at, b.at],
    }
}

impl Motion<'_> {
    /// How far the vertices of a region stray from one another [m], since the last search and on their
    /// ways.
    fn stray(&self, region: &Region) -> [f64; 2] {
        let Some(moves) = &self.moves else {
            return [0.0; 2];
        };
        let all = match *region {
            Region::Own(a) => moves[a.at as usize],
            Region::Two(a, b) => moves[a.at as usize].join(&moves[b.at as usize]),
        };
        [all.since.radius(), all.ways.radius()]
    }

    /// What is still known of a region; nothing where it has to be looked at again.
    fn verdict(&self, region: &Region, [since, on_the_way]: [f64; 2]) -> Option<Verdict> {
        let key = key(region);
        let at = self
            .before
            .binary_search_by(|verdict| verdict.key.cmp(&key));
        let mut verdict = self.before[at.ok()?];
        verdict.strayed += since;
        let all = match verdict.clear {
            true => verdict.strayed + on_the_way,
            false => verdict.strayed,
        };
        (all <= self.clearance.budget(verdict.level)).then_some(verdict)
    }

    /// Whether a region is left out; what is not known is told by `tell` for a level.
    fn leaves_out(
        &self,
        notes: &mut Notes,
        region: &Region,
        tell: impl FnOnce(&mut Notes, usize) -> Option<Found>,
    ) -> bool {
        if region.count() < LEAST {
            return false;
        }
        let stray = self.stray(region);
        if let Some(known) = self.verdict(region, stray) {
            notes.verdicts.push(known);
            return known.clear;
        }
        let Some(level) = self.clearance.level(stray[1]) else {
            return false;
        };
        let Some(found) = tell(notes, level) else {
            return true;
        };
        let clear = found == Found::Clear;
        notes.verdicts.push(Verdict {
            key: key(region),
            clear,
            level,
            strayed: match found {
                Found::Apart => f64::NEG_INFINITY,
                _ => 0.0,
            },
        });
        clear
    }
}

/// Boxes round the moves of the corners of every triangle, and of all below each node.
fn moves(cloth: &Cloth, ways: &Ways, at: &[Vec3]) -> Vec<Moves> {
    let everywhere = Bounds {
        low: [f64::NEG_INFINITY; 3],
        high: [f64::INFINITY; 3],
    };
    let round = |vectors: [Vec3; 3]| {
        let known = vectors.iter().all(|d| d.iter().all(|c| c.is_finite()));
        if known {
            Bounds::round(&vectors, 0.0)
        } else {
            everywhere
        }
    };
    let rest = Bounds::round(&[Vec3::zeros()], 0.0);
    let of_triangle = |t: &u32| {
        let corners = cloth.triangles[*t as usize].map(|v| v as usize);
        let moving = round(corners.map(|v| ways.to[v] - ways.from[v]));
        Moves {
            since: round(corners.map(|v| ways.from[v] - at[v])),
            ways: if ways.together {
                moving
            } else {
                moving.join(&rest)
            },
        }
    };
    let none = Moves {
        since: Bounds::EMPTY,
        ways: Bounds::EMPTY,
    };
    let of_leaf = |leaf: usize| {
        let all = cloth.tree.items(leaf).iter().map(of_triangle);
        all.fold(none, |all, own| all.join(&own))
    };
    cloth.tree.folded(of_leaf, Moves::join)
}

impl Regions {
    /// Regions of a cloth.
    pub fn new(cloth: &Cloth, edge_triangles: &[Vec<u32>]) -> Self {
        Self {
            curvature: Curvature::new(cloth.tree, cloth.triangles, cloth.edges, edge_triangles),
            ..Self::default()
        }
    }

    /// Forgets what was found.
    pub fn forget(&mut self) {
        self.clearance = None;
    }

    /// How many regions the last search looked at closely.
    pub fn told(&self) -> usize {
        self.told
    }

    /// Pairs of clusters whose boxes meet, without those of regions that keep clear of themselves,
    /// and how many regions were looked into.
    pub fn near(
        &mut self,
        cloth: &Cloth,
        ways: &Ways,
        clearance: Clearance,
    ) -> (Vec<[u32; 2]>, usize) {
        let x = ways.from;
        if self.clearance != Some(clearance) || self.at.len() != x.len() {
            self.clearance = Some(clearance);
            let most_kept = cloth.room.iter().map(|room| ROOM * room);
            self.curvature.keep(most_kept, clearance);
            self.verdicts.clear();
        }
        let before = std::mem::take(&mut self.verdicts);
        let at = if before.is_empty() { x } else { &self.at };
        let rests = before.is_empty() && ways.are_still();
        let motion = Motion {
            moves: (!rests).then(|| moves(cloth, ways, at)),
            before: &before,
            clearance,
        };
        let known = |notes: &mut Notes, region: &Region| {
            motion.leaves_out(notes, region, |notes, level| {
                notes.asked.push((*region, level));
                None
            })
        };
        let root: Vec<Region> = cloth.tree.root().map(Region::Own).into_iter().collect();
        let mut all: Pairs<Notes> = cloth.tree.pairs(&root, known);
        let asked = all.notes.iter().flat_map(|n| n.asked.iter().copied());
        let asked: Vec<(Region, usize)> = asked.collect();
        if !asked.is_empty() {
            self.curvature.face(cloth.tree, cloth.triangles, x, &asked);
            let curvature = &self.curvature;
            let regions: Vec<Region> = asked.iter().map(|(region, _)| *region).collect();
            let more = cloth.tree.pairs(&regions, |notes: &mut Notes, region| {
                motion.leaves_out(notes, region, |notes, level| {
                    notes.told += 1;
                    Some(curvature.find(cloth.edges, x, region, level))
                })
            });
            all.pairs.extend(more.pairs);
            all.opened += more.opened;
            all.notes.extend(more.notes);
        }
        self.told = all.notes.iter().map(|notes| notes.told).sum();
        let verdicts = all.notes.into_iter().flat_map(|notes| notes.verdicts);
        self.verdicts.extend(verdicts);
        self.verdicts.sort_unstable_by_key(|verdict| verdict.key);
        self.at.clear();
        self.at.extend_from_slice(x);
        (all.pairs, all.opened)
    }
}
