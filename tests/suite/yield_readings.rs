//! Stress and plastic strain that are read of bodies that yield or creep, anywhere on coarse meshes.

use impinge::closed_form::{Bilinear, Conductor, HeatedSlab};
use impinge::laws::stress::{max_principal, von_mises};
use impinge::model::NodalFields;

use crate::common::{Trial, off};

/// A material with what yields of it: σ_y and the temperature by which it falls to a quarter, H_i, H_k.
struct Metal {
    text: &'static str,
    law: &'static str,
    yield_stress: f64,
    falls_to: Option<f64>,
    isotropic: f64,
    kinematic: f64,
    /// Flux of the spot that makes it yield [W/m²].
    flux: f64,
}

const START: f64 = 300.0;

static METALS: [Metal; 5] = [
    Metal {
        text: "density = 7800.0, specific_heat = 500.0, conductivity = 45.0, young = 200e9, poisson = 0.3, \
               expansion = 1.2e-5",
        law: "elastoplastic",
        yield_stress: 250e6,
        falls_to: None,
        isotropic: 2e9,
        kinematic: 0.0,
        flux: 4e7,
    },
    Metal {
        text: "density = 7800.0, specific_heat = 500.0, conductivity = 45.0, young = 200e9, poisson = 0.3, \
               expansion = 1.2e-5",
        law: "elastoplastic",
        yield_stress: 250e6,
        falls_to: Some(900.0),
        isotropic: 2e9,
        kinematic: 0.0,
        flux: 4e7,
    },
    Metal {
        text: "density = 11340.0, specific_heat = 129.0, conductivity = 35.0, young = 16e9, poisson = 0.44, \
               expansion = 2.9e-5",
        law: "elastoplastic",
        yield_stress: 12e6,
        falls_to: None,
        isotropic: 5e7,
        kinematic: 0.0,
        flux: 1e7,
    },
    Metal {
        text: "density = 2700.0, specific_heat = 900.0, conductivity = 200.0, young = 70e9, poisson = 0.33, \
               expansion = 2.3e-5",
        law: "elastoplastic",
        yield_stress: 80e6,
        falls_to: None,
        isotropic: 0.0,
        kinematic: 0.0,
        flux: 1.2e8,
    },
    Metal {
        text: "density = 8960.0, specific_heat = 385.0, conductivity = 400.0, young = 120e9, poisson = 0.34, \
               expansion = 1.7e-5",
        law: "elastoplastic",
        yield_stress: 70e6,
        falls_to: None,
        isotropic: 0.0,
        kinematic: 2e9,
        flux: 2e8,
    },
];

impl Metal {
    fn material(&self) -> String {
        let yields = match self.falls_to {
            None => format!("{:e}", self.yield_stress),
            Some(hot) => format!(
                "{{ temperature = [{START:?}, {hot:?}], value = [{:e}, {:e}] }}",
                self.yield_stress,
                0.25 * self.yield_stress
            ),
        };
        format!(
            "model = \"{}\", {}, yield_stress = {yields}, isotropic_hardening = {:e}, kinematic_hardening = {:e}",
            self.law, self.text, self.isotropic, self.kinematic
        )
    }

    /// The most that von Mises stress may be; the back stress adds at most `H_k p`.
    fn bound(&self, temperature: f64, plastic: f64) -> f64 {
        let part = match self.falls_to {
            None => 1.0,
            Some(hot) => 1.0 - 0.75 * ((temperature - START) / (hot - START)).clamp(0.0, 1.0),
        };
        part * self.yield_stress + (self.isotropic + self.kinematic) * plastic
    }
}

/// A plate with a heated spot on a mesh that the scene sets, clamped below or on rollers, with probes.
fn plate(
    shape: &str,
    order: usize,
    material: &str,
    flux: f64,
    bottom: &str,
    probes: &str,
) -> String {
    format!(
        "name = \"Spot\"\nstop_time = 0.03\nstep = 0.005\n[body.plate]\nkind = \"solid\"\nshape = {{ {shape} }}\n\
         initial_temperature = {START:?}\nmaterial = {{ {material} }}\n\
         mesh = {{ spacing = 5e-4, depth_spacing = 3.3e-4, growth = 1.0, order = {order} }}\n\
         [body.plate.faces]\nbottom = {{ {bottom} }}\n[[load]]\nname = \"spot\"\non = \"plate.top\"\n\
         footprint = {{ gaussian = {{ radius = 1e-3 }} }}\ncarries = [\"heat_flux\"]\nstart = {{ heat_flux = {flux:e} }}\n\
         {probes}"
    )
}

