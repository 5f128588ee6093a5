//! Heat and momentum that a drop transfers to the rings of a wall during its impact.

use super::tail::Tail;

/// Heat and momentum that a ring has received since the drop touched the wall.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Amounts {
    /// Heat over the difference between the temperatures of the drop and of the wall without it
    /// [J/K].
    pub heat: f64,
    /// Momentum into the wall [N s].
    pub push: f64,
    /// Momentum outward along the radius [N s].
    pub outward: f64,
}

impl Amounts {
    /// Interpolates linearly towards another value by the fraction `part`.
    pub fn towards(self, other: Self, part: f64) -> Self {
        let between = |a: f64, b: f64| a + part * (b - a);
        Self {
            heat: between(self.heat, other.heat),
            push: between(self.push, other.push),
            outward: between(self.outward, other.outward),
        }
    }
}

/// Profile of a drop of one speed.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// Speed towards the wall at contact [m/s].
    pub speed: f64,
    /// Heat capacity of the drop [J/K].
    pub heat_capacity: f64,
    /// Duration [s].
    pub duration: f64,
    /// Number of rings of equal width, and the radius of the outermost [m].
    pub rings: usize,
    pub radius: f64,
    /// Amounts at equidistant times, the first after one interval; all rings of a time together.
    pub amounts: Vec<Amounts>,
    /// Diameter of the film at these times [m].
    pub spread: Vec<f64>,
    /// Largest fraction of the fluid, over these times, that had detached in small lumps.
    pub stray: f64,
}

impl Profile {
    pub fn samples(&self) -> usize {
        self.spread.len()
    }

    /// Amounts of all rings at a time [s], for uniform fluxes between samples; constant after the
    /// end.
    pub fn at(&self, time: f64) -> Vec<Amounts> {
        let (before, part) = self.place(time);
        let of = |sample: usize| match sample {
            0 => vec![Amounts::default(); self.rings],
            sample => self.amounts[(sample - 1) * self.rings..sample * self.rings].to_vec(),
        };
        let (from, to) = (of(before), of((before + 1).min(self.samples())));
        from.into_iter().zip(to).map(|(a, b)| a.towards(b, part)).collect()
    }

    /// Heat per kelvin of one ring at a time [s] [J/K].
    pub fn heat_of(&self, ring: usize, time: f64) -> f64 {
        let (before, part) = self.place(time);
        let of = |sample: usize| match sample {
            0 => 0.0,
            sample => self.amounts[(sample - 1) * self.rings + ring].heat,
        };
        let (from, to) = (of(before), of((before + 1).min(self.samples())));
        from + part * (to - from)
    }

    /// Diameter of the film at a time [m].
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

    /// Further cooling of the drop after the end of the profile.
    pub fn tail(&self) -> Option<Tail> {
        Tail::of(self)
    }

    /// Index of the sample before a time (0 for the beginning), and the fraction of the interval to
    /// the next.
    fn place(&self, time: f64) -> (usize, f64) {
        let samples = self.samples() as f64;
        let at = (time / self.duration * samples).clamp(0.0, samples);
        let before = at.floor().min(samples);
        (before as usize, at - before)
    }

    /// Refuses amounts that no drop can transfer, with the reason.
    pub fn check(&self) -> Result<(), String> {
        let Self { speed, heat_capacity, duration, radius, rings, .. } = self;
        let fine = |x: f64| x.is_finite() && x > 0.0;
        if ![*speed, *duration, *radius].into_iter().all(fine) || *rings == 0 {
            return Err("a speed, time or radius is not positive".to_owned());
        }
        if self.amounts.len() != self.samples() * rings || self.samples() < 2 {
            return Err("its numbers of rings and times are inconsistent".to_owned());
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

/// Largest heat over that of the drop, with a tolerance for particles.
const MOST_HEAT: f64 = 1.01;
