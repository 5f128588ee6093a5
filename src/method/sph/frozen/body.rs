//! Rigid bodies of particles.

use nalgebra::{Matrix3, Rotation3, Vector3};

use super::links::SelfBonds;
use crate::method::sph::method::Method;

/// Fraction of the largest moment of inertia below which particles lie on the axis.
const ON_AXIS: f64 = 1e-9;
/// Change of an angular velocity, relative to it, at which the iteration for the middle of a turn ends, and the most
/// iterations.
const SAME_SPIN: f64 = 1e-15;
const MOST_ITERATIONS: usize = 30;

/// Axes along and about which a body may move, by the symmetry of its model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Freedom {
    slides: [bool; 3],
    turns: [bool; 3],
}

impl Freedom {
    /// Freedom of a set of particles with bonds to its own images: it moves as the symmetric whole. Across a mirror the
    /// whole does not slide, and it turns about the mirror's normal alone; a chain of periods turns about itself.
    pub fn of(method: &Method, bonds: SelfBonds) -> Self {
        let (is_plane, rings) = (method.dimension == 2, method.rings);
        let other = |a: usize| (0..3).filter(move |&b| b != a);
        let is_bound = |b: usize| bonds.mirrored[b] || bonds.chained[b];
        Self {
            slides: [0, 1, 2].map(|a| match a {
                0 => !rings && !bonds.mirrored[0],
                1 => !rings && !is_plane && !bonds.mirrored[1],
                _ => !bonds.mirrored[2],
            }),
            turns: [0, 1, 2].map(|a| !rings && (!is_plane || a == 1) && !other(a).any(is_bound)),
        }
    }
}

/// A rigid body: mass, centre, and the inverse of its inertia about the axes on which it turns.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    slides: [bool; 3],
    mass: f64,
    centre: [f64; 3],
    /// Rounding error of the centre: in long runs it would change momentum.
    rest: [f64; 3],
    mobility: Matrix3<f64>,
}

/// Motion of a rigid body: velocity of its centre, angular velocity, and angular momentum about the centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidMotion {
    velocity: [f64; 3],
    spin: Vector3<f64>,
    angular: Vector3<f64>,
}

/// Rigid displacement of a body over a time.
#[derive(Debug, Clone, PartialEq)]
pub struct Displacement {
    way: [f64; 3],
    turn: Rotation3<f64>,
    /// Velocity of the centre, and angular velocity at the end.
    velocity_after: [f64; 3],
    spin_after: Vector3<f64>,
}

impl Body {
    /// Body of points with these masses and positions.
    pub fn of(freedom: Freedom, points: impl Iterator<Item = (f64, [f64; 3])> + Clone) -> Self {
        let mass = points.clone().map(|(m, _)| m).sum();
        let mean = |from: [f64; 3]| {
            let mut sum = [0.0; 3];
            for (m, x) in points.clone() {
                (0..3).for_each(|a| sum[a] += m * (x[a] - from[a]));
            }
            sum.map(|sum| sum / mass)
        };
        let centre = mean([0.0; 3]);
        let mut body = Self {
            slides: freedom.slides,
            mass,
            centre,
            rest: mean(centre),
            mobility: Matrix3::zeros(),
        };
        let mut inertia = Matrix3::zeros();
        if freedom.turns != [false; 3] {
            for (m, x) in points {
                let arm = body.arm(x);
                inertia += m
                    * (Matrix3::from_diagonal_element(arm.norm_squared()) - arm * arm.transpose());
            }
        }
        body.mobility = mobility(inertia, freedom.turns);
        body
    }

    /// Position relative to the centre.
    pub fn arm(&self, x: [f64; 3]) -> Vector3<f64> {
        Vector3::from([0, 1, 2].map(|a| x[a] - self.centre[a] - self.rest[a]))
    }

