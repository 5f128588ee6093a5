//! Points as text: a line each, with columns named by the first.
//!
//! A point on the surface has the area vector of its patch, and may have the name of a face. A line whose volume is 0
//! adds a further patch to the point at the same place, as points on edges and corners have.

use std::collections::HashMap;

use super::{BadPart, FACES, FARTHEST, Part, PartBody, names};
use crate::limits::number;
use crate::space::{BadCloud, Cloud, Form, Patch, Side};

/// A line of text with its number from 1.
type Line<'a> = (usize, &'a str);

/// Places of columns in a line.
struct Columns {
    coordinates: Vec<usize>,
    size: usize,
    /// True for volumes, false for edges of squares or cubes.
    is_volume: bool,
    areas: Option<Vec<usize>>,
    face: Option<usize>,
    count: usize,
    separator: char,
}

/// Points while they are read.
#[derive(Default)]
struct Points<'a> {
    nodes: Vec<[f64; 3]>,
    volumes: Vec<f64>,
    patches: Vec<Patch>,
    lines: Vec<Line<'a>>,
    known: HashMap<[u64; 3], u32>,
}

/// Reads the points of a text.
pub fn read(text: &str, part: &Part, form: Form) -> Result<PartBody, BadPart> {
    if form == Form::Axisymmetric {
        let message = "points have no meridian section: their cells would have to end at the axis";
        return Err(BadPart::whole(message, "a `.vtu` file with cells"));
    }
    let lines = text.lines().enumerate().map(|(n, line)| (n + 1, line));
    let mut lines = lines.filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('#'));
    let Some(header) = lines.next() else {
        return Err(BadPart::whole("the file has no line of names", allowed_columns(part, form)));
    };
    let columns = Columns::of(header, part, form)?;
    let mut points = Points::default();
    for line in lines {
        points.read(line, &columns, (part, form))?;
    }
    points.finish(form).map(PartBody::Points)
}

fn allowed_columns(part: &Part, form: Form) -> String {
    let names = names(part, form);
    let areas: Vec<String> = names.iter().map(|name| format!("area_{name}")).collect();
    format!("{}, volume or spacing, {}, face", names.join(", "), areas.join(", "))
}

impl Columns {
    fn of(header: Line, part: &Part, form: Form) -> Result<Self, BadPart> {
        let (_, text) = header;
        let separator = if text.contains(';') { ';' } else { ',' };
        let found: Vec<String> =
            text.split(separator).map(|name| name.trim().to_lowercase()).collect();
        let names = names(part, form);
        let areas: Vec<String> = names.iter().map(|name| format!("area_{name}")).collect();
        let is_known = |name: &str| {
            names.contains(&name)
                || ["volume", "spacing", "face"].contains(&name)
                || areas.iter().any(|area| area == name)
        };
        let refused = |message: String| BadPart::at(header, message, allowed_columns(part, form));
        for (n, name) in found.iter().enumerate() {
            if !is_known(name) {
                return Err(refused(format!("there is no column `{name}`")));
            }
            if found[..n].contains(name) {
                return Err(refused(format!("the column `{name}` comes twice")));
            }
        }
        let find = |name: &str| found.iter().position(|own| own == name);
        let missing = |name: &str| refused(format!("the column `{name}` is missing"));
        let coordinates = names.iter().map(|name| find(name).ok_or_else(|| missing(name)));
        let coordinates = coordinates.collect::<Result<_, _>>()?;
        let (size, is_volume) = match (find("volume"), find("spacing")) {
            (Some(place), None) => (place, true),
            (None, Some(place)) => (place, false),
            (None, None) => return Err(missing("volume")),
            _ => return Err(refused("volumes follow from `spacing`".to_owned())),
        };
        let own: Vec<usize> = areas.iter().filter_map(|name| find(name)).collect();
        let face = find("face");
        let areas = match own.len() {
            0 => None,
            count if count == areas.len() => Some(own),
            _ => return Err(refused("an area vector has all components".to_owned())),
        };
        if areas.is_none() {
            let message = "without the areas of the surface no force balances at it";
            return Err(refused(message.to_owned()));
        }
        Ok(Self { coordinates, size, is_volume, areas, face, count: found.len(), separator })
    }
}

