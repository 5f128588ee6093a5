//! Reads lines of G-code as a machine does: word by word, with its modes.

use std::f64::consts::{FRAC_PI_4, TAU};

use super::{BadLine, Step};
use crate::limits::number;
use crate::scene::filament::PathFile;

/// Codes without effect on motion and flow: temperatures, fans, motors, messages, limits of firmware, metadata.
const PASSED_OVER: [&str; 41] = [
    "G17", "G29", "M17", "M18", "M73", "M74", "M75", "M77", "M84", "M104", "M105", "M106", "M107",
    "M109", "M110", "M115", "M117", "M118", "M140", "M141", "M155", "M190", "M191", "M201", "M203",
    "M204", "M205", "M220S100", "M221S100", "M300", "M400", "M420", "M486", "M500", "M501", "M502",
    "M503", "M572", "M593", "M900", "T0",
];
/// Codes whose rest of the line is text: messages, names of jobs, of objects and of machines, and commands by words that
/// move nothing.
const MESSAGES: [&str; 12] = [
    "M75",
    "M117",
    "M118",
    "M486",
    "M862.1",
    "M862.2",
    "M862.3",
    "M862.4",
    "M862.5",
    "M862.6",
    "EXCLUDE_OBJECT",
    "SET_PRESSURE_ADVANCE",
];
/// Words of moves, which belong to no code that is passed over beside a code that is obeyed.
const OF_MOVES: &str = "XYZEFIJ";
const UNDERSTOOD: &str = "G0, G1, G2 and G3 with I and J, G4, G20, G21, G90, G91, G92, M82, M83; codes of temperatures, fans and messages";
/// Metres of a millimetre and of an inch.
const MILLIMETRE: f64 = 1e-3;
const INCH: f64 = 25.4e-3;
/// Largest distance of a chord from its arc [m], and largest number of chords.
const SAGITTA: f64 = 5e-6;
const MOST_CHORDS: f64 = 3600.0;
/// Difference of an arc's radii at its ends, over the radius.
const ROUND: f64 = 0.01;
/// Radii that differ by less are equal [m].
const LEAST: f64 = 2e-5;
/// Rounding of places [m], and that of lengths of filament, over the length.
const STILL: f64 = 1e-13;
const NO_FEED: f64 = 1e-10;

/// Letters and numbers of a line.
type Words = Vec<(char, f64)>;

struct Machine<'a> {
    settings: &'a PathFile,
    /// Metres of a unit of length.
    unit: f64,
    is_relative: bool,
    feeds_relative: bool,
    /// Place of the outlet on the plate [m], each axis once it is known; `height` is that of an unknown z.
    place: [Option<f64>; 3],
    height: f64,
    /// Place on the plate at which the coordinates are zero [m].
    zero: [f64; 3],
    /// Length of filament by its last word E, and length that is drawn back [m].
    fed: f64,
    drawn_back: f64,
    /// [m/s]
    speed: Option<f64>,
    /// True once the nozzle has gone home after the path began: the path ends there.
    is_home: bool,
    steps: Vec<Step>,
}

/// Reason why a line is refused, and what is allowed.
type Refusal = (String, String);

/// Steps of a text.
pub fn steps(text: &str, settings: &PathFile, height: f64) -> Result<Vec<Step>, BadLine> {
    let [x, y] = settings.origin;
    let mut machine = Machine {
        settings,
        unit: MILLIMETRE,
        is_relative: false,
        feeds_relative: false,
        place: [None; 3],
        height,
        zero: [x, y, 0.0],
        fed: 0.0,
        drawn_back: 0.0,
        speed: None,
        is_home: false,
        steps: Vec::new(),
    };
    for (n, line) in text.lines().enumerate() {
        machine.read(line).map_err(|(message, allowed)| BadLine {
            line: n + 1,
            text: line.trim().to_owned(),
            message,
            allowed,
        })?;
    }
    Ok(machine.steps)
}

