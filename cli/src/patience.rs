//! Forecasts of how long a command takes: reported where that is long, refused where nobody waits for it.

use std::path::Path;

use impinge::advice;
use impinge::model::forecast;
use impinge::scene::{self, Scene};
use impinge::warning::Warning;

use super::CliError;
use super::units::lasting;

const MINUTE: f64 = 60.0;
const DAY: f64 = 24.0 * 60.0 * MINUTE;
/// From where on a run says how long it will take, and is refused [s].
const TOLD: f64 = 10.0 * MINUTE;
const REFUSED: f64 = 30.0 * DAY;
/// What is proposed instead [s].
const PROPOSED: f64 = DAY;

/// Reads and checks the scene in a file; says so before it reads a large one.
pub fn read(path: &Path) -> Result<(Scene, Vec<Warning>), CliError> {
    let file = path.display().to_string();
    let text = scene::text_of(path, &file)?;
    if let Some(note) = scene::note_on_reading(&text, &file) {
        super::print_message("note", &note);
    }
    Ok(advice::parse_with_warnings(&text, &file)?)
}

/// What to say of the time that a run of a scene will take; refuses one that takes months, with what would do.
pub fn expected(scene: &Scene) -> Result<Option<String>, CliError> {
    let forecast = forecast(scene);
    let time = forecast.run_time();
    if time > REFUSED {
        let until = scene.stop_time * PROPOSED / time;
        return Err(CliError::Months {
            time: lasting(time),
            most: lasting(REFUSED),
            until: format!("{until:.1e}"),
            proposed: lasting(PROPOSED),
        });
    }
    let steps = forecast.droplets.iter().map(|body| {
        format!(", {:.2e} time steps of `{}` of {:.1e} s", body.steps, body.name, body.time_step)
    });
    let told = || format!("this takes about {}{}", lasting(time), steps.collect::<String>());
    Ok((time > TOLD).then(told))
}
