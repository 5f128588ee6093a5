//! Instantiates a library in a process of its own.
//!
//! The parent calls this program with `--instantiate LIBRARY GUID RESOURCES KIND`; the answer is the
//! exit status, and the log of the library comes by standard error.

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::fs::File;
use std::path::Path;
use std::process::{Command, ExitCode, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use libloading::Library;

use super::package::Package;

/// What came of it.
pub enum Outcome {
    Made,
    /// fmi2Instantiate answered null; the log.
    Refused(String),
    Unloadable(String),
    /// The process ended by itself or had to be ended.
    Lost(String),
}

/// Exit status of the child. Others mean that the library took the process down.
const MADE: u8 = 0;
const REFUSED: u8 = 90;
const UNLOADABLE: u8 = 91;

/// Longest time that a library may take.
const PATIENCE: Duration = Duration::from_secs(60);

/// Unpacks a library with the resources of its unit and has it instantiated with a GUID.
pub fn ask(package: &Package, library: &str, guid: &str, co_simulation: bool) -> Outcome {
    try_asking(package, library, guid, co_simulation).unwrap_or_else(Outcome::Unloadable)
}

fn try_asking(
    package: &Package,
    library: &str,
    guid: &str,
    co_simulation: bool,
) -> Result<Outcome, String> {
    let said = |error: std::io::Error| error.to_string();
    let folder = tempfile::tempdir().map_err(said)?;
    let (beside, _) = library.rsplit_once('/').unwrap_or_default();
    package.unpack(&format!("{beside}/"), folder.path())?;
    package.unpack("resources/", folder.path())?;
    let resources = folder.path().join("resources");
    std::fs::create_dir_all(&resources).map_err(said)?;
    let log = folder.path().join("log");
    let mut child = Command::new(std::env::current_exe().map_err(said)?)
        .arg("--instantiate")
        .arg(folder.path().join(library))
        .args([guid, &uri(&resources), if co_simulation { "1" } else { "0" }])
        .current_dir(folder.path())
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(File::create(&log).map_err(said)?)
        .spawn()
        .map_err(said)?;
    let begin = Instant::now();
    let status = loop {
        match child.try_wait().map_err(said)? {
            Some(status) => break status,
            None if begin.elapsed() > PATIENCE => {
                let _ = child.kill();
                let _ = child.wait();
                return Ok(Outcome::Lost(format!("took longer than {} s", PATIENCE.as_secs())));
            }
            None => thread::sleep(Duration::from_millis(5)),
        }
    };
    let log = std::fs::read(&log).map_err(said)?;
    Ok(outcome(status, String::from_utf8_lossy(&log).trim().to_owned()))
}

fn outcome(status: ExitStatus, log: String) -> Outcome {
    match status.code().and_then(|code| u8::try_from(code).ok()) {
        Some(MADE) => Outcome::Made,
        Some(REFUSED) => {
            Outcome::Refused(if log.is_empty() { "no reason given".into() } else { log })
        }
        Some(UNLOADABLE) => Outcome::Unloadable(log),
        _ => Outcome::Lost(format!("ended the process ({status}): {log}")),
    }
}

/// The URI of a folder; what stands for something else in URIs is escaped.
fn uri(folder: &Path) -> String {
    let path = folder.display().to_string().replace('\\', "/");
    let escaped =
        path.replace('%', "%25").replace(' ', "%20").replace('#', "%23").replace('?', "%3F");
    format!("file://{}{escaped}", if escaped.starts_with('/') { "" } else { "/" })
}

type Logger = unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char);

/// `fmi2CallbackFunctions`. The logger is declared without its variable arguments, which it does not
/// look at; all C ABIs in use allow that.
#[repr(C)]
struct Callbacks {
    logger: Logger,
    allocate_memory: unsafe extern "C" fn(usize, usize) -> *mut c_void,
    free_memory: unsafe extern "C" fn(*mut c_void),
    step_finished: Option<unsafe extern "C" fn(*mut c_void, c_int)>,
    environment: *mut c_void,
}

unsafe extern "C" {
    fn calloc(count: usize, size: usize) -> *mut c_void;
    fn free(memory: *mut c_void);
}

unsafe extern "C" fn logger(
    _environment: *mut c_void,
    _instance: *const c_char,
    _status: c_int,
    _category: *const c_char,
    message: *const c_char,
) {
    if !message.is_null() {
        // SAFETY: a library passes a C string.
        let message = unsafe { CStr::from_ptr(message) };
        eprintln!("{}", message.to_string_lossy());
    }
}

/// What the child does: LIBRARY GUID RESOURCES KIND.
pub fn instantiate(arguments: &[String]) -> ExitCode {
    match try_instantiating(arguments) {
        Ok(true) => ExitCode::from(MADE),
        Ok(false) => ExitCode::from(REFUSED),
        Err(error) => {
            eprintln!("{error}");
            ExitCode::from(UNLOADABLE)
        }
    }
}

fn try_instantiating(arguments: &[String]) -> Result<bool, String> {
    type Instantiate = unsafe extern "C" fn(
        *const c_char,
        c_int,
        *const c_char,
        *const c_char,
        *const Callbacks,
        c_int,
        c_int,
    ) -> *mut c_void;
    type Free = unsafe extern "C" fn(*mut c_void);
    let [library, guid, resources, kind] = arguments else {
        return Err("LIBRARY GUID RESOURCES KIND are needed".into());
    };
    let text = |text: &str| CString::new(text).map_err(|error| error.to_string());
    let (guid, resources) = (text(guid)?, text(resources)?);
    let callbacks = Callbacks {
        logger,
        allocate_memory: calloc,
        free_memory: free,
        step_finished: None,
        environment: std::ptr::null_mut(),
    };
    // SAFETY: nothing can vouch for a foreign library; that is why it has this process to itself. The
    // types are those of the standard's header, the strings live through the calls.
    unsafe {
        let library = Library::new(library).map_err(|error| error.to_string())?;
        let make = library.get::<Instantiate>("fmi2Instantiate").map_err(|e| e.to_string())?;
        let free = library.get::<Free>("fmi2FreeInstance").map_err(|e| e.to_string())?;
        let kind = c_int::from(kind == "1");
        let name = c"lint";
        let made = make(
            name.as_ptr(),
            kind,
            guid.as_ptr(),
            resources.as_ptr(),
            &raw const callbacks,
            0,
            1,
        );
        if !made.is_null() {
            free(made);
        }
        // Threads of the library may still run; unloading it under them would end the process.
        std::mem::forget(library);
        Ok(!made.is_null())
    }
}
