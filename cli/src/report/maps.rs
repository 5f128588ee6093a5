//! Maps of solids: the top face and a section through the middle, over time.

use std::path::Path;

use impinge::scene::{Scene, Shape, Solid};

use super::document::{Axis, Layout, Map, Mark, Values};
use super::error::ReportError;
use super::fields::{FieldFile, Frames, thinned};
use super::packed::Array;
use crate::check::words::metres;

/// Most values of all maps together.
const MOST_VALUES: usize = 320_000;
/// Most nodes of a map along an axis.
const MOST_NODES: usize = 150;
/// Most times, and fewest if each has many values.
const TIMES: [usize; 2] = [50, 3];
/// Fields that are shown, and their units.
const FIELDS: [(&str, &str); 4] =
    [("temperature", "K"), ("von_mises", "Pa"), ("max_principal", "Pa"), ("plastic_strain", "1")];
/// Share of the largest change from which on a node belongs to the detail, and the margin around it.
const FELT: f64 = 0.03;
const MARGIN: f64 = 0.25;
/// A detail is not smaller than the whole from this share of it on.
const DETAIL: f64 = 0.6;

/// Maps of the solids of a scene whose nodes are in a folder.
pub fn maps(scene: &Scene, folder: &Path) -> Result<Vec<Map>, ReportError> {
    let drawn: Vec<_> = scene.solids().filter(|(name, _)| scene.is_drawn(name)).collect();
    let mut found = Vec::new();
    for (name, solid) in &drawn {
        if let Some(frames) = Frames::read(folder, name)? {
            found.extend(of_solid(scene, (name, solid), &frames, MOST_VALUES / drawn.len())?);
        }
    }
    Ok(found)
}

/// Nodes of a body's grid, and which of them are shown.
struct Grid {
    /// x (or the radius), y, z [m].
    axes: [Vec<f64>; 3],
    /// Places along the axes.
    shown: [Vec<usize>; 3],
    /// Distance of the values of neighbours along the axes in an array.
    strides: [usize; 3],
    is_round: bool,
}

impl Grid {
    /// Reads the nodes of a box or of a meridian section, revolved or not.
    fn read(file: &mut FieldFile, is_round: bool) -> Result<Self, ReportError> {
        let axes = match file.components("position") {
            Some(_) => revolved(&file.read("position")?),
            None => [file.read("x")?, file.read("y")?, file.read("z")?],
        };
        let sections = match file.components("position") {
            Some(_) => sections(&axes, file),
            None => 1,
        };
        let counts = axes.each_ref().map(Vec::len);
        let strides = [1, counts[0], counts[0] * counts[1].max(sections)];
        let shown = counts.map(|count| thinned(count, MOST_NODES));
        Ok(Self { axes, shown, strides, is_round })
    }

    fn coordinates(&self, axis: usize) -> Vec<f64> {
        self.shown[axis].iter().map(|&place| self.axes[axis][place]).collect()
    }

    /// Values of a plane of an array: of two axes, at a place of the third.
    fn plane(&self, values: &[f64], [across, up]: [usize; 2], fixed: (usize, usize)) -> Vec<f64> {
        let base = fixed.1 * self.strides[fixed.0];
        let at = |i: usize, j: usize| base + i * self.strides[across] + j * self.strides[up];
        let rows = self.shown[up].iter();
        rows.flat_map(|&j| self.shown[across].iter().map(move |&i| (i, j)))
            .map(|(i, j)| values.get(at(i, j)).copied().unwrap_or(f64::NAN))
            .collect()
    }
}

/// Radii and heights of a section that is turned about its axis: radii come first, then angles, then heights.
fn revolved(position: &[f64]) -> [Vec<f64>; 3] {
    let points: Vec<&[f64]> = position.chunks_exact(3).collect();
    let turn =
        points.windows(2).position(|two| two[1][0].hypot(two[1][1]) < two[0][0].hypot(two[0][1]));
    let radii = turn.map_or(points.len(), |last| last + 1);
    // A row for each angle; heights of interfaces come twice.
    let rows: Vec<f64> = points.iter().step_by(radii.max(1)).map(|point| point[2]).collect();
    let angles = rows.iter().take_while(|&height| height == &rows[0]).count();
    let heights = rows.into_iter().step_by(angles.max(1)).collect();
    [points.iter().take(radii).map(|point| point[0]).collect(), vec![0.0], heights]
}

