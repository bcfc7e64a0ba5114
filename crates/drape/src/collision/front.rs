//! Where a search for near features ended, kept from one look to the next: between regions far apart,
//! at regions that cannot touch themselves, and at pairs of clusters with lists of the features near
//! each other in them (lists: Verlet 1967; the front of a search: Ehmann and Lin 2001). Each part
//! serves until its vertices have strayed too far from one another, however far they go together; only
//! then it is searched again.

use super::boxes::{BoxTree, Region};
use super::clusters::{Clusters, Hits};
use super::curvature::Clearance;
use super::feature_pair::FeaturePair;
use super::moves::Moves;
use super::nearness::{Nearness, PARALLEL, is_far};
use super::reach::Reach;
use super::regions::{PruningRule, Regions};
use super::surface_view::SurfaceView;
use super::trajectories::LinearTrajectories;
use pulp::Arch;
use rayon::iter::Either;
use rayon::prelude::*;
use std::sync::Arc;
use toile_geometry::Vec3;

/// Looks that a part is to serve at the pace at which its vertices stray now.
const SERVES: f64 = 8.0;

/// How far features of a part may come nearer before it is searched again, at the least and at the
/// most [m].
const SLACK: [f64; 2] = [1e-3, 2e-3];

/// How far the vertices of two clusters may stray from one another in a look for their features to be
/// listed [m], and to be listed again.
const CALM: [f64; 2] = [2.5e-4, 1e-4];

/// How far off features may be listed, as a share of the shortest edge there; and those that stray less than
/// so far in a look [m]: their list is long, but serves for very long.
const DENSE: f64 = 0.5;
const DENSE_AT_REST: f64 = 2.0;
const AT_REST: f64 = 2e-5;

/// How many times as fast vertices may become before features that come near by that are searched for again.
const FASTER: f64 = 2.0;

/// Distances of boxes and of features are known no better than this [m].
const ROUNDING: f64 = 1e-9;

/// Places that are told apart by rounding alone are no farther from each other [m].
const SAME: f64 = 1e-12;

/// All is searched again when the parts have grown by this share and this many: those that come of one
/// never become one again.
const GROWTH: (f64, usize) = (0.25, 64);

/// Looks after which all is searched again in any case: clusters that were near may be far.
const LOOKS: usize = 256;

/// Where a search ended.
#[derive(Clone, Debug)]
enum End {
    /// At two nodes so far apart [m].
    Apart(f64),
    /// At a region that keeps clear of itself, at a level.
    Clear(usize),
    /// At clusters whose features near each other are listed.
    Listed(List),
    /// At clusters that move too fast for that, or whose features lie too close: they are held against each
    /// other at every look.
    Open,
}

/// Features of two clusters, or of one, that are near each other.
#[derive(Clone, Debug)]
struct List {
    /// How far apart vertices and faces, and edges, are at the least that are not listed [m].
    gap: f64,
    /// The same of edges and faces [m].
    piercing: f64,
    /// The features, where there are any.
    hits: Option<Box<Hits>>,
}

/// A part of the front.
#[derive(Clone, Debug)]
struct Part {
    region: Region,
    end: End,
    /// How far its vertices may have strayed since from what their moves have in common [m].
    strayed: f64,
    /// How far they stray on the ways that were asked about last [m].
    way: f64,
}

impl Part {
    fn new(region: Region, end: End, way: f64) -> Self {
        Self {
            region,
            end,
            strayed: 0.0,
            way,
        }
    }

    fn hits(&self) -> Option<&Hits> {
        match &self.end {
            End::Listed(list) => list.hits.as_deref(),
            _ => None,
        }
    }
}

/// How near features come that are looked for.
#[derive(Clone, Debug, Default)]
struct Sought {
    /// At the most [m].
    most: f64,
    pace: Option<Arc<Pace>>,
}

/// What is known of the time until the next look.
#[derive(Debug)]
struct Pace {
    /// Boxes round the velocities [m/s].
    velocities: Moves,
    /// As [`super::Ahead`] has them.
    kept: f64,
    least: f64,
    time: f64,
}

