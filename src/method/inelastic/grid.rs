//! All elements of a mesh: loops over their layers along z on many threads, bitwise equal on any number.

use super::element::{Answer, Given, Kit, Known};
use super::locking::LockingTreatment;
use super::shapes::{Scratch, Shapes};
use crate::laws::{PointConstants, PointTangent, Relaxation};
use crate::method::fem::{Geometry, Mesh};
use crate::runtime::parallel::Team;

/// The elements of a mesh. Vectors have all displacements along x (r), then along y, then along z, with the x index of
/// nodes fastest. Lists of elements and of their points also run x fastest.
pub struct Grid {
    pub kit: Kit,
    order: usize,
    /// Numbers of nodes of the mesh, along x, and of a plane across z.
    pub nodes: usize,
    columns: usize,
    plane: usize,
    /// Offsets from the first node of an element to each of its nodes.
    offsets: Vec<usize>,
}

/// Displacements, and the response of all points to them.
#[derive(Default)]
pub struct Iterate {
    pub displacement: Vec<f64>,
    pub amplitudes: Vec<f64>,
    pub new: Vec<f64>,
    pub tangents: Vec<PointTangent>,
    pub forces: Vec<f64>,
    pub mode_forces: Vec<f64>,
    pub scales: Vec<[f64; 2]>,
}

/// The elements of one layer and the planes of nodes that they share, a list for each component.
pub struct Layer<'a> {
    pub number: usize,
    pub out: Vec<&'a mut [f64]>,
}

/// Rounding level of forces on amplitudes, relative to moduli times strains times volume.
const NOTHING: f64 = 1e-15;
/// Number of elements processed at once.
const BATCH: usize = 32;

impl Grid {
    /// `history` is the length of the history of a point.
    pub fn new(mesh: &Mesh, history: usize) -> Self {
        let shapes = Shapes::new(mesh);
        let treatment = LockingTreatment::new(&shapes, mesh.order());
        let order = mesh.order();
        let n = order + 1;
        let [columns, rows, _] = mesh.node_counts();
        let plane = columns * rows;
        let offset = |a: usize| match mesh.geometry {
            Geometry::Box => a % n + columns * (a / n % n) + plane * (a / (n * n)),
            Geometry::Axisymmetric => a % n + plane * (a / n),
        };
        let offsets = (0..shapes.nodes).map(offset).collect();
        Self {
            kit: Kit { shapes, treatment, history },
            order,
            nodes: mesh.nodes(),
            columns,
            plane,
            offsets,
        }
    }

    pub fn elements(&self) -> usize {
        self.kit.shapes.counts().iter().product()
    }

    pub fn points(&self) -> usize {
        self.elements() * self.kit.shapes.points
    }

    pub fn unknowns(&self) -> usize {
        self.nodes * self.kit.shapes.degrees
    }

    pub fn layers(&self) -> usize {
        self.kit.shapes.counts()[2]
    }

    /// Number of elements of a layer.
    pub fn per_layer(&self) -> usize {
        let [nx, ny, _] = self.kit.shapes.counts();
        nx * ny
    }

    /// Returns an element's place from its number within a layer.
    pub fn place(&self, layer: usize, number: usize) -> [usize; 3] {
        let nx = self.kit.shapes.counts()[0];
        [number % nx, number / nx, layer]
    }

