//! The constants of a homogeneous, isotropic body in the closed forms.

/// A body that conducts heat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conductor {
    /// Thermal conductivity k [W/(m K)].
    pub conductivity: f64,
    /// Volumetric heat capacity ρc [J/(m³ K)].
    pub heat_capacity: f64,
}

impl Conductor {
    /// Thermal diffusivity `a = k / ρc` [m²/s].
    pub fn diffusivity(&self) -> f64 {
        self.conductivity / self.heat_capacity
    }

    /// Thermal effusivity `e = √(k ρc)` [J/(m² K √s)].
    pub fn effusivity(&self) -> f64 {
        (self.conductivity * self.heat_capacity).sqrt()
    }

    /// Diffusion length `s = 2 √(a t)` [m].
    pub fn diffusion_length(&self, t: f64) -> f64 {
        2.0 * (self.diffusivity() * t).sqrt()
    }
}

/// A linear elastic body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elastic {
    /// Young's modulus E [Pa].
    pub young: f64,
    /// Poisson's ratio ν [1].
    pub poisson: f64,
}

impl Elastic {
    /// Shear modulus `G = E / 2(1 + ν)` [Pa].
    pub fn shear_modulus(&self) -> f64 {
        self.young / (2.0 * (1.0 + self.poisson))
    }

    /// Biaxial modulus `E / (1 − ν)` [Pa].
    pub fn biaxial_modulus(&self) -> f64 {
        self.young / (1.0 - self.poisson)
    }

    /// Flexural rigidity of a plate `D = E h³ / 12(1 − ν²)` [N m].
    pub fn plate_rigidity(&self, thickness: f64) -> f64 {
        self.young * thickness.powi(3) / (12.0 * (1.0 - self.poisson * self.poisson))
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{ALUMINA, ALUMINA_ELASTIC, assert_close};

    #[test]
    fn effusivity_and_diffusivity_give_back_conductivity() {
        let product = ALUMINA.effusivity() * ALUMINA.diffusivity().sqrt();
        assert_close(product, ALUMINA.conductivity, 1e-14);
    }

    #[test]
    fn diffusion_length_of_alumina_at_3_5_us() {
        assert_close(ALUMINA.diffusion_length(3.5e-6), 6.3e-6, 0.01);
    }

    #[test]
    fn plate_rigidity_is_the_biaxial_modulus_reduced() {
        let (body, h) = (ALUMINA_ELASTIC, 0.26e-3_f64);
        let expected = body.biaxial_modulus() * h.powi(3) / (12.0 * (1.0 + body.poisson));
        assert_close(body.plate_rigidity(h), expected, 1e-14);
    }
}
