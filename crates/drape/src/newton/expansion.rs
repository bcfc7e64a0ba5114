//! The potential about a state to second order: recorded to compare builds of the program.

use super::{Inertia, Workspace};
use crate::collision::ClothContact;
use crate::laws::membrane::Curvature;
use crate::{Contact, State, System};
use toile_geometry::Vec3;

/// The potential of a state to the second order, without inertia.
pub struct Expansion {
    /// Energy of strain, elastics, contact and weight (J), heights counted from the origin.
    pub energy: f64,
    /// Its gradient by the position of each vertex (N), zero at pins.
    pub gradient: Vec<Vec3>,
    /// Products of its Hessian with the given vectors (N); rows and columns of pins are included.
    pub products: Vec<Vec<Vec3>>,
    /// Contacts with solid surfaces.
    pub surface: Vec<Contact>,
    /// Contacts of cloth with cloth.
    pub cloth: Vec<ClothContact>,
}

impl Workspace {
    /// Expands the static potential about a state, velocities left out. `curvature` is the fraction of the
    /// destabilising curvature in the Hessian.
    pub fn expand(
        &mut self,
        system: &System,
        state: &State,
        curvature: Curvature,
        vectors: &[Vec<Vec3>],
    ) -> Expansion {
        self.net_force(system, state);
        let gradient = self.gradient.iter().map(|force| -force).collect();
        let weight = vec![0.0; system.vertex_count()];
        let inertia = Inertia {
            weight: &weight,
            target: &state.positions,
        };
        let energy = self.potential(system, &state.positions, &inertia);
        self.fill_hessian(system, &state.positions, &inertia, curvature);
        let rows = 0..system.vertex_count();
        let times = |p: &Vec<Vec3>| {
            rows.clone()
                .map(|row| self.hessian_row(system, row, p))
                .collect()
        };
        Expansion {
            energy,
            gradient,
            products: vectors.iter().map(times).collect(),
            surface: self.contacts.active.clone(),
            cloth: self.contacts.cloth.all().copied().collect(),
        }
    }
}
