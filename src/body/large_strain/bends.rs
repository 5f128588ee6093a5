//! Bends of metal that a mesh resolves poorly.
//!
//! A bend beyond yield leaves plastic strain along a strip that changes its sign across it. The moment that bends n
//! elements from yield to yield has an error of `c/n²`, as elements are too stiff. With the stress K of the
//! strip's face by its curvature, as if it were elastic, and the same M by its moment, `K − M` stays of the bend:
//!
//! - Where loads bend the strip, an error of M changes what stays by the S-fold, `S = (dK/dM − 1) M/(K − M)`: small
//!   parts of the moment decide where the metal has just begun to yield, or hardly hardens.
//! - Where faces move it, elements are too stiff under load and in unloading alike, and the factor is about `M/K`.
//!
//! Cantilevers of 15 times their height in plane stress with 2 to 32 elements across, under 1.2 to 2 times the load of
//! first yield (hardening by 1 and 7 GPa at a Young's modulus of 70 GPa, a yield stress of 100 MPa), have a known limit
//! of fine meshes. The estimate is 0.8 to 1.3 times the error of what stays from 8 elements on, and up to twice that
//! error with 4. Where no point of a coarse mesh yields, nothing shows the bend.

use crate::laws::solid::large_strain::{Deviator, LargeStrainLaw, Plastic};
use crate::math::matrix3::{IDENTITY, Matrix3, eigen, inverse};
use crate::method::large_strain::Deformable;
use crate::scene::{KernelIntegration, LargeStrain, Mechanics};
use crate::space::Bins;
use crate::warning::{self, Warning};

/// Test of the mesh of a body for its bends.
pub struct BendTest {
    name: String,
    /// Distance of nodes [m].
    spacing: f64,
    /// True if points lie in elements, whose nodes are those of a point.
    has_elements: bool,
    /// Elements by which the outermost points of a strip are closer than its faces.
    inset: f64,
    /// True if the mesh comes from a file.
    is_given: bool,
    /// Error of a moment times the square of the number of elements across, and its effect.
    stiff: f64,
    effect: &'static str,
}

/// The strongest bends of a body, in the mean.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Bends {
    /// Elements or nodes from yield to yield.
    across: f64,
    /// Part of what stays of the bend that may be missing.
    error: f64,
}

/// Part of what stays of a bend that may be missing without a warning, and that of a mesh that a warning proposes.
const MISSING: f64 = 0.035;
const PROPOSED: f64 = 0.02;
/// Error of the moment times the square of the number of elements across: of elements by their order, of kernels, and
/// of particles and of kernels with a point a node, which are too soft.
const OF_ELEMENTS: [f64; 2] = [0.75, 0.07];
const OF_KERNELS: f64 = 0.14;
const OF_SOFT: f64 = 0.3;
/// Plastic strain over that at first yield below which nothing stays of a bend.
const FAINT: f64 = 1e-3;
/// Part of the strain on its way from which on a strain of the opposite sign ends that way.
const COUNTS: f64 = 0.1;
/// Parts of the typical strain of a body: of points from which lines start, and on both sides of a bend.
const STRONG: f64 = 0.3;
const BENT: f64 = 0.7;
/// Part of the plastic strain of a bent body that belongs to its bends.
const SHARE: f64 = 0.5;
/// Principal strain over the largest of a point from which on it may be that of a bend.
const PRINCIPAL: f64 = 0.4;
/// Elements across beyond which a bend is resolved, whatever its strain.
const MOST: f64 = 64.0;
/// Distance of nodes within which slopes are found, that at which a place lies outside the body, and step of a line.
const AROUND: f64 = 1.6;
const OUTSIDE: f64 = 0.75;
const STEP: f64 = 0.25;
/// Elements by which the outermost points of a strip are closer than its faces, by the order of elements.
const INSET: [f64; 2] = [0.42, 0.23];
/// Points from which lines start.
const LINES: usize = 2000;

