//! Checks fluid, nozzle, path and target of each filament.

use super::{Checker, fits, freezing, material, number};
use crate::laws::Viscosity;
use crate::scene::filament::{Filament, FilamentMethod, PathFile, PathTable};
use crate::scene::gcode::BadLine;
use crate::scene::locate::Path;
use crate::scene::route::Leg;

/// Largest number of segments.
const MOST_SEGMENTS: f64 = 1e6;
/// Longest segment over the diameter of the nozzle.
const LONGEST: f64 = 10.0;
/// Largest number of particles.
const MOST_PARTICLES: f64 = 2e6;
/// Least number of particles across the nozzle.
const LEAST_ACROSS: f64 = 4.0;

pub fn check(checker: &mut Checker) {
    for (name, filament) in checker.scene.filaments() {
        let path = Path::default().key("body").key(name);
        fluid(checker, &path, filament);
        if let Some(table) = filament.table() {
            places(checker, &path.key("path"), table);
        }
        if let Some(file) = filament.file() {
            code(checker, &path.at("path.file"), (filament, file));
        }
        let message = "the path sets the flow";
        let fine = filament.nozzle.flow == 0.0 || !filament.path_sets_flow();
        checker.require(
            fine,
            &path.at("nozzle.flow"),
            message,
            "no `nozzle.flow`, or a `path` without flow",
        );
        if filament.method == FilamentMethod::Particles {
            of_particles(checker, &path, (name, filament));
        }
        if checker.is_fine(&path) {
            match filament.method {
                FilamentMethod::Line => segments(checker, &path, filament),
                FilamentMethod::Particles => particles(checker, &path, filament),
            }
            volume(checker, &path, filament);
            if checker.is_fine(&path) {
                lowest(checker, &path, filament);
            }
        }
    }
    targets(checker);
}

fn fluid(checker: &mut Checker, path: &Path, filament: &Filament) {
    let fluid = &filament.fluid;
    if let Viscosity::Table(table) = &fluid.viscosity {
        material::table(checker, &path.at("fluid.viscosity"), table);
    }
    if let Some(convection) = filament.convection {
        let message = "the fluid conducts no heat that could pass to the air";
        let allowed = "no `convection`, or a `conductivity` of the fluid above 0";
        let fine = fluid.conductivity > 0.0 || convection.coefficient == 0.0;
        checker.require(fine, &path.at("convection"), message, allowed);
    }
    let Some(melting) = fluid.melting else {
        let message = "a fluid without `melting` does not freeze";
        let allowed = "no `frozen`, or a table `melting` of the fluid";
        checker.require(fluid.frozen.is_none(), &path.at("fluid.frozen"), message, allowed);
        return;
    };
    let at = path.at("fluid.melting");
    material::melting(checker, &at, melting);
    let message = "a fluid that conducts no heat does not freeze";
    let allowed = "no `melting`, or a `conductivity` of the fluid above 0";
    checker.require(fluid.conductivity > 0.0, &at, message, allowed);
    if checker.is_fine(&at) {
        let shown = number(melting.liquidus);
        let message = format!("the fluid would come frozen: its liquidus is {shown} K");
        let is_molten = filament.nozzle.temperature > melting.liquidus;
        let path = path.at("nozzle.temperature");
        checker.require(is_molten, &path, message, format!("> {shown}"));
    }
}

fn places(checker: &mut Checker, path: &Path, table: &PathTable) {
    let count = table.len();
    let message = format!("{count} times are no motion");
    checker.require(count >= 2, &path.key("time"), message, "two or more times");
    let others = [("z", &table.z), ("flow", &table.flow)];
    let others = others.into_iter().filter_map(|(key, list)| Some((key, list.as_ref()?.len())));
    for (key, own) in [("x", table.x.len()), ("y", table.y.len())].into_iter().chain(others) {
        let message = format!("{own} places at {count} times");
        checker.require(own == count, &path.key(key), message, format!("{count} numbers"));
    }
    let ascends = table.time.windows(2).all(|times| times[0] < times[1]);
    let message = "the times do not ascend";
    checker.require(ascends, &path.key("time"), message, "each time later than the one before");
}

/// Refuses G-code that is missing or not understood, at its line.
fn code(checker: &mut Checker, path: &Path, (filament, own): (&Filament, &PathFile)) {
    let scene = checker.scene;
    if !scene.files.contains_key(&own.file) {
        let message = format!("the scene has no text of the file `{}`", own.file);
        checker.refuse(path, message, "a scene that is read from a file, or the text in `[files]`");
        return;
    }
    match filament.route(&scene.files) {
        Err(bad) => {
            let BadLine { line, text, message, allowed } = bad;
            checker.refuse(path, format!("{}:{line}: {text}: {message}", own.file), allowed);
        }
        Ok(route) => {
            let has_legs = route.is_some_and(|route| route.laid().next().is_some());
            let message = "no fluid comes on this path";
            checker.require(has_legs, path, message, "moves G1 with words E");
        }
    }
}

