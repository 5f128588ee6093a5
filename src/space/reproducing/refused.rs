//! Reasons why a mesh's nodes carry no reproducing-kernel functions.

use std::fmt;

/// Why a discretisation is refused; its text names the place and what to change.
#[derive(Debug, Clone, PartialEq)]
pub enum Refused {
    /// Settings out of their range.
    Setting(&'static str),
    /// Too few nodes, or nodes on a line or plane, reach a place.
    FewNeighbours { at: [f64; 3], neighbours: usize, terms: usize, support: f64 },
    /// The neighbours of a particle lie on a line or plane.
    FewParticles { at: [f64; 3], neighbours: usize },
    /// The cell of a node has no volume.
    Cell { at: [f64; 3], volume: f64 },
}

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Setting(text) => f.write_str(text),
            Self::FewNeighbours { at: [x, y, z], neighbours, terms, support } => write!(
                f,
                "the {neighbours} nodes that reach ({x}, {y}, {z}) do not determine a polynomial of {terms} terms; \
                 raise `support` above {support}, lower `basis`, or refine the mesh across its thinnest part"
            ),
            Self::FewParticles { at: [x, y, z], neighbours } => write!(
                f,
                "the {neighbours} particles around ({x}, {y}, {z}) do not determine a gradient; raise `sph.support`, or \
                 refine the mesh across its thinnest part"
            ),
            Self::Cell { at: [x, y, z], volume } => write!(
                f,
                "the cell of the node at ({x}, {y}, {z}) has the volume {volume}; correct the mesh, whose cells overlap"
            ),
        }
    }
}

impl std::error::Error for Refused {}
