//! `docs/warnings.md` is what follows from the table of rules; `WRITE_REFERENCE=1` writes it anew.

use std::collections::BTreeSet;
use std::path::Path;
use std::{env, fs};

use impinge::warning::{When, table};

const PAGE: &str = "docs/warnings.md";

const HEAD: &str = "# Warnings

Warnings name what may be wrong and change no result; what cannot be computed is refused instead. Every warning reads
`place: what is wrong, with the number; remedy [id]`, where the place is `FILE:LINE: KEY = VALUE`, the name of a body or
an output, or `INPUT = VALUE`.

This page follows from the table of rules in `src/warning`. Names in braces stand for values.

";

const SECTIONS: [(When, &str); 5] = [
    (
        When::Check,
        "`impinge check`, `run` and `build-fmu` apply these to a scene, a unit to its parameters.",
    ),
    (When::Build, "These apply once meshes are chosen and bodies are built."),
    (When::Step, "These apply as an input is set and after each step; a unit's log has each once."),
    (When::Read, "These apply as an output is read."),
    (When::End, "These apply as a run ends."),
];

fn page() -> String {
    let mut page = HEAD.to_owned();
    for (when, words) in SECTIONS {
        page +=
            &format!("## {}\n{words}\n\n| id | message | remedy |\n|---|---|---|\n", when.name());
        for rule in table().filter(|rule| rule.when == when) {
            let [message, remedy] = [rule.message, rule.remedy].map(shown);
            page += &format!("| `{}` | {message} | {remedy} |\n", rule.id);
        }
        page += "\n";
    }
    page.trim_end().to_owned() + "\n"
}

/// A format as it reads, with braces that are no value's.
fn shown(format: &str) -> String {
    format.replace("{{", "{").replace("}}", "}").replace('|', "\\|")
}

#[test]
fn the_page_follows_from_the_table() {
    if env::var_os("WRITE_REFERENCE").is_some() {
        fs::write(PAGE, page()).unwrap();
    }
    let same = fs::read_to_string(PAGE).unwrap() == page();
    assert!(same, "{PAGE} is not what follows; WRITE_REFERENCE=1 writes it");
}

fn text_below(folder: &Path, text: &mut String) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() && !path.ends_with("src/warning") {
            text_below(&path, text);
        } else if path.extension().is_some_and(|end| end == "rs") {
            *text += &fs::read_to_string(&path).unwrap();
        }
    }
}

#[test]
fn every_rule_has_a_name_of_its_own_and_a_test_that_applies_it() {
    let mut text = String::new();
    ["src", "cli/src"].into_iter().for_each(|folder| text_below(Path::new(folder), &mut text));
    let mut ids = BTreeSet::new();
    for rule in table() {
        assert!(ids.insert(rule.id), "{} stands twice", rule.id);
        let is_applied = [format!("warning::{}(", rule.id), format!("warning::{})", rule.id)];
        assert!(is_applied.iter().any(|call| text.contains(call)), "nothing applies {}", rule.id);
    }
}

#[test]
fn messages_have_no_remedy_and_end_as_parts_of_a_sentence() {
    for rule in table() {
        assert!(!rule.message.contains("; did you mean"), "{}", rule.id);
        assert!(!rule.message.ends_with(['.', ';', ' ']), "{}", rule.id);
        assert!(!rule.remedy.is_empty() && !rule.remedy.ends_with(['.', ';', ' ']), "{}", rule.id);
    }
}
