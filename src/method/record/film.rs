//! A profile from closed forms. The footprint grows to the width of published correlations, and a
//! force transfers all momentum. From the time at which each place is wetted, the flux is that of
//! two half spaces, one of which spreads over the other, limited by the heat of the film above the
//! place.

use std::f64::consts::PI;

use super::profile::{Amounts, Profile};
use crate::closed_form::cooling_film::given_part;
use crate::closed_form::{DropImpact, flux_over_rest};

/// Inputs of a film.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Film {
    pub impact: DropImpact,
    /// c [J/(kg K)] and k [W/(m K)] of the fluid.
    pub specific_heat: f64,
    pub conductivity: f64,
    /// √(kρc) of the wall [W √s/(m² K)]; `None` for a wall of prescribed temperature.
    pub effusivity: Option<f64>,
    /// [s]
    pub duration: f64,
    pub samples: usize,
    pub rings: usize,
    /// Radius of the outermost ring, no less than the film's [m].
    pub radius: f64,
}

/// Smallest and largest Prandtl number: outside this range the flux hardly depends on it.
const PRANDTL: [f64; 2] = [1e-6, 1e4];
/// Number of circles of a ring on which the time of wetting is evaluated.
const CIRCLES: usize = 8;

impl Film {
    /// Largest radius of the footprint [m].
    pub fn largest_radius(impact: &DropImpact) -> f64 {
        0.5 * impact.diameter * impact.largest_spread()
    }

    /// Heat per area and kelvin that a place has received by the end of each sample [J/(m² K)].
    ///
    /// A thermal layer of thickness √D [√s] grows by diffusion from the time at which the place is
    /// wetted, and the flow u = r/(t + τ) thins it: `dD/dt = 1 − (f² − 1) s D/(t + τ)`. In a flow
    /// that has lasted forever, D = t/f², which defines f, the ratio of the flux to that of fluid
    /// at rest. s falls from 1 to 0 as the footprint comes to rest. Compared with fluid at rest for
    /// the same time, the flux is larger by √(age/D), as far as the wall absorbs it.
    fn heats(&self, (thickness, largest): (f64, f64), flow: f64, at: f64) -> Vec<f64> {
        let impact = &self.impact;
        let step = self.duration / self.samples as f64;
        let diffusivity = self.conductivity / (impact.density * self.specific_heat);
        let content = impact.density * self.specific_heat * thickness;
        let wetted = impact.time_of_wetting(largest, at);
        let (mut layer, mut root) = (0.0, 0.0_f64);
        let until = |sample: usize| {
            let ages = [sample, sample + 1].map(|n| (step * n as f64 - wetted).max(0.0));
            let dt = ages[1] - ages[0];
            if self.conductivity > 0.0 && dt > 0.0 {
                let middle = wetted + 0.5 * (ages[0] + ages[1]);
                let thinned =
                    (flow.powi(2) - 1.0) * impact.flows(largest, middle) / impact.age(middle);
                let next = (layer + dt) / (1.0 + thinned * dt);
                let over_rest = ((ages[0] + ages[1]) / (layer + next)).sqrt();
                root += self.contact(over_rest) * (ages[1].sqrt() - ages[0].sqrt());
                layer = next;
            }
            content * given_part(diffusivity * (root / thickness).powi(2))
        };
        (0..self.samples).map(until).collect()
    }

    /// Flux at contact relative to that of the same fluid at rest above a wall of prescribed
    /// temperature. `over_rest` is this ratio for the flow without warming of the wall.
    fn contact(&self, over_rest: f64) -> f64 {
        let capacity = self.impact.density * self.specific_heat;
        let own = over_rest * (self.conductivity * capacity).sqrt();
        over_rest * self.effusivity.map_or(1.0, |wall| wall / (wall + own))
    }

    /// Flux of a flow that has lasted forever, relative to that of fluid at rest.
    fn flow(&self) -> f64 {
        let prandtl = self.impact.viscosity * self.specific_heat / self.conductivity;
        flux_over_rest(prandtl.clamp(PRANDTL[0], PRANDTL[1]))
    }

    /// Impulse that the wall has received within a radius [N s].
    fn pushed_within(&self, radius: f64, largest: f64, time: f64) -> f64 {
        // The pressure of a stagnation flow below the drop is a paraboloid.
        let reach = self.impact.wetted_radius(largest, time).min(0.5 * self.impact.diameter);
        let inside = if reach > 0.0 { (radius / reach).min(1.0).powi(2) } else { 1.0 };
        1.0 - (1.0 - inside).powi(2)
    }
}

