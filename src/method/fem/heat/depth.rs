//! Interface of the heat problem to the modes along z.

use std::borrow::Cow;

use faer::Mat;

use super::class::Class;

/// The matrices of a body along z and its modes there: one set for all modes along the surface of a homogeneous body,
/// and one set for each pair of them through layers.
pub trait DepthModes: Send + Sync {
    /// Sets of modes that belong to one symmetry class.
    type Columns: Default + Send + Sync;

    /// Heat capacity ρc [J/(m³ K)] and conductivity k [W/(m K)] if the matrices exclude these, otherwise 1.
    fn capacity(&self) -> f64;
    fn conductivity(&self) -> f64;

    /// `M(ρc)` and `M(k)` between nodes along z.
    fn mass(&self) -> &Mat<f64>;
    fn conductance(&self) -> &Mat<f64>;

    /// `K(k) v` of nodal values along z.
    fn stiffness_times(&self, v: &[f64]) -> Vec<f64>;

    /// Functions along z whose coefficients mixed arrays hold, by columns at the nodes there: those that convert to
    /// modes at the least cost.
    fn basis(&self) -> &Mat<f64>;

    /// Number of modes along z of each pair of modes along the surface.
    fn count(&self) -> usize;

    /// Calls `f(place, λ)` for every mode, with its decay rate λ [1/s].
    fn for_each_mode(&self, class: &Class<Self::Columns>, f: impl FnMut(usize, f64));

    /// Modal amplitudes of products with the functions of the basis.
    fn to_modal(&self, class: &Class<Self::Columns>, mixed: Vec<f64>) -> Vec<f64>;

    /// Coefficients in the basis of modal amplitudes.
    fn to_mixed<'a>(&self, class: &Class<Self::Columns>, modal: &'a [f64]) -> Cow<'a, [f64]>;

    /// Products of a nodal vector along z with the functions of the basis.
    fn project(&self, v: &[f64]) -> Vec<f64> {
        let basis = self.basis();
        let product = |k: usize| (0..v.len()).map(|i| basis[(i, k)] * v[i]).sum();
        (0..basis.ncols()).map(product).collect()
    }

    /// Values of the functions of the basis at the bottom or the top.
    fn at_end(&self, high: bool) -> Vec<f64> {
        let basis = self.basis();
        let node = if high { basis.nrows() - 1 } else { 0 };
        (0..basis.ncols()).map(|k| basis[(node, k)]).collect()
    }
}
