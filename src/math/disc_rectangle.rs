//! Intersection of a rectangle with a circle about the origin.

/// Area of the rectangle `[x₀, x₁] × [y₀, y₁]` that lies within `radius` of the origin.
pub fn area_within(radius: f64, [[x0, x1], [y0, y1]]: [[f64; 2]; 2]) -> f64 {
    let corner = |x: f64, y: f64| x.signum() * y.signum() * quadrant(radius, x.abs(), y.abs());
    corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0)
}

/// The same for `[0, x] × [0, y]`.
fn quadrant(radius: f64, x: f64, y: f64) -> f64 {
    let (x, y) = (x.min(radius), y.min(radius));
    if x * x + y * y <= radius * radius {
        return x * y;
    }
    // Up to where the circle leaves the upper edge, then below the circle.
    let edge = ((radius - y) * (radius + y)).max(0.0).sqrt();
    let below = |u: f64| {
        let height = ((radius - u) * (radius + u)).max(0.0).sqrt();
        0.5 * (u * height + radius * radius * (u / radius).clamp(-1.0, 1.0).asin())
    };
    y * edge + below(x) - below(edge)
}

/// Length of `[x₀, x₁]` on the line y that lies within `radius` of the origin.
pub fn length_within(radius: f64, [x0, x1]: [f64; 2], y: f64) -> f64 {
    let half = ((radius - y) * (radius + y)).max(0.0).sqrt();
    (x1.min(half) - x0.max(-half)).max(0.0)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn area_matches_sampling() {
        const N: usize = 1000;
        for rectangle in
            [[[-1.0, 1.0], [-1.0, 1.0]], [[0.2, 0.9], [-0.3, 0.8]], [[0.5, 2.0], [0.1, 3.0]]]
        {
            let [[x0, x1], [y0, y1]]: [[f64; 2]; 2] = rectangle;
            let at =
                |low: f64, high: f64, n: usize| low + (high - low) * (n as f64 + 0.5) / N as f64;
            for radius in [0.1, 0.5, 1.0, 1.2, 5.0] {
                let inside = |i: usize| {
                    let row = (0..N).filter(move |&j| at(x0, x1, i).hypot(at(y0, y1, j)) < radius);
                    row.count()
                };
                let share = (0..N).map(inside).sum::<usize>() as f64 / (N * N) as f64;
                let counted = share * (x1 - x0) * (y1 - y0);
                let area = area_within(radius, rectangle);
                assert!((area - counted).abs() < 3e-3, "{rectangle:?} {radius}: {area} {counted}");
            }
        }
        assert!((area_within(1.0, [[-2.0, 2.0], [-2.0, 2.0]]) - PI).abs() < 1e-14);
        assert!((area_within(2.0, [[0.0, 3.0], [-3.0, 3.0]]) - 2.0 * PI).abs() < 1e-14);
    }

    #[test]
    fn length_matches_chord() {
        assert_eq!(length_within(5.0, [-9.0, 9.0], 3.0), 8.0);
        assert_eq!(length_within(5.0, [1.0, 9.0], 3.0), 3.0);
        assert_eq!(length_within(5.0, [1.0, 9.0], 6.0), 0.0);
    }
}
