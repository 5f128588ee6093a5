//! Notched beams of concrete: peaks of an independent program, spacing, size effect, and a published test.

use crate::common::Trial;

/// A beam whose span, length and notch are those of D3, D6 and D9.
fn beam(depth: f64, spacing: f64, width: f64, keys: &str) -> String {
    let (span, notch, length) = (3.0 * depth, depth / 3.0, 3.0 * depth + 4.0 * spacing);
    format!(
        r#"
name = "Beam"
stop_time = 1.0
step = 0.1
[body.beam]
kind = "lattice"
length = {length}
depth = {depth}
thickness = 0.1524
spacing = {spacing}
notch = {{ depth = {notch}, width = {width} }}
support = {{ three_point = {{ span = {span} }} }}
control = "opening"
{keys}
"#
    )
}

const OPENINGS: &str = "material = { density = 2323.0, young = 30e9, poisson = 0.2, softening = { model = \"openings\", \
                        strength = 4.5e6, openings = [9.05e-6, 197e-6], share = 0.13 } }";
/// Width of a notch that takes out one column of particles, as in the source [m].
const COLUMN: f64 = 2.54e-3;
/// The source's choice: symmetric, and closed links bear no pressure.
const PLAIN: &str = "scatter = 0.0\ncontact = false\n";

/// Loads at equally spaced openings up to a last one [m].
fn curve(text: &str, last: f64, steps: usize) -> Vec<f64> {
    let mut trial = Trial::new(text);
    let of_step = |step: usize| {
        trial.set("beam.opening", last * step as f64 / steps as f64);
        trial.step(0.1);
        trial.get("beam.force")
    };
    (1..=steps).map(of_step).collect()
}

fn peak(loads: &[f64]) -> f64 {
    loads.iter().copied().fold(0.0, f64::max)
}

/// Peaks are within 2 % of those of an independent program of secant iterations (A: links across, B: along), and those
/// of D6 within 3 % of each other while the spacing falls to a quarter.
#[test]
fn peaks_are_those_of_another_program() {
    for (depth, spacing, arrangement, wanted) in [
        (76.2e-3, 6.35e-3, "across", 6684.0),
        (76.2e-3, 3.175e-3, "across", 6706.0),
        (152.4e-3, 12.7e-3, "across", 11065.0),
        (152.4e-3, 6.35e-3, "across", 11023.0),
        (152.4e-3, 3.175e-3, "across", 10938.0),
        (228.6e-3, 12.7e-3, "across", 14715.0),
        (228.6e-3, 9.525e-3, "across", 14595.0),
        (228.6e-3, 6.35e-3, "across", 14454.0),
        (76.2e-3, 7.33e-3, "along", 6010.0),
        (76.2e-3, 3.67e-3, "along", 6625.0),
        (152.4e-3, 14.7e-3, "along", 10067.0),
        (152.4e-3, 7.33e-3, "along", 10621.0),
        (228.6e-3, 11e-3, "along", 14020.0),
    ] {
        let keys = format!("arrangement = \"{arrangement}\"\n{PLAIN}{OPENINGS}");
        let found = peak(&curve(&beam(depth, spacing, COLUMN, &keys), 56e-6, 14));
        println!("{depth} {spacing} {arrangement}: {found:.0} N for {wanted}");
        assert!((found / wanted - 1.0).abs() < 0.02, "{depth}, {spacing}: {found} N for {wanted}");
    }
    for (depth, spacing, onset, wanted) in [
        (76.2e-3, 6.35e-3, 1.18e-4, 6182.0),
        (76.2e-3, 3.175e-3, 1.5e-4, 6707.0),
        (152.4e-3, 6.35e-3, 1.18e-4, 10522.0),
        (228.6e-3, 12.7e-3, 0.8e-4, 11489.0),
        (228.6e-3, 6.35e-3, 1.18e-4, 14088.0),
    ] {
        let softening = format!(
            "material = {{ density = 2323.0, young = 30e9, poisson = 0.2, softening = {{ model = \"stretches\", onset = \
             {onset}, stretches = [20.0, 415.0], share = 0.13 }} }}"
        );
        let found =
            peak(&curve(&beam(depth, spacing, COLUMN, &format!("{PLAIN}{softening}")), 56e-6, 14));
        println!("{depth} {spacing} as printed: {found:.0} N for {wanted}");
        assert!((found / wanted - 1.0).abs() < 0.02, "{depth}, {spacing}: {found} N for {wanted}");
    }
}

