//! Coarse phase of the neighbour search: finds the particles close to a box.

use super::images::Image;
use super::lanes::WIDTH;
use super::order::{BLOCK, Bounds};

/// Positions of a block's particles relative to one of them, in single precision.
#[derive(Debug, Clone)]
pub struct RelativePoints {
    pub origin: [f64; 3],
    pub along: [[f32; BLOCK]; 3],
    /// Number of points; padding follows them to fill whole vectors.
    pub count: usize,
}

/// Coordinates of points along x, y, z: `count` points, followed by padding to whole vectors.
#[derive(Debug, Clone, Copy)]
pub struct Points<'a> {
    pub along: [&'a [f32]; 3],
    pub count: usize,
}

/// Particles close to a box, and their coordinates about its centre. Its memory is reused from one
/// search to the next.
#[derive(Debug, Default)]
pub struct Candidates {
    count: usize,
    /// Index of the first candidate of the most recent `take`.
    from: usize,
    numbers: Vec<u32>,
    along: [Vec<f32>; 3],
}

/// Numbers of candidates, in memory that is reused from one list to the next.
#[derive(Debug, Default)]
pub struct Numbers {
    count: usize,
    list: Vec<u32>,
}

impl Numbers {
    pub fn list(&self) -> &[u32] {
        &self.list[..self.count]
    }
}

/// Search region: all x nearer than `reach` to the box that extends by `half` from the centre along
/// each axis.
#[derive(Debug, Clone, Copy)]
pub struct Near {
    pub half: [f32; 3],
    pub reach_squared: f32,
}

impl Near {
    /// Region slightly larger than requested, so that rounding excludes nothing.
    pub fn to(bounds: &Bounds, reach: f64) -> Self {
        let half = [0, 1, 2].map(|a| (0.5 * (bounds.high[a] - bounds.low[a])) as f32 + 1e-6);
        Self { half, reach_squared: (reach * reach) as f32 + 1e-6 }
    }

    /// Returns true if a place relative to the centre is in the region.
    fn has(&self, at: [f32; 3]) -> bool {
        let mut square = 0.0;
        for (at, half) in at.into_iter().zip(self.half) {
            let gap = (at.abs() - half).max(0.0);
            square += gap * gap;
        }
        square < self.reach_squared
    }

    /// Returns a mask of those of sixteen places that are in the region, with the same roundings as
    /// [`Self::has`].
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f")]
    fn has_of_sixteen(&self, at: [std::arch::x86_64::__m512; 3]) -> u16 {
        use std::arch::x86_64::*;
        let mut square = _mm512_setzero_ps();
        for (at, half) in at.into_iter().zip(self.half) {
            let away = _mm512_sub_ps(_mm512_abs_ps(at), _mm512_set1_ps(half));
            let gap = _mm512_max_ps(away, _mm512_setzero_ps());
            square = _mm512_add_ps(square, _mm512_mul_ps(gap, gap));
        }
        _mm512_cmp_ps_mask::<_CMP_LT_OQ>(square, _mm512_set1_ps(self.reach_squared))
    }
}

impl RelativePoints {
    /// Positions of the particles of a block.
    pub fn of(points: &[[f64; 3]]) -> Self {
        let origin = points[0];
        let mut along = [[f32::MAX; BLOCK]; 3];
        for (k, point) in points.iter().enumerate() {
            for a in 0..3 {
                along[a][k] = (point[a] - origin[a]) as f32;
            }
        }
        Self { origin, along, count: points.len() }
    }

    fn points(&self) -> Points<'_> {
        Points { along: self.along.each_ref().map(|along| &along[..]), count: self.count }
    }
}

impl Candidates {
    /// Appends the particles within `near`, where a particle stands at `signs · spot + shift` about
    /// the centre of the box.
    pub fn take(&mut self, spots: Points, signs: [f32; 3], shift: [f32; 3], near: Near) {
        self.from = self.count;
        // Room for all, and for the last vector to be written whole.
        let room = self.count + spots.along[0].len() + WIDTH;
        if self.numbers.len() < room {
            self.numbers.resize(room, 0);
            self.along.iter_mut().for_each(|along| along.resize(room, 0.0));
        }
        let mut along = self.along.each_mut().map(|along| &mut along[self.from..]);
        let numbers = &mut self.numbers[self.from..];
        self.count += compress(spots, signs, shift, near, numbers, &mut along);
    }

