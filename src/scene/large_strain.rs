//! Solids of large strain: gels, rubbers and soft prints, with or without inertia.

mod discretisation;
mod faces;
mod kind;
mod quadrilateral;
mod shape;
mod strand;

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::lookup::BodyInput;
use super::materials::{MaterialChoice, SLACK, heights};
use super::part::Part;
use super::types::{Disc, FaceName, Layer, PlaneSection, Shape};
pub use discretisation::{
    KernelIntegration, KernelSettings, LargeStrainMesh, Mechanics, ParticleSettings,
};
pub use faces::{HeldFace, LoadComponent};
use faces::{displacement, displacement_key, load_key};
pub use kind::{KIND, name_kind, with_names};
pub use quadrilateral::Quadrilateral;
pub use shape::{Ball, SolidShape};
pub use strand::Strand;

use crate::laws::Material;
use crate::laws::solid::SolidLaw;
use crate::laws::solid::large_strain::Thermal;
use crate::limits::{Keys, own_temperature, plausible, signed, traction, whole, within};
use crate::quantity::Quantity;
use crate::space::Form;

/// A solid of large strain.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LargeStrain {
    /// Measure of deformation.
    pub strain: FiniteStrain,
    /// `{ ball = { radius = R } }`, `{ disc = { radius = R, thickness = T } }`, `{ box = [LX, LY, LZ] }`,
    /// `{ quadrilateral = { corners = [[X, Z], …] } }`, `{ strand = { path = [[X, Y, Z], …], radius = R } }` or
    /// `{ part = { file = "NAME" } }`.
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
    /// 3, or 2 for a plane model in x and z, whose totals are per metre of depth.
    #[serde(default = "crate::scene::defaults::three")]
    #[schemars(transform = whole(2, 3, "no model of this dimension", "3, 2 (plane)"))]
    pub dimension: usize,
    /// State of a plane model along y.
    #[schemars(extend(
        "otherwise" = "plane strain",
        "condition" = "with `dimension = 2`; `plane_stress` without heat, concrete and `pressure`"
    ))]
    pub section: Option<PlaneSection>,
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
    #[schemars(extend(
        "otherwise" = "`explicit`",
        "condition" = "with `inertia = true`; `implicit` without `layers` and coupling"
    ))]
    pub motion: Option<MotionSteps>,
    /// Position and velocity at time zero.
    #[serde(default)]
    #[schemars(extend("otherwise" = "at rest", "condition" = "with `inertia = true`"))]
    pub start: LargeStrainStart,
    /// Coefficient of Coulomb friction on what lies below.
    #[schemars(
        extend("otherwise" = "it slides", "condition" = "with explicit motion"),
        transform = within(0.0, 10.0, "1", "the coefficient of friction")
    )]
    pub friction: Option<f64>,
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
    /// Conductance of the contact with the body or wall below [W/(m² K)]; derived from the scene.
    #[serde(skip)]
    pub conductance_below: Option<f64>,
    /// True if the cells of a wall below are tiles, which no meridian section meets; derived from the scene.
    #[serde(skip)]
    pub is_on_tiles: bool,
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

/// Distances of nodes across the smallest extent, by default, of linear functions and of quadratic elements.
const ACROSS: [f64; 2] = [10.0, 6.0];

