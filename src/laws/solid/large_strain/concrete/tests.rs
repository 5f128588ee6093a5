use super::*;
use crate::math::matrix3::{IDENTITY, contraction};

const YOUNG: f64 = 30e9;
const POISSON: f64 = 0.2;
const TENSILE: f64 = 4e6;

/// Concrete of 40 MPa: the first two surfaces in proportion to f_c as published.
pub fn concrete(dilatancy: f64) -> Concrete {
    let f = 40e6;
    let surfaces = Surfaces::new(
        [[0.2956 * f, 0.4463, 0.0808 / f], [0.2232 * f, 0.625, 0.2575 / f]],
        [0.4417, 0.1183 / f],
        TENSILE,
        1.15,
        &[[3.0, 0.753], [8.45, 1.0]],
    );
    let points = [
        [0.0, 0.0],
        [2e-5, 0.6],
        [6e-5, 0.95],
        [1e-4, 1.0],
        [5e-4, 0.6],
        [1.5e-3, 0.25],
        [4e-3, 0.0],
    ];
    Concrete {
        surfaces: surfaces.unwrap(),
        function: DamageFunction::new(&points).unwrap(),
        exponents: [1.6, -2.0],
        opening: 1.0,
        dilatancy,
        broken: 0.95,
        compaction: Vec::new(),
    }
}

fn law(concrete: Concrete) -> super::super::LargeStrainLaw {
    super::super::LargeStrainLaw {
        bulk: YOUNG / (3.0 * (1.0 - 2.0 * POISSON)),
        shear: YOUNG / (2.0 * (1.0 + POISSON)),
        deviator: super::super::Deviator::Concrete(concrete),
    }
}

/// A test of a point along its axis z.
struct Driver {
    law: super::super::LargeStrainLaw,
    history: Vec<f64>,
    /// Logarithmic strains across and along.
    strains: [f64; 2],
    /// Kirchhoff stresses across and along.
    stress: [f64; 2],
    work: f64,
    energy: f64,
}

impl Driver {
    fn new(concrete: Concrete) -> Self {
        let law = law(concrete);
        let history = vec![0.0; law.history()];
        Self { law, history, strains: [0.0; 2], stress: [0.0; 2], work: 0.0, energy: 0.0 }
    }

    fn tried(&self, [across, along]: [f64; 2]) -> (Vec<f64>, [f64; 2], f64) {
        let mut gradient = IDENTITY;
        (0..2).for_each(|a| gradient[a][a] = f64::exp(across));
        gradient[2][2] = along.exp();
        let mut history = self.history.clone();
        let response = self.law.respond(&Deformed::of(gradient), 0.0, &mut history);
        let stress = [0, 2].map(|a| response.stress[a][a] * gradient[a][a]);
        (history, stress, response.energy)
    }

    /// Moves along the axis, with a stress across [Pa].
    fn moved(&mut self, along: f64, across: f64) {
        let mut strain = self.strains[0] - POISSON * (along - self.strains[1]);
        let stiffness = YOUNG / (1.0 - POISSON);
        for _ in 0..200 {
            let excess = self.tried([strain, along]).1[0] - across;
            strain -= 0.9 * excess / stiffness;
            if excess.abs() < 1e-6 * TENSILE {
                break;
            }
        }
        self.accept([strain, along]);
    }

    fn accept(&mut self, strains: [f64; 2]) {
        let (history, stress, energy) = self.tried(strains);
        for (a, count) in [(0, 2.0), (1, 1.0)] {
            let mean = 0.5 * (self.stress[a] + stress[a]);
            self.work += count * mean * (strains[a] - self.strains[a]);
        }
        (self.history, self.stress, self.energy, self.strains) = (history, stress, energy, strains);
    }

    fn lambda(&self) -> f64 {
        self.history[Concrete::LAMBDA]
    }

