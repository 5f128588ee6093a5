//! Flux out of a layer of particles at a surface of constant temperature below the liquidus, as a function of the
//! heat that the layer has lost.

use std::cell::Cell;

use super::contact_law::{SHORTEST, THICK};
use super::freezing_flux::freezing_flux;
use super::phases::Phases;

/// Fluid in layers of thickness 1, molten diffusivity 1 and molten conductivity 1, insulated from the surface, that
/// conduct by the method's own sums.
pub struct Lattice {
    pub phases: Phases,
    /// Rates at which a layer approaches the layers 1, 2, … away.
    pub couplings: Vec<f64>,
    /// Conductivity of the lattice over the nominal one.
    pub strength: f64,
    /// 2C of a layer of uniform temperature.
    pub decay: f64,
}

/// Flux of a surface temperature, with the deficit E, the heat that the layer has lost per area.
///
/// A half space loses the flux `q = q₀/√t`, and `qE = 2q₀²` while the layer supplies all the heat. The bend
/// `qE/2q₀²` departs from 1 once other layers supply heat, too. Its knots are at equal distances in each of three
/// sections, in which the layer is molten, melts, and is frozen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Curve {
    /// `2q₀²/(Δh Δψ)` with the differences of content and potential between fluid and surface.
    pub similarity: f64,
    /// Potential of the layer at which the curve ends: its distance from that of the surface over that of the
    /// liquidus.
    pub end: f64,
    pub bends: [[f64; KNOTS]; 3],
}

/// Number of knots of a section, and of the curve of a fluid that stays molten.
pub const KNOTS: usize = 17;
const MOLTEN_KNOTS: usize = 193;
/// Number of layers of the lattice, and most couplings of a layer. Its diffusion steps relative to the elapsed time,
/// and their upper bound for the molten fluid and for its fastest phase.
const LAYERS: usize = 64;
const MOST_COUPLINGS: usize = 8;
const SHARE: f64 = 0.02;
const LONGEST: [f64; 2] = [0.05, 0.25];
/// Diffusion lengths over √t, and layers, that the calculation includes beyond the surface.
const REACH: [f64; 2] = [8.0, 8.0];
/// Time at which the lattice ends. Then the frozen skin thickens without further heat from above, in so many parts.
const SETTLED: f64 = 130.0;
const PARTS: usize = 400;
/// Largest end of a curve.
const LAST: f64 = 0.999_999;

impl Lattice {
    /// Bends of a fluid that stays molten, at equal distances of θ up to [`THICK`].
    pub fn molten_bends(&self) -> Vec<f64> {
        let phases = Phases { melting: [f64::MIN; 2], latent: 0.0, heat: 1.0, conduction: 1.0 };
        let lattice = Self { phases, couplings: self.couplings.clone(), ..*self };
        let factor = (self.strength / std::f64::consts::PI).sqrt();
        let known = lattice.losses(1.0, factor, |content, _| 1.0 - content >= THICK);
        let place = |n: usize| THICK * n as f64 / (MOLTEN_KNOTS - 1) as f64;
        (0..MOLTEN_KNOTS).map(|n| bend(&known, place(n), factor)).collect()
    }

    /// Curve of a fluid of a temperature above a surface of another.
    pub fn curve(&self, start: f64, surface: f64) -> Curve {
        let phases = &self.phases;
        let potential = |rise: f64| phases.potential(phases.content(rise));
        let (low, high) = (potential(surface), potential(phases.melting[1]));
        let factor = freezing_flux(phases, start, surface) * self.strength.sqrt();
        let was_below = Cell::new(false);
        // The flux falls below that of a layer of uniform temperature while a front passes the layer. The curve
        // ends where they meet again, or where the layer almost has the temperature of the surface.
        let ends = |content: f64, flux: f64| {
            let drop = phases.potential(content) - low;
            let below = flux < self.decay * drop;
            let met = was_below.get() && !below && drop < high - low;
            was_below.set(below || met);
            met || drop <= (1.0 - THICK) * (high - low)
        };
        let mut known = self.losses(start, factor, ends);
        let bottom = phases.content(surface);
        let [lost, flux] = known[known.len() - 1];
        if !ends(start - lost, flux) {
            let [frozen, molten] = phases.contents();
            let latent = molten - bottom.max(frozen);
            for n in 1..=PARTS {
                let deficit = lost + (start - bottom - lost) * n as f64 / PARTS as f64;
                let thickness = (high - low) / flux + (deficit - lost) / latent;
                known.push([deficit, (high - low) / thickness]);
                if ends(start - deficit, (high - low) / thickness) {
                    break;
                }
            }
        }
        let last = known[known.len() - 1][0];
        let end = ((phases.potential(start - last) - low) / (high - low)).clamp(0.0, LAST);
        let all = start - content_at(phases, low + end * (high - low));
        let edges = sections(phases, start, all);
        let at = |section: usize, n: usize| {
            let share = n as f64 / (KNOTS - 1) as f64;
            edges[section] + share * (edges[section + 1] - edges[section])
        };
        let bends =
            [0, 1, 2].map(|section| std::array::from_fn(|n| bend(&known, at(section, n), factor)));
        let similarity = 2.0 * factor * factor / ((start - bottom) * (potential(start) - low));
        Curve { similarity, end, bends }
    }

