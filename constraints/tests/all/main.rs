//! Joints and motions against closed forms and differences.

mod joints;
mod motions;