/// Computes the profile of a film.
pub fn film_profile(film: &Film) -> Profile {
    let impact = &film.impact;
    let largest = Film::largest_radius(impact);
    let heat_capacity = impact.density * impact.volume() * film.specific_heat;
    let width = film.radius / film.rings as f64;
    // Uniform over all circles that are ever wetted.
    let all = (0..film.rings).flat_map(|ring| circles(width, ring));
    let wetted: f64 = all.filter(|(at, _)| *at < largest).map(|(_, area)| area).sum();
    let thickness = impact.volume() / wetted;
    let flow = if film.conductivity > 0.0 { film.flow() } else { 1.0 };
    let heats: Vec<Vec<(f64, Vec<f64>)>> = (0..film.rings)
        .map(|ring| {
            let of_circle = |(at, area)| (area, film.heats((thickness, largest), flow, at));
            circles(width, ring).map(of_circle).collect()
        })
        .collect();
    let step = film.duration / film.samples as f64;
    let momentum = impact.momentum();
    let mut sums = vec![Amounts::default(); film.rings];
    let (mut amounts, mut spread) = (Vec::new(), Vec::new());
    for sample in 1..=film.samples {
        let (time, middle) = (step * sample as f64, step * (sample as f64 - 0.5));
        let pushed = impact.momentum_given(time) - impact.momentum_given(time - step);
        let flows = impact.flows(largest, middle);
        for (ring, sum) in sums.iter_mut().enumerate() {
            let [inner, outer] = [ring, ring + 1].map(|n| width * n as f64);
            let within = |radius: f64| film.pushed_within(radius, largest, middle);
            sum.push += momentum * pushed * (within(outer) - within(inner));
            sum.heat = heats[ring].iter().map(|(area, heat)| area * heat[sample - 1]).sum();
            for (at, area) in circles(width, ring) {
                if impact.time_of_wetting(largest, at) < middle {
                    sum.outward += step * area * flows * impact.shear(at, middle);
                }
            }
        }
        amounts.extend_from_slice(&sums);
        spread.push(2.0 * impact.wetted_radius(largest, time));
    }
    let Film { duration, rings, radius, .. } = *film;
    Profile {
        speed: impact.speed,
        heat_capacity,
        duration,
        rings,
        radius,
        amounts,
        spread,
        stray: 0.0,
    }
}

/// Radii [m] of the circles of a ring, and the area that belongs to each [m²].
fn circles(width: f64, ring: usize) -> impl Iterator<Item = (f64, f64)> {
    let [inner, outer] = [ring, ring + 1].map(|n| (width * n as f64).powi(2));
    let share = |circle: usize| (circle as f64 + 0.5) / CIRCLES as f64;
    let at = move |circle: usize| (inner + share(circle) * (outer - inner)).sqrt();
    (0..CIRCLES).map(move |circle| (at(circle), PI * (outer - inner) / CIRCLES as f64))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closed_form::{Conductor, Contact};

    fn film() -> Film {
        let impact = DropImpact {
            diameter: 1e-4,
            speed: 20.0,
            density: 1000.0,
            viscosity: 1e-3,
            surface_tension: 0.07,
            contact_angle: 1.57,
        };
        Film {
            impact,
            specific_heat: 4180.0,
            conductivity: 0.6,
            effusivity: Some(5963.0),
            duration: 2.5e-5,
            samples: 200,
            rings: 24,
            radius: 1.05 * Film::largest_radius(&impact),
        }
    }

    #[test]
    fn momentum_is_complete_and_heat_is_bounded() {
        let film = film();
        let profile = film_profile(&film);
        let end = profile.at(film.duration);
        let pushed: f64 = end.iter().map(|ring| ring.push).sum();
        // The force at the end is 1.4e-6 of its total.
        let part = film.impact.momentum_given(film.duration);
        assert!((pushed / film.impact.momentum() - part).abs() < 1e-12 && part > 1.0 - 1e-5);
        let heat: f64 = end.iter().map(|ring| ring.heat).sum();
        assert!(heat > 0.0 && heat < profile.heat_capacity);
        profile.check().unwrap();
        let all = heat + profile.tail().unwrap().heat(1e9);
        assert!((all / profile.heat_capacity - 1.0).abs() < 1e-12);
    }

    /// At first the flux in the middle is that between two half spaces.
    #[test]
    fn initial_flux_is_that_of_two_half_spaces() {
        let film = Film { duration: 1e-7, ..film() };
        let profile = film_profile(&film);
        let contact = Contact {
            first: Conductor { conductivity: 0.6, heat_capacity: 4.18e6 },
            first_temperature: 1.0,
            second: Conductor { conductivity: 10.0, heat_capacity: 3950.0 * 900.0 },
            second_temperature: 0.0,
        };
        let found = film.heats((1e-6, 1e-4), film.flow(), 0.0)[199];
        let exact = contact.heat(1e-7);
        // By then the flow has thinned its layer a little.
        assert!((0.999..1.02).contains(&(found / exact)), "{found} {exact}");
        assert!(profile.at(1e-7)[0].heat < found * PI * (film.radius / 24.0).powi(2));
    }

    /// A wall of prescribed temperature under a flow without end: `D = (T/m)(1 − (T₀/T)^m)`, T
    /// = t + τ, m = f².
    #[test]
    fn persistent_flow_matches_closed_form() {
        let film = Film { effusivity: None, samples: 2000, ..film() };
        let (flow, far) = (film.flow(), 1e3);
        let square = flow.powi(2);
        for at in [0.0, 4e-5] {
            let start = film.impact.age(film.impact.time_of_wetting(far, at));
            let end = film.impact.age(film.duration);
            // Divided by √(T − T₀), which leaves no infinite value.
            let (count, whole) = (20_000, (end - start).sqrt());
            let integral: f64 = (0..count)
                .map(|n| {
                    let root = whole * (f64::from(n) + 0.5) / f64::from(count);
                    let age = start + root * root;
                    let layer = age / square * -(square * (start / age).ln()).exp_m1();
                    2.0 * root / layer.sqrt() * whole / f64::from(count)
                })
                .sum();
            let effusivity = (0.6 * 4.18e6_f64).sqrt();
            let exact = effusivity * integral / PI.sqrt();
            // Thick enough not to cool through.
            let found = film.heats((1e-3, far), flow, at)[1999];
            assert!((found / exact - 1.0).abs() < 2e-3, "{at}: {found} {exact}");
        }
    }
}
