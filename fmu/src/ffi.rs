//! The C functions of FMI 2.0 co-simulation: the only file with `unsafe`, and long because there are 34 of them.
//!
//! Every function checks its pointers, asks the call-order table, and hands over to [`Instance`]. A panic ends at this
//! border: the instance is condemned and the importer gets `fmi2Fatal`. Text goes to the logger finished, with every
//! percent sign doubled, because the logger is a `printf`-like function.
#![allow(non_camel_case_types, non_snake_case)]

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::{ptr, slice};

use crate::instance::{Instance, Value};
use crate::lifecycle::Call;
use crate::log::{Log, Sink};
use crate::open;
use crate::status::Status;

/// `fmi2Component`: what [`fmi2Instantiate`] returned.
pub type fmi2Component = *mut Component;
/// `fmi2ComponentEnvironment`: the importer's own.
pub type fmi2ComponentEnvironment = *mut c_void;
/// `fmi2FMUstate`: the number of a saved state, never an address.
pub type fmi2FMUstate = *mut c_void;
/// `fmi2ValueReference`.
pub type fmi2ValueReference = u32;
/// `fmi2Real`.
pub type fmi2Real = f64;
/// `fmi2Integer`.
pub type fmi2Integer = c_int;
/// `fmi2Boolean`.
pub type fmi2Boolean = c_int;
/// `fmi2String`.
pub type fmi2String = *const c_char;
/// `fmi2Byte`.
pub type fmi2Byte = u8;

const FMI2_FALSE: fmi2Boolean = 0;
const FMI2_CO_SIMULATION: c_int = 1;
const FMI2_DO_STEP_STATUS: c_int = 0;
const FMI2_LAST_SUCCESSFUL_TIME: c_int = 2;
const FMI2_TERMINATED: c_int = 3;

/// `fmi2CallbackLogger`: variadic, but never called with more than the message.
pub type fmi2CallbackLogger =
    unsafe extern "C" fn(fmi2ComponentEnvironment, fmi2String, c_int, fmi2String, fmi2String, ...);

/// `fmi2CallbackFunctions`. Any member may be null.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct fmi2CallbackFunctions {
    /// Receives log messages.
    pub logger: Option<fmi2CallbackLogger>,
    /// Not used: the library manages its own memory.
    pub allocateMemory: Option<unsafe extern "C" fn(usize, usize) -> *mut c_void>,
    /// Not used.
    pub freeMemory: Option<unsafe extern "C" fn(*mut c_void)>,
    /// Not used: steps are synchronous.
    pub stepFinished: Option<unsafe extern "C" fn(fmi2ComponentEnvironment, c_int)>,
    /// Handed back to the logger.
    pub componentEnvironment: fmi2ComponentEnvironment,
}

/// An instance and the strings that it has lent to the importer.
pub struct Component {
    instance: Instance,
    /// Alive until the next `fmi2GetString`.
    lent: Vec<CString>,
}

/// Importers may use an instance from one thread after another.
const fn assert_send<T: Send>() {}
const _: () = assert_send::<Instance>();

/// `fmi2GetTypesPlatform`.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> fmi2String {
    c"default".as_ptr()
}

/// `fmi2GetVersion`.
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> fmi2String {
    c"2.0".as_ptr()
}

/// `fmi2Instantiate`. Null when anything is wrong; the reason goes to the logger.
///
/// # Safety
/// Strings are null or end with a zero byte; `functions` is null or points to a callback struct.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Instantiate(
    instanceName: fmi2String,
    fmuType: c_int,
    fmuGUID: fmi2String,
    fmuResourceLocation: fmi2String,
    functions: *const fmi2CallbackFunctions,
    _visible: fmi2Boolean,
    loggingOn: fmi2Boolean,
) -> fmi2Component {
    // SAFETY: the importer keeps the contract above.
    let (name, guid, location, functions) =
        unsafe { (text(instanceName), text(fmuGUID), text(fmuResourceLocation), functions.as_ref().copied()) };
    let request = open::Request {
        name: name.unwrap_or_default(),
        co_simulation: fmuType == FMI2_CO_SIMULATION,
        guid: guid.unwrap_or_default(),
        location,
        library: library_file(),
    };
    let made = catch_unwind(AssertUnwindSafe(|| {
        let log = Log::new(sink(functions, &request.name), loggingOn != FMI2_FALSE);
        open::open(&request, log)
    }));
    let refusal = match made {
        Ok(Ok(instance)) => return Box::into_raw(Box::new(Component { instance, lent: Vec::new() })),
        Ok(Err(refusal)) => refusal.to_string(),
        Err(panic) => format!("internal error: {}", panic_text(panic.as_ref())),
    };
    // There is no instance whose log could be switched on: the reason is always told.
    let _ = catch_unwind(AssertUnwindSafe(|| {
        Log::new(sink(functions, &request.name), true).error(|| format!("fmi2Instantiate: {refusal}"));
    }));
    ptr::null_mut()
}

