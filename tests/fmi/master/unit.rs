//! An instance, and what a master does with it under either version.

use std::ffi::{CStr, CString, c_char, c_int};
use std::marker::PhantomData;
use std::path::Path;
use std::ptr;

use impinge::fmi::guid;
use impinge::scene;
use impinge::variables::{ArrayRegistry, Registry};

use super::version::Version;
use super::{Folder, Handle, Messages, OK, SCENE, Saved, call, free_instance};

/// An instance of a scene, freed at the end.
pub struct Unit<V: Version> {
    pub handle: Handle,
    pub messages: Box<Messages>,
    pub guid: String,
    pub registry: Registry,
    pub arrays: ArrayRegistry,
    _folder: Folder,
    version: PhantomData<V>,
}

impl<V: Version> Drop for Unit<V> {
    fn drop(&mut self) {
        free_instance(&V::name("FreeInstance"), self.handle);
    }
}

impl<V: Version> Unit<V> {
    /// An instance that `make` makes of the folder of a scene and its GUID.
    pub fn made(text: &str, make: impl FnOnce(&Folder, &str, &Messages) -> Handle) -> Self {
        let folder = Folder::with_scene("unit", text);
        let messages = Box::<Messages>::default();
        let scene = scene::parse(text, "scene.toml").unwrap();
        let (registry, arrays) = (Registry::of(&scene), ArrayRegistry::of(&scene));
        let guid = guid::guid(text, &registry);
        let handle = make(&folder, &guid, &messages);
        assert!(!handle.is_null(), "{:?}", messages.take());
        Self { handle, messages, guid, registry, arrays, _folder: folder, version: PhantomData }
    }

    /// An instance of another scene than the usual one.
    pub fn of_scene(text: &str) -> Self {
        Self::made(text, V::instantiate)
    }

    pub fn instantiated() -> Self {
        Self::of_scene(SCENE)
    }

    pub fn initializing() -> Self {
        let unit = Self::instantiated();
        assert_eq!(unit.begin(0.0, None), OK);
        unit
    }

    /// Ready for steps.
    pub fn running() -> Self {
        let unit = Self::initializing();
        assert_eq!(unit.exit(), OK);
        unit.messages.take();
        unit
    }

    pub fn terminated() -> Self {
        let unit = Self::running();
        assert_eq!(unit.terminate(), OK);
        unit
    }

    /// Calls a function that takes nothing but the instance, by its whole name.
    pub fn simple(&self, name: &str) -> c_int {
        call!(name, self.handle => Handle)
    }

    /// Sets the times of the experiment and begins the initialization.
    pub fn begin(&self, start: f64, stop: Option<f64>) -> c_int {
        V::begin(self, start, stop)
    }

    pub fn exit(&self) -> c_int {
        self.simple(&V::name("ExitInitializationMode"))
    }

    pub fn terminate(&self) -> c_int {
        self.simple(&V::name("Terminate"))
    }

    pub fn reset(&self) -> c_int {
        self.simple(&V::name("Reset"))
    }

    pub fn advance(&self, point: f64, step: f64) -> c_int {
        V::advance(self, point, step)
    }

    /// Time of the last successful step.
    pub fn time(&self) -> f64 {
        V::time(self)
    }

    pub fn reference(&self, name: &str) -> u32 {
        V::find(self, name).unwrap_or_else(|| panic!("no variable {name}")) as u32
    }

    // FMI 2.0 knows no number of values; an argument more does no harm.

    pub fn set_all(&self, references: &[u32], values: &[f64]) -> c_int {
        call!(&V::name(&format!("Set{}", V::REAL)), self.handle => Handle,
            references.as_ptr() => *const u32, references.len() => usize,
            values.as_ptr() => *const f64, values.len() => usize)
    }

    pub fn get_in(&self, references: &[u32], values: &mut [f64]) -> c_int {
        call!(&V::name(&format!("Get{}", V::REAL)), self.handle => Handle,
            references.as_ptr() => *const u32, references.len() => usize,
            values.as_mut_ptr() => *mut f64, values.len() => usize)
    }

    /// Sets a variable of one value.
    pub fn put(&self, name: &str, value: f64) -> c_int {
        self.set_all(&[self.reference(name)], &[value])
    }

    /// The value of a variable that has one, which must be readable now.
    pub fn value(&self, name: &str) -> f64 {
        let mut value = [f64::NAN];
        let status = self.get_in(&[self.reference(name)], &mut value);
        assert_eq!(status, OK, "{name}: {:?}", self.messages.take());
        value[0]
    }

    pub fn set_threads(&self, value: c_int) -> c_int {
        let reference = self.reference("solver.threads");
        call!(&V::name(&format!("Set{}", V::INTEGER)), self.handle => Handle,
            &raw const reference => *const u32, 1 => usize,
            &raw const value => *const c_int, 1 => usize)
    }

