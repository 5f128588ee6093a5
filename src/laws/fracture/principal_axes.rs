//! Principal axes of strain, in a section whose normal is one of them and in space.

use crate::math::matrix3::{Matrix3, eigen, full};

/// Difference of two principal strains, relative to all, below which their axes may be any.
const EVEN: f64 = 1e-9;

/// Principal axes of a strain with engineering shear. Isotropic stress has the same.
pub trait PrincipalAxes<const V: usize>: Sized {
    /// Axes of a strain, and its principal values.
    fn of(strain: [f64; V]) -> (Self, [f64; 3]);

    /// Components of a stress with these axes [Pa].
    fn stress(&self, principal: [f64; 3]) -> [f64; V];

    /// Derivatives of the components of stress by those of strain [Pa], from the principal stresses and their derivatives
    /// by the principal strains.
    fn tangent(&self, stress: [f64; 3], slopes: &Matrix3) -> [[f64; V]; V];
}

/// Mohr's circle of the strain in a section: along its two axes, along its normal, and the shear between its axes.
pub struct InPlane {
    mean: f64,
    radius: f64,
    third: f64,
    /// Cosine and sine of twice the angle of the first principal axis.
    double_angle: [f64; 2],
}

impl PrincipalAxes<4> for InPlane {
    fn of([along, across, third, shear]: [f64; 4]) -> (Self, [f64; 3]) {
        let (mean, half) = (0.5 * (along + across), 0.5 * (along - across));
        let radius = (half * half + 0.25 * shear * shear).sqrt();
        let double_angle = match radius > 0.0 {
            true => [half / radius, 0.5 * shear / radius],
            false => [1.0, 0.0],
        };
        (Self { mean, radius, third, double_angle }, [mean + radius, mean - radius, third])
    }

    fn stress(&self, p: [f64; 3]) -> [f64; 4] {
        let [cosine, sine] = self.double_angle;
        let (centre, spread) = (0.5 * (p[0] + p[1]), 0.5 * (p[0] - p[1]));
        [centre + spread * cosine, centre - spread * cosine, p[2], spread * sine]
    }

    fn tangent(&self, p: [f64; 3], slopes: &Matrix3) -> [[f64; 4]; 4] {
        let Self { mean, radius, third, double_angle: [cosine, sine] } = *self;
        let turning = match radius > EVEN * (mean.abs() + third.abs()) && radius > 0.0 {
            true => (p[0] - p[1]) / (4.0 * radius),
            false => 0.25 * (slopes[0][0] + slopes[1][1]) - 0.5 * slopes[0][1],
        };
        let (high, low) = (0.5 * (1.0 + cosine), 0.5 * (1.0 - cosine));
        let axes: [[f64; 4]; 3] =
            [[high, low, 0.0, 0.5 * sine], [low, high, 0.0, -0.5 * sine], [0.0, 0.0, 1.0, 0.0]];
        let turn = [-sine, sine, 0.0, cosine];
        std::array::from_fn(|a| {
            let rows: [f64; 3] =
                std::array::from_fn(|j| (0..3).map(|i| axes[i][a] * slopes[i][j]).sum());
            std::array::from_fn(|b| {
                let normal: f64 = (0..3).map(|j| rows[j] * axes[j][b]).sum();
                normal + turning * turn[a] * turn[b]
            })
        })
    }
}

/// Principal axes in space, of a strain xx, yy, zz, xy, yz, xz.
pub struct InSpace {
    values: [f64; 3],
    /// Axes as columns.
    axes: Matrix3,
}

/// Pairs of different axes: those of the shears xy, yz and xz.
const PAIRS: [[usize; 2]; 3] = [[0, 1], [1, 2], [0, 2]];

impl InSpace {
    /// Components of the symmetric product of two axes, doubled unless they are one.
    fn product(&self, i: usize, j: usize) -> [f64; 6] {
        let both = |a: usize, b: usize| {
            self.axes[a][i] * self.axes[b][j] + self.axes[b][i] * self.axes[a][j]
        };
        let part = if i == j { 0.5 } else { 1.0 };
        std::array::from_fn(|k| match k {
            0..3 => part * both(k, k),
            _ => part * both(PAIRS[k - 3][0], PAIRS[k - 3][1]),
        })
    }
}

impl PrincipalAxes<6> for InSpace {
    fn of([xx, yy, zz, xy, yz, xz]: [f64; 6]) -> (Self, [f64; 3]) {
        let (values, axes) = eigen(&full([xx, yy, zz, 0.5 * xy, 0.5 * yz, 0.5 * xz]));
        (Self { values, axes }, values)
    }

    fn stress(&self, principal: [f64; 3]) -> [f64; 6] {
        let own = [0, 1, 2].map(|i| self.product(i, i));
        std::array::from_fn(|k| (0..3).map(|i| principal[i] * own[i][k]).sum())
    }

    fn tangent(&self, stress: [f64; 3], slopes: &Matrix3) -> [[f64; 6]; 6] {
        let own = [0, 1, 2].map(|i| self.product(i, i));
        let size = self.values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let turns = PAIRS.map(|[i, j]| {
            let apart = self.values[i] - self.values[j];
            let turning = match apart.abs() > EVEN * size {
                true => (stress[i] - stress[j]) / (2.0 * apart),
                false => 0.25 * (slopes[i][i] + slopes[j][j]) - 0.5 * slopes[i][j],
            };
            (turning, self.product(i, j))
        });
        std::array::from_fn(|a| {
            let rows: [f64; 3] =
                std::array::from_fn(|j| (0..3).map(|i| own[i][a] * slopes[i][j]).sum());
            std::array::from_fn(|b| {
                let normal: f64 = (0..3).map(|j| rows[j] * own[j][b]).sum();
                normal + turns.iter().map(|(part, turn)| part * turn[a] * turn[b]).sum::<f64>()
            })
        })
    }
}
