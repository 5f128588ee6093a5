//! Connected sets of rigid particles.

use super::super::images::{Image, Images};
use super::super::order::Bounds;

/// Bonds of a set to images of its own particles.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SelfBonds {
    /// For each axis, whether the set adheres to its mirror image across it.
    pub mirrored: [bool; 3],
    /// For each axis, whether the set adheres to itself one period away.
    pub chained: [bool; 3],
}

/// A connected set of particles.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Set {
    /// Its particles in ascending order.
    pub members: Vec<u32>,
    /// Displacement of each by whole periods, after which the set is in one place.
    pub frames: Vec<[f64; 3]>,
    pub bonds: SelfBonds,
}

/// Returns the connected sets of particles and images at most `reach` apart, in the order of their first particles.
/// Images across z are excluded: fluid sticks to those planes.
pub fn connected(places: &[[f64; 3]], images: &Images, reach: f64) -> Vec<Set> {
    let sites = sites(places, images, reach);
    let mut forest = Forest::of(places.len());
    let cells: Vec<&[Site]> = sites.chunk_by(|a, b| a.cell == b.cell).collect();
    let mut bond_all = |here: &[Site], there: &[Site]| {
        for a in here {
            for b in there.iter().filter(|b| touch(&a.place, &b.place, reach)) {
                match (a.code, b.code) {
                    (0, code) => forest.bond(a.particle, b.particle, images.get(code)),
                    (code, 0) => forest.bond(b.particle, a.particle, images.get(code)),
                    _ => {}
                }
            }
        }
    };
    for (n, here) in cells.iter().enumerate() {
        bond_all(here, here);
        let [x, y, z] = here[0].cell;
        // Cells after this one in order, row by row along the last axis.
        for (dx, dy) in [(0, 0), (0, 1), (1, -1), (1, 0), (1, 1)] {
            let low = [x + dx, y + dy, if (dx, dy) == (0, 0) { z + 1 } else { z - 1 }];
            let high = [x + dx, y + dy, z + 1];
            let first = n + cells[n..].partition_point(|cell| cell[0].cell < low);
            let near = cells[first..].iter().take_while(|cell| cell[0].cell <= high);
            near.for_each(|there| bond_all(here, there));
        }
    }
    forest.sets()
}

/// A particle or an image of it.
#[derive(Debug, Clone, Copy)]
struct Site {
    /// Numbers of the cube that contains it.
    cell: [i64; 3],
    particle: u32,
    code: u8,
    place: [f64; 3],
}

/// All particles, and those images within reach of any, in the order of their cells.
fn sites(places: &[[f64; 3]], images: &Images, reach: f64) -> Vec<Site> {
    let near = Bounds::of(places.iter().copied()).widened([reach; 3]);
    let contains = |x: &[f64; 3]| (0..3).all(|a| (near.low[a]..=near.high[a]).contains(&x[a]));
    let beside = |&&code: &&u8| images.get(code).signs[2] > 0.0;
    let mut sites: Vec<Site> = Vec::with_capacity(places.len());
    for &code in images.codes().iter().filter(beside) {
        let image = images.get(code);
        let places = places.iter().map(|&x| image.place(x)).zip(0..);
        sites.extend(places.filter(|(place, _)| contains(place)).map(|(place, particle)| Site {
            cell: place.map(|x| (x / reach).floor() as i64),
            particle,
            code,
            place,
        }));
    }
    sites.sort_unstable_by_key(|site| (site.cell, site.code, site.particle));
    sites
}

fn touch(a: &[f64; 3], b: &[f64; 3], reach: f64) -> bool {
    (0..3).map(|n| (a[n] - b[n]).powi(2)).sum::<f64>() <= reach * reach
}

/// Trees of bonded particles; the smallest number of each is its root.
struct Forest {
    parents: Vec<u32>,
    /// Displacement of each particle relative to its parent.
    frames: Vec<[f64; 3]>,
    /// Bonds of each root.
    bonds: Vec<SelfBonds>,
}

impl Forest {
    fn of(count: usize) -> Self {
        Self {
            parents: (0..count as u32).collect(),
            frames: vec![[0.0; 3]; count],
            bonds: vec![SelfBonds::default(); count],
        }
    }

