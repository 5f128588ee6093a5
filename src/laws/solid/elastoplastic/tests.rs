//! Properties that every law has, whatever its constants: one table, one test per property.

use nalgebra::{Matrix3, Rotation3, Vector3};

use super::*;
use crate::laws::{Creep, Elastic, Law, Viscoplastic};

/// Steel, aluminium, copper, hot lead, titanium, glass, and constants unlike any metal: E, ν, α, σ_y, H_i, H_k.
const MATERIALS: [[f64; 6]; 9] = [
    [210e9, 0.3, 12e-6, 250e6, 2e9, 0.0],
    [70e9, 0.33, 23e-6, 95e6, 0.0, 1e9],
    [120e9, 0.34, 17e-6, 70e6, 0.5e9, 0.5e9],
    [12e9, 0.44, 30e-6, 5e6, 0.0, 0.0],
    [115e9, 0.32, 9e-6, 880e6, 1e9, 2e9],
    [65e9, 0.2, 3e-6, 1e15, 0.0, 0.0],
    [1e9, 0.49999, 1e-4, 1e3, 0.0, 1e6],
    [1e6, -0.5, 1e-3, 0.0, 1e3, 1e3],
    [1e6, 0.0, 0.0, 1e3, 1e9, 1e9],
];

/// [s]
const STEP: f64 = 0.5;

struct Case {
    name: String,
    law: Box<dyn Law>,
    plastic: Option<Elastoplastic>,
    /// A large strain for the law.
    strain: f64,
}

/// All laws, with constants that decrease with temperature and with constant ones.
fn laws() -> Vec<Case> {
    let mut all = Vec::new();
    for [young, poisson, expansion, yield_stress, isotropic, kinematic] in MATERIALS {
        let law = Thermoelastic { young, poisson, expansion };
        let strain = 3.0 * yield_stress / young + 1e-4;
        all.push(Case {
            name: format!("elastic {young:e}"),
            law: Box::new(Elastic { law, stress_free_temperature: 300.0 }),
            plastic: None,
            strain: 1e-3,
        });
        for fall in [0.0, 4e-4] {
            let falls = |value: f64| -> OfTemperature {
                Arc::new(move |t: f64| value * (1.0 - fall * (t - 300.0)))
            };
            let plastic = Elastoplastic {
                young: falls(young),
                poisson: constant(poisson),
                expansion: falls(expansion),
                expansion_reference: 300.0,
                yield_stress: falls(yield_stress),
                isotropic: falls(isotropic),
                saturating: None,
                kinematic: falls(kinematic),
                stress_free_temperature: 300.0,
            };
            let unit = yield_stress.max(1e-4 * young);
            for (exponent, rate, part) in
                [(1.0, 1e-2, 1.0), (5.0, 1e-6, 0.0), (5.0, 1e3, 1.0), (20.0, 1e-9, 0.1)]
            {
                // At twice the unit and 350 K.
                let logarithm = f64::ln(rate) - exponent * unit.ln() + 4e3 / 350.0;
                let creep = Creep {
                    coefficient: logarithm.exp(),
                    exponent,
                    activation_temperature: 4e3,
                    breakdown: (exponent == 5.0).then_some(unit),
                };
                let plastic =
                    Elastoplastic { yield_stress: falls(part * yield_stress), ..plastic.clone() };
                all.push(Case {
                    name: format!("viscoplastic {young:e}, {fall}, {exponent}"),
                    law: Box::new(Viscoplastic { plastic, creep }),
                    plastic: None,
                    strain: 3.0 * unit / young + 1e-4,
                });
            }
            let saturating = Saturation { saturation: 2.0 * unit, rate: 1.0 / strain };
            for saturating in [None, Some(saturating)] {
                let plastic = Elastoplastic { saturating, ..plastic.clone() };
                all.push(Case {
                    name: format!("elastoplastic {young:e}, {fall}, {saturating:?}"),
                    law: Box::new(plastic.clone()),
                    plastic: Some(plastic),
                    strain,
                });
            }
        }
    }
    all
}

/// Response of a law to a strain at a temperature [K] after a step [s]; laws without a history leave it unchanged.
fn respond(
    law: &dyn Law,
    strain: &[f64; 6],
    temperature: f64,
    duration: f64,
    old: &PlasticHistory,
    new: &mut PlasticHistory,
) -> Response {
    let mut lists = [[0.0; PlasticHistory::LEN]; 2];
    lists.iter_mut().for_each(|list| old.write(list));
    let [before, mut after] = lists;
    let len = law.history_len();
    let response = law.respond(strain, temperature, duration, &before[..len], &mut after[..len]);
    *new = PlasticHistory::read(&after);
    response
}

fn random(rng: &mut fastrand::Rng, size: f64) -> [f64; 6] {
    std::array::from_fn(|_| size * (2.0 * rng.f64() - 1.0))
}