const SHAPES: [&str; 2] =
    ["disc = { radius = 4e-3, thickness = 1.5e-3 }", "box = [6e-3, 5e-3, 1.5e-3]"];

/// Places on and between nodes.
fn places() -> Vec<[f64; 3]> {
    let depths = [0.0, 4e-5, 1.3e-4, 3.3e-4, 5e-4, 8e-4, 1.2e-3, 1.5e-3];
    let radii = [0.0, 2.1e-4, 5e-4, 7.7e-4, 1e-3, 1.4e-3, 1.9e-3];
    radii.into_iter().flat_map(|r| depths.map(|z| [0.9 * r, -0.4 * r, -z])).collect()
}

fn probes() -> String {
    let probe = |(number, at): (usize, [f64; 3])| {
        format!(
            "[[probe]]\nname = \"q{number}\"\nin = \"plate\"\nat = {at:?}\n\
             gives = [\"temperature\", \"stress\", \"max_principal\", \"plastic_strain\"]\n"
        )
    };
    places().into_iter().enumerate().map(probe).collect()
}

/// All metals on discs, the first and the last on boxes.
fn spots() -> Vec<(&'static Metal, &'static str)> {
    let [disc, brick] = SHAPES;
    let ends = [&METALS[0], &METALS[4]].map(|metal| (metal, brick));
    METALS.iter().map(|metal| (metal, disc)).chain(ends).collect()
}

/// Calls `check` with bodies that are heated and, at last, cooled for a while.
fn for_spots(mut check: impl FnMut(&Metal, &str, &mut Trial)) {
    for (metal, shape) in spots() {
        for order in [1, 2] {
            let material = metal.material();
            let text = plate(shape, order, &material, metal.flux, "clamped = true", &probes());
            let mut trial = Trial::new(&text);
            let what = format!("{shape}, order {order}, {material}");
            for dt in [0.01, 0.01, 0.04] {
                if dt > 0.01 {
                    trial.set("spot.heat_flux", 0.0);
                }
                trial.step(dt);
                check(metal, &what, &mut trial);
            }
            assert!(trial.get("plate.max_plastic_strain") > 1e-5, "{what}");
        }
    }
}

/// Rounding of measures of stress.
const ROUNDED: f64 = 1.0 + 1e-9;

#[test]
fn stress_at_probes_and_nodes_stays_within_the_yield_surface() {
    for_spots(|metal, what, trial| {
        for number in 0..places().len() {
            let [stress, plastic, temperature] = ["von_mises", "plastic_strain", "temperature"]
                .map(|key| trial.get(&format!("q{number}.{key}")));
            let most = metal.bound(temperature, plastic);
            assert!(stress <= most * ROUNDED, "{what}: {stress:e} at {number}, not {most:e}");
        }
        let NodalFields { stress, temperature, plastic_strain, .. } = trial.fields("plate");
        for ((stress, plastic), temperature) in stress.iter().zip(plastic_strain).zip(temperature) {
            let (stress, most) = (von_mises(*stress), metal.bound(temperature, plastic));
            assert!(stress <= most * ROUNDED, "{what}: {stress:e}, not {most:e}");
        }
    });
}

#[test]
fn plastic_strain_lies_between_zero_and_the_largest_of_the_points() {
    for_spots(|_, what, trial| {
        let most = trial.get("plate.max_plastic_strain") * ROUNDED;
        let of_probes = (0..places().len()).map(|n| format!("q{n}.plastic_strain"));
        let mut all: Vec<f64> = of_probes.map(|name| trial.get(&name)).collect();
        all.extend(trial.fields("plate").plastic_strain);
        assert!(all.iter().all(|strain| (0.0..=most).contains(strain)), "{what}: {most:e}");
    });
}

#[test]
fn extremes_are_the_largest_of_what_can_be_read() {
    for_spots(|_, what, trial| {
        let fields = trial.fields("plate").stress;
        for (extreme, key, measure) in [
            ("max_von_mises", "von_mises", von_mises as fn([f64; 6]) -> f64),
            ("max_principal", "max_principal", max_principal as _),
        ] {
            let most = trial.get(&format!("plate.{extreme}"));
            let of_nodes = fields.iter().map(|stress| measure(*stress)).fold(f64::MIN, f64::max);
            assert!(off(of_nodes, most) < 1e-9, "{what} {extreme}: {of_nodes:e} {most:e}");
            for number in 0..places().len() {
                let found = trial.get(&format!("q{number}.{key}"));
                let slack = 1e-9 * trial.get("plate.max_von_mises");
                assert!(found <= most + slack, "{what} {extreme} at {number}: {found:e} {most:e}");
            }
        }
    });
}

