//! Meshes follow from the tolerance, and what outputs err by is told.

#[path = "../common/random_scenes.rs"]
#[allow(dead_code)]
mod random_scenes;

use crate::common::{Trial, off};
use impinge::closed_form::{Conductor, DiscFlux, UniformFlux};
use impinge::fmi::guid::guid;
use impinge::model::tolerance::{self, BodyEstimate, estimates, packed_text};
use impinge::model::{Model, forecast};
use impinge::scene::{Scene, parse};
use impinge::variables::Registry;
use random_scenes::{outcome, random_scene};

fn warnings(scene: &Scene, estimates: &[BodyEstimate]) -> Vec<String> {
    tolerance::warnings(scene, estimates).iter().map(ToString::to_string).collect()
}

/// Material constants from mercury to aerogel: ρ [kg/m³], c [J/(kg K)], k [W/(m K)].
const MATERIALS: [[f64; 3]; 6] = [
    [13534.0, 140.0, 8.5],
    [8960.0, 385.0, 398.0],
    [3950.0, 900.0, 30.0],
    [6000.0, 450.0, 2.5],
    [1180.0, 1450.0, 0.19],
    [10.0, 1000.0, 0.015],
];

fn plate(shape: &str, [density, heat, conductivity]: [f64; 3], rest: &str) -> String {
    format!(
        "name = \"Plate\"\nstop_time = 1.0\nstep = 0.05\n[body.plate]\nkind = \"solid\"\nshape = {{ {shape} }}\nmaterial = \
         {{ model = \"thermoelastic\", density = {density:?}, specific_heat = {heat:?}, conductivity = {conductivity:?}, \
         young = 1e11, poisson = 0.3, expansion = 1e-5 }}\ninitial_temperature = 300.0\n{rest}"
    )
}

fn probe(gives: &str) -> String {
    format!("[[probe]]\nname = \"p\"\nin = \"plate\"\nat = [0.0, 0.0, 0.0]\ngives = [{gives}]\n")
}

fn scene(text: &str) -> Scene {
    parse(text, "scene").unwrap_or_else(|error| panic!("{error}\n{text}"))
}

#[test]
fn random_scenes_keep_their_tolerance() {
    for seed in [0, 3, 5, 8, 12, 15, 23] {
        let drawn = random_scene(seed, false);
        for tolerance in [1e-1, 1e-2] {
            let found = outcome(&drawn, tolerance).unwrap();
            assert!(found.estimated <= tolerance, "{}", drawn.words);
            assert!(found.found <= tolerance, "{}: {:e}", drawn.words, found.found);
        }
    }
}

/// Surroundings of 2000 K warm a half space by 3 K, which its flux does not feel: `2q√(t/(πkρc))`.
#[test]
fn a_face_that_radiates_and_nothing_else_keeps_the_tolerance() {
    for material in MATERIALS {
        let [density, heat, conductivity] = material;
        let (rise, flux) = (3.0, 0.9 * 5.670374e-8 * (2000f64.powi(4) - 300f64.powi(4)));
        let time =
            std::f64::consts::PI * conductivity * density * heat * (0.5 * rise / flux).powi(2);
        let thickness = 12.0 * (conductivity * time / (density * heat)).sqrt();
        let radiates =
            "[body.plate.faces]\ntop = { radiation = { emissivity = 0.9, ambient = 2000.0 } }\n";
        let text = plate(&format!("box = [1.0, 1.0, {thickness:?}]"), material, radiates)
            .replace("stop_time = 1.0", &format!("stop_time = {time:?}"))
            .replace("step = 0.05", &format!("step = {:?}", time / 20.0));
        let mut trial = Trial::new(&(text + &probe("\"temperature\"")));
        (0..20).for_each(|_| trial.step(time / 20.0));
        let found = trial.get("p.temperature") - 300.0;
        assert!(off(found, rise) < 0.01, "{material:?}: {found}");
        let estimate = trial.get("plate.estimated_error");
        assert!(estimate > 0.0 && estimate <= 1e-2, "{material:?}: {estimate}");
        assert!(trial.heat_residual("plate") < 1e-9);
    }
}

