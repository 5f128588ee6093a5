//! Drops of several speeds: between two that are known, amounts at equal times over D/U are interpolated.

use super::profile::{Amounts, Profile};
use super::tail::Tail;

/// Relative difference of speeds that counts as none.
const SAME: f64 = 1e-6;

/// Profiles in the order of their speeds, over the same rings.
#[derive(Debug, Clone, PartialEq)]
pub struct Course {
    profiles: Vec<(Profile, Option<Tail>)>,
    /// Ages of each between which its heat changes little enough to be told by a mean and a slope [s].
    turns: Vec<Vec<f64>>,
    /// Heat that each ring of each has got at last, for each kelvin [J/K].
    wholes: Vec<Vec<f64>>,
    /// Largest diameter of the film of each [m].
    spreads: Vec<f64>,
}

impl Course {
    /// Refuses profiles that do not go together.
    pub fn new(profiles: Vec<Profile>) -> Result<Self, String> {
        let Some(first) = profiles.first() else { return Err("there is no profile".to_owned()) };
        profiles.iter().try_for_each(Profile::check)?;
        let alike = |other: &Profile| {
            (other.rings, other.radius.to_bits()) == (first.rings, first.radius.to_bits())
        };
        if !profiles.iter().all(alike) {
            return Err("its profiles have other rings".to_owned());
        }
        if profiles.windows(2).any(|pair| pair[0].speed >= pair[1].speed) {
            return Err("its speeds do not ascend".to_owned());
        }
        let with_tail = |profile: Profile| {
            let tail = profile.tail();
            (profile, tail)
        };
        let profiles: Vec<_> = profiles.into_iter().map(with_tail).collect();
        let turns = profiles.iter().map(turns).collect();
        let wholes = profiles.iter().map(whole).collect();
        let spreads = profiles.iter().map(|(profile, _)| profile.largest_spread()).collect();
        Ok(Self { profiles, turns, wholes, spreads })
    }

    pub fn profiles(&self) -> impl Iterator<Item = &Profile> {
        self.profiles.iter().map(|(profile, _)| profile)
    }

    pub fn rings(&self) -> usize {
        self.profiles[0].0.rings
    }

    /// Of the outermost ring [m].
    pub fn radius(&self) -> f64 {
        self.profiles[0].0.radius
    }

    /// Slowest and fastest drop [m/s].
    pub fn speeds(&self) -> [f64; 2] {
        [self.profiles[0].0.speed, self.profiles[self.profiles.len() - 1].0.speed]
    }

    /// Whether drops of a speed are known.
    pub fn knows(&self, speed: f64) -> bool {
        let [slowest, fastest] = self.speeds();
        speed >= slowest * (1.0 - SAME) && speed <= fastest * (1.0 + SAME)
    }

    /// How long a drop gives anything [s], and how long heat alone.
    pub fn duration(&self, speed: f64) -> f64 {
        let of = |(place, _): (usize, f64)| {
            let (profile, tail) = &self.profiles[place];
            let tail = tail.as_ref().map_or(0.0, Tail::duration);
            profile.duration * profile.speed / speed + tail
        };
        self.weights(speed).map(of).fold(0.0, f64::max)
    }

    /// Ages of a drop between which its heat changes little enough to be told by a mean and a slope [s]; none of a drop
    /// that gives no heat.
    pub fn turns(&self, speed: f64) -> impl Iterator<Item = f64> {
        let place = self.weights(speed).next().map_or(0, |(place, _)| place);
        let ratio = self.profiles[place].0.speed / speed;
        self.turns[place].iter().map(move |age| ratio * age)
    }

    /// Largest diameter of the film [m].
    pub fn largest_spread(&self, speed: f64) -> f64 {
        let weights = self.weights(speed);
        weights.map(|(place, weight)| weight * self.spreads[place]).sum()
    }

    /// Largest part of a drop that had come off in small lumps as it was recorded.
    pub fn largest_stray(&self) -> f64 {
        self.profiles().map(|profile| profile.stray).fold(0.0, f64::max)
    }

