//! Links between particles: beams without shear, whose stiffness is that of a plane-stress sheet.

use crate::laws::fracture::Softening;

/// A beam between two particles, for small rotations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Link {
    pub ends: [usize; 2],
    /// Distance of the particles [m].
    pub length: f64,
    /// Unit vector from the first to the second.
    pub direction: [f64; 2],
    /// Axial stiffness EA over the length [N/m].
    pub axial: f64,
    /// Flexural stiffness 2EI over the length [N m].
    pub flexural: f64,
    pub softening: Softening,
    /// False for links that stay intact, near supports and loads.
    pub breaks: bool,
}

/// Elongation [m] and rotations of both ends relative to the chord [rad].
pub type Deformation = [f64; 3];

/// Sheet of an elastic material in plane stress.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sheet {
    /// Young's modulus E [Pa] and Poisson's ratio ν [1], −1 < ν ≤ 1/3.
    pub young: f64,
    pub poisson: f64,
    /// [m]
    pub thickness: f64,
}

/// Constants of sheets of random links: Poisson's ratio and Young's modulus that they have over that with which the
/// stiffness of links is computed, and that Poisson's ratio. Means of eight samples of 50 rows pulled between
/// platens; samples differ by 0.7 % of the modulus and 0.004 of the ratio at most, as they do between the rows of the
/// table.
const RANDOM: [[f64; 3]; 14] = [
    [-1.0, 1.0, -1.0],
    [-0.9269, 0.97964, -0.95],
    [-0.86324, 0.97231, -0.9],
    [-0.74822, 0.96345, -0.8],
    [-0.54701, 0.96026, -0.6],
    [-0.36372, 0.96877, -0.4],
    [-0.18453, 0.98352, -0.2],
    [0.00271, 0.99624, 0.0],
    [0.10516, 0.99498, 0.1],
    [0.1606, 0.9893, 0.15],
    [0.22046, 0.97739, 0.2],
    [0.28717, 0.9547, 0.25],
    [0.36633, 0.91071, 0.3],
    [0.43424, 0.85385, 1.0 / 3.0],
];

impl Sheet {
    /// The sheet whose constants give random links those of this one: their rotations and slides are uneven, which
    /// softens the lattice and raises its contraction.
    pub fn of_random_links(&self) -> Self {
        let above = RANDOM.iter().position(|row| row[0] > self.poisson);
        let above = above.unwrap_or(RANDOM.len() - 1).max(1);
        let [low, high] = [RANDOM[above - 1], RANDOM[above]];
        let part = (self.poisson - low[0]) / (high[0] - low[0]);
        let [_, modulus, poisson] = [0, 1, 2].map(|k| low[k] + part * (high[k] - low[k]));
        Self { young: self.young / modulus, poisson, ..*self }
    }

    /// Axial stiffness EA/s [N/m] and flexural stiffness 2EI/s [N m] of a link of length s across a facet of width h:
    /// `EA = E t h/(1 − ν)` and `EI = E t h s² (1 − 3ν)/(12 (1 − ν²))`. With the facet `h = s/√3` of a hexagon these
    /// are eq. 2.49 of Asadollahi 2014, for which the lattice deforms as the sheet does.
    pub fn stiffness(&self, length: f64, facet: f64) -> [f64; 2] {
        let Self { young, poisson, thickness } = *self;
        let area = young * thickness * facet;
        let axial = area / (1.0 - poisson);
        let inertia =
            area * length * length * (1.0 - 3.0 * poisson) / (12.0 * (1.0 - poisson * poisson));
        [axial / length, 2.0 * inertia / length]
    }
}

impl Link {
    /// Rows of the linear map from the displacements `u, w, θ` of both ends to the deformation.
    pub fn rows(&self) -> [[f64; 6]; 3] {
        let [c, s] = self.direction;
        let [turn_x, turn_y] = [s / self.length, -c / self.length];
        // The chord turns by (−s Δu + c Δw)/length.
        let end = |own: f64, other: f64| [-turn_x, -turn_y, own, turn_x, turn_y, other];
        [[-c, -s, 0.0, c, s, 0.0], end(1.0, 0.0), end(0.0, 1.0)]
    }

    /// Forces of the undamaged link [N, N m], conjugate to a deformation.
    pub fn elastic(&self, q: &Deformation) -> Deformation {
        let moment = |own: f64, other: f64| self.flexural * (2.0 * own + other);
        [self.axial * q[0], moment(q[1], q[2]), moment(q[2], q[1])]
    }

    /// Stretch that damages, `ε = Δd/s + β s ψ` with the larger curvature ψ of the ends, and its gradient. `bending` is
    /// β [1]. Asadollahi 2014, eq. 3.9 and 3.10.
    pub fn stretch(&self, q: &Deformation, bending: f64) -> (f64, Deformation) {
        let curved = [2.0 * q[1] + q[2], q[1] + 2.0 * q[2]];
        let at = usize::from(curved[1].abs() > curved[0].abs());
        let slope = 2.0 * bending * curved[at].signum();
        let gradient = [[2.0, 1.0], [1.0, 2.0]][at].map(|part| part * slope);
        let stretch = q[0] / self.length + 2.0 * bending * curved[at].abs();
        (stretch, [1.0 / self.length, gradient[0], gradient[1]])
    }
}
