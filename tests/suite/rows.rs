//! Readings by influence rows: the values of a solution, the same in any order, and their derivatives.

use crate::common::{Trial, off};
use crate::layers::{AEROGEL, ALUMINA, COPPER, DIAMOND, LEAD, PTFE, Row, material};
use impinge::closed_form::{DiscPressure, Elastic};

/// Communication steps of an experiment that is worth rows, and of one that is not.
const MANY: f64 = 1000.0;
const FEW: f64 = 1.0;

/// Elements along the surface twice as wide as the other keys say: rows are solutions on any mesh.
const COARSE: &str = "[refinement.b]\nalong = 0.5\nthrough = 1.0";

/// Loads of every footprint, off all planes of symmetry, and readings at points and over cells. Lengths in units of
/// `unit`; `heat` and `force` scale fluxes and tractions.
fn loads_and_readings([unit, heat, force]: [f64; 3]) -> String {
    let l = |value: f64| value * unit;
    format!(
        r#"
{COARSE}
[[load]]
name = "spot"
on = "b.top"
footprint = {{ disc = {{ radius = {:?} }} }}
carries = ["heat_flux", "pressure", "shear"]
start = {{ heat_flux = {:?}, pressure = {:?}, shear_x = {:?}, shear_y = {:?}, x = {:?}, y = {:?} }}
[[load]]
name = "wheel"
on = "b.bottom"
footprint = {{ rings = {{ count = 2, radius = {:?} }} }}
carries = ["shear", "pressure", "heat_flux"]
start = {{ shear_r = [{:?}, {:?}], pressure = {:?}, heat_flux = [{:?}, {:?}], x = {:?}, y = {:?} }}
[[load]]
name = "patch"
on = "b.top"
footprint = {{ tiles = {{ count = [2, 1], size = [{:?}, {:?}] }} }}
carries = ["heat_flux", "pressure"]
start = {{ heat_flux = [[{:?}], [{:?}]], pressure = [[{:?}], [{:?}]], x = {:?}, y = {:?} }}
[[probe]]
name = "p"
in = "b"
at = [{:?}, {:?}, {:?}]
gives = ["temperature", "stress", "max_principal", "displacement"]
[[probe]]
name = "image"
in = "b"
at = [{:?}, {:?}, {:?}]
gives = ["von_mises", "stress", "displacement"]
[[probe]]
name = "centre"
in = "b"
at = [0.0, 0.0, 0.0]
gives = ["stress", "displacement"]
[[probe]]
name = "under"
in = "b"
at = [{:?}, 0.0, {:?}]
gives = ["stress", "displacement"]
[[field]]
name = "rings"
on = "b.top"
footprint = {{ rings = {{ count = 2, radius = {:?} }} }}
at = [{:?}, {:?}]
gives = ["stress", "displacement"]
"#,
        l(0.3),
        4000.0 * heat,
        3.0 * force,
        2.0 * force,
        -force,
        l(0.31),
        l(-0.22),
        l(0.4),
        2.0 * force,
        force,
        1.5 * force,
        500.0 * heat,
        800.0 * heat,
        l(-0.23),
        l(0.11),
        l(0.5),
        l(0.4),
        700.0 * heat,
        900.0 * heat,
        force,
        2.0 * force,
        l(-0.11),
        l(-0.3),
        l(0.31),
        l(-0.21),
        l(-0.11),
        l(-0.31),
        l(0.21),
        l(-0.11),
        l(0.2),
        l(-0.5),
        l(0.3),
        l(0.21),
        l(0.13),
    )
}

const STEP: f64 = 0.05;

fn head(steps: f64) -> String {
    format!("name = \"Rows\"\nstop_time = {:?}\nstep = {STEP:?}\n", steps * STEP)
}

const SOFT: Row = [2.0, 3.0, 5.0, 1000.0, 0.3, 1e-3];

/// Faces of every kind; like ones across from each other, unlike ones where half the body is wanted.
fn faces(half: bool) -> String {
    let back =
        if half { "" } else { "back = { convection = { coefficient = 8.0, ambient = 290.0 } }" };
    format!(
        "[body.b.faces]\nleft = {{ temperature = 320.0, clamped = true }}\n\
         right = {{ temperature = 310.0, clamped = true }}\n\
         front = {{ convection = {{ coefficient = 8.0, ambient = 280.0 }} }}\n{back}\nbottom = {{ flux = 30.0 }}\n"
    )
}

fn solid(keys: &str, faces: &str) -> String {
    format!("[body.b]\nkind = \"solid\"\ninitial_temperature = 300.0\n{keys}\n{faces}")
}

