use super::super::freezing_flux::freezing_flux;
use super::*;
use crate::closed_form::{Conductor, FreezingColumn, FreezingContact};
use crate::math::exponential;
use crate::port::SurfaceResponse;

const LATTICE: (Kernel, f64, usize) = (Kernel::WendlandC2, 3.0, 3);
/// Tin released at 505 K, 513 K and 600 K, water, and an alloy with a range, above their release.
const TIN: Phases =
    Phases { melting: [0.0, 0.0], latent: 59e3 / 244.0, heat: 1.0, conduction: 62.0 / 33.0 };
const WARM_TIN: Phases = Phases { melting: [-8.0, -8.0], ..TIN };
const HOT_TIN: Phases = Phases { melting: [-95.0, -95.0], ..TIN };
const WATER: Phases = Phases {
    melting: [-6.85, -6.85],
    latent: 334e3 / 4190.0,
    heat: 2050.0 / 4190.0,
    conduction: 2.2 / 0.57,
};
const ALLOY: Phases =
    Phases { melting: [-44.0, -7.0], latent: 45e3 / 210.0, heat: 180.0 / 210.0, conduction: 2.0 };
/// Effusivity of steel over that of molten tin.
const STEEL: f64 = 1.000_18;

fn law(phases: &Phases) -> FreezingLaw {
    FreezingLaw::of(LATTICE, phases, &[0.0])
}

/// Layers of fluid, released with a content of 0, that conduct by the method's sums.
struct Layers {
    phases: Phases,
    couplings: Vec<f64>,
    contents: Vec<f64>,
    time: f64,
}

impl Layers {
    fn new(phases: &Phases, count: usize) -> Self {
        let couplings = couplings(LATTICE.0, LATTICE.1, LATTICE.2);
        Self { phases: *phases, couplings, contents: vec![0.0; count], time: 0.0 }
    }

    fn advance(&mut self, step: f64, lost: f64) {
        let potential = |content: &f64| self.phases.potential(*content);
        let potentials: Vec<f64> = self.contents.iter().map(potential).collect();
        let reach = 8.0 * (self.time * self.phases.fastest()).sqrt() + 8.0;
        for layer in 0..(reach as usize).min(self.contents.len()) {
            let from = |(n, coupling): (usize, &f64)| {
                let distance = n + 1;
                let below = if layer >= distance { layer - distance } else { distance - layer - 1 };
                let above = potentials.get(layer + distance).copied().unwrap_or(0.0);
                coupling * (potentials[below] + above - 2.0 * potentials[layer])
            };
            let rate: f64 = self.couplings.iter().enumerate().map(from).sum();
            self.contents[layer] += step * rate;
        }
        self.contents[0] -= lost;
        self.time += step;
    }

    fn front(&self) -> f64 {
        self.contents.iter().map(|&content| self.phases.frozen(content)).sum()
    }
}

/// A half space below the layers.
struct Wall {
    response: SurfaceResponse,
    amplitudes: Vec<f64>,
    weights: Vec<[f64; exponential::COUNT]>,
    step: f64,
    temperature: f64,
    /// Fluid's and wall's part of the resistance.
    parts: [f64; 2],
}

impl Wall {
    fn new(temperature: f64, effusivity: f64, parts: [f64; 2], step: f64, end: f64) -> Self {
        let response = SurfaceResponse::of_half_space(effusivity, [0.1 * step, 10.0 * end]);
        let weights = response.rates.iter().map(|rate| exponential::weights(rate * step)).collect();
        let amplitudes = vec![0.0; response.len()];
        Self { response, amplitudes, weights, step, temperature, parts }
    }

    /// Exchanges the heat of a step with the layers; returns it, and the wall's temperature.
    fn exchange(&mut self, law: &FreezingLaw, layers: &Layers) -> (f64, f64) {
        let decayed = self.amplitudes.iter().zip(&self.weights).map(|(a, w)| a * w[0]);
        let free = self.temperature + decayed.sum::<f64>();
        let held = self.response.of_held_flux(self.step) / self.step;
        let falling = self.response.of_falling_flux(self.step) / self.step;
        let (mut surface, mut lost) = (free, Lost::default());
        for _ in 0..6 {
            let at = Contents { before: 0.0, fluid: layers.contents[0], wall: surface };
            lost = law.loss(at, self.step, self.parts);
            let slope = law.slope(at, self.step, self.parts, lost);
            let rise = held + lost.fall * falling;
            let fixed = lost.content + slope * surface;
            surface = (free + rise * fixed) / (1.0 + rise * slope);
        }
        let terms = self.amplitudes.iter_mut().zip(&self.response.gains).zip(&self.weights);
        for ((amplitude, gain), w) in terms {
            let mean = w[1] + lost.fall * (w[1] - 2.0 * w[2]);
            *amplitude = w[0] * *amplitude + gain * lost.content * mean;
        }
        (lost.content, surface)
    }
}

