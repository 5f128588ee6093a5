//! Rates of strain as fits to the elongation of all pairs of a particle.

use super::tensor::{PLACES, Square, product, solve};

/// Level of a moment, relative to that of a full neighbourhood, at which its direction is half lost
/// to the fit.
const CUT: f64 = 0.03;

/// Fits of a neighbourhood's strain rate in coordinates in which a full neighbourhood is a unit
/// matrix.
///
/// With weights w_j ≥ 0, the products φ = (x², y², z², xy, yz, xz) of `x = x_i − x_j` and the rates
/// of elongation `e_j = u_ij·x`, the form `x·D x = δ·φ` of the strain rate D that minimises
/// `Σ w_j (e_j − δ·φ_j)²` is `δ = M⁻¹ h`, with `h = Σ w_j e_j φ_j` and `M = Σ w_j φ_j ⊗ φ_j`. It is
/// exact for linear velocities, whatever the arrangement, and zero for rigid motion.
///
/// In an isotropic full neighbourhood `M = F = c (δδ + δδ + δδ)` with `c = m/d`, the kernel's second
/// moment over the dimensions, for weights of −∇W·x/x². `R = F^(−1/2)` whitens M. Directions that
/// few neighbours resolve fade: in place of 1/µ for an eigenvalue µ of `R M R` there is
/// `µ/(µ² + ε²)`, which never exceeds it.
pub struct Whitening {
    /// R, zero for products of coordinates that the model lacks.
    root: Square<6>,
    /// Products of coordinates that the model has.
    products: Vec<usize>,
    c: f64,
}

/// Matrices that act on the sums h of a particle, see [`Whitening`].
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// K of the strain rate `y = K h`, in coordinates in which `y·y = 2 D:D + (tr D)²`.
    pub rates: Square<6>,
    /// L of the part `h·L h` of `Σ w e²/c` that the fit explains.
    pub pairs: Square<6>,
}

impl Whitening {
    /// Coordinates of a model with the products that it has, and its `c`.
    pub fn of(products: &[usize], c: f64) -> Self {
        let normals: Vec<usize> = products.iter().copied().filter(|&n| n < 3).collect();
        let count = normals.len() as f64;
        let scale = 1.0 / c.sqrt();
        let diagonal = std::f64::consts::FRAC_1_SQRT_2;
        let common = ((2.0 + count).sqrt().recip() - diagonal) / count;
        let mut root = [[0.0; 6]; 6];
        for &a in &normals {
            normals.iter().for_each(|&b| root[a][b] = scale * common);
            root[a][a] += scale * diagonal;
        }
        products.iter().filter(|&&n| n >= 3).for_each(|&n| root[n][n] = scale);
        Self { root, products: products.to_vec(), c }
    }

    /// The fit of a neighbourhood with these fourth moments.
    pub fn fit(&self, fourth: &[f64; 15]) -> Fit {
        match self.products.len() {
            3 => self.fit_of::<3>(fourth),
            4 => self.fit_of::<4>(fourth),
            _ => self.fit_of::<6>(fourth),
        }
    }

    fn fit_of<const N: usize>(&self, fourth: &[f64; 15]) -> Fit {
        let at: [usize; N] = std::array::from_fn(|n| self.products[n]);
        let root: Square<N> = at.map(|a| at.map(|b| self.root[a][b]));
        let moments = at.map(|a| at.map(|b| fourth[PLACES[a][b]]));
        let whitened = product(&root, &product(&moments, &root));
        let mut squares = product(&whitened, &whitened);
        (0..N).for_each(|n| squares[n][n] += CUT * CUT);
        let inverse = solve(&squares, &whitened);
        let mut rates = product(&inverse, &root);
        rates.as_flattened_mut().iter_mut().for_each(|value| *value /= self.c.sqrt());
        let mut pairs = product(&root, &rates);
        pairs.as_flattened_mut().iter_mut().for_each(|value| *value /= self.c.sqrt());
        let mut fit = Fit { rates: [[0.0; 6]; 6], pairs: [[0.0; 6]; 6] };
        for (i, &a) in at.iter().enumerate() {
            for (j, &b) in at.iter().enumerate() {
                fit.rates[a][b] = rates[i][j];
                fit.pairs[a][b] = pairs[i][j];
            }
        }
        fit
    }
}
