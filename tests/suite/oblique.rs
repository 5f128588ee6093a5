//! Drops that come at an angle: the wall gets all of their momentum, whatever direction they come from.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::common::{Trial, off};
use impinge::model::Model;
use impinge::scene;

const STEP: f64 = 1e-7;
const DIAMETER: f64 = 1e-4;
const DENSITY: f64 = 1000.0;
const SPEED: f64 = 20.0;
/// Tiles along each axis.
const TILES: usize = 10;
const WIDTH: f64 = 4e-5;

fn drop(keys: &str) -> String {
    format!(
        "name = \"Drop\"\nstop_time = 4e-6\nstep = {STEP:?}\n[body.drop]\nkind = \"droplet\"\ndiameter = \
         {DIAMETER:?}\nimpact_velocity = {SPEED:?}\ninitial_temperature = 350.0\nspacing = 1e-5\nfluid = {{ density = \
         {DENSITY:?}, viscosity = 1e-3, specific_heat = 4180.0, conductivity = 0.6 }}\n{keys}\n"
    )
}

fn wall() -> String {
    format!(
        "[[wall]]\nname = \"wall\"\nunder = \"drop\"\nfootprint = {{ tiles = {{ count = [{TILES}, {TILES}], size = [{0:?}, \
         {0:?}] }} }}\nstart = {{ temperature = 300.0 }}\n",
        TILES as f64 * WIDTH
    )
}

const PLATE: &str = "[body.plate]\nkind = \"solid\"\nshape = { box = [6e-4, 6e-4, 2e-5] }\nmaterial = { model = \
                     \"thermoelastic\", density = 3950.0, specific_heat = 900.0, conductivity = 10.0 }\ninitial_temperature \
                     = 300.0\nmesh = { spacing = 2e-5, depth_spacing = 2e-6, growth = 1.0, order = 1 \
                     }\n[[coupling]]\nfrom = \"drop\"\nto = \"plate.top\"\ntraction = false\n";

fn at_angle(angle: f64, direction: f64) -> String {
    format!("impact_angle = {angle:?}\nimpact_direction = {direction:?}\n")
}

fn mass() -> f64 {
    PI / 6.0 * DIAMETER.powi(3) * DENSITY
}

/// x, y and z of a total.
fn vector(trial: &mut Trial, key: &str) -> [f64; 3] {
    ["x", "y", "z"].map(|axis| trial.get(&format!("drop.{key}_{axis}")))
}

/// An output of the wall on each tile.
fn tiles(trial: &mut Trial, key: &str) -> Vec<Vec<f64>> {
    let mut tile = |i: usize, j: usize| trial.get(&format!("wall.{key}[{},{}]", i + 1, j + 1));
    (0..TILES).map(|i| (0..TILES).map(|j| tile(i, j)).collect()).collect()
}

#[test]
fn a_drop_flies_along_its_line_and_the_parabola_of_gravity() {
    for (keys, gravity) in [("", 0.0), ("gravity = 1e6\n", 1e6)] {
        let (angle, direction) = (0.7f64, 2.5f64);
        let keys = format!("{}{keys}height = 2e-4\n", at_angle(angle, direction));
        let scene = scene::parse(&drop(&keys), "scene.toml").unwrap();
        let mut trial = Trial::of(scene);
        let steps = 20;
        (0..steps).for_each(|_| trial.step(STEP));
        let particles = trial.model.particle_fields(&trial.state, "drop");
        let whole: f64 = particles.mass.iter().sum();
        let middle = [0, 1, 2].map(|axis| {
            let moments = particles.position.iter().zip(&particles.mass);
            moments.map(|(x, m)| x[axis] * m).sum::<f64>() / whole
        });
        let time = f64::from(steps) * STEP;
        let aside = SPEED * angle.sin() * time;
        let fallen = SPEED * angle.cos() * time + 0.5 * gravity * time * time;
        let wanted = [aside * direction.cos(), aside * direction.sin(), 2.5e-4 - fallen];
        for axis in 0..3 {
            assert!((middle[axis] - wanted[axis]).abs() < 1e-10, "{middle:?} {wanted:?}");
        }
    }
}