    /// The rigid motion with momentum and angular momentum of points with these masses, positions and velocities; of
    /// all rigid motions it is the nearest by kinetic energy.
    pub fn fit(
        &self,
        points: impl Iterator<Item = (f64, [f64; 3], [f64; 3])> + Clone,
    ) -> RigidMotion {
        let first = self.fit_once(points.clone());
        // Rounding errors of the sums of many equal velocities have one sign.
        let rest = self.fit_once(points.map(|(m, x, v)| {
            let velocity = self.velocity(&first, x);
            (m, x, [0, 1, 2].map(|a| v[a] - velocity[a]))
        }));
        RigidMotion {
            velocity: [0, 1, 2].map(|a| first.velocity[a] + rest.velocity[a]),
            spin: first.spin + rest.spin,
            angular: first.angular + rest.angular,
        }
    }

    fn fit_once(&self, points: impl Iterator<Item = (f64, [f64; 3], [f64; 3])>) -> RigidMotion {
        let (mut momentum, mut angular) = ([0.0; 3], Vector3::zeros());
        for (m, x, v) in points {
            (0..3).for_each(|a| momentum[a] += m * v[a]);
            angular += m * self.arm(x).cross(&Vector3::from(v));
        }
        let along = |a: usize| if self.slides[a] { momentum[a] / self.mass } else { 0.0 };
        RigidMotion { velocity: [0, 1, 2].map(along), spin: self.mobility * angular, angular }
    }

    /// Velocity of a point that moves with the body.
    pub fn velocity(&self, motion: &RigidMotion, at: [f64; 3]) -> [f64; 3] {
        let turning = motion.spin.cross(&self.arm(at));
        [0, 1, 2].map(|a| motion.velocity[a] + turning[a])
    }

    /// Free motion of the body over a time, from its motion.
    ///
    /// It turns at the angular velocity `ω = I⁻¹ L` that it has with its angular momentum L in the orientation at the
    /// middle of that time. So it keeps its shape and its angular momentum to rounding, and its radius does not drift.
    /// Its energy oscillates by `(ω dt)²` without drift, because the scheme is symmetric in time; bodies with equal
    /// moments of inertia keep it, too.
    pub fn displacement(&self, motion: &RigidMotion, dt: f64) -> Displacement {
        let spin_after = |turn: &Rotation3<f64>| {
            turn.matrix() * (self.mobility * (turn.matrix().transpose() * motion.angular))
        };
        let mut spin = motion.spin;
        for _ in 0..MOST_ITERATIONS {
            let next = spin_after(&Rotation3::new(0.5 * dt * spin));
            let change = (next - spin).norm();
            spin = next;
            if change <= SAME_SPIN * spin.norm() {
                break;
            }
        }
        let turn = Rotation3::new(dt * spin);
        Displacement {
            way: motion.velocity.map(|v| dt * v),
            spin_after: spin_after(&turn),
            velocity_after: motion.velocity,
            turn,
        }
    }
}

impl Displacement {
    /// Displacement and new velocity of a point of the body, from its position relative to the centre.
    pub fn of(&self, before: Vector3<f64>) -> ([f64; 3], [f64; 3]) {
        let after = self.turn * before;
        let turning = self.spin_after.cross(&after);
        let way = [0, 1, 2].map(|a| self.way[a] + (after[a] - before[a]));
        (way, [0, 1, 2].map(|a| self.velocity_after[a] + turning[a]))
    }
}

/// Inverse of a tensor of inertia about the axes on which a body turns; zero about an axis on which all of its
/// particles lie.
fn mobility(mut inertia: Matrix3<f64>, turns: [bool; 3]) -> Matrix3<f64> {
    for a in (0..3).filter(|&a| !turns[a]) {
        inertia.row_mut(a).fill(0.0);
        inertia.column_mut(a).fill(0.0);
    }
    let largest = inertia.diagonal().max();
    if largest <= 0.0 {
        return Matrix3::zeros();
    }
    let axes = inertia.symmetric_eigen();
    let inverse = |moment: f64| if moment > ON_AXIS * largest { 1.0 / moment } else { 0.0 };
    let turned = Matrix3::from_diagonal(&axes.eigenvalues.map(inverse));
    axes.eigenvectors * turned * axes.eigenvectors.transpose()
}
