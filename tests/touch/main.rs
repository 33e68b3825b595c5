//! Contact and friction.

#[path = "../common/scenes.rs"]
mod common;

mod bed;
mod coarse;
mod contact;
mod contact_along;
mod feeding_contact;
mod friction;
mod lines;
mod lines_rub;
mod moorings;
