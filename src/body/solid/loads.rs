//! Converts inputs to the loads on a body.

use std::ops::Range;

use crate::body::BodyError;
use crate::channel::{Channel, Direction};
use crate::coupling::{Pattern, Placement, split_load};
use crate::inputs::{FaceInputKind, InputLayout, InputPath, LoadInputs};
use crate::method::fem::{Geometry, Mesh, Parity, Plan, SolidLoads};
use crate::scene::{FaceName, Load, Scene, Shape};

/// Inputs that act on a body, with their places.
pub struct BodyLoads {
    /// Each load and the places of its inputs.
    loads: Vec<(Load, LoadInputs)>,
    /// For each thermal face of the plan: its axis, and the inputs of that face and of its mirror image.
    faces: Vec<(usize, FaceValue, Option<FaceValue>)>,
    initial_temperature: f64,
    shape: Shape,
}

/// An input that is the value of a thermal face.
#[derive(Debug, Clone, Copy)]
struct FaceValue {
    index: usize,
    kind: FaceInputKind,
}

impl BodyLoads {
    pub fn of(
        scene: &Scene,
        layout: &InputLayout,
        (body, shape): (&str, Shape),
        plan: &Plan,
    ) -> Self {
        let loads = scene.load.iter().zip(&layout.loads);
        let loads = loads
            .filter(|(load, _)| load.body_and_face().0 == body)
            .map(|(load, inputs)| (load.clone(), inputs.clone()))
            .collect();
        let value = |face: FaceName| {
            let own = |name| layout.faces.iter().find(|f| f.body == body && f.face == name);
            let input = own(face).or_else(|| own(FaceName::Sides))?;
            Some(FaceValue { index: input.index, kind: input.kind })
        };
        let sources = plan.thermal_faces.iter().zip(&plan.face_sources);
        let faces = sources
            .map(|((place, _), (face, image))| {
                let face = value(*face).expect("a thermal face has an input");
                (place.axis, face, image.and_then(value))
            })
            .collect();
        let initial_temperature = plan.initial_temperature;
        Self { loads, faces, initial_temperature, shape }
    }

    /// Refuses inputs that make no sense for this body.
    pub fn check(&self, inputs: &[f64]) -> Result<(), BodyError> {
        for (_, face, image) in &self.faces {
            for value in [Some(face), image.as_ref()].into_iter().flatten() {
                let given = inputs[value.index];
                if value.kind != FaceInputKind::Flux && given <= 0.0 {
                    let message = format!("{given} K is not above absolute zero");
                    return Err(BodyError::Input { index: value.index, message });
                }
            }
        }
        for (load, places) in &self.loads {
            self.check_place(load, places, inputs)?;
        }
        Ok(())
    }

    /// Returns true if any heat flux points out of the body.
    pub fn draws_heat(&self, inputs: &[f64]) -> bool {
        let amounts = self.loads.iter().flat_map(|(_, places)| places.amounts.iter().cloned());
        let mut fluxes = amounts.filter(|(channel, _)| channel.is_heat()).map(|(_, range)| range);
        let faces = self.faces.iter().flat_map(|(_, face, image)| [Some(face), image.as_ref()]);
        fluxes.any(|range| inputs[range].iter().any(|&flux| flux < 0.0))
            || faces.flatten().any(|f| f.kind == FaceInputKind::Flux && inputs[f.index] < 0.0)
    }

