use std::collections::{BTreeMap, HashMap};
use std::ops::Range;
use std::rc::Rc;

use super::{
    DropletTotal, FaceInputKind, InputLayout, MaterialConstant, Parameter, Quantity, WallOutput,
    droplet, layers,
};
use crate::scene::{
    CellShape, CellValues, FaceName, Field, Gives, Load, LoadRange, Naming, Probe, Scene, Side,
    Solid,
};

/// All variables of a scene's unit. The value reference of a variable is its place in the list.
#[derive(Debug, Clone, PartialEq)]
pub struct Registry {
    pub variables: Vec<Variable>,
    by_name: HashMap<String, usize>,
}

/// One variable.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    pub name: String,
    pub description: String,
    pub slot: Slot,
    /// Set for reals.
    pub quantity: Option<Quantity>,
    /// Start value; none for outputs.
    pub start: Option<Value>,
    pub min: Option<f64>,
    pub max: Option<f64>,
}

/// A value of one of the FMI types in use.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    Real(f64),
    Integer(i32),
    Text(String),
}

/// What a variable stands for, and so where its value lives.
#[derive(Debug, Clone, PartialEq)]
pub enum Slot {
    /// Constant of the scene.
    Parameter(Parameter),
    /// Number of threads a unit may use.
    Threads,
    /// Folder for field files.
    OutputDirectory,
    /// Index into the state's inputs.
    Input(usize),
    /// Computed from the state.
    Output(Output),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Causality {
    Parameter,
    Input,
    Output,
}

/// A computed value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Output {
    /// Index into the scene's probes.
    Probe {
        probe: usize,
        component: Component,
    },
    /// Index into the scene's fields and, from zero, into the grid.
    Field {
        field: usize,
        component: Component,
        cell: [usize; 2],
    },
    Body {
        body: String,
        total: BodyTotal,
    },
    Droplet {
        body: String,
        total: DropletTotal,
    },
    /// Index into the scene's walls.
    Wall {
        wall: usize,
        output: WallOutput,
    },
}

/// A scalar at a point. Stress components stand in the order xx, yy, zz, xy, yz, xz.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Component {
    Temperature,
    Stress(usize),
    VonMises,
    MaxPrincipal,
    Displacement(usize),
}

/// A scalar of a whole body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BodyTotal {
    MaxTemperature,
    MaxVonMises,
    MaxPrincipal,
    HeatIn,
    HeatStored,
    HeatLost,
    HeatDrift,
    FallbackParticles,
}

const AXES: [&str; 3] = ["x", "y", "z"];
const STRESSES: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "xz"];

impl Variable {
    pub fn causality(&self) -> Causality {
        match self.slot {
            Slot::Parameter(_) | Slot::Threads | Slot::OutputDirectory => Causality::Parameter,
            Slot::Input(_) => Causality::Input,
            Slot::Output(_) => Causality::Output,
        }
    }

    /// The start value of a real.
    pub fn real_start(&self) -> Option<f64> {
        match self.start {
            Some(Value::Real(value)) => Some(value),
            _ => None,
        }
    }
}

impl Component {
    pub fn needs_mechanics(self) -> bool {
        self != Component::Temperature
    }

    pub fn key(self) -> String {
        match self {
            Component::Temperature => "temperature".into(),
            Component::Stress(i) => format!("stress_{}", STRESSES[i]),
            Component::VonMises => "von_mises".into(),
            Component::MaxPrincipal => "max_principal".into(),
            Component::Displacement(i) => format!("displacement_{}", AXES[i]),
        }
    }

    fn description(self) -> String {
        match self {
            Component::Temperature => "temperature".into(),
            Component::Stress(i) => format!("stress component {}", STRESSES[i]),
            Component::VonMises => "von Mises stress".into(),
            Component::MaxPrincipal => "largest principal stress, tension positive".into(),
            Component::Displacement(i) => format!("displacement along {}", AXES[i]),
        }
    }

    fn quantity(self) -> Quantity {
        match self {
            Component::Temperature => Quantity::Temperature,
            Component::Displacement(_) => Quantity::Displacement,
            _ => Quantity::Stress,
        }
    }
}

impl BodyTotal {
    pub const THERMAL: [BodyTotal; 4] =
        [BodyTotal::MaxTemperature, BodyTotal::HeatIn, BodyTotal::HeatStored, BodyTotal::HeatLost];
    /// What only particles have to tell.
    pub const OF_PARTICLES: [BodyTotal; 2] = [BodyTotal::HeatDrift, BodyTotal::FallbackParticles];
    pub const MECHANICAL: [BodyTotal; 2] = [BodyTotal::MaxVonMises, BodyTotal::MaxPrincipal];

