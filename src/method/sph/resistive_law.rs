//! Rate at which the layer of particles at a wall approaches a temperature beyond a thermal
//! resistance.

use std::f64::consts::PI;

use super::contact_law::{SHORTEST, THICK, couplings, deficits_under, effusivity};
use crate::closed_form::special::erfcx;
use crate::kernel::Kernel;
use crate::port::SurfaceResponse;

/// Cooling of the particles at a wall through a thermal resistance, for thermal layers thinner and
/// thicker than the particle layer.
///
/// Fluid of temperature T∞ that meets a place of constant temperature T_c through a conductance h
/// loses the flux `h (T∞ − T_c) exp(y²) erfc(y)`, `y = h √(t/kρc)` (H. S. Carslaw and J. C. Jaeger,
/// *Conduction of Heat in Solids*, Oxford 1959, §2.7). With `θ = (T∞ − T)/(T∞ − T_c)` of the
/// particle layer's temperature T, as in [`ContactLaw`](super::contact_law::ContactLaw), and its
/// Biot number `β = hδ/k`, the flux is that of two resistances in series,
///
/// `dθ/dt = κ/δ² (1 − θ)/(1/β + r(θ, β))`.
///
/// r is the resistance over δ/k between the fluid's surface and the particle layer: 0 at first
/// contact, 1/2C once the temperature is uniform across the layer. It is computed on the lattice of
/// `ContactLaw` under the flux above, for some Biot numbers.
///
/// **Two half spaces.** Of two half spaces of effusivities e₁ and e₂ in resistive contact, one plane
/// within the resistance keeps the temperature of perfect contact. It divides the resistance as
/// e₂ : e₁. So the fluid obeys the law with its part of the resistance, and the wall has the other
/// part in series with its own response, without further approximations.
#[derive(Debug, Clone, PartialEq)]
pub struct ResistiveLaw {
    /// h Δx/k.
    biot: f64,
    /// `1/h` [m² K/W] and effusivity of the fluid [W √s/(m² K)].
    resistance: f64,
    effusivity: f64,
    deficits: Vec<f64>,
    /// r at the deficits, for each of [`biots`].
    tables: Vec<Vec<f64>>,
}

/// The law above a surface: its resistance divided between fluid and wall.
#[derive(Debug, Clone, PartialEq)]
pub struct Resistance {
    /// Pairs of θ and r, at the Biot number of a full layer.
    places: Vec<[f64; 2]>,
    /// Inverse Biot numbers of the parts of the resistance at the fluid and at the wall, for a layer
    /// of thickness Δx.
    fluid: f64,
    wall: f64,
}

/// Temperatures that determine the heat of a layer [K].
#[derive(Debug, Clone, Copy)]
pub struct Temperatures {
    pub before: f64,
    pub fluid: f64,
    pub wall: f64,
}

/// Heat of a layer during a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Loss {
    /// Fraction of the difference between the layer and the wall that the layer loses, between 0 and
    /// 1.
    pub part: f64,
    /// Linear decrease of the flux, from 1 + `fall` to 1 − `fall` of its mean, with the same rise of
    /// a half space at the end.
    pub fall: f64,
}

/// Decimal logarithms of the first and last tabulated Biot number, and tables per decade. Below the
/// first a layer's own resistance hardly matters; the last but one hardly has a resistance, and the
/// last has none.
const DECADES: [i32; 2] = [-3, 4];
const PER_DECADE: i32 = 2;
const PERFECT: f64 = 1e6;
/// Diffusion time after which r no longer changes.
const SETTLED: f64 = 130.0;
/// Ratio of two early times of the tables, and number of those before the lattice's first step.
const SOONER: f64 = 0.7;
const EARLY: i32 = 60;
/// First place of the tables, and largest distances to the next relative to θ and to 1 − θ.
const FIRST: f64 = 1e-8;
const GROWTH: f64 = 0.1;
const APPROACH: f64 = 0.02;
/// Number of halvings of the logarithm of time in the search for the time of crossing; its range.
const HALVINGS: usize = 60;
const RANGE: f64 = 70.0;
/// Number of steps of the search for the temperature within the resistance, and its relative
/// accuracy.
const STEPS: usize = 40;
const ACCURACY: f64 = 1e-9;
/// A flux like 1/√t ends at half its mean, and has the `fall` 3 (1 − π/4) = 0.644, not 0.5.
const SINGULAR: f64 = 0.5752;

