//! Nonlinear heat of a solid's plan: enthalpies on the nodes of its mesh.

use std::f64::consts::TAU;

use super::heat::{HeatLoads, ThermalFace};
use super::plan::{NewtonPlan, Plan};
use crate::method::enthalpy::{
    Condition, Contact, EnthalpyHeat, Face, Failure, Loads, Setup, linear_mesh,
};
use crate::method::heat_totals::HeatTotals;
use crate::method::mesh::Mesh;
use crate::runtime::allowance::Allowance;
use crate::scene::Bath;
use crate::state::{Field, Layout, Per};

/// Enthalpy method behind the interface of a solid's heat: temperatures above the initial one, with nodes on interfaces
/// between layers listed twice. Parts that are odd about a plane of symmetry are refused.
pub struct NonlinearHeat {
    heat: EnthalpyHeat,
    initial_temperature: f64,
    /// Conditions of the plan's thermal faces.
    faces: Vec<ThermalFace>,
    /// Ambient temperatures of radiating faces [K].
    ambients: Vec<f64>,
    /// Speed at which the surface of a bath rises along the body [m/s], and its height at time zero, along z [m].
    bath: Option<[f64; 2]>,
    /// Number of faces that the bath wets.
    wetted: usize,
    /// Error tolerance of a time step [K].
    tolerance: f64,
    /// Level of the heat's own mesh for each level along z of the mesh with doubled interfaces.
    levels: Vec<usize>,
    /// Number of nodes of a level.
    plane: usize,
    classes: usize,
}

/// Reasons why nonlinear heat did not advance.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NonlinearFailure {
    #[error(transparent)]
    Heat(#[from] Failure),
    #[error(
        "loads are not even about the planes of symmetry, which heat that is not linear needs (allowed: loads that are, or \
         `symmetry = \"none\"`)"
    )]
    Uneven,
}

impl NonlinearHeat {
    pub fn new(plan: &Plan, newton: &NewtonPlan) -> Self {
        let faces: Vec<ThermalFace> = plan.thermal_faces.iter().map(|(_, kind)| *kind).collect();
        let heat = EnthalpyHeat::new(&setup(plan, newton));
        Self {
            heat: heat
                .unwrap_or_else(|error| panic!("a checked scene has nonlinear heat: {error}")),
            initial_temperature: plan.initial_temperature,
            faces,
            ambients: newton.radiation.iter().map(|(_, radiation)| radiation.ambient).collect(),
            bath: newton
                .bath
                .as_ref()
                .map(|(bath, _)| [bath.speed, plan.mesh.axes[2].start() + bath.depth]),
            wetted: newton.bath.as_ref().map_or(0, |(_, faces)| faces.len()),
            tolerance: newton.tolerance,
            levels: levels(&plan.mesh),
            plane: plan.mesh.axes[0].len() * plan.mesh.axes[1].len(),
            classes: plan.mesh.parities().len(),
        }
    }

    /// The fields of a state, see [`EnthalpyHeat`].
    pub fn layout(&self) -> Layout {
        let body = |name, words| Field { name, words, per: Per::Body, width: 1 };
        let words = "enthalpy per volume above that of the solid at time zero [J/m³]";
        let enthalpy = Field { name: "enthalpy", words, per: Per::Node, width: 1 };
        let layout = Layout::default()
            .with(enthalpy, self.heat.nodes())
            .with(body("inner_step", "length of the next inner step [s]"), 1)
            .with(body("inner_steps", "inner steps made since time zero"), 1)
            .with(body("initial_heat", "heat at time zero above the reference [J]"), 1);
        let layout = HeatTotals::at_end_of(layout);
        match self.bath {
            Some(_) => layout.with(body("surface", "height of the bath's surface, along z [m]"), 1),
            None => layout,
        }
    }

    pub fn initial_state(&self) -> Vec<f64> {
        let mut state = self.heat.initial_state(self.initial_temperature);
        state.extend(self.bath.map(|[_, surface]| surface));
        state
    }

