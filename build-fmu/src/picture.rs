//! The unit's icon: a section through the first loaded body, scaled to its loads.

use impinge::scene::{Droplet, FaceName, Load, Scene, Shape};
use tiny_skia::{Color, FillRule, Paint, Path, PathBuilder, Pixmap, Rect, Stroke, Transform};

const WIDTH: f32 = 400.0;
const HEIGHT: f32 = 300.0;
/// Space for arrows at a loaded face, and margin elsewhere [pixels].
const AIR: f32 = 76.0;
const MARGIN: f32 = 26.0;

/// Colours of the body from cold to hot.
const WARMTH: [[f32; 3]; 6] = [
    [0.84, 0.87, 0.91],
    [0.96, 0.91, 0.80],
    [0.99, 0.82, 0.49],
    [0.97, 0.60, 0.24],
    [0.86, 0.32, 0.15],
    [0.66, 0.10, 0.13],
];
const INK: [f32; 3] = [0.13, 0.19, 0.25];
const HOT: [f32; 3] = [0.77, 0.18, 0.11];
const WHITE: [f32; 3] = [1.0, 1.0, 1.0];
const WATER: [f32; 3] = [0.55, 0.75, 0.90];

/// The picture of a scene, as a PNG file.
pub fn png(scene: &Scene) -> Result<Vec<u8>, String> {
    let pixmap = Pixmap::new(WIDTH as u32, HEIGHT as u32).ok_or("cannot draw the picture")?;
    let mut canvas = Canvas(pixmap);
    canvas.0.fill(Color::WHITE);
    if let Some(section) = Section::of(scene) {
        section.paint_body(&mut canvas);
        section.paint_loads(&mut canvas);
        section.drops.iter().for_each(|drop| section.paint_drop(&mut canvas, drop));
        let probes = scene.probe.iter().filter(|probe| Some(&*probe.body) == section.body);
        let stride = scene.probe.len().div_ceil(MOST_PROBES).max(1);
        probes.step_by(stride).for_each(|probe| section.paint_probe(&mut canvas, probe.at));
    }
    canvas.0.encode_png().map_err(|error| format!("cannot draw the picture: {error}"))
}

/// A load's footprint in the section [m].
struct Spot {
    x: f64,
    reach: f64,
    on_top: bool,
    /// True if arrows show it.
    is_load: bool,
}

/// A drop above the top face, where it is released [m].
struct Drop {
    x: f64,
    z: f64,
    radius: f64,
}

impl Drop {
    /// The first drop to arrive at each place.
    fn of(droplet: &Droplet) -> Vec<Self> {
        let radius = 0.5 * droplet.diameter;
        let mut drops: Vec<Self> = Vec::new();
        // Default start position of drops released by inputs.
        let at_origin = droplet.is_on_demand().then_some(0.0);
        for x in droplet.arrivals().iter().map(|arrival| arrival.x).chain(at_origin) {
            if drops.iter().all(|drop| drop.x != x) {
                drops.push(Self { x, z: droplet.gap() + radius, radius });
            }
        }
        drops
    }

    /// The heated spot below the drop.
    fn spot(&self) -> Spot {
        Spot { x: self.x, reach: self.radius, on_top: true, is_load: false }
    }
}

impl Spot {
    fn of(load: &Load) -> Self {
        let [reach, _] = load.footprint.half_extents(load.start.radius);
        let on_top = load.body_and_face().1 != FaceName::Bottom;
        Self { x: load.start.x.unwrap_or(0.0), reach, on_top, is_load: true }
    }

    fn overlaps(&self, other: &Spot) -> bool {
        self.on_top == other.on_top && (self.x - other.x).abs() < self.reach + other.reach
    }

