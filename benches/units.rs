//! What units cost their host, through the C ABI: lives, second instances, threads, steps.
//!
//! `cargo bench --bench units [-- DIRECTORY …]`: steps of the units unpacked in these directories, of
//! any tool, are timed beside ours. `benches/units.py` fetches such units first.

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::{Path, PathBuf};
use std::time::Instant;
use std::{env, fs, ptr, thread};

use impinge::fmi::guid;
use impinge::model::{Cache, Model};
use impinge::scene;
use impinge::variables::{Causality, Registry};
use libloading::Library;

const SMALLEST: &str = include_str!("smallest.toml");
const TILES: &str = include_str!("tiles.toml");
const PLATE: &str = include_str!("../examples/alumina_plate/scene.toml");
const SMALL_PLATE: &str = include_str!("../tests/fmi/scene.toml");

const LIVES: usize = 2000;
const INSTANCES: usize = 8;
/// Steps of one timing, and timings of which the least is shown: what else a machine does only adds.
const STEPS: usize = 2000;
const TIMINGS: usize = 21;

type Handle = *mut c_void;

/// `fmi2CallbackFunctions`, its logger declared without the variable arguments.
#[repr(C)]
struct Callbacks {
    logger: unsafe extern "C" fn(Handle, *const c_char, c_int, *const c_char, *const c_char),
    allocate_memory: unsafe extern "C" fn(usize, usize) -> Handle,
    free_memory: unsafe extern "C" fn(Handle),
    step_finished: Option<unsafe extern "C" fn(Handle, c_int)>,
    environment: Handle,
}

unsafe extern "C" {
    fn calloc(count: usize, size: usize) -> Handle;
    fn free(pointer: Handle);
}

unsafe extern "C" fn logger(
    _: Handle,
    _: *const c_char,
    status: c_int,
    _: *const c_char,
    message: *const c_char,
) {
    if status > 1 {
        // SAFETY: messages are C strings.
        println!("  {}", unsafe { CStr::from_ptr(message) }.to_string_lossy());
    }
}

static CALLBACKS: Callbacks = Callbacks {
    logger,
    allocate_memory: calloc,
    free_memory: free,
    step_finished: None,
    environment: ptr::null_mut(),
};

// SAFETY: holds functions that may be called from any thread, and a null pointer.
unsafe impl Sync for Callbacks {}

/// A unit on disk, its library loaded.
struct Unit {
    library: Library,
    guid: CString,
    resources: CString,
    /// Of the default experiment [s].
    step: f64,
    /// Value references of fluxes, and of outputs.
    fluxes: Vec<u32>,
    outputs: Vec<u32>,
}

/// An instance that is ready for steps.
struct Instance<'a> {
    unit: &'a Unit,
    handle: Handle,
    time: f64,
}

fn load(path: &Path) -> Library {
    #[cfg(unix)]
    {
        use libloading::os::unix;
        // Interpreters inside a unit look for their own symbols among those of all libraries.
        let flags = unix::RTLD_NOW | unix::RTLD_GLOBAL;
        // SAFETY: whoever runs this bench trusts the units.
        unsafe { unix::Library::open(Some(path), flags) }.expect("a library").into()
    }
    #[cfg(not(unix))]
    // SAFETY: whoever runs this bench trusts the units.
    unsafe { Library::new(path) }.expect("a library")
}

impl Unit {
    /// One of ours; `folder` takes its resources.
    fn of_scene(text: &str, folder: &Path) -> Self {
        fs::create_dir_all(folder).expect("a folder");
        fs::write(folder.join("scene.toml"), text).expect("a scene");
        let scene = scene::parse(text, "scene.toml").unwrap_or_else(|error| panic!("{error}"));
        let registry = Registry::of(&scene);
        let is_flux = |i: u32| registry.variables[i as usize].name.contains(".heat_flux");
        let bench = env::current_exe().expect("the path of this bench");
        let library = bench.with_file_name(libloading::library_filename("impinge"));
        Self {
            library: load(&library),
            guid: CString::new(guid::guid(text, &registry)).expect("no zeros"),
            resources: uri(folder),
            step: scene.step,
            fluxes: (0..registry.variables.len() as u32).filter(|&i| is_flux(i)).collect(),
            outputs: registry.of_causality(Causality::Output).map(|i| i as u32).collect(),
        }
    }

