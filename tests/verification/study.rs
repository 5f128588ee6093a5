//! A row of ever finer runs of one case, and its table.

use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Alumina (Park §2.4.6.3).
pub const CONDUCTIVITY: f64 = 10.0;
pub const HEAT_CAPACITY: f64 = 3950.0 * 900.0;
pub const YOUNG: f64 = 300e9;
pub const POISSON: f64 = 0.21;
pub const EXPANSION: f64 = 8.1e-6;

/// A scene of one alumina body.
pub fn alumina(shape: &str, mesh: &str, faces: &str, rest: &str) -> String {
    format!(
        r#"
name = "Alumina"
stop_time = 1e-3
step = 1e-5
[body.plate]
kind = "solid"
shape = {{ {shape} }}
material = {{ model = "thermoelastic", density = 3950.0, specific_heat = 900.0, conductivity = 10.0, young = 300e9, poisson = 0.21, expansion = 8.1e-6 }}
initial_temperature = 293.15
mesh = {{ {mesh} }}
[body.plate.faces]
{faces}
{rest}
"#
    )
}

/// A probe of everything at a depth [m] on the axis.
pub fn probe(name: &str, at: [f64; 3], gives: &str) -> String {
    format!("[[probe]]\nname = \"{name}\"\nin = \"plate\"\nat = {at:?}\ngives = [{gives}]\n")
}

/// Probes at points, named NAME0, NAME1 …
pub fn line_of_probes(name: &str, points: &[[f64; 3]], gives: &str) -> String {
    points.iter().enumerate().map(|(i, &at)| probe(&format!("{name}{i}"), at, gives)).collect()
}

/// Root of the sum of squared errors over that of the exact values.
pub fn relative_norm(values: &[f64], exact: &[f64]) -> f64 {
    let square = |list: &mut dyn Iterator<Item = f64>| list.map(|v| v * v).sum::<f64>();
    let error = square(&mut values.iter().zip(exact).map(|(v, e)| v - e));
    (error / square(&mut exact.iter().copied())).sqrt()
}

/// Growth of elements for a spacing, so that a mesh of half the spacing is finer everywhere alike.
pub fn growth(spacing: f64, coarsest: f64) -> f64 {
    1.0 + 0.25 * spacing / coarsest
}

/// Keeps a table of numbers for the scripts that draw them.
pub fn keep(name: &str, header: &str, rows: impl IntoIterator<Item = Vec<f64>>) {
    let mut text = format!("{header}\n");
    for row in rows {
        let cells: Vec<String> = row.iter().map(|value| format!("{value:e}")).collect();
        let _ = writeln!(text, "{}", cells.join(","));
    }
    fs::write(Path::new(env!("CARGO_TARGET_TMPDIR")).join(name), text).unwrap();
}

/// Relative errors of several quantities over spacings that halve from row to row.
pub struct Study {
    title: String,
    quantities: Vec<&'static str>,
    rows: Vec<(String, f64, Vec<f64>)>,
}

impl Study {
    pub fn new(title: &str, quantities: &[&'static str]) -> Self {
        Self { title: title.into(), quantities: quantities.into(), rows: Vec::new() }
    }

    /// Adds the relative errors of a run with this spacing or step.
    pub fn add(&mut self, label: &str, spacing: f64, errors: Vec<f64>) {
        self.rows.push((label.into(), spacing, errors));
    }

    /// Order of convergence of a quantity between the last two rows.
    pub fn order(&self, quantity: usize) -> f64 {
        let [.., (_, h0, e0), (_, h1, e1)] = self.rows.as_slice() else { return f64::NAN };
        (e0[quantity].abs() / e1[quantity].abs()).ln() / (h0 / h1).ln()
    }

    /// Order over the whole row of runs, for errors that change their sign on the way.
    pub fn overall_order(&self, quantity: usize) -> f64 {
        let (Some((_, h0, e0)), Some((_, h1, e1))) = (self.rows.first(), self.rows.last()) else {
            return f64::NAN;
        };
        (e0[quantity].abs() / e1[quantity].abs()).ln() / (h0 / h1).ln()
    }

    /// Error of a quantity in the finest run.
    pub fn finest(&self, quantity: usize) -> f64 {
        self.rows.last().map_or(f64::NAN, |(.., errors)| errors[quantity].abs())
    }

    /// Least and largest error of some quantities in all runs.
    pub fn range(&self, quantities: &[usize]) -> [f64; 2] {
        let errors = || self.rows.iter().flat_map(|(.., e)| quantities.iter().map(|&q| e[q]));
        [errors().fold(f64::INFINITY, f64::min), errors().fold(f64::NEG_INFINITY, f64::max)]
    }

    /// Fails unless the named quantities converge at this order at least, first run to last, and
    /// end below this error.
    pub fn require(&self, quantities: &[usize], least_order: f64, most_error: f64) {
        for &q in quantities {
            let (order, error) = (self.overall_order(q), self.finest(q));
            let what = format!("{}: {}", self.title, self.quantities[q]);
            assert!(order > least_order, "{what}: order {order}, wanted {least_order}");
            assert!(error < most_error, "{what}: error {error}, wanted {most_error}");
        }
    }

    /// Prints the table in Markdown.
    pub fn print(&self) {
        println!("\n### {}\n", self.title);
        println!("| run | {} |", self.quantities.join(" | "));
        println!("|---|{}", "---|".repeat(self.quantities.len()));
        for (label, _, errors) in &self.rows {
            let cells: Vec<String> = errors.iter().map(|e| format!("{e:+.2e}")).collect();
            println!("| {label} | {} |", cells.join(" | "));
        }
        let orders: Vec<String> = (0..self.quantities.len())
            .map(|q| match self.rows.iter().all(|(.., errors)| errors[q] == 0.0) {
                true => "exact".into(),
                false => format!("{:.1} ({:.1})", self.order(q), self.overall_order(q)),
            })
            .collect();
        println!("| order: last two (first to last) | {} |", orders.join(" | "));
    }
}
