//! Slab of layers with different conductivities and heat capacities, with contact resistances, from rest at zero.
//!
//! With ω² the eigenvalues, modes are `C cos φ` in every layer, where φ grows by ω √(c/k) along it, and their flux is
//! `√(kc) ω C sin φ`. The flux, and the temperature less resistance times flux, are continuous at interfaces, which
//! changes φ within its multiple of π. The condition on the back is a transcendental equation that φ satisfies once in
//! every π (C. W. Tittle 1965, doi 10.1063/1.1714335; M. N. Özışık, *Heat Conduction*, 2nd ed., Wiley 1993, ch. 8).

use std::f64::consts::{FRAC_PI_2, PI};

use super::medium::Conductor;

/// Number of terms of series.
const TERMS: usize = 400;

/// A layer of the slab.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlabLayer {
    pub body: Conductor,
    /// Thickness [m].
    pub thickness: f64,
    /// Thermal resistance of the contact with the layer in front of it [m² K/W].
    pub contact_resistance: f64,
}

/// Boundary condition on the back.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Back {
    Insulated,
    /// Zero temperature.
    Held,
}

/// The slab, from its front, where depth is zero.
#[derive(Debug, Clone, PartialEq)]
pub struct CompositeSlab {
    pub layers: Vec<SlabLayer>,
    pub back: Back,
}

/// Boundary condition of the modes on the front.
#[derive(Clone, Copy, PartialEq)]
enum Front {
    Flux,
    Temperature,
}

/// A mode: phase at the beginning and amplitude in each layer.
struct Mode {
    omega: f64,
    parts: Vec<(f64, f64)>,
    /// `∫ c X² dx` [J/m²] for X in kelvins
    norm: f64,
}

/// A transient solution in the slab.
pub struct Transient<'a> {
    slab: &'a CompositeSlab,
    front: Front,
    value: f64,
    modes: Vec<Mode>,
}

impl Transient<'_> {
    /// Temperature rise [K] at depth `x` in a layer.
    pub fn rise(&self, (layer, x): (usize, f64), t: f64) -> f64 {
        let Self { slab, front, value, modes } = self;
        let settled = match front {
            Front::Flux => slab.settled_under_flux(layer, x, t),
            Front::Temperature => slab.settled_under_temperature(layer, x),
        };
        let decaying = modes.iter().map(|mode| {
            let share = (-mode.omega.powi(2) * t).exp() / (mode.norm * mode.omega.powi(2));
            slab.value(mode, layer, x) * self.drive(mode) * share
        });
        value * (settled - decaying.sum::<f64>())
    }

    /// Heat [J/m²] that has entered so far, for a prescribed temperature of the front.
    pub fn heat(&self, t: f64) -> f64 {
        let decaying = self.modes.iter().map(|mode| {
            let square = mode.omega.powi(2);
            self.drive(mode).powi(2) / (mode.norm * square * square) * (-square * t).exp()
        });
        let passed = match self.slab.back {
            Back::Insulated => 0.0,
            Back::Held => t / self.slab.resistance_before(usize::MAX, 0.0),
        };
        // By Parseval's theorem all modes together have ∫c θ² dx of the settled solution.
        self.value * (passed + self.slab.square_of_settled() - decaying.sum::<f64>())
    }

    /// Response of a mode to a unit value on the front: its value there, or its slope times conductivity.
    fn drive(&self, mode: &Mode) -> f64 {
        let (phase, amplitude) = mode.parts[0];
        match self.front {
            Front::Flux => amplitude * phase.cos(),
            Front::Temperature => {
                -self.slab.layers[0].body.effusivity() * mode.omega * amplitude * phase.sin()
            }
        }
    }
}

impl SlabLayer {
    /// `√(c/k) L` [√s]
    fn delay(&self) -> f64 {
        self.thickness / self.body.diffusivity().sqrt()
    }

    /// [J/(m² K)]
    fn capacity(&self) -> f64 {
        self.body.heat_capacity * self.thickness
    }