    /// One of any tool, unpacked.
    fn unpacked(folder: &Path) -> Self {
        let text = fs::read_to_string(folder.join("modelDescription.xml")).expect("a description");
        let attribute = |name: &str| {
            let (_, rest) = text.split_once(&format!(" {name}=\""))?;
            rest.split_once('"').map(|(value, _)| value.to_owned())
        };
        let name = attribute("modelIdentifier").expect("a modelIdentifier");
        let library = folder.join(format!("binaries/linux64/{name}.so"));
        Self {
            library: load(&library),
            guid: CString::new(attribute("guid").expect("a guid")).expect("no zeros"),
            resources: uri(&folder.join("resources")),
            step: attribute("stepSize").and_then(|step| step.parse().ok()).unwrap_or(1e-2),
            fluxes: Vec::new(),
            outputs: Vec::new(),
        }
    }

    fn call(&self, name: &CStr, handle: Handle) {
        type Function = unsafe extern "C" fn(Handle) -> c_int;
        // SAFETY: functions of this type by the standard's header.
        let status = unsafe { self.library.get::<Function>(name).expect("exported")(handle) };
        assert!(status <= 1, "{name:?} answers {status}");
    }

    fn instantiate(&self) -> Instance<'_> {
        type Instantiate = unsafe extern "C" fn(
            *const c_char,
            c_int,
            *const c_char,
            *const c_char,
            *const Callbacks,
            c_int,
            c_int,
        ) -> Handle;
        // SAFETY: the type is that of the header; strings and callbacks live long enough.
        let handle = unsafe {
            let function = self.library.get::<Instantiate>(c"fmi2Instantiate").expect("exported");
            let (guid, resources) = (self.guid.as_ptr(), self.resources.as_ptr());
            function(c"unit".as_ptr(), 1, guid, resources, &raw const CALLBACKS, 0, 0)
        };
        assert!(!handle.is_null(), "no instance");
        Instance { unit: self, handle, time: 0.0 }
    }

    fn start(&self) -> Instance<'_> {
        let instance = self.instantiate();
        instance.initialize();
        instance
    }
}

impl Instance<'_> {
    fn initialize(&self) {
        type Setup = unsafe extern "C" fn(Handle, c_int, f64, f64, c_int, f64) -> c_int;
        // SAFETY: the type is that of the header.
        let status = unsafe {
            let function = self.unit.library.get::<Setup>(c"fmi2SetupExperiment");
            function.expect("exported")(self.handle, 0, 0.0, 0.0, 0, 0.0)
        };
        assert_eq!(status, 0);
        self.unit.call(c"fmi2EnterInitializationMode", self.handle);
        self.unit.call(c"fmi2ExitInitializationMode", self.handle);
    }

    fn step(&mut self, count: usize) {
        type DoStep = unsafe extern "C" fn(Handle, f64, f64, c_int) -> c_int;
        // SAFETY: the type is that of the header.
        let function = unsafe { self.unit.library.get::<DoStep>(c"fmi2DoStep") };
        let function = function.expect("exported");
        for _ in 0..count {
            // SAFETY: as above.
            let status = unsafe { function(self.handle, self.time, self.unit.step, 1) };
            assert!(status <= 1, "fmi2DoStep answers {status}");
            self.time += self.unit.step;
        }
    }

    /// Gives all fluxes one value.
    fn set_all(&mut self, value: f64) {
        type SetReal = unsafe extern "C" fn(Handle, *const u32, usize, *const f64) -> c_int;
        let fluxes = &self.unit.fluxes;
        let values = vec![value; fluxes.len()];
        // SAFETY: the type is that of the header, and there are as many values.
        let status = unsafe {
            let function = self.unit.library.get::<SetReal>(c"fmi2SetReal").expect("exported");
            function(self.handle, fluxes.as_ptr(), fluxes.len(), values.as_ptr())
        };
        assert_eq!(status, 0);
    }

    /// Bits of all outputs.
    fn outputs(&self) -> Vec<u64> {
        type GetReal = unsafe extern "C" fn(Handle, *const u32, usize, *mut f64) -> c_int;
        let outputs = &self.unit.outputs;
        let mut values = vec![0.0; outputs.len()];
        // SAFETY: the type is that of the header, and there is room for all values.
        let status = unsafe {
            let function = self.unit.library.get::<GetReal>(c"fmi2GetReal").expect("exported");
            function(self.handle, outputs.as_ptr(), outputs.len(), values.as_mut_ptr())
        };
        assert_eq!(status, 0);
        values.into_iter().map(f64::to_bits).collect()
    }
}