/// `fmi2FreeInstance`.
///
/// # Safety
/// `c` is null or came from [`fmi2Instantiate`] and was not freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeInstance(c: fmi2Component) {
    if !c.is_null() {
        // SAFETY: `c` came from `Box::into_raw` in `fmi2Instantiate`, and the importer frees it once.
        let component = unsafe { Box::from_raw(c) };
        let _ = catch_unwind(AssertUnwindSafe(|| drop(component)));
    }
}

/// `fmi2SetDebugLogging`.
///
/// # Safety
/// `c` as in [`fmi2FreeInstance`]; `categories` has `nCategories` strings.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetDebugLogging(
    c: fmi2Component,
    loggingOn: fmi2Boolean,
    nCategories: usize,
    categories: *const fmi2String,
) -> Status {
    // SAFETY: see the contract.
    let categories = unsafe { array(categories, nCategories) };
    // SAFETY: see the contract.
    unsafe {
        enter(c, Call::SetDebugLogging, |c| {
            let Some(categories) = categories else { return refuse_null(c, Call::SetDebugLogging) };
            let names: Vec<String> = categories.iter().map(|&name| text(name).unwrap_or_default()).collect();
            c.instance.set_debug_logging(loggingOn != FMI2_FALSE, &names)
        })
    }
}

/// `fmi2SetupExperiment`. The tolerance is not used: the solution is exact for the deck.
///
/// # Safety
/// `c` as in [`fmi2FreeInstance`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetupExperiment(
    c: fmi2Component,
    _toleranceDefined: fmi2Boolean,
    _tolerance: fmi2Real,
    startTime: fmi2Real,
    stopTimeDefined: fmi2Boolean,
    stopTime: fmi2Real,
) -> Status {
    let stop = (stopTimeDefined != FMI2_FALSE).then_some(stopTime);
    // SAFETY: see the contract.
    unsafe { enter(c, Call::SetupExperiment, |c| c.instance.setup_experiment(startTime, stop)) }
}

/// Functions that take nothing but the instance.
macro_rules! plain {
    ($($(#[$doc:meta])* $name:ident, $call:ident, $method:ident;)*) => {$(
        $(#[$doc])*
        ///
        /// # Safety
        /// `c` as in [`fmi2FreeInstance`].
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(c: fmi2Component) -> Status {
            // SAFETY: see the contract.
            unsafe { enter(c, Call::$call, |c| c.instance.$method()) }
        }
    )*};
}

plain! {
    /// `fmi2EnterInitializationMode`.
    fmi2EnterInitializationMode, EnterInitializationMode, enter_initialization;
    /// `fmi2ExitInitializationMode`.
    fmi2ExitInitializationMode, ExitInitializationMode, exit_initialization;
    /// `fmi2Terminate`.
    fmi2Terminate, Terminate, terminate;
    /// `fmi2Reset`.
    fmi2Reset, Reset, reset;
}

/// `fmi2GetReal`.
///
/// # Safety
/// `c` as in [`fmi2FreeInstance`]; both arrays have `nvr` entries.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetReal(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *mut fmi2Real,
) -> Status {
    // SAFETY: see the contract.
    unsafe {
        enter(c, Call::GetReal, |c| match (array(vr, nvr), array_mut(value, nvr)) {
            (Some(references), Some(out)) => c.instance.get_real(references, out),
            _ => refuse_null(c, Call::GetReal),
        })
    }
}

/// `fmi2GetInteger`.
///
/// # Safety
/// As [`fmi2GetReal`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetInteger(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *mut fmi2Integer,
) -> Status {
    // SAFETY: see the contract.
    unsafe {
        enter(c, Call::GetInteger, |c| match (array(vr, nvr), array_mut(value, nvr)) {
            (Some(references), Some(out)) => c.instance.get_integer(references, out),
            _ => refuse_null(c, Call::GetInteger),
        })
    }
}

