//! Model of a solid, decided before any heavy work: symmetry, mesh, physics.

use std::sync::Arc;

use super::crack_mesh::crack_mesh;
use super::elastic::Support;
use super::fineness::{Fineness, Resolution};
use super::heat::ThermalFace;
use super::solver_choice::note_on_solver;
use crate::laws::fracture::GradientDamage;
use crate::laws::heat::unevenness;
use crate::laws::{Conduction, Constants, FlawStatistics, FlowLaw, Thermoelastic};
use crate::method::mesh::{Axis, Weight};
use crate::method::mesh::{Geometry, Mesh, MeshFace};
use crate::quantity::percent;
use crate::scene::{
    Bath, Face, FaceName, HeatMethod, Notch, Radiation, Shape, Solid, SphOperator, SphSettings,
    Stratum, Symmetry,
};

/// Everything from which a solid's model is built.
#[derive(Clone)]
pub struct Plan {
    pub mesh: Mesh,
    /// The layers, from the lowest on; a single one for a body of one material.
    pub strata: Vec<Stratum>,
    /// Constants of the top layer.
    pub constants: Constants,
    /// The law of deformation of each layer, from the lowest on; `None` if mechanics is not modelled.
    pub law: Option<Vec<Thermoelastic>>,
    pub initial_temperature: f64,
    /// Time after a jump from which on the mesh resolves the temperatures of heated faces [s].
    pub resolved_from: f64,
    /// Settings of particles that conduct the heat; `None` if finite elements do.
    pub sph: Option<SphSettings>,
    /// Conditions other than insulation.
    pub thermal_faces: Vec<(MeshFace, ThermalFace)>,
    /// For each thermal face, the face of the body at that place and the one with its image there.
    pub face_sources: Vec<(FaceName, Option<FaceName>)>,
    /// Settings of Newton's method for the heat; `None` if modes or particles advance it.
    pub newton: Option<NewtonPlan>,
    /// True if heat uses linear elements.
    pub linear_heat: bool,
    /// Flow law of each layer of elements along z, from the lowest on; `None` if deformation is linear.
    pub inelastic: Option<Vec<Arc<dyn FlowLaw>>>,
    /// Law of cracks; `None` if nothing cracks.
    pub damage: Option<GradientDamage>,
    /// True if a body that cracks does so in a section of its mesh.
    pub cracks_in_section: bool,
    /// Cracks at time zero.
    pub notches: Vec<Notch>,
    /// Flaws in each layer, from the lowest on.
    pub flaws: Vec<Option<FlawStatistics>>,
    /// Stress-free temperature above the initial one [K].
    pub stress_free_rise: f64,
    pub supports: Vec<(MeshFace, Support)>,
    /// Notes on choices and simplifications, with reasons: one sentence each.
    pub notes: Vec<String>,
}

/// Additional data of a plan for nonlinear heat.
#[derive(Debug, Clone, PartialEq)]
pub struct NewtonPlan {
    /// Material of each layer, from the lowest on.
    pub materials: Vec<Conduction>,
    pub radiation: Vec<(MeshFace, Radiation)>,
    /// A bath, with the faces that it wets.
    pub bath: Option<(Bath, Vec<MeshFace>)>,
    /// Error tolerance of a time step [K].
    pub tolerance: f64,
}

/// Requirements of a scene on a solid's plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanRequest<'a> {
    pub mechanics: Mechanics,
    /// Areas where loads act.
    pub refinements: &'a [Refinement],
    /// True if nothing that acts on the body or on what it touches varies along its surface, but for its own mechanics.
    pub is_uniform: bool,
    /// Shortest time after which results are needed [s].
    pub shortest: f64,
    /// Error tolerance of a time step of nonlinear heat [K]; `None` if heat is linear.
    pub newton: Option<f64>,
    /// Numbers of elements along the surface and through the thickness over the usual ones.
    pub factors: [f64; 2],
    /// True if linear heat uses linear elements.
    pub linear_heat: bool,
}

