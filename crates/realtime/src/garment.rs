//! A garment, adjusted once a frame to the ellipsoids it was made on.
//!
//! # Decided with
//! - [`crate::adjust`]: a frame by gravity or by shape;
//! - [`crate::push`], [`crate::field::Field`]: vertices put out of ellipsoids;
//! - [`crate::edges`], [`crate::home`]: bounds of edges; joints that a vertex hangs on;
//! - [`crate::character::Character`], [`crate::player`], [`crate::ellipsoids::Ellipsoids`]: the figure, its
//!   clips and its pose;
//! - [`crate::lanes`]: eight vertices at once.
//!
//! Made of drapes by crate `session` (`realtime.rs`), read and written by crate `interchange`, measured by
//! crate `lab`.

use crate::edges::{Bounds, Edges};
use crate::field::Field;
use crate::home::{Homes, along_a_curve, columns};
use crate::lanes::{Columns, LANES};
use crate::turn::{Frame, Vector, dot};
use crate::{Ellipsoids, RealtimeError};

/// How a garment behaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GarmentSettings {
    /// By how much the ellipsoids are enlarged under it: the layer it lies in (m).
    pub offset: f32,
    /// Largest stretch and largest shortening of an edge, as shares of its length at rest.
    pub stretch: f32,
    /// See `stretch`.
    pub shortening: f32,
    /// Friction on the ellipsoids: ratio of the largest tangential shift to the depth by which a
    /// vertex is put out.
    pub friction: f32,
    /// Share of the velocity lost in a second, as a rate (1/s).
    pub damping: f32,
    /// Stiffness of the springs on edges over the mass of a vertex (1/s2).
    pub stiffness: f32,
    /// Time in which the shape adjustment brings a vertex to a third of its distance from the
    /// rest shape (s).
    pub draw: f32,
    /// How far cloth that lies on the ellipsoids at rest may hang away from where its shape is
    /// carried (m); cloth that stands off from them may as much farther as it stands off.
    pub slack: f32,
    /// Rounds of edge bounds and pushing out in a frame, at the most.
    pub rounds: usize,
}

impl Default for GarmentSettings {
    fn default() -> Self {
        Self {
            offset: 0.0,
            stretch: 0.08,
            shortening: 0.08,
            friction: 0.6,
            damping: 2.0,
            stiffness: 300.0,
            draw: 0.08,
            slack: 0.03,
            rounds: 64,
        }
    }
}

/// A ball round a block with the ellipsoids that reach into it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ball {
    pub centre: [f32; 3],
    pub radius: f32,
}

impl Ball {
    /// Holds nothing: the ellipsoids must be found.
    pub const NOWHERE: Self = Self {
        centre: [0.0; 3],
        radius: f32::NEG_INFINITY,
    };
}

/// A garment on the ellipsoids of one character. Several garments share them, each with an offset
/// of its own; no test between cloths is made.
#[derive(Clone, Debug)]
pub struct Garment {
    pub(crate) settings: GarmentSettings,
    pub(crate) field: Field,
    pub(crate) edges: Edges,
    /// Which vertex of the mesh each column holds, and the way back.
    pub(crate) order: Vec<u32>,
    pub(crate) rank: Vec<u32>,
    pub(crate) places: Columns,
    /// Where vertices were carried to in this frame.
    pub(crate) starts: Columns,
    pub(crate) velocities: Columns,
    /// Rest shape, and where it is brought by its joints; `None` after an adjustment by gravity.
    pub(crate) bind: Columns,
    pub(crate) targets: Columns,
    /// Unit vectors out of the ellipsoids at rest.
    pub(crate) outward: Columns,
    pub(crate) follows_targets: bool,
    /// How far each vertex may be from its target (m).
    pub(crate) slack: Vec<f32>,
    pub(crate) homes: Homes,
    /// Row of the parent ellipsoid.
    pub(crate) parents: Vec<u32>,
    /// That at rest.
    pub(crate) first_parents: Vec<u32>,
    /// Joints: their frames at rest inverted, in the last frame, and how they moved.
    pub(crate) bind_inverse: Vec<Frame>,
    pub(crate) last: Vec<Frame>,
    pub(crate) motions: Vec<Frame>,
    pub(crate) balls: Vec<Ball>,
    /// Whether a vertex of each block has moved since the block was put out.
    pub(crate) has_moved: Vec<bool>,
    pub(crate) reached: Vec<u64>,
    pub(crate) scratch: Vec<f32>,
    pub(crate) turn: usize,
    pub(crate) adjusted: u64,
    pub(crate) rounds: u64,
}

