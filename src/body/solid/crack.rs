//! Stress intensity of flaws, from the stress of the body without them.
//!
//! An edge crack of depth a has `K = 2√(a/π) ∫₀¹ σ(xa) (1.3 − 0.3 x^{5/4})/√(1 − x²) dx` with the stress σ across its
//! plane (H. Tada, P. C. Paris and G. R. Irwin, *The Stress Analysis of Cracks Handbook*, Del Research 1973: point
//! forces on an edge crack of a half plane). A penny of radius a has the mean along its front,
//! `K = 2√(a/π) ∫ σ̄(a sin θ) sin θ dθ` with the mean σ̄ over circles (I. N. Sneddon 1946, doi 10.1098/rspa.1946.0077).
//! One in a row of equal edge cracks has the sum of [`crack_row`]. All are sums over points with fixed weights, so one
//! influence row has a whole flaw.
//!
//! Stress is a polynomial between neighbouring nodes, so edge cracks take it at the nodes along their line. A closed
//! crack, K < 0, has K = 0.

use std::f64::consts::{FRAC_PI_2, PI};

use super::reader::SolidReader;
use crate::body::BodyError;
use crate::laws::Property;
use crate::laws::fracture::{CrackGrowth, crack_row};
use crate::laws::solid::Elasticity;
use crate::math::gauss::gauss_on;
use crate::math::lagrange::interpolation_weights;
use crate::method::fem::{Component, Functional, Geometry, Mesh, NodalSum, Plan, SolidFem};
use crate::scene::{FaceName, Flaw, FlawShape, Scene, Solid};

/// Safety of closed cracks, and of all that are safer.
const SAFEST: f64 = 1e6;
/// Relative difference of equal distances.
const ROUNDING: f64 = 1e-9;
/// Gauss points between neighbouring element ends along an edge crack.
const POINTS: usize = 16;
/// Least and largest number of radii at which a penny has points, and radii for the root of its elements; there are
/// twice as many angles. Stress that decays within a length δ from the rim varies over the part √(δ/a) of both angles.
const RADII: [usize; 2] = [8, 64];
const RADII_OF_ELEMENTS: f64 = 4.0;
/// Points of the rim of a penny by which its elements are found.
const RIM: usize = 16;
/// Depths that are tried in an element.
const TRIALS: usize = 4;
/// Halves of the first of them that are tried.
const HALVINGS: i32 = 3;
/// Number of elements over the depth of a crack below which the mesh is too coarse for it.
const LEAST_ELEMENTS: f64 = 2.0;

/// A flaw of a body.
pub struct Crack {
    name: String,
    /// Factors of the stress components in the stress across the plane.
    across: [f64; 6],
    points: Vec<[f64; 3]>,
    extent: Extent,
    front: Front,
    elastic: Elastic,
    /// [Pa √m]
    toughness: f64,
    /// Distances from the mouth at which elements end [m], of edge cracks on meshes that do not resolve the heat of a
    /// step.
    elements: Option<Vec<f64>>,
}

/// Places at which a crack grows.
enum Front {
    /// The tip of an edge crack, which moves from its mouth along a unit vector.
    Tip { mouth: [f64; 3], inward: [f64; 3] },
    /// Points of the rim of a penny.
    Rim(Vec<[f64; 3]>),
}

/// Young's modulus and Poisson's ratio.
struct Elastic {
    young: Property,
    poisson: Property,
    /// [K]
    initial_temperature: f64,
}

impl Elastic {
    /// `E/(1 − ν²)` at a temperature [Pa].
    fn plane_modulus(&self, temperature: f64) -> f64 {
        let poisson = self.poisson.value(temperature);
        self.young.value(temperature) / (1.0 - poisson * poisson)
    }

    fn is_constant(&self) -> bool {
        self.young.is_constant() && self.poisson.is_constant()
    }
}

/// Extent of a crack.
enum Extent {
    /// Weights of the points in K [√m].
    Given { depth: f64, weights: Vec<f64> },
    /// Depths with the weights of the points for each.
    Searched { line: Line, trials: Trials },
    /// As searched, from a depth on.
    Growing { start: f64, line: Line, trials: Trials, law: CrackGrowth },
}

