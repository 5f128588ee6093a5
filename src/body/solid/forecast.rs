//! Cost of a solid.

use std::borrow::Cow;

use super::front::may_melt;
use super::rows::Choice;
use super::savings::savings;
use super::{PARTS_OF_A_FOOTPRINT, is_large, plan};
use crate::body::threads_for;
use crate::channel::{Channel, Direction};
use crate::coupling::FaceRings;
use crate::laws::Conduction;
use crate::math::chebyshev::products;
use crate::method::enthalpy::EnthalpyHeat;
use crate::method::fem::{
    Geometry, Mesh, Plan, expected_entries, factor_memory, memory_of_row, particle_cost,
    solver_memory, suits_conjugate_gradients,
};
use crate::method::inelastic::{MOST_KEPT, MOST_POISSON};
use crate::scene::{CellShape, CellValues, Coupling, Load, Scene, Solid};

#[derive(Debug, Clone, PartialEq)]
pub struct BodyForecast {
    pub name: String,
    /// Nodes along x, y, z (r, –, z in axisymmetry) of the meshed part.
    pub nodes: [usize; 3],
    /// Nodes of the whole body, in files; 0 of reduced ones.
    pub drawn: usize,
    /// Unknowns of heat and of displacement.
    pub unknowns: [usize; 2],
    /// Smallest and largest distance of nodes along each axis [m].
    pub spacing: [[f64; 2]; 3],
    /// Order of the shape functions.
    pub order: usize,
    /// Set if particles conduct the heat.
    pub particles: Option<ParticleForecast>,
    /// Memory of the model [B].
    pub memory: f64,
    /// Time to build the model, and time of a step whose stresses are read [s].
    pub build_time: f64,
    pub step_time: f64,
    /// Time in which heat follows a footprint that moves by its radius [s]; zero where inner steps follow it.
    pub way_time: f64,
    /// Set if the solid is reduced; its number of unknowns if that is known.
    pub reduced: Option<Option<usize>>,
    /// Notes on choices and simplifications.
    pub notes: Vec<String>,
    /// Keys that shorten a long run.
    pub savings: Option<String>,
}

/// Work of particles in a communication step of the default experiment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParticleForecast {
    /// Neighbours of a particle, itself included.
    pub neighbours: usize,
    /// Equal sub-steps, and products with the sparse matrix in each while inputs are constant.
    pub sub_steps: usize,
    pub products: usize,
    /// Sub-steps that the stability limit of the explicit Euler method would require.
    pub euler_steps: f64,
}

/// Rates of a typical machine: entries per second when solving, operations per second when factoring, the latter on
/// each thread.
const SOLVE_RATE: f64 = 1.2e9;
const FACTOR_RATE: f64 = 1.25e10;
/// Unknowns of bricks that conjugate gradients solve for per second, on each thread.
const BRICK_RATE: f64 = 7e5;
/// Products of particles' matrices: entries per second on one thread, and rows built per second.
pub const PRODUCT_RATE: f64 = 9e8;
const ROW_RATE: f64 = 2.5e4;
/// Time per node for nonlinear heat in a communication step [s], and further time in a run for each pair of nodes if a
/// melting front crosses some of them: each crossing costs inner steps of the whole body.
const NONLINEAR_HEAT: f64 = 3e-6;
const FRONT: f64 = 1.2e-8;
/// The same for an exchange with a fluid above, over a power of the Fourier number `a Δt/h²` of the smallest distance h
/// of nodes: heat that begins to flow takes the more inner steps the further it gets. Measured on plates of plastic,
/// wax, glass, steel and aluminium of 7000 to 67 000 nodes below strands of wax, with exchanges of 0.01 to 30;
/// forecasts are 0.7 to 2.5 times these 23 times, and 0.9 to 4 times 12 other ones.
const EXCHANGED_HEAT: f64 = 4.2e-6;
const OF_FOURIER: f64 = 0.35;
/// Time per node of an exchange in which heat hardly flows [s], and that of a plate that a hotter fluid may melt over
/// that of others.
const LEAST_EXCHANGED: f64 = 7e-7;
const MELTING: f64 = 2.0;
/// Time per node for the equilibrium of a body with yielding parts in a step [s], in boxes and in sections: the middle,
/// in ratio, of bodies that stay elastic and of those that flow throughout. Constants that depend on the temperature
/// and the inner steps of creep multiply it.
const YIELDING: f64 = 1.1e-5;
const YIELDING_SECTION: f64 = 2e-5;
const WITH_TABLES: f64 = 2.5;
const WITH_CREEP: f64 = 5.0;
/// Time per node for the equilibrium of a body in which cracks grow in a step [s], the middle of quenches, and memory
/// per node [B].
const CRACKING: f64 = 2.5e-5;
const CRACKING_MEMORY: f64 = 2e3;
/// The same in space, where a factor comes on top: the middle of bodies in which little cracks and of a surface on
/// which a network of cracks forms. Intact bodies take a fifth, the step in which a network forms thirty times that.
const CRACKING_IN_SPACE: f64 = 1.5e-4;
const CRACKING_MEMORY_IN_SPACE: f64 = 9e3;
/// Time of a body with moduli that relax, over that of one that stays elastic: a step is compared with its halves.
const WITH_RELAXATION: f64 = 4.0;
/// Memory per node of a body with yielding parts [B].
const YIELDING_MEMORY: f64 = 8e3;
/// Modes through layers: cube of the number of nodes along z per second, on each thread.
const COLUMN_RATE: f64 = 1e8;