    /// Whether no input acts on it at once.
    fn is_accumulated(self) -> bool {
        self == BodyTotal::HeatIn
            || self == BodyTotal::HeatStored
            || self == BodyTotal::HeatLost
            || BodyTotal::OF_PARTICLES.contains(&self)
    }

    fn key(self) -> &'static str {
        match self {
            BodyTotal::MaxTemperature => "max_temperature",
            BodyTotal::MaxVonMises => "max_von_mises",
            BodyTotal::MaxPrincipal => "max_principal",
            BodyTotal::HeatIn => "heat_in",
            BodyTotal::HeatStored => "heat_stored",
            BodyTotal::HeatLost => "heat_lost",
            BodyTotal::HeatDrift => "heat_drift",
            BodyTotal::FallbackParticles => "fallback_particles",
        }
    }

    fn description(self) -> &'static str {
        match self {
            BodyTotal::MaxTemperature => "highest temperature of the body",
            BodyTotal::MaxVonMises => "highest von Mises stress of the body",
            BodyTotal::MaxPrincipal => "largest principal stress of the body, tension positive",
            BodyTotal::HeatIn => "heat that loads and prescribed fluxes have brought in",
            BodyTotal::HeatStored => "heat stored since time zero",
            BodyTotal::HeatLost => {
                "heat that has left through convective and prescribed-temperature faces"
            }
            BodyTotal::HeatDrift => {
                "error of the heat balance: heat stored less what came in and was not lost"
            }
            BodyTotal::FallbackParticles => {
                "particles that conduct by the plain operator because the corrected one is near \
                 singular"
            }
        }
    }

    fn quantity(self) -> Quantity {
        match self {
            BodyTotal::MaxTemperature => Quantity::Temperature,
            BodyTotal::MaxVonMises | BodyTotal::MaxPrincipal => Quantity::Stress,
            BodyTotal::FallbackParticles => Quantity::Ratio,
            _ => Quantity::Energy,
        }
    }
}

impl Registry {
    /// Lists the variables of a checked scene: parameters, inputs, outputs.
    pub fn of(scene: &Scene) -> Self {
        let mut list = list(scene);
        if scene.naming == Naming::Flat {
            list.iter_mut().for_each(|variable| variable.name = flat(&variable.name));
        }
        Self::new(list)
    }

    /// The same variables under their structured names, from which one sees what belongs together.
    pub fn structured(scene: &Scene) -> Self {
        Self::new(list(scene))
    }

    fn new(list: Vec<Variable>) -> Self {
        let by_name = list.iter().enumerate().map(|(i, v)| (v.name.clone(), i)).collect();
        Self { variables: list, by_name }
    }

    /// The value reference of a name.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.by_name.get(name).copied()
    }

    /// Value references of all variables of one causality.
    pub fn of_causality(&self, causality: Causality) -> impl Iterator<Item = usize> + '_ {
        (0..self.variables.len()).filter(move |&i| self.variables[i].causality() == causality)
    }

    /// Value references of the inputs that an output follows without delay.
    ///
    /// Heat takes time to move; prescribed temperatures and tractions act at once.
    pub fn dependencies(&self, scene: &Scene, output: &Output) -> Vec<usize> {
        self.inputs_within(scene, &InputLayout::of(scene), Reach::of(scene, output))
    }

    /// Every output with its [`dependencies`](Self::dependencies); outputs that follow the same
    /// inputs share one list.
    pub fn all_dependencies(&self, scene: &Scene) -> Vec<(usize, Rc<[usize]>)> {
        let layout = InputLayout::of(scene);
        let mut lists: BTreeMap<Reach, Rc<[usize]>> = BTreeMap::new();
        let outputs = self.variables.iter().enumerate().filter_map(|(i, variable)| {
            let Slot::Output(output) = &variable.slot else { return None };
            let reach = Reach::of(scene, output);
            let list = lists
                .entry(reach)
                .or_insert_with(|| self.inputs_within(scene, &layout, reach).into());
            Some((i, Rc::clone(list)))
        });
        outputs.collect()
    }

    fn inputs_within(&self, scene: &Scene, layout: &InputLayout, reach: Reach) -> Vec<usize> {
        let direct = direct_inputs(scene, layout, reach);
        self.of_causality(Causality::Input)
            .filter(|&i| matches!(self.variables[i].slot, Slot::Input(at) if direct[at]))
            .collect()
    }
}

