//! Droplets take the steps that are said.

use impinge::model::forecast;

use crate::forecast_cases::{CASES, scene, steps_of};

#[test]
fn droplets_take_the_steps_that_were_said() {
    for case in CASES {
        let scene = scene(case);
        let ratio = steps_of(&scene) / forecast(&scene).droplets[0].steps;
        assert!((0.8..1.25).contains(&ratio), "{}: {ratio} of the steps said", case.0);
    }
}
