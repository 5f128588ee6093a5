//! Steps that would not end: refused where that is known, and ended by another thread.

use std::thread;
use std::time::{Duration, Instant};

use crate::droplets::{PLATE, WALL, started};
use crate::master::{DISCARD, ERROR, Handle, OK, Unit, call};

/// The time within which a step ends that is not to be computed, with all that other tests do.
const SOON: Duration = Duration::from_secs(20);

/// A step is discarded for its length, and leaves the unit as it was.
#[track_caller]
fn discarded(unit: &Unit, step: f64, words: &[&str]) {
    let before = unit.snapshot();
    let (begin, time) = (Instant::now(), unit.time());
    unit.messages.take();
    assert_eq!(unit.step(time, step), DISCARD, "{:?}", unit.messages.take());
    assert!(begin.elapsed() < SOON);
    unit.expect_message(DISCARD, words);
    assert_eq!((unit.snapshot(), unit.time()), (before, time));
}

const WORDS: [&str; 2] = ["more than a communication step may take", "shorter"];

#[test]
fn a_step_that_would_take_a_droplet_for_ever_is_discarded() {
    for step in [1e3, 1e60] {
        let unit = started(WALL);
        discarded(&unit, step, &[WORDS[0], WORDS[1], "drop: ", "time steps of a droplet"]);
    }
    // What makes a droplet's own steps as short as that does so too.
    let text = WALL.replace("viscosity = 1e-3", "viscosity = 1e6");
    let text = text.replace("kind = \"droplet\"", "kind = \"droplet\"\nviscous = \"explicit\"");
    let unit = started(&text);
    discarded(&unit, 1e-5, &[WORDS[0], WORDS[1], "drop: "]);
}

/// A day of 20 000 particles was once allowed, as if each were a single unknown; the step that is proposed is.
#[test]
fn a_step_of_many_particles_that_takes_a_day_is_discarded_with_one_that_does_not() {
    let text = WALL.replace("spacing = 1e-5", "spacing = 2e-6").replace(
        "arrivals = [{ time = 0.0 }, { time = 4e-7, x = 8e-5 }]\n",
        "symmetry = \"none\"\n",
    );
    let unit = started(&text);
    assert_eq!(unit.step(0.0, 1e-2), DISCARD);
    let messages = unit.messages.take();
    let said = &messages[messages.len() - 1].text;
    let step = said.split("(of ").nth(1).and_then(|rest| rest.split(' ').next());
    let step: f64 = step.unwrap_or_else(|| panic!("{said}")).parse().unwrap();
    assert!((1e-4..5e-3).contains(&step), "{said}");
}

#[test]
fn exchanges_without_end_are_discarded() {
    let unit = started(&PLATE.replace("interval = 5e-8", "interval = 1e-25"));
    discarded(&unit, 1e-7, &[WORDS[0], "exchanges between bodies"]);
}

#[test]
fn moves_of_a_tiny_footprint_are_discarded() {
    let text = crate::master::SCENE
        .replace("start = { heat_flux = 5e7 }", "start = { heat_flux = 5e7, radius = 1e-11 }")
        .replace("radius = [2e-5, 9e-5]", "radius = [1e-12, 9e-5]");
    assert_ne!(text, crate::master::SCENE);
    let unit = started(&text);
    assert_eq!(unit.set_derivative("spot.x", 1, 50.0), OK, "{:?}", unit.messages.take());
    discarded(&unit, 1e-6, &[WORDS[0], "samples of moving footprints", "plate: "]);
}

/// A unit that another thread may ask to end its step.
#[derive(Clone, Copy)]
pub struct Shared(pub Handle);
// SAFETY: for the one call that may come while another runs.
unsafe impl Send for Shared {}

impl Shared {
    pub fn cancel(self) -> i32 {
        call!("fmi2CancelStep", self.0 => Handle)
    }
}

#[test]
fn a_long_step_ends_when_another_thread_cancels_it() {
    for scene in [WALL, PLATE] {
        let unit = started(scene);
        assert_eq!(unit.step(0.0, 1e-7), OK);
        let before = unit.serialize(unit.save());
        let values = unit.snapshot();
        let shared = Shared(unit.handle);
        let canceller = thread::spawn(move || {
            // Until the step has begun there is nothing to cancel.
            while shared.cancel() != OK {
                thread::sleep(Duration::from_millis(1));
            }
        });
        let begin = Instant::now();
        // Minutes of computation and more, but no more than a step may take.
        assert_eq!(unit.step(1e-7, 5e-4), DISCARD, "{:?}", unit.messages.take());
        assert!(begin.elapsed() < SOON);
        canceller.join().unwrap();
        let messages = unit.messages.take();
        let last = messages.last().unwrap();
        assert!(last.text.contains("fmi2DoStep") && last.text.contains("cancelled"), "{last:?}");
        // In stepCanceled values can be read, but only a saved state, a reset or the end may follow.
        assert_eq!(unit.snapshot(), values);
        assert_eq!(unit.step(1e-7, 1e-8), ERROR);
        unit.expect_message(ERROR, &["not allowed in state stepCanceled"]);
        assert_eq!(unit.restore(unit.deserialize(&before)), OK);
        assert_eq!(unit.step(1e-7, 1e-8), OK, "{:?}", unit.messages.take());
    }
}

#[test]
fn without_a_step_there_is_nothing_to_cancel() {
    let unit = started(WALL);
    assert_eq!(Shared(unit.handle).cancel(), ERROR);
    assert_eq!(unit.step(0.0, 1e-8), OK);
    unit.messages.take();
    assert_eq!(Shared(unit.handle).cancel(), ERROR);
    unit.expect_message(ERROR, &["fmi2CancelStep"]);
    assert_eq!(unit.step(1e-8, 1e-8), OK);
}
