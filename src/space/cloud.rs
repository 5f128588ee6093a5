//! Points with volumes and with the patches of the surface at them: a body without cells.

use super::bins::Bins;
use super::factor::Factor;
use super::given::{coincident, roots};
use super::{Form, Mesh, Side};

/// Points of a body in a plane or in space; those on the surface have patches of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Cloud {
    pub form: Form,
    pub nodes: Vec<[f64; 3]>,
    /// Volumes; in a plane those of a metre of depth [m³].
    pub volumes: Vec<f64>,
    pub patches: Vec<Patch>,
}

/// A part of the surface at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Patch {
    pub node: u32,
    pub side: Side,
    /// Outward normal times the area [m²].
    pub vector: [f64; 3],
}

/// Why points make no body; they are counted from 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BadCloud {
    /// Two points closer than a thousandth of their distance to others.
    Twice { nodes: [usize; 2] },
    /// A point with too few neighbours to have a gradient.
    Isolated { node: usize, neighbours: usize },
    /// A point that no chain of neighbours connects with the first.
    Apart { node: usize },
    /// Areas that do not add up to zero: their sum over the sum of their sizes.
    Open { part: f64 },
    /// The volume that the patches enclose is not that of the points [m³].
    Volume { enclosed: f64, points: f64 },
}

/// Distance of two neighbours over the edge of the larger one's volume: points in corners have an eighth of the volume
/// of those inside.
const NEIGHBOURS: f64 = 2.0;
/// Distance of two points over the spacing at which they are at one place.
const COINCIDENT: f64 = 1e-3;
/// Sum of areas over the sum of their sizes, and difference of volumes over the volume, that are corrected.
const OPEN: f64 = 0.01;
const AMISS: f64 = 0.05;
/// Product of two normals from which on their patches are those of one face for the cell behind them.
const ALIKE: f64 = 0.7;

impl Patch {
    /// [m²]
    pub fn area(&self) -> f64 {
        length(self.vector)
    }

    pub fn normal(&self) -> [f64; 3] {
        let area = self.area();
        self.vector.map(|x| x / area)
    }
}

impl Cloud {
    /// Creates the points of a body in a plane or in space. Patches are changed by the least that makes them enclose
    /// the volume of the points: `Σ a = 0` and `Σ X ⊗ a = V 1`, as the divergence theorem requires.
    pub fn new(
        form: Form,
        nodes: Vec<[f64; 3]>,
        volumes: Vec<f64>,
        patches: Vec<Patch>,
    ) -> Result<Self, BadCloud> {
        let mut cloud = Self { form, nodes, volumes, patches };
        cloud.check_points()?;
        cloud.check_surface()?;
        match form {
            Form::Solid => cloud.close::<4>(),
            Form::Plane | Form::Axisymmetric => cloud.close::<3>(),
        }
        Ok(cloud)
    }

    /// Mean distance of points [m].
    pub fn spacing(&self) -> f64 {
        let mean = self.volumes.iter().sum::<f64>() / self.volumes.len() as f64;
        mean.powf(1.0 / self.form.axes().len() as f64)
    }

    /// Distance of each point to its neighbours [m]: the edge of the largest cell among theirs and its own.
    pub fn spacings(&self) -> Vec<f64> {
        let own = self.edges_of_cells();
        let around = self.around(&own);
        let largest = |(node, others): (usize, &Vec<u32>)| {
            others.iter().map(|&other| own[other as usize]).fold(own[node], f64::max)
        };
        around.iter().enumerate().map(largest).collect()
    }

    /// Pairs of neighbours.
    pub fn neighbours(&self) -> Vec<[u32; 2]> {
        let around = self.around(&self.edges_of_cells());
        let pairs = around.iter().enumerate().flat_map(|(node, others)| {
            let node = node as u32;
            others.iter().filter(move |&&other| other > node).map(move |&other| [node, other])
        });
        pairs.collect()
    }

    /// Centres of the points' cells: the point itself, or behind the patches of the surface by half of the thickness
    /// of the cell there.
    pub fn centres(&self) -> Vec<[f64; 3]> {
        let mut faces: Vec<Vec<[f64; 3]>> = vec![Vec::new(); self.nodes.len()];
        for patch in &self.patches {
            let own = &mut faces[patch.node as usize];
            let along = |face: &[f64; 3]| dot(*face, patch.vector) / (length(*face) * patch.area());
            match own.iter_mut().find(|face| along(face) > ALIKE) {
                Some(face) => (0..3).for_each(|a| face[a] += patch.vector[a]),
                None => own.push(patch.vector),
            }
        }
        let spacings = self.spacings();
        let centre = |node: usize| {
            let mut at = self.nodes[node];
            let (volume, spacing) = (self.volumes[node], spacings[node]);
            let share = volume / spacing.powi(self.form.axes().len() as i32);
            for face in &faces[node] {
                let area = length(*face);
                let depth = match share > 0.5 {
                    // In a corner that turns inwards: what a whole cell lacks is centred at a quarter of its edge.
                    true => 0.25 * spacing * (1.0 - share).max(0.0) / share,
                    false => 0.5 * (volume / area).min(spacing),
                };
                (0..3).for_each(|a| at[a] -= depth * face[a] / area);
            }
            at
        };
        (0..self.nodes.len()).map(centre).collect()
    }

    /// The points with their patches as the faces of a mesh without cells.
    pub fn surface(&self) -> Mesh {
        let faces = self.patches.iter().map(|patch| (patch.side, vec![patch.node]));
        let (form, nodes) = (self.form, self.nodes.clone());
        Mesh { form, order: 1, nodes, cells: Vec::new(), faces: faces.collect() }
    }

