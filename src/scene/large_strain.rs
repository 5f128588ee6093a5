//! Solids of large strain: gels, rubbers and soft prints, with or without inertia.

use std::collections::BTreeMap;

use schemars::{JsonSchema, Schema};
use serde::{Deserialize, Serialize};
use serde_json::json;

use super::lookup::BodyInput;
use super::materials::{MaterialChoice, heights};
use super::quadrilateral::Quadrilateral;
use super::types::{Convection, Disc, Face, FaceName, Layer, Shape};
use crate::laws::Material;
use crate::laws::solid::SolidLaw;
use crate::laws::solid::large_strain::Thermal;
use crate::limits::{
    Keys, Limits, above_zero, heat_flux, length, own_temperature, plausible, signed, traction,
    whole, within,
};
use crate::quantity::Quantity;

/// A solid of large strain.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LargeStrain {
    /// Measure of deformation.
    pub strain: FiniteStrain,
    /// `{ ball = { radius = R } }`, `{ disc = { radius = R, thickness = T } }`, `{ box = [LX, LY, LZ] }` or
    /// `{ quadrilateral = { corners = [[X, Z], …] } }`.
    pub shape: SolidShape,
    /// Material of the body: a table, or the name of a `[material.NAME]`.
    #[schemars(extend(
        "otherwise" = "`layers`",
        "condition" = "`model`: `neo_hookean`, `viscoelastic`, `elastoplastic`, `concrete`"
    ))]
    pub material: Option<MaterialChoice>,
    /// Layers from the top, instead of `material`; they fill the thickness.
    #[schemars(extend(
        "otherwise" = "`material`",
        "condition" = "finite elements without inertia, on a box or a disc"
    ))]
    pub layers: Option<Vec<Layer>>,
    /// Uniform temperature, at which constants are taken [K].
    #[schemars(transform = own_temperature())]
    pub initial_temperature: f64,
    /// 3, or 2 for a plane model in x and z of plane strain, whose totals are per metre of depth.
    #[serde(default = "three")]
    #[schemars(transform = whole(2, 3, "no model of this dimension", "3, 2 (plane)"))]
    pub dimension: usize,
    /// Part of the body that is modelled.
    #[serde(default)]
    #[schemars(extend("condition" = "a box is not `axisymmetric`, a disc is"))]
    pub symmetry: LargeStrainSymmetry,
    /// Discretisation: finite elements, reproducing kernels, the element-free Galerkin method, or total-Lagrangian
    /// smoothed particles.
    #[serde(default)]
    pub mechanics: Mechanics,
    /// Settings of `rkpm` and `efg`.
    #[schemars(extend("otherwise" = "a linear basis", "condition" = "with `mechanics = \"rkpm\"` or `\"efg\"`"))]
    pub rkpm: Option<KernelSettings>,
    /// Settings of `sph`.
    #[schemars(extend("otherwise" = "supports of 2.2 distances", "condition" = "with `mechanics = \"sph\"`"))]
    pub sph: Option<ParticleSettings>,
    /// True if the body has inertia: it moves above the plane z = 0, or above the body of its coupling, and falls; with
    /// `motion = "implicit"` nothing is below it. Otherwise it is in equilibrium at every time.
    #[serde(default)]
    pub inertia: bool,
    /// Time steps of a body with inertia.
    #[serde(default)]
    #[schemars(extend("condition" = "`implicit` with `inertia = true`, without `layers` and coupling"))]
    pub motion: MotionSteps,
    /// Position and velocity at time zero.
    #[serde(default)]
    #[schemars(extend("otherwise" = "at rest", "condition" = "with `inertia = true`"))]
    pub start: LargeStrainStart,
    /// Body force per mass towards −z [m/s²].
    #[serde(default)]
    #[schemars(transform = within(0.0, 1e7, "m/s²", "gravity, which acts towards the wall,")
        .plausible(&plausible::GRAVITY))]
    pub gravity: f64,
    /// The mesh.
    #[serde(default)]
    #[schemars(extend("otherwise" = "automatic"))]
    pub mesh: LargeStrainMesh,
    /// Conditions on faces.
    #[serde(default)]
    #[schemars(
        extend(
            "otherwise" = "free",
            "condition" = "not on a ball; with explicit motion loads only"
        ),
        transform = Keys(FaceName::ALL.map(FaceName::as_str))
    )]
    pub faces: BTreeMap<FaceName, HeldFace>,
    /// Conductance of the contact with the body below [W/(m² K)]; derived from the scene.
    #[serde(skip)]
    pub conductance_below: Option<f64>,
}

