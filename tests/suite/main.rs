//! Tests of the whole: one program, so that it is linked once.

mod accuracy;
mod afm_contact_oracle;
mod analytic;
mod builder;
mod command;
mod commands;
mod common;
mod degenerate;
mod distributions;
mod estimators;
mod examples;
mod expression;
mod extremes;
mod factors;
mod failures;
mod given;
mod given_data;
mod known;
mod metamorphic;
mod page;
mod points;
mod reproduce;
mod scenes;
mod schema;
mod screening;
mod workflows;
