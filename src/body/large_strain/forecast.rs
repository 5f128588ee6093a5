//! Cost of solids of large strain.

mod impact;
mod start;

use impact::Impact;
use start::StartLoads;

use super::plan;
use crate::body::threads_for;
use crate::laws::solid::large_strain::{Deviator, LargeStrainLaw, Thermal};
use crate::method::large_strain::{LayerOfBody, TOGETHER};
use crate::scene::{Coupling, LargeStrain, Mechanics, MotionSteps, Scene, SolidShape};
use crate::space::{Form, Integration, Mesh, Supports};

#[derive(Debug, Clone, PartialEq)]
pub struct LargeStrainForecast {
    pub name: String,
    /// Nodes of the model, and points of its volume.
    pub nodes: usize,
    pub points: usize,
    /// Nodes with their mirror images, in files.
    pub drawn: usize,
    /// Time step of the undeformed body [s]; `None` for a body in equilibrium.
    pub time_step: Option<f64>,
    /// Time steps of the default experiment, or steps of equilibrium.
    pub steps: f64,
    /// Memory [B].
    pub memory: f64,
    /// Time to run the default experiment [s].
    pub run_time: f64,
    /// Notes on choices and simplifications.
    pub notes: Vec<String>,
}

/// Times of a step of a body without explicit steps [s], all iterations of a usual step included.
struct StepTimes {
    /// Of a point in a plane and in space, and of a pair of functions of the points that share a dilatation.
    point: [f64; 2],
    pair: f64,
    /// Of a point of a sheet, whose thickness is found by iteration, in addition.
    of_sheet: f64,
    /// Of the factorisations, over a product of powers of the size of the mesh and of the functions at a point: see
    /// [`Self::of_factors`].
    in_plane: f64,
    in_space: f64,
    powers_of_size: [f64; 2],
    powers_of_functions: [f64; 2],
}

