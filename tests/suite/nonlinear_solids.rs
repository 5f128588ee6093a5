//! Solids of scenes whose constants depend on the temperature, that melt, radiate or yield.

use impinge::closed_form::{Bilinear, Conductor, HeatedSlab, MeltingFront};

use crate::common::{Trial, off};

/// A body with a material, faces and further tables.
fn body(shape: &str, material: &str, start: f64, faces: &str, rest: &str) -> String {
    format!(
        "name = \"Body\"\nstop_time = 1.0\nstep = 0.1\n[body.plate]\nkind = \"solid\"\nshape = {{ {shape} }}\n\
         initial_temperature = {start:?}\nmaterial = {{ {material} }}\n[body.plate.faces]\n{faces}\n{rest}"
    )
}

fn with_mesh(text: &str, mesh: &str) -> String {
    text.replacen("[body.plate.faces]", &format!("mesh = {{ {mesh} }}\n[body.plate.faces]"), 1)
}

fn probe(name: &str, at: [f64; 3], gives: &str) -> String {
    format!("[[probe]]\nname = \"{name}\"\nin = \"plate\"\nat = {at:?}\ngives = [{gives}]\n")
}

const T: &str = "\"temperature\"";

#[test]
fn a_steady_slab_conducts_as_the_integral_of_its_conductivity() {
    // k falls from 30 to 9 W/(m K) between 300 and 800 K: θ is a parabola.
    let material = "model = \"thermoelastic\", density = 3950.0, specific_heat = 900.0, \
                    conductivity = { temperature = [300.0, 800.0], value = [30.0, 9.0] }";
    let faces = "bottom = { temperature = 300.0 }\ntop = { temperature = 800.0 }";
    let probes = probe("middle", [0.0, 0.0, -0.5e-3], T) + &probe("low", [0.0, 0.0, -0.75e-3], T);
    for shape in ["box = [2e-3, 2e-3, 1e-3]", "disc = { radius = 1e-3, thickness = 1e-3 }"] {
        let text = with_mesh(
            &body(shape, material, 300.0, faces, &probes),
            "spacing = 5e-4, depth_spacing = 5e-5, growth = 1.0",
        );
        let mut trial = Trial::new(&text);
        (0..3).for_each(|_| trial.step(1.0));
        let theta = |t: f64| 30.0 * (t - 300.0) - 0.5 * 21.0 / 500.0 * (t - 300.0).powi(2);
        for (name, part) in [("middle", 0.5), ("low", 0.25)] {
            let found = trial.get(&format!("{name}.temperature"));
            assert!(off(theta(found), part * theta(800.0)) < 1e-4, "{shape} {name} {found}");
        }
        assert!(trial.heat_residual("plate") < 1e-9);
    }
}

/// Differences of temperatures, and of what follows from them, between Newton's method and modes on one mesh.
fn off_modes(spacing: [f64; 2]) -> [f64; 2] {
    let material = "model = \"thermoelastic\", density = 3950.0, specific_heat = 900.0, conductivity = 10.0, \
                    young = 300e9, poisson = 0.21, expansion = 8.1e-6";
    let load = "[[load]]\nname = \"spot\"\non = \"plate.top\"\nfootprint = { gaussian = { radius = 2e-4 } }\n\
                carries = [\"heat_flux\", \"pressure\"]\nstart = { heat_flux = 1e7, pressure = 1e6 }\n";
    let faces = "bottom = { convection = { coefficient = 500.0, ambient = 350.0 } }\nsides = { clamped = true }";
    let probes = probe("spot_top", [0.0; 3], "\"temperature\", \"stress\", \"displacement\"")
        + &probe("deep", [1e-4, 0.0, -2e-4], T);
    let text = with_mesh(
        &body("box = [1e-3, 1e-3, 4e-4]", material, 300.0, faces, &(load.to_owned() + &probes)),
        &format!("spacing = {:e}, depth_spacing = {:e}, growth = 1.0", spacing[0], spacing[1]),
    );
    let text = text.replacen("initial_", "symmetry = \"quarter\"\ninitial_", 1);
    let mut modal = Trial::new(&text);
    let mut newton = Trial::new(&format!(
        "{text}\n[solver]\nmethod = \"newton\"\n[fidelity]\ntolerance = 1e-4\n"
    ));
    for _ in 0..4 {
        modal.step(2e-3);
        newton.step(2e-3);
        assert!(newton.heat_residual("plate") < 1e-9);
    }
    let mut largest = |names: &[&str], zero: f64| {
        let of = |name: &&str| {
            let [a, b] = [&mut modal, &mut newton].map(|trial| trial.get(name) - zero);
            off(a, b)
        };
        names.iter().map(of).fold(0.0, f64::max)
    };
    let temperatures = ["spot_top.temperature", "deep.temperature", "plate.max_temperature"];
    let others = [
        "spot_top.stress_xx",
        "spot_top.von_mises",
        "spot_top.displacement_z",
        "plate.heat_stored",
    ];
    [largest(&temperatures, 300.0), largest(&others, 0.0)]
}

