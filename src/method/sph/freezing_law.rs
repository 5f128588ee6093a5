//! Heat of the layer of particles at a wall on which the fluid freezes.

use std::f64::consts::PI;

use super::contact_law::{ContactLaw, THICK, couplings, effusivity};
use super::freezing_curve::{Curve, KNOTS, Lattice, content_at, sections};
use super::phases::Phases;
use super::wall_heat::{BEYOND_ROUNDING, is_beyond_release};
use crate::closed_form::special::erfcx;
use crate::kernel::Kernel;

/// Cooling of the particles at a wall with latent heat, for frozen skins thinner and thicker than the particle layer.
///
/// **Constant surface temperature.** A half space then loses the flux `q = q₀/√t`
/// ([`freezing_flux`](super::freezing_flux)). The layer of particles has lost the deficit E. While it supplies all
/// the heat, `q = 2q₀²/E`; later a [`Curve`], which a lattice of layers yields under the exact flux, corrects it.
/// Beyond the end of the curve, and after an unknown past, the layer has a uniform temperature: `q = 2C (ψ − ψ_s)`
/// with the heat potentials of layer and surface, over δ. Without freezing this is the [`ContactLaw`].
///
/// **Resistance.** Between the surface T_s and a place of temperature T_c the flux is `(T_s − T_c)/R`. It equals that
/// of the law at the deficit and T_s, times a factor for its history,
/// `F = (π/2) u (u − 1 + 2y/√π)/(1 − u)²`, `u = (T_s − T_c)/(T_∞ − T_c) = exp(y²) erfc y`: exact for a half space
/// that only conducts (H. S. Carslaw and J. C. Jaeger, *Conduction of Heat in Solids*, Oxford 1959, §2.7). The factor
/// fades to 1, its value for a skin without heat capacity, as `2q₀²/(Δh Δψ)` rises from 2/π to 1, and as the layer
/// cools through. So the law is approximate if a fluid freezes across a resistance.
///
/// **Step.** `1/q` is linear in E for a layer that supplies all the heat. So the deficit rises in a step by the
/// harmonic mean of the fluxes at both ends, and never passes the content at the wall's temperature.
///
/// Units: contents and potentials in kelvins, times over δ²/κ, fluxes over k/δ, of the molten fluid.
#[derive(Debug, Clone, PartialEq)]
pub struct FreezingLaw {
    phases: Phases,
    contact: ContactLaw,
    /// Conductivity of the lattice over the nominal one, and 2C.
    strength: f64,
    decay: f64,
    /// Bends of the fluid above surfaces hotter than the liquidus.
    molten: Vec<f64>,
    /// F at equal distances of u from 0 to 1.
    history: Vec<f64>,
    /// Curves of distinct temperatures of release, which increase.
    releases: Vec<Release>,
}

/// Curves of a temperature of release, for surfaces between liquidus and solidus, and below the solidus.
#[derive(Debug, Clone, PartialEq)]
struct Release {
    start: f64,
    curves: [Vec<Curve>; 2],
}

/// State of a layer and its wall: contents before contact and now, and the wall's temperature above the reference [K].
#[derive(Debug, Clone, Copy)]
pub struct Contents {
    pub before: f64,
    pub fluid: f64,
    pub wall: f64,
}

/// Heat of a layer in a step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Lost {
    /// Content that the layer loses [K].
    pub content: f64,
    /// Linear decrease of the flux, see [`Loss`](super::resistive_law::Loss).
    pub fall: f64,
}

/// A surface temperature between two tabulated ones.
#[derive(Clone, Copy)]
struct Place {
    /// 0 between liquidus and solidus, 1 below.
    range: usize,
    /// Distance from the first table of the range.
    at: f64,
}

