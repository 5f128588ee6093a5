//! Heat of a segment: its contents and temperatures, and what it exchanges with what lies below it and with the air.
//!
//! A segment is a column of layers, each a fixed share of its volume, thinnest at its lower side. Each has a heat
//! content, and heat passes between their middles and from the lowest to what lies below. A step is implicit in the
//! temperatures, `C c' + Δt G T(c') = C c + …`. T is linear in c piece by piece, and Newton's method goes from kink to
//! kink, which always ends (J. Katzenelson 1965, doi 10.1002/j.1538-7305.1965.tb04195.x). Fluxes follow from the
//! temperatures found, so that heat balances however exact these are. A layer that is freezing has the front inside and
//! conducts with the mean of both phases.

use std::f64::consts::PI;

use crate::closed_form::cooling_film::given_part;
use crate::method::sph::Phases;

/// Number of layers of a segment.
pub const LAYERS: usize = 12;
/// Thickness of a layer over that of the layer below it.
const WIDENING: f64 = 1.25;
/// Shares of the layers in the volume, from below.
pub const SHARES: [f64; LAYERS] = shares();
/// Largest number of iterations.
const MOST_ITERATIONS: usize = 200;
/// Distance beyond a kink at which the next iteration begins [K].
const BEYOND: f64 = 1e-9;
/// Largest heat that passes in a step per kelvin over the capacity of a layer.
const LARGEST_LINK: f64 = 1e6;
/// Largest step over the relaxation time to the air that is made exact.
const LARGEST_RATIO: f64 = 3.0;
/// Fourier number from which on two terms of the series are exact to 1e-12.
const LATE: f64 = 0.3;

const fn shares() -> [f64; LAYERS] {
    let (mut shares, mut sum, mut n) = ([1.0; LAYERS], 1.0, 1);
    while n < LAYERS {
        shares[n] = WIDENING * shares[n - 1];
        sum += shares[n];
        n += 1;
    }
    while n > 0 {
        n -= 1;
        shares[n] /= sum;
    }
    shares
}

/// Heat of a fluid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Heat {
    /// Temperature of which the content is zero [K].
    pub reference: f64,
    /// Heat capacity per volume ρc of the molten fluid [J/(m³ K)].
    pub capacity: f64,
    /// Conductivity of the molten fluid [W/(m K)].
    pub conductivity: f64,
    pub phases: Option<Phases>,
}

/// Bodies with which a column of fluid exchanges heat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surroundings {
    /// Temperature below [K], the resistance to it [K/W] and the area of contact [m²].
    pub below: f64,
    pub resistance: f64,
    pub contact: f64,
    /// Temperature of the air [K], and conductances of the upper side and of the others to it [W/K].
    pub air: f64,
    pub above: f64,
    pub aside: f64,
}

/// A column of fluid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Column {
    /// [m³]
    pub volume: f64,
    /// [m]
    pub height: f64,
}

impl Heat {
    /// Heat capacity of a volume of molten fluid [J/K].
    pub fn capacity(&self, volume: f64) -> f64 {
        self.capacity * volume
    }

    /// Content over the heat capacity of the molten fluid [K], at a temperature [K].
    pub fn content_at(&self, temperature: f64) -> f64 {
        let rise = temperature - self.reference;
        self.phases.map_or(rise, |phases| phases.content(rise))
    }

    /// Temperature at a content [K].
    pub fn temperature(&self, content: f64) -> f64 {
        self.reference + self.phases.map_or(content, |phases| phases.rise(content))
    }

    pub fn frozen(&self, content: f64) -> f64 {
        self.phases.map_or(0.0, |phases| phases.frozen(content))
    }

    /// Change of the temperature with the content.
    fn slope(&self, content: f64) -> f64 {
        let Some(phases) = self.phases else { return 1.0 };
        let ([frozen, molten], [solidus, liquidus]) = (phases.contents(), phases.melting);
        match content {
            c if c >= molten => 1.0,
            c if c <= frozen => 1.0 / phases.heat,
            _ => (liquidus - solidus) / (molten - frozen),
        }
    }

