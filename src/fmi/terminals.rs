//! terminalsAndIcons.xml: groups of variables and their positions on the unit's icon; FMI 3.0, section 2.4.9, also
//! allowed in units of FMI 2.0.
//!
//! Every load, wall, probe, field, flaw and body is a terminal of its inputs and outputs.

use std::collections::HashMap;
use std::io;

use super::description::{Attributes, Xml, document, leaf, parent};
use crate::scene::{Field, Flaw, Probe, Scene, Wall};
use crate::variables::{ArrayRegistry, ArrayVariable, Causality, Registry};

/// Folder of the file and of the icons.
pub const FOLDER: &str = "terminalsAndIcons";

/// Half extents of the unit's icon, 4 : 3, in its own coordinates, and their scale to millimetres.
const HALF: [f64; 2] = [100.0, 75.0];
const MILLIMETRES: f64 = 0.1;
/// Largest side of a terminal's icon in these coordinates.
const LARGEST: f64 = 16.0;
/// Colour of connections, red, green and blue.
const COLOUR: &str = "196 46 28";

/// A variable as a part of a terminal.
#[derive(Debug, Clone, PartialEq)]
pub struct Member {
    pub variable: String,
    pub terminal: String,
    /// Name within the terminal; terminals with equal members are compatible.
    pub name: String,
    pub causality: Causality,
}

/// Direction of the flow through a terminal, which determines its icon.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    In,
    Out,
    Exchange,
}

impl Member {
    /// Creates a member from a variable's name and structured name; `None` for a parameter.
    pub fn of(variable: &str, structured: &str, causality: Causality) -> Option<Self> {
        let (terminal, name) = structured.split_once('.')?;
        (causality != Causality::Parameter).then(|| Self {
            variable: variable.to_owned(),
            terminal: terminal.to_owned(),
            name: name.to_owned(),
            causality,
        })
    }

    /// Returns all members of a unit of FMI 3.0, with arrays as variables where possible.
    pub fn arrays(scene: &Scene) -> Vec<Self> {
        let registry = Registry::of(scene);
        let (arrays, structured) = (ArrayRegistry::of(scene), ArrayRegistry::structured(scene));
        let pairs = arrays.variables.iter().zip(&structured.variables);
        let member = |(own, named): (&ArrayVariable, &ArrayVariable)| {
            Self::of(&own.name, &named.name, own.causality(&registry)?)
        };
        pairs.filter_map(member).collect()
    }

    /// All members of a unit whose variables are scalars.
    pub fn all(scene: &Scene) -> Vec<Self> {
        let (registry, structured) = (Registry::of(scene), Registry::structured(scene));
        let pairs = registry.variables.iter().zip(&structured.variables);
        pairs.filter_map(|(own, named)| Self::of(&own.name, &named.name, own.causality())).collect()
    }
}

impl Direction {
    pub const ALL: [Direction; 3] = [Direction::In, Direction::Out, Direction::Exchange];

    /// Name of the icon's file, without its ending.
    pub fn icon(self) -> &'static str {
        match self {
            Direction::In => "terminal_in",
            Direction::Out => "terminal_out",
            Direction::Exchange => "terminal_exchange",
        }
    }

    fn of(members: &[&Member]) -> Self {
        let has = |causality| members.iter().any(|member| member.causality == causality);
        match (has(Causality::Input), has(Causality::Output)) {
            (true, true) => Direction::Exchange,
            (true, false) => Direction::In,
            _ => Direction::Out,
        }
    }
}

/// Returns the file for the members of a scene's unit.
pub fn terminals_and_icons(scene: &Scene, members: &[Member]) -> String {
    let terminals = group(members);
    document("fmiTerminalsAndIcons", &[("fmiVersion", "3.0".into())], |xml| {
        contents(xml, scene, &terminals)
    })
}

struct Terminal<'a> {
    name: &'a str,
    members: Vec<&'a Member>,
}