/// Depths [m], each with the weights of the points in K [√m].
type Trials = Vec<(f64, Vec<f64>)>;

/// A crack that grows slowly, from a depth [m] on.
pub struct Growing<'c> {
    pub name: &'c str,
    pub start: f64,
    pub line: &'c Line,
    pub trials: &'c [(f64, Vec<f64>)],
    pub law: CrackGrowth,
    /// [Pa √m]
    pub toughness: f64,
}

/// Distances from the mouth of an edge crack at which stress is taken [m].
pub struct Line {
    /// Ends of elements, from 0 on.
    ends: Vec<f64>,
    /// Points of an element, its ends included.
    order: usize,
    /// Distance of equal cracks beside it [m], of one in a row.
    spacing: Option<f64>,
}

/// A flaw that the mesh does not resolve.
pub struct Coarse<'c> {
    pub name: &'c str,
    /// Number of elements over its depth.
    pub elements: f64,
    /// Distance of nodes that would be fine enough [m].
    pub finer: f64,
}

/// Stress intensity [Pa √m] and depth [m] of a flaw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Intensity {
    pub value: f64,
    pub depth: f64,
}

impl Line {
    /// The line through these ends of elements [m], ascending from zero.
    #[cfg(test)]
    pub fn new(ends: Vec<f64>, order: usize) -> Self {
        Self { ends, order, spacing: None }
    }

    /// Its depth [m].
    pub fn end(&self) -> f64 {
        self.ends.last().copied().unwrap_or_default()
    }

    /// Number of its points.
    pub fn count(&self) -> usize {
        self.order * (self.ends.len() - 1) + 1
    }

    /// The line from the mouth of a flaw to a depth [m].
    fn of(mesh: &Mesh, flaw: &Flaw, inward: [f64; 3], depth: f64) -> Self {
        let mut ends = vec![0.0];
        let all = element_ends(mesh, flaw.at, inward).into_iter();
        ends.extend(all.filter(|&end| end < depth * (1.0 - ROUNDING)));
        ends.push(depth);
        Self { ends, order: mesh.order(), spacing: flaw.spacing }
    }

    /// Distances of all points.
    pub fn distances(&self) -> Vec<f64> {
        let of_element = |pair: &[f64]| {
            let (from, length) = (pair[0], pair[1] - pair[0]);
            let inner = move |i: usize| from + length * i as f64 / self.order as f64;
            (0..self.order).map(inner).collect::<Vec<_>>()
        };
        let last = self.ends.last().copied();
        self.ends.windows(2).flat_map(of_element).chain(last).collect()
    }

    /// Weights of the points in K of an edge crack of a depth [√m].
    pub fn weights(&self, depth: f64) -> Vec<f64> {
        let distances = self.distances();
        let mut weights = vec![0.0; distances.len()];
        let mut add = |element: usize, place: f64, weight: f64| {
            let first = element * self.order;
            let shares = interpolation_weights(&distances[first..=first + self.order], place);
            let own = weights[first..].iter_mut().zip(shares);
            own.for_each(|(sum, share)| *sum += weight * share);
        };
        if let Some(spacing) = self.spacing {
            let inner = &self.ends[1..self.ends.len() - 1];
            let points = crack_row(depth, spacing).into_iter();
            let element = |place: f64| inner.partition_point(|&end| end <= place);
            points.for_each(|(place, weight)| add(element(place), place, weight));
            return weights;
        }
        for (element, pair) in self.ends.windows(2).enumerate() {
            let angle = |distance: f64| (distance / depth).min(1.0).asin();
            if pair[0] >= depth {
                break;
            }
            for (angle, part) in gauss_on(POINTS, angle(pair[0]), angle(pair[1])) {
                let x = angle.sin();
                let weight = 2.0 * (depth / PI).sqrt() * (1.3 - 0.3 * x.powf(1.25)) * part;
                add(element, x * depth, weight);
            }
        }
        weights
    }

    /// Depths that are tried.
    pub fn trials(&self) -> Vec<f64> {
        let of_element = |pair: &[f64]| {
            let [from, to] = [pair[0], pair[1]];
            (1..=TRIALS).map(move |i| from + (to - from) * i as f64 / TRIALS as f64)
        };
        self.ends.windows(2).flat_map(of_element).collect()
    }

