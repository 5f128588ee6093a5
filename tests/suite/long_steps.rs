//! Steps up to the longest and the shortest that arithmetic bears, for all that advances in time.

use crate::common::{Trial, off};
use impinge::limits;
use impinge::model::ModelError;

const LONGEST: f64 = 1e60;

fn slab(conductivity: f64, thickness: f64, more: &str, faces: &str) -> String {
    format!(
        "name = \"Slab\"\nstop_time = 1e-3\nstep = 1e-4\n{more}[body.slab]\nkind = \"solid\"\nshape = {{ box = [1e-3, 1e-3, \
         {thickness:?}] }}\nmaterial = {{ model = \"thermoelastic\", density = 3950.0, specific_heat = 900.0, conductivity \
         = {conductivity:?} }}\ninitial_temperature = 300.0\n{faces}\n[[probe]]\nname = \"p\"\nin = \"slab\"\nat = [0.0, \
         0.0, 0.0]\ngives = [\"temperature\"]\n"
    )
}

const HELD: &str = "faces = { top = { flux = 0.0 }, bottom = { temperature = 300.0 } }";

/// The steady rise is that of a flux through the slab, `q L/k`, after a step of any length.
#[test]
fn steady_states_are_reached_in_steps_of_any_length() {
    // What is reduced keeps the scene's tolerance of 1e-2; inner steps of nonlinear heat, twice that.
    for (what, more, allowed) in [
        ("full", "", 1e-4),
        ("reduced", "fidelity = { level = \"reduced\" }\n", 1e-2),
        ("nonlinear", "solver = { method = \"newton\" }\n", 2.5e-2),
    ] {
        for (conductivity, thickness) in [(10.0, 1e-4), (0.2, 1e-6), (400.0, 1e-3), (2000.0, 1e-8)]
        {
            let flux = conductivity / thickness;
            for step in [1e3, 1e12, 1e30, LONGEST] {
                let mut trial = Trial::new(&slab(conductivity, thickness, more, HELD));
                trial.set("slab.top.flux", flux);
                let before = trial.state.clone();
                let done = trial.try_step(step);
                let may_refuse = what == "nonlinear" && (step > 1e3 || thickness < 1e-7);
                if may_refuse && done.is_err() {
                    // Steps that it finds no solution of, so long or of so thin a slab.
                    assert_eq!(trial.state, before);
                    continue;
                }
                done.unwrap();
                let rise = trial.get("p.temperature") - 300.0;
                assert!(
                    off(rise, 1.0) < allowed,
                    "{what}, {conductivity}, {thickness}, {step}: {rise}"
                );
                assert_eq!(trial.state.time, step);
            }
        }
    }
}

/// Held inputs over the longest step heat an insulated body without a loss.
#[test]
fn heat_balances_over_the_longest_step() {
    for flux in [1e-3, 1e6, 1e60] {
        let mut trial = Trial::new(&slab(10.0, 1e-4, "", "faces = { top = { flux = 0.0 } }"));
        trial.set("slab.top.flux", flux);
        trial.step(LONGEST);
        let wanted = flux * 1e-6 * LONGEST;
        assert!(off(trial.get("slab.heat_stored"), wanted) < 1e-9, "{flux}");
        assert!(off(trial.get("slab.heat_in"), wanted) < 1e-9, "{flux}");
    }
}