#[test]
fn the_wall_gets_the_momentum_along_it_too() {
    for (angle, direction) in [(0.5f64, 0.0f64), (1.0, FRAC_PI_2), (0.8, 0.6), (-0.8, 3.0)] {
        let mut trial = Trial::new(&(drop(&at_angle(angle, direction)) + &wall()));
        let speed = [
            SPEED * angle.sin() * direction.cos(),
            SPEED * angle.sin() * direction.sin(),
            -SPEED * angle.cos(),
        ];
        let mut through_tiles = [0.0; 2];
        for _ in 0..60 {
            trial.step(STEP);
            for (axis, sum) in through_tiles.iter_mut().enumerate() {
                let shear = tiles(&mut trial, ["shear_x", "shear_y"][axis]);
                *sum += shear.as_flattened_sum() * WIDTH * WIDTH * STEP;
            }
        }
        let [momentum, impulse] = ["momentum", "impulse"].map(|key| vector(&mut trial, key));
        for axis in 0..3 {
            let sum = momentum[axis] + impulse[axis];
            let error = (sum - mass() * speed[axis]).abs() / (mass() * SPEED);
            assert!(error < 1e-4, "{angle} {direction}, axis {axis}: {error}");
        }
        // A wall to which the fluid sticks brakes it, along the way that it goes.
        let forward: f64 = (0..2).map(|axis| impulse[axis] * speed[axis]).sum();
        let aside = impulse[0] * speed[1] - impulse[1] * speed[0];
        assert!(forward > 0.0 && aside.abs() < 0.05 * forward, "{angle} {direction}: {impulse:?}");
        // All of the film lies on the tiles.
        for axis in 0..2 {
            let missing = (through_tiles[axis] - impulse[axis]).abs();
            assert!(
                missing < 1e-3 * mass() * SPEED,
                "{angle} {direction}: {through_tiles:?} {impulse:?}"
            );
        }
    }
}

trait Sum {
    fn as_flattened_sum(&self) -> f64;
}

impl Sum for Vec<Vec<f64>> {
    fn as_flattened_sum(&self) -> f64 {
        self.iter().flatten().sum()
    }
}

/// Half of the model stands for the whole, and one that is turned by a right angle gives turned results.
#[test]
fn a_drop_that_is_turned_gives_turned_results() {
    let run = |direction: f64, symmetry: &str| {
        let keys = at_angle(0.7, direction)
            + &format!("symmetry = \"{symmetry}\"\nprecision = \"double\"\n");
        let mut trial = Trial::new(&(drop(&keys) + &wall()));
        let mut heat = 0.0;
        for _ in 0..40 {
            trial.step(STEP);
            heat += trial.get("drop.heat_flow") * STEP;
        }
        assert!(off(trial.get("drop.heat"), heat) < 1e-9);
        trial
    };
    let mut along_x = run(0.0, "auto");
    let flux = tiles(&mut along_x, "heat_flux");
    let impulse = vector(&mut along_x, "impulse");
    let heat = along_x.get("drop.heat");
    let highest = flux.iter().flatten().copied().fold(0.0, f64::max);
    assert_eq!(impulse[1], 0.0, "half of it is modelled");
    // It is as wide on either side of its plane, and has gone along it.
    for column in &flux {
        for j in 0..TILES {
            assert!((column[j] - column[TILES - 1 - j]).abs() < 1e-9 * highest, "{column:?}");
        }
    }
    let moment: f64 =
        flux.iter().enumerate().map(|(i, column)| i as f64 * column.iter().sum::<f64>()).sum();
    let centre = moment / flux.as_flattened_sum() - 0.5 * (TILES - 1) as f64;
    assert!(centre * WIDTH > 0.2 * DIAMETER, "{centre}");
    for (direction, symmetry, tolerance) in [
        (FRAC_PI_2, "auto", 1e-12),
        (PI, "auto", 1e-12),
        (0.0, "none", 1e-8),
        (-FRAC_PI_2, "none", 1e-8),
    ] {
        let mut turned = run(direction, symmetry);
        let name = format!("{direction} {symmetry}");
        let (sine, cosine) = (direction.sin().round(), direction.cos().round());
        let other = tiles(&mut turned, "heat_flux");
        let last = TILES - 1;
        for (i, j) in (0..TILES).flat_map(|i| (0..TILES).map(move |j| (i, j))) {
            // Where a tile goes when the wall is turned about its middle.
            let (k, l) = match (cosine as i32, sine as i32) {
                (0, 1) => (last - j, i),
                (-1, 0) => (last - i, last - j),
                (0, -1) => (j, last - i),
                _ => (i, j),
            };
            let error = (other[k][l] - flux[i][j]).abs() / highest;
            assert!(error < 30.0 * tolerance, "{name}: tile {i}, {j}: {error}");
        }
        let found = vector(&mut turned, "impulse");
        let wanted = [cosine * impulse[0], sine * impulse[0], impulse[2]];
        for axis in 0..3 {
            let error = (found[axis] - wanted[axis]).abs() / impulse[2].abs();
            assert!(error < tolerance, "{name}: {found:?} {wanted:?}");
        }
        assert!(off(turned.get("drop.heat"), heat) < tolerance, "{name}");
    }
}