impl Sought {
    fn new(cloth: &SurfaceView, reach: &Reach) -> Self {
        let pace = reach.ahead.as_ref().map(|ahead| {
            // What is held may be led anywhere.
            let velocity = |v: u32| match ahead.pinned[v as usize] {
                true => Vec3::repeat(f64::INFINITY),
                false => ahead.velocities[v as usize],
            };
            Arc::new(Pace {
                velocities: Moves::shifts(cloth, velocity),
                kept: ahead.kept,
                least: ahead.least,
                time: ahead.time,
            })
        });
        Self {
            most: reach.most,
            pace,
        }
    }

    /// No less than what [`Reach::of`] says of any two features of a region [m], were they so many times as
    /// fast.
    fn of(&self, region: &Region, times: f64) -> f64 {
        let Some(pace) = &self.pace else {
            return self.most;
        };
        // Of four velocities in a ball none is farther than 3/2 of its radius from their mean.
        let speed = times * 1.5 * pace.velocities.stray(region);
        if !speed.is_finite() {
            return self.most;
        }
        let way = (2.0 * speed * pace.time).max(pace.least);
        (pace.kept + 2.0 * way).min(self.most)
    }
}

/// What is asked of the parts.
pub struct Asked {
    /// How near features come on their ways that are to be listed.
    near: Sought,
    /// The same for contacts, as they were last asked for where nothing moves.
    contacts: Sought,
    clearance: Clearance,
    /// Moves since the last look.
    since: Since,
    /// Moves on the ways.
    ways: Option<Arc<Moves>>,
    /// The last moves that are known, for what is to come.
    last: Option<Arc<Moves>>,
    /// The mean of the shortest edges at the vertices of every cluster [m].
    shortest: Arc<[f64]>,
}

/// Moves since the last look.
enum Since {
    /// None.
    Still,
    /// The ways that were asked about then.
    AsAsked,
    /// Others.
    Moved(Arc<Moves>),
}

impl Asked {
    /// How far the vertices of a region stray on their way [m].
    fn on_the_way(&self, region: &Region) -> f64 {
        self.ways.as_ref().map_or(0.0, |moves| moves.stray(region))
    }

    /// Takes note of the moves since the last look, and of the ways.
    fn age(&self, part: &mut Part) {
        part.strayed += match &self.since {
            Since::Still => 0.0,
            Since::AsAsked => part.way + SAME,
            Since::Moved(moves) => moves.stray(&part.region),
        };
        part.way = self.on_the_way(&part.region);
    }

    /// Whether what was found of a part serves.
    fn serves(&self, part: &Part) -> bool {
        let strayed = part.strayed + part.way;
        let comes = |gap: f64| gap - 2.0 * strayed >= self.near.of(&part.region, 1.0);
        match &part.end {
            End::Clear(level) => strayed <= self.clearance.budget(*level),
            End::Apart(gap) => comes(*gap),
            End::Listed(list) => comes(list.gap) && 2.0 * part.strayed < list.piercing,
            End::Open => self.ways.is_none() || part.way > CALM[1] || self.is_dense(&part.region),
        }
    }

    /// Whether features of two clusters, or one, lie too close for what is asked to be listed.
    fn is_dense(&self, region: &Region) -> bool {
        let edge = |first: u32| self.shortest[first as usize];
        let edge = region.nodes().map(|n| edge(n.first)).fold(0.0, f64::max);
        let most = match self.pace(region) <= AT_REST {
            true => DENSE_AT_REST,
            false => DENSE,
        };
        self.wanted(region)[0] > most * edge
    }

    /// Whether features of two clusters, or one, are to be listed.
    fn lists(&self, region: &Region) -> bool {
        self.pace(region) <= CALM[0] && !self.is_dense(region)
    }

    /// How far the vertices of a region stray on the way, or strayed on the last one [m].
    fn pace(&self, region: &Region) -> f64 {
        match (&self.ways, &self.last) {
            (Some(moves), _) | (None, Some(moves)) => moves.stray(region),
            (None, None) => 0.0,
        }
    }