fn list(scene: &Scene) -> Vec<Variable> {
    let mut list = Vec::new();
    parameters(scene, &mut list);
    inputs(scene, &mut list);
    outputs(scene, &mut list);
    list
}

/// `a.b[1,2]` as `a_b_1_2`.
pub(super) fn flat(name: &str) -> String {
    name.replace(']', "").replace(['.', '[', ','], "_")
}

/// All that decides which inputs an output follows without delay.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Reach<'a> {
    body: &'a str,
    mechanical: bool,
    /// Summed up over steps or the mean of the last one, so that no input acts at once.
    accumulated: bool,
}

impl<'a> Reach<'a> {
    fn of(scene: &'a Scene, output: &'a Output) -> Self {
        let (body, mechanical, accumulated) = match output {
            Output::Probe { probe, component } => {
                (scene.probe[*probe].body.as_str(), component.needs_mechanics(), false)
            }
            Output::Field { field, component, .. } => {
                (scene.field[*field].body_and_place().0, component.needs_mechanics(), false)
            }
            Output::Body { body, total } => {
                (body.as_str(), BodyTotal::MECHANICAL.contains(total), total.is_accumulated())
            }
            Output::Droplet { body, .. } => (body.as_str(), false, true),
            Output::Wall { wall, .. } => (scene.wall[*wall].under.as_str(), false, true),
        };
        Self { body, mechanical, accumulated }
    }
}

fn direct_inputs(scene: &Scene, layout: &InputLayout, reach: Reach) -> Vec<bool> {
    let mut direct = vec![false; layout.len];
    if reach.accumulated {
        return direct;
    }
    for face in &layout.faces {
        if face.body == reach.body && face.kind == FaceInputKind::Temperature {
            direct[face.index] = true;
        }
    }
    if reach.mechanical {
        for (load, inputs) in scene.load.iter().zip(&layout.loads) {
            if load.body_and_face().0 == reach.body {
                mark_traction(inputs, &mut direct);
            }
        }
    }
    direct
}

fn mark_traction(inputs: &super::LoadInputs, direct: &mut [bool]) {
    let tractions = [&inputs.pressure, &inputs.shear_x, &inputs.shear_y, &inputs.shear_r];
    let mut any = false;
    for range in tractions.into_iter().flatten() {
        direct[range.clone()].fill(true);
        any = true;
    }
    if any {
        for index in [inputs.x, inputs.y, inputs.radius].into_iter().flatten() {
            direct[index] = true;
        }
    }
}

fn parameters(scene: &Scene, list: &mut Vec<Variable>) {
    let mut add = |name: String, description: String, parameter: Parameter, quantity, bounds| {
        let (min, max): layers::Bounds = bounds;
        let start = Some(Value::Real(parameter.get(scene)));
        let slot = Slot::Parameter(parameter);
        list.push(Variable { name, description, slot, quantity: Some(quantity), start, min, max });
    };
    for (body, solid) in scene.solids() {
        if let Some(choice) = &solid.material {
            let given = |constant: &MaterialConstant| constant.is_given(choice.constants());
            for constant in MaterialConstant::ALL.into_iter().filter(given) {
                add(
                    format!("{body}.{}", constant.key()),
                    format!("{} of {body}", constant.description()),
                    Parameter::Material { body: body.to_owned(), constant },
                    constant.quantity(),
                    constant.bounds(),
                );
            }
        }
        layers::parameters((body, solid), &mut add);
        add(
            format!("{body}.initial_temperature"),
            format!("uniform temperature of {body} at time zero, free of thermal stress"),
            Parameter::InitialTemperature { body: body.to_owned() },
            Quantity::Temperature,
            (Some(0.0), None),
        );
        for (&face, _) in solid.faces.iter().filter(|(_, c)| c.convection.is_some()) {
            let name = face_key(face);
            add(
                format!("{body}.{name}.coefficient"),
                format!("heat transfer coefficient of the {name} of {body}"),
                Parameter::ConvectionCoefficient { body: body.to_owned(), face },
                Quantity::HeatTransferCoefficient,
                (Some(0.0), None),
            );
        }
    }
    for (body, fluid) in scene.droplets() {
        droplet::parameters(body, fluid, list);
    }
    list.push(Variable {
        name: "solver.threads".into(),
        description: "threads this unit may use; 0 lets the program choose".into(),
        slot: Slot::Threads,
        quantity: None,
        start: Some(Value::Integer(scene.solver.threads as i32)),
        min: Some(0.0),
        max: Some(1024.0),
    });
    list.push(Variable {
        name: "output.directory".into(),
        description: "folder for the fields as a ParaView time series; nothing is written if empty"
            .into(),
        slot: Slot::OutputDirectory,
        quantity: None,
        start: Some(Value::Text(String::new())),
        min: None,
        max: None,
    });
}

