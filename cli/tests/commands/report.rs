//! Pages of runs and documents.

use std::fs;

use serde_json::Value;

use super::{DROP, SCENE, Workplace};

impl Workplace {
    /// The document within a page.
    fn document(&self, page: &str) -> Value {
        let html = fs::read_to_string(self.path(page)).unwrap();
        let (_, rest) = html.split_once("id=\"document\">").unwrap();
        serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap()
    }

    /// A scene that takes 0.1 s.
    fn coarse() -> Self {
        let place = Self::new();
        let text =
            SCENE.replace("spacing = 4e-5", "spacing = 1e-4").replace("1e-6\nstep", "3e-7\nstep");
        fs::write(place.path("scene.toml"), text).unwrap();
        place
    }
}

/// Values of an array of a document that was not packed.
fn numbers(array: &Value) -> Vec<f64> {
    array.as_array().unwrap().iter().map(|value| value.as_f64().unwrap()).collect()
}

fn series<'d>(document: &'d Value, name: &str) -> &'d Value {
    let all = document["histories"]["series"].as_array().unwrap();
    all.iter().find(|one| one["name"] == name).unwrap()
}

#[test]
fn numbers_of_the_page_are_those_of_the_run() {
    let place = Workplace::coarse();
    place.call(&["report", "scene.toml", "--out", "run", "--fields-every", "1"]).succeeds();
    let (document, (head, rows)) = (place.document("run/report.html"), place.table("run"));
    let titles = csv::Reader::from_reader(head.as_bytes()).headers().unwrap().clone();
    let of = |title: &str| -> Vec<f64> {
        let column = titles.iter().position(|other| other == title).unwrap();
        rows.iter().map(|row| row[column]).collect()
    };
    let wanted = of("centre.temperature [K]");
    let found = numbers(&series(&document, "centre.temperature")["values"]);
    assert_eq!(found.len(), rows.len());
    for (found, wanted) in found.iter().zip(wanted) {
        assert!((found - wanted).abs() < 1e-6 * wanted, "{found} {wanted}");
    }
    let heat = &document["balances"][0];
    assert!(heat["residual"].as_f64().unwrap() < 1e-9, "{heat}");
    let maps = document["maps"].as_array().unwrap();
    assert_eq!(maps.len(), 2, "the top and a section");
    // The highest packed temperature is that of the body over time.
    let highest = of("plate.max_temperature [K]").into_iter().fold(0.0, f64::max);
    let packed = maps[0]["fields"][0]["values"]["high"].as_f64().unwrap();
    assert!((packed - highest).abs() < 1e-9 * highest, "{packed} {highest}");
    assert_eq!(maps[0]["times"].as_array().unwrap().len(), 4);
}

#[test]
fn folders_and_runs_give_the_same_page() {
    let place = Workplace::coarse();
    place.run(&["--out", "run", "--set", "spot.heat_flux=1e8"]).succeeds();
    place.call(&["report", "run", "-o", "page.html"]).succeeds();
    let document = place.document("page.html");
    let facts = document["source"].as_array().unwrap();
    assert!(facts.iter().any(|fact| fact["text"] == "spot.heat_flux = 1e8"), "{facts:?}");
    let labels: Vec<_> = document["timings"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| one["label"].to_string())
        .collect();
    assert_eq!(labels.len(), 3, "{labels:?}");
    assert_eq!(document["sketches"][0]["views"].as_array().unwrap().len(), 2);
    let shapes = document["sketches"][0]["views"][0]["shapes"].as_array().unwrap();
    for role in ["solid", "load", "probe", "clamped", "face"] {
        assert!(shapes.iter().any(|shape| shape["role"] == role), "{role}");
    }
    let errors = &document["errors"]["bodies"][0];
    assert_eq!(errors["body"], "plate");
}

#[test]
fn warnings_of_a_run_are_reported_with_their_remedies() {
    let place = Workplace::new();
    let text =
        SCENE.replace("spacing = 4e-5", "spacing = 1e-4").replace("1e-6\nstep", "2e-7\nstep");
    fs::write(place.path("scene.toml"), text).unwrap();
    let told = place.call(&["report", "scene.toml", "--out", "run"]).succeeds().stderr();
    let warned = told.lines().filter(|line| line.starts_with("warning: ")).count();
    let warnings = place.document("run/report.html")["warnings"].as_array().unwrap().clone();
    assert_eq!(warnings.len(), warned);
    assert!(warned > 0, "{told}");
    for warning in warnings {
        let [place, message, remedy, id] = ["place", "message", "remedy", "id"]
            .map(|key| warning[key].as_str().unwrap().to_owned());
        let line = format!("warning: {place}: {message}; {remedy} [{id}]\n");
        assert!(told.contains(&line) && !id.is_empty(), "{line}");
    }
}

#[test]
fn droplets_are_shown_by_their_particles() {
    let place = Workplace::new();
    fs::write(place.path("drop.toml"), DROP).unwrap();
    place.call(&["report", "drop.toml", "--out", "run"]).succeeds();
    let document = place.document("run/report.html");
    let clip = &document["clips"][0];
    let counts = numbers(&clip["counts"]);
    assert_eq!(counts.len(), clip["times"].as_array().unwrap().len());
    let bytes = counts.iter().sum::<f64>() * 2.0;
    for array in [&clip["x"], &clip["y"], &clip["fields"][0]["values"]] {
        let letters = array["data"].as_str().unwrap().len() as f64;
        assert_eq!(letters, (bytes / 3.0).ceil() * 4.0);
    }
    let titles: Vec<_> = document["balances"].as_array().unwrap().iter().collect();
    let title =
        |word: &str| titles.iter().find(|one| one["title"].as_str().unwrap().contains(word));
    for word in ["Heat", "Mass", "Momentum"] {
        let residual = title(word).unwrap()["residual"].as_f64().unwrap();
        assert!(residual < 1e-5, "{word}: {residual}");
    }
}