/// Largest errors of the heat relative to that of a half space at constant surface temperature, while the front is
/// in the first layer, in the next two, and beyond.
fn errors(phases: &Phases, surface: f64, most: f64) -> [f64; 3] {
    let (law, mut layers) = (law(phases), Layers::new(phases, 120));
    let exact = freezing_flux(phases, 0.0, surface);
    let (mut heat, mut found) = (0.0, [0.0; 3]);
    while layers.front() < most {
        let step = (0.1 * layers.time).clamp(1e-8, 0.005);
        let at = Contents { before: 0.0, fluid: layers.contents[0], wall: surface };
        let lost = law.loss(at, step, [0.0; 2]).content;
        layers.advance(step, lost);
        heat += lost;
        let error = heat / (2.0 * exact * layers.time.sqrt()) - 1.0;
        let part = [1.0, 3.0].iter().filter(|&&edge| layers.front() >= edge).count();
        found[part] = f64::max(found[part], error.abs());
    }
    found
}

#[test]
fn skins_thinner_than_particles_conduct_like_half_spaces() {
    let cases: [(&Phases, &[f64]); 5] = [
        (&TIN, &[-207.0, -82.0, -5.0]),
        (&WARM_TIN, &[-215.0, -13.0]),
        (&HOT_TIN, &[-302.0, -177.0]),
        (&WATER, &[-107.0, -30.0]),
        (&ALLOY, &[-200.0, -50.0, -30.0]),
    ];
    for (phases, surfaces) in cases {
        for &surface in surfaces {
            let [thin, ..] = errors(phases, surface, 0.95);
            assert!(thin < 5e-3, "{phases:?} {surface}: {thin}");
        }
    }
}

#[test]
fn steps_of_whole_layers_leave_no_lasting_error() {
    for (phases, surface) in [(&TIN, -207.0), (&WARM_TIN, -90.0), (&ALLOY, -200.0)] {
        let [_, next, later] = errors(phases, surface, 6.0);
        assert!(next < 0.06 && later < 0.016, "{phases:?} {surface}: {next} {later}");
    }
}

#[test]
fn tin_on_steel_has_the_temperature_and_front_of_two_half_spaces() {
    // Contact temperature and λ of 298.15 K and 423.15 K, and 505 K and 513 K.
    let cases = [
        (&TIN, -206.85, -36.81, 0.269269),
        (&WARM_TIN, -214.85, -43.21, 0.254518),
        (&TIN, -81.85, -7.58, 0.124516),
        (&WARM_TIN, -89.85, -14.79, 0.110241),
    ];
    for (phases, wall, contact, growth) in cases {
        let (law, mut layers) = (law(phases), Layers::new(phases, 40));
        let (step, end) = (5e-3, 1.0);
        let mut wall = Wall::new(wall, STEEL, [0.0; 2], step, end);
        let (mut heat, mut surface) = (0.0, 0.0);
        while layers.time < end {
            let (lost, rise) = wall.exchange(&law, &layers);
            layers.advance(step, lost);
            (heat, surface) = (heat + lost, rise);
        }
        let exact = 2.0 * STEEL * (contact - wall.temperature) * (end / PI).sqrt();
        assert!((heat / exact - 1.0).abs() < 5e-3, "{heat} {exact}");
        assert!((surface - contact).abs() < 0.3, "{surface} {contact}");
        let front = 2.0 * growth * (phases.conduction * end).sqrt();
        assert!((layers.front() - front).abs() < 0.1, "{} {front}", layers.front());
    }
}

#[test]
fn resistive_contacts_transfer_the_heat_of_an_enthalpy_column() {
    for (phases, wall, parts) in
        [(&TIN, -206.85, 0.18), (&WARM_TIN, -214.85, 0.2), (&ALLOY, -200.0, 0.25)]
    {
        let law = law(phases);
        for biot in [1e-3, 1e-1, 1.0, 10.0, 1e3] {
            let parts = [parts / biot, (1.0 - parts) / biot];
            let (step, end) = (5e-3, 0.3);
            let mut layers = Layers::new(phases, 40);
            let mut below = Wall::new(wall, STEEL, parts, step, end);
            let mut heat = 0.0;
            while layers.time < end - 0.5 * step {
                let (lost, _) = below.exchange(&law, &layers);
                layers.advance(step, lost);
                heat += lost;
            }
            let body = |conductivity, heat_capacity| Conductor { conductivity, heat_capacity };
            let column = FreezingColumn {
                bodies: FreezingContact {
                    wall: body(STEEL, STEEL),
                    frozen: body(phases.conduction, phases.heat),
                    molten: body(1.0, 1.0),
                    latent: phases.latent,
                    melts_at: phases.melting[1],
                    wall_temperature: wall,
                    fluid_temperature: 0.0,
                },
                solidus: phases.melting[0],
                conductance: biot,
                wall_thickness: 4.0,
                fluid_thickness: 8.0,
                cells: 150,
            };
            let exact = column.run(end, 150)[149].heat;
            assert!((heat / exact - 1.0).abs() < 0.012, "{wall} {biot}: {heat} {exact}");
        }
    }
}

