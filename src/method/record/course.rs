//! Drops of several speeds: between two recorded speeds, amounts at equal times over D/U are
//! interpolated.

use super::profile::{Amounts, Profile};
use super::tail::Tail;

/// Relative difference below which two speeds are equal.
const SAME: f64 = 1e-6;

/// Profiles in the order of their speeds, over the same rings.
#[derive(Debug, Clone, PartialEq)]
pub struct Course {
    profiles: Vec<(Profile, Option<Tail>)>,
    /// Ages of each profile between which a mean and a slope represent its heat well enough [s].
    turns: Vec<Vec<f64>>,
    /// Total heat per kelvin that each ring of each profile receives [J/K].
    wholes: Vec<Vec<f64>>,
    /// Largest film diameter of each profile [m].
    spreads: Vec<f64>,
}

impl Course {
    /// Creates a course; refuses incompatible profiles.
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

    /// Radius of the outermost ring [m].
    pub fn radius(&self) -> f64 {
        self.profiles[0].0.radius
    }

    /// Slowest and fastest drop [m/s].
    pub fn speeds(&self) -> [f64; 2] {
        [self.profiles[0].0.speed, self.profiles[self.profiles.len() - 1].0.speed]
    }

    /// Returns true if the course covers drops of a speed.
    pub fn knows(&self, speed: f64) -> bool {
        let [slowest, fastest] = self.speeds();
        speed >= slowest * (1.0 - SAME) && speed <= fastest * (1.0 + SAME)
    }

    /// Duration of a drop's contributions [s]; at the end only heat.
    pub fn duration(&self, speed: f64) -> f64 {
        let of = |(place, _): (usize, f64)| {
            let (profile, tail) = &self.profiles[place];
            let tail = tail.as_ref().map_or(0.0, Tail::duration);
            profile.duration * profile.speed / speed + tail
        };
        self.weights(speed).map(of).fold(0.0, f64::max)
    }

    /// Ages of a drop between which a mean and a slope represent its heat well enough [s]; none for
    /// a drop without heat.
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

    /// Largest fraction of a drop that had detached in small lumps when it was recorded.
    pub fn largest_stray(&self) -> f64 {
        self.profiles().map(|profile| profile.stray).fold(0.0, f64::max)
    }

    /// Diameter of the film at a time after contact [m].
    pub fn spread(&self, speed: f64, age: f64) -> f64 {
        let of = |(place, weight): (usize, f64)| {
            let (profile, _) = &self.profiles[place];
            weight * profile.spread_at(age * speed / profile.speed)
        };
        self.weights(speed).map(of).sum()
    }

    /// Amounts that each ring has received at a time after contact [s]. The heat of a ring is that
    /// of an age delayed by its lag.
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
                // Momentum is proportional to the speed.
                sum.push += weight * ratio * amounts.push;
                sum.outward += weight * ratio * amounts.outward;
            }
        }
        for (ring, sum) in sums.iter_mut().enumerate().filter(|(ring, _)| lags[*ring] != 0.0) {
            sum.heat = self.heat(speed, ring, age - lags[ring]);
        }
        sums
    }

    /// Heat per kelvin that one ring has received at a time [s] after contact [J/K].
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

    /// Total heat per kelvin that a ring receives [J/K].
    pub fn whole(&self, speed: f64, ring: usize) -> f64 {
        let weights = self.weights(speed);
        weights.map(|(place, weight)| weight * self.wholes[place][ring]).sum()
    }

    /// Indices and weights of the profiles that make up a drop of a speed.
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

/// Age at which a drop has transferred half of its heat [s], found by bisection.
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

/// Total heat that each ring receives [J/K].
fn whole((profile, tail): &(Profile, Option<Tail>)) -> Vec<f64> {
    let end = profile.at(profile.duration).into_iter().enumerate();
    let rest = |ring: usize| tail.as_ref().map_or(0.0, |t| t.shares()[ring] * t.heat(t.duration()));
    end.map(|(ring, amounts)| amounts.heat + rest(ring)).collect()
}

/// Resolves a thousandth of a range that spans a factor of a million.
const HALVINGS: usize = 30;

/// First age relative to the profile's duration: while the drop comes down.
const FIRST: f64 = 0.1;
/// Ages over the half time: the remaining heat of a film falls to a tenth in five of them.
const COOLING: [f64; 12] = [1.0, 2.0, 4.0, 6.0, 8.0, 10.0, 15.0, 30.0, 60.0, 120.0, 1e3, 1e4];

/// Ages that double until the half time, because fluxes fall like 1/√t until then, and then follow
/// the cooling of a film.
fn turns(known: &(Profile, Option<Tail>)) -> Vec<f64> {
    let half = half_time(known);
    if half.is_infinite() {
        return Vec::new();
    }
    turns_of_film(known.0.duration, half)
}

/// Same as `turns` for a drop recorded over a `duration` with a known half time [s].
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
    fn speeds_are_interpolated_within_the_course_only() {
        let course = Course::new(vec![profile(1.0), profile(2.0)]).unwrap();
        assert!(course.knows(1.0) && course.knows(1.5) && course.knows(2.0));
        assert!(!course.knows(0.9) && !course.knows(2.1));
        // These profiles coincide over D/U, so that interpolation between them is exact.
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
    fn incompatible_profiles_are_refused() {
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
