//! The folder of terminals: their XML, and the icons of unit and terminals.

use impinge::fmi::terminals::{Direction, FOLDER, Member, terminals_and_icons};
use impinge::scene::Scene;
use tiny_skia::{Color, FillRule, LineCap, Paint, PathBuilder, Pixmap, Stroke, Transform};

use crate::archive::Entries;
use crate::version::Version;

/// Side of a terminal's icon [pixels].
const SIDE: f32 = 64.0;
const GROUND: [u8; 3] = [252, 236, 228];
const RIM: [u8; 3] = [196, 46, 28];

/// The folder's files; `icon` is the picture of the unit.
pub fn entries(scene: &Scene, fmi: Version, icon: &[u8]) -> Result<Entries, String> {
    let members = match fmi {
        Version::Two => Member::all(scene),
        Version::Three => Member::arrays(scene),
    };
    let xml = terminals_and_icons(scene, &members);
    let mut entries = Entries::new();
    entries.insert(format!("{FOLDER}/terminalsAndIcons.xml"), xml.into());
    entries.insert(format!("{FOLDER}/icon.png"), icon.to_owned());
    for direction in Direction::ALL {
        entries.insert(format!("{FOLDER}/{}.png", direction.icon()), png(direction)?);
    }
    Ok(entries)
}

/// A disc with an arrow: into the unit from the left, out of it to the right, or both ways.
fn png(direction: Direction) -> Result<Vec<u8>, String> {
    let mut pixmap = Pixmap::new(SIDE as u32, SIDE as u32).ok_or("cannot draw a terminal")?;
    let middle = 0.5 * SIDE;
    let disc = PathBuilder::from_circle(middle, middle, 0.44 * SIDE).ok_or("no disc")?;
    pixmap.fill_path(&disc, &paint(GROUND), FillRule::Winding, Transform::identity(), None);
    let stroke = Stroke { width: 0.06 * SIDE, line_cap: LineCap::Round, ..Default::default() };
    pixmap.stroke_path(&disc, &paint(RIM), &stroke, Transform::identity(), None);
    let mut arrow = PathBuilder::new();
    let (left, right, head) = (0.26 * SIDE, 0.74 * SIDE, 0.14 * SIDE);
    arrow.move_to(left, middle);
    arrow.line_to(right, middle);
    let mut tip = |x: f32, back: f32| {
        arrow.move_to(x + back, middle - head);
        arrow.line_to(x, middle);
        arrow.line_to(x + back, middle + head);
    };
    tip(right, -head);
    if direction == Direction::Exchange {
        tip(left, head);
    }
    let arrow = arrow.finish().ok_or("no arrow")?;
    pixmap.stroke_path(&arrow, &paint(RIM), &stroke, Transform::identity(), None);
    if direction == Direction::Out {
        // The bar where the arrow starts.
        let mut bar = PathBuilder::new();
        bar.move_to(left, middle - head);
        bar.line_to(left, middle + head);
        let bar = bar.finish().ok_or("no bar")?;
        pixmap.stroke_path(&bar, &paint(RIM), &stroke, Transform::identity(), None);
    }
    pixmap.encode_png().map_err(|error| format!("cannot draw a terminal: {error}"))
}

fn paint([red, green, blue]: [u8; 3]) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Default::default() };
    paint.set_color(Color::from_rgba8(red, green, blue, 255));
    paint
}
