//! Where C's pointers become Rust's references, and where panics stop. All `unsafe` is here.
//!
//! The functions below are the kinds of arguments of `border!`. Each takes the pointer and the
//! parameter's name. A pointer that is null or misaligned, or a length that no array can have, is
//! an error. Any other pointer is trusted, as the header says.

use crate::error::{Fault, pc_status};
use crate::structure_end::pc_structure_end;
use parry_continuum::parry::math::{Pose, Vector};
use parry_continuum::pose_from_matrix;
use parry_continuum::proximity::StructureEnd;
use std::ffi::{CStr, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::slice;

/// The body of a function of the interface: `border!(name: kind, name: kind(length) => body)`.
/// `body` is a `Result<(), Fault>` that sees the arguments as Rust's.
macro_rules! border {
    ($($name:ident: $kind:ident $(($length:expr))?),* $(,)? => $body:expr) => {
        $crate::border::guard(|| {
            $(
                #[allow(unused_mut)] // places of answers change
                let mut $name =
                    // SAFETY: the caller keeps the header's rules: a pointer to aligned memory has
                    // as many items as the length says, and nobody else writes them.
                    unsafe { $crate::border::$kind($name, stringify!($name) $(, $length)?) }?;
            )*
            $body
        })
    };
}

/// The body of a function that frees a handle.
macro_rules! free {
    ($handle:ident) => {
        // SAFETY: the caller frees a handle of this type once, and does not use it again.
        unsafe { $crate::border::free($handle) }
    };
}

/// Runs a function's body. Its error becomes the thread's last one; a panic becomes an error.
#[inline]
pub(crate) fn guard(body: impl FnOnce() -> Result<(), Fault>) -> pc_status {
    // What a panic leaves behind is freed by the caller, as the header says.
    match catch_unwind(AssertUnwindSafe(body)) {
        Ok(Ok(())) => pc_status::PC_OK,
        Ok(Err(fault)) => keep(fault),
        Err(panic) => keep(Fault::panic(&*panic)),
    }
}

#[cold]
fn keep(fault: Fault) -> pc_status {
    fault.keep()
}

#[cold]
fn bad_pointer(is_null: bool, name: &str, align: usize) -> Fault {
    if is_null {
        let text = format!("`{name}` is NULL; pass a pointer to it");
        return Fault::argument("null_pointer", text);
    }
    let text = format!("`{name}` is not aligned to {align} bytes; pass a pointer to a whole item");
    Fault::argument("misaligned_pointer", text)
}

/// Refuses a null or misaligned pointer.
#[inline]
fn check<T>(pointer: *const T, name: &str) -> Result<(), Fault> {
    if pointer.is_null() || !pointer.is_aligned() {
        return Err(bad_pointer(pointer.is_null(), name, align_of::<T>()));
    }
    Ok(())
}

/// Refuses a pointer that cannot be that of `count` items. The pointer to no item may be null.
#[inline]
fn check_items<T>(pointer: *const T, name: &str, count: usize) -> Result<(), Fault> {
    if count == 0 {
        return Ok(());
    }
    check(pointer, name)?;
    let bytes = count.checked_mul(size_of::<T>());
    if bytes.is_none_or(|bytes| bytes > isize::MAX as usize) {
        let text = format!("`{name}` has {count} items, more than fit in memory; check its length");
        return Err(Fault::argument("bad_length", text));
    }
    Ok(())
}

/// A handle or a structure that is only read.
#[inline]
pub(crate) unsafe fn shared<'a, T>(pointer: *const T, name: &str) -> Result<&'a T, Fault> {
    check(pointer, name)?;
    // SAFETY: `check` accepts it, so it is valid by the caller's promise.
    Ok(unsafe { &*pointer })
}

/// A handle that is asked or changed.
#[inline]
pub(crate) unsafe fn exclusive<'a, T>(pointer: *mut T, name: &str) -> Result<&'a mut T, Fault> {
    check(pointer, name)?;
    // SAFETY: as for `shared`; a handle belongs to one thread at a time.
    Ok(unsafe { &mut *pointer })
}

/// Numbers or structures, one after another.
#[inline]
pub(crate) unsafe fn items<'a, T>(
    pointer: *const T,
    name: &str,
    count: usize,
) -> Result<&'a [T], Fault> {
    check_items(pointer, name, count)?;
    if count == 0 {
        return Ok(&[]);
    }
    // SAFETY: `check_items` accepts it, so it has `count` items by the caller's promise.
    Ok(unsafe { slice::from_raw_parts(pointer, count) })
}