#[test]
fn an_angle_of_zero_and_a_direction_change_no_bit() {
    let run = |keys: &str| {
        let mut trial = Trial::new(&(drop(keys) + &wall()));
        (0..10).for_each(|_| trial.step(STEP));
        trial.state.bodies
    };
    assert_eq!(run(""), run(&at_angle(0.0, 0.0)));
    assert_eq!(
        run("symmetry = \"none\"\n"),
        run(&("symmetry = \"none\"\n".to_owned() + &at_angle(-0.0, 0.0)))
    );
    // Against a direction is along the opposite one.
    let [one, other] =
        [(0.5, 0.0), (-0.5, PI)].map(|(angle, direction)| run(&at_angle(angle, direction)));
    assert_eq!(one, other);
}

#[test]
fn a_plate_gets_all_the_heat_of_a_drop_at_an_angle() {
    for direction in [0.0, 1.0] {
        let mut trial = Trial::new(&(drop(&at_angle(0.6, direction)) + PLATE));
        (0..30).for_each(|_| trial.step(STEP));
        let [given, taken] = ["drop.heat", "plate.heat_in"].map(|name| trial.get(name));
        assert!(
            given > 1e-9 && off(taken, given) < 1e-12,
            "{direction}: {given} J become {taken} J"
        );
        assert!(off(-trial.get("drop.heat_stored"), given) < 1e-6);
        assert!(trial.heat_residual("plate") < 1e-9);
    }
}

#[test]
fn angles_on_demand_are_those_of_the_scene_to_the_bit() {
    let timed = at_angle(0.6, 2.0) + "symmetry = \"none\"\n";
    let mut timed = Trial::new(&(drop(&timed) + &wall()));
    let mut asked = Trial::new(&(drop("release = \"input\"\nmost = 2\n") + &wall()));
    for (key, value) in [("release", 1.0), ("angle", 0.6), ("direction", 2.0)] {
        asked.set(&format!("drop.{key}"), value);
    }
    for _ in 0..10 {
        timed.step(STEP);
        asked.step(STEP);
    }
    for name in timed.outputs() {
        assert_eq!(timed.get(&name).to_bits(), asked.get(&name).to_bits(), "{name}");
    }
    asked.set("drop.angle", FRAC_PI_2);
    let refused = asked.try_step(STEP).unwrap_err().to_string();
    assert!(refused.contains("a drop does not come down"), "{refused}");
}

#[test]
fn a_plane_drop_comes_at_an_angle_along_x() {
    let wall = "[[wall]]\nname = \"wall\"\nunder = \"drop\"\nfootprint = { tiles = { count = [8, 1], size = [4e-4, 1.0] } }\n";
    let keys = "dimension = 2\nimpact_angle = -0.6\n";
    let mut trial = Trial::new(&(drop(keys) + wall));
    (0..30).for_each(|_| trial.step(STEP));
    let mass = PI / 4.0 * DIAMETER * DIAMETER * DENSITY;
    let wanted = [-mass * SPEED * 0.6f64.sin(), -mass * SPEED * 0.6f64.cos()];
    for (axis, wanted) in ["x", "z"].into_iter().zip(wanted) {
        let sum = trial.get(&format!("drop.momentum_{axis}"))
            + trial.get(&format!("drop.impulse_{axis}"));
        assert!(off(sum, wanted) < 1e-4, "{axis}: {sum} {wanted}");
    }
    assert!(trial.get("drop.impulse_x") < 0.0);
}

#[test]
fn what_needs_drops_straight_down_is_refused() {
    let refused = |text: &str, words: &str| {
        let error = scene::parse(text, "scene.toml").unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    };
    let slanted = at_angle(0.3, 0.0);
    let rings = "[[wall]]\nname = \"wall\"\nunder = \"drop\"\nfootprint = { rings = { count = 4, radius = 2e-4 } }\n";
    refused(&(drop(&slanted) + rings), "rings need all drops to come straight down");
    let disc =
        PLATE.replace("box = [6e-4, 6e-4, 2e-5]", "disc = { radius = 3e-4, thickness = 2e-5 }");
    refused(
        &(drop(&slanted) + &disc),
        "a disc is modelled axisymmetric: all drops must come straight down",
    );
    let quarter = drop(&(slanted.clone() + "symmetry = \"quarter\"\n"));
    refused(&(quarter + &wall()), "a quarter needs all drops to come straight down");
    refused(&(drop(&at_angle(1.6, 0.0)) + &wall()), "at this angle a drop does not come down");
    refused(&(drop(&at_angle(0.1, 7.0)) + &wall()), "the direction is more than a full turn");
    let plane = drop(&("dimension = 2\n".to_owned() + &at_angle(0.1, 1.0)));
    refused(&plane, "drops of a plane model move along x");
    // It starts above the plate, and comes down beside it.
    let beside = drop(&(at_angle(1.2, 0.0) + "height = 2e-4\n")) + PLATE;
    refused(&beside, "the drop of arrivals[0] lands outside the face");
    let fine = drop(&(at_angle(0.5, 0.0) + "height = 2e-4\n")) + PLATE;
    Model::build(&scene::parse(&fine, "scene.toml").unwrap(), 1).unwrap();
}
