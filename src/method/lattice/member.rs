//! Links of a lattice that moves: beams whose strain is small and whose rotation is not.

use super::link::{Deformation, Link};

/// Place and direction of a particle: displacement [m], and cosine and sine of its rotation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    pub moved: [f64; 2],
    pub axis: [f64; 2],
}

/// A link in the form that loops read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Member {
    pub ends: [u32; 2],
    /// Vector from the first particle to the second at rest, and its length [m].
    span: [f64; 2],
    length: f64,
    /// Axial stiffness EA over the length [N/m] and flexural stiffness 2EI over the length [N m].
    axial: f64,
    flexural: f64,
    /// Stretch from which damage may grow [1]; infinite for links that stay intact.
    pub onset: f64,
}

/// Deformation of a member, with the direction and the inverse length of its chord.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strain {
    pub q: Deformation,
    chord: [f64; 2],
    per_length: f64,
}

/// Force on the second particle [N], opposite on the first, and moments on both [N m].
pub type EndForces = [f64; 4];

/// Rotation up to which the cosine and the sine are sums of powers, exact to rounding [rad].
const SMALL: f64 = 0.25;

impl Pose {
    pub fn new(moved: [f64; 2], angle: f64) -> Self {
        Self { moved, axis: axis(angle) }
    }
}

/// Cosine and sine of a rotation, which is nearly always small.
fn axis(angle: f64) -> [f64; 2] {
    if angle.abs() > SMALL {
        return [angle.cos(), angle.sin()];
    }
    let x = angle * angle;
    let power = |sum: f64, part: f64| 1.0 - x * part * sum;
    let [cosine, sine] = POWERS.map(|parts| parts.into_iter().fold(1.0, power));
    [cosine, angle * sine]
}

/// Terms of the sums of powers over those before, `1/(n (n − 1))` from the last on: of the cosine and of the sine.
const POWERS: [[f64; 6]; 2] = [
    [1.0 / 132.0, 1.0 / 90.0, 1.0 / 56.0, 1.0 / 30.0, 1.0 / 12.0, 1.0 / 2.0],
    [1.0 / 156.0, 1.0 / 110.0, 1.0 / 72.0, 1.0 / 42.0, 1.0 / 20.0, 1.0 / 6.0],
];

impl Member {
    pub fn new(link: &Link) -> Self {
        let Link { length, direction, axial, flexural, .. } = *link;
        Self {
            ends: link.ends.map(|end| end as u32),
            span: direction.map(|part| part * length),
            length,
            axial,
            flexural,
            onset: if link.breaks { link.softening.onset } else { f64::INFINITY },
        }
    }

    /// Deformation between two poses: elongation, and the sines of the rotations of the ends relative to the chord,
    /// which stay as small as strains however far a link turns.
    #[inline(always)]
    pub fn strain(&self, [a, b]: [&Pose; 2]) -> Strain {
        let [x, y] = self.span;
        let [u, w] = [b.moved[0] - a.moved[0], b.moved[1] - a.moved[1]];
        let chord = [x + u, y + w];
        let length = (chord[0] * chord[0] + chord[1] * chord[1]).sqrt();
        let sum = length + self.length;
        // One division for both quotients.
        let quotient = 1.0 / (length * sum);
        let per_length = quotient * sum;
        // Differences of squares do not cancel.
        let elongation = (2.0 * (x * u + y * w) + u * u + w * w) * quotient * length;
        let scale = per_length / self.length;
        let rotation = |[c, s]: [f64; 2]| {
            let turned = [c * x - s * y, s * x + c * y];
            (turned[1] * chord[0] - turned[0] * chord[1]) * scale
        };
        let q = [elongation, rotation(a.axis), rotation(b.axis)];
        Strain { q, chord: chord.map(|part| part * per_length), per_length }
    }

    /// Stretch that damages: as [`Link::stretch`].
    #[inline(always)]
    pub fn stretch(&self, q: &Deformation, bending: f64) -> f64 {
        let curved = (2.0 * q[1] + q[2]).abs().max((q[1] + 2.0 * q[2]).abs());
        q[0] / self.length + 2.0 * bending * curved
    }

    /// Rate at which the ends move apart along the chord, from their velocities [m/s].
    pub fn opening_rate(&self, strain: &Strain, [a, b]: [[f64; 2]; 2]) -> f64 {
        (b[0] - a[0]) * strain.chord[0] + (b[1] - a[1]) * strain.chord[1]
    }

    /// Changes the forces of a closed link by those of a dashpot, of a coefficient [N s/m] and the rate at which its
    /// ends move apart, as far as they still press; returns the force of the dashpot, positive in tension [N].
    pub fn damp(
        &self,
        forces: &mut EndForces,
        strain: &Strain,
        coefficient: f64,
        rate: f64,
    ) -> f64 {
        let force = (coefficient * rate).min(-self.axial * strain.q[0]);
        let [c, s] = strain.chord;
        forces[0] -= force * c;
        forces[1] -= force * s;
        force
    }

    /// Coefficient of a dashpot that damps the contact of two inverse masses [1/kg] by a part of its critical damping.
    pub fn dashpot(&self, part: f64, [a, b]: [f64; 2]) -> f64 {
        2.0 * part * (self.axial / (a + b)).sqrt()
    }

    /// Forces on the particles, of which the given parts of axial and flexural stiffness remain. They are the exact
    /// derivative of the energy up to the fourth power of the rotations.
    #[inline(always)]
    pub fn forces(&self, strain: &Strain, [axial, flexural]: [f64; 2]) -> EndForces {
        let [elongation, a, b] = strain.q;
        let normal = axial * self.axial * elongation;
        let bending = flexural * self.flexural;
        let moments = [
            bending * (2.0 * a + b) * (1.0 - 0.5 * a * a),
            bending * (a + 2.0 * b) * (1.0 - 0.5 * b * b),
        ];
        let shear = (moments[0] + moments[1]) * strain.per_length;
        let [c, s] = strain.chord;
        [-normal * c - shear * s, -normal * s + shear * c, -moments[0], -moments[1]]
    }
}
