//! Cells of VTK's XML of unstructured grids, as text: quadrilaterals of sections and hexahedra.
//!
//! Cells of one dimension less name faces of the surface by the array `face` of the cells: 1 to 7 are left, right,
//! front, back, bottom, top and sides, 0 is none.

use std::ops::Range;

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use super::{BadPart, FACES, FARTHEST, Part, PartBody, names, place};
use crate::limits::number;
use crate::space::{BadMesh, Form, Mesh, Side};

/// Numbers of an array, each with its place in the text.
struct Array<'a> {
    text: &'a str,
    /// Place of the content within the whole text.
    start: usize,
    components: usize,
}

/// The parts of a file.
#[derive(Default)]
struct Grid<'a> {
    points: Option<Array<'a>>,
    connectivity: Option<Array<'a>>,
    offsets: Option<Array<'a>>,
    types: Option<Array<'a>>,
    faces: Option<Array<'a>>,
    pieces: usize,
}

/// A kind of cell: VTK's number, its words, and the place of each of our corners among its own.
struct Kind {
    number: usize,
    words: &'static str,
    corners: &'static [usize],
}

const VERTEX: usize = 1;
const LINE: Kind = Kind { number: 3, words: "line", corners: &[0, 1] };
const PIXEL: Kind = Kind { number: 8, words: "pixel", corners: &[0, 1, 2, 3] };
const QUAD: Kind = Kind { number: 9, words: "quadrilateral", corners: &[0, 1, 3, 2] };
const VOXEL: Kind = Kind { number: 11, words: "voxel", corners: &[0, 1, 2, 3, 4, 5, 6, 7] };
const HEXAHEDRON: Kind =
    Kind { number: 12, words: "hexahedron", corners: &[0, 1, 3, 2, 4, 5, 7, 6] };

/// Largest part of its extent by which a section leaves its plane.
const FLAT: f64 = 1e-9;

/// Reads the cells of a text.
pub fn read(text: &str, part: &Part, form: Form) -> Result<PartBody, BadPart> {
    let grid = Grid::of(text)?;
    let missing = |name: &str| BadPart::whole(format!("the file has no {name}"), ALLOWED);
    let points = grid.points.as_ref().ok_or_else(|| missing("`Points`"))?;
    let nodes = nodes(text, points, (part, form))?;
    let connectivity = grid.connectivity.as_ref().ok_or_else(|| missing("`connectivity`"))?;
    let offsets = grid.offsets.as_ref().ok_or_else(|| missing("`offsets`"))?;
    let array = grid.types.as_ref().ok_or_else(|| missing("`types`"))?;
    let connectivity = connectivity.whole_numbers(text)?;
    let (offsets, types) = (offsets.whole_numbers(text)?, array.whole_numbers(text)?);
    let faces = grid.faces.as_ref().map(|array| array.whole_numbers(text)).transpose()?;
    let is_paired = types.len() == offsets.len();
    if !is_paired || faces.as_ref().is_some_and(|faces| faces.len() != types.len()) {
        let of_faces = faces.map_or(String::new(), |faces| format!(" and {} faces", faces.len()));
        let message = format!("{} types, {} offsets{of_faces}", types.len(), offsets.len());
        return Err(BadPart::whole(message, "`types`, `offsets` and `face` of all cells"));
    }
    let cells = Cells { text, array, nodes: nodes.len(), connectivity, offsets, types, faces };
    let (inner, named) = cells.sorted(form)?;
    let (own, numbers): (Vec<Vec<u32>>, Vec<usize>) = inner.into_iter().unzip();
    let is_named = cells.faces.is_some();
    let facets: Vec<(Side, Vec<u32>)> =
        named.iter().map(|(side, facet, _)| (*side, facet.clone())).collect();
    let mesh = Mesh::of_cells(form, nodes, own, is_named.then_some(&facets[..]));
    mesh.map(PartBody::Cells).map_err(|bad| {
        let cell = |cell: usize| cells.line_of(numbers[cell]);
        let node = |node: usize| points.line_of(text, points.components * node, points.components);
        let refused = |(line, own): (usize, String), message: &str, allowed: &str| {
            BadPart::at((line, &own), message, allowed)
        };
        match bad {
            BadMesh::Empty => BadPart::whole("the file has no cells of the model", allowed(form)),
            BadMesh::BesideAxis { node: own } => {
                refused(node(own), "the point lies beyond the axis", "x ≥ 0 in a meridian section")
            }
            BadMesh::Unused { node: own } => {
                refused(node(own), "the point belongs to no cell", "points of cells alone")
            }
            BadMesh::Twice { nodes: [a, b] } => {
                let message = format!("the point is at the place of point {a}");
                refused(node(b), &message, "one point a place: cells are joined by their points")
            }
            BadMesh::Folded { cell: own } => refused(
                cell(own),
                "the cell has no volume, or is folded at a corner",
                "corners in VTK's order, with angles below 180°",
            ),
            BadMesh::Crowded { cell: own } => {
                refused(cell(own), "the cell lies where two others meet", "two cells at a facet")
            }
            BadMesh::Apart { cell: own } => {
                refused(cell(own), "the cell hangs together with nothing", "cells of one body")
            }
            BadMesh::Pinched { cell: own } => refused(
                cell(own),
                "the cell shares a part of a facet with others",
                "cells that share whole facets, with the same corners",
            ),
            BadMesh::Renamed { facet } => refused(
                cells.line_of(named[facet].2),
                "the facet has another name, too",
                "one name a facet",
            ),
            BadMesh::Inside { facet } => refused(
                cells.line_of(named[facet].2),
                "a named facet is none of the surface",
                "edges or faces of one cell of the model",
            ),
        }
    })
}

