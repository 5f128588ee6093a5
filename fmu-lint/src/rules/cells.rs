//! `resources/cells.json`, with the positions of cells in units of this program.

use serde_json::Value;

use super::{Check, Rule};
use crate::DESCRIPTION;
use crate::finding::{Place, Report};
use crate::package::Package;

pub static RULE: Rule = Rule {
    name: "cells",
    section: "2.3",
    says: "resources/cells.json, if there is one, lists families of cells with whole counts and a finite number for each \
           cell",
    check: Check::Package(check),
};

const FILE: &str = "resources/cells.json";
/// Keys with a number for each cell.
const PER_CELL: [&str; 6] = ["area", "inner", "outer", "x", "y", "z"];

/// Other tools may use a file of that name for their own purposes.
fn check(package: &Package, report: &mut Report) {
    if !package.has(FILE) {
        return;
    }
    let Ok(bytes) = package.bytes(FILE) else { return };
    let is_own =
        package.text(DESCRIPTION).is_ok_and(|text| text.contains("generationTool=\"impinge"));
    for (element, wrong) in faults(&bytes) {
        let place = Place { element, ..Place::file(FILE) };
        if is_own {
            report.error(place, wrong, RULE.says);
        } else {
            report.warning(place, wrong, RULE.says);
        }
    }
}

/// Families and their faults.
fn faults(bytes: &[u8]) -> Vec<(String, String)> {
    let told: Value = match serde_json::from_slice(bytes) {
        Ok(told) => told,
        Err(error) => return vec![(String::new(), format!("no JSON: {error}"))],
    };
    let Some(families) = told.get("families").and_then(Value::as_object) else {
        return vec![(String::new(), "no table families".to_owned())];
    };
    let faulty = |(name, family): (&String, &Value)| Some((name.clone(), fault(family)?));
    families.iter().filter_map(faulty).collect()
}

/// The first fault of a family.
fn fault(family: &Value) -> Option<String> {
    let Some(family) = family.as_object() else { return Some("no table".to_owned()) };
    if !family.get("footprint").is_some_and(Value::is_string) {
        return Some("no footprint".to_owned());
    }
    let mut cells = None;
    if let Some(count) = family.get("count") {
        let Some(product) = product(count) else {
            return Some(format!(
                "count is {}, none of [], [n] and [n, m] with whole numbers above 0",
                shown(count)
            ));
        };
        cells = Some(product);
    }
    for key in PER_CELL {
        let Some(values) = family.get(key) else { continue };
        let Some(values) = numbers(values) else {
            return Some(format!("{key} is no list of numbers"));
        };
        if *cells.get_or_insert(values.len()) != values.len() {
            return Some(format!("{key} has {} values for another number of cells", values.len()));
        }
        if key == "area" && values.iter().any(|&area| area < 0.0) {
            return Some("area has a value below 0 m2".to_owned());
        }
    }
    let pair = |key: &str| family.get(key).map(|value| numbers(value).filter(|two| two.len() == 2));
    if pair("at") == Some(None) {
        return Some("at is no place [x, y]".to_owned());
    }
    let is_no_size = |size: Option<Vec<f64>>| size.is_none_or(|two| two.iter().any(|&x| x <= 0.0));
    pair("size").is_some_and(is_no_size).then(|| "size is no pair of lengths above 0 m".to_owned())
}

/// Number of cells.
fn product(count: &Value) -> Option<usize> {
    let list = count.as_array().filter(|list| list.len() <= 2)?;
    list.iter().try_fold(1_usize, |product, one| {
        let one = one.as_u64().filter(|one| (1..1 << 31).contains(one))?;
        product.checked_mul(usize::try_from(one).ok()?)
    })
}

fn numbers(list: &Value) -> Option<Vec<f64>> {
    list.as_array()?.iter().map(Value::as_f64).collect()
}

/// The beginning of a value.
fn shown(value: &Value) -> String {
    value.to_string().chars().take(40).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn families_of_each_footprint_are_right_and_absurd_ones_are_found() {
        let family = |more: &str| format!("{{\"families\": {{\"a\": {{{more}}}}}}}");
        let rings =
            "\"footprint\": \"rings\", \"count\": [2], \"area\": [1.0, 2.0], \"outer\": [1, 2]";
        let disc = "\"footprint\": \"disc\", \"count\": [], \"area\": [1.0], \"at\": [0, 0.5]";
        let tiles =
            "\"footprint\": \"tiles\", \"count\": [1, 2], \"x\": [0, 1], \"size\": [1, 2.5]";
        for right in [rings, disc, tiles] {
            assert_eq!(faults(family(right).as_bytes()), [], "{right}");
        }
        for (wrong, part) in [
            ("\"footprint\": 3".to_owned(), "no footprint"),
            (rings.replace("[2]", "[1000000000000]"), "count is [1000000000000]"),
            (rings.replace("[2]", "[-2]"), "count is [-2]"),
            (rings.replace("[2]", "[3]"), "area has 2 values"),
            (rings.replace("2.0", "-2.0"), "below 0 m2"),
            (rings.replace("2.0", "\"2\""), "area is no list of numbers"),
            (rings.replace("2.0", "1e999"), "no JSON: number out of range"),
            (disc.replace("0.5", "null"), "at is no place"),
            (tiles.replace("2.5", "0"), "size is no pair"),
        ] {
            let found = faults(family(&wrong).as_bytes());
            assert!(found.len() == 1 && found[0].1.contains(part), "{wrong}: {found:?}");
        }
        for (text, part) in
            [("[]", "no table families"), ("", "no JSON"), ("{\"families\": 1}", "no table")]
        {
            assert!(faults(text.as_bytes())[0].1.contains(part), "{text}");
        }
        assert!(faults("[".repeat(100_000).as_bytes())[0].1.contains("recursion limit"));
    }
}
