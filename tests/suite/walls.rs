//! What a wall's cells get: as much per area in each of them where the film above is even, however narrow they are and
//! wherever particles stand, so that a plate below cells as narrow as particles is as warm as under the drop itself.

use std::f64::consts::PI;

use crate::common::{Trial, off};
use impinge::kernel::Kernel;
use impinge::method::sph::{
    DropletPlan, DropletSph, Extent, Fluid, ParticleFields, Placement, Precision, Release, Viscous,
    Wall,
};
use impinge::port::{Domain, WallCells};

const SPACING: f64 = 4e-6;
const HOT: f64 = 373.15;
const COLD: f64 = 293.15;
const STEP: f64 = 5e-6;
/// Widths of cells over the distance of particles.
const WIDTHS: [f64; 5] = [0.3, 0.5, 1.0, 2.0, 3.3];
/// Particles of a film along x and y to each side of the origin, and layers of them.
const HALF: i32 = 10;
const LAYERS: i32 = 4;
/// Distance from the origin over that of particles within which no edge of the film is felt.
const INSIDE: f64 = 6.0;

/// Water that stays where it is above cells of a wall.
fn film_plan(cells: WallCells, effusivity: Option<f64>, mirrors: [bool; 2]) -> DropletPlan {
    DropletPlan {
        dimension: 3,
        axisymmetric: false,
        spacing: SPACING,
        support: 3.0,
        kernel: Kernel::WendlandC2,
        fluid: Fluid {
            density: 1000.0,
            viscosity: 1e-2.into(),
            specific_heat: 4000.0,
            conductivity: 0.6,
            surface_tension: 0.0,
            sound_speed: 5.0,
            freezing: None,
        },
        placement: Placement::Lattice,
        precision: Precision::Single,
        viscous: Viscous::Explicit,
        density_diffusion: 0.1,
        corrected_diffusion: true,
        shifting: true,
        gravity: [0.0; 3],
        mirrors,
        extents: [Extent::Open; 3],
        // That of the reference temperature alone.
        demand: None,
        feed: None,
        releases: vec![Release {
            time: 0.0,
            centre: [0.0, 0.0, 1e-3],
            diameter: 1e-4,
            velocity: [0.0; 3],
            temperature: HOT,
        }],
        wall: Some(Wall { cells, contact_angle: 0.5 * PI, effusivity, conductance: None }),
    }
}

/// Particles at rest in layers, each displaced in x and y from its place on the lattice, over the distance of
/// particles.
fn film(mirrors: [bool; 2], mut displacement: impl FnMut() -> [f64; 2]) -> ParticleFields {
    let mut film = ParticleFields::default();
    let first = mirrors.map(|mirrored| if mirrored { 0 } else { -HALF });
    for k in 0..LAYERS {
        for j in first[1]..HALF {
            for i in first[0]..HALF {
                let [dx, dy] = displacement();
                let at = |n: i32, off: f64| (f64::from(n) + 0.5 + off) * SPACING;
                film.position.push([at(i, dx), at(j, dy), at(k, 0.0)]);
                film.velocity.push([0.0; 3]);
                film.mass.push(1000.0 * SPACING.powi(3));
                film.density.push(1000.0);
                film.temperature.push(HOT);
            }
        }
    }
    film
}

fn rings(width: f64) -> WallCells {
    let count = (INSIDE / width).floor() as usize;
    WallCells::Rings { count, radius: count as f64 * width * SPACING }
}

/// As many tiles along each axis as lie within the film, an odd and an even number.
fn tiles(width: f64) -> WallCells {
    let most = (2.0 * INSIDE / 2f64.sqrt() / width).floor() as usize;
    let count = [most - most % 2, most - (most + 1) % 2];
    WallCells::Tiles { count, size: count.map(|n| n as f64 * width * SPACING) }
}

/// Flux and pressure on each cell in the last step over their means.
fn per_area(drop: &DropletSph, state: &[f64]) -> [Vec<f64>; 2] {
    let exchange = drop.exchange(state);
    let areas = drop.plan().wall.as_ref().unwrap().cells.areas(Domain::whole(3));
    let whole: f64 = areas.iter().sum();
    let pushes = exchange.impulse.iter().map(|impulse| -impulse[2]).collect();
    [exchange.heat, pushes].map(|amounts: Vec<f64>| {
        let mean = amounts.iter().sum::<f64>() / whole;
        amounts.iter().zip(&areas).map(|(amount, area)| amount / area / mean).collect()
    })
}

