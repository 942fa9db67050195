use crate::record::Record;
use crate::{Precision, Shader, record, wgsl};

/// Threads of a workgroup.
pub(crate) const BATCH_THREADS: u32 = 64;
/// Numbers before an answer: the number of its submission.
pub(crate) const ANSWER_HEAD: u32 = 1;

record! {
    /// What shaders/batch.wgsl reads first.
    pub(crate) struct Head {
        pub(crate) problems: u32,
        pub(crate) submission: u32,
    }
}

/// A function in WGSL that answers one problem, for a [`Batch`](crate::Batch).
#[derive(Clone, Copy, Debug)]
pub struct Kernel<'a> {
    pub(crate) name: &'a str,
    text: &'a str,
    problem: u16,
    answer: u16,
}

impl<'a> Kernel<'a> {
    /// A kernel from a text with `fn solve(problem: u32, answer: u32)`.
    ///
    /// `solve` reads the numbers of its problem from `problems[problem]` on: `problem` numbers, at
    /// least 1. It writes its answer from `answers[answer]` on: `answer` numbers. All have the type
    /// `real`, which is `f32` or `f64`. The text may use the functions in [`wgsl`]. `name` is for
    /// messages.
    pub const fn new(name: &'a str, text: &'a str, problem: u16, answer: u16) -> Self {
        Self { name, text, problem, answer }
    }

    /// The whole text that is compiled in a precision, to check it without a GPU.
    pub fn shader(&self, precision: Precision) -> Shader {
        let sizes = [
            ("THREADS", BATCH_THREADS),
            ("PROBLEM", self.problem()),
            ("ANSWER", self.answer()),
            ("ANSWER_HEAD", ANSWER_HEAD),
        ];
        let sizes: String = sizes
            .iter()
            .map(|(name, size)| wgsl::constant(name, format_args!("{size}u")))
            .collect();
        let text = [
            &wgsl::prelude(precision),
            &sizes,
            &Head::wgsl(),
            self.text,
            include_str!("shaders/batch.wgsl"),
        ];
        Shader::new("batch", text.concat())
    }

    /// Numbers of a problem.
    pub(crate) fn problem(&self) -> u32 {
        u32::from(self.problem).max(1)
    }

    /// Numbers of an answer with its head.
    pub(crate) fn answer(&self) -> u32 {
        ANSWER_HEAD + u32::from(self.answer)
    }
}
