//! Loops compiled for several kinds of processors, of which the widest that there is runs.

use super::lanes::{Array, Lanes};
use crate::scene::Precision;

/// Work on vectors, whatever they are made of.
pub trait Work {
    /// To be marked as always inlined, so that it is compiled for the instructions at hand.
    fn run<L: Lanes>(self);
}

/// Takes the widest instructions that the processor has.
pub fn dispatch(work: impl Work, precision: Precision) {
    if precision == Precision::Double {
        return work.run::<Array<f64>>();
    }
    #[cfg(target_arch = "x86_64")]
    {
        if is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vl") {
            // SAFETY: the processor has what the function asks for.
            return unsafe { run_avx512(work) };
        }
        if is_x86_feature_detected!("avx2") {
            // SAFETY: as above.
            return unsafe { run_avx2(work) };
        }
    }
    work.run::<Array<f32>>();
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl")]
fn run_avx512(work: impl Work) {
    work.run::<super::lanes::Avx512>();
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn run_avx2(work: impl Work) {
    work.run::<Array<f32>>();
}
