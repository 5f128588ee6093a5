//! Heat capacities of the nodes of a body, and conductances between them.

use faer::prelude::Solve;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{MatMut, Side};

use super::super::{Deformable, Failure};
use crate::laws::solid::large_strain::Deformed;
use crate::math::cholesky::LowerTriangle;
use crate::runtime::parallel::Team;

/// Heat capacity per reference volume [J/(m³ K)] and conductivity [W/(m K)] of a layer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeatOfLayer {
    pub capacity: f64,
    pub conductivity: f64,
}

/// Capacities and conductances of a body, whose pattern is known before time starts.
pub struct Conduction {
    /// Heat capacity of each node [J/K].
    pub capacity: Vec<f64>,
    /// Nodes of prescribed temperature.
    pub held: Vec<bool>,
    layers: Vec<HeatOfLayer>,
    /// The lower triangle of the conductances, without values.
    pattern: LowerTriangle,
    symbolic: SymbolicLlt<usize>,
    blocks: Vec<Block>,
}

/// Nodes of a group of points, and the places of their lower triangle in that of the matrix, row by row.
struct Block {
    nodes: Vec<u32>,
    places: Vec<u32>,
}

/// A factored matrix.
pub struct Factored(Llt<usize, f64>);

impl Conduction {
    /// `held` marks nodes of prescribed temperature.
    pub fn new(
        body: &Deformable,
        layers: Vec<HeatOfLayer>,
        held: Vec<bool>,
    ) -> Result<Self, Failure> {
        let capacities: Vec<f64> = layers.iter().map(|layer| layer.capacity).collect();
        let capacity = body.lumped(&capacities);
        let block = |group| Block { nodes: body.nodes_of(group), places: Vec::new() };
        let mut blocks: Vec<Block> = body.space.groups.iter().map(block).collect();
        let pattern = pattern(body.nodes(), &blocks);
        for block in &mut blocks {
            block.places = places(&pattern, &block.nodes);
        }
        let symbolic = SymbolicLlt::try_new(symbolic(&pattern), Side::Lower);
        let symbolic = symbolic.map_err(|_| Failure::Singular)?;
        Ok(Self { capacity, held, layers, pattern, symbolic, blocks })
    }

    /// Values of the lower triangle of the conductances of a body displaced by u [W/K].
    pub fn conductances(&self, body: &Deformable, u: &[[f64; 3]], team: &Team) -> Vec<f64> {
        let of_block = |group: usize| self.block(body, u, group);
        let all = team.map(self.blocks.len(), of_block);
        let mut values = vec![0.0; self.pattern.rows.len()];
        for (block, own) in self.blocks.iter().zip(&all) {
            for (&place, value) in block.places.iter().zip(own) {
                values[place as usize] += value;
            }
        }
        values
    }

