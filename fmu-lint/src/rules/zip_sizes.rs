//! Sizes in the zip file's directory, compared with those of the entries.

use super::{Check, Rule};
use crate::finding::{Place, Report};
use crate::package::Size;

pub static RULE: Rule = Rule {
    name: "zip-sizes",
    section: "2.3",
    says: "an entry has the size in the directory, and above 64 MiB at most 100 times its packed size",
    check: Check::Reading,
};

/// Size above which the compression ratio is checked, and the largest ratio.
const JUDGED_RATIO: u64 = 1 << 26;
const MOST_RATIO: u64 = 100;

pub fn check_sizes(sizes: &[Size], report: &mut Report) {
    for Size { path, said, packed, unpacked } in sizes {
        if said != unpacked {
            let wrong = format!("the directory states {said} bytes, but the entry has {unpacked}");
            report.error(Place::file(path), wrong, RULE.says);
        }
        if *unpacked > JUDGED_RATIO && *unpacked > MOST_RATIO * packed {
            let wrong = format!("{unpacked} bytes are packed in {packed}");
            report.error(Place::file(path), wrong, RULE.says);
        }
    }
}
