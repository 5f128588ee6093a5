//! Sixteen numbers at once.
//!
//! All implementations round alike (no fused operations, sums in one fixed order), so results are
//! the same to the bit on every processor.

use std::ops::{Add, Div, Mul, Sub};

use num_traits::Float;

use crate::kernel::Number;

/// Lanes of a vector.
pub const WIDTH: usize = 16;

/// A particle as the loops over pairs read it: eight numbers, loaded at once.
pub type Record<R> = [R; 8];

/// Further numbers of a particle, for the loops that need them.
pub type Annex<R> = [R; 4];

/// Arithmetic on [`WIDTH`] lanes.
pub trait Lanes: Number {
    type Real: Float + Number + Default + Into<f64> + Send + Sync;

    /// Lanes from an array of values.
    fn of_array(values: &[Self::Real; WIDTH]) -> Self;
    fn splat(value: Self::Real) -> Self;
    fn to_array(self) -> [Self::Real; WIDTH];

    /// A record relative to an origin.
    #[inline(always)]
    fn about(numbers: &[f64; 8], origin: &[f64; 8]) -> Record<Self::Real> {
        let mut record = [Self::Real::constant(0.0); 8];
        for n in 0..8 {
            record[n] = Self::Real::constant(numbers[n] - origin[n]);
        }
        record
    }

    /// Gathers the records at sixteen places, transposed to one vector per number.
    ///
    /// # Safety
    /// There is a record at every place.
    unsafe fn gather(records: &[Record<Self::Real>], places: &[u16; WIDTH]) -> [Self; 8];

    /// Gathers the annexes at sixteen places, transposed to one vector per number.
    ///
    /// # Safety
    /// There is an annex at every place.
    unsafe fn gather_annex(annexes: &[Annex<Self::Real>], places: &[u16; WIDTH]) -> [Self; 4];

    /// Sum of the lanes, in pairs of pairs.
    #[inline(always)]
    fn sum(self) -> Self::Real {
        let mut values = self.to_array();
        let mut count = WIDTH / 2;
        while count > 0 {
            for lane in 0..count {
                values[lane] = values[lane] + values[lane + count];
            }
            count /= 2;
        }
        values[0]
    }
}

/// Three numbers, each broadcast to all lanes. (Loops over lanes use no closures, which would not
/// be compiled for the instructions of the enclosing function.)
#[inline(always)]
pub fn lanes<L: Lanes>([x, y, z]: [f64; 3]) -> [L; 3] {
    [L::constant(x), L::constant(y), L::constant(z)]
}

/// The sums of three lanes, multiplied by a factor.
#[inline(always)]
pub fn scaled<L: Lanes>([x, y, z]: [L; 3], factor: f64) -> [f64; 3] {
    [factor * x.sum().into(), factor * y.sum().into(), factor * z.sum().into()]
}

/// Lanes as an array, which the compiler maps to the vectors available to it.
#[derive(Debug, Clone, Copy)]
pub struct Array<R>([R; WIDTH]);

macro_rules! lanewise {
    ($trait:ident, $method:ident) => {
        impl<R: Float> $trait for Array<R> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let mut result = self.0;
                for lane in 0..WIDTH {
                    result[lane] = result[lane].$method(other.0[lane]);
                }
                Self(result)
            }
        }
    };
}

lanewise!(Add, add);
lanewise!(Sub, sub);
lanewise!(Mul, mul);
lanewise!(Div, div);

impl<R: Float + Number> Number for Array<R> {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self([R::constant(value); WIDTH])
    }

    #[inline(always)]
    fn max(mut self, other: Self) -> Self {
        for lane in 0..WIDTH {
            self.0[lane] = Number::max(self.0[lane], other.0[lane]);
        }
        self
    }

    #[inline(always)]
    fn sqrt(mut self) -> Self {
        for lane in 0..WIDTH {
            self.0[lane] = Number::sqrt(self.0[lane]);
        }
        self
    }

    #[inline(always)]
    fn choose_below(self, limit: f64, low: Self, mut high: Self) -> Self {
        for lane in 0..WIDTH {
            high.0[lane] = self.0[lane].choose_below(limit, low.0[lane], high.0[lane]);
        }
        high
    }
}

impl<R: Float + Number + Default + Into<f64> + Send + Sync> Lanes for Array<R> {
    type Real = R;

    #[inline(always)]
    fn of_array(values: &[R; WIDTH]) -> Self {
        Self(*values)
    }

