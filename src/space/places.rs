//! Rows at any place of a body: values of its functions, and means of its points that reproduce linear fields.

use super::factor::Factor;
use super::finite_elements::shape;
use super::{Form, Mesh, Samples, Value};
use crate::math::matrix3::inverse;

/// Iterations of Newton's method for a place within a cell.
const ITERATIONS: usize = 30;
/// Change of a coordinate of a cell at which they end.
const CONVERGED: f64 = 1e-13;
/// Rounding of a place over the extent of a cell.
const SLACK: f64 = 1e-9;

/// Returns the functions of a mesh at a place, those of the nearest cell for a place outside; values only.
pub fn row_of_mesh(mesh: &Mesh, at: [f64; 3]) -> Vec<Value> {
    let excess = |local: [f64; 3]| {
        let beyond = |&a: &usize| (local[a] - 1.0).max(-local[a]).max(0.0);
        mesh.form.axes().iter().map(beyond).fold(0.0, f64::max)
    };
    let nearest = |cells: &mut dyn Iterator<Item = &'_ Vec<u32>>| {
        let places = cells.filter_map(|cell| Some((cell.clone(), local(mesh, cell, at)?)));
        places.min_by(|a, b| excess(a.1).total_cmp(&excess(b.1)))
    };
    // A cell that contains the place is found among those whose bounds do.
    let inside = nearest(&mut mesh.cells.iter().filter(|cell| bounds(mesh, cell, at)));
    let inside = inside.filter(|(_, local)| excess(*local) == 0.0);
    let nearest = inside.or_else(|| nearest(&mut mesh.cells.iter()));
    let Some((cell, local)) = nearest else { return Vec::new() };
    let value = |(place, &node): (usize, &u32)| {
        let (value, _) = shape((mesh.form, mesh.order), place, local);
        Value { node, value, gradient: [0.0; 3] }
    };
    cell.iter().enumerate().map(value).collect()
}

/// Returns true if a place lies in a cell of a mesh, to rounding.
pub fn contains(mesh: &Mesh, at: [f64; 3]) -> bool {
    let inside = |cell: &Vec<u32>| {
        bounds(mesh, cell, at)
            && local(mesh, cell, at).is_some_and(|local| {
                let within = |&a: &usize| (-WITHIN..=1.0 + WITHIN).contains(&local[a]);
                mesh.form.axes().iter().all(within)
            })
    };
    mesh.cells.iter().any(inside)
}

/// Rounding of a coordinate of a cell.
const WITHIN: f64 = 1e-6;

/// Returns true if a place lies between the extreme coordinates of a cell's nodes.
fn bounds(mesh: &Mesh, cell: &[u32], at: [f64; 3]) -> bool {
    mesh.form.axes().iter().all(|&a| {
        let nodes = || cell.iter().map(|&node| mesh.nodes[node as usize][a]);
        let low = nodes().fold(f64::INFINITY, f64::min);
        let high = nodes().fold(f64::NEG_INFINITY, f64::max);
        let slack = SLACK * (high - low);
        (low - slack..=high + slack).contains(&at[a])
    })
}

/// Coordinates of a place in the map of a cell, by Newton's method; `None` where that finds none.
fn local(mesh: &Mesh, cell: &[u32], at: [f64; 3]) -> Option<[f64; 3]> {
    let mut local = [0.5; 3];
    for _ in 0..ITERATIONS {
        let mut rest = at;
        let mut jacobian = [[0.0; 3]; 3];
        for (place, &node) in cell.iter().enumerate() {
            let (value, slope) = shape((mesh.form, mesh.order), place, local);
            let x = mesh.nodes[node as usize];
            for a in 0..3 {
                rest[a] -= value * x[a];
                (0..3).for_each(|b| jacobian[a][b] += x[a] * slope[b]);
            }
        }
        if mesh.form != Form::Solid {
            jacobian[1][1] = 1.0;
            rest[1] = 0.0;
        }
        let (inverse, determinant) = inverse(&jacobian);
        if determinant == 0.0 {
            return None;
        }
        let step = inverse.map(|row| row[0] * rest[0] + row[1] * rest[1] + row[2] * rest[2]);
        (0..3).for_each(|a| local[a] += step[a]);
        if step.iter().all(|step| step.abs() < CONVERGED) {
            return Some(local);
        }
    }
    None
}

/// Points within a distance of a place count, which grows by this factor while they determine no linear field.
const GROWTH: f64 = 1.25;

