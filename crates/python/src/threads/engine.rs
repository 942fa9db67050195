//! A mesh's engine, and the clones of it that questions are asked of.

use super::compute::{compute, interruptible};
use super::each::Lender;
use super::fork::forks;
use super::held::Held;
use super::pool::pool;
use crate::error::Refused;
use parry_continuum::parry::math::Vector;
use parry_continuum::proximity::{BvhSearch, Contact, LinkProximity, Proximity};
use parry_continuum::{Chain, Tube};
use pyo3::prelude::*;

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
pub(crate) struct Engine(Held<State>);

struct State {
    base: BvhSearch,
    /// Sessions that nobody uses.
    free: Vec<Session>,
    /// How many are in use.
    lent: usize,
    /// How often had been forked when all this was noted.
    forks: u64,
}

impl Engine {
    /// The engine of a mesh, built on all cores.
    pub(crate) fn new(
        py: Python<'_>,
        vertices: Vec<Vector>,
        faces: Vec<[u32; 3]>,
    ) -> PyResult<Self> {
        /// Below this number of triangles, the build ends before a user can press Ctrl-C.
        const FEW: usize = 1 << 16;
        let (pool, count) = (pool(py)?, faces.len());
        let build = move || pool.install(|| BvhSearch::from_triangles(&vertices, &faces));
        let built = if count < FEW { compute(py, build)? } else { interruptible(py, build)? };
        let base = built.map_err(|error| Refused::Mesh(error).raise(py, None))?;
        Ok(Self::of(base))
    }

    fn of(base: BvhSearch) -> Self {
        Self(Held::new(State { base, free: Vec::new(), lent: 0, forks: forks() }))
    }

    /// A clone of the engine itself: for what asks once, and for what moves.
    pub(crate) fn search(&self, py: Python<'_>) -> PyResult<BvhSearch> {
        self.notice_fork(py)?;
        Ok(self.0.with(py, |state| state.base.clone()))
    }

    /// The engine with its vertices elsewhere; this one stays as it is.
    pub(crate) fn moved(&self, py: Python<'_>, vertices: &[Vector]) -> PyResult<Self> {
        let pool = pool(py)?;
        let mut search = self.search(py)?;
        let moved = compute(py, || pool.install(|| search.set_vertices(vertices)))?;
        moved.map_err(|error| Refused::Mesh(error).raise(py, None))?;
        Ok(Self::of(search))
    }

    /// In a child: where another thread of the parent was asking at the fork, it may have been
    /// building what the library builds at a first question, behind a lock that nobody opens here.
    /// The vertices and triangles are whole, so the engine is built of them again. Where nobody was
    /// asking, the parent's is as good as ever.
    fn notice_fork(&self, py: Python<'_>) -> PyResult<()> {
        let half_built = self.0.with(py, |state| {
            if state.forks == forks() {
                return None;
            }
            state.forks = forks();
            (std::mem::take(&mut state.lent) > 0).then(|| state.base.clone())
        });
        let Some(parents) = half_built else { return Ok(()) };
        // With the GIL, so that no thread uses the parent's in that time.
        let (vertices, triangles) = (parents.vertices(), parents.triangles());
        let built = pool(py)?.install(|| BvhSearch::from_triangles(vertices, triangles));
        let base = built.map_err(|error| Refused::Mesh(error).raise(py, None))?;
        self.0.with(py, |state| {
            state.base = base;
            state.free.clear();
        });
        Ok(())
    }
}

impl Lender for Engine {
    type Session = Session;

    fn lend(&self, py: Python<'_>) -> PyResult<Session> {
        self.notice_fork(py)?;
        Ok(self.0.with(py, |state| {
            state.lent += 1;
            state.free.pop().unwrap_or_else(|| Session::new(&state.base))
        }))
    }

    fn take_back(&self, py: Python<'_>, lent: usize, sessions: impl IntoIterator<Item = Session>) {
        self.0.with(py, |state| {
            state.lent = state.lent.saturating_sub(lent);
            state.free.extend(sessions);
        });
    }
}
