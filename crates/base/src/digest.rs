//! SHA-256 in hexadecimal, which identifies a file, a study or a design.

use hmac_sha256::Hash;

/// A digest of bytes that arrive in pieces.
#[derive(Clone, Default)]
pub struct Sha256(Hash);

impl Sha256 {
    /// Adds bytes.
    pub fn update(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }

    /// Returns the digest in hexadecimal.
    pub fn finish(self) -> String {
        self.0.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

/// Returns the digest of `bytes` in hexadecimal.
///
/// ```
/// assert!(apportion_base::digest::sha256(b"abc").starts_with("ba7816bf8f01cfea"));
/// ```
pub fn sha256(bytes: &[u8]) -> String {
    let mut digest = Sha256::default();
    digest.update(bytes);
    digest.finish()
}