#[test]
fn an_even_film_gives_as_much_to_every_cell() {
    // On the points of the wall and beside them, a quarter of the film and all of it.
    for (mirrors, aside) in
        [([true; 2], [0.0; 2]), ([false; 2], [0.0; 2]), ([false; 2], [0.3, 0.1])]
    {
        for cells in WIDTHS.iter().flat_map(|&width| [rings(width), tiles(width)]) {
            for effusivity in [None, Some(6000.0)] {
                let name = format!("{cells:?} {effusivity:?} {mirrors:?} {aside:?}");
                let mut plan = film_plan(cells.clone(), effusivity, mirrors);
                plan.gravity[2] = -1000.0;
                let drop = DropletSph::new(plan, 1);
                let mut state = drop.state_of(&film(mirrors, || aside));
                // Shorter than it takes the edges to be felt in the middle.
                drop.advance(&mut state, &vec![COLD; cells.len()], 0.2 * STEP).unwrap();
                let [fluxes, pressures] = per_area(&drop, &state);
                let uneven =
                    |values: &[f64]| values.iter().map(|q| (q - 1.0).abs()).fold(0.0, f64::max);
                assert!(uneven(&fluxes) < 1e-3, "{name}: {fluxes:?}");
                assert!(uneven(&pressures) < 2e-3, "{name}: {pressures:?}");
            }
        }
    }
}

/// Numbers that look like chance, from −1 to 1 (Marsaglia's xorshift, 2003, doi 10.18637/jss.v008.i14).
struct Chance(u64);

impl Chance {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        2.0 * (self.0 >> 11) as f64 / (1u64 << 53) as f64 - 1.0
    }
}

/// Particles that stand unevenly give single cells more and others less, but none of them for where it is.
#[test]
fn uneven_films_give_as_much_to_the_axis_on_average() {
    const FILMS: usize = 60;
    for mirrors in [[true; 2], [false; 2]] {
        for width in [0.5, 1.0, 2.0] {
            let cells = rings(width);
            let drop = DropletSph::new(film_plan(cells.clone(), None, mirrors), 1);
            let mut chance = Chance(0x9e37_79b9_7f4a_7c15);
            let mut means = vec![0.0; cells.len()];
            for _ in 0..FILMS {
                let film = film(mirrors, || [0.25 * chance.next(), 0.25 * chance.next()]);
                let mut state = drop.state_of(&film);
                drop.advance(&mut state, &vec![COLD; cells.len()], 0.1 * STEP).unwrap();
                let [fluxes, _] = per_area(&drop, &state);
                means.iter_mut().zip(fluxes).for_each(|(mean, flux)| *mean += flux / FILMS as f64);
            }
            assert!((means[0] - 1.0).abs() < 0.015, "{width} {mirrors:?}: {means:?}");
            assert!(means.iter().all(|mean| (mean - 1.0).abs() < 0.02), "{width}: {means:?}");
        }
    }
}

/// Density, specific heat, conductivity of a plate.
const ALUMINA: [f64; 3] = [3950.0, 900.0, 10.0];
const POLYMER: [f64; 3] = [1200.0, 1500.0, 0.2];
const AEROGEL: [f64; 3] = [100.0, 1000.0, 0.02];
/// Radii in a ring whose mean temperature is taken, at equal parts of its area.
const RADII: usize = 4;