#[test]
fn a_half_space_keeps_the_tolerance_that_is_asked_for_by_the_closed_form() {
    for material in MATERIALS {
        let [density, heat, conductivity] = material;
        let body = Conductor { conductivity, heat_capacity: density * heat };
        // Deep enough for nothing to reach the bottom.
        let thickness = 12.0 * (conductivity / (density * heat)).sqrt();
        let exact = UniformFlux { body, flux: 1e3 };
        for tolerance in [1e-1, 1e-2, 1e-3] {
            let faces = "[body.plate.faces]\ntop = { flux = 1e3 }\n";
            let shape = format!("box = [1.0, 1.0, {thickness:e}]");
            let fidelity = format!("[fidelity]\ntolerance = {tolerance:e}\n");
            let rest = format!("{faces}{}{fidelity}", probe("\"temperature\""));
            let mut trial = Trial::new(&plate(&shape, material, &rest));
            let range = exact.rise(0.0, 1.0);
            for step in 1..=20 {
                trial.step(0.05);
                let rise = trial.get("p.temperature") - 300.0;
                let error = (rise - exact.rise(0.0, 0.05 * f64::from(step))).abs() / range;
                assert!(error <= tolerance, "{material:?} {tolerance:e}: {error:e}");
            }
            assert!(trial.heat_residual("plate") < 1e-9);
            let told = trial.get("plate.estimated_error");
            assert!(told > 0.0 && told <= tolerance, "{told:e}");
        }
    }
}

#[test]
fn a_column_is_one_element_along_the_surface_and_exact() {
    let sides = "bottom = { temperature = 350.0, roller = true }\nsides = { roller = true }\n";
    for shape in ["box = [2e-3, 1e-3, 1e-3]", "disc = { radius = 1e-3, thickness = 1e-3 }"] {
        let text = |mesh: &str| {
            let faces = format!("{mesh}[body.plate.faces]\ntop = {{ flux = 1e5 }}\n{sides}");
            let fixed = "[refinement.plate]\nalong = 1.0\nthrough = 1.0\n";
            let probes = probe("\"temperature\", \"stress\", \"displacement\"");
            plate(shape, MATERIALS[2], &format!("{faces}{probes}{fixed}"))
        };
        let column = scene(&text(""));
        let nodes = forecast(&column).bodies[0].nodes;
        assert_eq!([nodes[0], nodes[1].min(3)], [3, nodes[1].min(3)], "{nodes:?}");
        let depth = forecast(&column).bodies[0].spacing[2][0];
        let own = format!("mesh = {{ spacing = 2e-4, depth_spacing = {depth:e}, growth = 1.4 }}\n");
        let (mut column, mut whole) = (Trial::of(column), Trial::new(&text(&own)));
        let mut fine = Trial::new(&text("").replace("through = 1.0", "through = 4.0"));
        for _ in 0..5 {
            [&mut column, &mut whole, &mut fine].into_iter().for_each(|trial| trial.step(0.02));
            for name in ["p.temperature", "p.stress_xx", "p.displacement_z"] {
                let [one, all, fine] = [&mut column, &mut whole, &mut fine].map(|t| t.get(name));
                assert!(
                    off(one, all) < 1e-3 && off(one, fine) < 1e-3,
                    "{name}: {one} {all} {fine}"
                );
            }
            // Held along the surface, it bears −EαΔT/(1 − ν).
            let rise = column.get("p.temperature") - 300.0;
            let wanted = -1e11 * 1e-5 * rise / 0.7;
            assert!(off(column.get("p.stress_xx"), wanted) < 1e-6);
        }
        assert!(column.heat_residual("plate") < 1e-9);
    }
}

