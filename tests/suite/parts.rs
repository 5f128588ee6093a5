//! Solids of large strain from files: cells of VTK's XML and points with volumes.

use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

use impinge::advice::parse_with_warnings;
use impinge::closed_form::{Rubber, Sides};
use impinge::scene;

use crate::common::{Trial, off};

const LAW: &str = "young = 1e6, poisson = 0.3";

/// A plane mesh: places in mm, cells in VTK's order, and edges with the numbers of their faces.
struct Plan {
    nodes: Vec<[f64; 2]>,
    cells: Vec<[usize; 4]>,
    edges: Vec<([usize; 2], usize)>,
}

const LEFT: usize = 1;
const RIGHT: usize = 2;
const BOTTOM: usize = 5;
const TOP: usize = 6;
const SIDES: usize = 7;
const NAMES: [&str; 8] = ["", "left", "right", "front", "back", "bottom", "top", "sides"];

impl Plan {
    /// A block of cells; `faces` are the numbers of its left, right, bottom and top.
    fn block(count: [usize; 2], faces: [usize; 4], place: impl Fn(f64, f64) -> [f64; 2]) -> Self {
        let [m, n] = count;
        let number = |i: usize, k: usize| i + (m + 1) * k;
        let at = |(i, k): (usize, usize)| place(i as f64 / m as f64, k as f64 / n as f64);
        let all = |m: usize, n: usize| (0..n).flat_map(move |k| (0..m).map(move |i| (i, k)));
        let cell =
            |(i, k)| [number(i, k), number(i + 1, k), number(i + 1, k + 1), number(i, k + 1)];
        let [left, right, bottom, top] = faces;
        // Edges go round the block against the clock.
        let mut edges: Vec<([usize; 2], usize)> = Vec::new();
        edges.extend((0..m).map(|i| ([number(i, 0), number(i + 1, 0)], bottom)));
        edges.extend((0..n).map(|k| ([number(m, k), number(m, k + 1)], right)));
        edges.extend((0..m).map(|i| ([number(i + 1, n), number(i, n)], top)));
        edges.extend((0..n).map(|k| ([number(0, k + 1), number(0, k)], left)));
        Self {
            nodes: all(m + 1, n + 1).map(at).collect(),
            cells: all(m, n).map(cell).collect(),
            edges,
        }
    }

    /// Moves the nodes off the edges, each its own way.
    fn shaken(mut self, by: f64) -> Self {
        let on_edge = |node: usize| self.edges.iter().any(|(ends, _)| ends.contains(&node));
        let inner: Vec<bool> = (0..self.nodes.len()).map(|node| !on_edge(node)).collect();
        for (node, at) in self.nodes.iter_mut().enumerate().filter(|(node, _)| inner[*node]) {
            let part = |n: usize| (n as f64 * 0.618_033_988_749_895).fract() - 0.5;
            *at = [at[0] + by * part(2 * node), at[1] + by * part(2 * node + 1)];
        }
        self
    }

    fn vtu(&self) -> String {
        let nodes = self.nodes.iter().map(|[x, z]| format!("{x:?} 0 {z:?}"));
        let cells = self.cells.iter().map(|c| format!("{} {} {} {}", c[0], c[1], c[2], c[3]));
        let edges = self.edges.iter().map(|(e, _)| format!("{} {}", e[0], e[1]));
        let offsets = (1..=self.cells.len()).map(|n| 4 * n);
        let beyond = (1..=self.edges.len()).map(|n| 4 * self.cells.len() + 2 * n);
        let counts = [self.cells.len(), self.edges.len()];
        vtu(
            nodes.collect(),
            cells.chain(edges).collect(),
            offsets.chain(beyond).collect(),
            [9, 3].iter().zip(counts).flat_map(|(kind, n)| vec![*kind; n]).collect(),
            vec![0; counts[0]]
                .into_iter()
                .chain(self.edges.iter().map(|(_, face)| *face))
                .collect(),
        )
    }

