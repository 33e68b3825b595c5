//! Ropewalk: models.
