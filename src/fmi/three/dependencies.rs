//! FMI functions for the inputs that an output follows without delay, section 2.2 of the standard.
//!
//! Every element of an output array follows either every element or no element of an input array. A dependency is
//! therefore reported once for whole arrays: element index 0 represents all elements.

use super::table::Fmi3;
use super::types::{DEPENDENT, DependencyKind, Handle, Reference};
use crate::fmi::gate::answer::{Answer, Refusal, Status};
use crate::fmi::gate::arguments::write;
use crate::fmi::gate::gated;
use crate::fmi::unit::{Unit, array_variable};
use crate::variables::Causality;

/// Returns the number of inputs that an output follows without delay.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetNumberOfVariableDependencies(
    instance: Handle,
    value_reference: Reference,
    dependency_count: *mut usize,
) -> Status {
    gated!(instance, Fmi3::fmi3GetNumberOfVariableDependencies, |unit| {
        write(dependency_count, &[inputs_of(unit, value_reference)?.len()], "nDependencies")
    })
}

/// Lists the inputs that an output follows without delay.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetVariableDependencies(
    instance: Handle,
    dependent: Reference,
    element_indices_of_dependent: *mut usize,
    independents: *mut Reference,
    element_indices_of_independents: *mut usize,
    dependency_kinds: *mut DependencyKind,
    dependency_count: usize,
) -> Status {
    gated!(instance, Fmi3::fmi3GetVariableDependencies, |unit| {
        let inputs = inputs_of(unit, dependent)?;
        let count = inputs.len();
        if count != dependency_count {
            let message = format!("nDependencies is {dependency_count}; there are {count}");
            return Err(Refusal::error(message));
        }
        let all = vec![0; count];
        write(element_indices_of_dependent, &all, "elementIndicesOfDependent")?;
        write(independents, &inputs, "independents")?;
        write(element_indices_of_independents, &all, "elementIndicesOfIndependents")?;
        write(dependency_kinds, &vec![DEPENDENT; count], "dependencyKinds")
    })
}

/// Value references of the inputs that an output follows without delay.
fn inputs_of(unit: &Unit, output: Reference) -> Answer<Vec<Reference>> {
    let arrays = unit.arrays();
    let found = array_variable(&arrays, output)?;
    if found.causality(&unit.registry) != Some(Causality::Output) {
        return Err(Refusal::error(format!("{} is no output", found.name)));
    }
    let inputs = arrays.dependencies(&unit.packed, &unit.registry, found);
    Ok(inputs.into_iter().map(|input| input as Reference).collect())
}
