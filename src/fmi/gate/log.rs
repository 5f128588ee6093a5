//! Messages to the master's logger callback.

use std::collections::BTreeSet;
use std::ffi::CStr;

use super::answer::Status;

/// Log categories, as the XML declares them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Category {
    Warning,
    Discard,
    Error,
    Fatal,
    Model,
    All,
}

impl Category {
    pub const ALL: [Category; 6] = [
        Category::Warning,
        Category::Discard,
        Category::Error,
        Category::Fatal,
        Category::Model,
        Category::All,
    ];

    /// Name of the category in XML and in messages.
    pub fn name(self) -> &'static str {
        self.c_name().to_str().unwrap_or_default()
    }

    fn c_name(self) -> &'static CStr {
        match self {
            Category::Warning => c"logStatusWarning",
            Category::Discard => c"logStatusDiscard",
            Category::Error => c"logStatusError",
            Category::Fatal => c"logStatusFatal",
            Category::Model => c"model",
            Category::All => c"logAll",
        }
    }

    /// Description of the category in XML.
    pub fn description(self) -> &'static str {
        match self {
            Category::Warning => {
                "What is implausible in the scene, and failures beside the computation"
            }
            Category::Discard => "A question that this unit has no answer to",
            Category::Error => "Why a call was refused",
            Category::Fatal => "Why the instance can no longer be used",
            Category::Model => "What is modelled, and what was left out and why",
            Category::All => "All messages",
        }
    }

    fn of(status: Status) -> Self {
        match status {
            Status::Ok => Category::Model,
            Status::Warning => Category::Warning,
            Status::Discard => Category::Discard,
            Status::Error => Category::Error,
            Status::Fatal => Category::Fatal,
        }
    }

    fn find(name: &str) -> Option<Self> {
        Category::ALL.into_iter().find(|category| category.name() == name)
    }
}

/// Passes a message on to the master: status, category, text.
pub type Sink = Box<dyn Fn(Status, &CStr, &str)>;

/// Sink of messages, and the enabled categories.
pub struct Log {
    sink: Sink,
    on: bool,
    wanted: BTreeSet<Category>,
}

impl Log {
    /// All categories are enabled until a master chooses.
    pub fn new(sink: Sink, on: bool) -> Self {
        Self { sink, on, wanted: BTreeSet::from([Category::All]) }
    }

    /// Switches logging; no names mean all categories. An unknown name changes nothing.
    pub fn configure(&mut self, on: bool, names: &[String]) -> Result<(), String> {
        let wanted: Result<BTreeSet<_>, String> = names
            .iter()
            .map(|name| {
                let known = Category::ALL.map(Category::name).join(", ");
                let unknown = || format!("log category {name:?} is unknown; known are {known}");
                Category::find(name).ok_or_else(unknown)
            })
            .collect();
        let wanted = wanted?;
        self.on = on;
        self.wanted = if wanted.is_empty() { BTreeSet::from([Category::All]) } else { wanted };
        Ok(())
    }

    /// Sends one message, if enabled. Errors are not debug logging: a master without debug logging still receives the
    /// reasons of refusals.
    pub fn send(&self, status: Status, message: &str) {
        let category = Category::of(status);
        let wanted = if self.on {
            self.wanted.contains(&Category::All) || self.wanted.contains(&category)
        } else {
            status >= Status::Error
        };
        if wanted {
            (self.sink)(status, category.c_name(), message);
        }
    }
}