/// Refuses what particles do not compute.
fn of_particles(checker: &mut Checker, path: &Path, (name, filament): (&str, &Filament)) {
    let fluid = &filament.fluid;
    if let Some(freezing) = fluid.freezing().filter(|_| checker.is_fine(path)) {
        freezing::constants(checker, path, fluid, &freezing);
    }
    let stands = checker.scene.coupling_from(name).is_some();
    let message = "particles that conduct heat need a solid below";
    let allowed = "0, or a `[[coupling]]` with a solid";
    let fine = fluid.conductivity == 0.0 || stands;
    checker.require(fine, &path.at("fluid.conductivity"), message, allowed);
}

fn particles(checker: &mut Checker, path: &Path, filament: &Filament) {
    let distance = filament.particle_distance();
    let largest = filament.nozzle.diameter / LEAST_ACROSS;
    let message = "fewer than four particles across the nozzle resolve no flow";
    let allowed = format!("up to {}", number(largest));
    checker.require(fits(distance, largest), &path.key("spacing"), message, allowed);
    let count = filament.particles();
    if count > MOST_PARTICLES {
        let message = format!("{} particles would hold this volume", number(count.ceil()));
        let least = number((filament.most / MOST_PARTICLES).cbrt());
        let most = number(MOST_PARTICLES * distance.powi(3));
        let allowed = format!("at most {most}, or a `spacing` of {least} or more");
        checker.refuse(&path.key("most"), message, allowed);
    }
    let height = filament.nozzle.height;
    let message = "the outlet is nearer to the plate than particles are to each other";
    let allowed = format!("{} and more", number(distance));
    checker.require(height >= distance, &path.at("nozzle.height"), message, allowed);
}

fn segments(checker: &mut Checker, path: &Path, filament: &Filament) {
    let spacing = filament.segment_length();
    let longest = LONGEST * filament.nozzle.diameter;
    let message = "the segments are far longer than the nozzle is wide";
    let allowed = format!("up to {}", number(longest));
    checker.require(fits(spacing, longest), &path.key("spacing"), message, allowed);
    let count = filament.most / (filament.outlet() * spacing);
    if count > MOST_SEGMENTS {
        let message = format!("{} segments would hold this volume", number(count.ceil()));
        let least = number(filament.most / (filament.outlet() * MOST_SEGMENTS));
        let most = number(MOST_SEGMENTS * filament.outlet() * spacing);
        let allowed = format!("at most {most}, or a `spacing` of {least} or more");
        checker.refuse(&path.key("most"), message, allowed);
    }
}

/// Refuses a flow that would exceed the largest volume in the default experiment.
fn volume(checker: &mut Checker, path: &Path, filament: &Filament) {
    let stop = checker.scene.stop_time;
    let route = checker.scene.route(filament);
    let time = route.as_ref().map_or(stop, |route| route.time_until(stop));
    let (volume, by, less) = match route.filter(|_| filament.path_sets_flow()) {
        Some(route) => (route.volume_until(stop), "on the path", "less flow"),
        None => (filament.nozzle.flow * time, "at the flow of the nozzle", "less `nozzle.flow`"),
    };
    let message = format!("{} m³ come until the stop time {by}", number(volume));
    let allowed = format!(">= {}, or {less}", number(volume));
    checker.require(fits(volume, filament.most), &path.key("most"), message, allowed);
}

/// Refuses a path on which the nozzle meets the plate while fluid comes.
fn lowest(checker: &mut Checker, path: &Path, filament: &Filament) {
    let route = checker.scene.route(filament);
    let stop = checker.scene.stop_time;
    let comes = |leg: &Leg| match leg.flow {
        Some(_) => leg.largest_flow() > 0.0,
        None => filament.nozzle.flow > 0.0,
    };
    // Particles are in the nozzle at all times.
    let counts = |leg: &Leg| filament.method == FilamentMethod::Particles || comes(leg);
    let Some([height, time]) = route.and_then(|route| route.lowest_until(stop, counts)) else {
        return;
    };
    let least = filament.least_height();
    let (shown, time) = (number(height), number(time));
    let message = format!("the outlet is {shown} m above the plate at {time} s, with fluid in it");
    let allowed = format!("{} m and more", number(least));
    checker.require(height >= least, &path.key("path"), message, allowed);
}

fn targets(checker: &mut Checker) {
    let scene = checker.scene;
    for (i, target) in scene.target.iter().enumerate() {
        let path = Path::default().key("target").index(i);
        let of = path.key("of");
        if scene.filament(&target.of).is_none() {
            let known: Vec<_> = scene.filaments().map(|(name, _)| name).collect();
            let message = format!("there is no filament `{}`", target.of);
            let allowed = super::list_or(known.join(", "), "a body of kind `filament`");
            checker.refuse(&of, message, allowed);
        }
        let is_first = scene.target[..i].iter().all(|other| other.of != target.of);
        let message = format!("`{}` has a target already", target.of);
        checker.require(is_first, &of, message, "one target a filament");
        let places = target.line.len();
        let message = format!("{places} places are no line");
        checker.require(places >= 2, &path.key("line"), message, "two or more places");
        let repeated = target.line.windows(2).position(|ends| ends[0] == ends[1]);
        if let Some(n) = repeated {
            let message = "the place is that before it";
            checker.refuse(&path.key("line").index(n + 1), message, "another place");
        }
    }
}