    /// The nodes as points with the integrals of the cells' functions; each edge is half of both ends.
    fn csv(&self) -> String {
        let mut volumes = vec![0.0; self.nodes.len()];
        for cell in &self.cells {
            let corners = cell.map(|node| self.nodes[node]);
            for gauss in 0..4 {
                let part = |bit: usize| {
                    0.5 + (if gauss >> bit & 1 == 1 { 0.5 } else { -0.5 }) / 3f64.sqrt()
                };
                let (u, w) = (part(0), part(1));
                let values = [(1.0 - u) * (1.0 - w), u * (1.0 - w), u * w, (1.0 - u) * w];
                let along = |slopes: [f64; 4]| {
                    [0, 1].map(|a| (0..4).map(|n| slopes[n] * corners[n][a]).sum::<f64>())
                };
                let [a, b] = along([w - 1.0, 1.0 - w, w, -w]);
                let [c, d] = along([u - 1.0, -u, u, 1.0 - u]);
                let area = 0.25 * (a * d - b * c);
                cell.iter().zip(values).for_each(|(&node, value)| volumes[node] += area * value);
            }
        }
        let mut patches: BTreeMap<(usize, usize), [f64; 2]> = BTreeMap::new();
        for (ends, face) in &self.edges {
            let [[x, z], [to_x, to_z]] = ends.map(|node| self.nodes[node]);
            for node in ends {
                let own = patches.entry((*node, *face)).or_default();
                own[0] += 0.5 * (to_z - z);
                own[1] -= 0.5 * (to_x - x);
            }
        }
        let mut text = "x,z,volume,area_x,area_z,face\n".to_owned();
        for (node, [x, z]) in self.nodes.iter().enumerate() {
            let own: Vec<_> = patches.range((node, 0)..(node + 1, 0)).collect();
            if own.is_empty() {
                text += &format!("{x:?},{z:?},{:?},0,0,\n", volumes[node]);
            }
            for (n, ((_, face), [a, b])) in own.into_iter().enumerate() {
                let volume = if n == 0 { volumes[node] } else { 0.0 };
                text += &format!("{x:?},{z:?},{volume:?},{a:?},{b:?},{}\n", NAMES[*face]);
            }
        }
        text
    }
}

fn vtu(
    nodes: Vec<String>,
    cells: Vec<String>,
    offsets: Vec<usize>,
    types: Vec<usize>,
    faces: Vec<usize>,
) -> String {
    let numbers = |all: Vec<usize>| all.iter().map(usize::to_string).collect::<Vec<_>>().join(" ");
    let array = |name: &str, text: String| {
        format!(
            "<DataArray type=\"Float64\" Name=\"{name}\" NumberOfComponents=\"{}\" format=\"ascii\">\n{text}\n</DataArray>\n",
            if name == "points" { 3 } else { 1 }
        )
    };
    format!(
        "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece>\n<Points>{}</Points>\n<Cells>{}{}{}</Cells>\n\
         <CellData>{}</CellData></Piece></UnstructuredGrid></VTKFile>",
        array("points", nodes.join("\n")),
        array("connectivity", cells.join("\n")),
        array("offsets", numbers(offsets)),
        array("types", numbers(types)),
        array("face", numbers(faces))
    )
}

/// A scene of a rubber part from a text, in mm, with further keys of the body; `more` follows.
fn scene(file: &str, text: &str, keys: &str, more: &str) -> String {
    format!(
        "name = \"Part\"\nstop_time = 1.0\nstep = 1e-2\n[body.pad]\nkind = \"solid\"\nstrain = \"finite\"\n\
         initial_temperature = 293.15\n\
         material = {{ model = \"neo_hookean\", density = 1000.0, specific_heat = 1900.0, conductivity = 0.2, {LAW} }}\n\
         shape = {{ part = {{ file = \"{file}\", unit = \"1 mm\" }} }}\n{keys}\n{more}\n[files]\n\"{file}\" = '''\n{text}'''\n"
    )
}

fn probe(name: &str, at: [f64; 3], gives: &str) -> String {
    format!("[[probe]]\nname = \"{name}\"\nin = \"pad\"\nat = {at:?}\ngives = [{gives}]\n")
}

/// The files of a plan with the methods that take them.
fn files(plan: &Plan) -> Vec<(&'static str, String, &'static str)> {
    let vtu = plan.vtu();
    let of = |method: &'static str| ("part.vtu", vtu.clone(), method);
    let mut all: Vec<_> = ["fem", "rkpm", "efg", "sph"].map(of).into();
    all.push(("part.csv", plan.csv(), "sph"));
    all
}