/// Time steps of a solid of large strain with inertia.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum MotionSteps {
    /// As short as the speed of sound requires; the body touches what lies below.
    #[default]
    Explicit,
    /// Of any length, one a communication step, with Newton's method; faces may be held and moved.
    Implicit,
}

fn three() -> usize {
    3
}

/// Measure of the deformation of a solid of large strain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum FiniteStrain {
    /// Strains and rotations of any size.
    Finite,
}

/// Measure of the deformation of a thermo-elastic solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum SmallStrain {
    /// Strains and rotations far below 1.
    #[default]
    Small,
}

/// Discretisation of a solid of large strain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Mechanics {
    /// Linear finite elements.
    #[default]
    Fem,
    /// Reproducing kernels: cubic splines.
    Rkpm,
    /// The element-free Galerkin method: moving least squares with quartic splines.
    Efg,
    /// Total-Lagrangian smoothed particles: neighbours of the undeformed body, with corrected gradients.
    Sph,
}

/// Settings of smoothed particles of large strain.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ParticleSettings {
    /// Radius of supports, in distances of particles.
    #[schemars(transform = within(1.5, 6.0, "distances of particles", "").says(
        "the support, in distances of particles, reaches too few or too many",
        "1.5 to 6",
    ))]
    pub support: f64,
}

impl Default for ParticleSettings {
    fn default() -> Self {
        Self { support: 2.2 }
    }
}

/// Settings of reproducing kernels.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct KernelSettings {
    /// Order of the polynomials that the functions reproduce.
    #[schemars(transform = whole(1, 2, "no basis of this order", "1 (linear), 2 (quadratic)"))]
    pub basis: usize,
    /// Half of the width of supports, in distances of nodes.
    #[schemars(transform = within(1.0, 6.0, "distances of nodes", "").low_open().says(
        "the support, in distances of nodes, reaches too few or too many",
        "above `basis`, up to 6",
    ).otherwise("`basis` + 0.75"))]
    pub support: Option<f64>,
    /// Points at which the mechanics is integrated.
    pub integration: KernelIntegration,
    /// Radius over which gradients are averaged once more, a length of the material on which strain localises [m].
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(transform = length("the radius of smoothing")
        .plausible(&plausible::EXTENT)
        .condition("with `integration = \"nsni\"`, four distances of nodes or more")
        .otherwise("none"))]
    pub smoothing: Option<f64>,
}

impl Default for KernelSettings {
    fn default() -> Self {
        Self { basis: 1, support: None, integration: KernelIntegration::default(), smoothing: None }
    }
}

/// Integration of reproducing kernels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum KernelIntegration {
    /// Naturally stabilised: as exact as the basis, at a few points about each node.
    #[default]
    Nsni,
    /// Stabilised conforming: one point a node with the mean gradient of its cell; soft in bending.
    Scni,
    /// Gauss points of the cells between nodes; fails the patch test.
    Gauss,
}

/// The shape of a solid of large strain. The origin of a box and of a disc is the centre of their top, that of a ball
/// its centre.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum SolidShape {
    /// Extents along x, y and z [m].
    Box(
        #[schemars(transform = length("the extent of a body").plausible(&plausible::EXTENT))]
        [f64; 3],
    ),
    /// A round plate or cylinder.
    Disc(Disc),
    /// A ball; in a plane model a circle.
    Ball(Ball),
    /// Four corners in x and z; its faces are those of a box, `left` and `right` between the corners there.
    Quadrilateral(Quadrilateral),
}

/// A ball.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Ball {
    /// Radius [m].
    #[schemars(transform = length("the radius of a body").plausible(&plausible::EXTENT))]
    pub radius: f64,
}

