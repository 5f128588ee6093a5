//! Separates the body of fluid from detached lumps.

/// Largest distance over Δx at which two particles touch. It exceeds √2, to which a film of a cubic
/// lattice may thin without holes, and is below the range of forces.
const TOUCH: f64 = 2.0;
/// Fraction of a drop's mass below which a lump is stray.
const LEAST: f64 = 0.1;

/// Returns for each particle whether it belongs to the body of fluid. The body consists of the
/// heaviest lump and of all lumps of touching particles with at least a tenth of a drop's mass.
/// Positions are in units of Δx, masses in any unit; that of a drop includes images at mirrors
/// x = 0 and y = 0.
///
/// A lump that touches its image at a mirror is one with it.
pub fn body_of_fluid(
    positions: &[[f64; 3]],
    masses: &[f64],
    mirrors: [bool; 2],
    drop: f64,
) -> Vec<bool> {
    let lumps = lumps(positions);
    let mut weights = vec![0.0; masses.len()];
    for (&lump, mass) in lumps.iter().zip(masses) {
        weights[lump as usize] += mass;
    }
    for axis in (0..2).filter(|&axis| mirrors[axis]) {
        let mut touches = vec![false; masses.len()];
        for (&lump, x) in lumps.iter().zip(positions) {
            touches[lump as usize] |= 2.0 * x[axis].abs() <= TOUCH;
        }
        weights.iter_mut().zip(touches).for_each(|(weight, touches)| {
            *weight *= if touches { 2.0 } else { 1.0 };
        });
    }
    let heaviest = weights.iter().copied().fold(0.0, f64::max);
    let least = (LEAST * drop).min(heaviest);
    lumps.iter().map(|&lump| weights[lump as usize] >= least).collect()
}

/// Lump number of each particle: the number of one of the lump's particles.
fn lumps(positions: &[[f64; 3]]) -> Vec<u32> {
    let mut cells: Vec<([i64; 3], u32)> = positions
        .iter()
        .zip(0..)
        .map(|(x, i)| (x.map(|x| (x / TOUCH).floor() as i64), i))
        .collect();
    cells.sort_unstable();
    let starts: Vec<&[([i64; 3], u32)]> = cells.chunk_by(|a, b| a.0 == b.0).collect();
    let mut parents: Vec<u32> = (0..positions.len() as u32).collect();
    let mut join_all = |here: &[([i64; 3], u32)], there: &[([i64; 3], u32)]| {
        for &(_, i) in here {
            for &(_, j) in there {
                if touch(&positions[i as usize], &positions[j as usize]) {
                    let [a, b] = [i, j].map(|k| root(&mut parents, k));
                    parents[a.max(b) as usize] = a.min(b);
                }
            }
        }
    };
    for (n, here) in starts.iter().enumerate() {
        join_all(here, here);
        let [x, y, z] = here[0].0;
        // Cells after this one in order, row by row along the last axis.
        for (dx, dy) in [(0, 0), (0, 1), (1, -1), (1, 0), (1, 1)] {
            let low = [x + dx, y + dy, if (dx, dy) == (0, 0) { z + 1 } else { z - 1 }];
            let high = [x + dx, y + dy, z + 1];
            let first = n + starts[n..].partition_point(|cell| cell[0].0 < low);
            let near = starts[first..].iter().take_while(|cell| cell[0].0 <= high);
            near.for_each(|there| join_all(here, there));
        }
    }
    (0..positions.len() as u32).map(|i| root(&mut parents, i)).collect()
}

fn touch(a: &[f64; 3], b: &[f64; 3]) -> bool {
    (0..3).map(|n| (a[n] - b[n]).powi(2)).sum::<f64>() <= TOUCH * TOUCH
}

/// Root particle of a particle's lump; shortens the path to it.
fn root(parents: &mut [u32], mut of: u32) -> u32 {
    while parents[of as usize] != of {
        let next = parents[parents[of as usize] as usize];
        parents[of as usize] = next;
        of = next;
    }
    of
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No mirrors.
    const WHOLE: [bool; 2] = [false; 2];

    /// A cube of particles from a corner on.
    fn cube(side: usize, corner: [f64; 3]) -> Vec<[f64; 3]> {
        let at = |n: usize| [n % side, n / side % side, n / side / side];
        let place = |at: [usize; 3]| [0, 1, 2].map(|a| corner[a] + at[a] as f64);
        (0..side.pow(3)).map(|n| place(at(n))).collect()
    }

    #[test]
    fn separate_lumps_are_distinguished_at_any_position() {
        for corner in [[0.0; 3], [-3.7, 11.2, -0.4]] {
            let mut positions = cube(6, corner);
            let gaps = [[7.2, 0.0, 0.0], [0.0, -2.1, 0.0], [2.0, 2.0, 6.9], [6.2, 6.2, 6.2]];
            positions.extend(gaps.map(|gap| [0, 1, 2].map(|a| corner[a] + gap[a])));
            positions.extend(cube(3, corner.map(|x| x + 20.0)));
            let lumps = lumps(&positions);
            // The third stands 1.9 above the cube's uppermost layer, the fourth 1.2 √3 off its corner.
            assert!(lumps[..216].iter().all(|&lump| lump == lumps[0]));
            assert_eq!(
                [216, 217, 218, 219].map(|i| lumps[i] == lumps[0]),
                [false, false, true, false]
            );
            assert!(lumps[220..].iter().all(|&lump| lump == lumps[220]) && lumps[220] != lumps[0]);
        }
    }

    #[test]
    fn only_small_lumps_are_stray() {
        let mut positions = cube(6, [0.0; 3]);
        positions.extend(cube(6, [0.0, 0.0, 30.0]));
        positions.extend(cube(2, [20.0, 0.0, 0.0]));
        let body = body_of_fluid(&positions, &[1.0; 440], WHOLE, 216.0);
        assert!(body[..432].iter().all(|&body| body) && !body[432..].contains(&true));
        assert_eq!(body_of_fluid(&positions[432..], &[1.0; 8], WHOLE, 216.0), [true; 8]);
        assert!(body_of_fluid(&[], &[], WHOLE, 216.0).is_empty());
    }

    /// A body on both mirrors, and lumps of its eighth on both, on one and on none.
    #[test]
    fn parts_between_mirrors_have_the_strays_of_the_whole() {
        let edge = |corner: [f64; 3]| corner.map(|x| x + 0.5);
        let mut part = cube(6, edge([0.0; 3]));
        for corner in [[0.0, 0.0, 20.0], [20.0, 0.0, 0.0], [0.0, 20.0, 20.0], [20.0, 20.0, 0.0]] {
            part.extend(cube(3, edge(corner)));
        }
        for mirrors in [[true, true], [true, false], [false, true]] {
            let mut whole = part.clone();
            for axis in (0..2).filter(|&axis| mirrors[axis]) {
                let mut images = whole.clone();
                images.iter_mut().for_each(|x| x[axis] = -x[axis]);
                whole.extend(images);
            }
            let count = whole.len();
            for drop in [200.0, 400.0, 700.0, 1500.0] {
                let of_part = body_of_fluid(&part, &vec![1.0; part.len()], mirrors, drop);
                let of_whole = body_of_fluid(&whole, &vec![1.0; count], WHOLE, drop);
                assert_eq!(of_part, of_whole[..part.len()], "{mirrors:?}, {drop}");
            }
        }
    }
}