/// A part of the top or bottom face where a load may act.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Refinement {
    pub x: [f64; 2],
    pub y: [f64; 2],
    pub top: bool,
    /// Length over which the load changes [m].
    pub feature: f64,
    /// True if the load brings heat.
    pub heats: bool,
    /// Distances of sharp edges from the centre if they are constant [m].
    pub edges: [Option<f64>; 2],
}

/// Extent of a solid's mechanics that a scene needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mechanics {
    /// No stress or displacement can be read.
    Absent,
    /// They can be read but are not requested, as for a plate under a droplet.
    Offered,
    /// A probe or field reads them.
    Wanted,
}

impl Mechanics {
    fn note(self) -> Option<&'static str> {
        match self {
            Self::Absent => Some(
                "mechanics is left out: nothing asks for stress or displacement, no load carries \
                 traction, or the material names no elastic constants",
            ),
            Self::Offered => Some(
                "no probe or field gives stress or displacement: what solves for them is made when the \
                 body's highest stress is first read",
            ),
            Self::Wanted => None,
        }
    }
}

impl Plan {
    /// Plans a solid.
    pub fn new(
        solid: &Solid,
        PlanRequest { mechanics, refinements, is_uniform, shortest, newton, factors, linear_heat }: PlanRequest,
    ) -> Self {
        let mut strata = solid.strata();
        strata.reverse();
        let constants = strata[strata.len() - 1].constants;
        let laws: Option<Vec<_>> = strata.iter().map(|layer| layer.constants.law()).collect();
        let wanted = mechanics != Mechanics::Absent;
        let is_inelastic = wanted && !solid.deforms_linearly();
        let cracks = solid.damage();
        let damage = cracks.filter(|_| wanted);
        let law = laws.filter(|_| wanted && !is_inelastic && damage.is_none());
        let mut notes = Vec::new();
        let mirrored =
            mirrored(solid, newton.is_some() || is_inelastic || damage.is_some(), &mut notes);
        let is_column = is_uniform && is_column(solid, wanted);
        let resolution = Resolution { refinements, shortest, factors, is_column };
        let mut notes_on_mesh = Vec::new();
        let fineness = Fineness::choose(solid, &strata, resolution, &mut notes_on_mesh);
        let mesh = match &cracks {
            Some(law) => crack_mesh(solid, mirrored, law.length, factors),
            None => {
                notes.append(&mut notes_on_mesh);
                build_mesh(&solid.shape, mirrored, &fineness)
            }
        };
        let resolved_from = fineness.resolved_from(&mesh);
        notes.extend((strata.len() > 1).then(|| note_on_layers(&mesh, newton.is_none())));
        notes.extend(mechanics.note().map(str::to_owned));
        notes.extend(law.as_ref().and_then(|law| note_on_solver(&mesh, law)));
        if let Some(settings) = solid.sph() {
            notes.push(particle_note(&settings, &mesh));
        }
        let (thermal_faces, face_sources) = thermal_faces(solid, &mesh);
        let supports = supports(solid, &mesh);
        let newton = newton.map(|tolerance| newton_plan(solid, &mesh, tolerance));
        notes.extend(newton.as_ref().map(note_on_newton));
        notes.extend(solid.bath.map(|_| note_on_bath(solid)));
        let inelastic = is_inelastic.then(|| inelastic_laws(solid, &mesh));
        notes.extend(inelastic.as_ref().map(|laws| note_on_history(solid, laws)));
        let in_section = solid.cracks() && !solid.cracks_in_space();
        notes.extend(damage.as_ref().map(|damage| note_on_cracks(damage, &mesh, in_section)));
        let stress_free_rise = solid.temperature_without_stress() - solid.initial_temperature;
        let initial_temperature = solid.initial_temperature;
        Self {
            mesh,
            strata,
            constants,
            law,
            initial_temperature,
            resolved_from,
            sph: solid.sph(),
            thermal_faces,
            face_sources,
            linear_heat: linear_heat || newton.is_some(),
            newton,
            inelastic,
            damage,
            cracks_in_section: in_section,
            notches: solid.notches.clone(),
            flaws: flaws(solid),
            stress_free_rise,
            supports,
            notes,
        }
    }

    /// The constants of the layers, from the lowest on.
    pub fn constants_of_layers(&self) -> Vec<Constants> {
        self.strata.iter().map(|layer| layer.constants).collect()
    }