    /// Depths above the first of these, halves of each other: stress may peak at the mouth, within the first element.
    fn shallow_trials(&self) -> Vec<f64> {
        let first = self.ends[1] / TRIALS as f64;
        (1..=HALVINGS).rev().map(|halving| first * 0.5_f64.powi(halving)).collect()
    }
}

impl Crack {
    /// Flaws of a scene's solid, each with its place among the scene's.
    pub fn of_scene(
        scene: &Scene,
        (name, solid): (&str, &Solid),
        plan: &Plan,
    ) -> Vec<(usize, Self)> {
        let own = scene.flaw.iter().enumerate().filter(|(_, flaw)| flaw.body == name);
        // A mesh that resolves the heat of a step resolves its stress, also along shallower flaws.
        let is_fine = plan.resolved_from <= scene.step;
        let of = |(place, flaw): (usize, &Flaw)| {
            let own = Self::of(flaw, solid, plan)?;
            let elements = own.elements.filter(|_| !is_fine);
            Some((place, Self { elements, ..own }))
        };
        own.filter_map(of).collect()
    }

    /// Returns `None` for an edge crack away from faces, which a checked scene excludes.
    fn of(flaw: &Flaw, solid: &Solid, plan: &Plan) -> Option<Self> {
        let flaw = &flaw.settled(solid);
        let [x, y, z] = flaw.unit_normal();
        let across = [x * x, y * y, z * z, 2.0 * x * y, 2.0 * y * z, 2.0 * x * z];
        let layer = flaw.layer(solid);
        let material = solid.materials_of_layers()[layer];
        let Elasticity { young, poisson, .. } = material.law.deformation().elasticity().clone();
        let initial_temperature = solid.initial_temperature;
        let elastic = Elastic { young: young?, poisson: poisson?, initial_temperature };
        let toughness = material.fracture.toughness.unwrap_or(0.0);
        let (points, extent, front, elements) = match flaw.shape {
            FlawShape::Penny => {
                let radius = flaw.depth.given()?;
                let (points, extent) =
                    penny(flaw, radius, radii_of_penny(&plan.mesh, flaw, radius));
                (points, extent, Front::Rim(rim(flaw, radius).collect()), None)
            }
            FlawShape::Edge => {
                let face = flaw.face(&solid.shape)?;
                let inward = flaw.inward(face);
                let (points, extent) = edge(flaw, solid, plan, face);
                let front = Front::Tip { mouth: flaw.at, inward };
                (points, extent, front, Some(element_ends(&plan.mesh, flaw.at, inward)))
            }
        };
        let name = flaw.name.clone();
        Some(Self { name, across, points, extent, front, elastic, toughness, elements })
    }

    /// K of a given depth as a sum of stress components; `None` if the depth is searched.
    pub fn functional(&self, solid: &SolidFem) -> Option<Functional> {
        let Extent::Given { weights, .. } = &self.extent else { return None };
        let of_slot = |slot: usize| {
            let factor = self.across[slot];
            let weighted = self.points.iter().zip(weights);
            let weighted = weighted.map(|(point, weight)| (*point, factor * weight));
            let points: Vec<_> = weighted.filter(|(_, weight)| *weight != 0.0).collect();
            solid.functional(Component::Stress(slot), &points).terms
        };
        Some(Functional { terms: (0..6).flat_map(of_slot).collect() })
    }