    /// Temperature around a disc held at 1 on a half-space that is cold far away, in oblate
    /// spheroidal coordinates: H. S. Carslaw and J. C. Jaeger, *Conduction of Heat in Solids*,
    /// Oxford 1959, §8.2 (8).
    fn warmth(&self, x: f64, depth: f64) -> f64 {
        let (r, a) = (x - self.x, self.reach);
        let sum = (r - a).hypot(depth) + (r + a).hypot(depth);
        (2.0 * a / sum).min(1.0).asin() * std::f64::consts::FRAC_2_PI
    }
}

/// Largest number of displayed probes: more of them would overlap.
const MOST_PROBES: usize = 1000;

/// The visible part of a body, and its coordinates: rightward x and downward depth below the top face.
struct Section<'a> {
    /// Name of the solid, if it is one.
    body: Option<&'a str>,
    drops: Vec<Drop>,
    /// Spots, the widest first.
    spots: Vec<Spot>,
    thickness: f64,
    /// x in the middle of the picture [m].
    middle: f64,
    /// Pixels per metre.
    scale: f64,
    /// Vertical position of the top face [pixels].
    top: f32,
    /// Rectangle of the body, which may extend beyond the picture [pixels].
    outline: Rect,
}

impl<'a> Section<'a> {
    fn of(scene: &'a Scene) -> Option<Self> {
        let loaded = scene.load.first().map(|load| load.body_and_face().0);
        let coupled = scene.coupling.first().and_then(|coupling| coupling.solid());
        let first = || scene.solids().next().map(|(name, _)| name);
        let body = loaded.or(coupled).or_else(first);
        let drops: Vec<Drop> = match body {
            Some(body) => {
                let couplings = scene.couplings_to(body);
                let droplets = couplings.filter_map(|coupling| scene.droplet(&coupling.from));
                droplets.flat_map(Drop::of).collect()
            }
            None => scene.droplets().next().map_or(vec![], |(_, droplet)| Drop::of(droplet)),
        };
        let (half_width, thickness) = extents(scene, body, &drops)?;
        let loads = scene.load.iter().filter(|load| Some(load.body_and_face().0) == body);
        let mut spots: Vec<Spot> =
            loads.map(Spot::of).chain(drops.iter().map(Drop::spot)).collect();
        spots.sort_by(|a, b| b.reach.total_cmp(&a.reach));
        let (middle, half_seen) = seen(&spots, half_width);
        let free = if half_seen < half_width { 0.0 } else { MARGIN };
        let scale = f64::from(WIDTH / 2.0 - free) / half_seen;
        let height = (thickness * scale) as f32;
        let highest = drops.iter().map(|drop| drop.z + drop.radius).fold(0.0, f64::max);
        let top = top_of(&spots, height, (highest * scale) as f32);
        let left = WIDTH / 2.0 + ((-half_width - middle) * scale) as f32;
        let width = (2.0 * half_width * scale) as f32;
        let outline = Rect::from_xywh(left, top, width, height)?;
        Some(Self { body, drops, spots, thickness, middle, scale, top, outline })
    }

    fn pixel_x(&self, x: f64) -> f32 {
        WIDTH / 2.0 + ((x - self.middle) * self.scale) as f32
    }

    fn pixel_y(&self, z: f64) -> f32 {
        self.top - (z * self.scale) as f32
    }

    fn paint_body(&self, canvas: &mut Canvas) {
        if self.thickness == 0.0 {
            return;
        }
        for row in self.outline.top().max(0.0) as u32..self.outline.bottom().min(HEIGHT) as u32 {
            for column in
                self.outline.left().max(0.0) as u32..self.outline.right().min(WIDTH) as u32
            {
                let x =
                    self.middle + (f64::from(column) + 0.5 - f64::from(WIDTH) / 2.0) / self.scale;
                let depth = (f64::from(row) + 0.5 - f64::from(self.top)) / self.scale;
                let pixel = Rect::from_xywh(column as f32, row as f32, 1.0, 1.0);
                canvas.fill_rect(pixel, colour_of(self.warmth(x, depth)));
            }
        }
        canvas.stroke(&PathBuilder::from_rect(self.outline), INK, 1.5);
    }