/// A box of soft numbers.
fn block(keys: &str, faces: &str) -> String {
    let shape = "shape = { box = [2.0, 1.5, 0.5] }\n";
    let body = solid(&format!("{shape}material = {}\n{keys}", material(SOFT)), faces);
    body + &loads_and_readings([1.0; 3])
}

fn mesh(spacing: f64, order: usize) -> String {
    format!("mesh = {{ spacing = {spacing:?}, depth_spacing = {spacing:?}, order = {order} }}")
}

/// A disc: loads about the axis, probes on it and off it.
fn disc(keys: &str, order: usize) -> String {
    let axial = |text: &str| -> String {
        let moved = ["x = 0.31, y = -0.22", "x = -0.23, y = 0.11"];
        let text = moved
            .iter()
            .fold(text.to_owned(), |text, place| text.replace(&format!(", {place}"), ""));
        let text = text.replace(", shear_x = 2.0, shear_y = -1.0", "");
        let text = text
            .replace("[\"heat_flux\", \"pressure\", \"shear\"]", "[\"heat_flux\", \"pressure\"]");
        let (head, tiles) = text.split_once("[[load]]\nname = \"patch\"").unwrap();
        let (_, rest) = tiles.split_once("[[probe]]").unwrap();
        format!("{head}[[probe]]{rest}").replace("at = [0.21, 0.13]\n", "")
    };
    let faces = "[body.b.faces]\nsides = { temperature = 310.0, clamped = true }\n\
                 top = { convection = { coefficient = 8.0, ambient = 290.0 } }\nbottom = { flux = 30.0 }\n";
    let shape = "shape = { disc = { radius = 1.0, thickness = 0.5 } }\n";
    let keys = format!("{shape}{keys}\n{}", mesh(0.1, order));
    solid(&keys, faces) + &axial(&loads_and_readings([1.0; 3]))
}

fn is_mechanical(name: &str) -> bool {
    name.contains("stress")
        || name.contains("von_mises")
        || name.contains("displacement")
        || name.contains("principal")
}

fn goes_by_rows(trial: &Trial) -> bool {
    trial.model.notes().iter().any(|note| note.contains("influence rows"))
}

/// The values of rows are those of solutions to a part of the largest of their kind in the body.
#[track_caller]
fn assert_rows_are_solutions(text: &str, tolerance: f64) {
    let mut trials = [MANY, FEW].map(|steps| Trial::new(&(head(steps) + text)));
    assert_eq!(trials.each_ref().map(goes_by_rows), [true, false]);
    let names: Vec<String> = trials[0].outputs().into_iter().filter(|n| is_mechanical(n)).collect();
    assert!(names.len() > 20, "{names:?}");
    for round in 0..3 {
        let [by_rows, solved] =
            trials.each_mut().map(|trial| names.iter().map(|n| trial.get(n)).collect::<Vec<_>>());
        for (i, name) in names.iter().enumerate() {
            let moves = name.contains("displacement");
            let alike = (0..names.len()).filter(|&j| names[j].contains("displacement") == moves);
            let range = alike.map(|j| solved[j].abs()).fold(0.0, f64::max);
            let error = (by_rows[i] - solved[i]).abs();
            assert!(
                range > 0.0 && error <= tolerance * range,
                "{name}, {round}: {error:e} of {range:e}"
            );
        }
        for trial in &mut trials {
            trial.step(STEP);
            if round == 0 {
                trial.set("spot.pressure", -1.0);
            }
        }
    }
}

#[test]
fn rows_of_boxes_are_solutions() {
    for (half, symmetry) in [(false, "auto"), (true, "auto"), (false, "none")] {
        for order in [1, 2] {
            let keys = format!("symmetry = {symmetry:?}\n{}", mesh(0.25, order));
            assert_rows_are_solutions(&block(&keys, &faces(half)), 1e-10);
        }
    }
}

#[test]
fn rows_of_conjugate_gradients_are_solutions() {
    for order in [1, 2] {
        let keys = format!(
            "stress_free_temperature = 350.0\n{}",
            mesh(if order == 1 { 0.05 } else { 0.1 }, order)
        );
        // On a coarser mesh the stiffness would be factored.
        let text = block(&keys, &faces(false)).replace(COARSE, "");
        assert_rows_are_solutions(&text, 1e-10);
    }
}

