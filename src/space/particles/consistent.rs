//! Gradients of particles whose forces balance: the smallest change of all after which a constant stress is in
//! equilibrium with its tractions.
//!
//! Nodal forces of a constant stress P are `−P Σ w g_b` over the points, which have to be the tractions, `Σ w g_b = ∮
//! N_b n dA` (the integration constraint of J.-S. Chen, M. Hillman & M. Rüter 2013, doi 10.1002/nme.4512). Gradients g
//! are changed by the least squares that keep them exact for affine motion: `δg_b(a) = λ_b`, less the affine function
//! that is closest to λ at the nodes of a. The λ of all nodes follow from one symmetric positive semidefinite system
//! for each coordinate.

use std::collections::BTreeMap;

use super::Point;
use crate::math::cholesky::{Elimination, LowerTriangle, SparseCholesky};
use crate::math::conjugate_gradients::{self, Operator};
use crate::math::geometric_dissection::geometric_dissection;
use crate::runtime::parallel::Team;
use crate::space::factor::Factor;
use crate::space::finite_elements::boundary;
use crate::space::reproducing::Refused;
use crate::space::reproducing::facets::{Facet, corners, surface};
use crate::space::{Boundary, Form, Mesh, Side};

/// Part of the imbalance that is left.
const TOLERANCE: f64 = 1e-11;

/// A particle: its nodes, and what projects on the affine functions at these.
struct Patch<const N: usize> {
    nodes: Vec<u32>,
    /// 1 and coordinates from the particle over the size of its surroundings.
    terms: Vec<[f64; N]>,
    moments: Factor<N>,
    volume: f64,
}

impl<const N: usize> Patch<N> {
    /// Returns values at the nodes less the affine function that is closest to them.
    fn bent(&self, values: &[f64]) -> Vec<f64> {
        let mut sums = [0.0; N];
        for (&node, terms) in self.nodes.iter().zip(&self.terms) {
            (0..N).for_each(|i| sums[i] += values[node as usize] * terms[i]);
        }
        let affine = self.moments.solve(sums);
        let rest = |(&node, terms): (&u32, &[f64; N])| {
            values[node as usize] - (0..N).map(|i| affine[i] * terms[i]).sum::<f64>()
        };
        self.nodes.iter().zip(&self.terms).map(rest).collect()
    }
}

struct Balance<'a, const N: usize> {
    patches: &'a [Patch<N>],
    diagonal: Vec<f64>,
}

impl<const N: usize> Operator for Balance<'_, N> {
    fn apply(&self, x: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        for patch in self.patches {
            for (&node, rest) in patch.nodes.iter().zip(patch.bent(x)) {
                out[node as usize] += patch.volume * rest;
            }
        }
    }

    fn precondition(&self, residual: &[f64], out: &mut [f64]) {
        for ((out, residual), diagonal) in out.iter_mut().zip(residual).zip(&self.diagonal) {
            *out = residual / diagonal;
        }
    }
}

/// The same with a factor of its matrix as the preconditioner.
struct Factored<'a, const N: usize> {
    balance: &'a Balance<'a, N>,
    form: Form,
    places: &'a [[f64; 3]],
    factor: SparseCholesky,
}

