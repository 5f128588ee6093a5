//! Bodies whose moduli relax, against closed forms.

use closed_form::relaxing_solid::{Relaxing, RelaxingSolid};
use impinge::runtime::allowance::{Allowance, Interrupt};

use crate::common::{Trial, off};

const YOUNG: f64 = 3e9;
const POISSON: f64 = 0.3;
const EXPANSION: f64 = 7e-5;
const START: f64 = 400.0;
/// Of the branch.
const FRACTION: f64 = 0.8;
const TIME: f64 = 2.0;

fn solid(fraction: f64, time: f64) -> RelaxingSolid {
    RelaxingSolid::of(YOUNG, POISSON, fraction, time)
}

/// Constants of a material, with further keys.
fn material(model: &str, young: f64, poisson: f64, more: &str) -> String {
    format!(
        "{{ model = \"{model}\", density = 1200.0, specific_heat = 1500.0, conductivity = 1e6, young = {young:e}, \
         poisson = {poisson:?}, expansion = {EXPANSION:e}{more} }}"
    )
}

fn relaxing(fraction: f64, time: f64, more: &str) -> String {
    let branch =
        format!(", shear_relaxation = [{{ fraction = {fraction:?}, time = {time:e} }}]{more}");
    material("viscoelastic", YOUNG, POISSON, &branch)
}

const BAR: &str = "box = [2e-2, 1e-2, 1e-2]";
const DISC: &str = "disc = { radius = 1e-2, thickness = 1e-2 }";
/// For ten steps to be accurate to 1e-6.
const STRICT: &str = "[fidelity]\ntolerance = 1e-4\n";
const PROBE: &str = "[[probe]]\nname = \"inside\"\nin = \"bar\"\nat = [0.0, 0.0, -5e-3]\n\
                     gives = [\"stress\", \"displacement\"]\n";
/// Held at both ends, and everywhere but on the top.
const ENDS: &str = "left = { roller = true }\nright = { roller = true }\nfront = { roller = true }\nbottom = { roller = true }";
const SIDES: &str = "sides = { roller = true }\nbottom = { roller = true }";
const PRESSED: &str =
    "left = { roller = true }\nfront = { roller = true }\nbottom = { roller = true }";

fn scene(shape: &str, material: &str, [start, free]: [f64; 2], faces: &str, rest: &str) -> String {
    format!(
        "name = \"Relaxation\"\nstop_time = 10.0\nstep = 1.0\n[body.bar]\nkind = \"solid\"\nshape = {{ {shape} }}\n\
         initial_temperature = {start:?}\nstress_free_temperature = {free:?}\nmaterial = {material}\n\
         mesh = {{ spacing = 5e-3, depth_spacing = 5e-3, growth = 1.0 }}\n[body.bar.faces]\n{faces}\n{rest}"
    )
}

/// A uniform pressure on the top.
fn pressure(amount: f64) -> String {
    format!(
        "[[load]]\nname = \"press\"\non = \"bar.top\"\nfootprint = {{ tiles = {{ count = [1, 1], size = [2e-2, 1e-2] }} }}\n\
         carries = [\"pressure\"]\nstart = {{ pressure = {amount:e} }}\n"
    )
}

/// Steps through times, and returns a reading at each.
fn readings(trial: &mut Trial, times: &[f64], name: &str) -> Vec<f64> {
    let mut read = |time: &f64| {
        trial.step(time - trial.state.time);
        trial.get(name)
    };
    times.iter().map(&mut read).collect()
}

/// The scene of all of a box.
fn whole(text: &str) -> String {
    text.replace("[body.bar.faces]", "symmetry = \"none\"\n[body.bar.faces]")
}

fn ten(end: f64) -> Vec<f64> {
    (1..=10).map(|k| end * f64::from(k) / 10.0).collect()
}

/// Largest difference from a modulus times the strain at first, over the stress at first.
fn error(found: &[f64], times: &[f64], exact: Relaxing, strain: f64) -> f64 {
    let pairs = found.iter().zip(times);
    let off = pairs.map(|(found, time)| (found - exact.modulus(*time) * strain).abs());
    off.fold(0.0, f64::max) / (exact.instantaneous * strain).abs()
}

