//! Nodes in levels along z, with their volumes and conductances.

use super::setup::Setup;
use crate::method::mesh::Axis;

/// Columns of nodes along z, level by level; the x index runs fastest. A contact doubles a level.
pub struct Grid {
    /// Along x and y.
    pub sides: [Side; 2],
    pub levels: Vec<Level>,
    /// Joints between a level and the next.
    pub joints: Vec<Joint>,
}

/// One lateral axis.
pub struct Side {
    /// `∫ N dx`, or `∫ N 2πr dr` [m or m²].
    pub mass: Vec<f64>,
    /// `∫ N′N′ dx` of neighbours [1/m or 1].
    pub links: Vec<f64>,
    /// Measure of a face at its low and high end.
    pub ends: [f64; 2],
}

/// Nodes at one height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Level {
    /// Halves of the elements next to it, below and above [m].
    pub heights: [f64; 2],
    /// Their materials.
    pub materials: [usize; 2],
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Joint {
    /// `1/Δz` [1/m] within an element.
    Element(f64),
    /// Contact conductance [W/(m² K)].
    Contact(f64),
}

impl Grid {
    pub fn new(setup: &Setup) -> Self {
        let nodes = &setup.mesh.axes[2].nodes;
        let layers = setup.linear_layers();
        let order = setup.mesh.axes[2].order;
        let (mut levels, mut joints) = (Vec::new(), Vec::new());
        let half = |e: usize| 0.5 * (nodes[e + 1] - nodes[e]);
        for k in 0..nodes.len() {
            let below = k.checked_sub(1).map(|e| (half(e), layers[e]));
            let above = layers.get(k).map(|&material| (half(k), material));
            let level = |below: Option<(f64, usize)>, above: Option<(f64, usize)>| {
                // A missing side has no height, and the material of the other side. A point has measure one.
                let some = below.or(above).unwrap_or((1.0, 0));
                let sides = match (below, above) {
                    (None, None) => [some, (0.0, 0)],
                    _ => [below.unwrap_or((0.0, some.1)), above.unwrap_or((0.0, some.1))],
                };
                Level { heights: sides.map(|s| s.0), materials: sides.map(|s| s.1) }
            };
            match setup.contacts.iter().find(|contact| contact.below * order == k) {
                Some(contact) if k > 0 => {
                    levels.extend([level(below, None), level(None, above)]);
                    joints.push(Joint::Contact(contact.conductance));
                }
                _ => levels.push(level(below, above)),
            }
            if k + 1 < nodes.len() {
                joints.push(Joint::Element(0.5 / half(k)));
            }
        }
        let sides = [0, 1].map(|a| Side::new(&setup.mesh.axes[a]));
        Self { sides, levels, joints }
    }

    /// Number of nodes of a level.
    pub fn plane(&self) -> usize {
        self.sides[0].mass.len() * self.sides[1].mass.len()
    }

    pub fn nodes(&self) -> usize {
        self.plane() * self.levels.len()
    }

    /// Area next to each node of a level [m²].
    pub fn areas(&self) -> Vec<f64> {
        let [x, y] = &self.sides;
        y.mass.iter().flat_map(|my| x.mass.iter().map(move |mx| mx * my)).collect()
    }

    /// Diagonal of lateral conduction for each node of a level, over its height [1].
    pub fn lateral_diagonal(&self) -> Vec<f64> {
        let [x, y] = &self.sides;
        let of = |(j, my): (usize, &f64)| {
            let (around_y, my) = (y.around(j), *my);
            x.mass.iter().enumerate().map(move |(i, mx)| x.around(i) * my + mx * around_y)
        };
        y.mass.iter().enumerate().flat_map(of).collect()
    }

    /// Ends along z of what the levels represent, from the lowest on [m]; `bottom` is that of the body.
    pub fn bounds(&self, bottom: f64) -> Vec<f64> {
        let mut bounds = vec![bottom];
        bounds.extend(self.levels.iter().scan(bottom, |end, level| {
            *end += level.height();
            Some(*end)
        }));
        bounds
    }

