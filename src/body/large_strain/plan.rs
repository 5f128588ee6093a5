//! Converts a solid of large strain of a scene to its mesh and its mechanics.

use std::ops::Range;

use crate::laws::Material;
use crate::method::fem::Refinement;
use crate::method::large_strain::{Deformable, Failure, LayerOfBody, Plane};
use crate::scene::{
    Coupling, FaceName, HeldFace, KernelIntegration, KernelSettings, LargeStrain, Mechanics, Part,
    PartBody, SolidShape,
};
use crate::space::{
    Form, Integration, Kernel, Mesh, Reproducing, Shape, Side, Sides, Space, cells_along,
    finite_elements, particles, particles_of_cloud, reproducing,
};

/// Stiffness of the plane over that of a layer of the body one spacing thick.
const PLANE: f64 = 1.0;
/// Elements of a ball from its inner block, 0.55 of its radius, to its surface.
const OUTER: f64 = 0.45;
const INNER: f64 = 0.55;
/// Width of a body that has spread over its own.
const SPREAD: f64 = 1.3;

/// The mesh of a solid; that of points has no cells.
pub fn mesh(solid: &LargeStrain) -> Mesh {
    let (form, mirrors, spacing) = (solid.form(), solid.mirrors(), solid.spacing());
    let order = solid.order();
    let [x, y, z] = solid.extents();
    let count = |length: f64| cells_along(length, order, spacing);
    match &solid.shape {
        SolidShape::Ball(ball) => {
            let counts = [INNER, OUTER].map(|part| count(part * ball.radius));
            Mesh::of_ball_by((form, order), ball.radius, counts, mirrors)
        }
        SolidShape::Disc(disc) if form == Form::Solid => {
            let [inner, outer] = [INNER, OUTER].map(|part| count(part * disc.radius));
            let heights = heights(solid);
            let counts = [inner, outer, (heights.len() - 1) / order];
            let mesh = Mesh::of_cylinder(order, [disc.radius, disc.thickness], counts, mirrors);
            if solid.layers.is_some() { mesh.at_heights(&heights) } else { mesh }
        }
        SolidShape::Quadrilateral(own) => {
            let [bottom, right, top, left] = own.edges();
            let counts = [count(bottom.max(top)), count(if mirrors[1] { 0.5 * y } else { y })];
            let counts = [counts[0], counts[1], count(left.max(right))];
            let front = if mirrors[1] { 0.0 } else { -0.5 * y };
            let ends = [[0.0, front, 0.0], [1.0, 0.5 * y, 1.0]];
            let mesh = Mesh::of_box_by((form, order), ends[0], ends[1], counts);
            let mesh = mesh.without_cuts([false, mirrors[1]]);
            mesh.mapped(|[u, y, w]| {
                let [x, z] = own.place(u, w);
                [x, y, z]
            })
        }
        SolidShape::Strand(strand) => strand.sweep(form).mesh(order, spacing),
        SolidShape::Part(part) => match part.body().expect(CHECKED) {
            PartBody::Cells(mesh) => mesh.clone(),
            PartBody::Points(cloud) => cloud.surface(),
        },
        SolidShape::Box(_) | SolidShape::Disc(_) => {
            let halved = [mirrors[0] || form == Form::Axisymmetric, mirrors[1]];
            let low = |a: usize, length: f64| if halved[a] { 0.0 } else { -0.5 * length };
            let (left, front) = (low(0, x), low(1, y));
            let heights = heights(solid);
            let layers = (heights.len() - 1) / order;
            let counts = [count(0.5 * x - left), count(0.5 * y - front), layers];
            let ends = [[left, front, -z], [0.5 * x, 0.5 * y, 0.0]];
            let mesh = Mesh::of_box_by((form, order), ends[0], ends[1], counts);
            let mesh = if solid.layers.is_some() { mesh.at_heights(&heights) } else { mesh };
            mesh.without_cuts(halved)
        }
    }
}

const CHECKED: &str = "a checked scene has read its parts";

/// Number of cells of a mesh, or of the points that stand for them.
pub fn cells(mesh: &Mesh) -> usize {
    if mesh.cells.is_empty() { mesh.nodes.len() } else { mesh.cells.len() }
}

/// The layers, from the top.
pub fn layers(solid: &LargeStrain) -> Vec<LayerOfBody> {
    let of_layer = |material: &Material| {
        let law = material.law.deformation().large_strain(solid.initial_temperature);
        LayerOfBody {
            law: law.expect("a checked solid of large strain has a law of large strain"),
            density: material.heat.density,
        }
    };
    solid.materials_of_layers().into_iter().map(of_layer).collect()
}