/// Number of sections of a revolved grid.
fn sections(axes: &[Vec<f64>; 3], file: &mut FieldFile) -> usize {
    let of_section = axes[0].len() * axes[2].len();
    file.length("temperature").map_or(1, |values| values / of_section.max(1)).max(1)
}

fn of_solid(
    scene: &Scene,
    (name, solid): (&str, &Solid),
    frames: &Frames,
    most: usize,
) -> Result<Vec<Map>, ReportError> {
    let is_round = matches!(solid.shape, Shape::Disc(_));
    let (_, first) = &frames.files[0];
    let mut file = FieldFile::open(first)?;
    let grid = Grid::read(&mut file, is_round)?;
    let fields: Vec<_> =
        FIELDS.into_iter().filter(|(field, _)| file.components(field).is_some()).collect();
    let planes = planes(name, &grid);
    let size: usize = planes.iter().map(|plane| plane.size(&grid)).sum::<usize>() * fields.len();
    let times = (most / size.max(1)).clamp(TIMES[1], TIMES[0]);
    let chosen = frames.thinned(times);
    let mut values = vec![vec![Vec::new(); fields.len()]; planes.len()];
    for (_, path) in &chosen {
        let mut file = FieldFile::open(path)?;
        for (place, (field, _)) in fields.iter().enumerate() {
            let array = file.read(field)?;
            for (plane, all) in planes.iter().zip(&mut values) {
                all[place].extend(grid.plane(&array, plane.axes, plane.fixed));
            }
        }
    }
    let times: Vec<f64> = chosen.iter().map(|(time, _)| *time).collect();
    let made = planes.iter().zip(values).map(|(plane, values)| {
        let axes = plane.axes.map(|axis| grid.coordinates(axis));
        let focus = focus(&axes, &values, times.len(), plane.layout);
        Map {
            title: plane.title.clone(),
            layout: plane.layout,
            is_cells: false,
            focus,
            marks: marks(scene, name, plane),
            axes: [0, 1].map(|k| Axis {
                name: plane.names[k].to_owned(),
                unit: "m".to_owned(),
                values: Array::rounded(axes[k].iter().copied()),
                ends: None,
            }),
            times: times.clone(),
            fields: fields
                .iter()
                .zip(&values)
                .map(|((field, unit), values)| Values {
                    name: field.replace('_', " "),
                    unit: (*unit).to_owned(),
                    values: Array::packed(values),
                })
                .collect(),
        }
    });
    Ok(made.collect())
}

