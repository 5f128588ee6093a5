//! Initial positions of the particles of a round droplet.

use super::plan::Placement;

/// Points inside a sphere (a circle in x and z in two dimensions) about the origin, about one per
/// volume `spacing`^d, and their shares of the droplet's volume.
///
/// Points of a lattice have equal shares. Random points have shares inversely proportional to the
/// number density, so crowded ones are lighter: `m_i ∝ 1/Σ_j W_ij` (Park 2021, eq. 2.106). The sum
/// includes points outside the sphere.
pub fn place(
    placement: Placement,
    diameter: f64,
    spacing: f64,
    dimension: usize,
) -> Vec<([f64; 3], f64)> {
    let radius = 0.5 * diameter;
    let inside = |p: &[f64; 3]| p.iter().map(|x| x * x).sum::<f64>() < radius * radius;
    match placement {
        Placement::Lattice => {
            let points: Vec<_> = lattice(radius, spacing, dimension).filter(inside).collect();
            let share = 1.0 / points.len() as f64;
            points.into_iter().map(|point| (point, share)).collect()
        }
        Placement::BlueNoise => super::blue_noise::place(radius, spacing, dimension),
    }
}

/// Rings from the points of a circle in x and z: those with x > 0, with shares proportional to
/// their circumference.
pub fn rings(points: &[([f64; 3], f64)]) -> Vec<([f64; 3], f64)> {
    let outside = points.iter().filter(|(point, _)| point[0] > 0.0);
    let rings: Vec<_> = outside.map(|&(point, share)| (point, share * point[0])).collect();
    let sum: f64 = rings.iter().map(|ring| ring.1).sum();
    rings.into_iter().map(|(point, share)| (point, share / sum)).collect()
}

/// Points of a cubic lattice with the origin at the centre of a cell.
fn lattice(radius: f64, spacing: f64, dimension: usize) -> impl Iterator<Item = [f64; 3]> {
    let half = (radius / spacing).ceil() as i64;
    let at = move |i: i64| (i as f64 + 0.5) * spacing;
    let rows = if dimension == 2 { 0..1 } else { -half..half };
    (-half..half).flat_map(move |k| {
        rows.clone().flat_map(move |j| {
            let y = if dimension == 2 { 0.0 } else { at(j) };
            (-half..half).map(move |i| [at(i), y, at(k)])
        })
    })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn rings_fill_the_droplet() {
        for placement in [Placement::Lattice, Placement::BlueNoise] {
            let rings = rings(&place(placement, 1.0, 0.02, 2));
            assert!((rings.len() as f64 * 0.02f64.powi(2) / (PI / 8.0) - 1.0).abs() < 0.05);
            let mean = |of: fn(&[f64; 3]) -> f64| rings.iter().map(|(x, s)| s * of(x)).sum::<f64>();
            assert!((mean(|_| 1.0) - 1.0).abs() < 1e-12);
            // Means of r and of z² over a ball: 3π/32 D and D²/20.
            assert!((mean(|x| x[0]) / (3.0 * PI / 32.0) - 1.0).abs() < 0.01);
            assert!((mean(|x| x[2] * x[2]) * 20.0 - 1.0).abs() < 0.03);
        }
    }

    #[test]
    fn a_lattice_fills_the_droplet() {
        for (dimension, volume) in [(2, PI / 4.0), (3, PI / 6.0)] {
            let points = place(Placement::Lattice, 1.0, 0.02, dimension);
            let filled = points.len() as f64 * 0.02f64.powi(dimension as i32);
            assert!((filled / volume - 1.0).abs() < 0.01, "{dimension}-D: {filled}");
            let shares: f64 = points.iter().map(|point| point.1).sum();
            assert!((shares - 1.0).abs() < 1e-10);
            let moment: f64 = points.iter().map(|point| point.0[0]).sum();
            assert!(moment.abs() < 1e-9);
        }
    }
}