#[test]
fn newton_comes_to_agree_with_modes_where_both_may_be_taken() {
    let [coarse, fine] = [[4e-5, 2e-5], [2e-5, 1e-5]].map(off_modes);
    for (coarse, fine) in coarse.iter().zip(fine) {
        assert!(fine < 0.01 && (coarse / fine).log2() > 1.5, "{coarse} {fine}");
    }
}

#[test]
fn a_melting_plate_takes_its_latent_heat() {
    // Tin, heated evenly from above until all of it is liquid.
    let material = "model = \"thermoelastic\", density = 7290.0, specific_heat = 230.0, conductivity = 65.0, \
                    melting = { solidus = 505.0, liquidus = 505.0, latent_heat = 5.9e4 }";
    let load = "[[load]]\nname = \"heat\"\non = \"plate.top\"\nfootprint = { tiles = { count = [1, 1], size = [2e-3, 2e-3] } }\n\
                carries = [\"heat_flux\"]\nstart = { heat_flux = 1e5 }\n";
    let text = with_mesh(
        &body("box = [2e-3, 2e-3, 5e-4]", material, 300.0, "", load),
        "spacing = 1e-3, depth_spacing = 5e-5, growth = 1.0",
    );
    let mut trial = Trial::new(&text);
    let volume = 4e-6 * 5e-4;
    let needed = volume * 7290.0 * (230.0 * 205.0 + 5.9e4);
    // A gradient of 1.5 K/mm stands in the plate as long as heat comes in.
    let time = needed / (1e5 * 4e-6);
    trial.step(0.9 * time);
    let half = trial.get("plate.liquid_volume") / volume;
    assert!((0.7..0.9).contains(&half), "{half}");
    assert!((trial.get("plate.max_temperature") - 505.0).abs() < 1.0);
    trial.step(0.2 * time);
    assert!(off(trial.get("plate.liquid_volume"), volume) < 1e-9);
    let rise = 0.1 * needed / (volume * 7290.0 * 230.0);
    trial.set("heat.heat_flux[1,1]", 0.0);
    trial.step(1.0);
    assert!(off(trial.get("plate.max_temperature") - 505.0, rise) < 1e-3);
    assert!(off(trial.get("plate.heat_in"), 1.1 * needed) < 1e-9);
    assert!(trial.heat_residual("plate") < 1e-9);
}

