//! Steps that FMI 3.0 answers in its own way.

use crate::master::three::Unit;
use crate::master::{DISCARD, ERROR, OK, WARNING};

#[test]
fn a_discarded_step_leaves_the_unit_in_step_mode() {
    let unit = Unit::running();
    assert_eq!(unit.step(0.0, 1e-8).0, OK);
    assert_eq!(unit.set("spot.heat_flux", &[-1e14]), OK);
    unit.expect_message(WARNING, &["spot.heat_flux = -1e14: a heat flux is plausible"]);
    let before = unit.snapshot();
    let (status, stepped) = unit.step(1e-8, 1e-8);
    assert_eq!((status, stepped.flags, stepped.time), (DISCARD, [false; 3], 1e-8));
    unit.expect_message(DISCARD, &["fmi3DoStep", "below absolute zero"]);
    assert_eq!(unit.snapshot(), before);
    assert_eq!(unit.set("spot.heat_flux", &[1e6]), OK);
    assert_eq!(unit.step(1e-8, 1e-8).0, OK, "{:?}", unit.messages.take());
}

#[test]
fn a_step_that_fits_tells_its_time_and_does_not_end_early() {
    let unit = Unit::instantiated();
    assert_eq!(unit.enter(1e-6, Some(2e-6)), OK);
    assert_eq!(unit.time(), 1e-6);
    assert_eq!(unit.exit(), OK);
    let (status, stepped) = unit.step(1e-6, 3e-8);
    assert_eq!((status, stepped.flags), (OK, [false; 3]));
    assert_eq!((stepped.time, unit.time()), (1e-6 + 3e-8, 1e-6 + 3e-8));
    unit.messages.take();
    assert_eq!(unit.step(1e-6 + 3e-8, 1e-6).0, ERROR);
    unit.expect_message(ERROR, &["beyond the stop time"]);
}