impl BendTest {
    pub fn of((name, solid): (&str, &LargeStrain)) -> Self {
        let integration = solid.rkpm.unwrap_or_default().integration;
        let (stiff, effect) = match (solid.mechanics, integration) {
            (Mechanics::Fem, _) => match solid.order() {
                1 => (OF_ELEMENTS[0], "too small"),
                _ => (OF_ELEMENTS[1], "too small or too large"),
            },
            (Mechanics::Sph, _) | (_, KernelIntegration::Scni) => (OF_SOFT, "too large"),
            (_, KernelIntegration::Nsni) => (OF_KERNELS, "too small"),
            (_, KernelIntegration::Gauss) => (OF_KERNELS, "too small or too large"),
        };
        Self {
            stiff,
            effect,
            name: name.to_owned(),
            spacing: solid.spacing(),
            has_elements: solid.mechanics == Mechanics::Fem,
            inset: INSET[solid.order() - 1],
            is_given: solid.part().is_some(),
        }
    }

    /// Warns of bends of a history that the mesh resolves poorly; `is_loaded` if loads have bent the body.
    pub fn warning(&self, body: &Deformable, history: &[f64], is_loaded: bool) -> Option<Warning> {
        let Bends { across, error } = self.bends(body, history, is_loaded)?;
        if error < MISSING {
            return None;
        }
        let percents = format!("{:.0}", 100.0 * error);
        let finer = format!("{:.1e}", self.spacing * (PROPOSED / error).sqrt());
        let remedy = match self.is_given {
            true => format!("take a finer mesh of the part, with nodes {finer} m apart"),
            false => format!("set a `mesh.spacing` of {finer} m"),
        };
        let across = format!("{across:.0}");
        let finding = warning::bend_is_coarse(across, percents, self.effect, remedy);
        Some(finding.at(&self.name).whatever_its_numbers())
    }

    /// Finds the bends of a history; none where the metal is not bent, or resolved by far.
    fn bends(&self, body: &Deformable, history: &[f64], is_loaded: bool) -> Option<Bends> {
        if !body.yields() {
            return None;
        }
        let field = Field::new(self, body, history);
        let weights = &body.space.volume.weights;
        let [sum, squares] = field
            .sizes
            .iter()
            .zip(weights)
            .fold([0.0; 2], |[a, b], (e, w)| [a + w * e, b + w * e * e]);
        let usual = squares / sum;
        if usual.is_nan() || usual <= 0.0 {
            return None;
        }
        let strong: Vec<usize> =
            (0..field.sizes.len()).filter(|&point| field.sizes[point] >= STRONG * usual).collect();
        let mut whole = 0.0;
        let mut lines = Vec::new();
        for &point in strong.iter().step_by(strong.len() / LINES + 1) {
            let weight = weights[point] * field.sizes[point];
            whole += weight;
            let least = (BENT * usual).max(field.faint(point));
            let line = field.strongest_line(point).filter(|line| line.strain >= least);
            lines.extend(line.map(|line| (point, line, weight)));
        }
        let bent: f64 = lines.iter().map(|(.., weight)| weight).sum();
        if bent < SHARE * whole {
            return None;
        }
        let mean = |of: &dyn Fn(usize, &Line) -> f64| {
            lines.iter().map(|(point, line, weight)| weight * of(*point, line)).sum::<f64>() / bent
        };
        let across = mean(&|_, line| line.across);
        let amplified = |point: usize, line: &Line| {
            let law = field.laws[point];
            let section = Section::of(law, line.strain, 1.0 - self.inset / line.across);
            if is_loaded { section.under_load() } else { section.moved() }
        };
        let error = mean(&|point, line| self.stiff * amplified(point, line) / line.across.powi(2));
        Some(Bends { across, error: error.min(1.0) })
    }
}

/// A line across a bend, from yield to yield.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Line {
    across: f64,
    /// Plastic strain of the less strained side.
    strain: f64,
}