    fn warmth(&self, x: f64, depth: f64) -> f64 {
        let of =
            |spot: &Spot| spot.warmth(x, if spot.on_top { depth } else { self.thickness - depth });
        // The power makes the slowly decaying far field fade within the picture.
        self.spots.iter().map(of).fold(0.0, f64::max).powf(1.8)
    }

    fn paint_loads(&self, canvas: &mut Canvas) {
        for (i, spot) in self.spots.iter().enumerate().filter(|(_, spot)| spot.is_load) {
            let (left, right) =
                (self.pixel_x(spot.x - spot.reach), self.pixel_x(spot.x + spot.reach));
            let (face, outward) =
                if spot.on_top { (self.outline.top(), -1.0) } else { (self.outline.bottom(), 1.0) };
            let bar = Rect::from_ltrb(left, face - 3.0, right, face + 3.0);
            canvas.fill_rect(bar, HOT);
            if self.spots[..i].iter().any(|wider| wider.overlaps(spot)) {
                continue;
            }
            let count = ((right - left) / 26.0).clamp(1.0, 9.0) as usize;
            for k in 0..count {
                let x = left + (right - left) * (k as f32 + 0.5) / count as f32;
                paint_arrow(canvas, x, face + 8.0 * outward, outward);
            }
        }
    }

    fn paint_drop(&self, canvas: &mut Canvas, drop: &Drop) {
        let (x, y) = (self.pixel_x(drop.x), self.pixel_y(drop.z));
        let radius = (drop.radius * self.scale) as f32;
        if let Some(circle) = PathBuilder::from_circle(x, y, radius) {
            canvas.fill(&circle, WATER);
            canvas.stroke(&circle, INK, 1.5);
        }
        paint_arrow(canvas, x, y + 0.55 * radius.max(40.0), -1.0);
    }

    fn paint_probe(&self, canvas: &mut Canvas, at: [f64; 3]) {
        let circle = PathBuilder::from_circle(self.pixel_x(at[0]), self.pixel_y(at[2]), 5.5);
        if let Some(circle) = circle {
            canvas.fill(&circle, WHITE);
            canvas.stroke(&circle, INK, 2.5);
        }
    }
}

/// Middle and half of the visible width [m]: some widths of the footprints, or the whole body.
fn seen(spots: &[Spot], half_width: f64) -> (f64, f64) {
    let low = spots.iter().map(|spot| spot.x - spot.reach).fold(f64::INFINITY, f64::min);
    let high = spots.iter().map(|spot| spot.x + spot.reach).fold(f64::NEG_INFINITY, f64::max);
    let half_seen = 1.6 * (high - low);
    if half_seen < half_width { ((low + high) / 2.0, half_seen) } else { (0.0, half_width) }
}

/// Half the width and the thickness of the displayed object: a solid, or the wall below drops.
fn extents(scene: &Scene, body: Option<&str>, drops: &[Drop]) -> Option<(f64, f64)> {
    if let Some(solid) = body.and_then(|name| scene.solid(name)) {
        let half_width = match solid.shape {
            Shape::Box(extents) => extents[0] / 2.0,
            Shape::Disc(disc) => disc.radius,
        };
        return Some((half_width, solid.shape.thickness()));
    }
    let widest = drops.iter().map(|drop| drop.x.abs() + 2.0 * drop.radius).reduce(f64::max)?;
    match scene.wall.first().map(|wall| wall.footprint.half_extents(None)) {
        Some([half_width, _]) => Some((half_width, widest)),
        None => Some((widest, 0.0)),
    }
}

/// Vertical position of the top face: thick bodies extend beyond the side without load, and drops above fit in.
fn top_of(spots: &[Spot], height: f32, drops: f32) -> f32 {
    let on_top = spots.iter().any(|spot| spot.on_top);
    let room_above = match (on_top, drops > 0.0) {
        (_, true) => drops + MARGIN,
        (true, false) => AIR,
        (false, false) => MARGIN,
    };
    let room_below = if spots.iter().any(|spot| !spot.on_top) { AIR } else { MARGIN };
    let room = HEIGHT - room_above - room_below;
    if height <= room {
        (room_above + (room - height) / 2.0).round()
    } else if on_top || spots.is_empty() {
        room_above
    } else {
        HEIGHT - room_below - height
    }
}

