//! The matrix of a Newton step: membrane, contact and inertia as 3x3 blocks over the mesh's edges, bending as scalars
//! over two rings of neighbours, elastics between any two vertices. Rows are computed on demand; a direct solver
//! factorises it.

use crate::collision::Couplings;
use crate::{ElasticEnd, Model, System};
use nalgebra::Matrix3;
use toile_geometry::Vec3;
use toile_sparse::ScalarMatrix;
use toile_sparse::factor::{Block, Factor, Graph};

/// A symmetric positive semidefinite Hessian; rows and columns of pinned vertices are not used.
pub struct Hessian<'a> {
    pub system: &'a System,
    /// Bending, with the viscous term of the step.
    pub bending: &'a ScalarMatrix,
    /// Blocks over the mesh's pattern; the diagonal ones include all terms but bending.
    pub blocks: &'a [Matrix3<f64>],
    /// Stiffness of each elastic (N/m).
    pub secants: &'a [f64],
    /// Blocks between vertices coupled by contact of cloth with cloth.
    pub touching: &'a Couplings,
}

/// Numbering of the unknowns: the vertices that are not pinned, in the order of the mesh.
struct Unknowns {
    /// Vertex of each unknown.
    vertex: Vec<u32>,
    /// Unknown of each vertex, `PINNED` for a pinned one.
    number: Vec<u32>,
}

/// Number of a pinned vertex, which is no unknown.
const PINNED: u32 = u32::MAX;

impl Unknowns {
    fn new(system: &System) -> Self {
        let all = 0..system.vertex_count() as u32;
        let vertex: Vec<u32> = all
            .filter(|&v| !system.prescribed.pinned[v as usize])
            .collect();
        let mut number = vec![PINNED; system.vertex_count()];
        for (at, &v) in (0..).zip(&vertex) {
            number[v as usize] = at;
        }
        Self { vertex, number }
    }

    /// The unknowns of a pair of vertices; none where one is pinned.
    fn pair(&self, pair: [u32; 2]) -> Option<[u32; 2]> {
        let pair = pair.map(|v| self.number[v as usize]);
        (!pair.contains(&PINNED)).then_some(pair)
    }

    /// The graph of unknowns that the matrix couples.
    fn graph(&self, system: &System, touching: &[[u32; 2]]) -> Graph {
        let mesh = self.vertex.iter().flat_map(|&v| {
            let edges = system.topology.pattern.row_columns(v as usize);
            let bending = system.rest.bending.row_entries(v as usize).0;
            // Each pair once.
            let after = edges.iter().chain(bending).filter(move |&&u| u > v);
            after.map(move |&u| [v, u])
        });
        let others = couples(system).chain(touching.iter().copied());
        let pairs = mesh.chain(others).filter_map(|pair| self.pair(pair));
        Graph::from_pairs(self.vertex.len(), pairs)
    }
}

/// Vertices coupled by elastics.
fn couples(system: &System) -> impl Iterator<Item = [u32; 2]> + '_ {
    system.couplings.ends()
}

impl Hessian<'_> {
    /// A row times a vector, pinned vertices included.
    pub fn row_times(&self, row: usize, p: &[Vec3]) -> Vec3 {
        let system = self.system;
        let mut sum =
            system.topology.pattern.row_times(row, self.blocks, p) + self.bending.row_times(row, p);
        for (e, other) in system.elastics_at(row) {
            if let ElasticEnd::Vertex(other) = other {
                sum -= p[other as usize] * self.secants[e];
            }
        }
        sum + self.touching.row_times(row, p)
    }

    /// The diagonal block of a row.
    pub fn diagonal(&self, row: usize) -> Matrix3<f64> {
        self.system
            .topology
            .pattern
            .diagonal_block(row, self.blocks)
            + Matrix3::identity() * self.bending.diagonal(row)
    }

    /// Writes the row of an unknown for the factorisation; `columns` are the unknowns of its sparsity pattern.
    fn fill_row(&self, unknowns: &Unknowns, row: usize, columns: &[u32], out: &mut [Block<3>]) {
        let system = self.system;
        out.fill([[0.0; 3]; 3]);
        let row = unknowns.vertex[row] as usize;
        let number = |vertex: u32| unknowns.number[vertex as usize];
        let (edges, blocks) = system.topology.pattern.row_entries(row, self.blocks);
        let mut at = 0;
        for (&vertex, block) in edges.iter().zip(blocks) {
            if seek(columns, &mut at, number(vertex)) {
                // Matrix3 holds columns, a block rows.
                out[at] = block.transpose().into();
            }
        }
        let (neighbours, values) = self.bending.row_entries(row);
        let mut at = 0;
        for (&vertex, &value) in neighbours.iter().zip(values) {
            if seek(columns, &mut at, number(vertex)) {
                (0..3).for_each(|k| out[at][k][k] += value);
            }
        }
        for (e, other) in system.elastics_at(row) {
            if let ElasticEnd::Vertex(other) = other
                && let Ok(at) = columns.binary_search(&number(other))
            {
                (0..3).for_each(|k| out[at][k][k] -= self.secants[e]);
            }
        }
        let mut at = 0;
        for (vertex, block) in self.touching.row(row) {
            if seek(columns, &mut at, number(vertex)) {
                for (i, row) in out[at].iter_mut().enumerate() {
                    (0..3).for_each(|k| row[k] += block[(i, k)]);
                }
            }
        }
    }
}

