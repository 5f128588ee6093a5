//! A face through which a solid exchanges heat and force with another body.

use super::SolidBody;
use super::loads::add;
use super::memo::SolidMemo;
use crate::body::{Acts, BodyError, Conductor, Given, Memo};
use crate::coupling::TopFace;
use crate::math::allowance::Allowance;
use crate::method::fem::{Geometry, Plan, SolidFem, SolidLoads, Temperatures};
use crate::method::sph::{Surface, SurfaceResponse, WallCells};

/// The number of the top among a solid's ports.
pub const TOP: usize = 0;

/// How a face takes what comes through its cells, and how it answers.
pub struct Port {
    face: TopFace,
    response: SurfaceResponse,
    initial_temperature: f64,
    geometry: Geometry,
}

impl Port {
    pub fn top(plan: &Plan, solid: &SolidFem) -> Self {
        let [rates, gains] = solid.top_modes();
        Self {
            face: TopFace::of(&plan.mesh, plan.sph.is_some()),
            response: SurfaceResponse { rates, gains },
            initial_temperature: plan.initial_temperature,
            geometry: plan.mesh.geometry,
        }
    }

    /// Temperature of each cell [K].
    fn at_cells(&self, temperatures: &Temperatures) -> Vec<f64> {
        let rise = self.face.rise(temperatures);
        rise.into_iter().map(|rise| self.initial_temperature + rise).collect()
    }

    /// The face over a step between these temperatures at its beginning and, if nothing is given, at its end.
    ///
    /// Every place answers as the whole face would that is heated as it is: during a step heat hardly passes
    /// along the surface. How far the solid itself goes in the step is exact, as drift about these modes.
    fn surface(
        &self,
        solid: &SolidFem,
        [start, end]: [&Temperatures; 2],
        duration: f64,
    ) -> Surface {
        let response = self.response.clone();
        let count = response.len();
        let amplitudes = self.face.parts(&solid.top_amplitudes(start), count);
        let rest = |(t, parts): (f64, &[f64])| t - parts.iter().sum::<f64>();
        let cells = self.at_cells(start).into_iter().zip(amplitudes.chunks_exact(count));
        let base = cells.map(rest).collect();
        let end = self.at_cells(end);
        let mut surface = Surface { response, base, amplitudes, drift: vec![0.0; end.len()] };
        let free = surface.free(1.0, duration);
        surface.drift = end.iter().zip(free).map(|(end, free)| end - free).collect();
        surface
    }

    /// Adds what was given during a step, as rates, to what acts.
    pub fn add(&self, loads: &mut SolidLoads, given: &Given) {
        if given.duration <= 0.0 {
            return;
        }
        let rate = 1.0 / given.duration;
        self.add_heat(loads, given);
        if given.impulse.is_empty() {
            return;
        }
        for (component, axis, flips) in self.directions() {
            let force: Vec<f64> = given.impulse.iter().map(|p| p[axis] * rate).collect();
            for (class, vector) in self.parts_of(&force, flips, given) {
                add(&mut loads.force[class][1][component], &vector, 1.0);
            }
        }
    }

    /// Adds the heat of a step, as it was given in its course, to what acts and its derivatives.
    pub fn add_over_step(&self, derivatives: &mut [SolidLoads], given: &Given) {
        if given.duration <= 0.0 {
            return;
        }
        self.add_heat(&mut derivatives[0], given);
        let slope = -2.0 / given.duration;
        for (class, vector) in self.parts_of(&given.falling, [false; 2], given) {
            add(&mut derivatives[0].heat[class][1], &vector, 1.0);
            add(&mut derivatives[1].heat[class][1], &vector, slope);
        }
    }

    fn add_heat(&self, loads: &mut SolidLoads, given: &Given) {
        let rate = 1.0 / given.duration;
        let heat: Vec<f64> = given.heat.iter().map(|heat| heat * rate).collect();
        for (class, vector) in self.parts_of(&heat, [false; 2], given) {
            add(&mut loads.heat[class][1], &vector, 1.0);
        }
    }

    /// Nodal vectors of an amount at each cell, one a symmetry class; nothing of no amounts.
    fn parts_of(
        &self,
        amounts: &[f64],
        flips: [bool; 2],
        given: &Given,
    ) -> impl Iterator<Item = (usize, Vec<f64>)> + use<> {
        let vectors = match amounts.is_empty() {
            true => Vec::new(),
            false => self.face.nodal(amounts, flips, given.symmetric),
        };
        vectors.into_iter().enumerate()
    }

    /// Displacement component of the solid, component of the impulse, and where mirrors turn it.
    fn directions(&self) -> Vec<(usize, usize, [bool; 2])> {
        match self.geometry {
            Geometry::Box => {
                vec![(0, 0, [true, false]), (1, 1, [false, true]), (2, 2, [false; 2])]
            }
            Geometry::Axisymmetric => vec![(0, 0, [true, false]), (1, 2, [false; 2])],
        }
    }
}

impl Conductor for SolidBody {
    fn cells(&self, _: usize) -> WallCells {
        self.top.face.cells()
    }

    fn surfaces(
        &self,
        state: &[f64],
        memo: &Memo,
        ports: &[usize],
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Vec<Surface>, BodyError> {
        let mut later = state.to_vec();
        self.advance_here(&mut later, SolidMemo::of(memo), acts, allowance)?;
        let temperatures = |state: &[f64], s: f64| match acts.path.is_held() {
            true => self.solid.temperatures(state, SolidMemo::of(memo).outside()),
            false => {
                let loads = self.loads.of_faces(&acts.path.at(0, s), self.solid.mesh());
                self.solid.temperatures(state, &loads)
            }
        };
        let [start, end] = [temperatures(state, 0.0), temperatures(&later, acts.duration)];
        let surface = |_: &usize| self.top.surface(&self.solid, [&start, &end], acts.duration);
        Ok(ports.iter().map(surface).collect())
    }
}