/// Uniform tension of disordered cells and points: stress, extents, mass and the sum of the forces.
#[test]
fn uniform_stress_is_exact_on_disordered_parts() {
    let law = Rubber::of_young(1e6, 0.3);
    let place = |u: f64, w: f64| [8.0 * u, 6.0 * w];
    let plan = Plan::block([8, 6], [LEFT, RIGHT, BOTTOM, TOP], place).shaken(0.4);
    for (file, text, method) in files(&plan) {
        let keys = format!(
            "dimension = 2\nmechanics = \"{method}\"\nfaces = {{ left = {{ roller = true }}, bottom = {{ roller = true }}, \
             top = {{ traction = [0.0, 0.0, 0.0] }} }}"
        );
        let inside = [[2e-3, 0.0, 2.3e-3], [5.1e-3, 0.0, 4.4e-3], [7.6e-3, 0.0, 5.8e-3]];
        let probes: String = inside
            .iter()
            .enumerate()
            .map(|(n, at)| probe(&format!("p{n}"), *at, "\"stress\", \"displacement\""))
            .collect();
        let mut trial = Trial::new(&scene(file, &text, &keys, &probes));
        assert!(off(trial.get("pad.mass"), 1000.0 * 48e-6) < 1e-12, "{file} {method}");
        for traction in [3e5, -1e5] {
            trial.set("pad.top.traction_z", traction);
            trial.step(1.0);
            let stretch = trial.get("pad.height") / 6e-3;
            let lateral = law.lateral(stretch, Sides::OneHeld);
            let force = off(law.force(stretch, Sides::OneHeld), traction);
            let width = off(trial.get("pad.width"), 8e-3 * lateral);
            println!("{file} {method} {traction}: force {force:e}, width {width:e}");
            assert!(force < 1e-9 && width < 1e-9, "{file} {method}: {force:e} {width:e}");
            for (n, at) in inside.iter().enumerate() {
                let stress = trial.get(&format!("p{n}.stress_zz"));
                assert!(off(stress, traction / lateral) < 1e-9, "{file} {method}: {stress}");
                let across = trial.get(&format!("p{n}.stress_xx"));
                assert!(across.abs() < 1e-9 * traction.abs(), "{file} {method}: {across}");
                let rise = trial.get(&format!("p{n}.displacement_z"));
                assert!((rise - at[2] * (stretch - 1.0)).abs() < 1e-11, "{file} {method}: {rise}");
            }
        }
    }
}

