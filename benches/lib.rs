//! Nothing: a package has a library or a program, and its benchmarks need neither.
