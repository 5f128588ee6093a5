//! Number and size of the files of a run.

use super::{Discs, vtk};
use crate::model::Forecast;
use crate::scene::Scene;
use crate::variables::{Registry, Slot};

/// Mean length of a number in the table and its comma [B]; the longest has 24.
const NUMBER: f64 = 17.0;
/// Size of a number in the files of fields [B].
const WORD: f64 = 8.0;
/// Numbers of a node with stress and displacement, and of one without.
const OF_NODE: [f64; 2] = [12.0, 1.0];
/// Numbers of a particle.
const OF_PARTICLE: f64 = 12.0;

/// Files of a run: the table of variables, and the fields of its bodies over time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FilesForecast {
    pub count: usize,
    /// Size of all [B], about: numbers in the table have as many digits as they need.
    pub bytes: f64,
}

impl FilesForecast {
    /// Forecasts the files of so many rows of the table, and times of fields.
    pub fn of(scene: &Scene, forecast: &Forecast, [rows, times]: [usize; 2], discs: Discs) -> Self {
        let is_column = |slot: &Slot| matches!(slot, Slot::Input(_) | Slot::Output(_));
        let variables = Registry::of(scene).variables;
        let columns = 1 + variables.iter().filter(|variable| is_column(&variable.slot)).count();
        let solids = forecast.bodies.iter().map(|body| {
            let is_round = scene.body.get(&body.name).is_some_and(|body| body.is_round());
            let sections = if is_round && discs == Discs::Revolved { vtk::SECTIONS } else { 1 };
            let numbers = if body.unknowns[1] > 0 { OF_NODE[0] } else { OF_NODE[1] };
            (sections * body.drawn) as f64 * numbers
        });
        let droplets = forecast.droplets.iter().map(|body| body.drawn as f64 * OF_PARTICLE);
        let of_body: Vec<f64> = solids.chain(droplets).filter(|numbers| *numbers > 0.0).collect();
        let series = if times > 0 { of_body.len() } else { 0 };
        Self {
            // The table, the files of each body with their list, and the list of all if there are several.
            count: 1 + series * (times + 1) + usize::from(series > 1),
            bytes: NUMBER * (rows * columns) as f64
                + WORD * times as f64 * of_body.iter().fold(0.0, |sum, numbers| sum + numbers),
        }
    }
}
