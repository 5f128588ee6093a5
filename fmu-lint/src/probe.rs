//! Instantiates a library in a separate process.
//!
//! The parent calls this program with `--instantiate LIBRARY GUID RESOURCES KIND`. The exit status is the result, and
//! standard error the log of the library.

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::io::Read;
use std::io::Write as _;
use std::path::Path;
use std::process::{ChildStderr, Command, ExitCode, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use libloading::Library;

use super::package::Package;

/// Outcome of the instantiation.
pub enum Outcome {
    Made,
    /// fmi2Instantiate returned null; holds the log.
    Refused(String),
    Unloadable(String),
    /// The process crashed or was killed.
    Lost(String),
}

/// Exit status of the child. Others mean that the library ended the process.
const MADE: u8 = 0;
const REFUSED: u8 = 90;
const UNLOADABLE: u8 = 91;

/// Prefix of the folders into which libraries are unpacked; the number of a process follows.
const FOLDER: &str = "impinge-lint-";

/// Largest number of stored bytes of a library's log.
const LONGEST_LOG: usize = 1 << 16;

/// Longest time that a library may take.
const PATIENCE: Duration = Duration::from_secs(60);

/// Unpacks a library with the resources of its unit and instantiates it with a GUID.
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
    remove_left_behind();
    let own = format!("{FOLDER}{}-", std::process::id());
    let folder = tempfile::Builder::new().prefix(&own).tempdir().map_err(said)?;
    let (beside, _) = library.rsplit_once('/').unwrap_or_default();
    package.unpack(&format!("{beside}/"), folder.path())?;
    package.unpack("resources/", folder.path())?;
    let resources = folder.path().join("resources");
    std::fs::create_dir_all(&resources).map_err(said)?;
    let mut child = Command::new(std::env::current_exe().map_err(said)?)
        .arg("--instantiate")
        .arg(folder.path().join(library))
        .args([guid, &uri(&resources), if co_simulation { "1" } else { "0" }])
        .current_dir(folder.path())
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(said)?;
    let log = Log::of(child.stderr.take());
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
    Ok(outcome(status, log.text()))
}

/// Output of a child: the beginning is kept, the rest read and discarded.
struct Log {
    kept: Arc<Mutex<Vec<u8>>>,
    is_over: Receiver<()>,
}

impl Log {
    fn of(stream: Option<ChildStderr>) -> Self {
        let kept = Arc::new(Mutex::new(Vec::new()));
        let (sender, is_over) = channel::<()>();
        let place = Arc::clone(&kept);
        thread::spawn(move || {
            let _sender = sender;
            let mut piece = [0; 4096];
            let mut stream = stream.into_iter();
            let Some(mut stream) = stream.next() else { return };
            while let Ok(count @ 1..) = stream.read(&mut piece) {
                let mut kept = place.lock().unwrap_or_else(PoisonError::into_inner);
                let room = LONGEST_LOG.saturating_sub(kept.len());
                kept.extend_from_slice(&piece[..count.min(room)]);
            }
        });
        Self { kept, is_over }
    }

    /// The output so far; does not wait for output of the child's own child processes.
    fn text(&self) -> String {
        let _ = self.is_over.recv_timeout(Duration::from_secs(1));
        let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let mut text = String::from_utf8_lossy(&kept).trim().to_owned();
        if kept.len() == LONGEST_LOG {
            text.push_str(" … (cut off)");
        }
        text
    }
}

/// Removes folders of earlier calls of this program that were killed.
fn remove_left_behind() {
    let Ok(entries) = std::fs::read_dir(std::env::temp_dir()) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name().into_string().unwrap_or_default();
        let number = name.strip_prefix(FOLDER).and_then(|rest| rest.split_once('-'));
        let Some((process, _)) = number else { continue };
        let is_number = !process.is_empty() && process.bytes().all(|byte| byte.is_ascii_digit());
        // Only Linux reports whether another process still runs.
        let has_ended =
            Path::new("/proc/self").exists() && !Path::new("/proc").join(process).exists();
        if is_number && has_ended {
            let _ = std::fs::remove_dir_all(entry.path());
        }
    }
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

/// The URI of a folder, with reserved characters escaped.
fn uri(folder: &Path) -> String {
    let path = folder.display().to_string().replace('\\', "/");
    let escaped =
        path.replace('%', "%25").replace(' ', "%20").replace('#', "%23").replace('?', "%3F");
    format!("file://{}{escaped}", if escaped.starts_with('/') { "" } else { "/" })
}

type Logger = unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char);

/// `fmi2CallbackFunctions`. The logger is declared without its variable arguments, which it does not read; all C ABIs
/// in use allow that.
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
    #[cfg(unix)]
    fn alarm(seconds: u32) -> u32;
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
        let _ = writeln!(std::io::stderr(), "{}", message.to_string_lossy());
    }
}

/// Main function of the child; arguments: LIBRARY GUID RESOURCES KIND.
pub fn instantiate(arguments: &[String]) -> ExitCode {
    // In case the parent is gone and cannot kill this process. SAFETY: sets a timer of this process.
    #[cfg(unix)]
    unsafe {
        alarm(2 * PATIENCE.as_secs() as u32)
    };
    match try_instantiating(arguments) {
        Ok(true) => ExitCode::from(MADE),
        Ok(false) => ExitCode::from(REFUSED),
        Err(error) => {
            let _ = writeln!(std::io::stderr(), "{error}");
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
    // SAFETY: nothing can vouch for a foreign library, hence the separate process. The types are those of the
    // standard's header, the strings live through the calls.
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

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    fn said(script: &str) -> String {
        let shell = Command::new("sh").args(["-c", script]).stderr(Stdio::piped()).spawn();
        let mut shell = shell.unwrap();
        let log = Log::of(shell.stderr.take());
        shell.wait().unwrap();
        log.text()
    }

    #[test]
    fn beginning_of_an_endless_log_is_kept() {
        assert_eq!(said("echo ' no such unit ' >&2"), "no such unit");
        let long = said("head -c 5000000 /dev/zero | tr '\\0' x >&2");
        assert!(long.ends_with("… (cut off)") && long.len() < LONGEST_LOG + 100);
    }

    #[test]
    fn grandchildren_are_not_waited_for() {
        let begin = Instant::now();
        assert_eq!(said("echo started >&2; sleep 30 &"), "started");
        assert!(begin.elapsed() < Duration::from_secs(20));
    }
}