    /// Prescribed temperatures of faces [K].
    pub fn temperatures_of_faces<'a>(
        &'a self,
        inputs: &'a [f64],
    ) -> impl Iterator<Item = f64> + 'a {
        let faces = self.faces.iter().flat_map(|(_, face, image)| [Some(face), image.as_ref()]);
        let held = faces.flatten().filter(|face| face.kind == FaceInputKind::Temperature);
        held.map(|face| inputs[face.index])
    }

    /// Values of the thermal faces alone, which temperatures follow without delay.
    pub fn of_faces(&self, inputs: &[f64], mesh: &Mesh) -> SolidLoads {
        let faces = self.face_values(inputs, self.initial_temperature, mesh);
        SolidLoads { faces, ..SolidLoads::default() }
    }

    /// Assembles the loads of these inputs; heat and forces have meshes of their own.
    pub fn assemble(&self, inputs: &[f64], meshes: [&Mesh; 2]) -> SolidLoads {
        let faces = self.face_values(inputs, self.initial_temperature, meshes[0]);
        self.sum(meshes, faces, Asked::Value(inputs))
    }

    /// Rate of the result of [`assemble`](Self::assemble) when the inputs change at `rates`. It is exact for amounts
    /// and for places of footprints.
    pub fn change(&self, inputs: &[f64], rates: &[f64], meshes: [&Mesh; 2]) -> SolidLoads {
        let faces = self.face_values(rates, 0.0, meshes[0]);
        self.sum(meshes, faces, Asked::Change { inputs, rates })
    }

    /// Largest distance, in units of its own least size, by which any footprint moves or grows in a time `dt` [s].
    pub fn travel(&self, path: &InputPath, dt: f64) -> f64 {
        let extremes = extremes(path, dt);
        let way = |at: usize| {
            let mut weight = 1.0;
            let parts = path.derivatives().iter().enumerate().skip(1).map(|(k, list)| {
                weight *= dt / k as f64;
                weight * list[at].abs()
            });
            parts.sum::<f64>()
        };
        let travel = |(load, places): &(Load, LoadInputs)| {
            let moved = [places.x, places.y, places.radius].into_iter().flatten();
            // A radius that is not positive is refused where loads are sampled.
            let radii = radii(load, places, &extremes).filter(|&radius| radius > 0.0);
            let least = radii.fold(f64::INFINITY, f64::min);
            let size = load.footprint.finest(least.is_finite().then_some(least));
            moved.map(way).sum::<f64>() / size
        };
        self.loads.iter().map(travel).fold(0.0, f64::max)
    }

    /// Largest ratio of two radii of any footprint within a time `dt` [s]. Those whose radius is not positive at some
    /// time, which are refused where loads are sampled, do not count.
    pub fn ratio_of_radii(&self, path: &InputPath, dt: f64) -> f64 {
        let extremes = extremes(path, dt);
        let ratio = |(load, places): &(Load, LoadInputs)| {
            let least = radii(load, places, &extremes).fold(f64::INFINITY, f64::min);
            let largest = radii(load, places, &extremes).fold(0.0, f64::max);
            if least > 0.0 { largest / least } else { 1.0 }
        };
        self.loads.iter().map(ratio).fold(1.0, f64::max)
    }

    /// Adds the parts of all loads to the values of faces.
    fn sum(&self, meshes: [&Mesh; 2], faces: Vec<Vec<f64>>, asked: Asked) -> SolidLoads {
        let [mesh, _] = meshes;
        let classes = mesh.parities().len();
        let components = if mesh.geometry == Geometry::Box { 3 } else { 2 };
        let mut out = SolidLoads {
            heat: vec![[Vec::new(), Vec::new()]; classes],
            force: vec![[vec![Vec::new(); components], vec![Vec::new(); components]]; classes],
            faces,
        };
        for (load, places) in &self.loads {
            let top = usize::from(load.body_and_face().1 == FaceName::Top);
            for part in self.parts(load, places, asked, meshes) {
                for (class, vector) in part.vectors.into_iter().enumerate() {
                    let target = match part.component {
                        None => &mut out.heat[class][top],
                        Some(component) => &mut out.force[class][top][component],
                    };
                    add(target, &vector, part.sign);
                }
            }
        }
        out
    }

    /// Values of the thermal faces, temperatures above `base`.
    fn face_values(&self, inputs: &[f64], base: f64, mesh: &Mesh) -> Vec<Vec<f64>> {
        let read = |value: &FaceValue| match value.kind {
            FaceInputKind::Flux => inputs[value.index],
            _ => inputs[value.index] - base,
        };
        let parts = |parity: &Parity| {
            let of_face = |&(axis, ref face, ref image): &(usize, FaceValue, Option<FaceValue>)| {
                let Some(image) = image else {
                    return if parity.is_even() { read(face) } else { 0.0 };
                };
                // The faces across a mirrored axis: half their sum is even, half their
                // difference odd about that axis alone.
                match (parity.odd[axis], parity.odd[1 - axis]) {
                    (_, true) => 0.0,
                    (false, false) => 0.5 * (read(face) + read(image)),
                    (true, false) => 0.5 * (read(face) - read(image)),
                }
            };
            self.faces.iter().map(of_face).collect()
        };
        mesh.parities().iter().map(parts).collect()
    }

    /// Returns the nodal vectors of a load, each with its component and sign.
    fn parts(
        &self,
        load: &Load,
        places: &LoadInputs,
        asked: Asked,
        [of_heat, of_force]: [&Mesh; 2],
    ) -> Vec<Part> {
        let top = load.body_and_face().1 == FaceName::Top;
        let round = of_heat.geometry == Geometry::Axisymmetric;
        type Amount = (Channel, Range<usize>);
        let vectors = |mesh, quantity: Quantity, (channel, range): &Amount| match asked {
            Asked::Value(inputs) => {
                let place = placement(load, places, inputs);
                let [density, _] = load.density(*channel, place.radius);
                let values: Vec<f64> =
                    inputs[range.clone()].iter().map(|value| value * density).collect();
                still(mesh, load, quantity, &place, &values)
            }
            Asked::Change { inputs, rates } => {
                let place = placement(load, places, inputs);
                let motion = placement_rate(places, rates);
                let [density, by_radius] = load.density(*channel, place.radius);
                let values = inputs[range.clone()].iter();
                let rate = |(value, rate): (&f64, &f64)| {
                    rate * density + value * by_radius * motion.radius
                };
                let change: Vec<f64> =
                    values.clone().zip(&rates[range.clone()]).map(rate).collect();
                let values: Vec<f64> = values.map(|value| value * density).collect();
                let grown = still(mesh, load, quantity, &place, &change);
                both(grown, moving(mesh, load, quantity, (&place, &motion), &values))
            }
        };
        let axial = if round { 1 } else { 2 };
        // Pressure acts into the body: down on the top, up on the bottom.
        let inward = if top { -1.0 } else { 1.0 };
        let mut parts = Vec::new();
        let mut push = |amount, component: Option<usize>, sign, pattern, flips| {
            let mesh = if component.is_none() { of_heat } else { of_force };
            let vectors = vectors(mesh, (pattern, flips), amount);
            parts.push(Part { component, sign, vectors });
        };
        let none = [false; 2];
        let across = [0, 1].map(|axis| [axis == 0, axis == 1]);
        for amount in &places.amounts {
            match amount.0.direction() {
                Direction::Heat => push(amount, None, 1.0, Pattern::Scalar, none),
                Direction::Inward => push(amount, Some(axial), inward, Pattern::Scalar, none),
                Direction::Along(axis) => {
                    push(amount, Some(axis), 1.0, Pattern::Scalar, across[axis]);
                }
                Direction::Outward => {
                    let axes = across.into_iter().take(if round { 1 } else { 2 });
                    for (axis, flips) in axes.enumerate() {
                        push(amount, Some(axis), 1.0, Pattern::Outward(axis), flips);
                    }
                }
            }
        }
        parts
    }

    fn check_place(
        &self,
        load: &Load,
        places: &LoadInputs,
        inputs: &[f64],
    ) -> Result<(), BodyError> {
        let named = [
            (places.x, load.range.x),
            (places.y, load.range.y),
            (places.radius, load.range.radius),
        ];
        for (at, range) in named {
            let Some([low, high]) = range else { continue };
            // A path may end with a rounding error.
            let slack = ROUNDING * (high - low);
            if let Some(index) = at
                && !(low - slack..=high + slack).contains(&inputs[index])
            {
                let message = format!(
                    "{} m is outside the range of {} (allowed: {low} to {high} m)",
                    inputs[index], load.name
                );
                return Err(BodyError::Input { index, message });
            }
        }
        let place = placement(load, places, inputs);
        if let Some(index) = places.radius
            && place.radius <= 0.0
        {
            let message = format!("a radius of {} m; allowed: above zero", place.radius);
            return Err(BodyError::Input { index, message });
        }
        let half = load.footprint.half_extents(Some(place.radius));
        let limits = match self.shape {
            Shape::Box([x, y, _]) => [x / 2.0, y / 2.0],
            Shape::Disc(disc) => [disc.radius; 2],
        };
        let centres = [(place.x, places.x), (place.y, places.y)];
        for axis in 0..2 {
            let (centre, input) = centres[axis];
            let room = limits[axis] * (1.0 + ROUNDING);
            if centre.abs() + half[axis] > room {
                // A footprint that fits nowhere is too large, whatever its place.
                let at_fault = match half[axis] > room {
                    true => places.radius.or(input),
                    false => input.or(places.radius),
                };
                let index = at_fault.unwrap_or_default();
                let message = format!(
                    "the footprint of {} (centre {centre} m, half width {} m) leaves its face \
                     (allowed: within ±{} m)",
                    load.name, half[axis], limits[axis]
                );
                return Err(BodyError::Input { index, message });
            }
        }
        Ok(())
    }
}

