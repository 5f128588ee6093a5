//! Dilatation of quadratic bricks, projected so that they do not lock when nearly incompressible.
//!
//! The elastic part of the volume strain, `tr ε − 3 α ΔT`, is replaced by its least-squares
//! projection on linear polynomials in each element: the pair Q2/P₋₁ of displacement and pressure,
//! which is stable (M. Fortin and A. Fortin 1985, doi 10.1002/cnm.1630010603).

use crate::math::gauss::gauss_legendre;
use crate::math::lagrange::{shape, slope};

/// The linear polynomials `1, ξ, η, ζ`, orthogonal on a brick.
pub const POLYNOMIALS: usize = 4;

/// Integrals of one brick element against the linear polynomials.
pub struct DilatationProjection {
    /// For each node and direction: `∫ ψ_m ∂_i N_a dV`.
    pub gradient: Vec<[[f64; POLYNOMIALS]; 3]>,
    /// For each node: `∫ ψ_m N_a dV`.
    pub value: Vec<[f64; POLYNOMIALS]>,
    /// `∫ ψ_m² dV`.
    pub norm: [f64; POLYNOMIALS],
}

/// Integrals along an edge: of each shape function and its derivative, times 1 and times ξ.
struct EdgeMoments {
    value: [[f64; 3]; 2],
    slope: [[f64; 3]; 2],
}

impl EdgeMoments {
    fn new(order: usize, length: f64) -> Self {
        let mut moments = Self { value: [[0.0; 3]; 2], slope: [[0.0; 3]; 2] };
        for (xi, w) in gauss_legendre(order + 1) {
            let (n, d) = (shape(order, xi), slope(order, xi));
            for (power, factor) in [1.0, xi].into_iter().enumerate() {
                for a in 0..=order {
                    moments.value[power][a] += w * factor * n[a] * length / 2.0;
                    moments.slope[power][a] += w * factor * d[a];
                }
            }
        }
        moments
    }
}

impl DilatationProjection {
    pub fn new(order: usize, size: [f64; 3]) -> Self {
        let edges = size.map(|length| EdgeMoments::new(order, length));
        let n = order + 1;
        let volume: f64 = size.iter().product();
        // Polynomial m is ξ along axis m − 1 and constant along the others.
        let power = |m: usize, axis: usize| usize::from(m == axis + 1);
        let (mut gradient, mut value) = (Vec::new(), Vec::new());
        for node in 0..n * n * n {
            let at = [node % n, node / n % n, node / (n * n)];
            let along = |m: usize, i: Option<usize>| {
                (0..3)
                    .map(|k| {
                        let edge = &edges[k];
                        let table = if i == Some(k) { &edge.slope } else { &edge.value };
                        table[power(m, k)][at[k]]
                    })
                    .product::<f64>()
            };
            gradient.push([0, 1, 2].map(|i| [0, 1, 2, 3].map(|m| along(m, Some(i)))));
            value.push([0, 1, 2, 3].map(|m| along(m, None)));
        }
        Self { gradient, value, norm: [volume, volume / 3.0, volume / 3.0, volume / 3.0] }
    }

    /// Coefficients of the projection of `tr ε − 3 α ΔT`, from nodal displacements [m] and thermal
    /// volume strains `3 α ΔT`.
    pub fn coefficients(&self, nodes: impl Iterator<Item = ([f64; 3], f64)>) -> [f64; POLYNOMIALS] {
        let mut sum = [0.0; POLYNOMIALS];
        for ((gradient, value), (u, thermal)) in self.gradient.iter().zip(&self.value).zip(nodes) {
            for m in 0..POLYNOMIALS {
                let stretch: f64 = (0..3).map(|i| gradient[i][m] * u[i]).sum();
                sum[m] += (stretch - value[m] * thermal) / self.norm[m];
            }
        }
        sum
    }
}

/// Value of a projection at a local place.
pub fn evaluate(coefficients: &[f64; POLYNOMIALS], [xi, eta, zeta]: [f64; 3]) -> f64 {
    let [c, x, y, z] = coefficients;
    c + x * xi + y * eta + z * zeta
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linear_dilatation_is_projected_exactly() {
        // u_x = x²/2 + x y, u_y = u_z = 0 has the dilatation x + y.
        let size = [0.5, 0.3, 0.2];
        let projection = DilatationProjection::new(2, size);
        let nodes = (0..27).map(|a| {
            let [x, y] = [a % 3, a / 3 % 3].map(|i| i as f64 / 2.0);
            let (x, y) = (x * size[0], y * size[1]);
            ([0.5 * x * x + x * y, 0.0, 0.0], 0.0)
        });
        let coefficients = projection.coefficients(nodes);
        for place in [[0.3, -0.8, 0.1], [-1.0, 1.0, 0.5]] {
            let (x, y) = (size[0] * (1.0 + place[0]) / 2.0, size[1] * (1.0 + place[1]) / 2.0);
            assert!((evaluate(&coefficients, place) - (x + y)).abs() < 1e-14);
        }
    }
}
