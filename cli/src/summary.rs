use impinge::body::{PeakPart, Reading};
use impinge::model::{Cache, Model, ModelError, State};
use impinge::scene::Scene;
use impinge::variables::{Output, Quantity, Registry, Slot, Variable};
use impinge::warning::{self, Warning};

use super::ranges::is_loaded;
use super::table::table;
use super::units::{decimal, engineering, kelvin};

/// Relative residual of the heat balance above which a run warns.
const BALANCED: f64 = 1e-9;
/// The same with particle conduction, which conserves heat only approximately on graded meshes.
const BALANCED_BY_PARTICLES: f64 = 5e-2;
/// Change of the temperature of a whole body [K] below which its heat does not count beside rounding.
const ROUNDING: f64 = 1e-3;

/// Totals of solids that are listed: of those that melt, deform for good or crack.
const OF_SOLIDS: [&str; 20] = [
    ".liquid_volume",
    ".max_plastic_strain",
    ".plastic_work",
    ".dissipated",
    ".stored",
    "failure_probability",
    ".failure_risk",
    ".failure_place_x",
    ".failure_place_y",
    ".failure_place_z",
    ".max_damage",
    ".crack_area",
    ".first_crack_time",
    ".first_crack_x",
    ".first_crack_y",
    ".first_crack_z",
    ".crack_growth",
    ".crack_length",
    ".crack_count",
    ".crack_depth",
];

/// Start of the names of a body's time and place of the first crack.
const FIRST_CRACK: &str = ".first_crack_";

/// Heat balance of a body [J].
#[derive(Debug, Clone, PartialEq)]
pub struct Balance {
    body: String,
    heat_in: f64,
    stored: f64,
    lost: f64,
    /// Largest of these at any time so far, because rounding scales with it.
    largest: f64,
    /// Largest acceptable relative residual.
    expected: f64,
    /// Heat, or heat per length of a plane model.
    quantity: Quantity,
}

impl Balance {
    /// `|in − stored − lost|` over the largest of these so far; zero without heat.
    fn residual(&self) -> f64 {
        let off = (self.heat_in - self.stored - self.lost).abs();
        if self.largest == 0.0 { 0.0 } else { off / self.largest }
    }

    /// Updates the largest values from earlier balances of the same bodies.
    pub fn join(balances: &mut [Self], earlier: &[Self]) {
        for (now, before) in balances.iter_mut().zip(earlier) {
            now.largest = now.largest.max(before.largest);
        }
    }

    /// Returns a warning if the heat does not balance.
    pub fn warning(&self) -> Option<Warning> {
        let residual = self.residual();
        let is_balanced = residual <= self.expected;
        (!is_balanced).then(|| {
            let (residual, expected) = (format!("{residual:.1e}"), format!("{:e}", self.expected));
            warning::heat_unbalanced(residual, expected).at(&self.body)
        })
    }

    fn row(&self) -> [String; 5] {
        [
            self.body.clone(),
            shown(self.heat_in, self.quantity),
            shown(self.stored, self.quantity),
            shown(self.lost, self.quantity),
            format!("{:.1e}", self.residual()),
        ]
    }
}

/// The outputs of a body whose sum is its heat balance.
pub struct BalanceOutputs {
    body: String,
    /// Heat supplied, stored and lost.
    outputs: [Output; 3],
    /// Heat given to the body below, which is lost, too; `None` for bodies that have no such output.
    given: Option<Output>,
    expected: f64,
    quantity: Quantity,
    /// Heat below which all are rounding [J].
    rounding: f64,
}

impl BalanceOutputs {
    /// Balance outputs of each body of a scene that has all three.
    pub fn of(scene: &Scene) -> Vec<Self> {
        let registry = Registry::structured(scene);
        let of_body = |body: &String| {
            let output = |key: &str| {
                let place = registry.find(&format!("{body}.{key}"))?;
                let Slot::Output(output) = &registry.variables[place].slot else { return None };
                Some(output.clone())
            };
            let outputs = [output("heat_in")?, output("heat_stored")?, output("heat_lost")?];
            let given = output("heat");
            let expected = expected_residual(scene, body);
            let heat_in = registry.find(&format!("{body}.heat_in"))?;
            let quantity = registry.variables[heat_in].quantity?;
            let capacity = scene.body[body].heat_capacity().unwrap_or(0.0);
            let rounding = ROUNDING * capacity;
            Some(Self { body: body.clone(), outputs, given, expected, quantity, rounding })
        };
        scene.body.keys().filter_map(of_body).collect()
    }

    /// The balance at `state`.
    pub fn read(
        &self,
        model: &Model,
        state: &State,
        cache: &mut Cache,
    ) -> Result<Balance, ModelError> {
        let [heat_in, stored, lost] =
            self.outputs.each_ref().map(|output| model.output(state, cache, output));
        let given = self.given.as_ref().map(|given| model.output(state, cache, given));
        let (heat_in, stored, lost) =
            (heat_in?, stored?, lost? + given.transpose()?.unwrap_or(0.0));
        let largest =
            [heat_in, stored, lost].into_iter().map(f64::abs).fold(self.rounding, f64::max);
        let Self { expected, quantity, .. } = *self;
        Ok(Balance { body: self.body.clone(), heat_in, stored, lost, largest, expected, quantity })
    }
}