/// Share of a length by which a place may exceed its limits.
const ROUNDING: f64 = 1e-9;

/// Nodal vectors of one quantity of a load, one for each symmetry class.
struct Part {
    /// Displacement component that the force acts on; heat if none.
    component: Option<usize>,
    sign: f64,
    vectors: Vec<Vec<f64>>,
}

/// Requested result of a load: its value under these inputs, or its rate of change.
#[derive(Clone, Copy)]
enum Asked<'a> {
    Value(&'a [f64]),
    Change { inputs: &'a [f64], rates: &'a [f64] },
}

/// Pattern of a quantity over its footprint, and axes along which a mirror reverses its sign.
type Quantity = (Pattern, [bool; 2]);

/// Nodal vectors, one for each symmetry class, of values on a footprint at rest; none if all are zero.
fn still(
    mesh: &Mesh,
    load: &Load,
    (pattern, flips): Quantity,
    place: &Placement,
    values: &[f64],
) -> Vec<Vec<f64>> {
    if values.iter().all(|&v| v == 0.0) {
        return Vec::new();
    }
    if mesh.geometry == Geometry::Axisymmetric {
        return vec![pattern.on_radius(&mesh.axes[0], &load.footprint, place.radius, values)];
    }
    let plane = [&mesh.axes[0], &mesh.axes[1]];
    split_load(mesh, flips, |image| pattern.on_plane(plane, &load.footprint, place, values, image))
}

