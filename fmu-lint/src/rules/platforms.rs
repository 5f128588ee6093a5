//! Missing libraries.

use super::{Check, Rule};
use crate::Subject;
use crate::finding::{Place, Report};
use crate::platform::PLATFORMS;

pub static RULE: Rule = Rule {
    name: "platforms",
    section: "2.3",
    says: "a unit has a library in each of its folders binaries/win32, win64, linux32, linux64, \
           darwin32, darwin64, or source files",
    check: Check::Unit(check),
};

fn check(subject: &Subject, report: &mut Report) {
    let folders = subject.package.names_in("binaries/");
    for name in &folders {
        let place = || Place::file(&format!("binaries/{name}"));
        let Some(folder) = name.strip_suffix('/') else {
            report.warning(place(), "a file beside the folders of platforms", RULE.says);
            continue;
        };
        match PLATFORMS.iter().find(|platform| platform.folder == folder) {
            None => report.warning(place(), "no platform that the standard names", RULE.says),
            Some(platform) => {
                let files = subject.package.names_in(&format!("binaries/{name}"));
                if !files.iter().any(|file| file.ends_with(platform.ending)) {
                    let wrong = "the library is missing";
                    report.error(place(), wrong, format!("a file *{}", platform.ending));
                }
            }
        }
    }
    if folders.is_empty() && subject.package.names_in("sources/").is_empty() {
        report.error(Place::unit(), "neither a library nor source files", RULE.says);
    }
}