/// With scatter and a cut, peaks of D3, D6 and D9 depend on the spacing by less than 4 %, and fall with the size as
/// Bažant's law has it: each ratio lies between a strength without size effect and that of linear fracture mechanics.
#[test]
fn larger_beams_are_weaker() {
    let nominal = [76.2e-3, 152.4e-3, 228.6e-3].map(|depth: f64| {
        let peaks = [depth / 12.0, depth / 24.0]
            .map(|spacing| peak(&curve(&beam(depth, spacing, 0.0, OPENINGS), 56e-6, 28)));
        println!("{depth}: {peaks:?} N");
        assert!((peaks[1] / peaks[0] - 1.0).abs() < 0.04, "{depth}: {peaks:?}");
        peaks[1] / (0.1524 * depth)
    });
    for sizes in nominal.windows(2) {
        let ratio = sizes[1] / sizes[0];
        assert!(ratio < 0.97, "{nominal:?}");
    }
    assert!(nominal[1] / nominal[0] > 0.5_f64.sqrt(), "{nominal:?}");
    assert!(nominal[2] / nominal[1] > (2.0_f64 / 3.0).sqrt(), "{nominal:?}");
}

/// Half-notched beam 4 of D. Grégoire et al. 2013 (doi 10.1002/nag.2187) with its published E, f_t and G_f and
/// Wittmann's bilinear law (1/4, 0.75 G_f/f_t, 5 G_f/f_t). With 40 particles over the depth the peak and
/// loads at 0.05 to 0.2 mm are within the envelope of the tests; with 20 up to 10 % above it. The peak comes at
/// 28 µm instead of 18 to 23 µm.
#[test]
fn published_beam_is_within_its_tests() {
    let (strength, energy, young, poisson) = (3.9e6, 143.2, 37e9, 0.2);
    for (spacing, slack) in [(2.5e-3, 1.1), (1.25e-3, 1.0)] {
        // A straight crack takes f (s f/E + w₂ + α₁ w₃)/(√3 (1 − ν)) per area.
        let opening =
            3.0_f64.sqrt() * (1.0 - poisson) * energy / strength - spacing * strength / young;
        let [knee, end] = [0.75, 5.0].map(|part| part / (0.75 + 0.25 * 5.0) * opening);
        let text = format!(
            r#"
name = "Beam"
stop_time = 1.0
step = 0.1
[body.beam]
kind = "lattice"
length = 0.175
depth = 0.05
thickness = 0.05
spacing = {spacing}
notch = {{ depth = 0.025 }}
support = {{ three_point = {{ span = 0.125 }} }}
control = "opening"
material = {{ density = 2346.0, young = {young}, poisson = {poisson}, softening = {{ model = "openings", strength = {strength}, openings = [{knee}, {end}], share = 0.25 }} }}
"#
        );
        let loads = curve(&text, 0.2e-3, 40);
        println!(
            "{spacing}: peak {:.0} N, {:.0?}",
            peak(&loads),
            [9, 19, 29, 39].map(|n| loads[n])
        );
        assert!((933.0..1114.0 * slack).contains(&peak(&loads)), "{}", peak(&loads));
        for (n, least, most) in
            [(9, 637.0, 897.0), (19, 381.0, 644.0), (29, 257.0, 528.0), (39, 169.0, 412.0)]
        {
            assert!((least..most * slack).contains(&loads[n]), "{spacing}, {n}: {} N", loads[n]);
        }
    }
}

/// Strips of 60 × 40 mm that are pulled until they are in two take a share of the area below the law of a link,
/// `f (s f/2E + (1 + α₁) w₂/2 + α₁ (w₃ − w₂)/2)`, that depends on the arrangement, and on the sample: cracks that begin at
/// two places take more than straight ones. Of seven samples the least and the median are within limits.
#[test]
fn cracks_take_their_share_of_the_energy_of_links() {
    let (strength, young, spacing, share, [knee, end]) = (3e6, 18e9, 2.5e-3, 0.2, [12e-6, 150e-6]);
    let law = strength
        * (0.5 * spacing * strength / young
            + 0.5 * (1.0 + share) * knee
            + 0.5 * share * (end - knee));
    for (arrangement, least, most) in
        [("across", 0.8, 1.25), ("along", 1.2, 1.4), ("random", 0.85, 1.4)]
    {
        for poisson in [0.0, 0.2] {
            let of_sample = |seed: usize| {
                let text = format!(
                    r#"
name = "Strip"
stop_time = 1.0
step = 0.02
[body.strip]
kind = "lattice"
length = 0.06
depth = 0.04
thickness = 0.04
spacing = {spacing}
arrangement = "{arrangement}"
seed = {seed}
support = "ends"
material = {{ density = 2200.0, young = {young}, poisson = {poisson}, softening = {{ model = "openings", strength = {strength}, openings = [{knee}, {end}], share = {share} }} }}
"#
                );
                let mut trial = Trial::new(&text);
                for n in 1..=50 {
                    trial.set("strip.displacement", 4e-6 * f64::from(n));
                    trial.step(0.02);
                }
                trial.get("strip.dissipated_energy") / (0.04 * 0.04 * law)
            };
            let mut found: Vec<f64> = (0..7).map(of_sample).collect();
            found.sort_by(f64::total_cmp);
            println!("{arrangement}, ν {poisson}: cracks take {found:.3?} of the energy of a link");
            let (lowest, median) = (found[0], found[3]);
            assert!(lowest > least && median < most, "{arrangement}, {poisson}: {found:?}");
        }
    }
}
