//! What the processor can do beyond the baseline of its architecture: asked once per stage, so that the loops of a stage are compiled twice
//! and no decision is taken inside them (DESIGN §12).
//!
//! Values do not depend on the answer: fused multiplication is used where it is exact either way (the error of a product).

/// Declares a function that runs its body compiled for 256-bit vectors and fused multiplication where the processor has them,
/// else for the baseline. The body is an `#[inline(always)]` function with a `const FUSED: bool`, which says whether `mul_add` is
/// an instruction.
macro_rules! dispatched {
    ($(#[$doc:meta])* fn $name:ident($($arg:ident: $type:ty),* $(,)?) -> $result:ty = $body:ident) => {
        $(#[$doc])*
        fn $name($($arg: $type),*) -> $result {
            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx2,fma,bmi2")]
                fn fused($($arg: $type),*) -> $result {
                    $body::<true>($($arg),*)
                }
                if $crate::base::processor::fuses() {
                    // SAFETY: the processor has the features that the function is compiled for.
                    return unsafe { fused($($arg),*) };
                }
            }
            $body::<false>($($arg),*)
        }
    };
}
pub(crate) use dispatched;

/// Whether what [`dispatched`] asks for is there. Cost: a load and a test.
#[cfg(target_arch = "x86_64")]
#[inline]
pub fn fuses() -> bool {
    std::arch::is_x86_feature_detected!("avx2")
        && std::arch::is_x86_feature_detected!("fma")
        && std::arch::is_x86_feature_detected!("bmi2")
}

/// Asks for an element of an array, which will be read soon: both its ends, since it may lie across two lines of the cache.
#[inline(always)]
pub fn prefetch<T>(items: &[T], i: usize) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        let first = items.as_ptr().wrapping_add(i).cast::<i8>();
        let last = first.wrapping_add(size_of::<T>().saturating_sub(1));
        // SAFETY: a prefetch is a hint: it reads nothing, and any address will do.
        unsafe {
            _mm_prefetch::<_MM_HINT_T0>(first);
            _mm_prefetch::<_MM_HINT_T0>(last);
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (items, i);
}