/// Modelled part of a solid of large strain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum LargeStrainSymmetry {
    /// Axisymmetric if ball or disc move along the axis, else a quarter (half of a plane model) where that is exact;
    /// the whole body with a second smoothing.
    #[default]
    Auto,
    /// The whole body.
    None,
    /// A quarter, or half of a plane model.
    Quarter,
    /// A meridian section.
    Axisymmetric,
}

/// Position and velocity of a solid of large strain at time zero.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LargeStrainStart {
    /// Velocity along x, y and z [m/s].
    #[schemars(transform = signed("m/s", "a velocity"))]
    pub velocity: [f64; 3],
    /// Gap between the lowest point and the plane [m].
    #[schemars(transform = within(0.0, 1e3, "m", "the gap between body and plane")
        .plausible(&plausible::HEIGHT))]
    pub height: f64,
}

/// Mesh of a solid of large strain.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LargeStrainMesh {
    /// Distance of nodes [m].
    #[schemars(transform = above_zero("m")
        .condition("up to the smallest extent")
        .otherwise("a tenth of the smallest extent"))]
    pub spacing: Option<f64>,
}

/// Conditions on a face of a solid of large strain: at most one thermal one, and a mechanical one, or `roller` with
/// `displacement`, or `pressure` with `traction`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HeldFace {
    /// No displacement.
    #[serde(default)]
    pub clamped: bool,
    /// No displacement along the normal; with `displacement`, that one along it, and none is held across.
    #[serde(default)]
    pub roller: bool,
    /// Displacement along x, y and z at the start; inputs [m].
    #[schemars(transform = displacement().otherwise("free"))]
    pub displacement: Option<[f64; 3]>,
    /// Pressure on the deformed face, into the body, at the start; an input [Pa].
    #[schemars(transform = traction().otherwise("free"))]
    pub pressure: Option<f64>,
    /// Force per area of the undeformed face along x, y and z at the start; inputs [Pa].
    #[schemars(transform = traction().otherwise("free"))]
    pub traction: Option<[f64; 3]>,
    /// Prescribed temperature [K]; an input.
    #[schemars(transform = own_temperature().otherwise("insulated"))]
    pub temperature: Option<f64>,
    /// Heat flux into the body per present area [W/m²]; an input.
    #[schemars(transform = heat_flux().otherwise("insulated"))]
    pub flux: Option<f64>,
    /// Heat flux by convection to a fluid, per present area.
    #[schemars(extend("otherwise" = "insulated"))]
    pub convection: Option<Convection>,
}

/// A component of the load on a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LoadComponent {
    Pressure,
    /// Along an axis.
    Traction(usize),
}

impl HeldFace {
    /// Keys of the mechanical conditions that are set.
    pub fn conditions(&self) -> Vec<&'static str> {
        let given = [
            ("clamped", self.clamped),
            ("roller", self.roller),
            ("displacement", self.displacement.is_some()),
            ("pressure", self.pressure.is_some()),
            ("traction", self.traction.is_some()),
        ];
        given.into_iter().filter(|(_, given)| *given).map(|(key, _)| key).collect()
    }

    /// Thermal conditions as those of other solids.
    pub fn heated(&self) -> Face {
        let Self { temperature, flux, convection, .. } = *self;
        Face { temperature, flux, convection, ..Face::default() }
    }

    /// Returns true if the face is held or moved.
    pub fn is_held(&self) -> bool {
        self.clamped || self.roller || self.displacement.is_some()
    }

    /// Returns true if a load acts on the face, which is not held then.
    pub fn is_loaded(&self) -> bool {
        self.pressure.is_some() || self.traction.is_some()
    }
}

/// Displacement of a face [m].
const fn displacement() -> Limits {
    signed("m", "a displacement")
}

/// Elements across the smallest extent, by default.
const ACROSS: f64 = 10.0;

