//! A profile from closed forms: a footprint that grows to the width of published correlations, a force that gives all
//! momentum, and from the time at which each place is wetted the flux of two half spaces, of which the one spreads over
//! the other, as far as the heat of the film above it goes.

use std::f64::consts::PI;

use super::profile::{Amounts, Profile};
use crate::closed_form::cooling_film::given_part;
use crate::closed_form::{DropImpact, flux_over_rest};

/// What a film follows from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Film {
    pub impact: DropImpact,
    /// c [J/(kg K)] and k [W/(m K)] of the fluid.
    pub specific_heat: f64,
    pub conductivity: f64,
    /// √(kρc) of the wall [W √s/(m² K)]; nothing for one that is held at its temperature.
    pub effusivity: Option<f64>,
    /// [s]
    pub duration: f64,
    pub samples: usize,
    pub rings: usize,
    /// Of the outermost ring, no less than the film's [m].
    pub radius: f64,
}

/// Least and largest Prandtl number: the flux hardly depends on it beyond.
const PRANDTL: [f64; 2] = [1e-6, 1e4];
/// Circles of a ring on which the time of wetting is looked at.
const CIRCLES: usize = 8;

impl Film {
    /// Largest radius of the footprint [m].
    pub fn largest_radius(impact: &DropImpact) -> f64 {
        0.5 * impact.diameter * impact.largest_spread()
    }

    /// Part of its heat that the film at a place has given so long after this was wetted [s].
    fn cooled(&self, thickness: f64, contact: f64, time: f64) -> f64 {
        let DropImpact { density, .. } = self.impact;
        let diffusivity = self.conductivity / (density * self.specific_heat);
        given_part(contact.powi(2) * diffusivity * time / thickness.powi(2))
    }

    /// Flux at first contact over that of the same fluid at rest above a wall that is held: the flow towards the wall
    /// keeps the thermal layer thin, and the wall warms up.
    fn contact(&self) -> f64 {
        let DropImpact { density, viscosity, .. } = self.impact;
        let prandtl = viscosity * self.specific_heat / self.conductivity;
        let flow = flux_over_rest(prandtl.clamp(PRANDTL[0], PRANDTL[1]));
        let own = flow * (self.conductivity * density * self.specific_heat).sqrt();
        flow * self.effusivity.map_or(1.0, |wall| wall / (wall + own))
    }

    /// What the wall has got within a radius [N s].
    fn pushed_within(&self, radius: f64, largest: f64, time: f64) -> f64 {
        // A stagnation flow presses as a paraboloid on what is below the drop.
        let reach = self.impact.wetted_radius(largest, time).min(0.5 * self.impact.diameter);
        let inside = if reach > 0.0 { (radius / reach).min(1.0).powi(2) } else { 1.0 };
        1.0 - (1.0 - inside).powi(2)
    }
}

/// The profile of a film.
pub fn film_profile(film: &Film) -> Profile {
    let impact = &film.impact;
    let largest = Film::largest_radius(impact);
    let heat_capacity = impact.density * impact.volume() * film.specific_heat;
    let width = film.radius / film.rings as f64;
    // Even over all circles that are ever wetted.
    let all = (0..film.rings).flat_map(|ring| circles(width, ring));
    let wetted: f64 = all.filter(|(at, _)| *at < largest).map(|(_, area)| area).sum();
    let thickness = impact.volume() / wetted;
    let contact = if film.conductivity > 0.0 { film.contact() } else { 0.0 };
    let step = film.duration / film.samples as f64;
    let momentum = impact.momentum();
    let mut sums = vec![Amounts::default(); film.rings];
    let (mut amounts, mut spread) = (Vec::new(), Vec::new());
    for sample in 1..=film.samples {
        let (time, middle) = (step * sample as f64, step * (sample as f64 - 0.5));
        let pushed = impact.momentum_given(time) - impact.momentum_given(time - step);
        // The flow has come to rest where the footprint has.
        let flows = 1.0 - (impact.wetted_radius(largest, middle) / largest).powi(2);
        for (ring, sum) in sums.iter_mut().enumerate() {
            let [inner, outer] = [ring, ring + 1].map(|n| width * n as f64);
            let within = |radius: f64| film.pushed_within(radius, largest, middle);
            sum.push += momentum * pushed * (within(outer) - within(inner));
            sum.heat = 0.0;
            for (at, area) in circles(width, ring) {
                let wetted = impact.time_of_wetting(largest, at);
                sum.heat += heat_of(film, [thickness, contact], (area, time - wetted));
                if wetted < middle {
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

/// Heat that the film has given to an area [m²] so long after this was wetted, for each kelvin [J/K].
fn heat_of(film: &Film, [thickness, contact]: [f64; 2], (area, time): (f64, f64)) -> f64 {
    if film.conductivity == 0.0 || time <= 0.0 {
        return 0.0;
    }
    let content = film.impact.density * film.specific_heat * thickness * area;
    content * film.cooled(thickness, contact, time)
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
    fn all_momentum_is_given_and_no_more_heat_than_there_is() {
        let film = film();
        let profile = film_profile(&film);
        let end = profile.at(film.duration);
        let pushed: f64 = end.iter().map(|ring| ring.push).sum();
        // What is left of the force at the end is 1.4e-6 of it all.
        let part = film.impact.momentum_given(film.duration);
        assert!((pushed / film.impact.momentum() - part).abs() < 1e-12 && part > 1.0 - 1e-5);
        let heat: f64 = end.iter().map(|ring| ring.heat).sum();
        assert!(heat > 0.0 && heat < profile.heat_capacity);
        profile.check().unwrap();
        let all = heat + profile.tail().unwrap().heat(1e9);
        assert!((all / profile.heat_capacity - 1.0).abs() < 1e-12);
    }

    /// At first the middle gives what two half spaces exchange.
    #[test]
    fn the_middle_begins_as_two_half_spaces() {
        let film = Film { duration: 2e-6, ..film() };
        let profile = film_profile(&film);
        let flow = flux_over_rest(1e-3 * 4180.0 / 0.6);
        let contact = Contact {
            // Which spreads: as if of a higher effusivity.
            first: Conductor { conductivity: 0.6 * flow * flow, heat_capacity: 4.18e6 },
            first_temperature: 1.0,
            second: Conductor { conductivity: 10.0, heat_capacity: 3950.0 * 900.0 },
            second_temperature: 0.0,
        };
        let area = PI * (film.radius / 24.0).powi(2);
        let found = profile.at(1e-6)[0].heat / area;
        let exact = contact.heat(1e-6);
        assert!((found / exact - 1.0).abs() < 1e-2, "{found} {exact}");
    }
}
