//! Elasticity of a brick in products of Legendre polynomials.
//!
//! In every element, displacements are sums of products of Legendre polynomials along the edges, and so are strains;
//! as the polynomials are orthogonal, the energy is a sum over them, each with its own moduli:
//!
//! `E = ½ V Σ_l n_l [2µ Σ_i ε_ii² + λ_l (Σ_i ε_ii)² + Σ_{i<j} µ_l,ij γ_ij²]`, `n_l = Π 1/(2 l_k + 1)`.
//!
//! - Quadratic bricks project their dilatation on linear polynomials (see [`super::dilatation`]): λ_l = λ up to degree
//!   1, 0 beyond.
//! - Linear bricks have enhanced strains (see [`super::hexahedron`]) that are free to relieve the stresses of
//!   their own polynomials: a normal strain along i where l_i = 1, the shear ij for l = e_i and l = e_j. What is left
//!   are plane and uniaxial stress, and no energy of those shears.

use crate::laws::Thermoelastic;

/// Moduli of one product of Legendre polynomials.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PolynomialModuli {
    /// Degrees along x, y, z.
    pub degrees: [usize; 3],
    /// `n_l`
    pub norm: f64,
    /// λ_l [Pa]
    pub lame: f64,
    /// µ_l of the shears xy, yz, xz [Pa].
    pub shear: [f64; 3],
    /// Normal stress of one kelvin of heating at constant strain [Pa/K].
    pub thermal: f64,
}

/// The two axes of a shear strain xy, yz, xz.
const SHEARS: [[usize; 2]; 3] = [[0, 1], [1, 2], [0, 2]];

/// Moduli of all products of Legendre polynomials of an element, x fastest.
pub fn moduli(order: usize, law: &Thermoelastic) -> Vec<PolynomialModuli> {
    let (lame, shear) = (law.lame_first(), law.shear_modulus());
    let n = order + 1;
    let of = |index: usize| {
        let degrees = [index % n, index / n % n, index / (n * n)];
        let total: usize = degrees.iter().sum();
        let linear = order == 1;
        let lame = match (linear, total) {
            (_, 0) | (false, 1) => lame,
            (true, 1) => 2.0 * lame * shear / (lame + 2.0 * shear),
            (true, 2) => law.young - 2.0 * shear,
            _ => 0.0,
        };
        let relieved = |[i, j]: [usize; 2]| linear && total == 1 && degrees[i] + degrees[j] == 1;
        PolynomialModuli {
            degrees,
            norm: degrees.iter().map(|&l| 1.0 / (2 * l + 1) as f64).product(),
            lame,
            shear: SHEARS.map(|pair| if relieved(pair) { 0.0 } else { shear }),
            // In linear bricks, free enhanced strains along an axis relieve the stress.
            thermal: law.expansion
                * (2.0 * shear + lame * if linear { 3.0 - total as f64 } else { 3.0 }),
        }
    };
    (0..n * n * n).map(of).collect()
}

/// Legendre coefficients of a function from its values at the nodes of an element, by rows.
pub fn legendre(order: usize) -> [[f64; 3]; 3] {
    match order {
        1 => [[0.5, 0.5, 0.0], [-0.5, 0.5, 0.0], [0.0; 3]],
        _ => [
            [1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0],
            [-0.5, 0.0, 0.5],
            [1.0 / 3.0, -2.0 / 3.0, 1.0 / 3.0],
        ],
    }
}

/// Index of a component of a symmetric tensor: xx, yy, zz, xy, yz, xz.
pub fn strain_of(i: usize, j: usize) -> usize {
    if i == j { i } else { [0, 3, 5, 4][i + j] }
}

/// `d/dξ` of `P_{l+1}` has the part `2l + 1` of `P_l`; that along an edge of length h is `2/h` times as large.
pub fn slope_factor(degrees: [usize; 3], axis: usize) -> f64 {
    2.0 * (2 * degrees[axis] + 1) as f64
}