/// Equilibria of bodies that stay elastic and of those that yield, and implicit steps of both.
///
/// Fitted to processor times of `impinge run` on one thread of an AMD EPYC (Zen 5): squares and cubes of rubber and of
/// metal that yields, in plane strain, in plane stress and in space, with `fem`, `rkpm` (`nsni`, `gauss`), `efg` and
/// `sph`, of 121 to 10 200 nodes in a plane and 125 to 3400 in space. They are sheared by 15 % and 1 % in three steps,
/// or set in motion by a traction for six. To these come bars of 4 to 16 elements across, bent and drawn out by 0.2 to
/// 3 times the yield strain a step, or at once by a jump. Of 168 forecasts, 164 were within a factor of two of the
/// measured times at the fit; the others were 0.32 to 2.5 times these. Pairs have become faster since: `OF_KERNELS`.
/// `benches/forecasts.py "bent steel"` repeats four cases, whose forecasts are 0.63 to 1.1 times the measured times.
///
/// Newton's method takes some 3 iterations for a step of rubber and 10 to 20 where metal yields. Each of these
/// evaluates the law up to four times, as lengths of its steps are tried.
const ELASTIC: StepTimes = StepTimes {
    point: [6e-6, 9e-6],
    pair: 7e-8,
    of_sheet: 1e-5,
    in_plane: 2.0e-9,
    in_space: 6.5e-8,
    powers_of_size: [1.0, 0.8],
    powers_of_functions: [2.0, 1.33],
};
const YIELDING: StepTimes = StepTimes {
    point: [1.8e-5, 3.5e-5],
    pair: 1.3e-7,
    of_sheet: 7e-5,
    in_plane: 5.7e-7,
    in_space: 1.8e-7,
    powers_of_size: [1.0, 0.9],
    powers_of_functions: [0.8, 0.8],
};
const IMPLICIT: StepTimes = StepTimes {
    point: [2.6e-6; 2],
    pair: 8.5e-8,
    of_sheet: 1.3e-5,
    in_plane: 4.8e-7,
    in_space: 1.7e-7,
    powers_of_size: [1.0, 0.9],
    powers_of_functions: [0.8, 0.8],
};
const IMPLICIT_YIELDING: StepTimes = StepTimes {
    point: [2.4e-5; 2],
    pair: 7.5e-8,
    of_sheet: 2.5e-5,
    in_plane: 3.2e-7,
    in_space: 9.5e-8,
    powers_of_size: [1.0, 0.9],
    powers_of_functions: [0.8, 0.8],
};
/// Equilibria of concrete, and the time of an implicit step over that of an elastic body: its tangent is made of
/// differences, and softening takes many iterations.
const CONCRETE: StepTimes = StepTimes {
    point: [0.0; 2],
    pair: 1.6e-6,
    of_sheet: 0.0,
    in_plane: 2.1e-5,
    in_space: 4.5e-6,
    powers_of_size: [1.0, 0.9],
    powers_of_functions: [0.8, 0.8],
};
const SWINGING_CONCRETE: f64 = 22.0;
/// Usual steps that take as long as a jump at the start, over its strain by the yield strain: at rest, those of sheets,
/// and by implicit steps, of which such a jump takes many.
const OF_JUMP: f64 = 1.0;
const OF_JUMP_OF_SHEET: f64 = 0.3;
const OF_IMPLICIT_JUMP: f64 = 0.2;
/// Time of a step under loads that the start sets, over that of one in which they change: nothing moves in it unless
/// inputs do.
const HELD: f64 = 0.3;
/// Time of a point and of a function there in an explicit step [s], and that of a metal over it: 16² to 160² cells in a
/// plane and 4³ to 28³ in space, by the same discretisations. Forecasts are 0.59 to 1.55 times the 60 measured times.
/// The same of concrete, and of a metal with a back stress, whose flow has no axes that are known before.
const MOVING: [f64; 2] = [0.18e-6, 0.011e-6];
const MOVING_YIELDING: f64 = 1.35;
const MOVING_CONCRETE: f64 = 1.6;
const MOVING_KINEMATIC: f64 = 4.7;
/// Time of other steps of such a metal over that of a metal without a back stress: 2.0 to 3.4 times, and of sheets 3.9
/// and 6.3 times.
const KINEMATIC: f64 = 2.6;
const KINEMATIC_SHEET: f64 = 5.0;
/// Time to set up a point in a plane and in space by elements, particles and kernels [s], and to start a run.
const SET_UP: [[f64; 2]; 3] = [[0.5e-6; 2], [2e-6, 8e-6], [5e-6, 35e-6]];
const START: f64 = 0.03;
/// Parts of a usual step of heat, and time of a pair of functions at a point in one [s].
const PARTS: f64 = 4.0;
const HEAT: f64 = 0.05e-6;
/// Time to factor the capacity of a body that conducts, over the power 1.5 of the nodes in a plane and the square in
/// space [s].
const FACTOR_OF_HEAT: [f64; 2] = [4.4e-9, 6.7e-9];
/// Memory of the program for a body, of a point, and of a function there [B]; with [`OF_PAIR`] and those after it
/// 0.57 to 1.68 times the peak resident memory of all runs above.
const OF_BODY: f64 = 11e6;
const POINT: f64 = 250.0;
const FUNCTION: f64 = 130.0;

