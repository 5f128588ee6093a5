//! Hosts that are not as most are, played by a program in C: see `c/host.c`.

#![cfg(target_os = "linux")]

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use impinge::fmi::guid;
use impinge::scene;
use impinge::variables::{ArrayRegistry, Registry};

use crate::master::{Folder, SCENE, library};

/// A clamped disc, whose stiffness is that of a meridian section.
const DISC: &str = r#"
name = "Disc"
stop_time = 10.0
step = 0.5
[body.bed]
kind = "solid"
shape = { disc = { radius = 40e-3, thickness = 6e-3 } }
material = { model = "thermoelastic", density = 7850.0, specific_heat = 470.0, conductivity = 45.0, young = 200e9, poisson = 0.29, expansion = 12e-6 }
initial_temperature = 293.15
mesh = { spacing = 1e-3, depth_spacing = 0.5e-3 }
[body.bed.faces]
top = { convection = { coefficient = 30.0, ambient = 293.15 } }
sides = { clamped = true }
[[load]]
name = "heater"
on = "bed.bottom"
footprint = { disc = { radius = 30e-3 } }
carries = ["heat_flux"]
start = { heat_flux = 1e5 }
[[probe]]
name = "centre"
in = "bed"
at = [0.0, 0.0, -1e-3]
gives = ["temperature", "stress"]
"#;

/// Enough particles for some threads.
const DROP: &str = r#"
name = "Drop"
stop_time = 1e-6
step = 1e-8
[body.drop]
kind = "droplet"
diameter = 1e-4
impact_velocity = 20.0
initial_temperature = 350.0
spacing = 5e-6
fluid = { density = 1000.0, viscosity = 1e-3, specific_heat = 4180.0, conductivity = 0.6, surface_tension = 0.07 }
"#;

/// A drop on a plate whose stresses are solved for when they are read.
const IMPACT: &str = r#"
name = "Impact"
stop_time = 4e-6
step = 1e-7
[body.drop]
kind = "droplet"
diameter = 1e-4
impact_velocity = 20.0
initial_temperature = 350.0
spacing = 1.25e-5
fluid = { density = 1000.0, viscosity = 1e-3, specific_heat = 4180.0, conductivity = 0.6 }
arrivals = [{ x = 2e-4, y = -1e-4 }]
[body.plate]
kind = "solid"
shape = { box = [1e-3, 1e-3, 2e-4] }
material = { model = "thermoelastic", density = 3950.0, specific_heat = 900.0, conductivity = 10.0, young = 300e9, poisson = 0.21, expansion = 8.1e-6 }
initial_temperature = 300.0
mesh = { spacing = 5e-5, depth_spacing = 1e-5, growth = 1.8, order = 1 }
[body.plate.faces]
sides = { clamped = true }
[[coupling]]
from = "drop"
to = "plate.top"
interval = 5e-8
radius = 2e-4
"#;

const LOAD: &str = r#"
[[load]]
name = "spot"
on = "plate.top"
footprint = { disc = { radius = 2e-4 } }
carries = ["heat_flux", "pressure"]
start = { heat_flux = 1e6 }
"#;

struct Case {
    folder: Folder,
    /// All arguments behind the library's, of FMI 2.0 and 3.0.
    arguments: [Vec<String>; 2],
}

impl Case {
    fn new(text: &str, step: f64, outputs: &[&str]) -> Self {
        let folder = Folder::with_scene("host", text);
        let scene = scene::parse(text, "scene.toml").unwrap();
        let registry = Registry::of(&scene);
        let arrays = ArrayRegistry::of(&scene);
        let arguments = |version: &str, resources: String, find: &dyn Fn(&str) -> usize| {
            let guid = guid::guid(text, &registry);
            let mut all = vec![version.into(), resources, guid];
            all.push(find("solver.threads").to_string());
            all.push(step.to_string());
            all.extend(outputs.iter().map(|name| find(name).to_string()));
            all
        };
        let arguments = [
            arguments("2", folder.uri(), &|name| registry.find(name).unwrap()),
            arguments("3", format!("{}/", folder.0.display()), &|name| arrays.find(name).unwrap()),
        ];
        Self { folder, arguments }
    }

    fn all() -> [Self; 4] {
        let plate =
            ["centre.temperature", "centre.stress_zz", "plate.heat_in", "plate.max_von_mises"];
        let disc = ["centre.temperature", "centre.stress_xx", "bed.heat_in", "bed.max_von_mises"];
        let particles = SCENE.replace("mesh = { spacing", "heat = \"sph\"\nmesh = { spacing");
        [
            Self::new(SCENE, 1e-8, &plate),
            Self::new(&particles, 1e-8, &plate),
            Self::new(DISC, 0.5, &disc),
            Self::new(DROP, 1e-8, &["drop.kinetic_energy", "drop.height"]),
        ]
    }

    /// A drop on a plate.
    fn impact() -> Self {
        let outputs = ["drop.kinetic_energy", "plate.max_temperature", "plate.max_von_mises"];
        Self::new(IMPACT, 1e-7, &outputs)
    }

    /// What a host prints that plays this.
    fn play(&self, name: &str, version: usize) -> Vec<String> {
        library();
        let path = env::current_exe().unwrap().with_file_name("libimpinge.so");
        let ran = Command::new(program())
            .current_dir(&self.folder.0)
            .arg(name)
            .arg(&path)
            .args(&self.arguments[version - 2])
            // What threads keep of what was freed counts as handed out.
            .env("GLIBC_TUNABLES", "glibc.malloc.tcache_count=0")
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&ran.stderr);
        assert!(ran.status.success(), "{name}, FMI {version}: {:?}: {said}", ran.status);
        assert_eq!(said, "", "{name}, FMI {version}");
        String::from_utf8(ran.stdout).unwrap().lines().map(str::to_owned).collect()
    }
}