fn inputs(scene: &Scene, list: &mut Vec<Variable>) {
    let layout = InputLayout::of(scene);
    for (load, places) in scene.load.iter().zip(&layout.loads) {
        amounts(load, places, list);
        placement(load, places, list);
    }
    for input in &layout.faces {
        let Some(solid) = scene.solid(&input.body) else { continue };
        list.push(face_variable(&input.body, solid, input.face, input.kind, input.index));
    }
    droplet::inputs(scene, &layout, list);
}

fn amounts(load: &Load, places: &super::LoadInputs, list: &mut Vec<Variable>) {
    let start = &load.start;
    type Kind<'a> = (&'a str, &'a str, Quantity, &'a Option<Range<usize>>, &'a Option<CellValues>);
    let kinds: [Kind; 5] = [
        (
            "heat_flux",
            "heat flux into the body",
            Quantity::HeatFlux,
            &places.heat_flux,
            &start.heat_flux,
        ),
        (
            "pressure",
            "pressure that acts into the body",
            Quantity::Stress,
            &places.pressure,
            &start.pressure,
        ),
        ("shear_x", "shear traction along x", Quantity::Stress, &places.shear_x, &start.shear_x),
        ("shear_y", "shear traction along y", Quantity::Stress, &places.shear_y, &start.shear_y),
        (
            "shear_r",
            "radial shear traction, outward positive",
            Quantity::Stress,
            &places.shear_r,
            &start.shear_r,
        ),
    ];
    for (key, meaning, quantity, range, start) in kinds {
        let Some(range) = range else { continue };
        let cells = cell_labels(load.footprint.cells());
        for (cell, at) in range.clone().enumerate() {
            let (label, place) = &cells[cell];
            list.push(Variable {
                name: format!("{}.{key}{label}", load.name),
                description: format!("{meaning}{place}, {} on {}", load.name, load.on),
                slot: Slot::Input(at),
                quantity: Some(quantity),
                start: Some(Value::Real(cell_start(start.as_ref(), load.footprint.cells(), cell))),
                min: None,
                max: None,
            });
        }
    }
}

fn placement(load: &Load, places: &super::LoadInputs, list: &mut Vec<Variable>) {
    let LoadRange { x, y, radius } = load.range;
    let own_radius = load.footprint.radius().unwrap_or_default();
    let kinds = [
        ("x", "x of the centre", places.x, load.start.x.unwrap_or(0.0), x),
        ("y", "y of the centre", places.y, load.start.y.unwrap_or(0.0), y),
        ("radius", "outer radius", places.radius, load.start.radius.unwrap_or(own_radius), radius),
    ];
    for (key, meaning, at, start, range) in kinds {
        let Some(at) = at else { continue };
        let lowest = if key == "radius" { Some(0.0) } else { None };
        list.push(Variable {
            name: format!("{}.{key}", load.name),
            description: format!("{meaning} of the footprint of {} on {}", load.name, load.on),
            slot: Slot::Input(at),
            quantity: Some(Quantity::Length),
            start: Some(Value::Real(start)),
            min: range.map(|r| r[0]).or(lowest),
            max: range.map(|r| r[1]),
        });
    }
}

/// Index text of each cell in a variable's name, and the words for it.
pub(super) fn cell_labels(cells: Option<CellShape>) -> Vec<(String, String)> {
    match cells {
        None => vec![(String::new(), String::new())],
        Some(CellShape::Rings(count)) => {
            (1..=count).map(|i| (format!("[{i}]"), format!(" on ring {i}"))).collect()
        }
        Some(CellShape::Tiles([nx, ny])) => (1..=nx)
            .flat_map(|i| {
                (1..=ny).map(move |j| (format!("[{i},{j}]"), format!(" on tile {i}, {j}")))
            })
            .collect(),
    }
}

/// The start value of one cell; zero where none is given.
pub(super) fn cell_start(start: Option<&CellValues>, cells: Option<CellShape>, cell: usize) -> f64 {
    match (start, cells) {
        (Some(CellValues::Uniform(value)), _) => *value,
        (Some(CellValues::Rings(values)), _) => values[cell],
        (Some(CellValues::Tiles(rows)), Some(CellShape::Tiles([_, ny]))) => {
            rows[cell / ny][cell % ny]
        }
        _ => 0.0,
    }
}

