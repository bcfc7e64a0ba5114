//! A state as its potential is expanded there: for comparing one build of the program with another.

use super::{Inertia, Workspace};
use crate::collision::ClothContact;
use crate::laws::membrane::Curvature;
use crate::{Contact, State, System};
use toile_geometry::Vec3;

/// The potential of a state to the second order, without inertia.
pub struct Expansion {
    /// Energy of strain, elastics, contact and weight [J], heights counted from the origin.
    pub energy: f64,
    /// Its gradient by the place of each vertex [N], zero at pins.
    pub gradient: Vec<Vec3>,
    /// Its Hessian times each of the vectors given [N], pins not heeded.
    pub products: Vec<Vec<Vec3>>,
    /// Contacts with solid surfaces.
    pub surface: Vec<Contact>,
    /// Contacts of cloth with cloth.
    pub cloth: Vec<ClothContact>,
}

impl Workspace {
    /// Expands the potential of a state that stands still. `curvature` says how much of the part that can
    /// make the Hessian indefinite is in it.
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
