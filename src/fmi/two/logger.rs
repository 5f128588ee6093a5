//! The logger of FMI 2.0, which takes messages as `printf` formats.

use std::ffi::{CStr, CString};

use super::types::Callbacks;
use crate::fmi::gate::float_environment;
use crate::fmi::gate::log::Sink;

/// Longest message in bytes; some masters format into fixed buffers of 1024.
const LONGEST: usize = 1000;

/// Returns a sink for the logger of FMI 2.0, with the name of the instance.
pub fn to_logger(instance: &CStr, callbacks: &Callbacks) -> Sink {
    let Callbacks { logger, component_environment: environment, .. } = *callbacks;
    let instance = instance.to_owned();
    Box::new(move |status, category, message| {
        let Some(logger) = logger else { return };
        let (instance, category) = (instance.as_ptr(), category.as_ptr());
        let format = as_format(message);
        // SAFETY: the callback came with fmi2Instantiate and has this signature; the strings live
        // through the call and the format takes no further arguments.
        float_environment::of_host(|| unsafe {
            logger(environment, instance, status, category, format.as_ptr());
        });
    })
}

/// Returns the text as a `printf` format that prints it. Many masters print the format itself and ignore further
/// arguments, so `"%s"` with the text as an argument would print nothing useful.
fn as_format(message: &str) -> CString {
    let mut format = String::with_capacity(message.len());
    for character in message.chars() {
        match character {
            '%' => format.push_str("%%"),
            '\0' => format.push(' '),
            other => format.push(other),
        }
        if format.len() > LONGEST {
            format.push('…');
            break;
        }
    }
    CString::new(format).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percent_signs_are_escaped_and_nul_bytes_removed() {
        assert_eq!(as_format("100 %s\0!").as_c_str(), c"100 %%s !");
    }

    #[test]
    fn long_messages_are_cut_between_characters() {
        let format = as_format(&"%µ".repeat(2000)).into_string().unwrap();
        assert!(format.len() < 1024 && format.ends_with('…'));
    }
}
