//! Room of a drop at its release: whether an earlier one is still there, and which place, time or height keeps them
//! apart.

use super::{fits, number};
use crate::scene::droplet::{Arrival, Droplet, DropletSymmetry};

/// Digits of the figures that a refusal names, rounded up: of a time, those of the delay.
const DIGITS: i32 = 4;
/// Most decimals of such a figure.
const MOST_DECIMALS: i32 = 30;
/// Share of a unit of the last digit by which a figure may be rounded down.
const ROUNDING: f64 = 1e-6;
/// Doublings of a time or height after which no larger one helps, and halvings that find the least of them.
const MOST_DOUBLINGS: usize = 60;
/// Largest height of a release [m].
const HIGHEST: f64 = 1e3;

/// Position of an earlier drop relative to the release: place along the wall, and height fallen [m].
struct Fallen {
    x: f64,
    y: f64,
    fall: f64,
}

/// Returns where an earlier drop is when a later one is released. It falls freely, until its centre reaches the wall.
fn fallen(droplet: &Droplet, earlier: &Arrival, later: &Arrival, free: bool) -> Fallen {
    let time = (later.time - earlier.time).max(0.0);
    let [u, v, _] = droplet.velocity();
    let speed = droplet.normal_speed();
    let fall = speed * time + 0.5 * droplet.gravity * time * time;
    let deepest = droplet.gap() + 0.5 * droplet.diameter;
    let fall = if free { fall } else { fall.min(deepest) };
    // Fluid on the wall is not assumed to move along it.
    let aside = if free { time } else { time.min(droplet.fall_time(speed)) };
    let along = |v: f64| if v == 0.0 { 0.0 } else { v * aside };
    Fallen { x: earlier.x + along(u), y: earlier.y + along(v), fall }
}

/// Returns true if a drop is released where an earlier one still is.
pub fn meets(droplet: &Droplet, earlier: &Arrival, later: &Arrival, free: bool) -> bool {
    let Fallen { x, y, fall } = fallen(droplet, earlier, later, free);
    !fits(droplet.diameter, (later.x - x).hypot(later.y - y).hypot(fall))
}

/// Returns the ways in which the last of some arrivals keeps clear of all before it: a place, a time, and a height if a
/// larger one helps at that time.
pub fn ways(droplet: &Droplet, arrivals: &[Arrival], free: bool) -> String {
    let Some((last, earlier)) = arrivals.split_last() else { return String::new() };
    let is_clear = |droplet: &Droplet, time: f64| {
        let later = Arrival { time, ..*last };
        !earlier.iter().any(|other| meets(droplet, other, &later, free))
    };
    let lifted = |height: f64| Droplet { height: Some(height), ..droplet.clone() };
    let time_of = |droplet: &Droplet| {
        let fall = droplet.diameter / droplet.normal_speed();
        let by_gravity = (2.0 * droplet.diameter / droplet.gravity).sqrt();
        least(last.time, fall.min(by_gravity), f64::INFINITY, |time| is_clear(droplet, time))
    };
    let height = match free {
        true => None,
        false => least(droplet.gap(), droplet.diameter, HIGHEST, |height| {
            is_clear(&lifted(height), last.time)
        }),
    };
    let mut ways = Vec::new();
    match (time_of(droplet), height) {
        (None, None) => {
            // Above one that has landed it has room from half a diameter on.
            let height = droplet.gap().max(0.5 * droplet.diameter);
            let height = up(height, decimals_of(height), 0.0);
            let time = time_of(&lifted(height)).filter(|_| !free);
            ways.extend(time.map(|time| {
                let [height, time] = [height, time].map(whole);
                format!("a `height` of the body >= {height} with a `time` >= {time}")
            }));
        }
        (time, height) => {
            ways.extend(time.map(|time| format!("a `time` >= {}", whole(time))));
            let height = height.map(whole);
            ways.extend(height.map(|height| format!("a `height` of the body >= {height}")));
        }
    }
    // The axis has one place.
    let is_movable =
        !matches!(droplet.symmetry, DropletSymmetry::Quarter | DropletSymmetry::Axisymmetric);
    if is_movable || ways.is_empty() {
        ways.insert(0, place(droplet, (last, earlier), free));
    }
    ways.join(", or ")
}