    /// Returns the crack as one that grows; `None` if it does not.
    pub fn growing(&self) -> Option<Growing<'_>> {
        let Extent::Growing { start, line, trials, law } = &self.extent else { return None };
        let (name, toughness) = (&self.name, self.toughness);
        Some(Growing { name, start: *start, line, trials, law: *law, toughness })
    }

    /// Returns the name of a crack whose depth is searched, and the largest depth [m].
    pub fn searched(&self) -> Option<(&str, f64)> {
        let Extent::Searched { line, .. } = &self.extent else { return None };
        Some((&self.name, line.end()))
    }

    /// Stress intensity of one that grows, at a depth [m] that it has reached.
    pub fn at_depth(&self, reader: &mut SolidReader, depth: f64) -> Result<Intensity, BodyError> {
        let Some(Growing { line, .. }) = self.growing() else {
            return Err(BodyError::NoSuchReading);
        };
        let value = dot(&line.weights(depth), &self.stresses(reader)?);
        Ok(Intensity { value: value.max(0.0), depth })
    }

    /// Returns the elements over the depth that is given, or from which the crack grows, if they are too few for the
    /// stress there.
    pub fn too_few_elements(&self) -> Option<Coarse<'_>> {
        match self.extent {
            Extent::Given { depth, .. } | Extent::Growing { start: depth, .. } => {
                self.too_few_elements_over(depth)
            }
            Extent::Searched { .. } => None,
        }
    }

    /// The same over a depth that was found [m]; `None` where the crack is closed.
    pub fn too_few_elements_over(&self, depth: f64) -> Option<Coarse<'_>> {
        let elements = elements_over(self.elements.as_ref()?, depth);
        (depth > 0.0 && elements < LEAST_ELEMENTS).then(|| Coarse {
            name: &self.name,
            elements,
            finer: depth / (2.0 * LEAST_ELEMENTS),
        })
    }

    /// Energy release rate `G = K²(1 − ν²)/E` of plane strain [J/m²], with constants at the present temperature of the
    /// front, the mean one of the rim of a penny.
    pub fn energy_release_rate(&self, reader: &mut SolidReader, intensity: Intensity) -> f64 {
        let Intensity { value, depth } = intensity;
        value * value / self.elastic.plane_modulus(self.temperature(reader, depth))
    }

    /// Rate of change of the energy release rate of a crack with constants of elasticity that are no tables.
    pub fn energy_release_change(&self, intensity: f64, rate: f64) -> f64 {
        2.0 * intensity * rate / self.elastic.plane_modulus(self.elastic.initial_temperature)
    }

    /// Temperature of the front at a depth, at which constants are taken [K].
    fn temperature(&self, reader: &mut SolidReader, depth: f64) -> f64 {
        let initial = self.elastic.initial_temperature;
        if self.elastic.is_constant() {
            return initial;
        }
        let rise = match &self.front {
            Front::Tip { mouth, inward } => reader.rise_at(below(*mouth, *inward, depth), false),
            Front::Rim(points) => {
                let rises = points.iter().map(|&point| reader.rise_at(point, false));
                rises.sum::<f64>() / points.len() as f64
            }
        };
        initial + rise
    }

    /// Toughness over stress intensity.
    pub fn safety(&self, intensity: f64) -> f64 {
        if intensity * SAFEST <= self.toughness { SAFEST } else { self.toughness / intensity }
    }

    /// Rate of change of the safety.
    pub fn safety_change(&self, intensity: f64, rate: f64) -> f64 {
        match intensity * SAFEST <= self.toughness {
            true => 0.0,
            false => -self.toughness / (intensity * intensity) * rate,
        }
    }

    /// Stress across the plane at all points [Pa].
    pub fn stresses(&self, reader: &mut SolidReader) -> Result<Vec<f64>, BodyError> {
        let across = |point: &[f64; 3]| {
            let stress = reader.stress_at(*point)?;
            Ok(self.across.iter().zip(stress).map(|(factor, own)| factor * own).sum())
        };
        self.points.iter().map(across).collect()
    }

    /// The stress intensity of a given depth as a sum over nodes; `None` if the depth is searched or grows, or if the
    /// sum is over more than the nodes of one image.
    pub fn nodal_sum(&self, solid: &SolidFem) -> Option<NodalSum> {
        let Extent::Given { weights, .. } = &self.extent else { return None };
        solid.nodal_sum(&self.points, weights, self.across)
    }

    /// Stress intensity of a given depth, negative in compression, from a solution.
    pub fn signed(&self, reader: &mut SolidReader) -> Result<Option<f64>, BodyError> {
        let Extent::Given { weights, .. } = &self.extent else { return Ok(None) };
        Ok(Some(dot(weights, &self.stresses(reader)?)))
    }

    /// Stress intensity of a given depth, from its signed value.
    pub fn opened(&self, signed: f64) -> Intensity {
        let depth = match &self.extent {
            Extent::Given { depth, .. } => *depth,
            Extent::Searched { .. } | Extent::Growing { .. } => 0.0,
        };
        Intensity { value: signed.max(0.0), depth }
    }

    /// Highest stress intensity of all depths, and that depth; zero if the crack is closed at any depth.
    pub fn worst(&self, reader: &mut SolidReader) -> Result<Intensity, BodyError> {
        let Extent::Searched { line, trials } = &self.extent else {
            return Err(BodyError::NoSuchReading);
        };
        let stresses = self.stresses(reader)?;
        let tried: Vec<f64> = trials.iter().map(|(_, weights)| dot(weights, &stresses)).collect();
        let mut best = Intensity { value: 0.0, depth: 0.0 };
        let Some(place) = (0..tried.len()).max_by(|&a, &b| tried[a].total_cmp(&tried[b])) else {
            return Ok(best);
        };
        if tried[place] <= 0.0 {
            return Ok(best);
        }
        best = Intensity { value: tried[place], depth: trials[place].0 };
        // The vertex of the parabola through the best trial and its neighbours; no crack is that of the first one.
        if place + 1 < tried.len() {
            let at = |i: usize| (trials[i].0, tried[i]);
            let before = place.checked_sub(1).map_or((0.0, 0.0), at);
            let depth = vertex(before, at(place), at(place + 1));
            let value = dot(&line.weights(depth), &stresses);
            if value > best.value {
                best = Intensity { value, depth };
            }
        }
        Ok(best)
    }
}