    /// Lower triangle of the conductances of a group of points, `V k J (F⁻ᵀ ∇Ψ_I) · (F⁻ᵀ ∇Ψ_J)`.
    fn block(&self, body: &Deformable, u: &[[f64; 3]], group: usize) -> Vec<f64> {
        let volume = &body.space.volume;
        let nodes = &self.blocks[group].nodes;
        let conductivity = self.layers[body.layer_of_group[group]].conductivity;
        let mut values = vec![0.0; self.blocks[group].places.len()];
        for point in body.space.groups[group].clone() {
            let at = Deformed::of(body.gradient(volume, point, u));
            let scale = volume.weights[point] * conductivity * at.dilatation;
            let mut slopes = vec![[0.0; 3]; nodes.len()];
            for value in volume.row(point) {
                let place =
                    nodes.binary_search(&value.node).expect("a block has the nodes of its rows");
                for (sum, row) in slopes[place].iter_mut().zip(&at.inverse_transposed) {
                    *sum += (0..3).map(|b| row[b] * value.gradient[b]).sum::<f64>();
                }
            }
            let mut entry = 0;
            for (row, a) in slopes.iter().enumerate() {
                for b in &slopes[..=row] {
                    values[entry] += scale * (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
                    entry += 1;
                }
            }
        }
        values
    }

    /// Factors conductances with these additions to their diagonal [W/K], in which held nodes keep their values.
    pub fn factor(&self, conductances: &[f64], diagonal: &[f64]) -> Result<Factored, Failure> {
        let mut values = conductances.to_vec();
        self.each(|place, row, column| {
            values[place] = match (self.held[row] || self.held[column], row == column) {
                (true, true) => 1.0,
                (true, false) => 0.0,
                (false, true) => values[place] + diagonal[row],
                (false, false) => values[place],
            };
        });
        let matrix = SparseColMatRef::new(symbolic(&self.pattern), &values[..]);
        let factor = Llt::try_new_with_symbolic(self.symbolic.clone(), matrix, Side::Lower);
        Ok(Factored(factor.map_err(|_| Failure::NotFinite)?))
    }

    /// Conductances times temperatures of all nodes: the heat flow out of each [W].
    pub fn outflow(&self, conductances: &[f64], temperature: &[f64]) -> Vec<f64> {
        let mut flow = vec![0.0; temperature.len()];
        self.each(|place, row, column| {
            // Rows sum to zero: differences leave no rounding of uniform temperatures.
            if row != column {
                let part = conductances[place] * (temperature[column] - temperature[row]);
                flow[row] += part;
                flow[column] -= part;
            }
        });
        flow
    }

    /// Heat flow into free nodes at a temperature of zero from held ones at theirs [W].
    pub fn from_held(&self, conductances: &[f64], held: &[f64]) -> Vec<f64> {
        let mut flow = vec![0.0; held.len()];
        self.each(|place, row, column| match [self.held[row], self.held[column]] {
            [true, false] => flow[column] -= conductances[place] * held[row],
            [false, true] => flow[row] -= conductances[place] * held[column],
            _ => (),
        });
        flow
    }

    /// Calls back for each entry of the lower triangle: its place, row and column.
    fn each(&self, mut take: impl FnMut(usize, usize, usize)) {
        for column in 0..self.capacity.len() {
            for place in self.pattern.column_start[column]..self.pattern.column_start[column + 1] {
                take(place, self.pattern.rows[place], column);
            }
        }
    }
}

impl Factored {
    /// Replaces the right-hand side by the solution.
    pub fn solve(&self, right: &mut [f64]) {
        let rows = right.len();
        self.0.solve_in_place(MatMut::from_column_major_slice_mut(right, rows, 1));
    }
}

fn symbolic(pattern: &LowerTriangle) -> SymbolicSparseColMatRef<'_, usize> {
    let size = pattern.column_start.len() - 1;
    SymbolicSparseColMatRef::new_checked(size, size, &pattern.column_start, None, &pattern.rows)
}

/// The entries of all blocks, diagonals included.
fn pattern(size: usize, blocks: &[Block]) -> LowerTriangle {
    let mut columns: Vec<Vec<usize>> = (0..size).map(|node| vec![node]).collect();
    for Block { nodes, .. } in blocks {
        for (place, &column) in nodes.iter().enumerate() {
            columns[column as usize].extend(nodes[place + 1..].iter().map(|&row| row as usize));
        }
    }
    let mut pattern = LowerTriangle { column_start: vec![0], ..LowerTriangle::default() };
    for column in &mut columns {
        column.sort_unstable();
        column.dedup();
        pattern.rows.extend(column.iter());
        pattern.column_start.push(pattern.rows.len());
    }
    pattern
}

/// Places of the lower triangle of a block in a pattern, row by row.
fn places(pattern: &LowerTriangle, nodes: &[u32]) -> Vec<u32> {
    let place = |row: u32, column: u32| {
        let ends = pattern.column_start[column as usize]..pattern.column_start[column as usize + 1];
        let own = &pattern.rows[ends.clone()];
        (ends.start + own.partition_point(|&other| other < row as usize)) as u32
    };
    let rows = nodes.iter().enumerate();
    rows.flat_map(|(n, &row)| nodes[..=n].iter().map(move |&column| place(row, column))).collect()
}