    /// Diameter of the film a time after the contact [m].
    pub fn spread(&self, speed: f64, age: f64) -> f64 {
        let of = |(place, weight): (usize, f64)| {
            let (profile, _) = &self.profiles[place];
            weight * profile.spread_at(age * speed / profile.speed)
        };
        self.weights(speed).map(of).sum()
    }

    /// Amounts that each ring has got a time after the contact [s]. The heat of a ring is that of an age that lags behind.
    pub fn amounts(&self, speed: f64, age: f64, lags: &[f64]) -> Vec<Amounts> {
        let mut sums = vec![Amounts::default(); self.rings()];
        if age <= 0.0 {
            return sums;
        }
        for (place, weight) in self.weights(speed) {
            let (profile, tail) = &self.profiles[place];
            let ratio = speed / profile.speed;
            let heat = tail.as_ref().map_or(0.0, |tail| tail.heat(age - profile.duration / ratio));
            let shares = tail.as_ref().map_or(&[][..], Tail::shares);
            for (ring, (sum, amounts)) in sums.iter_mut().zip(profile.at(age * ratio)).enumerate() {
                if lags[ring] == 0.0 {
                    let rest = shares.get(ring).map_or(0.0, |share| share * heat);
                    sum.heat += weight * (amounts.heat + rest);
                }
                // Momentum is in proportion to the speed.
                sum.push += weight * ratio * amounts.push;
                sum.outward += weight * ratio * amounts.outward;
            }
        }
        for (ring, sum) in sums.iter_mut().enumerate().filter(|(ring, _)| lags[*ring] != 0.0) {
            sum.heat = self.heat(speed, ring, age - lags[ring]);
        }
        sums
    }

    /// Heat that one ring has got a time after the contact [s], for each kelvin [J/K].
    pub fn heat(&self, speed: f64, ring: usize, age: f64) -> f64 {
        if age <= 0.0 {
            return 0.0;
        }
        let of = |(place, weight): (usize, f64)| {
            let (profile, tail) = &self.profiles[place];
            let ratio = speed / profile.speed;
            let rest = tail.as_ref().map_or(0.0, |tail| {
                tail.shares()[ring] * tail.heat(age - profile.duration / ratio)
            });
            weight * (profile.heat_of(ring, age * ratio) + rest)
        };
        self.weights(speed).map(of).sum()
    }

    /// Heat that a ring gets in all, for each kelvin [J/K].
    pub fn whole(&self, speed: f64, ring: usize) -> f64 {
        let weights = self.weights(speed);
        weights.map(|(place, weight)| weight * self.wholes[place][ring]).sum()
    }

    /// Places of the profiles that make up a drop of some speed, and their weights.
    fn weights(&self, speed: f64) -> impl Iterator<Item = (usize, f64)> + use<> {
        let of = |place: usize| self.profiles[place].0.speed;
        let above = (0..self.profiles.len()).find(|&place| of(place) * (1.0 + SAME) >= speed);
        let above = above.unwrap_or(self.profiles.len() - 1);
        let is_known = above == 0 || (of(above) / speed - 1.0).abs() <= SAME;
        let weights = if is_known {
            [Some((above, 1.0)), None]
        } else {
            let share = (speed - of(above - 1)) / (of(above) - of(above - 1));
            [Some((above - 1, 1.0 - share)), Some((above, share))]
        };
        weights.into_iter().flatten()
    }
}

/// When a drop has given half of what heat it gives [s], found by halving.
fn half_time((profile, tail): &(Profile, Option<Tail>)) -> f64 {
    let heat = |age: f64| {
        let of_profile: f64 = profile.at(age).iter().map(|amounts| amounts.heat).sum();
        of_profile + tail.as_ref().map_or(0.0, |tail| tail.heat(age - profile.duration))
    };
    let end = profile.duration + tail.as_ref().map_or(0.0, Tail::duration);
    let half = 0.5 * heat(end);
    if half <= 0.0 {
        return f64::INFINITY;
    }
    let (mut low, mut high) = (0.0, end);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if heat(middle) < half { low = middle } else { high = middle }
    }
    high
}

