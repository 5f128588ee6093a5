//! One element: the response of its points to displacements, and its tangent.

use super::locking::{LockingTreatment, MOST_MODES, SmallFactor};
use super::problem::PointState;
use super::shapes::{Scratch, Shapes};
use crate::laws::solid::Present;
use crate::laws::{PlasticHistory, PointConstants, PointTangent, Relaxation};

/// Tables shared by all elements.
pub struct Kit {
    pub shapes: Shapes,
    pub treatment: LockingTreatment,
    /// Length of the history of a point.
    pub history: usize,
}

/// Input of the element loop.
pub struct Given<'a> {
    pub elements: &'a [[usize; 3]],
    /// Displacements, in the order of [`Shapes`].
    pub displacement: &'a [f64],
    /// Amplitudes of enhanced modes.
    pub amplitudes: &'a [f64],
    pub constants: &'a [PointConstants],
    /// Histories of the points after the last accepted step.
    pub old: &'a [f64],
    /// Relaxation of the moduli of the layer, if they relax.
    pub relaxation: Option<&'a Relaxation>,
}

/// Response of elements.
pub struct Answer<'a> {
    pub new: &'a mut [f64],
    pub tangents: &'a mut [PointTangent],
    /// Nodal forces, in the order of [`Shapes`], and forces on the amplitudes.
    pub forces: &'a mut [f64],
    pub mode_forces: &'a mut [f64],
    /// Scales of the forces on an element's nodes and amplitudes: moduli times strains times area, and times volume.
    pub scales: &'a mut [[f64; 2]],
}

/// Data for linearised changes of an element: its volumes and the factor that eliminates its enhanced modes.
pub struct Prepared {
    volumes: Vec<f64>,
    means: [f64; MOST_MODES],
    modes: Option<SmallFactor>,
}

/// Data of the last element whose points were all equally elastic: neighbours often need the same.
#[derive(Default)]
pub struct Known(Option<([f64; 3], PointTangent, Prepared)>);

/// Fraction of stiffness that tangents keep where a point flows. With none, enhanced modes could diverge; with more,
/// Newton's method would slow down.
const LEAST: f64 = 1e-5;

/// A tangent for strains, by columns.
fn matrix(tangent: &PointTangent) -> [[f64; 6]; 6] {
    let PointTangent { bulk, all, along, direction: n } = tangent;
    let mut d = [[0.0; 6]; 6];
    for (i, row) in d.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            *entry = along * n[i] * n[j];
            if i < 3 && j < 3 {
                *entry += bulk - all / 3.0;
            }
        }
        row[i] += if i < 3 { *all } else { 0.5 * all };
    }
    d
}

/// Strain up to which rounding scales: in a collapsing body strains grow without bound, but the residual forces do not.
const MOST_STRAIN: f64 = 0.1;

/// Computes the response of a point: stress of the change of shape and of volume [Pa], the tangent, and the largest
/// component of plastic strain.
fn respond(
    (constants, relaxation): (&PointConstants, Option<&Relaxation>),
    (shape, dilatation): (&[f64; 6], f64),
    old: &[f64],
    new: &mut [f64],
) -> ([f64; 6], f64, PointTangent, f64) {
    if let Some(relaxation) = relaxation {
        let found = relaxation.respond(constants, (shape, dilatation), old, new);
        return (found.stress, found.pressure, found.tangent, 0.0);
    }
    let mut history = PlasticHistory::default();
    let (stress, mut tangent) =
        constants.return_to_yield(shape, &PlasticHistory::read(old), &mut history);
    history.write(new);
    tangent.along = tangent.along.max(2.0 * LEAST * constants.shear - tangent.all);
    (stress, constants.bulk * dilatation, tangent, largest(&history.plastic_strain))
}

/// Computes stress and energy of a point from its plastic history.
fn present(
    constants: &PointConstants,
    (shape, dilatation): (&[f64; 6], f64),
    history: &PlasticHistory,
) -> Present {
    let elastic: [f64; 6] = std::array::from_fn(|i| shape[i] - history.plastic_strain[i]);
    let stress = constants.elastic_tangent().of_shape(&elastic);
    let pressure = constants.bulk * dilatation;
    let work: f64 = stress.iter().zip(&elastic).map(|(s, e)| s * e).sum();
    let stored = 0.5 * (work + pressure * dilatation) + constants.hardening_energy(history);
    Present { stress, pressure, stored }
}

