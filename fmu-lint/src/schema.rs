//! The elements and attributes of modelDescription.xml as tables, after the schema files of FMI 2.0.4
//! (`fmi2ModelDescription.xsd` and the files that it includes).

use super::vocabulary::{Causality, DEPENDENCE, Initial, Variability};

/// An element with its allowed contents.
pub struct Element {
    pub name: &'static str,
    pub attributes: &'static [Attribute],
    pub content: Content,
}

pub enum Content {
    /// Groups of elements in this order.
    Sequence(&'static [Group]),
    /// Arbitrary content.
    Anything,
}

/// Elements allowed at one position of a sequence.
pub struct Group {
    pub any_of: &'static [&'static Element],
    pub least: usize,
    pub most: usize,
}

pub struct Attribute {
    pub name: &'static str,
    pub values: Values,
    pub required: bool,
}

/// Allowed values of an attribute.
#[derive(Clone, Copy)]
pub enum Values {
    Text,
    Boolean,
    Double,
    Integer,
    /// A whole number from 0 on.
    Unsigned,
    Time,
    OneOf(&'static [&'static str]),
    ListOfUnsigned,
    ListOf(&'static [&'static str]),
}

impl Values {
    /// Returns true if the text is one of these values.
    pub fn hold(self, text: &str) -> bool {
        match self {
            Values::Text => true,
            Values::Boolean => ["true", "false", "1", "0"].contains(&text.trim()),
            Values::Double => double(text).is_some(),
            Values::Integer => text.trim().parse::<i32>().is_ok(),
            Values::Unsigned => text.trim().parse::<u32>().is_ok(),
            Values::Time => is_time(text.trim()),
            Values::OneOf(words) => words.contains(&text),
            Values::ListOfUnsigned => {
                text.split_whitespace().all(|item| item.parse::<u32>().is_ok())
            }
            Values::ListOf(words) => text.split_whitespace().all(|item| words.contains(&item)),
        }
    }

    /// Describes the allowed values.
    pub fn words(self) -> String {
        match self {
            Values::Text => "any text".into(),
            Values::Boolean => "true, false, 1 or 0".into(),
            Values::Double => "a finite number".into(),
            Values::Integer => format!("a whole number from {} to {}", i32::MIN, i32::MAX),
            Values::Unsigned => format!("a whole number from 0 to {}", u32::MAX),
            Values::Time => "a time such as 2009-12-08T14:33:22Z".into(),
            Values::OneOf(words) => words.join(", "),
            Values::ListOfUnsigned => "whole numbers from 0 on, separated by blanks".into(),
            Values::ListOf(words) => format!("words separated by blanks, of {}", words.join(", ")),
        }
    }
}

/// Parses a finite number in XML notation; FMI excludes infinities and NaN.
pub fn double(text: &str) -> Option<f64> {
    let text = text.trim();
    let known = text.bytes().all(|byte| byte.is_ascii_digit() || b"+-.eE".contains(&byte));
    text.parse().ok().filter(|value: &f64| known && value.is_finite())
}

/// `YYYY-MM-DDThh:mm:ss`, optionally with fractional seconds and a time zone.
fn is_time(text: &str) -> bool {
    let pattern = "0000-00-00T00:00:00";
    let fits =
        |(have, want): (char, char)| if want == '0' { have.is_ascii_digit() } else { have == want };
    let zone = |rest: &str| rest.chars().all(|c| c.is_ascii_digit() || ".:+-Z".contains(c));
    text.len() >= pattern.len()
        && text.chars().zip(pattern.chars()).all(fits)
        && text.get(pattern.len()..).is_some_and(zone)
}

const fn need(name: &'static str, values: Values) -> Attribute {
    Attribute { name, values, required: true }
}

const fn may(name: &'static str, values: Values) -> Attribute {
    Attribute { name, values, required: false }
}

const fn one(element: &'static [&'static Element]) -> Group {
    Group { any_of: element, least: 1, most: 1 }
}

const fn optional(element: &'static [&'static Element]) -> Group {
    Group { any_of: element, least: 0, most: 1 }
}

const fn many(least: usize, element: &'static [&'static Element]) -> Group {
    Group { any_of: element, least, most: usize::MAX }
}

/// An element without content.
const fn leaf(name: &'static str, attributes: &'static [Attribute]) -> Element {
    Element { name, attributes, content: Content::Sequence(&[]) }
}

/// An element without attributes.
const fn parent(name: &'static str, groups: &'static [Group]) -> Element {
    Element { name, attributes: &[], content: Content::Sequence(groups) }
}

use Values::{Boolean, Double, Integer, Text, Unsigned};