    /// How far off features of a region are listed, and how far off edges and faces [m].
    fn wanted(&self, region: &Region) -> [f64; 2] {
        let way = self.on_the_way(region);
        let pace = match self.ways.is_some() {
            true => way,
            false => self.pace(region),
        };
        let slack = (2.0 * SERVES * pace).clamp(SLACK[0], SLACK[1]);
        let near = self.near.of(region, 1.0) + 2.0 * way;
        [near.max(self.contacts.of(region, FASTER)) + slack, slack]
    }
}

/// Leaves out what is far apart at the start of the ways, and what keeps clear of itself on them.
struct Parted<'a> {
    tree: &'a BoxTree,
    asked: &'a Asked,
}

impl PruningRule for Parted<'_> {
    type Notes = Vec<Part>;

    fn apart(&self, parts: &mut Vec<Part>, region: &Region) -> bool {
        let Some(distance) = self.tree.distance(region) else {
            return false;
        };
        let apart = distance > self.asked.wanted(region)[0];
        if apart {
            let way = self.asked.on_the_way(region);
            parts.push(Part::new(*region, End::Apart(distance - ROUNDING), way));
        }
        apart
    }

    fn level(&self, region: &Region) -> Option<usize> {
        self.asked.clearance.level(self.asked.on_the_way(region))
    }

    fn clear(&self, parts: &mut Vec<Part>, region: &Region, level: usize) {
        let way = self.asked.on_the_way(region);
        parts.push(Part::new(*region, End::Clear(level), way));
    }
}

/// The front of a search.
#[derive(Clone, Debug, Default)]
pub struct Front {
    parts: Vec<Part>,
    /// How many there were when all was searched, and the looks since.
    first: usize,
    looks: usize,
    clearance: Option<Clearance>,
    /// Places at the last look [m], and the ends of the ways that were asked about.
    at: Vec<Vec3>,
    ends: Vec<Vec3>,
    contacts: Sought,
    last: Option<Arc<Moves>>,
    /// Parts with a list.
    listed: Vec<u32>,
    /// Pairs of clusters without, and how near features come that are looked for in them [m].
    open: Vec<([u32; 2], f64)>,
    shortest: Option<Arc<[f64]>>,
}

impl Front {
    /// Searches all at the next look.
    pub fn forget(&mut self) {
        self.clearance = None;
    }

    /// Lists of features that may come near each other.
    pub fn lists(&self) -> impl IndexedParallelIterator<Item = Option<&Hits>> {
        let listed = self.listed.par_iter();
        listed.map(|&k| self.parts[k as usize].hits())
    }

    /// Pairs of clusters whose features are not listed, and how near features come that are looked for in
    /// them [m].
    pub fn open(&self) -> &[([u32; 2], f64)] {
        &self.open
    }

    /// Takes out what does not serve for features that come within reach on their ways; the regions
    /// that are to be searched for it, and what is asked of them.
    pub fn expired(
        &mut self,
        cloth: &SurfaceView,
        (ways, reach): (&LinearTrajectories, &Reach),
        clearance: Clearance,
    ) -> (Vec<Region>, Asked) {
        let (grown, fewest) = GROWTH;
        let most = self.first + fewest + (grown * self.first as f64) as usize;
        let anew = self.clearance != Some(clearance)
            || self.at.len() != ways.from.len()
            || self.parts.len() > most
            || self.looks > LOOKS;
        self.looks = if anew { 0 } else { self.looks + 1 };
        let near = Sought::new(cloth, reach);
        if ways.are_still() {
            self.contacts = near.clone();
        }
        let since = match anew {
            true => Since::Still,
            false => self.since(cloth, ways.from),
        };
        let moves = Moves::of(ways, cloth).map(Arc::new);
        if let (Some(moves), _) | (None, Since::Moved(moves)) = (&moves, &since) {
            self.last = Some(moves.clone());
        }
        let asked = Asked {
            near,
            contacts: self.contacts.clone(),
            clearance,
            since,
            ways: moves,
            last: self.last.clone(),
            shortest: (self.shortest.get_or_insert_with(|| shortest(cloth))).clone(),
        };
        self.at.clear();
        self.at.extend_from_slice(ways.from);
        self.ends.clear();
        self.ends.extend_from_slice(ways.to);
        self.clearance = Some(clearance);
        if anew {
            self.parts.clear();
            self.listed.clear();
            self.first = 0;
            let root = cloth.tree.root().map(Region::Own);
            return (root.into_iter().collect(), asked);
        }
        let age = |part: &mut Part| {
            asked.age(part);
            asked.serves(part)
        };
        let parts = self.parts.par_iter_mut().with_min_len(512);
        let serves: Vec<bool> = parts.map(age).collect();
        let both = self.parts.iter().zip(&serves);
        let expired = both.filter(|(_, serves)| !**serves);
        let expired: Vec<Region> = expired.map(|(part, _)| part.region).collect();
        if !expired.is_empty() {
            let mut serves = serves.into_iter();
            self.parts.retain(|_| serves.next() == Some(true));
        }
        (expired, asked)
    }