/// Hexahedra and points in space under uniform tension.
#[test]
fn uniform_stress_is_exact_in_space() {
    let law = Rubber::of_young(1e6, 0.3);
    const N: usize = 3;
    let size = N + 1;
    let part = |n: usize| (n as f64 * 0.618_033_988_749_895).fract() - 0.5;
    let places: Vec<[f64; 3]> = (0..size.pow(3))
        .map(|n| {
            let own = [n % size, n / size % size, n / size / size];
            let is_inside = own.iter().all(|&i| i > 0 && i < N);
            let shift = |a: usize| if is_inside { 0.3 * part(3 * n + a) } else { 0.0 };
            [0, 1, 2].map(|a| own[a] as f64 + shift(a))
        })
        .collect();
    let number = |[i, j, k]: [usize; 3]| i + size * (j + size * k);
    const ROUND: [[usize; 2]; 4] = [[0, 0], [1, 0], [1, 1], [0, 1]];
    let mut cells = Vec::new();
    for n in 0..N.pow(3) {
        let own = [n % N, n / N % N, n / N / N];
        let at = |level: usize| {
            ROUND.map(|[i, j]| number([own[0] + i, own[1] + j, own[2] + level]).to_string())
        };
        cells.push([at(0).join(" "), at(1).join(" ")].join(" "));
    }
    let count = cells.len();
    let nodes = places.iter().map(|[x, y, z]| format!("{x:?} {y:?} {z:?}")).collect();
    let offsets = (1..=count).map(|n| 8 * n).collect();
    let text = vtu(nodes, cells, offsets, vec![12; count], vec![0; count]);
    let text = text.replace("Name=\"face\"", "Name=\"other\"");
    let mut csv = "x;y;z;volume;area_x;area_y;area_z;face\n".to_owned();
    for (n, [x, y, z]) in places.iter().enumerate() {
        let own = [n % size, n / size % size, n / size / size];
        let share = |a: usize| if own[a] == 0 || own[a] == N { 0.5 } else { 1.0 };
        let volume: f64 = (0..3).map(share).product();
        let mut line = |volume: f64, area: [f64; 3], face: &str| {
            let [a, b, c] = area;
            csv += &format!("{x:?};{y:?};{z:?};{volume};{a};{b};{c};{face}\n");
        };
        let faces = [["left", "right"], ["front", "back"], ["bottom", "top"]];
        let mut is_first = true;
        for axis in (0..3).filter(|&axis| own[axis] == 0 || own[axis] == N) {
            let end = usize::from(own[axis] == N);
            let mut area = [0.0; 3];
            let across: f64 = (0..3).filter(|&a| a != axis).map(share).product();
            area[axis] = if end == 1 { across } else { -across };
            line(if is_first { volume } else { 0.0 }, area, faces[axis][end]);
            is_first = false;
        }
        if is_first {
            line(volume, [0.0; 3], "");
        }
    }
    // Particles take the volume of a distorted hexahedron from one point an eighth.
    for (file, text, method, tolerance) in [
        ("part.vtu", &text, "fem", 1e-8),
        ("part.vtu", &text, "rkpm", 1e-8),
        ("part.vtu", &text, "sph", 1e-5),
        ("part.csv", &csv, "sph", 1e-8),
    ] {
        let keys = format!(
            "mechanics = \"{method}\"\nfaces = {{ left = {{ roller = true }}, front = {{ roller = true }}, \
             bottom = {{ roller = true }}, top = {{ traction = [0.0, 0.0, 2e5] }} }}"
        );
        let mut trial = Trial::new(&scene(file, text, &keys, ""));
        trial.step(1.0);
        let stretch = trial.get("pad.height") / 3e-3;
        let force = off(law.force(stretch, Sides::Free), 2e5);
        let width = off(trial.get("pad.width"), 3e-3 * law.lateral(stretch, Sides::Free));
        println!("{file} {method}: force {force:e}, width {width:e}");
        assert!(force.max(width) < tolerance, "{file} {method}: {force:e} {width:e}");
        let mass = off(trial.get("pad.mass"), 1000.0 * 27e-9);
        assert!(mass < tolerance, "{file} {method}: {mass:e}");
    }
}

/// A box and the part of the same cells are the same body, to rounding; the part of its points is so to the error of
/// the method.
#[test]
fn parts_with_the_cells_of_a_box_agree_with_it() {
    let place = |u: f64, w: f64| [-10.0 + 20.0 * u, -8.0 + 8.0 * w];
    let plan = Plan::block([20, 8], [LEFT, RIGHT, BOTTOM, TOP], place);
    for method in ["fem", "rkpm", "sph"] {
        let keys = format!(
            "dimension = 2\nsymmetry = \"none\"\nmechanics = \"{method}\"\ngravity = 50.0\n\
             faces = {{ left = {{ clamped = true }}, right = {{ traction = [0.0, 0.0, 2e3] }} }}"
        );
        let tip = probe("tip", [10e-3, 0.0, -4e-3], "\"displacement\"");
        let run = |text: &str| {
            let mut trial = Trial::new(text);
            trial.step(1.0);
            ["pad.stored", "pad.max_von_mises", "tip.displacement_z"].map(|name| trial.get(name))
        };
        let own = scene("part.vtu", &plan.vtu(), &keys, &tip);
        let shape = "shape = { part = { file = \"part.vtu\", unit = \"1 mm\" } }";
        let same = "shape = { box = [20e-3, 1.0, 8e-3] }\nmesh = { spacing = 1e-3 }";
        let as_box = own[..own.find("[files]").unwrap()].replace(shape, same);
        let (part, body) = (run(&own), run(&as_box));
        for (a, b) in part.into_iter().zip(body) {
            assert!(off(a, b) < 1e-9, "{method}: {part:?} {body:?}");
        }
        if method == "sph" {
            let points = run(&scene("part.csv", &plan.csv(), &keys, &tip));
            println!("points {points:?}, box {body:?}");
            assert!(off(points[0], body[0]) < 0.03 && off(points[2], body[2]) < 0.03, "{points:?}");
        }
    }
}

