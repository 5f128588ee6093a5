//! The registry with families of variables as arrays, as FMI 3.0 lists them.

use std::collections::HashMap;
use std::ops::Range;
use std::rc::Rc;

use super::registry::flat;
use super::{Causality, CellFamily, Quantity, Registry, Slot, Variable};
use crate::scene::{Grid, Naming, Sampling, Scene};

/// All variables of a scene's unit, with arrays as variables. Time comes first, then those of the [`Registry`] in their
/// order, with each family `name[i]` or `name[i,j]` of structured names as one variable, then the positions of the
/// points and cells of families. The value reference of a variable is its place in the list.
#[derive(Debug, Clone, PartialEq)]
pub struct ArrayRegistry {
    pub variables: Vec<ArrayVariable>,
}

/// A scalar or an array.
#[derive(Debug, Clone, PartialEq)]
pub struct ArrayVariable {
    pub name: String,
    pub description: String,
    /// Number of elements along each index, the last running fastest; none of a scalar.
    pub dimensions: Vec<usize>,
    pub content: Content,
}

/// Source of the values.
#[derive(Debug, Clone, PartialEq)]
pub enum Content {
    /// The time of the unit [s].
    Time,
    /// Elements by their places in the [`Registry`].
    Elements(Range<usize>),
    /// Lengths and areas that follow from the scene.
    Constants(Quantity, Vec<f64>),
}

const AXES: [&str; 3] = ["x", "y", "z"];
const INDICES: [&str; 2] = ["i", "j"];

impl ArrayRegistry {
    /// Lists the variables of a checked scene.
    pub fn of(scene: &Scene) -> Self {
        let mut arrays = Self::structured(scene);
        if scene.naming == Naming::Flat {
            arrays.variables.iter_mut().for_each(|variable| variable.name = flat(&variable.name));
        }
        arrays
    }

    /// The same variables under their structured names.
    pub fn structured(scene: &Scene) -> Self {
        let registry = Registry::structured(scene);
        let time = ArrayVariable {
            name: "time".into(),
            description: "time".into(),
            dimensions: Vec::new(),
            content: Content::Time,
        };
        let mut variables = vec![time];
        let mut next = 0;
        while next < registry.variables.len() {
            let members = family(&registry, next);
            next = members.end;
            variables.push(array(&registry.variables, members));
        }
        constants(scene, &mut variables);
        Self { variables }
    }

    /// Value references of the inputs that an output follows without delay: every element of the output follows every
    /// element of these inputs.
    pub fn dependencies(
        &self,
        scene: &Scene,
        registry: &Registry,
        output: &ArrayVariable,
    ) -> Vec<usize> {
        let elements = output.elements(registry);
        let Some(Slot::Output(first)) = elements.first().map(|element| &element.slot) else {
            return Vec::new();
        };
        self.arrays_of(&registry.dependencies(scene, first))
    }

    /// Every output with its [`dependencies`](Self::dependencies); outputs that follow the same inputs share one list.
    pub fn all_dependencies(
        &self,
        scene: &Scene,
        registry: &Registry,
    ) -> Vec<(usize, Rc<[usize]>)> {
        let of_elements: HashMap<usize, Rc<[usize]>> =
            registry.all_dependencies(scene).into_iter().collect();
        let mut lists: HashMap<*const usize, Rc<[usize]>> = HashMap::new();
        let outputs = self.variables.iter().enumerate().filter_map(|(reference, variable)| {
            let Content::Elements(range) = &variable.content else { return None };
            let inputs = of_elements.get(&range.start)?;
            let list = lists.entry(inputs.as_ptr());
            Some((reference, Rc::clone(list.or_insert_with(|| self.arrays_of(inputs).into()))))
        });
        outputs.collect()
    }

    /// Value references of the arrays that inputs, ascending, are elements of.
    fn arrays_of(&self, inputs: &[usize]) -> Vec<usize> {
        let mut rest = inputs;
        let mut found = Vec::new();
        for (reference, variable) in self.variables.iter().enumerate() {
            let Content::Elements(range) = &variable.content else { continue };
            let count = rest.iter().take_while(|input| range.contains(input)).count();
            if count > 0 {
                found.push(reference);
                rest = &rest[count..];
            }
        }
        found
    }

    /// The value reference of a name.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.variables.iter().position(|variable| variable.name == name)
    }
}

impl ArrayVariable {
    /// Number of elements.
    pub fn size(&self) -> usize {
        self.dimensions.iter().product()
    }

