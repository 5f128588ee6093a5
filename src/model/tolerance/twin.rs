//! A body by itself, its heat linear, with what is read of it and without what does not matter to that.

use super::experiment::tries_least_radii;
use super::sample::sample;
use crate::body::fine_radius;
use crate::material::{Material, Properties, Property, radiative_coefficient};
use crate::scene::{
    Body, Carries, CellValues, Convection, Face, FidelityLevel, Footprint, Gives, Load, LoadRange,
    LoadStart, MaterialChoice, MeshFactors, PeakOf, Radiation, Role, Scene, Solid, takes_newton,
};

/// What of a body is estimated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Physics {
    Heat,
    /// Stresses and displacements.
    Deformation,
}

/// A scene of one body that stands for that body of another scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Twin {
    scene: Scene,
    name: String,
    /// Numbers of elements of its own mesh over the usual ones.
    own: [f64; 2],
    /// Whether extremes of the body count: those of stress, which may lie at edges where no mesh finds them, count where
    /// running maxima ask for them.
    pub reads_extremes: bool,
    /// Whether stress depends on the history of the body, as it yields, creeps or has constants that are tables.
    pub has_history: bool,
    /// Whether loads stand for drops, whose heat these bring whatever the mesh is.
    pub has_drops: bool,
    /// Whether heat goes through linear elements, as Newton's method has them.
    pub linear_heat: bool,
    /// What differs from the body itself.
    pub simplified: Vec<String>,
}

/// Probes of a twin, at most: of more, a sample stands for all.
pub const MOST_PROBES: usize = 256;

impl Twin {
    /// Of a solid of a scene; nothing where there is nothing to be estimated.
    pub fn of(scene: &Scene, name: &str, physics: Physics) -> Option<Self> {
        let solid = scene.meshed(name)?;
        let is_mechanical = physics == Physics::Deformation;
        let reads = scene.gives_mechanics(name);
        let has_stress_peaks = solid.has_stress_peaks();
        if is_mechanical && !reads && !has_stress_peaks {
            return None;
        }
        let mut simplified = Vec::new();
        let own = |gives: &[Gives]| -> Vec<Gives> {
            let wanted = |what: &&Gives| {
                what.is_mechanical() == is_mechanical && **what != Gives::PlasticStrain
            };
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
        let has_drops = scene.couplings_to(name).next().is_some();
        if has_drops {
            simplified.push(
                "a disc as wide as the drop is expected to spread stands for it where it lands, and brings a heat that does \
                 not depend on the mesh: the dependence of a drop's heat on it is not estimated"
                    .to_owned(),
            );
        }
        twin.solver.method = Default::default();
        let solid = twin.meshed_mut(name)?;
        let has_history = is_mechanical && !solid.deforms_linearly();
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
            simplified,
        })
    }

    /// On a mesh of so many times as many elements as its own along the surface and through the thickness.
    pub fn on_mesh(&self, factors: [f64; 2]) -> Scene {
        let mut scene = self.scene.clone();
        let factors = MeshFactors::of([0, 1].map(|way| self.own[way] * factors[way]));
        let factors = MeshFactors { linear_heat: self.linear_heat, ..factors };
        scene.refinement.insert(self.name.clone(), factors);
        scene
    }

    /// Name of the body.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The body itself.
    pub fn solid(&self) -> &Solid {
        self.scene.meshed(&self.name).expect("twins are made of bodies with a mesh")
    }

    /// Without a mesh.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }
}

/// The part of a load that brings heat, or all of it; nothing if that is nothing.
fn part_of_load(load: &Load, is_mechanical: bool) -> Option<Load> {
    let mut load = load.clone();
    load.carries.retain(|what| is_mechanical || *what == Carries::HeatFlux);
    Some(load).filter(|load| !load.carries.is_empty())
}

/// What drops bring, as loads of their size where they land.
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

/// Lets a face that radiates convect what it would at a temperature [K]. One with a `flux` has that alone.
fn convect(face: &mut Face, temperature: f64) {
    let Some(Radiation { emissivity, ambient }) = face.radiation.take() else { return };
    if face.flux.is_some() {
        return;
    }
    let radiative = radiative_coefficient(emissivity, temperature, ambient);
    let beside = face.convection.unwrap_or(Convection { coefficient: 0.0, ambient });
    let coefficient = beside.coefficient + radiative;
    if coefficient > 0.0 {
        let ambient = (beside.coefficient * beside.ambient + radiative * ambient) / coefficient;
        face.convection = Some(Convection { coefficient, ambient });
    }
}

/// Makes constants of heat numbers, those at the temperature at time zero; those of deformation, too, where the body
/// does not have its history.
fn linearise(solid: &mut Solid, has_history: bool) {
    let temperature = solid.initial_temperature;
    solid.faces.values_mut().for_each(|face| convect(face, temperature));
    let choices = solid
        .material
        .iter_mut()
        .chain(solid.layers.iter_mut().flatten().map(|layer| &mut layer.material));
    choices.for_each(|choice: &mut MaterialChoice| {
        let own = choice.properties();
        let number = |property: &Property| Property::Constant(property.value(temperature));
        let constants = Properties {
            specific_heat: number(&own.specific_heat),
            conductivity: number(&own.conductivity),
            melting: None,
            ..own.clone()
        };
        *choice = MaterialChoice::of(match (has_history, choice.material()) {
            (true, Material::Elastoplastic(_)) => Material::Elastoplastic(constants),
            (true, Material::Viscoplastic(_)) => Material::Viscoplastic(constants),
            (true, Material::Thermoelastic(_)) => Material::Thermoelastic(constants),
            (false, _) => Material::Thermoelastic(Properties {
                young: own.young.as_ref().map(number),
                poisson: own.poisson.as_ref().map(number),
                expansion: own.expansion.as_ref().map(number),
                yield_stress: None,
                isotropic_hardening: None,
                kinematic_hardening: None,
                creep: None,
                ..constants
            }),
        });
    });
}
