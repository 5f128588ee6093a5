//! Arrays, and that they are the scalars of FMI 2.0.

use impinge::variables::{Causality, Content};

use crate::master::three::Unit;
use crate::master::{self, ERROR, OK};

/// Sets scalar after scalar what is set as arrays.
fn set_scalars(unit: &master::Unit, names: &[&str], values: &[f64]) {
    for (name, value) in names.iter().zip(values) {
        assert_eq!(unit.set(name, *value), OK, "{name}");
    }
}

#[test]
fn a_run_is_that_of_fmi_2_to_the_bit() {
    let (two, three) = (master::Unit::instantiated(), Unit::instantiated());
    let inputs = ["patch.heat_flux", "patch.pressure", "spot.heat_flux", "spot.shear_x", "spot.x"];
    let inputs = three.references(&inputs);
    let names = three.scalar_names(&inputs);
    assert_eq!(two.set("plate.conductivity", 14.0), OK);
    assert_eq!(three.set("plate.conductivity", &[14.0]), OK);
    assert_eq!((two.setup(0.0, None), two.enter(), two.exit()), (OK, OK, OK));
    assert_eq!((three.enter(0.0, None), three.exit()), (OK, OK));
    let outputs = three.floats(Some(Causality::Output));
    let scalars: Vec<u32> =
        three.scalar_names(&outputs).iter().map(|name| two.reference(name)).collect();
    assert!(scalars.len() > 32);
    let mut time = 0.0;
    for (i, step) in [1e-8, 4e-8, 0.3e-8].into_iter().enumerate() {
        let size = |k: usize| [1e7, 1e5, 2e7, 3e5, 2e-5][k.min(4)] * (1.0 + i as f64);
        let kinds = [[0; 6], [1; 6]].concat().into_iter().chain([2, 3, 4]);
        let values: Vec<f64> =
            kinds.enumerate().map(|(at, kind)| size(kind) * (1.0 + 0.1 * at as f64)).collect();
        let values = values.iter().map(|v| if *v < 1e-3 { 3e-5 } else { *v }).collect::<Vec<_>>();
        assert_eq!(three.set_all(&inputs, &values), OK, "{:?}", three.messages.take());
        set_scalars(&two, &names, &values);
        assert_eq!(three.get_all(&inputs), values);
        assert_eq!((two.step(time, step), three.step(time, step).0), (OK, OK));
        time += step;
        let mut expected = vec![0.0; scalars.len()];
        assert_eq!(two.get_in(&scalars, &mut expected), OK);
        let found = three.get_all(&outputs);
        let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&found), bits(&expected));
        assert!(found.iter().any(|value| *value != 0.0));
    }
}

#[test]
fn arrays_run_fastest_along_the_last_index() {
    let unit = Unit::running();
    assert_eq!(unit.set("patch.heat_flux", &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]), OK);
    let names = unit.scalar_names(&[unit.reference("patch.heat_flux")]).join(" ");
    assert!(names.starts_with("patch.heat_flux[1,1] patch.heat_flux[1,2]"), "{names}");
    assert_eq!(unit.get("patch.heat_flux"), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    let mixed = unit.references(&["time", "patch.heat_flux", "surface.z", "spot.radius"]);
    assert_eq!(unit.get_all(&mixed), [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 0.0, 60e-6]);
}

#[test]
fn a_set_is_all_or_nothing() {
    let unit = Unit::running();
    let before = unit.snapshot();
    let both = unit.references(&["patch.heat_flux", "spot.x"]);
    let mut values = [7.0; 7];
    values[6] = 1.0;
    assert_eq!(unit.set_all(&both, &values), ERROR, "x is out of its range");
    unit.expect_message(ERROR, &["fmi3SetFloat64", "spot.x", "at most"]);
    values[6] = 0.0;
    values[3] = f64::NAN;
    assert_eq!(unit.set_all(&both, &values), ERROR);
    unit.expect_message(ERROR, &["patch.heat_flux[2,1]", "finite"]);
    assert_eq!(unit.snapshot(), before);
}

#[test]
fn wrong_numbers_of_values_are_refused() {
    let unit = Unit::running();
    let before = unit.snapshot();
    let flux = [unit.reference("patch.heat_flux")];
    for count in [0, 1, 5, 7] {
        assert_eq!(unit.set_all(&flux, &vec![1.0; count]), ERROR);
        unit.expect_message(ERROR, &["fmi3SetFloat64", "nValues", "6 elements"]);
        let mut values = vec![-1.0; count];
        assert_eq!(unit.get_in(&flux, &mut values), ERROR);
        unit.expect_message(ERROR, &["fmi3GetFloat64", "nValues", "6 elements"]);
        assert!(values.iter().all(|value| *value == -1.0));
    }
    assert_eq!(unit.snapshot(), before);
}

#[test]
fn coordinates_and_time_are_read_and_never_set() {
    let unit = Unit::running();
    let before = unit.snapshot();
    let x = unit.get("surface.x");
    for (found, expected) in x.iter().zip([-1.5e-4, -0.5e-4, 0.5e-4, 1.5e-4]) {
        assert!((found - expected).abs() < 1e-18, "{x:?}");
    }
    assert_eq!(unit.get("surface.z"), [0.0]);
    assert_eq!(unit.set("surface.x", &[0.0; 4]), ERROR);
    unit.expect_message(ERROR, &["surface.x is constant"]);
    assert_eq!(unit.set("time", &[1.0]), ERROR);
    unit.expect_message(ERROR, &["time"]);
    assert_eq!(unit.snapshot(), before);
    for variable in &unit.arrays.variables {
        if let Content::Constants(_, values) = &variable.content {
            assert_eq!(&unit.get(&variable.name), values, "{}", variable.name);
        }
    }
}

/// The temperature of a field belongs to the points that its coordinates tell.
#[test]
fn fields_stand_at_their_coordinates() {
    let unit = Unit::running();
    assert_eq!(unit.set("spot.x", &[5e-5]), OK);
    assert_eq!(unit.set("spot.y", &[-5e-5]), OK);
    assert_eq!(unit.step(0.0, 1e-7).0, OK);
    let (x, y, field) =
        (unit.get("surface.x"), unit.get("surface.y"), unit.get("surface.temperature"));
    let hottest = (0..16).max_by(|&a, &b| field[a].total_cmp(&field[b])).unwrap();
    let distance = (x[hottest / 4] - 5e-5).hypot(y[hottest % 4] + 5e-5);
    assert!(distance < 1e-9, "hottest at {}, {}", x[hottest / 4], y[hottest % 4]);
}

#[test]
fn before_initialization_only_start_values_are_known() {
    let unit = Unit::instantiated();
    assert_eq!(unit.get("spot.heat_flux"), [5e7]);
    assert_eq!(unit.get("plate.density"), [3950.0]);
    let mut value = [-1.0; 16];
    let field = [unit.reference("surface.temperature")];
    assert_eq!(unit.get_in(&field, &mut value), ERROR);
    unit.expect_message(ERROR, &["surface.temperature", "before Initialization Mode"]);
    assert_eq!(value, [-1.0; 16]);
}
