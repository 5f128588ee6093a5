//! Heat of the layer of particles at a wall on which the fluid freezes.

use std::f64::consts::PI;

use super::contact_law::{ContactLaw, SHORTEST, THICK, couplings, effusivity};
use super::freezing_flux::freezing_flux;
use super::phases::Phases;
use crate::closed_form::special::erfcx;
use crate::kernel::Kernel;

#[derive(Debug, Clone, PartialEq)]
pub struct FreezingLaw {
    phases: Phases,
    molten: ContactLaw,
    /// Bends of the molten fluid.
    contact: Vec<f64>,
    /// Square of the lattice's effusivity, and 2C.
    strength: f64,
    decay: f64,
    releases: Vec<Release>,
    history: Vec<f64>,
}

#[derive(Debug, Clone, PartialEq)]
struct Release {
    start: f64,
    mushy: Vec<Curve>,
    frozen: Vec<Curve>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Curve {
    /// `2q₀²/(Δh Δψ)`.
    similarity: f64,
    /// Potential above the surface's, over the liquidus' above it, at which the curve ends.
    end: f64,
    bends: [[f64; KNOTS]; 3],
}

#[derive(Debug, Clone, Copy)]
pub struct Contents {
    pub before: f64,
    pub fluid: f64,
    pub wall: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lost {
    pub content: f64,
    pub fall: f64,
}

const KNOTS: usize = 17;
const CONTACT_PLACES: usize = 193;
const LAYERS: usize = 64;
const SHARE: f64 = 0.02;
const LONGEST: f64 = 0.05;
const SETTLED: f64 = 130.0;
const MUSHY: usize = 16;
const FROZEN: usize = 64;
const FINEST: f64 = 1e-3;
const COLDEST: f64 = 0.96;
const STEPS: usize = 60;
const ACCURACY: f64 = 1e-9;
const SINGULAR: f64 = 0.5752;
const ENTRIES: usize = 65;

/// Node of a curve: a position along the logarithmic scale.
fn scale(z: f64) -> f64 {
    (z / FINEST).ln_1p() / (1.0 / FINEST).ln_1p()
}
fn unscale(place: f64) -> f64 {
    FINEST * (place * (1.0 / FINEST).ln_1p()).exp_m1()
}

impl FreezingLaw {
    pub fn of(lattice: (Kernel, f64, usize), phases: &Phases, starts: &[f64]) -> Self {
        let couplings = couplings(lattice.0, lattice.1, lattice.2);
        let strength = effusivity(&couplings).powi(2);
        let molten = ContactLaw::of(lattice.0, lattice.1, lattice.2);
        let decay = molten.decay();
        let lat = Lattice { phases: *phases, couplings, decay };
        let simple = Phases { melting: [f64::NEG_INFINITY; 2], ..*phases };
        let _ = simple;
        let contact = lat.contact(strength);
        let mut starts = starts.to_vec();
        starts.sort_by(f64::total_cmp);
        let releases = starts.iter().map(|&start| lat.release(start, strength)).collect();
        let history = (0..ENTRIES).map(|n| history(n as f64 / (ENTRIES - 1) as f64)).collect();
        Self { phases: *phases, molten, contact, strength, decay, releases, history }
    }

    pub fn loss(&self, at: Contents, diffusion: f64, resistances: [f64; 2]) -> Lost {
        let Contents { before, fluid, wall } = at;
        let [_, molten] = self.phases.contents();
        let perfect = resistances == [0.0; 2];
        if perfect && wall >= self.phases.melting[1] && fluid >= molten {
            let deficit = (before - fluid) / (before - wall);
            let part = self.molten.relaxation(Some(deficit).filter(|d| d.is_finite()), diffusion);
            return Lost { content: part * (fluid - wall), fall: 0.0 };
        }
        let low = self.potential(wall);
        let before = before.max(fluid).max(self.phases.melting[1]);
        let deficit = before - fluid;
        let uniform = self.phases.potential(fluid) <= low
            || (perfect && deficit >= self.end(before, wall));
        if perfect && uniform {
            return Lost { content: self.relaxed(fluid, low, diffusion), fall: 0.0 };
        }
        let sign = if self.phases.potential(fluid) >= low { 1.0 } else { -1.0 };
        if sign < 0.0 {
            return self.warming(at, diffusion, resistances);
        }
        self.cooling(before, fluid, wall, diffusion, resistances)
    }

