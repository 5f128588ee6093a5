//! The linear systems of Newton's method and their preconditioner.
//!
//! The unknown is the temperature change scaled by conductivity, `x = κ δT`, with κ the conductivity over that at the
//! reference. Within one material the system is then symmetric, `(V ∂H/∂x + τ K) x = −r`, with a constant K. With
//! several materials or contacts along z it is not. Where enthalpy changes at one temperature, x is zero.
//!
//! The preconditioner uses means over each level except for the diagonal, `S Ā S` with `S² = diag A / diag Ā`.
//! Eigenvectors along x and y leave one tridiagonal system along z for each mode, in general not symmetric. It is exact
//! if constants differ along z alone, whatever the layers, gradings and fronts are. S makes it effective for short
//! steps too, and for melting nodes.

use super::grid::{Grid, Joint};
use super::lateral::Lateral;
use crate::math::conjugate_gradients::Operator;

/// Nodal coefficients of a system.
pub struct Coefficients<'a> {
    /// Volume over the change of x with the volumetric enthalpy: infinite at held nodes.
    pub storage: Vec<f64>,
    /// Derivative of the heat loss to the surroundings [W/K], over κ.
    pub loss: Vec<f64>,
    /// Conductivities below and above, over κ.
    pub ratios: [Vec<f64>; 2],
    /// `1/κ`
    pub inverse: Vec<f64>,
    /// `∂q/∂T` of the bottom and top, means [W/(m² K)].
    pub ends: [f64; 2],
    /// That of each level through lateral faces to a bath, per area of the level [W/(m² K)]; empty without a bath.
    pub aside: Vec<f64>,
    pub held: &'a [bool],
}

pub struct System<'a> {
    grid: &'a Grid,
    lateral: &'a Lateral,
    /// Length of an implicit step [s].
    tau: f64,
    /// True if conductivities below and above differ anywhere, or there are contacts.
    has_layers: bool,
    storage: Vec<f64>,
    loss: Vec<f64>,
    ratios: [Vec<f64>; 2],
    inverse: Vec<f64>,
    /// Diagonal of K.
    own: Vec<f64>,
    /// `1/S`
    scale: Vec<f64>,
    bands: Bands,
    /// Inverse pivots of each level and mode.
    pivots: Vec<f64>,
}

/// Means of the levels, per area: coupling of a level to itself, to the one below and to the one above; and to itself
/// times the eigenvalue of a mode.
struct Bands {
    diagonal: Vec<f64>,
    below: Vec<f64>,
    above: Vec<f64>,
    spread: Vec<f64>,
}

impl<'a> System<'a> {
    pub fn new(grid: &'a Grid, lateral: &'a Lateral, tau: f64, coefficients: Coefficients) -> Self {
        let bands = Bands::new(grid, tau, &coefficients);
        let Coefficients { storage, loss, ratios, inverse, .. } = coefficients;
        let pivots = bands.factor(&lateral.decay());
        let contacts = grid.joints.iter().any(|joint| matches!(joint, Joint::Contact(_)));
        let has_layers = contacts || grid.levels.iter().any(|level| !level.is_uniform());
        let (own, scale) = (Vec::new(), Vec::new());
        let mut system = Self {
            grid,
            lateral,
            tau,
            has_layers,
            storage,
            loss,
            ratios,
            inverse,
            own,
            scale,
            bands,
            pivots,
        };
        system.own = system.conducted_diagonal();
        system.scale = system.scales();
        system
    }

    pub fn is_solved(&self, node: usize) -> bool {
        self.storage[node].is_finite()
    }

    pub fn storage(&self, node: usize) -> f64 {
        self.storage[node]
    }

    /// Heat flow from a node to its neighbours, per its temperature [W/K].
    pub fn conducted(&self, node: usize) -> f64 {
        self.own[node] / self.inverse[node]
    }