/// The largest magnitude of a tensor's components.
fn largest(tensor: &[f64; 6]) -> f64 {
    tensor.iter().fold(0.0, |m, v| m.max(v.abs()))
}

impl Kit {
    /// Number of unknowns of an element.
    pub fn unknowns(&self) -> usize {
        self.shapes.degrees * self.shapes.nodes
    }

    /// Strains of some elements, including enhanced modes.
    fn strains(&self, given: &Given, scratch: &mut Scratch) -> Vec<[f64; 6]> {
        let (points, modes) = (self.shapes.points, self.treatment.modes());
        let mut strains = vec![[0.0; 6]; given.elements.len() * points];
        self.shapes.strains(given.elements, given.displacement, &mut strains, scratch);
        if modes > 0 {
            for ((element, strains), amplitudes) in given
                .elements
                .iter()
                .zip(strains.chunks_exact_mut(points))
                .zip(given.amplitudes.chunks_exact(modes))
            {
                let means = self.treatment.means(&self.shapes.volumes(*element));
                self.enhance(&means, amplitudes, strains);
            }
        }
        strains
    }

    fn enhance(&self, means: &[f64; MOST_MODES], amplitudes: &[f64], strains: &mut [[f64; 6]]) {
        for (q, strain) in strains.iter_mut().enumerate() {
            for ((component, value), amplitude) in self.treatment.at(means, q).zip(amplitudes) {
                strain[component] += value * amplitude;
            }
        }
    }

    /// Computes the work of stresses times volumes on the enhanced modes.
    fn on_modes(&self, means: &[f64; MOST_MODES], stress: &[[f64; 6]], out: &mut [f64]) {
        out.fill(0.0);
        for (q, stress) in stress.iter().enumerate() {
            for ((component, value), force) in self.treatment.at(means, q).zip(&mut *out) {
                *force += value * stress[component];
            }
        }
    }

    /// Splits strains: returns the elastic volume change, projected in elements that do so, and leaves the shape
    /// changes in place.
    fn split(
        &self,
        volumes: &[f64],
        thermal: impl Fn(usize) -> f64,
        strains: &mut [[f64; 6]],
    ) -> Vec<f64> {
        let trace = |(q, e): (usize, &[f64; 6])| e[0] + e[1] + e[2] - 3.0 * thermal(q);
        let mut dilatation: Vec<f64> = strains.iter().enumerate().map(trace).collect();
        if self.treatment.is_projected() {
            self.treatment.project(volumes, &mut dilatation);
        }
        for (q, strain) in strains.iter_mut().enumerate() {
            let off = dilatation[q] / 3.0 + thermal(q);
            strain[..3].iter_mut().for_each(|e| *e -= off);
        }
        dilatation
    }

    /// Combines shape stresses and pressures to stresses times volumes: the adjoint of [`Self::split`].
    fn join(&self, volumes: &[f64], pressures: &[f64], stress: &mut [[f64; 6]]) {
        let rest = |((s, p), v): ((&[f64; 6], &f64), &f64)| v * (p - (s[0] + s[1] + s[2]) / 3.0);
        let mut rest: Vec<f64> = stress.iter().zip(pressures).zip(volumes).map(rest).collect();
        if self.treatment.is_projected() {
            self.treatment.project_back(volumes, &mut rest);
        }
        for ((stress, volume), rest) in stress.iter_mut().zip(volumes).zip(rest) {
            *stress = stress.map(|s| s * volume);
            stress[..3].iter_mut().for_each(|s| *s += rest);
        }
    }

