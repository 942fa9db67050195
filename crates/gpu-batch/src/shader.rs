/// The text of a kernel in one precision.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Shader {
    /// The name of the entry point.
    pub entry_point: &'static str,
    /// The whole text, in WGSL.
    pub text: String,
}

impl Shader {
    /// A text with this entry point. Numbers of either precision need
    /// [`wgsl::prelude`](crate::wgsl::prelude) in it.
    pub fn new(entry_point: &'static str, text: impl Into<String>) -> Self {
        Self { entry_point, text: text.into() }
    }
}