#[test]
fn a_radiating_plate_comes_to_rest_where_it_loses_what_it_gets() {
    let material =
        "model = \"thermoelastic\", density = 8960.0, specific_heat = 385.0, conductivity = 400.0";
    for (emissivity, flux, ambient) in [(0.8, 2e4, 293.15), (1.0, 5e5, 4.0), (0.03, 100.0, 500.0)] {
        let faces = format!(
            "top = {{ radiation = {{ emissivity = {emissivity:?}, ambient = {ambient:?} }} }}\nbottom = {{ flux = {flux:?} }}"
        );
        let text = with_mesh(
            &body("disc = { radius = 1e-2, thickness = 1e-3 }", material, 400.0, &faces, ""),
            "spacing = 5e-3, depth_spacing = 5e-4",
        );
        let mut trial = Trial::new(&text);
        (0..4).for_each(|_| trial.step(1e5));
        let wanted = (flux / (emissivity * 5.670374419e-8) + f64::powi(ambient, 4)).powf(0.25);
        let found = trial.get("plate.max_temperature");
        // Across the plate the flux makes a difference of its own.
        assert!((found - wanted - flux * 1e-3 / 400.0).abs() < 2e-4 * wanted, "{found} {wanted}");
        assert!(trial.heat_residual("plate") < 1e-9);
    }
}

/// Steel, say, that yields.
const STEEL: &str = "model = \"elastoplastic\", density = 7800.0, specific_heat = 500.0, conductivity = 45.0, \
                     young = 200e9, poisson = 0.3, expansion = 1.2e-5, yield_stress = 250e6, \
                     isotropic_hardening = 2e9";

/// A bar between rigid walls whose sides are free.
fn bar(material: &str, rest: &str) -> String {
    let faces = "left = { roller = true }\nright = { roller = true }\nfront = { roller = true }\n\
                 bottom = { roller = true, temperature = 300.0 }\ntop = { temperature = 300.0 }";
    with_mesh(
        &body(
            "box = [4e-2, 1e-2, 1e-2]",
            material,
            300.0,
            faces,
            &(probe(
                "inside",
                [0.0, 0.0, -5e-3],
                "\"stress\", \"displacement\", \"plastic_strain\"",
            ) + rest),
        ),
        "spacing = 5e-3, depth_spacing = 5e-3, growth = 1.0",
    )
}

#[test]
fn a_held_bar_yields_when_heated_and_is_in_tension_when_cold_again() {
    for (method, material) in [("auto", STEEL), ("newton", STEEL)] {
        let mut trial = Trial::new(&bar(material, &format!("[solver]\nmethod = \"{method}\"\n")));
        // Inner steps of Newton's method leave some of the way to rest.
        let bound = if method == "auto" { 1e-6 } else { 1e-4 };
        let to = |trial: &mut Trial, temperature: f64| {
            trial.set("plate.top.temperature", temperature);
            trial.set("plate.bottom.temperature", temperature);
            (0..4).for_each(|_| trial.step(100.0));
            trial.get("inside.stress_xx")
        };
        // Yield at σ/(Eα) = 104.17 K; beyond it stress grows by EH/(E + H) of the strain.
        let (young, hardening, strain) = (200e9, 2e9, 1.2e-5);
        let elastic = to(&mut trial, 350.0);
        assert!(off(elastic, -young * strain * 50.0) < bound, "{elastic}");
        let plastic = young * strain * 300.0 - 250e6;
        let tangent = hardening / (young + hardening);
        let hot = to(&mut trial, 600.0);
        let wanted = -(250e6 + tangent * plastic);
        assert!(off(hot, wanted) < bound, "{method}: {hot} {wanted}");
        assert!(trial.heat_residual("plate") < 1e-9);
        let strained = trial.get("plate.max_plastic_strain");
        let accumulated = plastic / (young + hardening);
        assert!(off(strained, accumulated) < bound, "{strained}");
        assert!(off(trial.get("inside.plastic_strain"), accumulated) < bound);
        assert!(trial.get("plate.plastic_work") > 0.0);
        // Cooled it is elastic until tension yields at the hardened stress.
        let cold = to(&mut trial, 300.0);
        let residual: f64 = wanted + young * strain * 300.0;
        let limit = -wanted;
        let wanted = if residual > limit { limit + tangent * (residual - limit) } else { residual };
        assert!(off(cold, wanted) < bound, "{method}: {cold} {wanted}");
        let accumulated = accumulated + (residual - limit).max(0.0) / (young + hardening);
        assert!(off(trial.get("inside.plastic_strain"), accumulated) < bound);
        let fields = trial.fields("plate").plastic_strain;
        assert!(!fields.is_empty() && fields.iter().all(|p| off(*p, accumulated) < bound));
    }
}

