//! Ends of elements along an axis: fine on given stretches, with geometric growth elsewhere.

/// A stretch of an axis that wants elements no larger than `size` [m], and beyond it neighbours that
/// differ by no more than about the factor `growth`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fine {
    pub from: f64,
    pub to: f64,
    pub size: f64,
    pub growth: f64,
}

/// Returns the ends of elements on `[start, end]`.
///
/// The desired size at x is `min over stretches of size + (growth − 1) · distance`, which makes neighbours differ by
/// about that factor, and never more than `coarsest`. Ends are at equal steps of `∫ dx / size(x)`, so that all sizes
/// shrink by one common factor to fit.
pub fn graded_ends(start: f64, end: f64, fine: &[Fine], coarsest: f64) -> Vec<f64> {
    let size = |x: f64| {
        fine.iter()
            .map(|f| f.size + (f.growth - 1.0) * (f.from - x).max(x - f.to).max(0.0))
            .fold(coarsest, f64::min)
    };
    // Kinks of the size function bound the pieces of the quadrature.
    let mut samples: Vec<f64> = vec![start, end];
    samples.extend(fine.iter().flat_map(|f| [f.from, f.to]).filter(|&x| x > start && x < end));
    samples.sort_by(f64::total_cmp);
    samples.dedup();
    let table = cumulated_density(&samples, size);
    let total = table[table.len() - 1].1;
    // A total just above a whole number counts as that number.
    let count = ((total - 1e-9).ceil() as usize).max(1);
    let mut ends: Vec<f64> =
        (0..=count).map(|i| place_of(&table, total * i as f64 / count as f64)).collect();
    ends[0] = start;
    ends[count] = end;
    ends
}

/// `(x, ∫ dx / size)` at many places, by the midpoint rule on small steps.
fn cumulated_density(samples: &[f64], size: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    let mut table = vec![(samples[0], 0.0)];
    let mut sum = 0.0;
    for piece in samples.windows(2) {
        let mut x = piece[0];
        while x < piece[1] {
            // Steps that are a small share of the local size resolve its change.
            let step = (size(x) / 16.0).min(piece[1] - x).max((piece[1] - piece[0]) * 1e-6);
            let next = if piece[1] - x - step < 1e-3 * step { piece[1] } else { x + step };
            sum += (next - x) / size(0.5 * (x + next));
            x = next;
            table.push((x, sum));
        }
    }
    table
}

fn place_of(table: &[(f64, f64)], wanted: f64) -> f64 {
    let above = table.partition_point(|&(_, sum)| sum < wanted).clamp(1, table.len() - 1);
    let ((x0, s0), (x1, s1)) = (table[above - 1], table[above]);
    x0 + (x1 - x0) * (wanted - s0) / (s1 - s0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_fine_inside_and_grow_by_the_ratio_outside() {
        let fine = [Fine { from: 0.0, to: 0.1, size: 0.01, growth: 1.3 }];
        let ends = graded_ends(0.0, 2.0, &fine, f64::INFINITY);
        let sizes: Vec<f64> = ends.windows(2).map(|e| e[1] - e[0]).collect();
        assert!(sizes[..8].iter().all(|&s| s <= 0.0100001 && s > 0.008), "{sizes:?}");
        assert!(sizes.windows(2).all(|s| s[1] / s[0] < 1.36), "{sizes:?}");
        assert_eq!((ends[0], *ends.last().unwrap()), (0.0, 2.0));
    }

    #[test]
    fn equal_elements_without_fine_stretches() {
        let ends = graded_ends(-1.0, 1.0, &[], 0.5);
        assert_eq!(ends.len(), 5);
        assert!((ends[2]).abs() < 1e-12);
    }

    #[test]
    fn symmetric_stretches_give_symmetric_ends() {
        let fine = [Fine { from: -0.2, to: 0.2, size: 0.05, growth: 1.2 }];
        let ends = graded_ends(-1.0, 1.0, &fine, f64::INFINITY);
        for (a, b) in ends.iter().zip(ends.iter().rev()) {
            assert!((a + b).abs() < 1e-3 * 0.05, "{ends:?}");
        }
    }
}
