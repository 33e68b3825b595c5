//! The functions of C that a co-simulation calls (FMI 3.0, section 4).
//!
//! Pointers are taken as the standard promises them: valid for the lengths that come with them. A panic ends with
//! `fmi3Fatal`, since it can't cross into C.
#![allow(unsafe_code, non_snake_case)]

use crate::instance::{Failure, Instance, Saved};
use std::ffi::{CStr, CString, c_char, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::ptr::{null, null_mut};
use std::slice;

/// `fmi3Status`.
pub(crate) type Status = i32;
const OK: Status = 0;
pub(crate) const ERROR: Status = 3;
const FATAL: Status = 4;

/// `fmi3LogMessageCallback`.
type Log = Option<unsafe extern "C" fn(*mut c_void, Status, *const c_char, *const c_char)>;

/// What `fmi3Instance` points at.
pub(crate) struct Component {
    instance: Instance,
    environment: *mut c_void,
    log: Log,
    logging: bool,
}

impl Component {
    /// Tells the importer something; errors always, warnings if it wants to hear them.
    fn tell(&self, status: Status, text: &str) {
        if let Some(log) = self.log
            && (self.logging || status == ERROR)
        {
            let text = CString::new(text.replace('\0', " ")).unwrap_or_default();
            let category = if status == ERROR { c"logStatusError" } else { c"logStatusWarning" };
            // SAFETY: both texts live until the call is over.
            unsafe { log(self.environment, status, category.as_ptr(), text.as_ptr()) };
        }
    }
}

/// Does something with the instance, and tells what went wrong.
///
/// # Safety
/// `at` is what [`fmi3InstantiateCoSimulation`] returned, and was not freed.
unsafe fn with(at: *mut Component, act: impl FnOnce(&mut Instance) -> Result<(), Failure>) -> Status {
    // SAFETY: as promised; an importer calls the functions of an instance one after the other.
    let Some(component) = (unsafe { at.as_mut() }) else { return ERROR };
    match catch_unwind(AssertUnwindSafe(|| act(&mut component.instance))) {
        Ok(Ok(())) => {
            component.instance.news().iter().for_each(|text| component.tell(1, text));
            OK
        }
        Ok(Err(failure)) => {
            component.tell(ERROR, &failure);
            ERROR
        }
        Err(_) => {
            component.tell(ERROR, "a defect of the program: please report it");
            FATAL
        }
    }
}

/// An array of C; empty if there is none.
///
/// # Safety
/// `at` is valid for `count` elements.
unsafe fn array<'a, T>(at: *const T, count: usize) -> &'a [T] {
    // SAFETY: as promised.
    if at.is_null() { &[] } else { unsafe { slice::from_raw_parts(at, count) } }
}

/// The same to be written to.
///
/// # Safety
/// `at` is valid for `count` elements.
unsafe fn array_mut<'a, T>(at: *mut T, count: usize) -> &'a mut [T] {
    // SAFETY: as promised.
    if at.is_null() { &mut [] } else { unsafe { slice::from_raw_parts_mut(at, count) } }
}

/// # Safety
/// `at` is null or a text that ends with a zero.
unsafe fn text(at: *const c_char) -> String {
    // SAFETY: as promised.
    if at.is_null() { String::new() } else { unsafe { CStr::from_ptr(at) }.to_string_lossy().into_owned() }
}

#[unsafe(no_mangle)]
extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3InstantiateCoSimulation(
    _name: *const c_char,
    token: *const c_char,
    resources: *const c_char,
    _visible: bool,
    logging: bool,
    _event_mode: bool,
    _early_return: bool,
    _intermediate: *const u32,
    _intermediate_count: usize,
    environment: *mut c_void,
    log: Log,
    _update: *const c_void,
) -> *mut Component {
    // SAFETY: texts of the importer.
    let (token, resources) = unsafe { (text(token), text(resources)) };
    let made = catch_unwind(|| Instance::new(Path::new(&resources), &token));
    match made.unwrap_or_else(|_| Err("a defect of the program: please report it".into())) {
        Ok(instance) => Box::into_raw(Box::new(Component { instance, environment, log, logging })),
        Err(failure) => {
            if let Some(log) = log {
                let failure = CString::new(failure.replace('\0', " ")).unwrap_or_default();
                // SAFETY: both texts live until the call is over.
                unsafe { log(environment, ERROR, c"logStatusError".as_ptr(), failure.as_ptr()) };
            }
            null_mut()
        }
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3FreeInstance(at: *mut Component) {
    if !at.is_null() {
        // SAFETY: it was boxed when it was made.
        drop(unsafe { Box::from_raw(at) });
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetDebugLogging(
    at: *mut Component,
    on: bool,
    _count: usize,
    _of: *const *const c_char,
) -> Status {
    // SAFETY: an instance of ours.
    let Some(component) = (unsafe { at.as_mut() }) else { return ERROR };
    component.logging = on;
    OK
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3EnterInitializationMode(
    at: *mut Component,
    _tolerance_defined: bool,
    _tolerance: f64,
    start: f64,
    _stop_defined: bool,
    _stop: f64,
) -> Status {
    // SAFETY: an instance of ours.
    unsafe { with(at, |instance| instance.initialise(start)) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3ExitInitializationMode(at: *mut Component) -> Status {
    // SAFETY: an instance of ours.
    unsafe { with(at, |_| Ok(())) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3Terminate(at: *mut Component) -> Status {
    // SAFETY: an instance of ours.
    unsafe { with(at, |_| Ok(())) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3Reset(at: *mut Component) -> Status {
    // SAFETY: an instance of ours.
    unsafe {
        with(at, |instance| {
            instance.reset();
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3DoStep(
    at: *mut Component,
    from: f64,
    size: f64,
    _no_going_back: bool,
    event: *mut bool,
    terminate: *mut bool,
    early: *mut bool,
    last: *mut f64,
) -> Status {
    // SAFETY: an instance of ours, and places for the results.
    unsafe {
        let mut ended = false;
        let status = with(at, |instance| {
            ended = instance.step(from, size)?;
            Ok(())
        });
        let t = at.as_ref().map_or(f64::NAN, |c| c.instance.t());
        for (place, value) in [(event, false), (terminate, ended), (early, false)] {
            if let Some(place) = place.as_mut() {
                *place = value;
            }
        }
        if let Some(last) = last.as_mut() {
            *last = t;
        }
        status
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetFloat64(
    at: *mut Component,
    references: *const u32,
    count: usize,
    values: *mut f64,
    values_count: usize,
) -> Status {
    // SAFETY: an instance of ours, and arrays of the importer.
    unsafe {
        let (references, values) = (array(references, count), array_mut(values, values_count));
        with(at, |instance| {
            for (reference, value) in references.iter().zip(values) {
                *value = instance.number(*reference)?;
            }
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetFloat64(
    at: *mut Component,
    references: *const u32,
    count: usize,
    values: *const f64,
    values_count: usize,
) -> Status {
    // SAFETY: an instance of ours, and arrays of the importer.
    unsafe {
        let (references, values) = (array(references, count), array(values, values_count));
        with(at, |instance| {
            references.iter().zip(values).try_for_each(|(r, value)| instance.set_number(*r, *value))
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetString(
    at: *mut Component,
    references: *const u32,
    count: usize,
    values: *mut *const c_char,
    values_count: usize,
) -> Status {
    // SAFETY: an instance of ours, and arrays of the importer.
    unsafe {
        let (references, values) = (array(references, count), array_mut(values, values_count));
        with(at, |instance| {
            let texts: Result<Vec<String>, _> = references.iter().map(|r| instance.text(*r)).collect();
            instance.texts = texts?.into_iter().map(|t| CString::new(t).unwrap_or_default()).collect();
            for (text, value) in instance.texts.iter().zip(values) {
                *value = text.as_ptr();
            }
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetString(
    at: *mut Component,
    references: *const u32,
    count: usize,
    values: *const *const c_char,
    values_count: usize,
) -> Status {
    // SAFETY: an instance of ours, and arrays of the importer.
    unsafe {
        let (references, values) = (array(references, count), array(values, values_count));
        with(at, |instance| {
            references.iter().zip(values).try_for_each(|(r, value)| instance.set_text(*r, &text(*value)))
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetFMUState(at: *mut Component, state: *mut *mut Saved) -> Status {
    // SAFETY: an instance of ours, and a place for the state: null, or a state of ours.
    unsafe {
        with(at, |instance| {
            let saved = instance.save()?;
            match state.as_mut() {
                None => return Err("there is no place for the state".into()),
                Some(place) => match place.as_mut() {
                    Some(old) => *old = saved,
                    None => *place = Box::into_raw(Box::new(saved)),
                },
            }
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetFMUState(at: *mut Component, state: *const Saved) -> Status {
    // SAFETY: an instance and a state of ours.
    unsafe {
        let saved = state.as_ref().cloned();
        with(at, |instance| instance.restore(saved.ok_or("there is no state")?))
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3FreeFMUState(_at: *mut Component, state: *mut *mut Saved) -> Status {
    // SAFETY: a place with a state of ours, or with null.
    unsafe {
        if let Some(place) = state.as_mut()
            && !place.is_null()
        {
            drop(Box::from_raw(*place));
            *place = null_mut();
        }
    }
    OK
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SerializedFMUStateSize(
    at: *mut Component,
    state: *const Saved,
    size: *mut usize,
) -> Status {
    // SAFETY: an instance and a state of ours, and a place for the size.
    unsafe {
        with(at, |_| {
            let bytes = state.as_ref().ok_or("there is no state")?.bytes()?;
            *size.as_mut().ok_or("there is no place for the size")? = bytes.len();
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SerializeFMUState(
    at: *mut Component,
    state: *const Saved,
    to: *mut u8,
    size: usize,
) -> Status {
    // SAFETY: an instance and a state of ours, and an array for its bytes.
    unsafe {
        with(at, |_| {
            let bytes = state.as_ref().ok_or("there is no state")?.bytes()?;
            let to =
                array_mut(to, size).get_mut(..bytes.len()).ok_or("there is not enough room for the state")?;
            to.copy_from_slice(&bytes);
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3DeserializeFMUState(
    at: *mut Component,
    from: *const u8,
    size: usize,
    state: *mut *mut Saved,
) -> Status {
    // SAFETY: an instance of ours, an array of bytes, and a place for the state.
    unsafe {
        with(at, |_| {
            let saved = Saved::from_bytes(array(from, size))?;
            *state.as_mut().ok_or("there is no place for the state")? = Box::into_raw(Box::new(saved));
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
extern "C" fn fmi3InstantiateModelExchange() -> *const c_void {
    null()
}

#[unsafe(no_mangle)]
extern "C" fn fmi3InstantiateScheduledExecution() -> *const c_void {
    null()
}