#[test]
fn texts_of_a_scene_are_no_markup_in_its_page() {
    let place = Workplace::coarse();
    let text = fs::read_to_string(place.path("scene.toml")).unwrap();
    let bad = "</script><script>alert(1)</script><img src=x onerror=alert(2)>";
    let text = text.replace("A small plate under a hot spot", bad);
    fs::write(place.path("scene.toml"), text).unwrap();
    place.call(&["report", "scene.toml", "--out", "run"]).succeeds();
    let html = fs::read_to_string(place.path("run/report.html")).unwrap();
    assert_eq!(html.matches("<script").count(), 2);
    assert!(!html.contains("<img"));
    assert_eq!(place.document("run/report.html")["description"], bad);
}

#[test]
fn folders_that_are_none_of_a_run_are_refused() {
    let place = Workplace::coarse();
    fs::create_dir(place.path("empty")).unwrap();
    place.call(&["report", "empty"]).fails(1, &["empty is not the folder of a run", "run.json"]);
    place.run(&["--out", "run", "--fields-every", "0"]).succeeds();
    place.call(&["report", "run", "--until", "1"]).fails(1, &["--until is a setting of a run"]);
    let record = fs::read_to_string(place.path("run/run.json")).unwrap();
    for (from, to, words) in [
        ("\"format\": 1", "\"format\": 7", "format 7"),
        ("\"steps\"", "\"stages\"", "unknown field `stages`"),
    ] {
        fs::write(place.path("run/run.json"), record.replace(from, to)).unwrap();
        place.call(&["report", "run"]).fails(1, &["run.json", words]);
    }
    fs::write(place.path("run/run.json"), &record).unwrap();
    fs::remove_file(place.path("run/outputs.csv")).unwrap();
    place.call(&["report", "run"]).fails(1, &["outputs.csv"]);
}

#[test]
fn interrupted_runs_are_marked() {
    let place = Workplace::coarse();
    place.run(&["--out", "run", "--fields-every", "1"]).succeeds();
    let record = fs::read_to_string(place.path("run/run.json")).unwrap();
    let begun = record.replace("\"is_finished\": true", "\"is_finished\": false");
    fs::write(place.path("run/run.json"), begun).unwrap();
    let table = fs::read_to_string(place.path("run/outputs.csv")).unwrap();
    fs::write(place.path("run/outputs.csv"), &table[..table.len() - 20]).unwrap();
    place.call(&["report", "run"]).succeeds();
    let document = place.document("run/report.html");
    let warnings = document["warnings"].to_string();
    assert!(warnings.contains("the run has not ended"), "{warnings}");
    assert_eq!(numbers(&document["histories"]["axis"]["values"]).len(), 3);
}

#[test]
fn files_that_are_no_pages_of_ours_are_replaced_only_if_asked() {
    let place = Workplace::coarse();
    fs::write(place.path("mine.html"), "mine").unwrap();
    let command = ["report", "scene.toml", "--out", "run", "-o", "mine.html"];
    place.call(&command).fails(1, &["mine.html exists", "--overwrite"]);
    assert!(!place.path("run").exists(), "refused before it runs");
    place.run(&["--out", "run"]).succeeds();
    place.call(&["report", "run"]).succeeds();
    place.call(&["report", "run"]).succeeds();
    place.call(&["report", "run", "-o", "mine.html", "--overwrite"]).succeeds();
    // A new run takes the page of the earlier one away.
    place.run(&["--out", "run", "--overwrite"]).succeeds();
    assert!(!place.path("run/report.html").exists());
}

#[test]
fn documents_of_other_programs_are_drawn_with_their_scenes() {
    let place = Workplace::coarse();
    let scene = fs::read_to_string(place.path("scene.toml")).unwrap();
    let document = serde_json::json!({
        "format": 1,
        "title": "Coupled",
        "scenes": [{ "name": "plate", "text": scene }, { "name": "other", "text": "no scene" }],
        "study": { "columns": [{ "name": "a", "role": "parameter", "values": [1.0, null, "x"] }] },
    });
    fs::write(place.path("page.json"), document.to_string()).unwrap();
    place.call(&["report", "page.json"]).succeeds();
    let found = place.document("page.html");
    assert_eq!(found["sketches"][0]["title"], "plate");
    assert!(found["model"].as_array().unwrap().len() > 1);
    assert!(found["notes"].to_string().contains("scene of other"));
    assert_eq!(found["study"]["columns"][0]["values"], serde_json::json!([1.0, null, "x"]));
    for (text, words) in [
        (r#"{"format": 1, "titel": ""}"#, "unknown field `titel`"),
        (r#"{"format": 2}"#, "format 2"),
        ("{}", "format 0"),
        ("[", "EOF"),
    ] {
        fs::write(place.path("bad.json"), text).unwrap();
        place.call(&["report", "bad.json"]).fails(1, &["bad.json", words]);
    }
}