    pub fn threads(&self) -> c_int {
        let (reference, mut value) = (self.reference("solver.threads"), -1);
        let status = call!(&V::name(&format!("Get{}", V::INTEGER)), self.handle => Handle,
            &raw const reference => *const u32, 1 => usize,
            &raw mut value => *mut c_int, 1 => usize);
        assert_eq!(status, OK);
        value
    }

    pub fn set_directory(&self, path: &Path) -> c_int {
        let reference = self.reference("output.directory");
        let text = CString::new(path.to_str().unwrap()).unwrap();
        let value = text.as_ptr();
        call!(&V::name("SetString"), self.handle => Handle, &raw const reference => *const u32,
            1 => usize, &raw const value => *const *const c_char, 1 => usize)
    }

    pub fn directory(&self) -> String {
        let (reference, mut value) = (self.reference("output.directory"), ptr::null());
        let status = call!(&V::name("GetString"), self.handle => Handle,
            &raw const reference => *const u32, 1 => usize,
            &raw mut value => *mut *const c_char, 1 => usize);
        assert_eq!(status, OK);
        // SAFETY: valid until the next call on the instance.
        unsafe { CStr::from_ptr(value) }.to_str().unwrap().to_owned()
    }

    /// All values that can be read, as bits, so that equal means identical.
    pub fn snapshot(&self) -> (Vec<u64>, c_int, String) {
        let others = ["solver.threads", "output.directory"].map(|name| self.reference(name));
        let all = 0..V::count(self) as u32;
        let reals: Vec<u32> = all.filter(|reference| !others.contains(reference)).collect();
        let mut values = vec![0.0; V::size(self, &reals)];
        assert_eq!(self.get_in(&reals, &mut values), OK, "{:?}", self.messages.take());
        (values.into_iter().map(f64::to_bits).collect(), self.threads(), self.directory())
    }

    /// Saves the state in a new place.
    pub fn save(&self) -> Saved {
        let mut state = ptr::null_mut();
        assert_eq!(self.save_in(&mut state), OK, "{:?}", self.messages.take());
        assert!(!state.is_null());
        state
    }

    pub fn save_in(&self, state: &mut Saved) -> c_int {
        call!(&V::name("GetFMUState"), self.handle => Handle, state => *mut Saved)
    }

    pub fn restore(&self, state: Saved) -> c_int {
        call!(&V::name("SetFMUState"), self.handle => Handle, state => Saved)
    }

    pub fn free_state(&self, state: &mut Saved) -> c_int {
        call!(&V::name("FreeFMUState"), self.handle => Handle, state => *mut Saved)
    }

    pub fn state_size(&self, state: Saved, size: &mut usize) -> c_int {
        let name = V::name("SerializedFMUStateSize");
        call!(&name, self.handle => Handle, state => Saved, size => *mut usize)
    }

    /// The bytes of a saved state.
    pub fn serialize(&self, state: Saved) -> Vec<u8> {
        let mut size = 0;
        assert_eq!(self.state_size(state, &mut size), OK, "{:?}", self.messages.take());
        let mut bytes = vec![0; size];
        assert_eq!(self.serialize_in(state, &mut bytes), OK, "{:?}", self.messages.take());
        bytes
    }

    pub fn serialize_in(&self, state: Saved, bytes: &mut [u8]) -> c_int {
        call!(&V::name("SerializeFMUState"), self.handle => Handle, state => Saved,
            bytes.as_mut_ptr() => *mut u8, bytes.len() => usize)
    }

    /// The saved state of these bytes, which must be good.
    pub fn deserialize(&self, bytes: &[u8]) -> Saved {
        let mut state = ptr::null_mut();
        assert_eq!(self.deserialize_in(bytes, &mut state), OK, "{:?}", self.messages.take());
        assert!(!state.is_null());
        state
    }

    pub fn deserialize_in(&self, bytes: &[u8], state: &mut Saved) -> c_int {
        call!(&V::name("DeserializeFMUState"), self.handle => Handle, bytes.as_ptr() => *const u8,
            bytes.len() => usize, state => *mut Saved)
    }

    /// The calls on a saved state with null where an answer belongs.
    pub fn null_state_calls(&self, state: Saved) -> [c_int; 4] {
        let bytes = self.serialize(state);
        [
            call!(&V::name("GetFMUState"), self.handle => Handle, ptr::null_mut() => *mut Saved),
            call!(&V::name("SerializedFMUStateSize"), self.handle => Handle, state => Saved,
                ptr::null_mut() => *mut usize),
            call!(&V::name("SerializeFMUState"), self.handle => Handle, state => Saved,
                ptr::null_mut() => *mut u8, bytes.len() => usize),
            call!(&V::name("DeserializeFMUState"), self.handle => Handle,
                bytes.as_ptr() => *const u8, bytes.len() => usize, ptr::null_mut() => *mut Saved),
        ]
    }

    /// The one message since the last look, of this status, with the fragments in its text.
    #[track_caller]
    pub fn expect_message(&self, status: c_int, fragments: &[&str]) {
        self.messages.expect_one(status, fragments);
    }
}