#[test]
fn a_bar_and_a_film_that_were_hotter_relax_by_correspondence() {
    for fraction in [1.0, FRACTION, 0.2] {
        let exact = solid(fraction, TIME);
        let cases = [
            (BAR, ENDS, "inside.stress_xx", exact.bar()),
            (BAR, SIDES, "inside.stress_xx", exact.film()),
            (DISC, SIDES, "inside.stress_xx", exact.film()),
        ];
        for (shape, faces, name, modulus) in cases {
            let text = scene(
                shape,
                &relaxing(fraction, TIME, ""),
                [START, START + 40.0],
                faces,
                &(PROBE.to_owned() + STRICT),
            );
            let mut trial = Trial::new(&text);
            let strain = EXPANSION * 40.0;
            assert!(off(trial.get(name), modulus.instantaneous * strain) < 1e-12);
            let times = ten(3.0 * modulus.time);
            let found = error(&readings(&mut trial, &times, name), &times, modulus, strain);
            assert!(found < 1e-6, "{fraction} {shape}: {found:e}");
        }
    }
}

#[test]
fn a_pressed_bar_creeps_by_correspondence() {
    for fraction in [FRACTION, 0.2] {
        let load = pressure(1e6) + &PROBE.replace("-5e-3]", "0.0]") + STRICT;
        let mut trial =
            Trial::new(&scene(BAR, &relaxing(fraction, TIME, ""), [START; 2], PRESSED, &load));
        let exact = solid(fraction, TIME).bar();
        let wanted = |time: f64| -1e-2 * 1e6 * exact.compliance(time);
        let times = ten(5.0 * TIME);
        let found = readings(&mut trial, &times, "inside.displacement_z");
        let off = found.iter().zip(&times).map(|(found, time)| off(*found, wanted(*time)));
        let most = off.fold(0.0, f64::max);
        assert!(most < 1e-6, "{fraction}: {most:e}");
        // Released: what is left of the strain is that of the branch.
        trial.set("press.pressure[1,1]", 0.0);
        trial.step(1.0);
        let end = trial.state.time;
        let left = wanted(end) - wanted(1.0);
        let found = trial.get("inside.displacement_z");
        assert!((found - left).abs() < 1e-6 * wanted(end).abs(), "{found} {left}");
    }
}

/// A cantilever of 20 m and 1 m × 1 m under 2/15 Pa on its top, which bends its end as a force of 1 N there does, for
/// ten seconds; ν is 0.3 and four fifths of E₀ = 5e5 Pa relax in 1 s.
#[test]
fn a_beam_creeps_by_correspondence() {
    const LOAD: f64 = 8.0 / (3.0 * 20.0);
    let slender = 20f64.powi(3) / (3.0 / 12.0);
    let branch = "[{ fraction = 0.8, time = 1.0 }]";
    let of = |bulk: &str| {
        let keys = format!(", shear_relaxation = {branch}{bulk}");
        let load = "[[load]]\nname = \"press\"\non = \"bar.top\"\ncarries = [\"pressure\"]\n\
                    footprint = { tiles = { count = [1, 1], size = [20.0, 1.0] } }\n"
            .to_owned()
            + &format!("start = {{ pressure = {LOAD} }}\n")
            + "[[probe]]\nname = \"end\"\nin = \"bar\"\nat = [10.0, 0.0, -0.5]\ngives = [\"displacement\"]\n"
            + STRICT;
        let material = material("viscoelastic", 5e5, 0.3, &keys);
        let text = scene(
            "box = [20.0, 1.0, 1.0]",
            &material,
            [START; 2],
            "left = { clamped = true }",
            &load,
        );
        text.replace("spacing = 5e-3, depth_spacing = 5e-3", "spacing = 0.5, depth_spacing = 0.5")
    };
    // Young's modulus relaxes as both moduli do, or as the shear modulus makes it relax.
    let both = Relaxing { instantaneous: 5e5, lasting: 1e5, time: 1.0 };
    let shear = RelaxingSolid::of(5e5, 0.3, 0.8, 1.0).bar();
    let cases = [
        (format!(", bulk_relaxation = {branch}"), both, 0.285_354),
        (String::new(), shear, 0.255_840),
    ];
    for (bulk, modulus, at_ten) in cases {
        assert!(off(slender * modulus.compliance(10.0), at_ten) < 2e-6);
        let is_alike = !bulk.is_empty();
        let mut trial = Trial::new(&of(&bulk));
        trial.step(1e-6);
        let at_first = -trial.get("end.displacement_z");
        // Shear of the beam adds 4 E I/(κ G A L²); the clamped end, which keeps its section, takes half a per cent.
        let sheared = 1.0 + 4.0 * 2.6 / (12.0 * 5.0 / 6.0 * 400.0);
        assert!(off(at_first, 0.064 * sheared) < 6e-3, "{at_first}");
        for time in ten(10.0) {
            trial.step(time - trial.state.time);
            let found = -trial.get("end.displacement_z");
            let expected = at_first * modulus.compliance(time) / modulus.compliance(0.0);
            assert!(
                off(found, expected) < if is_alike { 1e-6 } else { 1e-2 },
                "{time}: {found} {expected}"
            );
        }
        // With an elastic bulk the clamped end relaxes otherwise than the beam.
        let most = -trial.get("end.displacement_z");
        trial.set("press.pressure[1,1]", 0.0);
        for time in [12.0, 15.0, 20.0, 30.0] {
            trial.step(time - trial.state.time);
            let found = -trial.get("end.displacement_z");
            let left = modulus.compliance(time) - modulus.compliance(time - 10.0);
            let expected = at_first * left / modulus.compliance(0.0);
            let allowed = if is_alike { 1e-5 * at_first } else { 1e-2 * most };
            assert!((found - expected).abs() < allowed, "{time}: {found} {expected}");
        }
    }
}