/// Plastic strains of the points of a body.
struct Field<'a> {
    body: &'a Deformable,
    laws: Vec<&'a LargeStrainLaw>,
    /// `½ ln C_p`, and its largest principal value by size.
    strains: Vec<Matrix3>,
    sizes: Vec<f64>,
    axes: Vec<([f64; 3], Matrix3)>,
    /// Points by place, each in reach of all places that it may be the nearest to.
    near: Bins,
    spacing: f64,
    /// Elements have sizes of their own, those of the nodes of a point.
    has_elements: bool,
    inset: f64,
}

impl<'a> Field<'a> {
    fn new(test: &BendTest, body: &'a Deformable, history: &[f64]) -> Self {
        let strain = |law: &LargeStrainLaw, own: &[f64]| match &law.deviator {
            Deviator::Plastic(_) if own[Plastic::STRAIN] > 0.0 => Plastic::logarithmic_strain(own),
            _ => [[0.0; 3]; 3],
        };
        let strains = body.of_histories(history, strain);
        let axes: Vec<_> = strains.iter().map(eigen).collect();
        let size = |(values, _): &([f64; 3], Matrix3)| {
            values.iter().fold(0.0, |most: f64, e| most.max(e.abs()))
        };
        let sizes = axes.iter().map(size).collect();
        let groups = &body.space.groups;
        let laws = (0..groups.len()).flat_map(|group| groups[group].clone().map(move |_| group));
        let laws = laws.map(|group| body.law_of(group)).collect();
        let BendTest { spacing, has_elements, inset, .. } = *test;
        let near = Self::bins(body, spacing, has_elements);
        Self { body, laws, strains, sizes, axes, near, spacing, has_elements, inset }
    }

    /// The points of a body, in reach of places among them and of those just outside.
    fn bins(body: &Deformable, spacing: f64, has_elements: bool) -> Bins {
        let volume = &body.space.volume;
        let largest = match has_elements {
            true => (0..volume.at.len()).map(|point| diagonal(body, point)).fold(0.0, f64::max),
            false => spacing,
        };
        let reach = (AROUND * spacing).max(OUTSIDE * largest);
        let around = |at: &[f64; 3]| [at.map(|x| x - reach), at.map(|x| x + reach)];
        let supports: Vec<_> = volume.at.iter().map(around).collect();
        Bins::new(body.space.form.axes(), &supports, [spacing; 3])
    }

    /// The point nearest to a place within a distance [m].
    fn nearest(&self, place: [f64; 3], distance: f64) -> Option<usize> {
        let places = &self.body.space.volume.at;
        let mut best = (distance * distance, None);
        for &point in self.near.near(place) {
            let way = [0, 1, 2].map(|a| places[point as usize][a] - place[a]);
            let square = dot(way, way);
            if square < best.0 {
                best = (square, Some(point as usize));
            }
        }
        best.1
    }

    /// Plastic strain of a point below which nothing stays of its bend.
    fn faint(&self, point: usize) -> f64 {
        let law = self.laws[point];
        match &law.deviator {
            Deviator::Plastic(metal) => FAINT * metal.yield_stress / law.young(),
            Deviator::Relaxing(_) | Deviator::Concrete(_) => f64::INFINITY,
        }
    }

    /// The line from a point across the bend of the strongest strain on its less strained side.
    fn strongest_line(&self, point: usize) -> Option<Line> {
        let (values, vectors) = &self.axes[point];
        let axes = self.body.space.form.axes();
        let directions = (0..3).filter(|&n| values[n].abs() >= PRINCIPAL * self.sizes[point]);
        let directions = directions.map(|n| [0, 1, 2].map(|a| vectors[a][n]));
        let inside = directions.filter(|d| (0..3).all(|a| axes.contains(&a) || d[a].abs() < 0.5));
        let lines = inside.filter_map(|direction| self.line(point, direction));
        lines.max_by(|a, b| a.strain.total_cmp(&b.strain))
    }