    /// Rise through resistances of a layer of uniform temperature.
    fn warming(&self, at: Contents, diffusion: f64, [near, far]: [f64; 2]) -> Lost {
        let all = near + far;
        let line = |content: f64, flux: f64| {
            let surface = at.wall - all * flux;
            self.decay * (self.potential(surface) - self.phases.potential(content))
        };
        let most = (at.wall - self.phases.rise(at.fluid)) / all.max(1e-300);
        let most = most.min(line(at.fluid, 0.0));
        let first = root(most, |flux| excess(line(at.fluid, flux), flux));
        let gained = |last: f64| mean(first, last) * diffusion;
        let last = root(first, |last| excess(line(at.fluid + gained(last), last), last));
        let content = gained(last);
        Lost { content: -content, fall: fall(last * diffusion, content) }
    }

    fn cooling(
        &self,
        before: f64,
        fluid: f64,
        wall: f64,
        diffusion: f64,
        [near, far]: [f64; 2],
    ) -> Lost {
        let deficit = before - fluid;
        let step = |plane: f64| {
            let flux = |deficit: f64, flux: f64| {
                self.flux(before, deficit, plane + near * flux, plane)
            };
            let most = match near > 0.0 {
                true => (before - plane) / near,
                false => f64::INFINITY,
            };
            let first = match deficit > 0.0 {
                true => {
                    let bound = most.min(2.6 * self.similar(before, plane) / deficit
                        + self.decay * (self.phases.potential(fluid) - self.potential(plane)));
                    if near > 0.0 { root(bound, |q| excess(flux(deficit, q), q)) } else { flux(deficit, 0.0) }
                }
                false => most,
            };
            let bound = first.min((2.6 * self.similar(before, plane) / diffusion).sqrt()
                + self.decay * (self.phases.potential(fluid) - self.potential(plane)));
            let last = root(bound, |last| {
                excess(flux(deficit + diffusion * mean(first, last), last), last)
            });
            (diffusion * mean(first, last), last)
        };
        let mut plane = wall;
        if far > 0.0 {
            let span = self.phases.rise(fluid) - wall;
            plane += span * root(1.0, |part| {
                far * step(wall + part * span).1 / span - part
            });
        }
        let (content, last) = step(plane);
        Lost { content, fall: fall(last * diffusion, content) }
    }

    fn potential(&self, rise: f64) -> f64 {
        self.phases.potential(self.phases.content(rise))
    }

    /// q₀² upper bound
    fn similar(&self, before: f64, surface: f64) -> f64 {
        let heat = before - self.phases.content(surface).min(self.phases.contents()[0]);
        0.5 * heat * (self.potential(before) - self.potential(surface)) * self.strength.max(1.0)
    }

    /// Range and place of a surface temperature below the liquidus.
    fn place(&self, surface: f64) -> (bool, f64) {
        place(&self.phases, surface)
    }

    /// E*.
    fn end(&self, before: f64, surface: f64) -> f64 {
        if surface >= self.phases.melting[1] {
            return THICK * (before - surface);
        }
        let (is_frozen, place) = self.place(surface);
        let low = self.potential(surface);
        let span = self.potential(self.phases.melting[1]) - low;
        let [a, b, share] = self.between(before);
        let end = |n: f64| self.releases[n as usize].end(is_frozen, place);
        let part = (1.0 - share) * end(a) + if share > 0.0 { share * end(b) } else { 0.0 };
        before - content_of(&self.phases, low + part * span)
    }

    fn between(&self, before: f64) -> [f64; 3] {
        let above = self.releases.partition_point(|release| release.start < before);
        if above == 0 {
            return [0.0, 0.0, 0.0];
        }
        if above == self.releases.len() {
            return [above as f64 - 1.0, 0.0, 0.0];
        }
        let [a, b] = [above - 1, above].map(|n| self.releases[n].start);
        [above as f64 - 1.0, above as f64, (before - a) / (b - a)]
    }

    /// Flux at a deficit and a surface temperature.
    fn flux(&self, before: f64, deficit: f64, surface: f64, plane: f64) -> f64 {
        let liquidus = self.phases.melting[1];
        let u = ((surface - plane) / (before - plane)).clamp(0.0, 1.0);
        if surface >= liquidus {
            return self.contact_flux(before, deficit, surface, u);
        }
        let (is_frozen, place) = self.place(surface);
        let isothermal = self.phases.melting[0] == liquidus;
        if place < 1.0 && (isothermal || !is_frozen) {
            // The curve at the liquidus is that of the molten fluid.
            let node = self.surface_at(is_frozen, 1.0);
            let part = (surface - liquidus) / (node - liquidus);
            let a = self.contact_flux(before, deficit, liquidus, u);
            let b = self.flux_at(before, deficit, (is_frozen, 1.0), node, u);
            return (1.0 - part) * a + part * b;
        }
        self.flux_at(before, deficit, (is_frozen, place), surface, u)
    }

    fn surface_at(&self, is_frozen: bool, node: f64) -> f64 {
        surface_at(&self.phases, is_frozen, node)
    }

