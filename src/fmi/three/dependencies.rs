//! FMI functions that tell which inputs an output follows at once, section 2.2 of the standard.
//!
//! Every element of an output array follows every element of the input arrays that it follows at all, so
//! a dependency is told once for whole arrays: element index 0 stands for all elements.

use super::legality::Fmi3;
use super::types::{DEPENDENT, DependencyKind, Handle, Reference};
use super::values::variable;
use crate::fmi::instance::{call, write};
use crate::fmi::types::{Answer, Refusal, Status};
use crate::fmi::unit::Unit;
use crate::variables::Causality;

/// # Safety
/// Pointers are null or as the standard asks.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetNumberOfVariableDependencies(
    instance: Handle,
    value_reference: Reference,
    dependency_count: *mut usize,
) -> Status {
    // SAFETY: by contract.
    unsafe {
        call(instance, Fmi3::GetNumberOfVariableDependencies, |unit| {
            write(dependency_count, &[inputs_of(unit, value_reference)?.len()], "nDependencies")
        })
    }
}

/// # Safety
/// Pointers are null or as the standard asks.
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
    // SAFETY: by contract.
    unsafe {
        call(instance, Fmi3::GetVariableDependencies, |unit| {
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
}

/// Value references of the inputs that an output follows at once.
fn inputs_of(unit: &Unit, output: Reference) -> Answer<Vec<Reference>> {
    let arrays = unit.arrays();
    let found = variable(&arrays, output)?;
    if found.causality(&unit.registry) != Some(Causality::Output) {
        return Err(Refusal::error(format!("{} is no output", found.name)));
    }
    let inputs = arrays.dependencies(&unit.packed, &unit.registry, found);
    Ok(inputs.into_iter().map(|input| input as Reference).collect())
}