/// Estimates the cost without building the solid.
pub fn forecast_solid(scene: &Scene, name: &str, solid: &Solid) -> BodyForecast {
    let plan = plan(scene, name, solid);
    let unknowns = plan.unknowns();
    let n = unknowns[1] as f64;
    let geometry = plan.mesh.geometry;
    // Bodies that yield have a factor of one section alone.
    let is_yielding_box = plan.inelastic.is_some() && geometry == Geometry::Box;
    let suits = |law| suits_conjugate_gradients(&plan.mesh, law);
    let by_bricks = is_yielding_box || plan.law.as_deref().is_some_and(suits);
    let entries = if by_bricks { 0.0 } else { expected_entries(geometry, unknowns[1]) };
    let operations = match geometry {
        _ if by_bricks => 0.0,
        Geometry::Axisymmetric => 10.0 * n.powf(1.5),
        Geometry::Box => 10.0 * n * n,
    };
    let solver = plan.law.as_ref().map_or(0.0, |law| solver_memory(&plan.mesh, law));
    // Bricks need no assembly.
    let assembly = if by_bricks { 3e-7 } else { 2e-5 };
    // Those of equilibrium are counted with it.
    let iterations = if by_bricks && !is_yielding_box { n / BRICK_RATE } else { 0.0 };
    let at_start = |axis| is_odd_at_start(scene, name, axis);
    let classes = count_classes(plan.mesh.mirrored, at_start);
    // Memory is taken when a class is first loaded; the time is that of a run that loads all possible classes.
    let later = expected_classes(scene, name, &plan);
    let spacing = plan.mesh.axes.each_ref().map(|axis| {
        let steps = axis.nodes.windows(2).map(|pair| pair[1] - pair[0]);
        steps.fold([f64::INFINITY, 0.0], |[low, high], step| [low.min(step), high.max(step)])
    });
    let threads = threads_for(scene.solver.threads, is_large(&plan)) as f64;
    let cost = particle_cost(&plan);
    let particles = cost.map(|cost| {
        let (sub_steps, products) = products(cost.bound, scene.step);
        let euler_steps = (0.5 * cost.bound * scene.step).ceil().max(1.0);
        ParticleForecast { neighbours: cost.neighbours, sub_steps, products, euler_steps }
    });
    let links = particles.map_or(0.0, |p| p.neighbours as f64 * unknowns[0] as f64);
    let passes = particles.map_or(0.0, |p| p.sub_steps as f64 * p.products as f64);
    // Each axis has a full matrix and the data to compute it.
    let modes = plan.mesh.axes.iter().map(|axis| 3.0 * (axis.len() as f64).powi(2));
    let modes: f64 = if particles.is_none() { modes.sum() } else { 0.0 };
    let nodes = unknowns[0] as f64;
    let (mut further_memory, mut nonlinear_time) = (0.0, 0.0);
    let mut proposed = None;
    if plan.newton.is_some() {
        further_memory += EnthalpyHeat::expected_bytes(plan.mesh.sided_counts());
        // Exchanges with a fluid are counted with it.
        let advances_alone = scene.couplings_to(name).next().is_none();
        nonlinear_time += if advances_alone { NONLINEAR_HEAT * nodes } else { 0.0 };
        if may_melt(scene, name, solid) {
            nonlinear_time += FRONT * nodes.powi(2) * scene.step / scene.stop_time;
        }
    }
    if plan.inelastic.is_some() {
        further_memory += (YIELDING_MEMORY + memory_of_branches(solid)) * nodes;
        if !is_yielding_box || becomes_incompressible(solid) {
            let kept = if solid.relaxes() { MOST_KEPT } else { 1 };
            further_memory += (kept + 1) as f64 * factor_memory(geometry, unknowns[1]);
        }
        nonlinear_time += yielding_time(solid, geometry) * nodes / threads;
    }
    if plan.damage.is_some() {
        let (memory, time) = match plan.cracks_in_section {
            true => (CRACKING_MEMORY, CRACKING),
            false => (CRACKING_MEMORY_IN_SPACE, CRACKING_IN_SPACE),
        };
        // In space the factor of a patch is smaller than that of the whole, in which its rounding fits, too.
        further_memory += memory * nodes
            + match plan.cracks_in_section {
                true => 2.0 * factor_memory(Geometry::Axisymmetric, unknowns[1]),
                false => factor_memory(Geometry::Box, unknowns[1]),
            };
        let factor = match plan.cracks_in_section {
            true => 0.0,
            false => 10.0 * n * n / (FACTOR_RATE * threads),
        };
        nonlinear_time += time * nodes + factor;
        let time = (time * nodes + factor) * (scene.stop_time / scene.step).ceil();
        proposed = savings(scene, (name, solid), (nodes, time));
    }
    if scene.meets_rings(name) {
        further_memory += FaceRings::expected_bytes(&plan.mesh);
    }
    let columns = classes * plan.entries_of_columns();
    let rows_of_reading = Choice::of(scene, (name, solid), &plan).rows as f64;
    let rows = if particles.is_some() { unknowns[0] as f64 } else { 0.0 };
    let heat_time =
        1e-7 * unknowns[0] as f64 + columns / SOLVE_RATE + passes * links / PRODUCT_RATE;
    let is_linear = plan.newton.is_none() && particles.is_none();
    BodyForecast {
        name: name.into(),
        nodes: plan.mesh.node_counts(),
        drawn: whole(&plan.mesh),
        unknowns,
        spacing,
        order: plan.mesh.order(),
        particles,
        reduced: None,
        memory: further_memory
            + classes * (solver + rows_of_reading * memory_of_row(&plan.mesh))
            + 8.0 * (20.0 * unknowns[0] as f64 + modes + columns)
            + 12.0 * links,
        build_time: later * operations / (FACTOR_RATE * threads)
            + assembly * n
            + rows / ROW_RATE
            + columns * plan.mesh.sided_counts()[2] as f64 / (COLUMN_RATE * threads),
        step_time: later * (entries / SOLVE_RATE + iterations / threads + 5e-7 * n)
            + nonlinear_time
            + heat_time,
        way_time: if is_linear { PARTS_OF_A_FOOTPRINT * heat_time } else { 0.0 },
        notes: plan.notes.into_iter().chain(proposed.clone()).collect(),
        savings: proposed,
    }
}

