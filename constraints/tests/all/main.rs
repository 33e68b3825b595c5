//! Joints and motions against closed forms and differences.

mod function;
mod joints;
mod motions;
mod package;
mod winch;
