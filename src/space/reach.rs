//! Numbers of functions that reach a place, counted before they are made.

use super::Mesh;
use super::reproducing::{Shape, spacings};

/// Nodes at which functions are counted.
const SAMPLE: usize = 200;

/// Supports of the functions of nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Supports {
    /// Balls of a radius in spacings of nodes.
    Balls(f64),
    /// Boxes of half widths in spacings of nodes, about places that reach some spacings to each side.
    Boxes { support: f64, around: f64 },
}

impl Supports {
    /// Mean number of the functions that reach a node of a mesh, from a sample of its nodes.
    pub fn functions_at_nodes(self, mesh: &Mesh) -> f64 {
        let spacings = spacings(mesh, Shape::Box);
        let reaches = |node: usize, place: usize| {
            let apart = [0, 1, 2].map(|a| (mesh.nodes[node][a] - mesh.nodes[place][a]).abs());
            match self {
                Self::Balls(support) => {
                    let widest = spacings[node].into_iter().fold(0.0, f64::max);
                    apart.iter().map(|x| x * x).sum::<f64>() < (support * widest).powi(2)
                }
                Self::Boxes { support, around } => (0..3).all(|a| {
                    let reach = support * spacings[node][a] + around * spacings[place][a];
                    reach == 0.0 || apart[a] < reach
                }),
            }
        };
        let nodes = mesh.nodes.len();
        let stride = nodes.div_ceil(SAMPLE).max(1);
        let sample = (0..nodes).step_by(stride);
        let taken = sample.len() as f64;
        let count: usize =
            sample.map(|place| (0..nodes).filter(|&node| reaches(node, place)).count()).sum();
        count as f64 / taken
    }
}

#[cfg(test)]
mod tests {
    use super::super::Form;
    use super::*;

    #[test]
    fn nodes_of_a_lattice_have_the_functions_of_their_neighbours() {
        let mesh = Mesh::of_box(Form::Solid, [0.0; 3], [24.0, 24.0, 24.0], [24, 24, 24]);
        let inside = |count: f64, wanted: f64| (0.8 * wanted..wanted).contains(&count);
        assert!(inside(Supports::Balls(2.2).functions_at_nodes(&mesh), 33.0));
        let boxes = Supports::Boxes { support: 1.75, around: 0.5 };
        assert!(inside(boxes.functions_at_nodes(&mesh), 125.0));
    }
}
