use impinge::variables::{Causality, Registry};

/// A variable, or all elements of an array under one name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Folded {
    /// Name with the highest indices: `surface.temperature[16,16]`.
    pub name: String,
    /// Value references of the elements.
    pub elements: Vec<usize>,
}

/// Name of an array that `name` is an element of; a scalar's own name.
pub fn array_name(name: &str) -> &str {
    name.split_once('[').map_or(name, |(array, _)| array)
}

/// The variables of one causality, in the registry's order, arrays folded; `structured` has the names
/// that tell which variables are an array.
pub fn folded(registry: &Registry, structured: &Registry, causality: Causality) -> Vec<Folded> {
    let mut list: Vec<Folded> = Vec::new();
    let array = |reference: usize| array_name(&structured.variables[reference].name);
    for reference in registry.of_causality(causality) {
        let name = &registry.variables[reference].name;
        match list.last_mut().filter(|last| array(last.elements[0]) == array(reference)) {
            Some(last) => {
                last.name.clone_from(name);
                last.elements.push(reference);
            }
            None => list.push(Folded { name: name.clone(), elements: vec![reference] }),
        }
    }
    list
}