    /// Root of a particle, and the particle's displacement relative to it; shortens the path.
    fn root(&mut self, of: u32) -> (u32, [f64; 3]) {
        let (mut root, mut frame) = (of, [0.0; 3]);
        while self.parents[root as usize] != root {
            let at = root as usize;
            let parent = self.parents[at] as usize;
            if self.parents[parent] != parent as u32 {
                self.frames[at] = sum(self.frames[at], self.frames[parent]);
                self.parents[at] = self.parents[parent];
            }
            frame = sum(frame, self.frames[at]);
            root = self.parents[at];
        }
        (root, frame)
    }

    /// Bonds a particle to the image of another, or of itself.
    fn bond(&mut self, one: u32, other: u32, image: &Image) {
        let ((a, of_a), (b, of_b)) = (self.root(one), self.root(other));
        let is_mirrored = image.signs.map(|sign| sign < 0.0);
        let apart = [0, 1, 2].map(|n| {
            let offset = if is_mirrored[n] { 0.0 } else { image.offset[n] };
            of_a[n] + offset - of_b[n]
        });
        let root = a.min(b) as usize;
        if a < b {
            (self.parents[b as usize], self.frames[b as usize]) = (a, apart);
        } else if b < a {
            (self.parents[a as usize], self.frames[a as usize]) = (b, apart.map(|x| -x));
        }
        let [of_a, of_b] = [a, b].map(|root| self.bonds[root as usize]);
        for n in 0..3 {
            let bonds = &mut self.bonds[root];
            bonds.mirrored[n] = of_a.mirrored[n] || of_b.mirrored[n] || is_mirrored[n];
            // Periods are longer than 2.
            let around = a == b && apart[n].abs() > 1.0;
            bonds.chained[n] = of_a.chained[n] || of_b.chained[n] || around;
        }
    }

    fn sets(mut self) -> Vec<Set> {
        let mut sets: Vec<Set> = Vec::new();
        let mut numbers = vec![0; self.parents.len()];
        for i in 0..self.parents.len() as u32 {
            let (root, frame) = self.root(i);
            if root == i {
                numbers[i as usize] = sets.len();
                sets.push(Set { bonds: self.bonds[i as usize], ..Set::default() });
            }
            let set = &mut sets[numbers[root as usize]];
            set.members.push(i);
            set.frames.push(frame);
        }
        sets
    }
}

fn sum(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[cfg(test)]
mod tests {
    use super::super::super::images::Ends;
    use super::*;

    const OPEN: Ends = Ends::Planes { near: false, far: None };
    const MIRROR: Ends = Ends::Planes { near: true, far: None };

    fn row(first: f64, count: usize) -> impl Iterator<Item = [f64; 3]> {
        (0..count).map(move |n| [first + n as f64, 0.25, 7.0])
    }

    #[test]
    fn gaps_separate_sets() {
        let images = Images::new([OPEN; 3], false, [0.0; 3]);
        let places: Vec<_> = row(-3.0, 4).chain(row(1.6, 3)).chain(row(5.2, 1)).collect();
        let sets = connected(&places, &images, 1.5);
        let sizes: Vec<usize> = sets.iter().map(|set| set.members.len()).collect();
        assert_eq!(sizes, [4, 3, 1]);
        assert!(sets.iter().all(|set| set.bonds == SelfBonds::default()));
    }

    #[test]
    fn sets_continue_across_periods() {
        let images = Images::new([Ends::Period(10.0), OPEN, OPEN], false, [0.0; 3]);
        let places: Vec<_> = row(0.5, 3).chain(row(7.5, 3)).collect();
        let sets = connected(&places, &images, 1.5);
        assert_eq!((sets.len(), sets[0].bonds), (1, SelfBonds::default()));
        assert!(sets[0].frames[..3].iter().all(|frame| *frame == [0.0; 3]));
        assert!(sets[0].frames[3..].iter().all(|frame| *frame == [-10.0, 0.0, 0.0]));
        let sets = connected(&row(0.5, 10).collect::<Vec<_>>(), &images, 1.5);
        assert_eq!((sets.len(), sets[0].bonds.chained), (1, [true, false, false]));
    }

    #[test]
    fn sets_adhere_to_their_mirror_images() {
        let images = Images::new([MIRROR, MIRROR, MIRROR], true, [0.0; 3]);
        let bonds =
            |first: f64| connected(&row(first, 3).collect::<Vec<_>>(), &images, 1.5)[0].bonds;
        assert_eq!(bonds(0.7).mirrored, [true, true, false]);
        assert_eq!(bonds(0.8).mirrored, [false, true, false]);
    }
}