    /// The moves since the last look.
    fn since(&self, cloth: &SurfaceView, x: &[Vec3]) -> Since {
        let same = |places: &[Vec3]| {
            let mut both = x.iter().zip(places);
            both.all(|(x, place)| (x - place).norm_squared() <= SAME * SAME)
        };
        if self.at == x {
            return Since::Still;
        }
        if same(&self.ends) {
            return Since::AsAsked;
        }
        let way = |v: u32| x[v as usize] - self.at[v as usize];
        Since::Moved(Arc::new(Moves::new(cloth, &self.at, way)))
    }

    /// Takes in what a search of the regions that had expired comes to; the tree is fitted where the ways
    /// begin, at `x` [m]. How many regions it looked into, and how many closely.
    pub fn search(
        &mut self,
        cloth: &SurfaceView,
        (regions, clusters): (&mut Regions, &mut Clusters),
        x: &[Vec3],
        (expired, asked): (&[Region], &Asked),
    ) -> [usize; 2] {
        let tree = cloth.tree;
        let parted = Parted { tree, asked };
        let found = regions.search(cloth, (x, expired), asked.clearance, &parted);
        for mut parts in found.notes {
            self.parts.append(&mut parts);
        }
        let end = |&pair: &[u32; 2]| {
            let region = tree.region(pair);
            match asked.lists(&region) {
                true => Either::Left(pair),
                false => Either::Right(Part::new(region, End::Open, asked.on_the_way(&region))),
            }
        };
        let pairs = found.pairs.par_iter().with_min_len(64);
        let (listed, open): (Vec<[u32; 2]>, Vec<Part>) = pairs.partition_map(end);
        self.parts.extend(open);
        clusters.fit_some(
            &LinearTrajectories::still(x),
            cloth.corners(),
            &of_pairs(cloth, listed.iter().copied()),
        );
        let (arch, clusters) = (Arch::new(), &*clusters);
        let list = |hits: &mut Hits, &pair: &[u32; 2]| {
            let region = tree.region(pair);
            let wanted = asked.wanted(&region);
            hits.clear();
            clusters.near_within(arch, pair, wanted[0], hits);
            clusters.piercing_within(arch, pair, wanted[1], hits);
            let hits = near(cloth, x, hits, wanted);
            let [gap, piercing] = wanted.map(|far| far - ROUNDING);
            let list = List {
                gap,
                piercing,
                hits,
            };
            Part::new(region, End::Listed(list), asked.on_the_way(&region))
        };
        let pairs = listed.par_iter().with_min_len(8);
        let lists = pairs.map_init(Hits::default, list);
        self.parts.par_extend(lists);
        if self.first == 0 {
            self.first = self.parts.len();
        }
        let with_list = (0u32..).zip(&self.parts);
        let with_list = with_list.filter(|(_, part)| part.hits().is_some());
        self.listed.clear();
        self.listed.extend(with_list.map(|(k, _)| k));
        [found.opened, found.told]
    }