    /// Largest number of entries of the modes along z of one symmetry class: through layers, each pair of modes along
    /// the surface has its own.
    pub fn entries_of_columns(&self) -> f64 {
        let [nx, ny, nz] = self.mesh.sided_counts().map(|count| count as f64);
        if self.strata.len() > 1 { nx * ny * nz * (nz + 1.0) } else { 0.0 }
    }

    /// Numbers of unknowns of heat and of displacement, reduced by symmetry.
    pub fn unknowns(&self) -> [usize; 2] {
        let nodes = self.mesh.nodes();
        let degrees = self.mesh.geometry.degrees();
        [
            self.mesh.sided_nodes(),
            if self.damage.is_some() {
                let [columns, rows, layers] = self.mesh.node_counts();
                match self.cracks_in_section {
                    true => 2 * columns * layers,
                    false => 3 * columns * rows * layers,
                }
            } else if self.law.is_some() || self.inelastic.is_some() {
                nodes.saturating_mul(degrees)
            } else {
                0
            },
        ]
    }
}

fn note_on_layers(mesh: &Mesh, is_linear: bool) -> String {
    let elements = (0..mesh.layering.count()).rev().map(|layer| mesh.layer_elements(layer).len());
    let elements: Vec<String> = elements.map(|count| count.to_string()).collect();
    let elements = elements.join(", ");
    match is_linear {
        true => format!(
            "layers of {elements} elements from the top; heat passes them exactly in time, by modes through the depth \
             for each pair of modes along the surface"
        ),
        false => format!("layers of {elements} elements from the top"),
    }
}

fn particle_note(settings: &SphSettings, mesh: &Mesh) -> String {
    let operator = match settings.operator {
        SphOperator::Corrected if mesh.axes.iter().all(Axis::is_uniform) => {
            "the corrected operator, which conserves heat to rounding at equal distances"
        }
        SphOperator::Corrected => {
            "the corrected operator, which conserves heat only approximately on a graded mesh: see \
             heat_drift"
        }
        SphOperator::Plain => {
            "the plain operator, which conserves heat but misses the conductivity by a share that \
             no refinement lowers"
        }
    };
    format!(
        "particles on the nodes conduct the heat by {operator}; supports of {} distances",
        settings.support
    )
}

/// Returns the axes along which half the body represents the whole.
fn mirrored(solid: &Solid, is_nonlinear: bool, notes: &mut Vec<String>) -> [bool; 2] {
    if matches!(solid.shape, Shape::Disc(_)) {
        notes.push("axisymmetric: a meridian section stands for the disc".into());
        return [false; 2];
    }
    if solid.symmetry == Symmetry::None {
        notes.push("the whole box is meshed, as the scene asks".into());
        return [false; 2];
    }
    if is_nonlinear && solid.symmetry == Symmetry::Auto {
        notes.push(
            "the whole box is meshed: parts of loads that are odd about a plane do not add up where heat or \
             deformation is not linear (`symmetry = \"quarter\"` for loads that stay even)"
                .into(),
        );
        return [false; 2];
    }
    let pairs = [(FaceName::Left, FaceName::Right, "x"), (FaceName::Front, FaceName::Back, "y")];
    pairs.map(|(low, high, axis)| {
        let alike = alike(&solid.face(low), &solid.face(high));
        notes.push(match alike {
            true => format!(
                "half the box along {axis} is meshed: its two faces have like conditions; loads \
                 split into parts even and odd about {axis} = 0, and odd parts cost nothing until \
                 a load has them"
            ),
            false => format!(
                "the box is meshed whole along {axis}: its two faces have unlike conditions"
            ),
        });
        alike
    })
}

/// Returns true if one element spans a body in which heat does not vary along the surface, with or without mechanics.
fn is_column(solid: &Solid, has_mechanics: bool) -> bool {
    let is_free = |&name: &FaceName| {
        let side = solid.face(name);
        !has_mechanics || side.roller && !side.clamped
    };
    solid.mesh.spacing.is_none() && sides(solid).all(is_free)
}

