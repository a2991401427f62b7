//! The nanoparticle: its physics, scenes and rungs.

mod contact_oracle;
mod fidelity;
mod limits_of_input;
mod scenes;
mod silently_wrong;
mod slip_oracle;