    /// Appends the nearby images of some particles, for a box with this centre.
    pub fn take_images(
        &mut self,
        spots: &RelativePoints,
        image: &Image,
        centre: [f64; 3],
        near: Near,
    ) {
        let origin = image.place(spots.origin);
        let shift = [0, 1, 2].map(|a| (origin[a] - centre[a]) as f32);
        self.take(spots.points(), image.signs.map(|sign| sign as f32), shift, near);
    }

    /// Lists the numbers of candidates close to another box, about whose centre they are displaced
    /// by `shift`.
    pub fn narrow(&mut self, shift: [f32; 3], near: Near, numbers: &mut Numbers) {
        let (_, points) = self.all();
        let room = points.along[0].len() + WIDTH;
        if numbers.list.len() < room {
            numbers.list.resize(room, 0);
        }
        numbers.count = select(points, shift, near, &mut numbers.list);
    }

    /// Discards all candidates.
    pub fn clear(&mut self) {
        self.count = 0;
    }

    /// Numbers of the candidates of the most recent `take`, in the list that they were taken from.
    pub fn last_numbers(&self) -> &[u32] {
        &self.numbers[self.from..self.count]
    }

    /// Numbers and coordinates of all candidates, each followed by at least one vector of padding,
    /// to complete whole vectors.
    pub fn all(&mut self) -> (&[u32], Points<'_>) {
        let (count, full) = (self.count, self.count.next_multiple_of(WIDTH) + WIDTH);
        if self.numbers.len() < full {
            self.numbers.resize(full, 0);
        }
        let along = self.along.each_mut().map(|along| {
            along.resize(full.max(along.len()), 0.0);
            along[count..full].fill(f32::MAX);
            &along[..full]
        });
        (&self.numbers[..full], Points { along, count })
    }
}

fn compress(
    spots: Points,
    signs: [f32; 3],
    shift: [f32; 3],
    near: Near,
    numbers: &mut [u32],
    along: &mut [&mut [f32]; 3],
) -> usize {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx512f") {
        // SAFETY: the processor has the features that the function requires.
        return unsafe { compress_avx512(spots, signs, shift, near, numbers, along) };
    }
    compress_each(spots, signs, shift, near, numbers, along)
}

/// Processes one at a time without a branch: always writes, keeps what is near.
fn compress_each(
    spots: Points,
    signs: [f32; 3],
    shift: [f32; 3],
    near: Near,
    numbers: &mut [u32],
    along: &mut [&mut [f32]; 3],
) -> usize {
    let [along_x, along_y, along_z] = spots.along.map(<[f32]>::iter);
    let mut found = 0;
    for (k, ((&x, &y), &z)) in along_x.zip(along_y).zip(along_z).enumerate().take(spots.count) {
        let spot = [x, y, z];
        let at = [0, 1, 2].map(|a| signs[a] * spot[a] + shift[a]);
        numbers[found] = k as u32;
        (0..3).for_each(|a| along[a][found] = at[a]);
        found += usize::from(near.has(at));
    }
    found
}

/// Processes sixteen at a time, with the same roundings.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f")]
fn compress_avx512(
    spots: Points,
    signs: [f32; 3],
    shift: [f32; 3],
    near: Near,
    numbers: &mut [u32],
    along: &mut [&mut [f32]; 3],
) -> usize {
    use std::arch::x86_64::*;
    let ahead = _mm512_set1_epi32(WIDTH as i32);
    let mut number = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    let mut found = 0;
    for k in (0..spots.count).step_by(WIDTH) {
        let mut at = [_mm512_setzero_ps(); 3];
        for a in 0..3 {
            // SAFETY: the slice is as long as a vector.
            let spot = unsafe { _mm512_loadu_ps(spots.along[a][k..k + WIDTH].as_ptr()) };
            let turned = _mm512_mul_ps(_mm512_set1_ps(signs[a]), spot);
            at[a] = _mm512_add_ps(turned, _mm512_set1_ps(shift[a]));
        }
        let kept = near.has_of_sixteen(at) & inside(spots.count - k);
        if kept != 0 {
            let end = found + WIDTH;
            let place = numbers[found..end].as_mut_ptr();
            // SAFETY: the slices are as long as a vector.
            unsafe { _mm512_storeu_epi32(place.cast(), _mm512_maskz_compress_epi32(kept, number)) };
            for a in 0..3 {
                let place = along[a][found..end].as_mut_ptr();
                unsafe { _mm512_storeu_ps(place, _mm512_maskz_compress_ps(kept, at[a])) };
            }
            found += kept.count_ones() as usize;
        }
        number = _mm512_add_epi32(number, ahead);
    }
    found
}

