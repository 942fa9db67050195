//! A mesh's engine, and the clones of it that questions are asked of.

use super::compute::{compute, interruptible};
use super::device::{Device, DeviceKind, DeviceSession, Place};
use super::each::Lender;
use super::fork::forks;
use super::held::Held;
use super::pool::pool;
use crate::error::Refused;
use parry_continuum::parry::math::Vector;
use parry_continuum::proximity::{BvhSearch, Contact, LinkProximity, Proximity};
use parry_continuum::{Chain, Tube};
use pyo3::prelude::*;
use std::sync::Arc;

/// What one thread needs to ask: a clone of the engine, which shares mesh and hierarchy and
/// remembers its own answers, and memory that is used again.
pub(crate) struct Session {
    pub search: BvhSearch,
    pub chain: Option<Chain>,
    /// The tube of the last question, and whether it was made of samples alone.
    pub tube: Option<Tube>,
    pub has_samples: bool,
    pub links: Vec<LinkProximity>,
    pub contacts: Vec<Contact>,
}

impl Session {
    fn new(search: &BvhSearch) -> Self {
        Self {
            search: search.clone(),
            chain: None,
            tube: None,
            has_samples: false,
            links: Vec::new(),
            contacts: Vec::new(),
        }
    }
}

/// The engine of a mesh as it is now. A mesh that moves gets a new engine; running queries keep the
/// old engine.
pub(crate) struct Engine {
    state: Held<State>,
    /// The search on the GPU and the place of the vertices there, if the mesh is on a GPU.
    device: Option<(Arc<Device>, Place)>,
}

struct State {
    /// The search on the CPU. Its vertices are stale if `moved` has others.
    base: BvhSearch,
    /// The vertices after a move that only the GPU has followed so far.
    moved: Option<Arc<Vec<Vector>>>,
    /// Sessions that nobody uses.
    free: Vec<Session>,
    /// How many are in use.
    lent: usize,
    /// How often had been forked when all this was noted.
    forks: u64,
}

impl State {
    /// The vertices of the mesh.
    fn vertices(&self) -> Vertices {
        match &self.moved {
            Some(moved) => Vertices::Moved(Arc::clone(moved)),
            None => Vertices::Of(Box::new(self.base.clone())),
        }
    }
}

/// The vertices of a mesh, which stay as they are when the mesh moves.
pub(crate) enum Vertices {
    Of(Box<BvhSearch>),
    Moved(Arc<Vec<Vector>>),
}

impl Vertices {
    pub(crate) fn as_slice(&self) -> &[Vector] {
        match self {
            Self::Of(search) => search.vertices(),
            Self::Moved(vertices) => vertices,
        }
    }
}

impl Engine {
    /// The engine of a mesh, built on all cores.
    pub(crate) fn new(
        py: Python<'_>,
        vertices: Vec<Vector>,
        faces: Vec<[u32; 3]>,
        device: DeviceKind,
    ) -> PyResult<Self> {
        /// Below this number of triangles, the build ends before a user can press Ctrl-C.
        const FEW: usize = 1 << 16;
        if device == DeviceKind::Gpu {
            let (base, device) = Device::build(py, vertices, faces)?;
            return Ok(Self::of(base, None, Some(device)));
        }
        let (pool, count) = (pool(py)?, faces.len());
        let build = move || pool.install(|| BvhSearch::from_triangles(&vertices, &faces));
        let built = if count < FEW { compute(py, build)? } else { interruptible(py, build)? };
        let base = built.map_err(|error| Refused::Mesh(error).raise(py, None))?;
        Ok(Self::of(base, None, None))
    }

    fn of(
        base: BvhSearch,
        moved: Option<Arc<Vec<Vector>>>,
        device: Option<(Arc<Device>, Place)>,
    ) -> Self {
        let state = State { base, moved, free: Vec::new(), lent: 0, forks: forks() };
        Self { state: Held::new(state), device }
    }

    /// The same mesh on a device.
    pub(crate) fn on(self: Arc<Self>, py: Python<'_>, device: DeviceKind) -> PyResult<Arc<Self>> {
        if device == self.device() {
            return Ok(self);
        }
        Ok(Arc::new(match device {
            DeviceKind::Cpu => Self::of(self.search(py)?, None, None),
            DeviceKind::Gpu => {
                let vertices = self.vertices(py).as_slice().to_vec();
                Self::new(py, vertices, self.base(py).triangles().to_vec(), device)?
            }
        }))
    }

    /// Where the mesh is. In a forked child it is on the CPU.
    pub(crate) fn device(&self) -> DeviceKind {
        match &self.device {
            Some((device, _)) if device.is_of_this_process() => DeviceKind::Gpu,
            _ => DeviceKind::Cpu,
        }
    }

    /// The seconds that the GPU searched for the last batch on it, without transfers; `None` before
    /// the first, or if the GPU keeps no time.
    pub(crate) fn gpu_seconds(&self, py: Python<'_>) -> Option<f64> {
        self.device.as_ref().and_then(|(device, _)| device.seconds(py))
    }

    /// The engine of the CPU, whose vertices may be older than a move.
    pub(crate) fn base(&self, py: Python<'_>) -> BvhSearch {
        self.state.with(py, |state| state.base.clone())
    }

    /// The vertices.
    pub(crate) fn vertices(&self, py: Python<'_>) -> Vertices {
        self.state.with(py, |state| state.vertices())
    }