impl Garment {
    /// A garment of a triangle mesh that lies over the ellipsoids as they are now; lengths of its
    /// edges and its shape there are its rest shape.
    ///
    /// # Errors
    /// No vertices or triangles, numbers that are none, vertices that are not there, edges without
    /// length, an offset no ellipsoid bears, bounds or rates that are none.
    pub fn new(
        ellipsoids: &Ellipsoids,
        positions: &[[f32; 3]],
        triangles: &[[u32; 3]],
        settings: GarmentSettings,
    ) -> Result<Self, RealtimeError> {
        settings.check()?;
        check_mesh(positions, triangles)?;
        let field = Field::new(ellipsoids, settings.offset)?;
        let order = along_a_curve(positions);
        let mut rank = vec![0; order.len()];
        for (k, &v) in order.iter().enumerate() {
            rank[v as usize] = k as u32;
        }
        let padded = order.len().next_multiple_of(LANES);
        let bind = columns(positions, &order, padded);
        let ranked: Vec<[u32; 3]> = triangles
            .iter()
            .map(|corners| corners.map(|v| rank[v as usize]))
            .collect();
        let edges = Edges::new(&ranked, &bind)?;
        let mut parents = Vec::with_capacity(padded);
        for block in 0..padded / LANES {
            let rows = field.nearest_rows(&bind.block(block), (&[u64::MAX; LANES], &[0; LANES]));
            parents.extend(rows.map(|row| row as u32));
        }
        let nearest: Vec<usize> = parents
            .iter()
            .map(|&row| ellipsoids.joints[row as usize])
            .collect();
        let frames = ellipsoids.frames();
        let words = field.len().div_ceil(64);
        let blocks = padded / LANES;
        let mut garment = Self {
            homes: Homes::new(&nearest, edges.ends(), frames.len()),
            bind_inverse: frames.iter().map(Frame::inverse).collect(),
            last: frames.to_vec(),
            motions: vec![Frame::NONE; frames.len()],
            balls: vec![Ball::NOWHERE; blocks],
            has_moved: vec![true; blocks],
            reached: vec![0; blocks * words],
            scratch: vec![0.0; field.len()],
            places: bind.clone(),
            starts: bind.clone(),
            targets: bind.clone(),
            velocities: Columns::zeros(padded),
            outward: Columns::zeros(padded),
            follows_targets: true,
            slack: vec![settings.slack; padded],
            turn: 0,
            adjusted: 0,
            rounds: 0,
            settings,
            field,
            edges,
            order,
            rank,
            bind,
            first_parents: parents.clone(),
            parents,
        };
        garment.rest_outside(&ranked)?;
        Ok(garment)
    }

    /// Takes for the rest shape the mesh put out of the enlarged ellipsoids: a layer farther out is
    /// wider, and bounds of its edges and the ellipsoids can hold together.
    fn rest_outside(&mut self, triangles: &[[u32; 3]]) -> Result<(), RealtimeError> {
        self.push_out(0.0);
        self.edges = Edges::new(triangles, &self.places)?;
        self.bind.copy_from(&self.places);
        self.targets.copy_from(&self.places);
        self.starts.copy_from(&self.places);
        for k in 0..self.order.len() {
            let place = self.places.at(k);
            let off = self.field.nearest(place).map_or(0.0, |near| near.distance);
            self.slack[k] += off.max(0.0);
            let way = self.field.steepest_way(self.parents[k] as usize, place);
            let length = dot(way, way).sqrt();
            self.outward.set(k, way.map(|x| x / length));
        }
        Ok(())
    }

    /// Number of vertices.
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// Whether there is none: never.
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// Where the vertices are, in the mesh's order (m). Nothing is computed: show it as often as
    /// needed, to one eye or two.
    pub fn positions(&self) -> impl ExactSizeIterator<Item = [f32; 3]> {
        self.rank.iter().map(|&k| self.places.at(k as usize))
    }

