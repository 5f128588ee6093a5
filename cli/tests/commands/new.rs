//! `impinge new`.

use std::fs;

use super::Workplace;

#[test]
fn new_scenes_raise_no_warning() {
    let place = Workplace::new();
    let list = place.call(&["new"]).succeeds().stdout();
    let names: Vec<_> = list.lines().map(|line| line.split_whitespace().next().unwrap()).collect();
    assert_eq!(names.len(), 6, "{list}");
    for name in names {
        let said = place.call(&["new", name]).succeeds().stdout();
        assert!(said.contains(&format!("next: impinge check {name}.toml")), "{said}");
        let called = place.call(&["check", &format!("{name}.toml")]).succeeds();
        assert_eq!(called.stderr(), "", "{name}");
    }
}

#[test]
fn a_file_that_is_there_is_kept() {
    let place = Workplace::new();
    fs::write(place.path("mine.toml"), "mine").unwrap();
    let words = ["mine.toml", "exists", "another file"];
    place.call(&["new", "heated-box", "-o", "mine.toml"]).fails(1, &words);
    assert_eq!(fs::read_to_string(place.path("mine.toml")).unwrap(), "mine");
}

#[test]
fn misspelt_kinds_are_corrected() {
    Workplace::new().call(&["new", "drop-on-plat"]).fails(1, &["did you mean `drop-on-plate`?"]);
}

#[test]
fn bodies_that_no_input_moves_are_told_of() {
    let place = Workplace::new();
    place.call(&["new", "notched-beam"]).succeeds();
    let run = |more: &[&str]| {
        let words = [&["run", "notched-beam.toml", "--overwrite", "--until", "0.1"], more].concat();
        place.call(&words).succeeds().stderr()
    };
    let said = run(&[]);
    assert!(said.contains("note: nothing acts") && said.contains("beam.opening=VALUE"), "{said}");
    assert!(!run(&["--set", "beam.opening=1e-6"]).contains("nothing acts"));
}
