//! G-code as the route of a nozzle: the moves that its lines describe, and the motion through them.
//!
//! Understood are G0 and G1, arcs G2 and G3 by their centre, G4, units G20 and G21, places G90 and G91, lengths of
//! filament M82 and M83, and G92. Codes of temperatures, fans, motors and messages change no motion and are passed
//! over. All others are refused with their line: a path of which a part is guessed is no path.
//!
//! A retraction takes time; fluid comes again when all that was drawn back has been fed.

mod machine;
mod memo;
mod motion;

pub use memo::Memo;

use super::filament::PathFile;
use super::files::with_line_feeds;
use super::route::Route;

/// A move between two places, or a rest at one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Step {
    /// To a place [m] with a speed [m/s], while a volume comes [m³].
    Move { from: [f64; 3], to: [f64; 3], volume: f64, speed: f64 },
    /// At a place [m] for a time [s], while a volume comes [m³].
    Rest { at: [f64; 3], duration: f64, volume: f64 },
}

/// A line that is not understood.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BadLine {
    /// Counted from 1.
    pub line: usize,
    /// Text of the line.
    pub text: String,
    pub message: String,
    pub allowed: String,
}

/// Returns the route that a text describes; `height` is that of the outlet before Z is set [m].
pub fn route(text: &str, settings: &PathFile, height: f64) -> Result<Route, BadLine> {
    let PathFile { acceleration, corner_speed, filament_diameter, origin: [x, y], .. } = *settings;
    let acceleration = acceleration.unwrap_or(f64::NAN);
    let numbers = [acceleration, corner_speed, filament_diameter, x, y, height];
    settings.memo.route((text, &numbers), || make(text, settings, height))
}