impl ResistiveLaw {
    /// Law for a kernel of support radius `support` over Δx. `biot` is hΔx/k, `resistance` 1/h
    /// [m² K/W] and `effusivity` the fluid's [W √s/(m² K)].
    pub fn of(
        (kernel, support, dimension): (Kernel, f64, usize),
        [biot, resistance, effusivity]: [f64; 3],
    ) -> Self {
        let couplings = couplings(kernel, support, dimension);
        let deficits = deficits();
        let tables = biots().map(|biot| table(&couplings, biot, &deficits)).collect();
        Self { biot, resistance, effusivity, deficits, tables }
    }

    /// Divides the resistance above a surface.
    ///
    /// The surface counts as a half space of the effusivity that it shows at the time at which the
    /// thermal layers of fluid and wall together resist as much as the contact.
    pub fn above(&self, response: &SurfaceResponse) -> Resistance {
        let root_pi = PI.sqrt();
        let of_wall = |time: f64| 0.5 * root_pi * response.of_held_flux(time);
        let of_fluid = |time: f64| time.sqrt() / self.effusivity;
        let longest = 2.0 * (self.effusivity * self.resistance).ln();
        let mut range = [longest - RANGE, longest];
        for _ in 0..HALVINGS {
            let middle = 0.5 * (range[0] + range[1]);
            let time = middle.exp();
            let side = usize::from(of_fluid(time) + of_wall(time) > self.resistance);
            range[side] = middle;
        }
        let time = range[1].exp();
        let ratio = of_wall(time) / of_fluid(time);
        let [at_fluid, at_wall] = [1.0, ratio].map(|part| part / (1.0 + ratio));
        Resistance {
            places: self.places(self.biot / at_fluid),
            fluid: at_fluid / self.biot,
            wall: at_wall / self.biot,
        }
    }

    /// r at a Biot number, interpolated along its logarithm.
    fn places(&self, biot: f64) -> Vec<[f64; 2]> {
        let biots: Vec<f64> = biots().collect();
        let above = biots.partition_point(|&known| known < biot).clamp(1, biots.len() - 1);
        let [low, high] = [biots[above - 1], biots[above]].map(f64::ln);
        let share = ((biot.ln() - low) / (high - low)).clamp(0.0, 1.0);
        let mean = |n: usize| {
            let [a, b] = [above - 1, above].map(|table| self.tables[table][n]);
            [self.deficits[n], a + share * (b - a)]
        };
        (0..self.deficits.len()).map(mean).collect()
    }
}

impl Resistance {
    /// Parts of the resistance at the fluid and at the wall over δ/k, for a layer of thickness δ over Δx.
    pub fn parts(&self, thickness: f64) -> [f64; 2] {
        [self.fluid, self.wall].map(|inverse| inverse / thickness)
    }

    /// Heat that a layer of thickness δ, over Δx, loses during a diffusion time `κΔt/δ²`.
    ///
    /// One temperature T_c within the resistance serves both sides: the fluid approaches it by the
    /// law, and at the end the flux passes the wall's part of the resistance.
    pub fn loss(&self, at: Temperatures, diffusion: f64, thickness: f64) -> Loss {
        let [inverse, wall] = self.parts(thickness);
        let Temperatures { before, fluid, wall: far } = at;
        // `part` is (T_c − T_w)/(T − T_w); losses and fluxes are over T − T_w.
        let found = |part: f64| {
            let deficit = (before - fluid) / (before - far - part * (fluid - far));
            let deficit = Some(deficit).filter(|deficit| deficit.is_finite());
            let (lost, resistance) = self.towards(deficit, diffusion, inverse);
            [lost, (1.0 - lost) / resistance].map(|amount| (1.0 - part) * amount)
        };
        let part = match wall > 0.0 {
            true => root(|part| found(part)[1] * wall - part),
            false => 0.0,
        };
        let [lost, flux] = found(part);
        // At first contact the flux falls like 1/√t, from which the line differs.
        let fallen = match lost > 0.0 {
            true => (1.0 - flux * diffusion / lost).clamp(0.0, 0.5),
            false => 0.0,
        };
        Loss { part: lost, fall: fallen * (1.0 + SINGULAR * fallen) }
    }

