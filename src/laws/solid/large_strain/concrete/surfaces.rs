//! Strength surfaces of the KCC law over the pressure, which is positive in compression.
//!
//! `Δσ_m = a₀ + p/(a₁ + a₂ p)` is the strength in triaxial compression from the pressure `f_c/3` of uniaxial
//! compression on, `Δσ_m = ³⁄₂ (p + f_t)/ψ(p)` below it, with the ratio ψ of strengths in triaxial extension and
//! compression, ½ for p ≤ 0: in tension the largest principal stress is then f_t. The body yields at Δσ_y, of the same
//! form from the pressure p_y at which uniaxial compression yields; in tension it yields at the same part of the
//! strength, and in between linearly. What remains is `Δσ_r = p/(a₁f + a₂f p)`, nothing in tension.
//!
//! Sources: L. J. Malvar, J. E. Crawford, J. W. Wesevich & D. Simons (1997), Int. J. Impact Eng. 19, 847–873, doi
//! 10.1016/S0734-743X(97)00023-7; K. J. Willam & E. P. Warnke (1975), IABSE Proceedings 19, for sections across the
//! axis.

/// The three surfaces.
#[derive(Debug, Clone, PartialEq)]
pub struct Surfaces {
    /// a₀ [Pa], a₁ [1], a₂ [1/Pa] of Δσ_m.
    strength: [f64; 3],
    /// The same of Δσ_y.
    yielding: [f64; 3],
    /// a₁f [1], a₂f [1/Pa] of Δσ_r.
    residual: [f64; 2],
    /// f_t [Pa].
    pub tensile: f64,
    /// f_c, at which `Δσ_m(f_c/3) = f_c` [Pa].
    pub compressive: f64,
    /// p_y, at which `Δσ_y(p_y) = 3 p_y` [Pa].
    onset: f64,
    /// ψ over the pressure [Pa], linear between its points.
    ratios: Vec<[f64; 2]>,
}

impl Surfaces {
    /// Creates the surfaces of coefficients and of f_t; `biaxial` is the strength in equal biaxial compression over
    /// f_c, and `meridians` has ψ at pressures over f_c. `None` unless uniaxial compression has a strength, and yields
    /// below it.
    pub fn new(
        [strength, yielding]: [[f64; 3]; 2],
        residual: [f64; 2],
        tensile: f64,
        biaxial: f64,
        meridians: &[[f64; 2]],
    ) -> Option<Self> {
        let compressive = 3.0 * uniaxial(strength)?;
        let onset = uniaxial(yielding)?;
        let at_biaxial = 2.0 * biaxial * compressive / 3.0;
        let mut ratios = vec![
            [0.0, HALF],
            [compressive / 3.0, HALF + 1.5 * tensile / compressive],
            [at_biaxial, biaxial * compressive / hyperbola(strength, at_biaxial)],
        ];
        ratios.extend(meridians.iter().map(|[p, ratio]| [p * compressive, *ratio]));
        let ascend = ratios.windows(2).all(|pair| pair[0][0] < pair[1][0]);
        // Sections are convex for these ratios.
        let convex = ratios.iter().all(|[_, ratio]| (HALF..=1.0).contains(ratio));
        (ascend && convex && 3.0 * onset < compressive).then_some(Self {
            strength,
            yielding,
            residual,
            tensile,
            compressive,
            onset,
            ratios,
        })
    }

    /// ψ.
    pub fn ratio(&self, p: f64) -> f64 {
        let [first, .., last] = &self.ratios[..] else { return HALF };
        if p <= first[0] {
            return first[1];
        }
        let segment = self.ratios.windows(2).find(|pair| p <= pair[1][0]);
        segment.map_or(last[1], |pair| {
            let slope = (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]);
            pair[0][1] + slope * (p - pair[0][0])
        })
    }

    /// Δσ_m.
    pub fn strength(&self, p: f64) -> f64 {
        if p >= self.compressive / 3.0 {
            hyperbola(self.strength, p)
        } else {
            1.5 * (p + self.tensile).max(0.0) / self.ratio(p)
        }
    }

    /// Δσ_y.
    pub fn yielding(&self, p: f64) -> f64 {
        let part = 3.0 * self.onset / self.compressive;
        let at_zero = 3.0 * part * self.tensile;
        if p >= self.onset {
            hyperbola(self.yielding, p)
        } else if p >= 0.0 {
            at_zero + (3.0 * self.onset - at_zero) / self.onset * p
        } else {
            part * self.strength(p)
        }
    }

    /// Δσ_r, nowhere above Δσ_m.
    pub fn residual(&self, p: f64) -> f64 {
        if p <= 0.0 {
            return 0.0;
        }
        let [linear, quadratic] = self.residual;
        hyperbola([0.0, linear, quadratic], p).min(self.strength(p))
    }

    /// Strength at a Lode angle over that in triaxial compression, at ψ: 1 at 60° and ψ at 0°, where one principal
    /// stress is above two equal ones. `cosine` is that of the angle.
    pub fn section(ratio: f64, cosine: f64) -> f64 {
        let (a, b) = (1.0 - ratio * ratio, 2.0 * ratio - 1.0);
        let square = 4.0 * a * cosine * cosine;
        let root = (square + 5.0 * ratio * ratio - 4.0 * ratio).max(0.0).sqrt();
        (2.0 * a * cosine + b * root) / (square + b * b)
    }
}

const HALF: f64 = 0.5;

/// `a₀ + p/(a₁ + a₂ p)`.
fn hyperbola([a0, a1, a2]: [f64; 3], p: f64) -> f64 {
    a0 + p / (a1 + a2 * p)
}

/// p at which a hyperbola is 3 p; `None` if there is none.
fn uniaxial([a0, a1, a2]: [f64; 3]) -> Option<f64> {
    // 3 a₂ p² + (3 a₁ − a₀ a₂ − 1) p − a₀ a₁ = 0.
    let (square, linear, constant) = (3.0 * a2, 3.0 * a1 - a0 * a2 - 1.0, -a0 * a1);
    let root = (linear * linear - 4.0 * square * constant).sqrt();
    let p = -2.0 * constant / (linear + root);
    (p > 0.0 && p.is_finite()).then_some(p)
}
