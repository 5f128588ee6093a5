//! Stresses along the way from one state to another that conserve energy and momentum.
//!
//! Over a step from F₀ to F₁ the stress is `P = F_½ ∫₀¹ S(C(s)) ds` with `F_½ = ½ (F₀ + F₁)`, the second
//! Piola–Kirchhoff stress S and the straight path `C(s) = C₀ + s (C₁ − C₀)` of `C = FᵀF`. As `C₁ − C₀ = 2 sym F_½ᵀ(F₁ −
//! F₀)`, the work `P : (F₁ − F₀)` is the change of the energy for any steps, and as S is symmetric no moment arises; a
//! rotation has no stress. With an S that is linear in C this is the method of J. C. Simo and N. Tarnow (1992, doi
//! 10.1007/BF00913408); the mean over the path is that of G. R. W. Quispel and D. I. McLaren (2008, doi
//! 10.1088/1751-8113/41/4/045206), taken in C. Two Gauss points on the path leave an error of the fifth power of the
//! change.

use super::dilatation::Pressure;
use super::tangent::{GroupTangent, Swelling};
use super::{Courses, Deformable, Failure};
use crate::laws::solid::large_strain::Deformed;
use crate::math::matrix3::{Matrix3, contraction, product, transposed};
use crate::runtime::parallel::Team;

/// Elastic deformation gradients of all points at both ends of a step.
pub struct Path<'a> {
    pub body: &'a Deformable,
    pub start: &'a [Matrix3],
    pub end: Vec<Matrix3>,
    /// History at the beginning.
    pub before: &'a [f64],
    /// Times in which points relax, and their thermal stretches.
    pub over: &'a Courses,
}

/// Places on the path and their weights.
const STATIONS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];
const WEIGHT: f64 = 0.5;

/// A group of points at both places of the path.
pub type Stations = [Station; 2];

/// A group of points at a place of the path.
pub struct Station {
    /// Upper triangles U with `UᵀU = C`, which have the stress S of every other F of that C.
    deformed: Vec<Deformed>,
    /// Pressure of the dilatation that the points share.
    pressure: Pressure,
    /// S of each point [Pa].
    stresses: Vec<Matrix3>,
}

/// Returns F at all points for displacements u of the nodes; refuses a body that is turned inside out.
pub fn gradients(body: &Deformable, u: &[[f64; 3]], team: &Team) -> Result<Vec<Matrix3>, Failure> {
    let volume = &body.space.volume;
    let all = team.map(volume.len(), |point| body.gradient(volume, point, u));
    for (point, gradient) in all.iter().enumerate() {
        let dilatation = Deformed::of(*gradient).dilatation;
        if !dilatation.is_finite() {
            return Err(Failure::NotFinite);
        }
        if dilatation <= 0.0 {
            return Err(Failure::Inverted { at: volume.at[point], dilatation });
        }
    }
    Ok(all)
}