/// A quarter of a pipe under a small pressure inside, by Lamé: errors of both displacements fall with the spacing.
#[test]
fn pipes_follow_lame() {
    let [inner, outer] = [10.0, 20.0];
    let (young, poisson, pressure) = (1e6, 0.3, 10.0);
    let exact = |r: f64| {
        let factor =
            (1.0 + poisson) * pressure * inner * inner / (young * (outer * outer - inner * inner));
        1e-3 * factor * ((1.0 - 2.0 * poisson) * r + outer * outer / r)
    };
    let errors = |count: usize, file: &str, method: &str| {
        // Exact zeros on both planes of symmetry.
        let turned = |w: f64| match w {
            0.0 => [1.0, 0.0],
            1.0 => [0.0, 1.0],
            _ => [(FRAC_PI_2 * w).cos(), (FRAC_PI_2 * w).sin()],
        };
        let place = |u: f64, w: f64| turned(w).map(|x| x * (inner + u * (outer - inner)));
        let plan = Plan::block([count, 2 * count], [SIDES, RIGHT, BOTTOM, LEFT], place);
        let keys = format!(
            "dimension = 2\nmechanics = \"{method}\"\nfaces = {{ left = {{ roller = true }}, bottom = {{ roller = true }}, \
             sides = {{ pressure = {pressure:?} }} }}"
        );
        let probes = probe("inner", [10e-3, 0.0, 0.0], "\"displacement\"")
            + &probe("outer", [0.0, 0.0, 20e-3], "\"displacement\"");
        let text = if file == "part.vtu" { plan.vtu() } else { plan.csv() };
        let mut trial = Trial::new(&scene(file, &text, &keys, &probes));
        trial.step(1.0);
        let [a, b] = [("inner.displacement_x", inner), ("outer.displacement_z", outer)]
            .map(|(name, r)| (trial.get(name) / exact(r) - 1.0).abs());
        a.max(b)
    };
    for (file, method, counts, most, least_order) in [
        ("part.vtu", "fem", [4, 8], 5e-3, 1.8),
        ("part.vtu", "rkpm", [4, 8], 5e-3, 1.6),
        ("part.csv", "sph", [6, 12], 3e-2, 0.8),
    ] {
        let found = counts.map(|count| errors(count, file, method));
        let order = (found[0] / found[1]).log2();
        println!("{file} {method} {counts:?}: {found:?}, order {order:.2}");
        assert!(found[1] < most && order > least_order, "{file} {method}: {found:?} {order}");
    }
}

/// A bracket that no other shape makes hangs by its face: the force there is its weight, and moving it as a whole
/// stresses nothing.
#[test]
fn a_bracket_weighs_what_it_should() {
    // Three squares in an L, 4 × 4 cells each.
    let mut plan = Plan::block([8, 8], [0; 4], |u, w| [20.0 * u, 20.0 * w]);
    plan.cells.retain(|cell| {
        let middle = [0, 1].map(|a| cell.iter().map(|&n| plan.nodes[n][a]).sum::<f64>() / 4.0);
        !(middle[0] > 10.0 && middle[1] > 10.0)
    });
    let used: Vec<usize> =
        (0..plan.nodes.len()).filter(|n| plan.cells.iter().any(|cell| cell.contains(n))).collect();
    let new = |node: usize| used.binary_search(&node).unwrap();
    plan.nodes = used.iter().map(|&node| plan.nodes[node]).collect();
    plan.cells = plan.cells.iter().map(|cell| cell.map(new)).collect();
    let mut count: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    let around = |cell: &[usize; 4]| [0, 1, 2, 3].map(|n| [cell[n], cell[(n + 1) % 4]]);
    for [a, b] in plan.cells.iter().flat_map(around) {
        *count.entry([a.min(b), a.max(b)]).or_default() += 1;
    }
    let outer =
        plan.cells.iter().flat_map(around).filter(|&[a, b]| count[&[a.min(b), a.max(b)]] == 1);
    let face = |[a, b]: [usize; 2]| {
        let is_top = [a, b].iter().all(|&node| plan.nodes[node][1] == 20.0);
        if is_top { TOP } else { 0 }
    };
    plan.edges = outer.map(|ends| (ends, face(ends))).collect();
    let mass = 1000.0 * 300e-6;
    for (file, text, method) in files(&plan) {
        let keys = format!("dimension = 2\nmechanics = \"{method}\"\n");
        let held = "gravity = 9.81\nfaces = { top = { displacement = [0.0, 0.0, 0.0] } }";
        let mut trial = Trial::new(&scene(file, &text, &(keys.clone() + held), ""));
        trial.step(1.0);
        assert!(off(trial.get("pad.mass"), mass) < 1e-12);
        let force = trial.get("pad.top.force_z");
        assert!(off(force, 9.81 * mass) < 1e-9, "{file} {method}: {force}");
        // It falls freely without deformation.
        let free =
            "inertia = true\ngravity = 9.81\nstart = { velocity = [0.3, 0.0, -0.2], height = 0.1 }";
        let mut trial = Trial::new(&scene(file, &text, &(keys + free), ""));
        trial.step(1e-3);
        let [x, z] = ["x", "z"].map(|axis| trial.get(&format!("pad.momentum_{axis}")));
        assert!(off(x, 0.3 * mass) < 1e-11 && off(z, -(0.2 + 9.81e-3) * mass) < 1e-11, "{x} {z}");
        assert!(trial.get("pad.max_von_mises") < 1e-4, "{file} {method}");
    }
}

