//! The command as its users meet it: a process with arguments, files, output and an exit code.

mod bad_models;
mod bad_points;
mod bodies;
mod check_and_show;
mod explain;
mod export;
mod import;
mod intent;
mod learn;
mod output;
mod prepare;
mod project;
mod report;
mod stationary;
mod workshop;