/// The program, compiled once.
fn program() -> &'static Path {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    PROGRAM.get_or_init(|| {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let program = Path::new(env!("CARGO_TARGET_TMPDIR")).join("host");
        let compiled = Command::new("cc")
            .args(["-std=gnu11", "-Wall", "-Wextra", "-Werror", "-rdynamic"])
            .arg(format!("-I{}", root.join("include").display()))
            .arg(root.join("tests/fmi/c/host.c"))
            .arg("-o")
            .arg(&program)
            .args(["-ldl", "-lpthread", "-lm"])
            .output()
            .unwrap();
        assert!(compiled.status.success(), "{}", String::from_utf8_lossy(&compiled.stderr));
        program
    })
}

/// Every unit gives in these hosts, in both versions, the bits that it gives in a plain one.
fn expect_the_same_bits(plays: &[(&str, usize)]) {
    for case in Case::all() {
        let plain = case.play("plain", 2);
        assert_eq!(plain.len(), 1);
        assert!(plain[0].split_whitespace().any(|bits| bits != "0000000000000000"), "{plain:?}");
        for version in [2, 3] {
            for &(play, lines) in plays {
                let found = case.play(play, version);
                assert_eq!(found, vec![plain[0].clone(); lines], "{play}, FMI {version}");
            }
        }
    }
}

#[test]
fn a_library_whose_instances_are_gone_leaves_the_process_without_a_trace() {
    expect_the_same_bits(&[("unload", 4), ("again", 8)]);
}

#[test]
fn a_thread_with_little_stack_may_call() {
    expect_the_same_bits(&[("stack", 1)]);
}

#[test]
fn a_thread_with_very_little_stack_may_read_stresses() {
    let impact = Case::impact();
    let plate = IMPACT.split("[[coupling]]").next().unwrap();
    let [head, plate] = [plate.split("[body.drop]").next(), plate.split("[body.plate]").nth(1)];
    let text = format!("{}[body.plate]{}{LOAD}", head.unwrap(), plate.unwrap());
    let outputs = ["plate.max_temperature", "plate.max_von_mises", "plate.heat_in"];
    for case in [impact, Case::new(&text, 1e-7, &outputs)] {
        let plain = case.play("plain", 2);
        for version in [2, 3] {
            assert_eq!(case.play("little stack", version), plain, "FMI {version}");
        }
    }
}

#[test]
fn little_address_space_is_enough() {
    expect_the_same_bits(&[("space", 1)]);
}

/// The largest limit is enough from each of three moments on, the smallest is not. How many others are enough depends
/// on addresses, too: whether the C library finds room for a thread's arena.
fn expect_some_refused(version: usize, complete: usize) {
    assert!((3..37).contains(&complete), "FMI {version}: {complete} of 37");
}

/// Whatever is left, and from whichever moment on, a host is answered: it never ends in a call.
#[test]
fn too_little_address_space_is_refused() {
    let [plate, ..] = Case::all();
    for (case, version) in [(&plate, 2), (&plate, 3), (&Case::impact(), 2)] {
        let complete: usize = case.play("sweep", version)[0].parse().unwrap();
        expect_some_refused(version, complete);
    }
}

#[test]
fn too_little_data_is_refused() {
    let [plate, _, disc, _] = Case::all();
    let outputs = ["centre.temperature", "bed.heat_in", "bed.max_temperature"];
    let reduced = DISC.replace("step = 0.5\n", "step = 0.5\n[fidelity]\nlevel = \"reduced\"\n");
    let reduced = reduced.replace(r#", "stress"]"#, "]");
    let newton = DISC.replace("step = 0.5\n", "step = 0.5\n[solver]\nmethod = \"newton\"\n");
    let reduced = Case::new(&reduced, 0.5, &outputs[..2]);
    let newton = Case::new(&newton, 0.5, &outputs);
    let all = [&plate, &plate, &disc, &Case::impact(), &reduced, &newton];
    for (case, version) in all.into_iter().zip([2, 3, 2, 2, 2, 3]) {
        let complete: usize = case.play("sweep of data", version)[0].parse().unwrap();
        expect_some_refused(version, complete);
    }
}

#[test]
fn threads_that_cannot_start_are_done_without() {
    expect_the_same_bits(&[("no threads", 2)]);
}

#[test]
fn a_forked_process_goes_on_and_begins_anew() {
    expect_the_same_bits(&[("fork", 5), ("fork within calls", 8)]);
}

/// Another thread is in a call at each of these moments, holds what is shared and makes what others wait for;
/// so does the C library, which frees what a thread before has left.
#[test]
fn a_fork_at_any_start_of_a_thread_leaves_a_child_that_runs() {
    expect_the_same_bits(&[("fork at starts", 1)]);
}

#[test]
fn traps_of_the_host_stay_set_and_kill_nothing() {
    expect_the_same_bits(&[("traps", 1)]);
}

#[test]
fn rounding_and_subnormals_of_the_host_change_no_bit_and_stay() {
    let flushing = cfg!(target_arch = "x86_64").then_some(("flushing", 1));
    let plays: Vec<_> = [("rounding", 4)].into_iter().chain(flushing).collect();
    expect_the_same_bits(&plays);
}

#[test]
fn signals_stay_with_the_host() {
    expect_the_same_bits(&[("timer", 1)]);
}