    #[inline(always)]
    fn splat(value: R) -> Self {
        Self([value; WIDTH])
    }

    #[inline(always)]
    fn to_array(self) -> [R; WIDTH] {
        self.0
    }

    #[inline(always)]
    unsafe fn gather(records: &[Record<R>], places: &[u16; WIDTH]) -> [Self; 8] {
        let mut result = [Self([R::default(); WIDTH]); 8];
        for (lane, &place) in places.iter().enumerate() {
            let record = &records[place as usize];
            for (numbers, &number) in result.iter_mut().zip(record) {
                numbers.0[lane] = number;
            }
        }
        result
    }

    #[inline(always)]
    unsafe fn gather_annex(annexes: &[Annex<R>], places: &[u16; WIDTH]) -> [Self; 4] {
        let mut result = [Self([R::default(); WIDTH]); 4];
        for (lane, &place) in places.iter().enumerate() {
            let annex = &annexes[place as usize];
            for (numbers, &number) in result.iter_mut().zip(annex) {
                numbers.0[lane] = number;
            }
        }
        result
    }
}

#[cfg(target_arch = "x86_64")]
pub use avx512::Avx512;

#[cfg(target_arch = "x86_64")]
mod avx512 {
    use std::arch::x86_64::*;
    use std::ops::{Add, Div, Mul, Sub};

    use super::{Annex, Lanes, Number, Record, WIDTH};

    /// Lanes in one AVX-512 register. Use it only inside functions compiled for AVX-512.
    #[derive(Debug, Clone, Copy)]
    pub struct Avx512(__m512);

    // SAFETY, for all blocks below: values of this type are created only in functions that are
    // called after AVX-512F was detected.
    macro_rules! lanewise {
        ($trait:ident, $method:ident, $instruction:ident) => {
            impl $trait for Avx512 {
                type Output = Self;
                #[inline(always)]
                fn $method(self, other: Self) -> Self {
                    Self(unsafe { $instruction(self.0, other.0) })
                }
            }
        };
    }

    lanewise!(Add, add, _mm512_add_ps);
    lanewise!(Sub, sub, _mm512_sub_ps);
    lanewise!(Mul, mul, _mm512_mul_ps);
    lanewise!(Div, div, _mm512_div_ps);

    impl Number for Avx512 {
        #[inline(always)]
        fn constant(value: f64) -> Self {
            Self(unsafe { _mm512_set1_ps(value as f32) })
        }

        #[inline(always)]
        fn max(self, other: Self) -> Self {
            Self(unsafe { _mm512_max_ps(self.0, other.0) })
        }

        #[inline(always)]
        fn sqrt(self) -> Self {
            Self(unsafe { _mm512_sqrt_ps(self.0) })
        }

