//! Modes of conduction along x and y, which decouple into systems along z.

use faer::{Mat, MatRef};

use super::grid::Side;
use crate::math::eigenvectors::eigenvectors;
use crate::math::product::product;

/// Mass-normal modes along both lateral axes, with lumped masses.
pub struct Lateral {
    axes: [Modes; 2],
}

struct Modes {
    /// Modes by columns; zero at held nodes.
    shapes: Mat<f64>,
    decay: Vec<f64>,
}

/// Thermal condition of an end of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum End {
    Held,
    /// `h/k` [1/m]; zero for an insulated end.
    Open(f64),
}

impl Lateral {
    pub fn new(sides: &[Side; 2], ends: [[End; 2]; 2]) -> Self {
        Self { axes: [0, 1].map(|a| Modes::new(&sides[a], ends[a])) }
    }

    /// Number of modes of a level.
    pub fn count(&self) -> usize {
        self.axes.iter().map(|modes| modes.decay.len()).product()
    }

    /// Eigenvalue of every mode of a level [1/m²].
    pub fn decay(&self) -> Vec<f64> {
        let [x, y] = &self.axes;
        y.decay.iter().flat_map(|b| x.decay.iter().map(move |a| a + b)).collect()
    }

    /// `Φᵀ v` of every level.
    pub fn project(&self, nodal: &[f64]) -> Vec<f64> {
        let [x, y] = self.axes.each_ref().map(|modes| modes.shapes.transpose());
        transform(nodal, x, y)
    }

    /// `Φ a` of every level.
    pub fn expand(&self, modal: &[f64]) -> Vec<f64> {
        let [x, y] = self.axes.each_ref().map(|modes| modes.shapes.as_ref());
        transform(modal, x, y)
    }
}

/// `Σ X[a, i] Y[b, j] in[i, j, k]` for every level k; there are modes.
fn transform(values: &[f64], x: MatRef<'_, f64>, y: MatRef<'_, f64>) -> Vec<f64> {
    let (nx, ny, mx, my) = (x.ncols(), y.ncols(), x.nrows(), y.nrows());
    let levels = values.len() / (nx * ny);
    let mut along_x = vec![0.0; mx * ny * levels];
    product(&mut along_x, x, MatRef::from_column_major_slice(values, nx, ny * levels));
    if let (1, 1) = (ny, my) {
        along_x.iter_mut().for_each(|value| *value *= y[(0, 0)]);
        return along_x;
    }
    let mut out = vec![0.0; mx * my * levels];
    for (source, target) in along_x.chunks_exact(mx * ny).zip(out.chunks_exact_mut(mx * my)) {
        product(target, MatRef::from_column_major_slice(source, mx, ny), y.transpose());
    }
    out
}

impl Modes {
    fn new(side: &Side, ends: [End; 2]) -> Self {
        let count = side.mass.len();
        let held =
            |i: usize| (i == 0 && ends[0] == End::Held) || (i + 1 == count && ends[1] == End::Held);
        let free: Vec<usize> = (0..count).filter(|&i| !held(i)).collect();
        let loss = [0, 1].map(|e| match ends[e] {
            End::Open(ratio) => ratio * side.ends[e],
            End::Held => 0.0,
        });
        let mut stiffness = Mat::<f64>::zeros(count, count);
        for (i, link) in side.links.iter().enumerate() {
            for (a, b) in [(i, i + 1), (i + 1, i)] {
                stiffness[(a, a)] += link;
                stiffness[(a, b)] -= link;
            }
        }
        stiffness[(0, 0)] += loss[0];
        stiffness[(count - 1, count - 1)] += loss[1];
        let root = |i: usize| side.mass[free[i]].sqrt();
        let m = free.len();
        let scaled = |i: usize, j: usize| stiffness[(free[i], free[j])] / (root(i) * root(j));
        let vectors = match m {
            0 => Mat::zeros(0, 0),
            _ => eigenvectors(&Mat::from_fn(m, m, scaled)),
        };
        let mut shapes = Mat::zeros(count, m);
        for k in 0..m {
            for i in 0..m {
                shapes[(free[i], k)] = vectors[(i, k)] / root(i);
            }
        }
        // Squares of differences do not cancel as products with a matrix do.
        let quotient = |k: usize| -> f64 {
            let differences = side.links.iter().enumerate();
            let inner: f64 = differences
                .map(|(i, link)| link * (shapes[(i + 1, k)] - shapes[(i, k)]).powi(2))
                .sum();
            inner + loss[0] * shapes[(0, k)].powi(2) + loss[1] * shapes[(count - 1, k)].powi(2)
        };
        let decay = (0..m).map(quotient).collect();
        Self { shapes, decay }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modes_are_mass_normal_and_have_their_eigenvalues() {
        let nodes: Vec<f64> = (0..9).map(|i| 0.1 * 1.3_f64.powi(i)).collect();
        let side = || Side {
            mass: (0..9)
                .map(|i| nodes[(i + 1).min(8)] - nodes[i - usize::from(i > 0)])
                .map(|d| 0.5 * d)
                .collect(),
            links: nodes.windows(2).map(|pair| 1.0 / (pair[1] - pair[0])).collect(),
            ends: [1.0; 2],
        };
        let ends = [[End::Held, End::Open(3.0)], [End::Open(0.0), End::Open(0.0)]];
        let lateral = Lateral::new(&[side(), side()], ends);
        assert_eq!(lateral.count(), 72);
        let areas: Vec<f64> =
            side().mass.iter().flat_map(|a| side().mass.into_iter().map(move |b| a * b)).collect();
        for number in [0, 5, 40] {
            let mut modal = vec![0.0; 72];
            modal[number] = 1.0;
            let nodal = lateral.expand(&modal);
            let weighted: Vec<f64> = nodal.iter().zip(&areas).map(|(v, a)| v * a).collect();
            for (k, overlap) in lateral.project(&weighted).iter().enumerate() {
                let same = if k == number { 1.0 } else { 0.0 };
                assert!((overlap - same).abs() < 1e-12);
            }
        }
        // The insulated axis has a constant mode.
        let decay = lateral.decay();
        assert!(decay.iter().all(|&d| d > 0.0));
        assert!(lateral.axes[1].decay[0].abs() < 1e-12);
    }
}
