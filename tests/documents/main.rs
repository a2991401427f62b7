//! The documents and the schemas, against the program as it is built. `just docs` runs these tests.

#[cfg(unix)]
mod book;
#[path = "../suite/common.rs"]
#[expect(dead_code, reason = "shared with the tests of the program")]
mod common;
mod schema;
