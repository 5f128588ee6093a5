//! Meshes are fine where heat enters, on every face and by every kind of condition: those that a scene
//! asks for and those that are chosen.

use crate::common::{Trial, off, sweep};
use impinge::closed_form::{
    Conductor, ConvectiveSlab, ConvectiveSurface, SuddenSurface, UniformFlux,
};
use impinge::model::forecast;
use impinge::scene;

/// Name, density, specific heat, conductivity.
const MATERIALS: [(&str, f64, f64, f64); 6] = [
    ("steel", 7850.0, 470.0, 45.0),
    ("glass", 2500.0, 840.0, 1.0),
    ("polymer", 1200.0, 1500.0, 0.2),
    ("alumina", 3950.0, 900.0, 10.0),
    ("copper", 8960.0, 385.0, 400.0),
    ("aerogel", 100.0, 1000.0, 0.015),
];
/// Edge of the box, thickness and radius of the disc [m].
const LENGTH: f64 = 1e-3;
/// What drives the heat [K].
const AMBIENT: f64 = 100.0;
const INITIAL: f64 = 300.0;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Convective,
    Flux,
    Prescribed,
}

const KINDS: [Kind; 3] = [Kind::Convective, Kind::Flux, Kind::Prescribed];

/// A body of one material and a face that heat passes, run to a Fourier number.
#[derive(Clone, Copy)]
struct Case<'a> {
    material: (&'a str, f64, f64, f64),
    kind: Kind,
    shape: &'a str,
    face: &'a str,
    /// `at/L²` of a step, and steps.
    fourier: f64,
    steps: usize,
    biot: f64,
    mesh: &'a str,
}

impl Case<'_> {
    fn conductor(&self) -> Conductor {
        let (_, density, specific_heat, conductivity) = self.material;
        Conductor { conductivity, heat_capacity: density * specific_heat }
    }

    fn step(&self) -> f64 {
        self.fourier * LENGTH * LENGTH / self.conductor().diffusivity()
    }

    /// Heat transfer coefficient of the Biot number, and the flux that it would bring at first.
    fn coefficient(&self) -> f64 {
        self.biot * self.conductor().conductivity / LENGTH
    }

    fn scene(&self) -> String {
        let (_, density, specific_heat, conductivity) = self.material;
        let (coefficient, flux) = (self.coefficient(), self.coefficient() * AMBIENT);
        let ambient = INITIAL + AMBIENT;
        let condition = match self.kind {
            Kind::Convective => {
                format!("convection = {{ coefficient = {coefficient:?}, ambient = {ambient:?} }}")
            }
            Kind::Flux => format!("flux = {flux:?}"),
            Kind::Prescribed => format!("temperature = {ambient:?}"),
        };
        format!(
            r#"
name = "Fine"
stop_time = {:?}
step = {:?}
fidelity = {{ tolerance = 1e-3 }}
[body.b]
kind = "solid"
shape = {}
material = {{ model = "thermoelastic", density = {density:?}, specific_heat = {specific_heat:?}, conductivity = {conductivity:?}, young = 70e9, poisson = 0.25, expansion = 8e-6 }}
initial_temperature = {INITIAL:?}
mesh = {{ {} }}
[body.b.faces]
{} = {{ {condition} }}
"#,
            self.step() * self.steps as f64,
            self.step(),
            self.shape,
            self.mesh,
            self.face,
        )
    }

    /// Largest relative error over the steps: of the highest temperature, which is the surface's, or
    /// where that is held of the heat that came in.
    fn error(&self) -> f64 {
        let (body, h) = (self.conductor(), self.coefficient());
        let area = match (self.shape, self.face) {
            (BOX, "top" | "bottom" | "left" | "right" | "front" | "back") => LENGTH * LENGTH,
            (_, "top" | "bottom") => std::f64::consts::PI * LENGTH * LENGTH,
            _ => 2.0 * std::f64::consts::PI * LENGTH * LENGTH,
        };
        let mut trial = Trial::new(&self.scene());
        let mut worst: f64 = 0.0;
        for step in 1..=self.steps {
            trial.step(self.step());
            let t = self.step() * step as f64;
            let rise = trial.get("b.max_temperature") - INITIAL;
            let error = match self.kind {
                Kind::Flux => off(rise, UniformFlux { body, flux: h * AMBIENT }.rise(0.0, t)),
                Kind::Convective => {
                    let slab = ConvectiveSlab {
                        body,
                        thickness: LENGTH,
                        coefficient: h,
                        ambient: AMBIENT,
                    };
                    off(rise, slab.rise(0.0, t))
                }
                Kind::Prescribed => {
                    let heat = 2.0 * t * SuddenSurface { body, step: AMBIENT }.flux(t) * area;
                    off(trial.get("b.heat_stored"), heat)
                }
            };
            worst = worst.max(error);
        }
        worst
    }

    /// Smallest distances of nodes along the axes, of a mesh that is planned.
    fn spacing(&self) -> [f64; 3] {
        let scene = scene::parse(&self.scene(), "scene").unwrap();
        forecast(&scene).bodies[0].spacing.map(|[least, _]| least)
    }
}

