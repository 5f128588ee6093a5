//! Lattices compared with sheets, single links and beams.

use std::f64::consts::PI;

use super::equilibrium::{Equilibrium, product};
use super::frame::Frame;
use super::stiffness::Pattern;
use super::*;
use crate::laws::fracture::SofteningLaw;
use crate::runtime::allowance::Allowance;

const OPENINGS: SofteningLaw =
    SofteningLaw::Openings { strength: 4.5e6, ends: [9.05e-6, 197e-6], share: 0.13 };
const CONCRETE: Sheet = Sheet { young: 30e9, poisson: 0.2, thickness: 0.1524 };

/// A beam whose depth is a third of its span, with a notch of a third of its depth.
fn notched(depth: f64, spacing: f64, arrangement: Arrangement) -> LatticePlan {
    let notch = Notch { at: 0.0, depth: depth / 3.0, width: 2.54e-3 };
    let length = 3.0 * depth + 4.0 * spacing;
    LatticePlan {
        strip: Strip { length, depth, spacing, arrangement, notch: Some(notch) },
        sheet: CONCRETE,
        support: Support::ThreePoint { span: 3.0 * depth },
        control: Control::Opening,
        softening: OPENINGS,
        bending: 0.1,
        closes: false,
        scatter: 0.0,
        seed: 0,
    }
}

/// Largest load up to an opening [m], in equal parts.
fn peak(lattice: &Lattice, state: &mut LatticeState, opening: f64, parts: usize) -> f64 {
    let allowance = Allowance::default();
    let mut most = 0.0_f64;
    for part in 1..=parts {
        let target = opening * part as f64 / parts as f64;
        lattice.advance(state, target, &allowance).unwrap();
        most = most.max(state.force);
    }
    most
}

/// Stiffness follows the depth of a cut, also where its tip is at the middle of a link, and that of linear fracture
/// mechanics: the opening over the load is `4σaV/E` with `V(1/3) = 1.8394` (H. Tada, for a span of four depths).
#[test]
fn stiffness_follows_the_depth_of_a_cut_continuously() {
    let depth = 76.2e-3;
    let load = |arrangement: Arrangement, part: f64| {
        let mut plan = notched(depth, depth / 24.0, arrangement);
        plan.strip.notch = Some(Notch { at: 0.0, depth: part * depth / 3.0, width: 0.0 });
        let lattice = Lattice::new(plan, 1).unwrap();
        peak(&lattice, &mut lattice.initial_state(), 1e-7, 1)
    };
    for arrangement in [Arrangement::Across, Arrangement::Along] {
        let [less, at, more] = [1.0 - 1e-9, 1.0, 1.0 + 1e-9].map(|part| load(arrangement, part));
        assert!((less / at - 1.0).abs() < 1e-6 && (more / at - 1.0).abs() < 1e-6);
        let compliance = 1e-7 / at;
        let sigma = 4.5 / (CONCRETE.thickness * depth);
        let wanted = 4.0 * sigma * depth / 3.0 * 1.8394 / CONCRETE.young;
        assert!((compliance / wanted - 1.0).abs() < 0.03, "{arrangement:?}: {compliance} {wanted}");
    }
}

/// The energy of a lattice under uniform strain is that of plane stress, for every ratio and direction.
#[test]
fn uniform_strain_stores_the_energy_of_a_sheet() {
    let (young, thickness, spacing) = (30e9, 0.1, 2e-3);
    for poisson in [-0.9, -0.5, 0.0, 0.2, 0.3, 1.0 / 3.0] {
        let sheet = Sheet { young, poisson, thickness };
        let [axial, flexural] = sheet.stiffness(spacing, spacing / 3.0_f64.sqrt());
        for turn in [0.0, 0.1, PI / 12.0, 0.4, PI / 6.0] {
            for [xx, yy, shear] in [[1e-3, 0.0, 0.0], [-2e-4, 7e-4, 0.0], [1e-4, 3e-4, -5e-4]] {
                // Particles turn with the mean rotation of the field, which is zero.
                let of_link = |k: usize| {
                    let angle = turn + k as f64 * PI / 3.0;
                    let link = Link {
                        ends: [0, 1],
                        length: spacing,
                        direction: [angle.cos(), angle.sin()],
                        axial,
                        flexural,
                        softening: OPENINGS.of_link(spacing, young, 1.0),
                        breaks: true,
                    };
                    let [x, y] = link.direction.map(|part| part * spacing);
                    let moved =
                        [0.0, 0.0, 0.0, xx * x + 0.5 * shear * y, yy * y + 0.5 * shear * x, 0.0];
                    let q = link.rows().map(|row| row.iter().zip(&moved).map(|(a, b)| a * b).sum());
                    0.5 * link.elastic(&q).iter().zip(&q).map(|(a, b)| a * b).sum::<f64>()
                };
                let energy: f64 = (0..3).map(of_link).sum();
                let modulus = young / (1.0 - poisson * poisson);
                let density = 0.5
                    * modulus
                    * (xx * xx
                        + yy * yy
                        + 2.0 * poisson * xx * yy
                        + 0.5 * (1.0 - poisson) * shear * shear);
                let wanted = density * thickness * 0.75_f64.sqrt() * spacing * spacing;
                let error = (energy / wanted - 1.0).abs();
                assert!(error < 1e-12, "ν {poisson}, {turn}: {error:e}");
            }
        }
    }
}

