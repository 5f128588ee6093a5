//! Completions for shells and pages for `man`.

use std::fs;

use super::Workplace;

#[test]
fn every_shell_completes_commands_and_options() {
    for shell in ["bash", "zsh", "fish", "powershell"] {
        let script = Workplace::new().call(&["completions", shell]).succeeds().stdout();
        for word in ["check", "schema", "fields-every"] {
            assert!(script.contains(word), "{shell} does not know {word}");
        }
    }
    Workplace::new().call(&["completions", "tcsh"]).fails(2, &["tcsh", "possible values", "bash"]);
}

#[test]
fn every_command_has_a_manual_page() {
    let place = Workplace::new();
    place.call(&["man", "share/man1"]).succeeds();
    let pages = place.files("share/man1");
    for page in ["impinge.1", "impinge-check.1", "impinge-run.1", "impinge-schema.1"] {
        assert!(pages.iter().any(|name| name == page), "{pages:?}");
    }
    let page = fs::read_to_string(place.path("share/man1/impinge-run.1")).unwrap();
    assert!(page.contains("overwrite"), "{page}");
    place.call(&["man", "scene.toml/below"]).fails(1, &["cannot write manual pages to scene.toml"]);
}
