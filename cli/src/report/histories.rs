//! Variables over time: single ones as curves, arrays on rings, tiles and grids as maps.

use impinge::scene::Scene;
use impinge::variables::{
    ArrayRegistry, ArrayVariable, CellFamily, Content, Quantity, Registry, Slot, Variable,
};

use super::document::{Axis, Cell, Column, Histories, Layout, Map, Series, Table, Values};
use super::fields::thinned;
use super::outputs::{Outputs, extent};
use super::packed::Array;

/// Most numbers of all curves together, and fewest rows.
const MOST_NUMBERS: usize = 50_000;
const FEWEST_ROWS: usize = 200;
/// Most values of all arrays together, most times of a profile, and most of a map of cells.
const MOST_OF_ARRAYS: usize = 200_000;
const PROFILE_TIMES: usize = 200;
const CELL_TIMES: usize = 30;

/// A single variable of a run.
pub struct Scalar<'r> {
    pub variable: &'r Variable,
    pub unit: &'static str,
    pub values: &'r [f64],
}

/// Inputs that change and all outputs of a run, without arrays.
pub fn scalars<'r>(
    registry: &'r Registry,
    arrays: &ArrayRegistry,
    outputs: &'r Outputs,
) -> Vec<Scalar<'r>> {
    let single = arrays.variables.iter().filter(|array| array.dimensions.is_empty());
    let variables = single.flat_map(|array| array.elements(registry));
    let scalar = |variable: &'r Variable| {
        let values = outputs.values(&variable.name)?;
        let unit = variable.quantity.map_or("1", Quantity::unit);
        let is_shown = match variable.slot {
            Slot::Output(_) => true,
            Slot::Input(_) => values.iter().any(|value| *value != values[0]),
            _ => false,
        };
        is_shown.then_some(Scalar { variable, unit, values })
    };
    variables.filter_map(scalar).collect()
}

/// Curves of variables that change.
pub fn histories(scalars: &[Scalar], outputs: &Outputs) -> Histories {
    let changing: Vec<_> = scalars
        .iter()
        .filter(|one| extent(one.values).is_some_and(|[low, high]| low < high))
        .collect();
    let most = (MOST_NUMBERS / (changing.len() + 1)).max(FEWEST_ROWS);
    let rows = thinned(outputs.times.len(), most);
    let kept = |values: &[f64]| Array::rounded(rows.iter().map(|&row| values[row]));
    let series = changing.iter().map(|one| Series {
        name: one.variable.name.clone(),
        unit: one.unit.to_owned(),
        group: group(one.variable.quantity).to_owned(),
        about: one.variable.description.clone(),
        values: kept(one.values),
    });
    let mut notes = Vec::new();
    if rows.len() < outputs.times.len() {
        notes.push(format!("{} of {} rows are drawn.", rows.len(), outputs.times.len()));
    }
    let constant = scalars.len() - changing.len();
    match constant {
        0 => {}
        1 => notes.push("One variable that does not change stands in the table alone.".to_owned()),
        count => {
            notes.push(format!("{count} variables that do not change stand in the table alone."))
        }
    }
    let axis =
        Axis { name: "time".into(), unit: "s".into(), values: kept(&outputs.times), ends: None };
    Histories { axis, note: notes.join(" "), series: series.collect() }
}

/// Ranges of variables over a run, and their last values.
pub fn ranges(scalars: &[Scalar]) -> Table {
    let names = ["variable", "lowest", "highest", "at the end", "meaning"];
    let head = names.map(|name| Column { name: name.to_owned(), unit: String::new() });
    let row = |one: &Scalar| {
        let [low, high] = extent(one.values).unwrap_or([f64::NAN; 2]);
        let last = one.values.last().copied().unwrap_or(f64::NAN);
        vec![
            Cell::Text(one.variable.name.clone()),
            Cell::quantity(low, one.unit),
            Cell::quantity(high, one.unit),
            Cell::quantity(last, one.unit),
            Cell::Text(one.variable.description.clone()),
        ]
    };
    let rows = scalars.iter().map(row).collect();
    Table { title: String::new(), head: head.into(), rows }
}