/// Groups members to terminals in the order of their first members.
fn group(members: &[Member]) -> Vec<Terminal<'_>> {
    let mut terminals: Vec<Terminal> = Vec::new();
    let mut places: HashMap<&str, usize> = HashMap::new();
    for member in members {
        let place = *places.entry(&member.terminal).or_insert_with(|| {
            terminals.push(Terminal { name: &member.terminal, members: Vec::new() });
            terminals.len() - 1
        });
        terminals[place].members.push(member);
    }
    terminals
}

fn contents(xml: &mut Xml, scene: &Scene, terminals: &[Terminal]) -> io::Result<()> {
    parent(xml, "GraphicalRepresentation", &[], |xml| {
        let whole = extent([-HALF[0], -HALF[1]], HALF);
        let scale = [("suggestedScalingFactorTo_mm", format!("{MILLIMETRES:?}"))];
        leaf(xml, "CoordinateSystem", &[&whole[..], &scale].concat())?;
        leaf(xml, "Icon", &whole)
    })?;
    if terminals.is_empty() {
        return Ok(());
    }
    let places = places(terminals);
    let described = descriptions(scene);
    parent(xml, "Terminals", &[], |xml| {
        let mut both = terminals.iter().zip(&places);
        both.try_for_each(|(terminal, place)| element(xml, &described, terminal, place))
    })
}

fn element(
    xml: &mut Xml,
    described: &HashMap<&str, String>,
    terminal: &Terminal,
    place: &Attributes,
) -> io::Result<()> {
    let attributes: Attributes = vec![
        ("name", terminal.name.to_owned()),
        ("matchingRule", "plug".into()),
        ("description", description(described, terminal.name)),
    ];
    parent(xml, "Terminal", &attributes, |xml| {
        for member in &terminal.members {
            let attributes: Attributes = vec![
                ("variableName", member.variable.clone()),
                ("memberName", member.name.clone()),
                ("variableKind", "signal".into()),
            ];
            leaf(xml, "TerminalMemberVariable", &attributes)?;
        }
        let look: Attributes = vec![
            ("defaultConnectionColor", COLOUR.into()),
            ("defaultConnectionStrokeSize", "1.0".into()),
        ];
        let icon = [("iconBaseName", Direction::of(&terminal.members).icon().to_owned())];
        leaf(xml, "TerminalGraphicalRepresentation", &[&look[..], place, &icon].concat())
    })
}

/// Positions of the terminals' icons: terminals with inputs on the left edge, the others on the right, from top to
/// bottom.
fn places(terminals: &[Terminal]) -> Vec<Attributes> {
    let is_left = |terminal: &Terminal| Direction::of(&terminal.members) != Direction::Out;
    let left = terminals.iter().filter(|terminal| is_left(terminal)).count();
    let mut above = [0.0, 0.0];
    let place = |terminal: &Terminal| {
        let right = usize::from(!is_left(terminal));
        let count = if right == 1 { terminals.len() - left } else { left } as f64;
        let pitch = 2.0 * HALF[1] / count;
        let y = HALF[1] - (above[right] + 0.5) * pitch;
        above[right] += 1.0;
        let x = if right == 1 { HALF[0] } else { -HALF[0] };
        let half = 0.5 * LARGEST.min(0.8 * pitch);
        extent([x - half, y - half], [x + half, y + half]).to_vec()
    };
    terminals.iter().map(place).collect()
}

