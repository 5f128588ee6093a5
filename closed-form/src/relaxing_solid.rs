//! Standard linear solid: a shear modulus that relaxes by one Maxwell branch, and an elastic bulk modulus, in a bar, a
//! film and under shear.
//!
//! By the correspondence principle a modulus of elasticity holds in Laplace space with `s Ḡ(s) = (G_∞ + G₀ sτ)/(1 +
//! sτ)`. That of a bar, `9KG/(3K + G)`, and that of a film, `18KG/(3K + 4G) = E/(1 − ν)`, are then of the same form as
//! Ḡ, with relaxation times of their own.
//!
//! Source: R. M. Christensen, *Theory of Viscoelasticity*, 2nd ed., Academic Press 1982, §§1.2, 1.7 and 2.2.

/// A modulus that relaxes with one time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Relaxing {
    /// Modulus at first, M₀, and in the end, M_∞ [Pa].
    pub instantaneous: f64,
    pub lasting: f64,
    /// Relaxation time [s].
    pub time: f64,
}

impl Relaxing {
    /// Stress over strain at a time [s] after a sudden strain [Pa].
    pub fn modulus(&self, time: f64) -> f64 {
        let Self { instantaneous, lasting, time: own } = *self;
        lasting + (instantaneous - lasting) * (-time / own).exp()
    }

    /// Stress over the rate of strain at a time [s] after the strain began to grow [Pa s].
    pub fn after_ramp(&self, time: f64) -> f64 {
        let Self { instantaneous, lasting, time: own } = *self;
        lasting * time - (instantaneous - lasting) * own * (-time / own).exp_m1()
    }

    /// Strain over stress at a time [s] after a sudden stress [1/Pa]: the retardation time is `τ M₀/M_∞`, longer than
    /// the relaxation time. Without a lasting modulus strain grows without bound.
    pub fn compliance(&self, time: f64) -> f64 {
        let Self { instantaneous, lasting, time: own } = *self;
        if lasting == 0.0 {
            return (1.0 + time / own) / instantaneous;
        }
        let retardation = own * instantaneous / lasting;
        1.0 / lasting + (1.0 / instantaneous - 1.0 / lasting) * (-time / retardation).exp()
    }
}

/// The solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RelaxingSolid {
    /// Bulk modulus K [Pa].
    pub bulk: f64,
    /// Instantaneous shear modulus G₀ [Pa].
    pub shear: f64,
    /// Fraction of it that relaxes [1].
    pub fraction: f64,
    /// Relaxation time τ of shear [s].
    pub time: f64,
}

impl RelaxingSolid {
    /// Creates the solid from its instantaneous Young's modulus [Pa] and Poisson's ratio.
    pub fn of(young: f64, poisson: f64, fraction: f64, time: f64) -> Self {
        let bulk = young / (3.0 * (1.0 - 2.0 * poisson));
        Self { bulk, shear: young / (2.0 * (1.0 + poisson)), fraction, time }
    }

    /// Modulus of shear.
    pub fn in_shear(&self) -> Relaxing {
        let Self { shear, fraction, time, .. } = *self;
        Relaxing { instantaneous: shear, lasting: (1.0 - fraction) * shear, time }
    }

    /// Modulus of a bar.
    pub fn bar(&self) -> Relaxing {
        self.of_form([9.0, 3.0, 1.0])
    }

    /// Modulus of a film that is strained equally in both directions.
    pub fn film(&self) -> Relaxing {
        self.of_form([18.0, 3.0, 4.0])
    }

    /// The modulus `a K G/(b K + c G)`.
    fn of_form(&self, [a, b, c]: [f64; 3]) -> Relaxing {
        let Relaxing { instantaneous, lasting, time } = self.in_shear();
        let below = |shear: f64| b * self.bulk + c * shear;
        let modulus = |shear: f64| a * self.bulk * shear / below(shear);
        Relaxing {
            instantaneous: modulus(instantaneous),
            lasting: modulus(lasting),
            time: time * below(instantaneous) / below(lasting),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SOLID: RelaxingSolid = RelaxingSolid {
        bulk: 4.166_666_666_666_667e5,
        shear: 1.923_076_923_076_923e5,
        fraction: 0.8,
        time: 1.0,
    };

    /// Creep of a bar of E₀ 5e5 Pa and ν 0.3 whose shear modulus falls to a fifth: D₀ 2e-6, retardation time 5 s, and
    /// D_∞ = J_∞/3 + 1/(9K).
    #[test]
    fn creep_of_a_bar_is_that_of_shear_and_elastic_bulk() {
        let bar = SOLID.bar();
        for time in [0.0, 1.0, 5.0, 20.0] {
            let shear = SOLID.in_shear().compliance(time);
            let sum = shear / 3.0 + 1.0 / (9.0 * SOLID.bulk);
            assert!((bar.compliance(time) / sum - 1.0).abs() < 1e-12, "{time}");
        }
        assert!((bar.compliance(0.0) * 5e5 - 1.0).abs() < 1e-12);
    }

    /// Stress history and strain history are inverse: `∫ M(t − s) dD(s) = 1`.
    #[test]
    fn compliance_is_the_inverse_of_the_modulus() {
        for own in [SOLID.in_shear(), SOLID.bar(), SOLID.film()] {
            let (end, n) = (2.0 * own.time, 4000);
            let h = end / n as f64;
            let mut sum = own.modulus(end) * own.compliance(0.0);
            for k in 0..n {
                let [a, b] = [k, k + 1].map(|k| own.compliance(k as f64 * h));
                sum += own.modulus(end - (k as f64 + 0.5) * h) * (b - a);
            }
            assert!((sum - 1.0).abs() < 1e-6, "{sum}");
        }
    }

    #[test]
    fn a_ramp_is_the_sum_of_sudden_strains() {
        let own = SOLID.film();
        let (end, n) = (3.0, 3000);
        let h = end / f64::from(n);
        let sum: f64 = (0..n).map(|k| own.modulus((f64::from(k) + 0.5) * h) * h).sum();
        assert!((own.after_ramp(end) / sum - 1.0).abs() < 1e-6);
    }
}
