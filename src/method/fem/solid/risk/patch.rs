//! Elements and parts of faces over which the risk of failure is integrated, with the Gauss points of each.

use crate::laws::{Extent, FlawStatistics};
use crate::method::fem::elastic::Support;
use crate::method::fem::free_faces::is_inside;
use crate::method::fem::plan::Plan;
use crate::method::mesh::{Axis, Geometry, Mesh, MeshFace};

/// An element, or a part of a face, of a layer.
pub(super) struct Patch {
    pub spans: [Span; 3],
    pub layer: usize,
}

/// A Gauss point of an element along one axis.
#[derive(Clone, Copy)]
pub(super) struct Point {
    pub place: f64,
    pub weight: f64,
    pub shape: [f64; 3],
}

/// An element, or a node on a face, along one axis.
#[derive(Clone, Copy)]
pub(super) struct Span {
    /// The element; `None` for a single node.
    element: Option<usize>,
    /// Number of nodes.
    pub count: usize,
    /// First node, in the list with doubled interfaces along z.
    first: usize,
    /// Place of that node on the axis.
    node: usize,
}

/// Ends of the axes that are faces on which flaws may be. Lateral planes on rollers are planes of symmetry, which have
/// none; a bottom on rollers stands on something, and the rim of a disc is no plane.
pub(super) fn faces(plan: &Plan) -> [[bool; 2]; 3] {
    let mesh = &plan.mesh;
    let is_face = |axis: usize, high: bool| {
        let is_lateral_plane = axis < 2 && mesh.geometry == Geometry::Box;
        let rollers = (MeshFace { axis, high }, Support::Roller);
        let is_plane_of_symmetry = is_lateral_plane && plan.supports.contains(&rollers);
        mesh.axes[axis].elements() > 0 && (high || !is_inside(mesh, axis)) && !is_plane_of_symmetry
    };
    [0, 1, 2].map(|axis| [false, true].map(|high| is_face(axis, high)))
}

/// Elements of the layers with flaws, or the parts of their faces.
pub(super) fn patches(
    mesh: &Mesh,
    layers: &[Option<FlawStatistics>],
    faces: [[bool; 2]; 3],
) -> Vec<Patch> {
    let all = |axis: usize| -> Vec<Span> {
        let count = mesh.axes[axis].elements().max(1);
        (0..count).map(|element| Span::of(mesh, axis, element)).collect()
    };
    let mut list = Vec::new();
    let mut add = |layer: usize, xs: &[Span], ys: &[Span], zs: &[Span]| {
        for &z in zs {
            for &y in ys {
                list.extend(xs.iter().map(|&x| Patch { spans: [x, y, z], layer }));
            }
        }
    };
    let (xs, ys) = (all(0), all(1));
    let top = mesh.layering.count() - 1;
    for (layer, statistics) in layers.iter().enumerate() {
        let Some(statistics) = statistics else { continue };
        let elements = mesh.layer_elements(layer);
        let zs: Vec<Span> = elements.map(|element| Span::of(mesh, 2, element)).collect();
        if let Extent::Volume(_) = statistics.extent {
            add(layer, &xs, &ys, &zs);
            continue;
        }
        for high in [false, true] {
            if layer == if high { top } else { 0 } {
                add(layer, &xs, &ys, &[Span::end(mesh, 2, high)]);
            }
            let is_face = |axis: usize| faces[axis][usize::from(high)];
            if is_face(0) {
                add(layer, &[Span::end(mesh, 0, high)], &ys, &zs);
            }
            if is_face(1) {
                add(layer, &xs, &[Span::end(mesh, 1, high)], &zs);
            }
        }
    }
    list
}

/// Shape functions and measures of points along each axis.
pub(super) type Points = [Vec<([f64; 3], f64)>; 3];

impl Span {
    fn of(mesh: &Mesh, axis: usize, element: usize) -> Self {
        let own = &mesh.axes[axis];
        if own.elements() == 0 {
            return Self { element: None, count: 1, first: 0, node: 0 };
        }
        let node = element * own.order;
        let below = if axis == 2 { mesh.layering.layer_of(element) } else { 0 };
        Self { element: Some(element), count: own.order + 1, first: node + below, node }
    }

    /// The node at an end of an axis.
    fn end(mesh: &Mesh, axis: usize, high: bool) -> Self {
        let last = |count: usize| if high { count - 1 } else { 0 };
        let (first, node) = (last(mesh.sided_counts()[axis]), last(mesh.axes[axis].len()));
        Self { element: None, count: 1, first, node }
    }

    /// Measure of the span: its length, or area along a radius.
    fn measure(&self, axis: &Axis) -> f64 {
        match self.element {
            None => axis.weight_at(axis.nodes[self.node]),
            Some(element) => {
                let [a, b] = axis.bounds(element);
                axis.weight_at(0.5 * (a + b)) * (b - a)
            }
        }
    }

    /// Shape functions and measures of the points of a rule.
    pub fn points(&self, axis: &Axis, rule: &[Point]) -> Vec<([f64; 3], f64)> {
        let Some(element) = self.element else {
            return vec![([1.0, 0.0, 0.0], self.measure(axis))];
        };
        let [a, b] = axis.bounds(element);
        let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
        let at = |point: &Point| {
            let measure = axis.weight_at(middle + half * point.place);
            (point.shape, half * point.weight * measure)
        };
        rule.iter().map(at).collect()
    }
}

impl Patch {
    /// Passes each node with its place among the patch's nodes.
    pub fn for_nodes(&self, mesh: &Mesh, mut pass: impl FnMut(usize, usize)) {
        let [nx, ny, _] = mesh.sided_counts();
        let [x, y, z] = &self.spans;
        for c in 0..z.count {
            for b in 0..y.count {
                for a in 0..x.count {
                    let node = x.first + a + nx * (y.first + b + ny * (z.first + c));
                    pass(a + 3 * (b + 3 * c), node);
                }
            }
        }
    }

    pub fn measure(&self, mesh: &Mesh) -> f64 {
        let spans = self.spans.iter().zip(&mesh.axes);
        spans.map(|(span, axis)| span.measure(axis)).product()
    }
}