    /// The part of a state that holds the enthalpies.
    fn of_enthalpy<'s>(&self, state: &'s [f64]) -> &'s [f64] {
        &state[..self.heat.state_len()]
    }

    /// Error tolerance of a time step [K].
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    pub fn advance(
        &self,
        state: &mut [f64],
        loads: &[HeatLoads],
        dt: f64,
        allowance: &Allowance,
    ) -> Result<(), NonlinearFailure> {
        let is_zero = |list: &Vec<f64>| list.iter().all(|&value| value == 0.0);
        for load in loads {
            let mut odd = load.surface.iter().skip(1).flatten().chain(load.faces.iter().skip(1));
            if !odd.all(is_zero) {
                return Err(NonlinearFailure::Uneven);
            }
        }
        let (state, surface) = state.split_at_mut(self.heat.state_len());
        let none = [Vec::new(), Vec::new()];
        // A bath moves even where loads are constant.
        let orders = loads.len().max(if self.bath.is_some() { 2 } else { 0 });
        let values: Vec<Vec<f64>> = (0..orders)
            .map(|k| {
                let mut values = match loads.get(k) {
                    Some(load) => self.values(k, load.faces),
                    None => vec![0.0; self.faces.len() + self.ambients.len()],
                };
                values.extend(std::iter::repeat_n(self.surface(k, surface), self.wetted));
                values
            })
            .collect();
        let surfaces = (0..orders).map(|k| loads.get(k).map_or(&none, |load| &load.surface[0]));
        let loads: Vec<Loads> =
            surfaces.zip(&values).map(|(surface, faces)| Loads { surface, faces }).collect();
        self.heat.advance(state, &loads, dt, self.tolerance, allowance)?;
        if let (Some([speed, _]), [surface]) = (self.bath, surface) {
            *surface += speed * dt;
        }
        Ok(())
    }

    /// Height of the surface of the bath, or a time derivative of it.
    fn surface(&self, derivative: usize, surface: &[f64]) -> f64 {
        match (self.bath, derivative, surface) {
            (Some(_), 0, [surface]) => *surface,
            (Some([speed, _]), 1, _) => speed,
            _ => 0.0,
        }
    }

    /// Values of all faces, or a time derivative of them; temperatures are absolute.
    fn values(&self, derivative: usize, faces: &[Vec<f64>]) -> Vec<f64> {
        let is_value = if derivative == 0 { 1.0 } else { 0.0 };
        let base = |kind: &ThermalFace| match kind {
            ThermalFace::Flux => 0.0,
            ThermalFace::Prescribed | ThermalFace::Convective(_) => {
                is_value * self.initial_temperature
            }
        };
        let own = faces[0].iter().zip(&self.faces).map(|(value, kind)| value + base(kind));
        own.chain(self.ambients.iter().map(|ambient| is_value * ambient)).collect()
    }

    /// Temperature above the initial one at all nodes, class by class [K].
    pub fn nodal(&self, state: &[f64]) -> Vec<Vec<f64>> {
        let temperatures = self.heat.temperatures(self.of_enthalpy(state));
        let level = |&level: &usize| &temperatures[level * self.plane..(level + 1) * self.plane];
        let rises = self.levels.iter().flat_map(level).map(|t| t - self.initial_temperature);
        let mut classes = vec![Vec::new(); self.classes];
        classes[0] = rises.collect();
        classes
    }

    pub fn stored(&self, state: &[f64]) -> f64 {
        self.heat.stored(self.of_enthalpy(state))
    }

    pub fn totals(&self, state: &[f64]) -> HeatTotals {
        self.heat.totals(self.of_enthalpy(state))
    }

    /// Liquid volume [m³].
    pub fn liquid_volume(&self, state: &[f64], copies: f64) -> f64 {
        let of_nodes = self.heat.liquid(self.of_enthalpy(state));
        copies * of_nodes.iter().map(|[volume, fraction]| volume * fraction).sum::<f64>()
    }

    /// Approximate scatter of the liquid volume about the exact value as fronts move from node to node [m³].
    ///
    /// A melting node keeps the melting temperature whatever its liquid fraction, so the gradient at a front does not
    /// depend on the front's position within the node. Compared with Neumann's front (Carslaw & Jaeger 1959, § 11.2)
    /// the error is 0.05 to 0.25 of a node's volume, at Stefan numbers of 0.05 to 5. A front that waits between two nodes
    /// until the solid one is warm errs by 0.1 to 0.4. Errors of nodes that melt at different times cancel: with
    /// fractions f, `|Σ V e^{2πif}|` is the coherent part. In a body at its melting point, rounding melts traces
    /// everywhere, which are no front.
    pub fn liquid_scatter(&self, state: &[f64], copies: f64) -> f64 {
        let of_nodes = self.heat.liquid(self.of_enthalpy(state));
        let melting = of_nodes.iter().filter(|[_, part]| *part > TRACE && *part < 1.0 - TRACE);
        let sum = melting.fold([0.0; 2], |[re, im], [volume, fraction]| {
            let (sin, cos) = (TAU * fraction).sin_cos();
            [re + SCATTER * volume * cos, im + SCATTER * volume * sin]
        });
        let is_molten = |[_, fraction]: [f64; 2]| fraction >= 1.0 - TRACE;
        let is_solid = |[volume, fraction]: [f64; 2]| volume > 0.0 && fraction <= TRACE;
        let waits = |pair: [usize; 2]| {
            let [one, other] = pair.map(|node| of_nodes[node]);
            match (is_solid(one) && is_molten(other), is_molten(one) && is_solid(other)) {
                (true, _) => one[0],
                (_, true) => other[0],
                _ => 0.0,
            }
        };
        let waiting: f64 = self.heat.neighbours_along_z().map(waits).sum();
        copies * (sum[0] + WAITING * waiting).hypot(sum[1])
    }
}