#[test]
fn a_mesh_too_coarse_is_warned_of_with_one_that_keeps_the_tolerance() {
    let load = "[[load]]\nname = \"spot\"\non = \"plate.top\"\nfootprint = { gaussian = { radius = 1e-3 } }\n\
                carries = [\"heat_flux\"]\nstart = { heat_flux = 1e6 }\n";
    let text = |mesh: &str| {
        let probes = probe("\"temperature\"");
        let disc = "disc = { radius = 1e-2, thickness = 5e-3 }";
        plate(disc, MATERIALS[3], &format!("mesh = {{ {mesh} }}\n{load}{probes}"))
    };
    let told = |mesh: &str| {
        let (scene, estimates) = estimates(&scene(&text(mesh)));
        (warnings(&scene, &estimates), estimates[0].worst().unwrap())
    };
    let (warned, error) = told("spacing = 2e-3");
    assert!(warned.len() == 1 && error > 0.1, "{warned:?} {error}");
    // With the keys that it names it is as good as asked for, but for rounding of these numbers.
    let keys: Vec<&str> = warned[0].split('`').skip(1).step_by(2).collect();
    let keys: Vec<&str> = keys.iter().filter_map(|key| key.strip_prefix("mesh.")).collect();
    assert!(!keys.is_empty(), "{warned:?}");
    let (_, error) = told(&keys.join(", "));
    assert!(error < 1.5e-2, "{keys:?}: {error}");
    let (warned, error) = told("");
    assert!(warned.is_empty() && error <= 1e-2, "{warned:?} {error}");
}

#[test]
fn a_packed_scene_neither_chooses_nor_estimates_anew() {
    let text = random_scene(8, false).text;
    let scene = scene(&text);
    let (known, estimates) = estimates(&scene);
    let packed = packed_text(&scene, &text, &known);
    let again = parse(&packed, "scene").unwrap();
    assert_eq!(again.refinement["plate"].factors(), known.refinement["plate"].factors());
    let error = estimates[0].worst().unwrap();
    let mut trial = Trial::of(again.clone());
    assert!(off(trial.get("plate.estimated_error"), error) < 1e-12);
    let registry = Registry::of(&scene);
    assert_eq!(guid(&text, &registry), guid(&packed, &registry));
    let nodes = |scene: &Scene| Model::build(scene, 1).unwrap().initial_state().bodies[0].len();
    assert_eq!(nodes(&scene), nodes(&again));
}

#[test]
fn particles_have_no_estimate_and_say_so() {
    let text = plate(
        "box = [1e-3, 1e-3, 1e-3]",
        MATERIALS[1],
        "heat = \"sph\"\nmesh = { spacing = 1e-4, growth = 1.0 }\n[body.plate.faces]\ntop = { flux = 1e3 }\n",
    );
    let (known, found) = estimates(&scene(&text));
    assert!(found[0].worst().is_none() && !found[0].notes.is_empty(), "{found:?}");
    assert_eq!(Trial::of(known).get("plate.estimated_error"), -1.0);
}