/// Number of intervals of the tables in both ranges. They grow in proportion to the distance from the liquidus, but
/// for distances below `FINEST` of the largest. The largest below the solidus is that of a potential drop of
/// `COLDEST/(1 − COLDEST)` times the latent heat.
const INTERVALS: [usize; 2] = [16, 64];
const FINEST: f64 = 1e-3;
const COLDEST: f64 = 0.96;
/// Number of entries of the table of F.
const ENTRIES: usize = 65;
/// Largest product of F and the bend, above its exact bound π²/8, for brackets of roots.
const MOST: f64 = 1.3;
/// Number of rounds that reconcile the temperature within a resistance.
const ROUNDS: usize = 2;
/// Number of steps of a search for a root, and its relative accuracy.
const STEPS: usize = 60;
const ACCURACY: f64 = 1e-6;
/// Change of the wall's temperature over its difference from the layer that determines the slope.
const NUDGE: f64 = 1e-3;
/// A flux like 1/√t ends at half its mean, and has the `fall` 3 (1 − π/4) = 0.644, not 0.5.
const SINGULAR: f64 = 0.5752;

impl FreezingLaw {
    /// Law for a kernel of support radius over Δx, and a dimension. `starts` are temperatures of release above the
    /// reference [K], not below the liquidus.
    pub fn of(
        (kernel, support, dimension): (Kernel, f64, usize),
        phases: &Phases,
        starts: &[f64],
    ) -> Self {
        let couplings = couplings(kernel, support, dimension);
        let strength = effusivity(&couplings).powi(2);
        let contact = ContactLaw::of(kernel, support, dimension);
        let decay = contact.decay();
        let lattice = Lattice { phases: *phases, couplings, strength, decay };
        let mut starts = starts.to_vec();
        starts.sort_by(f64::total_cmp);
        starts.dedup();
        Self {
            phases: *phases,
            contact,
            strength,
            decay,
            molten: lattice.molten_bends(),
            history: (0..ENTRIES).map(|n| history(n as f64 / (ENTRIES - 1) as f64)).collect(),
            releases: starts.iter().map(|&start| Release::of(&lattice, start)).collect(),
        }
    }

    /// Heat that the layer loses in a step of diffusion time `κΔt/δ²`. `resistances` over δ/k are those between the
    /// fluid and a place of constant temperature, and between that and the wall; for bodies that are half spaces
    /// they are in the ratio of the effusivities of wall and fluid.
    pub fn loss(&self, at: Contents, diffusion: f64, resistances: [f64; 2]) -> Lost {
        let (content, fall) = self.step(at, diffusion, resistances);
        Lost { content, fall }
    }

    /// Decrease of the content lost in such a step per rise of the wall's temperature; 0 at equal temperatures.
    pub fn slope(
        &self,
        at: Contents,
        diffusion: f64,
        resistances: [f64; 2],
        Lost { content, .. }: Lost,
    ) -> f64 {
        let gap = self.phases.rise(at.fluid) - at.wall;
        if content == 0.0 || gap == 0.0 {
            return 0.0;
        }
        if gap < 0.0 || at.wall >= self.phases.melting[1] {
            return content / gap;
        }
        let colder = Contents { wall: at.wall - NUDGE * gap, ..at };
        let more = self.step(colder, diffusion, resistances).0 - content;
        (more / (NUDGE * gap)).max(0.0)
    }

    /// Returns true if no contact with this wall explains the content of the layer, which the law then regards as that
    /// before contact: a hotter wall has warmed it, or a colder one has cooled it, earlier. Of a layer of uniform
    /// temperature the law needs no past.
    pub fn begins_anew(&self, at: Contents, resistances: [f64; 2]) -> bool {
        let Contents { before, fluid, wall } = at;
        if self.stays_molten(at, resistances) {
            return is_beyond_release(before, fluid, wall);
        }
        let cools = self.phases.potential(fluid) > self.potential(wall);
        cools && fluid - before.max(self.phases.melting[1]) > BEYOND_ROUNDING
    }

    /// Returns true if molten fluid is in perfect contact with a wall that freezes none.
    fn stays_molten(&self, Contents { fluid, wall, .. }: Contents, resistances: [f64; 2]) -> bool {
        let [_, molten] = self.phases.contents();
        resistances == [0.0; 2] && wall >= self.phases.melting[1] && fluid >= molten
    }