impl<'a, const N: usize> Factored<'a, N> {
    fn of(balance: &'a Balance<'a, N>, (form, places): (Form, &'a [[f64; 3]])) -> Option<Self> {
        let mut columns: Vec<BTreeMap<u32, f64>> = vec![BTreeMap::new(); places.len()];
        for patch in balance.patches {
            for (column, terms) in patch.nodes.iter().zip(&patch.terms) {
                let solved = patch.moments.solve(*terms);
                for (row, other) in patch.nodes.iter().zip(&patch.terms) {
                    let affine = (0..N).map(|i| solved[i] * other[i]).sum::<f64>();
                    let own = if row == column { 1.0 } else { 0.0 };
                    if row >= column {
                        *columns[*column as usize].entry(*row).or_default() +=
                            patch.volume * (own - affine);
                    }
                }
            }
        }
        // Affine values have no energy, and a factor needs some.
        for (node, column) in columns.iter_mut().enumerate() {
            *column.entry(node as u32).or_default() += SHIFT * balance.diagonal[node];
        }
        let mut neighbours: Vec<Vec<u32>> = vec![Vec::new(); places.len()];
        for (node, column) in columns.iter().enumerate() {
            for &row in column.keys() {
                neighbours[node].push(row);
                neighbours[row as usize].push(node as u32);
            }
        }
        let order = geometric_dissection(places, &neighbours);
        let mut triangle = LowerTriangle { column_start: vec![0], ..LowerTriangle::default() };
        for column in columns {
            triangle.rows.extend(column.keys().map(|&row| row as usize));
            triangle.values.extend(column.into_values());
            triangle.column_start.push(triangle.rows.len());
        }
        let factor = Elimination::new(&triangle, &order).ok()?.factor(&triangle, 1).ok()?;
        Some(Self { balance, form, places, factor })
    }
}

/// Part of the diagonal that is added to the matrix before it is factored.
const SHIFT: f64 = 1e-11;

impl<const N: usize> Operator for Factored<'_, N> {
    fn apply(&self, x: &[f64], out: &mut [f64]) {
        self.balance.apply(x, out);
    }

    fn precondition(&self, residual: &[f64], out: &mut [f64]) {
        let mut solved = residual.to_vec();
        self.factor.solve_in_place(&mut solved);
        out.copy_from_slice(&without_affine::<N>(self.form, self.places, solved));
    }
}

/// Changes the gradients of points, those of one particle together.
pub fn balance<const N: usize>(
    (form, nodes): (Form, &[[f64; 3]]),
    boundary: &Boundary,
    particles: &mut [Vec<Point>],
) -> Result<(), Refused> {
    let axes = form.axes();
    let patches =
        particles.iter().enumerate().map(|(node, points)| patch(form, nodes, node, points));
    let patches: Vec<Patch<N>> = patches.collect::<Result<_, _>>()?;
    let mut diagonal = vec![0.0; nodes.len()];
    for patch in &patches {
        for (&node, terms) in patch.nodes.iter().zip(&patch.terms) {
            let solved = patch.moments.solve(*terms);
            let part = 1.0 - (0..N).map(|i| solved[i] * terms[i]).sum::<f64>();
            diagonal[node as usize] += patch.volume * part;
        }
    }
    let system = Balance { patches: &patches, diagonal };
    let mut factored = None;
    for &axis in axes {
        let missing = without_affine::<N>(form, nodes, missing(form, axis, particles, boundary));
        let factors = solve(&system, &mut factored, (form, nodes), &missing)?;
        for (points, patch) in particles.iter_mut().zip(&patches) {
            let change = patch.bent(&factors);
            for point in points {
                point.row.iter_mut().zip(&change).for_each(|(own, c)| own.gradient[axis] += c);
            }
        }
    }
    Ok(())
}

/// Solves the system. That of a long body is as ill conditioned as the fourth power of its length over the distance of
/// particles, and is factored.
fn solve<'a, const N: usize>(
    system: &'a Balance<N>,
    factored: &mut Option<Factored<'a, N>>,
    nodes: (Form, &'a [[f64; 3]]),
    missing: &[f64],
) -> Result<Vec<f64>, Refused> {
    let team = Team::new(1);
    if factored.is_none() {
        if let Ok((factors, _)) = conjugate_gradients::solve(system, missing, TOLERANCE, &team) {
            return Ok(factors);
        }
        *factored = Factored::of(system, nodes);
    }
    let unbalanced = || Refused::Setting(UNBALANCED);
    let factored = factored.as_ref().ok_or_else(unbalanced)?;
    let solved = conjugate_gradients::solve(factored, missing, TOLERANCE, &team);
    solved.map(|(factors, _)| factors).map_err(|_| unbalanced())
}

