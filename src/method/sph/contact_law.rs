//! How fast the layer of particles at a wall takes its temperature.

use std::f64::consts::PI;

use crate::kernel::Kernel;

/// Cooling of the particles at a wall, right for thermal layers thinner and thicker than they are.
///
/// Fluid of temperature T∞ above a wall of T_w loses the heat `2 ρc (T∞ − T_w) √(κt/π)` in a time t (H. S.
/// Carslaw and J. C. Jaeger, *Conduction of Heat in Solids*, Oxford 1959, §2.4). The particles at the wall,
/// a layer of thickness δ and mean temperature T, have lost the part `θ = (T∞ − T)/(T∞ − T_w)` of theirs.
/// The wall alone changes θ at the rate
///
/// `dθ/dt = κ/δ² f(θ)`,
///
/// with `f → 2/(πθ)` while the layer holds all the heat that is lost, and `f → 2C (1 − θ)` once the
/// temperature is even across it, so that T∞ no longer matters. No time of contact is needed.
///
/// f is found by computation: layers of a lattice conduct by the method's own sums, insulated from the
/// wall; the exact flux enters the lowest; f is that flux as a function of the θ that this layer
/// has then. So a lattice takes the exact heat at any time, whatever Δx. C, which is 1 for finite volumes,
/// makes up for a kernel that smooths over several layers.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactLaw {
    /// `∫₀^θ dθ/f` for θ at equal distances from 0 to [`THICK`].
    times: Vec<f64>,
    /// 2C.
    decay: f64,
}

/// θ beyond which it decays towards 1 as if it were even across the layer.
const THICK: f64 = 0.95;
/// Places of the table.
const PLACES: usize = 96;
/// Layers of the lattice, and steps of its diffusion time: by their share of the time so far, and at most.
const LAYERS: usize = 64;
const SHARE: f64 = 0.02;
const SHORTEST: f64 = 1e-5;
const LONGEST: f64 = 0.05;

impl ContactLaw {
    /// For a kernel of support radius `support` over Δx.
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

    /// Part of `T − T_w` that the layer loses during a diffusion time `κΔt/δ²`, always between 0 and 1.
    ///
    /// Without a θ, for fluid of which no temperature before contact is known, the layer is taken to be even.
    pub fn relaxation(&self, deficit: Option<f64>, diffusion: f64) -> f64 {
        match deficit {
            Some(deficit) if deficit < THICK => {
                let before = deficit.max(0.0);
                (self.later(before, diffusion) - before) / (1.0 - before)
            }
            _ => -(-self.decay * diffusion).exp_m1(),
        }
    }

    /// θ < [`THICK`] after a diffusion time.
    fn later(&self, deficit: f64, diffusion: f64) -> f64 {
        let (count, width) = (self.times.len(), THICK / (self.times.len() - 1) as f64);
        let place = deficit / width;
        let below = (place as usize).min(count - 2);
        // Times grow like θ², which is kept between places too.
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

/// Rates `2 Σ V (−F)` at which a layer of a lattice takes the temperature of one that is 1, 2, … layers away,
/// over κ/Δx².
fn couplings(kernel: Kernel, support: f64, dimension: usize) -> Vec<f64> {
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

/// Pairs of θ of the lowest layer and of the flux over k (T∞ − T_w)/Δx, in the course of time, up to
/// [`THICK`] and a little beyond.
fn exact_flux(couplings: &[f64]) -> Vec<[f64; 2]> {
    let moments = couplings.iter().enumerate().map(|(n, c)| ((n + 1) * (n + 1)) as f64 * c);
    // What the lattice conducts, 1 but for the kernel's error.
    let effusivity = moments.sum::<f64>().sqrt();
    let heat = |time: f64| 2.0 * effusivity * (time / PI).sqrt();
    let (mut lost, mut time) = (vec![0.0; LAYERS], 0.0);
    let mut curve: Vec<[f64; 2]> = Vec::new();
    while curve.last().is_none_or(|&[deficit, _]| deficit < THICK) {
        let step = (SHARE * time).clamp(SHORTEST, LONGEST);
        let rate = |layer: usize| {
            let from = |distance: usize, coupling: f64| {
                // The wall mirrors the layers; far above nothing has cooled.
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
        curve.push([lost[0], effusivity / (PI * time).sqrt()]);
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
    fn a_fresh_layer_loses_the_heat_of_a_half_space_whatever_the_step() {
        for law in laws() {
            for diffusion in [1e-4, 1e-3, 1e-2] {
                let exact = 2.0 * (diffusion / PI).sqrt();
                let lost = law.relaxation(Some(0.0), diffusion);
                // Short supports conduct by up to 3 % too little.
                assert!((lost / exact - 1.0).abs() < 0.02, "{diffusion}: {lost} {exact}");
            }
        }
    }

    #[test]
    fn two_steps_are_one_step() {
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
    fn no_step_goes_beyond_the_wall() {
        for law in laws() {
            for deficit in [None, Some(-0.5), Some(0.0), Some(0.7), Some(1.0), Some(3.0)] {
                let parts = [0.0, 1e-3, 0.1, 1.0, 1e3].map(|d| law.relaxation(deficit, d));
                assert!(parts.is_sorted(), "{parts:?}");
                assert!(parts[0].abs() < 1e-15 && parts[4] <= 1.0, "{parts:?}");
            }
        }
    }

    #[test]
    fn finite_volumes_pass_twice_the_conductivity_over_their_thickness() {
        // A kernel that reaches no further than the next layer makes finite volumes of a lattice's layers.
        let law = ContactLaw::of(Kernel::WendlandC2, 2.0, 3);
        assert!((law.decay / 2.0 - 1.0).abs() < 0.05, "{}", law.decay);
    }
}
