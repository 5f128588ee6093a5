//! The page: a template of HTML, CSS and JavaScript that holds the document and draws it. Nothing of it is loaded from
//! elsewhere.

use super::document::Document;

const TEMPLATE: &str = include_str!("page/page.html");
const STYLE: &str = include_str!("page/page.css");
/// Parts of the script, in the order of their dependence.
const SCRIPT: &[&str] = &[
    include_str!("page/dom.js"),
    include_str!("page/numbers.js"),
    include_str!("page/packed.js"),
    include_str!("page/colours.js"),
    include_str!("page/axes.js"),
    include_str!("page/clock.js"),
    include_str!("page/sketch.js"),
    include_str!("page/map.js"),
    include_str!("page/clip.js"),
    include_str!("page/history.js"),
    include_str!("page/tables.js"),
    include_str!("page/study.js"),
    include_str!("page/page.js"),
];

/// Returns the page of a document.
pub fn page(document: &Document) -> Result<String, serde_json::Error> {
    let data = embedded(&serde_json::to_string(document)?);
    let (title, script) = (escaped(&document.title), SCRIPT.concat());
    let mut html = String::with_capacity(TEMPLATE.len() + data.len() + script.len() + STYLE.len());
    // Filled from left to right, so that no text that is put in is taken for a place.
    let mut rest = TEMPLATE;
    let places = [
        ("{{title}}", &*title),
        ("{{style}}", STYLE),
        ("{{data}}", &data),
        ("{{script}}", &script),
    ];
    for (place, text) in places {
        if let Some((before, after)) = rest.split_once(place) {
            html.push_str(before);
            html.push_str(text);
            rest = after;
        }
    }
    html.push_str(rest);
    Ok(html)
}

/// JSON within a script element: no `<` of a text can end that.
fn embedded(json: &str) -> String {
    json.replace('<', "\\u003c")
}

/// A text within HTML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_of_users_never_become_markup() {
        let title = "</title></script><script>alert(1)</script> {{data}} {{script}}";
        let document = Document {
            title: title.to_owned(),
            description: title.to_owned(),
            ..Document::default()
        };
        let html = page(&document).unwrap();
        assert_eq!(html.matches("<script").count(), 2, "the document and the script of the page");
        assert_eq!(html.matches("</script>").count(), 2);
        assert_eq!(
            html.matches("alert(1)").count(),
            3,
            "title, title and description of the document"
        );
        assert!(html.contains("<title>&lt;/title&gt;&lt;/script&gt;"));
    }

    #[test]
    fn nothing_is_loaded_from_elsewhere() {
        let html = page(&Document::default()).unwrap();
        for word in [" src=", "@import", "url(http", "fetch(", "XMLHttpRequest", "import("] {
            assert!(!html.contains(word), "{word}");
        }
        let addresses = html.matches("http://").count() + html.matches("https://").count();
        assert_eq!(addresses, html.matches("http://www.w3.org/2000/svg").count());
        assert!(html.contains("default-src 'none'"));
    }

    #[test]
    fn every_place_of_the_template_is_filled() {
        let html = page(&Document::default()).unwrap();
        assert!(!html.contains("{{"), "a place is left");
    }
}
