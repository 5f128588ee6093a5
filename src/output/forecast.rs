//! Number and size of the files of a run.

use super::{Discs, vtk};
use crate::model::Forecast;
use crate::quantity::Quantity;
use crate::scene::Scene;
use crate::variables::{Registry, Slot, Variable};

/// Mean length of a number in the table and its comma [B]; the longest has 24.
const NUMBER: f64 = 17.0;
/// Time to read and write a number of the table, and a component of stress, measured on grids of 1600 points [s].
const NUMBER_TIME: f64 = 4e-7;
const STRESS_TIME: f64 = 1.8e-6;
/// Size of a number in the files of fields [B].
const WORD: f64 = 8.0;
/// Numbers of a node with stress and displacement, and of one without.
const OF_NODE: [f64; 2] = [12.0, 1.0];
/// Head of a field file, its entry in a list, and the title of a column [B].
const HEAD: f64 = 1400.0;
const ENTRY: f64 = 80.0;
const TITLE: f64 = 25.0;
/// Numbers of a particle.
const OF_PARTICLE: f64 = 12.0;

/// Files of a run: the table of variables, and the fields of its bodies over time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilesForecast {
    pub count: usize,
    /// Size of all [B], about: numbers in the table have as many digits as they need.
    pub bytes: f64,
    /// Time to read and write the table [s].
    pub table_time: f64,
}

impl FilesForecast {
    /// Forecasts the files of so many rows of the table, and times of fields.
    pub fn of(scene: &Scene, forecast: &Forecast, [rows, times]: [usize; 2], discs: Discs) -> Self {
        let is_column = |slot: &Slot| matches!(slot, Slot::Input(_) | Slot::Output(_));
        let variables = Registry::of(scene).variables;
        let in_table: Vec<_> =
            variables.iter().filter(|variable| is_column(&variable.slot)).collect();
        let columns = 1 + in_table.len();
        let time_of = |variable: &&Variable| match variable.quantity {
            Some(Quantity::Stress) => STRESS_TIME,
            _ => NUMBER_TIME,
        };
        let row_time: f64 = in_table.iter().map(time_of).sum();
        let solids = forecast.bodies.iter().map(|body| {
            let is_round = scene.body.get(&body.name).is_some_and(|body| body.is_round());
            let sections = if is_round && discs == Discs::Revolved { vtk::SECTIONS } else { 1 };
            let numbers = if body.unknowns[1] > 0 { OF_NODE[0] } else { OF_NODE[1] };
            (sections * body.drawn) as f64 * numbers
        });
        let particles = forecast.needs().into_iter().filter_map(|need| need.particles);
        let particles = particles.map(|drawn| drawn as f64 * OF_PARTICLE);
        let of_body: Vec<f64> = solids.chain(particles).filter(|numbers| *numbers > 0.0).collect();
        let series = if times > 0 { of_body.len() } else { 0 };
        Self {
            // The table, the files of each body with their list, and the list of all if there are several.
            count: 1 + series * (times + 1) + usize::from(series > 1),
            bytes: TITLE * columns as f64
                + NUMBER * (rows * columns) as f64
                + (HEAD + ENTRY) * (series * times) as f64
                + WORD * times as f64 * of_body.iter().fold(0.0, |sum, numbers| sum + numbers),
            table_time: rows as f64 * row_time,
        }
    }
}