/// Where a mesh is so coarse that no coarser one tells what it errs by, a finer one does.
#[test]
fn meshes_that_cannot_get_coarser_are_judged() {
    // Mercury under a disc of flux; the thickness is all but one element.
    let (radius, flux, stop) = (2e-4, 4.25e6, 1e-3);
    for material in [MATERIALS[0], MATERIALS[2], MATERIALS[4]] {
        let [density, heat, conductivity] = material;
        let body = Conductor { conductivity, heat_capacity: density * heat };
        let load = format!(
            "[[load]]\nname = \"spot\"\non = \"plate.top\"\nfootprint = {{ disc = {{ radius = {radius:e} }} }}\n\
             carries = [\"heat_flux\"]\nstart = {{ heat_flux = {flux:e} }}\n"
        );
        let text = |depth: &str| {
            let disc = "disc = { radius = 4e-3, thickness = 4e-3 }";
            let mesh = format!("mesh = {{ {depth} }}\n");
            plate(disc, material, &format!("{mesh}{load}{}", probe("\"temperature\"")))
                .replace("stop_time = 1.0\nstep = 0.05", "stop_time = 1e-3\nstep = 1e-4")
        };
        let exact = DiscFlux { body, flux, radius }.rise_on_axis(0.0, stop);
        for depth in ["depth_spacing = 6e-4", "depth_spacing = 1e-3"] {
            let scene = scene(&text(depth));
            let (_, found) = estimates(&scene);
            let mut trial = Trial::of(scene.clone());
            (0..10).for_each(|_| trial.step(1e-4));
            let error = (trial.get("p.temperature") - 300.0 - exact).abs() / exact;
            let told = found[0].worst().unwrap();
            assert!(error > 1e-2 && told > 0.5 * error, "{material:?} {depth}: {told} {error}");
        }
    }
    // A column of one linear element.
    for top in ["flux = 1e3", "temperature = 350.0"] {
        let faces = format!("[body.plate.faces]\ntop = {{ {top} }}\n");
        let mesh = "mesh = { depth_spacing = 1e-2, order = 1 }\n";
        let probes = probe("\"temperature\"").replace("0.0]", "-5e-3]");
        let shape = "box = [1e-2, 1e-2, 1e-2]";
        let text = |mesh: &str| {
            plate(shape, MATERIALS[4], &format!("{mesh}{faces}{probes}"))
                .replace("stop_time = 1.0\nstep = 0.05", "stop_time = 100.0\nstep = 5.0")
        };
        let (_, found) = estimates(&scene(&text(mesh)));
        let (mut coarse, mut fine) = (Trial::new(&text(mesh)), Trial::new(&text("")));
        let (mut error, mut range) = (0.0_f64, 0.0_f64);
        for _ in 0..20 {
            [&mut coarse, &mut fine].into_iter().for_each(|trial| trial.step(5.0));
            let [value, wanted] = [&mut coarse, &mut fine].map(|t| t.get("p.temperature"));
            (error, range) = (error.max((value - wanted).abs()), range.max((wanted - 300.0).abs()));
        }
        let told = found[0].worst().unwrap();
        assert!(told > 0.5 * (error / range).min(1.0), "{top}: {told} {error} {range}");
    }
}

/// A plate on a coarse mesh of its own between a hot reservoir and a weak flux: the estimate is that of what the
/// reservoir brings.
#[test]
fn estimates_count_what_bodies_in_contact_bring() {
    let rest = "[body.chuck]\nkind = \"reservoir\"\nheat_capacity = 1e9\ninitial_temperature = 900.0\n[[coupling]]\n\
                from = \"chuck.top\"\nto = \"plate.bottom\"\nconductance = 1e5\n";
    let text = |depth_spacing: f64| {
        let mesh = format!(
            "mesh = {{ spacing = 5e-4, depth_spacing = {depth_spacing:e}, growth = 1.0 }}\n"
        );
        let faces = "[body.plate.faces]\ntop = { flux = 1.0 }\n";
        let probes = probe("\"temperature\"").replace("0.0]", "-0.5e-3]");
        plate(
            "box = [4e-3, 4e-3, 1e-3]",
            [2000.0, 500.0, 1.0],
            &format!("{mesh}{faces}{rest}{probes}"),
        )
        .replace("step = 0.05", "step = 0.1")
    };
    let (_, found) = estimates(&scene(&text(5e-4)));
    let told = found.iter().find(|one| one.body == "plate").and_then(BodyEstimate::worst).unwrap();
    let (mut coarse, mut fine) = (Trial::new(&text(5e-4)), Trial::new(&text(2e-5)));
    let (mut error, mut range) = (0.0_f64, 0.0_f64);
    for _ in 0..10 {
        [&mut coarse, &mut fine].into_iter().for_each(|trial| trial.step(0.1));
        let [value, wanted] = [&mut coarse, &mut fine].map(|trial| trial.get("p.temperature"));
        (error, range) = (error.max((value - wanted).abs()), range.max(wanted - 300.0));
    }
    assert!(error > 0.01 * range, "{error} of {range}");
    assert!(told > 0.5 * error / range && told < 20.0 * error / range, "{told} {error} {range}");
}