impl Path<'_> {
    /// The places of each group on the path.
    pub fn stations(&self, team: &Team) -> Vec<Stations> {
        let of_group = |group: usize| STATIONS.map(|s| self.station(group, s));
        team.map(self.body.space.groups.len(), of_group)
    }

    /// Volume times P of each point [N m].
    pub fn loads(&self, stations: &[Stations], team: &Team) -> Vec<Matrix3> {
        let groups = &self.body.space.groups;
        let of_group = |group: usize| {
            let weights = &self.body.space.volume.weights;
            let of_point = |(place, point): (usize, usize)| {
                let mean = self.mean(&stations[group], place);
                let load = product(&self.middle(point), &mean);
                load.map(|row| row.map(|p| weights[point] * p))
            };
            groups[group].clone().enumerate().map(of_point).collect::<Vec<_>>()
        };
        team.map(groups.len(), of_group).concat()
    }

    /// Work of the stresses at the thermal stretches [J]: `ϑ³` times that per elastic volume. That of the pressure is the
    /// change of its energy, which no path errs in: on a long one volumes change by far more than between its ends.
    pub fn work(&self, team: &Team) -> f64 {
        let of_group = |group: usize| {
            let stretch = self.over.at(self.body, group).stretch;
            stretch.powi(3) * (self.work_of_shape(group) + self.work_of_pressure(group))
        };
        team.map(self.body.space.groups.len(), of_group).into_iter().sum()
    }

    /// Work of the stresses of a group without the pressure, of sheets with it [J].
    fn work_of_shape(&self, group: usize) -> f64 {
        let points = self.body.space.groups[group].clone();
        let stations = STATIONS.map(|s| match self.body.is_sheet {
            true => self.station(group, s).stresses,
            false => self.stresses(group, s, &self.deformed(group, s), |_| 0.0),
        });
        let of_point = |(place, point): (usize, usize)| {
            let mut mean = [[0.0; 3]; 3];
            stations.iter().for_each(|stresses| add(&mut mean, WEIGHT, &stresses[place]));
            let (from, to) = (&self.start[point], &self.end[point]);
            let stress = product(&self.middle(point), &mean);
            let work = contraction(&stress, to) - contraction(&stress, from);
            self.body.space.volume.weights[point] * work
        };
        points.enumerate().map(of_point).sum()
    }

    /// Change of the energy of the dilatation of a group [J]; of sheets it is part of the other work.
    fn work_of_pressure(&self, group: usize) -> f64 {
        if self.body.is_sheet {
            return 0.0;
        }
        let (body, points) = (self.body, self.body.space.groups[group].clone());
        let energy = |gradients: &[Matrix3]| {
            let own = gradients[points.clone()].iter();
            let deformed: Vec<Deformed> = own.map(|gradient| Deformed::of(*gradient)).collect();
            let shared = body.shared_dilatation(group, &deformed);
            body.energy_of_dilatation(group, body.law_of(group), (1.0, &shared))
        };
        energy(&self.end) - energy(self.start)
    }

    /// Derivatives of P of a group by F₁.
    pub fn tangent(&self, group: usize, stations: &Stations) -> GroupTangent {
        let body = self.body;
        let (law, duration) = (body.law_of(group), self.over.at(body, group).time);
        let (length, history) = (law.history(), &self.before[body.history_of(group)]);
        let points = body.space.groups[group].clone();
        let of_point = |(place, point): (usize, usize)| {
            let before = &history[length * place..length * (place + 1)];
            let (end, middle) = (&self.end[point], self.middle(point));
            let mean = self.mean(stations, place);
            let laws = [0, 1].map(|n| {
                let Station { deformed, pressure, .. } = &stations[n];
                let (at, time) = (&deformed[place], STATIONS[n] * duration);
                match body.is_sheet {
                    true => law.condensed_tangent(at, time, before),
                    false => law.tangent(at, time, before, pressure.at(place)),
                }
            });
            // δP for δF₁ = e_k ⊗ e_l.
            let columns: [Matrix3; 9] = std::array::from_fn(|column| {
                let (k, l) = (column / 3, column % 3);
                let mut squeeze = [[0.0; 3]; 3];
                for b in 0..3 {
                    squeeze[l][b] += end[k][b];
                    squeeze[b][l] += end[k][b];
                }
                let mut change = [[0.0; 3]; 3];
                for ((s, station), law) in STATIONS.iter().zip(stations).zip(&laws) {
                    let (at, stress) = (&station.deformed[place], &station.stresses[place]);
                    add(&mut change, WEIGHT, &turn(at, stress, law, *s, &squeeze));
                }
                let mut stress = product(&middle, &change);
                (0..3).for_each(|b| stress[k][b] += 0.5 * mean[l][b]);
                stress
            });
            std::array::from_fn(|row| {
                std::array::from_fn(|column| columns[column][row / 3][row % 3])
            })
        };
        GroupTangent {
            points: points.enumerate().map(of_point).collect(),
            swellings: match body.is_sheet {
                true => Vec::new(),
                false => {
                    let places = STATIONS.iter().zip(stations);
                    places.flat_map(|(s, station)| self.swellings(group, *s, station)).collect()
                }
            },
            scale: 1.0,
        }
    }

    /// Stiffness of the pressure at a place s of the path.
    fn swellings(&self, group: usize, s: f64, station: &Station) -> Vec<Swelling> {
        let points = self.body.space.groups[group].clone();
        let of = |gradient: &dyn Fn(usize) -> Matrix3, scale: f64| {
            let of_point = |(at, point): (&Deformed, usize)| {
                let inverse = product(&transposed(&at.inverse_transposed), &at.inverse_transposed);
                let own = product(&gradient(point), &inverse);
                own.map(|row| row.map(|x| scale * at.dilatation * x))
            };
            station.deformed.iter().zip(points.clone()).map(of_point).collect()
        };
        let forces = of(&|point| self.middle(point), 1.0);
        let changes = of(&|point| self.end[point], s);
        self.body.swellings(group, (&station.pressure, WEIGHT), forces, changes)
    }

    fn station(&self, group: usize, s: f64) -> Station {
        let deformed = self.deformed(group, s);
        let shared = self.body.shared_dilatation(group, &deformed);
        let pressure = self.body.pressure(group, self.body.law_of(group), &shared);
        let stresses = self.stresses(group, s, &deformed, |place| pressure.at(place));
        Station { deformed, pressure, stresses }
    }

    /// Points of a group at a place s of the path.
    fn deformed(&self, group: usize, s: f64) -> Vec<Deformed> {
        let body = self.body;
        let (law, duration) = (body.law_of(group), self.over.at(body, group).time);
        let history = &self.before[body.history_of(group)];
        let of_point = |point: usize| {
            let at = self.stretched(point, s);
            if body.is_sheet { law.thinned(at.gradient, s * duration, history) } else { at }
        };
        body.space.groups[group].clone().map(of_point).collect()
    }

    /// S of these [Pa], at pressures of the dilatation.
    fn stresses(
        &self,
        group: usize,
        s: f64,
        deformed: &[Deformed],
        pressure: impl Fn(usize) -> f64,
    ) -> Vec<Matrix3> {
        let body = self.body;
        let (law, duration) = (body.law_of(group), self.over.at(body, group).time);
        let (length, history) = (law.history(), &self.before[body.history_of(group)]);
        let stress = |(place, at): (usize, &Deformed)| {
            let mut own = history[length * place..length * (place + 1)].to_vec();
            let mut stress = law.respond(at, s * duration, &mut own).stress;
            add(&mut stress, pressure(place) * at.dilatation, &at.inverse_transposed);
            product(&transposed(&at.inverse_transposed), &stress)
        };
        deformed.iter().enumerate().map(stress).collect()
    }

    /// U of a point at a place s of the path.
    fn stretched(&self, point: usize, s: f64) -> Deformed {
        let square = |f: &Matrix3| product(&transposed(f), f);
        let (from, to) = (square(&self.start[point]), square(&self.end[point]));
        let c = |a: usize, b: usize| from[a][b] + s * (to[a][b] - from[a][b]);
        let mut u = [[0.0; 3]; 3];
        for a in 0..3 {
            let above = |b: usize| (0..a).map(|k| u[k][a] * u[k][b]).sum::<f64>();
            let diagonal = (c(a, a) - above(a)).sqrt();
            let row: [f64; 3] = std::array::from_fn(|b| match b {
                b if b < a => 0.0,
                b if b == a => diagonal,
                b => (c(a, b) - above(b)) / diagonal,
            });
            u[a] = row;
        }
        Deformed::of(u)
    }

    fn middle(&self, point: usize) -> Matrix3 {
        let (from, to) = (&self.start[point], &self.end[point]);
        std::array::from_fn(|a| std::array::from_fn(|b| 0.5 * (from[a][b] + to[a][b])))
    }

    /// Mean of S over the path.
    fn mean(&self, stations: &Stations, place: usize) -> Matrix3 {
        let mut mean = [[0.0; 3]; 3];
        stations.iter().for_each(|station| add(&mut mean, WEIGHT, &station.stresses[place]));
        mean
    }
}

/// δS at a place s of the path for δC₁: of `δU = ½ s U^(−T) δC₁`, `δS = U⁻¹ (δP − δU S)`.
fn turn(
    at: &Deformed,
    stress: &Matrix3,
    law: &[[f64; 9]; 9],
    s: f64,
    squeeze: &Matrix3,
) -> Matrix3 {
    let stretch = product(&at.inverse_transposed, squeeze).map(|row| row.map(|x| 0.5 * s * x));
    let along = |n: usize| (0..9).map(|m| law[n][m] * stretch[m / 3][m % 3]).sum::<f64>();
    let mut change: Matrix3 = std::array::from_fn(|a| std::array::from_fn(|b| along(3 * a + b)));
    add(&mut change, -1.0, &product(&stretch, stress));
    product(&transposed(&at.inverse_transposed), &change)
}

fn add(sum: &mut Matrix3, factor: f64, other: &Matrix3) {
    for (sum, other) in sum.iter_mut().flatten().zip(other.iter().flatten()) {
        *sum += factor * other;
    }
}
