//! Tables of viscosity over the temperature.

use crate::laws::Table;

/// Interpolates the logarithm of a table's values at a temperature [K]; beyond its ends the value is constant.
///
/// The logarithm of a liquid's viscosity is nearly linear over intervals in which the viscosity itself changes several
/// times.
///
/// NaN for a table that [`Table::check`] refuses because of its lengths.
pub fn interpolated(table: &Table, temperature: f64) -> f64 {
    let Table { temperature: knots, value } = table;
    if value.is_empty() || value.len() != knots.len() {
        return f64::NAN;
    }
    let above = knots.partition_point(|&knot| knot <= temperature);
    if above == 0 || above == knots.len() {
        return value[above.saturating_sub(1)];
    }
    let low = above - 1;
    let part = (temperature - knots[low]) / (knots[above] - knots[low]);
    value[low] * (value[above] / value[low]).powf(part)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logarithms_are_linear_between_knots_and_constant_beyond() {
        let table = Table { temperature: vec![300.0, 400.0, 450.0], value: vec![1.0, 0.01, 0.002] };
        for (temperature, value) in [
            (200.0, 1.0),
            (300.0, 1.0),
            (350.0, 0.1),
            (400.0, 0.01),
            (450.0, 0.002),
            (900.0, 0.002),
        ] {
            let found = interpolated(&table, temperature);
            assert!((found / value - 1.0).abs() < 1e-14, "{temperature}: {found}");
        }
    }
}
