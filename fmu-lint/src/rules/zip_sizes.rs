//! Sizes that the directory of the zip file gives, against those that entries have.

use super::{Check, Rule};
use crate::finding::{Place, Report};
use crate::package::Size;

pub static RULE: Rule = Rule {
    name: "zip-sizes",
    section: "2.3",
    says: "an entry has as many bytes as the directory says, and above 64 MiB at most 100 times as many as it is packed in",
    check: Check::Reading,
};

/// Bytes from which on the ratio is judged, and the largest one.
const JUDGED_RATIO: u64 = 1 << 26;
const MOST_RATIO: u64 = 100;

pub fn check_sizes(sizes: &[Size], report: &mut Report) {
    for Size { path, said, packed, unpacked } in sizes {
        if said != unpacked {
            let wrong = format!("the directory says {said} bytes, but there are {unpacked}");
            report.error(Place::file(path), wrong, RULE.says);
        }
        if *unpacked > JUDGED_RATIO && *unpacked > MOST_RATIO * packed {
            let wrong = format!("{unpacked} bytes are packed in {packed}");
            report.error(Place::file(path), wrong, RULE.says);
        }
    }
}
