//! Metals with a back stress: cycles of Cook's membrane and of a beam beside an independent program and beam theory.
//!
//! Cases: Petersson (2007), An implementation of mesh free methods for mechanical problems at large strains, M.Sc.
//! thesis, Lund University, ch. 5, in plane strain, with back stress `c εₚ`. The expected numbers are those of an
//! independent program for small strains with quadratic elements, 3 × 3 Gauss points each.

use impinge::laws::solid::large_strain::{Deviator, LargeStrainLaw, Plastic};
use impinge::method::large_strain::{
    Conditions, Deformable, Equilibrium, Found, LoadedFaces, Rest,
};
use impinge::space::{Form, Mesh, Reproducing, Side, Sides, Space, finite_elements, reproducing};

use super::large_strain::{cook, pulled_by, settle};
use super::reproducing::closed_forms::Cantilever;

/// `H_k = 3 c/2`.
fn metal(bulk: f64, shear: f64, yield_stress: f64, c: f64) -> LargeStrainLaw {
    let plastic = Plastic {
        yield_stress,
        hardening: 0.0,
        saturation: yield_stress,
        rate: 0.0,
        kinematic: 1.5 * c,
    };
    LargeStrainLaw { bulk, shear, deviator: Deviator::Plastic(plastic) }
}

fn kernels(mesh: &Mesh) -> Space {
    let held = Sides::of(&[Side::Left]);
    reproducing(mesh, Reproducing { held, ..Reproducing::default() }).unwrap()
}

fn space(mesh: &Mesh, method: &str) -> Space {
    match method {
        "fem" => finite_elements(mesh),
        _ => kernels(mesh),
    }
}

/// A body whose left side is held, or moved, under forces in proportion to a load.
struct Case {
    equilibrium: Equilibrium,
    rest: Rest,
    forces: Vec<[f64; 3]>,
    moved: Vec<[f64; 3]>,
    tip: usize,
}

impl Case {
    /// With the traction on the right side and the displacements of the left under a load of 1.
    fn new(
        space: Space,
        law: LargeStrainLaw,
        traction: impl Fn([f64; 3]) -> [f64; 3],
        moved: impl Fn([f64; 3]) -> [f64; 3],
        tip: [f64; 3],
    ) -> Self {
        let nodes = space.nodes.clone();
        let forces = pulled_by(&space, Side::Right, traction);
        let held: Vec<[bool; 3]> = nodes.iter().map(|at| [at[0] == 0.0; 3]).collect();
        let far = |at: &[f64; 3]| (at[0] - tip[0]).hypot(at[2] - tip[2]);
        let nearest = (0..nodes.len()).min_by(|&a, &b| far(&nodes[a]).total_cmp(&far(&nodes[b])));
        let body = Deformable::new(space, law, 1.0, [false; 2], 2);
        let equilibrium = Equilibrium::new(body, &held, LoadedFaces::default()).unwrap();
        Self {
            rest: equilibrium.rest(),
            equilibrium,
            forces,
            moved: nodes.into_iter().map(moved).collect(),
            tip: nearest.unwrap(),
        }
    }

    fn to(&mut self, load: f64) -> Found {
        let scaled = |all: &[[f64; 3]]| all.iter().map(|own| own.map(|x| load * x)).collect();
        let to = Conditions {
            forces: scaled(&self.forces),
            displacements: scaled(&self.moved),
            loads: Vec::new(),
        };
        settle(&self.equilibrium, &mut self.rest, &to)
    }

    /// Goes to a load from another in even steps.
    fn along(&mut self, from: f64, to: f64, steps: usize) {
        (1..=steps).for_each(|n| {
            self.to(from + (to - from) * n as f64 / steps as f64);
        });
    }

    /// Displacement of the tip along z.
    fn rise(&self) -> f64 {
        self.equilibrium.body.displacements(&self.rest.displacement)[self.tip][2]
    }
}

/// Cook's membrane [mm, MPa] under 1 N per millimetre of thickness. A part of load and yield stress makes strains
/// small.
fn membrane(cells: [usize; 2], method: &str, part: f64) -> Case {
    let law = metal(164e3, 80e3, 400.0 * part, 18e3);
    let space = space(&cook(cells), method);
    Case::new(space, law, |_| [0.0, 0.0, 1.0 / 16.0], |_| [0.0; 3], [48.0, 0.0, 44.0])
}

/// Small strains: 2500 N and the yield stress are a hundredth of those of the source.
const PART: f64 = 1e-2;
const FULL: f64 = 2500.0 * PART;

