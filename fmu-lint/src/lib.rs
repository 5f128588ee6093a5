//! `build-fmu --lint FILE.fmu`: checks a unit of any tool against the FMI 2.0 standard.
//!
//! A unit is unpacked in memory ([`package`]), its modelDescription.xml is parsed ([`document`]) and converted to plain
//! data ([`description`]). Then each rule of the table in [`rules`] checks that data and reports its findings
//! ([`finding`]).

mod combination;
mod description;
mod document;
mod extent;
mod finding;
pub mod library;
mod package;
mod platform;
mod probe;
mod rules;
mod schema;
mod vocabulary;

use std::fmt::Write as _;
use std::path::Path;

use description::Description;
use document::Document;
use finding::{Finding, Report, Severity};
use impinge::scene::bytes_of;
use package::Package;
use rules::{Check, Rule};

pub use probe::instantiate;

/// The file that describes a unit.
const DESCRIPTION: &str = "modelDescription.xml";

/// Largest size of a checked file in bytes.
const LARGEST_FILE: u64 = 1 << 32;

/// A unit that could be read, for rules to look at.
pub struct Subject<'a> {
    pub package: &'a Package,
    pub document: &'a Document<'a>,
    pub description: &'a Description<'a>,
    /// True if the unit's library may be loaded, in a separate process.
    pub may_run: bool,
}

/// Result for a file.
pub struct Verdict {
    pub text: String,
    pub has_errors: bool,
}

/// Checks the unit in `path`; `may_run` allows loading its library.
pub fn lint(path: &Path, may_run: bool) -> Result<Verdict, String> {
    let file = path.display();
    let cannot = |error: std::io::Error| format!("cannot read {file}: {error}");
    let bytes = bytes_of(path, LARGEST_FILE).map_err(cannot)?;
    let findings = findings(bytes, may_run);
    let count = |severity| findings.iter().filter(|f| f.severity == severity).count();
    let (errors, warnings) = (count(Severity::Error), count(Severity::Warning));
    let mut text = String::new();
    for finding in &findings {
        let _ = writeln!(text, "{finding}");
    }
    let _ = match findings.len() {
        0 => write!(text, "{file}: no findings"),
        _ => write!(text, "{file}: errors: {errors}, warnings: {warnings}"),
    };
    Ok(Verdict { text, has_errors: errors > 0 })
}

/// The table of rules as text.
pub fn rules() -> String {
    let line = |rule: &Rule| format!("{:20} {:8} {}", rule.name, rule.section, rule.says);
    let lines: Vec<String> = rules::all().map(line).collect();
    format!("{:20} {:8} what is right, by FMI 2.0.4\n{}", "rule", "section", lines.join("\n"))
}

/// All findings in the order of the rules. Without a zip file there is no XML to check, and without well-formed XML of
/// this version of the standard no description.
fn findings(bytes: Vec<u8>, may_run: bool) -> Vec<Finding> {
    let mut found = Vec::new();
    let Some(package) = Report::of(&rules::READABLE, &mut found).take(Package::open(bytes)) else {
        return found;
    };
    let (sizes, faults) = package.read_all();
    for fault in faults {
        Report::of(&rules::READABLE, &mut found).take(Err::<(), _>(fault));
    }
    rules::check_sizes(&sizes, &mut Report::of(&rules::SIZES, &mut found));
    for rule in rules::all() {
        if let Check::Package(check) = rule.check {
            check(&package, &mut Report::of(rule, &mut found));
        }
    }
    let mut report = Report::of(&rules::WELL_FORMED, &mut found);
    let Some(text) = report.take(package.text(DESCRIPTION)) else { return found };
    let Some(document) = report.take(Document::parse(&text)) else { return found };
    rules::check_encoding(&text, &mut report);
    if !rules::of_this_version(&document, &mut Report::of(&rules::VERSION, &mut found)) {
        return found;
    }
    let description = &Description::read(&document);
    let subject = Subject { package: &package, document: &document, description, may_run };
    for rule in rules::all() {
        if let Check::Unit(check) = rule.check {
            check(&subject, &mut Report::of(rule, &mut found));
        }
    }
    found
}