/// Points of an edge crack, and its extent.
fn edge(flaw: &Flaw, solid: &Solid, plan: &Plan, face: FaceName) -> (Vec<[f64; 3]>, Extent) {
    let inward = flaw.inward(face);
    let given = flaw.depth.given();
    let reach = given.filter(|_| flaw.growth.is_none());
    let reach = reach.unwrap_or_else(|| flaw.reach(solid, face));
    let line = Line::of(&plan.mesh, flaw, inward, reach);
    let points = line.distances().into_iter().map(|distance| below(flaw.at, inward, distance));
    let points = points.collect();
    let weighted = |line: &Line, depths: Vec<f64>| {
        depths.into_iter().map(|depth| (depth, line.weights(depth))).collect()
    };
    let extent = match (given, flaw.growth) {
        (Some(depth), None) => Extent::Given { depth, weights: line.weights(depth) },
        (Some(start), Some(law)) => {
            let trials = weighted(&line, line.trials());
            Extent::Growing { start, trials, line, law }
        }
        (None, _) => {
            let trials = weighted(&line, [line.shallow_trials(), line.trials()].concat());
            Extent::Searched { trials, line }
        }
    };
    (points, extent)
}

/// The point at a distance from the mouth of an edge crack. On an interface the layer above counts, so the deepest point
/// stays within its own.
fn below(mouth: [f64; 3], inward: [f64; 3], distance: f64) -> [f64; 3] {
    let inside = 1.0 - 1e-12;
    std::array::from_fn(|i| mouth[i] + inside * distance * inward[i])
}

/// Points of the rim of a penny.
fn rim(flaw: &Flaw, radius: f64) -> impl Iterator<Item = [f64; 3]> {
    (0..RIM).map(move |turn| flaw.on_plane(radius, turn as f64 / RIM as f64))
}

/// Distances from the mouth of an edge crack, above zero and ascending, at which elements end [m].
fn element_ends(mesh: &Mesh, at: [f64; 3], inward: [f64; 3]) -> Vec<f64> {
    let axis = (0..3).fold(
        0,
        |most, axis| {
            if inward[axis].abs() > inward[most].abs() { axis } else { most }
        },
    );
    let is_radial = mesh.geometry == Geometry::Axisymmetric && axis < 2;
    let own = &mesh.axes[if is_radial { 0 } else { axis }];
    let (start, way) = match is_radial {
        true => (own.end(), -1.0),
        false => (at[axis], inward[axis]),
    };
    let continues = is_radial || axis < 2 && mesh.mirrored[axis];
    let nodes = own.nodes.iter().step_by(own.order).copied();
    let images = nodes.clone().filter(|_| continues).map(|node| -node);
    let distances = nodes.chain(images).map(|node| (node - start) * way);
    let least = ROUNDING * (own.end() - own.start());
    let mut ends: Vec<f64> = distances.filter(|&distance| distance > least).collect();
    ends.sort_by(f64::total_cmp);
    ends.dedup_by(|b, a| *b - *a <= least);
    ends
}

