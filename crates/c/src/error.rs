//! What is wrong: a code, and for each thread the message of its last error.

use mesh_files::MeshFileError;
use parry_continuum::proximity::{MeshError, ProximityError, SceneError};
use parry_continuum::{MatrixError, RobotError};
use std::any::Any;
use std::cell::RefCell;
use std::ffi::{CString, c_char};

/// What a function returns.
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum pc_status {
    /// There is an answer.
    PC_OK = 0,
    /// A pointer, a length or an option is wrong.
    PC_BAD_ARGUMENT = 1,
    /// The library refuses the numbers. `pc_error_kind` is the same word as in Rust and Python.
    PC_REFUSED = 2,
    /// A file cannot be read or written, or contains no mesh.
    PC_FILE = 3,
    /// A defect of the library. Free the handles of the call, and report the message.
    PC_DEFECT = 4,
}

/// Why there is no answer.
#[derive(Debug)]
pub(crate) struct Fault {
    pub status: pc_status,
    kind: &'static str,
    text: String,
    robot: i64,
}

impl Fault {
    pub(crate) fn new(status: pc_status, kind: &'static str, text: String) -> Self {
        Self { status, kind, text, robot: -1 }
    }

    pub(crate) fn argument(kind: &'static str, text: String) -> Self {
        Self::new(pc_status::PC_BAD_ARGUMENT, kind, text)
    }

    /// The same, about one robot or motion of a batch.
    pub(crate) fn of_robot(self, robot: usize) -> Self {
        let text = format!("robot {robot}: {}", self.text);
        Self { text, robot: i64::try_from(robot).unwrap_or(i64::MAX), ..self }
    }

    pub(crate) fn panic(panic: &(dyn Any + Send)) -> Self {
        let text = panic.downcast_ref::<&str>().copied();
        let text = text.or_else(|| panic.downcast_ref::<String>().map(String::as_str));
        let text = format!(
            "{}; this is a defect of parry-continuum, please report it",
            text.unwrap_or("the library panicked")
        );
        Self::new(pc_status::PC_DEFECT, "defect", text)
    }

    /// Keeps the message for this thread.
    pub(crate) fn keep(self) -> pc_status {
        // A text has no NUL, except the name of a file from a program in another language.
        let text = CString::new(self.text.replace('\0', "?")).unwrap_or_default();
        let kind = CString::new(self.kind).unwrap_or_default();
        LAST.with_borrow_mut(|last| *last = Some(Last { kind, text, robot: self.robot }));
        self.status
    }
}

/// The library's names of parameters, and the names here.
const NAMES: [(&str, &str); 4] = [
    ("`segment_radii`", "`radii`"),
    ("`end_tangents`", "`tangents`"),
    ("`from`", "`start`"),
    ("`to`", "`end`"),
];
/// The same for the poses of a motion.
const POSES: [(&str, &str); 2] = [("`from`", "`start_pose`"), ("`to`", "`end_pose`")];

impl From<RobotError> for Fault {
    fn from(error: RobotError) -> Self {
        let names: &[_] = match error {
            RobotError::BadPose { .. } | RobotError::PoseNotRigid { .. } => &POSES,
            _ => &NAMES,
        };
        let text = error.to_string();
        let text = names.iter().fold(text, |text, (rust, c)| text.replace(rust, c));
        Self::new(pc_status::PC_REFUSED, error.kind(), text)
    }
}

macro_rules! refused {
    ($($error:ty),*) => {$(
        impl From<$error> for Fault {
            fn from(error: $error) -> Self {
                Self::new(pc_status::PC_REFUSED, error.kind(), error.to_string())
            }
        }
    )*};
}
refused!(MatrixError, ProximityError, MeshError, SceneError);

impl From<MeshFileError> for Fault {
    fn from(error: MeshFileError) -> Self {
        Self::new(pc_status::PC_FILE, "file", error.to_string())
    }
}

struct Last {
    kind: CString,
    text: CString,
    robot: i64,
}

thread_local! {
    static LAST: RefCell<Option<Last>> = const { RefCell::new(None) };
}

/// A text of this thread's last error.
fn text_of(of: fn(&Last) -> &CString) -> *const c_char {
    LAST.with_borrow(|last| last.as_ref().map_or(c"".as_ptr(), |last| of(last).as_ptr()))
}

/// Returns the message of this thread's last error, in UTF-8: what is wrong, and what to change. It
/// is empty before the first error, and valid until the next one.
#[unsafe(no_mangle)]
pub extern "C" fn pc_error_message() -> *const c_char {
    text_of(|last| &last.text)
}

/// Returns the kind of this thread's last error, such as "point_not_finite". Programs can compare
/// it: it stays the same where a message becomes clearer.
#[unsafe(no_mangle)]
pub extern "C" fn pc_error_kind() -> *const c_char {
    text_of(|last| &last.kind)
}

/// Returns which robot or motion of a batch this thread's last error is about, or -1.
#[unsafe(no_mangle)]
pub extern "C" fn pc_error_robot() -> i64 {
    LAST.with_borrow(|last| last.as_ref().map_or(-1, |last| last.robot))
}
