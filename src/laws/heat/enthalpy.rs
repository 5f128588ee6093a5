//! Enthalpy as a function of temperature, and its inverse.

use super::conduction::Conduction;
use super::melting::Melting;

/// Volumetric enthalpy as an exact function of temperature, and its inverse: quadratic pieces, and jumps at isothermal
/// melting.
///
/// `H(T) = ∫ ρ c dT + ρ L f(T)` [J/m³] from a reference temperature, with f linear between solidus and liquidus (V. R.
/// Voller and C. R. Swaminathan 1991, doi 10.1080/10407799108944962). At the temperature of isothermal melting the
/// enthalpy is that of the solid.
#[derive(Debug, Clone, PartialEq)]
pub struct Enthalpy {
    /// The first piece extends down, the last one up, without limit.
    pieces: Vec<Piece>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Piece {
    /// Temperature above the reference [K] and enthalpy [J/m³] at the start of the piece; the first piece has those of
    /// its end.
    rise: f64,
    content: f64,
    /// `dH/dT` there [J/(m³ K)]; infinite for a jump.
    capacity: f64,
    /// `d²H/dT²` [J/(m³ K²)]
    slope: f64,
    /// Derivative of the latent part of the enthalpy by temperature [J/(m³ K)].
    latent_rate: f64,
    /// Part of the volume that is liquid there, and its derivative by temperature [1/K], or by enthalpy [m³/J] in a jump.
    liquid: f64,
    liquid_rate: f64,
}

/// State at an enthalpy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnthalpyPoint {
    /// Temperature above the reference [K].
    pub rise: f64,
    /// `dT/dH` [m³ K/J]: zero during isothermal melting.
    pub inverse_capacity: f64,
    /// `ρ c` without latent heat [J/(m³ K)].
    pub sensible: f64,
    /// Part of the volume that is liquid, of materials that melt.
    pub liquid: f64,
}

impl Enthalpy {
    /// Enthalpy of materials side by side at one temperature, with the volume fraction of each.
    pub fn of_mixture(parts: &[(f64, &Conduction)], reference: f64) -> Self {
        let knots = knots(parts, reference);
        let sensible = |t: f64| -> f64 {
            parts.iter().map(|(part, s)| part * s.density * s.specific_heat.value(t)).sum()
        };
        let capacities: Vec<f64> = knots.iter().map(|rise| sensible(reference + rise)).collect();
        let below = Piece {
            rise: knots[0],
            content: 0.0,
            capacity: capacities[0],
            slope: 0.0,
            latent_rate: 0.0,
            liquid: 0.0,
            liquid_rate: 0.0,
        };
        let mut pieces = vec![below];
        let (mut content, mut liquid, mut base) = (0.0, 0.0, 0.0);
        for (i, &rise) in knots.iter().enumerate() {
            if rise == 0.0 {
                base = content;
            }
            let jump = Melts::at(parts, rise, reference);
            if jump.latent > 0.0 {
                let liquid_rate = jump.part / jump.latent;
                let (capacity, slope) = (f64::INFINITY, capacities[i]);
                let latent_rate = 0.0;
                pieces.push(Piece {
                    rise,
                    content,
                    capacity,
                    slope,
                    latent_rate,
                    liquid,
                    liquid_rate,
                });
                content += jump.latent;
                liquid += jump.part;
            }
            let (width, change) = match knots.get(i + 1) {
                Some(next) => (next - rise, capacities[i + 1] - capacities[i]),
                None => (1.0, 0.0),
            };
            let Melts { latent: latent_rate, part: liquid_rate } =
                Melts::around(parts, reference + rise + 0.5 * width);
            let capacity = capacities[i] + latent_rate;
            let slope = change / width;
            pieces.push(Piece { rise, content, capacity, slope, latent_rate, liquid, liquid_rate });
            content += width * (capacity + 0.5 * change);
            liquid += width * liquid_rate;
        }
        pieces.iter_mut().for_each(|piece| piece.content -= base);
        Self { pieces }
    }

    /// Enthalpy [J/m³] at a temperature above the reference [K].
    pub fn content(&self, rise: f64) -> f64 {
        // A jump begins at the end of the previous piece, which is the solid's enthalpy.
        let piece = self.pieces[1..].iter().rfind(|piece| piece.rise < rise);
        let piece = piece.unwrap_or(&self.pieces[0]);
        let along = rise - piece.rise;
        piece.content + along * (piece.capacity + 0.5 * piece.slope * along)
    }