pub static ROOT: Element = Element {
    name: "fmiModelDescription",
    attributes: &[
        need("fmiVersion", Values::OneOf(&["2.0"])),
        need("modelName", Text),
        need("guid", Text),
        may("description", Text),
        may("author", Text),
        may("version", Text),
        may("copyright", Text),
        may("license", Text),
        may("generationTool", Text),
        may("generationDateAndTime", Values::Time),
        may("variableNamingConvention", Values::OneOf(&["flat", "structured"])),
        may("numberOfEventIndicators", Unsigned),
    ],
    content: Content::Sequence(&[
        Group { any_of: &[&MODEL_EXCHANGE, &CO_SIMULATION], least: 1, most: 2 },
        optional(&[&UNIT_DEFINITIONS]),
        optional(&[&TYPE_DEFINITIONS]),
        optional(&[&LOG_CATEGORIES]),
        optional(&[&DEFAULT_EXPERIMENT]),
        optional(&[&VENDOR_ANNOTATIONS]),
        one(&[&MODEL_VARIABLES]),
        one(&[&MODEL_STRUCTURE]),
    ]),
};

static MODEL_EXCHANGE: Element = Element {
    name: "ModelExchange",
    attributes: &[
        need("modelIdentifier", Text),
        may("needsExecutionTool", Boolean),
        may("completedIntegratorStepNotNeeded", Boolean),
        may("canBeInstantiatedOnlyOncePerProcess", Boolean),
        may("canNotUseMemoryManagementFunctions", Boolean),
        may("canGetAndSetFMUstate", Boolean),
        may("canSerializeFMUstate", Boolean),
        may("providesDirectionalDerivative", Boolean),
    ],
    content: Content::Sequence(&[optional(&[&SOURCE_FILES])]),
};

static CO_SIMULATION: Element = Element {
    name: "CoSimulation",
    attributes: &[
        need("modelIdentifier", Text),
        may("needsExecutionTool", Boolean),
        may("canHandleVariableCommunicationStepSize", Boolean),
        may("canInterpolateInputs", Boolean),
        may("maxOutputDerivativeOrder", Unsigned),
        may("canRunAsynchronuously", Boolean),
        may("canBeInstantiatedOnlyOncePerProcess", Boolean),
        may("canNotUseMemoryManagementFunctions", Boolean),
        may("canGetAndSetFMUstate", Boolean),
        may("canSerializeFMUstate", Boolean),
        may("providesDirectionalDerivative", Boolean),
    ],
    content: Content::Sequence(&[optional(&[&SOURCE_FILES])]),
};

static SOURCE_FILES: Element = parent("SourceFiles", &[many(1, &[&FILE])]);
static FILE: Element = leaf("File", &[need("name", Text)]);

static UNIT_DEFINITIONS: Element = parent("UnitDefinitions", &[many(1, &[&UNIT])]);
static UNIT: Element = Element {
    name: "Unit",
    attributes: &[need("name", Text)],
    content: Content::Sequence(&[optional(&[&BASE_UNIT]), many(0, &[&DISPLAY_UNIT])]),
};
static BASE_UNIT: Element = leaf(
    "BaseUnit",
    &[
        may("kg", Integer),
        may("m", Integer),
        may("s", Integer),
        may("A", Integer),
        may("K", Integer),
        may("mol", Integer),
        may("cd", Integer),
        may("rad", Integer),
        may("factor", Double),
        may("offset", Double),
    ],
);
static DISPLAY_UNIT: Element =
    leaf("DisplayUnit", &[need("name", Text), may("factor", Double), may("offset", Double)]);

static TYPE_DEFINITIONS: Element = parent("TypeDefinitions", &[many(1, &[&SIMPLE_TYPE])]);
static SIMPLE_TYPE: Element = Element {
    name: "SimpleType",
    attributes: &[need("name", Text), may("description", Text)],
    content: Content::Sequence(&[one(&[
        &TYPE_REAL,
        &TYPE_INTEGER,
        &TYPE_BOOLEAN,
        &TYPE_STRING,
        &TYPE_ENUMERATION,
    ])]),
};
static TYPE_REAL: Element = leaf(
    "Real",
    &[
        may("quantity", Text),
        may("unit", Text),
        may("displayUnit", Text),
        may("relativeQuantity", Boolean),
        may("min", Double),
        may("max", Double),
        may("nominal", Double),
        may("unbounded", Boolean),
    ],
);
static TYPE_INTEGER: Element =
    leaf("Integer", &[may("quantity", Text), may("min", Integer), may("max", Integer)]);