/// Requests that a part's file, method or faces do not allow are refused at their place in the scene.
#[test]
fn parts_that_cannot_be_modelled_are_refused() {
    let plan = Plan::block([4, 4], [0, RIGHT, BOTTOM, 0], |u, w| [4.0 * u, 4.0 * w]);
    let slanted = Plan::block([4, 4], [0, RIGHT, BOTTOM, 0], |u, w| [4.0 * u + w, 4.0 * w]);
    let held = "dimension = 2\nfaces = { bottom = { clamped = true } }";
    let says = |text: &str| scene::parse(text, "s.toml").unwrap_err().to_string();
    let vtu = |plan: &Plan, keys: &str| says(&scene("part.vtu", &plan.vtu(), keys, ""));
    for (keys, message) in [
        ("dimension = 2\nfaces = { top = { clamped = true } }", "no face `top`"),
        (
            "dimension = 2\nmesh = { spacing = 1e-3 }\nfaces = { bottom = { clamped = true } }",
            "that of the file",
        ),
        (
            "symmetry = \"quarter\"\ndimension = 2\nfaces = { bottom = { clamped = true } }",
            "as the file has it",
        ),
        ("faces = { bottom = { clamped = true } }", "part.vtu:"),
    ] {
        let found = vtu(&plan, keys);
        assert!(found.contains(message), "{found}");
    }
    let right = "dimension = 2\nmechanics = \"rkpm\"\nfaces = { right = { clamped = true } }";
    assert!(vtu(&slanted, right).contains("slip between nodes"));
    let roller =
        "dimension = 2\nfaces = { right = { roller = true }, bottom = { clamped = true } }";
    assert!(vtu(&slanted, roller).contains("no normal along an axis"));
    let text = scene("part.csv", &plan.csv(), held, "");
    assert!(says(&text).contains("points have no elements"), "{}", says(&text));
    let kernels = scene("part.csv", &plan.csv(), &format!("{held}\nmechanics = \"rkpm\""), "");
    assert!(says(&kernels).contains("which points do not have"), "{}", says(&kernels));
    let text = scene("part.vtu", &plan.vtu(), held, "");
    assert!(says(&text[..text.find("[files]").unwrap()]).contains("has no text of the file"));
    let other = text.replace("part.vtu", "part.stl");
    assert!(says(&other).contains("another kind of file"));
    let outside =
        text.replace("[files]", &(probe("p", [5e-3, 0.0, 1e-3], "\"stress\"") + "[files]"));
    assert!(says(&outside).contains("outside of `pad`"), "{}", says(&outside));
}