impl Drop for Instance<'_> {
    fn drop(&mut self) {
        type Free = unsafe extern "C" fn(Handle);
        // SAFETY: the type is that of the header, and nobody uses the instance afterwards.
        unsafe {
            self.unit.library.get::<Free>(c"fmi2FreeInstance").expect("exported")(self.handle)
        };
    }
}

fn uri(folder: &Path) -> CString {
    let folder = fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned());
    CString::new(format!("file://{}", folder.display())).expect("no zeros")
}

/// What this process holds in memory [B].
fn resident() -> f64 {
    let pages = fs::read_to_string("/proc/self/statm").unwrap_or_default();
    pages.split(' ').nth(1).and_then(|pages| pages.parse().ok()).unwrap_or(0.0) * 4096.0
}

/// Time of a call [s].
fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let begin = Instant::now();
    let result = work();
    (result, begin.elapsed().as_secs_f64())
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn least(values: Vec<f64>) -> f64 {
    values.into_iter().fold(f64::INFINITY, f64::min)
}

/// Instances come and go; time and memory of each quarter.
fn lives(unit: &Unit) {
    let live = || {
        let mut instance = unit.start();
        instance.step(1);
        unit.call(c"fmi2Reset", instance.handle);
    };
    (0..LIVES / 10).for_each(|_| live());
    for quarter in 1..=4 {
        let before = resident();
        let ((), time) = timed(|| (0..LIVES / 4).for_each(|_| live()));
        let (each, grown) = (time / (LIVES / 4) as f64 * 1e6, (resident() - before) / 1e3);
        println!("  quarter {quarter}: {each:8.1} us a life, memory {grown:+.0} kB");
    }
}

/// The first instance of a scene builds the model, the second finds it.
fn second_instance(unit: &Unit) {
    let (first, slow) = timed(|| unit.start());
    let others: Vec<f64> = (0..5).map(|_| timed(|| unit.start()).1).collect();
    let quick = median(others);
    drop(first);
    println!("alumina plate: first instance {:.1} ms, second {:.3} ms", 1e3 * slow, 1e3 * quick);
    println!("  ratio {:.0}", slow / quick);
}

/// Instances on threads of their own give the bits that they give one after another.
fn at_once(unit: &Unit) {
    let run = || {
        let mut instance = unit.start();
        (0..20)
            .map(|_| {
                instance.step(1);
                instance.outputs()
            })
            .collect::<Vec<_>>()
    };
    let _holder = unit.start();
    let (alone, serial) = timed(|| (0..INSTANCES).map(|_| run()).collect::<Vec<_>>());
    let (together, parallel) = timed(|| {
        thread::scope(|scope| {
            let started: Vec<_> = (0..INSTANCES).map(|_| scope.spawn(run)).collect();
            started.into_iter().map(|thread| thread.join().expect("no panic")).collect::<Vec<_>>()
        })
    });
    let verdict = if alone == together { "the same bits" } else { "DIFFERENT BITS" };
    let cores = thread::available_parallelism().map_or(1, Into::into);
    println!("{INSTANCES} instances: {:.1} ms one after another", 1e3 * serial);
    println!("  {:.1} ms on {INSTANCES} threads of {cores} cores, {verdict}", 1e3 * parallel);
}

