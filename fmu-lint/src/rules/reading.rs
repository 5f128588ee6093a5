//! Requirements that must hold before any other check.

use super::{Check, Rule};
use crate::DESCRIPTION;
use crate::document::Document;
use crate::finding::{Place, Report};

pub static READABLE: Rule = Rule {
    name: "zip-readable",
    section: "2.3",
    says: "a unit is a zip file, every entry of which can be read and has its checksum",
    check: Check::Reading,
};

pub static WELL_FORMED: Rule = Rule {
    name: "well-formed",
    section: "2.2",
    says: "modelDescription.xml is at the root of the zip file, is well-formed XML and UTF-8",
    check: Check::Reading,
};

pub static VERSION: Rule = Rule {
    name: "fmi-version",
    section: "2.2.1",
    says: "the root element is fmiModelDescription with fmiVersion=\"2.0\"",
    check: Check::Reading,
};

/// Warns of a description that declares another encoding than UTF-8, though it could be read as UTF-8.
pub fn check_encoding(text: &str, report: &mut Report) {
    let declaration = text.split("?>").next().filter(|text| text.contains("<?xml"));
    let Some((_, rest)) = declaration.and_then(|text| text.split_once("encoding")) else { return };
    let name = rest.split(['"', '\'']).nth(1).unwrap_or_default();
    if !name.eq_ignore_ascii_case("utf-8") {
        let place = Place { line: Some(1), ..Place::file(DESCRIPTION) };
        report.warning(place, format!("the encoding is said to be {name:?}"), "UTF-8");
    }
}

/// Returns true if the description is of FMI 2.0. Units of other versions may be valid by rules that are not
/// implemented here.
pub fn of_this_version(document: &Document, report: &mut Report) -> bool {
    let root = document.root();
    if root.tag_name().name() != "fmiModelDescription" {
        let wrong = format!("the root element is {}", root.tag_name().name());
        report.error(document.place(root), wrong, VERSION.says);
        return false;
    }
    match root.attribute("fmiVersion") {
        Some("2.0") => true,
        Some(version) if ["1.", "3."].iter().any(|major| version.starts_with(major)) => {
            let wrong = format!(
                "a unit of FMI {version}: only its zip file has been checked, and that \
                 {DESCRIPTION} is well-formed"
            );
            let allowed = "the rules known here are those of FMI 2.0";
            report.warning(document.place_of(root, "fmiVersion"), wrong, allowed);
            false
        }
        Some(version) => {
            let place = document.place_of(root, "fmiVersion");
            report.error(place, format!("fmiVersion is {version:?}"), VERSION.says);
            false
        }
        None => {
            let place: Place = document.place(root);
            report.error(place, "fmiVersion is missing", VERSION.says);
            false
        }
    }
}
