//! Sparse stiffness of a lattice: its pattern once, its numbers for each state of damage.

use super::frame::{COMPONENTS, Frame};
use super::link::{Deformation, Link};
use crate::math::cholesky::{Elimination, LowerTriangle, SolverError, SparseCholesky};

/// Part of its stiffness that a broken link keeps in systems that are solved; residuals have none of it.
pub const REMAINDER: f64 = 1e-8;

/// Places of the entries of all links in the lower triangle.
pub struct Pattern {
    pub frame: Frame,
    /// Unknowns of both ends of each link.
    pub unknowns: Vec<[Option<usize>; 6]>,
    rows: Vec<[[f64; 6]; 3]>,
    /// For each link the places of the lower triangle of its matrix.
    places: Vec<[usize; 21]>,
    matrix: LowerTriangle,
    elimination: Elimination,
    threads: usize,
}

/// Place of an entry that belongs to a component without unknown.
const NOWHERE: usize = usize::MAX;

impl Pattern {
    /// `order` is the order of elimination of the particles.
    pub fn new(
        frame: Frame,
        links: &[Link],
        order: &[usize],
        threads: usize,
    ) -> Result<Self, SolverError> {
        let number = |i: usize, k: usize| frame.unknown[COMPONENTS * i + k];
        let of_link = |link: &Link| {
            let [a, b] = link.ends;
            [number(a, 0), number(a, 1), number(a, 2), number(b, 0), number(b, 1), number(b, 2)]
        };
        let unknowns: Vec<_> = links.iter().map(of_link).collect();
        let mut columns: Vec<Vec<usize>> = (0..frame.unknowns).map(|j| vec![j]).collect();
        for own in &unknowns {
            for (row, column) in lower(own).flatten() {
                columns[column].push(row);
            }
        }
        let mut matrix = LowerTriangle { column_start: vec![0], ..LowerTriangle::default() };
        for column in &mut columns {
            column.sort_unstable();
            column.dedup();
            matrix.rows.extend(column.iter());
            matrix.column_start.push(matrix.rows.len());
        }
        let place = |(row, column): (usize, usize)| {
            let ends = matrix.column_start[column]..matrix.column_start[column + 1];
            ends.start + matrix.rows[ends].partition_point(|&other| other < row)
        };
        let places = unknowns.iter().map(|own| {
            let mut places = [NOWHERE; 21];
            for (at, entry) in places.iter_mut().zip(lower(own)) {
                *at = entry.map_or(NOWHERE, place);
            }
            places
        });
        let places = places.collect();
        let rows = links.iter().map(Link::rows).collect();
        let elimination = Elimination::new(&matrix, &unknown_order(&frame, order))?;
        Ok(Self { unknowns, rows, places, matrix, elimination, threads, frame })
    }

    /// Factors the stiffness of links of which the given parts of axial and flexural stiffness remain.
    pub fn factor(
        &self,
        links: &[Link],
        remaining: impl Fn(usize) -> [f64; 2],
    ) -> Result<SparseCholesky, SolverError> {
        let mut matrix = self.matrix.clone();
        matrix.values = vec![0.0; matrix.rows.len()];
        for (l, link) in links.iter().enumerate() {
            let [axial, flexural] = remaining(l).map(|part| part.max(REMAINDER));
            let rows = &self.rows[l];
            let scaled = [0, 1, 2, 3, 4, 5].map(|k| {
                let forces = link.elastic(&[rows[0][k], rows[1][k], rows[2][k]]);
                [axial * forces[0], flexural * forces[1], flexural * forces[2]]
            });
            let mut at = self.places[l].iter();
            for a in 0..6 {
                for forces in &scaled[..=a] {
                    let place = at.next().copied().unwrap_or(NOWHERE);
                    if place != NOWHERE {
                        let entry = (0..3).map(|m| rows[m][a] * forces[m]).sum::<f64>();
                        matrix.values[place] += entry;
                    }
                }
            }
        }
        self.elimination.factor(&matrix, self.threads)
    }

    /// Deformation of a link under given displacements of the unknowns.
    pub fn deformation(&self, l: usize, displacement: &[f64]) -> Deformation {
        let moved = self.unknowns[l].map(|unknown| unknown.map_or(0.0, |at| displacement[at]));
        self.rows[l].map(|row| row.iter().zip(&moved).map(|(a, b)| a * b).sum())
    }

    /// Adds the forces of a link, conjugate to its deformation, to those of the unknowns.
    pub fn add_forces(&self, l: usize, conjugate: &Deformation, forces: &mut [f64]) {
        for (k, unknown) in self.unknowns[l].iter().enumerate() {
            if let Some(at) = unknown {
                forces[*at] += (0..3).map(|m| self.rows[l][m][k] * conjugate[m]).sum::<f64>();
            }
        }
    }
}

/// Entries of the lower triangle of a link's matrix, row by row, as row and column of the whole one.
fn lower(own: &[Option<usize>; 6]) -> impl Iterator<Item = Option<(usize, usize)>> {
    (0..6).flat_map(move |a| {
        (0..=a).map(move |b| {
            let (row, column) = (own[a]?, own[b]?);
            Some((row.max(column), row.min(column)))
        })
    })
}

/// Order of the unknowns that follows from that of the particles; an unknown of several comes with the last of them.
fn unknown_order(frame: &Frame, particles: &[usize]) -> Vec<usize> {
    let components =
        particles.iter().rev().flat_map(|&i| (0..COMPONENTS).map(move |k| COMPONENTS * i + k));
    let mut is_listed = vec![false; frame.unknowns];
    let mut order: Vec<usize> = components
        .filter_map(|component| frame.unknown[component])
        .filter(|&unknown| !std::mem::replace(&mut is_listed[unknown], true))
        .collect();
    order.reverse();
    order
}
