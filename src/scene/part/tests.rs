//! Files describe the bodies that they seem to, and what they do not describe is refused at its line.

use super::*;

fn part(file: &str, keys: &str) -> Part {
    toml::from_str(&format!("file = \"{file}\"\n{keys}")).unwrap()
}

fn read(file: &str, keys: &str, text: &str, form: Form) -> Result<PartBody, BadPart> {
    let mut part = part(file, keys);
    part.read(text, form);
    part.content.as_ref().unwrap().as_ref().clone()
}

/// A square of 2 × 2 cells with its bottom named, as VTK writes it.
fn square() -> String {
    let point = |n: usize| format!("{} {} 0", n % 3, n / 3);
    let points: Vec<String> = (0..9).map(point).collect();
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\">\n<UnstructuredGrid>\n\
         <Piece NumberOfPoints=\"9\" NumberOfCells=\"6\">\n<Points>\n\
         <DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n{}\n</DataArray>\n</Points>\n<Cells>\n\
         <DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n\
         0 1 4 3\n1 2 5 4\n3 4 7 6\n4 5 8 7\n0 1\n1 2\n</DataArray>\n\
         <DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">4 8 12 16 18 20</DataArray>\n\
         <DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">\n9\n9\n9\n9\n3\n3\n</DataArray>\n</Cells>\n\
         <CellData>\n<DataArray type=\"Int32\" Name=\"face\" format=\"ascii\">\n0 0 0 0 5 5\n</DataArray>\n</CellData>\n\
         </Piece>\n</UnstructuredGrid>\n</VTKFile>\n",
        points.join("\n")
    )
}

const KEYS: &str = "unit = 1e-3\naxes = \"xy\"";

#[test]
fn cells_make_a_mesh_with_the_named_faces() {
    let Ok(PartBody::Cells(mesh)) = read("a.vtu", KEYS, &square(), Form::Plane) else { panic!() };
    assert_eq!((mesh.nodes.len(), mesh.cells.len(), mesh.faces.len()), (9, 4, 8));
    assert_eq!(mesh.nodes[8], [2e-3, 0.0, 2e-3]);
    assert_eq!(mesh.cells[0], [0, 1, 3, 4]);
    let of = |side: Side| mesh.faces.iter().filter(|(own, _)| *own == side).count();
    assert_eq!([Side::Bottom, Side::Free, Side::Top].map(of), [2, 6, 0]);
    assert_eq!(mesh.plane_of(Side::Bottom), Some((2, 0.0)));
    // Without names the outermost planes are the faces of a box.
    let text = square().replace("Name=\"face\"", "Name=\"other\"");
    let Ok(PartBody::Cells(mesh)) = read("a.vtu", KEYS, &text, Form::Plane) else { panic!() };
    let of = |side: Side| mesh.faces.iter().filter(|(own, _)| *own == side).count();
    assert_eq!([Side::Left, Side::Right, Side::Bottom, Side::Top].map(of), [2; 4]);
    // About an axis there is no left face.
    let Ok(PartBody::Cells(mesh)) = read("a.vtu", KEYS, &text, Form::Axisymmetric) else {
        panic!()
    };
    assert_eq!(mesh.faces.len(), 6);
}

#[test]
fn cells_that_make_no_body_are_refused_at_their_line() {
    let cases: [(&str, &str, usize, &str); 13] = [
        ("1 1 0", "1 nan 0", 11, "`nan` is not a finite number"),
        ("1 1 0", "1 1 1", 11, "do not lie in one plane"),
        ("2 2 0", "2 2e12 0", 15, "lies at 2e9 m"),
        ("2 0 0", "0 0 0", 9, "at the place of point 0"),
        ("1 1 0", "3 3 0", 30, "folded at a corner"),
        ("0 1 4 3\n", "0 1 4 4\n", 29, "cell 0, a quadrilateral, has 3 points"),
        ("0 1 4 3\n", "0 1 4 30\n", 29, "corners that are no points"),
        ("\n9\n9\n9\n9", "\n9\n9\n9\n5", 32, "of type 5"),
        ("\n9\n9\n9\n9", "\n9\n9\n9\n1", 15, "belongs to no cell"),
        ("0 0 0 0 5 5", "0 0 0 0 5 9", 34, "has the face 9"),
        ("0 0 0 0 5 5", "0 6 0 0 5 5", 30, "cell 1, a quadrilateral, is none of the surface"),
        ("1 2\n</", "1 4\n</", 34, "none of the surface"),
        ("Name=\"types\" format=\"ascii\"", "Name=\"types\" format=\"binary\"", 28, "are `binary`"),
    ];
    for (old, new, line, message) in cases {
        let text = square();
        assert!(text.contains(old), "{old}");
        let bad = read("a.vtu", KEYS, &text.replacen(old, new, 1), Form::Plane).unwrap_err();
        assert!(bad.message.contains(message), "{bad:?}");
        assert_eq!(bad.line, Some(line), "{bad:?}");
    }
    for (old, new, message) in [
        ("type=\"UnstructuredGrid\"", "type=\"PolyData\"", "of the type `PolyData`"),
        ("Name=\"types\"", "Name=\"kinds\"", "no `types`"),
        ("<Points>", "<Points", "no XML"),
    ] {
        let text = square().replacen(old, new, 1);
        let bad = read("a.vtu", KEYS, &text, Form::Plane).unwrap_err();
        assert!(bad.message.contains(message), "{bad:?}");
    }
    let text = square().replace("0 1\n1 2\n</", "0 1\n1 0\n</").replace("5 5\n</", "5 6\n</");
    let bad = read("a.vtu", KEYS, &text, Form::Plane).unwrap_err();
    assert!(bad.message.contains("another name") && bad.line == Some(34), "{bad:?}");
    // Two cells that share no point.
    let apart = square()
        .replace("0 1 4 3\n1 2 5 4\n3 4 7 6\n4 5 8 7", "0 1 4 3\n0 1 4 3\n5 8 7 2\n6 2 5 8");
    assert!(read("a.vtu", KEYS, &apart, Form::Plane).is_err());
}

