//! What will be modelled of a solid, decided before any heavy work: symmetry, mesh, physics.

use super::axis::{Axis, Weight};
use super::elastic::Support;
use super::grading::{Fine, graded_ends};
use super::heat::ThermalFace;
use super::mesh::{Geometry, Mesh, MeshFace};
use crate::material::{Material, Thermoelastic};
use crate::scene::{Face, FaceName, HeatMethod, Shape, Solid, SphOperator, SphSettings, Symmetry};

/// Everything that a solid's model is built from.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    pub mesh: Mesh,
    pub law: Thermoelastic,
    pub initial_temperature: f64,
    /// How particles conduct the heat; `None` where finite elements do.
    pub sph: Option<SphSettings>,
    /// Conditions other than insulation.
    pub thermal_faces: Vec<(MeshFace, ThermalFace)>,
    /// For each thermal face, the face of the body that lies there and the one whose image does.
    pub face_sources: Vec<(FaceName, Option<FaceName>)>,
    pub supports: Vec<(MeshFace, Support)>,
    pub mechanics: bool,
    /// What was chosen or left out, and why: a sentence each.
    pub notes: Vec<String>,
}

/// A part of the top or bottom face where a load may act.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Refinement {
    pub x: [f64; 2],
    pub y: [f64; 2],
    pub top: bool,
    /// Length over which the load changes [m].
    pub feature: f64,
}

/// Nodes across a feature of a load, where the scene names no spacing.
const NODES_PER_FEATURE: f64 = 10.0;
/// Nodes across the depth that heat reaches, where the scene names no spacing.
const NODES_PER_DIFFUSION_LENGTH: f64 = 5.0;
const DEFAULT_GROWTH: f64 = 1.2;
const DEFAULT_ORDER: usize = 2;
/// Fewest elements from the centre to a side and through the thickness.
const LATERAL_ELEMENTS: f64 = 12.0;
const THICKNESS_ELEMENTS: f64 = 6.0;

impl Plan {
    /// Plans a solid under loads on `refinements`, run to `stop_time` [s].
    pub fn new(solid: &Solid, mechanics: bool, refinements: &[Refinement], stop_time: f64) -> Self {
        let Material::Thermoelastic(law) = solid.material.clone();
        let mut notes = Vec::new();
        let mirrored = mirrored(solid, &mut notes);
        let sizes = Sizes::choose(solid, &law, refinements, stop_time, &mut notes);
        let mesh = build_mesh(solid, mirrored, &sizes, refinements);
        if !mechanics {
            notes.push(
                "mechanics is left out: nothing asks for stress or displacement, no load carries \
                 traction"
                    .into(),
            );
        }
        if let Some(settings) = solid.sph() {
            notes.push(particle_note(&settings, &mesh));
        }
        let (thermal_faces, face_sources) = thermal_faces(solid, &mesh);
        let supports = supports(solid, &mesh);
        let initial_temperature = solid.initial_temperature;
        Self {
            mesh,
            law,
            initial_temperature,
            sph: solid.sph(),
            thermal_faces,
            face_sources,
            supports,
            mechanics,
            notes,
        }
    }

    /// Unknowns of heat and of displacement, symmetry used.
    pub fn unknowns(&self) -> [usize; 2] {
        let nodes = self.mesh.nodes();
        let degrees = if self.mesh.geometry == Geometry::Box { 3 } else { 2 };
        [nodes, if self.mechanics { nodes.saturating_mul(degrees) } else { 0 }]
    }
}

/// Distances of nodes and growth of elements.
struct Sizes {
    lateral: f64,
    depth: f64,
    growth: f64,
    order: usize,
}

