//! Time and memory of a run.

use impinge::model::Forecast;
use impinge::runtime::Usage;

use crate::units::lasting;

/// Resource usage of choosing and assessing meshes; a run does the same before it builds its model.
pub struct Preparation {
    pub begun: Usage,
    pub done: Usage,
}

impl Preparation {
    /// Processor time [s], equal to the wall time on an idle machine: trials use one thread.
    fn time(&self) -> f64 {
        self.done.processor_time - self.begun.processor_time
    }

    /// Memory of a process that prepares and then holds so much data [B]: trials are freed before models are built.
    fn process_memory(&self, data: f64) -> f64 {
        self.done.peak_memory.max(self.begun.peak_memory + data)
    }

    /// Describes the cost of a run: that of its preparation, that of its model, and the time for its table [s].
    pub fn cost(&self, forecast: &Forecast, table_time: f64) -> String {
        let total = forecast.run_time() + self.time() + table_time;
        let memory = self.process_memory(forecast.memory()) / 1e6;
        let of_it = match self.time() {
            time if time > NOTABLE * total => {
                format!(", {} of it to choose and judge meshes", lasting(time))
            }
            _ => String::new(),
        };
        format!("about {} on idle cores{of_it}, {memory:.0} MB of memory", lasting(total))
    }
}

/// Smallest share of a run's time for which `check` reports the preparation.
const NOTABLE: f64 = 0.1;