fn make(text: &str, settings: &PathFile, height: f64) -> Result<Route, BadLine> {
    // Some editors begin a file with a mark of its byte order.
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let steps = machine::steps(&with_line_feeds(text), settings, height)?;
    Ok(motion::route(&steps, settings))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settings(keys: &str) -> PathFile {
        toml::from_str(&format!("file = \"a.gcode\"\n{keys}")).unwrap()
    }

    fn of(text: &str, keys: &str) -> Route {
        route(text, &settings(keys), 1e-3).unwrap()
    }

    fn close(found: [f64; 3], wanted: [f64; 3]) -> bool {
        found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-12)
    }

    #[test]
    fn carriage_returns_alone_end_lines() {
        let text = LINE.replace('\n', "\r");
        assert_eq!(of(&text, ""), of(LINE, ""));
        assert_eq!(of(&format!("\u{feff}{LINE}"), ""), of(LINE, ""));
        let bad = route(&text.replace("M82", "X"), &settings(""), 1e-3).unwrap_err();
        assert_eq!(bad.line, 3);
    }

    const LINE: &str =
        "G21 ; mm\nG90\nM82\nG92 E0\nG0 X10 Y5 Z0.5 F6000\nG1 X30 E2 F1200 (20 mm/s)\ng1 y15 e3\n";

    #[test]
    fn moves_take_their_time_and_volume() {
        let route = of(LINE, "");
        let ends: Vec<_> = route.legs.iter().map(|leg| leg.at(leg.duration)).collect();
        assert_eq!(ends.len(), 2, "{route:?}");
        assert!(close(route.legs[0].place[0], [10e-3, 5e-3, 0.5e-3]));
        assert!(close(ends[0], [30e-3, 5e-3, 0.5e-3]) && close(ends[1], [30e-3, 15e-3, 0.5e-3]));
        assert!((route.stop() - 1.5).abs() < 1e-12);
        let section = std::f64::consts::FRAC_PI_4 * 1.75e-3_f64.powi(2);
        assert!((route.volume_until(9.0) / (3e-3 * section) - 1.0).abs() < 1e-12);
        assert!((route.volume_until(1.0) / (2e-3 * section) - 1.0).abs() < 1e-12);
    }

    /// Relative places and lengths, inches, an origin and line numbers with checksums describe the same route.
    #[test]
    fn other_notations_describe_the_same_route() {
        let expected = of(LINE, "");
        let relative = "N1 G91*3\nM83\nG90\nG0 X10 Y5 Z0.5 F1200\nG91\nN5 G1 X20 E2*71\nG1 Y10 E1";
        let inches = "G20\nG0 X0.39370078740157477 Y0.19685039370078738 Z0.019685039370078738 F47.2440944881889\n\
                      G1 X1.1811023622047243 E0.07874015748031496\nG1 Y0.5905511811023622 E0.11811023622047244";
        let shifted = LINE.replace("X10", "X110").replace("X30", "X130");
        let moved = LINE.replace("G0 X10 Y5 Z0.5 F6000", "G0 X0 Y5 Z0.5 F6000\nG92 X-10\nG0 X0");
        for (text, keys) in [
            (relative, ""),
            (inches, ""),
            (&shifted, "origin = [-0.1, 0.0]"),
            (&moved.replace("X30", "X20"), ""),
        ] {
            let route = of(text, keys);
            let [found, wanted] = [&route, &expected].map(|route| {
                let last = route.legs.len() - 2;
                &route.legs[last..]
            });
            for (a, b) in found.iter().zip(wanted) {
                assert!(
                    close(a.place[0], b.place[0]) && close(a.place[1], b.place[1]),
                    "{text}: {a:?}"
                );
                let [a, b] = [a, b].map(|leg| leg.flow.unwrap()[0]);
                assert!((a / b - 1.0).abs() < 1e-9, "{text}: {a} {b}");
            }
        }
    }

    /// Comments may contain the letters that end a line elsewhere.
    #[test]
    fn comments_hide_no_words() {
        let plain = "G0 X0 Y0\nG1 X10 E0.5 F600";
        for commented in [
            "G0 X0 Y0\nG1 X10 (outer; wall 50%) E0.5 F600",
            "G0 X0 Y0 ; (\nG1 (a * (b)) X10 E0.5 F600 ;)",
            "G0 X0 Y0*(\nG1 X10 E0.5 F600 % )",
        ] {
            assert_eq!(of(commented, ""), of(plain, ""), "{commented}");
        }
    }

    /// The place after homing is not known, so a path may only begin with a new one.
    #[test]
    fn homing_forgets_the_place() {
        let plain = "G0 X5 Y6 Z1\nG1 X15 E1 F600";
        assert_eq!(of(&format!("G0 X1 Y2\nG92 X7\nG28\n{plain}"), ""), of(plain, ""));
    }

    /// Axes need no number, and other words name none of them.
    #[test]
    fn homing_takes_axes_without_numbers() {
        let text = |home: &str, next: &str| format!("G0 X1 Y2\n{home}\n{next}\nG1 X15 Y6 E1 F600");
        let all = of(&text("G28", "G0 X5 Y6"), "");
        for home in ["G28 W", "G28 X Y", "g28 X0 Y0 Z", "N4 G28 O"] {
            assert_eq!(of(&text(home, "G0 X5 Y6"), ""), all, "{home}");
        }
        assert_eq!(of(&text("G28 X", "G0 X5"), ""), of("G0 X5 Y2\nG1 X15 Y6 E1 F600", ""));
    }

    /// The present place becomes that of all zeros.
    #[test]
    fn renaming_without_words_renames_all() {
        let plain = "G0 X5 Y6 Z1\nM82\nG1 X7 E3 F600\n";
        let rest = "\nG1 X10 E1 F600";
        let named = of(&format!("{plain}G92 X0 Y0 Z0 E0{rest}"), "");
        assert_eq!(of(&format!("{plain}G92{rest}"), ""), named);
        let unknown = route("G92\nG0 X0 Y0", &settings(""), 1e-3).unwrap_err();
        assert!(unknown.message.contains("before its place is known"), "{unknown:?}");
    }

    /// Machines differ in whether a move obeys a mode that stands behind it.
    #[test]
    fn modes_behind_moves_are_refused() {
        for mode in ["G20", "G91", "M83", "G92"] {
            let text = format!("G0 X0 Y0\nG1 X10 E1 F600 {mode}");
            let bad = route(&text, &settings(""), 1e-3).unwrap_err();
            assert!(bad.line == 2 && bad.message.contains("behind a move"), "{bad:?}");
        }
        let before = of("G0 X0 Y0\nG21 G91 G1 X10 E1 F600", "");
        assert_eq!(before, of("G0 X0 Y0\nG91\nG1 X10 E1 F600", ""));
    }

    /// Filament that was drawn back is fed first; only then does fluid come again.
    #[test]
    fn retractions_bring_no_fluid() {
        let text = "M83\nG0 X0 Y0\nG1 X10 E1 F600\nG1 E-2 F1200\nG0 X20 F6000\nG1 E2 F1200\nG4 P500\nG1 X30 E1 F600";
        let route = of(text, "filament_diameter = 1e-3");
        let volume = |time| route.volume_until(time) / (std::f64::consts::FRAC_PI_4 * 1e-9);
        assert!((volume(1.0) - 1.0).abs() < 1e-12);
        let resumes = 1.0 + 0.1 + 0.1 + 0.1 + 0.5;
        assert!((volume(resumes) - 1.0).abs() < 1e-12 && (volume(9.0) - 2.0).abs() < 1e-12);
        assert!((route.stop() - resumes - 1.0).abs() < 1e-12);
    }

    /// An outlet that comes back to where it has been is moved by rounding, as is filament that is fed as far as
    /// before.
    #[test]
    fn rounding_moves_and_feeds_nothing() {
        let relative =
            "M83\nG0 X0 Y0\nG1 X27.3 E3 F1200\nG92 X8.8\nG1 X8.8 E1 F60\nG1 X18.8 E2 F1200";
        let route = of(relative, "filament_diameter = 1e-3");
        assert!((route.stop() - 2.865).abs() < 1e-9, "{}", route.stop());
        let volume = route.volume_until(9.0) / (6e-3 * std::f64::consts::FRAC_PI_4 * 1e-6);
        assert!((volume - 1.0).abs() < 1e-9, "{volume}");
        let again =
            "M82\nG0 X0 Y0\nG1 X5 E2.128 F1200\nG1 X15 E6.566\nG1 X15 Y20 E6.566\nG1 X0 Y20 E9";
        let parts = "M83\nG0 X0 Y0\nG1 X5 E1 F1200\nG1 E-0.1\nG1 E-0.1\nG1 E-0.1\nG1 X9 E0.3\nG1 E0.3\nG1 Y9";
        for text in [again, parts] {
            let flows = of(text, "").legs.into_iter().map(|leg| leg.flow.unwrap()[0]);
            assert!(flows.into_iter().all(|flow| flow == 0.0 || flow > 1e-12), "{text}");
        }
    }

    /// Codes without effect on motion take their own words, and messages the rest of the line.
    #[test]
    fn codes_beside_those_that_are_passed_over_are_obeyed() {
        let plain = "G0 X0 Y0\nG91\nG1 X10 E0.5 F600\nG4 S2\nG1 X10";
        for beside in [
            "G0 X0 Y0\nM107 G91\nG1 X10 E0.5 F600\nG4 P500 S2\nG1 X10",
            "T0 G0 X0 Y0\nN7 M104 T1 S200 G91*3\nM106 S255 G1 X10 E0.5 F600\nG4 P2000\nG1 X10 M106 S9",
            "G0 X0 Y0 M84\nG91 M117 G1 X3\nG1 X10 E0.5 F600 M220 S100\nG4 S2 P1 M107\nM84 X Y E\nG1 X10",
            "M205 X8 Y8\nG0 X0 Y0\nM486 A\"(G0 X7\"\ng91m107\nG1 X10 E0.5 F600\nG4 S2\nG1 X10",
        ] {
            assert_eq!(of(beside, ""), of(plain, ""), "{beside}");
        }
        for (text, words) in [("G1 M106 X10 F60", "`X`"), ("M205 E3 G91", "`E`"), ("M107 G5", "G5")]
        {
            let refused = route(text, &settings(""), 1e-3).unwrap_err();
            assert!(refused.message.contains(words), "{text}: {refused:?}");
        }
    }

    /// A full circle by G2 and half of one by G3 keep their distance from the centre, and their length.
    #[test]
    fn arcs_keep_their_radius() {
        for (text, angle, end) in [
            ("G0 X10 Y0\nG2 X10 Y0 I-10 J0 E1 F600", 2.0, [10e-3, 0.0]),
            ("G0 X10 Y0\nG3 X-10 Y0 I-10 J0 E1 F600", 1.0, [-10e-3, 0.0]),
        ] {
            let route = of(text, "");
            let length = angle * std::f64::consts::PI * 10e-3;
            assert!((route.stop() / (length / 10e-3) - 1.0).abs() < 1e-3, "{}", route.stop());
            for leg in &route.legs {
                let [x, y, _] = leg.at(leg.duration);
                assert!((x.hypot(y) / 10e-3 - 1.0).abs() < 1e-12);
                let [x, y, _] = leg.at(0.5 * leg.duration);
                assert!(x.hypot(y) > 10e-3 - 6e-6);
            }
            let last = route.legs.last().unwrap();
            let [x, y, _] = last.at(last.duration);
            assert!((x - end[0]).abs() < 1e-12 && (y - end[1]).abs() < 1e-12);
            let upper = route.legs[route.legs.len() / 3].place[0][1];
            assert!(if angle > 1.0 { upper < 0.0 } else { upper > 0.0 });
        }
    }

    /// A straight move from rest to rest takes `L/v + v/a`; one too short for its speed `2 √(L/a)`. The flow follows
    /// the speed, and all comes.
    #[test]
    fn acceleration_makes_trapezoids() {
        for (length, speed, time) in
            [(20.0, 20.0, 1.0 + 0.04), (0.2, 20.0, 2.0 * 0.4e-3_f64.sqrt())]
        {
            let text = format!("M83\nG0 X0 Y0\nG1 X{length} E1 F{}", 60.0 * speed);
            let route = of(&text, "acceleration = 0.5");
            assert!((route.stop() / time - 1.0).abs() < 1e-9, "{length}: {}", route.stop());
            let whole = std::f64::consts::FRAC_PI_4 * 1.75e-3_f64.powi(2) * 1e-3;
            assert!((route.volume_until(9.0) / whole - 1.0).abs() < 1e-9);
            for leg in &route.legs {
                let [value, slope] = leg.flow.unwrap();
                let [speed, rate] = [leg.place[1][0], leg.place[2][0]];
                assert!((value * 1e-3 * length - whole * speed).abs() < 1e-9 * whole);
                assert!((slope * 1e-3 * length - whole * rate).abs() < 1e-6 * whole);
            }
            let last = route.legs.last().unwrap();
            assert!((last.at(last.duration)[0] - 1e-3 * length).abs() < 1e-12);
        }
    }

    /// A right angle is passed with the corner speed, a straight joint with the whole speed.
    #[test]
    fn corners_slow_the_nozzle() {
        let text = "M83\nG0 X0 Y0\nG1 X20 E1 F1200\nG1 X40 E1\nG1 Y20 E1\nG1 Y40 E1";
        let route = of(text, "acceleration = 1.0\ncorner_speed = 4e-3");
        let speed_at = |place: [f64; 2]| {
            let at = |leg: &&super::super::route::Leg| {
                (leg.place[0][0] - place[0]).hypot(leg.place[0][1] - place[1]) < 1e-9
            };
            let leg = route.legs.iter().find(at).unwrap();
            leg.place[1][0].hypot(leg.place[1][1])
        };
        assert!((speed_at([20e-3, 0.0]) - 20e-3).abs() < 1e-9);
        assert!((speed_at([40e-3, 0.0]) - 4e-3).abs() < 1e-9);
        assert_eq!(speed_at([0.0, 0.0]), 0.0);
        let joints = route.legs.windows(2).all(|legs| {
            let end =
                [0, 1, 2].map(|a| legs[0].place[1][a] + legs[0].duration * legs[0].place[2][a]);
            let [end, start] = [end, legs[1].place[1]].map(|v| v[0].hypot(v[1]));
            (end - start).abs() < 1e-9 && (legs[0].stop() - legs[1].start).abs() < 1e-12
        });
        assert!(joints, "{route:?}");
    }

    #[test]
    fn lines_that_are_not_understood_are_refused() {
        for (text, line, words) in [
            ("G0 X0 Y0\nG5 X1", 2, "G5"),
            ("G0 X0 Y0\nG1 X1 E1", 2, "speed"),
            ("G1 E1 F600", 1, "before"),
            ("\n\nM600", 3, "M600"),
            ("G1 X1 Y", 1, "`Y`"),
            ("G0 X0 Y0\nG2 X1 R4 F60", 2, "I and J"),
            ("G0 X0 Y0\nG2 X9 Y0 I1 J0 F60", 2, "radius"),
            ("G0 X0 Y0\nG1 X1 A3 F60", 2, "`A`"),
            ("G0 X0 Y0\nG1 X1 F0", 2, "speed"),
            ("hello", 1, "`h`"),
            ("X1 Y2", 1, "no command"),
            ("G0 X0 Y0\nG1 X1 (wall F60", 2, "`(`"),
            ("G0 X0 Y0\nG1 X1 wall) F60", 2, "`)`"),
            ("G0 X0 Y0\nG1 X1 E1 F60\nG28\nG0 X0\nG1 X1 E2 F60", 5, "after G28"),
            ("G0 X0 Y0\nG28\nG1 X1 E1 F60", 3, "before the place"),
            ("G0 X0 Y0\nG28 Y0\nG1 X1 E1 F60", 3, "before the place"),
        ] {
            let refused = route(text, &settings(""), 1e-3).unwrap_err();
            assert!(refused.line == line && refused.message.contains(words), "{text}: {refused:?}");
        }
        let passed = "M104 S200\nM107\nG28\nM117 Hello (world) X1\nM117 :)\nT0\n; only a comment\n%\nG0 X0 Y0";
        assert!(route(passed, &settings(""), 1e-3).is_ok());
        // What machines are asked at the start, and where they go at the end.
        let plain = "G0 X0 Y0\nG1 X9 E1 F600\n";
        let whole = format!(
            "M862.3 P \"MK3S\"\nG17\nG29\nSET_PRESSURE_ADVANCE ADVANCE=0.04\n{plain}EXCLUDE_OBJECT_END NAME=a_1\n\
             G28 X0\nG0 Y90 F600\nG1 E-1 F600\nM500\n"
        );
        let [found, wanted] = [&whole, plain].map(|text| route(text, &settings(""), 1e-3).unwrap());
        assert_eq!(found, wanted);
    }
}