static TYPE_BOOLEAN: Element = leaf("Boolean", &[]);
static TYPE_STRING: Element = leaf("String", &[]);
static TYPE_ENUMERATION: Element = Element {
    name: "Enumeration",
    attributes: &[may("quantity", Text)],
    content: Content::Sequence(&[many(1, &[&ITEM])]),
};
static ITEM: Element =
    leaf("Item", &[need("name", Text), need("value", Integer), may("description", Text)]);

static LOG_CATEGORIES: Element = parent("LogCategories", &[many(1, &[&CATEGORY])]);
static CATEGORY: Element = leaf("Category", &[need("name", Text), may("description", Text)]);

static DEFAULT_EXPERIMENT: Element = leaf(
    "DefaultExperiment",
    &[
        may("startTime", Double),
        may("stopTime", Double),
        may("tolerance", Double),
        may("stepSize", Double),
    ],
);

static VENDOR_ANNOTATIONS: Element = parent("VendorAnnotations", &[many(1, &[&TOOL])]);
static ANNOTATIONS: Element = parent("Annotations", &[many(1, &[&TOOL])]);
static TOOL: Element =
    Element { name: "Tool", attributes: &[need("name", Text)], content: Content::Anything };

static MODEL_VARIABLES: Element = parent("ModelVariables", &[many(1, &[&SCALAR_VARIABLE])]);
static SCALAR_VARIABLE: Element = Element {
    name: "ScalarVariable",
    attributes: &[
        need("name", Text),
        need("valueReference", Unsigned),
        may("description", Text),
        may("causality", Values::OneOf(Causality::WORDS)),
        may("variability", Values::OneOf(Variability::WORDS)),
        may("initial", Values::OneOf(Initial::WORDS)),
        may("canHandleMultipleSetPerTimeInstant", Boolean),
    ],
    content: Content::Sequence(&[
        one(&[&REAL, &INTEGER, &BOOLEAN, &STRING, &ENUMERATION]),
        optional(&[&ANNOTATIONS]),
    ]),
};
static REAL: Element = leaf(
    "Real",
    &[
        may("declaredType", Text),
        may("quantity", Text),
        may("unit", Text),
        may("displayUnit", Text),
        may("relativeQuantity", Boolean),
        may("min", Double),
        may("max", Double),
        may("nominal", Double),
        may("unbounded", Boolean),
        may("start", Double),
        may("derivative", Unsigned),
        may("reinit", Boolean),
    ],
);
static INTEGER: Element = leaf(
    "Integer",
    &[
        may("declaredType", Text),
        may("quantity", Text),
        may("min", Integer),
        may("max", Integer),
        may("start", Integer),
    ],
);
static BOOLEAN: Element = leaf("Boolean", &[may("declaredType", Text), may("start", Boolean)]);
static STRING: Element = leaf("String", &[may("declaredType", Text), may("start", Text)]);
static ENUMERATION: Element = leaf(
    "Enumeration",
    &[
        need("declaredType", Text),
        may("quantity", Text),
        may("min", Integer),
        may("max", Integer),
        may("start", Integer),
    ],
);

static MODEL_STRUCTURE: Element = parent(
    "ModelStructure",
    &[optional(&[&OUTPUTS]), optional(&[&DERIVATIVES]), optional(&[&INITIAL_UNKNOWNS])],
);
static OUTPUTS: Element = parent("Outputs", &[many(1, &[&UNKNOWN])]);
static DERIVATIVES: Element = parent("Derivatives", &[many(1, &[&UNKNOWN])]);
static INITIAL_UNKNOWNS: Element = parent("InitialUnknowns", &[many(1, &[&UNKNOWN])]);
static UNKNOWN: Element = leaf(
    "Unknown",
    &[
        need("index", Unsigned),
        may("dependencies", Values::ListOfUnsigned),
        may("dependenciesKind", Values::ListOf(DEPENDENCE)),
    ],
);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_recognised() {
        for (values, good, bad) in [
            (Double, "-1.5e-3", "inf"),
            (Double, " .5 ", "NaN"),
            (Double, "+1", "0x10"),
            (Integer, "-2147483648", "2147483648"),
            (Unsigned, "4294967295", "-1"),
            (Boolean, "1", "True"),
            (Values::Time, "2009-12-08T14:33:22Z", "8.12.2009"),
            (Values::Time, "2009-12-08T14:33:22.25+01:00", "2009-12-08T14:33:22 noon"),
            (Values::ListOfUnsigned, "", "1,2"),
            (Values::ListOf(DEPENDENCE), "fixed  dependent", "linear"),
        ] {
            assert!(values.hold(good), "{good}");
            assert!(!values.hold(bad), "{bad}");
        }
    }
}