    /// Content lost and decrease of the flux.
    fn step(&self, at: Contents, diffusion: f64, resistances: [f64; 2]) -> (f64, f64) {
        let Contents { before, fluid, wall } = at;
        let perfect = resistances == [0.0; 2];
        if self.stays_molten(at, resistances) {
            let deficit = Some((before - fluid) / (before - wall)).filter(|d| d.is_finite());
            return (self.contact.relaxation(deficit, diffusion) * (fluid - wall), 0.0);
        }
        let at = Contents { before: before.max(fluid).max(self.phases.melting[1]), ..at };
        let warms = self.phases.potential(fluid) <= self.potential(wall);
        if perfect && (warms || at.before - fluid >= self.end(at.before, wall)) {
            return (self.relaxed(fluid, self.potential(wall), self.decay * diffusion), 0.0);
        }
        match warms {
            true => self.warmed(at, diffusion, resistances[0] + resistances[1]),
            false => self.cooled(at, diffusion, resistances),
        }
    }

    /// Step of a layer of uniform temperature that a hotter wall warms through a resistance.
    fn warmed(&self, at: Contents, diffusion: f64, resistance: f64) -> (f64, f64) {
        let flux = |content: f64, flux: f64| {
            let surface = self.potential(at.wall - resistance * flux);
            self.decay * (surface - self.phases.potential(content))
        };
        let most = (at.wall - self.phases.rise(at.fluid)) / resistance;
        let first = root(most.min(flux(at.fluid, 0.0)), |of| flux(at.fluid, of));
        let gain = |last: f64| diffusion * mean(first, last);
        let last = root(first, |last| flux(at.fluid + gain(last), last));
        (-gain(last), fall(last * diffusion, gain(last)))
    }

    /// Step of a layer above a colder wall.
    ///
    /// One temperature of the place within the resistance serves the whole step. At the end the flux passes the
    /// wall's part of the resistance.
    fn cooled(&self, at: Contents, diffusion: f64, [near, far]: [f64; 2]) -> (f64, f64) {
        let deficit = at.before - at.fluid;
        let drop = self.phases.potential(at.fluid) - self.potential(at.wall);
        let squared = MOST * self.twice_squared(at.before, at.wall);
        let most = (squared / diffusion).sqrt() + self.decay * drop;
        let highest = (at.before - at.wall) / (near + far);
        let ending = |first: f64| {
            root(most.min(highest).min(first), |last| {
                let plane = at.wall + far * last;
                let deficit = deficit + diffusion * mean(first, last);
                self.flux(at.before, deficit, plane + near * last, plane)
            })
        };
        let mut first = self.first(at.before, deficit, at.wall, near + far);
        let mut last = ending(first);
        if far > 0.0 {
            for _ in 0..ROUNDS {
                first = self.first(at.before, deficit, at.wall + far * last, near);
                last = ending(first);
            }
        }
        let content = diffusion * mean(first, last);
        (content, fall(last * diffusion, content))
    }

    /// Flux at the start of a step.
    fn first(&self, before: f64, deficit: f64, plane: f64, near: f64) -> f64 {
        let most = if near > 0.0 { (before - plane) / near } else { f64::INFINITY };
        if deficit <= 0.0 || plane >= before {
            return most.max(0.0);
        }
        if near == 0.0 {
            return self.flux(before, deficit, plane, plane);
        }
        let drop = self.phases.potential(before - deficit) - self.potential(plane);
        let bound = MOST * self.twice_squared(before, plane) / deficit + self.decay * drop.max(0.0);
        root(most.min(bound), |of| self.flux(before, deficit, plane + near * of, plane))
    }

    /// Potential at a temperature.
    fn potential(&self, rise: f64) -> f64 {
        self.phases.potential(self.phases.content(rise))
    }

