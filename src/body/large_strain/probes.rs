//! Points of a solid of large strain whose values are outputs: probes, and points of fields.

use super::plan;
use super::snapshot::Seen;
use super::warming::Temperatures;
use crate::body::solid::Measure;
use crate::body::{BodyError, point_quantities};
use crate::laws::solid::stress::von_mises;
use crate::math::matrix3::{Matrix3, packed, product, scale_deviator, transposed};
use crate::method::large_strain::{Deformable, Stresses};
use crate::scene::{LargeStrain, Mechanics, Sampling, Scene};
use crate::space::{Form, Functions, Mesh, Refused, Row, Samples, Value, fit, row_of_mesh};

/// The points of a body.
pub struct Probes(Vec<Probe>);

/// A point: functions there, and points of the volume from which stress is fitted.
struct Probe {
    /// In the scene [m].
    at: [f64; 3],
    row: Vec<Value>,
    points: Vec<(u32, f64)>,
    /// Rotation or reflection from the model to the place.
    turn: Matrix3,
}

/// Values at a point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Probed {
    at: [f64; 3],
    /// [m]
    displacement: [f64; 3],
    /// Cauchy stress (xx, yy, zz, xy, yz, xz) [Pa].
    stress: [f64; 6],
    plastic_strain: f64,
    /// [K]
    temperature: f64,
}

/// Distance over that of nodes within which points of the volume give the stress at a place.
const REACH: f64 = 1.6;

impl Probes {
    pub fn new(
        scene: &Scene,
        (name, solid): (&str, &LargeStrain),
        mesh: &Mesh,
        body: &Deformable,
    ) -> Result<Self, Refused> {
        let own = scene.probe.iter().filter(|probe| probe.body == name).map(|probe| probe.at);
        let fields = scene.field.iter().filter(|field| field.body_and_place().0 == name);
        let of_fields = fields.flat_map(|field| match scene.sampling(field) {
            Some(Sampling::Points(grid)) => grid.points().collect(),
            _ => Vec::new(),
        });
        let all = own.chain(of_fields).map(|at| Probe::new(at, solid, mesh, body));
        all.collect::<Result<_, _>>().map(Self)
    }

    /// Values at all points of a state.
    pub fn read(
        &self,
        seen: &Seen,
        stresses: &Stresses,
        temperatures: Temperatures,
    ) -> Vec<Probed> {
        if self.0.is_empty() {
            return Vec::new();
        }
        let strains = seen.body.plastic_strains(seen.history);
        self.0.iter().map(|probe| probe.read(seen, (stresses, &strains), temperatures)).collect()
    }
}

impl Probe {
    fn new(
        at: [f64; 3],
        solid: &LargeStrain,
        mesh: &Mesh,
        body: &Deformable,
    ) -> Result<Self, Refused> {
        let (place, turn) = in_model(solid, mesh.form, at);
        let row = match solid.mechanics {
            Mechanics::Rkpm | Mechanics::Efg => {
                let mut row = Row::default();
                let functions = Functions::of(mesh, plan::kernels(solid, mesh))?;
                functions.evaluate(place, false, &mut row)?;
                row.values().collect()
            }
            Mechanics::Fem | Mechanics::Sph if mesh.cells.is_empty() => {
                among_points(body, place, REACH * solid.spacing())
            }
            Mechanics::Fem | Mechanics::Sph => row_of_mesh(mesh, place),
        };
        let layer = solid.layer_at(place[2]);
        let mut in_layer = vec![false; body.space.volume.len()];
        for (group, &own) in body.space.groups.iter().zip(&body.layer_of_group) {
            in_layer[group.clone()].fill(own == layer);
        }
        let distance = REACH * solid.spacing();
        let points = fit(&body.space.volume, mesh.form, place, distance, |point| in_layer[point]);
        Ok(Self { at, row, points, turn })
    }