    /// Returns the state at an enthalpy [J/m³].
    pub fn at(&self, content: f64) -> EnthalpyPoint {
        let number = self.pieces[1..].partition_point(|piece| piece.content <= content);
        let piece = &self.pieces[number];
        let above = content - piece.content;
        if piece.capacity.is_infinite() {
            let (rise, liquid) = (piece.rise, piece.liquid + piece.liquid_rate * above);
            return EnthalpyPoint { rise, inverse_capacity: 0.0, sensible: piece.slope, liquid };
        }
        let capacity = (piece.capacity * piece.capacity + 2.0 * piece.slope * above).sqrt();
        let along = 2.0 * above / (piece.capacity + capacity);
        EnthalpyPoint {
            rise: piece.rise + along,
            inverse_capacity: 1.0 / capacity,
            sensible: capacity - piece.latent_rate,
            liquid: piece.liquid + piece.liquid_rate * along,
        }
    }

    /// Part of the volume that can melt.
    pub fn melting_part(&self) -> f64 {
        self.pieces.last().map_or(0.0, |piece| piece.liquid)
    }
}

/// Temperatures above the reference at which pieces begin. The reference is one of them, so that small differences to
/// it keep all digits.
fn knots(parts: &[(f64, &Conduction)], reference: f64) -> Vec<f64> {
    let mut knots = vec![0.0];
    for (_, substance) in parts {
        knots.extend(substance.specific_heat.knots().iter().map(|t| t - reference));
        if let Some(melting) = substance.melting {
            knots.extend([melting.solidus - reference, melting.liquidus - reference]);
        }
    }
    knots.sort_by(f64::total_cmp);
    knots.dedup();
    knots
}

/// Melting at one temperature, or by temperature around it.
#[derive(Debug, Clone, Copy, Default)]
struct Melts {
    /// Latent heat [J/m³ or J/(m³ K)].
    latent: f64,
    /// Part of the volume [1 or 1/K].
    part: f64,
}

impl Melts {
    /// Isothermal melting at a temperature above the reference.
    fn at(parts: &[(f64, &Conduction)], rise: f64, reference: f64) -> Self {
        let own = |melting: &Melting| {
            let melts = melting.is_isothermal() && melting.solidus - reference == rise;
            if melts { 1.0 } else { 0.0 }
        };
        Self::sum(parts, own)
    }

    /// Melting over a range around a temperature, by kelvin.
    fn around(parts: &[(f64, &Conduction)], temperature: f64) -> Self {
        let own = |melting: &Melting| match melting.is_isothermal() {
            false if melting.solidus < temperature && temperature < melting.liquidus => {
                1.0 / (melting.liquidus - melting.solidus)
            }
            _ => 0.0,
        };
        Self::sum(parts, own)
    }