const BOX: &str = "{ box = [1e-3, 1e-3, 1e-3] }";
const DISC: &str = "{ disc = { radius = 1e-3, thickness = 1e-3 } }";

/// Shapes, faces and the axes of the faces' normals.
const FACES: [(&str, &str, usize); 9] = [
    (BOX, "top", 2),
    (BOX, "bottom", 2),
    (BOX, "left", 0),
    (BOX, "right", 0),
    (BOX, "front", 1),
    (BOX, "back", 1),
    (DISC, "top", 2),
    (DISC, "bottom", 2),
    (DISC, "sides", 0),
];

fn case<'a>(shape: &'a str, face: &'a str, kind: Kind, mesh: &'a str) -> Case<'a> {
    Case { material: MATERIALS[0], kind, shape, face, fourier: 2.5e-5, steps: 4, biot: 5.0, mesh }
}

#[test]
fn chosen_meshes_resolve_the_first_step_on_every_face_of_every_kind_and_material() {
    for (i, (shape, face, _)) in FACES.into_iter().enumerate() {
        for (j, kind) in KINDS.into_iter().enumerate() {
            // Two of the six materials each, all six over the faces and kinds.
            for material in [MATERIALS[(i + j) % 6], MATERIALS[(i + j + 3) % 6]] {
                let error = Case { material, ..case(shape, face, kind, "") }.error();
                // Around a cylinder heat gathers by half of √(at)/R more than on a plane.
                let bound = if face == "sides" { 6e-3 } else { 1e-3 };
                assert!(error < bound, "{} {shape} {face} {kind:?}: {error:e}", material.0);
            }
        }
    }
}

#[test]
fn slabs_that_meet_a_fluid_follow_the_series_at_all_biot_and_fourier_numbers() {
    for material in MATERIALS {
        for biot in [0.1, 5.0, 100.0] {
            for fourier in [1e-4, 1e-3, 1e-2, 0.2, 1.0] {
                let top = case(BOX, "top", Kind::Convective, "");
                let case = Case { material, biot, fourier: 0.25 * fourier, ..top };
                let error = case.error();
                assert!(error < 1e-3, "{} Bi {biot} Fo {fourier}: {error:e}", material.0);
            }
        }
    }
}

#[test]
fn the_distances_that_a_scene_asks_for_are_meshed_on_every_face() {
    for (shape, face, axis) in FACES {
        for kind in KINDS {
            for wanted in [1e-5, 2.5e-6] {
                let named = format!("spacing = {wanted:e}");
                let found = case(shape, face, kind, &named).spacing()[axis];
                let fits = found <= wanted * (1.0 + 1e-9) && found > 0.6 * wanted;
                assert!(fits, "{shape} {face} {kind:?}: {found:e}, asked for {wanted:e}");
            }
        }
    }
}