fn face_variable(
    body: &str,
    solid: &Solid,
    face: FaceName,
    kind: FaceInputKind,
    index: usize,
) -> Variable {
    let condition = solid.faces[&face];
    let name = face_key(face);
    let (key, meaning, quantity, start) = match kind {
        FaceInputKind::Temperature => {
            ("temperature", "prescribed temperature", Quantity::Temperature, condition.temperature)
        }
        FaceInputKind::Ambient => (
            "ambient",
            "ambient temperature",
            Quantity::Temperature,
            condition.convection.map(|c| c.ambient),
        ),
        FaceInputKind::Flux => {
            ("flux", "heat flux into the body", Quantity::HeatFlux, condition.flux)
        }
    };
    Variable {
        name: format!("{body}.{name}.{key}"),
        description: format!("{meaning} at the {name} of {body}"),
        slot: Slot::Input(index),
        quantity: Some(quantity),
        start: start.map(Value::Real),
        min: (quantity == Quantity::Temperature).then_some(0.0),
        max: None,
    }
}

fn outputs(scene: &Scene, list: &mut Vec<Variable>) {
    for (i, probe) in scene.probe.iter().enumerate() {
        probe_variables(i, probe, list);
    }
    for (i, field) in scene.field.iter().enumerate() {
        field_variables(i, field, list);
    }
    for (body, solid) in scene.solids() {
        let mechanical: &[BodyTotal] =
            if scene.asks_mechanics(body) { &BodyTotal::MECHANICAL } else { &[] };
        let particles: &[BodyTotal] =
            if solid.sph().is_some() { &BodyTotal::OF_PARTICLES } else { &[] };
        for &total in BodyTotal::THERMAL.iter().chain(particles).chain(mechanical) {
            list.push(Variable {
                name: format!("{body}.{}", total.key()),
                description: format!("{} ({body})", total.description()),
                slot: Slot::Output(Output::Body { body: body.to_owned(), total }),
                quantity: Some(total.quantity()),
                start: None,
                min: None,
                max: None,
            });
        }
    }
    droplet::outputs(scene, list);
}

fn probe_variables(index: usize, probe: &Probe, list: &mut Vec<Variable>) {
    let [x, y, z] = probe.at;
    for component in components(&probe.gives) {
        list.push(Variable {
            name: format!("{}.{}", probe.name, component.key()),
            description: format!(
                "{} at x = {x} m, y = {y} m, z = {z} m of {}{}",
                component.description(),
                probe.body,
                match probe.side {
                    None => "",
                    Some(Side::Above) => ", above the interface",
                    Some(Side::Below) => ", below the interface",
                }
            ),
            slot: Slot::Output(Output::Probe { probe: index, component }),
            quantity: Some(component.quantity()),
            start: None,
            min: None,
            max: None,
        });
    }
}

fn field_variables(index: usize, field: &Field, list: &mut Vec<Variable>) {
    let place = field.on.as_deref().or(field.body.as_deref()).unwrap_or_default();
    for component in components(&field.gives) {
        for i in 0..field.grid[0] {
            for j in 0..field.grid[1] {
                let cell = [i, j];
                list.push(Variable {
                    name: format!("{}.{}[{},{}]", field.name, component.key(), i + 1, j + 1),
                    description: format!(
                        "{} at point {}, {} of the grid on {place}",
                        component.description(),
                        i + 1,
                        j + 1
                    ),
                    slot: Slot::Output(Output::Field { field: index, component, cell }),
                    quantity: Some(component.quantity()),
                    start: None,
                    min: None,
                    max: None,
                });
            }
        }
    }
}

/// The scalars that a list of wishes stands for, each once, in a fixed order.
fn components(gives: &[Gives]) -> Vec<Component> {
    let stress = gives.contains(&Gives::Stress);
    let mut list = Vec::new();
    if gives.contains(&Gives::Temperature) {
        list.push(Component::Temperature);
    }
    if stress {
        list.extend((0..6).map(Component::Stress));
    }
    if stress || gives.contains(&Gives::VonMises) {
        list.push(Component::VonMises);
    }
    if gives.contains(&Gives::MaxPrincipal) {
        list.push(Component::MaxPrincipal);
    }
    if gives.contains(&Gives::Displacement) {
        list.extend((0..3).map(Component::Displacement));
    }
    list
}

fn face_key(face: FaceName) -> &'static str {
    match face {
        FaceName::Top => "top",
        FaceName::Bottom => "bottom",
        FaceName::Sides => "sides",
        FaceName::Left => "left",
        FaceName::Right => "right",
        FaceName::Front => "front",
        FaceName::Back => "back",
    }
}