/// Title of the chart of a quantity.
pub fn group(quantity: Option<Quantity>) -> &'static str {
    match quantity {
        Some(Quantity::Temperature | Quantity::TemperatureDifference) => "Temperature",
        Some(Quantity::Stress | Quantity::Modulus) => "Stress and pressure",
        Some(Quantity::HeatFlux) => "Heat flux",
        Some(Quantity::HeatFlow | Quantity::HeatFlowPerLength) => "Heat flow",
        Some(Quantity::Energy | Quantity::EnergyPerLength) => "Heat and energy",
        Some(Quantity::Displacement) => "Displacement",
        Some(Quantity::Length) => "Length",
        Some(Quantity::Velocity) => "Speed",
        Some(Quantity::Momentum | Quantity::MomentumPerLength) => "Momentum and impulse",
        Some(Quantity::Force | Quantity::ForcePerLength) => "Force",
        Some(Quantity::Mass | Quantity::MassPerLength) => "Mass",
        Some(Quantity::Density) => "Density",
        Some(Quantity::Volume) => "Volume",
        Some(Quantity::Ratio) => "Shares",
        None | Some(Quantity::Count) => "Counts",
        Some(_) => "Other quantities",
    }
}

/// Arrays over time of those families of cells that are shown: those on rings as profiles, those on tiles and grids as
/// maps of cells.
pub fn arrays(
    scene: &Scene,
    outputs: &Outputs,
    is_shown: impl Fn(&CellFamily) -> bool,
) -> Vec<Map> {
    let (registry, arrays) = (Registry::of(scene), ArrayRegistry::of(scene));
    let structured = ArrayRegistry::structured(scene);
    let families = CellFamily::all(scene);
    let found: Vec<_> = arrays
        .variables
        .iter()
        .zip(&structured.variables)
        .filter(|(array, _)| {
            !array.dimensions.is_empty() && matches!(array.content, Content::Elements(_))
        })
        .filter_map(|(array, structured)| {
            let family = family(structured, &families)?;
            Some((array, columns(array, &registry, outputs)?, family))
        })
        .collect();
    let most = MOST_OF_ARRAYS / found.len().max(1);
    found
        .iter()
        .filter(|(_, _, family)| is_shown(family))
        .filter_map(|(array, columns, family)| {
            let unit = array.quantity(&registry).map_or("1", Quantity::unit);
            map(array, unit, columns, family, &outputs.times, most)
        })
        .collect()
}

/// Columns of the elements of an array, if any of them changes.
fn columns<'o>(
    array: &ArrayVariable,
    registry: &Registry,
    outputs: &'o Outputs,
) -> Option<Vec<&'o [f64]>> {
    let columns: Option<Vec<_>> =
        array.elements(registry).iter().map(|element| outputs.values(&element.name)).collect();
    columns.filter(|columns| {
        let first = columns.first().and_then(|column| column.first());
        columns.iter().any(|column| column.iter().any(|value| Some(value) != first))
    })
}

/// The cells of an array with a structured name, which begins with that of its family.
fn family<'f>(array: &ArrayVariable, families: &'f [CellFamily]) -> Option<&'f CellFamily> {
    let (owner, _) = array.name.split_once('.')?;
    families.iter().find(|family| family.name == owner && family.count == array.dimensions)
}

