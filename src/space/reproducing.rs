//! Reproducing-kernel discretisations of a mesh's nodes, of which the element-free Galerkin method is one.

mod basis;
mod cell_map;
mod cells;
pub(super) mod facets;
mod functions;
mod kernel;
mod nodal_cells;
mod nodal_points;
mod refused;
mod second_smoothing;
mod sides;

pub(super) use functions::spacings;
pub use functions::{Functions, Row};
pub use kernel::Kernel;
pub use refused::Refused;
pub use sides::Sides;

use super::shares::shares;
use super::{Form, Mesh, Samples, Sharing, Side, Space};
use second_smoothing::smoothed_again;

/// Settings of a discretisation by reproducing kernels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reproducing {
    /// Order of the polynomials that the functions reproduce, 1 or 2.
    pub basis: usize,
    pub kernel: Kernel,
    pub shape: Shape,
    /// Half of the width of supports over the spacing of nodes; it must exceed `basis`.
    pub support: f64,
    pub integration: Integration,
    /// Radius over which nodal integration averages gradients once more [m].
    pub smoothing: Option<f64>,
    /// Flat sides on which functions of other nodes vanish, so that displacements of their nodes prescribe those of the
    /// sides. Elsewhere prescribed displacements need Nitsche's method or multipliers.
    pub held: Sides,
}

impl Default for Reproducing {
    fn default() -> Self {
        Self {
            basis: 1,
            kernel: Kernel::CubicSpline,
            shape: Shape::Box,
            support: 1.75,
            integration: Integration::Nsni,
            smoothing: None,
            held: Sides::default(),
        }
    }
}

/// Shape of supports.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Shape {
    /// A product of kernels along each coordinate.
    #[default]
    Box,
    /// A kernel of the distance.
    Round,
}

/// Points of the volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Integration {
    /// Gauss points of the mesh's cells, as many along each edge.
    Gauss(usize),
    /// Stabilised conforming nodal integration: one point for each node, with the mean gradient over the node's cell.
    Scni,
    /// Naturally stabilised nodal integration: two points along each coordinate for each node, with the gradient that
    /// is closest to the functions' own among those linear over the node's cell.
    Nsni,
}

impl Integration {
    /// Number of points of a cell of the mesh, or of a node.
    pub fn points_of_cell(self, form: Form) -> usize {
        let axes = form.axes().len();
        match self {
            Self::Gauss(count) => count.pow(axes as u32),
            Self::Scni => 1,
            Self::Nsni => 2 * axes,
        }
    }
}

/// Creates the space of the reproducing-kernel functions of a mesh's nodes. Each point is alone in its group.
///
/// With nodal integration the divergence theorem holds in sums, Σ w ∇Ψ = Σ Ψ n over the points of the volume and the
/// boundary (with n weighted by areas), so stresses that are constant balance to rounding; with [`Integration::Nsni`]
/// it also holds with linear weights.
pub fn reproducing(mesh: &Mesh, settings: Reproducing) -> Result<Space, Refused> {
    settings.check()?;
    settings.check_smoothing(mesh.form)?;
    let surface = facets::surface(mesh);
    let planes = facets::planes(mesh, &surface, settings.held);
    let functions = Functions::new(mesh, settings, planes);
    let (volume, boundary) = match settings.integration {
        Integration::Gauss(count) => (
            cells::volume(mesh, &functions, count)?,
            cells::boundary(mesh, &functions, &surface, count)?,
        ),
        Integration::Scni | Integration::Nsni => {
            let (cells, boundary) =
                nodal_cells::nodal_cells(mesh, &functions, &surface, settings.basis + 1)?;
            let points = match settings.integration {
                Integration::Scni => nodal_points::smoothed,
                _ => nodal_points::stabilised,
            };
            let volume = points(mesh, cells)?;
            let of_cell = volume.len() / mesh.nodes.len();
            match settings.smoothing {
                Some(radius) => (smoothed_again(mesh.form, &volume, of_cell, radius), boundary),
                None => (volume, boundary),
            }
        }
    };
    let shares = shares(mesh, &volume);
    let at_nodes = at_nodes(mesh, &functions, &shares)?;
    Ok(Space {
        form: mesh.form,
        order: 1,
        nodes: mesh.nodes.clone(),
        groups: (0..volume.len()).map(|n| n..n + 1).collect(),
        sharing: Sharing::Mean,
        volume,
        boundary,
        at_nodes: Some(at_nodes),
        shares,
        links: mesh.edges(),
    })
}

impl Functions {
    /// Creates the functions of a mesh's nodes, to be evaluated at any place.
    pub fn of(mesh: &Mesh, settings: Reproducing) -> Result<Self, Refused> {
        settings.check()?;
        let planes = facets::planes(mesh, &facets::surface(mesh), settings.held);
        Ok(Self::new(mesh, settings, planes))
    }
}

impl Reproducing {
    fn check(&self) -> Result<(), Refused> {
        if !(1..=2).contains(&self.basis) {
            return Err(Refused::Setting("`basis` must be 1 or 2"));
        }
        if !(self.support > self.basis as f64 && self.support.is_finite()) {
            return Err(Refused::Setting("`support` must exceed `basis`"));
        }
        if self.held.contains(Side::Round) {
            return Err(Refused::Setting("a round side cannot be held by its nodes"));
        }
        if self.integration == Integration::Gauss(0) {
            return Err(Refused::Setting(
                "Gauss quadrature needs at least one point along each edge",
            ));
        }
        Ok(())
    }

    fn check_smoothing(&self, form: Form) -> Result<(), Refused> {
        let fine = form != Form::Axisymmetric && !matches!(self.integration, Integration::Gauss(_));
        if self.smoothing.is_some_and(|radius| !(fine && radius > 0.0 && radius.is_finite())) {
            return Err(Refused::Setting(
                "a second smoothing has a radius above 0 and averages gradients of nodal integration, not of rings",
            ));
        }
        Ok(())
    }
}

/// Functions at the nodes, without gradients; each weight is the node's share.
fn at_nodes(mesh: &Mesh, functions: &Functions, shares: &[f64]) -> Result<Samples, Refused> {
    let mut samples = Samples::default();
    let mut row = Row::default();
    for (&at, &share) in mesh.nodes.iter().zip(shares) {
        functions.evaluate(at, false, &mut row)?;
        samples.push(at, share, row.values());
    }
    Ok(samples)
}