impl Sizes {
    fn choose(
        solid: &Solid,
        law: &Thermoelastic,
        refinements: &[Refinement],
        stop_time: f64,
        notes: &mut Vec<String>,
    ) -> Self {
        let given = &solid.mesh;
        let default = if solid.heat == HeatMethod::Sph { 1 } else { DEFAULT_ORDER };
        let order = given.order.unwrap_or(default);
        let width = lateral_extents(&solid.shape).into_iter().fold(f64::INFINITY, f64::min);
        let feature = refinements.iter().map(|r| r.feature).fold(width, f64::min);
        let reach = (law.diffusivity() * stop_time).sqrt();
        let lateral = given.spacing.unwrap_or(feature / NODES_PER_FEATURE);
        let depth = given.depth_spacing.or(given.spacing).unwrap_or_else(|| {
            lateral.min(reach / NODES_PER_DIFFUSION_LENGTH).max(solid.shape.thickness() / 500.0)
        });
        if given.spacing.is_none() {
            notes.push(format!(
                "mesh spacing chosen: {lateral:.3e} m along the surface (a tenth of the finest \
                 load), {depth:.3e} m in depth (heat reaches {reach:.3e} m by the stop time)"
            ));
        }
        Self { lateral, depth, growth: given.growth.unwrap_or(DEFAULT_GROWTH), order }
    }
}

impl Sizes {
    /// Largest element where `usual` would do: without growth all are of one `size`.
    fn coarsest(&self, usual: f64, size: f64) -> f64 {
        if self.growth == 1.0 { size } else { usual }
    }
}

fn particle_note(settings: &SphSettings, mesh: &Mesh) -> String {
    let operator = match settings.operator {
        SphOperator::Corrected if mesh.axes.iter().all(Axis::is_uniform) => {
            "the corrected operator, which conserves heat to rounding at equal distances"
        }
        SphOperator::Corrected => {
            "the corrected operator, which conserves heat only approximately on a graded mesh: see \
             heat_drift"
        }
        SphOperator::Plain => {
            "the plain operator, which conserves heat but misses the conductivity by a share that \
             no refinement lowers"
        }
    };
    format!(
        "particles on the nodes conduct the heat by {operator}; supports of {} distances",
        settings.support
    )
}

/// Along which axes half the body stands for the whole.
fn mirrored(solid: &Solid, notes: &mut Vec<String>) -> [bool; 2] {
    if matches!(solid.shape, Shape::Disc(_)) {
        notes.push("axisymmetric: a meridian section stands for the disc".into());
        return [false; 2];
    }
    if solid.symmetry == Symmetry::None {
        notes.push("the whole box is meshed, as the scene asks".into());
        return [false; 2];
    }
    let pairs = [(FaceName::Left, FaceName::Right, "x"), (FaceName::Front, FaceName::Back, "y")];
    pairs.map(|(low, high, axis)| {
        let alike = alike(&solid.face(low), &solid.face(high));
        notes.push(match alike {
            true => format!(
                "half the box along {axis} is meshed: its two faces have like conditions; loads \
                 split into parts even and odd about {axis} = 0, and odd parts cost nothing until \
                 a load has them"
            ),
            false => format!(
                "the box is meshed whole along {axis}: its two faces have unlike conditions"
            ),
        });
        alike
    })
}

/// Whether two faces differ at most in the values of inputs.
fn alike(a: &Face, b: &Face) -> bool {
    a.temperature.is_some() == b.temperature.is_some()
        && a.flux.is_some() == b.flux.is_some()
        && a.convection.map(|c| c.coefficient) == b.convection.map(|c| c.coefficient)
        && a.clamped == b.clamped
        && a.roller == b.roller
}

fn lateral_extents(shape: &Shape) -> Vec<f64> {
    match shape {
        Shape::Box([x, y, _]) => vec![*x, *y],
        Shape::Disc(disc) => vec![disc.radius],
    }
}

