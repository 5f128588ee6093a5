//! Elements: allowed names, numbers and order.

use roxmltree::Node;

use super::{Check, Rule};
use crate::document::{self, Document};
use crate::finding::Report;
use crate::schema::{Content, Element, Group, ROOT};

pub static RULE: Rule = Rule {
    name: "elements",
    section: "2.2",
    says: "elements are those of the schema, in its order",
    check: Check::Unit(|subject, report| {
        check(subject.document, subject.document.root(), &ROOT, report)
    }),
};

fn check(document: &Document, node: Node, element: &Element, report: &mut Report) {
    let Content::Sequence(groups) = &element.content else { return };
    let mut counts = vec![0; groups.len()];
    let mut reached = 0;
    for child in document::elements(node) {
        let name = child.tag_name().name();
        let Some((at, of)) = find(groups, name) else {
            let wrong = format!("{} has no element {name}", element.name);
            report.error(document.place(child), wrong, order(groups));
            continue;
        };
        counts[at] += 1;
        if at < reached {
            let wrong = format!("{name} stands after {}", names(&groups[reached]));
            report.error(document.place(child), wrong, order(groups));
        } else if counts[at] == groups[at].most.saturating_add(1) {
            let wrong = format!("one {} too many in {}", names(&groups[at]), element.name);
            report.error(document.place(child), wrong, format!("at most {}", groups[at].most));
        }
        reached = reached.max(at);
        check(document, child, of, report);
    }
    for (group, count) in groups.iter().zip(counts) {
        if count < group.least {
            let wrong = format!("{} lacks an element {}", element.name, names(group));
            report.error(document.place(node), wrong, format!("at least {}", group.least));
        }
    }
    if node.children().any(|child| child.is_text() && child.text().is_some_and(is_word)) {
        report.error(document.place(node), format!("{} holds text", element.name), RULE.says);
    }
}

fn is_word(text: &str) -> bool {
    !text.trim().is_empty()
}

/// The group of an element by its name, and the element.
fn find(groups: &'static [Group], name: &str) -> Option<(usize, &'static Element)> {
    let of = |group: &Group| group.any_of.iter().copied().find(|element| element.name == name);
    groups.iter().enumerate().find_map(|(at, group)| Some((at, of(group)?)))
}

fn names(group: &Group) -> String {
    group.any_of.iter().map(|element| element.name).collect::<Vec<_>>().join(" or ")
}

fn order(groups: &[Group]) -> String {
    match groups {
        [] => "no element".into(),
        _ => groups.iter().map(names).collect::<Vec<_>>().join(", then "),
    }
}