/// A history produced by the law itself.
fn aged(case: &Case, rng: &mut fastrand::Rng) -> PlasticHistory {
    let mut history = PlasticHistory::default();
    for _ in 0..4 {
        let mut new = PlasticHistory::default();
        let strain = random(rng, 2.0 * case.strain);
        respond(case.law.as_ref(), &strain, 300.0 + 200.0 * rng.f64(), STEP, &history, &mut new);
        history = new;
    }
    history
}

fn matrix(t: &[f64; 6], shear: f64) -> Matrix3<f64> {
    let [xx, yy, zz] = [t[0], t[1], t[2]];
    let [xy, yz, xz] = [t[3] * shear, t[4] * shear, t[5] * shear];
    Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
}

/// A tensor in rotated axes; `shear` is the ratio of its shears to those of the tensor.
fn turned(t: &[f64; 6], rotation: &Matrix3<f64>, shear: f64) -> [f64; 6] {
    let m = rotation * matrix(t, shear) * rotation.transpose();
    let s = 1.0 / shear;
    [m[(0, 0)], m[(1, 1)], m[(2, 2)], s * m[(0, 1)], s * m[(1, 2)], s * m[(0, 2)]]
}

/// Runs a check on random states of all laws.
fn for_all(check: impl Fn(&Case, &mut fastrand::Rng)) {
    for case in laws() {
        let mut rng = fastrand::Rng::with_seed(7);
        for _ in 0..40 {
            check(&case, &mut rng);
        }
    }
}

#[test]
fn objectivity() {
    for_all(|case, rng| {
        let (old, strain) = (aged(case, rng), random(rng, case.strain));
        let axis = Vector3::new(rng.f64(), rng.f64(), rng.f64());
        let rotation = Rotation3::from_scaled_axis(4.0 * axis).into_inner();
        let turned_old = PlasticHistory {
            plastic_strain: turned(&old.plastic_strain, &rotation, 0.5),
            back_strain: turned(&old.back_strain, &rotation, 0.5),
            ..old
        };
        let (mut new, mut turned_new) = (PlasticHistory::default(), PlasticHistory::default());
        let found = respond(
            case.law.as_ref(),
            &turned(&strain, &rotation, 0.5),
            350.0,
            STEP,
            &turned_old,
            &mut turned_new,
        );
        let wanted = respond(case.law.as_ref(), &strain, 350.0, STEP, &old, &mut new);
        let wanted = turned(&wanted.stress, &rotation, 1.0);
        let stiffness: f64 = found.tangent[0][0].abs() + case.stiffness();
        for (f, w) in found.stress.iter().zip(wanted) {
            assert!(
                (f - w).abs() < 1e-12 * stiffness * case.strain.max(0.01),
                "{}: {f} {w}",
                case.name
            );
        }
        assert!((turned_new.accumulated - new.accumulated).abs() < 1e-12 * (1.0 + new.accumulated));
    });
}

impl Case {
    /// Stiffness that amplifies rounding errors of strains [Pa].
    fn stiffness(&self) -> f64 {
        let (old, mut new) = (PlasticHistory::default(), PlasticHistory::default());
        let row = respond(self.law.as_ref(), &[0.0; 6], 300.0, STEP, &old, &mut new).tangent[0];
        row.iter().map(|d| d.abs()).sum()
    }
}

#[test]
fn tangents_are_symmetric_and_the_limit_of_differences() {
    for_all(|case, rng| {
        let (old, strain) = (aged(case, rng), random(rng, case.strain));
        let respond = |strain: &[f64; 6]| {
            let mut new = PlasticHistory::default();
            let response = respond(case.law.as_ref(), strain, 400.0, STEP, &old, &mut new);
            (response, new.accumulated > old.accumulated)
        };
        let (centre, flows) = respond(&strain);
        let largest = case.stiffness();
        let h = 1e-6 * case.strain;
        for j in 0..6 {
            let moved = |by: f64| {
                let mut strain = strain;
                strain[j] += by;
                respond(&strain)
            };
            let (above, below) = (moved(h), moved(-h));
            // Not across the yield surface, where stress has a kink.
            let kink = above.1 != flows || below.1 != flows;
            for i in 0..6 {
                let t = centre.tangent[i][j];
                assert!((t - centre.tangent[j][i]).abs() <= 1e-14 * largest, "{}", case.name);
                let difference = (above.0.stress[i] - below.0.stress[i]) / (2.0 * h);
                let off = (t - difference).abs() / largest;
                assert!(kink || off < 1e-6, "{}: {t} {difference}", case.name);
            }
        }
    });
}

