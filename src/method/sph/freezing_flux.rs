//! Heat that a half space of a freezing fluid loses to a surface of constant temperature.

use std::f64::consts::PI;

use super::phases::Phases;
use crate::closed_form::special::erfcx;

/// Number of halvings of the bracket of a root.
const HALVINGS: usize = 56;
/// Largest `η/√d` beyond the start of a phase that the search for its end considers.
const FARTHEST: f64 = 8.0;

/// Flux at a surface of constant temperature, times the root of the time since contact [K], in units in which the
/// molten fluid has a diffusivity of 1.
///
/// All depends on `η = x/2√t`. In a phase of diffusivity d that starts at η₀ with the flux p₀/√t the flux is
/// `p₀ exp((η₀² − η²)/d)/√t`, and the heat potential ψ rises by
/// `p₀ √(πd) (erfcx y₀ − exp(y₀² − y²) erfcx y)`, `y = η/√d`. Isothermal melting takes the flux `ΔH η` away, with
/// the difference ΔH of contents. The flux at the surface is the one for which ψ ends at that of the fluid far away.
///
/// Source: generalises Neumann's solution (H. S. Carslaw and J. C. Jaeger, *Conduction of Heat in Solids*, Oxford
/// 1959, §11.2) to a range of melting.
pub fn freezing_flux(phases: &Phases, start: f64, surface: f64) -> f64 {
    let potential = |rise: f64| phases.potential(phases.content(rise));
    let [solidus, liquidus] = phases.melting;
    let [first, last] = [potential(surface), potential(start)];
    // A front at rest would need the flux √(Δh Δψ/2t).
    let heat = phases.content(start) - phases.content(surface).min(phases.contents()[0]);
    let mut bracket = [0.0, (0.5 * heat * (last - first)).sqrt()];
    let reaches = |flux: f64| {
        let mut at = Place { distance: 0.0, flux };
        if surface < solidus {
            at.cross(phases.conduction / phases.heat, potential(solidus) - first)?;
        }
        let [frozen, molten] = phases.contents();
        if solidus == liquidus {
            at.flux -= (molten - frozen) * at.distance;
        } else if surface < liquidus {
            let drop = potential(liquidus) - potential(solidus);
            let left = potential(liquidus) - first.max(potential(solidus));
            at.cross(drop / (molten - frozen), left)?;
        }
        let all = at.flux * PI.sqrt() * erfcx(at.distance);
        (all >= last - first.max(potential(liquidus))).then_some(())
    };
    for _ in 0..HALVINGS {
        let middle = 0.5 * (bracket[0] + bracket[1]);
        bracket[usize::from(reaches(middle).is_some())] = middle;
    }
    bracket[1]
}

/// Start of a phase: η, and the flux times √t.
struct Place {
    distance: f64,
    flux: f64,
}

impl Place {
    /// Moves to where ψ has risen by some amount; `None` if it never does.
    fn cross(&mut self, diffusivity: f64, rise: f64) -> Option<()> {
        let root = diffusivity.sqrt();
        let start = self.distance / root;
        let whole = erfcx(start);
        let wanted = rise / (self.flux * PI.sqrt() * root);
        if wanted >= whole {
            return None;
        }
        let decay = |way: f64| (-way * (2.0 * start + way)).exp();
        let mut ways = [0.0, FARTHEST];
        for _ in 0..HALVINGS {
            let middle = 0.5 * (ways[0] + ways[1]);
            let risen = whole - decay(middle) * erfcx(start + middle);
            ways[usize::from(risen >= wanted)] = middle;
        }
        self.flux *= decay(ways[1]);
        self.distance = root * (start + ways[1]);
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closed_form::{Conductor, MeltingFront};

    const FLUID: Phases =
        Phases { melting: [-8.0, -8.0], latent: 240.0, heat: 1.1, conduction: 1.9 };

    #[test]
    fn isothermal_melting_agrees_with_neumann() {
        let body = |conductivity, heat_capacity| Conductor { conductivity, heat_capacity };
        for start in [-8.0, -7.999, 0.0, 90.0] {
            for surface in [-8.001, -20.0, -200.0, -5000.0] {
                let front = MeltingFront {
                    new: body(1.9, 1.1),
                    old: body(1.0, 1.0),
                    latent: FLUID.latent,
                    surface: -8.0 - surface,
                    initial: start + 8.0,
                };
                let ratio = freezing_flux(&FLUID, start, surface) / front.flux(1.0);
                assert!((ratio - 1.0).abs() < 1e-9, "{start} {surface}: {ratio}");
            }
        }
    }

    #[test]
    fn narrow_range_is_a_melting_point() {
        for width in [1e-6, 1e-3, 0.1] {
            let range = Phases { melting: [-8.0 - width, -8.0], ..FLUID };
            let [of_range, of_point] =
                [range, FLUID].map(|phases| freezing_flux(&phases, 0.0, -200.0));
            assert!((of_range / of_point - 1.0).abs() < 0.01 * width + 1e-9, "{width}");
        }
    }

    #[test]
    fn equal_phases_conduct() {
        let phases = Phases { melting: [-20.0, -5.0], latent: 0.0, heat: 1.0, conduction: 1.0 };
        for surface in [-4.0, -10.0, -100.0] {
            let flux = freezing_flux(&phases, 7.0, surface);
            assert!((flux * PI.sqrt() / (7.0 - surface) - 1.0).abs() < 1e-9, "{surface}");
        }
    }
}
