//! A body alone with linear heat and its readings, without data that do not affect these.

use super::experiment::tries_least_radii;
use super::sample::sample;
use crate::body::fine_radius;
use crate::laws::radiative_coefficient;
use crate::scene::{
    Body, Carries, CellValues, Convection, Face, FaceName, FidelityLevel, Footprint, Gives, Load,
    LoadRange, LoadStart, MaterialChoice, MeshFactors, PeakOf, Radiation, Role, Scene, Solid,
    takes_newton,
};

/// Quantities of a body whose errors are estimated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Physics {
    Heat,
    /// Stresses and displacements.
    Deformation,
}

/// A scene of one body that represents that body of another scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Twin {
    scene: Scene,
    name: String,
    /// Numbers of elements of its own mesh over the usual ones.
    own: [f64; 2],
    /// True if extremes of the body count. Those of stress may lie at edges where no mesh converges, so they count only
    /// if running maxima are requested.
    pub reads_extremes: bool,
    /// True if stress depends on the history of the body, because it yields, creeps or has tabulated constants; moduli
    /// that relax alone do not count.
    pub has_history: bool,
    /// True if loads represent drops, whose heat does not depend on the mesh.
    pub has_drops: bool,
    /// True if heat uses linear elements, as with Newton's method.
    pub linear_heat: bool,
    /// True if mechanics is left out, as the body cracks.
    heat_alone: bool,
    /// Notes on differences from the body itself.
    pub simplified: Vec<String>,
}

/// Largest number of probes of a twin; a sample represents a longer list.
pub const MOST_PROBES: usize = 256;

impl Twin {
    /// Creates the twin of a solid of a scene; `None` if there is nothing to estimate.
    pub fn of(scene: &Scene, name: &str, physics: Physics) -> Option<Self> {
        let solid = scene.meshed(name)?;
        let is_mechanical = physics == Physics::Deformation;
        let has_stress_peaks = solid.has_stress_peaks();
        // The probability of failure is no output whose error is estimated.
        let reads = scene.gives_mechanics_at_places(name) || has_stress_peaks;
        if is_mechanical && (solid.cracks() || !reads && !has_stress_peaks) {
            return None;
        }
        let mut simplified = Vec::new();
        let own = |gives: &[Gives]| -> Vec<Gives> {
            let wanted =
                |what: &&Gives| what.is_mechanical() == is_mechanical && !what.is_of_history();
            gives.iter().filter(wanted).copied().collect()
        };
        let mut twin = scene.alone(name);
        let own_factors = scene.refinement.get(name).map_or([1.0; 2], MeshFactors::factors);
        twin.refinement.clear();
        twin.load =
            scene.loads_on(name).filter_map(|load| part_of_load(load, is_mechanical)).collect();
        twin.load.extend(drops(scene, name));
        twin.probe.iter_mut().for_each(|probe| probe.gives = own(&probe.gives));
        twin.probe.retain(|probe| !probe.gives.is_empty());
        let probes = twin.probe.len();
        if probes > MOST_PROBES {
            let sample = sample(probes, MOST_PROBES);
            twin.probe = sample.into_iter().map(|place| twin.probe[place].clone()).collect();
            simplified.push(format!("{MOST_PROBES} of {probes} probes stand for all of them"));
        }
        twin.field.iter_mut().for_each(|field| field.gives = own(&field.gives));
        twin.field.retain(|field| !field.gives.is_empty());
        twin.solver.threads = 1;
        twin.fidelity.level = FidelityLevel::Full;
        let linear_heat = takes_newton(scene, solid);
        if linear_heat {
            simplified.push(
                "constants are those at the temperature at time zero, nothing melts, and faces radiate in proportion to \
                 what they are warmer than their surroundings"
                    .to_owned(),
            );
            if solid.melts() {
                simplified.push(
                    "fronts are left out, which go from node to node: the error of temperatures behind one is up to half \
                     of an element over the depth that is molten"
                        .to_owned(),
                );
            }
        }
        let heat_alone = solid.cracks();
        let has_drops = scene.couplings_to(name).next().is_some();
        if has_drops {
            simplified.push(
                "a disc as wide as the drop is expected to spread stands for it where it lands, and brings a heat that does \
                 not depend on the mesh: the dependence of a drop's heat on it is not estimated"
                    .to_owned(),
            );
        }
        twin.solver.method = Default::default();
        let touched: Vec<_> = touched(scene, name).collect();
        if !touched.is_empty() {
            simplified.push("what touches the body keeps its temperature at time zero".to_owned());
        }
        let solid = twin.meshed_mut(name)?;
        for (face, convection) in touched {
            let face = solid.faces.entry(face).or_default();
            face.convection = Some(beside(face.convection, convection));
        }
        let only_relaxes = solid.only_relaxes();
        if is_mechanical && only_relaxes {
            simplified.push("moduli are the instantaneous ones at all times".to_owned());
        }
        let has_history = is_mechanical && !solid.deforms_linearly() && !only_relaxes;
        linearise(solid, has_history);
        solid.peaks.clear();
        if is_mechanical && !reads {
            solid.peaks.push(PeakOf::VonMises);
        }
        let reads_extremes = !is_mechanical || has_stress_peaks;
        if tries_least_radii(&twin) {
            simplified.push(
                "loads are tried at the lower ends of their ranges of radius, too".to_owned(),
            );
        }
        Some(Self {
            scene: twin,
            name: name.to_owned(),
            own: own_factors,
            reads_extremes,
            has_history,
            has_drops,
            linear_heat,
            heat_alone,
            simplified,
        })
    }