    /// Thermal resistance of the layer alone [m² K/W].
    fn resistance(&self) -> f64 {
        self.thickness / self.body.conductivity
    }
}

impl CompositeSlab {
    /// Transient under a constant `flux` [W/m²] into the front from time 0 on.
    pub fn under_flux(&self, flux: f64) -> Transient<'_> {
        Transient { slab: self, front: Front::Flux, value: flux, modes: self.modes(Front::Flux) }
    }

    /// Transient with the front at `rise` [K] from time 0 on.
    pub fn under_temperature(&self, rise: f64) -> Transient<'_> {
        let front = Front::Temperature;
        Transient { slab: self, front, value: rise, modes: self.modes(front) }
    }

    /// Thermal resistance between the front and depth `x` in a layer; of the whole slab for layers beyond [m² K/W].
    fn resistance_before(&self, layer: usize, x: f64) -> f64 {
        let before = self.layers.iter().take(layer).map(SlabLayer::resistance);
        let contacts = self.layers.iter().take(layer.saturating_add(1)).skip(1);
        let own = self.layers.get(layer).map_or(0.0, |layer| {
            let start: f64 = self.start_of(layer);
            (x - start) / layer.body.conductivity
        });
        before.sum::<f64>() + contacts.map(|layer| layer.contact_resistance).sum::<f64>() + own
    }

    fn start_of(&self, layer: &SlabLayer) -> f64 {
        let before = self.layers.iter().take_while(|other| !std::ptr::eq(*other, layer));
        before.map(|layer| layer.thickness).sum()
    }

    /// Settled solution for a front at one.
    fn settled_under_temperature(&self, layer: usize, x: f64) -> f64 {
        match self.back {
            Back::Insulated => 1.0,
            Back::Held => {
                1.0 - self.resistance_before(layer, x) / self.resistance_before(usize::MAX, 0.0)
            }
        }
    }

    /// `∫c θ² dx` of the settled solution [J/(m² K)], by Simpson's rule, which is exact.
    fn square_of_settled(&self) -> f64 {
        let of_layer = |(i, layer): (usize, &SlabLayer)| {
            let start = self.start_of(layer);
            let square = |share: f64| {
                self.settled_under_temperature(i, start + share * layer.thickness).powi(2)
            };
            layer.capacity() * (square(0.0) + 4.0 * square(0.5) + square(1.0)) / 6.0
        };
        self.layers.iter().enumerate().map(of_layer).sum()
    }

    /// Late-time solution under a unit flux: a steady rise, or one that grows linearly, with zero mean heat.
    fn settled_under_flux(&self, layer: usize, x: f64, t: f64) -> f64 {
        if self.back == Back::Held {
            return self.resistance_before(usize::MAX, 0.0) - self.resistance_before(layer, x);
        }
        let total: f64 = self.layers.iter().map(SlabLayer::capacity).sum();
        // The flux decreases by the heat that the previous layers absorb, starting from the temperature of the front.
        let mut content = 0.0;
        let (mut flux, mut value) = (1.0, 0.0);
        let mut wanted = 0.0;
        let mut start = 0.0;
        for (i, part) in self.layers.iter().enumerate() {
            if i > 0 {
                value -= part.contact_resistance * flux;
            }
            let fall = part.body.heat_capacity / total;
            let k = part.body.conductivity;
            let at = |s: f64| value - (flux * s - 0.5 * fall * s * s) / k;
            if i == layer {
                wanted = at(x - start);
            }
            let length = part.thickness;
            let mean =
                value * length - (flux * length.powi(2) / 2.0 - fall * length.powi(3) / 6.0) / k;
            content += part.body.heat_capacity * mean;
            value = at(length);
            flux -= fall * length;
            start += length;
        }
        t / total + wanted - content / total
    }

    /// Modes in the order of their eigenvalues, without the constant one.
    fn modes(&self, front: Front) -> Vec<Mode> {
        let delay: f64 = self.layers.iter().map(SlabLayer::delay).sum();
        let first = match (front, self.back) {
            (Front::Flux, Back::Insulated) => 1,
            _ => 0,
        };
        (first..first + TERMS).map(|n| self.mode(front, n, delay)).collect()
    }

    fn mode(&self, front: Front, n: usize, delay: f64) -> Mode {
        let start = if front == Front::Flux { 0.0 } else { -FRAC_PI_2 };
        let end = if self.back == Back::Insulated { 0.0 } else { FRAC_PI_2 };
        let back = n as f64 * PI + end;
        let off =
            |omega: f64| self.phases(start, omega).last().expect("a slab has layers").1 - back;
        let mut high = (back - start).max(PI) / delay;
        while off(high) < 0.0 {
            high *= 2.0;
        }
        let mut low = 0.0;
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if off(middle) < 0.0 { low = middle } else { high = middle }
        }
        self.with_amplitudes(start, 0.5 * (low + high))
    }

    /// Phases at both ends of each layer.
    fn phases(&self, start: f64, omega: f64) -> Vec<(f64, f64)> {
        let mut list: Vec<(f64, f64)> = Vec::new();
        for (i, layer) in self.layers.iter().enumerate() {
            let from = match i {
                0 => start,
                _ => {
                    let (before, phase) = (&self.layers[i - 1], list[i - 1].1);
                    let turns = (phase / PI).floor() * PI;
                    let cotangent = (phase - turns).tan().recip();
                    let cotangent = layer.body.effusivity()
                        * (cotangent / before.body.effusivity() - omega * layer.contact_resistance);
                    turns + FRAC_PI_2 - cotangent.atan()
                }
            };
            list.push((from, from + omega * layer.delay()));
        }
        list
    }

    fn with_amplitudes(&self, start: f64, omega: f64) -> Mode {
        let phases = self.phases(start, omega);
        let mut parts: Vec<(f64, f64)> = Vec::new();
        let mut norm = 0.0;
        for (i, (layer, &(from, to))) in self.layers.iter().zip(&phases).enumerate() {
            let amplitude = match i {
                0 => 1.0,
                _ => {
                    let (before, phase) = (&self.layers[i - 1], phases[i - 1].1);
                    let value = parts[i - 1].1 * phase.cos();
                    let flux = parts[i - 1].1 * before.body.effusivity() * omega * phase.sin();
                    let value = value - layer.contact_resistance * flux;
                    // Uses both terms, because either may be zero.
                    let flux = flux / (layer.body.effusivity() * omega);
                    value * from.cos() + flux * from.sin()
                }
            };
            let root = layer.body.diffusivity().sqrt() / omega;
            let square =
                layer.thickness / 2.0 + root / 4.0 * ((2.0 * to).sin() - (2.0 * from).sin());
            norm += layer.body.heat_capacity * amplitude.powi(2) * square;
            parts.push((from, amplitude));
        }
        Mode { omega, parts, norm }
    }

    fn value(&self, mode: &Mode, layer: usize, x: f64) -> f64 {
        let own = &self.layers[layer];
        let (phase, amplitude) = mode.parts[layer];
        let way = (x - self.start_of(own)) / own.body.diffusivity().sqrt();
        amplitude * (phase + mode.omega * way).cos()
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{ALUMINA, assert_close, derivative, derivative_at_left};
    use super::super::slab::HeatedSlab;
    use super::*;

    const COPPER: Conductor = Conductor { conductivity: 400.0, heat_capacity: 3.45e6 };
    const GLASS: Conductor = Conductor { conductivity: 1.1, heat_capacity: 2.1e6 };

    fn layer(body: Conductor, thickness: f64, contact_resistance: f64) -> SlabLayer {
        SlabLayer { body, thickness, contact_resistance }
    }

    fn slab(back: Back) -> CompositeSlab {
        let layers = vec![
            layer(GLASS, 20e-6, 0.0),
            layer(ALUMINA, 100e-6, 3e-6),
            layer(COPPER, 300e-6, 0.0),
        ];
        CompositeSlab { layers, back }
    }

    #[test]
    fn layers_of_one_material_are_a_slab_of_it() {
        let single = HeatedSlab { body: ALUMINA, flux: 1e6, thickness: 0.3e-3 };
        let parts = [0.1e-3, 0.05e-3, 0.15e-3].map(|thickness| layer(ALUMINA, thickness, 0.0));
        for t in [1e-4, 1e-3, 1e-2] {
            for (part, x) in [(0, 0.0), (0, 0.1e-3), (1, 0.1e-3), (1, 0.13e-3), (2, 0.3e-3)] {
                let of = |back| CompositeSlab { layers: parts.to_vec(), back };
                let value = of(Back::Insulated).under_flux(1e6).rise((part, x), t);
                assert!((value - single.rise_with_insulated_back(x, t)).abs() < 1e-9);
                let value = of(Back::Held).under_flux(1e6).rise((part, x), t);
                assert!((value - single.rise_with_held_back(x, t)).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn flux_is_continuous_and_temperature_falls_by_the_contacts_share_of_it() {
        for back in [Back::Insulated, Back::Held] {
            let slab = slab(back);
            let (heated, warm) = (slab.under_flux(1e6), slab.under_temperature(40.0));
            for t in [2e-4, 2e-3, 0.05] {
                for sudden in [false, true] {
                    let rise = |layer, x| match sudden {
                        false => heated.rise((layer, x), t),
                        true => warm.rise((layer, x), t),
                    };
                    for (above, x) in [(0, 20e-6), (1, 120e-6)] {
                        let h = 1e-7;
                        let [k, below] =
                            [above, above + 1].map(|i| slab.layers[i].body.conductivity);
                        let out = k * derivative_at_left(|s| rise(above, 2.0 * x - s), x, h);
                        let into = -below * derivative_at_left(|s| rise(above + 1, s), x, h);
                        assert!((out - into).abs() < 1e-5 * into.abs().max(1e4), "{out} {into}");
                        let jump = rise(above, x) - rise(above + 1, x);
                        let wanted = slab.layers[above + 1].contact_resistance * into;
                        assert!((jump - wanted).abs() < 1e-5, "{jump} {wanted}");
                    }
                }
            }
        }
    }

    #[test]
    fn front_satisfies_its_boundary_condition() {
        for back in [Back::Insulated, Back::Held] {
            let slab = slab(back);
            let (heated, warm) = (slab.under_flux(1e6), slab.under_temperature(40.0));
            for t in [2e-4, 0.05] {
                let rise = |x: f64| heated.rise((0, x), t);
                let into = -GLASS.conductivity * derivative_at_left(rise, 0.0, 1e-7);
                assert_close(into, 1e6, 1e-6);
                assert!((warm.rise((0, 0.0), t) - 40.0).abs() < 1e-9);
            }
            assert!(warm.rise((1, 60e-6), 1e-7).abs() < 1e-6);
        }
    }

    #[test]
    fn heat_supplied_equals_heat_stored_at_late_times() {
        let slab = slab(Back::Insulated);
        let capacity: f64 = slab.layers.iter().map(SlabLayer::capacity).sum();
        assert_close(slab.under_temperature(40.0).heat(10.0), 40.0 * capacity, 1e-6);
    }

    #[test]
    fn heat_follows_the_slope_at_the_front_and_starts_as_in_a_half_space() {
        for back in [Back::Insulated, Back::Held] {
            let slab = slab(back);
            let warm = slab.under_temperature(40.0);
            for t in [2e-4, 2e-3, 0.05] {
                let rate = derivative(|t| warm.heat(t), t, 0.01 * t);
                let slope = derivative_at_left(|x| warm.rise((0, x), t), 0.0, 1e-7);
                assert_close(rate, -GLASS.conductivity * slope, 1e-5);
            }
            let t = 2e-6;
            assert_close(warm.heat(t), 2.0 * 40.0 * GLASS.effusivity() * (t / PI).sqrt(), 1e-4);
        }
    }
}