/// What a disc with a spot and a probe of temperature asks for, with more said of the plate, its probe and the scene.
fn spotted(plate_says: &str, gives: &str, says: &str) -> Scene {
    let load = "[[load]]\nname = \"spot\"\non = \"plate.top\"\nfootprint = { gaussian = { radius = 1e-3 } }\n\
                carries = [\"heat_flux\"]\nstart = { heat_flux = 1e6 }\n";
    let disc = "disc = { radius = 1e-2, thickness = 5e-3 }";
    scene(&plate(disc, MATERIALS[3], &format!("{plate_says}\n{load}{}{says}", probe(gives))))
}

#[test]
fn reduced_solids_get_the_meshes_of_full_ones() {
    let of = |level: &str| {
        let says = format!("[fidelity]\nlevel = \"{level}\"\n");
        estimates(&spotted("", "\"temperature\"", &says)).0.refinement["plate"]
    };
    assert_eq!(of("reduced"), of("full"));
}

/// A face that keeps its temperature is no experiment of its own where something else happens.
#[test]
fn ambients_at_rest_take_no_finer_mesh() {
    let faces = |bottom: &str| format!("[body.plate.faces]\nbottom = {{ {bottom} }}\n");
    let of = |bottom: &str| {
        let known = estimates(&spotted(&faces(bottom), "\"temperature\"", "")).0;
        known.refinement["plate"].factors()
    };
    assert_eq!(
        of("convection = { coefficient = 1e4, ambient = 300.0 }"),
        of("convection = { coefficient = 1e4, ambient = 300.0 }, role = \"parameter\"")
    );
}

/// Extremes of stress may lie at edges where no mesh finds them: they count where running maxima ask for them.
#[test]
fn extremes_of_stress_count_where_they_are_asked_for() {
    let names = |peaks: &str| {
        let held = "[body.plate.faces]\nbottom = { clamped = true }\n";
        let says = format!("{peaks}\n{held}");
        let (_, found) = estimates(&spotted(&says, "\"temperature\", \"von_mises\"", ""));
        found[0].outputs.iter().map(|one| one.name.clone()).collect::<Vec<_>>()
    };
    let has_extreme = |names: &[String]| names.iter().any(|name| name == "plate.max_von_mises");
    let plain = names("");
    assert!(!has_extreme(&plain), "{plain:?}");
    assert!(has_extreme(&names("peaks = [\"von_mises\"]")));
    assert!(plain.iter().any(|name| name == "plate.max_temperature"));
}

/// The centre of a spot that gets smaller than it starts, against a mesh twice as fine for the small one alone.
#[test]
fn meshes_serve_the_whole_range_of_a_radius() {
    let small = 3e-4;
    let text = |keys: &str| {
        let load = format!(
            "[[load]]\nname = \"spot\"\non = \"plate.top\"\nfootprint = {{ gaussian = {{ radius = 2e-3 }} }}\n\
             carries = [\"heat_flux\"]\nstart = {{ heat_flux = 1e6 }}\n{keys}"
        );
        let disc = "disc = { radius = 8e-3, thickness = 3e-3 }";
        plate(disc, MATERIALS[3], &format!("{load}{}", probe("\"temperature\"")))
    };
    let rise = |mut trial: Trial| {
        trial.set("spot.radius", small);
        (0..20).for_each(|_| trial.step(0.05));
        trial.get("p.temperature") - 300.0
    };
    let (ranged, found) = estimates(&scene(&text("range = { radius = [3e-4, 2e-3] }\n")));
    let note = "in the estimate loads are tried at the lower ends of their ranges of radius, too";
    assert!(found[0].notes.iter().any(|said| said == note), "{:?}", found[0].notes);
    let fine = "[refinement.plate]\nalong = 2.0\nthrough = 2.0\n";
    let wanted = rise(Trial::new(&text(fine).replace("radius = 2e-3", "radius = 3e-4")));
    let error = off(rise(Trial::of(ranged)), wanted);
    assert!(error < 5e-3, "{error:e}");
}