    /// Conductivity at a content [W/(m K)].
    pub fn conductivity(&self, content: f64) -> f64 {
        let ratio = self.phases.map_or(1.0, |phases| phases.conduction);
        self.conductivity * (1.0 + self.frozen(content) * (ratio - 1.0))
    }

    /// Contents of the layers of a volume [K], from their heat [J].
    pub fn contents(&self, heats: &[f64; LAYERS], volume: f64) -> [f64; LAYERS] {
        std::array::from_fn(|n| heats[n] / (SHARES[n] * self.capacity(volume)))
    }

    /// Resistance from the middle of a layer to its lower or upper side over an area of 1 m² [m² K/W].
    pub fn half_resistance(&self, layer: usize, height: f64, content: f64) -> f64 {
        0.5 * SHARES[layer] * height / self.conductivity(content)
    }

    /// Advances the heat of a column; returns the heat that passes down and to the air [J].
    pub fn advance(
        &self,
        heats: &mut [f64; LAYERS],
        column: Column,
        duration: f64,
        around: &Surroundings,
    ) -> [f64; 2] {
        let old = self.contents(heats, column.volume);
        // Beyond a ratio temperatures are equal, and larger conductances would multiply rounding.
        let most = |n: usize| {
            LARGEST_LINK * SHARES[n] * self.capacity(column.volume)
                / duration.max(f64::MIN_POSITIVE)
        };
        let links = self.links(&old, column, around);
        let links: [f64; LAYERS] = std::array::from_fn(|n| links[n].min(most(n)));
        let to_air = self.air_links(column, duration, around);
        let to_air: [f64; LAYERS] = std::array::from_fn(|n| to_air[n].min(most(n)));
        let contents = self.solve(&old, column, duration, &links, (around, &to_air));
        let temperatures = contents.map(|content| self.temperature(content));
        let down = duration * links[0] * (temperatures[0] - around.below);
        heats[0] -= down;
        let mut lost = 0.0;
        for n in 0..LAYERS {
            if n > 0 {
                let flow = duration * links[n] * (temperatures[n] - temperatures[n - 1]);
                heats[n] -= flow;
                heats[n - 1] += flow;
            }
            let out = duration * to_air[n] * (temperatures[n] - around.air);
            heats[n] -= out;
            lost += out;
        }
        [down, lost]
    }

    /// Conductances below each layer [W/K].
    fn links(
        &self,
        contents: &[f64; LAYERS],
        Column { volume, height }: Column,
        around: &Surroundings,
    ) -> [f64; LAYERS] {
        let area = volume / height;
        let half = |n: usize| self.half_resistance(n, height, contents[n]);
        std::array::from_fn(|n| match n {
            0 => 1.0 / (half(0) / around.contact + around.resistance),
            _ => area / (half(n - 1) + half(n)),
        })
    }

    /// Conductances from each layer to the air [W/K], with which an implicit step of a lump is exact.
    fn air_links(&self, column: Column, duration: f64, around: &Surroundings) -> [f64; LAYERS] {
        let all = around.above + around.aside;
        let ratio = duration * all / self.capacity(column.volume);
        let ratio = ratio.min(LARGEST_RATIO);
        let exact = if ratio > 0.0 { ratio.exp_m1() / ratio } else { 1.0 };
        std::array::from_fn(|n| {
            let above = if n + 1 == LAYERS { around.above } else { 0.0 };
            exact * (above + SHARES[n] * around.aside)
        })
    }

