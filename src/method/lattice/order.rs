//! Fill-reducing order of particles by nested dissection of their places.

use super::arrangement::Particles;

/// Number of particles below which a part is not divided further.
const LEAF: usize = 16;

/// Orders particles for elimination: both halves of the longer axis, then the particles that separate them;
/// recursively.
///
/// A. George 1973, doi 10.1137/0710032, with the median of the places instead of a plane of a grid.
pub fn dissect(particles: &Particles) -> Vec<usize> {
    let mut around = vec![Vec::new(); particles.places.len()];
    for pair in &particles.pairs {
        let [a, b] = pair.ends;
        around[a].push(b);
        around[b].push(a);
    }
    let mut dissection = Dissection {
        places: &particles.places,
        around: &around,
        side: vec![Side::Outside; particles.places.len()],
        order: Vec::with_capacity(particles.places.len()),
    };
    dissection.part((0..particles.places.len()).collect());
    dissection.order
}

struct Dissection<'a> {
    places: &'a [[f64; 2]],
    around: &'a [Vec<usize>],
    side: Vec<Side>,
    order: Vec<usize>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Outside,
    Low,
    High,
}

impl Dissection<'_> {
    fn part(&mut self, mut part: Vec<usize>) {
        if part.len() <= LEAF {
            self.order.append(&mut part);
            return;
        }
        let extent = [0, 1].map(|axis| {
            let along = part.iter().map(|&i| self.places[i][axis]);
            along.clone().fold(f64::MIN, f64::max) - along.fold(f64::MAX, f64::min)
        });
        let axis = usize::from(extent[1] > extent[0]);
        let key = |i: &usize| (self.places[*i][axis], self.places[*i][1 - axis]);
        part.sort_by(|a, b| key(a).partial_cmp(&key(b)).expect("places are finite"));
        let high = part.split_off(part.len() / 2);
        part.iter().for_each(|&i| self.side[i] = Side::Low);
        high.iter().for_each(|&i| self.side[i] = Side::High);
        let (separator, low): (Vec<_>, Vec<_>) = part
            .into_iter()
            .partition(|&i| self.around[i].iter().any(|&j| self.side[j] == Side::High));
        for &i in low.iter().chain(&separator).chain(&high) {
            self.side[i] = Side::Outside;
        }
        self.part(low);
        self.part(high);
        self.order.extend(separator);
    }
}