/// `fmi2GetBoolean`: there are no Boolean variables.
///
/// # Safety
/// As [`fmi2GetReal`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBoolean(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    _value: *mut fmi2Boolean,
) -> Status {
    // SAFETY: see the contract.
    unsafe {
        enter(c, Call::GetBoolean, |c| match array(vr, nvr) {
            Some(references) => c.instance.no_boolean(Call::GetBoolean, references),
            None => refuse_null(c, Call::GetBoolean),
        })
    }
}

/// `fmi2GetString`. The strings stay valid until the next call of this function on the instance.
///
/// # Safety
/// As [`fmi2GetReal`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetString(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *mut fmi2String,
) -> Status {
    // SAFETY: see the contract.
    unsafe {
        enter(c, Call::GetString, |c| match (array(vr, nvr), array_mut(value, nvr)) {
            (Some(references), Some(out)) => {
                let mut strings = vec![String::new(); references.len()];
                let status = c.instance.get_string(references, &mut strings);
                if status == Status::Ok {
                    c.lent = strings.into_iter().map(c_string).collect();
                    for (out, string) in out.iter_mut().zip(&c.lent) {
                        *out = string.as_ptr();
                    }
                }
                status
            }
            _ => refuse_null(c, Call::GetString),
        })
    }
}

/// `fmi2SetReal`.
///
/// # Safety
/// As [`fmi2GetReal`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetReal(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *const fmi2Real,
) -> Status {
    // SAFETY: see the contract.
    unsafe {
        enter(c, Call::SetReal, |c| match (array(vr, nvr), array(value, nvr)) {
            (Some(references), Some(values)) => {
                let entries = references.iter().zip(values).map(|(&reference, &value)| (reference, Value::Real(value)));
                c.instance.set(Call::SetReal, entries)
            }
            _ => refuse_null(c, Call::SetReal),
        })
    }
}

/// `fmi2SetInteger`.
///
/// # Safety
/// As [`fmi2GetReal`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetInteger(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *const fmi2Integer,
) -> Status {
    // SAFETY: see the contract.
    unsafe {
        enter(c, Call::SetInteger, |c| match (array(vr, nvr), array(value, nvr)) {
            (Some(references), Some(values)) => {
                let entries =
                    references.iter().zip(values).map(|(&reference, &value)| (reference, Value::Integer(value)));
                c.instance.set(Call::SetInteger, entries)
            }
            _ => refuse_null(c, Call::SetInteger),
        })
    }
}

/// `fmi2SetBoolean`: there are no Boolean variables.
///
/// # Safety
/// As [`fmi2GetReal`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetBoolean(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    _value: *const fmi2Boolean,
) -> Status {
    // SAFETY: see the contract.
    unsafe {
        enter(c, Call::SetBoolean, |c| match array(vr, nvr) {
            Some(references) => c.instance.no_boolean(Call::SetBoolean, references),
            None => refuse_null(c, Call::SetBoolean),
        })
    }
}

/// `fmi2SetString`.
///
/// # Safety
/// As [`fmi2GetReal`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetString(
    c: fmi2Component,
    vr: *const fmi2ValueReference,
    nvr: usize,
    value: *const fmi2String,
) -> Status {
    // SAFETY: see the contract.
    unsafe {
        enter(c, Call::SetString, |c| {
            let (Some(references), Some(values)) = (array(vr, nvr), array(value, nvr)) else {
                return refuse_null(c, Call::SetString);
            };
            let mut entries = Vec::with_capacity(references.len());
            for (&reference, &value) in references.iter().zip(values) {
                let Some(value) = text(value) else {
                    return c
                        .instance
                        .refuse(Call::SetString, format!("value reference {reference}: null or not UTF-8"));
                };
                entries.push((reference, Value::String(value)));
            }
            c.instance.set(Call::SetString, entries.into_iter())
        })
    }
}