#[test]
fn plastic_strain_is_that_of_the_layer_that_yields() {
    // A stack that is held sideways: each layer is a film of its own.
    let elastic = "model = \"thermoelastic\", density = 3950.0, specific_heat = 900.0, conductivity = 30.0, \
                   young = 300e9, poisson = 0.21, expansion = 8.1e-6";
    let lead = "model = \"elastoplastic\", density = 11340.0, specific_heat = 129.0, conductivity = 35.0, \
                young = 16e9, poisson = 0.44, expansion = 2.9e-5, yield_stress = 12e6, kinematic_hardening = 5e7";
    let all = "temperature = 295.0";
    let rest = probe("above", [0.0, 0.0, -1e-3], "\"plastic_strain\"")
        + &probe("below", [0.0, 0.0, -1e-3], "\"plastic_strain\"")
            .replace("gives", "side = \"below\"\ngives")
        + "[[field]]\nname = \"map\"\nin = \"plate\"\nplane = { x = 0.0 }\ngrid = [2, 2]\ngives = [\"plastic_strain\"]\n";
    for shape in ["box = [6e-3, 4e-3, 2e-3]", "disc = { radius = 3e-3, thickness = 2e-3 }"] {
        let faces = format!(
            "sides = {{ roller = true }}\nbottom = {{ roller = true, {all} }}\ntop = {{ {all} }}"
        );
        let text = body(shape, lead, 295.0, &faces, &rest).replace(
            &format!("material = {{ {lead} }}"),
            &format!(
                "layers = [{{ material = {{ {elastic} }}, thickness = 1e-3 }}, {{ material = {{ {lead} }}, thickness = 1e-3 }}]"
            ),
        );
        let text = with_mesh(&text, "spacing = 1e-3, depth_spacing = 5e-4, growth = 1.0");
        let mut trial = Trial::new(&text);
        for face in ["top", "bottom"] {
            trial.set(&format!("plate.{face}.temperature"), 355.0);
        }
        (0..3).for_each(|_| trial.step(10.0));
        // Beyond yield, 2Δe of plastic strain change stress by E/(1 − ν) and kinematic hardening by 2H of the part
        // along.
        let (modulus, strain) = (16e9 / 0.56, 2.9e-5 * 60.0);
        let part = (modulus * strain - 12e6) / (modulus + 2.0 * 5e7);
        let found = trial.get("below.plastic_strain");
        assert!(off(found, 2.0 * part) < 1e-6, "{shape}: {found} {}", 2.0 * part);
        assert_eq!(trial.get("above.plastic_strain"), 0.0);
        // Points of the grid at a quarter and three quarters of the height.
        assert!(off(trial.get("map.plastic_strain[1,1]"), 2.0 * part) < 1e-6);
        assert_eq!(trial.get("map.plastic_strain[2,2]"), 0.0);
        assert!(trial.heat_residual("plate") < 1e-9);
    }
}