/// Returns a mask of the next sixteen lanes that hold one of `rest` points.
#[cfg(target_arch = "x86_64")]
pub fn inside(rest: usize) -> u16 {
    if rest < WIDTH { (1 << rest) - 1 } else { u16::MAX }
}

/// Writes the numbers of nearby points into a list with room for one more vector than there are
/// points; returns their number.
fn select(points: Points, shift: [f32; 3], near: Near, numbers: &mut [u32]) -> usize {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx512f") {
        // SAFETY: the processor has the features that the function requires.
        return unsafe { select_avx512(points, shift, near, numbers) };
    }
    select_each(points, shift, near, numbers)
}

/// Processes one at a time without a branch: always writes, keeps what is near.
fn select_each(points: Points, shift: [f32; 3], near: Near, numbers: &mut [u32]) -> usize {
    let [x, y, z] = points.along;
    let mut found = 0;
    for (k, ((&x, &y), &z)) in x.iter().zip(y).zip(z).enumerate().take(points.count) {
        numbers[found] = k as u32;
        found += usize::from(near.has([x + shift[0], y + shift[1], z + shift[2]]));
    }
    found
}

/// Processes sixteen at a time, with the same roundings.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f")]
fn select_avx512(points: Points, shift: [f32; 3], near: Near, numbers: &mut [u32]) -> usize {
    use std::arch::x86_64::*;
    let Points { along, count } = points;
    let length = along[0].len();
    let is_whole = length.is_multiple_of(WIDTH) && along.iter().all(|along| along.len() == length);
    assert!(is_whole && count <= length && numbers.len() >= length + WIDTH);
    let ahead = _mm512_set1_epi32(WIDTH as i32);
    let mut number = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    let mut found = 0;
    for k in (0..count).step_by(WIDTH) {
        let mut at = [_mm512_setzero_ps(); 3];
        for a in 0..3 {
            // SAFETY: the slices hold whole vectors.
            let spot = unsafe { _mm512_loadu_ps(along[a].as_ptr().add(k)) };
            at[a] = _mm512_add_ps(spot, _mm512_set1_ps(shift[a]));
        }
        let kept = near.has_of_sixteen(at) & inside(count - k);
        // SAFETY: there are at most as many found numbers as points so far, and room for one more
        // vector.
        unsafe {
            let place = numbers.as_mut_ptr().add(found);
            _mm512_storeu_epi32(place.cast(), _mm512_maskz_compress_epi32(kept, number));
        }
        found += kept.count_ones() as usize;
        number = _mm512_add_epi32(number, ahead);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn candidates_match_brute_force() {
        let number = |i: usize| (i as f64 * 0.754877666).fract();
        for count in [1, 30, BLOCK] {
            let point = |i: usize| [4.0 * number(i), 3.0 * number(7 * i + 3), number(13 * i + 5)];
            let points: Vec<[f64; 3]> = (0..count).map(point).collect();
            let bounds = Bounds { low: [-0.5, -0.25, 0.0], high: [0.5, 0.75, 0.5] };
            let (centre, reach) = (bounds.centre(), 1.2);
            for signs in [[1.0, 1.0, 1.0], [-1.0, 1.0, -1.0]] {
                let image = |p: &[f64; 3]| [0, 1, 2].map(|a| signs[a] * p[a]);
                let spots = RelativePoints::of(&points);
                let shift = [0, 1, 2].map(|a| (signs[a] * spots.origin[a] - centre[a]) as f32);
                let (signs, near) = (signs.map(|s| s as f32), Near::to(&bounds, reach));
                let mut taken = Candidates::default();
                taken.take(spots.points(), signs, shift, near);
                let gap = |x: f64, a: usize| (bounds.low[a] - x).max(x - bounds.high[a]).max(0.0);
                let is_near = |p: &[f64; 3]| {
                    let at = image(p);
                    (0..3).map(|a| gap(at[a], a).powi(2)).sum::<f64>() < reach * reach
                };
                let expected: Vec<u32> =
                    (0..count).filter(|&i| is_near(&points[i])).map(|i| i as u32).collect();
                assert_eq!(taken.last_numbers(), expected);
                for (n, &i) in expected.iter().enumerate() {
                    let at = image(&points[i as usize]);
                    for a in 0..3 {
                        let apart = f64::from(taken.all().1.along[a][n]) - (at[a] - centre[a]);
                        assert!(apart.abs() < 1e-6);
                    }
                }
                let (mut numbers, mut places) = (vec![0; 200], [(); 3].map(|_| vec![0.0; 200]));
                let mut slices = places.each_mut().map(|places| &mut places[..]);
                let spots = spots.points();
                let found = compress_each(spots, signs, shift, near, &mut numbers, &mut slices);
                assert_eq!(taken.last_numbers(), &numbers[..found]);
                let (_, Points { along, count }) = taken.all();
                assert!((0..3).all(|a| along[a][..found] == places[a][..found]));
                assert!(along[0].len() % WIDTH == 0 && count == found);
            }
        }
    }

    #[test]
    fn narrowed_candidates_match_brute_force() {
        let number = |i: usize| (i as f64 * 0.754877666).fract();
        let points: Vec<_> =
            (0..BLOCK).map(|i| [number(i), number(7 * i + 3), number(13 * i + 5)]).collect();
        let (spots, mut all) = (RelativePoints::of(&points), Candidates::default());
        let whole = Near { half: [5.0; 3], reach_squared: 1.0 };
        all.take(spots.points(), [1.0; 3], [0.0; 3], whole);
        let near = Near { half: [0.1, 0.2, 0.0], reach_squared: 0.09 };
        let shift = [0.3, -0.2, 0.1];
        let mut numbers = Numbers::default();
        all.narrow(shift, near, &mut numbers);
        let is_near = |p: &[f64; 3]| {
            let at = [0, 1, 2].map(|a| (p[a] - spots.origin[a]) as f32 + shift[a]);
            let gap = |a: usize| (at[a].abs() - near.half[a]).max(0.0);
            (0..3).map(|a| gap(a) * gap(a)).sum::<f32>() < near.reach_squared
        };
        let expected: Vec<u32> =
            (0..BLOCK).filter(|&i| is_near(&points[i])).map(|i| i as u32).collect();
        assert!(!expected.is_empty() && expected.len() < BLOCK / 2);
        assert_eq!(numbers.list(), expected);
        let mut plain = vec![0; 2 * BLOCK];
        let found = select_each(all.all().1, shift, near, &mut plain);
        assert_eq!(numbers.list(), &plain[..found]);
    }

    /// Padding behind the points stands at the largest number, which a shift of equal size moves
    /// close to the box.
    #[test]
    fn padding_is_never_near() {
        for count in [1, 15, 17, BLOCK - 1] {
            let spots = RelativePoints::of(&vec![[0.0; 3]; count]);
            let near = Near { half: [1.0; 3], reach_squared: f32::INFINITY };
            let mut all = Candidates::default();
            all.take(spots.points(), [1.0; 3], [-f32::MAX; 3], near);
            assert!(all.last_numbers().iter().all(|&k| (k as usize) < count));
            let mut slices = [(); 3].map(|_| vec![0.0; 2 * BLOCK]);
            let (mut numbers, shift) = (vec![0; 2 * BLOCK], [-f32::MAX; 3]);
            let mut along = slices.each_mut().map(|places| &mut places[..]);
            let found =
                compress_each(spots.points(), [1.0; 3], shift, near, &mut numbers, &mut along);
            assert_eq!(all.last_numbers(), &numbers[..found]);
            let mut narrowed = Numbers::default();
            all.narrow([-f32::MAX; 3], near, &mut narrowed);
            assert!(narrowed.list().iter().all(|&k| (k as usize) < all.count));
            let found = select_each(all.all().1, shift, near, &mut numbers);
            assert_eq!(narrowed.list(), &numbers[..found]);
        }
    }
}
