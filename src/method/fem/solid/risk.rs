//! Risk of failure of a body of brittle material: `B = Σ ∫ (s/σ₀)^m dV/V₀` over its layers, or over their faces.
//!
//! The equivalent stress s is known at the nodes, of every mirror image of the mesh; between nodes it follows the shape
//! functions. It is the power that needs care: an error of s counts m times. Each element takes as many Gauss points
//! along each axis as its values vary, up to those that integrate the power of a linear function exactly, and all
//! values are relative to the largest.

use super::tangent::present;
use super::{Deformation, Extreme, SolidFem, Temperatures};
use crate::laws::{Extent, FlawStatistics};
use crate::math::gauss::gauss_legendre;
use crate::math::lagrange::shape;
use crate::method::fem::elastic::Support;
use crate::method::fem::free_faces::is_inside;
use crate::method::fem::plan::Plan;
use crate::method::mesh::{Axis, Geometry, Mesh, MeshFace};

/// Flaws of a body.
pub struct Flaws {
    /// Distribution in each layer, from the lowest on; `None` where nothing is known to break.
    layers: Vec<Option<FlawStatistics>>,
    /// Gauss rules of 1, 2, … points: place, weight and shape functions.
    rules: Vec<Vec<Point>>,
    /// Elements of the layers with flaws, or the parts of their faces.
    patches: Vec<Patch>,
    /// Nodes of these.
    bears: Vec<bool>,
    /// Ends of the axes that are faces on which flaws may be.
    faces: [[bool; 2]; 3],
}

/// An element, or a part of a face, of a layer.
struct Patch {
    spans: [Span; 3],
    layer: usize,
}

/// A Gauss point of an element along one axis.
#[derive(Clone, Copy)]
struct Point {
    place: f64,
    weight: f64,
    shape: [f64; 3],
}

/// An element, or a node on a face, along one axis.
#[derive(Clone, Copy)]
struct Span {
    /// The element; `None` for a single node.
    element: Option<usize>,
    /// Number of nodes.
    count: usize,
    /// First node, in the list with doubled interfaces along z.
    first: usize,
    /// Place of that node on the axis.
    node: usize,
}

/// Stress at the nodes of an image of the mesh [Pa].
pub type ImageStress = ([bool; 2], Vec<[f64; 6]>);

/// Largest number of points along an axis.
const MOST_POINTS: usize = 48;
/// Points of an element in which the power hardly varies, and of one whose share of the risk is below [`MINOR`].
const LEAST_POINTS: f64 = 3.0;
const POINTS_OF_MINOR: f64 = 2.0;
/// Share of the largest equivalent stress below which tension may be rounding.
const NEGLIGIBLE: f64 = 1e-6;
/// Share of the largest tension of a node by which tension may differ that meets it, and least share of tension that
/// flaws have grown under which is there at the moment.
const ROUNDING: f64 = 1e-9;
const PRESENT: f64 = 0.5;
/// Further points of an element whose stress passes through zero.
const POINTS_AT_ZERO: f64 = 24.0;
/// Share of the largest contribution below which an element counts as minor, and sum of such shares that is left out.
const MINOR: f64 = 1e-5;
const LEFT_OUT: f64 = 1e-10;

impl Flaws {
    /// Returns `None` if no layer has flaws, or nothing mechanical is modelled.
    pub fn of(plan: &Plan) -> Option<Self> {
        let layers = plan.flaws.clone();
        let is_mechanical = plan.law.is_some() || plan.inelastic.is_some();
        if !is_mechanical || layers.iter().all(Option::is_none) {
            return None;
        }
        let order = plan.mesh.order();
        let rule = |count: usize| {
            let point =
                |(place, weight): (f64, f64)| Point { place, weight, shape: shape(order, place) };
            gauss_legendre(count).into_iter().map(point).collect()
        };
        let mesh = &plan.mesh;
        let faces = faces(plan);
        let patches = patches(mesh, &layers, faces);
        let mut bears = vec![false; mesh.sided_nodes()];
        for patch in &patches {
            patch.for_nodes(mesh, |_, node| bears[node] = true);
        }
        let rules = (1..=MOST_POINTS).map(rule).collect();
        Some(Self { layers, rules, patches, bears, faces })
    }

