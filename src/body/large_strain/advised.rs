//! Notes on solids of large strain, and warnings about their values.

use std::f64::consts::PI;

use super::snapshot::copies;
use super::{forecast, totals};
use crate::body::Reading;
use crate::laws::solid::large_strain::Deviator;
use crate::method::large_strain::Deformable;
use crate::scene::{LargeStrain, SolidShape};
use crate::space::Form;
use crate::warning::{self, Warning};

/// Dissipation below zero that is no rounding and no error of steps, over the shear modulus times the volume of the
/// whole body.
const UNSOUND: f64 = 1e-3;

/// Messages of a body to its user.
pub struct Advised {
    name: String,
    notes: Vec<String>,
    /// Dissipation below which the split of energy of a body that relaxes is unsound [J]; `None` of any other body.
    unsound: Option<f64>,
}

impl Advised {
    pub fn of((name, solid): (&str, &LargeStrain), body: &Deformable) -> Self {
        let relaxing = body.layers.iter().filter(|layer| match &layer.law.deviator {
            Deviator::Relaxing(own) => own.history() > 0,
            Deviator::Plastic(_) | Deviator::Concrete(_) => false,
        });
        let shear = relaxing.map(|layer| layer.law.shear).reduce(f64::max);
        let of_model: f64 = body.space.volume.weights.iter().sum();
        let volume = copies(solid.mirrors()) * of_model;
        let mut notes = forecast::notes(solid);
        notes.extend(note_on_volume(solid, volume));
        Self { name: name.to_owned(), notes, unsound: shear.map(|shear| -UNSOUND * shear * volume) }
    }

    pub fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    /// Warns of energy that a body that relaxes seems to gain: far from small strain its law stores more than the work
    /// done.
    pub fn on_value(&self, reading: &Reading, value: f64) -> Option<Warning> {
        let Reading::Total(place) = *reading else { return None };
        let is_unsound = totals::is_dissipated(place) && value < self.unsound?;
        is_unsound.then(|| {
            warning::dissipation_below_zero(format!("{value:.2e}"))
                .at(format!("{}.dissipated", self.name))
        })
    }
}

/// Part of a ball that may be missing without a note.
const MISSING: f64 = 5e-3;

/// Notes that flat elements fill less than a ball.
fn note_on_volume(solid: &LargeStrain, filled: f64) -> Option<String> {
    let SolidShape::Ball(ball) = &solid.shape else { return None };
    let radius = ball.radius;
    let whole = match solid.form() {
        Form::Plane => PI * radius * radius,
        Form::Axisymmetric | Form::Solid => 4.0 / 3.0 * PI * radius.powi(3),
    };
    let missing = 1.0 - filled / whole;
    let percents = format!("{:.1}", 100.0 * missing);
    (missing > MISSING).then(|| {
        format!("flat elements leave out {percents} % of the ball: so much less are mass, momentum and energy")
    })
}

#[cfg(test)]
mod tests {
    use super::super::plan;
    use super::*;
    use crate::scene;

    /// Dissipation below which a block is warned of [J].
    fn unsound(symmetry: &str) -> f64 {
        let text = format!(
            r#"
name = "Block"
stop_time = 1.0
step = 0.1
[body.block]
kind = "solid"
strain = "finite"
shape = {{ box = [4e-3, 4e-3, 2e-3] }}
symmetry = "{symmetry}"
initial_temperature = 293.15
material = {{ model = "viscoelastic", density = 1000.0, specific_heat = 1900.0, conductivity = 0.2, young = 1e6, poisson = 0.4, shear_relaxation = [{{ fraction = 0.6, time = 0.3 }}] }}
mesh = {{ spacing = 2e-3 }}
faces.bottom = {{ clamped = true }}
"#
        );
        let scene = scene::parse(&text, "scene.toml").unwrap_or_else(|error| panic!("{error}"));
        let own = scene.large_strains().next().unwrap();
        let body = plan::deformable(own.1, 1).unwrap();
        Advised::of(own, &body).unsound.unwrap()
    }

    #[test]
    fn a_quarter_is_warned_of_as_the_whole_body() {
        let [whole, quarter] = ["none", "quarter"].map(unsound);
        assert!((quarter / whole - 1.0).abs() < 1e-12, "{quarter} {whole}");
        assert!((whole / -(1e-3 * 1e6 / 2.8 * 32e-9) - 1.0).abs() < 1e-12, "{whole}");
    }
}
