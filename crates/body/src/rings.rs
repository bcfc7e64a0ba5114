//! Casts the skin of a template: rays from the axes of limbs and trunk meet the implicit surface in rings of
//! vertices.
//!
//! Only the left half, x >= 0, is cast; the right half is its mirror image. Trunk, neck and head are one tube
//! of half rings with a hole for the arm. The border of that hole is the arm's first ring; the lowest half
//! ring, closed along the crotch, is the leg's first ring. So parts share the points of their borders, and
//! the skin is a closed two-manifold by construction.

use crate::bands::Bands;
use crate::curve::smooth_step;
use crate::template::Template;
use crate::underarm::Underarm;
use crate::{BodyError, Field, Part};
use toile_geometry::{SurfaceTree, TriangleMesh, Vec3};

/// Number of steps of a half ring of the trunk, from the front midline round the left to the back midline. It
/// is even, so that one column runs down the side.
const HALF: usize = 24;
/// Number of points of the crotch line between front and back midline.
pub(crate) const CROTCH_POINTS: usize = 7;
/// Distance between rings of arms and legs, for a stature of 1.7 m (m).
pub(crate) const SPACING: f64 = 0.0165;
/// Number of rings from a border to the first plane ring of a limb.
pub(crate) const TRANSITION: usize = 5;

/// Distance along the side between rows over the shoulder, for a stature of 1.7 m (m). The rays of these rows
/// fan out from one point.
pub(crate) const FAN: f64 = 0.0145;

/// Distance between rows across the face, for a stature of 1.7 m (m).
const FACE: f64 = 0.0055;
/// Depth below the crown up to which the rows across the face reach, for a stature of 1.7 m (m).
const ABOVE_BROW: f64 = 0.08;
/// Largest angle by which rays gather at nose and ears (rad).
const GATHERING: f64 = 0.09;
/// Number of rows over which this angle grows to its largest value.
const GATHERED: usize = 4;
/// Number in place of a vertex where a grid has none, inside the hole for a limb.
pub(crate) const OPEN: u32 = u32::MAX;

/// A skin before any measurement is applied.
pub(crate) struct TemplateSkin {
    pub(crate) mesh: TriangleMesh,
    /// The part of each triangle.
    pub(crate) parts: Vec<Part>,
    /// Share with which each vertex follows the arm of its side instead of the trunk, 0 to 1.
    pub(crate) arm: Vec<f64>,
    /// Share with which each vertex follows the leg, 0 to 1.
    pub(crate) leg: Vec<f64>,
    /// The mirror image of each vertex; a vertex in the median plane is its own mirror image.
    pub(crate) mirror: Vec<u32>,
    /// Vertices of the left armpit, where the trunk ends and the arm begins, from front to back.
    pub(crate) armpit: Vec<u32>,
    /// The vertex at the front fold of the left armpit, where the arm's border turns upwards.
    pub(crate) fold: u32,
    /// Index of the left half's triangles by position.
    pub(crate) bands: Bands,
    /// The arm's first rings on its underside.
    pub(crate) underarm: Underarm,
}

/// Origin and elevation of the rays of one half ring of the trunk.
#[derive(Clone, Copy)]
struct Row {
    origin: Vec3,
    /// Angle of the rays above the horizontal (rad).
    elevation: f64,
    part: Part,
    /// Angle by which the rays of a row across the face gather at nose and ears (rad); such a row has twice
    /// the columns. `None` for other rows.
    gathering: Option<f64>,
}

impl Row {
    /// Number of steps from the front midline to the back midline.
    fn columns(&self) -> usize {
        match self.gathering {
            Some(_) => 2 * HALF,
            None => HALF,
        }
    }

    /// Angle of a column from the front (rad).
    fn azimuth(&self, column: usize) -> f64 {
        let even = std::f64::consts::PI * column as f64 / self.columns() as f64;
        even - self.gathering.unwrap_or_default() * (4.0 * even).sin()
    }
}