/// Quadratic elements find 0.2783, 0.2826, 0.2842, 0.2847 and 0.2850 mm with 4, 8, 16, 24 and 32 a side, whose
/// differences halve: 0.2858 in the limit.
#[test]
fn cooks_membrane_rises_as_an_independent_program_finds() {
    let rise = |cells: [usize; 2], method: &str| {
        let mut case = membrane(cells, method, PART);
        case.along(0.0, FULL, 5);
        case.rise() / PART
    };
    let found = [[19, 17], [38, 34], [64, 64]].map(|cells| rise(cells, "fem"));
    let kernels = rise([19, 17], "rkpm");
    println!("Cook, back stress: {found:?}, kernels {kernels}");
    assert!((found[2] / 0.2858 - 1.0).abs() < 0.004, "{found:?}");
    assert!((found[1] - found[0]) > 2.0 * (found[2] - found[1]), "{found:?}");
    // As many nodes as 0.2831 mm of quadratic elements.
    assert!((kernels / 0.2858 - 1.0).abs() < 0.008, "{kernels}");
    // At 2500 N itself the membrane has turned, by a hundredth.
    let mut case = membrane([38, 34], "fem", 1.0);
    case.along(0.0, 2500.0, 5);
    let finite = case.rise() / found[1];
    assert!((0.99..0.998).contains(&finite), "{finite}");
}

/// Rises beside the first one after each reversal of 2500 N, and after the load is gone, of quadratic elements with 8 a
/// side: the loop closes by and by, not at once: by a factor of some four in early cycles.
#[test]
fn cooks_membrane_settles_into_a_closed_loop() {
    let mut case = membrane([19, 17], "rkpm", PART);
    case.along(0.0, FULL, 5);
    let first = case.rise();
    for wanted in [-0.99927, 0.99960, -0.99943, 0.99953] {
        case.along(FULL * -f64::signum(wanted), FULL * f64::signum(wanted), 10);
        let found = case.rise() / first;
        println!("Cook, reversal: {found} {wanted}");
        assert!((found - wanted).abs() < 3e-4, "{found} {wanted}");
    }
    case.along(FULL, 0.0, 10);
    let left = case.rise() / first;
    println!("Cook, left: {left}");
    assert!((left / 0.0879 - 1.0).abs() < 0.1, "{left}");

    let mut case = membrane([9, 7], "fem", PART);
    case.along(0.0, FULL, 10);
    let (mut before, mut gap) = (case.rise(), f64::INFINITY);
    for cycle in 1..=14 {
        case.along(FULL, -FULL, 20);
        case.along(-FULL, FULL, 20);
        let now = (case.rise() / before - 1.0).abs();
        println!("Cook, cycle {cycle}: {now:e}");
        assert!(now < 0.8 * gap, "{now:e} {gap:e}");
        (before, gap) = (case.rise(), now);
    }
    assert!(gap < 2e-7, "{gap:e}");
}

/// Once no more points begin to yield, each residual is of the size of the square of the one before, until it rounds.
#[test]
fn residuals_fall_quadratically() {
    for method in ["fem", "rkpm"] {
        for part in [PART, 1.0] {
            let mut case = membrane([9, 7], method, part);
            for n in [1, 2, 3, 4, 5, 3, 1, -1, -3, -5] {
                let residuals = case.to(500.0 * part * f64::from(n)).residuals;
                let pairs = residuals.windows(2).filter(|pair| pair[0] < 1e-4);
                for pair in pairs {
                    assert!(pair[1] < 10.0 * pair[0] * pair[0] + 1e-9, "{method} {residuals:?}");
                }
                assert!(residuals[residuals.len() - 1] < 1e-7, "{method} {residuals:?}");
            }
        }
    }
}

/// Differences of rises between 10 × 8, 20 × 18 and 30 × 28 nodes are those of the source, table 5.5, whose load
/// follows from its rise: 4.9 kN.
#[test]
fn cooks_membrane_tends_to_its_limit_as_in_the_source() {
    let rises = [1, 2, 3].map(|n| {
        let mut case = membrane([10 * n - 1, 10 * n - 3], "rkpm", PART);
        case.along(0.0, 4900.0 * PART, 5);
        case.rise() / PART
    });
    println!("Cook, 4.9 kN: {rises:?}");
    let [coarse, middle] = [rises[0], rises[1]].map(|rise| rise / rises[2]);
    assert!((coarse - 1.601 / 1.650).abs() < 0.01 && (middle - 1.640 / 1.650).abs() < 0.005);
}