    /// Strains along to an end, in equal steps under a stress across; returns the largest magnitude of the stress
    /// difference.
    fn drive(&mut self, end: f64, steps: usize, across: f64) -> f64 {
        let start = self.strains[1];
        let mut most: f64 = 0.0;
        for n in 1..=steps {
            self.moved(start + (end - start) * n as f64 / steps as f64, across);
            most = most.max((self.stress[1] - across).abs());
        }
        most
    }
}

#[test]
fn uniaxial_strengths() {
    for dilatancy in [0.0, 0.5] {
        let concrete = concrete(dilatancy);
        let compressive = concrete.surfaces.compressive;
        assert!((compressive / 40e6 - 1.0).abs() < 1e-4, "{compressive}");
        let mut pressed = Driver::new(concrete.clone());
        let most = pressed.drive(-4e-3, 500, 0.0);
        assert!((most / compressive - 1.0).abs() < 1e-3, "{most}");
        assert!(pressed.stress[1].abs() < 0.9 * most);
        let mut drawn = Driver::new(concrete);
        let most = drawn.drive(5e-4, 700, 0.0);
        assert!((most / TENSILE - 1.0).abs() < 1e-3, "{most}");
    }
}

#[test]
fn triaxial_strengths_lie_on_the_surface() {
    for confinement in [5e6, 60e6, 150e6] {
        let concrete = concrete(0.0);
        let surfaces = concrete.surfaces.clone();
        let mut driver = Driver::new(concrete);
        for n in 1..=20 {
            let pressure = confinement * f64::from(n) / 20.0;
            let strain = -pressure / (3.0 * driver.law.bulk);
            driver.accept([strain; 2]);
        }
        let most = driver.drive(-0.08, 400, -confinement);
        // p = confinement + q/3 on the compressive meridian.
        let (mut low, mut high) = (0.0, 1e9);
        for _ in 0..60 {
            let q = 0.5 * (low + high);
            let below = surfaces.strength(confinement + q / 3.0) > q;
            *(if below { &mut low } else { &mut high }) = q;
        }
        assert!((most / low - 1.0).abs() < 2e-3, "{confinement}: {most} {low}");
    }
}

/// Shear and confined extension end on the surface with its section.
#[test]
fn points_end_on_the_surface_of_their_angle() {
    let concrete = concrete(0.5);
    let law = law(concrete.clone());
    for direction in [
        [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
        [[1.0, 0.0, 0.3], [0.0, -0.7, 0.0], [0.2, 0.0, -0.9]],
        [[-0.6, 0.2, 0.0], [0.0, -0.6, 0.1], [0.0, 0.0, 0.2]],
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.2], [0.0, 0.0, 0.9]],
    ] {
        let mut history = vec![0.0; law.history()];
        for n in 1..=400 {
            let size = 2e-3 * f64::from(n) / 400.0;
            let gradient = std::array::from_fn(|a| {
                std::array::from_fn(|b| IDENTITY[a][b] + size * direction[a][b])
            });
            let response = law.respond(&Deformed::of(gradient), 0.0, &mut history);
            let stress = product(&response.stress, &transposed(&gradient));
            let p = -(stress[0][0] + stress[1][1] + stress[2][2]) / 3.0;
            let s: Matrix3 = std::array::from_fn(|a| {
                std::array::from_fn(|b| stress[a][b] + if a == b { p } else { 0.0 })
            });
            let q = (1.5 * contraction(&s, &s)).sqrt();
            let ratio = concrete.surfaces.ratio(p);
            let lambda = history[Concrete::LAMBDA];
            let most =
                Surfaces::section(ratio, cosine(&eigen(&s).0)) * concrete.strength(p, lambda);
            assert!(q <= most + 1e-9 * TENSILE, "{n} {q} {most}");
            assert!(-p <= concrete.cut_off(lambda) + 1e-9 * TENSILE, "{n} {p}");
            let largest = eigen(&stress).0.into_iter().fold(f64::NEG_INFINITY, f64::max);
            assert!(largest <= 1.01 * TENSILE, "{n} {largest}");
        }
        assert!(history[Concrete::LAMBDA] > 0.0);
    }
}

