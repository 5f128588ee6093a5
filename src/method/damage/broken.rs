//! Broken places of a body: how many cracks they are, how deep these reach, and how wide they are open.

use std::collections::BTreeSet;

use super::domain::Domain;
use crate::math::grid_matrix::Grid;

/// Damage from which on a place is broken [1]: it bears less than a hundredth of the stiffness.
const BROKEN: f64 = 0.9;
/// Points per element at which a straight crack is followed.
const POINTS_OF_AN_ELEMENT: f64 = 8.0;

/// Sides of a domain: the first and the last along each axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// A face of the body.
    Face,
    /// A face that is held, wholly or along its normal.
    Held,
    /// A plane of symmetry: what touches it continues in the other half.
    Mirror,
    /// The axis of a meridian section.
    Axis,
}

/// Measures of the broken places of a body.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Cracks {
    /// Number of connected broken regions.
    pub count: usize,
    /// Largest distance of a broken node from the face at which its crack begins [m].
    pub depth: f64,
}

/// Broken nodes.
pub fn broken(damage: &[f64]) -> Vec<bool> {
    damage.iter().map(|&damage| damage >= BROKEN).collect()
}

/// Returns the broken nodes of a grid, each list a connected region. A single node is no crack: nothing has come
/// apart along it.
fn regions<const D: usize>(grid: Grid<D>, damage: &[f64]) -> Vec<Vec<usize>> {
    let mut is_open = broken(damage);
    let mut found = Vec::new();
    for start in 0..damage.len() {
        if !std::mem::replace(&mut is_open[start], false) {
            continue;
        }
        let mut region = vec![start];
        let mut next = 0;
        while let Some(&node) = region.get(next) {
            next += 1;
            for other in grid.around(node) {
                if std::mem::replace(&mut is_open[other], false) {
                    region.push(other);
                }
            }
        }
        found.extend((region.len() > 1).then_some(region));
    }
    found
}

/// Kinds of both sides along each axis.
pub type Sides<const D: usize> = [[Side; 2]; D];

impl<const D: usize> Domain<D> {
    /// Counts cracks and measures their depth. Cracks that damage within a skin of the faces [m] has joined stay as many
    /// as reach below it.
    pub fn cracks(&self, damage: &[f64], sides: Sides<D>, skin: f64) -> Cracks {
        let grid = self.grid();
        // Those that touch a plane of symmetry are one with their image.
        let copies = |region: &Vec<usize>| -> usize {
            let is_doubled = |axis: &usize| {
                let touches = |&node: &usize| grid.position(node)[*axis] == 0;
                sides[*axis][0] == Side::Mirror && !region.iter().any(touches)
            };
            1 << (0..D).filter(is_doubled).count()
        };
        let whole = regions(grid, damage);
        let deep = regions(grid, &self.below_skin(damage, sides, skin));
        let count = |region: &Vec<usize>| {
            let nodes: BTreeSet<usize> = region.iter().copied().collect();
            let parts = deep.iter().filter(|part| nodes.contains(&part[0]));
            parts.map(copies).sum::<usize>().max(copies(region))
        };
        let depths = whole.iter().map(|region| self.depth(region, sides));
        Cracks { count: whole.iter().map(count).sum(), depth: depths.fold(0.0, f64::max) }
    }

    /// Damage of the nodes below a skin of the faces [m]; zero within it.
    fn below_skin(&self, damage: &[f64], sides: Sides<D>, skin: f64) -> Vec<f64> {
        let faces: Vec<[usize; 2]> = faces(sides).collect();
        let is_skin = |node: usize| faces.iter().any(|&face| self.distance(node, face) < skin);
        let own = damage.iter().enumerate();
        own.map(|(node, &damage)| if is_skin(node) { 0.0 } else { damage }).collect()
    }

    /// Nodes of cracks that are not among those broken from the start.
    pub fn grown(&self, damage: &[f64], from_start: &[bool]) -> Vec<usize> {
        let nodes = regions(self.grid(), damage).into_iter().flatten();
        nodes.filter(|&node| !from_start[node]).collect()
    }

