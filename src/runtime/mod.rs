//! Resources of the process: threads, memory, work, locks and bytes.

pub mod address_space;
mod allocator;
pub mod allowance;
pub mod file_size;
pub mod fork_lock;
pub mod made_once;
mod memory;
pub mod parallel;
pub mod sealed;
pub mod shared_values;
pub mod thread;
mod usage;

pub use memory::available_memory;
pub use usage::Usage;
