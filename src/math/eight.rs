//! Eight numbers at once, in double precision.
//!
//! All implementations round alike: nothing is fused.

use std::ops::{Add, Mul};

/// Arithmetic on eight numbers, lane by lane.
pub trait Eight: Copy + Add<Output = Self> + Mul<Output = Self> {
    fn splat(value: f64) -> Self;
    fn load(from: &[f64; 8]) -> Self;
    fn store(self, to: &mut [f64; 8]);
}

/// An array, which the compiler maps to the vectors available to it.
#[derive(Debug, Clone, Copy)]
pub struct Array([f64; 8]);

macro_rules! lanewise {
    ($trait:ident, $method:ident) => {
        impl $trait for Array {
            type Output = Self;
            #[inline(always)]
            fn $method(mut self, other: Self) -> Self {
                for lane in 0..8 {
                    self.0[lane] = self.0[lane].$method(other.0[lane]);
                }
                self
            }
        }
    };
}

lanewise!(Add, add);
lanewise!(Mul, mul);

impl Eight for Array {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([value; 8])
    }

    #[inline(always)]
    fn load(from: &[f64; 8]) -> Self {
        Self(*from)
    }

    #[inline(always)]
    fn store(self, to: &mut [f64; 8]) {
        *to = self.0;
    }
}

#[cfg(target_arch = "x86_64")]
pub use avx512::Avx512;

#[cfg(target_arch = "x86_64")]
mod avx512 {
    use std::arch::x86_64::*;
    use std::ops::{Add, Mul};

    use super::Eight;

    /// One AVX-512 register. Use it only inside functions compiled for AVX-512.
    #[derive(Debug, Clone, Copy)]
    pub struct Avx512(__m512d);

    // SAFETY, for all blocks below: values of this type are created only in functions that are
    // called after AVX-512F was detected.
    impl Add for Avx512 {
        type Output = Self;
        #[inline(always)]
        fn add(self, other: Self) -> Self {
            Self(unsafe { _mm512_add_pd(self.0, other.0) })
        }
    }

    impl Mul for Avx512 {
        type Output = Self;
        #[inline(always)]
        fn mul(self, other: Self) -> Self {
            Self(unsafe { _mm512_mul_pd(self.0, other.0) })
        }
    }

    impl Eight for Avx512 {
        #[inline(always)]
        fn splat(value: f64) -> Self {
            Self(unsafe { _mm512_set1_pd(value) })
        }

        #[inline(always)]
        fn load(from: &[f64; 8]) -> Self {
            Self(unsafe { _mm512_loadu_pd(from.as_ptr()) })
        }

        #[inline(always)]
        fn store(self, to: &mut [f64; 8]) {
            unsafe { _mm512_storeu_pd(to.as_mut_ptr(), self.0) }
        }
    }
}