    /// Sum over materials, of which a part melts.
    fn sum(parts: &[(f64, &Conduction)], own: impl Fn(&Melting) -> f64) -> Self {
        let mut sum = Self::default();
        for (volume, substance) in parts {
            let Some(melting) = substance.melting else { continue };
            let part = volume * own(&melting);
            sum.part += part;
            sum.latent += part * substance.density * melting.latent_heat;
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::{Property, Table};

    /// [J/m³]
    const LATENT: f64 = 7800.0 * 2.6e5;

    fn alloy(solidus: f64, liquidus: f64) -> Conduction {
        let temperature = vec![300.0, 700.0, 900.0, 1500.0];
        let value = vec![450.0, 600.0, 900.0, 800.0];
        Conduction {
            density: 7800.0,
            specific_heat: Property::Table(Table { temperature, value }),
            conductivity: 30.0.into(),
            melting: Some(Melting { solidus, liquidus, latent_heat: 2.6e5 }),
        }
    }

    #[test]
    fn enthalpy_is_the_integral_of_its_parts() {
        for (solidus, liquidus) in [(800.0, 1000.0), (900.0, 900.0), (250.0, 2000.0)] {
            let substance = alloy(solidus, liquidus);
            for reference in [293.15, 900.0, 1234.5] {
                let law = substance.enthalpy(reference);
                for t in [20.0, 299.0, 650.0, 850.0, 899.0, 901.0, 1000.0, 3000.0] {
                    let fraction = |t: f64| match t > liquidus {
                        true => 1.0,
                        false => ((t - solidus) / (liquidus - solidus)).clamp(0.0, 1.0),
                    };
                    let from = if reference > liquidus { 1.0 } else { 0.0 };
                    let from = if liquidus > solidus { fraction(reference) } else { from };
                    let wanted = 7800.0
                        * (substance.specific_heat.integral(reference, t)
                            + 2.6e5 * (fraction(t) - from));
                    let content = law.content(t - reference);
                    assert!((content - wanted).abs() < 1e-13 * 1e10, "{content} {wanted}");
                    let point = law.at(content);
                    assert!((point.rise - (t - reference)).abs() < 1e-10, "{t} {point:?}");
                    assert!((point.liquid - fraction(t)).abs() < 1e-12);
                    let sensible = 7800.0 * substance.specific_heat.value(t);
                    assert!((point.sensible / sensible - 1.0).abs() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn inverse_slope_matches_differences() {
        let law = alloy(800.0, 1000.0).enthalpy(500.0);
        for content in [-3e8, 1e8, 9e8, 1.6e9, 2.9e9, 5e9] {
            let (low, high) = (law.at(content - 1e3), law.at(content + 1e3));
            let slope = (high.rise - low.rise) / 2e3;
            assert!((slope / law.at(content).inverse_capacity - 1.0).abs() < 1e-6, "{content}");
        }
    }

    #[test]
    fn temperature_stands_still_while_something_melts_at_one() {
        let law = alloy(900.0, 900.0).enthalpy(300.0);
        let solid = law.content(600.0);
        for part in [0.0, 0.3, 0.999] {
            let point = law.at(solid + part * LATENT);
            assert_eq!((point.rise, point.inverse_capacity), (600.0, 0.0));
            assert!((point.liquid - part).abs() < 1e-14);
        }
        let liquid = law.at(solid + LATENT * (1.0 + 1e-9));
        assert!(liquid.rise > 600.0 && liquid.inverse_capacity > 0.0);
        // A reference at the melting temperature is solid.
        assert_eq!(alloy(900.0, 900.0).enthalpy(900.0).at(0.0).liquid, 0.0);
    }

    #[test]
    fn narrow_melting_range_keeps_latent_heat() {
        for width in [0.0, 1e-13, 2e-13, 1e-12, 1e-10, 1e-8, 1e-6] {
            for solidus in [200.0, 900.0, 3000.0] {
                let law = alloy(solidus, solidus + width).enthalpy(293.15);
                let [below, above] = [-1.0, 1.0].map(|off| law.content(solidus + off - 293.15));
                let sensible =
                    7800.0 * alloy(0.0, 0.0).specific_heat.integral(solidus - 1.0, solidus + 1.0);
                let found = (above - below - sensible) / LATENT;
                assert!((found - 1.0).abs() < 1e-6, "{solidus} {width:e}: {found}");
            }
        }
    }

    #[test]
    fn mixture_enthalpy_is_the_sum_of_its_parts() {
        let (a, b) = (alloy(900.0, 900.0), alloy(700.0, 1100.0));
        let mixture = Enthalpy::of_mixture(&[(0.3, &a), (0.7, &b)], 400.0);
        let laws = [a.enthalpy(400.0), b.enthalpy(400.0)];
        for content in [-1e8, 1e9, 2.2e9, 3.4e9, 6e9] {
            let point = mixture.at(content);
            let jumps = point.inverse_capacity == 0.0;
            let sum = 0.3 * laws[0].content(point.rise) + 0.7 * laws[1].content(point.rise);
            let excess = content - sum;
            let most = if jumps { 0.3 * LATENT } else { 0.0 };
            assert!(excess > -1e-3 && excess < most + 1e-3, "{content} {excess}");
            // Each is liquid by its own volume, not by its latent heat.
            let ranged = ((400.0 + point.rise - 700.0) / 400.0).clamp(0.0, 1.0);
            let rest = point.liquid - 0.7 * ranged;
            let own = if point.rise > 500.0 { 0.3 } else { 0.0 };
            let own = if jumps { excess / LATENT } else { own };
            assert!((rest - own).abs() < 1e-9, "{content} {rest} {own}");
        }
    }

    #[test]
    fn only_melting_parts_of_a_mixture_become_liquid() {
        for (solidus, liquidus) in [(900.0, 900.0), (800.0, 1000.0)] {
            let melting = alloy(solidus, liquidus);
            let solid = Conduction { melting: None, ..melting.clone() };
            let law = Enthalpy::of_mixture(&[(0.02, &melting), (0.98, &solid)], 300.0);
            assert_eq!(law.at(law.content(450.0)).liquid, 0.0);
            let liquid = law.at(law.content(900.0)).liquid;
            assert!((liquid - 0.02).abs() < 1e-15, "{liquid}");
        }
    }
}
