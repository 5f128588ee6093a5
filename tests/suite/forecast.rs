//! Forecasts agree with the counts of runs.

use impinge::advice::parse_with_warnings;
use impinge::model::forecast;
use impinge::scene::parse;

use crate::common::Trial;
use crate::forecast_cases::{CASES, scene, steps_of};

#[test]
fn droplets_take_the_steps_that_were_said() {
    for case in CASES {
        let scene = scene(case);
        let ratio = steps_of(&scene) / forecast(&scene).droplets[0].steps;
        assert!((0.8..1.25).contains(&ratio), "{}: {ratio} of the steps said", case.0);
    }
}

/// Solved pressure is offered where it shortens a run that is not short anyway, and where the fluid may have it.
#[test]
fn solved_pressure_is_offered_to_slow_thick_drops() {
    let honey = |keys: &str, of_fluid: &str, stop: f64| {
        let text = format!(
            "name = \"Honey\"\nstop_time = {stop:e}\nstep = 2e-3\n[body.drop]\nkind = \"droplet\"\ndiameter = 5e-3\n\
             impact_velocity = 0.2\ninitial_temperature = 300.0\nspacing = 0.25e-3\ngravity = 9.81\n{keys}\n\
             fluid = {{ density = 1400.0, viscosity = 10.0, specific_heat = 2500.0, conductivity = 0.5{of_fluid} }}\n\
             [[wall]]\nname = \"wall\"\nunder = \"drop\"\nfootprint = {{ rings = {{ count = 20, radius = 8e-3 }} }}\n"
        );
        let notes = forecast(&parse(&text, "scene.toml").unwrap()).droplets.remove(0).notes;
        notes.into_iter().find(|note| note.contains("would shorten this run"))
    };
    assert!(honey("", "", 0.5).is_some());
    assert_eq!(honey("", "", 2e-3), None, "short anyway");
    assert_eq!(honey("pressure = \"implicit\"", "", 0.5), None);
    assert_eq!(honey("viscous = \"explicit\"", "", 0.5), None);
    assert_eq!(honey("", ", sound_speed = 1400.0", 0.5), None);
}

/// A drop that falls from a height and the same impact as a speed: what is planned, noted and warned of is the same.
#[test]
fn drops_from_a_height_are_those_of_the_same_impact() {
    let keys = "spacing = 2e-4\n";
    let thin = "viscosity = 1e-3, surface_tension = 0.07";
    let thick = "viscosity = 2.0, surface_tension = 0.06";
    let replayed = "effusivity = 1400.0\n";
    for (method, fluid, spacing, wall) in [
        ("sph", thin, keys, ""),
        ("sph", thick, keys, ""),
        ("sph", "viscosity = 1e-3, surface_tension = 0.002", keys, ""),
        ("record", thin, keys, replayed),
        ("film", thin, "", replayed),
    ] {
        // In 0.05 s at 10 m/s², and 0.05 m, a drop of 0.75 m/s reaches 1.25 m/s.
        let seen = |speed: f64, way: f64, fall: f64| {
            let gap = if spacing.is_empty() { way } else { way + 1e-4 };
            let text = format!(
                "name = \"Fall\"\nstop_time = {:e}\nstep = 1e-3\n[body.drop]\nkind = \"droplet\"\nmethod = \
                 \"{method}\"\ndiameter = 2e-3\nimpact_velocity = {speed:?}\nheight = {gap:e}\ninitial_temperature = \
                 330.0\ngravity = 10.0\n{spacing}fluid = {{ density = 1000.0, specific_heat = 4000.0, conductivity = \
                 0.6, {fluid} }}\n[[wall]]\nname = \"wall\"\nunder = \"drop\"\n{wall}footprint = {{ rings = {{ \
                 count = 2, radius = 5e-3 }} }}\nstart = {{ temperature = 300.0 }}\n",
                fall + 0.01
            );
            let (scene, found) = parse_with_warnings(&text, "scene.toml").unwrap();
            let droplet = scene.droplet("drop").unwrap();
            let sizes = [droplet.spread_diameter(), droplet.sound_speed()];
            let warnings: Vec<_> = found.iter().map(ToString::to_string).collect();
            let mut notes = forecast(&scene).droplets.remove(0).notes;
            // The time of a run includes the fall.
            notes.retain(|note| !note.contains("all that follows") && !note.contains("this run"));
            (sizes, droplet.shifts(), notes, warnings)
        };
        let (fallen, fast) = (seen(0.75, 0.05, 0.05), seen(1.25, 0.0, 0.0));
        for (a, b) in fallen.0.iter().zip(fast.0) {
            // Films have no particles, and so no speed of sound.
            let equal = *a == b || (a / b - 1.0).abs() < 1e-12;
            assert!(equal, "{method}, {fluid}: {a}, {b}");
        }
        assert_eq!((fallen.1, fallen.2, fallen.3), (fast.1, fast.2, fast.3), "{method}, {fluid}");
    }
}