#[test]
fn free_tops_of_bodies_that_yield_bear_little_traction() {
    for_spots(|_, what, trial| {
        let most = trial.get("plate.max_von_mises");
        for number in (0..places().len()).filter(|n| places()[*n][2] == 0.0) {
            for key in ["stress_zz", "stress_xz", "stress_yz"] {
                let found = trial.get(&format!("q{number}.{key}"));
                assert!(found.abs() < 0.5 * most, "{what}: {key} at {number} {found:e} {most:e}");
            }
        }
    });
}

/// Means over cells are those of stress within the law, and running maxima are extremes at some moment.
#[test]
fn means_and_running_maxima_stay_within_the_law() {
    let metal = &METALS[0];
    let grid = "[[field]]\nname = \"map\"\nin = \"plate\"\nplane = { y = 0.0 }\ngrid = [7, 5]\n\
                gives = [\"von_mises\", \"plastic_strain\"]\n";
    for order in [1, 2] {
        let text = plate(SHAPES[0], order, &metal.material(), metal.flux, "clamped = true", grid);
        let text = text.replacen("initial_", "peaks = [\"von_mises\"]\ninitial_", 1);
        let mut trial = Trial::new(&text);
        let mut highest = 0.0_f64;
        for _ in 0..4 {
            trial.step(5e-3);
            let most = trial.get("plate.max_von_mises");
            highest = highest.max(most);
            for name in trial.outputs().iter().filter(|name| name.starts_with("map.von_mises")) {
                let plastic = trial.get(&name.replace("von_mises", "plastic_strain"));
                let found = trial.get(name);
                assert!(found <= most * ROUNDED, "{name}: {found:e} {most:e}");
                assert!(found <= metal.bound(START, plastic) * ROUNDED, "{name}: {found:e}");
            }
        }
        assert!(off(trial.get("plate.peak_von_mises"), highest) < 1e-12);
    }
}

/// A plate that is held flat under a flux: each depth is a film that goes the bilinear way of its temperature.
#[test]
fn coarse_meshes_read_what_a_held_plate_bears() {
    let (thickness, stop) = (1e-3, 20e-3);
    for metal in METALS.iter().filter(|metal| metal.falls_to.is_none()) {
        let number = |key: &str| -> f64 {
            let rest = metal.text.split(&format!("{key} = ")).nth(1).unwrap();
            rest.split(',').next().unwrap().parse().unwrap()
        };
        let body = Conductor {
            conductivity: number("conductivity"),
            heat_capacity: number("density") * number("specific_heat"),
        };
        let film = Bilinear::film(
            number("young"),
            number("poisson"),
            metal.yield_stress,
            metal.isotropic,
            metal.kinematic,
        );
        // The face comes to four times the strain of first yield.
        let first = metal.yield_stress / (film.modulus * number("expansion"));
        let one = HeatedSlab { body, flux: 1.0, thickness }.rise_with_insulated_back(0.0, stop);
        let slab = HeatedSlab { body, flux: 4.0 * first / one, thickness };
        for order in [1, 2] {
            let depths = [0.0, 0.07, 0.15, 0.3, 0.5, 0.62, 0.8, 1.0].map(|part| part * thickness);
            let probe = |(n, z): (usize, f64)| {
                format!(
                    "[[probe]]\nname = \"q{n}\"\nin = \"plate\"\nat = [0.0, 0.0, {:e}]\n\
                     gives = [\"stress\", \"plastic_strain\"]\n",
                    -z
                )
            };
            let probes: String = depths.into_iter().enumerate().map(probe).collect();
            let spacing = 1e-4 * order as f64;
            let text = format!(
                "name = \"Held\"\nstop_time = {stop:e}\nstep = 1e-3\n[body.plate]\nkind = \"solid\"\n\
                 shape = {{ disc = {{ radius = 5e-4, thickness = {thickness:e} }} }}\n\
                 initial_temperature = {START:?}\nmaterial = {{ {} }}\n\
                 mesh = {{ spacing = 2.5e-4, depth_spacing = {spacing:e}, growth = 1.0, order = {order} }}\n\
                 [body.plate.faces]\ntop = {{ flux = {:e} }}\nbottom = {{ roller = true }}\nsides = {{ roller = true }}\n\
                 {probes}",
                metal.material(),
                slab.flux
            );
            let mut trial = Trial::new(&text);
            (0..4).for_each(|_| trial.step(0.25 * stop));
            for (n, depth) in depths.into_iter().enumerate() {
                let rise = slab.rise_with_insulated_back(depth, stop);
                let strain = -number("expansion") * rise;
                let wanted = film.stresses(&[strain])[0];
                let plastic = 2.0 * (strain - wanted / film.modulus).abs();
                let found = trial.get(&format!("q{n}.stress_xx"));
                let error = (found - wanted).abs() / metal.yield_stress;
                let far = (trial.get(&format!("q{n}.plastic_strain")) - plastic).abs()
                    / (4.0 * first * number("expansion"));
                // At the face plastic strain is no more than at the points below.
                assert!(
                    error < 0.06 && far < 0.15,
                    "{} {order} {depth:e}: {error} {far}",
                    metal.text
                );
            }
        }
    }
}