fn extent(low: [f64; 2], high: [f64; 2]) -> [(&'static str, String); 4] {
    let number = |value: f64| format!("{value:?}");
    [
        ("x1", number(low[0])),
        ("y1", number(low[1])),
        ("x2", number(high[0])),
        ("y2", number(high[1])),
    ]
}

/// Descriptions of the terminals of loads, probes, walls, fields and flaws by name, which are unique.
fn descriptions(scene: &Scene) -> HashMap<&str, String> {
    let loads = scene.load.iter().map(|load| (load.name.as_str(), format!("load on {}", load.on)));
    let of_probe = |probe: &Probe| format!("values at a point of {}", probe.body);
    let probes = scene.probe.iter().map(|probe| (probe.name.as_str(), of_probe(probe)));
    let of_wall = |wall: &Wall| format!("wall under {}", wall.under);
    let walls = scene.wall.iter().map(|wall| (wall.name.as_str(), of_wall(wall)));
    let of_field = |field: &Field| match field.footprint {
        Some(_) => format!("means over cells of {}", field.body_and_place().0),
        None => format!("values on a grid of {}", field.body_and_place().0),
    };
    let fields = scene.field.iter().map(|field| (field.name.as_str(), of_field(field)));
    let of_flaw = |flaw: &Flaw| format!("flaw in {}", flaw.body);
    let flaws = scene.flaw.iter().map(|flaw| (flaw.name.as_str(), of_flaw(flaw)));
    loads.chain(probes).chain(walls).chain(fields).chain(flaws).collect()
}

/// Description of the terminal of a name; terminals that no table describes are bodies.
fn description(described: &HashMap<&str, String>, name: &str) -> String {
    let own = described.get(name).cloned();
    own.unwrap_or_else(|| format!("what {name} is given and shows as a whole"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{self, Naming};

    const SCENE: &str = include_str!("../../tests/fmi/scene.toml");

    #[test]
    fn every_input_and_output_stands_in_one_terminal() {
        let scene = scene::parse(SCENE, "scene.toml").unwrap();
        let members = Member::all(&scene);
        let xml = terminals_and_icons(&scene, &members);
        for variable in Registry::of(&scene).variables {
            let count = xml.matches(&format!(" variableName=\"{}\" ", variable.name)).count();
            let wanted = usize::from(variable.causality() != Causality::Parameter);
            assert_eq!(count, wanted, "{}", variable.name);
        }
        let names: Vec<&str> = group(&members).iter().map(|terminal| terminal.name).collect();
        assert_eq!(names, ["spot", "patch", "plate", "centre", "surface"]);
    }

    #[test]
    fn arrays_are_members_as_a_whole() {
        let mut scene = scene::parse(SCENE, "scene.toml").unwrap();
        for (naming, variable) in
            [(Naming::Structured, "patch.heat_flux"), (Naming::Flat, "patch_heat_flux")]
        {
            scene.naming = naming;
            let members = Member::arrays(&scene);
            let flux = Member::of(variable, "patch.heat_flux", Causality::Input).unwrap();
            assert_eq!(members.iter().filter(|member| **member == flux).count(), 1);
            assert!(members.iter().all(|member| !member.name.contains('[')));
            let [arrays, all] = [&members, &Member::all(&scene)].map(|members| {
                group(members).iter().map(|terminal| terminal.name.to_owned()).collect::<Vec<_>>()
            });
            assert_eq!(arrays, all);
        }
    }

    #[test]
    fn icons_stand_on_the_edges_and_do_not_overlap() {
        let scene = scene::parse(SCENE, "scene.toml").unwrap();
        let members = Member::all(&scene);
        let places = places(&group(&members));
        let numbers = |place: &Attributes| -> Vec<f64> {
            place.iter().map(|(_, value)| value.parse().unwrap()).collect()
        };
        let boxes: Vec<Vec<f64>> = places.iter().map(numbers).collect();
        for (i, a) in boxes.iter().enumerate() {
            assert_eq!((0.5 * (a[0] + a[2])).abs(), HALF[0]);
            assert!(a[1] >= -HALF[1] && a[3] <= HALF[1]);
            let apart = |b: &Vec<f64>| a[2] < b[0] || b[2] < a[0] || a[3] <= b[1] || b[3] <= a[1];
            assert!(boxes[..i].iter().all(apart), "{boxes:?}");
        }
    }
}
