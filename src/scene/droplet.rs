//! Droplets, the walls that turn them into units, and their couplings to solids.

use std::f64::consts::{FRAC_PI_2, TAU};

use schemars::{JsonSchema, Schema};
use serde::{Deserialize, Serialize};
use serde_json::json;

use super::lookup::BodyInput;
use super::recording::Recording;
use crate::closed_form::DropImpact;
use crate::kernel::Kernel;
use crate::laws::Fluid;
use crate::limits::{Bounds, Limits, own_temperature, plausible, temperature, whole, within};
use crate::quantity::Quantity;
use crate::substances;

/// Round drops of one fluid that arrive, along −z, above the plane z = 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Droplet {
    /// Method that computes the drops.
    #[serde(default)]
    pub method: DropletMethod,
    /// Diameter [m].
    #[schemars(transform = within(1e-9, 1e2, "m", "the diameter of a drop").plausible(&plausible::DIAMETER))]
    pub diameter: f64,
    /// Speed at the release, straight towards the wall unless there is an angle [m/s].
    #[schemars(transform = speed())]
    pub impact_velocity: f64,
    /// Angle between the velocity of a drop at its release and the downward vertical [rad].
    #[serde(default)]
    #[schemars(transform = angle().otherwise("0: straight down"))]
    pub impact_angle: f64,
    /// Direction along the wall of drops with an angle, from x towards y [rad].
    #[serde(default)]
    #[schemars(transform = direction()
        .condition("0 in a plane model")
        .otherwise("0: along x"))]
    pub impact_direction: f64,
    /// Uniform temperature at the release [K].
    #[schemars(transform = own_temperature())]
    pub initial_temperature: f64,
    /// Gap between a drop's lowest point and the wall at its release [m].
    #[schemars(transform = within(0.0, 1e3, "m", "the gap between drop and wall")
        .plausible(&plausible::HEIGHT)
        .otherwise("half a `spacing`"))]
    pub height: Option<f64>,
    /// Distance of particles Δx [m].
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(transform = within(1e-10, 1e1, "m", "the distance of particles")
        .condition("required except with `method = \"film\"`; up to a sixth of the diameter, at most 2e7 particles")
        .otherwise("none"))]
    pub spacing: f64,
    /// Fluid of the drops: a table, or the name of a substance of the library.
    #[schemars(transform = or_substance)]
    pub fluid: Fluid,
    /// 3, or 2 for a plane model in x and z, whose totals are per metre of depth.
    #[serde(default = "crate::scene::defaults::three")]
    #[schemars(transform = whole(2, 3, "no model of this dimension", "3, 2 (plane)"))]
    pub dimension: usize,
    /// Part of the drop that is modelled.
    #[serde(default)]
    #[schemars(extend(
        "otherwise" = "`auto`: axisymmetric above rings or a disc, else a quarter, where that is exact",
        "condition" = "`quarter` and `axisymmetric` with all drops at x = 0, y = 0, straight down; `quarter` on a lattice; `axisymmetric` in three dimensions, not above tiles"
    ))]
    pub symmetry: DropletSymmetry,
    /// True if the surface below is modelled as round (a disc or a wall of rings); derived from the scene.
    #[serde(skip)]
    pub is_on_round: bool,
    /// Initial placement of particles: on a lattice, or at random with a minimum distance.
    #[serde(default)]
    pub placement: Placement,
    /// Body force per mass towards −z [m/s²].
    #[serde(default)]
    #[schemars(transform = within(0.0, 1e7, "m/s²", "gravity, which acts towards the wall,")
        .plausible(&plausible::GRAVITY))]
    pub gravity: f64,
    /// Smoothing kernel.
    #[serde(default)]
    pub kernel: Kernel,
    /// Support radius of the kernel.
    #[serde(default = "default_support")]
    #[schemars(transform = within(2.0, 6.0, "distances of particles", "").says(
        "the support radius of the kernel is out of bounds",
        "2 <= support <= 6 (distances of particles)",
    ))]
    pub support: f64,
    /// Precision of pair interactions.
    #[serde(default)]
    pub precision: Precision,
    /// Advance of viscosity in time.
    #[serde(default)]
    #[schemars(extend(
        "otherwise" = "`auto`: implicit where that is cheaper, or where viscosity depends on the temperature or on the shear rate",
        "condition" = "`explicit` with a constant viscosity"
    ))]
    pub viscous: ViscousAdvance,
    /// Advance of pressure in time; `implicit` is quick for fluid that is thick, slow or at rest.
    #[serde(default)]
    #[schemars(extend("condition" = "`implicit` without `viscous = \"explicit\"`"))]
    pub pressure: PressureAdvance,
    /// δ of the density diffusion [1].
    #[serde(default = "default_density_diffusion")]
    #[schemars(transform = within(0.0, 1.0, "1", "").says("the density diffusion is out of bounds", "0 to 1"))]
    pub density_diffusion: f64,
    /// Correction of the density diffusion by renormalised gradients, which preserves a fluid at rest under gravity.
    #[serde(default = "crate::scene::defaults::yes")]
    pub corrected_diffusion: bool,
    /// Shifting of particles from crowded to sparse regions.
    #[serde(default)]
    #[schemars(extend("otherwise" = "true from a Weber number of 1000 on, or without tension"))]
    pub shifting: Option<bool>,
    /// Trigger of releases: times of the scene, or inputs of the unit.
    #[serde(default)]
    pub release: ReleaseBy,
    /// Largest number of drops that inputs may release in a run.
    #[schemars(transform = whole(1, 10_000, "the number of drops is out of bounds", "1 to 10000")
        .condition("required with `release = \"input\"`, else not allowed")
        .otherwise("none"))]
    pub most: Option<usize>,
    /// Releases of drops: one drop per entry of the list.
    #[schemars(
        length(min = 1),
        extend(
            "otherwise" = "one at time 0",
            "condition" = "in the order of their times; not with `release = \"input\"`"
        )
    )]
    pub arrivals: Option<Vec<Arrival>>,
    /// Settings of the recorded impact that `method = "record"` repeats.
    #[schemars(extend("otherwise" = "at `impact_velocity`", "condition" = "with `method = \"record\"` or `\"film\"`"))]
    pub record: Option<Recording>,
}