/// Advances `at` to the index of a column in an ascending list; false for a pinned vertex, which has no column.
fn seek(columns: &[u32], at: &mut usize, column: u32) -> bool {
    if column == PINNED {
        return false;
    }
    while columns[*at] < column {
        *at += 1;
    }
    true
}

/// Direct solver of a [`Hessian`], with one symbolic factorisation for many numeric ones.
pub struct Direct {
    factor: Factor<3>,
    unknowns: Unknowns,
    /// The model of the symbolic factorisation.
    model: Model,
    /// Contact pairs of vertices in the sparsity pattern of the symbolic factorisation.
    touching: Vec<[u32; 2]>,
    /// Right side and solution at the unknowns.
    right: Vec<Vec3>,
    solution: Vec<Vec3>,
    /// Whether the last numeric factorisation succeeded.
    is_factorised: bool,
}

impl Direct {
    /// Symbolic factorisation for a model and contact pairs of vertices; `layout` are positions of the vertices, for
    /// nested dissection (m).
    pub fn new(system: &System, layout: &[Vec3], touching: &[[u32; 2]]) -> Self {
        let unknowns = Unknowns::new(system);
        let graph = unknowns.graph(system, touching);
        let layout: Vec<Vec3> = (unknowns.vertex.iter())
            .map(|&v| layout[v as usize])
            .collect();
        Self {
            factor: Factor::new(graph, &layout),
            model: system.model.clone(),
            touching: touching.to_vec(),
            right: Vec::new(),
            solution: vec![Vec3::zeros(); layout.len()],
            unknowns,
            is_factorised: false,
        }
    }

    /// Contact pairs of vertices in the sparsity pattern.
    pub fn touching(&self) -> &[[u32; 2]] {
        &self.touching
    }

    /// Whether it is of a model with the same triangles, prescribed vertices and elastics.
    pub fn is_of(&self, model: &Model) -> bool {
        self.model.has_structure_of(model) && self.model.has_couplings_of(model)
    }

    /// Whether the sparsity pattern covers a system with its contact pairs.
    pub fn fits(&self, system: &System, touching: &Couplings) -> bool {
        let graph = self.factor.graph();
        let has = |[a, b]: [u32; 2]| graph.row(a as usize).binary_search(&b).is_ok();
        self.is_of(system)
            && (touching.places())
                .filter_map(|pair| self.unknowns.pair(pair))
                .all(has)
    }

    /// Factorises A and solves A x = b for the free vertices; x is zero at pinned ones. False when the matrix is not
    /// numerically positive definite; `x` is then undefined.
    pub fn solve(&mut self, hessian: &Hessian, b: &[Vec3], x: &mut [Vec3]) -> bool {
        let unknowns = &self.unknowns;
        let fill = |row: usize, columns: &[u32], out: &mut [Block<3>]| {
            hessian.fill_row(unknowns, row, columns, out);
        };
        self.is_factorised = self.factor.factorise(fill).is_ok();
        self.solve_again(b, x)
    }