    fn contact_flux(&self, before: f64, deficit: f64, surface: f64, u: f64) -> f64 {
        let step = before - surface;
        let theta = deficit / step;
        if theta >= THICK || step <= 0.0 {
            return (self.decay * (self.phases.potential(before - deficit) - surface)).max(0.0);
        }
        let place = theta / THICK * (CONTACT_PLACES - 1) as f64;
        let bend = pick(&self.contact, place);
        let history = 1.0 + (pick(&self.history, u * (ENTRIES - 1) as f64) - 1.0) * (1.0 - theta);
        2.0 / PI * self.strength * step * bend * history / theta
    }

    fn flux_at(
        &self,
        before: f64,
        deficit: f64,
        (is_frozen, place): (bool, f64),
        surface: f64,
        u: f64,
    ) -> f64 {
        let low = self.potential(surface);
        let span = self.potential(self.phases.melting[1]) - low;
        let [a, b, share] = self.between(before);
        let [mut similarity, mut end] = self.releases[a as usize].of(is_frozen, place);
        if share > 0.0 {
            let [s, e] = self.releases[b as usize].of(is_frozen, place);
            similarity += share * (s - similarity);
            end += share * (e - end);
        }
        let end = before - content_of(&self.phases, low + end * span);
        if deficit >= end {
            return (self.decay * (self.phases.potential(before - deficit) - low)).max(0.0);
        }
        let spot = spot(&self.phases, before, deficit, end);
        let mut bend = self.releases[a as usize].bend(is_frozen, place, spot);
        if share > 0.0 {
            bend += share * (self.releases[b as usize].bend(is_frozen, place, spot) - bend);
        }
        let heat = before - self.phases.content(surface);
        let drop = self.potential(before) - low;
        let like = ((1.0 - similarity / self.strength) / (1.0 - 2.0 / PI)).clamp(0.0, 1.0);
        let fade = like * (1.0 - deficit / end);
        let history = 1.0 + (pick(&self.history, u * (ENTRIES - 1) as f64) - 1.0) * fade;
        similarity * heat * drop * bend * history / deficit
    }

