//! Ropewalk: elements.
