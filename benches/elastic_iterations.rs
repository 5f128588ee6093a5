//! Iterations of conjugate gradients for the displacements of boxes, and what one costs: over size, grading, Poisson's
//! ratio, order and thickness. `cargo bench --bench elastic_iterations`.

use std::slice;
use std::time::Instant;

use impinge::laws::Thermoelastic;
use impinge::math::conjugate_gradients::{self, Operator};
use impinge::method::fem::brick_inverse::BrickInverse;
use impinge::method::fem::brick_stiffness::BrickStiffness;
use impinge::method::fem::{Axis, Geometry, Layering, Mesh, Weight};
use impinge::runtime::parallel::Team;

/// What is left of the load, as where units solve for displacements.
const TOLERANCE: f64 = 1e-12;

/// A box that is clamped below.
#[derive(Clone, Copy)]
struct Case {
    order: usize,
    /// Nodes along each axis.
    nodes: [usize; 3],
    poisson: f64,
    /// Largest over smallest length of elements along each axis.
    grading: f64,
    /// Thickness over width.
    thickness: f64,
}

const CASE: Case =
    Case { order: 2, nodes: [41, 41, 41], poisson: 0.3, grading: 8.0, thickness: 1.0 };

struct Bricks<'a> {
    stiffness: BrickStiffness,
    inverse: BrickInverse,
    team: &'a Team,
}

impl Operator for Bricks<'_> {
    fn apply(&self, x: &[f64], out: &mut [f64]) {
        self.stiffness.apply(x, out, self.team);
    }

    fn precondition(&self, residual: &[f64], out: &mut [f64]) {
        self.inverse.apply(residual, out, self.team);
    }
}

impl Case {
    fn mesh(&self) -> Mesh {
        let lengths = [1.0, 1.0, self.thickness];
        let axes = [0, 1, 2].map(|axis| {
            let elements = (self.nodes[axis] - 1) / self.order;
            let growth = self.grading.powf(1.0 / (elements - 1).max(1) as f64);
            let mut ends = vec![0.0];
            (0..elements).for_each(|e| ends.push(ends[e] + growth.powi(e as i32)));
            let scale = lengths[axis] / ends[elements];
            ends.iter_mut().for_each(|end| *end *= scale);
            Axis::from_element_ends(&ends, self.order, Weight::Uniform)
        });
        Mesh { axes, mirrored: [false; 2], geometry: Geometry::Box, layering: Layering::default() }
    }

    /// Prints a row: the case, iterations, time of one [ms].
    fn run(&self, team: &Team) {
        let mesh = self.mesh();
        let law = Thermoelastic { young: 3e11, poisson: self.poisson, expansion: 8e-6 };
        let laws = slice::from_ref(&law);
        let [x, y, z] = mesh.node_counts();
        let free = [(); 3].map(|()| [0..x, 0..y, 1..z]);
        let stiffness = BrickStiffness::new(&mesh, laws, free.clone());
        let bricks =
            Bricks { inverse: BrickInverse::new(&mesh, laws, &free, team), stiffness, team };
        let mut load: Vec<f64> =
            (0..3 * mesh.nodes()).map(|i| (1.7 * (i * i % 1009) as f64).sin()).collect();
        bricks.stiffness.hold(&mut load, team);
        let begin = Instant::now();
        let solved = conjugate_gradients::solve(&bricks, &load, TOLERANCE, team);
        let seconds = begin.elapsed().as_secs_f64();
        let Case { order, nodes: [x, y, z], poisson, grading, thickness } = self;
        let nodes = x * y * z;
        let case = format!("{order:5}{nodes:10}{poisson:8}{grading:9}{thickness:11}");
        match solved {
            Ok((_, count)) => println!("{case}{count:12}{:10.2}", 1e3 * seconds / count as f64),
            Err(error) => println!("{case}  {error}"),
        }
    }
}

fn main() {
    let team = Team::new(std::thread::available_parallelism().map_or(1, Into::into));
    println!("{} threads, tolerance {TOLERANCE:e}", team.threads());
    println!("order     nodes       ν  grading  thickness  iterations  ms each");
    for order in [1, 2] {
        let base = Case { order, ..CASE };
        let sides = [21, 41, 81, 101];
        let sizes = sides.map(|n| Case { nodes: [n; 3], ..base });
        let ratios = [0.0, 0.21, 0.4, 0.45].map(|poisson| Case { poisson, ..base });
        let gradings = [1.0, 50.0, 1e3].map(|grading| Case { grading, ..base });
        let plates = [0.1, 0.01, 1e-3].map(|thickness| Case { thickness, ..base });
        for case in sizes.iter().chain(&ratios).chain(&gradings).chain(&plates) {
            case.run(&team);
        }
    }
}
