//! The clock that times runs.

#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
pub use std::time::Instant;

/// A moment on a platform without a clock (WebAssembly has none of its own): no time passes between two moments.
/// Results then report that a run took no time; no estimate depends on it.
#[cfg(all(target_family = "wasm", target_os = "unknown"))]
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Instant;

#[cfg(all(target_family = "wasm", target_os = "unknown"))]
impl Instant {
    /// Returns the current moment.
    pub fn now() -> Self {
        Self
    }

    /// Returns zero.
    pub fn elapsed(&self) -> std::time::Duration {
        std::time::Duration::ZERO
    }
}