/// An arrow into the body whose tip is at `x`, `tip`.
fn paint_arrow(canvas: &mut Canvas, x: f32, tip: f32, outward: f32) {
    let shaft = Rect::from_ltrb(
        x - 1.5,
        (tip + 9.0 * outward).min(tip + 38.0 * outward),
        x + 1.5,
        (tip + 9.0 * outward).max(tip + 38.0 * outward),
    );
    canvas.fill_rect(shaft, HOT);
    let mut head = PathBuilder::new();
    head.move_to(x, tip);
    head.line_to(x - 6.0, tip + 12.0 * outward);
    head.line_to(x + 6.0, tip + 12.0 * outward);
    head.close();
    if let Some(head) = head.finish() {
        canvas.fill(&head, HOT);
    }
}

fn colour_of(warmth: f64) -> [f32; 3] {
    let place = warmth.clamp(0.0, 1.0) as f32 * (WARMTH.len() - 1) as f32;
    let below = (place as usize).min(WARMTH.len() - 2);
    let part = place - below as f32;
    let mix = |i: usize| WARMTH[below][i] * (1.0 - part) + WARMTH[below + 1][i] * part;
    [mix(0), mix(1), mix(2)]
}

/// Filling and stroking in one colour.
struct Canvas(Pixmap);

impl Canvas {
    fn fill_rect(&mut self, rect: Option<Rect>, colour: [f32; 3]) {
        if let Some(rect) = rect {
            self.0.fill_rect(rect, &paint(colour), Transform::identity(), None);
        }
    }

    fn fill(&mut self, path: &Path, colour: [f32; 3]) {
        self.0.fill_path(path, &paint(colour), FillRule::Winding, Transform::identity(), None);
    }

    fn stroke(&mut self, path: &Path, colour: [f32; 3], width: f32) {
        let stroke = Stroke { width, ..Stroke::default() };
        self.0.stroke_path(path, &paint(colour), &stroke, Transform::identity(), None);
    }
}

fn paint([red, green, blue]: [f32; 3]) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    if let Some(colour) = Color::from_rgba(red, green, blue, 1.0) {
        paint.set_color(colour);
    }
    paint
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: &str = include_str!("../../examples/droplet_unit/scene.toml");
    const IMPACT: &str = include_str!("../../examples/droplet_impact/scene.toml");

    /// Number of pixels of a colour, and whether any differ from white below the drop.
    fn seen(text: &str) -> (usize, bool) {
        let scene = impinge::scene::parse(text, "scene").unwrap_or_else(|e| panic!("{e}"));
        let picture = Pixmap::decode_png(&png(&scene).unwrap()).unwrap();
        let wanted = WATER.map(|part| (part * 255.0).round() as i32);
        let is_water = |pixel: &&tiny_skia::PremultipliedColorU8| {
            let colour = [pixel.red(), pixel.green(), pixel.blue()];
            colour.iter().zip(wanted).all(|(&a, b)| (i32::from(a) - b).abs() <= 1)
        };
        let bottom = picture.pixel(WIDTH as u32 / 2, HEIGHT as u32 - 40).unwrap();
        (picture.pixels().iter().filter(is_water).count(), bottom.red() != 255)
    }

    #[test]
    fn drop_appears_above_plate_and_wall() {
        for text in [UNIT, IMPACT] {
            let (water, has_ground) = seen(text);
            assert!(water > 3000 && has_ground, "{water} {has_ground}");
        }
    }

    #[test]
    fn drop_without_wall_appears_alone() {
        let free = UNIT.split("[[wall]]").next().unwrap();
        let (water, has_ground) = seen(free);
        assert!(water > 3000 && !has_ground, "{water} {has_ground}");
    }
}