    /// Returns the nodes of an element.
    pub fn nodes_of(&self, [ex, ey, ez]: [usize; 3]) -> impl Iterator<Item = usize> + '_ {
        let first = self.order * (ex + self.columns * ey + self.plane * ez);
        self.offsets.iter().map(move |offset| first + offset)
    }

    /// Collects the values at the nodes of some elements.
    pub fn gather(&self, elements: &[[usize; 3]], x: &[f64], out: &mut Vec<f64>) {
        out.clear();
        for element in elements {
            for component in x.chunks_exact(self.nodes) {
                out.extend(self.nodes_of(*element).map(|node| component[node]));
            }
        }
    }

    /// Adds the forces of elements of a layer.
    pub fn scatter(&self, elements: &[[usize; 3]], forces: &[f64], layer: &mut Layer) {
        let first = layer.number * self.order * self.plane;
        let nodes = self.kit.shapes.nodes;
        for (element, forces) in elements.iter().zip(forces.chunks_exact(self.kit.unknowns())) {
            for (out, forces) in layer.out.iter_mut().zip(forces.chunks_exact(nodes)) {
                for (node, force) in self.nodes_of(*element).zip(forces) {
                    out[node - first] += force;
                }
            }
        }
    }

    /// Returns the planes of nodes of every second layer of elements; layers of one colour share no nodes.
    pub fn coloured<'a>(&self, out: &'a mut [f64], colour: usize) -> Vec<Layer<'a>> {
        let height = self.order * self.plane;
        let numbers = (colour..self.layers()).step_by(2);
        let mut layers: Vec<Layer> =
            numbers.map(|number| Layer { number, out: Vec::new() }).collect();
        for component in out.chunks_exact_mut(self.nodes) {
            let planes = component[colour * height..].chunks_mut(2 * height);
            layers.iter_mut().zip(planes).for_each(|(layer, planes)| layer.out.push(planes));
        }
        layers
    }

    /// Calls `work` for every layer, which adds to its planes of `out`; each layer has its own item.
    pub fn add_layers<T: Send>(
        &self,
        team: &Team,
        out: &mut [f64],
        items: Vec<T>,
        work: impl Fn(&mut Layer, &mut T, &mut Scratch) + Sync,
    ) {
        let mut items: Vec<Option<T>> = items.into_iter().map(Some).collect();
        for colour in 0..2 {
            let mut pairs: Vec<(Layer, T)> = self
                .coloured(out, colour)
                .into_iter()
                .map(|layer| {
                    let item = items[layer.number].take().expect("each layer has one colour");
                    (layer, item)
                })
                .collect();
            team.for_pieces(&mut pairs, |_, pairs| {
                let mut scratch = Scratch::default();
                for (layer, item) in pairs {
                    work(layer, item, &mut scratch);
                }
            });
        }
    }

    /// Batches of a layer's elements, `(number of the first, elements)`.
    pub fn batches(&self, layer: usize) -> impl Iterator<Item = (usize, Vec<[usize; 3]>)> + '_ {
        let count = self.per_layer();
        (0..count).step_by(BATCH).map(move |first| {
            let numbers = first..(first + BATCH).min(count);
            (first, numbers.map(|number| self.place(layer, number)).collect())
        })
    }

    /// Allocates an iterate.
    pub fn iterate(&self) -> Iterate {
        let (elements, modes) = (self.elements(), self.kit.treatment.modes());
        let none = PointTangent { bulk: 0.0, all: 0.0, along: 0.0, direction: [0.0; 6] };
        Iterate {
            displacement: vec![0.0; self.unknowns()],
            amplitudes: vec![0.0; elements * modes],
            new: vec![0.0; self.points() * self.kit.history],
            tangents: vec![none; self.points()],
            forces: vec![0.0; self.unknowns()],
            mode_forces: vec![0.0; elements * modes],
            scales: vec![[0.0; 2]; elements],
        }
    }

    /// Updates an iterate's response to its displacements and amplitudes; `relaxation` is that of each layer.
    pub fn respond(
        &self,
        team: &Team,
        (constants, relaxation): (&[PointConstants], &[Option<&Relaxation>]),
        old: &[f64],
        iterate: &mut Iterate,
    ) {
        let (count, modes) = (self.per_layer(), self.kit.treatment.modes());
        let (points, history) = (self.kit.shapes.points, self.kit.history);
        let Iterate { displacement, amplitudes, new, tangents, forces, mode_forces, scales } =
            iterate;
        let mut items = Vec::new();
        let mut on_modes = mode_forces.chunks_mut((count * modes).max(1));
        for ((new, tangents), scales) in new
            .chunks_mut(count * points * history)
            .zip(tangents.chunks_mut(count * points))
            .zip(scales.chunks_mut(count))
        {
            items.push((new, tangents, on_modes.next().unwrap_or_default(), scales));
        }
        forces.fill(0.0);
        self.add_layers(
            team,
            forces,
            items,
            |layer, (new, tangents, mode_forces, scales), scratch| {
                let (mut u, mut f) = (Vec::new(), Vec::new());
                for (first, elements) in self.batches(layer.number) {
                    self.gather(&elements, displacement, &mut u);
                    f.clear();
                    f.resize(u.len(), 0.0);
                    let (own, all) = (first..first + elements.len(), layer.number * count + first);
                    let at = |each: usize| all * each..(all + elements.len()) * each;
                    let within = |each: usize| own.start * each..own.end * each;
                    let given = Given {
                        elements: &elements,
                        displacement: &u,
                        amplitudes: &amplitudes[at(modes)],
                        constants: &constants[at(points)],
                        old: &old[at(points * history)],
                        relaxation: relaxation[layer.number],
                    };
                    let mut answer = Answer {
                        new: &mut new[within(points * history)],
                        tangents: &mut tangents[within(points)],
                        forces: &mut f,
                        mode_forces: &mut mode_forces[within(modes)],
                        scales: &mut scales[within(1)],
                    };
                    self.kit.respond(&given, &mut answer, scratch);
                    self.scatter(&elements, &f, layer);
                }
            },
        );
    }

    /// Adds to `load` the nodal forces of the forces on amplitudes after condensation.
    pub fn condense(&self, team: &Team, iterate: &Iterate, load: &mut [f64]) {
        let (modes, points) = (self.kit.treatment.modes(), self.kit.shapes.points);
        if iterate.mode_forces.iter().all(|force| *force == 0.0) {
            return;
        }
        let items = vec![(); self.layers()];
        self.add_layers(team, load, items, |layer, (), scratch| {
            let mut known = Known::default();
            for (first, elements) in self.batches(layer.number) {
                let mut stress = vec![[0.0; 6]; elements.len() * points];
                for (e, stress) in stress.chunks_exact_mut(points).enumerate() {
                    let number = layer.number * self.per_layer() + first + e;
                    let tangents = &iterate.tangents[number * points..][..points];
                    let forces = &iterate.mode_forces[number * modes..][..modes];
                    let most = forces.iter().fold(0.0_f64, |most, force| most.max(force.abs()));
                    if most <= NOTHING * iterate.scales[number][1] {
                        continue;
                    }
                    let prepared = self.kit.prepare_after(&mut known, elements[e], tangents);
                    self.kit.given_way(prepared, tangents, forces, stress);
                    stress.iter_mut().flatten().for_each(|s| *s = -*s);
                }
                let mut f = vec![0.0; elements.len() * self.kit.unknowns()];
                self.kit.shapes.forces(&elements, &stress, &mut f, scratch);
                self.scatter(&elements, &f, layer);
            }
        });
    }

    /// Changes of amplitudes that follow a change of displacement.
    pub fn following(&self, team: &Team, iterate: &Iterate, change: &[f64]) -> Vec<f64> {
        let (modes, points) = (self.kit.treatment.modes(), self.kit.shapes.points);
        if modes == 0 {
            return Vec::new();
        }
        let layers = team.map(self.layers(), |layer| {
            let (mut scratch, mut known) = (Scratch::default(), Known::default());
            let (mut u, mut out) = (Vec::new(), Vec::new());
            for (first, elements) in self.batches(layer) {
                self.gather(&elements, change, &mut u);
                let mut strains = vec![[0.0; 6]; elements.len() * points];
                self.kit.shapes.strains(&elements, &u, &mut strains, &mut scratch);
                for (e, strains) in strains.chunks_exact_mut(points).enumerate() {
                    let number = layer * self.per_layer() + first + e;
                    let tangents = &iterate.tangents[number * points..][..points];
                    let prepared = self.kit.prepare_after(&mut known, elements[e], tangents);
                    let forces = &iterate.mode_forces[number * modes..][..modes];
                    out.extend(self.kit.following(prepared, tangents, strains, forces));
                }
            }
            out
        });
        layers.concat()
    }
}