#[test]
fn a_yield_stress_out_of_reach_leaves_a_body_elastic() {
    let glass = STEEL.replace("250e6", "1e13");
    let elastic = STEEL
        .replace("elastoplastic", "thermoelastic")
        .replace(", yield_stress = 250e6, isotropic_hardening = 2e9", "");
    let load = "[[load]]\nname = \"press\"\non = \"plate.top\"\nfootprint = { disc = { radius = 2e-3 } }\n\
                carries = [\"pressure\", \"shear\", \"heat_flux\"]\n\
                start = { pressure = 1e8, shear_x = 3e7, heat_flux = 1e6, x = 2e-3, y = 1e-3 }\n";
    let text = |material: &str, symmetry: &str| {
        let faces = "bottom = { clamped = true }";
        let text = body(
            "box = [2e-2, 1.6e-2, 6e-3]",
            material,
            300.0,
            faces,
            &format!(
                "{load}{}",
                probe("inside", [2e-3, 1e-3, -3e-3], "\"stress\", \"displacement\"")
            ),
        );
        let text = with_mesh(&text, "spacing = 1e-3, depth_spacing = 1e-3, growth = 1.5");
        text.replacen("initial_", &format!("symmetry = \"{symmetry}\"\ninitial_"), 1)
    };
    let mut one = Trial::new(&text(&glass, "auto"));
    let mut other = Trial::new(&text(&elastic, "none"));
    for trial in [&mut one, &mut other] {
        (0..2).for_each(|_| trial.step(0.2));
    }
    for key in ["displacement_x", "displacement_y", "displacement_z"] {
        let name = format!("inside.{key}");
        let (found, wanted) = (one.get(&name), other.get(&name));
        assert!(off(found, wanted) < 1e-8, "{name}: {found} {wanted}");
    }
    // Both recover stress from the same points, but not by the same polynomials.
    let scale = other.get("inside.von_mises");
    for key in ["stress_xx", "stress_yy", "stress_zz", "stress_xz", "von_mises"] {
        let name = format!("inside.{key}");
        let (found, wanted) = (one.get(&name), other.get(&name));
        assert!((found - wanted).abs() < 0.1 * scale, "{name}: {found} {wanted} {scale}");
    }
    assert_eq!(one.get("plate.max_plastic_strain"), 0.0);
}

#[test]
fn stress_counts_from_the_temperature_without_it() {
    // Held on all sides: σ = −Eα(T − T₀)/(1 − 2ν), whatever the temperature at time zero.
    let faces = "sides = { roller = true }\ntop = { roller = true }\nbottom = { roller = true }";
    for material in [
        STEEL.replace("250e6", "1e13"),
        STEEL
            .replace("elastoplastic", "thermoelastic")
            .replace(", yield_stress = 250e6, isotropic_hardening = 2e9", ""),
    ] {
        let text = body(
            "box = [2e-2, 2e-2, 1e-2]",
            &material,
            400.0,
            faces,
            &probe("inside", [1e-3, 2e-3, -3e-3], "\"stress\""),
        );
        let text = with_mesh(&text, "spacing = 5e-3, depth_spacing = 5e-3").replacen(
            "initial_",
            "stress_free_temperature = 300.0\ninitial_",
            1,
        );
        let mut trial = Trial::new(&text);
        trial.step(1.0);
        let wanted = -200e9 * 1.2e-5 * 100.0 / 0.4;
        for key in ["stress_xx", "stress_yy", "stress_zz"] {
            let found = trial.get(&format!("inside.{key}"));
            assert!(off(found, wanted) < 1e-9, "{key} {found} {wanted}");
        }
    }
}

#[test]
fn states_of_bodies_that_melt_and_yield_go_on_to_the_bit() {
    let material = STEEL.replace(
        "yield_stress = 250e6",
        "yield_stress = { temperature = [300.0, 900.0], value = [250e6, 40e6] }, \
         melting = { solidus = 1700.0, liquidus = 1750.0, latent_heat = 2.7e5 }",
    );
    let load = "[[load]]\nname = \"spot\"\non = \"plate.top\"\nfootprint = { gaussian = { radius = 1e-3 } }\n\
                carries = [\"heat_flux\"]\nstart = { heat_flux = 4e7 }\n";
    let text = with_mesh(
        &body(
            "disc = { radius = 6e-3, thickness = 2e-3 }",
            &material,
            300.0,
            "bottom = { clamped = true, convection = { coefficient = 1e3, ambient = 300.0 } }\n\
             top = { radiation = { emissivity = 0.4, ambient = 293.0 } }",
            &format!("{load}{}", probe("inside", [0.0, 0.0, -1e-3], "\"stress\", \"temperature\"")),
        ),
        "spacing = 4e-4, depth_spacing = 2e-4",
    );
    let mut trial = Trial::new(&text);
    trial.step(0.02);
    let saved = trial.state.clone();
    trial.step(0.02);
    let ahead = trial.state.clone();
    let mut other = Trial::on_threads(&text, 3);
    other.restart(&saved);
    other.step(0.02);
    assert_eq!(other.state, ahead);
    assert!(trial.get("plate.max_plastic_strain") > 0.0);
    assert!(trial.get("plate.liquid_volume") >= 0.0);
    assert!(trial.heat_residual("plate") < 1e-9);
    trial.model.check_state(&ahead).unwrap();
}