#[test]
fn dissipation_is_never_negative_and_is_what_histories_sum() {
    for_all(|case, rng| {
        let (mut old, mut sum) = (PlasticHistory::default(), 0.0);
        for _ in 0..10 {
            let mut new = PlasticHistory::default();
            let size = case.strain * 10f64.powf(3.0 * rng.f64() - 1.0);
            let (strain, temperature) = (random(rng, size), 250.0 + 300.0 * rng.f64());
            let dissipation =
                respond(case.law.as_ref(), &strain, temperature, STEP, &old, &mut new).dissipation;
            assert!(dissipation >= 0.0 && new.accumulated >= old.accumulated, "{}", case.name);
            sum += dissipation;
            old = new;
        }
        assert!((old.dissipated - sum).abs() <= 1e-12 * sum);
    });
}

#[test]
fn elasticity_below_yield_is_independent_of_the_path() {
    for_all(|case, rng| {
        let Some(plastic) = &case.plastic else { return };
        let at = plastic.at(400.0).unwrap();
        // The norm of a deviator is at most that of six components of equal size.
        let size = 0.2 * at.yield_stress / at.shear;
        let (first, second) = (random(rng, size), random(rng, size));
        let (old, mut new) = (PlasticHistory::default(), PlasticHistory::default());
        let direct = respond(plastic, &second, 400.0, STEP, &old, &mut new);
        assert_eq!(new, old);
        respond(plastic, &first, 400.0, STEP, &old, &mut new);
        assert_eq!(new, old);
        let after = respond(plastic, &second, 400.0, STEP, &{ new }, &mut new);
        assert_eq!(direct, after);
        let young = (plastic.young)(400.0);
        let expansion = (plastic.expansion)(400.0);
        let law = Thermoelastic { young, poisson: (plastic.poisson)(400.0), expansion };
        let elastic = Elastic { law, stress_free_temperature: 300.0 };
        let wanted = respond(&elastic, &second, 400.0, STEP, &old, &mut new);
        let scale = at.bulk * (size + 100.0 * expansion) + at.shear * size;
        for (f, w) in direct.stress.iter().zip(wanted.stress) {
            assert!((f - w).abs() <= 1e-13 * scale, "{}: {f} {w}", case.name);
        }
    });
}

#[test]
fn return_to_the_yield_surface_from_any_distance() {
    for_all(|case, rng| {
        let Some(plastic) = &case.plastic else { return };
        let old = aged(case, rng);
        for power in [0.0, 1.0, 3.0, 6.0, 100.0] {
            let strain = random(rng, case.strain * 10f64.powf(power));
            let temperature = 300.0 + 400.0 * rng.f64();
            let at = plastic.at(temperature).unwrap();
            let mut new = PlasticHistory::default();
            let response = respond(plastic, &strain, temperature, STEP, &old, &mut new);
            let back = at.back_stress(&new.back_strain);
            let mean = (0..3).map(|i| response.stress[i]).sum::<f64>() / 3.0;
            let xi: [f64; 6] = std::array::from_fn(|i| {
                response.stress[i] - back[i] - if i < 3 { mean } else { 0.0 }
            });
            let growth = plastic.saturating.map_or(0.0, |own| {
                (own.saturation - at.yield_stress) * (1.0 - (-own.rate * new.accumulated).exp())
            });
            let radius = at.yield_stress + at.isotropic * new.accumulated + growth;
            let equivalent = norm(&xi) / ROOT;
            // Pressure and back stress may be much larger.
            let scale = radius + 1e-3 * (mean.abs() + norm(&back));
            if new.accumulated > old.accumulated {
                assert!((equivalent - radius).abs() <= 1e-12 * scale, "{} {power}", case.name);
            } else {
                assert!(equivalent <= radius + 1e-12 * scale, "{} {power}", case.name);
            }
            assert!(response.stress.iter().all(|s| s.is_finite()), "{} {power}", case.name);
        }
    });
}

#[test]
fn bilinear_bar_under_cyclic_strain() {
    for [young, poisson, _, yield_stress, isotropic, kinematic] in MATERIALS {
        if yield_stress == 0.0 {
            continue;
        }
        let law = Thermoelastic { young, poisson, expansion: 0.0 };
        let law = Elastoplastic {
            yield_stress: constant(yield_stress),
            isotropic: constant(isotropic),
            kinematic: constant(kinematic),
            ..Elastoplastic::elastic(&law, 300.0)
        };
        let unit = yield_stress / young;
        let path = [0.5, 3.0, 1.0, -4.0, -3.5, 6.0, 0.0].map(|part| part * unit);
        let bar = crate::closed_form::Bilinear::bar(young, yield_stress, isotropic, kinematic);
        let mut history = PlasticHistory::default();
        for (strain, wanted) in path.iter().zip(bar.stresses(&path)) {
            // Lateral strain at which the lateral stress vanishes.
            let (mut side, mut new) = (-poisson * strain, PlasticHistory::default());
            let mut stress = f64::NAN;
            for _ in 0..40 {
                let six = [side, side, *strain, 0.0, 0.0, 0.0];
                let response = respond(&law, &six, 300.0, STEP, &history, &mut new);
                side -= response.stress[0] / (response.tangent[0][0] + response.tangent[0][1]);
                stress = response.stress[2];
            }
            history = new;
            let scale = yield_stress * if poisson > 0.49 { 1e4 } else { 1.0 };
            assert!((stress - wanted).abs() < 1e-11 * scale, "{young:e}: {stress} {wanted}");
        }
    }
}

