//! A body of large strain: stresses of its points, and forces on its nodes.

use std::ops::Range;

use super::mirrors::fixed;
use super::{Course, Courses};
use crate::laws::solid::large_strain::{Deformed, LargeStrainLaw};
use crate::laws::solid::stress::von_mises;
use crate::math::matrix3::{IDENTITY, Matrix3, contraction, packed, scale_deviator};
use crate::runtime::parallel::Team;
use crate::space::{Form, Samples, Shared, Space};

/// A body in its reference configuration with the laws of its layers.
pub struct Deformable {
    pub space: Space,
    pub layers: Vec<LayerOfBody>,
    /// Layer of each group of points, and where its history begins; that of the whole ends the list.
    pub layer_of_group: Vec<usize>,
    histories: Vec<usize>,
    /// Mass of each node [kg].
    pub mass: Vec<f64>,
    /// Axes along which each node is at rest: those that a model lacks, and normals of its planes of symmetry.
    pub fixed: Vec<[bool; 3]>,
    /// True for x and y if the body is one half, on the positive side, of what a plane of symmetry or an axis mirrors.
    pub(super) mirrored: [bool; 2],
    /// For each node its functions at all points.
    uses: Vec<Vec<Use>>,
    /// Number of threads of its loops.
    pub threads: usize,
    /// True for a plane section without stress across it, where each point has a dilatation of its own.
    pub is_sheet: bool,
}

/// A layer's law and reference density ρ₀ [kg/m³].
#[derive(Debug, Clone, PartialEq)]
pub struct LayerOfBody {
    pub law: LargeStrainLaw,
    pub density: f64,
}

/// A function of a node at a point of the volume.
#[derive(Debug, Clone, Copy)]
struct Use {
    point: u32,
    gradient: [f64; 3],
    /// Ψ/r in an axisymmetric model.
    hoop: f64,
}

/// Stresses of the points of a body, and what follows from them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Stresses {
    /// Volume times P of each point [N m].
    pub loads: Vec<Matrix3>,
    /// Stretch across a sheet at each point; empty for other bodies.
    pub across: Vec<f64>,
    /// Stored energy [J].
    pub energy: f64,
    /// Power with which thermal stretches change it [W].
    pub swelling: f64,
    /// Largest modulus of plane waves over that of the undeformed body.
    pub stiffening: f64,
    /// Smallest J of a point.
    pub least: f64,
}

