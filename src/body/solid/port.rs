//! A face through which a solid exchanges heat and force with another body.

use std::borrow::Cow;

use super::SolidBody;
use super::loads::add;
use super::memo::SolidMemo;
use crate::body::{Acts, BodyError, Conductor, Given, Memo};
use crate::coupling::{FaceCells, FaceRings, Transfer};
use crate::inputs::InputPath;
use crate::method::fem::{Plan, SolidFem, SolidLoads, heat_mesh};
use crate::port::{Surface, SurfaceResponse, WallCells};
use crate::runtime::allowance::Allowance;
use crate::scene::FaceName;

/// Transfer through the cells of a face, and response of the face.
pub struct Port {
    pub face: FaceName,
    transfer: Box<dyn Transfer>,
    response: SurfaceResponse,
    initial_temperature: f64,
}

impl Port {
    /// `face` is the top or the bottom; `meets_rings` is set for a box below axisymmetric drops.
    pub fn new(face: FaceName, plan: &Plan, solid: &SolidFem, meets_rings: bool) -> Self {
        let high = face == FaceName::Top;
        // Each node has a volume of its own.
        let has_volumes = plan.sph.is_some() || plan.newton.is_some();
        let [rates, gains] = solid.end_modes(high);
        Self {
            face,
            transfer: match meets_rings {
                true => Box::new(FaceRings::of(&heat_mesh(plan), has_volumes)),
                false => Box::new(FaceCells::of(&heat_mesh(plan), has_volumes)),
            },
            response: SurfaceResponse { rates, gains },
            initial_temperature: plan.initial_temperature,
        }
    }

    /// End of the axis z, as a place in lists.
    fn side(&self) -> usize {
        usize::from(self.face == FaceName::Top)
    }

    /// Temperature of each cell [K] in a state under these loads.
    fn temperatures(&self, solid: &SolidFem, state: &[f64], loads: &SolidLoads) -> Vec<f64> {
        let planes = solid.end_rise(state, loads, self.side() == 1);
        let rise = self.transfer.at_cells(&planes, 1);
        rise.into_iter().map(|rise| self.initial_temperature + rise).collect()
    }

    /// Returns the face over a step between two states without received heat; loads act at both.
    ///
    /// Every place responds as the whole face would under uniform heating, because heat hardly spreads along the
    /// surface during a step. The solid's own change in the step is exact, as drift about these modes.
    fn surface(
        &self,
        solid: &SolidFem,
        start: (&[f64], &SolidLoads),
        end: (&[f64], &SolidLoads),
        duration: f64,
    ) -> Surface {
        let response = self.response.clone();
        let planes = solid.end_parts(start.0, start.1, self.side() == 1);
        let parts = self.transfer.at_cells(&planes, 1 + response.len());
        let (mut base, mut amplitudes) = (Vec::new(), Vec::new());
        for cell in parts.chunks_exact(1 + response.len()) {
            let (rise, modes) = (cell[0], &cell[1..]);
            base.push(self.initial_temperature + rise - modes.iter().sum::<f64>());
            amplitudes.extend_from_slice(modes);
        }
        let end = self.temperatures(solid, end.0, end.1);
        let mut surface = Surface { response, base, amplitudes, drift: vec![0.0; end.len()] };
        let free = surface.free(1.0, duration);
        surface.drift = end.iter().zip(free).map(|(end, free)| end - free).collect();
        surface
    }

    /// Adds the amounts received during a step, as rates, to the loads.
    pub fn add(&self, loads: &mut SolidLoads, given: &Given) {
        if given.duration <= 0.0 {
            return;
        }
        let (rate, side) = (1.0 / given.duration, self.side());
        self.add_heat(loads, given);
        if given.impulse.is_empty() {
            return;
        }
        let along = |axis: usize| -> Vec<f64> {
            given.impulse.iter().map(|impulse| impulse[axis] * rate).collect()
        };
        for (component, vectors) in self.transfer.forces(&along, given.symmetric) {
            for (class, vector) in vectors.into_iter().enumerate() {
                add(&mut loads.force[class][side][component], &vector, 1.0);
            }
        }
    }