    fn read(
        &self,
        seen: &Seen,
        (stresses, strains): (&Stresses, &[f64]),
        temperatures: Temperatures,
    ) -> Probed {
        let body = seen.body;
        let mut displacement = [0.0; 3];
        for value in &self.row {
            let u = seen.displacement[value.node as usize];
            (0..3).for_each(|a| displacement[a] += value.value * u[a]);
        }
        let mut stress = [[0.0; 3]; 3];
        let (mut plastic_strain, mut most_strain, mut most) = (0.0, 0.0_f64, 0.0_f64);
        for &(point, weight) in &self.points {
            let own = body.cauchy(seen.displacement, stresses, point as usize);
            for (sum, own) in stress.iter_mut().flatten().zip(own.iter().flatten()) {
                *sum += weight * own;
            }
            most = most.max(von_mises(packed(&own)));
            let strain = strains[point as usize];
            plastic_strain += weight * strain;
            most_strain = most_strain.max(strain);
        }
        if body.yields() {
            limit(&mut stress, most);
        }
        let turned = product(&product(&self.turn, &stress), &transposed(&self.turn));
        Probed {
            at: self.at,
            displacement: self.turn.map(|row| (0..3).map(|a| row[a] * displacement[a]).sum()),
            stress: packed(&turned),
            plastic_strain: plastic_strain.clamp(0.0, most_strain),
            temperature: temperatures.at(&self.row),
        }
    }
}

/// Row at a place among points without cells: the linear fit to the points around it.
fn among_points(body: &Deformable, place: [f64; 3], distance: f64) -> Vec<Value> {
    let space = &body.space;
    let mut nodes = Samples::default();
    space.nodes.iter().zip(&space.shares).for_each(|(at, share)| nodes.push(*at, *share, []));
    let fitted = fit(&nodes, space.form, place, distance, |_| true).into_iter();
    fitted.map(|(node, value)| Value { node, value, gradient: [0.0; 3] }).collect()
}

impl Probed {
    /// Returns a quantity at a point among the values of all.
    pub fn find(all: &[Self], at: [f64; 3], quantity: usize) -> Result<f64, BodyError> {
        let own = all.iter().find(|own| own.at == at).ok_or(BodyError::NoSuchReading)?;
        Ok(match point_quantities()[quantity].measure {
            Measure::Temperature => own.temperature,
            Measure::Displacement(axis) => own.displacement[axis],
            Measure::Stress(place) => own.stress[place],
            Measure::OfStress(measure, _) => measure(own.stress),
            Measure::PlasticStrain => own.plastic_strain,
            Measure::Damage | Measure::FailureDensity(_) => return Err(BodyError::NoSuchReading),
        })
    }
}

/// Scales the deviator of a stress fitted to points that yield, so that its von Mises stress is none above theirs.
fn limit(stress: &mut Matrix3, most: f64) {
    let found = von_mises(packed(stress));
    if found > most {
        scale_deviator(stress, most / found);
    }
}

/// Place in the model of a place in a body, and the turn back: from a meridian section about the axis, from half or a
/// quarter by reflection.
fn in_model(solid: &LargeStrain, form: Form, [x, y, z]: [f64; 3]) -> ([f64; 3], Matrix3) {
    if form == Form::Axisymmetric {
        let radius = x.hypot(y);
        let [c, s] = if radius > 0.0 { [x / radius, y / radius] } else { [1.0, 0.0] };
        return ([radius, 0.0, z], [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]);
    }
    let mirrors = solid.mirrors();
    let sign = |axis: usize, value: f64| if mirrors[axis] && value < 0.0 { -1.0 } else { 1.0 };
    let [sx, sy] = [sign(0, x), sign(1, y)];
    let turn = [[sx, 0.0, 0.0], [0.0, sy, 0.0], [0.0, 0.0, 1.0]];
    ([sx * x, if form == Form::Plane { 0.0 } else { sy * y }, z], turn)
}
