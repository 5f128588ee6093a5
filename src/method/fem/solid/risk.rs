//! Risk of failure of a body of brittle material: `B = Σ ∫ (s/σ₀)^m dV/V₀` over its layers, or over their faces.
//!
//! The equivalent stress s is known at the nodes, of every mirror image of the mesh; between nodes it follows the shape
//! functions. It is the power that needs care: an error of s counts m times. Each element takes as many Gauss points
//! along each axis as its values vary, up to those that integrate the power of a linear function exactly, and all
//! values are relative to the largest.

mod local;
mod maxima;
mod patch;

use self::local::Local;
use self::patch::{Patch, Point, Points, faces, patches};
use super::tangent::present;
use super::{Deformation, Extreme, SolidFem, Temperatures};
use crate::laws::FlawStatistics;
use crate::math::gauss::gauss_legendre;
use crate::math::lagrange::shape;
use crate::method::fem::plan::Plan;

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

/// Stress at the nodes of an image of the mesh [Pa].
pub type ImageStress = ([bool; 2], Vec<[f64; 6]>);

/// Largest number of points along an axis.
const MOST_POINTS: usize = 48;
/// Points of an element in which the power hardly varies, and of one whose share of the risk is below [`MINOR`].
const LEAST_POINTS: f64 = 3.0;
const POINTS_OF_MINOR: f64 = 2.0;
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
            let relative = local.relative();
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