#[test]
fn tension_takes_its_energy() {
    for dilatancy in [0.0, 1.0] {
        let wanted = 2500.0;
        let mut concrete = concrete(dilatancy);
        let b = energy::exponent(&concrete.function, TENSILE, dilatancy, wanted).unwrap();
        concrete.exponents[1] = b;
        assert!((concrete.energy_of_tension() / wanted - 1.0).abs() < 1e-9);
        assert!(concrete.brittleness(YOUNG, law(concrete.clone()).bulk) < 1.0);
        let peak = concrete.function.peak;
        let mut driver = Driver::new(concrete);
        // The work up to the peak is not part of it.
        let mut before = 0.0;
        let mut strain = 0.0;
        while driver.lambda() < 3.9e-3 {
            strain += 4e-6;
            driver.moved(strain, 0.0);
            if driver.lambda() <= peak {
                before = driver.work - driver.energy;
            }
        }
        let found = driver.work - driver.energy - before;
        assert!((found / wanted - 1.0).abs() < 0.01, "{dilatancy}: {found}");
    }
}

#[test]
fn tension_from_all_sides_takes_its_energy() {
    let mut concrete = concrete(0.5);
    concrete.opening = energy::opening(&concrete.function, TENSILE, 2500.0);
    let mut driver = Driver::new(concrete);
    let mut before = 0.0;
    for n in 1..=2000 {
        driver.accept([2e-6 * f64::from(n); 2]);
        if driver.lambda() <= 1e-4 {
            before = driver.work - driver.energy;
        }
    }
    let found = driver.work - driver.energy - before;
    assert!((found / 2500.0 - 1.0).abs() < 0.01, "{found}");
    assert!(driver.stress[1].abs() < 1e-3 * TENSILE);
}

/// With a positive exponent damage is bounded, so that energy follows neither steps nor small deviators.
#[test]
fn tension_that_is_held_across_takes_energy_by_no_steps() {
    for part in [0.4, 0.9, 0.999, 1.0] {
        let energies = [400, 1600].map(|steps| {
            let mut concrete = concrete(0.5);
            concrete.exponents[1] = 1.8;
            concrete.opening = energy::opening(&concrete.function, TENSILE, 2500.0);
            let mut driver = Driver::new(concrete);
            for n in 1..=steps {
                let along = 4e-3 * f64::from(n) / f64::from(steps);
                driver.accept([part * along, along]);
            }
            driver.work - driver.energy
        });
        assert!((energies[0] / energies[1] - 1.0).abs() < 0.05, "{part}: {energies:?}");
        assert!((2000.0..3500.0).contains(&energies[1]), "{part}: {energies:?}");
    }
}

#[test]
fn dilation_follows_its_constant() {
    let volumes = [0.0, 0.5, 1.0].map(|dilatancy| {
        let mut driver = Driver::new(concrete(dilatancy));
        driver.drive(-4e-3, 300, 0.0);
        let elastic = driver.stress[1] / (3.0 * driver.law.bulk);
        2.0 * driver.strains[0] + driver.strains[1] - elastic
    });
    assert!(volumes[0].abs() < 1e-9, "{volumes:?}");
    assert!(volumes[1] > 1e-3 && volumes[2] > 1.5 * volumes[1], "{volumes:?}");
}

#[test]
fn compression_softens_as_its_brittleness_says() {
    for dilatancy in [0.0, 0.5] {
        let concrete = concrete(dilatancy);
        let (peak, wanted) = (concrete.function.peak, concrete.brittleness_in_compression(YOUNG));
        let mut driver = Driver::new(concrete);
        let mut steepest: f64 = 0.0;
        for n in 1..=2000 {
            let (stress, strain) = (driver.stress[1], driver.strains[1]);
            driver.moved(-4e-6 * f64::from(n), 0.0);
            let fall = driver.stress[1] - stress;
            let plastic = strain - driver.strains[1] + fall / YOUNG;
            if driver.lambda() > peak {
                steepest = steepest.max(fall / plastic / YOUNG);
            }
        }
        assert!((steepest / wanted - 1.0).abs() < 0.05, "{dilatancy}: {steepest} {wanted}");
    }
}

