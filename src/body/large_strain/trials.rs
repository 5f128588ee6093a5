//! A body alone, in equilibrium under small inputs, one after the other.
//!
//! Errors of the linear response to these by a mesh are those of any small load, and of the same size under larger ones.
//! Errors of plastic flow, of relaxation and of waves do not show.

use super::plan;
use crate::inputs::InputLayout;
use crate::quantity::Quantity;
use crate::scene::{Body, HeldFace, LargeStrain, Mechanics, Scene};

/// Strain of the trials: far below that of yield, and far above rounding.
const STRAIN: f64 = 1e-5;
/// Least part of a stress of that strain by which a slender body is loaded.
const LEAST: f64 = 1e-4;

/// The trials of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct SmallTrials {
    scene: Scene,
    name: String,
    /// Inputs, one alone in each trial; the first trial has none.
    pub inputs: Vec<Vec<f64>>,
    /// Gravity of a further trial, for bodies on which nothing else acts [m/s²].
    pub gravity: Option<f64>,
    /// True if no heat flows in the body, which quadratic elements do not have.
    is_even: bool,
}

/// A discretisation to compare with: the mechanics, and the order of its elements.
pub type Discretisation = (Mechanics, usize);

impl SmallTrials {
    /// The trials of a solid of large strain, or the reason why it has none; `None` for other bodies.
    pub fn of(scene: &Scene, name: &str) -> Option<Result<Self, &'static str>> {
        let solid = scene.large_strain(name)?;
        Some(match obstacle(solid) {
            Some(why) => Err(why),
            None => Self::at_rest(scene, name, solid),
        })
    }

    fn at_rest(scene: &Scene, name: &str, solid: &LargeStrain) -> Result<Self, &'static str> {
        let mut twin = scene.alone(name);
        twin.solver.threads = 1;
        let own = resting(solid);
        let [shear, weight] = stiffness_and_weight(&own);
        let rest: Vec<f64> =
            own.inputs().iter().map(|input| unloaded(&own, input.quantity)).collect();
        let mut inputs = vec![rest.clone()];
        for (place, input) in own.inputs().iter().enumerate() {
            let change = match input.quantity {
                Quantity::Displacement => STRAIN * own.smallest(),
                Quantity::Temperature => warming(&own),
                _ => STRAIN * shear * slimness(&own),
            };
            let mut trial = rest.clone();
            // Sides bulge under one sign alone, and a largest extent is not linear.
            trial[place] += change.copysign(input.start - rest[place]);
            inputs.push(trial);
        }
        let is_weighed = solid.gravity > 0.0 && inputs.len() == 1;
        let gravity = is_weighed.then(|| STRAIN * shear * slimness(solid) / weight);
        if inputs.len() == 1 && gravity.is_none() {
            return Err("nothing acts on the body by itself");
        }
        twin.body.insert(name.to_owned(), Body::LargeStrain(Box::new(own)));
        let is_even = !solid.conducts();
        Ok(Self { scene: twin, name: name.to_owned(), inputs, gravity, is_even })
    }

    /// The scene of the body with nodes nearer to each other by a factor, under gravity [m/s²].
    pub fn scene(&self, finer: f64, gravity: f64) -> Scene {
        let mut scene = self.scene.clone();
        if let Some(Body::LargeStrain(solid)) = scene.body.get_mut(&self.name) {
            solid.mesh.spacing = Some(solid.spacing() / finer);
            solid.gravity = gravity;
        }
        scene
    }

    /// The same trials with another discretisation, where the body may have it.
    pub fn with(&self, (mechanics, order): Discretisation) -> Option<Self> {
        let mut other = self.clone();
        let Some(Body::LargeStrain(solid)) = other.scene.body.get_mut(&self.name) else {
            return None;
        };
        let may_be = match (mechanics, order) {
            (Mechanics::Fem, 2) => self.is_even,
            _ => solid.layers.is_none() && !solid.is_of_concrete(),
        };
        if !may_be || (solid.mechanics, solid.order()) == (mechanics, order) {
            return None;
        }
        (solid.mechanics, solid.rkpm, solid.sph) = (mechanics, None, None);
        solid.mesh.order = Some(order);
        Some(other)
    }

    pub fn discretisation(&self) -> Option<Discretisation> {
        let solid = self.scene.large_strain(&self.name)?;
        Some((solid.mechanics, solid.order()))
    }

    /// Distance of nodes [m].
    pub fn spacing(&self) -> Option<f64> {
        Some(self.scene.large_strain(&self.name)?.spacing())
    }

    /// Usual size of an output: forces, or those per metre of depth, of an even strain, and the curvature by which it
    /// changes its sign across the body; zero of others.
    pub fn size(&self, quantity: Quantity) -> f64 {
        let Some(solid) = self.scene.large_strain(&self.name) else { return 0.0 };
        let [shear, _] = stiffness_and_weight(solid);
        let across = solid.smallest();
        match quantity {
            Quantity::Force => STRAIN * shear * across * across,
            Quantity::ForcePerLength => STRAIN * shear * across,
            Quantity::Curvature => STRAIN / across,
            _ => 0.0,
        }
    }

    /// Places of the inputs among those of the scene.
    pub fn place(&self) -> std::ops::Range<usize> {
        InputLayout::of(&self.scene).of_body(&self.name)
    }
}

/// Why the errors of a body cannot be estimated from small inputs.
fn obstacle(solid: &LargeStrain) -> Option<&'static str> {
    let is_held = solid.faces.values().any(HeldFace::is_held);
    match () {
        () if solid.part().is_some() => Some("its nodes come from a file"),
        () if solid.is_above() => Some("the body moves freely"),
        () if !is_held => Some("no face holds the body"),
        () => None,
    }
}

/// The body in equilibrium, without heat flow.
fn resting(solid: &LargeStrain) -> LargeStrain {
    let mut own = solid.clone();
    own.inertia = false;
    (own.motion, own.friction, own.conductance_below) = (None, None, None);
    own.start = Default::default();
    own.gravity = 0.0;
    for face in own.faces.values_mut() {
        (face.temperature, face.flux, face.convection) = (None, None, None);
    }
    own
}

/// The softest shear modulus [Pa], and the stress by a unit of gravity [kg/m²].
fn stiffness_and_weight(solid: &LargeStrain) -> [f64; 2] {
    let layers = plan::layers(solid);
    let shear = layers.iter().map(|layer| layer.law.shear).fold(f64::INFINITY, f64::min);
    let density = layers.iter().map(|layer| layer.density).fold(0.0, f64::max);
    [shear, density * solid.smallest()]
}

/// Stress of a load on a side over that of the bends that it causes, about: the square of the smallest extent over the
/// largest.
fn slimness(solid: &LargeStrain) -> f64 {
    let [x, y, z] = solid.extents();
    let largest = if solid.dimension == 2 { x.max(z) } else { x.max(y).max(z) };
    (solid.smallest() / largest).powi(2).clamp(LEAST, 1.0)
}

/// Value of an input without effect.
fn unloaded(solid: &LargeStrain, quantity: Quantity) -> f64 {
    if quantity == Quantity::Temperature { solid.initial_temperature } else { 0.0 }
}

/// Change of the temperature by which the layer that expands most strains by [`STRAIN`]; nothing where none does [K].
fn warming(solid: &LargeStrain) -> f64 {
    let start = solid.initial_temperature;
    let slope = |stretch: f64| (stretch - 1.0).abs();
    let thermal = solid.thermal();
    let most = thermal.iter().map(|own| slope(own.stretch(start + 1.0))).fold(0.0, f64::max);
    if most > 0.0 { STRAIN / most } else { 0.0 }
}
