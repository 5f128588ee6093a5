//! Adjoint derivatives, in safe Rust.

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;
use std::sync::Arc;

use super::Unit;
use super::rates::{Change, Known, check_finite, outputs};
use crate::fmi::gate::answer::{Answer, Reference};
use crate::variables::Output;

impl Unit {
    /// Computes Jᵀ·w, where J holds the derivatives of outputs by inputs, and in initialization mode by parameters too:
    /// for each known, the sum over the unknowns of weight times derivative.
    ///
    /// It is computed column by column from the equations of directional derivatives, so it is equally exact. Columns
    /// of inputs that no weighted unknown follows without delay are zero and cost nothing.
    pub fn adjoint_derivative(
        &mut self,
        unknowns: &[Reference],
        knowns: &[Reference],
        weights: &[f64],
    ) -> Answer<Vec<f64>> {
        let registry = Arc::clone(&self.registry);
        let asked = outputs(&registry, unknowns)?;
        for (&unknown, &weight) in unknowns.iter().zip(weights) {
            check_finite(&registry.variables[unknown as usize].name, weight)?;
        }
        let is_weighted = |i: &usize| weights[*i] != 0.0;
        let weighted: Vec<usize> = (0..unknowns.len()).filter(is_weighted).collect();
        let asked: Vec<&Output> = weighted.iter().map(|&i| asked[i]).collect();
        let unknowns: Vec<Reference> = weighted.iter().map(|&i| unknowns[i]).collect();
        let weights = weighted.iter().map(|&i| weights[i]);
        let followed = self.followed(&unknowns);
        let (mut changes, mut places) = (Vec::new(), Vec::new());
        for (place, (&reference, (known, _))) in
            knowns.iter().zip(self.knowns(&registry, knowns)?).enumerate()
        {
            match known {
                Known::Input(_) if !followed.contains(&(reference as usize)) => continue,
                Known::Input(index) => changes.push(Change::Input(index)),
                Known::Parameter(parameter) => changes.push(Change::Parameter(parameter)),
            }
            places.push(place);
        }
        let mut sums = vec![0.0; knowns.len()];
        for (place, column) in places.into_iter().zip(self.rates(&asked, &changes)?) {
            sums[place] = column.iter().zip(weights.clone()).map(|(rate, w)| rate * w).sum();
        }
        Ok(sums)
    }

    /// Places of the inputs that some of these outputs follow without delay.
    fn followed(&self, outputs: &[Reference]) -> BTreeSet<usize> {
        let all: BTreeMap<usize, Rc<[usize]>> =
            self.registry.all_dependencies(&self.packed).into_iter().collect();
        let mut followed = BTreeSet::new();
        let mut seen = BTreeSet::new();
        for output in outputs {
            // Outputs of one kind share one list.
            let list = &all[&(*output as usize)];
            if seen.insert(Rc::as_ptr(list)) {
                followed.extend(list.iter().copied());
            }
        }
        followed
    }
}