impl LargeStrainForecast {
    /// Estimates the cost from the mesh alone.
    pub fn of(scene: &Scene, name: &str, solid: &LargeStrain) -> Self {
        let mesh = plan::mesh(solid);
        let nodes = mesh.nodes.len();
        let size = Size::of(solid, &mesh);
        let Size { points, functions, .. } = size;
        let threads = threads_for(scene.solver.threads, super::is_large(points)) as f64;
        let layers = plan::layers(solid);
        let speeds = layers.iter().map(|own| (own.law.wave_modulus() / own.density).sqrt());
        let speed = speeds.fold(0.0, f64::max);
        let history = layers.iter().map(|own| own.law.history()).max().unwrap_or(0);
        // Four fifths of the largest stable step, with the plane as stiff as the body.
        let explicit = solid.is_above();
        let time_step = explicit.then(|| OF_CROSSING * solid.spacing() / speed);
        let impact = Impact::of(solid, &layers[0]).filter(|_| explicit);
        let shorter = impact.as_ref().map_or(1.0, |impact| impact.mean(scene.stop_time));
        let exchanges = (scene.stop_time / scene.step).ceil();
        let steps =
            time_step.map_or(exchanges, |dt| (shorter * scene.stop_time / dt).max(exchanges));
        let start = StartLoads::of(solid, &layers);
        let of_step = match explicit {
            true => slower_in_motion(&layers) * points as f64 * (MOVING[0] + MOVING[1] * functions),
            false if solid.is_of_concrete() => of_concrete(solid, &size),
            false => {
                let slower = if has_back_stress(&layers) { of_back_stress(solid) } else { 1.0 };
                let [elastic, yielding] =
                    times(solid).map(|own| own.of_step(&size, solid.is_sheet()));
                let share = if solid.yields() { start.share_of_yielding() } else { 0.0 };
                slower * (elastic + share * (yielding - elastic))
            }
        };
        // Steps that take as long as all of the run.
        let usual_steps = if explicit { steps } else { start.usual_steps(solid, steps) };
        let heat = match solid.conducts() {
            true => {
                PARTS
                    * (points as f64 * HEAT * functions * functions
                        + factor_of_heat(solid.form(), nodes as f64))
            }
            false => 0.0,
        };
        let of_point = POINT + FUNCTION * functions + 8.0 * history as f64;
        let is_symmetric = !solid.inertia && layers.iter().all(|own| own.law.is_symmetric());
        let solver = match (explicit, is_symmetric) {
            (true, _) => 0.0,
            (false, false) => size.solver_memory([0.0, 1.0]),
            (false, true) if solid.yields() => size.solver_memory([ALREADY_FACTORED, 1.0]),
            (false, true) => size.solver_memory([1.0, 0.0]),
        };
        let memory = OF_BODY + of_point * points as f64 + solver;
        let set_up = SET_UP[match solid.mechanics {
            Mechanics::Fem => 0,
            Mechanics::Sph => 1,
            Mechanics::Rkpm | Mechanics::Efg => 2,
        }];
        let set_up = points as f64 * set_up[usize::from(solid.form() == Form::Solid)];
        Self {
            name: name.to_owned(),
            nodes,
            points,
            drawn: nodes * super::snapshot::copies(solid.mirrors()) as usize,
            time_step,
            steps,
            memory,
            run_time: START
                + set_up
                + usual_steps * of_step / if explicit { threads } else { 1.0 }
                + exchanges * heat,
            notes: notes(solid)
                .into_iter()
                .chain(impact.and_then(|impact| impact.note()))
                .collect(),
        }
    }
}

/// Times of a usual step of a body without explicit steps, if it stays elastic and if it yields.
fn times(solid: &LargeStrain) -> [&'static StepTimes; 2] {
    if solid.inertia { [&IMPLICIT, &IMPLICIT_YIELDING] } else { [&ELASTIC, &YIELDING] }
}

/// Time of a step of concrete without explicit steps [s].
fn of_concrete(solid: &LargeStrain, size: &Size) -> f64 {
    match solid.inertia {
        true => SWINGING_CONCRETE * IMPLICIT.of_step(size, false),
        false => CONCRETE.of_step(size, false),
    }
}

fn has_back_stress(layers: &[LayerOfBody]) -> bool {
    layers.iter().any(|own| !own.law.is_symmetric() && own.law.concrete().is_none())
}

/// Time of other steps of a metal with a back stress over that of one without.
fn of_back_stress(solid: &LargeStrain) -> f64 {
    if solid.is_sheet() { KINEMATIC_SHEET } else { KINEMATIC }
}

/// Time of an explicit step of a body over that of an elastic one.
fn slower_in_motion(layers: &[LayerOfBody]) -> f64 {
    let of_law = |own: &LayerOfBody| match &own.law.deviator {
        Deviator::Relaxing(_) => 1.0,
        Deviator::Plastic(metal) if metal.kinematic > 0.0 => MOVING_KINEMATIC,
        Deviator::Plastic(_) => MOVING_YIELDING,
        Deviator::Concrete(_) => MOVING_CONCRETE,
    };
    layers.iter().map(of_law).fold(1.0, f64::max)
}

/// Stable step over the time in which sound crosses an element.
const OF_CROSSING: f64 = 0.45;

