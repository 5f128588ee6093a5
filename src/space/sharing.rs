//! Dilatations that the points of a group share.

use std::ops::Range;

use super::{Form, Samples};

/// How the dilatation that the points of a group share follows from those of each: by projection on functions of place.
#[derive(Debug, Clone, PartialEq)]
pub enum Sharing {
    /// On a constant.
    Mean,
    /// On linear functions, of which those at each point are orthonormal over its group; unused ones are zero.
    Linear(Vec<[f64; 4]>),
}

/// Values that the points of a group share.
#[derive(Debug, Clone, PartialEq)]
pub enum Shared {
    /// One of all points.
    One(f64),
    /// One of each point.
    Each(Vec<f64>),
}

impl Shared {
    /// The value at a point, by its place in the group.
    pub fn at(&self, place: usize) -> f64 {
        match self {
            Self::One(value) => *value,
            Self::Each(values) => values[place],
        }
    }

    /// Values of a function of these.
    pub fn map(&self, of: impl Fn(f64) -> f64) -> Self {
        match self {
            Self::One(value) => Self::One(of(*value)),
            Self::Each(values) => Self::Each(values.iter().map(|value| of(*value)).collect()),
        }
    }
}

impl Sharing {
    /// Linear functions over groups of points, made orthonormal one after the other (Gram and Schmidt).
    pub(super) fn linear(volume: &Samples, groups: &[Range<usize>], form: Form) -> Self {
        let mut functions = vec![[0.0; 4]; volume.len()];
        for group in groups {
            let weights = &volume.weights[group.clone()];
            let own = &mut functions[group.clone()];
            own.iter_mut().for_each(|values| values[0] = 1.0);
            for (n, &axis) in form.axes().iter().enumerate() {
                let places = &volume.at[group.clone()];
                own.iter_mut().zip(places).for_each(|(values, at)| values[n + 1] = at[axis]);
            }
            // Twice, as coordinates may be far from zero.
            for _ in 0..2 {
                for n in 0..=form.axes().len() {
                    for k in 0..n {
                        let part = product(weights, own, [n, k]);
                        own.iter_mut().for_each(|values| values[n] -= part * values[k]);
                    }
                    let size = product(weights, own, [n, n]).sqrt();
                    own.iter_mut().for_each(|values| values[n] /= size);
                }
            }
        }
        Self::Linear(functions)
    }

    /// Projects values of the points of a group, by their places in it, with some weights.
    pub fn project(
        &self,
        group: &Range<usize>,
        weights: &[f64],
        value: impl Fn(usize) -> f64,
    ) -> Shared {
        let parts = || weights.iter().enumerate().map(|(place, w)| w * value(place));
        let functions = match self {
            Self::Mean => return Shared::One(parts().sum::<f64>() / weights.iter().sum::<f64>()),
            Self::Linear(functions) => &functions[group.clone()],
        };
        let mut factors = [0.0; 4];
        for (part, own) in parts().zip(functions) {
            factors.iter_mut().zip(own).for_each(|(factor, value)| *factor += part * value);
        }
        let of_point =
            |own: &[f64; 4]| own.iter().zip(&factors).map(|(value, factor)| value * factor).sum();
        Shared::Each(functions.iter().map(of_point).collect())
    }
}

/// Integral of the product of two functions over a group.
fn product(weights: &[f64], functions: &[[f64; 4]], [a, b]: [usize; 2]) -> f64 {
    weights.iter().zip(functions).map(|(w, own)| w * own[a] * own[b]).sum()
}

#[cfg(test)]
mod tests {
    use super::super::{Mesh, finite_elements};
    use super::*;

    /// Linear values stay as they are, and others keep their integral.
    #[test]
    fn linear_values_are_shared_as_they_are() {
        for (form, far) in [(Form::Plane, 0.0), (Form::Axisymmetric, 0.0), (Form::Solid, 1e4)] {
            let high = [1.5 + far, 1.0, 2.0];
            let mesh = Mesh::of_box_by((form, 2), [0.5 + far, 0.0, 0.0], high, [1, 1, 1]);
            let space = finite_elements(&mesh.mapped(|[x, y, z]| [x + 0.1 * (z * z), y, z]));
            let volume = &space.volume;
            let group = &space.groups[0];
            let linear = |at: &[f64; 3]| 2.0 + 3.0 * (at[0] - far) - 0.5 * at[2];
            let values: Vec<f64> = volume.at.iter().map(linear).collect();
            let Shared::Each(shared) = space.sharing.project(group, &volume.weights, |n| values[n])
            else {
                panic!("linear functions")
            };
            for (shared, value) in shared.iter().zip(&values) {
                assert!((shared - value).abs() < 1e-11 * (1.0 + far), "{form:?} {shared} {value}");
            }
            let bent: Vec<f64> = volume.at.iter().map(|at| (at[0] - far).powi(2)).collect();
            let Shared::Each(shared) = space.sharing.project(group, &volume.weights, |n| bent[n])
            else {
                panic!("linear functions")
            };
            let whole = |values: &[f64]| -> f64 {
                volume.weights.iter().zip(values).map(|(w, value)| w * value).sum()
            };
            assert!((whole(&shared) / whole(&bent) - 1.0).abs() < 1e-11, "{form:?}");
            assert!(shared.iter().zip(&bent).any(|(a, b)| (a - b).abs() > 1e-3), "{form:?}");
        }
    }
}