#[test]
fn depth_and_surface_spacing_are_meshed_apart() {
    for face in ["top", "bottom"] {
        for kind in KINDS {
            let mesh = "spacing = 1.5e-5, depth_spacing = 1e-6";
            let [x, y, z] = case(BOX, face, kind, mesh).spacing();
            assert!(z <= 1.000001e-6 && z > 0.6e-6, "{face} {kind:?}: {z:e}");
            for lateral in [x, y] {
                assert!(lateral <= 1.50001e-5 && lateral > 0.9e-5, "{face} {kind:?}: {lateral:e}");
            }
        }
    }
    let [x, _, z] = case(BOX, "left", Kind::Flux, "depth_spacing = 2e-5").spacing();
    assert!(z <= 2.00001e-5, "{z:e}");
    assert!(x < 5e-6, "the side has its chosen distance, {x:e}");
}

#[test]
fn coarser_meshes_than_the_layer_are_as_inaccurate_as_they_were_asked_to_be() {
    let errors = ["spacing = 1e-4, growth = 1.0", "spacing = 2e-5", "spacing = 2e-6"]
        .map(|mesh| case(BOX, "top", Kind::Convective, mesh).error());
    assert!(errors[0] > 0.3 && errors[2] < 1e-3, "{errors:?}");
    assert!(errors.is_sorted_by(|a, b| a > b), "{errors:?}");
}

/// A heated top over nodes that the scene sets too far apart below it.
#[test]
fn the_time_until_a_named_depth_is_resolved_is_told() {
    for (name, density, specific_heat, conductivity) in MATERIALS {
        let body = Conductor { conductivity, heat_capacity: density * specific_heat };
        let resolved = 0.4 * 1e-10 / body.diffusivity();
        let heated = |stop: f64, mesh: &str| {
            let text = format!(
                r#"
name = "Depth"
stop_time = {stop:e}
step = {stop:e}
[body.b]
kind = "solid"
shape = {BOX}
material = {{ model = "thermoelastic", density = {density}, specific_heat = {specific_heat}, conductivity = {conductivity} }}
initial_temperature = 300.0
faces = {{ top = {{ flux = 1e4 }} }}
{mesh}
"#
            );
            let mut trial = Trial::new(&text);
            trial.step(stop);
            let rise = trial.get("b.max_temperature") - 300.0;
            let notes = trial.model.notes().join("\n");
            let told = notes.contains(&format!("is resolved after {resolved:.1e} s"));
            (rise / UniformFlux { body, flux: 1e4 }.rise(0.0, stop), told)
        };
        let depth = "mesh = { depth_spacing = 1e-5 }";
        let (early, told) = heated(0.05 * resolved, depth);
        assert!(told && early < 0.8, "{name}: {early}");
        let (early, told) = heated(0.05 * resolved, "");
        assert!(!told && off(early, 1.0) < 1e-3, "{name}: {early}");
        let (late, told) = heated(1.1 * resolved, depth);
        assert!(!told && off(late, 1.0) < 0.05, "{name}: {late}");
    }
}

#[test]
fn a_long_experiment_read_early_is_right() {
    let text = |stop: f64| {
        format!(
            r#"
name = "Early"
stop_time = {stop:?}
step = 1e-6
[body.p]
kind = "solid"
shape = {{ disc = {{ radius = 1e-3, thickness = 0.5e-3 }} }}
material = {{ model = "thermoelastic", density = 4500.0, specific_heat = 520.0, conductivity = 20.0, young = 110e9, poisson = 0.3, expansion = 9e-6 }}
initial_temperature = 300.0
[[load]]
name = "l"
on = "p.top"
footprint = {{ disc = {{ radius = 4e-4 }} }}
carries = ["heat_flux"]
start = {{ heat_flux = 1e8 }}
[[probe]]
name = "a"
in = "p"
at = [0.0, 0.0, 0.0]
gives = ["temperature"]
[refinement.p]
along = 1.0
through = 1.0
"#
        )
    };
    let body = Conductor { conductivity: 20.0, heat_capacity: 4500.0 * 520.0 };
    let exact = UniformFlux { body, flux: 1e8 };
    for stop in [1.0, 1e-4] {
        let mut trial = Trial::new(&text(stop));
        for time in [1e-6, 1e-5, 1e-4] {
            trial.step(time - trial.state.time);
            let rise = trial.get("a.temperature") - 300.0;
            let error = off(rise, exact.rise(0.0, time));
            assert!(error < 2e-3, "stop {stop} s, read at {time} s: {error:e}");
        }
    }
}