    /// Solves A x = b with the last factor; false without one.
    pub fn solve_again(&mut self, b: &[Vec3], x: &mut [Vec3]) -> bool {
        if !self.is_factorised {
            return false;
        }
        let vertices = &self.unknowns.vertex;
        self.right.clear();
        (self.right).extend(vertices.iter().map(|&v| b[v as usize]));
        self.factor.solve(&self.right, &mut self.solution);
        x.fill(Vec3::zeros());
        for (&v, solution) in vertices.iter().zip(&self.solution) {
            x[v as usize] = *solution;
        }
        (self.solution.iter()).all(|x| x.iter().all(|x| x.is_finite()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::elastic::ElasticLaw;
    use crate::laws::membrane::Curvature;
    use crate::{Cloth, Elastic, Inertia, Material, State, Workspace};
    use toile_geometry::{TriangleMesh, Vec2};

    /// Two sheets of 20 x 20 squares above each other, the second of another material.
    fn sheets(second: Material) -> Cloth {
        let mut cloth = Cloth {
            materials: vec![Material::default(), second],
            ..Cloth::default()
        };
        for sheet in 0..2u32 {
            let at = |i: u32, j: u32| sheet * 441 + j * 21 + i;
            let flat = |[i, j]: [u32; 2]| Vec2::new(0.015 * f64::from(i), 0.015 * f64::from(j));
            for v in 0..441 {
                let p = flat([v % 21, v / 21]);
                let wave = 0.004 * (40.0 * p.x).sin() * (30.0 * p.y).cos();
                let position = Vec3::new(p.x, p.y, 0.02 * f64::from(sheet) + wave);
                cloth.positions.push(position);
            }
            for (i, j) in (0..400).map(|q| (q % 20, q / 20)) {
                let [a, b, c, d] = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
                for corners in [[a, b, c], [a, c, d]] {
                    cloth.triangles.push(corners.map(|[i, j]| at(i, j)));
                    cloth.rest.push(corners.map(flat));
                    cloth.material.push(sheet as u16);
                }
            }
        }
        cloth
    }

    /// Norm of A x - b over the norm of b, the weights, and over |A| |x| + |b|, the scale of rounding, with pseudo
    /// steps of `step` seconds.
    fn residuals(system: &System, positions: &[Vec3], step: f64) -> [f64; 2] {
        let state = State::at_rest(system, positions.to_vec());
        let mut workspace = Workspace::default();
        workspace.net_force(system, &state);
        let weight: Vec<f64> = system.rest.mass.iter().map(|m| m / (step * step)).collect();
        let inertia = Inertia {
            weight: &weight,
            target: positions,
        };
        workspace.fill_hessian(system, positions, &inertia, Curvature::CONVEX);
        let hessian = workspace.hessian(system);
        let free = |v: usize, p: Vec3| {
            if system.prescribed.pinned[v] {
                Vec3::zeros()
            } else {
                p
            }
        };
        let b: Vec<Vec3> = (0..positions.len())
            .map(|v| free(v, system.control.gravity * system.rest.mass[v]))
            .collect();
        let mut x = vec![Vec3::zeros(); b.len()];
        let mut direct = Direct::new(system, &system.topology.layout, &[]);
        assert!(direct.fits(system, &Couplings::default()));
        assert!(direct.solve(&hessian, &b, &mut x));
        let (mut off, mut whole, mut found, mut largest) = (0.0, 0.0, 0.0, 0.0f64);
        for v in 0..b.len() {
            found += x[v].norm_squared();
            largest = largest.max(hessian.diagonal(v).norm());
            assert!(!system.prescribed.pinned[v] || x[v] == Vec3::zeros());
            off += free(v, hessian.row_times(v, &x) - b[v]).norm_squared();
            whole += b[v].norm_squared();
        }
        let [off, whole, found]: [f64; 3] = [off, whole, found].map(f64::sqrt);
        [off / whole, off / (largest * found + whole)]
    }

    fn check(system: &System, positions: &[Vec3], step: f64) {
        let [relative, rounding] = residuals(system, positions, step);
        assert!(rounding < 1e-14, "{step} s: {rounding:e}");
        assert!(relative < 1e-3, "{step} s: {relative:e}");
    }

    fn stiff(by: f64) -> Material {
        let soft = Material::default();
        Material {
            stretch: soft.stretch.map(|k| k * by),
            shear: soft.shear * by,
            bend: soft.bend.map(|k| k * by),
            ..soft
        }
    }

    #[test]
    fn ill_conditioned_systems_are_solved() {
        let cloth = sheets(stiff(1e4));
        let mut system = System::new("sheets", &cloth).unwrap();
        // Pseudo steps from the first to the longest of pseudo-transient continuation; sheets pinned at one corner, and
        // free sheets, whose matrix is regular by inertia alone.
        for (pins, step) in [
            (vec![], 0.02),
            (vec![], 1.0),
            (vec![0, 441], 0.02),
            (vec![0, 441], 100.0),
        ] {
            system = system.with(|builder| {
                builder.pinned.fill(false);
                pins.iter().for_each(|&v: &usize| builder.pinned[v] = true);
            });
            check(&system, &cloth.positions, step);
        }
    }

    #[test]
    fn crushed_and_stretched_cloth_is_solved() {
        let cloth = sheets(stiff(1.0));
        let system = System::new("sheets", &cloth).unwrap();
        for scale in [0.0, 0.1, 4.0] {
            let positions: Vec<Vec3> = cloth.positions.iter().map(|p| p * scale).collect();
            check(&system, &positions, 0.02);
        }
    }

    #[test]
    fn sewn_sheets_are_solved_and_other_seams_need_another_structure() {
        let cloth = sheets(stiff(1.0));
        let mut system = System::new("sheets", &cloth).unwrap();
        let unsewn = Direct::new(&system, &system.topology.layout, &[]);
        let law = ElasticLaw {
            stiffness: 2e3,
            largest_force: 1.0,
        };
        let seam = |v: u32| Elastic {
            from: v,
            to: ElasticEnd::Vertex(v + 441),
            law,
        };
        let hold = Elastic {
            from: 440,
            to: ElasticEnd::Point(Vec3::zeros()),
            law,
        };
        system = system.with(|builder| {
            builder.elastics = (0..21).map(seam).chain([hold]).collect();
        });
        assert!(!unsewn.fits(&system, &Couplings::default()));
        check(&system, &cloth.positions, 1.0 / 60.0);
    }

    #[test]
    fn pins_are_no_unknowns_and_other_pins_need_another_structure() {
        let cloth = sheets(stiff(1.0));
        let mut system = System::new("sheets", &cloth).unwrap();
        let free = Direct::new(&system, &system.topology.layout, &[]);
        system = system.with(|builder| {
            builder.pinned[..441].fill(true);
        });
        assert!(!free.fits(&system, &Couplings::default()));
        let held = Direct::new(&system, &system.topology.layout, &[[3, 500]]);
        assert!(held.fits(&system, &Couplings::default()));
        assert_eq!(held.factor.graph().vertex_count(), 441);
        assert!(held.factor.operations() < 0.51 * free.factor.operations());
        // Contact with a pinned vertex adds no coupling, contact of free vertices does.
        let mut touching = Couplings::default();
        touching.add(3, 600, Matrix3::identity());
        touching.sort(system.vertex_count());
        assert!(held.fits(&system, &touching));
        touching.add(450, 870, Matrix3::identity());
        touching.sort(system.vertex_count());
        assert!(!held.fits(&system, &touching));
        check(&system, &cloth.positions, 1.0);
    }

    #[test]
    fn a_matrix_that_is_not_positive_is_refused() {
        let mesh = TriangleMesh {
            positions: vec![Vec3::zeros(), Vec3::x(), Vec3::y()],
            triangles: vec![[0, 1, 2]],
        };
        let cloth = Cloth::from_mesh("triangle", &mesh, Material::default()).unwrap();
        let system = System::new("triangle", &cloth).unwrap();
        let blocks = vec![Matrix3::identity() * -1.0; system.topology.pattern.block_count()];
        let hessian = Hessian {
            system: &system,
            bending: &system.rest.bending,
            blocks: &blocks,
            secants: &[],
            touching: &Couplings::default(),
        };
        let mut x = [Vec3::zeros(); 3];
        let mut direct = Direct::new(&system, &system.topology.layout, &[]);
        assert!(!direct.solve(&hessian, &[Vec3::x(); 3], &mut x));
        assert!(!direct.solve_again(&[Vec3::x(); 3], &mut x));
    }
}
