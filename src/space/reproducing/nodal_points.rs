//! Points of nodal integration, with functions and gradients that are means over the cells of nodes.

use super::super::{Form, Mesh, Samples, Value};
use super::Refused;
use super::nodal_cells::{Moments, NodalCell};

/// One point for each node at the centre of its cell, with mean values and mean gradients.
///
/// Means of axisymmetric gradients are over the ring's volume. Values are means over the area, at its centre: divided
/// by the radius there, they are the mean circumferential strain ∫ Ψ/r dV / V, because 2πr dA is the ring's volume.
pub(super) fn smoothed(mesh: &Mesh, cells: Vec<NodalCell>) -> Result<Samples, Refused> {
    let mut samples = Samples::default();
    for (node, cell) in mesh.nodes.iter().zip(&cells) {
        check(*node, cell)?;
        let (size, first) = match mesh.form {
            Form::Axisymmetric => (cell.ring, cell.ring_first),
            Form::Plane | Form::Solid => (cell.volume, cell.first),
        };
        let at = [0, 1, 2].map(|a| node[a] + first[a] / size);
        let value = |moments: &Moments| Value {
            node: moments.node,
            value: match mesh.form {
                Form::Axisymmetric => moments.hoop / size,
                Form::Plane | Form::Solid => moments.value / size,
            },
            gradient: moments.gradient.map(|x| x / cell.volume),
        };
        samples.push(at, cell.volume, cell.row.iter().map(value));
    }
    Ok(samples)
}

/// Two points for each node and coordinate, whose first and second moments are those of the cell, with gradients of the
/// linear function over the cell that is closest to the gradient. They integrate the products of two such functions
/// exactly, so the energy has the mean strain and its change over the cell, without a factor to choose.
///
/// Values of axisymmetric functions are the radius times the linear function closest to Ψ/r, from which strains follow.
/// Their sum over the nodes is 1 in the mean over the cell, not at each of its points.
///
/// Sources: Duan, Wang, Gao & Li (2014), Comput. Mech. 54, 353–368, doi 10.1007/s00466-014-0989-1, for linear
/// gradients on nodal cells that obey the divergence theorem; Hillman & Chen (2016), Int. J. Numer. Methods Eng. 107,
/// 603–630, doi 10.1002/nme.5183, for stabilisation by second moments.
pub(super) fn stabilised(mesh: &Mesh, cells: Vec<NodalCell>) -> Result<Samples, Refused> {
    let axes = mesh.form.axes();
    let mut samples = Samples::default();
    for (node, mut cell) in mesh.nodes.iter().zip(cells) {
        check(*node, &cell)?;
        let centre = cell.centred(*node);
        let factor =
            triangle(axes, &cell.second).ok_or(Refused::Cell { at: *node, volume: cell.volume })?;
        // A point lies at `reach` times a column of the factor.
        let reach = (axes.len() as f64 / cell.volume).sqrt();
        for &j in axes {
            for sign in [-1.0, 1.0] {
                let step = [0, 1, 2].map(|k| sign * reach * factor[k][j]);
                let at = [0, 1, 2].map(|a| centre[a] + step[a]);
                let change = |first: [f64; 3]| sign * reach * solved(axes, &factor, first)[j];
                let value = |moments: &Moments| {
                    let first = |l: usize| [0, 1, 2].map(|k| moments.gradient_first[k][l]);
                    let mean = moments.gradient.map(|x| x / cell.volume);
                    let gradient = [0, 1, 2].map(|l| mean[l] + change(first(l)));
                    let value = match mesh.form {
                        Form::Axisymmetric => {
                            at[0] * (moments.hoop / cell.volume + change(moments.hoop_first))
                        }
                        Form::Plane | Form::Solid => {
                            let slope = (0..3).map(|k| step[k] * mean[k]).sum::<f64>();
                            moments.value / cell.volume + slope
                        }
                    };
                    Value { node: moments.node, value, gradient }
                };
                let weight = cell.volume / (2 * axes.len()) as f64;
                samples.push(at, weight, cell.row.iter().map(value));
            }
        }
    }
    Ok(samples)
}

fn check(at: [f64; 3], cell: &NodalCell) -> Result<(), Refused> {
    let volume = cell.volume;
    if volume > 0.0 { Ok(()) } else { Err(Refused::Cell { at, volume }) }
}

/// L of M = L Lᵀ in the coordinates `axes`; `None` unless M is positive definite.
fn triangle(axes: &[usize], m: &[[f64; 3]; 3]) -> Option<[[f64; 3]; 3]> {
    let mut factor = [[0.0; 3]; 3];
    for &i in axes {
        for &j in axes.iter().filter(|&&j| j <= i) {
            let left = m[i][j] - (0..j).map(|k| factor[i][k] * factor[j][k]).sum::<f64>();
            factor[i][j] = if i == j { left.sqrt() } else { left / factor[j][j] };
        }
        // False for the root of a negative number, too.
        let is_positive = factor[i][i] > 0.0;
        if !is_positive {
            return None;
        }
    }
    Some(factor)
}

/// L⁻¹ `right`.
fn solved(axes: &[usize], factor: &[[f64; 3]; 3], mut right: [f64; 3]) -> [f64; 3] {
    for &i in axes {
        let before: f64 = (0..i).map(|k| factor[i][k] * right[k]).sum();
        right[i] = (right[i] - before) / factor[i][i];
    }
    right
}