    /// Pairs of the lowest layer's deficit and the flux, which is `factor/√t`, until `ends(content, flux)`.
    fn losses(&self, start: f64, factor: f64, ends: impl Fn(f64, f64) -> bool) -> Vec<[f64; 2]> {
        let fastest = self.phases.fastest();
        let longest = LONGEST[0].min(LONGEST[1] / fastest);
        let (mut contents, mut time) = ([start; LAYERS], 0.0_f64);
        let mut known: Vec<[f64; 2]> = Vec::new();
        while time < SETTLED {
            let step = (SHARE * time).max(SHORTEST).min(longest);
            let reach = REACH[0] * (time * fastest).sqrt() + REACH[1];
            self.conduct(&mut contents, start, (reach as usize).min(LAYERS), step);
            contents[0] -= 2.0 * factor * ((time + step).sqrt() - time.sqrt());
            time += step;
            let [deficit, flux] = [start - contents[0], factor / time.sqrt()];
            if known.last().is_some_and(|last| deficit <= last[0]) {
                break;
            }
            known.push([deficit, flux]);
            if ends(contents[0], flux) {
                break;
            }
        }
        known
    }

    /// Conducts between the lowest layers for a time. The surface mirrors the layers; `far` is the content above them.
    fn conduct(&self, contents: &mut [f64], far: f64, reach: usize, step: f64) {
        let potential = |content: &f64| self.phases.potential(*content);
        let mut potentials = [potential(&far); LAYERS + MOST_COUPLINGS];
        potentials.iter_mut().zip(contents.iter()).for_each(|(to, of)| *to = potential(of));
        for layer in 0..reach {
            let mut rate = 0.0;
            for (n, coupling) in self.couplings.iter().enumerate() {
                let distance = n + 1;
                let below = if layer >= distance { layer - distance } else { distance - layer - 1 };
                let pair = potentials[below] + potentials[layer + distance];
                rate += coupling * (pair - 2.0 * potentials[layer]);
            }
            contents[layer] += step * rate;
        }
    }
}

/// Deficits that bound the sections of a curve.
pub fn sections(phases: &Phases, start: f64, end: f64) -> [f64; 4] {
    let [frozen, molten] = phases.contents();
    [0.0, (start - molten).min(end), (start - frozen).min(end), end]
}

/// `qE/2q₀²` at a deficit, between known pairs of E and q.
fn bend(known: &[[f64; 2]], deficit: f64, factor: f64) -> f64 {
    if deficit <= known[0][0] {
        return 1.0;
    }
    let above = known.partition_point(|place| place[0] < deficit).clamp(1, known.len() - 1);
    let ([a, f], [b, g]) = (known[above - 1], known[above]);
    let share = ((deficit - a) / (b - a)).clamp(0.0, 1.0);
    (a * f + share * (b * g - a * f)) / (2.0 * factor * factor)
}

/// Content at a heat potential; where melting is isothermal, at that point, of the molten phase.
pub fn content_at(phases: &Phases, potential: f64) -> f64 {
    let [solidus, liquidus] = phases.melting;
    let mean = 0.5 * (1.0 + phases.conduction);
    let at_solidus = liquidus - mean * (liquidus - solidus);
    let rise = if potential >= liquidus {
        potential
    } else if potential <= at_solidus {
        solidus + (potential - at_solidus) / phases.conduction
    } else {
        liquidus + (potential - liquidus) / mean
    };
    phases.content(rise)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn content_is_the_inverse_of_the_potential() {
        for melting in [[-8.0, -8.0], [-20.0, -5.0]] {
            let phases = Phases { melting, latent: 240.0, heat: 1.1, conduction: 1.9 };
            for rise in [-300.0, -20.0, -12.0, -6.0, -5.0, 0.0, 90.0] {
                let content = phases.content(rise);
                let found = content_at(&phases, phases.potential(content));
                assert!((found - content).abs() < 1e-10, "{rise}: {found} {content}");
            }
        }
    }
}