/// Returns true if heat flows along the thickness alone in a body without loads on parts of faces.
pub fn conducts_along_thickness(solid: &Solid) -> bool {
    let is_insulated = |&name: &FaceName| {
        let side = solid.face(name);
        side.thermal().is_empty() && side.radiation.is_none()
    };
    solid.heat == HeatMethod::Fem && solid.bath.is_none() && sides(solid).all(is_insulated)
}

fn sides(solid: &Solid) -> impl Iterator<Item = &'static FaceName> {
    solid.shape.faces().iter().filter(|face| face.normal() != Some(2))
}

/// Returns true if two faces differ at most in the values of inputs.
fn alike(a: &Face, b: &Face) -> bool {
    a.temperature.is_some() == b.temperature.is_some()
        && a.flux.is_some() == b.flux.is_some()
        && a.convection.map(|c| c.coefficient) == b.convection.map(|c| c.coefficient)
        && a.radiation == b.radiation
        && a.clamped == b.clamped
        && a.roller == b.roller
}

fn build_mesh(shape: &Shape, mirrored: [bool; 2], fineness: &Fineness) -> Mesh {
    let order = fineness.order;
    let uniform = |ends: Vec<f64>| Axis::from_element_ends(&ends, order, Weight::Uniform);
    let (ends, layering) = fineness.depth();
    let height = uniform(ends);
    match *shape {
        Shape::Box([lx, ly, _]) => {
            let along = |axis: usize, half: f64| {
                let start = if mirrored[axis] { 0.0 } else { -half };
                uniform(fineness.lateral_ends(axis, [start, half]))
            };
            let axes = [along(0, lx / 2.0), along(1, ly / 2.0), height];
            Mesh { axes, mirrored, geometry: Geometry::Box, layering }
        }
        Shape::Disc(disc) => {
            let ends = fineness.lateral_ends(0, [0.0, disc.radius]);
            let radii = Axis::from_element_ends(&ends, order, Weight::Radial);
            let geometry = Geometry::Axisymmetric;
            Mesh { axes: [radii, Axis::point(), height], mirrored, geometry, layering }
        }
    }
}

type ThermalFaces = (Vec<(MeshFace, ThermalFace)>, Vec<(FaceName, Option<FaceName>)>);

fn thermal_faces(solid: &Solid, mesh: &Mesh) -> ThermalFaces {
    let mut faces: Vec<(MeshFace, ThermalFace)> = Vec::new();
    let mut sources: Vec<(FaceName, Option<FaceName>)> = Vec::new();
    for &name in solid.shape.faces() {
        let Some(condition) = thermal_condition(&solid.face(name)) else { continue };
        let (place, image) = mesh.place(name);
        // The meshed face of a mirrored axis is always listed: its conditions equal those of the image.
        if image {
            continue;
        }
        faces.push((place, condition));
        sources.push((name, opposite(name).filter(|&other| mesh.place(other) == (place, true))));
    }
    (faces, sources)
}

/// Returns the opposite face of the box.
fn opposite(face: FaceName) -> Option<FaceName> {
    match face {
        FaceName::Right => Some(FaceName::Left),
        FaceName::Back => Some(FaceName::Front),
        _ => None,
    }
}

fn thermal_condition(face: &Face) -> Option<ThermalFace> {
    if face.temperature.is_some() {
        Some(ThermalFace::Prescribed)
    } else if let Some(convection) = face.convection {
        Some(ThermalFace::Convective(convection.coefficient))
    } else {
        face.flux.map(|_| ThermalFace::Flux)
    }
}

fn newton_plan(solid: &Solid, mesh: &Mesh, tolerance: f64) -> NewtonPlan {
    let mut materials: Vec<Conduction> =
        solid.materials_of_layers().iter().map(|own| own.heat.clone()).collect();
    materials.reverse();
    let radiating = solid.shape.faces().iter().filter_map(|&name| {
        let radiation = solid.face(name).radiation?;
        let (place, image) = mesh.place(name);
        (!image).then_some((place, radiation))
    });
    let wetted = || {
        let places = solid.wetted_faces().into_iter().map(|name| mesh.place(name));
        places.filter(|(_, image)| !image).map(|(place, _)| place).collect()
    };
    let bath = solid.bath.map(|bath| (bath, wetted()));
    NewtonPlan { materials, radiation: radiating.collect(), bath, tolerance }
}