/// Returns the line without comments and checksum. Within brackets every letter belongs to the comment, also those that
/// end a line elsewhere.
fn bare(line: &str) -> Result<String, Refusal> {
    let mut depth = 0_usize;
    let mut text = String::new();
    for letter in line.chars() {
        match letter {
            '(' => depth += 1,
            ')' => depth = depth.checked_sub(1).ok_or_else(|| unbalanced(letter))?,
            ';' | '*' | '%' if depth == 0 => break,
            _ if depth == 0 => text.push(letter),
            _ => {}
        }
    }
    if depth == 0 { Ok(text) } else { Err(unbalanced('(')) }
}

/// Number that follows a letter.
fn word(values: &Words, letter: char) -> Option<f64> {
    values.iter().find(|(own, _)| *own == letter).map(|word| word.1)
}

fn unbalanced(bracket: char) -> Refusal {
    let message = format!("the bracket `{bracket}` of a comment has no counterpart");
    (message, "comments as in G1 X10 (wall), or after a semicolon".to_owned())
}

/// Words of a line. Axes that go home need no number.
fn words_of(line: &str) -> Result<Words, Refusal> {
    let goes_home = begins_with(line, &["G28"]);
    let mut words = Words::new();
    let mut rest = line.trim();
    while let Some(letter) = rest.chars().next() {
        let after = rest[letter.len_utf8()..].trim_start();
        let end = after.find(|c: char| !(c.is_ascii_digit() || "+-.".contains(c)));
        let (value, next) = after.split_at(end.unwrap_or(after.len()));
        let is_axis = goes_home && value.is_empty();
        let value = if is_axis { "0" } else { value };
        let value: Option<f64> = value.parse().ok().filter(|value: &f64| value.is_finite());
        let (true, Some(value)) = (letter.is_ascii_alphabetic(), value) else {
            let message = format!("`{letter}` stands without a number");
            return Err((message, "words of a letter and a number, as in G1 X10 Y5".to_owned()));
        };
        if next.starts_with(['e', 'E']) {
            let message = format!("`{letter}{value}{}`: an exponent, or a word E", &next[..1]);
            return Err((message, "numbers without exponents, and a space before E".to_owned()));
        }
        words.push((letter.to_ascii_uppercase(), value));
        rest = next.trim_start();
    }
    if words.first().is_some_and(|(letter, _)| *letter == 'N') {
        words.remove(0);
    }
    Ok(words)
}