const UNBALANCED: &str = "the forces of particles do not balance; raise `support`, or refine the mesh across its thinnest part";

fn patch<const N: usize>(
    form: Form,
    nodes: &[[f64; 3]],
    node: usize,
    points: &[Point],
) -> Result<Patch<N>, Refused> {
    let own: Vec<u32> = points[0].row.iter().map(|value| value.node).collect();
    let at = nodes[node];
    let apart = |&other: &u32| form.axes().iter().map(move |&a| nodes[other as usize][a] - at[a]);
    let reach = own.iter().flat_map(apart).fold(0.0, |most: f64, x| most.max(x.abs()));
    let terms = |other: &u32| {
        let mut terms = [1.0; N];
        terms[1..].iter_mut().zip(apart(other)).for_each(|(term, x)| *term = x / reach);
        terms
    };
    let terms: Vec<[f64; N]> = own.iter().map(terms).collect();
    let few = Refused::FewParticles { at, neighbours: own.len() - 1 };
    let moments = Factor::of(&moments(&terms)).ok_or(few)?;
    let volume = points.iter().map(|point| point.weight).sum();
    Ok(Patch { nodes: own, terms, moments, volume })
}

/// Lower triangle of `Σ t tᵀ`.
fn moments<const N: usize>(terms: &[[f64; N]]) -> [[f64; N]; N] {
    let mut sums = [[0.0; N]; N];
    for own in terms {
        for i in 0..N {
            (0..=i).for_each(|j| sums[i][j] += own[i] * own[j]);
        }
    }
    sums
}

/// The surface of the model, planes of symmetry included.
pub fn whole_surface(mesh: &Mesh) -> Boundary {
    let outer = surface(mesh);
    let faces = mesh.cells.iter().zip(&outer).flat_map(|(cell, facets)| {
        let face = |facet: &Facet| corners(mesh.form, cell, facet.axis, facet.upper);
        facets.iter().map(move |facet| (facet.side.unwrap_or(Side::Left), face(facet)))
    });
    boundary(&Mesh { faces: faces.collect(), ..mesh.clone() })
}

/// `∮ N_b n dA − Σ w g_b` of each node along an axis; in a meridian section the hoop is a part of the radial force.
fn missing(form: Form, axis: usize, particles: &[Vec<Point>], boundary: &Boundary) -> Vec<f64> {
    let mut missing = vec![0.0; particles.len()];
    let samples = &boundary.samples;
    for (face, normal) in boundary.normals.iter().enumerate() {
        for value in samples.row(face) {
            missing[value.node as usize] += samples.weights[face] * normal[axis] * value.value;
        }
    }
    let is_radial = form == Form::Axisymmetric && axis == 0;
    for point in particles.iter().flatten() {
        for value in &point.row {
            let hoop = if is_radial { value.value / point.at[0] } else { 0.0 };
            missing[value.node as usize] -= point.weight * (value.gradient[axis] + hoop);
        }
    }
    missing
}

/// Removes the affine part, which sums of gradients that are exact for affine motion cannot change.
fn without_affine<const N: usize>(
    form: Form,
    nodes: &[[f64; 3]],
    mut values: Vec<f64>,
) -> Vec<f64> {
    let size = nodes.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
    let terms = |at: &[f64; 3]| {
        let mut terms = [1.0; N];
        terms[1..].iter_mut().zip(form.axes()).for_each(|(term, &a)| *term = at[a] / size);
        terms
    };
    let terms: Vec<[f64; N]> = nodes.iter().map(terms).collect();
    let Some(factor) = Factor::of(&moments(&terms)) else { return values };
    let mut sums = [0.0; N];
    for (value, terms) in values.iter().zip(&terms) {
        (0..N).for_each(|i| sums[i] += value * terms[i]);
    }
    let affine = factor.solve(sums);
    for (value, terms) in values.iter_mut().zip(&terms) {
        *value -= (0..N).map(|i| affine[i] * terms[i]).sum::<f64>();
    }
    values
}