    /// The elements' variables; none if they are in no [`Registry`].
    pub fn elements<'a>(&self, registry: &'a Registry) -> &'a [Variable] {
        match &self.content {
            Content::Elements(range) => &registry.variables[range.clone()],
            Content::Time | Content::Constants(..) => &[],
        }
    }

    /// Quantity of the values; `None` for texts and counts.
    pub fn quantity(&self, registry: &Registry) -> Option<Quantity> {
        match self.content {
            Content::Time => Some(Quantity::Time),
            Content::Constants(quantity, _) => Some(quantity),
            Content::Elements(_) => self.elements(registry)[0].quantity,
        }
    }

    /// Causality of all elements; `None` for time and constants.
    pub fn causality(&self, registry: &Registry) -> Option<Causality> {
        self.elements(registry).first().map(Variable::causality)
    }
}

/// Places of the variable at `first` and of those after it whose names differ only in indices.
fn family(registry: &Registry, first: usize) -> Range<usize> {
    let variables = &registry.variables[first..];
    let Some((stem, _)) = indexed(&variables[0].name) else { return first..first + 1 };
    let has_stem = |variable: &&Variable| indexed(&variable.name).is_some_and(|n| n.0 == stem);
    first..first + variables.iter().take_while(has_stem).count()
}

/// Stem and indices, `3,4]`, of a name that ends with indices; those inside a name are part of it.
fn indexed(name: &str) -> Option<(&str, &str)> {
    if name.ends_with(']') { name.rsplit_once('[') } else { None }
}

fn array(variables: &[Variable], members: Range<usize>) -> ArrayVariable {
    let (first, last) = (&variables[members.start], &variables[members.end - 1]);
    let (name, dimensions) = match indexed(&last.name) {
        None => (first.name.clone(), Vec::new()),
        Some((stem, indices)) => (stem.to_owned(), counts(indices)),
    };
    let description = common_words(&first.description, &last.description, &dimensions);
    ArrayVariable { name, description, dimensions, content: Content::Elements(members) }
}

/// Counts along the indices from those of the last element, `3,4]`.
fn counts(indices: &str) -> Vec<usize> {
    let numbers = indices.trim_end_matches(']').split(',');
    numbers.map(|number| number.parse().expect("indices of variables are numbers")).collect()
}

/// Common words of first and last element, with letters for the indices in which they differ.
fn common_words(first: &str, last: &str, dimensions: &[usize]) -> String {
    let longer_than_one = INDICES.iter().zip(dimensions).filter(|(_, count)| **count > 1);
    let mut letters = longer_than_one.map(|(letter, _)| *letter);
    let word = |(a, b): (&str, &str)| {
        if a == b {
            return a.to_owned();
        }
        let tail = a.trim_start_matches(|c: char| c.is_ascii_digit());
        letters.next().unwrap_or("…").to_owned() + tail
    };
    first.split(' ').zip(last.split(' ')).map(word).collect::<Vec<_>>().join(" ")
}

/// Coordinates of the points of fields on grids, one list for each index and the constant one, and areas and positions
/// of cells.
fn constants(scene: &Scene, list: &mut Vec<ArrayVariable>) {
    for field in &scene.field {
        if let Some(Sampling::Points(grid)) = scene.sampling(field) {
            coordinates(&field.name, &grid, list);
        }
    }
    let families = CellFamily::places(scene);
    families
        .iter()
        .filter(|family| family.footprint != "grid")
        .for_each(|family| cells(family, list));
}

fn coordinates(field: &str, grid: &Grid, list: &mut Vec<ArrayVariable>) {
    for (axis, name) in AXES.iter().enumerate() {
        let index = grid.axes.iter().position(|along| *along == axis);
        let point = |i| if index == Some(1) { grid.point(0, i) } else { grid.point(i, 0) };
        let count = index.map_or(1, |index| grid.count[index]);
        let along = match index {
            Some(index) => format!("along index {}", INDICES[index]),
            None => "of all points".into(),
        };
        let values = (0..count).map(|i| point(i)[axis]).collect();
        list.push(ArrayVariable {
            name: format!("{field}.{name}"),
            description: format!("{name} {along} of {field}"),
            dimensions: index.map(|_| count).into_iter().collect(),
            content: Content::Constants(Quantity::Length, values),
        });
    }
}