/// Time of nonlinear heat in an exchange of some length [s] with a fluid of a temperature [K]; none of a body whose
/// heat is linear.
pub fn exchanged_heat_time(plan: &Plan, length: f64, temperature: f64) -> f64 {
    let Some(newton) = &plan.newton else { return 0.0 };
    let distances = plan.mesh.axes.iter().flat_map(|axis| axis.nodes.windows(2));
    let smallest = distances.map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
    let fastest = newton.materials.iter().map(fastest_diffusivity).fold(0.0, f64::max);
    let fourier = fastest * length / (smallest * smallest);
    let melting = newton.materials.iter().filter_map(|own| own.melting.as_ref());
    let melts = melting.map(|own| own.solidus).any(|solidus| solidus < temperature);
    let of_node = (EXCHANGED_HEAT * fourier.powf(OF_FOURIER)).max(LEAST_EXCHANGED);
    of_node * plan.mesh.nodes() as f64 * if melts { MELTING } else { 1.0 }
}

/// Bound on the diffusivity of a material [m²/s].
fn fastest_diffusivity(material: &Conduction) -> f64 {
    let conductivity = material.conductivity.values().iter().copied().fold(0.0, f64::max);
    let heats = material.specific_heat.values().iter().copied();
    conductivity / (material.density * heats.fold(f64::INFINITY, f64::min))
}

