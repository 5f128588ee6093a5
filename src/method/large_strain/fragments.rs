//! Parts into which broken nodes divide a body of concrete.

use super::Deformable;
use crate::math::parts::Parts;
use crate::space::Form;

/// Damage of a body, and the parts of its unbroken nodes that edges of the mesh connect, with mirror images.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Fragments {
    /// Largest damage of a point, and the mean over the volume.
    pub max_damage: f64,
    pub mean_damage: f64,
    pub count: usize,
    /// Mass of the part with the largest [kg], and the speed of its centre [m/s].
    pub largest_mass: f64,
    pub largest_speed: f64,
    /// Mass of the nodes that are broken [kg].
    pub broken_mass: f64,
}

/// A connected set of nodes of the model.
#[derive(Clone, Copy, Default)]
struct Part {
    mass: f64,
    momentum: [f64; 3],
    /// Planes of symmetry x = 0 and y = 0 that it touches, across which it goes on.
    touches: [bool; 2],
}

impl Deformable {
    /// Damage of each point for a history of all; 0 where the law has none.
    pub fn damages(&self, history: &[f64]) -> Vec<f64> {
        let of_group = |group: usize| {
            let (law, points) = (self.law_of(group), self.space.groups[group].len());
            let own = &history[self.history_of(group)];
            let length = law.history();
            let damage = move |n: usize| {
                law.concrete().map_or(0.0, |own_law| own_law.damage(&own[length * n..]))
            };
            (0..points).map(damage)
        };
        (0..self.space.groups.len()).flat_map(of_group).collect()
    }

    /// Largest change of the damage function η of a point between two histories of all; 0 without concrete.
    pub fn largest_passed(&self, from: &[f64], to: &[f64]) -> f64 {
        let of_group = |group: usize| {
            let (law, own) = (self.law_of(group), self.history_of(group));
            let concrete = law.concrete()?;
            let length = law.history();
            let after = to[own.clone()].chunks_exact(length);
            let pairs = from[own].chunks_exact(length).zip(after);
            pairs.map(|(from, to)| concrete.passed(from, to)).reduce(f64::max)
        };
        (0..self.space.groups.len()).filter_map(of_group).fold(0.0, f64::max)
    }

    /// Returns true if part of the body is concrete.
    pub fn has_concrete(&self) -> bool {
        self.layers.iter().any(|layer| layer.law.concrete().is_some())
    }

    /// Damage at the nodes: means over the points around them, by the squares of functions.
    pub fn damages_at_nodes(&self, damages: &[f64]) -> Vec<f64> {
        let mut sums = vec![[0.0; 2]; self.nodes()];
        for (point, damage) in damages.iter().enumerate() {
            for value in self.space.volume.row(point) {
                let share = value.value * value.value * self.space.volume.weights[point];
                let sum = &mut sums[value.node as usize];
                sum[0] += share * damage;
                sum[1] += share;
            }
        }
        sums.into_iter().map(|[damage, whole]| damage / whole).collect()
    }

    /// Fragments of a model with planes of symmetry; nodes are broken from the damage of their law on.
    pub fn fragments(
        &self,
        history: &[f64],
        velocity: Option<&[[f64; 3]]>,
        mirrors: [bool; 2],
    ) -> Option<Fragments> {
        let threshold = self.layers.iter().find_map(|layer| layer.law.concrete())?.broken;
        let damages = self.damages(history);
        let at_nodes = self.damages_at_nodes(&damages);
        let weights = &self.space.volume.weights;
        let sum: f64 = damages.iter().zip(weights).map(|(damage, weight)| damage * weight).sum();
        let mut fragments = Fragments {
            max_damage: damages.iter().copied().fold(0.0, f64::max),
            mean_damage: sum / weights.iter().sum::<f64>(),
            ..Fragments::default()
        };
        let copies = mirrors.map(|mirrored| if mirrored { 2.0 } else { 1.0 });
        let broken: Vec<bool> = at_nodes.iter().map(|damage| *damage >= threshold).collect();
        let mut parts = Parts::new(self.nodes());
        for link in &self.space.links {
            let ends = link.map(|node| node as usize);
            if ends.iter().all(|&node| !broken[node]) {
                parts.join(ends);
            }
        }
        let mut own = vec![Part::default(); self.nodes()];
        for node in 0..self.nodes() {
            let mass = self.mass[node];
            if broken[node] {
                fragments.broken_mass += copies[0] * copies[1] * mass;
                continue;
            }
            let part = &mut own[parts.first(node)];
            part.mass += mass;
            for axis in 0..3 {
                part.momentum[axis] += velocity.map_or(0.0, |all| mass * all[node][axis]);
            }
            for (axis, mirrored) in mirrors.into_iter().enumerate() {
                part.touches[axis] |= mirrored && self.space.nodes[node][axis] == 0.0;
            }
        }
        let is_round = self.space.form == Form::Axisymmetric;
        for part in own.iter().filter(|part| part.mass > 0.0) {
            let (mut images, mut mass, mut momentum) = (1.0, part.mass, part.momentum);
            for axis in 0..2 {
                if part.touches[axis] {
                    mass *= copies[axis];
                } else {
                    images *= copies[axis];
                }
                if part.touches[axis] || is_round {
                    momentum[axis] = 0.0;
                }
            }
            fragments.count += images as usize;
            if mass > fragments.largest_mass {
                fragments.largest_mass = mass;
                let square: f64 = momentum.iter().map(|own| own * own).sum();
                // The masses of model and momentum are those of one image.
                fragments.largest_speed = square.sqrt() / part.mass;
            }
        }
        Some(fragments)
    }
}