/// Held on all sides there is no change of shape; pressure relaxes with the bulk modulus, exactly in any steps.
#[test]
fn steps_of_any_length_are_exact_where_strain_is_linear() {
    let more =
        ", bulk_relaxation = [{ fraction = 0.5, time = 1.0 }, { fraction = 0.25, time = 1e-3 }]";
    let material = relaxing(FRACTION, TIME, more);
    let faces = SIDES.to_owned() + "\ntop = { roller = true, temperature = 400.0 }";
    let text = scene(BAR, &material, [430.0, START], &faces.replace("400.0", "430.0"), PROBE);
    let bulk = YOUNG / (3.0 * (1.0 - 2.0 * POISSON));
    let branch = |fraction: f64, time: f64| {
        let instantaneous = fraction * 3.0 * bulk;
        Relaxing { instantaneous, lasting: 0.0, time }
    };
    for rate in [0.5, 0.0] {
        let run = |steps: usize| {
            let mut trial = Trial::new(&text);
            // Conduction is so good that the body is of one temperature.
            trial.set_derivative("bar.top.temperature", 1, rate);
            (0..steps).for_each(|_| trial.step(4.0 / steps as f64));
            trial.get("inside.stress_zz")
        };
        let [whole, parts] = [1, 100].map(run);
        let lasting = 0.25 * 3.0 * bulk * (30.0 + 4.0 * rate);
        let exact: f64 = [branch(0.5, 1.0), branch(0.25, 1e-3)]
            .iter()
            .map(|own| own.modulus(4.0) * 30.0 + own.after_ramp(4.0) * rate)
            .sum();
        let wanted = -EXPANSION * (lasting + exact);
        assert!(off(whole, parts) < 1e-6, "{rate}: {whole} {parts}");
        assert!(off(whole, wanted) < 5e-6, "{rate}: {whole} {wanted}");
    }
}