/// A drop on a plate in one unit, and as two units that take turns, with the same probes in the plate.
fn one_and_two(symmetry: &str, solid: [f64; 3], count: usize, width: f64, step: f64) -> [Trial; 3] {
    let [density, specific_heat, conductivity] = solid;
    let effusivity = solid.iter().product::<f64>().sqrt();
    let material = format!(
        "{{ model = \"thermoelastic\", density = {density:?}, specific_heat = {specific_heat:?}, conductivity = {conductivity:?} }}"
    );
    let head = format!("name = \"Halves\"\nstop_time = 3e-6\nstep = {step:?}\n");
    let drop = "[body.drop]\nkind = \"droplet\"\ndiameter = 1e-4\nimpact_velocity = 20.0\ninitial_temperature = \
                373.15\nsymmetry = \"SYMMETRY\"\nspacing = 8e-6\nfluid = { density = 1000.0, viscosity = 1e-3, \
                specific_heat = 4000.0, conductivity = 0.6, surface_tension = 0.059 }\n"
        .replace("SYMMETRY", symmetry);
    let plate = format!(
        "[body.plate]\nkind = \"solid\"\nshape = {{ disc = {{ radius = 3e-4, thickness = 5e-5 }} }}\n\
         initial_temperature = 293.15\nmaterial = {material}\nmesh = {{ spacing = 3e-6, depth_spacing = 5e-7, growth = \
         1.3, order = 1 }}\n"
    );
    let rings = format!(
        "footprint = {{ rings = {{ count = {count}, radius = {:?} }} }}",
        count as f64 * width
    );
    let wall = format!(
        "[[wall]]\nname = \"wall\"\nunder = \"drop\"\n{rings}\neffusivity = {effusivity:?}\nstart = {{ temperature = \
         293.15 }}\n"
    );
    let load = format!(
        "[[load]]\nname = \"rings\"\non = \"plate.top\"\n{rings}\ncarries = [\"heat_flux\"]\n"
    );
    let probe = |name: &str, radius: f64| {
        format!(
            "[[probe]]\nname = \"{name}\"\nin = \"plate\"\nat = [{radius:?}, 0.0, 0.0]\ngives = [\"temperature\"]\n"
        )
    };
    let mut probes = probe("centre", 0.0);
    for (ring, n) in (0..count).flat_map(|ring| (0..RADII).map(move |n| (ring, n))) {
        let part = (n as f64 + 0.5) / RADII as f64;
        let square = (ring * ring) as f64 + (2 * ring + 1) as f64 * part;
        probes += &probe(&format!("ring{ring}_{n}"), square.sqrt() * width);
    }
    let coupling =
        "[[coupling]]\nfrom = \"drop\"\nto = \"plate.top\"\nradius = 1.2e-4\ntraction = false\n";
    [
        format!("{head}{drop}{plate}{coupling}{probes}"),
        format!("{head}{drop}{wall}"),
        format!("{head}{plate}{load}{probes}"),
    ]
    .map(|text| Trial::new(&text))
}

fn ring_temperature(trial: &mut Trial, ring: usize) -> f64 {
    let at = |n: usize| trial.get(&format!("ring{ring}_{n}.temperature"));
    (0..RADII).map(at).sum::<f64>() / RADII as f64
}

/// Rings half as wide as particles, as wide and twice as wide, coupled by their mean temperatures; no wider where
/// particles are rings, too. Heat may be off by a part of that of one scene.
#[test]
fn two_units_are_as_warm_at_the_centre_as_one() {
    for (symmetry, solid, width, of_heat) in [
        ("quarter", ALUMINA, 4e-6, 0.01),
        ("quarter", ALUMINA, 8e-6, 0.01),
        ("quarter", ALUMINA, 16e-6, 0.01),
        ("quarter", POLYMER, 8e-6, 0.01),
        ("quarter", AEROGEL, 8e-6, 0.05),
        ("axisymmetric", ALUMINA, 4e-6, 0.01),
        ("axisymmetric", ALUMINA, 8e-6, 0.01),
        ("axisymmetric", POLYMER, 8e-6, 0.01),
        ("axisymmetric", AEROGEL, 8e-6, 0.05),
    ] {
        let (count, step) = ((2e-4f64 / width).round() as usize, 5e-8);
        let [mut whole, mut drop, mut plate] = one_and_two(symmetry, solid, count, width, step);
        for _ in 0..60 {
            whole.step(step);
            drop.step(step);
            for ring in 1..=count {
                let flux = drop.get(&format!("wall.heat_flux[{ring}]"));
                plate.set(&format!("rings.heat_flux[{ring}]"), flux);
            }
            plate.step(step);
            for ring in 0..count {
                let temperature = ring_temperature(&mut plate, ring);
                drop.set(&format!("wall.temperature[{}]", ring + 1), temperature);
            }
        }
        let [one, two] = [&mut whole, &mut plate].map(|trial| trial.get("plate.heat_in"));
        assert!(off(two, one) < of_heat, "{symmetry} {width}: {one} J, {two} J");
        assert!(off(two, drop.get("drop.heat")) < 1e-3, "{symmetry} {width}: {two} J");
        let rise = whole.get("centre.temperature") - COLD;
        let differences: Vec<f64> = (0..5)
            .map(|ring| ring_temperature(&mut plate, ring) - ring_temperature(&mut whole, ring))
            .collect();
        let centre = plate.get("centre.temperature") - whole.get("centre.temperature");
        println!(
            "{symmetry}, rings of {width} m: centre {centre:.3} K, rings {differences:.3?} of {rise:.2} K"
        );
        let most = 0.015 * rise;
        assert!(
            differences.iter().all(|d| d.abs() < most),
            "{symmetry} {width}: {differences:?} {rise}"
        );
        // A wider ring does not know how the flux differs within it.
        assert!(width > 1e-5 || centre.abs() < 0.015 * rise, "{width}: {centre} of {rise} K");
    }
}