/// The block of the trunk's grid that is left open for the arm: first and last row and column.
#[derive(Clone, Copy)]
struct Hole {
    rows: [usize; 2],
    columns: [usize; 2],
}

impl Hole {
    /// Whether a vertex lies strictly inside the hole.
    fn inside(&self, t: usize, i: usize) -> bool {
        let within = |[low, high]: [usize; 2], at: usize| at > low && at < high;
        within(self.rows, t) && within(self.columns, i)
    }

    /// Grid steps from a vertex to the hole's border.
    fn steps_to(&self, t: usize, i: usize) -> f64 {
        let beyond = |[low, high]: [usize; 2], at: usize| {
            low.saturating_sub(at).max(at.saturating_sub(high))
        };
        beyond(self.rows, t).max(beyond(self.columns, i)) as f64
    }
}

/// The left half of a skin while it is cast.
pub(crate) struct Half<'a> {
    pub(crate) template: &'a Template,
    pub(crate) field: &'a Field,
    pub(crate) positions: Vec<Vec3>,
    /// Whether each vertex lies in the median plane.
    middle: Vec<bool>,
    pub(crate) arm: Vec<f64>,
    pub(crate) leg: Vec<f64>,
    /// Vertices that fairing does not move.
    pub(crate) held: Vec<bool>,
    triangles: Vec<[u32; 3]>,
    parts: Vec<Part>,
}

/// Casts the skin of a template.
pub(crate) fn cast(template: &Template, field: &Field) -> Result<TemplateSkin, BodyError> {
    let mut half = Half {
        template,
        field,
        positions: Vec::new(),
        middle: Vec::new(),
        arm: Vec::new(),
        leg: Vec::new(),
        held: Vec::new(),
        triangles: Vec::new(),
        parts: Vec::new(),
    };
    let border = half.trunk()?;
    half.arm(&border.arm)?;
    half.leg(&border.bottom)?;
    Ok(half.mirrored(&border))
}

/// Casts the skin of a template with a frame of its own. A hand whose tip is not enclosed by the primitives
/// is shortened, at most to half.
pub(crate) fn cast_framed(template: &mut Template) -> Result<TemplateSkin, BodyError> {
    let field = Field::new(&template.primitives);
    let least = 0.5 * template.hand;
    loop {
        match cast(template, &field) {
            Err(BodyError::Open { part, .. })
                if part == Part::LeftArm.name() && template.hand > least =>
            {
                template.hand *= 0.93;
            }
            other => return other.map(|skin| clear_under_the_arms(skin, template.height)),
        }
    }
}

/// The given skin if it does not cross itself. Otherwise the first rings under the arms are evened out, as on
/// bodies grown to measurements; that skin is taken if it has fewer crossings.
fn clear_under_the_arms(mut skin: TemplateSkin, stature: f64) -> TemplateSkin {
    let before = crossings(&skin.mesh);
    if before == 0 {
        return skin;
    }
    let mut drawn = skin.mesh.clone();
    skin.underarm.draw(&mut drawn.positions, stature);
    for (v, &image) in skin.mirror.iter().enumerate() {
        if image as usize > v {
            let p = drawn.positions[v];
            drawn.positions[image as usize] = Vec3::new(-p.x, p.y, p.z);
        }
    }
    if crossings(&drawn) < before {
        skin.mesh = drawn;
    }
    skin
}

/// Number of pairs of triangles that cross.
pub(crate) fn crossings(mesh: &TriangleMesh) -> usize {
    SurfaceTree::new(mesh.clone()).self_intersections().len()
}

/// Vertices of the trunk at which the limbs begin. `arm` and `bottom` list them in the order of the rings of
/// arm and leg.
struct Borders {
    armpit: Vec<u32>,
    fold: u32,
    /// Columns of the trunk's side under the arm, front to back, each from the lowest row up to the hole.
    side: Vec<Vec<u32>>,
    arm: Vec<u32>,
    bottom: Vec<u32>,
}

