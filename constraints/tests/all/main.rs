//! Joints and motions against closed forms and differences.

mod function;
mod joints;
mod motions;
mod package;
mod reeving;
mod winch;
