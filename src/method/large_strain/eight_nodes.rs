//! The sums of [`element`](super::element) for blocks of eight nodes that move along three axes: hexahedra.
//!
//! A vector holds a number for each node. Sums have the order of those for any number of nodes, and nothing is fused,
//! so both round alike on all processors.

#[cfg(target_arch = "x86_64")]
use crate::math::eight::Avx512;
use crate::math::eight::{Array, Eight};

/// Number of nodes, of unknowns, and of components of F.
pub const NODES: usize = 8;
const AXES: usize = 3;
pub const WIDTH: usize = AXES * NODES;
const COMPONENTS: usize = AXES * AXES;
/// Nodes whose rows are summed together.
const TOGETHER: usize = 4;

/// Adds weighted contractions of the changes of F under the displacements of all nodes with tensors, one after another
/// in `tensors` and `sums`.
pub fn contract(changes: [&[f64]; AXES], tensors: &[f64], weight: f64, sums: &mut [f64]) {
    let changes = changes.map(|of_axis| of_axis.try_into().expect("a change for each node"));
    #[cfg(target_arch = "x86_64")]
    {
        if is_x86_feature_detected!("avx512f") {
            // SAFETY: the processor has the function's instructions.
            return unsafe { contract_avx512(changes, tensors, weight, sums) };
        }
        if is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has the function's instructions.
            return unsafe { contract_avx2(changes, tensors, weight, sums) };
        }
    }
    contract_with::<Array>(changes, tensors, weight, sums);
}

/// Computes `out = Σ own rowsᵀ` of all terms: rows of the nodes along one axis.
pub fn multiply(out: &mut [f64], own: &[f64], rows: &[f64]) {
    #[cfg(target_arch = "x86_64")]
    {
        if is_x86_feature_detected!("avx512f") {
            // SAFETY: the processor has the function's instructions.
            return unsafe { multiply_avx512(out, own, rows) };
        }
        if is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has the function's instructions.
            return unsafe { multiply_avx2(out, own, rows) };
        }
    }
    multiply_with::<Array>(out, own, rows);
}

type Changes<'a> = [&'a [f64; NODES]; AXES];

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f")]
fn contract_avx512(changes: Changes, tensors: &[f64], weight: f64, sums: &mut [f64]) {
    contract_with::<Avx512>(changes, tensors, weight, sums);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn contract_avx2(changes: Changes, tensors: &[f64], weight: f64, sums: &mut [f64]) {
    contract_with::<Array>(changes, tensors, weight, sums);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f")]
fn multiply_avx512(out: &mut [f64], own: &[f64], rows: &[f64]) {
    multiply_with::<Avx512>(out, own, rows);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn multiply_avx2(out: &mut [f64], own: &[f64], rows: &[f64]) {
    multiply_with::<Array>(out, own, rows);
}

#[inline(always)]
fn contract_with<E: Eight>(changes: Changes, tensors: &[f64], weight: f64, sums: &mut [f64]) {
    let (tensors, _) = tensors.as_chunks::<COMPONENTS>();
    let (sums, _) = sums.as_chunks_mut::<NODES>();
    let mut next = 0;
    for tensor in tensors {
        for axis in 0..AXES {
            let mut sum = E::load(&sums[next]);
            for b in 0..AXES {
                let factor = E::splat(weight * tensor[AXES * axis + b]);
                sum = sum + factor * E::load(changes[b]);
            }
            sum.store(&mut sums[next]);
            next += 1;
        }
    }
}

#[inline(always)]
fn multiply_with<E: Eight>(out: &mut [f64], own: &[f64], rows: &[f64]) {
    let (out, _) = out.as_chunks_mut::<NODES>();
    let ((own, _), (rows, _)) = (own.as_chunks::<NODES>(), rows.as_chunks::<WIDTH>());
    for first in (0..NODES).step_by(TOGETHER) {
        let mut sums = [[E::splat(0.0); AXES]; TOGETHER];
        for (own, row) in own.iter().zip(rows) {
            let (row, _) = row.as_chunks::<NODES>();
            for axis in 0..AXES {
                let row = E::load(&row[axis]);
                for node in 0..TOGETHER {
                    sums[node][axis] = sums[node][axis] + E::splat(own[first + node]) * row;
                }
            }
        }
        for node in 0..TOGETHER {
            for axis in 0..AXES {
                sums[node][axis].store(&mut out[AXES * (first + node) + axis]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Random;

    /// The sums of all processors are those of plain loops, to the bit.
    #[test]
    fn vectors_round_as_plain_sums_do() {
        let mut random = Random::of(3);
        let mut numbers =
            |count: usize| -> Vec<f64> { (0..count).map(|_| random.number()).collect() };
        let (changes, tensors) = (numbers(WIDTH), numbers(2 * COMPONENTS));
        let mut sums = numbers(2 * WIDTH);
        let mut plain = sums.clone();
        for (n, sum) in plain.iter_mut().enumerate() {
            for b in 0..AXES {
                *sum += 0.7 * tensors[AXES * (n / NODES) + b] * changes[NODES * b + n % NODES];
            }
        }
        let (of_axes, _) = changes.as_chunks::<NODES>();
        contract([0, 1, 2].map(|b| &of_axes[b][..]), &tensors, 0.7, &mut sums);
        assert_eq!(sums, plain);

        let terms = 5;
        let (own, rows) = (numbers(terms * NODES), numbers(terms * WIDTH));
        let mut out = vec![f64::NAN; NODES * WIDTH];
        multiply(&mut out, &own, &rows);
        for (n, found) in out.iter().enumerate() {
            let term = |term: usize| own[NODES * term + n / WIDTH] * rows[WIDTH * term + n % WIDTH];
            assert_eq!(*found, (0..terms).fold(0.0, |sum, t| sum + term(t)));
        }
    }
}