    /// Returns true if a place is within half of the spacing of a point.
    pub fn contains(&self, at: [f64; 3]) -> bool {
        let apart = |node: [f64; 3]| self.form.axes().iter().map(move |&a| (node[a] - at[a]).abs());
        let near = |(node, edge): (&[f64; 3], f64)| apart(*node).all(|apart| apart <= 0.5 * edge);
        self.nodes.iter().zip(self.spacings()).any(near)
    }

    /// Edges of squares or cubes of the points' volumes [m].
    fn edges_of_cells(&self) -> Vec<f64> {
        let power = 1.0 / self.form.axes().len() as f64;
        self.volumes.iter().map(|volume| volume.powf(power)).collect()
    }

    /// Neighbours of each point for edges of their cells.
    fn around(&self, edges: &[f64]) -> Vec<Vec<u32>> {
        let axes = self.form.axes();
        let support = |(at, edge): (&[f64; 3], &f64)| {
            let reach = NEIGHBOURS * edge;
            [at.map(|x| x - reach), at.map(|x| x + reach)]
        };
        let supports: Vec<[[f64; 3]; 2]> = self.nodes.iter().zip(edges).map(support).collect();
        let mean = edges.iter().sum::<f64>() / edges.len() as f64;
        let bins = Bins::new(axes, &supports, [2.0 * NEIGHBOURS * mean; 3]);
        let mut around = vec![Vec::new(); self.nodes.len()];
        for (node, at) in self.nodes.iter().enumerate() {
            for &other in bins.near(*at) {
                let there = self.nodes[other as usize];
                let apart = axes.iter().map(|&a| (at[a] - there[a]).powi(2)).sum::<f64>().sqrt();
                if other as usize != node && apart < NEIGHBOURS * edges[other as usize] {
                    around[node].push(other);
                    around[other as usize].push(node as u32);
                }
            }
        }
        for own in &mut around {
            own.sort_unstable();
            own.dedup();
        }
        around
    }

    fn check_points(&self) -> Result<(), BadCloud> {
        let edges = self.edges_of_cells();
        let least = edges.iter().copied().fold(f64::INFINITY, f64::min);
        if let Some(nodes) = coincident(self.form, &self.nodes, COINCIDENT * least) {
            return Err(BadCloud::Twice { nodes });
        }
        let around = self.around(&edges);
        let dimension = self.form.axes().len();
        if let Some(node) = around.iter().position(|others| others.len() < dimension) {
            return Err(BadCloud::Isolated { node, neighbours: around[node].len() });
        }
        let links = around
            .iter()
            .enumerate()
            .flat_map(|(node, others)| others.iter().map(move |&other| [node as u32, other]));
        let roots = roots(self.nodes.len(), links);
        match roots.iter().position(|&root| root != 0) {
            Some(node) => Err(BadCloud::Apart { node }),
            None => Ok(()),
        }
    }

    fn check_surface(&self) -> Result<(), BadCloud> {
        let sizes: f64 = self.patches.iter().map(Patch::area).sum();
        let mut sum = [0.0; 3];
        let mut enclosed = 0.0;
        for patch in &self.patches {
            (0..3).for_each(|a| sum[a] += patch.vector[a]);
            // From the first point, as sums far from the origin round.
            let [at, origin] = [self.nodes[patch.node as usize], self.nodes[0]];
            enclosed += dot([0, 1, 2].map(|a| at[a] - origin[a]), patch.vector);
        }
        let part = length(sum) / sizes;
        if part > OPEN {
            return Err(BadCloud::Open { part });
        }
        let enclosed = enclosed / self.form.axes().len() as f64;
        let points = self.volumes.iter().sum::<f64>();
        let is_close = (enclosed / points - 1.0).abs() <= AMISS;
        if is_close { Ok(()) } else { Err(BadCloud::Volume { enclosed, points }) }
    }

    /// Changes each patch by its area times an affine function of its place.
    fn close<const N: usize>(&mut self) {
        let (axes, origin) = (self.form.axes(), self.nodes[0]);
        let whole: f64 = self.volumes.iter().sum();
        let size = whole.powf(1.0 / axes.len() as f64);
        let terms = |patch: &Patch| {
            let at = self.nodes[patch.node as usize];
            let mut terms = [1.0; N];
            terms[1..].iter_mut().zip(axes).for_each(|(t, &a)| *t = (at[a] - origin[a]) / size);
            terms
        };
        let terms: Vec<[f64; N]> = self.patches.iter().map(terms).collect();
        let mut moments = [[0.0; N]; N];
        for (patch, terms) in self.patches.iter().zip(&terms) {
            for i in 0..N {
                (0..=i).for_each(|j| moments[i][j] += patch.area() * terms[i] * terms[j]);
            }
        }
        // A surface that encloses a volume has patches off every plane.
        let Some(factor) = Factor::of(&moments) else { return };
        let areas: Vec<f64> = self.patches.iter().map(Patch::area).collect();
        for (n, &axis) in axes.iter().enumerate() {
            let mut missing = [0.0; N];
            missing[n + 1] = whole / size;
            for (patch, terms) in self.patches.iter().zip(&terms) {
                (0..N).for_each(|i| missing[i] -= patch.vector[axis] * terms[i]);
            }
            let factors = factor.solve(missing);
            for ((patch, terms), area) in self.patches.iter_mut().zip(&terms).zip(&areas) {
                let change: f64 = factors.iter().zip(terms).map(|(f, t)| f * t).sum();
                patch.vector[axis] += area * change;
            }
        }
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|n| a[n] * b[n]).sum()
}

fn length(v: [f64; 3]) -> f64 {
    dot(v, v).sqrt()
}