/// Returns the place that is far enough from all earlier drops in the way.
fn place(droplet: &Droplet, (last, earlier): (&Arrival, &[Arrival]), free: bool) -> String {
    let mut farthest: f64 = 0.0;
    let mut places = Vec::new();
    for other in earlier.iter().filter(|other| meets(droplet, other, last, free)) {
        let Fallen { x, y, fall } = fallen(droplet, other, last, free);
        farthest = farthest.max((droplet.diameter.powi(2) - fall.powi(2)).max(0.0).sqrt());
        let x = format!("x = {}", number(x));
        let place = if droplet.dimension == 2 { x } else { format!("{x}, y = {}", number(y)) };
        if !places.contains(&place) {
            places.push(place);
        }
    }
    format!(
        "a place {} m or more from {}",
        whole(up(farthest, decimals_of(farthest), 0.0)),
        places.join(" and ")
    )
}

/// Returns the least value above `from` that passes, rounded up; `None` if none does up to `most`.
fn least(from: f64, scale: f64, most: f64, passes: impl Fn(f64) -> bool) -> Option<f64> {
    if !scale.is_finite() {
        return None;
    }
    let doubled = |n: usize| from + scale * 1e-3 * 2f64.powi(n as i32);
    let mut larger = (0..MOST_DOUBLINGS).map(doubled).take_while(|&value| value <= most);
    let mut high = larger.find(|&value| passes(value))?;
    let mut low = from;
    for _ in 0..MOST_DOUBLINGS {
        let middle = 0.5 * (low + high);
        if passes(middle) { high = middle } else { low = middle }
    }
    let decimals = decimals_of(high - from);
    let rounded = [0.0, 1.0].map(|more| up(high, decimals, more));
    rounded.into_iter().find(|&value| value <= most && passes(value))
}

/// Returns the number of decimals that leaves a few digits of a difference.
fn decimals_of(difference: f64) -> i32 {
    let magnitude = difference.max(f64::MIN_POSITIVE).log10().floor();
    (DIGITS - 1 - magnitude as i32).clamp(0, MOST_DECIMALS)
}

/// Rounds a positive number up to some decimals, and adds some units of the last one.
fn up(value: f64, decimals: i32, more: f64) -> f64 {
    let units = (value * 10f64.powi(decimals) - ROUNDING).ceil() + more;
    format!("{units}e{}", -decimals).parse().unwrap_or(value)
}

/// Writes a number with all of its digits.
fn whole(value: f64) -> String {
    let brief = number(value);
    if brief.parse() == Ok(value) { brief } else { format!("{value}") }
}

#[cfg(test)]
mod tests {
    use crate::scene::{self, Scene};

    fn parsed(height: f64, arrivals: &str, more: &str, wall: bool) -> Result<Scene, String> {
        let wall = match wall {
            true => {
                "[[wall]]\nname = \"wall\"\nunder = \"drop\"\nfootprint.tiles = { count = [2, 2], size = [4e-4, 4e-4] }"
            }
            false => "",
        };
        let text = format!(
            "name = \"Two\"\nstop_time = 1e-4\nstep = 1e-5\n[body.drop]\nkind = \"droplet\"\ndiameter = 0.1e-3\n\
             impact_velocity = 2.0\ninitial_temperature = 573.0\nspacing = 9e-6\nheight = {height:e}\narrivals = [{arrivals}]\n\
             fluid = {{ density = 7000.0, viscosity = 2e-3, surface_tension = 0.5, specific_heat = 250.0, conductivity = 30.0 }}\n\
             {more}\n{wall}"
        );
        scene::parse(&text, "two.toml").map_err(|error| error.to_string())
    }

    /// Numbers behind some words of a refusal.
    fn figure(refusal: &str, words: &str) -> Option<f64> {
        let after = refusal.split_once(words)?.1;
        let end = after.find([' ', ',']).unwrap_or(after.len());
        after[..end].trim().parse().ok()
    }