/// What inputs cost that are there and not set, and to set them all: one tile and ten thousand.
fn many_inputs(folder: &Path) {
    for side in [1, 100] {
        let text = TILES.replace("[100, 100]", &format!("[{side}, {side}]"));
        let unit = Unit::of_scene(&text, &folder.join(format!("tiles_{side}")));
        let (mut instance, time) = timed(|| unit.start());
        instance.step(100);
        let held = least((0..TIMINGS).map(|_| timed(|| instance.step(100)).1 / 100.0).collect());
        let mut value = 0.0;
        let mut set = || {
            value += 1e3;
            timed(|| instance.set_all(value)).1
        };
        let set = least((0..TIMINGS).map(|_| set()).collect());
        println!("{side} x {side} tiles: start {:.1} ms, step {:.1} us", 1e3 * time, 1e6 * held);
        println!("  to set all {:.1} us", 1e6 * set);
    }
}

/// Time of a step of the model alone, without any FMI [ns].
fn model_step(model: &Model, state: &mut impinge::model::State, cache: &mut Cache) -> f64 {
    let step = model.scene().step;
    let ((), time) = timed(|| {
        (0..STEPS).for_each(|_| model.step(state, cache, step).expect("a step"));
    });
    1e9 * time / STEPS as f64
}

/// Time of fmi2DoStep on the smallest scene and of the model's own step, taken in turn, and of units
/// of other tools.
fn overhead(unit: &Unit, others: &[PathBuf]) {
    let scene = scene::parse(SMALLEST, "smallest.toml").expect("a scene");
    let model = Model::build(&scene, 1).expect("a model");
    let (mut state, mut cache) = (model.initial_state(), Cache::default());
    let mut instance = unit.start();
    let others: Vec<(String, Unit)> =
        others.iter().map(|path| (name_of(path), Unit::unpacked(path))).collect();
    let mut running: Vec<Instance> = others.iter().map(|(_, unit)| unit.start()).collect();
    let steps = |instance: &mut Instance, count: usize| {
        1e9 * timed(|| instance.step(count)).1 / count as f64
    };
    let mut times = vec![Vec::new(); 2 + others.len()];
    for _ in 0..TIMINGS {
        times[0].push(model_step(&model, &mut state, &mut cache));
        times[1].push(steps(&mut instance, STEPS));
        for (i, other) in running.iter_mut().enumerate() {
            times[2 + i].push(steps(other, STEPS / 10));
        }
    }
    let times: Vec<f64> = times.into_iter().map(least).collect();
    println!("smallest scene: fmi2DoStep {:.0} ns, model alone {:.0} ns", times[1], times[0]);
    println!("  overhead {:.0} ns", times[1] - times[0]);
    for ((name, _), time) in others.iter().zip(&times[2..]) {
        println!("{name}: fmi2DoStep {time:.0} ns");
    }
}

fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

fn main() {
    let others: Vec<PathBuf> =
        env::args().skip(1).filter(|a| a != "--bench").map(Into::into).collect();
    let folder = env::temp_dir().join(format!("impinge-bench-{}", std::process::id()));
    let unit = |name: &str, text: &str| Unit::of_scene(text, &folder.join(name));
    println!("{LIVES} lives: instantiate, initialise, step, reset, free");
    println!("smallest scene, its model built in every life");
    lives(&unit("smallest", SMALLEST));
    println!("small plate, its model held by another instance");
    let plate = unit("small_plate", SMALL_PLATE);
    {
        let _holder = plate.start();
        lives(&plate);
    }
    second_instance(&unit("plate", PLATE));
    at_once(&plate);
    many_inputs(&folder);
    overhead(&unit("smallest", SMALLEST), &others);
    let _ = fs::remove_dir_all(folder);
}