impl Machine<'_> {
    fn read(&mut self, line: &str) -> Result<(), Refusal> {
        // Messages may contain any brackets.
        if begins_with(line, &MESSAGES) {
            return Ok(());
        }
        let words = words_of(&obeyed(&bare(line)?)?)?;
        let is_code = |&&(letter, _): &&(char, f64)| matches!(letter, 'G' | 'M' | 'T');
        let codes: Vec<_> = words.iter().filter(is_code).copied().collect();
        let values: Words = words.iter().filter(|word| !is_code(word)).copied().collect();
        let is_again =
            |(n, word): (usize, &(char, f64))| values[..n].iter().any(|old| old.0 == word.0);
        if let Some((letter, _)) =
            values.iter().enumerate().find(|own| is_again(*own)).map(|own| *own.1)
        {
            let message = format!("`{letter}` is given twice");
            return Err((message, "each letter once in a line".to_owned()));
        }
        if codes.is_empty() && !values.is_empty() {
            return Err(("the line has no command".to_owned(), UNDERSTOOD.to_owned()));
        }
        check_order(&codes)?;
        codes.into_iter().try_for_each(|code| self.obey(code, &values))
    }

    fn obey(&mut self, (letter, code): (char, f64), values: &Words) -> Result<(), Refusal> {
        let code = format!("{letter}{code}");
        match code.as_str() {
            "G0" | "G1" | "G2" | "G3" | "G4" if self.is_home => self.go_on_from_home(values)?,
            "G0" | "G1" => self.go(values)?,
            "G2" | "G3" => self.arc(values, code == "G2")?,
            "G4" => self.dwell(values)?,
            "G20" => self.unit = INCH,
            "G21" => self.unit = MILLIMETRE,
            // No fluid comes at home, and the path begins afterwards.
            "G28" if self.steps.is_empty() => self.home(values),
            "G28" => self.is_home = true,
            "G90" => self.is_relative = false,
            "G91" => self.is_relative = true,
            "G92" => self.rename(values)?,
            "M82" => self.feeds_relative = false,
            "M83" => self.feeds_relative = true,
            _ => return Err((format!("{code} is not understood"), UNDERSTOOD.to_owned())),
        }
        Ok(())
    }

    /// Forgets the place along the axes that go home, and that it was renamed; if none is named, all axes go.
    fn home(&mut self, values: &Words) {
        let [x, y] = self.settings.origin;
        let go_all = !values.iter().any(|(named, _)| "XYZ".contains(*named));
        for (axis, (letter, zero)) in [('X', x), ('Y', y), ('Z', 0.0)].into_iter().enumerate() {
            if go_all || values.iter().any(|(named, _)| *named == letter) {
                self.place[axis] = None;
                self.zero[axis] = zero;
            }
        }
    }

    /// Leaves out moves after the nozzle has gone home, which takes a time that is not known.
    fn go_on_from_home(&mut self, values: &Words) -> Result<(), Refusal> {
        let [volume, _] = self.feed(values);
        match volume > 0.0 {
            true => Err((
                "fluid comes after G28, whose way takes a time that is not known".to_owned(),
                "G28 before the first move, or after the last on which fluid comes".to_owned(),
            )),
            false => Ok(()),
        }
    }

    /// Place at which the words of a line end [m].
    fn end(&self, values: &Words) -> Result<[Option<f64>; 3], Refusal> {
        let mut end = self.place;
        for &(letter, value) in values {
            let axis = match letter {
                'X' => 0,
                'Y' => 1,
                'Z' => 2,
                _ => continue,
            };
            end[axis] = match (self.is_relative, self.place[axis]) {
                (false, _) => Some(self.zero[axis] + value * self.unit),
                (true, Some(place)) => Some(place + value * self.unit),
                (true, None) => {
                    let message = format!("{letter} is relative to a place that is not known");
                    return Err((message, "an absolute place before".to_owned()));
                }
            };
        }
        Ok(end)
    }

    /// Volume that the word E of a line lets come [m³], and the length that it moves the filament [m].
    fn feed(&mut self, values: &Words) -> [f64; 2] {
        let Some(value) = word(values, 'E') else { return [0.0; 2] };
        let to = value * self.unit;
        let (length, fed) = match self.feeds_relative {
            true => (to, self.fed + to),
            false => (above_rounding(to - self.fed, to), to),
        };
        self.fed = fed;
        let comes = above_rounding(length - self.drawn_back, self.drawn_back).max(0.0);
        self.drawn_back = (self.drawn_back - length).max(0.0);
        let section = FRAC_PI_4 * self.settings.filament_diameter.powi(2);
        [section * comes, length.abs()]
    }

    fn check_words(&mut self, values: &Words, known: &str) -> Result<(), Refusal> {
        if let Some((letter, _)) = values.iter().find(|(letter, _)| !known.contains(*letter)) {
            let message = format!("`{letter}` is no word of this command");
            return Err((message, known.chars().map(String::from).collect::<Vec<_>>().join(", ")));
        }
        if let Some(speed) = word(values, 'F') {
            if speed <= 0.0 {
                let message = "the speed F is not above zero".to_owned();
                return Err((message, "F in units of length per minute".to_owned()));
            }
            self.speed = Some(speed * self.unit / 60.0);
        }
        Ok(())
    }

    fn speed(&self) -> Result<f64, Refusal> {
        self.speed.ok_or_else(|| {
            ("no speed is set for this move".to_owned(), "a word F here or before".to_owned())
        })
    }

    fn go(&mut self, values: &Words) -> Result<(), Refusal> {
        self.check_words(values, "XYZEF")?;
        let end = self.end(values)?;
        let [volume, length] = self.feed(values);
        self.travel(end, volume, length)
    }

    /// Moves to a place, or feeds at rest. Before x and y are known, places take no time.
    fn travel(&mut self, end: [Option<f64>; 3], volume: f64, length: f64) -> Result<(), Refusal> {
        let [Some(from_x), Some(from_y), from_z] = self.place else {
            self.place = end;
            return match volume > 0.0 {
                true => Err((
                    "fluid comes before the place of the nozzle is known".to_owned(),
                    "a move G0 with X and Y before".to_owned(),
                )),
                false => Ok(()),
            };
        };
        let from = [from_x, from_y, from_z.unwrap_or(self.height)];
        let is_still =
            |axis: usize, to: f64| (to - from[axis]).abs() <= STILL * from[axis].abs().max(1.0);
        let to = [0, 1, 2].map(|axis| match end[axis] {
            Some(to) if !is_still(axis, to) => to,
            _ => from[axis],
        });
        self.place = to.map(Some);
        if to != from {
            let speed = self.speed()?;
            self.steps.push(Step::Move { from, to, volume, speed });
        } else if length > 0.0 {
            let duration = length / self.speed()?;
            self.steps.push(Step::Rest { at: to, duration, volume });
        }
        Ok(())
    }

    /// An arc around a centre that I and J set from its beginning, as chords.
    fn arc(&mut self, values: &Words, is_clockwise: bool) -> Result<(), Refusal> {
        let find = |letter: char| word(values, letter);
        if find('R').is_some() || (find('I').is_none() && find('J').is_none()) {
            let message = "an arc is understood by its centre, I and J".to_owned();
            return Err((
                message,
                "I and J from the beginning of the arc to its centre".to_owned(),
            ));
        }
        self.check_words(values, "XYZIJEF")?;
        let [Some(x), Some(y), z] = self.place else {
            let message = "the arc begins before the place of the nozzle is known".to_owned();
            return Err((message, "a move G0 with X and Y before".to_owned()));
        };
        let end = self.end(values)?;
        let [to_x, to_y] = [end[0].unwrap_or(x), end[1].unwrap_or(y)];
        let [i, j] = ['I', 'J'].map(|letter| find(letter).unwrap_or(0.0) * self.unit);
        let centre = [x + i, y + j];
        let radius = i.hypot(j);
        let other = (to_x - centre[0]).hypot(to_y - centre[1]);
        if (radius - other).abs() > LEAST.max(ROUND * radius) || radius == 0.0 {
            let [radius, other] = [radius, other].map(|radius| number(1e3 * radius));
            let message =
                format!("the radius is {radius} mm at the beginning and {other} mm at the end");
            return Err((message, "equal distances of both ends from the centre".to_owned()));
        }
        let [first, last] =
            [[-i, -j], [to_x - centre[0], to_y - centre[1]]].map(|[x, y]| y.atan2(x));
        let turn = if is_clockwise { first - last } else { last - first };
        let turn = turn.rem_euclid(TAU);
        let turn = if turn < 1e-9 { TAU } else { turn };
        let angle = if is_clockwise { -turn } else { turn };
        let widest = 2.0 * (1.0 - SAGITTA / radius).max(0.0).acos();
        let count = (turn / widest).ceil().clamp(1.0, MOST_CHORDS);
        let [volume, length] = self.feed(values);
        let from_z = z.unwrap_or(self.height);
        let to_z = end[2].unwrap_or(from_z);
        for n in 1..=count as usize {
            let part = n as f64 / count;
            let (sine, cosine) = (first + part * angle).sin_cos();
            let on_arc = [centre[0] + radius * cosine, centre[1] + radius * sine];
            let [x, y] = if n as f64 == count { [to_x, to_y] } else { on_arc };
            let place = [x, y, from_z + part * (to_z - from_z)];
            self.travel(place.map(Some), volume / count, length / count)?;
        }
        Ok(())
    }

    fn dwell(&mut self, values: &Words) -> Result<(), Refusal> {
        self.check_words(values, "PS")?;
        let find = |letter: char| word(values, letter);
        // Seconds take precedence, as in common firmware.
        let duration = find('S').or_else(|| Some(1e-3 * find('P')?)).unwrap_or(0.0);
        if duration < 0.0 {
            let message = "the nozzle rests for a negative time".to_owned();
            return Err((message, "P in ms or S in s".to_owned()));
        }
        if let [Some(x), Some(y), z] = self.place {
            let at = [x, y, z.unwrap_or(self.height)];
            self.steps.push(Step::Rest { at, duration, volume: 0.0 });
        }
        Ok(())
    }

    /// Renames the present place and the length of filament; without words, all become zero.
    fn rename(&mut self, values: &Words) -> Result<(), Refusal> {
        self.check_words(values, "XYZE")?;
        let all = || "XYZE".chars().map(|letter| (letter, 0.0)).collect();
        let values = if values.is_empty() { all() } else { values.clone() };
        for (letter, value) in values {
            let value = value * self.unit;
            match letter {
                'E' => self.fed = value,
                _ => {
                    let axis = usize::from(letter as u8 - b'X');
                    let Some(place) = self.place[axis] else {
                        let message = format!("{letter} is renamed before its place is known");
                        return Err((message, "a move G0 before".to_owned()));
                    };
                    self.zero[axis] = place - value;
                }
            }
        }
        Ok(())
    }
}

