//! The book: one chapter per module.

#[doc = include_str!("book_links.md")]
#[doc = include_str!("../docs/book/shape.md")]
pub mod shape {}

#[doc = include_str!("book_links.md")]
#[doc = include_str!("../docs/book/kinematics.md")]
pub mod kinematics {}

#[doc = include_str!("book_links.md")]
#[doc = include_str!("../docs/book/queries.md")]
pub mod queries {}

#[doc = include_str!("book_links.md")]
#[doc = include_str!("../docs/book/engines.md")]
pub mod engines {}

#[doc = include_str!("book_links.md")]
#[doc = include_str!("../docs/book/threads.md")]
pub mod threads {}

#[doc = include_str!("book_links.md")]
#[doc = include_str!("../docs/book/robots.md")]
pub mod robots {}

#[doc = include_str!("book_links.md")]
#[doc = include_str!("../docs/book/inside.md")]
pub mod inside {}

#[doc = include_str!("book_links.md")]
#[doc = include_str!("../docs/book/control.md")]
pub mod control {}

#[doc = include_str!("book_links.md")]
#[doc = include_str!("../docs/book/tube.md")]
pub mod tube {}

#[doc = include_str!("book_links.md")]
#[doc = include_str!("../docs/book/trade.md")]
pub mod trade {}

// Its code needs rapier.
#[cfg(any(not(doctest), feature = "rapier"))]
#[doc = include_str!("book_links.md")]
#[doc = include_str!("../docs/book/hosts.md")]
pub mod hosts {}

#[doc = include_str!("book_links.md")]
#[doc = include_str!("../docs/book/certificates.md")]
pub mod certificates {}

#[doc = include_str!("book_links.md")]
#[doc = include_str!("../docs/book/proofs.md")]
pub mod proofs {}

#[doc = include_str!("book_links.md")]
#[doc = include_str!("../docs/book/errors.md")]
pub mod errors {}

#[doc = include_str!("book_links.md")]
#[doc = include_str!("../docs/book/limits.md")]
pub mod limits {}

#[doc = include_str!("book_links.md")]
#[doc = include_str!("../docs/book/from_ct.md")]
pub mod from_ct {}

#[doc = include_str!("book_links.md")]
#[doc = include_str!("../docs/book/coming_from.md")]
pub mod coming_from {}
