//! Heat in a solid of large strain: conditions on its faces, contact below, and what its stress feels of it.

use super::plan;
use crate::body::BodyError;
use crate::inputs::{FaceInput, FaceInputKind, InputLayout, InputPath};
use crate::laws::Material;
use crate::laws::solid::large_strain::Thermal;
use crate::method::large_strain::{
    Conduction, Course, Courses, Deformable, Failure, Film, HeatDrive, HeatOfLayer, Warmth,
    present_area,
};
use crate::runtime::allowance::Allowance;
use crate::scene::LargeStrain;
use crate::space::{Mesh, Value};

/// Conduction of a body with the conditions on its faces.
pub struct Warming {
    conduction: Conduction,
    faces: Vec<HeatedFace>,
    /// Number of the face of each node of prescribed temperature.
    holds: Vec<Option<usize>>,
    thermal: Vec<Thermal>,
    /// Initial temperature [K].
    zero: f64,
}

/// A thermal condition on a face.
struct HeatedFace {
    /// Points of the boundary.
    points: Vec<usize>,
    kind: FaceInputKind,
    /// Heat transfer coefficient [W/(m² K)].
    coefficient: f64,
    /// Place of its value among the inputs.
    input: usize,
}

/// Totals of the heat of a body.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HeatTotals {
    /// [K]
    pub highest: f64,
    pub mean: f64,
    /// [J]
    pub brought_in: f64,
    pub stored: f64,
    pub lost: f64,
    pub given: f64,
}

/// Temperatures of a body: those of its nodes, or the same everywhere where these have no rise of their own.
#[derive(Clone, Copy)]
pub struct Temperatures<'a> {
    /// [K]
    pub base: f64,
    pub rise: &'a [f64],
}

impl Temperatures<'_> {
    /// Temperature at a place with these functions [K].
    pub fn at(&self, row: &[Value]) -> f64 {
        let rise = |value: &Value| value.value * self.rise[value.node as usize];
        match self.rise.is_empty() {
            true => self.base,
            false => self.base + row.iter().map(rise).sum::<f64>(),
        }
    }

    /// Temperatures at the nodes [K].
    pub fn at_nodes(&self, body: &Deformable) -> Vec<f64> {
        match self.rise.is_empty() {
            true => vec![self.base; body.nodes()],
            false => body.at_nodes(self.rise).into_iter().map(|rise| self.base + rise).collect(),
        }
    }
}

/// Totals of the heat of a whole body of `copies` modelled parts; zeros of one that conducts no heat.
pub fn heat_totals(
    warming: Option<&Warming>,
    (body, warmth): (&Deformable, &Warmth),
    copies: f64,
) -> HeatTotals {
    let Some(warming) = warming else { return HeatTotals::default() };
    let own = warming.totals(body, warmth);
    HeatTotals {
        brought_in: copies * own.brought_in,
        stored: copies * own.stored,
        lost: copies * own.lost,
        given: copies * own.given,
        ..own
    }
}

/// Heat of a cell below in a step over that in the body up to which a state is possible.
const EXCHANGE: f64 = 100.0;
/// Share of the heat that a balance may miss.
const BALANCE: f64 = 1e-9;

impl Warming {
    /// `None` for a body that conducts no heat.
    pub fn new(
        layout: &InputLayout,
        (name, solid): (&str, &LargeStrain),
        mesh: &Mesh,
        body: &Deformable,
    ) -> Result<Option<Self>, Failure> {
        if !solid.conducts() {
            return Ok(None);
        }
        let sides = &body.space.boundary.sides;
        let own = layout.faces.iter().filter(|input| input.body == name);
        let face = |input: &FaceInput| {
            let convection = solid.faces[&input.face].convection;
            let is_on = |&point: &usize| plan::is_on(solid, input.face, sides[point]);
            HeatedFace {
                points: (0..sides.len()).filter(is_on).collect(),
                kind: input.kind,
                coefficient: convection.map_or(0.0, |convection| convection.coefficient),
                input: input.index,
            }
        };
        let faces: Vec<HeatedFace> = own.clone().map(face).collect();
        let mut holds = vec![None; body.nodes()];
        for (number, input) in own.enumerate() {
            if input.kind != FaceInputKind::Temperature {
                continue;
            }
            let on_face = |side| plan::is_on(solid, input.face, side);
            for (_, corners) in mesh.faces.iter().filter(|(side, _)| on_face(*side)) {
                corners.iter().for_each(|&node| holds[node as usize] = Some(number));
            }
        }
        let zero = solid.initial_temperature;
        let layer = |material: &Material| HeatOfLayer {
            capacity: material.heat.density * material.heat.specific_heat.value(zero),
            conductivity: material.heat.conductivity.value(zero),
        };
        let layers = solid.materials_of_layers().into_iter().map(layer).collect();
        let held = holds.iter().map(Option::is_some).collect();
        let conduction = Conduction::new(body, layers, held)?;
        Ok(Some(Self { conduction, faces, holds, thermal: solid.thermal(), zero }))
    }