/// Refuses codes of units and modes behind a move: machines differ in whether that move obeys them.
fn check_order(codes: &[(char, f64)]) -> Result<(), Refusal> {
    let moves = |&(letter, code): &(char, f64)| letter == 'G' && code <= 4.0;
    let Some(first) = codes.iter().position(moves) else { return Ok(()) };
    match codes[first + 1..].iter().find(|code| !moves(code)) {
        None => Ok(()),
        Some((letter, code)) => Err((
            format!("{letter}{code} stands behind a move, which may obey it or not"),
            "codes of units and modes before the move, or in lines of their own".to_owned(),
        )),
    }
}

/// Returns a change of a length, or zero if it is due to rounding.
fn above_rounding(change: f64, length: f64) -> f64 {
    if change.abs() <= NO_FEED * length.abs() { 0.0 } else { change }
}

/// Returns the line without codes that have no effect on motion and flow, with their words up to the next code. Those
/// need not be numbers, and messages take the rest of the line.
fn obeyed(line: &str) -> Result<String, Refusal> {
    let parts = parts_of(line);
    let before = parts.iter().take_while(|part| !begins_with(part, &MESSAGES));
    let (passed, kept): (Vec<&str>, Vec<&str>) =
        before.partition(|part| begins_with(part, &PASSED_OVER));
    let is_obeyed = kept.iter().any(|part| part.starts_with(['G', 'g', 'M', 'm']));
    for part in passed.iter().filter(|_| is_obeyed) {
        let is_of_move = |letter: &char| OF_MOVES.contains(letter.to_ascii_uppercase());
        if let Some(letter) = part.chars().find(is_of_move) {
            let message =
                format!("`{letter}` stands behind `{}`, which moves nothing", part.trim());
            return Err((message, "codes in lines of their own".to_owned()));
        }
    }
    Ok(kept.concat())
}

