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

    /// The same, about one robot or motion of a list.
    pub(crate) fn of_robot(self, robot: usize) -> Self {
        self.of("robot", robot)
    }

    /// The same, about one item of a list.
    pub(crate) fn of(self, item: &str, index: usize) -> Self {
        self.within(&format!("{item} {index}")).about(index)
    }

    /// The same, about a part of an argument.
    pub(crate) fn within(self, place: &str) -> Self {
        Self { text: format!("{place}: {}", self.text), ..self }
    }

    fn about(self, index: usize) -> Self {
        Self { robot: i64::try_from(index).unwrap_or(i64::MAX), ..self }
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
        let last = Some(Last { kind, text, robot: self.robot });
        // A thread that ends has no place for it.
        let _ = LAST.try_with(|place| place.replace(last));
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
refused!(MatrixError, ProximityError, MeshError);

impl From<SceneError> for Fault {
    fn from(error: SceneError) -> Self {
        let fault = Self::new(pc_status::PC_REFUSED, error.kind(), error.to_string());
        match error {
            SceneError::Robot { robot, .. } => fault.about(robot),
            _ => fault,
        }
    }
}

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

/// What `of` says of this thread's last error. `None`: there is none.
fn last<T>(of: impl FnOnce(&Last) -> T) -> Option<T> {
    LAST.try_with(|last| last.borrow().as_ref().map(of)).ok().flatten()
}

/// Returns the message of this thread's last error, in UTF-8: what is wrong, and what to change. It
/// is empty before the first error, and valid until the thread's next one or the thread's end.
#[unsafe(no_mangle)]
pub extern "C" fn pc_error_message() -> *const c_char {
    last(|last| last.text.as_ptr()).unwrap_or(c"".as_ptr())
}

/// Returns the kind of this thread's last error, such as "point_not_finite". Programs can compare
/// it: it stays the same where a message becomes clearer. It is valid as long as the message.
#[unsafe(no_mangle)]
pub extern "C" fn pc_error_kind() -> *const c_char {
    last(|last| last.kind.as_ptr()).unwrap_or(c"".as_ptr())
}

/// Returns which robot, motion or set of a list this thread's last error is about, or -1.
#[unsafe(no_mangle)]
pub extern "C" fn pc_error_robot() -> i64 {
    last(|last| last.robot).unwrap_or(-1)
}
