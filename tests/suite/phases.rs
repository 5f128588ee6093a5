//! Fluids that would freeze or boil: a warning as they do, none before, and no other result.

use std::cell::RefCell;
use std::collections::BTreeSet;

use crate::common::Trial;
use impinge::advice::parse_with_warnings;
use impinge::model::forecast;
use impinge::scene::parse;

/// Density, viscosity, specific heat, conductivity, surface tension; temperature of the drop, of the plate; freezes,
/// boils.
type Case = (&'static str, [f64; 5], [f64; 2], [f64; 2]);
const TIN: Case = ("tin", [6970.0, 1.9e-3, 250.0, 30.0, 0.55], [550.0, 300.0], [505.1, 2875.0]);
const WATER: Case = ("water", [998.0, 1e-3, 4180.0, 0.6, 0.072], [300.0, 200.0], [273.15, 373.15]);
const WAX: Case = ("wax", [780.0, 4e-3, 2100.0, 0.15, 0.027], [350.0, 250.0], [330.0, 620.0]);
const STEAM: Case =
    ("water on hot steel", [998.0, 1e-3, 4180.0, 0.6, 0.072], [300.0, 700.0], [273.15, 373.15]);
const ETHANOL: Case =
    ("ethanol", [789.0, 1.2e-3, 2440.0, 0.17, 0.022], [300.0, 280.0], [159.0, 351.4]);

/// Alumina.
const PLATE: [f64; 3] = [3950.0, 900.0, 10.0];

fn scene(method: &str, case: Case, points: bool) -> String {
    let (_, [density, viscosity, heat, conductivity, tension], [drop, plate], [freezes, boils]) =
        case;
    let points = match points {
        true => format!(", freezes_at = {freezes:?}, boils_at = {boils:?}"),
        false => String::new(),
    };
    // A film has no particles.
    let of_particles = match method {
        "sph" => "symmetry = \"quarter\"\nspacing = 6e-6\n",
        _ => "",
    };
    format!(
        "name = \"Phases\"\nstop_time = 4e-5\nstep = 1e-6\n[body.drop]\nkind = \"droplet\"\nmethod = \
         \"{method}\"\n{of_particles}diameter = 6e-5\nimpact_velocity = 10.0\ninitial_temperature = {drop:?}\nfluid = \
         {{ density = {density:?}, viscosity = {viscosity:?}, specific_heat = {heat:?}, conductivity = {conductivity:?}, \
         surface_tension = {tension:?}{points} }}\n[body.plate]\nkind = \"solid\"\nshape = {{ box = [4e-4, 4e-4, 1e-4] \
         }}\nmaterial = {{ model = \"thermoelastic\", density = {:?}, specific_heat = {:?}, conductivity = {:?} \
         }}\ninitial_temperature = {plate:?}\nmesh = {{ spacing = 1e-5, order = 1 }}\n[[coupling]]\nfrom = \"drop\"\nto = \
         \"plate.top\"\n",
        PLATE[0], PLATE[1], PLATE[2]
    )
}

/// Steps through a scene; its warnings with the coldest and hottest fluid of particles, step by step.
fn run(trial: &mut Trial) -> Vec<(f64, Vec<String>)> {
    let said = RefCell::new(BTreeSet::new());
    let mut steps = Vec::new();
    for _ in 0..40 {
        trial.step(1e-6);
        let found =
            trial.model.phase_warnings(&trial.state, |subject| said.borrow().contains(subject));
        let messages = found.iter().map(|warning| warning.to_string()).collect();
        said.borrow_mut().extend(found.iter().map(|warning| warning.subject().to_owned()));
        steps.push((trial.state.time, messages));
    }
    steps
}

/// Temperature of the contact of two half spaces [K].
fn contact(case: Case) -> f64 {
    let (_, [density, _, heat, conductivity, _], [drop, plate], _) = case;
    let own = (density * heat * conductivity).sqrt();
    let below = (PLATE[0] * PLATE[1] * PLATE[2]).sqrt();
    (own * drop + below * plate) / (own + below)
}

#[test]
fn fluid_beyond_its_points_warns_once_in_the_step_that_takes_it_there() {
    for (case, wanted) in [
        (TIN, Some("freezes_at")),
        (WATER, Some("freezes_at")),
        (WAX, Some("freezes_at")),
        (STEAM, Some("boils_at")),
        (ETHANOL, None),
    ] {
        for method in ["sph", "film"] {
            let mut trial = Trial::new(&scene(method, case, true));
            let steps = run(&mut trial);
            let all: Vec<&String> = steps.iter().flat_map(|(_, messages)| messages).collect();
            let name = case.0;
            assert_eq!(all.len(), usize::from(wanted.is_some()), "{name}, {method}: {all:?}");
            let Some(key) = wanted else { continue };
            let (time, _) = steps.iter().find(|(_, messages)| !messages.is_empty()).unwrap();
            for words in [key.to_owned(), format!("at {time:.3e} s"), "drop: ".to_owned()] {
                assert!(all[0].contains(&words), "{name}, {method}: {words} is not in {}", all[0]);
            }
        }
    }
}

/// Glycerol neither freezes nor boils on these plates, but the library knows it up to 373 K alone.
#[test]
fn fluids_of_the_library_warn_beyond_their_range() {
    for (plate, is_warned) in [(600.0, true), (310.0, false)] {
        for method in ["sph", "film"] {
            let case = ("glycerol", STEAM.1, [300.0, plate], STEAM.3);
            let text = scene(method, case, false);
            let (before, rest) = text.split_once("fluid = {").unwrap();
            let (_, after) = rest.split_once("}\n").unwrap();
            let mut trial = Trial::new(&format!("{before}fluid = \"glycerol\"\n{after}"));
            let steps = run(&mut trial);
            let all: Vec<&String> = steps.iter().flat_map(|(_, messages)| messages).collect();
            assert_eq!(all.len(), usize::from(is_warned), "{plate} {method}: {all:?}");
            assert!(all.iter().all(|text| text.contains("beyond the 373.15 K")), "{all:?}");
        }
    }
}

/// The step that warns is the first after which a particle is beyond the point.
#[test]
fn particles_warn_with_the_first_step_beyond() {
    for case in [TIN, WATER, WAX] {
        let mut trial = Trial::new(&scene("sph", case, true));
        let point = case.3[0];
        let mut coldest = Vec::new();
        let mut warned = Vec::new();
        for _ in 0..40 {
            trial.step(1e-6);
            coldest.push(trial.get("drop.min_temperature") < point);
            warned.push(!trial.model.phase_warnings(&trial.state, |_| false).is_empty());
        }
        assert_eq!(warned, coldest, "{}", case.0);
        assert!(coldest.contains(&true), "{}", case.0);
    }
}

#[test]
fn what_is_watched_changes_no_bit_of_a_run() {
    for method in ["sph", "film"] {
        let [watched, plain] = [true, false].map(|points| {
            let mut trial = Trial::new(&scene(method, TIN, points));
            run(&mut trial);
            trial.state
        });
        assert_eq!(watched, plain, "{method}");
    }
}

#[test]
fn warnings_follow_from_a_state_that_is_restored() {
    let mut trial = Trial::new(&scene("sph", TIN, true));
    (0..10).for_each(|_| trial.step(1e-6));
    let half = trial.state.clone();
    let said = trial.model.phase_warnings(&half, |_| false);
    (0..3).for_each(|_| trial.step(1e-6));
    trial.restart(&half);
    assert_eq!(trial.model.phase_warnings(&trial.state, |_| false), said);
    assert!(trial.model.phase_warnings(&half, |subject| subject == said[0].subject()).is_empty());
}

#[test]
fn freezing_and_boiling_on_contact_warn_before_a_run() {
    let notes = |text: &str| {
        let scene = parse(text, "scene.toml").unwrap();
        forecast(&scene).droplets[0].notes.join("\n")
    };
    for method in ["sph", "film"] {
        for (case, verdict) in [
            (TIN, Some("freezes_at")),
            (WATER, Some("freezes_at")),
            (WAX, Some("freezes_at")),
            (STEAM, Some("boils_at")),
            (ETHANOL, None),
        ] {
            let text = scene(method, case, true);
            let predicted = format!("predicted to be at {:.1} K", contact(case));
            let said = notes(&text);
            assert!(said.contains(&predicted), "{}: {said}", case.0);
            let (_, found) = parse_with_warnings(&text, "scene.toml").unwrap();
            let found: Vec<String> = found.iter().map(ToString::to_string).collect();
            let of_contact: Vec<_> =
                found.iter().filter(|warning| warning.contains(&predicted)).collect();
            assert_eq!(of_contact.len(), usize::from(verdict.is_some()), "{}: {found:?}", case.0);
            if let Some(key) = verdict {
                assert!(of_contact[0].contains(&format!("body.drop.fluid.{key} =")), "{found:?}");
            }
            let said = notes(&scene(method, case, false));
            assert!(
                said.contains("neither freeze nor boil") && said.contains("`boils_at`"),
                "{said}"
            );
        }
    }
}

#[test]
fn points_that_leave_no_liquid_are_refused() {
    let text = scene("sph", WATER, true).replace("boils_at = 373.15", "boils_at = 273.15");
    let refusal = parse(&text, "scene.toml").unwrap_err().to_string();
    for words in
        ["body.drop.fluid.boils_at = 273.15", "at or below the 273.15 K", "allowed: > 273.15"]
    {
        assert!(refusal.contains(words), "{words} is not in {refusal}");
    }
    let text = scene("sph", WATER, true).replace("freezes_at = 273.15", "freezes_at = -1.0");
    assert!(parse(&text, "scene.toml").unwrap_err().to_string().contains("above absolute zero"));
}