/// Trigger of the drops' releases.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ReleaseBy {
    /// The times of `arrivals`.
    #[default]
    Arrivals,
    /// An input that counts the requested drops; further inputs set position, speed and temperature.
    Input,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum DropletMethod {
    /// Weakly compressible smoothed particle hydrodynamics.
    #[default]
    Sph,
    /// A precomputed impact of particles, repeated for every drop.
    Record,
    /// Closed forms of a film that spreads and cools, repeated for every drop.
    Film,
}

/// Advance of viscosity in time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ViscousAdvance {
    /// The cheaper of both, by the forecast.
    #[default]
    Auto,
    /// With other forces, in steps short enough for it.
    Explicit,
    /// Solved at the end of each step: thick fluids take fewer, longer steps.
    Implicit,
}

/// Advance of pressure in time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum PressureAdvance {
    /// In steps that resolve the sound of the model.
    #[default]
    Explicit,
    /// Solved with viscosity at the end of each step, whose length sound does not limit: for fluid that is thick, slow
    /// or at rest.
    Implicit,
}

/// Modelled part of the drops.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum DropletSymmetry {
    /// The plane of radius and height if all drops arrive at the origin, on a lattice, straight down, above a disc or a
    /// wall of rings. Other drops at the origin: a quarter, or half of a plane model; half if they come at an angle
    /// along x or y.
    #[default]
    Auto,
    /// All drops entirely.
    None,
    /// A quarter; drops must arrive at the origin, straight down.
    Quarter,
    /// The plane of radius and height, in which particles are rings about the axis: two dimensions instead of three.
    /// Drops must arrive at the origin, straight down. A box below exchanges means over rings.
    Axisymmetric,
}

/// Initial arrangement of particles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Placement {
    /// On a cubic lattice.
    #[default]
    Lattice,
    /// At random with a minimum distance (Poisson disk).
    BlueNoise,
}

/// Precision of pair interactions; positions and sums over time are always double.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Precision {
    /// 32 bits.
    #[default]
    Single,
    /// 64 bits.
    Double,
}

/// Time and position of a drop's release.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Arrival {
    /// Time of the release [s].
    #[serde(default)]
    #[schemars(transform = within(0.0, 1e12, "s", "the time of an arrival"))]
    pub time: f64,
    /// x of the centre [m].
    #[serde(default)]
    #[schemars(transform = arrival())]
    pub x: f64,
    /// y of the centre [m].
    #[serde(default)]
    #[schemars(transform = arrival().condition("0 in a plane model"))]
    pub y: f64,
}

/// Speed of a drop at its release [m/s].
const fn speed() -> Limits {
    within(0.0, 1e5, "m/s", "the speed towards the wall").plausible(&plausible::SPEED)
}

/// Angle between the velocity of a drop and the downward vertical [rad].
const fn angle() -> Limits {
    let limits = within(-FRAC_PI_2, FRAC_PI_2, "rad", "").open();
    limits.says(
        "at this angle a drop does not come down",
        "-1.5708 to 1.5708 (rad), without these ends",
    )
}

/// Direction along the wall of a drop with an angle [rad].
const fn direction() -> Limits {
    let limits = within(-TAU, TAU, "rad", "");
    limits.says("the direction is more than a full turn", "-6.28319 to 6.28319 (rad)")
}