    /// Content that a uniform layer loses towards a potential.
    fn relaxed(&self, content: f64, low: f64, diffusion: f64) -> f64 {
        relaxed(&self.phases, content, low, self.decay * diffusion)
    }
}

fn relaxed(phases: &Phases, content: f64, low: f64, time: f64) -> f64 {
    let contents = phases.contents();
    let (mut now, mut rest) = (content, time);
    let cools = phases.potential(content) > low;
    for _ in 0..3 {
        let gap = phases.potential(now) - low;
        if gap == 0.0 {
            break;
        }
        // Phase and its edge ahead.
        let ahead = match cools {
            true => contents.iter().rev().find(|&&edge| edge < now),
            false => contents.iter().find(|&&edge| edge > now),
        };
        let slope = match (now, cools) {
            (h, true) if h > contents[1] => 1.0,
            (h, false) if h >= contents[1] => 1.0,
            (h, true) if h <= contents[0] => phases.conduction / phases.heat,
            (h, false) if h < contents[0] => phases.conduction / phases.heat,
            _ => {
                (phases.potential(contents[1]) - phases.potential(contents[0]))
                    / (contents[1] - contents[0])
            }
        };
        let Some(&edge) = ahead else {
            now += gap / slope * (-slope * rest).exp_m1();
            break;
        };
        let left = phases.potential(edge) - low;
        let reach = if slope > 0.0 {
            if left / gap <= 0.0 { f64::INFINITY } else { (gap / left).ln() / slope }
        } else {
            (now - edge) / gap
        };
        if reach >= rest {
            now += if slope > 0.0 { gap / slope * (-slope * rest).exp_m1() } else { -gap * rest };
            break;
        }
        (now, rest) = (edge, rest - reach);
    }
    content - now
}

fn mean(first: f64, last: f64) -> f64 {
    if first.is_infinite() {
        2.0 * last
    } else if first + last > 0.0 {
        2.0 * first * last / (first + last)
    } else {
        0.0
    }
}

fn fall(last: f64, whole: f64) -> f64 {
    let fallen = if whole > 0.0 { (1.0 - last / whole).clamp(0.0, 0.5) } else { 0.0 };
    fallen * (1.0 + SINGULAR * fallen)
}

/// Relative excess of one flux over another.
fn excess(one: f64, other: f64) -> f64 {
    if one.is_infinite() {
        1.0
    } else if one + other > 0.0 {
        (one - other) / (one + other)
    } else {
        0.0
    }
}

/// Zero between 0 and a bound of a falling function.
fn root(bound: f64, of: impl Fn(f64) -> f64) -> f64 {
    let (mut ends, mut values) = ([0.0, bound], [of(0.0), of(bound)]);
    if values[0] <= 0.0 {
        return 0.0;
    }
    if values[1] >= 0.0 {
        return bound;
    }
    let (mut place, mut stays) = (0.0, None);
    for _ in 0..STEPS {
        let share = values[0] / (values[0] - values[1]);
        place = ends[0] + share * (ends[1] - ends[0]);
        let value = of(place);
        let side = usize::from(value < 0.0);
        let moved = (place - ends[side]).abs();
        (ends[side], values[side]) = (place, value);
        COUNT.with(|c| c.set(c.get() + 1));
        if moved <= ACCURACY * place || (value.abs() <= ACCURACY) {
            break;
        }
        if stays == Some(1 - side) {
            values[1 - side] *= 0.5;
        }
        stays = Some(1 - side);
    }
    place
}
thread_local! { pub static COUNT: std::cell::Cell<u64> = const { std::cell::Cell::new(0) }; }

/// Value of a table at a place.
fn pick(table: &[f64], place: f64) -> f64 {
    let below = (place as usize).min(table.len() - 2);
    let share = place - below as f64;
    table[below] + share * (table[below + 1] - table[below])
}

fn content_of(phases: &Phases, potential: f64) -> f64 {
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

fn surface_at(phases: &Phases, is_frozen: bool, node: f64) -> f64 {
    let [solidus, liquidus] = phases.melting;
    if is_frozen {
        let [frozen, molten] = phases.contents();
        let z = unscale(node / FROZEN as f64) * COLDEST;
        solidus - (molten - frozen) * z / (1.0 - z) / phases.conduction
    } else {
        liquidus - (liquidus - solidus) * unscale(node / MUSHY as f64)
    }
}

fn place(phases: &Phases, surface: f64) -> (bool, f64) {
    let [solidus, liquidus] = phases.melting;
    if surface < solidus || solidus == liquidus {
        let [frozen, molten] = phases.contents();
        let drop = phases.conduction * (solidus - surface);
        let z = drop / (drop + molten - frozen) / COLDEST;
        (true, FROZEN as f64 * scale(z).min(1.0))
    } else {
        (false, MUSHY as f64 * scale((liquidus - surface) / (liquidus - solidus)))
    }
}

/// Segment and place of a deficit.
fn spot(phases: &Phases, before: f64, deficit: f64, end: f64) -> (usize, f64) {
    let edges = phases.contents();
    let breaks = [0.0, (before - edges[1]).min(end), (before - edges[0]).min(end), end];
    let segment = if deficit < breaks[1] {
        0
    } else if deficit < breaks[2] {
        1
    } else {
        2
    };
    let [from, to] = [breaks[segment], breaks[segment + 1]];
    let share = if to > from { ((deficit - from) / (to - from)).min(1.0) } else { 1.0 };
    (segment, share * (KNOTS - 1) as f64)
}

impl Release {
    fn curves(&self, is_frozen: bool, place: f64) -> (&Curve, &Curve, f64) {
        let list = if is_frozen { &self.frozen } else { &self.mushy };
        let below = (place as usize).min(list.len() - 2);
        (&list[below], &list[below + 1], place - below as f64)
    }
    fn end(&self, is_frozen: bool, place: f64) -> f64 {
        self.of(is_frozen, place)[1]
    }
    fn of(&self, is_frozen: bool, place: f64) -> [f64; 2] {
        let (a, b, share) = self.curves(is_frozen, place);
        [
            a.similarity + share * (b.similarity - a.similarity),
            a.end + share * (b.end - a.end),
        ]
    }
    fn bend(&self, is_frozen: bool, place: f64, (segment, spot): (usize, f64)) -> f64 {
        let (a, b, share) = self.curves(is_frozen, place);
        let [a, b] = [a, b].map(|curve| pick(&curve.bends[segment], spot));
        a + share * (b - a)
    }
}

fn history(u: f64) -> f64 {
    if u <= 0.0 {
        return 1.0;
    }
    if u >= 1.0 {
        return PI * PI / 8.0;
    }
    let mut range = [0.0, 1e9f64];
    for _ in 0..200 {
        let middle = 0.5 * (range[0] + range[1]);
        range[usize::from(erfcx(middle) < u)] = middle;
    }
    let y = range[1];
    let heat = if y > 0.02 {
        u - 1.0 + 2.0 * y / PI.sqrt()
    } else {
        y * y * (1.0 - 4.0 * y / (3.0 * PI.sqrt()))
    };
    0.5 * PI * u * heat / (1.0 - u).powi(2)
}

struct Lattice {
    phases: Phases,
    couplings: Vec<f64>,
    decay: f64,
}

impl Lattice {
    fn contact(&self, strength: f64) -> Vec<f64> {
        let molten =
            Phases { melting: [-1e9; 2], latent: 0.0, heat: 1.0, conduction: 1.0 };
        let lattice = Lattice { phases: molten, couplings: self.couplings.clone(), decay: self.decay };
        let q = (strength / PI).sqrt();
        let curve = lattice.run(1.0, q, f64::INFINITY, |content, _| 1.0 - content >= THICK);
        let bend = |theta: f64| sample(&curve, theta, q);
        (0..CONTACT_PLACES)
            .map(|n| bend(THICK * n as f64 / (CONTACT_PLACES - 1) as f64))
            .collect()
    }

    /// Pairs of E and q under q₀/√t.
    fn run(&self, start: f64, q: f64, most: f64, ends: impl Fn(f64, f64) -> bool) -> Vec<[f64; 2]> {
        let mut layers = [start; LAYERS];
        let mut potentials = [0.0; LAYERS];
        let mut curve: Vec<[f64; 2]> = Vec::new();
        let mut time: f64 = 0.0;
        let longest = LONGEST.min(0.25 / self.phases.fastest());
        let far = self.phases.potential(start);
        while time < most {
            let step = (SHARE * time).clamp(SHORTEST, longest);
            let reach = ((8.0 * (time * self.phases.fastest()).sqrt()) as usize + 8).min(LAYERS);
            for (potential, layer) in potentials.iter_mut().zip(&layers) {
                *potential = self.phases.potential(*layer);
            }
            for n in 0..reach {
                let mut rate = 0.0;
                for (m, c) in self.couplings.iter().enumerate() {
                    let m = m + 1;
                    let below = if n >= m { n - m } else { m - n - 1 };
                    let above = potentials.get(n + m).copied().unwrap_or(far);
                    rate += c * (potentials[below] + above - 2.0 * potentials[n]);
                }
                layers[n] += step * rate;
            }
            layers[0] -= 2.0 * q * ((time + step).sqrt() - time.sqrt());
            time += step;
            let lost = start - layers[0];
            if curve.last().is_some_and(|last| lost <= last[0]) {
                break;
            }
            curve.push([lost, q / time.sqrt()]);
            if ends(layers[0], q / time.sqrt()) {
                break;
            }
        }
        curve
    }

    fn release(&self, start: f64, strength: f64) -> Release {
        let curve = |is_frozen: bool, node: usize| {
            let surface = surface_at(&self.phases, is_frozen, node as f64);
            self.curve(start, surface, strength)
        };
        let [solidus, liquidus] = self.phases.melting;
        let all = |is_frozen: bool, count: usize, singular: bool| {
            let first = usize::from(singular);
            let mut list: Vec<Curve> = (first..=count).map(|n| curve(is_frozen, n)).collect();
            if singular {
                list.insert(0, list[0]);
            }
            list
        };
        let isothermal = solidus == liquidus;
        Release {
            start,
            mushy: if isothermal { Vec::new() } else { all(false, MUSHY, true) },
            frozen: all(true, FROZEN, isothermal),
        }
    }

    fn curve(&self, start: f64, surface: f64, strength: f64) -> Curve {
        let phases = &self.phases;
        let flux = freezing_flux(phases, start, surface) * strength.sqrt();
        let potential = |rise: f64| phases.potential(phases.content(rise));
        let (low, high) = (potential(surface), potential(phases.melting[1]));
        let line = |content: f64| self.decay * (phases.potential(content) - low);
        let was_below = std::cell::Cell::new(false);
        let ends = |content: f64, flux: f64| {
            let below = flux < line(content);
            if !below && was_below.get() && phases.potential(content) < high {
                return true;
            }
            was_below.set(below);
            phases.potential(content) - low <= (1.0 - THICK) * (high - low)
        };
        let mut curve = self.run(start, flux, SETTLED, ends);
        // If the lattice has not ended, a thickening skin.
        let [lost, last] = curve[curve.len() - 1];
        let bottom = phases.content(surface);
        if !(ends(start - lost, last)) {
            let skin = (start - phases.melting[1]).max(0.0) + phases.melting[1]
                - bottom.max(phases.contents()[0]);
            let _ = skin;
            let latent = phases.contents()[1] - bottom.max(phases.contents()[0]);
            let mut deficit = lost;
            let step = (start - bottom - lost) / 400.0;
            for _ in 0..400 {
                deficit += step;
                let thick = (high - low) / last + (deficit - lost) / latent;
                let flux = (high - low) / thick;
                curve.push([deficit, flux]);
                if ends(start - deficit, flux) {
                    break;
                }
            }
        }
        let [lost, _] = curve[curve.len() - 1];
        let end = (phases.potential(start - lost) - low) / (high - low);
        let end = end.clamp(0.0, 0.999999);
        let all = start - content_of(phases, low + end * (high - low));
        let edges = phases.contents();
        let breaks = [0.0, (start - edges[1]).min(all), (start - edges[0]).min(all), all];
        let mut bends = [[0.0; KNOTS]; 3];
        for (segment, bends) in bends.iter_mut().enumerate() {
            for (n, bend) in bends.iter_mut().enumerate() {
                let share = n as f64 / (KNOTS - 1) as f64;
                let deficit =
                    breaks[segment] + share * (breaks[segment + 1] - breaks[segment]);
                *bend = sample(&curve, deficit, flux);
            }
        }
        let heat = start - bottom;
        let similarity = 2.0 * flux * flux / (heat * (potential(start) - low));
        Curve { similarity, end, bends }
    }
}

/// `qE/2q₀²` at a deficit.
fn sample(curve: &[[f64; 2]], deficit: f64, q: f64) -> f64 {
    if deficit <= curve[0][0] {
        return 1.0;
    }
    let above = curve.partition_point(|place| place[0] < deficit).clamp(1, curve.len() - 1);
    let ([a, f], [b, g]) = (curve[above - 1], curve[above]);
    let [low, high] = [a * f, b * g];
    let share = ((deficit - a) / (b - a)).clamp(0.0, 1.0);
    (low + share * (high - low)) / (2.0 * q * q)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closed_form::{Conductor, FreezingColumn, FreezingContact};
    use crate::math::exponential;
    use crate::port::SurfaceResponse;

    #[derive(Clone, Copy)]
    struct Material {
        conductivity: [f64; 2],
        density: f64,
        heat: [f64; 2],
        latent: f64,
        melting: [f64; 2],
    }
    const TIN: Material = Material {
        conductivity: [62.0, 33.0],
        density: 6970.0,
        heat: [244.0, 244.0],
        latent: 59e3,
        melting: [505.0, 505.0],
    };
    const WATER: Material = Material {
        conductivity: [2.2, 0.57],
        density: 1000.0,
        heat: [2050.0, 4190.0],
        latent: 334e3,
        melting: [273.15, 273.15],
    };
    const ALLOY: Material = Material {
        conductivity: [50.0, 25.0],
        density: 8400.0,
        heat: [180.0, 210.0],
        latent: 45e3,
        melting: [456.0, 493.0],
    };
    const PARAFFIN: Material = Material {
        conductivity: [0.23, 0.15],
        density: 780.0,
        heat: [2100.0, 2200.0],
        latent: 200e3,
        melting: [310.0, 330.0],
    };
    const ALUMINA: Material = Material {
        conductivity: [8.0, 6.0],
        density: 3500.0,
        heat: [1300.0, 1400.0],
        latent: 1.07e6,
        melting: [2327.0, 2327.0],
    };

    impl Material {
        fn phases(&self, zero: f64) -> Phases {
            Phases {
                melting: self.melting.map(|m| m - zero),
                latent: self.latent / self.heat[1],
                heat: self.heat[0] / self.heat[1],
                conduction: self.conductivity[0] / self.conductivity[1],
            }
        }
        fn contact(&self, wall: Conductor, wall_temperature: f64, fluid: f64) -> FreezingContact {
            let body = |n: usize| Conductor {
                conductivity: self.conductivity[n],
                heat_capacity: self.density * self.heat[n],
            };
            FreezingContact {
                wall,
                frozen: body(0),
                molten: body(1),
                latent: self.density * self.latent,
                melts_at: self.melting[1],
                wall_temperature,
                fluid_temperature: fluid,
            }
        }
    }

    /// Times, heats and frozen thicknesses.
    fn perfect(
        lattice: (Kernel, f64, usize),
        material: &Material,
        start: f64,
        wall: f64,
        layers: f64,
    ) -> Vec<[f64; 4]> {
        let phases = material.phases(start);
        let law = FreezingLaw::of(lattice, &phases, &[0.0]);
        let c = couplings(lattice.0, lattice.1, lattice.2);
        let exact = freezing_flux(&phases, 0.0, wall - start);
        let huge = Conductor { conductivity: 1e15, heat_capacity: 1e15 };
        let contact = material.contact(huge, wall, start);
        let growth = 2.0 * contact.growth()
            * (phases.conduction / phases.heat).sqrt();
        let mut h = vec![0.0; 400];
        let (mut t, mut heat): (f64, f64) = (0.0, 0.0);
        let (mut next, mut found) = (1e-4, Vec::new());
        let most = 0.2 / phases.fastest();
        loop {
            let s = (0.1 * t).clamp(1e-8, most);
            let lost = law.loss(
                Contents { before: 0.0, fluid: h[0], wall: wall - start }, s, [0.0; 2]);
            let psi: Vec<f64> = h.iter().map(|&h| phases.potential(h)).collect();
            let reach = ((8.0 * (t * phases.fastest()).sqrt()) as usize + 8).min(h.len());
            for i in 0..reach {
                for (n, c) in c.iter().enumerate() {
                    let d = n + 1;
                    let below = if i >= d { i - d } else { d - i - 1 };
                    let above = psi.get(i + d).copied().unwrap_or(0.0);
                    h[i] += s * c * (psi[below] + above - 2.0 * psi[i]);
                }
            }
            h[0] -= lost.content;
            heat += lost.content;
            t += s;
            let front: f64 = h.iter().map(|&h| phases.frozen(h)).sum();
            let ideal = growth * t.sqrt();
            if ideal > next || (growth == 0.0 && t > next) {
                found.push([ideal, heat / (2.0 * exact * t.sqrt()) - 1.0, front - ideal, t]);
                next *= if next < 0.2 { 2.0 } else { 1.2 };
            }
            if next > layers || t > 3000.0 {
                return found;
            }
        }
    }

    #[test]
    fn show_perfect() {
        for support in [2.0, 3.0] {
            for (name, material, start, walls) in [
                ("tin", TIN, 505.0, [298.0, 423.0, 500.0]),
                ("tin", TIN, 513.0, [298.0, 423.0, 500.0]),
                ("tin", TIN, 600.0, [298.0, 423.0, 500.0]),
                ("water", WATER, 280.0, [173.0, 250.0, 270.0]),
                ("alumina", ALUMINA, 2500.0, [300.0, 1000.0, 2200.0]),
                ("paraffin", PARAFFIN, 340.0, [250.0, 300.0, 315.0]),
                ("alloy", ALLOY, 500.0, [300.0, 450.0, 470.0]),
            ] {
                for wall in walls {
                    let clock = std::time::Instant::now();
                    let found = perfect((Kernel::WendlandC2, support, 3), &material, start, wall, 30.0);
                    print!("{support} {name} {start} {wall} {:.2?}: ", clock.elapsed());
                    for [ideal, heat, front, t] in found {
                        print!(" {ideal:.4}(t{t:.3}):{:.2}%/{front:.3}", 100.0 * heat);
                    }
                    println!();
                }
            }
        }
    }

    fn passes() -> usize {
        std::env::var("PASSES").map_or(6, |p| p.parse().unwrap())
    }
    /// Heat, front and wall's surface temperature at some times, of layers of unit thickness.
    fn coupled(
        phases: &Phases,
        law: &FreezingLaw,
        lattice: (Kernel, f64, usize),
        [start, wall]: [f64; 2],
        effusivity: f64,
        resistance: f64,
        times: &[f64],
    ) -> Vec<[f64; 3]> {
        let c = couplings(lattice.0, lattice.1, lattice.2);
        let parts = if resistance > 0.0 {
            let (mut a, mut b) = (wall, start);
            for _ in 0..80 {
                let m = 0.5 * (a + b);
                let q = freezing_flux(phases, start, m) * PI.sqrt();
                if effusivity * (m - wall) > q { b = m } else { a = m }
            }
            let own = match std::env::var("SPLIT") {
                Ok(_) => effusivity * (a - wall) / (start - a),
                _ => 1.0,
            };
            [effusivity, own].map(|e| resistance * e / (own + effusivity))
        } else {
            [0.0; 2]
        };
        let step = (0.2 / phases.fastest()).min(0.02).min(times[0] / 10.0);
        let response =
            SurfaceResponse::of_half_space(effusivity, [0.1 * step, 10.0 * times[times.len() - 1]]);
        let weights: Vec<_> =
            response.rates.iter().map(|rate| exponential::weights(rate * step)).collect();
        let [held, falling] =
            [response.of_held_flux(step), response.of_falling_flux(step)].map(|rise| rise / step);
        let mut h = vec![start; 150];
        let mut amplitudes = vec![0.0; response.len()];
        let (mut heat, mut taken) = (0.0, 0);
        let mut found = Vec::new();
        for &time in times {
            let mut surface = 0.0;
            while taken < (time / step).round() as usize {
                let free: f64 =
                    wall + amplitudes.iter().zip(&weights).map(|(a, w)| a * w[0]).sum::<f64>();
                surface = free;
                let mut lost = Lost { content: 0.0, fall: 0.0 };
                for _ in 0..passes() {
                    let at = Contents { before: start, fluid: h[0], wall: surface };
                    lost = law.loss(at, step, parts);
                    let layer = phases.rise(h[0]);
                    let rise = lost.content / (layer - surface) * (held + lost.fall * falling);
                    surface = (free + rise * layer) / (1.0 + rise);
                }
                for ((amplitude, gain), w) in
                    amplitudes.iter_mut().zip(&response.gains).zip(&weights)
                {
                    let mean = w[1] + lost.fall * (w[1] - 2.0 * w[2]);
                    *amplitude = w[0] * *amplitude + gain * lost.content * mean;
                }
                heat += lost.content;
                let psi: Vec<f64> = h.iter().map(|&h| phases.potential(h)).collect();
                let now = taken as f64 * step;
                let reach = ((8.0 * (now * phases.fastest()).sqrt()) as usize + 8).min(h.len());
                for i in 0..reach {
                    for (n, c) in c.iter().enumerate() {
                        let d = n + 1;
                        let below = if i >= d { i - d } else { d - i - 1 };
                        let above = psi.get(i + d).copied().unwrap_or(start);
                        h[i] += step * c * (psi[below] + above - 2.0 * psi[i]);
                    }
                }
                h[0] -= lost.content;
                taken += 1;
            }
            found.push([heat, h.iter().map(|&h| phases.frozen(h)).sum(), surface]);
        }
        found
    }

    #[test]
    fn show_resistive() {
        let lattice = (Kernel::WendlandC2, 3.0, 3);
        for (name, material, start, wall) in [
            ("tin", TIN, 505.0, 298.15),
            ("tin", TIN, 513.0, 298.15),
            ("tin", TIN, 513.0, 423.15),
            ("tin", TIN, 600.0, 298.15),
            ("tin", TIN, 540.0, 503.0),
            ("water", WATER, 280.0, 250.0),
            ("alumina", ALUMINA, 2500.0, 300.0),
            ("alloy", ALLOY, 500.0, 300.0),
        ] {
            let phases = material.phases(start);
            let law = FreezingLaw::of(lattice, &phases, &[0.0]);
            let bodies = material.contact(Conductor { conductivity: 14.9, heat_capacity: 7900.0 * 477.0 }, wall, start);
            let scale = bodies.molten.effusivity();
            for ratio in [bodies.wall.effusivity() / scale, 1e4] {
                for biot in [0.1, 1.0, 10.0, 100.0, f64::INFINITY] {
                    let times = [1e-2, 1e-1, 1.0, 10.0];
                    let clock = std::time::Instant::now();
                    COUNT.with(|c| c.set(0));
                    let found = coupled(&phases, &law, lattice, [0.0, wall - start], ratio, 1.0 / biot, &times);
                    let spent = clock.elapsed();
                    print!("{name} {start} {wall} e{ratio:.3} Bi {biot:e} {spent:.1?}/{}:", COUNT.with(|c| c.get()));
                    for (time, [heat, front, surface]) in times.into_iter().zip(found) {
                        let column = FreezingColumn {
                            bodies: FreezingContact {
                                wall: Conductor { conductivity: ratio, heat_capacity: ratio },
                                frozen: Conductor { conductivity: phases.conduction, heat_capacity: phases.heat },
                                molten: Conductor { conductivity: 1.0, heat_capacity: 1.0 },
                                latent: phases.latent,
                                melts_at: phases.melting[1],
                                wall_temperature: wall - start,
                                fluid_temperature: 0.0,
                            },
                            solidus: phases.melting[0],
                            conductance: biot,
                            wall_thickness: 8.0 * time.sqrt(),
                            fluid_thickness: 12.0 * (time * phases.fastest()).sqrt(),
                            cells: 150,
                        };
                        let mut exact = *column.run(time, 150).last().unwrap();
                        let fine = *FreezingColumn { cells: 300, ..column }.run(time, 300).last().unwrap();
                        exact.heat = 2.0 * fine.heat - exact.heat;
                        exact.front = 2.0 * fine.front - exact.front;
                        exact.wall_surface = 2.0 * fine.wall_surface - exact.wall_surface;
                        print!(" {:+.2}%/{:.3}:{:+.3}/{:+.2}K", 100.0 * (heat / exact.heat - 1.0), exact.front, front - exact.front, surface - exact.wall_surface);
                    }
                    println!();
                }
            }
        }
    }
    #[test]
    fn debug_crossing() {
        let lattice = (Kernel::WendlandC2, 3.0, 3);
        let phases = TIN.phases(540.0);
        let law = FreezingLaw::of(lattice, &phases, &[0.0]);
        for deficit in [5.0, 11.0, 17.0] {
            for surface in [-30.0, -34.0, -34.9, -34.99, -35.0, -35.001, -35.01, -35.05, -35.1, -35.2, -35.5, -36.0, -36.5, -36.9, -37.0] {
                let q0 = freezing_flux(&phases, 0.0, surface);
                println!("{deficit} {surface}: flux {:.4} u0 {:.4} sim {:.4}", law.flux(0.0, deficit, surface, -37.0), law.flux(0.0, deficit, surface, surface), 2.0*q0*q0/deficit);
            }
        }
    }
}