    /// Nodes that are farther than a distance [m] along one of the axes from all broken ones.
    pub fn away_from_broken(&self, damage: &[f64], distance: f64) -> Vec<usize> {
        let grid = self.grid();
        // Numbers of broken nodes in the boxes from the first node up to each, with a layer of zeros before the first.
        let sums = Grid { counts: grid.counts.map(|count| count + 1) };
        let number = |position: [usize; D]| -> usize {
            (0..D).map(|axis| position[axis] * sums.stride(axis)).sum()
        };
        let mut broken = vec![0_u32; sums.nodes()];
        for (node, &damage) in damage.iter().enumerate() {
            broken[number(grid.position(node).map(|along| along + 1))] =
                u32::from(damage >= BROKEN);
        }
        for axis in 0..D {
            let stride = sums.stride(axis);
            for place in 0..broken.len() {
                if place / stride % sums.counts[axis] > 0 {
                    broken[place] += broken[place - stride];
                }
            }
        }
        let around = |axis: usize, at: f64| {
            let nodes = &self.axes[axis];
            let first = nodes.partition_point(|&place| place < at - distance);
            [first, nodes.partition_point(|&place| place <= at + distance)]
        };
        let is_away = |&node: &usize| {
            let place = self.place(node);
            let range: [[usize; 2]; D] = std::array::from_fn(|axis| around(axis, place[axis]));
            // Corners of the box count by turns.
            let [added, taken] = [0, 1].map(|odd| {
                let corners = (0..1_usize << D).filter(|corner| corner.count_ones() % 2 == odd);
                let count = |corner: usize| {
                    broken
                        [number(std::array::from_fn(|axis| range[axis][1 - (corner >> axis & 1)]))]
                };
                corners.map(count).sum::<u32>()
            });
            added == taken
        };
        (0..damage.len()).filter(is_away).collect()
    }

    /// Returns true if a crack at later damage is not part of one at earlier damage.
    pub fn has_new_crack(&self, before: &[f64], after: &[f64]) -> bool {
        let known: BTreeSet<usize> = regions(self.grid(), before).into_iter().flatten().collect();
        let is_new = |region: &Vec<usize>| region.iter().all(|node| !known.contains(node));
        regions(self.grid(), after).iter().any(is_new)
    }

    /// Depth of a region [m]: how far it reaches from the face that it touches, from the nearest one if it touches
    /// several or none; zero if all faces are held.
    fn depth(&self, region: &[usize], sides: Sides<D>) -> f64 {
        let grid = self.grid();
        let reaches = faces(sides).map(|face @ [axis, _]| {
            let distances = region.iter().map(|&node| self.distance(node, face));
            let [near, far] =
                distances.fold([f64::INFINITY, 0.0], |[near, far], d| [near.min(d), far.max(d)]);
            // The image of what touches a plane of symmetry reaches as near to the opposite face.
            let touches = |&node: &usize| grid.position(node)[axis] == 0;
            let is_doubled = sides[axis][0] == Side::Mirror && region.iter().any(touches);
            let nodes = &self.axes[axis];
            let extent = nodes[nodes.len() - 1] - nodes[0];
            [near, if is_doubled { 2.0 * extent - near } else { far }]
        });
        let reaches: Vec<[f64; 2]> = reaches.collect();
        if reaches.is_empty() {
            return 0.0;
        }
        let nearest = reaches.iter().map(|[near, _]| *near).fold(f64::INFINITY, f64::min);
        let touched = reaches.iter().filter(|[near, _]| *near == nearest);
        touched.map(|[_, far]| *far).fold(f64::INFINITY, f64::min)
    }

    /// Distance of a node from the first or last side along an axis [m].
    fn distance(&self, node: usize, [axis, side]: [usize; 2]) -> f64 {
        let nodes = &self.axes[axis];
        (nodes[self.grid().position(node)[axis]] - nodes[side * (nodes.len() - 1)]).abs()
    }

    /// Largest `|u₁ − u₂|/h` of the displacements u [m] at both ends of an edge of length h [m] with a broken end: how
    /// wide a crack is open over the size of its elements [1].
    pub fn opening(&self, displacement: &[f64], damage: &[f64]) -> f64 {
        let grid = self.grid();
        let displacement_of = |node: usize| &displacement[D * node..][..D];
        let mut most = 0.0_f64;
        for one in 0..grid.nodes() {
            let position = grid.position(one);
            for axis in (0..D).filter(|&axis| position[axis] + 1 < grid.counts[axis]) {
                let other = one + grid.stride(axis);
                if damage[one].max(damage[other]) >= BROKEN {
                    let nodes = &self.axes[axis][position[axis]..];
                    let both = displacement_of(one).iter().zip(displacement_of(other));
                    let apart: f64 = both.map(|(one, other)| (one - other) * (one - other)).sum();
                    most = most.max(apart.sqrt() / (nodes[1] - nodes[0]));
                }
            }
        }
        most
    }
}

/// Axis and side of the faces of a body.
fn faces<const D: usize>(sides: Sides<D>) -> impl Iterator<Item = [usize; 2]> {
    let all = (0..2 * D).map(|face| [face / 2, face % 2]);
    all.filter(move |[axis, side]| sides[*axis][*side] == Side::Face)
}

/// A plane or meridian section.
pub type Section = Domain<2>;