impl LargeStrain {
    /// Extents along x, y and z [m].
    pub fn extents(&self) -> [f64; 3] {
        match &self.shape {
            SolidShape::Box(extents) => *extents,
            SolidShape::Disc(Disc { radius, thickness }) => {
                [2.0 * radius, 2.0 * radius, *thickness]
            }
            SolidShape::Ball(Ball { radius }) => [2.0 * radius; 3],
            SolidShape::Quadrilateral(own) => {
                let [x, z] = own.ranges().map(|[low, high]| high - low);
                [x, own.depth.unwrap_or(1.0), z]
            }
            SolidShape::Strand(own) => {
                let [x, y, z] = own.sweep(self.form()).ranges().map(|[low, high]| high - low);
                [x, if self.dimension == 2 { 1.0 } else { y }, z]
            }
            SolidShape::Part(part) => {
                let [x, y, z] = part.ranges().map(|[low, high]| high - low);
                match self.form() {
                    Form::Solid => [x, y, z],
                    Form::Plane => [x, if x > 0.0 { 1.0 } else { 0.0 }, z],
                    Form::Axisymmetric => {
                        let [[_, radius], ..] = part.ranges();
                        [2.0 * radius, 2.0 * radius, z]
                    }
                }
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

    /// The part that a file describes, if the shape is one.
    pub fn part(&self) -> Option<&Part> {
        match &self.shape {
            SolidShape::Part(part) => Some(part),
            _ => None,
        }
    }

    /// The strand along a path, if the shape is one.
    pub fn strand(&self) -> Option<&Strand> {
        match &self.shape {
            SolidShape::Strand(strand) => Some(strand),
            _ => None,
        }
    }

    /// Returns true if the face `sides` is made of four that have names of their own.
    pub fn has_four_sides(&self) -> bool {
        matches!(self.shape, SolidShape::Box(_) | SolidShape::Quadrilateral(_))
    }

    /// Coordinates of the model.
    pub fn form(&self) -> Form {
        match (self.is_axisymmetric(), self.dimension) {
            (true, _) => Form::Axisymmetric,
            (false, 2) => Form::Plane,
            (false, _) => Form::Solid,
        }
    }

    /// Smallest extent of the model, of a quadrilateral its shortest edge [m].
    pub fn smallest(&self) -> f64 {
        let [x, y, z] = self.extents();
        let in_plane = match &self.shape {
            SolidShape::Quadrilateral(own) => own.edges().into_iter().fold(x.min(z), f64::min),
            SolidShape::Strand(own) => return 2.0 * own.radius,
            _ => x.min(z),
        };
        if self.dimension == 2 { in_plane } else { in_plane.min(y) }
    }

    /// Distance of nodes [m].
    pub fn spacing(&self) -> f64 {
        if let Some(part) = self.part() {
            return part.spacing();
        }
        self.mesh.spacing.unwrap_or(self.smallest() / ACROSS[self.order() - 1])
    }

    /// Order of the functions of finite elements.
    pub fn order(&self) -> usize {
        self.mesh.order.unwrap_or(1)
    }

    /// Returns true if the body is modelled by a meridian section.
    pub fn is_axisymmetric(&self) -> bool {
        let [u, v, _] = self.start.velocity;
        let is_round = matches!(self.shape, SolidShape::Ball(_) | SolidShape::Disc(_));
        let is_straight = u == 0.0 && v == 0.0 && self.faces.values().all(HeldFace::is_straight);
        match self.symmetry {
            LargeStrainSymmetry::Axisymmetric => true,
            LargeStrainSymmetry::Auto => {
                let is_round_below = !self.is_on_tiles;
                let may_be_round = is_round && is_round_below && self.smoothing().is_none();
                self.dimension == 3 && may_be_round && is_straight
            }
            LargeStrainSymmetry::None | LargeStrainSymmetry::Quarter => false,
        }
    }

    /// Returns true if the body stays round about the axis x = 0, y = 0, or mirrors itself there: a meridian section,
    /// or a shape about the origin that neither moves nor is drawn aside.
    pub fn falls_centred(&self) -> bool {
        let [u, v, _] = self.start.velocity;
        let is_centred = match self.shape {
            SolidShape::Ball(_) | SolidShape::Disc(_) | SolidShape::Box(_) => true,
            SolidShape::Quadrilateral(_) | SolidShape::Strand(_) | SolidShape::Part(_) => false,
        };
        let is_straight = u == 0.0 && v == 0.0 && self.faces.values().all(HeldFace::is_straight);
        self.is_axisymmetric() || is_centred && is_straight
    }

    /// Axes along which the displacement of a face is an input; see [`Self::held_axes`]. A face without rollers is held
    /// along the others.
    pub fn moved_axes(&self, face: FaceName) -> Vec<usize> {
        let is_moved = self.faces.get(&face).is_some_and(|held| held.displacement.is_some());
        if is_moved { self.held_axes(face) } else { Vec::new() }
    }

    /// Axes along which a held or moved face bears a force: its normal on rollers, on those of all four sides x and y,
    /// else those that the model neither lacks nor mirrors.
    pub fn held_axes(&self, face: FaceName) -> Vec<usize> {
        let Some(held) = self.faces.get(&face).filter(|held| held.is_held()) else {
            return Vec::new();
        };
        match (held.roller, face.normal()) {
            (true, Some(axis)) => vec![axis],
            (true, None) => self.free_axes().into_iter().filter(|&axis| axis < 2).collect(),
            (false, _) => self.free_axes(),
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
        self.steps() == Some(MotionSteps::Explicit)
    }

    /// Time steps of the body; `None` without inertia.
    pub fn steps(&self) -> Option<MotionSteps> {
        self.inertia.then(|| self.motion.unwrap_or_default())
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
            LargeStrainSymmetry::Auto if self.part().is_some() || self.strand().is_some() => {
                [false; 2]
            }
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
            SolidShape::Ball(_)
            | SolidShape::Quadrilateral(_)
            | SolidShape::Strand(_)
            | SolidShape::Part(_) => None,
        }
    }

    /// Material of each layer, from the top.
    pub fn materials_of_layers(&self) -> Vec<&Material> {
        let layers = self.layers.iter().flatten().map(|layer| &layer.material);
        self.material.iter().chain(layers).map(MaterialChoice::material).collect()
    }

    /// Returns true if the body is a thin sheet, without stress across its section.
    pub fn is_sheet(&self) -> bool {
        self.section == Some(PlaneSection::PlaneStress)
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
        let [.., thickness] = self.extents();
        let slack = SLACK * thickness;
        heights.iter().position(|[low, _]| z >= low - slack).unwrap_or(heights.len() - 1)
    }

    /// Effects of the temperature on each layer, from the top.
    pub fn thermal(&self) -> Vec<Thermal> {
        let of = |own: &Material| own.law.deformation().thermal(self.initial_temperature);
        self.materials_of_layers().into_iter().map(of).collect()
    }

    /// Returns true if heat flows in the body: a face has a thermal condition, or what lies below takes heat.
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