    /// Heat flow from a node to the surroundings, per its temperature [W/K].
    pub fn lost(&self, node: usize) -> f64 {
        self.loss[node] / self.inverse[node]
    }

    /// Change of the heat into each node by conduction under a change x [W].
    pub fn conduct(&self, x: &[f64], out: &mut [f64]) {
        let times = |list: &[f64]| -> Vec<f64> { list.iter().zip(x).map(|(a, b)| a * b).collect() };
        let below = times(&self.ratios[0]);
        if !self.has_layers {
            return self.grid.conduct([&below, &below], &below, out);
        }
        let above = times(&self.ratios[1]);
        self.grid.conduct([&below, &above], &times(&self.inverse), out);
    }

    /// `√(diag Ā / diag A)`, zero at held nodes.
    fn scales(&self) -> Vec<f64> {
        let (areas, sideways) = (self.grid.areas(), self.grid.lateral_diagonal());
        let plane = areas.len();
        let scale = |node: usize| {
            let (k, i) = (node / plane, node % plane);
            let mean = areas[i] * self.bands.diagonal[k] + sideways[i] * self.bands.spread[k];
            let own = self.storage[node] + self.tau * (self.loss[node] + self.own[node]);
            if self.is_solved(node) { (mean / own).sqrt() } else { 0.0 }
        };
        (0..self.own.len()).map(scale).collect()
    }

    /// Returns the diagonal of conduction.
    fn conducted_diagonal(&self) -> Vec<f64> {
        let (areas, sideways) = (self.grid.areas(), self.grid.lateral_diagonal());
        let plane = areas.len();
        let mut out = vec![0.0; self.storage.len()];
        for (k, level) in self.grid.levels.iter().enumerate() {
            let joints = [k.checked_sub(1), Some(k)];
            let joints = joints.map(|n| n.and_then(|n| self.grid.joints.get(n)));
            for i in 0..plane {
                let node = k * plane + i;
                let ratios = [0, 1].map(|side| self.ratios[side][node]);
                let own = |side: usize| match joints[side] {
                    Some(Joint::Element(inverse)) => inverse * ratios[side],
                    Some(Joint::Contact(conductance)) => conductance * self.inverse[node],
                    None => 0.0,
                };
                let height = level.heights[0] * ratios[0] + level.heights[1] * ratios[1];
                out[node] = areas[i] * (own(0) + own(1)) + height * sideways[i];
            }
        }
        out
    }
}

impl Operator for System<'_> {
    fn apply(&self, x: &[f64], out: &mut [f64]) {
        self.conduct(x, out);
        for (node, value) in out.iter_mut().enumerate() {
            let own = self.storage[node] + self.tau * self.loss[node];
            *value = if self.is_solved(node) { own * x[node] - self.tau * *value } else { 0.0 };
        }
    }

    fn precondition(&self, residual: &[f64], out: &mut [f64]) {
        let scaled: Vec<f64> = residual.iter().zip(&self.scale).map(|(r, s)| r * s).collect();
        let mut modal = self.lateral.project(&scaled);
        self.bands.solve(&mut modal, &self.pivots, self.lateral.count());
        let nodal = self.lateral.expand(&modal);
        for ((value, x), scale) in out.iter_mut().zip(&nodal).zip(&self.scale) {
            *value = x * scale;
        }
    }
}