/// Number of elements over a depth, the last one in part, by their ends.
fn elements_over(ends: &[f64], depth: f64) -> f64 {
    let complete = ends.partition_point(|&end| end <= depth);
    let last = if complete == 0 { 0.0 } else { ends[complete - 1] };
    complete as f64 + ends.get(complete).map_or(0.0, |next| (depth - last) / (next - last))
}

/// Number of radii at which a penny of a radius has points, by the finest elements that it crosses.
fn radii_of_penny(mesh: &Mesh, flaw: &Flaw, radius: f64) -> usize {
    let places: Vec<_> =
        rim(flaw, radius).chain([flaw.at]).map(|point| mesh.locate(point).0).collect();
    let elements_along = |axis: usize| {
        let along = places.iter().map(|place| place[axis]);
        let low = along.clone().fold(f64::INFINITY, f64::min);
        let high = along.fold(f64::NEG_INFINITY, f64::max);
        let own = &mesh.axes[axis];
        let bounds = (0..own.elements()).map(|element| own.bounds(element));
        let crossed = bounds.filter(|[from, to]| *from < high && *to > low);
        let finest = crossed.map(|[from, to]| to - from).fold(f64::INFINITY, f64::min);
        0.5 * (high - low) / finest
    };
    let elements = (0..3).map(elements_along).fold(0.0, f64::max);
    let [least, most] = RADII;
    ((RADII_OF_ELEMENTS * elements.sqrt()).ceil() as usize).clamp(least, most)
}

/// Points of a penny of a radius, at a number of radii, and its extent.
fn penny(flaw: &Flaw, radius: f64, radii: usize) -> (Vec<[f64; 3]>, Extent) {
    let (mut points, mut weights) = (Vec::new(), Vec::new());
    let angles = 2 * radii;
    for (angle, part) in gauss_on(radii, 0.0, FRAC_PI_2) {
        let weight = 2.0 * (radius / PI).sqrt() * angle.sin() * part / angles as f64;
        for turn in 0..angles {
            let turn = (turn as f64 + 0.5) / angles as f64;
            points.push(flaw.on_plane(radius * angle.sin(), turn));
            weights.push(weight);
        }
    }
    (points, Extent::Given { depth: radius, weights })
}

pub fn dot(weights: &[f64], values: &[f64]) -> f64 {
    weights.iter().zip(values).map(|(weight, value)| weight * value).sum()
}

/// Abscissa of the vertex of the parabola through three points, the middle one of which is highest.
fn vertex((xa, a): (f64, f64), (xb, b): (f64, f64), (xc, c): (f64, f64)) -> f64 {
    let (left, right) = ((b - a) / (xb - xa), (c - b) / (xc - xb));
    let curvature = (right - left) / (xc - xa);
    if curvature < 0.0 { 0.5 * (xa + xb) - 0.5 * left / curvature } else { xb }
}

#[cfg(test)]
mod tests {
    use super::{Line, dot, vertex};
    use crate::closed_form::edge_crack::edge;

    #[test]
    fn weights_integrate_parabolas_over_the_crack() {
        let line = Line::new(vec![0.0, 0.2, 0.5, 1.1, 2.0], 2);
        let distances = line.distances();
        for depth in [0.1, 0.5, 0.77, 2.0] {
            let stresses: Vec<f64> = distances.iter().map(|z| 3.0 - z + 0.4 * z * z).collect();
            let found = dot(&line.weights(depth), &stresses);
            let wanted = edge(depth, |z| 3.0 - z + 0.4 * z * z);
            assert!((found / wanted - 1.0).abs() < 1e-6, "{depth}: {found} {wanted}");
        }
    }

    #[test]
    fn vertices_of_parabolas_are_found_at_unequal_distances() {
        let at = |x: f64| (x, 2.0 - (x - 1.3).powi(2));
        assert!((vertex(at(0.5), at(1.0), at(2.5)) - 1.3).abs() < 1e-12);
    }
}
