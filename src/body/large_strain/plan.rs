//! Converts a solid of large strain of a scene to its mesh and its mechanics.

use crate::laws::solid::large_strain::LargeStrainLaw;
use crate::method::fem::Refinement;
use crate::method::large_strain::{Deformable, Failure, Plane};
use crate::scene::{
    Coupling, FaceName, KernelIntegration, KernelSettings, LargeStrain, Mechanics, SolidShape,
};
use crate::space::{
    Form, Integration, Kernel, Mesh, Reproducing, Shape, Side, Sides, finite_elements, reproducing,
};

/// Stiffness of the plane over that of a layer of the body one spacing thick.
const PLANE: f64 = 1.0;
/// Elements of a ball from its inner block, 0.55 of its radius, to its surface.
const OUTER: f64 = 0.45;
const INNER: f64 = 0.55;
/// Width of a body that has spread over its own.
const SPREAD: f64 = 1.3;

pub fn form(solid: &LargeStrain) -> Form {
    match (solid.is_axisymmetric(), solid.dimension) {
        (true, _) => Form::Axisymmetric,
        (false, 2) => Form::Plane,
        (false, _) => Form::Solid,
    }
}

pub fn mesh(solid: &LargeStrain) -> Mesh {
    let (form, mirrors, spacing) = (form(solid), solid.mirrors(), solid.spacing());
    let [x, y, z] = solid.extents();
    let count = |length: f64| (length / spacing).round().max(1.0) as usize;
    match solid.shape {
        SolidShape::Ball(ball) => {
            let [inner, outer] = [INNER, OUTER].map(|part| count(part * ball.radius));
            Mesh::of_ball(form, ball.radius, inner, outer, mirrors)
        }
        SolidShape::Disc(disc) if form == Form::Solid => {
            let [inner, outer] = [INNER, OUTER].map(|part| count(part * disc.radius));
            Mesh::of_cylinder([disc.radius, disc.thickness], [inner, outer, count(z)], mirrors)
        }
        SolidShape::Box(_) | SolidShape::Disc(_) => {
            let halved = [mirrors[0] || form == Form::Axisymmetric, mirrors[1]];
            let low = |a: usize, length: f64| if halved[a] { 0.0 } else { -0.5 * length };
            let (left, front) = (low(0, x), low(1, y));
            let counts = [count(0.5 * x - left), count(0.5 * y - front), count(z)];
            let mesh = Mesh::of_box(form, [left, front, -z], [0.5 * x, 0.5 * y, 0.0], counts);
            // Planes of symmetry bound the model and not the body.
            let cut =
                |side: Side| side == Side::Left && halved[0] || side == Side::Front && halved[1];
            Mesh { faces: mesh.faces.into_iter().filter(|(side, _)| !cut(*side)).collect(), ..mesh }
        }
    }
}

pub fn law(solid: &LargeStrain) -> LargeStrainLaw {
    let law = solid.material.material().law.deformation().large_strain(solid.initial_temperature);
    law.expect("a checked solid of large strain has a law of large strain")
}

pub fn deformable(solid: &LargeStrain, threads: usize) -> Result<Deformable, Failure> {
    let density = solid.material.material().heat.density;
    let mesh = mesh(solid);
    let space = match solid.mechanics {
        Mechanics::Fem => finite_elements(&mesh),
        Mechanics::Rkpm | Mechanics::Efg => reproducing(&mesh, kernels(solid, &mesh))?,
    };
    Ok(Deformable::new(space, law(solid), density, solid.mirrors(), threads))
}

/// Settings of reproducing kernels, with functions that can be held at the faces of a body.
pub fn kernels(solid: &LargeStrain, mesh: &Mesh) -> Reproducing {
    let KernelSettings { basis, support, integration } = solid.rkpm.unwrap_or_default();
    let order = basis as f64;
    let is_held = |side: &Side| solid.faces.keys().any(|&face| is_on(solid, face, *side));
    let held: Vec<Side> = mesh.faces.iter().map(|(side, _)| *side).filter(is_held).collect();
    let kernel = match solid.mechanics {
        Mechanics::Efg => Kernel::QuarticSpline,
        Mechanics::Rkpm | Mechanics::Fem => Kernel::CubicSpline,
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
        held: Sides::of(&held),
    }
}

/// The plane below a body that moves.
pub fn plane(solid: &LargeStrain, body: &Deformable) -> Plane {
    let spacing = solid.spacing();
    let lowest = body.space.nodes.iter().map(|at| at[2]).fold(f64::INFINITY, f64::min);
    Plane {
        stiffness: PLANE * body.law.wave_modulus() / spacing,
        height: solid.start.height - lowest,
        width: spacing,
    }
}

/// Refinement of the solid on which a body falls: below the body as it spreads, as far as half of its width resolves it.
pub fn refinement(coupling: &Coupling, solid: &LargeStrain) -> Refinement {
    let [width, depth, _] = solid.extents();
    let reach = |length: f64| coupling.radius.unwrap_or(SPREAD * 0.5 * length);
    let [x, y] = [width, depth].map(|length| [-reach(length), reach(length)]);
    let feature = 0.5 * width.min(depth);
    Refinement { x, y, top: true, feature, heats: false, edges: [None; 2] }
}

/// Axis normal to a side; rollers on round sides are those of sections.
pub fn normal(side: Side) -> usize {
    match side {
        Side::Left | Side::Right | Side::Round => 0,
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
    };
    own == face || face == FaceName::Sides && own.is_one_of_four_sides()
}