    /// Fraction of the difference between the layer and a constant temperature that the layer loses
    /// through a resistance `inverse` over δ/k, and the whole resistance at the end.
    fn towards(&self, deficit: Option<f64>, diffusion: f64, inverse: f64) -> (f64, f64) {
        let slowness = |[deficit, r]: [f64; 2]| (inverse + r) / (1.0 - deficit);
        let last = self.places[self.places.len() - 1];
        let before = deficit.unwrap_or(f64::INFINITY).clamp(0.0, last[0]);
        let (mut now, mut rest) = (before, diffusion);
        let next = self.places.partition_point(|place| place[0] <= before);
        for place in next..self.places.len() {
            let [a, b] = [self.places[place - 1], self.places[place]];
            let bend = (slowness(b) - slowness(a)) / (b[0] - a[0]);
            let here = slowness(a) + bend * (now - a[0]);
            let way = b[0] - now;
            let time = way * (here + 0.5 * bend * way);
            if time > rest {
                let then = (here * here + 2.0 * bend * rest).sqrt();
                let gain = 2.0 * rest / (here + then);
                let lost = (now - before + gain) / (1.0 - before);
                return (lost, then * (1.0 - now - gain));
            }
            (now, rest) = (b[0], rest - time);
        }
        let resistance = inverse + last[1];
        let decayed = -(-rest / resistance).exp_m1();
        ((now - before + (1.0 - now) * decayed) / (1.0 - before), resistance)
    }
}

/// Zero between 0 and 1 of a function that falls to −1: false position, which halves the value of
/// an end that stays.
fn root(of: impl Fn(f64) -> f64) -> f64 {
    let (mut ends, mut values) = ([0.0, 1.0], [of(0.0), -1.0]);
    let (mut place, mut stays) = (0.0, None);
    for _ in 0..STEPS {
        let share = values[0] / (values[0] - values[1]);
        place = ends[0] + share * (ends[1] - ends[0]);
        let value = of(place);
        let side = usize::from(value < 0.0);
        let moved = (place - ends[side]).abs();
        (ends[side], values[side]) = (place, value);
        if moved <= ACCURACY * place.min(1.0 - place) {
            break;
        }
        if stays == Some(1 - side) {
            values[1 - side] *= 0.5;
        }
        stays = Some(1 - side);
    }
    place
}

/// Tabulated Biot numbers.
fn biots() -> impl Iterator<Item = f64> {
    let [first, last] = DECADES.map(|decade| decade * PER_DECADE);
    let regular = (first..=last).map(|n| 10f64.powf(f64::from(n) / f64::from(PER_DECADE)));
    regular.chain([PERFECT])
}

/// Deficits of the tables, from 0 to [`THICK`].
fn deficits() -> Vec<f64> {
    let mut all = vec![0.0, FIRST];
    while all[all.len() - 1] < THICK {
        let last = all[all.len() - 1];
        let width = (GROWTH * last).min(APPROACH * (1.0 - last));
        all.push((last + width).min(THICK));
    }
    all
}

/// r at some deficits.
fn table(couplings: &[f64], biot: f64, deficits: &[f64]) -> Vec<f64> {
    let effusivity = effusivity(couplings);
    let place = |time: f64| biot * time.sqrt() / effusivity;
    let heat = |time: f64| effusivity.powi(2) / biot * passed(place(time));
    let flux = |time: f64| biot * erfcx(place(time));
    // Before the lattice's first step nothing leaves the lowest layer upward.
    let early = (1..=EARLY).rev().map(|n| SHORTEST * SOONER.powi(n));
    let early = early.map(|time| [heat(time), flux(time)]);
    let curve = early.chain(deficits_under(couplings, (heat, flux), SETTLED));
    let resistance = |[deficit, flux]: [f64; 2]| (1.0 - flux / biot - deficit) / flux;
    let known: Vec<[f64; 2]> =
        std::iter::once([0.0; 2]).chain(curve.map(|place| [place[0], resistance(place)])).collect();
    let at = |&deficit: &f64| {
        let above = known.partition_point(|place| place[0] < deficit).clamp(1, known.len() - 1);
        let [[a, low], [b, high]] = [known[above - 1], known[above]];
        low + (high - low) * ((deficit - a) / (b - a)).clamp(0.0, 1.0)
    };
    deficits.iter().map(at).collect()
}

