//! Messages to standard error, and what of them has been printed so far.

use std::fmt::Display;
use std::io::{self, Write};
use std::sync::{Mutex, PoisonError};

use impinge::warning::Warning;
use serde::{Deserialize, Serialize};

/// A message of a run, for its report.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Message {
    /// `warning`, `note` or `error`.
    pub kind: String,
    /// The body, variable or file that it is about; empty for others.
    pub place: String,
    pub message: String,
    /// Empty if there is none.
    pub remedy: String,
    /// Id in the library's table of warnings; empty for other messages.
    #[serde(default)]
    pub id: String,
}

/// Messages that this process has printed.
static PRINTED: Mutex<Vec<Message>> = Mutex::new(Vec::new());

/// Prints warnings.
pub fn warn(warnings: &[Warning]) {
    for warning in warnings {
        let finding = warning.finding();
        write("warning", warning);
        keep(Message {
            kind: "warning".to_owned(),
            place: warning.place().to_owned(),
            message: finding.message.clone(),
            remedy: finding.remedy.clone(),
            id: finding.id.to_owned(),
        });
    }
}

/// Prints a message that is no warning of the library's table.
pub fn print_message(kind: &str, what: &dyn Display) {
    write(kind, what);
    let (kind, message) = (kind.to_owned(), what.to_string());
    let (place, remedy, id) = (String::new(), String::new(), String::new());
    keep(Message { kind, place, message, remedy, id });
}

/// Prints a message that depends on the machine, so that no report of the run has it.
pub fn print_in_passing(kind: &str, what: &dyn Display) {
    write(kind, what);
}

/// Returns what has been printed so far.
pub fn printed() -> Vec<Message> {
    PRINTED.lock().unwrap_or_else(PoisonError::into_inner).clone()
}

fn keep(message: Message) {
    PRINTED.lock().unwrap_or_else(PoisonError::into_inner).push(message);
}

/// Writes to standard error; ignores a failure to do so.
fn write(kind: &str, what: &dyn Display) {
    let _ = writeln!(io::stderr(), "{kind}: {what}");
}