/// A film on rollers that is heated: its yield stress saturates as `s = Y(p)`, `p = 2 (α ΔT − s (1 − ν)/E)`, in the body
/// and in layers.
#[test]
fn yield_stress_saturates_in_small_strain() {
    let material = "{ model = \"elastoplastic\", density = 7800.0, specific_heat = 500.0, conductivity = 50.0, \
                    young = 200e9, poisson = 0.3, expansion = 12e-6, yield_stress = 200e6, \
                    hardening = { saturation = 400e6, rate = 100.0 } }";
    let (modulus, first, saturation, rate) = (200e9 / 0.7, 200e6, 400e6, 100.0);
    let plastic = |stress: f64| 2.0 * (12e-6 * 500.0 - stress / modulus);
    let mut wanted = 300e6;
    for _ in 0..200 {
        let found = saturation - (saturation - first) * f64::exp(-rate * plastic(wanted));
        wanted = 0.5 * (wanted + found);
    }
    let single = format!("material = {material}");
    let layers = [0.5e-3, 1.5e-3]
        .map(|thickness| format!("{{ thickness = {thickness:e}, material = {material} }}"));
    for of_body in [single, format!("layers = [{}]", layers.join(", "))] {
        for steps in [1, 10] {
            let text = format!(
                "name = \"Film\"\nstop_time = 100.0\nstep = 10.0\n[body.film]\nkind = \"solid\"\n\
                 shape = {{ box = [4e-3, 4e-3, 2e-3] }}\ninitial_temperature = 300.0\n{of_body}\n\
                 [body.film.faces]\nsides = {{ roller = true }}\nbottom = {{ roller = true, temperature = 800.0 }}\n\
                 top = {{ temperature = 800.0 }}\n[[probe]]\nname = \"a\"\nin = \"film\"\nat = [0.0, 0.0, -1e-3]\n\
                 gives = [\"stress\", \"plastic_strain\"]\n"
            );
            let mut trial = Trial::new(&text);
            (0..steps).for_each(|_| trial.step(100.0 / f64::from(steps)));
            assert!(off(trial.get("a.stress_xx"), -wanted) < 1e-6, "{steps}: {of_body}");
            assert!(off(trial.get("a.plastic_strain"), plastic(wanted)) < 1e-6, "{steps}");
        }
    }
}

/// Stress where nothing has yielded is that of the same body with a yield stress out of reach, to the rounding of
/// steps that are cut elsewhere.
#[test]
fn a_yield_stress_above_all_that_a_body_bears_changes_nothing() {
    for metal in [&METALS[0], &METALS[2]] {
        for shape in SHAPES {
            for order in [1, 2] {
                let read = |yield_stress: f64| {
                    let material = Metal { yield_stress, ..*metal }.material();
                    let text =
                        plate(shape, order, &material, metal.flux, "clamped = true", &probes());
                    let mut trial = Trial::new(&text);
                    (0..2).for_each(|_| trial.step(5e-3));
                    let is_stress = |name: &String| {
                        ["stress", "von_mises", "principal"].iter().any(|key| name.contains(key))
                    };
                    let names = trial.outputs().into_iter().filter(is_stress);
                    names.map(|name| (name.clone(), trial.get(&name))).collect::<Vec<_>>()
                };
                let free = read(1e13);
                let most = free.iter().find(|(name, _)| name == "plate.max_von_mises").unwrap().1;
                for ((name, found), (_, wanted)) in read(3.0 * most).iter().zip(&free) {
                    let off = (found - wanted).abs() / most;
                    assert!(off < 1e-6, "{shape} {order} {name}: {found:e} {wanted:e}");
                }
            }
        }
    }
}