#[test]
fn parts_of_bodies_take_loads_that_are_even_alone() {
    let load = "[[load]]\nname = \"spot\"\non = \"plate.top\"\nfootprint = { disc = { radius = 2e-3 } }\n\
                carries = [\"heat_flux\", \"pressure\"]\nstart = { heat_flux = 1e5, pressure = 1e5 }\n";
    let text = body("box = [2e-2, 2e-2, 4e-3]", STEEL, 300.0, "bottom = { clamped = true }", load);
    let text = with_mesh(&text, "spacing = 2e-3, depth_spacing = 2e-3");
    let of = |symmetry: &str| {
        Trial::new(&text.replacen("initial_", &format!("symmetry = \"{symmetry}\"\ninitial_"), 1))
    };
    let (mut quarter, mut whole) = (of("quarter"), of("none"));
    for trial in [&mut quarter, &mut whole] {
        trial.step(0.1);
    }
    for name in ["plate.max_temperature", "plate.max_von_mises", "plate.heat_in"] {
        assert!(off(quarter.get(name), whole.get(name)) < 1e-6, "{name}");
    }
    let before = quarter.state.clone();
    quarter.set("spot.x", 1e-3);
    let refused = quarter.try_step(0.1).unwrap_err().to_string();
    assert!(refused.contains("plate") && refused.contains("even"), "{refused}");
    assert_eq!(quarter.state.bodies, before.bodies);
}

#[test]
fn a_body_that_yields_is_in_equilibrium_from_the_beginning() {
    // Copper that has cooled from 800 K, free but for its base or held along x.
    let material = "model = \"elastoplastic\", density = 8960.0, specific_heat = 385.0, conductivity = 400.0, \
                    young = 120e9, poisson = 0.34, expansion = 1.7e-5, yield_stress = 60e6";
    let of = |faces: &str| {
        let text = body(
            "box = [1e-2, 1e-2, 1e-2]",
            material,
            300.0,
            faces,
            &probe("inside", [0.0, 0.0, -5e-3], "\"stress\", \"displacement\""),
        );
        let text = with_mesh(&text, "spacing = 5e-3, depth_spacing = 5e-3").replacen(
            "initial_",
            "stress_free_temperature = 800.0\ninitial_",
            1,
        );
        Trial::new(&text)
    };
    let mut free =
        of("left = { roller = true }\nfront = { roller = true }\nbottom = { roller = true }");
    let mut held = of(
        "left = { roller = true }\nright = { roller = true }\nfront = { roller = true }\nbottom = { roller = true }",
    );
    for step in 0..2 {
        assert!(free.get("inside.stress_xx").abs() < 1.0);
        assert!(off(free.get("inside.displacement_z"), -1.7e-5 * 500.0 * 5e-3) < 1e-9, "{step}");
        assert!(off(held.get("inside.stress_xx"), 60e6) < 1e-9);
        assert!(off(held.get("plate.max_von_mises"), 60e6) < 1e-9);
        for trial in [&mut free, &mut held] {
            trial.step(1.0);
        }
    }
}