impl Bands {
    fn new(grid: &Grid, tau: f64, coefficients: &Coefficients) -> Self {
        let count = grid.levels.len();
        let means = Means::new(grid, coefficients);
        let mut bands = Self {
            diagonal: means.storage.clone(),
            below: vec![0.0; count],
            above: vec![0.0; count],
            spread: vec![0.0; count],
        };
        for (k, joint) in grid.joints.iter().enumerate() {
            let (low, high) = match *joint {
                Joint::Element(inverse) => {
                    (inverse * means.ratios[1][k], inverse * means.ratios[0][k + 1])
                }
                Joint::Contact(conductance) => {
                    (conductance * means.inverse[k], conductance * means.inverse[k + 1])
                }
            };
            bands.diagonal[k] += tau * low;
            bands.diagonal[k + 1] += tau * high;
            bands.above[k] = -tau * high;
            bands.below[k + 1] = -tau * low;
        }
        let aside = coefficients.aside.iter().copied().enumerate();
        for (k, loss) in [0, count - 1].into_iter().zip(coefficients.ends).chain(aside) {
            bands.diagonal[k] += tau * loss * means.inverse[k];
        }
        for (k, level) in grid.levels.iter().enumerate() {
            bands.spread[k] = tau
                * (level.heights[0] * means.ratios[0][k] + level.heights[1] * means.ratios[1][k]);
            if !means.storage[k].is_finite() {
                // No node of the level is free.
                (bands.diagonal[k], bands.spread[k]) = (1.0, 0.0);
                (bands.below[k], bands.above[k]) = (0.0, 0.0);
            }
        }
        bands
    }

    fn factor(&self, decay: &[f64]) -> Vec<f64> {
        let mut pivots: Vec<f64> = Vec::with_capacity(decay.len() * self.diagonal.len());
        for k in 0..self.diagonal.len() {
            let link = if k > 0 { self.below[k] * self.above[k - 1] } else { 0.0 };
            for (i, eigenvalue) in decay.iter().enumerate() {
                let own = self.diagonal[k] + self.spread[k] * eigenvalue;
                let before = if k > 0 { pivots[(k - 1) * decay.len() + i] } else { 0.0 };
                pivots.push(1.0 / (own - link * before));
            }
        }
        pivots
    }

    fn solve(&self, modal: &mut [f64], pivots: &[f64], modes: usize) {
        let levels = self.diagonal.len();
        for k in 1..levels {
            let (before, rest) = modal[(k - 1) * modes..].split_at_mut(modes);
            let pivots = &pivots[(k - 1) * modes..][..modes];
            for ((value, low), pivot) in rest[..modes].iter_mut().zip(&*before).zip(pivots) {
                *value -= self.below[k] * pivot * low;
            }
        }
        for k in (0..levels).rev() {
            let (own, after) = modal[k * modes..].split_at_mut(modes);
            let pivots = &pivots[k * modes..][..modes];
            for (value, pivot) in own.iter_mut().zip(pivots) {
                *value *= pivot;
            }
            if k + 1 < levels {
                for ((value, high), pivot) in own.iter_mut().zip(&after[..modes]).zip(pivots) {
                    *value -= self.above[k] * pivot * high;
                }
            }
        }
    }
}

/// Means over the free nodes of each level.
struct Means {
    /// Per area; infinite where no node of a level changes its temperature.
    storage: Vec<f64>,
    ratios: [Vec<f64>; 2],
    inverse: Vec<f64>,
}

impl Means {
    fn new(grid: &Grid, coefficients: &Coefficients) -> Self {
        let areas = grid.areas();
        let plane = areas.len();
        let mean = |k: usize, of: &dyn Fn(usize) -> f64| {
            let (mut sum, mut measure) = (0.0, 0.0);
            for (i, area) in areas.iter().enumerate() {
                if !coefficients.held[k * plane + i] {
                    sum += area * of(k * plane + i);
                    measure += area;
                }
            }
            if measure > 0.0 { sum / measure } else { 0.0 }
        };
        let list = |of: &dyn Fn(usize) -> f64| -> Vec<f64> {
            (0..grid.levels.len()).map(|k| mean(k, of)).collect()
        };
        let response = list(&|node| areas[node % plane] / coefficients.storage[node]);
        Self {
            storage: response.iter().map(|response| 1.0 / response).collect(),
            ratios: [0, 1].map(|side| list(&|node| coefficients.ratios[side][node])),
            inverse: list(&|node| coefficients.inverse[node]),
        }
    }
}
