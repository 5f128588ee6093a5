//! The GUID, compared with that of the library.
//!
//! For our own units the GUID follows from the scene that they carry. For any other unit the library decides: it must
//! accept instantiation with the GUID of the XML, and should refuse another one. The library is loaded in a separate
//! process, so that its crashes have no effect here.

use impinge::fmi::guid::guid;
use impinge::scene;
use impinge::variables::Registry;

use super::{Check, Rule};
use crate::Subject;
use crate::description::Interface;
use crate::finding::{Place, Report};
use crate::platform;
use crate::probe::{self, Outcome};

pub static RULE: Rule = Rule {
    name: "guid",
    section: "2.1.5",
    says: "the library can be instantiated with the guid of the XML, and with no other",
    check: Check::Unit(check),
};

/// The scene that a unit of ours carries.
const SCENE: &str = "resources/scene.toml";
/// A GUID that no unit has.
const FOREIGN: &str = "{00000000-0000-0000-0000-000000000000}";

fn check(subject: &Subject, report: &mut Report) {
    if differs_from_scene(subject, report) || !subject.may_run {
        return;
    }
    let is_true = |value: Option<&str>| matches!(value, Some("true" | "1"));
    for interface in &subject.description.interfaces {
        // Such a library starts another program, which a check of a file must not do.
        if !is_true(interface.node.attribute("needsExecutionTool")) {
            ask_library(subject, interface, report);
        }
    }
}

/// Reports a GUID that differs from that of the scene, in units made by this version.
fn differs_from_scene(subject: &Subject, report: &mut Report) -> bool {
    let root = subject.description.root;
    let ours = concat!("impinge ", env!("CARGO_PKG_VERSION"));
    if root.attribute("generationTool") != Some(ours) || !subject.package.has(SCENE) {
        return false;
    }
    let Ok(text) = subject.package.text(SCENE) else { return false };
    let Ok(scene) = scene::parse(&text, SCENE) else { return false };
    let expected = guid(&text, &Registry::of(&scene));
    let differs = subject.description.guid != expected;
    if differs {
        let wrong = format!("guid {:?} is not that of {SCENE}", subject.description.guid);
        report.error(subject.document.place_of(root, "guid"), wrong, expected);
    }
    differs
}

fn ask_library(subject: &Subject, interface: &Interface, report: &mut Report) {
    let Some(here) = platform::here() else { return };
    let path = format!("binaries/{}/{}{}", here.folder, interface.identifier, here.ending);
    if !subject.package.has(&path) {
        return;
    }
    let guid = subject.description.guid;
    let ask = |guid| probe::ask(subject.package, &path, guid, interface.is_co_simulation);
    let place = || subject.document.place_of(subject.description.root, "guid");
    match ask(guid) {
        Outcome::Made => {
            if matches!(ask(FOREIGN), Outcome::Made) {
                let wrong = format!("the library accepts any GUID, such as {FOREIGN}");
                report.warning(Place::file(&path), wrong, RULE.says);
            }
        }
        Outcome::Refused(log) => {
            let wrong = format!("the library refuses to be instantiated with guid {guid:?}: {log}");
            report.error(place(), wrong, RULE.says);
        }
        Outcome::Unloadable(reason) => {
            let wrong = format!(
                "the library cannot be loaded here, so its GUID cannot be compared: {reason}"
            );
            report.warning(Place::file(&path), wrong, RULE.says);
        }
        Outcome::Lost(how) => {
            report.error(Place::file(&path), format!("instantiation {how}"), RULE.says);
        }
    }
}