#[test]
fn no_part_of_a_body_bears_more_than_its_yield_stress() {
    // Lead on a default mesh, clamped below and heated in the middle.
    let material = "model = \"elastoplastic\", density = 11340.0, specific_heat = 129.0, conductivity = 35.0, \
                    young = 16e9, poisson = 0.44, expansion = 2.9e-5, yield_stress = 12e6, isotropic_hardening = 5e7";
    let load = "[[load]]\nname = \"spot\"\non = \"plate.top\"\nfootprint = { disc = { radius = 5e-4 } }\n\
                carries = [\"heat_flux\"]\nstart = { heat_flux = 3e6 }\n";
    let text = body(
        "disc = { radius = 3e-3, thickness = 1e-3 }",
        material,
        295.0,
        "bottom = { clamped = true }",
        &(load.to_owned() + &probe("inside", [0.0; 3], "\"stress\"")),
    );
    let mut trial = Trial::new(&text);
    (0..3).for_each(|_| trial.step(0.1));
    let strained = trial.get("plate.max_plastic_strain");
    let highest = trial.get("plate.max_von_mises");
    assert!(strained > 1e-4, "{strained}");
    let most = (12e6 + 5e7 * strained) * (1.0 + 1e-9);
    assert!((11.9e6..most).contains(&highest), "{highest} {strained}");
}

/// A plate that is held flat, heated by a pulse and left alone: a quarter deep it is warmest after the pulse, within
/// the second of two steps.
#[test]
fn a_moment_within_a_step_leaves_the_plastic_strain_that_it_makes() {
    let (flux, stop, thickness, depth) = (1.5e7, 40e-3, 1e-3, 0.25e-3);
    let body = Conductor { conductivity: 45.0, heat_capacity: 7800.0 * 500.0 };
    let slab = HeatedSlab { body, flux: 3.0 * flux, thickness };
    let rise = |time: f64| {
        let from = |begin: f64| {
            if time > begin { slab.rise_with_insulated_back(depth, time - begin) } else { 0.0 }
        };
        from(0.0) - from(0.5 * stop)
    };
    let warmest = (0..=400).map(|i| rise(stop * (0.5 + f64::from(i) / 800.0))).fold(0.0, f64::max);
    let law = Bilinear::film(200e9, 0.3, 250e6, 2e9, 0.0);
    let wanted = law.stresses(&[warmest, rise(stop)].map(|rise| -1.2e-5 * rise))[1];
    assert!(rise(0.5 * stop) < 0.98 * warmest);
    let faces = format!(
        "top = {{ flux = {:e} }}\nbottom = {{ roller = true }}\nsides = {{ roller = true }}",
        3.0 * flux
    );
    let shape = "disc = { radius = 5e-4, thickness = 1e-3 }";
    let text = body_of_pulse(shape, &faces, depth);
    for steps in [2, 8] {
        let mut trial = Trial::new(&text);
        for step in 0..steps {
            if 2 * step == steps {
                trial.set("plate.top.flux", 0.0);
            }
            trial.step(stop / f64::from(steps));
        }
        let error = (trial.get("inside.stress_xx") - wanted).abs() / 250e6;
        assert!(error < 0.02, "{steps} steps: {error}");
    }
}

fn body_of_pulse(shape: &str, faces: &str, depth: f64) -> String {
    let text = body(shape, STEEL, 300.0, faces, &probe("inside", [0.0, 0.0, -depth], "\"stress\""));
    let text = text.replace("stop_time = 1.0\nstep = 0.1", "stop_time = 40e-3\nstep = 1e-3");
    with_mesh(&text, "spacing = 2.5e-4, depth_spacing = 3e-5, growth = 1.0")
}

