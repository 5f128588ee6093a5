//! The floating-point environment: rounding, subnormal numbers, and trapping exceptions.
//!
//! A host may use its own. Another rounding would change the results, and a trap would end the process at the first
//! infinity, which is harmless here. Calls therefore run in the standard environment (round to nearest, subnormal
//! numbers kept, no traps), which threads started in them inherit. Afterwards the host's environment is restored, flags
//! included. Its logger is also called in it.
//!
//! On x86-64 all arithmetic here is that of SSE and AVX, whose environment is MXCSR; the x87 unit is left
//! alone. Source: Intel 64 and IA-32 Architectures Software Developer's Manual, volume 1, section 10.2.3; Arm
//! Architecture Reference Manual for A-profile, FPCR and FPSR.

use std::cell::Cell;

use register::{Environment, STANDARD};

thread_local! {
    /// The host's environment during a call.
    static HOSTS: Cell<Environment> = const { Cell::new(STANDARD) };
}

/// Runs `body` in the standard environment.
pub fn standard<R>(body: impl FnOnce() -> R) -> R {
    let host = Environment::current();
    if !host.is_standard() {
        STANDARD.enter();
    }
    let outer = HOSTS.replace(host);
    let result = apart(body);
    HOSTS.set(outer);
    if Environment::current() != host {
        host.enter();
    }
    result
}

/// Runs `body`, which belongs to the host, in the host's environment.
pub fn of_host<R>(body: impl FnOnce() -> R) -> R {
    let ours = Environment::current();
    let host = HOSTS.get();
    if ours != host {
        host.enter();
    }
    let result = apart(body);
    // Flags raised by the host belong to the host.
    HOSTS.set(Environment::current());
    ours.enter();
    result
}

/// Never inlined, so that no operation moves across a change of the environment.
#[inline(never)]
fn apart<R>(body: impl FnOnce() -> R) -> R {
    body()
}

#[cfg(target_arch = "x86_64")]
mod register {
    use std::arch::asm;

    /// MXCSR: flags in bits 0 to 5, what decides about results above.
    #[derive(Clone, Copy, PartialEq)]
    pub struct Environment(u32);

    /// All exceptions masked, no flag raised.
    pub const STANDARD: Environment = Environment(0x1f80);
    const FLAGS: u32 = 0x3f;

    impl Environment {
        /// Reads the thread's environment.
        pub fn current() -> Self {
            let mut value = 0;
            // SAFETY: stores the register in `value`.
            unsafe {
                asm!("stmxcsr [{}]", in(reg) &raw mut value, options(nostack, preserves_flags))
            };
            Self(value)
        }

        /// Returns true if results are those of the standard environment.
        pub fn is_standard(self) -> bool {
            self.0 & !FLAGS == STANDARD.0
        }

        /// Makes this the thread's environment.
        pub fn enter(self) {
            // SAFETY: either the standard value or one that the register had.
            unsafe {
                asm!("ldmxcsr [{}]", in(reg) &raw const self.0, options(nostack, preserves_flags))
            };
        }
    }
}

#[cfg(target_arch = "aarch64")]
mod register {
    use std::arch::asm;

    /// FPCR, which decides about results, and FPSR, which has the flags.
    #[derive(Clone, Copy, PartialEq)]
    pub struct Environment(u64, u64);

    pub const STANDARD: Environment = Environment(0, 0);

    impl Environment {
        /// Reads the thread's environment.
        pub fn current() -> Self {
            let (control, flags): (u64, u64);
            // SAFETY: reads two registers.
            unsafe {
                asm!("mrs {}, fpcr", "mrs {}, fpsr", out(reg) control, out(reg) flags, options(nostack));
            }
            Self(control, flags)
        }

        /// Returns true if results are those of the standard environment.
        pub fn is_standard(self) -> bool {
            self.0 == STANDARD.0
        }

        /// Makes this the thread's environment.
        pub fn enter(self) {
            // SAFETY: either the standard values or those that the registers had.
            unsafe {
                asm!("msr fpcr, {}", "msr fpsr, {}", in(reg) self.0, in(reg) self.1, options(nostack));
            }
        }
    }
}

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
mod register {
    /// The environment of this processor is unknown.
    #[derive(Clone, Copy, PartialEq)]
    pub struct Environment;

    pub const STANDARD: Environment = Environment;

    impl Environment {
        /// Reads the thread's environment.
        pub fn current() -> Self {
            Self
        }

        /// Returns true if results are those of the standard environment.
        pub fn is_standard(self) -> bool {
            true
        }

        /// Makes this the thread's environment.
        pub fn enter(self) {}
    }
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use super::*;
    use std::hint::black_box;

    fn third() -> u64 {
        (black_box(1.0_f64) / black_box(3.0)).to_bits()
    }

    fn smallest() -> f64 {
        black_box(f64::MIN_POSITIVE) / black_box(2.0)
    }

    /// Runs `body` in a host's environment, and returns true if that is unchanged afterwards.
    fn as_host(value: u32, body: impl FnOnce()) -> bool {
        let mut now = 0_u32;
        // SAFETY: legal values of the register, which is put back at the end.
        unsafe {
            std::arch::asm!("ldmxcsr [{}]", in(reg) &raw const value);
            apart(body);
            std::arch::asm!("stmxcsr [{}]", in(reg) &raw mut now);
        }
        STANDARD.enter();
        now == value
    }

    #[test]
    fn host_environment_has_no_effect_and_is_restored() {
        let nearest = third();
        let (upward, to_zero, flushing, trapping) = (0x5f80, 0x7f80, 0x9fc0, 0x1000);
        for value in [upward, to_zero, flushing, trapping] {
            let stays = as_host(value, || {
                standard(|| {
                    assert_eq!(third(), nearest);
                    assert!(smallest() > 0.0);
                    assert!((black_box(1.0) / black_box(0.0_f64)).is_infinite());
                });
            });
            assert!(stays, "{value:x}");
        }
    }

    #[test]
    fn loggers_run_in_the_host_environment() {
        let nearest = third();
        let stays = as_host(0x5fa0, || {
            standard(|| {
                of_host(|| assert_ne!(third(), nearest));
                assert_eq!(third(), nearest);
            });
        });
        assert!(stays);
    }
}
