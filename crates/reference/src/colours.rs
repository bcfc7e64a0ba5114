//! Colours of vertices: two of one colour share no triangle, bending stencil or elastic.

use toile_drape::{Model, System};

/// Vertices by colour, computed once for a model.
#[derive(Default)]
pub struct Colours {
    vertices: Vec<u32>,
    start: Vec<usize>,
    /// The model for which they were computed.
    model: Option<Model>,
}

impl Colours {
    /// Computes the colours of a model; false where they are up to date.
    pub fn fit(&mut self, system: &System) -> bool {
        let fits = |of: &Model| of.has_cloth_of(system) && of.has_couplings_of(system);
        if self.model.as_ref().is_some_and(fits) {
            return false;
        }
        let n = system.vertex_count();
        self.model = Some(system.model.clone());
        let mut pairs: Vec<Vec<u32>> = vec![Vec::new(); n];
        for [from, to] in system.couplings.ends() {
            pairs[from as usize].push(to);
            pairs[to as usize].push(from);
        }
        // Greedy colouring in the order of the vertices: the lowest colour that no neighbour has.
        let mut colour_of = vec![u32::MAX; n];
        let mut taken: Vec<usize> = Vec::new();
        for v in 0..n {
            let neighbours = system.topology.pattern.row_columns(v).iter();
            let bending = system.rest.bending.row_entries(v).0.iter();
            for &u in neighbours.chain(bending).chain(&pairs[v]) {
                let colour = colour_of[u as usize];
                if colour != u32::MAX {
                    let colour = colour as usize;
                    if taken.len() <= colour {
                        taken.resize(colour + 1, usize::MAX);
                    }
                    taken[colour] = v;
                }
            }
            let free = taken.iter().position(|&by| by != v).unwrap_or(taken.len());
            colour_of[v] = free as u32;
        }
        let count = colour_of.iter().max().map_or(0, |&c| c as usize + 1);
        self.vertices.clear();
        self.start = vec![0];
        for colour in 0..count {
            let own = (0..n as u32).filter(|&v| colour_of[v as usize] as usize == colour);
            self.vertices.extend(own);
            self.start.push(self.vertices.len());
        }
        true
    }

    /// Number of colours.
    pub fn count(&self) -> usize {
        self.start.len().saturating_sub(1)
    }

    /// The vertices of a colour, ascending.
    pub fn vertices(&self, colour: usize) -> &[u32] {
        &self.vertices[self.start[colour]..self.start[colour + 1]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_drape::{Cloth, Material};
    use toile_geometry::{TriangleMesh, Vec3};

    #[test]
    fn vertices_of_one_colour_are_not_coupled() {
        let mut mesh = TriangleMesh::default();
        for v in 0..100u32 {
            mesh.positions
                .push(Vec3::new(f64::from(v % 10), f64::from(v / 10), 0.0) * 0.01);
        }
        for v in 0..90u32 {
            if v % 10 < 9 {
                mesh.triangles
                    .extend([[v, v + 1, v + 11], [v, v + 11, v + 10]]);
            }
        }
        let cloth = Cloth::from_mesh("cloth", &mesh, Material::default()).unwrap();
        let system = System::new("cloth", &cloth).unwrap();
        let mut colours = Colours::default();
        assert!(colours.fit(&system) && !colours.fit(&system));
        let mut seen = [false; 100];
        for colour in 0..colours.count() {
            let own = colours.vertices(colour);
            for &v in own {
                assert!(!std::mem::replace(&mut seen[v as usize], true));
                let (columns, _) = system.rest.bending.row_entries(v as usize);
                for &u in system
                    .topology
                    .pattern
                    .row_columns(v as usize)
                    .iter()
                    .chain(columns)
                {
                    assert!(u == v || !own.contains(&u), "{u} and {v} share {colour}");
                }
            }
        }
        assert!(seen.iter().all(|&seen| seen));
        assert!(colours.count() < 24, "{}", colours.count());
    }
}