/// Rate of [`still`] while its place changes.
fn moving(
    mesh: &Mesh,
    load: &Load,
    (pattern, flips): Quantity,
    (place, rate): (&Placement, &Placement),
    values: &[f64],
) -> Vec<Vec<f64>> {
    let rests = *rate == Placement { x: 0.0, y: 0.0, radius: 0.0 };
    if rests || values.iter().all(|&v| v == 0.0) {
        return Vec::new();
    }
    if mesh.geometry == Geometry::Axisymmetric {
        let growth = [place.radius, rate.radius];
        return vec![pattern.growth_on_radius(&mesh.axes[0], &load.footprint, growth, values)];
    }
    let plane = [&mesh.axes[0], &mesh.axes[1]];
    split_load(mesh, flips, |image| {
        pattern.motion_on_plane(plane, &load.footprint, (place, rate), values, image)
    })
}

/// Sum of two lists of vectors, class by class; an empty list or vector is zero.
fn both(mut a: Vec<Vec<f64>>, b: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    a.resize(a.len().max(b.len()), Vec::new());
    for (target, vector) in a.iter_mut().zip(&b) {
        add(target, vector, 1.0);
    }
    a
}

/// Inputs at the beginning, the end and the extremes of a time `dt` [s].
fn extremes(path: &InputPath, dt: f64) -> Vec<Vec<f64>> {
    let times = [0.0, dt].into_iter().chain(path.turns(dt));
    times.map(|s| path.at(0, s)).collect()
}

/// Radius of a footprint under each of these inputs [m].
fn radii(load: &Load, places: &LoadInputs, inputs: &[Vec<f64>]) -> impl Iterator<Item = f64> {
    inputs.iter().map(|inputs| placement(load, places, inputs).radius)
}

fn placement(load: &Load, places: &LoadInputs, inputs: &[f64]) -> Placement {
    let read = |at: Option<usize>, other: f64| at.map_or(other, |index| inputs[index]);
    Placement {
        x: read(places.x, 0.0),
        y: read(places.y, 0.0),
        radius: read(places.radius, load.footprint.radius().unwrap_or(0.0)),
    }
}

/// Rate of change of a place with the inputs.
fn placement_rate(places: &LoadInputs, rates: &[f64]) -> Placement {
    let read = |at: Option<usize>| at.map_or(0.0, |index| rates[index]);
    Placement { x: read(places.x), y: read(places.y), radius: read(places.radius) }
}