/// Stress does not jump over strain where parts of surfaces meet.
#[test]
fn stress_is_continuous() {
    let mut driver = Driver::new(concrete(0.9));
    driver.drive(-1.6e-3, 400, -2e6);
    let [across, along] = driver.strains;
    let stresses: Vec<[f64; 2]> = (0..=20_000)
        .map(|n| driver.tried([across + 1e-7 * f64::from(n - 10_000), along - 1e-5]).1)
        .collect();
    let steps = stresses.windows(2).map(|pair| (pair[1][0] - pair[0][0]).abs());
    let most = steps.fold(0.0, f64::max);
    // Elastic moduli bound the change.
    assert!(most < 3.0 * YOUNG * 1e-7, "{most}");
}

#[test]
fn compaction_follows_its_table_and_unloads_elastically() {
    let mut concrete = concrete(0.0);
    concrete.compaction = vec![[0.0, 60e6], [0.02, 200e6], [0.03, 400e6]];
    let mut driver = Driver::new(concrete);
    for n in 1..=200 {
        driver.accept([-1e-4 * f64::from(n); 2]);
        let (p, volume) = (-driver.stress[1], 3.0 * driver.strains[1]);
        let compaction = -volume - p / driver.law.bulk;
        let wanted = crushing(&[[0.0, 60e6], [0.02, 200e6], [0.03, 400e6]], compaction);
        assert!(p < 60e6 || (p / wanted - 1.0).abs() < 1e-9, "{p} {wanted}");
    }
    let before = driver.stress[1];
    driver.accept([-1.98e-2; 2]);
    let slope = (driver.stress[1] - before) / (3.0 * 2e-4);
    assert!((slope / driver.law.bulk - 1.0).abs() < 1e-9, "{slope}");
}

#[test]
fn objectivity_and_dissipation() {
    let law = law(concrete(0.5));
    let (s, c) = 0.7_f64.sin_cos();
    let turn = [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]];
    let mut histories = [vec![0.0; law.history()], vec![0.0; law.history()]];
    let (mut work, mut before, mut stress) = (0.0, IDENTITY, [[0.0; 3]; 3]);
    for n in 1..=300 {
        let size = 3e-3 * (f64::from(n) / 40.0).sin();
        let gradient = [[1.0 + size, 2.0 * size, 0.0], [0.0, 1.0, size], [0.0, 0.0, 1.0 - size]];
        let plain = law.respond(&Deformed::of(gradient), 0.0, &mut histories[0]);
        let turned = Deformed::of(product(&turn, &gradient));
        let turned = law.respond(&turned, 0.0, &mut histories[1]);
        let expected = product(&turn, &plain.stress);
        for k in 0..9 {
            let (a, b) = (k / 3, k % 3);
            assert!((turned.stress[a][b] - expected[a][b]).abs() < 1e-5 * TENSILE);
            let mean = 0.5 * (plain.stress[a][b] + stress[a][b]);
            work += mean * (gradient[a][b] - before[a][b]);
        }
        assert!(work > 0.98 * plain.energy, "{n} {work} {}", plain.energy);
        (before, stress) = (gradient, plain.stress);
    }
}

#[test]
fn unfit_surfaces_are_none() {
    let f = 40e6;
    let good = [[0.2956 * f, 0.4463, 0.0808 / f], [0.2232 * f, 0.625, 0.2575 / f]];
    let with = |surfaces: [[f64; 3]; 2], meridian: [f64; 2]| {
        Surfaces::new(surfaces, [0.4417, 0.1183 / f], TENSILE, 1.15, &[meridian])
    };
    assert!(with(good, [3.0, 0.753]).is_some());
    assert!(with([good[1], good[0]], [3.0, 0.753]).is_none());
    assert!(with(good, [0.7, 0.753]).is_none());
    assert!(with(good, [3.0, 1.1]).is_none());
    assert!(DamageFunction::new(&[[0.0, 0.0], [1.0, 1.0], [2.0, 0.5]]).is_none());
    assert!(DamageFunction::new(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0]]).is_none());
}
