//! Errors of a mesh from differences to finer and coarser ones.

/// Levels by which a finer mesh differs from the one that it judges, and the error of that over their difference.
pub type Finer = (i32, f64);

/// Order at which errors fall with the number of elements.
#[derive(Debug)]
pub struct Order {
    /// Of a mesh twice as fine, and of one √2 as fine where that is too large.
    pub twice: Finer,
    pub barely: Finer,
    pub far: [Finer; 2],
    /// Error over the difference to a mesh √2 as coarse, and the difference to one twice as coarse over the error,
    /// where errors fall unevenly.
    pub coarser: [f64; 2],
    /// True if errors through the thickness fall evenly.
    is_smooth: bool,
}

/// Of about 1.6 along edges, where slopes have no limit. Coarser meshes count as of second order: the first difference
/// is the error, the second three times as large.
pub static LINEAR: Order = Order {
    twice: (2, 1.5),
    barely: (1, 2.4),
    far: [(4, 1.1), (8, 1.0)],
    coarser: [1.0, 3.0],
    is_smooth: true,
};

/// Of first order: stress has kinks where flow begins, which lie anywhere within an element.
pub static OF_HISTORY: Order = Order {
    twice: (2, 2.0),
    barely: (1, 3.4),
    far: [(4, 1.35), (8, 1.1)],
    coarser: [2.4, 1.0],
    is_smooth: false,
};

impl Order {
    /// The error along the surface (0) or through the thickness (1) from differences to meshes √2 and twice as coarse.
    pub fn by_coarser(&self, way: usize, first: &[f64], second: &[f64]) -> Vec<f64> {
        let [near, far] = self.coarser;
        let uneven = |(a, b): (&f64, &f64)| (near * a).max(b / far);
        let pairs = first.iter().zip(second);
        if way == 1 && self.is_smooth {
            pairs.map(smooth).collect()
        } else {
            pairs.map(uneven).collect()
        }
    }
}

/// The error through the thickness, where it is even enough to show the order p: the differences are as 1 to
/// `2^{p/2} + 1`, and the error is the first over `2^{p/2} − 1`.
fn smooth((a, b): (&f64, &f64)) -> f64 {
    let ratio = if *a > 0.0 { (b / a).clamp(FIRST_ORDER, THIRD_ORDER) } else { THIRD_ORDER };
    (a / (ratio - 2.0)).max(b / 4.0)
}

/// `2^{p/2} + 1` of orders 1 and 3.
const FIRST_ORDER: f64 = 2.414;
const THIRD_ORDER: f64 = 3.828;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_an_order_are_found_from_finer_and_coarser_meshes() {
        // Errors at levels −2, −1, 0, 2, 4 are 2^(−p/2) times another.
        for (order, power) in [(&LINEAR, 2.0_f64), (&OF_HISTORY, 1.0)] {
            let error = |level: i32| 0.5f64.powf(0.5 * power * f64::from(level));
            let coarser = |level: i32| vec![error(level) - error(0)];
            for way in [0, 1] {
                let found = order.by_coarser(way, &coarser(-1), &coarser(-2))[0];
                assert!((0.95..1.2).contains(&found), "{power} {way}: {found}");
            }
            for (level, factor) in [order.twice, order.barely, order.far[0], order.far[1]] {
                let found = factor * (error(0) - error(level));
                assert!((0.95..1.35).contains(&found), "{power} {level}: {found}");
            }
        }
    }
}
