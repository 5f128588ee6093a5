//! Eight numbers at once, which the compiler maps to the vectors available to it.

use std::ops::{Add, Mul, Sub};

pub const LANES: usize = 8;

/// Numbers that are processed alike. Nothing is fused, so that all processors round alike.
#[derive(Debug, Clone, Copy, Default)]
pub struct Lanes(pub [f64; LANES]);

macro_rules! lanewise {
    ($trait:ident, $method:ident) => {
        impl $trait for Lanes {
            type Output = Self;

            #[inline(always)]
            fn $method(mut self, other: Self) -> Self {
                for n in 0..LANES {
                    self.0[n] = self.0[n].$method(other.0[n]);
                }
                self
            }
        }
    };
}

lanewise!(Add, add);
lanewise!(Sub, sub);
lanewise!(Mul, mul);

impl Lanes {
    #[inline(always)]
    pub fn splat(value: f64) -> Self {
        Self([value; LANES])
    }

    #[inline(always)]
    pub fn map(mut self, f: impl Fn(f64) -> f64) -> Self {
        for n in 0..LANES {
            self.0[n] = f(self.0[n]);
        }
        self
    }

    /// Sum of the lanes, in pairs.
    #[inline(always)]
    pub fn sum(self) -> f64 {
        let [a, b, c, d, e, f, g, h] = self.0;
        ((a + e) + (c + g)) + ((b + f) + (d + h))
    }
}
