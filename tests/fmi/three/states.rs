//! States that pass from FMI 2.0 to FMI 3.0.

use crate::master::three::Unit;
use crate::master::{self, OK};
use crate::peaks;

/// A state belongs to the unit, not to the version of the standard that it is driven by.
#[test]
fn a_state_of_fmi_2_goes_on_under_fmi_3() {
    let two = master::Unit::running();
    assert_eq!(two.set("spot.heat_flux", 2e7), OK);
    assert_eq!(two.step(0.0, 1e-8), OK);
    let bytes = two.serialize(two.save());
    let three = Unit::instantiated();
    assert_eq!(three.restore(three.deserialize(&bytes)), OK);
    assert_eq!(two.step(1e-8, 2e-8), OK);
    assert_eq!(three.step(1e-8, 2e-8).0, OK);
    for name in ["centre.temperature", "centre.von_mises", "plate.heat_in"] {
        assert_eq!(three.get(name)[0].to_bits(), two.get(name).to_bits(), "{name}");
    }
}

#[test]
fn a_state_that_failed_under_fmi_2_is_in_step_mode_under_fmi_3() {
    let two = master::Unit::running();
    assert_eq!(two.set("spot.heat_flux", -1e13), OK);
    assert_eq!(two.step(0.0, 1e-8), master::DISCARD);
    let bytes = two.serialize(two.save());
    let three = Unit::instantiated();
    assert_eq!(three.restore(three.deserialize(&bytes)), OK);
    assert_eq!(three.set("spot.heat_flux", &[1e6]), OK);
    assert_eq!(three.step(0.0, 1e-8).0, OK, "{:?}", three.messages.take());
}

#[test]
fn running_maxima_are_those_of_fmi_2_and_go_on_to_the_bit() {
    let text = peaks::scene();
    let two = master::Unit::of_scene(&text);
    assert_eq!([two.setup(0.0, None), two.enter(), two.exit()], [OK; 3]);
    let three = Unit::of_scene(&text);
    assert_eq!([three.enter(0.0, None), three.exit()], [OK; 2]);
    let compare = || {
        for key in ["temperature", "von_mises", "max_principal"] {
            for end in ["", "_time", "_x", "_y", "_z"] {
                let name = format!("plate.peak_{key}{end}");
                assert_eq!(three.get(&name)[0].to_bits(), two.get(&name).to_bits(), "{name}");
            }
        }
    };
    let both = |pressure: f64, point: f64| {
        assert_eq!([two.set("spot.pressure", pressure), two.step(point, 1e-8)], [OK; 2]);
        assert_eq!(three.set("spot.pressure", &[pressure]), OK);
        assert_eq!(three.step(point, 1e-8).0, OK, "{:?}", three.messages.take());
    };
    both(4e8, 0.0);
    both(0.0, 1e-8);
    compare();
    assert_eq!(
        three.get("plate.peak_von_mises_time"),
        [0.0],
        "under the pressure of the first step"
    );
    let bytes = two.serialize(two.save());
    let other = Unit::of_scene(&text);
    assert_eq!(other.restore(other.deserialize(&bytes)), OK);
    assert_eq!(other.snapshot(), three.snapshot());
    both(1e8, 2e-8);
    compare();
}
