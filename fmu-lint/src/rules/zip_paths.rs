//! Paths that some tools would unpack elsewhere, or not at all.

use super::{Check, Rule};
use crate::finding::{Place, Report};
use crate::package::Package;

pub static RULE: Rule = Rule {
    name: "zip-paths",
    section: "2.3",
    says: "paths in the zip file are relative, in UTF-8, with forward slashes and without `..`",
    check: Check::Package(check),
};

fn check(package: &Package, report: &mut Report) {
    for entry in &package.entries {
        let shown = String::from_utf8_lossy(&entry.path);
        for wrong in faults(&entry.path) {
            report.error(Place::file(&shown), wrong, RULE.says);
        }
    }
}

fn faults(path: &[u8]) -> Vec<&'static str> {
    let has_drive = matches!(path, [drive, b':', ..] if drive.is_ascii_alphabetic());
    let parts = || path.split(|byte| b"/\\".contains(byte));
    let faults = [
        (path.contains(&b'\\'), "the path has a backslash"),
        (path.starts_with(b"/") || has_drive, "the path is absolute"),
        (parts().any(|part| part == b".."), "the path leads out of the unit by `..`"),
        (std::str::from_utf8(path).is_err(), "the path is not UTF-8"),
        (path.contains(&0), "the path has a zero byte"),
        (path.is_empty(), "the path is empty"),
    ];
    faults.into_iter().filter(|(is_wrong, _)| *is_wrong).map(|(_, wrong)| wrong).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn non_relative_paths_are_found() {
        for (path, count) in [
            (&b"binaries/linux64/a.so"[..], 0),
            (b"resources/a..b", 0),
            ("documentation/ü.html".as_bytes(), 0),
            (b"binaries\\win64\\a.dll", 1),
            (b"/etc/passwd", 1),
            (b"C:/a", 1),
            (b"../a", 1),
            (b"resources\\..\\a", 2),
            (b"\xff", 1),
            (b"", 1),
        ] {
            assert_eq!(faults(path).len(), count, "{}", String::from_utf8_lossy(path));
        }
    }
}
