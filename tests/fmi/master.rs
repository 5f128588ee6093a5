//! A small master: loads the library, unpacks the test scene, records what the logger is told.

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock};
use std::{env, fs, process, ptr};

use impinge::fmi::guid;
use impinge::scene;
use impinge::variables::Registry;
use libloading::Library;

pub const SCENE: &str = include_str!("scene.toml");

pub const OK: c_int = 0;
pub const WARNING: c_int = 1;
pub const DISCARD: c_int = 2;
pub const ERROR: c_int = 3;

pub type Handle = *mut c_void;
/// `fmi2FMUstate`.
pub type Saved = *mut c_void;
type LoggerFn =
    unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char);

/// `fmi2CallbackFunctions`. The logger is declared without its variable arguments, which it does not
/// look at; all C ABIs in use allow that.
#[repr(C)]
pub struct Callbacks {
    pub logger: Option<LoggerFn>,
    pub allocate_memory: Option<unsafe extern "C" fn(usize, usize) -> *mut c_void>,
    pub free_memory: Option<unsafe extern "C" fn(*mut c_void)>,
    pub step_finished: Option<unsafe extern "C" fn(*mut c_void, c_int)>,
    pub environment: *mut c_void,
}

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
}

unsafe extern "C" {
    fn snprintf(buffer: *mut c_char, size: usize, format: *const c_char, ...) -> c_int;
}

