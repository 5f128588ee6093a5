//! Rate at which the layer of particles at a wall adopts the wall's temperature.

use std::f64::consts::PI;

use crate::kernel::Kernel;

/// Cooling of the particles at a wall, valid for thermal layers thinner and thicker than the
/// particle layer.
///
/// Fluid of temperature T∞ above a wall of T_w loses the heat `2 ρc (T∞ − T_w) √(κt/π)` in a time t
/// (H. S. Carslaw and J. C. Jaeger, *Conduction of Heat in Solids*, Oxford 1959, §2.4). The
/// particles at the wall form a layer of thickness δ and mean temperature T. They have lost the
/// fraction `θ = (T∞ − T)/(T∞ − T_w)` of their heat. The wall alone changes θ at the rate
///
/// `dθ/dt = κ/δ² f(θ)`,
///
/// with `f → 2/(πθ)` while the layer supplies all the lost heat, and `f → 2C (1 − θ)` once the
/// temperature is uniform across it and T∞ no longer matters. The law needs no time of contact.
///
/// f is computed numerically. Layers of a lattice, insulated from the wall, conduct by the method's
/// own sums; the exact flux enters the lowest layer. f is that flux as a function of this layer's
/// θ. So a lattice absorbs the exact heat at any time, for every Δx. C is 1 for finite volumes; it
/// compensates for a kernel that smooths over several layers.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactLaw {
    /// `∫₀^θ dθ/f` for θ at equal distances from 0 to [`THICK`].
    times: Vec<f64>,
    /// 2C.
    decay: f64,
}

/// θ beyond which the deficit decays towards 1 as in a layer of uniform temperature.
pub const THICK: f64 = 0.95;
/// Number of entries of the table.
const PLACES: usize = 96;
/// Number of layers of the lattice; its diffusion steps relative to the elapsed time, and their
/// bounds.
const LAYERS: usize = 64;
const SHARE: f64 = 0.02;
pub const SHORTEST: f64 = 1e-5;
const LONGEST: f64 = 0.05;

impl ContactLaw {
    /// Law for a kernel of support radius `support` over Δx.
    pub fn of(kernel: Kernel, support: f64, dimension: usize) -> Self {
        let curve = exact_flux(&couplings(kernel, support, dimension));
        // θ f π/2 is smooth where f has a pole.
        let smooth = |deficit: f64| {
            let above =
                curve.partition_point(|&[known, _]| known < deficit).clamp(1, curve.len() - 1);
            let ([a, f], [b, g]) = (curve[above - 1], curve[above]);
            let [low, high] = [a * f, b * g].map(|product| 0.5 * PI * product);
            low + (high - low) * ((deficit - a) / (b - a)).clamp(0.0, 1.0)
        };
        let width = THICK / (PLACES - 1) as f64;
        let slowness = |deficit: f64| 0.5 * PI * deficit / smooth(deficit);
        let mut times = vec![0.0];
        for place in 1..PLACES {
            let [a, b] = [place - 1, place].map(|n| n as f64 * width);
            let mean = (slowness(a) + 4.0 * slowness(0.5 * (a + b)) + slowness(b)) / 6.0;
            times.push(times[place - 1] + width * mean);
        }
        Self { times, decay: 1.0 / (slowness(THICK) * (1.0 - THICK)) }
    }

    /// 2C.
    pub fn decay(&self) -> f64 {
        self.decay
    }

    /// Fraction of `T − T_w` that the layer loses during a diffusion time `κΔt/δ²`, always between
    /// 0 and 1.
    ///
    /// Without a θ (fluid whose temperature before contact is unknown) the layer is assumed
    /// uniform.
    pub fn relaxation(&self, deficit: Option<f64>, diffusion: f64) -> f64 {
        match deficit {
            Some(deficit) if deficit < THICK => {
                let before = deficit.max(0.0);
                (self.later(before, diffusion) - before) / (1.0 - before)
            }
            _ => -(-self.decay * diffusion).exp_m1(),
        }
    }

    /// θ after a diffusion time, for θ < [`THICK`].
    fn later(&self, deficit: f64, diffusion: f64) -> f64 {
        let (count, width) = (self.times.len(), THICK / (self.times.len() - 1) as f64);
        let place = deficit / width;
        let below = (place as usize).min(count - 2);
        // Times grow like θ²; the interpolation between entries keeps that.
        let square = |n: usize| (n as f64 * width).powi(2);
        let [low, high] = [below, below + 1].map(square);
        let share = (deficit * deficit - low) / (high - low);
        let now = self.times[below] + share * (self.times[below + 1] - self.times[below]);
        let then = now + diffusion;
        let last = self.times[count - 1];
        if then >= last {
            return 1.0 - (1.0 - THICK) * (-self.decay * (then - last)).exp();
        }
        let above = self.times.partition_point(|&time| time <= then);
        let [a, b] = [self.times[above - 1], self.times[above]];
        let [low, high] = [above - 1, above].map(square);
        (low + (high - low) * (then - a) / (b - a)).sqrt()
    }
}

