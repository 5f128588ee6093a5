//! Adjoint derivatives, in safe Rust.

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;
use std::sync::Arc;

use super::rates::{Known, check_finite, outputs};
use super::types::{Answer, Reference};
use super::unit::Unit;

impl Unit {
    /// Jᵀ·w, where J holds the derivatives of outputs by inputs, and in initialization mode by
    /// parameters too: for each known the sum over the unknowns of weight times derivative.
    ///
    /// Column by column, from the same equations as directional derivatives and so as exact. Columns
    /// of inputs that no weighted unknown follows at once are zero and cost nothing.
    pub fn adjoint_derivative(
        &mut self,
        unknowns: &[Reference],
        knowns: &[Reference],
        weights: &[f64],
    ) -> Answer<Vec<f64>> {
        let registry = Arc::clone(&self.registry);
        outputs(&registry, unknowns)?;
        for (&unknown, &weight) in unknowns.iter().zip(weights) {
            check_finite(&registry.variables[unknown as usize].name, weight)?;
        }
        let weighted = unknowns.iter().zip(weights).filter(|(_, weight)| **weight != 0.0);
        let (unknowns, weights): (Vec<Reference>, Vec<f64>) = weighted.unzip();
        let followed = self.followed(&unknowns);
        let mut sums = Vec::with_capacity(knowns.len());
        for (&reference, (known, _)) in knowns.iter().zip(self.knowns(&registry, knowns)?) {
            if matches!(known, Known::Input(_)) && !followed.contains(&(reference as usize)) {
                sums.push(0.0);
                continue;
            }
            let column = self.directional_derivative(&unknowns, &[reference], &[1.0])?;
            sums.push(column.iter().zip(&weights).map(|(rate, weight)| rate * weight).sum());
        }
        Ok(sums)
    }

    /// Places of the inputs that some of these outputs follow at once.
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