    /// Contents after an implicit step.
    fn solve(
        &self,
        old: &[f64; LAYERS],
        column: Column,
        duration: f64,
        links: &[f64; LAYERS],
        (around, to_air): (&Surroundings, &[f64; LAYERS]),
    ) -> [f64; LAYERS] {
        let below = around.below - self.reference;
        let air = around.air - self.reference;
        let ratio: [f64; LAYERS] =
            std::array::from_fn(|n| duration / (SHARES[n] * self.capacity(column.volume)));
        let mut contents = *old;
        for _ in 0..MOST_ITERATIONS {
            // T = offset + slope c of each layer.
            let slope = contents.map(|content| self.slope(content));
            let offset: [f64; LAYERS] = std::array::from_fn(|n| {
                self.temperature(contents[n]) - self.reference - slope[n] * contents[n]
            });
            let mut rows = [[0.0; 4]; LAYERS];
            for n in 0..LAYERS {
                let above = if n + 1 < LAYERS { links[n + 1] } else { 0.0 };
                let all = links[n] + above + to_air[n];
                let mut known = to_air[n] * air - all * offset[n];
                let [mut lower, mut upper] = [0.0; 2];
                match n {
                    0 => known += links[0] * below,
                    _ => {
                        known += links[n] * offset[n - 1];
                        lower = -ratio[n] * links[n] * slope[n - 1];
                    }
                }
                if n + 1 < LAYERS {
                    known += above * offset[n + 1];
                    upper = -ratio[n] * above * slope[n + 1];
                }
                rows[n] =
                    [lower, 1.0 + ratio[n] * all * slope[n], upper, old[n] + ratio[n] * known];
            }
            let found = tridiagonal(rows);
            // All go as far as the first that comes to a kink of T(c), where the slopes change.
            let kinks: [_; LAYERS] = std::array::from_fn(|n| self.kink(contents[n], found[n]));
            let part = kinks.iter().flatten().map(|kink| kink.0).fold(1.0, f64::min);
            for n in 0..LAYERS {
                contents[n] = match kinks[n] {
                    Some((own, beyond)) if own <= part => beyond,
                    _ => contents[n] + part * (found[n] - contents[n]),
                };
            }
            if part == 1.0 && kinks.iter().all(Option::is_none) {
                break;
            }
        }
        contents
    }

    /// The first kink of T(c) between two contents: the part of the way to it, and a content just beyond it.
    fn kink(&self, from: f64, to: f64) -> Option<(f64, f64)> {
        let [frozen, molten] = self.phases?.contents();
        let up = [frozen, molten].into_iter().find(|&kink| from < kink && kink + BEYOND < to);
        let down = [molten, frozen].into_iter().find(|&kink| to < kink - BEYOND && kink < from);
        let beyond = match (up, down) {
            (Some(kink), _) => kink + BEYOND,
            (None, kink) => kink? - BEYOND,
        };
        Some((((beyond - from) / (to - from)).min(1.0), beyond))
    }

    /// `−ln(1 − F)` between two ages of a slab of the height H, F being the part of its heat that a slab has released.
    pub fn cooling(&self, height: f64, [from, to]: [f64; 2]) -> f64 {
        let fourier = |age: f64| self.conductivity / self.capacity * age / (height * height);
        logarithm(fourier(to)) - logarithm(fourier(from))
    }
}

/// Solves rows of lower, own and upper coefficients and the right-hand side, by elimination.
fn tridiagonal(mut rows: [[f64; 4]; LAYERS]) -> [f64; LAYERS] {
    for n in 1..LAYERS {
        let [_, own, upper, side] = rows[n - 1];
        let factor = rows[n][0] / own;
        rows[n][1] -= factor * upper;
        rows[n][3] -= factor * side;
    }
    let mut found = [0.0; LAYERS];
    for n in (0..LAYERS).rev() {
        let after = if n + 1 < LAYERS { rows[n][2] * found[n + 1] } else { 0.0 };
        found[n] = (rows[n][3] - after) / rows[n][1];
    }
    found
}