    /// Computes the heat flow into each node [W] from `∫ k dT` with the materials of the elements below and above, and
    /// from temperatures at contacts. Flows between two nodes are equal and opposite.
    pub fn conduct(&self, integrals: [&[f64]; 2], temperatures: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        let plane = self.plane();
        let mut potential = vec![0.0; plane];
        for (k, level) in self.levels.iter().enumerate() {
            let at = k * plane..(k + 1) * plane;
            let [below, above] = integrals.map(|list| &list[at.clone()]);
            for ((p, b), a) in potential.iter_mut().zip(below).zip(above) {
                *p = level.heights[0] * b + level.heights[1] * a;
            }
            self.conduct_sideways(&potential, &mut out[at]);
        }
        let areas = self.areas();
        for (k, joint) in self.joints.iter().enumerate() {
            let (low, high) = out[k * plane..(k + 2) * plane].split_at_mut(plane);
            let (conductance, from, to) = match *joint {
                Joint::Element(inverse) => (inverse, integrals[1], integrals[0]),
                Joint::Contact(conductance) => (conductance, temperatures, temperatures),
            };
            let (from, to) = (&from[k * plane..][..plane], &to[(k + 1) * plane..][..plane]);
            for i in 0..plane {
                let heat = conductance * areas[i] * (to[i] - from[i]);
                low[i] += heat;
                high[i] -= heat;
            }
        }
    }

    fn conduct_sideways(&self, potential: &[f64], out: &mut [f64]) {
        let [x, y] = &self.sides;
        let count = x.mass.len();
        for (j, my) in y.mass.iter().enumerate() {
            let (row, sums) = (&potential[j * count..][..count], &mut out[j * count..][..count]);
            let mut from_left = 0.0;
            for (i, link) in x.links.iter().enumerate() {
                let heat = link * my * (row[i + 1] - row[i]);
                sums[i] += heat - from_left;
                from_left = heat;
            }
            sums[count - 1] -= from_left;
        }
        for (j, link) in y.links.iter().enumerate() {
            let rows = &potential[j * count..][..2 * count];
            let (low, high) = out[j * count..][..2 * count].split_at_mut(count);
            for i in 0..count {
                let heat = link * x.mass[i] * (rows[count + i] - rows[i]);
                low[i] += heat;
                high[i] -= heat;
            }
        }
    }

    /// Nodes of an end of an axis, with their areas [m²].
    pub fn face(&self, axis: usize, high: bool) -> Vec<(usize, f64)> {
        let counts = [self.sides[0].mass.len(), self.sides[1].mass.len(), self.levels.len()];
        let node = if high { counts[axis] - 1 } else { 0 };
        let range = |a: usize| if a == axis { node..node + 1 } else { 0..counts[a] };
        let factor = |a: usize, i: usize| match (a == axis, a) {
            (true, 2) => 1.0,
            (true, a) => self.sides[a].ends[usize::from(high)],
            (false, 2) => self.levels[i].height(),
            (false, a) => self.sides[a].mass[i],
        };
        let mut nodes = Vec::new();
        for k in range(2) {
            for j in range(1) {
                for i in range(0) {
                    let area = factor(0, i) * factor(1, j) * factor(2, k);
                    nodes.push((i + counts[0] * (j + counts[1] * k), area));
                }
            }
        }
        nodes
    }
}

impl Level {
    pub fn height(&self) -> f64 {
        self.heights[0] + self.heights[1]
    }

    /// Returns true if both sides are of one material.
    pub fn is_uniform(&self) -> bool {
        self.materials[0] == self.materials[1]
    }
}

impl Side {
    fn new(axis: &Axis) -> Self {
        let mut linear = axis.clone();
        linear.order = 1;
        let link = |pair: &[f64]| linear.weight_at(0.5 * (pair[0] + pair[1])) / (pair[1] - pair[0]);
        Self {
            mass: linear.integrals(),
            links: linear.nodes.windows(2).map(link).collect(),
            ends: [linear.start(), linear.end()].map(|x| linear.weight_at(x)),
        }
    }

    /// Sum of the links of a node.
    fn around(&self, i: usize) -> f64 {
        let link = |number: Option<usize>| number.and_then(|n| self.links.get(n)).unwrap_or(&0.0);
        link(i.checked_sub(1)) + link(Some(i))
    }
}
