//! Units of the numbers in a scene, by their keys.

use crate::scene::locate::Path;

/// Keys whose numbers have a unit; a key means the same wherever it stands.
const UNITS: [(&str, &[&str]); 19] = [
    ("s", &["stop_time", "step", "time", "interval"]),
    (
        "m",
        &[
            "box",
            "radius",
            "thickness",
            "spacing",
            "depth_spacing",
            "at",
            "size",
            "x",
            "y",
            "z",
            "diameter",
            "height",
        ],
    ),
    (
        "K",
        &[
            "initial_temperature",
            "stress_free_temperature",
            "temperature",
            "ambient",
            "solidus",
            "liquidus",
        ],
    ),
    ("kg/m³", &["density"]),
    ("J/(kg K)", &["specific_heat"]),
    ("W/(m K)", &["conductivity"]),
    (
        "Pa",
        &[
            "young",
            "pressure",
            "shear_x",
            "shear_y",
            "shear_r",
            "yield_stress",
            "isotropic_hardening",
            "kinematic_hardening",
        ],
    ),
    ("J/kg", &["latent_heat"]),
    ("1/K", &["expansion"]),
    ("W/m²", &["flux", "heat_flux"]),
    ("W/(m² K)", &["coefficient", "conductance"]),
    ("m² K/W", &["contact_resistance"]),
    ("m/s", &["impact_velocity", "sound_speed"]),
    ("m/s²", &["gravity"]),
    ("Pa s", &["viscosity"]),
    ("N/m", &["surface_tension"]),
    ("rad", &["contact_angle"]),
    ("W √s/(m² K)", &["effusivity"]),
    ("distances of particles", &["support"]),
];

/// What is allowed at a place, with the unit of numbers there.
pub fn with_unit(allowed: String, place: &Path) -> String {
    let Some(unit) = unit_at(place) else { return allowed };
    for kind in ["a finite number", "a list of 2 values", "a list of 3 values"] {
        if let Some(rest) = allowed.strip_prefix(kind) {
            return format!("{kind} in {unit}{rest}");
        }
    }
    allowed
}

/// The unit of a value, or of the list that it is an element of.
fn unit_at(place: &Path) -> Option<&'static str> {
    let mut place = place.clone();
    while place.last_key().is_empty() && place != place.parent() {
        place = place.parent();
    }
    let key = place.last_key();
    UNITS.iter().find(|(_, keys)| keys.contains(&key)).map(|(unit, _)| *unit)
}