    /// Computes the response of elements to displacements and amplitudes.
    pub fn respond(&self, given: &Given, answer: &mut Answer, scratch: &mut Scratch) {
        let (points, modes) = (self.shapes.points, self.treatment.modes());
        let mut strains = self.strains(given, scratch);
        let mut pressures = vec![0.0; points];
        for (e, (element, strains)) in
            given.elements.iter().zip(strains.chunks_exact_mut(points)).enumerate()
        {
            let volumes = self.shapes.volumes(*element);
            let constants = &given.constants[e * points..][..points];
            let totals: Vec<f64> = strains.iter().map(largest).collect();
            let dilatation = self.split(&volumes, |q| constants[q].thermal_strain, strains);
            let mut most = 0.0_f64;
            for q in 0..points {
                let at = (e * points + q) * self.history;
                let own = at..at + self.history;
                let change = (&strains[q], dilatation[q]);
                let (old, new) = (&given.old[own.clone()], &mut answer.new[own]);
                let (stress, pressure, tangent, plastic) =
                    respond((&constants[q], given.relaxation), change, old, new);
                answer.tangents[e * points + q] = tangent;
                pressures[q] = pressure;
                let strain = totals[q] + constants[q].thermal_strain.abs() + plastic;
                let moduli = constants[q].bulk + constants[q].shear;
                let rounded = moduli * strain.min(MOST_STRAIN);
                most = most.max(largest(&stress) + pressures[q].abs() + rounded);
                strains[q] = stress;
            }
            self.join(&volumes, &pressures, strains);
            if modes > 0 {
                let means = self.treatment.means(&volumes);
                let out = &mut answer.mode_forces[e * modes..][..modes];
                self.on_modes(&means, strains, out);
            }
            let volume: f64 = volumes.iter().sum();
            answer.scales[e] = [most * volume / self.shortest(*element), most * volume];
        }
        self.shapes.forces(given.elements, &strains, answer.forces, scratch);
    }

    /// Computes stress and energies at the points, with their present histories.
    pub fn read(&self, given: &Given, scratch: &mut Scratch, out: &mut Vec<PointState>) {
        let points = self.shapes.points;
        let mut strains = self.strains(given, scratch);
        for (e, (element, strains)) in
            given.elements.iter().zip(strains.chunks_exact_mut(points)).enumerate()
        {
            let volumes = self.shapes.volumes(*element);
            let constants = &given.constants[e * points..][..points];
            let dilatation = self.split(&volumes, |q| constants[q].thermal_strain, strains);
            let first = out.len();
            let mut pressures = Vec::with_capacity(points);
            for (q, (constants, shape)) in constants.iter().zip(&mut *strains).enumerate() {
                let own = &given.old[(e * points + q) * self.history..][..self.history];
                let change = (&*shape, dilatation[q]);
                let Present { stress: of_shape, pressure, stored } = match given.relaxation {
                    Some(relaxation) => relaxation.present(constants, change, own),
                    None => present(constants, change, &PlasticHistory::read(own)),
                };
                *shape = of_shape;
                pressures.push(pressure);
                let history = PlasticHistory::read(own);
                let mut stress = *shape;
                let off = pressures[q] - (stress[0] + stress[1] + stress[2]) / 3.0;
                stress[..3].iter_mut().for_each(|s| *s += off);
                let (volume, thermal_strain) = (volumes[q], constants.thermal_strain);
                out.push(PointState {
                    volume,
                    stress,
                    thermal_strain,
                    tension: 0.0,
                    stored,
                    history,
                });
            }
            self.join(&volumes, &pressures, strains);
            for (point, stress) in out[first..].iter_mut().zip(strains) {
                point.tension = (stress[0] + stress[1] + stress[2]) / point.volume;
            }
        }
    }

    fn shortest(&self, element: [usize; 3]) -> f64 {
        let [x, y, z] = self.shapes.size(element);
        if self.shapes.degrees == 2 { x.min(z) } else { x.min(y).min(z) }
    }

    /// Prepares the data for linearised changes of an element.
    pub fn prepare(&self, element: [usize; 3], tangents: &[PointTangent]) -> Prepared {
        let volumes = self.shapes.volumes(element);
        let means = self.treatment.means(&volumes);
        let count = self.treatment.modes();
        if count == 0 {
            return Prepared { volumes, means, modes: None };
        }
        let mut own = [[0.0; MOST_MODES]; MOST_MODES];
        for (q, (tangent, volume)) in tangents.iter().zip(&volumes).enumerate() {
            let columns = matrix(tangent);
            let mut all = [(0, 0.0); MOST_MODES];
            all.iter_mut().zip(self.treatment.at(&means, q)).for_each(|(to, from)| *to = from);
            for (m, &(component, value)) in all.iter().enumerate().take(count) {
                let (row, weight) = (&columns[component], volume * value);
                for (sum, &(other, factor)) in own[m][..=m].iter_mut().zip(&all) {
                    *sum += weight * factor * row[other];
                }
            }
        }
        Prepared { volumes, means, modes: SmallFactor::new(count, own) }
    }