/// `fmi2GetFMUstate`.
///
/// # Safety
/// `c` as in [`fmi2FreeInstance`]; `state` is null or points to a handle.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetFMUstate(c: fmi2Component, state: *mut fmi2FMUstate) -> Status {
    // SAFETY: see the contract.
    unsafe {
        enter(c, Call::GetFmuState, |c| match state.as_mut() {
            Some(state) => take_handle(c.instance.save_state(number(*state)), state),
            None => refuse_null(c, Call::GetFmuState),
        })
    }
}

/// `fmi2SetFMUstate`.
///
/// # Safety
/// `c` as in [`fmi2FreeInstance`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetFMUstate(c: fmi2Component, state: fmi2FMUstate) -> Status {
    // SAFETY: see the contract.
    unsafe {
        enter(c, Call::SetFmuState, |c| match number(state) {
            Some(state) => c.instance.load_state(state),
            None => refuse_null(c, Call::SetFmuState),
        })
    }
}

/// `fmi2FreeFMUstate`. The handle becomes null; a null handle is fine.
///
/// # Safety
/// As [`fmi2GetFMUstate`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(c: fmi2Component, state: *mut fmi2FMUstate) -> Status {
    // SAFETY: see the contract.
    unsafe {
        enter(c, Call::FreeFmuState, |c| {
            let Some(state) = state.as_mut() else { return Status::Ok };
            let status = number(*state).map_or(Status::Ok, |handle| c.instance.free_state(handle));
            if status == Status::Ok {
                *state = ptr::null_mut();
            }
            status
        })
    }
}

/// `fmi2SerializedFMUstateSize`.
///
/// # Safety
/// `c` as in [`fmi2FreeInstance`]; `size` is null or points to a size.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(c: fmi2Component, state: fmi2FMUstate, size: *mut usize) -> Status {
    // SAFETY: see the contract.
    unsafe {
        enter(c, Call::SerializedFmuStateSize, |c| {
            let (Some(handle), Some(size)) = (number(state), size.as_mut()) else {
                return refuse_null(c, Call::SerializedFmuStateSize);
            };
            match c.instance.serialized_state(Call::SerializedFmuStateSize, handle) {
                Ok(bytes) => {
                    *size = bytes.len();
                    Status::Ok
                }
                Err(status) => status,
            }
        })
    }
}

/// `fmi2SerializeFMUstate`.
///
/// # Safety
/// `c` as in [`fmi2FreeInstance`]; `bytes` has `size` entries.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializeFMUstate(
    c: fmi2Component,
    state: fmi2FMUstate,
    bytes: *mut fmi2Byte,
    size: usize,
) -> Status {
    // SAFETY: see the contract.
    unsafe {
        enter(c, Call::SerializeFmuState, |c| {
            let (Some(handle), Some(out)) = (number(state), array_mut(bytes, size)) else {
                return refuse_null(c, Call::SerializeFmuState);
            };
            let saved = match c.instance.serialized_state(Call::SerializeFmuState, handle) {
                Ok(saved) => saved,
                Err(status) => return status,
            };
            match out.get_mut(..saved.len()) {
                Some(out) => {
                    out.copy_from_slice(saved);
                    Status::Ok
                }
                None => {
                    let reason = format!("{size} bytes are given, the state has {}", saved.len());
                    c.instance.refuse(Call::SerializeFmuState, reason)
                }
            }
        })
    }
}

/// `fmi2DeSerializeFMUstate`.
///
/// # Safety
/// As [`fmi2SerializeFMUstate`] and [`fmi2GetFMUstate`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
    c: fmi2Component,
    bytes: *const fmi2Byte,
    size: usize,
    state: *mut fmi2FMUstate,
) -> Status {
    // SAFETY: see the contract.
    unsafe {
        enter(c, Call::DeSerializeFmuState, |c| match (array(bytes, size), state.as_mut()) {
            (Some(bytes), Some(state)) => take_handle(c.instance.deserialize_state(bytes, number(*state)), state),
            _ => refuse_null(c, Call::DeSerializeFmuState),
        })
    }
}