/// Metals flatten by what their kinetic energy is over their yield stress, and rubber by its speed over that of sound.
#[test]
fn impacts_take_the_steps_that_were_said() {
    const BAR: &str = "disc = { radius = 3e-3, thickness = 20e-3 }";
    const BALL: &str = "ball = { radius = 3e-3 }";
    let metal = |young: f64, yields: f64, hardens: f64| {
        format!(
            "model = \"elastoplastic\", young = {young:e}, poisson = 0.35, yield_stress = {yields:e}, \
             isotropic_hardening = {hardens:e}"
        )
    };
    let copper = || (8930.0, metal(117e9, 400e6, 100e6));
    let lead = || (11340.0, metal(16e9, 20e6, 20e6));
    let rubber = (1000.0, "model = \"neo_hookean\", young = 1e6, poisson = 0.4".to_owned());
    // Body, speed, end, and the least number of steps over that of the undeformed body.
    let cases = [
        (BAR, copper(), 227.0, 50e-6, 5.0),
        (BAR, copper(), 20.0, 50e-6, 0.0),
        (BAR, lead(), 50.0, 100e-6, 2.0),
        (BALL, lead(), 30.0, 80e-6, 1.2),
        ("box = [6e-3, 1.0, 15e-3]", copper(), 150.0, 40e-6, 1.2),
        (BALL, rubber, 15.0, 1e-3, 1.1),
    ];
    for (shape, (density, law), speed, stop, least) in cases {
        let dimension = if shape.contains("1.0") { "dimension = 2\n" } else { "" };
        let text = format!(
            "name = \"Impact\"\nstop_time = {stop:e}\nstep = {:e}\n[body.bar]\nkind = \"solid\"\nstrain = \"finite\"\n\
             {dimension}shape = {{ {shape} }}\ninitial_temperature = 293.15\nmesh = {{ spacing = 0.8e-3 }}\n\
             inertia = true\nstart = {{ velocity = [0.0, 0.0, {:e}], height = 1e-6 }}\n\
             material = {{ density = {density:e}, specific_heat = 400.0, conductivity = 50.0, {law} }}\n",
            0.1 * stop,
            -speed,
        );
        let said = forecast(&parse(&text, "scene.toml").unwrap()).large_strains.remove(0);
        let mut trial = Trial::new(&text);
        (0..10).for_each(|_| trial.step(0.1 * stop));
        let ratio = trial.get("bar.steps") / said.steps;
        let case = format!("{shape} at {speed} m/s: {} steps, {ratio} of those said", said.steps);
        assert!((0.5..2.0).contains(&ratio), "{case}");
        assert!(said.steps > least * stop / said.time_step.unwrap(), "{case}");
        let warns = said.notes.iter().any(|note| note.contains("elements flatten"));
        assert!(warns || least < 1.2, "{case}");
    }
}

/// A body that the loads of the start leave elastic is not forecast to yield, and one that inputs load is.
#[test]
fn start_loads_tell_whether_metal_yields() {
    let bar = |keys: &str, traction: f64| {
        let text = format!(
            "name = \"Bar\"\nstop_time = 10.0\nstep = 1.0\n[body.bar]\nkind = \"solid\"\nstrain = \"finite\"\n\
             dimension = 2\nshape = {{ box = [20e-3, 1.0, 4e-3] }}\ninitial_temperature = 293.15\n\
             mesh = {{ spacing = 1e-3 }}\nfaces.left = {{ roller = true }}\nfaces.bottom = {{ roller = true }}\n\
             faces.right = {{ traction = [{traction:e}, 0.0, 0.0] }}\nmaterial = {{ density = 2700.0, specific_heat = \
             900.0, conductivity = 200.0, model = \"elastoplastic\", young = 70e9, poisson = 0.33, yield_stress = \
             100e6, isotropic_hardening = 1e9 }}\n{keys}"
        );
        let time = forecast(&parse(&text, "scene.toml").unwrap()).run_time();
        let mut trial = Trial::new(&text);
        trial.step(1.0);
        (trial.get("bar.dissipated"), time)
    };
    let (dissipated, elastic) = bar("", 50e6);
    let (lost, yielding) = bar("", 180e6);
    let (_, unknown) = bar("", 0.0);
    assert!(dissipated.abs() < 1e-9 * lost && lost > 0.0, "{dissipated} {lost}");
    assert!(elastic < yielding && yielding < unknown, "{elastic} {yielding} {unknown}");
}

/// A plate of nonlinear heat costs as much below a strand as it has exchanges, whatever the steps are.
#[test]
fn nonlinear_heat_below_a_strand_costs_as_much_as_its_exchanges() {
    let time = |step: f64, conductivity: &str| {
        let text = format!(
            "name = \"Line\"\nstop_time = 4.0\nstep = {step:e}\n[body.ink]\nkind = \"filament\"\n\
             fluid = {{ substance = \"n-eicosane\", at = \"60 °C\", contact_angle = \"20°\" }}\n\
             nozzle = {{ diameter = 0.8e-3, height = 0.7e-3, temperature = \"70 °C\", flow = 2e-8 }}\n\
             path = {{ time = [0.0, 4.0], x = [0.0, 0.0], y = [-8e-3, 8e-3] }}\nmost = 5e-7\n\
             [body.plate]\nkind = \"solid\"\nshape = {{ box = [40e-3, 30e-3, 2e-3] }}\ninitial_temperature = \"20 °C\"\n\
             mesh = {{ spacing = 0.4e-3 }}\nmaterial = {{ model = \"thermoelastic\", density = 2500.0, specific_heat = \
             800.0, conductivity = {conductivity} }}\n[[coupling]]\nfrom = \"ink\"\nto = \"plate.top\"\ninterval = 0.05\n"
        );
        forecast(&parse(&text, "scene.toml").unwrap()).run_time()
    };
    let table =
        |k: f64| format!("{{ temperature = [250.0, 400.0], value = [{k:e}, {:e}] }}", 0.8 * k);
    let [short, long] = [0.05, 1.0].map(|step| time(step, &table(1.0)));
    assert!((long / short - 1.0).abs() < 0.1, "{short} {long}");
    // Heat that spreads to more nodes in an exchange takes more inner steps.
    assert!(time(1.0, &table(50.0)) > 2.0 * long);
    assert!(time(1.0, "1.0") < 0.2 * long, "linear heat");
}
