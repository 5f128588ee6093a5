//! Time derivatives of what the heat problem holds, exact: they are what its equations say.

use super::{HeatClass, HeatLoads, HeatProblem, Passage};

impl HeatProblem {
    /// Time derivative of a state, laid out like the state itself: modal heat content of each class,
    /// face values, totals.
    ///
    /// `loads` acts now and `rates` is its time derivative. Where face values have just jumped, the
    /// totals' rates are those under the new values.
    pub fn rates(&self, state: &[f64], loads: &HeatLoads, rates: &HeatLoads) -> Vec<f64> {
        let mut out = Vec::with_capacity(state.len());
        for (index, (class, content)) in self.classes.iter().zip(self.contents(state)).enumerate() {
            let mut source = self.source(class, &loads.surface[index], &loads.faces[index]);
            class.add_decay(&mut source, content, self.diffusivity());
            out.extend(source);
        }
        let class = &self.classes[0];
        let (values, value_rates) = (&loads.faces[0], &rates.faces[0]);
        let passage = Passage {
            change: self.effective(class, &out[..class.len()], value_rates),
            integral: self.effective(class, &state[..class.len()], values),
            surface: loads.surface[0].clone(),
            value_change: value_rates.clone(),
            values: values.clone(),
        };
        let totals = self.passed(class, &passage);
        out.extend(value_rates);
        out.extend([totals.brought_in, totals.lost]);
        out
    }
}

impl HeatClass {
    /// Adds `−λ d` to the rate of the content `d`.
    fn add_decay(&self, rate: &mut [f64], content: &[f64], diffusivity: f64) {
        let [x, y, z] = self.modes.each_ref().map(|m| &m.decay);
        let mut at = 0;
        for decay_z in z {
            for decay_y in y {
                for decay_x in x {
                    rate[at] -= diffusivity * (decay_x + decay_y + decay_z) * content[at];
                    at += 1;
                }
            }
        }
    }
}