    /// A clone of the engine of the CPU itself: for what asks once, and for what moves.
    pub(crate) fn search(&self, py: Python<'_>) -> PyResult<BvhSearch> {
        self.notice_fork(py)?;
        self.refit(py)?;
        Ok(self.base(py))
    }

    /// The engine with its vertices elsewhere; this one stays as it is.
    pub(crate) fn moved(&self, py: Python<'_>, vertices: Vec<Vector>) -> PyResult<Self> {
        let pool = pool(py)?;
        if let Some((device, _)) = &self.device
            && let Some(mut session) = device.take(py)
        {
            let moved = compute(py, || pool.install(|| session.set_vertices(&vertices)));
            device.give_back(py, moved.is_ok().then_some(session));
            let place = moved?.map_err(|error| Refused::Mesh(error).raise(py, None))?;
            let moved = Some(Arc::new(vertices));
            return Ok(Self::of(self.base(py), moved, Some((Arc::clone(device), place))));
        }
        let mut search = self.search(py)?;
        let moved = compute(py, || pool.install(|| search.set_vertices(&vertices)))?;
        moved.map_err(|error| Refused::Mesh(error).raise(py, None))?;
        let device = self.device.as_ref().map(|(device, _)| (Arc::clone(device), Place::new()));
        Ok(Self::of(search, None, device))
    }

    /// Lends the search on the GPU, with the vertices of this engine. `None` if the mesh is on the
    /// CPU, if another thread has the search, or in a child.
    pub(crate) fn lend_device(&self, py: Python<'_>) -> PyResult<Option<DeviceSession>> {
        let Some((device, place)) = &self.device else { return Ok(None) };
        let pool = pool(py)?;
        let Some(mut session) = device.take(py) else { return Ok(None) };
        if session.place() != *place {
            let vertices = self.vertices(py);
            let moved =
                compute(py, || pool.install(|| session.follow(*place, vertices.as_slice())));
            if moved.is_err() {
                device.give_back(py, None);
            }
            moved?.map_err(|error| Refused::Mesh(error).raise(py, None))?;
        }
        self.state.with(py, |state| state.lent += 1);
        Ok(Some(session))
    }

    /// Takes the search on the GPU back; `None` after a defect.
    pub(crate) fn take_back_device(&self, py: Python<'_>, session: Option<DeviceSession>) {
        self.state.with(py, |state| state.lent = state.lent.saturating_sub(1));
        if let Some((device, _)) = &self.device {
            device.give_back(py, session);
        }
    }

    /// Whether the vertices have moved since the engine of the CPU was refitted.
    pub(crate) fn is_stale(&self, py: Python<'_>) -> bool {
        self.state.with(py, |state| state.moved.is_some())
    }

    /// Refits the engine of the CPU after a move.
    fn refit(&self, py: Python<'_>) -> PyResult<()> {
        let stale = self.state.with(py, |state| Some((state.base.clone(), state.moved.clone()?)));
        let Some((mut search, vertices)) = stale else { return Ok(()) };
        let pool = pool(py)?;
        let refitted = match self.lend_device(py)? {
            // The search on the GPU then has the same hierarchy for its own work on the CPU.
            Some(mut session) => {
                let refitted = compute(py, || pool.install(|| session.cpu()));
                self.take_back_device(py, refitted.is_ok().then_some(session));
                refitted?
            }
            None => {
                let moved = compute(py, || pool.install(|| search.set_vertices(&vertices)))?;
                moved.map_err(|error| Refused::Mesh(error).raise(py, None))?;
                search
            }
        };
        let before = self.state.with(py, |state| {
            // Another thread may have been faster.
            state.moved.take()?;
            Some((std::mem::replace(&mut state.base, refitted), std::mem::take(&mut state.free)))
        });
        drop(before); // not under the lock
        Ok(())
    }

    /// In a child: where another thread of the parent was asking at the fork, it may have been
    /// building what the library builds at a first question, behind a lock that nobody opens here.
    /// The vertices and triangles are whole, so the engine is built of them again. Where nobody was
    /// asking, the parent's is as good as ever.
    fn notice_fork(&self, py: Python<'_>) -> PyResult<()> {
        let half_built = self.state.with(py, |state| {
            if state.forks == forks() {
                return None;
            }
            state.forks = forks();
            (std::mem::take(&mut state.lent) > 0).then(|| (state.base.clone(), state.vertices()))
        });
        let Some((parents, vertices)) = half_built else { return Ok(()) };
        // With the GIL, so that no thread uses the parent's in that time.
        let (vertices, triangles) = (vertices.as_slice(), parents.triangles());
        let built = pool(py)?.install(|| BvhSearch::from_triangles(vertices, triangles));
        let base = built.map_err(|error| Refused::Mesh(error).raise(py, None))?;
        self.state.with(py, |state| {
            state.base = base;
            state.moved = None;
            state.free.clear();
        });
        Ok(())
    }
}

impl Lender for Engine {
    type Session = Session;

    fn lend(&self, py: Python<'_>) -> PyResult<Session> {
        self.notice_fork(py)?;
        self.refit(py)?;
        Ok(self.state.with(py, |state| {
            state.lent += 1;
            state.free.pop().unwrap_or_else(|| Session::new(&state.base))
        }))
    }

    fn take_back(&self, py: Python<'_>, lent: usize, sessions: impl IntoIterator<Item = Session>) {
        self.state.with(py, |state| {
            state.lent = state.lent.saturating_sub(lent);
            state.free.extend(sessions);
        });
    }
}
