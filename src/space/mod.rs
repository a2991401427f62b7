//! Factor spaces.