const ALLOWED: &str = "VTK's XML of an unstructured grid";
const AS_TEXT: &str = "format=\"ascii\", numbers as text: `meshio.write(file, mesh, binary=False)`, the data mode `Ascii` of \
                       ParaView";

fn allowed(form: Form) -> String {
    match form {
        Form::Solid => words(&[HEXAHEDRON, VOXEL]),
        Form::Plane | Form::Axisymmetric => words(&[QUAD, PIXEL]),
    }
}

fn words(kinds: &[Kind]) -> String {
    let words = kinds.iter().map(|kind| format!("{} ({})", kind.number, kind.words));
    words.collect::<Vec<_>>().join(", ")
}

/// Places of the points in the model.
fn nodes(
    text: &str,
    points: &Array,
    (part, form): (&Part, Form),
) -> Result<Vec<[f64; 3]>, BadPart> {
    let values = points.numbers(text)?;
    if points.components != 3 || values.len() % 3 != 0 {
        let message = format!("{} coordinates of points", values.len());
        return Err(BadPart::whole(message, "three coordinates each"));
    }
    let all: Vec<[f64; 3]> = values.chunks(3).map(|at| [at[0], at[1], at[2]]).collect();
    let far = |at: &[f64; 3]| at.iter().any(|x| (x * part.unit).abs() > FARTHEST);
    if let Some(node) = all.iter().position(far) {
        let (line, own) = points.line_of(text, 3 * node, 3);
        let largest = all[node].iter().fold(0.0, |most: f64, x| most.max((x * part.unit).abs()));
        let message = format!("the point lies at {} m", number(largest));
        return Err(BadPart::at((line, &own), message, "coordinates of at most 1e6 m"));
    }
    if form != Form::Solid {
        let names = names(part, form);
        let across = if names.contains(&"z") { 1 } else { 2 };
        let extent = all.iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
        let off = |at: &[f64; 3]| (at[across] - all[0][across]).abs() > FLAT * extent;
        if let Some(node) = all.iter().position(off) {
            let (line, own) = points.line_of(text, 3 * node, 3);
            let message = format!(
                "the points of a section do not lie in one plane of {}",
                names.join(" and ")
            );
            return Err(BadPart::at((line, &own), message, "a plane section; `axes` of the part"));
        }
    }
    Ok(all.into_iter().map(|at| place(part, form, at)).collect())
}

impl<'a> Grid<'a> {
    fn of(text: &'a str) -> Result<Self, BadPart> {
        let mut reader = Reader::from_str(text);
        let mut grid = Self::default();
        let mut section = String::new();
        loop {
            let event = reader.read_event();
            let place = (reader.buffer_position() as usize).min(text.len());
            match event {
                Ok(Event::Start(start)) => {
                    let name = start.name().as_ref().to_owned();
                    if name == "DataArray" {
                        grid.add(text, (&start, place), &section)?;
                    } else {
                        section = name;
                        grid.open(text, (&start, place), &section)?;
                    }
                }
                Ok(Event::Eof) => return Ok(grid),
                Ok(_) => {}
                Err(error) => {
                    let (line, own) = line_at(text, place);
                    return Err(BadPart::at((line, own), format!("no XML: {error}"), ALLOWED));
                }
            }
        }
    }

