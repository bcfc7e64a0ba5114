//! Squares of cloth of a metre at three resolutions, hung by two corners or dropped on a ball: the
//! scenes that frame times are told for.

use crate::LabError;
use crate::freeze::ball;
use std::sync::Arc;
use strum::{EnumCount, VariantArray, VariantNames};
use toile_drape::{Cloth, Collider, Material, State, System, SystemBuilder};
use toile_geometry::{SurfaceTree, TriangleMesh, Vec3};

/// The scene of a square.
#[derive(Clone, Copy, Debug, PartialEq, Eq, EnumCount, VariantArray, VariantNames)]
#[strum(serialize_all = "lowercase")]
pub(crate) enum Square {
    /// It lies flat, held at two corners of one side, and swings down.
    Hang,
    /// It falls from 50 mm above a ball of 0.25 m radius.
    Sphere,
}

/// Vertices along a side.
pub(crate) const SIDES: [u32; 3] = [33, 65, 129];

/// Radius of the ball (m), and how high above its middle the square starts (m).
const BALL: f64 = 0.25;
const START: f64 = 0.3;

impl Square {
    /// Both with their names.
    pub(crate) const ALL: [(&'static str, Self); Self::COUNT] = toile_geometry::named_variants!();

    /// The model and its state at the start.
    ///
    /// # Errors
    /// None for the sides of [`SIDES`].
    pub(crate) fn build(self, side: u32) -> Result<(System, State), LabError> {
        let height = match self {
            Self::Hang => 0.0,
            Self::Sphere => START,
        };
        let mesh = grid(side, height);
        let material = Material {
            density: 0.2,
            stretch: [1000.0; 2],
            shear: 1000.0 / 2.6,
            poisson: 0.3,
            bend: [1e-5; 3],
            friction: 0.5,
            ..Material::default()
        };
        let cloth = Cloth::from_mesh("square", &mesh, material)?;
        let mut builder = SystemBuilder::new("square", &cloth)?;
        match self {
            Self::Hang => {
                for corner in [side * (side - 1), side * side - 1] {
                    builder.pinned[corner as usize] = true;
                }
            }
            Self::Sphere => {
                let solid = SurfaceTree::new(ball(BALL, 4));
                builder.colliders.push(Collider::new(Arc::new(solid)));
            }
        }
        let system = builder.build();
        let state = State::at_rest(&system, mesh.positions);
        Ok((system, state))
    }
}

/// A square of a metre in a level plane, diagonals alternating.
fn grid(side: u32, height: f64) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    let cells = side - 1;
    for j in 0..side {
        for i in 0..side {
            let [x, z] = [i, j].map(|k| f64::from(k) / f64::from(cells) - 0.5);
            mesh.positions.push(Vec3::new(x, height, -z));
        }
    }
    for j in 0..cells {
        for i in 0..cells {
            let a = j * side + i;
            let (b, c, d) = (a + 1, a + side, a + side + 1);
            mesh.triangles.extend(if (i + j).is_multiple_of(2) {
                [[a, b, d], [a, d, c]]
            } else {
                [[a, b, c], [b, d, c]]
            });
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_have_their_size_and_mass() {
        for (name, square) in Square::ALL {
            let (system, state) = square.build(33).expect("a method that there is");
            assert_eq!(system.vertex_count(), 1089, "{name}");
            assert!((system.rest.mass.iter().sum::<f64>() - 0.2).abs() < 1e-12);
            let mesh = system.mesh(&state.positions);
            let corners = mesh.corners(0);
            let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
            assert!(normal.y > 0.0);
            let held = system
                .prescribed
                .pinned
                .iter()
                .filter(|&&pinned| pinned)
                .count();
            assert_eq!(held, if square == Square::Hang { 2 } else { 0 });
        }
    }
}