impl Half<'_> {
    pub(crate) fn add(&mut self, position: Vec3, middle: bool) -> u32 {
        self.positions.push(position);
        self.middle.push(middle);
        self.arm.push(0.0);
        self.leg.push(0.0);
        self.held.push(false);
        (self.positions.len() - 1) as u32
    }

    pub(crate) fn face(&mut self, part: Part, corners: [u32; 3]) {
        self.triangles.push(corners);
        self.parts.push(part);
    }

    /// Point where a ray from a point inside first leaves the union of some parts; an error names the first
    /// of them.
    pub(crate) fn hit(
        &self,
        parts: &[Part],
        origin: Vec3,
        direction: Vec3,
    ) -> Result<Vec3, BodyError> {
        match self.field.first_exit(parts, origin, direction) {
            Some(distance) => Ok(origin + direction * distance),
            None => Err(BodyError::Open {
                part: parts.first().map_or("body", |part| part.name()),
                x: origin.x,
                y: origin.y,
                z: origin.z,
            }),
        }
    }

    /// Height at which the underside of the arm meets the side of the trunk (m).
    fn armpit(&self) -> f64 {
        let shoulder = Vec3::from(self.template.joints.shoulder);
        let step = 0.002;
        let mut y = shoulder.y - 0.02;
        let side = |y: f64| {
            let origin = Vec3::new(0.0, y, shoulder.z);
            let mut x = 0.06;
            while self.field.density(Part::Trunk, origin + Vec3::x() * x) >= crate::THRESHOLD {
                x += step;
            }
            origin + Vec3::x() * x
        };
        while y > 0.6 * shoulder.y && self.field.density(Part::LeftArm, side(y)) >= crate::THRESHOLD
        {
            y -= step;
        }
        y
    }

    /// The rows of the trunk, neck and head from the crotch to below the crown.
    fn rows(&self) -> Vec<Row> {
        let t = self.template;
        let scale = t.height / 1.7;
        let j = t.joints;
        let armpit = t.armpit.unwrap_or_else(|| self.armpit());
        let (neck, head) = (Vec3::from(j.neck), Vec3::from(j.head));
        let row = |origin: Vec3, elevation: f64, part: Part| Row {
            origin,
            elevation,
            part,
            gathering: None,
        };
        let mut rows = Vec::new();
        // Level rings up to the armpit.
        let bottom = t.crotch + 0.035 * scale;
        // If the height of the armpit is known, the level rows end the distance of one row below it.
        let base = armpit - if t.armpit.is_some() { FAN } else { 0.02 } * scale;
        let count = ((base - bottom) / (0.016 * scale)).round() as usize;
        let focus = Vec3::new(0.0, base, self.middle_z(j.chest, base));
        let bottom_z = self.middle_z(j.pelvis, bottom);
        for k in 0..count {
            let u = k as f64 / count as f64;
            let y = bottom + (base - bottom) * u;
            let z = bottom_z + (focus.z - bottom_z) * u;
            rows.push(row(Vec3::new(0.0, y, z), 0.0, Part::Trunk));
        }
        // A fan over the shoulders, evenly spaced along the side.
        let tip = Vec3::new(j.shoulder[0] + 0.005, j.shoulder[1] + 0.045 * scale, 0.0);
        let foot_of_neck = Vec3::new(t.neck_radius, neck.y - 0.002 * scale, 0.0);
        let path = [Vec3::new(tip.x - 0.01, base, 0.0), tip, foot_of_neck];
        let mut elevation = 0.0;
        for p in along(&path, FAN * scale) {
            elevation = (p.y - base).atan2(p.x);
            rows.push(row(focus, elevation, Part::Trunk));
        }
        // The neck: from the fan back to level rings.
        let neck_top = Vec3::new(0.0, head.y - 0.035 * scale, 0.6 * neck.z + 0.4 * head.z);
        let neck_rows = 6;
        let straight = foot_of_neck.y + 0.45 * (neck_top.y - foot_of_neck.y);
        for k in 1..=neck_rows {
            let u = k as f64 / neck_rows as f64;
            let tilt = elevation * (1.0 - u) * (1.0 - 0.4 * u);
            let target = foot_of_neck.y + (straight - foot_of_neck.y) * u;
            let y = (target - t.neck_radius * tilt.tan()).max(base + 1e-3);
            let z = focus.z + (neck_top.z - focus.z) * 0.45 * u;
            rows.push(row(Vec3::new(0.0, y, z), tilt, Part::Head));
        }
        // The head: level rings, then a fan to the crown.
        let (spacing, under_crown) = match t.features {
            Some(_) => (FACE, ABOVE_BROW),
            None => (0.016, 0.095),
        };
        let centre = Vec3::new(0.0, t.height - under_crown * scale, head.z - 0.005 * scale);
        let above = Vec3::new(0.0, straight, focus.z + (neck_top.z - focus.z) * 0.45);
        let face = along(&[above, neck_top, centre], spacing * scale);
        for (k, &p) in face.iter().enumerate() {
            // No gathering next to the rows that have half as many columns.
            let share = k.min(face.len() - 1 - k) as f64 / GATHERED as f64;
            rows.push(Row {
                gathering: t.features.map(|_| GATHERING * share.min(1.0)),
                ..row(p, 0.0, Part::Head)
            });
        }
        let crown = 9;
        for k in 1..crown {
            let up = std::f64::consts::FRAC_PI_2 * k as f64 / crown as f64;
            rows.push(row(centre, up, Part::Head));
        }
        rows
    }

    /// Depth half-way between the front and the back surface of the trunk at a height, seen from a joint (m).
    fn middle_z(&self, joint: [f64; 3], y: f64) -> f64 {
        let origin = Vec3::new(0.0, y, joint[2]);
        let front = self.field.first_exit(&[Part::Trunk], origin, Vec3::z());
        let back = self.field.first_exit(&[Part::Trunk], origin, -Vec3::z());
        match (front, back) {
            (Some(f), Some(b)) => joint[2] + 0.5 * (f - b),
            _ => joint[2],
        }
    }

    /// The last row whose point at the side lies below the arm.
    fn armpit_row(&self, rows: &[Row]) -> Result<usize, BodyError> {
        let scale = self.template.height / 1.7;
        for (t, row) in rows.iter().enumerate() {
            let (sin, cos) = row.elevation.sin_cos();
            let point = self.hit(&[Part::Trunk], row.origin, Vec3::new(cos, sin, 0.0))?;
            let above = self
                .template
                .armpit
                .map(|armpit| point.y > armpit + 0.3 * FAN * scale);
            let is_under_the_arm = || self.field.density(Part::LeftArm, point) >= crate::THRESHOLD;
            if above.unwrap_or_else(is_under_the_arm) {
                return Ok(t.saturating_sub(1));
            }
        }
        let [x, y, z] = self.template.joints.shoulder;
        Err(BodyError::Open {
            part: Part::LeftArm.name(),
            x,
            y,
            z,
        })
    }

    fn trunk(&mut self) -> Result<Borders, BodyError> {
        let rows = self.rows();
        let hole = self.hole(&rows)?;
        let grid = self.cast_rows(&rows, hole)?;
        if self.template.armpit.is_some() {
            self.below_the_chin(&rows, &grid)?;
        }
        for (t, (lower, upper)) in grid.iter().zip(&grid[1..]).enumerate() {
            self.strip(rows[t + 1].part, [lower, upper]);
        }
        let last = rows.len() - 1;
        let crown = self.hit(&[Part::Head], rows[last].origin, Vec3::y())?;
        let pole = self.add(crown, true);
        for i in 0..HALF {
            self.face(Part::Head, [grid[last][i], grid[last][i + 1], pole]);
        }
        let ([r0, r1], [c0, c1]) = (hole.rows, hole.columns);
        let mut arm: Vec<u32> = (c0..c1).rev().map(|i| grid[r1][i + 1]).collect();
        arm.extend((r0 + 1..=r1).rev().map(|t| grid[t][c0]));
        arm.extend((c0..c1).map(|i| grid[r0][i]));
        arm.extend((r0..r1).map(|t| grid[t][c1]));
        let bottom = grid[0].iter().rev().copied().collect();
        let armpit = grid[r0][c0..=c1].to_vec();
        Ok(Borders {
            side: (c0..=c1)
                .map(|i| (0..=r0).map(|t| grid[t][i]).collect())
                .collect(),
            armpit,
            fold: grid[r0][c0],
            arm,
            bottom,
        })
    }

    /// The hole for the arm: from below the armpit to the row that passes over the shoulder.
    fn hole(&self, rows: &[Row]) -> Result<Hole, BodyError> {
        let scale = self.template.height / 1.7;
        let shoulder = Vec3::from(self.template.joints.shoulder);
        let low = self.armpit_row(rows)?;
        let rise = shoulder.y + 0.035 * scale - rows[low].origin.y;
        let top = rise.atan2(shoulder.x);
        let high = (low..rows.len())
            .find(|&t| rows[t].elevation >= top)
            .unwrap_or(low)
            .max(low + 4)
            .min(rows.len() - 2);
        Ok(Hole {
            rows: [low, high],
            columns: [HALF / 2 - 4, HALF / 2 + 4],
        })
    }

    /// Casts the vertices of all rows, except those inside the hole.
    fn cast_rows(&mut self, rows: &[Row], hole: Hole) -> Result<Vec<Vec<u32>>, BodyError> {
        let mut grid: Vec<Vec<u32>> = (rows.iter())
            .map(|row| vec![OPEN; row.columns() + 1])
            .collect();
        for (t, (row, vertices)) in rows.iter().zip(&mut grid).enumerate() {
            let (sin, cos) = row.elevation.sin_cos();
            for (i, vertex) in vertices.iter_mut().enumerate() {
                if hole.inside(t, i) {
                    continue;
                }
                let angle = row.azimuth(i);
                let middle = i == 0 || i == row.columns();
                let level = Vec3::new(if middle { 0.0 } else { angle.sin() }, 0.0, angle.cos());
                let direction = (level * cos + Vec3::y() * sin).normalize();
                let position = self.hit(reachable(row.part), row.origin, direction)?;
                *vertex = self.add(position, middle);
                self.arm[*vertex as usize] = follow(-hole.steps_to(t, i));
                self.leg[*vertex as usize] = follow(-(t as f64));
                self.held[*vertex as usize] = row.gathering.is_some();
            }
        }
        Ok(grid)
    }

    /// Replaces the points of tilted neck rays that ran on into a large chin. The new rays are level and
    /// start from the axis of the neck, evenly spaced between the rows below and the first level row.
    fn below_the_chin(&mut self, rows: &[Row], grid: &[Vec<u32>]) -> Result<(), BodyError> {
        /// Largest height of the end of a tilted ray above the first level row, as a share of stature, on a
        /// body without features and with them: less than half the distance to the next row.
        const OVER: [f64; 2] = [0.006, 0.0016];
        let is_head = |t: &usize| rows[*t].part == Part::Head;
        let Some(neck) = (1..rows.len()).find(is_head) else {
            return Ok(());
        };
        let is_level = |t: &usize| rows[*t].elevation <= 0.0;
        let Some(level) = (neck..rows.len()).find(is_level) else {
            return Ok(());
        };
        let top = rows[level].origin;
        let over = OVER[usize::from(self.template.features.is_some())];
        for i in 0..=HALF {
            let height = |half: &Self, t: usize| half.positions[grid[t][i] as usize].y;
            let most = top.y + over * self.template.height;
            let Some(first) = (neck..level).find(|&t| height(self, t) > most) else {
                continue;
            };
            let from = height(self, first - 1).min(top.y);
            let angle = std::f64::consts::PI * i as f64 / HALF as f64;
            let middle = i == 0 || i == HALF;
            let across = Vec3::new(if middle { 0.0 } else { angle.sin() }, 0.0, angle.cos());
            for (t, row) in grid.iter().enumerate().take(level).skip(first) {
                let share = (t + 1 - first) as f64 / (level + 1 - first) as f64;
                let origin = Vec3::new(0.0, from + (top.y - from) * share, top.z);
                self.positions[row[i] as usize] =
                    self.hit(reachable(Part::Head), origin, across.normalize())?;
            }
        }
        Ok(())
    }

    fn mirrored(self, border: &Borders) -> TemplateSkin {
        let count = self.positions.len();
        let mut mirror: Vec<u32> = vec![0; count];
        let mut mesh = TriangleMesh {
            positions: self.positions,
            triangles: self.triangles,
        };
        let (mut arm, mut leg, mut parts) = (self.arm, self.leg, self.parts);
        let held = self.held;
        for v in 0..count {
            if self.middle[v] {
                mesh.positions[v].x = 0.0;
                mirror[v] = v as u32;
            } else {
                let p = mesh.positions[v];
                mirror[v] = mesh.positions.len() as u32;
                mirror.push(v as u32);
                mesh.positions.push(Vec3::new(-p.x, p.y, p.z));
                arm.push(arm[v]);
                leg.push(leg[v]);
            }
        }
        for t in 0..mesh.triangles.len() {
            let [a, b, c] = mesh.triangles[t].map(|v| mirror[v as usize]);
            mesh.triangles.push([a, c, b]);
            parts.push(match parts[t] {
                Part::LeftArm => Part::RightArm,
                Part::LeftLeg => Part::RightLeg,
                part => part,
            });
        }
        // The soles stay flat, vertices of the median plane stay in the plane x = 0, and the right half stays
        // the mirror image of the left.
        let is_held = |v: usize| held[v.min(mirror[v] as usize)];
        crate::fair::fair(&mut mesh, |v, p| p.y <= 0.0 || is_held(v));
        for (v, &image) in mirror.iter().enumerate() {
            let image = image as usize;
            if image == v {
                mesh.positions[v].x = 0.0;
            } else if image > v {
                mesh.positions[v].y = mesh.positions[v].y.max(0.0);
                let p = mesh.positions[v];
                mesh.positions[image] = Vec3::new(-p.x, p.y, p.z);
            }
        }
        let j = self.template.joints;
        let shoulder = Vec3::from(j.shoulder);
        let along = (Vec3::from(j.wrist) - shoulder).normalize();
        TemplateSkin {
            bands: Bands::new(&mesh, &parts, [shoulder, along]),
            underarm: Underarm::of(&mesh, &arm, &border.side, shoulder.y),
            mesh,
            parts,
            arm,
            leg,
            mirror,
            armpit: border.armpit.clone(),
            fold: border.fold,
        }
    }
}

/// Share with which a vertex follows a limb, by its number of rings from the limb's border, negative on the
/// trunk's side.
pub(crate) fn follow(rings: f64) -> f64 {
    smooth_step((rings + 4.0) / 9.0)
}

/// Points about `spacing` apart along a polyline, without its first point and with its last.
fn along(path: &[Vec3], spacing: f64) -> Vec<Vec3> {
    let length: f64 = path.windows(2).map(|w| (w[1] - w[0]).norm()).sum();
    let count = (length / spacing).round().max(1.0) as usize;
    (1..=count)
        .map(|k| at_length(path, length * k as f64 / count as f64))
        .collect()
}

/// The point at a length along a polyline (m).
pub(crate) fn at_length(path: &[Vec3], mut length: f64) -> Vec3 {
    for w in path.windows(2) {
        let step = (w[1] - w[0]).norm();
        if length <= step {
            return w[0] + (w[1] - w[0]) * (length / step);
        }
        length -= step;
    }
    path[path.len() - 1]
}

/// Parts that a ray of a row may run through before it leaves the body.
fn reachable(part: Part) -> &'static [Part] {
    match part {
        Part::Head => &[Part::Head, Part::Trunk],
        _ => &[Part::Trunk],
    }
}
