//! fmi2Instantiate tells precisely what is wrong.

use std::ffi::CString;
use std::ptr::null;

use crate::master::{Arguments, ERROR, Folder, Messages, SCENE, free, own_guid};

/// Instantiation with one argument changed fails with a message that holds the fragments.
#[track_caller]
fn refused(change: impl FnOnce(&mut Arguments), fragments: &[&str]) {
    let folder = Folder::with_scene("resources", SCENE);
    let messages = Messages::default();
    let mut arguments = Arguments::good(&folder);
    change(&mut arguments);
    assert!(arguments.instantiate(&messages).is_null());
    told(&messages, "fmi2Instantiate", fragments);
}

/// A function that makes instances has said why it made none, with the fragments.
#[track_caller]
pub fn told(messages: &Messages, function: &str, fragments: &[&str]) {
    let message = messages.expect_one(ERROR, fragments);
    assert_eq!(message.category, "logStatusError");
    assert!(message.text.starts_with(function), "{}", message.text);
}

pub fn text(text: &str) -> Option<CString> {
    Some(CString::new(text).unwrap())
}

#[test]
fn good_arguments_in_all_forms_of_the_uri() {
    let folder = Folder::with_scene("a b ü 100%", SCENE);
    let path = folder.0.to_str().unwrap();
    let escaped = path.replace('%', "%25").replace(' ', "%20").replace('ü', "%C3%BC");
    for uri in [
        format!("file://{escaped}"),
        format!("file:{escaped}"),
        format!("file://localhost{escaped}/"),
        format!("FILE://{}", path.replace('%', "%25")),
        path.to_owned(),
    ] {
        let messages = Messages::default();
        let arguments = Arguments { resources: text(&uri), ..Arguments::good(&folder) };
        let handle = arguments.instantiate(&messages);
        assert!(!handle.is_null(), "{uri}: {:?}", messages.take());
        free(handle);
    }
}

#[test]
fn the_name_must_not_be_empty() {
    refused(|a| a.name = text(""), &["instanceName is empty"]);
    refused(|a| a.name = None, &["instanceName is empty"]);
}

#[test]
fn model_exchange_is_refused() {
    refused(|a| a.fmu_type = 0, &["fmuType 0", "fmi2CoSimulation"]);
    refused(|a| a.fmu_type = 77, &["fmuType 77"]);
}

#[test]
fn another_guid_is_refused_with_both_guids() {
    refused(|a| a.guid = text("{1234}"), &["{1234}", &own_guid(), "scene.toml"]);
    refused(|a| a.guid = None, &["fmuGUID is a null pointer"]);
}

#[test]
fn a_bad_resource_location_is_refused() {
    refused(|a| a.resources = None, &["fmuResourceLocation is a null pointer"]);
    refused(|a| a.resources = text(""), &["resource location is empty"]);
    refused(|a| a.resources = text("https://host/unit"), &["https URI"]);
    refused(|a| a.resources = text("file://server/unit"), &["another host"]);
    refused(|a| a.resources = text("file:///nowhere/100%25s"), &["/nowhere/100%s/scene.toml"]);
    let invalid = CString::new(b"file:///\xff".to_vec()).unwrap();
    refused(|a| a.resources = Some(invalid), &["not UTF-8"]);
}

#[test]
fn a_broken_scene_is_refused_with_its_file() {
    let folder = Folder::with_scene("broken", "name = 3");
    let uri = folder.uri();
    refused(move |a| a.resources = text(&uri), &["scene.toml"]);
}

#[test]
fn no_callbacks_are_refused_and_no_logger_is_fine() {
    let folder = Folder::with_scene("resources", SCENE);
    let messages = Messages::default();
    let mut arguments = Arguments::good(&folder);
    assert!(arguments.instantiate_with(null()).is_null());
    arguments.with_logger = false;
    let handle = arguments.instantiate(&messages);
    assert!(!handle.is_null());
    free(handle);
    arguments.guid = text("{wrong}");
    assert!(arguments.instantiate(&messages).is_null());
}