fn map(
    array: &ArrayVariable,
    unit: &str,
    columns: &[&[f64]],
    cells: &CellFamily,
    times: &[f64],
    most: usize,
) -> Option<Map> {
    let axis = |name: &str, unit: &str, values: &[f64], ends: Option<[f64; 2]>| Axis {
        name: name.to_owned(),
        unit: unit.to_owned(),
        values: Array::rounded(values.iter().copied()),
        ends,
    };
    let values = |values: Vec<f64>| {
        vec![Values {
            name: array.name.clone(),
            unit: unit.to_owned(),
            values: Array::packed(&values),
        }]
    };
    let (title, marks, focus) =
        (format!("{}: {}", array.name, array.description), Vec::new(), None);
    if let [count] = array.dimensions[..] {
        let radii: Vec<f64> = match (&cells.inner[..], &cells.outer[..]) {
            (inner, outer) if inner.len() == count => {
                inner.iter().zip(outer).map(|(inner, outer)| 0.5 * (inner + outer)).collect()
            }
            _ => return None,
        };
        let rows = thinned(times.len(), PROFILE_TIMES.min(most / count.max(1)));
        let kept: Vec<f64> = rows.iter().map(|&row| times[row]).collect();
        let ends = [cells.inner.first().copied()?, cells.outer.last().copied()?];
        let of_rows = columns.iter().flat_map(|column| rows.iter().map(|&row| column[row]));
        return Some(Map {
            title,
            marks,
            focus,
            layout: Layout::Profile,
            is_cells: true,
            axes: [axis("time", "s", &kept, None), axis("r", "m", &radii, Some(ends))],
            times: Vec::new(),
            fields: values(of_rows.collect()),
        });
    }
    let [first, second] = array.dimensions[..] else { return None };
    let (names, along) = axes_of(cells, [first, second])?;
    let rows = thinned(times.len(), CELL_TIMES.min(most / (first * second).max(1)));
    // The first index runs along the first axis, and the last index fastest in a family.
    let of_row =
        |row: usize| (0..second).flat_map(move |j| (0..first).map(move |i| (row, i * second + j)));
    let kept = rows.iter().flat_map(|&row| of_row(row)).map(|(row, element)| columns[element][row]);
    Some(Map {
        title,
        marks,
        focus,
        layout: Layout::Grid,
        is_cells: true,
        axes: [axis(names[0], "m", &along[0], None), axis(names[1], "m", &along[1], None)],
        times: rows.iter().map(|&row| times[row]).collect(),
        fields: values(kept.collect()),
    })
}

/// The two axes of tiles or of a grid, with the middles of cells along them.
fn axes_of(
    cells: &CellFamily,
    [first, second]: [usize; 2],
) -> Option<([&'static str; 2], [Vec<f64>; 2])> {
    let all = [("x", &cells.x), ("y", &cells.y), ("z", &cells.z)];
    let along = |stride: usize, count: usize| {
        all.iter().find_map(|(name, values)| {
            let line: Vec<f64> =
                (0..count).filter_map(|i| values.get(i * stride).copied()).collect();
            let is_line = line.len() == count && line.windows(2).all(|two| two[0] < two[1]);
            (is_line && (count > 1 || *name == "y")).then_some((*name, line))
        })
    };
    let (across, up) = (along(second, first)?, along(1, second)?);
    Some(([across.0, up.0], [across.1, up.1]))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = r#"
name = "Rings"
stop_time = 1.0
step = 1.0
[body.plate]
kind = "solid"
shape = { disc = { radius = 1.0, thickness = 0.5 } }
material = { model = "thermoelastic", density = 2.0, specific_heat = 3.0, conductivity = 5.0 }
initial_temperature = 300.0
mesh = { spacing = 0.25 }
[[load]]
name = "spot"
on = "plate.top"
footprint = { rings = { count = 2, radius = 0.25 } }
carries = ["heat_flux"]
[[load]]
name = "spot_wide"
on = "plate.top"
footprint = { rings = { count = 2, radius = 1.0 } }
carries = ["heat_flux"]
"#;

    /// A table in which all elements of both loads change.
    fn table(registry: &Registry) -> Outputs {
        let names = registry.variables.iter().map(|variable| variable.name.as_str());
        let names: Vec<_> = names.filter(|name| name.contains("heat_flux")).collect();
        let row = |value: &str| format!("{value}{}\n", format!(",{value}").repeat(names.len()));
        let head: String = names.iter().map(|name| format!(",{name} [W/m2]")).collect();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        std::fs::write(&path, format!("time [s]{head}\n{}{}", row("0.0"), row("1.0"))).unwrap();
        Outputs::read(&path).unwrap()
    }

    /// The name of one family begins with that of the other, which flat names exclude.
    #[test]
    fn arrays_belong_to_the_family_of_their_whole_name() {
        let scene = impinge::scene::parse(SCENE, "scene.toml");
        let scene = scene.unwrap_or_else(|error| panic!("{error}"));
        let outputs = table(&Registry::of(&scene));
        let maps = arrays(&scene, &outputs, |_| true);
        let radii: Vec<_> = maps.iter().map(|map| map.axes[1].ends).collect();
        assert_eq!(radii, [Some([0.0, 0.25]), Some([0.0, 1.0])]);
        let shown = arrays(&scene, &outputs, |family| family.name != "spot");
        let radii: Vec<_> = shown.iter().map(|map| map.axes[1].ends).collect();
        assert_eq!(radii, [Some([0.0, 1.0])]);
    }
}
