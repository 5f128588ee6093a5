//! Gets and sets variables by reference, with families of scalars as arrays, in safe Rust.
//!
//! A set is all or nothing, as in [`super::values`], which processes the scalars.

use std::ffi::CString;
use std::ops::Range;
use std::sync::Arc;

use super::Unit;
use super::kind::{Kind, look_up, wrong_type};
use crate::fmi::gate::answer::{Answer, Reference, Refusal};
use crate::fmi::table::Phase;
use crate::variables::{ArrayRegistry, ArrayVariable, Causality, Content};

impl Unit {
    /// Returns the variables as numbered in FMI 3.0.
    pub fn arrays(&self) -> Arc<ArrayRegistry> {
        let list = || Arc::new(ArrayRegistry::of(&self.packed));
        Arc::clone(self.arrays.get_or_init(list))
    }

    /// Returns values of variables, `count` in total.
    pub fn floats(&mut self, references: &[Reference], count: usize) -> Answer<Vec<f64>> {
        let arrays = self.arrays();
        let variables = self.of_kind(&arrays, references, Kind::Real)?;
        check_count(&variables, count)?;
        variables.iter().try_for_each(|variable| self.check_known(variable))?;
        let ranges = variables.iter().filter_map(|variable| match &variable.content {
            Content::Elements(range) => Some(range),
            Content::Time | Content::Constants(..) => None,
        });
        let elements: Vec<Reference> = ranges.flat_map(places).collect();
        // All at once, so that inputs are checked once for all outputs.
        let mut found = self.reals(&elements)?.into_iter();
        let mut values = Vec::with_capacity(count);
        for variable in variables {
            match &variable.content {
                Content::Time => values.push(self.time()),
                Content::Constants(_, constants) => values.extend(constants),
                Content::Elements(range) => values.extend(found.by_ref().take(range.len())),
            }
        }
        Ok(values)
    }

    /// Sets elements of Float64 variables, all or none.
    pub fn set_floats(&mut self, references: &[Reference], values: &[f64]) -> Answer {
        let elements = self.settable(references, Kind::Real, values.len())?;
        self.set_reals(&elements, values)
    }

    /// Returns values of Int32 variables, `count` in total.
    pub fn whole_numbers(&mut self, references: &[Reference], count: usize) -> Answer<Vec<i32>> {
        let elements = self.settable(references, Kind::Integer, count)?;
        self.integers(&elements)
    }

    /// Sets Int32 variables, all or none.
    pub fn set_whole_numbers(&mut self, references: &[Reference], values: &[i32]) -> Answer {
        let elements = self.settable(references, Kind::Integer, values.len())?;
        self.set_integers(&elements, values)
    }

    /// Returns texts, which the unit keeps until the next call.
    pub fn strings(&mut self, references: &[Reference], count: usize) -> Answer<&[CString]> {
        let elements = self.settable(references, Kind::Text, count)?;
        self.texts(&elements)
    }

    /// Sets String variables, all or none.
    pub fn set_strings(&mut self, references: &[Reference], values: Vec<String>) -> Answer {
        let elements = self.settable(references, Kind::Text, values.len())?;
        self.set_texts(&elements, values)
    }

    /// Returns the refusal of a variable whose type is not that of a function, or of an unknown reference.
    pub fn array_of_another_type(&self, reference: Reference, wanted: &str) -> Refusal {
        match array_variable(&self.arrays(), reference) {
            Ok(variable) => wrong_type(&variable.name, wanted, self.kind(variable).of_arrays()),
            Err(unknown) => unknown,
        }
    }

    /// Returns the places of the elements of variables that have elements, in sequence.
    pub fn elements(
        &self,
        arrays: &ArrayRegistry,
        references: &[Reference],
    ) -> Answer<Vec<Reference>> {
        let mut elements = Vec::new();
        for variable in self.of_kind(arrays, references, Kind::Real)? {
            elements.extend(places(range(variable)?));
        }
        Ok(elements)
    }

    /// Returns the places of the elements of variables that are not constants, `count` in total.
    fn settable(
        &self,
        references: &[Reference],
        kind: Kind,
        count: usize,
    ) -> Answer<Vec<Reference>> {
        let arrays = self.arrays();
        let variables = self.of_kind(&arrays, references, kind)?;
        check_count(&variables, count)?;
        let mut elements = Vec::with_capacity(count);
        for variable in variables {
            elements.extend(places(range(variable)?));
        }
        Ok(elements)
    }

    fn of_kind<'a>(
        &self,
        arrays: &'a ArrayRegistry,
        references: &[Reference],
        wanted: Kind,
    ) -> Answer<Vec<&'a ArrayVariable>> {
        let of_kind = |&reference: &Reference| {
            let variable = array_variable(arrays, reference)?;
            let kind = self.kind(variable);
            if kind == wanted {
                return Ok(variable);
            }
            Err(wrong_type(&variable.name, wanted.of_arrays(), kind.of_arrays()))
        };
        references.iter().map(of_kind).collect()
    }

    fn kind(&self, variable: &ArrayVariable) -> Kind {
        let element = variable.elements(&self.registry).first();
        element.map_or(Kind::Real, |element| Kind::of(&element.slot))
    }

    /// Before initialization only start values are known.
    fn check_known(&self, variable: &ArrayVariable) -> Answer<()> {
        let is_output = variable.causality(&self.registry) == Some(Causality::Output);
        if is_output && self.phase == Phase::Instantiated {
            let message = format!("{} has no value before Initialization Mode", variable.name);
            return Err(Refusal::error(message));
        }
        Ok(())
    }
}

/// The variable of a reference under FMI 3.0.
pub fn array_variable(arrays: &ArrayRegistry, reference: Reference) -> Answer<&ArrayVariable> {
    look_up(&arrays.variables, reference)
}

fn range(variable: &ArrayVariable) -> Answer<&Range<usize>> {
    match &variable.content {
        Content::Elements(range) => Ok(range),
        Content::Time => Err(Refusal::error(format!("{} passes by steps alone", variable.name))),
        Content::Constants(..) => Err(Refusal::error(format!("{} is constant", variable.name))),
    }
}

fn places(range: &Range<usize>) -> Vec<Reference> {
    range.clone().map(|place| place as Reference).collect()
}

fn check_count(variables: &[&ArrayVariable], count: usize) -> Answer<()> {
    let size: usize = variables.iter().map(|variable| variable.size()).sum();
    if size == count {
        return Ok(());
    }
    Err(Refusal::error(format!("nValues is {count}; these variables have {size} elements")))
}