impl LargeStrain {
    /// Extents along x, y and z [m].
    pub fn extents(&self) -> [f64; 3] {
        match self.shape {
            SolidShape::Box(extents) => extents,
            SolidShape::Disc(Disc { radius, thickness }) => [2.0 * radius, 2.0 * radius, thickness],
            SolidShape::Ball(Ball { radius }) => [2.0 * radius; 3],
            SolidShape::Quadrilateral(own) => {
                let [x, z] = own.ranges().map(|[low, high]| high - low);
                [x, own.depth.unwrap_or(1.0), z]
            }
        }
    }

    /// Returns true if the shape is a box.
    pub fn is_box(&self) -> bool {
        matches!(self.shape, SolidShape::Box(_))
    }

    /// Returns true if the shape has four corners, which mirror nothing.
    pub fn is_quadrilateral(&self) -> bool {
        matches!(self.shape, SolidShape::Quadrilateral(_))
    }

    /// Smallest extent of the model, of a quadrilateral its shortest edge [m].
    pub fn smallest(&self) -> f64 {
        let [x, y, z] = self.extents();
        let in_plane = match self.shape {
            SolidShape::Quadrilateral(own) => own.edges().into_iter().fold(x.min(z), f64::min),
            _ => x.min(z),
        };
        if self.dimension == 2 { in_plane } else { in_plane.min(y) }
    }

    /// Distance of nodes [m].
    pub fn spacing(&self) -> f64 {
        self.mesh.spacing.unwrap_or(self.smallest() / ACROSS)
    }

    /// Returns true if the body is modelled by a meridian section.
    pub fn is_axisymmetric(&self) -> bool {
        let [u, v, _] = self.start.velocity;
        let is_round = matches!(self.shape, SolidShape::Ball(_) | SolidShape::Disc(_));
        let is_straight = u == 0.0 && v == 0.0 && self.faces.values().all(HeldFace::is_straight);
        match self.symmetry {
            LargeStrainSymmetry::Axisymmetric => true,
            LargeStrainSymmetry::Auto => {
                self.dimension == 3 && is_round && is_straight && self.smoothing().is_none()
            }
            LargeStrainSymmetry::None | LargeStrainSymmetry::Quarter => false,
        }
    }

    /// Axes along which the displacement of a face is an input: its normal on rollers, else those that the model
    /// neither lacks nor mirrors. A face without rollers is held along the others.
    pub fn moved_axes(&self, face: FaceName) -> Vec<usize> {
        let Some(held) = self.faces.get(&face).filter(|held| held.displacement.is_some()) else {
            return Vec::new();
        };
        let is_taken = |axis: &usize| face.normal() == Some(*axis);
        match held.roller {
            true => (0..3).filter(is_taken).collect(),
            false => self.free_axes(),
        }
    }

    /// Components of the load on a face that are inputs: the pressure, and the traction along axes that the model
    /// neither lacks nor mirrors.
    pub fn load_components(&self, face: FaceName) -> Vec<LoadComponent> {
        let Some(own) = self.faces.get(&face) else { return Vec::new() };
        let pressure = own.pressure.map(|_| LoadComponent::Pressure);
        let axes = if own.traction.is_some() { self.free_axes() } else { Vec::new() };
        pressure.into_iter().chain(axes.into_iter().map(LoadComponent::Traction)).collect()
    }

    /// Axes that the model neither lacks nor mirrors.
    fn free_axes(&self) -> Vec<usize> {
        let is_round = self.is_axisymmetric();
        let mirrors = self.mirrors();
        let is_free = |&axis: &usize| {
            let mirrored = axis < 2 && (is_round || mirrors[axis]);
            !mirrored && (axis != 1 || self.dimension == 3)
        };
        (0..3).filter(is_free).collect()
    }

    /// Returns true if the body moves above a plane or another body, which it may touch.
    pub fn is_above(&self) -> bool {
        self.inertia && self.motion == MotionSteps::Explicit
    }