/// Film and substrate: the elastic side bears what elasticity says, the other no more than its yield stress.
#[test]
fn both_sides_of_an_interface_keep_to_their_own_law() {
    let film = "model = \"elastoplastic\", density = 2700.0, specific_heat = 900.0, conductivity = 200.0, young = 70e9, \
                poisson = 0.33, expansion = 2.3e-5, yield_stress = 80e6";
    let silicon = "model = \"thermoelastic\", density = 2330.0, specific_heat = 700.0, conductivity = 148.0, \
                   young = 160e9, poisson = 0.22, expansion = 2.6e-6";
    let probe = |name: &str, z: f64, side: &str| {
        format!(
            "[[probe]]\nname = \"{name}\"\nin = \"plate\"\nat = [0.0, 0.0, {z:e}]\ngives = [\"stress\", \"plastic_strain\"]\n{side}"
        )
    };
    for shape in SHAPES {
        for order in [1, 2] {
            let probes = probe("above", -2e-4, "side = \"above\"\n")
                + &probe("below", -2e-4, "side = \"below\"\n")
                + &probe("top", 0.0, "");
            let one = format!("material = {{ {film} }}\n");
            let two = format!(
                "layers = [{{ material = {{ {film} }}, thickness = 2e-4 }}, \
                 {{ material = {{ {silicon} }}, thickness = 1.3e-3 }}]\n"
            );
            let text = plate(shape, order, film, 1.2e8, "clamped = true", &probes);
            let mut trial = Trial::new(&text.replace(&one, &two));
            (0..3).for_each(|_| trial.step(5e-3));
            for side in ["above", "top"] {
                let found = trial.get(&format!("{side}.von_mises"));
                assert!(found <= 80e6 * ROUNDED, "{shape} {order} {side}: {found:e}");
            }
            assert!(trial.get("top.plastic_strain") > 1e-4);
            assert_eq!(trial.get("below.plastic_strain"), 0.0);
            let highest = trial.get("plate.max_von_mises");
            assert!(trial.get("below.von_mises") <= highest * ROUNDED);
        }
    }
}

/// A quarter has no place for stress that is not even about its planes: the step and the reading are refused, and nothing
/// changes.
#[test]
fn quarters_refuse_uneven_temperatures() {
    for (model, own) in [
        ("elastoplastic", "yield_stress = 3e8"),
        ("viscoelastic", "shear_relaxation = [{ fraction = 0.5, time = 1.0 }]"),
        ("thermoelastic", "fracture = { model = \"at1\", strength = 180e6, energy = 2e4 }"),
    ] {
        let text = format!(
            "name = \"Quarter\"\nstop_time = 1.0\nstep = 0.01\n[body.plate]\nkind = \"solid\"\n\
             shape = {{ box = [2e-3, 2e-3, 0.5e-3] }}\nsymmetry = \"quarter\"\ninitial_temperature = 293.15\n\
             mesh = {{ spacing = 0.25e-3, depth_spacing = 0.25e-3, growth = 1.0, order = 1 }}\n\
             material = {{ model = \"{model}\", density = 3950.0, specific_heat = 900.0, conductivity = 10.0, \
             young = 200e9, poisson = 0.3, expansion = 1.2e-5, {own} }}\n[body.plate.faces]\n\
             bottom = {{ clamped = true }}\nleft = {{ temperature = 293.15 }}\nright = {{ temperature = 293.15 }}\n\
             [[probe]]\nname = \"p\"\nin = \"plate\"\nat = [0.4e-3, 0.0, 0.0]\ngives = [\"stress\"]\n"
        );
        let mut trial = Trial::new(&text);
        for side in ["left", "right"] {
            trial.set(&format!("plate.{side}.temperature"), 320.0);
        }
        trial.step(0.01);
        trial.set("plate.right.temperature", 330.0);
        let before = trial.state.clone();
        let refusal = trial.try_step(0.01).map_or_else(|e| e.to_string(), |()| "none".into());
        assert!(refusal.contains("not even") && refusal.contains("none"), "{model}: {refusal}");
        assert!(trial.state.bodies == before.bodies, "{model}");
    }
}