/// Parts of a line, each of which begins with a code, and what stands before the first one.
fn parts_of(line: &str) -> Vec<&str> {
    let is_number = |c: char| c.is_ascii_digit() || "+-.".contains(c);
    let codes = line.char_indices().filter(|&(place, letter)| {
        "GMgm".contains(letter) && line[place + 1..].trim_start().starts_with(is_number)
    });
    let starts: Vec<usize> = [0].into_iter().chain(codes.map(|(place, _)| place)).collect();
    let ends = starts[1..].iter().copied().chain([line.len()]);
    starts.iter().zip(ends).map(|(&start, end)| &line[start..end]).collect()
}

/// Returns true if a line begins with one of these codes, behind its number.
fn begins_with(line: &str, codes: &[&str]) -> bool {
    let line = line.trim();
    let line = match line.strip_prefix(['N', 'n']) {
        Some(rest) => rest.trim_start_matches(|c: char| c.is_ascii_digit()).trim_start(),
        None => line,
    };
    let compact: String = line.split_whitespace().collect::<String>().to_ascii_uppercase();
    codes.iter().any(|code| {
        let rest = compact.strip_prefix(code);
        rest.is_some_and(|rest| !rest.starts_with(|c: char| c.is_ascii_digit() || c == '.'))
    })
}