/// A face or section of a grid.
struct Plane {
    title: String,
    layout: Layout,
    axes: [usize; 2],
    names: [&'static str; 2],
    /// The axis that it is normal to, and the place along that.
    fixed: (usize, usize),
}

impl Plane {
    fn size(&self, grid: &Grid) -> usize {
        self.axes.map(|axis| grid.shown[axis].len()).iter().product()
    }
}

/// The top and the section through the middle.
fn planes(body: &str, grid: &Grid) -> Vec<Plane> {
    let top = (2, grid.axes[2].len().saturating_sub(1));
    let title = |words: &str| format!("{body}: {words}");
    if grid.is_round {
        // The top of a disc has one value for each radius; its second axis is y = 0 alone.
        let [round, section] = [(Layout::Round, "top"), (Layout::Section, "meridian section")];
        return vec![
            Plane {
                title: title(round.1),
                layout: round.0,
                axes: [0, 1],
                names: ["r", "y"],
                fixed: top,
            },
            Plane {
                title: title(section.1),
                layout: section.0,
                axes: [0, 2],
                names: ["r", "z"],
                fixed: (1, 0),
            },
        ];
    }
    let y = &grid.axes[1];
    let middle = (0..y.len()).min_by(|a, b| y[*a].abs().total_cmp(&y[*b].abs())).unwrap_or(0);
    let at = y.get(middle).copied().unwrap_or(0.0);
    vec![
        Plane {
            title: title("top"),
            layout: Layout::Grid,
            axes: [0, 1],
            names: ["x", "y"],
            fixed: top,
        },
        Plane {
            title: title(&section(at)),
            layout: Layout::Grid,
            axes: [0, 2],
            names: ["x", "z"],
            fixed: (1, middle),
        },
    ]
}

/// Names a section at a coordinate [m].
fn section(y: f64) -> String {
    if y == 0.0 { "section y = 0".to_owned() } else { format!("section y = {}", metres(y)) }
}

/// Probes that lie in a plane.
fn marks(scene: &Scene, body: &str, plane: &Plane) -> Vec<Mark> {
    let own = scene.probe.iter().filter(|probe| probe.body == body);
    let in_plane = own.filter(|probe| probe.at[plane.fixed.0] == 0.0);
    in_plane
        .map(|probe| Mark { name: probe.name.clone(), at: plane.axes.map(|axis| probe.at[axis]) })
        .collect()
}

/// The part of a plane in which the first field changes over time; `None` if that is most of it.
fn focus(
    axes: &[Vec<f64>; 2],
    values: &[Vec<f64>],
    times: usize,
    layout: Layout,
) -> Option<[f64; 4]> {
    let field = values.first()?;
    let (columns, nodes) = (axes[0].len(), axes[0].len() * axes[1].len());
    let start = field.get(..nodes)?;
    let change = |frame: usize, node: usize| (field[frame * nodes + node] - start[node]).abs();
    let all = || (1..times).flat_map(|frame| (0..nodes).map(move |node| (frame, node)));
    let largest = all().map(|(frame, node)| change(frame, node)).fold(0.0, f64::max);
    if largest <= 0.0 {
        return None;
    }
    let mut ends = [f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY];
    for (_, node) in all().filter(|&(frame, node)| change(frame, node) > FELT * largest) {
        let at = [axes[0][node % columns], axes[1][node / columns]];
        for (axis, value) in at.into_iter().enumerate() {
            ends[2 * axis] = ends[2 * axis].min(value);
            ends[2 * axis + 1] = ends[2 * axis + 1].max(value);
        }
    }
    detail(axes, ends, layout)
}

/// A detail with its margin, within the whole.
fn detail(axes: &[Vec<f64>; 2], ends: [f64; 4], layout: Layout) -> Option<[f64; 4]> {
    let [x0, x1, y0, y1] = ends;
    let span = |axis: &Vec<f64>| {
        [axis.first().copied(), axis.last().copied()].map(Option::unwrap_or_default)
    };
    let ([left, right], [bottom, top]) = (span(&axes[0]), span(&axes[1]));
    if layout == Layout::Grid {
        let (dx, dy) = (MARGIN * (x1 - x0), MARGIN * (y1 - y0));
        let found =
            [(x0 - dx).max(left), (x1 + dx).min(right), (y0 - dy).max(bottom), (y1 + dy).min(top)];
        let shares =
            [(found[1] - found[0]) / (right - left), (found[3] - found[2]) / (top - bottom)];
        return (shares.into_iter().fold(1.0, f64::min) < DETAIL
            && found[0] < found[1]
            && found[2] < found[3])
            .then_some(found);
    }
    // Both sides of the axis.
    let reach = (x1 * (1.0 + MARGIN)).min(right);
    if layout == Layout::Round {
        return (reach < DETAIL * right && reach > 0.0).then_some([-reach, reach, -reach, reach]);
    }
    let low = (y0 - MARGIN * (y1 - y0)).max(bottom);
    let is_small = reach < DETAIL * right || top - low < DETAIL * (top - bottom);
    (is_small && reach > 0.0 && low < top).then_some([-reach, reach, low, top])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radii_and_heights_follow_from_a_revolved_section() {
        let mut position = Vec::new();
        for z in [-1.0, -0.5, 0.0] {
            for angle in [0.0f64, 2.0, 4.0, 0.0] {
                for r in [0.0, 1.0, 3.0] {
                    position.extend([r * angle.cos(), r * angle.sin(), z]);
                }
            }
        }
        let [radii, _, heights] = revolved(&position);
        assert_eq!((radii, heights), (vec![0.0, 1.0, 3.0], vec![-1.0, -0.5, 0.0]));
    }

    #[test]
    fn the_detail_holds_what_changes() {
        let axis: Vec<f64> = (-10..=10).map(f64::from).collect();
        let axes = [axis.clone(), axis];
        let mut values = vec![0.0; 2 * 441];
        for (i, j) in [(9, 9), (12, 11)] {
            values[441 + j * 21 + i] = 1.0;
        }
        let [x0, x1, y0, y1] = focus(&axes, &[values], 2, Layout::Grid).unwrap();
        assert!(x0 <= -1.0 && x1 >= 2.0 && y0 <= -1.0 && y1 >= 1.0);
        assert!(x1 - x0 < 8.0 && y1 - y0 < 8.0);
        let still = vec![293.15; 2 * 441];
        assert_eq!(focus(&axes, &[still], 2, Layout::Grid), None);
    }
}