/// Neumann's front through a column: a mesh that is chosen keeps the tolerance over the later half of the time, and one
/// that does not says so at the end, by about as much as it errs.
#[test]
fn fronts_keep_the_tolerance_or_say_what_they_err_by() {
    let (melting, hot, stop) = (1000.0, 1500.0, 5e-3);
    let material = format!(
        "model = \"thermoelastic\", density = 7900.0, specific_heat = 500.0, conductivity = 15.0, \
         melting = {{ solidus = {melting:?}, liquidus = {melting:?}, latent_heat = 2e5 }}"
    );
    let steel = Conductor { conductivity: 15.0, heat_capacity: 7900.0 * 500.0 };
    let exact = |initial: f64| MeltingFront {
        new: steel,
        old: steel,
        latent: 7900.0 * 2e5,
        surface: hot - melting,
        initial: melting - initial,
    };
    let top = format!("top = {{ temperature = {hot:?} }}");
    let run = |mesh: &str, tolerance: f64, initial: f64| {
        let fidelity = format!("[fidelity]\ntolerance = {tolerance:e}\n");
        let text = body("box = [1e-4, 1e-4, 2.5e-4]", &material, initial, &top, &fidelity);
        let text = text.replace("stop_time = 1.0\nstep = 0.1", "stop_time = 5e-3\nstep = 5e-4");
        let text = if mesh.is_empty() { text } else { with_mesh(&text, mesh) };
        let mut trial = Trial::new(&text);
        let (mut worst, mut apart) = (0.0_f64, 0.0_f64);
        for step in 1..=40 {
            trial.step(stop / 40.0);
            let depth = trial.get("plate.liquid_volume") / 1e-8;
            if step > 20 {
                let exact = exact(initial).depth(trial.state.time);
                worst = worst.max(off(depth, exact));
                apart = apart.max((depth - exact).abs());
            }
        }
        let told = trial.model.closing_warnings(&trial.state);
        ([worst, apart], told.iter().map(ToString::to_string).collect::<Vec<_>>())
    };
    // Just below it, the sheet melts in traces all over.
    for initial in [melting, melting - 1e-5] {
        let ([error, _], told) = run("", 1e-2, initial);
        assert!(error < 1e-2 && told.is_empty(), "{error:e} {told:?}");
    }
    let coarse = "spacing = 5e-5, depth_spacing = 2e-5, growth = 1.0, order = 1";
    // Far below it, fronts wait between nodes.
    for initial in [300.0, 700.0, 900.0] {
        let ([_, apart], told) = run(coarse, 1e-3, initial);
        let of_node = apart / 2e-5;
        assert!(of_node < 0.4 && told.len() == 1, "{initial}: {of_node} {told:?}");
    }
    let ([error, _], told) = run(coarse, 1e-3, melting);
    assert!(error > 5e-3 && told.len() == 1, "{error:e} {told:?}");
    let said = told[0].split("is up to about ").nth(1).and_then(|rest| rest.split(' ').next());
    let said: f64 = said.unwrap().parse().unwrap();
    assert!((0.5..2.0).contains(&(0.01 * said / error)), "{error:e} {told:?}");
    assert!(told[0].contains("this mesh keeps a"), "{told:?}");
    let (_, told) = run(coarse, 5e-3, melting);
    assert!(told[0].contains("times as many elements where the front stands"), "{told:?}");
}

#[test]
fn only_melting_layers_count_in_the_liquid_volume() {
    let layer = |thickness: f64, melting: &str| {
        format!(
            "[[body.plate.layers]]\nthickness = {thickness:e}\nmaterial = {{ model = \"thermoelastic\", \
             density = 2700.0, specific_heat = 900.0, conductivity = 200.0{melting} }}\n"
        )
    };
    let [melts, stays] =
        [", melting = { solidus = 900.0, liquidus = 930.0, latent_heat = 4e5 }", ""];
    for layers in [
        vec![(2e-5, melts), (5.98e-3, stays)],
        vec![(2e-3, stays), (2e-5, melts), (1e-3, stays)],
        vec![(3e-3, melts), (3e-3, melts)],
    ] {
        let all: String = layers.iter().map(|(own, melting)| layer(*own, melting)).collect();
        let text = format!(
            "name = \"Body\"\nstop_time = 1.0\nstep = 0.1\n[body.plate]\nkind = \"solid\"\n\
             shape = {{ disc = {{ radius = 1e-2, thickness = {:e} }} }}\ninitial_temperature = 1000.0\n\
             faces.top.flux = 0.0\n{all}",
            layers.iter().map(|(own, _)| own).sum::<f64>()
        );
        let mut trial = Trial::new(&text);
        trial.step(1.0);
        let depth: f64 = layers.iter().filter(|(_, own)| *own == melts).map(|(own, _)| own).sum();
        let wanted = std::f64::consts::PI * 1e-4 * depth;
        assert!(off(trial.get("plate.liquid_volume"), wanted) < 1e-9, "{layers:?}");
    }
}
