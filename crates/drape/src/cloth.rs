//! A cloth before it is simulated: positions, triangles, rest shapes and materials.

use crate::merge::keeps_corners;
use crate::{DrapeError, Material};
use serde::{Deserialize, Serialize};
use toile_geometry::{TriangleMesh, Vec2, Vec3};

/// A deformable surface: positions, and the rest shape of each triangle.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cloth {
    /// Positions (m).
    pub positions: Vec<Vec3>,
    /// Corners of the triangles.
    pub triangles: Vec<[u32; 3]>,
    /// Corners of each triangle in its material plane, warp along the first axis (m). Two
    /// triangles need not agree on a shared corner: panels keep their own planes when merged.
    pub rest: Vec<[Vec2; 3]>,
    /// Index into `materials` for each triangle.
    pub material: Vec<u16>,
    /// Panel each triangle belongs to: triangles of one panel share a material plane.
    pub panel: Vec<u32>,
    /// The materials used.
    pub materials: Vec<Material>,
}

/// Largest number of a panel: panel numbers of many concatenated objects still fit 32 bits.
const MAX_PANEL: u32 = 1 << 24;

impl Cloth {
    /// A cloth whose rest shape is the mesh itself: each triangle is a panel of its own with the size and shape it has
    /// in the mesh. The warp runs along the mesh's first axis, projected.
    ///
    /// # Errors
    /// Bad indices, coordinates that are not finite, triangles without area.
    pub fn from_mesh(
        object: &str,
        mesh: &TriangleMesh,
        material: Material,
    ) -> Result<Self, DrapeError> {
        let name = || object.to_owned();
        mesh.check().map_err(|defect| DrapeError::Mesh {
            object: name(),
            defect,
        })?;
        let mut rest = Vec::with_capacity(mesh.triangles.len());
        for triangle in 0..mesh.triangles.len() {
            let [a, b, c] = mesh.corners(triangle);
            let normal = (b - a).cross(&(c - a));
            let empty = || DrapeError::EmptyTriangle {
                object: name(),
                triangle,
            };
            let normal = normal.try_normalize(0.0).ok_or_else(empty)?;
            let along = if normal.x.abs() < 0.9 {
                Vec3::x()
            } else {
                Vec3::z()
            };
            let u = (along - normal * along.dot(&normal)).normalize();
            let v = normal.cross(&u);
            rest.push([a, b, c].map(|p| Vec2::new((p - a).dot(&u), (p - a).dot(&v))));
        }
        Ok(Self {
            positions: mesh.positions.clone(),
            triangles: mesh.triangles.clone(),
            material: vec![0; rest.len()],
            panel: (0..rest.len() as u32).collect(),
            materials: vec![material],
            rest,
        })
    }

    /// The first list that does not fit the triangles, in words; none where all fit.
    pub(crate) fn defect(&self) -> Option<String> {
        let count = self.triangles.len();
        let lists = [
            ("rest shapes", self.rest.len()),
            ("materials", self.material.len()),
            ("panels", self.panel.len()),
        ];
        if let Some((what, given)) = lists.iter().find(|(_, given)| *given != count) {
            return Some(format!("{given} {what} are given for {count} triangles"));
        }
        let materials = self.materials.len();
        if let Some(m) = (self.material.iter()).find(|&&m| usize::from(m) >= materials) {
            return Some(format!("there is no material {m}"));
        }
        let far = self.panel.iter().find(|&&panel| panel > MAX_PANEL)?;
        Some(format!("panel {far} is out of range"))
    }

    /// The surface at the present positions.
    pub fn mesh(&self) -> TriangleMesh {
        TriangleMesh {
            positions: self.positions.clone(),
            triangles: self.triangles.clone(),
        }
    }

    /// The cloth with merged vertices: `target[v]` is the new index of vertex `v`. The position of a merged vertex is
    /// the mean; triangles keep their rest shapes. A triangle with two of its vertices merged is dropped.
    pub fn merged(&self, target: &[u32], count: usize) -> Self {
        let mut sums = vec![(Vec3::zeros(), 0.0); count];
        for (position, &to) in self.positions.iter().zip(target) {
            let sum = &mut sums[to as usize];
            *sum = (sum.0 + position, sum.1 + 1.0);
        }
        let mut merged = Self {
            positions: sums
                .iter()
                .map(|&(sum, n)| sum / f64::max(n, 1.0))
                .collect(),
            materials: self.materials.clone(),
            ..Self::default()
        };
        for t in self.merged_triangles(target) {
            let corners = self.triangles[t].map(|v| target[v as usize]);
            merged.triangles.push(corners);
            merged.rest.push(self.rest[t]);
            merged.material.push(self.material[t]);
            merged.panel.push(self.panel[t]);
        }
        merged
    }

    /// Triangles that [`Self::merged`] does not drop, ascending.
    pub fn merged_triangles(&self, target: &[u32]) -> Vec<usize> {
        let keeps = |&t: &usize| keeps_corners(self.triangles[t], target);
        (0..self.triangles.len()).filter(keeps).collect()
    }
}