/// Uniform strain leaves no forces on the particles inside of a strip.
#[test]
fn uniform_strain_is_in_equilibrium() {
    for arrangement in [Arrangement::Across, Arrangement::Along] {
        let plan = LatticePlan {
            strip: Strip { notch: None, ..notched(0.05, 5e-3, arrangement).strip },
            control: Control::Displacement,
            ..notched(0.05, 5e-3, arrangement)
        };
        let lattice = Lattice::new(plan, 1).unwrap();
        let places = &lattice.particles().places;
        let mut forces = vec![[0.0; 3]; places.len()];
        let mut size = 0.0_f64;
        for link in lattice.links() {
            let of_end = |[x, y]: [f64; 2]| [1e-4 * x + 3e-5 * y, 3e-5 * x - 2e-4 * y, 0.0];
            let moved = link.ends.map(|i| of_end(places[i]));
            let q = link
                .rows()
                .map(|row| row.iter().zip(moved.as_flattened()).map(|(a, b)| a * b).sum());
            let conjugate = link.elastic(&q);
            size = size.max(conjugate[0].abs());
            for (k, end) in link.ends.into_iter().enumerate() {
                for (c, force) in forces[end].iter_mut().enumerate() {
                    *force += (0..3).map(|m| link.rows()[m][3 * k + c] * conjugate[m]).sum::<f64>();
                }
            }
        }
        let inside = places
            .iter()
            .zip(&forces)
            .filter(|([x, y], _)| x.abs() < 0.06 && *y > 6e-3 && *y < 0.044);
        assert!(inside.clone().count() > 50);
        for (place, force) in inside {
            assert!(force.iter().all(|part| part.abs() < 1e-12 * size), "{place:?}: {force:?}");
        }
    }
}

/// A link that is pulled, released and pulled again follows its law, and what it dissipates is the area below it.
#[test]
fn single_link_follows_its_law() {
    let softening = OPENINGS.of_link(4e-3, 30e9, 1.0);
    let direction = [0.6, 0.8];
    let [axial, flexural] = CONCRETE.stiffness(4e-3, 2.3e-3);
    let link =
        Link { ends: [0, 1], length: 4e-3, direction, axial, flexural, softening, breaks: true };
    // The first particle is held, the second moves along the link, that is by u = 0.6 and w = 0.8 of its elongation.
    let frame = Frame {
        unknown: vec![None, None, None, Some(0), Some(1), Some(2)],
        unknowns: 3,
        load: vec![(0, 0.6), (1, 0.8)],
        mouth: None,
        loaded: Vec::new(),
    };
    let pattern = Pattern::new(frame, &[link], &[0, 1], 1).unwrap();
    let control = vec![(0, 0.6), (1, 0.8)];
    let masses = super::settling::Masses { of_unknowns: vec![1.0; 3], time_step: 1.0, fading: 1.0 };
    let links = vec![link];
    let own =
        Equilibrium { links, pattern, bending: 0.1, closes: true, control, masses, strength: 0.0 };
    let onset = softening.onset * link.length;
    let (knee, end) = (softening.knee * onset, softening.end * onset);
    let path = [
        0.7 * onset,
        onset,
        0.4 * knee,
        knee,
        0.0,
        -0.3 * onset,
        0.0,
        knee,
        0.5 * (knee + end),
        end,
        1.1 * end,
    ];
    let mut now = super::equilibrium::Balanced { displacement: vec![0.0; 3], force: 0.0 };
    let (mut damage, mut dissipated, mut work, mut most) = (vec![0.0], 0.0, 0.0, 0.0_f64);
    let peak = axial * onset;
    for wanted in path {
        let found = own.solve(&now, &damage, wanted, &Allowance::default()).unwrap().unwrap();
        let before = own.deformations(&now.displacement);
        dissipated +=
            own.dissipation([&before, &found.trial.deformation], [&damage, &found.trial.damage]);
        work += 0.5
            * (now.force + found.balanced.force)
            * (wanted - product(&own.control, &now.displacement));
        (now, damage) = (found.balanced, found.trial.damage);
        most = most.max(wanted);
        let on_envelope = |at: f64| {
            if at <= onset {
                peak * at / onset
            } else if at <= knee {
                peak * (1.0 - (1.0 - 0.13) * (at - onset) / (knee - onset))
            } else {
                peak * 0.13 * ((end - at) / (end - knee)).max(0.0)
            }
        };
        let expected =
            if wanted < 0.0 { axial * wanted } else { on_envelope(most) * wanted / most };
        assert!(
            (now.force - expected).abs() < 1e-12 * peak,
            "{wanted:e}: {} for {expected}",
            now.force
        );
    }
    let area = peak * onset * softening.energy();
    assert!((dissipated / area - 1.0).abs() < 1e-12, "{dissipated:e} for {area:e}");
    assert!((work / area - 1.0).abs() < 1e-9, "{work:e} for {area:e}");
}