    /// Returns true if flaws of a layer grow slowly.
    pub fn grow(&self) -> bool {
        self.layers.iter().flatten().any(|own| own.slow_growth.is_some())
    }

    /// The distribution in a layer, from the lowest on; `None` where nothing is known to break.
    pub(super) fn of_layer(&self, layer: usize) -> Option<&FlawStatistics> {
        self.layers.get(layer)?.as_ref()
    }

    /// Returns true if the end of an axis is a face on which flaws may be.
    pub(super) fn may_be_on(&self, axis: usize, high: bool) -> bool {
        self.faces[axis][usize::from(high)]
    }

    /// The distribution of a patch.
    fn of_patch(&self, patch: &Patch) -> &FlawStatistics {
        self.layers[patch.layer].as_ref().expect("patches are those of layers with flaws")
    }
}

/// Ends of the axes that are faces on which flaws may be. Lateral planes on rollers are planes of symmetry, which have
/// none; a bottom on rollers stands on something, and the rim of a disc is no plane.
fn faces(plan: &Plan) -> [[bool; 2]; 3] {
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
fn patches(mesh: &Mesh, layers: &[Option<FlawStatistics>], faces: [[bool; 2]; 3]) -> Vec<Patch> {
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
    fn points(&self, axis: &Axis, rule: &[Point]) -> Vec<([f64; 3], f64)> {
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
    fn for_nodes(&self, mesh: &Mesh, mut pass: impl FnMut(usize, usize)) {
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

    fn measure(&self, mesh: &Mesh) -> f64 {
        let spans = self.spans.iter().zip(&mesh.axes);
        spans.map(|(span, axis)| span.measure(axis)).product()
    }
}

/// Shape functions and measures of points along each axis.
type Points = [Vec<([f64; 3], f64)>; 3];

/// A patch with a share of the risk.
struct Share<'s> {
    own: &'s FlawStatistics,
    patch: &'s Patch,
    /// Nodal values relative to the largest of the patch.
    local: &'s Local,
    points: &'s Points,
    /// The largest value over the strength.
    most: f64,
}

/// Nodal values of a patch relative to a scale.
struct Local {
    values: [f64; 27],
    counts: [usize; 3],
    most: f64,
    least: f64,
}

impl Local {
    fn of(mesh: &Mesh, patch: &Patch, equivalent: &[f64], scale: f64) -> Self {
        let (mut values, mut most, mut least) = ([0.0; 27], f64::NEG_INFINITY, f64::INFINITY);
        patch.for_nodes(mesh, |place, node| {
            let value = equivalent[node] / scale;
            values[place] = value;
            most = most.max(value);
            least = least.min(value);
        });
        Self { values, counts: patch.spans.map(|span| span.count), most, least }
    }

    /// Largest change along lines of nodes in the direction of an axis, over twice the largest value; negative values
    /// count as zero.
    fn variation(&self, axis: usize) -> f64 {
        let stride = [1, 3, 9][axis];
        let others: [usize; 2] = std::array::from_fn(|i| (axis + 1 + i) % 3);
        let mut most = 0.0_f64;
        for i in 0..self.counts[others[0]] {
            for j in 0..self.counts[others[1]] {
                let first = i * [1, 3, 9][others[0]] + j * [1, 3, 9][others[1]];
                let line = (0..self.counts[axis]).map(|k| self.values[first + k * stride].max(0.0));
                let [low, high] =
                    line.fold([f64::INFINITY, 0.0], |[low, high], v| [low.min(v), high.max(v)]);
                most = most.max((high - low) / (2.0 * self.most - (high - low)));
            }
        }
        most
    }

    /// `∫ ⟨s⟩^m` over the patch, with a list of points for each axis.
    fn integral(&self, points: &Points, power: impl Fn(f64) -> f64) -> f64 {
        let cap = self.cap();
        let mut sum = 0.0;
        self.for_points(points, |value, _, measure| {
            if value > 0.0 {
                sum += measure * power(value.min(cap));
            }
        });
        sum
    }

    /// `∫ m ⟨s⟩^(m−1) ṡ` over the patch, with the nodal values of ṡ.
    fn integral_of_change(
        &self,
        change: &Self,
        points: &Points,
        slope: impl Fn(f64) -> f64,
    ) -> f64 {
        let cap = self.cap();
        let mut sum = 0.0;
        self.for_points(points, |value, shapes, measure| {
            if value > 0.0 {
                sum += measure * slope(value.min(cap)) * change.at(shapes);
            }
        });
        sum
    }

    /// Interpolation between positive and negative nodes may overshoot.
    fn cap(&self) -> f64 {
        if self.least < 0.0 { self.most } else { f64::INFINITY }
    }

    /// Value at a point of given shape functions along the axes.
    fn at(&self, [x, y, z]: [&[f64; 3]; 3]) -> f64 {
        let nodes = self.values.iter().enumerate();
        nodes.map(|(n, value)| x[n % 3] * y[n / 3 % 3] * z[n / 9] * value).sum()
    }

    /// Passes the value, the shape functions and the measure of each point.
    fn for_points(&self, points: &Points, mut pass: impl FnMut(f64, [&[f64; 3]; 3], f64)) {
        for (along_z, of_z) in &points[2] {
            let plane: [f64; 9] = std::array::from_fn(|n| {
                (0..self.counts[2]).map(|c| along_z[c] * self.values[n + 9 * c]).sum()
            });
            for (along_y, of_y) in &points[1] {
                let line: [f64; 3] = std::array::from_fn(|n| {
                    (0..self.counts[1]).map(|b| along_y[b] * plane[n + 3 * b]).sum()
                });
                for (along_x, of_x) in &points[0] {
                    let value: f64 = along_x.iter().zip(line).map(|(n, value)| n * value).sum();
                    pass(value, [along_x, along_y, along_z], of_x * of_y * of_z);
                }
            }
        }
    }
}

/// How the tension of a patch comes to its running maxima.
struct Rise {
    /// The largest tension so far, zero for none, and the larger of it and the present one.
    before: f64,
    after: f64,
    /// True if a node meets its largest tension now, and if all nodes with tension do.
    is_met: bool,
    is_met_by_all: bool,
}

impl Rise {
    /// That of running maxima to values of now; up to `least` there is no tension. Those of flaws that have grown
    /// exceed the present stress.
    fn of(mesh: &Mesh, patch: &Patch, [noted, now, present]: [&[f64]; 3], least: f64) -> Self {
        let mut own = Self { before: 0.0, after: 0.0, is_met: false, is_met_by_all: true };
        patch.for_nodes(mesh, |_, node| {
            let (noted, now) = (noted[node], now[node]);
            let is_present = present[node] >= PRESENT * now;
            let is_met = now >= noted * (1.0 - ROUNDING) && is_present;
            own.is_met |= is_met && now > 0.0;
            own.after = own.after.max(noted).max(now);
            if noted > least {
                own.before = own.before.max(noted);
                own.is_met_by_all &= is_met;
            }
        });
        own
    }

    /// The value of a node without tension under which the tension so far has its share of the risk: all of it where
    /// only a part of the nodes meets its largest one. Otherwise the largest value T has grown by a factor g. Between
    /// it and a negative value v, over the part `T/(T − v)` of the length, the share is as `T^(m+1)/(T − v)`, so that v
    /// falls to `gT − g^(m+1) (T − v)`.
    fn reach(&self, modulus: f64) -> impl Fn(f64) -> f64 {
        let Self { before, after, is_met_by_all, .. } = *self;
        let after = if is_met_by_all { after } else { before };
        let growth = (after / before).powf(modulus + 1.0);
        move |value| match before > 0.0 {
            true if growth == 1.0 => value,
            true => after - growth * (before - value),
            false => f64::NEG_INFINITY,
        }
    }
}

/// Of the values of distinct images, those of the one that shares most reflections with an image.
pub(super) fn like_image<T>(known: &[([bool; 2], T)], image: [bool; 2]) -> Option<&([bool; 2], T)> {
    known.iter().rev().find(|([x, y], _)| (!x || image[0]) && (!y || image[1]))
}

impl SolidFem {
    pub fn flaws(&self) -> Option<&Flaws> {
        self.flaws.as_ref()
    }

    /// Mirror images of the mesh that make the body, the mesh first.
    pub(super) fn all_images(&self) -> impl Iterator<Item = [bool; 2]> {
        let [x, y] = self.mesh.mirrored;
        let all = [[false, false], [true, false], [false, true], [true, true]];
        all.into_iter().filter(move |image| (!image[0] || x) && (!image[1] || y))
    }

    /// Number of values of [`Self::equivalent_stress`].
    pub fn risk_points(&self) -> usize {
        match self.flaws {
            Some(_) => self.mesh.sided_nodes() * self.all_images().count(),
            None => 0,
        }
    }

    /// Stress at the nodes of all distinct images.
    pub fn stresses(
        &self,
        temperatures: &Temperatures,
        deformation: &Deformation,
    ) -> Vec<ImageStress> {
        let nodal = self.nodal_strains(deformation);
        let of_image = |image| (image, self.stress_in(temperatures, deformation, &nodal, image));
        self.images(&deformation.displacement).into_iter().map(of_image).collect()
    }

    /// Equivalent stress at the nodes of all images [Pa], continued to negative values as
    /// [`FlawStatistics::continued`] says; zero where there are no flaws.
    pub fn equivalent_stress(&self, flaws: &Flaws, stresses: &[ImageStress]) -> Vec<f64> {
        let of_image = |stress: &[[f64; 6]]| {
            let value = |(node, stress): (usize, &[f64; 6])| {
                self.statistics(flaws, node).map_or(0.0, |own| own.continued(*stress))
            };
            stress.iter().enumerate().map(value).collect::<Vec<f64>>()
        };
        let known = stresses.iter().map(|(image, stress)| (*image, of_image(stress))).collect();
        self.over_all_images(known)
    }

    /// Rate of [`Self::equivalent_stress`] when temperatures and deformation change by `change`.
    pub fn equivalent_stress_rate(
        &self,
        flaws: &Flaws,
        (temperatures, deformation): (&Temperatures, &Deformation),
        (temperature_change, change): (&Temperatures, &Deformation),
    ) -> Vec<f64> {
        let (nodal, nodal_change) = (self.nodal_strains(deformation), self.nodal_strains(change));
        let of_image = |image: [bool; 2]| {
            let stresses = self.stress_of_image(temperatures, &nodal, image);
            let rates = self.stress_of_image(temperature_change, &nodal_change, image);
            let value = |(node, (stress, rate)): (usize, ([f64; 6], [f64; 6]))| {
                self.statistics(flaws, node).map_or(0.0, |own| own.continued_rate(stress, rate))
            };
            (image, stresses.into_iter().zip(rates).enumerate().map(value).collect())
        };
        let images = self.images(&present(&deformation.displacement, &change.displacement));
        self.over_all_images(images.into_iter().map(of_image).collect())
    }

    /// Values at the nodes of all images from those of the distinct ones.
    fn over_all_images(&self, known: Vec<([bool; 2], Vec<f64>)>) -> Vec<f64> {
        let like = |image| like_image(&known, image).map_or(&[][..], |(_, own)| own);
        self.all_images().flat_map(|image| like(image).iter().copied()).collect()
    }

    /// Distribution of the flaws at a node of one image; `None` where there are none.
    fn statistics<'f>(&self, flaws: &'f Flaws, node: usize) -> Option<&'f FlawStatistics> {
        let [nx, ny, _] = self.mesh.sided_counts();
        let level = node / (nx * ny);
        let layer = level - self.nodes_of_sided[level];
        flaws.layers[layer].as_ref().filter(|_| flaws.bears[node])
    }

    /// Adds to `∫ (s/σ₀)^n dt` [s] of all nodes, between two equivalent stresses [Pa] a time apart [s].
    pub fn grow(
        &self,
        flaws: &Flaws,
        [first, last]: [&[f64]; 2],
        duration: f64,
        grown: &mut [f64],
    ) {
        let nodes = self.mesh.sided_nodes();
        for (place, grown) in grown.iter_mut().enumerate() {
            let Some(own) = self.statistics(flaws, place % nodes) else { continue };
            let Some(law) = own.slow_growth else { continue };
            let more = law.grown([first[place], last[place]], own.strength, duration);
            *grown = (*grown + more).min(f64::MAX);
        }
    }

    /// Equivalent stress at which flaws that have not grown would break like those of a state [Pa].
    pub fn inert_stress(&self, flaws: &Flaws, equivalent: &[f64], grown: &[f64]) -> Vec<f64> {
        let nodes = self.mesh.sided_nodes();
        let inert = |(place, (&stress, &grown)): (usize, (&f64, &f64))| {
            let own = self.statistics(flaws, place % nodes);
            let law = own.and_then(|own| Some((own.slow_growth?, own.strength)));
            law.map_or(stress, |(law, strength)| law.inert(stress, strength, grown))
        };
        equivalent.iter().zip(grown).enumerate().map(inert).collect()
    }

    /// Updates running maxima of the equivalent stress to the present one. Tension keeps its largest value. Where none
    /// has been, the continued value says how far tension reaches from the other nodes of the same element. It follows
    /// the present one when these meet their largest tension, as far as [`Rise::reach`] says, so that both belong
    /// together; `nothing` marks nodes before the first update. Flaws that grow have more than the present stress.
    pub fn note_largest(
        &self,
        flaws: &Flaws,
        noted: &mut [f64],
        [now, present]: [&[f64]; 2],
        nothing: f64,
    ) {
        let nodes = self.mesh.sided_nodes();
        let (mut rises, mut least_reach) = (vec![false; nodes], vec![f64::NEG_INFINITY; nodes]);
        let images = now.chunks_exact(nodes).zip(present.chunks_exact(nodes));
        for (noted, (now, present)) in noted.chunks_exact_mut(nodes).zip(images) {
            let largest = noted.iter().chain(now).fold(0.0_f64, |most, value| most.max(*value));
            let least = NEGLIGIBLE * largest;
            rises.fill(false);
            least_reach.fill(f64::NEG_INFINITY);
            for patch in &flaws.patches {
                let rise = Rise::of(&self.mesh, patch, [noted, now, present], least);
                let reach = rise.reach(flaws.of_patch(patch).modulus);
                patch.for_nodes(&self.mesh, |_, node| {
                    rises[node] |= rise.is_met;
                    least_reach[node] = least_reach[node].max(reach(noted[node]));
                });
            }
            for (node, (noted, &now)) in noted.iter_mut().zip(now).enumerate() {
                if *noted == nothing || now > noted.max(0.0) {
                    *noted = now;
                } else if *noted <= least && rises[node] {
                    *noted = now.max(least_reach[node].min(*noted));
                }
            }
        }
    }

    /// Risk B of an equivalent stress [1].
    pub fn risk(&self, flaws: &Flaws, equivalent: &[f64]) -> f64 {
        let nodes = self.mesh.sided_nodes();
        let mut known: Option<(&[f64], f64)> = None;
        let mut total = 0.0;
        for image in equivalent.chunks_exact(nodes) {
            let own = match known {
                Some((same, risk)) if same == image => risk,
                _ => self.risk_of_image(flaws, image),
            };
            known.get_or_insert((image, own));
            total += own;
        }
        total
    }

    fn risk_of_image(&self, flaws: &Flaws, equivalent: &[f64]) -> f64 {
        if equivalent.iter().any(|value| value.is_nan()) {
            return f64::NAN;
        }
        let mut total = 0.0;
        self.for_shares(flaws, equivalent, |Share { own, local, points, most, .. }| {
            let integral = local.integral(points, |value| own.power(value));
            total += (own.modulus * most.ln()).exp() * integral / own.extent.size();
        });
        total
    }

    /// Bound of the risk of running maxima on all ways to them: each element bears its largest stress throughout, and
    /// as much more as a parabola may exceed its nodes.
    pub fn largest_risk(&self, flaws: &Flaws, equivalent: &[f64]) -> f64 {
        let nodes = self.mesh.sided_nodes();
        let of_patch = |image: &[f64], patch: &Patch| {
            let own = flaws.of_patch(patch);
            let local = Local::of(&self.mesh, patch, image, own.strength);
            let axes = patch.spans.iter().filter(|span| span.count > 2).count();
            // The sum of the positive shape functions is at most that.
            let excess = 0.5 * (1.0 + 1.25_f64.powi(axes as i32));
            let share = patch.measure(&self.mesh) / own.extent.size();
            share * (excess * local.most.max(0.0)).powf(own.modulus)
        };
        let of_image = |image| flaws.patches.iter().map(|own| of_patch(image, own)).sum::<f64>();
        equivalent.chunks_exact(nodes).map(of_image).sum()
    }

    /// Rate of the risk B when the equivalent stress changes at a rate [1/s, or per unit of what changes].
    pub fn risk_rate(&self, flaws: &Flaws, equivalent: &[f64], rate: &[f64]) -> f64 {
        let nodes = self.mesh.sided_nodes();
        let images = equivalent.chunks_exact(nodes).zip(rate.chunks_exact(nodes));
        images.map(|(values, rates)| self.risk_rate_of_image(flaws, values, rates)).sum()
    }

    fn risk_rate_of_image(&self, flaws: &Flaws, equivalent: &[f64], rates: &[f64]) -> f64 {
        let mut total = 0.0;
        self.for_shares(flaws, equivalent, |Share { own, patch, local, points, most }| {
            let scale = most * own.strength;
            let change = Local::of(&self.mesh, patch, rates, scale);
            let slope = |value: f64| own.modulus * own.power(value) / value;
            let integral = local.integral_of_change(&change, points, slope);
            total += (own.modulus * most.ln()).exp() * integral / own.extent.size();
        });
        total
    }

    /// Passes the patches that matter to the risk of an equivalent stress.
    fn for_shares(&self, flaws: &Flaws, equivalent: &[f64], mut pass: impl FnMut(Share)) {
        let patches = &flaws.patches;
        let bound = |patch: &Patch| {
            let own = flaws.of_patch(patch);
            let local = Local::of(&self.mesh, patch, equivalent, own.strength);
            match local.most > 0.0 {
                true => {
                    let share = patch.measure(&self.mesh) / own.extent.size();
                    own.modulus * local.most.ln() + share.ln()
                }
                false => f64::NEG_INFINITY,
            }
        };
        let bounds: Vec<f64> = patches.iter().map(bound).collect();
        let highest = bounds.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let least = highest + (LEFT_OUT / patches.len() as f64).ln();
        let minor = highest + MINOR.ln();
        for (patch, bound) in patches.iter().zip(bounds) {
            if bound < least || bound == f64::NEG_INFINITY {
                continue;
            }
            let own = flaws.of_patch(patch);
            let local = Local::of(&self.mesh, patch, equivalent, own.strength);
            let most = local.most;
            let relative = Local { values: local.values.map(|v| v / most), ..local };
            let relative = Local { most: 1.0, least: local.least / most, ..relative };
            let few = if bound < minor { POINTS_OF_MINOR } else { LEAST_POINTS };
            // The power ends at zero within the element.
            let more = match relative.least < 0.0 && bound >= minor {
                true => POINTS_AT_ZERO,
                false => 0.0,
            };
            let exact = (0.5 * (self.mesh.order() as f64 * own.modulus + 1.0)).ceil() + 1.0;
            let points = std::array::from_fn(|axis| {
                let variation = relative.variation(axis);
                let wanted = (few + (own.modulus * variation).ceil()).min(exact.max(few));
                let count = ((wanted + (more * variation).ceil()) as usize).min(MOST_POINTS);
                patch.spans[axis].points(&self.mesh.axes[axis], &flaws.rules[count - 1])
            });
            pass(Share { own, patch, local: &relative, points: &points, most });
        }
    }

    /// Place of the largest failure density, h/V₀ or h/A₀ [m]; the centre of the top if there is none.
    pub fn riskiest(&self, flaws: &Flaws, equivalent: &[f64]) -> [f64; 3] {
        let nodes = self.mesh.sided_nodes();
        let [nx, ny, _] = self.mesh.sided_counts();
        let own = || flaws.layers.iter().flatten();
        let steepest = own().map(|own| own.modulus).fold(0.0, f64::max);
        let smallest = own().map(|own| own.extent.size()).fold(f64::INFINITY, f64::min);
        // A root of the density orders places alike, and neither overflows nor underflows.
        let root = |(node, value): (usize, &f64)| {
            let level = node / (nx * ny);
            let own = flaws.layers[level - self.nodes_of_sided[level]].as_ref();
            let root = own.map(|own| {
                let density = (smallest / own.extent.size()).powf(1.0 / steepest);
                density * (value.max(0.0) / own.strength).powf(own.modulus / steepest)
            });
            root.unwrap_or(0.0)
        };
        let of_image = |(values, image): (&[f64], [bool; 2])| {
            (values.iter().enumerate().map(root).collect::<Vec<f64>>(), image)
        };
        let all: Vec<_> =
            equivalent.chunks_exact(nodes).zip(self.all_images()).map(of_image).collect();
        let Extreme { value, at } = self.highest_of(&all);
        if value > 0.0 { at } else { [0.0; 3] }
    }
}