/// Rates `2 Σ V (−F)`, over κ/Δx², at which a layer of a lattice approaches the temperature of the
/// layer 1, 2, … layers away.
pub fn couplings(kernel: Kernel, support: f64, dimension: usize) -> Vec<f64> {
    let reach = support.ceil() as i64;
    let rows = if dimension == 3 { -reach..=reach } else { 0..=0 };
    let of_layer = |layer: i64| {
        let across = (-reach..=reach).flat_map(|i| rows.clone().map(move |j| i * i + j * j));
        let factor = |across: i64| {
            let distance = ((across + layer * layer) as f64).sqrt();
            kernel.gradient_factor(distance, support, dimension)
        };
        -2.0 * across.map(factor).sum::<f64>()
    };
    (1..=reach).map(of_layer).collect()
}

/// Pairs of the lowest layer's θ and the flux over k (T∞ − T_w)/Δx over time, until slightly beyond
/// [`THICK`].
fn exact_flux(couplings: &[f64]) -> Vec<[f64; 2]> {
    let effusivity = effusivity(couplings);
    let heat = |time: f64| 2.0 * effusivity * (time / PI).sqrt();
    let flux = |time: f64| effusivity / (PI * time).sqrt();
    deficits_under(couplings, (heat, flux), f64::INFINITY)
}

/// Effusivity of a lattice over the fluid's. The square is its conductivity over the nominal one: 1
/// but for the kernel's error.
pub fn effusivity(couplings: &[f64]) -> f64 {
    let moments = couplings.iter().enumerate().map(|(n, c)| ((n + 1) * (n + 1)) as f64 * c);
    moments.sum::<f64>().sqrt()
}

/// Pairs of the lowest layer's θ and the flux over time, until slightly beyond [`THICK`] or
/// `longest`. `heat` is the integral of the flux.
pub fn deficits_under(
    couplings: &[f64],
    (heat, flux): (impl Fn(f64) -> f64, impl Fn(f64) -> f64),
    longest: f64,
) -> Vec<[f64; 2]> {
    let (mut lost, mut time) = (vec![0.0; LAYERS], 0.0);
    let mut curve: Vec<[f64; 2]> = Vec::new();
    while time < longest && curve.last().is_none_or(|&[deficit, _]| deficit < THICK) {
        let step = (SHARE * time).clamp(SHORTEST, LONGEST);
        let rate = |layer: usize| {
            let from = |distance: usize, coupling: f64| {
                // The wall mirrors the layers; far above nothing has cooled yet.
                let below = if layer >= distance { layer - distance } else { distance - layer - 1 };
                let above = lost.get(layer + distance).copied().unwrap_or(0.0);
                coupling * (lost[below] + above - 2.0 * lost[layer])
            };
            couplings.iter().enumerate().map(|(n, &c)| from(n + 1, c)).sum::<f64>()
        };
        let rates: Vec<f64> = (0..LAYERS).map(rate).collect();
        lost.iter_mut().zip(rates).for_each(|(lost, rate)| *lost += step * rate);
        lost[0] += heat(time + step) - heat(time);
        time += step;
        curve.push([lost[0], flux(time)]);
    }
    curve
}

#[cfg(test)]
mod tests {
    use super::*;

    fn laws() -> Vec<ContactLaw> {
        let supports = [2.0, 2.5, 3.0, 4.0, 6.0];
        let law = |dimension| move |support| ContactLaw::of(Kernel::WendlandC2, support, dimension);
        [2, 3].into_iter().flat_map(|d| supports.map(law(d))).collect()
    }

    #[test]
    fn initial_cooling_matches_half_space_for_any_step() {
        for law in laws() {
            for diffusion in [1e-4, 1e-3, 1e-2] {
                let exact = 2.0 * (diffusion / PI).sqrt();
                let lost = law.relaxation(Some(0.0), diffusion);
                // With short supports the conductivity is up to 3 % too low.
                assert!((lost / exact - 1.0).abs() < 0.02, "{diffusion}: {lost} {exact}");
            }
        }
    }

    #[test]
    fn two_half_steps_equal_one_step() {
        for law in laws() {
            for deficit in [0.0, 0.1, 0.5, 0.9, 0.94] {
                let once = law.relaxation(Some(deficit), 0.02);
                let first = law.relaxation(Some(deficit), 0.01);
                let middle = deficit + first * (1.0 - deficit);
                let both = 1.0 - (1.0 - first) * (1.0 - law.relaxation(Some(middle), 0.01));
                assert!((once - both).abs() < 1e-12, "{deficit}: {once} {both}");
            }
        }
    }

    #[test]
    fn no_step_overshoots_the_wall_temperature() {
        for law in laws() {
            for deficit in [None, Some(-0.5), Some(0.0), Some(0.7), Some(1.0), Some(3.0)] {
                let parts = [0.0, 1e-3, 0.1, 1.0, 1e3].map(|d| law.relaxation(deficit, d));
                assert!(parts.is_sorted(), "{parts:?}");
                assert!(parts[0].abs() < 1e-15 && parts[4] <= 1.0, "{parts:?}");
            }
        }
    }

    #[test]
    fn finite_volume_conductance_at_the_wall() {
        // With a kernel that reaches only the next layer, a lattice's layers are finite volumes.
        let law = ContactLaw::of(Kernel::WendlandC2, 2.0, 3);
        assert!((law.decay / 2.0 - 1.0).abs() < 0.05, "{}", law.decay);
    }
}