impl<'a> Points<'a> {
    fn read(
        &mut self,
        line: Line<'a>,
        columns: &Columns,
        (part, form): (&Part, Form),
    ) -> Result<(), BadPart> {
        let values: Vec<&str> = line.1.split(columns.separator).map(str::trim).collect();
        if values.len() != columns.count {
            let message = format!("the line has {} values", values.len());
            return Err(BadPart::at(line, message, format!("{} values", columns.count)));
        }
        let value = |place: usize| {
            let found = values[place].parse::<f64>().ok().filter(|value| value.is_finite());
            let message = || format!("`{}` is no number", values[place]);
            found.ok_or_else(|| BadPart::at(line, message(), "a finite number"))
        };
        let vector = |places: &[usize], factor: f64| -> Result<[f64; 3], BadPart> {
            let mut own = [0.0; 3];
            for (n, &place) in places.iter().enumerate() {
                own[if form == Form::Solid || n == 0 { n } else { 2 }] = factor * value(place)?;
            }
            Ok(own)
        };
        let at = vector(&columns.coordinates, part.unit)?;
        if let Some(far) = at.into_iter().find(|x| x.abs() > FARTHEST) {
            let message = format!("the point lies at {} m", number(far));
            return Err(BadPart::at(line, message, "coordinates of at most 1e6 m"));
        }
        let dimension = form.axes().len() as i32;
        let size = value(columns.size)?;
        let volume = match columns.is_volume {
            true => size * part.unit.powi(dimension),
            false => size.abs().powi(dimension) * size.signum() * part.unit.powi(dimension),
        };
        if volume < 0.0 || size < 0.0 {
            let message = format!("`{}` is negative", values[columns.size]);
            return Err(BadPart::at(line, message, "> 0; 0 for a further patch of a point"));
        }
        let node = self.node(line, at, volume)?;
        let Some(areas) = &columns.areas else { return Ok(()) };
        let area = vector(areas, part.unit.powi(dimension - 1))?;
        let name = columns.face.map_or("", |place| values[place]);
        let side = side(line, name, form)?;
        let is_surface = area.iter().any(|x| *x != 0.0);
        if side != Side::Free && !is_surface {
            let message = format!("the point on `{name}` has no area there");
            return Err(BadPart::at(line, message, "an area vector along the outward normal"));
        }
        if is_surface {
            self.patches.push(Patch { node, side, vector: area });
        }
        Ok(())
    }

    /// Number of the point of a line: a new one, or the one at the same place if it has no volume.
    fn node(&mut self, line: Line<'a>, at: [f64; 3], volume: f64) -> Result<u32, BadPart> {
        // Zeros of both signs are one place.
        let key = at.map(|x| (x + 0.0).to_bits());
        let known = self.known.get(&key).copied();
        match (known, volume > 0.0) {
            (Some(node), false) => Ok(node),
            (None, true) => {
                let node = self.nodes.len() as u32;
                self.known.insert(key, node);
                self.nodes.push(at);
                self.volumes.push(volume);
                self.lines.push(line);
                Ok(node)
            }
            (Some(node), true) => {
                let message = format!(
                    "the point of line {} is at the same place",
                    self.lines[node as usize].0
                );
                Err(BadPart::at(line, message, "one volume a place; 0 for a further patch"))
            }
            (None, false) => {
                let message = "a point without volume, where no line before has a point";
                Err(BadPart::at(line, message, "a volume > 0"))
            }
        }
    }

    fn finish(self, form: Form) -> Result<Cloud, BadPart> {
        if self.nodes.is_empty() {
            return Err(BadPart::whole("the file has no points", "lines of numbers"));
        }
        if self.patches.is_empty() {
            let message = "no point has an area of the surface";
            return Err(BadPart::whole(message, "area vectors that enclose the body"));
        }
        let lines = self.lines;
        Cloud::new(form, self.nodes, self.volumes, self.patches).map_err(|bad| match bad {
            BadCloud::Twice { nodes: [a, b] } => {
                let message = format!("the point is that of line {}", lines[a].0);
                BadPart::at(lines[b], message, "points apart from each other")
            }
            BadCloud::Isolated { node, neighbours } => {
                let message = format!("the point is isolated: it has {neighbours} neighbours");
                let allowed = "neighbours on all axes, within twice the edge of their volume";
                BadPart::at(lines[node], message, allowed)
            }
            BadCloud::Apart { node } => {
                let message = "no chain of neighbours leads from the first point to this one";
                BadPart::at(lines[node], message, "points of one body")
            }
            BadCloud::Open { part } => {
                let message = format!(
                    "the areas do not enclose the body: their sum is {:.2} % of their sizes",
                    100.0 * part
                );
                BadPart::whole(message, "outward area vectors whose sum is zero, to 1 %")
            }
            BadCloud::Volume { enclosed, points } => {
                let message = format!(
                    "the areas enclose {enclosed:.4e}, and the volumes of the points are {points:.4e}"
                );
                BadPart::whole(message, "points on the surface that enclose their volume, to 5 %")
            }
        })
    }
}

/// Side of a face's name; free without one.
fn side(line: Line, name: &str, form: Form) -> Result<Side, BadPart> {
    if name.is_empty() {
        return Ok(Side::Free);
    }
    let offered = || FACES.into_iter().filter(|(_, side)| is_there(*side, form));
    let found = offered().find(|(face, _)| face.as_str() == name.to_lowercase());
    found.map(|(_, side)| side).ok_or_else(|| {
        let names: Vec<&str> = offered().map(|(face, _)| face.as_str()).collect();
        BadPart::at(line, format!("there is no face `{name}`"), names.join(", "))
    })
}

/// Returns true if a model may have a side: sections have none across y.
fn is_there(side: Side, form: Form) -> bool {
    form == Form::Solid || !matches!(side, Side::Front | Side::Back)
}