#[test]
fn linear_elements_that_lock_are_told_to_be_quadratic() {
    let told = |poisson: &str, order: usize| {
        let load = "[[load]]\nname = \"spot\"\non = \"plate.top\"\nfootprint = { disc = { radius = 1e-3 } }\n\
                    carries = [\"pressure\"]\nstart = { pressure = 1e6 }\n";
        let mesh = format!("mesh = {{ spacing = 2.5e-4, order = {order} }}\n");
        let held = "[body.plate.faces]\nbottom = { clamped = true }\n";
        let probes = probe("\"stress\"").replace("0.0]", "-8e-4]");
        let disc = "disc = { radius = 4e-3, thickness = 4e-3 }";
        let text = plate(disc, MATERIALS[3], &format!("{mesh}{held}{load}{probes}"));
        let (scene, found) = estimates(&scene(&text.replace("poisson = 0.3", poisson)));
        warnings(&scene, &found)
    };
    let said = told("poisson = 0.4999", 1);
    assert!(said.len() == 1 && said[0].contains("`mesh.order = 2` would"), "{said:?}");
    for (poisson, order) in [("poisson = 0.3", 1), ("poisson = 0.4999", 2)] {
        let said = told(poisson, order);
        assert!(said.iter().all(|said| !said.contains("mesh.order")), "{said:?}");
    }
}

#[test]
fn reduced_solids_are_not_said_to_err_in_what_they_do_not_tell() {
    let names = |level: &str| {
        let says = format!("[fidelity]\nlevel = \"{level}\"\n");
        let scene = spotted("", "\"temperature\"", &says);
        let offered = Registry::of(&scene);
        let outputs = estimates(&scene).1.remove(0).outputs;
        assert!(outputs.iter().all(|one| offered.find(&one.name).is_some()), "{outputs:?}");
        outputs.len()
    };
    assert!((1..names("full")).contains(&names("reduced")));
}

/// What is beyond all tolerance is told without figures that mean nothing, and asks for no mesh that nobody can afford.
#[test]
fn errors_as_large_as_the_range_name_a_mesh_to_go_on_from() {
    let (scene, mut found) = estimates(&spotted("", "\"temperature\"", ""));
    let own = scene.refinement["plate"].factors();
    (found[0].outputs[0].along, found[0].outputs[0].through) = (1.48, 0.0);
    let said = warnings(&scene, &found);
    assert!(said.len() == 1 && said[0].contains("is about its whole range or more"), "{said:?}");
    let next = format!("with along = {:.2}, through = {:.2}", 2.0 * own[0], own[1]);
    assert!(said[0].contains(&next) && said[0].contains("would show which"), "{said:?} {next}");
}

/// Newton's method advances heat on linear elements, which err by ten times as much as quadratic ones under a smooth
/// flux; what outputs err by is judged by these, too.
#[test]
fn estimates_of_heat_by_newtons_method_are_those_of_its_elements() {
    let of = |solver: &str, mesh: &str| {
        scene(&format!(
            "name = \"Disc\"\nstop_time = 2e-2\nstep = 1e-3\n{solver}[body.b]\nkind = \"solid\"\nshape = {{ disc = {{ radius \
             = 4e-3, thickness = 0.5e-3 }} }}\nmaterial = {{ model = \"thermoelastic\", density = 5320.0, specific_heat = \
             320.0, conductivity = 60.0, young = 103e9, poisson = 0.26, expansion = 5.9e-6 }}\ninitial_temperature = \
             300.0\n{mesh}[body.b.faces]\nbottom = {{ convection = {{ coefficient = 500.0, ambient = 290.0 }}, roller = \
             true }}\n[[load]]\nname = \"g\"\non = \"b.top\"\nfootprint = {{ gaussian = {{ radius = 0.5e-3 }} }}\ncarries = \
             [\"heat_flux\"]\nstart = {{ heat_flux = 2e6 }}\n[[probe]]\nname = \"c\"\nin = \"b\"\nat = [0.3e-3, 0.0, \
             -0.1e-3]\ngives = [\"temperature\", \"stress\"]\n"
        ))
    };
    let own = of(
        "solver = { method = \"newton\" }\n",
        "mesh = { spacing = 50e-6, depth_spacing = 40e-6 }\n",
    );
    let fine = of("fidelity = { tolerance = 1e-4 }\n", "");
    let read = |scene: &Scene| {
        let mut trial = Trial::of(scene.clone());
        (0..20).for_each(|_| trial.step(1e-3));
        ["c.temperature", "c.stress_xx"].map(|name| trial.get(name))
    };
    let (found, exact) = (read(&own), read(&fine));
    let ranges = [exact[0] - 300.0, exact[1]].map(f64::abs);
    let (_, told) = estimates(&own);
    for (place, name) in ["c.temperature", "c.stress_xx"].into_iter().enumerate() {
        let error = (found[place] - exact[place]).abs() / ranges[place];
        let told = told[0].outputs.iter().find(|one| one.name == name).unwrap().total();
        assert!(error > 1e-3 && told > error && told < 8.0 * error, "{name}: {told} {error}");
    }
}