    /// Upper bound of 2q₀².
    fn twice_squared(&self, before: f64, surface: f64) -> f64 {
        let heat = before - self.phases.content(surface).min(self.phases.contents()[0]);
        heat * (self.potential(before) - self.potential(surface)) * self.strength.max(1.0)
    }

    /// Flux at a deficit and a surface temperature, beyond which a resistance ends at the temperature of a plane.
    fn flux(&self, before: f64, deficit: f64, surface: f64, plane: f64) -> f64 {
        let liquidus = self.phases.melting[1];
        let part = ((surface - plane) / (before - plane)).clamp(0.0, 1.0);
        let excess = pick(&self.history, part * (ENTRIES - 1) as f64) - 1.0;
        if surface >= liquidus {
            return self.molten_flux(before, deficit, surface, excess);
        }
        let place = Place::of(&self.phases, surface);
        if place.at >= 1.0 || place.range > self.first_range() {
            return self.frozen_flux(before, deficit, surface, place, excess);
        }
        // Next to the liquidus the flux is linear in the temperature; there the curves end with the molten one.
        let first = Place { at: 1.0, ..place };
        let colder = first.surface(&self.phases);
        let share = (surface - liquidus) / (colder - liquidus);
        let [hot, cold] = [
            self.molten_flux(before, deficit, liquidus, excess),
            self.frozen_flux(before, deficit, colder, first, excess),
        ];
        hot + share * (cold - hot)
    }

    /// First of the ranges that exist.
    fn first_range(&self) -> usize {
        usize::from(self.phases.melting[0] == self.phases.melting[1])
    }

    /// Flux above a surface hotter than the liquidus. `excess` is F − 1.
    fn molten_flux(&self, before: f64, deficit: f64, surface: f64, excess: f64) -> f64 {
        let step = before - surface;
        let fraction = deficit / step;
        if step <= 0.0 || fraction >= THICK {
            let drop = self.phases.potential(before - deficit) - self.potential(surface);
            return self.decay * drop.max(0.0);
        }
        let bend = pick(&self.molten, fraction / THICK * (self.molten.len() - 1) as f64);
        let factor = 1.0 + excess * (1.0 - fraction);
        2.0 / PI * self.strength * step * bend * factor / fraction
    }

    /// Flux above a surface colder than the liquidus.
    fn frozen_flux(
        &self,
        before: f64,
        deficit: f64,
        surface: f64,
        place: Place,
        excess: f64,
    ) -> f64 {
        let low = self.potential(surface);
        let (below, above, share) = self.between(before);
        let mix = |of: &dyn Fn(&Release) -> f64| {
            let first = of(below);
            if share > 0.0 { first + share * (of(above) - first) } else { first }
        };
        let end = mix(&|release| release.mean(place, |curve| curve.end));
        let end = before
            - content_at(&self.phases, low + end * (self.potential(self.phases.melting[1]) - low));
        if deficit >= end {
            return self.decay * (self.phases.potential(before - deficit) - low).max(0.0);
        }
        let edges = sections(&self.phases, before, end);
        let section = edges[1..3].iter().filter(|&&edge| deficit >= edge).count();
        let width = edges[section + 1] - edges[section];
        let knot = (deficit - edges[section]) / width * (KNOTS - 1) as f64;
        let bend = mix(&|release| release.mean(place, |curve| pick(&curve.bends[section], knot)));
        let similarity = mix(&|release| release.mean(place, |curve| curve.similarity));
        let all = (before - self.phases.content(surface)) * (self.potential(before) - low);
        let conducts = (1.0 - similarity / self.strength) / (1.0 - 2.0 / PI);
        let factor = 1.0 + excess * conducts.clamp(0.0, 1.0) * (1.0 - deficit / end);
        similarity * all * bend * factor / deficit
    }

    /// Deficit at which the curve of a surface ends.
    fn end(&self, before: f64, surface: f64) -> f64 {
        if surface >= self.phases.melting[1] {
            return THICK * (before - surface);
        }
        let place = Place::of(&self.phases, surface);
        let (below, above, share) = self.between(before);
        let [first, last] = [below, above].map(|release| release.mean(place, |curve| curve.end));
        let low = self.potential(surface);
        let drop = self.potential(self.phases.melting[1]) - low;
        before - content_at(&self.phases, low + (first + share * (last - first)) * drop)
    }

