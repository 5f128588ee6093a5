//! Instances come and go without a trace.

use crate::master::{Arguments, Folder, Messages, OK, SCENE, Unit, free};

/// What this process holds in memory [B].
#[cfg(target_os = "linux")]
fn resident() -> usize {
    let pages = std::fs::read_to_string("/proc/self/statm").unwrap();
    let pages: usize = pages.split(' ').nth(1).unwrap().parse().unwrap();
    pages * 4096
}

/// Instantiates, steps, saves a state that is never freed, resets and frees.
#[cfg(target_os = "linux")]
fn live() {
    let unit = Unit::initializing();
    assert_eq!(unit.exit(), OK);
    assert_eq!(unit.step(0.0, 1e-8), OK);
    unit.save();
    assert_eq!(unit.get("plate.max_von_mises"), unit.get("plate.max_von_mises"));
    assert_eq!(unit.reset(), OK);
}

/// Runs alone in a process of its own, where no other test takes memory; see below.
#[cfg(target_os = "linux")]
#[test]
#[ignore = "is run by two_hundred_lives_leave_no_memory_behind"]
fn two_hundred_lives() {
    // Keeps the model, so that it is built once.
    let holder = Unit::running();
    (0..50).for_each(|_| live());
    let before = resident();
    (0..200).for_each(|_| live());
    let grown = resident().saturating_sub(before);
    // A saved state alone takes more than 30 kB: 200 of them would be 6 MB.
    assert!(grown < 4 << 20, "{grown} bytes more than before");
    drop(holder);
}

#[cfg(target_os = "linux")]
#[test]
fn two_hundred_lives_leave_no_memory_behind() {
    let output = std::process::Command::new(std::env::current_exe().unwrap())
        .args(["--ignored", "--exact", "endurance::two_hundred_lives"])
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && text.contains("1 passed"), "{text}");
}

#[test]
fn refused_instances_leave_nothing_behind_either() {
    let folder = Folder::with_scene("refused", SCENE);
    let messages = Messages::default();
    for _ in 0..500 {
        let arguments = Arguments { guid: Some(c"{no}".into()), ..Arguments::good(&folder) };
        let handle = arguments.instantiate(&messages);
        assert!(handle.is_null());
        free(handle);
    }
    assert_eq!(messages.take().len(), 500);
}
