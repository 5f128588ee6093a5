//! Thick cylinder of elastic–perfectly plastic, incompressible material under internal pressure, in plane strain: its
//! inner part yields, up to a radius that grows with the pressure.
//!
//! Source: R. Hill, *The Mathematical Theory of Plasticity*, Oxford 1950, §V.2; with the yield criterion of von Mises,
//! whose shear stress is `k = σ_y/√3`.

/// Cylinder `a ≤ r ≤ b`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct YieldingCylinder {
    /// Shear modulus G [Pa].
    pub shear: f64,
    /// Yield stress σ_y [Pa].
    pub yield_stress: f64,
    /// Inner radius a [m].
    pub inner: f64,
    /// Outer radius b [m].
    pub outer: f64,
    /// Radius c of the plastic front [m].
    pub front: f64,
}

impl YieldingCylinder {
    /// Shear stress at yield `k = σ_y/√3` [Pa].
    fn shear_yield(&self) -> f64 {
        self.yield_stress / 3f64.sqrt()
    }

    /// Internal pressure [Pa] `p = k (1 − c²/b² + 2 ln(c/a))`.
    pub fn pressure(&self) -> f64 {
        -self.radial_stress(self.inner)
    }

    /// Limit pressure [Pa] `2k ln(b/a)`.
    pub fn limit_pressure(&self) -> f64 {
        2.0 * self.shear_yield() * (self.outer / self.inner).ln()
    }

    /// Radial stress [Pa] `−k (1 − c²/b² + 2 ln(c/r))` in the plastic part, `−k c² (1/r² − 1/b²)` beyond.
    pub fn radial_stress(&self, r: f64) -> f64 {
        let (k, c, b) = (self.shear_yield(), self.front, self.outer);
        match r < c {
            true => -k * (1.0 - (c / b).powi(2) + 2.0 * (c / r).ln()),
            false => -k * ((c / r).powi(2) - (c / b).powi(2)),
        }
    }

    /// Hoop stress [Pa] `σ_rr + 2k min(1, c²/r²)`.
    pub fn hoop_stress(&self, r: f64) -> f64 {
        self.radial_stress(r) + 2.0 * self.shear_yield() * (self.front / r).powi(2).min(1.0)
    }

    /// Axial stress [Pa], the mean of the others.
    pub fn axial_stress(&self, r: f64) -> f64 {
        0.5 * (self.radial_stress(r) + self.hoop_stress(r))
    }

    /// Radial displacement [m] `k c²/(2 G r)`.
    pub fn radial_displacement(&self, r: f64) -> f64 {
        self.shear_yield() * self.front.powi(2) / (2.0 * self.shear * r)
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{assert_close, assert_within, derivative};
    use super::*;

    const CYLINDER: YieldingCylinder =
        YieldingCylinder { shear: 80e9, yield_stress: 250e6, inner: 0.1, outer: 0.2, front: 0.15 };

    #[test]
    fn stress_is_in_equilibrium_and_continuous() {
        for r in [0.11, 0.13, 0.16, 0.19] {
            let slope = derivative(|r| CYLINDER.radial_stress(r), r, 1e-4);
            let force = CYLINDER.hoop_stress(r) - CYLINDER.radial_stress(r);
            assert_close(slope, force / r, 1e-8);
        }
        for f in [YieldingCylinder::radial_stress, YieldingCylinder::hoop_stress] {
            assert_close(f(&CYLINDER, 0.15 - 1e-12), f(&CYLINDER, 0.15 + 1e-12), 1e-9);
        }
        assert_within(CYLINDER.radial_stress(0.2), 0.0, 1e-6);
    }

    #[test]
    fn elastic_part_follows_the_displacement_and_plastic_part_is_at_yield() {
        let r = 0.17;
        let stretch = derivative(|r| CYLINDER.radial_displacement(r), r, 1e-4);
        let hoop = CYLINDER.radial_displacement(r) / r;
        let shear = 2.0 * CYLINDER.shear * (hoop - stretch);
        assert_close(CYLINDER.hoop_stress(r) - CYLINDER.radial_stress(r), shear, 1e-8);
        let difference = CYLINDER.hoop_stress(0.12) - CYLINDER.radial_stress(0.12);
        assert_close(difference * 0.75f64.sqrt(), 250e6, 1e-13);
        assert_close(
            YieldingCylinder { front: 0.2, ..CYLINDER }.pressure(),
            CYLINDER.limit_pressure(),
            1e-13,
        );
    }
}