pub fn deformable(solid: &LargeStrain, threads: usize) -> Result<Deformable, Failure> {
    let mesh = mesh(solid);
    let layers = layers(solid);
    let alone = |space: Space| if solid.is_sheet() { space.with_points_alone() } else { space };
    let sheet = |body: Deformable| if solid.is_sheet() { body.of_sheet() } else { body };
    if solid.layers.is_some() {
        let space = alone(finite_elements(&mesh));
        let of_groups = layers_of_groups(solid, &space);
        let body = Deformable::layered(space, (layers, of_groups), solid.mirrors(), threads);
        return Ok(sheet(body));
    }
    let LayerOfBody { law, density } = layers.into_iter().next().expect("a body has a material");
    let space = match solid.mechanics {
        Mechanics::Fem => finite_elements(&mesh),
        Mechanics::Rkpm | Mechanics::Efg => {
            let settings = kernels(solid, &mesh);
            let space = reproducing(&mesh, settings)?;
            let of_cell = settings.integration.points_of_cell(space.form);
            // What hardly changes its volume would lock.
            if law.is_nearly_incompressible() { space.with_points_together(of_cell) } else { space }
        }
        Mechanics::Sph => {
            let support = solid.sph.unwrap_or_default().support;
            match solid.part().and_then(Part::body) {
                Some(PartBody::Points(cloud)) => particles_of_cloud(cloud, support)?,
                _ => particles(&mesh, support)?,
            }
        }
    };
    Ok(sheet(Deformable::new(alone(space), law, density, solid.mirrors(), threads)))
}

/// Layer of each group of points, all of which lie in it.
fn layers_of_groups(solid: &LargeStrain, space: &Space) -> Vec<usize> {
    let heights = solid.heights_of_layers();
    let of_group = |group: &Range<usize>| {
        let z = space.volume.at[group.start][2];
        heights.iter().position(|[low, _]| z > *low).unwrap_or(heights.len() - 1)
    };
    space.groups.iter().map(of_group).collect()
}

/// Heights of the nodes of a box or a disc, from the bottom [m]: each layer has elements of its own.
fn heights(solid: &LargeStrain) -> Vec<f64> {
    let least = if solid.layers.is_some() { LEAST_IN_LAYER } else { 1 };
    let order = solid.order();
    let mut heights = Vec::new();
    for [low, high] in solid.heights_of_layers().into_iter().rev() {
        let count = order * cells_along(high - low, order, solid.spacing()).max(least / order);
        heights.extend((0..count).map(|n| low + (high - low) * n as f64 / count as f64));
    }
    heights.push(0.0);
    heights
}

/// Fewest distances of nodes through a layer.
const LEAST_IN_LAYER: usize = 2;

/// Settings of reproducing kernels, with functions that can be held at the faces of a body.
pub fn kernels(solid: &LargeStrain, mesh: &Mesh) -> Reproducing {
    let KernelSettings { basis, support, integration, smoothing } = solid.rkpm.unwrap_or_default();
    let order = basis as f64;
    let is_held = |side: &Side| {
        let ends = |own: &HeldFace| own.is_held() || own.temperature.is_some();
        solid.faces.iter().any(|(&face, own)| ends(own) && is_on(solid, face, *side))
    };
    let held: Vec<Side> = mesh.faces.iter().map(|(side, _)| *side).filter(is_held).collect();
    let kernel = match solid.mechanics {
        Mechanics::Efg => Kernel::QuarticSpline,
        Mechanics::Rkpm | Mechanics::Fem | Mechanics::Sph => Kernel::CubicSpline,
    };
    Reproducing {
        basis,
        kernel,
        shape: Shape::Box,
        support: support.unwrap_or(order + 0.75),
        integration: match integration {
            KernelIntegration::Nsni => Integration::Nsni,
            KernelIntegration::Scni => Integration::Scni,
            KernelIntegration::Gauss => Integration::Gauss(basis + 1),
        },
        smoothing,
        held: Sides::of(&held),
    }
}

/// The plane below a body that moves.
pub fn plane(solid: &LargeStrain, body: &Deformable) -> Plane {
    let spacing = solid.spacing();
    let lowest = body.space.nodes.iter().map(|at| at[2]).fold(f64::INFINITY, f64::min);
    Plane {
        stiffness: PLANE * body.wave_modulus() / spacing,
        height: solid.start.height - lowest,
        width: spacing,
        friction: solid.friction,
    }
}

/// Refinement of the solid on which a body falls: below the body as it spreads, as far as half of its width resolves
/// it.
pub fn refinement(coupling: &Coupling, solid: &LargeStrain) -> Refinement {
    let [width, depth, _] = solid.extents();
    let reach = |length: f64| coupling.radius.unwrap_or(SPREAD * 0.5 * length);
    let [x, y] = [width, depth].map(|length| [-reach(length), reach(length)]);
    let feature = 0.5 * width.min(depth);
    Refinement { x, y, top: true, feature, heats: solid.conducts(), edges: [None; 2] }
}

/// Axis normal to a side; rollers on round sides are those of sections.
pub fn normal(side: Side) -> usize {
    match side {
        Side::Left | Side::Right | Side::Round | Side::Free => 0,
        Side::Front | Side::Back => 1,
        Side::Bottom | Side::Top => 2,
    }
}

/// Side of the mesh that is a face of the shape.
pub fn is_on(solid: &LargeStrain, face: FaceName, side: Side) -> bool {
    let own = match side {
        Side::Left => FaceName::Left,
        Side::Right if matches!(solid.shape, SolidShape::Disc(_)) => FaceName::Sides,
        Side::Right => FaceName::Right,
        Side::Front => FaceName::Front,
        Side::Back => FaceName::Back,
        Side::Bottom => FaceName::Bottom,
        Side::Top => FaceName::Top,
        Side::Round => FaceName::Sides,
        Side::Free => return false,
    };
    own == face || solid.has_four_sides() && face == FaceName::Sides && own.is_one_of_four_sides()
}