/// `count` points of three numbers each.
#[inline]
pub(crate) unsafe fn points<'a>(
    pointer: *const f64,
    name: &str,
    count: usize,
) -> Result<&'a [Vector], Fault> {
    const {
        assert!(size_of::<Vector>() == 24 && align_of::<Vector>() == align_of::<f64>());
    }
    // SAFETY: a vector is three doubles, in C's layout and with a double's alignment.
    unsafe { items(pointer.cast(), name, count) }
}

/// As many points, or none where the pointer is null.
#[inline]
pub(crate) unsafe fn points_or_none<'a>(
    pointer: *const f64,
    name: &str,
    count: usize,
) -> Result<&'a [Vector], Fault> {
    // SAFETY: as for `points`.
    unsafe { points(pointer, name, if pointer.is_null() { 0 } else { count }) }
}

/// `count` triangles of three indices each.
#[inline]
pub(crate) unsafe fn triangles<'a>(
    pointer: *const u32,
    name: &str,
    count: usize,
) -> Result<&'a [[u32; 3]], Fault> {
    // SAFETY: an array has the layout of its items.
    unsafe { items(pointer.cast(), name, count) }
}

/// `count` pairs of numbers.
pub(crate) unsafe fn pairs<'a>(
    pointer: *const usize,
    name: &str,
    count: usize,
) -> Result<&'a [[usize; 2]], Fault> {
    // SAFETY: an array has the layout of its items.
    unsafe { items(pointer.cast(), name, count) }
}

fn pose_of(matrix: &[f64; 16]) -> Result<Pose, Fault> {
    let (rows, _) = matrix.as_chunks::<4>();
    Ok(pose_from_matrix([rows[0], rows[1], rows[2], rows[3]])?)
}

/// A pose by its matrix; the identity where the pointer is null.
#[inline]
pub(crate) unsafe fn pose(pointer: *const f64, name: &str) -> Result<Pose, Fault> {
    if pointer.is_null() {
        return Ok(Pose::IDENTITY);
    }
    // SAFETY: 16 doubles by the caller's promise; an array has the layout of its items.
    pose_of(unsafe { shared(pointer.cast(), name) }?)
}

/// `count` poses, one after another; all the identity where the pointer is null.
pub(crate) unsafe fn poses(
    pointer: *const f64,
    name: &str,
    count: usize,
) -> Result<Vec<Pose>, Fault> {
    // SAFETY: as for `batch_poses`.
    let BatchPoses { poses, bad } = unsafe { batch_poses(pointer, name, count) }?;
    match bad.into_iter().next() {
        Some((robot, fault)) => Err(fault.of_robot(robot)),
        None => Ok(poses),
    }
}

/// The poses of a batch. A robot with a bad pose is asked at the identity, and then refused.
pub(crate) struct BatchPoses {
    pub poses: Vec<Pose>,
    /// The robots with a bad pose, in order, and what is wrong.
    pub bad: Vec<(usize, Fault)>,
}

/// `count` poses, good and bad ones; all the identity where the pointer is null.
pub(crate) unsafe fn batch_poses(
    pointer: *const f64,
    name: &str,
    count: usize,
) -> Result<BatchPoses, Fault> {
    if pointer.is_null() {
        return Ok(BatchPoses { poses: vec![Pose::IDENTITY; count], bad: Vec::new() });
    }
    // SAFETY: 16 doubles each by the caller's promise.
    let matrices: &[[f64; 16]] = unsafe { items(pointer.cast(), name, count) }?;
    let mut bad = Vec::new();
    let poses = matrices.iter().enumerate().map(|(robot, matrix)| {
        pose_of(matrix).unwrap_or_else(|fault| {
            bad.push((robot, fault));
            Pose::IDENTITY
        })
    });
    Ok(BatchPoses { poses: poses.collect(), bad })
}

/// Where `count` structures are at the end of a motion.
pub(crate) unsafe fn structure_ends<'a>(
    pointer: *const pc_structure_end,
    name: &str,
    count: usize,
) -> Result<Vec<(usize, StructureEnd<'a>)>, Fault> {
    // SAFETY: `count` structures by the caller's promise.
    let given = unsafe { items(pointer, name, count) }?;
    let of = |(k, end): (usize, &pc_structure_end)| {
        let pc_structure_end { structure, .. } = *end;
        let found = match (end.pose.is_null(), end.vertices.is_null() && end.vertex_count == 0) {
            // SAFETY: a pose by the caller's promise.
            (false, true) => unsafe { pose(end.pose, "pose") }.map(StructureEnd::Pose),
            (true, false) => {
                // SAFETY: as many vertices as it says, by the caller's promise.
                let vertices = unsafe { points(end.vertices, "vertices", end.vertex_count) };
                vertices.map(StructureEnd::Vertices)
            }
            _ => {
                let text = "give either a `pose` or `vertices`";
                Err(Fault::argument("bad_structure_end", text.into()))
            }
        };
        let found = found.map_err(|fault| fault.within(&format!("`{name}[{k}]`")))?;
        Ok((structure, found))
    };
    given.iter().enumerate().map(of).collect()
}