fn cells(family: &CellFamily, list: &mut Vec<ArrayVariable>) {
    let CellFamily { name, count, area, inner, outer, x, y, .. } = family;
    let at_start = if family.kind == "load" { ", at the start" } else { "" };
    for (key, words, quantity, values) in [
        ("cell_area", "what the value 1 per area brings on each cell", Quantity::Area, area),
        ("cell_inner", "inner radius of each cell", Quantity::Length, inner),
        ("cell_outer", "outer radius of each cell", Quantity::Length, outer),
        ("cell_x", "x of the middle of each cell", Quantity::Length, x),
        ("cell_y", "y of the middle of each cell", Quantity::Length, y),
    ] {
        if values.is_empty() {
            continue;
        }
        list.push(ArrayVariable {
            name: format!("{name}.{key}"),
            description: format!("{words} of {name}{at_start}"),
            dimensions: count.clone(),
            content: Content::Constants(quantity, values.clone()),
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = include_str!("../../tests/fmi/scene.toml");

    fn registries(text: &str) -> (Registry, ArrayRegistry) {
        let scene = crate::scene::parse(text, "scene.toml").unwrap();
        let registry = Registry::of(&scene);
        let arrays = ArrayRegistry::of(&scene);
        (registry, arrays)
    }

    #[test]
    fn families_are_arrays_whose_last_index_runs_fastest() {
        let (registry, arrays) = registries(SCENE);
        let flux = &arrays.variables[arrays.find("patch.heat_flux").unwrap()];
        assert_eq!(flux.dimensions, [2, 3]);
        assert_eq!(flux.description, "heat flux into the body on tile i, j, patch on plate.top");
        let names: Vec<&str> = flux.elements(&registry).iter().map(|v| v.name.as_str()).collect();
        assert_eq!(names[1], "patch.heat_flux[1,2]");
        assert_eq!(names[3], "patch.heat_flux[2,1]");
        let spot = &arrays.variables[arrays.find("spot.heat_flux").unwrap()];
        assert_eq!((spot.dimensions.len(), spot.size()), (0, 1));
    }

    #[test]
    fn every_element_is_in_one_array_as_large_as_its_dimensions() {
        let droplet = include_str!("../../examples/droplet_unit/scene.toml");
        for text in [SCENE, droplet] {
            let (registry, arrays) = registries(text);
            let mut next = 0;
            for variable in &arrays.variables {
                if let Content::Elements(range) = &variable.content {
                    assert_eq!((range.start, range.len()), (next, variable.size()));
                    next = range.end;
                }
            }
            assert_eq!(next, registry.variables.len());
            let named = arrays.variables.iter().map(|variable| variable.name.as_str());
            let unique: std::collections::BTreeSet<&str> = named.collect();
            assert_eq!(unique.len(), arrays.variables.len());
        }
    }

    #[test]
    fn flat_names_make_the_same_arrays() {
        let (_, structured) = registries(SCENE);
        let (registry, arrays) = registries(&format!("naming = \"flat\"\n{SCENE}"));
        assert_eq!(arrays.variables.len(), structured.variables.len());
        for (own, named) in arrays.variables.iter().zip(&structured.variables) {
            assert_eq!(own.name, named.name.replace('.', "_"));
            assert_eq!((&own.dimensions, &own.content), (&named.dimensions, &named.content));
        }
        let flux = &arrays.variables[arrays.find("patch_heat_flux").unwrap()];
        assert_eq!(flux.elements(&registry)[1].name, "patch_heat_flux_1_2");
        assert!(arrays.find("surface_x").is_some());
    }

    #[test]
    fn coordinates_are_those_of_the_points() {
        let (_, arrays) = registries(SCENE);
        let find = |name| &arrays.variables[arrays.find(name).unwrap()];
        let (x, z) = (find("surface.x"), find("surface.z"));
        let Content::Constants(_, values) = &x.content else { panic!("{x:?}") };
        assert_eq!(x.dimensions, [4]);
        for (value, expected) in values.iter().zip([-1.5e-4, -0.5e-4, 0.5e-4, 1.5e-4]) {
            assert!((value - expected).abs() < 1e-18, "{values:?}");
        }
        assert_eq!(
            (z.dimensions.len(), &z.content),
            (0, &Content::Constants(Quantity::Length, vec![0.0]))
        );
    }

    #[test]
    fn one_row_arrays_keep_the_order_of_index_letters() {
        assert_eq!(common_words("at 1, 1 of", "at 1, 9 of", &[1, 9]), "at 1, j of");
        assert_eq!(common_words("on ring 1, spot", "on ring 24, spot", &[24]), "on ring i, spot");
    }
}