#[test]
fn rows_of_particles_and_of_nonlinear_heat_are_solutions() {
    let particles =
        "heat = \"sph\"\nmesh = { spacing = 0.25, depth_spacing = 0.25, growth = 1.0, order = 1 }";
    assert_rows_are_solutions(&block(particles, &faces(false)), 1e-10);
    // Where heat is not linear, the whole box is meshed.
    let constant = "conductivity = 5.0";
    let variable = "conductivity = { temperature = [300.0, 800.0], value = [5.0, 4.0] }";
    let nonlinear = block(&mesh(0.25, 2), &faces(false)).replace(constant, variable);
    assert!(nonlinear.contains(variable));
    assert_rows_are_solutions(&nonlinear, 1e-10);
}

#[test]
fn rows_of_discs_are_solutions() {
    let keys = format!("material = {}\nstress_free_temperature = 280.0", material(SOFT));
    for order in [1, 2] {
        assert_rows_are_solutions(&disc(&keys, order), 1e-10);
    }
}

#[test]
fn rows_through_layers_are_solutions() {
    let other: Row = [3.0, 1.0, 20.0, 30_000.0, 0.2, 2e-4];
    let layers = format!(
        "layers = [ {{ material = {}, thickness = 0.11 }}, {{ material = {}, thickness = 0.39, contact_resistance = 0.02 }} ]",
        material(other),
        material(SOFT)
    );
    let faces = "[body.b.faces]\nleft = { temperature = 320.0, clamped = true }\n\
                 right = { temperature = 310.0, clamped = true }\ntop = { convection = { coefficient = 8.0, ambient = 280.0 } }\n";
    for order in [1, 2] {
        let keys = format!(
            "shape = {{ box = [2.0, 1.5, 0.5] }}\n{layers}\nstress_free_temperature = 320.0\n{}",
            mesh(0.25, order)
        );
        let text = solid(&keys, faces) + &loads_and_readings([1.0; 3]);
        assert_rows_are_solutions(&text, 1e-10);
        assert_rows_are_solutions(&disc(&layers, order), 1e-10);
    }
}

/// Materials from metals to what hardly resists, ν up to 0.49, and coatings a hundredth as thick as their plate.
#[test]
fn rows_of_real_materials_are_solutions() {
    let mut rubber = PTFE;
    rubber[4] = 0.49;
    let thin = [(DIAMOND, COPPER), (PTFE, ALUMINA)].map(|(film, base)| {
        format!(
            "layers = [ {{ material = {}, thickness = 5e-6 }}, {{ material = {}, thickness = 4.95e-4 }} ]\n",
            material(film),
            material(base)
        )
    });
    let alone = [ALUMINA, COPPER, LEAD, PTFE, rubber, AEROGEL];
    let bodies = alone.map(|row| format!("material = {}\n", material(row)));
    for (number, made_of) in bodies.iter().chain(&thin).enumerate() {
        for order in if number % 3 == 0 { 1..=2 } else { 2..=2 } {
            let keys = format!(
                "shape = {{ box = [2e-3, 1.5e-3, 0.5e-3] }}\n{made_of}\
                 mesh = {{ spacing = 4e-4, growth = 2.0, order = {order} }}"
            );
            let faces = "[body.b.faces]\nsides = { clamped = true }\n";
            let text = solid(&keys, faces) + &loads_and_readings([1e-3, 1e2, 1e4]);
            assert_rows_are_solutions(&text, 1e-10);
        }
    }
}

#[test]
fn the_order_of_reading_changes_no_bit() {
    let text = head(MANY) + &block(&mesh(0.25, 2), &faces(false));
    let mut trial = Trial::new(&text);
    let names: Vec<String> = trial
        .outputs()
        .into_iter()
        .filter(|name| is_mechanical(name) || name.contains("temp"))
        .collect();
    trial.step(STEP);
    let start = trial.state.clone();
    let bits = |trial: &mut Trial, order: &[usize]| -> Vec<u64> {
        let mut values = vec![0; names.len()];
        order.iter().for_each(|&i| values[i] = trial.get(&names[i]).to_bits());
        values
    };
    let plain: Vec<usize> = (0..names.len()).collect();
    let wanted = bits(&mut trial, &plain);
    trial.set("spot.x", 0.1);
    trial.step(STEP);
    let later = (trial.state.clone(), bits(&mut trial, &plain));
    let mut random = fastrand::Rng::with_seed(3);
    for round in 0..12 {
        // A new model solves for its rows in another order.
        if round % 4 == 0 {
            trial = Trial::new(&text);
        }
        let mut order = plain.clone();
        random.shuffle(&mut order);
        let early = random.bool();
        trial.restart(&start);
        if early {
            trial.fields("b");
            trial.get("b.max_von_mises");
        }
        let found = bits(&mut trial, &order[..random.usize(..order.len())]);
        assert!(found.iter().zip(&wanted).all(|(f, w)| *f == 0 || f == w), "round {round}");
        trial.set("spot.x", 0.1);
        trial.step(STEP);
        if !early {
            trial.get("b.max_von_mises");
        }
        assert_eq!(bits(&mut trial, &order), later.1, "round {round}");
        trial.restart(&start);
        trial.fields("b");
        assert_eq!(bits(&mut trial, &order), wanted, "round {round}");
        trial.restart(&later.0);
        random.shuffle(&mut order);
        assert_eq!(bits(&mut trial, &order), later.1, "round {round}");
    }
}

