//! Damage function η(λ) of the KCC law: from the surface of yielding (0) to that of strength (1) and on to the residual
//! one (0).

/// η over λ, linear between points.
#[derive(Debug, Clone, PartialEq)]
pub struct DamageFunction {
    points: Vec<[f64; 2]>,
    /// λ_m, where η is 1.
    pub peak: f64,
}

impl DamageFunction {
    /// `None` unless λ rises from 0, and η from 0 to 1 and falls to 0.
    pub fn new(points: &[[f64; 2]]) -> Option<Self> {
        let place = points.iter().position(|point| point[1] == 1.0)?;
        let (rising, falling) = (&points[..=place], &points[place..]);
        let ends = [points[0], points[points.len() - 1]];
        let proper = ends[0] == [0.0, 0.0]
            && ends[1][1] == 0.0
            && points.windows(2).all(|pair| pair[0][0] < pair[1][0])
            && rising.windows(2).all(|pair| pair[0][1] < pair[1][1])
            && falling.windows(2).all(|pair| pair[0][1] > pair[1][1]);
        proper.then(|| Self { points: points.to_vec(), peak: points[place][0] })
    }

    /// η.
    pub fn value(&self, lambda: f64) -> f64 {
        let segment = self.points.windows(2).find(|pair| lambda < pair[1][0]);
        segment.map_or(0.0, |pair| {
            let part = (lambda - pair[0][0]) / (pair[1][0] - pair[0][0]);
            pair[0][1] + part * (pair[1][1] - pair[0][1])
        })
    }

    /// Change of η on the way from the start to λ: η up to the peak, 2 − η beyond it.
    pub fn passed(&self, lambda: f64) -> f64 {
        let value = self.value(lambda);
        if lambda <= self.peak { value } else { 2.0 - value }
    }

    /// Part of the strength beyond the residual one that is lost: 0 up to the peak, 1 in the end.
    pub fn damage(&self, lambda: f64) -> f64 {
        if lambda <= self.peak { 0.0 } else { 1.0 - self.value(lambda) }
    }

    /// `∫ f(η) dλ` beyond the peak, by Simpson's rule on parts of each segment.
    pub fn integral(&self, f: impl Fn(f64) -> f64) -> f64 {
        let falling = self.points.windows(2).filter(|pair| pair[0][0] >= self.peak);
        let of_segment = |pair: &[[f64; 2]]| {
            let ([from, start], [to, end]) = (pair[0], pair[1]);
            let width = 1.0 / PARTS as f64;
            let at = |part: f64| f(start + part * (end - start));
            let simpson = |n: usize| {
                let left = n as f64 * width;
                at(left) + 4.0 * at(left + 0.5 * width) + at(left + width)
            };
            (to - from) * width / 6.0 * (0..PARTS).map(simpson).sum::<f64>()
        };
        falling.map(of_segment).sum()
    }

    /// Largest fall of η per λ on each segment beyond the peak, with η at its ends.
    pub fn falls(&self) -> impl Iterator<Item = (f64, [f64; 2])> + '_ {
        let falling = self.points.windows(2).filter(|pair| pair[0][0] >= self.peak);
        falling.map(|pair| {
            let ([from, start], [to, end]) = (pair[0], pair[1]);
            ((start - end) / (to - from), [start, end])
        })
    }
}

const PARTS: usize = 16;
