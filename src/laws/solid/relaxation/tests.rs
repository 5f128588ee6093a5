//! Properties of relaxation at a point, over spectra and lengths of steps.

use super::super::{Elastoplastic, Thermoelastic, Viscoelastic};
use super::*;
use crate::laws::{FlowLaw, Law};

const YOUNG: f64 = 3e9;
const POISSON: f64 = 0.35;

fn branch(fraction: f64, time: f64) -> Branch {
    Branch { fraction, time }
}

fn law(shear: &[Branch], bulk: &[Branch]) -> Viscoelastic {
    let elastic = Thermoelastic { young: YOUNG, poisson: POISSON, expansion: 5e-5 };
    Viscoelastic {
        elastic: Elastoplastic::elastic(&elastic, 300.0),
        relaxation: Relaxation::new(shear, bulk, None),
    }
}

fn spectra() -> Vec<Viscoelastic> {
    let many: Vec<Branch> = (-6..7).map(|k| branch(1.0 / 13.0, 10_f64.powi(k))).collect();
    vec![
        law(&[branch(1.0, 1.0)], &[]),
        law(&[branch(0.8, 1.0), branch(0.1, 1e-3)], &[branch(0.3, 10.0)]),
        law(&many, &many),
    ]
}

fn random(rng: &mut fastrand::Rng, size: f64) -> [f64; 6] {
    std::array::from_fn(|_| size * (2.0 * rng.f64() - 1.0))
}

/// Stress and dissipation after steps of these lengths over each of which strain changes linearly.
fn path(law: &Viscoelastic, steps: &[([f64; 6], f64)]) -> ([f64; 6], f64) {
    let mut history = vec![0.0; law.history_len()];
    let (mut stress, mut dissipated) = ([0.0; 6], 0.0);
    for (strain, duration) in steps {
        let old = history.clone();
        let found = law.respond(strain, 300.0, *duration, &old, &mut history);
        (stress, dissipated) = (found.stress, dissipated + found.dissipation);
    }
    (stress, dissipated)
}

/// Elastic energy per volume at a strain.
fn stored(law: &Viscoelastic, strain: &[f64; 6], history: &[f64]) -> f64 {
    let own = law.elastic.at(300.0).unwrap();
    let volume = strain[0] + strain[1] + strain[2];
    let mut shape = *strain;
    shape[..3].iter_mut().for_each(|e| *e -= volume / 3.0);
    law.relaxation.present(&own, (&shape, volume), history).stored
}

/// One step, or a thousand, of a strain that grows linearly.
#[test]
fn linear_strain_is_exact_in_steps_of_any_length() {
    let mut rng = fastrand::Rng::with_seed(4);
    for law in spectra() {
        for duration in [1e-12, 1e-3, 1.0, 1e3, 1e12] {
            let jump = random(&mut rng, 1e-3);
            let end = random(&mut rng, 1e-3);
            let part = |k: usize| {
                std::array::from_fn(|i| jump[i] + (end[i] - jump[i]) * k as f64 / 1000.0)
            };
            let (whole, lost) = path(&law, &[(jump, 0.0), (end, duration)]);
            let steps: Vec<_> = std::iter::once((jump, 0.0))
                .chain((1..=1000).map(|k| (part(k), duration / 1000.0)))
                .collect();
            let (parts, lost_in_parts) = path(&law, &steps);
            let scale = whole.iter().fold(0.0_f64, |most, s| most.max(s.abs()));
            for (a, b) in whole.iter().zip(parts) {
                assert!((a - b).abs() < 1e-10 * scale, "{duration}: {whole:?} {parts:?}");
            }
            assert!(
                (lost / lost_in_parts - 1.0).abs() < 1e-9,
                "{duration}: {lost} {lost_in_parts}"
            );
        }
    }
}