/// `exp(y²) erfc(y) − 1 + 2y/√π`, the integral of the flux over time.
fn passed(y: f64) -> f64 {
    /// Below it, these terms of the series are accurate to 1e-9.
    const SMALL: f64 = 0.02;
    let root_pi = PI.sqrt();
    if y > SMALL {
        return erfcx(y) - 1.0 + 2.0 * y / root_pi;
    }
    let terms = [1.0, -4.0 / (3.0 * root_pi), 0.5, -8.0 / (15.0 * root_pi), 1.0 / 6.0];
    y * y * terms.into_iter().rev().fold(0.0, |sum, term| sum * y + term)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closed_form::{Conductor, Contact, ResistiveContact};
    use crate::math::exponential;

    const LATTICE: (Kernel, f64, usize) = (Kernel::WendlandC2, 3.0, 3);

    /// Law of a fluid of unit constants, on particles of unit distance.
    fn law(conductance: f64) -> ResistiveLaw {
        ResistiveLaw::of(LATTICE, [conductance, 1.0 / conductance, 1.0])
    }

    /// Errors of the heat that layers of such a fluid transfer to a half space by some times.
    fn errors(conductance: f64, wall: Option<f64>, step: f64, times: &[f64]) -> Vec<f64> {
        let response = wall.map_or(SurfaceResponse::default(), |effusivity| {
            SurfaceResponse::of_half_space(effusivity, [0.1 * step, 10.0 * times[times.len() - 1]])
        });
        let resistance = law(conductance).above(&response);
        let couplings = couplings(LATTICE.0, LATTICE.1, LATTICE.2);
        let medium =
            |effusivity: f64| Conductor { conductivity: effusivity, heat_capacity: effusivity };
        let bodies = Contact {
            first: medium(1.0),
            first_temperature: 1.0,
            second: medium(wall.unwrap_or(1e30)),
            second_temperature: 0.0,
        };
        let exact = ResistiveContact { bodies, conductance };
        let weights: Vec<_> =
            response.rates.iter().map(|rate| exponential::weights(rate * step)).collect();
        let [held, falling] =
            [response.of_held_flux(step), response.of_falling_flux(step)].map(|rise| rise / step);
        let (mut layers, mut amplitudes) = ([1.0; 100], vec![0.0; response.len()]);
        let (mut heat, mut taken) = (0.0, 0);
        let mut until = |time: f64| {
            while taken < (time / step).round() as usize {
                let decayed = amplitudes.iter().zip(&weights).map(|(a, w)| a * w[0]);
                let free: f64 = decayed.sum();
                let (mut surface, mut loss) = (free, Loss { part: 0.0, fall: 0.0 });
                for _ in 0..6 {
                    let at = Temperatures { before: 1.0, fluid: layers[0], wall: surface };
                    loss = resistance.loss(at, step, 1.0);
                    let rise = loss.part * (held + loss.fall * falling);
                    surface = (free + rise * layers[0]) / (1.0 + rise);
                }
                let given = loss.part * (layers[0] - surface);
                for ((amplitude, gain), w) in
                    amplitudes.iter_mut().zip(&response.gains).zip(&weights)
                {
                    let mean = w[1] + loss.fall * (w[1] - 2.0 * w[2]);
                    *amplitude = w[0] * *amplitude + gain * given * mean;
                }
                heat += given;
                layers[0] -= given;
                conduct(&mut layers, &couplings, step);
                taken += 1;
            }
            heat / exact.heat(time) - 1.0
        };
        times.iter().map(|&time| until(time)).collect()
    }

    /// Conducts between layers of a lattice, which the wall mirrors.
    fn conduct(layers: &mut [f64], couplings: &[f64], step: f64) {
        let rate = |layer: usize| {
            let from = |distance: usize, coupling: f64| {
                let below = if layer >= distance { layer - distance } else { distance - layer - 1 };
                let above = layers.get(layer + distance).copied().unwrap_or(1.0);
                coupling * (layers[below] + above - 2.0 * layers[layer])
            };
            couplings.iter().enumerate().map(|(n, &c)| from(n + 1, c)).sum::<f64>()
        };
        let rates: Vec<f64> = (0..layers.len()).map(rate).collect();
        layers.iter_mut().zip(rates).for_each(|(layer, rate)| *layer += step * rate);
    }

    #[test]
    fn half_spaces_exchange_their_heat_from_the_first_step() {
        for wall in [None, Some(100.0), Some(0.03)] {
            for conductance in [1e-3, 0.3, 3.0, 30.0, 1e9] {
                let errors = errors(conductance, wall, 1e-2, &[1e-2, 1e-1, 1.0, 10.0, 50.0]);
                let name = format!("{conductance} above {wall:?}: {errors:?}");
                assert!(errors.iter().all(|error| error.abs() < 5e-3), "{name}");
            }
        }
    }

    #[test]
    fn thermal_layers_much_thinner_than_particles_transfer_their_heat() {
        for wall in [None, Some(1.0), Some(0.03)] {
            for conductance in [1e-2, 1.0, 10.0, 1e3, 1e9] {
                let errors = errors(conductance, wall, 1e-4, &[1e-4, 1e-3, 1e-2, 1e-1]);
                let name = format!("{conductance} above {wall:?}: {errors:?}");
                assert!(errors.iter().all(|error| error.abs() < 1e-2), "{name}");
            }
        }
    }

    #[test]
    fn two_half_steps_equal_one_step() {
        for conductance in [1e-9, 1e-3, 1.0, 1e9] {
            let resistance = law(conductance).above(&SurfaceResponse::default());
            let inverse = 1.0 / conductance;
            for deficit in [0.0, 1e-3, 0.5, 0.94] {
                let of = |deficit, time| resistance.towards(Some(deficit), time, inverse).0;
                let once = of(deficit, 0.02);
                let first = of(deficit, 0.01);
                let middle = deficit + first * (1.0 - deficit);
                let both = first + (1.0 - first) * of(middle, 0.01);
                assert!((both / once - 1.0).abs() < 1e-6, "{conductance} {deficit}: {both} {once}");
            }
        }
    }

    #[test]
    fn losses_never_overshoot_the_wall() {
        for response in
            [SurfaceResponse::default(), SurfaceResponse::of_half_space(0.1, [1e-3, 1e3])]
        {
            for conductance in [1e-12, 1e-3, 1.0, 1e3, 1e12] {
                let resistance = law(conductance).above(&response);
                for before in [-2.0, 0.0, 0.5, 1.0, 1.0 + 1e-9, 3.0, 1e3] {
                    let at = Temperatures { before, fluid: 1.0, wall: 0.0 };
                    for diffusion in [1e-9, 1e-3, 0.1, 1.0, 1e3] {
                        let Loss { part, fall } = resistance.loss(at, diffusion, 0.8);
                        assert!((0.0..=1.0).contains(&part), "{part} {fall}");
                        assert!((0.0..0.65).contains(&fall), "{part} {fall}");
                        // The wall has its temperature at the end of the step, as the flux then.
                        let fallen =
                            ((1.0 + 4.0 * SINGULAR * fall).sqrt() - 1.0) / (2.0 * SINGULAR);
                        let most = conductance * 0.8 * diffusion * (1.0 + 1e-6);
                        assert!(fallen > 0.499 || part * (1.0 - fallen) <= most, "{part} {most}");
                    }
                }
            }
        }
    }

    #[test]
    fn layers_without_gradient_resist_as_in_perfect_contact() {
        let tables = law(1.0).tables;
        let last = |table: &Vec<f64>| table[table.len() - 1];
        let perfect = last(&tables[tables.len() - 1]);
        assert!(tables.iter().all(|table| (last(table) / perfect - 1.0).abs() < 0.01));
    }

    #[test]
    fn heat_passed_is_smooth_between_series_and_closed_form() {
        for y in [0.0199, 0.0201] {
            let exact = erfcx(y) - 1.0 + 2.0 * y / PI.sqrt();
            assert!((passed(y) / exact - 1.0).abs() < 1e-8, "{y}");
        }
    }
}