/// A bar that is drawn: `ε = Y(p)/E + p`.
#[test]
fn yield_stress_of_a_bar_saturates_whatever_the_step() {
    let (young, poisson, first) = (200e9, 0.3, 200e6);
    for (saturation, rate) in [(400e6, 100.0), (400e6, 1e6), (201e6, 1e-6), (200e6, 5.0)] {
        for isotropic in [0.0, 2e9] {
            let law = Elastoplastic {
                yield_stress: constant(first),
                isotropic: constant(isotropic),
                saturating: Some(Saturation { saturation, rate }),
                ..Elastoplastic::elastic(&Thermoelastic { young, poisson, expansion: 0.0 }, 300.0)
            };
            for strain in [0.9e-3, 1.1e-3, 1e-2, 1.0, 1e3] {
                let mut side = -0.4 * strain;
                let (old, mut new) = (PlasticHistory::default(), PlasticHistory::default());
                let mut stress = f64::NAN;
                for _ in 0..60 {
                    let six = [side, side, strain, 0.0, 0.0, 0.0];
                    let response = respond(&law, &six, 300.0, STEP, &old, &mut new);
                    side -= response.stress[0] / (response.tangent[0][0] + response.tangent[0][1]);
                    stress = response.stress[2];
                }
                let p = strain - stress / young;
                let grown =
                    first + isotropic * p + (saturation - first) * (1.0 - (-rate * p).exp());
                let wanted = if strain * young < first { strain * young } else { grown };
                let off = (stress / wanted - 1.0).abs();
                assert!(off < 1e-10 * (1.0 + strain / 1e-3), "{rate} {strain}: {stress} {wanted}");
            }
        }
    }
}

#[test]
fn work_of_growth_is_what_its_stress_does() {
    let growth = Growth { range: 3.0, rate: 7.0 };
    let count = 10_000;
    let middle = |i: i32| growth.at((f64::from(i) + 0.5) / f64::from(count)) / f64::from(count);
    let sum: f64 = (0..count).map(middle).sum();
    assert!((growth.work(1.0) / sum - 1.0).abs() < 1e-7, "{sum}");
}

#[test]
fn constants_out_of_range_are_refused() {
    let law = Thermoelastic { young: 200e9, poisson: 0.3, expansion: 1e-5 };
    let sound = Elastoplastic::elastic(&law, 300.0);
    assert!(sound.at(1e4).is_some());
    for broken in [
        Elastoplastic { young: constant(0.0), ..sound.clone() },
        Elastoplastic { poisson: constant(0.5), ..sound.clone() },
        Elastoplastic { poisson: constant(-1.0), ..sound.clone() },
        Elastoplastic { yield_stress: constant(-1.0), ..sound.clone() },
        Elastoplastic { yield_stress: constant(f64::NAN), ..sound.clone() },
        Elastoplastic { isotropic: constant(-1e9), ..sound.clone() },
        Elastoplastic {
            yield_stress: constant(2e8),
            saturating: Some(Saturation { saturation: 1e8, rate: 1.0 }),
            ..sound.clone()
        },
        Elastoplastic { expansion: constant(f64::INFINITY), ..sound.clone() },
    ] {
        assert!(broken.at(400.0).is_none());
        let mut new = PlasticHistory::default();
        assert!(
            respond(&broken, &[0.0; 6], 400.0, STEP, &PlasticHistory::default(), &mut new).stress
                [0]
            .is_nan()
        );
    }
}

/// A body without stress at 800 K under a mean coefficient that is measured from 300 K.
#[test]
fn mean_coefficients_of_expansion_count_from_their_reference() {
    let mean = |t: f64| 2.5e-6 + 2e-9 * (t - 300.0);
    let law = Elastoplastic {
        expansion: Arc::new(mean),
        expansion_reference: 300.0,
        ..Elastoplastic::elastic(
            &Thermoelastic { young: 1e11, poisson: 0.2, expansion: 0.0 },
            800.0,
        )
    };
    let length = |t: f64| mean(t) * (t - 300.0);
    for temperature in [300.0, 500.0, 800.0, 1000.0] {
        let strain = law.at(temperature).unwrap().thermal_strain;
        assert!((strain - (length(temperature) - length(800.0))).abs() < 1e-18, "{temperature}");
    }
}