    fn open(
        &mut self,
        text: &str,
        (start, place): (&BytesStart, usize),
        section: &str,
    ) -> Result<(), BadPart> {
        let refused = |message: String, allowed: &str| {
            let (line, own) = line_at(text, place);
            BadPart::at((line, own), message, allowed)
        };
        match section {
            "VTKFile" => {
                let found = attribute(start, "type").unwrap_or_default();
                let message = format!("the file is of the type `{found}`");
                let fine = found == "UnstructuredGrid";
                if fine { Ok(()) } else { Err(refused(message, "type=\"UnstructuredGrid\"")) }
            }
            "Piece" => {
                self.pieces += 1;
                let message = "the grid has several pieces".to_owned();
                if self.pieces == 1 { Ok(()) } else { Err(refused(message, "one `Piece`")) }
            }
            _ => Ok(()),
        }
    }

    fn add(
        &mut self,
        text: &'a str,
        (start, place): (&BytesStart, usize),
        section: &str,
    ) -> Result<(), BadPart> {
        let name = attribute(start, "Name").unwrap_or_default();
        let slot = match (section, name.as_str()) {
            ("Points", _) => &mut self.points,
            ("Cells", "connectivity") => &mut self.connectivity,
            ("Cells", "offsets") => &mut self.offsets,
            ("Cells", "types") => &mut self.types,
            ("CellData", "face") => &mut self.faces,
            _ => return Ok(()),
        };
        let format = attribute(start, "format").unwrap_or_else(|| "ascii".to_owned());
        if format != "ascii" {
            let (line, own) = line_at(text, place);
            let message = format!("the numbers are `{format}`");
            return Err(BadPart::at((line, own), message, AS_TEXT));
        }
        let rest = &text[place..];
        let content = &rest[..rest.find('<').unwrap_or(rest.len())];
        let components = attribute(start, "NumberOfComponents");
        let components = components.and_then(|count| count.parse().ok()).unwrap_or(1);
        *slot = Some(Array { text: content, start: place, components });
        Ok(())
    }
}

fn attribute(start: &BytesStart, name: &str) -> Option<String> {
    let found = start.attributes().flatten().find(|own| own.key.as_ref() == name)?;
    Some(found.value.into_owned())
}

/// Number of a line from 1, and its text.
fn line_at(text: &str, place: usize) -> (usize, &str) {
    let before = text.get(..place).unwrap_or(text);
    let number = before.matches('\n').count();
    (number + 1, text.lines().nth(number).unwrap_or_default())
}

impl Array<'_> {
    fn numbers(&self, text: &str) -> Result<Vec<f64>, BadPart> {
        let number = |word: &str| {
            let found = word.parse::<f64>().ok().filter(|value| value.is_finite());
            found.ok_or_else(|| self.refused(text, word, "a finite number"))
        };
        self.text.split_ascii_whitespace().map(number).collect()
    }

    fn whole_numbers(&self, text: &str) -> Result<Vec<usize>, BadPart> {
        let number = |word: &str| {
            word.parse::<usize>().map_err(|_| self.refused(text, word, "a whole number"))
        };
        self.text.split_ascii_whitespace().map(number).collect()
    }

    fn refused(&self, text: &str, word: &str, allowed: &str) -> BadPart {
        let within = word.as_ptr() as usize - self.text.as_ptr() as usize;
        let (line, _) = line_at(text, self.start + within);
        BadPart::at((line, word), format!("`{word}` is not {allowed}"), allowed)
    }

    /// Line of a number of the array, and the numbers from there on.
    fn line_of(&self, text: &str, first: usize, count: usize) -> (usize, String) {
        let words: Vec<&str> = self.text.split_ascii_whitespace().skip(first).take(count).collect();
        let within = words.first().map_or(0, |w| w.as_ptr() as usize - self.text.as_ptr() as usize);
        (line_at(text, self.start + within).0, words.join(" "))
    }
}

/// The cells of a grid.
struct Cells<'a> {
    text: &'a str,
    /// The array of types.
    array: &'a Array<'a>,
    nodes: usize,
    connectivity: Vec<usize>,
    offsets: Vec<usize>,
    types: Vec<usize>,
    faces: Option<Vec<usize>>,
}

/// Cells of the model with their numbers, and named facets with theirs.
type Sorted = (Vec<(Vec<u32>, usize)>, Vec<(Side, Vec<u32>, usize)>);

