//! Ropewalk: forces.