/// Largest acceptable relative residual of the heat balance of a body.
pub fn expected_residual(scene: &Scene, body: &str) -> f64 {
    let by_particles = scene.solid(body).is_some_and(|solid| solid.sph().is_some());
    if by_particles { BALANCED_BY_PARTICLES } else { BALANCED }
}

/// Formats the balances as a table.
pub fn balance_table(balances: &[Balance]) -> String {
    let rows: Vec<_> = balances.iter().map(Balance::row).collect();
    table(["body", "heat in", "stored", "lost", "residual"], &rows)
}

/// Formats the totals at `state` that [`Ranges`](super::ranges::Ranges) does not follow as a table: those of droplets
/// and reservoirs, and some of solids.
pub fn totals_table(model: &Model, state: &State, cache: &mut Cache) -> Result<String, ModelError> {
    let mut rows = Vec::new();
    let registry = Registry::structured(model.scene());
    let named = Registry::of(model.scene()).variables;
    for (variable, named) in registry.variables.iter().zip(named) {
        let Slot::Output(output) = &variable.slot else { continue };
        let Some(quantity) = variable.quantity else { continue };
        let is_total = matches!(output.reading, Reading::Total(_));
        let body = model.scene().body.keys().nth(output.body);
        let scene = model.scene();
        let is_shown = body.is_none_or(|name| {
            let is_listed = || OF_SOLIDS.iter().any(|key| variable.name.ends_with(key));
            !is_loaded(scene, name) && (scene.solid(name).is_none() || is_listed())
        });
        if is_total && is_shown {
            let value = model.output(state, cache, output)?;
            let value = match variable.name.split_once(FIRST_CRACK) {
                Some((body, _)) if !has_cracked((model, state, cache), &registry, body)? => {
                    "no crack".into()
                }
                _ => shown(value, quantity),
            };
            rows.push([named.name, value]);
        }
    }
    Ok(table(["at the end", "value"], &rows))
}

/// Returns true if a body that cracks has done so.
fn has_cracked(
    (model, state, cache): (&Model, &State, &mut Cache),
    registry: &Registry,
    body: &str,
) -> Result<bool, ModelError> {
    let time = registry.find(&format!("{body}{FIRST_CRACK}time"));
    match time.map(|place| &registry.variables[place].slot) {
        Some(Slot::Output(output)) => Ok(model.output(state, cache, output)? > 0.0),
        _ => Ok(false),
    }
}

/// Formats the running maxima at `state` as a table, each with its time and position; empty if none are kept.
pub fn peaks_table(model: &Model, state: &State, cache: &mut Cache) -> Result<String, ModelError> {
    let mut rows = Vec::new();
    for Variable { name, slot, quantity, .. } in Registry::of(model.scene()).variables {
        let (Slot::Output(output), Some(quantity)) = (slot, quantity) else { continue };
        let Reading::Peak { which, part: PeakPart::Value } = output.reading else { continue };
        let mut part = |part| {
            let output = Output { body: output.body, reading: Reading::Peak { which, part } };
            model.output(state, cache, &output)
        };
        let value = shown(part(PeakPart::Value)?, quantity);
        let time = engineering(part(PeakPart::Time)?, "s");
        let [x, y, z] = [0, 1, 2].map(|axis| part(PeakPart::Along(axis)));
        let at = [x?, y?, z?].map(|length| engineering(length, "m")).join(", ");
        rows.push([name, value, time, at]);
    }
    match rows.is_empty() {
        true => Ok(String::new()),
        false => Ok(table(["highest so far", "value", "at", "x, y, z"], &rows)),
    }
}

pub fn shown(value: f64, quantity: Quantity) -> String {
    match quantity {
        Quantity::Temperature => kelvin(value),
        Quantity::Count => format!("{value}"),
        Quantity::Ratio => five_digits(value),
        quantity => engineering(value, quantity.unit()),
    }
}

/// A number without a unit to five digits.
fn five_digits(value: f64) -> String {
    match format!("{value:.4e}").parse() {
        Ok(rounded) => decimal(rounded),
        Err(_) => value.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn balance(heat_in: f64, stored: f64, lost: f64) -> Balance {
        let largest = [heat_in, stored, lost].into_iter().map(f64::abs).fold(0.0, f64::max);
        Balance {
            body: "plate".into(),
            heat_in,
            stored,
            lost,
            largest,
            expected: BALANCED,
            quantity: Quantity::Energy,
        }
    }

    #[test]
    fn heat_that_adds_up_passes_without_warning() {
        assert_eq!(balance(3.0, 2.0, 1.0).warning(), None);
        assert_eq!(balance(0.0, 0.0, 0.0).warning(), None);
        assert_eq!(balance(1.0, 1.0 + 1e-10, 0.0).warning(), None);
    }

    #[test]
    fn missing_heat_is_reported_against_the_largest_amount() {
        assert_eq!(balance(1.0, -4.0, 4.5).residual(), 0.5 / 4.5);
        assert!(balance(1.0, 0.9, 0.0).warning().unwrap().to_string().contains("plate"));
        assert!(balance(f64::NAN, 1.0, 0.0).warning().is_some());
    }
}