    /// Fits what is not listed round the ways; where only marked vertices go another way than was last asked
    /// about, only what has one of these.
    pub fn fit(
        &mut self,
        cloth: &SurfaceView,
        clusters: &mut Clusters,
        (ways, asked): (&LinearTrajectories, &Asked),
        marks: Option<&[bool]>,
    ) {
        let marked = |leaf: u32| {
            let mut vertices = cloth.leaf(leaf as usize).iter();
            marks.is_none_or(|marks| vertices.any(|&v| marks[v as usize]))
        };
        let leaves = 0..cloth.tree.leaves() as u32;
        let marked: Vec<bool> = match marks {
            None => vec![true; leaves.len()],
            Some(_) => leaves.map(marked).collect(),
        };
        let open = |part: &Part| {
            let mut leaves = part.region.nodes().map(|node| node.first);
            let first = leaves.next()?;
            let pair = [first, leaves.next().unwrap_or(first)];
            let asked_for =
                matches!(part.end, End::Open) && pair.iter().any(|&leaf| marked[leaf as usize]);
            asked_for.then(|| (pair, asked.near.of(&part.region, 1.0)))
        };
        let parts = self.parts.par_iter().with_min_len(512);
        self.open = parts.filter_map(open).collect();
        let pairs = self.open.iter().map(|(pair, _)| *pair);
        let clusters_of_pairs = of_pairs(cloth, pairs);
        clusters.fit_some(ways, cloth.corners(), &clusters_of_pairs);
    }
}

/// The clusters of some pairs, sorted.
fn of_pairs(cloth: &SurfaceView, pairs: impl Iterator<Item = [u32; 2]>) -> Vec<u32> {
    let mut named = vec![false; cloth.tree.leaves()];
    pairs.flatten().for_each(|leaf| named[leaf as usize] = true);
    let leaves = 0..named.len() as u32;
    leaves.filter(|&leaf| named[leaf as usize]).collect()
}

/// The mean of the shortest edges at the vertices of every cluster [m].
fn shortest(cloth: &SurfaceView) -> Arc<[f64]> {
    let of_leaf = |leaf: usize| {
        let vertices = cloth.leaf(leaf);
        let sum: f64 = vertices.iter().map(|&v| cloth.room[v as usize]).sum();
        sum / vertices.len() as f64
    };
    (0..cloth.tree.leaves()).map(of_leaf).collect()
}

/// Whether two features are no farther apart than so [m]; also where that is no number.
fn within(pair: FeaturePair, x: &[Vec3], far: f64) -> bool {
    if is_far(pair, &pair.vertices().map(|v| x[v as usize]), far) {
        return false;
    }
    let distance = Nearness::distance(pair, x);
    distance <= far || distance.is_nan()
}

/// Those of some features that may be no farther apart than `gap` [m], edges and faces than `piercing` [m];
/// nothing where none is.
fn near(
    cloth: &SurfaceView,
    x: &[Vec3],
    hits: &Hits,
    [gap, piercing]: [f64; 2],
) -> Option<Box<Hits>> {
    let is_near = |pair: Option<FeaturePair>| pair.is_some_and(|pair| within(pair, x, gap));
    let some = |hits: &[[u32; 2]], keep: &dyn Fn([u32; 2]) -> bool| -> Vec<[u32; 2]> {
        hits.iter().copied().filter(|&hit| keep(hit)).collect()
    };
    let pierces = |hit| cloth.are_apart(hit) && edge_within(cloth, x, hit, piercing);
    let near = Hits {
        vertex_face: some(&hits.vertex_face, &|hit| is_near(cloth.vertex_face(hit))),
        edge_edge: some(&hits.edge_edge, &|hit| is_near(cloth.edge_edge(hit))),
        edge_face: some(&hits.edge_face, &pierces),
    };
    (!near.is_empty()).then(|| Box::new(near))
}

/// Whether an edge may cross a face, or come no farther from it than so [m]: its ends are not both farther
/// from the plane of the face on one side. Of a face that is hardly more than a line the plane is rounding.
fn edge_within(cloth: &SurfaceView, x: &[Vec3], [e, t]: [u32; 2], far: f64) -> bool {
    let at = |v: u32| x[v as usize];
    let (ends, [p, q, r]) = (
        cloth.edges[e as usize].map(at),
        cloth.triangles[t as usize].map(at),
    );
    let sides = [q - p, r - p];
    let across = sides[0].cross(&sides[1]);
    let square = across.norm_squared();
    let known = square > PARALLEL * sides[0].norm_squared() * sides[1].norm_squared();
    let [a, b] = ends.map(|end| across.dot(&(end - p)));
    let most = (far + ROUNDING) * square.sqrt();
    !(known && (a.min(b) > most || a.max(b) < -most))
}
