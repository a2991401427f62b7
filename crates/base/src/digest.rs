//! SHA-256 in hexadecimal, which identifies a file, a study or a design.

use std::fs::File;
use std::io::Read;
use std::path::Path;

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

/// Returns the digest of a file, read in pieces: data may be larger than the memory.
///
/// # Errors
/// The error of the operating system.
pub fn sha256_of_file(path: &Path) -> std::io::Result<String> {
    let (mut file, mut digest) = (File::open(path)?, Sha256::default());
    let mut piece = vec![0; 1 << 16];
    loop {
        match file.read(&mut piece)? {
            0 => return Ok(digest.finish()),
            length => digest.update(&piece[..length]),
        }
    }
}