/// Typical errors of the liquid volume of a melting node, and of one before which a front waits, as shares of its
/// volume.
const SCATTER: f64 = 0.1;
const WAITING: f64 = 0.25;

/// Liquid fraction below which a node counts as solid, and above whose complement it counts as liquid.
const TRACE: f64 = 1e-2;

/// Returns the mesh on which heat enters the nodes.
pub fn heat_mesh(plan: &Plan) -> Mesh {
    if plan.linear_heat { linear_mesh(&plan.mesh) } else { plan.mesh.clone() }
}

fn setup(plan: &Plan, newton: &NewtonPlan) -> Setup {
    let layering = &plan.mesh.layering;
    let elements = plan.mesh.axes[2].elements();
    let contact = |layer: usize| {
        let resistance = layering.resistance_above(layer);
        let below = layering.elements(layer, elements).end;
        (resistance > 0.0).then(|| Contact { below, conductance: 1.0 / resistance })
    };
    let own = plan.thermal_faces.iter().map(|&(place, kind)| Face {
        place,
        condition: match kind {
            ThermalFace::Flux => Condition::Flux,
            ThermalFace::Prescribed => Condition::Prescribed,
            ThermalFace::Convective(coefficient) => Condition::Convective(coefficient),
        },
    });
    let radiating = newton.radiation.iter().map(|&(place, radiation)| Face {
        place,
        condition: Condition::Radiative(radiation.emissivity),
    });
    let wetted = newton.bath.iter().flat_map(|(bath, faces)| {
        let Bath { coefficient, ambient, .. } = *bath;
        let condition = Condition::Wetted { coefficient, ambient };
        faces.iter().map(move |&place| Face { place, condition })
    });
    Setup {
        mesh: plan.mesh.clone(),
        reference: plan.initial_temperature,
        materials: newton.materials.clone(),
        layers: (0..elements).map(|element| layering.layer_of(element)).collect(),
        contacts: (0..layering.interfaces()).filter_map(contact).collect(),
        faces: own.chain(radiating).chain(wetted).collect(),
    }
}

/// Maps levels with doubled interfaces to those of the heat, which are doubled at resistive contacts alone.
fn levels(mesh: &Mesh) -> Vec<usize> {
    let resists = |layer: &usize| mesh.layering.resistance_above(*layer) > 0.0;
    let of_layer = |layer: usize| {
        let contacts = (0..layer).filter(resists).count();
        let elements = mesh.layer_elements(layer);
        let order = mesh.order();
        (elements.start * order..=elements.end * order).map(move |node| node + contacts)
    };
    (0..mesh.layering.count()).flat_map(of_layer).collect()
}