/// Heat that each ring has got at last [J/K].
fn whole((profile, tail): &(Profile, Option<Tail>)) -> Vec<f64> {
    let end = profile.at(profile.duration).into_iter().enumerate();
    let rest = |ring: usize| tail.as_ref().map_or(0.0, |t| t.shares()[ring] * t.heat(t.duration()));
    end.map(|(ring, amounts)| amounts.heat + rest(ring)).collect()
}

/// To a thousandth of what lasts a million times as long.
const HALVINGS: usize = 30;

/// The first, over what the profile lasts: while its drop comes down.
const FIRST: f64 = 0.1;
/// Ages over that at which half of the heat has been given: what is left in a film falls to a tenth in five of it.
const COOLING: [f64; 12] = [1.0, 2.0, 4.0, 6.0, 8.0, 10.0, 15.0, 30.0, 60.0, 120.0, 1e3, 1e4];

/// Ages that double until half of the heat has been given, as fluxes fall like 1/√t until then, and on as a film cools.
fn turns(known: &(Profile, Option<Tail>)) -> Vec<f64> {
    let half = half_time(known);
    if half.is_infinite() {
        return Vec::new();
    }
    turns_of_film(known.0.duration, half)
}

/// The same of a drop of which something is known for a `duration`, and which has given half of its heat at an age [s].
pub fn turns_of_film(duration: f64, half: f64) -> Vec<f64> {
    let mut age = FIRST * duration;
    let mut ages = Vec::new();
    while age < half {
        ages.push(age);
        age *= 2.0;
    }
    ages.extend(COOLING.map(|times| times * half));
    ages
}

#[cfg(test)]
mod tests {
    use super::*;

    fn profile(speed: f64) -> Profile {
        let (rings, samples) = (2, 8);
        let amounts = (1..=samples).flat_map(|n| {
            let part = n as f64 / samples as f64;
            (0..rings).map(move |_| Amounts {
                heat: 0.2 * part,
                push: 0.5 * speed * part,
                outward: 0.0,
            })
        });
        Profile {
            speed,
            heat_capacity: 1.0,
            duration: 4.0 / speed,
            rings,
            radius: 1.0,
            amounts: amounts.collect(),
            spread: vec![1.0; samples],
            stray: 0.0,
        }
    }

    #[test]
    fn speeds_between_are_interpolated_and_others_unknown() {
        let course = Course::new(vec![profile(1.0), profile(2.0)]).unwrap();
        assert!(course.knows(1.0) && course.knows(1.5) && course.knows(2.0));
        assert!(!course.knows(0.9) && !course.knows(2.1));
        // These profiles are alike over D/U, so that any speed between is known exactly.
        for speed in [1.0, 1.25, 1.9, 2.0] {
            let found = course.amounts(speed, 2.0 / speed, &[0.0; 2])[1];
            assert!((found.heat - 0.1).abs() < 1e-12);
            assert!((found.push - 0.25 * speed).abs() < 1e-12);
            let end = course.amounts(speed, 1e9, &[0.0; 2]);
            let heat: f64 = end.iter().map(|amounts| amounts.heat).sum();
            assert!((heat - 1.0).abs() < 1e-9, "{heat}");
        }
    }

    #[test]
    fn what_does_not_go_together_is_refused() {
        assert!(Course::new(Vec::new()).is_err());
        assert!(Course::new(vec![profile(2.0), profile(1.0)]).is_err());
        assert!(Course::new(vec![profile(1.0), Profile { radius: 2.0, ..profile(2.0) }]).is_err());
        let mut hot = profile(1.0);
        hot.amounts[15].heat = 2.0;
        assert!(Course::new(vec![hot]).is_err());
        let mut broken = profile(1.0);
        broken.amounts[3].push = f64::NAN;
        assert!(Course::new(vec![broken]).is_err());
    }
}