#[test]
fn a_shift_changes_the_time_of_relaxation() {
    let wlf = "law = \"wlf\", c1 = 17.44, c2 = 51.6, reference_temperature = 390.0";
    let arrhenius = "law = \"arrhenius\", activation_energy = 2e5, reference_temperature = 405.0";
    let of_wlf = |t: f64| 10_f64.powf(-17.44 * (t - 390.0) / (51.6 + t - 390.0));
    let of_arrhenius = |t: f64| (2e5 / 8.314_462_618 * (1.0 / t - 1.0 / 405.0)).exp();
    let shifts: [(&str, &dyn Fn(f64) -> f64); 2] = [(wlf, &of_wlf), (arrhenius, &of_arrhenius)];
    for (keys, factor) in shifts {
        // The branch has its time at the temperature of the bar.
        let time = TIME / factor(START);
        let shift = format!(", shift = {{ {keys} }}");
        let text =
            scene(BAR, &relaxing(FRACTION, time, &shift), [START, START + 40.0], ENDS, PROBE);
        let exact = solid(FRACTION, TIME).bar();
        let times = ten(3.0 * exact.time);
        let found = readings(&mut Trial::new(&text), &times, "inside.stress_xx");
        let found = error(&found, &times, exact, EXPANSION * 40.0);
        assert!(found < 1e-6, "{keys}: {found:e}");
        // All sides held, so that only the bulk modulus acts, while it cools evenly: σ = −3Kα ∫ M(ξ(t) − ξ(s)) dT(s).
        let bulk = format!("{shift}, bulk_relaxation = [{{ fraction = 1.0, time = {time:e} }}]");
        let faces = SIDES.to_owned() + "\ntop = { roller = true, temperature = 400.0 }";
        let text = scene(BAR, &relaxing(FRACTION, time, &bulk), [START; 2], &faces, PROBE);
        let mut trial = Trial::new(&text);
        let rate = -1.0;
        trial.set_derivative("bar.top.temperature", 1, rate);
        (0..10).for_each(|_| trial.step(1.0));
        let n = 20_000;
        let h = 10.0 / f64::from(n);
        let (mut strain, mut modulus) = (0.0, 1.0);
        for k in (0..n).rev() {
            let middle = START + rate * (f64::from(k) + 0.5) * h;
            let x = h / (time * factor(middle));
            strain += modulus * -f64::exp_m1(-x) / x * h * rate;
            modulus *= (-x).exp();
        }
        let wanted = -YOUNG / (1.0 - 2.0 * POISSON) * EXPANSION * strain;
        let found = trial.get("inside.stress_xx");
        assert!(off(found, wanted) < 1e-5, "{keys}: {found} {wanted}");
    }
}

/// Times far from the duration: elasticity with the instantaneous and with the long-term constants.
#[test]
fn slow_and_quick_relaxation_is_elasticity() {
    let exact = solid(FRACTION, TIME);
    let (shear, bulk) = (exact.in_shear().lasting, exact.bulk);
    let soft = [
        9.0 * bulk * shear / (3.0 * bulk + shear),
        (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear)),
    ];
    for (time, [young, poisson]) in [(1e14, [YOUNG, POISSON]), (1e-14, soft)] {
        for shape in [BAR, DISC] {
            let faces = "sides = { clamped = true }\nbottom = { convection = { coefficient = 1e3, ambient = 420.0 } }";
            let run = |material: &str| {
                let more = PROBE.to_owned() + "[fidelity]\ntolerance = 1e-6\n";
                let text = scene(shape, material, [START, START + 20.0], faces, &more);
                let text = if shape == BAR { whole(&text) } else { text };
                let mut trial = Trial::new(&text);
                (0..2).for_each(|_| trial.step(1.0));
                [
                    "inside.stress_xx",
                    "inside.stress_zz",
                    "inside.displacement_z",
                    "bar.max_von_mises",
                ]
                .map(|name| trial.get(name))
            };
            let found = run(&relaxing(FRACTION, time, ""));
            let wanted = run(&material("elastoplastic", young, poisson, ", yield_stress = 1e15"));
            let scale = wanted[3];
            for (k, (a, b)) in found.iter().zip(wanted).enumerate() {
                let scale = if k == 2 { b.abs() } else { scale };
                assert!((a - b).abs() < 1e-6 * scale, "{time} {shape} {k}: {a} {b}");
            }
        }
    }
}

#[test]
fn energy_of_a_held_body_is_dissipated_and_a_load_does_all_work() {
    let faces = "sides = { clamped = true }\nbottom = { clamped = true }";
    let material = relaxing(0.9, TIME, ", bulk_relaxation = [{ fraction = 0.2, time = 0.5 }]");
    for shape in [BAR, DISC] {
        let mut trial = Trial::new(&scene(shape, &material, [START, START + 40.0], faces, PROBE));
        let first = trial.get("bar.stored");
        assert!(first > 0.0 && trial.get("bar.dissipated") == 0.0);
        let mut before = 0.0;
        for step in [0.01, 0.3, 1.0, 5.0, 100.0] {
            trial.step(step);
            let [stored, lost] = ["bar.stored", "bar.dissipated"].map(|name| trial.get(name));
            // The free top moves without a load.
            assert!(
                (stored + lost - first).abs() < 2e-4 * first,
                "{shape} {step}: {stored} {lost} {first}"
            );
            assert!(lost >= before && stored > 0.0);
            before = lost;
        }
    }
    // A sudden constant pressure works on the way of the face; half of it at first.
    let load = pressure(1e6) + &PROBE.replace("-5e-3]", "0.0]");
    let mut trial =
        Trial::new(&scene(BAR, &relaxing(FRACTION, TIME, ""), [START; 2], PRESSED, &load));
    trial.step(1e-9);
    let first = -1e6 * 2e-4 * trial.get("inside.displacement_z");
    for _ in 0..5 {
        trial.step(2.0);
        let work = -1e6 * 2e-4 * trial.get("inside.displacement_z") - 0.5 * first;
        let sum = trial.get("bar.stored") + trial.get("bar.dissipated");
        assert!(off(sum, work) < 1e-4, "{sum} {work}");
    }
}

