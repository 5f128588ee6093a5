//! The state machine of FMI 2.0.4, section 4.2.4, and that of FMI 3.0, sections 2.3 and 4.2.

use crate::master::{ERROR, Folder, OK, UnitOf, Version, both_versions};

both_versions! {
    every_call_is_allowed_exactly_when_the_standard_says_so,
    an_untimely_call_changes_nothing,
    a_unit_can_be_freed_in_every_phase,
    a_terminated_unit_still_answers_and_can_start_again,
    reset_brings_back_the_start_values_and_the_same_run,
}

/// A phase by its letter in the tables of functions, and a unit in it.
type Phase<V> = (char, fn() -> UnitOf<V>);

/// Phases that a master can bring a unit into.
fn phases<V: Version>() -> [Phase<V>; 4] {
    [
        ('i', UnitOf::instantiated),
        ('m', UnitOf::initializing),
        ('s', UnitOf::running),
        ('t', UnitOf::terminated),
    ]
}

/// Words of the log when a call comes at the wrong time.
const UNTIMELY: [&str; 3] = ["not allowed in state", "belongs to", "this unit has no"];

fn every_call_is_allowed_exactly_when_the_standard_says_so<V: Version>() {
    for (names, allowed, call) in V::FUNCTIONS {
        for (&name, (letter, make)) in names.iter().flat_map(|n| phases::<V>().map(|p| (n, p))) {
            let unit = make();
            unit.messages.take();
            let status = call(&unit, name);
            let messages = unit.messages.take();
            let untimely = messages.iter().any(|m| UNTIMELY.iter().any(|w| m.text.contains(w)));
            assert_eq!(!untimely, allowed.contains(letter), "{name} in {letter}: {messages:?}");
            assert!(!untimely || status == ERROR, "{name} in {letter}: {status}");
            let named = messages.iter().all(|m| m.status == OK || m.text.starts_with(name));
            assert!(named, "{name} in {letter}: {messages:?}");
        }
    }
}

fn an_untimely_call_changes_nothing<V: Version>() {
    for (letter, make) in phases::<V>().into_iter().skip(2) {
        let unit = make();
        let before = unit.snapshot();
        for (names, _, call) in
            V::FUNCTIONS.iter().filter(|(_, allowed, _)| !allowed.contains(letter))
        {
            for name in *names {
                call(&unit, name);
                assert_eq!(unit.snapshot(), before, "{name} in {letter}");
                assert_eq!(unit.time(), 0.0, "{name} in {letter}");
            }
        }
    }
}

fn a_unit_can_be_freed_in_every_phase<V: Version>() {
    for (_, make) in phases::<V>() {
        drop(make());
    }
}

fn a_terminated_unit_still_answers_and_can_start_again<V: Version>() {
    let unit = UnitOf::<V>::running();
    assert_eq!(unit.advance(0.0, 1e-8), OK);
    let heat = unit.value("plate.heat_in");
    assert_eq!(unit.terminate(), OK);
    assert_eq!(unit.value("plate.heat_in"), heat);
    assert_eq!([unit.reset(), unit.begin(0.0, None), unit.exit()], [OK; 3]);
    assert_eq!(unit.value("plate.heat_in"), 0.0);
}

fn reset_brings_back_the_start_values_and_the_same_run<V: Version>() {
    type Act<V> = fn(&UnitOf<V>) -> i32;
    let fresh = UnitOf::<V>::running();
    let unit = UnitOf::<V>::instantiated();
    let folder = Folder::new("fields");
    let whole: [Act<V>; 4] = [
        |unit| unit.begin(1e-6, Some(2e-6)),
        UnitOf::exit,
        |unit| unit.advance(1e-6, 1e-8),
        UnitOf::terminate,
    ];
    for way in (0..=whole.len()).map(|length| &whole[..length]) {
        assert_eq!(unit.put("plate.conductivity", 20.0), OK);
        assert_eq!(unit.put("spot.heat_flux", 1e6), OK);
        assert_eq!(unit.set_all(&V::family(&unit, "patch.heat_flux"), &[1e6; 6]), OK);
        assert_eq!(unit.set_threads(1), OK);
        assert_eq!(unit.set_directory(&folder.0), OK);
        way.iter().for_each(|act| assert_eq!(act(&unit), OK));
        assert_eq!(unit.reset(), OK);
    }
    assert_eq!([unit.begin(0.0, None), unit.exit()], [OK; 2]);
    for at in 0..3 {
        assert_eq!(unit.snapshot(), fresh.snapshot());
        assert_eq!(unit.advance(f64::from(at) * 1e-8, 1e-8), OK);
        assert_eq!(fresh.advance(f64::from(at) * 1e-8, 1e-8), OK);
    }
    assert_eq!(unit.snapshot(), fresh.snapshot());
}