    /// Every figure that refusals of drops in each other name is accepted, and a hundredth less is not.
    #[test]
    fn figures_of_refusals_are_accepted() {
        let releases =
            [(6e-5, 2e-5), (6e-5, 0.0), (0.0, 2e-5), (0.0, 1e-3), (8e-5, 1e-3), (-9e-5, 1e-5)];
        let scenes = [
            ("", true),
            ("", false),
            ("gravity = 9.81", true),
            ("impact_angle = 0.5", true),
            ("impact_angle = 0.5\nimpact_direction = 2.0", false),
        ];
        let mut seen = [0; 4];
        for height in [0.0, 1e-6, 2e-5, 3.5e-5, 5e-5, 1e-3, 1.0] {
            for ((x, time), (more, wall)) in
                releases.iter().flat_map(|one| scenes.map(|own| (*one, own)))
            {
                let release = |height: f64, x: f64, time: f64| {
                    let arrivals = format!("{{ time = 0.0 }}, {{ time = {time:e}, x = {x:e} }}");
                    parsed(height, &arrivals, more, wall)
                };
                let Err(refusal) = release(height, x, time) else { continue };
                let is_accepted = |height, x, time| release(height, x, time).is_ok();
                let case = format!("{height} {x} {time} {more} {wall}: {refusal}");
                assert!(refusal.contains("released into that of arrivals[0]"), "{case}");
                let [apart, from, beside] = ["a place ", "from x = ", ", y = "]
                    .map(|words| figure(&refusal, words).expect(&refusal));
                assert!(is_accepted(height, from + apart, time), "{case}");
                assert!(beside != 0.0 || !is_accepted(height, from + 0.99 * apart, time), "{case}");
                seen[0] += 1;
                let with_both = refusal.contains("with a `time`");
                let later = figure(&refusal, "a `time` >= ");
                let lifted = figure(&refusal, "a `height` of the body >= ");
                if let Some(later) = later {
                    let height = lifted.filter(|_| with_both).unwrap_or(height);
                    assert!(is_accepted(height, x, later), "{case}");
                    assert!(!is_accepted(height, x, 0.99 * later), "{case}");
                    seen[1 + usize::from(with_both)] += 1;
                }
                if let Some(lifted) = lifted.filter(|_| !with_both) {
                    assert!(is_accepted(lifted, x, time), "{case}");
                    assert!(!is_accepted(0.99 * lifted, x, time), "{case}");
                    seen[3] += 1;
                }
            }
        }
        assert!(seen.iter().all(|&count| count > 5), "{seen:?}");
    }

    /// Both fall at one speed: above the wall no height keeps them apart.
    #[test]
    fn heights_that_do_not_help_are_not_named() {
        let refusal =
            parsed(1e-3, "{ time = 0.0 }, { time = 20e-6, x = 60e-6 }", "", true).unwrap_err();
        assert!(
            refusal.ends_with(
                "allowed: a place 9.166e-5 m or more from x = 0, y = 0, or a `time` >= 4e-5"
            ),
            "{refusal}"
        );
    }

    #[test]
    fn times_keep_clear_of_all_earlier_drops() {
        let arrivals = "{ time = 0.0 }, { time = 6e-5 }, { time = 7e-5 }";
        let refusal = parsed(1e-3, arrivals, "", true).unwrap_err();
        assert_eq!(figure(&refusal, "a `time` >= "), Some(1.1e-4), "{refusal}");
        let arrivals = "{ time = 1000.0 }, { time = 1000.00002 }";
        let refusal = parsed(1e-3, arrivals, "", true).unwrap_err();
        let time = figure(&refusal, "a `time` >= ").expect(&refusal);
        assert!((time - 1000.00005).abs() < 2e-8, "{refusal}");
        let arrivals = format!("{{ time = 1000.0 }}, {{ time = {time} }}");
        assert!(parsed(1e-3, &arrivals, "", true).is_ok(), "{refusal}");
    }
}
