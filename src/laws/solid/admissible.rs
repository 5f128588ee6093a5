//! Stress read where a law was not evaluated, returned to the limit of the law there.
//!
//! Polynomials through yielding points exceed the yield surface `‖ξ‖ ≤ R`, `ξ = dev σ − β`, between and beyond these
//! points. The nearest admissible stress scales ξ and leaves the pressure unchanged, like the radial return of the law.
//! On a free face equilibrium prescribes the traction instead. There the return scales the other parts of ξ, and the
//! pressure follows from the traction, as in plane stress (J. C. Simo and T. J. R. Hughes 1998, § 3.4).

/// Shears of the traction on a face that is normal to an axis, among xx, yy, zz, xy, yz, xz.
const SHEARS: [[usize; 2]; 3] = [[3, 5], [3, 4], [4, 5]];

/// Third of the sum of normal components.
fn mean(tensor: &[f64; 6]) -> f64 {
    (tensor[0] + tensor[1] + tensor[2]) / 3.0
}

/// Contribution of shears to the squared norm of a tensor.
fn squares<'a>(shears: impl Iterator<Item = &'a f64>) -> f64 {
    shears.map(|shear| 2.0 * shear * shear).sum()
}

/// Returns a stress whose ξ is at most `radius` [Pa] long, from a stress and a deviatoric back stress [Pa]. `face` is
/// the axis normal to the free face on which the stress is located; its traction is kept if the radius allows it.
///
/// A stress within the radius is bitwise unchanged.
pub fn admissible(stress: [f64; 6], back: &[f64; 6], radius: f64, face: Option<usize>) -> [f64; 6] {
    let pressure = mean(&stress);
    let deviator = |i: usize| stress[i] - if i < 3 { pressure } else { 0.0 };
    let xi: [f64; 6] = std::array::from_fn(|i| deviator(i) - back[i]);
    let square = xi[..3].iter().map(|x| x * x).sum::<f64>() + squares(xi[3..].iter());
    // Not `square > …`, so that NaN remains NaN.
    if !square.is_finite() || square.sqrt() <= radius {
        return stress;
    }
    let kept = face.map_or(0.0, |axis| squares(SHEARS[axis].iter().map(|&slot| &xi[slot])));
    let room = radius * radius - kept;
    let face = face.filter(|_| room >= 0.0);
    let factor = match face {
        Some(_) => (room / (square - kept)).sqrt(),
        None => radius / square.sqrt(),
    };
    let stays = |slot: usize| face.is_some_and(|axis| SHEARS[axis].contains(&slot));
    let scaled: [f64; 6] =
        std::array::from_fn(|i| back[i] + if stays(i) { xi[i] } else { factor * xi[i] });
    let pressure = face.map_or(pressure, |axis| stress[axis] - scaled[axis]);
    std::array::from_fn(|i| if i < 3 { pressure + scaled[i] } else { scaled[i] })
}

#[cfg(test)]
mod tests {
    use super::super::stress::von_mises;
    use super::*;

    const NO_BACK_STRESS: [f64; 6] = [0.0; 6];
    const STRESSES: [[f64; 6]; 4] = [
        [-420.0, -400.0, 3.0, 10.0, -20.0, 30.0],
        [900.0, 850.0, 1000.0, 0.0, 0.0, 0.0],
        [300.0, -300.0, 0.0, 100.0, 50.0, -70.0],
        [0.0, 0.0, 5000.0, 0.0, 0.0, 0.0],
    ];
    const ROOT: f64 = 0.816_496_580_927_726;

    #[test]
    fn stress_beyond_the_yield_surface_returns_to_it() {
        for stress in STRESSES {
            for face in [None, Some(0), Some(1), Some(2)] {
                for yield_stress in [70.0, 250.0] {
                    let found = admissible(stress, &NO_BACK_STRESS, ROOT * yield_stress, face);
                    let excess = von_mises(found) / yield_stress.min(von_mises(stress)) - 1.0;
                    assert!(excess.abs() < 1e-12, "{stress:?} {face:?}: {excess:e}");
                }
            }
        }
    }

    #[test]
    fn pressure_stays_inside_and_traction_on_a_free_face() {
        for stress in STRESSES {
            let inside = admissible(stress, &NO_BACK_STRESS, 100.0, None);
            assert!((mean(&inside) - mean(&stress)).abs() < 1e-12 * 5000.0);
            for (axis, shears) in SHEARS.iter().enumerate() {
                let radius = 1e-9 + squares(shears.iter().map(|&s| &stress[s])).sqrt();
                let on_face = admissible(stress, &NO_BACK_STRESS, radius, Some(axis));
                assert!((on_face[axis] - stress[axis]).abs() < 1e-9, "{stress:?} {on_face:?}");
                assert!(shears.iter().all(|&slot| on_face[slot] == stress[slot]));
            }
        }
    }

    #[test]
    fn stress_within_the_surface_stays_to_the_bit() {
        for stress in STRESSES {
            let back = [40.0, -10.0, -30.0, 5.0, 0.0, 1.0];
            assert_eq!(admissible(stress, &back, f64::INFINITY, None), stress);
            assert_eq!(admissible(stress, &back, 1e4, Some(2)), stress);
        }
        let none = admissible([f64::NAN; 6], &NO_BACK_STRESS, 1.0, None);
        assert!(none.iter().all(|value| value.is_nan()));
    }

    #[test]
    fn yield_surface_is_centred_on_the_back_stress() {
        let back = [40.0, -10.0, -30.0, 5.0, 0.0, 1.0];
        for stress in STRESSES {
            for face in [None, Some(2)] {
                let found = admissible(stress, &back, ROOT * 100.0, face);
                let shifted: [f64; 6] = std::array::from_fn(|i| found[i] - back[i]);
                assert!((von_mises(shifted) / 100.0 - 1.0).abs() < 1e-12, "{stress:?} {found:?}");
            }
        }
    }
}