/// `fmi2GetDirectionalDerivative`: the capability flag is false.
///
/// # Safety
/// `c` as in [`fmi2FreeInstance`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetDirectionalDerivative(
    c: fmi2Component,
    _vUnknown: *const fmi2ValueReference,
    _nUnknown: usize,
    _vKnown: *const fmi2ValueReference,
    _nKnown: usize,
    _dvKnown: *const fmi2Real,
    _dvUnknown: *mut fmi2Real,
) -> Status {
    let call = Call::GetDirectionalDerivative;
    // SAFETY: see the contract.
    unsafe { enter(c, call, |c| c.instance.refuse(call, "this FMU does not provide directional derivatives")) }
}

/// `fmi2SetRealInputDerivatives`: the capability flag is false.
///
/// # Safety
/// `c` as in [`fmi2FreeInstance`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetRealInputDerivatives(
    c: fmi2Component,
    _vr: *const fmi2ValueReference,
    nvr: usize,
    _order: *const fmi2Integer,
    _value: *const fmi2Real,
) -> Status {
    let call = Call::SetRealInputDerivatives;
    // SAFETY: see the contract.
    unsafe {
        enter(c, call, |c| match nvr {
            0 => Status::Ok,
            _ => c.instance.refuse(call, "this FMU does not interpolate inputs"),
        })
    }
}

/// `fmi2GetRealOutputDerivatives`: the greatest order is 0.
///
/// # Safety
/// `c` as in [`fmi2FreeInstance`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealOutputDerivatives(
    c: fmi2Component,
    _vr: *const fmi2ValueReference,
    nvr: usize,
    _order: *const fmi2Integer,
    _value: *mut fmi2Real,
) -> Status {
    let call = Call::GetRealOutputDerivatives;
    // SAFETY: see the contract.
    unsafe {
        enter(c, call, |c| match nvr {
            0 => Status::Ok,
            _ => c.instance.refuse(call, "this FMU does not provide output derivatives"),
        })
    }
}

/// `fmi2DoStep`.
///
/// # Safety
/// `c` as in [`fmi2FreeInstance`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DoStep(
    c: fmi2Component,
    currentCommunicationPoint: fmi2Real,
    communicationStepSize: fmi2Real,
    _noSetFMUStatePriorToCurrentPoint: fmi2Boolean,
) -> Status {
    // SAFETY: see the contract.
    unsafe { enter(c, Call::DoStep, |c| c.instance.do_step(currentCommunicationPoint, communicationStepSize)) }
}

/// `fmi2CancelStep`: steps are synchronous, there is never one to cancel.
///
/// # Safety
/// `c` as in [`fmi2FreeInstance`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2CancelStep(c: fmi2Component) -> Status {
    let call = Call::CancelStep;
    // SAFETY: see the contract.
    unsafe { enter(c, call, |c| c.instance.refuse(call, "no step is in progress")) }
}

/// `fmi2GetStatus`: steps are synchronous, `fmi2DoStep` itself returned their status.
///
/// # Safety
/// `c` as in [`fmi2FreeInstance`]; `value` is null or points to a status.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStatus(c: fmi2Component, s: c_int, value: *mut c_int) -> Status {
    let call = Call::GetStatus;
    // SAFETY: see the contract.
    unsafe {
        enter(c, call, |c| match (s, value.as_mut()) {
            (FMI2_DO_STEP_STATUS, Some(value)) => {
                *value = c.instance.last_step_status() as c_int;
                Status::Ok
            }
            (_, None) => refuse_null(c, call),
            _ => refuse_kind(c, call, s),
        })
    }
}

/// `fmi2GetRealStatus`: the last successful time.
///
/// # Safety
/// `c` as in [`fmi2FreeInstance`]; `value` is null or points to a real.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealStatus(c: fmi2Component, s: c_int, value: *mut fmi2Real) -> Status {
    let call = Call::GetRealStatus;
    // SAFETY: see the contract.
    unsafe {
        enter(c, call, |c| match (s, value.as_mut()) {
            (FMI2_LAST_SUCCESSFUL_TIME, Some(value)) => {
                *value = c.instance.last_successful_time();
                Status::Ok
            }
            (_, None) => refuse_null(c, call),
            _ => refuse_kind(c, call, s),
        })
    }
}