/// Returns true if moduli relax to a ratio of Poisson at which the stiffness of a box has to be factored.
fn becomes_incompressible(solid: &Solid) -> bool {
    let start = solid.initial_temperature;
    solid.materials_of_layers().into_iter().any(|material| {
        let Some(relaxing) = material.law.deformation().relaxing() else { return false };
        let Some(law) = material.at(start).law() else { return false };
        let [bulk, shear] = relaxing.lasting();
        let bulk = bulk * (law.lame_first() + law.shear_modulus() / 1.5);
        let shear = shear * law.shear_modulus();
        0.5 * (3.0 * bulk - 2.0 * shear) > MOST_POISSON * (3.0 * bulk + shear)
    })
}

/// Memory per node of the history of moduli that relax [B]: quadratic elements have some four points for each node, and
/// a step compares five states.
fn memory_of_branches(solid: &Solid) -> f64 {
    let materials = solid.materials_of_layers().into_iter();
    let laws = materials.filter_map(|own| own.law.deformation().relaxing());
    let branches = laws.map(|own| 7 + own.bulk_relaxation.len() + 6 * own.shear_relaxation.len());
    8.0 * 4.0 * 5.0 * branches.max().unwrap_or(0) as f64
}

/// Time per node for the equilibrium in a step [s].
fn yielding_time(solid: &Solid, geometry: Geometry) -> f64 {
    let materials = solid.materials_of_layers();
    let has_tables = materials.iter().any(|own| {
        let properties = own.law.deformation().properties();
        !properties.iter().all(|(_, property)| property.is_constant())
    });
    let creeps = materials.iter().any(|own| own.law.deformation().creeps());
    let base = if geometry == Geometry::Box { YIELDING } else { YIELDING_SECTION };
    let more = match (creeps, solid.relaxes()) {
        (true, _) => WITH_CREEP,
        (false, true) => WITH_RELAXATION,
        (false, false) => 1.0,
    };
    base * more * if has_tables { WITH_TABLES } else { 1.0 }
}

/// Nodes of a mesh and its mirror images.
fn whole(mesh: &Mesh) -> usize {
    let [columns, rows, layers] = mesh.node_counts();
    let [columns, rows] = [(columns, 0), (rows, 1)]
        .map(|(count, axis)| if mesh.mirrored[axis] { 2 * count - 1 } else { count });
    columns * rows * layers
}

/// Number of symmetry classes that may be loaded during a run.
fn expected_classes(scene: &Scene, name: &str, plan: &Plan) -> f64 {
    let is_odd = |axis| is_odd_at_start(scene, name, axis) || becomes_odd(scene, name, axis);
    count_classes(plan.mesh.mirrored, is_odd)
}

/// Number of loaded symmetry classes, each with a solver of its own.
fn count_classes(mirrored: [bool; 2], is_odd: impl Fn(usize) -> bool) -> f64 {
    let axes = [0, 1].into_iter().filter(|&axis| mirrored[axis] && is_odd(axis));
    axes.fold(1.0, |count, _| 2.0 * count)
}

/// Returns true if loads have an antisymmetric part at the start about the plane across an axis.
fn is_odd_at_start(scene: &Scene, name: &str, axis: usize) -> bool {
    scene.loads_on(name).any(|load| {
        let start = &load.start;
        let place = [start.x, start.y][axis].unwrap_or(0.0);
        let mut started =
            load.channels().filter_map(|channel| Some((channel, start.amounts(channel)?)));
        let is_odd = |(channel, values): (Channel, Cow<CellValues>)| {
            channel.direction() == Direction::Along(axis) || matches!(*values, CellValues::Tiles(_))
        };
        place != 0.0 || started.any(is_odd)
    })
}

/// Returns true if loads may acquire such a part: tiles, footprints with room to move, and drops that land off the
/// plane.
fn becomes_odd(scene: &Scene, name: &str, axis: usize) -> bool {
    let of_load = |load: &Load| {
        let tiles =
            matches!(load.footprint.cells(), Some(CellShape::Tiles(count)) if count[axis] > 1);
        let range = [load.range.x, load.range.y][axis];
        tiles || range.is_some_and(|range| range != [0.0; 2])
    };
    let of_droplet = |coupling: &Coupling| {
        scene.droplet(&coupling.from).is_some_and(|droplet| !droplet.even()[axis])
    };
    scene.loads_on(name).any(of_load) || scene.couplings_to(name).any(of_droplet)
}