#[test]
fn molten_fluid_obeys_the_law_of_contact() {
    let law = law(&HOT_TIN);
    for (fluid, wall) in [(-1.0, -90.0), (-30.0, -90.0), (-60.0, -61.0), (-20.0, 30.0)] {
        let at = Contents { before: 0.0, fluid, wall };
        let deficit = Some(-fluid / -wall);
        let exact = law.contact.relaxation(deficit, 0.02) * (fluid - wall);
        assert_eq!(law.loss(at, 0.02, [0.0; 2]).content, exact);
    }
}

#[test]
fn steps_end_at_the_content_at_the_wall_at_most() {
    for phases in [&TIN, &WARM_TIN, &WATER, &ALLOY] {
        let law = law(phases);
        for wall in [-300.0, -46.0, -20.0, -8.0, -1.0, 20.0] {
            for fluid in [-400.0, -260.0, -100.0, -20.0, -1.0, 0.0, 10.0] {
                for parts in [[0.0; 2], [1e-3; 2], [1.0, 0.0], [1e3; 2]] {
                    let gap = phases.potential(fluid) - law.potential(wall);
                    let mut before = 0.0;
                    for diffusion in [1e-9, 1e-3, 0.1, 1.0, 1e3] {
                        let at = Contents { before: 0.0, fluid, wall };
                        let lost = law.loss(at, diffusion, parts);
                        let left = phases.potential(fluid - lost.content) - law.potential(wall);
                        let name = format!("{phases:?} {at:?} {parts:?} {diffusion} {lost:?}");
                        assert!(lost.content * gap >= 0.0, "{name}");
                        assert!(left * gap >= -1e-9 * gap * gap, "{name}");
                        assert!(lost.content.abs() >= before * (1.0 - 1e-5), "{name}");
                        assert!((0.0..0.65).contains(&lost.fall), "{name}");
                        before = lost.content.abs();
                    }
                }
            }
        }
    }
}

#[test]
fn hot_wall_melts_a_frozen_layer_in_two_phases_and_a_plateau() {
    let law = law(&WARM_TIN);
    let [frozen, molten] = WARM_TIN.contents();
    let at = Contents { before: 0.0, fluid: frozen - 50.0, wall: 20.0 };
    // The potential rises exponentially, rests at the melting point, and rises again.
    let drops = [28.0 + 50.0 * WARM_TIN.conduction, 28.0, 14.0].map(|drop| law.decay * drop);
    let times = [
        (drops[0] / drops[1]).ln() / (law.decay * WARM_TIN.conduction),
        (molten - frozen) / drops[1],
        (drops[1] / drops[2]).ln() / law.decay,
    ];
    let all = -law.loss(at, times.iter().sum(), [0.0; 2]).content;
    assert!((at.fluid + all - (molten + 14.0)).abs() < 1e-9, "{all}");
    let half = -law.loss(at, times[0] + 0.5 * times[1], [0.0; 2]).content;
    assert!((at.fluid + half - 0.5 * (frozen + molten)).abs() < 1e-9, "{half}");
}

/// Contacts begin anew where fluid is hotter than at its release above a colder wall, or, molten, colder above a hotter
/// one; not within the range of a contact, nor by rounding.
#[test]
fn contacts_begin_anew_beyond_the_content_of_release() {
    let (phases, law) = (WARM_TIN, law(&WARM_TIN));
    let begins = |fluid: f64, wall: f64, resistances: [f64; 2]| {
        law.begins_anew(Contents { before: 0.0, fluid, wall }, resistances)
    };
    for resistances in [[0.0; 2], [0.3, 0.1]] {
        for wall in [-1e-3, -5.0, -8.0, -60.0] {
            assert!(begins(40.0, wall, resistances), "{wall}");
            assert!(!begins(1e-9, wall, resistances), "{wall}");
            let end = phases.content(wall);
            for part in [0.0, 0.1, 0.5, 1.0] {
                assert!(!begins(part * end, wall, resistances), "{part} of {wall}");
            }
        }
        for part in [0.0, 0.5, 1.0] {
            assert!(!begins(part * 40.0, 40.0, resistances), "{part}");
        }
    }
    assert!(begins(-5.0, 40.0, [0.0; 2]));
    // A frozen layer has a uniform temperature.
    assert!(!begins(phases.content(-20.0), 40.0, [0.0; 2]));
}
