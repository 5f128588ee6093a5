//! Functions that the libraries must export.

use super::{Check, Rule};
use crate::Subject;
use crate::description::Interface;
use crate::finding::{Place, Report};
use crate::library;
use crate::platform::{PLATFORMS, Platform};

pub static RULE: Rule = Rule {
    name: "exports",
    section: "4.2",
    says: "a library is of the platform of its folder and exports the functions of its interface: \
           those of the capabilities that it declares, and the others, which answer fmi2Error",
    check: Check::Unit(check),
};

/// Functions of both interfaces, sections 2.1.2 to 2.1.7.
const COMMON: &[&str] = &[
    "fmi2GetTypesPlatform",
    "fmi2GetVersion",
    "fmi2SetDebugLogging",
    "fmi2Instantiate",
    "fmi2FreeInstance",
    "fmi2SetupExperiment",
    "fmi2EnterInitializationMode",
    "fmi2ExitInitializationMode",
    "fmi2Terminate",
    "fmi2Reset",
    "fmi2GetReal",
    "fmi2GetInteger",
    "fmi2GetBoolean",
    "fmi2GetString",
    "fmi2SetReal",
    "fmi2SetInteger",
    "fmi2SetBoolean",
    "fmi2SetString",
];

/// Functions of co-simulation, section 4.2.
const CO_SIMULATION: &[&str] = &[
    "fmi2DoStep",
    "fmi2CancelStep",
    "fmi2GetStatus",
    "fmi2GetRealStatus",
    "fmi2GetIntegerStatus",
    "fmi2GetBooleanStatus",
    "fmi2GetStringStatus",
];

/// Functions of model exchange, section 3.2.
const MODEL_EXCHANGE: &[&str] = &[
    "fmi2EnterEventMode",
    "fmi2NewDiscreteStates",
    "fmi2EnterContinuousTimeMode",
    "fmi2CompletedIntegratorStep",
    "fmi2SetTime",
    "fmi2SetContinuousStates",
    "fmi2GetDerivatives",
    "fmi2GetEventIndicators",
    "fmi2GetContinuousStates",
    "fmi2GetNominalsOfContinuousStates",
];

/// Functions of optional capabilities, with the attribute that declares each.
const OPTIONAL: &[(&str, &[&str])] = &[
    ("canGetAndSetFMUstate", &["fmi2GetFMUstate", "fmi2SetFMUstate", "fmi2FreeFMUstate"]),
    (
        "canSerializeFMUstate",
        &["fmi2SerializedFMUstateSize", "fmi2SerializeFMUstate", "fmi2DeSerializeFMUstate"],
    ),
    ("providesDirectionalDerivative", &["fmi2GetDirectionalDerivative"]),
];

/// The same for those of co-simulation.
const OPTIONAL_IN_CO_SIMULATION: &[(&str, &[&str])] = &[
    ("canInterpolateInputs", &["fmi2SetRealInputDerivatives"]),
    ("maxOutputDerivativeOrder", &["fmi2GetRealOutputDerivatives"]),
];

fn check(subject: &Subject, report: &mut Report) {
    for interface in &subject.description.interfaces {
        for platform in &PLATFORMS {
            let Platform { folder, ending, .. } = platform;
            let path = format!("binaries/{folder}/{}{ending}", interface.identifier);
            if subject.package.has(&path) {
                check_library(subject, interface, platform, &path, report);
            }
        }
    }
}

fn check_library(
    subject: &Subject,
    interface: &Interface,
    platform: &Platform,
    path: &str,
    report: &mut Report,
) {
    let place = || Place::file(path);
    let bytes = match subject.package.bytes(path) {
        Ok(bytes) => bytes,
        Err(fault) => return report.error(fault.place, fault.wrong, RULE.says),
    };
    let libraries = match library::read(&bytes) {
        Ok(libraries) => libraries,
        Err(error) => return report.error(place(), format!("no library: {error}"), RULE.says),
    };
    let fits = |library: &&library::Library| {
        library.format == platform.format && library.architecture == platform.architecture
    };
    let Some(library) = libraries.iter().find(fits) else {
        let found: Vec<String> = libraries
            .iter()
            .map(|library| format!("{:?} for {:?}", library.format, library.architecture))
            .collect();
        let allowed = format!("{:?} for {:?}", platform.format, platform.architecture);
        return report.error(place(), format!("a library of {}", found.join(", ")), allowed);
    };
    let lacks = |name: &&str| !library.symbols.contains(*name);
    let (needed, unused) = functions(interface);
    let missing =
        |names: Vec<&'static str>| names.into_iter().filter(lacks).collect::<Vec<_>>().join(", ");
    let (needed, unused) = (missing(needed), missing(unused));
    if !needed.is_empty() {
        report.error(place(), format!("does not export {needed}"), RULE.says);
    }
    if !unused.is_empty() {
        let wrong = format!("does not export {unused}, whose capabilities it does not declare");
        report.warning(place(), wrong, RULE.says);
    }
}

/// The functions that an interface needs, and those of capabilities that it does not have.
fn functions(interface: &Interface) -> (Vec<&'static str>, Vec<&'static str>) {
    let (own, more) = match interface.is_co_simulation {
        true => (CO_SIMULATION, OPTIONAL_IN_CO_SIMULATION),
        false => (MODEL_EXCHANGE, &[][..]),
    };
    let declared = |flag: &str| {
        interface.node.attribute(flag).is_some_and(|value| !["false", "0"].contains(&value.trim()))
    };
    let (mut needed, mut unused) = ([COMMON, own].concat(), Vec::new());
    for (flag, names) in OPTIONAL.iter().chain(more) {
        if declared(flag) { &mut needed } else { &mut unused }.extend(*names);
    }
    (needed, unused)
}
