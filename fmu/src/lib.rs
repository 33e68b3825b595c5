//! The shared library inside an FMU: a scene as a unit of a co-simulation by [FMI 3.0](https://fmi-standard.org).
//!
//! `ropewalk export-fmu SCENE` puts it into a `.fmu` file, beside the scene and the description of its variables. A
//! [`Session`](ropewalk::Session) does the work; this crate hands values over. `instance` is safe Rust, `interface` the
//! functions of C that co-simulation needs, `absent` those that belong to other kinds of FMUs and end with an error.

mod absent;
mod instance;
mod interface;