#[test]
fn nothing_is_factored_before_a_mechanical_variable_is_read() {
    let bodies =
        [block(&mesh(0.25, 2), &faces(false)), disc(&format!("material = {}", material(SOFT)), 1)];
    for text in bodies {
        for steps in [MANY, FEW] {
            // A stiffness of its own: other tests of this process share theirs.
            let text = text.replace("young = 1000.0", "young = 1001.0");
            let mut trial = Trial::new(&(head(steps) + &text));
            trial.step(STEP);
            trial.get("p.temperature");
            trial.get("b.max_temperature");
            assert_eq!(trial.model.factor_entries(), 0);
            assert!(trial.get("p.stress_xx") != 0.0 && trial.model.factor_entries() > 0);
        }
    }
}

/// Hosts read initial values before the first step: what they will read is made then, though nothing acts yet.
#[test]
fn what_is_read_at_rest_is_made_at_rest() {
    for steps in [MANY, FEW] {
        let quiet = block(&mesh(0.25, 2), "[body.b.faces]\nsides = { clamped = true }\n")
            .replace("start = {", "# start = {")
            .replace("young = 1000.0", "young = 1002.0");
        let mut trial = Trial::new(&(head(steps) + &quiet));
        assert_eq!(trial.get("p.stress_xx"), 0.0);
        assert!(trial.model.factor_entries() > 0);
    }
}

#[test]
fn derivatives_by_rows_are_those_of_solutions_and_the_limit_of_differences() {
    for text in [block(&mesh(0.25, 2), &faces(false)), block(&mesh(0.25, 1), &faces(true))] {
        let mut trials = [MANY, FEW].map(|steps| Trial::new(&(head(steps) + &text)));
        let names: Vec<String> =
            trials[0].outputs().into_iter().filter(|n| is_mechanical(n)).collect();
        trials.iter_mut().for_each(|trial| trial.step(STEP));
        let compare = |[by_rows, solved]: [Vec<f64>; 2], tolerance: f64, what: &str| {
            for (i, name) in names.iter().enumerate() {
                let moves = name.contains("displacement");
                let alike =
                    (0..names.len()).filter(|&j| names[j].contains("displacement") == moves);
                let range = alike.map(|j| solved[j].abs()).fold(0.0, f64::max);
                let error = (by_rows[i] - solved[i]).abs();
                assert!(error <= tolerance * range, "{what}: {name}: {error:e} of {range:e}");
            }
        };
        compare(trials.each_mut().map(|trial| trial.rates(&names)), 1e-9, "in time");
        for (input, size) in [
            ("spot.pressure", 1.0),
            ("spot.x", 0.1),
            ("wheel.shear_r[2]", 1.0),
            ("patch.pressure[1,1]", 1.0),
            ("b.left.temperature", 1.0),
        ] {
            let found = trials.each_mut().map(|trial| trial.changes(&names, &[(input, size)]));
            let by_rows = found[0].clone();
            compare(found, 1e-9, input);
            let trial = &mut trials[0];
            let start = trial.state.clone();
            let step = 1e-5;
            let ends = [step, -step].map(|way| {
                trial.restart(&start);
                let value = start.inputs[trial.input(input)];
                trial.set(input, value + way * size);
                names.iter().map(|name| trial.get(name)).collect::<Vec<_>>()
            });
            trial.restart(&start);
            let [above, below] = ends;
            let differences =
                above.iter().zip(&below).map(|(a, b)| (a - b) / (2.0 * step)).collect();
            compare([by_rows, differences], 1e-5, input);
        }
    }
}