    /// The line from a point to the side on which the strain along a direction has the opposite sign.
    fn line(&self, point: usize, direction: [f64; 3]) -> Option<Line> {
        let sign = along(&self.strains[point], direction).signum();
        let slope = self.slope(point, direction);
        let part = dot(slope, direction);
        let across = [0, 1, 2].map(|a| -sign * (slope[a] - part * direction[a]));
        let steep = dot(across, across).sqrt();
        if steep.is_nan() || steep <= 0.0 {
            return None;
        }
        let across = across.map(|x| x / steep);
        let size = self.size(point, direction).max(self.size(point, across));
        let from = self.body.space.volume.at[point];
        let step = STEP * size;
        // Places along the line with the strain there, positive on the side of the point.
        let walk = |way: f64| {
            let most = (MOST / STEP) as usize;
            let places = (0..most).map(move |n| way * n as f64 * step);
            let values = places.map_while(move |s| {
                let at = [0, 1, 2].map(|a| from[a] + s * across[a]);
                let point = self.nearest(at, OUTSIDE * size)?;
                let own = self.body.space.volume.at[point];
                let offset = dot([0, 1, 2].map(|a| own[a] - from[a]), across);
                Some((offset, sign * along(&self.strains[point], direction)))
            });
            values.collect::<Vec<_>>()
        };
        let (down, up) = (walk(1.0), walk(-1.0));
        let here = along(&self.strains[point], direction).abs();
        let turns = down.iter().position(|(_, e)| *e < -COUNTS * here)?;
        let (own, other) = down.split_at(turns);
        let zone = |values: &[(f64, f64)], side: f64| {
            let mut most: (f64, f64) = (0.0, 0.0);
            for (s, e) in values {
                let e = side * e;
                if e < COUNTS * most.0 {
                    break;
                }
                most = (most.0.max(e), *s);
            }
            most
        };
        let (peak, first) = zone(&up, 1.0);
        let (opposite, last) = zone(other, -1.0);
        let peak = own.iter().fold(peak, |most, (_, e)| most.max(*e));
        Some(Line { across: (last - first) / size + self.inset, strain: peak.min(opposite) })
    }

    /// Slope of the strain along a direction [1/m].
    fn slope(&self, point: usize, direction: [f64; 3]) -> [f64; 3] {
        let places = &self.body.space.volume.at;
        let own = along(&self.strains[point], direction);
        let (mut moments, mut sums) = ([[0.0; 3]; 3], [0.0; 3]);
        let reach = AROUND * self.spacing;
        for other in self.near.near(places[point]).iter().map(|&other| other as usize) {
            let way = [0, 1, 2].map(|a| (places[other][a] - places[point][a]) / reach);
            if dot(way, way) < 1.0 {
                let change = along(&self.strains[other], direction) - own;
                for a in 0..3 {
                    sums[a] += way[a] * change;
                    (0..3).for_each(|b| moments[a][b] += way[a] * way[b]);
                }
            }
        }
        let axes = self.body.space.form.axes();
        (0..3).filter(|a| !axes.contains(a)).for_each(|a| moments[a][a] = 1.0);
        let (inverse, determinant) = inverse(&moments);
        if determinant <= 0.0 {
            return [0.0; 3];
        }
        inverse.map(|row| dot(row, sums) / reach)
    }

    /// Size of the element or nodal cell of a point along a direction [m].
    fn size(&self, point: usize, direction: [f64; 3]) -> f64 {
        if !self.has_elements {
            return self.spacing;
        }
        extent(self.body, point, direction)
    }
}

/// Extent of the element of a point along a direction [m].
fn extent(body: &Deformable, point: usize, direction: [f64; 3]) -> f64 {
    let nodes = body.space.volume.row(point).iter();
    let along = nodes.map(|value| dot(body.space.nodes[value.node as usize], direction));
    let (low, high) =
        along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    high - low
}