/// A pad that covers a face takes few nodes beside a small spot.
/// Places of a square field that stand for all of it lie in many of its rows and columns.
#[test]
fn fields_are_judged_all_over() {
    for size in [15, 16, 32] {
        let text = plate(
            "disc = { radius = 2e-3, thickness = 0.5e-3 }",
            [2700.0, 900.0, 200.0],
            &format!(
                "[[load]]\nname = \"spot\"\non = \"plate.top\"\ncarries = [\"heat_flux\"]\n\
                 footprint = {{ gaussian = {{ radius = 3e-4 }} }}\nstart = {{ heat_flux = 1e6 }}\n\
                 [[field]]\nname = \"map\"\non = \"plate.top\"\ngrid = [{size}, {size}]\n\
                 gives = [\"temperature\"]\n"
            ),
        );
        let (_, found) = estimates(&scene(&text));
        let of_field = |name: &str| name.strip_prefix("map.temperature[").map(str::to_owned);
        let places: Vec<String> =
            found[0].outputs.iter().filter_map(|one| of_field(&one.name)).collect();
        for axis in [0, 1] {
            let along = |place: &String| {
                place.trim_end_matches(']').split(',').nth(axis).map(str::to_owned)
            };
            let lines: std::collections::BTreeSet<_> = places.iter().filter_map(along).collect();
            assert!(lines.len() >= 6, "{size}: {places:?}");
        }
    }
}

/// A face that hardly radiates takes Newton's method, and so linear elements on all nodes; layers keep their thickness.
#[test]
fn layers_that_radiate_are_judged_like_those_that_do_not() {
    let of = |radiation: &str| {
        let text = format!(
            "name = \"Layers\"\nstop_time = 2e-3\nstep = 2e-4\n[body.plate]\nkind = \"solid\"\n\
             shape = {{ box = [1e-4, 1e-4, 0.5e-3] }}\ninitial_temperature = 300.0\n\
             layers = [\n{{ material = {{ model = \"thermoelastic\", density = 3510.0, specific_heat = 510.0, \
             conductivity = 1000.0 }}, thickness = 0.02e-3 }},\n{{ material = {{ model = \"thermoelastic\", \
             density = 1190.0, specific_heat = 1470.0, conductivity = 0.19 }}, thickness = 0.48e-3 }}]\n\
             mesh = {{ spacing = 5e-5, depth_spacing = 5e-6, growth = 1.4 }}\n\
             faces.bottom = {{ temperature = 300.0 }}\nfaces.top = {{ flux = 1e5{radiation} }}\n\
             [[probe]]\nname = \"top\"\nin = \"plate\"\nat = [0.0, 0.0, 0.0]\ngives = [\"temperature\"]\n"
        );
        let (_, found) = estimates(&scene(&text));
        found[0].worst().unwrap()
    };
    let [without, with] = ["", ", radiation = { emissivity = 1e-3, ambient = 300.0 }"].map(of);
    assert!(with < 5e-3 && without < 1e-3, "{with:e} {without:e}");
}