/// `−ln(1 − F(Fo))`.
fn logarithm(fourier: f64) -> f64 {
    if fourier < LATE {
        return -(-given_part(fourier)).ln_1p();
    }
    let rate = 0.25 * PI * PI;
    rate * fourier - (8.0 / (PI * PI)).ln() - ((-8.0 * rate * fourier).exp() / 9.0).ln_1p()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closed_form::{Conductor, MeltingFront};

    fn wax(range: f64) -> Heat {
        let phases =
            Phases { melting: [-40.0 - range, -40.0], latent: 110.0, heat: 0.9, conduction: 2.0 };
        Heat { reference: 350.0, capacity: 1.7e6, conductivity: 0.15, phases: Some(phases) }
    }

    const COLUMN: Column = Column { volume: 4e-4, height: 0.4e-3 };

    fn held(below: f64) -> Surroundings {
        let none = [0.0; 3];
        let [resistance, above, aside] = none;
        Surroundings { below, resistance, contact: 1.0, air: 300.0, above, aside }
    }

    /// Cools a column of 1 m² in steps that grow with the root of the age; returns its heat per area [J/m²].
    fn cooled(heat: &Heat, steps: usize, end: f64, around: &Surroundings) -> ([f64; LAYERS], f64) {
        let mut heats = SHARES.map(|share| 10.0 * share * heat.capacity(COLUMN.volume));
        let mut given = 0.0;
        for n in 0..steps {
            let [from, to] = [n, n + 1].map(|n| end * (n as f64 / steps as f64).powi(2));
            let [down, lost] = heat.advance(&mut heats, COLUMN, to - from, around);
            given += down + lost;
        }
        (heats, given)
    }

    #[test]
    fn series_and_images_meet() {
        let [before, after] = [LATE * (1.0 - 1e-12), LATE].map(logarithm);
        assert!((before - after).abs() < 1e-9, "{before} {after}");
    }

    #[test]
    fn shares_are_a_whole() {
        assert!((SHARES.iter().sum::<f64>() - 1.0).abs() < 1e-14 && SHARES[0] < 0.025);
    }

    /// Heat balances to rounding in steps of any length, and nothing leaves the range of the temperatures around.
    #[test]
    fn columns_balance_heat() {
        for heat in [wax(0.0), wax(8.0), Heat { phases: None, ..wax(0.0) }] {
            for (below, resistance) in [(290.0, 0.0), (290.0, 1e-3), (380.0, 0.0)] {
                let around = Surroundings { resistance, above: 20.0, aside: 5.0, ..held(below) };
                for duration in [1e-6, 0.1, 10.0, 1e4] {
                    let mut heats = SHARES.map(|share| 10.0 * share * heat.capacity(COLUMN.volume));
                    let before: f64 = heats.iter().sum();
                    let [down, lost] = heat.advance(&mut heats, COLUMN, duration, &around);
                    let after: f64 = heats.iter().sum();
                    let scale = before.abs() + down.abs() + lost.abs();
                    assert!((after + down + lost - before).abs() < 1e-12 * scale);
                    let contents = heat.contents(&heats, COLUMN.volume);
                    let range = contents.map(|content| heat.temperature(content));
                    let [low, high] = [below.min(300.0), below.max(360.0)];
                    let is_within = |t: &f64| (low - 1e-6..=high + 1e-6).contains(t);
                    assert!(range.iter().all(is_within), "{duration}: {range:?}");
                }
            }
        }
    }

    /// A slab on a plate of constant temperature releases the heat of the closed form to 3 %.
    #[test]
    fn slabs_cool_as_in_closed_form() {
        let heat = Heat { phases: None, ..wax(0.0) };
        for end in [0.01, 0.1, 2.0] {
            let (_, given) = cooled(&heat, 16, end, &held(330.0));
            let fourier = heat.conductivity / heat.capacity * end / COLUMN.height.powi(2);
            let exact = 30.0 * heat.capacity(COLUMN.volume) * given_part(fourier);
            assert!((given / exact - 1.0).abs() < 0.03, "{end}: {}", given / exact);
        }
    }

    /// Fluid on a cold plate freezes as a half space does (Neumann) to 7.5 %, as the front lags within a layer.
    #[test]
    fn columns_freeze_as_half_spaces() {
        let heat = wax(0.0);
        let exact = MeltingFront {
            new: Conductor { conductivity: 0.3, heat_capacity: 0.9 * 1.7e6 },
            old: Conductor { conductivity: 0.15, heat_capacity: 1.7e6 },
            latent: 110.0 * 1.7e6,
            surface: 20.0,
            initial: 50.0,
        };
        for end in [0.1, 0.3] {
            let (_, given) = cooled(&heat, 20, end, &held(290.0));
            let ratio = given / (2.0 * end * exact.flux(end));
            assert!((ratio - 1.0).abs() < 0.075, "{end}: {ratio}");
        }
    }
}