    /// How often it was adjusted.
    pub fn adjustments(&self) -> u64 {
        self.adjusted
    }

    /// Rounds of edge bounds and pushing out that all adjustments took together.
    pub fn rounds(&self) -> u64 {
        self.rounds
    }

    /// Shortest and longest edge over their lengths at rest, as ratios.
    pub fn edge_extremes(&self) -> [f32; 2] {
        self.edges.extremes(&self.places)
    }

    /// Vertices inside an ellipsoid of their own group, that of their parent.
    pub fn inside_count(&self) -> usize {
        self.count_within(|k| self.own_group(k))
    }

    /// Vertices inside an ellipsoid of another group that touches their own: pinched between limbs,
    /// as in an armpit.
    pub fn pinched_count(&self) -> usize {
        self.count_within(|k| self.sees(k) & !self.own_group(k))
    }

    fn count_within(&self, groups: impl Fn(usize) -> u64) -> usize {
        let is_inside = |&k: &usize| self.field.contains_among(self.places.at(k), groups(k));
        (0..self.len()).filter(is_inside).count()
    }

    /// The enlarged ellipsoids as of the last adjustment.
    pub fn field(&self) -> &Field {
        &self.field
    }

    pub(crate) fn own_group(&self, k: usize) -> u64 {
        1 << self.field.groups[self.parents[k] as usize]
    }

    pub(crate) fn sees(&self, k: usize) -> u64 {
        self.field.touching[self.field.groups[self.parents[k] as usize]]
    }

    /// The way out of the ellipsoids that a vertex has at rest, as its joint has turned since.
    pub(crate) fn outward(&self, k: usize) -> Vector {
        match self.homes.joints.get(k) {
            Some(&[joint, _]) => self.motions[usize::from(joint)].turned(self.outward.at(k)),
            None => [0.0, 1.0, 0.0],
        }
    }

    pub(crate) fn bounds(&self) -> Bounds {
        Bounds {
            least: 1.0 - self.settings.shortening,
            most: 1.0 + self.settings.stretch,
        }
    }
}

impl GarmentSettings {
    fn check(&self) -> Result<(), RealtimeError> {
        let ranges = [
            ("stretch", self.stretch, 0.001, 1.0),
            ("shortening", self.shortening, 0.001, 0.9),
            ("friction", self.friction, 0.0, 10.0),
            ("damping", self.damping, 0.0, 1e3),
            ("stiffness", self.stiffness, 0.0, 1e6),
            ("draw", self.draw, 1e-4, 1e3),
            ("slack", self.slack, 0.0, 1e3),
        ];
        for (name, value, least, most) in ranges {
            if !(least..=most).contains(&value) {
                return Err(RealtimeError::new(
                    name,
                    format!("{value} is not from {least} to {most}"),
                    "leave it at its default where in doubt",
                ));
            }
        }
        match self.rounds {
            1..=1000 => Ok(()),
            rounds => Err(RealtimeError::new(
                "rounds",
                format!("{rounds} is not from 1 to 1000"),
                "leave it at its default where in doubt",
            )),
        }
    }
}

fn check_mesh(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Result<(), RealtimeError> {
    if positions.is_empty() || triangles.is_empty() {
        return Err(RealtimeError::new(
            "garment",
            "it has no vertices or no triangles",
            "give a triangle mesh that lies over the character",
        ));
    }
    let is_place = |p: &[f32; 3]| p.iter().all(|x| x.abs() <= 1e3);
    if let Some(k) = positions.iter().position(|p| !is_place(p)) {
        return Err(RealtimeError::new(
            format!("positions[{k}]"),
            format!("{:?} is no place near the character", positions[k]),
            "give places in metres",
        ));
    }
    let count = positions.len() as u32;
    let lost = triangles.iter().position(|t| t.iter().any(|&v| v >= count));
    match lost {
        None => Ok(()),
        Some(k) => Err(RealtimeError::new(
            format!("triangles[{k}]"),
            format!(
                "{:?} names a vertex beyond the last of {count}",
                triangles[k]
            ),
            "number vertices from 0",
        )),
    }
}