    /// Planes x = 0 and y = 0 that mirror the model.
    pub fn mirrors(&self) -> [bool; 2] {
        let [u, v, _] = self.start.velocity;
        let [x, y] = [FaceName::Left, FaceName::Front].map(|face| !self.faces.contains_key(&face));
        let [right, back] =
            [FaceName::Right, FaceName::Back].map(|face| !self.faces.contains_key(&face));
        let straight = self.faces.iter().all(|(&face, held)| held.stays_straight(face));
        match self.symmetry {
            _ if self.is_axisymmetric() => [false; 2],
            LargeStrainSymmetry::Quarter => [true, self.dimension == 3],
            LargeStrainSymmetry::Auto if self.smoothing().is_some() => [false; 2],
            LargeStrainSymmetry::Auto => [
                u == 0.0 && x && right && straight && !self.is_quadrilateral(),
                v == 0.0 && y && back && straight && self.dimension == 3,
            ],
            LargeStrainSymmetry::None | LargeStrainSymmetry::Axisymmetric => [false; 2],
        }
    }

    /// The shape of a box or a disc among those of other solids.
    pub fn plate(&self) -> Option<Shape> {
        match self.shape {
            SolidShape::Box(extents) => Some(Shape::Box(extents)),
            SolidShape::Disc(disc) => Some(Shape::Disc(disc)),
            SolidShape::Ball(_) | SolidShape::Quadrilateral(_) => None,
        }
    }

    /// Material of each layer, from the top.
    pub fn materials_of_layers(&self) -> Vec<&Material> {
        let layers = self.layers.iter().flatten().map(|layer| &layer.material);
        self.material.iter().chain(layers).map(MaterialChoice::material).collect()
    }

    /// Returns true if part of the body yields.
    pub fn yields(&self) -> bool {
        let law = |own: &Material| own.law.deformation().large_strain(self.initial_temperature);
        self.materials_of_layers().into_iter().filter_map(law).any(|law| law.yields())
    }

    /// Returns true if part of the body is of concrete.
    pub fn is_of_concrete(&self) -> bool {
        let mut materials = self.materials_of_layers().into_iter();
        materials.any(|material| matches!(material.law, SolidLaw::Concrete(_)))
    }

    /// Radius of the second smoothing [m]; `None` without one.
    pub fn smoothing(&self) -> Option<f64> {
        self.rkpm.and_then(|settings| settings.smoothing)
    }

    /// Bottom and top of each layer, from the top [m].
    pub fn heights_of_layers(&self) -> Vec<[f64; 2]> {
        let [.., thickness] = self.extents();
        let own = [-thickness, 0.0];
        self.layers.as_ref().map_or(vec![own], |layers| heights(layers, -thickness))
    }

    /// Number of the layer at a height, from the top; at an interface the layer above [m].
    pub fn layer_at(&self, z: f64) -> usize {
        let heights = self.heights_of_layers();
        heights.iter().position(|[low, _]| z >= *low).unwrap_or(heights.len() - 1)
    }

    /// Effects of the temperature on each layer, from the top.
    pub fn thermal(&self) -> Vec<Thermal> {
        let of = |own: &Material| own.law.deformation().thermal(self.initial_temperature);
        self.materials_of_layers().into_iter().map(of).collect()
    }

    /// Returns true if heat flows in the body: a face has a thermal condition, or a body below takes heat.
    pub fn conducts(&self) -> bool {
        let is_heated = |face: &HeldFace| !face.heated().thermal().is_empty();
        self.conductance_below.is_some() || self.faces.values().any(is_heated)
    }

    /// Returns true if the temperature is an input: the body rests, has no heat flow, and expands or relaxes with it,
    /// and its other constants are the same at every temperature.
    pub fn has_temperature(&self) -> bool {
        let is_steady = |own: &Material| {
            let properties = own.law.deformation().properties();
            properties.iter().all(|(key, other)| *key == "expansion" || other.is_constant())
        };
        let mut materials = self.materials_of_layers().into_iter();
        !self.inertia
            && !self.conducts()
            && self.thermal().iter().any(Thermal::acts)
            && materials.all(is_steady)
    }

