//! What a drop gives to the rings of a wall in the course of its impact.

use super::tail::Tail;

/// What a ring got since the drop touched the wall.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Amounts {
    /// Over the difference between the drop's temperature and that of the wall without it [J/K].
    pub heat: f64,
    /// Momentum into the wall [N s].
    pub push: f64,
    /// Momentum outward along the radius [N s].
    pub outward: f64,
}

impl Amounts {
    /// What lies between this and a later or another value, a part of it.
    pub fn towards(self, other: Self, part: f64) -> Self {
        let between = |a: f64, b: f64| a + part * (b - a);
        Self {
            heat: between(self.heat, other.heat),
            push: between(self.push, other.push),
            outward: between(self.outward, other.outward),
        }
    }
}

/// A drop of one speed.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// Towards the wall as it touches it [m/s].
    pub speed: f64,
    /// Heat capacity of the drop [J/K].
    pub heat_capacity: f64,
    /// [s]
    pub duration: f64,
    /// Rings of equal width, out to this radius [m].
    pub rings: usize,
    pub radius: f64,
    /// At equal distances in time, the first after one of them; all rings of a time together.
    pub amounts: Vec<Amounts>,
    /// Diameter of the film at these times [m].
    pub spread: Vec<f64>,
    /// Largest part of the fluid that had come off it in small lumps at one of these times.
    pub stray: f64,
}

impl Profile {
    pub fn samples(&self) -> usize {
        self.spread.len()
    }

    /// Of all rings after a time [s], as if the flux were even between two samples; at the end what there is then.
    pub fn at(&self, time: f64) -> Vec<Amounts> {
        let (before, part) = self.place(time);
        let of = |sample: usize| match sample {
            0 => vec![Amounts::default(); self.rings],
            sample => self.amounts[(sample - 1) * self.rings..sample * self.rings].to_vec(),
        };
        let (from, to) = (of(before), of((before + 1).min(self.samples())));
        from.into_iter().zip(to).map(|(a, b)| a.towards(b, part)).collect()
    }

    /// Heat of one ring after a time [s], for each kelvin [J/K].
    pub fn heat_of(&self, ring: usize, time: f64) -> f64 {
        let (before, part) = self.place(time);
        let of = |sample: usize| match sample {
            0 => 0.0,
            sample => self.amounts[(sample - 1) * self.rings + ring].heat,
        };
        let (from, to) = (of(before), of((before + 1).min(self.samples())));
        from + part * (to - from)
    }

    /// Diameter of the film after a time [m].
    pub fn spread_at(&self, time: f64) -> f64 {
        let (before, part) = self.place(time);
        let of = |sample: usize| match sample {
            0 => 0.0,
            sample => self.spread[sample - 1],
        };
        let (from, to) = (of(before), of((before + 1).min(self.samples())));
        from + part * (to - from)
    }

    /// Largest diameter of the film [m].
    pub fn largest_spread(&self) -> f64 {
        self.spread.iter().copied().fold(0.0, f64::max)
    }

    /// How the drop goes on to cool when the profile has ended.
    pub fn tail(&self) -> Option<Tail> {
        Tail::of(self)
    }

    /// The sample before a time, 0 for the beginning, and how far the time is on the way to the next.
    fn place(&self, time: f64) -> (usize, f64) {
        let samples = self.samples() as f64;
        let at = (time / self.duration * samples).clamp(0.0, samples);
        let before = at.floor().min(samples);
        (before as usize, at - before)
    }

    /// Refuses what no drop gives, with what is wrong.
    pub fn check(&self) -> Result<(), String> {
        let Self { speed, heat_capacity, duration, radius, rings, .. } = self;
        let fine = |x: f64| x.is_finite() && x > 0.0;
        if ![*speed, *duration, *radius].into_iter().all(fine) || *rings == 0 {
            return Err("a speed, time or radius is not positive".to_owned());
        }
        if self.amounts.len() != self.samples() * rings || self.samples() < 2 {
            return Err("its numbers of rings and times do not go together".to_owned());
        }
        let of = |a: &Amounts| [a.heat, a.push, a.outward];
        let numbers = self.amounts.iter().flat_map(of).chain(self.spread.iter().copied());
        if !numbers.chain([*heat_capacity]).all(f64::is_finite) {
            return Err("an amount is not finite".to_owned());
        }
        if !(0.0..=1.0).contains(&self.stray) {
            return Err("the part of it that came off is none".to_owned());
        }
        let given: f64 = self.at(*duration).iter().map(|amounts| amounts.heat).sum();
        if given > MOST_HEAT * heat_capacity {
            return Err(format!("it gives {:.3} of its heat", given / heat_capacity));
        }
        Ok(())
    }
}

/// Heat that a drop gives over all that it has, with the allowance that particles need.
const MOST_HEAT: f64 = 1.01;