/// Coordinate of a drop's centre at its release [m].
const fn arrival() -> Limits {
    within(-1e3, 1e3, "m", "the place of an arrival")
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

fn default_support() -> f64 {
    Droplet::DEFAULT_SUPPORT
}

fn default_density_diffusion() -> f64 {
    Droplet::DEFAULT_DENSITY_DIFFUSION
}

/// Arrival of a scene without `arrivals`.
const ONE_ARRIVAL: [Arrival; 1] = [Arrival { time: 0.0, x: 0.0, y: 0.0 }];

/// Default speed of sound over the governing speed: it keeps the density within 1 %.
pub(super) const SOUND_OVER_FLOW: f64 = 10.0;

/// Smallest speed of sound over that of the flow or its surface. Below it the fluid would be compressed by 4 % and
/// more, or its surface would detach.
pub const LEAST_SOUND_OVER_FLOW: f64 = 5.0;

/// Dominant cause of motion or pressure in a fluid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Governing {
    Flow,
    Surface,
    Viscosity,
}

/// Weber number above which inertia dominates.
const INERTIAL: f64 = 1000.0;

/// Cosine below which an angle counts as a right angle, given rounding.
const RIGHT: f64 = 1e-9;

/// Velocity [m/s] from speed, angle to the downward vertical and direction along the wall, from x towards y [rad].
pub fn velocity(speed: f64, angle: f64, direction: f64) -> [f64; 3] {
    let (down, aside) = (speed * angle.cos(), speed * angle.sin());
    let (sine, cosine) = direction.sin_cos();
    let [x, y] = match (cosine.abs() < RIGHT, sine.abs() < RIGHT) {
        (true, _) => [0.0, sine.signum()],
        (_, true) => [cosine.signum(), 0.0],
        _ => [cosine, sine],
    };
    [aside * x, aside * y, -down]
}

/// Lets a substance of the library stand for a fluid's constants.
pub(super) fn or_substance(schema: &mut Schema) {
    if let Some(table) = schema.remove("$ref") {
        let choices = json!([{ "$ref": table }, { "type": "string" }, substances::schema()]);
        schema.insert("anyOf".into(), choices);
    }
}

impl Droplet {
    pub const DEFAULT_SUPPORT: f64 = 3.0;
    pub const DEFAULT_DENSITY_DIFFUSION: f64 = 0.1;

    /// Gap between a drop's lowest point and the wall at its release [m].
    pub fn gap(&self) -> f64 {
        self.height.unwrap_or(0.5 * self.spacing)
    }

    /// Larger of two speeds [m/s]: that of a drop that has fallen through its gap and its own height, and that of
    /// capillary waves, √(σ/(ρR)).
    pub fn fastest_flow(&self) -> f64 {
        let fall = self.gain_by_fall();
        let capillary = self.fluid.capillary_speed_squared(0.5 * self.diameter);
        (self.impact_velocity.powi(2) + fall).max(capillary).sqrt()
    }

    /// The viscosity that stands for the fluid in dimensionless numbers and estimates [Pa s]: at the initial
    /// temperature and, of a law of the shear rate, at the rate U/D of the [fastest flow](Self::fastest_flow) over the
    /// diameter.
    pub fn reference_viscosity(&self) -> f64 {
        let rate = self.fastest_flow() / self.diameter;
        self.fluid.reference_viscosity(self.initial_temperature, rate)
    }

    /// Increase of the squared speed during the fall of a drop through its gap and its own height [m²/s²].
    fn gain_by_fall(&self) -> f64 {
        2.0 * self.gravity * (self.gap() + self.diameter)
    }

    /// Governing speed [m/s], which the speed of sound must exceed by far, and its cause.
    pub fn governing_speed(&self) -> (Governing, f64) {
        let surface = self.fluid.laplace_speed(self.spacing);
        let viscous = self.fluid.viscous_speed(
            self.reference_viscosity(),
            self.speed_at_contact(),
            self.diameter,
        );
        [(Governing::Surface, surface), (Governing::Viscosity, viscous)].into_iter().fold(
            (Governing::Flow, self.fastest_flow()),
            |largest, other| {
                if other.1 > largest.1 { other } else { largest }
            },
        )
    }

    /// Speed of sound of the model [m/s].
    pub fn sound_speed(&self) -> f64 {
        self.fluid.sound_speed.unwrap_or_else(|| SOUND_OVER_FLOW * self.governing_speed().1)
    }

    /// Returns true if inputs release the drops.
    pub fn is_on_demand(&self) -> bool {
        self.release == ReleaseBy::Input
    }