    /// Inputs: the displacements of faces, their loads, then the temperature.
    pub fn inputs(&self) -> Vec<BodyInput> {
        let of_face = |(&face, held): (&FaceName, &HeldFace)| {
            let start = held.displacement?;
            let axes = self.moved_axes(face).into_iter();
            Some(axes.map(move |axis| BodyInput {
                key: displacement_key(face, axis),
                words: "displacement of the face",
                quantity: Quantity::Displacement,
                start: start[axis],
                bounds: displacement().bounds(),
            }))
        };
        let of_load = |(&face, own): (&FaceName, &HeldFace)| {
            let (pressure, dead) = (own.pressure, own.traction);
            let input = move |component: LoadComponent| BodyInput {
                key: load_key(face, component),
                words: match component {
                    LoadComponent::Pressure => "pressure on the deformed face, into the body",
                    LoadComponent::Traction(_) => "force on the face per undeformed area",
                },
                quantity: Quantity::Stress,
                start: match component {
                    LoadComponent::Pressure => pressure.unwrap_or_default(),
                    LoadComponent::Traction(axis) => dead.unwrap_or_default()[axis],
                },
                bounds: traction().bounds(),
            };
            self.load_components(face).into_iter().map(input)
        };
        let temperature = self.has_temperature().then(|| BodyInput {
            key: "temperature",
            words: "uniform temperature of the body",
            quantity: Quantity::Temperature,
            start: self.initial_temperature,
            bounds: own_temperature().bounds(),
        });
        let displacements = self.faces.iter().filter_map(of_face).flatten();
        displacements.chain(self.faces.iter().flat_map(of_load)).chain(temperature).collect()
    }
}

impl HeldFace {
    /// Returns true if the face is neither moved nor drawn along x or y at the start.
    fn is_straight(&self) -> bool {
        let along = [self.displacement, self.traction];
        along.into_iter().flatten().all(|by| by[0] == 0.0 && by[1] == 0.0)
    }

    /// Returns true if no input moves or draws the face along x or y in a model of the whole body.
    fn stays_straight(&self, face: FaceName) -> bool {
        let is_moved = self.displacement.is_some() && !(self.roller && face.normal() == Some(2));
        !is_moved && self.traction.is_none()
    }
}

/// Last part of the name of an input of a face.
macro_rules! face_key {
    ($face:expr, $suffix:literal) => {
        match $face {
            FaceName::Top => concat!("top.", $suffix),
            FaceName::Bottom => concat!("bottom.", $suffix),
            FaceName::Sides => concat!("sides.", $suffix),
            FaceName::Left => concat!("left.", $suffix),
            FaceName::Right => concat!("right.", $suffix),
            FaceName::Front => concat!("front.", $suffix),
            FaceName::Back => concat!("back.", $suffix),
        }
    };
}

fn displacement_key(face: FaceName, axis: usize) -> &'static str {
    match axis {
        0 => face_key!(face, "displacement_x"),
        1 => face_key!(face, "displacement_y"),
        _ => face_key!(face, "displacement_z"),
    }
}

fn load_key(face: FaceName, component: LoadComponent) -> &'static str {
    match component {
        LoadComponent::Pressure => face_key!(face, "pressure"),
        LoadComponent::Traction(0) => face_key!(face, "traction_x"),
        LoadComponent::Traction(1) => face_key!(face, "traction_y"),
        LoadComponent::Traction(_) => face_key!(face, "traction_z"),
    }
}

/// Names the kind of solids of large strain in the schema as scenes do, `kind = "solid"` with `strain = "finite"`, and
/// has the measure of strain tell solids apart.
pub fn name_kind(schema: &mut Schema) {
    let kinds = schema.get_mut("oneOf").and_then(serde_json::Value::as_array_mut);
    for kind in kinds.into_iter().flatten() {
        let keys = &mut kind["properties"];
        let strain = match keys["kind"]["const"].as_str() {
            Some(KIND) => "finite",
            Some("solid") => "small",
            _ => continue,
        };
        keys["kind"]["const"] = json!("solid");
        if let Some(table) = keys["strain"].as_object_mut() {
            table.remove("$ref");
            table.remove("anyOf");
            table.insert("type".to_owned(), json!("string"));
            table.insert("const".to_owned(), json!(strain));
        }
    }
}

/// Name of the kind within the program; see [`name_kind`].
pub const KIND: &str = "solid of large strain";