/// Peaks of concrete beams with a cohesive law do not depend on the spacing, and work balances. The wanted loads are
/// those of an independent program in Python, of secant iterations instead of Newton's: `docs/theory/lattice.md`.
#[test]
fn notched_beams_reach_their_peaks() {
    for (depth, spacing, arrangement, wanted) in [
        (76.2e-3, 6.35e-3, Arrangement::Across, 6684.0),
        (76.2e-3, 7.33e-3, Arrangement::Along, 6010.0),
    ] {
        let lattice = Lattice::new(notched(depth, spacing, arrangement), 1).unwrap();
        let mut state = lattice.initial_state();
        let most = peak(&lattice, &mut state, 36e-6, 9);
        assert!((most / wanted - 1.0).abs() < 0.02, "{most} N for {wanted} N");
        let missing = state.work - state.dissipated - lattice.elastic_energy(&state);
        assert!(missing.abs() < 1e-9 * state.work, "{missing:e} J of {:e} J", state.work);
    }
}

/// Random links have the modulus and the ratio of their sheet.
#[test]
fn random_links_have_the_constants_of_their_sheet() {
    for (poisson, seed) in [(0.0, 0), (0.2, 1), (1.0 / 3.0, 2), (-0.5, 3)] {
        let strip = Strip {
            length: 0.3,
            depth: 0.1,
            spacing: 4e-3,
            arrangement: Arrangement::Random { seed },
            notch: None,
        };
        let plan = LatticePlan {
            strip,
            sheet: Sheet { poisson, ..CONCRETE },
            support: Support::Ends,
            control: Control::Displacement,
            softening: SofteningLaw::Openings { strength: 1e9, ends: [1e-5, 2e-4], share: 0.1 },
            ..notched(0.1, 4e-3, Arrangement::Across)
        };
        let lattice = Lattice::new(plan, 1).unwrap();
        let mut state = lattice.initial_state();
        lattice.advance(&mut state, 1e-6, &Allowance::default()).unwrap();
        let moved = lattice.displacements(&state);
        let places = lattice.particles().places.iter().zip(&moved);
        let inside: Vec<_> = places.filter(|(place, _)| place[0].abs() < 0.1).collect();
        let count = inside.len() as f64;
        // Strain by least squares.
        let strain = |axis: usize| {
            let all = || inside.iter().map(|(place, moved)| (place[axis], moved[axis]));
            let x = all().map(|(x, _)| x).sum::<f64>() / count;
            let slope: f64 = all().map(|(own, moved)| (own - x) * moved).sum();
            slope / all().map(|(own, _)| (own - x).powi(2)).sum::<f64>()
        };
        let modulus = state.force / (strain(0) * 0.1 * CONCRETE.thickness) / CONCRETE.young;
        let ratio = -strain(1) / strain(0);
        assert!((modulus - 1.0).abs() < 0.02, "ν {poisson}: E {modulus} of the sheet's");
        assert!((ratio - poisson).abs() < 0.015, "ν {poisson}: {ratio}");
    }
}
