//! A face through which a solid exchanges heat and force with another body.

use super::SolidBody;
use super::loads::add;
use super::memo::SolidMemo;
use crate::body::{Acts, BodyError, Conductor, Given, Memo};
use crate::coupling::{FaceCells, FaceRings};
use crate::inputs::InputPath;
use crate::method::fem::{Geometry, Plan, SolidFem, SolidLoads, Temperatures, heat_mesh};
use crate::port::{Surface, SurfaceResponse, WallCells};
use crate::runtime::allowance::Allowance;
use crate::scene::FaceName;

/// How a face takes what comes through its cells, and how it answers.
pub struct Port {
    pub face: FaceName,
    cells: Cells,
    response: SurfaceResponse,
    initial_temperature: f64,
    geometry: Geometry,
}

impl Port {
    /// Of the top or the bottom; `meets_rings` of a box on which axisymmetric drops stand.
    pub fn new(face: FaceName, plan: &Plan, solid: &SolidFem, meets_rings: bool) -> Self {
        let high = face == FaceName::Top;
        // Each node has a volume of its own.
        let has_volumes = plan.sph.is_some() || plan.newton.is_some();
        let [rates, gains] = solid.end_modes(high);
        Self {
            face,
            cells: match meets_rings {
                true => Cells::Rings(FaceRings::of(&heat_mesh(plan), high, has_volumes)),
                false => Cells::Face(FaceCells::of(&heat_mesh(plan), high, has_volumes)),
            },
            response: SurfaceResponse { rates, gains },
            initial_temperature: plan.initial_temperature,
            geometry: plan.mesh.geometry,
        }
    }

    /// The end of the axis z, as a place in lists.
    fn side(&self) -> usize {
        usize::from(self.face == FaceName::Top)
    }

    /// Temperature of each cell [K].
    fn at_cells(&self, temperatures: &Temperatures) -> Vec<f64> {
        let rise = self.cells.rise(temperatures);
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
        let amplitudes = self.cells.parts(&solid.end_amplitudes(start, self.side() == 1), count);
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
        let (rate, side) = (1.0 / given.duration, self.side());
        self.add_heat(loads, given);
        if given.impulse.is_empty() {
            return;
        }
        let along = |axis: usize| -> Vec<f64> {
            given.impulse.iter().map(|impulse| impulse[axis] * rate).collect()
        };
        for (component, vectors) in self.cells.forces(along, self.geometry, given.symmetric) {
            for (class, vector) in vectors.into_iter().enumerate() {
                add(&mut loads.force[class][side][component], &vector, 1.0);
            }
        }
    }

    /// Adds the heat of a step, as it was given over time, to what acts and its derivatives.
    pub fn add_over_step(&self, derivatives: &mut [SolidLoads], given: &Given) {
        if given.duration <= 0.0 {
            return;
        }
        self.add_heat(&mut derivatives[0], given);
        let (slope, side) = (-2.0 / given.duration, self.side());
        for (class, vector) in self.heat_of(&given.falling, given) {
            add(&mut derivatives[0].heat[class][side], &vector, 1.0);
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

    /// Nodal vectors of heat at each cell, one a symmetry class; nothing of no amounts.
    fn heat_of(
        &self,
        amounts: &[f64],
        given: &Given,
    ) -> impl Iterator<Item = (usize, Vec<f64>)> + use<> {
        let vectors = match amounts.is_empty() {
            true => Vec::new(),
            false => self.cells.heat(amounts, given.symmetric),
        };
        vectors.into_iter().enumerate()
    }
}

/// Cells of a face: its own, or rings about the middle of a box.
enum Cells {
    Face(FaceCells),
    Rings(FaceRings),
}

impl Cells {
    fn as_wall(&self) -> WallCells {
        match self {
            Cells::Face(face) => face.cells(),
            Cells::Rings(rings) => rings.cells(),
        }
    }

    /// Temperature above the initial one at each cell [K].
    fn rise(&self, temperatures: &Temperatures) -> Vec<f64> {
        match self {
            Cells::Face(face) => face.rise(temperatures),
            Cells::Rings(rings) => rings.rise(temperatures),
        }
    }

    /// Parts of the temperature at each cell [K] from `count` layers of nodes, class by class.
    fn parts(&self, layers: &[Vec<f64>], count: usize) -> Vec<f64> {
        match self {
            Cells::Face(face) => face.parts(layers, count),
            Cells::Rings(rings) => rings.parts(layers, count),
        }
    }

    /// Nodal vectors of heat at each cell, one a symmetry class.
    fn heat(&self, amounts: &[f64], symmetric: [bool; 2]) -> Vec<Vec<f64>> {
        match self {
            Cells::Face(face) => face.nodal(amounts, [false; 2], symmetric),
            Cells::Rings(rings) => rings.nodal(amounts),
        }
    }

    /// The same of forces, of which a component `along` each axis is given (that along x is radial for rings): each with
    /// the displacement component of the solid that it acts on.
    fn forces(
        &self,
        along: impl Fn(usize) -> Vec<f64>,
        geometry: Geometry,
        symmetric: [bool; 2],
    ) -> Vec<(usize, Vec<Vec<f64>>)> {
        match (self, geometry) {
            (Cells::Rings(rings), _) => {
                let outward = along(0);
                let aside = [0, 1].map(|axis| (axis, rings.nodal_outward(&outward, axis)));
                aside.into_iter().chain([(2, rings.nodal(&along(2)))]).collect()
            }
            (Cells::Face(face), Geometry::Box) => {
                let flips = [[true, false], [false, true], [false; 2]];
                let nodal = |axis| (axis, face.nodal(&along(axis), flips[axis], symmetric));
                (0..3).map(nodal).collect()
            }
            (Cells::Face(face), Geometry::Axisymmetric) => {
                let radial = face.nodal(&along(0), [true, false], symmetric);
                vec![(0, radial), (1, face.nodal(&along(2), [false; 2], symmetric))]
            }
        }
    }
}

impl SolidBody {
    /// The port on a face that is linked.
    pub(super) fn port(&self, face: FaceName) -> &Port {
        let known = self.ports.iter().find(|port| port.face == face);
        known.expect("a body has a port on every face that is linked")
    }

    fn temperatures_at(
        &self,
        state: &[f64],
        memo: &Memo,
        path: &InputPath,
        s: f64,
    ) -> Temperatures {
        if path.is_held() {
            return self.solid.temperatures(state, SolidMemo::of(memo).outside());
        }
        let loads = self.loads.of_faces(&path.at(0, s), self.solid.mesh());
        self.solid.temperatures(state, &loads)
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
        Some(self.port(face).cells.as_wall())
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
        let start = self.temperatures_at(state, memo, acts.path, 0.0);
        let end = self.temperatures_at(&later, memo, acts.path, acts.duration);
        let surface =
            |&face: &FaceName| self.port(face).surface(&self.solid, [&start, &end], acts.duration);
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
        let end = self.temperatures_at(&later, memo, acts.path, acts.duration);
        Ok(faces.iter().map(|&face| self.port(face).at_cells(&end)).collect())
    }
}
