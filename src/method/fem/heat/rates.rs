//! Exact time derivatives of the heat problem's state, from its equations.

use super::depth::DepthModes;
use super::{HeatLoads, HeatProblem, Passage, is_zero};

impl<D: DepthModes> HeatProblem<D> {
    /// Time derivative of a state, laid out like the state itself: modal heat content of each class,
    /// face values, totals.
    ///
    /// `loads` acts now and `rates` is its time derivative. Where face values have just jumped, the
    /// totals' rates are those under the new values.
    pub fn rates(&self, state: &[f64], loads: &HeatLoads, rates: &HeatLoads) -> Vec<f64> {
        let mut out = Vec::with_capacity(state.len());
        for (index, (class, content)) in self.classes.iter().zip(self.contents(state)).enumerate() {
            let values = &loads.faces[index];
            if is_zero(content, values) && !loads.drive(index) {
                out.resize(out.len() + content.len(), 0.0);
                continue;
            }
            let mut source = self.source(class, &loads.surface[index], values);
            self.depth.for_each_mode(class, |at, decay| source[at] -= decay * content[at]);
            out.extend(source);
        }
        let class = &self.classes[0];
        let modes = self.len(class);
        let (values, value_rates) = (&loads.faces[0], &rates.faces[0]);
        let passage = Passage {
            change: self.effective(class, &out[..modes], value_rates),
            integral: self.effective(class, &state[..modes], values),
            surface: loads.surface[0].clone(),
            value_change: value_rates.clone(),
            values: values.clone(),
        };
        let totals = self.passed(class, &passage).totals;
        out.extend(value_rates);
        out.extend([totals.brought_in, totals.lost]);
        out
    }
}