#[test]
fn a_wide_load_beside_a_small_one_keeps_its_own_fineness() {
    let of = |load: &str| {
        let spot = "[[load]]\nname = \"spot\"\non = \"plate.top\"\nfootprint = { disc = { radius = 1e-4 } }\ncarries = \
                    [\"heat_flux\"]\n";
        let text = plate("box = [1e-2, 1e-2, 1e-3]", MATERIALS[2], &(spot.to_owned() + load));
        forecast(&scene(&(text + &probe("\"temperature\"")))).bodies[0].unknowns[0] as f64
    };
    let pad = "[[load]]\nname = \"pad\"\non = \"plate.bottom\"\nfootprint = { tiles = { count = [1, 1], size = [1e-2, 1e-2] } \
               }\ncarries = [\"heat_flux\"]\n";
    let (alone, both) = (of(""), of(pad));
    assert!(both < 4.0 * alone, "{both} nodes beside {alone}");
}

/// By the end of a short pulse the highest temperature overshoots at the edge of a footprint, on every mesh alike, and
/// nowhere if the footprint covers its face.
#[test]
fn overshoot_at_edges_is_part_of_the_estimate() {
    let error_of_highest = |footprint: &str| {
        let scene = format!(
            r#"
name = "Pulse"
stop_time = 1e-8
step = 1e-9
[body.disc]
kind = "solid"
shape.disc = {{ radius = 1e-2, thickness = 2e-3 }}
material = {{ model = "thermoelastic", density = 7850.0, specific_heat = 470.0, conductivity = 45.0 }}
initial_temperature = 300.0
[[load]]
name = "flash"
on = "disc.top"
footprint = {{ {footprint} }}
carries = ["heat_flux"]
start.heat_flux = 1e10
"#
        );
        let scene = parse(&scene, "scene.toml").unwrap();
        let (_, found) = tolerance::estimates(&scene);
        let highest = found[0].outputs.iter().find(|one| one.name == "disc.max_temperature");
        highest.unwrap().total()
    };
    assert!(error_of_highest("disc = { radius = 1e-3 }") > 0.08);
    assert!(error_of_highest("ring = { inner = 5e-3, outer = 1e-2 }") > 0.08);
    for whole in ["disc = { radius = 1e-2 }", "rings = { count = 1, radius = 1e-2 }"] {
        assert!(error_of_highest(whole) < 0.02, "{whole}");
    }
    assert!(error_of_highest("gaussian = { radius = 1e-3 }") < 0.02);
}

/// The core of a plate whose face cools suddenly changes by a ten thousandth of what its face does: the error of its
/// temperature counts beside the change of the body's mean.
#[test]
fn temperatures_of_a_core_count_beside_the_mean() {
    let faces = "[body.plate.faces]\ntop = { convection = { coefficient = 6e4, ambient = 280.0 } }\n\
                 sides = { roller = true }\nbottom = { roller = true }\n";
    let mesh = "mesh = { spacing = 5e-4, depth_spacing = 6e-5, growth = 1.0 }\n";
    let text = plate("box = [1e-3, 1e-3, 4e-3]", MATERIALS[2], &format!("{mesh}{faces}"));
    let text = text.replace("stop_time = 1.0\nstep = 0.05", "stop_time = 0.06\nstep = 2e-3");
    let scene = scene(&text.replace("initial_temperature = 300.0", "initial_temperature = 600.0"));
    let (_, estimates) = estimates(&scene);
    let found = estimates[0].outputs.iter().find(|output| output.name == "plate.max_temperature");
    let error = found.unwrap().total();
    let mut trial = Trial::of(scene);
    (0..30).for_each(|_| trial.step(2e-3));
    let (core, mean) =
        (600.0 - trial.get("plate.max_temperature"), -trial.get("plate.heat_stored"));
    let mean = mean / (3950.0 * 900.0 * 4e-9);
    assert!(core < 1e-3 * mean && core > 1e-9, "{core} {mean}");
    assert!(error < 1e-2, "{error}");
}