/// Returns points with weights whose mean at a place is that of the linear field that fits their values best; points
/// near the place weigh most. Only points that `accept` returns true for count; the search begins within a distance
/// [m].
pub fn fit(
    samples: &Samples,
    form: Form,
    at: [f64; 3],
    distance: f64,
    accept: impl Fn(usize) -> bool,
) -> Vec<(u32, f64)> {
    let accepted: Vec<usize> = (0..samples.len()).filter(|&point| accept(point)).collect();
    let axes = form.axes();
    let from = |point: usize| {
        let mut offset = [0.0; 3];
        axes.iter().enumerate().for_each(|(n, &a)| offset[n] = samples.at[point][a] - at[a]);
        offset
    };
    let length = |offset: [f64; 3]| offset.iter().map(|x| x * x).sum::<f64>().sqrt();
    let farthest = accepted.iter().map(|&point| length(from(point))).fold(0.0, f64::max);
    let mut reach = distance;
    loop {
        let near: Vec<(usize, [f64; 3], f64)> = accepted
            .iter()
            .map(|&point| (point, from(point).map(|x| x / reach)))
            .filter(|(_, offset)| length(*offset) < 1.0)
            .map(|(point, offset)| {
                let q = length(offset);
                (point, offset, samples.weights[point] * (1.0 - q * q).powi(2))
            })
            .collect();
        let weights = match axes.len() {
            2 => of_linear::<3>(&near),
            _ => of_linear::<4>(&near),
        };
        if let Some(weights) = weights {
            return weights;
        }
        if reach > 2.0 * farthest {
            let whole: f64 = accepted.iter().map(|&point| samples.weights[point]).sum();
            let share = |&point: &usize| (point as u32, samples.weights[point] / whole);
            return accepted.iter().map(share).collect();
        }
        reach *= GROWTH;
    }
}

/// Weights of the fit of a constant and N − 1 slopes; `None` if the points do not determine them.
fn of_linear<const N: usize>(near: &[(usize, [f64; 3], f64)]) -> Option<Vec<(u32, f64)>> {
    if near.len() < 2 * N {
        return None;
    }
    let basis =
        |offset: &[f64; 3]| std::array::from_fn(|n| if n == 0 { 1.0 } else { offset[n - 1] });
    let mut moments = [[0.0; N]; N];
    for (_, offset, weight) in near {
        let h: [f64; N] = basis(offset);
        for a in 0..N {
            (0..N).for_each(|b| moments[a][b] += weight * h[a] * h[b]);
        }
    }
    let at_place: [f64; N] = std::array::from_fn(|n| if n == 0 { 1.0 } else { 0.0 });
    let factors = Factor::of(&moments)?.solve(at_place);
    let of_point = |(point, offset, weight): &(usize, [f64; 3], f64)| {
        let h: [f64; N] = basis(offset);
        let along: f64 = h.iter().zip(&factors).map(|(h, f)| h * f).sum();
        (*point as u32, weight * along)
    };
    Some(near.iter().map(of_point).collect())
}

#[cfg(test)]
mod tests {
    use super::super::finite_elements;
    use super::*;

    #[test]
    fn linear_fields_are_exact_at_any_place() {
        let meshes = [
            Mesh::of_ball(Form::Plane, 1.0, 2, 2, [false; 2]),
            Mesh::of_ball_by((Form::Plane, 2), 1.0, [1, 1], [false; 2]),
            Mesh::of_cylinder(1, [1.0, 0.5], [2, 1, 2], [false; 2]),
            Mesh::of_cylinder(2, [1.0, 0.5], [1, 1, 1], [false; 2]),
            Mesh::of_box(Form::Solid, [-1.0, -1.0, -1.0], [1.0, 1.0, 0.0], [3, 2, 2]),
        ];
        for mesh in meshes {
            let flat = mesh.form != Form::Solid;
            let field = |[x, y, z]: [f64; 3]| 2.0 + 3.0 * x - if flat { 0.0 } else { y } + 0.5 * z;
            let space = finite_elements(&mesh);
            for at in [[0.1, 0.2, -0.2], [0.6, -0.1, -0.4], [0.0, 0.0, 0.0], [-0.7, 0.1, -0.45]] {
                let row = row_of_mesh(&mesh, at);
                let along = row.iter().map(|own| own.value * field(mesh.nodes[own.node as usize]));
                assert!((along.sum::<f64>() - field(at)).abs() < 1e-12, "{:?} {at:?}", mesh.form);
                let fitted = fit(&space.volume, mesh.form, at, 0.5, |_| true);
                let points =
                    fitted.iter().map(|(point, w)| w * field(space.volume.at[*point as usize]));
                assert!((points.sum::<f64>() - field(at)).abs() < 1e-12, "{:?} {at:?}", mesh.form);
            }
        }
    }
}
