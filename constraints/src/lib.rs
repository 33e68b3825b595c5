//! Ropewalk: constraints.