/// `fmi2GetIntegerStatus`: the standard defines no such status.
///
/// # Safety
/// `c` as in [`fmi2FreeInstance`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetIntegerStatus(c: fmi2Component, s: c_int, _value: *mut fmi2Integer) -> Status {
    let call = Call::GetIntegerStatus;
    // SAFETY: see the contract.
    unsafe { enter(c, call, |c| refuse_kind(c, call, s)) }
}

/// `fmi2GetBooleanStatus`: whether the FMU wants the simulation to end. It never does.
///
/// # Safety
/// `c` as in [`fmi2FreeInstance`]; `value` is null or points to a boolean.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBooleanStatus(c: fmi2Component, s: c_int, value: *mut fmi2Boolean) -> Status {
    let call = Call::GetBooleanStatus;
    // SAFETY: see the contract.
    unsafe {
        enter(c, call, |c| match (s, value.as_mut()) {
            (FMI2_TERMINATED, Some(value)) => {
                *value = FMI2_FALSE;
                Status::Ok
            }
            (_, None) => refuse_null(c, call),
            _ => refuse_kind(c, call, s),
        })
    }
}

/// `fmi2GetStringStatus`: there is no step in progress that could tell something.
///
/// # Safety
/// `c` as in [`fmi2FreeInstance`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStringStatus(c: fmi2Component, s: c_int, _value: *mut fmi2String) -> Status {
    let call = Call::GetStringStatus;
    // SAFETY: see the contract.
    unsafe { enter(c, call, |c| refuse_kind(c, call, s)) }
}

/// Checks instance and call order, then calls `body`; a panic condemns the instance.
///
/// # Safety
/// `c` is null or came from [`fmi2Instantiate`] and was not freed; nobody else uses it during the call.
unsafe fn enter(c: fmi2Component, call: Call, body: impl FnOnce(&mut Component) -> Status) -> Status {
    // SAFETY: see the contract.
    let Some(component) = (unsafe { c.as_mut() }) else {
        return Status::Error;
    };
    let guarded = catch_unwind(AssertUnwindSafe(|| {
        if call.allowed_in(component.instance.phase()) {
            body(component)
        } else {
            component.instance.refuse_order(call)
        }
    }));
    guarded.unwrap_or_else(|panic| {
        let what = panic_text(panic.as_ref());
        catch_unwind(AssertUnwindSafe(|| component.instance.condemn(call, &what))).unwrap_or(Status::Fatal)
    })
}

fn refuse_null(c: &Component, call: Call) -> Status {
    c.instance.refuse(call, "a null pointer was passed where values are needed")
}

fn refuse_kind(c: &Component, call: Call, kind: c_int) -> Status {
    c.instance.refuse(call, format!("status kind {kind} is not available here"))
}

fn take_handle(taken: Result<usize, Status>, state: &mut fmi2FMUstate) -> Status {
    match taken {
        Ok(handle) => {
            *state = ptr::without_provenance_mut(handle);
            Status::Ok
        }
        Err(status) => status,
    }
}

fn number(state: fmi2FMUstate) -> Option<usize> {
    Some(state.addr()).filter(|&handle| handle != 0)
}

/// Text of a C string; `None` when it is null or not UTF-8.
///
/// # Safety
/// `string` is null or ends with a zero byte.
unsafe fn text(string: fmi2String) -> Option<String> {
    if string.is_null() {
        return None;
    }
    // SAFETY: not null, and ends with a zero byte.
    unsafe { CStr::from_ptr(string) }.to_str().ok().map(str::to_owned)
}

/// An array of the importer; `None` when it is null though entries are promised. No entries need no pointer.
///
/// # Safety
/// `first` is null or points to `count` entries that stay unchanged during the call.
unsafe fn array<'a, T>(first: *const T, count: usize) -> Option<&'a [T]> {
    match count {
        0 => Some(&[]),
        _ if first.is_null() || count > isize::MAX as usize / size_of::<T>() => None,
        // SAFETY: not null, and has `count` entries.
        _ => Some(unsafe { slice::from_raw_parts(first, count) }),
    }
}