const BULK: f64 = 2.5e7;
const SHEAR: f64 = 1.1538e7;
const POISSON: f64 = (3.0 * BULK - 2.0 * SHEAR) / (6.0 * BULK + 2.0 * SHEAR);

/// Beam theory of plane strain: that of plane stress with other constants.
fn section() -> Cantilever {
    let young = 9.0 * BULK * SHEAR / (3.0 * BULK + SHEAR);
    Cantilever {
        length: 48.0,
        height: 12.0,
        young: young / (1.0 - POISSON * POISSON),
        poisson: POISSON / (1.0 - POISSON),
        force: -1.0,
    }
}

/// The beam of the source [N, m] under 1 N, its root clamped under an even shear traction, or as beam theory has it.
fn beam([along, across]: [usize; 2], method: &str, is_exact: bool) -> Case {
    let section = section();
    let corners = [[0.0, 0.0, -6.0], [48.0, 0.0, 6.0]];
    let mesh = Mesh::of_box(Form::Plane, corners[0], corners[1], [along, 1, across]);
    let traction = |at| if is_exact { section.end_traction(at) } else { [0.0, 0.0, -1.0 / 12.0] };
    let moved = |at| if is_exact { section.displacement(at) } else { [0.0; 3] };
    let law = metal(BULK, SHEAR, 600.0, 25e3);
    Case::new(space(&mesh, method), law, traction, moved, [48.0, 0.0, 0.0])
}

/// Deflections at 340 N, at 500 N and without load thereafter; quadratic elements find these with 64 × 16 and a root of
/// beam theory, and with 16 × 4 and a clamped one.
#[test]
fn beams_bend_and_unload_as_in_an_independent_program() {
    for (cells, method, is_exact, wanted, tolerances) in [
        ([64, 16], "fem", true, [2.7670e-3, 4.6071e-3, 5.380e-4], [1e-3, 5e-3, 0.05]),
        ([32, 8], "rkpm", true, [2.7670e-3, 4.5877e-3, 5.186e-4], [1e-3, 0.015, 0.11]),
        ([32, 8], "fem", false, [2.7512e-3, 4.4880e-3, 4.421e-4], [3e-3, 2e-3, 0.03]),
        ([32, 8], "rkpm", false, [2.7512e-3, 4.4880e-3, 4.421e-4], [3e-3, 8e-3, 0.07]),
    ] {
        let mut case = beam(cells, method, is_exact);
        let mut at = |from: f64, to: f64| {
            case.along(from, to, 5);
            -case.rise()
        };
        let found = [at(0.0, 340.0), at(340.0, 500.0), at(500.0, 0.0)];
        println!("beam {method} {is_exact}: {found:?} {wanted:?}");
        for ((found, wanted), tolerance) in found.iter().zip(wanted).zip(tolerances) {
            assert!(
                (found / wanted - 1.0).abs() < tolerance,
                "{method} {is_exact}: {found} {wanted}"
            );
        }
    }
}

/// The load at which a point begins to yield is that of beam theory there, which tends to 300 N/√(1 − ν + ν²) = 337.5 N
/// at the root's corners.
#[test]
fn beams_begin_to_yield_at_the_load_of_beam_theory() {
    let section = section();
    let onset = |cells: [usize; 2]| {
        let mut case = beam(cells, "fem", true);
        let places = case.equilibrium.body.space.volume.at.clone();
        let load = |at: &[f64; 3]| {
            let [along, .., shear, _] = section.stress(*at);
            let flat = 1.0 - POISSON + POISSON * POISSON;
            600.0 / (flat * along * along + 3.0 * shear * shear).sqrt()
        };
        let wanted = places.iter().map(load).fold(f64::INFINITY, f64::min);
        let [mut low, mut high] = [300.0, 400.0];
        while high - low > 0.05 {
            let middle = 0.5 * (low + high);
            case.rest = case.equilibrium.rest();
            case.to(middle);
            let strains = case.equilibrium.body.plastic_strains(&case.rest.history);
            if strains.iter().all(|&own| own == 0.0) { low = middle } else { high = middle }
        }
        println!("beam, onset: {low} N beside {wanted}");
        [low, wanted]
    };
    let [[coarse, _], [fine, wanted]] = [[32, 8], [64, 16]].map(onset);
    // Linear elements bend stiffly.
    assert!((fine / wanted - 1.0).abs() < 0.013, "{fine} {wanted}");
    // Of the first order in the distance of a point from the corner.
    assert!(((2.0 * fine - coarse) / 337.5 - 1.0).abs() < 1e-3, "{coarse} {fine}");
}