/// Sizes of a model.
struct Size {
    form: Form,
    nodes: f64,
    points: usize,
    /// Functions at a point, and points that share a dilatation.
    functions: f64,
    together: f64,
    /// Product of the nodes with those across the model in a plane; with those across one way and the square of those
    /// across the other in space. Factorisations of long bodies take less than those of cubes.
    across: f64,
}

impl Size {
    fn of(solid: &LargeStrain, mesh: &Mesh) -> Self {
        let axes = mesh.form.axes();
        let corners = 1 << axes.len();
        let of_element = (solid.order() + 1).pow(axes.len() as u32);
        let kernels = plan::kernels(solid, mesh);
        let nodes = mesh.nodes.len() as f64;
        let along = |&a: &usize| {
            let all = || mesh.nodes.iter().map(|at| at[a]);
            let [low, high] =
                [all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max)];
            (high - low) / solid.spacing() + 1.0
        };
        let mut counts: Vec<f64> = axes.iter().map(along).collect();
        counts.sort_by(f64::total_cmp);
        let across = match counts[..] {
            [least, middle, _] => least * least * middle,
            _ => counts[0].powi(2),
        };
        // Functions that reach a place; near faces some of them are missing.
        let product =
            |reach: f64| counts.iter().map(|count| within(reach, *count)).product::<f64>();
        // Elsewhere nodes are nearer to each other than their distance along the axes.
        let is_section = matches!(solid.shape, SolidShape::Disc(_)) && mesh.form != Form::Solid;
        let is_lattice = solid.is_box() || is_section || mesh.cells.is_empty();
        let (points, functions, together) = match (solid.mechanics, kernels.integration) {
            (Mechanics::Fem, _) => {
                (mesh.cells.len() * of_element, of_element as f64, of_element as f64)
            }
            (Mechanics::Sph, _) => {
                let support = solid.sph.unwrap_or_default().support;
                let missing = counts.iter().map(|count| (1.0 - 0.2 * support / count).max(0.5));
                let functions = match is_lattice {
                    true => lattice(support, axes.len()) * missing.product::<f64>(),
                    false => Supports::Balls(support).functions_at_nodes(mesh),
                };
                (plan::cells(mesh) * corners, functions, corners as f64)
            }
            (_, integration) => {
                // Averaged gradients have the functions of all cells within the radius, means over the cell of a node
                // those of all of its corners.
                let averaged =
                    kernels.smoothing.map_or(0.0, |radius| 2.0 * radius / solid.spacing());
                let (cells, reach) = match integration {
                    Integration::Scni | Integration::Nsni => {
                        (mesh.nodes.len(), 2.0 * (kernels.support + 0.5).floor() + 1.0)
                    }
                    Integration::Gauss(_) => (mesh.cells.len(), 2.0 * kernels.support - 0.5),
                };
                let of_cell = integration.points_of_cell(mesh.form);
                let functions = match is_lattice {
                    true => product(reach + averaged),
                    false => {
                        let around = (0.5 * (reach + averaged) - kernels.support).max(0.0);
                        let supports = Supports::Boxes { support: kernels.support, around };
                        supports.functions_at_nodes(mesh)
                    }
                };
                (of_cell * cells, functions, 1.0)
            }
        };
        let across = if axes.len() == 3 { across.min(nodes) } else { across.min(nodes).sqrt() };
        Self { form: mesh.form, nodes, points, functions, together, across: nodes * across }
    }

    /// Entries of the stiffness matrices of the points that share a dilatation.
    fn entries_of_blocks(&self) -> f64 {
        let axes = self.form.axes().len() as f64;
        self.points as f64 / self.together * (axes * self.functions).powi(2)
    }

    fn is_solid(&self) -> bool {
        self.form == Form::Solid
    }

    /// Memory of the stiffness and its factor [B]: the places of the entries of all blocks, the entries of those that
    /// are assembled together, and fill that grows with the power 4/3 of the unknowns in space, of symmetric and of
    /// general factors.
    fn solver_memory(&self, factors: [f64; 2]) -> f64 {
        let axes = self.form.axes().len() as f64;
        let unknowns = axes * self.nodes;
        let blocks = self.entries_of_blocks();
        let fill = match self.is_solid() {
            true => unknowns.powf(4.0 / 3.0) * self.functions.sqrt(),
            false => unknowns * self.functions * unknowns.max(2.0).log2(),
        };
        let of_fill = [OF_FILL, OF_GENERAL_FILL].map(|own| own[usize::from(self.is_solid())]);
        let fill = fill * (factors[0] * of_fill[0] + factors[1] * of_fill[1]);
        OF_PAIR * blocks / axes.powi(2) + 8.0 * blocks.min(TOGETHER as f64) + fill
    }
}