/// Formats as masters written in C do, and keeps the result.
unsafe extern "C" fn logger(
    environment: *mut c_void,
    instance: *const c_char,
    status: c_int,
    category: *const c_char,
    format: *const c_char,
) {
    let mut buffer = [0; 4096];
    // SAFETY: the environment is a `Messages` that outlives the instance; the strings are C strings.
    unsafe {
        snprintf(buffer.as_mut_ptr(), buffer.len(), format);
        let text = |pointer| CStr::from_ptr(pointer).to_str().unwrap().to_owned();
        let message = Message {
            instance: text(instance),
            status,
            category: text(category),
            text: text(buffer.as_ptr()),
        };
        (*environment.cast::<Messages>()).0.lock().unwrap().push(message);
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

/// Arguments of fmi2Instantiate, all good until a test changes one.
pub struct Arguments {
    pub name: Option<CString>,
    pub fmu_type: c_int,
    pub guid: Option<CString>,
    pub resources: Option<CString>,
    pub logging_on: c_int,
    pub with_logger: bool,
}

impl Arguments {
    pub fn good(folder: &Folder) -> Self {
        Self {
            name: Some(c"unit".into()),
            fmu_type: 1,
            guid: Some(CString::new(own_guid()).unwrap()),
            resources: Some(CString::new(folder.uri()).unwrap()),
            logging_on: 1,
            with_logger: true,
        }
    }

    pub fn instantiate(&self, messages: &Messages) -> Handle {
        let callbacks = Callbacks {
            logger: self.with_logger.then_some(logger as LoggerFn),
            allocate_memory: None,
            free_memory: None,
            step_finished: None,
            environment: ptr::from_ref(messages).cast_mut().cast(),
        };
        self.instantiate_with(&callbacks)
    }

    pub fn instantiate_with(&self, callbacks: *const Callbacks) -> Handle {
        type Function = unsafe extern "C" fn(
            *const c_char,
            c_int,
            *const c_char,
            *const c_char,
            *const Callbacks,
            c_int,
            c_int,
        ) -> Handle;
        let pointer =
            |text: &Option<CString>| text.as_ref().map_or(ptr::null(), |text| text.as_ptr());
        // SAFETY: the types are those of the header; the strings live through the call.
        unsafe {
            let instantiate = library().get::<Function>("fmi2Instantiate").unwrap();
            instantiate(
                pointer(&self.name),
                self.fmu_type,
                pointer(&self.guid),
                pointer(&self.resources),
                callbacks,
                0,
                self.logging_on,
            )
        }
    }
}

pub fn free(handle: Handle) {
    // SAFETY: the type is that of the header.
    unsafe {
        let free = library().get::<unsafe extern "C" fn(Handle)>("fmi2FreeInstance").unwrap();
        free(handle);
    }
}

/// An instance of the test scene, freed at the end.
pub struct Unit {
    pub handle: Handle,
    pub messages: Box<Messages>,
    pub guid: String,
    registry: Registry,
    _folder: Folder,
}

impl Drop for Unit {
    fn drop(&mut self) {
        free(self.handle);
    }
}

impl Unit {
    pub fn instantiated() -> Self {
        Self::of_scene(SCENE)
    }

    /// An instance of another scene.
    pub fn of_scene(text: &str) -> Self {
        let folder = Folder::with_scene("unit", text);
        let messages = Box::<Messages>::default();
        let registry = Registry::of(&scene::parse(text, "scene.toml").unwrap());
        let guid = guid::guid(text, &registry);
        let guid_argument = Some(CString::new(guid.as_str()).unwrap());
        let arguments = Arguments { guid: guid_argument, ..Arguments::good(&folder) };
        let handle = arguments.instantiate(&messages);
        assert!(!handle.is_null(), "{:?}", messages.take());
        Self { handle, messages, guid, registry, _folder: folder }
    }

    pub fn initializing() -> Self {
        let unit = Self::instantiated();
        assert_eq!(unit.setup(0.0, None), OK);
        assert_eq!(unit.enter(), OK);
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

    pub fn reference(&self, name: &str) -> u32 {
        self.registry.find(name).unwrap_or_else(|| panic!("no variable {name}")) as u32
    }

    pub fn simple(&self, name: &str) -> c_int {
        call!(name, self.handle => Handle)
    }

    pub fn setup(&self, start: f64, stop: Option<f64>) -> c_int {
        call!("fmi2SetupExperiment", self.handle => Handle, 0 => c_int, 0.0 => f64,
            start => f64, stop.is_some().into() => c_int, stop.unwrap_or(0.0) => f64)
    }

    pub fn enter(&self) -> c_int {
        self.simple("fmi2EnterInitializationMode")
    }

    pub fn exit(&self) -> c_int {
        self.simple("fmi2ExitInitializationMode")
    }

    pub fn terminate(&self) -> c_int {
        self.simple("fmi2Terminate")
    }

    pub fn reset(&self) -> c_int {
        self.simple("fmi2Reset")
    }

    pub fn step(&self, point: f64, step: f64) -> c_int {
        call!("fmi2DoStep", self.handle => Handle, point => f64, step => f64, 1 => c_int)
    }

    pub fn set(&self, name: &str, value: f64) -> c_int {
        self.set_all(&[self.reference(name)], &[value])
    }

    pub fn set_all(&self, references: &[u32], values: &[f64]) -> c_int {
        call!("fmi2SetReal", self.handle => Handle, references.as_ptr() => *const u32,
            references.len() => usize, values.as_ptr() => *const f64)
    }

    pub fn get_all(&self, references: &[u32], values: &mut [f64]) -> c_int {
        call!("fmi2GetReal", self.handle => Handle, references.as_ptr() => *const u32,
            references.len() => usize, values.as_mut_ptr() => *mut f64)
    }

    /// The value of a real, which must be readable now.
    pub fn get(&self, name: &str) -> f64 {
        let mut value = [f64::NAN];
        let status = self.get_all(&[self.reference(name)], &mut value);
        assert_eq!(status, OK, "{name}: {:?}", self.messages.take());
        value[0]
    }

    pub fn set_threads(&self, value: c_int) -> c_int {
        let reference = self.reference("solver.threads");
        call!("fmi2SetInteger", self.handle => Handle, &raw const reference => *const u32,
            1 => usize, &raw const value => *const c_int)
    }

    pub fn threads(&self) -> c_int {
        let (reference, mut value) = (self.reference("solver.threads"), -1);
        let status = call!("fmi2GetInteger", self.handle => Handle,
            &raw const reference => *const u32, 1 => usize, &raw mut value => *mut c_int);
        assert_eq!(status, OK);
        value
    }

    pub fn set_directory(&self, path: &Path) -> c_int {
        let reference = self.reference("output.directory");
        let text = CString::new(path.to_str().unwrap()).unwrap();
        let value = text.as_ptr();
        call!("fmi2SetString", self.handle => Handle, &raw const reference => *const u32,
            1 => usize, &raw const value => *const *const c_char)
    }

    pub fn directory(&self) -> String {
        let (reference, mut value) = (self.reference("output.directory"), ptr::null());
        let status = call!("fmi2GetString", self.handle => Handle,
            &raw const reference => *const u32, 1 => usize,
            &raw mut value => *mut *const c_char);
        assert_eq!(status, OK);
        // SAFETY: valid until the next call on the instance.
        unsafe { CStr::from_ptr(value) }.to_str().unwrap().to_owned()
    }

    /// Saves the state in a new place.
    pub fn save(&self) -> Saved {
        let mut state = ptr::null_mut();
        assert_eq!(self.save_in(&mut state), OK, "{:?}", self.messages.take());
        assert!(!state.is_null());
        state
    }

    pub fn save_in(&self, state: &mut Saved) -> c_int {
        call!("fmi2GetFMUstate", self.handle => Handle, state => *mut Saved)
    }

    pub fn restore(&self, state: Saved) -> c_int {
        call!("fmi2SetFMUstate", self.handle => Handle, state => Saved)
    }

    pub fn free_state(&self, state: &mut Saved) -> c_int {
        call!("fmi2FreeFMUstate", self.handle => Handle, state => *mut Saved)
    }

    pub fn state_size(&self, state: Saved, size: &mut usize) -> c_int {
        call!("fmi2SerializedFMUstateSize", self.handle => Handle, state => Saved,
            size => *mut usize)
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
        call!("fmi2SerializeFMUstate", self.handle => Handle, state => Saved,
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
        call!("fmi2DeSerializeFMUstate", self.handle => Handle, bytes.as_ptr() => *const u8,
            bytes.len() => usize, state => *mut Saved)
    }

    /// The calls on a saved state with null where an answer belongs.
    pub fn null_state_calls(&self, state: Saved) -> [c_int; 4] {
        let bytes = self.serialize(state);
        [
            call!("fmi2GetFMUstate", self.handle => Handle, ptr::null_mut() => *mut Saved),
            call!("fmi2SerializedFMUstateSize", self.handle => Handle, state => Saved,
                ptr::null_mut() => *mut usize),
            call!("fmi2SerializeFMUstate", self.handle => Handle, state => Saved,
                ptr::null_mut() => *mut u8, bytes.len() => usize),
            call!("fmi2DeSerializeFMUstate", self.handle => Handle, bytes.as_ptr() => *const u8,
                bytes.len() => usize, ptr::null_mut() => *mut Saved),
        ]
    }

    /// Changes of outputs with inputs, which must exist.
    pub fn directional_derivative(&self, outputs: &[u32], inputs: &[u32], by: &[f64]) -> Vec<f64> {
        let mut found = vec![f64::NAN; outputs.len()];
        let status = self.directional_derivative_in(outputs, inputs, by, &mut found);
        assert_eq!(status, OK, "{:?}", self.messages.take());
        found
    }

    pub fn directional_derivative_in(
        &self,
        outputs: &[u32],
        inputs: &[u32],
        by: &[f64],
        found: &mut [f64],
    ) -> c_int {
        call!("fmi2GetDirectionalDerivative", self.handle => Handle,
            outputs.as_ptr() => *const u32, outputs.len() => usize,
            inputs.as_ptr() => *const u32, inputs.len() => usize,
            by.as_ptr() => *const f64, found.as_mut_ptr() => *mut f64)
    }

    pub fn set_derivative(&self, name: &str, order: c_int, value: f64) -> c_int {
        let reference = self.reference(name);
        call!("fmi2SetRealInputDerivatives", self.handle => Handle,
            &raw const reference => *const u32, 1 => usize, &raw const order => *const c_int,
            &raw const value => *const f64)
    }

    pub fn output_derivatives_in(
        &self,
        outputs: &[u32],
        orders: &[c_int],
        found: &mut [f64],
    ) -> c_int {
        call!("fmi2GetRealOutputDerivatives", self.handle => Handle,
            outputs.as_ptr() => *const u32, outputs.len() => usize,
            orders.as_ptr() => *const c_int, found.as_mut_ptr() => *mut f64)
    }

    /// fmi2GetBooleanStatus(fmi2Terminated).
    pub fn wants_to_end(&self) -> c_int {
        let mut value = -1;
        let status = call!("fmi2GetBooleanStatus", self.handle => Handle, 3 => c_int,
            &raw mut value => *mut c_int);
        assert_eq!(status, OK);
        value
    }

    /// fmi2GetRealStatus(fmi2LastSuccessfulTime).
    pub fn time(&self) -> f64 {
        let mut value = f64::NAN;
        let status = call!("fmi2GetRealStatus", self.handle => Handle, 2 => c_int,
            &raw mut value => *mut f64);
        assert_eq!(status, OK);
        value
    }

    /// All values that can be read, as bits, so that equal means identical.
    pub fn snapshot(&self) -> (Vec<u64>, c_int, String) {
        let integer = self.reference("solver.threads");
        let text = self.reference("output.directory");
        let all = 0..self.registry.variables.len() as u32;
        let reals: Vec<u32> = all.filter(|&r| r != integer && r != text).collect();
        let mut values = vec![0.0; reals.len()];
        assert_eq!(self.get_all(&reals, &mut values), OK, "{:?}", self.messages.take());
        (values.into_iter().map(f64::to_bits).collect(), self.threads(), self.directory())
    }

    /// The one message since the last look, of this status, with the fragments in its text.
    #[track_caller]
    pub fn expect_message(&self, status: c_int, fragments: &[&str]) {
        let messages = self.messages.take();
        let [message] = &messages[..] else { panic!("not one message: {messages:#?}") };
        assert_eq!(message.status, status, "{message:?}");
        for fragment in fragments {
            assert!(message.text.contains(fragment), "no {fragment:?} in {:?}", message.text);
        }
    }
}
