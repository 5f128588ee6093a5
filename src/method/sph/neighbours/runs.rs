//! Lists of neighbours, one for each particle of a block.

use crate::method::sph::lanes::WIDTH;

/// Places of the neighbours of each particle: a run for fluid, and one for images at the wall. Lengths of runs are
/// multiples of [`WIDTH`], filled up by the place 0.
#[derive(Default)]
pub struct Runs {
    places: Vec<u16>,
    /// For each particle the ends of its two runs.
    ends: Vec<[u32; 2]>,
}

impl Runs {
    /// Removes the lists of all particles, and makes room for places.
    pub fn start(&mut self, room: usize) {
        self.places.clear();
        self.places.reserve(room);
        self.ends.clear();
    }

    /// Adds the next particle; `fill` appends the places of its run 0 and 1.
    pub fn push(&mut self, mut fill: impl FnMut(usize, &mut Vec<u16>)) {
        let ends = [0, 1].map(|run| {
            fill(run, &mut self.places);
            let full = self.places.len().next_multiple_of(WIDTH);
            self.places.resize(full, 0);
            full as u32
        });
        self.ends.push(ends);
    }

    /// Gives so many particles no neighbours.
    pub fn discard(&mut self, particles: usize) {
        self.start(0);
        self.ends.resize(particles, [0; 2]);
    }

    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// Highest place of all runs.
    pub fn highest(&self) -> u16 {
        self.places.iter().fold(0, |highest, &place| highest.max(place))
    }

    /// Runs of the k-th particle.
    #[inline(always)]
    pub fn of(&self, k: usize) -> [&[[u16; WIDTH]]; 2] {
        let start = if k == 0 { 0 } else { self.ends[k - 1][1] as usize };
        let [middle, end] = self.ends[k].map(|end| end as usize);
        [start..middle, middle..end].map(|range| self.places[range].as_chunks().0)
    }
}