    /// The state at time zero above a number of cells; stress lags behind the temperature if `lags`.
    pub fn start(&self, cells: usize, lags: bool) -> Warmth {
        let count = self.conduction.capacity.len();
        let felt = if lags && self.acts() { vec![0.0; count] } else { Vec::new() };
        Warmth { rise: vec![0.0; count], felt, exchange: vec![0.0; cells], ..Warmth::default() }
    }

    /// Refuses temperatures that are not above absolute zero.
    pub fn check_inputs(&self, inputs: &[f64]) -> Result<(), BodyError> {
        for face in self.faces.iter().filter(|face| face.kind != FaceInputKind::Flux) {
            let given = inputs[face.input];
            if given <= 0.0 {
                let message = format!("{given} K is not above absolute zero");
                return Err(BodyError::Input { index: face.input, message });
            }
        }
        Ok(())
    }

    /// Brings nodes of prescribed temperature to the inputs at once.
    pub fn hold(&self, warmth: &mut Warmth, inputs: &[f64]) {
        for (node, hold) in self.holds.iter().enumerate() {
            let Some(face) = hold else { continue };
            let rise = inputs[self.faces[*face].input] - self.zero;
            warmth.lost -= self.conduction.capacity[node] * (rise - warmth.rise[node]);
            warmth.rise[node] = rise;
        }
    }

    /// Advances the temperatures of a body displaced by u over a duration [s]; returns the heat through each of further
    /// films, whose temperatures are absolute [J].
    pub fn advance(
        &self,
        (name, body, u): (&str, &Deformable, &[[f64; 3]]),
        warmth: &mut Warmth,
        (path, duration): (&InputPath, f64),
        further: Vec<Film>,
        allowance: &Allowance,
    ) -> Result<Vec<f64>, BodyError> {
        let (drive, further) = self.drive((body, u), (path, duration), further);
        let advanced =
            self.conduction.advance((body, u), &mut warmth.rise, &drive, duration, allowance);
        let passed = advanced.map_err(|failure| super::named(name, failure))?;
        let (own, other) = passed.through_films.split_at(further);
        warmth.brought_in += passed.brought_in;
        warmth.lost += passed.through_held + own.iter().sum::<f64>();
        warmth.given += other.iter().sum::<f64>();
        // Beyond some length of step or size of constants rounding is all that is left.
        let [missing, passed] = self.balance(warmth);
        if missing.is_nan() || missing.abs() > BALANCE * passed {
            return Err(BodyError::Unbalanced { body: name.to_owned(), missing, passed });
        }
        let [coldest, _] = self.range(warmth);
        if coldest <= 0.0 {
            let body = name.to_owned();
            return Err(BodyError::BelowAbsoluteZero { body, temperature: coldest });
        }
        Ok(other.to_vec())
    }

    /// Conditions over a step with the present areas of faces, and the number of films of faces; further ones follow.
    fn drive(
        &self,
        (body, u): (&Deformable, &[[f64; 3]]),
        (path, duration): (&InputPath, f64),
        further: Vec<Film>,
    ) -> (HeatDrive, usize) {
        let ends = [path.at(0, 0.0), path.at(0, duration)];
        let count = body.nodes();
        let mut drive = HeatDrive {
            held: vec![[0.0; 2]; count],
            flows: vec![[0.0; 2]; count],
            films: Vec::new(),
        };
        for (held, hold) in drive.held.iter_mut().zip(&self.holds) {
            if let Some(face) = hold {
                *held = [0, 1].map(|n| ends[n][self.faces[*face].input] - self.zero);
            }
        }
        for face in &self.faces {
            let value = [0, 1].map(|n| ends[n][face.input]);
            let areas = self.areas(face, body, u);
            match face.kind {
                FaceInputKind::Temperature => {}
                FaceInputKind::Flux => {
                    for (node, area) in areas {
                        (0..2).for_each(|n| drive.flows[node][n] += area * value[n]);
                    }
                }
                FaceInputKind::Ambient => {
                    drive.films.extend(areas.into_iter().map(|(node, area)| Film {
                        node,
                        conductance: face.coefficient * area,
                        ambient: value.map(|t| t - self.zero),
                    }))
                }
            }
        }
        let own = drive.films.len();
        let above = |film: Film| Film { ambient: film.ambient.map(|t| t - self.zero), ..film };
        drive.films.extend(further.into_iter().map(above));
        (drive, own)
    }

    /// Present area of a face that each of its nodes represents [m²].
    fn areas(&self, face: &HeatedFace, body: &Deformable, u: &[[f64; 3]]) -> Vec<(usize, f64)> {
        let mut areas = vec![0.0; body.nodes()];
        if face.kind != FaceInputKind::Temperature {
            for &point in &face.points {
                let area = present_area(body, point, u);
                for value in body.space.boundary.samples.row(point) {
                    areas[value.node as usize] += area * value.value;
                }
            }
        }
        areas.into_iter().enumerate().filter(|(_, area)| *area != 0.0).collect()
    }

    /// Returns true if temperatures deform the body or change the pace of its relaxation.
    pub fn acts(&self) -> bool {
        self.thermal.iter().any(Thermal::acts)
    }

