//! Elements of Ropewalk.

pub mod cable;