fn build_mesh(
    solid: &Solid,
    mirrored: [bool; 2],
    sizes: &Sizes,
    refinements: &[Refinement],
) -> Mesh {
    let element = sizes.order as f64;
    let lateral = |start: f64, end: f64, stretch: &dyn Fn(&Refinement) -> [f64; 2]| {
        let margin = 2.0 * sizes.lateral;
        let fine: Vec<Fine> = refinements
            .iter()
            .map(|r| {
                let [from, to] = fold(stretch(r), start);
                Fine { from: from - margin, to: to + margin, size: element * sizes.lateral }
            })
            .collect();
        let coarsest = sizes.coarsest(end / LATERAL_ELEMENTS, element * sizes.lateral);
        graded_ends(start, end, &fine, sizes.growth, coarsest)
    };
    let height = {
        let thickness = solid.shape.thickness();
        let size = element * sizes.depth;
        let fine: Vec<Fine> = fine_faces(solid, refinements)
            .into_iter()
            .map(|top| if top { 0.0 } else { -thickness })
            .map(|z| Fine { from: z - size, to: z + size, size })
            .collect();
        let coarsest = sizes.coarsest((thickness / THICKNESS_ELEMENTS).max(size), size);
        let ends = graded_ends(-thickness, 0.0, &fine, sizes.growth, coarsest);
        Axis::from_element_ends(&ends, sizes.order, Weight::Uniform)
    };
    let uniform = |ends: Vec<f64>| Axis::from_element_ends(&ends, sizes.order, Weight::Uniform);
    match solid.shape {
        Shape::Box([lx, ly, _]) => {
            let start = |half: f64, mirrored: bool| if mirrored { 0.0 } else { -half };
            let x = lateral(start(lx / 2.0, mirrored[0]), lx / 2.0, &|r| r.x);
            let y = lateral(start(ly / 2.0, mirrored[1]), ly / 2.0, &|r| r.y);
            Mesh { axes: [uniform(x), uniform(y), height], mirrored, geometry: Geometry::Box }
        }
        Shape::Disc(disc) => {
            let r = lateral(0.0, disc.radius, &|r| r.x);
            let radii = Axis::from_element_ends(&r, sizes.order, Weight::Radial);
            let geometry = Geometry::Axisymmetric;
            Mesh { axes: [radii, Axis::point(), height], mirrored, geometry }
        }
    }
}

/// A stretch brought to the meshed half, where the mesh begins at the symmetry plane.
fn fold([from, to]: [f64; 2], start: f64) -> [f64; 2] {
    if start != 0.0 {
        return [from, to];
    }
    let far = from.abs().max(to.abs());
    let near = if from < 0.0 && to > 0.0 { 0.0 } else { from.abs().min(to.abs()) };
    [near, far]
}

/// Whether the top (true) and the bottom need a fine mesh: where heat or traction enters.
fn fine_faces(solid: &Solid, refinements: &[Refinement]) -> Vec<bool> {
    [(true, FaceName::Top), (false, FaceName::Bottom)]
        .into_iter()
        .filter(|&(top, face)| {
            let face = solid.face(face);
            refinements.iter().any(|r| r.top == top)
                || face.temperature.is_some()
                || face.flux.is_some()
        })
        .map(|(top, _)| top)
        .collect()
}

type ThermalFaces = (Vec<(MeshFace, ThermalFace)>, Vec<(FaceName, Option<FaceName>)>);

fn thermal_faces(solid: &Solid, mesh: &Mesh) -> ThermalFaces {
    let mut faces: Vec<(MeshFace, ThermalFace)> = Vec::new();
    let mut sources: Vec<(FaceName, Option<FaceName>)> = Vec::new();
    for &name in solid.shape.faces() {
        let Some(condition) = thermal_condition(&solid.face(name)) else { continue };
        let (place, image) = mesh.place(name);
        // The own face of a mirrored axis is always there: its conditions are like the image's.
        if image {
            continue;
        }
        faces.push((place, condition));
        sources.push((name, opposite(name).filter(|&other| mesh.place(other) == (place, true))));
    }
    (faces, sources)
}

/// The face across the box.
fn opposite(face: FaceName) -> Option<FaceName> {
    match face {
        FaceName::Right => Some(FaceName::Left),
        FaceName::Back => Some(FaceName::Front),
        _ => None,
    }
}

fn thermal_condition(face: &Face) -> Option<ThermalFace> {
    if face.temperature.is_some() {
        Some(ThermalFace::Prescribed)
    } else if let Some(convection) = face.convection {
        Some(ThermalFace::Convective(convection.coefficient))
    } else {
        face.flux.map(|_| ThermalFace::Flux)
    }
}

fn supports(solid: &Solid, mesh: &Mesh) -> Vec<(MeshFace, Support)> {
    let mut supports = Vec::new();
    for &name in solid.shape.faces() {
        let face = solid.face(name);
        let support = match (face.clamped, face.roller) {
            (true, _) => Support::Clamped,
            (false, true) => Support::Roller,
            _ => continue,
        };
        let (place, image) = mesh.place(name);
        if !image {
            supports.push((place, support));
        }
    }
    supports
}