/// Part of a symmetric factor that is in memory with a general one: tangents of metal that yields may not be positive
/// definite, which shows while they are factored.
const ALREADY_FACTORED: f64 = 0.6;
/// Memory of a pair of nodes of a block, and of the fill in a plane and in space, of symmetric and general matrices [B].
const OF_PAIR: f64 = 4.4;
const OF_FILL: [f64; 2] = [63.0, 137.0];
const OF_GENERAL_FILL: [f64; 2] = [118.0, 350.0];

/// Time of a pair of functions in a plane and in space, where each point has a dilatation of its own, over that of other
/// points.
const OF_KERNELS: [f64; 2] = [0.5, 0.3];

impl StepTimes {
    fn of_step(&self, size: &Size, is_sheet: bool) -> f64 {
        let points = size.points as f64;
        let pairs = points / size.together * size.functions.powi(2);
        // Points of a node, whose functions are about the same, are assembled together.
        let alike =
            if size.together > 1.0 { 1.0 } else { OF_KERNELS[usize::from(size.is_solid())] };
        let of_point =
            self.point[usize::from(size.is_solid())] + if is_sheet { self.of_sheet } else { 0.0 };
        points * of_point + alike * pairs * self.pair + self.of_factors(size)
    }

    fn of_factors(&self, size: &Size) -> f64 {
        let n = usize::from(size.is_solid());
        let of_functions = size.functions.powf(self.powers_of_functions[n]);
        [self.in_plane, self.in_space][n] * size.across.powf(self.powers_of_size[n]) * of_functions
    }
}

/// Nodes among some in a row that a function of a reach has on average, in distances of nodes.
fn within(reach: f64, count: f64) -> f64 {
    if reach < 2.0 * count { reach - reach * reach / (4.0 * count) } else { count }
}

/// Nodes of a lattice within a distance of one of them, in distances of nodes.
fn lattice(distance: f64, axes: usize) -> f64 {
    let most = distance.floor() as i32;
    let within = |[x, y, z]: [i32; 3]| f64::from(x * x + y * y + z * z) < distance * distance;
    let depth = if axes == 3 { most } else { 0 };
    let mut count = 0.0;
    for x in -most..=most {
        for y in -most..=most {
            count += (-depth..=depth).filter(|&z| within([x, y, z])).count() as f64;
        }
    }
    count
}

fn factor_of_heat(form: Form, nodes: f64) -> f64 {
    match form {
        Form::Plane | Form::Axisymmetric => FACTOR_OF_HEAT[0] * nodes.powf(1.5),
        Form::Solid => FACTOR_OF_HEAT[1] * nodes.powi(2),
    }
}