    /// Releases that the scene sets.
    pub fn arrivals(&self) -> &[Arrival] {
        match &self.arrivals {
            Some(list) => list,
            None if self.is_on_demand() => &[],
            None => &ONE_ARRIVAL,
        }
    }

    /// Largest number of drops.
    pub fn drops(&self) -> usize {
        if self.is_on_demand() { self.most.unwrap_or(1) } else { self.arrivals().len() }
    }

    /// Largest speed at which inputs may release a drop [m/s]; the flow then reaches a fifth of the speed of sound.
    pub fn fastest_release(&self) -> f64 {
        let flow = self.sound_speed() / LEAST_SOUND_OVER_FLOW;
        (flow * flow - self.gain_by_fall()).max(0.0).sqrt()
    }

    /// Inputs that a released drop reads when it starts.
    pub fn inputs(&self) -> Vec<BodyInput> {
        if !self.is_on_demand() {
            return Vec::new();
        }
        let input =
            |key, words, quantity, start, bounds| BodyInput { key, words, quantity, start, bounds };
        let count = Bounds::between(0.0, self.drops() as f64);
        let release =
            "drops asked for so far: each that is added starts with the next step, or waits";
        let places =
            [("x", "x of the centre at the release"), ("y", "y of the centre at the release")];
        let mut inputs = vec![input("release", release, Quantity::Count, 0.0, count)];
        inputs.extend(
            places.map(|(key, words)| input(key, words, Quantity::Length, 0.0, arrival().bounds())),
        );
        inputs.extend([
            input(
                "speed",
                "speed at the release",
                Quantity::Velocity,
                self.impact_velocity,
                speed().bounds(),
            ),
            input(
                "temperature",
                "temperature at the release",
                Quantity::Temperature,
                self.initial_temperature,
                temperature().bounds(),
            ),
            input(
                "angle",
                "angle at the release between the way of the drop and the way straight down",
                Quantity::Angle,
                self.impact_angle,
                angle().bounds(),
            ),
            input(
                "direction",
                "direction along the wall of a drop that comes at an angle, from x towards y",
                Quantity::Angle,
                self.impact_direction,
                direction().bounds(),
            ),
        ]);
        inputs.retain(|input| self.dimension == 3 || !["y", "direction"].contains(&input.key));
        inputs
    }

    /// Velocity of a drop at its release [m/s].
    pub fn velocity(&self) -> [f64; 3] {
        velocity(self.impact_velocity, self.impact_angle, self.impact_direction)
    }

    /// Returns true if drops come straight down.
    pub fn is_straight(&self) -> bool {
        self.impact_angle == 0.0
    }

    /// Speed towards the wall at the release [m/s].
    pub fn normal_speed(&self) -> f64 {
        -self.velocity()[2]
    }

    /// Time that a drop takes to fall through its gap at a speed towards the wall [s]; infinite if it never arrives.
    pub fn fall_time(&self, speed: f64) -> f64 {
        2.0 * self.gap() / (speed + (speed * speed + 2.0 * self.gravity * self.gap()).sqrt())
    }

    /// Landing position of a drop that starts above a position [m] at a velocity [m/s]; the start position if it never
    /// lands.
    pub fn landing(&self, from: [f64; 2], velocity: [f64; 3]) -> [f64; 2] {
        let time = self.fall_time(-velocity[2]);
        let along = |axis: usize| match time.is_finite() {
            true => from[axis] + velocity[axis] * time,
            false => from[axis],
        };
        [along(0), along(1)]
    }

    /// Landing positions of the scene's drops [m].
    pub fn landings(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        let velocity = self.velocity();
        self.arrivals().iter().map(move |arrival| self.landing([arrival.x, arrival.y], velocity))
    }

    /// Returns true if all drops that the scene releases arrive at the origin.
    pub fn is_centred(&self) -> bool {
        self.arrivals().iter().all(|arrival| arrival.x == 0.0 && arrival.y == 0.0)
    }

    /// Returns true if particles are shifted.
    pub fn shifts(&self) -> bool {
        let tension = self.fluid.surface_tension;
        let inertia = self.fluid.density * self.speed_at_contact().powi(2) * self.diameter;
        self.shifting.unwrap_or(inertia > INERTIAL * tension || tension == 0.0)
    }

    /// The impact of a drop on the wall in terms of the closed forms.
    pub fn impact(&self) -> DropImpact {
        let Fluid { density, surface_tension, contact_angle, .. } = self.fluid;
        DropImpact {
            diameter: self.diameter,
            speed: self.normal_speed_at_contact(),
            density,
            viscosity: self.reference_viscosity(),
            surface_tension,
            contact_angle,
        }
    }

    /// Largest spread diameter of a drop [m].
    pub fn spread_diameter(&self) -> f64 {
        self.impact().largest_spread() * self.diameter
    }
}