/// A film on a strip that is free to bend and not to strain across. Both moduli of one of them relax alike, so that it
/// keeps its ratio of Poisson.
fn bilayer(layers: &str, elements: &str) -> String {
    format!(
        "name = \"Strip\"\nstop_time = 10.0\nstep = 1.0\n[body.bar]\nkind = \"solid\"\nshape = {{ box = [2e-2, 2e-3, 1e-3] }}\n\
         initial_temperature = 440.0\nstress_free_temperature = {START:?}\nsymmetry = \"none\"\nmesh = {{ {elements} }}\n{layers}\
         [body.bar.faces]\nleft = {{ clamped = true }}\nfront = {{ roller = true }}\nback = {{ roller = true }}\n\
         [[probe]]\nname = \"coat\"\nin = \"bar\"\nat = [1e-3, 0.0, -1e-4]\ngives = [\"stress\"]\n\
         [[probe]]\nname = \"plate\"\nin = \"bar\"\nat = [1e-3, 0.0, -6e-4]\ngives = [\"stress\"]\n"
    )
}

/// Stress of layers of a free strip under a sudden rise, at times, by plate theory with a thousand steps: `ε = e + κ
/// z`, no resultant, no moment, and elastic strains of the branch that are linear in z, too.
fn strip(
    moduli: [f64; 2],
    expansions: [f64; 2],
    relaxing: usize,
    rise: f64,
    times: &[f64],
) -> Vec<[f64; 2]> {
    // Layers from the top, 0.2 mm and 0.8 mm; probes at −0.1 mm and −0.6 mm.
    let ends: [[f64; 2]; 2] = [[-2e-4, 0.0], [-1e-3, -2e-4]];
    let moment = |layer: usize, power: i32| {
        let [low, high] = ends[layer];
        let n = power + 1;
        (high.powi(n) - low.powi(n)) / f64::from(n)
    };
    let probes = [-1e-4, -6e-4];
    // The strain e + κ z under which what the elastic strains lack balances; `acting` is the fraction of the modulus.
    let solve = |acting: f64, before: [f64; 2]| {
        let m = |layer: usize| moduli[layer] * if layer == relaxing { acting } else { 1.0 };
        let sum = |power: i32| (0..2).map(|l| m(l) * moment(l, power)).sum::<f64>();
        let load = |power: i32| {
            let thermal: f64 = (0..2).map(|l| m(l) * expansions[l] * rise * moment(l, power)).sum();
            let past =
                before[0] * moment(relaxing, power) + before[1] * moment(relaxing, power + 1);
            thermal - moduli[relaxing] * past
        };
        let [a, b, c] = [sum(0), sum(1), sum(2)];
        let [f, g] = [load(0), load(1)];
        let det = a * c - b * b;
        [(f * c - g * b) / det, (a * g - b * f) / det]
    };
    let steps = 4000;
    let (mut strain, mut out) = (solve(1.0, [0.0; 2]), Vec::new());
    let mut branch = [strain[0] - expansions[relaxing] * rise, strain[1]];
    let mut now = 0.0;
    for &time in times {
        let h = (time - now) / f64::from(steps);
        let x = h / TIME;
        let first = -f64::exp_m1(-x) / x;
        for _ in 0..steps {
            // Stress over the modulus is `d`, of which the step keeps a part.
            let rest =
                |k: usize, thermal: f64| (-x).exp() * branch[k] - first * (strain[k] - thermal);
            let past = [rest(0, expansions[relaxing] * rise), rest(1, 0.0)];
            let next = solve(first, past);
            branch = [0, 1].map(|k| (-x).exp() * branch[k] + first * (next[k] - strain[k]));
            strain = next;
        }
        now = time;
        let stress = |layer: usize| match layer == relaxing {
            true => moduli[layer] * (branch[0] + branch[1] * probes[layer]),
            false => {
                moduli[layer] * (strain[0] + strain[1] * probes[layer] - expansions[layer] * rise)
            }
        };
        out.push([stress(0), stress(1)]);
    }
    out
}