/// Note on cracks.
fn note_on_cracks(law: &GradientDamage, mesh: &Mesh, in_section: bool) -> String {
    let spacing = [0, 2].map(|axis| mesh.axes[axis].end_distance(true));
    let cost = match in_section {
        true => "",
        false => {
            "; a step takes a fifth of the forecast where nothing cracks, and up to thirty times that where a network forms"
        }
    };
    format!(
        "cracks are damage over a length of {:.3e} m, with {:.3e} J/m² and a strength of {:.3e} Pa; nodes are {:.3e} m \
         apart along the surface and {:.3e} m through the thickness; heat passes cracks as if they were closed{cost}",
        law.length,
        law.energy,
        law.strength(),
        spacing[0],
        spacing[1]
    )
}

/// Note on history-dependent stress.
fn note_on_history(solid: &Solid, laws: &[Arc<dyn FlowLaw>]) -> String {
    if !laws.iter().any(|law| law.relaxation().is_some()) {
        return "stress depends on what the body went through: equilibrium is found at the end of every communication step, \
                between which each place deforms straight on"
            .to_owned();
    }
    let order = if solid.only_relaxes() { "fourth" } else { "second" };
    format!(
        "moduli relax by a generalised Maxwell model, exactly where strain and temperature change linearly over a \
         communication step; otherwise it is halved, by a method of {order} order, until strain errs by a tenth of \
         `fidelity.tolerance`"
    )
}

fn inelastic_laws(solid: &Solid, mesh: &Mesh) -> Vec<Arc<dyn FlowLaw>> {
    let mut materials = solid.materials_of_layers();
    materials.reverse();
    let stress_free = solid.temperature_without_stress();
    let laws: Vec<Arc<dyn FlowLaw>> =
        materials.iter().map(|own| own.flow_law(stress_free)).collect();
    let elements = mesh.axes[2].elements();
    (0..elements).map(|element| laws[mesh.layering.layer_of(element)].clone()).collect()
}

/// Flaws in each layer, from the lowest on.
fn flaws(solid: &Solid) -> Vec<Option<FlawStatistics>> {
    let materials = solid.materials_of_layers().into_iter().rev();
    materials.map(|own| own.fracture.weibull.map(|weibull| weibull.statistics())).collect()
}

/// Note on what a bath wets. Through the thickness of a section in plane stress temperatures are even, as they are in a
/// plate of small Biot number.
fn note_on_bath(solid: &Solid) -> String {
    let faces: Vec<&str> = solid.wetted_faces().into_iter().map(FaceName::as_str).collect();
    let faces = faces.join(", ");
    let wets = format!("the bath wets what is below its surface of the faces {faces}");
    let Some(biot) = solid.biot_in_bath() else { return wets };
    let verdict = if biot <= Solid::THIN { "which holds" } else { "which does not hold" };
    format!(
        "{wets}; the temperature is taken as even through the thickness of the section, {verdict}: its Biot number is \
         {biot:.2e}, with which its middle and surfaces differ by {} of the difference to the bath",
        percent(unevenness(biot))
    )
}

fn note_on_newton(NewtonPlan { tolerance, bath, .. }: &NewtonPlan) -> String {
    let what = if bath.is_some() { "a bath moves: heat" } else { "heat is not linear: it" };
    format!(
        "{what} advances in inner steps of which each errs by {tolerance:.1e} K at most \
         (`fidelity.tolerance` times 10 K), and balances whatever these leave"
    )
}

fn supports(solid: &Solid, mesh: &Mesh) -> Vec<(MeshFace, Support)> {
    let mut supports = Vec::new();
    for &name in solid.shape.faces() {
        let face = solid.face(name);
        let support = match (face.clamped, face.roller) {
            (true, _) => Support::Clamped,
            (false, true) => Support::Roller,
            _ => continue,
        };
        let (place, image) = mesh.place(name);
        if !image {
            supports.push((place, support));
        }
    }
    supports
}