    /// Releases on both sides of a temperature, and its share of the way between them.
    fn between(&self, before: f64) -> (&Release, &Release, f64) {
        let above = self.releases.partition_point(|release| release.start < before);
        let last = self.releases.len() - 1;
        let [a, b] = [above.saturating_sub(1), above.min(last)].map(|n| &self.releases[n]);
        let share = if b.start > a.start { (before - a.start) / (b.start - a.start) } else { 0.0 };
        (a, b, share)
    }

    /// Content that a layer of uniform temperature loses towards a surface of some potential: exponentially in a
    /// phase, linearly in time where melting is isothermal.
    fn relaxed(&self, content: f64, low: f64, time: f64) -> f64 {
        let phases = &self.phases;
        let edges = phases.contents();
        let cools = phases.potential(content) > low;
        let (mut now, mut rest) = (content, time);
        loop {
            let gap = phases.potential(now) - low;
            let ahead = match cools {
                true => edges.into_iter().rev().find(|&edge| edge < now),
                false => edges.into_iter().find(|&edge| edge > now),
            };
            let next = ahead.unwrap_or(if cools { now - 1.0 } else { now + 1.0 });
            let slope = (phases.potential(now) - phases.potential(next)) / (now - next);
            let decayed = |time: f64| match slope > 0.0 {
                true => -gap / slope * (-slope * time).exp_m1(),
                false => gap * time,
            };
            let left = phases.potential(next) - low;
            let way = now - next;
            let time = match slope > 0.0 {
                true if left / gap > 0.0 => (gap / left).ln() / slope,
                true => f64::INFINITY,
                false => way / gap,
            };
            if gap == 0.0 || ahead.is_none() || time >= rest {
                return content - now + decayed(rest);
            }
            (now, rest) = (next, rest - time);
        }
    }
}

impl Place {
    /// Place of a surface temperature below the liquidus.
    fn of(phases: &Phases, surface: f64) -> Self {
        let ([solidus, liquidus], [frozen, molten]) = (phases.melting, phases.contents());
        let range = usize::from(surface < solidus || solidus == liquidus);
        let distance = if range == 0 {
            (liquidus - surface) / (liquidus - solidus)
        } else {
            let drop = phases.conduction * (solidus - surface);
            drop / (drop + molten - frozen) / COLDEST
        };
        let part = (distance / FINEST).ln_1p() / (1.0 / FINEST).ln_1p();
        Self { range, at: INTERVALS[range] as f64 * part.min(1.0) }
    }

    /// Surface temperature of the place.
    fn surface(&self, phases: &Phases) -> f64 {
        let ([solidus, liquidus], [frozen, molten]) = (phases.melting, phases.contents());
        let part = self.at / INTERVALS[self.range] as f64;
        let distance = FINEST * (part * (1.0 / FINEST).ln_1p()).exp_m1();
        if self.range == 0 {
            return liquidus - (liquidus - solidus) * distance;
        }
        let cold = COLDEST * distance;
        solidus - (molten - frozen) * cold / (1.0 - cold) / phases.conduction
    }
}

impl Release {
    fn of(lattice: &Lattice, start: f64) -> Self {
        let phases = &lattice.phases;
        let first_range = usize::from(phases.melting[0] == phases.melting[1]);
        let of_range = |range: usize| -> Vec<Curve> {
            if range < first_range {
                return Vec::new();
            }
            let curve = |n: usize| {
                // No curve belongs to the liquidus; the law does not use that table.
                let at = if range == first_range { n.max(1) } else { n };
                lattice.curve(start, Place { range, at: at as f64 }.surface(phases))
            };
            (0..=INTERVALS[range]).map(curve).collect()
        };
        Self { start, curves: [0, 1].map(of_range) }
    }