/// Diagonal of the box around the element of a point [m].
fn diagonal(body: &Deformable, point: usize) -> f64 {
    let edges = IDENTITY.map(|direction| extent(body, point, direction));
    dot(edges, edges).sqrt()
}

/// A rectangular section that is bent, in units of stress; see the head of this file.
struct Section {
    /// K, M and `dM/dK`.
    surface: f64,
    moment: f64,
    slope: f64,
}

impl Section {
    /// Creates the section with a plastic strain at a height over half of its own: `M = 3 ∫₀¹ σ ζ dζ`.
    fn of(law: &LargeStrainLaw, plastic_strain: f64, height: f64) -> Self {
        let young = law.young();
        let Deviator::Plastic(metal) = &law.deviator else {
            return Self { surface: young, moment: young, slope: 1.0 };
        };
        let stress = metal.flow_stress(plastic_strain)[0];
        let surface = (young * plastic_strain + stress) / height;
        let (mut moment, mut slope) = (0.0, 0.0);
        for n in 0..LAYERS {
            let place = (n as f64 + 0.5) / LAYERS as f64;
            let [stress, stiffness] = drawn(metal, young, surface * place);
            moment += 3.0 * stress * place / LAYERS as f64;
            slope += 3.0 * stiffness * place * place / LAYERS as f64;
        }
        Self { surface, moment, slope }
    }

    /// Relative change of what stays of a bend over that of the moment of loads.
    fn under_load(&self) -> f64 {
        (1.0 / self.slope - 1.0) * self.moment / (self.surface - self.moment)
    }

    /// The same for an error of the moment of a curvature that faces prescribe.
    fn moved(&self) -> f64 {
        self.moment / self.surface
    }
}

/// Layers of a section, and halvings in the search for a plastic strain.
const LAYERS: usize = 200;
const HALVINGS: usize = 50;

/// Stress of a bar at Young's modulus times its strain, and its slope over that.
fn drawn(metal: &Plastic, young: f64, stretch: f64) -> [f64; 2] {
    if stretch <= metal.flow_stress(0.0)[0] {
        return [stretch, 1.0];
    }
    let (mut low, mut high) = (0.0, stretch / young);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if stretch - young * middle > metal.flow_stress(middle)[0] {
            low = middle
        } else {
            high = middle
        }
    }
    let [stress, slope] = metal.flow_stress(low);
    [stress, slope / (young + slope)]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|n| a[n] * b[n]).sum()
}

fn along(strain: &Matrix3, direction: [f64; 3]) -> f64 {
    (0..3).map(|a| direction[a] * dot(strain[a], direction)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Perfect plasticity: M = σ (3/2 − ½ (σ/K)²), so dM/dK = (σ/K)³.
    #[test]
    fn sections_of_perfect_plasticity_have_the_moments_of_their_closed_form() {
        let yield_stress = 1e8;
        let metal = Plastic {
            yield_stress,
            hardening: 0.0,
            saturation: yield_stress,
            rate: 0.0,
            kinematic: 0.0,
        };
        let elastic = LargeStrainLaw::elastic(70e9, 26e9);
        let law = LargeStrainLaw { deviator: Deviator::Plastic(metal), ..elastic };
        for [strain, height] in [[1e-4, 1.0], [1e-3, 0.9], [1e-2, 0.8]] {
            let section = Section::of(&law, strain, height);
            let stretch = (law.young() * strain / yield_stress + 1.0) / height;
            let moment = 1.5 - 0.5 / stretch.powi(2);
            assert!((section.surface / (yield_stress * stretch) - 1.0).abs() < 1e-12);
            assert!((section.moment / (yield_stress * moment) - 1.0).abs() < 1e-4);
            assert!((section.slope * stretch.powi(3) - 1.0).abs() < 0.05, "{}", section.slope);
            let error = (stretch.powi(3) - 1.0) * moment / (stretch - moment);
            assert!((section.under_load() / error - 1.0).abs() < 0.05);
        }
    }
}
