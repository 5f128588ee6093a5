//! A small master of both versions: loads the library, unpacks the test scene, records the log.

pub mod three;
pub mod two;
mod unit;
mod version;

use std::ffi::{c_int, c_void};
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock};
use std::{env, fs, process};

use impinge::fmi::guid;
use impinge::scene;
use impinge::variables::Registry;
use libloading::Library;

pub use two::{Arguments, Callbacks, Unit, free};
pub use unit::Unit as UnitOf;
pub(crate) use version::both_versions;
pub use version::{Three, Two, Version};

pub const SCENE: &str = include_str!("../scene.toml");

/// A strip between rollers that breaks when it is cooled by 115 K, in less than 10 ms.
pub const STRIP: &str = r#"
name = "Strip"
stop_time = 10.0
step = 1.0
[body.plate]
kind = "solid"
shape = { box = [0.6e-3, 1e-3, 0.3e-3] }
section = "plane_stress"
initial_temperature = 600.0
[body.plate.material]
model = "thermoelastic"
density = 3980.0
specific_heat = 880.0
conductivity = 31.0
young = 340e9
poisson = 0.22
expansion = 8e-6
fracture = { model = "at1", strength = 300e6, energy = 45.0, scatter = 0.04 }
[body.plate.faces]
left = { roller = true }
right = { roller = true }
bottom = { temperature = 600.0, roller = true }
top = { temperature = 600.0 }
"#;

pub const OK: c_int = 0;
pub const WARNING: c_int = 1;
pub const DISCARD: c_int = 2;
pub const ERROR: c_int = 3;

pub type Handle = *mut c_void;
/// `fmi2FMUstate` or `fmi3FMUState`.
pub type Saved = *mut c_void;
#[derive(Debug, Clone, PartialEq)]
pub struct Message {
    pub instance: String,
    pub status: c_int,
    pub category: String,
    pub text: String,
}

/// What the logger was told, oldest first.
#[derive(Default)]
pub struct Messages(Mutex<Vec<Message>>);

impl Messages {
    /// Hands out all messages and forgets them.
    pub fn take(&self) -> Vec<Message> {
        std::mem::take(&mut *self.0.lock().unwrap())
    }

    pub fn keep(&self, message: Message) {
        self.0.lock().unwrap().push(message);
    }

    /// The one message since the last look, of this status, with the fragments in its text.
    #[track_caller]
    pub fn expect_one(&self, status: c_int, fragments: &[&str]) -> Message {
        let messages = self.take();
        let [message] = &messages[..] else { panic!("not one message: {messages:#?}") };
        assert_eq!(message.status, status, "{message:?}");
        for fragment in fragments {
            assert!(message.text.contains(fragment), "no {fragment:?} in {:?}", message.text);
        }
        message.clone()
    }
}

/// The library that cargo built along with this test.
pub fn library() -> &'static Library {
    static LIBRARY: OnceLock<Library> = OnceLock::new();
    LIBRARY.get_or_init(|| {
        let test = env::current_exe().unwrap();
        let path = test.with_file_name(libloading::library_filename("impinge"));
        // SAFETY: the library runs nothing when loaded.
        unsafe { Library::new(&path) }.unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    })
}

/// Calls an exported function: `call!("fmi2Reset", unit.handle)`, all of whose arguments have the C
/// types, as `fmi2Status`.
macro_rules! call {
    ($name:expr $(, $argument:expr => $type:ty)*) => {{
        type Function = unsafe extern "C" fn($($type),*) -> std::ffi::c_int;
        // SAFETY: every use in these tests states the types of the standard's header.
        unsafe {
            let function = $crate::master::library().get::<Function>($name).unwrap();
            function($($argument),*)
        }
    }};
}
pub(crate) use call;

/// A folder that is removed when done.
pub struct Folder(pub PathBuf);

impl Folder {
    pub fn new(name: &str) -> Self {
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        let path = env::temp_dir().join(format!("impinge-{}-{count}-{name}", process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    /// A folder of resources with this text as its scene.
    pub fn with_scene(name: &str, text: &str) -> Self {
        let folder = Self::new(name);
        fs::write(folder.0.join("scene.toml"), text).unwrap();
        folder
    }

    pub fn uri(&self) -> String {
        format!("file://{}", self.0.display())
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

pub fn registry() -> Registry {
    Registry::of(&scene::parse(SCENE, "scene.toml").unwrap())
}

pub fn own_guid() -> String {
    guid::guid(SCENE, &registry())
}

/// Frees an instance by the version's function for that.
fn free_instance(function: &str, handle: Handle) {
    // SAFETY: the type is that of the headers.
    unsafe {
        let free = library().get::<unsafe extern "C" fn(Handle)>(function).unwrap();
        free(handle);
    }
}