/// A list of handles that are only read.
pub(crate) unsafe fn handles<'a, T>(
    pointer: *const *const T,
    name: &str,
    count: usize,
) -> Result<Vec<&'a T>, Fault> {
    // SAFETY: `count` pointers by the caller's promise.
    let pointers = unsafe { items(pointer, name, count) }?;
    let of = |(k, &handle): (usize, &*const T)| {
        // SAFETY: a handle by the caller's promise, unless it is null or misaligned.
        unsafe { shared(handle, name) }.map_err(|fault| fault.of_robot(k))
    };
    pointers.iter().enumerate().map(of).collect()
}

/// A text that ends in NUL, in UTF-8.
pub(crate) unsafe fn text<'a>(pointer: *const c_char, name: &str) -> Result<&'a str, Fault> {
    check(pointer, name)?;
    // SAFETY: it ends in NUL by the caller's promise.
    let text = unsafe { CStr::from_ptr(pointer) };
    let not_utf8 = |_| Fault::argument("bad_text", format!("`{name}` is not UTF-8; convert it"));
    text.to_str().map_err(not_utf8)
}

/// Where answers go. The memory may be uninitialised before.
pub(crate) struct Place<T>(*mut T, usize);

impl<T> Place<T> {
    /// Writes the first answer.
    #[inline]
    pub(crate) fn set(&mut self, value: T) {
        self.set_at(0, value);
    }

    /// Writes one of several answers.
    #[inline]
    pub(crate) fn set_at(&mut self, index: usize, value: T) {
        assert!(index < self.1);
        // SAFETY: the index is within the items, which a call of `place` or `places` has checked.
        let item = unsafe { self.0.add(index) };
        // SAFETY: writing needs no value before.
        unsafe { item.write(value) }
    }
}

/// Where an answer goes.
#[inline]
pub(crate) unsafe fn place<T>(pointer: *mut T, name: &str) -> Result<Place<T>, Fault> {
    check(pointer, name)?;
    Ok(Place(pointer, 1))
}

/// Where `count` answers go.
pub(crate) unsafe fn places<T>(
    pointer: *mut T,
    name: &str,
    count: usize,
) -> Result<Place<T>, Fault> {
    check_items(pointer, name, count)?;
    Ok(Place(pointer, count))
}

/// The same, or none where the pointer is null.
pub(crate) unsafe fn places_or_none<T>(
    pointer: *mut T,
    name: &str,
    count: usize,
) -> Result<Option<Place<T>>, Fault> {
    // SAFETY: as for `places`.
    (!pointer.is_null()).then(|| unsafe { places(pointer, name, count) }).transpose()
}

/// Where a new handle goes. It is null until there is one.
pub(crate) struct NewHandle<T>(Place<*mut T>);

impl<T> NewHandle<T> {
    pub(crate) fn set(&mut self, value: T) {
        self.0.set(Box::into_raw(Box::new(value)));
    }
}

pub(crate) unsafe fn new_handle<T>(
    pointer: *mut *mut T,
    name: &str,
) -> Result<NewHandle<T>, Fault> {
    // SAFETY: as for `place`.
    let mut place = unsafe { place(pointer, name) }?;
    place.set(std::ptr::null_mut());
    Ok(NewHandle(place))
}

/// Where the first item of a list goes.
pub(crate) struct ListPlace<T>(Place<*const T>);

impl<T> ListPlace<T> {
    /// Shows a list that the asked handle keeps.
    pub(crate) fn set(&mut self, list: &[T]) {
        self.0.set(list.as_ptr());
    }

    /// The same, and how many items it has.
    pub(crate) fn set_counted(&mut self, list: &[T], count: &mut Place<usize>) {
        self.set(list);
        count.set(list.len());
    }
}

pub(crate) unsafe fn list<T>(pointer: *mut *const T, name: &str) -> Result<ListPlace<T>, Fault> {
    // SAFETY: as for `place`.
    Ok(ListPlace(unsafe { place(pointer, name) }?))
}

/// Frees a handle. A null pointer is none.
pub(crate) unsafe fn free<T>(handle: *mut T) {
    if !handle.is_null() && handle.is_aligned() {
        guard(|| {
            // SAFETY: `NewHandle` made it of a box, and by the caller's promise it is freed once.
            drop(unsafe { Box::from_raw(handle) });
            Ok(())
        });
    }
}
