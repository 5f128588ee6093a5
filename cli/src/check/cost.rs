//! Time and memory of a run.

use assessments::Cost;
use impinge::model::Forecast;
use impinge::runtime::Usage;

use crate::units::lasting;

/// Resource usage before meshes are assessed, and of the assessments when they were made: that of levels, and that of
/// meshes. A run of the scene finds them in the store.
pub struct Preparation {
    pub begun: Usage,
    pub costs: [Cost; 2],
}

impl Preparation {
    /// Processor time [s], equal to the wall time on an idle machine: trials use one thread.
    fn time(&self) -> f64 {
        self.costs.iter().map(|cost| cost.time).sum()
    }

    /// Memory of a process that prepares and then holds so much data [B]: trials are freed before models are built.
    fn process_memory(&self, data: f64) -> f64 {
        let trials: f64 = self.costs.iter().map(|cost| cost.memory).sum();
        self.begun.peak_memory + trials.max(data)
    }

    /// Describes the cost of a run: that of its model, that of the first preparation, and the time for its table [s].
    pub fn cost(&self, forecast: &Forecast, table_time: f64) -> String {
        let run = forecast.run_time() + table_time;
        let memory = self.process_memory(forecast.memory()) / 1e6;
        let first = match self.time() {
            time if time > NOTABLE * (run + time) => {
                format!(", the first time {} more to choose and judge meshes", lasting(time))
            }
            _ => String::new(),
        };
        format!("about {} on idle cores{first}, {memory:.0} MB of memory", lasting(run))
    }
}

/// Smallest share of the time of a first run for which `check` reports the preparation.
const NOTABLE: f64 = 0.1;