/// Adds a nodal vector to another, either of which may be empty.
pub fn add(target: &mut Vec<f64>, vector: &[f64], sign: f64) {
    if vector.is_empty() {
        return;
    }
    if target.is_empty() {
        target.resize(vector.len(), 0.0);
    }
    for (t, v) in target.iter_mut().zip(vector) {
        *t += sign * v;
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::body::solid::plan;
    use crate::inputs::InputLayout;
    use crate::method::fem::heat_mesh;
    use crate::scene;

    const POWER: f64 = 3.0;

    pub fn loads(shape: &str, footprint: &str, place: &str) -> (BodyLoads, Mesh) {
        let text = format!(
            "name = \"Loads\"\nstop_time = 1.0\nstep = 0.1\n[body.block]\nkind = \"solid\"\nshape = {{ {shape} }}\n\
             material = {{ model = \"thermoelastic\", density = 2.0, specific_heat = 3.0, conductivity = 5.0 }}\ninitial_temperature = 300.0\n\
             mesh = {{ spacing = 0.1 }}\n[[load]]\nname = \"beam\"\non = \"block.top\"\n\
             footprint = {{ {footprint} }}\ncarries = [\"power\"]\n{place}\n"
        );
        let scene = scene::parse(&text, "scene.toml").unwrap();
        let solid = scene.solid("block").unwrap();
        let plan = plan(&scene, "block", solid);
        let layout = InputLayout::of(&scene);
        (BodyLoads::of(&scene, &layout, ("block", solid.shape), &plan), heat_mesh(&plan))
    }

    pub const BOX: &str = "box = [2.0, 1.6, 0.5]";
    const ROUND: &str = "disc = { radius = 1.0, thickness = 0.5 }";

    fn cases() -> Vec<(BodyLoads, Mesh, Vec<f64>, Vec<f64>)> {
        let mut cases = Vec::new();
        for footprint in [
            "disc = { radius = 0.3 }",
            "gaussian = { radius = 0.3 }",
            "ring = { inner = 0.1, outer = 0.3 }",
        ] {
            let off = "range = { x = [-0.2, 0.2] }";
            let (of_box, mesh) = loads(BOX, footprint, off);
            cases.push((of_box, mesh, vec![POWER, 0.1, 0.07, 0.27], vec![0.7, 0.2, -0.1, 0.3]));
            let (round, mesh) = loads(ROUND, footprint, "");
            cases.push((round, mesh, vec![POWER, 0.27], vec![0.7, 0.3]));
        }
        cases
    }

    /// Nodal heat of the top, class by class.
    fn heat(loads: &SolidLoads) -> Vec<Vec<f64>> {
        loads.heat.iter().map(|of_class| of_class[1].clone()).collect()
    }

    #[test]
    fn rates_of_power_and_radius_match_finite_differences() {
        for (loads, mesh, inputs, rates) in cases() {
            let h = 1e-6;
            let at = |sign: f64| {
                let moved = inputs.iter().zip(&rates).map(|(value, rate)| value + sign * h * rate);
                heat(&loads.assemble(&moved.collect::<Vec<f64>>(), [&mesh, &mesh]))
            };
            let found = heat(&loads.change(&inputs, &rates, [&mesh, &mesh]));
            let [above, below] = [at(1.0), at(-1.0)];
            let largest = found.iter().flatten().fold(0.0_f64, |a, b| a.max(b.abs()));
            for (class, found) in found.iter().enumerate() {
                for (node, found) in found.iter().enumerate() {
                    let wanted = (above[class][node] - below[class][node]) / (2.0 * h);
                    assert!((found - wanted).abs() < 1e-5 * largest, "{found} {wanted}");
                }
            }
        }
    }

    #[test]
    fn nodal_heat_sums_to_the_power_at_any_radius() {
        for (loads, mesh, inputs, _) in cases() {
            // Odd classes add up to nothing. A mirrored part has its share.
            let total = |inputs: &[f64]| -> f64 {
                let images: f64 =
                    mesh.mirrored.iter().map(|&m| if m { 2.0 } else { 1.0 }).product();
                images * heat(&loads.assemble(inputs, [&mesh, &mesh]))[0].iter().sum::<f64>()
            };
            let mut smaller = inputs.clone();
            *smaller.last_mut().unwrap() = 0.2;
            let tails = if loads.loads[0].0.footprint.reach() > 1.0 { 1e-2 } else { 1e-12 };
            assert!((total(&inputs) / POWER - 1.0).abs() < tails, "{}", total(&inputs));
            assert!((total(&smaller) / POWER - 1.0).abs() < tails, "{}", total(&smaller));
        }
    }
}
