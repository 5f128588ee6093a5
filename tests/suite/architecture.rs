//! Holds what ARCHITECTURE.md promises of the source.

use std::fs;
use std::path::{Path, PathBuf};

fn sources(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, out);
        } else if path.extension().is_some_and(|e| e == "rs") {
            out.push(path);
        }
    }
}

/// Modules of the library in the order of `lib.rs`.
fn order() -> Vec<String> {
    let text = fs::read_to_string("src/lib.rs").unwrap();
    let name = |line: &str| Some(line.strip_prefix("pub mod ")?.strip_suffix(';')?.to_owned());
    text.lines().filter_map(name).collect()
}

/// The library's files with the module each belongs to, and their text without its tests.
fn library() -> Vec<(String, PathBuf, String)> {
    let mut files = Vec::new();
    sources(Path::new("src"), &mut files);
    let modules = order();
    let part = |path: PathBuf| {
        let first =
            path.components().nth(1)?.as_os_str().to_str()?.trim_end_matches(".rs").to_owned();
        let text = fs::read_to_string(&path).ok()?;
        let code = text.split("#[cfg(test)]").next()?.to_owned();
        modules.contains(&first).then_some((first, path, code))
    };
    files.into_iter().filter_map(part).collect()
}

#[test]
fn a_module_uses_only_modules_above_it() {
    let modules = order();
    assert!(modules.len() >= 10, "{modules:?}");
    for (module, path, code) in library() {
        let own = modules.iter().position(|m| *m == module).unwrap();
        for later in &modules[own + 1..] {
            let code: Vec<&str> =
                code.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
            let used = code.iter().any(|line| line.contains(&format!("crate::{later}::")));
            assert!(!used, "{} uses {later}, which stands below {module}", path.display());
        }
    }
}

#[test]
fn the_front_page_lists_all_modules_in_their_order() {
    let text = fs::read_to_string("src/lib.rs").unwrap();
    let name = |line: &str| Some(line.strip_prefix("//! | [`")?.split_once("`]")?.0.to_owned());
    let listed: Vec<String> = text.lines().filter_map(name).collect();
    assert_eq!(listed, order());
}

#[test]
fn a_method_uses_only_methods_above_it() {
    let text = fs::read_to_string("src/method/mod.rs").unwrap();
    let name = |line: &str| Some(line.strip_prefix("pub mod ")?.strip_suffix(';')?.to_owned());
    let methods: Vec<String> = text.lines().filter_map(name).collect();
    assert!(methods.len() >= 7, "{methods:?}");
    for (n, method) in methods.iter().enumerate() {
        let folder = Path::new("src/method").join(method);
        let mut files = Vec::new();
        if folder.is_dir() {
            sources(&folder, &mut files);
        }
        for path in files {
            let text = fs::read_to_string(&path).unwrap();
            let code = text.split("#[cfg(test)]").next().unwrap();
            for later in &methods[n + 1..] {
                let uses = code.contains(&format!("crate::method::{later}::"));
                assert!(!uses, "{} uses {later}, which stands below", path.display());
            }
        }
    }
}

#[test]
fn only_the_outer_layers_do_input_and_output() {
    for (module, path, code) in library() {
        if ["fmi", "runtime", "output", "scene"].contains(&module.as_str()) {
            continue;
        }
        for word in ["std::fs", "std::io", "println!", "print!(", "eprint"] {
            assert!(!code.contains(word), "{} does input or output: {word}", path.display());
        }
    }
}

#[test]
fn only_bodies_and_scenes_know_kinds_of_bodies() {
    // Rules of advice are each about the keys of one kind, which they get from a list of its bodies.
    let lists =
        [".solids(", ".droplets(", ".reservoirs(", ".large_strains(", ".filaments(", ".lattices("];
    let solids = [".solid(\"", ".solid(&", ".solid(name"];
    let kinds = [".droplet(", ".reservoir(", "scene.large_strain(", ".filament(", ".lattice("];
    let words = [
        "Body::Solid",
        "Body::Droplet",
        "Body::Reservoir",
        "Body::LargeStrain",
        "Body::Filament",
        "Body::Lattice",
    ];
    for (module, path, code) in library() {
        if ["scene", "body"].contains(&module.as_str()) {
            continue;
        }
        let of_lists = lists.iter().filter(|_| module != "advice");
        for word in solids.iter().chain(&kinds).chain(&words).chain(of_lists) {
            assert!(!code.contains(word), "{} asks for a kind of body: {word}", path.display());
        }
    }
}

#[test]
fn a_panic_never_aborts() {
    let manifest = fs::read_to_string("Cargo.toml").unwrap();
    assert!(!manifest.contains("panic ="));
}