impl Cells<'_> {
    /// Sorts the cells of the model from those that name facets.
    fn sorted(&self, form: Form) -> Result<Sorted, BadPart> {
        let (own, facets): (&[Kind], &[Kind]) = match form {
            Form::Solid => (&[HEXAHEDRON, VOXEL], &[QUAD, PIXEL]),
            Form::Plane | Form::Axisymmetric => (&[QUAD, PIXEL], &[LINE]),
        };
        let (mut cells, mut named) = (Vec::new(), Vec::new());
        let mut first = 0;
        for (number, (&kind, &last)) in self.types.iter().zip(&self.offsets).enumerate() {
            let corners = self.corners(number, first..last)?;
            first = last;
            let find = |kinds: &'static [Kind]| kinds.iter().find(|own| own.number == kind);
            if let Some(kind) = find(own) {
                self.name_nothing(number, kind.words, form)?;
                cells.push((self.ordered(number, kind, corners)?, number));
            } else if let Some(kind) = find(facets) {
                if let Some(side) = self.side(number, form)? {
                    named.push((side, self.ordered(number, kind, corners)?, number));
                }
            } else if kind != VERTEX && !(form == Form::Solid && kind == LINE.number) {
                let message = format!("cell {number} is of type {kind}, of which no body is made");
                let allowed = format!("{}; faces of {}", allowed(form), words(facets));
                return Err(self.refused(number, message, allowed));
            } else {
                self.name_nothing(number, "cell of fewer dimensions", form)?;
            }
        }
        Ok((cells, named))
    }

    fn corners(&self, number: usize, places: Range<usize>) -> Result<&[usize], BadPart> {
        let corners = self.connectivity.get(places);
        let corners = corners.filter(|own| own.iter().all(|&node| node < self.nodes));
        corners.ok_or_else(|| {
            let message = format!("cell {number} has corners that are no points");
            self.refused(
                number,
                message,
                format!("offsets that ascend, points below {}", self.nodes),
            )
        })
    }

    fn ordered(&self, number: usize, kind: &Kind, corners: &[usize]) -> Result<Vec<u32>, BadPart> {
        let mut distinct = corners.to_vec();
        distinct.sort_unstable();
        distinct.dedup();
        if corners.len() != kind.corners.len() || distinct.len() != corners.len() {
            let message = format!("cell {number}, a {}, has {} points", kind.words, distinct.len());
            return Err(self.refused(number, message, format!("{}", kind.corners.len())));
        }
        Ok(kind.corners.iter().map(|&place| corners[place] as u32).collect())
    }

    /// Side that a cell names; `None` if it names none.
    fn side(&self, number: usize, form: Form) -> Result<Option<Side>, BadPart> {
        let Some(code) = self.faces.as_ref().map(|faces| faces[number]) else { return Ok(None) };
        if code == 0 {
            return Ok(None);
        }
        let side = FACES.get(code - 1).map(|(_, side)| *side);
        let is_there =
            |side: &Side| form == Form::Solid || !matches!(side, Side::Front | Side::Back);
        side.filter(is_there).map(Some).ok_or_else(|| {
            let message = format!("cell {number} has the face {code}");
            let allowed = "0 (none), 1 (left), 2 (right), 3 (front) and 4 (back) in space, 5 (bottom), 6 (top), 7 (sides)";
            self.refused(number, message, allowed)
        })
    }

    /// Refuses the name of a face on a cell that is none of the surface, where it would be lost.
    fn name_nothing(&self, number: usize, kind: &str, form: Form) -> Result<(), BadPart> {
        let Some(code) = self.faces.as_ref().map(|faces| faces[number]) else { return Ok(()) };
        if code == 0 {
            return Ok(());
        }
        let message =
            format!("cell {number}, a {kind}, is none of the surface and has the face {code}");
        let facets = match form {
            Form::Solid => words(&[QUAD, PIXEL]),
            Form::Plane | Form::Axisymmetric => words(&[LINE]),
        };
        let allowed = format!("0; faces on cells of the surface, {facets}");
        Err(self.refused(number, message, allowed))
    }

    fn refused(
        &self,
        number: usize,
        message: impl Into<String>,
        allowed: impl Into<String>,
    ) -> BadPart {
        let (line, own) = self.line_of(number);
        BadPart::at((line, &own), message, allowed)
    }

    /// Line of the type of a cell, and the points of the cell.
    fn line_of(&self, number: usize) -> (usize, String) {
        let (line, _) = self.array.line_of(self.text, number, 1);
        let first = if number == 0 { 0 } else { self.offsets[number - 1] };
        let own = self.connectivity.get(first..self.offsets[number]).unwrap_or_default();
        let own: Vec<String> = own.iter().map(usize::to_string).collect();
        (line, format!("cell {number}: {}", own.join(" ")))
    }
}
