//! Critical pushing force of a nanoparticle.