    /// Adds the heat of a step, as it was transferred over time, to the loads and their derivatives at a time [s] after
    /// the beginning of the transfer.
    pub fn add_over_step(&self, derivatives: &mut [SolidLoads], given: &Given, after: f64) {
        if given.duration <= 0.0 {
            return;
        }
        self.add_heat(&mut derivatives[0], given);
        let (slope, side) = (-2.0 / given.duration, self.side());
        for (class, vector) in self.heat_of(&given.falling, given) {
            add(&mut derivatives[0].heat[class][side], &vector, 1.0 + slope * after);
            add(&mut derivatives[1].heat[class][side], &vector, slope);
        }
    }

    fn add_heat(&self, loads: &mut SolidLoads, given: &Given) {
        let (rate, side) = (1.0 / given.duration, self.side());
        let heat: Vec<f64> = given.heat.iter().map(|heat| heat * rate).collect();
        for (class, vector) in self.heat_of(&heat, given) {
            add(&mut loads.heat[class][side], &vector, 1.0);
        }
    }

    /// Nodal vectors of heat at each cell, one for each symmetry class; empty if all amounts are zero.
    fn heat_of(
        &self,
        amounts: &[f64],
        given: &Given,
    ) -> impl Iterator<Item = (usize, Vec<f64>)> + use<> {
        let vectors = match amounts.is_empty() {
            true => Vec::new(),
            false => self.transfer.heat(amounts, given.symmetric),
        };
        vectors.into_iter().enumerate()
    }
}

impl SolidBody {
    /// The port on a face that is linked.
    pub(super) fn port(&self, face: FaceName) -> &Port {
        let known = self.ports.iter().find(|port| port.face == face);
        known.expect("a body has a port on every face that is linked")
    }

    /// Loads on faces at a time after the beginning of a step.
    fn face_loads<'m>(&self, memo: &'m Memo, path: &InputPath, s: f64) -> Cow<'m, SolidLoads> {
        match path.is_held() {
            true => Cow::Borrowed(SolidMemo::of(memo).outside()),
            false => Cow::Owned(self.loads.of_faces(&path.at(0, s), self.solid.mesh())),
        }
    }
}

impl Conductor for SolidBody {
    fn response(&self, face: FaceName, _: f64) -> SurfaceResponse {
        self.port(face).response.clone()
    }

    fn diffusivity(&self, face: FaceName) -> f64 {
        let strata = &self.plan.strata;
        let layer = if face == FaceName::Top { strata.last() } else { strata.first() };
        layer.map_or(0.0, |layer| layer.constants.diffusivity())
    }

    fn tolerance(&self) -> f64 {
        self.solid.tolerance()
    }

    fn cells(&self, face: FaceName) -> Option<WallCells> {
        Some(self.port(face).transfer.cells())
    }

    fn surfaces(
        &self,
        state: &[f64],
        memo: &Memo,
        faces: &[FaceName],
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Vec<Surface>, BodyError> {
        let state = self.heat_of(state);
        let mut later = state.to_vec();
        self.advance_here(&mut later, SolidMemo::of(memo), acts, allowance)?;
        let loads = [0.0, acts.duration].map(|s| self.face_loads(memo, acts.path, s));
        let (start, end) = ((state, &*loads[0]), (&*later, &*loads[1]));
        let surface =
            |&face: &FaceName| self.port(face).surface(&self.solid, start, end, acts.duration);
        Ok(faces.iter().map(surface).collect())
    }

    fn temperatures_after(
        &self,
        state: &[f64],
        memo: &Memo,
        faces: &[FaceName],
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Vec<Vec<f64>>, BodyError> {
        let state = self.heat_of(state);
        let mut later = state.to_vec();
        if acts.duration > 0.0 {
            self.advance_here(&mut later, SolidMemo::of(memo), acts, allowance)?;
        }
        let loads = self.face_loads(memo, acts.path, acts.duration);
        let at_cells = |&face: &FaceName| self.port(face).temperatures(&self.solid, &later, &loads);
        Ok(faces.iter().map(at_cells).collect())
    }
}