/// As [`array`], to write to.
///
/// # Safety
/// `first` is null or points to `count` entries that nobody else uses during the call.
unsafe fn array_mut<'a, T>(first: *mut T, count: usize) -> Option<&'a mut [T]> {
    match count {
        0 => Some(&mut []),
        _ if first.is_null() || count > isize::MAX as usize / size_of::<T>() => None,
        // SAFETY: not null, and has `count` entries.
        _ => Some(unsafe { slice::from_raw_parts_mut(first, count) }),
    }
}

/// The importer's callbacks, copied: the struct itself may be gone after `fmi2Instantiate`.
#[derive(Clone, Copy)]
struct Logger {
    function: fmi2CallbackLogger,
    environment: fmi2ComponentEnvironment,
}

// SAFETY: the function is code, and the environment is only handed back to it; an importer that uses an instance from
// another thread expects its log there.
unsafe impl Send for Logger {}

fn sink(functions: Option<fmi2CallbackFunctions>, name: &str) -> Option<Sink> {
    let functions = functions?;
    let logger = Logger { function: functions.logger?, environment: functions.componentEnvironment };
    let name = c_string(name.to_owned());
    Some(Box::new(move |status, category, message| {
        let logger: Logger = logger;
        let category = c_string(category.to_owned());
        let message = c_string(message.replace('%', "%%"));
        // SAFETY: the importer gave this function for this purpose; the strings live until it returns, and the message
        // holds no conversion that would ask for further arguments.
        unsafe {
            (logger.function)(logger.environment, name.as_ptr(), status as c_int, category.as_ptr(), message.as_ptr());
        }
    }))
}

fn c_string(text: String) -> CString {
    CString::new(text.replace('\0', "\u{fffd}")).expect("zero bytes were replaced")
}

fn panic_text(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "no message".into())
}

#[repr(C)]
struct DlInfo {
    dli_fname: *const c_char,
    dli_fbase: *mut c_void,
    dli_sname: *const c_char,
    dli_saddr: *mut c_void,
}

unsafe extern "C" {
    fn dladdr(address: *const c_void, info: *mut DlInfo) -> c_int;
}

/// File that this code was loaded from, for importers that do not say where the resources are.
fn library_file() -> Option<PathBuf> {
    let mut info = DlInfo {
        dli_fname: ptr::null(),
        dli_fbase: ptr::null_mut(),
        dli_sname: ptr::null(),
        dli_saddr: ptr::null_mut(),
    };
    // SAFETY: the address is that of a function of this library, and `info` may be written to.
    let found = unsafe { dladdr(fmi2GetVersion as *const c_void, &mut info) };
    if found == 0 {
        return None;
    }
    // SAFETY: `dladdr` succeeded, so the name is null or a string that lives as long as the library is loaded.
    unsafe { text(info.dli_fname) }.map(PathBuf::from)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::backend::law::LawBackend;
    use crate::lifecycle::Phase;

    fn component() -> Component {
        let instance = Instance::new("{1}".into(), Box::new(LawBackend::default()), Log::new(None, false));
        Component { instance, lent: Vec::new() }
    }

    #[test]
    fn a_panic_becomes_fatal_and_goes_no_further() {
        let mut component = component();
        // SAFETY: the component lives on the stack of this test.
        let status = unsafe { enter(&mut component, Call::Reset, |_| panic!("on purpose")) };
        assert_eq!(status, Status::Fatal);
        assert_eq!(component.instance.phase(), Phase::Fatal);
        // SAFETY: as above.
        let status = unsafe { fmi2Reset(&mut component) };
        assert_eq!(status, Status::Fatal);
    }

    #[test]
    fn a_null_component_is_an_error() {
        // SAFETY: null is allowed.
        unsafe {
            assert_eq!(fmi2Reset(ptr::null_mut()), Status::Error);
            assert_eq!(fmi2DoStep(ptr::null_mut(), 0.0, 1.0, 1), Status::Error);
            fmi2FreeInstance(ptr::null_mut());
        }
    }
}