    /// Returns the scene on a mesh with these multiples of its own numbers of elements along the surface and through
    /// the thickness.
    pub fn on_mesh(&self, factors: [f64; 2]) -> Scene {
        let mut scene = self.scene.clone();
        let factors = MeshFactors::of([0, 1].map(|way| self.own[way] * factors[way]));
        let factors =
            MeshFactors { linear_heat: self.linear_heat, heat_alone: self.heat_alone, ..factors };
        scene.refinement.insert(self.name.clone(), factors);
        scene
    }

    /// Name of the body.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the body itself.
    pub fn solid(&self) -> &Solid {
        self.scene.meshed(&self.name).expect("twins are made of bodies with a mesh")
    }

    /// Returns the scene without a mesh.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }
}

/// Returns the part of a load that brings heat, or all of it; `None` if that is empty.
fn part_of_load(load: &Load, is_mechanical: bool) -> Option<Load> {
    let mut load = load.clone();
    load.carries.retain(|what| is_mechanical || !what.is_mechanical());
    Some(load).filter(|load| !load.carries.is_empty())
}

/// Returns loads that represent drops, of their size where they land.
fn drops(scene: &Scene, name: &str) -> impl Iterator<Item = Load> {
    let is_round = scene.body.get(name).is_some_and(Body::is_round);
    scene.drops_on(name).map(move |(coupling, droplet)| {
        let reach = fine_radius(coupling, droplet, scene.stop_time);
        let spread = 0.5 * droplet.spread_diameter();
        let radius = spread.min(reach).max(0.5 * droplet.diameter);
        let [x, y] = droplet.landings().next().unwrap_or_default();
        let start = LoadStart {
            x: (!is_round).then_some(x),
            y: (!is_round).then_some(y),
            radius: Some(radius),
            heat_flux: Some(CellValues::Uniform(0.0)),
            ..LoadStart::default()
        };
        Load {
            name: coupling.from.clone(),
            on: coupling.to.clone(),
            footprint: Footprint::Disc { radius },
            carries: vec![Carries::HeatFlux],
            start,
            range: LoadRange { radius: Some([radius, reach.max(radius)]), ..LoadRange::default() },
            role: Role::default(),
        }
    })
}

/// Returns the faces of a solid that others touch, with convection that represents these at their first temperatures.
fn touched(scene: &Scene, name: &str) -> impl Iterator<Item = (FaceName, Convection)> {
    scene.coupling.iter().filter_map(move |coupling| {
        let (lower, upper) = (coupling.lower()?, coupling.upper()?);
        let ((_, face), other) = match name {
            own if own == lower.0 => (lower, upper.0),
            own if own == upper.0 => (upper, lower.0),
            _ => return None,
        };
        let ambient = scene.body.get(other)?.initial_temperature();
        Some((face, Convection { coefficient: coupling.conductance?, ambient }))
    })
}

/// The sum of two fluxes by convection.
fn beside(other: Option<Convection>, own: Convection) -> Convection {
    let Some(other) = other else { return own };
    let coefficient = other.coefficient + own.coefficient;
    let heat = other.coefficient * other.ambient + own.coefficient * own.ambient;
    let ambient = if coefficient > 0.0 { heat / coefficient } else { own.ambient };
    Convection { coefficient, ambient }
}

/// Replaces radiation of a face by the convection equivalent at a temperature [K]. On a face with a `flux` only that
/// remains.
fn convect(face: &mut Face, temperature: f64) {
    let Some(Radiation { emissivity, ambient }) = face.radiation.take() else { return };
    if face.flux.is_some() {
        return;
    }
    let coefficient = radiative_coefficient(emissivity, temperature, ambient);
    let both = beside(face.convection, Convection { coefficient, ambient });
    if both.coefficient > 0.0 {
        face.convection = Some(both);
    }
}

/// Replaces constants of heat by their values at the temperature at time zero. Those of deformation are replaced, too,
/// if the body has no history.
fn linearise(solid: &mut Solid, has_history: bool) {
    let temperature = solid.initial_temperature;
    solid.faces.values_mut().for_each(|face| convect(face, temperature));
    let choices = solid
        .material
        .iter_mut()
        .chain(solid.layers.iter_mut().flatten().map(|layer| &mut layer.material));
    choices.for_each(|choice: &mut MaterialChoice| {
        let material = choice.material();
        let mut own = material.linearised(temperature, !has_history);
        // The mesh of a body that cracks follows from its law.
        own.fracture.cracking = material.fracture.cracking;
        own.fracture.toughness = material.fracture.toughness;
        *choice = MaterialChoice::of(own);
    });
}
