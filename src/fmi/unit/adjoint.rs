//! Adjoint derivatives, in safe Rust.

use std::sync::Arc;

use super::Unit;
use super::rates::{Change, Known, check_finite, outputs};
use crate::fmi::gate::answer::{Answer, Reference};
use crate::variables::{Output, followed_inputs, follows_nothing};

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
        let weights = weighted.iter().map(|&i| weights[i]);
        let variables = self.knowns(&registry, knowns)?;
        let followed = self.followed(&asked)?;
        let (mut changes, mut places) = (Vec::new(), Vec::new());
        for (place, (known, _)) in variables.into_iter().enumerate() {
            match known {
                Known::Input(index) if !followed[index] => continue,
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

    /// Returns, for each input by its place in the state, whether some of these outputs may follow it without delay.
    fn followed(&mut self, outputs: &[&Output]) -> Answer<Vec<bool>> {
        let mut followed = followed_inputs(&self.packed, outputs);
        let undeclared: Vec<_> =
            outputs.iter().filter(|output| follows_nothing(&self.packed, output)).collect();
        let (run, state) = self.run()?;
        if undeclared.into_iter().any(|output| run.model.follows_undeclared(state, output)) {
            followed.fill(true);
        }
        Ok(followed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A plate whose bottom has a prescribed temperature, a tunable parameter above that of the body.
    const PLATE: &str = r#"
name = "Plate"
stop_time = 1.0
step = 0.1
[body.plate]
kind = "solid"
shape = { box = [4e-3, 4e-3, 2e-3] }
material = { model = "thermoelastic", density = 2500.0, specific_heat = 750.0, conductivity = 1.0 }
initial_temperature = 300.0
mesh = { spacing = 2e-3 }
peaks = ["temperature"]
faces = { bottom = { temperature = 320.0, role = "parameter" } }
[[probe]]
name = "foot"
in = "plate"
at = [0.0, 0.0, -2e-3]
gives = ["temperature"]
"#;

    /// Derivatives of an output by the temperature of the bottom, directional and adjoint.
    fn both(unit: &mut Unit, output: &str) -> [f64; 2] {
        let [of, by] = [output, "plate.bottom.temperature"]
            .map(|name| [unit.registry.find(name).unwrap() as Reference]);
        let directional = unit.directional_derivative(&of, &by, &[1.0]).unwrap();
        let adjoint = unit.adjoint_derivative(&of, &by, &[1.0]).unwrap();
        [directional[0], adjoint[0]]
    }

    #[test]
    fn tunable_parameters_and_unnoted_maxima_have_adjoint_derivatives() {
        let mut unit = Unit::of_scene_for_tests(PLATE);
        unit.enter_initialization().unwrap();
        assert_eq!(both(&mut unit, "foot.temperature"), [1.0, 1.0]);
        assert_eq!(both(&mut unit, "plate.peak_temperature"), [1.0, 1.0]);
        unit.finish_initialization().unwrap();
        assert_eq!(both(&mut unit, "foot.temperature"), [1.0, 1.0]);
        assert_eq!(both(&mut unit, "plate.peak_temperature"), [0.0, 0.0], "it is noted");
    }
}
