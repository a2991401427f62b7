//! What a user does, command by command.

mod commands;
mod examples;
mod failures;
mod known;
mod reproduce;
mod screening;
mod trade;
mod workflows;