    /// Temperatures of the groups of points of a body [K].
    pub fn of_groups(&self, body: &Deformable, rise: &[f64]) -> Vec<f64> {
        body.means_of_groups(rise).into_iter().map(|rise| self.zero + rise).collect()
    }

    /// The steps of all groups over a time [s] in which their temperatures change linearly [K].
    pub fn courses(
        &self,
        body: &Deformable,
        [before, after]: [&[f64]; 2],
        dt: f64,
    ) -> Result<Courses, Failure> {
        let of_group = |(group, (&from, &to)): (usize, (&f64, &f64))| {
            let thermal = &self.thermal[body.layer_of_group[group]];
            let stretch = thermal.stretch(to);
            if !(stretch > 0.0 && stretch.is_finite()) {
                return Err(Failure::Shrunk { temperature: to, stretch });
            }
            Ok(Course { time: thermal.reduced_time([from, to], dt), stretch, growth: 0.0 })
        };
        let all = before.iter().zip(after).enumerate().map(of_group);
        Ok(Courses::OfGroups(all.collect::<Result<_, _>>()?))
    }

    /// The steps of all groups over the last `dt` [s] before a time in an advance of this duration, over which their
    /// temperatures change linearly.
    pub fn swelling(
        &self,
        body: &Deformable,
        ends: &[Vec<f64>; 2],
        [time, dt]: [f64; 2],
        duration: f64,
    ) -> Result<Courses, Failure> {
        let [first, last] = ends;
        let at = |time: f64| -> Vec<f64> {
            let part = time / duration;
            first.iter().zip(last).map(|(a, b)| a + part * (b - a)).collect()
        };
        let mut courses = self.courses(body, [&at(time - dt), &at(time)], dt)?;
        if let Courses::OfGroups(courses) = &mut courses {
            for (group, course) in courses.iter_mut().enumerate() {
                let thermal = &self.thermal[body.layer_of_group[group]];
                let grown = thermal.stretch(last[group]) - thermal.stretch(first[group]);
                course.growth = grown / duration;
            }
        }
        Ok(courses)
    }

    /// The stretches of all groups at temperatures of the nodes, over no time.
    pub fn stretched(&self, body: &Deformable, rise: &[f64]) -> Result<Courses, Failure> {
        let at = self.of_groups(body, rise);
        self.courses(body, [&at, &at], 0.0)
    }

    /// Lowest and highest temperature of a node, or its coefficient, which kernels keep near it [K].
    pub fn range(&self, warmth: &Warmth) -> [f64; 2] {
        let rise = || warmth.rise.iter().copied();
        let extremes =
            [rise().fold(f64::INFINITY, f64::min), rise().fold(f64::NEG_INFINITY, f64::max)];
        extremes.map(|rise| self.zero + rise)
    }

    pub fn totals(&self, body: &Deformable, warmth: &Warmth) -> HeatTotals {
        let stored = self.stored(warmth);
        let capacity: f64 = self.conduction.capacity.iter().sum();
        let at_nodes = body.at_nodes(&warmth.rise);
        let Warmth { brought_in, lost, given, .. } = *warmth;
        HeatTotals {
            highest: self.zero + at_nodes.into_iter().fold(f64::NEG_INFINITY, f64::max),
            mean: self.zero + stored / capacity,
            brought_in,
            stored,
            lost,
            given,
        }
    }

    fn stored(&self, warmth: &Warmth) -> f64 {
        self.conduction.capacity.iter().zip(&warmth.rise).map(|(c, rise)| c * rise).sum()
    }

    /// Heat that has no cause, and the sum of all that has passed and is stored [J].
    fn balance(&self, warmth: &Warmth) -> [f64; 2] {
        let &Warmth { brought_in, lost, given, .. } = warmth;
        let missing = self.stored(warmth) - brought_in + lost + given;
        let content = self.conduction.capacity.iter().zip(&warmth.rise).map(|(c, t)| (c * t).abs());
        [missing, brought_in.abs() + lost.abs() + given.abs() + content.sum::<f64>()]
    }

    /// Refuses heat that no run produces.
    pub fn check(&self, warmth: &Warmth) -> Result<(), String> {
        let felt = &warmth.felt;
        if warmth.rise.iter().chain(felt).any(|rise| rise.is_nan() || self.zero + rise <= 0.0) {
            return Err("a temperature is not above absolute zero".to_owned());
        }
        let [missing, scale] = self.balance(warmth);
        let mut exchange = warmth.exchange.iter().chain([&warmth.outside]);
        if missing.is_nan() || missing.abs() > BALANCE * scale {
            return Err(format!("{missing:.1e} J of heat have no cause"));
        }
        let content: f64 = self.conduction.capacity.iter().map(|c| c * self.zero).sum();
        let most = EXCHANGE * (content + scale);
        if exchange.any(|heat| heat.is_nan() || heat.abs() > most) {
            return Err("a cell below took more heat than there is".to_owned());
        }
        Ok(())
    }
}