#[test]
fn coats_and_plates_relax_by_plate_theory() {
    let soft = |relaxes: bool| {
        let branch = format!("[{{ fraction = 1.0, time = {TIME:?} }}]");
        let more = format!(", shear_relaxation = {branch}, bulk_relaxation = {branch}");
        match relaxes {
            true => material("viscoelastic", YOUNG, POISSON, &more),
            false => material("thermoelastic", YOUNG, POISSON, ""),
        }
    };
    let stiff =
        |relaxes: bool| soft(relaxes).replace("young = 3e9", "young = 9e9").replace("7e-5", "2e-5");
    for relaxing in [0, 1] {
        let [coat, plate] = [soft(relaxing == 0), stiff(relaxing == 1)];
        let layers = format!(
            "layers = [{{ thickness = 2e-4, material = {coat} }}, {{ thickness = 8e-4, material = {plate} }}]\n"
        );
        let mesh = "spacing = 1e-3, depth_spacing = 2e-4, growth = 1.0";
        let mut trial = Trial::new(&bilayer(&layers, mesh));
        let times = [0.5, 2.0, 6.0];
        let plane = [3e9, 9e9].map(|young| young / (1.0 - POISSON * POISSON));
        let wanted =
            strip(plane, [7e-5, 2e-5].map(|own| (1.0 + POISSON) * own), relaxing, 40.0, &times);
        let scale = plane[0] * 1.3 * 5e-5 * 40.0;
        for (time, wanted) in times.iter().zip(wanted) {
            trial.step(time - trial.state.time);
            for (name, wanted) in ["coat", "plate"].iter().zip(wanted) {
                let found = trial.get(&format!("{name}.stress_xx"));
                assert!(
                    (found - wanted).abs() < 2e-3 * scale,
                    "{relaxing} {time} {name}: {found} {wanted}"
                );
            }
        }
    }
}

#[test]
fn quarters_and_whole_boxes_agree_and_runs_go_on_to_the_bit() {
    let faces = "sides = { clamped = true }\nbottom = { convection = { coefficient = 1e5, ambient = 380.0 } }";
    let shift =
        ", shift = { law = \"arrhenius\", activation_energy = 1e5, reference_temperature = 400.0 }";
    let text = scene(BAR, &relaxing(FRACTION, TIME, shift), [START, START + 10.0], faces, PROBE);
    let text = text.replace("spacing = 5e-3", "spacing = 2.5e-3");
    let quarter = text.replace("[body.bar.faces]", "symmetry = \"quarter\"\n[body.bar.faces]");
    let mut found = Vec::new();
    for text in [&text, &quarter] {
        let mut trial = Trial::new(text);
        trial.step(1.0);
        let saved = trial.state.clone();
        trial.step(1.0);
        let mut other = Trial::on_threads(text, 3);
        other.restart(&saved);
        other.step(1.0);
        assert_eq!(other.state, trial.state);
        found
            .push(["inside.stress_xx", "bar.stored", "bar.dissipated"].map(|name| trial.get(name)));
    }
    for (a, b) in found[0].iter().zip(found[1]) {
        assert!(off(*a, b) < 1e-9, "{found:?}");
    }
}

/// Inner steps count: a step ends where they come to more than it may take, and changes nothing.
#[test]
fn steps_end_as_soon_as_they_are_too_long() {
    let text = scene(BAR, &relaxing(FRACTION, TIME, ""), [START, START + 10.0], ENDS, PROBE);
    let mut trial = Trial::new(&text);
    let before = trial.state.clone();
    let Trial { model, state, .. } = &mut trial;
    let little = Allowance::of_updates(&Interrupt::default(), 1e5);
    let halted = model.step_within(&little, state, &mut Default::default(), (5.0, 5.0));
    let message = halted.unwrap_err().to_string();
    assert!(message.contains("iterations of equilibrium"), "{message}");
    assert_eq!(state.bodies, before.bodies);
}