#[test]
fn models_that_differ_in_heat_alone_share_what_rows_follow_from() {
    let text = block(&mesh(0.25, 2), &faces(false)).replace("young = 1000.0", "young = 1003.0");
    let denser = text.replace("density = 2.0", "density = 4.0");
    let [mut first, mut second, mut solved] = [(&text, MANY), (&denser, MANY), (&denser, FEW)]
        .map(|(text, steps)| Trial::new(&(head(steps) + text)));
    let kept = |trial: &Trial| trial.model.stiffness()[0].row_entries();
    let name = "p.stress_xx";
    for trial in [&mut first, &mut second, &mut solved] {
        trial.step(STEP);
    }
    assert_eq!(kept(&first), 0);
    let value = first.get(name);
    let entries = kept(&first);
    assert!(entries > 0);
    let denser = [second.get(name), solved.get(name)];
    assert_eq!(kept(&second), entries, "the second model solved for nothing");
    assert!(denser[0] != value && off(denser[0], denser[1]) < 1e-9, "{value} {denser:?}");
    // What stress follows at once is its own.
    let stiffer = text.replace("young = 1003.0", "young = 1004.0");
    let mut stiffer = Trial::new(&(head(MANY) + &stiffer));
    stiffer.step(STEP);
    stiffer.get(name);
    assert_eq!(kept(&first), entries);
    assert!(kept(&stiffer) > 0);
}

#[test]
fn surfaces_that_cannot_widen_have_their_closed_form_stress() {
    // −E α ΔT/(1 − ν), the whole body heated by 10 K between smooth walls.
    for row in [ALUMINA, COPPER, LEAD, PTFE, AEROGEL, DIAMOND] {
        for (shape, sides) in [
            ("box = [2e-3, 1e-3, 0.4e-3]", "sides = { roller = true }"),
            ("disc = { radius = 1e-3, thickness = 0.4e-3 }", "sides = { roller = true }"),
        ] {
            let keys = format!(
                "shape = {{ {shape} }}\nmaterial = {}\nstress_free_temperature = 290.0",
                material(row)
            );
            let faces = format!("[body.b.faces]\n{sides}\nbottom = {{ roller = true }}\n");
            let probe = "[[probe]]\nname = \"p\"\nin = \"b\"\nat = [3e-4, 1e-4, 0.0]\ngives = [\"stress\", \"displacement\"]\n";
            let mut trial = Trial::new(&(head(MANY) + &solid(&keys, &faces) + probe));
            assert!(goes_by_rows(&trial));
            let [_, _, _, young, poisson, expansion] = row;
            let wanted = -young * expansion * 10.0 / (1.0 - poisson);
            for name in ["p.stress_xx", "p.stress_yy"] {
                assert!(off(trial.get(name), wanted) < 1e-9, "{name}: {}", trial.get(name));
            }
            assert!(trial.get("p.stress_zz").abs() < 1e-9 * wanted.abs());
            assert!(off(trial.get("p.von_mises"), wanted.abs()) < 1e-9);
            let lifted = expansion * 10.0 * (1.0 + poisson) / (1.0 - poisson) * 0.4e-3;
            assert!(off(trial.get("p.displacement_z"), lifted) < 1e-9);
        }
    }
}

/// Love (1929), with an error that falls as the square of the spacing at least.
#[test]
fn pressed_half_spaces_converge_to_their_closed_form() {
    let error = |spacing: f64| {
        let keys = format!(
            "shape = {{ disc = {{ radius = 40.0, thickness = 40.0 }} }}\nmaterial = {}\n\
             mesh = {{ spacing = {spacing:?}, growth = 1.2, order = 2 }}",
            material(SOFT)
        );
        let rest = "[body.b.faces]\nbottom = { clamped = true }\n[[load]]\nname = \"l\"\non = \"b.top\"\n\
                    footprint = { disc = { radius = 1.0 } }\ncarries = [\"pressure\"]\nstart = { pressure = 1.0 }\n\
                    [[probe]]\nname = \"p\"\nin = \"b\"\nat = [0.0, 0.0, -0.7]\ngives = [\"stress\"]\n";
        let mut trial = Trial::new(&(head(MANY) + &solid(&keys, "") + rest));
        assert!(goes_by_rows(&trial));
        let exact = DiscPressure {
            body: Elastic { young: 1000.0, poisson: 0.3 },
            pressure: 1.0,
            radius: 1.0,
        };
        let axial = trial.get("p.stress_zz") - exact.axial_stress_on_axis(0.7);
        let radial = trial.get("p.stress_xx") - exact.radial_stress_on_axis(0.7);
        axial.abs().max(radial.abs())
    };
    let errors = [0.4, 0.2, 0.1].map(error);
    // Over two halvings: the probe lies elsewhere in its element each time.
    assert!(errors[2] < 2e-3 && errors[2] < errors[0] / 16.0, "{errors:?}");
}