#[test]
fn a_half_space_under_weak_convection_is_resolved_inside_too() {
    let top = case(BOX, "top", Kind::Convective, "");
    for material in MATERIALS {
        let case = Case { material, biot: 0.5, fourier: 1e-4, ..top };
        let mut probes = case.scene();
        for (i, depth) in [0.0, 1e-5, 3e-5].into_iter().enumerate() {
            probes += &format!(
                "[[probe]]\nname = \"p{i}\"\nin = \"b\"\nat = [0.0, 0.0, {:?}]\ngives = \
                 [\"temperature\"]\n",
                -depth
            );
        }
        let mut trial = Trial::new(&probes);
        let (body, coefficient) = (case.conductor(), case.coefficient());
        let exact = ConvectiveSurface { body, coefficient, ambient: AMBIENT };
        for step in 1..=case.steps {
            trial.step(case.step());
            let t = step as f64 * case.step();
            for (i, depth) in [0.0, 1e-5, 3e-5].into_iter().enumerate() {
                let rise = trial.get(&format!("p{i}.temperature")) - INITIAL;
                let error = (rise - exact.rise(depth, t)).abs() / exact.rise(0.0, t);
                assert!(error < 3e-3, "{} at {depth} m after {t} s: {error:e}", material.0);
            }
        }
    }
}

/// A disc of flux, of which no place gets warmer than a half space under it: until heat has gone half a node's
/// distance along the surface nodes beside the edge do, and the scene is told when that is over.
#[test]
fn the_time_until_edges_are_resolved_is_told() {
    for (name, density, specific_heat, conductivity) in
        sweep(&[MATERIALS[0], MATERIALS[2], MATERIALS[3]], &[0])
    {
        let heated = |stop: f64| {
            let text = format!(
                r#"
name = "Edge"
stop_time = {stop:e}
step = {:e}
[body.plate]
kind = "solid"
shape = {{ box = [4e-3, 4e-3, 1e-3] }}
material = {{ model = "thermoelastic", density = {density}, specific_heat = {specific_heat}, conductivity = {conductivity} }}
initial_temperature = 300.0
[[load]]
name = "spot"
on = "plate.top"
carries = ["heat_flux"]
footprint = {{ disc = {{ radius = 1e-3 }} }}
"#,
                0.1 * stop
            );
            let mut trial = Trial::new(&text);
            trial.set("spot.heat_flux", 1e5);
            trial.step(stop);
            let effusivity = f64::sqrt(density * specific_heat * conductivity);
            let bound = 2e5 * (stop / std::f64::consts::PI).sqrt() / effusivity;
            let notes = trial.model.notes().join("\n");
            ((trial.get("plate.max_temperature") - 300.0) / bound, notes)
        };
        let conductor = Conductor { conductivity, heat_capacity: density * specific_heat };
        // Nodes lie a tenth of the radius apart.
        let resolved = (0.5 * 1e-4f64).powi(2) / conductor.diffusivity();
        let (early, notes) = heated(0.1 * resolved);
        assert!(notes.contains(&format!("is resolved after {resolved:.1e} s")), "{name}: {notes}");
        let (now, _) = heated(resolved);
        assert!((0.9..1.06).contains(&now), "{name}: {now}");
        assert!((1.0..1.4).contains(&early), "{name}: {early}");
        let (late, notes) = heated(10.0 * resolved);
        assert!(!notes.contains("is resolved after"), "{name}: {notes}");
        assert!((0.7..1.005).contains(&late), "{name}: {late}");
    }
}