#[test]
fn steps_beyond_what_arithmetic_bears_are_refused_and_change_nothing() {
    let drop = "[body.drop]\nkind = \"droplet\"\nmethod = \"film\"\ndiameter = 6e-5\nimpact_velocity = \
                10.0\ninitial_temperature = 350.0\nfluid = { density = 1000.0, viscosity = 1e-3, specific_heat = 4180.0, \
                conductivity = 0.6 }\n[[coupling]]\nfrom = \"drop\"\nto = \"slab.top\"\n";
    let particles =
        "heat = \"sph\"\nmesh = { spacing = 1e-4, depth_spacing = 2e-5, growth = 1.0 }\n";
    for (what, text) in [
        ("full", slab(10.0, 1e-4, "", HELD)),
        ("reduced", slab(10.0, 1e-4, "fidelity = { level = \"reduced\" }\n", HELD)),
        ("nonlinear", slab(10.0, 1e-4, "solver = { method = \"newton\" }\n", HELD)),
        ("particles", slab(10.0, 1e-4, "", &format!("{HELD}\n{particles}"))),
        ("film", slab(10.0, 1e-4, "", "") + drop),
        ("drop", slab(10.0, 1e-4, "", "") + &drop.replace("method = \"film\"", "spacing = 1e-5")),
    ] {
        let mut trial = Trial::new(&text);
        let before = trial.state.clone();
        for step in [2e60, 1e304, 1e306, f64::MAX, f64::INFINITY, f64::NAN, 5e-61, 5e-324, 0.0] {
            let refusal = trial.try_step(step).unwrap_err();
            assert!(matches!(refusal, ModelError::StepLength { .. }), "{what}, {step}: {refusal}");
            assert!(refusal.to_string().contains("allowed: 1e-60 to 1e60 s"), "{what}: {refusal}");
            assert_eq!(trial.state, before);
        }
        trial.step(1e-5);
    }
    assert_eq!(limits::step().bounds().high.map(|end| end.value), Some(LONGEST));
}

/// A film has given all of its heat, whatever comes after.
#[test]
fn a_film_gives_the_same_heat_in_one_longest_step_as_in_a_long_one() {
    let text = slab(10.0, 1e-4, "", "")
        + "[body.drop]\nkind = \"droplet\"\nmethod = \"film\"\ndiameter = 6e-5\nimpact_velocity = \
           10.0\ninitial_temperature = 350.0\nfluid = { density = 1000.0, viscosity = 1e-3, specific_heat = 4180.0, \
           conductivity = 0.6 }\n[[coupling]]\nfrom = \"drop\"\nto = \"slab.top\"\n";
    let heat = |step: f64| {
        let mut trial = Trial::new(&text);
        trial.step(step);
        let [given, taken] = ["drop.heat", "slab.heat_in"].map(|name| trial.get(name));
        assert!(off(taken, given) < 1e-9, "{step}: {given} {taken}");
        given
    };
    let long = heat(1e3);
    for step in [1e12, 1e30, LONGEST] {
        assert!(off(heat(step), long) < 1e-9, "{step}: {} {long}", heat(step));
    }
}

#[test]
fn bodies_of_one_temperature_bear_the_longest_step() {
    let text = "name = \"Bath\"\nstop_time = 1.0\nstep = 0.1\n[body.bath]\nkind = \"reservoir\"\nheat_capacity = \
                10.0\ninitial_temperature = 300.0\nheating = 5.0\nconductance = 2.0\nambient = 290.0\n";
    for step in [1e3, 1e12, 1e30, LONGEST] {
        let mut trial = Trial::new(text);
        trial.step(step);
        // T∞ + P/G.
        assert!(off(trial.get("bath.temperature"), 292.5) < 1e-12, "{step}");
    }
}

/// Over a long step convection as strong as this multiplies the rounding of temperatures that have settled to more heat
/// than there is.
#[test]
fn strong_convection_balances_over_long_steps() {
    for (thickness, conductivity, coefficient) in
        [(1e-5, 2000.0, 1e9), (1e-4, 400.0, 1e7), (1e-2, 0.02, 1e9)]
    {
        let faces = |face: &str| {
            format!(
                "faces.{face}.convection = {{ coefficient = {coefficient:e}, ambient = 310.0 }}\n"
            )
        };
        let text = format!(
            "name = \"Thin\"\nstop_time = 100.0\nstep = 10.0\n[body.plate]\nkind = \"solid\"\n\
             shape.box = [1e-3, 1e-3, {thickness:e}]\ninitial_temperature = 300.0\n\
             material = {{ model = \"thermoelastic\", density = 3510.0, specific_heat = 510.0, \
             conductivity = {conductivity:?} }}\n{}{}",
            faces("top"),
            faces("bottom")
        );
        let mut trial = Trial::new(&text);
        for _ in 0..10 {
            trial.step(10.0);
            let residual = trial.heat_residual("plate");
            assert!(residual < 1e-9, "{thickness:e} m, {coefficient:e}: {residual:e}");
        }
    }
}