/// Notes on choices and simplifications, with reasons: one sentence each.
pub fn notes(solid: &LargeStrain) -> Vec<String> {
    let part = match (solid.is_axisymmetric(), solid.mirrors()) {
        (true, _) => "a meridian section of the body is modelled: it is round about z".to_owned(),
        (_, [true, true]) => {
            "a quarter of the body is modelled: it mirrors itself in x = 0 and y = 0".to_owned()
        }
        (_, [true, false]) => "half of the body is modelled: it mirrors itself in x = 0".to_owned(),
        (_, [false, true]) => "half of the body is modelled: it mirrors itself in y = 0".to_owned(),
        _ => "the whole body is modelled: nothing makes it mirror itself, or the scene asks for it"
            .to_owned(),
    };
    let mut notes = vec![part, note_on_motion(solid)];
    notes.extend(note_on_temperature(solid).map(str::to_owned));
    let expands =
        solid.thermal().iter().any(Thermal::acts) && (solid.conducts() || solid.has_temperature());
    if expands && solid.form() == Form::Plane && !solid.is_sheet() {
        notes.push(NOTE_ON_PLANE_STRAIN.to_owned());
    }
    notes.extend(match solid.mechanics {
        Mechanics::Fem => None,
        Mechanics::Rkpm => {
            Some("nodes have reproducing kernels, which reach over several elements".to_owned())
        }
        Mechanics::Efg => {
            Some("nodes have moving least squares, which reach over several elements".to_owned())
        }
        Mechanics::Sph => Some(
            "particles keep the neighbours of the undeformed body; in bending they are soft, by 2 % at 14 across"
                .to_owned(),
        ),
    });
    let layers = plan::layers(solid);
    let hardly_changes = layers.iter().any(|own| own.law.is_nearly_incompressible());
    notes.extend(layers.iter().filter_map(|own| note_on_concrete(&own.law)));
    let is_metal = |own: &LayerOfBody| matches!(own.law.deviator, Deviator::Plastic(_));
    if layers.iter().any(is_metal) && !solid.is_above() {
        notes.push(if solid.inertia { NOTE_ON_SWINGING_METAL } else { NOTE_ON_METAL }.to_owned());
    }
    let is_kernel = matches!(solid.mechanics, Mechanics::Rkpm | Mechanics::Efg);
    // A sheet may change its thickness.
    if is_kernel && hardly_changes && !solid.is_sheet() {
        notes.push(NOTE_ON_LOCKING.to_owned());
    }
    notes
}

fn note_on_motion(solid: &LargeStrain) -> String {
    match solid.steps() {
        Some(MotionSteps::Explicit) => {
            let friction = match solid.friction.filter(|&friction| friction > 0.0) {
                Some(friction) => {
                    format!("rubs on what lies below with a coefficient of friction of {friction}")
                }
                None => "slides on what lies below without friction".to_owned(),
            };
            let heat = if solid.conducts() { "" } else { ", and the body conducts no heat" };
            format!(
                "the body {friction}; what lies below is rigid for it{heat}; time steps follow the speed of sound"
            )
        }
        Some(MotionSteps::Implicit) => {
            "each communication step is one implicit time step, of second order, which conserves energy; nothing is below \
             the body, and it conducts no heat"
                .to_owned()
        }
        None => {
            "the body has no inertia: it is in equilibrium at every communication point".to_owned()
        }
    }
}

/// Note on what follows from the constants of concrete.
fn note_on_concrete(law: &LargeStrainLaw) -> Option<String> {
    let concrete = law.concrete()?;
    let brittleness = concrete.brittleness_in_compression(law.young());
    let breaks = match brittleness < 1.0 {
        true => "",
        false => {
            ", so without inertia it has no equilibrium on its way down; a longer `lambda` of `damage` helps"
        }
    };
    Some(format!(
        "the concrete bears {:.3e} Pa in uniaxial compression, and softens there at most {brittleness:.2} times as fast as \
         elastic strain recovers{breaks}; beyond the peak uniaxial tension takes {:.3e} J/m³, with the exponent {:.3} and \
         {:.3} of damage by opening",
        concrete.surfaces.compressive,
        concrete.energy_of_tension(),
        concrete.exponents[1],
        concrete.opening
    ))
}

fn note_on_temperature(solid: &LargeStrain) -> Option<&'static str> {
    if solid.conducts() {
        return Some(match solid.conductance_below {
            Some(_) => {
                "heat flows in the body as it is deformed, and to what lies below where they touch; constants are those of its \
                 initial temperature"
            }
            None => {
                "heat flows in the body as it is deformed; constants are those of its initial temperature"
            }
        });
    }
    if solid.has_temperature() {
        return Some("the body has one temperature, which is an input: no heat flows in it");
    }
    let acts = solid.thermal().iter().any(Thermal::acts);
    acts.then_some("the body keeps its initial temperature: it neither expands nor relaxes faster where it is warm")
}

/// Notes on the time of steps in which metal yields.
const NOTE_ON_METAL: &str = "a step in which little metal yields takes a quarter of the time forecast, one that strains it by several times \
                             its yield strain three times that";
