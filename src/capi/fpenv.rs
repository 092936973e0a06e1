//! The floating-point environment of a thread: saved, replaced by the one that our arithmetic is proved under, and
//! put back.
//!
//! Hosts built with -ffast-math flush subnormals to zero (FTZ, DAZ) in every thread; hosts built with -ffpe-trap
//! unmask traps; some set a rounding mode. Under the first our filters and expansions lose their proofs, under the
//! second an inexact or an overflowing filter would kill the process. Ours is IEEE's default: round to nearest,
//! subnormals kept, traps masked.
//!
//! Restoring brings back the host's control bits *and* its sticky exception flags, so a call leaves no trace.
//!
//! On x86-64 the x87 unit is handled too: none of our code uses it, but C code linked to us (long double) may, and an
//! exception that it leaves pending would fire in the host. Cost: about a hundred nanoseconds a call, nearly all of it
//! for the x87 unit.

/// A saved environment.
#[derive(Clone, Copy)]
pub struct Env(imp::Env);

/// Saves the calling thread's environment and sets the clean one.
pub fn enter() -> Env {
    let env = Env(imp::save());
    imp::set_clean();
    env
}

/// Puts a saved environment back.
pub fn leave(env: &Env) {
    imp::restore(&env.0);
}

/// Sets the clean environment for the rest of a thread of our own.
pub fn set_clean() {
    imp::set_clean();
}

#[cfg(target_arch = "x86_64")]
mod imp {
    use std::arch::asm;

    #[derive(Clone, Copy)]
    pub struct Env {
        /// The x87 environment in its protected-mode form: control, status and tag words, last instruction.
        x87: [u32; 7],
        mxcsr: u32,
    }

    /// Traps masked, round to nearest, FTZ and DAZ off, no sticky flags.
    static MXCSR: u32 = 0x1f80;

    pub fn save() -> Env {
        let mut env = Env { x87: [0; 7], mxcsr: 0 };
        // fnstenv masks the x87 exceptions as a side effect, and does not wait for pending ones. The asm blocks may
        // touch memory as far as the compiler knows, so no load or store moves across them.
        unsafe {
            asm!("fnstenv [{}]", in(reg) &raw mut env.x87, options(nostack));
            asm!("stmxcsr [{}]", in(reg) &raw mut env.mxcsr, options(nostack));
        }
        env
    }

    pub fn set_clean() {
        unsafe {
            asm!("fninit", out("st(0)") _, out("st(1)") _, out("st(2)") _, out("st(3)") _, out("st(4)") _,
                out("st(5)") _, out("st(6)") _, out("st(7)") _, options(nostack));
            asm!("ldmxcsr [{}]", in(reg) &raw const MXCSR, options(nostack));
        }
    }

    pub fn restore(env: &Env) {
        unsafe {
            asm!("fldenv [{}]", in(reg) &raw const env.x87, options(nostack));
            asm!("ldmxcsr [{}]", in(reg) &raw const env.mxcsr, options(nostack));
        }
    }
}

#[cfg(target_arch = "aarch64")]
mod imp {
    use std::arch::asm;

    #[derive(Clone, Copy)]
    pub struct Env {
        fpcr: u64,
        fpsr: u64,
    }

    pub fn save() -> Env {
        let (fpcr, fpsr): (u64, u64);
        unsafe {
            asm!("mrs {}, fpcr", out(reg) fpcr, options(nostack));
            asm!("mrs {}, fpsr", out(reg) fpsr, options(nostack));
        }
        Env { fpcr, fpsr }
    }

    /// All zero: round to nearest, no flushing, no traps.
    pub fn set_clean() {
        unsafe {
            asm!("msr fpcr, {}", in(reg) 0u64, options(nostack));
            asm!("msr fpsr, {}", in(reg) 0u64, options(nostack));
        }
    }

    pub fn restore(env: &Env) {
        unsafe {
            asm!("msr fpsr, {}", in(reg) env.fpsr, options(nostack));
            asm!("msr fpcr, {}", in(reg) env.fpcr, options(nostack));
        }
    }
}

#[cfg(target_arch = "riscv64")]
mod imp {
    use std::arch::asm;

    /// Rounding mode and sticky flags; RISC-V has neither traps nor flushing.
    #[derive(Clone, Copy)]
    pub struct Env {
        fcsr: u64,
    }

    pub fn save() -> Env {
        let fcsr: u64;
        unsafe { asm!("frcsr {}", out(reg) fcsr, options(nostack)) };
        Env { fcsr }
    }

    pub fn set_clean() {
        unsafe { asm!("fscsr x0", options(nostack)) };
    }

    pub fn restore(env: &Env) {
        unsafe { asm!("fscsr {}", in(reg) env.fcsr, options(nostack)) };
    }
}

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64", target_arch = "riscv64")))]
compile_error!("state here how this architecture saves and sets its floating-point environment");