/// A square of 3 × 3 points in mm; those of the edges have half, those of the corners a quarter of the volume.
fn points() -> String {
    let mut lines = vec!["x, z, volume, area_x, area_z, face".to_owned()];
    for n in 0..9 {
        let (i, k) = (n % 3, n / 3);
        let share = |n: usize| if n == 1 { 1.0 } else { 0.5 };
        let outward = |n: usize| n as f64 - 1.0;
        let (area_x, area_z) = (outward(i) * share(k), outward(k) * share(i));
        let of = |area_x: f64, area_z: f64, volume: f64, face: &str| {
            format!("{i}, {k}, {volume}, {area_x}, {area_z}, {face}")
        };
        let volume = share(i) * share(k);
        let lateral = ["left", "", "right"][i];
        let level = ["bottom", "", "top"][k];
        lines.push(of(area_x, 0.0, volume, lateral));
        if k != 1 {
            lines.push(of(0.0, area_z, 0.0, level));
        }
    }
    lines.join("\n")
}

#[test]
fn points_make_a_body_with_a_surface() {
    let Ok(PartBody::Points(cloud)) = read("a.csv", "unit = 1e-3", &points(), Form::Plane) else {
        panic!("{:?}", read("a.csv", "unit = 1e-3", &points(), Form::Plane))
    };
    assert_eq!((cloud.nodes.len(), cloud.patches.len()), (9, 12));
    assert!((cloud.volumes.iter().sum::<f64>() / 4e-6 - 1.0).abs() < 1e-12);
    let left: f64 = cloud.patches.iter().filter(|p| p.side == Side::Left).map(|p| p.area()).sum();
    assert!((left / 2e-3 - 1.0).abs() < 1e-12);
    let edges = points().replace("volume", "spacing");
    // Spacings are edges: a quarter of one is a sixteenth of the volume.
    let bad = read("a.csv", "unit = 1e-3", &edges, Form::Plane).unwrap_err();
    assert!(bad.message.contains("isolated"), "{bad:?}");
}

#[test]
fn points_that_make_no_body_are_refused_at_their_line() {
    let cases: [(&str, &str, Option<usize>, &str); 13] = [
        ("1, 1, 1, 0, 0, ", "1, 1, nan, 0, 0, ", Some(9), "`nan` is no number"),
        ("1, 1, 1, 0, 0, ", "1, 1, -1, 0, 0, ", Some(9), "is negative"),
        ("1, 1, 1, 0, 0, ", "1e12, 1, 1, 0, 0, ", Some(9), "lies at 1e9 m"),
        ("1, 1, 1, 0, 0, ", "1, 1, 1, 0, 0", Some(9), "5 values"),
        ("1, 1, 1, 0, 0, ", "0, 1, 1, 0, 0, ", Some(9), "of line 8 is at the same place"),
        ("1, 1, 1, 0, 0, ", "1e-9, 1, 1, 0, 0, ", Some(9), "is that of line 8"),
        ("1, 1, 1, 0, 0, ", "1, 1, 0, 0, 0, ", Some(9), "a point without volume"),
        ("1, 1, 1, 0, 0, ", "1, 1, 1, 0, 0, left", Some(9), "no area there"),
        ("1, 1, 1, 0, 0, ", "1, 1, 1, 1, 0, inside", Some(9), "no face `inside`"),
        ("1, 1, 1, 0, 0, ", "9, 9, 1, 0, 0, ", Some(9), "is isolated"),
        ("x, z, volume", "x, y, volume", Some(1), "no column `y`"),
        ("x, z, volume", "x, x, volume", Some(1), "comes twice"),
        ("2, 1, 0.5, 1, 0, right", "2, 1, 0.5, 2, 0, right", None, "do not enclose"),
    ];
    for (old, new, line, message) in cases {
        let text = points();
        assert!(text.contains(old), "{old}\n{text}");
        let bad = read("a.csv", "unit = 1e-3", &text.replacen(old, new, 1), Form::Plane);
        let bad = bad.unwrap_err();
        assert!(bad.message.contains(message), "{bad:?}");
        assert_eq!(bad.line, line, "{bad:?}");
    }
    let bad = read("a.csv", "", "", Form::Plane).unwrap_err();
    assert!(bad.message.contains("no line of names"), "{bad:?}");
    let bad = read("a.csv", "", &points(), Form::Axisymmetric).unwrap_err();
    assert!(bad.message.contains("no meridian section"), "{bad:?}");
}

#[test]
fn carriage_returns_alone_end_lines() {
    let text = points().replace('\n', "\r");
    let own = read("a.csv", "unit = 1e-3", &text, Form::Plane).unwrap();
    assert_eq!(own, read("a.csv", "unit = 1e-3", &points(), Form::Plane).unwrap());
    let bad = read("a.csv", "", &text.replace("1, 1, 1, 0, 0, ", "1, 1, nan, 0, 0, "), Form::Plane);
    assert_eq!(bad.unwrap_err().line, Some(9));
    let text = square().replace('\n', "\r");
    let bad = read("a.vtu", KEYS, &text.replace("1 1 0", "1 nan 0"), Form::Plane).unwrap_err();
    assert_eq!(bad.line, Some(11));
}
