//! fmi3Instantiate… tell precisely what is wrong.

use std::ffi::{c_char, c_void};
use std::ptr::{from_ref, null};

use crate::instantiation::{text, told};
use crate::master::three::{Arguments, free, listen};
use crate::master::{Folder, Handle, Messages, SCENE, library, own_guid};

/// Instantiation with one argument changed fails with a message that holds the fragments, whether the
/// master wants to log or not.
#[track_caller]
fn refused(change: impl Fn(&mut Arguments), fragments: &[&str]) {
    let folder = Folder::with_scene("resources", SCENE);
    for logging_on in [false, true] {
        let messages = Messages::default();
        let mut arguments = Arguments::good(&folder, &own_guid());
        arguments.logging_on = logging_on;
        change(&mut arguments);
        assert!(arguments.instantiate(&messages).is_null());
        told(&messages, "fmi3InstantiateCoSimulation", fragments);
    }
}

#[test]
fn a_path_with_blanks_and_percent_signs_is_taken_as_it_is() {
    let folder = Folder::with_scene("a b ü 100%20", SCENE);
    for tail in ["", "/"] {
        let messages = Messages::default();
        let mut arguments = Arguments::good(&folder, &own_guid());
        arguments.resources = text(&format!("{}{tail}", folder.0.display()));
        let handle = arguments.instantiate(&messages);
        assert!(!handle.is_null(), "{:?}", messages.take());
        free(handle);
    }
}

#[test]
fn wrong_arguments_are_refused_with_the_reason() {
    refused(|a| a.name = text(" "), &["instanceName is empty"]);
    refused(|a| a.name = None, &["instanceName is a null pointer"]);
    refused(|a| a.token = None, &["instantiationToken is a null pointer"]);
    refused(|a| a.token = text("{0}"), &["{0}", "not of one unit"]);
    refused(|a| a.resources = None, &["resourcePath is a null pointer"]);
    refused(|a| a.resources = text("/nowhere/"), &["/nowhere/scene.toml"]);
    refused(|a| a.event_mode_used = true, &["no Event Mode"]);
    refused(|a| a.intermediate = vec![1], &["intermediate updates"]);
}

#[test]
fn other_kinds_of_units_are_refused() {
    type Function = unsafe extern "C" fn(
        *const c_char,
        *const c_char,
        *const c_char,
        bool,
        bool,
        *const Messages,
        unsafe extern "C" fn(*mut c_void, i32, *const c_char, *const c_char),
        *const c_void,
        *const c_void,
        *const c_void,
    ) -> Handle;
    for (name, reason) in [
        ("fmi3InstantiateModelExchange", "model exchange"),
        ("fmi3InstantiateScheduledExecution", "scheduled execution"),
    ] {
        let messages = Messages::default();
        // SAFETY: the first takes three arguments less, which its caller cleans up.
        let handle = unsafe {
            let function = library().get::<Function>(name).unwrap();
            let (name, to) = (c"unit".as_ptr(), from_ref(&messages));
            function(name, name, name, false, false, to, listen, null(), null(), null())
        };
        assert!(handle.is_null());
        told(&messages, name, &[reason]);
    }
}