    /// Prepares the data like [`Self::prepare`], or reuses those of the last element if both are alike.
    pub fn prepare_after<'a>(
        &self,
        known: &'a mut Known,
        element: [usize; 3],
        tangents: &[PointTangent],
    ) -> &'a Prepared {
        let size = self.shapes.size(element);
        let is_alike = |(other, tangent, _): &([f64; 3], PointTangent, Prepared)| {
            // Rings of equal size differ in radius.
            self.shapes.degrees == 3 && *other == size && tangents.iter().all(|t| t == tangent)
        };
        if !known.0.as_ref().is_some_and(is_alike) {
            known.0 = Some((size, tangents[0], self.prepare(element, tangents)));
            // Cached data must belong to a tangent that all points share.
            if tangents.iter().any(|t| *t != tangents[0])
                && let Some((size, ..)) = &mut known.0
            {
                *size = [f64::NAN; 3];
            }
        }
        &known.0.as_ref().expect("it has been found").2
    }

    /// Replaces changes of strain by those of stress times volume, at constant enhanced modes.
    fn stresses(&self, prepared: &Prepared, tangents: &[PointTangent], strains: &mut [[f64; 6]]) {
        let dilatation = self.split(&prepared.volumes, |_| 0.0, strains);
        let pressure = |(t, d): (&PointTangent, f64)| t.bulk * d;
        let pressures: Vec<f64> = tangents.iter().zip(dilatation).map(pressure).collect();
        for (strain, tangent) in strains.iter_mut().zip(tangents) {
            *strain = tangent.of_shape(strain);
        }
        self.join(&prepared.volumes, &pressures, strains);
    }

    /// Replaces changes of strain by those of stress times volume, with enhanced modes condensed.
    pub fn relieved(
        &self,
        prepared: &Prepared,
        tangents: &[PointTangent],
        strains: &mut [[f64; 6]],
    ) {
        if self.treatment.modes() > 0 {
            let mut stress = strains.to_vec();
            let amplitudes = self.following(prepared, tangents, &mut stress, &[]);
            self.enhance(&prepared.means, &amplitudes, strains);
        }
        self.stresses(prepared, tangents, strains);
    }

    /// Changes of amplitudes that cancel the forces on them, from changes of strain and the present forces.
    pub fn following(
        &self,
        prepared: &Prepared,
        tangents: &[PointTangent],
        strains: &mut [[f64; 6]],
        forces: &[f64],
    ) -> Vec<f64> {
        self.stresses(prepared, tangents, strains);
        let mut on_modes = vec![0.0; self.treatment.modes()];
        self.on_modes(&prepared.means, strains, &mut on_modes);
        on_modes.iter_mut().zip(forces).for_each(|(sum, force)| *sum += force);
        on_modes.iter_mut().for_each(|force| *force = -*force);
        self.eliminate(prepared, on_modes)
    }

    fn eliminate(&self, prepared: &Prepared, mut forces: Vec<f64>) -> Vec<f64> {
        match &prepared.modes {
            Some(factor) => {
                factor.solve_in_place(&mut forces);
                forces
            }
            None => vec![f64::NAN; forces.len()],
        }
    }

    /// Returns stresses times volumes after the amplitudes have cancelled the forces on them.
    pub fn given_way(
        &self,
        prepared: &Prepared,
        tangents: &[PointTangent],
        forces: &[f64],
        out: &mut [[f64; 6]],
    ) {
        out.fill([0.0; 6]);
        let opposite = forces.iter().map(|f| -f).collect();
        self.enhance(&prepared.means, &self.eliminate(prepared, opposite), out);
        self.stresses(prepared, tangents, out);
    }

    /// Tangent stiffness of an element, symmetric, by columns.
    pub fn stiffness(
        &self,
        element: [usize; 3],
        tangents: &[PointTangent],
        scratch: &mut Scratch,
    ) -> Vec<f64> {
        let (unknowns, points) = (self.unknowns(), self.shapes.points);
        let elements = vec![element; unknowns];
        let mut unit = vec![0.0; unknowns * unknowns];
        unit.iter_mut().step_by(unknowns + 1).for_each(|one| *one = 1.0);
        let mut strains = vec![[0.0; 6]; unknowns * points];
        self.shapes.strains(&elements, &unit, &mut strains, scratch);
        let prepared = self.prepare(element, tangents);
        for strains in strains.chunks_exact_mut(points) {
            self.relieved(&prepared, tangents, strains);
        }
        self.shapes.forces(&elements, &strains, &mut unit, scratch);
        unit
    }
}