    /// A property of the curves, interpolated in the surface temperature.
    fn mean(&self, place: Place, of: impl Fn(&Curve) -> f64) -> f64 {
        let curves = &self.curves[place.range];
        let below = (place.at as usize).min(curves.len() - 2);
        let [a, b] = [below, below + 1].map(|n| of(&curves[n]));
        a + (place.at - below as f64) * (b - a)
    }
}

/// Harmonic mean of two fluxes, the first of which may be infinite.
fn mean(first: f64, last: f64) -> f64 {
    match last > 0.0 {
        true => 2.0 / (1.0 / first + 1.0 / last),
        false => 0.0,
    }
}

/// Linear decrease of a flux that ends with `last` if the mean is `whole`.
fn fall(last: f64, whole: f64) -> f64 {
    let fallen = if whole > 0.0 { (1.0 - last / whole).clamp(0.0, 0.5) } else { 0.0 };
    fallen * (1.0 + SINGULAR * fallen)
}

/// Value of a table at a place.
fn pick(table: &[f64], place: f64) -> f64 {
    let below = (place as usize).min(table.len() - 2);
    table[below] + (place - below as f64) * (table[below + 1] - table[below])
}

/// Flux up to a bound that equals a falling function of itself.
///
/// Inverse quadratic interpolation, or bisection where that is unsafe (T. R. Chandrupatla 1997, Adv. Eng. Softw. 28,
/// 145–149, doi 10.1016/S0965-9978(96)00051-8).
fn root(bound: f64, of: impl Fn(f64) -> f64) -> f64 {
    let value = |place: f64| excess(of(place), place);
    let (mut a, mut b) = ([bound, value(bound)], [0.0, 1.0]);
    if bound <= 0.0 || a[1] >= 0.0 {
        return bound.max(0.0);
    }
    let mut share = 0.5;
    for _ in 0..STEPS {
        let place = a[0] + share * (b[0] - a[0]);
        let next = [place, value(place)];
        let c = if (next[1] < 0.0) == (a[1] < 0.0) { a } else { std::mem::replace(&mut b, a) };
        a = next;
        let best = if a[1].abs() < b[1].abs() { a } else { b };
        let least = 0.5 * ACCURACY * best[0] / (b[0] - a[0]).abs();
        if least > 0.5 || best[1].abs() <= ACCURACY {
            return best[0];
        }
        let [x, y] = [(a[0] - b[0]) / (c[0] - b[0]), (a[1] - b[1]) / (c[1] - b[1])];
        share = if y * y < x && (1.0 - y).powi(2) < 1.0 - x {
            let ratio = (c[0] - a[0]) / (b[0] - a[0]);
            a[1] / (b[1] - a[1]) * c[1] / (b[1] - c[1])
                + ratio * a[1] / (c[1] - a[1]) * b[1] / (c[1] - b[1])
        } else {
            0.5
        };
        share = share.clamp(least, 1.0 - least);
    }
    a[0]
}

/// Excess of a flux over another, which is not negative, relative to their sum.
fn excess(one: f64, other: f64) -> f64 {
    match one {
        _ if one.is_infinite() => 1.0,
        _ if one <= 0.0 => -1.0,
        _ => (one - other) / (one + other),
    }
}

/// F at a fraction u of the temperature difference.
fn history(part: f64) -> f64 {
    /// Number of halvings of the logarithm of y, and its bounds.
    const HALVINGS: usize = 60;
    const BOUNDS: [f64; 2] = [-7.0, 12.0];
    if part == 0.0 {
        return 1.0;
    }
    if part == 1.0 {
        return PI * PI / 8.0;
    }
    let mut range = BOUNDS;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (range[0] + range[1]);
        range[usize::from(erfcx(middle.exp()) < part)] = middle;
    }
    let passed = part - 1.0 + 2.0 * range[0].exp() / PI.sqrt();
    0.5 * PI * part * passed / (1.0 - part).powi(2)
}

#[cfg(test)]
mod tests;