/// A ramp of shear, `τ = η γ̇ (1 − e^{−t/λ})`.
#[test]
fn a_ramp_of_shear_keeps_its_digits_over_all_ratios_of_times() {
    let shear = YOUNG / (2.0 * (1.0 + POISSON));
    for x in [1e-12, 1e-6, 1e-2, 0.999, 1.001, 30.0, 1e6, 1e12] {
        let law = law(&[branch(1.0, 1.0)], &[]);
        let (stress, _) = path(&law, &[([0.0, 0.0, 0.0, 1e-3, 0.0, 0.0], x)]);
        let wanted = -shear * 1e-3 * f64::exp_m1(-x) / x;
        assert!((stress[3] / wanted - 1.0).abs() < 1e-13, "{x}: {} {wanted}", stress[3]);
    }
}

#[test]
fn energy_is_balanced_and_never_created() {
    let mut rng = fastrand::Rng::with_seed(5);
    for law in spectra() {
        let mut history = vec![0.0; law.history_len()];
        let mut strain = random(&mut rng, 1e-3);
        law.respond(&strain, 300.0, 0.0, &history.clone(), &mut history);
        for duration in [1e-9, 1e-4, 0.02, 0.3, 2.0, 50.0] {
            // Held: what is lost was stored.
            let before = stored(&law, &strain, &history);
            let old = history.clone();
            let lost = law.respond(&strain, 300.0, duration, &old, &mut history).dissipation;
            let after = stored(&law, &strain, &history);
            assert!((before - after - lost).abs() < 1e-12 * before, "{duration}");
            assert!(lost >= 0.0 && after >= 0.0);
            // Moved along a straight line: work by Simpson's rule on 400 steps is stored or lost.
            let end = random(&mut rng, 1e-3);
            let part = |k: usize| -> [f64; 6] {
                std::array::from_fn(|i| strain[i] + (end[i] - strain[i]) * k as f64 / 400.0)
            };
            let rate = |stress: &[f64; 6]| -> f64 {
                (0..6).map(|i| stress[i] * (end[i] - strain[i])).sum()
            };
            let before = stored(&law, &strain, &history);
            let (mut now, mut lost, mut work) = (history.clone(), 0.0, 0.0);
            let start = law.respond(&strain, 300.0, 0.0, &history, &mut now).stress;
            work += rate(&start);
            for k in 1..=400 {
                let old = now.clone();
                let found = law.respond(&part(k), 300.0, 0.01 * duration, &old, &mut now);
                lost += found.dissipation;
                let weight = if k == 400 { 1.0 } else { [2.0, 4.0][k % 2] };
                work += weight * rate(&found.stress);
            }
            work /= 1200.0;
            let gained = stored(&law, &end, &now) - before;
            let scale = work.abs() + gained.abs();
            assert!(
                (work - gained - lost).abs() < 2e-3 * scale,
                "{duration}: {work} {gained} {lost}"
            );
            assert!(lost >= 0.0);
            (strain, history) = (end, now);
        }
    }
}

#[test]
fn tangents_are_the_limits_of_differences_at_once_and_in_the_end() {
    for law in spectra() {
        let own = law.elastic.at(300.0).unwrap();
        let at_once = law.over_step(300.0, 0.0).unwrap();
        assert_eq!(law.relaxation.tangent(&at_once), own.elastic_tangent());
        let history = vec![0.0; law.history_len()];
        let mut new = history.clone();
        for duration in [0.0, 0.5, 1e15] {
            let strain = [1e-3, -2e-4, 5e-4, 3e-4, 0.0, 1e-4];
            let found = law.respond(&strain, 300.0, duration, &history, &mut new);
            for i in 0..6 {
                let along: f64 = (0..6).map(|j| found.tangent[j][i] * strain[j]).sum();
                // Linear, so the tangent times the strain from rest is the stress.
                assert!((along - found.stress[i]).abs() < 1e-12 * YOUNG * 1e-3, "{duration}");
            }
        }
    }
}
