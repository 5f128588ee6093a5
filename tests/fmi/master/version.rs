//! What both versions of the standard have, spelt in two ways.

use std::ffi::c_int;

use super::unit::Unit;
use super::{Folder, Handle, Messages, OK, call, three, two};
use crate::functions::{self, Group};

/// A version of the standard.
pub trait Version: Sized + 'static {
    /// Beginning of the names of functions.
    const PREFIX: &'static str;
    /// Names of the types of numbers.
    const REAL: &'static str;
    const INTEGER: &'static str;
    /// Name of arguments that are value references, and of those that are values.
    const REFERENCES: &'static str;
    const VALUES: &'static str;
    /// The function that takes start and stop time.
    const EXPERIMENT: &'static str;
    /// The functions that act on an instance, all but that which frees it.
    const FUNCTIONS: &'static [Group<Self>];
    /// The functions beside these.
    const OTHERS: &'static [&'static str];

    /// Name in C of a function, from its name in FMI 3.0 without prefix.
    fn name(function: &str) -> String {
        format!("{}{function}", Self::PREFIX)
    }

    /// An instance of the unit in a folder, made with good arguments.
    fn instantiate(folder: &Folder, guid: &str, messages: &Messages) -> Handle;

    /// Reference of a variable.
    fn find(unit: &Unit<Self>, name: &str) -> Option<usize>;

    /// Number of variables.
    fn count(unit: &Unit<Self>) -> usize;

    /// Number of values of these variables.
    fn size(unit: &Unit<Self>, references: &[u32]) -> usize;

    /// Sets the times of the experiment and begins the initialization.
    fn begin(unit: &Unit<Self>, start: f64, stop: Option<f64>) -> c_int;

    /// Does a step.
    fn advance(unit: &Unit<Self>, point: f64, step: f64) -> c_int;

    /// Time of the last successful step.
    fn time(unit: &Unit<Self>) -> f64;

    /// References that lead to the elements of a load over cells, in their order.
    fn family(unit: &Unit<Self>, name: &str) -> Vec<u32>;

    /// Sets the slope of an input over the next step, where the version knows any.
    fn set_slope(unit: &Unit<Self>, name: &str, slope: f64) -> c_int;
}

/// FMI 2.0.
pub struct Two;

/// FMI 3.0.
pub struct Three;

impl Version for Two {
    const PREFIX: &'static str = "fmi2";
    const REAL: &'static str = "Real";
    const INTEGER: &'static str = "Integer";
    const REFERENCES: &'static str = "vr";
    const VALUES: &'static str = "value";
    const EXPERIMENT: &'static str = "fmi2SetupExperiment";
    const FUNCTIONS: &'static [Group<Self>] = &functions::TWO;
    const OTHERS: &'static [&'static str] =
        &["fmi2GetTypesPlatform", "fmi2GetVersion", "fmi2Instantiate", "fmi2FreeInstance"];

    fn name(function: &str) -> String {
        let spelt = function.replace("FMUState", "FMUstate").replace("Deserialize", "DeSerialize");
        format!("{}{spelt}", Self::PREFIX)
    }

    fn instantiate(folder: &Folder, guid: &str, messages: &Messages) -> Handle {
        two::Arguments::of(folder, guid).instantiate(messages)
    }

    fn find(unit: &Unit<Self>, name: &str) -> Option<usize> {
        unit.registry.find(name)
    }

    fn count(unit: &Unit<Self>) -> usize {
        unit.registry.variables.len()
    }

    fn size(_: &Unit<Self>, references: &[u32]) -> usize {
        references.len()
    }

    fn begin(unit: &Unit<Self>, start: f64, stop: Option<f64>) -> c_int {
        match unit.setup(start, stop) {
            OK => unit.enter(),
            refused => refused,
        }
    }

    fn advance(unit: &Unit<Self>, point: f64, step: f64) -> c_int {
        unit.step(point, step)
    }

    /// fmi2GetRealStatus(fmi2LastSuccessfulTime).
    fn time(unit: &Unit<Self>) -> f64 {
        let mut value = f64::NAN;
        let status = call!("fmi2GetRealStatus", unit.handle => Handle, 2 => c_int,
            &raw mut value => *mut f64);
        assert_eq!(status, OK);
        value
    }

    fn family(unit: &Unit<Self>, name: &str) -> Vec<u32> {
        let start = format!("{name}[");
        let all = unit.registry.variables.iter().enumerate();
        let elements = all.filter(|(_, variable)| variable.name.starts_with(&start));
        elements.map(|(reference, _)| reference as u32).collect()
    }

    fn set_slope(unit: &Unit<Self>, name: &str, slope: f64) -> c_int {
        unit.set_derivative(name, 1, slope)
    }
}

impl Version for Three {
    const PREFIX: &'static str = "fmi3";
    const REAL: &'static str = "Float64";
    const INTEGER: &'static str = "Int32";
    const REFERENCES: &'static str = "valueReferences";
    const VALUES: &'static str = "values";
    const EXPERIMENT: &'static str = "fmi3EnterInitializationMode";
    const FUNCTIONS: &'static [Group<Self>] = &functions::THREE;
    const OTHERS: &'static [&'static str] = &[
        "fmi3GetVersion",
        "fmi3InstantiateModelExchange",
        "fmi3InstantiateCoSimulation",
        "fmi3InstantiateScheduledExecution",
        "fmi3FreeInstance",
    ];

    fn instantiate(folder: &Folder, guid: &str, messages: &Messages) -> Handle {
        three::Arguments::good(folder, guid).instantiate(messages)
    }

    fn find(unit: &Unit<Self>, name: &str) -> Option<usize> {
        unit.arrays.find(name)
    }

    fn count(unit: &Unit<Self>) -> usize {
        unit.arrays.variables.len()
    }

    fn size(unit: &Unit<Self>, references: &[u32]) -> usize {
        references.iter().map(|&r| unit.arrays.variables[r as usize].size()).sum()
    }

    fn begin(unit: &Unit<Self>, start: f64, stop: Option<f64>) -> c_int {
        unit.enter(start, stop)
    }

    fn advance(unit: &Unit<Self>, point: f64, step: f64) -> c_int {
        unit.step(point, step).0
    }

    fn time(unit: &Unit<Self>) -> f64 {
        unit.value("time")
    }

    fn family(unit: &Unit<Self>, name: &str) -> Vec<u32> {
        vec![unit.reference(name)]
    }

    fn set_slope(_: &Unit<Self>, _: &str, _: f64) -> c_int {
        OK
    }
}

/// Makes a test for each version of each of these functions: `two::NAME` and `three::NAME`.
macro_rules! both_versions {
    ($($test:ident),* $(,)?) => {
        mod two {
            $(#[test] fn $test() { super::$test::<$crate::master::Two>() })*
        }
        mod three {
            $(#[test] fn $test() { super::$test::<$crate::master::Three>() })*
        }
    };
}
pub(crate) use both_versions;