        #[inline(always)]
        fn choose_below(self, limit: f64, low: Self, high: Self) -> Self {
            Self(unsafe {
                let below = _mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, Self::constant(limit).0);
                _mm512_mask_blend_ps(below, high.0, low.0)
            })
        }
    }

    impl Lanes for Avx512 {
        type Real = f32;

        #[inline(always)]
        fn of_array(values: &[f32; WIDTH]) -> Self {
            Self(unsafe { _mm512_loadu_ps(values.as_ptr()) })
        }

        #[inline(always)]
        fn splat(value: f32) -> Self {
            Self(unsafe { _mm512_set1_ps(value) })
        }

        #[inline(always)]
        fn to_array(self) -> [f32; WIDTH] {
            let mut values = [0.0; WIDTH];
            unsafe { _mm512_storeu_ps(values.as_mut_ptr(), self.0) };
            values
        }

        #[inline(always)]
        fn about(numbers: &[f64; 8], origin: &[f64; 8]) -> Record<f32> {
            let mut record = [0.0; 8];
            unsafe {
                let numbers = _mm512_loadu_pd(numbers.as_ptr());
                let away = _mm512_sub_pd(numbers, _mm512_loadu_pd(origin.as_ptr()));
                _mm256_storeu_ps(record.as_mut_ptr(), _mm512_cvtpd_ps(away));
            }
            record
        }

        #[inline(always)]
        fn sum(self) -> f32 {
            unsafe {
                let high = _mm256_castpd_ps(_mm512_extractf64x4_pd::<1>(_mm512_castps_pd(self.0)));
                let eight = _mm256_add_ps(_mm512_castps512_ps256(self.0), high);
                let four =
                    _mm_add_ps(_mm256_castps256_ps128(eight), _mm256_extractf128_ps::<1>(eight));
                let two = _mm_add_ps(four, _mm_movehl_ps(four, four));
                _mm_cvtss_f32(_mm_add_ss(two, _mm_movehdup_ps(two)))
            }
        }

        /// Loads each record at once and transposes them in registers; this is several times faster
        /// than the processor's gather instructions.
        #[inline(always)]
        unsafe fn gather(records: &[Record<f32>], places: &[u16; WIDTH]) -> [Self; 8] {
            // SAFETY: by contract.
            let pair = unsafe {
                [
                    pair(records, places[0], places[4]),
                    pair(records, places[1], places[5]),
                    pair(records, places[2], places[6]),
                    pair(records, places[3], places[7]),
                    pair(records, places[8], places[12]),
                    pair(records, places[9], places[13]),
                    pair(records, places[10], places[14]),
                    pair(records, places[11], places[15]),
                ]
            };
            let near = transpose([pair[0], pair[1], pair[2], pair[3]]);
            let far = transpose([pair[4], pair[5], pair[6], pair[7]]);
            let mut result = [Self(near[0]); 8];
            for k in 0..4 {
                unsafe {
                    result[k] = Self(_mm512_shuffle_f32x4::<0x88>(near[k], far[k]));
                    result[k + 4] = Self(_mm512_shuffle_f32x4::<0xDD>(near[k], far[k]));
                }
            }
            result
        }

        #[inline(always)]
        unsafe fn gather_annex(annexes: &[Annex<f32>], places: &[u16; WIDTH]) -> [Self; 4] {
            // SAFETY: by contract.
            let [a, b, c, d] = transpose(unsafe {
                [
                    four(annexes, [places[0], places[4], places[8], places[12]]),
                    four(annexes, [places[1], places[5], places[9], places[13]]),
                    four(annexes, [places[2], places[6], places[10], places[14]]),
                    four(annexes, [places[3], places[7], places[11], places[15]]),
                ]
            });
            [Self(a), Self(b), Self(c), Self(d)]
        }
    }

    /// Two records in one register; both places must hold records.
    #[inline(always)]
    unsafe fn pair(records: &[Record<f32>], low: u16, high: u16) -> __m512 {
        debug_assert!(usize::from(low.max(high)) < records.len());
        unsafe {
            let low = _mm256_loadu_ps(records.get_unchecked(usize::from(low)).as_ptr());
            let high = _mm256_loadu_ps(records.get_unchecked(usize::from(high)).as_ptr());
            let low = _mm512_castps_pd(_mm512_castps256_ps512(low));
            _mm512_castpd_ps(_mm512_insertf64x4::<1>(low, _mm256_castps_pd(high)))
        }
    }

    /// The annex at a place that has one.
    #[inline(always)]
    unsafe fn annex(annexes: &[Annex<f32>], place: u16) -> __m128 {
        debug_assert!(usize::from(place) < annexes.len());
        unsafe { _mm_loadu_ps(annexes.get_unchecked(usize::from(place)).as_ptr()) }
    }

    /// Four annexes in one register; all four places must hold annexes.
    #[inline(always)]
    unsafe fn four(annexes: &[Annex<f32>], places: [u16; 4]) -> __m512 {
        let [a, b, c, d] = places;
        unsafe {
            let first = _mm512_castps128_ps512(annex(annexes, a));
            let second = _mm512_insertf32x4::<1>(first, annex(annexes, b));
            let third = _mm512_insertf32x4::<2>(second, annex(annexes, c));
            _mm512_insertf32x4::<3>(third, annex(annexes, d))
        }
    }

    /// Transposes the 4 × 4 blocks that lie in each quarter of four registers.
    #[inline(always)]
    fn transpose([a, b, c, d]: [__m512; 4]) -> [__m512; 4] {
        unsafe {
            let [ab_low, ab_high] = [_mm512_unpacklo_ps(a, b), _mm512_unpackhi_ps(a, b)];
            let [cd_low, cd_high] = [_mm512_unpacklo_ps(c, d), _mm512_unpackhi_ps(c, d)];
            [
                _mm512_shuffle_ps::<0x44>(ab_low, cd_low),
                _mm512_shuffle_ps::<0xEE>(ab_low, cd_low),
                _mm512_shuffle_ps::<0x44>(ab_high, cd_high),
                _mm512_shuffle_ps::<0xEE>(ab_high, cd_high),
            ]
        }
    }
}