const NOTE_ON_SWINGING_METAL: &str = "a step in which little metal yields takes a quarter of the time forecast; one that strains it by several \
                                      times its yield strain takes three times that, and one that has to be cut into parts more: shorter \
                                      steps are cheaper then";

/// Note on a plane body that expands.
const NOTE_ON_PLANE_STRAIN: &str = "plane strain holds the body along y, so that it expands by 1 + ν times its coefficient in x and z; a strip \
                                    that is free along y takes `section = \"plane_stress\"`";

/// Note on kernels of a material that hardly changes its volume.
const NOTE_ON_LOCKING: &str = "the material hardly changes its volume, so the points of a kernel's cell share its dilatation; on coarse meshes \
                               it is too stiff all the same: at a Poisson's ratio of 0.4999 Cook's membrane of 16 cells a side by 4 %, with \
                               `rkpm = { integration = \"gauss\" }` by 0.8 %, with finite elements by 2.4 %, with quadratic ones by 0.4 %";

/// Longest time between exchanges with the body below [s]: the value of the scene, or the time in which the body falls
/// by an element.
pub fn contact_interval(coupling: &Coupling, solid: &LargeStrain) -> f64 {
    let start = solid.start;
    let speed = (start.velocity[2].powi(2) + 2.0 * solid.gravity * start.height).sqrt();
    coupling.interval.unwrap_or(solid.spacing() / speed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::large_strain::plan::deformable;
    use crate::scene::parse;

    /// Points and entries of the blocks, on which memory and time depend, are those of the body that is built.
    #[test]
    fn sizes_are_those_of_the_body() {
        let kinds = ["\"fem\"", "\"sph\"", "\"rkpm\"", "\"efg\""].map(|own| (own, "", 1));
        let gauss = ("\"rkpm\"", "rkpm = { integration = \"gauss\" }", 1);
        let nodal = ("\"rkpm\"", "rkpm = { integration = \"scni\" }", 1);
        let quadratic = ("\"fem\"", "", 2);
        for (mechanics, keys, order) in kinds.into_iter().chain([gauss, nodal, quadratic]) {
            let block = "box = [12e-3, 16e-3, 14e-3]";
            let ball = "ball = { radius = 5e-3 }";
            let strand =
                "strand = { path = [[0, 0, 0], [2e-2, 0, 0], [2e-2, 1e-2, 0]], radius = 2e-3 }";
            for (shape, dimension, spacing) in
                [(block, 2, 1e-3), (block, 3, 2e-3), (ball, 3, 1.5e-3), (strand, 3, 1.2e-3)]
            {
                let faces = if shape == ball { "" } else { "faces.left = { clamped = true }" };
                let text = format!(
                    "name = \"Block\"\nstop_time = 1.0\nstep = 1.0\n[body.block]\nkind = \"solid\"\nstrain = \
                     \"finite\"\ndimension = {dimension}\nshape = {{ {shape} }}\nsymmetry = \
                     \"none\"\ninitial_temperature = 293.15\nmesh = {{ spacing = {spacing:e}, order = {order} }}\nmechanics = \
                     {mechanics}\n{keys}\nmaterial = {{ model = \"neo_hookean\", density = 1000.0, specific_heat = \
                     1900.0, conductivity = 0.2, young = 1e6, poisson = 0.3 }}\n{faces}\ninertia = {}\n",
                    shape == ball
                );
                let scene = parse(&text, "scene.toml").unwrap_or_else(|error| panic!("{error}"));
                let solid = scene.large_strain("block").unwrap();
                let size = Size::of(solid, &plan::mesh(solid));
                let body = deformable(solid, 1).unwrap();
                let axes = body.space.form.axes().len();
                let of_group = |group| (axes * body.nodes_of(group).len()).pow(2);
                let entries: usize = body.space.groups.iter().map(of_group).sum();
                let case = format!("{mechanics} {order} {keys} {shape} {dimension}");
                let points = size.points as f64 / body.space.volume.len() as f64;
                assert!((0.8..1.25).contains(&points), "{case}: {points} of the points");
                let ratio = size.entries_of_blocks() / entries as f64;
                assert!((0.5..2.0).contains(&ratio), "{case}: {ratio} of the entries");
            }
        }
    }
}
