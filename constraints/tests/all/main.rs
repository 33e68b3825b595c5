//! Joints and motions against closed forms and differences.

mod drum;
mod function;
mod joints;
mod motions;
mod package;
mod winch;
