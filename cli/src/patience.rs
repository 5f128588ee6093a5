//! Forecasts of a command's duration: long ones are reported, extreme ones refused.

use std::path::Path;

use impinge::advice;
use impinge::model::{self, forecast};
use impinge::scene::{self, Scene};
use impinge::warning::Warning;

use super::CliError;
use super::units::lasting;

const MINUTE: f64 = 60.0;
const DAY: f64 = 24.0 * 60.0 * MINUTE;
/// Duration from which a run reports its forecast, and from which it is refused [s].
const REPORTED: f64 = 10.0 * MINUTE;
const REFUSED: f64 = 30.0 * DAY;
/// Duration of the proposed run [s].
const PROPOSED: f64 = DAY;

/// Reads and checks the scene in a file; prints a notice before it reads a large one.
pub fn read(path: &Path) -> Result<(Scene, Vec<Warning>), CliError> {
    model::check_room_to_read().map_err(CliError::Model)?;
    let file = path.display().to_string();
    let text = scene::text_of(path, &file)?;
    if let Some(note) = scene::note_on_reading(&text, &file) {
        super::print_message("note", &note);
    }
    Ok(advice::parse_with_warnings(&text, &file)?)
}

/// Notice on the duration of a scene's run; refuses one that takes months, with a proposal.
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
    let savings = forecast.bodies.iter().filter_map(|body| body.savings.as_ref());
    let savings = savings.map(|savings| format!("; {savings}"));
    let told = || {
        let further: String = steps.chain(savings).collect();
        format!("this takes about {}{further}", lasting(time))
    };
    Ok((time > REPORTED).then(told))
}
