//! Scratch that a thread keeps from call to call, by its type: to make it anew each time would be to clear it.

use std::any::Any;
use std::cell::Cell;

thread_local! {
    static ROOMS: Cell<Vec<Box<dyn Any>>> = const { Cell::new(Vec::new()) };
}

/// The scratch of a type as it was left, to be given [back](give_back); a new one if there is none.
pub(super) fn take<T: 'static>(new: impl FnOnce() -> T) -> Box<T> {
    let mut rooms = ROOMS.take();
    // the same few are taken again and again
    let own = rooms.iter().rposition(|room| room.is::<T>()).map(|own| rooms.swap_remove(own));
    ROOMS.set(rooms);
    own.and_then(|room| room.downcast().ok()).unwrap_or_else(|| Box::new(new()))
}

/// Leaves scratch for the next call.
pub(super) fn give_back<T: 'static>(room: Box<T>) {
    let mut rooms = ROOMS.take();
    rooms.push(room);
    ROOMS.set(rooms);
}
