//! Smoothed particles on the nodes.

use super::{Heat, HeatFailure};
use crate::method::fem::heat::{HeatLoads, ThermalFace};
use crate::method::fem::plan::Plan;
use crate::method::heat_totals::HeatTotals;
use crate::method::mesh::{Geometry, Mesh};
use crate::method::particle_heat::{
    Condition, Cost, End, Face, LatticeAxis, Operator, ParticleHeat, Settings, Setup, Sources,
};
use crate::runtime::allowance::Allowance;
use crate::scene::{SphOperator, SphSettings};
use crate::state::Layout;

impl Heat for ParticleHeat {
    fn layout(&self) -> Layout {
        self.layout()
    }

    fn advance(
        &self,
        state: &mut [f64],
        loads: &[HeatLoads],
        dt: f64,
        allowance: &Allowance,
    ) -> Result<(), HeatFailure> {
        let sources: Vec<Sources> = loads.iter().map(sources).collect();
        Ok(self.advance(state, &sources, dt, allowance)?)
    }

    fn nodal(&self, state: &[f64], faces: &[Vec<f64>]) -> Vec<Vec<f64>> {
        self.temperatures(state, faces)
    }

    fn stored(&self, state: &[f64]) -> f64 {
        self.stored(state)
    }

    fn totals(&self, state: &[f64]) -> HeatTotals {
        self.totals(state)
    }

    fn rates(&self, state: &[f64], loads: &HeatLoads, rates: &HeatLoads) -> Option<Vec<f64>> {
        Some(self.rates(state, &sources(loads), &sources(rates)))
    }

    fn fallback(&self) -> Option<usize> {
        Some(self.fallback())
    }
}

fn sources<'a>(loads: &HeatLoads<'a>) -> Sources<'a> {
    Sources { surface: loads.surface, faces: loads.faces }
}

/// Cost of the particles of a plan; `None` if finite elements conduct the heat.
pub fn particle_cost(plan: &Plan) -> Option<Cost> {
    setup(plan).map(|setup| ParticleHeat::cost(&setup))
}

/// The particles of a plan.
pub fn setup(plan: &Plan) -> Option<Setup> {
    let SphSettings { operator, kernel, support } = plan.sph?;
    let operator = match operator {
        SphOperator::Corrected => Operator::Corrected,
        SphOperator::Plain => Operator::Plain,
    };
    let condition = |condition: ThermalFace| match condition {
        ThermalFace::Flux => Condition::Flux,
        ThermalFace::Prescribed => Condition::Held,
        ThermalFace::Convective(coefficient) => Condition::Convective(coefficient),
    };
    let faces = plan.thermal_faces.iter().map(|&(face, kind)| Face {
        axis: face.axis,
        high: face.high,
        condition: condition(kind),
    });
    Some(Setup {
        axes: [0, 1, 2].map(|a| lattice_axis(&plan.mesh, a)),
        settings: Settings { operator, kernel, support },
        capacity: plan.constants.heat_capacity(),
        conductivity: plan.constants.conductivity,
        faces: faces.collect(),
        classes: plan.mesh.parities().into_iter().map(|parity| parity.odd).collect(),
        copies: plan.mesh.copies(),
    })
}

fn lattice_axis(mesh: &Mesh, axis: usize) -> LatticeAxis {
    LatticeAxis {
        nodes: mesh.axes[axis].nodes.clone(),
        measures: mesh.axes[axis].integrals(),
        ends: [End::Mirror; 2],
        radial: axis == 0 && mesh.geometry == Geometry::Axisymmetric,
    }
}