impl Section {
    /// Nodes of the elements through which a straight crack passes, from one point to another [m].
    pub fn nodes_along(&self, [from, to]: [[f64; 2]; 2]) -> BTreeSet<usize> {
        let grid = self.grid();
        let elements = grid.elements();
        let finest = [0, 1].map(|axis| {
            let sizes = self.axes[axis].windows(2).map(|pair| pair[1] - pair[0]);
            sizes.fold(f64::INFINITY, f64::min)
        });
        let longest = [0, 1].map(|axis| (to[axis] - from[axis]).abs() / finest[axis]);
        let parts = (POINTS_OF_AN_ELEMENT * longest[0].max(longest[1])).ceil().max(1.0);
        let of_part = |part: usize| {
            let share = part as f64 / parts;
            let place = [0, 1].map(|axis| {
                let along = from[axis] + share * (to[axis] - from[axis]);
                let below = self.axes[axis].partition_point(|&node| node <= along);
                below.saturating_sub(1).min(elements[axis] - 1)
            });
            grid.corners::<4>(place)
        };
        (0..=parts as usize).flat_map(of_part).collect()
    }

    /// Number of ends within the section of the cracks that have a node among those broken from the start: two of each,
    /// less the sides that it touches. A crack along a plane of symmetry at the first side does not end there.
    pub fn ends(&self, damage: &[f64], from_start: &[bool]) -> usize {
        let [columns, rows] = self.grid().counts;
        let of_region = |region: &Vec<usize>| {
            let is_along_plane = self.mirrored[0] && region.iter().all(|node| node % columns <= 1);
            let is_at = |side: usize| {
                region.iter().any(|node| match side {
                    0 => node % columns == 0 && !is_along_plane,
                    1 => node % columns == columns - 1,
                    2 => node / columns == 0,
                    _ => node / columns == rows - 1,
                })
            };
            2_usize.saturating_sub((0..4).filter(|&side| is_at(side)).count())
        };
        let regions = regions(self.grid(), damage);
        let own = regions.iter().filter(|region| region.iter().any(|&node| from_start[node]));
        own.map(of_region).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::damage::Form;

    /// Nodes a millimetre apart, those of a list broken.
    fn with_broken(nodes: &[[usize; 2]]) -> (Section, Vec<f64>) {
        let axis = |count: usize| (0..count).map(|i| i as f64 * 1e-3).collect();
        let section = Section {
            axes: [axis(9), axis(5)],
            form: Form::PlaneStrain { thickness: 1.0 },
            mirrored: [false; 2],
        };
        let mut damage = vec![0.5; 45];
        nodes.iter().for_each(|[i, j]| damage[i + 9 * j] = 1.0);
        (section, damage)
    }

    const FACES: [[Side; 2]; 2] = [[Side::Face; 2]; 2];

    #[test]
    fn separate_cracks_are_counted_with_their_depth() {
        let (section, damage) = with_broken(&[[2, 4], [3, 3], [3, 2], [6, 4], [6, 3], [8, 0]]);
        let found = section.cracks(&damage, FACES, 0.0);
        assert_eq!(found.count, 2);
        assert!((found.depth - 2e-3).abs() < 1e-15);
        assert_eq!(section.cracks(&[0.5; 45], FACES, 0.0), Cracks::default());
    }

    #[test]
    fn cracks_stay_several_where_their_mouths_have_joined() {
        let mouths: Vec<[usize; 2]> = (2..=6).map(|i| [i, 4]).collect();
        let cracks = [[2, 3], [2, 2], [6, 3], [6, 2]];
        let (section, damage) = with_broken(&[&mouths[..], &cracks].concat());
        let count = |skin: f64| section.cracks(&damage, FACES, skin).count;
        assert_eq!([count(0.0), count(0.5e-3)], [1, 2]);
        // A crack within the skin is one, too.
        let (section, damage) = with_broken(&mouths);
        assert_eq!(section.cracks(&damage, FACES, 0.5e-3).count, 1);
    }

    #[test]
    fn nodes_away_from_cracks_are_outside_of_squares_around_them() {
        let (section, damage) = with_broken(&[[2, 4], [2, 3]]);
        let away = section.away_from_broken(&damage, 2.1e-3);
        for node in 0..45 {
            let is_near = node % 9 <= 4 && node / 9 >= 1;
            assert_eq!(away.contains(&node), !is_near, "{node}");
        }
        assert_eq!(section.away_from_broken(&[0.5; 45], 1.0).len(), 45);
    }

    #[test]
    fn growth_is_no_new_crack() {
        let (section, before) = with_broken(&[[2, 4], [2, 3], [6, 4]]);
        let (_, grown) = with_broken(&[[2, 4], [2, 3], [2, 2], [6, 4]]);
        let (_, second) = with_broken(&[[2, 4], [2, 3], [6, 4], [6, 3]]);
        let (_, joined) = with_broken(&[[2, 4], [2, 3], [3, 4], [4, 4], [5, 4], [6, 4]]);
        assert_eq!(
            [&before, &grown, &second, &joined].map(|after| section.has_new_crack(&before, after)),
            [false, false, true, false]
        );
        assert!(section.has_new_crack(&[0.5; 45], &before));
    }

    #[test]
    fn images_count_and_no_depth_is_measured_from_a_plane_of_symmetry() {
        let (section, damage) = with_broken(&[[0, 2], [1, 2], [6, 4], [6, 3]]);
        let sides = [[Side::Mirror, Side::Face], [Side::Face; 2]];
        let found = section.cracks(&damage, sides, 0.0);
        assert_eq!(found.count, 3);
        assert!((found.depth - 2e-3).abs() < 1e-15);
        let sides = [[Side::Axis, Side::Face], [Side::Face; 2]];
        assert_eq!(section.cracks(&damage, sides, 0.0).count, 2);
    }

    #[test]
    fn through_crack_has_the_depth_of_the_body() {
        let (section, damage) = with_broken(&[0, 1, 2, 3, 4].map(|j| [1, j]));
        assert!((section.cracks(&damage, FACES, 0.0).depth - 4e-3).abs() < 1e-15);
    }

    #[test]
    fn straight_crack_breaks_a_row_of_elements() {
        let (section, _) = with_broken(&[]);
        let nodes = |from, to| -> Vec<usize> {
            section
                .nodes_along([from, to])
                .into_iter()
                .map(|node| node % 9 + 100 * (node / 9))
                .collect()
        };
        assert_eq!(nodes([2.5e-3, 0.0], [2.5e-3, 1.5e-3]), [2, 3, 102, 103, 202, 203]);
        // On a line of nodes it breaks one row, too.
        assert_eq!(nodes([2e-3, 0.5e-3], [3.5e-3, 0.5e-3]), [2, 3, 4, 102, 103, 104]);
        assert_eq!(nodes([8e-3, 4e-3], [8e-3, 4e-3]), [307, 308, 407, 408]);
    }

    #[test]
    fn crack_has_grown_where_it_was_not_at_the_start() {
        let (section, start) = with_broken(&[[2, 4], [2, 3]]);
        let from_start = broken(&start);
        let (_, longer) = with_broken(&[[2, 4], [2, 3], [2, 2]]);
        let (_, point) = with_broken(&[[2, 4], [2, 3], [6, 1]]);
        let grown = [&start, &longer, &point].map(|damage| section.grown(damage, &from_start));
        assert_eq!(grown, [vec![], vec![2 + 9 * 2], vec![]]);
        let place = section.place(2 + 9 * 2);
        assert!((place[0] - 2e-3).abs() < 1e-15 && (place[1] - 2e-3).abs() < 1e-15);
    }

    #[test]
    fn ends_are_those_within_the_section() {
        let (section, start) = with_broken(&[[2, 4], [2, 3], [5, 2], [6, 2]]);
        let from_start = broken(&start);
        let (_, through) =
            with_broken(&[[2, 4], [2, 3], [2, 2], [2, 1], [2, 0], [5, 2], [6, 2], [7, 1], [8, 0]]);
        let (_, other) = with_broken(&[[2, 4], [2, 3], [5, 2], [6, 2], [8, 1], [8, 2]]);
        let ends = [&start, &through, &other].map(|damage| section.ends(damage, &from_start));
        assert_eq!(ends, [3, 0, 3]);
    }

    #[test]
    fn cracks_along_a_plane_of_symmetry_end_below_it() {
        let along = [[0, 4], [1, 4], [0, 3], [1, 3]];
        let (section, start) = with_broken(&[&along[..], &[[0, 1], [1, 1], [2, 1]]].concat());
        let from_start = broken(&start);
        let through: Vec<[usize; 2]> = (0..5).flat_map(|j| [[0, j], [1, j]]).collect();
        let (_, through) = with_broken(&through);
        let section = Section { mirrored: [true, false], ..section };
        let ends = |damage: &[f64]| section.ends(damage, &from_start);
        assert_eq!([&start, &through].map(|damage| ends(damage)), [2, 0]);
    }

    #[test]
    fn opening_is_that_of_broken_elements() {
        let (section, damage) = with_broken(&[[4, 2]]);
        let mut displacement = vec![0.0; 90];
        displacement[2 * (4 + 18)] = 2e-3;
        assert!((section.opening(&displacement, &damage) - 2.0).abs() < 1e-12);
        assert_eq!(section.opening(&displacement, &[0.0; 45]), 0.0);
    }
}