/// Knowledge of the stretch across a sheet.
#[derive(Debug, Clone, Copy)]
pub(super) enum Sheet<'a> {
    /// The history before the step.
    From(&'a [f64]),
    /// The stretch of each point of the body.
    Known(&'a [f64]),
}

impl Deformable {
    /// Creates a body of one law with mirrors at x = 0 and y = 0, where these are planes of symmetry.
    pub fn new(
        space: Space,
        law: LargeStrainLaw,
        density: f64,
        mirrors: [bool; 2],
        threads: usize,
    ) -> Self {
        let layer_of_group = vec![0; space.groups.len()];
        let mass = space.shares.iter().map(|share| density * share).collect();
        let layers = (vec![LayerOfBody { law, density }], layer_of_group);
        Self::with(space, layers, mass, mirrors, threads)
    }

    /// Creates a body of layers, with the layer of each group of points; see [`Self::new`].
    pub fn layered(
        space: Space,
        layers: (Vec<LayerOfBody>, Vec<usize>),
        mirrors: [bool; 2],
        threads: usize,
    ) -> Self {
        let densities: Vec<f64> = layers.0.iter().map(|layer| layer.density).collect();
        let mass = lumped(&space, &layers.1, &densities);
        Self::with(space, layers, mass, mirrors, threads)
    }

    /// Makes a plane body a sheet, without stress across it.
    ///
    /// # Panics
    /// If points share dilatations; see [`Space::with_points_alone`].
    pub fn of_sheet(mut self) -> Self {
        let is_alone = self.space.groups.iter().all(|group| group.len() == 1);
        assert!(is_alone && self.space.form == Form::Plane, "a sheet is plane, its points alone");
        self.is_sheet = true;
        self
    }

    /// Integrals over the shares of the nodes of a value of each layer per reference volume.
    pub fn lumped(&self, of_layers: &[f64]) -> Vec<f64> {
        match of_layers {
            [only] => self.space.shares.iter().map(|share| only * share).collect(),
            _ => lumped(&self.space, &self.layer_of_group, of_layers),
        }
    }

    fn with(
        space: Space,
        (layers, layer_of_group): (Vec<LayerOfBody>, Vec<usize>),
        mass: Vec<f64>,
        mirrors: [bool; 2],
        threads: usize,
    ) -> Self {
        let mut histories = vec![0];
        for (group, &layer) in space.groups.iter().zip(&layer_of_group) {
            let own = group.len() * layers[layer].law.history();
            histories.push(histories[histories.len() - 1] + own);
        }
        let mirrored = [mirrors[0] || space.form == Form::Axisymmetric, mirrors[1]];
        let fixed = space.nodes.iter().map(|at| fixed(space.form, mirrored, *at)).collect();
        let mut uses = vec![Vec::new(); space.nodes.len()];
        for point in 0..space.volume.len() {
            let r = space.volume.at[point][0];
            for value in space.volume.row(point) {
                let hoop = if space.form == Form::Axisymmetric { value.value / r } else { 0.0 };
                let gradient = value.gradient;
                uses[value.node as usize].push(Use { point: point as u32, gradient, hoop });
            }
        }
        Self {
            space,
            layers,
            layer_of_group,
            histories,
            mass,
            fixed,
            mirrored,
            uses,
            threads,
            is_sheet: false,
        }
    }

    /// Starts the threads of its loops, which end with the value.
    pub fn team(&self) -> Team {
        Team::new(self.threads)
    }

    pub fn nodes(&self) -> usize {
        self.mass.len()
    }

    /// Displacements of the nodes themselves from their coefficients, which are the same where each function is one at
    /// its own node.
    pub fn displacements(&self, u: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let Some(at_nodes) = &self.space.at_nodes else { return u.to_vec() };
        let of_node = |node: usize| {
            let mut sum = [0.0; 3];
            for value in at_nodes.row(node) {
                let u = u[value.node as usize];
                (0..3).for_each(|a| sum[a] += value.value * u[a]);
            }
            sum
        };
        (0..self.nodes()).map(of_node).collect()
    }

    /// Values at the nodes themselves from their coefficients.
    pub fn at_nodes(&self, values: &[f64]) -> Vec<f64> {
        let Some(at_nodes) = &self.space.at_nodes else { return values.to_vec() };
        let row = |node: usize| at_nodes.row(node).iter();
        let of_node = |node| row(node).map(|own| own.value * values[own.node as usize]).sum();
        (0..self.nodes()).map(of_node).collect()
    }

    /// Mean of a field of the nodes over each group of points.
    pub fn means_of_groups(&self, values: &[f64]) -> Vec<f64> {
        let volume = &self.space.volume;
        let at = |point: usize| -> f64 {
            volume.row(point).iter().map(|own| own.value * values[own.node as usize]).sum()
        };
        let of_group = |group: &Range<usize>| {
            let whole: f64 = volume.weights[group.clone()].iter().sum();
            group.clone().map(|point| volume.weights[point] * at(point)).sum::<f64>() / whole
        };
        self.space.groups.iter().map(of_group).collect()
    }

    /// Nodes of the functions at points, ascending.
    pub fn nodes_of(&self, points: &Range<usize>) -> Vec<u32> {
        let rows = points.clone().flat_map(|point| self.space.volume.row(point));
        let mut nodes: Vec<u32> = rows.map(|value| value.node).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// Length of the history of all points.
    pub fn history(&self) -> usize {
        self.histories[self.space.groups.len()]
    }

    /// Place of the history of a group's points.
    pub fn history_of(&self, group: usize) -> Range<usize> {
        self.histories[group]..self.histories[group + 1]
    }

    /// Law of a group of points.
    pub fn law_of(&self, group: usize) -> &LargeStrainLaw {
        &self.layers[self.layer_of_group[group]].law
    }

    /// Returns true if part of the body yields.
    pub fn yields(&self) -> bool {
        self.layers.iter().any(|layer| layer.law.yields())
    }

    /// Accumulated plastic strain of each point for a history of all.
    pub fn plastic_strains(&self, history: &[f64]) -> Vec<f64> {
        self.of_histories(history, LargeStrainLaw::plastic_strain)
    }

    /// Values of all points that follow from the law and the history of each.
    pub fn of_histories<T>(
        &self,
        history: &[f64],
        of: impl Fn(&LargeStrainLaw, &[f64]) -> T,
    ) -> Vec<T> {
        let mut values = Vec::with_capacity(self.space.volume.len());
        for (group, points) in self.space.groups.iter().enumerate() {
            let (law, own) = (self.law_of(group), &history[self.history_of(group)]);
            let length = law.history();
            values.extend((0..points.len()).map(|n| of(law, &own[length * n..length * (n + 1)])));
        }
        values
    }

    /// Returns true if a run may produce a history of all points.
    pub fn is_sound(&self, history: &[f64]) -> bool {
        let of_group = |group: usize| {
            let law = self.law_of(group);
            let own = &history[self.history_of(group)];
            law.history() == 0 || own.chunks_exact(law.history()).all(|own| law.is_sound(own))
        };
        (0..self.space.groups.len()).all(of_group)
    }

    /// Returns true if the derivatives of the stresses of all layers are symmetric.
    pub fn has_symmetric_tangent(&self) -> bool {
        self.layers.iter().all(|layer| layer.law.is_symmetric())
    }

    /// Largest modulus of plane waves of a layer [Pa].
    pub fn wave_modulus(&self) -> f64 {
        self.layers.iter().map(|layer| layer.law.wave_modulus()).fold(0.0, f64::max)
    }

    /// A step in which all layers go through the same.
    pub fn in_all(&self, over: Course) -> Courses {
        Courses::OfLayers(vec![over; self.layers.len()])
    }

    /// `F` at a point for displacements u of the nodes.
    pub fn gradient(&self, samples: &Samples, point: usize, u: &[[f64; 3]]) -> Matrix3 {
        let mut f = IDENTITY;
        let mut around = 0.0;
        for value in samples.row(point) {
            let u = u[value.node as usize];
            for (row, u) in f.iter_mut().zip(u) {
                (0..3).for_each(|b| row[b] += u * value.gradient[b]);
            }
            around += value.value * u[0];
        }
        if self.space.form == Form::Axisymmetric {
            f[1][1] += around / samples.at[point][0];
        }
        f
    }

    /// Elastic deformation of the points of a group over the thermal stretch of a step, and the dilatation that they
    /// share.
    pub(super) fn group(
        &self,
        number: usize,
        u: &[[f64; 3]],
        over: Course,
        sheet: Sheet,
    ) -> (Vec<Deformed>, Shared) {
        let (points, volume) = (&self.space.groups[number], &self.space.volume);
        let Course { time, stretch, .. } = over;
        let elastic = |f: Matrix3| f.map(|row| row.map(|value| value / stretch));
        let at = |point| {
            let mut gradient = elastic(self.gradient(volume, point, u));
            match sheet {
                _ if !self.is_sheet => {}
                Sheet::Known(across) => gradient[1][1] = across[point] / stretch,
                Sheet::From(before) => {
                    return self.law_of(number).thinned(gradient, time, before);
                }
            }
            Deformed::of(gradient)
        };
        let all: Vec<Deformed> = points.clone().map(at).collect();
        let shared = self.shared_dilatation(number, &all);
        (all, shared)
    }

    /// Elastic deformation of all points over their thermal stretches in a step from a history, and the dilatation that
    /// each group shares.
    pub fn deformations(
        &self,
        u: &[[f64; 3]],
        (over, before): (&Courses, &[f64]),
        team: &Team,
    ) -> (Vec<Deformed>, Vec<Shared>) {
        let of_group = |group: usize| {
            let before = &before[self.history_of(group)];
            self.group(group, u, over.at(self, group), Sheet::From(before))
        };
        self.of_groups(of_group, team)
    }

    /// The same where the stresses are known.
    pub fn deformations_under(
        &self,
        u: &[[f64; 3]],
        (over, stresses): (&Courses, &Stresses),
        team: &Team,
    ) -> (Vec<Deformed>, Vec<Shared>) {
        let across = Sheet::Known(&stresses.across);
        self.of_groups(|group| self.group(group, u, over.at(self, group), across), team)
    }

    fn of_groups(
        &self,
        of_group: impl Fn(usize) -> (Vec<Deformed>, Shared) + Sync,
        team: &Team,
    ) -> (Vec<Deformed>, Vec<Shared>) {
        let all = team.map(self.space.groups.len(), of_group);
        let (points, dilatations): (Vec<_>, Vec<_>) = all.into_iter().unzip();
        (points.concat(), dilatations)
    }

    /// Internal forces on the nodes [N], which resist the deformation.
    pub fn forces(&self, stresses: &Stresses, team: &Team) -> Vec<[f64; 3]> {
        self.forces_of(&stresses.loads, team)
    }

    /// The same of the volume times P of each point [N m].
    pub fn forces_of(&self, loads: &[Matrix3], team: &Team) -> Vec<[f64; 3]> {
        team.map(self.uses.len(), |node| {
            let mut force = [0.0; 3];
            for Use { point, gradient, hoop } in &self.uses[node] {
                let load = &loads[*point as usize];
                for (total, row) in force.iter_mut().zip(load) {
                    *total -= row[0] * gradient[0] + row[1] * gradient[1] + row[2] * gradient[2];
                }
                force[0] -= load[1][1] * hoop;
            }
            force
        })
    }

    /// Work of the stresses under a change of displacements [J].
    pub fn work(&self, stresses: &Stresses, change: &[[f64; 3]], team: &Team) -> f64 {
        let of_point = |point: usize| {
            let mut f = self.gradient(&self.space.volume, point, change);
            (0..3).for_each(|a| f[a][a] -= 1.0);
            contraction(&stresses.loads[point], &f)
        };
        team.map(stresses.loads.len(), of_point).into_iter().sum()
    }

    /// Cauchy stress of a point [Pa].
    pub fn cauchy(&self, u: &[[f64; 3]], stresses: &Stresses, point: usize) -> Matrix3 {
        let mut gradient = self.gradient(&self.space.volume, point, u);
        if let Some(across) = stresses.across.get(point) {
            gradient[1][1] = *across;
        }
        let at = Deformed::of(gradient);
        let scale = 1.0 / (at.dilatation * self.space.volume.weights[point]);
        let load = &stresses.loads[point];
        let entry = |a: usize, b: usize| {
            scale * (0..3).map(|k| load[a][k] * at.gradient[b][k]).sum::<f64>()
        };
        let mut stress = std::array::from_fn(|a| std::array::from_fn(|b| entry(a, b)));
        if self.yields() {
            // The law bounds Kirchhoff's deviator, which is Cauchy's times the dilatation that the points share.
            scale_deviator(&mut stress, at.dilatation / self.dilatation_beside(u, point, &at));
        }
        stress
    }

    /// The dilatation that a point shares with others.
    fn dilatation_beside(&self, u: &[[f64; 3]], point: usize, own: &Deformed) -> f64 {
        let groups = &self.space.groups;
        let group = groups.partition_point(|group| group.end <= point);
        if groups[group].len() == 1 {
            return own.dilatation;
        }
        let volume = &self.space.volume;
        let at = |other| Deformed::of(self.gradient(volume, other, u));
        let all: Vec<Deformed> = groups[group].clone().map(at).collect();
        self.shared_dilatation(group, &all).at(point - groups[group].start)
    }

    /// Largest von Mises stress of a point [Pa].
    pub fn greatest_von_mises(&self, u: &[[f64; 3]], stresses: &Stresses, team: &Team) -> f64 {
        self.von_mises(u, stresses, team).into_iter().fold(0.0, f64::max)
    }

    /// Von Mises stress of each point [Pa].
    pub fn von_mises(&self, u: &[[f64; 3]], stresses: &Stresses, team: &Team) -> Vec<f64> {
        let of_point = |point: usize| von_mises(packed(&self.cauchy(u, stresses, point)));
        team.map(stresses.loads.len(), of_point)
    }

    /// Largest frequency of the undeformed body [1/s], by power iteration.
    pub fn highest_frequency(&self) -> f64 {
        let team = &self.team();
        let size = self.space.nodes.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
        let mut shape: Vec<[f64; 3]> = (0..self.nodes()).map(rough).collect();
        let mut square: f64 = 0.0;
        let still = self.in_all(Course::NONE);
        for _ in 0..ITERATIONS {
            self.flatten(&mut shape);
            let largest = shape.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
            let scale = TINY * size / largest;
            let u: Vec<[f64; 3]> = shape.iter().map(|x| x.map(|x| scale * x)).collect();
            let mut history = vec![0.0; self.history()];
            let Ok(stresses) = self.respond(&u, &still, &mut history, team) else { break };
            let forces = self.forces(&stresses, team);
            let products = forces.iter().zip(&u).zip(&self.mass).map(|((f, u), m)| {
                let along: f64 = (0..3).map(|a| f[a] * u[a]).sum();
                [-along, m * u.iter().map(|u| u * u).sum::<f64>()]
            });
            let [work, norm] = products.fold([0.0; 2], |[a, b], [c, d]| [a + c, b + d]);
            square = square.max(work / norm);
            shape = forces.iter().zip(&self.mass).map(|(f, m)| f.map(|f| f / m)).collect();
        }
        square.sqrt()
    }

    /// Removes motion along fixed axes.
    pub fn flatten(&self, shape: &mut [[f64; 3]]) {
        for (shape, fixed) in shape.iter_mut().zip(&self.fixed) {
            (0..3).filter(|&a| fixed[a]).for_each(|a| shape[a] = 0.0);
        }
    }
}

/// Integrals over the functions of the nodes of a value of each layer.
fn lumped(space: &Space, layer_of_group: &[usize], of_layers: &[f64]) -> Vec<f64> {
    let mut sums = vec![0.0; space.nodes.len()];
    for (group, &layer) in space.groups.iter().zip(layer_of_group) {
        for point in group.clone() {
            let share = of_layers[layer] * space.volume.weights[point];
            for value in space.volume.row(point) {
                sums[value.node as usize] += share * value.value;
            }
        }
    }
    sums
}

/// Iterations after which the highest frequency is known to a few per cent, from below.
const ITERATIONS: usize = 60;
/// Displacements over the extent of a body at which it responds linearly.
const TINY: f64 = 1e-7;

/// A rough start for the iteration: multiples of the golden ratio, which repeat nowhere.
fn rough(node: usize) -> [f64; 3] {
    let number = |n: usize| 2.0 * (n as f64 * 0.618_033_988_749_895).fract() - 1.0;
    [number(3 * node + 1), number(3 * node + 2), number(3 * node + 3)]
}