/// Particles of uneven parts bend about as those of a lattice, whatever their support: beside a face that a single row
/// lies behind, its unevenness is no second derivative. Cantilevers of 50 mm by 10 mm, 8 cells across, under a small
/// load, beside beam theory.
#[test]
fn particles_of_uneven_parts_do_not_stiffen() {
    let (length, height, load) = (50.0, 10.0, 20.0);
    let bent =
        4.0 * load * (length * 1e-3_f64).powi(3) / (1e6 / 0.91 * (height * 1e-3_f64).powi(2));
    let sheared = 1.2 * load * length * 1e-3 / (1e6 / 2.6);
    // Distances across grow from both faces to the middle.
    let graded = |growth: f64| {
        let widths: Vec<f64> = (0..8).map(|n: i32| growth.powi(n.min(7 - n))).collect();
        let whole: f64 = widths.iter().sum();
        let levels: Vec<f64> = (0..=8).map(|n| widths[..n].iter().sum::<f64>() / whole).collect();
        move |u: f64, w: f64| [length * u, height * levels[(8.0 * w).round() as usize]]
    };
    let mut cases: Vec<(f64, f64, f64)> = Vec::new();
    cases.extend([1e-3, 0.01, 0.1, 0.2].map(|shake| (1.0, shake, 1.8)));
    cases.extend([1.3, 1.5].map(|growth| (growth, 1e-3, 2.2)));
    for (growth, shake, support) in cases {
        let plan = Plan::block([40, 8], [LEFT, RIGHT, BOTTOM, TOP], graded(growth)).shaken(shake);
        for (file, text) in [("part.vtu", plan.vtu()), ("part.csv", plan.csv())] {
            let keys = format!(
                "dimension = 2\nmechanics = \"sph\"\nsph = {{ support = {support:?} }}\n\
                 faces = {{ left = {{ clamped = true }}, right = {{ traction = [0.0, 0.0, 0.0] }} }}"
            );
            let at = probe("end", [length * 1e-3, 0.0, 0.5 * height * 1e-3], "\"displacement\"");
            let mut trial = Trial::new(&scene(file, &text, &keys, &at));
            trial.set("pad.right.traction_z", load);
            trial.step(1.0);
            let found = trial.get("end.displacement_z") / (bent + sheared) - 1.0;
            println!("{file} growth {growth}, shaken {shake}, support {support}: {found}");
            assert!(found.abs() < 0.12, "{file} {growth} {shake} {support}: {found}");
        }
    }
}

/// The forces of particles balance in bodies that are hundreds of distances long, too: bars are drawn as in closed
/// form.
#[test]
fn long_bodies_of_particles_balance() {
    let law = Rubber::of_young(1e6, 0.3);
    for [across, along] in [[8, 600], [32, 320]] {
        let size = format!("[{:?}, 1.0, {:?}]", 1e-3 * f64::from(along), 1e-3 * f64::from(across));
        let text = format!(
            "name = \"Bar\"\nstop_time = 1.0\nstep = 1.0\n[body.pad]\nkind = \"solid\"\nstrain = \"finite\"\n\
             initial_temperature = 293.15\nmechanics = \"sph\"\ndimension = 2\n\
             material = {{ model = \"neo_hookean\", density = 1000.0, specific_heat = 1900.0, conductivity = 0.2, {LAW} }}\n\
             shape = {{ box = {size} }}\nmesh = {{ spacing = 1e-3 }}\nsymmetry = \"none\"\n\
             faces = {{ left = {{ roller = true }}, bottom = {{ roller = true }}, right = {{ traction = [0.0, 0.0, 0.0] }} }}\n"
        );
        let mut trial = Trial::new(&text);
        trial.set("pad.right.traction_x", 1e5);
        trial.step(1.0);
        let stretch = trial.get("pad.width") / (1e-3 * f64::from(along));
        let found = law.force(stretch, Sides::OneHeld);
        assert!(off(found, 1e5) < 1e-7, "{across} {along}: {found}");
    }
}

/// Wide supports of particles and of kernels with Gauss points soften uneven parts, and are warned of there alone.
#[test]
fn wide_supports_of_parts_are_warned_of() {
    let place = |u: f64, w: f64| [8.0 * u, 6.0 * w];
    let plan = Plan::block([8, 6], [LEFT, RIGHT, BOTTOM, TOP], place).shaken(0.4);
    let faces = "faces = { left = { clamped = true } }";
    for (keys, wanted) in [
        ("mechanics = \"sph\"", false),
        ("mechanics = \"sph\"\nsph = { support = 3.0 }", true),
        ("mechanics = \"rkpm\"\nrkpm = { support = 5.0, integration = \"gauss\" }", true),
        ("mechanics = \"rkpm\"\nrkpm = { support = 5.0 }", false),
    ] {
        let text = scene("part.vtu", &plan.vtu(), &format!("dimension = 2\n{keys}\n{faces}"), "");
        let (_, found) = parse_with_warnings(&text, "scene.toml").unwrap();
        let told = found.iter().any(|warning| warning.finding().id == "supports_soften");
        assert_eq!(told, wanted, "{keys}");
    }
}
